//! The renderer: pictures, and what is done when the device fails.

use crate::adapter::{AdapterInfo, Choice, Kind};
use crate::band::{BUDGET, LEAST_BUDGET};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::fault::Faults;
use crate::flight::Flight;
use crate::memory::Memory;
use crate::picture::{Bench, Course, Progress};
use crate::pipeline::{Cache, Layouts};
use crate::timing::Timings;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use web_time::Instant;
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::camera::Camera;
use zeroset_scene::render::{Observer, Prepared, RenderError, Renderer, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_shader::{FieldForm, Job, Shaders};

/// The GPU's renderer.
///
/// Shaders, buffers and what is known about their speed are kept from picture to picture, and shared by clones; pictures of
/// several threads are rendered one after the other. Where the device ends loops early, rays are traced in turns; where memory runs out, a picture
/// is rendered in smaller bands; where the device is lost, it is opened anew, once a picture. What remains is an error, and the renderer can be asked again.
///
/// ```
/// use zeroset_gpu::{Choice, GpuRenderer};
/// use zeroset_language::load::{Language, Options, load_text};
/// use zeroset_scene::render::{Renderer, Silent};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let options = Options { size: Some([48, 32]), ..Options::default() };
/// let loaded = load_text("a.star", "show(sphere())", Language::Starlark, None, &options)?;
/// match GpuRenderer::new(&Choice::Any) {
///     Ok(renderer) => assert!(renderer.render(&loaded.scene, &Silent)?.statistics.rays > 0),
///     Err(error) => println!("rendering on the CPU: {error}"),
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone)]
pub struct GpuRenderer {
    choice: Choice,
    faults: Faults,
    adapter: AdapterInfo,
    state: Arc<Mutex<State>>,
}

struct State {
    shaders: Shaders,
    opened: Option<Opened>,
    /// Bytes of the buffers of a band together.
    budget: u64,
    timings: Option<Timings>,
}

/// Words of registers that software compiles arrays for: lavapipe takes 3 s for 16 points and 16 values, 19 s for 32 points,
/// 120 s for 64.
const MOST_REGISTERS_OF_SOFTWARE: u32 = 256;
/// Words of registers that a thread of a GPU has room for, 32 KiB.
const MOST_REGISTERS: u32 = 8192;
/// Texts of shaders that are remembered for their loops.
const REMEMBERED: usize = 64;

/// A device and all that belongs to it.
struct Opened {
    /// Texts of shaders whose loops the device ended early: their rays are traced in turns.
    cut_short: Vec<Arc<str>>,
    gpu: Arc<Gpu>,
    layouts: Arc<Layouts>,
    cache: Cache,
    memory: Memory,
    flight: Flight,
}

impl Opened {
    fn new(gpu: Arc<Gpu>) -> Result<Opened, GpuError> {
        Ok(Opened {
            layouts: Arc::new(Layouts::new(&gpu)?),
            flight: Flight::new(&gpu)?,
            cache: Cache::default(),
            memory: Memory::default(),
            cut_short: Vec::new(),
            gpu,
        })
    }

    /// Whether the rays of a job must be traced in turns: the device is known to end the loops of its shader early, or would
    /// compile too long for its registers, or has no room for them.
    fn needs_turns(&self, job: &Job) -> bool {
        let most = match self.gpu.info().kind {
            Kind::Software => MOST_REGISTERS_OF_SOFTWARE,
            _ => MOST_REGISTERS,
        };
        job.registers > most || self.is_cut_short(job)
    }

    fn is_cut_short(&self, job: &Job) -> bool {
        let is_it = |text: &Arc<str>| Arc::ptr_eq(text, &job.source) || *text == job.source;
        self.cut_short.iter().any(is_it)
    }
}

impl GpuRenderer {
    /// A renderer on the adapter that a choice means.
    ///
    /// # Errors
    /// There is no such adapter, it lacks something, or its driver gives no device.
    pub fn new(choice: &Choice) -> Result<GpuRenderer, GpuError> {
        GpuRenderer::with_faults(choice, Faults::default())
    }

    /// A renderer that fails on demand.
    ///
    /// # Errors
    /// As [`GpuRenderer::new`].
    #[doc(hidden)]
    pub fn with_faults(choice: &Choice, faults: Faults) -> Result<GpuRenderer, GpuError> {
        let gpu = Arc::new(Gpu::open_with(choice, faults.clone())?);
        let adapter = gpu.info().clone();
        let state = State {
            shaders: Shaders::new(FieldForm::default()),
            opened: Some(Opened::new(gpu)?),
            budget: BUDGET,
            timings: None,
        };
        Ok(GpuRenderer {
            choice: choice.clone(),
            faults,
            adapter,
            state: Arc::new(Mutex::new(state)),
        })
    }

    /// With another way to bring fields into shaders than the automatic one.
    #[must_use]
    pub fn with_form(self, form: FieldForm) -> GpuRenderer {
        self.state().shaders = Shaders::new(form);
        self
    }

    /// With another limit on the bytes of all buffers of a picture together, about 256 MiB otherwise. A picture that needs
    /// more is rendered in bands.
    #[must_use]
    pub fn with_budget(self, bytes: u64) -> GpuRenderer {
        self.state().budget = bytes;
        self
    }

    /// The adapter.
    pub fn adapter(&self) -> &AdapterInfo {
        &self.adapter
    }

    /// What the last finished picture took.
    pub fn timings(&self) -> Option<Timings> {
        self.state().timings.clone()
    }

    /// What a scene is for the GPU.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub fn job(&self, scene: &Scene) -> Result<Job, RenderError> {
        self.state().shaders.prepare(scene)
    }

    /// Adds samples of a job to the sums of a picture of the job's size.
    ///
    /// # Errors
    /// See [`GpuError`]; the sums are then good for nothing.
    pub fn sample(
        &self,
        job: &Job,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, GpuError> {
        let began = Instant::now();
        let mut state = self.state();
        let (size, count) = (job.frame.size, samples.len() as u32);
        let mut timings = Timings::new(self.adapter.clone(), size, count);
        let mut progress = Progress::new(observer, size, count);
        let mut course = Course::default();
        let mut was_lost = false;
        loop {
            let mut errand = Errand {
                job,
                samples: &samples,
                into,
                course: &mut course,
                progress: &mut progress,
                timings: &mut timings,
            };
            let failure = match self.attempt(&mut state, &mut errand) {
                Ok(()) => break,
                Err(failure) => failure,
            };
            match &failure {
                GpuError::OutOfMemory { .. } if state.budget > LEAST_BUDGET => {
                    state.budget = (state.budget / 4).max(LEAST_BUDGET);
                    if let Some(opened) = &mut state.opened {
                        opened.memory = Memory::default();
                    }
                    tracing::debug!("{failure}: {} bytes are tried", state.budget);
                }
                GpuError::Lost { .. } if !was_lost => {
                    was_lost = true;
                    state.opened = None;
                    tracing::debug!("{failure}: it is opened anew");
                }
                GpuError::Loops { .. } => {
                    let Some(opened) = state.opened.as_mut().filter(|o| !o.needs_turns(job)) else {
                        return Err(failure);
                    };
                    tracing::debug!("{failure}: rays are traced in turns");
                    if opened.cut_short.len() == REMEMBERED {
                        opened.cut_short.remove(0);
                    }
                    opened.cut_short.push(Arc::clone(&job.source));
                }
                // what is still on its way is waited for by the next picture
                GpuError::Scene(RenderError::Cancelled) => return Err(failure),
                _ => {
                    // whatever is left of it is not trusted
                    state.opened = None;
                    return Err(failure);
                }
            }
            progress.restart();
            timings.retries += 1;
        }
        into.count(count);
        timings.wall = began.elapsed().as_secs_f64();
        let seconds = timings.wall;
        state.timings = Some(timings);
        Ok(Statistics {
            seconds,
            ..course.statistics()
        })
    }

    fn attempt(&self, state: &mut State, errand: &mut Errand<'_, '_>) -> Result<(), GpuError> {
        let Errand {
            job,
            samples,
            into,
            course,
            progress,
            timings,
        } = errand;
        let job: &Job = job;
        let opened = match &mut state.opened {
            Some(opened) => opened,
            none => {
                let gpu = Gpu::open_with(&self.choice, self.faults.clone())?;
                none.insert(Opened::new(Arc::new(gpu))?)
            }
        };
        opened.flight.drain(&mut **progress)?;
        let turned = if opened.needs_turns(job) {
            state.shaders.in_turns(job)
        } else {
            None
        };
        let job = turned.as_ref().unwrap_or(job);
        let began = Instant::now();
        let set = opened.cache.get(
            &opened.gpu,
            &opened.layouts,
            &job.source,
            progress.observer(),
        )?;
        if !set.is_warm {
            timings.compile += began.elapsed().as_secs_f64();
        }
        let before = opened.flight.submissions;
        let mut bench = Bench {
            gpu: &opened.gpu,
            layouts: &opened.layouts,
            memory: &mut opened.memory,
            flight: &mut opened.flight,
            set,
            budget: state.budget,
        };
        bench.render(job, samples, into, course, progress, timings)?;
        timings.submissions += opened.flight.submissions - before;
        Ok(())
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What is to be sampled, and how far that is.
struct Errand<'a, 'o> {
    job: &'a Job,
    samples: &'a Range<u32>,
    into: &'a mut Accumulator,
    course: &'a mut Course,
    progress: &'a mut Progress<'o>,
    timings: &'a mut Timings,
}

impl Renderer for GpuRenderer {
    fn name(&self) -> String {
        self.adapter.title()
    }

    fn prepare(&self, scene: Arc<Scene>) -> Result<Box<dyn Prepared>, RenderError> {
        let job = self.job(&scene)?;
        let renderer = self.clone();
        Ok(Box::new(PreparedScene { renderer, job }))
    }
}

/// A scene that is ready to be rendered on the GPU.
struct PreparedScene {
    renderer: GpuRenderer,
    job: Job,
}

impl Prepared for PreparedScene {
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError> {
        self.job = self.renderer.job(&scene)?;
        Ok(())
    }

    fn sample(
        &mut self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let job = self.job.seen(camera, into.size(), into.antialias());
        Ok(self.renderer.sample(&job, samples, into, observer)?)
    }
}
