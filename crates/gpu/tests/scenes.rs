//! Scenes, from their text to a film. That films are those of the CPU is the conformance suite's to say.

use std::fmt::Write;
use std::time::{Duration, Instant};
use zeroset_gpu::{FieldForm, GpuError, testing};
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::Plane;
use zeroset_scene::render::{Observer, RenderError, Renderer, Silent};
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
    let mut scene = scene("show(sphere(1.0))");
    scene.edit(|s| s.objects.clear()).expect("a scene");
    let frame = renderer.render(&scene, &Silent).expect("a picture");
    assert_eq!(frame.statistics.hits, 0);
    assert!(frame.film.plane(Plane::Coverage).iter().all(|c| *c == 0.0));
}

/// Chains that need a register a link: drivers compile arrays of them slowly, or not at all.
#[test]
fn a_long_chain_of_changes_is_rendered() {
    let Some(renderer) = testing::renderer("a_long_chain_of_changes_is_rendered") else {
        return;
    };
    for (links, link, [radius, height]) in [
        (160, "round(0.001).move(y = 0.001)", [0.66, 0.16]),
        (100, "round(0).move(y = 0.001)", [0.5, 0.1]),
    ] {
        let text = format!(
            "s = sphere(0.5)\nfor i in range({links}):\n    s = s.{link}\nshow(s)\ncamera((0, {height}, 4), (0, {height}, 0), fov = 40)"
        );
        let scene = scene(&text);
        let began = Instant::now();
        let frame = renderer.render(&scene, &Silent).expect("a picture");
        println!("{links} times {link}: {:?}", began.elapsed());
        let depth = frame.film.plane(Plane::Depth)[32 * 96 + 48];
        assert!((depth - (4.0 - radius)).abs() < 0.03, "{link}: {depth}");
    }
}

/// Cancels after some time.
struct Patience(Instant, Duration);

impl Observer for Patience {
    fn advance(&self, _: u64, _: u64) {}

    fn is_cancelled(&self) -> bool {
        self.0.elapsed() > self.1
    }
}

#[test]
fn who_cancels_does_not_wait_for_the_compiler() {
    let Some(renderer) = testing::renderer("who_cancels_does_not_wait_for_the_compiler") else {
        return;
    };
    // code that takes lavapipe minutes
    let renderer = renderer.with_form(FieldForm::Compiled);
    let mut text = String::new();
    for i in 0..3000 {
        // writing to a string cannot fail
        let _ = writeln!(text, "show(sphere(0.1).move(({}, {}, 0)))", i % 50, i / 50);
    }
    let scene = scene(&text);
    let job = renderer.job(&scene).expect("a job");
    for after in [200, 1500, 4000] {
        let after = Duration::from_millis(after);
        let patience = Patience(Instant::now(), after);
        let planes = [zeroset_scene::film::Plane::Colour];
        let mut sums = zeroset_scene::accumulator::Accumulator::new(
            [96, 64],
            scene.settings().antialias,
            &planes,
        );
        let samples = 0..sums.wanted();
        match renderer.sample(&job, samples, &mut sums, &patience) {
            Err(GpuError::Scene(RenderError::Cancelled)) => {}
            // a fast compiler
            Ok(_) => return,
            Err(error) => panic!("{error}"),
        }
        let late = patience.0.elapsed().saturating_sub(after);
        assert!(late < Duration::from_secs(30), "{late:?} after {after:?}");
    }
    let began = Instant::now();
    drop(renderer);
    assert!(
        began.elapsed() < Duration::from_secs(1),
        "{:?}",
        began.elapsed()
    );
}
