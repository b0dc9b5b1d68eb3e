//! A lattice hash in plain arithmetic: the same bits in `f32`, `f64`, SIMD lanes and on GPUs.
//!
//! The permutation polynomial (34 x + 10) x mod 289 of Gustavson and McEwan 2022 (Tiling simplex noise and flow noise in two
//! and three dimensions; the idea is McEwan, Sheets, Gustavson and Richardson 2012, Efficient computational noise in GLSL):
//! with x in [0, 289) every product stays below 2^24, so all of it is exact in `f32`, with or without fused multiply-add.
//! The hash repeats after 289 cells along every axis.

use super::real::Real;
use super::vector::{Vec2, Vec3, v2, v3};

/// Cells farther from the origin than this count as being there: up to here the arithmetic is exact.
const REACH: f32 = 4_194_304.0;
const M: f32 = 289.0;

/// x mod 289, for whole numbers up to [`REACH`].
///
/// The quotient of x + 1/2 is at least 0.5 / 289 away from every whole number, which is more than two roundings of it (one
/// of 1 / 289, one of the product) can make up.
#[inline(always)]
fn mod289<R: Real>(x: R) -> R {
    x - ((x + 0.5) * (1.0 / M)).floor() * M
}

/// The next whole number in [0, 289), for a whole number in [0, 578).
#[inline(always)]
fn permute<R: Real>(x: R) -> R {
    let x = mod289(x);
    mod289((x * 34.0 + 10.0) * x).whole()
}

#[inline(always)]
fn cell<R: Real>(x: R) -> R {
    mod289(x.clamp(-REACH, REACH))
}

/// A whole number in [0, 289) that a lattice cell hashed to.
#[derive(Clone, Copy, Debug)]
pub struct Hash<R>(R);

impl<R: Real> Hash<R> {
    /// The hash of a whole number.
    #[inline(always)]
    pub fn of1(x: R) -> Self {
        Hash(permute(cell(x)))
    }

    /// The hash of a cell of the plane (whole numbers).
    #[inline(always)]
    pub fn of2(c: Vec2<R>) -> Self {
        Hash(permute(permute(cell(c.x)) + cell(c.y)))
    }

    /// The hash of a cell of space (whole numbers).
    #[inline(always)]
    pub fn of3(c: Vec3<R>) -> Self {
        Hash(permute(permute(permute(cell(c.x)) + cell(c.y)) + cell(c.z)))
    }

    /// The hash of the same cell and one more whole number: `of1(x).and(y).and(z)` is `of3`, step by step, so that
    /// neighbours can share the steps that they have in common.
    #[inline(always)]
    pub fn and(self, x: R) -> Self {
        Hash(permute(self.0 + cell(x)))
    }

    /// Another hash of the same cell.
    #[inline(always)]
    pub fn next(self) -> Self {
        Hash(permute(self.0))
    }

    /// As a point of a 17 by 17 grid in the open square (-1, 1) x (-1, 1).
    #[inline(always)]
    pub fn square(self) -> Vec2<R> {
        // half a step off the whole numbers, so that no rounding decides the floor
        let row = ((self.0 + 0.5) * (1.0 / 17.0)).floor();
        let column = self.0 - row * 17.0;
        v2(Self::centred(column), Self::centred(row))
    }

    /// A whole number in [0, 17) as a number in (-1, 1).
    #[inline(always)]
    fn centred(i: R) -> R {
        ((i - 8.0) * (2.0 / 17.0)).proven(-1.0, 1.0, Vec3::splat(i), f32::INFINITY)
    }

    /// As a number in [0, 1): one of 289 evenly spaced ones.
    #[inline(always)]
    pub fn unit(self) -> R {
        // 58052 / 2^24 is just below 1 / 289, and its product with a whole number below 289 is exact
        let h = self.0 * (58052.0 / 16_777_216.0);
        h.proven(0.0, 1.0, v3(self.0, self.0, self.0), f32::INFINITY)
    }
}

/// The hash of a whole number, in [0, 1).
#[inline(always)]
pub fn hash1<R: Real>(x: R) -> R {
    Hash::of1(x).unit()
}

/// The hash of a cell of the plane (whole numbers), in [0, 1).
#[inline(always)]
pub fn hash2<R: Real>(c: Vec2<R>) -> R {
    Hash::of2(c).unit()
}

/// The hash of a cell of space (whole numbers), in [0, 1).
#[inline(always)]
pub fn hash3<R: Real>(c: Vec3<R>) -> R {
    Hash::of3(c).unit()
}
