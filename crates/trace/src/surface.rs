//! What the surface is at the hits: to which objects and materials they belong, and what these are made of there.

use crate::job::Job;
use crate::simd::{Sheet, load, load3, splat, store, store3};
use crate::tile::{Hits, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::{BATCH, Lane, Workspace};
use zeroset_number::{Lanes, Ops, Real, Vec3, v3};
use zeroset_scene::material::Material;
use zeroset_scene::settings::Shading;
use zeroset_shade::coat::{Coat, unmapped};
use zeroset_shade::march::MARKS_BEHIND;
use zeroset_shade::pattern::{Place, tame};
use zeroset_shade::surface::{BLURRED, LocalMaterial};

/// What a surface is made of, and its normal with the heights that it is shown with.
#[derive(Clone, Copy)]
struct Local<S: Simd> {
    what: LocalMaterial<Lanes<S>>,
    normal: Vec3<Lanes<S>>,
}

/// What the hits of a batch know of where they are.
struct Spaces<'w> {
    /// The places in the spaces of coats, for hits from `first` on.
    work: &'w Workspace,
    first: usize,
}

impl Spaces<'_> {
    /// A share of one coat at the hits from `i` on, which rays of direction `d` meet.
    #[inline(always)]
    fn local<S: Simd>(
        &self,
        s: S,
        coat: &Coat,
        i: usize,
        at: &Place<Lanes<S>>,
        d: Vec3<Lanes<S>>,
        weight: Lanes<S>,
    ) -> Local<S> {
        let (here, rows) = if coat.place == 0 {
            (*at, unmapped(at))
        } else {
            let lanes = self.work.place(coat.place);
            let k = i - self.first;
            let of =
                |lane: usize| Lanes(S::f32s::from_slice(s, &lanes[lane].0[k..][..S::f32s::LEN]));
            let point = v3(of(0), of(4), of(8));
            let rows = [
                tame(v3(of(1), of(2), of(3))),
                tame(v3(of(5), of(6), of(7))),
                tame(v3(of(9), of(10), of(11))),
            ];
            (at.mapped(point, rows), rows)
        };
        let what = coat.local(&here);
        Local {
            normal: coat.normal(at, &here, rows, d) * weight,
            what: LocalMaterial {
                albedo: what.albedo * weight,
                emission: what.emission * weight,
                specular: what.specular * weight,
                metallic: what.metallic * weight,
                roughness: what.roughness * weight,
                transmission: what.transmission * weight,
                shininess: what.shininess * weight,
            },
        }
    }
}

impl Job<'_> {
    pub(crate) fn material(&self, number: f32) -> &Material {
        &self.coat(number).material
    }

    fn coat(&self, number: f32) -> &Coat {
        let at = if number >= 0.0 {
            number as usize
        } else {
            usize::MAX
        };
        self.picture.coats.get(at).unwrap_or(&self.fallback)
    }

    /// What the surface is made of at the hits from `i` on: of each material that any of them has, as much as they have.
    #[inline(always)]
    fn local_material<S: Simd>(
        &self,
        s: S,
        hits: &Hits,
        spaces: &Spaces<'_>,
        i: usize,
        at: &Place<Lanes<S>>,
        d: Vec3<Lanes<S>>,
    ) -> Local<S> {
        if let Some(only) = self.picture.material {
            let coat = self.coat(f32::from(only));
            return spaces.local(s, coat, i, at, d, splat(s, 1.0));
        }
        let lanes = S::f32s::LEN.min(hits.count - i);
        let (first, second, share) = (
            load(s, &hits.first, i),
            load(s, &hits.second, i),
            load(s, &hits.share, i),
        );
        let mut sum: Option<Local<S>> = None;
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
            let part = spaces.local(s, self.coat(number), i, at, d, weight);
            sum = Some(match sum {
                None => part,
                Some(Local { what: all, normal }) => Local {
                    normal: normal + part.normal,
                    what: LocalMaterial {
                        albedo: all.albedo + part.what.albedo,
                        emission: all.emission + part.what.emission,
                        specular: all.specular + part.what.specular,
                        metallic: all.metallic + part.what.metallic,
                        roughness: all.roughness + part.what.roughness,
                        transmission: all.transmission + part.what.transmission,
                        shininess: all.shininess + part.what.shininess,
                    },
                },
            });
        }
        match sum {
            Some(all) => all,
            None => spaces.local(s, &self.fallback, i, at, d, splat(s, 1.0)),
        }
    }
}

/// Finds what the surface is made of at the hits, and the normals that it is shown with.
pub(crate) fn materials<S: Simd>(s: S, job: &Job<'_>, solid: &Solid<'_>, q: &mut Scratch) {
    for first in (0..q.hits.count).step_by(BATCH) {
        let n = (q.hits.count - first).min(BATCH);
        if !solid.program.coats().is_empty() {
            for (column, x) in q.work.points_mut().iter_mut().zip(&q.hits.point) {
                column.0[..n].copy_from_slice(&x[first..first + n]);
                // those behind must be numbers
                let last = column.0[n - 1];
                column.0[n..].fill(last);
            }
            zeroset_eval::places(s, solid.program.places(), &mut q.work, n);
        }
        let spaces = Spaces {
            work: &q.work,
            first,
        };
        batch_of_materials(s, job, solid, &spaces, first..first + n, &mut q.hits);
    }
}

fn batch_of_materials<S: Simd>(
    s: S,
    job: &Job<'_>,
    solid: &Solid<'_>,
    spaces: &Spaces<'_>,
    range: Range<usize>,
    hits: &mut Hits,
) {
    s.vectorize(
        #[inline(always)]
        || {
            // with more rays a pixel each stands for less of it
            let finer = 1.0 / (job.samples() as f32).sqrt();
            for i in range.step_by(S::f32s::LEN) {
                let ray = hits.ray(s, i);
                let pixel = solid.width(&ray, load(s, &hits.t, i)) * finer;
                let (point, normal) = (load3(s, &hits.point, i), load3(s, &hits.normal, i));
                let mut place = Place::new(point, normal, ray.direction, pixel);
                if job.picture.has_orbits {
                    let o = &hits.orbit;
                    place = place.with_orbit([
                        load(s, &o[0], i),
                        load(s, &o[1], i),
                        load(s, &o[2], i),
                        load(s, &o[3], i),
                    ]);
                }
                let local = job.local_material(s, hits, spaces, i, &place, ray.direction);
                hits.material.store(&local.what, i);
                let shown = if job.picture.has_bumps {
                    local.normal / local.normal.length().max(f32::MIN_POSITIVE)
                } else {
                    normal
                };
                store3(shown, &mut hits.shown, i);
            }
        },
    );
}

/// Finds which objects and materials the hits belong to.
pub(crate) fn marks<S: Simd>(s: S, solid: &Solid<'_>, q: &mut Scratch) {
    for k in (0..q.hits.count).step_by(BATCH) {
        let n = (q.hits.count - k).min(BATCH);
        if solid.stop.before(n) {
            break;
        }
        let hits = &q.hits;
        let places = hits.point.iter().zip(&hits.normal);
        let mut behind = Lane::ZERO;
        for i in (0..n).step_by(S::f32s::LEN) {
            let way = hits.ray(s, k + i).way(load(s, &hits.t, k + i));
            store(solid.view.rounding.at(way) * MARKS_BEHIND, &mut behind.0, i);
        }
        for (column, (x, normal)) in q.work.points_mut().iter_mut().zip(places) {
            for i in 0..n {
                column.0[i] = x[k + i] - normal[k + i] * behind.0[i];
            }
        }
        solid.marks(s, &mut q.work, n);
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

/// What the surface is made of at many hits, a column for each number.
pub(crate) struct MaterialColumns {
    pub(crate) albedo: [Box<Sheet>; 3],
    emission: [Box<Sheet>; 3],
    specular: Box<Sheet>,
    metallic: Box<Sheet>,
    roughness: Box<Sheet>,
    transmission: Box<Sheet>,
    shininess: Box<Sheet>,
}

impl MaterialColumns {
    pub(crate) fn new() -> MaterialColumns {
        let sheet3 = || [Sheet::boxed(), Sheet::boxed(), Sheet::boxed()];
        MaterialColumns {
            albedo: sheet3(),
            emission: sheet3(),
            specular: Sheet::boxed(),
            metallic: Sheet::boxed(),
            roughness: Sheet::boxed(),
            transmission: Sheet::boxed(),
            shininess: Sheet::boxed(),
        }
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, what: &LocalMaterial<Lanes<S>>, i: usize) {
        store3(what.albedo, &mut self.albedo, i);
        store3(what.emission, &mut self.emission, i);
        store(what.specular, &mut self.specular, i);
        store(what.metallic, &mut self.metallic, i);
        store(what.roughness, &mut self.roughness, i);
        store(what.transmission, &mut self.transmission, i);
        store(what.shininess, &mut self.shininess, i);
    }

    /// What those from number `i` on are made of.
    #[inline(always)]
    pub(crate) fn load<S: Simd>(&self, s: S, i: usize) -> LocalMaterial<Lanes<S>> {
        LocalMaterial {
            albedo: load3(s, &self.albedo, i),
            emission: load3(s, &self.emission, i),
            specular: load(s, &self.specular, i),
            metallic: load(s, &self.metallic, i),
            roughness: load(s, &self.roughness, i),
            transmission: load(s, &self.transmission, i),
            shininess: load(s, &self.shininess, i),
        }
    }

    /// How smooth those from number `i` on are for a light model: see [`zeroset_shade::light::response`].
    #[inline(always)]
    pub(crate) fn finish<S: Simd>(&self, s: S, shading: Shading, i: usize) -> Lanes<S> {
        let column = match shading {
            Shading::Phong => &self.shininess,
            Shading::Physical | Shading::Lambert | Shading::LambertLegacy => &self.roughness,
        };
        load(s, column, i)
    }

    /// Shows clear bodies as if they were none.
    pub(crate) fn make_opaque(&mut self, count: usize) {
        self.transmission[..count].fill(0.0);
    }

    /// Whether rays may go on from number `i`.
    pub(crate) fn goes_on(&self, i: usize) -> bool {
        self.roughness[i] < BLURRED || self.transmission[i] > 0.0
    }

    /// What number `i` is made of.
    pub(crate) fn get(&self, i: usize) -> LocalMaterial<f32> {
        let vector = |[x, y, z]: &[Box<Sheet>; 3]| v3(x[i], y[i], z[i]);
        LocalMaterial {
            albedo: vector(&self.albedo),
            emission: vector(&self.emission),
            specular: self.specular[i],
            metallic: self.metallic[i],
            roughness: self.roughness[i],
            transmission: self.transmission[i],
            shininess: self.shininess[i],
        }
    }
}
