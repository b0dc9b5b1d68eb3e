//! The sky: what is behind everything, what comes of it to a surface, and its mirror image.

use crate::known::{Check, Draw, Eye, Found, Lens, SIZE, ball, compare, light, rgb, scene, with};
use glam::DVec3;
use std::f64::consts::TAU;
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 7] = [
    Check {
        name: "the sky through a pinhole",
        run: behind,
    },
    Check {
        name: "the sky in parallel rays",
        run: parallel,
    },
    Check {
        name: "a sky of one colour",
        run: even,
    },
    Check {
        name: "ambient light",
        run: ambient,
    },
    Check {
        name: "mirrors",
        run: mirrors,
    },
    Check {
        name: "fog",
        run: fog,
    },
    Check {
        name: "the disc of the sun",
        run: disc,
    },
];

pub const TOP: [f64; 3] = [0.1, 0.3, 0.9];
pub const HORIZON: [f64; 3] = [0.9, 0.8, 0.4];
pub const BOTTOM: [f64; 3] = [0.5, 0.1, 0.2];

pub fn line(ambient: f64) -> String {
    let [top, horizon, bottom] = [TOP, HORIZON, BOTTOM].map(rgb);
    format!("sky(top = {top}, horizon = {horizon}, bottom = {bottom}, ambient = {ambient})\n")
}

/// The horizon, and from there to what is straight up or down, about half way at a sine of 0.35.
pub fn along(y: f64) -> DVec3 {
    let far = if y < 0.0 { BOTTOM } else { TOP };
    light(HORIZON).lerp(light(far), y * y * 1.1225 / (y * y + 0.1225))
}

/// What arrives at a surface whose normal has this height: the mean of the sky by the cosine law, summed up.
pub fn arriving(height: f64) -> DVec3 {
    let n = DVec3::new((1.0 - height * height).sqrt(), height, 0.0);
    let (rings, turns) = (64, 64);
    let (mut sum, mut all) = (DVec3::ZERO, 0.0);
    for i in 0..rings {
        let y = (f64::from(i) + 0.5) / f64::from(rings) * 2.0 - 1.0;
        for k in 0..turns {
            let phi = (f64::from(k) + 0.5) / f64::from(turns) * TAU;
            let r = (1.0 - y * y).sqrt();
            let cosine = n.dot(DVec3::new(r * phi.cos(), y, r * phi.sin())).max(0.0);
            sum += cosine * along(y);
            all += cosine;
        }
    }
    sum / all
}

/// A camera that sees what is above and what is below.
fn wide(lens: Lens) -> Eye {
    Eye {
        at: DVec3::new(1.0, 2.0, 3.0),
        target: DVec3::new(-1.0, 2.6, -2.0),
        up: DVec3::Y,
        lens,
        size: SIZE,
    }
}

/// Something that is not in the picture.
const BEHIND: &str = "show(sphere(0.1).move(30, 30, 300))\n";

fn behind(draw: Draw) -> Found {
    let eye = wide(Lens::Fov(110.0));
    let film = draw(&scene(&format!("{BEHIND}{}", line(0.5)), &eye));
    compare(&film, &eye, Plane::Colour, 2e-3, |x, y| {
        Some(along(eye.ray(x, y).1.y))
    })?;
    compare(&film, &eye, Plane::Coverage, 0.0, |_, _| Some(DVec3::ZERO))
}

/// Parallel rays all see one place of the sky.
fn parallel(draw: Draw) -> Found {
    let eye = wide(Lens::Height(9.0));
    let film = draw(&scene(&format!("{BEHIND}{}", line(0.5)), &eye));
    let y = (eye.target - eye.at).normalize().y;
    compare(&film, &eye, Plane::Colour, 1e-3, |_, _| Some(along(y)))
}

/// A ball before the sky.
fn before(material: &str, sky: &str) -> String {
    format!("show(sphere(1), material({material}))\nsun(strength = 0, shadow = none())\n{sky}")
}

const ALBEDO: [f64; 3] = [0.7, 0.5, 0.9];

/// Normal, direction of sight and cosine between them where the ball is met; not where it is grazed.
fn on_ball(eye: &Eye, x: f64, y: f64) -> Option<(DVec3, DVec3, f64)> {
    let ray = eye.ray(x, y);
    let n = ray.0 + ray.1 * ball(ray, DVec3::ZERO, 1.0)?;
    let cosine = -n.dot(ray.1);
    (cosine > 0.25).then_some((n, ray.1, cosine))
}

fn near() -> Eye {
    Eye {
        at: DVec3::new(0.5, 1.0, 3.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        lens: Lens::Fov(40.0),
        size: SIZE,
    }
}

/// Under a sky of one colour it does not matter which way a surface faces.
fn even(draw: Draw) -> Found {
    let eye = near();
    let sky = format!("sky(color = {}, ambient = 0.6)", rgb(TOP));
    let material = format!("color = {}, roughness = 1", rgb(ALBEDO));
    let film = draw(&with(&before(&material, &sky), &eye, MATTE));
    let right = light(ALBEDO) * light(TOP) * 0.6;
    compare(&film, &eye, Plane::Colour, 1e-3, |x, y| {
        on_ball(&eye, x, y).map(|_| right)
    })
}

/// Matte surfaces alone.
const MATTE: &str = "aa = none(), ao = none(), shading = \"phong\"";

/// A surface sees the sky over it, by the cosine law.
fn ambient(draw: Draw) -> Found {
    let material = format!("color = {}, roughness = 1", rgb(ALBEDO));
    let text = before(&material, &line(0.8));
    for side in [0.5, 3.0, -3.0] {
        let eye = Eye {
            at: DVec3::new(0.5, side, 2.5),
            ..near()
        };
        let film = draw(&with(&text, &eye, MATTE));
        let right = |x, y| {
            let (n, ..) = on_ball(&eye, x, y)?;
            Some(light(ALBEDO) * 0.8 * arriving(n.y))
        };
        compare(&film, &eye, Plane::Colour, 4e-3, right)?;
    }
    Ok(())
}

/// A smooth metal shows the sky along the mirror direction in its colour, whiter the more it is grazed (Schlick 1994), and a
/// smooth plastic 4 % of it over what is left for its own colour.
fn mirrors(draw: Draw) -> Found {
    let eye = near();
    for metallic in [0.0, 1.0] {
        let material = format!(
            "color = {}, roughness = 0, metallic = {metallic}",
            rgb(ALBEDO)
        );
        let film = draw(&scene(&before(&material, &line(0.8)), &eye));
        let right = |x, y| {
            let (n, d, cosine) = on_ball(&eye, x, y)?;
            let mirrored = along((d + n * 2.0 * cosine).y);
            let straight = light(ALBEDO) * metallic + DVec3::splat(0.04 * (1.0 - metallic));
            let share = straight.lerp(DVec3::ONE, (1.0 - cosine).powi(5));
            // what is not mirrored comes to the body below
            let around = (DVec3::ONE - share) * arriving(n.y);
            Some(share * mirrored + light(ALBEDO) * around * 0.8 * (1.0 - metallic))
        };
        compare(&film, &eye, Plane::Colour, 0.01, right)
            .map_err(|e| format!("metallic {metallic}: {e}"))?;
    }
    Ok(())
}

/// What fog leaves over the way through it, in small steps; then its own colour, and what it shows of the sun.
fn fog(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(0.0, 2.0, 6.0),
        target: DVec3::new(0.0, 1.0, 0.0),
        up: DVec3::Y,
        lens: Lens::Fov(50.0),
        size: SIZE,
    };
    for (words, height) in [
        ("density = 0.1", None),
        ("density = 0.3, height = 0.8, base = 0.5", Some(0.8)),
    ] {
        let text = format!(
            "show(plane(), material(color = \"black\", specular = 0, roughness = 1, emission = {}))
sun(direction = (0, -1, 2), strength = 0.4, shadow = none())\n{}fog({words}, color = {}, glow = 0.5)",
            rgb(ALBEDO),
            line(0.0),
            rgb([0.5, 0.6, 0.7])
        );
        let film = draw(&scene(&text, &eye));
        let density = |y: f64| match height {
            None => 0.1,
            Some(h) => 0.3 * ((0.5 - y) / h).exp(),
        };
        let right = |x, y| {
            let (o, d) = eye.ray(x, y);
            let met = crate::known::floor((o, d));
            if met.is_none() && (height.is_some() && d.y < 0.05) {
                return None;
            }
            let far = met.map_or(400.0, |p| (p - o).length());
            let steps = 4000;
            let depth: f64 = (0..steps)
                .map(|i| density(o.y + d.y * far * (f64::from(i) + 0.5) / f64::from(steps)))
                .sum::<f64>()
                * far
                / f64::from(steps);
            let left = (-depth).exp();
            let behind = if met.is_some() {
                light(ALBEDO)
            } else {
                along(d.y)
            };
            let cosine = d.dot(-DVec3::new(0.0, -1.0, 2.0).normalize());
            let phase = (1.0 - 0.49) / (1.49 - 1.4 * cosine).powf(1.5);
            let own = light([0.5, 0.6, 0.7]) + DVec3::splat(0.25 * 0.5 * 0.4 * phase);
            Some(behind * left + own * (1.0 - left))
        };
        compare(&film, &eye, Plane::Colour, 4e-3, right).map_err(|e| format!("{words}: {e}"))?;
    }
    Ok(())
}

/// A white disc of the stated width around the sun, and nowhere else.
fn disc(draw: Draw) -> Found {
    let way = DVec3::new(0.2, -0.3, 1.0);
    let eye = Eye {
        at: DVec3::ZERO,
        target: -way,
        up: DVec3::Y,
        lens: Lens::Fov(20.0),
        size: SIZE,
    };
    let text = format!(
        "{BEHIND}sun(direction = (0.2, -0.3, 1), strength = 0.1, shadow = none())\nsky(color = {}, sun = 10)",
        rgb(TOP)
    );
    let film = draw(&scene(&text, &eye));
    compare(&film, &eye, Plane::Colour, 2e-3, |x, y| {
        let angle = eye.ray(x, y).1.angle_between(-way).to_degrees();
        if (angle - 5.0).abs() < 0.05 {
            return None;
        }
        // as much as lights a surface, but no more than twenty times as bright
        let power = (2.0 * (1.0 - 5f64.to_radians().cos())).recip().min(20.0);
        Some(light(TOP) + DVec3::splat(if angle < 5.0 { 0.1 * power } else { 0.0 }))
    })
}
