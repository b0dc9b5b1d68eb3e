//! The cone prepass: whole squares of pixels are marched as one cone each, so that their rays start near the surface.
//!
//! A cone of slope `k` is free up to `t` where the field is larger than its radius `w = k t + c`. Its clearance
//! `(f - w) / (1 + k)` is a distance along the axis: it changes by at most 1 per unit, as the field does along a ray. So
//! cones are marched like rays, by the same marchers.

use crate::march::{Arrived, ORDINAL, Sink, Stream, stream};
use crate::marcher::{Auto, Marcher, Sphere};
use crate::order;
use crate::primary;
use crate::ray::{Common, Queue};
use crate::simd::{Chosen, INSIDE, load, splat, store};
use crate::tile::{Area, HEIGHT, RaySpans, Rays, Scratch, Solid, WIDTH};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real};
use zeroset_scene::settings::March;
use zeroset_shade::march::{CONE_NEAR, CONE_STEPS};
use zeroset_shade::view::Linear;

/// Sides of the cells that are marched as one cone, in pixels. They nest, each with the next one's sides times 2 or 4.
const SIDES: [usize; 4] = [32, 8, 4, 2];
/// The cells for which the box of the scene is looked at where no cones are marched.
const COARSE: [usize; 1] = [8];
/// Share of that clearance that a step is at least long: longer ones could circle around a surface.
const LEAST: f32 = 0.5;
/// Share of a cone's clearance that the cones within it may count on: they lie within it but for rounding.
const FREE: f32 = 0.98;

/// Finds where the rays of every pixel of the tile start and end, and the slope of the field along them.
///
/// `reach` is how far rays go through a pixel from its middle, in pixels.
pub(crate) fn prepass<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    area: &Area,
    reach: f32,
    march: Option<March>,
    q: &mut Scratch,
) {
    q.parents.start[..TILE_TOP].fill(0.0);
    q.parents.end[..TILE_TOP].fill(f32::INFINITY);
    q.parents.slope[..TILE_TOP].fill(-1.0);
    q.parents.radius[..TILE_TOP].fill(0.0);
    let mut above = TOP;
    let sides: &[usize] = if march.is_some() { &SIDES } else { &COARSE };
    for &side in sides {
        let count = WIDTH / side * (HEIGHT / side);
        expand(s, above / side, count, q);
        let cells = Cells {
            solid,
            area,
            side,
            reach: 0.5 * (side as f32 - 1.0) + reach,
        };
        let width = enclose(s, &cells, count, q);
        match march {
            Some(March::Auto { beta }) => run(s, Auto { beta }, &cells, width, count, q),
            Some(_) => run(s, Sphere, &cells, width, count, q),
            None => {}
        }
        std::mem::swap(&mut q.queue.spans, &mut q.parents);
        above = side;
    }
    expand(s, above, WIDTH * HEIGHT, q);
    if area.width < WIDTH || area.height < HEIGHT {
        // what a tile has beyond the edge of the picture is not followed
        let beyond =
            |i: &usize| order::X[*i] >= area.width as f32 || order::Y[*i] >= area.height as f32;
        for i in (0..WIDTH * HEIGHT).filter(beyond) {
            q.queue.spans.start[i] = f32::INFINITY;
        }
    }
}

/// The whole tile is made of cells of this side.
const TOP: usize = 32;
const TILE_TOP: usize = WIDTH / TOP * (HEIGHT / TOP);

/// Gives every cell what its parent has. A parent has `ratio * ratio` cells.
fn expand<S: Simd>(s: S, ratio: usize, count: usize, q: &mut Scratch) {
    let (from, to) = (&q.parents, &mut q.queue.spans);
    let pairs = [
        (&from.start, &mut to.start),
        (&from.end, &mut to.end),
        (&from.slope, &mut to.slope),
        (&from.radius, &mut to.radius),
    ];
    s.vectorize(
        #[inline(always)]
        || {
            for (from, to) in pairs {
                match ratio {
                    1 => to[..count].copy_from_slice(&from[..count]),
                    2 => {
                        for i in (0..count / 4).step_by(S::f32s::LEN) {
                            let x = load(s, from, i).0;
                            for (k, pair) in [x.zip_low(x), x.zip_high(x)].into_iter().enumerate() {
                                let at = 4 * i + 2 * k * S::f32s::LEN;
                                store(Lanes::<S>(pair.zip_low(pair)), to, at);
                                store(Lanes::<S>(pair.zip_high(pair)), to, at + S::f32s::LEN);
                            }
                        }
                    }
                    _ => {
                        let cells = ratio * ratio;
                        for (cells, x) in to[..count].chunks_exact_mut(cells).zip(from.iter()) {
                            cells.fill(*x);
                        }
                    }
                }
            }
        },
    );
}

/// The cells of one size.
struct Cells<'a> {
    solid: &'a Solid<'a>,
    area: &'a Area,
    side: usize,
    /// How far their rays go from their middle, in pixels.
    reach: f32,
}

impl Cells<'_> {
    /// Middles of the cells from number `i` on, in pixels of the picture.
    #[inline(always)]
    fn middle<S: Simd>(&self, s: S, i: usize) -> (Lanes<S>, Lanes<S>) {
        let (side, half) = (self.side as f32, 0.5 * self.side as f32);
        (
            load(s, &order::X, i) * side + (self.area.x as f32 + half),
            load(s, &order::Y, i) * side + (self.area.y as f32 + half),
        )
    }

    /// Which of the cells from number `i` on have pixels of the picture.
    #[inline(always)]
    fn exist<S: Simd>(&self, s: S, i: usize) -> LaneMask<S> {
        let side = self.side as f32;
        (load(s, &order::X, i) * side).below(self.area.width as f32)
            & (load(s, &order::Y, i) * side).below(self.area.height as f32)
    }
}

/// Puts the cones of the cells into the queue, their spans cut to where they can meet the scene's box. Returns the width of the widest.
#[inline(always)]
fn enclose<S: Simd>(s: S, cells: &Cells<'_>, count: usize, q: &mut Scratch) -> Linear {
    let (view, region) = (cells.solid.view, &cells.solid.region);
    s.vectorize(
        #[inline(always)]
        || {
            let mut widest = Linear {
                slope: 0.0,
                constant: 0.0,
            };
            let Queue {
                rays,
                spans,
                common,
                ..
            } = &mut q.queue;
            *common = primary::common(view, Some(1.0));
            for i in (0..count).step_by(S::f32s::LEN) {
                let (x, y) = cells.middle(s, i);
                let (slope, constant) = view.cone(x, y, cells.reach);
                widest.slope = widest.slope.max(slope.0.reduce_max());
                widest.constant = constant;
                let ray = primary::ray(view, x, y);
                rays.store(common, &ray, i);
                let (o, d) = (ray.origin, ray.direction);
                let (slope, constant) = (
                    slope + view.threshold.slope,
                    splat(s, constant + view.threshold.constant),
                );
                let above = load(s, &spans.start, i);
                let start = region
                    .enter(o, d, slope, constant)
                    .max(view.near)
                    .max(above);
                // what is known to be empty around the start of the larger cell is less around a later one
                let radius = load(s, &spans.radius, i);
                let left = (radius.abs() - (start - above)).max(0.0);
                let left = Lanes::select(radius.below(0.0) & left.above(0.0), -left, left);
                store(left, &mut spans.radius, i);
                let end = region
                    .leave(o, d, slope, constant)
                    .min(view.far)
                    .min(load(s, &spans.end, i));
                store(
                    Lanes::select(
                        start.below(end) & cells.exist(s, i),
                        start,
                        splat(s, f32::INFINITY),
                    ),
                    &mut spans.start,
                    i,
                );
                store(end, &mut spans.end, i);
            }
            widest
        },
    )
}

fn run<S: Simd, M: Marcher>(
    s: S,
    marcher: M,
    cells: &Cells<'_>,
    width: Linear,
    count: usize,
    q: &mut Scratch,
) {
    let share = 1.0 / (1.0 + width.slope);
    let how = Stream {
        solid: cells.solid,
        width,
        share,
        near: Linear {
            slope: width.slope * share * CONE_NEAR,
            constant: width.constant * share * CONE_NEAR,
        },
        least: LEAST,
        touch: true,
        max_steps: CONE_STEPS,
    };
    q.next.start[..count].fill(f32::INFINITY);
    q.next.end[..count].copy_from_slice(&q.queue.spans.end[..count]);
    q.queue.count = count;
    let mut found = ConeEnds { spans: &mut q.next };
    let (queue, rays, work) = (&q.queue, &mut q.rays, &mut q.work);
    q.counts.prepass += stream(s, marcher, &how, queue, rays, work, &mut found);
    std::mem::swap(&mut q.queue.spans, &mut q.next);
}

/// Where cones ended.
struct ConeEnds<'a> {
    spans: &'a mut RaySpans,
}

impl<S: Simd> Sink<S> for ConeEnds<'_> {
    #[inline(always)]
    fn found(&mut self, done: Chosen<S>, _common: &Common, at: &Arrived<S>) {
        // all cones and rays within this one keep this far from the surface; a cone that met it at once began too near to tell
        let free = at.clearance.max(0.0) * FREE;
        let mut bits = done.bits();
        while bits != 0 {
            let k = bits.trailing_zeros() as usize;
            let word = at.word.as_slice()[k];
            let cell = (word & ORDINAL) as usize;
            self.spans.start[cell] = at.t.0.as_slice()[k];
            self.spans.slope[cell] = at.m.0.as_slice()[k];
            // a cone that found no room tells nothing of the side that its rays are on
            let radius = free.0.as_slice()[k];
            self.spans.radius[cell] = if word & INSIDE != 0 && radius > 0.0 {
                -radius
            } else {
                radius
            };
            bits &= bits - 1;
        }
    }
    #[inline(always)]
    fn left(&mut self, _gone: LaneMask<S>, _at: &Arrived<S>) {}
    fn spent(&mut self, rays: &Rays, _common: &Common, i: usize) {
        let cell = (rays.word[i] & ORDINAL) as usize;
        (
            self.spans.start[cell],
            self.spans.slope[cell],
            self.spans.radius[cell],
        ) = (rays.t[i], -1.0, 0.0);
    }
}
