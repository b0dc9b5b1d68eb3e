//! Random text: it loads or it is refused, without a panic, in time. The same as the targets of `fuzz/`, for every day.

use proptest::prelude::*;
use std::time::Instant;
use zeroset_language::json::{expand, to_text};
use zeroset_language::limits::Limits;
use zeroset_language::load::{Language, Options, load_text};

/// Scenes that are valid, to be damaged.
const SCENES: [&str; 3] = [
    r##"
def ring(n, shape):
    return union([shape.move(x = 2).turn(y = 360 * i / n) for i in range(n)])
k = slider("k", 0.4)
for i, c in enumerate(["red", "#12f", (0.1, 0.2, 0.3)]):
    show(ring(i + 2, sphere(k)).blend(box((1, 2, 3)), 0.2), material(color = c, metallic = 1), name = "n%d" % i)
show((box(1) - sphere(0.6)).twist(30).repeat((4, 0, 4), count = (3, 1, 3)), checker("red", "blue", 0.5), ao = quilez(steps = 3))
camera(eye = (3, 2, 4), target = (0, 0.5, 0), fov = 40)
sun(direction = (-1, -2, -1), shadow = soft(16))
render(size = (64, 48), march = relaxed(1.2), aa = supersample(9, "tent"))
"##,
    r#"
l = [x * y for x in range(4) for y in range(3) if x != y]
d = {"a": 1, (1, 2): [3, 4], None: {}}
d["a"] += 2
s = "%s %d" % (l[1:-1], len(d)) + f"{l[0]} {d['a']}" + "-".join(["a", "b"]).upper()
f = lambda x, *y, z = 3, **w: sorted([x, z], key = lambda v: -v)
a, (b, c) = f(1, 2, z = 4)[0], (5, 6)
show(sphere(1 if a > b else 2).round(0.1).onion(0.05).polar(5))
"#,
    "show(mandelbulb())\nshow(plane())\npoint_light((1, 2, 3))\nsky(color = hsv(200, 0.5, 0.9))",
];

/// Pieces that are put into scenes.
const PIECES: [&str; 40] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "=",
    "+=",
    "-",
    "*",
    "//",
    "%",
    "<<",
    "|",
    "&",
    "~",
    "not ",
    " in ",
    " for x in ",
    " if ",
    " else ",
    "lambda: ",
    "\n",
    "\n    ",
    "\"",
    "'",
    "\\",
    "0",
    "-1",
    "1e308",
    "9223372036854775807",
    "None",
    "[0] * 99999",
    ".move(",
    "sphere",
    "\u{0}",
    "é",
    "**",
];

fn options() -> Options {
    let limits = Limits {
        ticks: 100_000,
        heap: 8 << 20,
        nodes: 2000,
        ..Limits::default()
    };
    Options {
        limits,
        ..Options::default()
    }
}

/// A scene with pieces put in, cut out or taken twice.
fn damaged(scene: &str, changes: &[(usize, usize, u8, usize)]) -> String {
    let mut text: Vec<char> = scene.chars().collect();
    for &(at, length, kind, piece) in changes {
        let start = at % (text.len() + 1);
        let end = (start + length % 12).min(text.len());
        match kind % 3 {
            0 => drop(text.splice(start..start, PIECES[piece % PIECES.len()].chars())),
            1 => drop(text.drain(start..end)),
            _ => {
                let copy = text[start..end].to_vec();
                let to = piece % (text.len() + 1);
                drop(text.splice(to..to, copy));
            }
        }
    }
    text.into_iter().collect()
}

fn survives(text: &str, language: Language) -> Result<(), TestCaseError> {
    let start = Instant::now();
    let result = load_text("random", text, language, None, &options());
    prop_assert!(
        start.elapsed().as_secs_f64() < 5.0,
        "{:?} for {text}",
        start.elapsed()
    );
    match result {
        Ok(loaded) => {
            let written =
                expand(&loaded.scene).map_err(|e| TestCaseError::fail(format!("{e}: {text}")))?;
            let json = to_text(&written);
            let again = load_text("random", &json, Language::Json, None, &options());
            let again = again.map_err(|f| TestCaseError::fail(format!("{}: {text}", f.report)))?;
            prop_assert_eq!(json, to_text(&expand(&again.scene).unwrap()));
        }
        Err(failed) => {
            prop_assert!(!failed.report.is_bug(), "{}", text);
            // no text of a report may break what shows it
            let shown = format!("{:?}", miette::Report::new(*failed.report));
            prop_assert!(!shown.is_empty());
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, ..ProptestConfig::default() })]

    #[test]
    fn damaged_scripts(scene in 0..SCENES.len(), changes in prop::collection::vec((any::<usize>(), any::<usize>(), any::<u8>(), any::<usize>()), 1..5)) {
        survives(&damaged(SCENES[scene], &changes), Language::Starlark)?;
    }

    #[test]
    fn damaged_json(scene in 0..SCENES.len(), changes in prop::collection::vec((any::<usize>(), any::<usize>(), any::<u8>(), any::<usize>()), 0..4)) {
        let loaded = load_text("random", SCENES[scene], Language::Starlark, None, &options()).unwrap();
        survives(&damaged(&to_text(&expand(&loaded.scene).unwrap()), &changes), Language::Json)?;
    }

    #[test]
    fn any_text(text in "\\PC{0,80}") {
        survives(&text, Language::Starlark)?;
        survives(&text, Language::Json)?;
    }
}
