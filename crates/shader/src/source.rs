//! The text of a shader module: the recorded field and the stages that a scene needs.

use crate::job::{FieldForm, LONGEST_COMPILED};
use std::collections::BTreeSet;
use std::sync::Arc;
use zeroset_field::program::{Program, Structure};
use zeroset_scene::material::Pattern;
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{March, Normals, Occlusion, Shading, Shadow};

/// What the text depends on.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Key {
    structure: Arc<Structure>,
    interpreted: bool,
    march: u32,
    normals: Normals,
    shading: Shading,
    occlusion: BTreeSet<u32>,
    shadows: BTreeSet<u32>,
    patterns: BTreeSet<u32>,
}

impl Key {
    pub(crate) fn new(scene: &Scene, program: &Program, form: FieldForm) -> Key {
        let structure = program.shared_structure();
        let length = structure.values.instructions.len() + structure.marks.instructions.len();
        let methods = (scene.objects.iter())
            .filter_map(|o| o.occlusion.as_ref())
            .chain([&scene.settings.occlusion]);
        Key {
            interpreted: match form {
                FieldForm::Auto => length > LONGEST_COMPILED,
                FieldForm::Compiled => false,
                FieldForm::Interpreted => true,
            },
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
        }
    }

    /// The text, and the instructions of a field that is data.
    pub(crate) fn source(&self) -> (String, Vec<u32>) {
        (String::new(), vec![0])
    }
}

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
