//! A scene as one file of shader text, with all its numbers in it: it needs no buffers and no program of ours.
//!
//! The picture is the one that a GPU renders, but for two things that need buffers: rays are weighted by a box as wide as
//! their pixel, and there are no cones.

use crate::fold;
use crate::job::{Before, FieldForm, Parts};
use crate::layout::{Frame, Shared};
use crate::motion::{self, Motion, Numbers};
use crate::texture;
use naga::back::glsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::fmt::Write;
use std::hash::{DefaultHasher, Hash, Hasher};
use zeroset_field::program::Limits;
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings;
use zeroset_shade::environment::EnvironmentMap;

pub use crate::motion::{Held, Input};

/// Parameters, table rows, pixels of images, samples of grids and instructions that a file may have, of each: compilers of shaders give up on more.
const LARGEST: usize = 4000;

/// Why there is no file.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The scene cannot be made.
    #[error(transparent)]
    Scene(#[from] RenderError),
    /// The scene is too large for one shader.
    #[error(
        "the scene is too large for one shader: it has {count} {what}, {LARGEST} is the most that can be exported"
    )]
    Large {
        /// What there is too much of.
        what: &'static str,
        /// How much.
        count: usize,
    },
    /// The text could not be translated.
    #[error("the shader cannot be written as GLSL: {0}")]
    Translation(String),
}

/// The scene as a WGSL module with a vertex and a fragment entry point, which draw it on a triangle over the whole picture.
///
/// # Errors
/// See [`ExportError`].
pub fn wgsl(scene: &Scene) -> Result<String, ExportError> {
    let mut text = format!(
        "// {}: a signed distance field, rendered by sphere tracing. Written by Zeroset.\n\
         // Draw three vertices without buffers with `corners` and `pixel`.\n\n",
        one_line(scene.name())
    );
    text += &body(scene, &parts(scene)?)?;
    let [width, height] = scene.settings().size;
    let _ = write!(
        text,
        "
/// A triangle that covers the picture.
@vertex
fn corners(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {{
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}}

/// The picture's size in pixels.
const SIZE: vec2f = vec2f({width}.0, {height}.0);

@fragment
fn pixel(@builtin(position) position: vec4f) -> @location(0) vec4f {{
    return picture(floor(position.xy), SIZE, vec2f(0.0));
}}
"
    );
    Ok(text)
}

/// A scene as GLSL, and what of it the text does not have.
#[derive(Clone, Debug)]
pub struct Exported {
    /// The text.
    pub text: String,
    /// What is left out, and why; the text says so too.
    pub held: Vec<Held>,
}

/// The scene as GLSL that runs when it is pasted into Shadertoy: dragging with the mouse turns the camera.
///
/// # Errors
/// See [`ExportError`].
pub fn glsl(scene: &Scene) -> Result<String, ExportError> {
    let exported = glsl_moving(scene, &[], &[], &mut |_| None)?;
    Ok(exported.text)
}

/// As [`glsl()`], of a scene that time and sliders change: the text follows `iTime`, and has each slider as a number at its head, or as a uniform.
///
/// `scene_at` makes the scene for values of the inputs, in their order; none where it fails. `scene` is the one for the values that the inputs
/// have. `held` is what is known beforehand to be left out.
///
/// # Errors
/// See [`ExportError`].
pub fn glsl_moving(
    scene: &Scene,
    inputs: &[Input],
    held: &[Held],
    scene_at: &mut dyn FnMut(&[f64]) -> Option<Scene>,
) -> Result<Exported, ExportError> {
    let mut parts = parts(scene)?;
    let mut scene = scene.clone();
    let mut inputs = inputs.to_vec();
    // occlusion by a volume of distances has one that is made anew for each place that is tried
    let mut motion = Motion::held(&inputs, "a volume of distances is as it was made");
    if parts.sky.is_none() && parts.light.is_none() && !inputs.is_empty() {
        let mut make = |values: &[f64]| {
            let scene = scene_at(values)?;
            Some(numbers(&scene, &self::parts(&scene).ok()?))
        };
        let usual = motion::usual(&inputs, &mut make);
        motion = motion::found(&inputs, numbers(&scene, &parts), &mut make);
        if let Some(usual) = usual {
            let values: Vec<f64> = usual.iter().map(|i| i.value).collect();
            if let Some(base) = make(&values) {
                let moving = motion::found(&usual, base, &mut make);
                if moving.moves(&usual)
                    && let Some(later) = scene_at(&values)
                {
                    parts = self::parts(&later)?;
                    (scene, inputs, motion) = (later, usual, moving);
                }
            }
        }
    }
    let (scene, inputs) = (&scene, inputs.as_slice());
    let mut source = body(scene, &parts)?;
    if !motion.inputs.is_empty() {
        source += &motion.text(inputs, |place| place_name(&parts, place));
    }
    let mut held = held.to_vec();
    held.extend(motion.held.iter().cloned());
    let (mut parameters, mut arguments) = (String::new(), String::new());
    for (k, _) in motion.inputs.iter().enumerate() {
        let _ = write!(parameters, ", @location({}) input_{k}: f32", k + 3);
        let _ = write!(arguments, "{}input_{k}", if k == 0 { "" } else { ", " });
    }
    let animate = match motion.inputs.is_empty() {
        true => String::new(),
        false => format!("    animate({arguments});\n"),
    };
    let _ = write!(
        source,
        "
@fragment
fn pixel(@location(0) corner: vec2f, @location(1) size: vec2f, @location(2) angles: vec2f{parameters}) -> @location(0) vec4f {{
{animate}    return picture(corner, size, angles);
}}
"
    );
    let text = translated(&source)?;
    let head = Head {
        name: scene.name(),
        inputs,
        carried: &motion.inputs,
        held: &held,
    };
    let text = shadertoy(&head, &text).ok_or_else(|| {
        ExportError::Translation("the translation has an unknown form".to_owned())
    })?;
    Ok(Exported { text, held })
}

/// WGSL with an entry point `pixel` as GLSL.
fn translated(source: &str) -> Result<String, ExportError> {
    let wrong = |e: &dyn std::fmt::Display| ExportError::Translation(e.to_string());
    let mut module = naga::front::wgsl::parse_str(source).map_err(|e| wrong(&e))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).map_err(|e| wrong(&e))?;
    fold::trim(&mut module);
    let info = validator.validate(&module).map_err(|e| wrong(&e))?;
    fold::unname(&mut module, &info);
    let options = glsl::Options {
        version: glsl::Version::Embedded {
            version: 300,
            is_webgl: true,
        },
        writer_flags: glsl::WriterFlags::empty(),
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: naga::ShaderStage::Fragment,
        entry_point: "pixel".into(),
        multiview: None,
    };
    let mut written = String::new();
    glsl::Writer::new(
        &mut written,
        &module,
        &info,
        &options,
        &pipeline,
        naga::proc::BoundsCheckPolicies::default(),
    )
    .map_err(|e| wrong(&e))?
    .write()
    .map_err(|e| wrong(&e))?;
    Ok(written)
}

/// What stands at the head of a file.
struct Head<'a> {
    name: &'a str,
    inputs: &'a [Input],
    /// Numbers of those that the shader has.
    carried: &'a [usize],
    held: &'a [Held],
}

impl Head<'_> {
    fn text(&self) -> String {
        let mut text = format!(
            "// {}: a signed distance field, rendered by sphere tracing. Written by Zeroset.\n\
             // Paste this into the Image tab of shadertoy.com. Drag with the mouse to look around.\n",
            one_line(self.name)
        );
        for held in self.held {
            let _ = writeln!(
                text,
                "// Not carried: {}: {}.",
                one_line(&held.name),
                one_line(&held.why)
            );
        }
        let sliders: Vec<(&Input, [f64; 2], String)> = (self.carried.iter())
            .filter_map(|i| {
                Some((
                    &self.inputs[*i],
                    self.inputs[*i].range?,
                    slider(self.inputs, *i),
                ))
            })
            .collect();
        if sliders.is_empty() {
            return text;
        }
        text += "\n// Sliders: change the numbers, or define SLIDERS_ARE_UNIFORMS and set them from outside.\n#ifdef SLIDERS_ARE_UNIFORMS\n";
        for (input, [min, max], name) in &sliders {
            let _ = writeln!(
                text,
                "uniform float {name}; // {}: {min} to {max}, at first {}",
                one_line(&input.name),
                input.value
            );
        }
        text += "#else\n";
        for (input, [min, max], name) in &sliders {
            let _ = writeln!(
                text,
                "const float {name} = {:?}; // {}: {min} to {max}",
                input.value as f32,
                one_line(&input.name)
            );
        }
        text += "#endif\n";
        text
    }

    /// The call that gives the shader what changes.
    fn animate(&self) -> String {
        if self.carried.is_empty() {
            return String::new();
        }
        let each = |i: &usize| match self.inputs[*i].range {
            None => "iTime".to_owned(),
            Some(_) => slider(self.inputs, *i),
        };
        let arguments: Vec<String> = self.carried.iter().map(each).collect();
        format!("    animate({});\n", arguments.join(", "))
    }
}

/// What a slider is called: letters of its name that GLSL takes, and its number where another one is called so.
fn slider(inputs: &[Input], number: usize) -> String {
    let of = |input: &Input| {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let mut name: String = input.name.chars().map(plain).take(40).collect();
        // two of them in a row are not allowed
        while name.contains("__") {
            name = name.replace("__", "_");
        }
        format!("slider_{}", name.trim_matches('_'))
    };
    let name = of(&inputs[number]);
    let is_taken = inputs[..number].iter().any(|other| of(other) == name);
    if is_taken || name == "slider_" {
        format!("{}_number_{number}", name.trim_end_matches('_'))
    } else {
        name
    }
}

/// Takes what Shadertoy gives itself out of a fragment shader, and puts its entry point in.
fn shadertoy(head: &Head<'_>, written: &str) -> Option<String> {
    let (functions, _) = written.split_once("void main() {")?;
    let kept = functions.lines().filter(|line| {
        let given = [
            "#version",
            "precision ",
            "layout(location",
            "in vec",
            "smooth in",
            "out vec",
        ];
        !given.iter().any(|start| line.starts_with(start))
    });
    let mut text = head.text();
    let mut blank = false;
    for line in kept {
        // what was taken out leaves no gaps
        if !(blank && line.is_empty()) {
            text += line;
            text.push('\n');
        }
        blank = line.is_empty();
    }
    text += "void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    vec2 corner = vec2(floor(fragCoord.x), iResolution.y - 1.0 - floor(fragCoord.y));
    vec2 angles = vec2(0.0);
    if (iMouse.x + iMouse.y > 0.0) {
        angles = (0.5 - iMouse.xy / iResolution.xy) * vec2(6.2831853, 3.1415927);
    }
";
    text += &head.animate();
    text += "    fragColor = picture(corner, iResolution.xy, angles);
}
";
    Some(text)
}

fn one_line(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

fn parts(scene: &Scene) -> Result<Parts, ExportError> {
    let around = EnvironmentMap::renewed(None, scene);
    let (limits, form) = (Limits::default(), FieldForm::Compiled);
    Ok(Parts::new(
        scene,
        &limits,
        form,
        around.as_deref(),
        Before::default(),
    )?)
}

/// Members of the frame that only bound what there is: they may be larger, or smaller.
const LOOSE: [(&str, i8); 4] = [
    ("region_min", -1),
    ("region_max", 1),
    ("far", 1),
    ("rounding", 1),
];

/// The floats of the frame: name, how many, and where they begin in bytes.
fn frame_floats() -> impl Iterator<Item = (&'static str, usize, usize)> {
    Frame::MEMBERS.iter().filter_map(|m| {
        let count = match m.wgsl {
            "f32" => 1,
            "vec2f" => 2,
            "vec3f" => 3,
            _ => return None,
        };
        Some((m.name, count, m.offset))
    })
}

/// All numbers that may change without another shader: parameters, the table, and the frame.
fn numbers(scene: &Scene, parts: &Parts) -> Numbers {
    let bytes = bytemuck::bytes_of(&parts.frame);
    let mut others = bytes.to_vec();
    let fixed = parts.params.iter().chain(parts.table.as_flattened());
    let mut values: Vec<f64> = fixed.map(|x| f64::from(*x)).collect();
    let mut loose = vec![0; values.len()];
    for (name, count, offset) in frame_floats() {
        let may = LOOSE
            .iter()
            .find(|(n, _)| *n == name)
            .map_or(0, |(_, may)| *may);
        for k in 0..count {
            let at = offset + 4 * k;
            let word = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
            values.push(f64::from(f32::from_ne_bytes(word)));
            loose.push(may);
            others[at..at + 4].fill(0);
        }
    }
    let mut hasher = DefaultHasher::new();
    (&parts.key, parts.params.len(), parts.table.len(), others).hash(&mut hasher);
    let settings = scene.settings();
    (settings.exposure.to_bits(), settings.tone).hash(&mut hasher);
    for image in &parts.images {
        let bits = |c: &glam::Vec3| c.to_array().map(f32::to_bits);
        (
            image.width,
            image.height,
            image.pixels.iter().map(bits).collect::<Vec<_>>(),
        )
            .hash(&mut hasher);
    }
    for grid in &parts.grids {
        (grid
            .values()
            .iter()
            .map(|x| x.to_bits())
            .collect::<Vec<_>>())
        .hash(&mut hasher);
    }
    Numbers {
        structure: hasher.finish(),
        values,
        loose,
    }
}

/// What a number of [`numbers`] is called in the shader.
fn place_name(parts: &Parts, place: usize) -> String {
    let letters = ["x", "y", "z", "w"];
    let Some(row) = place.checked_sub(parts.params.len()) else {
        return format!("params[{place}]");
    };
    let Some(mut rest) = row.checked_sub(4 * parts.table.len()) else {
        return format!("table[{}].{}", row / 4, letters[row % 4]);
    };
    for (name, count, _) in frame_floats() {
        if rest < count {
            return match count {
                1 => format!("frame.{name}"),
                _ => format!("frame.{name}.{}", letters[rest]),
            };
        }
        rest -= count;
    }
    // no number lies beyond
    String::new()
}

/// Everything but entry points.
fn body(scene: &Scene, parts: &Parts) -> Result<String, ExportError> {
    let large = [
        ("instructions", parts.key.length()),
        ("parameters", parts.params.len()),
        ("rows of lights, objects and materials", parts.table.len()),
        (
            "pixels of images",
            texture::starts(&parts.images).last().unwrap_or(0) as usize,
        ),
        (
            "samples of grids",
            texture::starts(&parts.grids).last().unwrap_or(0) as usize,
        ),
    ];
    if let Some((what, count)) = large.into_iter().find(|(_, count)| *count > LARGEST) {
        return Err(ExportError::Large { what, count });
    }
    let mut text = Frame::declaration();
    let _ = writeln!(
        text,
        "var<private> frame: Frame = {};",
        values(&parts.frame)
    );
    list(
        &mut text,
        "params",
        "f32",
        parts.params.iter().map(|&x| number(x)).collect(),
    );
    let row = |r: &[f32]| {
        let numbers: Vec<String> = r.iter().map(|&x| number(x)).collect();
        format!("vec{}f({})", r.len(), numbers.join(", "))
    };
    list(
        &mut text,
        "table",
        "vec4f",
        parts.table.iter().map(|r| row(r)).collect(),
    );
    if parts.key.shows_images() {
        let pixels = parts.images.iter().flat_map(|image| &image.pixels);
        list(
            &mut text,
            "images",
            "vec3f",
            pixels.map(|c| row(&c.to_array())).collect(),
        );
        text += IMAGE_TEXEL;
    }
    if parts.key.reads_grids() {
        let samples = parts.grids.iter().flat_map(|grid| grid.values());
        list(
            &mut text,
            "grids",
            "f32",
            samples.map(|&x| number(x)).collect(),
        );
        text += GRID_TEXEL;
    }
    let _ = writeln!(
        text,
        "const EXPOSURE: f32 = {};",
        number(scene.settings().exposure.exp2())
    );
    let _ = writeln!(text, "const PIVOT: f32 = {};", number(pivot(&parts.frame)));
    text += &parts.key.picture().text;
    text.push('\n');
    text += crate::formulas::text(match scene.settings().tone {
        settings::Tone::Soft => "srgb@Soft",
        settings::Tone::Filmic => "srgb@Filmic",
        settings::Tone::Agx => "srgb@Agx",
        settings::Tone::Standard => "srgb@Standard",
    });
    text.push('\n');
    text += include_str!("stage/picture.wgsl");
    Ok(text)
}

/// How far from the eye the camera turns around: the middle of the scene's box, as far as it has one, along the view.
fn pivot(frame: &Frame) -> f32 {
    let mut along = 0.0;
    for k in 0..3 {
        let (low, high) = (frame.region_min[k], frame.region_max[k]);
        let middle = match (
            low.is_finite() && low.abs() < 1e6,
            high.is_finite() && high.abs() < 1e6,
        ) {
            (true, true) => 0.5 * (low + high),
            (true, false) => low,
            (false, true) => high,
            (false, false) => 0.0,
        };
        along -= (middle - frame.eye[k]) * frame.back[k];
    }
    along.clamp(0.1, 1e4)
}

/// The function that reads a pixel of `images`, by its number.
const IMAGE_TEXEL: &str = "
fn image_texel(at: u32) -> vec3f {
    return images[at];
}
";

/// The function that reads a sample of `grids`, by its number.
const GRID_TEXEL: &str = "
fn grid_texel(at: u32) -> f32 {
    return grids[at];
}
";

/// An array of values that nobody changes. (WGSL indexes only variables by numbers that are not constant.)
fn list(text: &mut String, name: &str, kind: &str, mut values: Vec<String>) {
    if values.is_empty() {
        values.push(format!("{kind}(0.0)"));
    }
    let _ = writeln!(
        text,
        "var<private> {name}: array<{kind}, {}> = array<{kind}, {}>(\n    {},\n);",
        values.len(),
        values.len(),
        values.join(",\n    ")
    );
}

/// The value of a struct.
fn values<T: Shared>(of: &T) -> String {
    let bytes = bytemuck::bytes_of(of);
    let members = T::MEMBERS.iter().map(|m| {
        let word = |k: usize| {
            let at = m.offset + 4 * k;
            [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]
        };
        let float = |k: usize| number(f32::from_ne_bytes(word(k)));
        let whole = |k: usize| format!("{}u", u32::from_ne_bytes(word(k)));
        match m.wgsl {
            "f32" => float(0),
            "u32" => whole(0),
            "vec2f" => format!("vec2f({}, {})", float(0), float(1)),
            "vec2u" => format!("vec2u({}, {})", whole(0), whole(1)),
            "vec3f" => format!("vec3f({}, {}, {})", float(0), float(1), float(2)),
            _ => format!(
                "vec4u({}, {}, {}, {})",
                whole(0),
                whole(1),
                whole(2),
                whole(3)
            ),
        }
    });
    format!("{}({})", T::NAME, members.collect::<Vec<_>>().join(", "))
}

/// A number as WGSL: finite, with a point or an exponent.
fn number(x: f32) -> String {
    let x = if x.is_nan() {
        0.0
    } else {
        x.clamp(-3.0e38, 3.0e38)
    };
    format!("{x:?}f")
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::assets::Assets;
    use zeroset_language::document::Document;
    use zeroset_language::limits;
    use zeroset_language::load::{Language, Options};

    const SCENE: &str = "bite = slider(\"bite mark\", 0.4, min = 0.1, max = 1.0)
t = time()
show(sphere(1) - sphere(0.5).move(x = 1.2 - bite, y = 0.1 * sin(tau * t)), material(color = hsv(100, 0.5 * bite, 1)))
show(torus(1.4, 0.1).turn(x = 90).move(y = -0.4).smooth_union(sphere(0.2).move(z = 0.5 * cos(3 * t)), radius = bite))
show(box((0.2 + bite, 1, 1)).turn(y = 40 * t).move(x = 3), name = \"turning\")
camera(eye = (3 * cos(t / 2), 2, 3 * sin(t / 2)), target = (0, 0, 0))
";

    /// The numbers of a scene at another time and with another slider are what the formulas say.
    #[test]
    fn scenes_move_as_they_do() {
        let (limits, assets) = (limits::Limits::default(), Assets::default());
        let mut document =
            Document::of_text("a.star", SCENE, Language::Starlark, None, &limits, &assets)
                .expect("a document");
        let mut scene_at = |values: &[f64]| {
            let options = Options {
                time: values[0],
                set: [("bite mark".to_owned(), values[1].to_string())].into(),
                ..Options::default()
            };
            document.scene(&options).ok().map(|loaded| loaded.scene)
        };
        let scene = scene_at(&[0.0, 0.4]).expect("a scene");
        let inputs = [("time()", 0.0, None), ("bite mark", 0.4, Some([0.1, 1.0]))];
        let inputs = inputs.map(|(name, value, range)| Input {
            name: name.to_owned(),
            value,
            range,
        });
        let exported = glsl_moving(&scene, &inputs, &[], &mut scene_at).expect("a shader");
        assert_eq!(exported.held, []);
        let text = exported.text;
        for line in [
            "uniform float slider_bite_mark; // bite mark: 0.1 to 1, at first 0.4",
            "const float slider_bite_mark = 0.4; // bite mark: 0.1 to 1",
            "    animate(iTime, slider_bite_mark);",
        ] {
            assert!(text.lines().any(|l| l == line), "{line}\n{text}");
        }
        let made = |scene: &Scene| {
            let parts = parts(scene).expect("parts");
            numbers(scene, &parts)
        };
        let base = made(&scene);
        let mut make = |values: &[f64]| scene_at(values).map(|scene| made(&scene));
        let motion = motion::found(&inputs, base.clone(), &mut make);
        for k in 0..12u32 {
            let values = [
                f64::from(k) * 3.7,
                0.1 + 0.9 * (f64::from(k) * 0.37).fract(),
            ];
            let right = make(&values).expect("numbers");
            for (place, right) in right.values.iter().enumerate() {
                let found = motion.at(&inputs, place, base.values[place], &values);
                let held = match base.loose[place] {
                    0 => (found - right).abs() <= 2e-5 * right.abs().max(1.0),
                    sign => f64::from(sign) * (found - right) >= 0.0,
                };
                assert!(
                    found == *right || held,
                    "{place} at {values:?}: {found}, not {right}"
                );
            }
        }
    }

    #[test]
    fn names_of_sliders_are_names_of_glsl() {
        let named = |names: &[&str]| {
            let inputs: Vec<Input> = (names.iter())
                .map(|name| Input {
                    name: (*name).to_owned(),
                    value: 0.0,
                    range: Some([0.0, 1.0]),
                })
                .collect();
            (0..inputs.len())
                .map(|i| slider(&inputs, i))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            named(&["a b", "a-b", "größe", "__", "π"]),
            [
                "slider_a_b",
                "slider_a_b_number_1",
                "slider_gr_e",
                "slider_number_3",
                "slider_number_4"
            ]
        );
    }
}
