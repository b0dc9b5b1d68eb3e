//! The stream renderer against the plain one, against itself, and against a dense march in double precision.

#![allow(unreachable_pub, reason = "the modules of a test are its own")]

mod any_formula;
mod cells;
mod certify;
mod closed;
mod compare;
mod coverage;
mod edges;
mod marchers;
mod methods;
mod mutants;
mod openness;
mod paths;
mod queries;
mod robust;
mod scenes;
mod surfaces;
