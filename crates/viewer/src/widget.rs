//! Controls that the panels are made of. Every one has a name that a screen reader says.

use crate::methods::{Choice, Dial, Method, Number};
use eframe::egui::{
    Align, CollapsingHeader, ComboBox, Layout, Response, RichText, Slider, SliderClamping, Ui, Vec2,
};

/// Width of the names before controls.
const NAMES: f32 = 104.0;
/// Width of the numbers behind sliders.
const NUMBERS: f32 = 62.0;

/// A part of a panel that can be closed.
pub(crate) fn section(ui: &mut Ui, title: &str, is_open: bool, body: impl FnOnce(&mut Ui)) {
    ui.add_space(2.0);
    CollapsingHeader::new(RichText::new(title).strong())
        .id_salt(title)
        .default_open(is_open)
        .show_unindented(ui, |ui| {
            ui.add_space(2.0);
            body(ui);
            ui.add_space(6.0);
        });
    ui.separator();
}

/// A name, and a control to the right of it.
pub(crate) fn row<R>(
    ui: &mut Ui,
    name: &str,
    about: &str,
    control: impl FnOnce(&mut Ui) -> R,
) -> (Response, R) {
    ui.horizontal(|ui| {
        let size = Vec2::new(NAMES, ui.spacing().interact_size.y);
        let layout = Layout::left_to_right(Align::Center);
        let label = ui
            .allocate_ui_with_layout(size, layout, |ui| {
                ui.set_min_width(NAMES);
                let label = eframe::egui::Label::new(RichText::new(name).weak()).truncate();
                ui.add(label)
            })
            .inner;
        let label = if about.is_empty() {
            label
        } else {
            label.on_hover_text(about)
        };
        let inner = control(ui);
        (label, inner)
    })
    .inner
}

/// A slider that takes what room there is.
pub(crate) fn slide(ui: &mut Ui, name: &str, about: &str, slider: Slider<'_>) -> Response {
    let (label, response) = row(ui, name, about, |ui| {
        let room = ui.available_width() - NUMBERS - ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width = room.max(60.0);
        ui.spacing_mut().interact_size.x = NUMBERS;
        ui.add(slider.clamping(SliderClamping::Edits))
    });
    let response = response.labelled_by(label.id);
    if about.is_empty() {
        response
    } else {
        response.on_hover_text(about)
    }
}

/// A switch.
pub(crate) fn switch(ui: &mut Ui, name: &str, about: &str, on: &mut bool) -> Response {
    ui.checkbox(on, name).on_hover_text(about)
}

/// A number of a method.
pub(crate) fn dial(ui: &mut Ui, dial: Dial<'_>) -> bool {
    let (low, high) = dial.range;
    let slider = match dial.number {
        Number::Real(x) => Slider::new(x, low..=high).max_decimals(3),
        Number::Whole(n) => Slider::new(n, low as u32..=high as u32),
        Number::Limit(limit) => {
            let mut x = limit.unwrap_or(high);
            let slider = Slider::new(&mut x, low..=high)
                .logarithmic(dial.is_logarithmic)
                .custom_formatter(move |x, _| {
                    if x >= f64::from(high) {
                        "unlimited".to_owned()
                    } else {
                        format!("{x:.3}")
                    }
                });
            let changed = slide(ui, dial.name, dial.about, slider).changed();
            if changed {
                *limit = (x < high).then_some(x);
            }
            return changed;
        }
    };
    let slider = slider.logarithmic(dial.is_logarithmic);
    slide(ui, dial.name, dial.about, slider).changed()
}

/// A method among all of its kind, with what it does, and its numbers.
pub(crate) fn choose<T: Choice + PartialEq>(ui: &mut Ui, name: &str, chosen: &mut T) -> bool {
    let before = *chosen;
    let place = chosen.place();
    let methods = T::methods();
    if let Some(place) = pop_up(ui, name, methods, Some(place), None)
        && let Some(method) = place.and_then(|p| methods.get(p))
    {
        *chosen = method.make;
    }
    explain(ui, &methods[chosen.place()]);
    for number in chosen.dials() {
        dial(ui, number);
    }
    *chosen != before
}

/// As [`choose`], with a word for the choice to make none.
pub(crate) fn choose_or<T: Choice + PartialEq>(
    ui: &mut Ui,
    name: &str,
    none: &'static str,
    chosen: &mut Option<T>,
) {
    let place = chosen.as_ref().map(Choice::place);
    let methods = T::methods();
    if let Some(place) = pop_up(ui, name, methods, place, Some(none)) {
        *chosen = place.and_then(|p| methods.get(p)).map(|m| m.make);
    }
    let Some(chosen) = chosen else {
        return;
    };
    explain(ui, &methods[chosen.place()]);
    for number in chosen.dials() {
        dial(ui, number);
    }
}

/// A list of methods that pops up. Gives what was chosen; inside, `None` is the choice to make none.
fn pop_up<T>(
    ui: &mut Ui,
    name: &str,
    methods: &[Method<T>],
    place: Option<usize>,
    none: Option<&'static str>,
) -> Option<Option<usize>> {
    let text = place.map_or(none.unwrap_or_default(), |p| methods[p].name);
    let (_, chosen) = row(ui, name, "", |ui| {
        let mut chosen = None;
        let shown = ComboBox::from_id_salt(name)
            .selected_text(text)
            .width(ui.available_width() - 8.0)
            .show_ui(ui, |ui| {
                if let Some(word) = none
                    && ui.selectable_label(place.is_none(), word).clicked()
                {
                    chosen = Some(None);
                }
                for (i, method) in methods.iter().enumerate() {
                    let entry = ui.selectable_label(place == Some(i), method.name);
                    let about = format!("{}\n{}", method.about, method.source)
                        .trim_end()
                        .to_owned();
                    if entry.on_hover_text(about).clicked() {
                        chosen = Some(Some(i));
                    }
                }
            });
        let about = place.map_or_else(String::new, |p| methods[p].about.to_owned());
        let response = shown.response.accessible_name(name);
        if !about.is_empty() {
            response.on_hover_text(about);
        }
        chosen
    });
    chosen
}

/// What a method does and where it comes from.
fn explain<T>(ui: &mut Ui, method: &Method<T>) {
    let text = match method.source {
        "" => method.about.to_owned(),
        source => format!("{} [{source}]", method.about),
    };
    ui.label(RichText::new(text).small().weak());
    ui.add_space(1.0);
}

/// Text that is worth less than other text.
pub(crate) fn aside(ui: &mut Ui, text: &str) -> Response {
    ui.label(RichText::new(text).small().weak())
}
