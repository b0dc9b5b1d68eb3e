//! What the script printed.

use eframe::egui::{RichText, ScrollArea, Ui};
use zeroset_output::display::{LINES, text};

/// The lines, as far as anybody would read them.
pub fn log(ui: &mut Ui, lines: &[String]) {
    ScrollArea::vertical()
        .id_salt("log")
        .max_height(160.0)
        .show(ui, |ui| {
            for line in lines.iter().take(LINES) {
                ui.label(RichText::new(text(line)).monospace().small());
            }
            if lines.len() > LINES {
                let more = format!("…({} lines left out)", lines.len() - LINES);
                ui.label(RichText::new(more).monospace().small());
            }
        });
}
