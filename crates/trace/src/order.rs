//! The order of a tile's pixels: along Morton's curve (1966), so that the pixels of every square cell follow each other, and
//! so do the cells of every larger one.

use crate::simd::{SLACK, Sheet, TILE_RAYS};
use crate::tile::WIDTH;

/// Column of pixel (or cell) number `i`: its even bits.
pub(crate) static X: Sheet = coordinates(0);
/// Row of pixel (or cell) number `i`: its odd bits.
pub(crate) static Y: Sheet = coordinates(1);

const fn half(i: usize, from: usize) -> usize {
    let (mut bit, mut out) = (0, 0);
    while bit < 6 {
        out |= (i >> (2 * bit + from) & 1) << bit;
        bit += 1;
    }
    out
}

const fn coordinates(from: usize) -> Sheet {
    let mut out = [0.0; TILE_RAYS + SLACK];
    let mut i = 0;
    while i < TILE_RAYS {
        out[i] = half(i, from) as f32;
        i += 1;
    }
    Sheet::of(out)
}

/// Where pixel number `i` stands when rows follow each other.
pub(crate) static PLACE: [u16; TILE_RAYS] = {
    let mut out = [0; TILE_RAYS];
    let mut i = 0;
    while i < TILE_RAYS {
        out[i] = (half(i, 1) * WIDTH + half(i, 0)) as u16;
        i += 1;
    }
    out
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::HEIGHT;

    #[test]
    fn every_pixel_has_its_place() {
        let mut taken = vec![false; TILE_RAYS];
        for (i, &place) in PLACE.iter().enumerate() {
            assert!(!std::mem::replace(&mut taken[usize::from(place)], true));
            assert_eq!(
                (X[i], Y[i]),
                (
                    (usize::from(place) % WIDTH) as f32,
                    (usize::from(place) / WIDTH) as f32
                )
            );
            assert!(X[i] < WIDTH as f32 && Y[i] < HEIGHT as f32);
            // the cell of a pixel has a quarter of its number at each level
            for level in 1..4 {
                let cell = i >> (2 * level);
                assert_eq!(
                    (X[cell], Y[cell]),
                    ((X[i] as u32 >> level) as f32, (Y[i] as u32 >> level) as f32)
                );
            }
        }
    }
}
