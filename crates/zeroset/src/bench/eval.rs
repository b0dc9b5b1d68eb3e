//! `bench eval`: one program over SIMD batches of `f32`, and one point of `f64` at a time, on one thread.

use fearless_simd::Level;
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;
use zeroset_eval::{BATCH, Point, Workspace};
use zeroset_field::program::Program;
use zeroset_number::{F64, v3};

/// What `bench eval` measures. Times are the best of several runs, in nanoseconds a point.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Eval {
    /// SIMD level that was used.
    pub level: String,
    /// Instructions of the program.
    pub instructions: usize,
    /// Batches.
    pub ns_per_point: f64,
    /// Batches with gradients.
    pub ns_per_gradient: f64,
    /// One point at a time in double precision, the same program.
    pub ns_per_point_scalar: f64,
    /// `ns_per_point_scalar / ns_per_point`
    pub simd_over_scalar: f64,
}

const RUNS: usize = 9;
const BATCHES: usize = 2000;

/// Measures a program at points spread over the box `[-3, 3]^3`.
pub(crate) fn eval(program: &Program) -> Eval {
    let level = Level::new();
    let mut w = Workspace::new(program.values(), program.marks());
    let spread = |i: usize, step: f64| (6.0 * (i as f64 * step).fract() - 3.0) as f32;
    for i in 0..BATCH {
        for (k, step) in [0.754_877_67, 0.569_840_29, 0.430_159_7]
            .into_iter()
            .enumerate()
        {
            w.points_mut()[k].0[i] = spread(i, step);
        }
    }
    let points: Vec<_> = (0..BATCH)
        .map(|i| {
            let [x, y, z] = w.points().each_ref().map(|lane| F64(lane.0[i].into()));
            v3(x, y, z)
        })
        .collect();
    let mut one = Point::<F64>::new(program.values());
    let (mut values, mut gradients, mut scalar) = (f64::MAX, f64::MAX, f64::MAX);
    // in turn, so that a machine that changes its pace changes all three
    for _ in 0..RUNS {
        values = values.min(per_point(BATCHES, || {
            zeroset_number::at_level!(level, s => zeroset_eval::values(s, program.values(), &mut w, BATCH));
            black_box(w.values());
        }));
        gradients = gradients.min(per_point(BATCHES / 4, || {
            zeroset_number::at_level!(level, s => zeroset_eval::gradients(s, program.values(), &mut w, BATCH));
            black_box(w.gradients());
        }));
        scalar = scalar.min(per_point(BATCHES / 16, || {
            for &p in &points {
                black_box(one.value(black_box(p)));
            }
        }));
    }
    Eval {
        level: name(level),
        instructions: program.structure().values.instructions.len(),
        ns_per_point: values,
        ns_per_gradient: gradients,
        ns_per_point_scalar: scalar,
        simd_over_scalar: scalar / values,
    }
}

/// Name of a SIMD level: the first word of how it is written for debugging.
fn name(level: Level) -> String {
    let written = format!("{level:?}");
    written.split('(').next().unwrap_or_default().to_owned()
}

/// Nanoseconds a point of `batches` runs over a batch each.
fn per_point(batches: usize, mut run: impl FnMut()) -> f64 {
    let start = Instant::now();
    for _ in 0..batches {
        run();
    }
    start.elapsed().as_secs_f64() * 1e9 / (batches * BATCH) as f64
}
