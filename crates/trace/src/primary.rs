//! Primary rays: those from the eye, one a pixel.

use crate::order;
use crate::ray::{Common, Queue, WideRay};
use crate::simd::{Sheet, load, splat, store};
use crate::tile::{Area, HEIGHT, Solid, WIDTH};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::{Lanes, Ops, Real};
use zeroset_shade::view::View;

/// Puts the rays of a tile into the queue, in the order of its pixels: number `i` goes through the place `jitter[i]` of its pixel. They
/// have the spans that are there.
pub(crate) fn aim<S: Simd>(
    s: S,
    view: &View,
    area: &Area,
    jitter: &[Box<Sheet>; 2],
    queue: &mut Queue,
) {
    s.vectorize(
        #[inline(always)]
        || {
            queue.count = WIDTH * HEIGHT;
            queue.common = common(view, None);
            for i in (0..WIDTH * HEIGHT).step_by(S::f32s::LEN) {
                let x = load(s, &order::X, i) + area.x as f32;
                let y = load(s, &order::Y, i) + area.y as f32;
                let ray = ray(view, x + load(s, &jitter[0], i), y + load(s, &jitter[1], i));
                queue.rays.store(&queue.common, &ray, i);
            }
        },
    );
}

/// As [`aim`], from the places `lens` of the unit square on a lens, each with a span of its own.
pub(crate) fn aim_lens<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    area: &Area,
    [jitter, lens]: [&[Box<Sheet>; 2]; 2],
    queue: &mut Queue,
) {
    s.vectorize(
        #[inline(always)]
        || {
            let (view, region) = (solid.view, &solid.region);
            queue.count = WIDTH * HEIGHT;
            queue.common = Common {
                narrow: (!view.pinhole).then_some(1.0),
                travelled: Some(0.0),
                ..Common::default()
            };
            let (slope, constant) = (
                splat(s, view.threshold.slope),
                splat(s, view.threshold.constant),
            );
            for i in (0..WIDTH * HEIGHT).step_by(S::f32s::LEN) {
                let (column, row) = (load(s, &order::X, i), load(s, &order::Y, i));
                let x = column + area.x as f32 + load(s, &jitter[0], i);
                let y = row + area.y as f32 + load(s, &jitter[1], i);
                let u = [load(s, &lens[0], i), load(s, &lens[1], i)];
                let (origin, direction) = view.lens_ray(x, y, u);
                let ray = WideRay {
                    origin,
                    direction,
                    narrow: if view.pinhole {
                        view.narrow(direction)
                    } else {
                        splat(s, 1.0)
                    },
                    travelled: splat(s, 0.0),
                };
                queue.rays.store(&queue.common, &ray, i);
                let start = region
                    .enter(origin, direction, slope, constant)
                    .max(view.near);
                let end = region
                    .leave(origin, direction, slope, constant)
                    .min(view.far);
                // what a tile has beyond the edge of the picture is not followed
                let within = column.below(area.width as f32) & row.below(area.height as f32);
                let start =
                    Lanes::select(start.below(end) & within, start, splat(s, f32::INFINITY));
                store(start, &mut queue.spans.start, i);
                store(end, &mut queue.spans.end, i);
                store(splat(s, -1.0), &mut queue.spans.slope, i);
                store(splat(s, 0.0), &mut queue.spans.radius, i);
            }
        },
    );
}

/// The rays from the eye through these places of the picture, in pixels.
#[inline(always)]
pub(crate) fn ray<S: Simd>(view: &View, x: Lanes<S>, y: Lanes<S>) -> WideRay<Lanes<S>> {
    let ray = view.ray(x, y);
    let (origin, direction) = view.split(ray);
    WideRay {
        origin,
        direction,
        narrow: view.narrow(ray),
        travelled: splat(x.0.token(), 0.0),
    }
}

/// What all rays from the eye have in common; `narrow` where that is the same for all.
pub(crate) fn common(view: &View, narrow: Option<f32>) -> Common {
    Common {
        origin: view.pinhole.then_some(view.eye),
        direction: (!view.pinhole).then(|| view.back.map(|c| -c)),
        narrow: if view.pinhole { narrow } else { Some(1.0) },
        travelled: Some(0.0),
    }
}
