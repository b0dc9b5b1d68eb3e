//! From linear light to what a file stores: the sRGB curve, and dithering.

use zeroset_number::v3;
use zeroset_scene::settings::Tone;
pub use zeroset_shade::tone::{decode, encode};

/// What a screen shows of linear light, itself linear. What is not a number is black.
pub fn shown(rgb: [f32; 3], tone: Tone) -> [f32; 3] {
    let [r, g, b] = rgb.map(|c| if c.is_nan() { 0.0 } else { c });
    zeroset_shade::tone::view(tone, v3(r, g, b)).array()
}

/// The nearest of 256 levels, dithered: between two levels, the share of pixels that take the upper one is how near the
/// value is to it, so that a slow gradient shows no bands. The pattern is interleaved gradient noise (Jimenez 2014), fixed
/// to the pixel: equal pictures become equal files. A value that is a level is kept everywhere.
pub fn quantise8(value: f32, x: u32, y: u32) -> u8 {
    // the margin keeps a level a level in spite of rounding
    let threshold = 0.002 + 0.996 * gradient_noise(x, y);
    (f64::from(value.clamp(0.0, 1.0)) * 255.0 + threshold) as u8
}

/// The nearest of 65,536 levels.
pub fn quantise16(value: f32) -> u16 {
    (f64::from(value.clamp(0.0, 1.0)) * 65535.0 + 0.5) as u16
}

/// Interleaved gradient noise (Jimenez 2014, Next generation post processing in Call of Duty): every 3x3 neighbourhood
/// holds nearly evenly spread values between 0 and 1.
fn gradient_noise(x: u32, y: u32) -> f64 {
    let along = 0.067_110_56 * f64::from(x) + 0.005_837_15 * f64::from(y);
    (52.982_918_9 * along.fract()).fract()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_curve_has_its_published_points() {
        for (linear, coded) in [
            (0.0, 0.0),
            (0.003_130_8, 0.040_45),
            (0.214_041_14, 0.5),
            (0.5, 0.735_356_9),
            (1.0, 1.0),
        ] {
            assert!(
                (encode(linear) - coded).abs() < 1e-5,
                "{linear}: {}",
                encode(linear)
            );
            assert!(
                (decode(coded) - linear).abs() < 1e-5,
                "{coded}: {}",
                decode(coded)
            );
        }
        assert_eq!(
            [
                encode(-1.0),
                encode(f32::NAN),
                encode(7.0),
                encode(f32::INFINITY)
            ],
            [0.0, 0.0, 1.0, 1.0]
        );
    }

    #[test]
    fn dithering_keeps_every_level_everywhere() {
        for level in 0..=255u8 {
            for i in 0..1000 {
                assert_eq!(quantise8(f32::from(level) / 255.0, i * 37, i), level);
            }
        }
    }

    proptest! {
        #[test]
        fn the_curve_and_its_inverse_cancel(linear in 0.0f32..1.0) {
            prop_assert!((decode(encode(linear)) - linear).abs() < 1e-5);
        }

        #[test]
        fn dithering_keeps_the_mean(value in 0.0f32..1.0, x in 0u32..10_000, y in 0u32..10_000) {
            let all = (0..64).flat_map(|i| (0..64).map(move |j| (i, j)));
            let sum: f64 = all.map(|(i, j)| f64::from(quantise8(value, x + i, y + j))).sum();
            prop_assert!((sum / 4096.0 - f64::from(value) * 255.0).abs() < 0.03);
        }
    }
}
