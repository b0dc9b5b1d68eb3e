//! The stage of a scene that says nothing but what is shown: a floor, three lights, a sky, colours.
//!
//! A first line, `show(sphere())`, becomes a picture that tells form: a key light with a soft shadow, a weak fill from the other
//! side, a rim light from behind, and a floor that the thing stands on. Whatever a scene says of its camera, lights, sky or
//! fog, and whatever it shows without an end, makes the stage its own, and nothing of this is added.

use crate::draft::Draft;
use crate::framing::surface;
use glam::Vec3;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::Field;
use zeroset_field::placement::Placement;
use zeroset_scene::light::{Light, Sky, Source};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::scene::{Object, finite_bounds};
use zeroset_scene::settings::Shadow;

/// What objects without a material have in turn, linear: terracotta, teal, sand, plum, moss.
const COLOURS: [Vec3; 5] = [
    Vec3::new(0.62, 0.13, 0.06),
    Vec3::new(0.03, 0.24, 0.27),
    Vec3::new(0.72, 0.40, 0.08),
    Vec3::new(0.29, 0.10, 0.24),
    Vec3::new(0.22, 0.34, 0.10),
];

/// A matte floor, nearly white.
const FLOOR: Vec3 = Vec3::new(0.66, 0.64, 0.61);

impl Draft {
    /// Adds the stage, if the scene leaves it to us; with its floor, or without.
    pub(crate) fn welcome(&mut self, floor: bool) {
        let says = self.view.is_some()
            || self.lights.is_some()
            || self.sky.is_some()
            || self.fog.is_some();
        let ends = |o: &Object| o.field.facts().bounds.is_finite();
        if says || !self.objects.iter().all(ends) {
            return;
        }
        let bounds = finite_bounds(self.objects.iter().map(|o| surface(&o.field)));
        let (Some(bounds), Some(plane)) = (bounds, catalogue().primitive("plane")) else {
            return;
        };
        for (turn, object) in std::mem::take(&mut self.plain).into_iter().enumerate() {
            let material = matte(COLOURS[turn % COLOURS.len()], 0.3);
            if let Some(number) = self.number(&material)
                && let Some(object) = self.objects.get_mut(object)
            {
                object.material = number;
            }
        }
        if floor {
            let plane = Field::primitive(plane, plane.info.defaults())
                .and_then(|f| f.place(Placement::moved([0.0, bounds.min[1], 0.0])));
            let (Ok(field), Some(material)) = (plane, self.number(&matte(FLOOR, 0.05))) else {
                return;
            };
            self.objects.push(Object {
                name: "floor".into(),
                field,
                material,
                occlusion: None,
                place: None,
            });
        }
        let light = |direction: [f32; 3], radiance: [f32; 3], shadow| Light {
            source: Source::Directional {
                direction: Vec3::from(direction).normalize(),
            },
            radiance: Vec3::from(radiance),
            shadow,
        };
        self.lights = Some(vec![
            // the key: warm, from the right, above and a little in front
            light(
                [-0.75, -1.0, -0.42],
                [0.80, 0.74, 0.66],
                Shadow::SoftClosest { sharpness: 7.0 },
            ),
            // the fill: cool and weak, from the left
            light([0.9, -0.35, -0.55], [0.10, 0.12, 0.15], Shadow::None),
            // the rim: from behind
            light([0.35, -0.55, 1.0], [0.24, 0.26, 0.30], Shadow::None),
        ]);
        self.sky = Some(Sky {
            top: Vec3::new(0.50, 0.58, 0.68),
            horizon: Vec3::new(0.80, 0.81, 0.82),
            bottom: Vec3::new(0.46, 0.44, 0.42),
            ambient: 0.55,
            ..Sky::default()
        });
    }
}

fn matte(colour: Vec3, specular: f32) -> Material {
    Material {
        pattern: Pattern::Solid { colour },
        specular,
        roughness: 0.4,
        ..Material::default()
    }
}
