//! What is done for a tile: the stages, sample by sample.

use crate::march::ORDINAL;
use crate::normal::{normals, place};
use crate::order::{self, PLACE};
use crate::primary::{Plan, march};
use crate::renderer::{Done, PreparedScene};
use crate::shadow::shadows;
use crate::simd::{INSIDE, constant, load, load3, splat, store, store3};
use crate::stop::Stop;
use crate::tile::{Area, HEIGHT, Hits, Scratch, Solid, WIDTH};
use crate::{ao, cone, resolve};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::BATCH;
use zeroset_number::{Lanes, Ops, Real};
use zeroset_scene::accumulator::{Accumulator, Sum};
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::material::Material;
use zeroset_scene::settings::{Filter, Occlusion, Shading};
use zeroset_shade::light::{arrival, towards};
use zeroset_shade::march::MARKS_BEHIND;
use zeroset_shade::pattern::{Place, colour as pattern_colour};
use zeroset_shade::sampling::{hit_seed, point, scramble};
use zeroset_shade::sky::{SkyColours, colour as sky};
use zeroset_shade::surface::{Lighting, LocalMaterial, colour};
use zeroset_shade::view::View;

/// All that tiles of one rendering have in common.
pub(crate) struct Job<'a> {
    picture: &'a PreparedScene,
    view: View,
    wanted: [bool; Plane::ALL.len()],
    /// Samples a pixel of the finished picture, and their filter.
    samples: Option<(u32, Filter)>,
    /// Those that are taken now.
    taken: Range<u32>,
    plan: Plan,
    /// Whether the marks of hits differ and are needed.
    marks: bool,
    /// What a surface without a material is made of.
    fallback: Material,
}

impl<'a> Job<'a> {
    pub(crate) fn new(
        picture: &'a PreparedScene,
        camera: &Camera,
        taken: Range<u32>,
        into: &Accumulator,
    ) -> Job<'a> {
        let settings = picture.scene.settings();
        let wanted = Plane::ALL.map(|plane| into.planes().contains(&plane));
        let objects = wanted[Plane::Object as usize] || picture.methods.len() > 1;
        let samples = into.filter().map(|filter| (into.wanted(), filter));
        Job {
            picture,
            view: View::new(camera, into.size(), settings.footprint),
            wanted,
            samples,
            taken,
            plan: Plan {
                march: settings.march,
                select: settings.hit_selection,
                steps: wanted[Plane::Steps as usize],
            },
            marks: picture.material.is_none()
                || picture.has_orbits
                || (objects && picture.object.is_none()),
            fallback: Material::default(),
        }
    }

    /// Whether pixels are made of several samples.
    pub(crate) fn is_filtered(&self) -> bool {
        self.samples.is_some()
    }

    /// Samples a pixel of the finished picture.
    fn samples(&self) -> u32 {
        self.samples.map_or(1, |(n, _)| n)
    }

    /// Samples a pixel that are taken now.
    pub(crate) fn taken(&self) -> u32 {
        self.taken.len() as u32
    }

    fn wants(&self, plane: Plane) -> bool {
        self.wanted[plane as usize]
    }

    /// Renders a tile into the scratch memory; where samples are filtered, their colours into `sums`.
    pub(crate) fn tile<S: Simd>(
        &self,
        s: S,
        area: &Area,
        sums: &mut [f32],
        q: &mut Scratch,
        stop: &Stop<'_>,
    ) -> Done {
        let solid = Solid::new(
            &self.picture.program,
            self.picture.region,
            &self.view,
            self.picture.scene.settings().max_steps,
            self.picture.skins,
            self.samples(),
            stop,
        );
        q.planes.clear();
        let mut hits = 0;
        for index in self.taken.clone() {
            if stop.is_set() {
                break;
            }
            self.aim(area, index, q);
            self.trace(s, &solid, area, index, q);
            if stop.is_set() {
                // what was found is not all: it must not reach the pixels of the tiles around
                break;
            }
            hits += q.hits.count as u64;
            self.gather(s, area, q);
            if let Some((_, filter)) = self.samples {
                resolve::splat_samples(s, filter, area, &q.planes, sums);
            }
        }
        let rays = (area.width * area.height) as u64 * u64::from(self.taken());
        Done {
            rays,
            hits,
            evaluations: q.counts,
            spent: stop.evaluations(),
        }
    }

    /// Chooses where in their pixels the rays of sample number `index` go through.
    fn aim(&self, area: &Area, index: u32, q: &mut Scratch) {
        let seed = self.picture.scene.settings().seed;
        if self.samples.is_none() {
            q.jitter.iter_mut().for_each(|j| j.fill(0.5));
            return;
        }
        for i in 0..WIDTH * HEIGHT {
            let key = scramble(
                area.x as u32 + order::X[i] as u32,
                area.y as u32 + order::Y[i] as u32,
                seed,
            );
            let place = point(index, key);
            for k in 0..2 {
                q.jitter[k][i] = place[k];
                q.planes.jitter[k][usize::from(PLACE[i])] = place[k];
            }
        }
    }

    /// Finds what the rays hit and what colour it has.
    fn trace<S: Simd>(&self, s: S, solid: &Solid<'_>, area: &Area, index: u32, q: &mut Scratch) {
        let settings = self.picture.scene.settings();
        if index == self.taken.start {
            let reach = if self.samples.is_some() { 0.5 } else { 0.0 };
            cone::prepass(
                s,
                solid,
                area,
                reach,
                settings.prepass.then_some(settings.march),
                q,
            );
        }
        if self.plan.steps {
            q.steps.fill(0.0);
        }
        march(s, &self.plan, solid, area, q);
        place(
            s,
            solid,
            settings.discontinuity_reduction,
            self.wants(Plane::Residual),
            q,
        );
        normals(s, solid, settings.normals, q);
        if self.marks {
            marks(s, solid, q);
        } else {
            let (object, material) = (
                self.picture.object.unwrap_or(0),
                self.picture.material.unwrap_or(0),
            );
            let n = q.hits.count;
            q.hits.object[..n].fill(f32::from(object));
            q.hits.first[..n].fill(f32::from(material));
            q.hits.share[..n].fill(0.0);
        }
        self.occlude(s, solid, area, index, q);
        self.light(s, solid, q);
        self.shade(s, q);
    }

    /// Finds the ambient visibility, object by object where they chose different methods.
    fn occlude<S: Simd>(&self, s: S, solid: &Solid<'_>, area: &Area, index: u32, q: &mut Scratch) {
        let methods = &self.picture.methods;
        let random = |m: &Occlusion| {
            matches!(
                m,
                Occlusion::Hemisphere { .. } | Occlusion::Obscurance { .. }
            )
        };
        if methods.len() > 1 {
            q.hits.sort_by_method(&self.picture.method_of);
        }
        if methods.iter().any(random) {
            let seed = self.picture.scene.settings().seed;
            for i in 0..q.hits.count {
                let pixel = (q.hits.word[i] & ORDINAL) as usize;
                let (x, y) = (
                    area.x as u32 + order::X[pixel] as u32,
                    area.y as u32 + order::Y[pixel] as u32,
                );
                // not the random numbers of the pixel's samples
                let key = scramble(x, y, hit_seed(seed, index));
                (q.scramble[0][i], q.scramble[1][i]) = (key[0], key[1]);
            }
        }
        let mut from = 0;
        for (number, method) in methods.iter().enumerate() {
            let to = if methods.len() == 1 {
                q.hits.count
            } else {
                let of = |object: &f32| method_of(&self.picture.method_of, *object);
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
    fn light<S: Simd>(&self, s: S, solid: &Solid<'_>, q: &mut Scratch) {
        let (count, shading) = (q.hits.count, self.picture.scene.settings().shading);
        let columns = q.hits.diffuse.iter_mut().chain(&mut q.hits.gloss);
        columns
            .chain([&mut q.hits.shadow, &mut q.hits.shares])
            .for_each(|c| c[..count].fill(0.0));
        for light in self.picture.scene.lights() {
            if solid.stop.is_set() {
                break;
            }
            shadows(s, solid, light, q);
            let only = self
                .picture
                .material
                .map(|m| self.material(f32::from(m)).shininess);
            s.vectorize(
                #[inline(always)]
                || {
                    let hits = &mut q.hits;
                    for i in (0..count).step_by(S::f32s::LEN) {
                        let lit = load(s, &hits.lit, i);
                        let (_, d) = self.view.split(load3(s, &hits.ray, i));
                        let to = towards(&light.source, load3(s, &hits.point, i));
                        let shininess = match (shading, only) {
                            (Shading::Phong, None) => self.shininess(s, hits, i),
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
                        let (diffuse, gloss) =
                            (load3(s, &hits.diffuse, i), load3(s, &hits.gloss, i));
                        store3(diffuse + got.diffuse, &mut hits.diffuse, i);
                        store3(gloss + got.gloss, &mut hits.gloss, i);
                        if self.wants(Plane::Shadow) {
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

    fn material(&self, number: f32) -> &Material {
        let at = if number >= 0.0 {
            number as usize
        } else {
            usize::MAX
        };
        self.picture
            .scene
            .materials()
            .get(at)
            .unwrap_or(&self.fallback)
    }

    #[inline(always)]
    fn shininess<S: Simd>(&self, s: S, hits: &Hits, i: usize) -> Lanes<S> {
        Lanes(S::f32s::from_fn(
            s,
            #[inline(always)]
            |k| {
                let (a, b) = (hits.first[i + k], hits.second[i + k]);
                let (a, share) = (self.material(a).shininess, hits.share[i + k]);
                if share > 0.0 {
                    a + (self.material(b).shininess - a) * share
                } else {
                    a
                }
            },
        ))
    }

    /// What the surface is made of at the hits from `i` on: of each material that any of them has, as much as they have.
    #[inline(always)]
    fn local_material<S: Simd>(
        &self,
        s: S,
        hits: &Hits,
        i: usize,
        at: &Place<Lanes<S>>,
    ) -> LocalMaterial<Lanes<S>> {
        if let Some(only) = self.picture.material {
            return whole(self.material(f32::from(only)), at, splat(s, 1.0));
        }
        let lanes = S::f32s::LEN.min(hits.count - i);
        let (first, second, share) = (
            load(s, &hits.first, i),
            load(s, &hits.second, i),
            load(s, &hits.share, i),
        );
        let mut sum: Option<LocalMaterial<Lanes<S>>> = None;
        let mut last = f32::NEG_INFINITY;
        loop {
            // the next material in the order of their numbers
            let mut number = f32::INFINITY;
            for k in 0..lanes {
                let (a, b, share) = (hits.first[i + k], hits.second[i + k], hits.share[i + k]);
                if a > last && a < number {
                    number = a;
                }
                if share > 0.0 && b > last && b < number {
                    number = b;
                }
            }
            if number == f32::INFINITY {
                break;
            }
            last = number;
            let (not_first, not_second) = (
                first.below(number) | first.above(number),
                second.below(number) | second.above(number),
            );
            let zero = splat(s, 0.0);
            let weight = Lanes::select(not_first, zero, share.one_minus())
                + Lanes::select(not_second, zero, share);
            let part = whole(self.material(number), at, weight);
            sum = Some(match sum {
                None => part,
                Some(all) => LocalMaterial {
                    albedo: all.albedo + part.albedo,
                    emission: all.emission + part.emission,
                    specular: all.specular + part.specular,
                    metallic: all.metallic + part.metallic,
                    roughness: all.roughness + part.roughness,
                },
            });
        }
        match sum {
            Some(all) => all,
            None => whole(&self.fallback, at, splat(s, 1.0)),
        }
    }

    /// Puts the colours of all hits together.
    fn shade<S: Simd>(&self, s: S, q: &mut Scratch) {
        s.vectorize(
            #[inline(always)]
            || {
                let (scene, hits) = (&self.picture.scene, &mut q.hits);
                let heaven = SkyColours::of(scene.sky());
                // with more rays a pixel each stands for less of it
                let finer = 1.0 / (self.samples() as f32).sqrt();
                for i in (0..hits.count).step_by(S::f32s::LEN) {
                    let (_, d) = self.view.split(load3(s, &hits.ray, i));
                    let n = load3(s, &hits.normal, i);
                    let narrow = self.view.narrow(load3(s, &hits.ray, i));
                    let pixel = self.view.width(load(s, &hits.t, i), narrow) * finer;
                    let mut place = Place::new(load3(s, &hits.point, i), n, d, pixel);
                    if self.picture.has_orbits {
                        let o = &hits.orbit;
                        place = place.with_orbit([
                            load(s, &o[0], i),
                            load(s, &o[1], i),
                            load(s, &o[2], i),
                            load(s, &o[3], i),
                        ]);
                    }
                    let what = self.local_material(s, hits, i, &place);
                    let light = Lighting {
                        diffuse: load3(s, &hits.diffuse, i),
                        gloss: load3(s, &hits.gloss, i),
                        open: load(s, &hits.open, i),
                        bent: load3(s, &hits.bent, i),
                        normal: n,
                        direction: d,
                    };
                    let c = colour(scene.settings().shading, &heaven, &what, &light);
                    store3(c, &mut hits.colour, i);
                    if self.wants(Plane::Albedo) {
                        store3(what.albedo, &mut hits.albedo, i);
                    }
                    if self.wants(Plane::Shadow) {
                        let (lit, all) = (load(s, &hits.shadow, i), load(s, &hits.shares, i));
                        store(lit / all.max(1e-20), &mut hits.shadow, i);
                    }
                }
            },
        );
    }

    /// Puts the hits of one sample in their pixels, and the sky in all others.
    fn gather<S: Simd>(&self, s: S, area: &Area, q: &mut Scratch) {
        if q.hits.count < area.width * area.height {
            self.background(s, area, q);
        }
        let (hits, planes) = (&q.hits, &mut q.planes);
        for i in 0..hits.count {
            let at = usize::from(PLACE[(hits.word[i] & ORDINAL) as usize]);
            for k in 0..3 {
                planes.colour[k][at] = hits.colour[k][i];
            }
            planes.coverage[at] = 1.0;
        }
        if Plane::ALL
            .iter()
            .any(|p| !matches!(p, Plane::Colour | Plane::Coverage) && self.wants(*p))
        {
            planes.add(hits, self.plan.steps.then_some(&*q.steps));
        }
    }

    /// Fills the tile with the sky. (Its colours are so smooth that the middle of a pixel does for all its samples.)
    fn background<S: Simd>(&self, s: S, area: &Area, q: &mut Scratch) {
        let heaven = SkyColours::of(self.picture.scene.sky());
        s.vectorize(
            #[inline(always)]
            || {
                let ramp = Lanes(S::f32s::from_fn(
                    s,
                    #[inline(always)]
                    |k| k as f32,
                ));
                for y in 0..area.height {
                    let v = splat(s, (area.y + y) as f32 + 0.5);
                    for x in (0..area.width).step_by(S::f32s::LEN) {
                        let (_, d) = self
                            .view
                            .split(self.view.ray(ramp + ((area.x + x) as f32 + 0.5), v));
                        store3(sky(&heaven, d.y), &mut q.planes.colour, y * WIDTH + x);
                        store(splat(s, 0.0), &mut q.planes.coverage, y * WIDTH + x);
                    }
                }
            },
        );
    }

    /// Adds the tile to the sums of the picture, all but what is filtered.
    pub(crate) fn deliver(
        &self,
        area: &Area,
        size: [u32; 2],
        q: &Scratch,
        band: &mut [(Sum, &mut [f32])],
    ) {
        let width = size[0] as usize;
        for y in 0..area.height {
            let at = y * width + area.x;
            let depth = band.iter().find(|(sum, _)| *sum == Sum::Depth);
            let depth = depth.map_or(&[][..], |(_, depth)| &depth[at..at + area.width]);
            let nearer = q.planes.nearer(y * WIDTH, depth);
            for (sum, numbers) in band.iter_mut() {
                if self.is_filtered() && sum.is_filtered() {
                    continue;
                }
                let channels = sum.channels();
                let out = &mut numbers[at * channels..(at + area.width) * channels];
                q.planes.add_to(*sum, y * WIDTH, &nearer, out);
            }
        }
    }
}

/// A share of one material.
#[inline(always)]
fn whole<S: Simd>(m: &Material, at: &Place<Lanes<S>>, weight: Lanes<S>) -> LocalMaterial<Lanes<S>> {
    LocalMaterial {
        albedo: pattern_colour(&m.pattern, at) * weight,
        emission: constant(weight, m.emission.to_array()) * weight,
        specular: weight * m.specular,
        metallic: weight * m.metallic,
        roughness: weight * m.roughness,
    }
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
    fn sort_by_method(&mut self, methods: &[usize]) {
        let n = self.count;
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&i| method_of(methods, self.object[i]));
        let mut old = vec![0.0; n];
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
        let vectors = self
            .ray
            .iter_mut()
            .chain(&mut self.orbit)
            .chain(&mut self.point)
            .chain(&mut self.normal);
        for column in columns.into_iter().chain(marks).chain(vectors) {
            old.copy_from_slice(&column[..n]);
            for (to, &from) in column.iter_mut().zip(&order) {
                *to = old[from];
            }
        }
        let old = self.word[..n].to_vec();
        for (to, &from) in self.word.iter_mut().zip(&order) {
            *to = old[from];
        }
    }
}

/// Finds which objects and materials the hits belong to.
fn marks<S: Simd>(s: S, solid: &Solid<'_>, q: &mut Scratch) {
    for k in (0..q.hits.count).step_by(BATCH) {
        let n = (q.hits.count - k).min(BATCH);
        if solid.stop.before(n) {
            break;
        }
        let hits = &q.hits;
        let places = hits.point.iter().zip(&hits.normal);
        for (column, (x, normal)) in q.work.points_mut().iter_mut().zip(places) {
            for i in 0..n {
                let behind = MARKS_BEHIND * solid.view.rounding.at(hits.t[k + i]);
                column.0[i] = x[k + i] - normal[k + i] * behind;
            }
        }
        zeroset_eval::marks(s, solid.program.marks(), &mut q.work, n);
        q.counts.material += n as u64;
        let marks = q.work.marks();
        q.hits.object[k..k + n].copy_from_slice(&marks.object.0[..n]);
        q.hits.first[k..k + n].copy_from_slice(&marks.first.0[..n]);
        q.hits.second[k..k + n].copy_from_slice(&marks.second.0[..n]);
        q.hits.share[k..k + n].copy_from_slice(&marks.share.0[..n]);
        for (column, orbit) in q.hits.orbit.iter_mut().zip(&marks.orbit) {
            column[k..k + n].copy_from_slice(&orbit.0[..n]);
        }
    }
}
