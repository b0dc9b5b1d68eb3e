//! The strip beside a view that says what its colours mean.

use super::scale::Scale;
use super::{NOTHING, object_colour, text};
use crate::picture::Picture;

const BACKGROUND: [f32; 3] = [0.09, 0.09, 0.10];
const INK: [f32; 3] = [0.88, 0.88, 0.86];
/// Pictures that are less high have no room for a legend.
const MIN_HEIGHT: u32 = 64;

/// What the colours of a view mean.
pub(crate) struct Legend {
    title: &'static str,
    scale: Scale,
    colours: fn(f32) -> [f32; 3],
    nothing: Option<&'static str>,
}

/// What the colours of a view mean, for somebody who draws it.
#[derive(Clone, Debug)]
pub struct LegendKey {
    /// What is shown.
    pub title: &'static str,
    /// Places from 0 to 1 with what is written at them, ascending.
    pub ticks: Vec<(f32, String)>,
    /// The sRGB colour at a place.
    pub colours: fn(f32) -> [f32; 3],
    /// The word for pixels that have no number.
    pub nothing: Option<&'static str>,
}

impl Legend {
    /// A legend over a scale. `nothing` is the word for pixels that have no number.
    pub(crate) fn new(
        title: &'static str,
        scale: Scale,
        colours: fn(f32) -> [f32; 3],
        nothing: Option<&'static str>,
    ) -> Legend {
        Legend {
            title,
            scale,
            colours,
            nothing,
        }
    }

    /// The colour of a number.
    pub(crate) fn colour(&self, x: f32) -> [f32; 3] {
        (self.colours)(self.scale.place(x))
    }

    /// The same for somebody else to draw.
    pub(crate) fn key(&self, most: usize) -> LegendKey {
        LegendKey {
            title: self.title,
            ticks: self.scale.ticks(most),
            colours: self.colours,
            nothing: self.nothing,
        }
    }

    /// A picture with this legend at its right side.
    pub(crate) fn beside(&self, picture: Picture) -> Picture {
        if picture.height() < MIN_HEIGHT {
            return picture;
        }
        let unit = unit(&picture);
        let height = i64::from(picture.height());
        let line = text::CHARACTER * unit;
        let (top, bottom) = (
            3 * line,
            height - line - if self.nothing.is_some() { 2 * line } else { 0 },
        );
        let most = ((bottom - top) / (3 * line)).clamp(2, 10) as usize;
        let ticks = self.scale.ticks(most);
        let words = ticks
            .iter()
            .map(|(_, word)| word.as_str())
            .chain([self.title])
            .chain(self.nothing);
        let widest = words.map(|word| text::width(word, unit)).max().unwrap_or(0);
        let (bar, margin) = (2 * line, line);
        let left = i64::from(picture.width()) + margin;
        let mut out = widened(&picture, 3 * margin + bar + widest);
        text::draw(&mut out, self.title, [left, line], unit, INK);
        for y in top..bottom {
            let t = 1.0 - (y - top) as f32 / (bottom - 1 - top).max(1) as f32;
            out.fill([left, y], [bar, 1], (self.colours)(t));
        }
        for (place, word) in ticks {
            let y = bottom - 1 - ((bottom - 1 - top) as f32 * place).round() as i64;
            out.fill([left + bar, y - unit / 2], [line / 2, unit], INK);
            text::draw(
                &mut out,
                &word,
                [left + bar + margin, y - line / 2],
                unit,
                INK,
            );
        }
        if let Some(word) = self.nothing {
            let y = height - 2 * line;
            out.fill([left, y - line / 4], [bar, line + line / 2], NOTHING);
            text::draw(&mut out, word, [left + bar + margin, y], unit, INK);
        }
        out
    }
}

/// A picture of object numbers with the names of those it shows at its right side.
pub(crate) fn names(picture: Picture, names: &[String], numbers: &[f32]) -> Picture {
    if picture.height() < MIN_HEIGHT || names.is_empty() {
        return picture;
    }
    let mut seen = vec![false; names.len()];
    for number in numbers.iter().map(|x| x.round()) {
        if let Some(seen) = seen.get_mut((number as usize).wrapping_sub(1)) {
            *seen = true;
        }
    }
    let unit = unit(&picture);
    let line = text::CHARACTER * unit;
    let shown: Vec<_> = (1..)
        .zip(names)
        .zip(&seen)
        .filter(|(_, seen)| **seen)
        .map(|(name, _)| name)
        .collect();
    let room = ((i64::from(picture.height()) - 4 * line) / (2 * line)).max(1) as usize;
    let mut words: Vec<(Option<u32>, String)> = shown
        .iter()
        .take(room)
        .map(|(number, name)| (Some(*number), name.chars().take(20).collect()))
        .collect();
    if shown.len() > room {
        words.push((None, format!("{} more", shown.len() - room)));
    }
    let widest = words
        .iter()
        .map(|(_, word)| text::width(word, unit))
        .chain([text::width("object", unit)])
        .max();
    let left = i64::from(picture.width()) + line;
    let mut out = widened(&picture, 4 * line + line / 2 + widest.unwrap_or(0));
    text::draw(&mut out, "object", [left, line], unit, INK);
    for ((number, word), y) in words
        .into_iter()
        .zip((3 * line..).step_by(2 * line as usize))
    {
        if let Some(number) = number {
            out.fill(
                [left, y - line / 4],
                [line + line / 2, line + line / 2],
                object_colour(number as f32),
            );
        }
        text::draw(&mut out, &word, [left + 2 * line + line / 2, y], unit, INK);
    }
    out
}

/// Scale of the text: readable at the picture's size.
fn unit(picture: &Picture) -> i64 {
    i64::from(picture.height() / 480).max(1)
}

/// A picture with `more` empty columns at its right side.
fn widened(picture: &Picture, more: i64) -> Picture {
    Picture::from_fn(picture.width() + more as u32, picture.height(), |x, y| {
        picture.pixel(x, y).unwrap_or(BACKGROUND)
    })
}
