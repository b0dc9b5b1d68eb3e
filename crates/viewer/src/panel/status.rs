//! What the picture took.

use crate::session::Session;
use eframe::egui::{Align, Layout, RichText, Ui};

/// Frame time, evaluations, resolution, rays a pixel, and what renders.
pub fn status(ui: &mut Ui, session: &Session) {
    let quiet = |text: String| RichText::new(text).small().weak();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 18.0;
        match &session.shown {
            None => {
                ui.label(quiet("no picture yet".to_owned()));
            }
            Some(shown) => {
                let [width, height] = shown.rung.size;
                let samples = shown.rung.samples();
                let rays = if samples == 1 {
                    "1 ray a pixel".to_owned()
                } else {
                    format!("{samples} rays a pixel")
                };
                let evaluations = shown.evaluations.total() as f64 / shown.rays.max(1) as f64;
                let about = |name: &str| format!("{name} of the picture that is shown");
                ui.label(quiet(spoken(shown.seconds)))
                    .on_hover_text(about("Rendering time"));
                ui.label(quiet(format!("{evaluations:.1} evaluations a ray")))
                    .on_hover_text("Evaluations of the field, of all stages, for each primary ray");
                ui.label(quiet(format!("{width} x {height}")))
                    .on_hover_text(about("Pixels"));
                ui.label(quiet(rays));
                let state = if shown.is_last {
                    "finished"
                } else {
                    "refining"
                };
                ui.label(quiet(state.to_owned()));
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let backend = session
                .backend
                .clone()
                .unwrap_or_else(|| "starting".to_owned());
            ui.label(quiet(backend))
                .on_hover_text("What renders the picture");
        });
    });
}

/// A time in three digits.
fn spoken(seconds: f64) -> String {
    match seconds {
        s if s >= 10.0 => format!("{s:.1} s"),
        s if s >= 1.0 => format!("{s:.2} s"),
        s if s >= 0.1 => format!("{:.0} ms", 1e3 * s),
        s => format!("{:.1} ms", 1e3 * s),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn times_are_short() {
        let spoken = [0.0042, 0.25, 1.5, 12.34].map(super::spoken);
        assert_eq!(spoken, ["4.2 ms", "250 ms", "1.50 s", "12.3 s"]);
    }
}
