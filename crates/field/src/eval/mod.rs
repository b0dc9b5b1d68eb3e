//! Evaluators: a program over SIMD batches, with gradients, with marks, and over one point of any number type.

mod batch;
mod level;
mod marks;
mod point;

pub use batch::{BATCH, FLAT, Lane, Workspace, gradients, values};
pub use marks::{Marks, marks};
pub use point::Point;
