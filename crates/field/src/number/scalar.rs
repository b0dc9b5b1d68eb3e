//! f32 (one point) and F64 (the reference).
use super::real::*;
use std::ops::*;

macro_rules! ops { ($t:ty, $($rhs:ty),*) => {$(
    impl Ops<$rhs> for $t {
        #[inline(always)] fn min(self, o: $rhs) -> Self { let o: $t = o.into(); if self < o { self } else { o } }
        #[inline(always)] fn max(self, o: $rhs) -> Self { let o: $t = o.into(); if self > o { self } else { o } }
        #[inline(always)] fn below(self, o: $rhs) -> bool { let o: $t = o.into(); self < o }
        #[inline(always)] fn above(self, o: $rhs) -> bool { let o: $t = o.into(); self > o }
    })*};
}
impl Masked for f32 { type Mask = bool; }
ops!(f32, f32);
impl Masked for F64 { type Mask = bool; }
ops!(F64, F64, f32);

/// f64 with f32 literals on the right: the orphan rule forbids `f64: Add<f32>`.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct F64(pub f64);
impl From<f32> for F64 { #[inline(always)] fn from(x: f32) -> F64 { F64(x as f64) } }
macro_rules! f64op { ($($t:ident $f:ident),*) => {$(
    impl $t for F64 { type Output = F64; #[inline(always)] fn $f(self, o: F64) -> F64 { F64($t::$f(self.0, o.0)) } }
    impl $t<f32> for F64 { type Output = F64; #[inline(always)] fn $f(self, o: f32) -> F64 { F64($t::$f(self.0, o as f64)) } }
)*}; }
f64op!(Add add, Sub sub, Mul mul, Div div);
impl Neg for F64 { type Output = F64; #[inline(always)] fn neg(self) -> F64 { F64(-self.0) } }

macro_rules! real { ($t:ty, $f:ty, |$x:ident| $get:expr, |$y:ident| $put:expr) => {
    impl State<$t> for $t { #[inline(always)] fn zip(self, o: Self, f: impl Fn($t, $t) -> $t + Copy) -> Self { f(self, o) } }
    impl Real for $t {
        type Base = $t;
        type Scalar = $t;
        type Store = [f32];
    #[inline(always)] fn param(a: &[f32], i: usize) -> Self::Scalar { a[i].into() }
        #[inline(always)] fn constant(c: f64) -> $t { let $y = c as $f; $put }
        #[inline(always)] fn like(self, s: $t) -> $t { s }
        #[inline(always)] fn lit(self, c: f32) -> $t { c.into() }
        #[inline(always)] fn select(m: bool, a: $t, b: $t) -> $t { if m { a } else { b } }
        #[inline(always)] fn sqrt(self) -> $t { let $x = self; let $y = ($get).sqrt(); $put }
        #[inline(always)] fn abs(self) -> $t { let $x = self; let $y = ($get).abs(); $put }
        #[inline(always)] fn floor(self) -> $t { let $x = self; let $y = ($get).floor(); $put }
        #[inline(always)] fn exp(self) -> $t { let $x = self; let $y = ($get).exp(); $put }
        #[inline(always)] fn ln(self) -> $t { let $x = self; let $y = ($get).ln(); $put }
        #[inline(always)] fn sin_cos(self) -> ($t, $t) { let $x = self; let (s, c) = ($get).sin_cos(); ({ let $y = s; $put }, { let $y = c; $put }) }
        #[inline(always)] fn atan2(self, o: $t) -> $t { let a = { let $x = self; $get }; let b = { let $x = o; $get }; let $y = a.atan2(b); $put }
        #[inline(always)] fn powf(self, o: $t) -> $t { let a = { let $x = self; $get }; let b = { let $x = o; $get }; let $y = a.powf(b); $put }
        #[inline(always)]
        fn repeat_while<T: State<$t>>(limit: $t, init: T, live: impl Fn(T) -> bool, step: impl Fn(T) -> T) -> T {
            let mut s = init;
            let $x = limit;
            for _ in 0..(($get) as u32) { if !live(s) { break; } s = step(s); }
            s
        }
        #[inline(always)]
        fn fold<const W: usize, T: State<$t>>(store: &[f32], at: usize, ends: Ends, init: T, step: impl Fn(T, [$t; W], [$t; W]) -> T) -> T {
            fold_slice(&store[at..], ends, init, #[inline(always)] |c| c.into(), step)
        }
    }
}; }
real!(f32, f32, |x| x, |y| y);
real!(F64, f64, |x| x.0, |y| F64(y));

#[inline(always)]
pub fn fold_slice<P: Copy, T: Copy, const W: usize>(list: &[f32], ends: Ends, init: T, get: impl Fn(f32) -> P, step: impl Fn(T, [P; W], [P; W]) -> T) -> T {
    let (n, list) = (list[0] as usize, &list[1..]);
    let mut s = init;
    if n == 0 { return s; }
    let item = inlined(#[inline(always)] |i: usize| { let c: &[f32; W] = list[i * W..][..W].try_into().unwrap(); let mut o = [get(0.0); W]; for k in 0..W { o[k] = get(c[k]); } o });
    let mut a = item(if ends == Ends::Ring { n - 1 } else { 0 });
    for i in (if ends == Ends::Ring { 0 } else { 1 })..n { let b = item(i); s = step(s, a, b); a = b; }
    s
}
