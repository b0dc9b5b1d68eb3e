//! File formats.

mod attributes;

pub mod animation;
pub mod checkpoint;
pub mod exr;
pub mod png;
pub mod read;
pub mod recipe;

use crate::display;
use std::borrow::Cow;
use std::io::{self, Seek, SeekFrom, Write};
use zeroset_scene::render::Observer;

/// Most characters of a title.
const TITLE: usize = 200;
/// Most characters of an entry.
pub const ENTRY: usize = 1 << 16;

/// What a file says about the picture in it. Nothing in here may name a place on the machine that made it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    /// The scene's name.
    pub title: String,
    /// Further entries: a key of 1 to 79 printable ASCII characters, and text.
    pub entries: Vec<(String, String)>,
}

impl Metadata {
    /// Metadata with a title. Of a title that is a path, its last part is kept.
    pub fn new(title: &str) -> Metadata {
        let title = title.rsplit(['/', '\\']).next().unwrap_or_default();
        Metadata {
            title: title.to_owned(),
            entries: Vec::new(),
        }
    }

    /// These notes with one more entry.
    #[must_use]
    pub fn with(mut self, key: &str, text: impl Into<String>) -> Metadata {
        self.entries.push((key.to_owned(), text.into()));
        self
    }

    /// All entries, the title first under the key that the format has for it, as they are written: programs show them.
    fn written<'a>(&'a self, title: &'a str) -> impl Iterator<Item = (&'a str, Cow<'a, str>)> {
        let entries = self.entries.iter().map(|(key, text)| {
            let text = match display::clean(text) {
                Cow::Borrowed(text) => display::clip(text, ENTRY),
                Cow::Owned(text) => Cow::Owned(display::clip(&text, ENTRY).into_owned()),
            };
            (key.as_str(), text)
        });
        std::iter::once((title, Cow::Owned(display::name(&self.title, TITLE)))).chain(entries)
    }
}

/// The observer did not want a file any more.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("the writing was cancelled")]
pub struct Cancelled;

/// A writer that asks its observer before it writes.
struct Asking<'a, W> {
    writer: W,
    observer: &'a dyn Observer,
}

impl<W: Write> Write for Asking<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.observer.is_cancelled() {
            return Err(io::Error::other(Cancelled));
        }
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

impl<W: Seek> Seek for Asking<'_, W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.writer.seek(to)
    }
}

/// The program that wrote a file.
const SOFTWARE: &str = concat!("Zeroset ", env!("CARGO_PKG_VERSION"));
