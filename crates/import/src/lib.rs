//! Scenes from models of others.
//!
//! [`import`] makes the text of a scene (Starlark) from a file: GLSL as it is written for Shadertoy (with the feature `glsl`), the JSON of
//! Lipschitz pruning (Barbier et al. 2025), or a register list of MPR and Fidget (`.vm`). What the scene shows is measured before it is
//! written: the box that the surface lies in, how steep the field is, which materials there are.
//!
//! ```
//! use zeroset_import::{Kind, Request, import};
//!
//! # fn main() -> Result<(), zeroset_import::ImportError> {
//! let ball = "x var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\nd add a b\ne add d c\nr sqrt e\none const 0.5\nout sub r one";
//! let request = Request { name: "ball.vm", title: "ball", function: None };
//! let scene = import(ball, Kind::Registers, &request)?;
//! assert!(scene.text.contains("load_vm(\"ball.vm\")"));
//! # Ok(())
//! # }
//! ```

#[cfg(feature = "glsl")]
pub mod glsl;
mod measure;
mod pruning;
mod registers;
#[cfg(feature = "glsl")]
mod shader;

use std::ops::Range;

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// GLSL with a function that gives the distance at a point.
    Glsl,
    /// A tree of shapes, as JSON.
    Tree,
    /// A list of operations, `.vm`.
    Registers,
}

impl Kind {
    /// What a file with this ending is.
    pub fn of_ending(ending: &str) -> Option<Kind> {
        Some(match ending.to_ascii_lowercase().as_str() {
            "glsl" | "frag" | "fs" | "fsh" | "shader" | "txt" => Kind::Glsl,
            "json" => Kind::Tree,
            "vm" => Kind::Registers,
            _ => return None,
        })
    }
}

/// What is wanted of a file.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The file's name as the scene will ask for it, which matters for register lists: relative to the scene's folder.
    pub name: &'a str,
    /// What the scene says it is from.
    pub title: &'a str,
    /// The function of a shader that gives the distance, if it has no usual name.
    pub function: Option<&'a str>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Its text.
    pub text: String,
    /// What a person should know of it.
    pub notes: Vec<String>,
}

/// Why a file gives no scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImportError {
    /// The shader cannot be translated.
    #[error("{message}")]
    Shader {
        /// What is wrong.
        message: String,
        /// What to do.
        help: Option<String>,
        /// The bytes of the file that it is about.
        place: Option<Range<usize>>,
    },
    /// The file is no JSON.
    #[error("{0}")]
    Json(String),
    /// The JSON is no tree of shapes.
    #[error("{}{message}", if path.is_empty() { String::new() } else { format!("{path}: ") })]
    Tree {
        /// The way to the node.
        path: String,
        /// What is wrong, and what is allowed.
        message: String,
    },
    /// The list of operations cannot be read.
    #[error("{0}")]
    Registers(#[from] zeroset_language::registers::RegistersError),
    /// What was written is no scene.
    #[error("what was made of it cannot be loaded: {message}")]
    Scene {
        /// Why.
        message: String,
        /// What to do.
        help: Option<String>,
    },
    /// This build reads no GLSL.
    #[error("this build reads no GLSL")]
    LeftOut,
}

impl From<serde_json::Error> for ImportError {
    fn from(error: serde_json::Error) -> Self {
        ImportError::Json(error.to_string())
    }
}

/// Makes a scene of a file's text.
///
/// # Errors
/// What cannot be read or translated.
pub fn import(text: &str, kind: Kind, request: &Request<'_>) -> Result<Imported, ImportError> {
    match kind {
        Kind::Tree => pruning::scene(text, &one_line(request.title)),
        Kind::Registers => registers::scene(text, request),
        #[cfg(feature = "glsl")]
        Kind::Glsl => shader::scene(text, request),
        #[cfg(not(feature = "glsl"))]
        Kind::Glsl => Err(ImportError::LeftOut),
    }
}

/// A text that stays in the line of a comment.
fn one_line(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .take(200)
        .collect()
}

/// A text as Starlark writes it.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out += "\\n",
            '\r' => out += "\\r",
            c => out.push(c),
        }
    }
    out + "\""
}
