//! What Zeroset's tests share; its own tests are the suites that hold the renderers together: the conformance suite, values
//! known from mathematics, golden pictures, a search for phantom surfaces.
//!
//! No product crate depends on this one.

pub mod conform;
pub mod plain;
pub mod scenes;
pub mod wgsl;
