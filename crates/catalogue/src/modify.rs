//! Changes of one field's value.

use super::*;

/// The other side of a surface.
pub struct Complement;
impl Modify for Complement {
    const INFO: Info = Info {
        name: "complement",
        doc: "All that is not in the shape.",
        source: "Ricci 1973",
        group: "Modifiers",
        dimension: Dimension::Any,
        params: &[],
    };
    #[inline(always)]
    fn modify<R: Real>(d: R, _p: Vec3<R>, _a: Args<'_, R>) -> R {
        -d
    }
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope
    }
    fn level_bounds(_a: &[f64], _level: f64, _shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        Aabb::WHOLE
    }
    /// What was inside is outside now.
    fn exactness(shape: Exactness) -> Exactness {
        match shape {
            Exactness::Outside => Exactness::Bound,
            other => other,
        }
    }
}

/// The surface moved along its normal.
pub struct Offset;
impl Modify for Offset {
    const INFO: Info = Info {
        name: "offset",
        doc: "Moves the surface out, or in where the distance is negative.",
        source: "",
        group: "Modifiers",
        dimension: Dimension::Any,
        params: &[number(
            "distance",
            Unit::Length,
            &[0.1],
            -LARGE,
            LARGE,
            "How far; negative moves inwards.",
        )],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[-0.15], &[0.4]];
    #[inline(always)]
    fn modify<R: Real>(d: R, _p: Vec3<R>, a: Args<'_, R>) -> R {
        d - a.get(0)
    }
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope
    }
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        shape(level + a[0])
    }
    /// Moved inwards, an outer edge stays sharp, and the distance outside does not know of it.
    fn exactness(shape: Exactness) -> Exactness {
        shape.max(Exactness::Bound)
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
    const SAMPLES: &'static [&'static [f64]] = &[&[0.0], &[0.6]];
    #[inline(always)]
    fn modify<R: Real>(d: R, _p: Vec3<R>, a: Args<'_, R>) -> R {
        d - a.get(0)
    }
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope
    }
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        shape(level + a[0])
    }
    /// Inside, a gap that closed leaves its walls behind in the distance.
    fn exactness(shape: Exactness) -> Exactness {
        shape.max(Exactness::Outside)
    }
}

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
    const SAMPLES: &'static [&'static [f64]] = &[&[0.0], &[0.5]];
    #[inline(always)]
    fn modify<R: Real>(d: R, _p: Vec3<R>, a: Args<'_, R>) -> R {
        d.abs() - a.get(0) * 0.5
    }
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope
    }
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        shape(level + 0.5 * a[0])
    }
    /// The distance to the surface less a constant is the distance outside the shell, the shape's inside included. In the
    /// shell, near an edge, it is only a bound.
    fn exactness(shape: Exactness) -> Exactness {
        match shape {
            Exactness::Exact => Exactness::Outside,
            other => other.max(Exactness::Bound),
        }
    }
}

/// A 2D shape pulled along z.
pub struct Extrude;
impl Modify for Extrude {
    const READS_POINT: bool = true;
    const INFO: Info = Info {
        name: "extrude",
        doc: "A solid from a 2D shape, pulled along z.",
        source: "Quilez 2018, extrusion",
        group: "From 2D and back",
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
    const SAMPLES: &'static [&'static [f64]] = &[&[0.05], &[4.0]];
    #[inline(always)]
    fn modify<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        let z = p.z.abs() - a.get(0) * 0.5;
        // on the surface, the derivative is that of the field or the height, not of 0
        length2(d.max(0.0), z.max(0.0)) + d.lit(0.0).min(d.max(z))
    }
    /// The field and the height change in directions at right angles, and the derivatives by them are a unit vector or 1.
    fn lipschitz(_a: &[f64], slope: f64) -> f64 {
        slope.max(1.0)
    }
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        let mut b = shape(level);
        let z = 0.5 * a[0] + level;
        (b.min[2], b.max[2]) = (-z, z);
        b
    }
    /// Above and below the shape, the height alone counts, so a bound inside the 2D shape is no matter outside the solid.
    fn exactness(shape: Exactness) -> Exactness {
        shape
    }
}
