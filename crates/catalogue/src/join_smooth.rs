//! Joins that round the edge where two surfaces meet, in the form `min(x, y) - k g(|x - y| / k)`.
//!
//! `g` falls from `g(0)`, where its slope is -1/2 and so the two sides meet without an edge, to 0. As its slope stays in
//! [-1, 0], the derivatives by `x` and `y` are not negative and add up to 1 (see [`super::join_style`]): no smooth join is
//! steeper than its operands. `k` is the support, beyond which the minimum is left alone; only the exponential one, which
//! is the associative one, has none.

use super::join_style::{Style, StyledIntersection, StyledSubtraction, StyledUnion};
use super::*;
use std::f64::consts::{FRAC_1_SQRT_2, LN_2};

const RADIUS: Param = number(
    "radius",
    Unit::Length,
    &[0.25],
    SMALL,
    LARGE,
    "Size of the smooth edge: where the operands differ by more, they stay.",
);
const SAMPLES: &[&[f64]] = &[&[0.02], &[1.5]];

/// `max(k - |x - y|, 0) / k`: 1 where the operands agree, 0 beyond the support.
#[inline(always)]
fn nearness<R: Real>(x: R, y: R, k: R::Scalar) -> R {
    ((x - y).abs() / k).one_minus().max(0.0)
}

/// Quadratic: `g(s) = (1 - s)^2 / 4`.
pub struct Quadratic;
impl Style for Quadratic {
    const NAMES: [&'static str; 3] = ["smooth_union", "smooth_intersection", "smooth_subtraction"];
    const DOCS: [&'static str; 3] = [
        "Union with a smooth inner edge.",
        "Intersection with a smooth outer edge.",
        "Subtraction with a smooth outer edge.",
    ];
    const SOURCE: &'static str = "Quilez 2013, smooth minimum (quadratic)";
    const GROUP: &'static str = "Smooth joins";
    const PARAMS: &'static [Param] = &[RADIUS];
    const SAMPLES: &'static [&'static [f64]] = SAMPLES;
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let k = a.get(0);
        x.min(y) - nearness(x, y, k).sq() * (k * 0.25)
    }
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(x, y, a.get(0).hi)
    }
    fn reach(a: &[f64]) -> f64 {
        0.25 * a[0]
    }
}

/// Cubic: `g(s) = (1 - s)^3 / 6`. Its curvature fades out too, which reflections show.
pub struct Cubic;
impl Style for Cubic {
    const NAMES: [&'static str; 3] = [
        "smooth_union_cubic",
        "smooth_intersection_cubic",
        "smooth_subtraction_cubic",
    ];
    const DOCS: [&'static str; 3] = [
        "Union with a smooth inner edge whose curvature fades out.",
        "Intersection with a smooth outer edge whose curvature fades out.",
        "Subtraction with a smooth outer edge whose curvature fades out.",
    ];
    const SOURCE: &'static str = "Quilez 2013, smooth minimum (cubic)";
    const GROUP: &'static str = "Smooth joins";
    const PARAMS: &'static [Param] = &[RADIUS];
    const SAMPLES: &'static [&'static [f64]] = SAMPLES;
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let k = a.get(0);
        let h = nearness(x, y, k);
        x.min(y) - h.sq() * h * (k * (1.0 / 6.0))
    }
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(x, y, a.get(0).hi)
    }
    fn reach(a: &[f64]) -> f64 {
        a[0] / 6.0
    }
}

/// Circular: the profile is a quarter of a circle around (k, k), `g(s) = 1 - s / 2 - sqrt(2 - s^2) / 2`.
pub struct Circular;
impl Style for Circular {
    const NAMES: [&'static str; 3] = [
        "smooth_union_circular",
        "smooth_intersection_circular",
        "smooth_subtraction_circular",
    ];
    const DOCS: [&'static str; 3] = [
        "Union with an inner edge that is a circular arc between walls at right angles.",
        "Intersection with an outer edge that is a circular arc between walls at right angles.",
        "Subtraction with an outer edge that is a circular arc between walls at right angles.",
    ];
    const SOURCE: &'static str = "Quilez 2013, smooth minimum (circular geometrical)";
    const GROUP: &'static str = "Smooth joins";
    const PARAMS: &'static [Param] = &[RADIUS];
    const SAMPLES: &'static [&'static [f64]] = SAMPLES;
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let k = a.get(0);
        let s = ((x - y).abs() / k).min(1.0);
        let arc = (-s.sq() + 2.0).sqrt();
        x.min(y) - (-(s + arc) * 0.5 + 1.0) * k
    }
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(x, y, a.get(0).hi)
    }
    fn reach(a: &[f64]) -> f64 {
        (1.0 - FRAC_1_SQRT_2) * a[0]
    }
}

/// Exponential: `-c ln(exp(-x / c) + exp(-y / c))` with `c = k / (4 ln 2)`, which takes as much from the minimum as the
/// quadratic style: `g(s) = log2(1 + 16^-s) / 4`. Joining more than two shapes gives the same in any order.
pub struct Exponential;
impl Style for Exponential {
    const NAMES: [&'static str; 3] = [
        "smooth_union_exponential",
        "smooth_intersection_exponential",
        "smooth_subtraction_exponential",
    ];
    const DOCS: [&'static str; 3] = [
        "Smooth union that does not depend on the order of its shapes.",
        "Smooth intersection that does not depend on the order of its shapes.",
        "Subtraction with a smooth outer edge that fades out slowly.",
    ];
    const SOURCE: &'static str = "Quilez 2013, smooth minimum (exponential)";
    const GROUP: &'static str = "Smooth joins";
    const PARAMS: &'static [Param] = &[RADIUS];
    const SAMPLES: &'static [&'static [f64]] = SAMPLES;
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let c = a.get(0) * R::constant(0.25 / LN_2);
        // the sum over its larger term: no overflow, however far away
        x.min(y) - ((-(x - y).abs() / c).exp() + 1.0).ln() * c
    }
    fn reach(a: &[f64]) -> f64 {
        0.25 * a[0]
    }
}

/// Union, quadratic.
pub type SmoothUnion = StyledUnion<Quadratic>;
/// Intersection, quadratic.
pub type SmoothIntersection = StyledIntersection<Quadratic>;
/// Subtraction, quadratic.
pub type SmoothSubtraction = StyledSubtraction<Quadratic>;
/// Union, cubic.
pub type CubicUnion = StyledUnion<Cubic>;
/// Intersection, cubic.
pub type CubicIntersection = StyledIntersection<Cubic>;
/// Subtraction, cubic.
pub type CubicSubtraction = StyledSubtraction<Cubic>;
/// Union, circular.
pub type CircularUnion = StyledUnion<Circular>;
/// Intersection, circular.
pub type CircularIntersection = StyledIntersection<Circular>;
/// Subtraction, circular.
pub type CircularSubtraction = StyledSubtraction<Circular>;
/// Union, exponential.
pub type ExponentialUnion = StyledUnion<Exponential>;
/// Intersection, exponential.
pub type ExponentialIntersection = StyledIntersection<Exponential>;
/// Subtraction, exponential.
pub type ExponentialSubtraction = StyledSubtraction<Exponential>;
