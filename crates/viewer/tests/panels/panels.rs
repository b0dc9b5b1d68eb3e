//! One panel after the other.

use crate::session::{SCENE, outcome, rendered, session};
use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Theme, Ui};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use zeroset_language::load::{Options, Setting};
use zeroset_scene::film::Plane;
use zeroset_scene::settings::{Antialias, Filter, March, Normals, Occlusion, Shadow};
use zeroset_viewer::panel;
use zeroset_viewer::pick::pick;
use zeroset_viewer::session::Session;

fn harness<'a>(
    session: Session,
    show: impl FnMut(&mut Ui, &mut Session) + 'a,
) -> Harness<'a, Session> {
    Harness::builder()
        .with_size([340.0, 2400.0])
        .with_max_steps(12)
        .build_ui_state(show, session)
}

/// Opens a list and takes an entry.
fn take(harness: &mut Harness<'_, Session>, list: &str, entry: &str) {
    harness.get_by_role_and_label(Role::ComboBox, list).click();
    harness.run();
    harness.get_by_role_and_label(Role::Button, entry).click();
    harness.run();
}

#[test]
fn parameters_change_what_is_loaded() {
    let mut harness = harness(session(), panel::parameters);
    let bite = harness.get_by_role_and_label(Role::Slider, "bite");
    assert_eq!(bite.accesskit_node().numeric_value(), Some(0.4));
    bite.set_value_accesskit(0.75);
    harness.run();
    harness
        .get_by_role_and_label(Role::CheckBox, "floor")
        .click();
    harness.run();
    take(&mut harness, "style", "sharp");
    let options = harness.state_mut().to_load().unwrap();
    let set: Vec<_> = options
        .set
        .iter()
        .map(|(k, v)| (k.as_str(), v.as_str()))
        .collect();
    assert_eq!(
        set,
        [("bite", "0.75"), ("floor", "false"), ("style", "sharp")]
    );
    // what was set is a scene: one object, on the floor of those that say nothing but what is shown
    harness.state_mut().absorb(outcome(SCENE, &options));
    assert_eq!(
        harness
            .state()
            .current
            .as_ref()
            .unwrap()
            .scene
            .objects()
            .len(),
        2
    );
    harness.run();
    assert!(
        harness
            .query_by_role_and_label(Role::ColorWell, "tint")
            .is_some(),
        "the colour has a name"
    );
    harness.get_by_label("Reset all").click();
    harness.run();
    let all = harness.state().parameters().to_vec();
    for parameter in &all {
        assert_eq!(harness.state().setting(parameter), parameter.default);
    }
}

#[test]
fn a_scene_without_parameters_says_how_to_make_one() {
    let mut session = session();
    session.absorb(outcome("show(sphere())", &Options::default()));
    let harness = harness(session, panel::parameters);
    assert!(harness.query_by_label_contains("slider(").is_some());
}

#[test]
fn every_method_can_be_chosen() {
    let mut harness = harness(session(), panel::methods);
    for closed in [
        "Light and shadow",
        "Ambient occlusion",
        "Normals",
        "Antialiasing",
    ] {
        harness
            .get_by_role_and_label(Role::DisclosureTriangle, closed)
            .click();
        harness.run();
    }
    take(&mut harness, "March", "Over-relaxation");
    assert!(
        harness
            .query_by_label_contains("Keinert et al. 2014, 3.1")
            .is_some()
    );
    harness
        .get_by_role_and_label(Role::Slider, "Omega")
        .set_value_accesskit(1.5);
    harness.run();
    take(&mut harness, "Occlusion", "Obscurance");
    harness
        .get_by_role_and_label(Role::Slider, "Tau")
        .set_value_accesskit(4.0);
    harness.run();
    take(&mut harness, "Shadow", "Hard");
    take(&mut harness, "Normals", "26 samples");
    take(&mut harness, "Edges", "Supersampling");
    take(&mut harness, "Filter", "Tent");
    harness
        .get_by_role_and_label(Role::CheckBox, "Cone prepass")
        .click();
    harness
        .get_by_role_and_label(Role::Slider, "Most steps")
        .set_value_accesskit(99.0);
    harness.run();
    let look = harness.state().looks[0];
    assert_eq!(look.settings.march, March::Relaxed { omega: 1.5 });
    assert_eq!(
        look.settings.occlusion,
        Occlusion::Obscurance {
            rays: 64,
            reach: None,
            tau: 4.0
        }
    );
    assert_eq!(look.shadow, Some(Shadow::Hard));
    assert_eq!(look.settings.normals, Normals::Samples26);
    let filter = Filter::Tent;
    assert_eq!(
        look.settings.antialias,
        Antialias::Supersample { samples: 4, filter }
    );
    assert!(!look.settings.prepass && look.settings.max_steps == 99);
    take(&mut harness, "Shadow", "As each light has it");
    assert_eq!(harness.state().looks[0].shadow, None);
    harness.get_by_label("As in the file").click();
    harness.run();
    assert_eq!(harness.state().looks[0].settings, *harness.state().stated());
}

#[test]
fn views_are_chosen_by_name() {
    let mut harness = harness(session(), panel::view);
    take(&mut harness, "Show", "Steps");
    assert_eq!(harness.state().looks[0].plane, Plane::Steps);
    harness
        .get_by_role_and_label(Role::Slider, "Exposure")
        .set_value_accesskit(1.5);
    harness.run();
    assert_eq!(harness.state().looks[0].settings.exposure, 1.5);
}

#[test]
fn comparisons_change_one_side_at_a_time() {
    let mut harness = harness(session(), |ui, session| {
        panel::comparison(ui, session);
        panel::view(ui, session);
    });
    harness
        .get_by_role_and_label(Role::CheckBox, "Show A and B")
        .click();
    harness.run();
    take(&mut harness, "Show", "Normals");
    let planes = |h: &Harness<'_, Session>| h.state().looks.map(|l| l.plane);
    assert_eq!(planes(&harness), [Plane::Colour, Plane::Normal]);
    harness.get_by_label("A, left").click();
    harness.run();
    take(&mut harness, "Show", "Depth");
    assert_eq!(planes(&harness), [Plane::Depth, Plane::Normal]);
    harness.get_by_label("Swap").click();
    harness.run();
    assert_eq!(planes(&harness), [Plane::Normal, Plane::Depth]);
    harness.get_by_label("Copy B to A").click();
    harness.run();
    assert_eq!(planes(&harness), [Plane::Depth, Plane::Depth]);
    harness.get_by_label("Show A and B").click();
    harness.run();
    assert_eq!(harness.state().comparison.edited, 0);
}

#[test]
fn the_plane_can_be_moved_through_the_scene() {
    let mut harness = harness(session(), panel::slice);
    harness.get_by_label("Show the plane").click();
    harness.run();
    harness.get_by_label("y").click();
    harness.run();
    harness
        .get_by_role_and_label(Role::Slider, "Offset")
        .set_value_accesskit(0.25);
    harness.run();
    let session = harness.state();
    assert_eq!(
        (session.is_sliced, session.slice.axis, session.slice.at),
        (true, 1, 0.25)
    );
    assert!(session.request([9, 9]).unwrap().slice.is_some());
}

#[test]
fn the_camera_has_buttons_and_a_statement() {
    let mut harness = harness(session(), |ui, session| {
        panel::camera(ui, session, [320, 240])
    });
    let before = harness.state().rig;
    harness.get_by_label("Front").click();
    harness.run();
    harness.get_by_label("Frame all").click();
    harness.run();
    assert!(harness.state().rig != before && harness.state().is_free);
    assert!(harness.query_by_label_contains("camera(eye = (").is_some());
    harness.get_by_label("Copy as text").click();
    harness.step();
    let copied = harness
        .output()
        .platform_output
        .commands
        .iter()
        .find_map(|c| match c {
            eframe::egui::OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
    assert_eq!(copied, Some(harness.state().rig.statement()));
    harness.run();
    harness.get_by_label("As in the file").click();
    harness.run();
    assert_eq!(harness.state().rig, before);
}

#[test]
fn the_timeline_plays_loops_and_scrubs() {
    let mut harness = Harness::builder()
        .with_size([1000.0, 60.0])
        .build_ui_state(panel::timeline, session());
    harness.get_by_label("Play").click();
    harness.run();
    assert!(harness.state().clock.is_playing);
    harness.get_by_label("Pause").click();
    harness.run();
    harness
        .get_by_role_and_label(Role::Slider, "Time")
        .set_value_accesskit(1.5);
    harness.run();
    assert_eq!(harness.state_mut().to_load().unwrap().time, 1.5);
    harness.get_by_label("Next frame").click();
    harness.run();
    assert_eq!(harness.state().clock.frame(), 46);
    harness.get_by_label("Loop").click();
    harness.run();
    assert!(!harness.state().clock.is_looping);
    for (name, value) in [("Length", 9.0), ("Frames a second", 24.0)] {
        harness
            .get_by_role_and_label(Role::SpinButton, name)
            .set_value_accesskit(value);
        harness.run();
    }
    let clock = harness.state().clock;
    assert_eq!((clock.length, clock.fps), (9.0, 24.0));
}

#[test]
fn the_status_says_what_the_picture_took() {
    let harness = Harness::builder().with_size([1000.0, 40.0]).build_ui_state(
        |ui, session: &mut Session| panel::status(ui, session),
        rendered(|_| {}),
    );
    for said in [
        "evaluations a ray",
        "160 x 120",
        "1 ray a pixel",
        "CPU, 2 threads",
        "finished",
    ] {
        assert!(harness.query_by_label_contains(said).is_some(), "{said}");
    }
    let empty = Harness::builder().build_ui_state(
        |ui, session: &mut Session| panel::status(ui, session),
        session(),
    );
    assert!(empty.query_by_label_contains("no picture yet").is_some());
}

#[test]
fn a_click_says_what_is_there() {
    let mut session = rendered(|_| {});
    let shown = session.shown.as_ref().unwrap();
    let film = &shown.sides[0].film;
    session.picked = pick(
        film,
        &shown.request.camera,
        &shown.request.scene,
        [0.42, 0.5],
    );
    let mut harness = harness(session, |ui, session| {
        panel::picked(ui, session);
    });
    for said in ["fruit", "test.star:6:1", "Point", "Distance"] {
        assert!(harness.query_by_label_contains(said).is_some(), "{said}");
    }
    harness.get_by_label("Close the card").click();
    harness.run();
    assert!(harness.state().picked.is_none());
}

#[test]
fn mistakes_are_shown_as_the_terminal_shows_them() {
    let report = "  × sphere() has no parameter `radios`\n   ╭─[test.star:1:13]\n 1 │ show(sphere(radios = 1))\n   ·             ──┬───\n   ╰────\n  help: did you mean `radius`?";
    let mut session = session();
    session.trouble = Some(report.to_owned());
    let harness = Harness::builder()
        .with_size([800.0, 400.0])
        .with_max_steps(12)
        .build_ui_state(
            |ui, session: &mut Session| panel::error(ui, session),
            session,
        );
    assert!(harness.query_by_label(report).is_some());
    assert!(
        harness
            .query_by_label_contains("last good version")
            .is_some()
    );
}

#[test]
fn views_of_numbers_have_a_legend() {
    let session = rendered(|s| s.looks[0].plane = Plane::Steps);
    let key = session.key().unwrap().clone();
    assert!(key.title == "steps" && key.ticks.len() >= 2);
    let harness = harness(session, move |ui, _| panel::legend(ui, &key));
    assert!(harness.query_by_label("Legend: steps").is_some());
    assert!(rendered(|_| {}).key().is_none());
    let sliced = rendered(|s| s.is_sliced = true);
    assert_eq!(sliced.key().unwrap().title, "distance");
}

#[test]
fn what_the_scene_prints_is_shown() {
    let mut session = session();
    session.absorb(outcome(
        "print(\"volume\", 42)\nshow(sphere())",
        &Options::default(),
    ));
    let harness = harness(session, |ui, session| {
        panel::log(ui, &session.current.as_ref().unwrap().loaded.log);
    });
    assert!(harness.query_by_label("volume 42").is_some());
}

#[test]
fn the_help_lists_every_key() {
    let mut harness = Harness::builder()
        .with_size([900.0, 900.0])
        .with_max_steps(12)
        .build_ui_state(|ui, open: &mut bool| panel::help(ui.ctx(), open), true);
    harness.run();
    for (key, _) in panel::KEYS {
        assert!(harness.query_by_label(key).is_some(), "{key}");
    }
}

/// A setting that was changed reads the same in both themes: nothing in a panel depends on one.
#[test]
fn both_themes_show_all_controls() {
    for theme in [Theme::Dark, Theme::Light] {
        let mut harness = Harness::builder()
            .with_size([340.0, 1600.0])
            .with_theme(theme)
            .with_max_steps(12)
            .build_ui_state(panel::parameters, session());
        harness.run();
        let floor = harness.get_by_role_and_label(Role::CheckBox, "floor");
        assert_eq!(floor.accesskit_node().toggled(), Some(Toggled::True));
        let first = harness.state().parameters()[0].clone();
        assert_eq!(harness.state().setting(&first), Setting::Number(0.4));
    }
}
