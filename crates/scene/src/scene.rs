//! The scene as a whole.

use crate::camera::Camera;
use crate::light::{Light, Sky};
use crate::material::Material;
use crate::settings::{Occlusion, Settings};
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::entries::Catalogue;
use zeroset_field::field::{Field, FieldError, Paint};

/// A field with a material.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its name, from the scene file or its number.
    pub name: String,
    /// Its shape. Parts of it may be painted with other materials.
    pub field: Field,
    /// Its material: an index into [`Scene::materials`].
    pub material: u16,
    /// Its own occlusion method, if it chose one.
    pub occlusion: Option<Occlusion>,
    /// Where in which file it was shown: (file, first line, first column), 1-based.
    pub place: Option<(String, u32, u32)>,
}

/// What a renderer gets: valid by construction.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name, usually the file's stem.
    pub name: String,
    /// What is seen. At most 65,535.
    pub objects: Vec<Object>,
    /// What it looks like. At most 65,535.
    pub materials: Vec<Material>,
    /// What lights it.
    pub lights: Vec<Light>,
    /// What is behind it.
    pub sky: Sky,
    /// Who looks.
    pub camera: Camera,
    /// How it is rendered.
    pub settings: Settings,
}

impl Scene {
    /// The box of all that has an end; what goes on for ever is left out. `None` where nothing is left.
    pub fn finite_bounds(&self) -> Option<Aabb> {
        finite_bounds(self.objects.iter().map(|o| o.field.facts().bounds))
    }

    /// Whether both scenes have the same field, as far as that is seen without a look into it: the same shapes, painted with the
    /// same numbers of materials.
    pub fn has_field_of(&self, other: &Scene) -> bool {
        let same =
            |(a, b): (&Object, &Object)| a.field.key() == b.field.key() && a.material == b.material;
        self.objects.len() == other.objects.len()
            && self.objects.iter().zip(&other.objects).all(same)
    }

    /// All objects as one field: their union, each painted with its material (where no part of it is painted already) and
    /// its number. A scene without objects has no field.
    ///
    /// # Errors
    /// A tree too deep.
    pub fn field(&self) -> Result<Option<Field>, FieldError> {
        let painted = self.objects.iter().zip(0..).map(|(object, number)| {
            object
                .field
                .paint(Paint::Material(object.material))?
                .paint(Paint::Object(number))
        });
        let shapes = painted.collect::<Result<Vec<Field>, FieldError>>()?;
        if shapes.is_empty() {
            return Ok(None);
        }
        Field::join(Catalogue::union(), Vec::new(), shapes).map(Some)
    }
}

/// The box of all that has an end; what goes on for ever is left out. `None` where nothing is left.
pub fn finite_bounds(bounds: impl Iterator<Item = Aabb>) -> Option<Aabb> {
    bounds
        .filter(|b| !b.is_empty() && b.is_finite())
        .reduce(|a, b| a.hull(&b))
}
