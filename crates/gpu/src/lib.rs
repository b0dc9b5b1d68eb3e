//! The GPU renderer of Zeroset, on wgpu.
//!
//! [`GpuRenderer`] renders the pictures of the CPU's renderer, on any GPU that runs compute shaders. It is made so that
//! neither the desktop nor the caller suffers: a picture is dispatched in tiles of milliseconds, in bands that fit into
//! memory; every wait ends; every failure of a driver is a [`GpuError`], so that a caller can go on with the CPU.
//!
//! ```
//! use zeroset_gpu::{Choice, GpuRenderer, adapters};
//!
//! let (all, _automatic) = adapters();
//! for adapter in all {
//!     println!("{}", adapter.name);
//! }
//! match GpuRenderer::new(&Choice::Any) {
//!     Ok(_renderer) => println!("rendering on the GPU"),
//!     Err(error) => println!("rendering on the CPU: {error}"),
//! }
//! ```
//!
//! | module | holds |
//! | --- | --- |
//! | `adapter` | what adapters there are and which one is taken |
//! | `device` | the device, and everything that a driver can fail at |
//! | `pipeline` | shaders, compiled once for scenes of equal structure |
//! | `band`, `memory` | what fits into the device's memory, and the buffers |
//! | `texture` | what is too long for buffers: images, grids |
//! | `pace` | how large a tile is, from what earlier ones took |
//! | `render_queue` | submissions on their way, and the GPU's clock |
//! | `picture` | one picture: bands, stages, tiles |
//! | `renderer` | the renderer, and what is done when the device fails |
//! | `host` | what is left to whoever runs all that: to wait, to compile beside other work |
//! | `blocking` | the renderer of native programs, which wait |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod adapter;
mod band;
mod blocking;
mod device;
mod error;
mod fault;
mod host;
mod memory;
mod pace;
mod picture;
mod pipeline;
mod render_queue;
mod renderer;
#[doc(hidden)]
pub mod testing;
mod texture;
mod timing;

pub use adapter::{AdapterInfo, Choice, Kind};
pub use blocking::{GpuRenderer, adapters};
pub use error::GpuError;
pub use timing::{StageSeconds, Timings};
pub use zeroset_shader::{FieldForm, Job};
