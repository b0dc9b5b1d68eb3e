//! Floors and balls in closed form: the same pictures as by marching all, in fewer evaluations.

use std::sync::Arc;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Evaluations, Silent};
use zeroset_scene::scene::Scene;
use zeroset_trace::CpuRenderer;

const SIZE: [u32; 2] = [72, 54];
const PLANES: [Plane; 4] = [Plane::Colour, Plane::Depth, Plane::Normal, Plane::Object];

fn scene(text: &str) -> Scene {
    let options = Options {
        bare: true,
        ..Options::default()
    };
    let loaded = load_text("floor.star", text, Language::Starlark, None, &options);
    loaded.unwrap_or_else(|e| panic!("{text}: {e}")).scene
}

/// The picture with closed forms and without, and what each took.
fn both(text: &str) -> [(Film, Evaluations); 2] {
    let prepared = || {
        let renderer = CpuRenderer::new(Some(2)).expect("threads");
        renderer
            .prepare_scene(Arc::new(scene(text)))
            .expect("a scene")
    };
    [prepared(), prepared().without_closed_forms()].map(|prepared| {
        let (part, film) = prepared.render_part(SIZE, &PLANES, &Silent);
        (film, part.statistics.evaluations)
    })
}

/// Rows of numbers of a plane.
fn numbers(film: &Film, plane: Plane) -> &[f32] {
    film.plane(plane)
}

/// The share of pixels whose depth differs by more than a thousandth, and the mean difference of colours.
fn difference(a: &Film, b: &Film) -> (f32, f32) {
    let depth = numbers(a, Plane::Depth)
        .iter()
        .zip(numbers(b, Plane::Depth));
    let far = |(a, b): &(&f32, &f32)| {
        let both_miss = a.is_infinite() && b.is_infinite();
        !both_miss && (*a - *b).abs() > 1e-3 * a.abs().max(1.0)
    };
    let differing = depth.filter(far).count() as f32 / (SIZE[0] * SIZE[1]) as f32;
    let colour = numbers(a, Plane::Colour)
        .iter()
        .zip(numbers(b, Plane::Colour));
    let sum: f32 = colour.map(|(a, b)| (a - b).abs()).sum();
    (differing, sum / (3 * SIZE[0] * SIZE[1]) as f32)
}

const CAMERA: &str = "camera(eye = (3, 2.2, 5), target = (0, 0.6, 0), fov = 40)\n\
    sky(top = \"#9fb8d8\", horizon = \"#e6edf5\")\nsun(direction = (-1, -1.6, -0.7))\n";

#[test]
fn pictures_stay() {
    let one = "render(aa = none())";
    let path = "render(aa = supersample(4, filter = \"box\"), integrator = path(depth = 4))";
    let cases = [
        ("a box on a floor", format!("show(box().move(y = 0.5))\nshow(plane())\n{CAMERA}{one}"), 0.9),
        ("coincident faces", format!("show(box((1, 1, 1)).move(y = 0.5) | box((6, 0.0001, 6)) | plane())\n{CAMERA}{one}"), 1.0),
        ("a tilted floor and a wall", format!("show(torus() .move(y = 0.8) | plane().turn(z = 12) | plane().turn(x = 90).move(z = -2))\n{CAMERA}{one}"), 0.9),
        ("balls alone", format!("show(sphere(0.8).move(y = 0.5))\nshow(sphere(0.4).move((1.2, 0.2, 0.5)).scale(1.3))\n{CAMERA}{one}"), 0.2),
        ("balls in a floor", format!("show(sphere(0.8) | sphere(0.4).move(x = 1.2) | plane())\n{CAMERA}{one}"), 0.5),
        ("a floor alone", format!("show(plane())\n{CAMERA}{one}"), 0.7),
        ("hard shadows", format!("show(box().move(y = 0.9))\nshow(plane())\ncamera(eye = (3, 2.2, 5), fov = 40)\nsun(direction = (-1, -1.6, -0.7), shadow = hard())\n{one}"), 0.9),
        ("a mirror", format!("show(sphere(0.7).move(y = 0.7), material(metallic = 1, roughness = 0))\nshow(box().move((1.5, 0.5, 0)))\nshow(plane())\n{CAMERA}{one}"), 0.9),
        ("glass on a floor", format!("show(sphere(0.7).move(y = 0.7), material(transmission = 1, roughness = 0))\nshow(box((0.6, 0.6, 0.6)).move((1.3, 0.3, 0)))\nshow(plane())\n{CAMERA}{one}"), 1.0),
        ("paths", format!("show(torus().move(y = 0.6))\nshow(plane())\n{CAMERA}{path}"), 0.9),
        ("parallel rays", format!("show(box().move(y = 0.5) | plane())\ncamera(eye = (3, 6, 5), lens = orthographic(3))\n{one}"), 0.9),
        ("a lens", "show(box().move(y = 0.5) | plane())\ncamera(eye = (3, 2.2, 5), fov = 40, aperture = 0.1)\nrender(aa = supersample(4, filter = \"box\"))".into(), 0.9),
        ("a floor that ends", format!("show(box().move(y = 0.5) | plane())\ncamera(eye = (3, 2.2, 5), fov = 40, far = 9)\n{one}"), 0.95),
        // where rays begin inside, all is marched
        ("from below", format!("show(box().move(y = 0.5) | plane())\ncamera(eye = (3, -1, 5), target = (0, 0.5, 0), fov = 40)\n{one}"), 1.0),
        ("from within", format!("show(box((4, 4, 4)) | plane())\ncamera(eye = (1, 1, 1), target = (0, 0.2, 0), fov = 60)\n{one}"), 1.0),
        ("at grazing angles", format!("show(box((0.2, 0.4, 0.2)).move(y = 0.2) | plane())\ncamera(eye = (0, 0.02, 3), target = (0, 0.02, 0), fov = 40)\n{one}"), 0.9),
    ];
    for (name, text, most) in cases {
        let [(with, few), (without, many)] = both(&text);
        let (depth, colour) = difference(&with, &without);
        // a pixel beside an edge may see what is behind it
        assert!(depth < 4e-3, "{name}: {depth} of the depths differ");
        assert!(colour < 4e-3, "{name}: colours differ by {colour}");
        let march = |taken: &Evaluations| (taken.prepass + taken.march) as f64;
        let share = march(&few) / march(&many);
        assert!(share <= most, "{name}: {share} of the march");
    }
}

/// Depths against f64: a floor that is far away, seen at a flat angle, and a small ball far away.
#[test]
fn places_are_exact() {
    let text = "show(plane().move(y = -1) | sphere(0.5).move((0.3, 2, -400)))\n\
        camera(eye = (0, 0.7, 0), target = (0, 0.7, -1), fov = 2, far = 100000)\nrender(aa = none())";
    let [(film, _), _] = both(text);
    let half = (1f64.to_radians()).tan();
    let mut seen = [0, 0];
    for (i, depth) in numbers(&film, Plane::Depth).iter().enumerate() {
        let (x, y) = (i % SIZE[0] as usize, i / SIZE[0] as usize);
        let pixel = 2.0 * half / f64::from(SIZE[1]);
        let u = (x as f64 + 0.5 - f64::from(SIZE[0]) / 2.0) * pixel;
        let v = (f64::from(SIZE[1]) / 2.0 - y as f64 - 0.5) * pixel;
        let length = (u * u + v * v + 1.0).sqrt();
        let d = [u / length, v / length, -1.0 / length];
        let to = [0.3, 1.3, -400.0];
        let along: f64 = (0..3).map(|k| to[k] * d[k]).sum();
        let aside: f64 = to.iter().map(|x| x * x).sum::<f64>() - along * along;
        let ball = (aside < 0.25).then(|| along - (0.25 - aside).sqrt());
        let floor = (d[1] < 0.0).then(|| -1.7 / d[1]);
        let nearest = ball.or(floor);
        match nearest {
            Some(t) if t < 90_000.0 => {
                seen[usize::from(ball.is_some())] += 1;
                let off = (f64::from(*depth) - t).abs() / t;
                assert!(off < 3e-5, "pixel {x}, {y}: {depth} for {t}");
            }
            Some(_) => {}
            None => assert!(!depth.is_finite(), "pixel {x}, {y}: {depth} for nothing"),
        }
    }
    assert!(seen[0] > 500 && seen[1] > 5, "{seen:?}");
}
