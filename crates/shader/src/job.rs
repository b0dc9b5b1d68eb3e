//! A scene as numbers for a shader: what changes from picture to picture, in buffers.

use crate::entry::{CONE_SIDES, MARGIN};
use crate::field::place_number;
use crate::layout::{self, Around, Frame, Light, Material, Occluder, TexturePart};
use crate::source::{Key, number, pattern_kind, reach};
use crate::texture;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use zeroset_field::formula::ColourFormula;
use zeroset_field::program::{Limits, Program};
use zeroset_number::Grid;
use zeroset_scene::accumulator::Sum;
use zeroset_scene::camera::Camera;
use zeroset_scene::light::Source as LightSource;
use zeroset_scene::material::{self, Image, Pattern};
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{
    Antialias, Filter, Integrator, March, Occlusion, Settings, Shading, Shadow,
};
use zeroset_shade::advection::LightVolume;
use zeroset_shade::air::Air;
use zeroset_shade::coat::{Coat, compiled};
use zeroset_shade::coverage::LAYERS;
use zeroset_shade::environment::EnvironmentMap;
use zeroset_shade::lamp::{Lamp, Shape};
use zeroset_shade::light::luminance;
use zeroset_shade::pattern::{Part, PartInk, Texture};
use zeroset_shade::skin::has_skins;
use zeroset_shade::skylight::{Extent, LEVELS, Reading, SkyVolume, per_voxel};
use zeroset_shade::view::{Region, View};

/// How the field gets into the shader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FieldForm {
    /// As code where it is short enough, else as data.
    #[default]
    Auto,
    /// As code: the fastest, but a driver takes long to compile much of it.
    Compiled,
    /// As data: a loop over the instructions.
    Interpreted,
}

/// Fields of more instructions than this (values and marks together) are interpreted: lavapipe compiles 240 in 1.2 s, 480 in
/// 2.5 s, 1200 in 9.6 s and 4000 in 69 s, the interpreter in 1.3 s (docs/performance.md).
pub const LONGEST_COMPILED: usize = 600;

/// Makes jobs of scenes, and remembers the text of their shaders: equal structure, equal text.
#[derive(Debug, Default)]
pub struct Shaders {
    form: FieldForm,
    limits: Limits,
    texts: HashMap<Key, Made>,
    /// The environment of the scene before.
    around: Option<Arc<EnvironmentMap>>,
    /// The volume of skylight of the scene before.
    sky: Option<Arc<SkyVolume>>,
    /// The volumes of its lights.
    light: Option<Arc<LightVolume>>,
}

/// A text and what belongs to it.
#[derive(Clone, Debug)]
struct Made {
    source: Arc<str>,
    code: Arc<[u32]>,
    registers: u32,
}

/// Texts that are remembered.
const REMEMBERED: usize = 64;

/// All that a GPU needs for a picture.
#[derive(Clone, Debug)]
pub struct Job {
    /// The shader module, in WGSL. Equal for scenes of equal structure.
    pub source: Arc<str>,
    /// Everything that is one number, for a picture in one band; see [`Job::band`].
    pub frame: Frame,
    /// Parameters of the field.
    pub params: Arc<[f32]>,
    /// Instructions of an interpreted field, else one word.
    pub code: Arc<[u32]>,
    /// Lights, materials, objects.
    pub table: Arc<[[f32; 4]]>,
    /// Images of materials, in the order in which their texels lie in their [`texture`].
    pub images: Arc<[Arc<Image>]>,
    /// Grids of samples of the field, likewise.
    pub grids: Arc<[Arc<Grid>]>,
    /// Words that the registers of an interpreted field take for each thread; 0 where the field is code.
    pub registers: u32,
    /// Whether each dispatch of rays answers one question of each to its field; else it traces them to the end.
    pub in_turns: bool,
    /// How the same is traced in turns.
    pub turns: Turns,
}

/// What a job is made of that traces the rays of another in turns, if one can.
#[derive(Clone, Debug, Default)]
pub struct Turns(Option<Key>);

impl Shaders {
    /// With nothing remembered.
    pub fn new(form: FieldForm) -> Shaders {
        Shaders {
            form,
            ..Shaders::default()
        }
    }

    /// Compiles a scene.
    ///
    /// # Errors
    /// See [`RenderError`].
    pub fn prepare(&mut self, scene: &Scene) -> Result<Job, RenderError> {
        self.around = EnvironmentMap::renewed(self.around.as_ref(), scene);
        let before = Before {
            sky: self.sky.as_ref(),
            light: self.light.as_ref(),
        };
        let around = self.around.as_deref();
        let parts = Parts::new(scene, &self.limits, self.form, around, before)?;
        (self.sky, self.light) = (parts.sky, parts.light);
        let turns = Turns(Some(parts.key.in_turns()));
        let made = self.text(parts.key);
        Ok(Job {
            source: made.source,
            frame: parts.frame,
            params: parts.params.into(),
            code: made.code,
            table: parts.table.into(),
            images: parts.images.into(),
            grids: parts.grids.into(),
            registers: made.registers,
            in_turns: false,
            turns,
        })
    }

    /// The job that traces the same rays in turns: for devices whose loops end early. None where it does that already.
    pub fn in_turns(&mut self, job: &Job) -> Option<Job> {
        let key = job.turns.0.as_ref()?;
        let made = self.text(key.clone());
        Some(Job {
            source: made.source,
            code: made.code,
            registers: made.registers,
            // cones are not marched in turns
            frame: Frame {
                prepass: 0,
                ..job.frame
            },
            in_turns: true,
            turns: Turns::default(),
            ..job.clone()
        })
    }

    fn text(&mut self, key: Key) -> Made {
        if self.texts.len() > REMEMBERED {
            self.texts.clear();
        }
        (self.texts.entry(key))
            .or_insert_with_key(|key| {
                let made = key.source();
                Made {
                    source: made.text.into(),
                    code: made.code.into(),
                    registers: made.registers,
                }
            })
            .clone()
    }
}

/// A scene as a shader sees it.
pub(crate) struct Parts {
    /// What the text depends on.
    pub(crate) key: Key,
    pub(crate) frame: Frame,
    pub(crate) params: Vec<f32>,
    pub(crate) table: Vec<[f32; 4]>,
    pub(crate) images: Vec<Arc<Image>>,
    pub(crate) grids: Vec<Arc<Grid>>,
    pub(crate) sky: Option<Arc<SkyVolume>>,
    pub(crate) light: Option<Arc<LightVolume>>,
}

/// The volumes of the scene before.
#[derive(Clone, Copy, Default)]
pub(crate) struct Before<'a> {
    sky: Option<&'a Arc<SkyVolume>>,
    light: Option<&'a Arc<LightVolume>>,
}

impl Parts {
    pub(crate) fn new(
        scene: &Scene,
        limits: &Limits,
        form: FieldForm,
        around: Option<&EnvironmentMap>,
        before: Before<'_>,
    ) -> Result<Parts, RenderError> {
        let (program, region) = compiled(scene, limits)?;
        let formulas = material::formulas(scene.materials());
        let program = program.with_colours(&formulas, limits)?;
        let mut images = images(scene);
        if let Some(around) = around {
            images.extend([&around.image, &around.table, &around.glossy].map(Arc::clone));
        }
        let sky = SkyVolume::renewed(before.sky, scene, &program)?;
        let light = LightVolume::renewed(before.light, scene, &program)?;
        let mut grids = program.data().grids.clone();
        let sky_grid = grids.len();
        grids.extend(sky.iter().flat_map(|sky| sky.data.grids.iter().cloned()));
        let light_grid = grids.len();
        let lit = light.iter().flat_map(|light| &light.data.grids);
        grids.extend(lit.cloned());
        let voxel = sky.as_ref().map_or(1.0, |sky| sky.extent.voxel);
        let (mut table, mut frame) = tables(
            scene,
            &program,
            &images,
            &grids,
            voxel,
            (light.as_deref(), light_grid),
            frame(scene, &region),
        );
        if let Some(sky) = &sky {
            frame.sky_rows = table.len() as u32;
            push(&mut table, volume_row(&sky.extent, sky_grid));
        }
        if let Some(light) = &light {
            frame.advected_rows = table.len() as u32;
            push(&mut table, volume_row(&light.extent, light_grid));
        }
        if let Some(around) = around {
            frame.around_rows = table.len() as u32;
            push(&mut table, around_row(around, &images));
            // nothing is left to its colours
            (frame.sky_top, frame.sky_horizon, frame.sky_bottom) = Default::default();
        }
        frame.max_steps = program.patient(scene.settings().max_steps);
        frame.quality = u32::from(program.is_fractal())
            | u32::from(program.is_close()) << 1
            | u32::from(has_skins(scene, &program)) << 2;
        Ok(Parts {
            key: Key::new(scene, &program, form, table.len(), light.is_some()),
            frame,
            params: program.params().to_vec(),
            table,
            images,
            grids,
            sky,
            light,
        })
    }
}

impl Job {
    /// Rays a pixel.
    pub fn samples(&self) -> u32 {
        self.frame.samples.max(1)
    }

    /// Rows that a band must store above and below those that it gives.
    pub fn margin(&self) -> u32 {
        if self.frame.samples == 0 {
            0
        } else {
            let kind = self.frame.filter_kind as usize;
            Filter::ALL.get(kind).map_or(0, |f| reach(*f)).min(MARGIN)
        }
    }

    /// Whether cones are marched before rays.
    pub fn prepass(&self) -> bool {
        self.frame.prepass != 0 && !self.frame.has_lens()
    }

    /// The same scene as a camera sees it, in a picture of this size and antialiasing.
    pub fn seen(&self, camera: &Camera, size: [u32; 2], antialias: Antialias) -> Job {
        Job {
            frame: seen(self.frame, camera, size, antialias),
            ..self.clone()
        }
    }

    /// The frame of the band that gives `count` rows from `first` on, with the sums that are asked for one after the other, of rays
    /// a pixel from number `ray` on.
    pub fn band(&self, first: u32, count: u32, sums: &[Sum], ray: u32) -> Frame {
        let from = first.saturating_sub(self.margin());
        let to = (first + count + self.margin()).min(self.frame.size[1]);
        let mut places = [u32::MAX; Sum::ALL.len()];
        let mut at = 0;
        for sum in sums {
            places[*sum as usize] = at;
            at += sum.channels() as u32 * count * self.frame.size[0];
        }
        let mut frame = Frame {
            band: [from, to - from, first, count],
            sums_a: [places[0], places[1], places[2], places[3]],
            sums_b: [places[4], places[5], places[6], places[7]],
            sums_c: [places[8], places[9], places[10], places[11]],
            detail: u32::from(sums.iter().any(|sum| !sum.is_filtered())),
            first_ray: ray,
            ..self.frame
        };
        let [across, down] = frame.cells(CONE_SIDES[0]);
        frame.wide_cones = across * down;
        frame
    }
}

impl Frame {
    /// Cells of this side, across and down, that overlap the rows that the band stores.
    pub fn cells(&self, side: u32) -> [u32; 2] {
        let [first, count, ..] = self.band;
        let down = (first + count).div_ceil(side) - first / side;
        [self.size[0].div_ceil(side), down]
    }

    /// Whether rays begin all over a lens.
    fn has_lens(&self) -> bool {
        self.aperture > 0.0 && self.samples != 0
    }

    /// Cones of both sizes.
    pub fn cones(&self) -> u32 {
        CONE_SIDES
            .iter()
            .map(|&side| self.cells(side))
            .map(|[across, down]| across * down)
            .sum()
    }
}

fn frame(scene: &Scene, region: &Region) -> Frame {
    let settings = scene.settings();
    let sky = scene.sky();
    let air = Air::of(sky, scene.lights());
    let [reflections, refractions] = bounces(settings).unwrap_or_default();
    let (depth, clamp) = match settings.integrator {
        Integrator::Path { depth, clamp } => (depth, clamp),
        Integrator::Whitted { .. } | Integrator::Direct => (0, None),
    };
    let frame = Frame {
        region_min: region.min,
        region_max: region.max,
        hit_selection: u32::from(settings.hit_selection),
        max_steps: settings.max_steps.max(1),
        footprint: settings.footprint,
        march: match settings.march {
            March::Fixed { step } => step,
            March::Sphere => 1.0,
            March::Relaxed { omega } => omega,
            March::Enhanced { share } => share,
            March::Auto { beta } => beta,
        },
        placing: settings.discontinuity_reduction,
        reflections,
        refractions,
        depth,
        clamp: clamp.unwrap_or(UNLIMITED),
        falloff: air.falloff,
        sun: air.sun.array(),
        sun_cosine: air.cosine,
        sun_radiance: air.radiance.array(),
        glow: air.glow,
        fog: air.fog.array(),
        density: air.density,
        seed: settings.seed,
        sky_top: sky.top.to_array(),
        ambient: sky.ambient,
        sky_horizon: sky.horizon.to_array(),
        sky_bottom: sky.bottom.to_array(),
        prepass: u32::from(settings.prepass),
        miss: f32::INFINITY,
        ..Frame::default()
    };
    seen(frame, scene.camera(), settings.size, settings.antialias)
}

/// How often rays are reflected, and how often they pass or meet from inside the surface of a clear body; none where they are not.
pub(crate) fn bounces(settings: &Settings) -> Option<[u32; 2]> {
    match (settings.shading, settings.integrator) {
        (
            Shading::Physical,
            Integrator::Whitted {
                reflections,
                refractions,
            },
        ) => Some([reflections, refractions]),
        (_, Integrator::Whitted { .. } | Integrator::Path { .. } | Integrator::Direct) => None,
    }
}

/// A frame as a camera sees it.
fn seen(frame: Frame, camera: &Camera, size: [u32; 2], antialias: Antialias) -> Frame {
    let view = View::new(camera, size, frame.footprint);
    let (samples, filter) = match antialias {
        Antialias::None | Antialias::Coverage { .. } => (0, Filter::Box),
        Antialias::Supersample { samples, filter } => (samples.max(1), filter),
    };
    Frame {
        eye: view.eye,
        pinhole: u32::from(view.pinhole),
        right: view.right,
        scale: view.scale,
        up: view.up,
        near: view.near,
        back: view.back,
        far: view.far,
        pixel: [view.pixel.slope, view.pixel.constant],
        threshold: [view.threshold.slope, view.threshold.constant],
        rounding: [view.rounding.slope, view.rounding.constant],
        size,
        half: view.half,
        aperture: view.aperture,
        focus: view.focus,
        layers: match antialias {
            Antialias::Coverage { layers } => layers.min(LAYERS),
            Antialias::None | Antialias::Supersample { .. } => 0,
        },
        samples,
        filter_kind: number(&filter),
        ..frame
    }
}

/// The images that materials show, each once.
fn images(scene: &Scene) -> Vec<Arc<Image>> {
    let mut seen = HashSet::new();
    let patterns = scene
        .materials()
        .iter()
        .flat_map(material::Material::patterns);
    let parts = patterns.flat_map(|(_, pattern)| pattern.parts());
    let shown = parts.filter_map(|part| match part {
        Pattern::Triplanar { image, .. } => Some(image),
        _ => None,
    });
    shown
        .filter(|image| seen.insert(Arc::as_ptr(image)))
        .cloned()
        .collect()
}

/// The table, and the frame that knows where in it everything is.
fn tables(
    scene: &Scene,
    program: &Program,
    images: &[Arc<Image>],
    grids: &[Arc<Grid>],
    voxel: f32,
    (advected, first): (Option<&LightVolume>, usize),
    mut frame: Frame,
) -> (Vec<[f32; 4]>, Frame) {
    let mut table = Vec::new();
    frame.lights = scene.lights().len() as u32;
    frame.light_rows = 0;
    for (number, light) in scene.lights().iter().enumerate() {
        let mut row = light_row(light);
        if let Some(Some(reading)) = advected.and_then(|volume| volume.readings.get(number)) {
            row.sharpness = reading.before;
            row.grid = (first + reading.grid) as f32;
        }
        push(&mut table, row);
    }
    frame.object_rows = table.len() as u32;
    frame.objects = scene.objects().len() as u32;
    for object in scene.objects() {
        push(
            &mut table,
            occluder(
                object.occlusion.unwrap_or(scene.settings().occlusion),
                voxel,
            ),
        );
    }
    push(&mut table, occluder(scene.settings().occlusion, voxel));
    let places: HashMap<*const Image, u64> = (images.iter().map(Arc::as_ptr))
        .zip(texture::starts(images))
        .collect();
    let is_path = matches!(scene.settings().integrator, Integrator::Path { .. });
    let formulas = material::formulas(scene.materials());
    let clear = is_path || bounces(scene.settings()).is_some();
    let mut coats = Coat::all(scene, program);
    coats.push(Coat::new(&material::Material::default(), 0));
    // a material that lies in several spaces has its textures once
    let mut known: HashMap<u16, [f32; 4]> = HashMap::new();
    let count = scene.materials().len();
    let rows: Vec<Material> = (coats.iter().enumerate())
        .map(|(number, coat)| {
            let placed = number
                .checked_sub(count)
                .and_then(|k| program.coats().get(k));
            let material = placed.map_or(number as u16, |coat| coat.material);
            let textures = *known.entry(material).or_insert_with(|| {
                coat.textures()
                    .map(|texture| push_texture(&mut table, texture, &places, &formulas))
            });
            material_row(
                coat,
                place_number(&program.structure().coats, coat.place),
                textures,
                clear,
            )
        })
        .collect();
    frame.material_rows = table.len() as u32;
    frame.materials = coats.len() as u32 - 1;
    for row in rows {
        push(&mut table, row);
    }
    frame.grid_rows = table.len() as u32;
    for (grid, start) in grids.iter().zip(texture::starts(grids)) {
        push(&mut table, grid_row(grid, start));
    }
    (table, frame)
}

fn push<T: bytemuck::Pod>(table: &mut Vec<[f32; 4]>, row: T) {
    table.extend_from_slice(bytemuck::cast_slice(std::slice::from_ref(&row)));
}

/// `start`: the first texel of its samples.
pub(crate) fn grid_row(grid: &Grid, start: u64) -> layout::Grid {
    let [nodes_x, nodes_y, _] = grid.nodes().map(|n| n as f32);
    let [row, column] = texture::place(start);
    layout::Grid {
        nodes_x,
        nodes_y,
        row,
        column,
    }
}

/// `grid`: the number of its first grid.
fn volume_row(extent: &Extent, grid: usize) -> layout::SkyVolume {
    layout::SkyVolume {
        origin: extent.origin,
        voxel: extent.voxel,
        cells: extent.cells.map(|n| n as f32),
        grid: grid as f32,
    }
}

fn light_row(light: &zeroset_scene::light::Light) -> Light {
    if let Some(lamp) = Lamp::of(light) {
        return lamp_row(light, &lamp);
    }
    let (kind, place) = match light.source {
        LightSource::Directional { direction } => (0.0, -direction),
        LightSource::Point { position }
        | LightSource::Rectangle { position, .. }
        | LightSource::Disc { position, .. }
        | LightSource::Sphere { position, .. } => (1.0, position),
    };
    let sharpness = match light.shadow {
        Shadow::None | Shadow::Hard | Shadow::Advected { .. } => 0.0,
        Shadow::Soft { sharpness } | Shadow::SoftClosest { sharpness } => sharpness,
    };
    let c = light.radiance;
    Light {
        place: place.to_array(),
        kind,
        radiance: c.to_array(),
        luminance: luminance(c.to_array()),
        shadow: number(&light.shadow) as f32,
        sharpness,
        ..Light::default()
    }
}

/// A light with an extent. Its shadow is sampled, advected, or none.
fn lamp_row(light: &zeroset_scene::light::Light, lamp: &Lamp<f32>) -> Light {
    let kind = match lamp.shape {
        Shape::Rectangle => LAMPS[0],
        Shape::Disc => LAMPS[1],
        Shape::Sphere => LAMPS[2],
    };
    let shadow = match light.shadow {
        shadow @ (Shadow::None | Shadow::Advected { .. }) => shadow,
        Shadow::Hard | Shadow::Soft { .. } | Shadow::SoftClosest { .. } => Shadow::Hard,
    };
    Light {
        place: lamp.place.array(),
        kind,
        radiance: lamp.strength.array(),
        luminance: luminance(lamp.strength.array()),
        shadow: number(&shadow) as f32,
        area: lamp.area,
        visible: if lamp.visible { 1.0 } else { 0.0 },
        right: lamp.right.array(),
        radius: lamp.radius,
        up: lamp.up.array(),
        ..Light::default()
    }
}

/// `images`: all that are in the texture, those of the environment last.
fn around_row(around: &EnvironmentMap, images: &[Arc<Image>]) -> Around {
    let starts: Vec<u64> = texture::starts(images).collect();
    let place = |back: usize| texture::place(starts[images.len() - back]);
    let [image, table, glossy] = [3, 2, 1].map(place);
    let [columns, rows] = around.cells().map(|n| n as f32);
    let [h0, h1, h2, h3, h4, h5, h6, h7, h8] = around.harmonics.map(|h| h.array());
    Around {
        image_row: image[0],
        image_column: image[1],
        width: around.image.width as f32,
        height: around.image.height as f32,
        table_row: table[0],
        table_column: table[1],
        columns,
        rows,
        glossy_row: glossy[0],
        glossy_column: glossy[1],
        strength: around.strength,
        cosine: around.turn[0],
        sine: around.turn[1],
        h0,
        h1,
        h2,
        h3,
        h4,
        h5,
        h6,
        h7,
        h8,
        ..Around::default()
    }
}

/// The kinds of lights with an extent: rectangles, discs, spheres, and what is all around.
pub(crate) const LAMPS: [f32; 4] = [2.0, 3.0, 4.0, 5.0];

/// The reach of occlusion that has none. Shaders have no infinity.
const UNLIMITED: f32 = 3.0e38;

/// `voxel`: of the volume that skylight is read from.
fn occluder(method: Occlusion, voxel: f32) -> Occluder {
    let kind = number(&method) as f32;
    let of = |count: u32, reach: f32, scale: f32, bend: f32| Occluder {
        kind,
        count: count as f32,
        reach,
        scale,
        bend,
        ..Occluder::default()
    };
    let far = |reach: Option<f32>| reach.unwrap_or(UNLIMITED);
    match method {
        Occlusion::None => of(0, 0.0, 0.0, 0.0),
        Occlusion::Quilez { steps, step, scale } => of(steps, step, scale, 0.0),
        Occlusion::Bent {
            steps,
            step,
            scale,
            bend,
        } => of(steps, step, scale, bend),
        Occlusion::Evans { scale, step, bend } => of(4, step, scale, bend),
        Occlusion::Skylight {
            step,
            strength,
            bend,
            bleed,
            ..
        } => {
            let reading = Reading::new(voxel, step, strength, bend, bleed);
            Occluder {
                bleed: reading.bleed,
                ..of(0, reading.first, reading.scale, reading.bend)
            }
        }
        Occlusion::Curvature { blur, strength, .. } => {
            let level = blur.min(LEVELS as u32 - 1);
            let per = per_voxel(strength, voxel, level as usize);
            of(level, 0.0, per, 0.0)
        }
        Occlusion::Upward { scale } => of(0, 0.0, scale, 0.0),
        Occlusion::Cones { reach, steps } => of(steps, far(reach), 0.0, 0.0),
        Occlusion::Hemisphere { rays, reach } => of(rays, far(reach), 0.0, 0.0),
        Occlusion::Obscurance { rays, reach, tau } => of(rays, far(reach), tau, 0.0),
    }
}

/// `place`: see [`place_number`]. `textures`: their first rows. `clear`: whether rays go through clear bodies; else these are shown as if
/// they were none.
fn material_row(coat: &Coat, place: u32, textures: [f32; 4], clear: bool) -> Material {
    let material = &coat.material;
    let [
        albedo_texture,
        roughness_texture,
        metallic_texture,
        bump_texture,
    ] = textures;
    let [.., bump] = coat.textures();
    Material {
        albedo: match &material.pattern {
            Pattern::Solid { colour } => colour.to_array(),
            _ => [0.0; 3],
        },
        place: place as f32,
        emission: material.emission.to_array(),
        specular: material.specular,
        attenuation: material.attenuation.to_array(),
        shininess: material.shininess,
        metallic: material.metallic,
        roughness: material.roughness,
        transmission: if clear { material.transmission } else { 0.0 },
        ior: material.ior,
        albedo_texture,
        roughness_texture,
        metallic_texture,
        bump_texture,
        depth: material.bump.as_ref().map_or(0.0, |bump| bump.depth),
        finest: bump.map_or(0.0, |texture| texture.finest().min(f32::MAX)),
        ..Material::default()
    }
}

/// Appends a texture. Its first row, or 0 where it is none or one colour.
fn push_texture(
    table: &mut Vec<[f32; 4]>,
    texture: Option<&Texture>,
    images: &HashMap<*const Image, u64>,
    formulas: &[Arc<ColourFormula>],
) -> f32 {
    let Some(texture) = texture.filter(|t| !t.is_solid()) else {
        return 0.0;
    };
    // row 0 is that of none
    if table.is_empty() {
        table.push([0.0; 4]);
    }
    let first = table.len();
    let parts = texture.parts();
    for (number, part) in parts.iter().enumerate() {
        push(
            table,
            part_row(part, parts.len() - number, images, formulas),
        );
    }
    first as f32
}

/// `count`: of the parts from this one on.
fn part_row(
    part: &Part,
    count: usize,
    images: &HashMap<*const Image, u64>,
    formulas: &[Arc<ColourFormula>],
) -> TexturePart {
    let inks = part.inks.map(|ink| match ink {
        PartInk::Colour(colour) => (colour.to_array(), 0.0),
        PartInk::Part(number) => ([0.0; 3], number as f32),
    });
    let [a, b, c, d] = inks.map(|(colour, _)| colour);
    let [instead_a, instead_b, instead_c, instead_d] = inks.map(|(_, part)| part);
    let mut row = TexturePart {
        a,
        instead_a,
        b,
        instead_b,
        c,
        instead_c,
        d,
        instead_d,
        kind: pattern_kind(&part.pattern) as f32,
        count: count as f32,
        still: if part.frame.is_none() { 1.0 } else { 0.0 },
        ..TexturePart::default()
    };
    if let Some(frame) = &part.frame {
        [row.x, row.y, row.z] = frame.rows.map(|row| row.to_array());
        [row.offset_x, row.offset_y, row.offset_z] = frame.offset.to_array();
    }
    match &part.pattern {
        Pattern::Checker { size, .. } => row.size = *size,
        Pattern::Stripes {
            direction, size, ..
        } => (row.start, row.size) = (direction.to_array(), *size),
        Pattern::Noise { size, octaves, .. } => {
            (row.size, row.detail) = (*size, *octaves as f32);
        }
        Pattern::Gradient { from, to, .. } => {
            (row.start, row.end) = (from.to_array(), to.to_array());
        }
        Pattern::Triplanar {
            image,
            size,
            sharpness,
        } => {
            let start = images.get(&Arc::as_ptr(image)).copied().unwrap_or(0);
            [row.image_row, row.image_column] = texture::place(start);
            (row.size, row.detail) = (*size, *sharpness);
            (row.width, row.height) = (image.width as f32, image.height as f32);
        }
        Pattern::Formula { formula } => {
            let number = formulas.iter().position(|f| Arc::ptr_eq(f, formula));
            row.size = number.unwrap_or_default() as f32;
        }
        Pattern::Solid { .. } | Pattern::Orbit { .. } | Pattern::Placed { .. } => {}
    }
    row
}
