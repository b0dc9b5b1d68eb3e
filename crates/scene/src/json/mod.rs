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
//! - What has a default may be left out.

mod formula;
mod locate;
mod read;
mod valid;
mod write;

pub use write::{expand, to_text};

pub(crate) use read::read;

use crate::report::{Place, Report, Source};
use zeroset_field::catalogue::Unit;

/// The key that says what the file is.
const NAME: &str = "zeroset";
/// The version of the format.
const VERSION: u64 = 1;

/// A step from a JSON value to a member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    Key(String),
    Index(usize),
}

/// What is wrong in a JSON scene, and where.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    message: String,
    help: Option<String>,
    path: Vec<Step>,
}

type Read<T> = Result<T, Box<Problem>>;

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
    fn within(mut self: Box<Self>, step: Step) -> Box<Self> {
        self.path.insert(0, step);
        self
    }

    /// Inside of a member of an object.
    fn at(self: Box<Self>, key: &str) -> Box<Self> {
        self.within(Step::Key(key.to_string()))
    }

    /// For a person.
    fn report(self, source: &Source) -> Report {
        let range = locate::locate(&source.text, &self.path);
        let mut path = String::new();
        for step in &self.path {
            match step {
                Step::Key(key) if path.is_empty() => path += key,
                Step::Key(key) => path += &format!(".{key}"),
                Step::Index(i) => path += &format!("[{i}]"),
            }
        }
        let message = if path.is_empty() {
            self.message
        } else {
            format!("{path}: {}", self.message)
        };
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
