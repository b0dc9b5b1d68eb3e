//! A scene as one file of shader text, with all its numbers in it: it needs no buffers and no program of ours.
//!
//! The picture is the one that a GPU renders, but for two things that need buffers: rays are weighted by a box as wide as
//! their pixel, and there are no cones.

use crate::job::{FieldForm, Parts};
use crate::layout::{Frame, Shared};
use crate::texture;
use naga::back::glsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::fmt::Write;
use zeroset_field::program::Limits;
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings;
use zeroset_shade::environment::EnvironmentMap;

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
    text += &body(scene)?;
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

/// The scene as GLSL that runs when it is pasted into Shadertoy: dragging with the mouse turns the camera.
///
/// # Errors
/// See [`ExportError`].
pub fn glsl(scene: &Scene) -> Result<String, ExportError> {
    let mut source = body(scene)?;
    source += "
@fragment
fn pixel(@location(0) corner: vec2f, @location(1) size: vec2f, @location(2) angles: vec2f) -> @location(0) vec4f {
    return picture(corner, size, angles);
}
";
    let wrong = |e: &dyn std::fmt::Display| ExportError::Translation(e.to_string());
    let module = naga::front::wgsl::parse_str(&source).map_err(|e| wrong(&e))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|e| wrong(&e))?;
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
    shadertoy(scene.name(), &written).ok_or_else(|| wrong(&"the translation has an unknown form"))
}

/// Takes what Shadertoy gives itself out of a fragment shader, and puts its entry point in.
fn shadertoy(name: &str, written: &str) -> Option<String> {
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
    let mut text = format!(
        "// {}: a signed distance field, rendered by sphere tracing. Written by Zeroset.\n\
         // Paste this into the Image tab of shadertoy.com. Drag with the mouse to look around.\n",
        one_line(name)
    );
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
    fragColor = picture(corner, iResolution.xy, angles);
}
";
    Some(text)
}

fn one_line(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// Everything but entry points.
fn body(scene: &Scene) -> Result<String, ExportError> {
    let around = EnvironmentMap::renewed(None, scene);
    let parts = Parts::new(
        scene,
        &Limits::default(),
        FieldForm::Compiled,
        around.as_deref(),
        None,
    )?;
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
