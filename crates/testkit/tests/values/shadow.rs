//! Shadows: where they lie, and how soft they are.

use crate::known::{Check, Draw, Eye, Found, ball, compare, floor, scene, value};
use glam::DVec3;
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 4] = [
    Check {
        name: "a hard shadow of the sun",
        run: |draw| {
            hard(
                draw,
                "sun(direction = (1, -1.5, -0.6), shadow = hard())",
                |_| DVec3::new(-1.0, 1.5, 0.6) * 1000.0,
            )
        },
    },
    Check {
        name: "a hard shadow of a lamp",
        run: |draw| {
            hard(
                draw,
                "point_light((-0.6, 2.6, 0.3), shadow = hard())",
                |p| DVec3::new(-0.6, 2.6, 0.3) - p,
            )
        },
    },
    Check {
        name: "a soft shadow",
        run: |draw| soft(draw, "soft", [0.98, 1.08], [0.99, 1.05]),
    },
    Check {
        name: "a soft shadow without bands",
        run: |draw| soft(draw, "soft_closest", [0.85, 1.12], [0.975, 1.06]),
    },
];

const CENTRE: DVec3 = DVec3::new(0.0, 1.5, 0.0);
const RADIUS: f64 = 0.5;
const SCENE: &str = "show(plane())\nshow(sphere(0.5).move(y = 1.5))\n";

/// The ball's shadow is where the way to the light meets it. `to` is the way from a point to the light.
fn hard(draw: Draw, line: &str, to: fn(DVec3) -> DVec3) -> Found {
    let eye = Eye {
        at: DVec3::new(2.0, 7.0, 5.0),
        ..Eye::straight(DVec3::Y, DVec3::Y, DVec3::new(0.5, 0.0, -0.2), 4.0)
    };
    let film = draw(&scene(&format!("{SCENE}{line}"), &eye));
    let lit = |x: f64, y: f64| {
        let ray = eye.ray(x, y);
        if ball(ray, CENTRE, RADIUS).is_some() {
            return None;
        }
        let p = floor(ray)?;
        Some(ball((p, to(p).normalize()), CENTRE, RADIUS).is_none_or(|t| t > to(p).length()))
    };
    let right = |x: f64, y: f64| {
        let own = lit(x, y)?;
        let corners = [(0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8)];
        let clear = corners.iter().all(|(u, v)| lit(x + u, y + v) == Some(own));
        clear.then(|| DVec3::splat(if own { 1.0 } else { 0.0 }))
    };
    let (mut bright, mut dark) = (0, 0);
    for (_, _, x, y) in eye.pixels() {
        match right(x, y) {
            Some(lit) if lit.x == 1.0 => bright += 1,
            Some(_) => dark += 1,
            None => {}
        }
    }
    assert!(
        bright > 200 && dark > 20,
        "{bright} and {dark} pixels show little"
    );
    compare(&film, &eye, Plane::Shadow, 0.0, right)
}

/// Larger is sharper.
const SHARPNESS: f64 = 2.0;

/// What is left of the light straight above a point of the floor: `sharpness * distance / way`, the least on the way, found
/// by looking everywhere.
fn penumbra(p: DVec3) -> f64 {
    let distance = |t: f64| {
        let q = p + DVec3::Y * t;
        q.y.min(q.distance(CENTRE) - RADIUS)
    };
    let ways = (1..4000).map(|k| 0.001 * f64::from(k));
    ways.map(|t| SHARPNESS * distance(t) / t)
        .fold(1.0, f64::min)
        .max(0.0)
}

/// Samples along the way find nearly the least. What is taken for the closest place between two of them is in single pixels up
/// to a tenth too dark, on average right: in double precision, whatever the first sample, 0.89 to 1.09 of the right light and
/// 0.99 to 1.05 on average. (Were it put behind the second sample and not before it, some pixels would have less than 0.8.)
/// `each` and `mean` are bounds of the found light over the right one.
fn soft(draw: Draw, name: &str, each: [f64; 2], mean: [f64; 2]) -> Found {
    let eye = Eye {
        at: DVec3::new(0.0, 6.0, 8.0),
        ..Eye::straight(DVec3::Y, DVec3::Y, DVec3::ZERO, 3.4)
    };
    let sun = format!("sun(direction = (0, -1, 0), shadow = {name}({SHARPNESS}))");
    let film = draw(&scene(&format!("{SCENE}{sun}"), &eye));
    let (mut sum, mut count, mut dark) = (0.0, 0, 0);
    for (x, y, u, v) in eye.pixels() {
        let ray = eye.ray(u, v);
        let Some(p) = floor(ray).filter(|_| ball(ray, CENTRE, RADIUS + 0.1).is_none()) else {
            continue;
        };
        let (found, right) = (value(&film, Plane::Shadow, x, y).x, penumbra(p));
        let shown = || format!("{found} instead of {right} at ({x}, {y})");
        if p.length() < RADIUS - 0.05 {
            dark += 1;
            if found != 0.0 {
                return Err(format!("under the ball: {}", shown()));
            }
        } else if right == 1.0 {
            if found < 0.93 {
                return Err(format!("beside the penumbra: {}", shown()));
            }
        } else if right > 0.1 && right < 0.95 {
            let ratio = found / right;
            if !(each[0] <= ratio && ratio <= each[1]) {
                return Err(shown());
            }
            (sum, count) = (sum + ratio, count + 1);
        }
    }
    assert!(
        count > 200 && dark > 20,
        "{count} and {dark} pixels show little"
    );
    let found = sum / f64::from(count);
    if mean[0] <= found && found <= mean[1] {
        Ok(())
    } else {
        Err(format!(
            "on average {found} of the right light, allowed is {mean:?}"
        ))
    }
}
