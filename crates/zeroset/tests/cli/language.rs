//! `check`, `expand` and `slice`.

use crate::run::{BALL, Folder};

const TWO: &str = "bite = slider(\"bite\", 0.4, min = 0.0, max = 1.0)\n\
    show(box(1.0) - sphere(bite).move(x = 0.5))\n\
    show(plane().move(y = -1.0))\n";

#[test]
fn check_says_what_is_known() {
    let folder = Folder::with(TWO);
    let found = folder.good("check scene.star --json --set bite=0.7").json();
    let objects = found["objects"].as_array().unwrap();
    assert_eq!(objects.len(), 2);
    assert_eq!(objects[0]["bounds"][0][0], -0.5);
    assert_eq!(objects[1]["bounds"][1][0], serde_json::Value::Null);
    assert_eq!(objects[1]["distance"], "exact");
    assert_eq!(found["proven"], true);
    assert_eq!(found["parameters"][0]["value"], "0.7");
    assert_eq!(found["parameters"][0]["default"], "0.4");
    let words = folder.good("check scene.star").out;
    assert!(
        words.contains("2 objects")
            && words.contains("bite = 0.4 (0 to 1)")
            && words.contains("Proven"),
        "{words}"
    );
}

#[test]
fn mistakes_have_their_place() {
    let folder = Folder::with("show(sphere(0.8))\nshow(spere(1))\n");
    for command in ["check", "render", "expand", "slice"] {
        folder.bad(
            &format!("{command} scene.star"),
            3,
            &["scene.star:2", "sphere", "help"],
        );
    }
    assert_eq!(folder.names(), ["scene.star"]);
}

#[test]
fn expand_is_the_same_scene() {
    let folder = Folder::with(TWO);
    folder.good("expand scene.star -o twin.json --set bite=0.6");
    let printed = folder.good("expand scene.star --set bite=0.6").out;
    assert!(printed.trim().as_bytes() == folder.read("twin.json").trim_ascii());
    folder.good("render scene.star --size 40x30 -o a.png --set bite=0.6");
    folder.good("render twin.json --size 40x30 -o b.png");
    let found = folder.good("compare a.png b.png --json").json();
    assert_eq!(found["equal"], true, "{found}");
    let twice = folder.good("expand twin.json").out;
    let (once, twice): (serde_json::Value, serde_json::Value) = (
        serde_json::from_slice(&folder.read("twin.json")).unwrap(),
        serde_json::from_str(&twice).unwrap(),
    );
    assert_eq!(once, twice);
}

#[test]
fn slices_are_drawn() {
    let folder = Folder::with(TWO);
    folder.good("slice scene.star --size 80x70");
    folder.good(
        "slice scene.star --size 80x70 --plane x=0.25 --window -1,-1,1,1 -o b.png --no-legend",
    );
    assert_eq!(folder.names(), ["b.png", "scene-slice.png", "scene.star"]);
    folder.bad("slice scene.star --plane w=0", 2, &["x, y or z"]);
    folder.bad(
        "slice scene.star --window 0,0,1",
        2,
        &["left,bottom,right,top"],
    );
    folder.bad("slice scene.star -o a.exr", 2, &[".png"]);
    folder.bad(
        "slice scene.star --size 100000x100000",
        2,
        &["--limit pixels"],
    );
}

#[test]
fn a_ball_is_cut_to_a_disc() {
    let folder = Folder::with(BALL);
    folder.good("slice scene.star --size 64x64 --window -1,-1,1,1 -o a.png --no-legend");
    let bytes = folder.read("a.png");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let pixel = |x: usize, y: usize| &pixels[3 * (64 * y + x)..][..3];
    let is_blue = |p: &[u8]| p[2] > p[0];
    assert!(is_blue(pixel(32, 32)) && !is_blue(pixel(2, 2)));
    let dark = |p: &[u8]| p.iter().all(|c| *c < 90);
    // radius 0.8 of a picture that shows -1 to 1
    assert!(
        dark(pixel(32 + 25, 32)) && dark(pixel(32, 32 - 26)),
        "{:?}",
        pixel(57, 32)
    );
}
