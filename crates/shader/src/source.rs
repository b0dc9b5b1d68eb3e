//! The text of a shader module: the recorded field and the stages that a scene needs.

use crate::entry::{Binding, UNIFORM_NUMBERS, UNIFORM_ROWS};
use crate::field::FieldSource;
use crate::job::{FieldForm, LONGEST_COMPILED};
use crate::layout::{
    Frame, Light, LightSum, Material, Occluder, Sample, Shared, SurfaceSum, Tile, loader, rows,
};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::{Arc, LazyLock};
use zeroset_catalogue::noise::gradient_noise;
use zeroset_field::program::{Program, Structure};
use zeroset_number::record::{Argument, Recorder};
use zeroset_number::wgsl;
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
            march: march_kind(&scene.settings().march),
            normals: scene.settings().normals,
            shading: scene.settings().shading,
            occlusion: methods.map(occlusion_kind).collect(),
            shadows: scene
                .lights()
                .iter()
                .map(|l| shadow_kind(&l.shadow))
                .collect(),
            patterns: (scene.materials().iter())
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
        text += &field.text;
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
        if self.normals != Normals::Exact {
            stages.push(include_str!("stage/normal.wgsl"));
        }
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
        let shadows = self.shadows.iter().any(|&kind| kind != 0);
        if shadows || self.occlusion.iter().any(|kind| HEMISPHERES.contains(kind)) {
            stages.push(include_str!("stage/beam.wgsl"));
        }
        stages.push(if shadows {
            include_str!("stage/shadow.wgsl")
        } else {
            include_str!("stage/shadow_none.wgsl")
        });
        stages.push(match self.shading {
            Shading::Phong => include_str!("stage/shade_phong.wgsl"),
            Shading::Lambert => include_str!("stage/shade_lambert.wgsl"),
            Shading::LambertLegacy => include_str!("stage/shade_legacy.wgsl"),
        });
        stages.extend(
            self.occlusion
                .iter()
                .filter_map(|&kind| Some(OCCLUSION[kind as usize]?.0)),
        );
        stages.extend(
            self.patterns
                .iter()
                .filter_map(|&kind| Some(PATTERNS[kind as usize]?.1)),
        );
        if self.patterns.contains(&PATTERN_NOISE) {
            stages.push(noise());
        }
        stages
    }

    /// The function that tells patterns apart.
    fn pattern_colour(&self) -> String {
        let cases = self.patterns.iter().filter_map(|&kind| {
            let (name, _) = PATTERNS[kind as usize]?;
            Some(format!(
                "        case {kind}u: {{\n            return {name}(m, at);\n        }}\n"
            ))
        });
        switch(
            "fn pattern_colour(m: Material, at: Place) -> vec3f",
            "m.kind",
            cases.collect(),
            "m.a",
        )
    }

    /// The function that tells occlusion methods apart.
    fn occlusion(&self) -> String {
        let cases = self.occlusion.iter().filter_map(|&kind| {
            let (_, call) = OCCLUSION[kind as usize]?;
            Some(format!(
                "        case {kind}u: {{\n            return {call};\n        }}\n"
            ))
        });
        switch(
            "fn occlusion(at: Surface, how: Occluder, key: vec2u) -> Openness",
            "how.kind",
            cases.collect(),
            "Openness(1.0, at.normal)",
        )
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

/// A function that returns `otherwise` but in some cases.
fn switch(signature: &str, kind: &str, cases: String, otherwise: &str) -> String {
    if cases.is_empty() {
        return format!("\n{signature} {{\n    return {otherwise};\n}}\n");
    }
    format!(
        "\n{signature} {{\n    switch (u32({kind})) {{\n{cases}        default: {{\n            return {otherwise};\n        }}\n    }}\n}}\n"
    )
}

/// The noise of procedural materials, recorded from the field's.
fn noise() -> &'static str {
    static NOISE: LazyLock<String> = LazyLock::new(|| {
        let recorder = Recorder::new();
        let value = gradient_noise(recorder.point("p"));
        let function = recorder
            .function("gradient_noise", &[("p", Argument::Vec3)], &[value])
            .expect("a formula of the point alone has no unknown input");
        wgsl::print(&function)
    });
    &NOISE
}

const MARCH_FIXED: u32 = 0;
const PATTERN_NOISE: u32 = 3;
/// Occlusion methods that send rays.
const HEMISPHERES: [u32; 2] = [6, 7];

/// Stage and call of every occlusion method, by its number.
const OCCLUSION: [Option<(&str, &str)>; 8] = [
    None,
    Some((
        include_str!("stage/ao_quilez.wgsl"),
        "Openness(ao_quilez(at, how), at.normal)",
    )),
    Some((
        include_str!("stage/ao_bent.wgsl"),
        "Openness(ao_bent(at, how), at.normal)",
    )),
    Some((
        include_str!("stage/ao_evans.wgsl"),
        "Openness(ao_evans(at, how), at.normal)",
    )),
    Some((
        include_str!("stage/ao_upward.wgsl"),
        "Openness(ao_upward(at, how), at.normal)",
    )),
    Some((include_str!("stage/ao_cones.wgsl"), "ao_cones(at, how)")),
    Some((
        include_str!("stage/ao_hemisphere.wgsl"),
        "Openness(ao_hemisphere(at, how, key), at.normal)",
    )),
    Some((
        include_str!("stage/ao_obscurance.wgsl"),
        "Openness(ao_obscurance(at, how, key), at.normal)",
    )),
];

/// Function and stage of every pattern that is more than one colour, by its number.
const PATTERNS: [Option<(&str, &str)>; 7] = [
    None,
    Some((
        "pattern_checker",
        include_str!("stage/pattern_checker.wgsl"),
    )),
    Some((
        "pattern_stripes",
        include_str!("stage/pattern_stripes.wgsl"),
    )),
    Some(("pattern_noise", include_str!("stage/pattern_noise.wgsl"))),
    Some((
        "pattern_gradient",
        include_str!("stage/pattern_gradient.wgsl"),
    )),
    Some((
        "pattern_triplanar",
        include_str!("stage/pattern_triplanar.wgsl"),
    )),
    Some(("pattern_orbit", include_str!("stage/pattern_orbit.wgsl"))),
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
