//! The methods of the papers, side by side.

use crate::preset::Preset;
use crate::session::Session;
use crate::widget::{aside, choose, choose_or, real, section, slide, switch, whole};
use eframe::egui::{RichText, Slider, Ui};
use zeroset_scene::settings::Settings;

/// What is seen of the film, and how bright.
pub fn view(ui: &mut Ui, session: &mut Session) {
    let look = session.edited();
    choose(ui, "Show", &mut look.plane);
    real(ui, &Settings::EXPOSURE, &mut look.settings.exposure);
    choose(ui, "Tone curve", &mut look.settings.tone);
}

/// Methods that go together, at a press.
pub fn presets(ui: &mut Ui, session: &mut Session) {
    let look = session.edited();
    let about = "Sets all methods at once.";
    ui.label(RichText::new("Quality").weak())
        .on_hover_text(about);
    ui.horizontal_wrapped(|ui| {
        for preset in Preset::ALL {
            let mut settings = look.settings;
            let shadow = preset.apply(&mut settings);
            let is_on = (settings, shadow) == (look.settings, look.shadow);
            let button = ui.selectable_label(is_on, preset.name());
            if button.on_hover_text(preset.about()).clicked() {
                (look.settings, look.shadow) = (settings, shadow);
            }
        }
    });
}

/// Every method that the edited look can have.
pub fn methods(ui: &mut Ui, session: &mut Session) {
    let stated = *session.stated();
    let (mut refine, mut noise) = (session.refine, session.noise);
    let look = session.edited();
    section(ui, "Marching", true, |ui| {
        choose(ui, "March", &mut look.settings.march);
        let about = "Marches whole tiles as cones first, so that rays start near the surface.";
        switch(ui, "Cone prepass", about, &mut look.settings.prepass);
        hits(ui, &mut look.settings);
    });
    section(ui, "Light and shadow", false, |ui| {
        choose(ui, "Integrator", &mut look.settings.integrator);
        choose(ui, "Shading", &mut look.settings.shading);
        choose_or(ui, "Shadow", "As each light has it", &mut look.shadow);
    });
    section(ui, "Ambient occlusion", false, |ui| {
        choose(ui, "Occlusion", &mut look.settings.occlusion);
        aside(ui, "Objects that choose a method of their own keep it.");
    });
    section(ui, "Normals", false, |ui| {
        choose(ui, "Normals", &mut look.settings.normals);
    });
    section(ui, "Antialiasing", false, |ui| {
        choose(ui, "Edges", &mut look.settings.antialias);
        let slider = Slider::new(&mut look.settings.seed, 0..=99);
        slide(
            ui,
            "Seed",
            "Other random numbers for all that samples.",
            slider,
        );
        let about = "Goes on to 64 rays a pixel while nothing changes.";
        switch(ui, "Refine at rest", about, &mut refine);
        let slider = Slider::new(&mut noise, 0.001..=0.1).logarithmic(true);
        let about = "Where Converge ends: 95 of 100 pixels are then so near to what they converge to, as a share of white.";
        slide(ui, "Noise", about, slider);
    });
    let changed = Settings {
        size: stated.size,
        ..look.settings
    } != stated
        || look.shadow.is_some();
    ui.add_space(4.0);
    let reset = ui.add_enabled(changed, eframe::egui::Button::new("As in the file"));
    if reset
        .on_hover_text("Puts every method back to what the file states.")
        .clicked()
    {
        look.settings = stated;
        look.shadow = None;
    }
    (session.refine, session.noise) = (refine, noise);
}

/// When a ray has hit (Keinert et al. 2014, 3.2 to 3.4).
fn hits(ui: &mut Ui, settings: &mut Settings) {
    whole(ui, &Settings::MAX_STEPS, &mut settings.max_steps);
    real(ui, &Settings::FOOTPRINT, &mut settings.footprint);
    let reduction = &mut settings.discontinuity_reduction;
    whole(ui, &Settings::DISCONTINUITY_REDUCTION, reduction);
    let about = "A ray that runs out of steps takes its best candidate (Keinert et al. 2014, 3.2).";
    switch(ui, "Hit selection", about, &mut settings.hit_selection);
}
