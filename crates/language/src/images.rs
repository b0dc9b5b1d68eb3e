//! Images that surfaces show, PNG and JPEG, and of light: Radiance.

use crate::budget::LoadBudget;
use crate::files::Reading;
use crate::limits::Limits;
use crate::radiance;
use glam::Vec3;
use std::io::Cursor;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use zeroset_scene::colour;
use zeroset_scene::material::Image;
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

/// An image from the scene's folder, decoded once however often it is asked for.
///
/// # Errors
/// What is wrong with it, and what is allowed.
pub(crate) fn load(files: &mut Reading, name: &str, limits: &Limits) -> Result<Arc<Image>, String> {
    files.image(name, |files, real| read(files, real, name, limits))
}

fn read(
    files: &mut Reading,
    real: &Path,
    name: &str,
    limits: &Limits,
) -> Result<Arc<Image>, String> {
    let text = |e: &dyn std::fmt::Display| e.to_string();
    // the file's own bytes are given back at the end
    let mut budget = files.budget;
    let bytes = files
        .read_at(real, name, limits.image_bytes, "image_bytes", &mut budget)
        .map_err(|e| text(&e))?;
    let path = Reading::normal(name).map_err(|e| text(&e))?;
    files.cache.assets.image(&path, &bytes, || {
        let ([width, height], pixels) = if radiance::is_one(&bytes) {
            bright(&bytes, name, limits, &mut budget)?
        } else {
            let decoded = decode(&bytes, name, limits, &mut budget)?;
            (decoded.size, decoded.linear())
        };
        Ok(Image {
            path: path.clone(),
            width,
            height,
            pixels,
        })
    })
}

/// Size and linear colours of an image that may be brighter than white.
fn bright(
    bytes: &[u8],
    name: &str,
    limits: &Limits,
    budget: &mut LoadBudget,
) -> Result<([u32; 2], Vec<Vec3>), String> {
    let room = ImageLimits {
        name,
        most: limits.image_pixels,
    };
    let (size, rest) = radiance::head(bytes).map_err(|e| room.bad(&e))?;
    room.charge(size, 0, budget)?;
    let pixels = radiance::pixels(size, rest).map_err(|e| room.bad(&e))?;
    Ok((size, pixels))
}

fn decode(
    bytes: &[u8],
    name: &str,
    limits: &Limits,
    budget: &mut LoadBudget,
) -> Result<Decoded, String> {
    let room = ImageLimits {
        name,
        most: limits.image_pixels,
    };
    if bytes.starts_with(b"\x89PNG") {
        png(bytes, &room, budget)
    } else if bytes.starts_with(&[0xff, 0xd8, 0xff]) {
        jpeg(bytes, &room, budget)
    } else {
        Err(room.bad(&"it begins neither like a PNG nor like a JPEG file"))
    }
}

/// A linear number as sRGB has it (IEC 61966-2-1).
fn encoded(x: f32) -> f32 {
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    }
}

/// The brightness of every pixel, 0 to 1, as a screen shows it: sRGB's of the luminance, over white where a pixel is see-through. With
/// width and height.
///
/// # Errors
/// What is wrong with the image, and what is allowed.
pub(crate) fn brightness(
    files: &mut Reading,
    name: &str,
    limits: &Limits,
) -> Result<([usize; 2], Vec<f32>), String> {
    let real = files.find(name).map_err(|e| e.to_string())?;
    let mut budget = files.budget;
    let bytes = files
        .read_at(&real, name, limits.image_bytes, "image_bytes", &mut budget)
        .map_err(|e| e.to_string())?;
    let decoded = decode(&bytes, name, limits, &mut budget)?;
    let size = [decoded.size[0] as usize, decoded.size[1] as usize];
    let colours = decoded.linear();
    let shown = (colours.iter().zip(decoded.opacities())).map(|(c, opacity)| {
        // Rec. 709
        let luminance = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        // mixed as drawing programs do, so that what is half clear is half as bright
        1.0 + opacity * (encoded(luminance) - 1.0)
    });
    Ok((size, shown.collect()))
}

/// An image for messages.
pub(crate) fn what(name: &str, [width, height]: [u32; 2]) -> String {
    format!("\"{name}\", an image of {width}x{height} pixels,")
}

/// What an image may be, and how it is called in messages.
struct ImageLimits<'a> {
    name: &'a str,
    /// Pixels.
    most: u64,
}

impl ImageLimits<'_> {
    fn bad(&self, e: &dyn std::fmt::Display) -> String {
        format!("\"{}\" is no image that can be read: {e}", self.name)
    }

    /// Charges what decoding takes: the file's pixels, as much again for the decoder, and the linear colours.
    fn charge(&self, size: [u32; 2], decoded: u64, budget: &mut LoadBudget) -> Result<(), String> {
        let [width, height] = size;
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > self.most {
            return Err(format!(
                "\"{}\" has {width}x{height} pixels, at most {} are allowed (limit `image_pixels`)",
                self.name, self.most
            ));
        }
        let bytes = decoded.saturating_mul(2).saturating_add(kept(size));
        budget
            .hold(bytes, || what(self.name, size))
            .map_err(|e| e.to_string())
    }
}

/// Bytes of an image as it is kept.
pub(crate) fn kept([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height) * size_of::<Vec3>() as u64
}

/// Pixels as they come from a file: rows of bytes.
struct Decoded {
    size: [u32; 2],
    bytes: Vec<u8>,
    /// Numbers a pixel: grey, grey and opacity, three colours, three colours and opacity.
    channels: usize,
    /// Whether a number takes two bytes, the larger one first.
    wide: bool,
}

fn png(bytes: &[u8], room: &ImageLimits<'_>, budget: &mut LoadBudget) -> Result<Decoded, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(|e| room.bad(&e))?;
    let size = [header.width, header.height];
    // what may come out of it: palettes and transparent colours become more channels
    let most = u64::from(size[0]) * u64::from(size[1]) * 8;
    room.charge(size, most, budget)?;
    decoder.set_limits(png::Limits {
        bytes: (2 * most + (1 << 20)) as usize,
    });
    let mut reader = decoder.read_info().map_err(|e| room.bad(&e))?;
    let length = reader.output_buffer_size().filter(|n| *n as u64 <= most);
    let length = length.ok_or_else(|| room.bad(&"its rows do not fit its size"))?;
    let mut pixels = vec![0; length];
    reader.next_frame(&mut pixels).map_err(|e| room.bad(&e))?;
    let (colour, depth) = reader.output_color_type();
    Ok(Decoded {
        size,
        bytes: pixels,
        channels: colour.samples(),
        wide: depth == png::BitDepth::Sixteen,
    })
}

fn jpeg(bytes: &[u8], room: &ImageLimits<'_>, budget: &mut LoadBudget) -> Result<Decoded, String> {
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| room.bad(&e))?;
    let size = decoder.dimensions().unwrap_or_default();
    // a JPEG holds its size in 16 bits
    let size = [size.0 as u32, size.1 as u32];
    room.charge(size, u64::from(size[0]) * u64::from(size[1]) * 3, budget)?;
    let pixels = decoder.decode().map_err(|e| room.bad(&e))?;
    if pixels.len() as u64 != u64::from(size[0]) * u64::from(size[1]) * 3 {
        return Err(room.bad(&"its rows do not fit its size"));
    }
    Ok(Decoded {
        size,
        bytes: pixels,
        channels: 3,
        wide: false,
    })
}

/// The linear channel of every value that a file can hold.
static CHANNELS: LazyLock<Vec<f32>> = LazyLock::new(|| {
    (0..=u16::MAX)
        .map(|x| colour::linear_channel(f64::from(x) / 65_535.0) as f32)
        .collect()
});

impl Decoded {
    /// How opaque each pixel is, 0 to 1.
    fn opacities(&self) -> impl Iterator<Item = f32> {
        let width = if self.wide { 2 } else { 1 };
        let clear = self.channels.is_multiple_of(2);
        self.bytes
            .chunks_exact(self.channels * width)
            .map(move |pixel| match &pixel[(self.channels - 1) * width..] {
                _ if !clear => 1.0,
                [high, low] => f32::from(u16::from_be_bytes([*high, *low])) / 65_535.0,
                [x, ..] => f32::from(*x) / 255.0,
                [] => 1.0,
            })
    }

    /// The pixels in linear colours. What is see-through counts as its colour.
    fn linear(&self) -> Vec<Vec3> {
        let width = if self.wide { 2 } else { 1 };
        let number = |pixel: &[u8], k: usize| match pixel[k * width..][..width] {
            [high, low] => CHANNELS[usize::from(u16::from_be_bytes([high, low]))],
            // 8 bits of all become 16 bits of all
            [x, ..] => CHANNELS[usize::from(x) * 257],
            [] => 0.0,
        };
        (self.bytes.chunks_exact(self.channels * width))
            .map(|pixel| {
                if self.channels < 3 {
                    Vec3::splat(number(pixel, 0))
                } else {
                    Vec3::new(number(pixel, 0), number(pixel, 1), number(pixel, 2))
                }
            })
            .collect()
    }
}
