//! `bench frame`: whole pictures by the CPU's stream renderer.

use serde::Serialize;
use std::time::Instant;
use zeroset_scene::film::Plane;
use zeroset_scene::render::{Evaluations, RenderError, Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_trace::CpuRenderer;

/// Pictures.
const PICTURES: usize = 75;

/// What `bench frame` measures. The time is the best of several pictures.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Frames {
    /// Threads of the renderer.
    pub threads: usize,
    /// Width and height.
    pub size: [u32; 2],
    /// Milliseconds a picture, colours only.
    pub milliseconds: f64,
    /// Pictures a second, colours only.
    pub frames_per_second: f64,
    /// Evaluations of the field a pixel, by stage.
    pub evaluations_per_pixel: Stages,
}

/// Evaluations of the field a pixel.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Stages {
    pub prepass: f64,
    pub march: f64,
    pub normal: f64,
    pub occlusion: f64,
    pub shadow: f64,
    pub material: f64,
    pub total: f64,
}

impl Stages {
    pub(crate) fn new(e: &Evaluations, pixels: f64) -> Self {
        let per = |n: u64| n as f64 / pixels;
        Stages {
            prepass: per(e.prepass),
            march: per(e.march),
            normal: per(e.normal),
            occlusion: per(e.occlusion),
            shadow: per(e.shadow),
            material: per(e.material),
            total: per(e.total()),
        }
    }
}

/// Measures a scene.
pub(crate) fn frame(scene: &Scene, threads: usize) -> Result<Frames, RenderError> {
    let renderer = CpuRenderer::new(Some(threads))?;
    let picture = renderer.prepare_scene(scene.clone().into())?;
    let size = scene.settings().size;
    let mut best = f64::MAX;
    for _ in 0..PICTURES {
        let start = Instant::now();
        picture.render_part(size, &[Plane::Colour], &Silent);
        best = best.min(start.elapsed().as_secs_f64());
    }
    let whole = renderer.render(scene, &Silent)?;
    let pixels = f64::from(size[0]) * f64::from(size[1]);
    Ok(Frames {
        threads,
        size,
        milliseconds: 1e3 * best,
        frames_per_second: 1.0 / best,
        evaluations_per_pixel: Stages::new(&whole.statistics.evaluations, pixels),
    })
}
