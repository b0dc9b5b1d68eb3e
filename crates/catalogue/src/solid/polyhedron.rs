//! The regular solids and the pyramid.
//!
//! A regular solid looks the same from every chamber of its mirrors, so the point is mirrored into one. There only one face
//! is near, and the distance to it follows from three products: over the face, past its edge, and past the end of that edge.

use super::*;

const RADIUS: Param = size("radius", &[1.0], "Distance from the centre to the corners.");

/// What is seen of a regular solid of radius 1 in the chamber of its mirrors.
struct Chamber {
    /// Unit normal of the face.
    face: [f64; 3],
    /// Unit vector in the face, from its centre towards the middle of its edge.
    edge: [f64; 3],
    /// Unit vector along the edge, towards the corner.
    corner: [f64; 3],
    /// Distance from the centre to the face.
    inradius: f64,
    /// Distance from the centre of the face to its edge.
    apothem: f64,
    /// Half the length of the edge.
    half_edge: f64,
}

const SQRT_1_2: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// 1 / sqrt(3).
const SQRT_1_3: f64 = 0.577_350_269_189_625_8;
/// 1 / sqrt(6).
const SQRT_1_6: f64 = 0.408_248_290_463_863;
/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;

impl Chamber {
    /// The distance of a point in the chamber. Within the chamber no other face, edge or corner is nearer.
    #[inline(always)]
    fn distance<R: Real>(&self, p: Vec3<R>, radius: R::Scalar) -> R {
        let over = dot(p, self.face) - radius * R::constant(self.inradius);
        let past_edge = dot(p, self.edge) - radius * R::constant(self.apothem);
        let past_corner = dot(p, self.corner) - radius * R::constant(self.half_edge);
        face(over, [past_edge, past_corner])
    }
}

/// The coordinates by size, largest first.
#[inline(always)]
fn sorted<R: Real>(p: Vec3<R>) -> Vec3<R> {
    let (a, b) = ordered(p.x, p.y);
    let (b, c) = ordered(b, p.z);
    let (a, b) = ordered(a, b);
    v3(a, b, c)
}

/// Whether `p` is below every plane with one of the `normals` (of any length) at `inradius` from the centre.
fn below_all(normals: impl IntoIterator<Item = [f64; 3]>, inradius: f64, p: [f64; 3]) -> bool {
    normals.into_iter().all(|n| {
        let product: f64 = (0..3).map(|k| n[k] * p[k]).sum();
        product <= inradius * n.iter().map(|x| x * x).sum::<f64>().sqrt()
    })
}

/// All sign changes of the cyclic shifts of a vector.
pub(super) fn signed_shifts(v: [f64; 3]) -> impl Iterator<Item = [f64; 3]> {
    (0..24).map(move |i| {
        std::array::from_fn(|k| {
            if i >> k & 1 == 0 {
                v[(k + i / 8) % 3]
            } else {
                -v[(k + i / 8) % 3]
            }
        })
    })
}

/// Eight triangles.
pub struct Octahedron;
impl Primitive for Octahedron {
    const INFO: Info = solid(
        "Polyhedra",
        "octahedron",
        "Eight triangles, corners on the axes.",
        "",
        &[RADIUS],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        const CHAMBER: Chamber = Chamber {
            face: [SQRT_1_3; 3],
            edge: [SQRT_1_6, SQRT_1_6, -2.0 * SQRT_1_6],
            corner: [SQRT_1_2, -SQRT_1_2, 0.0],
            inradius: SQRT_1_3,
            apothem: SQRT_1_6,
            half_edge: SQRT_1_2,
        };
        CHAMBER.distance(sorted(p.abs()), a.get(0))
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0]; 3])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        x.abs() + y.abs() + z.abs() <= a[0]
    }
}

/// Four triangles.
pub struct Tetrahedron;

/// The directions of its corners, upright: one up, one towards z.
fn tetrahedron_corners() -> [[f64; 3]; 4] {
    let (s, c) = (8_f64.sqrt() / 3.0, 1.0 / 3.0);
    let side = s * 0.75_f64.sqrt();
    [
        [0.0, 1.0, 0.0],
        [0.0, -c, s],
        [side, -c, -0.5 * s],
        [-side, -c, -0.5 * s],
    ]
}

impl Primitive for Tetrahedron {
    const INFO: Info = solid(
        "Polyhedra",
        "tetrahedron",
        "Four triangles, one corner up and one towards z.",
        "",
        &[RADIUS],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        // With corners at (1, 1, 1), (-1, -1, 1), (1, -1, -1) and (-1, 1, -1).
        const CHAMBER: Chamber = Chamber {
            face: [SQRT_1_3, SQRT_1_3, -SQRT_1_3],
            edge: [2.0 * SQRT_1_6, -SQRT_1_6, SQRT_1_6],
            corner: [0.0, SQRT_1_2, SQRT_1_2],
            inradius: 1.0 / 3.0,
            apothem: 2.0 * SQRT_1_2 / 3.0,
            half_edge: 2.0 * SQRT_1_6,
        };
        let p = v3(
            dot(p, [SQRT_1_2, SQRT_1_3, -SQRT_1_6]),
            dot(p, [-SQRT_1_2, SQRT_1_3, -SQRT_1_6]),
            dot(p, [0.0, SQRT_1_3, 2.0 * SQRT_1_6]),
        );
        // Its mirrors sort the coordinates and change two signs at once.
        let q = sorted(p.abs());
        let odd = differ(differ(p.x.negative(), p.y.negative()), p.z.negative());
        CHAMBER.distance(v3(q.x, q.y, R::select(odd, -q.z, q.z)), a.get(0))
    }
    fn bounds(a: &[f64]) -> Aabb {
        hull_of(&tetrahedron_corners().map(|c| c.map(|x| x * a[0])), 0.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        below_all(tetrahedron_corners().map(|c| c.map(|x| -x)), a[0] / 3.0, p)
    }
}

/// Mirrors into the chamber of the icosahedron whose corners are (0, 1, phi) and its like: the one around
/// (1/phi, 1, phi) / 2 between (1, 1, 1) / sqrt(3) and (0, phi, 1) / |(0, phi, 1)|.
#[inline(always)]
fn icosahedral_chamber<R: Real>(p: Vec3<R>) -> Vec3<R> {
    const A: [f64; 3] = [-0.5, PHI / 2.0, (1.0 - PHI) / 2.0];
    const B: [f64; 3] = [(1.0 - PHI) / 2.0, -0.5, PHI / 2.0];
    const C: [f64; 3] = [PHI / 2.0, (PHI - 1.0) / 2.0, -0.5];
    let mut p = p.abs();
    for n in [A, B, A, C, B] {
        let m = dot(p, n).min(0.0) * 2.0;
        p = v3(
            p.x - m * R::constant(n[0]),
            p.y - m * R::constant(n[1]),
            p.z - m * R::constant(n[2]),
        );
    }
    p
}

/// Distance from the centre to a face of the dodecahedron and of the icosahedron of radius 1: both have the same.
const INRADIUS: f64 = 0.794_654_472_291_766_1;

/// Twelve pentagons.
pub struct Dodecahedron;
impl Primitive for Dodecahedron {
    const INFO: Info = solid(
        "Polyhedra",
        "dodecahedron",
        "Twelve pentagons, six edges facing the axes.",
        "",
        &[RADIUS],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        const CHAMBER: Chamber = Chamber {
            face: [0.0, 0.850_650_808_352_039_9, 0.525_731_112_119_133_6],
            edge: [
                0.587_785_252_292_473_1,
                -0.425_325_404_176_02,
                0.688_190_960_235_586_8,
            ],
            corner: [0.809_016_994_374_947_5, 0.309_016_994_374_947_4, -0.5],
            inradius: INRADIUS,
            apothem: 0.491_123_473_188_423,
            half_edge: 0.356_822_089_773_09,
        };
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| CHAMBER.distance(icosahedral_chamber(p), a.get(0)),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0] * PHI * SQRT_1_3; 3])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        below_all(signed_shifts([0.0, PHI, 1.0]), INRADIUS * a[0], p)
    }
}

/// Twenty triangles.
pub struct Icosahedron;
impl Primitive for Icosahedron {
    const INFO: Info = solid(
        "Polyhedra",
        "icosahedron",
        "Twenty triangles, six edges facing the axes.",
        "",
        &[RADIUS],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        const CHAMBER: Chamber = Chamber {
            face: [SQRT_1_3; 3],
            edge: [
                -0.645_497_224_367_903,
                -0.110_264_089_708_268_2,
                0.755_761_314_076_170_9,
            ],
            corner: [-0.5, 0.809_016_994_374_947_5, -0.309_016_994_374_947_4],
            inradius: INRADIUS,
            apothem: 0.303_530_999_103_342_9,
            half_edge: 0.525_731_112_119_133_6,
        };
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| CHAMBER.distance(icosahedral_chamber(p), a.get(0)),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0] * 0.850_650_808_352_039_9; 3])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // Its faces are where the dodecahedron has its corners.
        let normals = signed_shifts([1.0; 3]).chain(signed_shifts([0.0, PHI - 1.0, PHI]));
        below_all(normals, INRADIUS * a[0], p)
    }
}

/// A square and four triangles.
pub struct Pyramid;
impl Primitive for Pyramid {
    const INFO: Info = solid(
        "Polyhedra",
        "pyramid",
        "A pyramid that stands on a square.",
        "",
        &[
            size("base", &[1.2], "Full side of the square."),
            size("height", &[1.0], "From the square to the tip."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.3], &[0.3, 2.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (half, height) = (a.get(0) * 0.5, a.get(1));
        // Mirrored so that the side that faces x is the nearest.
        let (x, z) = ordered(p.x.abs(), p.z.abs());
        let y = p.y + height * 0.5;
        // Over the side, and up along it from the middle of its lower edge.
        let len = (half * half + height * height).sqrt();
        let (s, c) = (half / len, height / len);
        let over = (x - half) * c + y * s;
        let up = y * c - (x - half) * s;
        // The triangle: its lower edge, and its slanted one from (0, half) to (len, 0).
        let edge = (len * len + half * half).sqrt();
        let (tu, tz) = (len / edge, half / edge);
        let past = up * tz + (z - half) * tu;
        let along = up * tu - (z - half) * tz;
        let slanted = length2(past, along - along.clamp(0.0, edge));
        let lower = length2(up, (z - half).max(0.0));
        let in_plane = R::select(
            past.above(0.0) | up.negative(),
            slanted.min(lower),
            up.lit(0.0),
        );
        let side = length2(over, in_plane);
        let square = R::norm([(x - half).max(0.0), (z - half).max(0.0), y]);
        let inside = over.max(-y);
        R::select(inside.above(0.0), side.min(square), inside)
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([0.5 * a[0], 0.5 * a[1], 0.5 * a[0]])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        let t = 0.5 - y / a[1];
        (0.0..=1.0).contains(&t) && 2.0 * x.abs().max(z.abs()) <= a[0] * t
    }
}
