//! The text of a shader module: the recorded field, the recorded formulas and the stages that a scene needs.

use crate::constants;
use crate::entry::{Binding, UNIFORM_NUMBERS, UNIFORM_ROWS};
use crate::field::FieldSource;
use crate::formulas;
use crate::job::{FieldForm, LONGEST_COMPILED};
use crate::layout::{
    Frame, Light, LightSum, Material, Occluder, Sample, Shared, SurfaceSum, Tile, loader, rows,
};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;
use zeroset_field::program::{Program, Structure};
use zeroset_scene::material::Pattern;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{March, Normals, Occlusion, Shading, Shadow};

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
    march: u32,
    normals: Normals,
    shading: Shading,
    occlusion: BTreeSet<u32>,
    shadows: BTreeSet<u32>,
    patterns: BTreeSet<u32>,
}

impl Key {
    /// `rows`: those of the table.
    pub(crate) fn new(scene: &Scene, program: &Program, form: FieldForm, rows: usize) -> Key {
        let structure = program.shared_structure();
        let methods = (scene.objects.iter())
            .filter_map(|o| o.occlusion.as_ref())
            .chain([&scene.settings.occlusion]);
        let mut key = Key {
            interpreted: form == FieldForm::Interpreted,
            steep: program.is_steep(),
            in_turns: false,
            uniform_params: program.params().len() <= UNIFORM_NUMBERS,
            uniform_table: rows <= UNIFORM_ROWS,
            structure,
            march: march_kind(&scene.settings.march),
            normals: scene.settings.normals,
            shading: scene.settings.shading,
            occlusion: methods.map(occlusion_kind).collect(),
            shadows: scene
                .lights
                .iter()
                .map(|l| shadow_kind(&l.shadow))
                .collect(),
            patterns: (scene.materials.iter())
                .map(|m| pattern_kind(&m.pattern))
                .collect(),
        };
        if form == FieldForm::Auto {
            key.interpreted = key.length() > LONGEST_COMPILED;
        }
        key
    }

    /// Instructions for values and marks together.
    pub(crate) fn length(&self) -> usize {
        self.structure.values.instructions.len() + self.structure.marks.instructions.len()
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

    /// What turns a ray into a sample: everything but buffers and entry points. It uses `frame`, `params`, `table` and, for a
    /// field that is data, `code`.
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
            Material::declaration(),
            Sample::declaration(),
        ] {
            text += &declaration;
        }
        for (name, rows) in [
            ("LIGHT", rows::<Light>()),
            ("OCCLUDER", rows::<Occluder>()),
            ("MATERIAL", rows::<Material>()),
        ] {
            // writing to a string cannot fail
            let _ = writeln!(text, "const {name}_ROWS: u32 = {rows}u;");
        }
        text += &loader::<Light>();
        text += &loader::<Occluder>();
        text += &loader::<Material>();
        text += &constants::declarations();
        text += &field.text;
        for name in self.formulas() {
            text.push('\n');
            text += formulas::text(name);
        }
        for stage in self.stages() {
            text.push('\n');
            text += stage;
        }
        text += &self.pattern_colour();
        text += &self.occlusion();
        Text {
            text,
            code: field.code,
            registers: field.registers,
        }
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
            include_str!("stage/shade.wgsl"),
            include_str!("stage/trace.wgsl"),
        ];
        if self.march != MARCH_FIXED {
            stages.push(include_str!("stage/march.wgsl"));
        }
        stages.push(match self.march {
            MARCH_FIXED => include_str!("stage/march_fixed.wgsl"),
            1 => include_str!("stage/march_sphere.wgsl"),
            2 => include_str!("stage/march_relaxed.wgsl"),
            3 => include_str!("stage/march_enhanced.wgsl"),
            _ => include_str!("stage/march_auto.wgsl"),
        });
        match self.normals {
            Normals::Exact => stages.push(include_str!("stage/normal_exact.wgsl")),
            Normals::Tetrahedron => stages.push(include_str!("stage/normal_tetrahedron.wgsl")),
            Normals::Central => stages.push("const NEIGHBOUR_AXES: f32 = 1.0;\n"),
            Normals::Samples18 => stages.push("const NEIGHBOUR_AXES: f32 = 2.0;\n"),
            Normals::Samples26 => stages.push("const NEIGHBOUR_AXES: f32 = 3.0;\n"),
        }
        if !matches!(self.normals, Normals::Exact | Normals::Tetrahedron) {
            stages.push(include_str!("stage/normal_neighbours.wgsl"));
        }
        stages.push(if self.steep {
            include_str!("stage/distance_steep.wgsl")
        } else {
            include_str!("stage/distance.wgsl")
        });
        if self.has_beams() {
            stages.push(include_str!("stage/beam.wgsl"));
        }
        stages.push(if self.has_shadows() {
            include_str!("stage/shadow.wgsl")
        } else {
            include_str!("stage/shadow_none.wgsl")
        });
        stages.extend(
            self.occlusion
                .iter()
                .filter_map(|&k| OCCLUSION[k as usize].stage),
        );
        stages.extend(
            self.patterns
                .iter()
                .filter_map(|&k| PATTERNS[k as usize].stage),
        );
        stages
    }

    fn has_shadows(&self) -> bool {
        self.shadows.iter().any(|&kind| kind != 0)
    }

    /// Whether rays are sent from surfaces.
    fn has_beams(&self) -> bool {
        self.has_shadows() || self.occlusion.iter().any(|kind| HEMISPHERES.contains(kind))
    }

    /// The formulas that those stages call.
    fn formulas(&self) -> BTreeSet<&'static str> {
        let mut names = BTreeSet::from(EVERYWHERE);
        names.extend(match self.shading {
            Shading::Phong => ["light_response@Phong", "surface_colour@Phong"],
            Shading::Lambert => ["light_response@Lambert", "surface_colour@Lambert"],
            // the surface answers alike
            Shading::LambertLegacy => ["light_response@LambertLegacy", "surface_colour@Lambert"],
        });
        if self.march == MARCH_ENHANCED {
            names.insert("planar_step");
        }
        if self.normals != Normals::Exact {
            names.insert("sample_step");
        }
        if self.has_beams() {
            names.extend(BEAMS);
        }
        for &kind in &self.occlusion {
            names.extend(OCCLUSION[kind as usize].formulas);
        }
        for &kind in &self.patterns {
            names.extend(PATTERNS[kind as usize].formulas);
        }
        names
    }

    /// The function that tells patterns apart.
    fn pattern_colour(&self) -> String {
        let signature = "fn pattern_colour(m: Material, at: Place) -> vec3f";
        switch(signature, "m.kind", &self.patterns, &PATTERNS)
    }

    /// The function that tells occlusion methods apart.
    fn occlusion(&self) -> String {
        let signature = "fn occlusion(at: Surface, how: Occluder, key: vec2u) -> Openness";
        switch(signature, "how.kind", &self.occlusion, &OCCLUSION)
    }
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

/// A row of the table, from the uniform buffer.
const ROW: &str = "
fn table_at(i: u32) -> vec4f {
    return rows[i];
}
";

/// A function that tells methods apart by their numbers; the first of them is the default.
fn switch(signature: &str, kind: &str, used: &BTreeSet<u32>, methods: &[Method]) -> String {
    let otherwise = methods[0].call;
    let cases: String = (used.iter().filter(|&&k| k != 0))
        .map(|&k| {
            let call = methods[k as usize].call;
            format!("        case {k}u: {{\n            return {call};\n        }}\n")
        })
        .collect();
    if cases.is_empty() {
        return format!("\n{signature} {{\n    return {otherwise};\n}}\n");
    }
    format!(
        "\n{signature} {{\n    switch (u32({kind})) {{\n{cases}        default: {{\n            return {otherwise};\n        }}\n    }}\n}}\n"
    )
}

const MARCH_FIXED: u32 = 0;
const MARCH_ENHANCED: u32 = 3;
/// Occlusion methods that send rays.
const HEMISPHERES: [u32; 2] = [6, 7];

/// Formulas that every picture needs.
const EVERYWHERE: [&str; 19] = [
    "false_position",
    "on_plane",
    "pinhole_ray",
    "across_plane",
    "cone_slope",
    "enter_box",
    "leave_box",
    "view_narrowness",
    "width_of_pixel",
    "radius_of_footprint",
    "behind_surface",
    "smoothed_slope",
    "slope_step",
    "filter_box",
    "filter_tent",
    "filter_mitchell",
    "footprint_on",
    "sky_colour",
    "towards_point",
];

/// Those of `stage/beam.wgsl`.
const BEAMS: [&str; 5] = [
    "slope_between",
    "secondary_step",
    "skin_touch",
    "soft_shadow",
    "closest_shadow",
];

/// One of several methods: the number that shaders know it by is its place in the list.
struct Method {
    /// What calls it.
    call: &'static str,
    /// The formulas that it needs.
    formulas: &'static [&'static str],
    /// Its stage, where it is more than a formula.
    stage: Option<&'static str>,
}

/// Occlusion methods, by their numbers.
const OCCLUSION: [Method; 8] = [
    Method {
        call: "Openness(1.0, at.normal)",
        formulas: &[],
        stage: None,
    },
    Method {
        call: "Openness(ao_quilez(at, how), at.normal)",
        formulas: &["visibility"],
        stage: Some(include_str!("stage/ao_quilez.wgsl")),
    },
    Method {
        call: "Openness(ao_bent(at, how), at.normal)",
        formulas: &["visibility"],
        stage: Some(include_str!("stage/ao_bent.wgsl")),
    },
    Method {
        call: "Openness(ao_evans(at, how), at.normal)",
        formulas: &["exponential_visibility"],
        stage: Some(include_str!("stage/ao_evans.wgsl")),
    },
    Method {
        call: "Openness(visibility(slant(at.normal), how.scale), at.normal)",
        formulas: &["visibility", "slant"],
        stage: None,
    },
    Method {
        call: "ao_cones(at, how)",
        formulas: &[
            "slope_between",
            "secondary_step",
            "skin_touch",
            "cone_direction",
            "turn_cone",
            "cone_clear",
            "cone_left",
            "cone_share",
        ],
        stage: Some(include_str!("stage/ao_cones.wgsl")),
    },
    Method {
        call: "Openness(ao_hemisphere(at, how, key), at.normal)",
        formulas: &["cosine_direction"],
        stage: Some(include_str!("stage/ao_hemisphere.wgsl")),
    },
    Method {
        call: "Openness(ao_obscurance(at, how, key), at.normal)",
        formulas: &["cosine_direction", "obscurance"],
        stage: Some(include_str!("stage/ao_obscurance.wgsl")),
    },
];

/// Patterns, by their numbers.
const PATTERNS: [Method; 7] = [
    Method {
        call: "m.a",
        formulas: &[],
        stage: None,
    },
    Method {
        call: "pattern_checker(at.point, at.normal, at.footprint, m.a, m.b, m.size)",
        formulas: &["pattern_checker"],
        stage: None,
    },
    Method {
        call: "pattern_stripes(at.point, at.normal, at.footprint, m.a, m.b, m.c, m.size)",
        formulas: &["pattern_stripes"],
        stage: None,
    },
    Method {
        call: "pattern_noise(at.point, at.footprint, m.a, m.b, m.size, m.detail)",
        formulas: &["pattern_noise"],
        stage: None,
    },
    Method {
        call: "pattern_gradient(at.point, m.a, m.b, m.c, m.d)",
        formulas: &["pattern_gradient"],
        stage: None,
    },
    Method {
        call: "pattern_triplanar(m, at)",
        formulas: &["projection_weights", "projection"],
        stage: Some(include_str!("stage/pattern_triplanar.wgsl")),
    },
    Method {
        call: "pattern_orbit(at.orbit, m.a, m.b, m.c, m.d)",
        formulas: &["pattern_orbit"],
        stage: None,
    },
];

/// Number of a marcher in shaders.
pub(crate) fn march_kind(march: &March) -> u32 {
    match march {
        March::Fixed { .. } => 0,
        March::Sphere => 1,
        March::Relaxed { .. } => 2,
        March::Enhanced { .. } => 3,
        March::Auto { .. } => 4,
    }
}

/// Number of a shadow method in shaders.
pub(crate) fn shadow_kind(shadow: &Shadow) -> u32 {
    match shadow {
        Shadow::None => 0,
        Shadow::Hard => 1,
        Shadow::Soft { .. } => 2,
        Shadow::SoftClosest { .. } => 3,
    }
}

/// Number of an occlusion method in shaders.
pub(crate) fn occlusion_kind(occlusion: &Occlusion) -> u32 {
    match occlusion {
        Occlusion::None => 0,
        Occlusion::Quilez { .. } => 1,
        Occlusion::Bent { .. } => 2,
        Occlusion::Evans { .. } => 3,
        Occlusion::Upward { .. } => 4,
        Occlusion::Cones { .. } => 5,
        Occlusion::Hemisphere { .. } => 6,
        Occlusion::Obscurance { .. } => 7,
    }
}

/// Number of a pattern in shaders.
pub(crate) fn pattern_kind(pattern: &Pattern) -> u32 {
    match pattern {
        Pattern::Solid { .. } => 0,
        Pattern::Checker { .. } => 1,
        Pattern::Stripes { .. } => 2,
        Pattern::Noise { .. } => 3,
        Pattern::Gradient { .. } => 4,
        Pattern::Triplanar { .. } => 5,
        Pattern::Orbit { .. } => 6,
    }
}
