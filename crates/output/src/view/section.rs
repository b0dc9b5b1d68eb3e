//! Sections: a field on a plane, as Munini 2021, fig. 1 to 6 and Tomczak 2012, fig. 3.8 draw it.

use super::legend::{Legend, LegendKey};
use super::map;
use super::scale::Scale;
use crate::picture::Picture;

const INK: [f32; 3] = [0.05, 0.05, 0.06];
/// Half the width of the line where the field is zero, and of the others, pixels.
const ZERO: f32 = 1.2;
const LINE: f32 = 0.45;

/// A field sampled at the middle of each pixel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Side of a pixel, scene units.
    pub pixel: f32,
    /// Values.
    pub values: Vec<f32>,
    /// Slope along the plane: length of the gradient's part in it.
    pub slopes: Vec<f32>,
}

impl Section {
    /// Draws it: blue inside, red outside, the stronger the farther from the surface, with a thick line where the field
    /// is zero and thin lines at equal distances. The strip at the right side says how far.
    pub fn picture(&self, legend: bool) -> Picture {
        let farthest = self
            .values
            .iter()
            .filter(|v| v.is_finite())
            .fold(0.0f32, |m, v| m.max(v.abs()));
        let picture = self.drawn(farthest);
        if legend {
            explained(farthest).beside(picture)
        } else {
            picture
        }
    }

    /// Draws it without a legend, with the strongest colours at a distance of `farthest`.
    pub fn drawn(&self, farthest: f32) -> Picture {
        let explained = explained(farthest);
        let spacing = scale(farthest).step(24);
        let mut at = 0;
        Picture::from_fn(self.width, self.height, |_, _| {
            let (value, slope) = (self.values[at], self.slopes[at]);
            at += 1;
            let colour = explained.colour(value);
            let ink = self.ink(value, value, slope, ZERO)
                + 0.45 * self.ink(from_line(value, spacing), value, slope, LINE);
            let ink = ink.clamp(0.0, 1.0);
            [0, 1, 2].map(|k| colour[k] + ink * (INK[k] - colour[k]))
        })
    }

    /// What the colours of [`Section::drawn`] mean, with at most about `most` ticks.
    pub fn key(farthest: f32, most: usize) -> LegendKey {
        explained(farthest).key(most)
    }

    /// How much of a pixel a line covers whose field value is `offset` away, where the field is `value` and grows by
    /// `slope`.
    fn ink(&self, offset: f32, value: f32, slope: f32, half_width: f32) -> f32 {
        // Where the field is flat there is no telling how far a line is: it is drawn where the value is met.
        let pixels = offset.abs() / (slope.max(0.05) * self.pixel);
        if value.is_finite() {
            (half_width + 0.5 - pixels).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

/// The scale of a section; a field that is zero everywhere has one too.
fn scale(farthest: f32) -> Scale {
    let farthest = if farthest > 0.0 { farthest } else { 1.0 };
    Scale::Linear(-farthest, farthest)
}

fn explained(farthest: f32) -> Legend {
    let colours = |t| map(colorous::RED_BLUE, 1.0 - t);
    Legend::new("distance", scale(farthest), colours, None)
}

/// How far a value is from the nearest multiple of the spacing.
fn from_line(value: f32, spacing: f32) -> f32 {
    value - (value / spacing).round() * spacing
}
