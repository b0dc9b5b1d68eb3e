//! The JSON twin: from a scene to JSON and back nothing changes.

use glam::Vec3;
use proptest::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use zeroset_catalogue::Dimension;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::field::{Field, Node};
use zeroset_field::placement::Placement;
use zeroset_field::sampled::Sampled;
use zeroset_language::json::{expand, to_text};
use zeroset_language::load::{Language, Loaded, Options, load_text};
use zeroset_number::Grid;
use zeroset_scene::camera::Lens;
use zeroset_scene::light::Source;
use zeroset_scene::material::Pattern;
use zeroset_scene::scene::{Object, Scene, SceneParts};
use zeroset_scene::settings::{March, Occlusion, Shadow};

fn load(name: &str, text: &str, language: Language) -> Loaded {
    match load_text(name, text, language, None, &Options::default()) {
        Ok(loaded) => loaded,
        Err(failed) => panic!("{:?}", miette::Report::new(*failed.report)),
    }
}

/// Whether two fields are the same: their nodes, every bit of their numbers, and what they share.
fn same(a: &Field, b: &Field, pairs: &mut HashMap<usize, usize>) {
    if let Some(other) = pairs.insert(a.key(), b.key()) {
        assert_eq!(other, b.key(), "shared on one side only");
        return;
    }
    let bits = |p: &[f64]| p.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    match (a.node(), b.node()) {
        (
            Node::Primitive {
                entry: x,
                params: p,
            },
            Node::Primitive {
                entry: y,
                params: q,
            },
        ) => {
            assert_eq!((x.info.name, bits(p)), (y.info.name, bits(q)));
        }
        (
            Node::Map {
                entry: x,
                params: p,
                ..
            },
            Node::Map {
                entry: y,
                params: q,
                ..
            },
        ) => {
            assert_eq!((x.info.name, bits(p)), (y.info.name, bits(q)));
        }
        (
            Node::Modify {
                entry: x,
                params: p,
                ..
            },
            Node::Modify {
                entry: y,
                params: q,
                ..
            },
        ) => {
            assert_eq!((x.info.name, bits(p)), (y.info.name, bits(q)));
        }
        (
            Node::Join {
                entry: x,
                params: p,
                ..
            },
            Node::Join {
                entry: y,
                params: q,
                ..
            },
        ) => {
            assert_eq!((x.info.name, bits(p)), (y.info.name, bits(q)));
        }
        (Node::Place { placement: x, .. }, Node::Place { placement: y, .. }) => assert_eq!(x, y),
        (Node::Repeat { repetition: x, .. }, Node::Repeat { repetition: y, .. }) => {
            assert_eq!(x, y)
        }
        (Node::Polar { polar: x, .. }, Node::Polar { polar: y, .. }) => assert_eq!(x, y),
        (Node::Paint { paint: x, .. }, Node::Paint { paint: y, .. }) => assert_eq!(x, y),
        (Node::Formula(x), Node::Formula(y)) => assert_eq!(x, y),
        (x, y) => panic!("{x:?} and {y:?}"),
    }
    assert_eq!(a.facts(), b.facts());
    assert_eq!(a.children().len(), b.children().len());
    a.children()
        .iter()
        .zip(b.children())
        .for_each(|(a, b)| same(a, b, pairs));
}

#[test]
fn a_field_of_samples_is_refused() {
    let grid = Arc::new(Grid::new([2; 3], vec![1.0; 8]).unwrap());
    let sampled = Sampled::new(grid, Aabb::centred([1.0; 3])).unwrap();
    let field = Field::sampled(Arc::new(sampled));
    let mut scene = load("a.star", "show(sphere())", Language::Starlark).scene;
    let placed = field.place(Placement::moved([1.0; 3])).unwrap();
    scene.edit(|s| s.objects[0].field = placed).unwrap();
    let error = expand(&scene).unwrap_err();
    assert!(error.to_string().contains("field of samples"), "{error}");
}

/// To JSON and back, and that nothing changed.
fn round_trip(scene: &Scene) -> String {
    let text = to_text(&expand(scene).unwrap());
    let again = load("scene.json", &text, Language::Json).scene;
    assert_same(scene, &again);
    assert_eq!(
        text,
        to_text(&expand(&again).unwrap()),
        "written again, it is the same text"
    );
    text
}

/// Whether two scenes are the same, to the bit.
fn assert_same(scene: &Scene, again: &Scene) {
    let mut pairs = HashMap::new();
    assert_eq!(scene.objects().len(), again.objects().len());
    for (a, b) in scene.objects().iter().zip(again.objects()) {
        same(&a.field, &b.field, &mut pairs);
        assert_eq!(
            (&a.name, a.material, a.occlusion),
            (&b.name, b.material, b.occlusion)
        );
    }
    assert_eq!(scene.name(), again.name());
    assert_eq!(scene.materials(), again.materials());
    assert_eq!(scene.lights(), again.lights());
    assert_eq!(scene.sky(), again.sky());
    assert_eq!(scene.camera(), again.camera());
    assert_eq!(scene.settings(), again.settings());
    // equality of floats takes -0 for 0
    let bits = |s: &Scene| {
        format!(
            "{:?}",
            (s.materials(), s.lights(), s.sky(), s.camera(), s.settings())
        )
    };
    assert_eq!(bits(scene), bits(again));
}

const ALL: &str = r##"
s = sphere(0.3).move(x = 1.1, y = -0.0)
deep = s
for i in range(60):
    deep = (deep - box(0.1).move(y = i)).round(0.01).turn(x = i / 7)
show(s | s.turn(y = 33).scale(1.7) | box((1, 2, 3)).twist(30.3) , material(color = checker("red", "#123", 0.3)), name = "é\"1")
show(deep, material(color = stripes("red", "blue", (1, 2, 3)), emission = "lime", strength = 3), ao = bent())
show(s.repeat((2, 0, 3), count = (5, 0, 7), vary = (0.1, 0.2, 0.3), seed = 9), noise(octaves = 3))
show(box(0.1).move(x = 3).polar(12).paint("teal"), gradient(start = (1, 2, 3)))
show(sphere().smooth_union(box(1), 0.2).onion(0.1), orbit())
marble = material(color = lambda p: mix("red", "white", 0.5 + 0.5 * noise(3 * p)), roughness = lambda p: clamp(s(p) + p.x, 0, 1),
    bump = checker(lambda p: p.x * pow(p.y, 3), stripes(0.5, lambda p: (p.x, s(p.zyx), 0.1)).turn(x = 20)))
show(torus().paint(marble).move(y = 5), marble)
camera(eye = (3, 2, 4.7), fov = 33.3)
sun(direction = (0.1, -2, 0.3), color = "#fed")
point_light((1, 2, 3), shadow = none())
sky(top = "#cfe3ff", ambient = 0.41)
render(size = (640, 360), march = relaxed(1.3), normals = "exact", ao = obscurance(), aa = supersample(9, "tent"), exposure = 0.1)
"##;

#[test]
fn of_a_written_scene() {
    let text = round_trip(&load("all.star", ALL, Language::Starlark).scene);
    insta::assert_snapshot!("all", text);
}

/// Every entry of the catalogue, at its defaults and at every parameter set worth a proof.
#[test]
fn of_the_catalogue() {
    let all = catalogue();
    let base = load("a.star", "show(sphere())", Language::Starlark).scene;
    let ball = base.objects()[0].field.clone();
    let flat = all
        .primitives
        .iter()
        .find(|e| e.info.dimension == Dimension::Two);
    let flat = flat.map(|e| Field::primitive(e, e.info.defaults()).unwrap());
    let mut fields = Vec::new();
    let solid = |field: Field| match field.facts().dimension {
        Dimension::Two => field
            .modify(all.modifier("extrude").unwrap(), vec![1.0])
            .unwrap(),
        _ => field,
    };
    let sets = |defaults: Vec<f64>, samples: &[&[f64]]| {
        std::iter::once(defaults)
            .chain(samples.iter().map(|s| s.to_vec()))
            .collect::<Vec<Vec<f64>>>()
    };
    for e in &all.primitives {
        for params in sets(e.info.defaults(), e.samples) {
            fields.push(solid(Field::primitive(e, params).unwrap()));
        }
    }
    let operand = |two: bool| {
        if two {
            flat.clone()
        } else {
            Some(ball.clone())
        }
    };
    for e in &all.maps {
        for params in sets(e.info.defaults(), e.samples) {
            fields.extend(
                operand(e.info.dimension == Dimension::Two)
                    .and_then(|f| f.map(e, params).ok())
                    .map(solid),
            );
        }
    }
    for e in &all.modifiers {
        for params in sets(e.info.defaults(), e.samples) {
            fields.extend(
                operand(e.info.dimension == Dimension::Two)
                    .and_then(|f| f.modify(e, params).ok())
                    .map(solid),
            );
        }
    }
    for e in &all.joins {
        for params in sets(e.info.defaults(), e.samples) {
            fields.push(Field::join(e, params, vec![ball.clone(), fields[0].clone()]).unwrap());
        }
    }
    let objects = fields
        .into_iter()
        .map(|field| Object {
            field,
            ..base.objects()[0].clone()
        })
        .collect();
    let parts = SceneParts {
        objects,
        ..base.into_parts()
    };
    round_trip(&parts.build().unwrap());
}

#[test]
fn what_is_left_out() {
    let loaded = load(
        "hand.json",
        r##"{"zeroset": 1, "objects": [{"field": {"sphere": {}}}]}"##,
        Language::Json,
    );
    let star = load("hand.star", "show(sphere())", Language::Starlark).scene;
    assert_eq!(
        to_text(&expand(&loaded.scene).unwrap()),
        to_text(&expand(&star).unwrap())
    );
    // colours as text, angles in degrees or radians, a camera that looks at something
    let text = r##"{
        "zeroset": 1,
        "objects": [{"field": {"twist": {"rate_radians": 0.5, "of": {"box": {"size": 2}}}}, "material": 0}],
        "materials": [{"pattern": {"kind": "solid", "colour": "#fff"}, "specular": 0, "shininess": 10, "metallic": 0,
                       "roughness": 1, "emission": [0, 0, 0]}],
        "lights": [],
        "camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "height": 4}
    }"##;
    let scene = load("hand.json", text, Language::Json).scene;
    assert!(scene.lights().is_empty());
    let Node::Map { params, .. } = scene.objects()[0].field.node() else {
        panic!("a twist")
    };
    assert_eq!(params, &[0.5]);
}

/// Occlusion sees the whole sky unless a reach is given, and both forms of a scene say so.
#[test]
fn reach_of_occlusion() {
    for method in ["cones", "hemisphere", "obscurance"] {
        for (reach, written) in [("", false), ("reach = 0.25", true)] {
            let text = format!("show(sphere())\nrender(ao = {method}({reach}))");
            let scene = load("sky.star", &text, Language::Starlark).scene;
            let json = round_trip(&scene);
            assert_eq!(
                json.contains("\"reach\": 0.25"),
                written,
                "{method}: {json}"
            );
            assert_eq!(json.contains("\"reach\""), written, "{method}: {json}");
            let again = load("sky.json", &json, Language::Json).scene;
            assert_eq!(again.settings().occlusion, scene.settings().occlusion);
        }
    }
}

/// What the language makes can be written and read, at the edges of its ranges too.
#[test]
fn of_scripts_at_the_edges() {
    for script in [
        "camera(lens = orthographic(1e-6))",
        "camera(lens = orthographic(1e6))",
        "camera(eye = (1e30, 0, 0))",
        "camera(near = 1e-6, far = 1e9)",
        "camera(fov = 1)\nshow(sphere().move(x = 1e12))",
        "camera(fov = 170)\nshow(sphere().move(x = -3e20))",
        "camera(direction = (1e-300, 1e-300, 0), up = (1e-200, 0, 1e-200))",
        "sun(direction = (1e-200, 0, 0))",
        "sun(direction = (1e-320, 1e-320, 0))",
        "sun(direction = (1e200, -1e200, 1e-200))",
        "sun(direction = (1, 1e-40, 0), strength = 1e6)",
        "point_light((1e9, 0, 0), strength = 1e6, color = (1, 1, 1))",
        "show(sphere(), gradient(start = (1e8, 0, 0), end = (-1e8, 1e-30, 0)))",
        "show(sphere(), stripes(\"red\", \"blue\", (1e-300, 0, 1e-300), 1e-6))",
        "show(sphere(), checker(\"red\", \"blue\", 1e6))",
        "sky(top = \"#000\", ambient = 10)",
        "show(sphere(1e-6))",
        "show(sphere().scale(1e-6).turn(x = 1e-300))",
        "show(box(1).twist(1e-9))",
        "show(formula(\"x*1e30 + 1e-300\", slope = 1e30, bounds = box(1e3)))",
    ] {
        let text = format!("{script}\nshow(sphere(), name = \"\\x01\\u202e\\\"\")");
        match load_text(
            "edge.star",
            &text,
            Language::Starlark,
            None,
            &Options::default(),
        ) {
            Ok(loaded) => drop(round_trip(&loaded.scene)),
            // refused, with what is wrong, rather than written as something else
            Err(failed) => {
                let message = failed.report.message().to_string();
                assert!(!message.contains("bug"), "{script}: {message}");
                println!("{script}: {message}");
            }
        }
    }
    let star = |text: &str| load("a.star", text, Language::Starlark).scene;
    let Source::Directional { direction } =
        star("sun(direction = (1e-200, 0, 0))\nshow(sphere())").lights()[0].source
    else {
        panic!("a sun")
    };
    assert_eq!(direction.to_array(), [1.0, 0.0, 0.0]);
    let far = star("show(sphere(1e9).move(x = 1e9))").camera().far;
    assert!(far > 1e9, "{far}");
    round_trip(&star("show(sphere(1e6).move(x = 1e9))"));
}

/// Numbers that are likely to be trouble.
fn nasty() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(0.0),
        Just(-0.0),
        Just(1.0),
        Just(1e-6),
        Just(1e6),
        Just(1e9),
        Just(0.1),
        Just(f32::MIN_POSITIVE),
        Just(f32::from_bits(1)),
        Just(f32::MAX),
        Just(f32::INFINITY),
        Just(f32::NAN),
        any::<f32>(),
        -10.0..10.0_f32,
    ]
}

/// A scene of which some numbers are replaced.
fn damaged(numbers: &[(u8, f32)], wide: f64, turn: [f64; 3]) -> SceneParts {
    let mut scene = load("all.star", ALL, Language::Starlark).scene.into_parts();
    for &(what, x) in numbers {
        let material = usize::from(what) % scene.materials.len();
        match what % 24 {
            0 => scene.camera.eye.x = x,
            1 => scene.camera.near = x,
            2 => scene.camera.far = x,
            3 => scene.camera.lens = Lens::Orthographic { height: x },
            4 => scene.camera.lens = Lens::Pinhole { fov: x },
            5 => scene.camera.axes.x_axis.x = x,
            6 => scene.sky.ambient = x,
            7 => scene.sky.horizon.z = x,
            8 => scene.lights[0].radiance.y = x,
            9 => {
                scene.lights[0].source = Source::Directional {
                    direction: Vec3::new(x, 1.0, 0.0).normalize(),
                }
            }
            10 => {
                scene.lights[0].source = Source::Directional {
                    direction: Vec3::new(0.0, x, 1.0),
                }
            }
            11 => {
                scene.lights[0].source = Source::Point {
                    position: Vec3::splat(x),
                }
            }
            12 => scene.lights[0].shadow = Shadow::Soft { sharpness: x },
            13 => scene.settings.exposure = x,
            14 => scene.settings.footprint = x,
            15 => scene.settings.march = March::Relaxed { omega: x },
            16 => {
                scene.objects[0].occlusion = Some(Occlusion::Hemisphere {
                    rays: 3,
                    reach: Some(x),
                })
            }
            17 => scene.materials[material].roughness = x,
            18 => scene.materials[material].emission.x = x,
            19 => scene.materials[material].shininess = x,
            20 => {
                scene.materials[material].pattern = Pattern::Gradient {
                    colours: [Vec3::ONE.into(), Vec3::splat(x).into()],
                    from: Vec3::splat(x),
                    to: Vec3::ZERO,
                }
            }
            21 => {
                scene.materials[material].pattern = Pattern::Stripes {
                    colours: [Vec3::ONE.into(), Vec3::ONE.into()],
                    direction: Vec3::new(x, x, 0.0).normalize_or_zero(),
                    size: x.abs(),
                }
            }
            22 => scene.objects[0].material = what.into(),
            _ => {
                let ball = scene.objects[0].field.clone();
                let placed = ball.place(Placement::moved([wide, f64::from(x), turn[0]]));
                let field = placed.and_then(|f| f.place(Placement::scaled(turn[1])));
                if let Ok(field) = field {
                    scene.objects[0].field = field;
                }
            }
        }
    }
    scene
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// Whatever a program puts into a scene: it is refused, or it can be written and read without any change.
    #[test]
    fn of_any_numbers(numbers in prop::collection::vec((any::<u8>(), nasty()), 1..4), wide in any::<f64>(), turn in any::<[f64; 3]>()) {
        match damaged(&numbers, wide, turn).build() {
            // named by its place
            Err(error) => prop_assert!(!error.path().is_empty(), "{}", error),
            Ok(scene) => {
                let text = to_text(&expand(&scene)?);
                prop_assert!(!text.contains("null"), "{}", text);
                let again = load_text("scene.json", &text, Language::Json, None, &Options::default());
                let again = again.map_err(|f| TestCaseError::fail(format!("{numbers:?}: {}", f.report)))?;
                assert_same(&scene, &again.scene);
            }
        }
    }

    /// Numbers in the ranges of the language are never refused.
    #[test]
    fn of_good_numbers(
        eye in prop::array::uniform3(-1e9..1e9_f32), height in 1e-6..1e6_f32, far in 1.0..1e30_f32, sharp in 1.0..1000.0_f32,
        light in prop::array::uniform3(0.0..1e6_f32), offset in prop::array::uniform3(-1e30..1e30), scale in 1e-6..1e6,
    ) {
        let mut scene = load("all.star", ALL, Language::Starlark).scene;
        scene.edit(|s| {
s.camera.eye = eye.into();
s.camera.far = far;
s.camera.lens = Lens::Orthographic { height };
s.lights[0].radiance = light.into();
s.lights[0].shadow = Shadow::Soft { sharpness: sharp };
}).expect("a scene");
        let moved = scene.objects()[0].field.place(Placement::moved(offset)).unwrap();
        scene.edit(|s| s.objects[0].field = moved.place(Placement::scaled(scale)).unwrap()).expect("a scene");
        round_trip(&scene);
    }
}
