//! Boxes and half spaces.

use super::*;

/// A box with sharp edges.
pub struct Cuboid;
impl Primitive for Cuboid {
    const INFO: Info = solid(
        "Boxes",
        "box",
        "A box around the origin.",
        "Tomczak 2012, algorithm 3.6",
        &[SIZE],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.5, 1.0], &[0.01, 3.0, 0.02]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        corner((p.abs() - half(a)).array())
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred(triple(a, 0).map(|s| 0.5 * s))
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        (0..3).all(|k| 2.0 * p[k].abs() <= a[k])
    }
}

const SIZE: Param = vec3(
    "size",
    Unit::Length,
    &[1.0, 1.0, 1.0],
    SMALL,
    LARGE,
    "Full sides along x, y and z.",
);

#[inline(always)]
fn half<R: Real>(a: Args<'_, R>) -> Vec3<R::Scalar> {
    v3(a.get(0) * 0.5, a.get(1) * 0.5, a.get(2) * 0.5)
}

/// The box by a bound that is too small beside its edges: it costs less and shows what a bound does to occlusion.
pub struct BoundBox;
impl Primitive for BoundBox {
    const INFO: Info = solid(
        "Boxes",
        "box_bound",
        "The box by its largest face distance, too small beside the edges.",
        "Tomczak 2012, algorithm 3.5",
        &[SIZE],
    );
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = Cuboid::SAMPLES;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        (p.abs() - half(a)).max_component()
    }
    fn bounds(a: &[f64]) -> Aabb {
        Cuboid::bounds(a)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        Cuboid::contains(a, p)
    }
}

/// A box with round edges.
pub struct RoundedBox;
impl Primitive for RoundedBox {
    const INFO: Info = solid(
        "Boxes",
        "rounded_box",
        "A box with round edges.",
        "",
        &[
            SIZE,
            number(
                "round",
                Unit::Length,
                &[0.1],
                0.0,
                LARGE,
                "Radius of the edges; the size stays.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[2.0, 0.5, 1.0, 0.25],
        &[1.0, 1.0, 1.0, 0.0],
        &[0.5, 0.7, 2.0, 0.01],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let round = a.get(3);
        let core = half(a).map(
            #[inline(always)]
            |h: R::Scalar| h - round,
        );
        corner((p.abs() - core).array()) - round
    }
    fn bounds(a: &[f64]) -> Aabb {
        Cuboid::bounds(a)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // The ball of radius `round` around the nearest point of the inner box reaches `p`.
        let gap = |k: usize| (p[k].abs() - (0.5 * a[k] - a[3])).max(0.0);
        let square = (0..3).map(|k| gap(k) * gap(k)).sum::<f64>();
        if a[3] > 0.0 {
            square <= a[3] * a[3]
        } else {
            Cuboid::contains(a, p)
        }
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let most = 0.5 * a[0].min(a[1]).min(a[2]);
        if a[3] <= most {
            Ok(())
        } else {
            Err(format!(
                "round must be at most half the shortest side, {most}, not {}",
                a[3]
            ))
        }
    }
}

/// The twelve edges of a box.
pub struct BoxFrame;
impl Primitive for BoxFrame {
    const INFO: Info = solid(
        "Boxes",
        "box_frame",
        "The edges of a box, as square bars.",
        "",
        &[
            SIZE,
            size(
                "thickness",
                &[0.1],
                "Full side of the bars' square section.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 1.0, 0.5, 0.2], &[1.0, 1.5, 1.0, 0.4]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let bar = a.get(3) * 0.5;
        // From the ends of the bars, and across them.
        let end = p.abs() - half(a);
        let across = end.map(
            #[inline(always)]
            |e: R| (e + bar).abs() - bar,
        );
        let x = corner([end.x, across.y, across.z]);
        let y = corner([across.x, end.y, across.z]);
        let z = corner([across.x, across.y, end.z]);
        x.min(y.min(z))
    }
    fn bounds(a: &[f64]) -> Aabb {
        Cuboid::bounds(a)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // In the box, and near a face in at least two directions.
        let near = (0..3).filter(|&k| p[k].abs() >= 0.5 * a[k] - a[3]).count();
        Cuboid::contains(a, p) && near >= 2
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let most = 0.5 * a[0].min(a[1]).min(a[2]);
        if a[3] <= most {
            Ok(())
        } else {
            Err(format!(
                "thickness must be at most half the shortest side, {most}, not {}",
                a[3]
            ))
        }
    }
}

/// The half space below `y = 0`.
pub struct Plane;
impl Primitive for Plane {
    const INFO: Info = solid(
        "Boxes",
        "plane",
        "The half space below y = 0: a floor.",
        "",
        &[],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> R {
        p.y
    }
    fn bounds(_a: &[f64]) -> Aabb {
        Aabb {
            max: [f64::INFINITY, 0.0, f64::INFINITY],
            ..Aabb::WHOLE
        }
    }
    fn contains(_a: &[f64], p: [f64; 3]) -> bool {
        p[1] <= 0.0
    }
}

/// The space between two horizontal planes.
pub struct Slab;
impl Primitive for Slab {
    const INFO: Info = solid(
        "Boxes",
        "slab",
        "The space between two horizontal planes.",
        "",
        &[size("thickness", &[0.2], "Distance between the planes.")],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        p.y.abs() - a.get(0) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([f64::INFINITY, 0.5 * a[0], f64::INFINITY])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        2.0 * p[1].abs() <= a[0]
    }
}
