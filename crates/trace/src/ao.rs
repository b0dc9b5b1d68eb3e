//! Ambient occlusion: how much of the sky reaches the hits. All methods of the papers, and cones as the default.

use crate::beam::{Aim, Penumbra, stream};
use crate::normal::sample;
use crate::sampling::{cosine_direction, sobol};
use crate::shadow::Hard;
use crate::simd::{
    Chosen, along, first_lanes, load, load_words, load3, sided, splat, splat3, store, store3,
};
use crate::tile::{Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_field::eval::{BATCH, Lane};
use zeroset_field::number::lanes::LaneMask;
use zeroset_field::number::{Lanes, Ops, Real, Vec3, v3};
use zeroset_scene::settings::Occlusion;

/// Up.
pub(crate) const UP: [f32; 3] = [0.0, 1.0, 0.0];
/// Occlusion less than this is none: no picture can show it.
const NOTHING: f32 = 1.0 / 4096.0;

/// Finds the ambient visibility and the bent normals of the hits of the range.
pub(crate) fn occlusion<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    method: Occlusion,
    range: Range<usize>,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            q.hits.open[range.clone()].fill(1.0);
            q.hits.ball[range.clone()].fill(0.0);
            for k in 0..3 {
                q.hits.bent[k][range.clone()].copy_from_slice(&q.hits.normal[k][range.clone()]);
            }
        },
    );
    match method {
        Occlusion::None => {}
        Occlusion::Quilez { steps, step, scale } => quilez(s, solid, steps, step, scale, range, q),
        Occlusion::Bent {
            steps,
            step,
            scale,
            bend,
        } => bent(s, solid, steps, step, scale, bend, range, q),
        Occlusion::Evans { scale, step, bend } => evans(s, solid, scale, step, bend, range, q),
        Occlusion::Upward { scale } => upward(s, scale, range, q),
        Occlusion::Cones { reach, steps } => cones(s, solid, reach, steps, range, q),
        Occlusion::Hemisphere { rays, reach } => hemisphere(s, solid, Hard, rays, reach, range, q),
        Occlusion::Obscurance { rays, reach, tau } => {
            hemisphere(s, solid, Near { tau }, rays, reach, range, q)
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

/// `1 - clamp(scale sum_k 2^-k (k dt - f(x + k dt n)), 0, 1)` (Tomczak 2012, algorithm 3.4 with the sum of equation 3.31).
///
/// No sample can be closer to a surface than the farthest one plus the way between them, so every term is at most as large
/// as the farthest sample's shortfall: where that is nothing, one sample is enough.
fn quilez<S: Simd>(
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
                finish(s, scale * 0.5, range.clone(), q);
                return;
            }
            q.beams.count = 0;
            for at in range.clone().step_by(S::f32s::LEN) {
                let (hits, beams) = (&mut q.hits, &mut *q.beams);
                let short = load(s, &hits.open, at);
                let more =
                    Chosen::new((short * scale).above(NOTHING) & first_lanes(s, range.end - at));
                store(splat(s, 1.0), &mut hits.open, at);
                if more.none() {
                    continue;
                }
                let b = beams.count;
                more.put3(load3(s, &hits.point, at), &mut beams.origin, b);
                more.put3(load3(s, &hits.normal, at), &mut beams.direction, b);
                more.put(short * 0.5f32.powi(steps as i32), &mut beams.light, b);
                let side = load_words(s, &hits.word, at) & crate::simd::INSIDE;
                let ordinal = S::u32s::from_fn(
                    s,
                    #[inline(always)]
                    |k| (at + k) as u32,
                );
                more.put_words(ordinal | side, &mut beams.word, b);
                beams.count += more.count;
                if beams.count + S::f32s::LEN > BATCH {
                    nearer(s, solid, steps, step, scale, q);
                }
            }
            if q.beams.count > 0 {
                nearer(s, solid, steps, step, scale, q);
            }
        },
    );
}

/// The nearer samples of [`quilez`], for the hits that need them.
#[inline(always)]
fn nearer<S: Simd>(s: S, solid: &Solid<'_>, steps: u32, step: f32, scale: f32, q: &mut Scratch) {
    let n = q.beams.count;
    for k in 1..steps {
        let (far, beams) = (k as f32 * step, &*q.beams);
        sample(
            s,
            solid,
            n,
            &mut q.work,
            #[inline(always)]
            |i| {
                along(
                    load3(s, &beams.origin, i),
                    load3(s, &beams.direction, i),
                    splat(s, far),
                )
            },
        );
        q.counts.occlusion += n as u64;
        let weight = 0.5f32.powi(k as i32);
        for i in (0..n).step_by(S::f32s::LEN) {
            let f = sided(
                load(s, &q.work.values().0, i),
                load_words(s, &q.beams.word, i),
            );
            let sum = load(s, &q.beams.light, i) - (f - far) * weight;
            store(sum, &mut q.beams.light, i);
        }
    }
    for (&word, &sum) in q.beams.word[..n].iter().zip(&q.beams.light[..n]) {
        q.hits.open[(word & crate::march::ORDINAL) as usize] = 1.0 - (scale * sum).clamp(0.0, 1.0);
    }
    q.beams.count = 0;
}

/// `1 - clamp(scale sum, 0, 1)` of the sums that are in place of the visibility.
#[inline(always)]
fn finish<S: Simd>(s: S, scale: f32, range: Range<usize>, q: &mut Scratch) {
    for i in range.step_by(S::f32s::LEN) {
        let sum = load(s, &q.hits.open, i) * scale;
        store(sum.clamp01().one_minus(), &mut q.hits.open, i);
    }
}

/// `1 - clamp(scale sum_k 1.1^-k (|n| k dt - f(x + k dt n)), 0, 1)`, with `n += bend up` after every sample (Tomczak 2012,
/// algorithm 3.7).
#[expect(clippy::too_many_arguments, reason = "the method's own numbers")]
fn bent<S: Simd>(
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
                    let weight = 1.1f32.powi(-(j as i32));
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

/// Weights of the samples of [`evans`] (Evans 2006, listing 1).
pub(crate) const EVANS: [f32; 4] = [1.0, 1.2, 1.4, 1.8];

/// `exp(-scale sum_i w_i (d_i - f(x + d_i n')))` with `n' = n + bend up` and `d_i` doubling (Evans 2006, 9.6; Tomczak 2012,
/// equation 3.26 with its sign mended), not above 1.
fn evans<S: Simd>(
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
                    let open = (load(s, &q.hits.open, k + i) * scale).min(0.0).exp();
                    store(open, &mut q.hits.open, k + i);
                }
            }
        },
    );
}

/// `1 - clamp(scale (1 - n . up), 0, 1)` (Tomczak 2012, algorithm 4.3).
fn upward<S: Simd>(s: S, scale: f32, range: Range<usize>, q: &mut Scratch) {
    s.vectorize(
        #[inline(always)]
        || {
            for i in range.clone().step_by(S::f32s::LEN) {
                let cosine = load3(s, &q.hits.normal, i).dot(v3(UP[0], UP[1], UP[2]));
                store(cosine.one_minus(), &mut q.hits.open, i);
            }
            finish(s, scale, range, q);
        },
    );
}

/// Cosines, to the normal, of the nine cones of equal solid angle: one up, three around it, five along the horizon.
pub(crate) const CONE_COSINES: [f32; 9] = {
    let (a, b) = (13.0 / 18.0, 5.0 / 18.0);
    [1.0, a, a, a, b, b, b, b, b]
};
/// Tangent of the half angle of a cone with a ninth of the hemisphere: acos(1 - 1/9) = 27.3 degrees.
pub(crate) const CONE_TANGENT: f32 = 0.515_388_2;
/// Samples along a cone are closer to its tip by this from one to the next.
pub(crate) const CONE_RATIO: f32 = 0.45;
/// The cones are made around this direction and turned from it to the normal the shortest way. It is the opposite of no
/// face that anybody builds, and only there the shortest way is not known.
pub(crate) const CONE_AXIS: [f32; 3] = [0.269_680_3, 0.898_934_4, 0.345_190_8];

/// The directions of the cones around [`CONE_AXIS`].
pub(crate) fn cone_directions() -> [[f32; 3]; 9] {
    let axis = v3(CONE_AXIS[0], CONE_AXIS[1], CONE_AXIS[2]);
    let [a, b] = crate::sampling::basis(axis);
    std::array::from_fn(|i| {
        let (ring, at) = if i < 4 {
            (3.0, i as f32)
        } else {
            (5.0, i as f32 + 0.25)
        };
        let (sin, cos) = (at * std::f32::consts::TAU / ring).sin_cos();
        let c = CONE_COSINES[i];
        let r = (1.0 - c * c).sqrt();
        (a * (r * cos) + b * (r * sin) + axis * c).array()
    })
}

/// `w`, turned with the rotation that takes [`CONE_AXIS`] to `n` the shortest way.
#[inline(always)]
pub(crate) fn turn<R: Real<Scalar = f32>>(n: Vec3<R>, w: [f32; 3]) -> Vec3<R> {
    let a = v3(
        n.x.lit(CONE_AXIS[0]),
        n.x.lit(CONE_AXIS[1]),
        n.x.lit(CONE_AXIS[2]),
    );
    let w = v3(n.x.lit(w[0]), n.x.lit(w[1]), n.x.lit(w[2]));
    let (v, c) = (a.cross(n), a.dot(n));
    let once = v.cross(w);
    w + once + v.cross(once) / (c + 1.0).max(1e-4)
}

/// Nine cones over the hemisphere. A cone is open as far as the field at its samples is as large as the cone is wide there,
/// or as large as over a bare plane, which so is open in full: `min_t f(x + w t) / (t min(tan, cos))`. (Distance field
/// ambient occlusion, as in Aaltonen 2018.)
fn cones<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    reach: f32,
    steps: u32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            let directions = cone_directions();
            for (k, n) in batches(range) {
                let mut open = Lane::ZERO;
                let mut bent = [Lane::ZERO; 3];
                let mut total = 0.0;
                for (&w, cosine) in directions.iter().zip(CONE_COSINES) {
                    let mut least = Lane([1.0; BATCH]);
                    let mut to = [Lane::ZERO; 3];
                    let mut origin = [Lane::ZERO; 3];
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let normal = load3(s, &q.hits.normal, k + i);
                        let from = along(
                            load3(s, &q.hits.point, k + i),
                            normal,
                            load(s, &q.hits.offset, k + i),
                        );
                        store3(from, &mut origin, i);
                        store3(turn(normal, w), &mut to, i);
                    }
                    let mut t = reach;
                    for step in 0..steps {
                        sample(
                            s,
                            solid,
                            n,
                            &mut q.work,
                            #[inline(always)]
                            |i| along(load3(s, &origin, i), load3(s, &to, i), splat(s, t)),
                        );
                        q.counts.occlusion += n as u64;
                        if step == 0 && cosine == 1.0 {
                            for i in (0..n).step_by(S::f32s::LEN) {
                                let f = value(s, q, k, i);
                                let radius = Lanes::select(f.below(t), splat(s, 0.0), splat(s, t));
                                store(radius, &mut q.hits.ball, k + i);
                            }
                        }
                        let scale = 1.0 / (t * CONE_TANGENT.min(cosine));
                        for i in (0..n).step_by(S::f32s::LEN) {
                            let seen = (value(s, q, k, i) * scale).max(0.0);
                            store(load(s, &least.0, i).min(seen), &mut least.0, i);
                        }
                        t *= CONE_RATIO;
                    }
                    total += cosine;
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let share = load(s, &least.0, i) * cosine;
                        store(load(s, &open.0, i) + share, &mut open.0, i);
                        store3(
                            along(load3(s, &bent, i), load3(s, &to, i), share),
                            &mut bent,
                            i,
                        );
                    }
                }
                for i in (0..n).step_by(S::f32s::LEN) {
                    // divided, not multiplied: with all cones open the quotient is exactly 1
                    store(load(s, &open.0, i) / total, &mut q.hits.open, k + i);
                    let sum = load3(s, &bent, i);
                    let normal = load3(s, &q.hits.normal, k + i);
                    // the normal decides where nothing is open
                    store3((sum + normal * 1e-3).normalize(), &mut q.hits.bent, k + i);
                }
            }
        },
    );
}

/// A ray that counts the more, the farther it gets: `1 - exp(-tau d)` (Tomczak 2012, equation 3.23; Iones et al. 2003).
#[derive(Clone, Copy)]
struct Near {
    tau: f32,
}

impl<S: Simd> Penumbra<S> for Near {
    const HARD: bool = true;
    #[inline(always)]
    fn width(self) -> f32 {
        0.0
    }
    #[inline(always)]
    fn darken(
        self,
        light: Lanes<S>,
        _f: Lanes<S>,
        _t: Lanes<S>,
        _z: Lanes<S>,
        _r: Lanes<S>,
    ) -> Lanes<S> {
        light
    }
    #[inline(always)]
    fn dark(self, light: Lanes<S>, f: Lanes<S>) -> LaneMask<S> {
        f.below(light)
    }
    #[inline(always)]
    fn stopped(self, t: Lanes<S>) -> Lanes<S> {
        (t * -self.tau).exp().one_minus()
    }
}

/// Ray number `index` of every hit.
struct Around<'a> {
    index: u32,
    reach: f32,
    scramble: &'a [Vec<u32>; 2],
}

impl<S: Simd> Aim<S> for Around<'_> {
    #[inline(always)]
    fn common(&self) -> Option<[f32; 3]> {
        None
    }
    #[inline(always)]
    fn direction(
        &self,
        at: usize,
        origin: Vec3<Lanes<S>>,
        normal: Vec3<Lanes<S>>,
    ) -> (Vec3<Lanes<S>>, Lanes<S>) {
        let s = origin.x.0.token();
        let point = sobol(self.index);
        let u: S::u32s = (load_words(s, &self.scramble[0], at) ^ point[0]) >> 8;
        let v: S::u32s = (load_words(s, &self.scramble[1], at) ^ point[1]) >> 8;
        let (u, v) = (
            Lanes::<S>(u.to_float::<S::f32s>()),
            Lanes::<S>(v.to_float::<S::f32s>()),
        );
        let unit = 1.0 / 16_777_216.0;
        (
            cosine_direction(normal, u * unit, v * unit),
            splat(s, self.reach),
        )
    }
}

/// The mean over rays that are spread by the cosine law of what they see: the reference (Tomczak 2012, equations 3.18 and
/// 3.19).
fn hemisphere<S: Simd, P: Penumbra<S>>(
    s: S,
    solid: &Solid<'_>,
    kind: P,
    rays: u32,
    reach: f32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    q.hits.open[range.clone()].fill(0.0);
    let scramble = std::mem::take(&mut q.scramble);
    for index in 0..rays {
        if solid.stop.is_set() {
            break;
        }
        let aim = Around {
            index,
            reach,
            scramble: &scramble,
        };
        q.counts.occlusion += stream(s, kind, &aim, solid, range.clone(), q);
        for (open, lit) in q.hits.open[range.clone()]
            .iter_mut()
            .zip(&q.hits.lit[range.clone()])
        {
            *open += lit / rays as f32;
        }
    }
    q.scramble = scramble;
}
