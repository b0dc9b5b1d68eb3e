//! Occlusion from samples of the field along one way: the methods of the papers that are made for speed.

use super::{batches, value};
use crate::normal::sample;
use crate::simd::{
    Chosen, along, first_lanes, load, load_words, load3, sided, splat, splat3, store,
};
use crate::tile::{Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::BATCH;
use zeroset_number::{Lanes, Ops, Real};
use zeroset_shade::occlusion::{
    BENT_FALL, EVANS, QUILEZ_FALL, UP, exponential_visibility, slant, visibility,
};

/// Occlusion less than this is none: no picture can show it.
const NOTHING: f32 = 1.0 / 4096.0;

/// `1 - clamp(scale sum_k 2^-k (k dt - f(x + k dt n)), 0, 1)` (Tomczak 2012, algorithm 3.4 with the sum of equation 3.31).
///
/// No sample can be closer to a surface than the farthest one plus the way between them, so every term is at most as large
/// as the farthest sample's shortfall: where that is nothing, one sample is enough.
pub(super) fn quilez<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    steps: u32,
    step: f32,
    scale: f32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            let far = steps as f32 * step;
            for (k, n) in batches(range.clone()) {
                let hits = &q.hits;
                sample(
                    s,
                    solid,
                    n,
                    &mut q.work,
                    #[inline(always)]
                    |i| {
                        along(
                            load3(s, &hits.point, k + i),
                            load3(s, &hits.normal, k + i),
                            splat(s, far),
                        )
                    },
                );
                q.counts.occlusion += n as u64;
                for i in (0..n).step_by(S::f32s::LEN) {
                    let f = value(s, q, k, i);
                    store(-(f - far), &mut q.hits.open, k + i);
                    let radius = -(load(s, &q.hits.offset, k + i) - far);
                    store(
                        Lanes::select(f.below(radius), splat(s, 0.0), radius.max(0.0)),
                        &mut q.hits.ball,
                        k + i,
                    );
                }
            }
            if steps < 2 {
                finish(s, scale * QUILEZ_FALL, range.clone(), q);
                return;
            }
            q.secondary.count = 0;
            for at in range.clone().step_by(S::f32s::LEN) {
                let (hits, rays) = (&mut q.hits, &mut *q.secondary);
                let short = load(s, &hits.open, at);
                let more =
                    Chosen::new((short * scale).above(NOTHING) & first_lanes(s, range.end - at));
                store(splat(s, 1.0), &mut hits.open, at);
                if more.none() {
                    continue;
                }
                let b = rays.count;
                more.put3(load3(s, &hits.point, at), &mut rays.origin, b);
                more.put3(load3(s, &hits.normal, at), &mut rays.direction, b);
                more.put(short * QUILEZ_FALL.powi(steps as i32), &mut rays.light, b);
                let side = load_words(s, &hits.word, at) & crate::simd::INSIDE;
                let ordinal = S::u32s::from_fn(
                    s,
                    #[inline(always)]
                    |k| (at + k) as u32,
                );
                more.put_words(ordinal | side, &mut rays.word, b);
                rays.count += more.count;
                if rays.count + S::f32s::LEN > BATCH {
                    nearer(s, solid, steps, step, scale, q);
                }
            }
            if q.secondary.count > 0 {
                nearer(s, solid, steps, step, scale, q);
            }
        },
    );
}

/// The nearer samples of [`quilez`], for the hits that need them.
#[inline(always)]
fn nearer<S: Simd>(s: S, solid: &Solid<'_>, steps: u32, step: f32, scale: f32, q: &mut Scratch) {
    let n = q.secondary.count;
    for k in 1..steps {
        let (far, rays) = (k as f32 * step, &*q.secondary);
        sample(
            s,
            solid,
            n,
            &mut q.work,
            #[inline(always)]
            |i| {
                along(
                    load3(s, &rays.origin, i),
                    load3(s, &rays.direction, i),
                    splat(s, far),
                )
            },
        );
        q.counts.occlusion += n as u64;
        let weight = QUILEZ_FALL.powi(k as i32);
        for i in (0..n).step_by(S::f32s::LEN) {
            let f = sided(
                load(s, &q.work.values().0, i),
                load_words(s, &q.secondary.word, i),
            );
            let sum = load(s, &q.secondary.light, i) - (f - far) * weight;
            store(sum, &mut q.secondary.light, i);
        }
    }
    for (&word, &sum) in q.secondary.word[..n].iter().zip(&q.secondary.light[..n]) {
        q.hits.open[(word & crate::march::ORDINAL) as usize] = visibility(sum, scale);
    }
    q.secondary.count = 0;
}

/// [`visibility`] of the sums that are in place of the visibility.
#[inline(always)]
fn finish<S: Simd>(s: S, scale: f32, range: Range<usize>, q: &mut Scratch) {
    for i in range.step_by(S::f32s::LEN) {
        let sum = load(s, &q.hits.open, i);
        store(visibility(sum, scale), &mut q.hits.open, i);
    }
}

/// `1 - clamp(scale sum_k 1.1^-k (|n| k dt - f(x + k dt n)), 0, 1)`, with `n += bend up` after every sample (Tomczak 2012,
/// algorithm 3.7).
#[expect(clippy::too_many_arguments, reason = "the method's own numbers")]
pub(super) fn bent<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    steps: u32,
    step: f32,
    scale: f32,
    bend: f32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            for (k, n) in batches(range.clone()) {
                q.hits.open[k..k + n].fill(0.0);
                for j in 1..=steps {
                    let (far, up) = (
                        j as f32 * step,
                        splat3(s, UP.map(|c| c * bend * (j - 1) as f32)),
                    );
                    let hits = &q.hits;
                    sample(
                        s,
                        solid,
                        n,
                        &mut q.work,
                        #[inline(always)]
                        |i| {
                            along(
                                load3(s, &hits.point, k + i),
                                load3(s, &hits.normal, k + i) + up,
                                splat(s, far),
                            )
                        },
                    );
                    q.counts.occlusion += n as u64;
                    let weight = BENT_FALL.powi(-(j as i32));
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let way = (load3(s, &q.hits.normal, k + i) + up).length() * far;
                        let sum = load(s, &q.hits.open, k + i) + (way - value(s, q, k, i)) * weight;
                        store(sum, &mut q.hits.open, k + i);
                    }
                }
            }
            finish(s, scale, range, q);
        },
    );
}

/// `exp(-scale sum_i w_i (d_i - f(x + d_i n')))` with `n' = n + bend up` and `d_i` doubling (Evans 2006, 9.6; Tomczak 2012,
/// equation 3.26 with its sign mended), not above 1.
pub(super) fn evans<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    scale: f32,
    step: f32,
    bend: f32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            let up = splat3(s, UP.map(|c| c * bend));
            for (k, n) in batches(range) {
                q.hits.open[k..k + n].fill(0.0);
                for (j, weight) in EVANS.into_iter().enumerate() {
                    let far = step * (1 << j) as f32;
                    let hits = &q.hits;
                    sample(
                        s,
                        solid,
                        n,
                        &mut q.work,
                        #[inline(always)]
                        |i| {
                            along(
                                load3(s, &hits.point, k + i),
                                load3(s, &hits.normal, k + i) + up,
                                splat(s, far),
                            )
                        },
                    );
                    q.counts.occlusion += n as u64;
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let sum = load(s, &q.hits.open, k + i) + (value(s, q, k, i) - far) * weight;
                        store(sum, &mut q.hits.open, k + i);
                    }
                }
                for i in (0..n).step_by(S::f32s::LEN) {
                    let open = exponential_visibility(load(s, &q.hits.open, k + i), scale);
                    store(open, &mut q.hits.open, k + i);
                }
            }
        },
    );
}

/// `1 - clamp(scale (1 - n . up), 0, 1)` (Tomczak 2012, algorithm 4.3).
pub(super) fn upward<S: Simd>(s: S, scale: f32, range: Range<usize>, q: &mut Scratch) {
    s.vectorize(
        #[inline(always)]
        || {
            for i in range.clone().step_by(S::f32s::LEN) {
                store(slant(load3(s, &q.hits.normal, i)), &mut q.hits.open, i);
            }
            finish(s, scale, range, q);
        },
    );
}
