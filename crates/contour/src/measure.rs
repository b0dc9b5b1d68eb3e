//! How far faces are from the surface.

use crate::Surface;
use crate::sampler::{Sampler, Slope};
use crate::vector::{V, add, length, scale, single, sub, wide};
use rayon::prelude::*;

/// Faces that are measured together.
const CHUNK: usize = 256;
/// Points along a side of a face, at most.
const MOST: usize = 12;

/// Puts points spread over a triangle, about `apart` from each other, behind those that are there: in its inside and along its sides.
pub(crate) fn spread([a, b, c]: [V; 3], apart: f64, most: usize, out: &mut Vec<[f32; 3]>) {
    let (u, v) = (sub(b, a), sub(c, a));
    let longest = length(u).max(length(v)).max(length(sub(c, b)));
    let n = (longest / apart).ceil().clamp(2.0, most as f64) as usize;
    let share = 1.0 / n as f64;
    let mut push = |s: f64, t: f64| out.push(single(add(a, add(scale(u, s), scale(v, t)))));
    for i in 0..n {
        for j in 0..n - i {
            let (s, t) = (i as f64, j as f64);
            push((s + 1.0 / 3.0) * share, (t + 1.0 / 3.0) * share);
            if i + j + 1 < n {
                push((s + 2.0 / 3.0) * share, (t + 2.0 / 3.0) * share);
            }
        }
        let s = (i as f64 + 0.5) * share;
        push(s, 0.0);
        push(0.0, s);
        push(s, 1.0 - s);
    }
}

/// The farthest that a point of the faces is found to be from the surface, where points are `apart` from each other: as far as value and
/// gradient of the field tell, `|f| / |grad f|` (Taubin 1994).
pub(crate) fn farthest<'p>(
    surface: &Surface,
    apart: f64,
    make: impl Fn() -> Sampler<'p> + Sync + Send,
) -> f64 {
    let make = || (make(), Vec::new(), Vec::<Slope>::new());
    (surface.faces.par_chunks(CHUNK))
        .map_init(make, |(sampler, points, slopes), faces| {
            points.clear();
            for face in faces {
                let corners = face.map(|v| wide(surface.points[v as usize]));
                spread(corners, apart, MOST, points);
            }
            sampler.whole_slopes(points, slopes);
            slopes
                .iter()
                .fold(0.0_f64, |far, s| far.max(s.distance.abs()))
        })
        .reduce(|| 0.0, f64::max)
}
