//! A shape becomes a shader: as GLSL for Shadertoy, or as WGSL.
//!
//! `cargo run --release --example shader -- glsl`

use std::error::Error;
use std::io::Write;
use zeroset::glam::{Vec3, vec3};
use zeroset::scene::light::Light;
use zeroset::scene::material::Material;
use zeroset::scene::scene::{Object, SceneParts};
use zeroset::shader::export;
use zeroset::shape::{box3, sphere};

fn main() -> Result<(), Box<dyn Error>> {
    let shape = box3([1.6; 3]).round(0.1).twist(0.5) - sphere(0.95);
    let parts = SceneParts {
        name: "a hollow cube".into(),
        objects: vec![Object::new("cube", shape.field()?)],
        materials: vec![Material::default()],
        lights: vec![Light::sun(vec3(-1.0, -1.0, -2.0), Vec3::ONE)],
        ..SceneParts::default()
    };
    let scene = parts.build()?;
    let text = match std::env::args().nth(1).as_deref() {
        Some("glsl") => export::glsl(&scene)?,
        _ => export::wgsl(&scene)?,
    };
    std::io::stdout().write_all(text.as_bytes())?;
    Ok(())
}
