//! The renderer of native programs, which wait: the only module that blocks a thread.
//!
//! Everything else of this crate is asynchronous, and asks a [`Host`] where it has to wait or to compile.

use crate::adapter::{self, AdapterInfo, Choice};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::fault::Faults;
use crate::host::{Host, Later};
use crate::pipeline::{Layouts, Pipelines, compile};
use crate::renderer::Core;
use crate::timing::Timings;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;
use web_time::Instant;
use wgpu::{Device, PollError, PollType, SubmissionIndex};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::camera::Camera;
use zeroset_scene::motion::Moving;
use zeroset_scene::render::{Observer, Prepared, RenderError, Renderer, Statistics};
use zeroset_scene::scene::{Object, Scene};
use zeroset_shader::{FieldForm, Job, Shaders};

/// How long a driver may compile.
const PATIENCE: Duration = Duration::from_secs(120);
/// Parsing and the compilers of drivers recurse along expressions: main threads of some systems have 1 MiB.
const STACK: usize = 64 << 20;
/// How long a device that is dropped is waited for.
const GOODBYE: Duration = Duration::from_millis(200);

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
    adapter: AdapterInfo,
    core: Arc<Mutex<Core>>,
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
        let core = now(Core::open(choice, faults, &Blocking))?;
        Ok(GpuRenderer {
            adapter: core.adapter().clone(),
            core: Arc::new(Mutex::new(core)),
        })
    }

    /// With another way to bring fields into shaders than the automatic one.
    #[must_use]
    pub fn with_form(self, form: FieldForm) -> GpuRenderer {
        self.core().shaders = Shaders::new(form);
        self
    }

    /// With another limit on the bytes of all buffers of a picture together, about 256 MiB otherwise. A picture that needs
    /// more is rendered in bands.
    #[must_use]
    pub fn with_budget(self, bytes: u64) -> GpuRenderer {
        self.core().budget = bytes;
        self
    }

    /// The adapter.
    pub fn adapter(&self) -> &AdapterInfo {
        &self.adapter
    }

    /// What the last finished picture took.
    pub fn timings(&self) -> Option<Timings> {
        self.core().timings.clone()
    }

    /// What a scene is for the GPU.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub fn job(&self, scene: &Scene) -> Result<Job, RenderError> {
        let is_unbounded = |o: &&Object| o.field.facts().unbounded;
        if let Some(object) = scene.objects().iter().find(is_unbounded) {
            let object = object.name.clone();
            return Err(GpuError::Unbounded { object }.into());
        }
        self.core().shaders.prepare(scene)
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
        now(self.core().sample(job, samples, into, observer))
    }

    fn core(&self) -> MutexGuard<'_, Core> {
        self.core.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Renderer for GpuRenderer {
    fn name(&self) -> String {
        self.adapter.title()
    }

    fn prepare(&self, scene: Arc<Scene>) -> Result<Box<dyn Prepared>, RenderError> {
        let job = self.job(&scene)?;
        let renderer = self.clone();
        let prepared = PreparedScene { renderer, job };
        Ok(Box::new(Moving::new(scene, Box::new(prepared))))
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

    fn reseed(&mut self, seed: u32) -> Result<(), RenderError> {
        self.job.frame.seed = seed;
        Ok(())
    }
}

/// All adapters, the best first, and the number of the one that [`Choice::Auto`] takes.
pub fn adapters() -> (Vec<AdapterInfo>, Option<usize>) {
    now(adapter::adapters())
}

/// What a future gives, waited for on this thread.
pub(crate) fn now<F: Future>(future: F) -> F::Output {
    pollster::block_on(future)
}

/// A host that blocks its thread.
struct Blocking;

impl Host for Blocking {
    fn pause<'a>(
        &'a self,
        device: &'a Device,
        submission: &'a SubmissionIndex,
        most: Duration,
    ) -> Later<'a, Result<(), String>> {
        let wait = PollType::Wait {
            submission_index: Some(submission.clone()),
            timeout: Some(most),
        };
        Box::pin(async move {
            // wgpu panics where the driver reports the loss of the device while it is waited for
            match catch_unwind(AssertUnwindSafe(|| device.poll(wait))) {
                Ok(Ok(_) | Err(PollError::Timeout)) => Ok(()),
                Ok(Err(error)) => Err(error.to_string()),
                Err(_) => Err("the driver failed while it was waited for".to_owned()),
            }
        })
    }

    fn compile<'a>(
        &'a self,
        gpu: &'a Arc<Gpu>,
        layouts: &'a Arc<Layouts>,
        source: &'a Arc<str>,
        observer: &'a dyn Observer,
    ) -> Later<'a, Result<Pipelines, GpuError>> {
        Box::pin(async move { compile_apart(gpu, layouts, source, observer) })
    }

    fn is_idle(&self, device: &Device) -> bool {
        let wait = PollType::Wait {
            submission_index: None,
            timeout: Some(GOODBYE),
        };
        matches!(
            catch_unwind(AssertUnwindSafe(|| device.poll(wait))),
            Ok(Ok(status)) if status.is_queue_empty()
        )
    }
}

/// Compiles on a thread with a large stack, which is left behind if the driver does not come back.
#[allow(
    clippy::disallowed_methods,
    reason = "drivers of systems, which have threads"
)]
fn compile_apart(
    gpu: &Arc<Gpu>,
    layouts: &Arc<Layouts>,
    source: &Arc<str>,
    observer: &dyn Observer,
) -> Result<Pipelines, GpuError> {
    let (tell, told) = mpsc::channel();
    let apart = (Arc::clone(gpu), Arc::clone(layouts), Arc::clone(source));
    let began = Instant::now();
    thread::Builder::new()
        .name("compile shader".to_owned())
        .stack_size(STACK)
        .spawn(move || {
            // nobody listens any more: the rendering was cancelled
            let _ = tell.send(now(compile(&apart.0, &apart.1, &apart.2)));
        })
        .map_err(|error| GpuError::Shader {
            log: format!("no thread can be started for it: {error}"),
        })?;
    loop {
        match told.recv_timeout(Duration::from_millis(20)) {
            Ok(compiled) => return compiled,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(GpuError::Shader {
                    log: "the compiler failed".to_owned(),
                });
            }
            Err(RecvTimeoutError::Timeout) if observer.is_cancelled() => {
                return Err(GpuError::Scene(RenderError::Cancelled));
            }
            Err(RecvTimeoutError::Timeout) if began.elapsed() > PATIENCE => {
                return Err(GpuError::SlowCompiler {
                    seconds: PATIENCE.as_secs(),
                });
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
}
