//! The number types that a field formula is evaluated over.

pub mod dual;
pub mod expr;
pub mod interval;
pub mod lanes;
pub mod real;
pub mod scalar;
pub mod slope;

pub use dual::Dual;
pub use expr::{Expr, Recorder};
pub use interval::Interval;
pub use lanes::Lanes;
pub use real::{Args, Ends, Masked, Ops, Real, State, Vec2, Vec3, inlined, length2, v2, v3};
pub use scalar::F64;
pub use slope::Slope;
