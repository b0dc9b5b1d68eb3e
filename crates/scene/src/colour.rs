//! Colours: sRGB where people write them, linear in the scene.

use glam::Vec3;

/// An sRGB colour, 0 to 1, from `#rgb`, `#rrggbb`, a CSS name or a CSS function such as `hsl(200, 50%, 50%)`.
///
/// # Errors
/// What is wrong with it.
pub fn parse(text: &str) -> Result<[f64; 3], String> {
    let colour = csscolorparser::parse(text).map_err(|e| e.to_string())?;
    if colour.a != 1.0 {
        return Err("it is see-through, which a colour cannot be here".into());
    }
    let [r, g, b] = [colour.r, colour.g, colour.b].map(f64::from);
    if [r, g, b].iter().all(|x| x.is_finite()) {
        Ok([r, g, b])
    } else {
        Err("it has no finite numbers".into())
    }
}

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
    fn words_and_digits() {
        assert_eq!(parse("#f00"), Ok([1.0, 0.0, 0.0]));
        assert_eq!(parse("#00ff00"), Ok([0.0, 1.0, 0.0]));
        assert_eq!(parse("white"), Ok([1.0; 3]));
        assert!(parse("#12").is_err());
        assert!(parse("#ff000080").is_err());
        assert!(parse("mauvish").is_err());
    }

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
