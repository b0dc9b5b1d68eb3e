//! The window of Zeroset.
//!
//! What the window is about is apart from how it is drawn, so that all of it is tested without a screen:
//!
//! | module | holds |
//! | --- | --- |
//! | [`session`] | the scene, the camera, the methods, the time: what every control changes |
//! | [`rig`] | the camera and what a hand does to it |
//! | [`ladder`] | which pictures are made, from a coarse one to a refined one |
//! | [`engine`] | the thread that renders them |
//! | [`converge`] | pictures that go on until there is little noise |
//! | [`loader`] | the thread that loads the scene, and again on every save |
//! | [`clock`] | the time of an animation |
//! | [`pace`] | how many pictures there are a second |
//! | [`preset`] | methods that go together |
//! | [`save`](mod@save), [`movie`] | pictures and animations as files |
//! | [`slice`](mod@slice), [`pick`] | a plane through the field; what is under the cursor |
//! | [`app`] | the window itself |
//!
//! ```
//! use zeroset_scene::camera::Camera;
//! use zeroset_viewer::rig::Rig;
//!
//! // a hand turns the camera around what it looks at: half a turn to the left shows the other side
//! let mut rig = Rig::new(&Camera::default(), None);
//! rig.orbit(std::f64::consts::PI, 0.0);
//! assert!((rig.camera().eye.z + 5.0).abs() < 1e-4);
//! ```

pub mod app;
pub mod clock;
pub mod converge;
mod develop;
pub mod engine;
pub mod ladder;
mod launch;
pub mod loader;
pub mod movie;
mod overlay;
pub mod pace;
pub mod panel;
pub mod pick;
pub mod preset;
pub mod rig;
pub mod save;
pub mod session;
pub mod slice;
mod stage;
mod style;
mod widget;

pub use launch::{Open, OpenError, open};
