//! Images on surfaces: not mirrored, upright, in linear light, whatever kind of file they come from.

use crate::known::{Check, Draw, Eye, FACES, Found, SIZE, ball, compare, light, linear, loaded};
use glam::DVec3;
use png::{BitDepth, ColorType};
use std::path::Path;
use zeroset::scene::film::Plane;
use zeroset::scene::material::Pattern;
use zeroset::scene::scene::Scene;

pub const CHECKS: [Check; 4] = [
    Check {
        name: "an image on six faces",
        run: faces,
    },
    Check {
        name: "an image on a ball",
        run: round,
    },
    Check {
        name: "an image of one colour",
        run: one_colour,
    },
    Check {
        name: "an image of one pixel's width",
        run: narrow,
    },
];

/// An image that looks like no turned or mirrored copy of itself: sRGB, row by row from the top left.
static IMAGE: [[[u8; 3]; 4]; 3] = [
    [[255, 0, 0], [0, 255, 0], [0, 0, 255], [30, 30, 30]],
    [[255, 255, 0], [128, 128, 128], [255, 0, 255], [200, 60, 10]],
    [[0, 80, 160], [250, 250, 250], [90, 0, 40], [0, 255, 255]],
];

fn write(
    path: &Path,
    size: [u32; 2],
    kind: ColorType,
    depth: BitDepth,
    palette: &[u8],
    data: &[u8],
) {
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, size[0], size[1]);
    encoder.set_color(kind);
    encoder.set_depth(depth);
    if kind == ColorType::Indexed {
        encoder.set_palette(palette.to_vec());
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
}

/// A scene whose folder holds `image.png` of these pixels.
fn with_image(pixels: &[&[[u8; 3]]], text: &str, eye: &Eye) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let size = [pixels[0].len() as u32, pixels.len() as u32];
    let data: Vec<u8> = pixels.concat().as_flattened().to_vec();
    let path = folder.path().join("image.png");
    write(&path, size, ColorType::Rgb, BitDepth::Eight, &[], &data);
    let render = "render(footprint = 0.01, aa = none(), ao = none())\n";
    let text = format!("{text}\n{}{render}", eye.line());
    loaded(&text, eye.size, Some(folder.path()))
}

fn rows() -> Vec<&'static [[u8; 3]]> {
    IMAGE.iter().map(|row| row.as_slice()).collect()
}

/// The linear colour of an endlessly repeated image at a place, in copies of it from its top left corner to the right and
/// down: between the middles of its pixels it goes evenly.
fn texel(rows: &[&[[u8; 3]]], u: f64, v: f64) -> DVec3 {
    let (width, height) = (rows[0].len(), rows.len());
    let (x, y) = (u * width as f64 - 0.5, v * height as f64 - 0.5);
    let at = |x: f64, y: f64| {
        let row = rows[y.rem_euclid(height as f64) as usize];
        light(row[x.rem_euclid(width as f64) as usize].map(|c| f64::from(c) / 255.0))
    };
    let (i, j) = (x.floor(), y.floor());
    let upper = at(i, j).lerp(at(i + 1.0, j), x - i);
    let lower = at(i, j + 1.0).lerp(at(i + 1.0, j + 1.0), x - i);
    upper.lerp(lower, y - j)
}

/// On all six faces of a cube one sees the same: the image as it is, its top left corner in the middle of the face, to the
/// right and down.
fn faces(draw: Draw) -> Found {
    let size = 1.7;
    let text = format!("show(box(4), triplanar(\"image.png\", size = {size}))");
    for (from, up) in FACES {
        let eye = Eye::straight(from, up, DVec3::ZERO, 2.8);
        let film = draw(&with_image(&rows(), &text, &eye));
        let right = |x, y| {
            let q = eye.on_plane(x, y) / size;
            Some(texel(&rows(), q.x, q.y))
        };
        compare(&film, &eye, Plane::Albedo, 0.01, right)
            .map_err(|e| format!("from {from}: {e}"))?;
    }
    Ok(())
}

/// Where no face is straight, the three images count by powers of the normal's parts.
fn round(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(5.0, -4.0, 6.0),
        ..Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 2.4)
    };
    for sharpness in [1.0, 4.0, 20.0] {
        let how = format!("size = 0.8, sharpness = {sharpness}");
        let text = format!("show(sphere(1), triplanar(\"image.png\", {how}))");
        let film = draw(&with_image(&rows(), &text, &eye));
        let right = |x, y| {
            let ray = eye.ray(x, y);
            let p = ray.0 + ray.1 * ball(ray, DVec3::ZERO, 1.0)?;
            let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
            for k in 0..3 {
                // the face that is nearest to facing this way, as it is seen straight on
                let (side, up) = FACES[[0, 4, 2][k] + usize::from(p[k] < 0.0)];
                let [right, up, _] = Eye::straight(side, up, DVec3::ZERO, 1.0).axes();
                let weight = p[k].abs().powf(sharpness);
                sum += texel(&rows(), p.dot(right) / 0.8, -p.dot(up) / 0.8) * weight;
                weights += weight;
            }
            (-p.dot(ray.1) > 0.2).then(|| sum / weights)
        };
        compare(&film, &eye, Plane::Albedo, 0.03, right)
            .map_err(|e| format!("sharpness {sharpness}: {e}"))?;
    }
    Ok(())
}

/// However sharply the three are told apart, together they are the whole image.
fn one_colour(draw: Draw) -> Found {
    let eye = Eye {
        at: DVec3::new(5.0, 5.0, 5.0),
        ..Eye::straight(DVec3::Z, DVec3::Y, DVec3::ZERO, 1.0)
    };
    let pixel = [[188u8, 20, 90]];
    let right = light(pixel[0].map(|c| f64::from(c) / 255.0));
    for sharpness in [1, 8, 30, 64] {
        let text = format!("show(sphere(1), triplanar(\"image.png\", sharpness = {sharpness}))");
        let film = draw(&with_image(&[&pixel], &text, &eye));
        compare(&film, &eye, Plane::Albedo, 1e-4, |_, _| Some(right))
            .map_err(|e| format!("sharpness {sharpness}: {e}"))?;
    }
    Ok(())
}

/// A row of pixels is as wide as its copy, and as high.
fn narrow(draw: Draw) -> Found {
    let eye = Eye::straight(DVec3::Z, DVec3::Y, DVec3::new(3.0, -2.0, 0.0), 2.0);
    let row = [[255u8, 0, 0], [0, 0, 255]];
    for image in [vec![row.as_slice()], vec![&row[..1], &row[1..]]] {
        let text = "show(box((20, 20, 1)), triplanar(\"image.png\"))";
        let film = draw(&with_image(&image, text, &eye));
        let right = |x, y| {
            let p = eye.ray(x, y).0;
            Some(texel(&image, p.x, -p.y))
        };
        compare(&film, &eye, Plane::Albedo, 0.01, right)?;
    }
    Ok(())
}

/// The linear pixels that a file is read as.
fn read(
    kind: ColorType,
    depth: BitDepth,
    palette: &[u8],
    size: [u32; 2],
    data: &[u8],
) -> Vec<DVec3> {
    let folder = tempfile::tempdir().unwrap();
    write(
        &folder.path().join("image.png"),
        size,
        kind,
        depth,
        palette,
        data,
    );
    let text = "show(sphere(), triplanar(\"image.png\"))";
    let scene = loaded(text, SIZE, Some(folder.path()));
    let Pattern::Triplanar { image, .. } = &scene.materials()[0].pattern else {
        panic!("the image is a pattern");
    };
    assert_eq!([image.width, image.height], size);
    image.pixels.iter().map(|p| p.as_dvec3()).collect()
}

/// How an image is stored: kind, depth, palette, pixels, and what is seen of it.
type Case<'a> = (ColorType, BitDepth, &'a [u8], &'a [u8], Vec<DVec3>);

/// All kinds of PNG: sRGB becomes linear light. What is see-through counts as its colour.
#[test]
fn every_kind_of_image_is_read_as_srgb() {
    use BitDepth::{Eight, One, Sixteen};
    let grey = |x: f64| DVec3::splat(linear(x));
    let of = |c: [f64; 3]| light(c.map(|x| x / 255.0));
    let cases: [Case<'_>; 8] = [
        (
            ColorType::Rgb,
            Eight,
            &[],
            &[255, 128, 0, 10, 20, 30],
            vec![of([255.0, 128.0, 0.0]), of([10.0, 20.0, 30.0])],
        ),
        (
            ColorType::Rgba,
            Eight,
            &[],
            &[255, 128, 0, 0, 10, 20, 30, 255],
            vec![of([255.0, 128.0, 0.0]), of([10.0, 20.0, 30.0])],
        ),
        (
            ColorType::Grayscale,
            Eight,
            &[],
            &[128, 7],
            vec![grey(128.0 / 255.0), grey(7.0 / 255.0)],
        ),
        (
            ColorType::GrayscaleAlpha,
            Eight,
            &[],
            &[128, 9, 7, 255],
            vec![grey(128.0 / 255.0), grey(7.0 / 255.0)],
        ),
        (
            ColorType::Grayscale,
            One,
            &[],
            &[0b0100_0000],
            vec![DVec3::ZERO, DVec3::ONE],
        ),
        (
            ColorType::Grayscale,
            Sixteen,
            &[],
            &[0x80, 0x01, 0x01, 0x00],
            vec![grey(32_769.0 / 65_535.0), grey(256.0 / 65_535.0)],
        ),
        (
            ColorType::Rgb,
            Sixteen,
            &[],
            &[0x12, 0x34, 0xff, 0xff, 0, 1, 0, 0, 0x80, 0, 0x40, 0],
            vec![
                light([f64::from(0x1234) / 65_535.0, 1.0, 1.0 / 65_535.0]),
                light([0.0, 32_768.0 / 65_535.0, 16_384.0 / 65_535.0]),
            ],
        ),
        (
            ColorType::Indexed,
            Eight,
            &[1, 2, 3, 200, 100, 50],
            &[1, 0],
            vec![of([200.0, 100.0, 50.0]), of([1.0, 2.0, 3.0])],
        ),
    ];
    for (kind, depth, palette, data, right) in cases {
        let found = read(kind, depth, palette, [2, 1], data);
        for (found, right) in found.iter().zip(&right) {
            let off = (*found - *right).abs().max_element();
            assert!(off < 1e-6, "{kind:?} {depth:?}: {found} instead of {right}");
        }
    }
}
