//! The CPU renderer: sphere tracing in SIMD streams.

mod ao;
mod beam;
pub mod bench;
mod bracket;
mod cone;
mod isolate;
mod job;
mod march;
mod marcher;
mod material;
mod normal;
mod order;
pub mod plain;
mod planes;
mod primary;
mod renderer;
mod resolve;
mod sampling;
mod shade;
mod shadow;
mod simd;
mod stop;
mod tile;

pub use renderer::{CpuRenderer, Part, PreparedScene, sums};
