//! What makers change: the sun, materials, what is shown, and writing it into the file.

use crate::session::{outcome, session};
use eframe::egui::Ui;
use eframe::egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::Vec3;
use zeroset_language::load::Options;
use zeroset_language::revision::Change;
use zeroset_scene::light::Source;
use zeroset_viewer::panel;
use zeroset_viewer::pick::Picked;
use zeroset_viewer::preset::Preset;
use zeroset_viewer::session::Session;

const SCENE: &str = "clay = material(color = \"#c03020\", roughness = 0.5)
show(sphere(0.5), clay, name = \"ball\")
show(box(0.5).move(x = 1), clay, name = \"cube\")
show(plane().move(y = -0.5), \"white\", name = \"floor\")
sun(direction = (0, -1, 0), strength = 0.8)
camera(eye = (0, 1, 4), target = (0, 0, 0))
";

fn maker() -> Session {
    let mut session = Session::new("test.star".into(), Options::default());
    session.absorb(outcome(SCENE, &Options::default()));
    assert_eq!(session.trouble, None);
    session
}

fn on(session: Session, show: fn(&mut Ui, &mut Session)) -> Harness<'static, Session> {
    let mut harness = Harness::builder()
        .with_size([420.0, 700.0])
        .build_ui_state(show, session);
    harness.run();
    harness
}

fn picked(session: &Session, object: usize) -> Picked {
    let shown = &session.objects()[object];
    Picked {
        object,
        name: shown.name.clone(),
        material: String::new(),
        colour: Vec3::ONE,
        point: Vec3::ZERO,
        distance: 1.0,
        normal: Vec3::Y,
        place: shown.place.clone(),
    }
}

/// The way the sun's light travels in the scene that is shown.
fn way(session: &Session) -> Vec3 {
    let (_, sun) = session.sun().unwrap();
    let Source::Directional { direction } = sun.source else {
        panic!("no sun");
    };
    direction
}

#[test]
fn the_sun_is_moved_and_taken_back() {
    let mut harness = on(maker(), panel::sun);
    let before = way(harness.state());
    harness.get_by_label("The sun as in the file");
    harness.state_mut().turn_sun(Vec3::new(1.0, -1.0, 0.0));
    harness.run();
    assert!((way(harness.state()) - Vec3::new(0.5, -0.5, 0.0).normalize()).length() < 1e-6);
    assert!(harness.state().is_unwritten());
    assert!(matches!(
        harness.state().changes()[..],
        [Change::Sun { light: 0, .. }]
    ));
    harness.get_by_label("The sun as in the file").click();
    harness.run();
    assert_eq!(way(harness.state()), before);
    assert!(!harness.state().is_unwritten());
    // without one there is nothing to move
    let mut none = Session::new("test.star".into(), Options::default());
    none.absorb(outcome(
        "show(sphere(1))\nsphere_light(position = (0, 3, 0))\n",
        &Options::default(),
    ));
    on(none, panel::sun).get_by_label_contains("sun() in the file");
}

#[test]
fn the_material_of_what_was_picked_is_changed_for_all_that_have_it() {
    let mut session = maker();
    session.picked = Some(picked(&session, 1));
    let mut harness = on(session, panel::material);
    harness.get_by_label("cube");
    harness.get_by_label_contains("2 objects have this material");
    let number = usize::from(harness.state().objects()[1].material);
    let slider = harness.get_by_role_and_label(Role::Slider, "Roughness");
    slider.focus();
    harness.run();
    harness.key_press(eframe::egui::Key::ArrowRight);
    harness.run();
    let look = harness.state().look_of(number);
    assert!(look.roughness.is_some_and(|r| r > 0.5), "{look:?}");
    let shown = harness.state().current.as_ref().unwrap();
    assert_eq!(
        Some(shown.scene.materials()[number].roughness),
        look.roughness
    );
    assert_eq!(shown.loaded.scene.materials()[number].roughness, 0.5);
    harness.get_by_label("The material as in the file").click();
    harness.run();
    assert!(harness.state().stage.is_empty());
}

#[test]
fn objects_are_hidden_and_shown_alone() {
    let mut harness = on(maker(), panel::objects);
    let names = |h: &Harness<'_, Session>| -> Vec<String> {
        let scene = &h.state().current.as_ref().unwrap().scene;
        scene.objects().iter().map(|o| o.name.clone()).collect()
    };
    harness.get_by_label("Show cube").click();
    harness.run();
    assert_eq!(names(&harness), ["ball", "floor"]);
    // what is picked is found by what it is, not by its number in the smaller scene
    let floor = picked(harness.state(), 2);
    harness.state_mut().picked = Some(Picked { object: 1, ..floor });
    assert_eq!(harness.state().picked_object(), Some(2));
    harness.get_by_label("Solo cube").click();
    harness.run();
    assert_eq!(names(&harness), ["cube"]);
    harness.get_by_label("Show cube").click();
    harness.run();
    assert_eq!(names(&harness), ["cube"], "the last one stays");
    harness.get_by_label("Solo cube").click();
    harness.run();
    assert_eq!(names(&harness), ["ball", "cube", "floor"]);
    harness.get_by_label("Place of floor").click();
    harness.step();
    let commands = &harness.output().platform_output.commands;
    assert!(commands.iter().any(
        |c| matches!(c, eframe::egui::OutputCommand::CopyText(text) if text == "test.star:4:1")
    ));
}

#[test]
fn presets_set_methods_and_keep_the_exposure() {
    let mut session = maker();
    session.edited().settings.exposure = 1.5;
    let mut harness = on(session, panel::presets);
    let stated = harness.state().looks[0];
    for preset in Preset::ALL {
        harness.get_by_label(preset.name()).click();
        harness.run();
        let look = harness.state().looks[0];
        assert_eq!(look.settings.exposure, 1.5);
        assert_eq!(look == stated, preset == Preset::Good, "{preset:?}");
    }
}

/// What the window wrote comes back as an edit: nothing moves, and nothing is left to write.
#[test]
fn a_write_of_its_own_moves_nothing() {
    let mut session = maker();
    session.rig.orbit(0.4, 0.2);
    session.is_free = true;
    session.turn_sun(Vec3::new(0.3, -1.0, 0.2));
    let changes = session.changes();
    assert_eq!(changes.len(), 2);
    let loaded = &session.current.as_ref().unwrap().loaded;
    let language = zeroset_language::load::Language::Starlark;
    let revision =
        zeroset_language::revision::revise("test.star", SCENE, language, loaded, &changes).unwrap();
    let (rig, sun) = (session.rig, way(&session));
    session.absorb(outcome(&revision.text, &Options::default()));
    assert_eq!(session.rig.camera().eye, rig.camera().eye);
    assert_eq!(session.rig.pivot(), rig.pivot());
    assert!((way(&session) - sun).length() < 1e-6);
    assert!(!session.is_free && !session.is_unwritten());
    // an edit by another hand does move it
    session.absorb(outcome(SCENE, &Options::default()));
    assert_eq!(session.rig.camera().eye, Vec3::new(0.0, 1.0, 4.0));
}

#[test]
fn parameters_that_the_file_says_are_set_no_more() {
    let mut session = session();
    let bite = session.parameters()[0].clone();
    session.set(&bite, &zeroset_language::load::Setting::Number(0.75));
    let options = session.to_load().unwrap();
    assert!(session.is_unwritten());
    let text = crate::session::SCENE.replace("\"bite\", 0.4", "\"bite\", 0.75");
    session.absorb(outcome(&text, &options));
    assert!(session.options.set.is_empty() && !session.is_unwritten());
    assert_eq!(session.to_load(), None);
}
