//! A range, a range of gradients, and a bound on the gradient's length: for proofs of Lipschitz constants.
use super::{interval::*, real::*, vector::*};
use std::ops::*;
#[derive(Clone, Copy, Debug)]
pub struct Slope { pub v: Interval, pub d: [Interval; 3], pub l: f64 }
fn len(d: [Interval; 3]) -> f64 { let s: f64 = d.iter().map(|x| x.mag() * x.mag()).sum(); if s.is_nan() { f64::INFINITY } else { s.sqrt() * (1.0 + 1e-15) } }
fn times(a: f64, b: f64) -> f64 { if a == 0.0 || b == 0.0 { 0.0 } else { a * b } }
/// Largest singular value of the derivative J of v: sqrt(largest eigenvalue of J J^T) <= sqrt(largest row sum).
fn rows<const N: usize>(v: [Slope; N]) -> f64 {
    let gram = |i: usize, j: usize| if i == j { v[i].l * v[i].l } else { let s = (0..3).fold(Interval::point(0.0), |s, k| s + v[i].d[k] * v[j].d[k]); s.mag().min(times(v[i].l, v[j].l)) };
    (0..N).map(|i| (0..N).map(|j| gram(i, j)).sum::<f64>()).fold(0.0, f64::max).sqrt() * (1.0 + 1e-14)
}
impl Slope {
    fn new(v: Interval, d: [Interval; 3], l: f64) -> Self { Slope { v, d, l: l.min(len(d)) } }
    fn chain(self, v: Interval, s: Interval) -> Self { Slope::new(v, self.d.map(|x| x * s), times(self.l, s.mag())) }
    fn flat(v: Interval) -> Self { Slope { v, d: [Interval::point(0.0); 3], l: 0.0 } }
    pub fn point(p: Vec3<Interval>) -> Vec3<Slope> {
        let (o, l) = (Interval::point(0.0), Interval::point(1.0));
        v3(Slope { v: p.x, d: [l, o, o], l: 1.0 }, Slope { v: p.y, d: [o, l, o], l: 1.0 }, Slope { v: p.z, d: [o, o, l], l: 1.0 })
    }
    fn pick(m: Maybe, v: Interval, a: Self, b: Self) -> Self {
        match m { Maybe { no: false, .. } => Slope { v, ..a }, Maybe { yes: false, .. } => Slope { v, ..b }, _ => Slope::new(v, [0, 1, 2].map(|k| a.d[k].hull(b.d[k])), a.l.max(b.l)) }
    }
}
impl Neg for Slope { type Output = Self; fn neg(self) -> Self { Slope { v: -self.v, d: self.d.map(|x| -x), l: self.l } } }
impl Add for Slope { type Output = Self; fn add(self, o: Self) -> Self { Slope::new(self.v + o.v, [0, 1, 2].map(|k| self.d[k] + o.d[k]), self.l + o.l) } }
impl Sub for Slope { type Output = Self; fn sub(self, o: Self) -> Self { self + -o } }
impl Mul for Slope { type Output = Self; fn mul(self, o: Self) -> Self { Slope::new(self.v * o.v, [0, 1, 2].map(|k| self.d[k] * o.v + o.d[k] * self.v), times(self.l, o.v.mag()) + times(o.l, self.v.mag())) } }
impl Div for Slope { type Output = Self; fn div(self, o: Self) -> Self { let i = Interval::point(1.0) / o.v; self * o.chain(i, -(i * i)) } }
macro_rules! sc { ($($t:ty),*) => {$(
    impl Add<$t> for Slope { type Output = Self; fn add(self, o: $t) -> Self { Slope { v: self.v + o, ..self } } }
    impl Sub<$t> for Slope { type Output = Self; fn sub(self, o: $t) -> Self { Slope { v: self.v - o, ..self } } }
    impl Mul<$t> for Slope { type Output = Self; fn mul(self, o: $t) -> Self { self.chain(self.v * o, o.into()) } }
    impl Div<$t> for Slope { type Output = Self; fn div(self, o: $t) -> Self { self.chain(self.v / o, Interval::point(1.0) / o) } }
    impl Ops<$t> for Slope {
        fn min(self, o: $t) -> Self { Slope::pick(self.v.below(o), self.v.min(o), self, Slope::flat(o.into())) }
        fn max(self, o: $t) -> Self { Slope::pick(self.v.above(o), self.v.max(o), self, Slope::flat(o.into())) }
        fn below(self, o: $t) -> Maybe { self.v.below(o) }
        fn above(self, o: $t) -> Maybe { self.v.above(o) }
    } )*}; }
sc!(Interval, f32);
impl Masked for Slope { type Mask = Maybe; }
impl Ops<Slope> for Slope {
    fn min(self, o: Self) -> Self { Slope::pick(self.v.below(o.v), self.v.min(o.v), self, o) }
    fn max(self, o: Self) -> Self { Slope::pick(self.v.above(o.v), self.v.max(o.v), self, o) }
    fn below(self, o: Self) -> Maybe { self.v.below(o.v) }
    fn above(self, o: Self) -> Maybe { self.v.above(o.v) }
}
impl State<Interval> for Slope { fn zip(self, o: Self, f: impl Fn(Interval, Interval) -> Interval + Copy) -> Self { let d = [0, 1, 2].map(|k| f(self.d[k], o.d[k])); Slope { v: f(self.v, o.v), d, l: len(d) } } }
impl Real for Slope {
    type Base = Interval;
    type Scalar = Interval;
    type Store = [f32];
    fn param(s: &[f32], at: usize) -> Interval { s[at].into() }
    fn constant(c: f64) -> Interval { Interval::constant(c) }
    fn like(self, s: Interval) -> Self { Slope::flat(s) }
    fn lit(self, c: f32) -> Self { Slope::flat(c.into()) }
    fn select(m: Maybe, a: Self, b: Self) -> Self { Slope::pick(m, Interval::select(m, a.v, b.v), a, b) }
    fn choose(m: Maybe, a: Self, b: Self) -> Self { let mut s = Slope::select(m, a, b); if m.yes && m.no { s.d = [WHOLE; 3]; s.l = f64::INFINITY; } s }
    fn fract(self) -> Self { let mut s = self - self.floor(); s.v = self.v.fract(); s }
    fn proven(self, lo: f32, hi: f32, at: Vec3<Self>, slope: f32) -> Self {
        let axis = |k: usize| times(slope as f64, len([at.x.d[k], at.y.d[k], at.z.d[k]]));
        let d = [0, 1, 2].map(|k| { let b = up(axis(k)); Interval { lo: self.d[k].lo.clamp(-b, b), hi: self.d[k].hi.clamp(-b, b) } });
        Slope::new(self.v.proven(lo, hi, at.map(|c| c.v), slope), d, self.l.min(up(times(slope as f64, rows([at.x, at.y, at.z])))))
    }
    fn bounded_slope(p: Vec3<Self>, slope: f32, f: impl Fn(Vec3<Self>) -> Self) -> Self {
        let at = p.map(|c| c.v);
        let (centre, reach) = middle(at);
        let direct = f(p).proven(f32::NEG_INFINITY, f32::INFINITY, p, slope);
        if !reach.is_finite() { return direct; }
        let around = f(centre.map(|c| Slope::flat(Interval::point(c)))).v;
        let by = up(slope as f64 * reach);
        Slope { v: direct.v.intersect(Interval::new(around.lo - by, around.hi + by)), ..direct }
    }
    fn whole(self) -> Self { Slope { v: self.v.whole(), ..self } }
    fn sqrt(self) -> Self { let r = self.v.sqrt(); self.chain(r, Interval::point(0.5) / r) }
    fn abs(self) -> Self { Slope::pick(self.v.below(0.0), self.v.abs(), -self, self) }
    fn floor(self) -> Self { let f = self.v.floor(); self.chain(f, self.v.step_slope(f)) }
    fn sin_cos(self) -> (Self, Self) { let (s, c) = self.v.sin_cos(); (self.chain(s, c), self.chain(c, -s)) }
    fn exp(self) -> Self { let e = self.v.exp(); self.chain(e, e) }
    fn ln(self) -> Self { self.chain(self.v.ln(), Interval::point(1.0) / self.v) }
    fn atan2(self, x: Self) -> Self { let i = Interval::point(1.0) / (x.v.sq() + self.v.sq()); let mut r = self * Slope::flat(x.v * i) - x * Slope::flat(self.v * i); r.v = self.v.atan2(x.v); r }
    fn powf(self, k: Interval) -> Self { let q = self.v.powf(k - 1.0); self.chain(q * self.v, q * k) }
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let u = v.map(|x| x.v);
        let r = Interval::norm(u);
        let mut d = [Interval::point(0.0); 3];
        for i in 0..N { let q = u[i].unit(r); for k in 0..3 { d[k] = d[k] + v[i].d[k] * q; } }
        Slope::new(r, d, rows(v))
    }
    fn repeat_while<T: State<Interval>>(limit: Interval, init: T, live: impl Fn(T) -> Maybe, step: impl Fn(T) -> T) -> T { Interval::repeat_while(limit, init, live, step) }
    fn fold<const W: usize, T: State<Interval>>(s: &[f32], at: usize, ends: Ends, init: T, step: impl Fn(T, [Interval; W], [Interval; W]) -> T) -> T { Interval::fold(s, at, ends, init, step) }
}
