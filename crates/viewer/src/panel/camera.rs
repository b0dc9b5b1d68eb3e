//! Where the camera stands.

use crate::rig::Side;
use crate::session::Session;
use crate::widget::aside;
use eframe::egui::{RichText, Ui};

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
    let statement = session.rig.statement();
    ui.add_space(2.0);
    ui.label(RichText::new(&statement).monospace().small());
    ui.horizontal(|ui| {
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
