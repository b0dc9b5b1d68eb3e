//! What is shown: a list of the scene's objects.

use crate::session::Session;
use crate::widget::aside;
use eframe::egui::{Align, Label, Layout, RichText, Sense, Ui};
use zeroset_output::display::{NAME, name as shown};
use zeroset_scene::scene::Object;

/// Every object with its place in the file; each can be hidden, or shown alone.
pub fn objects(ui: &mut Ui, session: &mut Session) {
    let named = |o: &Object| {
        let name = match o.name.parse::<u64>() {
            Ok(_) => format!("Object {}", o.name),
            Err(_) => shown(&o.name, NAME),
        };
        (name, o.place.clone())
    };
    let names: Vec<_> = session.objects().iter().map(named).collect();
    for (number, (name, place)) in names.iter().enumerate() {
        let mut is_shown = !session.hidden.contains(&number);
        ui.horizontal(|ui| {
            let show = ui.checkbox(&mut is_shown, "");
            let show = show.on_hover_text("Shows it or hides it, in the window alone.");
            if show.accessible_name(format!("Show {name}")).changed() {
                session.show_object(number, is_shown);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let solo = ui.small_button("Solo");
                let solo = solo.on_hover_text("Shows it alone; once more for all.");
                if solo.accessible_name(format!("Solo {name}")).clicked() {
                    session.solo(number);
                }
                if let Some((file, line, column)) = place {
                    let file = shown(file, NAME);
                    let link = ui.link(RichText::new(format!("line {line}")).small());
                    let link =
                        link.on_hover_text(format!("{file}:{line}:{column} (copies the place)"));
                    if link.accessible_name(format!("Place of {name}")).clicked() {
                        ui.ctx().copy_text(format!("{file}:{line}:{column}"));
                    }
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let label = Label::new(name.as_str()).truncate().sense(Sense::hover());
                    ui.add(label);
                });
            });
        });
    }
    if !session.hidden.is_empty() {
        aside(
            ui,
            "What is hidden here is in the file, and in pictures that render makes.",
        );
    }
}
