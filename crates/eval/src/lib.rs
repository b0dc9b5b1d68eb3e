//! Evaluators: a tape over SIMD batches, with gradients, with marks, and over one point of any number type.

mod batch;
mod evaluator;
mod marks;
mod point;

pub use batch::{BATCH, Lane, Workspace, gradients, values};
pub use evaluator::{Evaluator, LengthError};
pub use marks::{Marks, marks};
pub use point::{Number, Point};
