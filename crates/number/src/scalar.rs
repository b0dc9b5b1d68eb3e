//! One point at a time: `f32`, and `f64` as the reference.

use super::data::Data;
use super::list::{fold_list, walk_list};
use super::real::{Ends, Masked, Ops, Real, State, steps};
use super::vector::Vec3;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `f64`, with `f32` literals on the right-hand side of operators (the orphan rule forbids `f64: Add<f32>`).
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct F64(pub f64);

impl From<f32> for F64 {
    #[inline(always)]
    fn from(x: f32) -> F64 {
        F64(x.into())
    }
}

macro_rules! arithmetic {
    ($($t:ident $f:ident),*) => {$(
        impl $t for F64 {
            type Output = F64;
            #[inline(always)]
            fn $f(self, o: F64) -> F64 {
                F64($t::$f(self.0, o.0))
            }
        }

        impl $t<f32> for F64 {
            type Output = F64;
            #[inline(always)]
            fn $f(self, o: f32) -> F64 {
                F64($t::$f(self.0, f64::from(o)))
            }
        }
    )*};
}
arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl Neg for F64 {
    type Output = F64;
    #[inline(always)]
    fn neg(self) -> F64 {
        F64(-self.0)
    }
}

macro_rules! ops {
    ($t:ty, $($rhs:ty),*) => {$(
        impl Ops<$rhs> for $t {
            // as the vector instructions do: the second operand where one of the two is NaN
            #[inline(always)]
            fn min(self, o: $rhs) -> Self {
                let o: $t = o.into();
                if self < o { self } else { o }
            }
            #[inline(always)]
            fn max(self, o: $rhs) -> Self {
                let o: $t = o.into();
                if self > o { self } else { o }
            }
            #[inline(always)]
            fn below(self, o: $rhs) -> bool {
                let o: $t = o.into();
                self < o
            }
            #[inline(always)]
            fn above(self, o: $rhs) -> bool {
                let o: $t = o.into();
                self > o
            }
        }
    )*};
}
ops!(f32, f32);
ops!(F64, F64, f32);

impl Masked for f32 {
    type Mask = bool;
}

impl Masked for F64 {
    type Mask = bool;
}

/// `$t` is the number type, `$get` its float and `$put` the number of a float.
macro_rules! real {
    ($t:ty, $float:ty, $get:expr, $put:expr) => {
        impl State<$t> for $t {
            #[inline(always)]
            fn zip(self, o: Self, f: impl Fn($t, $t) -> $t + Copy) -> Self {
                f(self, o)
            }
        }

        impl Real for $t {
            const SHOWN: bool = true;
            type Base = $t;
            type Scalar = $t;
            type Store = Data;

            #[inline(always)]
            fn param(store: &Data, at: usize) -> $t {
                store.params.get(at).copied().unwrap_or(f32::NAN).into()
            }
            #[inline(always)]
            fn fetch(store: &Data, grid: $t, node: Vec3<$t>) -> $t {
                let Some(grid) = store.grids.get($get(grid) as usize) else {
                    return f32::NAN.into();
                };
                grid.at([
                    $get(node.x) as usize,
                    $get(node.y) as usize,
                    $get(node.z) as usize,
                ])
                .into()
            }
            #[inline(always)]
            fn constant(c: f64) -> $t {
                $put(c as $float)
            }
            #[inline(always)]
            fn like(self, s: $t) -> $t {
                s
            }
            #[inline(always)]
            fn lit(self, c: f32) -> $t {
                c.into()
            }
            #[inline(always)]
            fn select(m: bool, yes: $t, no: $t) -> $t {
                if m { yes } else { no }
            }
            #[inline(always)]
            fn sqrt(self) -> $t {
                $put($get(self).sqrt())
            }
            #[inline(always)]
            fn abs(self) -> $t {
                $put($get(self).abs())
            }
            #[inline(always)]
            fn floor(self) -> $t {
                $put($get(self).floor())
            }
            #[inline(always)]
            fn sin_cos(self) -> ($t, $t) {
                let (s, c) = $get(self).sin_cos();
                ($put(s), $put(c))
            }
            #[inline(always)]
            fn exp(self) -> $t {
                $put($get(self).exp())
            }
            #[inline(always)]
            fn exp2(self) -> $t {
                $put($get(self).exp2())
            }
            #[inline(always)]
            fn ln(self) -> $t {
                $put($get(self).ln())
            }
            #[inline(always)]
            fn atan2(self, x: $t) -> $t {
                $put($get(self).atan2($get(x)))
            }
            #[inline(always)]
            fn asin(self) -> $t {
                $put($get(Real::clamp(self, -1.0, 1.0)).asin())
            }
            #[inline(always)]
            fn acos(self) -> $t {
                $put($get(Real::clamp(self, -1.0, 1.0)).acos())
            }
            #[inline(always)]
            fn atan(self) -> $t {
                $put($get(self).atan())
            }
            #[inline(always)]
            fn tanh(self) -> $t {
                $put($get(self).tanh())
            }
            #[inline(always)]
            fn powf(self, k: $t) -> $t {
                let x = $get(self);
                $put(if x < 0.0 {
                    <$float>::NAN
                } else {
                    x.abs().powf($get(k))
                })
            }

            #[inline(always)]
            fn repeat_while<T: State<$t>>(
                limit: $t,
                init: T,
                live: impl Fn(T) -> bool,
                step: impl Fn(T) -> T,
            ) -> T {
                let mut s = init;
                for _ in 0..steps($get(limit).into()) {
                    if !live(s) {
                        break;
                    }
                    s = step(s);
                }
                s
            }

            #[inline(always)]
            fn fold<const W: usize, T: State<$t>>(
                store: &Data,
                at: usize,
                ends: Ends,
                init: T,
                step: impl Fn(T, [$t; W], [$t; W]) -> T,
            ) -> T {
                fold_list(
                    &store.params,
                    at,
                    ends,
                    init,
                    #[inline(always)]
                    |s, a: [f32; W], b: [f32; W]| step(s, a.map(Into::into), b.map(Into::into)),
                )
            }

            #[inline(always)]
            fn walk<const W: usize, const V: usize, T: State<$t>>(
                store: &Data,
                at: usize,
                init: T,
                look: impl Fn(T, [$t; W]) -> (T, T, bool),
                take: impl Fn(T, [$t; V]) -> T,
            ) -> T {
                walk_list(
                    &store.params,
                    at,
                    init,
                    #[inline(always)]
                    |s, node: [f32; W]| look(s, node.map(Into::into)),
                    #[inline(always)]
                    |s, item: [f32; V]| take(s, item.map(Into::into)),
                )
            }
        }
    };
}
real!(f32, f32, (|x: f32| x), (|x: f32| x));
real!(F64, f64, (|x: F64| x.0), F64);
