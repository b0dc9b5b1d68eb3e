//! The scene as a whole.

use crate::camera::Camera;
use crate::environment::Environment;
use crate::light::{Light, Sky};
use crate::material::Material;
use crate::settings::{Occlusion, Settings};
use crate::valid::{self, SceneError};
use std::collections::HashSet;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::entries::Catalogue;
use zeroset_field::field::{Field, FieldError, Node, Paint};

/// A field with a material.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its name, from the scene file or its number.
    pub name: String,
    /// Its shape. Parts of it may be painted with other materials.
    pub field: Field,
    /// Its material: an index into [`SceneParts::materials`].
    pub material: u16,
    /// Its own occlusion method, if it chose one.
    pub occlusion: Option<Occlusion>,
    /// Where in which file it was shown: (file, first line, first column), 1-based.
    pub place: Option<(String, u32, u32)>,
}

impl Object {
    /// A field with a name and the scene's first material.
    pub fn new(name: impl Into<String>, field: Field) -> Object {
        Object {
            name: name.into(),
            field,
            material: 0,
            occlusion: None,
            place: None,
        }
    }
}

/// What a scene is made of, unchecked.
#[derive(Clone, Debug, Default)]
pub struct SceneParts {
    /// Name, usually the file's stem.
    pub name: String,
    /// What is seen. At most 65,535.
    pub objects: Vec<Object>,
    /// What it looks like. At most 65,535.
    pub materials: Vec<Material>,
    /// What lights it. At most 64.
    pub lights: Vec<Light>,
    /// What is behind it.
    pub sky: Sky,
    /// What is all around it, in place of the colours of the sky.
    pub environment: Option<Environment>,
    /// Who looks.
    pub camera: Camera,
    /// How it is rendered.
    pub settings: Settings,
}

/// What a renderer gets: valid by construction. Its numbers are finite and in their ranges, its references lead somewhere
/// (see [`valid`]).
#[derive(Clone, Debug)]
pub struct Scene {
    parts: SceneParts,
    /// See [`Scene::moments`].
    moments: Arc<[Arc<Scene>]>,
}

/// Most moments of a scene.
pub const MOMENTS: u32 = 1024;

impl SceneParts {
    /// The scene of these parts: [`Scene::new`].
    ///
    /// # Errors
    /// What is wrong with them, and where.
    pub fn build(self) -> Result<Scene, SceneError> {
        Scene::new(self)
    }
}

impl Scene {
    /// The scene of these parts.
    ///
    /// # Errors
    /// What is wrong with them, and where: numbers that are not finite or out of their ranges, a picture without pixels,
    /// materials that are not there, too many of something.
    pub fn new(parts: SceneParts) -> Result<Scene, SceneError> {
        valid::parts(&parts)?;
        let moments = Arc::default();
        Ok(Scene { parts, moments })
    }

    /// What it is made of, to be changed and built again.
    pub fn into_parts(self) -> SceneParts {
        self.parts
    }

    /// What it is made of.
    pub fn parts(&self) -> &SceneParts {
        &self.parts
    }

    /// Name, usually the file's stem.
    pub fn name(&self) -> &str {
        &self.parts.name
    }

    /// What is seen.
    pub fn objects(&self) -> &[Object] {
        &self.parts.objects
    }

    /// What it looks like. [`Object::material`] is an index into these.
    pub fn materials(&self) -> &[Material] {
        &self.parts.materials
    }

    /// What lights it.
    pub fn lights(&self) -> &[Light] {
        &self.parts.lights
    }

    /// What is behind it.
    pub fn sky(&self) -> &Sky {
        &self.parts.sky
    }

    /// What is all around it, in place of the colours of the sky.
    pub fn environment(&self) -> Option<&Environment> {
        self.parts.environment.as_ref()
    }

    /// Who looks.
    pub fn camera(&self) -> &Camera {
        &self.parts.camera
    }

    /// How it is rendered.
    pub fn settings(&self) -> &Settings {
        &self.parts.settings
    }

    /// What the scene is at other moments, evenly spread over the time that the shutter is open, in their order: each sample of a pixel sees
    /// one of them, with the settings of this scene. None where nothing moves: then all samples see this scene.
    pub fn moments(&self) -> &[Arc<Scene>] {
        &self.moments
    }

    /// This scene, and what it is at other moments. Of their own settings and moments nothing counts.
    ///
    /// # Errors
    /// More than [`MOMENTS`].
    pub fn with_moments(self, moments: Vec<Scene>) -> Result<Scene, SceneError> {
        valid::count_moments(moments.len())?;
        let moments = moments.into_iter().map(Arc::new).collect();
        Ok(Scene { moments, ..self })
    }

    /// Changes this scene. Where the change is refused the scene stays as it was. It has no [moments](Scene::moments) then.
    ///
    /// # Errors
    /// What would be wrong with it, and where.
    pub fn edit(&mut self, change: impl FnOnce(&mut SceneParts)) -> Result<(), SceneError> {
        let mut parts = self.parts.clone();
        change(&mut parts);
        *self = Scene::new(parts)?;
        Ok(())
    }

    /// Changes this scene and what it is at other [moments](Scene::moments). Where a change is refused the scene stays as it was.
    ///
    /// # Errors
    /// What the change says, and what would be wrong with a scene, and where.
    pub fn edit_moments<E: From<SceneError>>(
        &mut self,
        mut change: impl FnMut(&mut SceneParts) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut changed = |scene: &Scene| {
            let mut parts = scene.parts.clone();
            change(&mut parts)?;
            Ok::<Scene, E>(Scene::new(parts)?)
        };
        let own = changed(self)?;
        let moments = self.moments.iter().map(|m| changed(m));
        *self = own.with_moments(moments.collect::<Result<Vec<Scene>, E>>()?)?;
        Ok(())
    }

    /// This scene with other settings.
    ///
    /// # Errors
    /// Which of them is out of its range.
    pub fn with_settings(mut self, settings: Settings) -> Result<Scene, SceneError> {
        valid::settings(&settings, valid::SAMPLES).map_err(|e| e.at("settings"))?;
        self.parts.settings = settings;
        Ok(self)
    }

    /// This scene as a picture of this width and height in pixels.
    ///
    /// # Errors
    /// A picture without pixels, or with more than [`valid::PIXELS`].
    pub fn with_size(mut self, size: [u32; 2]) -> Result<Scene, SceneError> {
        valid::size(size).map_err(|e| e.at("size").at("settings"))?;
        self.parts.settings.size = size;
        Ok(self)
    }

    /// This scene seen by another camera, which stands still at all moments.
    ///
    /// # Errors
    /// Which of its numbers is wrong.
    pub fn with_camera(mut self, camera: Camera) -> Result<Scene, SceneError> {
        valid::camera(&camera).map_err(|e| e.at("camera"))?;
        self.parts.camera = camera;
        let seen = |moment: &Arc<Scene>| {
            let mut moment = Scene::clone(moment);
            moment.parts.camera = camera;
            Arc::new(moment)
        };
        self.moments = self.moments.iter().map(seen).collect();
        Ok(self)
    }

    /// The box of all that has an end; what goes on for ever is left out. `None` where nothing is left.
    pub fn finite_bounds(&self) -> Option<Aabb> {
        finite_bounds(self.objects().iter().map(|o| o.field.facts().bounds))
    }

    /// Whether both scenes have the same field, as far as that is seen without a look into it: the same shapes, painted with the
    /// same numbers of materials, of which the same depend on where they are.
    pub fn has_field_of(&self, other: &Scene) -> bool {
        let same =
            |(a, b): (&Object, &Object)| a.field.key() == b.field.key() && a.material == b.material;
        let spatial = |scene: &Scene| scene.materials().iter().map(Material::is_spatial).collect();
        let (own, others): (Vec<bool>, Vec<bool>) = (spatial(self), spatial(other));
        own == others
            && self.objects().len() == other.objects().len()
            && self.objects().iter().zip(other.objects()).all(same)
    }

    /// All objects as one field: their union, each painted with its material (where no part of it is painted already) and
    /// its number. A scene without objects has no field.
    ///
    /// # Errors
    /// A tree too deep.
    pub fn field(&self) -> Result<Option<Field>, FieldError> {
        let painted = self.objects().iter().zip(0..).map(|(object, number)| {
            object
                .field
                .paint(Paint::Material(object.material))?
                .paint(Paint::Object(number))
        });
        let shapes = painted.collect::<Result<Vec<Field>, FieldError>>()?;
        let union = |shapes: Vec<Field>| Field::join(Catalogue::union(), Vec::new(), shapes);
        let (mut clear, mut opaque) = (Vec::new(), Vec::new());
        for (object, shape) in self.objects().iter().zip(&shapes) {
            let side = match self.is_clear(object) {
                true => &mut clear,
                false => &mut opaque,
            };
            side.push(shape.clone());
        }
        match (clear.is_empty(), opaque.is_empty()) {
            (true, true) => Ok(None),
            (false, false) => Field::clear_union(union(clear)?, union(opaque)?).map(Some),
            _ => union(shapes).map(Some),
        }
    }

    /// Whether light goes through an object: it, or a part of it, has a material that transmits.
    pub fn is_clear(&self, object: &Object) -> bool {
        let transmits = |number: u16| {
            let material = self.materials().get(usize::from(number));
            material.is_some_and(|m| m.transmission > 0.0)
        };
        if !self.materials().iter().any(|m| m.transmission > 0.0) {
            return false;
        }
        let (mut seen, mut waiting) = (HashSet::new(), vec![&object.field]);
        let mut painted = transmits(object.material);
        while let Some(field) = waiting.pop() {
            if painted || field.facts().materials == 0 || !seen.insert(field.key()) {
                continue;
            }
            if let Node::Paint {
                paint: Paint::Material(number),
                ..
            } = field.node()
            {
                painted |= transmits(*number);
            }
            waiting.extend(field.children());
        }
        painted
    }
}

/// The box of all that has an end; what goes on for ever is left out. `None` where nothing is left.
pub fn finite_bounds(bounds: impl Iterator<Item = Aabb>) -> Option<Aabb> {
    bounds
        .filter(|b| !b.is_empty() && b.is_finite())
        .reduce(|a, b| a.hull(&b))
}
