//! File formats.

pub mod exr;
pub mod png;
pub mod read;

/// What a file says about the picture in it. Nothing in here may name a place on the machine that made it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Notes {
    /// The scene's name.
    pub title: String,
    /// Further entries: a key of 1 to 79 printable ASCII characters, and text.
    pub entries: Vec<(String, String)>,
}

impl Notes {
    /// Notes with a title. Of a title that is a path, its last part is kept.
    pub fn new(title: &str) -> Notes {
        let title = title.rsplit(['/', '\\']).next().unwrap_or_default();
        Notes {
            title: title.to_owned(),
            entries: Vec::new(),
        }
    }

    /// These notes with one more entry.
    #[must_use]
    pub fn with(mut self, key: &str, text: impl Into<String>) -> Notes {
        self.entries.push((key.to_owned(), text.into()));
        self
    }
}

/// The program that wrote a file.
const SOFTWARE: &str = concat!("Zeroset ", env!("CARGO_PKG_VERSION"));
