//! Animations: many pictures of one size in a file, GIF, animated PNG or Y4M.
//!
//! ```
//! use zeroset_output::format::animation::{Animation, Kind, Timing};
//!
//! let timing = Timing { size: [2, 1], frames: 2, rate: 25.0 };
//! let mut bytes = Vec::new();
//! let mut animation = Animation::new(&mut bytes, Kind::Gif, timing)?;
//! animation.push(&[255, 0, 0, 0, 255, 0])?; // red and green
//! animation.push(&[0, 0, 255, 0, 255, 0])?; // red becomes blue
//! animation.finish()?;
//! assert!(bytes.starts_with(b"GIF89a"));
//! # Ok::<(), std::io::Error>(())
//! ```

mod apng;
mod gif;
mod palette;
mod y4m;

use std::io::{self, Write};

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// GIF89a: 255 colours that all frames share, mixed by a fixed pattern. It goes on for ever.
    Gif,
    /// Animated PNG: every colour, several times as large. It goes on for ever.
    Apng,
    /// YUV4MPEG2, for other programs: no colour lost but to rounding, and not packed.
    Y4m,
}

/// What an animation has to know before its first frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// How many frames there will be.
    pub frames: u32,
    /// Frames a second.
    pub rate: f64,
}

/// Most frames a second of a GIF: it counts hundredths of a second, and programs that show it take one of them for an error.
pub const FASTEST_GIF: f64 = 50.0;

/// The longest side of a GIF.
pub const LARGEST_GIF: u32 = u16::MAX as u32;

/// A file of many frames in the making.
pub struct Animation<W: Write>(Writer<W>);

enum Writer<W: Write> {
    Gif(gif::Gif<W>),
    Apng(Box<apng::Apng<W>>),
    Y4m(y4m::Y4m<W>),
}

impl<W: Write> Animation<W> {
    /// Begins a file.
    ///
    /// # Errors
    /// What the writer gives; a size or a rate that the kind cannot hold.
    pub fn new(writer: W, kind: Kind, timing: Timing) -> io::Result<Animation<W>> {
        check(kind, &timing).map_err(|why| io::Error::new(io::ErrorKind::InvalidInput, why))?;
        Ok(Animation(match kind {
            Kind::Gif => Writer::Gif(gif::Gif::new(writer, timing)),
            Kind::Apng => Writer::Apng(Box::new(apng::Apng::new(writer, timing)?)),
            Kind::Y4m => Writer::Y4m(y4m::Y4m::new(writer, timing)?),
        }))
    }

    /// Adds a frame: sRGB bytes, three a pixel, row by row from the top left.
    ///
    /// # Errors
    /// What the writer gives; another number of bytes than the size asks for.
    pub fn push(&mut self, frame: &[u8]) -> io::Result<()> {
        match &mut self.0 {
            Writer::Gif(w) => w.push(frame),
            Writer::Apng(w) => w.push(frame),
            Writer::Y4m(w) => w.push(frame),
        }
    }

    /// Ends the file.
    ///
    /// # Errors
    /// What the writer gives; fewer frames than were announced.
    pub fn finish(self) -> io::Result<()> {
        match self.0 {
            Writer::Gif(w) => w.finish(),
            Writer::Apng(w) => w.finish(),
            Writer::Y4m(w) => w.finish(),
        }
    }
}

/// Whether a kind of file can hold frames like these.
///
/// # Errors
/// What it cannot hold, and what it can.
pub fn check(kind: Kind, timing: &Timing) -> Result<(), String> {
    let Timing { size, frames, rate } = *timing;
    if frames == 0 || size.contains(&0) {
        return Err("an animation has at least one frame of one pixel".into());
    }
    if !(rate.is_finite() && rate > 0.0) {
        return Err(format!("{rate} frames a second are none"));
    }
    if kind == Kind::Gif && rate > FASTEST_GIF {
        return Err(format!(
            "a GIF has at most {FASTEST_GIF} frames a second, not {rate}: .apng and .mp4 have more"
        ));
    }
    if kind == Kind::Gif && size.iter().any(|n| *n > LARGEST_GIF) {
        return Err(format!("a side of a GIF has at most {LARGEST_GIF} pixels"));
    }
    Ok(())
}

/// Bytes of memory that writing takes, beside the frame that is added.
pub fn bytes(kind: Kind, timing: &Timing) -> u64 {
    let frame = 3 * u64::from(timing.size[0]) * u64::from(timing.size[1]);
    match kind {
        // all frames share their colours, which are known at the end
        Kind::Gif => frame.saturating_mul(u64::from(timing.frames) + 1),
        Kind::Apng | Kind::Y4m => 4 * frame,
    }
}

fn is_whole(frame: &[u8], size: [u32; 2]) -> io::Result<()> {
    let wanted = 3 * size[0] as usize * size[1] as usize;
    if frame.len() == wanted {
        return Ok(());
    }
    let message = format!("a frame of {} bytes, not {wanted}", frame.len());
    Err(io::Error::new(io::ErrorKind::InvalidInput, message))
}

/// The box around the pixels in which two frames differ: left, top, width, height. One pixel where they are equal, since a frame has to have
/// one.
fn changed<T: PartialEq>(before: &[T], after: &[T], width: usize, channels: usize) -> [usize; 4] {
    let row = width * channels;
    let (mut left, mut right, mut top, mut bottom) = (width, 0, usize::MAX, 0);
    for (y, (a, b)) in before.chunks(row).zip(after.chunks(row)).enumerate() {
        let Some(first) = a.iter().zip(b).position(|(a, b)| a != b) else {
            continue;
        };
        let last = a.iter().zip(b).rposition(|(a, b)| a != b).unwrap_or(first);
        left = left.min(first / channels);
        right = right.max(last / channels + 1);
        top = top.min(y);
        bottom = y + 1;
    }
    if top == usize::MAX {
        return [0, 0, 1, 1];
    }
    [left, top, right - left, bottom - top]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_changed_is_a_box() {
        let before = [0; 12];
        let mut after = before;
        assert_eq!(changed(&before, &after, 4, 1), [0, 0, 1, 1]);
        (after[5], after[11]) = (1, 1);
        assert_eq!(changed(&before, &after, 4, 1), [1, 1, 3, 2]);
        // two channels a pixel
        assert_eq!(changed(&before, &after, 2, 2), [0, 1, 2, 2]);
    }

    #[test]
    fn what_a_kind_cannot_hold_is_refused() {
        let timing = Timing {
            size: [4, 4],
            frames: 2,
            rate: 60.0,
        };
        assert!(
            check(Kind::Gif, &timing)
                .unwrap_err()
                .contains("at most 50")
        );
        assert_eq!(check(Kind::Apng, &timing), Ok(()));
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(check(Kind::Y4m, &Timing { rate, ..timing }).is_err());
        }
        let wide = Timing {
            size: [70_000, 1],
            rate: 10.0,
            ..timing
        };
        assert!(check(Kind::Gif, &wide).unwrap_err().contains("65535"));
        assert!(
            check(
                Kind::Apng,
                &Timing {
                    frames: 0,
                    ..timing
                }
            )
            .is_err()
        );
    }
}
