//! `--time-limit`, and what `check` says about the cost of a picture.

use crate::run::{BALL, Folder};

/// A scene that takes hours: 64 rays a pixel, 4096 more from each.
const SLOW: &str = "show(sphere(0.8))\nshow(plane().move(y = -0.8))\nrender(ao = hemisphere(4096), aa = supersample(64))\n";

#[test]
fn a_limit_ends_a_picture_with_what_there_is() {
    let folder = Folder::with(SLOW);
    let ended = folder.run("render scene.star --size 256x192 --time-limit 2 --json");
    assert_eq!(ended.code, Some(5), "{}", ended.err);
    for words in [
        "scene.png",
        "time limit of 2 s",
        "% of it is finished",
        "zeroset check",
    ] {
        let said = ended.err.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(words), "{}", ended.err);
    }
    let summary = ended.json();
    assert!(summary["finished"].as_f64().unwrap() < 1.0, "{summary}");
    assert_eq!(summary["width"], 256);
    assert!(summary["seconds"].as_f64().unwrap() > 0.0, "{summary}");
    let reader = png::Decoder::new(std::io::Cursor::new(folder.read("scene.png")))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (256, 192));
    let noted = info
        .uncompressed_latin1_text
        .iter()
        .find(|t| t.keyword == "Unfinished");
    assert!(noted.unwrap().text.contains("time limit"));
    // the ball is there, everywhere: a picture without occlusion is much the same
    folder.write(
        "plain.star",
        SLOW.replace(
            "hemisphere(4096), aa = supersample(64)",
            "none(), aa = none()",
        ),
    );
    folder.good("render plain.star --size 256x192");
    let rmse = folder.good("compare plain.png scene.png --json").json()["rmse"]
        .as_f64()
        .unwrap();
    assert!(rmse < 0.2, "{rmse}");
}

#[test]
fn a_limit_that_is_not_reached_changes_nothing() {
    let folder = Folder::with("show(sphere(0.8))\nrender(aa = supersample(4))\n");
    folder.good("render scene.star --size 150x100 -o a.exr");
    let ended = folder.good("render scene.star --size 150x100 -o b.exr --time-limit 600 --json");
    assert_eq!(ended.json()["finished"], 1.0);
    assert_eq!(ended.err, "");
    assert!(folder.read("a.exr") == folder.read("b.exr"));
}

#[test]
fn frames_go_on_after_one_that_is_unfinished() {
    let folder = Folder::with(&SLOW.replace("4096", "64"));
    let ended = folder.run("render scene.star --size 128x128 --time-limit 0.8 --frames 0..2 -q");
    assert_eq!(ended.code, Some(5), "{}", ended.err);
    assert_eq!(
        folder.names(),
        ["scene-0000.png", "scene-0001.png", "scene.star"]
    );
    assert_eq!(
        ended.err.matches("time limit of").count(),
        2,
        "{}",
        ended.err
    );
}

#[test]
fn a_limit_that_nothing_meets_makes_no_file() {
    let folder = Folder::with(BALL);
    folder.write("scene.png", "old");
    folder.bad(
        "render scene.star --size 64x64 --time-limit 0.000001",
        5,
        &["not even", "--time-limit"],
    );
    assert_eq!(folder.read("scene.png"), b"old");
    for limit in ["0", "-1", "soon", "nan", "inf"] {
        folder.bad(
            &format!("render scene.star --time-limit={limit}"),
            2,
            &["above 0"],
        );
    }
    folder.good("render scene.star --size 16x16 --time-limit 1e300");
}

#[test]
fn check_says_what_a_picture_costs() {
    let folder = Folder::with(
        "show(sphere(0.8))\nshow(plane().move(y = -0.8))\nrender(size = (200, 150), aa = supersample(4))\n",
    );
    let cost = folder.good("check scene.star --json").json()["cost"].clone();
    let found = cost["evaluations_per_pixel"].as_f64().unwrap();
    let done = folder.good("render scene.star --json").json();
    let right = done["evaluations"]["total"].as_f64().unwrap() / (200.0 * 150.0);
    assert!(
        (0.6..1.7).contains(&(found / right)),
        "{found}, right {right}"
    );
    assert!(
        cost["seconds"].as_f64().unwrap() > 0.0 && cost["bytes"].as_u64().unwrap() > 200 * 150 * 24
    );
    assert_eq!(
        (&cost["rays_per_pixel"], &cost["is_least"]),
        (&4.into(), &false.into())
    );
    let words = folder.good("check scene.star").out;
    assert!(
        words.contains("A picture of 200x150 with 4 rays a pixel takes about"),
        "{words}"
    );
    folder.write("scene.star", SLOW);
    let words = folder.good("check scene.star").out;
    assert!(
        words.contains("hours") || words.contains("minutes") || words.contains("days"),
        "{words}"
    );
}
