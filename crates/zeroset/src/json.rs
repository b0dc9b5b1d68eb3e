//! JSON on standard output.

use crate::failure::{Exit, Failure};
use serde::Serialize;
use zeroset_output::display;

/// On one line.
pub(crate) fn line(value: &impl Serialize) -> Result<String, Failure> {
    escaped(serde_json::to_string(value))
}

/// Indented.
pub(crate) fn pretty(value: &impl Serialize) -> Result<String, Failure> {
    escaped(serde_json::to_string_pretty(value))
}

/// With all that a terminal would obey as escapes.
fn escaped(written: serde_json::Result<String>) -> Result<String, Failure> {
    match written {
        Ok(text) => Ok(display::json(&text).into_owned()),
        Err(error) => Err(Failure::new(
            Exit::Job,
            format!("cannot be written as JSON: {error}"),
        )),
    }
}
