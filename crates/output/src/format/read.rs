//! Reading pictures back: to compare them, and for what they say of themselves.

use crate::picture::Picture;
use crate::tone;
use ::exr::prelude as exr;
use ::png::{ColorType, Decoder, DecodingError, Limits, Transformations};
use std::fs::{self, File};
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

/// Most bytes of a note that is read.
const NOTE: usize = 1 << 20;
/// Most pixels of a picture that is read.
pub const MAX_PIXELS: u64 = 1 << 27;

/// Why a picture could not be read.
#[derive(Debug, thiserror::Error)]
#[error("cannot read {}: {failure}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// What went wrong.
    pub failure: ReadFailure,
}

/// What goes wrong when a picture is read.
#[derive(Debug, thiserror::Error)]
pub enum ReadFailure {
    /// What the system said.
    #[error("{0}")]
    System(#[source] io::Error),
    /// A folder, a device, a pipe.
    #[error("it is not a regular file")]
    Special,
    /// Neither PNG nor OpenEXR.
    #[error("it is neither a PNG nor an OpenEXR file")]
    Format,
    /// More pixels than [`MAX_PIXELS`].
    #[error("it has {width}x{height} pixels, at most {MAX_PIXELS} in all are read")]
    Large {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
    },
    /// Pixels that are not opaque: what is behind them is anybody's guess.
    #[error("it has transparent pixels, only opaque pictures are read")]
    Transparent,
    /// A broken file.
    #[error("the file is damaged: {0}")]
    Damaged(String),
}

/// Reads a PNG of any kind, or the colour of an OpenEXR file, which is coded as [`Picture::develop`] does.
///
/// # Errors
/// See [`ReadFailure`].
pub fn read(path: &Path) -> Result<Picture, ReadError> {
    open(path).map_err(|failure| ReadError {
        path: path.to_owned(),
        failure,
    })
}

/// The note that a PNG or an OpenEXR file has under a name: a text chunk before the pixels, or an attribute of the first header. `None`
/// where it has none.
///
/// # Errors
/// See [`ReadFailure`]. Pixels are not looked at.
pub fn note(path: &Path, key: &str) -> Result<Option<String>, ReadError> {
    let read = || match opened(path)? {
        (Kind::Png, file) => png_note(file, key),
        (Kind::Exr, file) => exr_note(file, key),
    };
    let short = |text: Option<String>| match text {
        Some(text) if text.len() > NOTE => Err(ReadFailure::Damaged(format!(
            "the note `{key}` has {} bytes, at most {NOTE} are read",
            text.len()
        ))),
        other => Ok(other),
    };
    read().and_then(short).map_err(|failure| ReadError {
        path: path.to_owned(),
        failure,
    })
}

fn png_note(file: BufReader<File>, key: &str) -> Result<Option<String>, ReadFailure> {
    let reader = Decoder::new(file).read_info().map_err(damaged_png)?;
    let info = reader.info();
    if let Some(text) = (info.uncompressed_latin1_text.iter()).find(|t| t.keyword == key) {
        return Ok(Some(text.text.clone()));
    }
    // programs that pass a picture on compress its texts
    if let Some(text) = (info.compressed_latin1_text.iter()).find(|t| t.keyword == key) {
        let mut text = text.clone();
        text.decompress_text_with_limit(NOTE).map_err(damaged_png)?;
        return text.get_text().map(Some).map_err(damaged_png);
    }
    let Some(text) = info.utf8_text.iter().find(|t| t.keyword == key) else {
        return Ok(None);
    };
    let mut text = text.clone();
    text.decompress_text_with_limit(NOTE).map_err(damaged_png)?;
    text.get_text().map(Some).map_err(damaged_png)
}

fn exr_note(mut file: BufReader<File>, key: &str) -> Result<Option<String>, ReadFailure> {
    let metadata = exr::MetaData::read_from_buffered(&mut file, false).map_err(damaged_exr)?;
    let name = exr::Text::new_or_none(key);
    let held = metadata
        .headers
        .first()
        .zip(name)
        .and_then(|(header, name)| {
            let own = header.own_attributes.other.get(&name);
            own.or_else(|| header.shared_attributes.other.get(&name))
        });
    Ok(held.and_then(|value| match value {
        exr::AttributeValue::Text(text) => Some(String::from_utf8_lossy(text.bytes()).into_owned()),
        _ => None,
    }))
}

/// What a file begins like.
enum Kind {
    Png,
    Exr,
}

fn open(path: &Path) -> Result<Picture, ReadFailure> {
    match opened(path)? {
        (Kind::Png, file) => read_png(file),
        (Kind::Exr, file) => read_exr(file),
    }
}

fn opened(path: &Path) -> Result<(Kind, BufReader<File>), ReadFailure> {
    // before it is opened, because a pipe would block
    if !fs::metadata(path).map_err(ReadFailure::System)?.is_file() {
        return Err(ReadFailure::Special);
    }
    let mut file = BufReader::new(File::open(path).map_err(ReadFailure::System)?);
    let mut magic = Vec::new();
    file.by_ref()
        .take(4)
        .read_to_end(&mut magic)
        .map_err(ReadFailure::System)?;
    file.rewind().map_err(ReadFailure::System)?;
    match magic.as_slice() {
        b"\x89PNG" => Ok((Kind::Png, file)),
        b"\x76\x2f\x31\x01" => Ok((Kind::Exr, file)),
        _ => Err(ReadFailure::Format),
    }
}

fn damaged_png(error: DecodingError) -> ReadFailure {
    match error {
        DecodingError::IoError(error) if error.kind() != io::ErrorKind::UnexpectedEof => {
            ReadFailure::System(error)
        }
        other => ReadFailure::Damaged(other.to_string()),
    }
}

fn damaged_exr(error: exr::Error) -> ReadFailure {
    match error {
        exr::Error::Io(error) => ReadFailure::System(error),
        other => ReadFailure::Damaged(other.to_string()),
    }
}

/// Refuses a size before anything of that size is allocated.
fn check(width: u64, height: u64) -> Result<(), ReadFailure> {
    match width.checked_mul(height) {
        Some(pixels) if pixels <= MAX_PIXELS => Ok(()),
        _ => Err(ReadFailure::Large { width, height }),
    }
}

fn read_png(file: BufReader<File>) -> Result<Picture, ReadFailure> {
    let mut decoder = Decoder::new(file);
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    let header = decoder.read_header_info().map_err(damaged_png)?;
    let (width, height) = (header.width, header.height);
    check(width.into(), height.into())?;
    decoder.set_limits(Limits {
        bytes: 64 * MAX_PIXELS as usize,
    });
    let mut reader = decoder.read_info().map_err(damaged_png)?;
    let size = reader.output_buffer_size().ok_or(ReadFailure::Large {
        width: width.into(),
        height: height.into(),
    })?;
    let mut bytes = vec![0; size];
    reader.next_frame(&mut bytes).map_err(damaged_png)?;
    let (colour, depth) = reader.output_color_type();
    let channels = colour.samples();
    let wide = depth == ::png::BitDepth::Sixteen;
    let sample = |i: usize| {
        if wide {
            f32::from(u16::from_be_bytes([bytes[2 * i], bytes[2 * i + 1]])) / 65535.0
        } else {
            f32::from(bytes[i]) / 255.0
        }
    };
    let pixels = width as usize * height as usize;
    if matches!(colour, ColorType::Rgba | ColorType::GrayscaleAlpha)
        && (0..pixels).any(|i| sample(i * channels + channels - 1) < 1.0)
    {
        return Err(ReadFailure::Transparent);
    }
    let mut at = 0;
    Ok(Picture::from_fn(width, height, |_, _| {
        let i = at * channels;
        at += 1;
        if channels < 3 {
            [sample(i); 3]
        } else {
            [sample(i), sample(i + 1), sample(i + 2)]
        }
    }))
}

fn read_exr(mut file: BufReader<File>) -> Result<Picture, ReadFailure> {
    use exr::{ReadChannels, ReadLayers};
    let metadata = exr::MetaData::read_from_buffered(&mut file, false).map_err(damaged_exr)?;
    for header in &metadata.headers {
        check(
            header.layer_size.width() as u64,
            header.layer_size.height() as u64,
        )?;
    }
    file.rewind().map_err(ReadFailure::System)?;
    let image = exr::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size: exr::Vec2<usize>, _: &_| {
                Picture::filled(size.width() as u32, size.height() as u32, [0.0; 3])
            },
            |picture: &mut Picture, at: exr::Vec2<usize>, (r, g, b, _): (f32, f32, f32, f32)| {
                picture.set(at.x() as i64, at.y() as i64, [r, g, b].map(tone::encode));
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(file)
        .map_err(damaged_exr)?;
    Ok(image.layer_data.channel_data.pixels)
}
