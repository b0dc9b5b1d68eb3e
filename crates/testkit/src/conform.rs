//! Whether two films show the same scene in the same way: every plane within its budget, other than beside silhouettes.
//!
//! This is what holds the renderers together: the plain one, the CPU's and the GPU's.

use glam::Vec3;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::scene::Scene;

/// What may differ in a plane.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// The plane.
    pub plane: Plane,
    /// Differences up to this do not count. Depths and residuals are in pixel widths.
    pub tolerance: f32,
    /// Share of the compared pixels that may differ by more.
    pub share: f64,
}

/// What differs in a plane.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// The plane.
    pub plane: Plane,
    /// Share of the compared pixels that differ by more than the tolerance.
    pub share: f64,
    /// Mean absolute difference; differences above 10 count as 10.
    pub mean: f64,
    /// Pixels that were compared.
    pub compared: usize,
}

const fn budget(plane: Plane, tolerance: f32, share: f64) -> Budget {
    Budget {
        plane,
        tolerance,
        share,
    }
}

/// What renderers of one scene may differ by, with one ray through the middle of every pixel.
pub const BUDGETS: [Budget; 9] = [
    budget(Plane::Colour, 0.04, 0.02),
    budget(Plane::Coverage, 0.001, 0.0),
    budget(Plane::Depth, 0.75, 0.002),
    budget(Plane::Normal, 0.02, 0.01),
    budget(Plane::Albedo, 0.05, 0.02),
    budget(Plane::Occlusion, 0.02, 0.02),
    budget(Plane::Shadow, 0.06, 0.02),
    budget(Plane::Residual, 0.75, 0.002),
    budget(Plane::Object, 0.0, 0.0),
];

/// Whether pixel (x, y) lies beside an edge: something else is seen in one of its eight neighbours, or the surface breaks.
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

/// Compares a plane with a reference of the same size, apart from the reference's edges. Lengths are compared in widths of
/// the pixel at the reference's depth; depths along the normal, because a ray that grazes a surface stops anywhere in the
/// last half pixel before it.
///
/// # Panics
/// Films of different sizes, or without the planes of depth, normals and objects.
pub fn compare(scene: &Scene, film: &Film, reference: &Film, budget: &Budget) -> Difference {
    let size = [reference.width(), reference.height()];
    assert_eq!([film.width(), film.height()], size, "films of one size");
    let (width, height) = (size[0] as usize, size[1] as usize);
    let (plane, channels) = (budget.plane, budget.plane.channels());
    let (slope, constant) = scene.camera().pixel_width(size[1]);
    let (mut off, mut sum, mut compared) = (0, 0.0, 0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        if beside_edge(reference, x, y) {
            continue;
        }
        let pixel = y * width + x;
        let of = |film: &Film| film.plane(plane)[pixel * channels..][..channels].to_vec();
        let apart = of(film).into_iter().zip(of(reference)).map(|(p, q)| {
            let by = if p == q { 0.0 } else { (p - q).abs() };
            // a number that is none is as wrong as can be
            if by.is_nan() { f32::INFINITY } else { by }
        });
        let mut by = apart.fold(0.0, f32::max);
        if by > 0.0 && matches!(plane, Plane::Depth | Plane::Residual) {
            by /= slope * reference.plane(Plane::Depth)[pixel] + constant;
        }
        if by > 0.0 && plane == Plane::Depth {
            let (_, d) = scene.camera().ray(x as f32 + 0.5, y as f32 + 0.5, size);
            by *= d
                .dot(Vec3::from_slice(
                    &reference.plane(Plane::Normal)[3 * pixel..][..3],
                ))
                .abs();
        }
        off += usize::from(by > budget.tolerance);
        sum += f64::from(by.min(10.0));
        compared += 1;
    }
    let count = compared.max(1) as f64;
    Difference {
        plane,
        share: off as f64 / count,
        mean: sum / count,
        compared,
    }
}

/// The planes that differ from the reference by more than is allowed.
pub fn differing(
    scene: &Scene,
    film: &Film,
    reference: &Film,
    budgets: &[Budget],
) -> Vec<Difference> {
    let all = (budgets.iter()).map(|budget| (compare(scene, film, reference, budget), budget));
    all.filter(|(difference, budget)| difference.share > budget.share)
        .map(|(difference, _)| difference)
        .collect()
}
