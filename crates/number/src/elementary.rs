//! Elementary functions on SIMD lanes: what vector instruction sets lack.
//!
//! Straight vector code (reduction and polynomial, after Moshier's Cephes library, 1989; the polynomials of [`exp2`] and
//! [`pow`] by Remez' exchange) with a rare branch for arguments that it does not reach. Each function is right for every
//! `f32`, subnormal numbers and infinities included, on every instruction set. The stated errors hold with and without fused
//! multiply-add: against `f64` over a third of all `f32`, at AVX-512 and SSE2, none was larger.
//!
//! Errors are given in ulp (units in the last place of the result) or as absolute errors.

use fearless_simd::{Simd, prelude::*};
use std::f32::consts::{FRAC_2_PI, FRAC_PI_2, LOG2_E, PI};

/// 1.5 2^23: adding it rounds a number below 2^22 to a whole number, which then stands in the low bits.
const ROUNDER: f32 = 12_582_912.0;
/// Bits of sqrt(1/2): mantissas are taken from [sqrt(1/2), sqrt(2)).
const SQRT_HALF: i32 = 0x3f35_04f3;
/// The smallest number that is not subnormal.
const TINY: f32 = f32::MIN_POSITIVE;

/// `c[0] + x (c[1] + x (c[2] + ...))`.
#[inline(always)]
fn poly<S: Simd, const N: usize>(x: S::f32s, c: [f32; N]) -> S::f32s {
    let mut s = S::f32s::splat(x.token(), c[N - 1]);
    for i in (0..N - 1).rev() {
        s = s.mul_add(x, c[i]);
    }
    s
}

/// Both orders keep NaN: x86 gives the second operand where one is NaN, other sets give NaN.
#[inline(always)]
fn clamp<S: Simd>(x: S::f32s, lo: f32, hi: f32) -> S::f32s {
    let x = S::f32s::splat(x.token(), lo).max(x);
    S::f32s::splat(x.token(), hi).min(x)
}

/// `x 2^n`, where n in [-126, 129] stands in the low bits of a sum with [`ROUNDER`]: infinite from 2^128 on, zero for -126.
#[inline(always)]
fn scale<S: Simd>(x: S::f32s, n: S::f32s) -> S::f32s {
    // 2^(n - 1): zero for n = -126, infinite for n = 129, else a normal number
    let n: S::i32s = n.bitcast();
    let half: S::f32s = ((n + (126 - ROUNDER.to_bits() as i32)) << 23).bitcast();
    (x + x) * half
}

/// 2^r for r in [-0.52, 0.52], within 2.2e-8.
#[inline(always)]
fn exp2_small<S: Simd>(r: S::f32s) -> S::f32s {
    poly::<S, 7>(
        r,
        [
            1.0,
            6.931_472_4e-1,
            2.402_264_6e-1,
            5.550_315e-2,
            9.618_55e-3,
            1.340_531_6e-3,
            1.534_111_4e-4,
        ],
    )
}

/// Largest argument that [`sin_cos`] reduces in vector code.
const SIN_COS_REACH: f32 = 8192.0;

/// Sine and cosine of an angle in radians. Absolute error at most 1e-7; NaN for infinities.
///
/// Arguments beyond 8192 take a slow path, lane by lane.
#[inline(always)]
pub fn sin_cos<S: Simd>(x: S::f32s) -> (S::f32s, S::f32s) {
    let far = x.abs().simd_gt(SIN_COS_REACH);
    let (s, c) = sin_cos_near::<S>(x);
    if far.any_true() {
        let (x, mut s, mut c) = (x, s, c);
        sin_cos_far(x.as_slice(), s.as_mut_slice(), c.as_mut_slice());
        return (s, c);
    }
    (s, c)
}

#[cold]
#[inline(never)]
fn sin_cos_far(x: &[f32], s: &mut [f32], c: &mut [f32]) {
    for ((x, s), c) in x.iter().zip(s).zip(c) {
        if x.abs() > SIN_COS_REACH {
            let (a, b) = f64::from(*x).sin_cos();
            (*s, *c) = (a as f32, b as f32);
        }
    }
}

#[inline(always)]
fn sin_cos_near<S: Simd>(x: S::f32s) -> (S::f32s, S::f32s) {
    let t = x.mul_add(FRAC_2_PI, ROUNDER);
    let n = t - ROUNDER;
    // pi / 2 in three parts: 8 and 11 bits, whose products with n (13 bits) are exact, and the rest
    let r = n.mul_add(-1.570_312_5, x);
    let r = n.mul_add(-4.837_513e-4, r);
    let r = n.mul_add(-7.549_79e-8, r);
    let q: S::i32s = t.bitcast();
    let r2 = r * r;
    let s = (r * r2).mul_add(
        poly::<S, 3>(r2, [-1.666_665_5e-1, 8.332_161e-3, -1.951_529_6e-4]),
        r,
    );
    let c = (r2 * r2).mul_add(
        poly::<S, 3>(r2, [4.166_664_6e-2, -1.388_731_6e-3, 2.443_315_7e-5]),
        r2.mul_add(-0.5, 1.0),
    );
    let odd = (q & 1).simd_eq(1);
    let (ss, cc): (S::f32s, S::f32s) = (odd.select(c, s), odd.select(s, c));
    let s_sign: S::i32s = (q << 30) & i32::MIN;
    let c_sign: S::i32s = ((q + 1) << 30) & i32::MIN;
    let (si, ci): (S::i32s, S::i32s) = (ss.bitcast(), cc.bitcast());
    ((si ^ s_sign).bitcast(), (ci ^ c_sign).bitcast())
}

/// e to the power of x. At most 1.1 ulp off; results below 1.7e-38 may come out as zero.
#[inline(always)]
pub fn exp<S: Simd>(x: S::f32s) -> S::f32s {
    let x = clamp::<S>(x, -87.336_54, 89.0);
    let t = x.mul_add(LOG2_E, ROUNDER);
    let n = t - ROUNDER;
    // ln 2 in two parts, the first of 9 bits
    let r = n.mul_add(-0.693_359_4, x);
    let r = n.mul_add(2.121_944_4e-4, r);
    let p = poly::<S, 6>(
        r,
        [
            0.5,
            1.666_666_6e-1,
            4.166_579_6e-2,
            8.333_452e-3,
            1.398_199_9e-3,
            1.987_569_1e-4,
        ],
    );
    let y = (r * r).mul_add(p, r) + 1.0;
    scale::<S>(y, t)
}

/// 2 to the power of x. At most 1.4 ulp off; results below 1.7e-38 may come out as zero.
#[inline(always)]
pub fn exp2<S: Simd>(x: S::f32s) -> S::f32s {
    let x = clamp::<S>(x, -126.0, 129.0);
    let t = x + ROUNDER;
    scale::<S>(exp2_small::<S>(x - (t - ROUNDER)), t)
}

/// Whether every lane is positive, normal and finite.
#[inline(always)]
fn ordinary<S: Simd>(x: S::f32s) -> bool {
    (x.simd_ge(TINY) & x.simd_lt(f32::INFINITY)).all_true()
}

/// Exponent and mantissa less one, for positive normal x: `x = (1 + f) 2^e`, f in [sqrt(1/2) - 1, sqrt(2) - 1).
#[inline(always)]
fn split<S: Simd>(x: S::f32s) -> (S::f32s, S::f32s) {
    let i: S::i32s = x.bitcast();
    let e = (i - SQRT_HALF) >> 23;
    let m: S::f32s = (i - (e << 23)).bitcast();
    (e.to_float(), m - 1.0)
}

/// Natural logarithm; minus infinity at zero, NaN below. At most 0.9 ulp off.
///
/// Arguments that are not positive, normal and finite take a slow path, lane by lane.
#[inline(always)]
pub fn ln<S: Simd>(x: S::f32s) -> S::f32s {
    let y = ln_ordinary::<S>(x);
    if !ordinary::<S>(x) {
        let (x, mut y) = (x, y);
        ln_other(x.as_slice(), y.as_mut_slice());
        return y;
    }
    y
}

#[cold]
#[inline(never)]
fn ln_other(x: &[f32], y: &mut [f32]) {
    for (x, y) in x.iter().zip(y) {
        if !(TINY..f32::INFINITY).contains(x) {
            *y = x.ln();
        }
    }
}

#[inline(always)]
fn ln_ordinary<S: Simd>(x: S::f32s) -> S::f32s {
    let (e, f) = split::<S>(x);
    let z = f * f;
    let p = poly::<S, 9>(
        f,
        [
            3.333_333e-1,
            -2.499_999_4e-1,
            2.000_071_5e-1,
            -1.666_805_8e-1,
            1.424_932_3e-1,
            -1.242_014_1e-1,
            1.167_699_9e-1,
            -1.151_461e-1,
            7.037_683_6e-2,
        ],
    );
    let y = f * z * p;
    let y = e.mul_add(-2.121_944_4e-4, y);
    let y = z.mul_add(-0.5, y);
    e.mul_add(0.693_359_4, f + y)
}

/// Angle of the point (`x`, `y`) from the x axis, in [-pi, pi]; the signs of zeros count, as in `f32::atan2`. At most 2.5 ulp
/// off. NaN where both are infinite.
#[inline(always)]
pub fn atan2<S: Simd>(y: S::f32s, x: S::f32s) -> S::f32s {
    let (ax, ay) = (x.abs(), y.abs());
    let big = ax.max(ay);
    let a = ax.min(ay) / big;
    // the angle of the origin is that of its signed zeros
    let a = big.simd_eq(0.0).select(big, a);
    let p = a * poly::<S, 9>(a * a, ATAN);
    let p = ay.simd_gt(ax).select(-(p - FRAC_PI_2), p);
    let sign: S::i32s = x.bitcast();
    let p: S::f32s = sign.simd_lt(0).select(-(p - PI), p);
    p.copysign(y)
}
const ATAN: [f32; 9] = [
    1.0,
    -3.333_303_7e-1,
    1.999_187_2e-1,
    -1.419_779_8e-1,
    1.061_837e-1,
    -7.456_855e-2,
    4.213_762_4e-2,
    -1.573_125e-2,
    2.766_283_5e-3,
];

/// Largest exponent that [`pow`] takes in vector code.
const POW_REACH: f32 = 1e4;

/// x to the power of `k`, for x not below zero; NaN below. Relative error at most 1.5e-7 + 6e-8 |k|, and never above 7e-6;
/// results below 1.7e-38 may come out as zero.
///
/// Arguments that are subnormal, negative or not finite and `|k| > 1e4` take a slow path, lane by lane.
#[inline(always)]
pub fn pow<S: Simd>(x: S::f32s, k: f32) -> S::f32s {
    let y = pow_ordinary::<S>(x, k);
    if !ordinary::<S>(x) || k.abs() > POW_REACH {
        return pow_other::<S>(x, y, k);
    }
    y
}

/// The power where x is zero, subnormal, infinite, negative or NaN, or `k` is huge; `y` elsewhere.
#[cold]
#[inline(always)]
fn pow_other<S: Simd>(x: S::f32s, y: S::f32s, k: f32) -> S::f32s {
    let zero = x.simd_eq(0.0);
    let mut y = zero.select(S::f32s::splat(x.token(), 0.0_f32.powf(k)), y);
    let done = zero | (x.simd_ge(TINY) & x.simd_lt(f32::INFINITY));
    if !done.all_true() || k.abs() > POW_REACH {
        pow_lanes(x.as_slice(), k, y.as_mut_slice());
    }
    y
}

#[cold]
#[inline(never)]
fn pow_lanes(x: &[f32], k: f32, y: &mut [f32]) {
    for (x, y) in x.iter().zip(y) {
        *y = if *x < 0.0 { f32::NAN } else { x.abs().powf(k) };
    }
}

#[inline(always)]
fn pow_ordinary<S: Simd>(x: S::f32s, k: f32) -> S::f32s {
    let (e, f) = split::<S>(x);
    // log2(x) = e + l + l_lo
    let rest = f * poly::<S, 10>(f, LOG2);
    let l = f + rest;
    let l_lo = (f - l) + rest;
    // k = k_hi + k_lo, both of 12 bits, so that their products with e (8 bits) are exact
    let k_hi = f32::from_bits(k.to_bits() & !0xfff);
    let a = e * k_hi;
    let c = e * (k - k_hi);
    let t = clamp::<S>(l.mul_add(k, a), -126.0, 129.0) + ROUNDER;
    let r = l.mul_add(k, a - (t - ROUNDER)) + l_lo.mul_add(k, c);
    scale::<S>(exp2_small::<S>(r), t)
}

/// `(log2(1 + f) - f) / f` for f in [sqrt(1/2) - 1, sqrt(2) - 1), within 6.4e-9 / |f|.
const LOG2: [f32; 10] = [
    4.426_950_5e-1,
    -7.213_471_5e-1,
    4.808_981_4e-1,
    -3.607_088e-1,
    2.885_791_7e-1,
    -2.393_929_2e-1,
    2.042_893_6e-1,
    -1.923_528_2e-1,
    1.883_907_2e-1,
    -1.097_518_5e-1,
];
