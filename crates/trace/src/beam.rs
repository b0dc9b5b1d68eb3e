//! Secondary rays: one stream from the hits, refilled as rays end, that finds how much of something far reaches them.
//! See [`zeroset_shade::secondary`].

use crate::march::{ITERATIONS, ORDINAL, ORDINAL_BITS, age};
use crate::normal::distances;
use crate::simd::{
    Chosen, INSIDE, along, first_lanes, load, load_words, load3, sided, splat, splat3, store,
    store3,
};
use crate::tile::{Beams, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::BATCH;
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

/// Where rays go.
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

/// Finds how much reaches each hit of the range, into `lit`: 0 where the surface faces away. What is seen from inside the solid
/// is lit as if there were no solid: else it would be dark. Returns the evaluations.
pub(crate) fn stream<S: Simd, P: Penumbra<S>, A: Aim<S>>(
    s: S,
    penumbra: P,
    aim: &A,
    solid: &Solid<'_>,
    range: Range<usize>,
    q: &mut Scratch,
) -> u64 {
    s.vectorize(
        #[inline(always)]
        || {
            q.hits.lit[range.clone()].fill(0.0);
            q.beams.count = 0;
            q.ended.count = 0;
            let (mut next, mut iteration, mut evaluations) = (range.start, 0, 0);
            loop {
                while next < range.end && q.beams.count + S::f32s::LEN <= BATCH {
                    start(s, penumbra, aim, solid, next..range.end, iteration, q);
                    next += S::f32s::LEN;
                }
                if q.beams.count == 0 || solid.stop.before(q.beams.count) {
                    break;
                }
                sample(s, aim, solid, q);
                evaluations += q.beams.count as u64;
                advance(s, penumbra, aim.common().is_none(), solid, q);
                iteration += 1;
                retire(s, penumbra, solid.max_steps, iteration, q);
            }
            for i in 0..q.ended.count {
                q.hits.lit[(q.ended.word[i] & ORDINAL) as usize] = q.ended.light[i];
            }
            evaluations
        },
    )
}

/// Starts the rays of the first hits of the range, as far as they face where they go.
#[inline(always)]
fn start<S: Simd, P: Penumbra<S>, A: Aim<S>>(
    s: S,
    penumbra: P,
    aim: &A,
    solid: &Solid<'_>,
    range: Range<usize>,
    iteration: u32,
    q: &mut Scratch,
) {
    let at = range.start;
    let (hits, beams) = (&mut q.hits, &mut *q.beams);
    let (point, normal) = (load3(s, &hits.point, at), load3(s, &hits.normal, at));
    let offset = load(s, &hits.offset, at);
    let origin = along(point, normal, offset);
    let (to, distance) = aim.direction(at, origin, normal);
    let cosine = normal.dot(to);
    let side = load_words(s, &hits.word, at) & INSIDE;
    let inside = LaneMask(side.simd_gt(S::u32s::splat(s, 0)));
    let facing = cosine.above(0.0) & first_lanes(s, range.len());
    let lit = load(s, &hits.lit, at);
    store(
        Lanes::select(facing & inside, splat(s, 1.0), lit),
        &mut hits.lit,
        at,
    );
    let begin = Chosen::new(facing & !inside);
    if begin.none() {
        return;
    }
    let n = beams.count;
    let end = solid
        .region
        .leave(origin, to, splat(s, penumbra.width()), offset)
        .min(distance)
        .min(solid.view.far);
    let ordinal = S::u32s::from_fn(
        s,
        #[inline(always)]
        |k| (at + k) as u32,
    );
    let word = ordinal | (iteration & ITERATIONS) << ORDINAL_BITS;
    begin.put3(origin, &mut beams.origin, n);
    if aim.common().is_none() {
        begin.put3(to, &mut beams.direction, n);
    }
    // within a ball of radius a whose middle lies a above the origin the field at t is nowhere below a - |t to - a normal|,
    // which is more than the penumbra's w t up to 2 a (cosine - w) / (1 - w^2)
    let w = penumbra.width();
    let free =
        load(s, &hits.ball, at) * (cosine - w) * if w < 1.0 { 2.0 / (1.0 - w * w) } else { 0.0 };
    begin.put((offset * FIRST).max(free).min(end), &mut beams.t, n);
    store(splat(s, 0.0), &mut beams.z, n);
    store(splat(s, 0.0), &mut beams.r, n);
    begin.put(cosine, &mut beams.m, n);
    begin.put(
        if !P::HARD {
            splat(s, 1.0)
        } else if solid.fractal {
            offset * STOP
        } else {
            // behind the surface, beyond rounding
            behind(point.x.abs() + point.y.abs() + point.z.abs()) * 2.0
        },
        &mut beams.light,
        n,
    );
    begin.put(
        if solid.skins && !P::HARD {
            skin::touch(offset, point.x.abs() + point.y.abs() + point.z.abs())
        } else {
            offset * LEAST
        },
        &mut beams.least,
        n,
    );
    begin.put(end, &mut beams.end, n);
    begin.put_words(word, &mut beams.word, n);
    beams.count += begin.count;
}

#[inline(always)]
fn sample<S: Simd, A: Aim<S>>(s: S, aim: &A, solid: &Solid<'_>, q: &mut Scratch) {
    let (beams, points) = (&*q.beams, q.work.points_mut());
    let common = aim.common();
    for i in (0..beams.count).step_by(S::f32s::LEN) {
        let d = match common {
            Some(direction) => splat3(s, direction),
            None => load3(s, &beams.direction, i),
        };
        let at = along(
            load3(s, &beams.origin, i),
            d,
            load(s, &beams.t, i) + load(s, &beams.z, i),
        );
        store3(at, points, i);
    }
    if solid.close {
        zeroset_eval::values(s, solid.program.values(), &mut q.work, beams.count);
    } else {
        distances(s, solid, beams.count, &mut q.work);
    }
}

#[inline(always)]
fn advance<S: Simd, P: Penumbra<S>>(
    s: S,
    penumbra: P,
    aimed: bool,
    solid: &Solid<'_>,
    q: &mut Scratch,
) {
    let (close, skins) = (solid.close, solid.skins && !P::HARD);
    let (beams, ended) = (&mut *q.beams, &mut q.ended);
    // how far rays may go, and what is shown as the distance
    let (free, shown) = if close {
        (q.work.values(), q.work.values())
    } else {
        (q.work.gradient_values(), q.work.values())
    };
    let count = beams.count;
    let width = penumbra.width();
    let mut kept = 0;
    for i in (0..count).step_by(S::f32s::LEN) {
        let live = first_lanes(s, count - i);
        let word = load_words(s, &beams.word, i);
        let f = sided(load(s, &free.0, i), word);
        let distance = sided(load(s, &shown.0, i), word);
        let (t, z, r) = (
            load(s, &beams.t, i),
            load(s, &beams.z, i),
            load(s, &beams.r, i),
        );
        let (m, light, end) = (
            load(s, &beams.m, i),
            load(s, &beams.light, i),
            load(s, &beams.end, i),
        );
        let (to, least) = (t + z, load(s, &beams.least, i));
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
            on.put3(load3(s, &beams.origin, i), &mut beams.origin, kept);
            if aimed {
                on.put3(load3(s, &beams.direction, i), &mut beams.direction, kept);
            }
            on.put(least, &mut beams.least, kept);
            on.put(end, &mut beams.end, kept);
            on.put_words(word, &mut beams.word, kept);
        }
        on.put(darker, &mut beams.light, kept);
        on.put(t, &mut beams.t, kept);
        on.put(z.min(end - t), &mut beams.z, kept);
        on.put(r, &mut beams.r, kept);
        on.put(slope, &mut beams.m, kept);
        kept += on.count;
    }
    beams.count = kept;
}

/// Takes out the rays that ran out of steps: they have the light that is left.
#[inline(always)]
fn retire<S: Simd, P: Penumbra<S>>(
    _s: S,
    _penumbra: P,
    max_steps: u32,
    iteration: u32,
    q: &mut Scratch,
) {
    let (beams, ended) = (&mut *q.beams, &mut q.ended);
    let old = |w: &u32| age(*w, iteration) >= max_steps;
    let spent = beams.word[..beams.count]
        .iter()
        .take_while(|w| old(w))
        .count();
    for i in 0..spent {
        let touched = beams.light[i] < 0.0;
        ended.light[ended.count] = if P::HARD || touched {
            1.0
        } else {
            beams.light[i]
        };
        ended.word[ended.count] = beams.word[i];
        ended.count += 1;
    }
    if spent > 0 {
        beams.remove_first(spent);
    }
}

impl Beams {
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
