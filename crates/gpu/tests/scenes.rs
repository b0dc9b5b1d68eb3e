//! Scenes, from their text to a film. That films are those of the CPU is the conformance suite's to say.

use glam::Vec3;
use std::fmt::Write;
use std::sync::Arc;
use std::time::{Duration, Instant};
use zeroset_gpu::testing::{self, Faults};
use zeroset_gpu::{FieldForm, GpuError};
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::material::{Image, Pattern};
use zeroset_scene::render::{Observer, RenderError, Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Antialias;

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

/// An image of one colour, and its bytes on the GPU.
fn image(side: u32, colour: Vec3) -> (Arc<Image>, u64) {
    let pixels = vec![colour; (side * side) as usize];
    let image = Image {
        path: "one.png".into(),
        width: side,
        height: side,
        pixels,
    };
    (Arc::new(image), 16 * u64::from(side * side))
}

/// A scene that shows these images.
fn shown(images: &[&Arc<Image>], specular: f32) -> Arc<Scene> {
    let mut scene = scene("show(box(1))\ncamera((0, 0, 4), (0, 0, 0), fov = 40)");
    scene
        .edit(|s| {
            let material = s.materials[0].clone();
            for image in images {
                let mut material = material.clone();
                material.specular = specular;
                material.pattern = Pattern::Triplanar {
                    image: Arc::clone(image),
                    size: 1.0,
                    sharpness: 4.0,
                };
                s.materials.push(material);
            }
            s.objects[0].material = images.len() as u16;
        })
        .expect("a scene");
    Arc::new(scene)
}

/// Neither a slider nor the camera sends an image again: only what is new is sent.
#[test]
fn an_image_is_sent_to_the_gpu_once() {
    let Some(renderer) = testing::renderer("an_image_is_sent_to_the_gpu_once") else {
        return;
    };
    let (red, red_bytes) = image(700, Vec3::X);
    let (blue, blue_bytes) = image(2049, Vec3::Z);
    let first = shown(&[&red], 0.1);
    let mut prepared = renderer.prepare(Arc::clone(&first)).expect("a scene");
    // a picture, the colour of the surface in its middle, and the bytes that were sent for it
    let mut picture = |scene: &Arc<Scene>, camera: &Camera| {
        prepared.update(Arc::clone(scene)).expect("a scene");
        let mut sums = Accumulator::new([96, 64], Antialias::None, &[Plane::Albedo]);
        (prepared.sample(camera, 0..1, &mut sums, &Silent)).expect("a picture");
        let colours = sums.into_film().plane(Plane::Albedo).to_vec();
        let middle = Vec3::from_slice(&colours[3 * (32 * 96 + 48)..][..3]);
        let timings = renderer.timings().expect("a picture was made");
        (middle, timings.uploaded)
    };
    let camera = *first.camera();
    let mut moved = camera;
    moved.eye.x += 0.1;
    let few = 1 << 16;
    let (colour, bytes) = picture(&first, &camera);
    assert_eq!(colour, Vec3::X);
    assert!((red_bytes..red_bytes + few).contains(&bytes), "{bytes}");
    assert_eq!(picture(&first, &moved), (Vec3::X, 0));
    let (colour, bytes) = picture(&shown(&[&red], 0.2), &moved);
    assert_eq!(colour, Vec3::X);
    assert!((1..few).contains(&bytes), "{bytes} for a slider");
    // there is no room for another one beside it: both are sent, once
    let both = shown(&[&red, &blue], 0.2);
    let (colour, bytes) = picture(&both, &camera);
    assert_eq!(colour, Vec3::Z);
    let all = red_bytes + blue_bytes;
    assert!((all..all + few).contains(&bytes), "{bytes}");
    assert_eq!(picture(&both, &camera), (Vec3::Z, 0));
    // the same image is taken for the same, an equal one is sent again, and only that
    let (other, _) = image(2049, Vec3::Y);
    let (colour, bytes) = picture(&shown(&[&red, &other], 0.2), &camera);
    assert_eq!(colour, Vec3::Y);
    assert!((blue_bytes..blue_bytes + few).contains(&bytes), "{bytes}");
    // a scene without images leaves them there
    let (_, bytes) = picture(&shown(&[], 0.2), &camera);
    assert!(bytes < few, "{bytes}");
    let (colour, bytes) = picture(&shown(&[&red, &other], 0.2), &camera);
    assert_eq!(colour, Vec3::Y);
    assert!(bytes < few, "{bytes}");
}

#[test]
fn an_image_that_fits_into_no_memory_is_an_error_that_names_it() {
    let test = "an_image_that_fits_into_no_memory_is_an_error_that_names_it";
    let Some(renderer) = testing::with_faults(test, Faults::default().with_memory(8 << 20)) else {
        return;
    };
    let [(small, _), (large, _)] = [40, 1200].map(|side| image(side, Vec3::X));
    for (images, fits) in [([&small, &small], true), ([&small, &large], false)] {
        let rendered = renderer.render(&shown(&images, 0.1), &Silent);
        match rendered.map_err(|e| e.to_string()) {
            Ok(_) => assert!(fits),
            Err(error) => {
                let named = "\"one.png\", an image of 1200x1200 pixels";
                assert!(!fits && error.contains(named), "{error}");
                assert!(error.contains("out of memory"), "{error}");
            }
        }
    }
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
