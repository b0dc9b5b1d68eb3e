//! Joins with sharp edges.
//!
//! `min` and `max` of distance bounds are distance bounds (Ricci 1973): at every place the result is one of the operands
//! or its negation, so its slope is at most the steeper operand's.

use super::*;

/// What sharp joins have no more of than the operands' slopes.
fn steeper(x: f64, y: f64) -> f64 {
    x.max(y)
}

/// What lies in either of two fields.
pub struct Union;
impl Join for Union {
    const INFO: Info = Info {
        name: "union",
        doc: "What lies in either shape.",
        source: "Ricci 1973",
        group: "Joins",
        dimension: Dimension::Any,
        params: &[],
    };
    const SHARP: bool = true;
    const ASSOCIATIVE: bool = true;
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, _a: Args<'_, R>) -> R {
        x.min(y)
    }
    fn kept(x: SingleInterval, y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(x, y, 0.0)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level).hull(&y(level))
    }
    /// Outside both, the nearer surface is the nearest. Inside, a surface that the other operand swallowed may be nearer.
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        x.max(y).max(Exactness::Outside)
    }
    fn contains(x: bool, y: bool) -> bool {
        x || y
    }
}

/// What lies in both of two fields.
pub struct Intersection;
impl Join for Intersection {
    const INFO: Info = Info {
        name: "intersection",
        doc: "What lies in both shapes.",
        source: "Ricci 1973",
        group: "Joins",
        dimension: Dimension::Any,
        params: &[],
    };
    const SHARP: bool = true;
    const ASSOCIATIVE: bool = true;
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, _a: Args<'_, R>) -> R {
        x.max(y)
    }
    fn kept(x: SingleInterval, y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(-x, -y, 0.0)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level).intersect(&y(level))
    }
    /// Outside, the nearest point of one operand may be cut away by the other.
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        x.max(y).max(Exactness::Bound)
    }
    fn contains(x: bool, y: bool) -> bool {
        x && y
    }
}

/// The first of two fields without the second.
pub struct Subtraction;
impl Join for Subtraction {
    const INFO: Info = Info {
        name: "subtraction",
        doc: "The first shape without the second.",
        source: "Ricci 1973",
        group: "Joins",
        dimension: Dimension::Any,
        params: &[],
    };
    const SHARP: bool = true;
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, _a: Args<'_, R>) -> R {
        x.max(-y)
    }
    fn kept(x: SingleInterval, y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(-x, y, 0.0).with_second_negated()
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        _y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level)
    }
    /// Outside, the nearest point of the first operand may be cut away.
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        x.max(y).max(Exactness::Bound)
    }
    fn contains(x: bool, y: bool) -> bool {
        x && !y
    }
}

/// What lies in one of two fields and not in both.
pub struct Xor;
impl Join for Xor {
    const INFO: Info = Info {
        name: "xor",
        doc: "What lies in one shape and not in both.",
        source: "Ricci 1973",
        group: "Joins",
        dimension: Dimension::Any,
        params: &[],
    };
    const SHARP: bool = true;
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, _a: Args<'_, R>) -> R {
        x.min(y).max(-x.max(y))
    }
    fn kept(x: SingleInterval, y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        match Kept::smaller(x, y, 0.0) {
            // max(x, -y)
            Kept::First => Kept::smaller(-x, y, 0.0).with_second_negated(),
            // max(y, -x)
            Kept::Second if Kept::smaller(-y, x, 0.0) == Kept::First => Kept::Second,
            _ => Kept::Both,
        }
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level).hull(&y(level))
    }
    /// Outside both as the union. Inside both, which is outside the result, the distance is that to the nearer surface,
    /// and as good as the operands are inside.
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        match (x, y) {
            (Exactness::Exact, Exactness::Exact) => Exactness::Outside,
            _ => x.max(y).max(Exactness::Bound),
        }
    }
    fn contains(x: bool, y: bool) -> bool {
        x != y
    }
}

/// A shape between two shapes.
pub struct Mix;
impl Join for Mix {
    const INFO: Info = Info {
        name: "mix",
        doc: "A shape on the way from the first to the second.",
        source: "Munini 2021, 2.3",
        group: "Joins",
        dimension: Dimension::Any,
        params: &[number(
            "t",
            Unit::Ratio,
            &[0.5],
            0.0,
            1.0,
            "0 is the first shape, 1 the second.",
        )],
    };
    const SHARP: bool = false;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.0], &[0.1], &[1.0]];
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let t = a.get(0);
        x * t.one_minus() + y * t
    }
    fn lipschitz(a: &[f64], x: f64, y: f64) -> f64 {
        (1.0 - a[0]) * x + a[0] * y
    }
    /// A mean is nowhere below both.
    fn level_bounds(
        _a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb {
        x(level).hull(&y(level))
    }
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        x.max(y).max(Exactness::Bound)
    }
    fn reach(_a: &[f64]) -> f64 {
        f64::INFINITY
    }
    fn contains(x: bool, y: bool) -> bool {
        x && y
    }
}
