//! The commands.

pub(crate) mod bake;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod expand;
#[cfg(feature = "shaders")]
pub(crate) mod export;
pub(crate) mod fields;
pub(crate) mod fit_ao;
#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub(crate) mod init;
pub(crate) mod mesh;
pub(crate) mod slice;
#[cfg(feature = "window")]
pub(crate) mod view;
