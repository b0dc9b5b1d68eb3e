//! Formulas of materials: what colour is where, in the space of what was painted, and what shows where a formula has no value.

use crate::coat::lit;
use crate::known::{Check, Draw, Eye, Found, ball, compare, light, scene, value, with};
use glam::{DMat3, DVec3};
use zeroset::catalogue::noise::gradient_noise;
use zeroset::number::{F64, v3};
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 8] = [
    Check {
        name: "a colour by a formula",
        run: colour,
    },
    Check {
        name: "a formula mixes colours by name",
        run: mixed,
    },
    Check {
        name: "noise, turns and fields within a colour",
        run: functions,
    },
    Check {
        name: "a formula goes where its shape goes",
        run: carried,
    },
    Check {
        name: "formulas within patterns, placed",
        run: nested,
    },
    Check {
        name: "values without number or out of range",
        run: wild,
    },
    Check {
        name: "numbers by formulas",
        run: numbers,
    },
    Check {
        name: "heights by a formula",
        run: heights,
    },
];

fn straight() -> Eye {
    Eye::straight(DVec3::Z, DVec3::Y, DVec3::new(0.1, -0.2, 0.0), 2.4)
}

/// What a function of the point shows on the face z = 2 of a cube.
fn face(draw: Draw, colour: &str, right: impl Fn(DVec3) -> Option<DVec3>) -> Found {
    let eye = straight();
    let text = format!("ball = sphere(0.7)\nshow(box(4), material(color = lambda p: {colour}))");
    let film = draw(&scene(&text, &eye));
    compare(&film, &eye, Plane::Albedo, 2e-3, |x, y| {
        right(eye.ray(x, y).0.with_z(2.0))
    })
    .map_err(|e| format!("{colour}: {e}"))
}

fn colour(draw: Draw) -> Found {
    let text = "(0.5 + 0.4 * sin(3 * p.x), 0.5 + 0.3 * p.y, 0.2 if p.x > 0.05 else 0.7)";
    face(draw, text, |p| {
        let blue = if p.x > 0.05 { 0.2 } else { 0.7 };
        let clear = (p.x - 0.05).abs() > 1e-3;
        clear.then(|| light([0.5 + 0.4 * (3.0 * p.x).sin(), 0.5 + 0.3 * p.y, blue]))
    })
}

/// Colours are mixed as they are written.
fn mixed(draw: Draw) -> Found {
    let orange = [1.0, 165.0 / 255.0, 0.0];
    let text = "mix(\"orange\", \"#0000ff\", 0.5 + 0.25 * p.x)";
    face(draw, text, |p| {
        let t = 0.5 + 0.25 * p.x;
        Some(light([0, 1, 2].map(|k| {
            orange[k] * (1.0 - t) + if k == 2 { t } else { 0.0 }
        })))
    })?;
    let text = "\"orange\" if length(p.xy) < 0.6 else \"#0000ff\"";
    face(draw, text, |p| {
        let r = p.truncate().length();
        let clear = (r - 0.6).abs() > 1e-3;
        clear.then(|| light(if r < 0.6 { orange } else { [0.0, 0.0, 1.0] }))
    })
}

fn functions(draw: Draw) -> Found {
    let noise = |p: DVec3| gradient_noise(v3(F64(p.x), F64(p.y), F64(p.z))).0;
    face(draw, "vec3(0.5 + 0.5 * noise(3 * p))", |p| {
        Some(light([0.5 + 0.5 * noise(p * 3.0); 3]))
    })?;
    let text = "vec3(0.5 + 0.2 * rotate(p, \"z\", 0.7).x, 0.3, 0.5)";
    face(draw, text, |p| {
        let turned = DMat3::from_rotation_z(0.7) * p;
        Some(light([0.5 + 0.2 * turned.x, 0.3, 0.5]))
    })?;
    face(
        draw,
        "(0.3 * ball(p), 0.3 * ball((p.x, p.y, 0)), 0.2)",
        |p| {
            let flat = p.truncate().length() - 0.7;
            Some(light([0.3 * (p.length() - 0.7), 0.3 * flat.max(0.0), 0.2]))
        },
    )
}

fn carried(draw: Draw) -> Found {
    let at = DVec3::new(0.2, -0.3, 0.4);
    let paint = "material(color = lambda p: (0.5 + 0.4 * p.x, 0.5 + 0.4 * p.y, 0.5 + 0.4 * p.z))";
    let text = format!(
        "show(sphere(1).paint({paint}).scale(1.5).turn(z = 30).turn(x = 50).move((0.2, -0.3, 0.4)))"
    );
    let back = (DMat3::from_rotation_x(50_f64.to_radians())
        * DMat3::from_rotation_z(30_f64.to_radians()))
    .transpose();
    let eye = Eye::straight(DVec3::Z, DVec3::Y, at, 3.2);
    let film = draw(&scene(&text, &eye));
    compare(&film, &eye, Plane::Albedo, 4e-3, |x, y| {
        let (o, d) = eye.ray(x, y);
        let p = o + d * ball((o, d), at, 1.5)?;
        let local = back * (p - at) / 1.5;
        ((p - at).z > 0.6).then(|| light((local * 0.4 + 0.5).to_array()))
    })
}

fn nested(draw: Draw) -> Found {
    let text = "inner = stripes(lambda p: (0.2, 0.5 + 0.2 * p.x, 0.4), \"#ffffff\", direction = \"x\", size = 0.4)
show(box(4), material(color = inner.turn(z = 90).move(x = 0.3)))";
    let eye = straight();
    let film = draw(&scene(text, &eye));
    compare(&film, &eye, Plane::Albedo, 4e-3, |x, y| {
        let p = eye.ray(x, y).0 - DVec3::new(0.3, 0.0, 0.0);
        // the x axis of what was turned is y
        let local = DVec3::new(p.y, -p.x, 0.0);
        let band = local.x / 0.4;
        let clear = (band - band.round()).abs() > 0.2;
        let first = [0.2, 0.5 + 0.2 * local.x, 0.4];
        clear.then(|| {
            light(if band.rem_euclid(2.0) < 1.0 {
                [1.0; 3]
            } else {
                first
            })
        })
    })
}

/// What is no number is magenta, in all channels; what is below 0 or above 1 is the nearest that is not.
fn wild(draw: Draw) -> Found {
    let magenta = DVec3::new(1.0, 0.0, 1.0);
    let text = "vec3(0.3, 0.4, (p.x - p.x) / (p.y - p.y)) if p.x > 0 else vec3(p.y * 20, -3, 0.25)";
    face(draw, text, |p| {
        let clear = p.x.abs() > 1e-3 && p.y.abs() > 0.06;
        let right = match (p.x > 0.0, p.y > 0.0) {
            (true, _) => magenta,
            (false, true) => light([1.0, 0.0, 0.25]),
            (false, false) => light([0.0, 0.0, 0.25]),
        };
        clear.then_some(right)
    })?;
    face(draw, "vec3(1e17 * p.z * 1e17, 0, 0)", |_| Some(magenta))
}

/// Each place shows what a whole surface of its roughness, or of its metal, shows.
fn numbers(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(1.0, 5.0, 4.0),
        ..Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::ZERO, 3.0)
    };
    for (word, [first, second]) in [("roughness", [0.3, 0.7]), ("metallic", [0.0, 1.0])] {
        let shown = |value: &str| {
            let text = format!(
                "show(plane(), material(color = \"#c08040\", {word} = {value}))
sun(direction = (-0.3, -1, -0.6), shadow = none())\nsky(\"#6080a0\", ambient = 0.7)"
            );
            let choices = "aa = none(), ao = none(), integrator = direct()";
            draw(&with(&text, &eye, choices))
        };
        let halves = shown(&format!("lambda p: {first} if p.x < 0 else {second}"));
        let [a, b] = [first, second].map(|x| shown(&x.to_string()));
        compare(&halves, &eye, Plane::Colour, 1e-4, |x, y| {
            let p = crate::known::floor(eye.ray(x, y))?;
            let film = if p.x < 0.0 { &a } else { &b };
            let clear = p.x.abs() > 1e-3;
            clear.then(|| value(film, Plane::Colour, x as usize, y as usize))
        })
        .map_err(|e| format!("{word}: {e}"))?;
    }
    Ok(())
}

/// Heights may be anything, and below 0 too; in the space of what was painted.
fn heights(draw: Draw) -> Found {
    let coat = "material(color = \"white\", bump = lambda p: sin(3 * p.x), bump_depth = 0.2)";
    lit(
        draw,
        &format!("plane(), {coat}"),
        |p| Some(DVec3::new(-0.6 * (3.0 * p.x).cos(), 1.0, 0.0).normalize()),
        0.012,
    )?;
    lit(
        draw,
        &format!("plane().paint({coat}).scale(2)"),
        |p| Some(DVec3::new(-0.6 * (1.5 * p.x).cos(), 1.0, 0.0).normalize()),
        0.012,
    )
}
