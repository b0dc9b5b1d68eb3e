//! Lamps: a place of each is looked for from every surface, and rays may meet them.

use crate::integrator::TileSample;
use crate::job::Job;
use crate::march::ORDINAL;
use crate::path::{AimedLight, Distance, draw, random};
use crate::paths::PathState;
use crate::ray::WideRay;
use crate::secondary::from_hits;
use crate::shadow::{Hard, advected};
use crate::simd::{INSIDE, SLACK, Sheet, TILE_RAYS, load, load3, splat, store, store3};
use crate::tile::Scratch;
use fearless_simd::{Simd, prelude::*};
use zeroset_number::{Vec3, v3};
use zeroset_scene::film::Plane;
use zeroset_scene::settings::{Integrator, Shading, Shadow};
use zeroset_shade::air;
use zeroset_shade::environment::{self, EnvironmentMap};
use zeroset_shade::lamp::{Lamp, balance, density, highlight, likelihood};
use zeroset_shade::light::{luminance_of, response};
use zeroset_shade::parameters;
use zeroset_shade::sky::SkyColours;
use zeroset_shade::surface::{around, transmittance};

/// Where many hits look for a light, a column for each number.
pub(crate) struct AimColumns {
    to: [Vec<f32>; 3],
    distance: Vec<f32>,
    /// What a white surface shows that faces it there.
    pub(crate) light: [Box<Sheet>; 3],
    /// How much the light counts by the cosine law, and in highlights.
    diffuse: Box<Sheet>,
    gloss: Box<Sheet>,
}

impl AimColumns {
    pub(crate) fn new() -> AimColumns {
        let sheet3 = || [Sheet::boxed(), Sheet::boxed(), Sheet::boxed()];
        AimColumns {
            to: std::array::from_fn(|_| vec![0.0; TILE_RAYS + SLACK]),
            distance: vec![0.0; TILE_RAYS + SLACK],
            light: sheet3(),
            diffuse: Sheet::boxed(),
            gloss: Sheet::boxed(),
        }
    }

    /// Hit number `i` looks along `to`, as far as `distance`, for this light.
    fn set(&mut self, i: usize, to: Vec3<f32>, distance: f32, light: Vec3<f32>, counts: [f32; 2]) {
        for (column, x) in self.to.iter_mut().zip(to.array()) {
            column[i] = x;
        }
        self.distance[i] = distance;
        for (column, x) in self.light.iter_mut().zip(light.array()) {
            column[i] = x;
        }
        [self.diffuse[i], self.gloss[i]] = counts;
    }
}

/// How much of what is found at hit number `i` along `to` with this density counts by the cosine law and in highlights, where rays that
/// go on from there may find it too.
pub(crate) fn counts(
    sample: &TileSample<'_>,
    q: &Scratch,
    i: usize,
    to: Vec3<f32>,
    found: f32,
) -> [f32; 2] {
    match sample.job.picture.scene.settings().integrator {
        Integrator::Path { depth, .. } => {
            let state = q.paths.state((q.hits.word[i] & ORDINAL) as usize);
            if state.bounces + 1 >= depth {
                return [1.0, 1.0];
            }
            let what = q.hits.material.get(i);
            let ray = q.hits.rays.get(&q.hits.common, i);
            let [body, mirror] = likelihood(&what, q.hits.shown(i), ray.direction, to);
            let clear = what.transmission * (1.0 - what.metallic);
            [balance(found, body), balance(found, mirror) * (1.0 - clear)]
        }
        // what mirrored rays see is no highlight
        Integrator::Whitted { .. } | Integrator::Direct => [1.0, 1.0 - q.hits.followed[i]],
    }
}

/// What fog leaves of light on the way `t` from the height `y`, which goes up by `rise` over a scene unit.
fn in_air(sample: &TileSample<'_>, y: f32, rise: f32, t: f32) -> f32 {
    let air = &sample.job.picture.air;
    if !air.is_foggy() {
        return 1.0;
    }
    1.0 - air::share(air.density, air.falloff, y, rise, t)
}

/// Adds the light of a lamp, looked for at a place of it.
pub(crate) fn look<S: Simd>(
    s: S,
    sample: &TileSample<'_>,
    lamp: &Lamp<f32>,
    shadow: Shadow,
    number: u32,
    q: &mut Scratch,
) {
    for i in 0..q.hits.count {
        let origin = q.hits.point(i) + q.hits.normal(i) * q.hits.offset[i];
        let aimed = lamp.choose(origin, random(sample, q, i, 2 + number));
        let found = density(aimed.falloff, lamp.area);
        let counted = match lamp.visible {
            true => counts(sample, q, i, aimed.to, found),
            false => [1.0, 1.0],
        };
        let left = in_air(sample, origin.y, aimed.to.y, aimed.distance);
        let light = lamp.strength * (aimed.falloff * left);
        q.aim.set(i, aimed.to, aimed.distance, light, counted);
    }
    match sample.job.picture.advected(number as usize) {
        Some((volume, reading)) => {
            let columns = std::mem::take(&mut q.aim.to);
            let distances = std::mem::take(&mut q.aim.distance);
            let [x, y, z] = &columns;
            advected(
                s,
                volume,
                reading,
                #[inline(always)]
                |i, _| {
                    let to = v3(load(s, x, i), load(s, y, i), load(s, z, i));
                    (to, load(s, &distances, i))
                },
                q,
            );
            (q.aim.to, q.aim.distance) = (columns, distances);
        }
        None => find(s, sample, shadow, q),
    }
    add(s, sample, lamp.visible, q);
}

/// Adds light from all around, looked for where most of it comes from.
pub(crate) fn look_around<S: Simd>(
    s: S,
    sample: &TileSample<'_>,
    map: &EnvironmentMap,
    q: &mut Scratch,
) {
    let ambient = sample.job.picture.scene.sky().ambient;
    for i in 0..q.hits.count {
        let state = q.paths.state((q.hits.word[i] & ORDINAL) as usize);
        let surfaces = state.bounces + state.reflections + state.refractions;
        let (to, found) = map.choose(draw(sample, &state, environment::DECISION + surfaces));
        let y = (q.hits.point(i) + q.hits.normal(i) * q.hits.offset[i]).y;
        let left = in_air(sample, y, to.y, air::ENDLESS);
        let light = map.radiance(to) * (left / (found * std::f32::consts::PI).max(1e-30));
        // as it counts where it lights the scene, and where it is seen in a mirror
        let [body, mirror] = counts(sample, q, i, to, found);
        let mirror = if state.is_scattered {
            mirror * ambient
        } else {
            mirror
        };
        q.aim
            .set(i, to, f32::INFINITY, light, [body * ambient, mirror]);
    }
    find(s, sample, Shadow::Hard, q);
    add(s, sample, true, q);
}

/// Finds what the surfaces of the hits make of light from all around, as far as an occlusion method leaves it open.
pub(crate) fn surround(sample: &TileSample<'_>, map: &EnvironmentMap, q: &mut Scratch) {
    let scene = &sample.job.picture.scene;
    let (shading, ambient) = (scene.settings().shading, scene.sky().ambient);
    for i in 0..q.hits.count {
        let hits = &q.hits;
        let what = hits.material.get(i);
        let (n, d) = (hits.shown(i), hits.rays.get(&hits.common, i).direction);
        let [x, y, z] = &hits.bent;
        let mut arriving = map.arriving(v3(x[i], y[i], z[i])) * ambient;
        if sample.job.picture.is_tinted() {
            let [r, g, b] = &hits.tint;
            arriving = arriving.times(v3(r[i], g[i], b[i]));
        }
        let seen = map.reflected(d - n * (2.0 * n.dot(d)), what.roughness);
        let open = hits.open[i];
        let light = around(
            shading,
            &what,
            [n, d],
            open,
            [arriving, seen],
            hits.followed[i],
        );
        for (column, x) in q.aim.light.iter_mut().zip(light.array()) {
            column[i] = x;
        }
    }
}

/// Finds how much of what is aimed at reaches the hits.
fn find<S: Simd>(s: S, sample: &TileSample<'_>, shadow: Shadow, q: &mut Scratch) {
    let all = 0..q.hits.count;
    if matches!(shadow, Shadow::None) {
        let [x, y, z] = &q.aim.to;
        for i in all {
            let facing = q.hits.normal(i).dot(v3(x[i], y[i], z[i]));
            q.lit[i] = if facing > 0.0 { 1.0 } else { 0.0 };
        }
    } else {
        let towards = std::mem::take(&mut q.aim.to);
        let distance = std::mem::take(&mut q.aim.distance);
        let aim = AimedLight {
            towards: &towards,
            distance: Distance::Stored(&distance),
        };
        q.counts.shadow += from_hits(s, Hard, &aim, sample.marched, all, q);
        (q.aim.to, q.aim.distance) = (towards, distance);
    }
    if !sample.job.is_path() {
        return;
    }
    for i in 0..q.hits.count {
        let number = (q.hits.word[i] & ORDINAL) as usize;
        if q.hits.word[i] & INSIDE != 0 && q.paths.state(number).medium.is_some() {
            q.lit[i] = 0.0;
        }
    }
}

/// Adds what arrives from where the hits aim, `q.lit` of it. `is_met`: whether rays find it too.
fn add<S: Simd>(s: S, sample: &TileSample<'_>, is_met: bool, q: &mut Scratch) {
    let job = sample.job;
    let shading = job.picture.scene.settings().shading;
    let is_sharp = is_met && job.is_path() && matches!(shading, Shading::Physical);
    s.vectorize(
        #[inline(always)]
        || {
            let (hits, aim) = (&mut q.hits, &q.aim);
            for i in (0..hits.count).step_by(S::f32s::LEN) {
                let lit = load(s, &q.lit, i);
                let d = hits.ray(s, i).direction;
                let [x, y, z] = &aim.to;
                let to = v3(load(s, x, i), load(s, y, i), load(s, z, i));
                let n = load3(s, &hits.shown, i);
                let finish = hits.material.finish(s, shading, i);
                let far = splat(s, f32::INFINITY);
                let answer = response(shading, false, (to, far), n, d, finish);
                let [gloss, grazing] = if is_sharp {
                    highlight(n, to, d, finish)
                } else {
                    [answer.gloss, answer.grazing]
                };
                let light = load3(s, &aim.light, i);
                let (by_cosine, shine) =
                    (load(s, &aim.diffuse, i) * lit, load(s, &aim.gloss, i) * lit);
                let sum = load3(s, &hits.diffuse, i);
                store3(
                    sum + light * (answer.diffuse * by_cosine),
                    &mut hits.diffuse,
                    i,
                );
                let sum = load3(s, &hits.gloss, i);
                store3(sum + light * (gloss * shine), &mut hits.gloss, i);
                let sum = load3(s, &hits.grazing, i);
                store3(sum + light * (grazing * shine), &mut hits.grazing, i);
                if job.wants(Plane::Shadow) {
                    let share = luminance_of(light);
                    let (shadow, shares) = (load(s, &hits.shadow, i), load(s, &hits.shares, i));
                    store(shadow + share * lit, &mut hits.shadow, i);
                    store(shares + share, &mut hits.shares, i);
                }
            }
        },
    );
}

impl Job<'_> {
    /// Whether all ways of light are followed.
    pub(crate) fn is_path(&self) -> bool {
        let settings = self.picture.scene.settings();
        matches!(settings.integrator, Integrator::Path { .. })
    }

    /// What a ray sees that meets nothing; the disc of the sun where it `looks` from the eye.
    pub(crate) fn sky_seen(
        &self,
        ray: &WideRay<f32>,
        looks: bool,
        density: Option<f32>,
    ) -> Vec3<f32> {
        let air = &self.picture.air;
        let (y, d) = (ray.origin.y, ray.direction);
        let Some(map) = &self.picture.environment else {
            let sky = SkyColours::of(self.picture.scene.sky());
            return air::behind(&sky, air, y, d, looks);
        };
        let light = map.radiance(d);
        let seen = air::before(light, air, y, d, looks);
        let Some(found) = density else {
            return seen;
        };
        // what was looked for too counts only so much
        let left = match air.is_foggy() {
            true => 1.0 - air::share(air.density, air.falloff, y, d.y, air::ENDLESS),
            false => 1.0,
        };
        seen - light * (left * (1.0 - balance(found, map.density(d))))
    }

    /// The light of all lamps that a ray meets before it ends at `t`.
    pub(crate) fn glow(&self, ray: &WideRay<f32>, state: &PathState, t: f32) -> Vec3<f32> {
        let mut sum = Vec3::splat(0.0);
        for lamp in &self.picture.lamps {
            let Some([at, falloff]) = lamp.meet(ray.origin, ray.direction) else {
                continue;
            };
            if at >= t {
                continue;
            }
            let counts = match state.density {
                Some(found) => balance(found, density(falloff, lamp.area)),
                None => 1.0,
            };
            sum = sum + (lamp.radiance() * counts).times(self.left_of(ray, state, at));
        }
        sum
    }

    /// What the way `t` leaves of light along a ray: through a clear body, or through fog.
    fn left_of(&self, ray: &WideRay<f32>, state: &PathState, t: f32) -> Vec3<f32> {
        if let Some(medium) = state.medium {
            return transmittance(parameters(self.material(medium).attenuation), t);
        }
        let air = &self.picture.air;
        if !air.is_foggy() {
            return Vec3::splat(1.0);
        }
        let (y, rise) = (ray.origin.y, ray.direction.y);
        Vec3::splat(1.0 - air::share(air.density, air.falloff, y, rise, t))
    }
}

/// Adds the light of lamps before them to the hits of rays from the eye.
pub(crate) fn shine_before(job: &Job<'_>, q: &mut Scratch) {
    if job.picture.lamps.is_empty() {
        return;
    }
    for i in 0..q.hits.count {
        let state = q.paths.state((q.hits.word[i] & ORDINAL) as usize);
        let ray = q.hits.rays.get(&q.hits.common, i);
        let light = job.glow(&ray, &state, q.hits.t[i]).array();
        for (column, x) in q.hits.colour.iter_mut().zip(light) {
            column[i] += x;
        }
    }
}
