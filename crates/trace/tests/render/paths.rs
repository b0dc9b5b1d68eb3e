//! Rays that go on: reflections, glass, paths traced at random.

use crate::scenes::stream;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter, Integrator, Shadow};
use zeroset_trace::CpuRenderer;

/// Glass that stands on a floor, gold, a rough ball, a wide sun, fog.
const TABLE: &str = "
show(sphere(0.6).move(x = -0.7, y = 0.55), material(color = \"white\", transmission = 1, roughness = 0, tint = \"#bfe0c8\"))
show(torus(radius = 0.4, tube = 0.13).turn(x = 60).move(x = 0.6, y = 0.45), material(color = \"#d9a441\", metallic = 1, roughness = 0.1))
show(sphere(0.3).move(z = 0.9, y = 0.3), material(color = \"#b8321f\", roughness = 0.6))
show(plane(), material(color = \"#b0a898\", roughness = 0.3))
camera(eye = (0.6, 1.8, 4), target = (0, 0.4, 0), fov = 36)
sun(direction = (-0.7, -1, -0.6), shadow = soft(8))
fog(density = 0.03)
";

fn table(size: [u32; 2], integrator: Integrator, samples: u32) -> Scene {
    let options = Options {
        size: Some(size),
        ..Options::default()
    };
    let loaded = load_text("table.star", TABLE, Language::Starlark, None, &options);
    let mut scene = loaded.unwrap_or_else(|e| panic!("{}", e.report)).scene;
    scene
        .edit(|s| {
            s.settings.integrator = integrator;
            s.settings.antialias = Antialias::Supersample {
                samples,
                filter: Filter::Box,
            };
        })
        .expect("a scene");
    scene
}

const PATH: Integrator = Integrator::Path {
    depth: 10,
    clamp: None,
};

fn finite(film: &Film) -> bool {
    (film.plane(Plane::Colour).iter()).all(|x| x.is_finite() && *x >= 0.0)
}

#[test]
fn threads_do_not_change_what_comes_of_rays_that_go_on() {
    for integrator in Integrator::ALL {
        let scene = table([90, 70], integrator, 3);
        let bits = |threads| -> Vec<u32> {
            let renderer = CpuRenderer::new(Some(threads)).expect("threads");
            let film = renderer.render(&scene, &Silent).expect("a picture").film;
            assert!(finite(&film), "{integrator:?}");
            film.plane(Plane::Colour)
                .iter()
                .map(|x| x.to_bits())
                .collect()
        };
        assert!(bits(1) == bits(3), "{integrator:?}");
    }
}

/// Pictures of few rays with many seeds against one of many rays: their mean is right, by as much as their own variance says.
#[test]
fn paths_have_the_right_mean_for_any_seed() {
    // what is bright is rare, and where few samples missed it they think their variance small: that fades with their number
    const SEEDS: u32 = 72;
    let size = [16, 12];
    // with a sun without a width there are no caustics, whose tails are so long that few samples do not know their variance
    let table = |samples| {
        let mut scene = table(size, PATH, samples);
        scene
            .edit(|s| s.lights.iter_mut().for_each(|l| l.shadow = Shadow::Hard))
            .expect("a scene");
        scene
    };
    let truth = stream(&table(8192));
    let right = truth.plane(Plane::Colour);
    let (mut sums, mut squares) = (vec![0.0f64; right.len()], vec![0.0f64; right.len()]);
    for seed in 0..SEEDS {
        let mut scene = table(8);
        // not those of the reference
        scene
            .edit(|s| s.settings.seed = 1000 + seed)
            .expect("a scene");
        let film = stream(&scene);
        assert!(finite(&film));
        for ((sum, square), x) in (sums.iter_mut().zip(&mut squares)).zip(film.plane(Plane::Colour))
        {
            *sum += f64::from(*x);
            *square += f64::from(x * x);
        }
    }
    let n = f64::from(SEEDS);
    let mut far = 0;
    let (mut all, mut spread) = (0.0, 0.0);
    for ((sum, square), right) in sums.iter().zip(&squares).zip(right) {
        let mean = sum / n;
        let variance = (square / n - mean * mean).max(1e-9) / (n - 1.0);
        let z = (mean - f64::from(*right)) / variance.sqrt();
        far += usize::from(z.abs() > 4.5);
        all += z;
        spread += z * z;
    }
    let count = right.len() as f64;
    assert!(
        far * 50 < right.len(),
        "{far} of {count} pixels are far off"
    );
    assert!((all / count).abs() < 0.35, "mean z: {}", all / count);
    assert!(spread / count < 3.0, "mean square of z: {}", spread / count);
}

/// What goes on does not change what the planes say of the first surface.
#[test]
fn planes_are_those_of_the_first_surface() {
    let direct = stream(&table([60, 45], Integrator::Direct, 2));
    for integrator in Integrator::ALL {
        let film = stream(&table([60, 45], integrator, 2));
        for plane in [
            Plane::Depth,
            Plane::Normal,
            Plane::Albedo,
            Plane::Object,
            Plane::Coverage,
        ] {
            assert_eq!(
                film.plane(plane),
                direct.plane(plane),
                "{integrator:?} {plane:?}"
            );
        }
    }
}
