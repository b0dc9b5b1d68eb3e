//! What Zeroset puts out: the only crate that writes files.
//!
//! - [`display`]: texts of strangers, fit to be shown;
//! - [`atomic`]: files that appear whole or not at all;
//! - [`picture`] and [`tone`]: from a film's linear light to what a screen shows;
//! - [`format`](mod@format): PNG and OpenEXR;
//! - [`view`]: every plane of a film as a picture;
//! - [`compare`]: how different two pictures are.

pub mod atomic;
pub mod compare;
pub mod display;
pub mod format;
pub mod picture;
pub mod tone;
pub mod view;
