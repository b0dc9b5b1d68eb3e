//! Formulas over any number type, evaluated in every number type and at every SIMD level.

use fearless_simd::{Level, Simd, dispatch, prelude::*};
use zeroset_number::{Args, Data, Dual, F64, Lanes, Real, Vec3, v3};

/// A formula, written once.
pub(crate) trait Formula {
    /// The formula at `p`.
    fn eval<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R;
}

/// Declares formulas: `formulas! { Name |p, a| expression; }`.
#[macro_export]
macro_rules! formulas {
    ($($name:ident |$p:ident, $a:ident| $body:expr;)*) => {$(
        pub(crate) struct $name;
        impl $crate::support::Formula for $name {
            #[inline(always)]
            fn eval<R: zeroset_number::Real>(
                $p: zeroset_number::Vec3<R>,
                $a: zeroset_number::Args<'_, R>,
            ) -> R {
                let _ = $a;
                $body
            }
        }
    )*};
}

/// Every SIMD level of this machine, the best first.
pub(crate) fn levels() -> Vec<(&'static str, Level)> {
    let best = Level::new();
    let mut levels = Vec::new();
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        if let Some(level) = best.as_avx512() {
            levels.push(("AVX-512", level.level()));
        }
        if let Some(level) = best.as_avx2() {
            levels.push(("AVX2", level.level()));
        }
        if let Some(level) = best.as_sse4_2() {
            levels.push(("SSE4.2", level.level()));
        }
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    levels.push(("best", best));
    levels.push(("baseline", Level::baseline()));
    levels
}

/// The formula at every point, by lanes.
pub(crate) fn lanes<F: Formula>(level: Level, params: &[f32], points: &[[f32; 3]]) -> Vec<f32> {
    duals::<F>(level, params, points, false)
        .into_iter()
        .map(|[v, ..]| v)
        .collect()
}

/// Value and gradient of the formula at every point, by lanes.
pub(crate) fn dual_lanes<F: Formula>(
    level: Level,
    params: &[f32],
    points: &[[f32; 3]],
) -> Vec<[f32; 4]> {
    duals::<F>(level, params, points, true)
}

fn duals<F: Formula>(
    level: Level,
    params: &[f32],
    points: &[[f32; 3]],
    gradient: bool,
) -> Vec<[f32; 4]> {
    #[inline(always)]
    fn run<S: Simd, F: Formula>(
        s: S,
        data: &Data,
        points: &[[f32; 3]],
        gradient: bool,
        out: &mut Vec<[f32; 4]>,
    ) {
        for chunk in points.chunks(S::f32s::LEN) {
            // the last point fills the lanes that are left
            let axis = |k: usize| {
                let at = |i: usize| chunk[i.min(chunk.len() - 1)][k];
                Lanes::<S>(S::f32s::from_fn(s, at))
            };
            let p = v3(axis(0), axis(1), axis(2));
            let (v, d) = if gradient {
                let d = F::eval(Dual::point(p), Args::new(data));
                (d.v, d.d)
            } else {
                let v = F::eval(p, Args::new(data));
                (v, [v; 3])
            };
            out.extend((0..chunk.len()).map(|i| [v.0[i], d[0].0[i], d[1].0[i], d[2].0[i]]));
        }
    }
    let mut out = Vec::with_capacity(points.len());
    let data = Data::from(params);
    dispatch!(level, s => run::<_, F>(s, &data, points, gradient, &mut out));
    out
}

/// The formula at a point in `f64`.
pub(crate) fn reference<F: Formula>(params: &[f32], p: [f64; 3]) -> f64 {
    F::eval(p3(p), Args::new(&Data::from(params))).0
}

/// A point of reference numbers.
pub(crate) fn p3([x, y, z]: [f64; 3]) -> Vec3<F64> {
    v3(F64(x), F64(y), F64(z))
}

/// Distance between neighbouring `f32` at `x`.
pub(crate) fn ulp(x: f64) -> f64 {
    let a = (x.abs() as f32).min(f32::MAX);
    if a == f32::MAX {
        f64::from(a) - f64::from(a.next_down())
    } else {
        f64::from(a.next_up()) - f64::from(a)
    }
}

/// Numbers with every exponent and sign, `each` of them for each, with zeros, infinities and the ends of the range.
pub(crate) fn every_exponent(each: u32) -> Vec<f32> {
    let mut out = vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::MAX,
        f32::MIN,
        f32::INFINITY,
        f32::NEG_INFINITY,
    ];
    let mut noise = 0x9e37_79b9_u32;
    for high in 0..512_u32 {
        for i in 0..each {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let mantissa = match i {
                0 => 0,
                1 => 1,
                2 => 0x7f_ffff,
                _ => noise >> 9,
            };
            let x = f32::from_bits(high << 23 | mantissa);
            if x.is_finite() {
                out.push(x);
            }
        }
    }
    out
}
