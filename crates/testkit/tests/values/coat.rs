//! Materials on what was moved, turned, scaled and copied after it was painted; patterns within patterns, and what they say of roughness
//! and heights.

use crate::known::{Check, Draw, Eye, Found, ball, compare, light, rgb, scene, value, with};
use crate::pattern::{A, B, clouds};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 8] = [
    Check {
        name: "a pattern goes where its shape goes",
        run: carried,
    },
    Check {
        name: "copies carry the pattern",
        run: repeated,
    },
    Check {
        name: "copies around an axis carry the pattern",
        run: polar,
    },
    Check {
        name: "one painted shape in two places",
        run: twice,
    },
    Check {
        name: "patterns in patterns, turned and stretched",
        run: nested,
    },
    Check {
        name: "a pattern of numbers",
        run: numbers,
    },
    Check {
        name: "an even slope",
        run: slope,
    },
    Check {
        name: "bumps of noise",
        run: bumps,
    },
];

const C: [f64; 3] = [0.2, 0.8, 0.4];

/// Bands along x; nothing near their borders, where the mean depends on the shape of the pixel.
fn bands(local: DVec3, size: f64) -> Option<DVec3> {
    let p = local.x / size;
    let clear = (p - p.round()).abs() > 0.15;
    clear.then(|| light(if p.rem_euclid(2.0) < 1.0 { B } else { A }))
}

fn striped(shape: &str, size: f64) -> String {
    let (a, b) = (rgb(A), rgb(B));
    format!("{shape}.paint(stripes({a}, {b}, direction = \"x\", size = {size}))")
}

fn carried(draw: Draw) -> Found {
    let at = DVec3::new(0.2, -0.3, 0.4);
    let painted = striped("sphere(1)", 0.3);
    let text =
        format!("show({painted}.scale(1.5).turn(z = 30).turn(x = 50).move((0.2, -0.3, 0.4)))");
    let back = (DMat3::from_rotation_x(50_f64.to_radians())
        * DMat3::from_rotation_z(30_f64.to_radians()))
    .transpose();
    let eye = Eye::straight(DVec3::Z, DVec3::Y, at, 3.2);
    let film = draw(&scene(&text, &eye));
    let right = |x, y| {
        let (o, d) = eye.ray(x, y);
        let p = o + d * ball((o, d), at, 1.5)?;
        // where a pixel is not much longer than wide
        let faces = (p - at).z > 0.6;
        bands(back * (p - at) / 1.5, 0.3).filter(|_| faces)
    };
    compare(&film, &eye, Plane::Albedo, 0.005, right)
}

fn repeated(draw: Draw) -> Found {
    let painted = striped("sphere(0.5)", 0.3);
    let text = format!("show({painted}.move(y = 0.1).repeat((1.3, 1.4, 0), (3, 3, 1)))");
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 4.2).with_size([96, 96]);
    let film = draw(&scene(&text, &eye));
    let right = |x, y| {
        let (o, d) = eye.ray(x, y);
        let cell = |x: f64, spacing: f64| (x / spacing).round().clamp(-1.0, 1.0) * spacing;
        let at = DVec3::new(cell(o.x, 1.3), cell(o.y - 0.1, 1.4) + 0.1, 0.0);
        let p = o + d * ball((o, d), at, 0.5)?;
        let faces = (p - at).z > 0.3;
        bands(p - at + DVec3::new(0.0, 0.1, 0.0), 0.3).filter(|_| faces)
    };
    compare(&film, &eye, Plane::Albedo, 0.005, right)
}

fn polar(draw: Draw) -> Found {
    let painted = striped("sphere(0.5)", 0.3);
    let text = format!("show({painted}.move(x = 1.4).polar(6))");
    let eye = Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::ZERO, 4.2).with_size([96, 96]);
    let film = draw(&scene(&text, &eye));
    let right = |x, y| {
        let (o, d) = eye.ray(x, y);
        let sector = PI / 3.0;
        let angle = (o.z.atan2(o.x) / sector).round() * sector;
        // to the copy on the x axis
        let turn = DMat3::from_rotation_y(angle);
        let at = DVec3::new(1.4, 0.0, 0.0);
        let p = o + d * ball((o, d), turn.transpose() * at, 0.5)?;
        bands(turn * p - at, 0.3).filter(|_| p.y > 0.3)
    };
    compare(&film, &eye, Plane::Albedo, 0.005, right)
}

fn twice(draw: Draw) -> Found {
    let text = format!(
        "a = {}\nshow(smooth_union(a.move(x = 1), a.turn(z = 90).move(x = -1), radius = 0.1))",
        striped("sphere(0.8)", 0.25)
    );
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 2.0);
    let film = draw(&scene(&text, &eye));
    let right = |x, y| {
        let (o, d) = eye.ray(x, y);
        let at = DVec3::new(o.x.signum(), 0.0, 0.0);
        let p = o + d * ball((o, d), at, 0.8)? - at;
        let local = if at.x < 0.0 {
            DVec3::new(p.y, -p.x, p.z)
        } else {
            p
        };
        // where the joint does not reach
        bands(local, 0.25).filter(|_| p.z > 0.4 && p.x * at.x > -0.3)
    };
    compare(&film, &eye, Plane::Albedo, 0.005, right)
}

fn nested(draw: Draw) -> Found {
    let (a, b, c) = (rgb(A), rgb(B), rgb(C));
    let text = format!(
        "inner = stripes({a}, {b}, direction = \"x\", size = 0.2).turn(z = 90)
pattern = stripes({c}, inner, direction = \"x\", size = 0.4).scale((2, 1, 1)).turn(z = 30).move(x = 0.3)
show(box(4), material(color = pattern))"
    );
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 2.4);
    let film = draw(&scene(&text, &eye));
    let right = |x, y| {
        let p = eye.ray(x, y).0 - DVec3::new(0.3, 0.0, 0.0);
        let p = DMat3::from_rotation_z(30_f64.to_radians()).transpose() * p;
        let p = DVec3::new(0.5 * p.x, p.y, 0.0);
        let (outer, inner) = (p.x / 0.4, p.y / 0.2);
        let near = |q: f64| (q - q.round()).abs() < 0.2;
        let second = |q: f64| q.rem_euclid(2.0) < 1.0;
        let colour = match (second(outer), second(inner)) {
            (false, _) => C,
            (true, true) => B,
            (true, false) => A,
        };
        (!near(outer) && !near(inner)).then(|| light(colour))
    };
    compare(&film, &eye, Plane::Albedo, 0.005, right)
}

/// Bands of two roughnesses, of two metals: each shows what a whole surface of its kind shows.
fn numbers(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(1.0, 5.0, 4.0),
        ..Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::ZERO, 3.0)
    };
    for (word, [first, second]) in [("roughness", [0.3, 0.7]), ("metallic", [0.0, 1.0])] {
        let with_word = |value: &str| {
            let text = format!(
                "show(plane(), material(color = \"#c08040\", {word} = {value}))
sun(direction = (-0.3, -1, -0.6), shadow = none())\nsky(\"#6080a0\", ambient = 0.7)"
            );
            draw(&with(
                &text,
                &eye,
                "aa = none(), ao = none(), integrator = direct()",
            ))
        };
        let bands = with_word(&format!(
            "stripes({first}, {second}, direction = \"x\", size = 0.5)"
        ));
        let [first, second] = [first, second].map(|x| with_word(&x.to_string()));
        let mut differ = 0;
        let right = |x: f64, y: f64| {
            let p = crate::known::floor(eye.ray(x, y))?.x / 0.5;
            let film = if p.rem_euclid(2.0) < 1.0 {
                &second
            } else {
                &first
            };
            let clear = (p - p.round()).abs() > 0.2;
            clear.then(|| value(film, Plane::Colour, x as usize, y as usize))
        };
        compare(&bands, &eye, Plane::Colour, 1e-4, right).map_err(|e| format!("{word}: {e}"))?;
        for (x, y, ..) in eye.pixels() {
            let [a, b] = [&first, &second].map(|film| value(film, Plane::Colour, x, y));
            differ += usize::from((a - b).abs().max_element() > 0.01);
        }
        if differ * 2 < 48 * 36 {
            return Err(format!("two values of {word} look alike"));
        }
    }
    Ok(())
}

/// Lambert's light of a lamp far away on a floor with heights.
pub fn lit(
    draw: Draw,
    floor: &str,
    normal: impl Fn(DVec3) -> Option<DVec3>,
    tolerance: f64,
) -> Found {
    let eye = Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::ZERO, 2.4);
    let text =
        format!("show({floor})\nsun(direction = (1, -2, 0.5), shadow = none())\nsky(ambient = 0)");
    let choices = "aa = none(), ao = none(), shading = \"lambert\"";
    let film = draw(&with(&text, &eye, choices));
    let to = -DVec3::new(1.0, -2.0, 0.5).normalize();
    compare(&film, &eye, Plane::Colour, tolerance, |x, y| {
        let n = normal(crate::known::floor(eye.ray(x, y))?)?;
        Some(DVec3::splat(n.dot(to).max(0.0) / PI))
    })
}

fn slope(draw: Draw) -> Found {
    let heights = "gradient(0, 1, start = (-2, 0, 0), end = (2, 0, 0))";
    let coat = format!("material(color = \"white\", bump = {heights}, bump_depth = 0.8)");
    let along_x = DVec3::new(-0.2, 1.0, 0.0).normalize();
    // the x axis of what was turned by 90 degrees about y is -z
    let along_z = DVec3::new(0.0, 1.0, 0.2).normalize();
    let dents = coat.replace("0.8", "-0.8");
    for (floor, normal) in [
        (format!("plane(), {coat}"), along_x),
        (format!("plane().paint({coat}).scale(3)"), along_x),
        (format!("plane().paint({coat}).turn(y = 90)"), along_z),
        (
            format!("plane(), {dents}"),
            DVec3::new(0.2, 1.0, 0.0).normalize(),
        ),
    ] {
        lit(draw, &floor, |_| Some(normal), 2e-3).map_err(|e| format!("{floor}: {e}"))?;
    }
    Ok(())
}

fn bumps(draw: Draw) -> Found {
    let coat = "material(color = \"white\", bump = noise(0, 1, size = 1.2, octaves = 1), bump_depth = 0.3)";
    let height = |p: DVec3| 0.3 * clouds(p, 1e-3, 1.2, 1);
    let normal = |p: DVec3| {
        let h = 0.03;
        let along = |d: DVec3| (height(p + d * h) - height(p - d * h)) / (2.0 * h);
        Some(DVec3::new(-along(DVec3::X), 1.0, -along(DVec3::Z)).normalize())
    };
    lit(draw, &format!("plane(), {coat}"), normal, 0.012)
}
