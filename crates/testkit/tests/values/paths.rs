//! Path tracing, where mathematics knows what comes out. Every pixel is noisy: what is compared is the mean over many.

use crate::known::{Check, Draw, Eye, Found, Lens, ball, floor, light, rgb, value, with};
use glam::DVec3;
use zeroset::scene::film::{Film, Plane};

pub const CHECKS: [Check; 10] = [
    Check {
        name: "a lamp that rays meet",
        run: crate::lamps::in_paths,
    },
    Check {
        name: "a white world",
        run: furnace,
    },
    Check {
        name: "a closed room that glows",
        run: room,
    },
    Check {
        name: "a lamp over a floor",
        run: lamp,
    },
    Check {
        name: "a disc over a floor",
        run: disc,
    },
    Check {
        name: "the penumbra of a wide sun",
        run: penumbra,
    },
    Check {
        name: "light between two walls",
        run: corner,
    },
    Check {
        name: "the sun through a pane",
        run: pane,
    },
    Check {
        name: "a ball of glass, one way of many",
        run: glass,
    },
    Check {
        name: "clamped light",
        run: clamped,
    },
];

/// Compares the mean of a plane over all pixels of which it is known what is right there.
fn mean(
    film: &Film,
    eye: &Eye,
    tolerance: f64,
    right: impl Fn(f64, f64) -> Option<DVec3>,
) -> Found {
    let (mut found, mut wanted, mut count) = (DVec3::ZERO, DVec3::ZERO, 0);
    for (x, y, u, v) in eye.pixels() {
        let Some(right) = right(u, v) else {
            continue;
        };
        let pixel = value(film, Plane::Colour, x, y);
        if !pixel.is_finite() {
            return Err(format!("{pixel} at ({x}, {y})"));
        }
        found += pixel;
        wanted += right;
        count += 1;
    }
    let n = f64::from(count);
    let (found, wanted) = (found / n, wanted / n);
    let off = (found - wanted).abs() / wanted.abs().max(DVec3::splat(0.02));
    // what is no number is not close
    let is_close = off.max_element() < tolerance;
    if count < 50 || !is_close {
        return Err(format!("{found} instead of {wanted} in {count} pixels"));
    }
    Ok(())
}

/// What the sampled pictures are made with.
fn choices(samples: u32, path: &str) -> String {
    format!("aa = supersample({samples}, \"box\"), ao = quilez(), integrator = {path}")
}

fn at(eye: [f64; 3], target: [f64; 3], fov: f64) -> Eye {
    Eye {
        at: DVec3::from(eye),
        target: DVec3::from(target),
        up: DVec3::Y,
        lens: Lens::Fov(fov),
        size: [24, 20],
    }
}

/// What loses no light is not seen before a sky of one colour.
fn furnace(draw: Draw) -> Found {
    let eye = at([0.0, 0.0, 4.0], [0.0; 3], 26.0);
    for (material, tolerance) in [
        ("roughness = 1, specular = 0", 0.01),
        ("roughness = 0.5", 0.02),
        ("roughness = 0.15, specular = 1", 0.02),
        ("metallic = 1, roughness = 0.1", 0.01),
        ("metallic = 1, roughness = 0.6", 0.02),
        ("transmission = 1, roughness = 0", 0.01),
        ("transmission = 0.5, roughness = 0.1", 0.03),
    ] {
        let text = format!(
            "show(sphere(1), material(color = \"white\", {material}))\nsun(strength = 0)\nsky(color = rgb(0.5, 0.6, 0.7), ambient = 1)"
        );
        let film = draw(&with(&text, &eye, &choices(64, "path(200)")));
        let right = light([0.5, 0.6, 0.7]);
        mean(&film, &eye, tolerance, |x, y| {
            ball(eye.ray(x, y), DVec3::ZERO, 1.0).map(|_| right)
        })
        .map_err(|e| format!("{material}: {e}"))?;
    }
    Ok(())
}

/// In a closed room whose walls glow and reflect, the light is what they glow with over what they do not reflect.
fn room(draw: Draw) -> Found {
    let eye = at([0.3, 0.2, 0.4], [1.0, 0.1, -0.3], 60.0);
    let text = format!(
        "show(box(6) - box(4), material(color = {}, roughness = 1, specular = 0, emission = {}))\nsun(strength = 0)",
        rgb([0.7, 0.5, 0.3]),
        rgb([0.5, 0.5, 0.5])
    );
    let film = draw(&with(&text, &eye, &choices(64, "path(200)")));
    let glow = light([0.5, 0.5, 0.5]);
    let right = glow / (DVec3::ONE - light([0.7, 0.5, 0.3]));
    mean(&film, &eye, 0.015, |_, _| Some(right))?;
    // a way of one surface sees its own light alone
    let film = draw(&with(&text, &eye, &choices(4, "path(1)")));
    mean(&film, &eye, 1e-3, |_, _| Some(glow))?;
    // and one of two that of the next, too
    let film = draw(&with(&text, &eye, &choices(16, "path(2)")));
    mean(&film, &eye, 5e-3, |_, _| {
        Some(glow + glow * light([0.7, 0.5, 0.3]))
    })
}

/// Inverse squares and the cosine, of a lamp that is a point.
fn lamp(draw: Draw) -> Found {
    let eye = at([0.0, 4.0, 0.01], [0.0; 3], 40.0);
    let text = "show(plane(), material(color = rgb(0.8, 0.6, 0.3), roughness = 1, specular = 0))
point_light((0.3, 1.5, 0.2), color = rgb(1, 0.8, 0.6), strength = 2, shadow = hard())
sky(color = \"black\")";
    let film = draw(&with(text, &eye, &choices(4, "path()")));
    let right = |x, y| {
        let p = floor(eye.ray(x, y))?;
        let to = DVec3::new(0.3, 1.5, 0.2) - p;
        let power = 2.0 * to.normalize().y / to.length_squared();
        Some(light([0.8, 0.6, 0.3]) * light([1.0, 0.8, 0.6]) * power)
    };
    mean(&film, &eye, 4e-3, right)
}

/// Below the middle of a black disc in a white sky the floor sees what the disc leaves: by the cosine law 1 - r^2 / (r^2 + h^2).
fn disc(draw: Draw) -> Found {
    // looks at the floor from under the disc
    let eye = Eye {
        at: DVec3::new(0.0, 0.2, 0.0),
        target: DVec3::ZERO,
        up: DVec3::NEG_Z,
        lens: Lens::Height(0.06),
        size: [12, 10],
    };
    let (r, h) = (1.0, 0.8);
    let text = format!(
        "show(plane(), material(color = rgb(0.8, 0.8, 0.8), roughness = 1, specular = 0))
show(cylinder({r}, 0.02).move(y = {}), material(color = \"black\", roughness = 1, specular = 0))
sun(strength = 0)\nsky(color = \"white\", ambient = 1)",
        h + 0.01
    );
    let film = draw(&with(&text, &eye, &choices(256, "path()")));
    let right = light([0.8, 0.8, 0.8]) * (1.0 - r * r / (r * r + h * h));
    mean(&film, &eye, 0.015, |_, _| Some(right))
}

/// Behind the edge of a long wall a sun that is a disc is seen in part: half of it where the edge covers its middle.
fn penumbra(draw: Draw) -> Found {
    let text = "show(plane(), material(color = \"white\", roughness = 1, specular = 0))
show(box((40, 2, 2)).move((0, 1, -1)), material(color = \"black\", roughness = 1, specular = 0))
sun(direction = (0, -1, 1), strength = 0.6, shadow = soft(5))
sky(color = \"black\")";
    // the shadow of the edge y = 2, z = 0 ends in its middle at z = 2
    let eye = Eye {
        at: DVec3::new(0.0, 6.0, 2.0),
        target: DVec3::new(0.0, 0.0, 2.0),
        up: DVec3::NEG_Z,
        lens: Lens::Height(0.04),
        size: [12, 10],
    };
    let film = draw(&with(text, &eye, &choices(256, "path()")));
    // the half that is seen stands higher: of a cone of 1 to 5 the mean cosine is a little more
    let half = (0.6 * std::f64::consts::FRAC_1_SQRT_2) * 0.5;
    let higher =
        0.6 * std::f64::consts::FRAC_1_SQRT_2 * 0.5 * (4.0 / (3.0 * std::f64::consts::PI)) / 5.0;
    mean(&film, &eye, 0.03, |_, _| Some(DVec3::splat(half + higher)))
}

/// Between two large walls at right angles of which one glows, the other gets half of the light of a wall all around it near the corner,
/// and less far away: at a distance d from the edge of a wall of height a, 1/2 (1 - d / sqrt(d^2 + a^2)).
fn corner(draw: Draw) -> Found {
    let (a, d) = (2.0, 1.0);
    let text = format!(
        "show(plane(), material(color = \"white\", roughness = 1, specular = 0))
show(box((400, {a}, 1)).move((0, {}, -0.5)), material(color = \"black\", roughness = 1, specular = 0, emission = \"white\"))
sun(strength = 0)\nsky(color = \"black\")",
        0.5 * a
    );
    let eye = Eye {
        at: DVec3::new(0.0, 6.0, d),
        target: DVec3::new(0.0, 0.0, d),
        up: DVec3::NEG_Z,
        lens: Lens::Height(0.04),
        size: [12, 10],
    };
    let film = draw(&with(&text, &eye, &choices(256, "path()")));
    let right = 0.5 * (1.0 - d / (d * d + a * a).sqrt());
    mean(&film, &eye, 0.02, |_, _| Some(DVec3::splat(right)))
}

/// A wide sun shines through a pane of glass that does not bend it, and is lost by nothing but the tint; without the pane the same.
fn pane(draw: Draw) -> Found {
    let floor_and_sun = "show(plane(), material(color = \"white\", roughness = 1, specular = 0))
sun(direction = (0.2, -1, 0.1), strength = 0.5, shadow = soft(1.5))
sky(color = \"black\")\n";
    let pane = "show(box((60, 0.1, 60)).move(y = 3), material(color = \"white\", transmission = 1, ior = 1, specular = 0))\n";
    let eye = Eye {
        at: DVec3::new(0.0, 1.0, 0.0),
        target: DVec3::ZERO,
        up: DVec3::NEG_Z,
        lens: Lens::Height(0.5),
        size: [12, 10],
    };
    let open = draw(&with(floor_and_sun, &eye, &choices(64, "path()")));
    let right = value(&open, Plane::Colour, 6, 5);
    mean(&open, &eye, 0.02, |_, _| Some(right))?;
    let through = draw(&with(
        &format!("{floor_and_sun}{pane}"),
        &eye,
        &choices(512, "path()"),
    ));
    mean(&through, &eye, 0.04, |_, _| Some(right))
}

/// The whole picture of a ball of glass is that of the method that follows all ways.
fn glass(draw: Draw) -> Found {
    let eye = at([0.4, 0.8, 4.0], [0.0; 3], 32.0);
    let text = "show(sphere(1), material(transmission = 1, color = \"white\", ior = 1.5, roughness = 0, tint = rgb(0.9, 0.7, 0.5)))
sun(strength = 0)
sky(top = rgb(0.1, 0.3, 0.9), horizon = rgb(0.9, 0.8, 0.4), bottom = rgb(0.5, 0.1, 0.2), ambient = 1)";
    let one = draw(&with(text, &eye, &choices(256, "path(20)")));
    let all = draw(&with(text, &eye, &choices(256, "whitted(2, 12)")));
    // regions: left, right, upper and lower half
    let [width, height] = eye.size.map(f64::from);
    for (name, part) in [
        (
            "left",
            &(|x, _| x < 0.5 * width) as &dyn Fn(f64, f64) -> bool,
        ),
        ("right", &|x, _| x > 0.5 * width),
        ("above", &|_, y| y < 0.5 * height),
        ("below", &|_, y| y > 0.5 * height),
    ] {
        mean(&one, &eye, 0.02, |x, y| {
            part(x, y).then(|| value(&all, Plane::Colour, x as usize, y as usize))
        })
        .map_err(|e| format!("{name}: {e}"))?;
    }
    Ok(())
}

/// No way brings more than is allowed, in which all three colours keep their ratios.
fn clamped(draw: Draw) -> Found {
    let eye = at([0.3, 0.2, 0.4], [1.0, 0.1, -0.3], 60.0);
    let text = "show(box(6) - box(4), material(color = rgb(0.9, 0.9, 0.9), roughness = 1, specular = 0, emission = rgb(1, 0.5, 0.25), strength = 4))
sun(strength = 0)";
    let film = draw(&with(text, &eye, &choices(4, "path(2, 0.5)")));
    let glow = light([1.0, 0.5, 0.25]);
    // its own light, and of what the other walls send at most 0.5
    mean(&film, &eye, 1e-3, |_, _| Some(4.0 * glow + 0.5 * glow))
}
