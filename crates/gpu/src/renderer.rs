//! The renderer without anybody who waits for it: pictures, and what is done when the device fails.

use crate::adapter::{AdapterInfo, Choice, Kind};
use crate::band::{BUDGET, LEAST_BUDGET};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::fault::Faults;
use crate::host::Host;
use crate::memory::Memory;
use crate::picture::{PictureResources, Progress, RowsDone};
use crate::pipeline::{Cache, Layouts};
use crate::render_queue::RenderQueue;
use crate::timing::Timings;
use std::ops::Range;
use std::sync::Arc;
use web_time::Instant;
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::render::{Observer, RenderError, Statistics};
use zeroset_shader::{FieldForm, Job, Shaders};

/// A renderer on a device, which is opened anew where it fails.
pub(crate) struct Core {
    choice: Choice,
    faults: Faults,
    host: &'static dyn Host,
    adapter: AdapterInfo,
    pub(crate) shaders: Shaders,
    opened: Option<Opened>,
    /// Bytes of the buffers of a band together.
    pub(crate) budget: u64,
    /// What the last finished picture took.
    pub(crate) timings: Option<Timings>,
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
    render_queue: RenderQueue,
}

impl Opened {
    async fn new(gpu: Arc<Gpu>) -> Result<Opened, GpuError> {
        Ok(Opened {
            layouts: Arc::new(Layouts::new(&gpu).await?),
            render_queue: RenderQueue::new(&gpu).await?,
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

impl Core {
    /// A renderer on the adapter that a choice means.
    ///
    /// # Errors
    /// There is no such adapter, it lacks something, or its driver gives no device.
    pub(crate) async fn open(
        choice: &Choice,
        faults: Faults,
        host: &'static dyn Host,
    ) -> Result<Core, GpuError> {
        let gpu = Arc::new(Gpu::open(choice, faults.clone(), host).await?);
        Ok(Core {
            choice: choice.clone(),
            faults,
            host,
            adapter: gpu.info().clone(),
            shaders: Shaders::new(FieldForm::default()),
            opened: Some(Opened::new(gpu).await?),
            budget: BUDGET,
            timings: None,
        })
    }

    /// The adapter.
    pub(crate) fn adapter(&self) -> &AdapterInfo {
        &self.adapter
    }

    /// Adds samples of a job to the sums of a picture of the job's size.
    ///
    /// # Errors
    /// See [`GpuError`]; the sums are then good for nothing.
    pub(crate) async fn sample(
        &mut self,
        job: &Job,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, GpuError> {
        let began = Instant::now();
        let (size, count) = (job.frame.size, samples.len() as u32);
        let mut timings = Timings::new(self.adapter.clone(), size, count);
        let mut progress = Progress::new(observer, size, count);
        let mut rows_done = RowsDone::default();
        let mut was_lost = false;
        loop {
            let mut request = SampleRequest {
                job,
                samples: &samples,
                into,
                rows_done: &mut rows_done,
                progress: &mut progress,
                timings: &mut timings,
            };
            let failure = match self.attempt(&mut request).await {
                Ok(()) => break,
                Err(failure) => failure,
            };
            match &failure {
                GpuError::OutOfMemory { .. } if self.budget > LEAST_BUDGET => {
                    self.budget = (self.budget / 4).max(LEAST_BUDGET);
                    if let Some(opened) = &mut self.opened {
                        opened.memory = Memory::default();
                    }
                    tracing::debug!("{failure}: {} bytes are tried", self.budget);
                }
                GpuError::Lost { .. } if !was_lost => {
                    was_lost = true;
                    self.opened = None;
                    tracing::debug!("{failure}: it is opened anew");
                }
                GpuError::Loops { .. } => {
                    let Some(opened) = self.opened.as_mut().filter(|o| !o.needs_turns(job)) else {
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
                    self.opened = None;
                    return Err(failure);
                }
            }
            progress.restart();
            timings.retries += 1;
        }
        into.count(count);
        timings.wall = began.elapsed().as_secs_f64();
        let seconds = timings.wall;
        self.timings = Some(timings);
        Ok(Statistics {
            seconds,
            ..rows_done.statistics()
        })
    }

    async fn attempt(&mut self, request: &mut SampleRequest<'_, '_>) -> Result<(), GpuError> {
        let SampleRequest {
            job,
            samples,
            into,
            rows_done,
            progress,
            timings,
        } = request;
        let job: &Job = job;
        let opened = match &mut self.opened {
            Some(opened) => opened,
            none => {
                let gpu = Gpu::open(&self.choice, self.faults.clone(), self.host).await?;
                none.insert(Opened::new(Arc::new(gpu)).await?)
            }
        };
        opened.render_queue.drain(&mut **progress).await?;
        let turned = if opened.needs_turns(job) {
            self.shaders.in_turns(job)
        } else {
            None
        };
        let job = turned.as_ref().unwrap_or(job);
        let began = Instant::now();
        let (gpu, layouts) = (&opened.gpu, &opened.layouts);
        let set = (opened.cache)
            .get(gpu, layouts, &job.source, progress.observer())
            .await?;
        if !set.is_warm {
            timings.compile += began.elapsed().as_secs_f64();
        }
        let before = opened.render_queue.submissions;
        let mut resources = PictureResources {
            gpu: &opened.gpu,
            layouts: &opened.layouts,
            memory: &mut opened.memory,
            render_queue: &mut opened.render_queue,
            set,
            budget: self.budget,
        };
        resources
            .render(job, samples, into, rows_done, progress, timings)
            .await?;
        timings.submissions += opened.render_queue.submissions - before;
        Ok(())
    }
}

/// What is to be sampled, and how far that is.
struct SampleRequest<'a, 'o> {
    job: &'a Job,
    samples: &'a Range<u32>,
    into: &'a mut Accumulator,
    rows_done: &'a mut RowsDone,
    progress: &'a mut Progress<'o>,
    timings: &'a mut Timings,
}
