//! The planes of a tile, pixel by pixel, while its samples come in.

use crate::march::ORDINAL;
use crate::order::PLACE;
use crate::paths::PathState;
use crate::simd::Sheet;
use crate::tile::{Hits, WIDTH};
use zeroset_scene::accumulator::Sum;

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

    /// Adds the hits of rays from the eye, and the steps of those that hit nothing if they were counted. `state` says of each ray, by
    /// its number, what it shows.
    pub(crate) fn add(
        &mut self,
        hits: &Hits,
        state: impl Fn(usize) -> PathState,
        missed: Option<&Sheet>,
    ) {
        for i in 0..hits.count {
            let state = state((hits.word[i] & ORDINAL) as usize);
            if !state.is_from_eye {
                continue;
            }
            let (at, share) = (usize::from(PLACE[state.pixel]), state.weight.x);
            self.hits[at] += share;
            for k in 0..3 {
                self.normal[k][at] += hits.normal[k][i] * share;
                self.albedo[k][at] += hits.material.albedo[k][i] * share;
            }
            self.occlusion[at] += hits.open[i] * share;
            self.shadow[at] += hits.shadow[i] * share;
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

    /// All samples count so many times.
    pub(crate) fn weigh(&mut self, times: f32) {
        let vectors = self.normal.iter_mut().chain(&mut self.albedo);
        let sums = [
            &mut self.hits,
            &mut self.occlusion,
            &mut self.shadow,
            &mut self.steps,
        ];
        for sheet in vectors.chain(sums) {
            sheet.iter_mut().for_each(|x| *x *= times);
        }
    }

    /// Which pixels of the row that begins at `at` were hit nearer than these depths.
    pub(crate) fn nearer(&self, at: usize, depths: &[f32]) -> [bool; WIDTH] {
        let mut nearer = [false; WIDTH];
        for ((nearer, own), held) in nearer.iter_mut().zip(&self.depth[at..]).zip(depths) {
            *nearer = own < held;
        }
        nearer
    }

    /// Adds the pixels from `at` on to a sum. `nearer` says which of them are nearer than what it holds.
    pub(crate) fn add_to(&self, sum: Sum, at: usize, nearer: &[bool; WIDTH], out: &mut [f32]) {
        let nearest = |sheet: &Sheet, out: &mut [f32]| {
            for ((x, own), nearer) in out.iter_mut().zip(&sheet[at..]).zip(nearer) {
                if *nearer {
                    *x = *own;
                }
            }
        };
        let plus = |sheet: &Sheet, out: &mut [f32]| {
            out.iter_mut()
                .zip(&sheet[at..])
                .for_each(|(x, own)| *x += own);
        };
        let plus3 = |[x, y, z]: &[Box<Sheet>; 3], out: &mut [f32]| {
            let pixels = out.as_chunks_mut::<3>().0;
            let (x, y, z) = (
                &x[at..][..pixels.len()],
                &y[at..][..pixels.len()],
                &z[at..][..pixels.len()],
            );
            for (i, pixel) in pixels.iter_mut().enumerate() {
                pixel[0] += x[i];
                pixel[1] += y[i];
                pixel[2] += z[i];
            }
        };
        match sum {
            Sum::Colour => plus3(&self.colour, out),
            Sum::Coverage => plus(&self.coverage, out),
            Sum::Weight => out.iter_mut().for_each(|x| *x += 1.0),
            Sum::Hits => plus(&self.hits, out),
            Sum::Depth => nearest(&self.depth, out),
            Sum::Normal => plus3(&self.normal, out),
            Sum::Albedo => plus3(&self.albedo, out),
            Sum::Occlusion => plus(&self.occlusion, out),
            Sum::Shadow => plus(&self.shadow, out),
            Sum::Steps => plus(&self.steps, out),
            Sum::Residual => nearest(&self.residual, out),
            Sum::Object => nearest(&self.object, out),
        }
    }
}
