//! An entry as a table of plain functions, so that the proofs compile once and not once an entry.

use fearless_simd::{Level, Simd, prelude::*};
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::{Info, Primitive, Roughness};
use zeroset_number::{Args, Argument, Data, Dual, Expr, F64, Interval, Lanes, Recorder, v3, wgsl};

pub type Point = [f64; 3];

/// A catalogue entry, over every number type.
#[derive(Clone, Copy)]
pub struct Entry {
    pub info: Info,
    pub exactness: Exactness,
    pub slack: f64,
    pub roughness: Roughness,
    pub samples: &'static [&'static [f64]],
    /// The reference.
    pub value: fn(Point, &[f32]) -> f64,
    /// Value and gradient.
    pub gradient: fn(Point, &[f32]) -> (f64, Point),
    /// One point in `f32`, with its gradient.
    pub single: fn([f32; 3], &[f32]) -> (f32, [f32; 3]),
    /// Points in SIMD at a level of instructions.
    pub lanes: fn(Level, &[[f32; 3]], &[f32]) -> Vec<f32>,
    /// A proven range over a box.
    pub range: fn([Interval; 3], &[f32]) -> Interval,
    /// The formula and its gradient as two WGSL functions.
    pub shader: fn() -> String,
    pub bounds: fn(&[f64]) -> Aabb,
    pub level_bounds: fn(&[f64], f64) -> Aabb,
    pub lipschitz: fn(&[f64]) -> f64,
    pub contains: fn(&[f64], Point) -> bool,
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// The table of `P`.
pub fn entry<P: Primitive>() -> Entry {
    Entry {
        info: P::INFO,
        exactness: P::EXACTNESS,
        slack: P::SLACK,
        roughness: P::ROUGHNESS,
        samples: P::SAMPLES,
        value: |p, a| {
            P::distance(
                v3(F64(p[0]), F64(p[1]), F64(p[2])),
                Args::new(&Data::from(a)),
            )
            .0
        },
        gradient: |p, a| {
            let d = P::distance(
                Dual::point(v3(F64(p[0]), F64(p[1]), F64(p[2]))),
                Args::new(&Data::from(a)),
            );
            (d.v.0, d.d.map(|x| x.0))
        },
        single: |p, a| {
            let d = P::distance(Dual::point(v3(p[0], p[1], p[2])), Args::new(&Data::from(a)));
            (d.v, d.d)
        },
        lanes: |level, points, a| zeroset_number::at_level!(level, s => lanes::<P, _>(s, points, a)),
        range: |b, a| P::distance(v3(b[0], b[1], b[2]), Args::new(&Data::from(a))),
        shader: shader::<P>,
        bounds: P::bounds,
        level_bounds: P::level_bounds,
        lipschitz: P::lipschitz,
        contains: P::contains,
        check: P::check,
    }
}

#[inline(always)]
fn lanes<P: Primitive, S: Simd>(s: S, points: &[[f32; 3]], a: &[f32]) -> Vec<f32> {
    let mut out = Vec::with_capacity(points.len());
    let data = Data::from(a);
    for chunk in points.chunks(S::f32s::LEN) {
        let axis = |k: usize| Lanes::<S>(S::f32s::from_fn(s, |i| chunk[i.min(chunk.len() - 1)][k]));
        let d = P::distance(v3(axis(0), axis(1), axis(2)), Args::new(&data));
        out.extend_from_slice(&d.0.as_slice()[..chunk.len()]);
    }
    out
}

fn shader<P: Primitive>() -> String {
    let recorder = Recorder::new();
    let value = P::distance(recorder.point("p"), Args::new(&&recorder));
    let value = print("value", &recorder, &[value]);
    let recorder = Recorder::new();
    let d = P::distance(Dual::point(recorder.point("p")), Args::new(&&recorder));
    value + &print("gradient", &recorder, &[d.d[0], d.d[1], d.d[2], d.v])
}

fn print(name: &str, recorder: &Recorder, results: &[Expr<'_>]) -> String {
    let arguments = [("p", Argument::Vec3), ("at", Argument::Offset)];
    match recorder.function(name, &arguments, results) {
        Ok(function) => wgsl::print(&function),
        // no shader: naga refuses the message, and the failure shows it
        Err(e) => e.to_string(),
    }
}

/// The levels that formulas are compiled for here: programs are tested at all of them.
pub fn levels() -> Vec<(&'static str, Level)> {
    let mut levels = vec![("baseline", Level::baseline())];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let best = Level::new();
        levels.extend(best.as_avx2().map(|s| ("avx2", s.level())));
    }
    levels
}
