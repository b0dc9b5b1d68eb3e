//! Text as outlines: parameters for the `outline` shape, a glyph each.
//!
//! Fonts are read by `skrifa`. They may come from strangers: a damaged font is an error, and what one text may cost is limited
//! ([`CHARACTERS`], [`PIECES`]) beside the limits that `skrifa` sets on composite glyphs and glyph programs. Text is set in
//! its order from left to right, with kerning, but without ligatures and the shaping that Arabic or Indic scripts need.

use std::collections::HashMap;
use std::sync::Arc;

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::DrawSettings;
use skrifa::{FontRef, GlyphId, MetadataProvider};

use zeroset_catalogue::{LARGE, SMALL};

mod contour;
mod kerning;
#[cfg(test)]
mod tests;

use contour::{Contours, boundary};
use kerning::Kerning;

/// Most characters in a text.
pub const CHARACTERS: usize = 4096;
/// Most straight pieces in the outlines of a text.
pub const PIECES: usize = 100_000;

/// Why a text has no outlines.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TextError {
    /// The bytes are no font, or one whose tables contradict each other.
    #[error("the font cannot be read: {0}")]
    Font(String),
    /// One glyph of the font cannot be drawn.
    #[error("the font's glyph {glyph} for {character:?} cannot be drawn: {reason}")]
    Glyph {
        /// Number of the glyph in the font.
        glyph: u32,
        /// The character that it was for.
        character: char,
        /// What is wrong with it.
        reason: String,
    },
    /// More than [`CHARACTERS`].
    #[error("the text has {given} characters, at most {CHARACTERS} are allowed")]
    TooLong {
        /// Characters of the text.
        given: usize,
    },
    /// More than [`PIECES`].
    #[error(
        "the outlines of the text take more than {PIECES} pieces: shorten it or allow a larger tolerance than {tolerance}"
    )]
    TooDetailed {
        /// [`Layout::tolerance`].
        tolerance: f64,
    },
    /// A setting outside its range.
    #[error("{name} must be in {min} to {max}, not {given}")]
    Setting {
        /// Field of [`Layout`].
        name: &'static str,
        /// What was asked.
        given: f64,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
}

/// Where the origin is along a line of text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Align {
    /// Lines begin at x = 0.
    #[default]
    Left,
    /// Lines are centred on x = 0.
    Centre,
    /// Lines end at x = 0.
    Right,
}

/// Where the origin is across the lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Vertical {
    /// The first line stands on y = 0.
    #[default]
    Baseline,
    /// Half way from the top of the first line's capitals to where the last line stands.
    Middle,
}

/// How a text is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// The font's em in scene units: about the distance of two lines.
    pub size: f64,
    /// Where the origin is along the lines.
    pub align: Align,
    /// Where the origin is across the lines.
    pub vertical: Vertical,
    /// Added after every character, in ems. Between -1 and 10.
    pub letter_spacing: f64,
    /// Distance of two lines, as a multiple of what the font asks for. Between 0 and 10.
    pub line_spacing: f64,
    /// Whether pairs of letters move together as the font says.
    pub kerning: bool,
    /// Largest distance between a curve and the pieces that stand for it, in ems. Between 1e-5 and 0.1.
    pub tolerance: f64,
}

impl Default for Layout {
    fn default() -> Self {
        Layout {
            size: 1.0,
            align: Align::default(),
            vertical: Vertical::default(),
            letter_spacing: 0.0,
            line_spacing: 1.0,
            kerning: true,
            tolerance: 1e-3,
        }
    }
}

impl Layout {
    fn check(&self) -> Result<(), TextError> {
        let settings = [
            ("size", self.size, SMALL, LARGE),
            ("letter_spacing", self.letter_spacing, -1.0, 10.0),
            ("line_spacing", self.line_spacing, 0.0, 10.0),
            ("tolerance", self.tolerance, 1e-5, 0.1),
        ];
        for (name, given, min, max) in settings {
            if !(min..=max).contains(&given) {
                return Err(TextError::Setting {
                    name,
                    given,
                    min,
                    max,
                });
            }
        }
        Ok(())
    }
}

/// A glyph that leaves a mark.
#[derive(Clone, Debug, PartialEq)]
pub struct Glyph {
    /// The character that it stands for.
    pub character: char,
    /// Where its own origin is in the text.
    pub position: [f64; 2],
    /// Parameters of the `outline` shape around its own origin; the same for all glyphs alike.
    pub outline: Arc<[f64]>,
}

/// A text that was set.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Text {
    /// Its glyphs in their order, without those that leave no mark (spaces).
    pub glyphs: Vec<Glyph>,
    /// The length of its longest line.
    pub width: f64,
    /// Characters that the font has no glyph for, each once, in the order of the text.
    pub missing: Vec<char>,
}

/// The font that texts are set in unless they name another: DejaVu Sans Bold 2.37.
///
/// Its licence is that of Bitstream Vera and Arev: free to use, change, embed and sell with other software, not by itself.
pub fn default_font() -> &'static [u8] {
    dejavu::sans::bold()
}

/// A font that was opened.
pub struct Font<'a> {
    font: FontRef<'a>,
    kerning: Kerning<'a>,
    /// Font units in an em.
    units: f64,
}

/// A glyph's width and marks, in scene units.
#[derive(Clone)]
struct Shape {
    advance: f64,
    outline: Option<Arc<[f64]>>,
    pieces: usize,
}

impl<'a> Font<'a> {
    /// Opens an OpenType or TrueType font (also the `index`th of a collection), with outlines in `glyf`, `CFF` or `CFF2`.
    pub fn new(bytes: &'a [u8], index: u32) -> Result<Self, TextError> {
        let font = FontRef::from_index(bytes, index).map_err(|e| TextError::Font(e.to_string()))?;
        let units = font
            .metrics(Size::unscaled(), LocationRef::default())
            .units_per_em;
        if units == 0 {
            return Err(TextError::Font("it states no units per em".into()));
        }
        if font.outline_glyphs().format().is_none() {
            return Err(TextError::Font("it has no outlines".into()));
        }
        let kerning = Kerning::new(&font);
        Ok(Font {
            font,
            kerning,
            units: f64::from(units),
        })
    }

    /// Sets `text`: one line for each of its lines, tabs as wide as four spaces. A character that the font lacks is drawn as
    /// the font's sign for that, and told of in [`Text::missing`].
    pub fn set(&self, text: &str, layout: &Layout) -> Result<Text, TextError> {
        layout.check()?;
        let given = text.chars().count();
        if given > CHARACTERS {
            return Err(TextError::TooLong { given });
        }
        let metrics = self.font.metrics(Size::unscaled(), LocationRef::default());
        let em = layout.size / self.units;
        let line = f64::from(metrics.ascent - metrics.descent + metrics.leading) * em;
        let line = layout.line_spacing * line.clamp(0.0, 10.0 * layout.size);
        let capital = self.capital(metrics.cap_height) * em;
        let lines: Vec<&str> = text.lines().collect();
        let first = match layout.vertical {
            Vertical::Baseline => 0.0,
            Vertical::Middle => (line * (lines.len().max(1) - 1) as f64 - capital) / 2.0,
        };
        let mut shapes = HashMap::new();
        let mut pieces = 0;
        let mut out = Text::default();
        for (i, words) in lines.iter().enumerate() {
            let y = first - line * i as f64;
            let start = out.glyphs.len();
            let width = self.line(words, layout, y, &mut shapes, &mut pieces, &mut out)?;
            let shift = match layout.align {
                Align::Left => 0.0,
                Align::Centre => -width / 2.0,
                Align::Right => -width,
            };
            for glyph in &mut out.glyphs[start..] {
                glyph.position[0] += shift;
            }
            out.width = out.width.max(width);
        }
        Ok(out)
    }

    /// The height of capitals in font units: as stated, as high as an H, or else 0.7 ems.
    fn capital(&self, stated: Option<f32>) -> f64 {
        let high = || {
            let metrics = self
                .font
                .glyph_metrics(Size::unscaled(), LocationRef::default());
            metrics
                .bounds(self.font.charmap().map('H')?)
                .map(|b| b.y_max)
        };
        let plausible = |h: &f64| 0.0 < *h && *h < 10.0 * self.units;
        let height = stated.or_else(high).map(f64::from);
        height.filter(plausible).unwrap_or(0.7 * self.units)
    }

    /// Adds the glyphs of one line that begins at (0, `y`); its length.
    fn line(
        &self,
        words: &str,
        layout: &Layout,
        y: f64,
        shapes: &mut HashMap<GlyphId, Shape>,
        pieces: &mut usize,
        out: &mut Text,
    ) -> Result<f64, TextError> {
        let em = layout.size / self.units;
        let map = self.font.charmap();
        let spacing = layout.letter_spacing * layout.size;
        let (mut x, mut end) = (0.0, 0.0);
        let mut before = None;
        for character in words.chars() {
            let (drawn, times) = match character {
                '\t' => (' ', 4.0),
                c if c.is_control() => continue,
                c => (c, 1.0),
            };
            let id = map.map(drawn).unwrap_or(GlyphId::NOTDEF);
            if id == GlyphId::NOTDEF && !drawn.is_whitespace() && !out.missing.contains(&drawn) {
                out.missing.push(drawn);
            }
            let shape = match shapes.get(&id) {
                Some(shape) => Shape::clone(shape),
                None => {
                    let shape = self.shape(id, character, layout)?;
                    shapes.insert(id, shape.clone());
                    shape
                }
            };
            if let (true, Some(before)) = (layout.kerning, before) {
                x += f64::from(self.kerning.between(before, id)) * em;
            }
            if let Some(outline) = shape.outline {
                *pieces += shape.pieces;
                if *pieces > PIECES {
                    let tolerance = layout.tolerance;
                    return Err(TextError::TooDetailed { tolerance });
                }
                out.glyphs.push(Glyph {
                    character,
                    position: [x, y],
                    outline,
                });
            }
            end = x + shape.advance * times;
            x = end + spacing;
            before = Some(id);
        }
        Ok(end)
    }

    /// Draws a glyph.
    fn shape(&self, id: GlyphId, character: char, layout: &Layout) -> Result<Shape, TextError> {
        let damaged = |reason: String| TextError::Glyph {
            glyph: id.to_u32(),
            character,
            reason,
        };
        let em = layout.size / self.units;
        let outline = self
            .font
            .outline_glyphs()
            .get(id)
            .ok_or_else(|| damaged("it is missing".into()))?;
        let mut contours = Contours::new(em, layout.tolerance * self.units, PIECES);
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        outline
            .draw(settings, &mut contours)
            .map_err(|e| damaged(e.to_string()))?;
        let segments = contours.finish().ok_or(TextError::TooDetailed {
            tolerance: layout.tolerance,
        })?;
        if segments
            .iter()
            .flatten()
            .any(|x| x.is_nan() || x.abs() > 100.0 * layout.size)
        {
            return Err(damaged("it reaches farther than 100 ems".into()));
        }
        let segments = boundary(segments);
        let advance = self
            .font
            .glyph_metrics(Size::unscaled(), LocationRef::default())
            .advance_width(id)
            .unwrap_or(0.0);
        let pieces = segments.len();
        let list = || std::iter::once(pieces as f64).chain(segments.iter().flatten().copied());
        Ok(Shape {
            advance: f64::from(advance) * em,
            outline: (pieces > 0).then(|| list().collect()),
            pieces,
        })
    }
}
