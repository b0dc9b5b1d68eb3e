//! Normals of corners, for what draws a mesh.

use crate::Surface;
use crate::sampler::{Sampler, Slope};
use crate::vector::{V, add, dot, length, scale, single, sub, wide};
use rayon::prelude::*;

/// Faces that are looked at together.
const CHUNK: usize = 256;
/// How far from its corner a face is asked, as a share of the way to its middle: beyond the edge that the corner may lie on.
const WITHIN: f64 = 0.03;
/// Corners whose normals differ by less than 25 degrees have one in common.
const SMOOTH: f64 = 0.906;

/// See [`Surface::normals`].
pub(crate) fn normals<'p>(
    surface: &Surface,
    make: impl Fn() -> Sampler<'p> + Sync + Send,
) -> Vec<[[f32; 3]; 3]> {
    let make = || (make(), Vec::new(), Vec::<Slope>::new());
    let found: Vec<Vec<[V; 3]>> = (surface.faces.par_chunks(CHUNK))
        .map_init(make, |(sampler, points, slopes), faces| {
            points.clear();
            for face in faces {
                let corners = face.map(|v| wide(surface.points[v as usize]));
                let middle = scale(add(corners[0], add(corners[1], corners[2])), 1.0 / 3.0);
                points.extend(corners.map(|p| single(add(p, scale(sub(middle, p), WITHIN)))));
            }
            sampler.whole_slopes(points, slopes);
            let of_face = |(i, face): (usize, &[u32; 3])| {
                let corners = face.map(|v| wide(surface.points[v as usize]));
                let flat = unit(crate::surface::normal(corners));
                std::array::from_fn(|k| match slopes[3 * i + k].normal {
                    n if dot(n, flat) > 0.0 => n,
                    // whatever the field says, a face is not seen from behind
                    _ => flat,
                })
            };
            faces.iter().enumerate().map(of_face).collect()
        })
        .collect();
    let mut normals: Vec<[V; 3]> = found.into_iter().flatten().collect();
    // of each vertex the corners that lie on one smooth piece of the surface share their normal
    let mut corners: Vec<(u32, u32, u8)> = Vec::with_capacity(3 * surface.faces.len());
    for (i, face) in surface.faces.iter().enumerate() {
        for (k, v) in face.iter().enumerate() {
            corners.push((*v, i as u32, k as u8));
        }
    }
    corners.sort_unstable();
    for group in corners.chunk_by(|a, b| a.0 == b.0) {
        let own: Vec<V> = (group.iter())
            .map(|(_, i, k)| normals[*i as usize][usize::from(*k)])
            .collect();
        for ((_, i, k), n) in group.iter().zip(&own) {
            let beside = own.iter().filter(|o| dot(**o, *n) > SMOOTH);
            let sum = beside.fold([0.0; 3], |s, o| add(s, *o));
            normals[*i as usize][usize::from(*k)] = unit(sum);
        }
    }
    normals.into_iter().map(|face| face.map(single)).collect()
}

/// Of length 1, or zero.
fn unit(v: V) -> V {
    let l = length(v);
    if l > 0.0 { scale(v, 1.0 / l) } else { v }
}
