//! Displacement: a function of the place is taken from the field's value, and the slopes add up.

use super::noise::{CellularNoise, GradientNoise, Noise, ValueNoise, fbm, fbm_slope};
use super::*;
use std::f64::consts::TAU;
use std::marker::PhantomData;

const AMPLITUDE: Param = number(
    "amplitude",
    Unit::Length,
    &[0.05],
    -LARGE,
    LARGE,
    "How far the surface moves where the pattern is 1; negative moves inwards.",
);

/// Displacement by a product of sines.
pub struct Displace;
impl Modify for Displace {
    const READS_POINT: bool = true;
    const INFO: Info = Info {
        name: "displace",
        doc: "Moves the surface by a product of sines along x, y and z.",
        source: "Quilez 2008",
        group: "Displacement",
        dimension: Dimension::Three,
        params: &[
            AMPLITUDE,
            number(
                "frequency",
                Unit::Frequency,
                &[1.0],
                0.0,
                1e4,
                "Waves per unit of length.",
            ),
        ],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[0.2, 2.0], &[-0.1, 0.5]];
    #[inline(always)]
    fn modify<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        let q = p * (a.get(1) * R::Scalar::constant(TAU));
        d - q.x.sin() * q.y.sin() * q.z.sin() * a.get(0)
    }
    /// With A, B and C the squares of the sines, the square of the pattern's slope in radians is
    /// `A B + B C + C A - 3 A B C`, linear in each, so largest at a corner of the cube, where it is at most 1.
    fn lipschitz(a: &[f64], slope: f64) -> f64 {
        slope + a[0].abs() * a[1] * TAU
    }
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        shape(level + a[0].abs())
    }
    fn exactness(shape: Exactness) -> Exactness {
        shape.max(Exactness::Bound)
    }
}

/// A noise as a displacement: its words.
pub trait Roughness: Noise {
    /// Name in the scene language.
    const ENTRY: &'static str;
    /// One line.
    const LINE: &'static str;
    /// Author and year.
    const AFTER: &'static str;
}
impl Roughness for ValueNoise {
    const ENTRY: &'static str = "displace_value";
    const LINE: &'static str = "Moves the surface by value noise: soft, blotchy bumps.";
    const AFTER: &'static str = "Perlin 1985; fractal sum: Musgrave 1993";
}
impl Roughness for GradientNoise {
    const ENTRY: &'static str = "displace_gradient";
    const LINE: &'static str = "Moves the surface by gradient noise: even, natural roughness.";
    const AFTER: &'static str = "Perlin 2002; fractal sum: Musgrave 1993";
}
impl Roughness for CellularNoise {
    const ENTRY: &'static str = "displace_cellular";
    const LINE: &'static str =
        "Moves the surface by cellular noise: dents with ridges between them.";
    const AFTER: &'static str = "Worley 1996; fractal sum: Musgrave 1993";
}

/// Displacement by a fractal sum of noise.
pub struct DisplaceBy<N>(PhantomData<N>);
impl<N: Roughness> Modify for DisplaceBy<N> {
    const READS_POINT: bool = true;
    const INFO: Info = Info {
        name: N::ENTRY,
        doc: N::LINE,
        source: N::AFTER,
        group: "Noise displacement",
        dimension: Dimension::Three,
        params: &[
            AMPLITUDE,
            number(
                "frequency",
                Unit::Frequency,
                &[2.0],
                0.0,
                1e4,
                "Cells of the noise per unit of length.",
            ),
            number(
                "octaves",
                Unit::Count,
                &[1.0],
                1.0,
                16.0,
                "Layers, each finer and weaker than the one before.",
            ),
            number(
                "lacunarity",
                Unit::Ratio,
                &[2.0],
                1.0,
                8.0,
                "How much finer each layer is.",
            ),
            number(
                "gain",
                Unit::Ratio,
                &[0.5],
                0.0,
                1.0,
                "How strong each layer is, beside the one before.",
            ),
        ],
    };
    const SAMPLES: &'static [&'static [f64]] =
        &[&[0.2, 1.0, 4.0, 2.0, 0.5], &[-0.1, 3.0, 2.0, 1.7, 0.8]];
    #[inline(always)]
    fn modify<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        d - fbm::<N, R>(p * a.get(1), a.get(2), a.get(3), a.get(4)) * a.get(0)
    }
    fn lipschitz(a: &[f64], slope: f64) -> f64 {
        slope + a[0].abs() * a[1] * fbm_slope::<N>(a[2], a[3], a[4])
    }
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb {
        let (lo, hi) = N::RANGE;
        shape(level + (a[0] * lo).max(a[0] * hi))
    }
    fn exactness(shape: Exactness) -> Exactness {
        shape.max(Exactness::Bound)
    }
    fn check(a: &[f64]) -> Result<(), String> {
        join_style::whole("octaves", a[2])
    }
}

/// Displacement by value noise.
pub type DisplaceValue = DisplaceBy<ValueNoise>;
/// Displacement by gradient noise.
pub type DisplaceGradient = DisplaceBy<GradientNoise>;
/// Displacement by cellular noise.
pub type DisplaceCellular = DisplaceBy<CellularNoise>;
