//! The time of an animation.

use crate::clock::{LENGTHS, RATES};
use crate::session::Session;
use eframe::egui::{DragValue, RichText, Slider, SliderClamping, Ui};

/// Play, step, scrub, loop; length and frames a second.
pub fn timeline(ui: &mut Ui, session: &mut Session) {
    let clock = &mut session.clock;
    ui.horizontal(|ui| {
        let (name, about) = if clock.is_playing {
            ("Pause", "Stops (Space).")
        } else {
            ("Play", "Lets the time run (Space).")
        };
        let button = eframe::egui::Button::new(name).min_size(eframe::egui::vec2(58.0, 0.0));
        if ui.add(button).on_hover_text(about).clicked() {
            clock.toggle();
        }
        for (word, name, about, frames) in [
            ("−", "Previous frame", "Previous frame (,)", -1),
            ("+", "Next frame", "Next frame (.)", 1),
        ] {
            if ui
                .button(word)
                .on_hover_text(about)
                .accessible_name(name)
                .clicked()
            {
                clock.step(frames);
            }
        }
        ui.toggle_value(&mut clock.is_looping, "Loop")
            .on_hover_text("Begins again at the end.");
        let mut at = clock.time();
        let others = 330.0;
        ui.spacing_mut().slider_width = (ui.available_width() - others).max(80.0);
        let scrub = Slider::new(&mut at, 0.0..=clock.length)
            .fixed_decimals(2)
            .clamping(SliderClamping::Edits)
            .suffix(" s");
        let scrub = ui.add(scrub).accessible_name("Time");
        if scrub.changed() {
            clock.is_playing = false;
            clock.scrub(at);
        }
        ui.label(
            RichText::new(format!("frame {}", clock.frame()))
                .small()
                .weak(),
        );
        ui.label(RichText::new("length").small().weak());
        let length = DragValue::new(&mut clock.length)
            .range(LENGTHS)
            .speed(0.05)
            .suffix(" s");
        ui.add(length)
            .on_hover_text("Length of the animation.")
            .accessible_name("Length");
        let fps = DragValue::new(&mut clock.fps)
            .range(RATES)
            .speed(0.5)
            .max_decimals(2)
            .suffix(" fps");
        ui.add(fps)
            .on_hover_text("Frames a second.")
            .accessible_name("Frames a second");
        clock.settle();
    });
}
