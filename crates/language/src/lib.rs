//! Scene files: the Starlark language, its twin in JSON, loading, limits, reports with source spans, watching.
//!
//! ```
//! use zeroset_language::json::{expand, to_text};
//! use zeroset_language::load::{Language, Options, load_text};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = "r = slider(\"radius\", 0.8, min = 0.1, max = 2)\nshow(sphere(r) - box(1).move(x = 0.6))";
//! let mut options = Options::default();
//! options.set.insert("radius".into(), "1.5".into());
//! let loaded = load_text("ball.star", text, Language::Starlark, None, &options)?;
//! assert_eq!(loaded.parameters[0].name, "radius");
//! assert_eq!(loaded.scene.objects()[0].field.facts().bounds.max, [1.5; 3]);
//!
//! // everything that a scene is, as data: it can be loaded again
//! let json = to_text(&expand(&loaded.scene)?);
//! let again = load_text("ball.json", &json, Language::Json, None, &Options::default())?;
//! assert_eq!(again.scene.settings(), loaded.scene.settings());
//!
//! // what is wrong is said with its place and what can be done
//! let failed = load_text("ball.star", "show(spere(1))", Language::Starlark, None, &Options::default());
//! assert!(failed.unwrap_err().report.message().contains("spere"));
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod assets;
mod budget;
pub mod colour;
pub mod document;
mod draft;
pub mod files;
#[allow(clippy::disallowed_methods, reason = "the room that reads files")]
pub mod folder;
pub mod framing;
mod images;
pub mod json;
pub mod limits;
mod lines;
pub mod load;
pub mod naming;
mod radiance;
pub mod registers;
pub mod report;
#[allow(
    clippy::disallowed_methods,
    reason = "reads the file that is to be written again"
)]
pub mod revision;
mod sampled;
pub mod starlark;
mod trees;
#[allow(
    clippy::disallowed_methods,
    reason = "files that change, and waiting for them"
)]
pub mod watch;
mod welcome;
