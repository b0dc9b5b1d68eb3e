//! The order of a tile's pixels, and of its hits. Pixels lie along Morton's curve (1966), so that those of every square cell follow
//! each other, and so do the cells of every larger one.

use crate::simd::{SLACK, Sheet, TILE_RAYS, WordSheet};
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

/// Memory to put the hits of a tile in another order.
pub(crate) struct Sorting {
    /// Which hit comes first, second and so on.
    order: Vec<u16>,
    /// Where the hits of each key begin.
    starts: Vec<usize>,
    column: Box<Sheet>,
    words: Box<WordSheet>,
}

impl Sorting {
    pub(crate) fn new() -> Sorting {
        Sorting {
            order: Vec::with_capacity(TILE_RAYS),
            starts: Vec::new(),
            column: Sheet::boxed(),
            words: WordSheet::boxed(),
        }
    }

    /// Orders `count` hits by their keys, of which there are `keys`; those of equal keys stay as they are.
    pub(crate) fn by_key(&mut self, count: usize, keys: usize, key: impl Fn(usize) -> usize) {
        self.starts.clear();
        self.starts.resize(keys + 1, 0);
        (0..count).for_each(|i| self.starts[key(i) + 1] += 1);
        for k in 0..keys {
            self.starts[k + 1] += self.starts[k];
        }
        self.order.clear();
        self.order.resize(count, 0);
        for i in 0..count {
            let to = &mut self.starts[key(i)];
            self.order[*to] = i as u16;
            *to += 1;
        }
    }

    /// Puts a column in the order.
    pub(crate) fn apply(&mut self, column: &mut [f32]) {
        self.column[..self.order.len()].copy_from_slice(&column[..self.order.len()]);
        for (to, &from) in column.iter_mut().zip(&self.order) {
            *to = self.column[usize::from(from)];
        }
    }

    /// Puts whole numbers in the order.
    pub(crate) fn apply_words(&mut self, column: &mut [u32]) {
        self.words[..self.order.len()].copy_from_slice(&column[..self.order.len()]);
        for (to, &from) in column.iter_mut().zip(&self.order) {
            *to = self.words[usize::from(from)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tile::HEIGHT;

    #[test]
    fn hits_are_sorted_by_their_keys() {
        let keys = [2usize, 0, 1, 1, 0, 2, 0];
        let mut sorting = Sorting::new();
        for _ in 0..2 {
            sorting.by_key(keys.len(), 3, |i| keys[i]);
            let mut column: Vec<f32> = (0..8).map(|i| i as f32).collect();
            sorting.apply(&mut column);
            assert_eq!(column, [1.0, 4.0, 6.0, 2.0, 3.0, 0.0, 5.0, 7.0]);
            let mut words: Vec<u32> = (0..8).collect();
            sorting.apply_words(&mut words);
            assert_eq!(words, [1, 4, 6, 2, 3, 0, 5, 7]);
        }
    }

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
