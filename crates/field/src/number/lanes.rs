//! 4 to 16 points at once.
use super::{real::*, scalar::fold_slice};
use fearless_simd::{Simd, prelude::*};
use std::ops::*;

#[derive(Clone, Copy)] pub struct Lanes<S: Simd>(pub S::f32s);
#[derive(Clone, Copy)] pub struct LaneMask<S: Simd>(pub S::mask32s);

macro_rules! bin { ($($t:ident $f:ident),*) => {$(
    impl<S: Simd> $t for Lanes<S> { type Output = Self; #[inline(always)] fn $f(self, o: Self) -> Self { Lanes($t::$f(self.0, o.0)) } }
    impl<S: Simd> $t<f32> for Lanes<S> { type Output = Self; #[inline(always)] fn $f(self, o: f32) -> Self { Lanes($t::$f(self.0, o)) } }
)*}; }
bin!(Add add, Sub sub, Mul mul, Div div);
impl<S: Simd> Neg for Lanes<S> { type Output = Self; #[inline(always)] fn neg(self) -> Self { Lanes(-self.0) } }
impl<S: Simd> BitAnd for LaneMask<S> { type Output = Self; #[inline(always)] fn bitand(self, o: Self) -> Self { LaneMask(self.0 & o.0) } }
impl<S: Simd> BitOr for LaneMask<S> { type Output = Self; #[inline(always)] fn bitor(self, o: Self) -> Self { LaneMask(self.0 | o.0) } }
impl<S: Simd> Not for LaneMask<S> { type Output = Self; #[inline(always)] fn not(self) -> Self { LaneMask(!self.0) } }
impl<S: Simd> Masked for Lanes<S> { type Mask = LaneMask<S>; }
impl<S: Simd> Ops<Lanes<S>> for Lanes<S> {
    #[inline(always)] fn min(self, o: Self) -> Self { Lanes(self.0.min(o.0)) }
    #[inline(always)] fn max(self, o: Self) -> Self { Lanes(self.0.max(o.0)) }
    #[inline(always)] fn below(self, o: Self) -> LaneMask<S> { LaneMask(self.0.simd_lt(o.0)) }
    #[inline(always)] fn above(self, o: Self) -> LaneMask<S> { LaneMask(self.0.simd_gt(o.0)) }
}
impl<S: Simd> Ops<f32> for Lanes<S> {
    #[inline(always)] fn min(self, o: f32) -> Self { Lanes(self.0.min(o)) }
    #[inline(always)] fn max(self, o: f32) -> Self { Lanes(self.0.max(o)) }
    #[inline(always)] fn below(self, o: f32) -> LaneMask<S> { LaneMask(self.0.simd_lt(o)) }
    #[inline(always)] fn above(self, o: f32) -> LaneMask<S> { LaneMask(self.0.simd_gt(o)) }
}

impl<S: Simd> Real for Lanes<S> {
    type Base = Self;
    type Scalar = f32;
    type Store = [f32];
    #[inline(always)] fn param(a: &[f32], i: usize) -> Self::Scalar { a[i] }
    #[inline(always)] fn constant(c: f64) -> f32 { c as f32 }
    #[inline(always)] fn like(self, s: f32) -> Self { Lanes(S::f32s::splat(self.0.token(), s)) }
    #[inline(always)] fn lit(self, s: f32) -> Self { Lanes(S::f32s::splat(self.0.token(), s)) }
    #[inline(always)] fn select(m: LaneMask<S>, a: Self, b: Self) -> Self { Lanes(m.0.select(a.0, b.0)) }
    #[inline(always)] fn sqrt(self) -> Self { Lanes(self.0.sqrt()) }
    #[inline(always)] fn abs(self) -> Self { Lanes(self.0.abs()) }
    #[inline(always)] fn floor(self) -> Self { Lanes(self.0.floor()) }
    #[inline(always)] fn sin_cos(self) -> (Self, Self) { let (s, c) = sin_cos::<S>(self.0); (Lanes(s), Lanes(c)) }
    #[inline(always)] fn exp(self) -> Self { Lanes(exp::<S>(self.0)) }
    #[inline(always)] fn ln(self) -> Self { Lanes(ln::<S>(self.0)) }
    #[inline(always)] fn atan2(self, x: Self) -> Self { Lanes(atan2::<S>(self.0, x.0)) }
    #[inline(always)] fn powf(self, k: f32) -> Self { Lanes(pow::<S>(self.0, k)) }
    #[inline(always)]
    fn repeat_while<T: State<Self>>(limit: f32, init: T, live: impl Fn(T) -> LaneMask<S>, step: impl Fn(T) -> T) -> T {
        let mut s = init;
        for _ in 0..limit as u32 {
            let m = live(s).0;
            if !m.any_true() { break; }
            s = step(s).zip(s, #[inline(always)] |new: Self, old: Self| Lanes(m.select(new.0, old.0)));
        }
        s
    }
    #[inline(always)]
    fn fold<const W: usize, T: State<Self>>(store: &[f32], at: usize, ends: Ends, init: T, step: impl Fn(T, [f32; W], [f32; W]) -> T) -> T {
        fold_slice(&store[at..], ends, init, #[inline(always)] |c| c, step)
    }
}
impl<S: Simd> State<Lanes<S>> for Lanes<S> { #[inline(always)] fn zip(self, o: Self, f: impl Fn(Self, Self) -> Self + Copy) -> Self { f(self, o) } }

/// Horner with fused steps: c[0] + x (c[1] + ...).
#[inline(always)]
fn poly<S: Simd, const N: usize>(x: S::f32s, c: [f32; N]) -> S::f32s {
    let mut s = S::f32s::splat(x.token(), c[N - 1]);
    for i in (0..N - 1).rev() { s = s.mul_add(x, c[i]); }
    s
}

#[inline(always)]
pub fn sin_cos<S: Simd>(x: S::f32s) -> (S::f32s, S::f32s) {
    let n = (x * std::f32::consts::FRAC_2_PI).round_ties_even();
    let r = n.mul_add(-1.570_312_5, x);
    let r = n.mul_add(-4.837_513e-4, r);
    let r = n.mul_add(-7.549_79e-8, r);
    let q: S::i32s = n.to_int();
    let r2 = r * r;
    let s = (r * r2).mul_add(poly::<S, 3>(r2, [-1.666_665_5e-1, 8.332_161e-3, -1.951_529_6e-4]), r);
    let c = (r2 * r2).mul_add(poly::<S, 3>(r2, [4.166_664_6e-2, -1.388_731_6e-3, 2.443_315_7e-5]), r2.mul_add(-0.5, 1.0));
    let odd = (q & 1).simd_eq(1);
    let (ss, cc): (S::f32s, S::f32s) = (odd.select(c, s), odd.select(s, c));
    let sb: S::i32s = (q << 30) & i32::MIN;
    let cb: S::i32s = ((q + 1) << 30) & i32::MIN;
    let (si, ci): (S::i32s, S::i32s) = (ss.bitcast(), cc.bitcast());
    ((si ^ sb).bitcast(), (ci ^ cb).bitcast())
}

#[inline(always)]
pub fn exp<S: Simd>(x: S::f32s) -> S::f32s {
    let x = x.max(-87.3).min(88.3);
    let n = (x * std::f32::consts::LOG2_E).round_ties_even();
    let r = n.mul_add(-0.693_359_4, x);
    let r = n.mul_add(2.121_944_4e-4, r);
    let p = poly::<S, 6>(r, [5.000_000_1e-1, 1.666_666_6e-1, 4.166_579_6e-2, 8.333_452e-3, 1.398_199_9e-3, 1.987_569_1e-4]);
    let y = (r * r).mul_add(p, r) + 1.0;
    let q: S::i32s = n.to_int();
    let scale: S::f32s = ((q + 127) << 23).bitcast();
    y * scale
}

/// x > 0, normal.
#[inline(always)]
pub fn ln<S: Simd>(x: S::f32s) -> S::f32s {
    let i: S::i32s = x.bitcast();
    // exponent such that the mantissa lies in [sqrt(1/2), sqrt(2))
    let k: S::i32s = (i - 0x3f35_04f3) >> 23;
    let m: S::f32s = (i - (k << 23)).bitcast();
    let e: S::f32s = k.to_float();
    let f = m - 1.0;
    let z = f * f;
    let p = poly::<S, 9>(f, [3.333_333_1e-1, -2.499_999_4e-1, 2.000_071_5e-1, -1.666_805_8e-1, 1.424_932_3e-1, -1.242_014_1e-1, 1.167_699_9e-1, -1.151_461e-1, 7.037_683_6e-2]);
    let y = f * z * p;
    let y = e.mul_add(-2.121_944_4e-4, y);
    let y = z.mul_add(-0.5, y);
    e.mul_add(0.693_359_4, f + y)
}

#[inline(always)]
pub fn atan2<S: Simd>(y: S::f32s, x: S::f32s) -> S::f32s {
    let (ax, ay) = (x.abs(), y.abs());
    let big = ax.max(ay).max(1e-37);
    let a = ax.min(ay) / big;
    let t = a * a;
    let p = a * poly::<S, 9>(t, ATAN);
    let p = ay.simd_gt(ax).select(-(p - std::f32::consts::FRAC_PI_2), p);
    let p = x.simd_lt(0.0).select(-(p - std::f32::consts::PI), p);
    p.copysign(y)
}
const ATAN: [f32; 9] = [9.999_999_818e-1, -3.333_303_671e-1, 1.999_187_203e-1, -1.419_779_779e-1, 1.061_837_064e-1, -7.456_854_825e-2, 4.213_762_358e-2, -1.573_124_912e-2, 2.766_283_500e-3];

/// x > 0, normal. The exponent's share of the logarithm is kept apart, so that its product with k does not round.
#[inline(always)]
pub fn pow<S: Simd>(x: S::f32s, k: f32) -> S::f32s {
    let i: S::i32s = x.bitcast();
    let b: S::i32s = (i - 0x3f35_04f3) >> 23;
    let m: S::f32s = (i - (b << 23)).bitcast();
    let e: S::f32s = b.to_float();
    let f = m - 1.0;
    let z = f * f;
    let p = poly::<S, 9>(f, [3.333_333_1e-1, -2.499_999_4e-1, 2.000_071_5e-1, -1.666_805_8e-1, 1.424_932_3e-1, -1.242_014_1e-1, 1.167_699_9e-1, -1.151_461e-1, 7.037_683_6e-2]);
    let tail = z.mul_add(-0.5, f * z * p);
    // log2(m) = (f + tail) log2 e, with f log2 e split in two
    let (hi, lo) = (1.442_382_8_f32, 3.122_285_3e-4_f32); // log2 e = hi + lo, hi has 11 bits
    let l_hi = f * hi;
    let l_lo = f.mul_add(lo, tail * std::f32::consts::LOG2_E);
    let ke = e * k;
    let n = (l_hi + l_lo).mul_add(k, ke).round_ties_even();
    let n = n.max(-126.0).min(127.0);
    let r = e.mul_add(k, -n) + l_hi * k + l_lo * k;
    let q = poly::<S, 7>(r, [1.0, 6.931_472e-1, 2.402_264_7e-1, 5.550_357e-2, 9.618_437e-3, 1.339_887_4e-3, 1.535_336_3e-4]);
    let ni: S::i32s = n.to_int();
    let scale: S::f32s = ((ni + 127) << 23).bitcast();
    q * scale
}
