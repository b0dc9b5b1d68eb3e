//! Antialiasing by coverage: pixels that an edge goes through are parted, see [`zeroset_shade::coverage`].

use crate::march::{ITERATIONS, ORDINAL, ORDINAL_BITS, age};
use crate::order;
use crate::paths::{PathRay, PathState, Paths};
use crate::primary;
use crate::ray::{Common, Queue, RayColumns, WideRay};
use crate::simd::{
    Chosen, INSIDE, Row, Sheet, TILE_RAYS, WordRow, WordSheet, along, first_lanes, load,
    load_words, sided, splat, store3,
};
use crate::tile::{Area, Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_eval::{BATCH, Workspace};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec2, Vec3, v2, v3};
use zeroset_shade::coverage::{
    Cone, Edge, FRACTAL, PASSES, Part, SMALLEST, SOLID, STEPS, UNSEEN, watch,
};
use zeroset_shade::view::{Linear, View};

/// What became of a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Outcome {
    /// It met nothing.
    Clear,
    /// It is covered, or it ran out of steps: a ray finds what is there, from where the cone was free.
    Covered { free: f32 },
    /// It passed an edge.
    Passed(Passed),
}

/// An edge that a cone passed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Passed {
    /// Where the field was least in proportion to the cone's radius.
    at: f32,
    /// From here on the cone is behind the edge.
    behind: f32,
    /// On which side of the surface it is.
    inside: bool,
    /// Whether the edge is the horizon, behind which a plane fades.
    is_horizon: bool,
}

/// A part of a pixel, of which it is not known yet what covers it.
#[derive(Clone, Copy, Debug)]
struct Open {
    pixel: usize,
    part: Part,
    /// Its middle.
    middle: Vec2<f32>,
    /// Behind the last edge.
    start: f32,
    /// Whether its cone is inside a solid there.
    inside: bool,
    /// Edges that may still part it.
    layers: u32,
    /// Edges that it passed which did not cross it.
    passes: u32,
}

/// Cones on their way, one a lane.
struct Rows {
    ray: RayColumns<Row>,
    t: Row,
    z: Row,
    f: Row,
    slope: Row,
    low: Row,
    at: Row,
    high: Row,
    free: Row,
    end: Row,
    /// Radius of the cone, in widths of a pixel of the middle of the picture.
    wide: Row,
    /// See [`crate::march`].
    word: WordRow,
    count: usize,
}

/// What following cones takes.
struct Cones {
    rows: Box<Rows>,
    /// By number of the cone.
    wide: Box<Sheet>,
    /// The sides that they are on, where they are known: see [`KNOWN`].
    side: Box<WordSheet>,
    outcomes: Vec<Outcome>,
}

/// What finding the parts of a tile's pixels takes.
pub(crate) struct Coverage {
    cones: Cones,
    queue: Queue,
    /// Parts whose cones are to be followed.
    open: Vec<Open>,
    /// Those whose cones are followed.
    followed: Vec<Open>,
    /// Those whose cones passed edges.
    passed: Vec<(Open, Passed)>,
}

/// The bit of [`Cones::side`] that says that the side is known.
const KNOWN: u32 = 1;
/// The value of a cone before its first sample where the side is not known.
const UNKNOWN: f32 = 1.0;

impl Coverage {
    pub(crate) fn new() -> Coverage {
        let row = || Row::ZERO;
        Coverage {
            cones: Cones {
                rows: Box::new(Rows {
                    ray: RayColumns::new(row),
                    t: row(),
                    z: row(),
                    f: row(),
                    slope: row(),
                    low: row(),
                    at: row(),
                    high: row(),
                    free: row(),
                    end: row(),
                    wide: row(),
                    word: *WordRow::boxed(),
                    count: 0,
                }),
                wide: Sheet::boxed(),
                side: WordSheet::boxed(),
                outcomes: vec![Outcome::Clear; TILE_RAYS],
            },
            queue: Queue::new(),
            open: Vec::new(),
            followed: Vec::new(),
            passed: Vec::new(),
        }
    }
}

/// A picture's pixels and what is in them.
struct Pixels<'a> {
    solid: &'a Solid<'a>,
    area: &'a Area,
}

impl Pixels<'_> {
    /// The ray through a place of a pixel, from its middle.
    fn ray(&self, pixel: usize, place: Vec2<f32>) -> WideRay<f32> {
        let view = self.solid.view;
        let ray = view.ray(
            order::X[pixel] + self.area.x as f32 + 0.5 + place.x,
            order::Y[pixel] + self.area.y as f32 + 0.5 + place.y,
        );
        let (origin, direction) = view.split(ray);
        WideRay {
            origin,
            direction,
            narrow: view.narrow(ray),
            travelled: 0.0,
        }
    }

    /// The line in which the surface crosses the picture, from its value and gradient at `at` on the ray.
    fn edge(
        &self,
        ray: &WideRay<f32>,
        from: Vec2<f32>,
        at: f32,
        value: f32,
        gradient: [f32; 3],
    ) -> Edge {
        let view = self.solid.view;
        let [gx, gy, gz] = gradient;
        let along = |[x, y, z]: [f32; 3]| gx * x + gy * y + gz * z;
        // the side of a pixel on the plane through the place
        let side = match view.pinhole {
            true => -at * ray.direction.dot(vector(view.back)) * view.scale,
            false => view.scale,
        };
        Edge {
            value,
            slope: v2(side * along(view.right), -side * along(view.up)),
            from,
        }
    }
}

/// What an edge leaves of a part of a pixel.
enum Covered {
    /// All of it is covered.
    Whole,
    /// None of it.
    Not,
    /// That part of the pixel, with this middle.
    Part { share: f32, middle: Vec2<f32> },
}

/// Parts the pixels of a tile by up to `layers` edges each. The queue holds the rays through their middles, with the spans of the
/// prepass. Afterwards it holds one ray of each pixel, which counts as much as `q.paths` says; the rays of other parts wait there.
pub(crate) fn part<S: Simd>(s: S, solid: &Solid<'_>, area: &Area, layers: u32, q: &mut Scratch) {
    q.paths.begin();
    let pixels = Pixels { solid, area };
    let Scratch {
        coverage,
        queue,
        paths,
        jitter,
        work,
        counts,
        ..
    } = q;
    let Coverage {
        cones,
        queue: later,
        open,
        followed,
        passed,
    } = coverage;
    let reach = Part::PIXEL.reach(v2(0.0, 0.0));
    for i in 0..queue.count {
        cones.wide[i] = reach * widening(solid.view, queue.rays.get(&queue.common, i).narrow);
        let radius = queue.spans.radius[i];
        let known = radius.to_bits() & INSIDE | KNOWN;
        cones.side[i] = if radius != 0.0 { known } else { 0 };
    }
    counts.march += follow(s, solid, queue, cones, work);
    open.clear();
    passed.clear();
    for i in 0..queue.count {
        match cones.outcomes[i] {
            Outcome::Clear => queue.spans.start[i] = f32::INFINITY,
            Outcome::Covered { free } => {
                let spans = &mut queue.spans;
                if free > spans.start[i] {
                    // nothing is known of what is empty there
                    spans.radius[i] = 0.0;
                    spans.start[i] = free;
                }
            }
            Outcome::Passed(edge) => {
                let whole = Open {
                    pixel: i,
                    part: Part::PIXEL,
                    middle: v2(0.0, 0.0),
                    start: queue.spans.start[i],
                    inside: false,
                    layers,
                    passes: 0,
                };
                passed.push((whole, edge));
            }
        }
    }
    counts.march += cross(s, &pixels, passed, work, |whole, covered, rest| {
        match covered {
            Covered::Whole => {}
            Covered::Not => {
                // its ray comes later
                paths.set_share(whole.pixel, 0.0);
                queue.spans.start[whole.pixel] = f32::INFINITY;
            }
            Covered::Part { share, middle } => {
                paths.set_share(whole.pixel, share);
                (jitter[0][whole.pixel], jitter[1][whole.pixel]) = (middle.x + 0.5, middle.y + 0.5);
            }
        }
        keep(&pixels, paths, open, rest);
    });
    primary::aim(s, solid.view, area, jitter, queue);
    while !open.is_empty() && !solid.stop.is_set() {
        let from = open.len().saturating_sub(TILE_RAYS);
        followed.clear();
        followed.extend(open.drain(from..));
        later.count = 0;
        later.common = Common::default();
        for (i, open) in followed.iter().enumerate() {
            let ray = pixels.ray(open.pixel, open.middle);
            cones.wide[i] = open.part.reach(open.middle) * widening(solid.view, ray.narrow);
            cones.side[i] = if open.inside { INSIDE | KNOWN } else { KNOWN };
            let radius = cones.wide[i];
            let (slope, constant) = (
                radius * solid.view.pixel.slope,
                radius * solid.view.pixel.constant,
            );
            let end = (solid.region)
                .leave(ray.origin, ray.direction, slope, constant)
                .min(solid.view.far);
            later.push(&ray, open.start, end);
        }
        counts.march += follow(s, solid, later, cones, work);
        passed.clear();
        for (open, outcome) in followed.iter().zip(&cones.outcomes) {
            match outcome {
                Outcome::Passed(edge) if open.passes < PASSES => {
                    passed.push((*open, *edge));
                }
                Outcome::Clear => send(&pixels, paths, open, f32::INFINITY),
                Outcome::Covered { free } => send(&pixels, paths, open, *free),
                Outcome::Passed(_) => send(&pixels, paths, open, open.start),
            }
        }
        counts.march += cross(s, &pixels, passed, work, |part, covered, rest| {
            match covered {
                Covered::Whole => send(&pixels, paths, part, part.start),
                Covered::Not => {}
                Covered::Part { share, middle } => {
                    let ray = pixels.ray(part.pixel, middle);
                    let state = PathState::from_eye(part.pixel, share);
                    let start = part.start;
                    paths.push_from_eye(PathRay { ray, state, start });
                }
            }
            keep(&pixels, paths, open, rest);
        });
    }
}

/// Keeps what an edge left of a part for a cone of its own, or leaves a ray where no more edges may part it.
fn keep(pixels: &Pixels<'_>, paths: &mut Paths, open: &mut Vec<Open>, rest: Option<Open>) {
    match rest {
        Some(rest) if rest.layers > 0 => open.push(rest),
        Some(rest) => send(pixels, paths, &rest, rest.start),
        None => {}
    }
}

/// Leaves a ray that shows a part of a pixel.
fn send(pixels: &Pixels<'_>, paths: &mut Paths, open: &Open, start: f32) {
    let ray = pixels.ray(open.pixel, open.middle);
    let state = PathState::from_eye(open.pixel, open.part.measure().0);
    paths.push_from_eye(PathRay { ray, state, start });
}

fn vector([x, y, z]: [f32; 3]) -> Vec3<f32> {
    v3(x, y, z)
}

/// How much wider a pixel is, across rays that are so narrow, than one in the middle of the picture at the same distance.
#[inline(always)]
fn widening(view: &View, narrow: f32) -> f32 {
    if view.pinhole { narrow.sqrt() } else { 1.0 }
}

/// Point number `k` to evaluate: that at the distance `t` of a ray.
fn put(work: &mut Workspace, k: usize, ray: &WideRay<f32>, t: f32) {
    let p = (ray.origin + ray.direction * t).array();
    for (column, x) in work.points_mut().iter_mut().zip(p) {
        column.0[k] = x;
    }
}

/// Finds which parts the edges cover that cones passed, and hands them on with what is left of the part. Returns the evaluations.
fn cross<S: Simd>(
    s: S,
    pixels: &Pixels<'_>,
    passed: &[(Open, Passed)],
    work: &mut Workspace,
    mut found: impl FnMut(&Open, Covered, Option<Open>),
) -> u64 {
    let mut evaluations = 0;
    for batch in passed.chunks(BATCH) {
        if pixels.solid.stop.before(batch.len()) {
            break;
        }
        for (k, (open, edge)) in batch.iter().enumerate() {
            put(work, k, &pixels.ray(open.pixel, open.middle), edge.at);
        }
        pixels.solid.gradients(s, work, batch.len());
        evaluations += batch.len() as u64;
        for (k, (open, passed)) in batch.iter().enumerate() {
            let sign = if passed.inside { -1.0 } else { 1.0 };
            let gradient = work.gradients().each_ref().map(|c| sign * c.0[k]);
            let ray = pixels.ray(open.pixel, open.middle);
            let value = match passed.is_horizon {
                // what comes before does not count, so far away
                true => passed.at * ray.direction.dot(vector(gradient)),
                false => sign * work.gradient_values().0[k],
            };
            let edge = pixels.edge(&ray, open.middle, passed.at, value, gradient);
            let behind = Open {
                start: passed.behind,
                inside: passed.inside,
                ..*open
            };
            let (covered, rest) = (open.part.side(&edge, true), open.part.side(&edge, false));
            let ((share, middle), (left, elsewhere)) = (covered.measure(), rest.measure());
            // numbers that are none are no edge
            if !(left >= SMALLEST && share + left > 0.0) {
                found(open, Covered::Whole, None);
            } else if share < SMALLEST {
                let passes = open.passes + 1;
                found(open, Covered::Not, Some(Open { passes, ..behind }));
            } else {
                let rest = Open {
                    part: rest,
                    middle: elsewhere,
                    layers: open.layers.saturating_sub(1),
                    ..behind
                };
                found(open, Covered::Part { share, middle }, Some(rest));
            }
        }
    }
    evaluations
}

/// Follows the cones of a queue. Returns the evaluations.
fn follow<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    queue: &Queue,
    cones: &mut Cones,
    work: &mut Workspace,
) -> u64 {
    s.vectorize(
        #[inline(always)]
        || {
            cones.outcomes[..queue.count].fill(Outcome::Clear);
            cones.rows.count = 0;
            let (mut next, mut iteration, mut evaluations) = (0, 0, 0);
            loop {
                while next < queue.count && cones.rows.count + S::f32s::LEN <= BATCH {
                    begin(s, queue, next..queue.count, iteration, cones);
                    next += S::f32s::LEN;
                }
                let rows = &cones.rows;
                if rows.count == 0 || solid.stop.before(rows.count) {
                    break;
                }
                let points = work.points_mut();
                for i in (0..rows.count).step_by(S::f32s::LEN) {
                    let ray = rows.ray.load(s, &queue.common, i);
                    let t = load(s, &rows.t, i) + load(s, &rows.z, i).abs();
                    store3(along(ray.origin, ray.direction, t), points, i);
                }
                solid.values(s, work, rows.count);
                evaluations += rows.count as u64;
                advance(s, solid, &queue.common, iteration, cones, work);
                iteration += 1;
                retire(solid.view.pixel, iteration, cones);
            }
            evaluations
        },
    )
}

/// Puts the first cones of the range into the batch.
#[inline(always)]
fn begin<S: Simd>(s: S, queue: &Queue, range: Range<usize>, iteration: u32, cones: &mut Cones) {
    let (at, spans) = (range.start, &queue.spans);
    let (start, end) = (load(s, &spans.start, at), load(s, &spans.end, at));
    let new = Chosen::new(start.below(end) & first_lanes(s, range.len()));
    if new.none() {
        return;
    }
    let rows = &mut cones.rows;
    let n = rows.count;
    rows.ray.put(new, &queue.common, &queue.ray(s, at), n);
    let zero = splat(s, 0.0);
    new.put(start, &mut rows.t, n);
    new.put(zero, &mut rows.z, n);
    let known = load_words(s, &cones.side, at) & KNOWN;
    let known = LaneMask(known.simd_gt(S::u32s::splat(s, 0)));
    // what a cone found before its first sample does not matter: it tells that the side is not known
    new.put(
        Lanes::select(known, zero, splat(s, UNKNOWN)),
        &mut rows.f,
        n,
    );
    new.put(load(s, &spans.slope, at), &mut rows.slope, n);
    new.put(zero, &mut rows.low, n);
    new.put(zero, &mut rows.at, n);
    new.put(splat(s, UNSEEN), &mut rows.high, n);
    new.put(start, &mut rows.free, n);
    new.put(end, &mut rows.end, n);
    new.put(load(s, &cones.wide, at), &mut rows.wide, n);
    let ordinal = S::u32s::from_fn(
        s,
        #[inline(always)]
        |k| k as u32,
    ) + (at as u32);
    let side = load_words(s, &cones.side, at) & INSIDE;
    let word = ordinal | side | (iteration & ITERATIONS) << ORDINAL_BITS;
    new.put_words(word, &mut rows.word, n);
    rows.count += new.count;
}

/// Moves every cone on, and takes those out that are done.
#[inline(always)]
fn advance<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    common: &Common,
    iteration: u32,
    cones: &mut Cones,
    work: &Workspace,
) {
    let count = cones.rows.count;
    let touched = if solid.fractal { FRACTAL } else { SOLID };
    let mut kept = 0;
    for i in (0..count).step_by(S::f32s::LEN) {
        let rows = &mut cones.rows;
        let live = first_lanes(s, count - i);
        let value = load(s, &work.values().0, i);
        let word = load_words(s, &rows.word, i);
        let first = LaneMask(
            (word >> ORDINAL_BITS & ITERATIONS).simd_eq(S::u32s::splat(s, iteration & ITERATIONS)),
        );
        let unknown: S::mask32s = first.0 & load(s, &rows.f, i).above(0.5 * UNKNOWN).0;
        let own = value.0.bitcast::<S::u32s>() & INSIDE;
        let word = word | unknown.select(own, S::u32s::splat(s, 0));
        let f = sided(value, word);
        let cone = Cone {
            t: load(s, &rows.t, i),
            z: load(s, &rows.z, i),
            f: load(s, &rows.f, i),
            slope: load(s, &rows.slope, i),
            low: load(s, &rows.low, i),
            at: load(s, &rows.at, i),
            high: load(s, &rows.high, i),
            free: load(s, &rows.free, i),
        };
        let (wide, end) = (load(s, &rows.wide, i), load(s, &rows.end, i));
        let ray = rows.ray.load(s, common, i);
        let way = cone.t + cone.z.abs();
        let radius = wide * solid.view.pixel.at(way) + solid.view.rounding.at(way);
        let next = watch(cone, f, radius, end, first, touched);
        let over = next.covered | next.edge | next.clear;
        let mut bits = (over & live).0.to_bitmask();
        if bits != 0 {
            let (covered, edge) = (next.covered.0.to_bitmask(), next.edge.0.to_bitmask());
            while bits != 0 {
                let k = bits.trailing_zeros() as usize;
                let number = word.as_slice()[k];
                cones.outcomes[(number & ORDINAL) as usize] = if covered >> k & 1 != 0 {
                    Outcome::Covered {
                        free: next.cone.free.0.as_slice()[k],
                    }
                } else if edge >> k & 1 != 0 {
                    Outcome::Passed(Passed {
                        at: next.cone.at.0.as_slice()[k],
                        behind: next.cone.t.0.as_slice()[k],
                        inside: number & INSIDE != 0,
                        is_horizon: false,
                    })
                } else {
                    Outcome::Clear
                };
                bits &= bits - 1;
            }
        }
        let on = Chosen::new(live & !over);
        if on.none() {
            continue;
        }
        let rows = &mut cones.rows;
        if !on.all() || kept != i {
            rows.ray.put(on, common, &ray, kept);
            on.put(end, &mut rows.end, kept);
            on.put(wide, &mut rows.wide, kept);
        }
        on.put_words(word, &mut rows.word, kept);
        on.put(next.cone.t, &mut rows.t, kept);
        on.put(next.cone.z, &mut rows.z, kept);
        on.put(next.cone.f, &mut rows.f, kept);
        on.put(next.cone.slope, &mut rows.slope, kept);
        on.put(next.cone.low, &mut rows.low, kept);
        on.put(next.cone.at, &mut rows.at, kept);
        on.put(next.cone.high, &mut rows.high, kept);
        on.put(next.cone.free, &mut rows.free, kept);
        kept += on.count;
    }
    cones.rows.count = kept;
}

/// Takes out the cones that ran out of steps, the first ones: rays find what is there.
#[inline(always)]
fn retire(pixel: Linear, iteration: u32, cones: &mut Cones) {
    let rows = &mut cones.rows;
    let words = &rows.word[..rows.count];
    let spent = (words.iter())
        .take_while(|word| age(**word, iteration) >= STEPS)
        .count();
    if spent == 0 {
        return;
    }
    for (k, word) in words[..spent].iter().enumerate() {
        // a plane comes ever nearer until the horizon
        let (slope, reach) = (rows.slope[k], rows.wide[k] * pixel.slope);
        let fades = rows.f[k] > 0.0 && reach > 0.0 && slope.abs() < reach;
        cones.outcomes[(word & ORDINAL) as usize] = if fades {
            Outcome::Passed(Passed {
                at: rows.t[k],
                behind: f32::INFINITY,
                inside: word & INSIDE != 0,
                is_horizon: true,
            })
        } else {
            Outcome::Covered { free: rows.free[k] }
        };
    }
    let rest = spent..rows.count;
    let columns = [
        &mut rows.t,
        &mut rows.z,
        &mut rows.f,
        &mut rows.slope,
        &mut rows.low,
        &mut rows.at,
        &mut rows.high,
        &mut rows.free,
        &mut rows.end,
        &mut rows.wide,
    ];
    for column in columns {
        column.copy_within(rest.clone(), 0);
    }
    rows.ray.move_to_front(rest.clone());
    rows.word.copy_within(rest, 0);
    rows.count -= spent;
}
