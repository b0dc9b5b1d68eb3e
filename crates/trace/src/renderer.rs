//! The renderer: tiles over threads, into sums of samples.

use crate::job::Job;
use crate::resolve::{self, ACCUMULATORS};
use crate::stop::Stop;
use crate::tile::{Area, HEIGHT, Scratch, Solid, WIDTH};
use fearless_simd::Level;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};
use web_time::Instant;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::tape::Operation;
use zeroset_cells::Cells;
use zeroset_field::program::{Limits, Program};
use zeroset_number::at_level;
use zeroset_scene::accumulator::{self, Accumulator, Sum};
use zeroset_scene::camera::Camera;
use zeroset_scene::film::{Film, Plane, SUMS};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::motion::Moving;
use zeroset_scene::progressive::{MOST, SampleMap};
use zeroset_scene::render::{Evaluations, Observer, Prepared, RenderError, Renderer, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Antialias, Occlusion, Settings};
use zeroset_shade::advection::{LightVolume, Reading};
use zeroset_shade::air::Air;
use zeroset_shade::closed::{Closing, at_eye, begin_outside};
use zeroset_shade::coat::{Coat, compiled};
use zeroset_shade::environment::EnvironmentMap;
use zeroset_shade::lamp::{self, Lamp};
use zeroset_shade::skin::has_skins;
use zeroset_shade::skylight::SkyVolume;
use zeroset_shade::surface::BLURRED;
use zeroset_shade::view::{Region, View};

/// The CPU's renderer: sphere tracing in SIMD streams, over all threads that it is given. Clones share their threads.
///
/// The same scene gives the same picture, bit for bit, whatever the number of threads and the order of tiles.
#[derive(Clone)]
pub struct CpuRenderer {
    pub(crate) pool: Arc<ThreadPool>,
    pub(crate) level: Level,
    limits: Limits,
    sums: u64,
}

impl CpuRenderer {
    /// A renderer with this many threads, or as many as the machine has cores.
    ///
    /// # Errors
    /// [`RenderError::Threads`] where the system does not give that many.
    pub fn new(threads: Option<usize>) -> Result<CpuRenderer, RenderError> {
        let threads = threads.unwrap_or(0);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|k| format!("render {k}"))
            .build()
            .map_err(|e| RenderError::Threads {
                threads,
                reason: e.to_string(),
            })?;
        Ok(CpuRenderer {
            pool: Arc::new(pool),
            level: Level::new(),
            limits: Limits::default(),
            sums: SUMS,
        })
    }

    /// With another SIMD level than the best one of the machine.
    pub fn with_level(self, level: Level) -> CpuRenderer {
        CpuRenderer { level, ..self }
    }

    /// With other limits on what the scene may compile to.
    pub fn with_limits(self, limits: Limits) -> CpuRenderer {
        CpuRenderer { limits, ..self }
    }

    /// With another number of bytes for the sums of tiles that are kept at a time; the picture does not depend on it.
    pub fn with_sums(self, sums: u64) -> CpuRenderer {
        CpuRenderer { sums, ..self }
    }

    /// Threads.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// As [`Renderer::prepare`], for what only this renderer can do with a scene.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub fn prepare_scene(&self, scene: Arc<Scene>) -> Result<PreparedScene, RenderError> {
        PreparedScene::new(self.clone(), scene)
    }

    /// See [`SkyVolume::renewed`] and [`LightVolume::renewed`]: on the threads of this renderer.
    fn volumes(
        &self,
        before: &Volumes,
        scene: &Scene,
        program: &Program,
    ) -> Result<Volumes, RenderError> {
        let make = || {
            Ok(Volumes {
                sky: SkyVolume::renewed(before.sky.as_ref(), scene, program)?,
                light: LightVolume::renewed(before.light.as_ref(), scene, program)?,
            })
        };
        self.pool.install(make)
    }

    /// Bytes that a picture of the scene takes while these planes are rendered, apart from the scene itself.
    pub fn memory(&self, scene: &Scene, planes: &[Plane]) -> u64 {
        let size = scene.settings().size;
        let scratch = match scene.settings().antialias {
            Antialias::None | Antialias::Coverage { .. } => 0,
            Antialias::Supersample { .. } => sums(size),
        };
        accumulator::bytes(size, planes) + scratch
    }
}

/// Volumes that methods read instead of the field, where they do.
#[derive(Clone, Debug, Default)]
pub(crate) struct Volumes {
    /// What skylight is read from.
    pub(crate) sky: Option<Arc<SkyVolume>>,
    /// What lights are advected through.
    light: Option<Arc<LightVolume>>,
}

impl Renderer for CpuRenderer {
    fn name(&self) -> String {
        match self.threads() {
            1 => "CPU, 1 thread".to_owned(),
            n => format!("CPU, {n} threads"),
        }
    }

    fn prepare(&self, scene: Arc<Scene>) -> Result<Box<dyn Prepared>, RenderError> {
        let prepared = self.prepare_scene(Arc::clone(&scene))?;
        Ok(Box::new(Moving::new(scene, Box::new(prepared))))
    }
}

/// As much of a picture as there was time for.
#[derive(Clone, Debug)]
pub struct Part {
    /// What the finished tiles took.
    pub statistics: Statistics,
    /// Whether all of it is finished.
    pub is_whole: bool,
    /// The tiles that are finished: left edge, upper edge, width, height.
    pub finished: Vec<[u32; 4]>,
    /// Evaluations of the field, those of unfinished tiles included.
    pub spent: u64,
}

/// A scene as solids in closed form and what is marched beside them.
pub(crate) struct Beside {
    closing: Closing,
    cells: Option<Arc<Cells>>,
}

impl Beside {
    fn of(scene: &Scene, limits: &Limits) -> Result<Option<Arc<Beside>>, RenderError> {
        Ok(Closing::of(scene, limits)?.map(|closing| {
            let cells = cells_of(scene, &closing.program);
            Arc::new(Beside { closing, cells })
        }))
    }

    /// What is marched in place of a solid that is all of it.
    pub(crate) fn solid<'a>(&'a self, whole: &Solid<'a>, job: &Job<'_>) -> Solid<'a> {
        let Closing {
            closed,
            program,
            region,
        } = &self.closing;
        let steps = job.picture.scene.settings().max_steps;
        Solid {
            closed,
            ..Solid::new(
                (program, self.cells.as_deref()),
                *region,
                whole.view,
                steps,
                whole.skins,
                whole.samples,
                whole.stop,
            )
        }
    }
}

/// A scene that is ready to be rendered on the CPU.
pub struct PreparedScene {
    pub(crate) renderer: CpuRenderer,
    pub(crate) scene: Arc<Scene>,
    pub(crate) program: Program,
    /// Its cells, where it is worth while.
    cells: Option<Arc<Cells>>,
    /// The same as solids in closed form and what is left, where there are any.
    beside: Option<Arc<Beside>>,
    /// The program for rays inside clear bodies, where there are opaque ones too.
    pub(crate) inside: Option<Program>,
    /// See [`Program::inside_marks`].
    pub(crate) inside_marks: Option<Program>,
    /// Where the solid is; empty where the scene has no objects.
    pub(crate) region: Region,
    /// Whether there are skins that its methods would see.
    pub(crate) skins: bool,
    /// The only material there is, if there is only one.
    pub(crate) material: Option<u16>,
    /// The only object there is, if there is only one.
    pub(crate) object: Option<u16>,
    /// Fog, and the sun before the sky.
    pub(crate) air: Air<f32>,
    /// Light from all around, by an image.
    pub(crate) environment: Option<Arc<EnvironmentMap>>,
    /// What is read instead of the field.
    pub(crate) volumes: Volumes,
    /// The lamps that rays may meet.
    pub(crate) lamps: Vec<Lamp<f32>>,
    /// Whether rays go on from any material.
    pub(crate) goes_on: bool,
    /// The materials as they lie on things, by their numbers as marks.
    pub(crate) coats: Vec<Coat>,
    /// Whether any of them is shown with heights.
    pub(crate) has_bumps: bool,
    /// Whether a material is coloured by the orbits of fractals.
    pub(crate) has_orbits: bool,
    /// Occlusion methods that objects chose, each once; the first is the scene's.
    pub(crate) methods: Vec<Occlusion>,
    /// The method of every object.
    pub(crate) method_of: Vec<usize>,
    /// Memory of threads that are done with their tile.
    #[allow(clippy::vec_box, reason = "megabytes, which should not move")]
    spare: Mutex<Vec<Box<Scratch>>>,
}

impl PreparedScene {
    fn new(renderer: CpuRenderer, scene: Arc<Scene>) -> Result<PreparedScene, RenderError> {
        let (program, region) = compiled(&scene, &renderer.limits)?;
        let field = Compiled {
            cells: cells_of(&scene, &program),
            beside: Beside::of(&scene, &renderer.limits)?,
            program,
            region,
        };
        let environment = EnvironmentMap::renewed(None, &scene);
        let volumes = renderer.volumes(&Volumes::default(), &scene, &field.program)?;
        Ok(PreparedScene::of(
            renderer,
            scene,
            field,
            environment,
            volumes,
        ))
    }

    fn of(
        renderer: CpuRenderer,
        scene: Arc<Scene>,
        field: Compiled,
        environment: Option<Arc<EnvironmentMap>>,
        volumes: Volumes,
    ) -> PreparedScene {
        let Compiled {
            program,
            cells,
            beside,
            region,
        } = field;
        let (mut materials, mut objects) = (BTreeSet::new(), BTreeSet::new());
        for instruction in &program.structure().marks.instructions {
            match instruction.operation {
                Operation::Mark(0, number) => materials.insert(number),
                Operation::Mark(_, number) => objects.insert(number),
                _ => false,
            };
        }
        let only = |set: &BTreeSet<u16>| {
            if set.len() > 1 {
                None
            } else {
                Some(set.first().copied().unwrap_or(0))
            }
        };
        let mut methods = vec![scene.settings().occlusion];
        let mut method_of = Vec::new();
        for object in scene.objects() {
            let method = object.occlusion.unwrap_or(scene.settings().occlusion);
            let at = methods.iter().position(|m| *m == method);
            method_of.push(at.unwrap_or_else(|| {
                methods.push(method);
                methods.len() - 1
            }));
        }
        let parts = (scene.materials().iter())
            .flat_map(Material::patterns)
            .flat_map(|(_, pattern)| pattern.parts());
        let has_orbits = { parts }.any(|part| matches!(part, Pattern::Orbit { .. }));
        let goes_on = (scene.materials().iter())
            .any(|m| m.least_roughness() < BLURRED || m.transmission > 0.0);
        PreparedScene {
            goes_on,
            has_bumps: scene.materials().iter().any(|m| m.bump.is_some()),
            coats: Coat::all(&scene, &program),
            air: Air::of(scene.sky(), scene.lights()),
            lamps: lamp::visible(scene.lights()),
            environment,
            volumes,
            renderer,
            skins: has_skins(&scene, &program),
            scene,
            inside: program.inside(),
            inside_marks: program.inside_marks(),
            program,
            cells,
            beside,
            region,
            material: only(&materials),
            object: only(&objects),
            has_orbits,
            methods,
            method_of,
            spare: Mutex::default(),
        }
    }

    /// Whether rays may meet lights that are looked for too.
    pub(crate) fn meets_lights(&self) -> bool {
        !self.lamps.is_empty() || self.environment.is_some()
    }

    /// Whether the sky's light has the colours of what is near.
    pub(crate) fn is_tinted(&self) -> bool {
        let sky = self.volumes.sky.as_ref();
        sky.is_some_and(|sky| sky.is_coloured)
    }

    /// The volume that light number `number` was advected through, where it was, and how it is read.
    pub(crate) fn advected(&self, number: usize) -> Option<(&LightVolume, &Reading)> {
        let volume = self.volumes.light.as_deref()?;
        let reading = volume.readings.get(number)?.as_ref()?;
        Some((volume, reading))
    }

    /// Memory for a tile.
    pub(crate) fn scratch(&self) -> Box<Scratch> {
        let spare = (self.spare.lock())
            .unwrap_or_else(PoisonError::into_inner)
            .pop();
        let beside = self.beside.as_deref().map(|b| &b.closing.program);
        let mut q = spare.unwrap_or_else(|| Box::new(Scratch::new(&self.program, beside)));
        q.counts = Evaluations::default();
        q
    }

    /// Keeps it for the next tile.
    pub(crate) fn give_back(&self, q: Box<Scratch>) {
        (self.spare.lock())
            .unwrap_or_else(PoisonError::into_inner)
            .push(q);
    }

    /// The number of the material that marks stand for.
    pub(crate) fn material_of(&self, mark: usize) -> usize {
        let placed = mark.checked_sub(self.scene.materials().len());
        let coat = placed.and_then(|k| self.program.coats().get(k));
        coat.map_or(mark, |coat| usize::from(coat.material))
    }

    /// What the scene compiled to.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The cells of its program, where there are any: see [`Cells::new`].
    pub fn cells(&self) -> Option<&Cells> {
        self.cells.as_deref()
    }

    /// The scene with cells that make tapes shorter, where it has instructions enough for them: the same picture, to the bit. They are not
    /// there by default, because sorting points by cells takes as long as shorter tapes save (docs/performance.md, "Cells").
    pub fn with_cells(self) -> PreparedScene {
        let cells = |program: &Program| match program.is_unbounded() {
            true => cells_of(&self.scene, program),
            false => Cells::new(program, around(&self.scene)).map(Arc::new),
        };
        let beside = self.beside.as_ref().map(|beside| {
            Arc::new(Beside {
                closing: beside.closing.clone(),
                cells: cells(&beside.closing.program),
            })
        });
        PreparedScene {
            cells: cells(&self.program),
            beside,
            ..self
        }
    }

    /// The scene without cells: the same picture, slower or, where they were not worth while, as fast.
    pub fn without_cells(self) -> PreparedScene {
        let beside = self.beside.as_ref().map(|beside| {
            Arc::new(Beside {
                closing: beside.closing.clone(),
                cells: None,
            })
        });
        PreparedScene {
            cells: None,
            beside,
            ..self
        }
    }

    /// The scene marched as a whole, floors too: the same picture, slower.
    pub fn without_closed_forms(self) -> PreparedScene {
        PreparedScene {
            beside: None,
            ..self
        }
    }

    /// What is marched beside solids in closed form, where all rays of a picture begin outside everything.
    pub(crate) fn beside(&self, view: &View) -> Option<&Beside> {
        let beside = self.beside.as_deref()?;
        begin_outside(view, at_eye(&self.program, view)).then_some(beside)
    }

    /// What is marched.
    pub(crate) fn field(&self) -> (&Program, Option<&Cells>) {
        (&self.program, self.cells())
    }

    /// Renders as the scene's own camera and settings say, but for the size, until the observer ends it.
    pub fn render_part(
        &self,
        size: [u32; 2],
        planes: &[Plane],
        observer: &dyn Observer,
    ) -> (Part, Film) {
        let mut sums = Accumulator::new(size, self.scene.settings().antialias, planes);
        let samples = 0..sums.wanted();
        let part = self.sample_part(self.scene.camera(), samples, &mut sums, observer);
        (part, sums.into_film())
    }

    /// As [`Prepared::sample`]. Where the observer ends it, the accumulator holds the tiles that were finished by then, and
    /// anything in all other places.
    pub fn sample_part(
        &self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Part {
        let count = samples.len() as u32;
        let part = self.run(Job::new(self, camera, samples, into), into, observer);
        into.count(count);
        part
    }

    fn run(&self, job: Job<'_>, into: &mut Accumulator, observer: &dyn Observer) -> Part {
        let began = Instant::now();
        let size = into.size();
        let run = Rendering {
            picture: self,
            size,
            job,
            level: self.renderer.level,
            observer,
            cancelled: AtomicBool::new(false),
            sums: self.renderer.sums,
            finished: Mutex::default(),
        };
        let done = self.renderer.pool.install(|| run.all(into));
        let finished = run.finished.into_inner();
        let mut finished = finished.unwrap_or_else(PoisonError::into_inner);
        finished.sort_unstable();
        let area = |k: &usize| {
            let area = Area::of(*k, size);
            [area.x, area.y, area.width, area.height].map(|n| n as u32)
        };
        Part {
            statistics: Statistics {
                rays: done.rays,
                hits: done.hits,
                evaluations: done.evaluations,
                seconds: began.elapsed().as_secs_f64(),
                threads: self.renderer.threads(),
            },
            is_whole: finished.len() == Area::count(size),
            finished: finished.iter().map(area).collect(),
            spent: done.spent,
        }
    }
}

impl Prepared for PreparedScene {
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError> {
        let field = if scene.has_field_of(&self.scene) {
            Compiled {
                program: self.program.clone(),
                cells: self.cells.clone(),
                beside: self.beside.clone(),
                region: self.region,
            }
        } else {
            let (program, region) = compiled(&scene, &self.renderer.limits)?;
            Compiled {
                cells: cells_of(&scene, &program),
                beside: Beside::of(&scene, &self.renderer.limits)?,
                program,
                region,
            }
        };
        let fits = field.program.structure() == self.program.structure();
        let environment = EnvironmentMap::renewed(self.environment.as_ref(), &scene);
        let renderer = self.renderer.clone();
        let volumes = renderer.volumes(&self.volumes, &scene, &field.program)?;
        let spare = std::mem::take(&mut self.spare);
        *self = PreparedScene::of(renderer, scene, field, environment, volumes);
        if fits {
            self.spare = spare;
        }
        Ok(())
    }

    fn sample(
        &mut self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let part = self.sample_part(camera, samples, into, observer);
        if part.is_whole {
            Ok(part.statistics)
        } else {
            Err(RenderError::Cancelled)
        }
    }

    fn reseed(&mut self, seed: u32) -> Result<(), RenderError> {
        let settings = Settings {
            seed,
            ..*self.scene.settings()
        };
        self.scene = Arc::new(Scene::clone(&self.scene).with_settings(settings)?);
        Ok(())
    }

    fn is_adaptive(&self) -> bool {
        true
    }

    fn sample_where(
        &mut self,
        camera: &Camera,
        map: &SampleMap,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let job = Job::new(self, camera, 0..map.most(), into).spread(map);
        let part = self.run(job, into, observer);
        into.count(MOST);
        if part.is_whole {
            Ok(part.statistics)
        } else {
            Err(RenderError::Cancelled)
        }
    }
}

/// The field of a scene, as it is marched.
struct Compiled {
    program: Program,
    cells: Option<Arc<Cells>>,
    beside: Option<Arc<Beside>>,
    region: Region,
}

/// The cells of a scene's program, where it is steep: others do not pay yet, see [`PreparedScene::with_cells`].
fn cells_of(scene: &Scene, program: &Program) -> Option<Arc<Cells>> {
    let cells = Cells::new(program.marched(), around(scene)).filter(Cells::has_slopes)?;
    let facts = scene.objects().iter().map(|o| o.field.facts());
    let is_open = { facts }.any(|f| f.unbounded && !f.bounds.is_finite());
    Some(Arc::new(if is_open { cells.open() } else { cells }))
}

/// A box around all objects that have an end.
fn around(scene: &Scene) -> Aabb {
    let boxes = scene.objects().iter().map(|o| o.field.facts().bounds);
    boxes
        .filter(|b| b.is_finite() && !b.is_empty())
        .fold(Aabb::EMPTY, |all, b| all.hull(&b))
}

/// Rows of sums that tiles beside each other add to.
type Band<'f> = Mutex<Vec<(Sum, &'f mut [f32])>>;

/// One rendering.
struct Rendering<'a> {
    picture: &'a PreparedScene,
    size: [u32; 2],
    job: Job<'a>,
    level: Level,
    observer: &'a dyn Observer,
    cancelled: AtomicBool,
    /// Bytes of sums at a time.
    sums: u64,
    /// Numbers of the tiles that are finished.
    finished: Mutex<Vec<usize>>,
}

impl Rendering<'_> {
    fn all(&self, into: &mut Accumulator) -> Done {
        let mut bands = bands(into);
        if self.job.is_filtered() {
            return self.filtered(&mut bands);
        }
        let tiles = (0..Area::count(self.size)).into_par_iter();
        tiles.map(|k| self.tile(k, &mut [], &bands)).sum()
    }

    /// Renders all tiles, some rows of them at a time so that their sums take limited memory, and filters what is complete.
    /// The order in which a pixel's sums are added is that of the tiles, however many rows there are at a time.
    fn filtered(&self, bands: &mut [Band<'_>]) -> Done {
        let across = (self.size[0] as usize).div_ceil(WIDTH);
        let (row, down) = (across * ACCUMULATORS, bands.len());
        let step = rows(self.size, self.sums);
        // two rows stay for the filter, which reaches from a row into the next one
        let mut sums = vec![0.0; (step + 2).min(down) * row];
        // the first row of tiles that has sums, and the first band that is not filtered yet
        let (mut first, mut open) = (0, 0);
        let mut done = Done::default();
        for from in (0..down).step_by(step) {
            let to = (from + step).min(down);
            let kept = from.saturating_sub(2);
            sums.copy_within((kept - first) * row..(from - first) * row, 0);
            first = kept;
            let new = &mut sums[(from - first) * row..(to - first) * row];
            let tiles = new.par_chunks_exact_mut(ACCUMULATORS).enumerate();
            let tile = |(k, sums): (usize, &mut [f32])| {
                sums.fill(0.0);
                self.tile(from * across + k, sums, bands)
            };
            done = [done, tiles.map(tile).sum()].into_iter().sum();
            // the last row of tiles still gets samples from the next one
            let complete = if to == down { down } else { to - 1 };
            let filter = |(k, band): (usize, &mut Band<'_>)| {
                let band = band.get_mut().unwrap_or_else(PoisonError::into_inner);
                resolve::band(open + k, &sums, first, self.size, band);
            };
            bands[open..complete]
                .par_iter_mut()
                .enumerate()
                .for_each(filter);
            open = complete;
        }
        done
    }

    /// Renders tile number `k`.
    fn tile(&self, k: usize, sums: &mut [f32], bands: &[Band<'_>]) -> Done {
        let instructions = self.picture.program.structure().values.instructions.len();
        let stop = Stop::new(self.observer, &self.cancelled, instructions);
        if stop.is_set() {
            return Done::default();
        }
        let area = Area::of(k, self.size);
        let mut q = self.picture.scratch();
        let done = at_level!(self.level, s => self.job.tile(s, k, &area, sums, &mut q, &stop));
        if stop.is_set() {
            // another thread may have set it after the last sample: then the tile is lost, which does no harm
            return Done {
                spent: done.spent,
                ..Done::default()
            };
        }
        let band = &mut *bands[area.y / HEIGHT]
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        self.job.deliver(&area, self.size, &q, band);
        self.picture.give_back(q);
        self.finished
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(k);
        let total = self.job.rays(self.size);
        self.observer.advance(done.rays, total);
        done
    }
}

/// Rows of tiles that are rendered at a time for their sums, and those of the two rows before them, to take so many bytes.
fn rows(size: [u32; 2], bytes: u64) -> usize {
    let across = (size[0] as usize).div_ceil(WIDTH);
    let down = (size[1] as usize).div_ceil(HEIGHT);
    let fits = bytes as usize / (4 * across * ACCUMULATORS).max(1);
    fits.saturating_sub(2).clamp(1, down.max(1))
}

/// Bytes of the sums of samples that are kept at a time for a picture of this size.
pub fn sums(size: [u32; 2]) -> u64 {
    let across = u64::from(size[0]).div_ceil(WIDTH as u64);
    let down = u64::from(size[1]).div_ceil(HEIGHT as u64);
    let rows = (rows(size, SUMS) as u64 + 2).min(down);
    rows * across * 4 * ACCUMULATORS as u64
}

/// What tiles took. Sums of whole numbers: their order does not matter.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Done {
    pub(crate) rays: u64,
    pub(crate) hits: u64,
    pub(crate) evaluations: Evaluations,
    /// Evaluations of all stages, those of unfinished tiles included.
    pub(crate) spent: u64,
}

impl std::iter::Sum for Done {
    fn sum<I: Iterator<Item = Done>>(all: I) -> Done {
        all.fold(Done::default(), |a, b| Done {
            rays: a.rays + b.rays,
            hits: a.hits + b.hits,
            evaluations: a.evaluations.plus(&b.evaluations),
            spent: a.spent + b.spent,
        })
    }
}

/// The rows of all sums, cut into bands as high as a tile.
fn bands(into: &mut Accumulator) -> Vec<Band<'_>> {
    let [width, height] = into.size().map(|n| n as usize);
    let mut bands: Vec<Vec<(Sum, &mut [f32])>> =
        (0..height.div_ceil(HEIGHT)).map(|_| Vec::new()).collect();
    for (sum, numbers) in into.sums_mut() {
        let rows = numbers.chunks_mut(width * sum.channels() * HEIGHT);
        for (band, rows) in bands.iter_mut().zip(rows) {
            band.push((sum, rows));
        }
    }
    bands.into_iter().map(Mutex::new).collect()
}

#[cfg(test)]
mod tests;
