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
mod normal;
mod order;
mod planes;
mod primary;
mod renderer;
mod resolve;
mod shadow;
mod simd;
mod stop;
mod tile;

pub use renderer::{CpuRenderer, Part, Picture, sums};
