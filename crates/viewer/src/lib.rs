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
//! | [`loader`] | the thread that loads the scene, and again on every save |
//! | [`clock`] | the time of an animation |
//! | [`slice`](mod@slice), [`pick`] | a plane through the field; what is under the cursor |
//! | [`app`] | the window itself |

pub mod app;
pub mod clock;
mod develop;
pub mod engine;
pub mod ladder;
mod launch;
pub mod loader;
pub mod panel;
pub mod pick;
pub mod rig;
mod save;
pub mod session;
pub mod slice;
mod stage;
mod style;
mod widget;

pub use launch::{Open, OpenError, open};
