//! What is said to be proven is held against closed forms, and what is wrong is found.

use std::sync::Arc;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::Silent;
use zeroset_trace::certify::{Certificate, Verdict};
use zeroset_trace::why::End;
use zeroset_trace::{CpuRenderer, PreparedScene};

const SIZE: [u32; 2] = [80, 60];

fn prepared(text: &str) -> PreparedScene {
    let options = Options {
        bare: true,
        ..Options::default()
    };
    let loaded = load_text("proof.star", text, Language::Starlark, None, &options);
    let scene = loaded.unwrap_or_else(|e| panic!("{text}: {e}")).scene;
    let renderer = CpuRenderer::new(Some(2)).expect("threads");
    renderer.prepare_scene(Arc::new(scene)).expect("a scene")
}

fn certificate(text: &str) -> Certificate {
    prepared(text)
        .certify(SIZE, &Silent)
        .expect("a certificate")
}

const CAMERA: &str =
    "camera(eye = (3, 2.2, 5), target = (0, 0.6, 0), fov = 40)\nrender(aa = none())";

#[test]
fn bounds_are_proven() {
    for (name, shapes) in [
        ("a ball", "show(sphere(1))"),
        (
            "a box on a floor",
            "show(box().move(y = 0.5))\nshow(plane())",
        ),
        (
            "a twisted bar",
            "show(box((0.6, 2, 0.6)).twist(90).move(y = 1) | plane())",
        ),
        (
            "smooth joins",
            "show(sphere(0.6).smooth_union(box().move(x = 0.6), radius = 0.3) - cylinder(0.2, 4))",
        ),
        (
            "a formula",
            "show(field(lambda p: length(p) - 0.8 + 0.1 * sin(6 * p.x) * sin(6 * p.y), size = 4))",
        ),
        ("copies", "show(sphere(0.2).repeat(0.6, count = 3))"),
    ] {
        let found = certificate(&format!("{shapes}\n{CAMERA}"));
        assert!(
            found.proven() >= 0.999,
            "{name}: {} are proven",
            found.proven()
        );
        assert_eq!(found.count(Verdict::Wrong), 0, "{name}");
        assert!(found.count(Verdict::Hit) > 100, "{name}");
    }
}

/// A ball in closed form: a pixel is said to be hit or missed just where it is.
#[test]
fn verdicts_are_right() {
    let found =
        certificate("show(sphere(1))\ncamera(eye = (0, 0, 4), fov = 40)\nrender(aa = none())");
    let pixel = 2.0 * 20f64.to_radians().tan() / f64::from(SIZE[1]);
    for (i, verdict) in found.verdicts.iter().enumerate() {
        let (x, y) = (i % SIZE[0] as usize, i / SIZE[0] as usize);
        let u = (x as f64 + 0.5 - f64::from(SIZE[0]) / 2.0) * pixel;
        let v = (y as f64 + 0.5 - f64::from(SIZE[1]) / 2.0) * pixel;
        // distance of the ray from the middle of the ball
        let aside = 4.0 * ((u * u + v * v) / (1.0 + u * u + v * v)).sqrt();
        match verdict {
            Verdict::Hit => assert!(aside < 1.0, "pixel {x}, {y}"),
            Verdict::Miss => assert!(aside > 1.0, "pixel {x}, {y}"),
            Verdict::Unknown => assert!((aside - 1.0).abs() < 1e-3, "pixel {x}, {y}"),
            Verdict::Wrong => panic!("pixel {x}, {y}"),
        }
    }
}

/// A slope that is stated too low makes holes: their pixels are wrong, and none of them counts as proven. Estimates are never proven.
#[test]
fn what_is_wrong_is_found() {
    let holes = "show(field(lambda p: 8 * (length(p) - 1), size = 4, slope = 1))";
    let found = certificate(&format!("{holes}\n{CAMERA}"));
    let right = certificate(&format!("show(sphere(1))\n{CAMERA}"));
    let (mut holes, mut claimed) = (0, 0);
    for (a, b) in found.verdicts.iter().zip(&right.verdicts) {
        holes += usize::from(*a == Verdict::Wrong && *b == Verdict::Hit);
        claimed += usize::from(*a == Verdict::Miss && *b == Verdict::Hit);
    }
    assert!(holes > 20, "{holes} holes");
    assert_eq!(claimed, 0);
    let fractal = certificate(&format!("show(mandelbulb())\n{CAMERA}"));
    assert_eq!(fractal.count(Verdict::Unknown), fractal.verdicts.len());
}

/// A picture with places moved by more than a pixel is not certified: the prover does not repeat what the picture says.
#[test]
fn a_picture_that_lies_is_refused() {
    let scene = prepared(&format!("show(sphere(1))\n{CAMERA}"));
    let film = |change: &dyn Fn(f32) -> f32| -> Film {
        let planes = [Plane::Depth, Plane::Coverage];
        let mut film = scene.render_part(SIZE, &planes, &Silent).1;
        film.plane_mut(Plane::Depth)
            .iter_mut()
            .for_each(|t| *t = change(*t));
        film
    };
    let proven = |film: &Film| scene.certify_film(film, &Silent).expect("a certificate");
    let honest = proven(&film(&|t| t));
    let nearer = proven(&film(&|t| t - 0.3));
    let farther = proven(&film(&|t| t + 0.3));
    assert!(honest.count(Verdict::Hit) > 500);
    assert_eq!(
        (nearer.count(Verdict::Hit), farther.count(Verdict::Hit)),
        (0, 0)
    );
    assert_eq!(
        farther.count(Verdict::Wrong),
        honest.count(Verdict::Hit) + honest.count(Verdict::Unknown)
    );
}

/// The steps of a ray are those of Hart's march towards a ball: each as long as the distance, which a formula gives.
#[test]
fn a_pixel_is_explained() {
    let balls = "show(sphere(1), name = \"ball\")\nshow(sphere(0.3).move((0, 1.6, 0)), name = \"moon\")\n\
        camera(eye = (0, 0, 4), fov = 40)\nrender(aa = none())";
    let scene = prepared(balls);
    let distance = |p: [f64; 3]| {
        let ball = |y: f64, r: f64| (p[0] * p[0] + (p[1] - y).powi(2) + p[2] * p[2]).sqrt() - r;
        ball(0.0, 1.0).min(ball(1.6, 0.3))
    };
    for (pixel, end, verdict, object) in [
        ([40, 30], End::Surface, Verdict::Hit, Some(0)),
        ([40, 2], End::Surface, Verdict::Hit, Some(1)),
        ([0, 0], End::Left, Verdict::Miss, None),
    ] {
        let why = scene.why(SIZE, pixel, 1000);
        assert_eq!((why.end, why.verdict), (end, verdict), "{pixel:?}");
        assert_eq!(why.hit.and_then(|hit| hit.object), object, "{pixel:?}");
        assert!(!why.steps.is_empty() && !why.inside);
        let mut t = 0.0;
        for step in &why.steps {
            let at = |k: usize| f64::from(why.origin[k]) + f64::from(why.direction[k]) * step.t;
            let expected = distance([at(0), at(1), at(2)]);
            assert!((step.t - t).abs() < 1e-9);
            assert!(
                (step.value - expected).abs() < 1e-6,
                "{step:?} for {expected}"
            );
            assert!((step.slope - 1.0).abs() < 1e-6);
            t += step.value;
        }
        if let (Some(hit), Some(last)) = (why.hit, why.steps.last()) {
            assert!((f64::from(hit.t) - last.t).abs() < why.footprint);
            assert_eq!(last.object, object);
        }
    }
    assert_eq!(scene.why(SIZE, [40, 30], 1).end, End::Steps);
    let within = prepared("show(sphere(1))\ncamera(eye = (0, 0, 0.5))").why(SIZE, [3, 4], 1000);
    assert!(
        within.inside && within.verdict == Verdict::Hit,
        "{within:?}"
    );
}
