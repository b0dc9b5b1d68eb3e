//! Occlusion from eleven cones: how far each is clear of everything, and what that says of the sky between them, see
//! [`zeroset_shade::occlusion`].

use crate::march::{ITERATIONS, ORDINAL, ORDINAL_BITS};
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
use zeroset_shade::march::rise;
use zeroset_shade::occlusion::{
    BLOCKED, CARE, CONES, COSINES, EMPTY, FREE, FULL, GROWTH, NARROW, NORMAL_SHARE, START, SURE,
    WIDTH, clear, directions, distances, left, open as openness, ring, share, turn, weights,
};
use zeroset_shade::secondary::{SMOOTHING, STEEPEST, reach};
use zeroset_shade::skin;

/// What counts as the clearance of a cone that has touched something: from there on only what it hits blocks it.
const TOUCHED: f32 = -1.0;

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
                let cone = OcclusionCone {
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
    // of the rays: `t` is the radius that is tried, `r` the largest that is empty, `z` the least that is not
    q.secondary.count = 0;
    q.ended.count = 0;
    let mut next = range.start;
    loop {
        while next < range.end && q.secondary.count + S::f32s::LEN <= BATCH {
            let (hits, rays) = (&q.hits, &mut *q.secondary);
            let n = rays.count;
            let new = Chosen::new(first_lanes(s, range.end - next));
            let (origin, normal, word) = from(s, hits, next);
            new.put3(origin, &mut rays.origin, n);
            new.put3(normal, &mut rays.direction, n);
            new.put_words(word, &mut rays.word, n);
            let first = (load(s, &hits.offset, next) * START).min(far);
            new.put(first, &mut rays.t, n);
            new.put(splat(s, 0.0), &mut rays.r, n);
            new.put(splat(s, 0.0), &mut rays.z, n);
            rays.count += new.count;
            next += S::f32s::LEN;
        }
        let count = q.secondary.count;
        if count == 0 || solid.stop.is_set() {
            break;
        }
        look(s, solid, q);
        let (rays, ended, values) = (&mut *q.secondary, &mut q.ended, q.work.values());
        let mut kept = 0;
        for i in (0..count).step_by(S::f32s::LEN) {
            let word = load_words(s, &rays.word, i);
            let f = sided(load(s, &values.0, i), word);
            let t = load(s, &rays.t, i);
            let empty = f.above(t * EMPTY);
            let large = Lanes::select(empty, t, load(s, &rays.r, i));
            let least = Lanes::select(empty, load(s, &rays.z, i), t);
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
            on.put3(load3(s, &rays.origin, i), &mut rays.origin, kept);
            on.put3(load3(s, &rays.direction, i), &mut rays.direction, kept);
            on.put_words(word, &mut rays.word, kept);
            on.put(t, &mut rays.t, kept);
            on.put(large, &mut rays.r, kept);
            on.put(least, &mut rays.z, kept);
            kept += on.count;
        }
        rays.count = kept;
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

/// Samples all rays where they are.
#[inline(always)]
fn look<S: Simd>(s: S, solid: &Solid<'_>, q: &mut Scratch) {
    let (rays, count) = (&*q.secondary, q.secondary.count);
    sample(
        s,
        solid,
        count,
        &mut q.work,
        #[inline(always)]
        |i| {
            along(
                load3(s, &rays.origin, i),
                load3(s, &rays.direction, i),
                load(s, &rays.t, i),
            )
        },
    );
    q.counts.occlusion += count as u64;
}

/// One cone of every hit.
struct OcclusionCone {
    to: [f32; 3],
    cosine: f32,
    far: f32,
}

/// Finds the sines of a cone's clearances, into `ended`.
#[inline(always)]
fn march<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    cone: &OcclusionCone,
    steps: u32,
    range: Range<usize>,
    q: &mut Scratch,
) {
    q.secondary.count = 0;
    q.ended.count = 0;
    let (mut next, mut iteration) = (range.start, 0u32);
    loop {
        while next < range.end && q.secondary.count + S::f32s::LEN <= BATCH {
            start(s, solid, cone, next..range.end, iteration, q);
            next += S::f32s::LEN;
        }
        if q.secondary.count == 0 || solid.stop.is_set() {
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
    cone: &OcclusionCone,
    range: Range<usize>,
    iteration: u32,
    q: &mut Scratch,
) {
    let (hits, rays) = (&q.hits, &mut *q.secondary);
    let (at, n) = (range.start, rays.count);
    let ball = load(s, &hits.ball, at);
    let new = Chosen::new(ball.below(cone.far) & first_lanes(s, range.len()));
    if new.none() {
        return;
    }
    let (origin, normal, word) = from(s, hits, at);
    let offset = load(s, &hits.offset, at);
    let [x, y, z] = cone.to;
    let to = turn(normal, v3(x, y, z));
    let t = (offset * START).max(ball * (FREE * cone.cosine));
    let end = (solid.region)
        .leave(origin, to, splat(s, SURE * FULL), offset)
        .min(cone.far)
        .max(t);
    new.put3(origin, &mut rays.origin, n);
    new.put3(to, &mut rays.direction, n);
    new.put(t, &mut rays.t, n);
    new.put(splat(s, 0.0), &mut rays.z, n);
    new.put(splat(s, 0.0), &mut rays.r, n);
    new.put(splat(s, cone.cosine), &mut rays.m, n);
    new.put(splat(s, FULL), &mut rays.light, n);
    new.put(end, &mut rays.end, n);
    if solid.skins {
        let size = origin.x.abs() + origin.y.abs() + origin.z.abs();
        new.put(skin::touch(offset, size), &mut rays.least, n);
    }
    new.put_words(
        word | (iteration & ITERATIONS) << ORDINAL_BITS,
        &mut rays.word,
        n,
    );
    rays.count += new.count;
}

/// Takes the samples in, and ends the cones that hit something, have left the scene or have had all their steps.
#[inline(always)]
fn advance<S: Simd>(s: S, skins: bool, steps: u32, iteration: u32, q: &mut Scratch) {
    let (rays, ended, values) = (&mut *q.secondary, &mut q.ended, q.work.values());
    let count = rays.count;
    let mut kept = 0;
    for i in (0..count).step_by(S::f32s::LEN) {
        let word = load_words(s, &rays.word, i);
        let f = sided(load(s, &values.0, i), word);
        let (t, z, r) = (
            load(s, &rays.t, i),
            load(s, &rays.z, i),
            load(s, &rays.r, i),
        );
        let (m, end) = (load(s, &rays.m, i), load(s, &rays.end, i));
        // where the balls around two samples do not touch there may be something between them: back to where they do
        let gap = z.above(r) & (r + f).below(z);
        // steps that find out whether something is touched are kept
        let touch = load(s, &rays.least, i);
        let gap = if skins { gap & z.above(touch) } else { gap };
        let open = f.above(t * BLOCKED);
        let before = load(s, &rays.light, i);
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
        let rise = rise(r, f, z);
        let slope = Lanes::select(z.above(0.0), m.mix(rise, SMOOTHING), m).min(STEEPEST);
        let slope = Lanes::select(gap, splat(s, -1.0), slope);
        let edge = least.max(0.0) * CARE;
        let to_edge = reach(f, t, slope, edge);
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
            on.put3(load3(s, &rays.origin, i), &mut rays.origin, kept);
            on.put3(load3(s, &rays.direction, i), &mut rays.direction, kept);
            on.put(end, &mut rays.end, kept);
            if skins {
                on.put(touch, &mut rays.least, kept);
            }
            on.put_words(word, &mut rays.word, kept);
        }
        let step = to_edge.max(f);
        let step = if skins {
            let step = Lanes::select(black & !least.below(0.0), f, step);
            Lanes::select(black, step.max(touch), step)
        } else {
            step
        };
        let step = step.min(end - t);
        on.put(Lanes::select(gap, t - z + r, t + step), &mut rays.t, kept);
        on.put(Lanes::select(gap, r, step), &mut rays.z, kept);
        on.put(Lanes::select(gap, r, f), &mut rays.r, kept);
        on.put(slope, &mut rays.m, kept);
        on.put(least, &mut rays.light, kept);
        kept += on.count;
    }
    rays.count = kept;
}

/// Sums up what the cones of each hit see.
#[inline(always)]
fn combine<S: Simd>(s: S, to: &[[f32; 3]; CONES], range: Range<usize>, q: &mut Scratch) {
    let (distances, weights) = (distances(), weights());
    for i in range.step_by(S::f32s::LEN) {
        let mut clearance = [splat(s, 0.0); CONES];
        for (k, of) in clearance.iter_mut().enumerate() {
            *of = clear(load(s, &q.clearance[k], i));
        }
        let normal = load3(s, &q.hits.normal, i);
        let mut open = splat(s, 0.0);
        let mut bent = normal * NORMAL_SHARE;
        for (k, (&w, apart)) in to.iter().zip(&distances).enumerate() {
            let mut behind = splat(s, -WIDTH[0]);
            for (j, (&other, &distance)) in clearance.iter().zip(apart).enumerate() {
                if j != k {
                    behind = behind.max(left(other, distance));
                }
            }
            let ring = ring(k);
            let share = share(clearance[k], behind, 1.0 / WIDTH[ring], weights[ring]);
            open = open + share;
            bent = along(bent, turn(normal, v3(w[0], w[1], w[2])), share);
        }
        store(openness(open), &mut q.hits.open, i);
        // the normal decides where nothing is open
        store3(bent.normalize(), &mut q.hits.bent, i);
    }
}
