//! Structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004).

use super::plane::{Raster, kernel, normalised};
use crate::picture::Picture;

/// Radius of the window, pixels.
const RADIUS: usize = 5;
/// Standard deviation of the window, pixels.
const SIGMA: f32 = 1.5;

/// Mean structural similarity of the luma (ITU-R BT.709) of two pictures of one size, with the Gaussian window and the
/// constants of the paper; 1 for equal pictures. As in the paper, only windows inside the picture count; where there is
/// none, the border is continued.
pub(super) fn ssim(a: &Picture, b: &Picture) -> f64 {
    let luma = |[r, g, b]: [f32; 3]| 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let window = normalised(kernel(RADIUS, |x| (-x * x / (2.0 * SIGMA * SIGMA)).exp()));
    let mean = |grid: &Raster| grid.filtered(&window, &window).numbers;
    let (x, y) = (Raster::of(a, luma), Raster::of(b, luma));
    let (mx, my) = (mean(&x), mean(&y));
    let (xx, yy, xy) = (
        mean(&x.zip(&x, |a, b| a * b)),
        mean(&y.zip(&y, |a, b| a * b)),
        mean(&x.zip(&y, |a, b| a * b)),
    );
    let (c1, c2) = (0.01f32.powi(2), 0.03f32.powi(2));
    let at = |i: usize| {
        let (vx, vy, cov) = (
            xx[i] - mx[i] * mx[i],
            yy[i] - my[i] * my[i],
            xy[i] - mx[i] * my[i],
        );
        f64::from(
            (2.0 * mx[i] * my[i] + c1) * (2.0 * cov + c2)
                / ((mx[i] * mx[i] + my[i] * my[i] + c1) * (vx.max(0.0) + vy.max(0.0) + c2)),
        )
    };
    let inner = |n: usize| {
        if n > 2 * RADIUS {
            RADIUS..n - RADIUS
        } else {
            0..n
        }
    };
    let (columns, rows) = (inner(x.width), inner(x.height));
    let count = columns.len() * rows.len();
    let places = rows.flat_map(|row| columns.clone().map(move |column| row * x.width + column));
    places.map(at).sum::<f64>() / count as f64
}
