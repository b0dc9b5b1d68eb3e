use super::*;
use crate::bench::sphere_box_ground;
use crate::stop::INTERVAL;
use std::sync::atomic::{AtomicU64, Ordering};
use zeroset_eval::BATCH;
use zeroset_scene::render::Silent;
use zeroset_scene::settings::{Filter, March, Normals, Settings};

/// Wants the rendering to end when it was asked often enough.
struct Impatient {
    asked: AtomicU64,
    most: u64,
}

impl Impatient {
    fn after(most: u64) -> Impatient {
        Impatient {
            asked: AtomicU64::new(0),
            most,
        }
    }
}

impl Observer for Impatient {
    fn advance(&self, _rays: u64, _total: u64) {}
    fn is_cancelled(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.most
    }
}

/// Scenes that each spend most of their time in another stage.
fn slow() -> Vec<(&'static str, Scene)> {
    let with = |settings: &dyn Fn(&mut Settings)| {
        let mut scene = sphere_box_ground();
        scene
            .edit(|s| {
                s.settings.size = [512, 512];
                s.settings.antialias = Antialias::None;
                s.settings.occlusion = Occlusion::None;
            })
            .expect("a scene");
        scene.edit(|s| settings(&mut s.settings)).expect("a scene");
        scene
    };
    let reach = Some(1e3);
    let mut lit = with(&|_| {});
    lit.edit(|s| s.lights = vec![s.lights[0]; 64])
        .expect("a scene");
    let samples = Antialias::Supersample {
        samples: 4096,
        filter: Filter::Mitchell,
    };
    let quilez = Occlusion::Quilez {
        steps: 4096,
        step: 0.01,
        scale: 1.0,
    };
    let bent = Occlusion::Bent {
        steps: 4096,
        step: 0.01,
        scale: 1.0,
        bend: 0.1,
    };
    let cones = Occlusion::Cones { reach, steps: 4096 };
    let hemisphere = Occlusion::Hemisphere { rays: 4096, reach };
    let obscurance = Occlusion::Obscurance {
        rays: 4096,
        reach,
        tau: 1.0,
    };
    let fixed = March::Fixed { step: 1e-4 };
    vec![
        ("hemisphere", with(&|s| s.occlusion = hemisphere)),
        ("obscurance", with(&|s| s.occlusion = obscurance)),
        ("cones", with(&|s| s.occlusion = cones)),
        ("quilez", with(&|s| s.occlusion = quilez)),
        ("bent", with(&|s| s.occlusion = bent)),
        ("lights", lit),
        ("samples", with(&|s| s.antialias = samples)),
        (
            "steps",
            with(&|s| (s.march, s.max_steps, s.prepass) = (fixed, 100_000, false)),
        ),
        (
            "selected hits",
            with(&|s| {
                (s.march, s.max_steps, s.hit_selection) = (fixed, 100_000, true);
            }),
        ),
        (
            "rounds",
            with(&|s| {
                s.discontinuity_reduction = 16;
                s.normals = Normals::Samples26;
            }),
        ),
    ]
}

/// Without this the next test would prove nothing.
#[test]
fn every_evaluation_is_asked_for_before() {
    let renderer = CpuRenderer::new(Some(2)).unwrap();
    for (name, mut scene) in slow() {
        scene
            .edit(|s| {
                s.settings.size = [24, 16];
                s.lights.truncate(3);
                s.settings.max_steps = s.settings.max_steps.min(300);
                s.settings.discontinuity_reduction = s.settings.discontinuity_reduction.min(3);
            })
            .expect("a scene");
        let few = match scene.settings().occlusion {
            Occlusion::Hemisphere { reach, .. } => Occlusion::Hemisphere { rays: 3, reach },
            Occlusion::Obscurance { reach, tau, .. } => Occlusion::Obscurance {
                rays: 3,
                reach,
                tau,
            },
            Occlusion::Cones { reach, .. } => Occlusion::Cones { reach, steps: 3 },
            Occlusion::None => Occlusion::None,
            _ => Occlusion::Quilez {
                steps: 3,
                step: 0.1,
                scale: 1.0,
            },
        };
        scene
            .edit(|s| {
                s.settings.occlusion = few;
                if let Antialias::Supersample { samples, .. } = &mut s.settings.antialias {
                    *samples = 3;
                }
            })
            .expect("a scene");
        for normals in [Normals::Exact, Normals::Samples26, Normals::Tetrahedron] {
            scene
                .edit(|s| s.settings.normals = normals)
                .expect("a scene");
            let picture = renderer.prepare(&scene).unwrap();
            let mut film = Film::new(24, 16);
            let part = renderer.render_part(&picture, &mut film, &Silent);
            assert!(part.is_whole && part.spent > 0, "{name}");
            assert_eq!(part.spent, part.statistics.evaluations.total(), "{name}");
        }
    }
}

#[test]
fn work_ends_soon_after_it_is_not_wanted() {
    for threads in [1, 3] {
        let renderer = CpuRenderer::new(Some(threads)).unwrap();
        for (name, scene) in slow() {
            let picture = renderer.prepare(&scene).unwrap();
            let instructions = picture.program.structure().values.instructions.len() as u64;
            for asked in [1, 25, 60] {
                let mut film = Film::new(512, 512);
                let observer = Impatient::after(asked);
                let part = renderer.render_part(&picture, &mut film, &observer);
                assert!(!part.is_whole, "{name}");
                // between two questions lies at most this; 250 ms would be some thousand times as much
                // (the search of a ray that ran out of steps is one piece of work)
                let most = 3 * INTERVAL / instructions + BATCH as u64;
                let most = most * (asked + threads as u64 + 1);
                assert!(part.spent <= most, "{name}: {} of {most}", part.spent);
                let error = renderer.render_into(&picture, &mut film, &Impatient::after(0));
                assert_eq!(error, Err(RenderError::Cancelled), "{name}");
            }
        }
    }
}

#[test]
fn tiles_of_a_part_are_those_of_the_whole() {
    let renderer = CpuRenderer::new(Some(1)).unwrap();
    let mut scene = sphere_box_ground();
    scene
        .edit(|s| s.settings.size = [200, 100])
        .expect("a scene");
    for antialias in [
        Antialias::None,
        Antialias::Supersample {
            samples: 4,
            filter: Filter::Box,
        },
    ] {
        scene
            .edit(|s| s.settings.antialias = antialias)
            .expect("a scene");
        let picture = renderer.prepare(&scene).unwrap();
        let (mut whole, mut film) = (Film::new(200, 100), Film::new(200, 100));
        assert!(renderer.render_part(&picture, &mut whole, &Silent).is_whole);
        let (count, mut seen) = (Area::count([200, 100]), 0);
        for asked in (1..).step_by(9) {
            let observer = Impatient::after(asked);
            let part = renderer.render_part(&picture, &mut film, &observer);
            assert_eq!(part.is_whole, part.finished.len() == count);
            for plane in Plane::ALL {
                let channels = plane.channels();
                for &[x, y, width, height] in &part.finished {
                    for row in y..y + height {
                        let from = (row * 200 + x) as usize * channels;
                        let range = from..from + width as usize * channels;
                        let (a, b) = (
                            &film.plane(plane)[range.clone()],
                            &whole.plane(plane)[range],
                        );
                        assert!(a == b, "{plane:?}");
                    }
                }
            }
            if part.is_whole {
                break;
            }
            seen = seen.max(part.finished.len());
        }
        assert!(seen > 1, "{seen}");
    }
}
