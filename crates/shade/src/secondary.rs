//! Rays and cones from surfaces, apart from their loops.
//!
//! Such a ray needs samples only where they can darken it. Between two samples `z` apart with the radii `r` and `f` the
//! field is nowhere below `(r + f - z) / 2`; where even that is no penumbra, the step was free to be longer than `r`. The
//! step that just meets this, for a field that goes on with the slope `m`, is `2 (r - w t) / (1 - m + 2 w)` with the width
//! `w` of the penumbra, or of the cone, that still matters. For hard shadows `w` is zero and this is the step of
//! [`crate::march::slope_step`].

use crate::march::Rough;

/// Smoothing of the slope along a ray.
pub const SMOOTHING: f32 = 0.3;
/// Share of the step that would just do: guesses are not exact, and a step that was too long is an evaluation lost.
pub const SHARE: f32 = 0.95;
/// Steeper slopes count as this.
pub const STEEPEST: f32 = 0.98;
/// A ray's first sample is this many offsets from its origin.
pub const FIRST: f32 = 2.0;
/// A value of an estimate below this many offsets stops a ray that has no penumbra; any other field must change its sign.
pub const STOP: f32 = 0.125;
/// Steps are at least this many offsets long; where there are skins, no longer than what touches one.
pub const LEAST: f32 = 1.0 / 32.0;

/// The step from a sample of radius `r` at `t` for a field that goes on with the slope, where what is narrower than `wide t`
/// does not matter.
#[inline(always)]
pub fn reach<R: Rough>(r: R, t: R, slope: R, wide: R) -> R {
    (r - wide * t) * (2.0 * SHARE) * (slope.one_minus() + wide * 2.0).rough_recip()
}
