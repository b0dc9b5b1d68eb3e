//! Buffers, kept from picture to picture.

use crate::band::Sizes;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipeline::{Layouts, STAGES};
use std::num::NonZeroU64;
use std::sync::Arc;
use wgpu::{BindGroup, BindGroupEntry, BindingResource, Buffer, BufferBinding, BufferUsages};
use zeroset_shader::Job;
use zeroset_shader::entry::{Binding, COUNTERS, ENTRIES, UNIFORM_NUMBERS, UNIFORM_ROWS};
use zeroset_shader::layout::{Frame, Tile};

/// All buffers of a device that pictures are rendered with.
#[derive(Default)]
pub(crate) struct Memory {
    /// By binding. Tiles belong to the flight.
    buffers: [Option<Buffer>; Binding::ALL.len()],
    read: Option<Buffer>,
    /// Whether `read` is mapped, or will be: a picture that was cancelled leaves it so.
    pub(crate) is_mapped: bool,
    groups: Option<[BindGroup; STAGES]>,
    /// What the buffers hold: images make the table large.
    code: Option<Arc<[u32]>>,
    table: Arc<[[f32; 4]]>,
}

impl Memory {
    /// Makes room for a band, and writes what the scene says.
    pub(crate) fn fill(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        tiles: &Buffer,
        job: &Job,
        frame: &Frame,
        sizes: &Sizes,
    ) -> Result<(), GpuError> {
        let input = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        for binding in Binding::ALL {
            let (bytes, usage) = match binding {
                Binding::Tile => continue,
                Binding::Frame => (size_of::<Frame>() as u64, input),
                Binding::Params => (self.allowed(gpu, "the parameters", &job.params)?, input),
                Binding::Numbers => (4 * UNIFORM_NUMBERS as u64, uniform),
                Binding::Rows => (16 * UNIFORM_ROWS as u64, uniform),
                Binding::Code => (self.allowed(gpu, "the field", &job.code)?, input),
                Binding::Table => (self.allowed(gpu, "the images", &job.table)?, input),
                other => sizes.of(other).unwrap_or((0, input)),
            };
            let slot = &mut self.buffers[binding as usize];
            if slot.as_ref().is_none_or(|b| b.size() < bytes) {
                // the old buffer goes first: both may not fit
                (*slot, self.groups) = (None, None);
                match binding {
                    Binding::Code => self.code = None,
                    Binding::Table => self.table = Arc::default(),
                    _ => {}
                }
                *slot = Some(gpu.buffer("picture", bytes, usage)?);
            }
        }
        if self.is_mapped || self.read.as_ref().is_none_or(|b| b.size() < sizes.read) {
            (self.read, self.is_mapped) = (None, false);
            let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
            self.read = Some(gpu.buffer("readback", sizes.read, usage)?);
        }
        if self.groups.is_none() {
            self.groups = Some(gpu.watched(0, || self.bind(gpu, layouts, tiles))?);
        }
        gpu.watched(sizes.read, || self.write(gpu, job, frame))
    }

    fn allowed<T>(&self, gpu: &Gpu, what: &'static str, all: &[T]) -> Result<u64, GpuError> {
        let (bytes, limit) = (size_of_val(all) as u64, gpu.largest_binding());
        if bytes > limit {
            return Err(GpuError::TooLarge {
                what,
                bytes,
                adapter: gpu.info().title(),
                limit,
            });
        }
        Ok(bytes)
    }

    fn bind(&self, gpu: &Gpu, layouts: &Layouts, tiles: &Buffer) -> [BindGroup; STAGES] {
        let resource = |binding: Binding| match (binding, &self.buffers[binding as usize]) {
            (_, Some(buffer)) => buffer.as_entire_binding(),
            (_, None) => BindingResource::Buffer(BufferBinding {
                buffer: tiles,
                offset: 0,
                size: NonZeroU64::new(size_of::<Tile>() as u64),
            }),
        };
        std::array::from_fn(|k| {
            let entries: Vec<_> = (ENTRIES[k].bindings.iter())
                .map(|&binding| BindGroupEntry {
                    binding: binding as u32,
                    resource: resource(binding),
                })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(ENTRIES[k].name),
                layout: &layouts.groups[k],
                entries: &entries,
            })
        })
    }

    fn write(&mut self, gpu: &Gpu, job: &Job, frame: &Frame) {
        let put = |binding: Binding, bytes: &[u8]| {
            if let Some(buffer) = &self.buffers[binding as usize]
                && !bytes.is_empty()
            {
                gpu.queue.write_buffer(buffer, 0, bytes);
            }
        };
        put(Binding::Frame, bytemuck::bytes_of(frame));
        put(Binding::Params, bytemuck::cast_slice(&job.params));
        if job.params.len() <= UNIFORM_NUMBERS {
            put(Binding::Numbers, bytemuck::cast_slice(&job.params));
        }
        let has_code = (self.code.as_ref()).is_some_and(|code| Arc::ptr_eq(code, &job.code));
        if !has_code {
            put(Binding::Code, bytemuck::cast_slice(&job.code));
        }
        if !Arc::ptr_eq(&self.table, &job.table) && self.table != job.table {
            put(Binding::Table, bytemuck::cast_slice(&job.table));
            if job.table.len() <= UNIFORM_ROWS {
                put(Binding::Rows, bytemuck::cast_slice(&job.table));
            }
            self.table = Arc::clone(&job.table);
        }
        self.code = Some(Arc::clone(&job.code));
    }

    pub(crate) fn groups(&self) -> Option<&[BindGroup; STAGES]> {
        self.groups.as_ref()
    }

    pub(crate) fn buffer(&self, binding: Binding) -> Option<&Buffer> {
        self.buffers[binding as usize].as_ref()
    }

    pub(crate) fn read(&self) -> Option<&Buffer> {
        self.read.as_ref()
    }
}

/// The counters, as shaders write them.
pub(crate) type Counters = [u32; COUNTERS as usize];

/// What bytes of finished rows hold: the numbers of the sums, and the counters.
pub(crate) fn unpack(bytes: &[u8], sums: u64) -> (Vec<f32>, Counters) {
    let (numbers, rest) = bytes.split_at(sums as usize);
    (bytemuck::pod_collect_to_vec(numbers), counters(rest))
}

/// The counters that bytes begin with.
pub(crate) fn counters(bytes: &[u8]) -> Counters {
    let mut counters = [0; COUNTERS as usize];
    let target: &mut [u8] = bytemuck::cast_slice_mut(&mut counters);
    target.copy_from_slice(&bytes[..size_of::<Counters>()]);
    counters
}
