//! For tests of this and other crates.

use crate::adapter::Choice;
use crate::blocking::GpuRenderer;
pub use crate::fault::Faults;

/// A renderer on any adapter, software included. Where there is none, says so and gives none, unless the environment has
/// `ZEROSET_REQUIRE_GPU=1`.
///
/// # Panics
/// There is no adapter although the environment requires one.
#[must_use]
pub fn renderer(test: &str) -> Option<GpuRenderer> {
    with_faults(test, Faults::default())
}

/// As [`renderer`], with faults.
///
/// # Panics
/// As [`renderer`].
#[must_use]
pub fn with_faults(test: &str, faults: Faults) -> Option<GpuRenderer> {
    match GpuRenderer::with_faults(&Choice::Any, faults) {
        Ok(renderer) => Some(renderer),
        Err(error) => {
            let required = std::env::var("ZEROSET_REQUIRE_GPU").is_ok_and(|v| v == "1");
            assert!(!required, "{test} needs a GPU: {error}");
            println!("{test} did not run: {error}");
            None
        }
    }
}
