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

/// A choice between tuples is made item by item: a distance and a point stay those, in a tuple of up to four items too.
#[test]
fn tuples_are_chosen_item_by_item() {
    for (p, wanted) in [([0.5, 2.0, 3.0], 0.5 + 3.0), ([-0.5, 2.0, 3.0], 1.5 - 2.0)] {
        let nested =
            "lambda p: [d + q[2] for d, q in [(p.x, p) if p.x > 0 else (1 - p.x, -p.zxy)]][0]";
        assert_eq!(at(nested, p), wanted);
        let two = "lambda p: [a[1] + b[0] for a, b in [(p.zz, p.xy) if p.x > 0 else (-p.yy, (1 - p.x, 0))]][0]";
        assert_eq!(at(two, p), wanted);
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
fn no_slope_need_be_stated_where_none_holds() {
    for (text, slope) in [
        ("field(lambda p: sqrt(abs(p.x)) + length(p) - 1)", 1.0..6.0),
        (
            "field(lambda p: length(p) - (1 if p.x > 0 else 0.5))",
            1.0..1.01,
        ),
        ("field(lambda p: p.y - 0.1 / p.x)", 1.0..20.0),
        ("field(lambda p: p.x if p.x != p.y else p.z)", 1.0..2.0),
        // a million would be too steep, 20 is what it is where its surface lies
        (
            "field(lambda p: powi(p.x, 20) + powi(p.y, 20) + powi(p.z, 20) - 1, size = 9)",
            14.0..25.0,
        ),
    ] {
        let loaded = load(&format!("show({text})")).unwrap();
        let Node::Formula(formula) = loaded.scene.objects()[0].field.node() else {
            panic!("a formula")
        };
        assert!(formula.is_unbounded() && !formula.is_proven(), "{text}");
        assert!(
            slope.contains(&formula.slope()),
            "{text}: {}",
            formula.slope()
        );
        let json = to_text(&expand(&loaded.scene).unwrap());
        let options = Options::default();
        let again = load_text("scene.json", &json, Language::Json, None, &options).unwrap();
        let Node::Formula(other) = again.scene.objects()[0].field.node() else {
            panic!("a formula")
        };
        assert_eq!(formula, other);
        assert_eq!(json, to_text(&expand(&again.scene).unwrap()));
    }
}

#[test]
fn refusals() {
    for (text, says) in [
        ("show(field(lambda p: p))", "vector"),
        ("show(field(lambda p: \"x\"))", "a text"),
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

/// The value of a scene's first object at a point, the formula being given as a whole function.
#[track_caller]
fn of_script(script: &str, p: [f64; 3]) -> f64 {
    let loaded = load(script).unwrap_or_else(|e| panic!("{script}: {e}"));
    value(&loaded.scene.objects()[0].field, p)
}

/// What a person who knows Python or shaders writes without looking it up.
#[test]
fn natural_habits() {
    for p in [[0.3_f64, -0.7, 1.1], [-0.4, 0.9, 0.2]] {
        let [x, y, z] = p;
        let norm = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        for (formula, wanted) in [
            ("p[0] + p[-1] + p[1]", x + y + z),
            ("length(p[:2]) + len(p)", x.hypot(y) + 3.0),
            (
                "sum(p) + sum([c * c for c in p])",
                x + y + z + x * x + y * y + z * z,
            ),
            ("[a * b for a, b in zip(p, (1, 2, 3))][2]", 3.0 * z),
            ("+p.x - +2", x - 2.0),
            ("max(p)", x.max(y).max(z)),
            ("min(p.xz)", x.min(z)),
            ("max(abs(p))", x.abs().max(y.abs()).max(z.abs())),
            (
                "length(max(abs(p) - 0.5, 0))",
                norm(p.map(|c| (c.abs() - 0.5).max(0.0))),
            ),
            ("hypot(p.x, p.z)", x.hypot(z)),
            ("hypot(p.x, p.y, p.z)", norm(p)),
            ("cross(p, (0, 1, 0)).x", -z),
            ("dot(cross(p, (1, 2, 3)), p)", 0.0),
            ("lerp(p.x, p.y, 0.25)", x + (y - x) * 0.25),
            (
                "saturate(p.y) + trunc(3 * p.x)",
                y.clamp(0.0, 1.0) + (3.0 * x).trunc(),
            ),
            (
                "exp2(p.x) + log2(1 + square(p.y))",
                x.exp2() + (1.0 + y * y).log2(),
            ),
            ("sinh(p.x) + cosh(p.y)", x.sinh() + y.cosh()),
            ("inversesqrt(1 + square(p.x))", 1.0 / (1.0 + x * x).sqrt()),
            ("atan(p.y, p.x)", y.atan2(x)),
            ("radians(degrees(p.x))", x),
            (
                "length(vec3(p.xy, 2) - vec3(1))",
                norm([x - 1.0, y - 1.0, 1.0]),
            ),
            ("reflect(p, (0, 1, 0)).y", -y),
            (
                "normalize(p).x + distance(p, (1, 0, 0))",
                x / norm(p) + norm([x - 1.0, y, z]),
            ),
            (
                "fract(p.x) + mod(p.y, 0.3) + p.z % 0.3",
                x - x.floor() + y.rem_euclid(0.3) + z.rem_euclid(0.3),
            ),
            ("step(0.2, p.x)", f64::from(u8::from(x >= 0.2))),
            ("smin(p.x, p.y, 0.5)", {
                let h = (0.5 - (x - y).abs()).max(0.0);
                x.min(y) - h * h / 2.0
            }),
            (
                "rotate(p, \"y\", 0.5).x",
                x * 0.5_f64.cos() + z * 0.5_f64.sin(),
            ),
            (
                "rotate(p, \"z\", 0.5).y",
                x * 0.5_f64.sin() + y * 0.5_f64.cos(),
            ),
            (
                "rotate(p, (0, 2, 0), 0.5).z",
                -x * 0.5_f64.sin() + z * 0.5_f64.cos(),
            ),
            ("rotate(p, (1, 1, 1), tau / 3).y", x),
            ("rotate(p.xy, pi / 2).x", -y),
            ("p.x if p.x > 0.2 else p.y", if x > 0.2 { x } else { y }),
            ("where(p.x > 0.2, p, p.zyx).x", if x > 0.2 { x } else { z }),
            (
                "1 if p.x > 0 and p.y > 0 else 2",
                if x > 0.0 && y > 0.0 { 1.0 } else { 2.0 },
            ),
            (
                "1 if p.x > 0 or not p.y > 0 else 2",
                if x > 0.0 || y <= 0.0 { 1.0 } else { 2.0 },
            ),
            (
                "1 if floor(p.x) == 0 else 2",
                if x.floor() == 0.0 { 1.0 } else { 2.0 },
            ),
            (
                "1 if floor(p.x) != 0 else 2",
                if x.floor() != 0.0 { 1.0 } else { 2.0 },
            ),
            ("1 if p.x <= 0.3 else 2", if x <= 0.3 { 1.0 } else { 2.0 }),
            ("1 if p.x >= 0.3 else 2", if x >= 0.3 { 1.0 } else { 2.0 }),
            // what a choice leaves out needs no value
            (
                "log(p.x) if p.x > 0.1 else 0",
                if x > 0.1 { x.ln() } else { 0.0 },
            ),
            (
                "1 / p.x if abs(p.x) > 0.1 else 10",
                if x.abs() > 0.1 { 1.0 / x } else { 10.0 },
            ),
        ] {
            let got = at(&format!("lambda p: {formula}"), p);
            assert!(
                (got - wanted).abs() < 1e-9,
                "{formula} at {p:?}: {got}, not {wanted}"
            );
        }
        for (function, wanted) in [
            (
                "    x, y, z = p\n    return x + 2 * y + 3 * z",
                x + 2.0 * y + 3.0 * z,
            ),
            (
                "    if p.x > 0:\n        return p.y\n    return p.z",
                if x > 0.0 { y } else { z },
            ),
            (
                "    d = p.x\n    if p.y > 0:\n        d = d * 2\n    elif p.z > 0:\n        d = d * 3\n    return d",
                if y > 0.0 {
                    2.0 * x
                } else if z > 0.0 {
                    3.0 * x
                } else {
                    x
                },
            ),
            (
                "    if p.x > 0:\n        if p.y > 0:\n            return 1\n        e = 2\n    else:\n        e = 3\n    return e + p.z",
                if x > 0.0 && y > 0.0 {
                    1.0
                } else if x > 0.0 {
                    2.0 + z
                } else {
                    3.0 + z
                },
            ),
            (
                "    for i in range(3):\n        if p.x > 0.25 * i:\n            return i + p.y\n    return -1",
                if x > 0.0 { y } else { -1.0 },
            ),
            (
                "    def inner(q, k):\n        if q > k:\n            return q - k\n        return 0\n    return inner(p.x, 0.1) + inner(p.y, 0.2)",
                (x - 0.1).max(0.0) + (y - 0.2).max(0.0),
            ),
        ] {
            let script = format!("def f(p):\n{function}\nshow(field(f, slope = 50))");
            let got = of_script(&script, p);
            assert!(
                (got - wanted).abs() < 1e-9,
                "{script} at {p:?}: {got}, not {wanted}"
            );
        }
    }
}

/// Choices whose values agree where they flip have a proven slope.
#[test]
fn choices_are_proven() {
    for (formula, slope) in [
        ("-p.x if p.x < 0 else p.x", 1.0),
        ("p.x if p.x > p.y else p.y", 1.0),
        ("length(p) - 1 if p.y > 0 else length(p.xz) - 1", 1.0),
        ("square(p.x) if p.x > 0 else 0", 4.0),
        ("0 if length(p) < 1 else length(p) - 1", 1.0),
        ("p.x - 1 if p.x > 1 else (0 if p.x > -1 else p.x + 1)", 1.0),
        ("max(p.x, 0) if p.x > 0 and p.x > -5 else 0", 1.0),
        ("ease(p.x + 0.5, \"in_out_cubic\")", 3.0),
    ] {
        let loaded = load(&format!("show(field(lambda p: {formula}))"));
        let loaded = loaded.unwrap_or_else(|e| panic!("{formula}: {e}"));
        let Node::Formula(formula_of) = loaded.scene.objects()[0].field.node() else {
            panic!("a formula")
        };
        assert!(
            formula_of.is_proven() && formula_of.slope() < slope * 1.1,
            "{formula}: {}",
            formula_of.slope()
        );
        // and so it is by way of JSON
        let text = to_text(&expand(&loaded.scene).unwrap());
        let again = load_text(
            "scene.json",
            &text,
            Language::Json,
            None,
            &Options::default(),
        )
        .unwrap();
        assert_eq!(text, to_text(&expand(&again.scene).unwrap()), "{formula}");
    }
}

/// Fields inside of formulas, deformations, displacements, plane shapes.
#[test]
fn formulas_everywhere() {
    let p = [0.3_f64, -0.2, 0.7];
    let [x, y, z] = p;
    let length = (x * x + y * y + z * z).sqrt();
    for (script, wanted) in [
        (
            "s = sphere(1)\nshow(field(lambda p: max(s(p), -s(p * 2))))",
            (length - 1.0).max(1.0 - 2.0 * length),
        ),
        (
            "s = sphere(1)\nshow(field(lambda p: s(p - (1, 0, 0)) + s((0, 3, 0))))",
            ((x - 1.0).powi(2) + y * y + z * z).sqrt() - 1.0 + 2.0,
        ),
        (
            "c = circle(1)\nshow(field(lambda p: c(p.xz)))",
            x.hypot(z) - 1.0,
        ),
        (
            "show(sphere(1).map(lambda p: p * (1, 2, 1)))",
            (x * x + 4.0 * y * y + z * z).sqrt() - 1.0,
        ),
        (
            "show(sphere(1).displace(lambda p: 0.1 * sin(5 * p.x)))",
            length - 1.0 - 0.1 * (5.0 * x).sin(),
        ),
        ("show(sphere(1).morph(sphere(2), t = 0.25))", length - 1.25),
        (
            "show(sphere(1).bend_linear((0, 0, 0), (0, 0, 1), (0, 1, 0), \"in_quad\"))",
            (x * x + (y - z * z).powi(2) + z * z).sqrt() - 1.0,
        ),
        ("show(sphere(1).bend_radial(0, 1, 0.5))", {
            let lift = 0.5 * x.hypot(z).min(1.0);
            (x * x + (y - lift).powi(2) + z * z).sqrt() - 1.0
        }),
    ] {
        let got = of_script(script, p);
        assert!((got - wanted).abs() < 1e-6, "{script}: {got}, not {wanted}");
        let loaded = load(script).unwrap();
        let text = to_text(&expand(&loaded.scene).unwrap());
        let again = load_text(
            "scene.json",
            &text,
            Language::Json,
            None,
            &Options::default(),
        );
        let again = again.unwrap_or_else(|f| panic!("{script}: {}", f.report));
        assert_eq!(text, to_text(&expand(&again.scene).unwrap()), "{script}");
        let got = value(&again.scene.objects()[0].field, p);
        assert!(
            (got - wanted).abs() < 1e-6,
            "{script} from JSON: {got}, not {wanted}"
        );
    }
    // the boxes that were found hold the results, and are not much larger
    for (script, half) in [
        (
            "show(sphere(1).map(lambda p: p * (1, 2, 0.5)))",
            [1.0, 0.5, 2.0],
        ),
        ("show(sphere(1).displace(lambda p: 0.25))", [1.25; 3]),
        (
            "show(box(2).map(lambda p: rotate(p, \"y\", pi / 4)))",
            [2_f64.sqrt(), 1.0, 2_f64.sqrt()],
        ),
    ] {
        let loaded = load(script).unwrap();
        let bounds = loaded.scene.objects()[0].field.facts().bounds;
        for k in 0..3 {
            assert!(
                bounds.max[k] >= half[k] && bounds.max[k] < half[k] * 1.15,
                "{script}: {bounds:?}"
            );
            assert!(
                bounds.min[k] <= -half[k] && bounds.min[k] > -half[k] * 1.15,
                "{script}: {bounds:?}"
            );
        }
    }
    for script in [
        "show(field2d(lambda p: length(p) - 1).extrude(0.5))",
        "show(field2d(lambda p: length(p) - 1, size = (3, 4)).revolve())",
        "show(field2d(lambda p: max(abs(p)) - 0.5, bounds = ((-1, -1), (1, 2))).displace(lambda p: 0.1).extrude(1))",
        "show(star().map(lambda p: rotate(p, length(p))).extrude(0.3))",
        "show(rectangle(1).loft(circle(0.4), height = 2, ease = \"in_out_quad\"))",
        "show(sphere(0.5).transition(box(1), (0, -0.4, 0), (0, 0.4, 0), \"in_out_sine\"))",
        "show(tube([(0, 0, 0), (1, 0, 0), (1, 1, 0)], radius = [0.1, 0.2, 0.05]))",
        "show(tube([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], closed = True))",
        "show(rectangle((0.2, 0.1)).sweep(spline([(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1)])))",
        "show(circle(0.1).sweep(spline([(1, 0, 0), (0, 0, 1), (-1, 0, 0), (0, 0, -1)], closed = True)))",
        "show(polyline_tube(radius = 0.1, points = spline([(0, 0, 0), (1, 0, 0), (1, 1, 0)])))",
    ] {
        let loaded = load(script).unwrap_or_else(|e| panic!("{script}: {e}"));
        let text = to_text(&expand(&loaded.scene).unwrap());
        let again = load_text(
            "scene.json",
            &text,
            Language::Json,
            None,
            &Options::default(),
        );
        assert!(again.is_ok(), "{script}: {}", again.unwrap_err().report);
    }
    for (script, says) in [
        ("show(field2d(lambda p: p.z).extrude(1))", "no `z`"),
        ("c = circle(1)\nshow(field(lambda p: c(p)))", "s(p.xy)"),
        ("s = sphere(1)\nshow(field(lambda p: s(p.xy)))", "(x, y, z)"),
        ("s = sphere(1)\nshow(field(lambda p: s()))", "at a point"),
        (
            "s = sphere(1)\nshow(field(lambda p: s(\"x\")))",
            "not at a text",
        ),
        ("show(plane().displace(lambda p: 0.1 * noise(p)))", "bounds"),
        ("show(sphere().map(lambda p: p.x))", "(x, y, z)"),
        ("show(sphere().map(lambda p: (fract(p.x), p.y, p.z)))", ""),
        ("show(sphere().loft(circle()))", "plane shapes"),
        (
            "show(circle(1).sweep([(0, 0, 0), (1, 0, 0), (0.5, 0.1, 0)]))",
            "too sharply",
        ),
        (
            "show(sphere().transition(box(), (0, 0, 0), (0, 0, 0)))",
            "same point",
        ),
        ("x = ease(0.5, \"in_cubik\")\nshow(sphere())", "in_cubic"),
        (
            "def f(p):\n    l = []\n    if p.x > 0:\n        l.append(1)\n    return p.y\nshow(field(f))",
            "lists and dicts",
        ),
        (
            "def f(p):\n    for i in range(3):\n        if p.x > 0:\n            break\n    return p.y\nshow(field(f))",
            "cannot depend on the point",
        ),
        (
            "show(field(lambda p: [c for c in p if c > 0][0]))",
            "here one answer",
        ),
        ("show(field(lambda p: 1 if p > 0 else 2))", "vectors cannot"),
        (
            "show(field(lambda p: p.x if p.x > 0 and p.y else 0))",
            "neither true nor false",
        ),
    ] {
        let message = load(script).expect_err(script);
        assert!(message.contains(says), "{script}: {message}");
    }
}

/// Easing functions against their formulas (Penner 2001), and their ends.
#[test]
fn easing() {
    let value_of = |name: &str, t: f64| {
        let text = format!("print(ease({t}, \"{name}\"))\nshow(sphere())");
        load(&text).unwrap_or_else(|e| panic!("{name}: {e}")).log[0]
            .parse::<f64>()
            .unwrap()
    };
    let tau = std::f64::consts::TAU;
    for name in zeroset_field::formula::Ease::names() {
        assert!(value_of(&name, 0.0).abs() < 1e-9, "{name}");
        assert!((value_of(&name, 1.0) - 1.0).abs() < 1e-9, "{name}");
        if name.starts_with("in_out") {
            assert!((value_of(&name, 0.5) - 0.5).abs() < 1e-9, "{name}");
        }
    }
    let t = 0.3_f64;
    for (name, wanted) in [
        ("linear", t),
        ("in_quad", t * t),
        ("out_cubic", 1.0 - (1.0 - t).powi(3)),
        ("in_out_quint", 16.0 * t.powi(5)),
        ("in_sine", 1.0 - (t * tau / 4.0).cos()),
        ("in_circ", 1.0 - (1.0 - t * t).sqrt()),
        ("in_back", t * t * (2.70158 * t - 1.70158)),
        ("out_bounce", 7.5625 * t * t),
        ("in_expo", (2_f64.powf(10.0 * t) - 1.0) / 1023.0),
    ] {
        let got = value_of(name, t);
        assert!((got - wanted).abs() < 1e-9, "{name}: {got}, not {wanted}");
    }
}

/// Functions of plain numbers take radians, as in Python.
#[test]
fn radians() {
    let text = "print(sin(pi / 6), cos(pi), tan(pi / 4), asin(1), acos(0), atan(1), atan2(1, -1), atan(1, -1), radians(180), degrees(pi))
shape = cross(size = 1.5, width = 0.5)
print(sin(radians(30)), cross((1, 0, 0), (0, 1, 0)), rotate((1, 0, 0), \"y\", pi / 2)[2], dict(a = 1, b = 2)[\"b\"])
show(sphere())";
    let log = load(text).unwrap().log;
    let pi = std::f64::consts::PI;
    let numbers: Vec<f64> = log[0].split(' ').map(|n| n.parse().unwrap()).collect();
    let wanted = [
        0.5,
        -1.0,
        1.0,
        pi / 2.0,
        pi / 2.0,
        pi / 4.0,
        0.75 * pi,
        0.75 * pi,
        pi,
        180.0,
    ];
    for (got, wanted) in numbers.iter().zip(wanted) {
        assert!((got - wanted).abs() < 1e-9, "{got}, not {wanted}");
    }
    assert_eq!(numbers.len(), wanted.len());
    assert!(
        log[1].contains("(0.0, 0.0, 1.0)") && log[1].contains(" -1.0 ") && log[1].ends_with(" 2"),
        "{}",
        log[1]
    );
}

/// A scene that says nothing but what is shown stands on a floor, in light; whatever it says, nothing is added.
#[test]
fn a_first_line_has_a_stage() {
    let plain = load("show(sphere())").unwrap().scene;
    assert_eq!(plain.objects().len(), 2);
    assert_eq!(plain.objects()[1].name, "floor");
    assert_eq!(plain.objects()[1].field.facts().bounds.max[1], -1.0);
    assert_eq!(plain.lights().len(), 3);
    for text in [
        "show(sphere())\ncamera(eye = (0, 0, 5))",
        "show(sphere())\nsun()",
        "show(sphere())\nsky()",
        "show(sphere())\nfog(density = 0.1)",
        "show(sphere())\nshow(plane())",
    ] {
        let scene = load(text).unwrap().scene;
        assert!(scene.objects().iter().all(|o| o.name != "floor"), "{text}");
    }
    let options = Options {
        bare: true,
        ..Options::default()
    };
    let bare = load_text(
        "scene.star",
        "show(sphere())",
        Language::Starlark,
        None,
        &options,
    )
    .unwrap();
    assert_eq!(bare.scene.objects().len(), 1);
    // a formula is framed by its surface, not by the box that it lives in
    let eye = |text: &str| {
        let camera = *load(text).unwrap().scene.camera();
        camera.eye.length()
    };
    let (formula, shape) = (
        eye("show(field(lambda p: length(p) - 0.5, size = 40))"),
        eye("show(sphere(0.5))"),
    );
    assert!(
        (formula / shape - 1.0).abs() < 0.35,
        "{formula} for {shape}"
    );
}

/// Distances of what is made along curves and between shapes, where they are known.
#[test]
fn along_curves() {
    for (made, p, wanted) in [
        // a cone with round ends, at both of them and inside
        (
            "tube([(0, 0, 0), (2, 0, 0)], radius = [0.1, 0.3], steps = 1)",
            [-1.0, 0.0, 0.0],
            0.9,
        ),
        (
            "tube([(0, 0, 0), (2, 0, 0)], radius = [0.1, 0.3], steps = 1)",
            [3.0, 0.0, 0.0],
            0.7,
        ),
        (
            "tube([(0, 0, 0), (2, 0, 0)], radius = [0.1, 0.3], steps = 1)",
            [2.0, 0.0, 0.0],
            -0.3,
        ),
        (
            "tube([(0, 0, 0), (0, 0, 2)], radius = [0.1, 0.3])",
            [0.0, 0.0, -1.0],
            0.9,
        ),
        (
            "tube([(0, 0, 0), (2, 0, 0), (2, 2, 0)], radius = 0.1, steps = 1)",
            [1.0, 1.0, 0.0],
            0.9,
        ),
        // a straight spline is its chord
        (
            "tube([(0, 0, 0), (1, 0, 0), (2, 0, 0)], radius = 0.1)",
            [1.3, 0.5, 0.0],
            0.4,
        ),
        // around a corner, across it and before the start
        (
            "circle(0.1).sweep([(0, 0, 0), (1, 0, 0), (1, 1, 0)])",
            [0.5, -0.3, 0.0],
            0.2,
        ),
        (
            "circle(0.1).sweep([(0, 0, 0), (1, 0, 0), (1, 1, 0)])",
            [1.3, 0.7, 0.0],
            0.2,
        ),
        (
            "circle(0.1).sweep([(0, 0, 0), (1, 0, 0), (1, 1, 0)])",
            [-0.2, 0.0, 0.0],
            0.2,
        ),
        (
            "circle(0.1).sweep([(0, 0, 0), (1, 0, 0), (1, 1, 0)])",
            [1.0, 1.2, 0.0],
            0.2,
        ),
        // y of the shape points up, x to -z
        (
            "rectangle((0.4, 0.1)).sweep([(0, 0, 0), (1, 0, 0)])",
            [0.5, 0.0, 0.3],
            0.1,
        ),
        (
            "rectangle((0.4, 0.1)).sweep([(0, 0, 0), (1, 0, 0)])",
            [0.5, 0.2, 0.0],
            0.15,
        ),
        (
            "rectangle((0.4, 0.1)).sweep([(0, 0, 0), (1, 0, 0)], up = \"z\")",
            [0.5, 0.0, 0.2],
            0.15,
        ),
        (
            "rectangle(1).loft(circle(0.5), height = 2)",
            [0.0, 0.0, -0.9],
            -0.1,
        ),
        (
            "rectangle(1).loft(circle(0.5), height = 2)",
            [0.4, 0.4, 1.0],
            0.32_f64.sqrt() - 0.5,
        ),
        (
            "rectangle(1).loft(circle(0.5), height = 2)",
            [0.4, 0.4, -1.0],
            0.0,
        ),
        (
            "sphere(0.5).transition(sphere(1), (0, -0.25, 0), (0, 0.25, 0))",
            [0.0, -0.4, 0.0],
            -0.1,
        ),
        (
            "sphere(0.5).transition(sphere(1), (0, -0.25, 0), (0, 0.25, 0))",
            [0.0, 0.75, 0.0],
            -0.25,
        ),
        (
            "sphere(0.5).transition(sphere(1), (0, -0.25, 0), (0, 0.25, 0))",
            [0.6, 0.0, 0.0],
            -0.15,
        ),
    ] {
        let [x, y, z] = p;
        let text = format!("s = {made}\nprint(s(({x}, {y}, {z})))\nshow(sphere())");
        let log = load(&text).unwrap_or_else(|e| panic!("{made}: {e}")).log;
        let got: f64 = log[0].parse().unwrap();
        assert!(
            (got - wanted).abs() < 1e-5,
            "{made} at {p:?}: {got}, not {wanted}"
        );
    }
    let text = "points = spline([(0, 0, 0), (1, 2, 0), (3, 1, 1)], steps = 4)
print(len(points), points[0], points[4], points[8])
print(len(spline([(0, 0, 0), (1, 2, 0), (3, 1, 1)], closed = True, steps = 4)))
show(sphere())";
    let log = load(text).unwrap().log;
    assert_eq!(log[0], "9 (0.0, 0.0, 0.0) (1.0, 2.0, 0.0) (3.0, 1.0, 1.0)");
    assert_eq!(log[1], "13");
}
