//! A scene file with a parameter, at three values of it: what is seen of it each time.
//!
//! `cargo run --release --example parameter`

use std::error::Error;
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::Plane;
use zeroset::scene::render::{Renderer, Silent};
use zeroset::trace::CpuRenderer;

/// A file on disk is loaded by `load(path, &options)`.
const SCENE: &str = r#"
hole = slider("hole", 0.3, min = 0.0, max = 1.5)
show(box(1.6).round(0.05) - sphere(hole + 0.5))
camera(eye = (2, 1.5, 4), target = (0, 0, 0))
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let renderer = CpuRenderer::new(None)?;
    for hole in ["0.1", "0.4", "0.6"] {
        let mut options = Options {
            size: Some([160, 120]),
            ..Options::default()
        };
        options.set.insert("hole".into(), hole.into());
        let loaded = load_text("cube.star", SCENE, Language::Starlark, None, &options)?;

        // what no parameter of the file says is changed in the scene
        let mut scene = loaded.scene;
        scene.edit(|parts| parts.settings.exposure += 0.5)?;

        let film = renderer.render(&scene, &Silent)?.film;
        let covered: f32 = film.plane(Plane::Coverage).iter().sum();
        println!("hole {hole}: the solid covers {covered:.0} pixels");
    }
    Ok(())
}
