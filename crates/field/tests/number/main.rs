//! The number types, held against each other: what one formula gives in each of them must agree.

mod elementary;
mod hash;
mod support;
