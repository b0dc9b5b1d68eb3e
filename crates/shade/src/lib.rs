//! What is seen and how it looks: formulas of rays and light, each written once over any number type.

pub mod skin;
pub mod view;
