//! Shadows.

use super::{Plain, Probe, Ray, Way, field, glam};
use glam::Vec3;
use zeroset_scene::settings::Shadow;
use zeroset_shade::air::{self, Air};
use zeroset_shade::bsdf::DECISIONS;
use zeroset_shade::lamp::{Lamp, Shape};
use zeroset_shade::light::{arrival, luminance, response};
use zeroset_shade::sampling::{basis, decided, hit_seed, scramble};
use zeroset_shade::secondary::{FIRST, LEAST, STOP};
use zeroset_shade::shadow::{DARK, closest};
use zeroset_shade::skin;
use zeroset_shade::view::ROUNDING;
use zeroset_shade::view::on_disc;

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
    pub(super) fn light(
        &self,
        probe: &mut impl Probe,
        at: &Surface,
        finish: f32,
        way: &Way,
        followed: f32,
    ) -> Light {
        let (mut sum, mut shares) = (Light::default(), 0.0);
        for (light, number) in self.scene.lights().iter().zip(0..) {
            let origin = at.p + at.normal * at.offset;
            if let Some(lamp) = Lamp::of(light) {
                let surfaces = way.reflections + way.refractions;
                let [x, y] = way.pixel;
                let key = scramble(x, y, hit_seed(self.settings.seed, 0));
                let u = decided(way.index, key, surfaces * DECISIONS + 2 + number);
                let (to, distance, falloff) = place_on(&lamp, origin, u);
                let lit = match light.shadow {
                    _ if at.normal.dot(to) <= 0.0 => 0.0,
                    Shadow::None => 1.0,
                    _ if at.side < 0.0 => 1.0,
                    _ => (self.advected(number as usize, at, to, distance))
                        .unwrap_or_else(|| self.hard(probe, at, to, distance, |_| 0.0)),
                };
                let (n, d) = (field(at.shown), field(at.d));
                let answer = response(
                    self.settings.shading,
                    false,
                    (field(to), f32::INFINITY),
                    n,
                    d,
                    finish,
                );
                let seen = if lamp.visible { 1.0 - followed } else { 1.0 };
                let air = Air::of(self.scene.sky(), self.scene.lights());
                let lost = match air.is_foggy() {
                    true => air::share(air.density, air.falloff, origin.y, to.y, distance),
                    false => 0.0,
                };
                let colour = light.radiance * (falloff * (1.0 - lost));
                sum.diffuse += colour * (answer.diffuse * lit);
                sum.gloss += colour * (answer.gloss * lit * seen);
                sum.grazing += colour * (answer.grazing * lit * seen);
                let share = luminance(colour.to_array());
                sum.shadow += share * lit;
                shares += share;
                continue;
            }
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
                Shadow::Advected { .. } => {
                    let left = self.advected(number as usize, at, to, distance);
                    left.unwrap_or(1.0)
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

    /// The light of the lamps that a ray passes before it ends at `t`.
    pub(super) fn glow(&self, probe: &mut impl Probe, ray: &Ray, way: &Way, t: f32) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let lamps = self.scene.lights().iter().filter_map(Lamp::of);
        for lamp in lamps.filter(|lamp| lamp.visible) {
            let Some(at) = met(&lamp, ray.o, ray.d).filter(|at| *at < t) else {
                continue;
            };
            let left = match way.medium {
                Some(medium) => (-self.material(probe, medium).attenuation * at).exp(),
                None => {
                    let air = Air::of(self.scene.sky(), self.scene.lights());
                    let share = match air.is_foggy() {
                        true => air::share(air.density, air.falloff, ray.o.y, ray.d.y, at),
                        false => 0.0,
                    };
                    Vec3::splat(1.0 - share)
                }
            };
            sum += glam(lamp.strength) * (std::f32::consts::PI / lamp.area) * left;
        }
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

/// A place on a lamp as it is seen from `p`, by a point of the unit square: the way there, and what distance leaves.
fn place_on(lamp: &Lamp<f32>, p: Vec3, u: [f32; 2]) -> (Vec3, f32, f32) {
    let (middle, right, up) = (glam(lamp.place), glam(lamp.right), glam(lamp.up));
    let [x, y] = match lamp.shape {
        Shape::Rectangle => [2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0],
        Shape::Disc => on_disc(u),
        Shape::Sphere => {
            let way = middle - p;
            let far = way.length();
            let sine = lamp.radius / far;
            if sine >= 1.0 {
                return (way / far, 0.0, 0.0);
            }
            let most = sine * sine / (1.0 + (1.0 - sine * sine).sqrt());
            let cosine = 1.0 - most * u[0];
            let [a, b] = basis(field(way / far)).map(glam);
            let (sin, cos) = (u[1] * std::f32::consts::TAU).sin_cos();
            let aside = (most * u[0] * (2.0 - most * u[0])).sqrt();
            let to = (a * cos + b * sin) * aside + way / far * cosine;
            let t = met(lamp, p, to).unwrap_or(far * cosine);
            return (to, t, 2.0 * most / (lamp.radius * lamp.radius));
        }
    };
    let way = middle + right * x + up * y - p;
    let (far, front) = (way.length(), right.cross(up).normalize());
    let to = way / far;
    (to, far, (-front.dot(to)).max(0.0) / (far * far))
}

/// How far a ray comes to a lamp, if it meets it from its front.
fn met(lamp: &Lamp<f32>, o: Vec3, d: Vec3) -> Option<f32> {
    let (middle, right, up) = (glam(lamp.place), glam(lamp.right), glam(lamp.up));
    if lamp.shape == Shape::Sphere {
        let (way, square) = (middle - o, lamp.radius * lamp.radius);
        let along = way.dot(d);
        let left = square - (way - d * along).length_squared();
        let t = along - left.max(0.0).sqrt();
        return (left > 0.0 && t > 0.0 && way.length_squared() > square).then_some(t);
    }
    let front = right.cross(up);
    let t = front.dot(middle - o) / front.dot(d);
    let on = o + d * t - middle;
    let (x, y) = (
        on.dot(right) / right.length_squared(),
        on.dot(up) / up.length_squared(),
    );
    let within = match lamp.shape {
        Shape::Rectangle => x.abs() <= 1.0 && y.abs() <= 1.0,
        Shape::Disc | Shape::Sphere => x * x + y * y <= 1.0,
    };
    (front.dot(d) < 0.0 && t > 0.0 && within).then_some(t)
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
