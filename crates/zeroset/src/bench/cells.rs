//! `bench cells`: what cells save, against the whole program at every point, in one run.

use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;
use zeroset_scene::film::Plane;
use zeroset_scene::render::{RenderError, Silent};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Settings};
use zeroset_trace::CpuRenderer;

/// The picture's side.
const SIDE: u32 = 256;
/// Pictures that are rendered of each kind, of which the fastest counts. (First pictures are one.)
const PICTURES: usize = 3;

/// What `bench cells` measures, on one thread.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CellSavings {
    /// Instructions of the whole program.
    pub instructions: usize,
    /// Milliseconds of a picture without cells.
    pub milliseconds_without: f64,
    /// Milliseconds of the first picture, with all cells that it makes.
    pub milliseconds_first: f64,
    /// Milliseconds of the pictures after it.
    pub milliseconds_next: f64,
    /// How many times faster the first picture is.
    pub speedup_first: f64,
    /// How many times faster the next ones are.
    pub speedup_next: f64,
    /// Instructions that are evaluated for each ray from the eye, all stages together: each counts once a point.
    pub evaluated_instructions_per_ray: f64,
    /// The same without cells.
    pub evaluated_instructions_per_ray_without: f64,
    /// Cells that were made; 0 where a scene has none because they would not pay.
    pub cells: usize,
    /// Bytes that they take.
    pub bytes: usize,
    /// Whether both pictures are equal to the bit.
    pub same_picture: bool,
}

/// Measures a scene.
pub(crate) fn cells(scene: &Scene) -> Result<CellSavings, RenderError> {
    let renderer = CpuRenderer::new(Some(1))?;
    let settings = Settings {
        size: [SIDE, SIDE],
        antialias: Antialias::None,
        ..*scene.settings()
    };
    let scene = Arc::new(scene.clone().with_settings(settings)?);
    let planes = [Plane::Colour, Plane::Depth, Plane::Normal, Plane::Object];
    let timed = |work: &mut dyn FnMut()| {
        let began = Instant::now();
        work();
        began.elapsed().as_secs_f64() * 1e3
    };
    let fastest = |work: &mut dyn FnMut()| {
        (0..PICTURES)
            .map(|_| timed(work))
            .fold(f64::INFINITY, f64::min)
    };
    let whole = renderer.prepare_scene(Arc::clone(&scene))?.without_cells();
    let instructions = whole.program().values().code.instructions.len();
    let picture = || whole.render_part([SIDE, SIDE], &planes, &Silent);
    let (part, reference) = picture();
    let without = fastest(&mut || drop(picture()));
    let rays = part.statistics.rays as f64;
    let points = part.statistics.evaluations.total() as f64;
    drop(whole);

    let prepared = renderer.prepare_scene(scene)?.with_cells();
    let picture = || prepared.render_part([SIDE, SIDE], &planes, &Silent);
    let mut film = None;
    let first = timed(&mut || film = Some(picture().1));
    let census = || prepared.cells().map(|cells| cells.census());
    let before = census();
    let next = fastest(&mut || drop(picture()));
    let all = points * instructions as f64 / rays;
    let (evaluated, cells, bytes) = match (before, census()) {
        (Some(before), Some(after)) => {
            let evaluated = (after.instructions - before.instructions) as f64;
            (
                evaluated / (PICTURES as f64 * rays),
                after.cells,
                after.bytes,
            )
        }
        _ => (all, 0, 0),
    };
    Ok(CellSavings {
        instructions,
        milliseconds_without: without,
        milliseconds_first: first,
        milliseconds_next: next,
        speedup_first: without / first,
        speedup_next: without / next,
        evaluated_instructions_per_ray: evaluated,
        evaluated_instructions_per_ray_without: all,
        cells,
        bytes,
        same_picture: film
            .is_some_and(|film| planes.iter().all(|p| film.plane(*p) == reference.plane(*p))),
    })
}

impl CellSavings {
    /// For people.
    pub(crate) fn text(&self) -> String {
        format!(
            "{} instructions, one thread, {SIDE}x{SIDE}\n\
             without cells   {:8.1} ms, {:8.0} instructions a ray\n\
             first picture   {:8.1} ms, {:.2} times as fast\n\
             next pictures   {:8.1} ms, {:.2} times as fast, {:8.0} instructions a ray\n\
             {} cells, {:.1} MB; {}",
            self.instructions,
            self.milliseconds_without,
            self.evaluated_instructions_per_ray_without,
            self.milliseconds_first,
            self.speedup_first,
            self.milliseconds_next,
            self.speedup_next,
            self.evaluated_instructions_per_ray,
            self.cells,
            self.bytes as f64 / 1e6,
            if self.same_picture {
                "the same picture, to the bit"
            } else {
                "ANOTHER PICTURE"
            },
        )
    }
}
