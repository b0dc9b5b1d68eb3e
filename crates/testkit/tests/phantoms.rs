//! No phantom surfaces: behind every hit of every scene, seen from its own camera, from the front, the side and above, the field
//! is negative, in double precision.

use zeroset::eval::Point;
use zeroset::field::program::Program;
use zeroset::language::load::{Options, load};
use zeroset::number::{F64, v3};
use zeroset::scene::camera::{Camera, Lens};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::render::{Renderer, Silent};
use zeroset::scene::scene::Scene;
use zeroset::scene::settings::{Antialias, Occlusion};
use zeroset::trace::CpuRenderer;
use zeroset_testkit::scenes;

/// The scene's own view, then parallel ones along the axes that stand on the floor.
fn views(scene: &Scene) -> Vec<Camera> {
    let mut views = vec![*scene.camera()];
    let (centre, half) = match scene.finite_bounds() {
        Some(b) => (b.centre(), b.half()),
        None => ([0.0; 3], [2.0; 3]),
    };
    let centre = glam::DVec3::from(centre);
    let size = glam::DVec3::from(half).length();
    for (back, up) in [
        (glam::DVec3::Z, glam::Vec3::Y),
        (glam::DVec3::X, glam::Vec3::Y),
        (glam::DVec3::Y, -glam::Vec3::Z),
    ] {
        let lens = Lens::Orthographic {
            height: (2.0 * size) as f32,
        };
        let eye = (centre + back * 3.0 * size).as_vec3();
        if let Some(camera) = Camera::look_at(eye, centre.as_vec3(), up, lens) {
            let far = (100.0 * size) as f32;
            views.push(Camera { far, ..camera });
        }
    }
    views
}

/// Hits without a solid behind them.
fn phantoms(scene: &Scene, film: &Film, program: &Program) -> usize {
    let mut point = Point::<F64>::new(program.values());
    let mut f = |p: glam::DVec3| point.value(v3(F64(p.x), F64(p.y), F64(p.z))).0;
    let [width, height] = scene.settings().size;
    let (slope, constant) = scene.camera().pixel_width(height);
    let mut count = 0;
    for (i, &depth) in film.plane(Plane::Depth).iter().enumerate() {
        if !depth.is_finite() {
            continue;
        }
        let (x, y) = (i as u32 % width, i as u32 / width);
        let (o, d) = scene
            .camera()
            .ray(x as f32 + 0.5, y as f32 + 0.5, [width, height]);
        let (o, d, t) = (o.as_dvec3(), d.as_dvec3(), f64::from(depth));
        let pixel = f64::from(slope) * t + f64::from(constant);
        // a ray may start inside: then it ends where the field is positive
        let side = if f(o + d * f64::from(scene.camera().near)) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let mut behind = |share: f64| {
            let by = |k: i32| pixel * share * (f64::from(k) - 100.0);
            (0..=400).any(|k| side * f(o + d * (t + by(k))) < 0.0)
        };
        count += usize::from(![0.01, 0.000_5, 0.000_02].into_iter().any(&mut behind));
    }
    count
}

#[test]
fn behind_every_hit_is_a_solid() {
    let renderer = CpuRenderer::new(None).expect("threads");
    let mut failures = Vec::new();
    for path in scenes::all() {
        let options = Options {
            size: Some([40, 40]),
            ..Options::default()
        };
        let mut scene = load(&path, &options).expect("a scene").scene;
        scene
            .edit(|s| {
                s.settings.antialias = Antialias::None;
                s.settings.occlusion = Occlusion::None;
                s.lights.clear();
                s.objects.iter_mut().for_each(|o| o.occlusion = None);
            })
            .expect("a scene");
        for (number, camera) in views(&scene).into_iter().enumerate() {
            scene.edit(|s| s.camera = camera).expect("a scene");
            let picture = renderer
                .prepare_scene(scene.clone().into())
                .expect("a program");
            if picture.program().is_fractal() {
                continue;
            }
            let film = renderer.render(&scene, &Silent).expect("a picture").film;
            let count = phantoms(&scene, &film, picture.program());
            if count > 0 {
                failures.push(format!("{} view {number}: {count}", path.display()));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
