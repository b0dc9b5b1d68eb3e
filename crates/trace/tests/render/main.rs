//! The stream renderer against the plain one, against itself, and against a dense march in double precision.

mod compare;
mod marchers;
mod methods;
mod mutants;
mod robust;
mod scenes;
