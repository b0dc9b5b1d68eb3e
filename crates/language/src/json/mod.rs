//! The scene's JSON twin: everything that a scene is, as data.
//!
//! `expand` writes it and every command takes it, so that other programs can write scenes. From a scene to JSON and back
//! nothing changes: fields keep their shape and sharing, and every number its bits.
//!
//! - A field is an object with one key, the name of what it is: `{"sphere": {"radius": 1.0}}`. Its parameters have the
//!   names of the language; what is changed or joined stands under `of`. A field that is used more than once stands in the
//!   list `parts`, and `{"part": 0}` stands for it; a part may use earlier parts.
//! - Angles of fields are degrees, as in the language, wherever degrees say them exactly; otherwise the name of the
//!   parameter ends in `_radians`.
//! - Colours are three linear numbers. A text such as `"#e8b04a"` is read as an sRGB colour.
//! - What has a default may be left out. No key stands twice in an object.
//! - `name` is a title, for messages and for what a picture says of itself. It names no file: pictures are called after the
//!   scene's file.
//! - Numbers are those of the scene: finite, and in the ranges that the language allows. A scene that has others (one that
//!   a program made) cannot be written, and [`expand`] says which number it is.

pub(crate) mod formula;
pub(crate) mod locate;
mod parse;
mod read;
pub(crate) mod valid;
mod write;

pub use write::{ExpandError, expand, to_text};

pub(crate) use read::read;

use crate::naming::shortened;
use crate::report::{Place, Report, Source};
use zeroset_catalogue::Unit;

/// The key that says what the file is.
const NAME: &str = "zeroset";
/// The version of the format.
const VERSION: u64 = 1;

/// A step from a JSON value to a member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum JsonStep {
    Key(String),
    Index(usize),
}

/// What is wrong in a JSON scene, and where.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    message: String,
    help: Option<String>,
    path: Vec<JsonStep>,
}

/// Characters of a key, and of a path of keys, in a message.
const KEY: usize = 60;
const PATH: usize = 240;

pub(crate) type Read<T> = Result<T, Box<Problem>>;

fn problem(message: impl Into<String>) -> Box<Problem> {
    Box::new(Problem {
        message: message.into(),
        help: None,
        path: Vec::new(),
    })
}

impl Problem {
    fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }

    fn maybe_help(mut self: Box<Self>, help: Option<String>) -> Box<Self> {
        self.help = self.help.or(help);
        self
    }

    /// Inside of a member.
    fn within(mut self: Box<Self>, step: JsonStep) -> Box<Self> {
        self.path.insert(0, step);
        self
    }

    /// Inside of a member of an object.
    fn at(self: Box<Self>, key: &str) -> Box<Self> {
        self.within(JsonStep::Key(key.to_string()))
    }

    /// What is wrong, and of what.
    pub(crate) fn message(&self) -> String {
        let mut path = String::new();
        for step in &self.path {
            match step {
                JsonStep::Key(key) => {
                    let dot = if path.is_empty() { "" } else { "." };
                    path += &format!("{dot}{}", shortened(key, KEY));
                }
                JsonStep::Index(i) => path += &format!("[{i}]"),
            }
        }
        if path.is_empty() {
            self.message.clone()
        } else {
            format!("{}: {}", shortened(&path, PATH), self.message)
        }
    }

    /// For a person.
    fn report(self, source: &Source) -> Report {
        let range = locate::locate(&source.text, &self.path);
        let message = self.message();
        let place = Place {
            file: 0,
            start: range.start as u32,
            end: range.end as u32,
        };
        let report = Report::new(message).at(source, place);
        match self.help {
            Some(help) => report.with_help(help),
            None => report,
        }
    }
}

/// Whether a parameter is an angle, or an angle per length.
fn is_angle(unit: Unit) -> bool {
    matches!(unit, Unit::Angle | Unit::Rate)
}

/// The name of a parameter that stands in radians.
fn angle_name(name: &str) -> String {
    format!("{name}_radians")
}
