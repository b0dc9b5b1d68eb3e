//! Scene files: the Starlark language, its twin in JSON, loading, limits, reports with source spans, watching.

mod budget;
pub mod colour;
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
