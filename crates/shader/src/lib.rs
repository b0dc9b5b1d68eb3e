//! Shaders of Zeroset: WGSL and GLSL for any scene. Nothing here needs a GPU.
//!
//! A module is put together from the recorded field ([`zeroset_field`]), the recorded formulas and the constants of
//! [`zeroset_shade`], the stage files in `stage/` (what marches, named like its twin of the CPU renderer, and what reads
//! buffers) and structs that are declared once, in [`layout`].
//!
//! ```
//! use zeroset_field::shape::sphere;
//! use zeroset_scene::material::Material;
//! use zeroset_scene::scene::{Object, SceneParts};
//! use zeroset_shader::export;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let parts = SceneParts {
//!     name: "ball".into(),
//!     objects: vec![Object::new("ball", sphere(1.0).field()?)],
//!     materials: vec![Material::default()],
//!     ..SceneParts::default()
//! };
//! let text = export::wgsl(&parts.build()?)?;
//! assert!(text.starts_with("// ball: a signed distance field"));
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod constants;
pub mod entry;
pub mod export;
mod field;
mod fold;
mod formulas;
pub mod job;
pub mod layout;
mod motion;
mod source;
pub mod texture;

pub use field::{FieldSource, recorded};
pub use job::{FieldForm, Job, Shaders, Turns};
