//! Two looks beside each other.

use crate::session::Session;
use crate::widget::{aside, switch};
use eframe::egui::Ui;

/// Turns the comparison on, and says which look is changed.
pub fn comparison(ui: &mut Ui, session: &mut Session) {
    let mut on = session.comparison.is_on;
    switch(
        ui,
        "Show A and B",
        "Two settings beside each other (C).",
        &mut on,
    );
    set_comparison(session, on);
    if !session.comparison.is_on {
        aside(
            ui,
            "Two settings of one scene, with a divider that can be dragged.",
        );
        return;
    }
    ui.horizontal(|ui| {
        ui.weak("Panels change");
        for (i, name) in ["A, left", "B, right"].into_iter().enumerate() {
            ui.selectable_value(&mut session.comparison.edited, i, name);
        }
    });
    ui.horizontal(|ui| {
        if ui
            .button("Swap")
            .on_hover_text("A becomes B and B becomes A.")
            .clicked()
        {
            session.looks.swap(0, 1);
        }
        let edited = session.comparison.edited.min(1);
        let (from, to) = if edited == 0 { ("B", "A") } else { ("A", "B") };
        let same = ui.button(format!("Copy {from} to {to}"));
        if same.on_hover_text("Makes both the same.").clicked() {
            session.looks[edited] = session.looks[1 - edited];
        }
    });
}

/// Turns the comparison on or off. B begins as A, and is what the panels then change.
pub(crate) fn set_comparison(session: &mut Session, on: bool) {
    if on == session.comparison.is_on {
        return;
    }
    session.comparison.is_on = on;
    if on {
        session.looks[1] = session.looks[0];
        session.comparison.edited = 1;
        session.comparison.divider = 0.5;
    } else {
        session.comparison.edited = 0;
    }
}
