//! Antialiasing by coverage against 256 rays a pixel, where pixels hold silhouettes.

use crate::edges::{Edges, Measured};
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter};
use zeroset_trace::CpuRenderer;

const COVERAGE: Antialias = Antialias::Coverage { layers: 4 };

/// A scene under light that leaves no shadows, so that what differs are edges.
fn scene(text: &str) -> Scene {
    let text = format!(
        "{text}\nsky(top = \"#9fb8d8\", horizon = \"#e6edf5\")\nsun(direction = (-1, -1.6, -0.7), shadow = none())\n\
         render(size = (64, 48), shading = \"phong\", ao = none())"
    );
    let options = Options::default();
    let loaded = load_text("edges.star", &text, Language::Starlark, None, &options);
    loaded.unwrap_or_else(|e| panic!("{e}")).scene
}

fn measured(scene: &Scene) -> [Measured; 3] {
    let renderer = CpuRenderer::new(None).unwrap();
    let edges = Edges::of(&renderer, scene, scene.settings().size[0]);
    assert!(edges.share() > 0.01, "there are no edges");
    let filter = Filter::Box;
    let four = Antialias::Supersample { samples: 4, filter };
    [Antialias::None, COVERAGE, four].map(|aa| edges.measure(&renderer, scene, aa))
}

fn film(scene: &Scene, antialias: Antialias) -> Film {
    let mut scene = scene.clone();
    scene
        .edit(|s| s.settings.antialias = antialias)
        .expect("a scene");
    let renderer = CpuRenderer::new(None).unwrap();
    renderer.render(&scene, &Silent).expect("a picture").film
}

#[test]
fn edges_are_close_to_256_rays_a_pixel() {
    for (name, text, closer) in [
        (
            "a sphere",
            "show(sphere(1), material(color = \"#b33\"))\ncamera(eye = (0, 0, 4), fov = 40)",
            12.0,
        ),
        (
            "from the side",
            "show(sphere(1), material(color = \"#b33\"))\ncamera(eye = (0, 0, 4), target = (1.2, 0.8, 0), fov = 70)",
            8.0,
        ),
        (
            "in parallel",
            "show(sphere(1), material(color = \"#b33\"))\ncamera(eye = (0, 0, 4), lens = orthographic(3))",
            12.0,
        ),
        (
            "a torus before itself",
            "show(torus(1, 0.35).turn(x = 70, z = 20), material(color = \"#3b3\"))\ncamera(eye = (0, 0, 4), fov = 45)",
            5.0,
        ),
        (
            "two with an edge in common",
            "show(sphere(1), material(color = \"#b33\"))\nshow(sphere(2).move(z = -4), material(color = \"#33b\"))\ncamera(eye = (0, 0, 4), fov = 40)",
            8.0,
        ),
        (
            "the horizon",
            "show(sphere(1).move(y = 1), material(color = \"#b33\"))\nshow(plane(), material(color = \"#777\"))\ncamera(eye = (0, 1.2, 5), target = (0, 1.1, 0), fov = 50)",
            4.0,
        ),
        (
            "a noisy sphere",
            "show(sphere(1).displace_gradient(amplitude = 0.08, frequency = 5), material(color = \"#b33\"))\ncamera(eye = (0, 0, 4), fov = 40)",
            1.4,
        ),
        (
            "a box",
            "show(box(1.4).turn(x = 20, y = 30), material(color = \"#b33\"))\ncamera(eye = (0, 0, 4), fov = 40)",
            3.0,
        ),
    ] {
        let [none, coverage, four] = measured(&scene(text));
        println!(
            "{name}: none {:.4}, coverage {:.4}, 4 rays {:.4}; evaluations times {:.2}, time times {:.2}",
            none.error,
            coverage.error,
            four.error,
            coverage.evaluations / none.evaluations,
            coverage.seconds / none.seconds,
        );
        assert!(
            coverage.error * closer < none.error,
            "{name}: {} of {}",
            coverage.error,
            none.error
        );
        // bumps whose field is far below the distance are edges that cones see too early: there more rays are better still
        assert!(
            coverage.error < four.error || name == "a noisy sphere",
            "{name}: {} with 4 rays {}",
            coverage.error,
            four.error
        );
    }
}

#[test]
fn pixels_without_edges_are_what_one_ray_shows() {
    let scene =
        scene("show(sphere(1), material(color = \"#b33\"))\ncamera(eye = (0, 0, 4), fov = 40)");
    let [none, parts] = [Antialias::None, COVERAGE].map(|aa| film(&scene, aa));
    let cover = parts.plane(Plane::Coverage);
    let mut parted = 0;
    for (at, (own, wanted)) in parts
        .plane(Plane::Colour)
        .chunks(3)
        .zip(none.plane(Plane::Colour).chunks(3))
        .enumerate()
    {
        match cover[at] {
            0.0 | 1.0 => assert!(
                own.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-4),
                "pixel {at}: {own:?} for {wanted:?}"
            ),
            _ => parted += 1,
        }
    }
    assert!(parted > 60, "{parted} pixels");
    // the area of the disc that the sphere is seen as
    let area: f32 = cover.iter().sum();
    let radius = 1.0 / 15.0f32.sqrt() / (2.0 * 20.0f32.to_radians().tan() / 48.0);
    let wanted = std::f32::consts::PI * radius * radius;
    assert!(
        (area / wanted - 1.0).abs() < 2e-3,
        "{area} pixels for {wanted}"
    );
}

#[test]
fn coverage_does_not_depend_on_threads() {
    let mut scene = scene(
        "show(torus(1, 0.35).turn(x = 70, z = 20), material(color = \"#3b3\", transmission = 0.5))\ncamera(eye = (0, 0, 4), fov = 45)",
    );
    scene
        .edit(|s| s.settings.antialias = COVERAGE)
        .expect("a scene");
    let films = [1, 3].map(|threads| {
        let renderer = CpuRenderer::new(Some(threads)).unwrap();
        renderer.render(&scene, &Silent).expect("a picture").film
    });
    for plane in Plane::ALL {
        assert_eq!(films[0].plane(plane), films[1].plane(plane), "{plane:?}");
        assert!(
            films[0].plane(plane).iter().all(|x| !x.is_nan()),
            "{plane:?}"
        );
    }
}
