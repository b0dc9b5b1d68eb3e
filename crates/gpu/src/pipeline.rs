//! Pipelines: one set for each shader text, kept for scenes of equal structure.

use crate::device::Gpu;
use crate::error::GpuError;
use crate::pace::Costs;
use std::num::NonZeroU64;
use std::sync::Arc;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, ComputePipeline,
    PipelineCompilationOptions, PipelineLayout, ShaderStages, TextureSampleType,
    TextureViewDimension,
};
use zeroset_scene::render::Observer;
use zeroset_shader::entry::{Binding, ENTRIES, UNIFORM_NUMBERS, UNIFORM_ROWS};
use zeroset_shader::layout::{Frame, Tile};

/// Entry points.
pub(crate) const STAGES: usize = ENTRIES.len();
/// Sets that are kept.
const KEPT: usize = 24;

/// What entry points see, equal for all scenes.
pub(crate) struct Layouts {
    pub(crate) groups: Vec<BindGroupLayout>,
    pipelines: Vec<PipelineLayout>,
}

impl Layouts {
    pub(crate) async fn new(gpu: &Gpu) -> Result<Layouts, GpuError> {
        gpu.watched(0, || {
            let group = |entry: &zeroset_shader::entry::Entry| {
                let entries: Vec<_> = entry.bindings.iter().map(|b| layout(*b)).collect();
                gpu.device
                    .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                        label: Some(entry.name),
                        entries: &entries,
                    })
            };
            let groups: Vec<_> = ENTRIES.iter().map(group).collect();
            let pipeline = |group: &BindGroupLayout| {
                gpu.device
                    .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                        label: None,
                        bind_group_layouts: &[Some(group)],
                        immediate_size: 0,
                    })
            };
            let pipelines = groups.iter().map(pipeline).collect();
            Layouts { groups, pipelines }
        })
        .await
    }
}

/// How a shader sees a buffer or a texture.
fn layout(binding: Binding) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: ShaderStages::COMPUTE,
        ty: if binding.is_texture() {
            BindingType::Texture {
                sample_type: TextureSampleType::Float { filterable: false },
                view_dimension: TextureViewDimension::D2Array,
                multisampled: false,
            }
        } else {
            buffer_layout(binding)
        },
        count: None,
    }
}

fn buffer_layout(binding: Binding) -> BindingType {
    let storage = |read_only| BufferBindingType::Storage { read_only };
    let (ty, size) = match binding {
        Binding::Frame => (storage(true), size_of::<Frame>()),
        Binding::Tile => (storage(true), size_of::<Tile>()),
        Binding::Params | Binding::Code | Binding::Table => (storage(true), 0),
        Binding::Numbers => (BufferBindingType::Uniform, 4 * UNIFORM_NUMBERS),
        Binding::Rows => (BufferBindingType::Uniform, 16 * UNIFORM_ROWS),
        _ => (storage(false), 0),
    };
    BindingType::Buffer {
        ty,
        has_dynamic_offset: binding == Binding::Tile,
        min_binding_size: NonZeroU64::new(size as u64),
    }
}

/// The entry points of a shader, in the order of [`ENTRIES`].
pub(crate) type Pipelines = [ComputePipeline; STAGES];

/// The pipelines of a shader text, and what is known about them.
pub(crate) struct Set {
    source: Arc<str>,
    pub(crate) pipelines: Pipelines,
    /// What pixels cost, by stage.
    pub(crate) costs: [Costs; STAGES],
    /// Whether each has run: some drivers compile when a pipeline runs first.
    pub(crate) is_warm: bool,
    /// Whether a picture was made with loops that all ended when they were done.
    pub(crate) is_proven: bool,
}

/// Sets of pipelines, the one that was used last at the end.
#[derive(Default)]
pub(crate) struct Cache {
    sets: Vec<Set>,
}

impl Cache {
    /// The pipelines of a shader text, compiled if they are not there.
    ///
    /// # Errors
    /// It does not compile, or not in time, or the observer asked to stop.
    pub(crate) async fn get(
        &mut self,
        gpu: &Arc<Gpu>,
        layouts: &Arc<Layouts>,
        source: &Arc<str>,
        observer: &dyn Observer,
    ) -> Result<&mut Set, GpuError> {
        let is_it = |set: &Set| Arc::ptr_eq(&set.source, source) || set.source == *source;
        let set = match self.sets.iter().position(is_it) {
            Some(at) => self.sets.remove(at),
            None => Set {
                source: Arc::clone(source),
                pipelines: gpu.host.compile(gpu, layouts, source, observer).await?,
                costs: Default::default(),
                is_warm: false,
                is_proven: false,
            },
        };
        if self.sets.len() == KEPT {
            self.sets.remove(0);
        }
        self.sets.push(set);
        let last = self.sets.len() - 1;
        Ok(&mut self.sets[last])
    }
}

/// Compiles the entry points of a shader.
///
/// # Errors
/// What the compiler says.
pub(crate) async fn compile(
    gpu: &Gpu,
    layouts: &Layouts,
    source: &str,
) -> Result<Pipelines, GpuError> {
    let failed = |error: GpuError| match error {
        GpuError::Refused { reason: log, .. } => GpuError::Shader { log },
        other => other,
    };
    let module = gpu
        .watched(0, || {
            gpu.device
                .create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: Some("scene"),
                    source: wgpu::ShaderSource::Wgsl(source.into()),
                })
        })
        .await
        .map_err(failed)?;
    let stages = gpu
        .watched(0, || {
            std::array::from_fn(|k| {
                gpu.device
                    .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                        label: Some(ENTRIES[k].name),
                        layout: Some(&layouts.pipelines[k]),
                        module: &module,
                        entry_point: Some(ENTRIES[k].name),
                        compilation_options: PipelineCompilationOptions::default(),
                        cache: None,
                    })
            })
        })
        .await
        .map_err(failed)?;
    Ok(stages)
}
