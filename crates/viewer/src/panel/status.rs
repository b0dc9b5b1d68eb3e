//! What the picture took.

use crate::engine::Exposed;
use crate::session::Session;
use eframe::egui::{Align, Layout, Response, RichText, Ui};
use zeroset_output::display::{NAME, name};

/// Frame time, evaluations, resolution, rays a pixel, and what renders; of two looks, for each.
pub fn status(ui: &mut Ui, session: &Session) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 18.0;
        match &session.shown {
            None => {
                quiet(ui, "no picture yet".to_owned());
            }
            Some(shown) => {
                let is_one = shown.sides.len() == 1;
                for (side, name) in shown.sides.iter().zip(["A", "B"]) {
                    if !is_one {
                        ui.label(RichText::new(name).small().strong());
                    }
                    figures(ui, side, is_one);
                }
                let state = if shown.is_last {
                    "finished"
                } else {
                    "refining"
                };
                quiet(ui, state.to_owned());
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let backend = session.backend.as_deref().unwrap_or("starting");
            quiet(ui, name(backend, NAME)).on_hover_text("What renders the picture");
        });
    });
}

/// What one picture took.
fn figures(ui: &mut Ui, side: &Exposed, is_long: bool) {
    let [width, height] = side.rung.size;
    let evaluations = side.evaluations.total() as f64 / side.rays.max(1) as f64;
    quiet(ui, spoken(side.seconds)).on_hover_text("Rendering time of the picture that is shown");
    quiet(ui, format!("{evaluations:.1} evaluations a ray"))
        .on_hover_text("Evaluations of the field, of all stages, for each primary ray");
    if is_long {
        quiet(ui, format!("{width} x {height}"))
            .on_hover_text("Pixels of the picture that is shown");
    }
    quiet(
        ui,
        match side.rung.samples() {
            1 => "1 ray a pixel".to_owned(),
            samples => format!("{samples} rays a pixel"),
        },
    );
}

fn quiet(ui: &mut Ui, text: String) -> Response {
    ui.label(RichText::new(text).small().weak())
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
