//! Pictures that converge: intervals against mathematics over many seeds, and equal bits however they are made.

use std::sync::Arc;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::progressive::{Progressive, USUAL};
use zeroset_scene::render::{Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter};
use zeroset_trace::CpuRenderer;

fn scene(text: &str, size: [u32; 2]) -> Scene {
    let options = Options {
        size: Some(size),
        ..Options::default()
    };
    let loaded = load_text("a.star", text, Language::Starlark, None, &options);
    loaded.unwrap_or_else(|e| panic!("{e}")).scene
}

/// Renders until the noise is that small.
fn converged(
    renderer: &CpuRenderer,
    scene: &Scene,
    planes: &[Plane],
    seed: u32,
    noise: f64,
) -> Progressive {
    let settings = *scene.settings();
    let Antialias::Supersample { filter, .. } = settings.antialias else {
        panic!("a scene with several rays a pixel");
    };
    let mut picture = Progressive::new(settings.size, filter, planes, seed, 0.0);
    let mut prepared = renderer.prepare(Arc::new(scene.clone())).unwrap();
    while picture.noise() > noise {
        let (camera, target) = (scene.camera(), Some(noise));
        (picture.advance(prepared.as_mut(), camera, target, &Silent)).unwrap();
        assert!(picture.rounds() < 500, "it never ends");
    }
    picture
}

/// Whether places have different numbers of samples.
fn is_uneven(picture: &Progressive) -> bool {
    let [width, height] = picture.size().map(u64::from);
    picture.rays() != u64::from(picture.rounds() * USUAL) * width * height
}

/// The floor below a black ball in a white sky: what the ball covers of the sky is, by the cosine law, F = R^2 h / (h^2 + a^2)^(3/2) at a
/// distance `a` from the place below its middle at height `h` (a sphere that is above the horizon as a whole; Howell, configuration
/// factors, B-14). Where a picture ended because it seemed sharp, its intervals hold that, averaged over the pixel, 95 times of a
/// hundred, within 2; and the mean over all of them is not off: adaptive sampling and the end it comes to leave no bias that is seen.
#[test]
fn intervals_hold_the_truth_over_200_seeds() {
    const SIZE: [u32; 2] = [80, 3];
    const SEEDS: u32 = 200;
    // across the edge between two cells, which have samples of their own number
    let (radius, height, left, pixel) = (0.6, 1.0, 0.0, 1.2 / 80.0);
    let text = format!(
        "show(plane(), material(color = rgb(0.8, 0.8, 0.8), roughness = 1, specular = 0))
show(sphere({radius}).move(y = {height}), material(color = \"black\", roughness = 1, specular = 0))
sun(strength = 0)\nsky(color = \"white\", ambient = 1)
camera(eye = ({}, 0.2, 0), target = ({0}, 0, 0), up = (0, 0, -1), lens = orthographic({}))
render(footprint = 0.01, ao = none(), prepass = False, integrator = path(), aa = supersample(16, \"box\"))",
        left + 40.0 * pixel,
        3.0 * pixel,
    );
    let scene = scene(&text, SIZE);
    let albedo = ((0.8f64 + 0.055) / 1.055).powf(2.4);
    let right = |x: u32, y: u32| {
        let n = 8;
        let mut sum = 0.0;
        for i in 0..n * n {
            let at = |k: u32, i: u32| f64::from(k) + (f64::from(i) + 0.5) / f64::from(n);
            let a = left + at(x, i % n) * pixel;
            let b = (at(y, i / n) - 1.5) * pixel;
            let d = height * height + a * a + b * b;
            sum += 1.0 - radius * radius * height / (d * d.sqrt());
        }
        albedo * sum / f64::from(n * n)
    };
    let renderer = CpuRenderer::new(None).unwrap();
    let (mut held, mut off, mut uneven) = (0, 0.0, 0);
    for seed in 0..SEEDS {
        let picture = converged(&renderer, &scene, &[Plane::Colour], seed, 0.02);
        uneven += u32::from(is_uneven(&picture));
        for i in 0..SIZE[0] * SIZE[1] {
            let (interval, right) = (
                picture.interval(i as usize),
                right(i % SIZE[0], i / SIZE[0]),
            );
            held += u32::from(interval.holds(right));
            off += (interval.mean - right) / right;
        }
    }
    let all = f64::from(SEEDS * SIZE[0] * SIZE[1]);
    let (share, bias) = (f64::from(held) / all, off / all);
    println!("{share:.4} of the intervals hold the truth, bias {bias:.6}");
    assert!(uneven > SEEDS / 2, "{uneven} pictures have uneven samples");
    assert!((share - 0.95).abs() < 0.02, "{share}");
    // a standard error of the mean is about 0.02 / sqrt(48000), a ten-thousandth
    assert!(bias.abs() < 5e-4, "{bias}");
}

/// Threads change nothing, uneven samples included.
#[test]
fn threads_change_nothing() {
    let text = "show(sphere(0.5).move(y = 0.5), material(color = \"#c04020\", roughness = 0.3))\nshow(plane())
camera(eye = (0, 1, 3), target = (0, 0.4, 0))\nrender(integrator = path(3))";
    let scene = scene(text, [80, 40]);
    let [one, three] = [1, 3].map(|threads| {
        let renderer = CpuRenderer::new(Some(threads)).unwrap();
        converged(&renderer, &scene, &Plane::ALL, 7, 0.015)
    });
    assert_eq!(one.rounds(), three.rounds());
    assert!(one.rays() > 0 && one.rays() == three.rays());
    assert!(is_uneven(&one));
    assert!(one.film() == three.film());
}

/// Where samples are uneven, a wide filter still weighs all places around a pixel alike, and every plane is what even samples make it.
#[test]
fn uneven_samples_are_weighed() {
    let text = "show((sphere(0.5) & box(1)).move(y = 0.5))\nshow(plane())\ncamera(eye = (0, 1, 3), target = (0, 0.4, 0))
render(integrator = path(2), aa = supersample(16, \"mitchell\"))";
    let scene = scene(text, [140, 40]);
    let renderer = CpuRenderer::new(Some(2)).unwrap();
    let uneven = converged(&renderer, &scene, &Plane::ALL, 1, 0.02);
    assert!(is_uneven(&uneven));
    let mut even = Progressive::new([140, 40], Filter::Mitchell, &Plane::ALL, 2, 0.0);
    let mut prepared = renderer.prepare(Arc::new(scene.clone())).unwrap();
    for _ in 0..uneven.rounds() {
        (even.advance(prepared.as_mut(), scene.camera(), None, &Silent)).unwrap();
    }
    let (a, b) = (uneven.film(), even.film());
    for (plane, tolerance) in [
        (Plane::Colour, 0.02),
        (Plane::Coverage, 0.01),
        (Plane::Normal, 0.01),
        (Plane::Albedo, 0.01),
        (Plane::Shadow, 0.02),
    ] {
        let pairs = a.plane(plane).iter().zip(b.plane(plane));
        let rms: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
        let rms = (rms / a.plane(plane).len() as f32).sqrt();
        assert!(rms < tolerance, "{plane:?}: {rms}");
    }
    let mean = |film: &Film| film.plane(Plane::Steps).iter().sum::<f32>() / (140.0 * 40.0);
    let ratio = mean(&a) / mean(&b);
    assert!((ratio - 1.0).abs() < 0.02, "steps: {ratio}");
}
