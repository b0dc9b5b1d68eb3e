//! The everyday solids.

use super::*;
use crate::number::Vec3;

/// The distance to the corner of a box from the distances `q` to its faces, positive outside: the length of what sticks
/// out, or else the largest. Chosen rather than added, so that the gradient is right on the very surface too.
#[inline(always)]
fn corner<R: Real, const N: usize>(q: [R; N]) -> R {
    let mut largest = q[0];
    let mut out = q;
    for k in 0..N {
        largest = largest.max(q[k]);
        out[k] = q[k].max(0.0);
    }
    R::select(largest.above(0.0), R::norm(out), largest)
}

/// A ball.
pub struct Sphere;
impl Primitive for Sphere {
    const INFO: Info = Info {
        name: "sphere",
        doc: "A ball around the origin.",
        source: "",
        group: "Solids",
        dimension: Dimension::Three,
        params: &[number(
            "radius",
            Unit::Length,
            &[1.0],
            SMALL,
            LARGE,
            "Distance from the centre to the surface.",
        )],
    };
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        p.length() - a.get(0)
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0]; 3])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        x * x + y * y + z * z <= a[0] * a[0]
    }
}

/// A box with sharp edges.
pub struct Cuboid;
impl Primitive for Cuboid {
    const INFO: Info = Info {
        name: "box",
        doc: "A box around the origin.",
        source: "Tomczak 2012, algorithm 3.6",
        group: "Solids",
        dimension: Dimension::Three,
        params: &[vec3(
            "size",
            Unit::Length,
            &[1.0, 1.0, 1.0],
            SMALL,
            LARGE,
            "Full sides along x, y and z.",
        )],
    };
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let q = Vec3 {
            x: p.x.abs() - a.get(0) * 0.5,
            y: p.y.abs() - a.get(1) * 0.5,
            z: p.z.abs() - a.get(2) * 0.5,
        };
        corner([q.x, q.y, q.z])
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0] * 0.5, a[1] * 0.5, a[2] * 0.5])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        (0..3).all(|k| p[k].abs() <= a[k] * 0.5)
    }
}

/// The half space below `y = 0`.
pub struct Plane;
impl Primitive for Plane {
    const INFO: Info = Info {
        name: "plane",
        doc: "The half space below y = 0: a floor.",
        source: "",
        group: "Solids",
        dimension: Dimension::Three,
        params: &[],
    };
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
