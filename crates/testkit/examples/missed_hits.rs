//! Pixels that each marcher misses although a dense march in double precision hits at their middle and all corners:
//! `cargo run --release -p zeroset-testkit --example missed_hits [SCENE]`.

use rayon::prelude::*;
use zeroset::field::program::Program;
use zeroset::language::load::{Options, load};
use zeroset::scene::camera::Camera;
use zeroset::scene::film::Plane;
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::scene::Scene;
use zeroset::scene::settings::{Antialias, March, Occlusion, Settings};
use zeroset::trace::{CpuRenderer, bench};
use zeroset_testkit::plain::dense;

/// The picture's side: small, because the reference takes thousands of evaluations a ray.
const SIDE: u32 = 160;

fn main() {
    let mut scene = match std::env::args().nth(1) {
        Some(path) => {
            let loaded = load(path.as_ref(), &Options::default());
            loaded.unwrap_or_else(|e| panic!("{e}")).scene
        }
        None => bench::city(),
    };
    let plain = Settings {
        size: [SIDE, SIDE],
        antialias: Antialias::None,
        occlusion: Occlusion::None,
        ..*scene.settings()
    };
    scene.edit(|s| s.settings = plain).expect("a scene");
    let renderer = CpuRenderer::new(None).expect("threads");
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let solid = surely_hit(picture.program(), &scene);
    for (name, march, prepass) in [
        ("fixed", March::Fixed { step: 0.02 }, false),
        ("sphere", March::Sphere, false),
        ("relaxed", March::Relaxed { omega: 1.2 }, false),
        ("enhanced", March::Enhanced { share: 0.9 }, false),
        ("auto", March::Auto { beta: 0.3 }, false),
        ("sphere+prepass", March::Sphere, true),
        ("auto+prepass", March::Auto { beta: 0.3 }, true),
    ] {
        let max_steps = match march {
            March::Fixed { .. } => 5000,
            _ => scene.settings().max_steps,
        };
        let settings = Settings {
            march,
            prepass,
            max_steps,
            ..plain
        };
        let scene = scene.clone().with_settings(settings).expect("a scene");
        let film = renderer.render(&scene, &Silent).expect("a picture").film;
        let pixels = solid.iter().zip(film.plane(Plane::Depth));
        let missed = pixels
            .filter(|(solid, t)| **solid && !t.is_finite())
            .count();
        println!("{name:16} {missed} hits missed");
    }
}

/// Pixels whose middle and corners all hit in the reference: those that are not within half a pixel of a silhouette.
fn surely_hit(program: &Program, scene: &Scene) -> Vec<bool> {
    let hits = |camera: &Camera, x: f32, y: f32| {
        let (o, d) = camera.ray(x, y, [SIDE, SIDE]);
        let [o, d] = [o, d].map(|v| v.to_array().map(f64::from));
        let (near, far) = (f64::from(camera.near), f64::from(camera.far).min(60.0));
        dense::march(program, o, d, near, far, |t| 1e-4 * t.max(0.1)).is_some()
    };
    // corners are shared by pixels
    let corners: Vec<bool> = (0..(SIDE + 1) * (SIDE + 1))
        .into_par_iter()
        .map(|i| {
            let (x, y) = (i % (SIDE + 1), i / (SIDE + 1));
            hits(scene.camera(), x as f32, y as f32)
        })
        .collect();
    (0..SIDE * SIDE)
        .into_par_iter()
        .map(|i| {
            let (x, y) = (i % SIDE, i / SIDE);
            let corner = |dx: u32, dy: u32| corners[((y + dy) * (SIDE + 1) + x + dx) as usize];
            corner(0, 0)
                && corner(1, 0)
                && corner(0, 1)
                && corner(1, 1)
                && hits(scene.camera(), x as f32 + 0.5, y as f32 + 0.5)
        })
        .collect()
}
