//! Changes of one field's value.

use super::*;

/// The shell around a surface.
pub struct Onion;
impl Modify for Onion {
    const INFO: Info = Info {
        name: "onion",
        doc: "A shell along the surface.",
        source: "Quilez 2008",
        group: "Modifiers",
        dimension: Dimension::Any,
        params: &[number(
            "thickness",
            Unit::Length,
            &[0.1],
            0.0,
            LARGE,
            "Thickness of the shell, half on each side of the surface.",
        )],
    };
    #[inline(always)]
    fn modify<R: Real>(d: R, _p: Vec3<R>, a: Args<'_, R>) -> R {
        d.abs() - a.get(0) * 0.5
    }
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        shape.grow(0.5 * a[0])
    }
    /// Outside the shell is also the shape's inside. Within it, an inner corner's nearest point is farther than the level
    /// says.
    fn exactness(shape: Exactness) -> Exactness {
        match shape {
            Exactness::Exact => Exactness::Outside,
            _ => shape.max(Exactness::Bound),
        }
    }
}

/// The shape and all that is close to it.
pub struct Round;
impl Modify for Round {
    const INFO: Info = Info {
        name: "round",
        doc: "Grows the shape, which rounds its outer edges.",
        source: "Quilez 2008",
        group: "Modifiers",
        dimension: Dimension::Any,
        params: &[number(
            "radius",
            Unit::Length,
            &[0.1],
            0.0,
            LARGE,
            "How far the surface moves out.",
        )],
    };
    #[inline(always)]
    fn modify<R: Real>(d: R, _p: Vec3<R>, a: Args<'_, R>) -> R {
        d - a.get(0)
    }
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        shape.grow(a[0])
    }
    /// Inside, a gap that closed leaves its walls behind in the distance.
    fn exactness(shape: Exactness) -> Exactness {
        shape.max(Exactness::Outside)
    }
}

/// A 2D shape pulled along z.
pub struct Extrude;
impl Modify for Extrude {
    const INFO: Info = Info {
        name: "extrude",
        doc: "A solid from a 2D shape, pulled along z.",
        source: "Quilez 2008",
        group: "Modifiers",
        dimension: Dimension::Two,
        params: &[number(
            "height",
            Unit::Length,
            &[1.0],
            SMALL,
            LARGE,
            "Full height of the solid, half on each side of z = 0.",
        )],
    };
    #[inline(always)]
    fn modify<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        let z = p.z.abs() - a.get(0) * 0.5;
        length2(d.max(0.0), z.max(0.0)) + d.max(z).min(0.0)
    }
    /// The field and the height change in directions at right angles.
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope.max(1.0)
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        let mut b = *shape;
        (b.min[2], b.max[2]) = (-0.5 * a[0], 0.5 * a[0]);
        b
    }
    fn exactness(shape: Exactness) -> Exactness {
        shape
    }
}
