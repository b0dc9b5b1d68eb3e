//! The colours of a clear sky (Preetham, Shirley and Smits 1999).

use glam::Vec3;
use std::f32::consts::{FRAC_PI_2, PI};
use zeroset_scene::material::Image;

/// Pixels of the image of a sky.
const SIZE: [u32; 2] = [256, 128];
/// The luminance that is shown as white, thousands of candelas over a square metre.
const WHITE: f32 = 20.0;
/// The sun stands no lower: the model knows no dusk.
const LOWEST: f32 = 1.5;
/// Sine of the angle above the horizon that the sky is looked at, at least: there its formula has no limit.
const HORIZON: f32 = 0.01;

/// The five numbers of Perez's formula for luminance and both chromaticities (appendix A.2), each as what it grows by with the turbidity,
/// and what it is without.
const PEREZ: [[[f32; 2]; 5]; 3] = [
    [
        [0.1787, -1.4630],
        [-0.3554, 0.4275],
        [-0.0227, 5.3251],
        [0.1206, -2.5771],
        [-0.0670, 0.3703],
    ],
    [
        [-0.0193, -0.2592],
        [-0.0665, 0.0008],
        [-0.0004, 0.2125],
        [-0.0641, -0.8989],
        [-0.0033, 0.0452],
    ],
    [
        [-0.0167, -0.2608],
        [-0.0950, 0.0092],
        [-0.0079, 0.2102],
        [-0.0441, -1.6537],
        [-0.0109, 0.0529],
    ],
];

/// Both chromaticities straight up (appendix A.2): for each power of the turbidity, from the square down, those of the sun's angle, from the
/// cube down.
const ZENITH: [[[f32; 4]; 3]; 2] = [
    [
        [0.001_66, -0.003_75, 0.002_09, 0.0],
        [-0.029_03, 0.063_77, -0.032_02, 0.003_94],
        [0.116_93, -0.211_96, 0.060_52, 0.258_86],
    ],
    [
        [0.002_75, -0.006_10, 0.003_17, 0.0],
        [-0.042_14, 0.089_70, -0.041_53, 0.005_16],
        [0.153_46, -0.267_56, 0.066_70, 0.266_88],
    ],
];

/// Perez's formula: `(1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma)`.
fn perez([a, b, c, d, e]: [f32; 5], cosine: f32, gamma: f32) -> f32 {
    (1.0 + a * (b / cosine).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}

/// A clear sky whose sun stands in a direction.
struct Sky {
    sun: Vec3,
    /// Luminance and chromaticities straight up.
    zenith: [f32; 3],
    /// The numbers of Perez's formula.
    perez: [[f32; 5]; 3],
    /// What it gives straight up.
    up: [f32; 3],
}

impl Sky {
    fn new(turbidity: f32, sun: Vec3) -> Sky {
        let highest = (90.0 - LOWEST).to_radians();
        let theta = sun.y.clamp(-1.0, 1.0).acos().min(highest);
        let t = turbidity;
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * theta);
        let bright = (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192;
        let cubic = |[a, b, c, d]: [f32; 4]| ((a * theta + b) * theta + c) * theta + d;
        let [x, y] = ZENITH.map(|[a, b, c]| (cubic(a) * t + cubic(b)) * t + cubic(c));
        let perez_of = PEREZ.map(|all| all.map(|[grows, without]| grows * t + without));
        Sky {
            sun,
            zenith: [bright.max(0.0), x, y],
            up: perez_of.map(|numbers| perez(numbers, 1.0, theta)),
            perez: perez_of,
        }
    }

    /// The linear colour along a direction above the horizon.
    fn colour(&self, d: Vec3) -> Vec3 {
        let cosine = d.y.max(HORIZON);
        let gamma = d.dot(self.sun).clamp(-1.0, 1.0).acos();
        let [luminance, x, y] = std::array::from_fn(|k| {
            self.zenith[k] * perez(self.perez[k], cosine, gamma) / self.up[k]
        });
        let luminance = luminance.max(0.0) / WHITE;
        let (big_x, big_z) = (x / y * luminance, (1.0 - x - y) / y * luminance);
        // to linear sRGB (IEC 61966-2-1)
        Vec3::new(
            3.2406 * big_x - 1.5372 * luminance - 0.4986 * big_z,
            -0.9689 * big_x + 1.8758 * luminance + 0.0415 * big_z,
            0.0557 * big_x - 0.2040 * luminance + 1.0570 * big_z,
        )
        .max(Vec3::ZERO)
    }
}

/// The image of a clear sky over ground of one colour, in all directions.
pub(crate) fn image(turbidity: f32, ground: Vec3, sun: Vec3) -> Image {
    let sky = Sky::new(turbidity, sun);
    let [width, height] = SIZE;
    let mut pixels = Vec::new();
    // what arrives on the ground: the mean by the cosine law
    let (mut arriving, mut weights) = (Vec3::ZERO, 0.0);
    for y in 0..height {
        let theta = (y as f32 + 0.5) / height as f32 * PI;
        let is_above = theta < FRAC_PI_2;
        for x in 0..width {
            let (sin, cos) = (((x as f32 + 0.5) / width as f32 - 0.5) * 2.0 * PI).sin_cos();
            let d = Vec3::new(theta.sin() * sin, theta.cos(), -theta.sin() * cos);
            if is_above {
                let colour = sky.colour(d);
                let weight = theta.sin() * theta.cos();
                arriving += colour * weight;
                weights += weight;
                pixels.push(colour);
            } else {
                pixels.push(ground * (arriving / weights));
            }
        }
    }
    Image {
        path: String::new(),
        width,
        height,
        pixels,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clear_sky_is_blue_and_brightest_at_the_sun() {
        let sun = Vec3::new(0.6, 0.6, -0.5).normalize();
        let sky = Sky::new(2.5, sun);
        let up = sky.colour(Vec3::Y);
        assert!(up.z > 1.2 * up.x && up.x > 0.0, "{up}");
        let away = sky.colour(Vec3::new(-0.7, 0.6, 0.3).normalize());
        let there = sky.colour(sun);
        assert!(there.x > 3.0 * away.x, "{there} {away}");
    }

    /// The luminance straight up is that of the paper's equation, and haze makes the sky paler.
    #[test]
    fn the_zenith_has_its_luminance() {
        for (turbidity, height) in [(2.0f32, 45.0f32), (3.0, 60.0), (6.0, 20.0)] {
            let angle = height.to_radians();
            let sun = Vec3::new(0.0, angle.sin(), -angle.cos());
            let found = Sky::new(turbidity, sun).colour(Vec3::Y);
            let theta = (90.0 - height).to_radians();
            let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * theta);
            let right = (4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192;
            let luminance = found.dot(Vec3::new(0.2126, 0.7152, 0.0722)) * WHITE;
            assert!(
                (luminance / right - 1.0).abs() < 0.02,
                "{luminance} {right}"
            );
        }
        let sun = Vec3::new(0.0, 0.7, -0.7).normalize();
        let blue = |t: f32| {
            let c = Sky::new(t, sun).colour(Vec3::new(0.3, 0.6, 0.7).normalize());
            c.z / c.x
        };
        assert!(blue(2.0) > 1.2 * blue(8.0), "{} {}", blue(2.0), blue(8.0));
    }

    #[test]
    fn every_sky_has_numbers() {
        for turbidity in [1.7, 3.0, 10.0] {
            for y in [-0.5f32, 0.0, 0.02, 0.3, 1.0] {
                let sun = Vec3::new(0.4, y, -0.3).normalize();
                let image = image(turbidity, Vec3::splat(0.3), sun);
                let fine = |c: &Vec3| c.is_finite() && c.min_element() >= 0.0;
                assert!(image.pixels.iter().all(fine), "{turbidity} {y}");
            }
        }
    }
}
