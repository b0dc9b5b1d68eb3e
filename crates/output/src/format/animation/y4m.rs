//! YUV4MPEG2 (mjpegtools, yuv4mpeg(5)): frames as other programs take them from a pipe.

use super::{Timing, is_whole};
use std::io::{self, Write};

pub(super) struct Y4m<W> {
    writer: W,
    size: [u32; 2],
    planes: Vec<u8>,
}

impl<W: Write> Y4m<W> {
    pub(super) fn new(mut writer: W, timing: Timing) -> io::Result<Y4m<W>> {
        let [width, height] = timing.size;
        let (above, below) = ratio(timing.rate);
        // whole chroma, ITU-R BT.709 in its limited range
        writeln!(
            writer,
            "YUV4MPEG2 W{width} H{height} F{above}:{below} Ip A1:1 C444 XCOLORRANGE=LIMITED"
        )?;
        Ok(Y4m {
            writer,
            size: timing.size,
            planes: Vec::new(),
        })
    }

    pub(super) fn push(&mut self, frame: &[u8]) -> io::Result<()> {
        is_whole(frame, self.size)?;
        let pixels = frame.len() / 3;
        self.planes.clear();
        self.planes.resize(3 * pixels, 0);
        for (i, pixel) in frame.as_chunks::<3>().0.iter().enumerate() {
            for (k, x) in coded(*pixel).into_iter().enumerate() {
                self.planes[k * pixels + i] = x;
            }
        }
        self.writer.write_all(b"FRAME\n")?;
        self.writer.write_all(&self.planes)
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

/// Luma and chroma of a pixel (ITU-R BT.709-6, items 3.2 to 3.4, 8 bits).
fn coded(pixel: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = pixel.map(|x| f32::from(x) / 255.0);
    let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let (cb, cr) = ((b - y) / 1.8556, (r - y) / 1.5748);
    [16.0 + 219.0 * y, 128.0 + 224.0 * cb, 128.0 + 224.0 * cr].map(|x| x.round() as u8)
}

/// A rate as a fraction: of whole numbers, of thousandths over 1001 as television has them, or of thousandths.
pub(super) fn ratio(rate: f64) -> (u32, u32) {
    for (above, below) in [(rate, 1), (rate * 1.001, 1001)] {
        if (above - above.round()).abs() < 1e-6 && above < 1e6 {
            let scale = if below == 1001 { 1000 } else { 1 };
            return (above.round().max(1.0) as u32 * scale, below);
        }
    }
    ((rate * 1000.0).round().clamp(1.0, 4e9) as u32, 1000)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_standard() {
        // black, white and the primaries (BT.709, 8 bits)
        assert_eq!(coded([0, 0, 0]), [16, 128, 128]);
        assert_eq!(coded([255, 255, 255]), [235, 128, 128]);
        assert_eq!(coded([255, 0, 0]), [63, 102, 240]);
        assert_eq!(coded([0, 255, 0]), [173, 42, 26]);
        assert_eq!(coded([0, 0, 255]), [32, 240, 118]);
    }

    #[test]
    fn rates_are_fractions() {
        assert_eq!(ratio(30.0), (30, 1));
        assert_eq!(ratio(30_000.0 / 1001.0), (30_000, 1001));
        assert_eq!(ratio(12.5), (12_500, 1000));
    }

    #[test]
    fn a_stream_is_a_header_and_planes() {
        let timing = Timing {
            size: [2, 1],
            frames: 1,
            rate: 24.0,
        };
        let mut out = Vec::new();
        let mut y4m = Y4m::new(&mut out, timing).unwrap();
        y4m.push(&[0, 0, 0, 255, 255, 255]).unwrap();
        assert!(y4m.push(&[0]).is_err());
        y4m.finish().unwrap();
        let (head, body) = out.split_at(out.iter().position(|b| *b == b'\n').unwrap() + 1);
        assert!(head.starts_with(b"YUV4MPEG2 W2 H1 F24:1"));
        assert_eq!(body, b"FRAME\n\x10\xeb\x80\x80\x80\x80");
    }
}
