//! Free-form fields: `field(lambda p: ...)`.

use zeroset_field::field::{Field, Node};
use zeroset_language::json::{expand, to_text};
use zeroset_language::load::{Language, Loaded, Options, load_text};
use zeroset_number::{F64, v3};

fn load(text: &str) -> Result<Loaded, String> {
    let result = load_text(
        "scene.star",
        text,
        Language::Starlark,
        None,
        &Options::default(),
    );
    result.map_err(|f| format!("{}\n{}", f.report, f.report.hint().unwrap_or_default()))
}

fn value(field: &Field, p: [f64; 3]) -> f64 {
    match field.node() {
        Node::Formula(formula) => formula.eval(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0,
        other => panic!("{other:?}"),
    }
}

/// The value of a formula at a point.
#[track_caller]
fn at(formula: &str, p: [f64; 3]) -> f64 {
    let loaded = load(&format!("show(field({formula}, slope = 100))")).unwrap();
    value(&loaded.scene.objects()[0].field, p)
}

#[test]
fn values() {
    let p = [0.3_f64, -0.7, 1.1];
    let [x, y, z] = p;
    let length = (x * x + y * y + z * z).sqrt();
    for (formula, wanted) in [
        ("lambda p: length(p) - 1", length - 1.0),
        ("lambda p: p.x + 2 * p.y - p.z / 4", x + 2.0 * y - z / 4.0),
        ("lambda p: -p.x", -x),
        ("lambda p: p.y % 0.5", y.rem_euclid(0.5)),
        ("lambda p: sin(9 * p.x)", (9.0 * x).sin()),
        ("lambda p: atan2(p.y, p.x)", y.atan2(x)),
        (
            "lambda p: length(p.xz - (1, 2))",
            ((x - 1.0).powi(2) + (z - 2.0).powi(2)).sqrt(),
        ),
        ("lambda p: min(p.x, p.y, 0.1) + max(p.z, 2)", y + 2.0),
        ("lambda p: mix(p.x, p.y, 0.25)", x + (y - x) * 0.25),
        ("lambda p: dot(p, (1, 2, 3))", x + 2.0 * y + 3.0 * z),
        (
            "lambda p: abs(p.y) + sqrt(p.z) + square(p.x)",
            y.abs() + z.sqrt() + x * x,
        ),
        (
            "lambda p: clamp(p.z, 0, 1) + smoothstep(0, 1, 0.5) + powi(p.x, 3)",
            1.5 + x * x * x,
        ),
        (
            "lambda p: pow(abs(p.z), 1.5) + exp(p.x) + log(square(p.z) + 1) + tanh(p.y)",
            z.abs().powf(1.5) + x.exp() + (z * z + 1.0).ln() + y.tanh(),
        ),
    ] {
        let got = at(formula, p);
        assert!(
            (got - wanted).abs() < 1e-6,
            "{formula}: {got}, not {wanted}"
        );
    }
}

#[test]
fn slopes() {
    let loaded =
        load("show(field(lambda p: length(p) - 1 + 0.1 * sin(tau * p.x), size = 3))").unwrap();
    let Node::Formula(formula) = loaded.scene.objects()[0].field.node() else {
        panic!("a formula")
    };
    assert!(
        formula.is_proven() && formula.slope() > 1.0 && formula.slope() < 1.8,
        "{}",
        formula.slope()
    );
    assert_eq!(formula.bounds().max, [1.5; 3]);
    let text = to_text(&expand(&loaded.scene).unwrap());
    let again = load_text(
        "scene.json",
        &text,
        Language::Json,
        None,
        &Options::default(),
    )
    .unwrap();
    let Node::Formula(other) = again.scene.objects()[0].field.node() else {
        panic!("a formula")
    };
    assert_eq!(formula, other);
    assert_eq!(text, to_text(&expand(&again.scene).unwrap()));
    // a function of the script's own, with everything that a script may do
    let text = "
def waves(p, n):
    d = p.y
    for i in range(n):
        d += 0.1 * sin(1.5 * p.x * (i + 1)) if i % 2 else 0.05
    return d
show(field(lambda p: waves(p, 5), bounds = ((-1, -2, -3), (1, 2, 3))))";
    assert!(load(text).is_ok(), "{:?}", load(text).err());
}

#[test]
fn refusals() {
    for (text, says) in [
        ("show(field(lambda p: sqrt(p.x)))", "slope"),
        ("show(field(lambda p: p))", "vector"),
        ("show(field(lambda p: \"x\"))", "a text"),
        ("show(field(lambda p: 1 if p.x > 0 else 2))", "jumps where"),
        ("show(field(lambda p: p.w))", "no `w`"),
        ("show(field(lambda p: length(p, radios = 2)))", "radios"),
        ("show(field(lambda: 1))", "at most 0"),
        ("show(field(3))", "not a function"),
        (
            "show(field(lambda p: length(p) - 1, size = -1))",
            "allowed is",
        ),
        (
            "show(field(lambda p: length(p) - 1, bounds = (1, 2)))",
            "bounds",
        ),
        // powers of what may be negative, also where the slope is stated
        ("show(field(lambda p: pow(p.x, 2.5)))", "`x` is negative"),
        (
            "show(field(lambda p: pow(p.x, 2.5), slope = 9))",
            "max(x, 0)",
        ),
        (
            "show(field(lambda p: pow(p.x, -0.5), slope = 9))",
            "negative",
        ),
        (
            "show(field(lambda p: pow(p.x - p.y, p.z), slope = 9))",
            "negative",
        ),
        ("show(field(lambda p: pow(-2, p.x), slope = 9))", "negative"),
        (
            "show(field(lambda p: pow(p.x * 0 - 2, 0.5), slope = 9))",
            "negative",
        ),
        (
            "show(field(lambda p: pow(p, 1.5).x, slope = 9))",
            "negative",
        ),
        ("show(field(lambda p: log(p.x), slope = 9))", "negative"),
        (
            "show(field(lambda p: pow(1.9 - length(p.xy), 1.5), slope = 9))",
            "negative",
        ),
        ("show(field(lambda p: pow(p.x, -1)))", "divides by"),
        ("show(field(lambda p: p.x ** 2))", ""),
        // what depends on the point is neither true nor false
        (
            "show(field(lambda p: p.x and p.y))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x or p.y))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: 1 and p.x and p.y))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: (p.x or 1) + p.y))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x + (not p.y)))",
            "neither true nor false",
        ),
        ("show(field(lambda p: p and 1))", "neither true nor false"),
        (
            "show(field(lambda p: p.x if p.y else p.z))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x if not p.xz else p.z))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: [p.x for i in [1] if p.x][0]))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x + int(bool(p.y))))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x + int(any([0, p.y]))))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x + int(all([1, p.y]))))",
            "neither true nor false",
        ),
        (
            "def f(p):\n    if p.x:\n        return p.y\n    return p.z\nshow(field(f))",
            "neither true nor false",
        ),
        (
            "def f(p):\n    if p.x:\n        return p.y\n    else:\n        return p.z\nshow(field(f))",
            "neither true nor false",
        ),
        (
            "show(field(lambda p: p.x if p.x in [0, 1] else p.z))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: p.x if 1 in [p.x] else p.z))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: p.x if 1 not in (p.x, p.y) else p.z))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: p.x if p.x == 1 else p.z))",
            "jumps where",
        ),
        (
            "show(field(lambda p: p.x if p.x != p.y else p.z))",
            "jumps where",
        ),
        (
            "show(field(lambda p: p.x if (p.x, 1) == (p.y, 1) else p.z))",
            "vectors cannot",
        ),
        (
            "show(field(lambda p: p.x if [p.x, 1, 2, 3, 4] == [0, 1, 2, 3, 4] else p.z))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: p.x if {1: p.x} == {1: 0} else p.z))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: sorted([p.x, 1])[0]))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: sorted([1, 2], key = lambda i: p.x)[0]))",
            "cannot be compared",
        ),
        (
            "show(field(lambda p: [p.y, p.x].index(p.x)))",
            "cannot be compared",
        ),
        ("show(field(lambda p: {p.x: 1}[p.x]))", "key"),
        ("show(field(lambda p: [1, 2][p.x]))", "whole number"),
        (
            "show(field(lambda p: p.x + len(range(p.x))))",
            "whole number",
        ),
        ("show(field(lambda p: int(p.x)))", "a value of a formula"),
        ("show(field(lambda p: p.x | p.y))", "min(a, b)"),
        ("show(field(lambda p: p.x & 1))", "max(a, b)"),
        ("show(field(lambda p: ~p.x))", "field"),
        (
            "show(sphere() if True else 1)\nshow(field(lambda p: sphere(p.x)))",
            "a value of a formula",
        ),
        (
            "q = []\nfield(lambda p: [q.append(p), p.x][1])\nshow(field(lambda p: p.x + q[0].x))",
            "formula",
        ),
        (
            "def f(p):\n    d = p.x\n    for i in range(400000):\n        d = d + p.y * i\n    return d\nshow(field(f))",
            "",
        ),
    ] {
        let message = load(text).expect_err(text);
        assert!(message.contains(says), "{text}: {message}");
    }
}

/// Whole powers are products: of negative numbers as well, with the right sign, slope and value everywhere.
#[test]
fn whole_powers() {
    for p in [
        [0.3, -0.7, 1.1],
        [-1.3, 0.7, -0.2],
        [-0.5, -2.0, 1.9],
        [1.0, 1.0, 1.0],
    ] {
        let [x, y, z]: [f64; 3] = p;
        for (formula, wanted) in [
            ("pow(p.x, 2)", x.powi(2)),
            ("pow(p.x, 3)", x.powi(3)),
            ("pow(p.x, 3.0)", x.powi(3)),
            ("pow(p.y, 7) + pow(p.y, 1)", y.powi(7) + y),
            ("pow(p.x, 0) + p.y", 1.0 + y),
            ("pow(x = p.x, y = 5)", x.powi(5)),
            ("pow(p.x - 2 * p.z, 4)", (x - 2.0 * z).powi(4)),
            ("pow(p.x - 3, -3)", (x - 3.0).powi(-3)),
            ("powi(p.x - 3, -2)", (x - 3.0).powi(-2)),
            ("pow(p.x * 0.5, 33)", (x * 0.5).powi(33)),
            ("pow(-1.5, 3) + p.x", -3.375 + x),
            ("p.x + pow(p.x * 0 - 1.5, 3)", x - 3.375),
            ("pow(p, 3).y", y.powi(3)),
            (
                "pow(p.xy, (2, 3)).y + pow(p.xy, (2, 3)).x",
                y.powi(3) + x * x,
            ),
            ("pow(abs(p.x), 1.5)", x.abs().powf(1.5)),
            ("pow(max(p.x, 0), 2.5)", x.max(0.0).powf(2.5)),
            (
                "pow(p.x * p.x + p.y * p.y, 0.75)",
                (x * x + y * y).powf(0.75),
            ),
            ("pow(square(p.x - p.y), 1.25)", (x - y).powi(2).powf(1.25)),
            (
                "pow(p.x * p.x - 2 * p.x + 1, 1.5)",
                (x - 1.0).powi(2).powf(1.5),
            ),
            ("pow(2, p.x)", 2_f64.powf(x)),
            ("p.x // 0.5", (x / 0.5).floor()),
            ("min([p.x, p.y, p.z, 1, 2, 3])", x.min(y).min(z).min(1.0)),
            ("max([p.x, p.y])", x.max(y)),
        ] {
            let got = at(&format!("lambda p: {formula}"), p);
            assert!(
                (got - wanted).abs() < 1e-5 * (1.0 + wanted.abs()),
                "{formula} at {p:?}: {got}, not {wanted}"
            );
        }
    }
    // Taubin's heart, as everybody writes it: proven, and both of its halves are there
    let heart = "show(field(lambda p: pow(p.x * p.x + 9 / 4 * p.z * p.z + p.y * p.y - 1, 3) - p.x * p.x * pow(p.y, 3)
        - 9 / 80 * p.z * p.z * pow(p.y, 3), size = 3))";
    let loaded = load(heart).unwrap();
    let field = &loaded.scene.objects()[0].field;
    for [x, y, z] in [
        [0.0_f64, -0.5, 0.0],
        [0.5, 0.5, 0.2],
        [0.0, 1.1, 0.0],
        [-0.9, -0.9, 0.1],
    ] {
        let a = x * x + 2.25 * z * z + y * y - 1.0;
        let wanted = a.powi(3) - x * x * y.powi(3) - 9.0 / 80.0 * z * z * y.powi(3);
        assert!((value(field, [x, y, z]) - wanted).abs() < 1e-9);
    }
    // JSON has whole powers too
    let steps = r#"["x", 3, ["pow", 0, 1], "y", ["add", 2, 3]]"#;
    let json = format!(
        r#"{{"zeroset": 1, "objects": [{{"field": {{"formula": {{"steps": {steps}, "bounds": [[-2, -2, -2], [2, 2, 2]]}}}}}}]}}"#
    );
    let loaded = load_text(
        "scene.json",
        &json,
        Language::Json,
        None,
        &Options::default(),
    )
    .unwrap();
    let got = value(&loaded.scene.objects()[0].field, [-1.5, 0.25, 0.0]);
    assert!((got - (-3.375 + 0.25)).abs() < 1e-9, "{got}");
    let broken = json.replace(", 3, [", ", 2.5, [");
    let failed = load_text(
        "scene.json",
        &broken,
        Language::Json,
        None,
        &Options::default(),
    );
    assert!(failed.unwrap_err().report.message().contains("negative"));
}

/// Tests for nothing in particular stay possible: None is no number, and a value is itself.
#[test]
fn what_may_be_asked_of_a_value() {
    for text in [
        "show(field(lambda p: p.x if p.x != None else p.y))",
        "show(field(lambda p: p.x if [p.x] else p.y))",
        "def f(p, extra = None):\n    return p.x + (extra if extra != None else 0)\nshow(field(lambda p: f(p, p.y)))",
    ] {
        assert!(load(text).is_ok(), "{text}: {:?}", load(text).err());
    }
}

/// Long formulas, as from other programs.
#[test]
fn long_formulas() {
    let text = "
def f(p):
    d = length(p) - 1
    for i in range(4000):
        d = min(d, length(p.xy - (i * 0.01, 0.5)) - 0.01)
    return d
show(field(f))";
    let loaded = load(text).unwrap();
    let field = &loaded.scene.objects()[0].field;
    let Node::Formula(formula) = field.node() else {
        panic!("a formula")
    };
    assert!(formula.steps().len() > 16_000 && formula.is_proven() && formula.slope() < 1.01);
    let got = value(field, [1.7, 0.6, 0.0]);
    assert!((got - 0.09).abs() < 1e-6, "{got}");
}
