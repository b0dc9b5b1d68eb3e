//! The film: linear-light planes that a renderer fills. Debug views are planes of the film.

use crate::methods::{Choice, choice};
use serde::{Deserialize, Serialize};

choice! {
    /// One plane of the film, and its view.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
    pub enum Plane("view", "a view", "Views") {
        /// What a camera would see: linear colour.
        Colour("colour", "Picture", "3 channels"),
        /// Share of the pixel that is covered by a surface.
        Coverage("coverage", "Coverage", "1 channel"),
        /// Distance along the ray, scene units; infinite where nothing is hit.
        Depth("depth", "Depth", "1 channel"),
        /// Which way the surface faces: a unit normal, zero where nothing is hit.
        Normal("normal", "Normals", "3 channels"),
        /// Linear colour of the material.
        Albedo("albedo", "Albedo", "3 channels"),
        /// Ambient visibility: 1 open, 0 closed.
        Occlusion("occlusion", "Ambient occlusion", "Tomczak 2012, fig. 3.11"),
        /// Visibility of the lights, weighted by their share: 1 lit, 0 in shadow.
        Shadow("shadow", "Shadow", "1 channel"),
        /// Evaluations of the field that the primary ray took.
        Steps("steps", "Steps", "Munini 2021, fig. 12; Keinert et al. 2014, fig. 9"),
        /// How far from zero the field is at the hit.
        Residual("residual", "Residual", "Keinert et al. 2014, fig. 7"),
        /// Number of the object plus 1; 0 where nothing is hit.
        Object("object", "Objects", "1 channel"),
    }
}

impl Plane {
    /// Name on the command line and of the layer in a file.
    pub fn name(self) -> &'static str {
        self.method().name
    }

    /// Numbers a pixel.
    pub const fn channels(self) -> usize {
        match self {
            Plane::Colour | Plane::Normal | Plane::Albedo => 3,
            Plane::Coverage
            | Plane::Depth
            | Plane::Occlusion
            | Plane::Shadow
            | Plane::Steps
            | Plane::Residual
            | Plane::Object => 1,
        }
    }
}

/// Bytes of a film with these planes.
pub fn bytes([width, height]: [u32; 2], planes: &[Plane]) -> u64 {
    let numbers: usize = planes.iter().map(|p| p.channels()).sum();
    let pixels = u64::from(width) * u64::from(height);
    pixels.saturating_mul(4 * numbers as u64)
}

/// Bytes of sums that a renderer keeps beside the film at a time, unless the picture is so wide that it needs more.
pub const SUMS: u64 = 256 << 20;

/// An upper bound of the bytes that a renderer takes beside the film of a picture: sums of samples, of all its tiles if
/// that is little, of three rows of tiles at least, as a filter reaches from one row into the next.
pub fn scratch([width, height]: [u32; 2]) -> u64 {
    let [width, height] = [
        u64::from(width).next_multiple_of(64),
        u64::from(height).next_multiple_of(32),
    ];
    let rows = |rows: u64| (width * SUMS_OF_A_PIXEL).saturating_mul(rows);
    rows(height).min(SUMS.max(rows(3 * 32)))
}

/// Bytes of the sums of a tile, for each of its pixels.
const SUMS_OF_A_PIXEL: u64 = 34;

/// A picture in the making: `width * height` pixels of every plane, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    planes: Vec<Vec<f32>>,
}

impl Film {
    /// A black film. The caller has checked the size against its limits.
    pub fn new(width: u32, height: u32) -> Film {
        Film::with(width, height, &Plane::ALL)
    }

    /// A black film with some planes only; the others are empty.
    pub fn with(width: u32, height: u32, planes: &[Plane]) -> Film {
        let pixels = width as usize * height as usize;
        let numbers = |p: &Plane| {
            if planes.contains(p) {
                pixels * p.channels()
            } else {
                0
            }
        };
        Film {
            width,
            height,
            planes: Plane::ALL.iter().map(|p| vec![0.0; numbers(p)]).collect(),
        }
    }

    /// A film of planes that are there already, each with as many numbers as it has pixels times channels.
    pub(crate) fn from_planes([width, height]: [u32; 2], given: Vec<(Plane, Vec<f32>)>) -> Film {
        let mut planes = vec![Vec::new(); Plane::ALL.len()];
        for (plane, numbers) in given {
            planes[plane as usize] = numbers;
        }
        Film {
            width,
            height,
            planes,
        }
    }

    /// Whether the film has this plane. (One without pixels has none.)
    pub fn has(&self, plane: Plane) -> bool {
        !self.plane(plane).is_empty()
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The numbers of a plane, channels interleaved; empty if the film does not have it.
    pub fn plane(&self, plane: Plane) -> &[f32] {
        &self.planes[plane as usize]
    }

    /// The numbers of a plane, to be written.
    pub fn plane_mut(&mut self, plane: Plane) -> &mut [f32] {
        &mut self.planes[plane as usize]
    }

    /// Takes from each pixel what is seen of the background beside the things: what is left are colours times how much of the pixel is covered
    /// ("premultiplied", Porter and Duff 1984). `background` is the same picture without things; what it shows in a pixel counts as far as the pixel
    /// is not covered. Films of other sizes, or without colours or coverage, stay as they are.
    pub fn cut_out(&mut self, background: &Film) {
        let size = |film: &Film| [film.width, film.height];
        if size(self) != size(background) {
            return;
        }
        let coverage = std::mem::take(&mut self.planes[Plane::Coverage as usize]);
        let behind = background.plane(Plane::Colour).as_chunks::<3>().0;
        let own = self.planes[Plane::Colour as usize].as_chunks_mut::<3>().0;
        for ((pixel, behind), share) in own.iter_mut().zip(behind).zip(&coverage) {
            for (c, b) in pixel.iter_mut().zip(behind) {
                *c = match *share > 0.0 {
                    true => (*c - (1.0 - share) * b).max(0.0),
                    false => 0.0,
                };
            }
        }
        self.planes[Plane::Coverage as usize] = coverage;
    }

    /// The numbers of all planes, to be written, in the order of [`Plane::ALL`].
    pub fn planes_mut(&mut self) -> impl Iterator<Item = (Plane, &mut [f32])> {
        Plane::ALL
            .into_iter()
            .zip(self.planes.iter_mut().map(Vec::as_mut_slice))
    }
}

#[cfg(test)]
mod cut_tests {
    use super::*;

    #[test]
    fn what_is_cut_out_lies_over_its_background_as_before() {
        let (thing, behind) = ([0.8_f32, 0.1, 4.0], [0.2_f32, 0.5, 1.0]);
        let shares = [0.0, 0.25, 1.0];
        let planes = [Plane::Colour, Plane::Coverage];
        let mut film = Film::with(3, 1, &planes);
        let mut background = Film::with(3, 1, &planes[..1]);
        for (i, share) in shares.into_iter().enumerate() {
            film.plane_mut(Plane::Coverage)[i] = share;
            for k in 0..3 {
                let both = share * thing[k] + (1.0 - share) * behind[k];
                film.plane_mut(Plane::Colour)[3 * i + k] = both;
                background.plane_mut(Plane::Colour)[3 * i + k] = behind[k];
            }
        }
        film.cut_out(&background);
        for (i, share) in shares.into_iter().enumerate() {
            for k in 0..3 {
                let found = film.plane(Plane::Colour)[3 * i + k];
                assert!((found - share * thing[k]).abs() < 1e-6, "{found}");
            }
        }
        assert_eq!(film.plane(Plane::Coverage), shares);
    }
}
