//! Every exit code of the help, and colours.

use crate::run::{BALL, Folder};

#[test]
fn every_code_of_the_help_is_one() {
    let folder = Folder::with(BALL);
    folder.write("small.star", "show(sphere())\nrender(size = (8, 8))\n");
    folder.write("wrong.star", "show(spere())\n");
    folder.write("text.star", b"show(\xff)\n");
    folder.write("text.png", "no picture");
    folder.good("render small.star -o a.png");
    folder.good("render small.star -o b.png --size 9x8");
    std::fs::create_dir(folder.path("folder.png")).unwrap();
    let huge = "render scene.star --size 64x64 --time-limit 0.000001";
    let cases: &[(i32, &[&str])] = &[
        (
            0,
            &[
                "check scene.star",
                "render small.star",
                "compare a.png a.png",
                "--help",
                "fields sphere",
            ],
        ),
        (
            1,
            &[
                "compare a.png b.png",
                "render small.star --adapter no-such-adapter",
            ],
        ),
        (
            2,
            &[
                "",
                "rende small.star",
                "render",
                "render small.star --size 0x0",
                "fields spere",
                "man rendr",
                "render small.star -o a.jpg",
            ],
        ),
        (
            3,
            &[
                "check wrong.star",
                "render wrong.star",
                "slice wrong.star",
                "expand wrong.star",
                "export wrong.star --glsl",
                "render small.star --set a=1",
                "check text.star",
                "check scene.star --limit nodes=0.5",
            ],
        ),
        (
            4,
            &[
                "render none.star",
                "check none.star",
                "slice folder.png",
                "render small.star -o none/a.png",
                "render small.star -o folder.png",
                "compare a.png none.png",
                "compare a.png text.png",
                "init a.png",
            ],
        ),
        (5, &[huge]),
    ];
    let help = folder.good("--help").out;
    for (code, commands) in cases {
        assert!(help.contains(&format!("\n  {code:>3}  ")), "{code}");
        for command in *commands {
            let ended = folder.run(command);
            assert_eq!(ended.code, Some(*code), "zeroset {command}\n{}", ended.err);
            assert!(
                *code == 0 || !ended.err.is_empty(),
                "zeroset {command} says nothing"
            );
        }
    }
}

/// As root every file can be read, but not every read gives something.
#[cfg(target_os = "linux")]
#[test]
fn a_scene_that_cannot_be_read_is_no_wrong_scene() {
    let folder = Folder::empty();
    std::os::unix::fs::symlink("/proc/self/mem", folder.path("scene.star")).unwrap();
    std::os::unix::fs::symlink("/proc/self/mem", folder.path("scene.json")).unwrap();
    for command in [
        "render",
        "check",
        "expand",
        "slice",
        "certify",
        "export --wgsl",
        "render --watch",
    ] {
        for name in ["scene.star", "scene.json"] {
            folder.bad(&format!("{command} {name}"), 4, &["cannot read", name]);
        }
    }
    // below a folder that may not be entered
    folder.write("file", "");
    folder.bad("check file/scene.star", 4, &["file/scene.star"]);
}

/// A terminal that a program of util-linux plays.
#[cfg(target_os = "linux")]
#[test]
fn a_dumb_terminal_gets_text() {
    let folder = Folder::with("show(spere(1))\n");
    let said = |command: &str, variables: &[(&str, &str)]| {
        let program = format!("{} {command}", env!("CARGO_BIN_EXE_zeroset"));
        let mut script = std::process::Command::new("script");
        script
            .args(["-qec", &program, "/dev/null"])
            .current_dir(folder.path(""));
        for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "TERM", "CI"] {
            script.env_remove(name);
        }
        let output = script
            .envs(variables.iter().copied())
            .stdin(std::process::Stdio::null())
            .output()
            .ok()?;
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let Some(coloured) = said("check scene.star", &[("TERM", "xterm")]) else {
        return;
    };
    assert!(coloured.contains("\u{1b}["), "{coloured:?}");
    for variable in [("TERM", "dumb"), ("NO_COLOR", "1"), ("CLICOLOR", "0")] {
        let term = if variable.0 == "TERM" {
            variable
        } else {
            ("TERM", "xterm")
        };
        for command in ["check scene.star", "nonsense", "--help", "check --nonsense"] {
            let said = said(command, &[term, variable]).unwrap();
            assert!(
                !said.contains('\u{1b}') && said.len() > 20,
                "{command}, {variable:?}: {said:?}"
            );
        }
    }
    folder.write("scene.star", "show(sphere())\n");
    let said = said("render scene.star --size 400x400", &[("TERM", "dumb")]).unwrap();
    assert!(
        said.contains("scene.png") && !said.contains('\u{1b}'),
        "{said:?}"
    );
}
