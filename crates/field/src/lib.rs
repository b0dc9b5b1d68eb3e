//! Signed distance fields: numbers, catalogue, bounds, programs, evaluators.

pub mod bounds;
pub mod catalogue;
pub mod number;
