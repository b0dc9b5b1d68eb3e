//! What marching is made of but its loops: constants, and the formulas that choose steps.
//!
//! Rays are marched twice, by the CPU over lanes and by the shaders in `stage/march*.wgsl`; both take their numbers from here.

use crate::view::ROUNDING;
use fearless_simd::{Simd, prelude::*};
use zeroset_number::{Expr, Lanes, Real};

/// Numbers whose reciprocal can be had cheaply where it need not be right: a step that is a little off is still tested.
pub trait Rough: Real {
    /// Nearly `1 / self`.
    #[inline(always)]
    fn rough_recip(self) -> Self {
        self.recip()
    }
}

impl Rough for f32 {}

impl Rough for Expr<'_> {}

impl<S: Simd> Rough for Lanes<S> {
    #[inline(always)]
    fn rough_recip(self) -> Self {
        Lanes(self.0.approximate_recip())
    }
}

/// Steeper slopes along the ray count as this: a step is at most a hundred radii long.
pub const STEEPEST: f32 = 0.98;
/// A guess goes this much farther than where the sign should change, so that it does.
pub const GUESS_BEYOND: f32 = 1.1;
/// Guesses are at most this many footprints long.
pub const GUESS_LONGEST: f32 = 64.0;
/// A ray goes towards a surface where the value falls by more than this along it. Where it falls by less, what is behind the
/// surface is that much longer than thick.
pub const TOWARDS: f32 = 0.02;
/// Share of the footprint that a step is at least long. What is thinner may be passed.
pub const LEAST_SHARE: f32 = 1.0 / 16.0;
/// The same for fractals, whose rays end under the footprint.
pub const LEAST_SHARE_OF_FRACTALS: f32 = 0.5;
/// Steps are at least as long as this many roundings.
pub const LEAST_ROUNDINGS: f32 = 4.0;
/// So many from a value below zero farther than rounding reaches.
pub const LEAST_ROUNDINGS_BEHIND: f32 = 16.0 * LEAST_ROUNDINGS;

/// Guesses, at most, of where the sign changes. Most places are found by one or two.
pub const REFINEMENTS: u32 = 24;
/// One guess of so many is the middle: far from straight, false position hardly moves.
pub const MIDDLE: u32 = 3;
/// A guess is right where a straight line leads from it to the surface within this share of the footprint's radius.
pub const SETTLED: f32 = 1.0 / 256.0;

/// How far behind a hit its object is looked for, in parts of what rounding adds: a skin is as near as the solid that lies
/// there, until it is passed.
pub const MARKS_BEHIND: f32 = 4.0;

/// A cone of the prepass ends where its clearance is this share of its radius: with none it would creep up to the surface for
/// ever.
pub const CONE_NEAR: f32 = 0.3;
/// Steps of such a cone at most. Where they run out its rays start a little earlier.
pub const CONE_STEPS: u32 = 64;
/// Smoothing of the slope along such a cone, where the scene does not say.
pub const CONE_SMOOTHING: f32 = 0.3;

/// A value below this is behind the surface, at a place whose coordinates add up to `size`. One closer to zero may have its sign
/// from rounding: it is, where the value at the last place was negative too, for what rounding does is over within the step from
/// there.
#[inline(always)]
pub fn behind<R: Real>(size: R) -> R {
    size * (-0.5 * ROUNDING)
}

/// Where the line through the values at both ends of a part of a ray is zero, as a share of it: false position.
#[inline(always)]
pub fn root<R: Real>(above: R, below: R) -> R {
    let above = above.max(0.0);
    (above / (above - below).max(1e-30)).clamp01()
}

/// The slope of a field along a ray between two values, `z` apart: a distance changes by at most 1 per unit.
#[inline(always)]
pub fn rise<R: Rough>(before: R, after: R, z: R) -> R {
    ((after - before) * z.max(1e-20).rough_recip()).clamp(-1.0, 1.0)
}

/// The slope along a ray, smoothed over its samples by `beta` (Ban and Valasek 2023, algorithm 2), after one of radius `r`, a
/// step of `z` behind one of radius `before`.
#[inline(always)]
pub fn smoothed<R: Rough>(slope: R, before: R, r: R, z: R, beta: R::Scalar) -> R {
    slope.mix(rise(before, r, z), beta).min(STEEPEST)
}

/// The step from a place of radius `r`, for a field that goes on with the slope: to where the next sphere touches this one
/// (Ban and Valasek 2023).
#[inline(always)]
pub fn slope_step<R: Rough>(r: R, slope: R) -> R {
    r * (slope.one_minus().rough_recip() * 2.0).max(1.0)
}

/// The step from a place of radius `r`, `z` behind one of radius `before`, to where the next sphere would touch this one if the
/// surface were a plane: `r + w r (z - r0 + r) / (z + r0 - r)` (Balint and Valasek 2018).
#[inline(always)]
pub fn planar_step<R: Rough>(r: R, before: R, z: R, share: R::Scalar) -> R {
    let ahead = z - before + r;
    let behind = (z + before - r).max(z * (1.0 - STEEPEST)).max(1e-20);
    r + r * (ahead * behind.rough_recip()).max(0.0) * share
}
