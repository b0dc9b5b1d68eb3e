//! Scenes of thousands of parts: software that stands for a GPU ends the loops of a shader early, and what the interpreter
//! of such a field is then cut off from is shadows, occlusion and colours.

use crate::{check, none, on, reference};
use std::collections::BTreeSet;
use zeroset::gpu::testing;
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::scene::Scene;
use zeroset::scene::settings::{Antialias, Occlusion};
use zeroset::trace::CpuRenderer;

const SIZE: [u32; 2] = [48, 36];

/// A field of so many solids on a floor, each an object of a material of its own, of which the camera sees a few from near:
/// faces are wider than a pixel's neighbourhood, and all others are only work.
fn parts(count: usize) -> Scene {
    let text = format!(
        "
shapes = [sphere(0.4), box((0.7, 0.8, 0.6)), cylinder(radius = 0.35, height = 0.8), torus(radius = 0.3, tube = 0.15)]
colors = [checker(\"white\", \"black\", size = 0.2), stripes(\"gold\", \"navy\", direction = \"y\", size = 0.3)]
for i in range({count}):
    x = (i % 50 - 24.5) * 1.1
    z = (i // 50 - {rows} / 2) * 1.1
    color = colors[i // 7 % 2] if i % 7 == 0 else hsv(i * 47 % 360, 0.3 + 0.1 * (i % 6), 0.9)
    show(shapes[(i + i // 50) % 4].move((x, 0.4, z)), material(color = color, specular = 0.1 * (i % 5)))
show(plane(), material(color = \"#777777\"))
camera(eye = (0.4, 2.6, 2.9), target = (0.2, 0.2, 0), fov = 45)
sun(direction = (-1, -1.6, -0.7), shadow = soft(24))
",
        rows = count / 50
    );
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    let mut scene = load_text("parts.star", &text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene;
    scene
        .edit(|s| s.settings.antialias = Antialias::None)
        .expect("a scene");
    scene
}

/// Whether a film shows what it is meant to: many objects in many colours, in sun and in shadow.
#[track_caller]
fn is_varied(film: &Film) {
    let of = |plane: Plane| film.plane(plane);
    let objects: BTreeSet<u32> = of(Plane::Object).iter().map(|o| *o as u32).collect();
    let colours: BTreeSet<[u32; 3]> = (of(Plane::Albedo).as_chunks::<3>().0.iter())
        .map(|c| c.map(|x| (1000.0 * x) as u32))
        .collect();
    assert!(objects.len() > 12, "{} objects", objects.len());
    assert!(colours.len() > 12, "{} colours", colours.len());
    for plane in [Plane::Shadow, Plane::Occlusion] {
        let mean = of(plane).iter().sum::<f32>() / of(plane).len() as f32;
        assert!((0.2..0.95).contains(&mean), "{plane:?} {mean}");
    }
}

#[test]
fn a_scene_of_2000_parts_is_the_same_on_the_gpu() {
    let Some(gpu) = testing::renderer("2,000 parts on the GPU") else {
        return;
    };
    let scene = parts(2000);
    // the GPU starts each ray by itself, as the plain renderer does, where it traces in turns
    let right = reference(&scene);
    is_varied(&right);
    let film = on(&gpu, &scene);
    none(
        check("2,000 parts", &scene, &film, &right)
            .into_iter()
            .collect(),
    );
    // what is known about a scene stays: the second picture is not begun anew
    let again = on(&gpu, &scene);
    assert!(Plane::ALL.iter().all(|p| again.plane(*p) == film.plane(*p)));
    assert_eq!(gpu.timings().map(|t| t.retries), Some(0));
    // rays of occlusion ask many more questions than a dispatch can answer
    let mut sampled = scene;
    let occlusion = Occlusion::Hemisphere {
        rays: 12,
        reach: Some(1.0),
    };
    sampled
        .edit(|s| (s.settings.size, s.settings.occlusion) = ([16, 12], occlusion))
        .expect("a scene");
    let right = reference(&sampled);
    none(
        check("sampled", &sampled, &on(&gpu, &sampled), &right)
            .into_iter()
            .collect(),
    );
}

#[test]
fn a_scene_of_5000_coloured_objects_is_the_same_on_the_gpu() {
    let Some(gpu) = testing::renderer("5,000 objects on the GPU") else {
        return;
    };
    let mut scene = parts(5000);
    scene.edit(|s| s.settings.size = [32, 24]).expect("a scene");
    let right = on(&CpuRenderer::new(None).unwrap(), &scene);
    is_varied(&right);
    none(
        check("5,000 objects", &scene, &on(&gpu, &scene), &right)
            .into_iter()
            .collect(),
    );
}
