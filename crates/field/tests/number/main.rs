//! The number types, held against each other: what one formula gives in each of them must agree.

mod elementary;
mod gradient;
mod hash;
mod interval;
mod slope;
mod support;
mod tree;
