//! What Zeroset puts out: the only crate that writes files.
//!
//! - [`display`]: texts of strangers, fit to be shown;
//! - [`atomic`]: files that appear whole or not at all;
//! - [`picture`] and [`tone`]: from a film's linear light to what a screen shows;
//! - [`format`](mod@format): PNG and OpenEXR, with what makes a picture again in them;
//! - [`view`]: every plane of a film as a picture;
//! - [`cryptomatte`]: how much of each pixel belongs to which object;
//! - [`denoise`]: pictures without the noise of what was sampled at random;
//! - [`compare`]: how different two pictures are.
//!
//! ```
//! use zeroset_output::format::{Metadata, png};
//! use zeroset_output::picture::Picture;
//!
//! // sRGB-coded colours, 0 to 1, from column and row
//! let picture = Picture::from_fn(16, 8, |x, y| [x as f32 / 15.0, y as f32 / 7.0, 0.5]);
//! let mut bytes = Vec::new();
//! png::write(&mut bytes, &picture, png::Depth::Eight, &Metadata::new("colours"))?;
//! assert!(bytes.starts_with(b"\x89PNG"));
//! # Ok::<(), std::io::Error>(())
//! ```

pub mod atomic;
pub mod compare;
pub mod cryptomatte;
pub mod denoise;
pub mod display;
pub mod format;
pub mod picture;
pub mod tone;
pub mod view;
