//! What a scene's numbers may be. [`Scene::new`](crate::scene::Scene::new) asks all of it; whoever reads a part of a scene,
//! such as a file format, can ask for that part alone and knows where it stands.

mod fault;
mod methods;

pub use fault::{Fault, PathStep, SceneError};
pub use methods::{antialias, integrator, march, occlusion, shadow};

use crate::camera::{Camera, Lens};
use crate::environment::{self, Environment, Surroundings};
use crate::light::{Fog, Light, Sky, Source};
use crate::material::{Image, Ink, Material, Pattern};
use crate::methods::Value::{Real, Whole};
use crate::scene::{MOMENTS, SceneParts};
use crate::settings::Settings;
use glam::{DMat3, DVec3, Vec3};
use methods::setting;
use zeroset_catalogue::{Dimension, LARGE, SMALL};

/// What a check says.
pub type Checked = Result<(), SceneError>;

/// Largest coordinate of a light or a gradient.
pub const FAR: f32 = 1e12;
/// Largest linear colour, intensity included.
const BRIGHT: f32 = 1e12;
/// Smallest and largest height of an orthographic view, scene units.
pub const HEIGHT: (f32, f32) = (SMALL as f32, LARGE as f32);
/// How far the products of a camera's axes may be from those of right-angled ones of length 1.
pub const UPRIGHT: f64 = 1e-3;
/// Most objects, and most materials, of a scene: they are numbered with 16 bits, from 1 on.
pub const OBJECTS: usize = u16::MAX as usize;
/// Most lights of a scene.
pub const LIGHTS: usize = 64;
/// Most rays that sample one thing: a pixel, an occlusion.
pub const SAMPLES: u32 = 1 << 20;
/// Most pixels of a picture.
pub const PIXELS: u64 = 1 << 32;

/// Everything.
pub(crate) fn parts(scene: &SceneParts) -> Checked {
    if scene.objects.len() > OBJECTS {
        let fault = Fault::Objects {
            given: scene.objects.len(),
        };
        return Err(SceneError::new(fault).at("objects"));
    }
    count_materials(scene.materials.len()).map_err(|e| e.at("materials"))?;
    count_lights(scene.lights.len()).map_err(|e| e.at("lights"))?;
    for (i, object) in scene.objects.iter().enumerate() {
        let in_list = |e: SceneError| e.index(i).at("objects");
        let count = scene.materials.len();
        let exists = |number: u16| {
            if usize::from(number) < count {
                return Ok(());
            }
            Err(SceneError::new(Fault::Material { number, count }))
        };
        exists(object.material).map_err(|e| in_list(e.at("material")))?;
        let facts = object.field.facts();
        if let Some(highest) = facts.materials.checked_sub(1) {
            exists(highest.min(u32::from(u16::MAX)) as u16).map_err(|e| in_list(e.at("field")))?;
        }
        if facts.dimension == Dimension::Two {
            return Err(in_list(SceneError::new(Fault::Plane).at("field")));
        }
        let own = object.occlusion.as_ref();
        own.map_or(Ok(()), |ao| occlusion(ao, SAMPLES))
            .map_err(|e| in_list(e.at("ao")))?;
    }
    for (i, m) in scene.materials.iter().enumerate() {
        let in_list = |e: SceneError| e.index(i).at("materials");
        material(m).map_err(in_list)?;
        for (name, pattern) in m.patterns() {
            for part in pattern.parts() {
                if let Pattern::Triplanar { image: i, .. } = part {
                    image(i).map_err(|e| in_list(e.at("image").at(name)))?;
                }
            }
        }
    }
    for (i, l) in scene.lights.iter().enumerate() {
        light(l).map_err(|e| e.index(i).at("lights"))?;
    }
    sky(&scene.sky).map_err(|e| e.at("sky"))?;
    let around = scene.environment.as_ref();
    around.map_or(Ok(()), |e| environment(e).map_err(|e| e.at("environment")))?;
    camera(&scene.camera).map_err(|e| e.at("camera"))?;
    settings(&scene.settings, SAMPLES).map_err(|e| e.at("settings"))
}

/// Whether a scene may have this many materials: [`OBJECTS`] at most.
///
/// # Errors
/// Too many.
pub fn count_materials(given: usize) -> Checked {
    count_of("materials", given, OBJECTS)
}

/// Whether a scene may have this many lights: [`LIGHTS`] at most.
///
/// # Errors
/// Too many.
pub fn count_lights(given: usize) -> Checked {
    count_of("lights", given, LIGHTS)
}

/// Whether a scene may have this many moments: [`MOMENTS`] at most.
///
/// # Errors
/// Too many.
pub fn count_moments(given: usize) -> Checked {
    count_of("moments", given, MOMENTS as usize)
}

fn count_of(what: &'static str, given: usize, most: usize) -> Checked {
    if given <= most {
        return Ok(());
    }
    Err(SceneError::new(Fault::Many { what, given, most }))
}

/// Whether a picture may have this width and height: at least 1 pixel each, and [`PIXELS`] at most.
///
/// # Errors
/// What the size is.
pub fn size([width, height]: [u32; 2]) -> Checked {
    if width > 0 && height > 0 && u64::from(width) * u64::from(height) <= PIXELS {
        return Ok(());
    }
    Err(SceneError::new(Fault::Size { width, height }))
}

/// Whether a camera sees: axes at right angles, a field of view of 1 to 170 degrees, `near` below `far`, a focus before it where its
/// lens has an aperture.
///
/// # Errors
/// Which number is wrong.
pub fn camera(camera: &Camera) -> Checked {
    vector("eye", camera.eye, f32::MAX)?;
    let axes = camera.axes.as_dmat3();
    let error = axes * axes.transpose() - glam::DMat3::IDENTITY;
    // not a comparison that a number which is none would pass
    let upright = (error.to_cols_array().iter()).all(|e| e.abs() <= UPRIGHT);
    if !upright {
        return Err(SceneError::new(Fault::Axes).at("axes"));
    }
    match camera.lens {
        Lens::Pinhole { fov } => {
            let degrees = crate::camera::degrees_of(fov);
            if !(1.0..=170.0).contains(&degrees) {
                return Err(SceneError::new(Fault::FieldOfView { degrees }).at("fov"));
            }
        }
        Lens::Orthographic { height } => number("height", height, HEIGHT.0, HEIGHT.1)?,
    }
    number("near", camera.near, 0.0, f32::MAX)?;
    number("far", camera.far, 0.0, f32::MAX)?;
    number("aperture", camera.aperture, 0.0, LARGE as f32)?;
    if camera.aperture > 0.0 {
        number("focus", camera.focus, SMALL as f32, FAR)?;
    } else {
        number("focus", camera.focus, 0.0, FAR)?;
    }
    if camera.near < camera.far {
        return Ok(());
    }
    Err(SceneError::new(Fault::Range))
}

fn number(name: &'static str, value: f32, min: f32, max: f32) -> Checked {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(SceneError::new(Fault::Number { value, min, max }).at(name))
}

fn count(name: &'static str, value: u32, min: u32, max: u32) -> Checked {
    if (min..=max).contains(&value) {
        return Ok(());
    }
    Err(SceneError::new(Fault::Count { value, min, max }).at(name))
}

fn vector(name: &'static str, v: Vec3, max: f32) -> Checked {
    v.to_array()
        .into_iter()
        .try_for_each(|x| number(name, x, -max, max))
}

fn colour(name: &'static str, v: Vec3) -> Checked {
    v.to_array()
        .into_iter()
        .try_for_each(|x| number(name, x, 0.0, BRIGHT))
}

fn direction(name: &'static str, value: Vec3) -> Checked {
    if value.is_finite() && (value.length() - 1.0).abs() < 1e-3 {
        return Ok(());
    }
    Err(SceneError::new(Fault::Direction { value }).at(name))
}

/// Whether a material's numbers are in their ranges. Its image, if it has one, is asked for on its own: see [`image`].
///
/// # Errors
/// Which number is wrong.
pub fn material(material: &Material) -> Checked {
    for (name, whole) in material.patterns() {
        pattern(whole).map_err(|e| e.at(name))?;
    }
    if let Some(bump) = &material.bump {
        number("depth", bump.depth, -(LARGE as f32), LARGE as f32).map_err(|e| e.at("bump"))?;
    }
    number("specular", material.specular, 0.0, 10.0)?;
    number("shininess", material.shininess, 1.0, 1e4)?;
    number("metallic", material.metallic, 0.0, 1.0)?;
    number("roughness", material.roughness, 0.0, 1.0)?;
    number("transmission", material.transmission, 0.0, 1.0)?;
    number("ior", material.ior, 1.0, 4.0)?;
    colour("attenuation", material.attenuation)?;
    colour("emission", material.emission)
}

/// Whether an image has at least a pixel, and as many as its width and height say. Their values are not looked at.
///
/// # Errors
/// What it has.
pub fn image(image: &Image) -> Checked {
    let (width, height, pixels) = (image.width, image.height, image.pixels.len());
    if width > 0 && height > 0 && u64::from(width) * u64::from(height) == pixels as u64 {
        return Ok(());
    }
    Err(SceneError::new(Fault::Image {
        width,
        height,
        pixels,
    }))
}

fn pattern(whole: &Pattern) -> Checked {
    // asked for first: what is too deep is not gone down
    let parts: Vec<&Pattern> = whole.parts().take(Pattern::MOST + 1).collect();
    count("parts", parts.len() as u32, 1, Pattern::MOST as u32)?;
    parts.into_iter().try_for_each(pattern_part)?;
    placements(whole, DMat3::IDENTITY, DVec3::ZERO)
}

/// Whether patterns that were placed several times, or within others, are still where numbers are: `rows` and `offset` lead to `pattern`.
fn placements(pattern: &Pattern, rows: DMat3, offset: DVec3) -> Checked {
    if let Pattern::Placed {
        pattern,
        rows: own,
        offset: by,
    } = pattern
    {
        let own =
            DMat3::from_cols(own[0].as_dvec3(), own[1].as_dvec3(), own[2].as_dvec3()).transpose();
        let (rows, offset) = (own * rows, own * offset + by.as_dvec3());
        for row in [rows.row(0), rows.row(1), rows.row(2)] {
            vector("rows", row.as_vec3(), LARGE as f32)?;
        }
        vector("offset", offset.as_vec3(), FAR)?;
        let volume = rows.determinant().abs() as f32;
        number("determinant of rows", volume, f32::MIN_POSITIVE, f32::MAX)?;
        return placements(pattern, rows, offset);
    }
    pattern.inks().iter().try_for_each(|ink| match ink {
        Ink::Pattern(inner) => placements(inner, rows, offset),
        Ink::Colour(_) => Ok(()),
    })
}

fn pattern_part(pattern: &Pattern) -> Checked {
    let colours = |list: &[Ink]| {
        list.iter().try_for_each(|ink| match ink {
            Ink::Colour(c) => colour("colours", *c),
            Ink::Pattern(_) => Ok(()),
        })
    };
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
                Err(SceneError::new(Fault::Points))
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
        // what it gives is clamped where it is shown
        Pattern::Formula { .. } => Ok(()),
        // asked for with those that it is in: see `placements`
        Pattern::Placed { .. } => Ok(()),
    }
}

/// Whether a light's numbers are in their ranges: a direction of length 1, no negative light.
///
/// # Errors
/// Which number is wrong.
pub fn light(light: &Light) -> Checked {
    match light.source {
        Source::Directional { direction: d } => {
            direction("direction", d).map_err(|e| e.at("source"))?
        }
        Source::Point { position } => {
            vector("position", position, FAR).map_err(|e| e.at("source"))?
        }
        Source::Rectangle {
            position,
            right,
            up,
            ..
        } => (vector("position", position, FAR))
            .and_then(|()| half_side("right", right))
            .and_then(|()| half_side("up", up))
            .and_then(|()| at_right_angles(right, up))
            .map_err(|e| e.at("source"))?,
        Source::Disc {
            position,
            direction: d,
            radius,
            ..
        } => (vector("position", position, FAR))
            .and_then(|()| direction("direction", d))
            .and_then(|()| number("radius", radius, LAMP.0, LAMP.1))
            .map_err(|e| e.at("source"))?,
        Source::Sphere {
            position, radius, ..
        } => (vector("position", position, FAR))
            .and_then(|()| number("radius", radius, LAMP.0, LAMP.1))
            .map_err(|e| e.at("source"))?,
    }
    colour("radiance", light.radiance)?;
    shadow(&light.shadow).map_err(|e| e.at("shadow"))
}

/// Smallest and largest radius, and half side, of a light with an extent.
pub const LAMP: (f32, f32) = (1e-6, 1e6);

fn half_side(name: &'static str, v: Vec3) -> Checked {
    vector(name, v, LAMP.1)?;
    number(name, v.length(), LAMP.0, LAMP.1)
}

fn at_right_angles(right: Vec3, up: Vec3) -> Checked {
    if right.normalize().dot(up.normalize()).abs() < 1e-3 {
        return Ok(());
    }
    Err(SceneError::new(Fault::RightAngles).at("up"))
}

/// Whether a sky's numbers are in their ranges: no negative light, `ambient` 0 to 10.
///
/// # Errors
/// Which number is wrong.
pub fn sky(sky: &Sky) -> Checked {
    colour("top", sky.top)?;
    colour("horizon", sky.horizon)?;
    colour("bottom", sky.bottom)?;
    number("ambient", sky.ambient, 0.0, 10.0)?;
    number("sun", crate::camera::degrees_of(sky.sun) as f32, 0.0, 180.0)?;
    sky.fog
        .as_ref()
        .map_or(Ok(()), |f| fog(f).map_err(|e| e.at("fog")))
}

/// Whether an environment's numbers are in their ranges, and it has light: colours without a negative number, none of them endless.
///
/// # Errors
/// Which number is wrong.
pub fn environment(environment: &Environment) -> Checked {
    match &environment.source {
        Surroundings::Image { image: shown } => {
            let bright = |c: &Vec3| colour("pixels", *c);
            image(shown)
                .and_then(|()| shown.pixels.iter().try_for_each(bright))
                .map_err(|e| e.at("image").at("source"))?;
        }
        Surroundings::Clear { turbidity, ground } => {
            let (least, most) = environment::TURBIDITY;
            number("turbidity", *turbidity, least, most)
                .and_then(|()| colour("ground", *ground))
                .map_err(|e| e.at("source"))?;
        }
    }
    number("strength", environment.strength, 0.0, environment::STRENGTH)?;
    number("turn", environment.turn, -FAR, FAR)
}

fn fog(fog: &Fog) -> Checked {
    if let Some(c) = fog.colour {
        colour("colour", c)?;
    }
    number("density", fog.density, 0.0, 1e6)?;
    if let Some(height) = fog.height {
        number("height", height, SMALL as f32, LARGE as f32)?;
    }
    number("base", fog.base, -FAR, FAR)?;
    number("glow", fog.glow, 0.0, 10.0)
}

/// Whether settings are in their ranges, with `samples` rays (and [`SAMPLES`]) at most where something is sampled.
///
/// # Errors
/// Which number is wrong.
pub fn settings(settings: &Settings, samples: u32) -> Checked {
    size(settings.size).map_err(|e| e.at("size"))?;
    march(&settings.march).map_err(|e| e.at("march"))?;
    setting(Settings::MAX_STEPS, Whole(settings.max_steps))?;
    let reduction = Whole(settings.discontinuity_reduction);
    setting(Settings::DISCONTINUITY_REDUCTION, reduction)?;
    setting(Settings::FOOTPRINT, Real(settings.footprint))?;
    setting(Settings::EXPOSURE, Real(settings.exposure))?;
    integrator(&settings.integrator).map_err(|e| e.at("integrator"))?;
    occlusion(&settings.occlusion, samples).map_err(|e| e.at("occlusion"))?;
    antialias(&settings.antialias, samples).map_err(|e| e.at("antialias"))
}
