//! The entry points of a shader module, and the buffers and textures that each uses.

/// Threads of a workgroup along each of two axes.
pub const WORKGROUP: u32 = 8;
/// Side of the cells that `cones_wide` and `cones_narrow` march, in pixels.
pub const CONE_SIDES: [u32; 2] = [32, 8];
/// Pixels that samples reach over the edge of their own, at most.
pub const MARGIN: u32 = 2;
/// Counters that shaders add to: pairs of the low and high half of 64 bits for evaluations of prepass, march, normals,
/// occlusion, shadows, materials, and for primary rays and hits; then [`CUT_SHORT`] and [`WAITING`].
pub const COUNTERS: u32 = 18;
/// Which counter is not 0 where loops of a thread ended before they were done. llvmpipe ends every loop of a thread once all
/// of them together have made 65,535 turns, without a word, and a picture of such threads is wrong.
pub const CUT_SHORT: usize = 16;
/// Which counter is not 0 where a ray that is traced in turns has a question left.
pub const WAITING: usize = 17;

/// Numbers in the uniform buffer of the field's parameters: every GPU has room for them.
pub const UNIFORM_NUMBERS: usize = 4096;
/// Rows in the uniform buffer of the table.
pub const UNIFORM_ROWS: usize = 1024;

/// A buffer or a texture of bind group 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Binding {
    /// [`crate::layout::Frame`], read only. Not a uniform: lavapipe compiles a shader anew for the values of uniforms that
    /// it branches on, at every dispatch.
    Frame = 0,
    /// [`crate::layout::Tile`], read only, with a dynamic offset.
    Tile = 1,
    /// Parameters of the field: `array<f32>`, read only.
    Params = 2,
    /// Instructions of an interpreted field: `array<u32>`, read only.
    Code = 3,
    /// Lights, materials, objects: `array<vec4f>`, read only.
    Table = 4,
    /// Starts, slopes and radii of cones: `array<vec4f>`. Where rays are traced in turns there are no cones, and these are
    /// the rays' notes: `array<u32>`.
    Cones = 5,
    /// [`crate::layout::Sample`] of every stored pixel.
    Samples = 6,
    /// [`crate::layout::LightSum`] of every given pixel.
    Light = 7,
    /// [`crate::layout::SurfaceSum`] of every given pixel.
    Surface = 8,
    /// The planes that are asked for, one after the other: `array<f32>`.
    Planes = 9,
    /// [`COUNTERS`] atomic `u32`.
    Counters = 10,
    /// Parameters of the field, if they are at most [`UNIFORM_NUMBERS`]: `array<vec4f>`, uniform. What all threads read alike
    /// is cheaper from there, and a driver that turns every read of a storage buffer into a loop over lanes compiles a large
    /// field a hundred times as fast.
    Numbers = 11,
    /// The table, if it has at most [`UNIFORM_ROWS`]: `array<vec4f>`, uniform.
    Rows = 12,
    /// Pixels of images, in a [`texture`](crate::texture): `texture_2d_array<f32>`.
    Images = 13,
    /// Samples of grids, likewise.
    Grids = 14,
}

impl Binding {
    /// All of them.
    pub const ALL: [Binding; 15] = [
        Binding::Frame,
        Binding::Tile,
        Binding::Params,
        Binding::Code,
        Binding::Table,
        Binding::Cones,
        Binding::Samples,
        Binding::Light,
        Binding::Surface,
        Binding::Planes,
        Binding::Counters,
        Binding::Numbers,
        Binding::Rows,
        Binding::Images,
        Binding::Grids,
    ];

    /// Whether it is a texture, else a buffer.
    pub fn is_texture(self) -> bool {
        matches!(self, Binding::Images | Binding::Grids)
    }

    /// Its declaration in WGSL.
    pub(crate) fn declaration(self, in_turns: bool) -> String {
        let (space, name, kind) = match self {
            Binding::Frame => ("storage, read", "given_frame", "Frame"),
            Binding::Tile => ("storage, read", "given_tile", "Tile"),
            Binding::Params => ("storage, read", "params", "array<f32>"),
            Binding::Code => ("storage, read", "code", "array<u32>"),
            Binding::Table => ("storage, read", "table", "array<vec4f>"),
            Binding::Cones if in_turns => ("storage, read_write", "notes", "array<u32>"),
            Binding::Cones => ("storage, read_write", "cones", "array<vec4f>"),
            Binding::Samples => ("storage, read_write", "samples", "array<Sample>"),
            Binding::Light => ("storage, read_write", "light_sums", "array<LightSum>"),
            Binding::Surface => ("storage, read_write", "surface_sums", "array<SurfaceSum>"),
            Binding::Planes => ("storage, read_write", "planes", "array<f32>"),
            Binding::Counters => ("storage, read_write", "counters", "array<atomic<u32>, 18>"),
            Binding::Numbers => ("uniform", "numbers", "array<vec4f, 1024>"),
            Binding::Rows => ("uniform", "rows", "array<vec4f, 1024>"),
            Binding::Images => ("", "images", "texture_2d_array<f32>"),
            Binding::Grids => ("", "grids", "texture_2d_array<f32>"),
        };
        let space = match space {
            "" => String::new(),
            space => format!("<{space}>"),
        };
        format!(
            "@group(0) @binding({}) var{space} {name}: {kind};\n",
            self as u32
        )
    }
}

/// An entry point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub name: &'static str,
    /// What it may use.
    pub bindings: &'static [Binding],
}

/// One thread for every cell of 32x32 pixels that overlaps the band's stored rows.
pub const CONES_WIDE: Entry = Entry {
    name: "cones_wide",
    bindings: &[
        Binding::Frame,
        Binding::Params,
        Binding::Numbers,
        Binding::Code,
        Binding::Table,
        Binding::Rows,
        Binding::Grids,
        Binding::Cones,
        Binding::Counters,
    ],
};
/// One thread for every cell of 8x8 pixels that overlaps the band's stored rows. Runs after `cones_wide`.
pub const CONES_NARROW: Entry = Entry {
    name: "cones_narrow",
    bindings: CONES_WIDE.bindings,
};
/// One thread for every pixel of the tile: one ray.
pub const TRACE: Entry = Entry {
    name: "trace",
    bindings: &[
        Binding::Frame,
        Binding::Tile,
        Binding::Params,
        Binding::Numbers,
        Binding::Code,
        Binding::Table,
        Binding::Rows,
        Binding::Images,
        Binding::Grids,
        Binding::Cones,
        Binding::Samples,
        Binding::Counters,
    ],
};
/// One thread for every pixel of the tile, which lies in the band's given rows: adds the samples around it up.
pub const GATHER: Entry = Entry {
    name: "gather",
    bindings: &[
        Binding::Frame,
        Binding::Tile,
        Binding::Samples,
        Binding::Light,
        Binding::Surface,
    ],
};
/// One thread for every pixel of the tile, which lies in the band's given rows: from sums to planes.
pub const DEVELOP: Entry = Entry {
    name: "develop",
    bindings: &[
        Binding::Frame,
        Binding::Tile,
        Binding::Light,
        Binding::Surface,
        Binding::Planes,
    ],
};

/// All entry points of a shader module.
pub const ENTRIES: [Entry; 5] = [CONES_WIDE, CONES_NARROW, TRACE, GATHER, DEVELOP];
