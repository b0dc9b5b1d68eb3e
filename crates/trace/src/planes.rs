//! The planes of a tile, pixel by pixel, while its samples come in.

use crate::march::ORDINAL;
use crate::order::PLACE;
use crate::simd::Sheet;
use crate::tile::Hits;
use zeroset_scene::film::Plane;

/// The planes of a tile, row by row. Colour and coverage are those of the last sample; all others are sums over the samples, or belong to
/// the nearest hit.
pub(crate) struct Planes {
    pub(crate) colour: [Box<Sheet>; 3],
    pub(crate) coverage: Box<Sheet>,
    /// Where in their pixels the samples are.
    pub(crate) jitter: [Box<Sheet>; 2],
    /// Samples that hit.
    hits: Box<Sheet>,
    /// Of the nearest hit: distance, residual, object.
    depth: Box<Sheet>,
    residual: Box<Sheet>,
    object: Box<Sheet>,
    normal: [Box<Sheet>; 3],
    albedo: [Box<Sheet>; 3],
    occlusion: Box<Sheet>,
    shadow: Box<Sheet>,
    steps: Box<Sheet>,
}

impl Planes {
    pub(crate) fn new() -> Planes {
        let sheet3 = || [Sheet::boxed(), Sheet::boxed(), Sheet::boxed()];
        Planes {
            colour: sheet3(),
            coverage: Sheet::boxed(),
            jitter: [Sheet::boxed(), Sheet::boxed()],
            hits: Sheet::boxed(),
            depth: Sheet::boxed(),
            residual: Sheet::boxed(),
            object: Sheet::boxed(),
            normal: sheet3(),
            albedo: sheet3(),
            occlusion: Sheet::boxed(),
            shadow: Sheet::boxed(),
            steps: Sheet::boxed(),
        }
    }

    /// Makes ready for another tile.
    pub(crate) fn clear(&mut self) {
        let vectors = self.normal.iter_mut().chain(&mut self.albedo);
        let sums = [
            &mut self.hits,
            &mut self.occlusion,
            &mut self.shadow,
            &mut self.steps,
        ];
        let nearest = [&mut self.residual, &mut self.object];
        vectors
            .chain(sums)
            .chain(nearest)
            .for_each(|sheet| sheet.fill(0.0));
        self.depth.fill(f32::INFINITY);
    }

    /// Adds the hits of a sample, and the steps of the rays that hit nothing if they were counted.
    pub(crate) fn add(&mut self, hits: &Hits, missed: Option<&Sheet>) {
        for i in 0..hits.count {
            let at = usize::from(PLACE[(hits.word[i] & ORDINAL) as usize]);
            self.hits[at] += 1.0;
            for k in 0..3 {
                self.normal[k][at] += hits.normal[k][i];
                self.albedo[k][at] += hits.albedo[k][i];
            }
            self.occlusion[at] += hits.open[i];
            self.shadow[at] += hits.shadow[i];
            self.steps[at] += hits.steps[i];
            if hits.t[i] < self.depth[at] {
                self.depth[at] = hits.t[i];
                self.residual[at] = hits.residual[i].abs();
                self.object[at] = hits.object[i] + 1.0;
            }
        }
        if let Some(missed) = missed {
            for (&place, steps) in PLACE.iter().zip(missed.iter()) {
                self.steps[usize::from(place)] += steps;
            }
        }
    }

    /// Writes the pixels from `at` on, of which `rays` samples were taken each.
    pub(crate) fn write(&self, plane: Plane, at: usize, rays: f32, out: &mut [f32]) {
        // where nothing is hit, nothing is occluded or in shadow
        let mean = |sheet: &Sheet, i: usize| {
            if self.hits[i] > 0.0 {
                sheet[i] / self.hits[i]
            } else {
                1.0
            }
        };
        match plane {
            Plane::Colour => interleave(&self.colour, at, out, |c, _| c),
            Plane::Albedo => interleave(&self.albedo, at, out, |c, i| {
                c.map(|x| x / self.hits[i].max(1.0))
            }),
            Plane::Normal => interleave(&self.normal, at, out, |c, _| {
                let length = (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt();
                c.map(|x| x / length.max(f32::MIN_POSITIVE))
            }),
            Plane::Coverage => out.copy_from_slice(&self.coverage[at..at + out.len()]),
            Plane::Depth => out.copy_from_slice(&self.depth[at..at + out.len()]),
            Plane::Residual => out.copy_from_slice(&self.residual[at..at + out.len()]),
            Plane::Object => out.copy_from_slice(&self.object[at..at + out.len()]),
            Plane::Occlusion => out
                .iter_mut()
                .zip(at..)
                .for_each(|(x, i)| *x = mean(&self.occlusion, i)),
            Plane::Shadow => out
                .iter_mut()
                .zip(at..)
                .for_each(|(x, i)| *x = mean(&self.shadow, i)),
            Plane::Steps => out
                .iter_mut()
                .zip(at..)
                .for_each(|(x, i)| *x = self.steps[i] / rays),
        }
    }
}

fn interleave(
    sheets: &[Box<Sheet>; 3],
    at: usize,
    out: &mut [f32],
    f: impl Fn([f32; 3], usize) -> [f32; 3],
) {
    let (pixels, _) = out.as_chunks_mut::<3>();
    for (pixel, i) in pixels.iter_mut().zip(at..) {
        *pixel = f([sheets[0][i], sheets[1][i], sheets[2][i]], i);
    }
}
