//! Trees of Lipschitz pruning and register lists.

mod support;

use proptest::prelude::*;
use serde_json::{Value, json};
use support::{Shown, load, points};
use zeroset_import::{ImportError, Kind, Request, import};

fn request(name: &str) -> Request<'_> {
    Request {
        name,
        title: name,
        function: None,
    }
}

fn scene(value: &Value) -> Result<String, ImportError> {
    import(&value.to_string(), Kind::Tree, &request("tree.json")).map(|s| s.text)
}

/// What the program of Barbier et al. computes for a tree, in double precision (its `eval.glsl` in our words).
fn value(node: &Value, p: [f64; 3]) -> f64 {
    let number = |key: &str| node[key].as_f64().unwrap_or(0.0);
    let m: Vec<f64> = node["matrix"].as_array().map_or_else(
        || vec![1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        |m| m.iter().filter_map(Value::as_f64).collect(),
    );
    let q: [f64; 3] = [0, 4, 8].map(|r| m[r] * p[0] + m[r + 1] * p[1] + m[r + 2] * p[2] + m[r + 3]);
    let [x, y, z] = q;
    let outside = |a: f64, b: f64| a.max(b).min(0.0) + a.max(0.0).hypot(b.max(0.0));
    if node["nodeType"] == "binaryOperator" {
        let (a, b, k) = (
            value(&node["leftChild"], q),
            value(&node["rightChild"], q),
            number("blendRadius"),
        );
        let kernel = |a: f64, b: f64| {
            if k == 0.0 {
                0.0
            } else {
                (k - (a - b).abs()).max(0.0).powi(2) / (4.0 * k)
            }
        };
        return match node["blendMode"].as_str() {
            Some("union") => a.min(b) - kernel(a, b),
            Some("inter") => a.max(b) + kernel(a, b),
            _ => a.max(-b) + kernel(a, -b),
        };
    }
    match node["primitiveType"].as_str() {
        Some("sphere") => (x * x + y * y + z * z).sqrt() - number("radius"),
        Some("cylinder") => outside(
            x.hypot(z) - number("radius"),
            y.abs() - 0.5 * number("height"),
        ),
        Some("cone") => {
            let (r, h) = (number("radius"), 0.5 * number("height"));
            let p = [x.hypot(z) - r, y + h];
            let e = [-r, 2.0 * h];
            let t = ((p[0] * e[0] + p[1] * e[1]) / (e[0] * e[0] + e[1] * e[1])).clamp(0.0, 1.0);
            let q = [p[0] - e[0] * t, p[1] - e[1] * t];
            let d = q[0].hypot(q[1]);
            if q[0].max(q[1]) > 0.0 {
                d
            } else {
                -d.min(p[1])
            }
        }
        _ => {
            let list = |key: &str, k: usize| node[key][k].as_f64().unwrap_or(0.0);
            let half = [0, 1, 2].map(|k| 0.5 * list("sides", k));
            let corner = match (x > 0.0, z > 0.0) {
                (true, true) => 0,
                (true, false) => 1,
                (false, true) => 2,
                (false, false) => 3,
            };
            let r = 0.5 * list("bevel", corner);
            let section = outside(x.abs() - half[0] + r, z.abs() - half[2] + r) - r;
            let e = number(if y > 0.0 { "round_x" } else { "round_y" });
            outside(section + e, y.abs() - half[1] + e) - e
        }
    }
}

fn moved(x: f64, y: f64, z: f64) -> Value {
    json!([1, 0, 0, -x, 0, 1, 0, -y, 0, 0, 1, -z])
}

fn block(matrix: Value, sides: [f64; 3], bevel: [f64; 4], top: f64, bottom: f64) -> Value {
    json!({"nodeType": "primitive", "primitiveType": "box", "matrix": matrix, "sides": sides, "bevel": bevel,
           "round_x": top, "round_y": bottom, "color": [0.8, 0.4, 0.1]})
}

fn join(mode: &str, radius: f64, left: Value, right: Value) -> Value {
    json!({"nodeType": "binaryOperator", "blendMode": mode, "blendRadius": radius, "leftChild": left, "rightChild": right})
}

/// A tree with all there is.
fn whole() -> Value {
    let (s, c) = 0.6_f64.sin_cos();
    let ball = json!({"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "matrix": moved(0.2, 0.1, 0.0), "color": [1, 0, 0]});
    let tin = json!({"nodeType": "primitive", "primitiveType": "cylinder", "radius": 0.3, "height": 0.9,
                     "matrix": [c, -s, 0, 0.4, s, c, 0, 0.1, 0, 0, 1, -0.2], "color": [0, 1, 0]});
    let cone = json!({"nodeType": "primitive", "primitiveType": "cone", "radius": 0.4, "height": 0.8, "matrix": moved(-0.7, 0.3, 0.2)});
    let plain = block(moved(0.9, 0.0, 0.4), [0.5, 0.3, 0.4], [0.0; 4], 0.0, 0.0);
    let round = block(moved(0.0, -0.7, 0.3), [0.6, 0.4, 0.5], [0.2; 4], 0.1, 0.1);
    let odd = block(
        moved(-0.3, -0.6, -0.8),
        [0.7, 0.5, 0.6],
        [0.2, 0.4, 0.1, 0.3],
        0.05,
        0.15,
    );
    let even = block(
        json!([0, 0, 1, 0.1, 0, 1, 0, -0.8, -1, 0, 0, 0.1]),
        [0.7, 0.5, 0.6],
        [0.3; 4],
        0.0,
        0.0,
    );
    let left = join("sub", 0.1, join("union", 0.15, ball, tin), cone);
    let boxes = join(
        "union",
        1e-8,
        join("union", 1e-8, join("union", 1e-8, plain, round), odd),
        even,
    );
    let mut tree = join("union", 0.05, left, boxes);
    tree["aabb_min"] = json!([-1, -1, -1]);
    tree["aabb_max"] = json!([1, 1, 1]);
    join(
        "inter",
        0.02,
        tree,
        block(moved(0.0, 0.0, 0.0), [2.4, 2.2, 2.3], [0.0; 4], 0.0, 0.0),
    )
}

/// Its surface is that of the program's own values, seen in double precision.
#[test]
fn trees_are_what_their_program_shows() {
    let tree = whole();
    let text = scene(&tree).expect("a scene");
    let loaded = load(&text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let shown = Shown::of(&loaded.scene.objects()[0].field);
    let (mut wrong, mut near) = (Vec::new(), 0);
    for p in points(6000, 1.3) {
        let (is, should) = (shown.at(p), value(&tree, p));
        if should.abs() > 1e-5 && (is < 0.0) != (should < 0.0) {
            wrong.push((p, is, should));
        }
        near += i32::from(should.abs() < 0.05);
    }
    assert!(
        wrong.is_empty() && near > 200,
        "{} wrong, {near} near: {:?}\n{text}",
        wrong.len(),
        &wrong[..wrong.len().min(5)]
    );
    assert!(
        text.contains("#cc6619") && text.contains("rounded_box") && text.contains("bevelled_box"),
        "{text}"
    );
}

/// Long chains nest no deeper than a scene may.
#[test]
fn deep_chains_load() {
    let ball = |k: usize| json!({"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.1, "matrix": moved(0.01 * k as f64, 0.0, 0.0)});
    // what is joined in one way is a list; what is not is as deep as the field may be
    let chains = [
        (1000, true, ["union"; 2]),
        (1000, false, ["inter"; 2]),
        (400, false, ["union", "sub"]),
        (400, true, ["union", "sub"]),
    ];
    for (depth, left, modes) in chains {
        // made from the inside out, as text: a value of this depth would overflow the stack of a test when it is dropped
        let mut text = ball(0).to_string();
        for k in 1..depth {
            let other = ball(k).to_string();
            let (a, b) = if left { (text, other) } else { (other, text) };
            text = format!(
                r#"{{"nodeType": "binaryOperator", "blendMode": "{}", "blendRadius": 0.01, "leftChild": {a}, "rightChild": {b}}}"#,
                modes[k % 2]
            );
        }
        let made = import(&text, Kind::Tree, &request("chain.json")).expect("a scene");
        load(&made.text).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn damaged_trees_are_told_with_their_place() {
    let wrong = |change: &dyn Fn(&mut Value)| {
        let mut tree = whole();
        change(&mut tree);
        scene(&tree).expect_err("an error").to_string()
    };
    let at = |tree: &mut Value, path: &str, key: &str, to: Value| {
        tree.pointer_mut(path).expect("a node")[key] = to;
    };
    type Change<'a> = dyn Fn(&mut Value) + 'a;
    let cases: [(&Change<'_>, &str); 7] = [
        (
            &|t| at(t, "/rightChild", "matrix", json!([1, 2])),
            "rightChild: `matrix` is a list of 12 numbers",
        ),
        (
            &|t| at(t, "/rightChild", "sides", json!([1, 0, 1])),
            "rightChild: `sides` are above 0",
        ),
        (
            &|t| at(t, "/rightChild", "primitiveType", json!("torus")),
            "rightChild: `primitiveType` is \"sphere\"",
        ),
        (
            &|t| at(t, "", "blendMode", json!("xor")),
            "`blendMode` is \"union\", \"inter\" or \"sub\"",
        ),
        (
            &|t| at(t, "", "blendRadius", json!(-1)),
            "`blendRadius` is a number from 0",
        ),
        (
            &|t| at(t, "", "leftChild", json!(3)),
            "leftChild: a node is an object",
        ),
        (&|t| *t = json!({"nodes": []}), "`nodeType` is missing"),
    ];
    for (change, message) in cases {
        let said = wrong(change);
        assert!(said.contains(message), "{said}");
    }
    let cut = whole().to_string();
    assert!(matches!(
        import(&cut[..cut.len() / 2], Kind::Tree, &request("cut.json")),
        Err(ImportError::Json(_))
    ));
    let deep = "[".repeat(100_000);
    assert!(import(&deep, Kind::Tree, &request("deep.json")).is_err());
}

#[test]
fn register_lists_are_framed() {
    let ball = "x var-x\ny var-y\nz var-z\nc const 3\nq sub x c\na square q\nb square y\ng square z\nd add a b\ne add d g\nr sqrt e\none const 0.5\nout sub r one";
    let made = import(ball, Kind::Registers, &request("parts/ball.vm")).expect("a scene");
    assert!(
        made.text.contains("load_vm(\"parts/ball.vm\")"),
        "{}",
        made.text
    );
    assert!(!made.text.contains("slope"), "{}", made.text);
    // the box holds the ball, and little else
    let inner = made
        .text
        .split("bounds = ")
        .nth(1)
        .and_then(|t| t.split("))").next())
        .expect("bounds");
    let numbers: Vec<f64> = inner
        .split(|c: char| !"0123456789.-".contains(c))
        .filter_map(|n| n.parse().ok())
        .collect();
    for (number, (low, high)) in numbers.iter().zip([
        (2.0, 2.5),
        (-1.0, -0.5),
        (-1.0, -0.5),
        (3.5, 4.0),
        (0.5, 1.0),
        (0.5, 1.0),
    ]) {
        assert!((low..=high).contains(number), "{}", made.text);
    }
    let plane = "x var-x\ny var-y\na square x\nb square y\nd add a b\nr sqrt d\none const 0.5\nout sub r one";
    let made = import(plane, Kind::Registers, &request("disc.vm")).expect("a scene");
    assert!(
        made.text
            .contains("field2d(load_vm(\"disc.vm\"), size = 2).extrude"),
        "{}",
        made.text
    );
    let error = import("a var-x\nb foo a", Kind::Registers, &request("x.vm")).expect_err("no list");
    assert!(error.to_string().starts_with("line 2: "), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    #[test]
    fn damaged_texts_are_read_or_refused(at in any::<prop::sample::Index>(), length in 0..30_usize, by in "[{}\\[\\],:\"0-9a-z.-]{0,4}") {
        let mut text = whole().to_string();
        let from = at.index(text.len());
        text.replace_range(from..(from + length).min(text.len()), &by);
        if let Ok(made) = import(&text, Kind::Tree, &request("tree.json")) {
            prop_assert!(load(&made.text).is_ok(), "{}", made.text);
        }
    }
}
