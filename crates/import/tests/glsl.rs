//! Shaders against what they mean: each piece is written a second time here, in double precision and by hand.

mod support;

use glam::{DMat2, DMat3, DVec2, DVec3, DVec4, dvec2, dvec3, dvec4};
use proptest::prelude::*;
use std::f64::consts::PI;
use support::{Shown, TIME, load, points};
use zeroset_field::field::Node;
use zeroset_import::glsl::{Functions, Gives, translate};
use zeroset_import::{ImportError, Kind, Request, import};

macro_rules! pieces {
    ($($name:ident),*) => { const PIECES: &[(&str, &str, fn(DVec3) -> f64)] = &[$(
        (stringify!($name), include_str!(concat!("pieces/", stringify!($name), ".glsl")), $name),
    )*]; };
}

pieces!(
    bubbles, materials, domains, sponge, bulb, twisted, rows, folds, waves, capsules
);

fn sd_box(p: DVec3, b: DVec3) -> f64 {
    let d = p.abs() - b;
    d.max(DVec3::ZERO).length() + d.max_element().min(0.0)
}

fn bubbles(p: DVec3) -> f64 {
    let moved = p - dvec3(0.5 * (TIME * 0.7 + 0.3).sin(), 0.6, 0.0);
    let (a, b, k) = (
        moved.length() - 0.5,
        (p - dvec3(-0.6, 0.4, 0.2)).length() - 0.35,
        0.25,
    );
    let h = (0.5 + 0.5 * (b - a) / k).clamp(0.0, 1.0);
    // mix(b, a, h)
    let joined = b * (1.0 - h) + a * h - k * h * (1.0 - h);
    joined.min(p.y + 0.1)
}

fn materials(p: DVec3) -> f64 {
    let mut d = p.y;
    if p.x < 3.0 {
        d = d.min(sd_box(p - dvec3(-1.0, 0.35, 0.0), dvec3(0.35, 0.3, 0.25)));
    }
    // the swizzle makes z its height
    let q = p - dvec3(0.4, 0.5, 0.0);
    let torus = dvec2(dvec2(q.x, q.y).length() - 0.35, q.z).length() - 0.1;
    0.9 * d.min(torus)
}

fn modulo(x: f64, y: f64) -> f64 {
    x - y * (x / y).floor()
}

fn domains(p: DVec3) -> f64 {
    let turn = 2.0 * PI / 7.0;
    let a = modulo(p.z.atan2(p.x) + turn / 2.0, turn) - turn / 2.0;
    let r = p.x.hypot(p.z);
    let q = dvec3(a.cos() * r - 1.2, p.y, a.sin() * r);
    let (s, c) = (PI / 5.0).sin_cos();
    // cos * p + sin * (p.y, -p.x)
    let q = dvec3(c * q.x + s * q.y, c * q.y - s * q.x, q.z);
    let ring = sd_box(q, dvec3(0.2, 0.35, 0.15));
    let cell = ((p.y + 0.4) / 0.8).floor();
    let y = modulo(p.y + 0.4, 0.8) - 0.4;
    let column = (dvec3(p.x, y, p.z).length() - 0.3 - 0.02 * cell).max(p.y.abs() - 2.0);
    let u = dvec2(0.1 - ring, 0.1 - column).max(DVec2::ZERO);
    ring.min(column).max(0.1) - u.length()
}

fn sponge(p: DVec3) -> f64 {
    let mut d = sd_box(p, DVec3::ONE);
    for level in 0..3 {
        let s = 3_f64.powi(level);
        let a = (p * s).map_each(|x| modulo(x, 2.0) - 1.0);
        let r = (DVec3::ONE - 3.0 * a.abs()).abs();
        let c = r.x.max(r.y).min(r.y.max(r.z)).min(r.z.max(r.x));
        d = d.max((c - 1.0) / (3.0 * s));
    }
    d
}

trait Each {
    fn map_each(self, f: impl Fn(f64) -> f64) -> Self;
}

impl Each for DVec3 {
    fn map_each(self, f: impl Fn(f64) -> f64) -> Self {
        DVec3::from(self.to_array().map(f))
    }
}

fn bulb(p: DVec3) -> f64 {
    let (mut z, mut dr, mut r) = (p, 1.0, 0.0);
    for _ in 0..5 {
        r = z.length();
        if r > 2.0 {
            break;
        }
        let (theta, phi) = (8.0 * (z.z / r).acos(), 8.0 * z.y.atan2(z.x));
        dr = 8.0 * r.powi(7) * dr + 1.0;
        z = r.powi(8)
            * dvec3(
                theta.sin() * phi.cos(),
                phi.sin() * theta.sin(),
                theta.cos(),
            )
            + p;
    }
    0.5 * r.ln() * r / dr
}

fn twisted(p: DVec3) -> f64 {
    // columns (c, -s) and (s, c)
    let rot = |a: f64| DMat2::from_cols(dvec2(a.cos(), -a.sin()), dvec2(a.sin(), a.cos()));
    let mut q = p;
    // v * m is the transposed matrix times v
    let xz = rot(0.8 * p.y).transpose() * dvec2(q.x, q.z);
    (q.x, q.z) = (xz.x, xz.y);
    let xy = rot(0.3) * dvec2(q.x, q.y);
    (q.x, q.y) = (xy.x, xy.y);
    let bar = 0.7 * sd_box(q, dvec3(0.3, 1.0, 0.5));
    let w = dvec3(1.0, 0.4, 0.6).normalize();
    let u = w.cross(DVec3::Y).normalize();
    let m = DMat3::from_cols(u, u.cross(w), w);
    let s = m * (p - dvec3(1.0, 0.2, 0.3));
    let s = m.transpose() * (m.transpose() * s);
    let yz = rot(0.4) * rot(0.5) * dvec2(s.y, s.z);
    let slab = sd_box(dvec3(s.x, yz.x, yz.y), dvec3(0.5, 0.1, 0.3));
    if bar < slab { bar } else { slab }
}

fn rows(p: DVec3) -> f64 {
    let balls = [
        (dvec3(-1.0, 0.0, 0.2), 0.3),
        (dvec3(0.1, 0.3, -0.5), 0.45),
        (dvec3(0.9, -0.2, 0.4), 0.25),
    ];
    let mut d = balls
        .into_iter()
        .map(|(c, r)| (p - c).length() - r)
        .fold(1e10, f64::min);
    for a in 0..4 {
        let a = f64::from(a);
        let q = p - dvec3(0.6 * (a - 1.5), -0.7, 0.0);
        let one = (q.x.hypot(q.z) - 0.1 - 0.02 * a).max(q.y.abs() - 0.3);
        let other = (q.x.abs() + q.z.abs() - 0.14).max(q.y.abs() - 0.2);
        d = d.min(if a % 2.0 < 0.5 { one } else { other });
    }
    for (j, n) in [(1.0, 1.0), (3.0, 4.0)] {
        d = d.min((p - dvec3(0.0, 0.9, 0.3 * j)).length() - 0.05 * n);
    }
    let floor = if p.x > 0.0 || p.x <= -1.0 {
        -1.2
    } else {
        -1.2 - 0.1 * (p.x * PI).sin()
    };
    d.min(p.y - floor)
}

fn folds(p: DVec3) -> f64 {
    let mut p = p;
    for _ in 0..6 {
        if p.x + p.y < 0.0 {
            (p.x, p.y) = (-p.y, -p.x);
        }
        if p.x + p.z < 0.0 {
            (p.x, p.z) = (-p.z, -p.x);
        }
        if p.y + p.z < 0.0 {
            (p.z, p.y) = (-p.y, -p.z);
        }
        p = p * 2.0 - DVec3::ONE;
    }
    (p.length() - 1.6) / 64.0
}

fn waves(p: DVec3) -> f64 {
    let a: f64 = 0.2 * p.x;
    let xy = DMat2::from_cols(dvec2(a.cos(), -a.sin()), dvec2(a.sin(), a.cos())) * dvec2(p.x, p.y);
    let q = dvec3(xy.x, xy.y, p.z);
    let ball = (q * dvec3(1.0, 1.2, 0.9)).length() - 1.2;
    let s = q * 4.0;
    let g = 0.5
        * ((s
            .map_each(f64::sin)
            .dot(dvec3(s.z, s.x, s.y).map_each(f64::cos)))
        .abs()
            - 0.4)
        / 4.0;
    let x = ((p.y + 0.6) / 1.3).clamp(0.0, 1.0);
    let t = x * x * (3.0 - 2.0 * x);
    let saw = 0.25 * (p.z + 8.0);
    let mut wave = 0.05
        * (q.x + 10.0).signum()
        * (saw - saw.floor())
        * if p.y + 3.0 < 0.2 { 0.0 } else { 1.0 };
    wave += 0.01 * (-p.x * p.x).exp() * (p.y.abs() + 1.0).sqrt();
    let z = p.z.clamp(0.0, 1.0);
    let ease = z * z * z * (z * (z * 6.0 - 15.0) + 10.0);
    let c = q.clamp(DVec3::splat(-0.5), DVec3::splat(0.5));
    wave += 0.02 * dvec4(c.x, c.y, c.z, ease).dot(DVec4::new(0.1, 0.2, 0.3, 0.4));
    let n = dvec3(1.0, 2.0, 2.0) / 3.0;
    wave += 0.01 * (q - 2.0 * n.dot(q) * n).y;
    wave -= 0.001 * 3.5 * (0.2 * q.z).tan() + 0.001 * 1_f64.hypot(2.5);
    ball.max(g * (1.0 - t) + (-0.3 * g - 0.02) * t) + wave
}

fn capsules(p: DVec3) -> f64 {
    let ball = (p - dvec3(0.0, 0.2, 0.0) - dvec3(0.0, 1.0, 0.5)).length() - 0.4;
    let (a, b) = (dvec3(-1.0, 0.4, 0.1), dvec3(1.2, 0.5, -0.3));
    let h = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    let capsule = (p - a.lerp(b, h)).length() - 0.2;
    ball.min(capsule).min(p.y)
}

/// A scene that shows the bare function, without a proof.
fn bare(functions: &Functions) -> String {
    let part = match functions.gives {
        Gives::Distance => String::new(),
        Gives::Vector(_) => "[0]".into(),
        Gives::Item(k) => format!("[{k}]"),
    };
    format!(
        "{}\nshow(field(lambda p: {}(p){part}, size = 64, slope = 1))",
        functions.text, functions.name
    )
}

/// How far a scene is from what a piece means, at most, over a box of half this side. Places where it jumps may be missed by rounding.
fn farthest(scene: &str, oracle: fn(DVec3) -> f64) -> f64 {
    let loaded = load(scene).unwrap_or_else(|e| panic!("{e}\n{scene}"));
    let Node::Formula(formula) = loaded.scene.objects()[0].field.node() else {
        panic!("a formula")
    };
    let mut differences: Vec<f64> = points(600, 2.2)
        .map(|[x, y, z]| {
            let p = zeroset_number::v3(
                zeroset_number::F64(x),
                zeroset_number::F64(y),
                zeroset_number::F64(z),
            );
            let (is, should) = (formula.eval(p).0, oracle(dvec3(x, y, z)));
            (is - should).abs() / (1.0 + should.abs())
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    // two of six hundred may lie in a jump, whose place is known to single precision
    differences[differences.len() - 3]
}

#[test]
fn pieces_are_what_they_mean() {
    for (name, text, oracle) in PIECES {
        let functions = translate(text, None).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        let far = farthest(&bare(&functions), *oracle);
        assert!(far < 2e-6, "{name} is {far} off:\n{}", functions.text);
    }
}

/// What is wrong in a translation is noticed: arguments that change places, matrices that are transposed, a step left out.
#[test]
fn planted_faults_are_noticed() {
    let faults = [
        ("bubbles", "mix(b, a, h)", "mix(a, b, h)"),
        ("bubbles", "h * (1.0 - h)", "h * (1.0 + h)"),
        (
            "twisted",
            "apply_transposed(q.xz, rot(0.8 * p.y))",
            "apply_matrix(rot(0.8 * p.y), q.xz)",
        ),
        (
            "twisted",
            "return ((c, -s), (s, c))",
            "return ((c, s), (-s, c))",
        ),
        (
            "twisted",
            "apply_matrix(both, s.yz)",
            "apply_transposed(s.yz, both)",
        ),
        ("materials", "if d1.x < d2.x", "if d2.x < d1.x"),
        ("domains", "vec2(p.y, -p.x)", "vec2(-p.y, p.x)"),
        ("rows", "range(1, 4)", "range(1, 3)"),
        ("bulb", "running = False", "running = True"),
        ("folds", "n < 6", "n < 5"),
        ("waves", "p.zxy", "p.yzx"),
    ];
    for (piece, right, wrong) in faults {
        let (_, text, oracle) = PIECES
            .iter()
            .find(|(name, ..)| *name == piece)
            .expect("a piece");
        let scene = bare(&translate(text, None).expect(piece));
        assert!(scene.contains(right), "{piece} has no {right}:\n{scene}");
        let scene = scene.replace(right, wrong);
        let far = farthest(&scene, *oracle);
        // no number is no success either
        assert!(
            far > 1e-4 || far.is_nan(),
            "{piece}: {right} -> {wrong} is not noticed: {far}"
        );
    }
}

fn request(title: &'static str) -> Request<'static> {
    Request {
        name: title,
        title,
        function: None,
    }
}

/// The whole scene loads, shows the surface where the piece has it, and no stated slope is exceeded.
#[test]
fn scenes_show_the_pieces() {
    for (name, text, oracle) in PIECES {
        let made =
            import(text, Kind::Glsl, &request(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        let loaded = load(&made.text).unwrap_or_else(|e| panic!("{name}: {e}\n{}", made.text));
        let shown: Vec<Shown> = loaded
            .scene
            .objects()
            .iter()
            .map(|o| Shown::of(&o.field))
            .collect();
        let bounds = loaded
            .scene
            .finite_bounds()
            .unwrap_or_else(|| panic!("{name} has no end"));
        // near the surface and within the box, all parts together have the sign of the piece
        let (mut wrong, mut asked, mut solid) = (0, 0, 0);
        for p in points(1500, 1.0) {
            let p: [f64; 3] =
                std::array::from_fn(|k| bounds.centre()[k] + 0.97 * bounds.half()[k] * p[k]);
            let should = oracle(DVec3::from(p));
            if should.abs() < 1e-4 {
                continue;
            }
            let is = shown.iter().map(|s| s.at(p)).fold(f64::INFINITY, f64::min);
            asked += 1;
            solid += i32::from(should < 0.0);
            wrong += i32::from((is < 0.0) != (should < 0.0));
        }
        assert!(
            wrong <= 1 && asked > 1000 && solid > 0,
            "{name}: {wrong} of {asked}, {solid} solid\n{}",
            made.text
        );
    }
}

/// Numbers of materials become objects of their own.
#[test]
fn materials_have_colours() {
    let text = PIECES[1].1;
    let made = import(text, Kind::Glsl, &request("materials")).expect("a scene");
    let loaded = load(&made.text).expect("a scene");
    let names: Vec<&str> = loaded
        .scene
        .objects()
        .iter()
        .map(|o| o.name.as_str())
        .collect();
    assert_eq!(names, ["material 1", "material 3", "material 25"]);
    assert_eq!(loaded.scene.materials().len(), 3);
    // a ball of the torus has its own part below zero and no other
    let inside = [0.75, 0.5, 0.0];
    let signs: Vec<bool> = loaded
        .scene
        .objects()
        .iter()
        .map(|o| Shown::of(&o.field).at(inside) < 0.0)
        .collect();
    assert_eq!(signs, [false, false, true]);
}

#[test]
fn what_cannot_be_translated_is_named_with_its_place() {
    let cases = [
        (
            "float map(vec3 p) { return texture(iChannel0, p.xy).x; }",
            "textures are not translated",
            "iChannel0",
        ),
        (
            "float map(vec3 p) { return length(p) - dFdx(p.x); }",
            "a derivative between pixels",
            "dFdx",
        ),
        (
            "float map(vec3 p) { float d = 1.0; while (d < p.x) { d += 0.1; } return d; }",
            "how often this loop runs depends on the point",
            "d < p.x",
        ),
        (
            "float map(vec3 p) { uint h = uint(p.x); h ^= 5u; return float(h); }",
            "bits of whole numbers",
            "5u",
        ),
        ("float map(vec3 p) { return lenght(p); }", "", "lenght"),
        (
            "float map(vec3 p) { return length(p) - r; }",
            "`r` is not declared",
            "r",
        ),
        (
            "float map(vec3 p) { return length(p)",
            "the file ends too early",
            "",
        ),
        (
            "float map(float x) { return x; }",
            "`map` must take one point: a vec3",
            "",
        ),
        ("void map(vec3 p) { }", "`map` must give a distance", ""),
        (
            "float f(vec3 p) { return p.x; }",
            "there is no function called map, sdf, scene",
            "",
        ),
        (
            "float map(vec3 p) { float a[3]; int k = int(p.x); return a[k]; }",
            "which item is meant depends on the point",
            "k",
        ),
        (
            "float map(vec3 p);\nfloat g(vec3 p) { return map(p); }\nfloat map(vec3 p) { return g(p); }",
            "",
            "",
        ),
    ];
    for (text, message, at) in cases {
        let error = translate(text, None).expect_err(text);
        assert!(error.message.starts_with(message), "{text}: {error:?}");
        if !at.is_empty() {
            let place = error
                .place
                .clone()
                .unwrap_or_else(|| panic!("{text}: {error:?}"));
            assert!(
                text[place.clone()].contains(at) || at.contains(&text[place]),
                "{text}: {error:?}"
            );
        }
    }
    let named = translate("float f(vec3 p) { return p.x - 0.5; }", Some("f")).expect("a function");
    assert_eq!((named.name.as_str(), named.gives), ("f", Gives::Distance));
    assert!(translate("float f(vec3 p) { return p.x; }", Some("g")).is_err());
    let deep = format!(
        "float map(vec3 p) {{ return {}p.x{}; }}",
        "(".repeat(5000),
        ")".repeat(5000)
    );
    assert!(matches!(
        import(&deep, Kind::Glsl, &request("deep")),
        Err(ImportError::Shader { place: Some(_), .. })
    ));
}

/// A formula of ten thousand operations is a scene of many lines.
#[test]
fn long_formulas_are_lines() {
    let terms: Vec<String> = (0..3300)
        .map(|k| format!("{}.0 * sin(p.x * {k}.0)", k % 7))
        .collect();
    let text = format!(
        "float map(vec3 p) {{ return length(p) - 1.0 + 0.00001 * ({}); }}",
        terms.join(" + ")
    );
    let functions = translate(&text, None).expect("a scene");
    load(&bare(&functions)).expect("it loads");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    /// Whatever a file holds, it is translated or refused; what is translated is a text that can be loaded, or is refused for a reason.
    #[test]
    fn damaged_files_are_translated_or_refused(
        piece in 0..PIECES.len(),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), "[-+*/(){};.,a-z0-9=<#\\\\ \n]{0,3}"), 1..4),
    ) {
        let mut text = PIECES[piece].1.to_owned();
        for (from, to, by) in cuts {
            let (from, to) = (from.index(text.len()), to.index(12));
            text.replace_range(from..(from + to).min(text.len()), &by);
        }
        if let Ok(functions) = translate(&text, None) {
            let _ = load(&bare(&functions));
        }
    }

    #[test]
    fn any_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let text = String::from_utf8_lossy(&bytes);
        let _ = translate(&format!("float map(vec3 p) {{ {text} }}"), None);
        prop_assert!(translate(&text, Some("map")).is_err());
    }
}
