//! Images of light in the format of Radiance, `.hdr`: three colours with an exponent in common (Ward 1991, "Real pixels").

use glam::Vec3;

/// What such a file begins with.
const BEGINNINGS: [&[u8]; 2] = [b"#?RADIANCE", b"#?RGBE"];
/// Rows of other lengths are not packed number by number.
const PACKED: std::ops::Range<u32> = 8..32_768;

/// Whether a file begins like one.
pub(crate) fn is_one(bytes: &[u8]) -> bool {
    BEGINNINGS.iter().any(|b| bytes.starts_with(b))
}

/// What is left to read of a file.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    fn line(&mut self) -> Result<String, String> {
        let end = self.0.iter().take(1024).position(|b| *b == b'\n');
        let end = end.ok_or("its head has a line without an end")?;
        let line = String::from_utf8_lossy(&self.0[..end]);
        let line = line.trim_end_matches('\r').to_owned();
        self.0 = &self.0[end + 1..];
        Ok(line)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let (taken, rest) = self
            .0
            .split_first_chunk::<N>()
            .ok_or("it ends before its pixels do")?;
        self.0 = rest;
        Ok(*taken)
    }
}

/// Width and height, and where the pixels begin.
///
/// # Errors
/// What is wrong with the head of the file.
pub(crate) fn head(bytes: &[u8]) -> Result<([u32; 2], &[u8]), String> {
    let mut rest = Rest(bytes);
    loop {
        let line = rest.line()?;
        if line.is_empty() {
            break;
        }
        let format = line.strip_prefix("FORMAT=");
        if format.is_some_and(|format| format != "32-bit_rle_rgbe") {
            return Err("its format is not 32-bit_rle_rgbe".to_owned());
        }
    }
    let line = rest.line()?;
    let words: Vec<&str> = line.split_whitespace().collect();
    let number = |word: &str| word.parse::<u32>().ok();
    match words[..] {
        ["-Y", height, "+X", width] => match (number(width), number(height)) {
            (Some(width), Some(height)) => Ok(([width, height], rest.0)),
            _ => Err("its width and height are no numbers".to_owned()),
        },
        _ => Err("its rows do not go from the top left to the bottom right (-Y, +X)".to_owned()),
    }
}

/// The linear colours of an image of this size, whose room was asked for.
///
/// # Errors
/// What is wrong with the pixels.
pub(crate) fn pixels([width, height]: [u32; 2], bytes: &[u8]) -> Result<Vec<Vec3>, String> {
    let mut rest = Rest(bytes);
    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    let mut row = vec![[0u8; 4]; width as usize];
    for _ in 0..height {
        let is_packed = PACKED.contains(&width)
            && matches!(rest.0, [2, 2, high, low, ..]
                if u32::from(u16::from_be_bytes([*high, *low])) == width);
        if is_packed {
            rest.take::<4>()?;
            packed(&mut rest, &mut row)?;
        } else {
            plain(&mut rest, &mut row)?;
        }
        pixels.extend(row.iter().map(|pixel| colour(*pixel)));
    }
    Ok(pixels)
}

/// A row packed number by number: first all of red, then green, blue and exponents.
fn packed(rest: &mut Rest<'_>, row: &mut [[u8; 4]]) -> Result<(), String> {
    for channel in 0..4 {
        let mut at = 0;
        while at < row.len() {
            let [count] = rest.take()?;
            let (count, run) = match count {
                129.. => (usize::from(count) - 128, true),
                _ => (usize::from(count), false),
            };
            let pixels = row.get_mut(at..at + count).filter(|_| count > 0);
            let pixels = pixels.ok_or("a run in it does not fit its row")?;
            if run {
                let [value] = rest.take()?;
                pixels.iter_mut().for_each(|pixel| pixel[channel] = value);
            } else {
                for pixel in pixels {
                    [pixel[channel]] = rest.take()?;
                }
            }
            at += count;
        }
    }
    Ok(())
}

/// A row pixel by pixel; 1, 1, 1 repeats the one before, and longer each time that it follows itself.
fn plain(rest: &mut Rest<'_>, row: &mut [[u8; 4]]) -> Result<(), String> {
    let (mut at, mut shift) = (0, 0);
    while at < row.len() {
        let pixel: [u8; 4] = rest.take()?;
        let [1, 1, 1, count] = pixel else {
            row[at] = pixel;
            (at, shift) = (at + 1, 0);
            continue;
        };
        let count = usize::from(count) << shift;
        let before = at.checked_sub(1).map(|k| row[k]);
        let run = row.get_mut(at..at + count);
        match (before, run) {
            (Some(before), Some(run)) if shift <= 16 => run.fill(before),
            _ => return Err("a run in it does not fit its row".to_owned()),
        }
        (at, shift) = (at + count, shift + 8);
    }
    Ok(())
}

/// The brightest that a pixel may be, as colours of scenes: sums of what is brighter may be no number. (The sun is 1e9.)
const BRIGHTEST: f32 = 1e12;

fn colour([r, g, b, exponent]: [u8; 4]) -> Vec3 {
    if exponent == 0 {
        return Vec3::ZERO;
    }
    let scale = (f32::from(exponent) - 136.0).exp2();
    (Vec3::new(f32::from(r), f32::from(g), f32::from(b)) * scale).min(Vec3::splat(BRIGHTEST))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &[u8] = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n";

    fn read(bytes: &[u8]) -> Result<Vec<Vec3>, String> {
        let (size, rest) = head(bytes)?;
        assert_eq!(size, [8, 2]);
        pixels(size, rest)
    }

    #[test]
    fn packed_and_plain_rows_are_read() {
        let mut bytes = HEAD.to_vec();
        // a row of runs: red 128, green 64, blue of single numbers, exponent 129
        bytes.extend([
            2, 2, 0, 8, 136, 128, 136, 64, 8, 0, 32, 64, 96, 128, 160, 192, 224,
        ]);
        bytes.extend([136, 129]);
        // a row of pixels, the last five of them by a run
        bytes.extend([255, 0, 0, 128, 0, 128, 0, 130, 9, 9, 9, 0, 1, 1, 1, 5]);
        let found = read(&bytes).expect("pixels");
        assert_eq!(found.len(), 16);
        assert_eq!(found[3], Vec3::new(1.0, 0.5, 0.75));
        assert_eq!(found[8], Vec3::new(255.0 / 256.0, 0.0, 0.0));
        assert_eq!(found[9], Vec3::new(0.0, 2.0, 0.0));
        assert!(found[10..].iter().all(|c| *c == Vec3::ZERO));
    }

    /// Whatever a byte is, and wherever a file ends: as many pixels as it says, all of them numbers, or an error.
    #[test]
    fn damage_is_survived() {
        let mut whole = HEAD.to_vec();
        whole.extend([
            2, 2, 0, 8, 136, 128, 136, 64, 8, 0, 32, 64, 96, 128, 160, 192, 224,
        ]);
        whole.extend([136, 129]);
        whole.extend([255, 0, 0, 128, 0, 128, 0, 130, 9, 9, 9, 0, 1, 1, 1, 5]);
        let survives = |bytes: &[u8]| {
            let Ok((size, rest)) = head(bytes) else {
                return;
            };
            let count = u64::from(size[0]) * u64::from(size[1]);
            // what is larger is charged for before its pixels are asked for
            if count < 1000
                && let Ok(found) = pixels(size, rest)
            {
                assert_eq!(found.len() as u64, count);
                assert!(
                    found
                        .iter()
                        .all(|c| c.is_finite() && c.max_element() <= BRIGHTEST)
                );
            }
        };
        for end in 0..whole.len() {
            survives(&whole[..end]);
            for byte in 0..=255 {
                let mut bytes = whole.clone();
                bytes[end] = byte;
                survives(&bytes);
            }
        }
    }

    #[test]
    fn what_is_broken_is_refused() {
        let says = |bytes: &[u8]| read(bytes).expect_err("refused");
        assert!(says(HEAD).contains("ends before"));
        let with = |rest: &[u8]| [HEAD, rest].concat();
        assert!(says(&with(&[2, 2, 0, 8, 200, 1])).contains("does not fit"));
        assert!(says(&with(&[2, 2, 0, 8, 0])).contains("does not fit"));
        assert!(says(&with(&[1, 1, 1, 4])).contains("does not fit"));
        let turned = b"#?RADIANCE\n\n+X 8 -Y 2\n";
        assert!(head(turned).expect_err("refused").contains("top left"));
        assert!(head(b"#?RADIANCE\nFORMAT=xyze\n\n").is_err());
        assert!(head(b"#?RADIANCE").is_err());
    }
}
