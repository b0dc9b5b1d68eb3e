//! Threads, sizes, scales, odd cameras, empty scenes.

use crate::compare::same;
use crate::scenes::{blend, moved, object, quick, reference, shape, stream, tomczak, view};
use fearless_simd::Level;
use zeroset_field::placement::Placement;
use zeroset_scene::camera::Lens;
use zeroset_scene::film::{self, Film, Plane};
use zeroset_scene::render::{RenderError, Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter, Occlusion, Settings};
use zeroset_trace::CpuRenderer;

fn bits(film: &Film) -> Vec<u32> {
    Plane::ALL
        .iter()
        .flat_map(|p| film.plane(*p))
        .map(|x| x.to_bits())
        .collect()
}

#[test]
fn threads_do_not_change_the_picture() {
    for mut scene in [tomczak(), blend()] {
        for antialias in [
            Antialias::None,
            Antialias::Supersample {
                samples: 3,
                filter: Filter::Mitchell,
            },
        ] {
            for occlusion in [
                Occlusion::Cones {
                    reach: None,
                    steps: 14,
                },
                Occlusion::Hemisphere {
                    rays: 4,
                    reach: Some(1.0),
                },
            ] {
                scene
                    .edit(|s| {
                        s.settings = Settings {
                            size: [150, 75],
                            antialias,
                            occlusion,
                            ..quick()
                        }
                    })
                    .expect("a scene");
                let render = |threads| {
                    CpuRenderer::new(Some(threads))
                        .expect("threads")
                        .render(&scene, &Silent)
                };
                let first = bits(&render(1).expect("a picture").film);
                for threads in 2..=4 {
                    assert!(
                        bits(&render(threads).expect("a picture").film) == first,
                        "{threads} threads"
                    );
                }
            }
        }
    }
}

/// Tiles are independent: a picture is the same whichever of them share a thread and whichever rays share a batch.
#[test]
fn a_second_rendering_is_equal() {
    let scene = blend();
    let renderer = CpuRenderer::new(Some(2)).expect("threads");
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let rendered = |planes| picture.render_part([96, 72], planes, &Silent).1;
    let films = [rendered(&Plane::ALL), rendered(&Plane::ALL)];
    assert!(bits(&films[0]) == bits(&films[1]));
    // with some planes only, those are equal
    let colour = rendered(&[Plane::Colour]);
    assert_eq!(colour.plane(Plane::Colour), films[0].plane(Plane::Colour));
}

/// Sums of samples are kept for some rows of tiles at a time: how many there are does not change a bit, for any filter, whatever
/// the number of threads.
#[test]
fn limited_sums_are_equal() {
    for filter in [Filter::Box, Filter::Tent, Filter::Mitchell] {
        let mut scene = blend();
        scene
            .edit(|s| {
                s.settings = Settings {
                    antialias: Antialias::Supersample { samples: 2, filter },
                    ..quick()
                }
            })
            .expect("a scene");
        // seven rows of tiles, the last one of a few lines
        scene
            .edit(|s| s.settings.size = [70, 198])
            .expect("a scene");
        let row = 2 * 70_000;
        let render = |threads, sums| {
            let renderer = CpuRenderer::new(Some(threads)).expect("threads");
            bits(
                &renderer
                    .with_sums(sums)
                    .render(&scene, &Silent)
                    .expect("a picture")
                    .film,
            )
        };
        let whole = render(1, 100 * row);
        for rows in [0, 1, 2, 3, 4, 5, 6, 7, 8, 9] {
            assert!(
                render(1 + rows as usize % 3, rows * row) == whole,
                "{rows} rows with {filter:?}"
            );
        }
    }
}

/// What the renderer takes beside the film is what a scene is charged for before it is rendered.
#[test]
fn sums_are_not_more_than_charged() {
    for size in [
        [1, 1],
        [64, 32],
        [65, 33],
        [1920, 1080],
        [8192, 8192],
        [100_000, 2],
        [2, 100_000],
        [67_108_864, 1],
    ] {
        let bytes = zeroset_trace::sums(size);
        let charged = film::scratch(size);
        assert!(bytes <= charged, "{bytes} of {charged} bytes at {size:?}");
        assert!(
            charged <= 2 * bytes + (1 << 16),
            "{bytes} of {charged} bytes at {size:?}"
        );
    }
}

#[test]
fn every_width_of_vectors_agrees() {
    let scene = blend();
    let renderer = CpuRenderer::new(Some(1))
        .expect("threads")
        .with_level(Level::baseline());
    same(
        &scene,
        &renderer.render(&scene, &Silent).expect("a picture").film,
        &reference(&scene),
        "baseline",
    );
}

#[test]
fn odd_sizes() {
    for size in [[1, 1], [2, 1], [1, 40], [65, 33], [7, 100]] {
        for antialias in [
            Antialias::None,
            Antialias::Supersample {
                samples: 2,
                filter: Filter::Tent,
            },
        ] {
            let mut scene = blend();
            scene
                .edit(|s| {
                    s.settings = Settings {
                        size,
                        antialias,
                        ..quick()
                    }
                })
                .expect("a scene");
            let (a, b) = (stream(&scene), reference(&scene));
            assert_eq!([a.width(), a.height()], size);
            for (p, q) in a.plane(Plane::Colour).iter().zip(b.plane(Plane::Colour)) {
                assert!(p.is_finite() && q.is_finite());
            }
            let mean = |f: &Film| {
                f.plane(Plane::Colour).iter().sum::<f32>() / f.plane(Plane::Colour).len() as f32
            };
            assert!(
                (mean(&a) - mean(&b)).abs() < 0.02,
                "{size:?}: {} instead of {}",
                mean(&a),
                mean(&b)
            );
        }
    }
}

#[test]
fn nothing_is_sky() {
    let mut scene = view([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], 0.8);
    scene.edit(|s| s.settings.size = [20, 10]).expect("a scene");
    let film = stream(&scene);
    assert!(film.plane(Plane::Coverage).iter().all(|c| *c == 0.0));
    assert!(film.plane(Plane::Depth).iter().all(|t| *t == f32::INFINITY));
    assert!(film.plane(Plane::Object).iter().all(|o| *o == 0.0));
    assert!(film.plane(Plane::Colour).iter().all(|c| *c > 0.0));
}

#[test]
fn a_camera_within_the_solid() {
    let mut scene = view([0.1, 0.2, 0.1], [1.0, 0.4, -0.3], 1.2);
    scene
        .edit(|s| s.objects.push(object(shape("box", &[2.0, 2.0, 2.0]), 0)))
        .expect("a scene");
    let film = stream(&scene);
    same(&scene, &film, &reference(&scene), "inside");
    assert!(film.plane(Plane::Object).iter().all(|o| *o == 1.0));
    assert!(film.plane(Plane::Depth).iter().all(|t| *t < 2.0));
    // normals look inwards
    let (o, d) = scene.camera().ray(48.0, 36.0, scene.settings().size);
    let at = 36 * 96 + 48;
    let normal = glam::Vec3::from_slice(&film.plane(Plane::Normal)[3 * at..][..3]);
    assert!(normal.dot(d) < -0.3 && o.length() < 1.0);
}

fn scaled(scene: &Scene, scale: f32) -> Scene {
    let mut scene = scene.clone();
    scene
        .edit(|s| {
            for object in &mut s.objects {
                object.field = object
                    .field
                    .place(Placement::scaled(f64::from(scale)))
                    .expect("a place");
            }
            s.camera.eye *= scale;
            s.camera.far *= scale;
            if let Lens::Orthographic { height } = &mut s.camera.lens {
                *height *= scale;
            }
        })
        .expect("a scene");
    scene
        .edit(|s| {
            if let Occlusion::Quilez {
                step,
                scale: strength,
                ..
            } = &mut s.settings.occlusion
            {
                *step *= scale;
                *strength /= scale;
            }
        })
        .expect("a scene");
    scene
}

#[test]
fn scale_does_not_matter() {
    let scene = tomczak();
    let right = stream(&scene);
    for scale in [1.0 / 512.0, 512.0] {
        let mut film = stream(&scaled(&scene, scale));
        for plane in [Plane::Depth, Plane::Residual] {
            film.plane_mut(plane).iter_mut().for_each(|t| *t /= scale);
        }
        same(&scene, &film, &right, &format!("{scale} times as large"));
    }
}

#[test]
fn far_from_the_origin() {
    // single precision holds 1/16 at most a million away: it must end in a picture, not in a hang or holes
    let mut scene = tomczak();
    scene
        .edit(|s| {
            for object in &mut s.objects[..2] {
                object.field = moved(&object.field, [4096.0, 0.0, -4096.0]);
            }
            s.camera.eye += glam::Vec3::new(4096.0, 0.0, -4096.0);
        })
        .expect("a scene");
    let film = stream(&scene);
    same(&scene, &film, &reference(&scene), "far away");
    let near = stream(&tomczak());
    let covered = |f: &Film| f.plane(Plane::Coverage).iter().sum::<f32>();
    assert!((covered(&film) - covered(&near)).abs() < 0.01 * covered(&near));
}

#[test]
fn a_bare_plane_is_wholly_open() {
    for eye in [[0.0, 1.0, 3.0], [5.0, 0.3, -2.0], [0.0, 20.0, 0.1]] {
        let mut scene = view(eye, [0.0, 0.0, 0.0], 0.7);
        scene
            .edit(|s| {
                s.objects.push(object(shape("plane", &[]), 0));
                s.settings.occlusion = Occlusion::Cones {
                    reach: None,
                    steps: 14,
                };
            })
            .expect("a scene");
        for film in [stream(&scene), reference(&scene)] {
            let pixels = film
                .plane(Plane::Occlusion)
                .iter()
                .zip(film.plane(Plane::Object));
            let open: Vec<f32> = pixels.filter(|(_, o)| **o > 0.0).map(|(v, _)| *v).collect();
            assert!(open.len() > 1000 && open.iter().all(|v| *v == 1.0));
        }
    }
}

#[test]
fn a_rendering_can_be_cancelled() {
    let renderer = CpuRenderer::new(Some(1)).expect("threads");
    let stop = std::sync::atomic::AtomicBool::new(true);
    assert_eq!(
        renderer.render(&blend(), &stop).err(),
        Some(RenderError::Cancelled)
    );
}
