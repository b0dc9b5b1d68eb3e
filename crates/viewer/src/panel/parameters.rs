//! Sliders, choices, toggles and colours that the scene declares.

use crate::session::{Session, levels};
use crate::widget::{aside, row, slide};
use eframe::egui::{ComboBox, Slider, Ui};
use zeroset_language::load::{Control, Parameter, Setting};
use zeroset_output::display::{NAME, name as shown};

/// The parameters of the scene.
pub fn parameters(ui: &mut Ui, session: &mut Session) {
    let all: Vec<Parameter> = session.parameters().to_vec();
    if all.is_empty() {
        aside(
            ui,
            "This scene has none. slider(\"size\", 1) in the file makes one, and so do choice(), toggle() and color().",
        );
        return;
    }
    for parameter in &all {
        let before = session.setting(parameter);
        if let Some(setting) = control(ui, parameter, &before) {
            session.set(parameter, &setting);
        }
    }
    let moved = !session.options.set.is_empty();
    let reset = ui.add_enabled(moved, eframe::egui::Button::new("Reset all"));
    if reset
        .on_hover_text("Gives every parameter its default.")
        .clicked()
    {
        for parameter in &all {
            session.reset(&parameter.name);
        }
    }
}

/// The control of a parameter. Gives what it was set to.
fn control(ui: &mut Ui, parameter: &Parameter, before: &Setting) -> Option<Setting> {
    let name = &shown(&parameter.name, NAME);
    let place = parameter.place.as_ref();
    let about = place.map_or_else(String::new, |(file, line, _)| {
        format!("{name} ({}:{line})", shown(file, NAME))
    });
    match (&parameter.control, before) {
        (Control::Slider { min, max }, Setting::Number(x)) => {
            let mut x = *x;
            let decimals = (3.0 - (max - min).log10().floor()).clamp(0.0, 6.0) as usize;
            let slider = Slider::new(&mut x, *min..=*max).max_decimals(decimals);
            let changed = slide(ui, name, &about, slider).changed();
            changed.then_some(Setting::Number(x))
        }
        (Control::Choice { options }, Setting::Text(text)) => {
            let (_, chosen) = row(ui, name, &about, |ui| {
                let mut chosen = None;
                let shown = ComboBox::from_id_salt(&parameter.name)
                    .selected_text(shown(text, NAME))
                    .width(ui.available_width() - 8.0)
                    .show_ui(ui, |ui| {
                        for option in options {
                            if ui
                                .selectable_label(option == text, shown(option, NAME))
                                .clicked()
                            {
                                chosen = Some(Setting::Text(option.clone()));
                            }
                        }
                    });
                shown.response.accessible_name(name);
                chosen
            });
            chosen
        }
        (Control::Toggle, Setting::Flag(on)) => {
            let mut on = *on;
            let (_, changed) = row(ui, name, &about, |ui| {
                ui.checkbox(&mut on, "").accessible_name(name).changed()
            });
            changed.then_some(Setting::Flag(on))
        }
        (Control::Colour, Setting::Colour(srgb)) => {
            let before = levels(srgb);
            let mut rgb = before;
            row(ui, name, &about, |ui| {
                ui.color_edit_button_srgb(&mut rgb).accessible_name(name)
            });
            (rgb != before).then(|| Setting::Colour(rgb.map(|c| f64::from(c) / 255.0)))
        }
        // the loader makes no other pairs
        _ => None,
    }
}
