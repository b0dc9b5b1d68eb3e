//! Buffers and textures, kept from picture to picture, with what the scene wrote into them.

use crate::band::Sizes;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::pipeline::{Layouts, STAGES};
use crate::texture::Layers;
use std::num::NonZeroU64;
use std::sync::Arc;
use wgpu::{BindGroup, BindGroupEntry, BindingResource, Buffer, BufferBinding, BufferUsages};
use zeroset_number::Grid;
use zeroset_scene::material::Image;
use zeroset_shader::Job;
use zeroset_shader::entry::{Binding, COUNTERS, ENTRIES, UNIFORM_NUMBERS, UNIFORM_ROWS};
use zeroset_shader::layout::{Frame, Tile};

/// All buffers of a device that pictures are rendered with.
#[derive(Default)]
pub(crate) struct Memory {
    /// By binding. Tiles belong to the render queue.
    buffers: [Option<Buffer>; Binding::ALL.len()],
    read: Option<Buffer>,
    /// Whether `read` is mapped, or will be: a picture that was cancelled leaves it so.
    pub(crate) is_mapped: bool,
    groups: Option<[BindGroup; STAGES]>,
    held: Held,
    images: Layers<Image>,
    grids: Layers<Grid>,
}

/// What of a scene the buffers hold, so that it is written once.
#[derive(Default)]
struct Held {
    params: Option<Arc<[f32]>>,
    code: Option<Arc<[u32]>>,
    table: Option<Arc<[[f32; 4]]>>,
}

impl Held {
    /// What a buffer held is gone.
    fn forget(&mut self, binding: Binding) {
        match binding {
            Binding::Params | Binding::Numbers => self.params = None,
            Binding::Code => self.code = None,
            Binding::Table | Binding::Rows => self.table = None,
            _ => {}
        }
    }
}

/// Notes that a buffer holds these numbers, and says whether they have to be written for that.
fn is_new<T: PartialEq>(held: &mut Option<Arc<[T]>>, numbers: &Arc<[T]>) -> bool {
    let is_there = |held: &Arc<[T]>| Arc::ptr_eq(held, numbers) || held == numbers;
    let is_new = !held.as_ref().is_some_and(is_there);
    *held = Some(Arc::clone(numbers));
    is_new
}

impl Memory {
    /// Makes room for a band, and writes what the scene says, as far as it is not there. Gives the bytes of that.
    pub(crate) async fn fill(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        tiles: &Buffer,
        job: &Job,
        frame: &Frame,
        sizes: &Sizes,
    ) -> Result<u64, GpuError> {
        let input = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let uniform = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        for binding in Binding::ALL {
            let (bytes, usage) = match binding {
                Binding::Tile | Binding::Images | Binding::Grids => continue,
                Binding::Frame => (size_of::<Frame>() as u64, input),
                Binding::Params => (self.allowed(gpu, "the parameters", &job.params)?, input),
                Binding::Numbers => (4 * UNIFORM_NUMBERS as u64, uniform),
                Binding::Rows => (16 * UNIFORM_ROWS as u64, uniform),
                Binding::Code => (self.allowed(gpu, "the field", &job.code)?, input),
                Binding::Table => (self.allowed(gpu, "the table", &job.table)?, input),
                other => sizes.of(other).unwrap_or((0, input)),
            };
            let slot = &mut self.buffers[binding as usize];
            if slot.as_ref().is_none_or(|b| b.size() < bytes) {
                // the old buffer goes first: both may not fit
                (*slot, self.groups) = (None, None);
                self.held.forget(binding);
                *slot = Some(gpu.buffer("a picture", bytes, usage).await?);
            }
        }
        if !self.images.has_room(&job.images) {
            self.groups = None;
            self.images.make_room(gpu, &job.images).await?;
        }
        if !self.grids.has_room(&job.grids) {
            self.groups = None;
            self.grids.make_room(gpu, &job.grids).await?;
        }
        if self.is_mapped || self.read.as_ref().is_none_or(|b| b.size() < sizes.read) {
            (self.read, self.is_mapped) = (None, false);
            let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
            self.read = Some(gpu.buffer("reading a picture", sizes.read, usage).await?);
        }
        if self.groups.is_none() {
            let bind = || self.bind(gpu, layouts, tiles);
            self.groups = Some(gpu.watched(0, bind).await?);
        }
        gpu.watched(sizes.read, || self.write(gpu, job, frame))
            .await
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
        let resource = |binding: Binding| match binding {
            Binding::Tile => Some(BindingResource::Buffer(BufferBinding {
                buffer: tiles,
                offset: 0,
                size: NonZeroU64::new(size_of::<Tile>() as u64),
            })),
            Binding::Images => self.images.view().map(BindingResource::TextureView),
            Binding::Grids => self.grids.view().map(BindingResource::TextureView),
            buffer => self.buffer(buffer).map(Buffer::as_entire_binding),
        };
        std::array::from_fn(|k| {
            let entries: Vec<_> = (ENTRIES[k].bindings.iter())
                .filter_map(|&binding| {
                    Some(BindGroupEntry {
                        binding: binding as u32,
                        resource: resource(binding)?,
                    })
                })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(ENTRIES[k].name),
                layout: &layouts.groups[k],
                entries: &entries,
            })
        })
    }

    fn write(&mut self, gpu: &Gpu, job: &Job, frame: &Frame) -> u64 {
        let buffers = &self.buffers;
        let put = |binding: Binding, bytes: &[u8]| match &buffers[binding as usize] {
            Some(buffer) if !bytes.is_empty() => {
                gpu.queue.write_buffer(buffer, 0, bytes);
                bytes.len() as u64
            }
            _ => 0,
        };
        put(Binding::Frame, bytemuck::bytes_of(frame));
        let mut bytes = self.images.write(gpu, &job.images) + self.grids.write(gpu, &job.grids);
        if is_new(&mut self.held.params, &job.params) {
            let params = bytemuck::cast_slice(&job.params);
            bytes += put(Binding::Params, params);
            if job.params.len() <= UNIFORM_NUMBERS {
                bytes += put(Binding::Numbers, params);
            }
        }
        if is_new(&mut self.held.code, &job.code) {
            bytes += put(Binding::Code, bytemuck::cast_slice(&job.code));
        }
        if is_new(&mut self.held.table, &job.table) {
            let table = bytemuck::cast_slice(&job.table);
            bytes += put(Binding::Table, table);
            if job.table.len() <= UNIFORM_ROWS {
                bytes += put(Binding::Rows, table);
            }
        }
        bytes
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
