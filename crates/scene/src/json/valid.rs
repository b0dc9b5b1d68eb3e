//! What numbers of materials, lights, the sky and settings may be: the same ranges that the language allows.

use super::{Read, problem};
use crate::draft::check_size;
use crate::light::{Light, Sky, Source};
use crate::limits::Limits;
use crate::material::{Material, Pattern};
use crate::settings::{Antialias, March, Occlusion, Settings, Shadow};
use glam::Vec3;

fn number(name: &str, x: f32, min: f32, max: f32) -> Read<()> {
    if (min..=max).contains(&x) {
        return Ok(());
    }
    Err(problem(format!("this is {x}, allowed is {min} to {max}")).at(name))
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
        .try_for_each(|x| number(name, x, 0.0, 1e6))
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
    let scale = |x: f32| number("size", x, 1e-6, 1e6);
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
            vector("from", *from, 1e6)?;
            vector("to", *to, 1e6)?;
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
            vector("position", position, 1e6).map_err(|p| p.at("source"))?
        }
    }
    colour("radiance", light.radiance)?;
    match light.shadow {
        Shadow::None | Shadow::Hard => Ok(()),
        Shadow::Soft { sharpness } | Shadow::SoftClosest { sharpness } => {
            number("sharpness", sharpness, 1.0, 1000.0).map_err(|p| p.at("shadow"))
        }
    }
}

pub(super) fn sky(sky: &Sky) -> Read<()> {
    colour("top", sky.top)?;
    colour("horizon", sky.horizon)?;
    colour("bottom", sky.bottom)?;
    number("ambient", sky.ambient, 0.0, 10.0)
}

pub(super) fn occlusion(occlusion: &Occlusion, limits: &Limits) -> Read<()> {
    let most = limits.samples.min(1 << 20) as u32;
    let length = |name: &str, x: f32| number(name, x, 1e-6, 1e6);
    let far = |reach: Option<f32>| reach.map_or(Ok(()), |x| length("reach", x));
    let strength = |x: f32| number("scale", x, 0.0, 1000.0);
    let bend = |x: f32| number("bend", x, 0.0, 10.0);
    match *occlusion {
        Occlusion::None => Ok(()),
        Occlusion::Quilez { steps, step, scale } => {
            count("steps", steps, 1, most)?;
            length("step", step)?;
            strength(scale)
        }
        Occlusion::Bent {
            steps,
            step,
            scale,
            bend: b,
        } => {
            count("steps", steps, 1, most)?;
            length("step", step)?;
            strength(scale)?;
            bend(b)
        }
        Occlusion::Evans {
            scale,
            step,
            bend: b,
        } => {
            strength(scale)?;
            length("step", step)?;
            bend(b)
        }
        Occlusion::Upward { scale } => strength(scale),
        Occlusion::Cones { reach, steps } => {
            far(reach)?;
            count("steps", steps, 1, most)
        }
        Occlusion::Hemisphere { rays, reach } => {
            count("rays", rays, 1, most)?;
            far(reach)
        }
        Occlusion::Obscurance { rays, reach, tau } => {
            count("rays", rays, 1, most)?;
            far(reach)?;
            number("tau", tau, 1e-3, 1000.0)
        }
    }
}

pub(super) fn settings(settings: &Settings, limits: &Limits) -> Read<()> {
    check_size(settings.size, limits).map_err(|m| problem(m).at("size"))?;
    let march = match settings.march {
        March::Fixed { step } => number("step", step, 1e-6, 1e6),
        March::Sphere => Ok(()),
        March::Relaxed { omega } => number("omega", omega, 1.0, 1.99),
        March::Enhanced { share } => number("share", share, 0.1, 1.0),
        March::Auto { beta } => number("beta", beta, 0.01, 1.0),
    };
    march.map_err(|p| p.at("march"))?;
    count("max_steps", settings.max_steps, 1, 100_000)?;
    count(
        "discontinuity_reduction",
        settings.discontinuity_reduction,
        0,
        16,
    )?;
    number("footprint", settings.footprint, 1e-3, 4.0)?;
    number("exposure", settings.exposure, -20.0, 20.0)?;
    occlusion(&settings.occlusion, limits).map_err(|p| p.at("occlusion"))?;
    match settings.antialias {
        Antialias::None => Ok(()),
        Antialias::Supersample { samples, .. } => {
            count("samples", samples, 1, limits.samples.min(1 << 20) as u32)
                .map_err(|p| p.at("antialias"))
        }
    }
}
