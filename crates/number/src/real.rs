//! The number trait: what a field formula may do with a number.

use super::vector::{Vec2, Vec3, v3};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A truth value of a number type: `bool`, a mask of lanes, "maybe" over a box, a recorded condition.
pub trait Truth: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {}

impl<T: Copy + BitAnd<Output = T> + BitOr<Output = T> + Not<Output = T>> Truth for T {}

/// Whether exactly one of the two holds.
#[inline(always)]
pub fn differ<M: Truth>(a: M, b: M) -> M {
    (a & !b) | (b & !a)
}

/// The truth value that comparing numbers of this type gives.
pub trait Masked {
    /// The truth value.
    type Mask: Truth;
}

/// Arithmetic with one kind of right-hand side: a number, a parameter, a literal.
pub trait Ops<Rhs>:
    Masked
    + Sized
    + Add<Rhs, Output = Self>
    + Sub<Rhs, Output = Self>
    + Mul<Rhs, Output = Self>
    + Div<Rhs, Output = Self>
{
    /// The smaller of the two.
    fn min(self, o: Rhs) -> Self;
    /// The larger of the two.
    fn max(self, o: Rhs) -> Self;
    /// `self < o`.
    fn below(self, o: Rhs) -> Self::Mask;
    /// `self > o`.
    fn above(self, o: Rhs) -> Self::Mask;
}

/// No loop takes more steps than this, and no list has more items: where a count comes from a parameter, this bounds the
/// work that a wrong one can cause.
pub const MOST_STEPS: u32 = 1 << 20;

/// Steps of a loop whose limit is a parameter: rounded down, none for NaN, at most [`MOST_STEPS`].
#[inline(always)]
pub(super) fn steps(limit: f64) -> u32 {
    (limit as u32).min(MOST_STEPS)
}

/// Whether the items of a list are joined as an open line or as a closed ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// The last item has no successor: n items make n - 1 pairs.
    Open,
    /// The last item is followed by the first: n items make n pairs.
    Ring,
}

/// What a loop carries: numbers, vectors, tuples and arrays of them. `B` is the number under the dual numbers.
pub trait State<B>: Copy {
    /// `f` over every number of the two.
    fn zip(self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self;
}

impl<B, T: State<B>, const K: usize> State<B> for [T; K] {
    #[inline(always)]
    fn zip(mut self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self {
        for k in 0..K {
            self[k] = self[k].zip(o[k], f);
        }
        self
    }
}

impl<B, T: State<B>> State<B> for Vec2<T> {
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self {
        Vec2 {
            x: self.x.zip(o.x, f),
            y: self.y.zip(o.y, f),
        }
    }
}

impl<B, T: State<B>> State<B> for Vec3<T> {
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self {
        Vec3 {
            x: self.x.zip(o.x, f),
            y: self.y.zip(o.y, f),
            z: self.z.zip(o.z, f),
        }
    }
}

macro_rules! tuple_state {
    ($($t:ident $i:tt),*) => {
        impl<B, $($t: State<B>),*> State<B> for ($($t,)*) {
            #[inline(always)]
            fn zip(self, o: Self, f: impl Fn(B, B) -> B + Copy) -> Self {
                ($(self.$i.zip(o.$i, f),)*)
            }
        }
    };
}
tuple_state!(T0 0, T1 1);
tuple_state!(T0 0, T1 1, T2 2);
tuple_state!(T0 0, T1 1, T2 2, T3 3);
tuple_state!(T0 0, T1 1, T2 2, T3 3, T4 4);
tuple_state!(T0 0, T1 1, T2 2, T3 3, T4 4, T5 5);

/// [`Real::sample`] from [`Real::fetch`], for any number type.
#[inline(always)]
pub(super) fn interpolate<R: Real>(
    store: &R::Store,
    grid: R::Scalar,
    nodes: Vec3<R::Scalar>,
    p: Vec3<R>,
) -> R {
    let (x, i) = along_axis(p.x, nodes.x);
    let (y, j) = along_axis(p.y, nodes.y);
    let (z, k) = along_axis(p.z, nodes.z);
    let near = face(store, grid, v3(i, j, k), x, y);
    let far = face(store, grid, v3(i, j, k + 1.0), x, y);
    between(near, far, z)
}

/// Where a coordinate lies between the nodes of an axis, 0 to 1, and the first of the two.
#[inline(always)]
pub(super) fn along_axis<R: Real>(c: R, nodes: R::Scalar) -> (R, R) {
    let c = c.held(R::constant(0.0), nodes - 1.0);
    let first = Ops::<R::Scalar>::min(c.floor(), nodes - 2.0);
    (c - first, first)
}

#[inline(always)]
fn face<R: Real>(store: &R::Store, grid: R::Scalar, node: Vec3<R>, x: R, y: R) -> R {
    let near = edge(store, grid, node, x);
    let far = edge(store, grid, v3(node.x, node.y + 1.0, node.z), x);
    between(near, far, y)
}

#[inline(always)]
fn edge<R: Real>(store: &R::Store, grid: R::Scalar, node: Vec3<R>, x: R) -> R {
    let near = R::fetch(store, grid, node);
    let far = R::fetch(store, grid, v3(node.x + 1.0, node.y, node.z));
    between(near, far, x)
}

#[inline(always)]
pub(super) fn between<R: Real>(a: R, b: R, t: R) -> R {
    a + (b - a) * t
}

/// A number that a formula is evaluated over.
///
/// Formulas take numbers (which vary from point to point), parameters ([`Real::Scalar`], the same for all points) and
/// literals (`f32`). The right-hand side of an operator may be any of the three; the left-hand side is a number, or a
/// parameter when the right-hand side is a parameter or a literal too.
pub trait Real:
    Copy
    + Masked
    + Neg<Output = Self>
    + State<<Self as Real>::Base>
    + Ops<Self>
    + Ops<<Self as Real>::Scalar>
    + Ops<f32>
{
    /// The number under a dual number; otherwise `Self`.
    type Base;
    /// A parameter: the same for all points, no gradient.
    type Scalar: Real<Scalar = Self::Scalar>;
    /// What parameters and grids are read from: [`Data`](crate::Data), or the recorder. (No generic associated type: they fight with late-bound
    /// lifetimes.)
    type Store;
    /// Parameter number `at`; NaN where the array is too short for it, which a compiled program never asks for.
    fn param(store: &Self::Store, at: usize) -> Self::Scalar;
    /// The sample of grid number `grid` at a node, whose coordinates are whole numbers within the grid; NaN where there is no
    /// such grid. Over ranges: of all nodes in the box.
    fn fetch(store: &Self::Store, grid: Self::Scalar, node: Vec3<Self>) -> Self;
    /// The samples of grid number `grid`, interpolated trilinearly at `p`, in nodes. The grid has `nodes` nodes along x, y and z;
    /// beyond it, the nearest place of it counts, as in [`Real::held`].
    #[inline(always)]
    fn sample(
        store: &Self::Store,
        grid: Self::Scalar,
        nodes: Vec3<Self::Scalar>,
        p: Vec3<Self>,
    ) -> Self {
        interpolate(store, grid, nodes, p)
    }

    /// A constant, as a parameter: for constants that are not exact in `f32`.
    fn constant(c: f64) -> Self::Scalar;
    /// `s`, as a number of the same company (SIMD token) as self.
    fn like(self, s: Self::Scalar) -> Self;
    /// `c`, as a number of the same company (SIMD token) as self.
    fn lit(self, c: f32) -> Self;
    /// `yes` where `m` holds, else `no`. For functions that agree where the condition flips: proofs of slopes count on
    /// it. Use [`Real::choose`] for those that jump.
    fn select(m: Self::Mask, yes: Self, no: Self) -> Self;
    /// [`Real::select`] between values that need not agree where the condition flips.
    #[inline(always)]
    fn choose(m: Self::Mask, yes: Self, no: Self) -> Self {
        Self::select(m, yes, no)
    }

    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Largest integer that is not above self.
    fn floor(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// e to the power of self.
    fn exp(self) -> Self;
    /// Natural logarithm; minus infinity at zero, NaN below.
    fn ln(self) -> Self;
    /// Angle of the point (`x`, `self`) from the x axis, in [-pi, pi].
    fn atan2(self, x: Self) -> Self;
    /// self to the power of `k`; NaN for self below zero.
    fn powf(self, k: Self::Scalar) -> Self;

    /// Euclidean length: a primitive, because its gradient (a unit vector) is bounded where sqrt's is not.
    #[inline(always)]
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let mut s = v[0] * v[0];
        for c in &v[1..] {
            s = s + *c * *c;
        }
        s.sqrt()
    }

    /// `self / norm`, where `self` is a component of the vector whose length is `norm`: in [-1, 1], and 0 for the zero
    /// vector.
    #[inline(always)]
    fn unit(self, norm: Self) -> Self {
        self / norm.max(1e-18)
    }

    /// Slope of a step function (floor) whose value went from `self` to `stepped`.
    #[inline(always)]
    fn step_slope(self, _stepped: Self) -> Self {
        self.lit(0.0)
    }

    /// `slope`, the slope of a choice by `m`, unless the choice may jump: then any slope.
    #[inline(always)]
    fn jump_slope(_m: Self::Mask, slope: Self) -> Self {
        slope
    }

    /// This value, which was computed from the coordinates `at`, with what is known of it by a proof elsewhere: it lies in
    /// [`lo`, `hi`], and its slope with respect to `at` is at most `slope` (which may be infinite). The value itself stays;
    /// ranges and proven slopes are clipped. For functions such as noise that are smooth but are made of steps.
    #[inline(always)]
    fn proven(self, _lo: f32, _hi: f32, _at: Vec3<Self>, _slope: f32) -> Self {
        self
    }

    /// `f(p)`, for an `f` whose slope is proven to be at most `slope` everywhere (a distance: 1). A range over a box is clipped
    /// to what the value at the box's centre and the slope allow: for formulas that iterate or count, whose ranges would
    /// otherwise say nothing.
    #[inline(always)]
    fn bounded_slope(p: Vec3<Self>, _slope: f32, f: impl Fn(Vec3<Self>) -> Self) -> Self {
        f(p)
    }

    /// Whether gradients over this number are for what is shown, and not for a proof: see [`Real::held`].
    const SHOWN: bool = false;

    /// self, but not outside [`lo`, `hi`]. Gradients that are shown are those at the nearest place within, in all directions, as
    /// if the function went on as it does there.
    #[inline(always)]
    fn held(self, lo: Self::Scalar, hi: Self::Scalar) -> Self {
        self.max(lo).min(hi)
    }

    /// `value`, which is `hypot(slope * beyond, inner)`: the continuation of `inner` from a box, `beyond` away from it. Gradients
    /// that are shown are so long that `value` over their length is the distance to the surface that `inner` says, continued.
    #[inline(always)]
    fn continued(_beyond: Self, _inner: Self, _slope: Self::Scalar, value: Self) -> Self {
        value
    }

    /// This value, which is known to be a whole number: ranges shed what rounding has added.
    #[inline(always)]
    fn whole(self) -> Self {
        self
    }

    /// At most `limit` times (rounded down; never more than [`MOST_STEPS`]), while `live(s)`: `s = step(s)`, for each point on
    /// its own.
    fn repeat_while<T: State<Self::Base>>(
        limit: Self::Scalar,
        init: T,
        live: impl Fn(T) -> Self::Mask,
        step: impl Fn(T) -> T,
    ) -> T;

    /// The list at `at` is its count, then its items of `W` numbers. For each item and its successor
    /// `{ s = step(s, item, next) }`. At most [`MOST_STEPS`] items; a count that the array is too short for is cut short.
    fn fold<const W: usize, T: State<Self::Base>>(
        store: &Self::Store,
        at: usize,
        ends: Ends,
        init: T,
        step: impl Fn(T, [Self::Scalar; W], [Self::Scalar; W]) -> T,
    ) -> T;

    /// The list at `at` is a count, so many nodes of trees of `W` numbers each, then items of `V` numbers. A node's children and
    /// their children stand behind it. Its last three numbers are the first of its own items, how many it has, and the nodes of its
    /// tree, itself included.
    ///
    /// For each node from the first on, `look(s, node)` gives what follows if it is entered, what follows if its tree is passed
    /// over, and whether it is entered: then comes `s = take(s, item)` for its items, and its first child. Lanes and ranges that do
    /// not agree enter. At most [`MOST_STEPS`] nodes, as for [`Real::fold`].
    fn walk<const W: usize, const V: usize, T: State<Self::Base>>(
        store: &Self::Store,
        at: usize,
        init: T,
        look: impl Fn(T, [Self::Scalar; W]) -> (T, T, Self::Mask),
        take: impl Fn(T, [Self::Scalar; V]) -> T,
    ) -> T;

    /// self, but not outside [`lo`, `hi`]; `lo` and `hi` are numbers, parameters or literals.
    #[inline(always)]
    fn clamp<L, H>(self, lo: L, hi: H) -> Self
    where
        Self: Ops<L> + Ops<H>,
    {
        self.max(lo).min(hi)
    }

    /// self, but not outside [0, 1].
    #[inline(always)]
    fn clamp01(self) -> Self {
        self.max(0.0).min(1.0)
    }

    /// `1 / self`.
    #[inline(always)]
    fn recip(self) -> Self {
        self.lit(1.0) / self
    }

    /// `1 - self`.
    #[inline(always)]
    fn one_minus(self) -> Self {
        -self + 1.0
    }

    /// The square.
    #[inline(always)]
    fn sq(self) -> Self {
        self * self
    }

    /// self to the power of a small whole number, by squaring.
    #[inline(always)]
    fn powi(self, n: u32) -> Self {
        let Some(top) = n.checked_ilog2() else {
            return self.lit(1.0);
        };
        let mut power = self;
        for bit in (0..top).rev() {
            power = power.sq();
            if n >> bit & 1 == 1 {
                power = power * self;
            }
        }
        power
    }

    /// Sine of an angle in radians.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine of an angle in radians.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Tangent of an angle in radians.
    #[inline(always)]
    fn tan(self) -> Self {
        let (s, c) = self.sin_cos();
        s / c
    }

    /// Angle in [-pi/2, pi/2] whose sine is self; arguments outside [-1, 1] count as the nearer end.
    #[inline(always)]
    fn asin(self) -> Self {
        let s = self.clamp(-1.0, 1.0);
        s.atan2(((s + 1.0) * s.one_minus()).max(0.0).sqrt())
    }

    /// Angle in [0, pi] whose cosine is self; arguments outside [-1, 1] count as the nearer end.
    #[inline(always)]
    fn acos(self) -> Self {
        let c = self.clamp(-1.0, 1.0);
        ((c + 1.0) * c.one_minus()).max(0.0).sqrt().atan2(c)
    }

    /// Angle in [-pi/2, pi/2] whose tangent is self.
    #[inline(always)]
    fn atan(self) -> Self {
        self.atan2(self.lit(1.0))
    }

    /// 2 to the power of self.
    #[inline(always)]
    fn exp2(self) -> Self {
        (self * Self::constant(std::f64::consts::LN_2)).exp()
    }

    /// Logarithm to base 2.
    #[inline(always)]
    fn log2(self) -> Self {
        self.ln() * Self::constant(std::f64::consts::LOG2_E)
    }

    /// Hyperbolic tangent.
    #[inline(always)]
    fn tanh(self) -> Self {
        // 1 - 2 / (e^2x + 1); beyond 20 it is 1 in every number type
        let e = (self.clamp(-20.0, 20.0) * 2.0).exp();
        (self.lit(2.0) / (e + 1.0)).one_minus()
    }

    /// The nearest integer, halves upwards.
    #[inline(always)]
    fn round(self) -> Self {
        (self + 0.5).floor()
    }

    /// Smallest integer that is not below self.
    #[inline(always)]
    fn ceil(self) -> Self {
        -(-self).floor()
    }

    /// `self - floor(self)`, in [0, 1].
    #[inline(always)]
    fn fract(self) -> Self {
        self - self.floor()
    }

    /// `self - c floor(self / c)`: in [0, c] for positive `c`, whatever the sign of self.
    #[inline(always)]
    fn modulo<C: Copy>(self, c: C) -> Self
    where
        Self: Ops<C>,
    {
        self - (self / c).floor() * c
    }

    /// -1 where self is below zero, else 1.
    #[inline(always)]
    fn sign(self) -> Self {
        // by floor, not by select: a proof must see that it jumps
        (self.floor() * 2.0 + 1.0).clamp(-1.0, 1.0)
    }

    /// The magnitude of self with the sign of `s`, where zero counts as positive. Proofs of slopes count on self being zero
    /// where `s` changes its sign, as with [`Real::select`].
    #[inline(always)]
    fn copysign(self, s: Self) -> Self {
        let a = self.abs();
        Self::select(s.negative(), -a, a)
    }

    /// `self + (o - self) t`.
    #[inline(always)]
    fn mix<T>(self, o: Self, t: T) -> Self
    where
        Self: Ops<T>,
    {
        self + (o - self) * t
    }

    /// The cubic step 3 t^2 - 2 t^3, where t goes from 0 at `lo` to 1 at `hi`.
    #[inline(always)]
    fn smoothstep<T: Copy + Sub<Output = T>>(self, lo: T, hi: T) -> Self
    where
        Self: Ops<T>,
    {
        let t = ((self - lo) / (hi - lo)).clamp01();
        t.sq() * (-(t * 2.0) + 3.0)
    }

    /// Whether self is below zero.
    #[inline(always)]
    fn negative(self) -> Self::Mask {
        self.below(0.0)
    }
}

/// Length of (`x`, `y`).
#[inline(always)]
pub fn length2<R: Real>(x: R, y: R) -> R {
    R::norm([x, y])
}

/// The closure itself. Stable Rust takes `#[inline(always)]` on a closure only where it is an argument.
#[inline(always)]
pub fn inlined<F>(f: F) -> F {
    f
}
