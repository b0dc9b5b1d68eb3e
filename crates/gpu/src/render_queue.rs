//! Submissions on their way: dispatches are collected, submitted, timed and waited for.

use crate::device::{Gpu, Submission, Work};
use crate::error::GpuError;
use crate::host::Signal;
use crate::pace::{Area, TARGET};
use crate::pipeline::{Pipelines, STAGES};
use crate::timing::Stage;
use std::collections::VecDeque;
use std::ops::RangeBounds;
use std::sync::Arc;
use web_time::Instant;
use wgpu::{BindGroup, Buffer, BufferUsages, CommandEncoder, MapMode, QuerySet};
use zeroset_shader::entry::{Binding, ENTRIES};
use zeroset_shader::layout::Tile;

/// Submissions that are not waited for yet, at most.
const AHEAD: usize = 2;
/// Dispatches of a submission, at most.
const TOGETHER: usize = 32;
/// Tiles lie this far apart, bytes: what every device allows for dynamic offsets.
const STRIDE: u64 = 256;

/// A dispatch that was submitted, and how long it took.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dispatch {
    pub(crate) stage: Stage,
    /// Pixels that it stands for.
    pub(crate) area: Area,
    /// What it should take, seconds.
    pub(crate) predicted: Option<f64>,
    /// What it took, seconds.
    pub(crate) seconds: f64,
    /// Which turn of its rays it is, where they are traced in turns: later ones may have nothing to do.
    pub(crate) turn: u32,
    /// Words of notes for each of these rays.
    pub(crate) notes: u32,
}

/// Who is told of finished dispatches, and asked whether to go on waiting.
pub(crate) trait DispatchObserver {
    /// Takes in what a dispatch took.
    fn take(&mut self, dispatch: Dispatch);
    /// Whether to stop waiting.
    fn stops(&self) -> bool;
}

/// What shaders are dispatched with.
pub(crate) struct DispatchSetup<'a> {
    pub(crate) pipelines: &'a Pipelines,
    pub(crate) groups: &'a [BindGroup; STAGES],
}

/// Where the GPU's clock is read into.
struct Stamps {
    set: QuerySet,
    resolved: Buffer,
    read: Buffer,
}

struct Flown {
    submission: Submission,
    /// Buffers that must be mapped too.
    mapped: Vec<Signal>,
    began: Instant,
    dispatches: Vec<Dispatch>,
    stamps: Option<Stamps>,
    work: Work,
}

/// The queue of a device, as far as rendering is concerned.
pub(crate) struct RenderQueue {
    gpu: Arc<Gpu>,
    /// [`Tile`] of every dispatch of the submission that is being made.
    pub(crate) tiles: Buffer,
    encoder: Option<CommandEncoder>,
    open: Vec<Dispatch>,
    /// Tiles of `open`, as the buffer holds them.
    written: Vec<u8>,
    flying: VecDeque<Flown>,
    spare: Vec<Stamps>,
    /// When the latest submission that was waited for was done.
    last_done: Option<Instant>,
    pub(crate) submissions: u32,
    /// Whether what is submitted may make the driver compile.
    pub(crate) compiles: bool,
}

impl RenderQueue {
    pub(crate) async fn new(gpu: &Arc<Gpu>) -> Result<RenderQueue, GpuError> {
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        Ok(RenderQueue {
            tiles: gpu.buffer("tiles", STRIDE * TOGETHER as u64, usage).await?,
            gpu: Arc::clone(gpu),
            encoder: None,
            open: Vec::new(),
            written: Vec::new(),
            flying: VecDeque::new(),
            spare: Vec::new(),
            last_done: None,
            submissions: 0,
            compiles: false,
        })
    }

    /// Where commands beside dispatches are recorded.
    pub(crate) fn encoder(&mut self) -> &mut CommandEncoder {
        (self.encoder).get_or_insert_with(|| new_encoder(&self.gpu))
    }

    /// Whether a dispatch that takes so long should wait for the next submission.
    pub(crate) fn is_full(&self, predicted: Option<f64>) -> bool {
        let sum: Option<f64> = self.open.iter().map(|d| d.predicted).sum();
        let all = sum.zip(predicted).map(|(a, b)| a + b);
        !self.open.is_empty() && (self.open.len() == TOGETHER || all.is_none_or(|s| s > TARGET))
    }

    /// Records a dispatch. `groups` are workgroups across and down.
    pub(crate) async fn dispatch(
        &mut self,
        with: &DispatchSetup<'_>,
        dispatch: Dispatch,
        groups: [u32; 2],
        index: u32,
    ) -> Result<(), GpuError> {
        if self.open.is_empty() {
            self.prepare_stamps().await?;
        }
        let number = self.open.len();
        let tile = Tile {
            corner: dispatch.area.corner,
            size: dispatch.area.size,
            index,
            turn: dispatch.turn,
            notes: dispatch.notes,
            ..Tile::default()
        };
        self.written.resize(number * STRIDE as usize, 0);
        self.written.extend_from_slice(bytemuck::bytes_of(&tile));
        let stage = dispatch.stage as usize;
        let stamps = self.spare.last();
        let writes = stamps.map(|stamps| wgpu::ComputePassTimestampWrites {
            query_set: &stamps.set,
            beginning_of_pass_write_index: Some(2 * number as u32),
            end_of_pass_write_index: Some(2 * number as u32 + 1),
        });
        let encoder = (self.encoder).get_or_insert_with(|| new_encoder(&self.gpu));
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(ENTRIES[stage].name),
            timestamp_writes: writes,
        });
        let offset = [(number as u64 * STRIDE) as u32];
        let has_tile = ENTRIES[stage].bindings.contains(&Binding::Tile);
        pass.set_pipeline(&with.pipelines[stage]);
        pass.set_bind_group(
            0,
            &with.groups[stage],
            if has_tile { &offset[..] } else { &[] },
        );
        pass.dispatch_workgroups(groups[0], groups[1], 1);
        drop(pass);
        self.open.push(dispatch);
        Ok(())
    }

    /// Makes sure that there are stamps for the next submission, if the GPU has a clock.
    async fn prepare_stamps(&mut self) -> Result<(), GpuError> {
        if self.gpu.tick.is_none() || !self.spare.is_empty() {
            return Ok(());
        }
        let count = 2 * TOGETHER as u32;
        let bytes = 8 * u64::from(count);
        let make = || {
            self.gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count,
            })
        };
        let set = self.gpu.watched(bytes, make).await?;
        let resolved = BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC;
        let read = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
        self.spare.push(Stamps {
            set,
            resolved: (self.gpu.buffer("resolved timestamps", bytes, resolved)).await?,
            read: self.gpu.buffer("read timestamps", bytes, read).await?,
        });
        Ok(())
    }

    /// Submits what is recorded, if anything, and tells `observer` of submissions that had to be waited for.
    pub(crate) async fn flush(
        &mut self,
        observer: &mut dyn DispatchObserver,
    ) -> Result<(), GpuError> {
        let Some(mut encoder) = self.encoder.take() else {
            return Ok(());
        };
        let dispatches = std::mem::take(&mut self.open);
        let mut stamps = None;
        if !dispatches.is_empty() {
            self.gpu.queue.write_buffer(&self.tiles, 0, &self.written);
            self.written.clear();
            stamps = self.spare.pop();
        }
        if let Some(stamps) = &stamps {
            let count = 2 * dispatches.len() as u32;
            encoder.resolve_query_set(&stamps.set, 0..count, &stamps.resolved, 0);
            let bytes = 8 * u64::from(count);
            encoder.copy_buffer_to_buffer(&stamps.resolved, 0, &stamps.read, 0, bytes);
        }
        let began = Instant::now();
        let submission = self.gpu.submit(encoder).await?;
        self.submissions += 1;
        let mapped = (stamps.iter())
            .map(|stamps| map(&stamps.read, ..))
            .collect();
        self.flying.push_back(Flown {
            submission,
            mapped,
            began,
            dispatches,
            stamps,
            work: if self.compiles {
                Work::Compiling
            } else {
                Work::Dispatches
            },
        });
        while self.flying.len() > AHEAD {
            self.land(observer).await?;
        }
        Ok(())
    }

    /// Submits what is recorded and waits for everything.
    pub(crate) async fn finish(
        &mut self,
        observer: &mut dyn DispatchObserver,
    ) -> Result<(), GpuError> {
        self.flush(observer).await?;
        while !self.flying.is_empty() {
            self.land(observer).await?;
        }
        Ok(())
    }

    /// Submits what is recorded, waits for everything, and has a range of a buffer mapped then.
    pub(crate) async fn finish_and_map(
        &mut self,
        buffer: &Buffer,
        range: impl RangeBounds<u64>,
        observer: &mut dyn DispatchObserver,
    ) -> Result<(), GpuError> {
        self.flush(observer).await?;
        let mapped = map(buffer, range);
        if let Some(last) = self.flying.back_mut() {
            last.mapped.push(mapped);
        }
        self.finish(observer).await
    }

    /// Forgets what is recorded, and waits for what is on its way: not as long as a driver may compile, since nobody needs it
    /// any more.
    pub(crate) async fn drain(
        &mut self,
        observer: &mut dyn DispatchObserver,
    ) -> Result<(), GpuError> {
        self.flying.iter_mut().for_each(|f| f.work = Work::Left);
        self.encoder = None;
        self.open.clear();
        self.written.clear();
        self.finish(observer).await
    }

    /// Waits for the oldest submission.
    async fn land(&mut self, observer: &mut dyn DispatchObserver) -> Result<(), GpuError> {
        let Some(flown) = self.flying.front() else {
            return Ok(());
        };
        // what is not waited for to the end stays on its way
        let stop = || observer.stops();
        (self.gpu)
            .wait(&flown.submission, &flown.mapped, flown.work, &stop)
            .await?;
        let Some(flown) = self.flying.pop_front() else {
            return Ok(());
        };
        let now = Instant::now();
        // work begins when it is submitted or when the work before it is done
        let began = self.last_done.map_or(flown.began, |t| t.max(flown.began));
        let wall = now.duration_since(began).as_secs_f64();
        self.last_done = Some(now);
        let ticks = match &flown.stamps {
            Some(stamps) => read_ticks(stamps, flown.dispatches.len())?,
            None => Vec::new(),
        };
        let weight = |d: &Dispatch| d.predicted.unwrap_or(1e-9 * d.area.pixels() as f64);
        let weights: f64 = flown.dispatches.iter().map(weight).sum();
        for (k, mut dispatch) in flown.dispatches.iter().copied().enumerate() {
            let share = wall * weight(&dispatch) / weights.max(1e-12);
            let measured = ticks.get(k).zip(self.gpu.tick);
            dispatch.seconds = match measured {
                Some(([began, ended], tick)) if ended >= began => {
                    (ended - began) as f64 * tick * 1e-9
                }
                _ => share,
            };
            observer.take(dispatch);
        }
        self.spare.extend(flown.stamps);
        Ok(())
    }
}

/// Asks for a range of a buffer to be mapped. Whether it could be is seen when the range is asked for.
fn map(buffer: &Buffer, range: impl RangeBounds<u64>) -> Signal {
    let mapped = Signal::default();
    let told = mapped.clone();
    buffer.map_async(MapMode::Read, range, move |_| told.give());
    mapped
}

fn new_encoder(gpu: &Gpu) -> CommandEncoder {
    let descriptor = wgpu::CommandEncoderDescriptor::default();
    gpu.device.create_command_encoder(&descriptor)
}

/// When the dispatches of a submission began and ended, in ticks. Empty where the clock cannot be read.
fn read_ticks(stamps: &Stamps, count: usize) -> Result<Vec<[u64; 2]>, GpuError> {
    let bytes = 16 * count as u64;
    let ticks = match stamps.read.get_mapped_range(..bytes) {
        Ok(view) => bytemuck::pod_collect_to_vec(&view[..]),
        Err(error) => {
            tracing::debug!("the GPU's clock cannot be read: {error}");
            return Ok(Vec::new());
        }
    };
    stamps.read.unmap();
    Ok(ticks)
}
