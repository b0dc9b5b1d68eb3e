//! What the picture took.

use crate::converge::Convergence;
use crate::engine::Exposed;
use crate::ladder::Draft;
use crate::session::Session;
use eframe::egui::{Align, Layout, Response, RichText, Ui};
use std::time::Instant;
use zeroset_output::display::{NAME, name};

/// A narrower window has no room for all of it, points.
const WIDE: f32 = 720.0;

/// Frame time, evaluations, resolution, rays a pixel, and what renders; of two looks, for each.
pub fn status(ui: &mut Ui, session: &Session) {
    let is_wide = ui.available_width() >= WIDE;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 18.0;
        match &session.shown {
            None => {
                quiet(ui, "no picture yet".to_owned());
            }
            Some(shown) => {
                let is_one = shown.sides.len() == 1 && is_wide;
                for (side, name) in shown.sides.iter().zip(["A", "B"]) {
                    if shown.sides.len() > 1 {
                        ui.label(RichText::new(name).small().strong());
                    }
                    figures(ui, side, is_one);
                }
                let state = match shown.request.converge {
                    _ if shown.is_last => "finished",
                    Some(_) => "converging",
                    None => "refining",
                };
                let state = match session.progress {
                    Some(done) if !shown.is_last => format!("{state}, {:.0} %", 100.0 * done),
                    _ => state.to_owned(),
                };
                quiet(ui, state).on_hover_text("How far the next picture is");
                if let Some(rate) = session.pace.rate(Instant::now()) {
                    quiet(ui, format!("{rate:.0} pictures a second"))
                        .on_hover_text("Changes that were shown in the last second");
                }
            }
        }
        if !is_wide {
            return;
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
    if is_long {
        quiet(ui, format!("{evaluations:.1} evaluations a ray"))
            .on_hover_text("Evaluations of the field, of all stages, for each primary ray");
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
    let left_out = match side.rung.draft {
        Draft::Whole => None,
        Draft::Unoccluded => Some("without occlusion"),
        Draft::Shadowless => Some("without shadows"),
    };
    if let Some(what) = left_out {
        quiet(ui, what.to_owned())
            .on_hover_text("Left out as long as something moves, to be there in time");
    }
    if let Some(convergence) = side.convergence {
        quiet(ui, noise(&convergence)).on_hover_text(
            "95 of 100 pixels are so near to what they converge to, as a share of white, and what is wanted",
        );
    }
}

/// How much noise there is, how much there is to be, and how long that takes.
fn noise(convergence: &Convergence) -> String {
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let wanted = percent(convergence.wanted);
    match (convergence.noise, convergence.left) {
        (Some(noise), _) if noise <= convergence.wanted => format!("noise {}", percent(noise)),
        (Some(noise), Some(left)) => {
            format!(
                "noise {} of {wanted}, {} left",
                percent(noise),
                lasting(left)
            )
        }
        (Some(noise), None) => format!("noise {} of {wanted}", percent(noise)),
        (None, _) => "noise not known yet".to_owned(),
    }
}

/// A time that is estimated.
fn lasting(seconds: f64) -> String {
    match seconds {
        s if s >= 2.0 * 3600.0 => format!("{:.0} h", s / 3600.0),
        s if s >= 120.0 => format!("{:.0} min", s / 60.0),
        s => format!("{s:.0} s"),
    }
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

    #[test]
    fn noise_says_what_is_left() {
        let of = |noise, left| {
            let convergence = super::Convergence {
                noise,
                wanted: 0.005,
                left,
            };
            super::noise(&convergence)
        };
        assert_eq!(of(None, None), "noise not known yet");
        assert_eq!(
            of(Some(0.0123), Some(75.2)),
            "noise 1.23 % of 0.50 %, 75 s left"
        );
        assert_eq!(
            of(Some(0.04), Some(1234.0)),
            "noise 4.00 % of 0.50 %, 21 min left"
        );
        assert_eq!(of(Some(0.004), Some(0.0)), "noise 0.40 %");
    }
}
