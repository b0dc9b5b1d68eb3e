//! The machine that pictures run on, with a small shader in place of a scene's: bands, tiles, memory, failures.

mod faults;
mod pictures;

use std::sync::Mutex;
use zeroset_gpu::{GpuError, GpuRenderer, Job};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Observer, Statistics};
use zeroset_scene::settings::{Antialias, Filter};
use zeroset_shader::layout::{Frame, LightSum, Sample, Shared, SurfaceSum, Tile};

/// A job whose pictures are known: see `toy.wgsl`. `work` makes each ray dearer.
fn toy(size: [u32; 2], samples: u32, work: f32) -> Job {
    let structs = [
        Frame::declaration(),
        Tile::declaration(),
        Sample::declaration(),
        LightSum::declaration(),
        SurfaceSum::declaration(),
    ];
    let source = structs.concat() + include_str!("toy.wgsl");
    let frame = Frame {
        size,
        samples,
        filter_kind: Filter::Mitchell as u32,
        prepass: 1,
        ..Frame::default()
    };
    Job {
        source: source.into(),
        frame,
        params: vec![work].into(),
        code: vec![7].into(),
        table: vec![[0.7; 4]].into(),
        images: Vec::new().into(),
        grids: Vec::new().into(),
        registers: 0,
        in_turns: false,
        turns: zeroset_shader::Turns::default(),
    }
}

/// Renders a job into a film, as far as it has planes.
trait RenderInto {
    fn render_into(
        &self,
        job: &Job,
        film: &mut Film,
        observer: &dyn Observer,
    ) -> Result<Statistics, GpuError>;
}

impl RenderInto for GpuRenderer {
    fn render_into(
        &self,
        job: &Job,
        film: &mut Film,
        observer: &dyn Observer,
    ) -> Result<Statistics, GpuError> {
        let planes: Vec<Plane> = Plane::ALL.into_iter().filter(|p| film.has(*p)).collect();
        let antialias = Antialias::Supersample {
            samples: job.samples(),
            filter: Filter::Box,
        };
        let mut sums = Accumulator::new(job.frame.size, antialias, &planes);
        let statistics = self.sample(job, 0..job.samples(), &mut sums, observer)?;
        *film = sums.into_film();
        Ok(statistics)
    }
}

/// Whether the film holds the picture of [`toy`].
#[track_caller]
fn check(film: &Film, job: &Job) {
    let [width, height] = job.frame.size;
    let mean = (job.samples() - 1) as f32 / 2.0;
    let colours = film.plane(Plane::Colour);
    assert_eq!(colours.len(), 3 * (width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let at = (y * width + x) as usize;
            let below = (y + job.margin()).min(height - 1);
            let wanted = [x as f32, below as f32, mean];
            assert_eq!(colours[3 * at..3 * at + 3], wanted, "{x}, {y}");
        }
    }
    let depth = if job.prepass() { 8.0 } else { 7.0 };
    assert!(film.plane(Plane::Depth).iter().all(|d| *d == depth));
}

/// Adds rays up; cancels when there are enough.
#[derive(Default)]
struct Counting {
    seen: Mutex<(u64, u64)>,
    enough: Option<u64>,
}

impl Observer for Counting {
    fn advance(&self, rays: u64, total: u64) {
        let mut seen = self.seen.lock().expect("no panic before");
        *seen = (seen.0 + rays, total);
    }

    fn is_cancelled(&self) -> bool {
        let seen = self.seen.lock().expect("no panic before").0;
        self.enough.is_some_and(|enough| seen >= enough)
    }
}
