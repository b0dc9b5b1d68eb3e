//! Scenes: what a renderer gets. Valid by construction: finite numbers, resolved references, checked limits.

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
pub mod load;
pub mod material;
pub mod naming;
pub mod render;
pub mod report;
pub mod scene;
pub mod settings;
pub mod view;
pub mod watch;
