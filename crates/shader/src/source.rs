//! The text of a shader module: the recorded field, the recorded formulas and the stages that a scene needs.

use crate::constants;
use crate::entry::{Binding, UNIFORM_NUMBERS, UNIFORM_ROWS};
use crate::field::FieldSource;
use crate::formulas;
use crate::job::{FieldForm, LONGEST_COMPILED, bounces};
use crate::layout::{
    Around, Frame, Grid, Light, LightSum, Material, Occluder, Sample, Shared, SkyVolume,
    SurfaceSum, TexturePart, Tile, loader, rows,
};
use crate::texture;
use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;
use zeroset_catalogue::op::code;
use zeroset_catalogue::tape::Operation;
use zeroset_field::program::{Program, Structure};
use zeroset_scene::material::Pattern;
use zeroset_scene::methods::Choice;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{
    Antialias, Filter, Integrator, March, Normals, Occlusion, Settings, Shading, Shadow,
};
use zeroset_shade::coverage::LAYERS;

/// The text of a module, and what the module must find.
pub(crate) struct Text {
    pub(crate) text: String,
    /// The instructions of a field that is data.
    pub(crate) code: Vec<u32>,
    /// Words that its registers take for each thread.
    pub(crate) registers: u32,
}

/// What the text depends on.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Key {
    structure: Arc<Structure>,
    interpreted: bool,
    /// Whether the field's value may be less than the distance.
    steep: bool,
    /// Whether rays are traced in turns.
    in_turns: bool,
    /// Whether the parameters fit their uniform buffer.
    uniform_params: bool,
    /// Whether the table fits its uniform buffer.
    uniform_table: bool,
    march: &'static [Stage],
    normals: &'static [Stage],
    shading: Shading,
    /// Rays that may wait to be followed: as many as go on one after the other, and one more.
    waiting: u32,
    ways: &'static [Stage],
    /// How pixels are parted.
    parts: Stage,
    occlusion: BTreeSet<Case>,
    /// Whether any light casts a shadow.
    shadows: bool,
    /// Whether any of them is read from a volume.
    advected: bool,
    /// Whether any light has an extent, or comes from all around.
    lamps: bool,
    /// Whether light comes from all around, by an image.
    around: bool,
    patterns: BTreeSet<Case>,
    /// Most parts of a texture.
    texture_parts: u32,
    /// How often a place is looked at: for its colour, or also for its finish, or also for its heights and those beside it.
    looks: u32,
}

/// Textures of a colour, of roughness, and of how metallic something is.
const LOOKS: u32 = 3;
/// Those, and heights at three places.
const LOOKS_WITH_BUMPS: u32 = 6;

/// A part of the text that a method needs. Equal names, equal texts.
#[derive(Clone, Copy, Debug)]
struct Stage {
    name: &'static str,
    text: &'static str,
    /// The formulas that it needs, beside those of every picture.
    formulas: &'static [&'static str],
}

impl PartialEq for Stage {
    fn eq(&self, other: &Stage) -> bool {
        self.name == other.name
    }
}

impl Eq for Stage {}

impl std::hash::Hash for Stage {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

/// A stage from the file that has its name.
macro_rules! stage {
    ($name:literal $(, $formula:literal)*) => {
        Stage {
            name: $name,
            text: include_str!(concat!("stage/", $name, ".wgsl")),
            formulas: &[$($formula),*],
        }
    };
}

/// A method that a scene may mix with others: a shader tells them apart by a number. Equal numbers, equal methods.
#[derive(Clone, Copy, Debug)]
struct Case {
    kind: u32,
    /// Its stage, where it is more than a formula.
    stage: Option<Stage>,
    call: &'static str,
    /// The formulas that it needs.
    formulas: &'static [&'static str],
    /// Whether it sends rays over hemispheres.
    secondary: bool,
    /// Whether it reads an image.
    has_image: bool,
}

impl PartialEq for Case {
    fn eq(&self, other: &Case) -> bool {
        self.kind == other.kind
    }
}

impl Eq for Case {}

impl PartialOrd for Case {
    fn partial_cmp(&self, other: &Case) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Case {
    fn cmp(&self, other: &Case) -> Ordering {
        self.kind.cmp(&other.kind)
    }
}

impl std::hash::Hash for Case {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.kind.hash(state);
    }
}

impl Key {
    /// `rows`: those of the table. `advected`: whether shadows are read from a volume.
    pub(crate) fn new(
        scene: &Scene,
        program: &Program,
        form: FieldForm,
        rows: usize,
        advected: bool,
    ) -> Key {
        let structure = program.shared_structure();
        let methods = (scene.objects().iter())
            .filter_map(|o| o.occlusion.as_ref())
            .chain([&scene.settings().occlusion]);
        let mut key = Key {
            interpreted: form == FieldForm::Interpreted,
            steep: program.is_steep(),
            in_turns: false,
            uniform_params: program.params().len() <= UNIFORM_NUMBERS,
            uniform_table: rows <= UNIFORM_ROWS,
            structure,
            march: marcher(&scene.settings().march),
            normals: normals(scene.settings().normals),
            shading: scene.settings().shading,
            waiting: bounces(scene.settings()).map_or(1, |[a, b]| a + b + 1)
                + match scene.settings().antialias {
                    Antialias::Coverage { .. } => LAYERS,
                    Antialias::None | Antialias::Supersample { .. } => 0,
                },
            parts: match scene.settings().antialias {
                Antialias::Coverage { .. } => stage!("coverage"),
                Antialias::None | Antialias::Supersample { .. } => stage!("coverage_none"),
            },
            ways: ways(scene.settings()),
            occlusion: methods.filter_map(occlusion).collect(),
            shadows: scene.environment().is_some()
                || scene.lights().iter().any(|l| casts(&l.shadow)),
            advected,
            lamps: scene.lights().iter().any(|l| l.source.is_lamp())
                || scene.environment().is_some(),
            around: scene.environment().is_some(),
            patterns: BTreeSet::new(),
            texture_parts: 0,
            looks: 0,
        };
        for material in scene.materials() {
            for (name, whole) in material.patterns() {
                key.patterns.extend(whole.parts().filter_map(pattern));
                let parts = whole
                    .parts()
                    .filter(|p| !matches!(p, Pattern::Placed { .. }));
                key.texture_parts = key.texture_parts.max(parts.count() as u32);
                let looks = match name {
                    "pattern" => 1,
                    "bump" => LOOKS_WITH_BUMPS,
                    _ => LOOKS,
                };
                key.looks = key.looks.max(looks);
            }
        }
        if form == FieldForm::Auto {
            key.interpreted = key.length() > LONGEST_COMPILED;
        }
        key
    }

    /// Instructions for values and marks together.
    pub(crate) fn length(&self) -> usize {
        self.structure.values.instructions.len() + self.structure.marks.instructions.len()
    }

    /// Whether a material shows an image.
    pub(crate) fn shows_images(&self) -> bool {
        self.around || self.patterns.iter().any(|case| case.has_image)
    }

    /// Whether the field, the sky or a light has grids of samples.
    pub(crate) fn reads_grids(&self) -> bool {
        let structure = &self.structure;
        let mut steps = { &structure.colours }
            .iter()
            .chain([&structure.values])
            .flat_map(|code| &code.instructions);
        let skylight = self.occlusion.iter().filter_map(|case| case.stage);
        self.advected
            || { skylight }.any(|stage| matches!(stage.name, "ao_skylight" | "ao_curvature"))
            || steps.any(|step| step.operation == Operation::Leaf(code::SAMPLED))
    }

    /// The same, but that rays are traced in turns.
    pub(crate) fn in_turns(&self) -> Key {
        Key {
            in_turns: true,
            ..self.clone()
        }
    }

    /// The text of the module that a GPU renders with, and the instructions of a field that is data.
    pub(crate) fn source(&self) -> Text {
        let mut text = String::new();
        for declaration in [
            Frame::declaration(),
            Tile::declaration(),
            LightSum::declaration(),
            SurfaceSum::declaration(),
        ] {
            text += &declaration;
        }
        for binding in Binding::ALL {
            text += &binding.declaration(self.in_turns);
        }
        text += "/// Copies, which stay in registers.\nvar<private> frame: Frame;\nvar<private> tile: Tile;\n";
        let Text {
            text: mut common,
            code,
            registers,
        } = self.picture();
        if self.uniform_params {
            common = calls(&common, "params[", "param_at(") + PARAM;
        }
        if self.uniform_table {
            common = calls(&common, "table[", "table_at(") + ROW;
        }
        text += &common;
        if self.shows_images() {
            text += texture::IMAGE_TEXEL;
        }
        if self.reads_grids() {
            text += texture::GRID_TEXEL;
        }
        let stages: &[&str] = if self.in_turns {
            &[include_str!("stage/turns.wgsl")]
        } else {
            &[
                include_str!("stage/cone.wgsl"),
                include_str!("stage/cone_main.wgsl"),
                include_str!("stage/trace_main.wgsl"),
            ]
        };
        let both = [
            include_str!("stage/count_main.wgsl"),
            include_str!("stage/film.wgsl"),
        ];
        for stage in stages.iter().chain(&both) {
            text.push('\n');
            text += stage;
        }
        Text {
            text,
            code,
            registers,
        }
    }

    /// What turns a ray into a sample: everything but buffers, textures and entry points. It uses `frame`, `params`, `table`,
    /// `image_texel` where it shows images, `grid_texel` where it reads grids and, for a field that is data, `code`.
    pub(crate) fn picture(&self) -> Text {
        let mut field = if self.interpreted {
            if self.in_turns {
                FieldSource::in_memory(&self.structure)
            } else {
                FieldSource::interpreted(&self.structure)
            }
        } else {
            FieldSource::compiled(&self.structure)
        };
        if self.in_turns {
            field = asked(field);
        }
        let mut text = String::new();
        for declaration in [
            Light::declaration(),
            Occluder::declaration(),
            Around::declaration(),
            SkyVolume::declaration(),
            Material::declaration(),
            TexturePart::declaration(),
            Sample::declaration(),
        ] {
            text += &declaration;
        }
        for (name, rows) in [
            ("LIGHT", rows::<Light>()),
            ("OCCLUDER", rows::<Occluder>()),
            ("MATERIAL", rows::<Material>()),
            ("TEXTUREPART", rows::<TexturePart>()),
            ("AROUND", rows::<Around>()),
        ] {
            // writing to a string cannot fail
            let _ = writeln!(text, "const {name}_ROWS: u32 = {rows}u;");
        }
        text += &texture::side();
        text += &loader::<Light>();
        text += &loader::<Occluder>();
        text += &loader::<Material>();
        text += &loader::<TexturePart>();
        text += &loader::<Around>();
        text += &loader::<SkyVolume>();
        if self.reads_grids() {
            text += &grids();
        }
        text += &constants::declarations();
        text += MARCH_SIDE;
        text += &self.sided(&field.text);
        for name in self.formulas() {
            text.push('\n');
            text += formulas::text(name);
        }
        for stage in self.stages() {
            text.push('\n');
            text += stage;
        }
        // writing to a string cannot fail
        let _ = writeln!(text, "const WAITING: u32 = {}u;", self.waiting);
        text += finish(self.shading);
        text += &physical(self.shading);
        if !self.in_turns {
            text += NEVER;
        }
        text += &self.textures();
        text += &self.occlusion();
        if self.secondary() {
            text += &penumbrae();
        }
        text += &filters();
        Text {
            text,
            code: field.code,
            registers: field.registers,
        }
    }

    /// The text of a field whose parameters that tell sides are those of the ray.
    fn sided(&self, field: &str) -> String {
        let sides = &self.structure.sides;
        if sides.is_empty() {
            return field.to_owned();
        }
        let tests: Vec<String> = sides.iter().map(|side| format!("i == {side}u")).collect();
        calls(field, "params[", "sided_param(")
            + &format!(
                "\nfn sided_param(i: u32) -> f32 {{\n    return select(params[i], march_side, {});\n}}\n",
                tests.join(" || ")
            )
    }

    /// The stages that the methods of this scene need.
    fn stages(&self) -> Vec<&'static str> {
        let mut stages = vec![
            include_str!("stage/count.wgsl"),
            include_str!("stage/camera.wgsl"),
            include_str!("stage/bracket.wgsl"),
            include_str!("stage/sampling.wgsl"),
            include_str!("stage/surface.wgsl"),
            include_str!("stage/material.wgsl"),
            include_str!("stage/ao.wgsl"),
            include_str!("stage/air.wgsl"),
            include_str!("stage/shade.wgsl"),
            include_str!("stage/trace.wgsl"),
        ];
        stages.push(self.parts.text);
        let chosen = self.march.iter().chain(self.normals).chain(self.ways);
        stages.extend(chosen.map(|stage| stage.text));
        stages.push(if self.steep {
            include_str!("stage/distance_steep.wgsl")
        } else {
            include_str!("stage/distance.wgsl")
        });
        if self.secondary() {
            stages.push(include_str!("stage/secondary.wgsl"));
        }
        stages.push(if self.shadows {
            include_str!("stage/shadow.wgsl")
        } else {
            include_str!("stage/shadow_none.wgsl")
        });
        if self.shadows {
            stages.push(if self.advected {
                include_str!("stage/shadow_advected.wgsl")
            } else {
                include_str!("stage/shadow_cast.wgsl")
            });
        }
        stages.push(if self.lamps {
            include_str!("stage/lamps.wgsl")
        } else {
            include_str!("stage/lamps_none.wgsl")
        });
        stages.push(if self.around {
            include_str!("stage/environment.wgsl")
        } else {
            include_str!("stage/environment_none.wgsl")
        });
        let cases = self.occlusion.iter().chain(&self.patterns);
        stages.extend(cases.filter_map(|case| Some(case.stage?.text)));
        stages
    }

    /// Whether rays go to lights or over hemispheres.
    fn secondary(&self) -> bool {
        // paths name the shadows, even where there are none
        let paths = self.ways.iter().any(|stage| stage.name == "ways_path");
        paths || self.shadows || self.occlusion.iter().any(|case| case.secondary)
    }

    /// The formulas that those stages call.
    fn formulas(&self) -> BTreeSet<&'static str> {
        let mut names = BTreeSet::from(EVERYWHERE);
        names.extend(match self.shading {
            Shading::Physical => ["light_response@Physical", "surface_colour@Physical"],
            Shading::Phong => ["light_response@Phong", "surface_colour@Phong"],
            Shading::Lambert => ["light_response@Lambert", "surface_colour@Lambert"],
            // the surface answers alike
            Shading::LambertLegacy => ["light_response@LambertLegacy", "surface_colour@Lambert"],
        });
        if self.secondary() {
            names.extend(BEAMS);
        }
        if self.advected {
            names.insert("advected_entry");
        }
        if self.lamps {
            names.extend(LAMPS);
        }
        if self.around {
            names.extend(AROUND);
            names.insert(match self.shading {
                Shading::Physical => "surface_around@Physical",
                Shading::Phong | Shading::Lambert | Shading::LambertLegacy => {
                    "surface_around@Matte"
                }
            });
        }
        let stages = self.march.iter().chain(self.normals).chain(self.ways);
        names.extend(stages.flat_map(|stage| stage.formulas));
        let cases = self.occlusion.iter().chain(&self.patterns);
        names.extend(cases.flat_map(|case| case.formulas));
        if self.has_textures() {
            names.extend(TEXTURES);
        }
        names
    }

    /// Whether any material has a texture.
    fn has_textures(&self) -> bool {
        !self.patterns.is_empty() || self.looks > 1
    }

    /// What finds how materials look somewhere.
    fn textures(&self) -> String {
        let mut text = if self.structure.coats.is_empty() {
            include_str!("stage/space_world.wgsl").to_owned()
        } else {
            include_str!("stage/space.wgsl").to_owned()
        };
        if !self.has_textures() {
            return text + include_str!("stage/texture_none.wgsl");
        }
        let has = |name: &str| {
            let own = self.patterns.iter().filter_map(|case| case.stage);
            { own }.any(|stage| stage.name == name)
        };
        text += &switch(
            "fn pattern_shares(part: TexturePart, at: Place) -> vec4f",
            "part.kind",
            (self.patterns.iter())
                .filter(|case| !case.call.is_empty())
                .map(|case| (case.kind, case.call)),
            "vec4f(1.0, 0.0, 0.0, 0.0)",
        );
        if !has("pattern_triplanar") {
            text += include_str!("stage/pattern_no_image.wgsl");
        }
        if !has("pattern_formula") {
            text += include_str!("stage/pattern_no_formula.wgsl");
        }
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "const TEXTURE_PARTS: u32 = {}u;\nconst LOOKS: u32 = {}u;",
            self.texture_parts, self.looks
        );
        text + include_str!("stage/texture.wgsl")
    }

    /// The function that tells occlusion methods apart.
    fn occlusion(&self) -> String {
        switch(
            "fn occlusion(at: Surface, how: Occluder, key: vec2u) -> AmbientVisibility",
            "how.kind",
            self.occlusion.iter().map(|case| (case.kind, case.call)),
            "AmbientVisibility(1.0, at.normal, vec3f(1.0))",
        )
    }
}

/// What a field with grids calls: it reads `table`, `frame` and `grid_texel`.
pub(crate) fn grids() -> String {
    let rows = rows::<Grid>();
    format!(
        "{}const GRID_ROWS: u32 = {rows}u;\n{}\n{}",
        Grid::declaration(),
        loader::<Grid>(),
        include_str!("stage/grid.wgsl")
    )
}

/// The field under the names by which rays in turns ask it.
fn asked(mut field: FieldSource) -> FieldSource {
    for name in ["field(", "field_gradient(", "field_marks("] {
        let declared = format!("fn {name}p: vec3f)");
        field.text = (field.text).replacen(&declared, &format!("fn asked_{name}p: vec3f)"), 1);
    }
    field.text += &format!("const REGISTERS: u32 = {}u;\n", field.registers);
    field
}

/// The text with reads of an array as calls of a function.
fn calls(text: &str, read: &str, call: &str) -> String {
    let mut parts = text.split(read);
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        // indices hold no brackets: they are sums of names and literals
        let (index, rest) = part.split_once(']').unwrap_or((part, ""));
        out += &format!("{call}{index}){rest}");
    }
    out
}

/// A parameter, from the uniform buffer.
const PARAM: &str = "
fn param_at(i: u32) -> f32 {
    return numbers[i >> 2u][i & 3u];
}
";

/// What parameters are that tell sides, see `Structure::sides`.
const MARCH_SIDE: &str = "
/// 1 for rays outside all bodies, below 0 inside clear ones.
var<private> march_side: f32 = 1.0;
";

/// Rays that are not traced in turns are traced to their end.
const NEVER: &str = "
fn gives_up() -> bool {
    return false;
}
";

/// How smooth a surface is for a light model.
fn finish(shading: Shading) -> &'static str {
    match shading {
        Shading::Phong => {
            "fn light_finish(what: LocalMaterial) -> f32 {\n    return what.shininess;\n}\n"
        }
        Shading::Physical | Shading::Lambert | Shading::LambertLegacy => {
            "fn light_finish(what: LocalMaterial) -> f32 {\n    return what.finish.z;\n}\n"
        }
    }
}

/// Whether surfaces are small mirrors over a body.
fn physical(shading: Shading) -> String {
    let is = matches!(shading, Shading::Physical);
    format!("fn is_physical() -> bool {{\n    return {is};\n}}\n")
}

/// A row of the table, from the uniform buffer.
const ROW: &str = "
fn table_at(i: u32) -> vec4f {
    return rows[i];
}
";

/// A function that returns `otherwise` but for some numbers: for each of these what it calls.
fn switch<'a>(
    signature: &str,
    kind: &str,
    cases: impl Iterator<Item = (u32, &'a str)>,
    otherwise: &str,
) -> String {
    let case = |(kind, call)| {
        format!("        case {kind}u: {{\n            return {call};\n        }}\n")
    };
    let cases: String = cases.map(case).collect();
    if cases.is_empty() {
        return format!("\n{signature} {{\n    return {otherwise};\n}}\n");
    }
    format!(
        "\n{signature} {{\n    switch (u32({kind})) {{\n{cases}        default: {{\n            return {otherwise};\n        }}\n    }}\n}}\n"
    )
}

/// Formulas of textures.
const TEXTURES: [&str; 4] = [
    "texture_number",
    "bumped_normal",
    "basis_across",
    "basis_along",
];

/// Formulas that every picture needs.
const EVERYWHERE: [&str; 27] = [
    "false_position",
    "on_plane",
    "pinhole_ray",
    "across_plane",
    "cone_slope",
    "enter_box",
    "leave_box",
    "on_disc",
    "view_narrowness",
    "width_of_pixel",
    "radius_of_footprint",
    "behind_surface",
    "smoothed_slope",
    "slope_step",
    "filter_box",
    "filter_tent",
    "filter_mitchell",
    "pixel_stretch",
    "mapped_normal",
    "tame_row",
    "mapped_scale",
    "sky_colour",
    "towards_point",
    "transmittance",
    "fog_share",
    "fog_light",
    "sun_disc",
];

/// Those of `stage/environment.wgsl`.
const AROUND: [&str; 5] = [
    "place_of_direction",
    "direction_of_place",
    "turned_around",
    "density_of_direction",
    "arriving_around",
];

/// Those of `stage/lamps.wgsl`.
const LAMPS: [&str; 9] = [
    "towards_sheet",
    "sheet_falloff",
    "towards_sphere",
    "seen_sphere",
    "meet_sheet",
    "meet_sphere",
    "lamp_density",
    "balance",
    "scatter_density",
];

/// Those of `stage/secondary.wgsl`.
const BEAMS: [&str; 5] = [
    "slope_between",
    "secondary_step",
    "skin_touch",
    "soft_shadow",
    "closest_shadow",
];

/// The function that tells penumbrae apart, and the numbers of all shadows: they are the same in every scene, so that another
/// shadow needs no other shader.
fn penumbrae() -> String {
    let mut text = String::from("\n");
    for (shadow, method) in Shadow::ALL.iter().zip(Shadow::METHODS) {
        let (name, kind) = (method.name.to_uppercase(), number(shadow));
        // writing to a string cannot fail
        let _ = writeln!(text, "const SHADOW_{name}: u32 = {kind}u;");
    }
    let cases = Shadow::ALL
        .iter()
        .filter_map(|s| Some((number(s), penumbra(s)?)));
    text += &switch(
        "fn penumbra(f: f32, z: f32, r: f32, t: f32, kind: u32, sharpness: f32) -> f32",
        "kind",
        cases,
        "1.0",
    );
    text
}

/// The functions that tell filters apart: these too are the same in every scene.
fn filters() -> String {
    let weights = Filter::ALL.iter().map(|f| (number(f), filter(*f)));
    let reaches: Vec<(u32, String)> = (Filter::ALL.iter())
        .map(|f| (number(f), reach(*f).to_string()))
        .collect();
    let reaches = reaches.iter().map(|(kind, reach)| (*kind, reach.as_str()));
    let kind = "frame.filter_kind";
    switch("fn filter_weight(x: f32) -> f32", kind, weights, "0.0")
        + &switch("fn filter_reach() -> i32", kind, reaches, "0")
}

/// The number by which a shader knows a method: its place among those of its kind.
pub(crate) fn number<T: Choice>(method: &T) -> u32 {
    method.place() as u32
}

/// The stages of a marcher.
fn marcher(march: &March) -> &'static [Stage] {
    match march {
        March::Fixed { .. } => &[stage!("march_fixed")],
        March::Sphere => &[stage!("march"), stage!("march_sphere")],
        March::Relaxed { .. } => &[stage!("march"), stage!("march_relaxed")],
        March::Enhanced { .. } => &[stage!("march"), stage!("march_enhanced", "planar_step")],
        March::Auto { .. } => &[stage!("march"), stage!("march_auto")],
    }
}

/// The stages of the ways that light takes.
fn ways(settings: &Settings) -> &'static [Stage] {
    match settings.integrator {
        Integrator::Whitted { .. } if bounces(settings).is_some() => &[
            stage!("ways_seen"),
            stage!(
                "ways_whitted",
                "mirror_reflectance",
                "followed_share",
                "border",
                "kept_on"
            ),
        ],
        Integrator::Whitted { .. } | Integrator::Direct => {
            &[stage!("ways_seen"), stage!("ways_direct")]
        }
        Integrator::Path { .. } => &[stage!(
            "ways_path",
            "scatter_way",
            "scatter_weight",
            "cone_around",
            "light_width",
            "disc_power",
            "lamp_highlight",
            "balance",
            "scatter_density"
        )],
    }
}

/// The stages of a way to find normals.
fn normals(normals: Normals) -> &'static [Stage] {
    /// Differences over this many axes at a time, at most.
    macro_rules! neighbours {
        ($name:literal, $axes:literal) => {
            &[
                stage!("normal_neighbours", "sample_step"),
                Stage {
                    name: $name,
                    text: concat!("const NEIGHBOUR_AXES: f32 = ", $axes, ";\n"),
                    formulas: &[],
                },
            ]
        };
    }
    match normals {
        Normals::Exact => &[stage!("normal_exact")],
        Normals::Tetrahedron => &[stage!("normal_tetrahedron", "sample_step")],
        Normals::Central => neighbours!("one axis", "1.0"),
        Normals::Samples18 => neighbours!("two axes", "2.0"),
        Normals::Samples26 => neighbours!("three axes", "3.0"),
    }
}

/// Whether there is a shadow at all.
fn casts(shadow: &Shadow) -> bool {
    match shadow {
        Shadow::None => false,
        Shadow::Hard
        | Shadow::Soft { .. }
        | Shadow::SoftClosest { .. }
        | Shadow::Advected { .. } => true,
    }
}

/// How `secondary.wgsl` finds the penumbra of a shadow, if it has one.
fn penumbra(shadow: &Shadow) -> Option<&'static str> {
    match shadow {
        Shadow::None | Shadow::Hard | Shadow::Advected { .. } => None,
        Shadow::Soft { .. } => Some("soft_shadow(f, t, sharpness)"),
        Shadow::SoftClosest { .. } => Some("closest_shadow(f, z, r, t, sharpness)"),
    }
}

/// The weight of a sample along one axis, at `x` pixels from a pixel's middle.
fn filter(filter: Filter) -> &'static str {
    match filter {
        Filter::Box => "filter_box(x)",
        Filter::Tent => "filter_tent(x)",
        Filter::Mitchell => "filter_mitchell(x)",
    }
}

/// How many pixels around its own a sample counts for.
pub(crate) fn reach(filter: Filter) -> u32 {
    match filter {
        Filter::Box => 0,
        Filter::Tent => 1,
        Filter::Mitchell => 2,
    }
}

/// Stage, call and formulas of an occlusion method; none where there is nothing to do.
fn occlusion(method: &Occlusion) -> Option<Case> {
    let kind = number(method);
    let case = |stage, call, formulas, secondary| {
        Some(Case {
            kind,
            stage,
            call,
            formulas,
            secondary,
            has_image: false,
        })
    };
    match method {
        Occlusion::None => None,
        Occlusion::Quilez { .. } => case(
            Some(stage!("ao_quilez")),
            "AmbientVisibility(ao_quilez(at, how), at.normal, vec3f(1.0))",
            &["visibility"],
            false,
        ),
        Occlusion::Bent { .. } => case(
            Some(stage!("ao_bent")),
            "AmbientVisibility(ao_bent(at, how), at.normal, vec3f(1.0))",
            &["visibility"],
            false,
        ),
        Occlusion::Evans { .. } => case(
            Some(stage!("ao_evans")),
            "AmbientVisibility(ao_evans(at, how), at.normal, vec3f(1.0))",
            &["exponential_visibility"],
            false,
        ),
        Occlusion::Skylight { .. } => case(
            Some(stage!("ao_skylight")),
            "ao_skylight(at, how)",
            &[
                "skylight_way",
                "skylight_bent",
                "skylight_share",
                "skylight_light",
                "skylight_split",
            ],
            false,
        ),
        Occlusion::Curvature { .. } => case(
            Some(stage!("ao_curvature")),
            "AmbientVisibility(ao_curvature(at, how), at.normal, vec3f(1.0))",
            &["skylight_share", "skylight_curved"],
            false,
        ),
        Occlusion::Upward { .. } => case(
            None,
            "AmbientVisibility(visibility(slant(at.normal), how.scale), at.normal, vec3f(1.0))",
            &["visibility", "slant"],
            false,
        ),
        Occlusion::Cones { .. } => case(
            Some(stage!("ao_cones")),
            "ao_cones(at, how)",
            &[
                "slope_between",
                "secondary_step",
                "skin_touch",
                "cone_direction",
                "turn_cone",
                "cone_clear",
                "cone_left",
                "cone_share",
                "cone_open",
            ],
            false,
        ),
        Occlusion::Hemisphere { .. } => case(
            Some(stage!("ao_hemisphere")),
            "AmbientVisibility(ao_hemisphere(at, how, key), at.normal, vec3f(1.0))",
            &["cosine_direction"],
            true,
        ),
        Occlusion::Obscurance { .. } => case(
            Some(stage!("ao_obscurance")),
            "AmbientVisibility(ao_obscurance(at, how, key), at.normal, vec3f(1.0))",
            &["cosine_direction", "obscurance"],
            true,
        ),
    }
}

/// Stage, call and formulas of a pattern; none where it is one colour.
fn pattern(pattern: &Pattern) -> Option<Case> {
    let kind = pattern_kind(pattern);
    let case = |stage, call, formulas| {
        Some(Case {
            kind,
            stage,
            call,
            formulas,
            secondary: false,
            has_image: matches!(pattern, Pattern::Triplanar { .. }),
        })
    };
    match pattern {
        Pattern::Solid { .. } | Pattern::Placed { .. } => None,
        Pattern::Checker { .. } => case(
            None,
            "two_inks(pattern_checker(at.point, at.normal, at.width, at.stretch, part.size))",
            &["pattern_checker"],
        ),
        Pattern::Stripes { .. } => case(
            None,
            "two_inks(pattern_stripes(at.point, at.normal, at.width, at.stretch, part.start, part.size))",
            &["pattern_stripes"],
        ),
        Pattern::Noise { .. } => case(
            None,
            "two_inks(pattern_noise(at.point, at.normal, at.width, at.stretch, part.size, part.detail))",
            &["pattern_noise"],
        ),
        Pattern::Gradient { .. } => case(
            None,
            "two_inks(pattern_gradient(at.point, part.start, part.end))",
            &["pattern_gradient"],
        ),
        Pattern::Triplanar { .. } => case(
            Some(stage!("pattern_triplanar")),
            "",
            &["projection_weights", "projection"],
        ),
        Pattern::Orbit { .. } => case(None, "pattern_orbit(at.orbit)", &["pattern_orbit"]),
        Pattern::Formula { .. } => case(Some(stage!("pattern_formula")), "", &[]),
    }
}

/// The number by which a shader knows a pattern.
pub(crate) fn pattern_kind(pattern: &Pattern) -> u32 {
    match pattern {
        Pattern::Solid { .. } => 0,
        Pattern::Checker { .. } => 1,
        Pattern::Stripes { .. } => 2,
        Pattern::Noise { .. } => 3,
        Pattern::Gradient { .. } => 4,
        Pattern::Triplanar { .. } => 5,
        Pattern::Orbit { .. } => 6,
        Pattern::Placed { .. } => 7,
        Pattern::Formula { .. } => 8,
    }
}
