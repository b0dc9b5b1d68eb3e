//! The device: everything that can fail in a driver fails here, as a typed error.

use crate::adapter::{self, AdapterInfo, Adapters, Choice};
use crate::error::GpuError;
use crate::fault::Faults;
use crate::host::{Host, Signal};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;
use wgpu::{
    BufferUsages, ErrorFilter, Extent3d, Features, SubmissionIndex, TextureDimension,
    TextureFormat, TextureUsages,
};
use zeroset_scene::render::RenderError;

/// A device that does not finish one submission in this time is given up. Submissions are made to take milliseconds.
const PATIENCE: Duration = Duration::from_secs(20);
/// As long as this where a driver may be compiling.
const COMPILING: Duration = Duration::from_secs(180);
/// As long as this for work of a picture that nobody waits for any more, before the next one begins.
const LEFT: Duration = Duration::from_secs(3);
/// Who waits is asked whether to stop this often.
const LOOK: Duration = Duration::from_millis(50);

/// What a device is waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// Dispatches, which are made to take milliseconds.
    Dispatches,
    /// The same, where a driver may be compiling their shader.
    Compiling,
    /// What a picture that was cancelled left behind.
    Left,
}

/// Work that was given to a device.
pub(crate) struct Submission {
    index: SubmissionIndex,
    done: Signal,
}

/// An opened GPU.
pub(crate) struct Gpu {
    info: AdapterInfo,
    limits: wgpu::Limits,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// Nanoseconds a tick of the GPU's clock, if it has one.
    pub(crate) tick: Option<f64>,
    status: Arc<Status>,
    faults: Faults,
    pub(crate) host: &'static dyn Host,
}

/// What the driver said on its own.
#[derive(Default)]
struct Status {
    lost: Mutex<Option<String>>,
    refused: Mutex<Option<String>>,
}

impl Status {
    fn lose(&self, reason: &str) {
        set(&self.lost, reason);
    }
}

/// The first message stays: later ones are its consequences.
fn set(slot: &Mutex<Option<String>>, message: &str) {
    slot.lock()
        .unwrap_or_else(PoisonError::into_inner)
        .get_or_insert_with(|| message.trim().to_owned());
}

fn get(slot: &Mutex<Option<String>>) -> Option<String> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn take(slot: &Mutex<Option<String>>) -> Option<String> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).take()
}

impl Gpu {
    /// Opens the adapter that a choice means.
    ///
    /// # Errors
    /// There is none, it lacks something, or its driver gives no device.
    pub(crate) async fn open(
        choice: &Choice,
        faults: Faults,
        host: &'static dyn Host,
    ) -> Result<Gpu, GpuError> {
        let adapter = Adapters::choose(choice).await?;
        let info = AdapterInfo::new(&adapter);
        let limits = adapter::needed(&adapter.limits());
        let failed = |reason: String| GpuError::NoDevice {
            adapter: info.title(),
            reason,
        };
        if faults.refuses_device() {
            return Err(failed("a fault that was asked for".to_owned()));
        }
        let stamps = adapter.features() & Features::TIMESTAMP_QUERY;
        let asked = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("zeroset"),
            required_features: stamps,
            required_limits: limits.clone(),
            experimental_features: wgpu::ExperimentalFeatures::disabled(),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            trace: wgpu::Trace::Off,
        });
        let (device, queue) = asked.await.map_err(|e| failed(e.to_string()))?;
        let status = Arc::new(Status::default());
        let told = Arc::clone(&status);
        device.set_device_lost_callback(move |reason, message| {
            tracing::debug!("the GPU was lost ({reason:?}): {message}");
            told.lose(if message.is_empty() {
                "the driver does not say why"
            } else {
                &message
            });
        });
        let told = Arc::clone(&status);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            tracing::debug!("the GPU refused a command: {error}");
            set(&told.refused, &error.to_string());
        }));
        let period = f64::from(queue.get_timestamp_period());
        let tick = (!stamps.is_empty() && period > 0.0).then_some(period);
        tracing::debug!("rendering on {}, {}", info.title(), info.driver);
        Ok(Gpu {
            info,
            limits,
            device,
            queue,
            tick,
            status,
            faults,
            host,
        })
    }

    /// The adapter.
    pub(crate) fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// What the device allows.
    pub(crate) fn limits(&self) -> &wgpu::Limits {
        &self.limits
    }

    /// The largest buffer that a shader may see, bytes.
    pub(crate) fn largest_binding(&self) -> u64 {
        let limits = &self.limits;
        // a multiple of 16 keeps every element whole
        limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size)
            & !15
    }

    /// Whether the device is gone, or refused a command that nobody watched.
    pub(crate) fn check(&self) -> Result<(), GpuError> {
        if let Some(reason) = get(&self.status.lost) {
            return Err(GpuError::Lost {
                adapter: self.info.title(),
                reason,
            });
        }
        // told once: the device goes on working
        match take(&self.status.refused) {
            Some(reason) => Err(GpuError::Refused {
                adapter: self.info.title(),
                reason,
            }),
            None => Ok(()),
        }
    }

    /// Runs commands, and says what the driver says about them. They allocate `bytes`, for the message.
    pub(crate) async fn watched<T>(
        &self,
        bytes: u64,
        run: impl FnOnce() -> T,
    ) -> Result<T, GpuError> {
        let scopes = [
            ErrorFilter::Validation,
            ErrorFilter::Internal,
            ErrorFilter::OutOfMemory,
        ]
        .map(|filter| self.device.push_error_scope(filter));
        let made = run();
        let mut first = None;
        // scopes close in the reverse of the order that they were opened in
        for scope in scopes.into_iter().rev() {
            let error = scope.pop().await;
            first = first.or(error);
        }
        match first {
            None => self.check().map(|()| made),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(self.out_of_memory("its commands", bytes)),
            Some(error) => {
                self.check()?;
                Err(GpuError::Refused {
                    adapter: self.info.title(),
                    reason: error.to_string(),
                })
            }
        }
    }

    fn out_of_memory(&self, what: &str, bytes: u64) -> GpuError {
        GpuError::OutOfMemory {
            adapter: self.info.title(),
            what: what.to_owned(),
            bytes,
        }
    }

    /// A buffer of zeros. `what` it is for, for the message.
    pub(crate) async fn buffer(
        &self,
        what: &'static str,
        bytes: u64,
        usage: BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        if self.faults.fails_allocation(bytes) || bytes > self.limits.max_buffer_size {
            return Err(self.out_of_memory(what, bytes));
        }
        self.watched(bytes, || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                // no buffer may be empty where a shader sees it
                size: bytes.max(16).next_multiple_of(16),
                usage,
                mapped_at_creation: false,
            })
        })
        .await
        .map_err(|error| error.with_purpose(what))
    }

    /// A texture that shaders read by places. `what` it is for, for the message.
    pub(crate) async fn texture(
        &self,
        what: &str,
        size: Extent3d,
        format: TextureFormat,
    ) -> Result<wgpu::Texture, GpuError> {
        let texels = [size.width, size.height, size.depth_or_array_layers].map(u64::from);
        let texel = format.block_copy_size(None).unwrap_or(0);
        let bytes = texels.into_iter().product::<u64>() * u64::from(texel);
        if self.faults.fails_allocation(bytes) {
            return Err(self.out_of_memory(what, bytes));
        }
        self.watched(bytes, || {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format,
                usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
                view_formats: &[],
            })
        })
        .await
        .map_err(|error| error.with_purpose(what))
    }

    /// Gives the GPU something to do.
    pub(crate) async fn submit(
        &self,
        encoder: wgpu::CommandEncoder,
    ) -> Result<Submission, GpuError> {
        if self.faults.loses_device() {
            self.device.destroy();
            self.status.lose("a fault that was asked for");
        }
        let index = self
            .watched(0, || self.queue.submit([encoder.finish()]))
            .await?;
        let done = Signal::default();
        let told = done.clone();
        self.queue.on_submitted_work_done(move || told.give());
        Ok(Submission { index, done })
    }

    /// Waits until a submission is done, and buffers that are mapped after it. A device that does not answer counts as lost.
    ///
    /// # Errors
    /// The device is lost, or `stop` says that nobody waits any more; the submission is then still on its way.
    pub(crate) async fn wait(
        &self,
        submission: &Submission,
        mapped: &[Signal],
        work: Work,
        stop: &dyn Fn() -> bool,
    ) -> Result<(), GpuError> {
        let usual = match work {
            Work::Dispatches => PATIENCE,
            Work::Compiling => COMPILING,
            Work::Left => LEFT,
        };
        let patience = self.faults.patience().unwrap_or(usual);
        let began = Instant::now();
        loop {
            let most = LOOK.min(patience);
            let paused = (self.host).pause(&self.device, &submission.index, most);
            if let Err(reason) = paused.await {
                self.status.lose(&reason);
            }
            self.check()?;
            if submission.done.is_given() && mapped.iter().all(Signal::is_given) {
                return Ok(());
            }
            if stop() {
                return Err(GpuError::Scene(RenderError::Cancelled));
            }
            if began.elapsed() >= patience {
                let seconds = patience.as_secs_f32();
                self.status
                    .lose(&format!("it did not answer for {seconds} s"));
                self.check()?;
            }
        }
    }
}

/// Dropping a queue waits for its work, which never ends on a lost device and takes as long as a driver compiles where a shader
/// is run first; it panics where the work was not finished. Nobody who cancels a picture may have to wait for that: the
/// process lives on with the device instead, and with what little of it the driver has not freed.
impl Drop for Gpu {
    fn drop(&mut self) {
        if get(&self.status.lost).is_some() || !self.host.is_idle(&self.device) {
            tracing::debug!("{} is left as it is", self.info.title());
            std::mem::forget(self.queue.clone());
        }
    }
}
