//! Formulas over SIMD lanes must become vector code.
//!
//! One function or closure on the way that is not inlined is compiled without vector instructions, and everything it is given
//! goes through memory: the whole formula is then many times slower than it should be, and nothing else shows it. To look at
//! the code itself: `objdump -d` of a release build, which should be full of `zmm` (AVX-512) or `ymm` (AVX2) registers.

use crate::formulas::{Blend, Cuboid, PARAMS, Waves};
use crate::support::Formula;
use fearless_simd::{Level, Simd, dispatch, prelude::*};
use std::hint::black_box;
use std::time::{Duration, Instant};
use zeroset_field::number::{Args, Lanes, v3};

const N: usize = 512;

struct Batch {
    p: [[f32; N]; 3],
    out: [f32; N],
}

#[inline(always)]
fn wide<S: Simd, F: Formula>(s: S, b: &mut Batch) {
    for i in (0..N).step_by(S::f32s::LEN) {
        let at = i..i + S::f32s::LEN;
        let [x, y, z] = [0, 1, 2].map(
            #[inline(always)]
            |k: usize| Lanes::<S>(S::f32s::from_slice(s, &b.p[k][at.clone()])),
        );
        let v = F::eval(v3(x, y, z), Args::new(&PARAMS[..]));
        v.0.store_slice(&mut b.out[at]);
    }
}

fn narrow<F: Formula>(b: &mut Batch) {
    for i in 0..N {
        // one point at a time, and not by vectors of the compiler's making
        let p = v3(black_box(b.p[0][i]), b.p[1][i], b.p[2][i]);
        b.out[i] = F::eval(p, Args::new(&PARAMS[..]));
    }
}

/// How much longer a batch takes one point at a time. The shortest of many runs each, so that what else the machine does
/// falls out.
fn ratio<F: Formula>() -> f64 {
    let level = Level::new();
    let axis = |k: usize| std::array::from_fn(|i| ((i * 37 + k * 101) % 997) as f32 * 0.004 - 2.0);
    let mut b = Batch {
        p: [axis(0), axis(1), axis(2)],
        out: [0.0; N],
    };
    let (mut one, mut many) = (Duration::MAX, Duration::MAX);
    for _ in 0..60 {
        let start = Instant::now();
        narrow::<F>(black_box(&mut b));
        one = one.min(start.elapsed());
        let start = Instant::now();
        dispatch!(level, s => wide::<_, F>(s, black_box(&mut b)));
        many = many.min(start.elapsed());
    }
    one.as_secs_f64() / many.as_secs_f64().max(1e-9)
}

#[test]
fn lanes_are_faster_than_points() {
    for (name, ratio) in [
        ("cuboid", ratio::<Cuboid>()),
        ("blend", ratio::<Blend>()),
        ("waves", ratio::<Waves>()),
    ] {
        assert!(
            ratio > 1.5,
            "{name}: lanes are only {ratio:.2} times as fast: is something not inlined?"
        );
    }
}

/// The files whose every function runs over lanes.
const SOURCES: [(&str, &str); 9] = [
    ("args", include_str!("../../src/number/args.rs")),
    ("dual", include_str!("../../src/number/dual.rs")),
    ("elementary", include_str!("../../src/number/elementary.rs")),
    ("hash", include_str!("../../src/number/hash.rs")),
    ("lanes", include_str!("../../src/number/lanes.rs")),
    ("list", include_str!("../../src/number/list.rs")),
    ("real", include_str!("../../src/number/real.rs")),
    ("scalar", include_str!("../../src/number/scalar.rs")),
    ("vector", include_str!("../../src/number/vector.rs")),
];

/// Functions with a body that are not `#[inline(always)]` (nor kept out of line on purpose).
fn not_inlined(source: &str) -> Vec<String> {
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let is_function = |line: &str| {
        let line = line
            .trim_start_matches("pub ")
            .trim_start_matches("pub(super) ");
        line.starts_with("fn ") || line.starts_with("const fn ")
    };
    let has_body = |i: usize| {
        let end = lines[i..]
            .iter()
            .find(|l| l.ends_with('{') || l.ends_with(';') || l.ends_with('}'));
        end.is_some_and(|l| !l.ends_with(';'))
    };
    let is_marked = |i: usize| {
        let above = lines[..i]
            .iter()
            .rev()
            .take_while(|l| l.starts_with("#[") || l.starts_with("//"));
        let mut marks = above.filter(|l| l.starts_with("#[inline("));
        marks.any(|l| *l == "#[inline(always)]" || *l == "#[inline(never)]")
    };
    (0..lines.len())
        .filter(|i| is_function(lines[*i]) && has_body(*i) && !is_marked(*i))
        .map(|i| lines[i].to_owned())
        .collect()
}

#[test]
fn functions_over_lanes_are_inlined() {
    for (name, source) in SOURCES {
        assert_eq!(not_inlined(source), Vec::<String>::new(), "in {name}.rs");
    }
    let sample = "#[inline(always)]\nfn a() {\n}\nfn b(x: [f32; 2]) -> f32\nwhere\n{\n}\nfn c();\npub fn d() {}\n";
    assert_eq!(
        not_inlined(sample),
        ["fn b(x: [f32; 2]) -> f32", "pub fn d() {}"]
    );
}
