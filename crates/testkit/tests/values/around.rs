//! Light from all around, by images whose light is known, in every way of light.

use crate::known::{Draw, loaded, value};
use crate::on;
use std::path::Path;
use zeroset::scene::film::Plane;
use zeroset::trace::CpuRenderer;

/// A file of Radiance, plain rows, of what `colour` says at each pixel.
fn image(at: &Path, [width, height]: [u32; 2], colour: impl Fn(u32, u32) -> [f32; 3]) {
    let mut bytes =
        format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for y in 0..height {
        for x in 0..width {
            let c = colour(x, y);
            let most = c.into_iter().fold(1e-30f32, f32::max);
            let exponent = most.log2().floor() as i32 + 1;
            let scale = (8.0 - exponent as f32).exp2();
            bytes.extend(c.map(|x| (x * scale).round().min(255.0) as u8));
            bytes.push((exponent + 128) as u8);
        }
    }
    std::fs::write(at, bytes).expect("a file");
}

/// A floor with a ball on it, matte and glossy, under a sky.
fn scene(sky: &str, integrator: &str) -> String {
    format!(
        "{sky}\nsun(strength = 0)\nshow(plane(), material(color = \"#cccccc\", roughness = 1, specular = 0))\n\
         show(sphere(0.5).move(y = 0.5), material(color = \"#aa8866\", roughness = 0.6))\n\
         show(sphere(0.3).move(x = 0.9, y = 0.3), material(metallic = 1, roughness = 0.05))\n\
         camera(eye = (0.5, 1, 3), target = (0.3, 0.3, 0), fov = 40)\n\
         render(aa = supersample(64, \"box\"), integrator = {integrator}, ao = cones())"
    )
}

/// An image of one colour is a sky of one colour.
fn one_colour(draw: Draw, folder: &Path) {
    image(&folder.join("grey.hdr"), [16, 8], |_, _| [0.5, 0.25, 1.0]);
    for (integrator, most) in [
        ("whitted()", 0.02),
        ("path(depth = 4)", 0.05),
        ("direct()", 0.02),
    ] {
        let solid = "sky(color = rgb(0.735357, 0.537099, 1), ambient = 0.8)";
        let shown = "sky(image = \"grey.hdr\", ambient = 0.8, turn = 33)";
        let [a, b] = [solid, shown]
            .map(|sky| draw(&loaded(&scene(sky, integrator), [32, 24], Some(folder))));
        let (mut worst, mut sum, mut all) = (0.0f64, 0.0, 0.0);
        for y in 0..24 {
            for x in 0..32 {
                let (a, b) = (
                    value(&a, Plane::Colour, x, y),
                    value(&b, Plane::Colour, x, y),
                );
                worst = worst.max((a - b).abs().max_element());
                sum += (a - b).element_sum();
                all += a.element_sum();
            }
        }
        let off = (sum / all).abs();
        assert!(
            worst < 4.0 * most && off < 0.5 * most,
            "{integrator}: {worst} {off}"
        );
    }
}

/// A lamp in a dark image lights a floor as much as its part of all directions says, wherever it is turned to.
fn lamp(draw: Draw, folder: &Path) {
    // one of 64 x 32 pixels, a little below the middle between the horizon and straight up
    let bright = 400.0f32;
    image(&folder.join("lamp.hdr"), [64, 32], |x, y| match (x, y) {
        (40, 9) => [bright; 3],
        _ => [0.0; 3],
    });
    // what is mixed of four pixels has the light of the one
    let theta = (9.5f64 / 32.0) * std::f64::consts::PI;
    let angle = theta.sin() * (std::f64::consts::PI / 32.0) * (std::f64::consts::TAU / 64.0);
    let right = f64::from(bright) * angle * theta.cos() / std::f64::consts::PI;
    for turn in [0, 130] {
        let text = format!(
            "sky(image = \"lamp.hdr\", turn = {turn})\nsun(strength = 0)\n\
             show(plane(), material(color = \"white\", roughness = 1, specular = 0))\n\
             camera(eye = (0, 3, 0.01), target = (0, 0, 0), fov = 30)\n\
             render(aa = supersample(64, \"box\"), integrator = path(depth = 2))"
        );
        let film = draw(&loaded(&text, [16, 16], Some(folder)));
        let sum: f32 = film.plane(Plane::Colour).iter().sum();
        let found = f64::from(sum) / (3.0 * 256.0);
        assert!(
            (found / right - 1.0).abs() < 0.03,
            "turned by {turn}: {found} instead of {right}"
        );
    }
}

#[test]
fn images_light_as_skies_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let renderer = CpuRenderer::new(None).unwrap();
    one_colour(&|scene| on(&renderer, scene), folder.path());
    lamp(&|scene| on(&renderer, scene), folder.path());
}

#[test]
fn images_light_as_skies_do_on_the_gpu() {
    let Some(gpu) = zeroset::gpu::testing::renderer("images all around on the GPU") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    one_colour(&|scene| on(&gpu, scene), folder.path());
    lamp(&|scene| on(&gpu, scene), folder.path());
}
