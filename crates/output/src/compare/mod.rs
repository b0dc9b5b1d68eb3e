//! How different two pictures are: by number, by structure, and to the eye.

mod flip;
mod plane;
mod ssim;

use crate::picture::Picture;
use crate::view::{Legend, Scale, map};

/// How different two pictures of one size are. Numbers are of sRGB values between 0 and 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Root of the mean squared difference of all channels.
    pub rmse: f64,
    /// Peak signal to noise ratio, decibels; infinite for equal pictures.
    pub psnr: f64,
    /// Largest difference of a channel.
    pub largest: f64,
    /// Mean structural similarity of the luma (Wang et al. 2004); 1 for equal pictures.
    pub ssim: f64,
    /// Mean of the FLIP map (Andersson et al. 2020); 0 for equal pictures, at most 1.
    pub flip_mean: f64,
    /// 99 of 100 pixels of the FLIP map are at most this.
    pub flip_p99: f64,
    /// The FLIP map: the difference that is seen at each pixel, row by row from the top left.
    pub flip: Vec<f32>,
}

/// Why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CompareError {
    /// They have different sizes.
    #[error("the pictures have different sizes, {}x{} and {}x{}", .0[0], .0[1], .1[0], .1[1])]
    Sizes([u32; 2], [u32; 2]),
    /// They have no pixels.
    #[error("the pictures have no pixels")]
    Empty,
}

/// Compares a picture with a reference.
///
/// # Errors
/// Different sizes, no pixels.
pub fn compare(reference: &Picture, test: &Picture) -> Result<Comparison, CompareError> {
    let size = |p: &Picture| [p.width(), p.height()];
    if size(reference) != size(test) {
        return Err(CompareError::Sizes(size(reference), size(test)));
    }
    if reference.pixels().is_empty() {
        return Err(CompareError::Empty);
    }
    let pairs = reference
        .pixels()
        .as_flattened()
        .iter()
        .zip(test.pixels().as_flattened());
    let (mut squares, mut largest) = (0.0f64, 0.0f64);
    for (a, b) in pairs {
        let difference = f64::from(a - b).abs();
        squares += difference * difference;
        largest = largest.max(difference);
    }
    let mean_square = squares / (3 * reference.pixels().len()) as f64;
    let flip = flip::flip(reference, test);
    let mut sorted = flip.clone();
    let rank = ((sorted.len() as f64 * 0.99).ceil() as usize).clamp(1, sorted.len()) - 1;
    let (_, p99, _) = sorted.select_nth_unstable_by(rank, f32::total_cmp);
    Ok(Comparison {
        width: reference.width(),
        height: reference.height(),
        rmse: mean_square.sqrt(),
        psnr: -10.0 * mean_square.log10(),
        largest,
        ssim: ssim::ssim(reference, test),
        flip_mean: flip.iter().map(|x| f64::from(*x)).sum::<f64>() / flip.len() as f64,
        flip_p99: f64::from(*p99),
        flip,
    })
}

impl Comparison {
    /// The FLIP map as a picture, from black (no difference) over red to white, with a legend.
    pub fn picture(&self) -> Picture {
        let legend = Legend::new(
            "FLIP",
            Scale::Linear(0.0, 1.0),
            |t| map(colorous::MAGMA, t),
            None,
        );
        let width = self.width as usize;
        legend.beside(Picture::from_fn(self.width, self.height, |x, y| {
            legend.colour(self.flip[y as usize * width + x as usize])
        }))
    }
}
