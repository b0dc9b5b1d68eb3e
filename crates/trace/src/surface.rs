//! What the surface is at the hits: to which objects and materials they belong, and what these are made of there.

use crate::job::Job;
use crate::simd::{constant, load, splat, store};
use crate::tile::{Hits, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_eval::{BATCH, Lane};
use zeroset_number::{Lanes, Ops, Real};
use zeroset_scene::material::Material;
use zeroset_shade::march::MARKS_BEHIND;
use zeroset_shade::pattern::{Place, colour as pattern_colour};
use zeroset_shade::surface::LocalMaterial;

impl Job<'_> {
    pub(crate) fn material(&self, number: f32) -> &Material {
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
    pub(crate) fn shininess<S: Simd>(&self, s: S, hits: &Hits, i: usize) -> Lanes<S> {
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
    pub(crate) fn local_material<S: Simd>(
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
