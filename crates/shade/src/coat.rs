//! What renderers know of a scene before its first ray: the field with its materials, each in the space of what it was painted on.

use crate::pattern::{PerLane, Place, Texture};
use crate::surface::LocalMaterial;
use crate::view::Region;
use crate::{parameters, pattern};
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::Field;
use zeroset_field::program::{Limits, Program};
use zeroset_number::Vec3;
use zeroset_scene::material::Material;
use zeroset_scene::render::RenderError;
use zeroset_scene::scene::Scene;

/// The field of a scene, and where its solid is.
///
/// # Errors
/// A field over the limits.
pub fn compiled(scene: &Scene, limits: &Limits) -> Result<(Program, Region), RenderError> {
    if let Some(field) = scene.field()? {
        let spatial: Vec<bool> = scene.materials().iter().map(Material::is_spatial).collect();
        let program = Program::compile_painted(&field, limits, &spatial)?;
        let region = Region::new(&program.bounds());
        return Ok((program, region));
    }
    // no ray goes into an empty region: the program stands for nothing
    let sphere = &catalogue().primitives[0];
    let field = Field::primitive(sphere, sphere.info.defaults())?;
    Ok((Program::compile(&field, limits)?, Region::new(&Aabb::EMPTY)))
}

/// A material as it lies on something, ready to be asked how it looks somewhere.
#[derive(Clone, Debug)]
pub struct Coat {
    /// The material.
    pub material: Material,
    /// Where [`Program::places`] leave points of the space that it lies in; 0 where that is the world.
    pub place: u16,
    albedo: Texture,
    roughness: Option<Texture>,
    metallic: Option<Texture>,
    bump: Option<(Texture, f32)>,
}

impl Coat {
    /// The coats of a scene by their numbers as marks: its materials, then those that lie in the spaces of what they were painted on.
    pub fn all(scene: &Scene, program: &Program) -> Vec<Coat> {
        let materials = scene.materials();
        let whole = materials.iter().map(|m| Coat::new(m, 0));
        let placed = program.coats().iter().filter_map(|coat| {
            let material = materials.get(usize::from(coat.material))?;
            Some(Coat::new(material, coat.place))
        });
        whole.chain(placed).collect()
    }

    /// A material that lies in a space.
    pub fn new(material: &Material, place: u16) -> Coat {
        Coat {
            material: material.clone(),
            place,
            albedo: Texture::new(&material.pattern),
            roughness: material.roughness_map.as_ref().map(Texture::new),
            metallic: material.metallic_map.as_ref().map(Texture::new),
            bump: (material.bump.as_ref()).map(|b| (Texture::new(&b.pattern), b.depth)),
        }
    }

    /// What the surface is made of at a place of its space.
    #[inline(always)]
    pub fn local<R: PerLane>(&self, here: &Place<R>) -> LocalMaterial<R> {
        let (m, one) = (&self.material, here.width.lit(1.0));
        LocalMaterial {
            albedo: self.albedo.colour(here),
            emission: here.point.like(parameters(m.emission)),
            specular: one * m.specular,
            metallic: match &self.metallic {
                Some(map) => map.number(here),
                None => one * m.metallic,
            },
            roughness: match &self.roughness {
                Some(map) => map.number(here),
                None => one * m.roughness,
            },
            transmission: one * m.transmission,
            shininess: one * m.shininess,
        }
    }

    /// The normal at a place, which is `here` in its space; `rows` say how that changes with the place. Seen from direction `d`.
    #[inline(always)]
    pub fn normal<R: PerLane>(
        &self,
        at: &Place<R>,
        here: &Place<R>,
        rows: [Vec3<R>; 3],
        d: Vec3<R>,
    ) -> Vec3<R> {
        match &self.bump {
            Some((texture, depth)) => texture.bump(*depth, at, here, rows, d),
            None => at.normal,
        }
    }

    /// Its textures: of the colour, the roughness, how metallic it is, and its heights.
    pub fn textures(&self) -> [Option<&Texture>; 4] {
        [
            Some(&self.albedo),
            self.roughness.as_ref(),
            self.metallic.as_ref(),
            self.bump.as_ref().map(|(texture, _)| texture),
        ]
    }
}

/// The rows of no map.
#[inline(always)]
pub fn unmapped<R: pattern::PerLane>(at: &Place<R>) -> [Vec3<R>; 3] {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(
        #[inline(always)]
        |[x, y, z]| at.point.like(zeroset_number::v3(x, y, z)),
    )
}
