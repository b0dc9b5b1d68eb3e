//! Primary rays: from the spans that the prepass found to the list of hits.

use crate::isolate::{Crossing, Isolation, Line};
use crate::march::{Arrived, ORDINAL, Sink, Source, Stream, stream};
use crate::marcher::{Auto, Enhanced, Fixed, Marcher, Relaxed, Sphere};
use crate::order;
use crate::simd::{Chosen, INSIDE, Sheet, load};
use crate::tile::{Area, HEIGHT, Hits, Rays, Scratch, Solid, WIDTH};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3};
use zeroset_scene::settings::March;
use zeroset_shade::march::{LEAST_SHARE, LEAST_SHARE_OF_FRACTALS};
use zeroset_shade::view::Linear;

/// How the march of a picture is done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) march: March,
    /// Whether the rest of rays that run out of steps is searched.
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
    let view = solid.view;
    let share = if solid.fractal {
        1.0 / (solid.samples as f32).sqrt()
    } else {
        view.fine
    };
    let how = Stream {
        solid,
        width: Linear {
            slope: 0.0,
            constant: 0.0,
        },
        share: 1.0,
        near: view.footprint(share),
        narrows: view.pinhole,
        least: if solid.fractal {
            LEAST_SHARE_OF_FRACTALS
        } else {
            LEAST_SHARE
        },
        touch: solid.fractal,
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
        fractal: solid.fractal,
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
        search(plan, &how, area, q);
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
    /// A hit stays where its last sample was: the detail between two of them has no end.
    fractal: bool,
    hits: &'a mut Hits,
    steps: &'a mut Sheet,
    exhausted: &'a mut Vec<(u32, f32)>,
}

impl<S: Simd> Sink<S> for List<'_> {
    #[inline(always)]
    fn found(&mut self, done: Chosen<S>, at: &Arrived<S>) {
        let hits = &mut *self.hits;
        let n = hits.count;
        done.put3(at.ray, &mut hits.ray, n);
        let (t, beyond, f) = if self.fractal {
            let crossed = at.beyond.above(0.0);
            let f = Lanes::select(crossed, at.behind, at.clearance);
            (at.t + at.beyond, at.beyond * 0.0, f)
        } else {
            (at.t, at.beyond, at.clearance)
        };
        done.put(t, &mut hits.t, n);
        done.put(beyond, &mut hits.beyond, n);
        done.put(f, &mut hits.f, n);
        done.put(at.behind, &mut hits.behind, n);
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
        self.exhausted.push((rays.word[i], rays.t[i]));
    }
}

/// Looks for the surface on the rest of the rays that ran out of steps. Only what the search cannot tell, or fractals, are
/// taken where they stand, and only if that is under a pixel (Keinert 2014, 3.2).
fn search(plan: &Plan, how: &Stream<'_>, area: &Area, q: &mut Scratch) {
    let (solid, exhausted) = (how.solid, std::mem::take(&mut q.exhausted));
    let mut isolation = Isolation::new(solid.program);
    for &(word, t) in &exhausted {
        let k = (word & ORDINAL) as usize;
        let x = order::X[k] + area.x as f32 + q.jitter[0][k];
        let y = order::Y[k] + area.y as f32 + q.jitter[1][k];
        let ray = solid.view.ray(x, y);
        let (o, d) = solid.view.split(ray);
        let line = Line {
            origin: o.array(),
            direction: d.array(),
            inside: word & INSIDE != 0,
        };
        let near = solid.view.near(t, solid.view.narrow(ray));
        let found = if plan.select && !solid.fractal {
            isolation.first(
                &line,
                t,
                q.spans.end[k],
                near * solid.view.fine * LEAST_SHARE,
            )
        } else {
            Crossing::Unknown(t)
        };
        let spent = isolation.take_evaluations();
        q.counts.march += spent;
        if solid.stop.before(spent as usize) {
            break;
        }
        let t = match found {
            Crossing::None => continue,
            Crossing::At(t) => t,
            Crossing::Unknown(t) if isolation.distance(&line, t) < 2.0 * near => t,
            Crossing::Unknown(_) => continue,
        };
        q.hits.push(ray.array(), t, word, solid.max_steps);
    }
    q.exhausted = exhausted;
    q.exhausted.clear();
}

impl Hits {
    fn push(&mut self, ray: [f32; 3], t: f32, word: u32, steps: u32) {
        let n = self.count;
        self.ray
            .iter_mut()
            .zip(ray)
            .for_each(|(column, x)| column[n] = x);
        (self.t[n], self.word[n], self.steps[n]) = (t, word, steps as f32);
        (self.beyond[n], self.f[n], self.behind[n]) = (0.0, 0.0, 0.0);
        self.count += 1;
    }
}
