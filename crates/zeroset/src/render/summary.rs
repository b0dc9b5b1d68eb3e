//! What a picture was and what it took.

use crate::console::{grouped, short};
use serde::Serialize;
use std::collections::BTreeMap;
use zeroset_scene::render::Statistics;
use zeroset_scene::settings::Settings;

/// What `--json` prints of a picture.
#[derive(Serialize)]
pub(crate) struct Summary<'a> {
    pub(crate) scene: &'a str,
    pub(crate) file: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) view: &'static str,
    /// Number of the frame, if it is one of many.
    pub(crate) frame: Option<u32>,
    /// What time() was, seconds.
    pub(crate) time: f64,
    /// Parameters that were set.
    pub(crate) set: &'a BTreeMap<String, String>,
    /// Rendering, seconds.
    pub(crate) seconds: f64,
    /// What rendered it: cpu or gpu.
    pub(crate) backend: &'static str,
    /// The GPU's name.
    pub(crate) adapter: Option<&'a str>,
    pub(crate) threads: usize,
    pub(crate) rays: u64,
    pub(crate) hits: u64,
    pub(crate) rays_per_second: f64,
    pub(crate) evaluations: Evaluations,
    pub(crate) evaluations_per_ray: f64,
    /// Share of the pixels that have all their rays: less than 1 where a time limit ended the picture.
    pub(crate) finished: f64,
    /// How wide 95 % intervals are, where that was measured: see `--noise`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) noise: Option<f64>,
    /// Rays that a pixel has on average, those of earlier runs included, where a picture converges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rays_a_pixel: Option<f64>,
    pub(crate) settings: &'a Settings,
}

/// Evaluations of the field, by stage.
#[derive(Serialize)]
pub(crate) struct Evaluations {
    total: u64,
    prepass: u64,
    march: u64,
    normal: u64,
    occlusion: u64,
    shadow: u64,
    material: u64,
}

impl Evaluations {
    pub(crate) fn of(statistics: &Statistics) -> Evaluations {
        let e = statistics.evaluations;
        Evaluations {
            total: e.total(),
            prepass: e.prepass,
            march: e.march,
            normal: e.normal,
            occlusion: e.occlusion,
            shadow: e.shadow,
            material: e.material,
        }
    }
}

impl Summary<'_> {
    /// For a person, on one line.
    pub(crate) fn line(&self) -> String {
        let by = match (self.adapter, self.threads) {
            (Some(adapter), _) => adapter.to_owned(),
            (None, 1) => "1 thread".to_owned(),
            (None, threads) => format!("{threads} threads"),
        };
        format!(
            "{}: {}x{}, {} rays in {:.3} s ({} rays/s), {:.1} evaluations a ray, {by}",
            self.file,
            self.width,
            self.height,
            grouped(self.rays),
            self.seconds,
            short(self.rays_per_second),
            self.evaluations_per_ray,
        ) + &self.convergence()
    }

    fn convergence(&self) -> String {
        match (self.noise, self.rays_a_pixel) {
            (Some(noise), Some(rays)) => {
                format!(", {rays:.0} rays a pixel leave a noise of {noise:.5}")
            }
            (None, Some(rays)) => format!(", {rays:.0} rays a pixel"),
            _ => String::new(),
        }
    }
}
