//! Patterns: what colour is where, and what becomes of features finer than a pixel.

use crate::known::{Check, Draw, Eye, FACES, Found, Lens, SIZE, compare, light, rgb, scene, value};
use glam::{DVec2, DVec3};
use zeroset::catalogue::noise::gradient_noise;
use zeroset::number::{F64, v3};
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 8] = [
    Check {
        name: "checker",
        run: checker,
    },
    Check {
        name: "stripes",
        run: stripes,
    },
    Check {
        name: "slanted stripes",
        run: slanted,
    },
    Check {
        name: "gradient",
        run: gradient,
    },
    Check {
        name: "noise",
        run: noise,
    },
    Check {
        name: "fine patterns become their mean",
        run: fine,
    },
    Check {
        name: "orbit without a fractal",
        run: no_orbit,
    },
    Check {
        name: "orbit",
        run: orbit,
    },
];

pub const A: [f64; 3] = [0.9, 0.4, 0.1];
pub const B: [f64; 3] = [0.1, 0.3, 0.8];

/// Share of the first colour, 0 to 1, as a colour.
fn mix(second: f64) -> DVec3 {
    light(A).lerp(light(B), second)
}

/// A pattern of the two colours on a cube around the origin.
fn cube(side: f64, pattern: &str, more: &str) -> String {
    let colours = format!("{}, {}", rgb(A), rgb(B));
    format!("show(box({side}), material(color = {pattern}({colours}, {more})))")
}

/// Mean over `from` to `to` of a wave that is 1 from 0 to 1, -1 from 1 to 2, and so on.
fn wave(from: f64, to: f64) -> f64 {
    // its integral from 0 is a triangle wave
    let integral = |x: f64| {
        let r = x.rem_euclid(2.0);
        if r < 1.0 { r } else { 2.0 - r }
    };
    (integral(to) - integral(from)) / (to - from)
}

/// Mean of the wave over a pixel around `x`, both in cells.
fn over(x: f64, pixel: f64) -> f64 {
    wave(x - 0.5 * pixel, x + 0.5 * pixel)
}

/// The cube of cells from the origin to (size, size, size) has the second colour, and so has every second one. A face that
/// lies between two layers shows the one under it: a floor at y = 0 has the first colour where x and z are both positive.
/// A pixel shows the mean over its area.
fn checker(draw: Draw) -> Found {
    let (side, size) = (3.2, 0.4);
    for (from, up) in FACES {
        let eye = Eye::straight(from, up, DVec3::ZERO, 2.9);
        let film = draw(&scene(
            &cube(side, "checker", &format!("size = {size}")),
            &eye,
        ));
        let right = |x, y| {
            let (o, d) = eye.ray(x, y);
            let p = (o + d * (8.0 - 0.5 * side)) / size;
            let pixel = eye.pixel() / size;
            let mean = (0..3).map(|k| {
                if from[k] == 0.0 {
                    over(p[k], pixel)
                } else {
                    wave(p[k] - 0.01 * from[k], p[k] - 0.02 * from[k])
                }
            });
            let inside = (p - p * from.abs()).abs().max_element() < 0.5 * side / size - pixel;
            inside.then(|| mix(0.5 + 0.5 * mean.product::<f64>()))
        };
        compare(&film, &eye, Plane::Albedo, 0.01, right)
            .map_err(|e| format!("from {from}: {e}"))?;
    }
    let eye = Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::ZERO, 2.0);
    let colours = format!("{}, {}", rgb(A), rgb(B));
    let text = format!("show(plane(), checker({colours}, size = 1))");
    let film = draw(&scene(&text, &eye));
    let quarter = |x, y| {
        let q = eye.on_plane(x, y);
        let clear =
            q.abs().min_element() > eye.pixel() && q.abs().max_element() < 1.0 - eye.pixel();
        clear.then(|| mix(if (q.x > 0.0) == (q.y > 0.0) { 0.0 } else { 1.0 }))
    };
    compare(&film, &eye, Plane::Albedo, 0.01, quarter).map_err(|e| format!("the floor: {e}"))
}

/// The band from the origin on has the second colour.
fn stripes(draw: Draw) -> Found {
    for (axis, name) in [(DVec3::X, "x"), (DVec3::Y, "y")] {
        let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::new(0.1, -0.2, 0.0), 2.2);
        let more = format!("direction = \"{name}\", size = 0.3");
        let film = draw(&scene(&cube(4.0, "stripes", &more), &eye));
        let right = |x, y| {
            let p = eye.ray(x, y).0.dot(axis) / 0.3;
            Some(mix(0.5 + 0.5 * over(p, eye.pixel() / 0.3)))
        };
        compare(&film, &eye, Plane::Albedo, 0.01, right)
            .map_err(|e| format!("along {name}: {e}"))?;
    }
    Ok(())
}

/// A direction has a length of 1, whatever is written, and a sense.
fn slanted(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::X, DVec3::Y, DVec3::ZERO, 2.8);
    let film = draw(&scene(
        &cube(4.0, "stripes", "direction = (0, 2, -3), size = 0.5"),
        &eye,
    ));
    let direction = DVec3::new(0.0, 2.0, -3.0).normalize();
    let right = |x, y| {
        let p = eye.ray(x, y).0.with_x(2.0).dot(direction) / 0.5;
        // beside a border the mean depends on the shape of the pixel
        let clear = (p - p.round()).abs() > eye.pixel() / 0.5;
        clear.then(|| mix(if p.rem_euclid(2.0) < 1.0 { 1.0 } else { 0.0 }))
    };
    compare(&film, &eye, Plane::Albedo, 0.005, right)
}

fn gradient(draw: Draw) -> Found {
    let (start, end) = (DVec3::new(-0.5, 0.3, 0.0), DVec3::new(0.9, -0.6, 1.0));
    let more = "start = (-0.5, 0.3, 0), end = (0.9, -0.6, 1)";
    for (from, up) in [FACES[2], FACES[4]] {
        let eye = Eye::straight(from, up, DVec3::ZERO, 2.8);
        let film = draw(&scene(&cube(4.0, "gradient", more), &eye));
        let right = |x, y| {
            let (o, d) = eye.ray(x, y);
            let p = o + d * 6.0;
            let way = end - start;
            Some(mix(
                ((p - start).dot(way) / way.length_squared()).clamp(0.0, 1.0)
            ))
        };
        compare(&film, &eye, Plane::Albedo, 0.005, right)?;
    }
    Ok(())
}

/// The sum of octaves in double precision, each faded by the share of its feature that a pixel covers.
pub fn clouds(p: DVec3, pixel: f64, size: f64, octaves: u32) -> f64 {
    // on a face that is seen straight on a pixel is a square
    let mut footprint = pixel * 2.0f64.sqrt() / size;
    let (mut p, mut share, mut sum, mut total) = (p / size, 1.0, 0.0, 0.0);
    for k in 0..octaves {
        let seen = (1.0 - 2.0 * footprint).max(0.0);
        sum += share * seen * gradient_noise(v3(F64(p.x), F64(p.y), F64(p.z))).0;
        total += share;
        p = DVec3::new(0.8 * p.y + 0.6 * p.z, p.x, 0.6 * p.y - 0.8 * p.z) * 2.0
            + DVec3::new(0.37, 0.61, 0.13 + f64::from(k));
        (share, footprint) = (0.5 * share, 2.0 * footprint);
    }
    (0.5 + 0.8 * sum / total).clamp(0.0, 1.0)
}

fn noise(draw: Draw) -> Found {
    for (size, octaves) in [(0.9, 1), (1.3, 3), (1.3, 8), (0.25, 8)] {
        let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::new(0.3, -0.2, 0.0), 3.0);
        let more = format!("size = {size}, octaves = {octaves}");
        let film = draw(&scene(&cube(5.0, "noise", &more), &eye));
        let right = |x, y| {
            let p = eye.ray(x, y).0.with_z(2.5);
            Some(mix(clouds(p, eye.pixel(), size, octaves)))
        };
        compare(&film, &eye, Plane::Albedo, 0.01, right)
            .map_err(|e| format!("{octaves} octaves of {size}: {e}"))?;
    }
    Ok(())
}

/// What no pixel can show is shown as its mean, the middle of the two colours.
fn fine(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 30.0);
    for (pattern, more) in [
        ("checker", "size = 0.011"),
        ("stripes", "direction = \"x\", size = 0.007"),
        ("noise", "size = 1.5, octaves = 8"),
    ] {
        let film = draw(&scene(
            &cube(60.0, pattern, more).replace("box(60)", "box((60, 60, 2))"),
            &eye,
        ));
        compare(&film, &eye, Plane::Albedo, 0.01, |_, _| Some(mix(0.5)))
            .map_err(|e| format!("{pattern}: {e}"))?;
    }
    Ok(())
}

/// Colours of the traps that tell by a channel each how much a trap counts.
const TRAPS: &str =
    "orbit(center = \"black\", x = rgb(1, 0, 0), y = rgb(0, 1, 0), z = rgb(0, 0, 1))";

/// What has no orbit is equally far from all traps.
fn no_orbit(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 2.0);
    let film = draw(&scene(&format!("show(box(4), {TRAPS})"), &eye));
    compare(&film, &eye, Plane::Albedo, 1e-3, |_, _| {
        Some(DVec3::splat(0.25))
    })
}

/// The Julia set of q^2 is the unit ball, and an orbit that begins in the plane y = 0 or z = 0 stays there: nothing is nearer
/// to it than that plane. One that begins on the x-axis stays there, at distance 1 from the origin and from x = 0.
fn orbit(draw: Draw) -> Found {
    let eye = Eye {
        size: [33, 33],
        ..Eye::straight(DVec3::X, DVec3::Y, DVec3::ZERO, 1.6)
    };
    let film = draw(&scene(
        &format!("show(julia((0, 0, 0), c_w = 0), {TRAPS})"),
        &eye,
    ));
    let (near, far) = (1.0 / 0.08f64.powi(2), 1.0 / (1.0 + 0.08f64.powi(2)));
    let middle = DVec3::new(far, near, near) / (2.0 * far + 2.0 * near);
    let found = value(&film, Plane::Albedo, 16, 16);
    if (found - middle).abs().max_element() > 2e-3 {
        return Err(format!("in the middle {found} instead of {middle}"));
    }
    for k in 0..33 {
        let (row, column) = (
            value(&film, Plane::Albedo, k, 16),
            value(&film, Plane::Albedo, 16, k),
        );
        if row.y < row.max_element() - 1e-3 || column.z < column.max_element() - 1e-3 {
            return Err(format!(
                "the nearest plane does not count most: {row}, {column}"
            ));
        }
    }
    Ok(())
}

/// Two materials that a smooth join blends count half each in the middle between their shapes.
#[test]
fn the_wave_is_its_mean() {
    assert!((wave(0.2, 0.8) - 1.0).abs() < 1e-12 && (wave(-0.8, -0.2) + 1.0).abs() < 1e-12);
    assert!(wave(-0.5, 0.5).abs() < 1e-12 && (wave(0.5, 1.25) - 1.0 / 3.0).abs() < 1e-12);
    let eye = Eye {
        lens: Lens::Fov(90.0),
        ..Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 1.0)
    };
    assert_eq!(eye.on_plane(0.0, 0.0), DVec2::new(-4.0 / 3.0, -1.0));
    assert_eq!(SIZE, [48, 36]);
}
