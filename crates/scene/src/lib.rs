//! Scenes: what a renderer gets. Valid by construction: finite numbers, resolved references, checked limits.

mod budget;
pub mod camera;
pub mod colour;
mod draft;
mod files;
pub mod film;
pub mod framing;
mod images;
pub mod json;
pub mod language;
pub mod light;
pub mod limits;
mod lines;
pub mod load;
pub mod material;
pub mod naming;
pub mod render;
pub mod report;
pub mod scene;
pub mod settings;
pub mod skin;
mod trees;
pub mod view;
pub mod watch;
