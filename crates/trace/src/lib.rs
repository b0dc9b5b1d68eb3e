//! The CPU renderer: sphere tracing in SIMD streams.
//!
//! ```
//! use zeroset_field::shape::sphere;
//! use zeroset_scene::film::Plane;
//! use zeroset_scene::material::Material;
//! use zeroset_scene::render::{Renderer, Silent};
//! use zeroset_scene::scene::{Object, SceneParts};
//! use zeroset_trace::CpuRenderer;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let parts = SceneParts {
//!     objects: vec![Object::new("ball", sphere(1.0).field()?)],
//!     materials: vec![Material::default()],
//!     ..SceneParts::default() // the camera stands at (0, 0, 5)
//! };
//! let scene = parts.build()?.with_size([32, 24])?;
//!
//! // the picture is bit-equal whatever the number of threads; `None` takes all of them
//! let film = CpuRenderer::new(Some(2))?.render(&scene, &Silent)?.film;
//! let depth = film.plane(Plane::Depth)[12 * 32 + 16];
//! assert!((depth - 4.0).abs() < 0.02);
//! assert_eq!(film.plane(Plane::Coverage)[0], 0.0); // the corner shows the sky
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod ao;
pub mod bench;
mod bracket;
pub mod certify;
mod closed;
mod closest;
mod cone;
mod coverage;
mod integrator;
mod isolate;
mod job;
mod lamps;
mod march;
mod marcher;
mod normal;
mod order;
mod path;
mod paths;
mod planes;
mod primary;
mod query;
mod ray;
mod renderer;
mod resolve;
mod secondary;
mod shadow;
mod simd;
mod stop;
mod surface;
mod tile;
pub mod volume;
mod whitted;
pub mod why;

pub use query::{Hit, QueryError, Ray};
pub use renderer::{CpuRenderer, Part, PreparedScene, sums};
