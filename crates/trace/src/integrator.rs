//! Integrators: from what rays meet to the light that comes back along them.

use crate::ao;
use crate::job::Job;
use crate::march::ORDINAL;
use crate::order::{self, Sorting};
use crate::shadow::shadows;
use crate::simd::{INSIDE, load, load3, splat, store, store3};
use crate::tile::{Area, Hits, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::Ops;
use zeroset_scene::film::Plane;
use zeroset_scene::settings::{Occlusion, Shading};
use zeroset_shade::light::{arrival, towards};
use zeroset_shade::pattern::Place;
use zeroset_shade::sampling::{hit_seed, scramble};
use zeroset_shade::sky::SkyColours;
use zeroset_shade::surface::{Lighting, colour};

/// A sample of the pixels of a tile.
#[derive(Clone, Copy)]
pub(crate) struct TileSample<'a> {
    pub(crate) job: &'a Job<'a>,
    pub(crate) solid: &'a Solid<'a>,
    pub(crate) area: &'a Area,
    /// Its number.
    pub(crate) index: u32,
}

/// A way to find the light that comes back along rays.
///
/// It is given the hits of a sample's primary rays, with all that is known of their surfaces, and may follow other rays from there
/// ([`crate::closest::closest`], [`crate::secondary`]).
pub(crate) trait Integrator {
    /// Finds the light that comes back along the rays of `q.hits`, into their `colour`; beside it what the planes show of light:
    /// `open`, `shadow`, `albedo`.
    fn integrate<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch);
}

/// Light that comes from lights and the sky and is reflected once, as a method says that it does; the sky's through what an occlusion
/// method leaves open.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Direct;

impl Integrator for Direct {
    fn integrate<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch) {
        occlude(s, sample, q);
        light(s, sample, q);
        shade(s, sample, q);
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
    if methods.len() > 1 {
        q.hits
            .sort_by_method(methods.len(), &picture.method_of, &mut q.sorting);
    }
    if methods.iter().any(random) {
        let seed = picture.scene.settings().seed;
        for i in 0..q.hits.count {
            let pixel = (q.hits.word[i] & ORDINAL) as usize;
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
    for (number, method) in methods.iter().enumerate() {
        let to = if methods.len() == 1 {
            q.hits.count
        } else {
            let of = |object: &f32| method_of(&picture.method_of, *object);
            from + q.hits.object[from..q.hits.count]
                .iter()
                .take_while(|o| of(o) == number)
                .count()
        };
        ao::occlusion(s, solid, *method, from..to, q);
        from = to;
    }
    if !solid.close {
        // what was read is no bound: nothing is known to be empty
        let count = q.hits.count;
        q.hits.ball[..count].fill(0.0);
    }
    // inside a solid there is no sky: it is shown as if there were no solid
    let hits = &mut q.hits;
    for i in (0..hits.count).filter(|&i| hits.word[i] & INSIDE != 0) {
        hits.open[i] = 1.0;
        for (bent, normal) in hits.bent.iter_mut().zip(&hits.normal) {
            bent[i] = normal[i];
        }
    }
}

/// Sums up what arrives from the lights.
fn light<S: Simd>(s: S, sample: &TileSample<'_>, q: &mut Scratch) {
    let (job, solid) = (sample.job, sample.solid);
    let (count, shading) = (q.hits.count, job.picture.scene.settings().shading);
    let columns = q.hits.diffuse.iter_mut().chain(&mut q.hits.gloss);
    columns
        .chain([&mut q.hits.shadow, &mut q.hits.shares])
        .for_each(|c| c[..count].fill(0.0));
    for light in job.picture.scene.lights() {
        if solid.stop.is_set() {
            break;
        }
        shadows(s, solid, light, q);
        let only = job.picture.material;
        let only = only.map(|m| job.material(f32::from(m)).shininess);
        s.vectorize(
            #[inline(always)]
            || {
                let hits = &mut q.hits;
                for i in (0..count).step_by(S::f32s::LEN) {
                    let lit = load(s, &q.lit, i);
                    let d = hits.ray(s, i).direction;
                    let to = towards(&light.source, load3(s, &hits.point, i));
                    let shininess = match (shading, only) {
                        (Shading::Phong, None) => job.shininess(s, hits, i),
                        (_, shininess) => splat(s, shininess.unwrap_or(1.0)),
                    };
                    let got = arrival(
                        shading,
                        light,
                        to,
                        load3(s, &hits.normal, i),
                        d,
                        lit,
                        shininess,
                    );
                    let (diffuse, gloss) = (load3(s, &hits.diffuse, i), load3(s, &hits.gloss, i));
                    store3(diffuse + got.diffuse, &mut hits.diffuse, i);
                    store3(gloss + got.gloss, &mut hits.gloss, i);
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
}

/// Puts the colours of all hits together.
fn shade<S: Simd>(s: S, sample: &TileSample<'_>, q: &mut Scratch) {
    let (job, solid) = (sample.job, sample.solid);
    s.vectorize(
        #[inline(always)]
        || {
            let (scene, hits) = (&job.picture.scene, &mut q.hits);
            let sky = SkyColours::of(scene.sky());
            // with more rays a pixel each stands for less of it
            let finer = 1.0 / (job.samples() as f32).sqrt();
            for i in (0..hits.count).step_by(S::f32s::LEN) {
                let ray = hits.ray(s, i);
                let d = ray.direction;
                let n = load3(s, &hits.normal, i);
                let pixel = solid.width(&ray, load(s, &hits.t, i)) * finer;
                let mut place = Place::new(load3(s, &hits.point, i), n, d, pixel);
                if job.picture.has_orbits {
                    let o = &hits.orbit;
                    place = place.with_orbit([
                        load(s, &o[0], i),
                        load(s, &o[1], i),
                        load(s, &o[2], i),
                        load(s, &o[3], i),
                    ]);
                }
                let what = job.local_material(s, hits, i, &place);
                let light = Lighting {
                    diffuse: load3(s, &hits.diffuse, i),
                    gloss: load3(s, &hits.gloss, i),
                    open: load(s, &hits.open, i),
                    bent: load3(s, &hits.bent, i),
                    normal: n,
                    direction: d,
                };
                let c = colour(scene.settings().shading, &sky, &what, &light);
                store3(c, &mut hits.colour, i);
                if job.wants(Plane::Albedo) {
                    store3(what.albedo, &mut hits.albedo, i);
                }
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
    /// Orders the hits by the occlusion method of their objects.
    fn sort_by_method(&mut self, count: usize, methods: &[usize], sorting: &mut Sorting) {
        sorting.by_key(self.count, count, |i| method_of(methods, self.object[i]));
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
