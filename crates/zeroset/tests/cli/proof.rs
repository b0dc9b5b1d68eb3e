//! `zeroset certify` and `zeroset why`.

use crate::run::Folder;
use std::io::Cursor;

const SCENE: &str = "show(sphere(1), name = \"ball\")\nshow(plane().move(y = -1), name = \"floor\")\n\
    camera(eye = (0, 0.5, 5), target = (0, 0, 0), fov = 40)\n";
/// Its slope is 8, not 1.
const HOLES: &str = "show(field(lambda p: 8 * (length(p) - 1), size = 4, slope = 1))\ncamera(eye = (3, 2, 5), fov = 40)\n";

#[test]
fn a_picture_is_certified() {
    let folder = Folder::with(SCENE);
    let said = folder
        .good("certify scene.star --size 40x30 --at-least 99.9 -o map.png")
        .out;
    assert!(
        said.contains("of the pixels are proven") && said.contains("0 wrong"),
        "{said}"
    );
    let bytes = folder.read("map.png");
    let map = png::Decoder::new(Cursor::new(&bytes)).read_info();
    assert_eq!(map.expect("a picture").info().size(), (40, 30));
    let json = folder.good("certify scene.star --size 40x30 --json").json();
    let count = |name: &str| json[name].as_u64().expect("a count");
    assert_eq!(
        count("hits") + count("misses") + count("unknown") + count("wrong"),
        1200
    );
    assert!(count("hits") > 500 && json["proven"].as_f64() >= Some(0.999));
    folder.write("holes.star", HOLES);
    // what was counted is printed, and the exit code says that it is too little
    let wrong = folder.run("certify holes.star --size 40x30");
    assert_eq!(wrong.code, Some(1));
    assert!(!wrong.out.contains(" 0 wrong"), "{}", wrong.out);
    for said in ["pixels show what is not there", "zeroset check"] {
        assert!(wrong.err.contains(said), "{}", wrong.err);
    }
    folder.write("fractal.star", "show(mandelbulb())\n");
    let few = folder.run("certify fractal.star --size 16x12 --at-least 50");
    assert_eq!(few.code, Some(1));
    assert!(
        few.out.contains("0.000 % of the pixels are proven"),
        "{}",
        few.out
    );
    assert!(few.err.contains("--at-least asks for 50"), "{}", few.err);
    folder.bad("certify scene.star --at-least 101", 2, &["0 to 100"]);
    folder.bad("certify scene.star -o map.jpg", 2, &["map.jpg", ".png"]);
}

#[test]
fn a_formula_without_a_slope_is_checked_and_certified() {
    let folder = Folder::with(
        "show(field(lambda p: length(p) - 1.2 + 0.2 * sqrt(abs(p.x))), name = \"star\")\n\
         camera(eye = (2, 1.5, 3), target = (0, 0, 0), fov = 40)\n",
    );
    let said = folder.good("check scene.star").out;
    assert!(
        said.contains("By ranges: no slope holds for all of star"),
        "{said}"
    );
    assert!(
        said.contains("`sqrt(abs(x))` is infinitely steep"),
        "{said}"
    );
    let json = folder.good("check scene.star --json").json();
    assert_eq!(json["proven"], false);
    let sought = json["objects"][0]["sought"].as_array().expect("reasons");
    assert_eq!(sought.len(), 1);
    let certified = folder
        .good("certify scene.star --size 40x30 --at-least 99")
        .out;
    assert!(certified.contains("0 wrong"), "{certified}");
    let why = folder.good("why scene.star 20 15 --size 40x30").out;
    assert!(why.contains("by ranges"), "{why}");
    // the GPU says that it does not, where it is asked for by name
    let said = folder.run("render scene.star --backend gpu --size 16x12 -o x.png");
    assert!(said.code != Some(0), "{}", said.err);
}

#[test]
fn a_pixel_says_why() {
    let folder = Folder::with(SCENE);
    let said = folder.good("why scene.star 20 15 --size 40x30").out;
    for wanted in [
        "meets ball (scene.star:1)",
        "proven hit",
        "f along the ray",
        "Nothing to do.",
    ] {
        assert!(said.contains(wanted), "{wanted}: {said}");
    }
    let json = folder
        .good("why scene.star 2 28 --size 40x30 --json")
        .json();
    assert_eq!(
        (&json["hit"]["object"], &json["verdict"]),
        (&"floor".into(), &"proven hit".into())
    );
    assert_eq!(json["hit"]["place"][1], 2);
    let steps = json["steps"].as_array().expect("steps");
    assert!(steps.len() > 2 && steps.iter().all(|s| s["slope"].as_f64() > Some(0.99)));
    folder.write("holes.star", HOLES);
    let json = folder
        .good("why holes.star 20 15 --size 40x30 --json")
        .json();
    assert_eq!(
        (&json["verdict"], &json["hit"]),
        (&"wrong".into(), &serde_json::Value::Null)
    );
    assert!(
        json["advice"]
            .as_str()
            .is_some_and(|a| a.contains("a stated slope is too low")),
        "{json}"
    );
    folder.bad(
        "why scene.star 40 0 --size 40x30",
        2,
        &["column 40", "0 to 39"],
    );
    folder.bad(
        "why scene.star 0 30 --size 40x30",
        2,
        &["row 30", "0 to 29"],
    );
}
