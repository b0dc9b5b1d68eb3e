//! Scenes: what a renderer gets, what it gives, and what a renderer is. Valid by construction: finite numbers, resolved
//! references.

pub mod accumulator;
pub mod camera;
pub mod colour;
pub mod fallback;
pub mod film;
pub mod light;
pub mod material;
pub mod methods;
pub mod render;
pub mod scene;
pub mod settings;
pub mod valid;
