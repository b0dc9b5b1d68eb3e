//! What the CPU writes and shaders read: structs that are declared once, here, and printed as WGSL.
//!
//! A struct of this module has the same layout on both sides; a test compares every offset with what naga makes of the
//! printed declaration.

use bytemuck::{Pod, Zeroable};

/// A field of a shared struct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name.
    pub name: &'static str,
    /// Its type in WGSL.
    pub wgsl: &'static str,
    /// Where it begins, in bytes.
    pub offset: usize,
}

/// A struct that both sides know.
pub trait Shared: Pod {
    /// Its name.
    const NAME: &'static str;
    /// Its fields, in order.
    const MEMBERS: &'static [Member];

    /// Its declaration in WGSL.
    fn declaration() -> String {
        let fields: String = (Self::MEMBERS.iter())
            .map(|m| format!("    {}: {},\n", m.name, m.wgsl))
            .collect();
        format!("struct {} {{\n{fields}}}\n", Self::NAME)
    }
}

/// A type that has the same meaning in WGSL.
trait Wgsl {
    const WGSL: &'static str;
}

macro_rules! wgsl {
    ($($rust:ty = $wgsl:literal),*) => { $(impl Wgsl for $rust { const WGSL: &'static str = $wgsl; })* };
}
wgsl!(
    f32 = "f32",
    u32 = "u32",
    [f32; 2] = "vec2f",
    [u32; 2] = "vec2u",
    [f32; 3] = "vec3f",
    [u32; 4] = "vec4u"
);

macro_rules! shared {
    ($($(#[$meta:meta])* $name:ident { $($(#[$field_meta:meta])* $field:ident: $type:ty,)* })*) => { $(
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
        pub struct $name { $($(#[$field_meta])* pub $field: $type,)* }

        impl Shared for $name {
            const NAME: &'static str = stringify!($name);
            const MEMBERS: &'static [Member] = &[$(Member {
                name: stringify!($field),
                wgsl: <$type as Wgsl>::WGSL,
                offset: std::mem::offset_of!($name, $field),
            }),*];
        }
    )* };
}

shared! {
    /// Everything about a picture that is one number: camera, methods' numbers, sky, sizes, places of tables.
    Frame {
        /// Where the camera is.
        eye: [f32; 3],
        /// 1 if all rays go through the eye, 0 if they are parallel.
        pinhole: u32,
        /// To the right of the picture.
        right: [f32; 3],
        /// Side of a pixel on the plane at distance 1 (pinhole), or anywhere (orthographic).
        scale: f32,
        /// Upwards on the picture.
        up: [f32; 3],
        /// Rays start here.
        near: f32,
        /// Against the way the camera looks.
        back: [f32; 3],
        /// Rays end here at the latest.
        far: f32,
        /// Least coordinates of a box that holds the solid.
        region_min: [f32; 3],
        /// 1 if a ray that runs out of steps takes its best candidate.
        hit_selection: u32,
        /// Largest coordinates of that box.
        region_max: [f32; 3],
        /// Most steps of a ray.
        max_steps: u32,
        /// Width of a pixel along its ray: slope and constant.
        pixel: [f32; 2],
        /// Nearer than this to the surface a ray is under its footprint, in the middle of the picture: slope and constant.
        threshold: [f32; 2],
        /// What single precision cannot tell apart along a ray: slope and constant.
        rounding: [f32; 2],
        /// Share of a pixel's width that is the radius of its footprint.
        footprint: f32,
        /// 1 if what is under the footprint is a hit: the field is an estimate of something without an end to its detail. 2 if the
        /// field's value can be shown as a distance. Both can be so.
        quality: u32,
        /// The picture's size in pixels.
        size: [u32; 2],
        /// Half of it.
        half: [f32; 2],
        /// Number of the marcher: step, omega, share or beta.
        march: f32,
        /// Fixed-point steps behind a hit.
        placing: u32,
        /// Rays a pixel; 0 for one through its middle.
        samples: u32,
        /// Chooses other random numbers.
        seed: u32,
        /// Linear colour of the sky straight up.
        sky_top: [f32; 3],
        /// Share of the sky's light that reaches an open surface.
        ambient: f32,
        /// Linear colour at the horizon.
        sky_horizon: [f32; 3],
        /// Pixel filter: its place in `zeroset_scene::settings::Filter`.
        filter_kind: u32,
        /// Linear colour straight down.
        sky_bottom: [f32; 3],
        /// 1 if cones were marched first.
        prepass: u32,
        /// What the depth plane holds where nothing is hit.
        miss: f32,
        /// Number of lights.
        lights: u32,
        /// First row of the lights in the table.
        light_rows: u32,
        /// First row of the materials; the last of them is for what has none.
        material_rows: u32,
        /// Number of materials, without that last one.
        materials: u32,
        /// First row of the objects' occlusion; the last is the scene's own.
        object_rows: u32,
        /// Number of objects.
        objects: u32,
        /// Cells of 32x32 pixels in the band: those of 8x8 pixels come after them in `cones`.
        wide_cones: u32,
        /// Rows of pixels: the first that the band stores, how many it stores, the first that it gives, how many it gives.
        band: [u32; 4],
        /// Where sums 0 to 3 begin in `planes`, in numbers; 0xffffffff for one that is not asked for.
        sums_a: [u32; 4],
        /// Sums 4 to 7.
        sums_b: [u32; 4],
        /// Sums 8 to 11.
        sums_c: [u32; 4],
        /// 1 if anything but colour and coverage is asked for.
        detail: u32,
        /// The first of the rays a pixel that are traced now.
        first_ray: u32,
        /// First row of the grids.
        grid_rows: u32,
        /// How often a ray is reflected.
        reflections: u32,
        /// How often a ray passes the surface of a clear body, or is reflected within it.
        refractions: u32,
        /// Surfaces that light meets on its way, at most, where one way of many is followed.
        depth: u32,
        /// The most that the light counts of a ray that went on.
        clamp: f32,
        /// By what power fog grows thinner over a scene unit upwards.
        falloff: f32,
        /// Direction of the sun.
        sun: [f32; 3],
        /// Cosine of half the angle under which it is seen; above 1 where it is not shown.
        sun_cosine: f32,
        /// What a white surface shows that faces it.
        sun_radiance: [f32; 3],
        /// How much fog shows of it.
        glow: f32,
        /// Colour of fog.
        fog: [f32; 3],
        /// What fog takes over a scene unit at the height 0; 0 for none.
        density: f32,
        /// Edges that a pixel may be parted by.
        layers: u32,
        /// Radius of the lens; 0 where it has no extent.
        aperture: f32,
        /// How far before it, along the way it looks, what is sharp lies.
        focus: f32,
        /// First row of the environment.
        around_rows: u32,
        /// First row of the volume that skylight is read from.
        sky_rows: u32,
        /// First row of the volume that light was advected through.
        advected_rows: u32,
        /// Not used.
        pad_b: u32,
        /// Not used.
        pad_c: u32,
    }

    /// What one dispatch covers.
    Tile {
        /// First pixel of the picture.
        corner: [u32; 2],
        /// Width and height in pixels.
        size: [u32; 2],
        /// Which of the rays a pixel.
        index: u32,
        /// Which turn of these rays, where they are traced in turns.
        turn: u32,
        /// Words of notes that there are for each of these rays.
        notes: u32,
        /// Not used.
        pad: u32,
    }

    /// A light, as rows of the table.
    Light {
        /// The way towards it (kind 0), or where it is (kind 1).
        place: [f32; 3],
        /// 0 directional, 1 point, 2 rectangle, 3 disc, 4 sphere.
        kind: f32,
        /// Linear colour times intensity.
        radiance: [f32; 3],
        /// Luminance of that.
        luminance: f32,
        /// Its place in `zeroset_scene::settings::Shadow`.
        shadow: f32,
        /// Sharpness of the penumbra; how far before the surface advected light is read, scene units.
        sharpness: f32,
        /// What a lamp shows to one side, scene units squared.
        area: f32,
        /// 1 where rays meet the lamp.
        visible: f32,
        /// From the middle of a lamp to its right edge.
        right: [f32; 3],
        /// Radius of a sphere.
        radius: f32,
        /// From the middle of a lamp to its upper edge.
        up: [f32; 3],
        /// Number of the grid of what is left of advected light.
        grid: f32,
    }

    /// An environment, as rows of the table. Where its images begin is the row of their first texel through all layers of the texture, and
    /// its column.
    Around {
        /// Row of what is seen.
        image_row: f32,
        /// Column of it.
        image_column: f32,
        /// Pixels across.
        width: f32,
        /// Pixels down.
        height: f32,
        /// Row of the table that directions are chosen by.
        table_row: f32,
        /// Column of it.
        table_column: f32,
        /// Cells across.
        columns: f32,
        /// Cells down.
        rows: f32,
        /// Row of what rough mirrors show.
        glossy_row: f32,
        /// Column of it.
        glossy_column: f32,
        /// What its light is multiplied by.
        strength: f32,
        /// Not used.
        pad: f32,
        /// What arrives at open surfaces: the first nine spherical harmonics.
        h0: [f32; 3],
        /// Cosine of how far it is turned.
        cosine: f32,
        /// The second.
        h1: [f32; 3],
        /// Sine of how far it is turned.
        sine: f32,
        /// The third.
        h2: [f32; 3],
        /// Not used.
        pad_c: f32,
        /// The fourth.
        h3: [f32; 3],
        /// Not used.
        pad_d: f32,
        /// The fifth.
        h4: [f32; 3],
        /// Not used.
        pad_e: f32,
        /// The sixth.
        h5: [f32; 3],
        /// Not used.
        pad_f: f32,
        /// The seventh.
        h6: [f32; 3],
        /// Not used.
        pad_g: f32,
        /// The eighth.
        h7: [f32; 3],
        /// Not used.
        pad_h: f32,
        /// The ninth.
        h8: [f32; 3],
        /// Not used.
        pad_i: f32,
    }

    /// An ambient occlusion method, as rows of the table.
    Occluder {
        /// Its place in `zeroset_scene::settings::Occlusion`.
        kind: f32,
        /// Samples or rays.
        count: f32,
        /// Step or reach, scene units.
        reach: f32,
        /// Strength, or the falloff of obscurance.
        scale: f32,
        /// How far the way bends.
        bend: f32,
        /// How much farther away white things are in their own colour, scene units.
        bleed: f32,
        /// Not used.
        pad_b: f32,
        /// Not used.
        pad_c: f32,
    }

    /// A volume that skylight or the shadow of a light is read from, as rows of the table.
    SkyVolume {
        /// Its first node.
        origin: [f32; 3],
        /// From one node to the next, scene units.
        voxel: f32,
        /// Voxels along each axis.
        cells: [f32; 3],
        /// Number of its first grid.
        grid: f32,
    }

    /// A material as it lies on something, as rows of the table.
    Material {
        /// Its colour, where it is one.
        albedo: [f32; 3],
        /// Which place in `Structure::coats` is that of the space that it lies in, plus one; 0 where that is the world.
        place: f32,
        /// Light of its own.
        emission: [f32; 3],
        /// Strength of the highlight.
        specular: f32,
        /// What light loses inside over a scene unit.
        attenuation: [f32; 3],
        /// Exponent of the highlight.
        shininess: f32,
        /// 0 plastic, 1 metal.
        metallic: f32,
        /// 0 mirror, 1 chalk.
        roughness: f32,
        /// 0 opaque, 1 glass.
        transmission: f32,
        /// Index of refraction.
        ior: f32,
        /// First row of the texture of its colour; 0 where it is one colour.
        albedo_texture: f32,
        /// That of its roughness.
        roughness_texture: f32,
        /// That of how metallic it is.
        metallic_texture: f32,
        /// That of its heights.
        bump_texture: f32,
        /// How high white is.
        depth: f32,
        /// Size of the finest thing in the texture of its heights.
        finest: f32,
        /// Not used.
        pad_a: f32,
        /// Not used.
        pad_b: f32,
    }

    /// A part of a texture, as rows of the table.
    TexturePart {
        /// First colour.
        a: [f32; 3],
        /// The part that is shown in its stead, by number; 0 for none.
        instead_a: f32,
        /// Second colour.
        b: [f32; 3],
        /// In its stead.
        instead_b: f32,
        /// Third colour.
        c: [f32; 3],
        /// In its stead.
        instead_c: f32,
        /// Fourth colour.
        d: [f32; 3],
        /// In its stead.
        instead_d: f32,
        /// A direction, or where a gradient begins.
        start: [f32; 3],
        /// Its place in `zeroset_scene::material::Pattern`.
        kind: f32,
        /// Where a gradient ends.
        end: [f32; 3],
        /// Size, scene units; the number of a formula.
        size: f32,
        /// First row of the matrix that leads to where it lies.
        x: [f32; 3],
        /// First part of its offset.
        offset_x: f32,
        /// Second row.
        y: [f32; 3],
        /// Second part.
        offset_y: f32,
        /// Third row.
        z: [f32; 3],
        /// Third part.
        offset_z: f32,
        /// Octaves of noise, or sharpness of a projection.
        detail: f32,
        /// How many parts there are from this one on, of the same texture.
        count: f32,
        /// 1 where it lies as the texture does.
        still: f32,
        /// Not used.
        pad_a: f32,
        /// Where the image begins: the row of its first texel through all layers of the texture.
        image_row: f32,
        /// Column of its first texel.
        image_column: f32,
        /// Width of the image.
        width: f32,
        /// Height of the image.
        height: f32,
    }

    /// A grid of samples, as a row of the table.
    Grid {
        /// Nodes along x.
        nodes_x: f32,
        /// Nodes along y.
        nodes_y: f32,
        /// Where its samples begin: the row of the first texel through all layers of the texture.
        row: f32,
        /// Column of that texel.
        column: f32,
    }

    /// What one ray found.
    Sample {
        /// Linear colour.
        colour: [f32; 3],
        /// Distance along the ray, or -1 where nothing was hit.
        depth: f32,
        /// Unit normal.
        normal: [f32; 3],
        /// |f| at the hit.
        residual: f32,
        /// Linear colour of the surface.
        albedo: [f32; 3],
        /// Ambient visibility.
        open: f32,
        /// Visibility of the lights.
        shadow: f32,
        /// Number of the object plus 1.
        object: f32,
        /// Evaluations of the primary ray.
        steps: f32,
        /// Where in its pixel it went through: two fractions of 65,535. Where there is one ray a pixel, the bits of the share of
        /// the pixel that is covered.
        place: u32,
    }

    /// Filtered sums of a pixel.
    LightSum {
        /// Weighted colours.
        colour: [f32; 3],
        /// Weights.
        weight: f32,
        /// Weighted hits.
        cover: f32,
        /// Own rays that hit.
        hits: f32,
        /// Their evaluations, and those of the own rays that did not.
        steps: f32,
        /// Not used.
        pad: f32,
    }

    /// Sums over a pixel's own rays that hit.
    SurfaceSum {
        /// Normals.
        normal: [f32; 3],
        /// Distance of the nearest hit, or -1.
        depth: f32,
        /// Colours of the surface.
        albedo: [f32; 3],
        /// |f| at the nearest hit.
        residual: f32,
        /// Ambient visibility.
        open: f32,
        /// Visibility of the lights.
        shadow: f32,
        /// Number of the nearest object plus 1.
        object: f32,
        /// Not used.
        pad: f32,
    }
}

/// Rows of four numbers that a struct takes in the table.
pub const fn rows<T>() -> usize {
    size_of::<T>() / 16
}

/// A function that reads a struct of numbers from the rows of the table that begin at `at`.
pub fn loader<T: Shared>() -> String {
    let fields: Vec<String> = (T::MEMBERS.iter())
        .map(|m| {
            let (row, component) = (m.offset / 16, m.offset % 16 / 4);
            let components = match m.wgsl {
                "vec3f" => "xyz",
                _ => &"xyzw"[component..=component],
            };
            format!("table[at + {row}u].{components}")
        })
        .collect();
    let (name, fields) = (T::NAME, fields.join(", "));
    format!(
        "fn load_{}(at: u32) -> {name} {{\n    return {name}({fields});\n}}\n",
        name.to_lowercase()
    )
}
