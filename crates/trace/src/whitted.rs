//! Reflections, and light through clear bodies: rays that go on, all of them.

use crate::integrator::{Integrator, TileSample, identify, left, light, lose};
use crate::march::ORDINAL;
use crate::paths::PathState;
use crate::ray::WideRay;
use crate::simd::INSIDE;
use crate::tile::Scratch;
use fearless_simd::Simd;
use zeroset_number::v3;
use zeroset_scene::settings::Shading;
use zeroset_shade::surface::{FAINTEST, followed_share, kept_on, mirrored, refraction};

/// As [`Direct`](crate::integrator::Direct), and on: smooth surfaces reflect what rays find there, clear bodies let rays through (Whitted 1980; Keinert et al. 2014,
/// section 4).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Whitted {
    pub(crate) reflections: u32,
    pub(crate) refractions: u32,
}

impl Integrator for Whitted {
    fn integrate<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch) {
        let picture = sample.job.picture;
        identify(s, sample, q);
        let goes_on = picture.goes_on && picture.scene.settings().shading == Shading::Physical;
        if !goes_on {
            q.hits.material.make_opaque(q.hits.count);
            light(s, sample, q);
            return;
        }
        for i in 0..q.hits.count {
            q.hits.followed[i] = self.go_on(sample, q, i);
        }
        light(s, sample, q);
        for i in 0..q.hits.count {
            lose(sample, q, i);
        }
    }
}

impl Whitted {
    /// Sends rays on from hit number `i`. Gives the share of its reflection that they follow.
    fn go_on(&self, sample: &TileSample<'_>, q: &mut Scratch, i: usize) -> f32 {
        let (hits, number) = (&q.hits, (q.hits.word[i] & ORDINAL) as usize);
        let inside = hits.word[i] & INSIDE != 0;
        if !hits.material.goes_on(i) {
            return 0.0;
        }
        let what = hits.material.get(i);
        let clear = what.transmission * (1.0 - what.metallic);
        let smooth = followed_share(what.roughness);
        if clear <= 0.0 && (inside || smooth <= 0.0) {
            return 0.0;
        }
        let state = q.paths.state(number);
        let ray = hits.rays.get(&hits.common, i);
        let (d, n) = (ray.direction, hits.shown(i));
        let face = hits.normal(i);
        let cosine = (-n.dot(d)).clamp(0.0, 1.0);
        let body = sample.job.material(state.medium.unwrap_or(hits.first[i]));
        let weight = state.weight.times(left(sample, q, i));
        let next = WideRay {
            travelled: ray.way(hits.t[i]),
            ..ray
        };
        let mut onward = |direction, side: f32, state: PathState| {
            let bright = state.weight.max_component() >= FAINTEST;
            if bright {
                let origin = hits.point(i) + face * (hits.offset[i] * side);
                let direction = match sample.job.picture.has_bumps {
                    true => kept_on(direction, face * side),
                    false => direction,
                };
                let ray = WideRay {
                    origin,
                    direction,
                    ..next
                };
                q.paths.push(ray, state);
            }
            bright
        };
        let mirror = d + n * (2.0 * cosine);
        // what clear bodies reflect, and what goes on behind their surface
        let mut reflected = mirrored(&what, cosine).all * (smooth * (1.0 - clear));
        if inside {
            reflected = reflected * 0.0;
        }
        let (mut reflections, mut refractions) = (state.reflections, state.refractions);
        if inside {
            refractions += 1;
        } else {
            reflections += 1;
        }
        if clear > 0.0 {
            let ior = if inside { 1.0 / body.ior } else { body.ior };
            let border = refraction(d, n, ior);
            reflected = reflected + v3(1.0, 1.0, 1.0) * (clear * border.reflected);
            let through = clear * (1.0 - border.reflected);
            let colour = if inside {
                v3(1.0, 1.0, 1.0)
            } else {
                what.albedo
            };
            if state.refractions < self.refractions {
                let state = PathState {
                    weight: weight.times(colour) * through,
                    refractions: state.refractions + 1,
                    medium: (!inside).then_some(hits.first[i]),
                    ..state
                };
                onward(border.direction, -1.0, state);
            }
        }
        let allowed = reflections <= self.reflections && refractions <= self.refractions;
        let state = PathState {
            weight: weight.times(reflected),
            reflections,
            refractions,
            medium: inside.then_some(state.medium.unwrap_or(hits.first[i])),
            ..state
        };
        // of clear bodies nothing is left to the blurred sky
        if allowed && onward(mirror, 1.0, state) {
            smooth + (1.0 - smooth) * clear
        } else {
            clear
        }
    }
}
