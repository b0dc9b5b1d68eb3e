//! Light: the formulas of Tomczak 2012, 3.1 to 3.5, and of Munini 2021, 3.3, at known points.

use crate::known::{Check, Draw, Eye, Found, compare, light, rgb, with};
use glam::DVec3;
use std::f64::consts::PI;
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 4] = [
    Check {
        name: "Phong's light",
        run: |draw| lit(draw, "phong", 1.0, true),
    },
    Check {
        name: "Lambert's light",
        run: |draw| lit(draw, "lambert", 1.0 / PI, true),
    },
    Check {
        name: "Lambert's light as printed",
        run: |draw| lit(draw, "lambert_legacy", 0.25 / PI, false),
    },
    Check {
        name: "glow",
        run: glow,
    },
];

const ALBEDO: [f64; 3] = [0.8, 0.6, 0.3];
const SUN: [f64; 3] = [1.0, 0.7, 0.9];
const LAMP: [f64; 3] = [0.6, 1.0, 0.8];
const SKY: [f64; 3] = [0.3, 0.5, 0.7];
const SUN_WAY: DVec3 = DVec3::new(1.0, -2.0, 0.5);
const LAMP_PLACE: DVec3 = DVec3::new(-0.7, 1.2, 0.4);
const SPECULAR: f64 = 0.5;
const SHININESS: f64 = 12.0;

/// A floor under a sun, a lamp, a lamp below it that lights nothing, and a sky of one colour: ambient, diffuse and specular
/// light add up. `scale` is what diffuse light is multiplied with; `falls` whether a lamp grows weaker with the square of its
/// distance, which is as strong as it says at a distance of 1.
fn lit(draw: Draw, shading: &str, scale: f64, falls: bool) -> Found {
    let eye = Eye {
        at: DVec3::new(1.0, 6.0, 3.0),
        ..Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::new(0.1, 0.0, 0.2), 3.0)
    };
    let (w, l) = (SUN_WAY, LAMP_PLACE);
    let text = format!(
        "show(plane(), material(color = {}, roughness = 1, specular = {SPECULAR}, shininess = {SHININESS}))
sun(direction = ({}, {}, {}), color = {}, strength = 0.5, shadow = none())
point_light(({}, {}, {}), color = {}, strength = 0.9, shadow = none())
point_light((0, -1, 0), strength = 30, shadow = none())
sky(color = {}, ambient = 0.4)",
        rgb(ALBEDO), w.x, w.y, w.z, rgb(SUN), l.x, l.y, l.z, rgb(LAMP), rgb(SKY)
    );
    let choices = format!("aa = none(), ao = none(), shading = \"{shading}\"");
    let film = draw(&with(&text, &eye, &choices));
    let right = |x, y| {
        let (o, d) = eye.ray(x, y);
        let p = crate::known::floor((o, d))?;
        let to = LAMP_PLACE - p;
        let power = if falls {
            1.0 / to.length_squared()
        } else {
            1.0
        };
        let lights = [
            (-SUN_WAY.normalize(), light(SUN) * 0.5),
            (to.normalize(), light(LAMP) * 0.9 * power),
        ];
        let mut colour = light(ALBEDO) * light(SKY) * 0.4;
        for (to, radiance) in lights {
            colour += light(ALBEDO) * radiance * (to.y * scale);
            if shading == "phong" {
                let half = (to - d).normalize();
                colour += radiance * (SPECULAR * half.y.powf(SHININESS));
            }
        }
        Some(colour)
    };
    compare(&film, &eye, Plane::Colour, 4e-3, right)?;
    // nothing casts a shadow; the lamp below is in the way of nothing but the floor's own back
    let share = |x, y| {
        let p = crate::known::floor(eye.ray(x, y))?;
        let luminance = |c: DVec3| c.dot(DVec3::new(0.2126, 0.7152, 0.0722));
        let fall = |to: DVec3| {
            if falls {
                1.0 / to.length_squared()
            } else {
                1.0
            }
        };
        let seen =
            luminance(light(SUN)) * 0.5 + luminance(light(LAMP)) * 0.9 * fall(LAMP_PLACE - p);
        let hidden = 30.0 * fall(DVec3::NEG_Y - p);
        Some(DVec3::splat(seen / (seen + hidden)))
    };
    compare(&film, &eye, Plane::Shadow, 4e-3, share)
}

/// What glows shows its own light, whatever falls on it, in every model.
fn glow(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 1.0);
    let text = format!(
        "show(box(4), material(color = \"black\", specular = 0, roughness = 1, emission = {}, strength = 1.5))\nsun()",
        rgb(LAMP)
    );
    for shading in ["physical", "phong", "lambert", "lambert_legacy"] {
        let choices = format!("aa = none(), ao = none(), shading = \"{shading}\"");
        let film = draw(&with(&text, &eye, &choices));
        compare(&film, &eye, Plane::Colour, 1e-3, |_, _| {
            Some(light(LAMP) * 1.5)
        })
        .map_err(|e| format!("{shading}: {e}"))?;
    }
    Ok(())
}
