//! Secondary rays: one stream from the hits or from a queue, refilled as rays end, that finds how much of something far reaches
//! where they begin. See [`zeroset_shade::secondary`].

use crate::march::{ITERATIONS, ORDINAL, ORDINAL_BITS, age};
use crate::normal::{distances, values_and_clearances};
use crate::ray::Queue;
use crate::shadow::Hard;
use crate::simd::{
    Chosen, INSIDE, Sheet, along, first_lanes, load, load_words, load3, sided, splat, splat3,
    store, store3,
};
use crate::tile::{Ended, Hits, Scratch, SecondaryRays, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::{BATCH, Workspace};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3};
use zeroset_shade::march::{behind, rise};
use zeroset_shade::secondary::{FIRST, LEAST, SMOOTHING, STEEPEST, STOP, reach};
use zeroset_shade::skin;

/// What counts as light for a ray that has touched something: from there on only what it hits is dark.
const TOUCHED: f32 = -1.0;

/// What samples say of the light.
pub(crate) trait Penumbra<S: Simd>: Copy {
    /// Whether there is none: a ray is stopped or it is not.
    const HARD: bool;
    /// Width of the penumbra per distance; zero where there is none.
    fn width(self) -> f32;
    /// What is left of the light after a sample `f` at `t`, a step of `z` behind one of radius `r`. Where there is no
    /// penumbra, `light` is the value of the field that stops a ray, and stays.
    fn darken(
        self,
        light: Lanes<S>,
        f: Lanes<S>,
        t: Lanes<S>,
        z: Lanes<S>,
        r: Lanes<S>,
    ) -> Lanes<S>;
    /// Whether no light is left.
    fn dark(self, light: Lanes<S>, f: Lanes<S>) -> LaneMask<S>;
    /// What counts as light for a ray that was stopped at `t`.
    #[inline(always)]
    fn stopped(self, t: Lanes<S>) -> Lanes<S> {
        t * 0.0
    }
}

/// Secondary rays as they begin.
pub(crate) struct Departure<S: Simd> {
    pub(crate) origin: Vec3<Lanes<S>>,
    pub(crate) direction: Vec3<Lanes<S>>,
    /// Nothing nearer than this is looked at.
    pub(crate) start: Lanes<S>,
    /// Nothing farther than this matters.
    pub(crate) distance: Lanes<S>,
    /// Slope of the field along the ray where it begins.
    pub(crate) slope: Lanes<S>,
    /// How far from the surface that it comes from a ray begins.
    pub(crate) offset: Lanes<S>,
    /// The ball of this radius that touches the origin, on the side to which the field rises, is empty.
    pub(crate) ball: Lanes<S>,
    /// Sum of the sizes of coordinates there.
    pub(crate) size: Lanes<S>,
    /// The rays that are followed.
    pub(crate) followed: LaneMask<S>,
    /// Those that get all there is, without being followed.
    pub(crate) open: LaneMask<S>,
}

/// Where secondary rays come from.
pub(crate) trait Departures<S: Simd> {
    /// The direction of all rays, if they have one in common.
    fn common(&self) -> Option<[f32; 3]>;
    /// The rays from number `at` on.
    fn depart(&self, s: S, at: usize) -> Departure<S>;
}

/// Where rays from hits go.
pub(crate) trait Aim<S: Simd> {
    /// The direction of all rays, if they have one in common.
    fn common(&self) -> Option<[f32; 3]>;
    /// Direction, and the distance at which a ray ends, for the hits from `at` on.
    fn direction(
        &self,
        at: usize,
        origin: Vec3<Lanes<S>>,
        normal: Vec3<Lanes<S>>,
    ) -> (Vec3<Lanes<S>>, Lanes<S>);
}

/// Rays from hits. Those that would go into the surface are not followed; what is seen from inside a solid is lit as if there were no
/// solid, else it would be dark.
struct FromHits<'a, A> {
    hits: &'a Hits,
    aim: &'a A,
}

impl<S: Simd, A: Aim<S>> Departures<S> for FromHits<'_, A> {
    #[inline(always)]
    fn common(&self) -> Option<[f32; 3]> {
        self.aim.common()
    }
    #[inline(always)]
    fn depart(&self, s: S, at: usize) -> Departure<S> {
        let hits = self.hits;
        let (point, normal) = (load3(s, &hits.point, at), load3(s, &hits.normal, at));
        let offset = load(s, &hits.offset, at);
        let origin = along(point, normal, offset);
        let (direction, distance) = self.aim.direction(at, origin, normal);
        let slope = normal.dot(direction);
        let side = load_words(s, &hits.word, at) & INSIDE;
        let inside = LaneMask(side.simd_gt(S::u32s::splat(s, 0)));
        let facing = slope.above(0.0);
        Departure {
            origin,
            direction,
            start: offset * FIRST,
            distance,
            slope,
            offset,
            ball: load(s, &hits.ball, at),
            size: point.x.abs() + point.y.abs() + point.z.abs(),
            followed: facing & !inside,
            open: facing & inside,
        }
    }
}

/// Rays of a queue, each from where its span starts to where it ends.
struct FromQueue<'a> {
    queue: &'a Queue,
    solid: &'a Solid<'a>,
}

impl<S: Simd> Departures<S> for FromQueue<'_> {
    #[inline(always)]
    fn common(&self) -> Option<[f32; 3]> {
        None
    }
    #[inline(always)]
    fn depart(&self, s: S, at: usize) -> Departure<S> {
        let ray = self.queue.ray(s, at);
        let spans = &self.queue.spans;
        let (start, zero) = (load(s, &spans.start, at), splat(s, 0.0));
        let near = self.solid.near(&ray, start);
        let begin = along(ray.origin, ray.direction, start);
        Departure {
            origin: ray.origin,
            direction: ray.direction,
            start,
            distance: load(s, &spans.end, at),
            slope: load(s, &spans.slope, at),
            offset: near * 2.0,
            ball: zero,
            size: begin.x.abs() + begin.y.abs() + begin.z.abs(),
            followed: zero.below(1.0),
            open: zero.above(1.0),
        }
    }
}

/// What secondary rays are followed in.
struct RayMemory<'q> {
    rays: &'q mut SecondaryRays,
    ended: &'q mut Ended,
    work: &'q mut Workspace,
    lit: &'q mut Sheet,
}

/// Finds how much reaches each hit of the range, into `q.lit`: 0 where the surface faces away. Returns the evaluations.
pub(crate) fn from_hits<S: Simd, P: Penumbra<S>>(
    s: S,
    penumbra: P,
    aim: &impl Aim<S>,
    solid: &Solid<'_>,
    range: Range<usize>,
    q: &mut Scratch,
) -> u64 {
    let from = FromHits { hits: &q.hits, aim };
    let memory = RayMemory {
        rays: &mut q.secondary,
        ended: &mut q.ended,
        work: &mut q.work,
        lit: &mut q.lit,
    };
    stream(s, penumbra, &from, solid, range, memory)
}

/// Finds which rays of the queue meet nothing, into `q.lit`: 1 for those, 0 for the others. A ray that begins inside a solid meets it
/// at once. Returns the evaluations.
pub(crate) fn occluded<S: Simd>(s: S, solid: &Solid<'_>, q: &mut Scratch) -> u64 {
    let from = FromQueue {
        queue: &q.queue,
        solid,
    };
    let memory = RayMemory {
        rays: &mut q.secondary,
        ended: &mut q.ended,
        work: &mut q.work,
        lit: &mut q.lit,
    };
    stream(s, Hard, &from, solid, 0..q.queue.count, memory)
}

/// Follows the rays of the range. Returns the evaluations.
fn stream<S: Simd, P: Penumbra<S>, D: Departures<S>>(
    s: S,
    penumbra: P,
    from: &D,
    solid: &Solid<'_>,
    range: Range<usize>,
    mut q: RayMemory<'_>,
) -> u64 {
    s.vectorize(
        #[inline(always)]
        || {
            q.lit[range.clone()].fill(0.0);
            q.rays.count = 0;
            q.ended.count = 0;
            let common = from.common();
            let (mut next, mut iteration, mut evaluations) = (range.start, 0, 0);
            loop {
                while next < range.end && q.rays.count + S::f32s::LEN <= BATCH {
                    start(s, penumbra, from, solid, next..range.end, iteration, &mut q);
                    next += S::f32s::LEN;
                }
                if q.rays.count == 0 || solid.stop.before(q.rays.count) {
                    break;
                }
                sample(s, common, solid, &mut q);
                evaluations += q.rays.count as u64;
                advance(s, penumbra, common.is_none(), solid, &mut q);
                iteration += 1;
                retire(s, penumbra, solid.max_steps, iteration, &mut q);
            }
            for i in 0..q.ended.count {
                q.lit[(q.ended.word[i] & ORDINAL) as usize] = q.ended.light[i];
            }
            evaluations
        },
    )
}

/// Starts the first rays of the range.
#[inline(always)]
fn start<S: Simd, P: Penumbra<S>, D: Departures<S>>(
    s: S,
    penumbra: P,
    from: &D,
    solid: &Solid<'_>,
    range: Range<usize>,
    iteration: u32,
    q: &mut RayMemory<'_>,
) {
    let at = range.start;
    let ray = from.depart(s, at);
    let exists = first_lanes(s, range.len());
    let (lit, offset) = (load(s, q.lit, at), ray.offset);
    store(
        Lanes::select(ray.open & exists, splat(s, 1.0), lit),
        q.lit,
        at,
    );
    let width = penumbra.width();
    let limit = ray.distance.min(solid.view.far);
    let mut followed = ray.followed & exists;
    for form in solid.closed {
        // what is asked is only whether anything is in the way: it is
        followed = followed & !form.meet(ray.origin, ray.direction).below(limit);
    }
    let begin = Chosen::new(followed);
    if begin.none() {
        return;
    }
    let rays = &mut *q.rays;
    let n = rays.count;
    let end = solid
        .region
        .leave(ray.origin, ray.direction, splat(s, width), offset)
        .min(limit);
    let ordinal = S::u32s::from_fn(
        s,
        #[inline(always)]
        |k| (at + k) as u32,
    );
    let word = ordinal | (iteration & ITERATIONS) << ORDINAL_BITS;
    begin.put3(ray.origin, &mut rays.origin, n);
    if from.common().is_none() {
        begin.put3(ray.direction, &mut rays.direction, n);
    }
    // within a ball of radius a whose middle lies a above the origin the field at t is nowhere below a - |t to - a normal|,
    // which is more than the penumbra's w t up to 2 a (cosine - w) / (1 - w^2)
    let narrow = if width < 1.0 {
        2.0 / (1.0 - width * width)
    } else {
        0.0
    };
    let free = ray.ball * (ray.slope - width) * narrow;
    begin.put(ray.start.max(free).min(end), &mut rays.t, n);
    store(splat(s, 0.0), &mut rays.z, n);
    store(splat(s, 0.0), &mut rays.r, n);
    begin.put(ray.slope, &mut rays.m, n);
    begin.put(
        if !P::HARD {
            splat(s, 1.0)
        } else if solid.fractal {
            offset * STOP
        } else {
            // behind the surface, beyond rounding
            behind(ray.size) * 2.0
        },
        &mut rays.light,
        n,
    );
    begin.put(
        if solid.skins && !P::HARD {
            skin::touch(offset, ray.size)
        } else {
            offset * LEAST
        },
        &mut rays.least,
        n,
    );
    begin.put(end, &mut rays.end, n);
    begin.put_words(word, &mut rays.word, n);
    rays.count += begin.count;
}

#[inline(always)]
fn sample<S: Simd>(s: S, common: Option<[f32; 3]>, solid: &Solid<'_>, q: &mut RayMemory<'_>) {
    let (rays, points) = (&*q.rays, q.work.points_mut());
    for i in (0..rays.count).step_by(S::f32s::LEN) {
        let d = match common {
            Some(direction) => splat3(s, direction),
            None => load3(s, &rays.direction, i),
        };
        let at = along(
            load3(s, &rays.origin, i),
            d,
            load(s, &rays.t, i) + load(s, &rays.z, i),
        );
        store3(at, points, i);
    }
    if solid.sought {
        values_and_clearances(s, solid, rays.count, q.work);
    } else if solid.close {
        solid.values(s, q.work, rays.count);
    } else {
        distances(s, solid, rays.count, q.work);
    }
}

#[inline(always)]
fn advance<S: Simd, P: Penumbra<S>>(
    s: S,
    penumbra: P,
    aimed: bool,
    solid: &Solid<'_>,
    q: &mut RayMemory<'_>,
) {
    let (close, skins) = (solid.close, solid.skins && !P::HARD);
    let (rays, ended) = (&mut *q.rays, &mut *q.ended);
    // how far rays may go, and what is shown as the distance
    let (free, shown) = if close && !solid.sought {
        (q.work.values(), q.work.values())
    } else {
        (q.work.gradient_values(), q.work.values())
    };
    let count = rays.count;
    let width = penumbra.width();
    let mut kept = 0;
    for i in (0..count).step_by(S::f32s::LEN) {
        let live = first_lanes(s, count - i);
        let word = load_words(s, &rays.word, i);
        let f = sided(load(s, &free.0, i), word);
        let distance = sided(load(s, &shown.0, i), word);
        let (t, z, r) = (
            load(s, &rays.t, i),
            load(s, &rays.z, i),
            load(s, &rays.r, i),
        );
        let (m, light, end) = (
            load(s, &rays.m, i),
            load(s, &rays.light, i),
            load(s, &rays.end, i),
        );
        let (to, least) = (t + z, load(s, &rays.least, i));
        // beside a loose bound penumbrae are seen where samples happen to be
        let wide = if P::HARD || !close {
            splat(s, 0.0)
        } else {
            light.max(0.0) * width
        };
        // whether anything between the samples can matter
        let gap = z.above(r) & ((r + f - z) * 0.5).below(wide * to) & z.above(least);
        let rise = rise(r, f, z);
        let slope = Lanes::select(z.above(0.0), m.mix(rise, SMOOTHING), m);
        let slope = Lanes::select(gap, splat(s, -1.0), slope).min(STEEPEST);
        let back = if close { z } else { splat(s, 0.0) };
        let darker = penumbra.darken(light, distance, to, back, r);
        let darker = Lanes::select(gap, light, darker);
        // a ray without light may have come to a skin: it goes on until it touches something or moves away, and where it
        // touched, until it is behind a surface
        let black = penumbra.dark(darker, f);
        let (darker, dark) = if skins {
            let behind = f.below(least * skin::BEHIND);
            let touches = black & f.below(least) & !behind;
            let leaves = !light.below(0.0) & !touches & z.above(0.0) & f.above(r);
            let darker = Lanes::select(!gap & touches, splat(s, TOUCHED), darker);
            (darker, !gap & black & (behind | leaves))
        } else {
            (darker, !gap & black)
        };
        let (t, r) = (Lanes::select(gap, t, to), Lanes::select(gap, r, f));
        let wide = if P::HARD || !close {
            wide
        } else {
            darker.max(0.0) * width
        };
        let reach = reach(r, t, slope, wide);
        // after a gap the step must be the radius itself: no other is sure to be kept
        // and so where a skin may be touched
        let near = if skins {
            gap | (black & !darker.below(0.0))
        } else {
            gap
        };
        let z = Lanes::select(near, r, reach.max(r)).max(least);
        // not "above the end": a ray whose numbers are none must end too
        let within = (t + r.max(0.0)).below(end);
        let on = Chosen::new(live & !dark & within);
        if on.count < S::f32s::LEN {
            let done = Chosen::new(live & (dark | !within));
            let left = if P::HARD {
                splat(s, 1.0)
            } else {
                Lanes::select(darker.below(0.0), splat(s, 1.0), darker)
            };
            done.put(
                Lanes::select(dark, penumbra.stopped(t), left),
                &mut ended.light,
                ended.count,
            );
            done.put_words(word, &mut ended.word, ended.count);
            ended.count += done.count;
            if on.none() {
                continue;
            }
        }
        if !on.all() || kept != i {
            on.put3(load3(s, &rays.origin, i), &mut rays.origin, kept);
            if aimed {
                on.put3(load3(s, &rays.direction, i), &mut rays.direction, kept);
            }
            on.put(least, &mut rays.least, kept);
            on.put(end, &mut rays.end, kept);
            on.put_words(word, &mut rays.word, kept);
        }
        on.put(darker, &mut rays.light, kept);
        on.put(t, &mut rays.t, kept);
        on.put(z.min(end - t), &mut rays.z, kept);
        on.put(r, &mut rays.r, kept);
        on.put(slope, &mut rays.m, kept);
        kept += on.count;
    }
    rays.count = kept;
}

/// Takes out the rays that ran out of steps: they have the light that is left.
#[inline(always)]
fn retire<S: Simd, P: Penumbra<S>>(
    _s: S,
    _penumbra: P,
    max_steps: u32,
    iteration: u32,
    q: &mut RayMemory<'_>,
) {
    let (rays, ended) = (&mut *q.rays, &mut *q.ended);
    let old = |w: &u32| age(*w, iteration) >= max_steps;
    let spent = rays.word[..rays.count]
        .iter()
        .take_while(|w| old(w))
        .count();
    for i in 0..spent {
        let touched = rays.light[i] < 0.0;
        ended.light[ended.count] = if P::HARD || touched {
            1.0
        } else {
            rays.light[i]
        };
        ended.word[ended.count] = rays.word[i];
        ended.count += 1;
    }
    if spent > 0 {
        rays.remove_first(spent);
    }
}

impl SecondaryRays {
    fn remove_first(&mut self, n: usize) {
        let rest = n..self.count;
        let columns = self.origin.iter_mut().chain(&mut self.direction);
        let columns = columns.chain([
            &mut self.t,
            &mut self.z,
            &mut self.r,
            &mut self.m,
            &mut self.light,
            &mut self.least,
            &mut self.end,
        ]);
        for column in columns {
            column.copy_within(rest.clone(), 0);
        }
        self.word.copy_within(rest, 0);
        self.count -= n;
    }
}
