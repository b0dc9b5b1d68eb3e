//! Scenes and measurements.

use glam::Vec3;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::Field;
use zeroset_field::placement::Placement;
use zeroset_field::repetition::Repetition;
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::light::{Light, Sky, Source};
use zeroset_scene::material::Material;
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{Antialias, Normals, Occlusion, Settings, Shadow};

fn shape(name: &str, params: &[f64]) -> Field {
    let entry = catalogue().primitive(name).expect("in the catalogue");
    Field::primitive(entry, params.to_vec()).expect("fitting numbers")
}

fn object(name: &str, field: Field) -> Object {
    Object {
        name: name.into(),
        field,
        material: 0,
        occlusion: None,
        place: None,
    }
}

/// Tomczak's sphere, box and ground.
pub fn sphere_box_ground() -> Scene {
    let at = |f: Field, p: [f64; 3]| f.place(Placement::moved(p)).expect("a place");
    let lens = Lens::Pinhole {
        fov: 40f32.to_radians(),
    };
    let parts = SceneParts {
        name: "sphere-box-ground".into(),
        objects: vec![
            object("sphere", at(shape("sphere", &[1.0]), [-0.7, 1.0, 0.0])),
            object("box", at(shape("box", &[1.0, 1.0, 1.0]), [1.1, 0.5, 0.6])),
            object("ground", shape("plane", &[])),
        ],
        materials: vec![Material::default()],
        lights: vec![Light {
            source: Source::Directional {
                direction: Vec3::new(-0.6, -0.9, -0.35).normalize(),
            },
            radiance: Vec3::new(1.0, 0.96, 0.9),
            shadow: Shadow::Soft { sharpness: 16.0 },
        }],
        sky: Sky::default(),
        environment: None,
        camera: Camera::look_at(
            Vec3::new(2.5, 2.2, 4.0),
            Vec3::new(0.1, 0.6, 0.0),
            Vec3::Y,
            lens,
        )
        .expect("a view"),
        settings: Settings::default(),
    };
    parts.build().expect("a scene")
}

/// The scene of the frame benchmark: soft shadows, five samples of occlusion, a ray a pixel.
pub fn frame() -> Scene {
    let mut parts = sphere_box_ground().into_parts();
    parts.settings = Settings {
        occlusion: Occlusion::Quilez {
            steps: 5,
            step: 0.12,
            scale: 1.5,
        },
        antialias: Antialias::None,
        normals: Normals::Exact,
        ..parts.settings
    };
    parts.build().expect("a scene")
}

/// A city of boxes on a grid with varied heights.
pub fn city() -> Scene {
    let tower = shape("box", &[0.62, 2.0, 0.62]);
    let repetition = Repetition {
        spacing: [1.0, 0.0, 1.0],
        count: [24, 0, 24],
        vary: [0.0, 0.9, 0.0],
        seed: 1,
    };
    let towers = tower.repeat(repetition).expect("a grid");
    let parts = SceneParts {
        name: "city".into(),
        objects: vec![
            object("towers", towers),
            object("ground", shape("plane", &[])),
        ],
        camera: Camera::look_at(
            Vec3::new(9.0, 5.0, 13.0),
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::Y,
            Lens::Pinhole {
                fov: 45f32.to_radians(),
            },
        )
        .expect("a view"),
        ..sphere_box_ground().into_parts()
    };
    parts.build().expect("a scene")
}
