//! What makes a picture again from its scene, kept in the picture: in a text chunk of a PNG, in an attribute of an OpenEXR file.
//!
//! It is JSON under the name [`KEY`], in ASCII alone, so that whatever passes a picture on passes it on as it is. The scene is not in it,
//! nor where it is: only a [digest](Recipe::files) of its files, which tells whether they changed since.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use zeroset_scene::camera::Camera;

use super::read::{ReadError, note};

/// The name that a recipe has among the notes of a picture.
pub const KEY: &str = "Recipe";
/// The version of the format.
pub const FORMAT: u32 = 1;

/// What makes a picture again from its scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// The version of the format, [`FORMAT`].
    pub format: u32,
    /// The version of Zeroset that made the picture.
    pub zeroset: String,
    /// A digest of the files that the scene was loaded from, in hexadecimal digits.
    pub files: String,
    /// Parameters that were set, each as text.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, String>,
    /// What time() was, seconds.
    pub time: f64,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Who looked.
    pub camera: Camera,
    /// What chose the random numbers.
    pub seed: u32,
    /// Rays a pixel, where they were not the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spp: Option<u32>,
    /// Methods in place of the scene's, by the options of the command line that choose them, and in its words.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub methods: BTreeMap<String, String>,
    /// The plane of the film that is shown, where it is not the colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub view: Option<String>,
    /// Whether the strip is left out that explains the colours of a view.
    #[serde(default, skip_serializing_if = "is_false")]
    pub no_legend: bool,
    /// Whether the background is left out.
    #[serde(default, skip_serializing_if = "is_false")]
    pub transparent: bool,
    /// Whether an OpenEXR file has mattes of the objects.
    #[serde(default, skip_serializing_if = "is_false")]
    pub cryptomatte: bool,
    /// Whether the noise was taken out.
    #[serde(default, skip_serializing_if = "is_false")]
    pub denoise: bool,
    /// Bits a channel, of a PNG that has not 8.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bits: Option<u8>,
    /// Whether the picture converged round by round.
    #[serde(default, skip_serializing_if = "is_false")]
    pub rounds: bool,
    /// The noise at which it ended then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// The GPU that rendered it; none for the CPU.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gpu: Option<String>,
    /// Whether a time limit ended it: no other picture is like it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub unfinished: bool,
}

fn is_false(x: &bool) -> bool {
    !x
}

/// Why a picture has no recipe to follow.
#[derive(Debug, thiserror::Error)]
pub enum RecipeError {
    /// The picture cannot be read.
    #[error(transparent)]
    Picture(#[from] ReadError),
    /// It says nothing of how it was made.
    #[error("it does not say how it was made")]
    Missing,
    /// The recipe is of a later format.
    #[error("its recipe has format {0}, and {FORMAT} is what this program reads")]
    Format(u64),
    /// The recipe is none.
    #[error("its recipe is damaged: {0}")]
    Damaged(String),
}

impl Recipe {
    /// As text, in ASCII without controls.
    ///
    /// # Errors
    /// A number that JSON does not have.
    pub fn to_text(&self) -> Result<String, RecipeError> {
        let written =
            serde_json::to_string(self).map_err(|e| RecipeError::Damaged(e.to_string()))?;
        let mut out = String::with_capacity(written.len());
        // all but ASCII is inside of strings
        for c in written.chars() {
            match c {
                ' '..='~' => out.push(c),
                _ => {
                    for unit in c.encode_utf16(&mut [0; 2]) {
                        let _ = write!(out, "\\u{unit:04x}");
                    }
                }
            }
        }
        Ok(out)
    }

    /// From the text of [`Recipe::to_text`].
    ///
    /// # Errors
    /// It is none, or of a later format.
    pub fn of_text(text: &str) -> Result<Recipe, RecipeError> {
        let damaged = |e: serde_json::Error| RecipeError::Damaged(e.to_string());
        let value: serde_json::Value = serde_json::from_str(text).map_err(damaged)?;
        match value.get("format").and_then(serde_json::Value::as_u64) {
            Some(format) if format != u64::from(FORMAT) => Err(RecipeError::Format(format)),
            // which names what is missing
            _ => serde_json::from_value(value).map_err(damaged),
        }
    }

    /// The recipe in a picture, PNG or OpenEXR.
    ///
    /// # Errors
    /// See [`RecipeError`].
    pub fn of_picture(path: &Path) -> Result<Recipe, RecipeError> {
        let text = note(path, KEY)?.ok_or(RecipeError::Missing)?;
        Recipe::of_text(&text)
    }
}
