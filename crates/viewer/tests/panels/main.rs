//! Every panel, driven the way a screen reader drives it: by the names of its controls.

mod app;
mod makers;
mod panels;
mod session;
