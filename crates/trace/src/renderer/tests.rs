use super::*;
use crate::bench::sphere_box_ground;
use crate::stop::INTERVAL;
use std::sync::atomic::{AtomicU64, Ordering};
use zeroset_catalogue::entries::catalogue;
use zeroset_eval::BATCH;
use zeroset_field::field::Field;
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

/// All of a scene, or as much as there is when the observer ends it.
fn rendered(picture: &PreparedScene, observer: &dyn Observer) -> (Part, Film) {
    picture.render_part(picture.scene.settings().size, &Plane::ALL, observer)
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
            let picture = renderer.prepare_scene(Arc::new(scene.clone())).unwrap();
            let (part, _) = rendered(&picture, &Silent);
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
            let picture = renderer.prepare_scene(Arc::new(scene.clone())).unwrap();
            let instructions = picture.program.structure().values.instructions.len() as u64;
            for asked in [1, 25, 60] {
                let (part, _) = rendered(&picture, &Impatient::after(asked));
                assert!(!part.is_whole, "{name}");
                // between two questions lies at most this; 250 ms would be some thousand times as much
                // (the search of a ray that ran out of steps is one piece of work)
                let most = 3 * INTERVAL / instructions + BATCH as u64;
                let most = most * (asked + threads as u64 + 1);
                assert!(part.spent <= most, "{name}: {} of {most}", part.spent);
                let error = renderer.render(&scene, &Impatient::after(0)).err();
                assert_eq!(error, Some(RenderError::Cancelled), "{name}");
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
        let picture = renderer.prepare_scene(Arc::new(scene.clone())).unwrap();
        let (part, whole) = rendered(&picture, &Silent);
        assert!(part.is_whole);
        let (count, mut seen) = (Area::count([200, 100]), 0);
        for asked in (1..).step_by(9) {
            let (part, film) = rendered(&picture, &Impatient::after(asked));
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

/// Samples that are added in turns are the samples that are taken at once, up to the order of additions.
#[test]
fn samples_can_be_added_later() {
    let renderer = CpuRenderer::new(Some(2)).unwrap();
    let mut scene = sphere_box_ground();
    let antialias = Antialias::Supersample {
        samples: 7,
        filter: Filter::Mitchell,
    };
    scene
        .edit(|s| (s.settings.size, s.settings.antialias) = ([100, 70], antialias))
        .unwrap();
    let (camera, settings) = (*scene.camera(), *scene.settings());
    let at_once = renderer.render(&scene, &Silent).unwrap().film;
    let mut prepared = renderer.prepare(Arc::new(scene)).unwrap();
    let empty = || Accumulator::new(settings.size, settings.antialias, &Plane::ALL);
    let mut sums = empty();
    // groups of samples that share their occlusion, and where each begins in the middle of one
    for (turns, tolerance) in [(vec![0..4, 4..7], 1e-4), (vec![0..1, 1..4, 4..7], 0.05)] {
        for samples in turns {
            prepared
                .sample(&camera, samples, &mut sums, &Silent)
                .unwrap();
        }
        assert_eq!(sums.samples(), 7);
        let in_turns = std::mem::replace(&mut sums, empty()).into_film();
        for plane in Plane::ALL {
            let pairs = at_once.plane(plane).iter().zip(in_turns.plane(plane));
            for (a, b) in pairs.filter(|(a, _)| a.is_finite()) {
                assert!(
                    (a - b).abs() <= tolerance * a.abs().max(1.0),
                    "{plane:?}: {a}, {b}"
                );
            }
        }
    }
}

/// What a scene is updated to is what is rendered, whether or not its field is another one.
#[test]
fn updated_scenes_are_new_scenes() {
    let renderer = CpuRenderer::new(Some(2)).unwrap();
    let mut scene = sphere_box_ground();
    scene.edit(|s| s.settings.size = [64, 48]).unwrap();
    let mut prepared = renderer.prepare(Arc::new(scene.clone())).unwrap();
    let mut check = |scene: &Scene| {
        let settings = scene.settings();
        prepared.update(Arc::new(scene.clone())).unwrap();
        let mut sums = Accumulator::new(settings.size, settings.antialias, &Plane::ALL);
        let samples = 0..sums.wanted();
        prepared
            .sample(scene.camera(), samples, &mut sums, &Silent)
            .unwrap();
        let fresh = renderer.render(scene, &Silent).unwrap().film;
        assert!(sums.into_film() == fresh);
    };
    check(&scene);
    let plain = |s: &mut zeroset_scene::scene::SceneParts| {
        s.settings.occlusion = Occlusion::None;
        s.lights.clear();
    };
    scene.edit(plain).unwrap();
    check(&scene);
    let ball = Field::primitive(&catalogue().primitives[0], vec![0.4]).unwrap();
    scene.edit(|s| s.objects[0].field = ball).unwrap();
    check(&scene);
}
