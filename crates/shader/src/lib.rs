//! Shaders of Zeroset: WGSL and GLSL for any scene. Nothing here needs a GPU.
//!
//! A module is put together from the recorded field ([`zeroset_field`]), the recorded formulas and the constants of
//! [`zeroset_shade`], the stage files in `stage/` (what marches, named like its twin of the CPU renderer, and what reads
//! buffers) and structs that are declared once, in [`layout`].

mod constants;
pub mod entry;
pub mod export;
mod field;
mod formulas;
pub mod job;
pub mod layout;
mod source;

pub use field::{FieldSource, recorded};
pub use job::{FieldForm, Job, Shaders, Turns};
