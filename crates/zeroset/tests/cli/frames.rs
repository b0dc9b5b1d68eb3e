//! `--frames`.

use crate::run::{BALL, Folder};

const MOVING: &str =
    "show(sphere(0.5).move(x = time()))\ncamera(eye = (0, 0, 4), target = (0, 0, 0))\n";

#[test]
fn frames_are_numbered_and_differ() {
    let folder = Folder::with(MOVING);
    let ended = folder.good("render scene.star --size 24x24 --frames 2..5 --fps 10 --json");
    assert_eq!(
        folder.names(),
        [
            "scene-0002.png",
            "scene-0003.png",
            "scene-0004.png",
            "scene.star"
        ]
    );
    let lines: Vec<serde_json::Value> = ended
        .out
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    let times: Vec<f64> = lines.iter().map(|l| l["time"].as_f64().unwrap()).collect();
    assert_eq!(times, [0.2, 0.3, 0.4]);
    assert_eq!(lines[0]["frame"], 2);
    assert!(folder.read("scene-0002.png") != folder.read("scene-0004.png"));
    folder.good("render scene.star --size 24x24 --time 0.4 -o one.png");
    let one = folder.good("compare one.png scene-0004.png --json").json();
    assert_eq!(one["equal"], true);
}

#[test]
fn frames_have_names_that_the_user_chooses() {
    let folder = Folder::with(MOVING);
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.good("render scene.star --size 8x8 --frames 9..=10 -o out/f##.exr");
    assert!(folder.path("out/f09.exr").exists() && folder.path("out/f10.exr").exists());
}

#[test]
fn a_scene_that_stands_still_is_noticed() {
    let folder = Folder::with(BALL);
    assert!(
        folder
            .good("render scene.star --size 8x8 --frames 0..2")
            .err
            .contains("all frames will be the same")
    );
}

#[test]
fn frames_end_where_the_scene_breaks() {
    let folder = Folder::with("show(sphere(1.0 - time()))\n");
    folder.bad(
        "render scene.star --size 8x8 --frames 0..5 --fps 2 -q",
        3,
        &["sphere"],
    );
    assert_eq!(
        folder.names(),
        ["scene-0000.png", "scene-0001.png", "scene.star"]
    );
}
