//! Occlusion from eleven cones: how far each is clear of everything, and what that says of the sky between them.
//!
//! The *clearance* of a direction is the largest angle around it that holds no surface: `min_t f(x + w t) / t` is its sine.
//! It is found by sphere tracing, so the samples lie where the field is small, and it changes smoothly from place to place.
//! It ends at the surface itself: for all that a ray knows that hit something, the edge may be just beside it or far away.
//! But clearance changes by at most the angle between two directions. So a direction that is blocked has at most the negative
//! clearance that its neighbours leave it, `max_j (clearance_j - angle_ij)`: how deep it lies behind the edge. With a sign on
//! both sides of the edge, the share of the sky that a cone sees is a smooth step, and all of them together count a sky that
//! any edge moves over evenly. (Cones as in Aaltonen 2018; the continuation is that of McShane 1934.)
//!
//! Nothing here is a length: cones begin some pixels from the surface, or where the largest empty ball that touches it lets
//! them go, and end where the scene does.

use crate::march::{ITERATIONS, ORDINAL, ORDINAL_BITS};
use crate::marcher::Rough;
use crate::normal::sample;
use crate::simd::{
    Chosen, INSIDE, along, first_lanes, load, load_words, load3, sided, splat, store, store3,
};
use crate::tile::{Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::BATCH;
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3, v3};
use zeroset_shade::skin;

/// Number of cones.
pub(crate) const DIRECTIONS: usize = 11;
/// The first of them are the ring around the normal, the others that along the horizon.
const HIGH: usize = 4;
// The numbers of the two rings. They, `FULL` and `EXTENT` make the error least: against rays in double precision over 60
// random scenes of solids, floors, walls and lids, and against mathematics over two planes at random angles, balls and discs
// over a floor, three walls and thin rooms, with the roughness of the floor under the balls. The scenes of the papers are not
// among them.
/// Cosines to the normal.
pub(crate) const COSINES: [f32; 2] = [0.88, 0.49];
/// Shares of the sky, by the cosine law, of one cone.
const SHARES: [f32; 2] = [0.5426 / 4.0, 0.4574 / 7.0];
/// Sine of the clearance that counts as wholly open. The plane of the surface itself leaves a low cone not more than its
/// cosine.
pub(crate) const FULL: f32 = 0.465;
/// A cone counts as half hidden from this far on the one side of an edge to this far on the other.
pub(crate) const WIDTH: [f32; 2] = [1.075, 0.9];
/// How far, measured as the distances between directions are, wholly open is.
pub(crate) const EXTENT: f32 = 0.43;
/// Near an edge, up to this share of its width, an open cone counts on its neighbours as a blocked one does.
pub(crate) const CLOSENESS: f32 = 0.2;

/// From this share of wholly open on a clearance says all it can of the directions beside it.
const TELLING: f32 = 0.2;

/// Sine of the clearance that is none.
pub(crate) const BLOCKED: f32 = 0.05;
/// Steps are as short as an edge at this share of the clearance found so far asks for.
pub(crate) const CARE: f32 = 0.45;
/// A cone ends where the scene leaves it this share of what is wholly open.
pub(crate) const SURE: f32 = 0.75;
/// The first sample is this many offsets from the origin.
pub(crate) const START: f32 = 4.0;
/// Cones begin this share of the touching ball's radius times their cosine from the origin. Up to 2 there is nothing on the
/// axis; less is also clear beside it.
pub(crate) const FREE: f32 = 1.2;
/// From one touching ball to the next.
pub(crate) const GROWTH: f32 = 8.0;
/// The radius of the touching ball is known up to this factor.
pub(crate) const NARROW: f32 = 2.0;
/// A ball that has all but this share of its radius is empty: single precision has no more.
pub(crate) const EMPTY: f32 = 0.999_998;

/// What counts as the clearance of a cone that has touched something: from there on only what it hits blocks it.
const TOUCHED: f32 = -1.0;

/// Smoothing of the slope along a cone, share of the step that would just do, and steepest slope, as in [`crate::beam`].
pub(crate) const BETA: f32 = 0.3;
pub(crate) const SHARE: f32 = 0.95;
pub(crate) const STEEPEST: f32 = 0.98;

/// The cones are made around this direction and turned from it to the normal the shortest way. It is the opposite of no
/// face that anybody builds, and only there the shortest way is not known.
const AXIS: [f32; 3] = [0.269_680_3, 0.898_934_4, 0.345_190_8];

/// The directions around [`AXIS`].
pub(crate) fn directions() -> [[f32; 3]; DIRECTIONS] {
    let axis = v3(AXIS[0], AXIS[1], AXIS[2]);
    let [a, b] = crate::sampling::basis(axis);
    std::array::from_fn(|k| {
        let turns = if k < HIGH {
            k as f32 / HIGH as f32
        } else {
            ((k - HIGH) as f32 + 0.25) / (DIRECTIONS - HIGH) as f32
        };
        let (sin, cos) = (turns * std::f32::consts::TAU).sin_cos();
        let c = COSINES[ring(k)];
        let r = (1.0 - c * c).sqrt();
        (a * (r * cos) + b * (r * sin) + axis * c).array()
    })
}

/// The ring of a cone.
#[inline(always)]
pub(crate) fn ring(k: usize) -> usize {
    usize::from(k >= HIGH)
}

/// Distances between directions, as points of the unit sphere.
pub(crate) fn distances() -> [[f32; DIRECTIONS]; DIRECTIONS] {
    let to = directions();
    to.map(|a| to.map(|b| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>().sqrt()))
}

/// `w`, turned with the rotation that takes [`AXIS`] to `n` the shortest way.
#[inline(always)]
pub(crate) fn turn<R: Real<Scalar = f32>>(n: Vec3<R>, w: [f32; 3]) -> Vec3<R> {
    let a = v3(n.x.lit(AXIS[0]), n.x.lit(AXIS[1]), n.x.lit(AXIS[2]));
    let w = v3(n.x.lit(w[0]), n.x.lit(w[1]), n.x.lit(w[2]));
    let (v, c) = (a.cross(n), a.dot(n));
    let once = v.cross(w);
    w + once + v.cross(once) / (c + 1.0).max(1e-4)
}

/// The share that is open of a cone whose axis is `depth` widths before an edge: 0 at -1, 1 at 1.
#[inline(always)]
pub(crate) fn seen<R: Real<Scalar = f32>>(depth: R) -> R {
    let x = (depth * 0.5 + 0.5).clamp01();
    x.sq() * (x * -2.0 + 3.0)
}

/// How far behind the edge a blocked direction is, negative, for what another leaves it that is `clear` and so far `apart`.
/// One that is hardly clear says as little as one that is blocked: else the picture would jump where it becomes so.
#[inline(always)]
pub(crate) fn left<R: Real<Scalar = f32>>(clear: R, apart: f32) -> R {
    let none = clear.lit(-WIDTH[0]);
    none.mix(
        clear - apart,
        (clear * (1.0 / (TELLING * EXTENT))).clamp01(),
    )
}

/// What one cone of a ring adds where it is wholly open, so that all of them make 1.
pub(crate) fn weights() -> [f32; 2] {
    [0, 1].map(|r| SHARES[r] / seen(EXTENT / WIDTH[r]))
}

/// Finds the openness and the bent normals of the hits of the range.
pub(super) fn cones<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    reach: Option<f32>,
    steps: u32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    let far = reach.unwrap_or(f32::INFINITY).min(solid.view.far);
    let to = directions();
    s.vectorize(
        #[inline(always)]
        || {
            touch(s, solid, far, range.clone(), q);
            for (k, &w) in to.iter().enumerate() {
                q.clearance[k][range.clone()].fill(FULL);
                let cone = Cone {
                    to: w,
                    cosine: COSINES[ring(k)],
                    far,
                };
                march(
                    s,
                    solid,
                    &cone,
                    steps.clamp(1, ITERATIONS - skin::MORE),
                    range.clone(),
                    q,
                );
                let sheet = &mut q.clearance[k];
                for (&word, &light) in q.ended.word[..q.ended.count].iter().zip(&**q.ended.light) {
                    sheet[(word & ORDINAL) as usize] = light;
                }
            }
            combine(s, &to, range.clone(), q);
        },
    );
}

/// Finds how large an empty ball may be that touches the origin of secondary rays, up to a factor of [`NARROW`]; `far` where
/// there is no end to it. Balls that touch the same place hold each other, so few radii are enough.
#[inline(always)]
fn touch<S: Simd>(s: S, solid: &Solid<'_>, far: f32, range: Range<usize>, q: &mut Scratch) {
    // of the beams: `t` is the radius that is tried, `r` the largest that is empty, `z` the least that is not
    q.beams.count = 0;
    q.ended.count = 0;
    let mut next = range.start;
    loop {
        while next < range.end && q.beams.count + S::f32s::LEN <= BATCH {
            let (hits, beams) = (&q.hits, &mut *q.beams);
            let n = beams.count;
            let new = Chosen::new(first_lanes(s, range.end - next));
            let (origin, normal, word) = from(s, hits, next);
            new.put3(origin, &mut beams.origin, n);
            new.put3(normal, &mut beams.direction, n);
            new.put_words(word, &mut beams.word, n);
            let first = (load(s, &hits.offset, next) * START).min(far);
            new.put(first, &mut beams.t, n);
            new.put(splat(s, 0.0), &mut beams.r, n);
            new.put(splat(s, 0.0), &mut beams.z, n);
            beams.count += new.count;
            next += S::f32s::LEN;
        }
        let count = q.beams.count;
        if count == 0 || solid.stop.is_set() {
            break;
        }
        look(s, solid, q);
        let (beams, ended, values) = (&mut *q.beams, &mut q.ended, q.work.values());
        let mut kept = 0;
        for i in (0..count).step_by(S::f32s::LEN) {
            let word = load_words(s, &beams.word, i);
            let f = sided(load(s, &values.0, i), word);
            let t = load(s, &beams.t, i);
            let empty = f.above(t * EMPTY);
            let large = Lanes::select(empty, t, load(s, &beams.r, i));
            let least = Lanes::select(empty, load(s, &beams.z, i), t);
            let found = least.above(0.0);
            let narrow = (large * least).sqrt();
            let t = Lanes::select(found, narrow, (t * GROWTH).min(far));
            let wide = large.above(0.0) & least.above(large * NARROW);
            let more = (found & wide) | (!found & large.below(far));
            let live = first_lanes(s, count - i);
            let (on, done) = (Chosen::new(live & more), Chosen::new(live & !more));
            done.put(large, &mut ended.light, ended.count);
            done.put_words(word, &mut ended.word, ended.count);
            ended.count += done.count;
            on.put3(load3(s, &beams.origin, i), &mut beams.origin, kept);
            on.put3(load3(s, &beams.direction, i), &mut beams.direction, kept);
            on.put_words(word, &mut beams.word, kept);
            on.put(t, &mut beams.t, kept);
            on.put(large, &mut beams.r, kept);
            on.put(least, &mut beams.z, kept);
            kept += on.count;
        }
        beams.count = kept;
    }
    for i in 0..q.ended.count {
        q.hits.ball[(q.ended.word[i] & ORDINAL) as usize] = q.ended.light[i];
    }
}

/// Origins of secondary rays, normals, and words, of the hits from `at` on.
#[inline(always)]
fn from<S: Simd>(
    s: S,
    hits: &crate::tile::Hits,
    at: usize,
) -> (Vec3<Lanes<S>>, Vec3<Lanes<S>>, S::u32s) {
    let normal = load3(s, &hits.normal, at);
    let origin = along(load3(s, &hits.point, at), normal, load(s, &hits.offset, at));
    let ordinal = S::u32s::from_fn(
        s,
        #[inline(always)]
        |k| (at + k) as u32,
    );
    let side = load_words(s, &hits.word, at) & INSIDE;
    (origin, normal, ordinal | side)
}

/// Samples all beams where they are.
#[inline(always)]
fn look<S: Simd>(s: S, solid: &Solid<'_>, q: &mut Scratch) {
    let (beams, count) = (&*q.beams, q.beams.count);
    sample(
        s,
        solid,
        count,
        &mut q.work,
        #[inline(always)]
        |i| {
            along(
                load3(s, &beams.origin, i),
                load3(s, &beams.direction, i),
                load(s, &beams.t, i),
            )
        },
    );
    q.counts.occlusion += count as u64;
}

/// One cone of every hit.
struct Cone {
    to: [f32; 3],
    cosine: f32,
    far: f32,
}

/// Finds the sines of a cone's clearances, into `ended`.
#[inline(always)]
fn march<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    cone: &Cone,
    steps: u32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    q.beams.count = 0;
    q.ended.count = 0;
    let (mut next, mut iteration) = (range.start, 0u32);
    loop {
        while next < range.end && q.beams.count + S::f32s::LEN <= BATCH {
            start(s, solid, cone, next..range.end, iteration, q);
            next += S::f32s::LEN;
        }
        if q.beams.count == 0 || solid.stop.is_set() {
            break;
        }
        look(s, solid, q);
        advance(s, solid.skins, steps, iteration, q);
        iteration = iteration.wrapping_add(1);
    }
}

/// Starts the cones of the first hits of the range, but where all is open.
#[inline(always)]
fn start<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    cone: &Cone,
    range: Range<usize>,
    iteration: u32,
    q: &mut Scratch,
) {
    let (hits, beams) = (&q.hits, &mut *q.beams);
    let (at, n) = (range.start, beams.count);
    let ball = load(s, &hits.ball, at);
    let new = Chosen::new(ball.below(cone.far) & first_lanes(s, range.len()));
    if new.none() {
        return;
    }
    let (origin, normal, word) = from(s, hits, at);
    let offset = load(s, &hits.offset, at);
    let to = turn(normal, cone.to);
    let t = (offset * START).max(ball * (FREE * cone.cosine));
    let end = (solid.region)
        .leave(origin, to, splat(s, SURE * FULL), offset)
        .min(cone.far)
        .max(t);
    new.put3(origin, &mut beams.origin, n);
    new.put3(to, &mut beams.direction, n);
    new.put(t, &mut beams.t, n);
    new.put(splat(s, 0.0), &mut beams.z, n);
    new.put(splat(s, 0.0), &mut beams.r, n);
    new.put(splat(s, cone.cosine), &mut beams.m, n);
    new.put(splat(s, FULL), &mut beams.light, n);
    new.put(end, &mut beams.end, n);
    if solid.skins {
        let size = origin.x.abs() + origin.y.abs() + origin.z.abs();
        new.put(skin::touch(offset, size), &mut beams.least, n);
    }
    new.put_words(
        word | (iteration & ITERATIONS) << ORDINAL_BITS,
        &mut beams.word,
        n,
    );
    beams.count += new.count;
}

/// Takes the samples in, and ends the cones that hit something, have left the scene or have had all their steps.
#[inline(always)]
fn advance<S: Simd>(s: S, skins: bool, steps: u32, iteration: u32, q: &mut Scratch) {
    let (beams, ended, values) = (&mut *q.beams, &mut q.ended, q.work.values());
    let count = beams.count;
    let mut kept = 0;
    for i in (0..count).step_by(S::f32s::LEN) {
        let word = load_words(s, &beams.word, i);
        let f = sided(load(s, &values.0, i), word);
        let (t, z, r) = (
            load(s, &beams.t, i),
            load(s, &beams.z, i),
            load(s, &beams.r, i),
        );
        let (m, end) = (load(s, &beams.m, i), load(s, &beams.end, i));
        // where the balls around two samples do not touch there may be something between them: back to where they do
        let gap = z.above(r) & (r + f).below(z);
        // steps that find out whether something is touched are kept
        let touch = load(s, &beams.least, i);
        let gap = if skins { gap & z.above(touch) } else { gap };
        let open = f.above(t * BLOCKED);
        let before = load(s, &beams.light, i);
        let least = Lanes::select(gap, before, before.min(f / t));
        // what blocks a cone may be a skin: it goes on until it touches something or moves away, and where it touched, until
        // it is behind a surface
        let (black, least, clear) = if skins {
            let black = !gap & !least.above(BLOCKED);
            let behind = f.below(touch * skin::BEHIND);
            let touches = black & f.below(touch) & !behind;
            let leaves = !before.below(0.0) & !touches & z.above(0.0) & f.above(r);
            let least = Lanes::select(touches, splat(s, TOUCHED), least);
            (black, least, !(black & (behind | leaves)))
        } else {
            (!gap & !open, least, gap | open)
        };
        let rise = ((f - r) * z.max(1e-20).rough_recip()).clamp(-1.0, 1.0);
        let slope = Lanes::select(z.above(0.0), m.mix(rise, BETA), m).min(STEEPEST);
        let slope = Lanes::select(gap, splat(s, -1.0), slope);
        let edge = least.max(0.0) * CARE;
        let to_edge =
            (f - edge * t) * (2.0 * SHARE) * (slope.one_minus() + edge * 2.0).rough_recip();
        let old: S::u32s = (S::u32s::splat(s, iteration) - (word >> ORDINAL_BITS)) & ITERATIONS;
        let fresh = LaneMask(old.simd_lt(S::u32s::splat(s, steps - 1)));
        let late = LaneMask(old.simd_lt(S::u32s::splat(s, steps + skin::MORE - 1)));
        let fresh = fresh | ((black | !before.above(BLOCKED)) & late);
        let live = first_lanes(s, count - i);
        let more = clear & (gap | t.below(end)) & fresh;
        let on = Chosen::new(live & more);
        if on.count < S::f32s::LEN {
            let done = Chosen::new(live & !more);
            // a cone that had all its steps goes on as it went last: then f / t tends to the slope
            let at_end = !gap & !t.below(end);
            let found = Lanes::select(at_end, least, least.min(rise.max(0.0)));
            // one that was out of steps while it touched something did not get through
            let through = least.below(0.0) & (at_end | f.above(touch));
            let found = Lanes::select(through, splat(s, FULL), found.max(0.0));
            let found = Lanes::select(clear, found, splat(s, 0.0));
            done.put(found, &mut ended.light, ended.count);
            done.put_words(word, &mut ended.word, ended.count);
            ended.count += done.count;
            if on.none() {
                continue;
            }
        }
        if !on.all() || kept != i {
            on.put3(load3(s, &beams.origin, i), &mut beams.origin, kept);
            on.put3(load3(s, &beams.direction, i), &mut beams.direction, kept);
            on.put(end, &mut beams.end, kept);
            if skins {
                on.put(touch, &mut beams.least, kept);
            }
            on.put_words(word, &mut beams.word, kept);
        }
        let step = to_edge.max(f);
        let step = if skins {
            let step = Lanes::select(black & !least.below(0.0), f, step);
            Lanes::select(black, step.max(touch), step)
        } else {
            step
        };
        let step = step.min(end - t);
        on.put(Lanes::select(gap, t - z + r, t + step), &mut beams.t, kept);
        on.put(Lanes::select(gap, r, step), &mut beams.z, kept);
        on.put(Lanes::select(gap, r, f), &mut beams.r, kept);
        on.put(slope, &mut beams.m, kept);
        on.put(least, &mut beams.light, kept);
        kept += on.count;
    }
    beams.count = kept;
}

/// Sums up what the cones of each hit see.
#[inline(always)]
fn combine<S: Simd>(s: S, to: &[[f32; 3]; DIRECTIONS], range: Range<usize>, q: &mut Scratch) {
    let (distances, weights) = (distances(), weights());
    for i in range.step_by(S::f32s::LEN) {
        let mut clear = [splat(s, 0.0); DIRECTIONS];
        for (k, clear) in clear.iter_mut().enumerate() {
            let scale = 1.0 / (FULL - BLOCKED);
            *clear = ((load(s, &q.clearance[k], i) - BLOCKED) * scale).clamp01() * EXTENT;
        }
        let normal = load3(s, &q.hits.normal, i);
        let mut open = splat(s, 0.0);
        let mut bent = normal * 1e-3;
        for (k, (&w, apart)) in to.iter().zip(&distances).enumerate() {
            let mut behind = splat(s, -WIDTH[0]);
            for (j, (&other, &distance)) in clear.iter().zip(apart).enumerate() {
                if j != k {
                    behind = behind.max(left(other, distance));
                }
            }
            let behind = behind.min(0.0) * (1.0 / WIDTH[0]);
            let before = clear[k] * (1.0 / WIDTH[ring(k)]);
            let close = (before * (1.0 / CLOSENESS)).one_minus().max(0.0);
            let share = seen(before + behind * close) * weights[ring(k)];
            open = open + share;
            bent = along(bent, turn(normal, w), share);
        }
        // with all cones open the sum is 1 up to rounding
        store((open * 1.000_002).min(1.0), &mut q.hits.open, i);
        // the normal decides where nothing is open
        store3(bent.normalize(), &mut q.hits.bent, i);
    }
}
