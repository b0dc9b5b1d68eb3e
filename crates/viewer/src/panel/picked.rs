//! What was clicked.

use crate::session::Session;
use crate::style::Palette;
use crate::widget::row;
use eframe::egui::{Color32, Frame, Label, Margin, RichText, Sense, Stroke, Ui, vec2};
use glam::Vec3;
use zeroset_output::display::{NAME, name as shown};
use zeroset_output::tone;

/// A card with the object, its material, the point, and its place in the file. Gives whether it was closed.
pub fn picked(ui: &mut Ui, session: &mut Session) -> bool {
    let Some(picked) = session.picked.clone() else {
        return false;
    };
    let palette = Palette::of(ui.visuals());
    let mut is_closed = false;
    card(&palette).show(ui, |ui| {
        ui.set_width(330.0);
        ui.horizontal(|ui| {
            let [r, g, b] = picked
                .colour
                .to_array()
                .map(|c| (tone::encode(c) * 255.0).round() as u8);
            let (rect, _) = ui.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
            ui.painter()
                .rect_filled(rect, 4.0, Color32::from_rgb(r, g, b));
            let name = if picked.name.parse::<u64>().is_ok() {
                format!("Object {}", picked.name)
            } else {
                shown(&picked.name, NAME)
            };
            ui.label(RichText::new(name).strong());
            ui.with_layout(
                eframe::egui::Layout::right_to_left(eframe::egui::Align::Center),
                |ui| {
                    let close = ui.small_button("×").accessible_name("Close the card");
                    is_closed = close.on_hover_text("Closes this card (Esc).").clicked();
                },
            );
        });
        if let Some(place) = picked.whereabouts().map(|place| shown(&place, 200)) {
            row(
                ui,
                "In the file",
                "Where it is shown: file, line, column.",
                |ui| {
                    if ui.link(&place).on_hover_text("Copies the place.").clicked() {
                        ui.ctx().copy_text(place.clone());
                    }
                },
            );
        }
        let fact = |ui: &mut Ui, name: &str, text: String| {
            row(ui, name, "", |ui| {
                ui.add(Label::new(text.as_str()).truncate())
                    .on_hover_text(text);
            });
        };
        fact(ui, "Material", shown(&picked.material, 200));
        fact(ui, "Point", spoken(picked.point));
        fact(ui, "Normal", spoken(picked.normal));
        fact(ui, "Distance", format!("{:.4}", picked.distance));
    });
    if is_closed {
        session.picked = None;
    }
    is_closed
}

/// What lies on the picture.
pub(crate) fn card(palette: &Palette) -> Frame {
    Frame::new()
        .fill(palette.card)
        .stroke(Stroke::new(1.0, palette.edge))
        .corner_radius(10)
        .inner_margin(Margin::symmetric(14, 10))
}

fn spoken(p: Vec3) -> String {
    let [x, y, z] = p.to_array().map(|x| if x.abs() < 5e-5 { 0.0 } else { x });
    format!("{x:.4}, {y:.4}, {z:.4}")
}
