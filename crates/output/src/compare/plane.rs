//! Planes of numbers and separable filters over them.

use crate::picture::Picture;

/// A plane of numbers, row by row from the top left.
#[derive(Clone, Debug)]
pub(super) struct Raster {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) numbers: Vec<f32>,
}

impl Raster {
    /// One number a pixel.
    pub(super) fn of(picture: &Picture, number: impl Fn([f32; 3]) -> f32) -> Raster {
        let numbers = picture.pixels().iter().map(|&p| number(p)).collect();
        Raster {
            width: picture.width() as usize,
            height: picture.height() as usize,
            numbers,
        }
    }

    /// Number by number of two planes of one size.
    pub(super) fn zip(&self, other: &Raster, f: impl Fn(f32, f32) -> f32) -> Raster {
        let numbers = self
            .numbers
            .iter()
            .zip(&other.numbers)
            .map(|(&a, &b)| f(a, b))
            .collect();
        Raster { numbers, ..*self }
    }

    /// The plane filtered along its rows with one kernel and along its columns with another, both of odd length. Beyond
    /// the border the nearest number counts.
    pub(super) fn filtered(&self, along: &[f32], across: &[f32]) -> Raster {
        let (width, height) = (self.width, self.height);
        let mut rows = Vec::with_capacity(self.numbers.len());
        let radius = along.len() / 2;
        let mut padded = vec![0.0; width + 2 * radius];
        for row in self.numbers.chunks_exact(width) {
            padded[..radius].fill(row[0]);
            padded[radius..radius + width].copy_from_slice(row);
            padded[radius + width..].fill(row[width - 1]);
            rows.extend(
                padded
                    .windows(along.len())
                    .map(|w| w.iter().zip(along).map(|(a, b)| a * b).sum::<f32>()),
            );
        }
        let radius = across.len() / 2;
        let mut numbers = vec![0.0; self.numbers.len()];
        for (y, out) in numbers.chunks_exact_mut(width).enumerate() {
            for (k, &weight) in across.iter().enumerate() {
                let from = (y + k).saturating_sub(radius).min(height - 1) * width;
                for (sum, x) in out.iter_mut().zip(&rows[from..from + width]) {
                    *sum += weight * x;
                }
            }
        }
        Raster { numbers, ..*self }
    }
}

/// Samples of a function at -radius to radius.
pub(super) fn kernel(radius: usize, f: impl Fn(f32) -> f32) -> Vec<f32> {
    (0..=2 * radius)
        .map(|i| f(i as f32 - radius as f32))
        .collect()
}

/// A kernel whose positive numbers sum to 1 and whose negative ones, if any, to -1.
pub(super) fn normalised(mut kernel: Vec<f32>) -> Vec<f32> {
    let positive: f32 = kernel.iter().filter(|x| **x > 0.0).sum();
    let negative: f32 = -kernel.iter().filter(|x| **x < 0.0).sum::<f32>();
    for x in &mut kernel {
        *x /= if *x > 0.0 {
            positive
        } else {
            negative.max(f32::MIN_POSITIVE)
        };
    }
    kernel
}
