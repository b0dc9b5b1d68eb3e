//! Images: on a GPU they lie in one texture, one behind the other through its rows and layers.

use crate::{SIZE, check, none, on, reference};
use glam::{Vec2, Vec3};
use std::sync::Arc;
use zeroset::gpu::testing;
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::material::{Image, Pattern};
use zeroset::scene::scene::Scene;
use zeroset::scene::settings::Antialias;
use zeroset::trace::CpuRenderer;

/// Width and height of each: the first fills more than a layer, others are wider than one, end within a row or are one pixel.
const IMAGES: [[u32; 2]; 6] = [
    [2100, 2100],
    [1, 1],
    [5000, 3],
    [37, 53],
    [1, 4000],
    [64, 64],
];

/// An image that is nowhere like another one, and changes slowly from pixel to pixel.
fn image(number: usize, [width, height]: [u32; 2]) -> Image {
    let colour = |x: u32, y: u32| {
        let at = Vec2::new(x as f32 / width as f32, y as f32 / height as f32);
        let turn = std::f32::consts::TAU * (at + 0.13 * number as f32);
        let wave = Vec3::new(turn.x.sin(), turn.y.cos(), (turn.x + turn.y).sin());
        0.5 + 0.45 * wave
    };
    Image {
        path: format!("{number}.png"),
        width,
        height,
        pixels: (0..height)
            .flat_map(|y| (0..width).map(move |x| colour(x, y)))
            .collect(),
    }
}

/// A wall of cubes, each with an image of its own on its face.
fn wall() -> Scene {
    let text = format!(
        "
for i in range({count}):
    show(box(0.96).move(((i % 3) - 1, 0.5 - i // 3, 0)), material(color = hsv(60 * i, 1, 1)))
camera(eye = (0, 0, 5), target = (0, 0, 0), lens = orthographic(2.2))
",
        count = IMAGES.len()
    );
    let options = Options {
        size: Some(SIZE),
        ..Options::default()
    };
    let mut scene = load_text("images.star", &text, Language::Starlark, None, &options)
        .unwrap_or_else(|e| panic!("{}", e.report))
        .scene;
    scene
        .edit(|s| {
            s.settings.antialias = Antialias::None;
            for (k, size) in IMAGES.into_iter().enumerate() {
                let material = usize::from(s.objects[k].material);
                s.materials[material].pattern = Pattern::Triplanar {
                    image: Arc::new(image(k, size)),
                    size: 0.9,
                    sharpness: 4.0,
                };
            }
        })
        .expect("a scene");
    scene
}

/// The mean difference of the colours of surfaces, where both films show one.
fn apart(film: &Film, reference: &Film) -> f32 {
    let hits = reference.plane(Plane::Object).iter();
    let albedos = |film: &Film| film.plane(Plane::Albedo).as_chunks::<3>().0.to_vec();
    let pairs = albedos(film).into_iter().zip(albedos(reference));
    let (mut sum, mut count) = (0.0, 0.0);
    for ((a, b), _) in pairs.zip(hits).filter(|(_, object)| **object > 0.0) {
        sum += Vec3::from(a).distance(Vec3::from(b));
        count += 1.0;
    }
    assert!(count > 1000.0, "{count} pixels show an image");
    sum / count
}

#[test]
fn images_are_the_same_on_every_renderer() {
    let scene = wall();
    let film = on(&CpuRenderer::new(None).unwrap(), &scene);
    let right = reference(&scene);
    none(check("images", &scene, &film, &right).into_iter().collect());
    let Some(gpu) = testing::renderer("images on the GPU") else {
        return;
    };
    let by_gpu = on(&gpu, &scene);
    none(
        check("images on the GPU", &scene, &by_gpu, &right)
            .into_iter()
            .collect(),
    );
    let apart = apart(&by_gpu, &right);
    assert!(apart < 1e-3, "{apart}");
}
