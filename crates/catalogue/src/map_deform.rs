//! Maps that stretch and turn: how much is the largest singular value of their derivative, in closed form.

use super::map::{image, scaled};
use super::*;

/// Largest singular value of the matrix ((a, b), (0, 1)).
///
/// Singular values s >= t of a 2x2 matrix have `(s + t)^2 = |M|^2 + 2 |det|` and `(s - t)^2 = |M|^2 - 2 |det|`; here these
/// are `(a + 1)^2 + b^2` and `(a - 1)^2 + b^2`. It grows with |a| and with |b|.
pub(super) fn corner_stretch(a: f64, b: f64) -> f64 {
    0.5 * ((a.abs() + 1.0).hypot(b) + (a.abs() - 1.0).hypot(b))
}

/// Scale along the axes.
pub struct Scale3;
impl Map for Scale3 {
    const INFO: Info = Info {
        name: "stretch",
        doc: "Scales the shape by a factor of its own along each axis.",
        source: "",
        group: "Deformations",
        dimension: Dimension::Any,
        params: &[vec3(
            "factor",
            Unit::Ratio,
            &[1.0, 1.0, 1.0],
            1e-3,
            1e3,
            "Factors along x, y and z.",
        )],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.5, 1.0], &[0.2, 1.0, 3.0]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        p.over(a.vec3(0))
    }
    /// What is squeezed most makes the field steepest.
    fn stretch(a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(1.0 / a[0].min(a[1]).min(a[2])))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        image(
            [[a[0], 0.0, 0.0], [0.0, a[1], 0.0], [0.0, 0.0, a[2]]],
            [0.0; 3],
            shape,
        )
    }
}

/// A lean.
pub struct Shear;
impl Map for Shear {
    const INFO: Info = Info {
        name: "shear",
        doc: "Leans the shape: moves it along x and z in proportion to its height y.",
        source: "",
        group: "Deformations",
        dimension: Dimension::Any,
        params: &[
            number(
                "x",
                Unit::Ratio,
                &[0.5],
                -100.0,
                100.0,
                "Way along x per unit of height.",
            ),
            number(
                "z",
                Unit::Ratio,
                &[0.0],
                -100.0,
                100.0,
                "Way along z per unit of height.",
            ),
        ],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[-1.0, 2.0], &[0.0, 0.0], &[0.1, 0.3]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(p.x - p.y * a.get(0), p.y, p.z - p.y * a.get(1))
    }
    fn stretch(a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(corner_stretch(1.0, a[0].hypot(a[1]))))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        image(
            [[1.0, a[0], 0.0], [0.0, 1.0, 0.0], [0.0, a[1], 1.0]],
            [0.0; 3],
            shape,
        )
    }
    fn plane(a: &[f64]) -> Result<(), String> {
        if a[1] == 0.0 {
            return Ok(());
        }
        Err(format!(
            "z is {}, but a plane shape cannot lean out of its plane: make a solid of it with extrude(...) first",
            a[1]
        ))
    }
}

/// A turn that grows with height.
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
    const SAMPLES: &'static [&'static [f64]] = &[&[0.0], &[-2.5]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let (s, c) = (p.y * a.get(0)).sin_cos();
        v3(p.x * c - p.z * s, p.y, p.x * s + p.z * c)
    }
    /// A turn after a shear by `rate` times the distance from the axis.
    fn stretch(a: &[f64], bounds: &Aabb) -> Result<Stretch, String> {
        let radius = bounds.radius_about(1);
        if !radius.is_finite() {
            return Err(
                "the shape must be bounded in x and z; intersect it with a box or a cylinder first"
                    .into(),
            );
        }
        Ok(Stretch::Within(*bounds, corner_stretch(1.0, a[0] * radius)))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        if shape.is_empty() || a[0] == 0.0 {
            return *shape;
        }
        let r = shape.radius_about(1);
        Aabb::new([-r, shape.min[1], -r], [r, shape.max[1], r])
    }
}

/// A size that changes with height.
pub struct Taper;
impl Taper {
    /// The scale at height `y`.
    fn scale(a: &[f64], y: f64) -> f64 {
        1.0 + (a[1] - 1.0) * (y / a[0] + 0.5).clamp(0.0, 1.0)
    }
}
impl Map for Taper {
    const INFO: Info = Info {
        name: "taper",
        doc: "Scales the shape in x and z, from its full size at the bottom to another at the top.",
        source: "Barr 1984, global tapering",
        group: "Deformations",
        dimension: Dimension::Three,
        params: &[
            number(
                "height",
                Unit::Length,
                &[2.0],
                SMALL,
                LARGE,
                "Height over which the size changes, half on each side of y = 0.",
            ),
            number(
                "top",
                Unit::Ratio,
                &[0.5],
                0.01,
                100.0,
                "Scale at the top; 1 at the bottom.",
            ),
        ],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 3.0], &[3.0, 0.2], &[1.0, 1.0]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let s = (p.y / a.get(0) + 0.5).clamp01() * (a.get(1) - 1.0) + 1.0;
        v3(p.x / s, p.y, p.z / s)
    }
    /// With r the distance from the axis and s the scale: outwards the derivative is 1 / s, and going up changes the
    /// place by r s' / s^2.
    fn stretch(a: &[f64], bounds: &Aabb) -> Result<Stretch, String> {
        let radius = bounds.radius_about(1);
        if !radius.is_finite() {
            return Err(
                "the shape must be bounded in x and z; intersect it with a box or a cylinder first"
                    .into(),
            );
        }
        if bounds.is_empty() {
            return Ok(Stretch::Within(*bounds, 1.0));
        }
        let least = Taper::scale(a, bounds.min[1]).min(Taper::scale(a, bounds.max[1]));
        let changes = bounds.min[1] < 0.5 * a[0] && bounds.max[1] > -0.5 * a[0];
        let rate = if changes { (a[1] - 1.0) / a[0] } else { 0.0 };
        let across = 1.0 / least;
        Ok(Stretch::Within(
            *bounds,
            corner_stretch(across, radius * rate * across * across),
        ))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        if shape.is_empty() {
            return *shape;
        }
        let (s, t) = (Taper::scale(a, shape.min[1]), Taper::scale(a, shape.max[1]));
        let mut b = *shape;
        for k in [0, 2] {
            let (at_s, at_t) = (
                scaled(s, shape.min[k], shape.max[k]),
                scaled(t, shape.min[k], shape.max[k]),
            );
            (b.min[k], b.max[k]) = (at_s.0.min(at_t.0), at_s.1.max(at_t.1));
        }
        b
    }
}
