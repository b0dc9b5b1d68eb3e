//! A proven range: every operation rounds outwards (Moore 1966).
//!
//! A range encloses the values that a formula takes for all real arguments in the ranges that it is given, and those that
//! `f64` gives for them. An infinite end stands for values without a bound. Where a formula has no value (a division by
//! zero, the logarithm of a negative number) the range says nothing about that point.

use super::data::{Data, Grid};
use super::list::{fold_list, walk_list};
use super::real::{Ends, Masked, Ops, Real, State, interpolate, steps};
use super::scalar::F64;
use super::vector::{Vec3, v3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Cells of a grid that a range is taken from exactly; over more of them, that of their nodes counts.
const MOST_CELLS: f64 = 8.0;

/// All numbers from `lo` to `hi`. `SINGLE`: whether those of single precision are enclosed too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntervalOf<const SINGLE: bool> {
    /// Smallest value; not NaN, and not above `hi`.
    pub lo: f64,
    /// Largest value; not NaN.
    pub hi: f64,
}

/// A range of the values that a formula takes for real numbers, and of those that `f64` gives.
pub type Interval = IntervalOf<false>;

/// A range that also encloses what a formula gives in single precision, on any instruction set: every operation is widened by what
/// `f32` and [`elementary`](crate::elementary) may round, and by what overflows and underflows there.
pub type SingleInterval = IntervalOf<true>;

/// What a condition may be, over a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Maybe {
    /// Whether it may hold somewhere.
    pub yes: bool,
    /// Whether it may fail somewhere.
    pub no: bool,
}

impl Maybe {
    /// Whether it may hold in one place and fail in another.
    pub fn undecided(self) -> bool {
        self.yes && self.no
    }
}

impl BitAnd for Maybe {
    type Output = Self;
    fn bitand(self, o: Self) -> Self {
        Maybe {
            yes: self.yes && o.yes,
            no: self.no || o.no,
        }
    }
}

impl BitOr for Maybe {
    type Output = Self;
    fn bitor(self, o: Self) -> Self {
        Maybe {
            yes: self.yes || o.yes,
            no: self.no && o.no,
        }
    }
}

impl Not for Maybe {
    type Output = Self;
    fn not(self) -> Self {
        Maybe {
            yes: self.no,
            no: self.yes,
        }
    }
}

/// Rounded down; what is unknown is unbounded.
pub(super) fn down(x: f64) -> f64 {
    if x.is_nan() {
        f64::NEG_INFINITY
    } else {
        x.next_down()
    }
}

/// Rounded up; what is unknown is unbounded.
pub(super) fn up(x: f64) -> f64 {
    if x.is_nan() {
        f64::INFINITY
    } else {
        x.next_up()
    }
}

/// A product of ends: zero times infinity is zero, because an infinite end stands for every large number.
pub(super) fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// Roundings that a function of the system's library may be off by. (The libraries in use stay below one.)
const LIBRARY_ULPS: u32 = 3;

fn smallest(ends: [f64; 4]) -> f64 {
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

fn largest(ends: [f64; 4]) -> f64 {
    ends.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

/// Half a unit in the last place of single precision, as a share, twice: for the rounding of the ends too.
const SINGLE_SHARE: f64 = f32::EPSILON as f64;
/// What single precision may lose below its smallest normal number.
const SINGLE_TINY: f64 = f32::MIN_POSITIVE as f64;
/// The largest number of single precision.
const SINGLE_MAX: f64 = f32::MAX as f64;
/// What the elementary functions of single precision may be off by, as a share and absolutely; those that are stated are less than a
/// quarter of it (see [`elementary`](crate::elementary)).
const SINGLE_LIBRARY: [f64; 2] = [1e-6, 1e-6];
/// The share for powers.
const SINGLE_POWER: f64 = 1e-5;

impl<const SINGLE: bool> IntervalOf<SINGLE> {
    /// All numbers.
    pub const WHOLE: Self = IntervalOf {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// The range between two numbers, in any order; NaN stands for no bound.
    pub fn new(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() {
            return Self {
                lo: if a.is_nan() { f64::NEG_INFINITY } else { a },
                hi: if b.is_nan() { f64::INFINITY } else { b },
            };
        }
        Self {
            lo: a.min(b),
            hi: a.max(b),
        }
    }

    /// The number alone.
    pub fn point(x: f64) -> Self {
        Self::new(x, x)
    }

    /// The smallest range that holds both.
    pub fn hull(self, o: Self) -> Self {
        Self {
            lo: self.lo.min(o.lo),
            hi: self.hi.max(o.hi),
        }
    }

    /// What both hold; self where that is nothing.
    pub(super) fn intersect(self, o: Self) -> Self {
        let both = Self {
            lo: self.lo.max(o.lo),
            hi: self.hi.min(o.hi),
        };
        if both.lo <= both.hi { both } else { self }
    }

    /// Self, but not outside [`lo`, `hi`].
    pub(super) fn clip(self, lo: f64, hi: f64) -> Self {
        Self {
            lo: self.lo.clamp(lo, hi),
            hi: self.hi.clamp(lo, hi),
        }
    }

    /// The range of a grid's samples at the nodes of a box.
    fn nodes(grid: &Grid, node: [Self; 3]) -> Self {
        let range = grid.range(node.map(|c| Interval { lo: c.lo, hi: c.hi }));
        IntervalOf {
            lo: range.lo,
            hi: range.hi,
        }
    }

    /// Whether both ends are numbers.
    pub fn is_finite(self) -> bool {
        self.lo.is_finite() && self.hi.is_finite()
    }

    /// Whether the range holds `x`.
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Largest absolute value.
    pub fn mag(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    fn is_zero(self) -> bool {
        self.lo == 0.0 && self.hi == 0.0
    }

    /// The ends, rounded outwards once.
    fn rounded(lo: f64, hi: f64) -> Self {
        if SINGLE {
            return IntervalOf { lo, hi }.widened(SINGLE_SHARE, SINGLE_TINY);
        }
        IntervalOf {
            lo: down(lo),
            hi: up(hi),
        }
    }

    /// The ends, outwards by a share of them and an absolute number. What single precision cannot hold is infinite there, or the largest
    /// number that it has.
    #[inline(never)]
    fn widened(self, share: f64, by: f64) -> Self {
        let (lo, hi) = (down(self.lo), up(self.hi));
        let lo = down(lo - (lo.abs() * share + by));
        let hi = up(hi + (hi.abs() * share + by));
        IntervalOf {
            lo: if lo < -SINGLE_MAX {
                f64::NEG_INFINITY
            } else {
                lo.min(SINGLE_MAX)
            },
            hi: if hi > SINGLE_MAX {
                f64::INFINITY
            } else {
                hi.max(-SINGLE_MAX)
            },
        }
    }

    /// Self, but not outside [`lo`, `hi`], ends that values in single precision may miss by rounding.
    fn clip_rounded(self, lo: f64, hi: f64) -> Self {
        if !SINGLE {
            return self.clip(lo, hi);
        }
        let ends = IntervalOf::<true> { lo, hi }.widened(SINGLE_POWER, 0.0);
        self.clip(ends.lo, ends.hi)
    }

    /// The ends, rounded outwards by what a library function may be off by.
    #[inline(never)]
    fn library(lo: f64, hi: f64) -> Self {
        let mut r = Self::new(lo, hi);
        if SINGLE {
            let [share, by] = SINGLE_LIBRARY;
            return r.widened(share, by);
        }
        for _ in 0..LIBRARY_ULPS {
            r = Self::rounded(r.lo, r.hi);
        }
        r
    }

    /// A library function that grows, or that falls.
    fn monotone(self, f: impl Fn(f64) -> f64) -> Self {
        Self::library(f(self.lo), f(self.hi))
    }
}

impl<const SINGLE: bool> From<f32> for IntervalOf<SINGLE> {
    fn from(x: f32) -> Self {
        Self::point(x.into())
    }
}

impl<const SINGLE: bool> Neg for IntervalOf<SINGLE> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

impl<const SINGLE: bool> Add for IntervalOf<SINGLE> {
    type Output = Self;
    #[inline(never)]
    fn add(self, o: Self) -> Self {
        // without rounding, so that what is zero stays so
        if o.is_zero() {
            return self;
        }
        if self.is_zero() {
            return o;
        }
        Self::rounded(self.lo + o.lo, self.hi + o.hi)
    }
}

impl<const SINGLE: bool> Sub for IntervalOf<SINGLE> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl<const SINGLE: bool> Mul for IntervalOf<SINGLE> {
    type Output = Self;
    #[inline(never)]
    fn mul(self, o: Self) -> Self {
        if self.is_zero() || o.is_zero() {
            return Self::point(0.0);
        }
        let ends = [
            product(self.lo, o.lo),
            product(self.lo, o.hi),
            product(self.hi, o.lo),
            product(self.hi, o.hi),
        ];
        Self::rounded(smallest(ends), largest(ends))
    }
}

impl<const SINGLE: bool> Div for IntervalOf<SINGLE> {
    type Output = Self;
    #[inline(never)]
    fn div(self, o: Self) -> Self {
        if o.lo > 0.0 || o.hi < 0.0 {
            self * Self::rounded(1.0 / o.hi, 1.0 / o.lo)
        } else if o.lo == 0.0 && o.hi > 0.0 {
            self * Self::new(down(1.0 / o.hi), f64::INFINITY)
        } else if o.hi == 0.0 && o.lo < 0.0 {
            self * Self::new(f64::NEG_INFINITY, up(1.0 / o.lo))
        } else {
            Self::WHOLE
        }
    }
}

macro_rules! literal_arithmetic {
    ($($t:ident $f:ident),*) => {$(
        impl<const SINGLE: bool> $t<f32> for IntervalOf<SINGLE> {
            type Output = Self;
            fn $f(self, o: f32) -> Self {
                $t::$f(self, Self::from(o))
            }
        }
    )*};
}
literal_arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl<const SINGLE: bool> Masked for IntervalOf<SINGLE> {
    type Mask = Maybe;
}

macro_rules! ops {
    ($($rhs:ty),*) => {$(
        impl<const SINGLE: bool> Ops<$rhs> for IntervalOf<SINGLE> {
            fn min(self, o: $rhs) -> Self {
                let o = Self::from(o);
                Self { lo: self.lo.min(o.lo), hi: self.hi.min(o.hi) }
            }
            fn max(self, o: $rhs) -> Self {
                let o = Self::from(o);
                Self { lo: self.lo.max(o.lo), hi: self.hi.max(o.hi) }
            }
            fn below(self, o: $rhs) -> Maybe {
                let o = Self::from(o);
                Maybe { yes: self.lo < o.hi, no: self.hi >= o.lo }
            }
            fn above(self, o: $rhs) -> Maybe {
                Self::from(o).below(self)
            }
        }
    )*};
}
ops!(IntervalOf<SINGLE>, f32);

impl<const SINGLE: bool> State<IntervalOf<SINGLE>> for IntervalOf<SINGLE> {
    fn zip(self, o: Self, f: impl Fn(Self, Self) -> Self + Copy) -> Self {
        f(self, o)
    }
}

impl<const SINGLE: bool> Real for IntervalOf<SINGLE> {
    type Base = Self;
    type Scalar = Self;
    type Store = Data;

    fn param(store: &Data, at: usize) -> Self {
        f32::param(store, at).into()
    }
    fn fetch(store: &Data, grid: Self, node: Vec3<Self>) -> Self {
        match store.grids.get(grid.lo as usize) {
            Some(grid) => Self::nodes(grid, node.array()),
            None => Self::WHOLE,
        }
    }
    fn sample(store: &Data, grid: Self, nodes: Vec3<Self>, p: Vec3<Self>) -> Self {
        let Some(samples) = store.grids.get(grid.lo as usize) else {
            return Self::WHOLE;
        };
        let n = samples.nodes().map(f64::from);
        let held = |axis: usize| {
            let c = p.array()[axis];
            [c.lo, c.hi].map(|x| x.clamp(0.0, n[axis] - 1.0))
        };
        let held = [held(0), held(1), held(2)];
        let cell = |axis: usize, x: f64| x.floor().min(n[axis] - 2.0);
        let cells = [0, 1, 2].map(|axis| held[axis].map(|x| cell(axis, x)));
        let count: f64 = cells
            .iter()
            .map(|[first, last]| last - first + 1.0)
            .product();
        if count > MOST_CELLS {
            // what is interpolated never leaves its nodes
            return Self::nodes(
                samples,
                cells.map(|[first, last]| Self::new(first, last + 1.0)),
            );
        }
        // in a cell the function is linear along each axis: over a box it is largest and smallest at corners
        let corners = |axis: usize| {
            let ([first, last], [lo, hi]) = (cells[axis], held[axis]);
            let planes = (first as u32 + 1..=last as u32).map(f64::from);
            [lo, hi].into_iter().chain(planes).collect::<Vec<f64>>()
        };
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        let nodes = nodes.map(|n| F64(n.lo));
        for x in corners(0) {
            for y in corners(1) {
                for z in corners(2) {
                    let at = v3(F64(x), F64(y), F64(z));
                    let value = interpolate(store, F64(grid.lo), nodes, at).0;
                    (lo, hi) = (lo.min(value), hi.max(value));
                }
            }
        }
        // for the roundings of other number types
        let hair = if SINGLE { 1e-5 } else { 1e-12 } * lo.abs().max(hi.abs());
        Self::rounded(lo - hair, hi + hair)
    }
    fn constant(c: f64) -> Self {
        // 3 is meant to be 3, but pi stands for a number beside it
        if f64::from(c as f32) == c {
            Self::point(c)
        } else {
            Self::rounded(c, c)
        }
    }
    fn like(self, s: Self) -> Self {
        s
    }
    fn lit(self, c: f32) -> Self {
        c.into()
    }
    #[inline(never)]
    fn select(m: Maybe, yes: Self, no: Self) -> Self {
        if m.undecided() {
            yes.hull(no)
        } else if m.yes {
            yes
        } else {
            no
        }
    }

    #[inline(never)]
    fn sqrt(self) -> Self {
        let r = Self::rounded(self.lo.max(0.0).sqrt(), self.hi.max(0.0).sqrt());
        r.clip(0.0, f64::INFINITY)
    }
    #[inline(never)]
    fn abs(self) -> Self {
        if self.lo >= 0.0 {
            self
        } else if self.hi <= 0.0 {
            -self
        } else {
            Self {
                lo: 0.0,
                hi: self.mag(),
            }
        }
    }
    #[inline(never)]
    fn floor(self) -> Self {
        Self {
            lo: self.lo.floor(),
            hi: self.hi.floor(),
        }
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        (wave(self, f64::sin, FRAC_PI_2), wave(self, f64::cos, 0.0))
    }
    #[inline(never)]
    fn exp(self) -> Self {
        self.monotone(f64::exp).clip(0.0, f64::INFINITY)
    }
    #[inline(never)]
    fn exp2(self) -> Self {
        self.monotone(f64::exp2).clip(0.0, f64::INFINITY)
    }
    #[inline(never)]
    fn ln(self) -> Self {
        self.clip(0.0, f64::INFINITY).monotone(f64::ln)
    }
    #[inline(never)]
    fn powf(self, k: Self) -> Self {
        let power = (self.ln() * k).exp();
        if SINGLE {
            power.widened(SINGLE_POWER, 0.0).clip(0.0, f64::INFINITY)
        } else {
            power
        }
    }
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        // the cut, where the angle jumps from pi to -pi, and the origin, where it may be any
        if x.lo <= 0.0 && self.contains(0.0) {
            return Self::library(-PI, PI);
        }
        // elsewhere the angle of a box is largest and smallest at corners
        let ends = [
            self.lo.atan2(x.lo),
            self.lo.atan2(x.hi),
            self.hi.atan2(x.lo),
            self.hi.atan2(x.hi),
        ];
        Self::library(smallest(ends), largest(ends))
    }
    #[inline(never)]
    fn asin(self) -> Self {
        self.clip(-1.0, 1.0).monotone(f64::asin)
    }
    #[inline(never)]
    fn acos(self) -> Self {
        self.clip(-1.0, 1.0).monotone(f64::acos)
    }
    #[inline(never)]
    fn atan(self) -> Self {
        self.monotone(f64::atan)
    }
    #[inline(never)]
    fn tanh(self) -> Self {
        self.monotone(f64::tanh).clip_rounded(-1.0, 1.0)
    }
    #[inline(never)]
    fn sq(self) -> Self {
        let a = self.abs();
        Self::rounded(a.lo * a.lo, a.hi * a.hi).clip(0.0, f64::INFINITY)
    }
    #[inline(never)]
    fn norm<const N: usize>(v: [Self; N]) -> Self {
        let [first, rest @ ..] = v.as_slice() else {
            return Self::point(0.0);
        };
        rest.iter().fold(first.sq(), |s, x| s + x.sq()).sqrt()
    }
    fn unit(self, norm: Self) -> Self {
        (self / norm.max(1e-18)).clip_rounded(-1.0, 1.0)
    }
    #[inline(never)]
    fn sign(self) -> Self {
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        Self {
            lo: sign(self.lo),
            hi: sign(self.hi),
        }
    }
    #[inline(never)]
    fn fract(self) -> Self {
        let f = self.floor();
        if f.lo < f.hi {
            Self { lo: 0.0, hi: 1.0 }
        } else {
            (self - f).clip(0.0, 1.0)
        }
    }
    #[inline(never)]
    fn modulo<C: Copy>(self, c: C) -> Self
    where
        Self: Ops<C>,
    {
        modulo(self, self.lit(1.0) * c)
    }

    fn step_slope(self, stepped: Self) -> Self {
        if stepped.lo < stepped.hi {
            Self::WHOLE
        } else {
            Self::point(0.0)
        }
    }
    fn jump_slope(m: Maybe, slope: Self) -> Self {
        if m.undecided() { Self::WHOLE } else { slope }
    }
    fn proven(self, lo: f32, hi: f32, _at: Vec3<Self>, _slope: f32) -> Self {
        self.clip_rounded(lo.into(), hi.into())
    }
    fn bounded_slope(p: Vec3<Self>, slope: f32, f: impl Fn(Vec3<Self>) -> Self) -> Self {
        let direct = f(p);
        match around(p, slope, &f) {
            Some(near) => direct.intersect(near),
            None => direct,
        }
    }
    fn whole(self) -> Self {
        let whole = Self {
            lo: self.lo.ceil(),
            hi: self.hi.floor(),
        };
        if whole.lo <= whole.hi { whole } else { self }
    }

    fn repeat_while<T: State<Self>>(
        limit: Self,
        init: T,
        live: impl Fn(T) -> Maybe,
        step: impl Fn(T) -> T,
    ) -> T {
        // `s` is what may still run, `done` gathers what may have left
        let (mut s, mut done): (T, Option<T>) = (init, None);
        let join = |done: Option<T>, s: T| match done {
            Some(d) => d.zip(s, Self::hull),
            None => s,
        };
        let sure = steps(limit.lo);
        for i in 0..steps(limit.hi) {
            let m = live(s);
            if !m.yes {
                return join(done, s);
            }
            if m.no || i >= sure {
                done = Some(join(done, s));
            }
            s = step(s);
        }
        join(done, s)
    }

    fn fold<const W: usize, T: State<Self>>(
        store: &Data,
        at: usize,
        ends: Ends,
        init: T,
        step: impl Fn(T, [Self; W], [Self; W]) -> T,
    ) -> T {
        fold_list(
            &store.params,
            at,
            ends,
            init,
            |s, a: [f32; W], b: [f32; W]| step(s, a.map(Into::into), b.map(Into::into)),
        )
    }

    fn walk<const W: usize, const V: usize, T: State<Self>>(
        store: &Data,
        at: usize,
        init: T,
        look: impl Fn(T, [Self; W]) -> (T, T, Maybe),
        take: impl Fn(T, [Self; V]) -> T,
    ) -> T {
        walk_list(
            &store.params,
            at,
            init,
            |s, node: [f32; W]| {
                let (entered, passed, enters) = look(s, node.map(Into::into));
                (entered, passed, enters.yes)
            },
            |s, item: [f32; V]| take(s, item.map(Into::into)),
        )
    }
}

/// A function between -1 and 1 of period 2 pi whose maxima lie at `peak` and whole periods from it.
fn wave<const SINGLE: bool>(
    x: IntervalOf<SINGLE>,
    f: impl Fn(f64) -> f64,
    peak: f64,
) -> IntervalOf<SINGLE> {
    let narrow = x.hi - x.lo < TAU && x.mag() < 1e9;
    if !narrow {
        return IntervalOf { lo: -1.0, hi: 1.0 }.clip_rounded(-1.0, 1.0);
    }
    // whether a number `at + 2 pi n` lies in the range, or within a hair of it
    let hair = 1e-6;
    let holds = |at: f64| ((x.hi - at + hair) / TAU).floor() >= ((x.lo - at - hair) / TAU).ceil();
    let mut r = IntervalOf::library(f(x.lo), f(x.hi)).clip_rounded(-1.0, 1.0);
    let whole = IntervalOf::<SINGLE> { lo: -1.0, hi: 1.0 }.clip_rounded(-1.0, 1.0);
    if holds(peak + PI) {
        r.lo = whole.lo;
    }
    if holds(peak) {
        r.hi = whole.hi;
    }
    r
}

fn modulo<const SINGLE: bool>(x: IntervalOf<SINGLE>, c: IntervalOf<SINGLE>) -> IntervalOf<SINGLE> {
    let n = (x / c).floor();
    if n.lo == n.hi {
        return x - n * c;
    }
    // by rounding the result may lie outside [0, c] by a hair
    let epsilon = if SINGLE { SINGLE_SHARE } else { f64::EPSILON };
    let hair = 4.0 * epsilon * (x.mag() + c.mag());
    IntervalOf::rounded(c.lo.min(0.0) - hair, c.hi.max(0.0) + hair)
}

/// What a function of slope at most `slope` may be in the box `p`, from its range at the box's centre. None for an unbounded
/// box.
pub(super) fn around<const SINGLE: bool>(
    p: Vec3<IntervalOf<SINGLE>>,
    slope: f32,
    at_centre: impl FnOnce(Vec3<IntervalOf<SINGLE>>) -> IntervalOf<SINGLE>,
) -> Option<IntervalOf<SINGLE>> {
    let centre = p.map(|c| 0.5 * (c.lo + c.hi));
    let away = |c: IntervalOf<SINGLE>, m: f64| up(c.hi - m).max(up(m - c.lo));
    let reach = up(away(p.x, centre.x)
        .hypot(away(p.y, centre.y))
        .hypot(away(p.z, centre.z)));
    let by = f64::from(slope) * reach;
    if !by.is_finite() {
        return None;
    }
    let v = at_centre(centre.map(IntervalOf::point));
    // for the roundings of the formula's values elsewhere in the box: in single precision those of distances, which are some parts of
    // the coordinates that they are made of
    let hair = if SINGLE {
        let size = p.array().into_iter().fold(0.0, |s, c| c.mag().max(s));
        2e-5 * (by + v.mag() + size)
    } else {
        1e-12 * (by + v.mag())
    };
    Some(IntervalOf::rounded(v.lo - by - hair, v.hi + by + hair))
}
