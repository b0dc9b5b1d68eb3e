//! `bench frame`: whole pictures by the stream renderer and by the plain one, the same algorithms, equal threads, in turn.

use serde::Serialize;
use std::time::Instant;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Evaluations, RenderError, Renderer, Silent};
use zeroset_scene::scene::Scene;
use zeroset_trace::CpuRenderer;
use zeroset_trace::plain;

/// Streamed pictures per plain one.
const STREAMED: usize = 25;
/// Plain pictures.
const PLAIN: usize = 3;

/// What `bench frame` measures. Times are the best of several pictures.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Frames {
    /// Threads of both renderers.
    pub threads: usize,
    /// Width and height.
    pub size: [u32; 2],
    /// Pictures a second of the stream renderer, colours only.
    pub frames_per_second: f64,
    /// Milliseconds a picture of the plain renderer.
    pub plain_milliseconds: f64,
    /// Plain time over stream time.
    pub simd_over_plain: f64,
    /// Evaluations of the field a pixel, by stage, of the stream renderer.
    pub evaluations_per_pixel: Stages,
    /// How alike the two pictures are, dB.
    pub psnr: f64,
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
    let program = picture.program();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|e| RenderError::Threads {
            threads,
            reason: e.to_string(),
        })?;
    let size = scene.settings().size;
    let mut film = Film::new(0, 0);
    let (mut streamed, mut plain_time) = (f64::MAX, f64::MAX);
    let mut reference = None;
    for _ in 0..PLAIN {
        for _ in 0..STREAMED {
            let start = Instant::now();
            film = picture.render_part(size, &[Plane::Colour], &Silent).1;
            streamed = streamed.min(start.elapsed().as_secs_f64());
        }
        let start = Instant::now();
        let quality = plain::Quality::of(program, scene);
        let made = || plain::Compiled::new(program, None);
        reference = Some(pool.install(|| plain::render(scene, &quality, made)));
        plain_time = plain_time.min(start.elapsed().as_secs_f64());
    }
    let whole = renderer.render(scene, &Silent)?;
    let pixels = f64::from(size[0]) * f64::from(size[1]);
    let psnr = reference.map_or(0.0, |r| {
        psnr(r.plane(Plane::Colour), film.plane(Plane::Colour))
    });
    Ok(Frames {
        threads,
        size,
        frames_per_second: 1.0 / streamed,
        plain_milliseconds: 1e3 * plain_time,
        simd_over_plain: plain_time / streamed,
        evaluations_per_pixel: Stages::new(&whole.statistics.evaluations, pixels),
        psnr,
    })
}

/// How alike two planes are, with values limited to what a screen shows: 10 log10(1 / mean square), dB.
pub(crate) fn psnr(a: &[f32], b: &[f32]) -> f64 {
    let shown = |x: f32| f64::from(x.clamp(0.0, 1.0)).powf(1.0 / 2.2);
    let square = |(a, b): (&f32, &f32)| (shown(*a) - shown(*b)).powi(2);
    let mean = a.iter().zip(b).map(square).sum::<f64>() / a.len().max(1) as f64;
    -10.0 * mean.max(1e-12).log10()
}
