//! Small mirrors, what mirrors show, and what light does on its way through clear bodies, by textbooks.

use crate::known::{
    Check, Draw, Eye, Found, Lens, SIZE, ball, compare, floor, light, rgb, scene, with,
};
use crate::sky::{BOTTOM, HORIZON, TOP, along, line};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use zeroset::scene::film::Plane;

pub const CHECKS: [Check; 5] = [
    Check {
        name: "highlights of small mirrors",
        run: highlights,
    },
    Check {
        name: "what a mirror shows",
        run: mirror,
    },
    Check {
        name: "a ball of glass",
        run: glass,
    },
    Check {
        name: "what a tint leaves",
        run: tint,
    },
    Check {
        name: "a clear block on a table",
        run: block,
    },
];

const ALBEDO: [f64; 3] = [0.8, 0.6, 0.3];

/// GGX, what mirrors hide of each other (correlated by height), and the share of light that comes back after one reflection.
struct Mirrors {
    alpha: f64,
}

impl Mirrors {
    fn lambda(&self, cosine: f64) -> f64 {
        let tan2 = 1.0 / (cosine * cosine) - 1.0;
        0.5 * ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0)
    }

    fn density(&self, cosine: f64) -> f64 {
        let c2 = cosine * cosine;
        let a2 = self.alpha * self.alpha;
        a2 / (PI * (c2 * (a2 - 1.0) + 1.0).powi(2))
    }

    /// The reflectance of mirrors that lose nothing, times the cosine of the light.
    fn reflected(&self, n: DVec3, eye: DVec3, to: DVec3) -> f64 {
        let (v, l) = (n.dot(eye), n.dot(to));
        if l <= 0.0 || v <= 0.0 {
            return 0.0;
        }
        let half = (eye + to).normalize();
        let seen = 1.0 / (1.0 + self.lambda(v) + self.lambda(l));
        self.density(n.dot(half)) * seen / (4.0 * v)
    }

    /// The integral of that over all lights.
    fn single(&self, cosine: f64) -> f64 {
        let eye = DVec3::new((1.0 - cosine * cosine).sqrt(), cosine, 0.0);
        let (rings, turns) = (200, 200);
        let mut sum = 0.0;
        for i in 0..rings {
            // evenly over the solid angle
            let y = (f64::from(i) + 0.5) / f64::from(rings);
            for k in 0..turns {
                let phi = (f64::from(k) + 0.5) / f64::from(turns) * TAU;
                let r = (1.0 - y * y).sqrt();
                let to = DVec3::new(r * phi.cos(), y, r * phi.sin());
                sum += self.reflected(DVec3::Y, eye, to);
            }
        }
        sum * TAU / f64::from(rings * turns)
    }
}

/// A metal floor under a sun and a black sky.
fn highlights(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(0.0, 3.0, 6.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        lens: Lens::Fov(40.0),
        size: SIZE,
    };
    for roughness in [0.45, 0.8] {
        let text = format!(
            "show(plane(), material(color = {}, metallic = 1, roughness = {roughness}))
sun(direction = (0.3, -1, -1.4), strength = 0.7, shadow = none())
sky(color = \"black\")",
            rgb(ALBEDO)
        );
        let film = draw(&scene(&text, &eye));
        let mirrors = Mirrors {
            alpha: roughness * roughness,
        };
        let to = -DVec3::new(0.3, -1.0, -1.4).normalize();
        let singles: Vec<f64> = (0..=100)
            .map(|i| mirrors.single((f64::from(i) / 100.0).max(0.02)))
            .collect();
        let right = |x, y| {
            let ray = eye.ray(x, y);
            floor(ray)?;
            let v = -ray.1;
            let half = (v + to).normalize();
            let straight = light(ALBEDO);
            let fresnel = straight.lerp(DVec3::ONE, (1.0 - half.dot(to)).powi(5));
            let once = mirrors.reflected(DVec3::Y, v, to);
            let place = (v.y * 100.0) as usize;
            let single =
                singles[place] + (singles[place + 1] - singles[place]) * (v.y * 100.0).fract();
            let again = DVec3::ONE + straight * (1.0 / single - 1.0);
            // a light of strength 1 makes a white surface white that faces it
            Some(PI * 0.7 * once * fresnel * again)
        };
        compare(&film, &eye, Plane::Colour, 5e-3, right)
            .map_err(|e| format!("roughness {roughness}: {e}"))?;
    }
    Ok(())
}

/// A ball of silver over a glowing floor with an end, under a sky: whatever the mirrored ray meets.
fn mirror(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(0.5, 2.0, 5.0),
        target: DVec3::new(0.0, 1.0, 0.0),
        up: DVec3::Y,
        lens: Lens::Fov(28.0),
        size: SIZE,
    };
    let text = format!(
        "show(sphere(1).move(y = 1.2), material(color = \"white\", metallic = 1, roughness = 0))
show(box((6, 0.2, 6)).move(y = -0.1), material(color = \"black\", specular = 0, roughness = 1, emission = {}))
sun(strength = 0)\n{}",
        rgb(ALBEDO),
        line(0.0)
    );
    let film = draw(&scene(&text, &eye));
    let right = |x, y| {
        let ray = eye.ray(x, y);
        let t = ball(ray, DVec3::Y * 1.2, 1.0)?;
        let p = ray.0 + ray.1 * t;
        let n = p - DVec3::Y * 1.2;
        let d = ray.1 - n * (2.0 * n.dot(ray.1));
        if -n.dot(ray.1) < 0.1 {
            return None;
        }
        let Some(met) = floor((p, d)) else {
            // not over the edge of the box
            return Some(along(d.y));
        };
        let inside = 3.0 - met.x.abs().max(met.z.abs());
        if inside.abs() < 0.3 || inside < 0.0 {
            return None;
        }
        Some(light(ALBEDO))
    };
    compare(&film, &eye, Plane::Colour, 0.012, right)
}

/// Snell's law and Fresnel's equations: what is reflected, and the sine behind the border over the sine before it.
fn border(cosine: f64, n1: f64, n2: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).sqrt() * n1 / n2;
    if sine >= 1.0 {
        return 1.0;
    }
    let inner = (1.0 - sine * sine).sqrt();
    let across = (n1 * cosine - n2 * inner) / (n1 * cosine + n2 * inner);
    let along = (n1 * inner - n2 * cosine) / (n1 * inner + n2 * cosine);
    0.5 * (across * across + along * along)
}

/// A ball of glass before the sky: the light is reflected, or goes in, and is reflected inside again and again at the same angle.
fn glass(draw: Draw) -> Found {
    const IOR: f64 = 1.5;
    let eye = Eye {
        at: DVec3::new(0.4, 0.8, 4.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        lens: Lens::Fov(32.0),
        size: SIZE,
    };
    let text = format!(
        "show(sphere(1), material(transmission = 1, color = \"white\", ior = {IOR}, roughness = 0.6))
sun(strength = 0)\n{}",
        line(0.0)
    );
    let choices = "aa = none(), ao = none(), integrator = whitted(2, 12)";
    let film = draw(&with(&text, &eye, choices));
    let right = |x, y| {
        let ray = eye.ray(x, y);
        let n = ray.0 + ray.1 * ball(ray, DVec3::ZERO, 1.0)?;
        let cosine = -n.dot(ray.1);
        if cosine < 0.2 {
            return None;
        }
        let back = border(cosine, 1.0, IOR);
        let sky = |d: DVec3| along(d.y);
        let mut sum = back * sky(ray.1 + n * (2.0 * cosine));
        // in the plane of the ray and the middle of the ball: every chord turns by the same angle
        let tangent = (ray.1 + n * cosine).normalize_or_zero();
        let outer = cosine.acos();
        let inner = (outer.sin() / IOR).asin();
        let within = border(inner.cos(), IOR, 1.0);
        let mut weight = 1.0 - back;
        // the angle of the place on the circle, from the normal where the ray comes in
        for k in 1..=11 {
            let turned = f64::from(k) * (PI - 2.0 * inner);
            let place = n * turned.cos() + tangent * turned.sin();
            let side = -n * turned.sin() + tangent * turned.cos();
            let out = place * outer.cos() + side * outer.sin();
            sum += weight * (1.0 - within) * sky(out.normalize());
            weight *= within;
        }
        Some(sum)
    };
    compare(&film, &eye, Plane::Colour, 0.02, right)
}

/// A clear block that does not bend rays, before a sky of one colour: Beer's law.
fn tint(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 3.0);
    let text = format!(
        "show(box((4, 4, 0.6)), material(transmission = 1, color = \"white\", ior = 1, tint = {}, tint_depth = 0.5))
sun(strength = 0)\nsky(color = {}, ambient = 0)",
        rgb(ALBEDO),
        rgb(TOP)
    );
    let film = draw(&scene(&text, &eye));
    let right = light(TOP) * light(ALBEDO).map(|c| c.powf(0.6 / 0.5));
    compare(&film, &eye, Plane::Colour, 2e-3, |_, _| Some(right))
}

/// A clear block that stands on a glowing table, sunk into it or on its surface: what is seen through it is the table.
fn block(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(0.0, 6.0, 0.01),
        ..Eye::straight(DVec3::Y, DVec3::NEG_Z, DVec3::ZERO, 1.2)
    };
    for sunk in [0.0, 0.3] {
        let text = format!(
            "show(box(2).move(y = {}), material(transmission = 1, color = \"white\", ior = 1, tint = {}))
show(plane(), material(color = \"black\", specular = 0, roughness = 1, emission = {}))
sun(strength = 0)\nsky(top = {}, bottom = {}, ambient = 0)",
            1.0 - sunk,
            rgb(ALBEDO),
            rgb(HORIZON),
            rgb(TOP),
            rgb(BOTTOM)
        );
        let film = draw(&scene(&text, &eye));
        let right = light(HORIZON) * light(ALBEDO).map(|c| c.powf(2.0 - sunk));
        compare(&film, &eye, Plane::Colour, 3e-3, |_, _| Some(right))
            .map_err(|e| format!("sunk by {sunk}: {e}"))?;
    }
    Ok(())
}
