//! The whole window: keys, mouse, focus.

use crate::session::{outcome, rendered};
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, PointerButton, Pos2, Ui, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::collections::HashSet;
use zeroset_language::load::Options;
use zeroset_output::display::is_control;
use zeroset_scene::film::Plane;
use zeroset_viewer::app::App;
use zeroset_viewer::pick::pick;
use zeroset_viewer::session::Session;

/// The window, made once there is a context.
enum Window {
    Closed(Option<Box<Session>>),
    Open(Box<App>),
}

impl Window {
    fn show(ui: &mut Ui, window: &mut Window) {
        if let Window::Closed(session) = window
            && let Some(session) = session.take()
        {
            *window = Window::Open(Box::new(App::new(ui.ctx(), *session)));
        }
        if let Window::Open(app) = window {
            app.show(ui);
        }
    }

    fn session(&self) -> &Session {
        match self {
            Window::Open(app) => &app.session,
            Window::Closed(_) => panic!("no window"),
        }
    }
}

fn window(scale: f32) -> Harness<'static, Window> {
    let closed = Window::Closed(Some(Box::new(rendered(|_| {}))));
    let mut harness = Harness::builder()
        .with_size([1100.0, 700.0])
        .with_pixels_per_point(scale)
        .with_max_steps(24)
        .build_ui_state(Window::show, closed);
    harness.run();
    harness
}

fn drag(
    harness: &mut Harness<'_, Window>,
    button: PointerButton,
    modifiers: Modifiers,
    by: (f32, f32),
) {
    let from = pos2(400.0, 350.0);
    let pointer = |harness: &mut Harness<'_, Window>, pos: Pos2, pressed| {
        harness.event(eframe::egui::Event::PointerMoved(pos));
        if let Some(pressed) = pressed {
            harness.event(eframe::egui::Event::PointerButton {
                pos,
                button,
                pressed,
                modifiers,
            });
        }
        harness.step();
    };
    harness.event(eframe::egui::Event::ModifiersChanged(modifiers));
    pointer(harness, from, Some(true));
    pointer(
        harness,
        from + eframe::egui::vec2(0.5 * by.0, 0.5 * by.1),
        None,
    );
    let to = from + eframe::egui::vec2(by.0, by.1);
    pointer(harness, to, None);
    pointer(harness, to, Some(false));
    harness.event(eframe::egui::Event::ModifiersChanged(Modifiers::NONE));
    harness.run();
}

#[test]
fn the_mouse_orbits_pans_and_zooms() {
    let mut harness = window(1.0);
    let at = |h: &Harness<'_, Window>| h.state().session().rig;
    let start = at(&harness);
    drag(
        &mut harness,
        PointerButton::Primary,
        Modifiers::NONE,
        (120.0, 40.0),
    );
    let orbited = at(&harness);
    assert!((orbited.pivot() - start.pivot()).length() < 1e-6 && orbited != start);
    for (button, modifiers) in [
        (PointerButton::Secondary, Modifiers::NONE),
        (PointerButton::Middle, Modifiers::NONE),
        (PointerButton::Primary, Modifiers::SHIFT),
    ] {
        let before = at(&harness);
        drag(&mut harness, button, modifiers, (60.0, 0.0));
        let panned = at(&harness);
        assert!(
            (panned.pivot() - before.pivot()).length() > 1e-3,
            "{button:?} {modifiers:?}"
        );
        assert_eq!(panned.camera().axes, before.camera().axes);
    }
    let before = at(&harness);
    drag(
        &mut harness,
        PointerButton::Primary,
        Modifiers::ALT,
        (60.0, 0.0),
    );
    assert_eq!(at(&harness).camera().eye, before.camera().eye);
    assert!(at(&harness).camera().axes != before.camera().axes);
    let before = at(&harness).distance();
    harness.hover_at(pos2(400.0, 350.0));
    harness.event(eframe::egui::Event::MouseWheel {
        source: eframe::egui::MouseWheelSource::Wheel,
        unit: eframe::egui::MouseWheelUnit::Line,
        delta: eframe::egui::vec2(0.0, 3.0),
        phase: eframe::egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run_steps(12);
    assert!(at(&harness).distance() < 0.95 * before);
}

/// A slow machine sees a press, the way and the release in a few frames, or in two.
#[test]
fn no_part_of_a_drag_is_lost() {
    let mut ends = Vec::new();
    for steps in [1, 2, 5] {
        let mut harness = window(1.0);
        let (from, way) = (pos2(300.0, 300.0), eframe::egui::vec2(200.0, -30.0));
        let button = |pos, pressed| eframe::egui::Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        harness.event(eframe::egui::Event::PointerMoved(from));
        harness.step();
        harness.event(button(from, true));
        for step in 1..=steps {
            let at = from + way * (step as f32 / steps as f32);
            harness.event(eframe::egui::Event::PointerMoved(at));
            harness.step();
        }
        harness.event(button(from + way, false));
        harness.run();
        ends.push(harness.state().session().rig.camera().eye);
    }
    assert!(
        ends.iter().all(|e| (*e - ends[0]).length() < 1e-4),
        "{ends:?}"
    );
}

#[test]
fn keys_do_what_the_list_says() {
    let mut harness = window(1.0);
    let press = |h: &mut Harness<'_, Window>, key| {
        h.key_press(key);
        h.run();
    };
    press(&mut harness, Key::Num1);
    let back = harness.state().session().rig.camera().axes.z_axis;
    assert!((back - glam::Vec3::Z).length() < 1e-6);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Num3);
    harness.run();
    let back = harness.state().session().rig.camera().axes.z_axis;
    assert!((back + glam::Vec3::X).length() < 1e-6);
    press(&mut harness, Key::Home);
    assert!(!harness.state().session().is_free);
    press(&mut harness, Key::V);
    assert_eq!(harness.state().session().looks[0].plane, Plane::Coverage);
    press(&mut harness, Key::X);
    assert!(harness.state().session().is_sliced);
    press(&mut harness, Key::C);
    assert!(harness.state().session().comparison.is_on);
    harness.key_press(Key::Space);
    harness.run_steps(7);
    assert!(harness.state().session().clock.is_playing);
    harness.key_press(Key::Space);
    harness.run();
    assert!(!harness.state().session().clock.is_playing);
    press(&mut harness, Key::F1);
    assert!(harness.query_by_label("Keys and mouse").is_some());
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::P);
    assert!(harness.query_by_label("Methods").is_none());
    let before = harness.state().session().rig;
    harness.key_down(Key::W);
    harness.step();
    harness.step();
    harness.key_up(Key::W);
    harness.run();
    let flown = harness.state().session().rig.camera().eye - before.camera().eye;
    assert!(flown.dot(before.camera().axes.z_axis) < 0.0);
}

#[test]
fn the_divider_is_dragged_and_moved_by_keys() {
    let mut harness = window(1.0);
    harness.key_press(Key::C);
    harness.run();
    let name = "Divider between A and B";
    let before = harness.state().session().rig;
    let middle = harness
        .get_by_role_and_label(Role::Slider, name)
        .rect()
        .center();
    harness.drag_at(middle);
    harness.step();
    harness.hover_at(middle + eframe::egui::vec2(-150.0, 0.0));
    harness.step();
    harness.drop_at(middle + eframe::egui::vec2(-150.0, 0.0));
    harness.run();
    let dragged = harness.state().session().comparison.divider;
    assert!((0.2..0.4).contains(&dragged), "{dragged}");
    assert_eq!(
        harness.state().session().rig,
        before,
        "the camera moved with the divider"
    );
    harness.get_by_role_and_label(Role::Slider, name).focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    assert!((harness.state().session().comparison.divider - dragged - 0.02).abs() < 1e-4);
}

#[test]
fn a_click_picks() {
    let mut harness = window(1.0);
    let picture = harness.get_by_role(Role::Image).rect();
    let at = picture.lerp_inside(eframe::egui::vec2(0.42, 0.5));
    for pressed in [true, false] {
        harness.event(eframe::egui::Event::PointerMoved(at));
        harness.event(eframe::egui::Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        harness.step();
    }
    harness.run();
    assert_eq!(
        harness.state().session().picked.as_ref().unwrap().name,
        "fruit"
    );
    assert!(harness.query_by_label("test.star:6:1").is_some());
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.state().session().picked.is_none());
}

/// Every control is reached with Tab, the bar at the top before the panel.
#[test]
fn tab_goes_through_every_control() {
    let mut harness = window(1.0);
    let mut seen = Vec::new();
    for _ in 0..80 {
        harness.key_press(Key::Tab);
        harness.run();
        let focused = harness.root().children_recursive().find(|n| n.is_focused());
        let Some(focused) = focused else {
            continue;
        };
        let node = focused.accesskit_node();
        let name = (node.role(), node.label().unwrap_or_default());
        if seen.first() == Some(&name) {
            break;
        }
        seen.push(name);
    }
    let place = |name: &str| seen.iter().position(|(_, n)| n == name);
    let order = [
        "Compare",
        "Slice",
        "Save…",
        "Change the theme",
        "Help",
        "Panel",
        "bite",
        "Front",
        "Azimuth",
        "Exposure",
    ];
    assert!(order.is_sorted_by_key(|name| place(name)), "{seen:?}");
    let names: HashSet<&str> = seen.iter().map(|(_, name)| name.as_str()).collect();
    for name in [
        "Compare",
        "Slice",
        "Save…",
        "Help",
        "bite",
        "style",
        "Elevation",
        "Exposure",
        "Good",
        "Play",
    ] {
        assert!(names.contains(name), "{name} is not among {seen:?}");
    }
}

/// In a small window the panel gives way: the picture keeps more than half of it, and nothing covers the panel.
#[test]
fn the_panel_gives_way() {
    for (width, height) in [(520.0, 420.0), (480.0, 320.0), (700.0, 500.0)] {
        let closed = Window::Closed(Some(Box::new(rendered(|_| {}))));
        let mut harness = Harness::builder()
            .with_size([width, height])
            .with_max_steps(24)
            .build_ui_state(Window::show, closed);
        harness.run();
        let picture = harness.get_by_role(Role::Image).rect();
        let share = picture.width() / width;
        assert!((0.55..0.7).contains(&share), "{picture:?} of {width}");
        let slider = harness.get_by_role_and_label(Role::Slider, "bite").rect();
        assert!(
            picture.right() < slider.left() && slider.right() < width,
            "{slider:?}"
        );
        if width < 600.0 {
            assert!(harness.query_by_label("Save…").is_none());
            harness.get_by_label("Menu").click();
            harness.run_steps(6);
            assert!(harness.query_by_label("Save…").is_some());
        }
    }
}

/// The axes in the corner look along themselves.
#[test]
fn the_axes_can_be_pressed() {
    let mut harness = window(1.0);
    for (name, way) in [("+x", glam::Vec3::X), ("-z", glam::Vec3::NEG_Z)] {
        harness.get_by_label(&format!("Look from {name}")).click();
        harness.run();
        let back = harness.state().session().rig.camera().axes.z_axis;
        assert!((back - way).length() < 1e-5, "{name}: {back}");
    }
}

/// With the sun in hand, a drag moves it and leaves the camera alone.
#[test]
fn the_sun_is_dragged_over_the_picture() {
    let mut harness = window(1.0);
    harness.key_press(Key::L);
    harness.run();
    let before = harness.state().session().rig;
    let place = |h: &Harness<'_, Window>| h.state().session().sun().unwrap().1.source;
    let sun = place(&harness);
    drag(
        &mut harness,
        PointerButton::Primary,
        Modifiers::NONE,
        (80.0, -30.0),
    );
    assert_eq!(harness.state().session().rig, before);
    assert!(place(&harness) != sun);
    assert!(harness.state().session().is_unwritten());
}

#[test]
fn pictures_are_as_fine_as_the_screen() {
    for scale in [1.0, 1.5, 2.0] {
        let harness = window(scale);
        let picture = harness.get_by_role(Role::Image).rect();
        let pixels = picture.size() * scale;
        assert!(
            (pixels.x - pixels.x.round()).abs() < 0.01,
            "{pixels:?} at {scale}"
        );
        assert!(pixels.x > 700.0 * scale);
    }
}

#[test]
fn a_picture_is_saved_under_a_name() {
    let folder = std::env::temp_dir().join(format!("zeroset-window-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (file, said) in [
        ("a.png", "Saved"),
        ("a.exr", "Saved"),
        ("a.jpg", "Not saved"),
    ] {
        let mut harness = window(1.0);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
        harness.run();
        let path = folder.join(file);
        let edit = harness.get_by_role_and_label(Role::TextInput, "File name");
        edit.set_text_value_accesskit(&path.display().to_string());
        harness.run();
        harness.get_by_role_and_label(Role::Button, "Save").click();
        harness.step();
        harness.step();
        assert!(harness.query_by_label_contains(said).is_some(), "{file}");
        assert_eq!(path.exists(), said == "Saved", "{file}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Everything that a window says, as a screen reader reads it.
fn said(session: Session) -> Vec<String> {
    let closed = Window::Closed(Some(Box::new(session)));
    let mut harness = Harness::builder()
        .with_size([1200.0, 2000.0])
        .with_max_steps(24)
        .build_ui_state(Window::show, closed);
    harness.run_steps(3);
    let root = harness.root();
    let nodes = root.children_recursive();
    let texts = nodes.flat_map(|n| {
        let node = n.accesskit_node();
        [node.label(), node.value(), node.description()]
    });
    texts.flatten().collect()
}

#[test]
fn texts_of_a_stranger_are_shown_clean_and_cut() {
    // as long as a name may be
    let long = "y".repeat(190);
    for text in [
        "\u{1b}]0;owned\u{7}",
        "\u{9b}31m",
        "\u{202e}gnp.\u{2066}",
        "a\u{8}\u{7f}",
        &long,
    ] {
        let script = format!(
            "r = slider(\"{text}\", 0.5)\nc = choice(\"c{text}\", [\"{text}\", \"b\"])\n\
             t = toggle(\"t{text}\", True)\nk = color(\"k{text}\", \"red\")\nprint(\"{text}\" * 1000)\n\
             show(sphere(r), name = \"{text}\")\nrender(size = (320, 240), aa = none())\n"
        );
        let session = rendered(|session| {
            session.absorb(outcome(&script, &Options::default()));
            assert_eq!(session.trouble, None);
        });
        let mut picked = rendered(|session| session.absorb(outcome(&script, &Options::default())));
        let scene = &picked.current.as_ref().unwrap().scene;
        let film = &picked.shown.as_ref().unwrap().sides[0].film;
        picked.picked = pick(film, scene.camera(), scene, [0.5, 0.5]);
        assert!(picked.picked.is_some());
        let mut broken = rendered(|_| {});
        broken.trouble = Some(format!("{text} is wrong"));
        let odd = Session::new(format!("{text}.star").into(), Options::default());
        for session in [session, picked, broken, odd] {
            let all = said(session);
            assert!(all.len() > 20);
            for said in all {
                assert!(!said.contains(is_control), "{said:?}");
                assert!(
                    said.chars().count() < 2000,
                    "{} characters",
                    said.chars().count()
                );
            }
        }
    }
}

/// A scene calls itself what it wants; its picture is called after its file.
#[test]
fn a_picture_is_named_after_the_file() {
    let mut session = rendered(|_| {});
    let current = session.current.as_mut().unwrap();
    let mut scene = (*current.scene).clone();
    scene
        .edit(|s| s.name = "/etc/../../victim".to_owned())
        .expect("a scene");
    current.scene = std::sync::Arc::new(scene);
    let closed = Window::Closed(Some(Box::new(session)));
    let mut harness = Harness::builder()
        .with_size([1100.0, 700.0])
        .with_max_steps(24)
        .build_ui_state(Window::show, closed);
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::S);
    harness.run_steps(2);
    let edit = harness.get_by_role_and_label(Role::TextInput, "File name");
    assert_eq!(edit.accesskit_node().value().as_deref(), Some("test.png"));
}
