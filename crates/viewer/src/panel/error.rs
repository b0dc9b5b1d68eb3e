//! What is wrong with the file, as the terminal shows it.

use super::picked::card;
use crate::session::Session;
use crate::style::Palette;
use eframe::egui::{RichText, ScrollArea, Stroke, Ui};
use zeroset_output::display::text;

/// The report, over the last good picture.
pub fn error(ui: &mut Ui, session: &Session) {
    let Some(report) = &session.trouble else {
        return;
    };
    let palette = Palette::of(ui.visuals());
    card(&palette)
        .stroke(Stroke::new(1.0, palette.wrong))
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(
                    RichText::new("The scene has a mistake")
                        .strong()
                        .color(palette.wrong),
                );
                let kept = if session.current.is_some() {
                    "the picture is that of the last good version"
                } else {
                    "it is loaded again when it is saved"
                };
                ui.label(RichText::new(kept).small().weak());
            });
            ui.add_space(4.0);
            ScrollArea::both()
                .max_height(260.0)
                .id_salt("report")
                .show(ui, |ui| {
                    let label = RichText::new(text(report.trim_end())).monospace();
                    ui.add(eframe::egui::Label::new(label).extend());
                    ui.add_space(6.0);
                });
        });
}
