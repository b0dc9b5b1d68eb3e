//! Scenes, from their text to a film. That films are those of the CPU is the conformance suite's to say.

use zeroset_gpu::testing;
use zeroset_scene::film::Plane;
use zeroset_scene::load::{Language, Options, load_text};
use zeroset_scene::render::{Renderer, Silent};
use zeroset_scene::scene::Scene;

fn scene(text: &str) -> Scene {
    let options = Options {
        size: Some([96, 64]),
        ..Options::default()
    };
    load_text("test.star", text, Language::Starlark, None, &options)
        .expect("a valid scene")
        .scene
}

#[test]
fn a_sphere_is_seen_in_the_middle() {
    let Some(renderer) = testing::renderer("a_sphere_is_seen_in_the_middle") else {
        return;
    };
    let scene = scene("show(sphere(1.0))\ncamera((0, 0, 4), (0, 0, 0), fov = 40)");
    let frame = renderer.render(&scene, &Silent).expect("a picture");
    let film = &frame.film;
    let middle = (32 * 96 + 48) as usize;
    let depth = film.plane(Plane::Depth)[middle];
    assert!((depth - 3.0).abs() < 0.02, "{depth}");
    assert_eq!(film.plane(Plane::Object)[middle], 1.0);
    assert!(film.plane(Plane::Depth)[0].is_infinite());
    assert!(film.plane(Plane::Coverage)[middle] > 0.99);
    assert_eq!(film.plane(Plane::Coverage)[0], 0.0);
    let statistics = frame.statistics;
    assert_eq!(statistics.rays, 96 * 64 * u64::from(4u32));
    assert!(statistics.hits > 1000 && statistics.hits < statistics.rays);
    assert!(statistics.evaluations.march > 0 && statistics.evaluations.shadow > 0);
    let timings = renderer.timings().expect("a picture was made");
    assert!(timings.compile > 0.0);
    // a slider that moves compiles nothing
    let moved = crate::scene("show(sphere(0.8))\ncamera((0, 0, 4), (0, 0, 0), fov = 40)");
    let frame = renderer.render(&moved, &Silent).expect("a picture");
    assert!((frame.film.plane(Plane::Depth)[middle] - 3.2).abs() < 0.02);
    assert_eq!(renderer.timings().map(|t| t.compile), Some(0.0));
}

#[test]
fn a_scene_of_nothing_is_a_sky() {
    let Some(renderer) = testing::renderer("a_scene_of_nothing_is_a_sky") else {
        return;
    };
    let scene = Scene {
        objects: Vec::new(),
        ..scene("show(sphere(1.0))")
    };
    let frame = renderer.render(&scene, &Silent).expect("a picture");
    assert_eq!(frame.statistics.hits, 0);
    assert!(frame.film.plane(Plane::Coverage).iter().all(|c| *c == 0.0));
}
