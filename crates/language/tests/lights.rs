//! Lenses, shutters, lamps and skies of images: what is read, what is refused and why, and that JSON keeps it.

use zeroset_language::json::{expand, to_text};
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::environment::Surroundings;
use zeroset_scene::light::Source;
use zeroset_scene::scene::Scene;

fn with(text: &str, options: &Options) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    let dim = b"#?RADIANCE\n\n-Y 1 +X 2\n\x80\x80\x80\x85\x80\x80\x80\x80";
    std::fs::write(folder.path().join("sky.hdr"), dim).expect("a file");
    let loaded = load_text(
        "a.star",
        text,
        Language::Starlark,
        Some(folder.path()),
        options,
    );
    loaded.unwrap_or_else(|e| panic!("{}", e.report)).scene
}

fn scene(text: &str) -> Scene {
    with(text, &Options::default())
}

#[track_caller]
fn refused(text: &str, language: Language, words: &[&str]) {
    let failed = load_text("a.star", text, language, None, &Options::default());
    let said = failed.expect_err(text).report.to_string();
    for word in words {
        assert!(said.contains(word), "\"{word}\" is not in: {said}");
    }
}

#[test]
fn lenses_are_focused() {
    let focus = |text: &str| scene(&format!("show(sphere())\n{text}")).camera().focus;
    let of = |more: &str| {
        focus(&format!(
            "camera(eye = (0, 3, 4), target = (0, 0, 0), aperture = 0.1{more})"
        ))
    };
    assert!((of("") - 5.0).abs() < 1e-5);
    assert_eq!(of(", focus = 2.5"), 2.5);
    // how far along the way it looks, not how far away
    assert!((of(", focus = (1, 0, 0)") - 5.0).abs() < 1e-5);
    assert!((of(", focus = (0, 3, 0)") - 3.2).abs() < 1e-5);
    assert_eq!(focus("camera(eye = (0, 3, 4), focus = 2)"), 0.0);
}

#[test]
fn shutters_have_moments() {
    let text =
        "show(sphere().move(x = time()))\ncamera(eye = (0, 0, 9), shutter = 0.5, moments = 4)";
    let options = Options {
        time: 1.0,
        moments: true,
        ..Options::default()
    };
    let moving = with(text, &options);
    let at = |scene: &Scene| scene.finite_bounds().expect("bounds").centre()[0];
    assert!((at(&moving) - 1.0).abs() < 1e-6);
    let places: Vec<f64> = moving.moments().iter().map(|m| at(m)).collect();
    for (place, right) in places.iter().zip([1.0625, 1.1875, 1.3125, 1.4375]) {
        assert!((place - right).abs() < 1e-5, "{places:?}");
    }
    assert_eq!(places.len(), 4);
    assert!(scene(text).moments().is_empty());
    // what moves into nonsense says so
    let wrong = "show(sphere(1 - 2 * time()))\ncamera(shutter = 2)";
    let failed = load_text(
        "a.star",
        wrong,
        Language::Starlark,
        None,
        &Options {
            time: 0.0,
            ..options
        },
    );
    assert!(failed.is_err());
}

#[test]
fn what_no_lens_or_lamp_has_is_refused() {
    // the ends of ranges are as the language writes them
    assert_eq!(zeroset_scene::environment::TURBIDITY, (1.7, 10.0));
    assert_eq!(zeroset_scene::valid::LAMP, (1e-6, 1e6));
    for (text, words) in [
        (
            "camera(aperture = -1)",
            ["`aperture`", "-1", "allowed is 0"],
        ),
        (
            "camera(aperture = 1, focus = 0)",
            ["`focus`", "is 0", "allowed is"],
        ),
        (
            "camera(aperture = 1, eye = (0, 0, 4), target = (0, 0, 0), focus = (0, 0, 9))",
            ["focus", "before", "above 0"],
        ),
        (
            "camera(shutter = -0.1)",
            ["`shutter`", "-0.1", "allowed is 0"],
        ),
        ("camera(moments = 0)", ["`moments`", "is 0", "1 to 1024"]),
        (
            "camera(moments = 2.5)",
            ["`moments`", "whole number", "2.5"],
        ),
        (
            "sphere_light(position = (0, 1, 0), radius = 0)",
            ["`radius`", "is 0", "allowed is"],
        ),
        (
            "rectangle_light(position = (0, 1, 0), size = (1, -2))",
            ["`size`", "-2", "allowed is"],
        ),
        (
            "disc_light(position = (0, 1, 0), target = (0, 1, 0))",
            ["position", "target", "differ"],
        ),
        (
            "disc_light(position = (0, 1, 0), target = (0, 0, 0), direction = \"x\")",
            ["target", "direction", "both"],
        ),
        ("sky(turbidity = 1)", ["`turbidity`", "is 1", "1.7 to 10"]),
        (
            "sky(turbidity = 3, image = \"a.hdr\")",
            ["image", "turbidity", "both"],
        ),
        (
            "sky(turbidity = 3, top = \"red\")",
            ["own colours", "image", "sky"],
        ),
        ("sky(strength = 2)", ["`strength`", "image", "clear sky"]),
        ("sky(image = \"missing.hdr\")", ["missing.hdr", "", ""]),
    ] {
        refused(
            &format!("show(sphere())\n{text}"),
            Language::Starlark,
            &words,
        );
    }
    for (text, words) in [
        (
            r#""camera": {"aperture": -1}"#,
            ["camera.aperture", "-1", "allowed is"],
        ),
        (
            r#""camera": {"aperture": 1, "focus": 0}"#,
            ["camera.focus", "0", "allowed"],
        ),
        (
            r#""lights": [{"source": {"kind": "rectangle", "position": [0, 1, 0], "right": [1, 0, 0], "up": [1, 1, 0]}, "radiance": [1, 1, 1], "shadow": {"method": "hard"}}]"#,
            ["lights[0].source.up", "right angles", "up"],
        ),
        (
            r#""lights": [{"source": {"kind": "sphere", "position": [0, 1, 0], "radius": 0}, "radiance": [1, 1, 1], "shadow": {"method": "hard"}}]"#,
            ["lights[0].source.radius", "0", "allowed"],
        ),
        (
            r#""environment": {"source": {"kind": "clear", "turbidity": 20, "ground": "grey"}, "strength": 1}"#,
            ["environment.source.turbidity", "20", "1.7 to 10"],
        ),
    ] {
        let text = format!(
            "{{\"zeroset\": 1, \"objects\": [{{\"field\": {{\"sphere\": {{}}}}}}], {text}}}"
        );
        refused(&text, Language::Json, &words);
    }
}

#[test]
fn json_keeps_all_of_it() {
    for sky in [
        "sky(turbidity = 2.7, ground = \"#445566\", strength = 0.7)",
        "sky(image = \"sky.hdr\", turn = 25, strength = 3)",
        "",
    ] {
        let text = format!(
            "show(sphere())\n{sky}
camera(eye = (0, 3, 4), target = (0.1, 0, 0), aperture = 0.07, focus = 3.3)
rectangle_light(position = (0, 2, 1), target = (0.2, 0, 0), size = (1, 0.4), strength = 3)
disc_light(position = (0, 2, 1), radius = 0.2, visible = False)
sphere_light(position = (1, 2, 1), radius = 0.3, color = \"red\", shadow = none())"
        );
        let folder = tempfile::tempdir().expect("a folder");
        let dim = b"#?RADIANCE\n\n-Y 1 +X 2\n\x80\x80\x80\x85\x80\x80\x80\x80";
        std::fs::write(folder.path().join("sky.hdr"), dim).expect("a file");
        let load = |text: &str, language| {
            let loaded = load_text(
                "a",
                text,
                language,
                Some(folder.path()),
                &Options::default(),
            );
            loaded.unwrap_or_else(|e| panic!("{}", e.report)).scene
        };
        let scene = load(&text, Language::Starlark);
        let written = to_text(&expand(&scene).expect("JSON"));
        let again = load(&written, Language::Json);
        assert_eq!(scene.camera(), again.camera());
        assert_eq!(scene.lights(), again.lights());
        assert_eq!(scene.environment(), again.environment());
        assert_eq!(written, to_text(&expand(&again).expect("JSON")));
        let Source::Disc { visible, .. } = again.lights()[1].source else {
            panic!("{:?}", again.lights());
        };
        assert!(!visible);
        if sky.contains("image") {
            let Some(Surroundings::Image { image }) = again.environment().map(|e| &e.source) else {
                panic!("no image");
            };
            assert_eq!(image.pixels[0], glam::Vec3::splat(16.0));
        }
    }
}
