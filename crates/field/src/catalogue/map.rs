//! Maps of space that bend.

use super::*;

/// Turns space about the y axis in proportion to height.
pub struct Twist;
impl Map for Twist {
    const INFO: Info = Info {
        name: "twist",
        doc: "Turns the shape about the y axis, the more the higher.",
        source: "Barr 1984, global twisting",
        group: "Deformations",
        dimension: Dimension::Three,
        params: &[number(
            "rate",
            Unit::Rate,
            &[0.5],
            -LARGE,
            LARGE,
            "Turn per unit of height.",
        )],
    };
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let (s, c) = (p.y * a.get(0)).sin_cos();
        Vec3 {
            x: p.x * c - p.z * s,
            y: p.y,
            z: p.x * s + p.z * c,
        }
    }
    /// A turn after a shear by `rate` times the distance from the axis.
    fn stretch(a: &[f64], bounds: &Aabb) -> Result<Stretch, String> {
        if a[0] == 0.0 {
            return Ok(Stretch::Everywhere(1.0));
        }
        let radius = bounds.radius_about(1);
        if !radius.is_finite() {
            return Err("twist needs a shape that is bounded in x and z; intersect it with a box or a cylinder first".into());
        }
        Ok(Stretch::Within(*bounds, shear_stretch(a[0] * radius)))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        if shape.is_empty() || a[0] == 0.0 {
            return *shape;
        }
        let r = shape.radius_about(1);
        Aabb::new([-r, shape.min[1], -r], [r, shape.max[1], r])
    }
}

/// Largest singular value of the shear `x + s y`.
fn shear_stretch(s: f64) -> f64 {
    0.5 * (s.abs() + s.hypot(2.0))
}
