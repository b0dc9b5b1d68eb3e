//! Which moment each sample sees, and what a renderer is asked for.

use std::ops::Range;
use std::sync::{Arc, Mutex};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::motion::{Moving, moment_of};
use zeroset_scene::render::{Observer, Prepared, RenderError, Silent, Statistics};
use zeroset_scene::scene::{MOMENTS, Scene, SceneParts};
use zeroset_scene::settings::{Antialias, Filter, Settings};

#[test]
fn moments_are_seen_alike() {
    for (wanted, count) in [(64, 16), (64, 32), (256, 32), (32, 32), (1024, 8)] {
        for seed in [0, 1, 77] {
            let mut seen = vec![0; count as usize];
            for index in 0..wanted {
                seen[moment_of(index, wanted, count, seed) as usize] += 1;
            }
            let even = wanted / count;
            assert!(
                seen.iter().all(|n| (even - 1..=even + 1).contains(n)),
                "{wanted} {count} {seed}: {seen:?}"
            );
        }
    }
    // the first few are spread over all of the time
    let first: Vec<u32> = (0..4).map(|i| moment_of(i, 16, 32, 0)).collect();
    assert_eq!(first, [0, 16, 8, 24]);
    // where there are many samples, four that share what changes slowly see one moment
    assert!((0..64).all(|i| moment_of(4 * i, 256, 16, 3) == moment_of(4 * i + 3, 256, 16, 3)));
}

/// What was asked for: the eyes of the scene and of the camera, the seed, the samples.
type Note = (f32, f32, u32, Range<u32>);

/// Notes what it is asked for: the eye's x stands for the scene.
struct Notes {
    scene: Arc<Scene>,
    notes: Arc<Mutex<Vec<Note>>>,
}

impl Prepared for Notes {
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError> {
        self.scene = scene;
        Ok(())
    }

    fn sample(
        &mut self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        _observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let (eye, seed) = (self.scene.camera().eye.x, self.scene.settings().seed);
        let note = (eye, camera.eye.x, seed, samples.clone());
        self.notes.lock().expect("notes").push(note);
        into.count(samples.len() as u32);
        Ok(Statistics {
            rays: samples.len() as u64,
            ..Statistics::default()
        })
    }

    fn reseed(&mut self, _seed: u32) -> Result<(), RenderError> {
        Ok(())
    }
}

fn scene(x: f32) -> Scene {
    let camera = Camera {
        eye: glam::Vec3::new(x, 0.0, 5.0),
        ..Camera::default()
    };
    let parts = SceneParts {
        camera,
        settings: Settings {
            size: [2, 1],
            antialias: Antialias::Supersample {
                samples: 8,
                filter: Filter::Box,
            },
            ..Settings::default()
        },
        ..SceneParts::default()
    };
    parts.build().expect("a scene")
}

#[test]
fn each_sample_is_taken_once_of_its_moment() {
    let moments = (1..=4).map(|k| scene(k as f32)).collect();
    let scene = Arc::new(scene(0.0).with_moments(moments).expect("moments"));
    let notes = Arc::new(Mutex::default());
    let inner = Notes {
        scene: Arc::clone(&scene),
        notes: Arc::clone(&notes),
    };
    let mut moving = Moving::new(Arc::clone(&scene), Box::new(inner));
    moving.reseed(5).expect("a seed");
    assert!(!moving.is_adaptive());
    let settings = *scene.settings();
    let mut sums = Accumulator::new(settings.size, settings.antialias, &[Plane::Colour]);
    let took = moving
        .sample(scene.camera(), 0..8, &mut sums, &Silent)
        .expect("samples");
    assert_eq!((took.rays, sums.samples()), (8, 8));
    let all = std::mem::take(&mut *notes.lock().expect("notes"));
    let mut seen = [0; 8];
    for (eye, camera, seed, samples) in all {
        // the camera moves with its scene
        assert_eq!((eye, seed), (camera, 5));
        for index in samples {
            let moment = moment_of(index, 8, 4, 5);
            assert_eq!(eye, moment as f32 + 1.0);
            seen[index as usize] += 1;
        }
    }
    assert_eq!(seen, [1; 8]);
    // a camera of one's own stands still
    let own = Camera {
        eye: glam::Vec3::new(9.0, 0.0, 5.0),
        ..*scene.camera()
    };
    moving
        .sample(&own, 0..8, &mut sums, &Silent)
        .expect("samples");
    let all = notes.lock().expect("notes");
    assert!(all.iter().all(|(_, camera, ..)| *camera == 9.0));
}

#[test]
fn changes_reach_all_moments() {
    let mut moving = scene(0.0)
        .with_moments(vec![scene(1.0), scene(2.0)])
        .expect("moments");
    let dim = |parts: &mut SceneParts| {
        parts.sky.ambient = 0.25;
        Ok::<(), zeroset_scene::valid::SceneError>(())
    };
    moving.edit_moments(dim).expect("a scene");
    assert_eq!(moving.moments().len(), 2);
    let dim = |scene: &Scene| scene.sky().ambient == 0.25;
    assert!(dim(&moving) && moving.moments().iter().all(|m| dim(m)));
    let too_bright = |parts: &mut SceneParts| {
        parts.sky.ambient = 99.0;
        Ok::<(), zeroset_scene::valid::SceneError>(())
    };
    assert!(moving.edit_moments(too_bright).is_err());
    assert!(dim(&moving));
    let camera = Camera {
        far: 7.0,
        ..*moving.camera()
    };
    let still = moving.clone().with_camera(camera).expect("a scene");
    assert!(still.moments().iter().all(|m| *m.camera() == camera));
    moving.edit(|_| {}).expect("a scene");
    assert!(moving.moments().is_empty());
    let many = vec![scene(0.0); MOMENTS as usize + 1];
    let error = scene(0.0).with_moments(many).expect_err("too many");
    assert!(error.to_string().contains("1024"), "{error}");
}
