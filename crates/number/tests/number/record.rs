//! Recorded formulas: what the printed WGSL computes is what the formula computes.

use crate::formulas::*;
use crate::support::Formula;
use crate::tree::{Tree, Unary, number, tree};
use proptest::prelude::*;
use zeroset_number::wgsl;
use zeroset_number::{
    Args, Argument, Data, Dual, Ends, Expr, Ops, Real, RecordError, Recorder, Vec3, v3,
};
use zeroset_testkit::wgsl::{Shader, Value};

const SIGNATURE: [(&str, Argument); 2] = [("p", Argument::Vec3), ("at", Argument::Offset)];

/// A function of a point and the offset of its parameters, printed.
fn print(name: &str, recorder: &Recorder, results: &[Expr<'_>]) -> String {
    match recorder.function(name, &SIGNATURE, results) {
        Ok(function) => wgsl::print(&function),
        Err(e) => panic!("{e}"),
    }
}

/// A formula of a point and its parameters as the function `f`, and its gradient (and value) as `g`.
fn source<F: Formula>() -> String {
    let recorder = Recorder::new();
    let p = recorder.point("p");
    let v = F::eval(p, Args::new(&&recorder));
    let d = F::eval(Dual::point(p), Args::new(&&recorder));
    print("f", &recorder, &[v]) + &print("g", &recorder, &[d.d[0], d.d[1], d.d[2], d.v])
}

fn points() -> impl Iterator<Item = [f32; 3]> {
    (0..60_u32).map(|i| {
        let at = |k: u32| ((i * 7919 + k * 104_729) % 1000) as f32 * 0.004_003 - 2.0;
        [at(1), at(2), at(3)]
    })
}

/// The shader against the formula in `f32`, with its parameters somewhere in the array.
fn hold<F: Formula>() {
    let source = source::<F>();
    let shader = Shader::new(&source);
    let at = 5;
    let mut params = vec![9.0; at];
    params.extend(PARAMS);
    let data = Data::from(&params[..]);
    for p in points() {
        let q = v3(p[0], p[1], p[2]);
        let a = Args { store: &data, at };
        let v = F::eval(q, a);
        let d = F::eval(Dual::point(q), Args { store: &data, at });
        let expected = [d.d[0], d.d[1], d.d[2], d.v];
        let size = expected.iter().fold(1.0_f32, |m, x| m.max(x.abs()));
        let got = shader.call("f", p, at as u32, &params);
        assert!(
            (got[0] - v).abs() <= 1e-5 * size,
            "{got:?} at {p:?}, should be {v}\n{source}"
        );
        let got = shader.call("g", p, at as u32, &params);
        for k in 0..4 {
            let error = (got[k] - expected[k]).abs();
            assert!(
                error <= 1e-4 * size,
                "{got:?} at {p:?}, should be {expected:?}\n{source}"
            );
        }
    }
}

#[test]
fn shaders_compute_what_formulas_compute() {
    hold::<Sphere>();
    hold::<Cuboid>();
    hold::<Blend>();
    hold::<Bulb>();
    hold::<Polygon>();
    hold::<Waves>();
    hold::<Powers>();
    hold::<Quotients>();
    hold::<Cells>();
    hold::<Blends>();
}

/// Functions that `f32` takes from the system's library, and the recorder does not, make results differ in the last place.
fn plain(tree: Tree) -> Tree {
    let all = |v: Box<[Tree; 3]>| Box::new(v.map(plain));
    match tree {
        Tree::Unary(f, a) => {
            let f = match f {
                Unary::Asin | Unary::Acos | Unary::Atan | Unary::Tanh => Unary::Cos,
                f => f,
            };
            Tree::Unary(f, Box::new(plain(*a)))
        }
        Tree::Binary(f, a, b) => Tree::Binary(f, Box::new(plain(*a)), Box::new(plain(*b))),
        Tree::Length(v) => Tree::Length(all(v)),
        Tree::Choose(v) => Tree::Choose(Box::new(v.map(plain))),
        Tree::Loop(n, v) => Tree::Loop(n, all(v)),
        leaf => leaf,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_formulas_are_printed_as_they_are(tree in tree(), p in prop::array::uniform3(number())) {
        let tree = plain(tree);
        let recorder = Recorder::new();
        let v = tree.eval(recorder.point("p"), &mut |_| {});
        let d = tree.eval(Dual::point(recorder.point("p")), &mut |_| {});
        // a formula of constants may be no number
        let Ok(value) = recorder.function("f", &SIGNATURE, &[v]) else {
            return Ok(());
        };
        let shader = Shader::new(&wgsl::print(&value));
        if let Ok(gradient) = recorder.function("g", &SIGNATURE, &d.d) {
            Shader::new(&wgsl::print(&gradient));
        }
        // the signs of zeros and what comes of infinities may differ
        let mut tame = true;
        let expected = tree.eval(v3(p[0], p[1], p[2]), &mut |x: f32| tame &= x.is_finite() && x != 0.0);
        let got = shader.call("f", p, 0, &[])[0];
        prop_assert!(!tame || got == expected, "{got:e}, should be {expected:e}\n{}", wgsl::print(&value));
    }
}

/// The bodies of loops that are printed.
fn loops(source: &str) -> usize {
    source.matches("for (").count()
}

#[test]
fn loops_stay_loops() {
    assert_eq!(loops(&source::<Bulb>()), 2);
    assert_eq!(loops(&source::<Polygon>()), 2);
}

fn nested<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> [R; 3] {
    // the pair changes places in each turn; the inner loop reads both and a list
    R::repeat_while(
        a.get(0),
        [p.x, p.y, p.x.lit(0.0)],
        #[inline(always)]
        |[x, _, _]| x.below(1e6),
        #[inline(always)]
        |[x, y, s]| {
            let inner = a.list(1).fold(
                Ends::Ring,
                y,
                #[inline(always)]
                |t, item: [R::Scalar; 2], next: [R::Scalar; 2]| t * 0.5 + x * item[0] - next[1],
            );
            [y, x, s + inner]
        },
    )
}

#[test]
fn loops_nest_and_their_states_go_on_together() {
    let recorder = Recorder::new();
    let r = nested(recorder.point("p"), Args::new(&&recorder));
    let source = print("f", &recorder, &r);
    assert_eq!(loops(&source), 2, "{source}");
    let shader = Shader::new(&source);
    for turns in [0.0, 1.0, 2.0, 5.0, 5.9, -1.0] {
        let params = [turns, 3.0, 0.5, 1.0, -2.0, 0.25, 4.0, 0.125];
        let expected = nested(v3(1.0, -2.0, 0.0), Args::new(&Data::from(&params[..])));
        assert_eq!(
            shader.call("f", [1.0, -2.0, 0.0], 0, &params),
            expected,
            "{turns} turns\n{source}"
        );
    }
}

fn pairs<R: Real>(p: Vec3<R>, a: Args<'_, R>, ends: Ends) -> R {
    a.fold(
        ends,
        p.x,
        #[inline(always)]
        |s, item: [R::Scalar; 1], next: [R::Scalar; 1]| s * 2.0 + item[0] - next[0] * 0.5,
    )
}

#[test]
fn lists_of_every_length() {
    for ends in [Ends::Open, Ends::Ring] {
        let recorder = Recorder::new();
        let v = pairs(recorder.point("p"), Args::new(&&recorder), ends);
        let shader = Shader::new(&print("f", &recorder, &[v]));
        for n in 0..6 {
            let mut params = vec![n as f32];
            params.extend((0..n).map(|i| 1.5 + i as f32 * i as f32));
            let expected = pairs(v3(0.3, 0.0, 0.0), Args::new(&Data::from(&params[..])), ends);
            let got = shader.call("f", [0.3, 0.0, 0.0], 0, &params)[0];
            assert_eq!(got, expected, "{n} items, {ends:?}");
        }
    }
}

#[test]
fn loops_of_constants() {
    let recorder = Recorder::new();
    let p = recorder.point("p");
    // nothing but constants: computed at once
    let turns = |limit: f64| {
        Expr::repeat_while(
            Expr::constant(limit),
            Expr::constant(1.0),
            |s| s.below(50.0),
            |s| s * 2.0,
        )
    };
    let source = print("f", &recorder, &[turns(3.0), turns(100.0)]);
    assert!(source.contains("return vec2f(8.0f, 64.0f);"), "{source}");
    // constants that meet a value in the first turn
    let sum = Expr::repeat_while(
        Expr::constant(4.0),
        (Expr::constant(0.0), Expr::constant(1.0)),
        |(_, n)| n.below(100.0),
        |(s, n)| (s + p.x * n, n + 1.0),
    );
    // a condition that is known, a loop that never turns
    let never = Expr::repeat_while(
        Expr::constant(4.0),
        p.y,
        |s| s.lit(1.0).below(0.0),
        |s| s + p.x,
    );
    let none = Expr::repeat_while(Expr::constant(0.0), p.z, |s| s.below(1.0), |s| s + p.x);
    let source = print("f", &recorder, &[sum.0, sum.1, never, none]);
    assert_eq!(loops(&source), 1, "{source}");
    assert_eq!(
        Shader::new(&source).call("f", [0.5, 7.0, 9.0], 0, &[]),
        [5.0, 5.0, 7.0, 9.0]
    );
}

#[test]
fn only_what_is_needed_is_printed() {
    let recorder = Recorder::new();
    let p = recorder.point("p");
    let unused = Expr::repeat_while(recorder.param(3), p.x, |s| s.below(9.0), |s| s + p.y.sin());
    let twice = (p.y.exp() + p.z) * (p.y.exp() + p.z);
    let source = print("f", &recorder, &[twice]);
    assert_eq!(
        (
            loops(&source),
            source.matches("exp(").count(),
            source.matches("sin(").count()
        ),
        (0, 1, 0),
        "{source}"
    );
    // the same record gives other functions too
    assert_eq!(loops(&print("g", &recorder, &[unused])), 1);
    // derivatives of constants and products with 0 and 1 leave no trace
    let d = Dual::point(p);
    let source = print("h", &recorder, &((d.x * 3.0 + 1.0) * d.y).d);
    assert_eq!(source.matches("let ").count(), 3, "{source}");
}

#[test]
fn literals_are_ones_that_wgsl_has() {
    let recorder = Recorder::new();
    let x = recorder.input("p.x");
    let numbers = [
        1.0,
        -1.0,
        0.0,
        -0.0,
        3e38,
        -3e38,
        1e30,
        1e-45,
        16_777_216.0,
        0.1,
        f32::MIN_POSITIVE,
    ];
    for c in numbers {
        let shader = Shader::new(&print("f", &recorder, &[x.min(c), x.lit(c)]));
        let got = shader.call("f", [f32::MAX, 0.0, 0.0], 0, &[]);
        assert_eq!(got, [c, c]);
    }
    let infinite = [
        x.lit(f32::INFINITY),
        x.lit(1.0) / 0.0,
        x.lit(-1e38) * 1e38,
        (x.lit(0.0)).ln(),
    ];
    let source = print("f", &recorder, &infinite);
    let most = f32::MAX;
    assert_eq!(
        Shader::new(&source).call("f", [0.0; 3], 0, &[]),
        [most, most, -most, -most]
    );
    let none = recorder.function("f", &SIGNATURE, &[x + x.lit(0.0) / 0.0]);
    assert_eq!(none.err(), Some(RecordError::NotANumber("f".into())));
}

#[test]
fn reserved_names_are_kept_apart() {
    let words = naga::keywords::wgsl::RESERVED
        .iter()
        .chain(naga::keywords::wgsl::BUILTIN_IDENTIFIERS);
    let more = [
        "params", "v1", "s2_0", "i3", "n4", "a5", "b6", "box", "p_", "union", "f32", "main",
        "vec3f",
    ];
    for word in words.copied().chain(more) {
        let (a, b, c) = (word.to_owned(), format!("{word}_"), format!("{word}__"));
        let names = [
            wgsl::identifier(&a),
            wgsl::identifier(&b),
            wgsl::identifier(&c),
        ];
        assert!(names[0] != names[1] && names[1] != names[2], "{names:?}");
        // names that begin with two underscores are refused
        if word.starts_with('_') {
            continue;
        }
        let recorder = Recorder::new();
        let p = recorder.point(word);
        let lengths = [p.length(), p.x.max(p.y).floor() + recorder.param(2)];
        let signature = [(word, Argument::Vec3), ("at", Argument::Offset)];
        let function = |name: &str| match recorder.function(name, &signature, &lengths) {
            Ok(function) => wgsl::print(&function),
            Err(e) => panic!("{word}: {e}"),
        };
        // a function of the word's name beside one that uses the same built-in functions
        Shader::new(&(function(word) + &function("other")));
    }
}

#[test]
fn mistakes_are_named() {
    let recorder = Recorder::new();
    let p = recorder.point("p");
    let error = |name: &str, signature: &[(&str, Argument)], results: &[Expr<'_>]| {
        recorder
            .function(name, signature, results)
            .err()
            .map(|e| e.to_string())
    };
    for name in ["", "3d", "a b", "_", "__f", "größe", "a.b"] {
        assert!(
            error(name, &SIGNATURE, &[p.x]).is_some_and(|e| e.contains("is no name")),
            "{name}"
        );
    }
    let twice = [("p", Argument::Vec3), ("p", Argument::Number)];
    assert!(error("f", &twice, &[p.x]).is_some_and(|e| e.contains("two arguments `p`")));
    let offsets = [("a", Argument::Offset), ("b", Argument::Offset)];
    assert!(error("f", &offsets, &[]).is_some_and(|e| e.contains("two arguments")));
    let plane = [("p", Argument::Vec2)];
    assert!(error("f", &plane, &[p.x + p.y]).is_none());
    assert!(error("f", &plane, &[p.length()]).is_some_and(|e| e.contains("`p.z`")));
    assert!(error("f", &[("q", Argument::Vec3)], &[p.x]).is_some_and(|e| e.contains("`p.x`")));
    for (argument, input) in [
        (Argument::Vec4, "p"),
        (Argument::Vec4, "p[0].x"),
        (Argument::Mat3x4, "p.x"),
        (Argument::Mat3x4, "p[3].x"),
        (Argument::Mat3x4, "p[0]"),
        (Argument::Number, "p.x"),
    ] {
        let result = recorder.input(input);
        let error = error("f", &[("p", argument)], &[result]);
        assert!(error.is_some_and(|e| e.contains(&format!("`{input}`"))));
    }
    assert!(error("f", &SIGNATURE, &[]).is_some_and(|e| e.contains("0 results")));
    assert!(error("f", &SIGNATURE, &[p.x; 5]).is_some_and(|e| e.contains("5 results")));
}

#[test]
fn functions_take_what_their_arguments_say() {
    let recorder = Recorder::new();
    let (d, q) = (recorder.input("d"), recorder.input("q.y"));
    let signature = [("d", Argument::Number), ("q", Argument::Vec2)];
    let Ok(function) = recorder.function("f", &signature, &[d + q, recorder.param(7), d - q])
    else {
        panic!("no function");
    };
    let source = wgsl::print(&function);
    assert!(
        source.starts_with("fn f(d: f32, q: vec2f) -> vec3f {"),
        "{source}"
    );
    // without an offset parameters are counted from the array's beginning
    assert!(source.contains("params[7u]"), "{source}");
    Shader::new(&source);
}

#[test]
fn numbers_and_points_come_and_go_with_their_derivatives() {
    let recorder = Recorder::new();
    let (d, p) = (recorder.dual("d"), recorder.dual_point("m"));
    let signature = [("d", Argument::Vec4), ("m", Argument::Mat3x4)];
    let results = [p.z, d, p.x * p.y].map(|n| [n.v, n.d[0], n.d[1], n.d[2]]);
    let function = match recorder.function("f", &signature, &results.concat()) {
        Ok(function) => wgsl::print(&function),
        Err(e) => panic!("{e}"),
    };
    assert!(
        function.starts_with("fn f(d: vec4f, m: mat3x4f) -> mat3x4f {"),
        "{function}"
    );
    let columns = [
        vec![2.0, 3.0, 4.0, 5.0],
        vec![6.0, 7.0, 8.0, 9.0],
        vec![0.0, 1.0, -1.0, 0.5],
    ];
    let arguments = vec![
        Value::Vector(vec![1.0, -2.0, 3.0, -4.0]),
        Value::Matrix(columns.to_vec()),
    ];
    let product = [12.0, 32.0, 40.0, 48.0];
    assert_eq!(
        Shader::new(&function).call_with("f", arguments, &[]),
        [&[0.0, 1.0, -1.0, 0.5, 1.0, -2.0, 3.0, -4.0], &product[..]].concat()
    );
}

#[test]
fn long_vectors_have_a_length() {
    let recorder = Recorder::new();
    let p = recorder.point("p");
    let one = Expr::norm([p.x]);
    let six = Expr::norm([p.x, p.y, p.z, p.x * 2.0, p.y * 3.0, p.z.lit(1.0)]);
    let known = Expr::norm([Expr::constant(3.0), Expr::constant(4.0)]);
    let source = print("f", &recorder, &[one, six, known]);
    let got = Shader::new(&source).call("f", [-1.0, 2.0, 3.0], 0, &[]);
    assert_eq!(got[0], 1.0);
    assert!((got[1] - 55.0_f32.sqrt()).abs() < 1e-5, "{got:?}");
    assert_eq!(got[2], 5.0);
}
