//! OpenEXR: all planes of a film, as they are.
//!
//! One part with one channel a number: `R`, `G` and `B` are the linear colour, so that every viewer shows the picture,
//! and the other planes are layers by the convention of a dot in the name (`normal.X`, `steps.Y`, ...).

use super::attributes::Sorted;
use super::{Asking, Metadata, SOFTWARE};
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
    write_planes(writer, film, None, notes, observer)
}

/// As [`write_watched`], of a film that was [cut out](Film::cut_out): its coverage is the channel `A` too, by which OpenEXR has colours multiplied.
///
/// # Errors
/// As [`write_watched`].
pub fn write_cut_out(
    writer: impl Write + Seek,
    film: &Film,
    notes: &Metadata,
    observer: &dyn Observer,
) -> io::Result<()> {
    let opacity = Some(film.plane(Plane::Coverage)).filter(|c| !c.is_empty());
    write_planes(writer, film, opacity, notes, observer)
}

fn write_planes(
    writer: impl Write + Seek,
    film: &Film,
    opacity: Option<&[f32]>,
    notes: &Metadata,
    observer: &dyn Observer,
) -> io::Result<()> {
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
    let mut attributes = LayerAttributes {
        software_name: Some(text(SOFTWARE)),
        ..LayerAttributes::default()
    };
    for (key, value) in notes.written("title") {
        let value = AttributeValue::Text(text(&value));
        attributes.other.insert(text(key), value);
    }
    let layer = Layer::new(
        size,
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.chain(alpha).collect()),
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
