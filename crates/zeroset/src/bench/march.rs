//! `bench march`: how many evaluations a ray takes by each marcher, and whether one misses what a dense march in double
//! precision hits.

use serde::Serialize;
use std::collections::BTreeMap;
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::methods::Choice;
use zeroset_scene::render::{RenderError, Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, March, Occlusion, Settings};
use zeroset_trace::CpuRenderer;
use zeroset_trace::plain::dense;

/// The picture's side: small, because the reference takes thousands of evaluations a ray.
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
    /// Pixels where the reference hits and the marcher does not, although the reference hits at all corners of the pixel.
    pub missed_hits: BTreeMap<String, u64>,
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
    let solid = surely_hit(&renderer, &scene)?;
    let mut found = Marches {
        rays: u64::from(SIDE) * u64::from(SIDE),
        evaluations_per_ray: BTreeMap::new(),
        share_of_sphere: BTreeMap::new(),
        missed_hits: BTreeMap::new(),
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
        found.evaluations_per_ray.insert(name.clone(), per_ray);
        let depth = frame.film.plane(Plane::Depth);
        let missed = solid
            .iter()
            .zip(depth)
            .filter(|(solid, t)| **solid && !t.is_finite())
            .count();
        found.missed_hits.insert(name, missed as u64);
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

/// Pixels whose middle and corners all hit in the reference: those that are not within half a pixel of a silhouette.
fn surely_hit(renderer: &CpuRenderer, scene: &Scene) -> Result<Vec<bool>, RenderError> {
    use rayon::prelude::*;
    let picture = renderer.prepare_scene(scene.clone().into())?;
    let program = picture.program();
    let hits = |camera: &Camera, x: f32, y: f32| {
        let (o, d) = camera.ray(x, y, [SIDE, SIDE]);
        let wide = |v: glam::Vec3| v.to_array().map(f64::from);
        let (near, far) = (f64::from(camera.near), f64::from(camera.far).min(60.0));
        dense::march(program, wide(o), wide(d), near, far, |t| 1e-4 * t.max(0.1)).is_some()
    };
    // corners are shared by pixels
    let corners: Vec<bool> = (0..(SIDE + 1) * (SIDE + 1))
        .into_par_iter()
        .map(|i| {
            hits(
                scene.camera(),
                (i % (SIDE + 1)) as f32,
                (i / (SIDE + 1)) as f32,
            )
        })
        .collect();
    Ok((0..SIDE * SIDE)
        .into_par_iter()
        .map(|i| {
            let (x, y) = (i % SIDE, i / SIDE);
            let corner = |dx: u32, dy: u32| corners[((y + dy) * (SIDE + 1) + x + dx) as usize];
            corner(0, 0)
                && corner(1, 0)
                && corner(0, 1)
                && corner(1, 1)
                && hits(scene.camera(), x as f32 + 0.5, y as f32 + 0.5)
        })
        .collect())
}
