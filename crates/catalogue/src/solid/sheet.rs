//! Flat pieces, thickened by a radius.

use super::*;

const RADIUS: Param = size(
    "radius",
    &[0.05],
    "Half the thickness, and the radius of the edges.",
);

const fn corner_at(name: &'static str, default: &'static [f64; 3], doc: &'static str) -> Param {
    vec3(name, Unit::Length, default, -LARGE, LARGE, doc)
}

/// Distance to the straight line from `a` to `a + edge`, `p` being seen from `a`.
#[inline(always)]
pub(super) fn to_segment<R: Real>(p: Vec3<R>, edge: Vec3<R::Scalar>) -> R {
    let t = (p.dot(edge) / edge.length_squared().max(1e-30)).clamp01();
    R::norm([p.x - t * edge.x, p.y - t * edge.y, p.z - t * edge.z])
}

/// Distance to a triangle.
#[inline(always)]
fn to_triangle<R: Real>(
    p: Vec3<R>,
    a: Vec3<R::Scalar>,
    b: Vec3<R::Scalar>,
    c: Vec3<R::Scalar>,
) -> R {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let normal = ab.cross(ca);
    let (pa, pb, pc) = (p - a, p - b, p - c);
    // Over the inside of all three edges the plane is nearest; a triangle without area (an angle below 1e-5) has no inside.
    let area = normal.length_squared() - ab.length_squared() * ca.length_squared() * 1e-10;
    let within = p.x.like(area).above(0.0)
        & pa.dot(ab.cross(normal)).above(0.0)
        & pb.dot(bc.cross(normal)).above(0.0)
        & pc.dot(ca.cross(normal)).above(0.0);
    let plane = pa.dot(normal / normal.length().max(1e-30)).abs();
    let edges = to_segment(pa, ab).min(to_segment(pb, bc).min(to_segment(pc, ca)));
    R::select(within, plane, edges)
}

/// The point of a triangle that is nearest to `p` (Ericson 2005, section 5.1.5): for the proofs.
fn nearest_of_triangle(p: [f64; 3], a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> [f64; 3] {
    let sub = |u: [f64; 3], v: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| u[k] - v[k]) };
    let dot = |u: [f64; 3], v: [f64; 3]| -> f64 { (0..3).map(|k| u[k] * v[k]).sum() };
    let mix =
        |v: f64, w: f64| std::array::from_fn(|k| a[k] + v * (b[k] - a[k]) + w * (c[k] - a[k]));
    let (ab, ac) = (sub(b, a), sub(c, a));
    let [d1, d2] = [ab, ac].map(|e| dot(e, sub(p, a)));
    let [d3, d4] = [ab, ac].map(|e| dot(e, sub(p, b)));
    let [d5, d6] = [ab, ac].map(|e| dot(e, sub(p, c)));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else if d3 >= 0.0 && d4 <= d3 {
        b
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        mix(d1 / (d1 - d3), 0.0)
    } else if d6 >= 0.0 && d5 <= d6 {
        c
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        mix(0.0, d2 / (d2 - d6))
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        mix(1.0 - w, w)
    } else {
        mix(vb / (va + vb + vc), vc / (va + vb + vc))
    }
}

fn near_triangle(p: [f64; 3], corners: [[f64; 3]; 3], radius: f64) -> bool {
    let q = nearest_of_triangle(p, corners[0], corners[1], corners[2]);
    (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>() <= radius * radius
}

/// A triangle in space.
pub struct TriangleSheet;
impl Primitive for TriangleSheet {
    const INFO: Info = solid(
        "Sheets",
        "triangle_sheet",
        "A triangle in space, thickened.",
        "",
        &[
            corner_at("a", &[-0.8, -0.5, 0.0], "First corner."),
            corner_at("b", &[0.8, -0.5, 0.3], "Second corner."),
            corner_at("c", &[0.0, 0.8, -0.3], "Third corner."),
            RADIUS,
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.1, 0.05, 0.0, 0.1],
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.1],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (u, v, w) = (a.vec3(0), a.vec3(3), a.vec3(6));
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| to_triangle(p, u, v, w),
        ) - a.get(9)
    }
    fn bounds(a: &[f64]) -> Aabb {
        hull_of(&[triple(a, 0), triple(a, 3), triple(a, 6)], a[9])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        near_triangle(p, [triple(a, 0), triple(a, 3), triple(a, 6)], a[9])
    }
}

/// Two triangles in space with a common edge.
pub struct Quad;
impl Primitive for Quad {
    const INFO: Info = solid(
        "Sheets",
        "quad",
        "A quadrilateral in space, thickened; folded from a to c if it is not flat.",
        "",
        &[
            corner_at("a", &[-0.7, -0.6, 0.2], "First corner."),
            corner_at("b", &[0.7, -0.6, 0.2], "Second corner."),
            corner_at("c", &[0.5, 0.7, -0.2], "Third corner."),
            corner_at("d", &[-0.5, 0.7, -0.2], "Fourth corner."),
            RADIUS,
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[&[
        0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.0, 1.0, -0.3, 0.1,
    ]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (s, t, u, v) = (a.vec3(0), a.vec3(3), a.vec3(6), a.vec3(9));
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| to_triangle(p, s, t, u).min(to_triangle(p, s, u, v)),
        ) - a.get(12)
    }
    fn bounds(a: &[f64]) -> Aabb {
        hull_of(
            &[triple(a, 0), triple(a, 3), triple(a, 6), triple(a, 9)],
            a[12],
        )
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let near = |i: usize, j: usize| {
            near_triangle(p, [triple(a, 0), triple(a, i), triple(a, j)], a[12])
        };
        near(3, 6) || near(6, 9)
    }
}
