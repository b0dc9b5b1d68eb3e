//! Depth of field and motion blur: circles of confusion by the equation of a thin lens, and the mean of pictures that stand still.

use crate::known::{Check, Draw, Found, SIZE, loaded, value};
use zeroset::language::load::{Language, Options, load_text};
use zeroset::scene::film::{Film, Plane};
use zeroset::scene::render::{Renderer, Silent};
use zeroset::trace::CpuRenderer;

pub const CHECKS: [Check; 2] = [
    Check {
        name: "circles of confusion through a lens",
        run: |draw| confusion(draw, "fov = 30"),
    },
    Check {
        name: "circles of confusion of a lens with parallel rays",
        run: |draw| confusion(draw, "lens = orthographic(2.2)"),
    },
];

/// A small lamp that nothing else lights, at a distance of 4, seen by a lens of radius 0.2 that is focused at `focus`.
fn lamp(lens: &str, focus: &str, samples: u32) -> String {
    format!(
        "sky(color = \"black\")\nshow(sphere(0.08), material(color = \"black\", specular = 0, emission = \"white\"))\n\
         sun(strength = 0)\ncamera(eye = (0, 0, 4), target = (0, 0, 0), {lens}, aperture = 0.2, focus = {focus})\n\
         render(ao = none(), aa = supersample({samples}, filter = \"box\"))"
    )
}

/// The light of a picture, and the mean square of how far it lies from the middle, in pixels.
fn spread(film: &Film) -> (f64, f64) {
    let (mut sum, mut squares) = (0.0, 0.0);
    let half = SIZE.map(|n| f64::from(n) / 2.0);
    for y in 0..SIZE[1] as usize {
        for x in 0..SIZE[0] as usize {
            let light = value(film, Plane::Colour, x, y).x;
            let (dx, dy) = (x as f64 + 0.5 - half[0], y as f64 + 0.5 - half[1]);
            sum += light;
            squares += light * (dx * dx + dy * dy);
        }
    }
    (sum, squares / sum)
}

/// An even disc of radius R has a mean square of R^2 / 2. A lens of radius a shows what is at the distance z, focused at f, as a disc of
/// radius a |1 / f - 1 / z| on the plane at distance 1, or a |1 - z / f| with parallel rays.
fn confusion(draw: Draw, lens: &str) -> Found {
    let height = SIZE[1] as f64;
    let is_pinhole = lens.contains("fov");
    let pixel = match is_pinhole {
        true => 2.0 * 15f64.to_radians().tan() / height,
        false => 2.2 / height,
    };
    let (a, z, ball) = (0.2, 4.0, 0.08);
    let mut whole = None;
    for (focus, said) in [
        (4.0, "(1, 2, 0)"),
        (2.0, "2"),
        (1.6, "(0.3, -1, 2.4)"),
        (12.0, "12"),
    ] {
        let film = draw(&loaded(&lamp(lens, said, 400), SIZE, None));
        let (light, found) = spread(&film);
        let (radius, own) = match is_pinhole {
            true => (a * (1.0f64 / focus - 1.0 / z).abs(), ball / z),
            false => (a * (1.0 - z / focus).abs(), ball),
        };
        // the ball's own disc, and the box of a pixel
        let right = (radius * radius + own * own) / (2.0 * pixel * pixel) + 1.0 / 6.0;
        // what is sharp lies on few pixels
        let is_right = match radius > 0.0 {
            true => (found / right - 1.0).abs() < 0.05,
            false => (found / right - 1.0).abs() < 0.15,
        };
        if !is_right {
            return Err(format!(
                "{lens}, focus {focus}: mean square {found:.3} instead of {right:.3}"
            ));
        }
        let whole = *whole.get_or_insert(light);
        if (light / whole - 1.0).abs() > 0.08 {
            return Err(format!(
                "focus {focus}: {light} of light instead of {whole}"
            ));
        }
    }
    Ok(())
}

/// One ray a pixel goes through the middle of the lens.
#[test]
fn without_samples_all_is_sharp() {
    let renderer = CpuRenderer::new(None).unwrap();
    let of = |text: &str| {
        let scene = loaded(text, SIZE, None);
        renderer.render(&scene, &Silent).expect("a picture").film
    };
    for aa in ["none()", "coverage()"] {
        let text = lamp("fov = 30", "2", 4).replace("supersample(4, filter = \"box\")", aa);
        let sharp = text.replace(", aperture = 0.2, focus = 2", "");
        assert!(text != sharp);
        assert_eq!(
            of(&text).plane(Plane::Colour),
            of(&sharp).plane(Plane::Colour)
        );
    }
}

fn moving(shutter: f64, time: f64, moments: bool) -> zeroset::scene::scene::Scene {
    let text = format!(
        "sky(color = \"black\")\nshow(sphere(0.4).move(x = 1.6 * time() - 0.8, y = 0.3 * sin(tau * time())), material(color = \"black\", specular = 0, \
         emission = \"white\"))\nsun(strength = 0)\n\
         camera(eye = (0.2 * time(), 0, 4), target = (0.2 * time(), 0, 0), fov = 40, shutter = {shutter}, moments = 16)\n\
         render(ao = none(), aa = supersample(64, filter = \"box\"))"
    );
    let options = Options {
        size: Some(SIZE),
        time,
        moments,
        ..Options::default()
    };
    let loaded = load_text("moving.star", &text, Language::Starlark, None, &options);
    loaded.expect("a scene").scene
}

fn blurred(renderer: &dyn Renderer) {
    let draw = |scene: &_| renderer.render(scene, &Silent).expect("a picture").film;
    let scene = moving(0.5, 0.25, true);
    assert_eq!(scene.moments().len(), 16);
    let film = draw(&scene);
    let mut mean = vec![0.0; film.plane(Plane::Colour).len()];
    for k in 0..16 {
        let still = draw(&moving(0.0, 0.25 + 0.5 * (f64::from(k) + 0.5) / 16.0, true));
        for (sum, x) in mean.iter_mut().zip(still.plane(Plane::Colour)) {
            *sum += x / 16.0;
        }
    }
    let film = film.plane(Plane::Colour);
    let worst = (film.iter().zip(&mean)).fold(0.0f32, |w, (a, b)| w.max((a - b).abs()));
    let off: f32 = film.iter().zip(&mean).map(|(a, b)| (a - b).abs()).sum();
    let all: f32 = mean.iter().sum();
    // four samples of each moment in place of 64
    assert!(worst < 0.08 && off < 0.05 * all, "{worst}, {off} of {all}");
    // and that is not what one of them shows
    let still = draw(&moving(0.0, 0.5, true));
    let off: f32 = (still.plane(Plane::Colour).iter().zip(&mean))
        .map(|(a, b)| (a - b).abs())
        .sum();
    assert!(off > 0.2 * all, "{off} of {all}");
}

#[test]
fn motion_blur_is_the_mean_of_still_pictures() {
    blurred(&CpuRenderer::new(None).unwrap());
}

#[test]
fn motion_blur_is_the_mean_of_still_pictures_on_the_gpu() {
    if let Some(gpu) = zeroset::gpu::testing::renderer("motion blur on the GPU") {
        blurred(&gpu);
    }
}

/// Without moments, and where nothing moves, there is one scene.
#[test]
fn what_stands_still_has_no_moments() {
    assert!(moving(0.0, 0.0, true).moments().is_empty());
    assert!(moving(0.5, 0.0, false).moments().is_empty());
    let still = "show(sphere())\ncamera(shutter = 1)";
    assert!(loaded(still, SIZE, None).moments().is_empty());
}
