//! The JSON twin: from a scene to JSON and back nothing changes.

use std::collections::HashMap;
use zeroset_field::catalogue::Dimension;
use zeroset_field::catalogue::entries::catalogue;
use zeroset_field::field::{Field, Node};
use zeroset_scene::json::{expand, to_text};
use zeroset_scene::load::{Language, Loaded, Options, load_text};
use zeroset_scene::scene::{Object, Scene};

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

/// To JSON and back, and that nothing changed.
fn round_trip(scene: &Scene) -> String {
    let text = to_text(&expand(scene));
    let again = load("scene.json", &text, Language::Json).scene;
    let mut pairs = HashMap::new();
    assert_eq!(scene.objects.len(), again.objects.len());
    for (a, b) in scene.objects.iter().zip(&again.objects) {
        same(&a.field, &b.field, &mut pairs);
        assert_eq!(
            (&a.name, a.material, a.occlusion),
            (&b.name, b.material, b.occlusion)
        );
    }
    assert_eq!(scene.name, again.name);
    assert_eq!(scene.materials, again.materials);
    assert_eq!(scene.lights, again.lights);
    assert_eq!(scene.sky, again.sky);
    assert_eq!(scene.camera, again.camera);
    assert_eq!(scene.settings, again.settings);
    assert_eq!(
        text,
        to_text(&expand(&again)),
        "written again, it is the same text"
    );
    text
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
    let ball = base.objects[0].field.clone();
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
            ..base.objects[0].clone()
        })
        .collect();
    round_trip(&Scene { objects, ..base });
}

#[test]
fn what_is_left_out() {
    let loaded = load(
        "hand.json",
        r##"{"zeroset": 1, "objects": [{"field": {"sphere": {}}}]}"##,
        Language::Json,
    );
    let star = load("hand.star", "show(sphere())", Language::Starlark).scene;
    assert_eq!(to_text(&expand(&loaded.scene)), to_text(&expand(&star)));
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
    assert!(scene.lights.is_empty());
    let Node::Map { params, .. } = scene.objects[0].field.node() else {
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
            let scene = load("reach.star", &text, Language::Starlark).scene;
            let json = round_trip(&scene);
            assert_eq!(
                json.contains("\"reach\": 0.25"),
                written,
                "{method}: {json}"
            );
            assert_eq!(json.contains("\"reach\""), written, "{method}: {json}");
            let again = load("reach.json", &json, Language::Json).scene;
            assert_eq!(again.settings.occlusion, scene.settings.occlusion);
        }
    }
}
