//! Whether two films show the same, other than beside silhouettes.

use glam::Vec3;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::scene::Scene;

/// What differs in a plane.
#[derive(Clone, Copy, Debug, Default)]
pub struct Difference {
    /// Share of the pixels that differ by more than the tolerance.
    pub share: f64,
    /// Mean absolute difference.
    #[allow(dead_code, reason = "printed where a comparison fails")]
    pub mean: f64,
}

/// Whether pixel (x, y) lies beside an edge of the reference: something else is seen nearby, or the surface breaks.
pub fn beside_edge(film: &Film, x: usize, y: usize) -> bool {
    let (width, height) = (film.width() as usize, film.height() as usize);
    let at = y * width + x;
    let (object, depth) = (film.plane(Plane::Object), film.plane(Plane::Depth));
    let normal = |i: usize| Vec3::from_slice(&film.plane(Plane::Normal)[3 * i..][..3]);
    for (i, j) in (-1..=1).flat_map(|j: isize| (-1..=1).map(move |i: isize| (i, j))) {
        let (Some(u), Some(v)) = (x.checked_add_signed(i), y.checked_add_signed(j)) else {
            continue;
        };
        if u >= width || v >= height {
            continue;
        }
        let other = v * width + u;
        let breaks = object[other] > 0.0 && normal(at).dot(normal(other)) < 0.8;
        let jumps = object[other] > 0.0 && (depth[other] - depth[at]).abs() > 0.1 * depth[at];
        if object[other] != object[at] || breaks || jumps {
            return true;
        }
    }
    false
}

/// Compares a plane, apart from edges. Lengths are compared in widths of the pixel at the reference's depth; depths along
/// the normal, because a ray that grazes a surface stops anywhere in the last half pixel before it.
pub fn compare(scene: &Scene, a: &Film, b: &Film, plane: Plane, tolerance: f32) -> Difference {
    assert_eq!((a.width(), a.height()), (b.width(), b.height()));
    let (width, height, channels) = (a.width() as usize, a.height() as usize, plane.channels());
    let size = [b.width(), b.height()];
    let (slope, constant) = scene.camera.pixel_width(b.height());
    let (mut off, mut sum, mut count) = (0.0, 0.0, 0.0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        if beside_edge(b, x, y) {
            continue;
        }
        let pixel = y * width + x;
        let at = pixel * channels;
        let (p, q) = (
            &a.plane(plane)[at..at + channels],
            &b.plane(plane)[at..at + channels],
        );
        let by = p
            .iter()
            .zip(q)
            .map(|(p, q)| if p == q { 0.0 } else { (p - q).abs() });
        // a number that is none is as wrong as can be
        let by = by.fold(
            0.0f32,
            |m, d| if d.is_nan() { f32::INFINITY } else { m.max(d) },
        );
        let (_, d) = scene.camera.ray(x as f32 + 0.5, y as f32 + 0.5, size);
        let cosine = d
            .dot(Vec3::from_slice(&b.plane(Plane::Normal)[3 * pixel..][..3]))
            .abs();
        let wide = slope * b.plane(Plane::Depth)[pixel] + constant;
        let by = match plane {
            Plane::Depth if by > 0.0 => by * cosine / wide,
            Plane::Residual if by > 0.0 => by / wide,
            _ => by,
        };
        off += f64::from(u8::from(by > tolerance));
        sum += f64::from(by.min(10.0));
        count += 1.0;
    }
    assert!(
        count > 0.3 * (width * height) as f64,
        "hardly anything is compared"
    );
    Difference {
        share: off / count,
        mean: sum / count,
    }
}

/// What may differ: plane, tolerance, share of pixels over it.
pub const ALLOWED: [(Plane, f32, f64); 9] = [
    (Plane::Colour, 0.04, 0.02),
    (Plane::Coverage, 0.001, 0.0),
    (Plane::Depth, 0.75, 0.002),
    (Plane::Normal, 0.02, 0.01),
    (Plane::Albedo, 0.05, 0.02),
    (Plane::Occlusion, 0.02, 0.02),
    (Plane::Shadow, 0.06, 0.02),
    (Plane::Residual, 0.75, 0.002),
    (Plane::Object, 0.0, 0.0),
];

/// The planes that differ by more than is allowed.
pub fn differing(scene: &Scene, a: &Film, b: &Film) -> Vec<(Plane, Difference)> {
    let all = ALLOWED
        .iter()
        .map(|&(plane, tolerance, share)| (plane, compare(scene, a, b, plane, tolerance), share));
    all.filter(|(_, d, share)| d.share > *share)
        .map(|(plane, d, _)| (plane, d))
        .collect()
}

#[track_caller]
pub fn same(scene: &Scene, a: &Film, b: &Film, what: &str) {
    let off = differing(scene, a, b);
    assert!(off.is_empty(), "{what}: {off:?}");
}
