//! The device: everything that can fail in a driver fails here, as a typed error.

use crate::adapter::{self, AdapterInfo, Adapters, Choice};
use crate::error::GpuError;
use crate::fault::Faults;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;
use wgpu::{
    BufferUsages, ErrorFilter, Extent3d, Features, PollError, PollType, SubmissionIndex,
    TextureDimension, TextureFormat, TextureUsages,
};
use zeroset_scene::render::RenderError;

/// A device that does not finish one submission in this time is given up. Submissions are made to take milliseconds.
const PATIENCE: Duration = Duration::from_secs(20);
/// As long as this where a driver may be compiling.
const COMPILING: Duration = Duration::from_secs(180);
/// As long as this for work of a picture that nobody waits for any more, before the next one begins.
const LEFT: Duration = Duration::from_secs(3);
/// As long as this where a device is dropped.
const GOODBYE: Duration = Duration::from_millis(200);
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

/// An opened GPU.
pub struct Gpu {
    info: AdapterInfo,
    limits: wgpu::Limits,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// Nanoseconds a tick of the GPU's clock, if it has one.
    pub(crate) tick: Option<f64>,
    status: Arc<Status>,
    faults: Faults,
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
    pub fn open(choice: &Choice) -> Result<Gpu, GpuError> {
        Gpu::open_with(choice, Faults::default())
    }

    pub(crate) fn open_with(choice: &Choice, faults: Faults) -> Result<Gpu, GpuError> {
        let adapter = Adapters::choose(choice)?;
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
        let (device, queue) = pollster::block_on(asked).map_err(|e| failed(e.to_string()))?;
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
        })
    }

    /// The adapter.
    pub fn info(&self) -> &AdapterInfo {
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

    /// Runs commands, and says what the driver says about them. `bytes` is what they allocate, for the message.
    pub(crate) fn watched<T>(&self, bytes: u64, run: impl FnOnce() -> T) -> Result<T, GpuError> {
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
            first = first.or(pollster::block_on(scope.pop()));
        }
        match first {
            None => self.check().map(|()| made),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(self.out_of_memory(bytes)),
            Some(error) => {
                self.check()?;
                Err(GpuError::Refused {
                    adapter: self.info.title(),
                    reason: error.to_string(),
                })
            }
        }
    }

    fn out_of_memory(&self, bytes: u64) -> GpuError {
        GpuError::OutOfMemory {
            adapter: self.info.title(),
            bytes,
        }
    }

    /// A buffer of zeros.
    pub(crate) fn buffer(
        &self,
        label: &'static str,
        bytes: u64,
        usage: BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        if self.faults.fails_allocation(bytes) || bytes > self.limits.max_buffer_size {
            return Err(self.out_of_memory(bytes));
        }
        self.watched(bytes, || {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                // no buffer may be empty where a shader sees it
                size: bytes.max(16).next_multiple_of(16),
                usage,
                mapped_at_creation: false,
            })
        })
    }

    /// A texture that shaders read by places.
    pub(crate) fn texture(
        &self,
        label: &'static str,
        size: Extent3d,
        format: TextureFormat,
    ) -> Result<wgpu::Texture, GpuError> {
        let texels = [size.width, size.height, size.depth_or_array_layers].map(u64::from);
        let texel = format.block_copy_size(None).unwrap_or(0);
        let bytes = texels.into_iter().product::<u64>() * u64::from(texel);
        if self.faults.fails_allocation(bytes) {
            return Err(self.out_of_memory(bytes));
        }
        self.watched(bytes, || {
            self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format,
                usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
                view_formats: &[],
            })
        })
    }

    /// Gives the GPU something to do.
    pub(crate) fn submit(
        &self,
        encoder: wgpu::CommandEncoder,
    ) -> Result<SubmissionIndex, GpuError> {
        if self.faults.loses_device() {
            self.device.destroy();
            self.status.lose("a fault that was asked for");
        }
        self.watched(0, || self.queue.submit([encoder.finish()]))
    }

    /// Waits until a submission is done, and its buffers are mapped. A device that does not answer counts as lost.
    ///
    /// # Errors
    /// The device is lost, or `stop` says that nobody waits any more; the submission is then still on its way.
    pub(crate) fn wait(
        &self,
        submission: &SubmissionIndex,
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
            let wait = PollType::Wait {
                submission_index: Some(submission.clone()),
                timeout: Some(LOOK.min(patience)),
            };
            // wgpu panics where the driver reports the loss of the device while it is waited for
            match catch_unwind(AssertUnwindSafe(|| self.device.poll(wait))) {
                Ok(Ok(_)) => return self.check(),
                Ok(Err(PollError::Timeout)) if stop() => {
                    return Err(GpuError::Scene(RenderError::Cancelled));
                }
                Ok(Err(PollError::Timeout)) if began.elapsed() < patience => self.check()?,
                Ok(Err(PollError::Timeout)) => {
                    let seconds = patience.as_secs_f32();
                    self.status
                        .lose(&format!("it did not answer for {seconds} s"));
                }
                Ok(Err(error)) => self.status.lose(&error.to_string()),
                Err(_) => self
                    .status
                    .lose("the driver failed while it was waited for"),
            }
            self.check()?;
        }
    }
}

impl Gpu {
    /// Whether all work is done, or soon is.
    fn is_idle(&self) -> bool {
        let wait = PollType::Wait {
            submission_index: None,
            timeout: Some(GOODBYE),
        };
        matches!(
            catch_unwind(AssertUnwindSafe(|| self.device.poll(wait))),
            Ok(Ok(status)) if status.is_queue_empty()
        )
    }
}

/// Dropping a queue waits for its work, which never ends on a lost device and takes as long as a driver compiles where a shader
/// is run first; it panics where the work was not finished. Nobody who cancels a picture may have to wait for that: the
/// process lives on with the device instead, and with what little of it the driver has not freed.
impl Drop for Gpu {
    fn drop(&mut self) {
        if get(&self.status.lost).is_some() || !self.is_idle() {
            tracing::debug!("{} is left as it is", self.info.title());
            std::mem::forget(self.queue.clone());
        }
    }
}
