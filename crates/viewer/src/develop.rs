//! From a film to the pixels of the window.

use eframe::egui::{Color32, ColorImage};
use std::sync::LazyLock;
use zeroset_output::picture::Picture;
use zeroset_output::tone;
use zeroset_output::view::PlaneView;
use zeroset_scene::film::{Film, Plane};

/// Octaves below 1 that the table of the sRGB curve covers; what is darker lies on its straight part.
const OCTAVES: u32 = 9;
/// Bits of a number's mantissa that the table tells apart.
const BITS: u32 = 7;
/// The smallest number in the table.
const FIRST: u32 = (127 - OCTAVES) << 23;

/// The sRGB curve at numbers whose last bits are zero, so that a million pixels need no powers.
static CURVE: LazyLock<Vec<f32>> = LazyLock::new(|| {
    (0..=OCTAVES << BITS)
        .map(|i| tone::encode(f32::from_bits(FIRST + (i << (23 - BITS)))))
        .collect()
});

/// The sRGB value of linear light, within a tenth of one of 256 levels.
fn encode(curve: &[f32], linear: f32) -> f32 {
    if linear >= 1.0 {
        1.0
    } else if linear >= f32::from_bits(FIRST) {
        let bits = linear.to_bits() - FIRST;
        let at = (bits >> (23 - BITS)) as usize;
        let rest = bits & ((1 << (23 - BITS)) - 1);
        let share = rest as f32 / (1u32 << (23 - BITS)) as f32;
        curve[at] + share * (curve[at + 1] - curve[at])
    } else if linear > 0.0 {
        12.92 * linear
    } else {
        0.0
    }
}

/// What a view of a film shows, as pixels of the window; without a legend.
pub(crate) fn develop(film: &Film, view: &PlaneView<'_>) -> ColorImage {
    let size = [film.width() as usize, film.height() as usize];
    if view.plane != Plane::Colour || !film.has(Plane::Colour) {
        return pixels(
            &PlaneView {
                legend: false,
                ..*view
            }
            .of(film),
        );
    }
    let curve = &CURVE[..];
    let (gain, tone) = (view.transform.exposure.exp2(), view.transform.tone);
    let (linear, _) = film.plane(Plane::Colour).as_chunks::<3>();
    let mut out = Vec::with_capacity(linear.len());
    for (y, row) in (0..).zip(linear.chunks_exact(size[0].max(1))) {
        for (x, rgb) in (0..).zip(row) {
            let shown = tone::shown(rgb.map(|c| c * gain), tone);
            out.push(level(shown.map(|c| encode(curve, c)), x, y));
        }
    }
    ColorImage::new(size, out)
}

/// A picture as pixels of the window.
pub(crate) fn pixels(picture: &Picture) -> ColorImage {
    let width = picture.width().max(1);
    let colours = (0..).zip(picture.pixels());
    let out = colours.map(|(i, rgb)| level(*rgb, i % width, i / width));
    ColorImage::new(
        [picture.width() as usize, picture.height() as usize],
        out.collect(),
    )
}

/// The nearest of 256 levels a channel, dithered with one threshold a pixel: greys stay grey.
fn level(rgb: [f32; 3], x: u32, y: u32) -> Color32 {
    // interleaved gradient noise (Jimenez 2014)
    let along = 0.067_110_56 * x as f32 + 0.005_837_15 * y as f32;
    let threshold = 0.002 + 0.996 * (52.982_918 * along.fract()).fract();
    let [r, g, b] = rgb.map(|c| (c.clamp(0.0, 1.0) * 255.0 + threshold) as u8);
    Color32::from_rgb(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_follows_the_curve() {
        let curve = &CURVE[..];
        for i in 0..200_000 {
            let linear = (i as f32 / 190_000.0).powi(3);
            let off = (encode(curve, linear) - tone::encode(linear)).abs();
            assert!(off < 0.1 / 255.0, "{linear}: off by {off}");
        }
        let odd = [f32::NAN, -1.0, f32::INFINITY, 1.0f32.next_down()];
        assert_eq!(
            odd.map(|x| (encode(curve, x) * 255.0).round()),
            [0.0, 0.0, 255.0, 255.0]
        );
    }

    #[test]
    fn colours_are_those_of_a_file() {
        let mut film = Film::new(16, 8);
        for (i, x) in (0..).zip(film.plane_mut(Plane::Colour)) {
            *x = i as f32 / 300.0;
        }
        let view = PlaneView {
            plane: Plane::Colour,
            transform: zeroset_scene::settings::ViewTransform::standard(0.5),
            legend: false,
            objects: &[],
        };
        let (fast, slow) = (develop(&film, &view), pixels(&view.of(&film)));
        for (a, b) in fast.pixels.iter().zip(&slow.pixels) {
            for (a, b) in a.to_array().iter().zip(b.to_array()) {
                assert!(a.abs_diff(b) <= 1);
            }
        }
        assert_eq!(fast.size, [16, 8]);
    }
}
