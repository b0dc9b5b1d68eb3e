//! `bench march`: how many evaluations a ray takes by each marcher.

use serde::Serialize;
use std::collections::BTreeMap;
use zeroset_scene::render::{RenderError, Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, March, Occlusion, Settings};
use zeroset_trace::CpuRenderer;

/// The picture's side.
const SIDE: u32 = 160;

/// What `bench march` measures.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Marches {
    /// Rays of each marcher.
    pub rays: u64,
    /// Evaluations a ray, the prepass's cones included.
    pub evaluations_per_ray: BTreeMap<String, f64>,
    /// Evaluations a ray over those of `sphere`.
    pub share_of_sphere: BTreeMap<String, f64>,
}

/// The marchers side by side: all without the prepass, and the default with it.
fn marchers() -> Vec<(&'static str, March, bool)> {
    vec![
        ("fixed", March::Fixed { step: 0.02 }, false),
        ("sphere", March::Sphere, false),
        ("relaxed", March::Relaxed { omega: 1.2 }, false),
        ("enhanced", March::Enhanced { share: 0.9 }, false),
        ("auto", March::Auto { beta: 0.3 }, false),
        ("sphere+prepass", March::Sphere, true),
        ("auto+prepass", March::Auto { beta: 0.3 }, true),
    ]
}

/// Measures a scene.
pub(crate) fn march(scene: &Scene) -> Result<Marches, RenderError> {
    let renderer = CpuRenderer::new(None)?;
    let mut scene = scene.clone();
    scene.settings = Settings {
        size: [SIDE, SIDE],
        antialias: Antialias::None,
        occlusion: Occlusion::None,
        ..scene.settings
    };
    let mut found = Marches {
        rays: u64::from(SIDE) * u64::from(SIDE),
        evaluations_per_ray: BTreeMap::new(),
        share_of_sphere: BTreeMap::new(),
    };
    for (name, march, prepass) in marchers() {
        let max_steps = if matches!(march, March::Fixed { .. }) {
            5000
        } else {
            scene.settings.max_steps
        };
        scene.settings = Settings {
            march,
            prepass,
            max_steps,
            ..scene.settings
        };
        let frame = renderer.render(&scene, &Silent)?;
        let e = frame.statistics.evaluations;
        let per_ray = (e.march + e.prepass) as f64 / found.rays as f64;
        found.evaluations_per_ray.insert(name.into(), per_ray);
        scene.settings.max_steps = Settings::default().max_steps;
    }
    let sphere = found.evaluations_per_ray["sphere"];
    found.share_of_sphere = found
        .evaluations_per_ray
        .iter()
        .map(|(name, e)| (name.clone(), e / sphere))
        .collect();
    Ok(found)
}
