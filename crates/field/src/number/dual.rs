//! Value and gradient, over any number type.
use super::{expr::Expr, interval::Interval, real::*, scalar::F64, vector::*};
use std::ops::*;

#[derive(Clone, Copy, Debug)]
pub struct Dual<R> { pub v: R, pub d: [R; 3] }
impl<R: Real> Dual<R> {
    /// The coordinates themselves.
    #[inline(always)]
    pub fn point(p: Vec3<R>) -> Vec3<Dual<R>> {
        let (o, l) = (p.x.lit(0.0), p.x.lit(1.0));
        v3(Dual { v: p.x, d: [l, o, o] }, Dual { v: p.y, d: [o, l, o] }, Dual { v: p.z, d: [o, o, l] })
    }
    #[inline(always)] fn chain(self, v: R, slope: R) -> Self { Dual { v, d: [self.d[0] * slope, self.d[1] * slope, self.d[2] * slope] } }
    #[inline(always)] fn flat(self, v: R) -> Self { let o = v.lit(0.0); Dual { v, d: [o, o, o] } }
    #[inline(always)] fn pick(m: R::Mask, a: [R; 3], b: [R; 3]) -> [R; 3] { [R::select(m, a[0], b[0]), R::select(m, a[1], b[1]), R::select(m, a[2], b[2])] }
}
impl<R: Real> Neg for Dual<R> { type Output = Self; #[inline(always)] fn neg(self) -> Self { Dual { v: -self.v, d: [-self.d[0], -self.d[1], -self.d[2]] } } }
impl<R: Real> Add for Dual<R> { type Output = Self; #[inline(always)] fn add(self, o: Self) -> Self { Dual { v: self.v + o.v, d: [self.d[0] + o.d[0], self.d[1] + o.d[1], self.d[2] + o.d[2]] } } }
impl<R: Real> Sub for Dual<R> { type Output = Self; #[inline(always)] fn sub(self, o: Self) -> Self { Dual { v: self.v - o.v, d: [self.d[0] - o.d[0], self.d[1] - o.d[1], self.d[2] - o.d[2]] } } }
impl<R: Real> Mul for Dual<R> { type Output = Self; #[inline(always)] fn mul(self, o: Self) -> Self { Dual { v: self.v * o.v, d: [self.d[0] * o.v + o.d[0] * self.v, self.d[1] * o.v + o.d[1] * self.v, self.d[2] * o.v + o.d[2] * self.v] } } }
impl<R: Real> Div for Dual<R> { type Output = Self; #[inline(always)] fn div(self, o: Self) -> Self {
    let i = o.v.lit(1.0) / o.v; let q = self.v / o.v;
    Dual { v: q, d: [(self.d[0] - o.d[0] * q) * i, (self.d[1] - o.d[1] * q) * i, (self.d[2] - o.d[2] * q) * i] } } }
impl<R: Real> Masked for Dual<R> { type Mask = R::Mask; }
impl<R: Real> Ops<Dual<R>> for Dual<R> {
    #[inline(always)] fn min(self, o: Self) -> Self { Dual { v: self.v.min(o.v), d: Self::pick(self.v.below(o.v), self.d, o.d) } }
    #[inline(always)] fn max(self, o: Self) -> Self { Dual { v: self.v.max(o.v), d: Self::pick(self.v.above(o.v), self.d, o.d) } }
    #[inline(always)] fn below(self, o: Self) -> R::Mask { self.v.below(o.v) }
    #[inline(always)] fn above(self, o: Self) -> R::Mask { self.v.above(o.v) }
}
macro_rules! scalar { ([$($g:tt)*] $d:ty, $s:ty) => {
    impl<$($g)*> Add<$s> for $d { type Output = Self; #[inline(always)] fn add(self, o: $s) -> Self { Dual { v: self.v + o, d: self.d } } }
    impl<$($g)*> Sub<$s> for $d { type Output = Self; #[inline(always)] fn sub(self, o: $s) -> Self { Dual { v: self.v - o, d: self.d } } }
    impl<$($g)*> Mul<$s> for $d { type Output = Self; #[inline(always)] fn mul(self, o: $s) -> Self { Dual { v: self.v * o, d: [self.d[0] * o, self.d[1] * o, self.d[2] * o] } } }
    impl<$($g)*> Div<$s> for $d { type Output = Self; #[inline(always)] fn div(self, o: $s) -> Self { Dual { v: self.v / o, d: [self.d[0] / o, self.d[1] / o, self.d[2] / o] } } }
    impl<$($g)*> Ops<$s> for $d {
        #[inline(always)] fn min(self, o: $s) -> Self { let v = self.v.min(o); Dual { v, d: Self::pick(self.v.below(o), self.d, self.flat(v).d) } }
        #[inline(always)] fn max(self, o: $s) -> Self { let v = self.v.max(o); Dual { v, d: Self::pick(self.v.above(o), self.d, self.flat(v).d) } }
        #[inline(always)] fn below(self, o: $s) -> Self::Mask { self.v.below(o) }
        #[inline(always)] fn above(self, o: $s) -> Self::Mask { self.v.above(o) }
    }
}; }
scalar!([R: Real] Dual<R>, f32); // literals; and parameters where Scalar is f32
scalar!([] Dual<F64>, F64);
scalar!([] Dual<Interval>, Interval);
scalar!(['e] Dual<Expr<'e>>, Expr<'e>);

impl<R: Real> Real for Dual<R> where Self: Ops<R::Scalar> + Masked<Mask = R::Mask> {
    type Base = R::Base;
    type Scalar = R::Scalar;
    type Store = R::Store;
    #[inline(always)] fn param(s: &R::Store, at: usize) -> R::Scalar { R::param(s, at) }
    #[inline(always)] fn constant(c: f64) -> R::Scalar { R::constant(c) }
    #[inline(always)] fn like(self, s: R::Scalar) -> Self { self.flat(self.v.like(s)) }
    #[inline(always)] fn lit(self, c: f32) -> Self { self.flat(self.v.lit(c)) }
    #[inline(always)] fn select(m: R::Mask, a: Self, b: Self) -> Self { Dual { v: R::select(m, a.v, b.v), d: Self::pick(m, a.d, b.d) } }
    #[inline(always)] fn choose(m: R::Mask, a: Self, b: Self) -> Self { let d = Self::pick(m, a.d, b.d); Dual { v: R::choose(m, a.v, b.v), d: [R::jump_slope(m, d[0]), R::jump_slope(m, d[1]), R::jump_slope(m, d[2])] } }
    #[inline(always)] fn proven(self, lo: f32, hi: f32, at: Vec3<Self>, slope: f32) -> Self { Dual { v: self.v.proven(lo, hi, v3(at.x.v, at.y.v, at.z.v), slope), d: self.d } }
    #[inline(always)] fn whole(self) -> Self { Dual { v: self.v.whole(), d: self.d } }
    #[inline(always)] fn sqrt(self) -> Self { let r = self.v.sqrt(); self.chain(r, r.lit(0.5) / r.max(1e-18)) }
    #[inline(always)] fn abs(self) -> Self { Dual { v: self.v.abs(), d: Self::pick(self.v.negative(), (-self).d, self.d) } }
    #[inline(always)] fn floor(self) -> Self { let f = self.v.floor(); let s = self.v.step_slope(f); self.chain(f, s) }
    #[inline(always)] fn sin_cos(self) -> (Self, Self) { let (s, c) = self.v.sin_cos(); (self.chain(s, c), self.chain(c, -s)) }
    #[inline(always)] fn exp(self) -> Self { let e = self.v.exp(); self.chain(e, e) }
    #[inline(always)] fn ln(self) -> Self { self.chain(self.v.ln(), self.v.lit(1.0) / self.v) }
    #[inline(always)] fn atan2(self, x: Self) -> Self {
        // gradient (x dy - y dx) / (x^2 + y^2)
        let i = self.v.lit(1.0) / (x.v.sq() + self.v.sq()).max(1e-30);
        let (a, b) = (x.v * i, self.v * i);
        Dual { v: self.v.atan2(x.v), d: [self.d[0] * a - x.d[0] * b, self.d[1] * a - x.d[1] * b, self.d[2] * a - x.d[2] * b] }
    }
    #[inline(always)] fn powf(self, k: R::Scalar) -> Self { let q = self.v.powf(k - 1.0); self.chain(q * self.v, q * k) }
    #[inline(always)] fn norm<const N: usize>(v: [Self; N]) -> Self {
        let mut u = [v[0].v; N];
        for i in 1..N { u[i] = v[i].v; }
        let r = R::norm(u);
        let q = u[0].unit(r);
        let mut d = [v[0].d[0] * q, v[0].d[1] * q, v[0].d[2] * q];
        for i in 1..N { let q = u[i].unit(r); for k in 0..3 { d[k] = d[k] + v[i].d[k] * q; } }
        Dual { v: r, d }
    }
    #[inline(always)]
    fn repeat_while<T: State<R::Base>>(limit: R::Scalar, init: T, live: impl Fn(T) -> R::Mask, step: impl Fn(T) -> T) -> T { R::repeat_while(limit, init, live, step) }
    #[inline(always)]
    fn fold<const W: usize, T: State<R::Base>>(store: &R::Store, at: usize, ends: Ends, init: T, step: impl Fn(T, [R::Scalar; W], [R::Scalar; W]) -> T) -> T { R::fold(store, at, ends, init, step) }
}
impl<B, R: State<B>> State<B> for Dual<R> {
    #[inline(always)] fn zip(self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self { Dual { v: self.v.zip(o.v, f), d: self.d.zip(o.d, f) } }
}
