//! PNG: 8 or 16 bits a channel, sRGB, with notes in text chunks.

use super::{Asking, Metadata, SOFTWARE};
use crate::picture::Rows;
use crate::tone;
use ::png::{BitDepth, ColorType, Encoder, EncodingError, SrgbRenderingIntent};
use std::io::{self, Write};
use zeroset_scene::render::{Observer, Silent};

/// Bits a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 256 levels, dithered.
    #[default]
    Eight,
    /// 65,536 levels.
    Sixteen,
}

/// Writes a picture, row by row.
///
/// # Errors
/// What the writer gives; a picture without pixels or with a side of more than 2^31 - 1, which PNG cannot hold.
pub fn write(
    writer: impl Write,
    picture: &dyn Rows,
    depth: Depth,
    notes: &Metadata,
) -> io::Result<()> {
    write_watched(writer, picture, depth, notes, &Silent)
}

/// As [`write()`], and tells an observer of the pixels that are done.
///
/// # Errors
/// As [`write()`], and [`Cancelled`](super::Cancelled) where the observer wants it.
pub fn write_watched(
    writer: impl Write,
    picture: &dyn Rows,
    depth: Depth,
    notes: &Metadata,
    observer: &dyn Observer,
) -> io::Result<()> {
    let mut writer = Faithful {
        writer: Asking { writer, observer },
        failed: None,
    };
    let encoded = encode(&mut writer, picture, depth, notes, observer);
    writer.failed.map_or(encoded, Err)
}

fn encode(
    writer: impl Write,
    picture: &dyn Rows,
    depth: Depth,
    notes: &Metadata,
    observer: &dyn Observer,
) -> io::Result<()> {
    let mut encoder = Encoder::new(writer, picture.width(), picture.height());
    let is_opaque = picture.opacity(0).is_none();
    encoder.set_color(match is_opaque {
        true => ColorType::Rgb,
        false => ColorType::Rgba,
    });
    encoder.set_depth(match depth {
        Depth::Eight => BitDepth::Eight,
        Depth::Sixteen => BitDepth::Sixteen,
    });
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder
        .add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())
        .map_err(plain)?;
    for (key, text) in notes.written("Title") {
        let (key, text) = (key.to_owned(), text.into_owned());
        if text.is_ascii() {
            encoder.add_text_chunk(key, text).map_err(plain)?;
        } else {
            encoder.add_itxt_chunk(key, text).map_err(plain)?;
        }
    }
    let mut writer = encoder.write_header().map_err(plain)?;
    let mut stream = writer.stream_writer().map_err(plain)?;
    let mut line = Vec::with_capacity(picture.width() as usize * 8);
    let mut row = Vec::new();
    let width = u64::from(picture.width());
    let total = width * u64::from(picture.height());
    for y in 0..picture.height() {
        picture.row(y, &mut row);
        line.clear();
        let opacity = picture.opacity(y);
        for (x, pixel) in (0..).zip(&row) {
            let mut put = |channel: f32| match depth {
                Depth::Eight => line.push(tone::quantise8(channel, x, y)),
                Depth::Sixteen => line.extend(tone::quantise16(channel).to_be_bytes()),
            };
            pixel.iter().for_each(|channel| put(*channel));
            if !is_opaque {
                put(opacity
                    .and_then(|o| o.get(x as usize))
                    .copied()
                    .unwrap_or(1.0));
            }
        }
        // rows that compress to nothing are not written before the end
        if observer.is_cancelled() {
            return Err(io::Error::other(super::Cancelled));
        }
        stream.write_all(&line)?;
        observer.advance(width, total);
    }
    stream.finish().map_err(plain)?;
    writer.finish().map_err(plain)
}

/// A writer that keeps its first error, which the encoder would make a text of.
struct Faithful<W> {
    writer: W,
    failed: Option<io::Error>,
}

impl<W: Write> Faithful<W> {
    fn keep<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        result.map_err(|error| {
            let kind = error.kind();
            // which is tried again
            if kind != io::ErrorKind::Interrupted {
                self.failed.get_or_insert(error);
            }
            kind.into()
        })
    }
}

impl<W: Write> Write for Faithful<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.writer.write(bytes);
        self.keep(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.writer.flush();
        self.keep(result)
    }
}

fn plain(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::new(io::ErrorKind::InvalidInput, other),
    }
}
