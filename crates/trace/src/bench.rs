//! Scenes and measurements.

use glam::Vec3;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::Field;
use zeroset_field::placement::Placement;
use zeroset_field::repetition::Repetition;
use zeroset_field::shape;
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::light::{Light, Sky, Source};
use zeroset_scene::material::Material;
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{Antialias, Normals, Occlusion, Settings, Shadow};

fn entry(name: &str, params: &[f64]) -> Field {
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
            object("sphere", at(entry("sphere", &[1.0]), [-0.7, 1.0, 0.0])),
            object("box", at(entry("box", &[1.0, 1.0, 1.0]), [1.1, 0.5, 0.6])),
            object("ground", entry("plane", &[])),
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
    let tower = entry("box", &[0.62, 2.0, 0.62]);
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
            object("ground", entry("plane", &[])),
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

/// A molecule: 2,000 balls in a larger one, each smoothly joined with those before it.
pub fn molecule() -> Scene {
    let atoms = (0..2000).map(|k| {
        // a spiral over shells of a ball whose volume is filled evenly
        let share = (f64::from(k) + 0.5) / 2000.0;
        let radius = 5.0 * share.cbrt();
        let height = 1.0 - 2.0 * (f64::from(k) * 0.618_033_988_749_895).fract();
        let angle = f64::from(k) * 2.399_963_229_728_653;
        let across = (1.0 - height * height).sqrt() * radius;
        let at = [across * angle.cos(), height * radius, across * angle.sin()];
        shape::sphere(0.28 + 0.1 * (f64::from(k) * 0.754_877_666_246_693).fract()).translate(at)
    });
    let field = shape::smooth_union(atoms, 0.15)
        .field()
        .expect("a molecule");
    let parts = SceneParts {
        name: "molecule".into(),
        objects: vec![object("molecule", field)],
        camera: view_of(Vec3::new(7.0, 5.0, 14.0), Vec3::ZERO),
        ..sphere_box_ground().into_parts()
    };
    parts.build().expect("a scene")
}

fn view_of(eye: Vec3, target: Vec3) -> Camera {
    let lens = Lens::Pinhole {
        fov: 45f32.to_radians(),
    };
    Camera::look_at(eye, target, Vec3::Y, lens).expect("a view")
}
