//! From samples to pixels and from pixels to files: filters, exposure, the sRGB curve.

use crate::known::{Check, Draw, Eye, Found, compare, light, rgb, with};
use crate::on;
use glam::DVec3;
use zeroset::output::format::Metadata;
use zeroset::output::format::png::{Depth, write};
use zeroset::output::picture::Picture;
use zeroset::scene::film::Plane;
use zeroset::trace::CpuRenderer;

pub const CHECKS: [Check; 3] = [
    Check {
        name: "the box filter",
        run: |draw| edge(draw, "box", |x| if x.abs() <= 0.5 { 1.0 } else { 0.0 }),
    },
    Check {
        name: "the tent filter",
        run: |draw| edge(draw, "tent", |x| (1.0 - x.abs()).max(0.0)),
    },
    Check {
        name: "Mitchell's filter",
        run: |draw| edge(draw, "mitchell", mitchell),
    },
];

/// Mitchell and Netravali 1988, equation 8, with B = C = 1/3, term by term.
fn mitchell(x: f64) -> f64 {
    let (b, c, x) = (1.0 / 3.0, 1.0 / 3.0, x.abs());
    let sum = if x < 1.0 {
        (12.0 - 9.0 * b - 6.0 * c) * x.powi(3)
            + (-18.0 + 12.0 * b + 6.0 * c) * x.powi(2)
            + (6.0 - 2.0 * b)
    } else if x < 2.0 {
        (-b - 6.0 * c) * x.powi(3)
            + (6.0 * b + 30.0 * c) * x.powi(2)
            + (-12.0 * b - 48.0 * c) * x
            + (8.0 * b + 24.0 * c)
    } else {
        0.0
    };
    sum / 6.0
}

/// A pixel beside a straight border between two colours holds as much of each as lies under its filter.
fn edge(draw: Draw, name: &str, filter: fn(f64) -> f64) -> Found {
    // the integral of the filter up to x, in steps; the last and first half steps are within the tolerance
    let under = |x: f64| {
        const STEP: f64 = 1e-3;
        let steps = ((x + 2.0) / STEP).clamp(0.0, 4000.0) as u32;
        (0..steps)
            .map(|k| STEP * filter(-2.0 + STEP * (f64::from(k) + 0.5)))
            .sum::<f64>()
    };
    // two grey colours: filters with negative parts never reach below black
    let (one, other) = ([0.4; 3], [0.8; 3]);
    for (axis, name_of) in [(DVec3::X, "x"), (DVec3::Y, "y")] {
        // the border lies three tenths of a pixel beside the middle of the picture
        let size = [14, 12];
        let pixel = 0.1;
        let eye =
            Eye::straight(DVec3::Z, DVec3::Y, axis * (0.3 * pixel), pixel * 12.0).with_size(size);
        let colours = format!(
            "{}, {}, direction = \"{name_of}\", size = 9",
            rgb(one),
            rgb(other)
        );
        let text = format!(
            "show(box(8), material(color = stripes({colours}), specular = 0, roughness = 1))
sun(direction = (0, 0, -1), shadow = none())\nsky(color = \"black\")"
        );
        let choices = format!("ao = none(), aa = supersample(256, \"{name}\")");
        let film = draw(&with(&text, &eye, &choices));
        let right = |x: f64, y: f64| {
            let [width, height] = size.map(f64::from);
            // beside the border of the picture a filter has less to weigh
            if x < 2.0 || y < 2.0 || x > width - 2.0 || y > height - 2.0 {
                return None;
            }
            let share = under(eye.ray(x, y).0.dot(axis) / pixel);
            Some(light(one).lerp(light(other), share))
        };
        compare(&film, &eye, Plane::Colour, 0.006, right)
            .map_err(|e| format!("along {name_of}: {e}"))?;
    }
    Ok(())
}

/// What glows in a colour has that colour in the file, digit by digit; a stop brighter is twice the light.
#[test]
fn a_colour_reaches_the_file() {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 1.0).with_size([24, 20]);
    let colour = [0xbc, 0x4a, 0x03].map(|c| f64::from(c) / 255.0);
    let text = format!(
        "show(box(4), material(color = \"black\", specular = 0, roughness = 1, emission = {}))",
        rgb(colour)
    );
    let renderer = CpuRenderer::new(None).unwrap();
    for (exposure, aa) in [(0, "none()"), (0, "supersample(4)"), (-1, "none()")] {
        let scene = with(
            &text,
            &eye,
            &format!("ao = none(), aa = {aa}, exposure = {exposure}, tone = \"standard\""),
        );
        let film = on(&renderer, &scene);
        let picture = Picture::develop(&film, scene.settings().view_transform());
        for depth in [Depth::Eight, Depth::Sixteen] {
            let mut bytes = Vec::new();
            write(&mut bytes, &picture, depth, &Metadata::new("known")).unwrap();
            let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
                .read_info()
                .unwrap();
            let mut data = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut data).unwrap();
            let linear = light(colour) * 2.0f64.powi(exposure);
            // IEC 61966-2-1
            let coded = linear.to_array().map(|x| {
                if x <= 0.003_130_8 {
                    12.92 * x
                } else {
                    1.055 * x.powf(1.0 / 2.4) - 0.055
                }
            });
            let (levels, width) = match depth {
                Depth::Eight => (255.0, 1),
                Depth::Sixteen => (65_535.0, 2),
            };
            for (k, sample) in data.chunks_exact(width).enumerate() {
                let found = sample.iter().fold(0u32, |a, b| 256 * a + u32::from(*b));
                let right = coded[k % 3] * levels;
                // a value between two levels is dithered to one of them
                assert!(
                    (f64::from(found) - right).abs() < 1.01,
                    "{depth:?} at {exposure}: {found} instead of {right}"
                );
                if depth == Depth::Eight && exposure == 0 {
                    assert_eq!(found, (colour[k % 3] * 255.0).round() as u32);
                }
            }
        }
    }
}

/// The filter's published points: 8/9 in the middle, 1/18 a pixel beside it, then below zero.
#[test]
fn mitchell_has_its_points() {
    for (x, y) in [
        (0.0, 8.0 / 9.0),
        (1.0, 1.0 / 18.0),
        (-1.5, -5.0 / 144.0),
        (2.0, 0.0),
    ] {
        assert!((mitchell(x) - y).abs() < 1e-12, "{x}: {}", mitchell(x));
    }
}
