//! Adapters: the GPUs of the machine, and software that stands for one.

use crate::error::GpuError;
use std::fmt;
use std::path::Path;
use std::str::FromStr;
use wgpu::{Backend, Backends, DeviceType, DownlevelFlags, Features, Limits};
use zeroset_shader::texture::{MOST_LAYERS, SIDE};

/// Which adapter renders.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// The fastest kind of GPU there is. Software that stands for a GPU is not taken: the CPU's renderer is faster.
    #[default]
    Auto,
    /// As `Auto`, and software where there is nothing else.
    Any,
    /// The one whose name holds this text, in any case.
    Named(String),
}

impl FromStr for Choice {
    type Err = std::convert::Infallible;
    fn from_str(text: &str) -> Result<Choice, Self::Err> {
        Ok(match text {
            "auto" => Choice::Auto,
            "any" => Choice::Any,
            name => Choice::Named(name.to_owned()),
        })
    }
}

/// What an adapter is, the fastest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A card with memory of its own.
    Discrete,
    /// A part of the processor.
    Integrated,
    /// A share of a GPU, given to a virtual machine.
    Virtual,
    /// The driver does not say.
    Other,
    /// Software on the CPU.
    Software,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Kind::Discrete => "discrete GPU",
            Kind::Integrated => "integrated GPU",
            Kind::Virtual => "virtual GPU",
            Kind::Other => "unknown kind",
            Kind::Software => "software",
        })
    }
}

impl From<DeviceType> for Kind {
    fn from(kind: DeviceType) -> Kind {
        match kind {
            DeviceType::DiscreteGpu => Kind::Discrete,
            DeviceType::IntegratedGpu => Kind::Integrated,
            DeviceType::VirtualGpu => Kind::Virtual,
            DeviceType::Other => Kind::Other,
            DeviceType::Cpu => Kind::Software,
        }
    }
}

/// An adapter and what it can do.
#[derive(Clone, Debug, PartialEq)]
pub struct AdapterInfo {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: Kind,
    /// The interface that it is reached by: Vulkan, Metal or DirectX 12.
    pub backend: &'static str,
    /// The driver and its version.
    pub driver: String,
    /// The largest buffer that a shader may see, bytes.
    pub largest_binding: u64,
    /// Whether it says how long its work takes.
    pub has_timestamps: bool,
    /// Why it cannot render, if it cannot.
    pub lack: Option<GpuError>,
}

impl AdapterInfo {
    pub(crate) fn new(adapter: &wgpu::Adapter) -> AdapterInfo {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        let driver = format!("{} {}", info.driver, info.driver_info);
        AdapterInfo {
            lack: lack(adapter, &info.name).err(),
            name: info.name,
            kind: info.device_type.into(),
            backend: backend_name(info.backend),
            driver: driver.trim().to_owned(),
            largest_binding: limits
                .max_storage_buffer_binding_size
                .min(limits.max_buffer_size),
            has_timestamps: adapter.features().contains(Features::TIMESTAMP_QUERY),
        }
    }

    /// The name with the interface, for messages.
    pub fn title(&self) -> String {
        format!("{} ({})", self.name, self.backend)
    }
}

fn backend_name(backend: Backend) -> &'static str {
    match backend {
        Backend::Vulkan => "Vulkan",
        Backend::Metal => "Metal",
        Backend::Dx12 => "DirectX 12",
        Backend::Gl => "OpenGL",
        Backend::BrowserWebGpu => "WebGPU",
        Backend::Noop => "none",
    }
}

/// The limits that a device is asked for: what the shaders need, and as much memory as the adapter lets a buffer have.
pub(crate) fn needed(has: &Limits) -> Limits {
    Limits {
        max_bind_groups: 1,
        max_storage_buffers_per_shader_stage: STORAGE_BUFFERS,
        max_dynamic_storage_buffers_per_pipeline_layout: 1,
        max_uniform_buffer_binding_size: 16 << 10,
        max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
        max_buffer_size: has.max_buffer_size,
        max_texture_dimension_2d: SIDE,
        max_texture_array_layers: has.max_texture_array_layers.min(MOST_LAYERS),
        max_compute_workgroup_storage_size: 1 << 10,
        max_compute_invocations_per_workgroup: 64,
        max_compute_workgroup_size_x: 8,
        max_compute_workgroup_size_y: 8,
        max_compute_workgroup_size_z: 1,
        max_compute_workgroups_per_dimension: 65_535,
        max_buffers_and_acceleration_structures_per_shader_stage: STORAGE_BUFFERS + 2,
        ..Limits::downlevel_webgl2_defaults()
    }
}

/// Storage buffers of the entry point that has most.
const STORAGE_BUFFERS: u32 = 8;
/// The smallest buffer that rendering makes sense with, bytes.
const SMALLEST_BUFFER: u64 = 16 << 20;

fn lack(adapter: &wgpu::Adapter, name: &str) -> Result<(), GpuError> {
    let flags = adapter.get_downlevel_capabilities().flags;
    if !flags.contains(DownlevelFlags::COMPUTE_SHADERS) {
        return Err(GpuError::NoCompute {
            adapter: name.to_owned(),
        });
    }
    let has = adapter.limits();
    let mut first = None;
    let smallest = Limits {
        max_buffer_size: SMALLEST_BUFFER,
        max_storage_buffer_binding_size: SMALLEST_BUFFER,
        ..needed(&has)
    };
    smallest.check_limits_with_fail_fn(&has, true, |what, needed, has| {
        first.get_or_insert_with(|| GpuError::Limit {
            adapter: name.to_owned(),
            what: what.to_owned(),
            has,
            needed,
        });
    });
    first.map_or(Ok(()), Err)
}

/// All adapters.
#[derive(Default)]
pub(crate) struct Adapters {
    adapters: Vec<(AdapterInfo, wgpu::Adapter)>,
}

impl Adapters {
    /// Looks for adapters, the best first.
    pub(crate) async fn find() -> Adapters {
        let backends = Backends::PRIMARY;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends,
            flags: wgpu::InstanceFlags::empty().with_env(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let found = instance.enumerate_adapters(backends).await;
        let mut adapters: Vec<_> = found
            .into_iter()
            .map(|adapter| (AdapterInfo::new(&adapter), adapter))
            .collect();
        // stable: the system's own order within a kind
        adapters.sort_by_key(|(info, _)| info.kind);
        Adapters { adapters }
    }

    /// The adapter that a choice means.
    pub(crate) async fn choose(choice: &Choice) -> Result<wgpu::Adapter, GpuError> {
        let all = if *choice == Choice::Auto && !may_have_gpu() {
            Adapters::default()
        } else {
            Adapters::find().await
        };
        let best = all.adapters.iter().find(|(info, _)| match choice {
            Choice::Auto => is_automatic(info),
            Choice::Any => info.lack.is_none(),
            Choice::Named(name) => info.name.to_lowercase().contains(&name.to_lowercase()),
        });
        match best {
            Some((info, adapter)) => match &info.lack {
                None => Ok(adapter.clone()),
                Some(lack) => Err(lack.clone()),
            },
            None => Err(GpuError::NoAdapter {
                wanted: match choice {
                    Choice::Auto => "there is no GPU to render with".to_owned(),
                    Choice::Any => "there is no adapter to render with".to_owned(),
                    Choice::Named(name) => format!("no adapter is named `{name}`"),
                },
                found: all.adapters.iter().map(|(info, _)| told(info)).collect(),
            }),
        }
    }
}

/// Whether the system may have a GPU at all. To ask the drivers takes 40 ms, and some of them print on a system without a
/// screen; on Linux the kernel tells at once.
fn may_have_gpu() -> bool {
    let devices = [
        "/dev/dri",
        "/dev/nvidiactl",
        "/dev/dxg",
        "/dev/mali0",
        "/dev/kgsl-3d0",
    ];
    !cfg!(target_os = "linux") || devices.iter().any(|path| Path::new(path).exists())
}

fn is_automatic(info: &AdapterInfo) -> bool {
    let real = matches!(info.kind, Kind::Discrete | Kind::Integrated | Kind::Virtual);
    real && info.lack.is_none()
}

fn told(info: &AdapterInfo) -> String {
    let what = format!("{}, {}", info.title(), info.kind);
    match &info.lack {
        Some(lack) => format!("{what}: {lack}"),
        None => what,
    }
}

/// All adapters, the best first, and the number of the one that [`Choice::Auto`] takes.
pub(crate) async fn adapters() -> (Vec<AdapterInfo>, Option<usize>) {
    let all = Adapters::find().await;
    let infos: Vec<_> = all.adapters.into_iter().map(|(info, _)| info).collect();
    let automatic = infos.iter().position(is_automatic);
    (infos, automatic)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(name: &str, kind: Kind, backend: &'static str) -> AdapterInfo {
        AdapterInfo {
            name: name.into(),
            kind,
            backend,
            driver: String::new(),
            largest_binding: 1 << 30,
            has_timestamps: true,
            lack: None,
        }
    }

    #[test]
    fn auto_takes_hardware_only() {
        assert!(is_automatic(&info("a", Kind::Discrete, "Vulkan")));
        assert!(is_automatic(&info("a", Kind::Integrated, "Metal")));
        assert!(!is_automatic(&info("a", Kind::Software, "Vulkan")));
        assert!(!is_automatic(&info("a", Kind::Other, "Vulkan")));
        let lack = Some(GpuError::NoCompute {
            adapter: "a".into(),
        });
        let lacking = AdapterInfo {
            lack,
            ..info("a", Kind::Discrete, "Vulkan")
        };
        assert!(!is_automatic(&lacking));
    }

    #[test]
    fn every_choice_has_a_word() {
        for (text, choice) in [
            ("auto", Choice::Auto),
            ("any", Choice::Any),
            ("llvmpipe", Choice::Named("llvmpipe".into())),
        ] {
            assert_eq!(text.parse(), Ok(choice));
        }
    }

    #[test]
    fn a_name_that_nothing_has_is_refused_with_what_there_is() {
        let choice = Choice::Named("no such thing".into());
        let error = crate::blocking::now(Adapters::choose(&choice)).err();
        let Some(error @ GpuError::NoAdapter { .. }) = error else {
            panic!("{error:?}");
        };
        assert!(error.to_string().contains("no such thing"), "{error}");
        assert!(error.advice().is_some());
    }
}
