//! Regular solids by the generalised distance functions of Akleman and Chen (1999): one exponent goes from a ball to the
//! sharp solid.
//!
//! With the unit normals n of the faces, N(p) = (sum |n . p|^k)^(1/k) is a norm, and the solid is N(p) <= radius. Its largest
//! slope is the largest N of a unit vector. The sums of |n . u|^2 and of |n . u|^4 over the normals of each solid have known
//! largest values S2 and S4 over all u, and log-convexity in the exponent gives S2^((4 - k) / 2) S4^((k - 2) / 2) for the sum
//! of |n . u|^k with k in [2, 4], and S4 beyond (no |n . u| is larger than 1).

use super::polyhedron::signed_shifts;
use super::*;

const RADIUS: Param = size(
    "radius",
    &[0.8],
    "Distance from the centre to the faces of the sharp solid.",
);
const EXPONENT: Param = number(
    "exponent",
    Unit::Ratio,
    &[9.0],
    2.0,
    64.0,
    "2 is a ball; the higher, the sharper the edges.",
);
const SOURCE: &str = "Akleman and Chen 1999";

/// A family of faces: unit normals, one of each opposite pair.
struct Family<const N: usize> {
    normals: [[f64; 3]; N],
    /// Largest sum of the fourth powers of the products with a unit vector.
    fourth: f64,
    /// How far the sharp solid of radius 1 reaches along the axes.
    reach: f64,
}

impl<const N: usize> Family<N> {
    #[inline(always)]
    fn distance<R: Real>(&self, p: Vec3<R>, a: Args<'_, R>) -> R {
        let exponent = a.get(1);
        let mut products = [p.x; N];
        let mut largest = p.x.lit(1e-30);
        for k in 0..N {
            products[k] = dot(p, self.normals[k]).abs();
            largest = largest.max(products[k]);
        }
        // Relative to the largest, so that no power overflows.
        let mut sum = p.x.lit(0.0);
        for product in products {
            sum = sum + (product / largest).max(1e-9).powf(exponent);
        }
        largest * sum.max(1.0).powf(exponent.recip()) - a.get(0)
    }

    fn lipschitz(&self, a: &[f64]) -> f64 {
        let (k, second) = (a[1], N as f64 / 3.0);
        let sum = if k < 4.0 {
            second.powf((4.0 - k) / 2.0) * self.fourth.powf((k - 2.0) / 2.0)
        } else {
            self.fourth
        };
        sum.powf(1.0 / k)
    }

    fn bounds(&self, a: &[f64]) -> Aabb {
        // In the sharp solid; and in a ball, as the mean of the k-th powers is at least the k-th power of the mean square.
        let ball = 3_f64.sqrt() * (N as f64).powf(-1.0 / a[1]);
        Aabb::centred([a[0] * self.reach.min(ball); 3])
    }
}

/// Whether the sum over all `normals` (of any length; each direction `times` over) stays below radius to the exponent.
fn contains(normals: impl Iterator<Item = [f64; 3]>, times: f64, a: &[f64], p: [f64; 3]) -> bool {
    let sum: f64 = normals
        .map(|n| {
            let len = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            ((0..3).map(|k| n[k] * p[k]).sum::<f64>() / (len * a[0]))
                .abs()
                .powf(a[1])
        })
        .sum();
    sum <= times
}

const SAMPLES: &[&[f64]] = &[&[1.0, 2.0], &[1.0, 3.0], &[0.5, 24.0]];
/// 1 / sqrt(3).
const T: f64 = 0.577_350_269_189_625_8;
/// (0, 1, phi), of length 1.
const U: f64 = 0.525_731_112_119_133_6;
const V: f64 = 0.850_650_808_352_039_9;
/// (0, 1 / phi, phi), of length 1.
const P: f64 = 0.356_822_089_773_089_9;
const Q: f64 = 0.934_172_358_962_715_7;

macro_rules! generalised {
    ($(#[$doc:meta] $entry:ident $name:literal, $says:literal, $count:literal, $family:expr, $normals:expr, $times:literal;)*) => {$(
        #[$doc]
        pub struct $entry;
        impl $entry {
            const FAMILY: Family<$count> = $family;
        }
        impl Primitive for $entry {
            const INFO: Info = solid("Polyhedra", $name, $says, SOURCE, &[RADIUS, EXPONENT]);
            const EXACTNESS: Exactness = Exactness::Bound;
            const SAMPLES: &'static [&'static [f64]] = SAMPLES;
            #[inline(always)]
            fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
                Self::FAMILY.distance(p, a)
            }
            fn bounds(a: &[f64]) -> Aabb {
                Self::FAMILY.bounds(a)
            }
            fn level_bounds(a: &[f64], level: f64) -> Aabb {
                Self::FAMILY.bounds(&[a[0] + level, a[1]])
            }
            fn lipschitz(a: &[f64]) -> f64 {
                Self::FAMILY.lipschitz(a)
            }
            fn contains(a: &[f64], p: [f64; 3]) -> bool {
                contains($normals, $times, a, p)
            }
        }
    )*};
}
generalised! {
    /// From a ball to the octahedron.
    GeneralisedOctahedron "generalised_octahedron", "Between a ball and an octahedron.", 4,
    Family {
        normals: [[T, T, T], [-T, T, T], [T, -T, T], [T, T, -T]],
        fourth: 28.0 / 27.0,
        reach: 1.732_050_807_568_877_3,
    },
    signed_shifts([1.0; 3]), 6.0;
    /// From a ball to the dodecahedron.
    GeneralisedDodecahedron "generalised_dodecahedron", "Between a ball and a dodecahedron.", 6,
    Family {
        normals: [[0.0, V, U], [0.0, V, -U], [U, 0.0, V], [-U, 0.0, V], [V, U, 0.0], [V, -U, 0.0]],
        fourth: 1.2,
        reach: 1.175_570_504_584_946_4,
    },
    signed_shifts([0.0, V, U]), 4.0;
    /// From a ball to the icosahedron.
    GeneralisedIcosahedron "generalised_icosahedron", "Between a ball and an icosahedron.", 10,
    Family {
        normals: [
            [T, T, T], [-T, T, T], [T, -T, T], [T, T, -T],
            [0.0, P, Q], [0.0, P, -Q], [Q, 0.0, P], [-Q, 0.0, P], [P, Q, 0.0], [P, -Q, 0.0],
        ],
        fourth: 2.0,
        reach: 1.070_466_269_319_267,
    },
    // Every normal of the first kind comes 6 times in a list, of the second 4 times.
    [[1.0; 3], [1.0; 3], [0.0, P, Q], [0.0, P, Q], [0.0, P, Q]].into_iter().flat_map(signed_shifts), 12.0;
}
