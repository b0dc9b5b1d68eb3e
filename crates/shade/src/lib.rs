//! What is seen and how it looks: formulas of rays and light, each written once over any number type.
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

pub mod skin;
pub mod view;
