//! Signed distance fields as trees: what they know of themselves, how formulas are proven, and what they compile to.

mod compile;
pub mod field;
pub mod formula;
mod level;
pub mod placement;
pub mod program;
mod proof;
pub mod repetition;
pub mod shape;
pub mod text;
