//! Where the camera stands.

use crate::rig::Side;
use crate::session::Session;
use crate::widget::aside;
use eframe::egui::{DragValue, RichText, Ui};

/// Buttons for what the keys do too, and the camera as text.
pub fn camera(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    ui.horizontal_wrapped(|ui| {
        let button =
            |ui: &mut Ui, name: &str, about: &str| ui.button(name).on_hover_text(about).clicked();
        if button(ui, "Frame all", "Shows everything that has an end (F).") {
            session.frame_all(size);
        }
        for (name, about, side) in [
            ("Front", "From +z (1).", Side::Front),
            ("Right", "From +x (3).", Side::Right),
            ("Top", "From above (7).", Side::Top),
        ] {
            if button(ui, name, about) {
                session.rig.look_from(side);
                session.is_free = true;
            }
        }
    });
    lens(ui, session);
    let statement = session.rig.statement();
    ui.add_space(2.0);
    ui.label(RichText::new(&statement).monospace().small());
    ui.horizontal_wrapped(|ui| {
        let about = "Puts this statement on the clipboard (Ctrl+Shift+C): paste it into the scene.";
        if ui.button("Copy as text").on_hover_text(about).clicked() {
            ui.ctx().copy_text(statement);
        }
        let back = ui.add_enabled(session.is_free, eframe::egui::Button::new("As in the file"));
        if back
            .on_hover_text("Puts the camera where the file has it.")
            .clicked()
        {
            session.reset_camera();
        }
    });
    if session.is_free {
        aside(
            ui,
            "The camera stays where it is when a slider or the time moves the file's.",
        );
    }
}

/// The lens: how wide it is, and what is sharp.
fn lens(ui: &mut Ui, session: &mut Session) {
    let [before, sharp] = session.rig.lens();
    let (mut aperture, mut focus) = (before, sharp);
    let step = session.rig.distance() * 1e-3;
    ui.horizontal_wrapped(|ui| {
        ui.label("Aperture");
        let number = DragValue::new(&mut aperture).range(0.0..=1e9).speed(step);
        ui.add(number).on_hover_text(
            "Radius of the lens, scene units: what is out of focus is blurred, with several rays a pixel.",
        );
        ui.label("Focus");
        let number = DragValue::new(&mut focus).range(1e-5..=1e9).speed(step);
        ui.add_enabled(before > 0.0, number)
            .on_hover_text("How far before the camera what is sharp lies.");
    });
    if aperture != before {
        session.rig.set_aperture(aperture);
        session.is_free = true;
    }
    if focus != sharp && before > 0.0 {
        session.rig.focus_at(focus);
        session.is_free = true;
    }
}
