//! Maps that make no way longer: foldings, cuts and turns into another dimension. The field behind one is as steep as
//! before.

use super::*;

/// The range of `f * x` over `lo <= x <= hi`, where 0 times infinity is 0.
pub(super) fn scaled(f: f64, lo: f64, hi: f64) -> (f64, f64) {
    let times = |x: f64| if f == 0.0 { 0.0 } else { f * x };
    let (a, b) = (times(lo), times(hi));
    (a.min(b), a.max(b))
}

/// A box that holds `matrix * q + offset` for every `q` of `shape`.
pub(super) fn image(matrix: [[f64; 3]; 3], offset: [f64; 3], shape: &Aabb) -> Aabb {
    if shape.is_empty() {
        return Aabb::EMPTY;
    }
    let (mut min, mut max) = (offset, offset);
    for (i, row) in matrix.iter().enumerate() {
        for (k, &m) in row.iter().enumerate() {
            let (lo, hi) = scaled(m, shape.min[k], shape.max[k]);
            min[i] += lo;
            max[i] += hi;
        }
    }
    Aabb::new(min, max)
}

/// Reflection in the coordinate planes.
pub struct Symmetry;
impl Map for Symmetry {
    const INFO: Info = Info {
        name: "symmetry",
        doc: "Shows the half of the shape at positive coordinates on both sides.",
        source: "",
        group: "Symmetries",
        dimension: Dimension::Any,
        params: &[vec3(
            "axes",
            Unit::Count,
            &[1.0, 0.0, 0.0],
            0.0,
            1.0,
            "1 for every axis that is reflected, else 0.",
        )],
    };
    const SAMPLES: &'static [&'static [f64]] =
        &[&[0.0, 0.0, 0.0], &[1.0, 0.0, 1.0], &[0.0, 1.0, 0.0]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let folds = v3(p.x.like(a.get(0)), p.y.like(a.get(1)), p.z.like(a.get(2)));
        v3(
            R::select(folds.x.above(0.5), p.x.abs(), p.x),
            R::select(folds.y.above(0.5), p.y.abs(), p.y),
            R::select(folds.z.above(0.5), p.z.abs(), p.z),
        )
    }
    fn stretch(_a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(1.0))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        let mut b = *shape;
        for k in (0..3).filter(|&k| a[k] > 0.5) {
            if b.max[k] < 0.0 {
                return Aabb::EMPTY;
            }
            b.min[k] = -b.max[k];
        }
        b
    }
    fn check(a: &[f64]) -> Result<(), String> {
        a.iter().try_for_each(|&x| join_style::whole("axes", x))
    }
}

/// Reflection in a plane.
pub struct Mirror;
impl Mirror {
    fn normal(a: &[f64]) -> [f64; 3] {
        let length = a[0].hypot(a[1]).hypot(a[2]);
        [0, 1, 2].map(|k| a[k] / length)
    }
}
impl Map for Mirror {
    const INFO: Info = Info {
        name: "mirror",
        doc: "Shows what is in front of a plane also behind it, reflected.",
        source: "",
        group: "Symmetries",
        dimension: Dimension::Three,
        params: &[
            vec3(
                "normal",
                Unit::Direction,
                &[1.0, 0.0, 0.0],
                -LARGE,
                LARGE,
                "Points to the side that is kept.",
            ),
            number(
                "offset",
                Unit::Length,
                &[0.0],
                -LARGE,
                LARGE,
                "Distance of the plane from the origin, along the normal.",
            ),
        ],
    };
    const SAMPLES: &'static [&'static [f64]] = &[
        &[1.0, 2.0, -0.5, 0.3],
        &[0.0, -1.0, 0.0, -0.2],
        &[0.0, 0.0, 5.0, 0.4],
    ];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let n = a.vec3(0).normalize();
        let behind = (p.dot(n) - a.get(3)).min(0.0) * 2.0;
        p - v3(behind * n.x, behind * n.y, behind * n.z)
    }
    fn stretch(_a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(1.0))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        let n = Mirror::normal(a);
        let mut kept = *shape;
        if let Some(k) = (0..3).find(|&k| n[k].abs() == 1.0) {
            if n[k] > 0.0 {
                kept.min[k] = kept.min[k].max(a[3]);
            } else {
                kept.max[k] = kept.max[k].min(-a[3]);
            }
        }
        let row = |i: usize| std::array::from_fn(|k| f64::from(i == k) - 2.0 * n[i] * n[k]);
        kept.hull(&image(
            [row(0), row(1), row(2)],
            n.map(|c| 2.0 * a[3] * c),
            &kept,
        ))
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let length = a[0].hypot(a[1]).hypot(a[2]);
        if length > SMALL {
            Ok(())
        } else {
            Err("normal is (0, 0, 0), allowed is any other direction".into())
        }
    }
}

/// A shape cut at the origin and pulled apart.
pub struct Elongate;
impl Map for Elongate {
    const INFO: Info = Info {
        name: "elongate",
        doc: "Cuts the shape at its middle, pulls the halves apart and fills the gap.",
        source: "Quilez 2018, elongation",
        group: "Deformations",
        dimension: Dimension::Any,
        params: &[vec3(
            "size",
            Unit::Length,
            &[1.0, 0.0, 0.0],
            0.0,
            LARGE,
            "How much longer along x, y and z.",
        )],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[0.3, 0.0, 2.0], &[0.0, 0.7, 0.0]];
    /// `p` less its nearest point in a box, as the middle one of `c - h`, 0 and `c + h`: tight for intervals, and where
    /// nothing is elongated the derivative is 1.
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let h = a.vec3(0).scale(0.5);
        v3(
            (p.x + h.x).min(0.0).max(p.x - h.x),
            (p.y + h.y).min(0.0).max(p.y - h.y),
            (p.z + h.z).min(0.0).max(p.z - h.z),
        )
    }
    fn stretch(_a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(1.0))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        if shape.is_empty() {
            return Aabb::EMPTY;
        }
        // a side at 0 is seen at both ends of the gap
        let side = |k: usize, x: f64, outwards: f64| {
            x + 0.5 * a[k] * if x == 0.0 { outwards } else { x.signum() }
        };
        Aabb::new(
            std::array::from_fn(|k| side(k, shape.min[k], -1.0)),
            std::array::from_fn(|k| side(k, shape.max[k], 1.0)),
        )
    }
    fn plane(a: &[f64]) -> Result<(), String> {
        if a[2] == 0.0 {
            return Ok(());
        }
        Err(format!(
            "size is {} along z, but a plane shape has no z to be pulled along: extrude(...) makes a solid of it",
            a[2]
        ))
    }
}

/// A 2D shape turned about the y axis.
pub struct Revolve;
impl Map for Revolve {
    const INFO: Info = Info {
        name: "revolve",
        doc: "A solid from a 2D shape, turned about the y axis.",
        source: "Quilez 2018, revolution",
        group: "From 2D and back",
        dimension: Dimension::Two,
        params: &[number(
            "offset",
            Unit::Length,
            &[0.0],
            -LARGE,
            LARGE,
            "How far the shape's origin is from the axis.",
        )],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[1.2], &[-0.3]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(length2(p.x, p.z) - a.get(0), p.y, p.x.lit(0.0))
    }
    fn stretch(_a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(1.0))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        let r = shape.max[0] + a[0];
        if shape.is_empty() || r < 0.0 {
            return Aabb::EMPTY;
        }
        Aabb::new([-r, shape.min[1], -r], [r, shape.max[1], r])
    }
}

/// A solid cut across the z axis.
pub struct Slice;
impl Map for Slice {
    const INFO: Info = Info {
        name: "slice",
        doc: "A 2D shape: the section of a solid across the z axis.",
        source: "",
        group: "From 2D and back",
        dimension: Dimension::Three,
        params: &[number(
            "at",
            Unit::Length,
            &[0.0],
            -LARGE,
            LARGE,
            "Where it is cut: z.",
        )],
    };
    const SECTION: bool = true;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.4]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(p.x, p.y, p.x.like(a.get(0)))
    }
    fn stretch(_a: &[f64], _bounds: &Aabb) -> Result<Stretch, String> {
        Ok(Stretch::Everywhere(1.0))
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        if shape.is_empty() || a[0] < shape.min[2] || a[0] > shape.max[2] {
            return Aabb::EMPTY;
        }
        let mut b = *shape;
        (b.min[2], b.max[2]) = (f64::NEG_INFINITY, f64::INFINITY);
        b
    }
}
