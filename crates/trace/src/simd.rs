//! Columns of numbers, one lane a ray, and what SIMD does with them: loads, stores, and the compaction that closes the gaps
//! of finished rays.

use fearless_simd::{Simd, prelude::*};
use std::ops::{Deref, DerefMut};
use zeroset_eval::{BATCH, Lane};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Vec3, v3};

/// Lanes behind the last one that vectors may write garbage to.
pub(crate) const SLACK: usize = 64;
/// Rays of a tile.
pub(crate) const TILE_RAYS: usize = crate::tile::WIDTH * crate::tile::HEIGHT;

/// One number of every ray of a batch.
pub(crate) type Row = Column<{ BATCH + SLACK }>;
/// One number of every ray of a tile.
pub(crate) type Sheet = Column<{ TILE_RAYS + SLACK }>;

/// One number of `N` rays.
#[derive(Clone)]
#[repr(C, align(64))]
pub(crate) struct Column<const N: usize>([f32; N]);

impl<const N: usize> Column<N> {
    /// Zeros.
    pub(crate) const ZERO: Self = Column([0.0; N]);

    /// These numbers.
    pub(crate) const fn of(numbers: [f32; N]) -> Self {
        Column(numbers)
    }

    /// Zeros, on the heap.
    pub(crate) fn boxed() -> Box<Self> {
        Box::new(Self::ZERO)
    }
}

impl<const N: usize> Deref for Column<N> {
    type Target = [f32];
    #[inline(always)]
    fn deref(&self) -> &[f32] {
        &self.0
    }
}

impl<const N: usize> DerefMut for Column<N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }
}

/// A column, be it where it is or on the heap.
pub(crate) trait Numbers {
    fn numbers(&self) -> &[f32];
    fn numbers_mut(&mut self) -> &mut [f32];
}

impl<const N: usize> Numbers for Column<N> {
    #[inline(always)]
    fn numbers(&self) -> &[f32] {
        &self.0
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }
}

impl<C: Numbers> Numbers for Box<C> {
    #[inline(always)]
    fn numbers(&self) -> &[f32] {
        (**self).numbers()
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> &mut [f32] {
        (**self).numbers_mut()
    }
}

impl Numbers for Lane {
    #[inline(always)]
    fn numbers(&self) -> &[f32] {
        &self.0
    }
    #[inline(always)]
    fn numbers_mut(&mut self) -> &mut [f32] {
        &mut self.0
    }
}

/// Whole numbers of `N` rays.
#[derive(Clone)]
#[repr(C, align(64))]
pub(crate) struct Words<const N: usize>([u32; N]);

/// Whole numbers of a batch.
pub(crate) type WordRow = Words<{ BATCH + SLACK }>;
/// Whole numbers of a tile.
pub(crate) type WordSheet = Words<{ TILE_RAYS + SLACK }>;

impl<const N: usize> Words<N> {
    /// Zeros, on the heap.
    pub(crate) fn boxed() -> Box<Self> {
        Box::new(Words([0; N]))
    }
}

impl<const N: usize> Deref for Words<N> {
    type Target = [u32];
    #[inline(always)]
    fn deref(&self) -> &[u32] {
        &self.0
    }
}

impl<const N: usize> DerefMut for Words<N> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [u32] {
        &mut self.0
    }
}

/// The lanes from `i` on.
#[inline(always)]
pub(crate) fn load<S: Simd>(s: S, column: &[f32], i: usize) -> Lanes<S> {
    Lanes(S::f32s::from_slice(s, &column[i..i + S::f32s::LEN]))
}

/// Writes the lanes from `i` on.
#[inline(always)]
pub(crate) fn store<S: Simd>(x: Lanes<S>, column: &mut [f32], i: usize) {
    x.0.store_slice(&mut column[i..i + S::f32s::LEN]);
}

/// The whole numbers from `i` on.
#[inline(always)]
pub(crate) fn load_words<S: Simd>(s: S, column: &[u32], i: usize) -> S::u32s {
    S::u32s::from_slice(s, &column[i..i + S::f32s::LEN])
}

/// Writes the whole numbers from `i` on.
#[inline(always)]
pub(crate) fn store_words<S: Simd>(x: S::u32s, column: &mut [u32], i: usize) {
    x.store_slice(&mut column[i..i + S::f32s::LEN]);
}

/// The vectors from `i` on.
#[inline(always)]
pub(crate) fn load3<S: Simd, C: Numbers>(s: S, columns: &[C; 3], i: usize) -> Vec3<Lanes<S>> {
    let [x, y, z] = columns;
    v3(
        load(s, x.numbers(), i),
        load(s, y.numbers(), i),
        load(s, z.numbers(), i),
    )
}

/// Writes the vectors from `i` on.
#[inline(always)]
pub(crate) fn store3<S: Simd, C: Numbers>(x: Vec3<Lanes<S>>, columns: &mut [C; 3], i: usize) {
    store(x.x, columns[0].numbers_mut(), i);
    store(x.y, columns[1].numbers_mut(), i);
    store(x.z, columns[2].numbers_mut(), i);
}

/// `c` in every lane.
#[inline(always)]
pub(crate) fn splat<S: Simd>(s: S, c: f32) -> Lanes<S> {
    Lanes(S::f32s::splat(s, c))
}

/// `c` in every lane.
#[inline(always)]
pub(crate) fn splat3<S: Simd>(s: S, c: [f32; 3]) -> Vec3<Lanes<S>> {
    v3(splat(s, c[0]), splat(s, c[1]), splat(s, c[2]))
}

/// `a * b + c`, fused where the machine can.
#[inline(always)]
pub(crate) fn fma<S: Simd>(a: Lanes<S>, b: Lanes<S>, c: Lanes<S>) -> Lanes<S> {
    Lanes(a.0.mul_add(b.0, c.0))
}

/// `origin + direction * t`, fused where the machine can.
#[inline(always)]
pub(crate) fn along<S: Simd>(
    origin: Vec3<Lanes<S>>,
    direction: Vec3<Lanes<S>>,
    t: Lanes<S>,
) -> Vec3<Lanes<S>> {
    v3(
        fma(direction.x, t, origin.x),
        fma(direction.y, t, origin.y),
        fma(direction.z, t, origin.z),
    )
}

/// The first `n` lanes (all of them where `n` is larger).
#[inline(always)]
pub(crate) fn first_lanes<S: Simd>(s: S, n: usize) -> LaneMask<S> {
    let bits = if n >= S::f32s::LEN {
        u64::MAX
    } else {
        (1 << n) - 1
    };
    LaneMask(S::mask32s::from_bitmask(s, bits))
}

/// The bit of a ray's word that tells the side it is marched on: set where it starts inside a solid.
pub(crate) const INSIDE: u32 = 1 << 31;

/// `f` as seen from the side that `word` states: positive where the ray may go on.
#[inline(always)]
pub(crate) fn sided<S: Simd>(f: Lanes<S>, word: S::u32s) -> Lanes<S> {
    let bits: S::u32s = f.0.bitcast();
    Lanes((bits ^ (word & INSIDE)).bitcast())
}

/// Lanes that were chosen to be kept.
#[derive(Clone, Copy)]
pub(crate) struct Chosen<S: Simd> {
    mask: S::mask32s,
    bits: u64,
    /// How many.
    pub(crate) count: usize,
}

impl<S: Simd> Chosen<S> {
    /// The lanes where `mask` holds.
    #[inline(always)]
    pub(crate) fn new(mask: LaneMask<S>) -> Self {
        let bits = mask.0.to_bitmask();
        Chosen {
            mask: mask.0,
            bits,
            count: bits.count_ones() as usize,
        }
    }

    /// One bit a lane, set where it is chosen.
    #[inline(always)]
    pub(crate) fn bits(self) -> u64 {
        self.bits
    }

    /// Whether every lane is chosen.
    #[inline(always)]
    pub(crate) fn all(self) -> bool {
        self.count == S::f32s::LEN
    }

    /// Whether no lane is chosen.
    #[inline(always)]
    pub(crate) fn none(self) -> bool {
        self.count == 0
    }

    /// Writes the chosen lanes, closed up, from `at` on. The lanes behind them become garbage.
    #[inline(always)]
    pub(crate) fn put(self, x: Lanes<S>, column: &mut [f32], at: usize) {
        store(
            if self.all() {
                x
            } else {
                Lanes(x.0.compress(self.mask))
            },
            column,
            at,
        );
    }

    /// [`Chosen::put`] for vectors.
    #[inline(always)]
    pub(crate) fn put3<C: Numbers>(self, x: Vec3<Lanes<S>>, columns: &mut [C; 3], at: usize) {
        self.put(x.x, columns[0].numbers_mut(), at);
        self.put(x.y, columns[1].numbers_mut(), at);
        self.put(x.z, columns[2].numbers_mut(), at);
    }

    /// [`Chosen::put`] for whole numbers.
    #[inline(always)]
    pub(crate) fn put_words(self, x: S::u32s, column: &mut [u32], at: usize) {
        store_words::<S>(
            if self.all() { x } else { x.compress(self.mask) },
            column,
            at,
        );
    }
}
