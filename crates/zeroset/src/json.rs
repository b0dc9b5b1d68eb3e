//! JSON on standard output.

use crate::failure::{Exit, Failure};
use serde::Serialize;

/// On one line.
pub(crate) fn line(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string(value).map_err(failed)
}

/// Indented.
pub(crate) fn pretty(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map_err(failed)
}

fn failed(error: serde_json::Error) -> Failure {
    Failure::new(Exit::Job, format!("cannot be written as JSON: {error}"))
}
