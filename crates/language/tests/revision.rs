//! Values written back into scene files: what is loaded again is what was wanted, and all else is as it was.

use glam::Vec3;
use proptest::prelude::*;
use std::path::Path;
use zeroset_language::assets::Assets;
use zeroset_language::load::{Loaded, Options, Setting, load};
use zeroset_language::revision::{Change, Look, Reason, Revised, revise_file};
use zeroset_scene::camera::{Camera, Lens};
use zeroset_scene::light::Source;

/// A file with a comment on every line, and blanks where nobody expects them.
const SCENE: &str = r##"# An apple that somebody bit into.
bite = slider("bite", 0.2, 0, 1)  # how deep; "bite" again
n = slider( name = 'n' , default = -3 , min = -10, max = 10 )
kind = choice("kind", ["plain", "a \"quoted\" one", 'it\'s'], 'plain')
on   = toggle("on")   # 0.2
tint = color("tint",
             "#e4572e",  # "#e4572e"
            )
clay = material(color = tint, roughness = 0.4)
red = material(color = "#c03020")
show(sphere(1) - sphere(0.2 + bite).move(x = 1), clay, name = "apple")
show(box(0.2).move(y = n), red)
show(box(0.3).move(x = 2), material = "teal")
if on:
    show(torus(1, 0.1))
sun(direction = (0.5, -1, -0.25))
sky(top = "#8fb4dd", ambient = 0.4)
camera( eye = (2.6, 2.3, 4.4), target = (0.1,0.82,0), fov = 36 )  # from the right
# the end"##;

fn written(text: &str, ending: &str) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("scene.{ending}"));
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

fn set(all: &[(&str, &str)]) -> Options {
    Options {
        set: all
            .iter()
            .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
            .collect(),
        ..Options::default()
    }
}

fn revised(path: &Path, options: &Options, changes: &[Change]) -> Revised {
    revise_file(path, options, changes, &Assets::default()).unwrap()
}

/// As [`revised`], and writes it.
fn saved(path: &Path, options: &Options, changes: &[Change]) -> (Revised, Loaded) {
    let revised = revised(path, options, changes);
    std::fs::write(path, &revised.revision.text).unwrap();
    (revised, load(path, &Options::default()).unwrap())
}

fn looking(eye: Vec3, target: Vec3, fov: f32) -> Change {
    let lens = Lens::Pinhole { fov };
    let camera = Camera::look_at(eye, target, Vec3::Y, lens).unwrap();
    Change::Camera { camera, target }
}

/// The text between what two texts begin and end with alike.
fn middle<'a>(a: &'a str, b: &str) -> &'a str {
    let begin = (a.bytes().zip(b.bytes()))
        .take_while(|(a, b)| a == b)
        .count();
    let most = a.len().min(b.len()) - begin;
    let end = (a.bytes().rev().zip(b.bytes().rev()))
        .take(most)
        .take_while(|(a, b)| a == b)
        .count();
    &a[begin..a.len() - end]
}

#[test]
fn only_the_values_change() {
    let (_folder, path) = written(SCENE, "star");
    let options = set(&[
        ("bite", "0.75"),
        ("n", "2.5"),
        ("kind", "it's"),
        ("on", "true"),
        ("tint", "#20a0ff"),
    ]);
    let (revised, again) = saved(&path, &options, &[]);
    assert_eq!(revised.revision.left, []);
    let expected = SCENE
        .replace("\"bite\", 0.2,", "\"bite\", 0.75,")
        .replace("default = -3", "default = 2.5")
        .replace("'plain')", "'it\\'s')")
        .replace("toggle(\"on\")", "toggle(\"on\", default = True)")
        .replace("\"#e4572e\",  #", "\"#20a0ff\",  #");
    assert_eq!(revised.revision.text, expected);
    assert_eq!(again.parameters.len(), 5);
    assert!(again.parameters.iter().all(|p| p.value == p.default));
    // nothing is left to write
    assert!(!self::revised(&path, &options, &[]).is_changed());
}

#[test]
fn cameras_suns_skies_and_materials() {
    let (_folder, path) = written(SCENE, "star");
    let look = Look {
        colour: Some([0.0, 0.0, 1.0]),
        roughness: Some(0.15),
        ..Look::default()
    };
    let changes = [
        looking(Vec3::new(1.5, 2.0, -4.25), Vec3::new(0.0, 0.5, 0.0), 0.5),
        Change::Sun {
            light: 0,
            direction: Vec3::new(-0.6, -0.8, 0.0),
            radiance: Vec3::new(1.0, 0.5, 0.25) * 3.0,
        },
        Change::Sky {
            top: Vec3::new(0.1, 0.2, 0.3),
            horizon: Vec3::new(0.7, 0.8, 0.9),
            bottom: Vec3::new(0.05, 0.04, 0.03),
            ambient: 1.25,
        },
        Change::Material { material: 1, look },
        Change::Material {
            material: 2,
            look: Look {
                metallic: Some(1.0),
                ..Look::default()
            },
        },
    ];
    let (revised, again) = saved(&path, &Options::default(), &changes);
    assert_eq!(revised.revision.left, [], "{}", revised.revision.text);
    assert_eq!(revised.revision.written.len(), changes.len());
    let text = &revised.revision.text;
    for line in [
        "camera( eye = (1.5, 2, -4.25), target = (0, 0.5, 0), fov = ",
        "red = material(color = \"#0000ff\", roughness = 0.15)",
        "material = material(color = \"teal\", metallic = 1)",
        "sun(direction = (-0.6, -0.8, 0), color = ",
        "  # from the right\n# the end",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    assert_eq!(again.scene.camera().eye, Vec3::new(1.5, 2.0, -4.25));
    assert_eq!(again.scene.camera().lens, Lens::Pinhole { fov: 0.5 });
    assert_eq!(again.scene.sky().ambient, 1.25);
    let light = again.scene.lights()[0];
    assert!(
        matches!(light.source, Source::Directional { direction } if (direction - Vec3::new(-0.6, -0.8, 0.0)).length() < 1e-6)
    );
}

#[test]
fn a_camera_and_a_sun_that_are_missing_are_added() {
    for text in [
        "show(sphere(1))\nshow(plane())",
        "show(sphere(1))\r\nshow(plane())\r\n",
        "# a mark\nshow(sphere(1))\nshow(plane())  # end",
    ] {
        let (_folder, path) = written(text, "star");
        let sun = Change::Sun {
            light: 0,
            direction: Vec3::new(0.0, -1.0, 0.0),
            radiance: Vec3::splat(0.5),
        };
        let camera = looking(Vec3::new(3.0, 2.0, 1.0), Vec3::ZERO, 0.7);
        let (revised, again) = saved(&path, &Options::default(), &[camera, sun]);
        assert_eq!(revised.revision.left, []);
        let new = &revised.revision.text;
        assert!(
            new.starts_with(text) && new.ends_with(")\r\n") == text.contains('\r'),
            "{new}"
        );
        assert_eq!(again.scene.camera().eye, Vec3::new(3.0, 2.0, 1.0));
        assert_eq!(again.scene.lights().len(), 1);
    }
}

#[test]
fn other_ways_to_say_a_camera() {
    for (text, kept) in [
        ("camera(direction = \"-z\")", ""),
        ("camera(turn = (0, 30, 0), eye = (0, 0, 5))", ""),
        ("camera((0, 0, 5), (0, 0, 0))", "camera((1, 2, 6), "),
        ("camera(eye = (0, 0, 5), up = \"z\", fov = 30)", "fov = 30"),
        (
            "camera(lens = orthographic(3), eye = (0, 0, 5))",
            "orthographic(3)",
        ),
        (
            "camera(eye = ( 0, 0, 5, ), target = (0, # x\n 0, 1 # z\n))",
            "eye = (1, 2, 6), target = (0, 0, 0 # z\n))",
        ),
        ("camera()", "camera(eye = (1, 2, 6), target = (0, 0, 0)"),
        ("camera(eye = (0, 0, 5), aperture = 0.1)", "focus = 7"),
    ] {
        let (_folder, path) = written(&format!("show(sphere(1))\n{text}\n"), "star");
        let before = load(&path, &Options::default()).unwrap();
        let (eye, target) = (Vec3::new(1.0, 2.0, 6.0), Vec3::ZERO);
        let lens = before.scene.camera().lens;
        let camera = Camera {
            near: before.scene.camera().near,
            far: before.scene.camera().far,
            aperture: before.scene.camera().aperture,
            focus: 7.0,
            ..Camera::look_at(eye, target, Vec3::Y, lens).unwrap()
        };
        let (revised, again) = saved(
            &path,
            &Options::default(),
            &[Change::Camera { camera, target }],
        );
        assert_eq!(revised.revision.left, [], "{text}");
        assert!(
            revised.revision.text.contains(kept),
            "{}",
            revised.revision.text
        );
        assert!(again.scene.camera().axes.abs_diff_eq(camera.axes, 1e-5));
        assert_eq!(
            (again.scene.camera().eye, again.scene.camera().lens),
            (eye, lens)
        );
    }
}

/// What is left of a change, and why.
fn reason(text: &str, options: &Options, changes: &[Change]) -> Reason {
    let (_folder, path) = written(text, "star");
    let parts = path.with_file_name("parts.star");
    std::fs::write(
        parts,
        "r = slider(\"inner\", 0.5)\ndef place():\n    camera(eye = (0, 0, 5))\n",
    )
    .unwrap();
    let revised = revised(&path, options, changes);
    assert_eq!(revised.revision.left.len(), 1, "{}", revised.revision.text);
    assert!(!revised.is_changed());
    assert!(revised.revision.written.is_empty());
    revised.revision.left[0].reason.clone()
}

#[test]
fn what_cannot_be_written_is_left_and_said() {
    let moved = |name| set(&[(name, "0.9")]);
    let expression = reason(
        "b = 0.1\nshow(sphere(slider(\"r\", 2 * b, 0, 1)))\n",
        &moved("r"),
        &[],
    );
    assert!(
        matches!(&expression, Reason::Expression { what, line: 2 } if what.contains("default"))
    );
    assert_eq!(
        expression.to_string(),
        "`default` of slider() is no literal but an expression (line 2)"
    );
    let other = reason(
        "load(\"parts.star\", \"r\")\nshow(sphere(r))\n",
        &moved("inner"),
        &[],
    );
    assert_eq!(other, Reason::OtherFile("parts.star".into()));
    let names = "for i in range(2):\n    show(sphere(slider(\"r%d\" % i, 0.5)))\n";
    assert!(matches!(
        reason(names, &moved("r1"), &[]),
        Reason::Expression { .. }
    ));
    let spread = "a = [\"r\", 0.5]\nshow(sphere(slider(*a)))\n";
    assert!(matches!(
        reason(spread, &moved("r"), &[]),
        Reason::Spread { .. }
    ));

    let camera = [looking(Vec3::new(0.0, 1.0, 3.0), Vec3::ZERO, 0.7)];
    let plain = Options::default();
    assert_eq!(reason("show(sphere(1))\n", &plain, &camera), Reason::Stage);
    let path = "e = (0, 0, 5)\nshow(sphere(1))\ncamera(eye = e)\n";
    assert!(matches!(
        reason(path, &plain, &camera),
        Reason::Expression { line: 3, .. }
    ));
    let inside = "load(\"parts.star\", \"place\")\nshow(sphere(1))\nplace()\n";
    let said = reason(inside, &plain, &camera).to_string();
    assert!(said.contains("stated already in parts.star"), "{said}");
    let branches = "show(sphere(1))\nif True:\n    camera(eye = (0, 0, 5))\nelse:\n    camera(eye = (0, 0, 6))\n";
    assert!(matches!(
        reason(branches, &plain, &camera),
        Reason::Many { count: 2, .. }
    ));
    let sun = [Change::Sun {
        light: 1,
        direction: Vec3::NEG_Y,
        radiance: Vec3::ONE,
    }];
    let ring = "show(sphere(1))\nfor i in range(3):\n    sun(direction = (i, -1, 0))\n";
    assert!(matches!(
        reason(ring, &plain, &sun),
        Reason::Repeated { line: 3, .. }
    ));
}

#[test]
fn one_that_is_left_does_not_hold_the_others_back() {
    let text = "b = 0.1\nr = slider(\"r\", b)\ns = slider(\"s\", 0.5)\nshow(sphere(r) | box(s))\n";
    let (_folder, path) = written(text, "star");
    let camera = looking(Vec3::new(0.0, 1.0, 3.0), Vec3::ZERO, 0.7);
    let (revised, _) = saved(&path, &set(&[("r", "0.3"), ("s", "0.7")]), &[camera]);
    assert_eq!(revised.revision.written, ["`s`"]);
    assert_eq!(
        revised.revision.text,
        text.replace("\"s\", 0.5", "\"s\", 0.7")
    );
    let left: Vec<&str> = revised
        .revision
        .left
        .iter()
        .map(|l| l.subject.as_str())
        .collect();
    assert_eq!(left, ["`r`", "the camera"]);
}

#[test]
fn a_mark_at_the_beginning_stays() {
    let text = "\u{feff}s = slider(\"größe\", 0.5)\nshow(sphere(s))\nshow(plane())\n";
    let (_folder, path) = written(text, "star");
    let (revised, _) = saved(&path, &set(&[("größe", "0.25")]), &[]);
    assert_eq!(revised.revision.text, text.replace("0.5", "0.25"));
}

#[test]
fn json_scenes() {
    let text = r##"{
  "zeroset": 1,
  "objects": [{"field": {"sphere": {}}, "material": 0}],
  "materials": [{"pattern": {"kind": "solid", "colour": [1, 0, 0]}, "specular": 0.25, "shininess": 30, "metallic": 0, "roughness": 0.25, "emission": [0, 0, 0]}],
  "lights": [
    {"source": {"kind": "directional", "direction": [0.0, -1.0, 0.0]}, "radiance": [1, 1, 1], "shadow": {"method": "hard"}}
  ]
}
"##;
    let (_folder, path) = written(text, "json");
    let changes = [
        looking(Vec3::new(0.0, 1.0, 3.0), Vec3::ZERO, 0.7),
        Change::Sun {
            light: 0,
            direction: Vec3::new(0.6, -0.8, 0.0),
            radiance: Vec3::ONE,
        },
        Change::Material {
            material: 0,
            look: Look {
                metallic: Some(0.5),
                ..Look::default()
            },
        },
    ];
    let (revised, again) = saved(&path, &Options::default(), &changes);
    assert_eq!(revised.revision.left, [], "{}", revised.revision.text);
    let new = &revised.revision.text;
    assert!(
        new.contains("\"direction\": [0.6, -0.8, 0.0]}, \"radiance\": [1, 1, 1],"),
        "{new}"
    );
    assert!(
        new.contains("\"metallic\": 0.5, \"roughness\": 0.25,"),
        "{new}"
    );
    assert!(new.contains("  ],\n  \"camera\": {\"eye\": "), "{new}");
    assert_eq!(again.scene.camera().eye, Vec3::new(0.0, 1.0, 3.0));
    // and again, where it stands by now
    let closer = looking(Vec3::new(0.0, 1.0, 2.0), Vec3::ZERO, 0.7);
    let (second, _) = saved(&path, &Options::default(), &[closer]);
    assert_eq!(second.revision.text, new.replace("1.0, 3.0]", "1.0, 2.0]"));
}

/// The comparison that leaves changes out notices a scene that is not as wanted: a slider that hides another of its name.
#[test]
fn a_planted_difference_is_found() {
    let text = "s = slider(\"s\", 0.5)\nt = slider(\"s\", 0.5)\nshow(sphere(s) | box(t))\nshow(plane())\nif s > 0.6:\n    sky(top = \"red\")\n";
    let (_folder, path) = written(text, "star");
    let (revised, again) = saved(&path, &set(&[("s", "0.75")]), &[]);
    // both calls, which must agree
    assert_eq!(
        revised.revision.text,
        text.replace("\"s\", 0.5", "\"s\", 0.75")
    );
    assert_eq!(again.parameters[0].default, Setting::Number(0.75));
    // a material that two things have, of which one is painted where no change reaches it
    let text = "red = \"#ff0000\"\nshow(sphere(1), material(color = \"#ff0000\"))\nshow(box(1).paint(red).move(x = 3), \"blue\")\nshow(plane(), \"white\")\n";
    let look = Look {
        colour: Some([0.0, 1.0, 0.0]),
        ..Look::default()
    };
    let (_folder, path) = written(text, "star");
    let before = load(&path, &Options::default()).unwrap();
    let material = usize::from(before.scene.objects()[0].material);
    let left = self::revised(
        &path,
        &Options::default(),
        &[Change::Material { material, look }],
    );
    assert!(
        matches!(left.revision.left[0].reason, Reason::Refused(_)),
        "{}",
        left.revision.text
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Whatever is set, the file says it afterwards, and between the values it is as it was.
    #[test]
    fn what_was_written_is_loaded(
        bite in 0.0..=1.0_f64,
        n in prop_oneof![Just(0.0), -10.0..=10.0_f64, Just(-1e-7)],
        kind in 0..3_usize,
        on: bool,
        tint: [u8; 3],
        eye in [-50.0..50.0_f32, -50.0..50.0_f32, 1.0..50.0_f32],
        target in [-0.9..0.9_f32, -0.9..0.9_f32, -0.9..0.9_f32],
        fov in 0.1..2.5_f32,
        way in [-1.0..1.0_f32, 0.1..1.0_f32, -1.0..1.0_f32],
    ) {
        let (_folder, path) = written(SCENE, "star");
        let kind = ["plain", "a \"quoted\" one", "it's"][kind];
        let [r, g, b] = tint;
        let options = set(&[
            ("bite", &bite.to_string()),
            ("n", &n.to_string()),
            ("kind", kind),
            ("on", &on.to_string()),
            ("tint", &format!("#{r:02x}{g:02x}{b:02x}")),
        ]);
        let direction = -Vec3::from(way).normalize();
        let sun = Change::Sun { light: 0, direction, radiance: Vec3::ONE };
        let camera = looking(Vec3::from(eye), Vec3::from(target), fov);
        let set_so = load(&path, &options).unwrap();
        let (revised, again) = saved(&path, &options, &[camera.clone(), sun]);
        prop_assert_eq!(&revised.revision.left, &[]);
        prop_assert_eq!(&again.parameters.len(), &5);
        for (now, wanted) in again.parameters.iter().zip(&set_so.parameters) {
            prop_assert_eq!(&now.default, &wanted.value);
            prop_assert_eq!(&now.control, &wanted.control);
        }
        let Change::Camera { camera, .. } = camera else { unreachable!() };
        prop_assert_eq!(again.scene.camera().eye, camera.eye);
        prop_assert_eq!(again.scene.camera().lens, camera.lens);
        prop_assert!(again.scene.camera().axes.abs_diff_eq(camera.axes, 2e-5));
        let Source::Directional { direction: now } = again.scene.lights()[0].source else { unreachable!() };
        prop_assert!(now.abs_diff_eq(direction, 1e-6));
        // line by line, all that is no value is as it was
        let (old, new) = (SCENE.lines(), revised.revision.text.lines());
        prop_assert_eq!(old.clone().count(), new.clone().count());
        for (old, new) in old.zip(new) {
            let is_value = ["slider(", "choice(", "toggle(", "\"#e4572e\",", "sun(", "camera("]
                .iter()
                .any(|word| old.contains(word));
            if is_value {
                let comment = old.find("  #").map_or("", |at| &old[at..]);
                prop_assert!(new.ends_with(comment), "{}", new);
                let begin = old.find(['(', '"']).map_or("", |at| &old[..at]);
                prop_assert!(new.starts_with(begin), "{}", new);
            } else {
                prop_assert_eq!(old, new);
            }
        }
    }

    /// One slider alone: what differs is its number.
    #[test]
    fn one_value_is_one_span(x in 0.0..=1.0_f64) {
        let (_folder, path) = written(SCENE, "star");
        let revised = revised(&path, &set(&[("bite", &x.to_string())]), &[]);
        let expected = SCENE.replace("\"bite\", 0.2,", &format!("\"bite\", {x},"));
        if x >= 1e-5 {
            prop_assert_eq!(&revised.revision.text, &expected);
        }
        let changed = middle(&revised.revision.text, SCENE);
        prop_assert!(changed.chars().all(|c| "0123456789.e-".contains(c)), "{}", changed);
    }
}
