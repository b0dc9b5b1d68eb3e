//! Images that surfaces show.

use crate::files::{Files, read_ordinary};
use crate::limits::Limits;
use glam::Vec3;
use image::{DynamicImage, ImageDecoder, ImageReader, Limits as DecodeLimits};
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use zeroset_scene::colour;
use zeroset_scene::material::Image;

/// An image from the scene's folder, decoded once however often it is asked for.
///
/// # Errors
/// What is wrong with it, and what is allowed.
pub(crate) fn load(files: &mut Files, name: &str, limits: &Limits) -> Result<Arc<Image>, String> {
    files.image(name, |files, real| decode(files, real, name, limits))
}

fn decode(files: &mut Files, real: &Path, name: &str, limits: &Limits) -> Result<Image, String> {
    let text = |e: &dyn std::fmt::Display| e.to_string();
    // the file's own bytes are given back at the end
    let mut budget = files.budget;
    let bytes = read_ordinary(real, name, limits.image_bytes, "image_bytes", &mut budget)
        .map_err(|e| text(&e))?;
    let bad = |e: &dyn std::fmt::Display| format!("\"{name}\" is no image that can be read: {e}");
    let reader = || ImageReader::new(Cursor::new(&bytes)).with_guessed_format();
    let decoder = reader().map_err(|e| bad(&e))?.into_decoder();
    let decoder = decoder.map_err(|e| bad(&e))?;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 || pixels > limits.image_pixels {
        return Err(format!(
            "\"{name}\" has {width}x{height} pixels, at most {} are allowed (limit `image_pixels`)",
            limits.image_pixels
        ));
    }
    // as it is decoded, what the decoder may keep meanwhile, and as it is kept
    let decoded = decoder.total_bytes();
    drop(decoder);
    let kept = pixels * size_of::<Vec3>() as u64;
    let what = || format!("\"{name}\", an image of {width}x{height} pixels,");
    budget
        .hold(2 * decoded + kept, what)
        .map_err(|e| text(&e))?;
    let mut allowed = DecodeLimits::default();
    allowed.max_alloc = Some(2 * decoded + (1 << 20));
    let mut reader = reader().map_err(|e| bad(&e))?;
    reader.limits(allowed);
    let pixels = linear(reader.decode().map_err(|e| bad(&e))?);
    let path = Files::normal(name).map_err(|e| text(&e))?;
    files.budget.hold(kept, what).map_err(|e| text(&e))?;
    Ok(Image {
        path,
        width,
        height,
        pixels,
    })
}

/// The linear channel of every value that a file can hold.
static CHANNELS: LazyLock<Vec<f32>> = LazyLock::new(|| {
    (0..=u16::MAX)
        .map(|x| colour::linear_channel(f64::from(x) / 65_535.0) as f32)
        .collect()
});

/// The pixels in linear colours, without the detour of a larger copy.
fn linear(decoded: DynamicImage) -> Vec<Vec3> {
    // 8 bits of all become 16 bits of all
    let eight = |x: u8| CHANNELS[usize::from(x) * 257];
    let sixteen = |x: u16| CHANNELS[usize::from(x)];
    match decoded {
        DynamicImage::ImageLuma8(i) => i.pixels().map(|p| Vec3::splat(eight(p.0[0]))).collect(),
        DynamicImage::ImageLumaA8(i) => i.pixels().map(|p| Vec3::splat(eight(p.0[0]))).collect(),
        DynamicImage::ImageRgb8(i) => (i.pixels()).map(|p| Vec3::from(p.0.map(eight))).collect(),
        DynamicImage::ImageRgba8(i) => (i.pixels())
            .map(|p| Vec3::new(eight(p.0[0]), eight(p.0[1]), eight(p.0[2])))
            .collect(),
        other => (other.into_rgb16().pixels())
            .map(|p| Vec3::from(p.0.map(sixteen)))
            .collect(),
    }
}
