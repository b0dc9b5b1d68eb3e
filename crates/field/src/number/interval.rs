//! A proven range: every operation rounds outwards.
use super::{real::*, vector::*};
use std::ops::*;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval { pub lo: f64, pub hi: f64 }
/// What a condition may be, over a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maybe { pub yes: bool, pub no: bool }
impl BitAnd for Maybe { type Output = Self; fn bitand(self, o: Self) -> Self { Maybe { yes: self.yes && o.yes, no: self.no || o.no } } }
impl BitOr for Maybe { type Output = Self; fn bitor(self, o: Self) -> Self { Maybe { yes: self.yes || o.yes, no: self.no && o.no } } }
impl Not for Maybe { type Output = Self; fn not(self) -> Self { Maybe { yes: self.no, no: self.yes } } }

pub const WHOLE: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
pub(super) fn dn(x: f64) -> f64 { if x.is_nan() { f64::NEG_INFINITY } else { x.next_down() } }
pub(super) fn up(x: f64) -> f64 { if x.is_nan() { f64::INFINITY } else { x.next_up() } }
/// 0 * inf = 0: an endpoint that is infinite stands for every large number.
fn mul(a: f64, b: f64) -> f64 { if a == 0.0 || b == 0.0 { 0.0 } else { a * b } }
impl Interval {
    pub fn new(lo: f64, hi: f64) -> Self { Interval { lo, hi } }
    pub fn point(x: f64) -> Self { Interval { lo: x, hi: x } }
    pub fn hull(self, o: Self) -> Self { Interval { lo: self.lo.min(o.lo), hi: self.hi.max(o.hi) } }
    /// What both hold; self where that is nothing.
    pub(super) fn intersect(self, o: Self) -> Self { let r = Interval { lo: self.lo.max(o.lo), hi: self.hi.min(o.hi) }; if r.lo <= r.hi { r } else { self } }
    pub fn contains(self, x: f64) -> bool { self.lo <= x && x <= self.hi }
    pub fn mag(self) -> f64 { self.lo.abs().max(self.hi.abs()) }
    /// Monotone f, correct to about an ulp or two.
    fn mono(self, f: impl Fn(f64) -> f64) -> Self { Interval { lo: dn(dn(f(self.lo))), hi: up(up(f(self.hi))) } }
}
impl From<f32> for Interval { fn from(x: f32) -> Self { Interval::point(x as f64) } }
impl Neg for Interval { type Output = Self; fn neg(self) -> Self { Interval { lo: -self.hi, hi: -self.lo } } }
impl Add for Interval { type Output = Self; fn add(self, o: Self) -> Self { Interval { lo: dn(self.lo + o.lo), hi: up(self.hi + o.hi) } } }
impl Sub for Interval { type Output = Self; fn sub(self, o: Self) -> Self { self + -o } }
impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let c = [mul(self.lo, o.lo), mul(self.lo, o.hi), mul(self.hi, o.lo), mul(self.hi, o.hi)];
        Interval { lo: dn(c.iter().copied().fold(f64::INFINITY, f64::min)), hi: up(c.iter().copied().fold(f64::NEG_INFINITY, f64::max)) }
    }
}
impl Div for Interval {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if o.lo > 0.0 || o.hi < 0.0 { self * Interval { lo: dn(1.0 / o.hi), hi: up(1.0 / o.lo) } }
        else if o.lo == 0.0 && o.hi > 0.0 { self * Interval { lo: dn(1.0 / o.hi), hi: f64::INFINITY } }
        else { WHOLE }
    }
}
macro_rules! lit { ($($t:ident $f:ident),*) => {$( impl $t<f32> for Interval { type Output = Self; fn $f(self, o: f32) -> Self { $t::$f(self, Interval::from(o)) } } )*}; }
lit!(Add add, Sub sub, Mul mul, Div div);
impl Masked for Interval { type Mask = Maybe; }
macro_rules! ops { ($($t:ty),*) => {$( impl Ops<$t> for Interval {
    fn min(self, o: $t) -> Self { let o: Interval = o.into(); Interval { lo: self.lo.min(o.lo), hi: self.hi.min(o.hi) } }
    fn max(self, o: $t) -> Self { let o: Interval = o.into(); Interval { lo: self.lo.max(o.lo), hi: self.hi.max(o.hi) } }
    fn below(self, o: $t) -> Maybe { let o: Interval = o.into(); Maybe { yes: self.lo < o.hi, no: self.hi >= o.lo } }
    fn above(self, o: $t) -> Maybe { let o: Interval = o.into(); o.below(self) }
} )*}; }
ops!(Interval, f32);

impl Real for Interval {
    type Base = Self;
    type Scalar = Interval;
    type Store = [f32];
    #[inline(always)] fn param(a: &[f32], i: usize) -> Self::Scalar { a[i].into() }
    fn constant(c: f64) -> Self { Interval { lo: dn(c), hi: up(c) } }
    fn like(self, s: Self) -> Self { s }
    fn lit(self, c: f32) -> Self { c.into() }
    /// Both branches where it is undecided: `select` is for functions that agree where the condition flips.
    fn select(m: Maybe, a: Self, b: Self) -> Self { match m { Maybe { no: false, .. } => a, Maybe { yes: false, .. } => b, _ => a.hull(b) } }
    fn sqrt(self) -> Self { Interval { lo: dn(self.lo.max(0.0).sqrt()).max(0.0), hi: up(self.hi.max(0.0).sqrt()) } }
    fn abs(self) -> Self { if self.lo >= 0.0 { self } else if self.hi <= 0.0 { -self } else { Interval { lo: 0.0, hi: self.mag() } } }
    fn floor(self) -> Self { Interval { lo: self.lo.floor(), hi: self.hi.floor() } }
    fn sq(self) -> Self { let a = self.abs(); Interval { lo: dn(a.lo * a.lo).max(0.0), hi: up(a.hi * a.hi) } }
    fn norm<const N: usize>(v: [Self; N]) -> Self { let mut s = v[0].sq(); for i in 1..N { s = s + v[i].sq(); } s.sqrt() }
    fn unit(self, norm: Self) -> Self { let q = self / norm; Interval { lo: q.lo.clamp(-1.0, 1.0), hi: q.hi.clamp(-1.0, 1.0) } }
    fn step_slope(self, stepped: Self) -> Self { if stepped.lo < stepped.hi { WHOLE } else { Interval::point(0.0) } }
    fn sin_cos(self) -> (Self, Self) { let q = std::f64::consts::FRAC_PI_2; (cosine(self - Interval { lo: dn(q), hi: up(q) }), cosine(self)) }
    fn exp(self) -> Self { let r = self.mono(f64::exp); Interval { lo: r.lo.max(0.0), hi: r.hi } }
    fn ln(self) -> Self { if self.lo <= 0.0 { Interval { lo: f64::NEG_INFINITY, hi: up(up(self.hi.max(0.0).ln())) } } else { self.mono(f64::ln) } }
    fn powf(self, k: Self) -> Self { (self.ln() * k).exp() }
    fn atan2(self, x: Self) -> Self {
        let pi = up(std::f64::consts::PI);
        if x.lo <= 0.0 && self.lo <= 0.0 && self.hi >= 0.0 { return Interval { lo: -pi, hi: pi }; }
        let c = [self.lo.atan2(x.lo), self.lo.atan2(x.hi), self.hi.atan2(x.lo), self.hi.atan2(x.hi)];
        Interval { lo: dn(dn(c.iter().copied().fold(f64::INFINITY, f64::min))), hi: up(up(c.iter().copied().fold(f64::NEG_INFINITY, f64::max))) }
    }
    fn jump_slope(m: Maybe, slope: Self) -> Self { if m.yes && m.no { WHOLE } else { slope } }
    fn proven(self, lo: f32, hi: f32, _at: Vec3<Self>, _slope: f32) -> Self { let c = |x: f64| x.clamp(lo as f64, hi as f64); Interval { lo: c(self.lo), hi: c(self.hi) } }
    fn bounded_slope(p: Vec3<Self>, slope: f32, f: impl Fn(Vec3<Self>) -> Self) -> Self {
        let (centre, reach) = middle(p);
        let direct = f(p);
        if !reach.is_finite() { return direct; }
        let around = f(centre.map(Interval::point));
        let by = up(slope as f64 * reach);
        direct.intersect(Interval { lo: dn(around.lo - by), hi: up(around.hi + by) })
    }
    fn whole(self) -> Self { let r = Interval { lo: self.lo.ceil(), hi: self.hi.floor() }; if r.lo <= r.hi { r } else { self } }
    fn fract(self) -> Self { let f = self.floor(); if f.lo < f.hi { Interval { lo: 0.0, hi: 1.0 } } else { self - f } }
    fn modulo<C: Copy>(self, c: C) -> Self where Self: Ops<C> { modulo(self, self.lit(1.0) * c) }
    fn repeat_while<T: State<Self>>(limit: Self, init: T, live: impl Fn(T) -> Maybe, step: impl Fn(T) -> T) -> T {
        // `done` gathers what may have left; `s` is what may still run.
        let (mut s, mut done): (T, Option<T>) = (init, None);
        let join = |d: Option<T>, s: T| Some(match d { None => s, Some(d) => d.zip(s, |a: Interval, b: Interval| a.hull(b)) });
        for i in 0..limit.hi as u32 {
            let m = live(s);
            if m.no || i as f64 >= limit.lo { done = join(done, s); }
            if !m.yes { return done.unwrap(); }
            s = step(s);
        }
        join(done, s).unwrap()
    }
    fn fold<const W: usize, T: State<Self>>(store: &[f32], at: usize, ends: Ends, init: T, step: impl Fn(T, [Self; W], [Self; W]) -> T) -> T {
        super::list::fold_list(store, at, ends, init, |s, a: [f32; W], b: [f32; W]| step(s, a.map(Into::into), b.map(Into::into)))
    }
}
/// The centre of a box, and how far from it the corners are.
pub(super) fn middle(p: Vec3<Interval>) -> (Vec3<f64>, f64) {
    let centre = p.map(|c| 0.5 * (c.lo + c.hi));
    let away = |c: Interval, m: f64| up(c.hi - m).max(up(m - c.lo));
    let half = [away(p.x, centre.x), away(p.y, centre.y), away(p.z, centre.z)];
    (centre, half.iter().map(|h| h * h).sum::<f64>().sqrt() * (1.0 + 1e-15))
}
impl State<Interval> for Interval { fn zip(self, o: Self, f: impl Fn(Self, Self) -> Self + Copy) -> Self { f(self, o) } }
fn cosine(x: Interval) -> Interval {
    use std::f64::consts::{PI, TAU};
    if !(x.hi - x.lo < TAU) || x.mag() > 1e9 { return Interval { lo: -1.0, hi: 1.0 }; }
    let (a, b) = (x.lo.cos(), x.hi.cos());
    // does [lo, hi] hold a multiple of 2 pi (maximum), or an odd multiple of pi (minimum)? Widened by a hair.
    let e = 1e-6;
    let has = |off: f64| ((x.hi - off + e) / TAU).floor() >= ((x.lo - off - e) / TAU).ceil();
    Interval { lo: if has(PI) { -1.0 } else { dn(dn(a.min(b))).max(-1.0) }, hi: if has(0.0) { 1.0 } else { up(up(a.max(b))).min(1.0) } }
}
fn modulo(x: Interval, c: Interval) -> Interval { let f = (x / c).floor(); if f.lo < f.hi { c.hull(Interval::point(0.0)) } else { x - f * c } }
