//! Colours: linear in the scene, sRGB where people see numbers.

use glam::Vec3;

/// One channel from sRGB to linear (IEC 61966-2-1); values outside of 0 to 1 go on along the curve.
pub fn linear_channel(x: f64) -> f64 {
    if x <= 0.04045 {
        x / 12.92
    } else {
        ((x + 0.055) / 1.055).powf(2.4)
    }
}

/// From sRGB to linear.
pub fn linear(srgb: [f64; 3]) -> Vec3 {
    Vec3::from(srgb.map(|x| linear_channel(x) as f32))
}

/// An sRGB colour from hue (degrees), saturation and value (0 to 1) (Smith 1978).
pub fn hsv(hue: f64, saturation: f64, value: f64) -> [f64; 3] {
    let channel = |n: f64| {
        let k = (n + hue / 60.0).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    [channel(5.0), channel(3.0), channel(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues() {
        assert_eq!(hsv(0.0, 1.0, 1.0), [1.0, 0.0, 0.0]);
        assert_eq!(hsv(120.0, 1.0, 1.0), [0.0, 1.0, 0.0]);
        assert_eq!(hsv(-120.0, 1.0, 1.0), [0.0, 0.0, 1.0]);
        assert_eq!(hsv(77.0, 0.0, 0.25), [0.25; 3]);
    }

    #[test]
    fn linear_light() {
        assert_eq!(linear([0.0; 3]), Vec3::ZERO);
        assert_eq!(linear([1.0; 3]), Vec3::ONE);
        assert!((linear_channel(0.5) - 0.214_041).abs() < 1e-6);
    }
}
