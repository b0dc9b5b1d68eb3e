//! Primary rays: those from the eye, one a pixel.

use crate::order;
use crate::ray::{Common, Queue, WideRay};
use crate::simd::{Sheet, load, splat};
use crate::tile::{Area, HEIGHT, WIDTH};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::Lanes;
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
