//! Integrators: from what rays meet to the light that comes back along them.

use crate::ao;
use crate::job::Job;
use crate::lamps;
use crate::march::ORDINAL;
use crate::order::{self, Sorting};
use crate::shadow::{advected, shadows};
use crate::simd::{INSIDE, load, load_words, load3, splat, splat3, store, store3};
use crate::surface::materials;
use crate::tile::{Area, Hits, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3};
use zeroset_scene::film::Plane;
use zeroset_scene::light::Light;
use zeroset_scene::settings::{Occlusion, Shading};
use zeroset_shade::air::{self, through};
use zeroset_shade::lamp::Lamp;
use zeroset_shade::light::{arrival, towards};
use zeroset_shade::parameters;
use zeroset_shade::sampling::{hit_seed, scramble};
use zeroset_shade::sky::SkyColours;
use zeroset_shade::surface::{Lighting, colour, transmittance};

/// A sample of the pixels of a tile.
#[derive(Clone, Copy)]
pub(crate) struct TileSample<'a> {
    pub(crate) job: &'a Job<'a>,
    pub(crate) solid: &'a Solid<'a>,
    /// The same as what rays from outside of it are followed through: solids in closed form, and the rest.
    pub(crate) marched: &'a Solid<'a>,
    pub(crate) area: &'a Area,
    /// Its number.
    pub(crate) index: u32,
}

/// A way to find the light that comes back along rays.
///
/// It is given the hits of the rays of a queue, from the eye or onward, with all that is known of their surfaces, and may send other
/// rays on from there.
pub(crate) trait Integrator {
    /// Finds the light that comes back along the rays of `q.hits`, into their `colour`; beside it what the planes show of light:
    /// `open`, `shadow`, and the albedo of `material`. What other rays bring goes into `q.paths`.
    fn integrate<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch);
}

/// Light that comes from lights and the sky and is reflected once, as a method says that it does; the sky's through what an occlusion
/// method leaves open. Clear bodies are shown as if they were none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Direct;

impl Integrator for Direct {
    fn integrate<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch) {
        identify(s, sample, q);
        q.hits.material.make_opaque(q.hits.count);
        light(s, sample, q);
    }
}

/// Finds what the hits are made of and how much of the sky they see. No ray goes on yet.
pub(crate) fn identify<S: Simd>(s: S, sample: &TileSample<'_>, q: &mut Scratch) {
    occlude(s, sample, q);
    materials(s, sample.job, sample.solid, q);
    q.hits.followed[..q.hits.count].fill(0.0);
}

/// Puts the colours of the hits together, of what the lights and the sky send them.
pub(crate) fn light<S: Simd>(s: S, sample: &TileSample<'_>, q: &mut Scratch) {
    let scene = &sample.job.picture.scene;
    darken(q);
    for (number, light) in scene.lights().iter().enumerate() {
        if sample.solid.stop.is_set() {
            break;
        }
        if let Some(lamp) = Lamp::of(light) {
            lamps::look(s, sample, &lamp, light.shadow, number as u32, q);
            continue;
        }
        match sample.job.picture.advected(number) {
            Some((volume, reading)) => advected(
                s,
                volume,
                reading,
                #[inline(always)]
                |_, point| towards(&light.source, point),
                q,
            ),
            None => shadows(s, sample.solid, sample.marched, light, q),
        }
        add_light(
            s,
            sample,
            light,
            q,
            #[inline(always)]
            |_, point| towards(&light.source, point),
        );
    }
    match &sample.job.picture.environment {
        Some(map) => {
            lamps::surround(sample, map, q);
            shade(s, sample, &DARK, q);
        }
        None => shade(s, sample, &SkyColours::of(scene.sky()), q),
    }
}

/// No sky.
pub(crate) const DARK: SkyColours<f32> = SkyColours {
    top: Vec3 {
        x: 0.0,
        y: 0.0,
        z: 0.0,
    },
    horizon: Vec3 {
        x: 0.0,
        y: 0.0,
        z: 0.0,
    },
    bottom: Vec3 {
        x: 0.0,
        y: 0.0,
        z: 0.0,
    },
    ambient: 0.0,
};

/// What the way leaves of light from hit number `i` back to where its ray began: through a clear body, or through fog.
pub(crate) fn left(sample: &TileSample<'_>, q: &Scratch, i: usize) -> Vec3<f32> {
    let hits = &q.hits;
    if hits.word[i] & INSIDE != 0 {
        let state = q.paths.state((hits.word[i] & ORDINAL) as usize);
        let body = sample.job.material(state.medium.unwrap_or(hits.first[i]));
        return transmittance(parameters(body.attenuation), hits.t[i]);
    }
    let air = &sample.job.picture.air;
    let ray = hits.rays.get(&hits.common, i);
    let taken = match air.is_foggy() {
        true => air::share(
            air.density,
            air.falloff,
            ray.origin.y,
            ray.direction.y,
            hits.t[i],
        ),
        false => 0.0,
    };
    Vec3::splat(1.0 - taken)
}

/// What light loses inside clear bodies, on the way from hit number `i` back to where its ray began.
pub(crate) fn lose(sample: &TileSample<'_>, q: &mut Scratch, i: usize) {
    let hits = &mut q.hits;
    let state = q.paths.state((hits.word[i] & ORDINAL) as usize);
    let clear = hits.material.get(i).transmission > 0.0;
    if hits.word[i] & INSIDE == 0 || (state.medium.is_none() && !clear) {
        return;
    }
    let body = sample.job.material(state.medium.unwrap_or(hits.first[i]));
    let left = transmittance(parameters(body.attenuation), hits.t[i]).array();
    for (column, left) in hits.colour.iter_mut().zip(left) {
        column[i] *= left;
    }
}

/// Finds the ambient visibility, object by object where they chose different methods.
fn occlude<S: Simd>(s: S, sample: &TileSample<'_>, q: &mut Scratch) {
    let (picture, solid, area) = (sample.job.picture, sample.solid, sample.area);
    let methods = &picture.methods;
    let random = |m: &Occlusion| {
        matches!(
            m,
            Occlusion::Hemisphere { .. } | Occlusion::Obscurance { .. }
        )
    };
    // what takes a few evaluations is not worth it, and of what is random the mean over the samples is what counts
    let is_dear = |m: &Occlusion| matches!(m, Occlusion::Cones { .. });
    let shares = sample.job.samples() > 1 && q.paths.is_from_eye() && methods.iter().all(is_dear);
    let given = match shares {
        true => q.shared.look_up(solid, sample.index, &q.hits),
        false => 0,
    };
    // by method, and what is given behind what is found
    let key =
        |object: f32, given: bool| 2 * method_of(&picture.method_of, object) + usize::from(given);
    let keys = 2 * methods.len();
    let mut ends = std::mem::take(&mut q.ends);
    ends.clear();
    ends.resize(keys, 0);
    if methods.len() > 1 || given > 0 {
        let shared = &q.shared;
        let is_given = |i: usize| given > 0 && shared.is_given(i);
        let objects = &q.hits.object;
        (0..q.hits.count).for_each(|i| ends[key(objects[i], is_given(i))] += 1);
        q.sorting
            .by_key(q.hits.count, keys, |i| key(objects[i], is_given(i)));
        q.hits.sort(&mut q.sorting);
    } else {
        ends[0] = q.hits.count;
    }
    if methods.iter().any(random) {
        let seed = picture.scene.settings().seed;
        for i in 0..q.hits.count {
            let pixel = q.paths.pixel((q.hits.word[i] & ORDINAL) as usize);
            let (x, y) = (
                area.x as u32 + order::X[pixel] as u32,
                area.y as u32 + order::Y[pixel] as u32,
            );
            // not the random numbers of the pixel's samples
            let key = scramble(x, y, hit_seed(seed, sample.index));
            (q.scramble[0][i], q.scramble[1][i]) = (key[0], key[1]);
        }
    }
    let mut from = 0;
    for (method, counts) in methods.iter().zip(ends.as_chunks::<2>().0) {
        let [found, given] = counts.map(|count| {
            from += count;
            from - count..from
        });
        ao::occlusion(s, solid, *method, picture.volumes.sky.as_deref(), found, q);
        q.shared.give(&mut q.hits, given);
    }
    q.ends = ends;
    if !solid.close {
        // what was read is no bound: nothing is known to be empty
        let count = q.hits.count;
        q.hits.ball[..count].fill(0.0);
    }
    // inside a solid there is no sky: it is shown as if there were no solid
    let hits = &mut q.hits;
    for i in (0..hits.count).filter(|&i| hits.word[i] & INSIDE != 0) {
        hits.open[i] = 1.0;
        for tint in &mut hits.tint {
            tint[i] = 1.0;
        }
        for (bent, normal) in hits.bent.iter_mut().zip(&hits.normal) {
            bent[i] = normal[i];
        }
    }
    if shares {
        q.shared.keep(sample.index, &q.hits);
    }
}

/// Before anything arrives from a light.
pub(crate) fn darken(q: &mut Scratch) {
    let count = q.hits.count;
    let columns = q.hits.diffuse.iter_mut().chain(&mut q.hits.gloss);
    columns
        .chain(&mut q.hits.grazing)
        .chain([&mut q.hits.shadow, &mut q.hits.shares])
        .for_each(|c| c[..count].fill(0.0));
}

/// Adds what arrives from a light: `q.lit` of it, from the direction and the distance that `aim` gives for the hits from a number on, and
/// their places.
pub(crate) fn add_light<S: Simd>(
    s: S,
    sample: &TileSample<'_>,
    light: &Light,
    q: &mut Scratch,
    aim: impl Fn(usize, Vec3<Lanes<S>>) -> (Vec3<Lanes<S>>, Lanes<S>),
) {
    let job = sample.job;
    let (count, shading) = (q.hits.count, job.picture.scene.settings().shading);
    s.vectorize(
        #[inline(always)]
        || {
            let hits = &mut q.hits;
            for i in (0..count).step_by(S::f32s::LEN) {
                let lit = load(s, &q.lit, i);
                let d = hits.ray(s, i).direction;
                let to = aim(i, load3(s, &hits.point, i));
                let finish = hits.material.finish(s, shading, i);
                let got = arrival(shading, light, to, load3(s, &hits.shown, i), d, lit, finish);
                let (diffuse, gloss) = (load3(s, &hits.diffuse, i), load3(s, &hits.gloss, i));
                store3(diffuse + got.diffuse, &mut hits.diffuse, i);
                store3(gloss + got.gloss, &mut hits.gloss, i);
                if matches!(shading, Shading::Physical) {
                    let grazing = load3(s, &hits.grazing, i);
                    store3(grazing + got.grazing, &mut hits.grazing, i);
                }
                if job.wants(Plane::Shadow) {
                    store(
                        load(s, &hits.shadow, i) + got.share * lit,
                        &mut hits.shadow,
                        i,
                    );
                    store(load(s, &hits.shares, i) + got.share, &mut hits.shares, i);
                }
            }
        },
    );
}

/// Puts the colours of all hits together.
pub(crate) fn shade<S: Simd>(
    s: S,
    sample: &TileSample<'_>,
    sky: &SkyColours<f32>,
    q: &mut Scratch,
) {
    let job = sample.job;
    let air = &job.picture.air;
    let is_tinted = job.picture.is_tinted();
    // paths find it along the rays that meet nothing
    let is_surrounded = job.picture.environment.is_some() && !job.is_path();
    s.vectorize(
        #[inline(always)]
        || {
            let (scene, hits) = (&job.picture.scene, &mut q.hits);
            for i in (0..hits.count).step_by(S::f32s::LEN) {
                let what = hits.material.load(s, i);
                // lights do not shine on the inner side of a clear body
                let side = load_words(s, &hits.word, i) & INSIDE;
                let inside = LaneMask(side.simd_gt(S::u32s::splat(s, 0)));
                let one = splat(s, 1.0);
                let shone = Lanes::select(inside, what.transmission.one_minus(), one);
                let light = Lighting {
                    diffuse: load3(s, &hits.diffuse, i),
                    gloss: load3(s, &hits.gloss, i) * shone,
                    grazing: load3(s, &hits.grazing, i) * shone,
                    open: load(s, &hits.open, i),
                    tint: if is_tinted {
                        load3(s, &hits.tint, i)
                    } else {
                        splat3(s, [1.0; 3])
                    },
                    bent: load3(s, &hits.bent, i),
                    normal: load3(s, &hits.shown, i),
                    direction: hits.ray(s, i).direction,
                };
                let followed = load(s, &hits.followed, i);
                let mut c = colour(scene.settings().shading, sky, &what, &light, followed);
                if is_surrounded {
                    c = c + load3(s, &q.aim.light, i);
                }
                if air.is_foggy() {
                    // there is none in solids
                    let ray = hits.ray(s, i);
                    let (d, t) = (ray.direction, load(s, &hits.t, i));
                    let hazy = through(air, c, ray.origin.y, d, t);
                    c = Vec3::select(inside, c, hazy);
                }
                store3(c, &mut hits.colour, i);
                if job.wants(Plane::Shadow) {
                    let (lit, all) = (load(s, &hits.shadow, i), load(s, &hits.shares, i));
                    store(lit / all.max(1e-20), &mut hits.shadow, i);
                }
            }
        },
    );
}

fn method_of(methods: &[usize], object: f32) -> usize {
    if object >= 0.0 {
        methods.get(object as usize).copied().unwrap_or(0)
    } else {
        0
    }
}

impl Hits {
    /// Puts the hits in another order.
    fn sort(&mut self, sorting: &mut Sorting) {
        let columns = [
            &mut self.t,
            &mut self.f,
            &mut self.steps,
            &mut self.residual,
            &mut self.offset,
        ];
        let marks = [
            &mut self.object,
            &mut self.first,
            &mut self.second,
            &mut self.share,
        ];
        let vectors = (self.orbit.iter_mut())
            .chain(&mut self.point)
            .chain(&mut self.normal);
        for column in columns.into_iter().chain(marks).chain(vectors) {
            sorting.apply(column);
        }
        for column in self.rays.columns_mut() {
            sorting.apply(column);
        }
        sorting.apply_words(&mut self.word);
    }
}
