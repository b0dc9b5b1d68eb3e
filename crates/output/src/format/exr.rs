//! OpenEXR: all planes of a film, as they are.
//!
//! One part with one channel a number: `R`, `G` and `B` are the linear colour, so that every viewer shows the picture,
//! and the other planes are layers by the convention of a dot in the name (`normal.X`, `steps.Y`, ...).

use super::attributes::Sorted;
use super::{Asking, Metadata, SOFTWARE};
use crate::cryptomatte::Mattes;
use ::exr::prelude::*;
use std::io::{self, Seek, Write};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Observer, Silent};

/// Names of a plane's channels.
fn channels(plane: Plane) -> &'static [&'static str] {
    match plane {
        Plane::Colour => &["R", "G", "B"],
        Plane::Coverage => &["coverage.Y"],
        Plane::Depth => &["depth.Z"],
        Plane::Normal => &["normal.X", "normal.Y", "normal.Z"],
        Plane::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
        Plane::Occlusion => &["occlusion.Y"],
        Plane::Shadow => &["shadow.Y"],
        Plane::Steps => &["steps.Y"],
        Plane::Residual => &["residual.Y"],
        Plane::Object => &["object.Y"],
    }
}

/// Writes all planes that a film has, 32-bit floats, losslessly compressed.
///
/// # Errors
/// What the writer gives; a film without pixels.
pub fn write(writer: impl Write + Seek, film: &Film, notes: &Metadata) -> io::Result<()> {
    write_watched(writer, film, notes, &Silent)
}

/// As [`write()`], and tells an observer of the pixels that are done.
///
/// # Errors
/// As [`write()`], and [`Cancelled`](super::Cancelled) where the observer wants it.
pub fn write_watched(
    writer: impl Write + Seek,
    film: &Film,
    notes: &Metadata,
    observer: &dyn Observer,
) -> io::Result<()> {
    write_beside(writer, film, &Beside::default(), notes, observer)
}

/// What a file has beside the planes of a film.
#[derive(Clone, Copy, Debug, Default)]
pub struct Beside<'a> {
    /// Whether the film was [cut out](Film::cut_out): its coverage is the channel `A` too, by which OpenEXR has colours multiplied.
    pub is_cut_out: bool,
    /// Mattes of the objects, of the same size.
    pub mattes: Option<&'a Mattes>,
}

/// As [`write_watched`], with what is beside the planes of the film.
///
/// # Errors
/// As [`write_watched`]; mattes of another size.
pub fn write_beside(
    writer: impl Write + Seek,
    film: &Film,
    beside: &Beside<'_>,
    notes: &Metadata,
    observer: &dyn Observer,
) -> io::Result<()> {
    let opacity = Some(film.plane(Plane::Coverage)).filter(|c| beside.is_cut_out && !c.is_empty());
    if let Some(mattes) = beside.mattes
        && mattes.size() != [film.width(), film.height()]
    {
        let [width, height] = mattes.size();
        let message = format!(
            "mattes of {width}x{height} for a picture of {}x{}",
            film.width(),
            film.height()
        );
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let size = Vec2(film.width() as usize, film.height() as usize);
    let held = Plane::ALL
        .iter()
        .filter(|plane| !film.plane(**plane).is_empty());
    let list = held.flat_map(|&plane| {
        let numbers = film.plane(plane);
        (0..).zip(channels(plane)).map(move |(c, &name)| {
            let samples = numbers
                .iter()
                .skip(c)
                .step_by(plane.channels())
                .copied()
                .collect();
            AnyChannel::new(name, FlatSamples::F32(samples))
        })
    });
    let alpha = opacity.map(|a| AnyChannel::new("A", FlatSamples::F32(a.to_vec())));
    let mattes = beside.mattes.into_iter();
    let mattes = mattes
        .flat_map(Mattes::channels)
        .map(|(name, numbers)| AnyChannel::new(name.as_str(), FlatSamples::F32(numbers)));
    let mut attributes = LayerAttributes {
        software_name: Some(text(SOFTWARE)),
        ..LayerAttributes::default()
    };
    for (key, value) in notes.written("title") {
        let value = AttributeValue::Text(text(&value));
        attributes.other.insert(text(key), value);
    }
    for (key, value) in beside.mattes.into_iter().flat_map(Mattes::attributes) {
        let value = AttributeValue::Text(text(&value));
        attributes.other.insert(text(&key), value);
    }
    let layer = Layer::new(
        size,
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.chain(alpha).chain(mattes).collect()),
    );
    let writer = Sorted::new(Asking { writer, observer });
    let total = u64::from(film.width()) * u64::from(film.height());
    let mut told = 0;
    Image::from_layer(layer)
        .write()
        .on_progress(|share| {
            let done = (share * total as f64) as u64;
            observer.advance(done.saturating_sub(told), total);
            told = told.max(done);
        })
        .to_buffered(writer)
        .map_err(|error| match error {
            Error::Io(error) => error,
            other => io::Error::new(io::ErrorKind::InvalidInput, other.to_string()),
        })
}

/// OpenEXR's text has no stated coding; everybody reads UTF-8.
fn text(from: &str) -> Text {
    Text::from_bytes_unchecked(from.bytes().collect())
}
