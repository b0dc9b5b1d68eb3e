//! Lenses, lamps and light from all around, alike in every renderer.

use super::{SIZE, check, none, on, reference};
use zeroset::gpu::testing;
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::scene::Scene;
use zeroset::scene::settings::{Antialias, Filter};
use zeroset::trace::CpuRenderer;

const THINGS: &str = "
show(plane(), material(color = \"#bbbbbb\", roughness = 0.35))
show(sphere(0.5).move(y = 0.5), material(color = \"#aa6644\", roughness = 0.6))
show(sphere(0.35).move(x = 1, y = 0.35, z = 0.3), material(metallic = 1, roughness = 0.08))
show(sphere(0.3).move(x = -0.9, y = 0.3, z = 0.4), material(color = \"white\", transmission = 1, roughness = 0))
camera(eye = (0.3, 1.2, 3.4), target = (0.1, 0.4, 0), fov = 40, aperture = 0.03, focus = (0, 0.5, 0.3))
";

const LIGHTS: [(&str, &str); 4] = [
    (
        "lamps",
        "rectangle_light(position = (1.5, 2, 1), target = (0, 0, 0), size = (1, 0.6), strength = 4)
disc_light(position = (-1.6, 1.4, -0.6), target = (0, 0.4, 0), radius = 0.4, color = \"#88aaff\", strength = 3)
sphere_light(position = (0.1, 1.8, -0.9), radius = 0.2, color = \"#ffcc88\", strength = 2)
sky(top = \"#223344\")",
    ),
    (
        "hidden lamps",
        "rectangle_light(position = (1.5, 2, 1), target = (0, 0, 0), size = (1, 0.6), visible = False)
disc_light(position = (-1.6, 1.4, -0.6), target = (0, 0.4, 0), radius = 0.4, shadow = none())
sky(top = \"#223344\")\nfog(density = 0.05)",
    ),
    ("a clear sky", "sky(turbidity = 3, strength = 0.8)\nsun(direction = (-1, -1.2, -0.4))"),
    (
        "a clear sky in fog",
        "sky(turbidity = 6)\nsun(direction = (1, -0.3, -0.4), strength = 0)\nfog(density = 0.03, height = 2)\n\
         sphere_light(position = (0.1, 1.8, -0.9), radius = 0.2, color = \"#ffcc88\", strength = 2)",
    ),
];

fn scene(lights: &str, integrator: &str) -> Scene {
    let text = format!("{THINGS}{lights}\nrender(integrator = {integrator})");
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    load_text("lights.star", &text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene
}

fn sampled(scene: &Scene, samples: u32) -> Scene {
    let mut scene = scene.clone();
    let filter = Filter::Box;
    let antialias = Antialias::Supersample { samples, filter };
    scene
        .edit(|s| s.settings.antialias = antialias)
        .expect("a scene");
    scene
}

/// The root of the mean square of what differs, of colours no brighter than a few times white.
fn apart(a: &Film, b: &Film) -> f32 {
    let (a, b) = (a.plane(Plane::Colour), b.plane(Plane::Colour));
    let dim = |x: &f32| x.min(4.0);
    let square: f32 = (a.iter().map(dim).zip(b.iter().map(dim)))
        .map(|(x, y)| (x - y) * (x - y))
        .sum();
    (square / a.len() as f32).sqrt()
}

#[test]
fn lights_are_the_same_in_the_plain_renderer() {
    let renderer = CpuRenderer::new(None).unwrap();
    let mut failures = Vec::new();
    for (name, lights) in LIGHTS {
        for integrator in ["whitted()", "direct()"] {
            let mut one = scene(lights, integrator);
            one.edit(|s| s.settings.antialias = Antialias::None)
                .expect("a scene");
            failures.extend(check(name, &one, &on(&renderer, &one), &reference(&one)));
        }
        let several = sampled(&scene(lights, "whitted()"), 4);
        let off = apart(&on(&renderer, &several), &reference(&several));
        if off > 0.03 {
            failures.push(format!("{name} through a lens: {off}"));
        }
    }
    none(failures);
}

#[test]
fn lights_are_the_same_on_the_gpu() {
    let Some(gpu) = testing::renderer("lights on the GPU") else {
        return;
    };
    let renderer = CpuRenderer::new(None).unwrap();
    let mut failures = Vec::new();
    for (name, lights) in LIGHTS {
        for (integrator, samples, most) in [("whitted()", 4, 0.02), ("path(depth = 4)", 4, 0.08)] {
            // the same random numbers
            let scene = sampled(&scene(lights, integrator), samples);
            let off = apart(&on(&gpu, &scene), &on(&renderer, &scene));
            if off > most {
                failures.push(format!("{name} {integrator}: {off}"));
            }
        }
    }
    none(failures);
}
