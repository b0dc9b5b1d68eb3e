//! Scene files: the Starlark language, its twin in JSON, loading, limits, reports with source spans, watching.

pub mod assets;
mod budget;
pub mod colour;
pub mod document;
mod draft;
mod files;
pub mod framing;
mod images;
pub mod json;
pub mod limits;
mod lines;
pub mod load;
pub mod naming;
pub mod report;
pub mod starlark;
mod trees;
pub mod watch;
