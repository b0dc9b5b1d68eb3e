//! View, light and materials: every formula of a picture that does not march, written once over [`zeroset_number::Real`].
//!
//! The CPU renderer runs them over lanes, the shaders record them as WGSL, tests run them over `f32` and `f64`. A formula takes
//! numbers (which differ from ray to ray), parameters of the scene ([`zeroset_number::Real::Scalar`]) and constants, which are
//! public here: whatever marches is written twice, with the same constants.
//!
//! Everything is `#[inline(always)]`, closures too: what is compiled on its own has no vector instructions.
//!
//! ```
//! use zeroset_number::Vec3;
//! use zeroset_scene::camera::Camera;
//! use zeroset_shade::view::View;
//!
//! // the camera stands at (0, 0, 5) and looks along -z; the ray through the middle of the picture does too
//! let view = View::new(&Camera::default(), [64, 48], 0.5);
//! let (origin, direction): (Vec3<f32>, Vec3<f32>) = view.split(view.ray(32.0, 24.0));
//! assert_eq!(origin.array(), [0.0, 0.0, 5.0]);
//! assert_eq!(direction.array(), [0.0, 0.0, -1.0]);
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod advection;
pub mod air;
pub mod bsdf;
pub mod closed;
pub mod coat;
pub mod coverage;
pub mod environment;
pub mod lamp;
pub mod light;
pub mod march;
pub mod microfacet;
pub mod normal;
pub mod occlusion;
pub mod pattern;
mod preetham;
pub mod sampling;
pub mod secondary;
pub mod shadow;
pub mod skin;
pub mod sky;
pub mod skylight;
pub mod surface;
pub mod tone;
pub mod view;

use zeroset_number::{Vec3, v3};

/// The vector of `f(0)`, `f(1)` and `f(2)`.
#[inline(always)]
fn each<R>(f: impl Fn(usize) -> R) -> Vec3<R> {
    v3(f(0), f(1), f(2))
}

/// A vector of a scene as parameters.
#[inline(always)]
pub fn parameters(v: glam::Vec3) -> Vec3<f32> {
    v3(v.x, v.y, v.z)
}
