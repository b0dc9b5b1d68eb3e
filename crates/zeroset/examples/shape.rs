//! A shape that is written in Rust becomes a picture.
//!
//! `cargo run --release --example shape -- bowl.png`

use std::error::Error;
use std::path::PathBuf;
use zeroset::glam::{Vec3, vec3};
use zeroset::output::{atomic, format, picture::Picture};
use zeroset::scene::camera::{Camera, Lens};
use zeroset::scene::light::Light;
use zeroset::scene::material::{Material, Pattern};
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::scene::{Object, SceneParts};
use zeroset::shape::{cylinder, plane, sphere, torus};
use zeroset::trace::CpuRenderer;

fn main() -> Result<(), Box<dyn Error>> {
    let path: PathBuf = std::env::args().nth(1).unwrap_or("shape.png".into()).into();

    // a ball, hollow and open at the top, with three rings around it
    let bowl = sphere(1.0).onion(0.08) - cylinder(0.6, 2.0).translate([0.0, 1.0, 0.0]);
    let rings = torus(1.0, 0.06).repeat([0.0, 0.4, 0.0], [0, 3, 0]);
    let bowl = bowl.smooth_union(rings, 0.1).rotate_x(0.4);

    let colour = |r, g, b| Material {
        pattern: Pattern::Solid {
            colour: vec3(r, g, b),
        },
        ..Material::default()
    };
    let floor = Object {
        material: 1,
        ..Object::new("floor", plane().translate([0.0, -1.3, 0.0]).field()?)
    };
    let lens = Lens::Pinhole {
        fov: 40f32.to_radians(),
    };
    let parts = SceneParts {
        name: "bowl".into(),
        objects: vec![Object::new("bowl", bowl.field()?), floor],
        materials: vec![colour(0.8, 0.35, 0.1), colour(0.5, 0.5, 0.5)],
        lights: vec![Light::sun(vec3(-1.0, -2.0, -1.5), Vec3::ONE)],
        camera: Camera::look_at(vec3(1.5, 2.0, 4.5), Vec3::ZERO, Vec3::Y, lens).ok_or("no view")?,
        ..SceneParts::default()
    };
    let scene = parts.build()?.with_size([320, 240])?;

    let film = CpuRenderer::new(None)?.render(&scene, &Silent)?.film;
    let picture = Picture::develop(&film, scene.settings().view_transform());
    atomic::write_atomically(&path, |file| {
        format::png::write(
            file,
            &picture,
            format::png::Depth::Eight,
            &format::Metadata::new(scene.name()),
        )
    })?;
    println!("{}", path.display());
    Ok(())
}
