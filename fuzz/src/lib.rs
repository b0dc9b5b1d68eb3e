//! What every input must survive: it loads or it is refused, without a panic, in time and within its memory. What loads goes
//! to JSON and back unchanged, and what is rendered is finite.

pub mod nest;
pub mod samples;

use std::sync::LazyLock;
use std::time::{Duration, Instant};
use zeroset_language::json::{expand, to_text};
use zeroset_language::limits::Limits;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_output::format::checkpoint::{Identity, read, write};
use zeroset_scene::film::Plane;
use zeroset_scene::progressive::Progressive;
use zeroset_scene::render::{Observer, RenderError, Renderer};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Filter, Integrator, Occlusion, Shadow};
use zeroset_trace::CpuRenderer;

/// Loads a text, and what it wrote of it as JSON. `None` where it is refused.
///
/// # Panics
/// Something broke that must not.
pub fn load(text: &str, language: Language) -> Option<Scene> {
    let limits = Limits {
        // of the two seconds that an input has: a machine under load is slower, and an honest input is not worth more
        seconds: 0.5,
        ..Limits::default()
    };
    let options = Options {
        limits,
        ..Options::default()
    };
    match load_text("fuzz", text, language, None, &options) {
        Ok(loaded) => {
            let json = to_text(&expand(&loaded.scene).expect("what loads can be written"));
            match load_text("fuzz", &json, Language::Json, None, &options) {
                Ok(again) => {
                    let twice = expand(&again.scene).expect("what loads can be written");
                    assert_eq!(json, to_text(&twice));
                }
                // the second reading has a clock of its own
                Err(failed) if failed.report.message().contains("`seconds`") => {}
                Err(failed) => panic!("what was written cannot be read: {}", failed.report),
            }
            Some(loaded.scene)
        }
        Err(failed) => {
            // a panic of the loader is caught and reported, so that the window survives it; here it must not pass
            assert!(!failed.report.is_bug(), "{}", failed.report);
            None
        }
    }
}

/// JSON where the text begins as JSON does, else Starlark.
pub fn language_of(text: &str) -> Language {
    if text.trim_start().starts_with('{') {
        Language::Json
    } else {
        Language::Starlark
    }
}

/// Ends a picture after a while.
struct Deadline(Instant);

impl Observer for Deadline {
    fn advance(&self, _rays: u64, _total: u64) {}
    fn is_cancelled(&self) -> bool {
        self.0.elapsed() > Duration::from_millis(500)
    }
}

/// Side of the pictures.
const SIDE: u32 = 4;

/// Renders a scene at 4x4, with few of everything that a scene may honestly ask much of.
///
/// # Panics
/// A number of the film is none, or the film is not the same twice.
pub fn render(mut scene: Scene) {
    static RENDERER: LazyLock<CpuRenderer> =
        LazyLock::new(|| CpuRenderer::new(Some(1)).expect("a thread"));
    let few = |occlusion: &mut Occlusion| match occlusion {
        Occlusion::Quilez { steps, .. }
        | Occlusion::Bent { steps, .. }
        | Occlusion::Cones { steps, .. } => *steps = (*steps).min(8),
        Occlusion::Hemisphere { rays, .. } | Occlusion::Obscurance { rays, .. } => {
            *rays = (*rays).min(4);
        }
        // whose volume is made before the picture is begun, which a deadline does not end
        Occlusion::Skylight { resolution, .. } | Occlusion::Curvature { resolution, .. } => {
            *resolution = (*resolution).min(16);
        }
        _ => {}
    };
    let changed = scene.edit(|s| {
        for light in &mut s.lights {
            if let Shadow::Advected { resolution, .. } = &mut light.shadow {
                *resolution = (*resolution).min(16);
            }
        }
        s.settings.size = [SIDE; 2];
        s.settings.max_steps = s.settings.max_steps.min(64);
        if let Antialias::Supersample { samples, .. } = &mut s.settings.antialias {
            *samples = (*samples).min(2);
        }
        match &mut s.settings.integrator {
            Integrator::Whitted {
                reflections,
                refractions,
            } => {
                *reflections = (*reflections).min(2);
                *refractions = (*refractions).min(4);
            }
            Integrator::Path { depth, .. } => *depth = (*depth).min(4),
            Integrator::Direct => {}
        }
        few(&mut s.settings.occlusion);
        for object in &mut s.objects {
            object.occlusion.as_mut().map(few);
        }
        s.lights.truncate(2);
    });
    changed.expect("fewer of what was allowed");
    let nodes = scene.objects().iter().map(|o| o.field.facts().nodes);
    if nodes.sum::<u64>() > 500 {
        return;
    }
    let draw = || RENDERER.render(&scene, &Deadline(Instant::now()));
    let (first, second) = match (draw(), draw()) {
        (Ok(first), Ok(second)) => (first.film, second.film),
        (Err(RenderError::Threads { .. } | RenderError::Device { .. }), _) => {
            panic!("a scene has nothing to do with that")
        }
        _ => return,
    };
    for plane in Plane::ALL {
        let numbers = first.plane(plane);
        let far = plane == Plane::Depth;
        assert!(
            numbers
                .iter()
                .all(|x| x.is_finite() || (far && *x == f32::INFINITY)),
            "{plane:?}: {numbers:?}"
        );
        assert_eq!(
            numbers,
            second.plane(plane),
            "{plane:?} differs from run to run"
        );
    }
}

/// Reads bytes as a checkpoint of a small picture: as they are, and as what stands behind check sums that are right. What is accepted can
/// be shown, planned with, and written and read again.
///
/// # Panics
/// Something broke that must not.
pub fn checkpoint(bytes: &[u8]) {
    let identity = Identity::default().with("size", "2x2").with("scene", "a");
    let fresh = || Progressive::new([2, 2], Filter::Tent, &[Plane::Colour], 1, 0.0);
    let look = |bytes: &[u8]| {
        let mut picture = fresh();
        if read(bytes, &identity, &mut picture).is_err() {
            assert_eq!((picture.rounds(), picture.rays()), (0, 0));
            return;
        }
        let map = picture.plan(Some(0.01));
        assert!(map.most() >= 1 && picture.film().has(Plane::Colour));
        let mut again = Vec::new();
        write(&mut again, &identity, &picture).expect("memory");
        read(&again[..], &identity, &mut fresh()).expect("what was read can be read");
    };
    look(bytes);
    let mut whole = Vec::new();
    write(&mut whole, &identity, &fresh()).expect("memory");
    // the check sum of the second part, and where that begins
    let head = 16 + "size 2x2\nscene a\n".len() + 4;
    let end = whole.len() - 4;
    for (to, from) in whole[head..end].iter_mut().zip(bytes) {
        *to = *from;
    }
    let sum = crc32fast::hash(&whole[head..end]);
    whole[end..].copy_from_slice(&sum.to_le_bytes());
    look(&whole);
}
