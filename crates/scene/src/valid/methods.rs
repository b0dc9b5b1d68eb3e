//! What the numbers of methods may be: what their registry says.

use super::{Checked, Fault, SAMPLES, SceneError};
use crate::methods::{Choice, Param, Value};
use crate::settings::{Antialias, Integrator, March, Occlusion, Shadow};

/// Whether a marcher's numbers are in their ranges.
///
/// # Errors
/// Which number is wrong.
pub fn march(march: &March) -> Checked {
    method(march, SAMPLES)
}

/// Whether a shadow's numbers are in their ranges.
///
/// # Errors
/// Which number is wrong.
pub fn shadow(shadow: &Shadow) -> Checked {
    method(shadow, SAMPLES)
}

/// Whether an occlusion's numbers are in their ranges, with `samples` rays or steps at most, and [`SAMPLES`].
///
/// # Errors
/// Which number is wrong.
pub fn occlusion(occlusion: &Occlusion, samples: u32) -> Checked {
    method(occlusion, samples.min(SAMPLES))
}

/// Whether antialiasing's numbers are in their ranges, with `samples` rays at most, and [`SAMPLES`].
///
/// # Errors
/// Which number is wrong.
pub fn antialias(antialias: &Antialias, samples: u32) -> Checked {
    method(antialias, samples.min(SAMPLES))
}

/// Whether an integrator's numbers are in their ranges.
///
/// # Errors
/// Which number is wrong.
pub fn integrator(integrator: &Integrator) -> Checked {
    method(integrator, SAMPLES)
}

fn method<T: Choice>(chosen: &T, samples: u32) -> Checked {
    (chosen.check(samples.into()))
        .map_err(|(param, refused)| SceneError::new(Fault::Method(refused)).at(param))
}

/// Whether a number of the settings is what is allowed.
pub(super) fn setting(param: Param, value: Value) -> Checked {
    (param.check(value)).map_err(|refused| SceneError::new(Fault::Method(refused)).at(param.name))
}
