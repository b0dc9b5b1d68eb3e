use super::*;
use zeroset_language::load::{Language, load_text};
use zeroset_scene::settings::{March, Normals, Shadow};

fn outcome(text: &str, options: &Options, is_edit: bool) -> Outcome {
    let result = load_text("test.star", text, Language::Starlark, None, options);
    Outcome {
        options: options.clone(),
        is_edit,
        result: result.map(Arc::new).map_err(|f| f.to_string()),
    }
}

fn session(text: &str) -> Session {
    let options = Options::default();
    let mut session = Session::new("test.star".into(), options.clone());
    session.absorb(outcome(text, &options, false));
    assert_eq!(session.trouble, None);
    session
}

const SCENE: &str = "r = slider(\"r\", 0.5)\nshow(sphere(r))\ncamera(eye = (0, 0, 5), target = (0, 0, 0))\n\
                     render(march = sphere_tracing(), size = (400, 300))\n";

#[test]
fn the_last_good_scene_outlives_a_mistake() {
    let mut session = session(SCENE);
    let before = Arc::clone(&session.current.as_ref().unwrap().scene);
    session.absorb(outcome("show(spere())", &Options::default(), true));
    assert!(session.trouble.as_ref().unwrap().contains("spere"));
    assert!(Arc::ptr_eq(
        &before,
        &session.current.as_ref().unwrap().scene
    ));
    assert!(session.request([10, 10]).is_some());
    session.absorb(outcome(SCENE, &Options::default(), true));
    assert_eq!(session.trouble, None);
}

#[test]
fn what_was_changed_in_the_window_outlives_an_edit() {
    let mut session = session(SCENE);
    session.edited().settings.normals = Normals::Central;
    session.edited().shadow = Some(Shadow::Hard);
    let edited = SCENE.replace("sphere_tracing()", "relaxed(omega = 1.5)") + "sky(ambient = 0.1)\n";
    session.absorb(outcome(&edited, &Options::default(), true));
    let look = session.looks[0];
    assert_eq!(look.settings.normals, Normals::Central);
    assert_eq!(look.settings.march, March::Relaxed { omega: 1.5 });
    assert_eq!(look.shadow, Some(Shadow::Hard));
    // what was changed by hand stays though the file changes it
    session.edited().settings.march = March::Auto { beta: 0.5 };
    session.absorb(outcome(SCENE, &Options::default(), true));
    assert_eq!(session.looks[0].settings.march, March::Auto { beta: 0.5 });
}

#[test]
fn a_camera_that_was_moved_stays_until_the_file_moves_it() {
    let mut session = session(SCENE);
    session.rig.orbit(0.5, 0.1);
    session.is_free = true;
    let mut moved = session.rig;
    session.absorb(outcome(
        &SCENE.replace("slider(\"r\", 0.5)", "0.7"),
        &Options::default(),
        true,
    ));
    // a larger ball is seen from farther away
    let far = session.current.as_ref().unwrap().scene.camera();
    assert!(far.far > moved.camera().far);
    moved.see_as_far_as(far);
    assert_eq!(session.rig, moved);
    let other = SCENE.replace("eye = (0, 0, 5)", "eye = (0, 0, time())");
    let at = |time| Options {
        time,
        ..Options::default()
    };
    session.absorb(outcome(&other, &at(7.0), true));
    assert_eq!((session.rig.camera().eye.z, session.is_free), (7.0, false));
    // it follows the time as long as nobody moves it
    session.absorb(outcome(&other, &at(8.0), false));
    assert_eq!(session.rig.camera().eye.z, 8.0);
    session.is_free = true;
    session.absorb(outcome(&other, &at(9.0), false));
    assert_eq!(session.rig.camera().eye.z, 8.0);
    session.reset_camera();
    assert_eq!(session.rig.camera().eye.z, 9.0);
}

#[test]
fn parameters_are_asked_for_once_and_go_back_to_their_defaults() {
    let mut session = session(
        "a = slider(\"a\", 0.5)\nb = choice(\"b\", [\"x\", \"y\"])\nc = toggle(\"c\")\nd = color(\"d\", \"#ff8000\")\n\
         show(sphere(a), d)\n",
    );
    assert_eq!(session.to_load(), None);
    let all = session.parameters().to_vec();
    let settings = [
        Setting::Number(0.25),
        Setting::Text("y".into()),
        Setting::Flag(true),
        Setting::Colour([0.0, 1.0, 0.2]),
    ];
    for (parameter, setting) in all.iter().zip(&settings) {
        session.set(parameter, setting);
        match (session.setting(parameter), setting) {
            (Setting::Colour(a), Setting::Colour(b)) => assert_eq!(levels(&a), levels(b)),
            (a, b) => assert_eq!(a, *b),
        }
    }
    let options = session.to_load().unwrap();
    assert_eq!(session.to_load(), None);
    let text: Vec<_> = options.set.values().map(String::as_str).collect();
    assert_eq!(text, ["0.25", "y", "true", "#00ff33"]);
    for parameter in &all {
        session.set(parameter, &parameter.default);
    }
    assert!(session.options.set.is_empty() && session.to_load().is_some());
}

#[test]
fn parameters_that_an_edit_removed_are_forgotten() {
    let mut session = session(SCENE);
    let r = session.parameters()[0].clone();
    session.set(&r, &Setting::Number(0.75));
    let asked = session.to_load().unwrap();
    session.absorb(outcome(SCENE, &asked, false));
    session.absorb(outcome("show(box(1))\n", &Options::default(), true));
    assert!(session.options.set.is_empty());
    assert_eq!(session.to_load(), None);
}

#[test]
fn a_picture_is_asked_for_when_it_is_another_one() {
    let mut session = session(SCENE);
    assert!(session.to_render([64, 48]).is_some());
    assert!(session.to_render([64, 48]).is_none());
    assert!(session.to_render([65, 48]).is_some());
    session.rig.orbit(0.1, 0.0);
    assert!(session.to_render([65, 48]).is_some());
    session.is_sliced = true;
    let request = session.to_render([65, 48]).unwrap();
    assert_eq!(
        (request.looks.len(), request.slice),
        (1, Some(session.slice))
    );
    session.comparison.is_on = true;
    assert_eq!(session.to_render([65, 48]).unwrap().looks.len(), 2);
    session.absorb(outcome(SCENE, &Options::default(), true));
    assert!(session.to_render([65, 48]).is_some());
}

#[test]
fn framing_shows_all_in_a_window_of_any_shape() {
    let mut session = session(SCENE);
    for size in [[1000, 300], [300, 1000], [512, 512]] {
        session.rig.orbit(0.3, 0.2);
        session.frame_all(size);
        let camera = session.camera(size);
        let bounds = session
            .current
            .as_ref()
            .unwrap()
            .scene
            .finite_bounds()
            .unwrap();
        for corner in bounds.corners() {
            let p = camera.axes.transpose() * (glam::DVec3::from(corner).as_vec3() - camera.eye);
            let half = 0.5 * camera.plane_height() * -p.z;
            assert!(p.y.abs() <= half, "{size:?}");
            assert!(
                p.x.abs() <= half * size[0] as f32 / size[1] as f32,
                "{size:?}"
            );
        }
    }
}
