//! Pictures: what a screen shows.

use crate::tone;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::settings::{Tone, ViewTransform};

/// A picture as a screen shows it: sRGB values between 0 and 1 (IEC 61966-2-1), row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 3]>,
}

/// What can be written row by row, without a copy of the whole.
pub trait Rows {
    /// Width in pixels.
    fn width(&self) -> u32;
    /// Height in pixels.
    fn height(&self) -> u32;
    /// The pixels of a row, from the left, in place of what was in `out`.
    fn row(&self, y: u32, out: &mut Vec<[f32; 3]>);
    /// How opaque the pixels of a row are, 0 to 1; none where all are.
    fn opacity(&self, _y: u32) -> Option<&[f32]> {
        None
    }
}

impl Rows for Picture {
    fn width(&self) -> u32 {
        self.width
    }

    fn height(&self) -> u32 {
        self.height
    }

    fn row(&self, y: u32, out: &mut Vec<[f32; 3]>) {
        let width = self.width as usize;
        out.clear();
        out.extend_from_slice(&self.pixels[y as usize * width..][..width]);
    }
}

/// The colour plane of a film as [`Picture::develop`] shows it, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Developed<'f> {
    film: &'f Film,
    gain: f32,
    tone: Tone,
    /// Whether colours are those of the part of a pixel that is covered, times how much is.
    is_cut_out: bool,
}

impl<'f> Developed<'f> {
    /// A film as a screen shows it.
    pub fn new(film: &'f Film, transform: ViewTransform) -> Developed<'f> {
        Developed {
            film,
            gain: transform.exposure.exp2(),
            tone: transform.tone,
            is_cut_out: false,
        }
    }

    /// The same of a film that was [cut out](Film::cut_out): colours are divided by the coverage, which is how opaque a pixel is, as
    /// PNG has it.
    #[must_use]
    pub fn cut_out(self) -> Developed<'f> {
        Developed {
            is_cut_out: self.film.has(Plane::Coverage),
            ..self
        }
    }
}

impl Rows for Developed<'_> {
    fn opacity(&self, y: u32) -> Option<&[f32]> {
        let width = self.film.width() as usize;
        let coverage = self.film.plane(Plane::Coverage);
        let row = coverage.get(y as usize * width..(y as usize + 1) * width);
        row.filter(|_| self.is_cut_out)
    }

    fn width(&self) -> u32 {
        self.film.width()
    }

    fn height(&self) -> u32 {
        self.film.height()
    }

    fn row(&self, y: u32, out: &mut Vec<[f32; 3]>) {
        let width = self.film.width() as usize;
        out.clear();
        let (linear, _) = self.film.plane(Plane::Colour).as_chunks::<3>();
        match linear.get(y as usize * width..(y as usize + 1) * width) {
            Some(row) => {
                let shares = self.opacity(y).unwrap_or_default();
                out.extend(row.iter().enumerate().map(|(x, rgb)| {
                    let share = shares.get(x).copied().unwrap_or(1.0);
                    let gain = if share > 0.0 { self.gain / share } else { 0.0 };
                    tone::shown(rgb.map(|c| c * gain), self.tone).map(tone::encode)
                }))
            }
            None => out.resize(width, [0.0; 3]),
        }
    }
}

impl Picture {
    /// A picture of one colour. The caller has checked the size against its limits.
    pub fn filled(width: u32, height: u32, colour: [f32; 3]) -> Picture {
        Picture {
            width,
            height,
            pixels: vec![colour; width as usize * height as usize],
        }
    }

    /// A picture from a function of column and row. The caller has checked the size against its limits.
    pub fn from_fn(
        width: u32,
        height: u32,
        mut colour: impl FnMut(u32, u32) -> [f32; 3],
    ) -> Picture {
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            pixels.extend((0..width).map(|x| colour(x, y)));
        }
        Picture {
            width,
            height,
            pixels,
        }
    }

    /// The colour plane of a film, brightened by the exposure, bent to what a screen can show, and sRGB-coded.
    /// What is not a number becomes black, and so does a film without that plane.
    pub fn develop(film: &Film, transform: ViewTransform) -> Picture {
        let developed = Developed::new(film, transform);
        let mut pixels = Vec::with_capacity(film.width() as usize * film.height() as usize);
        let mut row = Vec::new();
        for y in 0..film.height() {
            developed.row(y, &mut row);
            pixels.extend_from_slice(&row);
        }
        Picture {
            width: film.width(),
            height: film.height(),
            pixels,
        }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row from the top left.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// One pixel; `None` beside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        (x < self.width && y < self.height)
            .then(|| self.pixels[y as usize * self.width as usize + x as usize])
    }

    /// Sets a pixel; beside the picture nothing happens, so that drawings are clipped.
    pub fn set(&mut self, x: i64, y: i64, colour: [f32; 3]) {
        if (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y) {
            self.pixels[y as usize * self.width as usize + x as usize] = colour;
        }
    }

    /// Fills a rectangle, clipped to the picture.
    pub fn fill(&mut self, [x, y]: [i64; 2], [width, height]: [i64; 2], colour: [f32; 3]) {
        let columns = x.clamp(0, i64::from(self.width)) as usize
            ..(x + width).clamp(0, i64::from(self.width)) as usize;
        for row in y.clamp(0, i64::from(self.height))..(y + height).clamp(0, i64::from(self.height))
        {
            let start = row as usize * self.width as usize;
            if columns.start < columns.end {
                self.pixels[start + columns.start..start + columns.end].fill(colour);
            }
        }
    }
}
