//! Ambient occlusion: how much of the sky reaches the hits. All methods of the papers, and cones as the default.

mod cones;
mod hemisphere;
mod samples;
mod shared;
mod skylight;

pub(crate) use shared::SharedOcclusion;

use crate::shadow::Hard;
use crate::simd::{load, load_words, sided};
use crate::tile::{Scratch, Solid};
use fearless_simd::Simd;
use std::ops::Range;
use zeroset_eval::BATCH;
use zeroset_number::Lanes;
use zeroset_scene::settings::Occlusion;
use zeroset_shade::skylight::{SkyVolume, reading};

/// Finds the ambient visibility and the bent normals of the hits of the range. `sky`: the volume of the scene, where any of its methods
/// reads it.
pub(crate) fn occlusion<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    method: Occlusion,
    sky: Option<&SkyVolume>,
    range: Range<usize>,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            q.hits.open[range.clone()].fill(1.0);
            q.hits.ball[range.clone()].fill(0.0);
            for k in 0..3 {
                q.hits.tint[k][range.clone()].fill(1.0);
                q.hits.bent[k][range.clone()].copy_from_slice(&q.hits.normal[k][range.clone()]);
            }
        },
    );
    match method {
        Occlusion::None => {}
        Occlusion::Quilez { steps, step, scale } => {
            samples::quilez(s, solid, steps, step, scale, range, q)
        }
        Occlusion::Bent {
            steps,
            step,
            scale,
            bend,
        } => samples::bent(s, solid, steps, step, scale, bend, range, q),
        Occlusion::Evans { scale, step, bend } => {
            samples::evans(s, solid, scale, step, bend, range, q)
        }
        Occlusion::Skylight { .. } => {
            if let Some(volume) = sky
                && let Some(reading) = reading(&method, volume.extent.voxel)
            {
                skylight::skylight(s, solid, volume, &reading, range, q);
            }
        }
        Occlusion::Curvature { blur, strength, .. } => {
            if let Some(volume) = sky {
                skylight::curvature(s, volume, blur as usize, strength, range, q);
            }
        }
        Occlusion::Upward { scale } => samples::upward(s, scale, range, q),
        Occlusion::Cones { reach, steps } => cones::cones(s, solid, reach, steps, range, q),
        Occlusion::Hemisphere { rays, reach } => {
            hemisphere::hemisphere(s, solid, Hard, rays, reach, range, q)
        }
        Occlusion::Obscurance { rays, reach, tau } => {
            hemisphere::hemisphere(s, solid, hemisphere::Near { tau }, rays, reach, range, q)
        }
    }
}

/// Batches of a range: where each begins, and its size.
fn batches(range: Range<usize>) -> impl Iterator<Item = (usize, usize)> {
    range
        .clone()
        .step_by(BATCH)
        .map(move |k| (k, (range.end - k).min(BATCH)))
}

/// The value of the field at the sample, from the side of its hit.
#[inline(always)]
fn value<S: Simd>(s: S, q: &Scratch, k: usize, i: usize) -> Lanes<S> {
    sided(
        load(s, &q.work.values().0, i),
        load_words(s, &q.hits.word, k + i),
    )
}
