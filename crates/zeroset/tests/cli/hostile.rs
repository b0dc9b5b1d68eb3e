//! Scenes from strangers: where their pictures go, and what they can do to a terminal.

use crate::run::{BALL, Ended, Folder};
use std::fs;

/// Names that lead out of a folder.
fn ways_out(folder: &Folder) -> Vec<String> {
    let outside = folder.path("outside");
    vec![
        outside.join("victim").to_string_lossy().into_owned(),
        "../outside/victim".to_owned(),
        "../../outside/victim".to_owned(),
        "..\\outside\\victim".to_owned(),
        "sub/victim".to_owned(),
        "~/victim".to_owned(),
        ".".to_owned(),
        "..".to_owned(),
        String::new(),
        "victim\u{0}".to_owned(),
        "-o".to_owned(),
        "n".repeat(10_000),
    ]
}

/// A scene in JSON that calls itself something.
fn named(folder: &Folder, name: &str) -> Option<String> {
    folder.write("plain.star", BALL);
    let mut scene = folder.good("expand plain.star").json();
    fs::remove_file(folder.path("plain.star")).unwrap();
    scene["name"] = name.into();
    Some(scene.to_string())
}

#[test]
fn a_scene_does_not_choose_where_its_picture_goes() {
    let folder = Folder::empty();
    for name in ["outside", "home", "home/sub"] {
        fs::create_dir(folder.path(name)).unwrap();
    }
    let victims = [
        "outside/victim.png",
        "outside/victim-slice.png",
        "outside/victim-steps.png",
        "home/sub/victim.png",
    ];
    for name in ways_out(&folder) {
        victims
            .iter()
            .for_each(|victim| folder.write(victim, "precious"));
        folder.write("home/scene.json", named(&folder, &name).unwrap());
        for (command, made) in [
            ("render scene.json --size 8x8", Some("scene.png")),
            (
                "render scene.json --size 8x8 --view steps",
                Some("scene-steps.png"),
            ),
            (
                "render scene.json --size 8x8 --frames 3..4",
                Some("scene-0003.png"),
            ),
            ("slice scene.json --size 8x8", Some("scene-slice.png")),
            ("check scene.json", None),
            ("expand scene.json", None),
            ("export scene.json --wgsl", None),
        ] {
            let mut program = folder.command(command);
            let output = program.current_dir(folder.path("home")).output().unwrap();
            // a name may be refused; what counts is where files are
            let ended = output.status.code();
            assert!(
                ended == Some(0) || ended == Some(3),
                "{name:?}: {command}: {output:?}"
            );
            let mut left: Vec<String> = fs::read_dir(folder.path("home"))
                .unwrap()
                .map(|e| e.unwrap().file_name().into_string().unwrap())
                .collect();
            left.sort();
            let mut right = vec!["scene.json", "sub"];
            right.extend(made.filter(|_| ended == Some(0)));
            right.sort_unstable();
            assert_eq!(left, right, "{name:?}: {command}");
            if let (Some(made), Some(0)) = (made, ended) {
                fs::remove_file(folder.path("home").join(made)).unwrap();
            }
        }
        for victim in victims {
            assert_eq!(folder.read(victim), b"precious", "{name:?}");
        }
        assert_eq!(folder.names(), ["home", "outside"], "{name:?}");
    }
}

#[test]
fn names_come_from_the_scene_file() {
    let folder = Folder::empty();
    for (scene, picture) in [
        ("a.b.star", "a.b.png"),
        ("größe.star", "größe.png"),
        ("#7.star", "#7.png"),
    ] {
        folder.write(scene, BALL);
        folder.good(&format!("render {scene} --size 8x8"));
        assert!(folder.names().contains(&picture.to_owned()), "{picture}");
        folder.good(&format!("render {scene} --size 8x8 --frames 0..1"));
        let numbered = picture.replace(".png", "-0000.png");
        assert!(folder.names().contains(&numbered), "{numbered}");
    }
}

/// A scene's folder may hold links to anywhere.
#[cfg(unix)]
#[test]
fn a_name_that_nobody_chose_follows_no_link() {
    let folder = Folder::with(BALL);
    folder.write("precious", "precious");
    for (link, command) in [
        ("scene.png", "render scene.star --size 8x8"),
        ("scene-slice.png", "slice scene.star --size 8x8"),
        (
            "scene-0002.png",
            "render scene.star --size 8x8 --frames 2..3",
        ),
    ] {
        std::os::unix::fs::symlink("precious", folder.path(link)).unwrap();
        folder.bad(command, 4, &[link, "link", "-o"]);
        assert_eq!(folder.read("precious"), b"precious");
    }
    folder.good("render scene.star --size 8x8 -o scene.png");
    assert!(folder.read("precious").starts_with(b"\x89PNG"));
}

/// What does something to a terminal, or to the order of what it shows.
const PLANTED: [&str; 9] = [
    "\u{1b}]0;owned\u{7}",
    "\u{1b}[8mhidden",
    "\u{1b}c",
    "\u{9b}31m",
    "\u{9d}52;c;b3duZWQ=\u{9c}",
    "\u{202e}gnp.\u{2066}x",
    "\u{7f}\u{7f}",
    "back\u{8}\u{8}\u{c}",
    "over\rwritten",
];

fn obeyed(c: char) -> bool {
    (c.is_control() && !matches!(c, '\n' | '\t'))
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{61c}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Without the colours that the program itself uses.
fn plain(text: &str) -> String {
    let mut pieces = text.split("\u{1b}[");
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        match piece.split_once('m') {
            // colours, bold, underlined and back, as clap and miette write them; not what was planted
            Some((codes, rest))
                if codes != "8" && codes.chars().all(|c| c.is_ascii_digit() || c == ';') =>
            {
                out += rest
            }
            _ => out = format!("{out}\u{1b}[{piece}"),
        }
    }
    out
}

#[track_caller]
fn harmless(ended: &Ended, what: &str) {
    for (text, stream) in [(&ended.out, "output"), (&ended.err, "error")] {
        let found = plain(text).chars().find(|c| obeyed(*c));
        assert!(
            found.is_none(),
            "{what}: {found:?} in standard {stream}: {text:?}"
        );
        assert!(
            text.chars().count() < 150_000,
            "{what}: {} characters",
            text.chars().count()
        );
        assert!(!text.contains("panicked"), "{what}: {text}");
    }
}

/// Scenes that let a text through in every way that there is.
fn routes(text: &str) -> Vec<String> {
    let quoted = format!("\"{text}\"");
    vec![
        format!("print({quoted})\nshow(sphere(0.8))\n"),
        format!("fail({quoted})\n"),
        format!("show(sphere(0.8), name = {quoted})\n"),
        format!("show(sphere(0.8) + mandelbulb(), name = {quoted})\n"),
        format!("show(sphere(0.8), {quoted})\n"),
        format!("show(sphere(0.8), color = {quoted})\n"),
        format!("x = {{}}\nshow(x[{quoted}])\n"),
        format!("show(sphere(0.8), **{{{quoted}: 1}})\n"),
        format!("show(sphere(**{{{quoted}: 1}}))\n"),
        format!("r = slider({quoted}, 0.5)\nshow(sphere(r))\n"),
        format!("r = choice({quoted}, [{quoted}, \"b\"])\nshow(sphere(0.8))\n"),
        format!("r = choice(\"style\", [{quoted}, \"b\"])\nshow(sphere(0.8))\n"),
        format!("load({quoted}, \"x\")\n"),
        format!("load(\"part.star\", {quoted})\n"),
        format!("show(image({quoted}))\n"),
        format!("show(sphere(0.8)) # {text}\nshow(spere())\n"),
        format!("show(spere()) # {text}\n"),
        format!("{text}\n"),
        format!("show(sphere(0.8))\n{text} = 1\n"),
        format!("{quoted} + 1\n"),
        format!("sphere(0.8).{text}()\n"),
        format!("render(size = {quoted})\n"),
        format!("render(march = {quoted})\n"),
        format!("show(text({quoted}, 1, 0.2))\n"),
        format!("int({quoted})\n"),
        format!("{quoted}.format({quoted})\n"),
        format!("[1, 2][{quoted}]\n"),
        format!("def f():\n  fail({quoted})\nf()\n"),
    ]
}

#[test]
fn nothing_that_a_script_says_reaches_a_terminal() {
    let all = PLANTED.concat();
    let folder = Folder::empty();
    folder.write("part.star", "x = 1\n");
    let check = |scene: &str, commands: &[&str]| {
        folder.write("scene.star", scene);
        for command in commands {
            harmless(&folder.run(command), &format!("{command}: {scene:?}"));
        }
    };
    for scene in routes(&all) {
        check(&scene, &["check scene.star --color always"]);
    }
    // each command has its own words
    let commands = [
        "check scene.star --json",
        "render scene.star --size 4x4 -v",
        "slice scene.star --size 4x4",
        "why scene.star 1 1 --size 4x4",
        "why scene.star 1 1 --size 4x4 --json",
        "certify scene.star --size 4x4",
        "expand scene.star",
        "export scene.star --glsl",
    ];
    for scene in routes(&all).iter().take(6) {
        check(scene, &commands);
    }
    for planted in PLANTED {
        for scene in routes(planted).iter().take(3) {
            check(scene, &["check scene.star"]);
        }
    }
}

#[test]
fn nothing_that_json_says_reaches_a_terminal() {
    let folder = Folder::empty();
    folder.write("plain.star", "show(sphere(0.8), \"red\", name = \"planted-name\")\nshow(box(1.0).paint(material(\"blue\")))\n");
    let text = folder.good("expand plain.star").out;
    for planted in PLANTED {
        let escaped = serde_json::to_string(planted).unwrap();
        let inner = &escaped[1..escaped.len() - 1];
        let scene: serde_json::Value = serde_json::from_str(&text).unwrap();
        let mut versions = vec![
            text.replace("planted-name", inner),
            format!("{{\"{inner}\": 1}}"),
            format!("[\"{inner}\"]"),
            format!("{planted}{text}"),
            text.replacen(':', &format!(": \"{inner}\","), 1),
        ];
        for key in scene.as_object().unwrap().keys() {
            let mut other = scene.clone();
            other[key] = planted.into();
            versions.push(other.to_string());
            other[key] = serde_json::json!({ planted: planted });
            versions.push(other.to_string());
            other[key] = serde_json::json!([{ planted: planted }]);
            versions.push(other.to_string());
        }
        for version in versions {
            folder.write("scene.json", &version);
            for command in ["check scene.json --color always", "expand scene.json"] {
                harmless(&folder.run(command), &format!("{command}: {version:?}"));
            }
        }
    }
}

#[test]
fn nothing_that_an_argument_says_reaches_a_terminal() {
    let folder =
        Folder::with("r = slider(\"r\", 0.5)\nc = color(\"c\", \"red\")\nshow(sphere(r), c)\n");
    for planted in PLANTED {
        let set = [
            format!("{planted}=1"),
            format!("r={planted}"),
            format!("c={planted}"),
            planted.to_owned(),
        ];
        for set in &set {
            for colour in ["always", "auto"] {
                let mut command = folder.command("check scene.star");
                let output = command
                    .args(["--set", set, "--color", colour])
                    .output()
                    .unwrap();
                harmless(&ended(output), &format!("--set {set:?}"));
            }
        }
        for flags in [
            ["--limit", planted],
            ["--limit", &format!("{planted}=1")],
            ["--limit", &format!("pixels={planted}")],
        ] {
            harmless(
                &ended(
                    folder
                        .command("check scene.star")
                        .args(flags)
                        .output()
                        .unwrap(),
                ),
                "--limit",
            );
        }
        for (command, flag) in [
            ("render scene.star", "--size"),
            ("render scene.star", "--view"),
            ("render scene.star", "--march"),
            ("render scene.star", "--adapter"),
            ("render scene.star", "-o"),
            ("render scene.star", "--"),
            ("render scene.star", planted),
            ("slice scene.star", "--plane"),
            ("fields", "--"),
            ("man", "--"),
            ("completions", "--"),
            ("compare a.png", "--"),
            ("init scene.star", "--"),
        ] {
            let output = folder
                .command(command)
                .args([flag, planted, "--color", "always"])
                .output()
                .unwrap();
            harmless(&ended(output), &format!("{command} {flag} {planted:?}"));
        }
        harmless(
            &ended(folder.command("").arg(planted).output().unwrap()),
            planted,
        );
    }
}

#[cfg(unix)]
#[test]
fn nothing_that_a_file_is_called_reaches_a_terminal() {
    for planted in PLANTED {
        let folder = Folder::empty();
        for (ending, text) in [
            ("star", BALL),
            ("star", "show(spere())\n"),
            ("json", "{}"),
            ("txt", ""),
        ] {
            let name = format!("{planted}.{ending}");
            folder.write(&name, text);
            for command in [
                "check",
                "render --size 4x4",
                "slice --size 4x4",
                "expand",
                "export --wgsl",
                "init",
            ] {
                let output = folder
                    .command(command)
                    .args([&name, "--color", "always"])
                    .output()
                    .unwrap();
                harmless(&ended(output), &format!("{command} {name:?}"));
            }
            let mut folder_of_it = folder.command("render --size 4x4");
            let missing = format!("{planted}/{name}");
            harmless(
                &ended(
                    folder_of_it
                        .args([&missing, "-o", &missing])
                        .output()
                        .unwrap(),
                ),
                &missing,
            );
        }
        // and the files that are made have ordinary names
        for name in folder.names().iter().filter(|name| name.ends_with(".png")) {
            assert!(!name.contains(obeyed), "{name:?}");
        }
        let bytes = std::os::unix::ffi::OsStringExt::from_vec(b"\x9b31m\xff.star".to_vec());
        let bytes: std::ffi::OsString = bytes;
        harmless(
            &ended(folder.command("check").arg(&bytes).output().unwrap()),
            "bytes",
        );
    }
}

#[test]
fn texts_without_end_are_cut() {
    let folder = Folder::empty();
    let long = "x".repeat(1 << 20);
    for scene in [
        "print(\"x\" * 1000000)\nshow(sphere())\n".to_owned(),
        "[print(i) for i in range(100000)]\nshow(sphere())\n".to_owned(),
        "print(\"x\\n\" * 100000)\nshow(sphere())\n".to_owned(),
        "fail(\"x\" * 1000000)\n".to_owned(),
        "show(sphere(), name = \"x\" * 1000000)\n".to_owned(),
        "show(sphere(), color = \"x\" * 1000000)\n".to_owned(),
        "slider(\"x\" * 1000000, 1)\nshow(sphere())\n".to_owned(),
        "choice(\"c\", [\"x\" * 1000000])\nshow(sphere())\n".to_owned(),
        "{}[\"x\" * 1000000]\n".to_owned(),
        format!("{long}\n"),
        format!("show(spere()) # {long}\n"),
        format!("# {long}\nshow(spere())\n# {long}\n"),
        format!("show(\"{long}\" + 1)\n"),
        format!("load(\"{long}\", \"a\")\n"),
    ] {
        folder.write("scene.star", &scene);
        for command in [
            "check scene.star",
            "render scene.star --size 4x4",
            "check scene.star --color always",
        ] {
            harmless(
                &folder.run(command),
                &format!("{command}: {}", scene.chars().take(40).collect::<String>()),
            );
        }
    }
    let name = folder
        .command("check scene.star")
        .args(["--set", &format!("{}=1", &long[..100_000])])
        .output()
        .unwrap();
    harmless(&ended(name), "--set");
    folder.write("scene.json", named(&folder, &long).unwrap());
    for command in [
        "check scene.json",
        "render scene.json --size 4x4",
        "slice scene.json --size 4x4",
    ] {
        harmless(&folder.run(command), command);
    }
}

#[test]
fn what_a_picture_says_of_itself_is_clean() {
    for planted in PLANTED {
        let folder = Folder::with(BALL);
        folder.write("scene.json", named(&folder, planted).unwrap());
        for name in ["a.png", "a.exr"] {
            let ended = folder.run(&format!("render scene.json --size 8x8 -o {name}"));
            if ended.code == Some(3) {
                continue;
            }
            let bytes = folder.read(name);
            let held = bytes
                .windows(planted.len())
                .any(|w| w == planted.as_bytes());
            assert!(!held, "{planted:?} in {name}");
        }
        let output = folder
            .command("export scene.json --wgsl -o a.wgsl")
            .output()
            .unwrap();
        if output.status.success() {
            let text = String::from_utf8(folder.read("a.wgsl")).unwrap();
            assert!(!text.contains(obeyed));
        }
    }
}

/// Text that is no UTF-8 is a control too: C1 in other codings.
fn ended(output: std::process::Output) -> Ended {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended {
        code: output.status.code(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}
