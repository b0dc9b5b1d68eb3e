//! Planted faults that the checks must notice.

use crate::{check_named, on};
use glam::Vec3;
use std::sync::Arc;
use zeroset::gpu::testing;
use zeroset::scene::film::Film;
use zeroset::scene::light::Source;
use zeroset::scene::material::{Image, Pattern};
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
    if let Antialias::Supersample { filter, .. } = &mut scene.settings().antialias {
        *filter = other;
    }
}

/// What is wrong, how, and the check that must notice.
type SceneFault = (&'static str, fn(&mut SceneParts), &'static str);

/// Faults of renderers that a changed scene stands for.
const IN_SCENES: [SceneFault; 22] = [
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

#[test]
fn faults_in_scenes_are_noticed() {
    let renderer = CpuRenderer::new(None).unwrap();
    for (what, edit, name) in IN_SCENES {
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
const IN_SHADERS: [(&str, &str, &str, &str); 22] = [
    (
        "a closest place behind the second sample",
        "max(t - before, 1e-20)",
        "max(t + before, 1e-20)",
        "a soft shadow without bands",
    ),
    (
        "soft shadows that are too soft",
        "return f / max(t, 1e-20);",
        "return 0.8 * f / max(t, 1e-20);",
        "a soft shadow",
    ),
    (
        "checkers inside out",
        "0.5 * even + 0.5",
        "0.5 - 0.5 * even",
        "checker",
    ),
    (
        "checkers that flicker far away",
        "let w = at.footprint / m.size;",
        "let w = 0.0 * at.footprint;",
        "fine patterns become their mean",
    ),
    (
        "stripes inside out",
        "0.5 * square_wave(p, w) + 0.5",
        "0.5 - 0.5 * square_wave(p, w)",
        "stripes",
    ),
    (
        "gradients that run on",
        "clamp(t, 0.0, 1.0)",
        "t",
        "gradient",
    ),
    (
        "octaves that do not fade",
        "clamp(1.0 - 2.0 * w, 0.0, 1.0)",
        "1.0",
        "noise",
    ),
    (
        "octaves that do not fade",
        "clamp(1.0 - 2.0 * w, 0.0, 1.0)",
        "1.0",
        "fine patterns become their mean",
    ),
    (
        "images mirrored along x",
        "-p.z * outwards.x",
        "p.z * outwards.x",
        "an image on six faces",
    ),
    (
        "images mirrored from behind",
        "p.x * outwards.z",
        "p.x",
        "an image on six faces",
    ),
    (
        "images mirrored from below",
        "p.z * outwards.y",
        "p.z",
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
        "1.0 / (at.orbit * at.orbit + TRAP * TRAP)",
        "vec4f(1.0)",
        "orbit",
    ),
    (
        "a sky that changes evenly",
        "sqrt(min(abs(y), 1.0))",
        "min(abs(y), 1.0)",
        "the sky through a pinhole",
    ),
    (
        "a sky upside down",
        "select(frame.sky_top, frame.sky_bottom, y < 0.0)",
        "select(frame.sky_bottom, frame.sky_top, y < 0.0)",
        "the sky in parallel rays",
    ),
    (
        "ambient light by the mirror image of the normal",
        "rise * (0.5 * y + 0.5)",
        "rise * (0.5 - 0.5 * y)",
        "ambient light",
    ),
    (
        "a lamp that falls off with its distance",
        "1.0 / max(distance * distance, 1e-12)",
        "1.0 / max(distance, 1e-12)",
        "Lambert's light",
    ),
    (
        "Lambert's law without pi",
        "const DIFFUSE_SCALE: f32 = 0.31830987;",
        "const DIFFUSE_SCALE: f32 = 1.0;",
        "Lambert's light",
    ),
    (
        "half a vector towards nobody",
        "let half = to - at.direction;",
        "let half = to + at.direction;",
        "Phong's light",
    ),
    (
        "Fresnel's law with the wrong power",
        "pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0)",
        "pow(1.0 - clamp(cosine, 0.0, 1.0), 2.0)",
        "mirrors",
    ),
    (
        "a filter without its negative parts",
        "(d * (-7.0 / 3.0) + 12.0)",
        "(d * (-6.0 / 3.0) + 12.0)",
        "Mitchell's filter",
    ),
    (
        "parallel rays that spread",
        "return Ray(frame.eye + across, -frame.back);",
        "return Ray(frame.eye + across, normalize(0.1 * across - frame.back));",
        "balls in parallel rays",
    ),
];

#[test]
fn faults_in_shaders_are_noticed() {
    let Some(gpu) = testing::renderer("planted faults against known values") else {
        return;
    };
    for (what, from, to, name) in IN_SHADERS {
        let planted = std::cell::Cell::new(false);
        let draw = |scene: &Scene| {
            let mut job = gpu.job(scene).expect("a job");
            planted.set(planted.get() || job.source.contains(from));
            job.source = job.source.replace(from, to).into();
            let settings = scene.settings();
            let mut sums = Accumulator::new(settings.size, settings.antialias, &Plane::ALL);
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
