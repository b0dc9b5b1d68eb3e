//! Loading: from a scene file, or its text, to a [`Scene`].

use crate::assets::Assets;
use crate::document::Document;
use crate::files::Files;
use crate::folder::Folder;
use crate::limits::Limits;
use crate::report::Report;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zeroset_scene::scene::Scene;

/// What is given beside the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Parameters by name, each as text.
    pub set: BTreeMap<String, String>,
    /// Seconds of the animation.
    pub time: f64,
    /// Width and height that replace the file's.
    pub size: Option<[u32; 2]>,
    /// What the scene may cost.
    pub limits: Limits,
    /// Whether the scene is wanted at all moments that its shutter is open ([`Scene::moments`]), else as it is at its time alone.
    pub moments: bool,
    /// Whether only what the file itself shows is wanted: a scene that says nothing but what is shown gets no stage.
    pub bare: bool,
    /// Whether the stage that such a scene gets has no floor: the thing stands alone.
    pub floorless: bool,
}

/// How long a camera's shutter is open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shutter {
    /// Seconds, from the scene's time on.
    pub seconds: f64,
    /// Moments of that time that pictures are made of.
    pub moments: u32,
}

/// A scene with what loading found out.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What can be changed from outside, in the order of the file.
    pub parameters: Vec<Parameter>,
    /// Whether the scene asked for the time.
    pub animated: bool,
    /// How long its camera's shutter is open.
    pub shutter: Shutter,
    /// Every file that was read, the scene's own first.
    pub files: Vec<PathBuf>,
    /// What the script printed, line by line.
    pub log: Vec<String>,
    /// What is not as it was meant, although the scene could be loaded.
    pub warnings: Vec<Report>,
}

/// A scene that could not be loaded. Boxed: it carries the file's text.
#[derive(Debug)]
pub struct Failed {
    /// Why.
    pub report: Box<Report>,
    /// Every file that was asked for, the scene's own first: when one of them changes, loading is worth another try.
    pub files: Vec<PathBuf>,
}

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.report.fmt(f)
    }
}

impl std::error::Error for Failed {}

/// Something that can be changed from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// How it is changed.
    pub control: Control,
    /// What it is.
    pub value: Setting,
    /// What it is when nobody changes it.
    pub default: Setting,
    /// Where it is declared: (file, line, column), 1-based.
    pub place: Option<(String, u32, u32)>,
}

/// How a parameter is changed.
#[derive(Clone, Debug, PartialEq)]
pub enum Control {
    /// A number in a range.
    Slider {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// One of several words.
    Choice {
        /// The words.
        options: Vec<String>,
    },
    /// On or off.
    Toggle,
    /// A colour.
    Colour,
}

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Of a slider.
    Number(f64),
    /// Of a choice.
    Text(String),
    /// Of a toggle.
    Flag(bool),
    /// Of a colour: sRGB, 0 to 1.
    Colour([f64; 3]),
}

/// The language of a scene's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Starlark, `.star`.
    Starlark,
    /// Its twin in JSON, `.json`.
    Json,
}

/// Loads a scene file. Files that it loads lie in its own folder. A scene that is to be loaded more than once, for other
/// parameters or times, is a [`Document`].
///
/// # Errors
/// Everything that can be wrong with it, with the place and what to do.
pub fn load(path: &Path, options: &Options) -> Result<Loaded, Failed> {
    Document::open(path, &options.limits, &Assets::default())?.scene(options)
}

/// Loads a scene from its text. `root` is the folder that it may load files from, if any.
///
/// # Errors
/// Everything that can be wrong with it, with the place and what to do.
pub fn load_text(
    name: &str,
    text: &str,
    language: Language,
    root: Option<&Path>,
    options: &Options,
) -> Result<Loaded, Failed> {
    let (limits, assets) = (&options.limits, Assets::default());
    let files = root.map(|root| Arc::new(Folder::new(root)) as Arc<dyn Files>);
    Document::of_text(name, text, language, files, limits, &assets)?.scene(options)
}
