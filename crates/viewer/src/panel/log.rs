//! What the script printed.

use eframe::egui::{RichText, ScrollArea, Ui};

/// The lines, as they are.
pub fn log(ui: &mut Ui, lines: &[String]) {
    ScrollArea::vertical()
        .id_salt("log")
        .max_height(160.0)
        .show(ui, |ui| {
            for line in lines {
                ui.label(RichText::new(line).monospace().small());
            }
        });
}
