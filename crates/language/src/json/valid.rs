//! What a scene's numbers may be where it is read: the ranges of [`zeroset_scene::valid`], and limits on top of these.

use super::{JsonStep, Problem, Read, problem};
use crate::draft::check_size;
use crate::limits::Limits;
use zeroset_scene::environment::Environment;
use zeroset_scene::light::{Light, Sky};
use zeroset_scene::material::Material;
use zeroset_scene::scene::SceneParts;
use zeroset_scene::settings::{Occlusion, Settings};
use zeroset_scene::valid::{self, Checked};
pub(super) use zeroset_scene::valid::{FAR, HEIGHT, UPRIGHT};

/// The error of a scene as one of a file.
fn read(check: Checked) -> Read<()> {
    check.map_err(|e| {
        let mut p = problem(e.fault().to_string());
        p.path = (e.path().iter())
            .map(|step| match *step {
                valid::PathStep::Key(key) => JsonStep::Key(key.to_string()),
                valid::PathStep::Index(i) => JsonStep::Index(i),
            })
            .collect();
        p
    })
}

/// The limits that numbers of a scene have beside their ranges.
pub(crate) fn limits(scene: &SceneParts, limits: &Limits) -> Read<()> {
    let in_list = |i: usize| move |p: Box<Problem>| p.within(JsonStep::Index(i)).at("objects");
    let named = |name: &str| limits.check_name(name).map_err(|m| problem(m).at("name"));
    named(&scene.name)?;
    for (i, object) in scene.objects.iter().enumerate() {
        named(&object.name).map_err(in_list(i))?;
        let ao = object.occlusion.as_ref();
        ao.map_or(Ok(()), |ao| occlusion(ao, limits))
            .map_err(|p| in_list(i)(p.at("ao")))?;
    }
    settings(&scene.settings, limits).map_err(|p| p.at("settings"))
}

/// Whether a scene may have this many materials.
pub(super) fn count_materials(n: usize) -> Read<()> {
    read(valid::count_materials(n))
}

/// Whether a scene may have this many lights.
pub(super) fn count_lights(n: usize) -> Read<()> {
    read(valid::count_lights(n))
}

pub(super) fn material(material: &Material) -> Read<()> {
    read(valid::material(material))
}

pub(super) fn light(light: &Light) -> Read<()> {
    read(valid::light(light))
}

pub(super) fn sky(sky: &Sky) -> Read<()> {
    read(valid::sky(sky))
}

pub(super) fn environment(environment: &Environment) -> Read<()> {
    read(valid::environment(environment))
}

pub(super) fn occlusion(occlusion: &Occlusion, limits: &Limits) -> Read<()> {
    read(valid::occlusion(occlusion, samples(limits)))
}

pub(super) fn settings(settings: &Settings, limits: &Limits) -> Read<()> {
    check_size(settings.size, limits).map_err(|m| problem(m).at("size"))?;
    read(valid::settings(settings, samples(limits)))
}

fn samples(limits: &Limits) -> u32 {
    limits.samples.min(u64::from(valid::SAMPLES)) as u32
}
