//! The sun, the sky, and what the object is made of that was picked.

use crate::session::{Session, levels};
use crate::widget::{aside, row, slide, switch};
use eframe::egui::{Button, Slider, Ui};
use glam::Vec3;
use zeroset_language::revision::{Change, Look};
use zeroset_output::display::{NAME, name as shown};
use zeroset_output::tone;
use zeroset_scene::colour::linear;
use zeroset_scene::light::{Light, Sky, Source};
use zeroset_scene::material::Pattern;

/// Where the sun stands, and how it shines.
pub fn sun(ui: &mut Ui, session: &mut Session) {
    let Some((number, sun)) = session.sun() else {
        aside(ui, "This scene has none. sun() in the file makes one.");
        return;
    };
    let Source::Directional { direction } = sun.source else {
        return;
    };
    let about = "Drags on the picture move the sun (L).";
    switch(ui, "Drag the sun", about, &mut session.is_sun_held);
    let before = SunPlace::of(direction);
    let mut place = before;
    let slider = Slider::new(&mut place.azimuth, -180.0..=180.0)
        .max_decimals(1)
        .suffix("°");
    let about = "Where it stands around the vertical: 0 is +z, 90 is +x.";
    slide(ui, "Azimuth", about, slider);
    let slider = Slider::new(&mut place.elevation, -90.0..=90.0)
        .max_decimals(1)
        .suffix("°");
    slide(
        ui,
        "Elevation",
        "How high it stands above the horizon.",
        slider,
    );
    if place != before {
        session.turn_sun(place.direction());
    }
    let strength = sun.radiance.max_element();
    let mut now = strength;
    let slider = Slider::new(&mut now, 0.0..=strength.max(5.0)).max_decimals(2);
    let hue = if strength > 0.0 {
        sun.radiance / strength
    } else {
        Vec3::ONE
    };
    slide(ui, "Strength", "How strong its light is.", slider);
    let colour = swatch(ui, "Sun colour", "The colour of its light.", hue).map(linear);
    if now != strength || colour.is_some() {
        let Some((
            _,
            Light {
                source: Source::Directional { direction },
                ..
            },
        )) = session.sun()
        else {
            return;
        };
        session.change(Change::Sun {
            light: number,
            direction,
            radiance: colour.unwrap_or(hue) * now,
        });
    }
    let is_sun = |c: &Change| matches!(c, Change::Sun { .. });
    back(ui, session, "The sun as in the file", is_sun);
}

/// The colours of the sky.
pub fn sky(ui: &mut Ui, session: &mut Session) {
    let Some(current) = &session.current else {
        return;
    };
    if current.scene.environment().is_some() {
        aside(
            ui,
            "This sky is an image, or that of the hour: see sky() in the file.",
        );
        return;
    }
    let before = *current.scene.sky();
    let mut now = before;
    let colours = [
        ("Top", "Colour straight up.", &mut now.top),
        ("Horizon", "Colour at the horizon.", &mut now.horizon),
        ("Bottom", "Colour straight down.", &mut now.bottom),
    ];
    for (name, about, colour) in colours {
        if let Some(srgb) = swatch(ui, name, about, *colour) {
            *colour = linear(srgb);
        }
    }
    let about = "How much of its light reaches a surface from everywhere.";
    let slider = Slider::new(&mut now.ambient, 0.0..=before.ambient.max(2.0)).max_decimals(2);
    slide(ui, "Ambient", about, slider);
    if now != before {
        let Sky {
            top,
            horizon,
            bottom,
            ambient,
            ..
        } = now;
        session.change(Change::Sky {
            top,
            horizon,
            bottom,
            ambient,
        });
    }
    let is_sky = |c: &Change| matches!(c, Change::Sky { .. });
    back(ui, session, "The sky as in the file", is_sky);
}

/// The material of the object that was picked.
pub fn material(ui: &mut Ui, session: &mut Session) {
    let Some(object) = session.picked_object() else {
        aside(
            ui,
            "Click on an object to see and change what it is made of.",
        );
        return;
    };
    let (Some(current), Some(object)) = (&session.current, session.objects().get(object)) else {
        return;
    };
    let number = usize::from(object.material);
    let Some(material) = current.scene.materials().get(number).cloned() else {
        return;
    };
    let name = shown(&object.name, NAME);
    let sharing = (session.objects().iter())
        .filter(|o| usize::from(o.material) == number)
        .count();
    row(ui, "Object", "What was clicked.", |ui| ui.label(name));
    let before = session.look_of(number);
    let mut look = before;
    match material.pattern {
        Pattern::Solid { colour } => {
            if let Some(srgb) = swatch(ui, "Colour", "The colour of its surface.", colour) {
                look.colour = Some(srgb);
            }
        }
        _ => {
            aside(ui, "Its colour is a pattern, which the file says.");
        }
    }
    let mut number_of = |name: &str, about: &str, now: f32, most: f32, to: &mut Option<f32>| {
        let mut x = now;
        let slider = Slider::new(&mut x, 0.0..=most).max_decimals(3);
        if slide(ui, name, about, slider).changed() {
            *to = Some(x);
        }
    };
    let Look {
        roughness,
        metallic,
        specular,
        ..
    } = &mut look;
    if material.roughness_map.is_none() {
        let about = "0 is a mirror, 1 is chalk.";
        number_of("Roughness", about, material.roughness, 1.0, roughness);
    }
    if material.metallic_map.is_none() {
        let about = "0 is plastic or stone, 1 is metal.";
        number_of("Metallic", about, material.metallic, 1.0, metallic);
    }
    let about = "How strong its highlight is; 0.25 is usual.";
    let most = material.specular.max(1.0);
    number_of("Specular", about, material.specular, most, specular);
    if look != before {
        session.change(Change::Material {
            material: number,
            look,
        });
    }
    if sharing > 1 {
        aside(ui, &format!("{sharing} objects have this material."));
    }
    let is_it = |c: &Change| matches!(c, Change::Material { material, .. } if *material == number);
    back(ui, session, "The material as in the file", is_it);
}

/// A button that takes changes back, where there are any.
fn back(ui: &mut Ui, session: &mut Session, name: &str, is_meant: impl Fn(&Change) -> bool) {
    let is_changed = session.stage.iter().any(&is_meant);
    let button = ui.add_enabled(is_changed, Button::new("As in the file"));
    let button = button.on_hover_text("Takes back what was changed here.");
    if button.accessible_name(name).clicked() {
        session.reset_stage(is_meant);
    }
}

/// A colour that can be changed; linear. Gives what it was changed to, sRGB.
fn swatch(ui: &mut Ui, name: &str, about: &str, colour: Vec3) -> Option<[f64; 3]> {
    let before = levels(&colour.to_array().map(|c| f64::from(tone::encode(c))));
    let mut rgb = before;
    row(ui, name, about, |ui| {
        ui.color_edit_button_srgb(&mut rgb).accessible_name(name)
    });
    let [r, g, b] = rgb;
    let is_changed = rgb != before;
    // exactly as a file says it
    let parse = || zeroset_language::colour::parse(&format!("#{r:02x}{g:02x}{b:02x}")).ok();
    is_changed.then(parse).flatten()
}

/// Where the sun stands in the sky, degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SunPlace {
    /// Around the vertical: 0 is +z, 90 is +x.
    pub(crate) azimuth: f32,
    /// Above the horizon.
    pub(crate) elevation: f32,
}

impl SunPlace {
    /// Of the sun whose light travels so.
    pub(crate) fn of(direction: Vec3) -> SunPlace {
        let to = -direction;
        SunPlace {
            azimuth: to.x.atan2(to.z).to_degrees(),
            elevation: to.y.clamp(-1.0, 1.0).asin().to_degrees(),
        }
    }

    /// The way that its light travels.
    pub(crate) fn direction(self) -> Vec3 {
        // straight above, it would forget where around the vertical it stands
        let elevation = self.elevation.clamp(-89.9, 89.9).to_radians();
        let azimuth = self.azimuth.to_radians();
        let flat = elevation.cos();
        -Vec3::new(flat * azimuth.sin(), elevation.sin(), flat * azimuth.cos())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_directions() {
        for (azimuth, elevation) in [(0.0, 0.0), (90.0, 45.0), (-120.0, -30.0), (30.0, 89.0)] {
            let place = SunPlace { azimuth, elevation };
            let again = SunPlace::of(place.direction());
            assert!((again.azimuth - azimuth).abs() < 0.05, "{again:?}");
            assert!((again.elevation - elevation).abs() < 0.01, "{again:?}");
        }
        let east = SunPlace {
            azimuth: 90.0,
            elevation: 0.0,
        };
        assert!((east.direction() + Vec3::X).length() < 1e-6);
    }
}
