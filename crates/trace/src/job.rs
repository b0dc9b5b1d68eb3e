//! What is done for a tile: the stages, sample by sample.

use crate::closed::{land, limit};
use crate::closest::{Plan, closest};
use crate::integrator::{Direct, Integrator, TileSample};
use crate::lamps::shine_before;
use crate::march::ORDINAL;
use crate::normal::{normals, place};
use crate::order::{self, PLACE};
use crate::path::PathTracer;
use crate::paths::{PathRay, PathState};
use crate::renderer::{Beside, Done, PreparedScene};
use crate::simd::{first_lanes, load, splat, store, store3};
use crate::stop::Stop;
use crate::surface::marks;
use crate::tile::{Area, HEIGHT, Scratch, Solid, WIDTH};
use crate::whitted::Whitted;
use crate::{cone, coverage, primary, resolve};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Vec3, v3};
use zeroset_scene::accumulator::{Accumulator, Sum};
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::material::Material;
use zeroset_scene::progressive::{MOST, SampleMap};
use zeroset_scene::settings::{self, Antialias, Filter};
use zeroset_shade::air::behind;
use zeroset_shade::coat::Coat;
use zeroset_shade::light::discs;
use zeroset_shade::sampling::{LENS, decided, hit_seed, point, scramble};
use zeroset_shade::sky::SkyColours;
use zeroset_shade::view::View;

/// All that tiles of one rendering have in common.
pub(crate) struct Job<'a> {
    pub(crate) picture: &'a PreparedScene,
    view: View,
    wanted: [bool; Plane::ALL.len()],
    /// Samples a pixel of the finished picture, and their filter.
    samples: Option<(u32, Filter)>,
    /// Edges that may part a pixel, where its parts are looked for.
    layers: Option<u32>,
    /// Those that are taken now.
    taken: Range<u32>,
    /// How many of them in each tile, where that differs.
    map: Option<&'a SampleMap>,
    plan: Plan,
    /// What is marched beside solids in closed form, where rays begin outside everything.
    beside: Option<&'a Beside>,
    /// Whether the marks of hits differ and are needed.
    marks: bool,
    /// What a surface without a material is made of.
    pub(crate) fallback: Coat,
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
        let view = View::new(camera, into.size(), settings.footprint);
        // the cones of coverage look at all edges, those of floors too
        let beside = match into.antialias() {
            Antialias::Coverage { .. } => None,
            Antialias::None | Antialias::Supersample { .. } => picture.beside(&view),
        };
        Job {
            picture,
            view,
            beside,
            wanted,
            samples,
            layers: match into.antialias() {
                Antialias::Coverage { layers } => Some(layers),
                Antialias::None | Antialias::Supersample { .. } => None,
            },
            taken,
            map: None,
            plan: Plan {
                march: settings.march,
                select: settings.hit_selection,
                steps: wanted[Plane::Steps as usize],
            },
            marks: picture.material.is_none()
                || picture.has_orbits
                || (objects && picture.object.is_none()),
            fallback: Coat::new(&Material::default(), 0),
        }
    }

    /// Whether pixels are made of several samples.
    pub(crate) fn is_filtered(&self) -> bool {
        self.samples.is_some()
    }

    /// Whether rays begin all over a lens: one ray a pixel goes through its middle.
    fn has_lens(&self) -> bool {
        self.view.aperture > 0.0 && self.is_filtered()
    }

    /// Samples a pixel of the finished picture.
    pub(crate) fn samples(&self) -> u32 {
        self.samples.map_or(1, |(n, _)| n)
    }

    /// With the first samples only, as many as there are for each tile, which count together as [`MOST`] do.
    pub(crate) fn spread(self, map: &'a SampleMap) -> Job<'a> {
        Job {
            map: Some(map),
            ..self
        }
    }

    /// Rays from the eye that are taken now.
    pub(crate) fn rays(&self, size: [u32; 2]) -> u64 {
        let even = || u64::from(size[0]) * u64::from(size[1]) * self.taken.len() as u64;
        self.map.map_or_else(even, SampleMap::rays)
    }

    pub(crate) fn wants(&self, plane: Plane) -> bool {
        self.wanted[plane as usize]
    }

    /// Renders tile number `k` into the scratch memory; where samples are filtered, their colours into `sums`.
    pub(crate) fn tile<S: Simd>(
        &self,
        s: S,
        k: usize,
        area: &Area,
        sums: &mut [f32],
        q: &mut Scratch,
        stop: &Stop<'_>,
    ) -> Done {
        let solid = Solid::new(
            self.picture.field(),
            self.picture.region,
            &self.view,
            self.picture.scene.settings().max_steps,
            self.picture.skins,
            self.samples(),
            stop,
        );
        let beside = self.beside.map(|beside| beside.solid(&solid, self));
        let marched = beside.as_ref().unwrap_or(&solid);
        q.planes.clear();
        q.shared.clear();
        let mut hits = 0;
        let taken = match self.map {
            Some(map) => 0..map.count(k),
            None => self.taken.clone(),
        };
        for index in taken.clone() {
            if stop.is_set() {
                break;
            }
            self.aim(area, index, q);
            let sample = TileSample {
                job: self,
                solid: &solid,
                marched,
                area,
                index,
            };
            hits += self.trace(s, &sample, q);
            if stop.is_set() {
                // what was found is not all: it must not reach the pixels of the tiles around
                break;
            }
            if let Some((_, filter)) = self.samples {
                resolve::splat_samples(s, filter, area, &q.planes, sums);
            }
        }
        if self.map.is_some() {
            let times = MOST as f32 / taken.len() as f32;
            sums.iter_mut().for_each(|x| *x *= times);
            q.planes.weigh(times);
        }
        let rays = (area.width * area.height) as u64 * taken.len() as u64;
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
        let has_lens = self.has_lens();
        for i in 0..WIDTH * HEIGHT {
            let key = scramble(
                area.x as u32 + order::X[i] as u32,
                area.y as u32 + order::Y[i] as u32,
                seed,
            );
            let place = point(index, key);
            if has_lens {
                let key = scramble(
                    area.x as u32 + order::X[i] as u32,
                    area.y as u32 + order::Y[i] as u32,
                    hit_seed(seed, 0),
                );
                let [u, v] = decided(index, key, LENS);
                (q.lens[0][i], q.lens[1][i]) = (u, v);
            }
            for k in 0..2 {
                q.jitter[k][i] = place[k];
                q.planes.jitter[k][usize::from(PLACE[i])] = place[k];
            }
        }
    }

    /// Finds what the rays hit and the light that comes from there. Gives the number of hits.
    fn trace<S: Simd>(&self, s: S, sample: &TileSample<'_>, q: &mut Scratch) -> u64 {
        let TileSample {
            solid,
            marched,
            area,
            index,
            ..
        } = *sample;
        let settings = self.picture.scene.settings();
        if index == self.taken.start && !self.has_lens() {
            let spread = self.samples.is_some() || self.layers.is_some();
            let reach = if spread { 0.5 } else { 0.0 };
            cone::prepass(
                s,
                marched,
                area,
                reach,
                settings.prepass.then_some(settings.march),
                q,
            );
        }
        if self.plan.steps {
            q.steps.fill(0.0);
        }
        if self.has_lens() {
            let places = [&q.jitter, &q.lens];
            primary::aim_lens(s, marched, area, places, &mut q.queue);
        } else {
            primary::aim(s, solid.view, area, &q.jitter, &mut q.queue);
        }
        match self.layers {
            Some(layers) => coverage::part(s, solid, area, layers, q),
            None => q.paths.begin(),
        }
        follow(
            s,
            &self.plan,
            marched,
            q,
            #[inline(always)]
            |i| {
                // what a tile has beyond the edge of the picture is not there
                let (x, y) = (load(s, &order::X, i), load(s, &order::Y, i));
                x.below(area.width as f32) & y.below(area.height as f32)
            },
        );
        self.surfaces(s, solid, self.wants(Plane::Residual), q);
        self.identify(s, solid, q);
        let hits = q.hits.count as u64;
        match settings.integrator {
            settings::Integrator::Direct => self.light(s, &Direct, sample, q),
            settings::Integrator::Whitted {
                reflections,
                refractions,
            } => {
                let whitted = Whitted {
                    reflections,
                    refractions,
                };
                self.light(s, &whitted, sample, q);
            }
            settings::Integrator::Path { depth, .. } => {
                self.light(s, &PathTracer { depth }, sample, q);
            }
        }
        hits
    }

    /// Finds the light that comes back along the rays of a sample, from the hits at hand and by all rays that go on from there, and
    /// puts it in the pixels.
    fn light<S: Simd>(
        &self,
        s: S,
        integrator: &impl Integrator,
        sample: &TileSample<'_>,
        q: &mut Scratch,
    ) {
        let (solid, plan) = (
            sample.solid,
            Plan {
                steps: false,
                ..self.plan
            },
        );
        integrator.integrate(s, sample, q);
        shine_before(self, q);
        self.gather(s, sample.area, q);
        // the spans of the rays from the eye are those of the next sample too
        std::mem::swap(&mut q.queue.spans, &mut q.next);
        let [within, marked] = [&self.picture.inside, &self.picture.inside_marks].map(|program| {
            let program = program.as_ref()?;
            Some(Solid {
                program,
                cells: None,
                ..*solid
            })
        });
        while !solid.stop.is_set()
            && let Some(inside) = q.paths.next(solid, sample.marched, &mut q.queue)
        {
            let field = within.as_ref().filter(|_| inside).unwrap_or(solid);
            // rays inside clear bodies are among all that there is
            let marched = if inside { field } else { sample.marched };
            follow(s, &plan, marched, q, |_| first_lanes(s, S::f32s::LEN));
            self.surfaces(s, field, false, q);
            let marked = marked.as_ref().filter(|_| inside).unwrap_or(solid);
            self.identify(s, marked, q);
            integrator.integrate(s, sample, q);
            self.add_onward(q);
        }
        std::mem::swap(&mut q.queue.spans, &mut q.next);
    }

    /// Adds the light that rays brought which went on, to the pixels that they come from.
    fn add_onward(&self, q: &mut Scratch) {
        let most = match self.picture.scene.settings().integrator {
            settings::Integrator::Path { clamp, .. } => clamp,
            settings::Integrator::Whitted { .. } | settings::Integrator::Direct => None,
        };
        let (colour, coverage) = (&mut q.planes.colour, &mut q.planes.coverage);
        let mut add = |state: &PathState, light: Vec3<f32>| {
            let light = match most {
                Some(most) if !state.is_from_eye => {
                    light * (most / light.max_component().max(1e-30)).min(1.0)
                }
                _ => light,
            };
            let at = usize::from(PLACE[state.pixel]);
            for (column, x) in colour.iter_mut().zip(light.array()) {
                column[at] += x;
            }
        };
        for i in 0..q.hits.count {
            let number = (q.hits.word[i] & ORDINAL) as usize;
            q.paths.meets(number);
            let [r, g, b] = &q.hits.colour;
            let state = q.paths.state(number);
            let ray = q.hits.rays.get(&q.hits.common, i);
            let glow = self.glow(&ray, &state, q.hits.t[i]);
            add(&state, state.weight.times(v3(r[i], g[i], b[i]) + glow));
            if state.is_from_eye {
                coverage[usize::from(PLACE[state.pixel])] += state.weight.x;
            }
        }
        let scene = &self.picture.scene;
        let sky = SkyColours::of(scene.sky());
        for PathRay { ray, state, .. } in q.paths.missed() {
            // what lights the scene, or what is seen
            let share = if state.is_scattered { sky.ambient } else { 1.0 };
            let mut seen = self.sky_seen(ray, state.is_from_eye, state.density) * share;
            if state.sees_lights {
                seen = seen + discs(scene.lights(), ray.direction);
            }
            seen = seen + self.glow(ray, state, f32::INFINITY);
            add(state, state.weight.times(seen));
        }
        if self.layers.is_some() && self.wants_surface() {
            (q.planes).add(&q.hits, |number| q.paths.state(number), None);
        }
    }

    /// Finds the places of the hits at hand, and their normals.
    fn surfaces<S: Simd>(&self, s: S, solid: &Solid<'_>, residual: bool, q: &mut Scratch) {
        let settings = self.picture.scene.settings();
        place(s, solid, settings.discontinuity_reduction, residual, q);
        normals(s, solid, settings.normals, q);
    }

    /// Finds the objects and the materials of the hits at hand.
    fn identify<S: Simd>(&self, s: S, solid: &Solid<'_>, q: &mut Scratch) {
        if self.marks {
            marks(s, solid, q);
            return;
        }
        let (object, material) = (
            self.picture.object.unwrap_or(0),
            self.picture.material.unwrap_or(0),
        );
        let n = q.hits.count;
        q.hits.object[..n].fill(f32::from(object));
        q.hits.first[..n].fill(f32::from(material));
        q.hits.share[..n].fill(0.0);
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
        for (pixel, share) in q.paths.parted() {
            let at = usize::from(PLACE[pixel]);
            let columns = planes.colour.iter_mut().chain([&mut planes.coverage]);
            columns.for_each(|column| column[at] *= share);
        }
        if self.wants_surface() {
            let missed = self.plan.steps.then_some(&*q.steps);
            planes.add(hits, |number| q.paths.state(number), missed);
        }
    }

    /// Whether anything but colour and coverage is wanted.
    fn wants_surface(&self) -> bool {
        let is_surface = |p: &Plane| !matches!(p, Plane::Colour | Plane::Coverage);
        Plane::ALL.iter().any(|p| is_surface(p) && self.wants(*p))
    }

    /// Fills the tile with the sky. (Its colours are so smooth that the middle of a pixel does for all its samples.)
    fn background<S: Simd>(&self, s: S, area: &Area, q: &mut Scratch) {
        let sky = SkyColours::of(self.picture.scene.sky());
        let air = &self.picture.air;
        if self.has_lens() || self.picture.meets_lights() {
            // a place of the picture shows many directions, or what has edges
            for i in 0..q.queue.count {
                let ray = q.queue.rays.get(&q.queue.common, i);
                let eye = PathState::from_eye(i, 1.0);
                let seen = self.sky_seen(&ray, true, None);
                let seen = (seen + self.glow(&ray, &eye, f32::INFINITY)).array();
                let at = usize::from(PLACE[i]);
                for (column, x) in q.planes.colour.iter_mut().zip(seen) {
                    column[at] = x;
                }
                q.planes.coverage[at] = 0.0;
            }
            return;
        }
        // but for the edge of the sun
        let has_edge = air.cosine <= 1.0 && self.is_filtered();
        s.vectorize(
            #[inline(always)]
            || {
                let ramp = Lanes(S::f32s::from_fn(
                    s,
                    #[inline(always)]
                    |k| k as f32,
                ));
                for y in 0..area.height {
                    let top = (area.y + y) as f32;
                    for x in (0..area.width).step_by(S::f32s::LEN) {
                        let (at, left) = (y * WIDTH + x, (area.x + x) as f32);
                        let [u, v] = if has_edge {
                            let [u, v] = &q.planes.jitter;
                            [load(s, u, at), load(s, v, at)]
                        } else {
                            [splat(s, 0.5), splat(s, 0.5)]
                        };
                        let ray = primary::ray(&self.view, ramp + left + u, v + top);
                        let sky = behind(&sky, air, ray.origin.y, ray.direction, true);
                        store3(sky, &mut q.planes.colour, y * WIDTH + x);
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

/// Finds what the rays of the queue meet first. `exists` says which of them are there.
fn follow<S: Simd>(
    s: S,
    plan: &Plan,
    solid: &Solid<'_>,
    q: &mut Scratch,
    exists: impl Fn(usize) -> LaneMask<S>,
) {
    if !solid.closed.is_empty() {
        limit(s, solid.closed, solid, &mut q.queue, exists);
    }
    let (queue, memory) = q.split();
    q.counts.march += closest(s, plan, solid, queue, memory);
    let steps = plan.steps.then_some(&*q.steps);
    land(s, &mut q.queue, steps, &mut q.hits);
}
