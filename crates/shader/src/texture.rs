//! Long lists of numbers as textures: images and grids, one behind the other.
//!
//! Storage buffers are few. A texture holds millions of numbers beside them and is read by whole places, so that a formula
//! interpolates on a GPU as it does on the CPU. The list runs through the rows of layers of [`SIDE`] by [`SIDE`] texels: nothing
//! is lost between images of different sizes, and an image may be longer than any side that a device allows.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;
use zeroset_number::Grid;
use zeroset_scene::material::Image;

/// Texels along both sides of a layer: every device that renders at all has so many.
pub const SIDE: u32 = 2048;
/// Layers, at most: every device has so many.
pub const MOST_LAYERS: u32 = 256;

/// What lies in such a texture.
pub trait Texels {
    /// Numbers of a texel. Those of an image are the CPU's own, bit for bit: half precision would lose the difference between
    /// dark colours of 16 bits, and the decoding of sRGB by a GPU is none that we know.
    const CHANNELS: usize;

    /// How many texels it takes.
    fn count(&self) -> u64;

    /// The numbers of some of them.
    fn numbers(&self, texels: Range<usize>) -> Cow<'_, [f32]>;
}

impl Texels for Image {
    // textures of three numbers are none that every device has
    const CHANNELS: usize = 4;

    fn count(&self) -> u64 {
        self.pixels.len() as u64
    }

    fn numbers(&self, texels: Range<usize>) -> Cow<'_, [f32]> {
        let pixels = self.pixels[texels].iter();
        pixels.flat_map(|c| [c.x, c.y, c.z, 0.0]).collect()
    }
}

impl Texels for Grid {
    const CHANNELS: usize = 1;

    fn count(&self) -> u64 {
        self.values().len() as u64
    }

    fn numbers(&self, texels: Range<usize>) -> Cow<'_, [f32]> {
        Cow::Borrowed(&self.values()[texels])
    }
}

/// The first texel of each, and of what would come next.
pub fn starts<T: Texels>(all: &[Arc<T>]) -> impl Iterator<Item = u64> {
    let first = std::iter::once(0);
    first.chain(all.iter().scan(0, |end, one| {
        *end += one.count();
        Some(*end)
    }))
}

/// The row and the column of a texel: whole numbers that single precision holds exactly, as far as devices have layers.
pub(crate) fn place(texel: u64) -> [f32; 2] {
    let side = u64::from(SIDE);
    [(texel / side) as f32, (texel % side) as f32]
}

/// The constant that the functions below read.
pub(crate) fn side() -> String {
    format!("const TEXTURE_SIDE: u32 = {SIDE}u;\n")
}

/// The function that reads a texel of `images`, by its number.
pub(crate) const IMAGE_TEXEL: &str = "
fn image_texel(at: u32) -> vec3f {
    let row = at / TEXTURE_SIDE;
    let place = vec2u(at % TEXTURE_SIDE, row % TEXTURE_SIDE);
    return textureLoad(images, place, row / TEXTURE_SIDE, 0).xyz;
}
";

/// The function that reads a texel of `grids`, by its number.
pub(crate) const GRID_TEXEL: &str = "
fn grid_texel(at: u32) -> f32 {
    let row = at / TEXTURE_SIDE;
    let place = vec2u(at % TEXTURE_SIDE, row % TEXTURE_SIDE);
    return textureLoad(grids, place, row / TEXTURE_SIDE, 0).x;
}
";

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32) -> Arc<Image> {
        Arc::new(Image {
            path: String::new(),
            width,
            height,
            pixels: vec![glam::Vec3::ONE; (width * height) as usize],
        })
    }

    #[test]
    fn texels_follow_each_other() {
        let all = [image(3, 5), image(1, 1), image(4000, 2)];
        assert_eq!(starts(&all).collect::<Vec<_>>(), [0, 15, 16, 8016]);
        assert_eq!(starts::<Image>(&[]).collect::<Vec<_>>(), [0]);
        assert_eq!(all[0].numbers(1..3).len(), 8);
    }

    #[test]
    fn places_are_exact_to_the_last_texel() {
        let side = u64::from(SIDE);
        let last = side * side * u64::from(MOST_LAYERS) - 1;
        for texel in [0, 1, side - 1, side, (1 << 24) + 1, last] {
            let [row, column] = place(texel).map(|x| x as u64);
            assert_eq!(row * side + column, texel);
        }
        assert!(u32::try_from(last).is_ok());
    }
}
