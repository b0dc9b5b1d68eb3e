//! Files that are no ordinary files, or no text: each is refused at once, with what is wrong.

use measure::{BYTES, SECONDS, alone, peak_memory, timed};
use std::path::Path;
use tempfile::TempDir;
use zeroset_language::limits::Limits;
use zeroset_language::load::{Options, load};

mod measure;

fn error(path: &Path) -> String {
    let (loaded, seconds) = timed(|| load(path, &Options::default()));
    let failed = loaded.expect_err(&path.display().to_string());
    assert!(seconds < SECONDS, "{}: {seconds:.2} s", path.display());
    if let Some(peak) = peak_memory() {
        assert!(peak < BYTES, "{}: {} MiB", path.display(), peak >> 20);
    }
    let message = failed.report.message().to_string();
    assert!(
        message.chars().count() < 1100,
        "{} characters",
        message.chars().count()
    );
    message
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// What a scene with these bytes is refused for.
fn error_of(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let folder = folder();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    error(&path)
}

#[test]
fn scenes_that_are_no_files() {
    let _alone = alone();
    let folder = folder();
    for name in ["a.star", "a.json", "no/such/a.star"] {
        assert!(error(&folder.path().join(name)).contains("there is no file"));
    }
    std::fs::create_dir(folder.path().join("d.star")).unwrap();
    assert!(error(&folder.path().join("d.star")).contains("ordinary"));
    assert!(error(&folder.path().join("d.star/a.json")).contains("there is no file"));
    for name in ["a", "a.txt", "a.star.", ""] {
        assert!(
            error(&folder.path().join(name)).contains(".star or .json"),
            "{name}"
        );
    }
    assert!(
        error(&folder.path().join(format!("{}.star", "a".repeat(5000)))).contains("cannot be read")
    );
}

#[cfg(unix)]
#[test]
fn pipes_and_devices() {
    let _alone = alone();
    use std::os::unix::fs::symlink;
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let pipe = std::process::Command::new("mkfifo")
        .arg(at("pipe.star"))
        .arg(at("pipe.png"))
        .arg(at("pipe.ttf"))
        .status();
    assert!(
        pipe.is_ok_and(|s| s.success()),
        "mkfifo is part of every Unix"
    );
    symlink("/dev/zero", at("zero.json")).unwrap();
    symlink("/dev/zero", at("zero.png")).unwrap();
    symlink("loop.star", at("loop.star")).unwrap();
    symlink("nowhere.star", at("dangling.star")).unwrap();
    assert!(error(&at("pipe.star")).contains("ordinary"));
    assert!(error(&at("zero.json")).contains("ordinary"));
    assert!(error(&at("loop.star")).contains("cannot be read"));
    assert!(error(&at("dangling.star")).contains("there is no file"));
    for (script, says) in [
        ("load(\"pipe.star\", \"x\")", "ordinary"),
        ("load(\"loop.star\", \"x\")", "cannot be read"),
        ("load(\"dangling.star\", \"x\")", "there is no file"),
        ("load(\"/dev/zero\", \"x\")", "outside"),
        ("load(\"/etc/passwd.star\", \"x\")", "outside"),
        ("load(\"../a.star\", \"x\")", "outside"),
        ("load(\"a/../../a.star\", \"x\")", "outside"),
        ("load(\"..\", \"x\")", "outside"),
        ("load(\"a\\\\b.star\", \"x\")", "outside"),
        ("load(\"\", \"x\")", "outside"),
        (
            "show(sphere(), material(color = triplanar(\"pipe.png\")))",
            "ordinary",
        ),
        (
            "show(sphere(), material(color = triplanar(\"zero.png\")))",
            "outside",
        ),
        (
            "show(sphere(), material(color = triplanar(\"/dev/zero\")))",
            "outside",
        ),
        (
            "show(sphere(), material(color = triplanar(\".\")))",
            "outside",
        ),
        (
            "show(sphere(), material(color = triplanar(\"sub\")))",
            "ordinary",
        ),
        ("show(text(\"a\", font = \"pipe.ttf\"))", "ordinary"),
        ("show(text(\"a\", font = \"/dev/zero\"))", "outside"),
    ] {
        std::fs::create_dir_all(at("sub")).unwrap();
        std::fs::write(at("main.star"), script).unwrap();
        let message = error(&at("main.star"));
        assert!(message.contains(says), "{script}: {message}");
    }
    for path in [
        "/dev/zero",
        "pipe.png",
        "../x.png",
        "zero.png",
        "",
        "a\\u0000b",
    ] {
        let json = format!(
            r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{}}}}}}], "materials": [{{"pattern": {{"kind": "triplanar", "image": {{"path": "{path}"}}, "size": 1, "sharpness": 4}}, "specular": 0, "shininess": 10, "metallic": 0, "roughness": 1, "emission": [0, 0, 0]}}]}}"#
        );
        std::fs::write(at("main.json"), json).unwrap();
        let message = error(&at("main.json"));
        assert!(
            message.contains("outside") || message.contains("ordinary"),
            "{path}: {message}"
        );
    }
    // a file of the system that says it is empty and is not
    if Path::new("/proc/self/status").exists() {
        symlink("/proc/self/status", at("status.star")).unwrap();
        assert!(!error(&at("status.star")).is_empty());
    }
}

/// A file that grows while it is read ends at its limit.
#[test]
fn a_file_that_grows() {
    let _alone = alone();
    use std::io::Write;
    use std::sync::atomic::{AtomicBool, Ordering};
    let folder = folder();
    let path = folder.path().join("grows.star");
    std::fs::write(&path, "").unwrap();
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let mut file = std::fs::OpenOptions::new()
                .append(true)
                .open(&path)
                .unwrap();
            let mut written = 0;
            while !done.load(Ordering::Relaxed) && written < 256 << 20 {
                let _ = file.write_all(&[b'#'; 1 << 16]);
                written += 1 << 16;
            }
        });
        for _ in 0..5 {
            let limits = Limits {
                file_bytes: 1 << 20,
                ..Limits::default()
            };
            let options = Options {
                limits,
                ..Options::default()
            };
            let (loaded, seconds) = timed(|| load(&path, &options));
            assert!(seconds < SECONDS, "{}", loaded.unwrap_err().report);
        }
        done.store(true, Ordering::Relaxed);
    });
    assert!(error(&path).len() < 1100);
}

#[test]
fn files_that_are_no_text() {
    let _alone = alone();
    for name in ["a.star", "a.json"] {
        let message = error_of(name, b"{\n  \"a\": \"\xff\"}");
        assert!(
            message.contains("UTF-8") && message.contains("byte 11, in line 2"),
            "{message}"
        );
        let message = error_of(name, b"\xff\xfes\0h\0o\0w\0");
        assert!(message.contains("UTF-16"), "{message}");
        // a surrogate, an overlong slash, a character cut in two
        for bytes in [
            &b"\"\xed\xa0\x80\""[..],
            b"\"\xc0\xaf\"",
            b"\"\xf0\x9d\x84\"",
        ] {
            assert!(error_of(name, bytes).contains("UTF-8"));
        }
        assert!(!error_of(name, "").is_empty());
        assert!(!error_of(name, "\0").is_empty());
        assert!(!error_of(name, "\u{feff}").is_empty());
    }
    assert!(error_of("a.json", "  \n").contains("empty"));
}

#[test]
fn a_byte_order_mark_is_skipped() {
    let _alone = alone();
    let folder = folder();
    let path = folder.path().join("mark.json");
    let json = "{\"zeroset\": 1, \"objects\": [{\"field\": {\"sphere\": {}}}]}";
    std::fs::write(&path, format!("\u{feff}{json}")).unwrap();
    let loaded = load(&path, &Options::default()).unwrap();
    let place = loaded.scene.objects()[0].place.clone().unwrap();
    let column = json.find("{\"field").unwrap() as u32 + 1;
    assert_eq!((place.1, place.2), (1, column));
    // a second one is no mark: it stands where a value should
    std::fs::write(&path, format!("\u{feff}\u{feff}{json}")).unwrap();
    assert!(!error(&path).is_empty());
}

/// Numbers that JSON or a scene cannot hold, each at its place.
#[test]
fn numbers_that_are_none() {
    let _alone = alone();
    let scene = |radius: &str| {
        format!(
            "{{\"zeroset\": 1, \"objects\": [{{\"field\": {{\"sphere\": {{\"radius\": {radius}}}}}}}]}}"
        )
    };
    for (radius, says) in [
        ("NaN", "there is no NaN"),
        ("Infinity", "there is no NaN"),
        ("-Infinity", "JSON"),
        ("1e400", "largest number"),
        ("-1e400", "largest number"),
        ("1e99999999999999999999", "largest number"),
        (&"9".repeat(400), "largest number"),
        (&"9".repeat(300), "allowed is"),
        ("123456789012345678901234567890", "allowed is"),
        ("-0.0", "allowed is"),
        ("1e-400", "allowed is"),
        ("null", "number"),
        ("\"1\"", "number"),
        ("[1]", "number"),
        ("0x10", "JSON"),
        ("+1", "JSON"),
        ("1.", "JSON"),
        ("\"\\ud800\"", "JSON"),
        ("\"\\udc00\\ud800\"", "JSON"),
        ("\"\\u12\"", "JSON"),
        ("\"\u{7}\"", "JSON"),
    ] {
        let folder = folder();
        let path = folder.path().join("a.json");
        std::fs::write(&path, scene(radius)).unwrap();
        let failed = load(&path, &Options::default()).expect_err(radius);
        let shown = format!("{:?}", miette::Report::new(*failed.report.clone()));
        let says_so = failed.report.message().contains(says)
            || failed.report.hint().is_some_and(|h| h.contains(says));
        assert!(says_so, "{radius}: {shown}");
        assert!(failed.report.position().is_some(), "{radius}: {shown}");
    }
    for (what, says) in [
        (
            r#""objects": [{"field": {"sphere": {}}, "material": -1}]"#,
            "objects[0].material",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}, "material": 1.5}]"#,
            "objects[0].material",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}, "material": 18446744073709551616}]"#,
            "objects[0].material",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "camera": {"eye": [1e39, 0, 0]}"#,
            "camera.eye",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "camera": {"far": 1e39}"#,
            "camera.far",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "camera": {"near": -1}"#,
            "camera.near",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "camera": {"near": 5, "far": 5}"#,
            "near",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "sky": {"ambient": 1e308}"#,
            "sky.ambient",
        ),
        (
            r#""objects": [{"field": {"place": {"offset": [0, 1e308, 0], "of": {"sphere": {}}}}}]"#,
            "objects[0].field.place.offset",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "settings": {"exposure": 1e39}"#,
            "settings.exposure",
        ),
        (
            r#""objects": [{"field": {"sphere": {}}}], "settings": {"size": [0, 1]}"#,
            "settings.size",
        ),
    ] {
        let message = error_of("a.json", format!("{{\"zeroset\": 1, {what}}}"));
        assert!(message.contains(says), "{what}: {message}");
    }
}

/// A title is a title: it may look like a path, and names no file.
#[test]
fn titles() {
    let _alone = alone();
    let folder = folder();
    let path = folder.path().join("a b.json");
    for (title, right) in [
        (r#""name": "/etc/passwd", "#, "/etc/passwd"),
        (r#""name": "../up", "#, "../up"),
        ("", "a b"),
    ] {
        std::fs::write(
            &path,
            format!(
                "{{\"zeroset\": 1, {title}\"objects\": [{{\"field\": {{\"sphere\": {{}}}}}}]}}"
            ),
        )
        .unwrap();
        assert_eq!(
            load(&path, &Options::default()).unwrap().scene.name(),
            right
        );
        assert_eq!(zeroset_language::naming::default_stem(&path), "a b");
    }
    let long = "é".repeat(201);
    let message = error_of(
        "a.json",
        format!("{{\"zeroset\": 1, \"name\": \"{long}\"}}"),
    );
    assert!(
        message.contains("a name of 201 characters") && message.contains("limit `name`"),
        "{message}"
    );
}

/// Names of a megabyte are refused or cut, wherever they stand.
#[test]
fn long_names() {
    let _alone = alone();
    let long = "n".repeat(1 << 20);
    let sphere = r#"{"field": {"sphere": {}}}"#;
    for json in [
        format!(
            r#"{{"zeroset": 1, "objects": [{{"name": "{long}", "field": {{"sphere": {{}}}}}}]}}"#
        ),
        format!(r#"{{"zeroset": 1, "{long}": 1}}"#),
        format!(r#"{{"zeroset": 1, "objects": [{{"field": {{"{long}": {{}}}}}}]}}"#),
        format!(r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{"{long}": 1}}}}}}]}}"#),
        format!(r#"{{"zeroset": 1, "objects": [{sphere}], "sky": {{"top": "{long}"}}}}"#),
        format!(r#"{{"zeroset": 1, "objects": [{sphere}], "settings": {{"normals": "{long}"}}}}"#),
        format!(r#"{{"zeroset": 1, "objects": [{sphere}], "settings": {{"{long}": 1}}}}"#),
        format!(r#"{{"zeroset": 1, "{long}": 1, "{long}": 1}}"#),
        format!(
            r#"{{"zeroset": 1, "objects": [{sphere}], "materials": [{{"pattern": {{"kind": "triplanar", "image": {{"path": "{long}"}}, "size": 1, "sharpness": 4}}, "specular": 0, "shininess": 10, "metallic": 0, "roughness": 1, "emission": [0, 0, 0]}}]}}"#
        ),
    ] {
        let message = error_of("a.json", &json);
        assert!(message.chars().count() < 1100, "{}", &message[..200]);
    }
    for star in [
        format!("show(sphere(), name = \"{long}\")"),
        format!("slider(\"{long}\", 1)\nshow(sphere())"),
        format!("fail(\"{long}\")"),
        format!("load(\"{long}.star\", \"x\")"),
        format!("show(sphere(), material(color = triplanar(\"{long}\")))"),
        format!("show(sphere(), material(color = \"{long}\"))"),
        format!("show(sphere({long} = 1))"),
        format!("show({long}())"),
        format!("show(sphere().{long}())"),
        format!("x = {{}}\nx[\"{long}\"]"),
    ] {
        let message = error_of("a.star", &star);
        assert!(message.chars().count() < 1100, "{}", &message[..200]);
    }
    let folder = folder();
    let path = folder.path().join("log.star");
    std::fs::write(
        &path,
        format!("x = \"{long}\"\nfor i in range(20):\n    print(x)\nshow(sphere())"),
    )
    .unwrap();
    let log = load(&path, &Options::default()).unwrap().log;
    assert!(log.len() == 20 && log.iter().all(|line| line.chars().count() < 2100));
}
