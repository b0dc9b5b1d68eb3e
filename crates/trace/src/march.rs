//! The stream of rays (and of the cones that go before those from the eye): a batch that is refilled as rays end.
//!
//! A batch holds up to [`BATCH`] rays. After every sample the rays that ended are taken out, the gap is closed, and new rays
//! fill the end: batches stay full, and their state stays in the nearest cache. What a ray does depends on nothing but
//! itself, so the picture does not depend on which rays share a batch.
//!
//! The word of a ray holds its number in the queue (12 bits), the iteration in which it began (19 bits,
//! wrapping) and the side that it is marched on ([`INSIDE`]). Rays are in the order in which they began, so the first ones run out
//! of steps first.

use crate::marcher::{self, Marcher, RayState, Reach};
use crate::ray::{Common, Queue, WideRay};
use crate::simd::{
    Chosen, INSIDE, along, first_lanes, load, load_words, load3, sided, store_words, store3,
};
use crate::tile::{Rays, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::{BATCH, Workspace};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3};
use zeroset_shade::march::{LEAST_ROUNDINGS, behind};
use zeroset_shade::view::Linear;

/// Where the number in the queue (or of the hit) of a word ends and the iteration begins.
pub(crate) const ORDINAL_BITS: u32 = 12;
/// The number in the queue (or of the hit) of a word.
pub(crate) const ORDINAL: u32 = (1 << ORDINAL_BITS) - 1;
/// Iterations are counted modulo this plus one.
pub(crate) const ITERATIONS: u32 = (1 << (31 - ORDINAL_BITS)) - 1;

/// Evaluations since a ray began.
#[inline(always)]
pub(crate) fn age(word: u32, iteration: u32) -> u32 {
    iteration.wrapping_sub(word >> ORDINAL_BITS) & ITERATIONS
}

/// Rays that ended.
pub(crate) struct Arrived<S: Simd> {
    pub(crate) ray: WideRay<Lanes<S>>,
    /// The last place that is not behind the surface.
    pub(crate) t: Lanes<S>,
    /// How much farther the place behind the surface is; zero where the ray ended before it.
    pub(crate) beyond: Lanes<S>,
    /// How much larger than the cone the field is at `t`, from the side that was marched.
    pub(crate) clearance: Lanes<S>,
    /// The same at the place behind the surface.
    pub(crate) behind: Lanes<S>,
    /// Slope of the field along the ray.
    pub(crate) m: Lanes<S>,
    pub(crate) word: S::u32s,
    pub(crate) iteration: u32,
}

impl<S: Simd> Arrived<S> {
    /// Evaluations that the rays took.
    #[inline(always)]
    pub(crate) fn steps(&self) -> S::u32s {
        let s = self.t.0.token();
        ((S::u32s::splat(s, self.iteration) - (self.word >> ORDINAL_BITS)) & ITERATIONS) + 1
    }
}

/// Where the rays of a stream go.
pub(crate) trait Sink<S: Simd> {
    /// Whether rays may go on behind the surface that they met, on its other side.
    const CROSSES: bool = false;
    /// These met the surface.
    fn found(&mut self, done: Chosen<S>, common: &Common, at: &Arrived<S>);
    /// Which of those that crossed the surface go on, where rays may.
    #[inline(always)]
    fn goes_on(&mut self, crossed: LaneMask<S>, _at: &Arrived<S>) -> LaneMask<S> {
        crossed
    }
    /// These left.
    fn left(&mut self, gone: LaneMask<S>, at: &Arrived<S>);
    /// Ray number `i` of the batch ran out of steps.
    fn spent(&mut self, rays: &Rays, common: &Common, i: usize);
}

/// What is marched, and as what.
pub(crate) struct Stream<'a> {
    pub(crate) solid: &'a Solid<'a>,
    /// Radius of the cones; zero for rays.
    pub(crate) width: Linear,
    /// Share of its clearance that a cone may go on: 1 / (1 + slope).
    pub(crate) share: f32,
    /// Radius of the footprint, but for what rounding adds.
    pub(crate) near: Linear,
    /// Share of the footprint that a step is at least long.
    pub(crate) least: f32,
    /// Whether a clearance below the footprint is a hit, and not just one below zero.
    pub(crate) touch: bool,
    /// Evaluations that each may take.
    pub(crate) max_steps: u32,
}

impl Stream<'_> {
    /// What is small at the point `p`, at distance `t` along `ray`.
    #[inline(always)]
    pub(crate) fn reach<S: Simd>(
        &self,
        ray: &WideRay<Lanes<S>>,
        t: Lanes<S>,
        p: Vec3<Lanes<S>>,
    ) -> Reach<Lanes<S>> {
        let way = ray.way(t);
        let near = self.near.at(way * ray.narrow);
        let rounding = self.solid.view.rounding.at(way);
        let size = p.x.abs() + p.y.abs() + p.z.abs();
        Reach {
            near: near + rounding,
            least: near * self.least + rounding * LEAST_ROUNDINGS,
            tiny: rounding * LEAST_ROUNDINGS,
            behind: behind(size),
        }
    }
}

/// Marches the rays or cones of the queue as far as they have a span. Returns the evaluations.
pub(crate) fn stream<S: Simd, M: Marcher>(
    s: S,
    marcher: M,
    how: &Stream<'_>,
    queue: &Queue,
    rays: &mut Rays,
    work: &mut Workspace,
    sink: &mut impl Sink<S>,
) -> u64 {
    s.vectorize(
        #[inline(always)]
        || {
            rays.count = 0;
            let (common, count) = (queue.common, queue.count);
            let (mut next, mut iteration, mut evaluations) = (0, 0, 0);
            loop {
                while next < count && rays.count + S::f32s::LEN <= BATCH {
                    begin(s, marcher, queue, next..count, iteration, rays);
                    next += S::f32s::LEN;
                }
                if rays.count == 0 || how.solid.stop.before(rays.count) {
                    break;
                }
                sample(s, how.solid, &common, rays, work);
                evaluations += rays.count as u64;
                advance(s, marcher, how, &common, iteration, rays, work, sink);
                iteration += 1;
                retire(how.max_steps, iteration, &common, rays, sink);
            }
            evaluations
        },
    )
}

/// Puts the first rays of the range into the batch.
#[inline(always)]
fn begin<S: Simd, M: Marcher>(
    s: S,
    marcher: M,
    queue: &Queue,
    range: Range<usize>,
    iteration: u32,
    rays: &mut Rays,
) {
    let (at, n, spans) = (range.start, rays.count, &queue.spans);
    let (start, mut end) = (load(s, &spans.start, at), load(s, &spans.end, at));
    if queue.limited {
        end = end.min(load(s, &queue.limit, at));
    }
    let new = Chosen::new(start.below(end) & first_lanes(s, range.len()));
    if new.none() {
        return;
    }
    rays.ray.put(new, &queue.common, &queue.ray(s, at), n);
    let (radius, slope) = (load(s, &spans.radius, at), load(s, &spans.slope, at));
    let r = radius.abs();
    new.put(start, &mut rays.t, n);
    new.put(end, &mut rays.end, n);
    new.put(slope, &mut rays.m, n);
    new.put(marcher.begin(r, slope).min(end - start), &mut rays.z, n);
    new.put(r, &mut rays.r, n);
    let (ordinal, side) = (
        S::u32s::from_fn(
            s,
            #[inline(always)]
            |k| k as u32,
        ) + (at as u32),
        radius.0.bitcast::<S::u32s>() & INSIDE,
    );
    new.put_words(
        ordinal | side | (iteration & ITERATIONS) << ORDINAL_BITS,
        &mut rays.word,
        n,
    );
    rays.count += new.count;
}

/// Finds how far it is free around the next place of every ray.
#[inline(always)]
fn sample<S: Simd>(s: S, solid: &Solid<'_>, common: &Common, rays: &Rays, work: &mut Workspace) {
    let points = work.points_mut();
    for i in (0..rays.count).step_by(S::f32s::LEN) {
        let ray = rays.ray.load(s, common, i);
        let t = load(s, &rays.t, i) + load(s, &rays.z, i).abs();
        store3(along(ray.origin, ray.direction, t), points, i);
    }
    solid.clearances(s, work, rays.count);
}

/// Moves every ray on, and takes those out that arrived or left.
#[expect(
    clippy::too_many_arguments,
    reason = "separate parts of the scratch memory"
)]
#[inline(always)]
fn advance<S: Simd, M: Marcher, K: Sink<S>>(
    s: S,
    marcher: M,
    how: &Stream<'_>,
    common: &Common,
    iteration: u32,
    rays: &mut Rays,
    work: &Workspace,
    sink: &mut K,
) {
    let (count, points) = (rays.count, work.points());
    let mut kept = 0;
    for i in (0..count).step_by(S::f32s::LEN) {
        let live = first_lanes(s, count - i);
        let value = load(s, &work.values().0, i);
        let at = RayState {
            t: load(s, &rays.t, i),
            z: load(s, &rays.z, i),
            r: load(s, &rays.r, i),
            m: load(s, &rays.m, i),
        };
        let word = load_words(s, &rays.word, i);
        let first = (word >> ORDINAL_BITS & ITERATIONS).simd_eq(iteration & ITERATIONS);
        // rays of whose start nothing is known take the side of their first sample
        let unknown = first & at.r.0.simd_le(0.0);
        let word =
            word | unknown.select(value.0.bitcast::<S::u32s>() & INSIDE, S::u32s::splat(s, 0));
        let first = LaneMask(first);
        let live = if how.solid.sought && !how.touch {
            // where nothing says how far a ray may go, its surface is looked for in another way
            let stuck = live & value.abs().below(f32::MIN_POSITIVE);
            store_words::<S>(word, &mut rays.word, i);
            let mut bits = stuck.0.to_bitmask();
            while bits != 0 {
                sink.spent(rays, common, i + bits.trailing_zeros() as usize);
                bits &= bits - 1;
            }
            live & !stuck
        } else {
            live
        };
        let f = sided(value, word);
        let to = at.t + at.z.abs();
        let ray = rays.ray.load(s, common, i);
        let clearance = (f - how.width.at(to)) * how.share;
        let reach = how.reach(&ray, to, load3(s, points, i));
        let next = marcher::advance(marcher, how.touch, at, clearance, reach, first);
        let (mut step, end) = (next.step, load(s, &rays.end, i));
        // not "above the end": a ray whose numbers are none must end too
        let within = (step.t + step.r.max(0.0)).below(end);
        let done = Chosen::new(next.hit & live);
        let mut on = Chosen::new(live & !next.hit & within);
        let mut word = word;
        if done.count + on.count < S::f32s::LEN || !done.none() {
            let arrived = Arrived {
                ray,
                t: step.t,
                beyond: to - step.t,
                clearance: step.r,
                behind: clearance,
                m: step.m,
                word,
                iteration,
            };
            sink.left(live & !next.hit & !within, &arrived);
            if !done.none() {
                sink.found(done, common, &arrived);
            }
            if K::CROSSES && !done.none() {
                // behind the surface the other side is marched, from the sample that was there
                let crossed = live & next.hit & to.above(step.t);
                let crossed = sink.goes_on(crossed, &arrived);
                let m = marcher.back(step.m);
                let z = marcher.begin(-clearance, m).max(reach.least);
                let none = S::u32s::splat(s, 0);
                word ^= crossed.0.select(S::u32s::splat(s, INSIDE), none);
                step = RayState {
                    t: Lanes::select(crossed, to, step.t),
                    z: Lanes::select(crossed, z, step.z),
                    r: Lanes::select(crossed, -clearance, step.r),
                    m: Lanes::select(crossed, m, step.m),
                };
                let within = (step.t + step.r.max(0.0)).below(end);
                on = Chosen::new(live & within & (!next.hit | crossed));
            }
        }
        if on.none() {
            continue;
        }
        if !on.all() || kept != i {
            rays.ray.put(on, common, &ray, kept);
            on.put(end, &mut rays.end, kept);
        }
        on.put_words(word, &mut rays.word, kept);
        on.put(step.t, &mut rays.t, kept);
        let rest = end - step.t;
        on.put(step.z.min(rest).max(-rest), &mut rays.z, kept);
        on.put(step.r, &mut rays.r, kept);
        on.put(step.m, &mut rays.m, kept);
        kept += on.count;
    }
    rays.count = kept;
}

/// Takes out the rays that ran out of steps: the first ones of the batch.
#[inline(always)]
fn retire<S: Simd>(
    max_steps: u32,
    iteration: u32,
    common: &Common,
    rays: &mut Rays,
    sink: &mut impl Sink<S>,
) {
    let old = |w: &u32| age(*w, iteration) >= max_steps;
    let spent = rays.word[..rays.count]
        .iter()
        .take_while(|w| old(w))
        .count();
    if spent > 0 {
        (0..spent).for_each(|i| sink.spent(rays, common, i));
        rays.remove_first(spent);
    }
}

impl Rays {
    fn remove_first(&mut self, n: usize) {
        let rest = n..self.count;
        let columns = [
            &mut self.t,
            &mut self.z,
            &mut self.r,
            &mut self.m,
            &mut self.end,
        ];
        for column in columns {
            column.copy_within(rest.clone(), 0);
        }
        self.ray.move_to_front(rest.clone());
        self.word.copy_within(rest, 0);
        self.count -= n;
    }
}
