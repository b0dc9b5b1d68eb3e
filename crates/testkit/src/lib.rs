//! What Zeroset's tests share; its own tests are the suites that hold the renderers together: the conformance suite, values
//! known from mathematics, golden pictures, a search for phantom surfaces.
//!
//! No product crate depends on this one.
//!
//! ```
//! use zeroset_testkit::scenes;
//!
//! // every scene of the repository, for tests that hold for all of them
//! assert!(scenes::all().iter().any(|path| scenes::name(path).ends_with("hello")));
//! ```

pub mod conform;
pub mod plain;
pub mod scenes;
pub mod wgsl;
