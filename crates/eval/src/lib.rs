//! Evaluators: a tape over SIMD batches, with gradients, with marks, and over one point of any number type.
//!
//! [`Evaluator`] is the one for most uses: slices of points in, slices of numbers out, at the widest vectors of the machine. [`Point`]
//! takes one point of any number type; a [`Pruner`] finds what is left of a tape in a box; the rest is for renderers that run SIMD code of their own.
//!
//! ```
//! use glam::vec3;
//! use zeroset_eval::{Evaluator, Point};
//! use zeroset_field::program::{Limits, Program};
//! use zeroset_field::shape::{box3, sphere};
//! use zeroset_number::{F64, Interval, Vec3, v3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let shape = sphere(1.0) - box3([1.0, 1.0, 4.0]);
//! let program = Program::compile(&shape.field()?, &Limits::default())?;
//!
//! let mut evaluator = Evaluator::new(program.values());
//! let points = [vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(0.75, 0.0, 0.0)];
//! let mut values = [0.0; 3];
//! evaluator.values(&points, &mut values)?;
//! assert_eq!(values, [0.5, 1.0, -0.25]);
//!
//! // the same in double precision, and over a whole box
//! let value = Point::<F64>::new(program.values()).value(v3(F64(2.0), F64(0.0), F64(0.0)));
//! assert_eq!(value, F64(1.0));
//! let cube = Vec3::splat(Interval::new(1.0, 2.0));
//! assert!(Point::<Interval>::new(program.values()).value(cube).lo > 0.0); // no surface in there
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod batch;
mod evaluator;
mod marks;
mod point;
mod prune;
mod workspace;

pub use batch::{gradients, places, values};
pub use evaluator::{Evaluator, LengthError};
pub use marks::marks;
pub use point::{Point, PointNumber};
pub use prune::{Pruner, Remains};
pub use workspace::{BATCH, Lane, Marks, Workspace};
