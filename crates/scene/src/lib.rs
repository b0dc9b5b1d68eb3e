//! Scenes: what a renderer gets. Valid by construction: finite numbers, resolved references, checked limits.

pub mod camera;
pub mod film;
pub mod light;
pub mod material;
pub mod render;
pub mod scene;
pub mod settings;
