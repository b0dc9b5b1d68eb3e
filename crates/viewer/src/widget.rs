//! Controls that the panels are made of. Every one has a name that a screen reader says.

use eframe::egui::{
    Align, CollapsingHeader, ComboBox, Layout, Response, RichText, Slider, SliderClamping, Ui, Vec2,
};
use zeroset_scene::methods::{Choice, Kind, Method, Param, Unit, Value};

/// Width of the names before controls, and their share of a narrow panel.
const NAMES: f32 = 104.0;
const SHARE: f32 = 0.36;
/// Width of the numbers behind sliders.
const NUMBERS: f32 = 62.0;
/// The shortest slider.
const SHORTEST: f32 = 28.0;

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
        let names = NAMES.min(SHARE * ui.available_width());
        let size = Vec2::new(names, ui.spacing().interact_size.y);
        let layout = Layout::left_to_right(Align::Center);
        let label = ui
            .allocate_ui_with_layout(size, layout, |ui| {
                ui.set_min_width(names);
                ui.set_max_width(names);
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
        ui.spacing_mut().slider_width = room.max(SHORTEST);
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

/// A parameter with its value; what it becomes, where it is changed.
pub(crate) fn dial(ui: &mut Ui, param: &Param, value: Value) -> Option<Value> {
    let about = match param.unit {
        Unit::Length | Unit::PerLength => {
            format!(
                "{}, {}.",
                param.doc.trim_end_matches('.'),
                param.unit.name()
            )
        }
        Unit::Ratio | Unit::Count | Unit::Pixels | Unit::Stops => param.doc.to_owned(),
    };
    let (low, high) = (param.usual.0 as f32, param.usual.1 as f32);
    let mut shown = |slider: Slider<'_>| {
        let slider = slider.logarithmic(param.is_logarithmic);
        slide(ui, param.title, &about, slider).changed()
    };
    match value {
        Value::Real(mut x) => {
            let slider = Slider::new(&mut x, low..=high).max_decimals(3);
            shown(slider).then_some(Value::Real(x))
        }
        Value::Whole(mut n) => {
            let slider = Slider::new(&mut n, low as u32..=high as u32);
            shown(slider).then_some(Value::Whole(n))
        }
        Value::Limit(limit) => {
            // the end of the slider stands for no limit
            let mut x = limit.unwrap_or(high);
            let slider = Slider::new(&mut x, low..=high).custom_formatter(move |x, _| {
                if x >= f64::from(high) {
                    "unlimited".to_owned()
                } else {
                    format!("{x:.3}")
                }
            });
            shown(slider).then_some(Value::Limit((x < high).then_some(x)))
        }
        Value::Word(place) => {
            let Kind::Word(methods) = param.kind else {
                return None;
            };
            let chosen = pop_up(ui, param.title, methods, Some(place), None).flatten();
            explain(ui, methods.get(chosen.unwrap_or(place))?);
            chosen.map(Value::Word)
        }
    }
}

/// A number of the settings.
pub(crate) fn real(ui: &mut Ui, param: &Param, number: &mut f32) {
    if let Some(Value::Real(x)) = dial(ui, param, Value::Real(*number)) {
        *number = x;
    }
}

/// A whole number of the settings.
pub(crate) fn whole(ui: &mut Ui, param: &Param, number: &mut u32) {
    if let Some(Value::Whole(n)) = dial(ui, param, Value::Whole(*number)) {
        *number = n;
    }
}

/// What a method does, and its numbers.
fn details<T: Choice>(ui: &mut Ui, chosen: &mut T) {
    explain(ui, chosen.method());
    for param in chosen.method().params {
        if let Some(value) = chosen.get(param.name)
            && let Some(value) = dial(ui, param, value)
        {
            // sliders end within what is allowed, and what is typed is clamped to them
            let _ = chosen.set(param.name, value);
        }
    }
}

/// A method among all of its kind, with what it does, and its numbers.
pub(crate) fn choose<T: Choice>(ui: &mut Ui, name: &str, chosen: &mut T) -> bool {
    let before = *chosen;
    if let Some(Some(place)) = pop_up(ui, name, T::METHODS, Some(chosen.place()), None) {
        *chosen = T::all()[place];
    }
    details(ui, chosen);
    *chosen != before
}

/// As [`choose`], with a word for the choice to make none.
pub(crate) fn choose_or<T: Choice>(
    ui: &mut Ui,
    name: &str,
    none: &'static str,
    chosen: &mut Option<T>,
) {
    let place = chosen.as_ref().map(Choice::place);
    if let Some(place) = pop_up(ui, name, T::METHODS, place, Some(none)) {
        *chosen = place.map(|p| T::all()[p]);
    }
    if let Some(chosen) = chosen {
        details(ui, chosen);
    }
}

/// A list of methods that pops up. Gives what was chosen; inside, `None` is the choice to make none.
fn pop_up(
    ui: &mut Ui,
    name: &str,
    methods: &[Method],
    place: Option<usize>,
    none: Option<&'static str>,
) -> Option<Option<usize>> {
    let text = place.map_or(none.unwrap_or_default(), |p| methods[p].title);
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
                    let entry = ui.selectable_label(place == Some(i), method.title);
                    let about = format!("{}\n{}", method.doc, method.source)
                        .trim_end()
                        .to_owned();
                    if entry.on_hover_text(about).clicked() {
                        chosen = Some(Some(i));
                    }
                }
            });
        let about = place.map_or_else(String::new, |p| methods[p].doc.to_owned());
        let response = shown.response.accessible_name(name);
        if !about.is_empty() {
            response.on_hover_text(about);
        }
        chosen
    });
    chosen
}

/// What a method does and where it comes from.
fn explain(ui: &mut Ui, method: &Method) {
    let text = match method.source {
        "" => method.doc.to_owned(),
        source => format!("{} [{source}]", method.doc),
    };
    ui.label(RichText::new(text).small().weak());
    ui.add_space(1.0);
}

/// Text that is worth less than other text.
pub(crate) fn aside(ui: &mut Ui, text: &str) -> Response {
    ui.label(RichText::new(text).small().weak())
}
