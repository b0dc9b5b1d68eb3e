//! `bench frame --backend gpu`: whole pictures by the GPU and by the CPU's stream renderer, in turn.

use super::frame::Stages;
use serde::Serialize;
use std::collections::BTreeMap;
use std::time::{Duration, Instant};
use zeroset_gpu::{GpuRenderer, Timings};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{RenderError, Silent};
use zeroset_scene::scene::Scene;
use zeroset_trace::CpuRenderer;

/// Pictures of each renderer, at most.
const PICTURES: usize = 50;
/// Fewer where they take longer than this together.
const LONG: Duration = Duration::from_secs(20);
/// And at least.
const LEAST: usize = 3;

/// What `bench frame --backend gpu` measures. Times are those of the fastest picture, colours only.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct GpuFrames {
    pub adapter: String,
    pub kind: String,
    /// Vulkan, Metal or DirectX 12.
    pub interface: &'static str,
    pub driver: String,
    /// Width and height.
    pub size: [u32; 2],
    /// Rays a pixel.
    pub samples: u32,
    /// Pictures that were measured.
    pub pictures: usize,
    /// Milliseconds a picture, from the call to the plane in memory.
    pub milliseconds: f64,
    pub frames_per_second: f64,
    /// Milliseconds of work on the GPU in that picture.
    pub gpu_milliseconds: f64,
    /// The same, by stage.
    pub gpu_stages: BTreeMap<&'static str, f64>,
    /// Whether the GPU's clock measured these; else they are times from submission to completion.
    pub by_timestamps: bool,
    /// Milliseconds that compiling the shader took, before the first picture.
    pub compile_milliseconds: f64,
    pub dispatches: u32,
    pub submissions: u32,
    /// The longest dispatch of all pictures but the first.
    pub longest_dispatch_milliseconds: f64,
    /// Threads of the CPU's renderer.
    pub cpu_threads: usize,
    pub cpu_milliseconds: f64,
    /// Time of the CPU over time of the GPU.
    pub gpu_over_cpu: f64,
    /// Evaluations of the field a pixel on the GPU, by stage.
    pub evaluations_per_pixel: Stages,
    /// How alike the two pictures are, dB.
    pub psnr: f64,
}

/// Measures a scene.
pub(crate) fn frame(
    scene: &Scene,
    threads: usize,
    gpu: &GpuRenderer,
) -> Result<GpuFrames, RenderError> {
    let cpu = CpuRenderer::new(Some(threads))?;
    let picture = cpu.prepare_scene(scene.clone().into())?;
    let job = gpu.job(scene)?;
    let settings = scene.settings();
    let by_the_gpu = || {
        let mut sums = Accumulator::new(settings.size, settings.antialias, &[Plane::Colour]);
        let samples = 0..sums.wanted();
        let statistics = gpu.sample(&job, samples, &mut sums, &Silent)?;
        Ok::<_, RenderError>((statistics.evaluations, sums.into_film()))
    };
    let mut by_cpu = Film::new(0, 0);
    let (mut best, mut compile, mut longest) = (None::<Timings>, 0.0, 0.0);
    let (mut cpu_seconds, mut pictures) = (f64::MAX, 0);
    let (mut evaluations, mut by_gpu) = by_the_gpu()?;
    if let Some(first) = gpu.timings() {
        compile = first.compile;
    }
    let began = Instant::now();
    while pictures < PICTURES && (pictures < LEAST || began.elapsed() < LONG) {
        (evaluations, by_gpu) = by_the_gpu()?;
        if let Some(timings) = gpu.timings() {
            longest = f64::max(longest, timings.longest);
            if best.as_ref().is_none_or(|b| timings.wall < b.wall) {
                best = Some(timings);
            }
        }
        let (part, film) = picture.render_part(settings.size, &[Plane::Colour], &Silent);
        (cpu_seconds, by_cpu) = (cpu_seconds.min(part.statistics.seconds), film);
        pictures += 1;
    }
    let best = best.ok_or_else(|| RenderError::Device {
        reason: "it did not say how long a picture took".to_owned(),
        advice: None,
    })?;
    let pixels = f64::from(settings.size[0]) * f64::from(settings.size[1]);
    let info = best.adapter.clone();
    Ok(GpuFrames {
        adapter: info.name,
        kind: info.kind.to_string(),
        interface: info.backend,
        driver: info.driver,
        size: best.size,
        samples: best.samples,
        pictures,
        milliseconds: 1e3 * best.wall,
        frames_per_second: 1.0 / best.wall,
        gpu_milliseconds: 1e3 * best.stages.total(),
        gpu_stages: best.stages.iter().map(|(n, s)| (n, 1e3 * s)).collect(),
        by_timestamps: best.by_timestamps,
        compile_milliseconds: 1e3 * compile,
        dispatches: best.dispatches,
        submissions: best.submissions,
        longest_dispatch_milliseconds: 1e3 * longest,
        cpu_threads: threads,
        cpu_milliseconds: 1e3 * cpu_seconds,
        gpu_over_cpu: cpu_seconds / best.wall,
        evaluations_per_pixel: Stages::new(&evaluations, pixels),
        psnr: psnr(by_cpu.plane(Plane::Colour), by_gpu.plane(Plane::Colour)),
    })
}

impl GpuFrames {
    /// For a person.
    pub(crate) fn text(&self) -> String {
        let stages: Vec<String> = (self.gpu_stages.iter())
            .map(|(name, milliseconds)| format!("{name} {milliseconds:.2}"))
            .collect();
        let clock = if self.by_timestamps {
            "by its own clock"
        } else {
            "from submission to completion"
        };
        format!(
            "{} ({}, {}), {}\n\
             {}x{}, {} ray{} a pixel, {} pictures\n\
             {:.2} ms a frame, {:.1} frames a second, {:.2} times the CPU on {} threads ({:.2} ms), {:.1} dB to its picture\n\
             GPU {clock}: {:.2} ms ({})\n\
             {} dispatches in {} submissions, the longest {:.2} ms; compiled in {:.0} ms\n\
             {:.1} evaluations a pixel",
            self.adapter,
            self.interface,
            self.kind,
            self.driver,
            self.size[0],
            self.size[1],
            self.samples,
            if self.samples == 1 { "" } else { "s" },
            self.pictures,
            self.milliseconds,
            self.frames_per_second,
            self.gpu_over_cpu,
            self.cpu_threads,
            self.cpu_milliseconds,
            self.psnr,
            self.gpu_milliseconds,
            stages.join(", "),
            self.dispatches,
            self.submissions,
            self.longest_dispatch_milliseconds,
            self.compile_milliseconds,
            self.evaluations_per_pixel.total,
        )
    }
}

/// How alike two planes are, with values limited to what a screen shows: 10 log10(1 / mean square), dB.
fn psnr(a: &[f32], b: &[f32]) -> f64 {
    let shown = |x: f32| f64::from(x.clamp(0.0, 1.0)).powf(1.0 / 2.2);
    let square = |(a, b): (&f32, &f32)| (shown(*a) - shown(*b)).powi(2);
    let mean = a.iter().zip(b).map(square).sum::<f64>() / a.len().max(1) as f64;
    -10.0 * mean.max(1e-12).log10()
}
