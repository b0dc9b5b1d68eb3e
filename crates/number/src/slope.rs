//! A range, a range of gradients, and a bound on the gradient's length over a box: for proofs of Lipschitz constants.
//!
//! The ranges of the three derivatives alone give up to sqrt(3) times too much where a gradient turns within the box (a
//! sphere: each derivative reaches 1). The bound on the length follows the chain rule on its own, and through
//! [`Real::norm`] it stays at 1.
//!
//! What is proven holds for any two points of the box, since a box is convex: a function that is continuous there and whose
//! pieces have gradients of length at most l changes by at most l times the way between the points. Where a function may
//! jump (a step, the cut of `atan2`, a loop that may end early, [`Real::choose`]) the bound is infinite.

use super::data::Data;
use super::interval::{Interval, Maybe, around, product, up};
use super::real::{Ends, Masked, Ops, Real, State};
use super::vector::{Vec3, v3};
use std::f64::consts::LN_2;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What a value and its gradient may be over a box.
#[derive(Clone, Copy, Debug)]
pub struct Slope {
    /// Range of the value.
    pub v: Interval,
    /// Ranges of the derivatives by x, y and z.
    pub d: [Interval; 3],
    /// Lipschitz constant over the box; infinite where none is proven.
    pub l: f64,
}

const FLAT: [Interval; 3] = [Interval { lo: 0.0, hi: 0.0 }; 3];

/// Product of two bounds, rounded up; what is zero stays so.
fn bound(a: f64, b: f64) -> f64 {
    let p = product(a, b);
    if p == 0.0 && (a == 0.0 || b == 0.0) {
        0.0
    } else {
        up(p)
    }
}

/// Largest length of a vector whose components are in these ranges, rounded up.
fn longest(d: [Interval; 3]) -> f64 {
    let s = d.iter().fold(0.0, |s, x| {
        let square = bound(x.mag(), x.mag());
        if square == 0.0 { s } else { up(s + square) }
    });
    if s == 0.0 { 0.0 } else { up(s.sqrt()) }
}

/// Derivatives by axis `k` of the components of a vector.
fn column<const N: usize>(v: &[Slope; N], k: usize) -> [Interval; N] {
    v.map(|x| x.d[k])
}

/// Largest singular value of the derivative J of a vector: at most sqrt of the largest row sum of |J J^T| (Gershgorin 1931).
fn singular<const N: usize>(v: &[Slope; N]) -> f64 {
    let gram = |a: &Slope, b: &Slope| {
        let dot = (0..3).fold(Interval::point(0.0), |s, k| s + a.d[k] * b.d[k]);
        dot.mag().min(bound(a.l, b.l))
    };
    let row = |i: usize| {
        let mut sum = bound(v[i].l, v[i].l);
        for j in (0..N).filter(|j| *j != i) {
            sum = up(sum + gram(&v[i], &v[j]));
        }
        sum
    };
    let largest = (0..N).map(row).fold(0.0, f64::max);
    // a sum of nothing but zeros has been rounded up from zero
    if v.iter().all(|x| x.l == 0.0) {
        0.0
    } else {
        up(largest.sqrt())
    }
}

impl Slope {
    /// The coordinates of a box: what a formula is given to have its slope proven there.
    pub fn point(p: Vec3<Interval>) -> Vec3<Slope> {
        let axis = |v: Interval, k: usize| {
            let mut d = FLAT;
            d[k] = Interval::point(1.0);
            Slope { v, d, l: 1.0 }
        };
        v3(axis(p.x, 0), axis(p.y, 1), axis(p.z, 2))
    }

    #[inline(never)]
    fn new(v: Interval, d: [Interval; 3], l: f64) -> Self {
        let l = if l.is_nan() { f64::INFINITY } else { l };
        Slope {
            v,
            d,
            l: l.min(longest(d)),
        }
    }

    /// The same everywhere.
    fn flat(v: Interval) -> Self {
        Slope { v, d: FLAT, l: 0.0 }
    }

    /// With a jump somewhere in the box, perhaps.
    fn jumping(v: Interval) -> Self {
        Slope {
            v,
            d: [Interval::WHOLE; 3],
            l: f64::INFINITY,
        }
    }

    /// A step function, whose values are in `v`.
    fn stepped(v: Interval) -> Self {
        if v.lo < v.hi {
            Slope::jumping(v)
        } else {
            Slope::flat(v)
        }
    }

    /// The chain rule: `v` is the range of a function of self whose derivative is in `slope`.
    #[inline(never)]
    fn chain(self, v: Interval, slope: Interval) -> Self {
        Slope::new(v, self.d.map(|x| x * slope), bound(self.l, slope.mag()))
    }

    /// One of two functions that agree where the condition flips.
    #[inline(never)]
    fn pick(m: Maybe, v: Interval, yes: Self, no: Self) -> Self {
        if m.undecided() {
            let d = [0, 1, 2].map(|k| yes.d[k].hull(no.d[k]));
            Slope::new(v, d, yes.l.max(no.l))
        } else if m.yes {
            Slope { v, ..yes }
        } else {
            Slope { v, ..no }
        }
    }
}

impl Neg for Slope {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Slope {
            v: -self.v,
            d: self.d.map(|x| -x),
            l: self.l,
        }
    }
}

impl Add for Slope {
    type Output = Self;
    #[inline(never)]
    fn add(self, o: Self) -> Self {
        let l = if self.l == 0.0 || o.l == 0.0 {
            self.l + o.l
        } else {
            up(self.l + o.l)
        };
        Slope::new(self.v + o.v, [0, 1, 2].map(|k| self.d[k] + o.d[k]), l)
    }
}

impl Sub for Slope {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Slope {
    type Output = Self;
    #[inline(never)]
    fn mul(self, o: Self) -> Self {
        let sum = self.chain(self.v, o.v) + o.chain(o.v, self.v);
        Slope {
            v: self.v * o.v,
            ..sum
        }
    }
}

impl Div for Slope {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let i = o.recip();
        Mul::mul(self, i)
    }
}

macro_rules! flat_ops {
    ($($rhs:ty),*) => {$(
        impl Add<$rhs> for Slope {
            type Output = Self;
            fn add(self, o: $rhs) -> Self {
                Slope { v: self.v + o, ..self }
            }
        }

        impl Sub<$rhs> for Slope {
            type Output = Self;
            fn sub(self, o: $rhs) -> Self {
                Slope { v: self.v - o, ..self }
            }
        }

        impl Mul<$rhs> for Slope {
            type Output = Self;
            fn mul(self, o: $rhs) -> Self {
                self.chain(self.v * o, o.into())
            }
        }

        impl Div<$rhs> for Slope {
            type Output = Self;
            fn div(self, o: $rhs) -> Self {
                self.chain(self.v / o, Interval::from(o).recip())
            }
        }

        impl Ops<$rhs> for Slope {
            fn min(self, o: $rhs) -> Self {
                Slope::pick(self.v.below(o), self.v.min(o), self, Slope::flat(o.into()))
            }
            fn max(self, o: $rhs) -> Self {
                Slope::pick(self.v.above(o), self.v.max(o), self, Slope::flat(o.into()))
            }
            fn below(self, o: $rhs) -> Maybe {
                self.v.below(o)
            }
            fn above(self, o: $rhs) -> Maybe {
                self.v.above(o)
            }
        }
    )*};
}
flat_ops!(Interval, f32);

impl Masked for Slope {
    type Mask = Maybe;
}

impl Ops<Slope> for Slope {
    fn min(self, o: Self) -> Self {
        Slope::pick(self.v.below(o.v), self.v.min(o.v), self, o)
    }
    fn max(self, o: Self) -> Self {
        Slope::pick(self.v.above(o.v), self.v.max(o.v), self, o)
    }
    fn below(self, o: Self) -> Maybe {
        self.v.below(o.v)
    }
    fn above(self, o: Self) -> Maybe {
        self.v.above(o.v)
    }
}

impl State<Interval> for Slope {
    /// Two ends that a loop may come to: its value may jump from one to the other.
    fn zip(self, o: Self, f: impl Fn(Interval, Interval) -> Interval + Copy) -> Self {
        Slope::jumping(f(self.v, o.v))
    }
}

impl Real for Slope {
    type Base = Interval;
    type Scalar = Interval;
    type Store = Data;

    fn param(store: &Data, at: usize) -> Interval {
        Interval::param(store, at)
    }
    fn fetch(store: &Data, grid: Interval, node: Vec3<Self>) -> Self {
        Slope::stepped(Interval::fetch(store, grid, node.map(|c| c.v)))
    }
    fn sample(store: &Data, grid: Interval, nodes: Vec3<Interval>, p: Vec3<Self>) -> Self {
        let v = Interval::sample(store, grid, nodes, p.map(|c| c.v));
        let Some(steepest) = store.grids.get(grid.lo as usize).map(|g| g.steepest()) else {
            return Slope::jumping(v);
        };
        let p = p.array();
        let along = steepest.map(|s| Interval::new(-f64::from(s), s.into()));
        let d = [0, 1, 2].map(|k| {
            (0..3).fold(Interval::point(0.0), |sum, axis| {
                sum + along[axis] * p[axis].d[k]
            })
        });
        Slope::new(v, d, bound(longest(along), singular(&p)))
    }
    fn constant(c: f64) -> Interval {
        Interval::constant(c)
    }
    fn like(self, s: Interval) -> Self {
        Slope::flat(s)
    }
    fn lit(self, c: f32) -> Self {
        Slope::flat(c.into())
    }
    fn select(m: Maybe, yes: Self, no: Self) -> Self {
        Slope::pick(m, Interval::select(m, yes.v, no.v), yes, no)
    }
    fn choose(m: Maybe, yes: Self, no: Self) -> Self {
        if m.undecided() {
            Slope::jumping(yes.v.hull(no.v))
        } else {
            Slope::select(m, yes, no)
        }
    }

    fn sqrt(self) -> Self {
        let r = self.v.sqrt();
        self.chain(r, Interval::point(0.5) / r)
    }
    fn abs(self) -> Self {
        Slope::pick(self.v.below(0.0), self.v.abs(), -self, self)
    }
    fn floor(self) -> Self {
        Slope::stepped(self.v.floor())
    }
    fn sign(self) -> Self {
        Slope::stepped(self.v.sign())
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.v.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    fn exp(self) -> Self {
        let e = self.v.exp();
        self.chain(e, e)
    }
    fn exp2(self) -> Self {
        let e = self.v.exp2();
        self.chain(e, e * Interval::constant(LN_2))
    }
    fn ln(self) -> Self {
        self.chain(self.v.ln(), self.v.recip())
    }
    fn atan2(self, x: Self) -> Self {
        let angle = self.v.atan2(x.v);
        if x.v.lo <= 0.0 && self.v.contains(0.0) {
            return Slope::jumping(angle);
        }
        // (x dy - y dx) / (x^2 + y^2)
        let i = (x.v.sq() + self.v.sq()).recip();
        let slope = self.chain(angle, x.v * i) - x.chain(angle, self.v * i);
        Slope { v: angle, ..slope }
    }
    fn powf(self, k: Interval) -> Self {
        self.chain(self.v.powf(k), self.v.powf(k - 1.0) * k)
    }
    fn asin(self) -> Self {
        let s = self.clamp(-1.0, 1.0);
        s.chain(s.v.asin(), s.v.sq().one_minus().sqrt().recip())
    }
    fn acos(self) -> Self {
        let c = self.clamp(-1.0, 1.0);
        c.chain(c.v.acos(), -c.v.sq().one_minus().sqrt().recip())
    }
    fn atan(self) -> Self {
        self.chain(self.v.atan(), (self.v.sq() + 1.0).recip())
    }
    fn tanh(self) -> Self {
        let t = self.v.tanh();
        self.chain(t, t.sq().one_minus())
    }
    fn sq(self) -> Self {
        self.chain(self.v.sq(), self.v * 2.0)
    }
    fn recip(self) -> Self {
        let i = self.v.recip();
        self.chain(i, -i.sq())
    }
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let r = Interval::norm(v.map(|x| x.v));
        let unit = v.map(|x| {
            let unit = x.v.unit(r);
            // the gradient of a length has length 1, however small the length is
            if r.lo < 1e-18 {
                unit.hull((x.v / r).clip(-1.0, 1.0))
            } else {
                unit
            }
        });
        let d = [0, 1, 2].map(|k| {
            let column = column(&v, k);
            let dot = (0..N).fold(Interval::point(0.0), |s, i| s + column[i] * unit[i]);
            // a unit vector times the column
            let reach = Interval::norm(column).hi;
            dot.clip(-reach, reach)
        });
        Slope::new(r, d, singular(&v))
    }
    fn unit(self, norm: Self) -> Self {
        let q = self / norm.max(1e-18);
        Slope {
            v: self.v.unit(norm.v),
            ..q
        }
    }
    fn fract(self) -> Self {
        Slope {
            v: self.v.fract(),
            ..self - self.floor()
        }
    }
    fn modulo<C: Copy>(self, c: C) -> Self
    where
        Self: Ops<C>,
    {
        let period = (self.lit(1.0) * c).v;
        let start = (self / c).floor() * c;
        Slope {
            v: self.v.modulo(period),
            ..Sub::<Slope>::sub(self, start)
        }
    }

    fn proven(self, lo: f32, hi: f32, at: Vec3<Self>, slope: f32) -> Self {
        let at = at.array();
        let d = [0, 1, 2].map(|k| {
            let reach = bound(slope.into(), longest(column(&at, k)));
            self.d[k].clip(-reach, reach)
        });
        let l = self.l.min(bound(slope.into(), singular(&at)));
        Slope::new(self.v.clip(lo.into(), hi.into()), d, l)
    }
    fn bounded_slope(p: Vec3<Self>, slope: f32, f: impl Fn(Vec3<Self>) -> Self) -> Self {
        let direct = f(p).proven(f32::NEG_INFINITY, f32::INFINITY, p, slope);
        let near = around(p.map(|c| c.v), slope, |centre| f(centre.map(Slope::flat)).v);
        match near {
            Some(near) => Slope {
                v: direct.v.intersect(near),
                ..direct
            },
            None => direct,
        }
    }
    fn whole(self) -> Self {
        Slope {
            v: self.v.whole(),
            ..self
        }
    }

    fn repeat_while<T: State<Interval>>(
        limit: Interval,
        init: T,
        live: impl Fn(T) -> Maybe,
        step: impl Fn(T) -> T,
    ) -> T {
        Interval::repeat_while(limit, init, live, step)
    }
    fn fold<const W: usize, T: State<Interval>>(
        store: &Data,
        at: usize,
        ends: Ends,
        init: T,
        step: impl Fn(T, [Interval; W], [Interval; W]) -> T,
    ) -> T {
        Interval::fold(store, at, ends, init, step)
    }
    fn walk<const W: usize, const V: usize, T: State<Interval>>(
        store: &Data,
        at: usize,
        init: T,
        look: impl Fn(T, [Interval; W]) -> (T, T, Maybe),
        take: impl Fn(T, [Interval; V]) -> T,
    ) -> T {
        Interval::walk(store, at, init, look, take)
    }
}
