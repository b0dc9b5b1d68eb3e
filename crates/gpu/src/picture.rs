//! Samples of a picture: band after band, stage after stage.

use crate::band::{COUNTER_BYTES, LEAST_BUDGET, Room, Sizes};
use crate::device::Gpu;
use crate::error::GpuError;
use crate::memory::{Counters, Memory, counters, unpack};
use crate::pace::{Area, Costs, Cutter, LIMIT};
use crate::pipeline::{Layouts, Pipelines, STAGES, Set};
use crate::render_queue::{Dispatch, DispatchObserver, DispatchSetup, RenderQueue};
use crate::timing::{Stage, Timings};
use std::ops::Range;
use std::sync::Arc;
use web_time::Instant;
use zeroset_scene::accumulator::{Accumulator, Sum};
use zeroset_scene::render::{Evaluations, Observer, RenderError, Statistics};
use zeroset_shader::Job;
use zeroset_shader::entry::{Binding, CONE_SIDES, CUT_SHORT, WAITING, WORKGROUP};
use zeroset_shader::layout::Frame;

/// Rows of the first band where cones were never measured: they are not cut into tiles.
const FIRST_ROWS: u32 = 128;

/// Bytes of the notes of all rays of a tile that is traced in turns, at most.
const NOTES: u64 = 64 << 20;
/// Words of notes that a ray should be able to have: more questions than loops can ask that end early.
const WORDS: u64 = 16_384;
/// Words of notes that it must be able to have.
const FEWEST_WORDS: u64 = 512;
/// Turns before the GPU is asked whether any ray still waits.
const TURNS: u32 = 16;

/// Tells an observer of rays, each once, also where a picture is begun anew.
pub(crate) struct Progress<'a> {
    observer: &'a dyn Observer,
    total: u64,
    told: u64,
    done: f64,
}

impl<'a> Progress<'a> {
    pub(crate) fn new(
        observer: &'a dyn Observer,
        [width, height]: [u32; 2],
        samples: u32,
    ) -> Progress<'a> {
        Progress {
            observer,
            total: u64::from(width) * u64::from(height) * u64::from(samples),
            told: 0,
            done: 0.0,
        }
    }

    pub(crate) fn observer(&self) -> &'a dyn Observer {
        self.observer
    }

    /// Begins anew.
    pub(crate) fn restart(&mut self) {
        self.done = 0.0;
    }

    fn advance(&mut self, rays: f64) {
        self.done += rays;
        let done = (self.done as u64).min(self.total);
        if done > self.told {
            self.observer.advance(done - self.told, self.total);
            self.told = done;
        }
    }

    /// All rays of this share of the rows are done.
    fn reach(&mut self, share: f64) {
        self.advance(share * self.total as f64 - self.done);
    }

    fn check(&self) -> Result<(), GpuError> {
        if self.observer.is_cancelled() {
            return Err(GpuError::Scene(RenderError::Cancelled));
        }
        Ok(())
    }
}

/// What a picture is rendered with, all of one device.
pub(crate) struct PictureResources<'a> {
    pub(crate) gpu: &'a Arc<Gpu>,
    pub(crate) layouts: &'a Layouts,
    pub(crate) memory: &'a mut Memory,
    pub(crate) render_queue: &'a mut RenderQueue,
    pub(crate) set: &'a mut Set,
    /// Bytes of all buffers of a band together.
    pub(crate) budget: u64,
}

/// How far a picture is: what is done stays done where it must be begun anew.
#[derive(Debug, Default)]
pub(crate) struct RowsDone {
    /// Rows whose sums the accumulator has.
    rows: u32,
    /// Sums of the counters of these rows.
    counted: [u64; 8],
}

impl RowsDone {
    pub(crate) fn statistics(&self) -> Statistics {
        let [
            prepass,
            march,
            normal,
            occlusion,
            shadow,
            material,
            rays,
            hits,
        ] = self.counted;
        Statistics {
            rays,
            hits,
            evaluations: Evaluations {
                prepass,
                march,
                normal,
                occlusion,
                shadow,
                material,
            },
            seconds: 0.0,
            threads: 1,
        }
    }
}

impl PictureResources<'_> {
    /// Adds samples to the sums of a picture of the job's size, from the row on that it has reached.
    pub(crate) async fn render(
        &mut self,
        job: &Job,
        samples: &Range<u32>,
        into: &mut Accumulator,
        rows_done: &mut RowsDone,
        progress: &mut Progress<'_>,
        timings: &mut Timings,
    ) -> Result<(), GpuError> {
        let sums: Vec<Sum> = into.kept().collect();
        timings.by_timestamps = self.gpu.tick.is_some();
        let height = job.frame.size[1];
        while rows_done.rows < height {
            let first = rows_done.rows;
            let room = Room {
                budget: self.budget.max(LEAST_BUDGET),
                binding: self.gpu.largest_binding(),
                rows: self.most_rows(job),
                notes: self.notes(job),
            };
            let rows = room.band(job, first, &sums, &self.gpu.info().title())?;
            let (numbers, counters) = self
                .band(job, [first, rows], samples, &sums, progress, timings)
                .await?;
            into.add_rows(first, rows, &numbers);
            let (pairs, _) = counters.as_chunks::<2>();
            for (sum, [low, high]) in rows_done.counted.iter_mut().zip(pairs) {
                *sum += u64::from(*low) | u64::from(*high) << 32;
            }
            rows_done.rows += rows;
            timings.bands += 1;
            progress.reach(f64::from(rows_done.rows) / f64::from(height));
        }
        Ok(())
    }

    /// Bytes for the notes of rays, where they are traced in turns.
    fn notes(&self, job: &Job) -> u64 {
        if !job.in_turns {
            return 0;
        }
        let budget = self.budget.max(LEAST_BUDGET);
        // of a workgroup at least
        let least =
            4 * u64::from(WORKGROUP * WORKGROUP) * (u64::from(job.registers) + FEWEST_WORDS);
        NOTES
            .min(budget / 4)
            .max(least)
            .min(self.gpu.largest_binding())
    }

    /// Rows whose cones take no longer than a dispatch may.
    fn most_rows(&self, job: &Job) -> u32 {
        if !job.prepass() {
            return u32::MAX;
        }
        let of = |stage: Stage| self.set.costs[stage as usize].dearest();
        match of(Stage::ConesWide).zip(of(Stage::ConesNarrow)) {
            None => FIRST_ROWS,
            Some((wide, narrow)) => {
                let row = wide.max(narrow) * f64::from(job.frame.size[0].max(1));
                (0.5 * LIMIT / row).clamp(32.0, 1e9) as u32
            }
        }
    }

    /// Renders `rows`: the first and how many. Gives the numbers of their sums.
    async fn band(
        &mut self,
        job: &Job,
        rows: [u32; 2],
        samples: &Range<u32>,
        sums: &[Sum],
        progress: &mut Progress<'_>,
        timings: &mut Timings,
    ) -> Result<(Vec<f32>, Counters), GpuError> {
        let frame = job.band(rows[0], rows[1], sums, samples.start);
        let notes = self.notes(job);
        let sizes = Sizes::new(&frame, sums, notes);
        progress.check()?;
        let (gpu, tiles) = (self.gpu, &self.render_queue.tiles);
        timings.uploaded += (self.memory)
            .fill(gpu, self.layouts, tiles, job, &frame, &sizes)
            .await?;
        // until all of it is done, it may be
        self.memory.is_mapped = true;
        let (Some(groups), Some(counters), Some(read)) = (
            self.memory.groups(),
            self.memory.buffer(Binding::Counters),
            self.memory.read(),
        ) else {
            return Err(self.without("buffers"));
        };
        let mut run = Run {
            render_queue: self.render_queue,
            pipelines: &self.set.pipelines,
            groups,
            gpu: self.gpu,
            counters,
            read,
            words: notes / 4,
            registers: u64::from(job.registers),
            notes: BandRecord {
                share: f64::from(rows[1]) / f64::from(frame.band[1].max(1)),
                size: frame.size,
                costs: &mut self.set.costs,
                progress,
                timings,
            },
        };
        let [from, stored, ..] = frame.band;
        let across = |first, count| Area {
            corner: [0, first],
            size: [frame.size[0], count],
        };
        let (stored, given) = (across(from, stored), across(rows[0], rows[1]));
        if !self.set.is_warm {
            run.warm_up(given).await?;
            self.set.is_warm = true;
        }
        run.render_queue.encoder().clear_buffer(counters, 0, None);
        if job.prepass() {
            let [wide, narrow] = CONE_SIDES;
            run.cones(Stage::ConesWide, &frame, stored, wide).await?;
            run.cones(Stage::ConesNarrow, &frame, stored, narrow)
                .await?;
        }
        for sample in samples.clone() {
            if job.in_turns {
                run.turns(stored, sample).await?;
            } else {
                run.tiles(Stage::Trace, stored, sample).await?;
                if !self.set.is_proven && sample + 1 < samples.end {
                    // the other rays of a scene that needs turns need not be traced
                    check(run.gpu, &run.counted().await?)?;
                }
            }
            run.tiles(Stage::Gather, given, sample).await?;
        }
        run.tiles(Stage::Develop, given, 0).await?;
        let (numbers, counters) = self.read(&frame, &sizes, progress, timings).await?;
        check(self.gpu, &counters)?;
        self.set.is_proven = true;
        Ok((numbers, counters))
    }

    /// Reads the finished sums of a band.
    async fn read(
        &mut self,
        frame: &Frame,
        sizes: &Sizes,
        progress: &mut Progress<'_>,
        timings: &mut Timings,
    ) -> Result<(Vec<f32>, Counters), GpuError> {
        let of = |binding| self.memory.buffer(binding);
        let (Some(made), Some(counters), Some(read)) = (
            of(Binding::Planes),
            of(Binding::Counters),
            self.memory.read(),
        ) else {
            return Err(self.without("buffers"));
        };
        let encoder = self.render_queue.encoder();
        if sizes.planes > 0 {
            encoder.copy_buffer_to_buffer(made, 0, read, 0, sizes.planes);
        }
        encoder.copy_buffer_to_buffer(counters, 0, read, sizes.planes, COUNTER_BYTES);
        let share = f64::from(frame.band[3]) / f64::from(frame.band[1].max(1));
        let mut notes = BandRecord {
            share,
            size: frame.size,
            costs: &mut self.set.costs,
            progress,
            timings,
        };
        self.render_queue
            .finish_and_map(read, .., &mut notes)
            .await?;
        let mapped = read.get_mapped_range(..sizes.read);
        let found = match &mapped {
            Ok(view) => unpack(view, sizes.planes),
            Err(error) => return Err(self.without(&error.to_string())),
        };
        drop(mapped);
        read.unmap();
        self.memory.is_mapped = false;
        Ok(found)
    }

    fn without(&self, reason: &str) -> GpuError {
        without(self.gpu, reason)
    }
}

fn without(gpu: &Gpu, reason: &str) -> GpuError {
    GpuError::Refused {
        adapter: gpu.info().title(),
        reason: format!("the picture cannot be read: {reason}"),
    }
}

/// What counters say about loops.
fn check(gpu: &Gpu, counters: &Counters) -> Result<(), GpuError> {
    if counters[CUT_SHORT] != 0 {
        return Err(GpuError::Loops {
            adapter: gpu.info().title(),
        });
    }
    Ok(())
}

/// Takes in what dispatches of a band took.
struct BandRecord<'a, 'o> {
    /// Share of the rays that is not traced by another band too.
    share: f64,
    /// The picture's size.
    size: [u32; 2],
    costs: &'a mut [Costs; STAGES],
    progress: &'a mut Progress<'o>,
    timings: &'a mut Timings,
}

impl DispatchObserver for BandRecord<'_, '_> {
    fn take(&mut self, dispatch: Dispatch) {
        let stage = dispatch.stage as usize;
        let Dispatch {
            area,
            seconds,
            predicted,
            turn,
            ..
        } = dispatch;
        self.timings.dispatches += 1;
        self.timings.stages.0[stage] += seconds;
        self.timings.longest = self.timings.longest.max(seconds);
        if turn > 0 {
            // of the same rays, of which fewer and fewer are left
            return;
        }
        self.costs[stage].learn(&area, self.size, seconds, predicted);
        if dispatch.stage == Stage::Trace {
            self.progress.advance(area.pixels() as f64 * self.share);
        }
    }

    fn stops(&self) -> bool {
        self.progress.stops()
    }
}

/// Only whether to go on waiting: what dispatches took says nothing where a driver compiles, or where nobody needs them.
impl DispatchObserver for Progress<'_> {
    fn take(&mut self, _: Dispatch) {}

    fn stops(&self) -> bool {
        self.observer.is_cancelled()
    }
}

/// The stages of one band.
struct Run<'a, 'o> {
    render_queue: &'a mut RenderQueue,
    pipelines: &'a Pipelines,
    groups: &'a [wgpu::BindGroup; STAGES],
    gpu: &'a Gpu,
    counters: &'a wgpu::Buffer,
    read: &'a wgpu::Buffer,
    /// Words for all rays of a tile, notes and registers.
    words: u64,
    /// Words of each for registers.
    registers: u64,
    notes: BandRecord<'a, 'o>,
}

impl Run<'_, '_> {
    /// Runs every pipeline once on as little as can be, for drivers that compile when a pipeline is run. What they write is
    /// written again later.
    async fn warm_up(&mut self, given: Area) -> Result<(), GpuError> {
        let began = Instant::now();
        let area = Area {
            corner: given.corner,
            size: given.size.map(|n| n.min(WORKGROUP)),
        };
        let stages = [
            Stage::ConesWide,
            Stage::ConesNarrow,
            Stage::Trace,
            Stage::Gather,
            Stage::Develop,
        ];
        self.render_queue.compiles = true;
        let mut run = Ok(());
        for stage in stages {
            let dispatch = self.dispatch(stage, area, Some(0.0));
            run = self.record(dispatch, [1, 1], 0).await;
            if run.is_ok() {
                run = self.render_queue.finish(self.notes.progress).await;
            }
            if run.is_err() {
                break;
            }
        }
        self.render_queue.compiles = false;
        self.notes.timings.compile += began.elapsed().as_secs_f64();
        run
    }

    /// Marches all cones of a size.
    async fn cones(
        &mut self,
        stage: Stage,
        frame: &Frame,
        area: Area,
        side: u32,
    ) -> Result<(), GpuError> {
        let known = &self.notes.costs[stage as usize];
        let predicted = known.dearest().map(|rate| rate * area.pixels() as f64);
        let groups = frame.cells(side).map(|n| n.div_ceil(WORKGROUP));
        if predicted.is_none() {
            self.finish().await?;
        }
        let dispatch = self.dispatch(stage, area, predicted);
        self.add(dispatch, groups, 0).await?;
        if predicted.is_none() {
            self.finish().await?;
        }
        Ok(())
    }

    /// Dispatches an area in tiles.
    async fn tiles(&mut self, stage: Stage, area: Area, index: u32) -> Result<(), GpuError> {
        let mut cutter = Cutter::new(area, self.notes.size[1]);
        while let Some(tile) = cutter.next(&self.notes.costs[stage as usize]) {
            if tile.is_guess {
                self.finish().await?;
            }
            let dispatch = self.dispatch(stage, tile.area, tile.predicted);
            self.add(dispatch, tile.area.groups(), index).await?;
            if tile.is_guess {
                self.finish().await?;
            }
        }
        Ok(())
    }

    /// Traces an area in turns: each dispatch answers one question of every ray, until none has any left.
    async fn turns(&mut self, area: Area, index: u32) -> Result<(), GpuError> {
        let most = self.words / (WORDS + self.registers);
        let mut cutter = Cutter::new(area, self.notes.size[1]).at_most(most);
        while let Some(tile) = cutter.next(&self.notes.costs[Stage::Trace as usize]) {
            let mut dispatch = self.dispatch(Stage::Trace, tile.area, tile.predicted);
            let words = self.words / tile.area.pixels().max(1);
            dispatch.notes = u32::try_from(words).unwrap_or(u32::MAX);
            let mut waiting = true;
            while waiting {
                for turn in 1..=TURNS {
                    if turn == TURNS {
                        let waits = 4 * WAITING as u64;
                        (self.render_queue.encoder()).clear_buffer(self.counters, waits, Some(4));
                    }
                    self.add(dispatch, tile.area.groups(), index).await?;
                    dispatch.turn += 1;
                }
                let counters = self.counted().await?;
                check(self.gpu, &counters)?;
                waiting = counters[WAITING] != 0;
            }
        }
        Ok(())
    }

    /// The counters after all that is recorded.
    async fn counted(&mut self) -> Result<Counters, GpuError> {
        let encoder = self.render_queue.encoder();
        encoder.copy_buffer_to_buffer(self.counters, 0, self.read, 0, COUNTER_BYTES);
        (self.render_queue)
            .finish_and_map(self.read, ..COUNTER_BYTES, &mut self.notes)
            .await?;
        let counted = match self.read.get_mapped_range(..COUNTER_BYTES) {
            Ok(view) => counters(&view),
            Err(error) => return Err(without(self.gpu, &error.to_string())),
        };
        self.read.unmap();
        Ok(counted)
    }

    fn dispatch(&self, stage: Stage, area: Area, predicted: Option<f64>) -> Dispatch {
        // what a warm-up notes of a workgroup is never read
        let notes = self.words / u64::from(WORKGROUP * WORKGROUP);
        Dispatch {
            stage,
            area,
            predicted,
            seconds: 0.0,
            turn: 0,
            notes: u32::try_from(notes).unwrap_or(u32::MAX),
        }
    }

    async fn add(
        &mut self,
        dispatch: Dispatch,
        groups: [u32; 2],
        index: u32,
    ) -> Result<(), GpuError> {
        if self.render_queue.is_full(dispatch.predicted) {
            self.notes.progress.check()?;
            self.render_queue.flush(&mut self.notes).await?;
        }
        self.record(dispatch, groups, index).await
    }

    async fn record(
        &mut self,
        dispatch: Dispatch,
        groups: [u32; 2],
        index: u32,
    ) -> Result<(), GpuError> {
        let with = DispatchSetup {
            pipelines: self.pipelines,
            groups: self.groups,
        };
        (self.render_queue)
            .dispatch(&with, dispatch, groups, index)
            .await
    }

    async fn finish(&mut self) -> Result<(), GpuError> {
        self.notes.progress.check()?;
        self.render_queue.finish(&mut self.notes).await
    }
}
