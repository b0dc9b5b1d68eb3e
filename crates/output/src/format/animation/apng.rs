//! Animated PNG (PNG third edition, section 11.3.7): of each frame what changed.

use super::y4m::ratio;
use super::{Timing, changed, is_whole};
use ::png::{BitDepth, BlendOp, ColorType, DisposeOp, Encoder, EncodingError, SrgbRenderingIntent};
use std::io::{self, Write};

pub(super) struct Apng<W: Write> {
    writer: ::png::Writer<W>,
    size: [u32; 2],
    before: Vec<u8>,
    /// Frames that are still to come: the file has said how many there are.
    left: u32,
}

impl<W: Write> Apng<W> {
    pub(super) fn new(writer: W, timing: Timing) -> io::Result<Apng<W>> {
        let [width, height] = timing.size;
        let mut encoder = Encoder::new(writer, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        encoder.set_animated(timing.frames, 0).map_err(plain)?;
        let (seconds, parts) = delay(timing.rate);
        encoder.set_frame_delay(seconds, parts).map_err(plain)?;
        encoder.set_blend_op(BlendOp::Source).map_err(plain)?;
        encoder.set_dispose_op(DisposeOp::None).map_err(plain)?;
        Ok(Apng {
            writer: encoder.write_header().map_err(plain)?,
            size: timing.size,
            before: Vec::new(),
            left: timing.frames,
        })
    }

    pub(super) fn push(&mut self, frame: &[u8]) -> io::Result<()> {
        is_whole(frame, self.size)?;
        self.left = self.left.saturating_sub(1);
        let width = self.size[0] as usize;
        if self.before.is_empty() {
            self.writer.write_image_data(frame).map_err(plain)?;
        } else {
            let [x, y, w, h] = changed(&self.before, frame, width, 3);
            self.writer.reset_frame_position().map_err(plain)?;
            self.writer
                .set_frame_dimension(w as u32, h as u32)
                .map_err(plain)?;
            self.writer
                .set_frame_position(x as u32, y as u32)
                .map_err(plain)?;
            let part: Vec<u8> = (y..y + h)
                .flat_map(|row| &frame[3 * (row * width + x)..][..3 * w])
                .copied()
                .collect();
            self.writer.write_image_data(&part).map_err(plain)?;
        }
        self.before.clear();
        self.before.extend_from_slice(frame);
        Ok(())
    }

    pub(super) fn finish(self) -> io::Result<()> {
        if self.left > 0 {
            let message = format!(
                "{} of the frames that were announced are missing",
                self.left
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        self.writer.finish().map_err(plain)
    }
}

/// How long a frame is shown, as a fraction of a second of two numbers of 16 bits.
fn delay(rate: f64) -> (u16, u16) {
    let (above, below) = ratio(rate);
    match (u16::try_from(below), u16::try_from(above)) {
        (Ok(seconds), Ok(parts)) => (seconds, parts),
        _ => {
            let scale = 60_000.0_f64.min(60_000.0 * rate);
            let parts = scale.max(1.0);
            (
                (parts / rate).round().clamp(1.0, 65_535.0) as u16,
                parts as u16,
            )
        }
    }
}

fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::new(io::ErrorKind::InvalidInput, other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_are_one_over_the_rate() {
        for rate in [
            1.0,
            24.0,
            30.0,
            30_000.0 / 1001.0,
            12.5,
            60.0,
            144.0,
            0.5,
            1000.0,
            33.333,
        ] {
            let (seconds, parts) = delay(rate);
            let found = f64::from(parts) / f64::from(seconds);
            assert!(
                (found / rate - 1.0).abs() < 1e-3,
                "{rate}: {seconds}/{parts}"
            );
        }
    }
}
