//! Signed distance fields: numbers, catalogue, bounds, programs, evaluators.

pub mod bounds;
pub mod catalogue;
pub mod field;
pub mod formula;
pub mod number;
pub mod placement;
pub mod program;
pub mod repetition;
