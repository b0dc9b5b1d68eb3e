//! Zeroset renders signed distance fields: this crate is its command line, and one name for all of it as a library.
//!
//! | module | holds |
//! | --- | --- |
//! | [`number`] | number types that formulas are evaluated over |
//! | [`catalogue`] | the formulas of shapes, maps, modifiers and joins |
//! | [`shape`] | shapes as they are written in Rust: functions, methods, operators |
//! | [`field`] | field trees, and the programs that they compile to |
//! | [`eval`] | evaluators of programs |
//! | [`scene`] | scenes, films, and what a renderer is |
//! | [`language`] | scene files |
//! | [`shade`] | what is seen and how it looks |
//! | [`trace`] | the renderer on the CPU |
//! | `shader` | shaders for any scene, in WGSL and GLSL, with the feature `shaders` |
//! | `gpu` | the renderer on the GPU, with the feature of that name |
//! | [`output`] | pictures and files |
//! | [`contour`] | meshes of the surfaces of fields |
//! | [`section`] | fields on a plane |
//!
//! A shape is written as in a scene file, and evaluated wherever one wants to know it:
//!
//! ```
//! use zeroset::eval::Evaluator;
//! use zeroset::field::program::{Limits, Program};
//! use zeroset::glam::{Vec3, vec3};
//! use zeroset::shape::{box3, sphere};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let shape = sphere(1.0).translate(vec3(0.0, 1.0, 0.0)) | box3([3.0, 0.2, 3.0]).round(0.05);
//! let program = Program::compile(&shape.field()?, &Limits::default())?;
//! let (value, gradient) = Evaluator::new(program.values()).gradient(vec3(0.0, 4.0, 0.0));
//! assert_eq!((value, gradient), (2.0, Vec3::Y));
//! # Ok(())
//! # }
//! ```
//!
//! A scene file becomes a picture in four steps; `examples/` has more:
//!
//! ```
//! use zeroset::output::{atomic, format, picture::Picture};
//! use zeroset::language::load::{Language, Options, load_text};
//! use zeroset::scene::render::{Renderer, Silent};
//! use zeroset::trace::CpuRenderer;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = "show(sphere(0.8) - box(1.0).move(x = 0.6))";
//! let options = Options { size: Some([48, 32]), ..Options::default() };
//! let loaded = load_text("bitten.star", text, Language::Starlark, None, &options)?;
//!
//! let frame = CpuRenderer::new(Some(2))?.render(&loaded.scene, &Silent)?;
//! assert!(frame.statistics.hits > 100);
//!
//! let picture = Picture::develop(&frame.film, loaded.scene.settings().view_transform());
//! let folder = std::env::temp_dir().join(format!("zeroset-doc-{}", std::process::id()));
//! atomic::create_folder(&folder)?;
//! atomic::write_atomically(&folder.join("bitten.png"), |writer| {
//!     format::png::write(writer, &picture, format::png::Depth::Eight, &format::Metadata::new("bitten"))
//! })?;
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok(())
//! # }
//! ```

pub mod section;

pub use glam;
pub use zeroset_field::shape;

pub use zeroset_catalogue as catalogue;
pub use zeroset_contour as contour;
pub use zeroset_eval as eval;
pub use zeroset_field as field;
#[cfg(feature = "gpu")]
pub use zeroset_gpu as gpu;
pub use zeroset_language as language;
pub use zeroset_number as number;
pub use zeroset_output as output;
pub use zeroset_scene as scene;
pub use zeroset_shade as shade;
#[cfg(feature = "shaders")]
pub use zeroset_shader as shader;
pub use zeroset_trace as trace;
pub use zeroset_volume as volume;
