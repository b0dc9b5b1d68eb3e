//! Prisms: a flat outline, upright.

use super::*;

const HEIGHT: Param = size("height", &[1.0], "Full height.");
/// sqrt(3) / 2.
const S60: f64 = 0.866_025_403_784_438_6;

#[inline(always)]
fn upright<R: Real>(outline: R, y: R, height: R::Scalar) -> R {
    corner([outline, y.abs() - height * 0.5])
}

/// Whether all corners of a convex outline, counterclockwise, see `q` on their left.
fn in_outline(corners: &[[f64; 2]], q: [f64; 2]) -> bool {
    let n = corners.len();
    (0..n).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % n]);
        (b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0]) >= 0.0
    })
}

/// Corners of a regular outline of this radius, the first at `turn` from the x axis.
fn regular(n: usize, radius: f64, turn: f64) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            let (s, c) = (turn + std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
            [radius * c, radius * s]
        })
        .collect()
}

/// A regular hexagon, upright.
pub struct HexagonalPrism;
impl Primitive for HexagonalPrism {
    const INFO: Info = solid(
        "Prisms",
        "hexagonal_prism",
        "An upright prism over a regular hexagon, two corners on the x axis.",
        "",
        &[
            size("radius", &[0.7], "Distance from the axis to the corners."),
            HEIGHT,
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.1]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let radius = a.get(0);
        let (x, z) = (p.x.abs(), p.z.abs());
        // Mirrored so that the edge that faces z is the nearest.
        let m = (x * R::constant(S60) - z * 0.5).max(0.0);
        let (x, z) = (x - m * R::constant(2.0 * S60), z + m);
        let outline = face(z - radius * R::constant(S60), [x.abs() - radius * 0.5]);
        upright(outline, p.y, a.get(1))
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0], 0.5 * a[1], S60 * a[0]])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        2.0 * y.abs() <= a[1] && in_outline(&regular(6, a[0], 0.0), [x, z])
    }
}

/// An equilateral triangle, upright.
pub struct TriangularPrism;
impl Primitive for TriangularPrism {
    const INFO: Info = solid(
        "Prisms",
        "triangular_prism",
        "An upright prism over a regular triangle, one corner on the z axis.",
        "",
        &[
            size("radius", &[0.7], "Distance from the axis to the corners."),
            HEIGHT,
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.1]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let radius = a.get(0);
        let x = p.x.abs();
        // Mirrored so that the edge that faces -z is the nearest.
        let m = (x * 0.5 + p.z * R::constant(S60)).max(0.0);
        let (x, z) = (x - m, p.z - m * R::constant(2.0 * S60));
        let outline = face(-z - radius * 0.5, [x.abs() - radius * R::constant(S60)]);
        upright(outline, p.y, a.get(1))
    }
    fn bounds(a: &[f64]) -> Aabb {
        let (radius, half) = (a[0], 0.5 * a[1]);
        Aabb::new(
            [-S60 * radius, -half, -0.5 * radius],
            [S60 * radius, half, radius],
        )
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        2.0 * y.abs() <= a[1] && in_outline(&regular(3, a[0], std::f64::consts::FRAC_PI_2), [x, z])
    }
}

/// A rhombus, upright.
pub struct RhombicPrism;
impl Primitive for RhombicPrism {
    const INFO: Info = solid(
        "Prisms",
        "rhombic_prism",
        "An upright prism over a rhombus with its diagonals along x and z.",
        "",
        &[
            size("width", &[1.2], "Full diagonal along x."),
            size("depth", &[0.8], "Full diagonal along z."),
            HEIGHT,
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.2, 0.5], &[1.0, 1.0, 0.1]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (w, d) = (a.get(0) * 0.5, a.get(1) * 0.5);
        let len = (w * w + d * d).sqrt();
        let (s, c) = (w / len, d / len);
        // Over the edge from (w, 0) to (0, d), and along it.
        let (x, z) = (p.x.abs() - w, p.z.abs());
        let along = z * c - x * s;
        let past = (along - along.clamp(0.0, len)).abs();
        let outline = face(x * c + z * s, [past]);
        upright(outline, p.y, a.get(2))
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([0.5 * a[0], 0.5 * a[2], 0.5 * a[1]])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        2.0 * y.abs() <= a[2] && 2.0 * (x / a[0]).abs() + 2.0 * (z / a[1]).abs() <= 1.0
    }
}
