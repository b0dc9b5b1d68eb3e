//! Sampled fields: meshes as grids of distances, distance transforms of pictures and volumes, and the files that they come in.
//!
//! A mesh is [read](read::read), [looked through](check::mend) and [baked](bake::Bake::bake) into a [`Volume`](volume::Volume):
//! signed distances at the nodes of a grid, which a scene takes as a field like any other. [`write`](write::write) gives the bytes of mesh files.
//!
//! ```
//! use zeroset_volume::bake::{Alone, Bake};
//! use zeroset_volume::check::mend;
//! use zeroset_volume::mesh::MeshLimits;
//! use zeroset_volume::read::{MeshFormat, nothing_beside, read};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // a tetrahedron
//! let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
//! let mut mesh = read(text, MeshFormat::Obj, &MeshLimits::default(), &mut nothing_beside)?;
//! let check = mend(&mut mesh);
//! assert!(check.watertight && check.holes == 0);
//! let volume = Bake::default().bake(&mesh, &check, &Alone)?;
//! let field = volume.into_sampled()?;
//! assert!(field.slope() < 1.8);
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod bake;
mod bvh;
pub mod check;
pub mod compose;
mod crossing;
pub mod file;
pub mod mesh;
mod nearest;
pub mod outline;
pub mod pseudo;
pub mod read;
pub mod transform;
pub mod volume;
mod winding;
pub mod write;
