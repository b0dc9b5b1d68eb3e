//! Scenes to compare on.

use glam::Vec3;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::Field;
use zeroset_field::placement::Placement;
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::film::Film;
use zeroset_scene::light::{Light, Source};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::render::{Renderer, Silent};
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{Antialias, Occlusion, Settings, Shadow};
use zeroset_testkit::plain::{self, Compiled, Quality};
use zeroset_trace::CpuRenderer;
use zeroset_trace::bench::sphere_box_ground;

pub fn shape(name: &str, params: &[f64]) -> Field {
    let entry = catalogue().primitive(name).expect("in the catalogue");
    Field::primitive(entry, params.to_vec()).expect("fitting numbers")
}

pub fn moved(field: &Field, offset: [f64; 3]) -> Field {
    field.place(Placement::moved(offset)).expect("a place")
}

pub fn object(field: Field, material: u16) -> Object {
    Object {
        name: String::new(),
        field,
        material,
        occlusion: None,
        place: None,
    }
}

/// A smooth blend of two materials, a body with a bite, a floor; a sun and a lamp.
pub fn blend() -> Scene {
    let join = |name: &str| catalogue().join(name).expect("in the catalogue");
    let paint = |f: &Field, m| {
        f.paint(zeroset_field::field::Paint::Material(m))
            .expect("a coat")
    };
    let a = paint(&moved(&shape("sphere", &[0.6]), [-0.4, 0.6, 0.0]), 1);
    let b = paint(&moved(&shape("box", &[0.8, 0.8, 0.8]), [0.5, 0.4, 0.2]), 2);
    let soft = Field::join(join("smooth_union"), vec![0.4], vec![a, b]).expect("a blend");
    let bite = moved(&shape("sphere", &[0.35]), [0.8, 0.8, 0.6]);
    let body = Field::join(join("subtraction"), vec![], vec![soft, bite]).expect("a bite");
    let colour = |r, g, b| Pattern::Solid {
        colour: Vec3::new(r, g, b),
    };
    let plain = Material::default();
    let parts = SceneParts {
        name: "blend".into(),
        objects: vec![object(body, 1), object(shape("plane", &[]), 0)],
        materials: vec![
            Material {
                pattern: Pattern::Checker {
                    colours: [Vec3::splat(0.3).into(), Vec3::splat(0.7).into()],
                    size: 0.5,
                },
                ..plain.clone()
            },
            Material {
                pattern: colour(0.8, 0.3, 0.2),
                metallic: 1.0,
                roughness: 0.2,
                ..plain.clone()
            },
            Material {
                pattern: colour(0.2, 0.4, 0.8),
                shininess: 10.0,
                ..plain
            },
        ],
        lights: vec![
            Light {
                source: Source::Directional {
                    direction: Vec3::new(-0.5, -0.8, -0.4).normalize(),
                },
                radiance: Vec3::splat(0.8),
                shadow: Shadow::Soft { sharpness: 12.0 },
            },
            Light {
                source: Source::Point {
                    position: Vec3::new(-1.5, 2.0, 1.5),
                },
                radiance: Vec3::new(1.5, 1.0, 0.5),
                shadow: Shadow::Hard,
            },
        ],
        ..view([2.0, 1.8, 3.0], [0.0, 0.4, 0.0], 0.6).into_parts()
    };
    parts.build().expect("a scene")
}

/// An empty scene with a view.
pub fn view(eye: [f32; 3], target: [f32; 3], fov: f32) -> Scene {
    let lens = Lens::Pinhole { fov };
    let mut scene = sphere_box_ground();
    scene
        .edit(|s| {
            s.objects.clear();
            s.camera = Camera::look_at(eye.into(), target.into(), Vec3::Y, lens).expect("a view");
            s.settings = quick();
        })
        .expect("a scene");
    scene
}

/// Small pictures, cheap methods.
pub fn quick() -> Settings {
    Settings {
        size: [96, 72],
        occlusion: Occlusion::Quilez {
            steps: 5,
            step: 0.12,
            scale: 1.5,
        },
        antialias: Antialias::None,
        ..Settings::default()
    }
}

/// Tomczak's scene, small.
pub fn tomczak() -> Scene {
    let mut scene = sphere_box_ground();
    scene.edit(|s| s.settings = quick()).expect("a scene");
    scene
}

pub fn stream(scene: &Scene) -> Film {
    CpuRenderer::new(Some(2))
        .expect("threads")
        .render(scene, &Silent)
        .expect("a picture")
        .film
}

/// The plain renderer's picture.
pub fn reference(scene: &Scene) -> Film {
    let renderer = CpuRenderer::new(Some(1)).expect("threads");
    let picture = renderer
        .prepare_scene(scene.clone().into())
        .expect("a program");
    let program = picture.program();
    plain::render(scene, &Quality::of(program, scene), || {
        Compiled::new(program, None)
    })
}
