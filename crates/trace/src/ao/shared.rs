//! Occlusion once for several samples of a pixel, where they lie on one surface: it changes slowly there, and costs more than all else.

use crate::march::ORDINAL;
use crate::simd::TILE_RAYS;
use crate::tile::{Hits, Solid};
use zeroset_number::Vec3;

/// Samples that share what the first of them found. (Their numbers decide, not which are taken together: so the picture does not depend
/// on that, but for where it begins.)
pub(crate) const GROUP: u32 = 4;

/// The least cosine between the normals of two samples that share their occlusion.
const ALIKE: f32 = 0.985;
/// How far one may lie from the surface through the other, in widths of a pixel.
const FLAT: f32 = 0.5;

/// What the first sample of a group found at its hit.
#[derive(Clone, Copy)]
struct Found {
    object: f32,
    point: Vec3<f32>,
    normal: Vec3<f32>,
    open: f32,
    bent: [f32; 3],
}

/// The occlusion of the samples of a tile's pixels.
pub(crate) struct SharedOcclusion {
    /// Which samples share it, by the number of their group.
    group: Option<u32>,
    /// By number of the pixel.
    found: Vec<Option<Found>>,
    /// Which hits are given what is found already.
    given: Vec<bool>,
}

impl SharedOcclusion {
    pub(crate) fn new() -> SharedOcclusion {
        SharedOcclusion {
            group: None,
            found: vec![None; TILE_RAYS],
            given: vec![false; TILE_RAYS],
        }
    }

    /// Begins another tile.
    pub(crate) fn clear(&mut self) {
        self.group = None;
    }

    /// Finds which hits of sample number `index` are given what the first of its group found. Gives how many.
    pub(crate) fn look_up(&mut self, solid: &Solid<'_>, index: u32, hits: &Hits) -> usize {
        self.given[..hits.count].fill(false);
        if self.group != Some(index / GROUP) || index.is_multiple_of(GROUP) {
            return 0;
        }
        let mut count = 0;
        for i in 0..hits.count {
            let Some(found) = &self.found[(hits.word[i] & ORDINAL) as usize] else {
                continue;
            };
            if found.object != hits.object[i] || found.normal.dot(hits.normal(i)) < ALIKE {
                continue;
            }
            let ray = hits.rays.get(&hits.common, i);
            let width = solid.width(&ray, hits.t[i]) * FLAT;
            let to = hits.point(i) - found.point;
            let beside = to.dot(found.normal).abs().max(to.dot(hits.normal(i)).abs());
            self.given[i] = beside <= width;
            count += usize::from(self.given[i]);
        }
        count
    }

    /// Whether hit number `i` is given what is found already.
    pub(crate) fn is_given(&self, i: usize) -> bool {
        self.given[i]
    }

    /// Gives the hits of a range what is found already.
    pub(crate) fn give(&self, hits: &mut Hits, range: std::ops::Range<usize>) {
        for i in range {
            if let Some(found) = &self.found[(hits.word[i] & ORDINAL) as usize] {
                hits.open[i] = found.open;
                // nothing is known to be empty
                hits.ball[i] = 0.0;
                for tint in &mut hits.tint {
                    tint[i] = 1.0;
                }
                for (bent, x) in hits.bent.iter_mut().zip(found.bent) {
                    bent[i] = x;
                }
            }
        }
    }

    /// Keeps what sample number `index` found, if it is the first of its group.
    pub(crate) fn keep(&mut self, index: u32, hits: &Hits) {
        if !index.is_multiple_of(GROUP) {
            return;
        }
        self.group = Some(index / GROUP);
        self.found.fill(None);
        for i in 0..hits.count {
            let [x, y, z] = &hits.bent;
            self.found[(hits.word[i] & ORDINAL) as usize] = Some(Found {
                object: hits.object[i],
                point: hits.point(i),
                normal: hits.normal(i),
                open: hits.open[i],
                bent: [x[i], y[i], z[i]],
            });
        }
    }
}
