//! Signed distance fields as trees: what they know of themselves, how formulas are proven, and what they compile to.
//!
//! A [`Shape`](shape::Shape) is how one writes a field in Rust; a [`Field`](field::Field) is the checked tree, whose every node knows a
//! box around it, how true its distance is, and its Lipschitz constant; a [`Program`](program::Program) is what evaluators and
//! shaders run, and never overestimates a distance.
//!
//! ```
//! use zeroset_catalogue::bounds::Exactness;
//! use zeroset_field::program::{Limits, Program};
//! use zeroset_field::shape::{box3, sphere};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let twisted = box3([2.0, 0.2, 2.0]).twist(0.5);
//! assert!(twisted.field()?.facts().slope > 1.0); // a twist makes a field steeper, and its distance a bound
//! assert_eq!(twisted.field()?.facts().exactness, Exactness::Bound);
//!
//! let field = (sphere(1.0).translate([0.0, 1.0, 0.0]) | twisted).field()?;
//!
//! let program = Program::compile(&field, &Limits::default())?;
//! assert!(program.bounds().max[1] >= 2.0);
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod closed;
mod compile;
pub mod field;
pub mod formula;
mod level;
pub mod placement;
pub mod program;
mod proof;
pub mod repetition;
#[doc(hidden)]
pub mod sampled;
pub mod shape;
pub mod text;
