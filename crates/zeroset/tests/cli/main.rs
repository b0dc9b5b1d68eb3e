//! The command line from outside: exit codes, what goes to which stream, and what happens to files.

mod again;
mod backend;
mod bake;
mod compare;
mod converge;
mod cryptomatte;
mod exits;
#[cfg(feature = "shaders")]
mod export;
mod fit;
mod frames;
mod hostile;
mod import;
mod language;
mod limit;
mod mesh;
mod proof;
mod reference;
mod render;
mod run;
mod set;
mod transparent;
mod usage;
mod watch;
mod writing;
