//! `bench march`: how many evaluations a ray takes by each marcher.

use serde::Serialize;
use std::collections::BTreeMap;
use zeroset_scene::methods::Choice;
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

/// The marchers side by side: all without the prepass, then the plainest and the default with it.
fn marchers() -> Vec<(String, March, bool)> {
    let plain = March::ALL.map(|march| (march.method().name.to_owned(), march, false));
    let with = [March::Sphere, March::default()];
    let with = with.map(|march| (format!("{}+prepass", march.method().name), march, true));
    plain.into_iter().chain(with).collect()
}

/// Measures a scene.
pub(crate) fn march(scene: &Scene) -> Result<Marches, RenderError> {
    let renderer = CpuRenderer::new(None)?;
    let settings = Settings {
        size: [SIDE, SIDE],
        antialias: Antialias::None,
        occlusion: Occlusion::None,
        ..*scene.settings()
    };
    let mut scene = scene.clone().with_settings(settings)?;
    let mut found = Marches {
        rays: u64::from(SIDE) * u64::from(SIDE),
        evaluations_per_ray: BTreeMap::new(),
        share_of_sphere: BTreeMap::new(),
    };
    for (name, march, prepass) in marchers() {
        let max_steps = if matches!(march, March::Fixed { .. }) {
            5000
        } else {
            Settings::default().max_steps
        };
        scene = scene.with_settings(Settings {
            march,
            prepass,
            max_steps,
            ..settings
        })?;
        let frame = renderer.render(&scene, &Silent)?;
        let e = frame.statistics.evaluations;
        let per_ray = (e.march + e.prepass) as f64 / found.rays as f64;
        found.evaluations_per_ray.insert(name, per_ray);
        scene.edit(|s| s.settings.max_steps = Settings::default().max_steps)?;
    }
    let sphere = found.evaluations_per_ray[March::Sphere.method().name];
    found.share_of_sphere = found
        .evaluations_per_ray
        .iter()
        .map(|(name, e)| (name.clone(), e / sphere))
        .collect();
    Ok(found)
}
