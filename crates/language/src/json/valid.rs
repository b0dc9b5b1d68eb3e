//! What a scene's numbers may be: in whatever the language makes, in JSON that is read, and in a scene that is written.

use super::write::degrees_of;
use super::{Read, Step, problem};
use crate::draft::{LIGHTS, check_size};
use crate::limits::Limits;
use glam::Vec3;
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::light::{Light, Sky, Source};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::methods::{self, Choice, Param};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Occlusion, Settings};

/// Largest coordinate of a light or a gradient.
const FAR: f32 = 1e12;
/// Largest linear colour, intensity included.
const BRIGHT: f32 = 1e12;
/// Height of an orthographic view.
pub(super) const HEIGHT: (f32, f32) = (SMALL as f32, LARGE as f32);
/// How far the products of a camera's axes may be from those of right-angled ones.
pub(super) const UPRIGHT: f64 = 1e-3;
/// Objects, and materials, that a scene may have: they are numbered with 16 bits, from 1 on.
const MOST: usize = u16::MAX as usize;

/// Everything but the fields, which are valid since they were made.
pub(crate) fn scene(scene: &Scene, limits: &Limits) -> Read<()> {
    let in_list = |list: &'static str, i: usize| {
        move |p: Box<super::Problem>| p.within(Step::Index(i)).at(list)
    };
    let named = |name: &str| limits.check_name(name).map_err(|m| problem(m).at("name"));
    named(&scene.name)?;
    if scene.objects.len() > MOST {
        return Err(problem(format!("more than {MOST} objects")).at("objects"));
    }
    count_materials(scene.materials.len()).map_err(|p| p.at("materials"))?;
    count_lights(scene.lights.len()).map_err(|p| p.at("lights"))?;
    for (i, object) in scene.objects.iter().enumerate() {
        named(&object.name).map_err(in_list("objects", i))?;
        if usize::from(object.material) >= scene.materials.len() {
            let p = problem(format!("there is no material {}", object.material));
            return Err(in_list("objects", i)(p.at("material")));
        }
        let ao = object.occlusion.as_ref();
        ao.map_or(Ok(()), |ao| occlusion(ao, limits))
            .map_err(|p| in_list("objects", i)(p.at("ao")))?;
    }
    for (i, m) in scene.materials.iter().enumerate() {
        material(m).map_err(in_list("materials", i))?;
    }
    for (i, l) in scene.lights.iter().enumerate() {
        light(l).map_err(in_list("lights", i))?;
    }
    sky(&scene.sky).map_err(|p| p.at("sky"))?;
    camera(&scene.camera).map_err(|p| p.at("camera"))?;
    settings(&scene.settings, limits).map_err(|p| p.at("settings"))
}

/// Whether a scene may have this many materials.
pub(super) fn count_materials(n: usize) -> Read<()> {
    if n <= MOST {
        return Ok(());
    }
    Err(problem(format!(
        "{n} materials, at most {MOST} are allowed"
    )))
}

/// Whether a scene may have this many lights.
pub(super) fn count_lights(n: usize) -> Read<()> {
    if n <= LIGHTS {
        return Ok(());
    }
    Err(problem(format!("{n} lights, at most {LIGHTS} are allowed")))
}

fn camera(camera: &Camera) -> Read<()> {
    vector("eye", camera.eye, f32::MAX)?;
    let axes = camera.axes.as_dmat3();
    let error = axes * axes.transpose() - glam::DMat3::IDENTITY;
    // not a comparison that a number which is none would pass
    let upright = (error.to_cols_array().iter()).all(|e| e.abs() <= UPRIGHT);
    if !upright {
        let message = "the axes must have length 1 and be at right angles to each other";
        return Err(problem(message).at("axes"));
    }
    match camera.lens {
        Lens::Pinhole { fov } => {
            let degrees = degrees_of(fov);
            if !(1.0..=170.0).contains(&degrees) {
                let message = format!("this is {degrees} degrees, allowed is 1 to 170");
                return Err(problem(message).at("fov"));
            }
        }
        Lens::Orthographic { height } => number("height", height, HEIGHT.0, HEIGHT.1)?,
    }
    number("near", camera.near, 0.0, f32::MAX)?;
    number("far", camera.far, 0.0, f32::MAX)?;
    if camera.near < camera.far {
        Ok(())
    } else {
        Err(problem("`near` must be below `far`"))
    }
}

fn number(name: &str, x: f32, min: f32, max: f32) -> Read<()> {
    if (min..=max).contains(&x) {
        return Ok(());
    }
    let [x, min, max] = [x, min, max].map(said);
    Err(problem(format!("this is {x}, allowed is {min} to {max}")).at(name))
}

/// A number for people.
fn said(x: f32) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

fn count(name: &str, n: u32, min: u32, max: u32) -> Read<()> {
    if (min..=max).contains(&n) {
        return Ok(());
    }
    Err(problem(format!("this is {n}, allowed is {min} to {max}")).at(name))
}

fn vector(name: &str, v: Vec3, max: f32) -> Read<()> {
    v.to_array()
        .into_iter()
        .try_for_each(|x| number(name, x, -max, max))
}

fn colour(name: &str, v: Vec3) -> Read<()> {
    v.to_array()
        .into_iter()
        .try_for_each(|x| number(name, x, 0.0, BRIGHT))
}

fn direction(name: &str, v: Vec3) -> Read<()> {
    if v.is_finite() && (v.length() - 1.0).abs() < 1e-3 {
        return Ok(());
    }
    Err(problem("this must be a direction of length 1").at(name))
}

pub(super) fn material(material: &Material) -> Read<()> {
    pattern(&material.pattern).map_err(|p| p.at("pattern"))?;
    number("specular", material.specular, 0.0, 10.0)?;
    number("shininess", material.shininess, 1.0, 1e4)?;
    number("metallic", material.metallic, 0.0, 1.0)?;
    number("roughness", material.roughness, 0.0, 1.0)?;
    colour("emission", material.emission)
}

fn pattern(pattern: &Pattern) -> Read<()> {
    let colours = |list: &[Vec3]| list.iter().try_for_each(|c| colour("colours", *c));
    let scale = |x: f32| number("size", x, SMALL as f32, LARGE as f32);
    match pattern {
        Pattern::Solid { colour: c } => colour("colour", *c),
        Pattern::Checker { colours: c, size } => colours(c).and_then(|()| scale(*size)),
        Pattern::Stripes {
            colours: c,
            direction: d,
            size,
        } => {
            colours(c)?;
            direction("direction", *d)?;
            scale(*size)
        }
        Pattern::Noise {
            colours: c,
            size,
            octaves,
        } => {
            colours(c)?;
            scale(*size)?;
            count("octaves", *octaves, 1, 8)
        }
        Pattern::Gradient {
            colours: c,
            from,
            to,
        } => {
            colours(c)?;
            vector("from", *from, FAR)?;
            vector("to", *to, FAR)?;
            if from == to {
                Err(problem("`from` and `to` must differ"))
            } else {
                Ok(())
            }
        }
        Pattern::Triplanar {
            size, sharpness, ..
        } => {
            scale(*size)?;
            number("sharpness", *sharpness, 1.0, 64.0)
        }
        Pattern::Orbit { colours: c } => colours(c),
    }
}

pub(super) fn light(light: &Light) -> Read<()> {
    match light.source {
        Source::Directional { direction: d } => {
            direction("direction", d).map_err(|p| p.at("source"))?
        }
        Source::Point { position } => {
            vector("position", position, FAR).map_err(|p| p.at("source"))?
        }
    }
    colour("radiance", light.radiance)?;
    // a shadow takes no samples
    method(&light.shadow, u64::MAX).map_err(|p| p.at("shadow"))
}

pub(super) fn sky(sky: &Sky) -> Read<()> {
    colour("top", sky.top)?;
    colour("horizon", sky.horizon)?;
    colour("bottom", sky.bottom)?;
    number("ambient", sky.ambient, 0.0, 10.0)
}

pub(super) fn occlusion(occlusion: &Occlusion, limits: &Limits) -> Read<()> {
    method(occlusion, limits.samples)
}

/// Whether the numbers of a method are what the registry allows, and its samples at most so many.
fn method<T: Choice>(chosen: &T, samples: u64) -> Read<()> {
    (chosen.check(samples)).map_err(|(param, refused)| problem(format!("this {refused}")).at(param))
}

/// Whether a number of the settings is what is allowed.
fn setting(param: Param, value: methods::Value) -> Read<()> {
    (param.check(value)).map_err(|refused| problem(format!("this {refused}")).at(param.name))
}

pub(super) fn settings(settings: &Settings, limits: &Limits) -> Read<()> {
    use methods::Value::{Real, Whole};
    check_size(settings.size, limits).map_err(|m| problem(m).at("size"))?;
    method(&settings.march, limits.samples).map_err(|p| p.at("march"))?;
    setting(Settings::MAX_STEPS, Whole(settings.max_steps))?;
    let reduction = Whole(settings.discontinuity_reduction);
    setting(Settings::DISCONTINUITY_REDUCTION, reduction)?;
    setting(Settings::FOOTPRINT, Real(settings.footprint))?;
    setting(Settings::EXPOSURE, Real(settings.exposure))?;
    occlusion(&settings.occlusion, limits).map_err(|p| p.at("occlusion"))?;
    method(&settings.antialias, limits.samples).map_err(|p| p.at("antialias"))
}
