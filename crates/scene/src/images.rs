//! Images that surfaces show.

use crate::colour;
use crate::files::Files;
use crate::limits::Limits;
use crate::material::Image;
use glam::Vec3;
use image::{ImageReader, Limits as DecodeLimits};
use std::io::Cursor;
use std::sync::Arc;

/// An image from the scene's folder.
///
/// # Errors
/// What is wrong with it, and what is allowed.
pub(crate) fn load(files: &mut Files, name: &str, limits: &Limits) -> Result<Arc<Image>, String> {
    let bytes = files
        .read(name, limits.image_bytes, "image_bytes")
        .map_err(|e| e.to_string())?;
    let bad = |e: &dyn std::fmt::Display| format!("\"{name}\" is no image that can be read: {e}");
    let reader = || ImageReader::new(Cursor::new(&bytes)).with_guessed_format();
    let (width, height) = reader()
        .map_err(|e| bad(&e))?
        .into_dimensions()
        .map_err(|e| bad(&e))?;
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 || pixels > limits.image_pixels {
        return Err(format!(
            "\"{name}\" has {width}x{height} pixels, at most {} are allowed (limit `image_pixels`)",
            limits.image_pixels
        ));
    }
    let mut decoder = reader().map_err(|e| bad(&e))?;
    let mut allowed = DecodeLimits::default();
    allowed.max_alloc = Some(pixels.saturating_mul(16).saturating_add(1 << 20));
    decoder.limits(allowed);
    let decoded = decoder.decode().map_err(|e| bad(&e))?.into_rgb16();
    let channel = |x: u16| colour::linear_channel(f64::from(x) / 65_535.0) as f32;
    let pixels = decoded
        .pixels()
        .map(|p| Vec3::new(channel(p.0[0]), channel(p.0[1]), channel(p.0[2])))
        .collect();
    let path = Files::normal(name).map_err(|e| e.to_string())?;
    Ok(Arc::new(Image {
        path,
        width,
        height,
        pixels,
    }))
}
