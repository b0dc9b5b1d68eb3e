//! Textures that hold long lists, the images and the grids of a scene, kept from picture to picture.

use crate::device::Gpu;
use crate::error::GpuError;
use std::sync::{Arc, Weak};
use wgpu::{
    Extent3d, Origin3d, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect,
    TextureFormat, TextureView, TextureViewDescriptor, TextureViewDimension,
};
use zeroset_number::Grid;
use zeroset_scene::material::Image;
use zeroset_shader::texture::{MOST_LAYERS, SIDE, Texels, starts};

/// Rows that are handed to the driver at a time: it keeps a copy of them until it has them.
const ROWS: u64 = 128;

/// What a texture holds a list of.
pub(crate) trait Listed: Texels {
    /// How its texels are kept.
    const FORMAT: TextureFormat;
    /// What they are, for messages.
    const UNIT: &'static str;

    /// What it is, for messages.
    fn name(&self) -> String;
}

impl Listed for Image {
    const FORMAT: TextureFormat = TextureFormat::Rgba32Float;
    const UNIT: &'static str = "pixels of images";

    fn name(&self) -> String {
        format!(
            "\"{}\", an image of {}x{} pixels",
            self.path, self.width, self.height
        )
    }
}

impl Listed for Grid {
    const FORMAT: TextureFormat = TextureFormat::R32Float;
    const UNIT: &'static str = "samples of grids";

    fn name(&self) -> String {
        let [x, y, z] = self.nodes();
        format!("a grid of {x}x{y}x{z} nodes")
    }
}

/// A list in the layers of a texture, as [`zeroset_shader::texture`] describes them.
pub(crate) struct Layers<T> {
    texture: Option<(Texture, TextureView)>,
    /// Rows of all layers together.
    rows: u64,
    /// What it holds, and where that begins. Who was dropped is not taken for another who came to lie at the same address.
    held: Vec<(Weak<T>, u64)>,
}

impl<T> Default for Layers<T> {
    fn default() -> Layers<T> {
        Layers {
            texture: None,
            rows: 0,
            held: Vec::new(),
        }
    }
}

impl<T: Listed> Layers<T> {
    /// Whether a list fits into what there is.
    pub(crate) fn has_room(&self, all: &[Arc<T>]) -> bool {
        self.texture.is_some() && rows(all) <= self.rows
    }

    /// Makes room for a list. What was held is gone.
    ///
    /// # Errors
    /// The device has not so many layers, or not so much memory.
    pub(crate) async fn make_room(&mut self, gpu: &Gpu, all: &[Arc<T>]) -> Result<(), GpuError> {
        // the old texture goes first: both may not fit
        *self = Layers::default();
        let most = gpu.limits().max_texture_array_layers.min(MOST_LAYERS);
        let rows = allowed(all, &gpu.info().title(), most)?;
        let layers = rows.div_ceil(u64::from(SIDE));
        let size = Extent3d {
            width: SIDE,
            height: rows.min(u64::from(SIDE)) as u32,
            depth_or_array_layers: layers as u32,
        };
        let texture = gpu.texture(&purpose(all), size, T::FORMAT).await?;
        let view = texture.create_view(&TextureViewDescriptor {
            dimension: Some(TextureViewDimension::D2Array),
            ..TextureViewDescriptor::default()
        });
        self.rows = layers * u64::from(size.height);
        self.texture = Some((texture, view));
        Ok(())
    }

    /// How shaders see it, once there is room.
    pub(crate) fn view(&self) -> Option<&TextureView> {
        self.texture.as_ref().map(|(_, view)| view)
    }

    /// Writes what of a list is not there yet, and gives its bytes. There must be room for it.
    pub(crate) fn write(&mut self, gpu: &Gpu, all: &[Arc<T>]) -> u64 {
        let Some((texture, _)) = self.texture.as_ref().filter(|_| !all.is_empty()) else {
            // what a scene of no images leaves there may be asked for again
            return 0;
        };
        let mut bytes = 0;
        let held = std::mem::take(&mut self.held);
        for (k, (one, start)) in all.iter().zip(starts(all)).enumerate() {
            let weak = Arc::downgrade(one);
            let is_there =
                (held.get(k)).is_some_and(|(held, at)| held.ptr_eq(&weak) && *at == start);
            if !is_there {
                bytes += put(gpu, texture, one.as_ref(), start);
            }
            self.held.push((weak, start));
        }
        bytes
    }
}

/// Rows that a list takes. A texture has at least one.
fn rows<T: Texels>(all: &[Arc<T>]) -> u64 {
    let texels = starts(all).last().unwrap_or(0);
    texels.div_ceil(u64::from(SIDE)).max(1)
}

/// The name of what takes most of a list.
fn largest<T: Listed>(all: &[Arc<T>]) -> Option<String> {
    let largest = all.iter().max_by_key(|one| one.count())?;
    Some(largest.name())
}

/// What a texture is for, for messages.
fn purpose<T: Listed>(all: &[Arc<T>]) -> String {
    match largest(all) {
        Some(largest) => format!("{}, the largest of which is {largest}", T::UNIT),
        None => T::UNIT.to_owned(),
    }
}

/// Rows that a list takes on a device of so many layers.
fn allowed<T: Listed>(all: &[Arc<T>], adapter: &str, layers: u32) -> Result<u64, GpuError> {
    let (side, count) = (u64::from(SIDE), starts(all).last().unwrap_or(0));
    let limit = side * side * u64::from(layers);
    if count > limit {
        return Err(GpuError::Texels {
            unit: T::UNIT,
            count,
            adapter: adapter.to_owned(),
            limit,
            largest: largest(all).unwrap_or_default(),
        });
    }
    Ok(rows(all))
}

/// Writes the texels of one of a list, which begins at `start`, and gives their bytes.
fn put<T: Listed>(gpu: &Gpu, texture: &Texture, one: &T, start: u64) -> u64 {
    let texel = (size_of::<f32>() * T::CHANNELS) as u64;
    for span in Spans::new(start, one.count()) {
        let from = (span.texel - start) as usize;
        let numbers = one.numbers(from..from + (span.width * span.height) as usize);
        let [row, column] = [span.texel / u64::from(SIDE), span.texel % u64::from(SIDE)];
        gpu.queue.write_texture(
            TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: Origin3d {
                    x: column as u32,
                    y: (row % u64::from(SIDE)) as u32,
                    z: (row / u64::from(SIDE)) as u32,
                },
                aspect: TextureAspect::All,
            },
            bytemuck::cast_slice(&numbers),
            TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some((span.width * texel) as u32),
                rows_per_image: None,
            },
            Extent3d {
                width: span.width as u32,
                height: span.height as u32,
                depth_or_array_layers: 1,
            },
        );
    }
    one.count() * texel
}

/// A rectangle of one layer that holds texels which follow each other: a part of a row, or whole rows.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    /// The first of them.
    texel: u64,
    width: u64,
    height: u64,
}

/// Texels that follow each other, rectangle by rectangle.
struct Spans {
    next: u64,
    left: u64,
}

impl Spans {
    fn new(start: u64, count: u64) -> Spans {
        Spans {
            next: start,
            left: count,
        }
    }
}

impl Iterator for Spans {
    type Item = Span;

    fn next(&mut self) -> Option<Span> {
        let side = u64::from(SIDE);
        let (row, column) = (self.next / side, self.next % side);
        let (width, height) = if column > 0 || self.left < side {
            (self.left.min(side - column), 1)
        } else {
            (side, (self.left / side).min(side - row % side).min(ROWS))
        };
        let span = Span {
            texel: self.next,
            width,
            height,
        };
        self.next += width * height;
        self.left -= width * height;
        (width > 0).then_some(span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::borrow::Cow;
    use std::ops::Range;

    #[test]
    fn spans_cover_what_they_should_and_stay_in_a_layer() {
        let side = u64::from(SIDE);
        let layer = side * side;
        for start in [0, 1, side - 1, side, layer - side - 3, 5 * layer - 1] {
            for count in [0, 1, side - 1, side, 2 * side + 5, 3 * layer + 7] {
                let mut next = start;
                for span in Spans::new(start, count) {
                    assert_eq!(span.texel, next);
                    assert!(span.height == 1 || (next % side == 0 && span.width == side));
                    assert!(next % side + span.width <= side && span.height <= ROWS);
                    next += span.width * span.height;
                    assert_eq!((next - 1) / layer, span.texel / layer);
                }
                assert_eq!(next, start + count);
            }
        }
    }

    /// As many texels as it says, none of which is there.
    struct Claim(u64);

    impl Texels for Claim {
        const CHANNELS: usize = 1;

        fn count(&self) -> u64 {
            self.0
        }

        fn numbers(&self, _: Range<usize>) -> Cow<'_, [f32]> {
            Cow::default()
        }
    }

    impl Listed for Claim {
        const FORMAT: TextureFormat = TextureFormat::R32Float;
        const UNIT: &'static str = "claims";

        fn name(&self) -> String {
            format!("a claim of {}", self.0)
        }
    }

    #[test]
    fn a_list_that_no_texture_holds_is_an_error_that_names_the_largest() {
        let layer = u64::from(SIDE) * u64::from(SIDE);
        let all = [1, 4 * layer - 2, 1].map(|n| Arc::new(Claim(n)));
        assert_eq!(allowed(&all, "card", 4), Ok(4 * u64::from(SIDE)));
        let error = allowed(&all, "card", 3).expect_err("four layers");
        assert_eq!(
            error.to_string(),
            "the scene has 16777216 claims, card holds 12582912: the largest is a claim of 16777214"
        );
        assert!(error.advice().is_some());
        assert_eq!(allowed::<Claim>(&[], "card", 1), Ok(1));
    }
}
