//! Limits: what a scene file may cost. Every one is checked before the allocation or the work that it guards.

use zeroset_scene::accumulator;
use zeroset_scene::film::{self, Plane};

/// What a scene may cost. A file from a stranger ends in an error within these.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Nodes of all fields together; a shape used twice counts twice.
    pub nodes: u64,
    /// Objects that are shown.
    pub objects: u64,
    /// Operations inside each other in a field, brackets and blocks inside each other in a file.
    pub nesting: u64,
    /// Steps of the script: expressions evaluated, items copied.
    pub ticks: u64,
    /// Bytes of all values that the script makes.
    pub heap: u64,
    /// Calls inside each other.
    pub calls: u64,
    /// Seconds that loading may take.
    pub seconds: f64,
    /// Pixels of the picture.
    pub pixels: u64,
    /// Rays that sample one thing: a pixel, an ambient occlusion.
    pub samples: u64,
    /// Files that a scene loads, itself included.
    pub files: u64,
    /// Bytes of one scene file.
    pub file_bytes: u64,
    /// Bytes of one image file.
    pub image_bytes: u64,
    /// Pixels of one image.
    pub image_pixels: u64,
    /// Bytes of one file of a mesh or of samples.
    pub mesh_bytes: u64,
    /// Vertices and triangles of one mesh.
    pub mesh_faces: u64,
    /// Samples of one mesh or volume.
    pub grid_samples: u64,
    /// Seconds that sampling the meshes of a scene may take, beside those of loading.
    pub sampling_seconds: f64,
    /// Bytes of memory of a picture and of what it takes to make it; loading may take an eighth of them.
    pub memory: u64,
    /// Characters of a name: of the scene, an object, a parameter.
    pub name: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            nodes: 100_000,
            objects: 10_000,
            nesting: 100,
            ticks: 5_000_000,
            heap: 64 << 20,
            calls: 100,
            seconds: 1.5,
            pixels: 64 << 20,
            samples: 4096,
            files: 64,
            file_bytes: 16 << 20,
            image_bytes: 32 << 20,
            image_pixels: 4 << 20,
            mesh_bytes: 128 << 20,
            mesh_faces: 4 << 20,
            grid_samples: 16 << 20,
            sampling_seconds: 120.0,
            memory: 2 << 30,
            name: 200,
        }
    }
}

/// A limit by name: what a flag of the command line sets and a reference lists.
#[derive(Clone, Copy)]
pub struct Limit {
    /// Its name.
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    get: fn(&Limits) -> f64,
    set: fn(&mut Limits, f64),
}

macro_rules! limit {
    ($name:ident, $doc:literal) => {
        Limit {
            name: stringify!($name),
            doc: $doc,
            get: |l| l.$name as f64,
            set: |l, x| l.$name = x as _,
        }
    };
}

/// All limits.
pub const LIMITS: &[Limit] = &[
    limit!(
        nodes,
        "nodes of all fields together; a shape used twice counts twice"
    ),
    limit!(objects, "objects that are shown"),
    limit!(nesting, "brackets and blocks inside each other in a file"),
    limit!(
        ticks,
        "steps of the script: expressions evaluated, items copied"
    ),
    limit!(heap, "bytes of all values that the script makes"),
    limit!(calls, "calls inside each other"),
    limit!(seconds, "seconds that loading may take"),
    limit!(pixels, "pixels of the picture"),
    limit!(
        samples,
        "rays that sample one thing: a pixel, an ambient occlusion"
    ),
    limit!(files, "files that a scene loads, itself included"),
    limit!(file_bytes, "bytes of one scene file"),
    limit!(image_bytes, "bytes of one image file"),
    limit!(image_pixels, "pixels of one image"),
    limit!(mesh_bytes, "bytes of one file of a mesh or of samples"),
    limit!(mesh_faces, "vertices and triangles of one mesh"),
    limit!(grid_samples, "samples of one mesh or volume"),
    limit!(
        sampling_seconds,
        "seconds that sampling the meshes of a scene may take"
    ),
    limit!(
        memory,
        "bytes of memory of a picture; loading may take an eighth of them"
    ),
    limit!(
        name,
        "characters of a name: of the scene, an object, a parameter"
    ),
];

/// Why a limit cannot be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LimitError {
    /// No limit has this name.
    #[error("there is no limit `{name}`; the limits are {}", LIMITS.iter().map(|l| l.name).collect::<Vec<_>>().join(", "))]
    Unknown {
        /// What was given.
        name: String,
    },
    /// Not a number that a limit can be.
    #[error("the limit `{name}` must be a number above 0, not `{value}`")]
    Value {
        /// Which.
        name: &'static str,
        /// What was given.
        value: String,
    },
    /// A picture that would take too much memory.
    #[error(
        "a picture of {}x{} pixels takes about {} of memory, at most {} are allowed: make it smaller, or raise the limit \
         `memory`",
        .size[0], .size[1], in_words(*.bytes), in_words(*.allowed)
    )]
    Picture {
        /// Width and height.
        size: [u32; 2],
        /// Estimated bytes.
        bytes: u64,
        /// Allowed bytes.
        allowed: u64,
    },
}

impl Limits {
    /// No limits at all.
    pub const NONE: Limits = Limits {
        nodes: u64::MAX,
        objects: u64::MAX,
        nesting: u64::MAX,
        ticks: u64::MAX,
        heap: u64::MAX,
        calls: u64::MAX,
        seconds: f64::INFINITY,
        pixels: u64::MAX,
        samples: u64::MAX,
        files: u64::MAX,
        file_bytes: u64::MAX,
        image_bytes: u64::MAX,
        image_pixels: u64::MAX,
        mesh_bytes: u64::MAX,
        mesh_faces: u64::MAX,
        grid_samples: u64::MAX,
        sampling_seconds: f64::INFINITY,
        memory: u64::MAX,
        name: u64::MAX,
    };

    /// Sets a limit by name.
    ///
    /// # Errors
    /// An unknown name, or not a number above 0.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), LimitError> {
        let limit = LIMITS
            .iter()
            .find(|l| l.name == name)
            .ok_or_else(|| LimitError::Unknown { name: name.into() })?;
        match value.trim().parse::<f64>() {
            Ok(x) if x > 0.0 && x <= 1e15 => (limit.set)(self, x),
            _ => {
                return Err(LimitError::Value {
                    name: limit.name,
                    value: value.into(),
                });
            }
        }
        Ok(())
    }

    /// Whether a name is short enough.
    pub(crate) fn check_name(&self, name: &str) -> Result<(), String> {
        let length = name.chars().count() as u64;
        if length <= self.name {
            return Ok(());
        }
        Err(format!(
            "a name of {length} characters: at most {} are allowed (limit `name`)",
            self.name
        ))
    }

    /// Whether a picture with these planes of a film is allowed, as far as memory goes. `copies` are bytes a pixel that
    /// are needed beside the film once it is rendered: for what is written to a file or shown.
    ///
    /// # Errors
    /// An estimate of what it takes, with what is allowed.
    pub fn check_picture(
        &self,
        size: [u32; 2],
        planes: &[Plane],
        copies: u64,
    ) -> Result<(), LimitError> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        // while it is rendered there are sums, and once it is, the film that is made in their place
        let sums = accumulator::bytes(size, planes).saturating_add(film::scratch(size));
        let film = film::bytes(size, planes).saturating_add(pixels.saturating_mul(copies));
        let bytes = sums.max(film);
        if bytes <= self.memory {
            return Ok(());
        }
        Err(LimitError::Picture {
            size,
            bytes,
            allowed: self.memory,
        })
    }
}

impl Limit {
    /// What it is in `limits`.
    pub fn of(&self, limits: &Limits) -> f64 {
        (self.get)(limits)
    }
}

/// Bytes for people.
pub(crate) fn in_words(bytes: u64) -> String {
    match bytes {
        0..1_000_000 => format!("{} KiB", bytes.div_ceil(1 << 10)),
        1_000_000..10_000_000_000 => format!("{} MiB", bytes.div_ceil(1 << 20)),
        _ => format!("{} GiB", bytes.div_ceil(1 << 30)),
    }
}
