//! Pictures made again from what they say of how they were made.

use crate::run::{BALL, Folder};

const SCENE: &str = "r = slider(\"radius\", 0.8, 0.1, 2)
kind = choice(\"kind\", [\"ball\", \"schön\"])
show(sphere(r) if kind == \"ball\" else box(r))
show(plane().move(y = -0.8))
camera(eye = (2, 1.5 + time(), 3), target = (0, 0, 0), shutter = 0.1)
";

/// Everything that is asked for on the way to a picture is in the picture.
#[test]
fn a_picture_is_made_again_to_the_bit() {
    let folder = Folder::with(SCENE);
    let asked = [
        ("a.png", "--aa coverage"),
        (
            "b.png",
            "--set radius=1.1 --set kind=schön --time 0.3 --spp 5 --seed 7 --bits 16",
        ),
        (
            "c.png",
            "--march relaxed=1.2 --normals central --shadow none --ao bent=3,bend=0.1 --aa supersample=4,filter=mitchell --tone standard",
        ),
        (
            "d.png",
            "--shading phong --integrator path=2 --seed 3 --spp 4 --denoise",
        ),
        ("e.png", "--transparent --set radius=0.3"),
        ("f.png", "--view normal --time -2"),
        ("g.png", "--view steps --no-legend"),
        ("h.exr", "--set radius=0.5 --spp 4"),
        ("i.exr", "--integrator path=2 --noise 0.3 --transparent"),
        ("j.exr", "--checkpoint a.ckpt --spp 16 --seed 4294967295"),
    ];
    for (name, flags) in asked {
        folder.good(&format!("render scene.star --size 36x30 {flags} -o {name}"));
        let ending = &name[1..];
        let ended = folder.good(&format!(
            "render {name} --scene scene.star -o again{ending} --threads 1"
        ));
        assert!(
            folder.read(name) == folder.read(&format!("again{ending}")),
            "{name} {flags}: {}",
            ended.err
        );
        assert!(!ended.err.contains("differ"), "{}", ended.err);
    }
    // what is made again says the same, and so on
    folder.good("render again.png --scene scene.star -o twice.png");
    assert!(folder.read("again.png") == folder.read("twice.png"));
}

/// What is given beside a picture counts; a frame of an animation is made again at its own time.
#[test]
fn the_command_line_counts_instead() {
    let folder = Folder::with(SCENE);
    folder.good("render scene.star --size 36x30 --set radius=0.4 --spp 2 --frames 3..5 --fps 10 -o scene.png");
    folder.good("render scene.star --size 36x30 --set radius=0.4 --spp 2 --time 0.4 -o whole.png");
    // the scene is found by its name
    folder.good("render scene-0004.png");
    assert!(folder.read("scene-0004-again.png") == folder.read("whole.png"));
    folder.good(
        "render scene-0004.png --size 72x60 --set radius=0.6 --time 1 --aa none -o other.png",
    );
    folder.good("render scene.star --size 72x60 --set radius=0.6 --time 1 --aa none -o wanted.png");
    let colours = folder.good("compare other.png wanted.png --json").json();
    assert_eq!(colours["largest"], 0.0, "{colours}");
    // an .exr holds all planes, whatever the picture shows
    folder.good("render scene.star --size 36x30 --view depth -o depth.png");
    folder.good("render depth.png --scene scene.star -o all.exr");
    folder.bad(
        "render scene.star --scene other.star",
        2,
        &["is no picture"],
    );
}

#[test]
fn what_may_differ_is_said() {
    let folder = Folder::with(SCENE);
    folder.good("render scene.star --size 36x30 --set radius=0.4 -o a.png");
    folder.write("scene.star", SCENE.replace("sphere", "octahedron"));
    let ended = folder.good("render a.png --scene scene.star -o b.png");
    assert!(
        ended.err.contains("The scene has changed since"),
        "{}",
        ended.err
    );
    // a parameter that is gone, and one whose range is another
    folder.write("scene.star", BALL);
    folder.bad(
        "render a.png --scene scene.star -o c.png",
        3,
        &["no parameter \"radius\""],
    );
    folder.write("scene.star", SCENE.replace("0.1, 2", "0.5, 2"));
    folder.bad(
        "render a.png --scene scene.star -o c.png",
        3,
        &["a number from 0.5 to 2"],
    );
    assert!(!folder.path("c.png").exists());
    let none = ["there is no a.star beside it", "--scene SCENE"];
    folder.bad("render a.png", 2, &none);
}

/// A PNG with a text chunk.
fn picture(key: &str, text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder
        .add_itxt_chunk(key.to_owned(), text.to_owned())
        .unwrap();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0]).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn pictures_of_strangers_do_no_harm() {
    let folder = Folder::with(BALL);
    folder.good("render scene.star --size 8x8 -o a.png");
    let bytes = folder.read("a.png");
    let from = bytes.windows(8).position(|w| w == b"{\"format").unwrap();
    let to = from
        + bytes[from..]
            .iter()
            .position(|b| *b > b'~' || *b < b' ')
            .unwrap();
    // before the check sum of the chunk
    let (end, _) = (from..to)
        .rev()
        .find_map(|at| (bytes[at] == b'}').then_some((at + 1, at)))
        .unwrap();
    let text = String::from_utf8(bytes[from..end].to_vec()).unwrap();
    let bad = |bytes: &[u8], words: &[&str]| {
        folder.write("scene.png", bytes);
        folder.bad("render scene.png -o out.png", 4, words);
        assert!(!folder.path("out.png").exists());
    };
    folder.write("scene.png", picture("Recipe", &text));
    folder.good("render scene.png -o b.png");
    assert!(folder.read("b.png") == folder.read("a.png"));
    bad(b"", &["neither a PNG"]);
    bad(&bytes[..40], &["damaged"]);
    bad(
        &picture("Comment", &text),
        &["does not say how it was made"],
    );
    let damaged = |from: &str, to: &str, words: &[&str]| {
        let changed = text.replacen(from, to, 1);
        assert!(changed != text, "{from}: {text}");
        bad(&picture("Recipe", &changed), words);
    };
    damaged("\"format\":1", "\"format\":2", &["its recipe has format 2"]);
    damaged("}", "", &["its recipe is damaged"]);
    damaged("\"seed\"", "\"sead\"", &["its recipe is damaged", "sead"]);
    damaged("[8,8]", "[0,8]", &["no pixels"]);
    damaged("\"seed\":", "\"seed\":-", &["its recipe is damaged"]);
    damaged("\"time\":0.0", "\"time\":1e999", &["its recipe is damaged"]);
    let with =
        |entry: &str, words: &[&str]| damaged("\"seed\":", &format!("{entry},\"seed\":"), words);
    with(
        "\"methods\":{\"march\":\"\\u001b[31m\"}",
        &["--march", "the methods are"],
    );
    with(
        "\"methods\":{\"output\":\"/etc/passwd\"}",
        &["chooses no method"],
    );
    with("\"view\":\"none\"", &["no plane"]);
    with(
        "\"view\":\"depth\",\"denoise\":true",
        &["does not go together"],
    );
    with("\"bits\":7", &["7 bits"]);
    with("\"spp\":0", &["no rays"]);
    with("\"noise\":-1", &["above 0"]);
    with("\"output\":\"x.png\"", &["unknown field"]);
    bad(
        &picture("Recipe", &"[".repeat(100_000)),
        &["its recipe is damaged"],
    );
    bad(
        &picture("Recipe", &"1".repeat(2_000_000)),
        &["1048576 are read"],
    );
    // within the format, but not within the limits of the command line and of scenes
    let refused = |from: &str, to: &str, code: i32, words: &[&str]| {
        folder.write("scene.png", picture("Recipe", &text.replacen(from, to, 1)));
        folder.bad("render scene.png -o out.png", code, words);
    };
    refused("[8,8]", "[4000000000,4000000000]", 2, &["pixels"]);
    refused("\"near\":0.0", "\"near\":-1.0", 3, &["camera"]);
    refused("\"seed\":", "\"spp\":4000000000,\"seed\":", 2, &["spp"]);
    let set = "\"set\":{\"a\\u001b[31m\":\"1\"},\"seed\":";
    refused("\"seed\":", set, 3, &["no parameter"]);
    // another version is no reason not to try
    let version = format!("\"zeroset\":\"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version));
    let other = text.replace(&version, "\"zeroset\":\"0.0.1\\u001b\"");
    folder.write("scene.png", picture("Recipe", &other));
    let ended = folder.good("render scene.png -o out.png");
    assert!(ended.err.contains("made by Zeroset 0.0.1"), "{}", ended.err);
    assert!(!ended.err.contains('\u{1b}'));
}
