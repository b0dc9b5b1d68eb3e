//! Lights with an extent: what they send to a floor by closed forms, and one light found in three ways.

use crate::known::{Check, Draw, Eye, Found, Lens, floor, loaded, value};
use glam::DVec3;
use zeroset::scene::film::Plane;
use zeroset::scene::render::{Renderer, Silent};
use zeroset::trace::CpuRenderer;

pub const CHECKS: [Check; 3] = [
    Check {
        name: "a sphere of light over a floor",
        run: |draw| {
            over_floor(
                draw,
                "sphere_light(position = (0.3, 1.5, -0.2), radius = 0.9",
                "whitted()",
                |p| {
                    // what is all above the horizon sends as much as its middle would (Lambert 1760)
                    let way = DVec3::new(0.3, 1.5, -0.2) - p;
                    way.normalize().y / way.length_squared()
                },
            )
        },
    },
    Check {
        name: "a disc of light over a floor",
        run: |draw| {
            over_floor(
                draw,
                "disc_light(position = (0, 1.2, 0), radius = 1.1",
                "whitted()",
                |p| {
                    // the form factor of a disc that lies parallel (Howell, configuration B-13)
                    let (radius, height) = (1.1f64, 1.2f64);
                    let aside = p.with_y(0.0).length().max(1e-6);
                    let (h, r) = (height / aside, radius / aside);
                    let z = 1.0 + h * h + r * r;
                    let factor = 0.5 * (1.0 - (z - 2.0 * r * r) / (z * z - 4.0 * r * r).sqrt());
                    factor / (radius * radius)
                },
            )
        },
    },
    Check {
        name: "a rectangle of light over a floor",
        run: |draw| {
            let text = "rectangle_light(position = (0, 1, 0), size = (2.4, 1), up = \"z\"";
            over_floor(draw, text, "whitted()", |p| {
                // the form factor of a rectangle that lies parallel, over a corner of it (Howell, configuration B-3)
                let corner = |x: f64, z: f64| {
                    let (a, b) = ((1.0 + x * x).sqrt(), (1.0 + z * z).sqrt());
                    (x / a * (z / a).atan() + z / b * (x / b).atan()) / std::f64::consts::TAU
                };
                let (x, z) = (p.x, p.z);
                let factor = corner(1.2 - x, 0.5 - z)
                    + corner(1.2 + x, 0.5 - z)
                    + corner(1.2 - x, 0.5 + z)
                    + corner(1.2 + x, 0.5 + z);
                factor * std::f64::consts::PI / 2.4
            })
        },
    },
];

/// As the first, found by looking for it and by rays that the floor scatters, both together.
pub fn in_paths(draw: Draw) -> Found {
    let text = "sphere_light(position = (0.3, 1.5, -0.2), radius = 0.9";
    over_floor(draw, text, "path(depth = 2)", |p| {
        let way = DVec3::new(0.3, 1.5, -0.2) - p;
        way.normalize().y / way.length_squared()
    })
}

/// What a white floor shows under a lamp of strength 1, in every way of light and light model.
fn over_floor(draw: Draw, lamp: &str, integrator: &str, right: fn(DVec3) -> f64) -> Found {
    let eye = Eye {
        at: DVec3::new(0.0, 0.55, 2.6),
        target: DVec3::new(0.0, 0.0, 0.3),
        up: DVec3::Y,
        lens: Lens::Fov(40.0),
        size: [24, 18],
    };
    let text = format!(
        "sky(color = \"black\")\nshow(plane(), material(color = \"white\", roughness = 1, specular = 0))\n{lamp}, strength = 1, color = (1, 0.5, 0.25))\n{}\
         render(footprint = 0.01, ao = none(), aa = supersample(256, \"box\"), integrator = {integrator})",
        eye.line()
    );
    let film = draw(&loaded(&text, eye.size, None));
    let light = DVec3::from([1.0, 0.5, 0.25].map(crate::known::linear));
    let (mut worst, mut off, mut all, mut count) = (0.0f64, 0.0, 0.0, 0);
    for (x, y, u, v) in eye.pixels() {
        // the mean over the pixel: light falls off fast
        let fine = 6;
        let inner = |k: i32| (f64::from(k) + 0.5) / f64::from(fine) - 0.5;
        let places = (0..fine * fine).map(|k| (u + inner(k % fine), v + inner(k / fine)));
        let shown = places.map(|(u, v)| {
            let p = floor(eye.ray(u, v)).filter(|p| p.length() < 4.0)?;
            Some(right(p) / f64::from(fine * fine))
        });
        let Some(mean) = shown.sum::<Option<f64>>() else {
            continue;
        };
        let (found, right) = (value(&film, Plane::Colour, x, y), light * mean);
        worst = worst.max((found - right).abs().max_element() / right.x.max(0.05));
        off += (found - right).x;
        all += right.x;
        count += 1;
    }
    if count > 100 && worst < 0.1 && (off / all).abs() < 0.01 {
        return Ok(());
    }
    Err(format!(
        "{count} pixels, one is off by {worst:.3}, all by {:.4}",
        off / all
    ))
}

/// The mean light of a picture, and the standard error of it over seeds.
fn measured(renderer: &dyn Renderer, text: &str) -> (f64, f64) {
    let seeds = 12;
    let means: Vec<f64> = (0..seeds)
        .map(|seed| {
            let text = text.replace("SEED", &seed.to_string());
            let scene = loaded(&text, [24, 16], None);
            let film = renderer.render(&scene, &Silent).expect("a picture").film;
            let colours = film.plane(Plane::Colour);
            colours.iter().map(|x| f64::from(*x)).sum::<f64>() / colours.len() as f64
        })
        .collect();
    let n = f64::from(seeds);
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// One lamp found by looking for it, by rays that surfaces scatter, and by both: the same light. The second is a ball that glows.
fn found_in_three_ways(renderer: &dyn Renderer) {
    for material in [
        "color = \"white\", roughness = 1, specular = 0",
        "color = \"#cc8844\", roughness = 0.45, metallic = 0.6",
        "color = \"#88aacc\", roughness = 0.3, specular = 0.5",
    ] {
        let scene = |lamp: &str| {
            format!(
                "sky(color = \"black\")\nshow(plane(), material({material}))\n{lamp}\n\
                 camera(eye = (0, 1.2, 3), target = (0, 0, 0.2), fov = 22)\n\
                 render(footprint = 0.01, ao = none(), aa = supersample(64, \"box\"), integrator = path(depth = 2), seed = SEED)"
            )
        };
        // a radiance of 6 of a ball of radius 0.5
        let lamp = "sphere_light(position = (0.2, 1.1, -1.2), radius = 0.5, strength = 1.5";
        let both = measured(renderer, &scene(&format!("{lamp})")));
        let looked = measured(renderer, &scene(&format!("{lamp}, visible = False)")));
        let glowing = "sun(strength = 0)\nshow(sphere(0.5).move(0.2, 1.1, -1.2), \
                       material(color = \"black\", specular = 0, emission = \"white\", strength = 6))";
        let scattered = measured(renderer, &scene(glowing));
        for (name, other) in [("looked for", looked), ("scattered", scattered)] {
            let off = (both.0 - other.0).abs() / both.1.hypot(other.1);
            assert!(
                off < 4.0 && both.0 > 0.01,
                "{material}: {both:?} with both, {other:?} {name}: {off:.1} standard errors"
            );
        }
        // and both together know it better than rays alone
        assert!(both.1 < scattered.1, "{both:?} {scattered:?}");
    }
}

#[test]
fn lamps_are_found_in_three_ways() {
    found_in_three_ways(&CpuRenderer::new(None).unwrap());
}

#[test]
fn lamps_are_found_in_three_ways_on_the_gpu() {
    if let Some(gpu) = zeroset::gpu::testing::renderer("lamps on the GPU") {
        found_in_three_ways(&gpu);
    }
}

/// A smooth mirror shows a lamp as bright as the eye sees it, in each way of light.
#[test]
fn mirrors_show_lamps_as_they_are() {
    let renderer = CpuRenderer::new(None).unwrap();
    for integrator in ["whitted()", "path(depth = 3)"] {
        let text = format!(
            "sky(color = \"black\")\nshow(plane(), material(color = \"white\", metallic = 1, roughness = 0))\n\
             rectangle_light(position = (0, 2, -2), target = (0, 0, 0), size = 1.2, strength = 2)\n\
             camera(eye = (0, 2, 2), target = (0, 0, 0), fov = 20)\n\
             render(ao = none(), aa = supersample(4, \"box\"), integrator = {integrator})"
        );
        let film = renderer
            .render(&loaded(&text, [16, 16], None), &Silent)
            .expect("a picture")
            .film;
        let right = 2.0 * std::f64::consts::PI / 1.44;
        let found = value(&film, Plane::Colour, 8, 8).x;
        assert!(
            (found / right - 1.0).abs() < 0.02,
            "{integrator}: {found} instead of {right}"
        );
    }
}
