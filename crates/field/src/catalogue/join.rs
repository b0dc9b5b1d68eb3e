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
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, _a: Args<'_, R>) -> R {
        x.min(y)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn bounds(_a: &[f64], x: &Aabb, y: &Aabb) -> Aabb {
        x.hull(y)
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
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, _a: Args<'_, R>) -> R {
        x.max(y)
    }
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn bounds(_a: &[f64], x: &Aabb, y: &Aabb) -> Aabb {
        x.intersect(y)
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
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        steeper(x, y)
    }
    fn bounds(_a: &[f64], x: &Aabb, _y: &Aabb) -> Aabb {
        *x
    }
    /// Outside, the nearest point of the first operand may be cut away.
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        x.max(y).max(Exactness::Bound)
    }
    fn contains(x: bool, y: bool) -> bool {
        x && !y
    }
}
