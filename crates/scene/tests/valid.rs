//! A scene that no renderer could draw cannot be made: each fault is named, with its place.

use glam::{Mat3, Vec3};
use std::sync::Arc;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::{Field, Paint};
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::material::{Image, Material, Pattern};
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{Antialias, March, Occlusion, Settings, Shadow};
use zeroset_scene::valid::{Fault, LIGHTS, PathStep, SceneError};

fn shape(name: &str) -> Field {
    let entry = catalogue().primitive(name).expect("in the catalogue");
    Field::primitive(entry, entry.info.defaults()).expect("defaults fit")
}

fn object(field: Field, material: u16) -> Object {
    Object {
        name: "it".into(),
        field,
        material,
        occlusion: None,
        place: None,
    }
}

fn light() -> Light {
    Light {
        source: Source::Directional {
            direction: -Vec3::Y,
        },
        radiance: Vec3::ONE,
        shadow: Shadow::Hard,
    }
}

fn parts() -> SceneParts {
    SceneParts {
        name: "test".into(),
        objects: vec![object(shape("sphere"), 0), object(shape("plane"), 1)],
        materials: vec![Material::default(), Material::default()],
        lights: vec![light()],
        ..SceneParts::default()
    }
}

/// What is wrong after a change.
fn refused(change: impl Fn(&mut SceneParts)) -> SceneError {
    let mut parts = parts();
    change(&mut parts);
    let error = parts.build().expect_err("something is wrong");
    // refused as well where a scene is changed, which stays as it was
    let mut scene = Scene::new(self::parts()).expect("a scene");
    let again = scene.edit(change).expect_err("as wrong");
    assert_eq!(again.to_string(), error.to_string());
    assert_eq!(scene.objects().len(), 2);
    error
}

#[track_caller]
fn says(error: &SceneError, message: &str) {
    assert_eq!(error.to_string(), message);
}

#[test]
fn a_scene_is_what_it_is_made_of() {
    let scene = Scene::new(parts()).expect("a scene");
    assert_eq!(scene.name(), "test");
    assert_eq!((scene.objects().len(), scene.materials().len()), (2, 2));
    assert_eq!(scene.settings(), &Settings::default());
    assert!(SceneParts::default().build().is_ok());
    let wide = scene.with_size([64, 32]).expect("a size");
    assert_eq!(wide.into_parts().settings.size, [64, 32]);
}

#[test]
fn a_picture_has_pixels() {
    for size in [[0, 480], [640, 0], [0, 0], [u32::MAX, u32::MAX]] {
        let error = refused(|s| s.settings.size = size);
        let [width, height] = size;
        assert_eq!(error.fault(), &Fault::Size { width, height });
        assert_eq!(
            error.path(),
            [PathStep::Key("settings"), PathStep::Key("size")]
        );
        let scene = Scene::new(parts()).expect("a scene");
        assert_eq!(scene.clone().with_size(size).err(), Some(error.clone()));
        let settings = Settings {
            size,
            ..Settings::default()
        };
        assert_eq!(scene.with_settings(settings).err(), Some(error));
    }
    says(
        &refused(|s| s.settings.size = [0, 480]),
        "settings.size: a picture of 0x480 pixels: width and height must be at least 1, and at most 4294967296 pixels are \
         allowed",
    );
}

#[test]
fn materials_are_there() {
    let error = refused(|s| s.objects[1].material = 2);
    says(&error, "objects[1].material: there is no material 2");
    let (number, count) = (2, 2);
    assert_eq!(error.fault(), &Fault::Material { number, count });
    // also those of painted parts, however deep
    let painted = shape("sphere").paint(Paint::Material(7)).expect("a coat");
    let both = Field::join(
        catalogue().join("union").expect("in the catalogue"),
        Vec::new(),
        vec![shape("box"), painted],
    );
    let both = both.expect("a union");
    let error = refused(|s| s.objects[0].field = both.clone());
    says(&error, "objects[0].field: there is no material 7");
}

#[test]
fn numbers_are_numbers() {
    let nan = f32::NAN;
    for (place, change) in [
        (
            "camera.eye",
            (|s, x| s.camera.eye.y = x) as fn(&mut SceneParts, f32),
        ),
        ("camera.near", |s, x| s.camera.near = x),
        ("camera.far", |s, x| s.camera.far = x),
        ("camera.height", |s, x| {
            s.camera.lens = Lens::Orthographic { height: x }
        }),
        ("sky.ambient", |s, x| s.sky.ambient = x),
        ("sky.top", |s, x| s.sky.top.x = x),
        ("lights[0].radiance", |s, x| s.lights[0].radiance.z = x),
        ("lights[0].shadow.sharpness", |s, x| {
            s.lights[0].shadow = Shadow::Soft { sharpness: x };
        }),
        ("lights[0].source.position", |s, x| {
            s.lights[0].source = Source::Point {
                position: Vec3::splat(x),
            };
        }),
        ("materials[1].roughness", |s, x| {
            s.materials[1].roughness = x
        }),
        ("materials[0].pattern.colour", |s, x| {
            s.materials[0].pattern = Pattern::Solid {
                colour: Vec3::splat(x),
            };
        }),
        ("materials[0].pattern.size", |s, x| {
            s.materials[0].pattern = Pattern::Checker {
                colours: [Vec3::ONE.into(), Vec3::ONE.into()],
                size: x,
            };
        }),
        ("settings.exposure", |s, x| s.settings.exposure = x),
        ("settings.footprint", |s, x| s.settings.footprint = x),
        ("settings.march.step", |s, x| {
            s.settings.march = March::Fixed { step: x }
        }),
        ("settings.occlusion.scale", |s, x| {
            s.settings.occlusion = Occlusion::Upward { scale: x };
        }),
        ("objects[0].ao.reach", |s, x| {
            s.objects[0].occlusion = Some(Occlusion::Cones {
                reach: Some(x),
                steps: 3,
            });
        }),
    ] {
        for x in [nan, f32::INFINITY, -f32::INFINITY] {
            let error = refused(|s| change(s, x));
            let is_number = matches!(error.fault(), Fault::Number { .. } | Fault::Method(_));
            assert!(is_number, "{error:?}");
            let text = error.to_string();
            assert!(text.starts_with(&format!("{place}: this is ")), "{text}");
        }
    }
    says(
        &refused(|s| s.settings.exposure = f32::NAN),
        "settings.exposure: this is NaN, allowed is -20 to 20",
    );
}

#[test]
fn counts_are_in_their_ranges() {
    says(
        &refused(|s| s.settings.max_steps = 0),
        "settings.max_steps: this is 0, allowed is 1 to 100000",
    );
    says(
        &refused(|s| {
            s.settings.antialias = Antialias::Supersample {
                samples: 0,
                filter: Default::default(),
            };
        }),
        "settings.antialias.samples: this is 0, allowed is 1 to 1048576",
    );
    says(
        &refused(|s| s.lights = vec![light(); LIGHTS + 1]),
        "lights: 65 lights, at most 64 are allowed",
    );
    says(
        &refused(|s| s.materials = vec![Material::default(); 70_000]),
        "materials: 70000 materials, at most 65535 are allowed",
    );
    says(
        &refused(|s| s.objects = vec![s.objects[0].clone(); 70_000]),
        "objects: more than 65535 objects",
    );
}

#[test]
fn cameras_see() {
    says(
        &refused(|s| s.camera.axes = Mat3::ZERO),
        "camera.axes: the axes must have length 1 and be at right angles to each other",
    );
    says(
        &refused(|s| s.camera.axes.x_axis.x = f32::NAN),
        "camera.axes: the axes must have length 1 and be at right angles to each other",
    );
    says(
        &refused(|s| s.camera.lens = Lens::Pinhole { fov: 3.2 }),
        "camera.fov: this is 183.3465 degrees, allowed is 1 to 170",
    );
    says(
        &refused(|s| (s.camera.near, s.camera.far) = (2.0, 1.0)),
        "camera: `near` must be below `far`",
    );
    let scene = Scene::new(parts()).expect("a scene");
    let camera = Camera {
        near: -1.0,
        ..Camera::default()
    };
    assert!(scene.with_camera(camera).is_err());
}

#[test]
fn directions_images_and_shapes_fit() {
    says(
        &refused(|s| {
            s.lights[0].source = Source::Directional {
                direction: Vec3::ZERO,
            };
        }),
        "lights[0].source.direction: this must be a direction of length 1",
    );
    says(
        &refused(|s| {
            s.materials[0].pattern = Pattern::Gradient {
                colours: [Vec3::ONE.into(), Vec3::ONE.into()],
                from: Vec3::ONE,
                to: Vec3::ONE,
            };
        }),
        "materials[0].pattern: `from` and `to` must differ",
    );
    // each fits, all together are nowhere
    let tiny = |pattern| Pattern::Placed {
        pattern: Box::new(pattern),
        rows: [Vec3::X, Vec3::Y, Vec3::Z].map(|row| row * 1e6),
        offset: Vec3::ZERO,
    };
    let error = refused(|s| {
        let checker = Pattern::Checker {
            colours: [Vec3::ONE.into(), Vec3::ZERO.into()],
            size: 1.0,
        };
        s.materials[0].pattern = tiny(tiny(checker));
    });
    assert!(
        error.to_string().starts_with("materials[0].pattern.rows"),
        "{error}"
    );
    for (width, height, pixels) in [(0, 0, 0), (2, 2, 3), (u32::MAX, u32::MAX, 1)] {
        let image = Arc::new(Image {
            path: "wood.png".into(),
            width,
            height,
            pixels: vec![Vec3::ONE; pixels],
        });
        let error = refused(|s| {
            s.materials[0].pattern = Pattern::Triplanar {
                image: Arc::clone(&image),
                size: 1.0,
                sharpness: 4.0,
            };
        });
        says(
            &error,
            &format!(
                "materials[0].pattern.image: an image of {width}x{height} pixels with {pixels} of them"
            ),
        );
    }
    says(
        &refused(|s| s.objects[0].field = shape("circle")),
        "objects[0].field: a plane shape has no surface to show",
    );
}
