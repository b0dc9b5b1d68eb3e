//! Every marcher, against the plain one and against a dense march.

use crate::compare::{beside_edge, same};
use crate::scenes::{blend, quick, reference, stream, tomczak};
use std::sync::Arc;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::Silent;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{March, Settings, Shadow};
use zeroset_testkit::plain::dense;
use zeroset_trace::CpuRenderer;
use zeroset_trace::bench::city;

pub const MARCHERS: [March; 6] = [
    March::Fixed { step: 0.02 },
    March::Sphere,
    March::Relaxed { omega: 1.2 },
    March::Relaxed { omega: 1.7 },
    March::Enhanced { share: 0.9 },
    March::Auto { beta: 0.3 },
];

#[test]
fn stream_and_plain_agree() {
    for march in MARCHERS {
        for prepass in [true, false] {
            for mut scene in [tomczak(), blend()] {
                scene
                    .edit(|s| {
                        s.settings = Settings {
                            march,
                            prepass,
                            max_steps: 2000,
                            ..quick()
                        };
                        s.camera.far = 30.0;
                    })
                    .expect("a scene");
                same(
                    &scene,
                    &stream(&scene),
                    &reference(&scene),
                    &format!("{} with {march:?}, {prepass}", scene.name()),
                );
            }
        }
    }
}

/// What a dense march in double precision finds through the middle of every pixel.
fn oracle(scene: &Scene) -> Vec<Option<f64>> {
    let picture = CpuRenderer::new(Some(1))
        .expect("threads")
        .prepare_scene(scene.clone().into())
        .map(|p| p.program().clone());
    let program = picture.expect("a program");
    let [width, height] = scene.settings().size;
    let (slope, constant) = scene.camera().pixel_width(height);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let march = |(x, y): (u32, u32)| {
        let (o, d) = scene
            .camera()
            .ray(x as f32 + 0.5, y as f32 + 0.5, [width, height]);
        let [o, d] = [o, d].map(|v| v.to_array().map(f64::from));
        let least = |t: f64| 0.25 * (f64::from(slope) * t + f64::from(constant)) + 1e-6;
        dense::march(
            &program,
            o,
            d,
            f64::from(scene.camera().near),
            f64::from(scene.camera().far),
            least,
        )
    };
    pixels.map(march).collect()
}

/// Hits of the oracle that the film does not have, other than beside silhouettes.
fn missed(scene: &Scene, film: &Film, oracle: &[Option<f64>]) -> usize {
    let width = film.width() as usize;
    let (slope, constant) = scene.camera().pixel_width(film.height());
    let passed = |(i, t): (usize, &Option<f64>)| {
        let found = f64::from(film.plane(Plane::Depth)[i]);
        t.is_some_and(|t| found > t + 3.0 * (f64::from(slope) * t + f64::from(constant)))
            && !beside_edge(film, i % width, i / width)
    };
    oracle.iter().enumerate().filter(|&i| passed(i)).count()
}

#[test]
fn none_misses_what_a_dense_march_finds() {
    for mut scene in [tomczak(), blend(), city()] {
        scene
            .edit(|s| {
                s.camera.far = 25.0;
                s.settings = Settings {
                    size: [64, 48],
                    max_steps: 4000,
                    ..quick()
                };
            })
            .expect("a scene");
        let oracle = oracle(&scene);
        for march in MARCHERS {
            for prepass in [true, false] {
                scene
                    .edit(|s| {
                        s.settings.march = march;
                        s.settings.prepass = prepass;
                    })
                    .expect("a scene");
                let film = stream(&scene);
                assert_eq!(
                    missed(&scene, &film, &oracle),
                    0,
                    "{} with {march:?}, {prepass}",
                    scene.name()
                );
            }
        }
    }
}

#[test]
fn relaxation_and_cones_save_evaluations() {
    use zeroset_scene::render::{Renderer, Silent};
    let mut scene = city();
    let mut cost = |march, prepass| {
        scene
            .edit(|s| {
                s.settings = Settings {
                    size: [256, 256],
                    march,
                    prepass,
                    discontinuity_reduction: 0,
                    ..quick()
                }
            })
            .expect("a scene");
        let statistics = CpuRenderer::new(Some(2))
            .expect("threads")
            .render(&scene, &Silent)
            .expect("a picture")
            .statistics;
        (statistics.evaluations.march + statistics.evaluations.prepass) as f64
            / statistics.rays as f64
    };
    let sphere = cost(March::Sphere, false);
    let auto = cost(March::Auto { beta: 0.3 }, false);
    let cones = cost(March::Auto { beta: 0.3 }, true);
    assert!(auto < 0.95 * sphere, "{auto} a ray instead of {sphere}");
    assert!(cones < 0.66 * sphere, "{cones} a ray instead of {sphere}");
}

#[test]
fn rays_out_of_steps_take_their_best_candidate() {
    let mut scene = tomczak();
    scene
        .edit(|s| {
            s.camera.eye.y = 1.9;
            s.lights.iter_mut().for_each(|l| l.shadow = Shadow::None);
            s.settings = Settings {
                max_steps: 6,
                prepass: false,
                march: March::Sphere,
                discontinuity_reduction: 0,
                ..quick()
            };
        })
        .expect("a scene");
    for hit_selection in [true, false] {
        scene
            .edit(|s| s.settings.hit_selection = hit_selection)
            .expect("a scene");
        let what = format!("few steps, {hit_selection}");
        // a floor in closed form takes no steps
        let renderer = CpuRenderer::new(None).expect("threads");
        let marched = renderer
            .prepare_scene(Arc::new(scene.clone()))
            .expect("a scene")
            .without_closed_forms();
        let film = marched
            .render_part(scene.settings().size, &Plane::ALL, &Silent)
            .1;
        same(&scene, &film, &reference(&scene), &what);
    }
}
