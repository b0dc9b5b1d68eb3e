//! Signed distance fields: numbers, catalogue, bounds, programs, evaluators.

pub mod bounds;
pub mod catalogue;
mod compile;
pub mod eval;
pub mod field;
pub mod formula;
mod level;
pub mod number;
pub mod op;
pub mod placement;
pub mod program;
mod proof;
pub mod repetition;
pub mod text;
