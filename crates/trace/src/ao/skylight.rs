//! Skylight from the volume of a scene; where that ends, from the field.

use super::{batches, value};
use crate::normal::sample;
use crate::simd::{along, load, load3, splat, store, store3};
use crate::tile::{Hits, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::Lane;
use zeroset_number::{Lanes, Real, Vec3};
use zeroset_shade::occlusion::EVANS;
use zeroset_shade::skylight::{
    LEVELS, Reading, SkyVolume, bent, curved, light, per_voxel, split, way,
};

/// Finds how open hits are, where the sky is seen, and what colours its light has, as [`zeroset_shade::skylight`] says.
pub(super) fn skylight<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    volume: &SkyVolume,
    reading: &Reading,
    range: Range<usize>,
    q: &mut Scratch,
) {
    // of the samples of a batch: how much the volume says of each, and what it says
    let mut shares = Box::new(Lane::ZERO);
    let mut found = Box::new(Lane::ZERO);
    s.vectorize(
        #[inline(always)]
        || {
            for (k, n) in batches(range) {
                for sums in &mut q.hits.tint {
                    sums[k..k + n].fill(0.0);
                }
                for (level, weight) in EVANS.into_iter().enumerate() {
                    let far = reading.first * (1 << level) as f32;
                    let hits = &mut q.hits;
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let p = aimed(s, hits, reading, far, k + i);
                        let place = volume.place(p);
                        let share = volume.share(place);
                        store(share, &mut shares.0, i);
                        store(volume.distance(level, place), &mut found.0, i);
                        if volume.is_coloured && reading.bleed > 0.0 {
                            let near = volume.colour(level, place) * (share * reading.bleed);
                            let sums = load3(s, &hits.tint, k + i) + near * weight;
                            store3(sums, &mut hits.tint, k + i);
                        }
                    }
                    let ends = shares.0[..n].iter().any(|share| *share < 1.0);
                    if ends {
                        let hits = &q.hits;
                        sample(
                            s,
                            solid,
                            n,
                            &mut q.work,
                            #[inline(always)]
                            |i| aimed(s, hits, reading, far, k + i),
                        );
                        q.counts.occlusion += n as u64;
                    }
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let mut f = load(s, &found.0, i);
                        if ends {
                            f = value(s, q, k, i).mix(f, load(s, &shares.0, i));
                        }
                        let more = (f - far) * weight;
                        let sums = load3(s, &q.hits.tint, k + i);
                        store3(sums + Vec3::splat(more), &mut q.hits.tint, k + i);
                    }
                }
                let hits = &mut q.hits;
                for i in (k..k + n).step_by(S::f32s::LEN) {
                    let (open, tint) = split(light(load3(s, &hits.tint, i), reading.scale));
                    let normal = load3(s, &hits.normal, i);
                    store(open, &mut hits.open, i);
                    store3(tint, &mut hits.tint, i);
                    store3(bent(normal, way(normal, reading.bend)), &mut hits.bent, i);
                }
            }
        },
    );
}

/// Shows how a surface bends, from what a mip is off there: see [`curved`]. Where the volume ends nothing is off.
pub(super) fn curvature<S: Simd>(
    s: S,
    volume: &SkyVolume,
    level: usize,
    strength: f32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    let level = level.min(LEVELS - 1);
    let per = per_voxel(strength, volume.extent.voxel, level);
    s.vectorize(
        #[inline(always)]
        || {
            for i in range.step_by(S::f32s::LEN) {
                let place = volume.place(load3(s, &q.hits.point, i));
                let off = volume.distance(level, place) * volume.share(place);
                store(curved(off, per), &mut q.hits.open, i);
            }
        },
    );
}

/// The sample so far along the ways of the hits from number `i` on.
#[inline(always)]
fn aimed<S: Simd>(s: S, hits: &Hits, reading: &Reading, far: f32, i: usize) -> Vec3<Lanes<S>> {
    let way = way(load3(s, &hits.normal, i), reading.bend);
    along(load3(s, &hits.point, i), way, splat(s, far))
}
