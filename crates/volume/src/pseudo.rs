//! Pseudo-distances: what a binary volume becomes that is blurred and halved again and again (Evans 2006, 9.5 and 9.7).
//!
//! A blurred volume is positive outside, negative inside and rises away from a surface: for skylight and for curvature that is enough, and it takes no search.
//! Each halving mixes four cells along each axis by 1/8, 3/8, 3/8, 1/8. What is left of a flat face is the sum of a Gaussian, whose slope is that of a
//! distance where it is zero; farther away than two deviations it tells no more. So each mip knows distances twice as far as the one below.
//!
//! ```
//! use zeroset_volume::pseudo::pseudo_distances;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // the lower half of 32 by 32 by 32 cells is filled: 8 by 8 by 8 are left, and 4 by 4 by 4 above them
//! let inside: Vec<bool> = (0..32 * 32 * 32).map(|n| n / 32 % 32 < 16).collect();
//! let mips = pseudo_distances([32; 3], &inside, 2, 2)?;
//! assert_eq!(mips[1].size, [4; 3]);
//! // the middle of the first cell above the face is two cells of the binary volume from it
//! assert!((mips[0].at([3, 4, 3]) - 2.0).abs() < 0.4);
//! # Ok(())
//! # }
//! ```

use rayon::prelude::*;

/// The most cells along an axis.
const MOST: usize = 1024;

/// Why there are no pseudo-distances.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PseudoError {
    /// Not one mark for each cell.
    #[error("{size:?} cells and {marks} marks")]
    Count {
        /// Cells along each axis.
        size: [usize; 3],
        /// Marks.
        marks: usize,
    },
    /// Sides that cannot be halved so often, or too long ones.
    #[error("{size:?} cells cannot be halved {times} times: sides are multiples of {}, up to 1024", 1usize << times)]
    Size {
        /// Cells along each axis.
        size: [usize; 3],
        /// How often.
        times: u32,
    },
    /// No mip, or no halving at all, or too many.
    #[error("{halvings} halvings and {mips} mips: at least one of each, and ten together")]
    Mips {
        /// Halvings before the first mip.
        halvings: u32,
        /// Mips.
        mips: u32,
    },
    /// A Gaussian without a width.
    #[error("a Gaussian of a deviation that is none, or beyond 256 samples")]
    Deviation,
}

/// Pseudo-distances at the middles of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Mip {
    /// Cells along x, y and z.
    pub size: [usize; 3],
    /// Width of a cell in cells of the binary volume.
    pub cell: usize,
    /// By cell, x fastest, in cells of the binary volume; positive outside.
    pub values: Vec<f32>,
}

impl Mip {
    /// The value of a cell.
    pub fn at(&self, [i, j, k]: [usize; 3]) -> f32 {
        self.values[i + self.size[0] * (j + self.size[1] * k)]
    }
}

/// The pseudo-distances of a binary volume, x fastest: blurred and halved so often (`halvings`, 2 from 512 cells to 128), then once more for each mip
/// behind the first. Beyond the volume its outermost cells go on.
///
/// # Errors
/// Not one mark a cell, sides that are no multiples of what they are halved by, no mip.
pub fn pseudo_distances(
    size: [usize; 3],
    inside: &[bool],
    halvings: u32,
    mips: u32,
) -> Result<Vec<Mip>, PseudoError> {
    if halvings == 0 || mips == 0 || halvings + mips > 10 {
        return Err(PseudoError::Mips { halvings, mips });
    }
    let times = halvings + mips - 1;
    let fits = |n: &usize| (1..=MOST).contains(n) && n.is_multiple_of(1 << times);
    if !size.iter().all(fits) {
        return Err(PseudoError::Size { size, times });
    }
    if size.iter().product::<usize>() != inside.len() {
        let marks = inside.len();
        return Err(PseudoError::Count { size, marks });
    }
    let mut shares = halved(size, |n| f32::from(u8::from(inside[n])));
    let (mut size, mut found) = (size.map(|n| n / 2), Vec::new());
    for done in 1..=times {
        if done >= halvings {
            let far = reach(done);
            let distance = |share: &f32| (0.5 - share) * far;
            found.push(Mip {
                size,
                cell: 1 << done,
                values: shares.par_iter().map(distance).collect(),
            });
        }
        if done < times {
            let before = std::mem::take(&mut shares);
            shares = halved(size, |n| before[n]);
            size = size.map(|n| n / 2);
        }
    }
    Ok(found)
}

/// What makes the slope of a blurred flat face 1 where it is: the deviation of the blur, in cells of the binary volume, times the root of tau.
fn reach(halvings: u32) -> f32 {
    // of a cell itself, and of each halving: 3/4 of the square of its cells
    let blurs: f32 = (0..halvings).map(|k| 0.75 * 4f32.powi(k as i32)).sum();
    ((blurs + 1.0 / 12.0) * std::f32::consts::TAU).sqrt()
}

/// Pairs of cells along each axis, mixed with the cell before and the one behind.
fn halved(size: [usize; 3], at: impl Fn(usize) -> f32 + Sync) -> Vec<f32> {
    let [nx, ny, nz] = size;
    let [hx, hy, hz] = size.map(|n| n / 2);
    // along x and y, slice by slice
    let mut flat = vec![0.0; hx * hy * nz];
    let slices = flat.par_chunks_mut(hx * hy).enumerate();
    slices.for_each_init(
        || vec![0.0; hx * ny],
        |narrow, (k, out)| {
            for (j, row) in narrow.chunks_mut(hx).enumerate() {
                let first = nx * (j + ny * k);
                for (i, x) in row.iter_mut().enumerate() {
                    let [a, b, c, d] = around(i, nx).map(|i| at(first + i));
                    *x = mixed(a, b, c, d);
                }
            }
            for (j, out) in out.chunks_mut(hx).enumerate() {
                rows(out, narrow, around(j, ny), hx);
            }
        },
    );
    let mut out = vec![0.0; hx * hy * hz];
    out.par_chunks_mut(hx * hy)
        .enumerate()
        .for_each(|(k, out)| rows(out, &flat, around(k, nz), hx * hy));
    out
}

/// The four cells that half cell number `i` is made of.
fn around(i: usize, count: usize) -> [usize; 4] {
    let first = 2 * i;
    [
        first.saturating_sub(1),
        first,
        first + 1,
        (first + 2).min(count - 1),
    ]
}

fn mixed(a: f32, b: f32, c: f32, d: f32) -> f32 {
    0.375 * (b + c) + 0.125 * (a + d)
}

/// Four rows of so many numbers, mixed.
fn rows(out: &mut [f32], from: &[f32], which: [usize; 4], width: usize) {
    let [a, b, c, d] = which.map(|number| &from[number * width..][..width]);
    for i in 0..width {
        out[i] = mixed(a[i], b[i], c[i], d[i]);
    }
}

/// Samples, x fastest, blurred by a Gaussian of this deviation, in samples, along each axis: its width is the size of the creases that curvature shows
/// (Evans 2006, 9.5). Beyond the ends the outermost samples go on.
///
/// # Errors
/// Not one value a sample, a deviation that is none or beyond 256.
pub fn gaussian(size: [usize; 3], values: &[f32], deviation: f32) -> Result<Vec<f32>, PseudoError> {
    // also refuses NaN
    if !(deviation > 0.0 && deviation <= 256.0) {
        return Err(PseudoError::Deviation);
    }
    if size.iter().product::<usize>() != values.len() || values.is_empty() {
        let marks = values.len();
        return Err(PseudoError::Count { size, marks });
    }
    let reach = (4.0 * deviation).ceil() as usize;
    let weight = |k: usize| (-0.5 * (k as f32 / deviation).powi(2)).exp();
    let half: Vec<f32> = (0..=reach).map(weight).collect();
    let all = half[0] + 2.0 * half[1..].iter().sum::<f32>();
    let half: Vec<f32> = half.iter().map(|w| w / all).collect();
    let [nx, ny, nz] = size;
    // along an axis whose samples are `stride` apart in a part of `count` of them
    let along = |from: &[f32], out: &mut [f32], stride: usize, count: usize| {
        for (n, x) in out.iter_mut().enumerate() {
            let (i, first) = (n / stride % count, n % stride);
            let at = |i: usize| from[first + stride * i];
            let mut sum = half[0] * at(i);
            for (k, w) in half.iter().enumerate().skip(1) {
                sum += w * (at(i.saturating_sub(k)) + at((i + k).min(count - 1)));
            }
            *x = sum;
        }
    };
    let mut flat = vec![0.0; values.len()];
    let slices = flat.par_chunks_mut(nx * ny).zip(values.par_chunks(nx * ny));
    slices.for_each_init(
        || vec![0.0; nx * ny],
        |narrow, (out, slice)| {
            for (out, row) in narrow.chunks_mut(nx).zip(slice.chunks(nx)) {
                along(row, out, 1, nx);
            }
            along(narrow, out, nx, ny);
        },
    );
    let mut out = vec![0.0; values.len()];
    out.par_chunks_mut(nx * ny)
        .enumerate()
        .for_each(|(k, out)| {
            for (n, x) in out.iter_mut().enumerate() {
                let at = |k: usize| flat[n + nx * ny * k];
                let mut sum = half[0] * at(k);
                for (by, w) in half.iter().enumerate().skip(1) {
                    sum += w * (at(k.saturating_sub(by)) + at((k + by).min(nz - 1)));
                }
                *x = sum;
            }
        });
    Ok(out)
}
