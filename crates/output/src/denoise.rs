//! Takes the noise out of pictures that were made at random: an edge-stopping wavelet filter (Dammertz et al. 2010), guided by the
//! colours, normals and distances of surfaces, and by how noisy a place is (Schied et al. 2017, section 4).
//!
//! What the surface colours is divided out first, so that patterns stay sharp, and what no neighbour knows of (fireflies) is cut down to
//! what the brightest neighbours but one have. What is seen in mirrors and through glass has no guide but its own brightness.

use glam::Vec3;
use zeroset_scene::film::{Film, Plane};

/// The planes that guide the filter; a film must have them, and colours.
pub const GUIDES: [Plane; 5] = [
    Plane::Colour,
    Plane::Coverage,
    Plane::Depth,
    Plane::Normal,
    Plane::Albedo,
];

/// Passes: each reaches twice as far as the one before.
const PASSES: usize = 5;
/// Weights of the five samples along a row or a column: the cubic B-spline.
const SPLINE: [f32; 5] = [1.0 / 16.0, 1.0 / 4.0, 3.0 / 8.0, 1.0 / 4.0, 1.0 / 16.0];
/// How many standard deviations a neighbour may be brighter or darker.
const BRIGHTNESS: f32 = 4.0;
/// How sharply the cosine between normals counts.
const NORMALS: i32 = 64;
/// How far from the plane of a pixel another may be, for each pixel that it is away.
const DISTANCE: f32 = 1.0;
/// How much pixels differ for what they show of the sky.
const MIXED: f32 = 8.0;
/// What surfaces are at least divided by.
const DARKEST: f32 = 0.02;

/// What is known of a pixel apart from its light.
#[derive(Clone, Copy)]
struct Guide {
    albedo: Vec3,
    normal: Vec3,
    depth: f32,
    /// The share of the pixel that surfaces cover.
    coverage: f32,
    /// How much the depth changes over a pixel.
    slope: f32,
}

impl Guide {
    /// How much another pixel, so many pixels away, counts for this one.
    fn likeness(&self, other: &Guide, away: f32) -> f32 {
        let (here, there) = (self.depth.is_finite(), other.depth.is_finite());
        // pixels on an edge show two things: they are like those that show as much of both
        let mixed = 1.0 - MIXED * (self.coverage - other.coverage).abs();
        if here != there || mixed <= 0.0 {
            return 0.0;
        }
        if !here {
            return 1.0;
        }
        let turned = self.normal.dot(other.normal).max(0.0).powi(NORMALS);
        let allowed = DISTANCE * self.slope * away + 1e-4 * self.depth;
        mixed * turned * (-(self.depth - other.depth).abs() / allowed.max(1e-20)).exp()
    }
}

/// A film without the noise of its colours. All other planes stay as they are.
///
/// A film that lacks one of the [`GUIDES`] is given back as it is. `stop` is asked before every pass whether to go on; where it says to
/// stop, there is no film.
pub fn denoise(mut film: Film, stop: &dyn Fn() -> bool) -> Option<Film> {
    if !GUIDES.iter().all(|plane| film.has(*plane)) {
        return Some(film);
    }
    let size = [film.width() as usize, film.height() as usize];
    let guides = guides(&film, size);
    let colours = film.plane(Plane::Colour).as_chunks::<3>().0;
    let mut light: Vec<Vec3> = (colours.iter().zip(&guides))
        .map(|(c, guide)| Vec3::from(*c) / guide.albedo)
        .collect();
    if stop() {
        return None;
    }
    light = without_fireflies(&light, size);
    let mut variance = variances(&light, &guides, size);
    for pass in 0..PASSES {
        (light, variance) = smoothed(&light, &variance, &guides, size, 1 << pass, stop)?;
    }
    let pixels = film.plane_mut(Plane::Colour).as_chunks_mut::<3>().0;
    for ((pixel, light), guide) in pixels.iter_mut().zip(&light).zip(&guides) {
        *pixel = (*light * guide.albedo).to_array();
    }
    Some(film)
}

/// Bytes a pixel that it takes beside the film: light and variances twice, and what guides.
pub const BYTES: u64 =
    2 * (size_of::<Vec3>() + size_of::<f32>()) as u64 + size_of::<Guide>() as u64;

fn luminance(c: Vec3) -> f32 {
    zeroset_shade::light::luminance(c.to_array())
}

fn guides(film: &Film, [width, height]: [usize; 2]) -> Vec<Guide> {
    let (albedo, _) = film.plane(Plane::Albedo).as_chunks::<3>();
    let (normal, _) = film.plane(Plane::Normal).as_chunks::<3>();
    let (depth, coverage) = (film.plane(Plane::Depth), film.plane(Plane::Coverage));
    let slope = |i: usize, step: usize, at: usize, end: usize| {
        let near = |j: usize| (depth[j] - depth[i]).abs();
        let before = if at > 0 {
            near(i - step)
        } else {
            f32::INFINITY
        };
        let behind = if at + 1 < end {
            near(i + step)
        } else {
            f32::INFINITY
        };
        // the smaller one: the other may be across an edge
        let least = before.min(behind);
        if least.is_finite() { least } else { 0.0 }
    };
    (0..width * height)
        .map(|i| {
            let (x, y) = (i % width, i / width);
            // edges of pixels are mixed with the sky, which has no colour of its own
            let own = Vec3::from(albedo[i]) * coverage[i] + Vec3::splat(1.0 - coverage[i]);
            Guide {
                albedo: own.max(Vec3::splat(DARKEST)),
                normal: Vec3::from(normal[i]),
                depth: depth[i],
                coverage: coverage[i],
                slope: slope(i, 1, x, width).max(slope(i, width, y, height)),
            }
        })
        .collect()
}

/// The pixels around one, up to `reach` times `step` away in each direction: place, and column and row from -reach to reach.
fn around(
    i: usize,
    [width, height]: [usize; 2],
    reach: isize,
    step: isize,
) -> impl Iterator<Item = (usize, [isize; 2])> {
    let (x, y) = ((i % width) as isize, (i / width) as isize);
    (-reach..=reach)
        .flat_map(move |dy| (-reach..=reach).map(move |dx| [dx, dy]))
        .filter_map(move |[dx, dy]| {
            let (u, v) = (x + dx * step, y + dy * step);
            let inside = u >= 0 && v >= 0 && u < width as isize && v < height as isize;
            inside.then(|| (v as usize * width + u as usize, [dx, dy]))
        })
}

/// Light where nothing is brighter than the second brightest of its neighbours.
fn without_fireflies(light: &[Vec3], size: [usize; 2]) -> Vec<Vec3> {
    (0..light.len())
        .map(|i| {
            let (mut first, mut second) = (0.0f32, 0.0f32);
            for (j, _) in around(i, size, 1, 1).filter(|(j, _)| *j != i) {
                let bright = luminance(light[j]);
                second = second.max(bright.min(first));
                first = first.max(bright);
            }
            let own = luminance(light[i]);
            if own > second && own > 0.0 {
                light[i] * (second / own)
            } else {
                light[i]
            }
        })
        .collect()
}

/// How much the light of pixels like one varies around it.
fn variances(light: &[Vec3], guides: &[Guide], size: [usize; 2]) -> Vec<f32> {
    (0..light.len())
        .map(|i| {
            let (mut sum, mut square, mut all) = (0.0f32, 0.0f32, 0.0f32);
            for (j, [dx, dy]) in around(i, size, 2, 1) {
                let away = (dx.abs() + dy.abs()) as f32;
                let w = guides[i].likeness(&guides[j], away);
                let bright = luminance(light[j]);
                sum += w * bright;
                square += w * bright * bright;
                all += w;
            }
            let mean = sum / all.max(1e-6);
            (square / all.max(1e-6) - mean * mean).max(0.0)
        })
        .collect()
}

/// One pass: light, and what is left of its variance. `stop` is asked before every row.
fn smoothed(
    light: &[Vec3],
    variance: &[f32],
    guides: &[Guide],
    size: [usize; 2],
    step: isize,
    stop: &dyn Fn() -> bool,
) -> Option<(Vec<Vec3>, Vec<f32>)> {
    (0..light.len())
        .map(|i| {
            if i.is_multiple_of(size[0]) && stop() {
                return None;
            }
            // of the neighbours too: one pixel may know its variance badly
            let (mut near, mut weights) = (0.0, 0.0);
            for (j, [dx, dy]) in around(i, size, 1, 1) {
                let w = SPLINE[(dx + 2) as usize] * SPLINE[(dy + 2) as usize];
                near += w * variance[j];
                weights += w;
            }
            let deviation = (near / weights).sqrt();
            let own = luminance(light[i]);
            let (mut sum, mut spread, mut all) = (Vec3::ZERO, 0.0f32, 0.0f32);
            for (j, [dx, dy]) in around(i, size, 2, step) {
                let away = ((dx.abs() + dy.abs()) * step) as f32;
                let like = guides[i].likeness(&guides[j], away);
                if like < 1e-4 {
                    continue;
                }
                let apart = (luminance(light[j]) - own).abs() / (BRIGHTNESS * deviation + 1e-4);
                let spline = SPLINE[(dx + 2) as usize] * SPLINE[(dy + 2) as usize];
                let w = spline * like * (-apart).exp();
                sum += light[j] * w;
                spread += variance[j] * w * w;
                all += w;
            }
            // a pixel is always like itself
            Some((sum / all, spread / (all * all)))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// A number from 0 to 1 for a place.
    fn random(seed: u32) -> f32 {
        let k = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let w = ((k >> ((k >> 28) + 4)) ^ k).wrapping_mul(277_803_737);
        ((w >> 22) ^ w) as f32 / 4_294_967_296.0
    }

    const SIZE: [usize; 2] = [48, 40];

    /// Two walls that meet, one in a checkered colour, and a sky; the light of each is `light`, with noise.
    fn film(noise: f32) -> (Film, Vec<Vec3>) {
        let [width, height] = SIZE;
        let mut film = Film::new(width as u32, height as u32);
        let mut right = Vec::new();
        for i in 0..width * height {
            let (x, y) = (i % width, i / width);
            let (light, normal, depth) = match (x < 24, y < 8) {
                (_, true) => (0.7, Vec3::ZERO, f32::INFINITY),
                (true, _) => (0.3, Vec3::X, 4.0 + 0.05 * x as f32),
                (false, _) => (0.9, Vec3::Z, 5.2 - 0.02 * (x - 24) as f32),
            };
            let checker = if (x / 3 + y / 3).is_multiple_of(2) {
                0.8
            } else {
                0.2
            };
            let hit = depth.is_finite();
            let albedo = if hit {
                Vec3::new(checker, 0.5, 0.4)
            } else {
                Vec3::ONE
            };
            let off = 1.0 + noise * (2.0 * random(i as u32) - 1.0);
            let mut put = |plane: Plane, values: &[f32]| {
                film.plane_mut(plane)[i * values.len()..][..values.len()].copy_from_slice(values);
            };
            right.push(albedo * light);
            put(Plane::Colour, &(albedo * light * off).to_array());
            put(
                Plane::Albedo,
                &(if hit { albedo } else { Vec3::ZERO }).to_array(),
            );
            put(Plane::Normal, &normal.to_array());
            put(Plane::Depth, &[depth]);
            put(Plane::Coverage, &[if hit { 1.0 } else { 0.0 }]);
        }
        (film, right)
    }

    fn whole(film: Film) -> Film {
        denoise(film, &|| false).expect("nobody stops it")
    }

    fn error(film: &Film, right: &[Vec3]) -> f32 {
        let pixels = film.plane(Plane::Colour).as_chunks::<3>().0;
        let square: f32 = (pixels.iter().zip(right))
            .map(|(p, r)| (Vec3::from(*p) - *r).length_squared())
            .sum();
        (square / right.len() as f32).sqrt()
    }

    #[test]
    fn noise_goes_and_edges_stay() {
        let (noisy, right) = film(0.5);
        let (before, after) = (error(&noisy, &right), error(&whole(noisy.clone()), &right));
        assert!(after < 0.2 * before, "{before} before, {after} after");
    }

    #[test]
    fn what_has_no_noise_stays() {
        let (clean, right) = film(0.0);
        let after = error(&whole(clean), &right);
        assert!(after < 2e-3, "{after}");
    }

    #[test]
    fn fireflies_are_cut_down() {
        let (mut film, right) = film(0.1);
        for i in [20 * SIZE[0] + 10, 30 * SIZE[0] + 35] {
            film.plane_mut(Plane::Colour)[3 * i..3 * i + 3].fill(1000.0);
        }
        let after = error(&whole(film), &right);
        assert!(after < 0.05, "{after}");
    }

    #[test]
    fn without_guides_nothing_changes() {
        let (film, _) = film(0.5);
        let mut bare = Film::with(film.width(), film.height(), &[Plane::Colour]);
        bare.plane_mut(Plane::Colour)
            .copy_from_slice(film.plane(Plane::Colour));
        assert_eq!(whole(bare).plane(Plane::Colour), film.plane(Plane::Colour));
    }

    #[test]
    fn it_ends_when_it_is_asked_to() {
        for rows in [0, 1, 60, 100] {
            let asked = Cell::new(0);
            let stop = || {
                asked.set(asked.get() + 1);
                asked.get() > rows
            };
            assert!(denoise(film(0.5).0, &stop).is_none());
            assert_eq!(asked.get(), rows + 1);
        }
    }
}
