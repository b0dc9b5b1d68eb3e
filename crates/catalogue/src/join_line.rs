//! Joins that work along the line where two surfaces meet.

use super::*;

/// Distance bounds, not distances.
fn bound(x: Exactness, y: Exactness) -> Exactness {
    x.max(y).max(Exactness::Bound)
}

/// A pipe along the line where two surfaces meet.
pub struct Pipe;
impl Join for Pipe {
    const INFO: Info = Info {
        name: "pipe",
        doc: "A pipe along the line where two surfaces meet; both shapes vanish.",
        source: "Mercury 2016, hg_sdf, pipe",
        group: "Line joins",
        dimension: Dimension::Any,
        params: &[number(
            "radius",
            Unit::Length,
            &[0.1],
            SMALL,
            LARGE,
            "Radius of the pipe.",
        )],
    };
    const SHARP: bool = false;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.5]];
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        length2(x, y) - a.get(0)
    }
    /// The derivatives are a unit vector.
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.hypot(y)
    }
    fn level_bounds(
        a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level + a[0]).intersect(&y(level + a[0]))
    }
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        bound(x, y)
    }
    fn reach(a: &[f64]) -> f64 {
        a[0]
    }
    fn contains(_x: bool, _y: bool) -> bool {
        false
    }
}

/// A V-shaped groove in one surface where it meets another.
pub struct Engrave;
impl Join for Engrave {
    const INFO: Info = Info {
        name: "engrave",
        doc: "Cuts a V-shaped groove into the first shape where the second one's surface meets it.",
        source: "Profile: Mercury 2016, hg_sdf, engrave",
        group: "Line joins",
        dimension: Dimension::Any,
        params: &[number(
            "depth",
            Unit::Length,
            &[0.1],
            SMALL,
            LARGE,
            "Depth of the groove, and half its width.",
        )],
    };
    const SHARP: bool = false;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.5]];
    /// Half of `x + depth - |y|`, for the reason that a chamfer has half: the slopes are the operands'.
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        x.max((x - y.abs() + a.get(0)) * 0.5)
    }
    fn kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        let size = x.mag() + y.mag() + a.get(0).hi;
        let beside = x.lo + Real::abs(y).lo > a.get(0).hi + 1e-5 * size;
        Kept::first_if(x.is_finite() && y.is_finite() && beside)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.max(0.5 * (x + y))
    }
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        _y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level)
    }
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        bound(x, y)
    }
    fn reach(a: &[f64]) -> f64 {
        a[0]
    }
    fn contains(x: bool, _y: bool) -> bool {
        x
    }
}

/// The depth or height and the width of what runs along the line.
const RAIL: [Param; 2] = [
    number(
        "depth",
        Unit::Length,
        &[0.1],
        SMALL,
        LARGE,
        "How far it goes into or out of the first surface.",
    ),
    number("width", Unit::Length, &[0.1], SMALL, LARGE, "Full width."),
];

/// A groove with straight walls.
pub struct Groove;
impl Join for Groove {
    const INFO: Info = Info {
        name: "groove",
        doc: "Cuts a groove with straight walls into the first shape where the second one's surface meets it.",
        source: "Mercury 2016, hg_sdf, groove",
        group: "Line joins",
        dimension: Dimension::Any,
        params: &RAIL,
    };
    const SHARP: bool = false;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.3, 0.8], &[0.5, 0.05]];
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        x.max((x + a.get(0)).min(-(y.abs() - a.get(1) * 0.5)))
    }
    fn kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        let wall = -(Real::abs(y) - a.get(1) * 0.5);
        Kept::first_if(Kept::smaller(-x, -wall, 0.0) == Kept::First)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.max(y)
    }
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        _y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level)
    }
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        bound(x, y)
    }
    fn reach(a: &[f64]) -> f64 {
        a[0].max(0.5 * a[1])
    }
    fn contains(x: bool, _y: bool) -> bool {
        x
    }
}

/// A rail with straight walls.
pub struct Tongue;
impl Join for Tongue {
    const INFO: Info = Info {
        name: "tongue",
        doc: "Puts a rail with straight walls onto the first shape where the second one's surface meets it.",
        source: "Mercury 2016, hg_sdf, tongue",
        group: "Line joins",
        dimension: Dimension::Any,
        params: &RAIL,
    };
    const SHARP: bool = false;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.3, 0.8], &[0.5, 0.05]];
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        x.min((x - a.get(0)).max(y.abs() - a.get(1) * 0.5))
    }
    fn kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        let wall = Real::abs(y) - a.get(1) * 0.5;
        Kept::first_if(Kept::smaller(x, wall, 0.0) == Kept::First)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.max(y)
    }
    fn level_bounds(
        a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level).hull(&x(level + a[0]).intersect(&y(level + 0.5 * a[1])))
    }
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        bound(x, y)
    }
    fn reach(a: &[f64]) -> f64 {
        a[0].max(0.5 * a[1])
    }
    fn contains(x: bool, _y: bool) -> bool {
        x
    }
}
