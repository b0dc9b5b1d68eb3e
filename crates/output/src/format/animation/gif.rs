//! GIF89a.

use super::palette::{Histogram, Mixer};
use super::{Timing, changed, is_whole};
use ::gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::borrow::Cow;
use std::io::{self, Write};

/// The number of no colour: what stays as it was.
const STAYS: u8 = u8::MAX;
/// Colours beside it.
const COLOURS: usize = 255;

pub(super) struct Gif<W: Write> {
    writer: W,
    timing: Timing,
    histogram: Histogram,
    frames: Vec<Vec<u8>>,
}

impl<W: Write> Gif<W> {
    pub(super) fn new(writer: W, timing: Timing) -> Gif<W> {
        Gif {
            writer,
            timing,
            histogram: Histogram::new(),
            frames: Vec::new(),
        }
    }

    pub(super) fn push(&mut self, frame: &[u8]) -> io::Result<()> {
        is_whole(frame, self.timing.size)?;
        self.histogram.add(frame);
        self.frames.push(frame.to_vec());
        Ok(())
    }

    pub(super) fn finish(self) -> io::Result<()> {
        let [width, height] = self.timing.size.map(|n| n as usize);
        let colours = self.histogram.colours(COLOURS);
        let mut mixer = Mixer::new(&colours);
        let mut palette = colours.as_flattened().to_vec();
        palette.resize(3 * (COLOURS + 1), 0);
        let (w, h) = (width as u16, height as u16);
        let mut encoder = Encoder::new(self.writer, w, h, &palette).map_err(plain)?;
        encoder.set_repeat(Repeat::Infinite).map_err(plain)?;
        let mut before: Vec<u8> = Vec::new();
        for (number, frame) in self.frames.iter().enumerate() {
            let pixels = frame.as_chunks::<3>().0;
            let now: Vec<u8> = (pixels.iter().enumerate())
                .map(|(i, pixel)| mixer.colour(*pixel, i % width, i / width))
                .collect();
            let [x, y, w, h] = match before.is_empty() {
                true => [0, 0, width, height],
                false => changed(&before, &now, width, 1),
            };
            let of_row = |row: usize| row * width + x..row * width + x + w;
            let part: Vec<u8> = (y..y + h)
                .flat_map(of_row)
                .map(|i| {
                    if before.get(i) == Some(&now[i]) {
                        STAYS
                    } else {
                        now[i]
                    }
                })
                .collect();
            let frame = Frame {
                delay: delay(number, self.timing.rate),
                dispose: DisposalMethod::Keep,
                transparent: (number > 0).then_some(STAYS),
                left: x as u16,
                top: y as u16,
                width: w as u16,
                height: h as u16,
                buffer: Cow::Owned(part),
                ..Frame::default()
            };
            encoder.write_frame(&frame).map_err(plain)?;
            before = now;
        }
        encoder.into_inner().map_err(plain)?.flush()
    }
}

/// How long a frame is shown, in hundredths of a second, such that all of them together keep the rate.
fn delay(frame: usize, rate: f64) -> u16 {
    let until = |n: usize| (100.0 * n as f64 / rate).round();
    (until(frame + 1) - until(frame)).clamp(2.0, 65_535.0) as u16
}

fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::new(io::ErrorKind::InvalidInput, other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_keep_the_rate() {
        for rate in [10.0, 24.0, 30.0, 50.0, 12.5] {
            let all: u32 = (0..300).map(|n| u32::from(delay(n, rate))).sum();
            assert_eq!(f64::from(all), (30_000.0 / rate).round(), "{rate}");
        }
    }
}
