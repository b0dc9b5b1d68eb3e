//! The number types, held against each other: what one formula gives in each of them must agree.

mod elementary;
mod formulas;
mod gradient;
mod grid;
mod hash;
mod interval;
mod record;
mod slope;
mod support;
mod tree;
mod vector_code;
