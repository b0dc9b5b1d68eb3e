//! Primary rays: from the spans that the prepass found to the list of hits.

use crate::march::{Arrived, ORDINAL, Sink, Source, Stream, stream};
use crate::marcher::{Advance, Auto, Enhanced, Fixed, Marcher, Relaxed, Sphere, Step};
use crate::order;
use crate::simd::{Chosen, Row, Sheet, along, load, load_words, load3, sided, store, store3};
use crate::tile::{Area, HEIGHT, Hits, Rays, Scratch, Solid, WIDTH};
use fearless_simd::{Simd, prelude::*};
use zeroset_field::eval::{self, BATCH};
use zeroset_field::number::lanes::LaneMask;
use zeroset_field::number::{Lanes, Ops, Real, Vec3};
use zeroset_scene::settings::March;
use zeroset_scene::view::Linear;

/// How the march of a picture is done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) march: March,
    /// Whether rays that run out of steps take their best candidate.
    pub(crate) select: bool,
    /// Whether the steps of rays that hit nothing are wanted.
    pub(crate) steps: bool,
}

/// Marches the rays of all pixels that have a span, into the list of hits.
pub(crate) fn march<S: Simd>(s: S, plan: &Plan, solid: &Solid<'_>, area: &Area, q: &mut Scratch) {
    match plan.march {
        March::Fixed { step } => run(s, Fixed { step }, plan, solid, area, q),
        March::Sphere => run(s, Sphere, plan, solid, area, q),
        March::Relaxed { omega } => run(s, Relaxed { omega }, plan, solid, area, q),
        March::Enhanced { share } => run(s, Enhanced { share }, plan, solid, area, q),
        March::Auto { beta } => run(s, Auto { beta }, plan, solid, area, q),
    }
}

fn run<S: Simd, M: Marcher>(
    s: S,
    marcher: M,
    plan: &Plan,
    solid: &Solid<'_>,
    area: &Area,
    q: &mut Scratch,
) {
    let how = Stream {
        solid,
        width: Linear {
            slope: 0.0,
            constant: 0.0,
        },
        share: 1.0,
        threshold: solid.threshold(),
        max_steps: solid.max_steps,
    };
    let pixels = Pixels {
        solid,
        area,
        jitter: &q.jitter,
    };
    q.hits.count = 0;
    q.exhausted.clear();
    let mut list = List {
        plan,
        max_steps: solid.max_steps,
        hits: &mut q.hits,
        steps: &mut q.steps,
        exhausted: &mut q.exhausted,
    };
    let count = WIDTH * HEIGHT;
    q.counts.march += stream(
        s,
        marcher,
        &how,
        &pixels,
        &q.spans,
        count,
        &mut q.rays,
        &mut q.work,
        &mut list,
    );
    if !q.exhausted.is_empty() {
        select(s, marcher, solid, area, q);
    }
}

/// The rays of a tile, one a pixel.
struct Pixels<'a> {
    solid: &'a Solid<'a>,
    area: &'a Area,
    /// Where in its pixel each goes through.
    jitter: &'a [Box<Sheet>; 2],
}

impl<S: Simd> Source<S> for Pixels<'_> {
    #[inline(always)]
    fn ray(&self, s: S, i: usize) -> Vec3<Lanes<S>> {
        let x = load(s, &order::X, i) + self.area.x as f32;
        let y = load(s, &order::Y, i) + self.area.y as f32;
        self.solid.view.ray(
            x + load(s, &self.jitter[0], i),
            y + load(s, &self.jitter[1], i),
        )
    }
    #[inline(always)]
    fn exists(&self, s: S, i: usize) -> LaneMask<S> {
        load(s, &order::X, i).below(self.area.width as f32)
            & load(s, &order::Y, i).below(self.area.height as f32)
    }
}

/// What becomes of rays.
struct List<'a> {
    plan: &'a Plan,
    max_steps: u32,
    hits: &'a mut Hits,
    steps: &'a mut Sheet,
    exhausted: &'a mut Vec<u32>,
}

impl<S: Simd> Sink<S> for List<'_> {
    #[inline(always)]
    fn found(&mut self, done: Chosen<S>, at: &Arrived<S>) {
        let hits = &mut *self.hits;
        let n = hits.count;
        done.put3(at.ray, &mut hits.ray, n);
        done.put(at.t, &mut hits.t, n);
        done.put(at.f, &mut hits.f, n);
        done.put_words(at.word, &mut hits.word, n);
        done.put(Lanes(at.steps().to_float::<S::f32s>()), &mut hits.steps, n);
        hits.count += done.count;
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
    fn spent(&mut self, rays: &Rays, i: usize) {
        if self.plan.select {
            self.exhausted.push(rays.word[i]);
        } else {
            // where it stands is taken for the surface
            let ray = rays.ray.each_ref().map(|c| c[i]);
            self.hits
                .push(ray, rays.t[i], rays.r[i], rays.word[i], self.max_steps);
        }
    }
}

impl Hits {
    fn push(&mut self, ray: [f32; 3], t: f32, f: f32, word: u32, steps: u32) {
        let n = self.count;
        self.ray
            .iter_mut()
            .zip(ray)
            .for_each(|(column, x)| column[n] = x);
        (self.t[n], self.f[n], self.word[n], self.steps[n]) = (t, f, word, steps as f32);
        self.count += 1;
    }
}

/// Marches the rays that ran out of steps once more, and takes of all their samples the one whose unbounding sphere is the
/// smallest on the picture (Keinert 2014, 3.2). To keep track of it in every march would cost all rays.
fn select<S: Simd, M: Marcher>(s: S, marcher: M, solid: &Solid<'_>, area: &Area, q: &mut Scratch) {
    let exhausted = std::mem::take(&mut q.exhausted);
    for words in exhausted.chunks(BATCH) {
        let n = words.len();
        let rays = &mut *q.rays;
        let (mut error, mut place, mut value) = (Row::ZERO, Row::ZERO, Row::ZERO);
        error.fill(f32::INFINITY);
        for (i, &word) in words.iter().enumerate() {
            let k = (word & ORDINAL) as usize;
            let x = order::X[k] + area.x as f32 + q.jitter[0][k];
            let y = order::Y[k] + area.y as f32 + q.jitter[1][k];
            let ray = solid.view.ray(x, y);
            rays.ray
                .iter_mut()
                .zip(ray.array())
                .for_each(|(column, c)| column[i] = c);
            (rays.t[i], rays.end[i], rays.m[i]) =
                (q.spans.start[k], q.spans.end[k], q.spans.slope[k]);
            (rays.r[i], rays.word[i]) = (q.spans.radius[k].abs(), word);
            rays.z[i] = marcher
                .begin(rays.r[i], rays.m[i])
                .min(rays.end[i] - rays.t[i]);
            place[i] = rays.t[i];
        }
        s.vectorize(
            #[inline(always)]
            || {
                for number in 0..solid.max_steps {
                    let points = q.work.points_mut();
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let (o, d) = solid.view.split(load3(s, &rays.ray, i));
                        store3(
                            along(o, d, load(s, &rays.t, i) + load(s, &rays.z, i)),
                            points,
                            i,
                        );
                    }
                    eval::values(s, solid.program, &mut q.work, n);
                    q.counts.march += n as u64;
                    let first = LaneMask(S::mask32s::splat(s, number == 0));
                    for i in (0..n).step_by(S::f32s::LEN) {
                        let f = sided(load(s, &q.work.values().0, i), load_words(s, &rays.word, i));
                        let (t, z, end) = (
                            load(s, &rays.t, i),
                            load(s, &rays.z, i),
                            load(s, &rays.end, i),
                        );
                        let threshold = solid.threshold().at(t + z);
                        let at = Step {
                            t,
                            z,
                            r: load(s, &rays.r, i),
                            m: load(s, &rays.m, i),
                        };
                        let Advance { step, kept, .. } = marcher.advance(at, f, threshold, first);
                        let (size, least) = (f.abs() / threshold, load(s, &error, i));
                        let better = kept & size.below(least);
                        store(Lanes::select(better, size, least), &mut error, i);
                        store(
                            Lanes::select(better, t + z, load(s, &place, i)),
                            &mut place,
                            i,
                        );
                        store(Lanes::select(better, f, load(s, &value, i)), &mut value, i);
                        store(step.t, &mut rays.t, i);
                        store(step.z.min(end - step.t), &mut rays.z, i);
                        store(step.r, &mut rays.r, i);
                        store(step.m, &mut rays.m, i);
                    }
                }
            },
        );
        for (i, &word) in words.iter().enumerate() {
            let ray = rays.ray.each_ref().map(|c| c[i]);
            q.hits.push(ray, place[i], value[i], word, solid.max_steps);
        }
    }
    q.exhausted = exhausted;
}
