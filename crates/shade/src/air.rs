//! What is between things, and before the sky: fog, and the sun behind it.

use crate::light::disc_power;
use crate::sky::{self, SkyColours};
use crate::{each, parameters};
use zeroset_number::{Real, Vec3};
use zeroset_scene::light::{Light, Sky, Source};

/// The numbers of the air.
#[derive(Clone, Copy, Debug)]
pub struct Air<C> {
    /// The direction of the sun.
    pub sun: Vec3<C>,
    /// What a white surface shows that faces it.
    pub radiance: Vec3<C>,
    /// The cosine of half the angle under which it is seen; above 1 where it is not shown.
    pub cosine: C,
    /// The colour of fog that the sun does not shine on.
    pub fog: Vec3<C>,
    /// The share of light that fog takes over a scene unit, at the height 0.
    pub density: C,
    /// By what power it grows thinner over a scene unit upwards.
    pub falloff: C,
    /// How much the fog shows of the sun.
    pub glow: C,
}

/// How many times as bright as a white surface that faces the sun its disc is, at most: more than any screen shows.
const BRIGHTEST: f32 = 20.0;

/// How strongly fog scatters forwards: the mean cosine (Henyey and Greenstein 1941).
const FORWARDS: f32 = 0.7;

/// What stands for no end: rays that meet nothing.
pub const ENDLESS: f32 = 1e15;

impl Air<f32> {
    /// That of a scene. The sun is the first light from far away.
    pub fn of(sky: &Sky, lights: &[Light]) -> Self {
        let sun = lights.iter().find_map(|light| match light.source {
            Source::Directional { direction } => Some((-direction, light.radiance)),
            _ => None,
        });
        let (sun, radiance) = sun.unwrap_or((glam::Vec3::Y, glam::Vec3::ZERO));
        let shown = sky.sun > 0.0 && radiance != glam::Vec3::ZERO;
        let fog = sky.fog.unwrap_or_default();
        let falloff = fog.height.map_or(0.0, |height| 1.0 / height);
        // what is stated at the base, at the height 0
        let up = (fog.base * falloff).clamp(-STEEPEST, STEEPEST).exp();
        Air {
            sun: parameters(sun),
            radiance: parameters(radiance),
            cosine: if shown { (0.5 * sky.sun).cos() } else { 2.0 },
            fog: parameters(fog.colour.unwrap_or(sky.horizon)),
            density: if sky.fog.is_some() {
                fog.density * up
            } else {
                0.0
            },
            falloff,
            glow: fog.glow,
        }
    }

    /// Whether there is any fog.
    pub fn is_foggy(&self) -> bool {
        self.density > 0.0
    }
}

/// Exponents are no larger: their powers stay finite.
const STEEPEST: f32 = 60.0;
/// Densities are no larger: nothing is seen through a thousandth of that.
const LARGEST: f32 = 1e20;

/// The share of light that fog takes on the way `t` from the height `y`, which goes up by `rise` over a scene unit.
#[inline(always)]
pub fn share<R: Real>(density: R::Scalar, falloff: R::Scalar, y: R, rise: R, t: R) -> R {
    // the integral of density e^(-falloff (y + rise s)) over the way: (1 - e^-k) / k of its start, with k = falloff rise t
    let here = (y * falloff * -1.0).clamp(-STEEPEST, STEEPEST).exp() * density;
    let k = (rise * t * falloff).clamp(-STEEPEST, ENDLESS);
    let flat = k.abs().below(1e-3);
    let safe = R::select(flat, k.lit(1.0), k);
    let mean = R::select(
        flat,
        (k * -0.5) + 1.0,
        (-(safe.min(STEEPEST))).exp().one_minus() / safe,
    );
    // not infinite: a way without a length would make no number of it
    let taken = (here.min(LARGEST) * mean).min(LARGEST) * t;
    (-taken).exp().one_minus()
}

/// The light that fog sends along a ray of direction `d`, where nothing is seen through it: its own colour, and what it scatters of the
/// sun's, most in its direction.
#[inline(always)]
pub fn scattered<R: Real>(
    fog: Vec3<R::Scalar>,
    sun: Vec3<R::Scalar>,
    radiance: Vec3<R::Scalar>,
    glow: R::Scalar,
    d: Vec3<R>,
) -> Vec3<R> {
    let g = FORWARDS;
    let cosine = d.dot(d.like(sun)).clamp(-1.0, 1.0);
    let base = (cosine * (-2.0 * g) + (1.0 + g * g)).max(1e-6);
    // one everywhere, if it were not for g
    let phase = (base * base.sqrt()).recip() * (1.0 - g * g) * glow;
    let (fog, radiance) = (fog.array(), radiance.array());
    each(
        #[inline(always)]
        |k| phase * radiance[k] * 0.25 + fog[k],
    )
}

/// The sun's disc along a direction.
#[inline(always)]
pub fn disc<R: Real>(
    sun: Vec3<R::Scalar>,
    radiance: Vec3<R::Scalar>,
    cosine: R::Scalar,
    d: Vec3<R>,
) -> Vec3<R> {
    let zero = d.x.lit(0.0);
    let power = disc_power(zero.like(cosine)).min(BRIGHTEST);
    let along = d.dot(d.like(sun));
    let shown = R::choose(along.above(cosine), power, zero);
    let radiance = radiance.array();
    each(
        #[inline(always)]
        |k| shown * radiance[k],
    )
}

/// What is seen of a colour behind the way `t` through the air from the height `y`, along a ray of direction `d`.
#[inline(always)]
pub fn through<R: Real>(air: &Air<R::Scalar>, colour: Vec3<R>, y: R, d: Vec3<R>, t: R) -> Vec3<R> {
    let share = share(air.density, air.falloff, y, d.y, t);
    let fog = scattered(air.fog, air.sun, air.radiance, air.glow, d);
    colour * share.one_minus() + fog * share
}

/// What a ray sees that meets nothing, from a place of the height `y`; with the disc of the sun where it `looks` from the eye.
#[inline(always)]
pub fn behind<R: Real<Scalar = f32>>(
    colours: &SkyColours<f32>,
    air: &Air<f32>,
    y: R,
    d: Vec3<R>,
    looks: bool,
) -> Vec3<R> {
    before(sky::colour(colours, d.y), air, y, d, looks)
}

/// What a ray sees of a colour that is endlessly far away: see [`behind`].
#[inline(always)]
pub fn before<R: Real<Scalar = f32>>(
    colour: Vec3<R>,
    air: &Air<f32>,
    y: R,
    d: Vec3<R>,
    looks: bool,
) -> Vec3<R> {
    let mut seen = colour;
    if looks && air.cosine <= 1.0 {
        seen = seen + disc(air.sun, air.radiance, air.cosine, d);
    }
    if air.is_foggy() {
        let far = y.lit(ENDLESS);
        seen = through(air, seen, y, d, far);
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_number::v3;

    #[test]
    fn fog_takes_what_the_integral_says() {
        for (density, falloff) in [(0.1f32, 0.0f32), (0.1, 0.5), (2.0, 3.0), (0.01, 0.05)] {
            for (y, rise, t) in [
                (0.0f32, 0.0f32, 10.0f32),
                (1.0, 0.3, 4.0),
                (3.0, -0.9, 2.5),
                (0.5, 1.0, 40.0),
                (0.2, 1e-5, 30.0),
            ] {
                let steps = 20_000;
                let sum: f64 = (0..steps)
                    .map(|i| {
                        let s = (f64::from(i) + 0.5) / f64::from(steps) * f64::from(t);
                        let h = f64::from(y) + f64::from(rise) * s;
                        f64::from(density) * (-f64::from(falloff) * h).exp()
                    })
                    .sum();
                let right = 1.0 - (-sum * f64::from(t) / f64::from(steps)).exp();
                let found = share(density, falloff, y, rise, t);
                assert!(
                    (f64::from(found) - right).abs() < 2e-4,
                    "{density} {falloff} {y} {rise} {t}: {found} instead of {right}"
                );
            }
        }
    }

    #[test]
    fn no_fog_is_so_thick_that_it_has_no_number() {
        for density in [0.0f32, 1e-30, 1.0, 1e32, f32::MAX] {
            for falloff in [0.0f32, 1e-9, 1.0, 1e9] {
                for y in [-1e9f32, -1.0, 0.0, 1e9] {
                    for rise in [-1.0f32, -1e-9, 0.0, 1e-9, 1.0] {
                        for t in [0.0f32, 1e-9, 1.0, 1e9, ENDLESS] {
                            let found = share(density, falloff, y, rise, t);
                            assert!(
                                (0.0..=1.0).contains(&found),
                                "{density} {falloff} {y} {rise} {t}: {found}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn fog_has_an_end_upwards_and_none_downwards() {
        assert_eq!(share(0.1f32, 0.0, 1.0, 0.5, ENDLESS), 1.0);
        assert_eq!(share(0.1f32, 0.5, 1.0, -0.5, ENDLESS), 1.0);
        // all that is above: density / (falloff rise)
        let above: f32 = share(0.1f32, 0.5, 0.0, 0.5, ENDLESS);
        assert!((above - (1.0 - (-0.4f32).exp())).abs() < 1e-5, "{above}");
        assert_eq!(share(0.0f32, 0.0, 1.0, 0.5, ENDLESS), 0.0);
    }

    #[test]
    fn what_the_sun_lends_to_fog_is_a_quarter_of_it_in_the_mean() {
        let zero = v3(0.0, 0.0, 0.0f32);
        let (mut sum, steps) = (0.0, 10_000);
        for i in 0..steps {
            let z = (i as f32 + 0.5) / steps as f32 * 2.0 - 1.0;
            let d = v3((1.0 - z * z).sqrt(), z, 0.0);
            sum += scattered(zero, v3(0.0, 1.0, 0.0), v3(1.0, 1.0, 1.0), 1.0, d).x / steps as f32;
        }
        assert!((sum - 0.25).abs() < 1e-3, "{sum}");
    }
}
