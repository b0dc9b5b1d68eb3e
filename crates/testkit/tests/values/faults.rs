//! Planted faults that the checks must notice.

use crate::{check_named, on};
use glam::Vec3;
use std::sync::Arc;
use zeroset::field::formula::ColourFormula;
use zeroset::gpu::testing;
use zeroset::scene::accumulator::Accumulator;
use zeroset::scene::light::Source;
use zeroset::scene::material::{Image, Pattern};
use zeroset::scene::methods::{Choice, Value};
use zeroset::scene::render::Silent;
use zeroset::scene::scene::{Scene, SceneParts};
use zeroset::scene::settings::{Antialias, Filter, Shadow};
use zeroset::trace::CpuRenderer;

fn patterns(scene: &mut SceneParts, edit: impl Fn(&mut Pattern)) {
    scene
        .materials
        .iter_mut()
        .for_each(|m| edit(&mut m.pattern));
}

fn inside_out(scene: &mut SceneParts) {
    patterns(scene, |pattern| match pattern {
        Pattern::Checker { colours, .. }
        | Pattern::Stripes { colours, .. }
        | Pattern::Gradient { colours, .. }
        | Pattern::Noise { colours, .. } => colours.swap(0, 1),
        Pattern::Orbit { colours } => colours.swap(2, 3),
        _ => {}
    });
}

/// Formulas whose red is another's blue.
fn exchanged(scene: &mut SceneParts) {
    patterns(scene, |pattern| {
        if let Pattern::Formula { formula } = pattern {
            let (steps, fields) = (formula.steps().to_vec(), formula.fields().to_vec());
            let [red, green, blue] = formula.results();
            let other = ColourFormula::of_steps(steps, fields, [blue, green, red]);
            *formula = Arc::new(other.expect("the same steps"));
        }
    });
}

fn images(scene: &mut SceneParts, edit: impl Fn(&mut Image)) {
    patterns(scene, |pattern| {
        if let Pattern::Triplanar { image, .. } = pattern {
            edit(Arc::make_mut(image));
        }
    });
}

fn mirrored(image: &mut Image) {
    let width = image.width as usize;
    image.pixels.chunks_mut(width).for_each(<[Vec3]>::reverse);
}

fn upside_down(image: &mut Image) {
    image.pixels.reverse();
    mirrored(image);
}

/// As if its numbers were linear light already.
fn undecoded(image: &mut Image) {
    let coded = |x: f32| zeroset::output::tone::encode(x);
    for p in &mut image.pixels {
        *p = Vec3::from(p.to_array().map(coded));
    }
}

fn with_octaves(scene: &mut SceneParts, more: u32) {
    patterns(scene, |pattern| {
        if let Pattern::Noise { octaves, .. } = pattern {
            *octaves += more;
        }
    });
}

fn with_filter(scene: &mut SceneParts, other: Filter) {
    if let Antialias::Supersample { filter, .. } = &mut scene.settings.antialias {
        *filter = other;
    }
}

fn skylight(scene: &mut SceneParts, param: &str, times: f32) {
    let method = &mut scene.settings.occlusion;
    if let Some(Value::Real(x)) = method.get(param) {
        method.put(param, Value::Real(x * times));
    }
}

fn advected(scene: &mut SceneParts, param: &str, times: f32) {
    let method = &mut scene.lights[0].shadow;
    if let Some(Value::Real(x)) = method.get(param) {
        let allowed = if param == "spread" { 1.0 } else { 8.0 };
        method.put(param, Value::Real((x * times).min(allowed)));
    }
}

/// What is wrong, how, and the check that must notice.
type SceneFault = (&'static str, fn(&mut SceneParts), &'static str);

/// Faults of renderers that a changed scene stands for.
const IN_SCENES: [SceneFault; 23] = [
    ("red and blue exchanged", exchanged, "a colour by a formula"),
    ("checkers inside out", inside_out, "checker"),
    ("stripes inside out", inside_out, "stripes"),
    ("stripes inside out", inside_out, "slanted stripes"),
    ("gradients from end to start", inside_out, "gradient"),
    ("noise inside out", inside_out, "noise"),
    ("an octave too many", |s| with_octaves(s, 1), "noise"),
    ("y and z taken for each other", inside_out, "orbit"),
    (
        "mirrored images",
        |s| images(s, mirrored),
        "an image on six faces",
    ),
    (
        "mirrored images",
        |s| images(s, mirrored),
        "an image on a ball",
    ),
    (
        "images upside down",
        |s| images(s, upside_down),
        "an image on six faces",
    ),
    (
        "images taken for linear",
        |s| images(s, undecoded),
        "an image on six faces",
    ),
    (
        "images taken for linear",
        |s| images(s, undecoded),
        "an image of one colour",
    ),
    (
        "a sky upside down",
        |s| std::mem::swap(&mut s.sky.top, &mut s.sky.bottom),
        "the sky through a pinhole",
    ),
    (
        "a sky upside down",
        |s| std::mem::swap(&mut s.sky.top, &mut s.sky.bottom),
        "ambient light",
    ),
    (
        "a lamp elsewhere",
        |s| {
            for light in &mut s.lights {
                if let Source::Point { position } = &mut light.source {
                    position.x += 0.05;
                }
            }
        },
        "Phong's light",
    ),
    (
        "a highlight that is too sharp",
        |s| s.materials.iter_mut().for_each(|m| m.shininess *= 1.1),
        "Phong's light",
    ),
    (
        "a hard shadow from elsewhere",
        |s| {
            if let Source::Directional { direction } = &mut s.lights[0].source {
                direction.z = -direction.z;
            }
        },
        "a hard shadow of the sun",
    ),
    (
        "a softer shadow",
        |s| s.lights[0].shadow = Shadow::SoftClosest { sharpness: 1.8 },
        "a soft shadow without bands",
    ),
    (
        "a box for a tent",
        |s| with_filter(s, Filter::Box),
        "the tent filter",
    ),
    (
        "a tent for Mitchell's",
        |s| with_filter(s, Filter::Tent),
        "Mitchell's filter",
    ),
    (
        "a camera a tenth of a pixel aside",
        |s| s.camera.eye += 0.0125 * s.camera.axes.x_axis,
        "balls in parallel rays",
    ),
    (
        "a camera that is upside down",
        |s| s.camera.axes.y_axis = -s.camera.axes.y_axis,
        "the sky through a pinhole",
    ),
];

/// The same, of skylight.
const SKYLIGHT_IN_SCENES: [SceneFault; 3] = [
    (
        "skylight that is too strong",
        |s| skylight(s, "strength", 1.03),
        "skylight under a ball",
    ),
    (
        "a way that bends too far",
        |s| skylight(s, "bend", 1.1),
        "where skylight comes from",
    ),
    (
        "colours that count for more",
        |s| skylight(s, "bleed", 1.05),
        "light beside a red wall",
    ),
];

/// The same, of light that flows.
const FLOW_IN_SCENES: [SceneFault; 3] = [
    (
        "light that is blurred too much",
        |s| advected(s, "spread", 1.5),
        "the edge of a shadow that flowed",
    ),
    (
        "light that is read farther from the floor",
        |s| advected(s, "bias", 6.0),
        "the edge of a shadow that flowed",
    ),
    (
        "light that is read within the surface",
        |s| advected(s, "bias", 0.2),
        "a ball in light that flows",
    ),
];

#[test]
fn faults_of_light_that_flows_in_scenes_are_noticed() {
    noticed_in_scenes(&FLOW_IN_SCENES);
}

#[test]
fn faults_in_scenes_are_noticed() {
    noticed_in_scenes(&IN_SCENES);
}

#[test]
fn faults_of_skylight_in_scenes_are_noticed() {
    noticed_in_scenes(&SKYLIGHT_IN_SCENES);
}

fn noticed_in_scenes(faults: &[SceneFault]) {
    let renderer = CpuRenderer::new(None).unwrap();
    for &(what, edit, name) in faults {
        let draw = |scene: &Scene| {
            let mut scene = scene.clone();
            scene.edit(edit).expect("a scene");
            on(&renderer, &scene)
        };
        assert!(
            (check_named(name).run)(&draw).is_err(),
            "{what} went unnoticed by {name}"
        );
    }
}

/// What is wrong, in the text of which shader how, and the check that must notice.
type ShaderFault = (&'static str, &'static str, &'static str, &'static str);

/// Faults of shaders. Formulas are recorded from those of the CPU:
/// these faults are in how shaders call them, or in their numbers.
const IN_SHADERS: [ShaderFault; 48] = [
    (
        "a closest place behind the second sample",
        "closest_shadow(f, z, r, t, sharpness)",
        "closest_shadow(f, z, r, t + f, sharpness)",
        "a soft shadow without bands",
    ),
    (
        "soft shadows that are too soft",
        "soft_shadow(f, t, sharpness)",
        "soft_shadow(0.8 * f, t, sharpness)",
        "a soft shadow",
    ),
    (
        "patterns inside out",
        "vec4f(1.0 - second, second, 0.0, 0.0)",
        "vec4f(second, 1.0 - second, 0.0, 0.0)",
        "checker",
    ),
    (
        "checkers that flicker far away",
        "pattern_checker(at.point, at.normal, at.width,",
        "pattern_checker(at.point, at.normal, 0.0,",
        "fine patterns become their mean",
    ),
    (
        "patterns inside out",
        "vec4f(1.0 - second, second, 0.0, 0.0)",
        "vec4f(second, 1.0 - second, 0.0, 0.0)",
        "stripes",
    ),
    (
        "gradients that run on",
        "pattern_gradient(at.point, part.start, part.end)",
        "dot(at.point - part.start, part.end - part.start) / dot(part.end - part.start, part.end - part.start)",
        "gradient",
    ),
    (
        "octaves that do not fade",
        "pattern_noise(at.point, at.normal, at.width,",
        "pattern_noise(at.point, at.normal, 0.0,",
        "noise",
    ),
    (
        "octaves that do not fade",
        "pattern_noise(at.point, at.normal, at.width,",
        "pattern_noise(at.point, at.normal, 0.0,",
        "fine patterns become their mean",
    ),
    (
        "patterns that stay in the world",
        "let point = vec3f(p[0].x, p[1].x, p[2].x);",
        "let point = at.point;",
        "a pattern goes where its shape goes",
    ),
    (
        "patterns of another copy",
        "field_place(u32(m.place), at.point)",
        "field_place(1u, at.point)",
        "copies around an axis carry the pattern",
    ),
    (
        "patterns in patterns that are not turned",
        "let point = vec3f(dot(part.x, at.point), dot(part.y, at.point), dot(part.z, at.point)) + offset;",
        "let point = at.point + offset;",
        "patterns in patterns, turned and stretched",
    ),
    (
        "an outer pattern in the place of its inner one",
        "shares[u32(part.instead_b)] = inks.y;",
        "shares[u32(part.instead_b)] = inks.x;",
        "patterns in patterns, turned and stretched",
    ),
    (
        "roughness for metal",
        "finish.z = saturate(",
        "finish.y = saturate(",
        "a pattern of numbers",
    ),
    (
        "dents for bumps",
        "(m.depth / (step * scale))",
        "(-m.depth / (step * scale))",
        "an even slope",
    ),
    (
        "bumps that grow with their things",
        "(m.depth / (step * scale))",
        "(m.depth / step)",
        "an even slope",
    ),
    (
        "images mirrored along z",
        "projection(at.point, at.normal,",
        "projection(at.point * vec3f(1.0, 1.0, -1.0), at.normal,",
        "an image on six faces",
    ),
    (
        "images mirrored from behind",
        "projection(at.point, at.normal,",
        "projection(at.point, vec3f(at.normal.xy, abs(at.normal.z)),",
        "an image on six faces",
    ),
    (
        "images mirrored from below",
        "projection(at.point, at.normal,",
        "projection(at.point, vec3f(at.normal.x, abs(at.normal.y), at.normal.z),",
        "an image on six faces",
    ),
    (
        "images a pixel aside",
        "m.height) - 0.5;",
        "m.height) + 0.5;",
        "an image on six faces",
    ),
    (
        "traps that all count alike",
        "pattern_orbit(at.orbit)",
        "pattern_orbit(vec4f(1.0))",
        "orbit",
    ),
    (
        "a sky that changes evenly",
        "frame.sky_bottom, d.y)",
        "frame.sky_bottom, d.y * abs(d.y))",
        "the sky through a pinhole",
    ),
    (
        "a sky upside down",
        "frame.sky_top, frame.sky_bottom, d.y)",
        "frame.sky_bottom, frame.sky_top, d.y)",
        "the sky in parallel rays",
    ),
    (
        "ambient light by the mirror image of the normal",
        "seen.open, seen.tint, seen.bent,",
        "seen.open, seen.tint, -seen.bent,",
        "ambient light",
    ),
    (
        "a lamp that falls off with its distance",
        "light_response(to.xyz, to.w,",
        "light_response(to.xyz, sqrt(to.w),",
        "Lambert's light",
    ),
    (
        "Lambert's law without pi",
        "light.radiance * (answer.x * power)",
        "light.radiance * (3.1415927 * answer.x * power)",
        "Lambert's light",
    ),
    (
        "half a vector towards nobody",
        "what.normal, at.direction, light_finish(what))",
        "what.normal, -at.direction, light_finish(what))",
        "Phong's light",
    ),
    (
        "plastic that mirrors as glass that is not there",
        " * 0.16f",
        " * 0.0f",
        "mirrors",
    ),
    (
        "Fresnel's law for a ray on the other side",
        "select(body.ior, 1.0 / body.ior, inside)",
        "select(1.0 / body.ior, body.ior, inside)",
        "a ball of glass",
    ),
    (
        "a border that lets through what it reflects",
        "clear * (1.0 - met.w)",
        "clear * met.w",
        "a ball of glass",
    ),
    (
        "light that loses nothing inside",
        "weight *= transmittance(body.attenuation, t);",
        "weight *= transmittance(body.attenuation, 0.5 * t);",
        "what a tint leaves",
    ),
    (
        "a clear block without an end where it stands",
        "march_side = select(1.0, -1.0, path.medium >= 0.0);",
        "march_side = 1.0;",
        "a clear block on a table",
    ),
    (
        "a reflection that is met twice",
        "clamped(path.weight * found.colour)",
        "clamped(2.0 * path.weight * found.colour)",
        "what a mirror shows",
    ),
    (
        "ways that end at random without the others making up for it",
        "weight /= chance;",
        "",
        "a closed room that glows",
    ),
    (
        "one surface too many",
        "path.bounces.x + 1u >= frame.depth",
        "path.bounces.x >= frame.depth",
        "a closed room that glows",
    ),
    (
        "a sun that is seen half as bright as it shines",
        "disc_power(cosine)",
        "0.5 * disc_power(cosine)",
        "the sun through a pane",
    ),
    (
        "a sun that shines from its middle alone",
        "return vec4f(cone_around(to.xyz, light_width(light.sharpness), u), to.w);",
        "return to;",
        "the penumbra of a wide sun",
    ),
    (
        "mirrors on the other side",
        "let ior = select(body.ior, 1.0 / body.ior, inside);",
        "let ior = select(1.0 / body.ior, body.ior, inside);",
        "a ball of glass, one way of many",
    ),
    (
        "light that counts more than it may",
        "frame.clamp / max(",
        "2.0 * frame.clamp / max(",
        "clamped light",
    ),
    (
        "mirrors that hide nothing of each other",
        "answer.y * power * shone",
        "1.3 * answer.y * power * shone",
        "highlights of small mirrors",
    ),
    (
        "a filter without its negative parts",
        "(-2.3333333f)",
        "(-2.0f)",
        "Mitchell's filter",
    ),
    (
        "a lens that is focused nearer",
        "let nearer = 1.0 / frame.focus;",
        "let nearer = 1.3 / frame.focus;",
        "circles of confusion through a lens",
    ),
    (
        "a lens half as wide",
        "LENS_DECISION)) * frame.aperture);",
        "LENS_DECISION)) * 0.5 * frame.aperture);",
        "circles of confusion of a lens with parallel rays",
    ),
    (
        "a lamp that sends as much aslant as straight on",
        "falloff = sheet_falloff(lamp.right, lamp.up, ray.xyz, ray.w);",
        "falloff = 1.0 / (ray.w * ray.w);",
        "a disc of light over a floor",
    ),
    (
        "a sphere of light that is looked for as if it were its middle",
        "falloff = seen_sphere(lamp.place, lamp.radius, origin);",
        "falloff = 1.0 / dot(lamp.place - origin, lamp.place - origin);",
        "a sphere of light over a floor",
    ),
    (
        "the density of the other end",
        "counted.x * balance(found, scattered.x)",
        "counted.x * balance(scattered.x, found)",
        "a lamp that rays meet",
    ),
    (
        "a lamp that counts from both ends",
        "counts = balance(path.density, lamp_density(met.y, lamp.area));",
        "counts = 1.0;",
        "a lamp that rays meet",
    ),
    (
        "half a rectangle",
        "var on = u * 2.0 - 1.0;",
        "var on = u;",
        "a rectangle of light over a floor",
    ),
    (
        "parallel rays that spread",
        "frame.right, frame.up, frame.eye), -frame.back, 1.0, 0.0);",
        "frame.right, frame.up, frame.eye), normalize(0.1 * (frame.right * q.x + frame.up * q.y) - frame.back), 1.0, 0.0);",
        "balls in parallel rays",
    ),
];

/// The same, of skylight.
const SKYLIGHT_IN_SHADERS: [ShaderFault; 8] = [
    (
        "ridges for creases",
        "skylight_curved(off *",
        "skylight_curved(-off *",
        "curvature in a corner",
    ),
    (
        "samples of the finest mip alone",
        "volume_sample(volume.grid + f32(level), volume.cells * finer + 1.0, place * finer)",
        "volume_sample(volume.grid, volume.cells + 1.0, place)",
        "skylight under a ball",
    ),
    (
        "a volume half a voxel aside",
        "(p - volume.origin) / volume.voxel",
        "(p - volume.origin) / volume.voxel - 0.5",
        "skylight under a ball",
    ),
    (
        "distances that do not double",
        "far *= 2.0;\n    }\n    let seen",
        "far += how.reach;\n    }\n    let seen",
        "skylight under a ball",
    ),
    (
        "nodes that are mixed up",
        "rows[1] - rows[0]) * t.y",
        "rows[1] - rows[0]) * t.z",
        "skylight under a ball",
    ),
    (
        "a field that is not read where the volume ends",
        "f = mix(around(at, p), f, share);",
        "",
        "skylight where its volume ends",
    ),
    (
        "blue light beside a red wall",
        "sums[k] +=",
        "sums[2u - k] +=",
        "light beside a red wall",
    ),
    (
        "a sky behind the wall",
        "skylight_bent(at.normal, way), seen.xyz",
        "at.normal, seen.xyz",
        "where skylight comes from",
    ),
];

/// The same, of light that flows.
const FLOW_IN_SHADERS: [ShaderFault; 3] = [
    (
        "light half a voxel aside",
        "(p - volume.origin) / volume.voxel",
        "(p - volume.origin) / volume.voxel - 0.5",
        "the edge of a shadow that flowed",
    ),
    (
        "no shadow beyond the volume",
        "if (t < 0.0 || t * volume.voxel > distance)",
        "if (t != 0.0)",
        "a shadow beyond its volume",
    ),
    (
        "light that is read on the surface itself",
        "at.point + at.normal * light.sharpness",
        "at.point",
        "a ball in light that flows",
    ),
];

#[test]
fn faults_of_light_that_flows_in_shaders_are_noticed() {
    noticed_in_shaders(&FLOW_IN_SHADERS);
}

#[test]
fn faults_in_shaders_are_noticed() {
    noticed_in_shaders(&IN_SHADERS);
}

#[test]
fn faults_of_skylight_in_shaders_are_noticed() {
    noticed_in_shaders(&SKYLIGHT_IN_SHADERS);
}

fn noticed_in_shaders(faults: &[ShaderFault]) {
    let Some(gpu) = testing::renderer("planted faults against known values") else {
        return;
    };
    for &(what, from, to, name) in faults {
        let planted = std::cell::Cell::new(false);
        let draw = |scene: &Scene| {
            let mut job = gpu.job(scene).expect("a job");
            planted.set(planted.get() || job.source.contains(from));
            job.source = job.source.replace(from, to).into();
            let settings = scene.settings();
            let mut sums = Accumulator::new(
                settings.size,
                settings.antialias,
                &zeroset::scene::film::Plane::ALL,
            );
            let samples = 0..sums.wanted();
            gpu.sample(&job, samples, &mut sums, &Silent)
                .expect("a picture");
            sums.into_film()
        };
        let noticed = (check_named(name).run)(&draw).is_err();
        assert!(planted.get(), "no `{from}` in a shader of {name}");
        assert!(noticed, "{what} went unnoticed by {name}");
    }
}
