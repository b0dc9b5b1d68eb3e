//! Shadows.

use super::{Plain, Probe, field, glam};
use glam::Vec3;
use zeroset_scene::settings::Shadow;
use zeroset_shade::light::arrival;
use zeroset_shade::secondary::{FIRST, LEAST, STOP};
use zeroset_shade::shadow::{DARK, closest};
use zeroset_shade::skin;
use zeroset_shade::view::ROUNDING;

/// A place on a surface that light falls on.
pub(super) struct Surface {
    pub(super) p: Vec3,
    pub(super) normal: Vec3,
    /// The normal that light meets: with the heights of bumps.
    pub(super) shown: Vec3,
    /// 1, or -1 where it is seen from inside the solid.
    pub(super) side: f32,
    /// How far secondary rays start from it.
    pub(super) offset: f32,
    /// The ray that sees it.
    pub(super) d: Vec3,
}

/// What arrives from all lights.
#[derive(Default)]
pub(super) struct Light {
    pub(super) diffuse: Vec3,
    pub(super) gloss: Vec3,
    pub(super) grazing: Vec3,
    pub(super) shadow: f32,
}

impl Plain<'_> {
    /// Sums up what arrives from the lights.
    pub(super) fn light(&self, probe: &mut impl Probe, at: &Surface, finish: f32) -> Light {
        let (mut sum, mut shares) = (Light::default(), 0.0);
        for light in self.scene.lights() {
            let origin = at.p + at.normal * at.offset;
            let (to, distance) = Self::towards(&light.source, origin);
            let lit = match light.shadow {
                _ if at.normal.dot(to) <= 0.0 => 0.0,
                _ if at.side < 0.0 => 1.0,
                Shadow::None => 1.0,
                Shadow::Hard => self.hard(probe, at, to, distance, |_| 0.0),
                Shadow::Soft { sharpness } => self.soft(probe, at, to, distance, sharpness, false),
                Shadow::SoftClosest { sharpness } => {
                    self.soft(probe, at, to, distance, sharpness, true)
                }
            };
            let (to, distance) = Self::towards(&light.source, at.p);
            let (n, d) = (field(at.shown), field(at.d));
            let got = arrival(
                self.settings.shading,
                light,
                (field(to), distance),
                n,
                d,
                lit,
                finish,
            );
            sum.diffuse += glam(got.diffuse);
            sum.gloss += glam(got.gloss);
            sum.grazing += glam(got.grazing);
            sum.shadow += got.share * lit;
            shares += got.share;
        }
        sum.shadow /= shares.max(1e-20);
        sum
    }

    /// See [`skin::touch`].
    pub(super) fn touch(&self, at: &Surface) -> f32 {
        let p = at.p.abs();
        skin::touch(at.offset, p.x + p.y + p.z)
    }

    /// 1 where nothing is in the way, else what `stopped` makes of the distance (Tomczak 2012, algorithm 3.2).
    pub(super) fn hard(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        to: Vec3,
        distance: f32,
        stopped: impl Fn(f32) -> f32,
    ) -> f32 {
        let origin = at.p + at.normal * at.offset;
        let end = self
            .leave(origin, to, 0.0, at.offset)
            .min(distance)
            .min(self.view.far);
        let stop = if self.quality.fractal {
            at.offset * STOP
        } else {
            -ROUNDING * (at.p.x.abs() + at.p.y.abs() + at.p.z.abs())
        };
        let mut t = at.offset * FIRST;
        for _ in 0..self.quality.max_steps {
            if t >= end {
                break;
            }
            let f = probe.value(origin + to * t);
            if f < stop {
                return stopped(t);
            }
            t += f.max(at.offset * LEAST);
        }
        1.0
    }

    /// The least `sharpness * f / t` (Tomczak 2012, algorithm 3.3), or with the closest place between samples (Aaltonen 2018).
    fn soft(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        to: Vec3,
        distance: f32,
        sharpness: f32,
        aaltonen: bool,
    ) -> f32 {
        let origin = at.p + at.normal * at.offset;
        let end = self
            .leave(origin, to, 1.0 / sharpness, at.offset)
            .min(distance)
            .min(self.view.far);
        let (mut t, mut light) = (at.offset * FIRST, 1.0f32);
        let mut last: Option<f32> = None;
        let least = if self.quality.skins {
            self.touch(at)
        } else {
            at.offset * LEAST
        };
        for _ in 0..self.quality.max_steps {
            if t >= end {
                break;
            }
            let f = probe.value(origin + to * t);
            let (y, d) = match last {
                Some(r) if aaltonen && self.quality.close && f >= 0.0 => closest(f, r, r),
                _ => (0.0, self.distance(probe, origin + to * t)),
            };
            light = light.min(sharpness * d / (t - y).max(1e-20));
            if light < DARK {
                let mut along = |t: f32| probe.value(origin + to * t);
                let passes = self.quality.skins && passes(&mut along, t, end, self.touch(at));
                return f32::from(passes);
            }
            last = Some(f);
            t += f.max(least);
        }
        light
    }
}

/// Whether a ray that came near something at `t` touches it there and gets through all the same, and on to `end`: it was
/// a skin.
pub(super) fn passes(f: &mut impl FnMut(f32) -> f32, mut t: f32, end: f32, touch: f32) -> bool {
    let (mut last, mut touched) = (f32::INFINITY, false);
    for _ in 0..10_000 {
        let value = f(t);
        if value < touch * skin::BEHIND || (!touched && value >= touch && value > last) {
            return false;
        }
        touched |= value < touch;
        last = value;
        t += value.max(touch);
        if t >= end {
            break;
        }
    }
    touched
}
