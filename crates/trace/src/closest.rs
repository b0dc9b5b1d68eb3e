//! Where rays first meet the surface, wherever they come from: the list of hits.

use crate::isolate::{Crossing, Isolation, Line};
use crate::march::{Arrived, ITERATIONS, ORDINAL, Sink, Stream, stream};
use crate::marcher::{Auto, Enhanced, Fixed, Marcher, Relaxed, Sphere};
use crate::ray::{Common, Queue, WideRay};
use crate::simd::{Chosen, INSIDE, Sheet, TILE_RAYS};
use crate::tile::{Exhausted, Hits, Rays, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_eval::Workspace;
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real};
use zeroset_scene::settings::March;
use zeroset_shade::march::{LEAST_SHARE, LEAST_SHARE_OF_FRACTALS};
use zeroset_shade::view::Linear;

/// Smoothing of [`Auto`] for rays that go on, as scenes have it where they say nothing.
const BETA: f32 = 0.3;

/// How rays are marched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) march: March,
    /// Whether the rest of rays that run out of steps is searched.
    pub(crate) select: bool,
    /// Whether the steps of rays that hit nothing are wanted.
    pub(crate) steps: bool,
}

/// The parts of the scratch memory that finding hits takes.
pub(crate) struct MarchMemory<'q> {
    pub(crate) hits: &'q mut Hits,
    pub(crate) rays: &'q mut Rays,
    pub(crate) work: &'q mut Workspace,
    /// Evaluations of the rays that hit nothing, by number.
    pub(crate) steps: &'q mut Sheet,
    pub(crate) exhausted: &'q mut Vec<Exhausted>,
}

impl Scratch {
    /// The queue, and what following its rays takes.
    pub(crate) fn split(&mut self) -> (&Queue, MarchMemory<'_>) {
        let memory = MarchMemory {
            hits: &mut self.hits,
            rays: &mut self.rays,
            work: &mut self.work,
            steps: &mut self.steps,
            exhausted: &mut self.exhausted,
        };
        (&self.queue, memory)
    }
}

/// Finds where the rays of the queue first meet the surface, in the order in which they do. What is found of a hit is its ray, the
/// part of it in which the surface is, the side, and the evaluations; [`crate::normal`] finds the place. Returns the evaluations.
pub(crate) fn closest<S: Simd>(
    s: S,
    plan: &Plan,
    solid: &Solid<'_>,
    queue: &Queue,
    q: MarchMemory<'_>,
) -> u64 {
    match plan.march {
        March::Fixed { step } => first(s, Fixed { step }, plan, solid, queue, q),
        March::Sphere => first(s, Sphere, plan, solid, queue, q),
        March::Relaxed { omega } => first(s, Relaxed { omega }, plan, solid, queue, q),
        March::Enhanced { share } => first(s, Enhanced { share }, plan, solid, queue, q),
        March::Auto { beta } => first(s, Auto { beta }, plan, solid, queue, q),
    }
}

/// How rays are followed: their footprint is what pixels of this many samples have.
fn stream_of<'a>(solid: &'a Solid<'a>) -> Stream<'a> {
    let share = if solid.fractal {
        1.0 / (solid.samples as f32).sqrt()
    } else {
        solid.view.fine
    };
    Stream {
        solid,
        width: Linear {
            slope: 0.0,
            constant: 0.0,
        },
        share: 1.0,
        near: solid.view.footprint(share),
        least: if solid.fractal {
            LEAST_SHARE_OF_FRACTALS
        } else {
            LEAST_SHARE
        },
        touch: solid.fractal,
        max_steps: solid.max_steps,
    }
}

/// As [`closest`], but the rays go on behind the surfaces that they meet, until each of them met `most`: all crossings, in the order
/// in which the rays come to them. Fractals are met once: what is behind an estimate is not known.
///
/// The queue holds so few rays that there is room for `most` crossings of each.
pub(crate) fn crossings<S: Simd>(
    s: S,
    most: usize,
    solid: &Solid<'_>,
    queue: &Queue,
    q: MarchMemory<'_>,
) -> u64 {
    debug_assert!(queue.count * most <= TILE_RAYS);
    q.hits.count = 0;
    q.hits.common = queue.common;
    q.exhausted.clear();
    q.steps[..queue.count].fill(0.0);
    let mut all = AllHits {
        most: most as f32,
        fractal: solid.fractal,
        hits: q.hits,
        met: q.steps,
        exhausted: q.exhausted,
    };
    // whatever the marcher is, the surfaces are the same: one does for all scenes
    let marcher = Auto { beta: BETA };
    let mut how = stream_of(solid);
    how.max_steps = how.max_steps.saturating_mul(most as u32).min(ITERATIONS);
    let evaluations = stream(s, marcher, &how, queue, q.rays, q.work, &mut all);
    evaluations + search(true, solid, q.exhausted, q.hits)
}

fn first<S: Simd, M: Marcher>(
    s: S,
    marcher: M,
    plan: &Plan,
    solid: &Solid<'_>,
    queue: &Queue,
    q: MarchMemory<'_>,
) -> u64 {
    q.hits.count = 0;
    q.hits.common = queue.common;
    q.exhausted.clear();
    let mut list = FirstHits {
        plan,
        fractal: solid.fractal,
        hits: q.hits,
        steps: q.steps,
        exhausted: q.exhausted,
    };
    let how = stream_of(solid);
    let evaluations = stream(s, marcher, &how, queue, q.rays, q.work, &mut list);
    evaluations + search(plan.select, solid, q.exhausted, q.hits)
}

/// What becomes of rays.
struct FirstHits<'a> {
    plan: &'a Plan,
    fractal: bool,
    hits: &'a mut Hits,
    steps: &'a mut Sheet,
    exhausted: &'a mut Vec<Exhausted>,
}

impl<S: Simd> Sink<S> for FirstHits<'_> {
    #[inline(always)]
    fn found(&mut self, done: Chosen<S>, common: &Common, at: &Arrived<S>) {
        self.hits.add(self.fractal, done, common, at);
    }
    #[inline(always)]
    fn left(&mut self, gone: LaneMask<S>, at: &Arrived<S>) {
        if !self.plan.steps {
            return;
        }
        let mut bits = gone.0.to_bitmask();
        while bits != 0 {
            let k = bits.trailing_zeros() as usize;
            self.steps[(at.word.as_slice()[k] & ORDINAL) as usize] =
                at.steps().as_slice()[k] as f32;
            bits &= bits - 1;
        }
    }
    fn spent(&mut self, rays: &Rays, common: &Common, i: usize) {
        self.exhausted.push(Exhausted::of(rays, common, i));
    }
}

/// What becomes of rays that go on.
struct AllHits<'a> {
    /// Surfaces that a ray may meet.
    most: f32,
    fractal: bool,
    hits: &'a mut Hits,
    /// Those that each has met.
    met: &'a mut Sheet,
    exhausted: &'a mut Vec<Exhausted>,
}

impl<S: Simd> Sink<S> for AllHits<'_> {
    const CROSSES: bool = true;
    #[inline(always)]
    fn found(&mut self, done: Chosen<S>, common: &Common, at: &Arrived<S>) {
        self.hits.add(self.fractal, done, common, at);
    }
    #[inline(always)]
    fn goes_on(&mut self, crossed: LaneMask<S>, at: &Arrived<S>) -> LaneMask<S> {
        let (mut bits, mut on) = (crossed.0.to_bitmask(), 0);
        if self.fractal {
            bits = 0;
        }
        while bits != 0 {
            let k = bits.trailing_zeros();
            let met = &mut self.met[(at.word.as_slice()[k as usize] & ORDINAL) as usize];
            *met += 1.0;
            on |= u64::from(*met < self.most) << k;
            bits &= bits - 1;
        }
        LaneMask(S::mask32s::from_bitmask(at.t.0.token(), on))
    }
    #[inline(always)]
    fn left(&mut self, _gone: LaneMask<S>, _at: &Arrived<S>) {}
    fn spent(&mut self, rays: &Rays, common: &Common, i: usize) {
        self.exhausted.push(Exhausted::of(rays, common, i));
    }
}

/// Looks for the surface on the rest of the rays that ran out of steps. Only what the search cannot tell, or fractals, are
/// taken where they stand, and only if that is under a pixel (Keinert 2014, 3.2).
fn search(select: bool, solid: &Solid<'_>, exhausted: &[Exhausted], hits: &mut Hits) -> u64 {
    if exhausted.is_empty() {
        return 0;
    }
    let mut evaluations = 0;
    let mut isolation = Isolation::new(solid.program.marched());
    for at in exhausted {
        let line = Line {
            origin: at.ray.origin.array(),
            direction: at.ray.direction.array(),
            inside: at.word & INSIDE != 0,
        };
        let near = solid.near(&at.ray, at.t);
        let found = if select && !solid.fractal {
            let least = near * solid.view.fine * LEAST_SHARE;
            isolation.first(&line, at.t, at.end, least)
        } else {
            Crossing::Unknown(at.t)
        };
        let spent = isolation.take_evaluations();
        evaluations += spent;
        if solid.stop.before(spent as usize) {
            break;
        }
        let t = match found {
            Crossing::None => continue,
            Crossing::At(t) => t,
            Crossing::Unknown(t) if isolation.distance(&line, t) < 2.0 * near => t,
            Crossing::Unknown(_) => continue,
        };
        hits.push(&at.ray, t, at.word, solid.max_steps);
    }
    evaluations
}

impl Exhausted {
    fn of(rays: &Rays, common: &Common, i: usize) -> Exhausted {
        Exhausted {
            ray: rays.ray.get(common, i),
            t: rays.t[i],
            end: rays.end[i],
            word: rays.word[i],
        }
    }
}

impl Hits {
    /// Adds rays that met the surface. A hit of a fractal stays where its last sample was: the detail between two of them has no end.
    #[inline(always)]
    fn add<S: Simd>(&mut self, fractal: bool, done: Chosen<S>, common: &Common, at: &Arrived<S>) {
        let n = self.count;
        self.rays.put(done, common, &at.ray, n);
        let (t, beyond, f) = if fractal {
            let crossed = at.beyond.above(0.0);
            let f = Lanes::select(crossed, at.behind, at.clearance);
            (at.t + at.beyond, at.beyond * 0.0, f)
        } else {
            (at.t, at.beyond, at.clearance)
        };
        done.put(t, &mut self.t, n);
        done.put(beyond, &mut self.beyond, n);
        done.put(f, &mut self.f, n);
        done.put(at.behind, &mut self.behind, n);
        done.put_words(at.word, &mut self.word, n);
        done.put(Lanes(at.steps().to_float::<S::f32s>()), &mut self.steps, n);
        self.count += done.count;
    }

    fn push(&mut self, ray: &WideRay<f32>, t: f32, word: u32, steps: u32) {
        let n = self.count;
        self.rays.set(n, ray);
        (self.t[n], self.word[n], self.steps[n]) = (t, word, steps as f32);
        (self.beyond[n], self.f[n], self.behind[n]) = (0.0, 0.0, 0.0);
        self.count += 1;
    }
}
