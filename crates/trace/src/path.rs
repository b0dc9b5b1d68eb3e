//! Path tracing: at each surface the light of the lights, seen by rays, and one way of many that goes on (Kajiya 1986).
//!
//! Lights are as wide as the penumbrae of their shadows, and looked for from every surface but the inner ones of clear bodies, where no ray
//! finds them: there they are discs, which rays may meet that leave the body.

use crate::ao;
use crate::integrator::{DARK, Integrator, TileSample, add_light, darken, left, lose, shade};
use crate::lamps;
use crate::march::ORDINAL;
use crate::order;
use crate::paths::PathState;
use crate::ray::WideRay;
use crate::secondary::{Aim, from_hits};
use crate::shadow::{Hard, unshadowed};
use crate::simd::{INSIDE, Sheet, load, load_words, load3, splat3, store, store3};
use crate::surface::materials;
use crate::tile::Scratch;
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Vec3, v3};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::settings::{Occlusion, Shadow};
use zeroset_shade::bsdf::{DECISIONS, LIKELIEST, SURE, scatter};
use zeroset_shade::lamp::{Lamp, likelihood};
use zeroset_shade::light::{towards, width};
use zeroset_shade::sampling::{cone_direction, decided, hit_seed, scramble};

/// All ways of light, one of many at each surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathTracer {
    /// Surfaces that light meets on its way, at most.
    pub(crate) depth: u32,
}

/// Where rays go on from many hits, a column for each number.
pub(crate) struct BounceColumns {
    /// Random numbers: what scatters, and where to.
    random: [Box<Sheet>; 3],
    /// Index of refraction behind the surface over that before it.
    ior: Box<Sheet>,
    direction: [Box<Sheet>; 3],
    weight: [Box<Sheet>; 3],
    lobe: Box<Sheet>,
    through: Box<Sheet>,
    /// How likely each of the two opaque lobes was to choose the direction.
    density: [Box<Sheet>; 2],
}

impl BounceColumns {
    pub(crate) fn new() -> BounceColumns {
        let sheet3 = || [Sheet::boxed(), Sheet::boxed(), Sheet::boxed()];
        BounceColumns {
            random: sheet3(),
            ior: Sheet::boxed(),
            direction: sheet3(),
            weight: sheet3(),
            lobe: Sheet::boxed(),
            through: Sheet::boxed(),
            density: [Sheet::boxed(), Sheet::boxed()],
        }
    }
}

impl Integrator for PathTracer {
    fn integrate<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch) {
        let all = 0..q.hits.count;
        ao::occlusion(s, sample.solid, Occlusion::None, None, all, q);
        materials(s, sample.job, sample.solid, q);
        q.hits.followed[..q.hits.count].fill(1.0);
        darken(q);
        for (number, light) in sample.job.picture.scene.lights().iter().enumerate() {
            if sample.solid.stop.is_set() {
                return;
            }
            match Lamp::of(light) {
                Some(lamp) => lamps::look(s, sample, &lamp, light.shadow, number as u32, q),
                None => look(s, sample, light, number as u32, q),
            }
        }
        if let Some(map) = &sample.job.picture.environment {
            lamps::look_around(s, sample, map, q);
        }
        // the sky comes along the rays that meet nothing
        shade(s, sample, &DARK, q);
        self.go_on(s, sample, q);
        for i in 0..q.hits.count {
            lose(sample, q, i);
        }
    }
}

/// Two random numbers for a decision at hit number `i`.
pub(crate) fn random(sample: &TileSample<'_>, q: &Scratch, i: usize, decision: u32) -> [f32; 2] {
    let state = q.paths.state((q.hits.word[i] & ORDINAL) as usize);
    let surfaces = state.bounces + state.reflections + state.refractions;
    draw(sample, &state, surfaces * DECISIONS + decision)
}

/// Two random numbers for a decision of a way of light.
pub(crate) fn draw(sample: &TileSample<'_>, state: &PathState, decision: u32) -> [f32; 2] {
    let seed = sample.job.picture.scene.settings().seed;
    let (x, y) = (
        sample.area.x as u32 + order::X[state.pixel] as u32,
        sample.area.y as u32 + order::Y[state.pixel] as u32,
    );
    let key = scramble(x, y, hit_seed(seed, 0));
    decided(sample.index, key, decision)
}

/// Towards places that were chosen before.
pub(crate) struct AimedLight<'a> {
    pub(crate) towards: &'a [Vec<f32>; 3],
    pub(crate) distance: Distance<'a>,
}

/// How far such places are.
pub(crate) enum Distance<'a> {
    /// As far as a light.
    Of(&'a Source),
    /// As far as is known for each.
    Stored(&'a [f32]),
}

impl AimedLight<'_> {
    #[inline(always)]
    fn at<S: Simd>(&self, at: usize, origin: Vec3<Lanes<S>>) -> (Vec3<Lanes<S>>, Lanes<S>) {
        let s = origin.x.0.token();
        let [x, y, z] = self.towards;
        let distance = match self.distance {
            Distance::Of(source) => towards(source, origin).1,
            Distance::Stored(distance) => load(s, distance, at),
        };
        (v3(load(s, x, at), load(s, y, at), load(s, z, at)), distance)
    }
}

impl<S: Simd> Aim<S> for AimedLight<'_> {
    #[inline(always)]
    fn common(&self) -> Option<[f32; 3]> {
        None
    }
    #[inline(always)]
    fn direction(
        &self,
        at: usize,
        origin: Vec3<Lanes<S>>,
        _normal: Vec3<Lanes<S>>,
    ) -> (Vec3<Lanes<S>>, Lanes<S>) {
        self.at(at, origin)
    }
}

/// Adds the light of a light, looked for at a place of it.
fn look<S: Simd>(s: S, sample: &TileSample<'_>, light: &Light, number: u32, q: &mut Scratch) {
    let cosine = width(light);
    let mut directions = std::mem::take(&mut q.towards);
    for i in 0..q.hits.count {
        let (to, _) = towards(&light.source, q.hits.point(i));
        let to = if cosine < 1.0 {
            let [u, v] = random(sample, q, i, 2 + number);
            cone_direction(to, cosine, u, v)
        } else {
            to
        };
        for (column, x) in directions.iter_mut().zip(to.array()) {
            column[i] = x;
        }
    }
    let aim = AimedLight {
        towards: &directions,
        distance: Distance::Of(&light.source),
    };
    let all = 0..q.hits.count;
    q.counts.shadow += match light.shadow {
        Shadow::None => unshadowed(s, light, q),
        Shadow::Hard
        | Shadow::Soft { .. }
        | Shadow::SoftClosest { .. }
        | Shadow::Advected { .. } => from_hits(s, Hard, &aim, sample.marched, all, q),
    };
    for i in 0..q.hits.count {
        let number = (q.hits.word[i] & ORDINAL) as usize;
        if q.hits.word[i] & INSIDE != 0 && q.paths.state(number).medium.is_some() {
            q.lit[i] = 0.0;
        }
    }
    add_light(
        s,
        sample,
        light,
        q,
        #[inline(always)]
        |at, point| aim.at(at, point),
    );
    q.towards = directions;
}

impl PathTracer {
    /// Chooses where rays go on.
    fn go_on<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch) {
        for i in 0..q.hits.count {
            let state = q.paths.state((q.hits.word[i] & ORDINAL) as usize);
            let body = sample.job.material(state.medium.unwrap_or(q.hits.first[i]));
            let inside = q.hits.word[i] & INSIDE != 0;
            let [choice, _] = random(sample, q, i, 0);
            let [u, v] = random(sample, q, i, 1);
            let bounce = &mut q.bounce;
            bounce.ior[i] = if inside { 1.0 / body.ior } else { body.ior };
            for (column, x) in bounce.random.iter_mut().zip([choice, u, v]) {
                column[i] = x;
            }
        }
        let meets_lights = sample.job.picture.meets_lights();
        s.vectorize(
            #[inline(always)]
            || {
                let (hits, bounce) = (&q.hits, &mut q.bounce);
                for i in (0..hits.count).step_by(S::f32s::LEN) {
                    let what = hits.material.load(s, i);
                    let side = load_words(s, &hits.word, i) & INSIDE;
                    let inside = LaneMask(side.simd_gt(S::u32s::splat(s, 0)));
                    let tint = Vec3::select(inside, splat3(s, [1.0; 3]), what.albedo);
                    let random = load3(s, &bounce.random, i);
                    let (n, d) = (load3(s, &hits.shown, i), hits.ray(s, i).direction);
                    let way = scatter(
                        &what,
                        n,
                        d,
                        load(s, &bounce.ior, i),
                        tint,
                        [random.x, random.y, random.z],
                    );
                    store3(way.direction, &mut bounce.direction, i);
                    store3(way.weight, &mut bounce.weight, i);
                    store(way.lobe, &mut bounce.lobe, i);
                    store(way.through, &mut bounce.through, i);
                    if meets_lights {
                        let found = likelihood(&what, n, d, way.direction);
                        for (column, x) in bounce.density.iter_mut().zip(found) {
                            store(x, column, i);
                        }
                    }
                }
            },
        );
        for i in 0..q.hits.count {
            if let Some((ray, state)) = self.next(sample, q, i) {
                q.paths.push(ray, state);
            }
        }
    }

    /// The ray that goes on from hit number `i`, if one does.
    fn next(
        &self,
        sample: &TileSample<'_>,
        q: &Scratch,
        i: usize,
    ) -> Option<(WideRay<f32>, PathState)> {
        let (hits, bounce) = (&q.hits, &q.bounce);
        let state = q.paths.state((hits.word[i] & ORDINAL) as usize);
        let inside = hits.word[i] & INSIDE != 0;
        let is_clear = hits.material.get(i).transmission > 0.0;
        if state.bounces + 1 >= self.depth || (inside && state.medium.is_none() && !is_clear) {
            return None;
        }
        let vector = |[x, y, z]: &[Box<Sheet>; 3]| v3(x[i], y[i], z[i]);
        let way = left(sample, q, i);
        let mut weight = state.weight.times(vector(&bounce.weight)).times(way);
        let strongest = weight.max_component();
        if !(strongest > 0.0 && strongest.is_finite()) {
            return None;
        }
        if state.bounces + 1 >= SURE {
            let chance = strongest.min(LIKELIEST);
            let [_, roulette] = random(sample, q, i, 0);
            if roulette >= chance {
                return None;
            }
            weight = weight / chance;
        }
        let through = bounce.through[i] > 0.5;
        let medium = match (inside, through) {
            (true, true) => None,
            (true, false) => Some(state.medium.unwrap_or(hits.first[i])),
            (false, true) => Some(hits.first[i]),
            (false, false) => None,
        };
        // from inside a clear body no light is looked for, nor behind one
        let looked = !(inside && state.medium.is_some()) && bounce.lobe[i] < 1.5;
        let density = (looked && sample.job.picture.meets_lights())
            .then(|| bounce.density[usize::from(bounce.lobe[i] > 0.5)][i]);
        let ray = hits.rays.get(&hits.common, i);
        let side = if through { -1.0 } else { 1.0 };
        // what bumps send behind the surface that they are on is lost
        if sample.job.picture.has_bumps
            && hits.normal(i).dot(vector(&bounce.direction)) * side <= 0.0
        {
            return None;
        }
        Some((
            WideRay {
                origin: hits.point(i) + hits.normal(i) * (hits.offset[i] * side),
                direction: vector(&bounce.direction),
                travelled: ray.way(hits.t[i]),
                ..ray
            },
            PathState {
                weight,
                medium,
                bounces: state.bounces + 1,
                is_scattered: state.is_scattered || bounce.lobe[i] < 0.5,
                sees_lights: bounce.lobe[i] > 1.5,
                density,
                ..state
            },
        ))
    }
}
