//! What the core leaves to whoever runs it: to wait, which a browser must not do, and to compile beside other work.

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipeline::{Layouts, Pipelines};
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use wgpu::{Device, SubmissionIndex};
use zeroset_scene::render::Observer;

/// What is there later.
pub(crate) type Later<'a, T> = Pin<Box<dyn Future<Output = T> + 'a>>;

/// Who runs the core. Native programs block: see [`blocking`](crate::blocking). A browser gives the turn back to its page.
pub(crate) trait Host: Send + Sync {
    /// Gives the device time to go on, this long at most, and comes back when a submission is done, or sooner. The core asks
    /// again, as long as it waits.
    ///
    /// # Errors
    /// Why the device can never be waited for again.
    fn pause<'a>(
        &'a self,
        device: &'a Device,
        submission: &'a SubmissionIndex,
        most: Duration,
    ) -> Later<'a, Result<(), String>>;

    /// Compiles a shader ([`compile`](crate::pipeline::compile)), as long as the observer does not ask to stop.
    fn compile<'a>(
        &'a self,
        gpu: &'a Arc<Gpu>,
        layouts: &'a Arc<Layouts>,
        source: &'a Arc<str>,
        observer: &'a dyn Observer,
    ) -> Later<'a, Result<Pipelines, GpuError>>;

    /// Whether a device that is about to be dropped has no work left, or soon has none.
    fn is_idle(&self, device: &Device) -> bool;
}

/// Given once by what a device does in its own time: a submission that is done, a buffer that is mapped.
#[derive(Clone, Debug, Default)]
pub(crate) struct Signal(Arc<AtomicBool>);

impl Signal {
    pub(crate) fn give(&self) {
        self.0.store(true, Ordering::Release);
    }

    pub(crate) fn is_given(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }
}
