//! Wrong command lines, missing files, help.

use crate::run::{BALL, Folder};

#[test]
fn help_and_version_are_results() {
    let folder = Folder::empty();
    let help = folder.good("--help");
    assert!(help.out.contains("Exit codes:") && help.out.contains("130") && help.err.is_empty());
    for command in [
        "render",
        "check",
        "expand",
        "fields",
        "slice",
        "compare",
        "init",
        "completions",
        "man",
    ] {
        assert!(help.out.contains(command), "{command}");
        assert!(
            folder
                .good(&format!("{command} --help"))
                .out
                .contains("Usage: zeroset"),
            "{command}"
        );
    }
    assert!(folder.good("--version").out.starts_with("zeroset "));
}

#[test]
fn no_command_prints_help_and_is_no_success() {
    let ended = Folder::empty().run("");
    assert_eq!(ended.code, Some(2));
    assert!(ended.err.contains("Usage: zeroset") && ended.out.is_empty());
}

#[cfg(not(feature = "window"))]
#[test]
fn a_scene_without_a_command_names_the_command() {
    let folder = Folder::with(BALL);
    let says = ["zeroset render scene.star", "--features window"];
    folder.bad("scene.star", 2, &says);
    folder.bad("some.json", 2, &["zeroset render some.json"]);
    folder.bad(
        "view scene.star",
        2,
        &["without the window", "--features window"],
    );
    folder.bad("gpu", 2, &["without the gpu", "--features gpu"]);
    let shaders = ["without the shaders", "--features shaders"];
    folder.bad("export scene.star --wgsl", 2, &shaders);
    folder.bad("rende", 2, &["render"]);
}

/// Without a screen, so that no window opens.
#[cfg(all(feature = "window", target_os = "linux"))]
#[test]
fn a_scene_without_a_command_is_viewed() {
    let folder = Folder::with(BALL);
    folder.bad("rende", 2, &["render"]);
    folder.bad("none.star", 4, &["none.star"]);
    for arguments in [
        "scene.star",
        "--color never scene.star --time 2",
        "view scene.star",
    ] {
        let mut command = folder.command(arguments);
        for screen in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(screen);
        }
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments}: {said}");
        assert!(
            said.contains("no screen") && said.contains("zeroset render"),
            "{said}"
        );
    }
}

#[test]
fn values_that_cannot_be_are_refused_with_what_is_allowed() {
    let folder = Folder::with(BALL);
    let cases: &[(&str, &[&str])] = &[
        ("--size 0x0", &["--size", "at least 1 pixel"]),
        ("--size 64", &["width x height"]),
        ("--size -3x5", &["unexpected argument"]),
        (
            "--size 1000000000x1000000000",
            &["1000000000x1000000000", "pixels", "--limit pixels"],
        ),
        ("--size 4294967295x4294967295", &["pixels"]),
        (
            "--view nothing",
            &["colour", "coverage", "steps", "residual", "object"],
        ),
        ("--view step", &["steps"]),
        (
            "--march leap",
            &["auto, enhanced, relaxed, sphere and fixed"],
        ),
        ("--march relaxed=2", &["omega is 2", "1 to below 2"]),
        ("--march auto=0", &["beta is 0", "above 0 to 1"]),
        ("--march enhanced=1", &["share is 1", "0 to below 1"]),
        ("--ao cones,step=3", &["has no `step`", "reach, steps"]),
        (
            "--ao hemisphere=9999",
            &["`rays` of --ao is 9999", "1 to 4096", "--limit samples"],
        ),
        ("--aa supersample,filter=round", &["tent, mitchell, box"]),
        ("--normals 26", &["samples18", "samples26"]),
        ("--bits 12", &["8, 16"]),
        ("--threads 0", &["1..=1024"]),
        ("--time soon", &["number of seconds"]),
        ("--time inf", &["number of seconds"]),
        ("--frames 3", &["first..end"]),
        ("--frames 5..5", &["no frame"]),
        ("--frames 0..3 --fps 0", &["above 0"]),
        ("--fps 10", &["--frames"]),
        ("--frames 0..3 --watch", &["cannot be used with"]),
        ("--set bite", &["NAME=VALUE"]),
        ("--set a=1 --set a=2", &["`a` is set twice"]),
        ("--limit ink=3", &["there is no limit `ink`", "pixels"]),
        ("--limit pixels=none", &["`pixels`", "none"]),
        ("-o picture.jpg", &[".png", ".exr"]),
        ("-o picture", &[".png"]),
        ("-o planes.exr --view steps", &["holds all planes"]),
        ("--colour never", &["--color"]),
        ("--quiet --verbose", &["cannot be used with"]),
    ];
    for (flags, words) in cases {
        folder.bad(&format!("render scene.star {flags}"), 2, words);
    }
    assert_eq!(folder.names(), ["scene.star"]);
}

#[test]
fn files_that_cannot_be_are_named() {
    let folder = Folder::with(BALL);
    std::fs::create_dir(folder.path("folder.star")).unwrap();
    for command in ["render", "check", "expand", "slice", "render --watch"] {
        folder.bad(&format!("{command} none.star"), 4, &["none.star"]);
        folder.bad(
            &format!("{command} folder.star"),
            4,
            &["folder.star", "not a regular file"],
        );
        folder.bad(&format!("{command} /dev/zero"), 4, &["not a regular file"]);
    }
    folder.bad(
        "render scene.star --size 8x8 -o none/a.png",
        4,
        &["none/a.png", "does not exist"],
    );
    folder.bad("render scene.star --size 8x8 -o folder.star", 2, &[".png"]);
    std::fs::create_dir(folder.path("a.png")).unwrap();
    folder.bad(
        "render scene.star --size 8x8 -o a.png",
        4,
        &["a.png", "it is a folder"],
    );
    folder.bad(
        "slice scene.star --size 8x8 -o a.png",
        4,
        &["it is a folder"],
    );
    folder.bad("expand scene.star -o a.png", 4, &["it is a folder"]);
    assert_eq!(folder.names(), ["a.png", "folder.star", "scene.star"]);
}

#[test]
fn init_makes_a_scene_and_replaces_nothing() {
    let folder = Folder::empty();
    folder.good("init new/deep");
    folder.good("render new/deep/scene.star --size 32x24 -o first.png");
    folder.write("new/deep/scene.star", "mine");
    folder.bad("init new/deep", 4, &["scene.star", "exists already"]);
    assert_eq!(folder.read("new/deep/scene.star"), b"mine");
    folder.write("file", "");
    folder.bad("init file", 4, &["file"]);
}

#[test]
fn completions_and_manual_pages_are_made() {
    let folder = Folder::empty();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(
            folder
                .good(&format!("completions {shell}"))
                .out
                .contains("zeroset"),
            "{shell}"
        );
    }
    folder.bad("completions csh", 2, &["bash"]);
    assert!(folder.good("man").out.contains(".TH zeroset"));
    assert!(folder.good("man render").out.contains("frames"));
    folder.bad("man rendr", 2, &["there is no command `rendr`", "render"]);
}

#[test]
fn colours_come_when_asked_for() {
    let folder = Folder::with("show(spere(1))\n");
    let escape = "\u{1b}[";
    assert!(!folder.run("check scene.star").err.contains(escape));
    assert!(
        folder
            .run("check scene.star --color always")
            .err
            .contains(escape)
    );
    assert!(
        !folder
            .run("--color=never check scene.star")
            .err
            .contains(escape)
    );
    assert!(folder.run("--color always nonsense").err.contains(escape));
    assert!(
        folder
            .run("--color=always fields")
            .out
            .find(escape)
            .is_none()
    );
}

#[test]
fn a_reader_that_has_read_enough_is_no_error() {
    use std::io::Read;
    let folder = Folder::empty();
    let mut child = folder.command("fields --json").spawn().unwrap();
    let mut first = [0; 1];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(output.stderr.is_empty());
}
