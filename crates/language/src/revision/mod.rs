//! Values written back: what was changed from outside, put into the text of a scene file.
//!
//! Only the spans of values that changed are replaced; comments, formatting and everything else stay as they are, byte for byte.
//! A value that is no literal (`slider("r", 2 * base)`), that stands in another file, or that no one place of the file makes,
//! is left, and why is said. [`revise`] is the change of the text alone, [`revise_file`] reads a file and holds the new text against
//! what is wanted: it is loaded, and what is not then exactly as asked is left too.
//!
//! ```
//! use zeroset_language::load::{Language, Options, load_text};
//! use zeroset_language::revision::{Change, revise};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = "bite = slider(\"bite\", 0.2, 0, 1)  # how deep\nshow(sphere(1) - sphere(bite).move(x = 1))\n";
//! let mut options = Options::default();
//! options.set.insert("bite".into(), "0.7".into());
//! let loaded = load_text("apple.star", text, Language::Starlark, None, &options)?;
//! let changes = Change::of_parameters(&loaded);
//! let revision = revise("apple.star", text, Language::Starlark, &loaded, &changes)?;
//! assert_eq!(revision.text, text.replace("0.2", "0.7"));
//! assert!(revision.left.is_empty());
//! # Ok(())
//! # }
//! ```

mod data;
mod plan;
mod script;
mod verify;

pub use verify::{Revised, revise_file};

use crate::load::{Failed, Language, Loaded, Setting};
use glam::Vec3;
use std::fmt;
use std::ops::Range;
use zeroset_scene::camera::Camera;
use zeroset_scene::colour::linear;
use zeroset_scene::light::{Sky, Source};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::scene::SceneParts;

/// A value that is to stand in the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// What a slider, choice, toggle or colour is at first.
    Parameter {
        /// Its name.
        name: String,
        /// What it is.
        setting: Setting,
    },
    /// Where the scene is seen from, and through what lens.
    Camera {
        /// The camera.
        camera: Camera,
        /// A point that it looks at.
        target: Vec3,
    },
    /// A directional light.
    Sun {
        /// Which of the scene's lights.
        light: usize,
        /// The way its light travels; of length 1.
        direction: Vec3,
        /// Linear colour times intensity.
        radiance: Vec3,
    },
    /// The colours of the sky, and how much of its light reaches surfaces. All else of it stays.
    Sky {
        /// Linear colour straight up.
        top: Vec3,
        /// Linear colour at the horizon.
        horizon: Vec3,
        /// Linear colour straight down.
        bottom: Vec3,
        /// Share of its light that reaches an unoccluded surface, 0 to 10.
        ambient: f32,
    },
    /// A material, of all objects that have it.
    Material {
        /// Which of the scene's materials.
        material: usize,
        /// What it is to be.
        look: Look,
    },
}

/// What of a material is changed from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Look {
    /// Its colour, sRGB, 0 to 1.
    pub colour: Option<[f64; 3]>,
    /// 0 mirror to 1 chalk.
    pub roughness: Option<f32>,
    /// 0 plastic or stone, 1 metal.
    pub metallic: Option<f32>,
    /// Strength of the highlight, 0 to 10.
    pub specular: Option<f32>,
}

impl Look {
    /// Puts it into a material.
    pub fn apply(&self, material: &mut Material) {
        if let Some(srgb) = self.colour {
            material.pattern = Pattern::Solid {
                colour: linear(srgb),
            };
        }
        if let Some(roughness) = self.roughness {
            material.roughness = roughness;
            material.shininess = crate::starlark::shininess_of(roughness);
        }
        if let Some(metallic) = self.metallic {
            material.metallic = metallic;
        }
        if let Some(specular) = self.specular {
            material.specular = specular;
        }
    }
}

impl Change {
    /// The parameters of a scene that are not what its file says.
    pub fn of_parameters(loaded: &Loaded) -> Vec<Change> {
        let moved = loaded.parameters.iter().filter(|p| p.value != p.default);
        moved
            .map(|p| Change::Parameter {
                name: p.name.clone(),
                setting: p.value.clone(),
            })
            .collect()
    }

    /// Makes the change in a scene, as far as it is no parameter of its file.
    pub fn apply(&self, parts: &mut SceneParts) {
        match self {
            Change::Parameter { .. } => {}
            Change::Camera { camera, .. } => parts.camera = *camera,
            Change::Sun {
                light,
                direction: way,
                radiance,
            } => {
                if let Some(light) = parts.lights.get_mut(*light)
                    && let Source::Directional { direction } = &mut light.source
                {
                    *direction = *way;
                    light.radiance = *radiance;
                }
            }
            Change::Sky {
                top,
                horizon,
                bottom,
                ambient,
            } => {
                parts.sky = Sky {
                    top: *top,
                    horizon: *horizon,
                    bottom: *bottom,
                    ambient: *ambient,
                    ..parts.sky
                };
            }
            Change::Material { material, look } => {
                if let Some(material) = parts.materials.get_mut(*material) {
                    look.apply(material);
                }
            }
        }
    }

    /// What it is called where it is reported.
    fn subject(&self, loaded: &Loaded) -> String {
        match self {
            Change::Parameter { name, .. } => format!("`{name}`"),
            Change::Camera { .. } => "the camera".into(),
            Change::Sun { .. } => "the sun".into(),
            Change::Sky { .. } => "the sky".into(),
            Change::Material { material, .. } => {
                let has = |o: &&zeroset_scene::scene::Object| usize::from(o.material) == *material;
                let of = loaded.scene.objects().iter().find(has);
                of.map_or("a material".into(), |o| {
                    format!("the material of object {}", o.name)
                })
            }
        }
    }
}

/// Why a value is not written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Reason {
    /// What makes it is an expression.
    #[error("{what} is no literal but an expression{}", on(*.line))]
    Expression {
        /// The argument.
        what: String,
        /// Its line, 1-based.
        line: usize,
    },
    /// It is declared in a file that is loaded.
    #[error("it stands in {0}, which this file loads")]
    OtherFile(String),
    /// The call that makes it is not to be found, such as one by another name.
    #[error("no call of {0}() with literal arguments makes it")]
    NotFound(&'static str),
    /// More than one call may make it.
    #[error("{count} calls of {function}() may make it{}", on(*.line))]
    Many {
        /// The function.
        function: &'static str,
        /// How many.
        count: usize,
        /// The line of the first, 1-based.
        line: usize,
    },
    /// The call is in a function or a loop.
    #[error("{function}() is called in a loop or a function{}", on(*.line))]
    Repeated {
        /// The function.
        function: &'static str,
        /// Its line, 1-based.
        line: usize,
    },
    /// Arguments come from a list or a dict.
    #[error("arguments of {function}() come from `*` or `**`{}", on(*.line))]
    Spread {
        /// The function.
        function: &'static str,
        /// Its line, 1-based.
        line: usize,
    },
    /// A scene that says nothing but what is shown gets lights and a floor, and stating this would take them away.
    #[error(
        "this scene has the lights and the floor of scenes that say nothing but what is shown; to state it would take them away"
    )]
    Stage,
    /// The file does not load with it, or does not make the scene that is wanted.
    #[error("with it in the file, {0}")]
    Refused(String),
    /// This kind of file has no such thing.
    #[error("a JSON scene has none to write")]
    NotInJson,
}

fn on(line: usize) -> String {
    format!(" (line {line})")
}

/// A change that is not in the new text.
#[derive(Clone, Debug, PartialEq)]
pub struct Left {
    /// Which.
    pub change: Change,
    /// What it is called.
    pub subject: String,
    /// Why.
    pub reason: Reason,
}

impl fmt::Display for Left {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.subject, self.reason)
    }
}

/// A scene's text with values written into it.
#[derive(Clone, Debug, PartialEq)]
pub struct Revision {
    /// The new text.
    pub text: String,
    /// What is in it, as it is called.
    pub written: Vec<String>,
    /// What is not.
    pub left: Vec<Left>,
}

/// Puts values into the text of a scene file. `loaded` is what the text makes, with the parameters set as they are wanted.
/// Nothing is read and the new text is not loaded: see [`revise_file`].
///
/// # Errors
/// The text cannot be parsed.
pub fn revise(
    name: &str,
    text: &str,
    language: Language,
    loaded: &Loaded,
    changes: &[Change],
) -> Result<Revision, Failed> {
    let (mark, body) = match text.strip_prefix('\u{feff}') {
        Some(body) => ("\u{feff}", body),
        None => ("", text),
    };
    let mut edits = Edits::new(body);
    let (mut written, mut left) = (Vec::new(), Vec::new());
    let mut record = |change: &Change, result: Result<(), Reason>| {
        let subject = change.subject(loaded);
        match result {
            Ok(()) => written.push(subject),
            Err(reason) => left.push(Left {
                change: change.clone(),
                subject,
                reason,
            }),
        }
    };
    match language {
        Language::Starlark => {
            script::revise(name, body, loaded, changes, &mut edits, &mut record)?;
        }
        Language::Json => data::revise(body, loaded, changes, &mut edits, &mut record),
    }
    Ok(Revision {
        text: format!("{mark}{}", edits.apply()),
        written,
        left,
    })
}

/// Replacements in a text.
struct Edits<'t> {
    text: &'t str,
    /// What is replaced, and by what; spans do not overlap.
    all: Vec<(Range<usize>, String)>,
}

impl<'t> Edits<'t> {
    fn new(text: &'t str) -> Edits<'t> {
        Edits {
            text,
            all: Vec::new(),
        }
    }

    /// Replaces a span. What is asked twice is done once.
    fn replace(&mut self, span: Range<usize>, by: String) {
        let edit = (span, by);
        if !self.all.contains(&edit) {
            self.all.push(edit);
        }
    }

    /// Puts something in front of a byte; after what was put there before.
    fn insert(&mut self, at: usize, what: String) {
        self.replace(at..at, what);
    }

    /// How far there are edits now, to go back to.
    fn mark(&self) -> usize {
        self.all.len()
    }

    /// Forgets all edits since then.
    fn back_to(&mut self, mark: usize) {
        self.all.truncate(mark);
    }

    fn apply(mut self) -> String {
        // stable: insertions at one place keep their order
        self.all.sort_by_key(|(span, _)| (span.start, span.end));
        let (mut out, mut at) = (String::with_capacity(self.text.len() + 64), 0);
        for (span, by) in &self.all {
            out += self.text.get(at..span.start).unwrap_or_default();
            out += by;
            at = span.end.max(at);
        }
        out + self.text.get(at..).unwrap_or_default()
    }
}
