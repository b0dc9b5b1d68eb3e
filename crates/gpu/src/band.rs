//! Bands: whole rows of a picture that fit into the device's memory together.

use crate::error::GpuError;
use wgpu::BufferUsages;
use zeroset_scene::accumulator::Sum;
use zeroset_shader::Job;
use zeroset_shader::entry::{Binding, COUNTERS};
use zeroset_shader::layout::{Frame, LightSum, Sample, SurfaceSum};

/// Bytes that all buffers of a band take together at most, unless a renderer is told otherwise.
pub(crate) const BUDGET: u64 = 256 << 20;
/// A smaller budget than this is not tried when memory runs out.
pub(crate) const LEAST_BUDGET: u64 = 1 << 20;
/// Bands are a multiple of these rows where they can be: whole cells of the widest cones.
const STEP: u32 = 32;

/// What a band's buffers must hold, bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sizes {
    pub(crate) cones: u64,
    pub(crate) samples: u64,
    pub(crate) light: u64,
    pub(crate) surface: u64,
    pub(crate) planes: u64,
    /// For reading planes and counters.
    pub(crate) read: u64,
}

/// Bytes of the counters.
pub(crate) const COUNTER_BYTES: u64 = 4 * COUNTERS as u64;

impl Sizes {
    /// `notes`: bytes for the notes of rays that are traced in turns, else 0.
    pub(crate) fn new(frame: &Frame, sums: &[Sum], notes: u64) -> Sizes {
        let [_, stored, _, given] = frame.band.map(u64::from);
        let width = u64::from(frame.size[0]);
        let numbers: usize = sums.iter().map(|s| s.channels()).sum();
        let planes = 4 * numbers as u64 * width * given;
        Sizes {
            cones: notes.max(16 * u64::from(frame.cones())),
            samples: size_of::<Sample>() as u64 * width * stored,
            light: size_of::<LightSum>() as u64 * width * given,
            surface: size_of::<SurfaceSum>() as u64 * width * given,
            planes,
            read: planes + COUNTER_BYTES,
        }
    }

    fn all(&self) -> [u64; 6] {
        [
            self.cones,
            self.samples,
            self.light,
            self.surface,
            self.planes,
            self.read,
        ]
    }

    pub(crate) fn total(&self) -> u64 {
        self.all().iter().sum()
    }

    pub(crate) fn largest(&self) -> u64 {
        self.all().into_iter().max().unwrap_or(0)
    }

    /// Of a buffer that shaders write to.
    pub(crate) fn of(&self, binding: Binding) -> Option<(u64, BufferUsages)> {
        let copied = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        match binding {
            Binding::Cones => Some((self.cones, BufferUsages::STORAGE)),
            Binding::Samples => Some((self.samples, BufferUsages::STORAGE)),
            Binding::Light => Some((self.light, BufferUsages::STORAGE)),
            Binding::Surface => Some((self.surface, BufferUsages::STORAGE)),
            Binding::Planes => Some((self.planes, copied)),
            Binding::Counters => Some((COUNTER_BYTES, copied)),
            _ => None,
        }
    }
}

/// What limits the height of bands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room {
    /// Bytes of all buffers together.
    pub(crate) budget: u64,
    /// Bytes of one buffer.
    pub(crate) binding: u64,
    /// Rows, so that what is not cut into tiles takes no longer than a tile may.
    pub(crate) rows: u32,
    /// Bytes for the notes of rays that are traced in turns, else 0.
    pub(crate) notes: u64,
}

impl Room {
    fn fits(&self, job: &Job, first: u32, rows: u32, sums: &[Sum]) -> bool {
        let sizes = Sizes::new(&job.band(first, rows, sums, 0), sums, self.notes);
        sizes.total() <= self.budget && sizes.largest() <= self.binding
    }

    /// How many rows the band has that begins with this one.
    ///
    /// # Errors
    /// Not even one row fits.
    pub(crate) fn band(
        &self,
        job: &Job,
        first: u32,
        sums: &[Sum],
        adapter: &str,
    ) -> Result<u32, GpuError> {
        let left = job.frame.size[1] - first;
        let most = left.min(self.rows.max(1));
        if self.fits(job, first, most, sums) {
            return Ok(most);
        }
        // rows that fit and rows that do not
        let (mut good, mut bad) = (0, most);
        while bad - good > 1 {
            let middle = good + (bad - good) / 2;
            if self.fits(job, first, middle, sums) {
                good = middle;
            } else {
                bad = middle;
            }
        }
        match good {
            0 => Err(GpuError::TooLarge {
                what: "one row of pixels",
                bytes: Sizes::new(&job.band(first, 1, sums, 0), sums, self.notes).total(),
                adapter: adapter.to_owned(),
                limit: self.binding.min(self.budget),
            }),
            rows if rows > STEP => Ok(rows / STEP * STEP),
            rows => Ok(rows),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use zeroset_scene::settings::Filter;
    use zeroset_shader::Turns;

    fn job(size: [u32; 2], filter: Filter) -> Job {
        let frame = Frame {
            size,
            samples: 4,
            filter_kind: filter as u32,
            prepass: 1,
            ..Frame::default()
        };
        Job {
            source: Arc::from(""),
            frame,
            params: Arc::default(),
            code: Arc::from([0]),
            table: Arc::default(),
            images: Arc::default(),
            grids: Arc::default(),
            registers: 0,
            in_turns: false,
            turns: Turns::default(),
        }
    }

    #[test]
    fn bands_cover_a_picture_within_their_room() {
        for size in [[1, 1], [7, 300], [640, 360], [1920, 1080], [8000, 50]] {
            for (budget, binding) in [
                (64 << 20, 16 << 20),
                (8 << 20, 128 << 20),
                (4 << 20, 1 << 20),
            ] {
                let job = job(size, Filter::Mitchell);
                let (room, mut first, mut bands) = (
                    Room {
                        budget,
                        binding,
                        rows: u32::MAX,
                        notes: 0,
                    },
                    0,
                    0,
                );
                while first < size[1] {
                    let rows = match room.band(&job, first, &Sum::ALL, "a") {
                        Ok(rows) => rows,
                        Err(error) => {
                            assert!(size[0] == 8000, "{size:?}: {error}");
                            break;
                        }
                    };
                    assert!(rows > 0 && first + rows <= size[1]);
                    let frame = job.band(first, rows, &Sum::ALL, 0);
                    let sizes = Sizes::new(&frame, &Sum::ALL, 0);
                    assert!(sizes.total() <= budget && sizes.largest() <= binding);
                    let [from, stored, given, count] = frame.band;
                    assert!(from <= given && from + stored >= given + count);
                    first += rows;
                    bands += 1;
                }
                if size == [1920, 1080] {
                    assert!(bands > 3, "{bands}");
                }
            }
        }
    }

    #[test]
    fn a_row_that_fits_nowhere_is_an_error() {
        let room = Room {
            budget: 1 << 20,
            binding: 1 << 30,
            rows: 100,
            notes: 0,
        };
        let error = room.band(&job([1 << 20, 4], Filter::Box), 0, &Sum::ALL, "card");
        assert!(matches!(error, Err(GpuError::TooLarge { .. })), "{error:?}");
    }

    #[test]
    fn the_rows_that_were_asked_for_are_not_passed() {
        let room = Room {
            budget: 1 << 30,
            binding: 1 << 30,
            rows: 48,
            notes: 0,
        };
        assert_eq!(
            room.band(&job([64, 100], Filter::Tent), 0, &Sum::ALL, "a"),
            Ok(48)
        );
        assert_eq!(
            room.band(&job([64, 100], Filter::Tent), 96, &Sum::ALL, "a"),
            Ok(4)
        );
    }
}
