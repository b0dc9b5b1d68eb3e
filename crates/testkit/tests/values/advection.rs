//! Light that flows through a volume (Evans 2006, 9.9), against what chance says of light that is blurred from voxel to voxel: the shadow of an edge is
//! a sum of many small steps to either side.

use crate::known::{Check, Draw, Eye, Found, Lens, SIZE, ball, compare, floor, scene};
use glam::DVec3;
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 4] = [
    Check {
        name: "the edge of a shadow that flowed",
        run: edge,
    },
    Check {
        name: "a shadow beyond its volume",
        run: beyond,
    },
    Check {
        name: "a ball in light that flows",
        run: own,
    },
    Check {
        name: "a bare floor in light that flows",
        run: bare,
    },
];

/// From one node to the next: the slab is 2 long, and 48 voxels.
const VOXEL: f64 = 2.0 / 48.0;
/// From the middle of the slab to its edge, halfway between two nodes.
const HALF: f64 = 15.5;
const SLAB: &str = "show(plane())\nshow(box((1.291666666, 0.2, 2))";

/// What is left of light at so many voxels from the middle of a shadow that began as wide as the slab and was blurred so often: a
/// quarter of `spread` went to either side each time.
fn left(x: f64, spread: f64, times: usize) -> f64 {
    let mut light: Vec<f64> = (-64..=64)
        .map(|n| f64::from(u8::from(f64::from(n).abs() > HALF)))
        .collect();
    for _ in 0..times {
        let old = light.clone();
        for n in 1..old.len() - 1 {
            light[n] += 0.25 * spread * (old[n - 1] - 2.0 * old[n] + old[n + 1]);
        }
    }
    let at = x + 64.0;
    let (n, t) = (at.floor() as usize, at - at.floor());
    light[n] * (1.0 - t) + light[n + 1] * t
}

fn shadow(draw: Draw, text: &str, spread: f64, times: usize) -> Found {
    let eye = Eye {
        at: DVec3::new(2.4, 0.6, 0.1),
        target: DVec3::new(0.66, 0.0, 0.0),
        up: DVec3::Y,
        lens: Lens::Fov(30.0),
        size: SIZE,
    };
    let text = format!(
        "{text}\nsun(direction = (0, -1, 0), shadow = advected(resolution = 64, spread = {spread}, bias = 2))"
    );
    let film = draw(&scene(&text, &eye));
    compare(&film, &eye, Plane::Shadow, 0.03, |x, y| {
        let p = floor(eye.ray(x, y)).filter(|p| p.z.abs() < 0.4 && p.x > 0.0 && p.x < 1.2)?;
        Some(DVec3::splat(left(p.x / VOXEL, spread, times)))
    })
}

/// A ball on the floor makes the volume reach it. From the first row of nodes below the slab to that which is read there are 17 ways.
fn edge(draw: Draw) -> Found {
    let text = format!("{SLAB}.move(y = 0.9))\nshow(sphere(0.05).move((-0.5, 0.05, -0.9)))");
    for spread in [1.0, 0.3] {
        shadow(draw, &text, spread, 17).map_err(|e| format!("spread {spread}: {e}"))?;
    }
    Ok(())
}

/// The volume ends above the floor: there the shadow goes on as it is.
fn beyond(draw: Draw) -> Found {
    let text = format!("{SLAB}.move(y = 2))");
    shadow(draw, &text, 0.8, 9)
}

/// Who looks down at the origin.
fn above() -> Eye {
    Eye {
        at: DVec3::new(1.0, 2.2, 3.2),
        target: DVec3::ZERO,
        up: DVec3::Y,
        lens: Lens::Fov(45.0),
        size: SIZE,
    }
}

/// A ball throws no shadow on the side that light comes to.
fn own(draw: Draw) -> Found {
    let eye = above();
    let lamp = DVec3::new(0.4, 2.6, 0.9);
    for kind in ["point_light(", "sphere_light(radius = 0.1, "] {
        let text = format!(
            "show(sphere(1))\n{kind}position = (0.4, 2.6, 0.9), shadow = advected(resolution = 64))"
        );
        let film = draw(&scene(&text, &eye));
        compare(&film, &eye, Plane::Shadow, 0.01, |x, y| {
            let (o, d) = eye.ray(x, y);
            let p = o + d * ball((o, d), DVec3::ZERO, 1.0)?;
            ((lamp - p).normalize().dot(p) > 0.3).then_some(DVec3::ONE)
        })?;
    }
    Ok(())
}

/// Nothing stands between a floor and a lamp, near or far, within the volume or beyond it.
fn bare(draw: Draw) -> Found {
    let eye = above();
    for light in [
        "point_light(position = (0.3, 1, -0.2), shadow = advected(resolution = 32))",
        "sun(direction = (2, -1, 0.3), shadow = advected(resolution = 32, spread = 1))",
    ] {
        let text = format!("show(plane())\nshow(box(1).move(y = -2))\n{light}");
        let film = draw(&scene(&text, &eye));
        compare(&film, &eye, Plane::Shadow, 1e-6, |x, y| {
            floor(eye.ray(x, y)).map(|_| DVec3::ONE)
        })?;
    }
    Ok(())
}
