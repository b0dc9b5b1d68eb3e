//! Files from strangers: every one ends in an error within two seconds and 512 MiB.

use measure::{BYTES, SECONDS, alone, peak_memory, timed};
use std::fmt::Write;
use std::path::Path;
use zeroset_language::limits::Limits;
use zeroset_language::load::{Language, Options, load, load_text};

mod measure;

/// Scripts that try to take more, and something that the answer says.
fn scripts() -> Vec<(&'static str, String, &'static str)> {
    let s = |text: &str| text.to_string();
    vec![
        (
            "nested ranges",
            s("for i in range(1000000):\n    for j in range(1000000):\n        pass"),
            "steps",
        ),
        (
            "nested comprehension",
            s("x = [1 for a in range(10000) for b in range(10000) for c in range(10000)]"),
            "",
        ),
        ("a long text", s("x = \"x\" * 1000000000"), "MiB"),
        ("letters", "\u{e4}".repeat(1_000_000), ""),
        ("letters and spaces", "\u{e4} ".repeat(300_000), ""),
        (
            "a number with letters",
            format!("1{}", "\u{e4}".repeat(1_000_000)),
            "",
        ),
        ("letters, one a line", "\u{e4}\n".repeat(99_000), ""),
        (
            "more proofs than there is time for",
            s(
                "show(union([field(lambda p: length(p - (i, 0, 0)) + 0.01 * sin(9 * p.x * p.y) * cos(p.z * p.x) - 1, size = 40) for i in range(10000)]))",
            ),
            "",
        ),
        ("a long list", s("x = [0] * 1000000000"), ""),
        ("a longer list", s("x = [0] * 9223372036854775807"), ""),
        (
            "a list of a range",
            s("x = list(range(9223372036854775807))"),
            "",
        ),
        (
            "doubled text",
            s("x = \"x\"\nfor i in range(100):\n    x += x"),
            "text",
        ),
        (
            "doubled text, in one line each",
            format!("x = \"x\"\n{}", "x = x + x\n".repeat(100)),
            "text",
        ),
        (
            "doubled list",
            s("x = [0]\nfor i in range(100):\n    x.extend(x)"),
            "",
        ),
        (
            "doubled list by +=",
            format!("x = [0]\n{}", "x += x\n".repeat(100)),
            "",
        ),
        (
            "doubled tuple",
            s("x = (0,)\nfor i in range(100):\n    x = x + x"),
            "",
        ),
        (
            "joined text",
            s("x = \"x\" * 100000\ny = x.join([x] * 100000)"),
            "MiB",
        ),
        (
            "replaced text",
            s("x = \"x\" * 100000\ny = x.replace(\"x\", x)"),
            "MiB",
        ),
        (
            "replaced nothing",
            s("x = \"x\" * 100000\ny = x.replace(\"\", x)"),
            "MiB",
        ),
        (
            "formatted text",
            s("x = \"x\"\nfor i in range(100):\n    x = \"%s%s\" % (x, x)"),
            "text",
        ),
        (
            "formatted text by {}",
            s("x = \"x\"\nfor i in range(100):\n    x = \"{0}{0}\".format(x)"),
            "text",
        ),
        (
            "split text",
            s("x = \"x \" * 100000\ny = [x.split() for i in range(10000)]"),
            "MiB",
        ),
        ("a huge shift", s("x = 1 << 1000000000"), "shift"),
        (
            "a huge number",
            s("x = 1\nfor i in range(10000):\n    x = x * 3"),
            "large",
        ),
        (
            "a huge literal",
            format!("x = {}", "9".repeat(100_000)),
            "large",
        ),
        (
            "a huge power",
            s("x = pow(1e300, 1e300)\nshow(sphere(x))"),
            "inf",
        ),
        (
            "deep recursion",
            s("def f(n):\n    return f(n + 1)\nf(0)"),
            "calls",
        ),
        (
            "recursion by lambdas",
            s("f = lambda f: f(f)\nf(f)"),
            "calls",
        ),
        (
            "wide recursion",
            s("def f(n):\n    return 0 if n == 0 else f(n - 1) + f(n - 1)\nf(90)"),
            "",
        ),
        (
            "recursion in sorted",
            s("def f(x):\n    return sorted([1, 2], key = f)\nf(1)"),
            "calls",
        ),
        (
            "tuples of themselves, compared",
            s(
                "a = (0,)\nb = (0,)\nfor i in range(30):\n    a = (a, a)\n    b = (b, b)\nx = a == b",
            ),
            "",
        ),
        (
            "tuples of themselves, printed",
            s("a = (0,)\nfor i in range(60):\n    a = (a, a)\nprint(a)"),
            "",
        ),
        (
            "tuples of themselves, as a key",
            s("a = (0,)\nfor i in range(60):\n    a = (a, a)\nd = {a: 1}"),
            "nested",
        ),
        (
            "a list in itself, compared",
            s("a = []\na.append(a)\nb = []\nb.append(b)\nx = a == b"),
            "nested",
        ),
        (
            "nested lists",
            s("a = []\nfor i in range(10000000):\n    a = [a]"),
            "",
        ),
        (
            "nested brackets",
            format!("x = {}{}", "[".repeat(100_000), "]".repeat(100_000)),
            "brackets",
        ),
        (
            "nested parentheses",
            format!("x = {}1{}", "(".repeat(100_000), ")".repeat(100_000)),
            "brackets",
        ),
        (
            "nested calls",
            format!("x = {}1{}", "f(".repeat(100_000), ")".repeat(100_000)),
            "brackets",
        ),
        (
            "unary operators",
            format!("x = {}1", "-".repeat(1_000_000)),
            "too long",
        ),
        (
            "not not not",
            format!("x = {}1", "not ".repeat(100_000)),
            "too long",
        ),
        (
            "nested lambdas",
            format!("x = {}1", "lambda a, b: ".repeat(100_000)),
            "too long",
        ),
        (
            "nested conditions",
            format!("x = {}1", "1 if 1 else ".repeat(100_000)),
            "too long",
        ),
        (
            "a long sum",
            format!("x = 1{}", " + 1".repeat(100_000)),
            "too long",
        ),
        (
            "a long chain of methods",
            format!("x = s{}", ".a()".repeat(100_000)),
            "too long",
        ),
        (
            "a long chain of indices",
            format!("x = s{}", "[0]".repeat(100_000)),
            "too long",
        ),
        (
            "a comprehension of many clauses",
            format!("x = [1 {}]", "for a, b in [] ".repeat(1000)),
            "clauses",
        ),
        (
            "nested blocks",
            (0..1000)
                .map(|i| format!("{}if 1:\n", " ".repeat(i)))
                .collect::<String>()
                + &" ".repeat(1000)
                + "pass",
            "blocks",
        ),
        (
            "many elif",
            format!("if 1:\n    pass\n{}", "elif 1:\n    pass\n".repeat(100_000)),
            "elif",
        ),
        (
            "an f-string in an f-string",
            format!("x = {}1{}", "f'{f\"{".repeat(1000), "}\"}'".repeat(1000)),
            "",
        ),
        (
            "a million fields",
            s("show(union([sphere() for i in range(1000000)]))"),
            "fields",
        ),
        (
            "a field of many",
            s("s = sphere()\nfor i in range(60):\n    s = s | s.move(x = 1)\nshow(s)"),
            "nodes",
        ),
        (
            "a deep field",
            s("s = sphere()\nfor i in range(100000):\n    s = s.round(0.001).move(x = 1)\nshow(s)"),
            "deep",
        ),
        (
            "a field in quadratic chains",
            s("s = sphere()\nfor i in range(100000):\n    s = s | sphere()\nshow(s)"),
            "",
        ),
        (
            "many objects",
            s("for i in range(100000):\n    show(sphere())"),
            "objects",
        ),
        (
            "many materials",
            s("for i in range(100000):\n    x = sphere().paint((i / 100000, 0, 0))"),
            "",
        ),
        (
            "many lights",
            s("for i in range(100000):\n    sun()"),
            "lights",
        ),
        (
            "many parameters",
            s("for i in range(100000):\n    slider(str(i), 1)"),
            "parameters",
        ),
        (
            "many printed lines",
            s("for i in range(10000000):\n    print(i)"),
            "",
        ),
        (
            "arguments by the list",
            s("def f(*a):\n    return f(*(a + a))\nf(1)"),
            "",
        ),
        (
            "a list sorted again and again",
            s("l = list(range(100000))\nfor i in range(100000):\n    l = sorted(l)"),
            "",
        ),
        (
            "items looked for",
            s("l = list(range(100000))\nfor i in range(100000):\n    x = -1 in l"),
            "",
        ),
        (
            "items put in front",
            s("l = []\nfor i in range(1000000):\n    l.insert(0, i)"),
            "",
        ),
        (
            "texts searched",
            s(
                "t = \"a\" * 100000\nfor i in range(1000000):\n    x = t.count(\"aaab\") + t.find(\"b\")",
            ),
            "",
        ),
        (
            "texts hashed",
            s("t = \"a\" * 100000\nd = {}\nfor i in range(1000000):\n    d[t] = i"),
            "",
        ),
        (
            "closures",
            s(
                "def f(n):\n    a = [0] * 1000\n    return lambda: a\nfs = [f(i) for i in range(1000000)]",
            ),
            "",
        ),
        (
            "a large picture",
            s("render(size = (1000000, 1000000))\nshow(sphere())"),
            "pixels",
        ),
        (
            "a large picture by its sides",
            s("render(size = (999999, 1))\nrender(size = (1, 1))\nshow(sphere())"),
            "already",
        ),
        (
            "many samples",
            s("render(aa = supersample(1000000000))\nshow(sphere())"),
            "samples",
        ),
        ("nothing at all", s(""), "shows nothing"),
        ("no text", s("\u{0}\u{1}\u{feff}"), ""),
    ]
}

/// JSON that tries to take more.
fn data() -> Vec<(&'static str, String, &'static str)> {
    let scene = |parts: &str, field: &str| {
        format!(r#"{{"zeroset": 1, "parts": [{parts}], "objects": [{{"field": {field}}}]}}"#)
    };
    let doubled: Vec<String> = (0..60)
        .map(|i| match i {
            0 => r#"{"sphere": {}}"#.to_string(),
            _ => format!(
                r#"{{"union": {{"of": [{{"part": {0}}}, {{"part": {0}}}]}}}}"#,
                i - 1
            ),
        })
        .collect();
    let deep: Vec<String> = (0..2000)
        .map(|i| match i {
            0 => r#"{"sphere": {}}"#.to_string(),
            _ => format!(
                r#"{{"onion": {{"thickness": 0.001, "of": {{"part": {}}}}}}}"#,
                i - 1
            ),
        })
        .collect();
    let many = vec![r#"{"sphere": {}}"#; 200_000].join(",");
    vec![
        ("nested lists", "[".repeat(1_000_000), "recursion"),
        ("nested fields", scene("", &(r#"{"onion": {"of": "#.repeat(10_000) + &"}}".repeat(10_000))), "recursion"),
        ("parts of parts", scene(&doubled.join(","), r#"{"part": 59}"#), "nodes"),
        ("deep parts", scene(&deep.join(","), r#"{"part": 1999}"#), "deep"),
        ("many fields", scene("", &format!(r#"{{"union": {{"of": [{many}]}}}}"#)), "fields"),
        ("a part of itself", scene(r#"{"part": 0}"#, r#"{"part": 0}"#), "no part 0"),
        ("a part to come", scene(r#"{"part": 1}, {"sphere": {}}"#, r#"{"part": 0}"#), "no part 1"),
        ("a large number", scene("", r#"{"sphere": {"radius": 1e999}}"#), "number"),
        ("a long list", format!("[{}]", vec!["0"; 1_500_000].join(",")), "object"),
        ("a large picture", r#"{"zeroset": 1, "objects": [{"field": {"sphere": {}}}], "settings": {"size": [4000000000, 4000000000]}}"#.into(), "pixels"),
        ("many samples", r#"{"zeroset": 1, "objects": [{"field": {"sphere": {}}}], "settings": {"antialias": {"method": "supersample", "samples": 4000000000, "filter": "box"}}}"#.into(), "samples"),
        ("references to a part", scene(r#"{"sphere": {}}"#, &format!(r#"{{"union": {{"of": [{}]}}}}"#, vec![r#"{"part":0}"#; 500_000].join(","))), ""),
        ("parts of references", scene(&format!(r#"{{"sphere": {{}}}}, {}"#, vec![r#"{"part":0}"#; 600_000].join(",")), r#"{"part": 9999999}"#), ""),
        ("a key of a megabyte", format!(r#"{{"zeroset": 1, "{}": 1}}"#, "a".repeat(1 << 20)), "has no"),
        ("a field of a megabyte", scene("", &format!(r#"{{"{}": {{}}}}"#, "ab".repeat(1 << 19))), "there is no field"),
        ("a parameter of a megabyte", scene("", &format!(r#"{{"sphere": {{"{}": 1}}}}"#, "_".repeat(1 << 20))), "has no"),
        ("many keys", format!("{{{}}}", (0..400_000).map(|i| format!("\"k{i}\":0")).collect::<Vec<_>>().join(",")), ""),
        ("many members of settings", format!(r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{}}}}}}], "settings": {{{}}}}}"#, (0..200_000).map(|i| format!("\"k{i}\":0")).collect::<Vec<_>>().join(",")), ""),
        ("objects, and a mistake in the last", format!(r#"{{"zeroset": 1, "objects": [{}, {{"field": {{"sphere": {{"radius": -1}}}}}}]}}"#, vec![r#"{"field":{"sphere":{}}}"#; 9999].join(",")), "objects[9999].field.sphere.radius"),
        ("large objects, and a mistake in the last", format!(r#"{{"zeroset": 1, "objects": [{}, {{"field": {{"sphere": {{"radius": -1}}}}}}]}}"#, vec![format!(r#"{{"field":{{"union":{{"of":[{}]}}}}}}"#, vec![r#"{"sphere":{}}"#; 20].join(",")); 4000].join(",")), "objects[4000].field.sphere.radius"),
        ("many materials", format!(r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{}}}}}}], "materials": [{}]}}"#, vec!["{}"; 70_000].join(",")), "materials"),
        ("many lights", format!(r#"{{"zeroset": 1, "objects": [{{"field": {{"sphere": {{}}}}}}], "lights": [{}]}}"#, vec!["{}"; 100_000].join(",")), "lights"),
        ("an outline of many points", scene("", &format!(r#"{{"extrude": {{"of": {{"polygon": {{"points": [{}]}}}}}}}}"#, (0..200_000).map(|i| format!("[{i}000000,{}]", i % 7)).collect::<Vec<_>>().join(","))), ""),
        ("a key twice", r#"{"zeroset": 1, "zeroset": 1}"#.into(), "twice"),
        ("a wide picture", r#"{"zeroset": 1, "objects": [{"field": {"sphere": {}}}], "settings": {"size": [67108864, 1]}}"#.into(), "memory"),
        ("a list of large texts", format!("[{}]", vec![format!("\"{}\"", "x".repeat(1000)); 16_000].join(",")), ""),
        ("lists in lists", format!("[{}]", vec!["[[[[]]]]"; 1_000_000].join(",")), ""),
        ("escapes", format!("\"{}\"", "\\u0000".repeat(2_000_000)), ""),
        ("nothing at all", String::new(), "JSON"),
        ("half a scene", r#"{"zeroset": 1, "objects": [{"field""#.into(), "JSON"),
    ]
}

/// One after the other, so that the memory that they take is that of the greediest and not of all.
#[test]
fn ends_in_time() {
    let _alone = alone();
    let all = (scripts().into_iter().map(|c| (c, Language::Starlark)))
        .chain(data().into_iter().map(|c| (c, Language::Json)));
    let mut failures = String::new();
    for ((what, text, says), language) in all {
        let name = if language == Language::Json {
            "hostile.json"
        } else {
            "hostile.star"
        };
        let (result, seconds) =
            timed(|| load_text(name, &text, language, None, &Options::default()));
        if seconds > SECONDS {
            writeln!(failures, "{what}: {seconds:.2} s").unwrap();
        }
        match result {
            Ok(_) => writeln!(failures, "{what}: was loaded").unwrap(),
            // on a machine that is slow enough, the clock ends any of them
            Err(failed) if failed.report.message().contains("longer than") => {}
            Err(failed) if !failed.report.message().contains(says) => {
                writeln!(failures, "{what}: does not say `{says}`: {}", failed.report).unwrap();
            }
            Err(failed) => {
                // whatever is wrong can also be shown
                let shown = format!("{:?}", miette::Report::new(*failed.report));
                assert!(
                    shown.len() < 4000,
                    "{what}: a message of {} bytes",
                    shown.len()
                );
            }
        }
    }
    assert!(failures.is_empty(), "\n{failures}");
    if let Some(peak) = peak_memory() {
        assert!(peak < BYTES, "{} MiB", peak >> 20);
    }
}

/// Four times as long, four times the work: a pass over a formula that is quadratic would take sixteen times as much.
#[test]
fn long_formulas_take_as_long_as_they_are() {
    let _alone = alone();
    let mut seconds = [1000, 4000].map(|parts| {
        let text = format!(
            "
def f(p):
    d = length(p) - 1
    for i in range({parts}):
        d = min(d, length(p.xy - (i * 0.01, 0.5)) - 0.01)
    return d
show(field(f))"
        );
        let options = Options::default();
        let (loaded, seconds) =
            timed(|| load_text("long.star", &text, Language::Starlark, None, &options));
        assert!(loaded.is_ok());
        seconds
    });
    seconds[0] = seconds[0].max(0.02);
    assert!(seconds[1] < 8.0 * seconds[0], "{seconds:?}");
}

/// A folder with a scene in it and a secret beside it.
struct Folder {
    root: tempfile::TempDir,
}

impl Folder {
    fn new(scene: &str) -> Folder {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(root.path().join("scene/parts")).unwrap();
        std::fs::write(root.path().join("secret.star"), "x = 1").unwrap();
        std::fs::write(
            root.path().join("scene/parts/ball.star"),
            "ball = sphere(0.5)\n_hidden = 1\n",
        )
        .unwrap();
        std::fs::write(root.path().join("scene/main.star"), scene).unwrap();
        Folder { root }
    }

    fn main(&self) -> std::path::PathBuf {
        self.root.path().join("scene/main.star")
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.root.path().join("scene").join(name), bytes).unwrap();
    }

    fn error(&self) -> String {
        load(&self.main(), &Options::default())
            .unwrap_err()
            .report
            .message()
            .to_string()
    }
}

#[test]
fn files_of_the_folder() {
    let _alone = alone();
    let folder = Folder::new(
        "load(\"parts/ball.star\", \"ball\")\nload(\"./parts/ball.star\", b = \"ball\")\nshow(ball | b)",
    );
    let loaded = load(&folder.main(), &Options::default()).unwrap();
    assert_eq!(loaded.scene.name(), "main");
    let names: Vec<String> = loaded
        .files
        .iter()
        .map(|f| f.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(names, ["main.star", "ball.star"]);
}

#[test]
fn files_outside_of_the_folder() {
    let _alone = alone();
    for path in [
        "../secret.star",
        "/etc/passwd",
        "parts/../../secret.star",
        "..",
        "parts\\..\\x.star",
        "",
        "\0.star",
        "//x.star",
    ] {
        let folder = Folder::new(&format!("load({path:?}, \"x\")\nshow(sphere())"));
        assert!(
            folder.error().contains("outside") || folder.error().contains("escape"),
            "{path}: {}",
            folder.error()
        );
    }
    let folder = Folder::new("load(\"nowhere.star\", \"x\")\nshow(sphere())");
    assert!(folder.error().contains("no file"), "{}", folder.error());
    let failed = load(&folder.main(), &Options::default()).unwrap_err();
    assert_eq!(
        failed.files.len(),
        2,
        "also the file that was not there is worth watching"
    );
    let folder = Folder::new("load(\"parts/ball.star\", \"_hidden\")\nshow(sphere())");
    assert!(folder.error().contains("private"), "{}", folder.error());
    let folder = Folder::new("load(\"parts/ball.star\", \"bal\")\nshow(sphere())");
    assert!(folder.error().contains("no `bal`"), "{}", folder.error());
    let folder = Folder::new("load(\"main.star\", \"x\")\nshow(sphere())");
    assert!(
        folder.error().contains("loads itself"),
        "{}",
        folder.error()
    );
    let folder = Folder::new("load(\"a.star\", \"x\")\nshow(sphere())");
    folder.write("a.star", "load(\"b.star\", \"x\")");
    folder.write("b.star", "load(\"a.star\", \"x\")");
    assert!(
        folder.error().contains("loads itself"),
        "{}",
        folder.error()
    );
}

#[test]
fn files_that_are_too_large_or_too_many() {
    let _alone = alone();
    let folder = Folder::new("load(\"a.star\", \"x\")\nshow(sphere())");
    folder.write("a.star", " ".repeat(17 << 20));
    assert!(folder.error().contains("file_bytes"), "{}", folder.error());
    folder.write("a.star", [0xff, 0xfe]);
    assert!(folder.error().contains("UTF-8"), "{}", folder.error());
    // every file loads the next
    for i in 0..100 {
        folder.write(
            &format!("f{i}.star"),
            format!("load(\"f{}.star\", \"x\")", i + 1),
        );
    }
    folder.write("main.star", "load(\"f0.star\", \"x\")\nshow(sphere())");
    assert!(folder.error().contains("files"), "{}", folder.error());
    let failed = load(Path::new("/dev/zero.star"), &Options::default()).unwrap_err();
    assert!(failed.report.message().contains("no file"));
}

#[test]
fn images() {
    let _alone = alone();
    let folder = Folder::new("show(sphere(), triplanar(\"tile.png\", size = 2))");
    let image = image::RgbImage::from_fn(4, 2, |x, _| image::Rgb([(x * 80) as u8, 255, 0]));
    image
        .save(folder.root.path().join("scene/tile.png"))
        .unwrap();
    let loaded = load(&folder.main(), &Options::default()).unwrap();
    assert_eq!(loaded.files.len(), 2);
    folder.write("tile.png", "no image at all");
    assert!(folder.error().contains("no image"), "{}", folder.error());
    // a header that promises four billion pixels squared
    let mut png =
        b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\xff\xff\xff\x7f\xff\xff\xff\x7f\x08\x02\0\0\0".to_vec();
    png.extend([0; 64]);
    folder.write("tile.png", &png);
    assert!(!folder.error().is_empty());
    image::RgbImage::new(64, 64)
        .save(folder.root.path().join("scene/tile.png"))
        .unwrap();
    let limits = Limits {
        image_pixels: 1000,
        ..Limits::default()
    };
    let failed = load(
        &folder.main(),
        &Options {
            limits,
            ..Options::default()
        },
    )
    .unwrap_err();
    assert!(
        failed.report.message().contains("image_pixels"),
        "{}",
        failed.report
    );
}

#[cfg(unix)]
#[test]
fn links_pipes_and_devices() {
    let _alone = alone();
    use std::os::unix::fs::symlink;
    let folder = Folder::new("load(\"link.star\", \"x\")\nshow(sphere())");
    let link = folder.root.path().join("scene/link.star");
    symlink(folder.root.path().join("secret.star"), &link).unwrap();
    assert!(folder.error().contains("outside"), "{}", folder.error());
    std::fs::remove_file(&link).unwrap();
    symlink("/dev/zero", &link).unwrap();
    assert!(folder.error().contains("outside"), "{}", folder.error());
    std::fs::remove_file(&link).unwrap();
    symlink("parts", &link).unwrap();
    assert!(folder.error().contains("ordinary"), "{}", folder.error());
    std::fs::remove_file(&link).unwrap();
    // a link that stays inside is a file like any other
    symlink("parts/ball.star", &link).unwrap();
    assert!(folder.error().contains("no `x`"), "{}", folder.error());
    std::fs::remove_file(&link).unwrap();
    let made = std::process::Command::new("mkfifo").arg(&link).status();
    assert!(
        made.is_ok_and(|s| s.success()),
        "mkfifo is part of every Unix"
    );
    assert!(folder.error().contains("ordinary"), "{}", folder.error());
}
