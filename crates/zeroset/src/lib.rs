//! Zeroset renders signed distance fields: this crate is its command line, and one name for all of it as a library.
//!
//! | module | holds |
//! | --- | --- |
//! | [`field`] | numbers, the catalogue of fields, field trees, programs |
//! | [`scene`] | scenes and the language they are written in |
//! | [`trace`] | the renderer on the CPU |
//! | [`output`] | pictures and files |
//! | [`section`] | fields on a plane |

pub mod section;

pub use zeroset_field as field;
pub use zeroset_output as output;
pub use zeroset_scene as scene;
pub use zeroset_trace as trace;
