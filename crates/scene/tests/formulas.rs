//! Free-form fields: `field(lambda p: ...)`.

use zeroset_field::field::{Field, Node};
use zeroset_field::number::{F64, v3};
use zeroset_scene::json::{expand, to_text};
use zeroset_scene::load::{Language, Loaded, Options, load_text};

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
    value(&loaded.scene.objects[0].field, p)
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
        ("lambda p: sin(90 * p.x)", (90.0 * x).to_radians().sin()),
        ("lambda p: atan2(p.y, p.x)", y.atan2(x).to_degrees()),
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
            "lambda p: pow(p.z, 1.5) + exp(p.x) + log(p.z) + tanh(p.y)",
            z.powf(1.5) + x.exp() + z.ln() + y.tanh(),
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
        load("show(field(lambda p: length(p) - 1 + 0.1 * sin(360 * p.x), size = 3))").unwrap();
    let Node::Formula(formula) = loaded.scene.objects[0].field.node() else {
        panic!("a formula")
    };
    assert!(
        formula.is_proven() && formula.slope() > 1.0 && formula.slope() < 1.8,
        "{}",
        formula.slope()
    );
    assert_eq!(formula.bounds().max, [1.5; 3]);
    let text = to_text(&expand(&loaded.scene));
    let again = load_text(
        "scene.json",
        &text,
        Language::Json,
        None,
        &Options::default(),
    )
    .unwrap();
    let Node::Formula(other) = again.scene.objects[0].field.node() else {
        panic!("a formula")
    };
    assert_eq!(formula, other);
    assert_eq!(text, to_text(&expand(&again.scene)));
    // a function of the script's own, with everything that a script may do
    let text = "
def waves(p, n):
    d = p.y
    for i in range(n):
        d += 0.1 * sin(90 * p.x * (i + 1)) if i % 2 else 0.05
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
        (
            "show(field(lambda p: 1 if p.x > 0 else 2))",
            "cannot compare",
        ),
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
        (
            "q = []\nfield(lambda p: [q.append(p), p.x][1])\nshow(field(lambda p: p.x + q[0].x))",
            "formula",
        ),
        (
            "def f(p):\n    d = p.x\n    for i in range(100000):\n        d = d + p.y * i\n    return d\nshow(field(f))",
            "steps",
        ),
    ] {
        let message = load(text).expect_err(text);
        assert!(message.contains(says), "{text}: {message}");
    }
    // more proofs than there is time for end in time
    let many = "show(union([field(lambda p: length(p - (i, 0, 0)) + 0.01 * sin(9 * p.x * p.y) * cos(p.z * p.x) - 1, size = 40) for i in range(10000)]))";
    let start = std::time::Instant::now();
    assert!(load(many).is_err());
    assert!(start.elapsed().as_secs_f64() < 3.0, "{:?}", start.elapsed());
}
