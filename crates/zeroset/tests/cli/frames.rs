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
    // the folder is made
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

#[test]
fn frames_become_one_file() {
    let folder = Folder::with(MOVING);
    let run = "render scene.star --size 24x16 --frames 0..3 --fps 10";
    for (name, magic) in [
        ("a.gif", &b"GIF89a"[..]),
        ("b.apng", b"\x89PNG"),
        ("c.y4m", b"YUV4MPEG2 W24 H16 F10:1 "),
    ] {
        let ended = folder.good(&format!("{run} -o films/{name}"));
        assert!(ended.err.contains("3 frames, 0.30 s long"), "{}", ended.err);
        assert!(
            folder.read(&format!("films/{name}")).starts_with(magic),
            "{name}"
        );
    }
    // what comes from a pipe is what a file has
    let piped = folder.command(&format!("{run} -o -")).output().unwrap();
    assert!(piped.status.success());
    assert_eq!(piped.stdout, folder.read("films/c.y4m"));
    // the animated PNG has the pictures that are rendered one by one
    folder.good(&format!("{run} -o f##.png"));
    let first = png::Decoder::new(std::io::Cursor::new(folder.read("films/b.apng")));
    let mut first = first.read_info().unwrap();
    let mut pixels = vec![0; first.output_buffer_size().unwrap()];
    first.next_frame(&mut pixels).unwrap();
    let mut alone = png::Decoder::new(std::io::Cursor::new(folder.read("f00.png")))
        .read_info()
        .unwrap();
    let mut right = vec![0; alone.output_buffer_size().unwrap()];
    alone.next_frame(&mut right).unwrap();
    assert_eq!(pixels, right);
}

#[test]
fn animations_that_cannot_be_are_refused() {
    let folder = Folder::with(MOVING);
    folder.write("kept.gif", "as it was");
    for (flags, code, words) in [
        ("-o kept.gif", 2, ["kept.gif is an animation", "--frames"]),
        (
            "-o kept.gif --frames 0..3 --fps 60",
            2,
            ["60", "at most 50"],
        ),
        (
            "-o kept.gif --frames 0..3000 --limit memory=2000000",
            2,
            ["memory", "--limit memory"],
        ),
        (
            "-o - --frames 0..2 --json",
            2,
            ["standard output", "--json"],
        ),
    ] {
        folder.bad(
            &format!("render scene.star --size 24x16 {flags}"),
            code,
            &words,
        );
    }
    assert_eq!(folder.read("kept.gif"), b"as it was");
    assert_eq!(folder.names(), ["kept.gif", "scene.star"]);
}

/// A stand-in for ffmpeg: it counts the bytes that it is given, and writes a line as the video.
#[cfg(unix)]
#[test]
fn videos_are_written_by_ffmpeg() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::with(MOVING);
    let run = "render scene.star --size 24x16 --frames 0..3 -o film.mp4";
    let with = |path: &str| {
        let output = folder.command(run).env("PATH", path).output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
        )
    };
    let (code, said) = with("/nonexistent");
    assert_eq!(code, Some(1));
    assert!(
        said.contains("ffmpeg") && said.contains("not") && said.contains(".gif"),
        "{said}"
    );
    assert_eq!(folder.names(), ["scene.star"]);
    std::fs::create_dir(folder.path("bin")).unwrap();
    let program = |text: &str| {
        folder.write("bin/ffmpeg", text);
        let can_run = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(folder.path("bin/ffmpeg"), can_run).unwrap();
    };
    let path = format!("{}:/usr/bin:/bin", folder.path("bin").display());
    program(
        "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nfor last; do :; done\nwc -c > \"$last\"\n",
    );
    assert_eq!(with(&path).0, Some(0));
    let video = String::from_utf8(folder.read("film.mp4")).unwrap();
    assert_eq!(video.trim(), (3 * 3 * 24 * 16).to_string());
    program(
        "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\ncat > /dev/null\necho Unknown encoder >&2\nexit 1\n",
    );
    let (code, said) = with(&path);
    assert!(
        code == Some(1) && said.contains("Unknown encoder"),
        "{said}"
    );
    // what was there is whole
    assert_eq!(String::from_utf8(folder.read("film.mp4")).unwrap(), video);
}
