//! OpenEXR: all planes of a film, as they are.
//!
//! One part with one channel a number: `R`, `G` and `B` are the linear colour, so that every viewer shows the picture,
//! and the other planes are layers by the convention of a dot in the name (`normal.X`, `steps.Y`, ...).

use super::{Notes, SOFTWARE};
use ::exr::prelude::*;
use std::io::{self, Seek, Write};
use zeroset_scene::film::{Film, Plane};

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
pub fn write(writer: impl Write + Seek, film: &Film, notes: &Notes) -> io::Result<()> {
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
    let mut attributes = LayerAttributes {
        software_name: Some(text(SOFTWARE)),
        ..LayerAttributes::default()
    };
    let title = ("title", notes.title.as_str());
    for (key, value) in [title]
        .into_iter()
        .chain(notes.entries.iter().map(|(k, t)| (k.as_str(), t.as_str())))
    {
        attributes
            .other
            .insert(text(key), AttributeValue::Text(text(value)));
    }
    let layer = Layer::new(
        size,
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.collect()),
    );
    Image::from_layer(layer)
        .write()
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
