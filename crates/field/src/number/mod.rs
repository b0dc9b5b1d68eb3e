//! The number types that a field formula is evaluated over.

pub mod args;
pub mod dual;
pub mod elementary;
pub mod expr;
pub mod hash;
pub mod interval;
pub mod lanes;
mod list;
pub mod real;
pub mod record;
pub mod scalar;
pub mod slope;
pub mod vector;
pub mod wgsl;
mod wgsl_words;

pub use args::Args;
pub use dual::Dual;
pub use expr::Expr;
pub use hash::{Hash, hash1, hash2, hash3};
pub use interval::Interval;
pub use lanes::Lanes;
pub use real::{Ends, MOST_STEPS, Masked, Ops, Real, State, Truth, differ, inlined, length2};
pub use record::{Argument, Function, RecordError, Recorder};
pub use scalar::F64;
pub use slope::Slope;
pub use vector::{Vec2, Vec3, v2, v3};
