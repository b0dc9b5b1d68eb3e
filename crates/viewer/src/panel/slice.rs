//! A plane through the field.

use crate::session::Session;
use crate::slice::Slice;
use crate::widget::{aside, row, slide, switch};
use eframe::egui::{Slider, Ui};

/// Where the plane is.
pub fn slice(ui: &mut Ui, session: &mut Session) {
    let about = "Draws the distance to the surface on a plane (X).";
    switch(ui, "Show the plane", about, &mut session.is_sliced);
    if !session.is_sliced {
        aside(
            ui,
            "Blue is inside, red outside; lines join points of equal distance.",
        );
        return;
    }
    let before = session.slice.axis;
    row(ui, "Across", "The axis that the plane lies across.", |ui| {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            ui.selectable_value(&mut session.slice.axis, axis, name);
        }
    });
    let Some(current) = &session.current else {
        return;
    };
    let room = Slice::room(&current.scene);
    let axis = session.slice.axis;
    let (low, high) = (room.min[axis], room.max[axis]);
    if axis != before {
        session.slice.at = 0.5 * (low + high);
    }
    session.slice.at = session.slice.at.clamp(low, high);
    let slider = Slider::new(&mut session.slice.at, low..=high).max_decimals(3);
    slide(ui, "Offset", "Where on the axis, scene units.", slider);
}
