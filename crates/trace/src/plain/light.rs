//! Shadows and occlusion.

use super::{Plain, Probe, field, glam};
use crate::ao::{CONE_COSINES, CONE_RATIO, CONE_TANGENT, EVANS, UP, cone_directions, turn};
use crate::beam::{FIRST, LEAST, STOP};
use crate::sampling::{cosine_direction, point};
use crate::shade::arrival;
use crate::shadow::{DARK, closest};
use glam::Vec3;
use zeroset_scene::settings::{Occlusion, Shadow};
use zeroset_scene::view::ROUNDING;

/// A place on a surface that light falls on.
pub(super) struct Surface {
    pub(super) p: Vec3,
    pub(super) normal: Vec3,
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
    pub(super) shadow: f32,
}

impl Plain<'_> {
    /// Sums up what arrives from the lights.
    pub(super) fn light(&self, probe: &mut impl Probe, at: &Surface, shininess: f32) -> Light {
        let (mut sum, mut shares) = (Light::default(), 0.0);
        for light in &self.scene.lights {
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
            let (n, d) = (field(at.normal), field(at.d));
            let got = arrival(
                self.settings.shading,
                light,
                (field(to), distance),
                n,
                d,
                lit,
                shininess,
            );
            sum.diffuse += glam(got.diffuse);
            sum.gloss += glam(got.gloss);
            sum.shadow += got.share * lit;
            shares += got.share;
        }
        sum.shadow /= shares.max(1e-20);
        sum
    }

    /// 1 where nothing is in the way, else what `stopped` makes of the distance (Tomczak 2012, algorithm 3.2).
    fn hard(
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
                return 0.0;
            }
            last = Some(f);
            t += f.max(at.offset * LEAST);
        }
        light
    }

    /// Ambient visibility and the bent normal.
    pub(super) fn occlusion(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        object: f32,
        key: [u32; 2],
    ) -> (f32, Vec3) {
        let chosen = self
            .scene
            .objects
            .get(object.max(0.0) as usize)
            .and_then(|o| o.occlusion);
        let up = Vec3::from(UP);
        let mut f = |p: Vec3| self.distance(probe, p);
        let open = match chosen.unwrap_or(self.settings.occlusion) {
            Occlusion::None => 1.0,
            Occlusion::Quilez { steps, step, scale } => {
                let part = |k: u32| {
                    let far = k as f32 * step;
                    0.5f32.powi(k as i32) * (far - f(at.p + at.normal * far))
                };
                1.0 - (scale * (1..=steps).map(part).sum::<f32>()).clamp(0.0, 1.0)
            }
            Occlusion::Bent {
                steps,
                step,
                scale,
                bend,
            } => {
                let (mut n, mut sum) = (at.normal, 0.0);
                for k in 1..=steps {
                    let far = k as f32 * step;
                    sum += 1.1f32.powi(-(k as i32)) * (n.length() * far - f(at.p + n * far));
                    n += up * bend;
                }
                1.0 - (scale * sum).clamp(0.0, 1.0)
            }
            Occlusion::Evans { scale, step, bend } => {
                let n = at.normal + up * bend;
                let part = |(k, weight): (usize, &f32)| {
                    let far = step * (1 << k) as f32;
                    weight * (far - f(at.p + n * far))
                };
                (-scale * EVANS.iter().enumerate().map(part).sum::<f32>())
                    .min(0.0)
                    .exp()
            }
            Occlusion::Upward { scale } => {
                1.0 - (scale * (1.0 - at.normal.dot(up))).clamp(0.0, 1.0)
            }
            Occlusion::Cones { reach, steps } => return cones(&mut f, at, reach, steps),
            Occlusion::Hemisphere { rays, reach } => {
                self.hemisphere(probe, at, rays, reach, key, |_| 0.0)
            }
            Occlusion::Obscurance { rays, reach, tau } => {
                self.hemisphere(probe, at, rays, reach, key, |t| 1.0 - (-tau * t).exp())
            }
        };
        (open, at.normal)
    }

    fn hemisphere(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        rays: u32,
        reach: f32,
        key: [u32; 2],
        stopped: impl Fn(f32) -> f32 + Copy,
    ) -> f32 {
        let mut sum = 0.0;
        for i in 0..rays {
            let [u, v] = point(i, key);
            let to = glam(cosine_direction(field(at.normal), u, v));
            if at.normal.dot(to) > 0.0 {
                sum += self.hard(probe, at, to, reach, stopped);
            }
        }
        sum / rays.max(1) as f32
    }
}

fn cones(f: &mut impl FnMut(Vec3) -> f32, at: &Surface, reach: f32, steps: u32) -> (f32, Vec3) {
    let origin = at.p + at.normal * at.offset;
    let (mut open, mut bent, mut total) = (0.0, Vec3::ZERO, 0.0);
    for (w, cosine) in cone_directions().into_iter().zip(CONE_COSINES) {
        let to = glam(turn(field(at.normal), w));
        let (mut least, mut t) = (1.0f32, reach);
        for _ in 0..steps {
            least = least.min((f(origin + to * t) / (t * CONE_TANGENT.min(cosine))).max(0.0));
            t *= CONE_RATIO;
        }
        open += least * cosine;
        bent += to * (least * cosine);
        total += cosine;
    }
    (
        open / total,
        (bent + at.normal * 1e-3).normalize_or(at.normal),
    )
}
