//! Pictures: what is in the files, what is said, and that old files survive.

use crate::run::{BALL, Folder};
use std::io::Cursor;

/// Width, height, bits and text chunks of a PNG.
fn png(bytes: &[u8]) -> (u32, u32, u8, Vec<(String, String)>) {
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let info = reader.info();
    let mut texts: Vec<(String, String)> = info
        .uncompressed_latin1_text
        .iter()
        .map(|t| (t.keyword.clone(), t.text.clone()))
        .collect();
    texts.extend(
        info.utf8_text
            .iter()
            .map(|t| (t.keyword.clone(), t.get_text().unwrap())),
    );
    (info.width, info.height, info.bit_depth as u8, texts)
}

#[test]
fn the_default_is_a_png_beside_the_user() {
    let folder = Folder::with(BALL);
    std::fs::create_dir(folder.path("elsewhere")).unwrap();
    let output = folder
        .command("render ../scene.star --size 40x30")
        .current_dir(folder.path("elsewhere"))
        .output();
    let output = output.unwrap();
    assert!(output.status.success() && output.stdout.is_empty());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("scene.png: 40x30") && said.contains("evaluations a ray"),
        "{said}"
    );
    assert_eq!(folder.names(), ["elsewhere", "scene.star"]);
    let (width, height, bits, _) = png(&folder.read("elsewhere/scene.png"));
    assert_eq!((width, height, bits), (40, 30, 8));
}

#[test]
fn a_picture_shows_the_scene() {
    let folder = Folder::with(BALL);
    folder.good("render scene.star --size 64x64 -o a.png");
    folder.good("render scene.star --size 64x64 -o b.png --threads 1");
    assert!(
        folder.read("a.png") == folder.read("b.png"),
        "threads change the picture"
    );
    folder.write("other.star", "show(box(1.2))\n");
    folder.good("render other.star --size 64x64 -o c.png");
    let far = folder.good("compare a.png c.png --json").json();
    assert!(far["rmse"].as_f64().unwrap() > 0.01, "{far}");
}

#[test]
fn notes_are_in_the_file_and_no_path() {
    let folder = Folder::with("size = slider(\"size\", 0.5)\nshow(sphere(size))\n");
    let place = folder.path("scene.star");
    folder.good(&format!(
        "render {} --size 16x16 --set size=0.75 --time 2.5 -o a.png --bits 16",
        place.display()
    ));
    let bytes = folder.read("a.png");
    let (_, _, bits, texts) = png(&bytes);
    assert_eq!(bits, 16);
    let text = |key: &str| {
        texts
            .iter()
            .find(|(k, _)| k == key)
            .unwrap_or_else(|| panic!("{key}: {texts:?}"))
            .1
            .as_str()
    };
    assert_eq!(text("Title"), "scene");
    assert!(text("Software").starts_with("Zeroset "));
    let settings: serde_json::Value = serde_json::from_str(text("Settings")).unwrap();
    assert_eq!(settings["size"], serde_json::json!([16, 16]));
    assert_eq!(text("Parameters"), "{\"size\":\"0.75\"}");
    assert_eq!(text("Time"), "2.5");
    let folder_name = place.parent().unwrap().to_string_lossy().into_owned();
    folder.good("render scene.star --size 16x16 -o a.exr");
    for name in ["a.png", "a.exr"] {
        let bytes = folder.read(name);
        let held = bytes
            .windows(folder_name.len())
            .any(|w| w == folder_name.as_bytes());
        assert!(!held, "{name} names {folder_name}");
    }
}

#[test]
fn every_plane_can_be_seen() {
    let folder = Folder::with(BALL);
    for plane in [
        "coverage",
        "depth",
        "normal",
        "albedo",
        "occlusion",
        "shadow",
        "steps",
        "residual",
        "object",
    ] {
        folder.good(&format!("render scene.star --size 72x72 --view {plane}"));
        let (width, height, ..) = png(&folder.read(&format!("scene-{plane}.png")));
        assert_eq!(height, 72, "{plane}");
        let explained = matches!(plane, "depth" | "steps" | "residual" | "object");
        assert_eq!(width > 72, explained, "{plane}");
    }
    folder.good("render scene.star --size 72x72 --view steps --no-legend -o plain.png");
    assert_eq!(png(&folder.read("plain.png")).0, 72);
}

#[test]
fn an_exr_shows_what_a_png_shows() {
    let folder = Folder::with(BALL);
    folder.good("render scene.star --size 48x32 -o a.exr");
    folder.good("render scene.star --size 48x32 -o a.png --bits 16 --tone standard");
    let found = folder.good("compare a.exr a.png --json").json();
    assert!(found["largest"].as_f64().unwrap() < 2e-5, "{found}");
}

#[test]
fn methods_are_chosen_by_flags() {
    let folder = Folder::with(BALL);
    let flags = "--march fixed=0.125 --normals central --shadow none --ao bent=3,bend=0.5 --aa none --shading lambert";
    let command = format!("render scene.star --size 16x12 --json {flags}");
    let settings = folder.good(&command).json()["settings"].clone();
    assert_eq!(settings["march"]["step"], 0.125);
    assert_eq!(settings["normals"], "central");
    assert_eq!(settings["occlusion"]["steps"], 3);
    assert_eq!(settings["occlusion"]["bend"], 0.5);
    assert_eq!(settings["antialias"]["method"], "none");
    assert_eq!(settings["shading"], "lambert");
    let command =
        "render scene.star --size 16x12 --json --integrator path,depth=3 --spp 6 --tone agx";
    let settings = folder.good(command).json()["settings"].clone();
    assert_eq!(settings["integrator"]["depth"], 3);
    assert_eq!(settings["antialias"]["samples"], 6);
    assert_eq!(settings["tone"], "agx");
    folder.bad("render scene.star --spp 0", 2, &["0", "1.."]);
    folder.write("floor.star", "show(sphere().move(y = 1))\nshow(plane())\n");
    let command = "render floor.star --size 32x24 --view shadow --no-legend";
    folder.good(&format!("{command} -o lit.png --shadow none"));
    folder.good(&format!("{command} -o own.png"));
    let found = folder.good("compare lit.png own.png --json").json();
    assert!(found["largest"].as_f64().unwrap() > 0.5, "{found}");
}

#[test]
fn the_summary_is_json() {
    let folder = Folder::with(BALL);
    let ended =
        folder.good("render scene.star --size 32x20 --json --march relaxed=1.3 --threads 2");
    assert_eq!(ended.err, "");
    let summary = ended.json();
    assert_eq!(summary["scene"], "scene");
    assert_eq!(summary["file"], "scene.png");
    assert_eq!(
        (&summary["width"], &summary["height"]),
        (&32.into(), &20.into())
    );
    assert_eq!(summary["view"], "colour");
    assert_eq!(summary["threads"], 2);
    assert_eq!(summary["settings"]["march"]["method"], "relaxed");
    let rays = summary["rays"].as_u64().unwrap();
    assert!(rays >= 640 && summary["hits"].as_u64().unwrap() > 0);
    let stages = summary["evaluations"].as_object().unwrap();
    let sum: u64 = stages
        .iter()
        .filter(|(k, _)| *k != "total")
        .map(|(_, n)| n.as_u64().unwrap())
        .sum();
    assert_eq!(stages["total"].as_u64().unwrap(), sum);
    let per_ray = summary["evaluations_per_ray"].as_f64().unwrap();
    assert!((per_ray - sum as f64 / rays as f64).abs() < 1e-9);
}

#[test]
fn quiet_says_nothing_and_verbose_says_more() {
    let folder = Folder::with("print(\"from the script\")\nshow(sphere(0.8))\n");
    let quiet = folder.good("render scene.star --size 8x8 --quiet");
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    assert!(
        folder
            .good("render scene.star --size 8x8")
            .err
            .contains("from the script")
    );
    assert!(
        folder
            .good("render scene.star --size 8x8 -v")
            .err
            .contains("loaded scene.star")
    );
    assert!(
        folder
            .bad("check none.star -q", 4, &["none.star"])
            .err
            .contains("none.star")
    );
}

#[test]
fn a_failure_leaves_the_old_picture() {
    let folder = Folder::with(BALL);
    folder.good("render scene.star --size 16x16");
    let before = folder.read("scene.png");
    folder.write("scene.star", "show(sphere(0.8)\n");
    folder.bad("render scene.star --size 16x16", 3, &["scene.star"]);
    folder.write("scene.star", BALL);
    folder.bad(
        "render scene.star --size 16x16 --set nothing=1",
        3,
        &["nothing"],
    );
    assert!(folder.read("scene.png") == before);
    assert_eq!(folder.names(), ["scene.png", "scene.star"]);
}

#[cfg(unix)]
mod signals {
    use super::*;
    use std::process::{Child, Command};
    use std::time::{Duration, Instant};

    /// A rendering that takes minutes.
    fn endless(folder: &Folder) -> Child {
        let flags = "render scene.star --size 4000x4000 --limit samples=4096 --march fixed=0.00002 -o a.png";
        folder.write("scene.star", "show(sphere(0.8))\nrender(aa = none())\n");
        folder.command(flags).spawn().unwrap()
    }

    fn signal(child: &Child, name: &str) {
        let killed = Command::new("kill")
            .args(["-s", name, &child.id().to_string()])
            .status()
            .unwrap();
        assert!(killed.success());
    }

    /// Waits until the program has begun: its unfinished file is only there while it writes, so time must do.
    fn begun() {
        std::thread::sleep(Duration::from_millis(400));
    }

    #[test]
    fn ctrl_c_stops_and_leaves_the_old_picture() {
        let folder = Folder::with(BALL);
        folder.write("a.png", "old");
        for name in ["INT", "TERM"] {
            let mut child = endless(&folder);
            begun();
            assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
            signal(&child, name);
            let asked = Instant::now();
            assert_eq!(child.wait().unwrap().code(), Some(130), "{name}");
            assert!(
                asked.elapsed() < Duration::from_secs(5),
                "{name}: it took {:?}",
                asked.elapsed()
            );
            assert_eq!(folder.read("a.png"), b"old");
            assert_eq!(folder.names(), ["a.png", "scene.star"]);
        }
    }

    #[test]
    fn kill_leaves_the_old_picture() {
        let folder = Folder::with(BALL);
        folder.write("a.png", "old");
        let mut child = endless(&folder);
        begun();
        signal(&child, "KILL");
        child.wait().unwrap();
        assert_eq!(folder.read("a.png"), b"old");
    }

    #[test]
    fn a_full_disk_leaves_the_old_picture() {
        let folder = Folder::with(BALL);
        folder.write("a.png", "old");
        let script = format!(
            "trap '' XFSZ; ulimit -f 8; exec {} render scene.star --size 256x256 -o a.png --bits 16",
            env!("CARGO_BIN_EXE_zeroset")
        );
        let output = Command::new("sh")
            .args(["-c", &script])
            .current_dir(folder.path(""))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(4), "{said}");
        assert!(
            said.contains("a.png") && said.contains("limit on file sizes"),
            "{said}"
        );
        assert_eq!(folder.read("a.png"), b"old");
        assert_eq!(folder.names(), ["a.png", "scene.star"]);
    }
}
