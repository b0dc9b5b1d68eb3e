//! Value and gradient, over any number type (forward-mode differentiation by dual numbers, Clifford 1871).
//!
//! Gradients are those of the formula's pieces: where two pieces meet (a minimum of equals, `abs` at zero) it is the gradient
//! of one of them, and at a point where there is none (the tip of a cone) it is finite. Over intervals this encloses the
//! gradients of the pieces, but no jumps between them: proofs of slopes are [`super::Slope`]'s.

use super::expr::Expr;
use super::interval::Interval;
use super::real::{Ends, Masked, Ops, Real, State};
use super::scalar::F64;
use super::vector::{Vec3, v3};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its gradient with respect to the point that a formula was given.
#[derive(Clone, Copy, Debug)]
pub struct Dual<R> {
    /// The value.
    pub v: R,
    /// Its derivatives by x, y and z.
    pub d: [R; 3],
}

impl<R: Real> Dual<R> {
    /// The coordinates themselves: what a formula is given to have its gradient.
    #[inline(always)]
    pub fn point(p: Vec3<R>) -> Vec3<Dual<R>> {
        let (o, l) = (p.x.lit(0.0), p.x.lit(1.0));
        v3(
            Dual {
                v: p.x,
                d: [l, o, o],
            },
            Dual {
                v: p.y,
                d: [o, l, o],
            },
            Dual {
                v: p.z,
                d: [o, o, l],
            },
        )
    }

    /// The chain rule: `v` is a function of self whose derivative is `slope`.
    #[inline(always)]
    fn chain(self, v: R, slope: R) -> Self {
        Dual {
            v,
            d: times(self.d, slope),
        }
    }

    /// `v`, the same everywhere.
    #[inline(always)]
    fn flat(v: R) -> Self {
        let o = v.lit(0.0);
        Dual { v, d: [o, o, o] }
    }

    /// Derivative of the arc sine, 1 / sqrt(1 - s^2); zero outside [-1, 1], where it stays at its ends.
    #[inline(always)]
    fn arc_slope(s: R) -> R {
        let square = (s + 1.0) * s.one_minus();
        let slope = square.max(0.0).sqrt().max(1e-18).recip();
        R::select(square.negative(), s.lit(0.0), slope)
    }

    /// The gradient that goes with `m`.
    #[inline(always)]
    fn pick(m: R::Mask, yes: [R; 3], no: [R; 3]) -> [R; 3] {
        [
            R::select(m, yes[0], no[0]),
            R::select(m, yes[1], no[1]),
            R::select(m, yes[2], no[2]),
        ]
    }
}

#[inline(always)]
fn times<R: Ops<T>, T: Copy>([x, y, z]: [R; 3], s: T) -> [R; 3] {
    [x * s, y * s, z * s]
}

#[inline(always)]
fn plus<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn minus<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

impl<R: Real> Neg for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [x, y, z] = self.d;
        Dual {
            v: -self.v,
            d: [-x, -y, -z],
        }
    }
}

impl<R: Real> Add for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Dual {
            v: self.v + o.v,
            d: plus(self.d, o.d),
        }
    }
}

impl<R: Real> Sub for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Dual {
            v: self.v - o.v,
            d: minus(self.d, o.d),
        }
    }
}

impl<R: Real> Mul for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Dual {
            v: self.v * o.v,
            d: plus(times(self.d, o.v), times(o.d, self.v)),
        }
    }
}

impl<R: Real> Div for Dual<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let (q, i) = (self.v / o.v, o.v.recip());
        Dual {
            v: q,
            d: times(minus(self.d, times(o.d, q)), i),
        }
    }
}

impl<R: Real> Masked for Dual<R> {
    type Mask = R::Mask;
}

impl<R: Real> Ops<Dual<R>> for Dual<R> {
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Dual {
            v: self.v.min(o.v),
            d: Self::pick(self.v.below(o.v), self.d, o.d),
        }
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Dual {
            v: self.v.max(o.v),
            d: Self::pick(self.v.above(o.v), self.d, o.d),
        }
    }
    #[inline(always)]
    fn below(self, o: Self) -> R::Mask {
        self.v.below(o.v)
    }
    #[inline(always)]
    fn above(self, o: Self) -> R::Mask {
        self.v.above(o.v)
    }
}

/// Operators with a right-hand side that has no gradient. One implementation for all parameters would overlap with that for
/// literals, since `f32` is both.
macro_rules! flat_ops {
    ([$($generics:tt)*] $dual:ty, $rhs:ty) => {
        impl<$($generics)*> Add<$rhs> for $dual {
            type Output = Self;
            #[inline(always)]
            fn add(self, o: $rhs) -> Self {
                Dual { v: self.v + o, d: self.d }
            }
        }

        impl<$($generics)*> Sub<$rhs> for $dual {
            type Output = Self;
            #[inline(always)]
            fn sub(self, o: $rhs) -> Self {
                Dual { v: self.v - o, d: self.d }
            }
        }

        impl<$($generics)*> Mul<$rhs> for $dual {
            type Output = Self;
            #[inline(always)]
            fn mul(self, o: $rhs) -> Self {
                Dual { v: self.v * o, d: times(self.d, o) }
            }
        }

        impl<$($generics)*> Div<$rhs> for $dual {
            type Output = Self;
            #[inline(always)]
            fn div(self, o: $rhs) -> Self {
                let [x, y, z] = self.d;
                Dual { v: self.v / o, d: [x / o, y / o, z / o] }
            }
        }

        impl<$($generics)*> Ops<$rhs> for $dual {
            #[inline(always)]
            fn min(self, o: $rhs) -> Self {
                let v = self.v.min(o);
                Dual { v, d: Self::pick(self.v.below(o), self.d, Self::flat(v).d) }
            }
            #[inline(always)]
            fn max(self, o: $rhs) -> Self {
                let v = self.v.max(o);
                Dual { v, d: Self::pick(self.v.above(o), self.d, Self::flat(v).d) }
            }
            #[inline(always)]
            fn below(self, o: $rhs) -> Self::Mask {
                self.v.below(o)
            }
            #[inline(always)]
            fn above(self, o: $rhs) -> Self::Mask {
                self.v.above(o)
            }
        }
    };
}
flat_ops!([R: Real] Dual<R>, f32);
flat_ops!([] Dual<F64>, F64);
flat_ops!([] Dual<Interval>, Interval);
flat_ops!(['r] Dual<Expr<'r>>, Expr<'r>);

impl<B, R: State<B>> State<B> for Dual<R> {
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self {
        Dual {
            v: self.v.zip(o.v, f),
            d: self.d.zip(o.d, f),
        }
    }
}

impl<R: Real> Real for Dual<R>
where
    Self: Ops<R::Scalar> + Masked<Mask = R::Mask>,
{
    type Base = R::Base;
    type Scalar = R::Scalar;
    type Store = R::Store;

    #[inline(always)]
    fn param(store: &R::Store, at: usize) -> R::Scalar {
        R::param(store, at)
    }
    #[inline(always)]
    fn fetch(store: &R::Store, grid: R::Scalar, node: Vec3<Self>) -> Self {
        Self::flat(R::fetch(
            store,
            grid,
            node.map(
                #[inline(always)]
                |c| c.v,
            ),
        ))
    }
    #[inline(always)]
    fn constant(c: f64) -> R::Scalar {
        R::constant(c)
    }
    #[inline(always)]
    fn like(self, s: R::Scalar) -> Self {
        Self::flat(self.v.like(s))
    }
    #[inline(always)]
    fn lit(self, c: f32) -> Self {
        Self::flat(self.v.lit(c))
    }
    #[inline(always)]
    fn select(m: R::Mask, yes: Self, no: Self) -> Self {
        Dual {
            v: R::select(m, yes.v, no.v),
            d: Self::pick(m, yes.d, no.d),
        }
    }
    #[inline(always)]
    fn choose(m: R::Mask, yes: Self, no: Self) -> Self {
        let [x, y, z] = Self::pick(m, yes.d, no.d);
        Dual {
            v: R::choose(m, yes.v, no.v),
            d: [
                R::jump_slope(m, x),
                R::jump_slope(m, y),
                R::jump_slope(m, z),
            ],
        }
    }
    #[inline(always)]
    fn proven(self, lo: f32, hi: f32, at: Vec3<Self>, slope: f32) -> Self {
        Dual {
            v: self.v.proven(lo, hi, v3(at.x.v, at.y.v, at.z.v), slope),
            d: self.d,
        }
    }
    #[inline(always)]
    fn whole(self) -> Self {
        Dual {
            v: self.v.whole(),
            d: self.d,
        }
    }
    #[inline(always)]
    fn held(self, lo: R::Scalar, hi: R::Scalar) -> Self {
        let held = self.max(lo).min(hi);
        if R::SHOWN {
            Dual {
                v: held.v,
                d: self.d,
            }
        } else {
            held
        }
    }
    #[inline(always)]
    fn continued(beyond: Self, inner: Self, slope: R::Scalar, value: Self) -> Self {
        if !R::SHOWN {
            return value;
        }
        // the distance to the surface from the box, then from here: value over the length of the gradient is to be that
        let steepness = R::norm(inner.d).max(1e-12);
        let from_box = inner.v / steepness;
        let distance = R::norm([beyond.v, from_box]).max(1e-30);
        let way = plus(
            times(beyond.d, beyond.v * slope * slope),
            times(inner.d, inner.v),
        );
        let length = value.v / distance;
        Dual {
            v: value.v,
            d: times(way, length / R::norm(way).max(1e-30)),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let r = self.v.sqrt();
        self.chain(r, r.lit(0.5) / r.max(1e-18))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Dual {
            v: self.v.abs(),
            d: Self::pick(self.v.negative(), (-self).d, self.d),
        }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        let f = self.v.floor();
        self.chain(f, self.v.step_slope(f))
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.v.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = self.v.exp();
        self.chain(e, e)
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        let e = self.v.exp2();
        self.chain(e, e * R::constant(std::f64::consts::LN_2))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.v.ln(), self.v.recip())
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        // (x dy - y dx) / (x^2 + y^2)
        let i = (x.v.sq() + self.v.sq()).max(1e-30).recip();
        Dual {
            v: self.v.atan2(x.v),
            d: minus(times(self.d, x.v * i), times(x.d, self.v * i)),
        }
    }
    #[inline(always)]
    fn powf(self, k: R::Scalar) -> Self {
        let p = self.v.powf(k);
        self.chain(p, p / self.v.max(f32::MIN_POSITIVE) * k)
    }
    #[inline(always)]
    fn asin(self) -> Self {
        self.chain(self.v.asin(), Self::arc_slope(self.v))
    }
    #[inline(always)]
    fn acos(self) -> Self {
        self.chain(self.v.acos(), -Self::arc_slope(self.v))
    }
    #[inline(always)]
    fn atan(self) -> Self {
        self.chain(self.v.atan(), (self.v.sq() + 1.0).recip())
    }
    #[inline(always)]
    fn tanh(self) -> Self {
        let t = self.v.tanh();
        self.chain(t, t.sq().one_minus())
    }
    #[inline(always)]
    fn sq(self) -> Self {
        self.chain(self.v.sq(), self.v * 2.0)
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let i = self.v.recip();
        self.chain(i, -i.sq())
    }
    #[inline(always)]
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let mut values = [v[0].v; N];
        for k in 0..N {
            values[k] = v[k].v;
        }
        let r = R::norm(values);
        let mut d = times(v[0].d, values[0].unit(r));
        for component in &v[1..] {
            d = plus(d, times(component.d, component.v.unit(r)));
        }
        Dual { v: r, d }
    }

    #[inline(always)]
    fn repeat_while<T: State<R::Base>>(
        limit: R::Scalar,
        init: T,
        live: impl Fn(T) -> R::Mask,
        step: impl Fn(T) -> T,
    ) -> T {
        R::repeat_while(limit, init, live, step)
    }
    #[inline(always)]
    fn fold<const W: usize, T: State<R::Base>>(
        store: &R::Store,
        at: usize,
        ends: Ends,
        init: T,
        step: impl Fn(T, [R::Scalar; W], [R::Scalar; W]) -> T,
    ) -> T {
        R::fold(store, at, ends, init, step)
    }
    #[inline(always)]
    fn walk<const W: usize, const V: usize, T: State<R::Base>>(
        store: &R::Store,
        at: usize,
        init: T,
        look: impl Fn(T, [R::Scalar; W]) -> (T, T, R::Mask),
        take: impl Fn(T, [R::Scalar; V]) -> T,
    ) -> T {
        R::walk(store, at, init, look, take)
    }
}
