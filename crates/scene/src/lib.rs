//! Scenes: what a renderer gets, what it gives, and what a renderer is.
//!
//! A [`Scene`](scene::Scene) is valid by construction: [`SceneParts`](scene::SceneParts) are put together freely, and become a scene
//! where their numbers are in their ranges and their references lead somewhere. What is wrong is named with its place.
//!
//! ```
//! use glam::{Vec3, vec3};
//! use zeroset_field::shape::sphere;
//! use zeroset_scene::camera::{Camera, Lens};
//! use zeroset_scene::light::Light;
//! use zeroset_scene::material::Material;
//! use zeroset_scene::scene::{Object, SceneParts};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let lens = Lens::Pinhole { fov: 40f32.to_radians() };
//! let parts = SceneParts {
//!     name: "ball".into(),
//!     objects: vec![Object::new("ball", sphere(1.0).field()?)],
//!     materials: vec![Material::default()],
//!     lights: vec![Light::sun(vec3(-1.0, -2.0, -1.0), Vec3::ONE)],
//!     camera: Camera::look_at(vec3(2.0, 1.5, 4.0), Vec3::ZERO, Vec3::Y, lens).ok_or("no view")?,
//!     ..SceneParts::default()
//! };
//! let mut scene = parts.build()?;
//!
//! // every change is checked; where it is refused, the scene stays as it was
//! scene.edit(|parts| parts.settings.max_steps = 100)?;
//! let error = scene.edit(|parts| parts.objects[0].material = 7).unwrap_err();
//! assert_eq!(error.to_string(), "objects[0].material: there is no material 7");
//! let error = scene.with_size([0, 480]).unwrap_err();
//! assert!(error.to_string().starts_with("settings.size: a picture of 0x480 pixels"));
//! # Ok(())
//! # }
//! ```
//!
//! A renderer is whatever implements [`Renderer`](render::Renderer): it turns a scene into a [`Film`](film::Film).

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod accumulator;
pub mod camera;
pub mod colour;
pub mod environment;
pub mod fallback;
pub mod film;
pub mod light;
pub mod material;
pub mod methods;
pub mod motion;
pub mod progressive;
pub mod render;
pub mod scene;
pub mod settings;
pub mod valid;
