//! The panels: each changes the session, and nothing else.

mod camera;
mod comparison;
mod error;
mod help;
mod legend;
mod log;
mod methods;
mod objects;
mod parameters;
mod picked;
mod slice;
mod stage;
mod status;
mod timeline;

pub use camera::camera;
pub use comparison::comparison;
pub(crate) use comparison::set_comparison;
pub use error::error;
pub use help::{KEYS, help};
pub use legend::legend;
pub use log::log;
pub use methods::{methods, presets, view};
pub use objects::objects;
pub use parameters::parameters;
pub(crate) use picked::card;
pub use picked::picked;
pub use slice::slice;
pub(crate) use stage::SunPlace;
pub use stage::{material, sky, sun};
pub use status::status;
pub use timeline::timeline;
