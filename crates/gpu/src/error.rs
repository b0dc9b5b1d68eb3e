//! Why the GPU did not render.

use zeroset_scene::render::RenderError;

/// What to install where there is no adapter.
#[cfg(target_os = "linux")]
const INSTALL: &str = "install the Vulkan driver of the graphics card, or a software one: on Debian and Ubuntu, \
     `apt install libvulkan1 mesa-vulkan-drivers`";
#[cfg(not(target_os = "linux"))]
const INSTALL: &str = "install the current driver of the graphics card";

/// Why the GPU did not render.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter fits.
    #[error("{wanted}: {}", listed(.found))]
    NoAdapter {
        /// What was looked for, and that it is not there.
        wanted: String,
        /// Adapters that are there, each with what it lacks.
        found: Vec<String>,
    },
    /// An adapter cannot do what is needed.
    #[error("{adapter} has {what} of {has}, and {needed} is needed")]
    Limit {
        /// The adapter.
        adapter: String,
        /// Which limit.
        what: String,
        /// What it is.
        has: u64,
        /// What is needed.
        needed: u64,
    },
    /// An adapter cannot run compute shaders.
    #[error("{adapter} runs no compute shaders")]
    NoCompute {
        /// The adapter.
        adapter: String,
    },
    /// The driver gives no device.
    #[error("{adapter} gives no device: {reason}")]
    NoDevice {
        /// The adapter.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// The shader of a scene does not compile.
    #[error("the shader of the scene does not compile: {log}")]
    Shader {
        /// What the compiler said.
        log: String,
    },
    /// The driver did not compile in time.
    #[error("the driver did not compile the shader of the scene within {seconds} s")]
    SlowCompiler {
        /// How long was waited.
        seconds: u64,
    },
    /// Something of the scene is larger than a buffer may be.
    #[error("{what} of the scene takes {bytes} bytes, {adapter} allows {limit} in a buffer")]
    TooLarge {
        /// What.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// The adapter.
        adapter: String,
        /// The most that is allowed.
        limit: u64,
    },
    /// A list of the scene is longer than a texture may be.
    #[error("the scene has {count} {unit}, {adapter} holds {limit}: the largest is {largest}")]
    Texels {
        /// What the list is of.
        unit: &'static str,
        /// How long it is.
        count: u64,
        /// The adapter.
        adapter: String,
        /// The most that is allowed.
        limit: u64,
        /// What takes most of it.
        largest: String,
    },
    /// There is not enough memory, even for a small part of the picture at a time.
    #[error("out of memory on {adapter}: {bytes} bytes cannot be had for {what}")]
    OutOfMemory {
        /// The adapter.
        adapter: String,
        /// What the allocation was for.
        what: String,
        /// The allocation that failed.
        bytes: u64,
    },
    /// The device was lost: the driver was reset, the card was taken away, or it did not answer.
    #[error("{adapter} was lost: {reason}")]
    Lost {
        /// The adapter.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// The driver refused a command.
    #[error("{adapter} refused a command: {reason}")]
    Refused {
        /// The adapter.
        adapter: String,
        /// What it said.
        reason: String,
    },
    /// Loops of the shader end before they are done, and a picture would be wrong.
    #[error(
        "{adapter} ends the loops of a shader early where they are long, and the scene needs longer ones: its picture would \
         be wrong"
    )]
    Loops {
        /// The adapter.
        adapter: String,
    },
    /// A formula of the scene has no Lipschitz constant, and shaders step by nothing else.
    #[error(
        "a formula of `{object}` has no Lipschitz constant: its surface is looked for by ranges, which only the CPU does"
    )]
    Unbounded {
        /// The object.
        object: String,
    },
    /// The scene has no shader, or its rendering was cancelled.
    #[error(transparent)]
    Scene(RenderError),
}

impl GpuError {
    /// The same, with what an allocation that failed was for.
    pub(crate) fn with_purpose(self, what: &str) -> GpuError {
        match self {
            GpuError::OutOfMemory { adapter, bytes, .. } => GpuError::OutOfMemory {
                adapter,
                what: what.to_owned(),
                bytes,
            },
            other => other,
        }
    }

    /// What can be done about it, if anything.
    pub fn advice(&self) -> Option<&'static str> {
        match self {
            GpuError::NoAdapter { .. } => Some(INSTALL),
            GpuError::Limit { .. } | GpuError::NoCompute { .. } => {
                Some("choose another adapter, or render on the CPU")
            }
            GpuError::Texels { .. } => Some("use smaller ones, or render on the CPU"),
            GpuError::OutOfMemory { .. } => {
                Some("close what else uses the GPU, or render on the CPU")
            }
            GpuError::Loops { .. } => Some(
                "render on the CPU, or with fewer steps, fewer rays of occlusion or shorter lists of points",
            ),
            GpuError::Unbounded { .. } => Some(
                "render on the CPU, or state how fast the formula changes at most: `slope = ...`",
            ),
            GpuError::Scene(_) => None,
            _ => Some("update the driver, or render on the CPU"),
        }
    }
}

/// A caller of [`Renderer`](zeroset_scene::render::Renderer) sees every failure of the device as one kind of error.
impl From<GpuError> for RenderError {
    fn from(error: GpuError) -> RenderError {
        match error {
            GpuError::Scene(error) => error,
            error => RenderError::Device {
                reason: error.to_string(),
                advice: error.advice(),
            },
        }
    }
}

fn listed(found: &[String]) -> String {
    if found.is_empty() {
        "the system has no graphics adapter".to_owned()
    } else {
        format!("there is {}", found.join("; "))
    }
}
