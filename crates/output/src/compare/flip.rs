//! FLIP (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020): how much a person who flips between
//! two pictures sees change, pixel by pixel. Section and equation numbers are the paper's.

use super::plane::{Raster, kernel, normalised};
use crate::picture::Picture;
use crate::tone;
use std::f32::consts::{FRAC_1_SQRT_2, PI};

/// Pixels per degree of the visual field: a screen 0.7 m wide with 3840 columns, seen from 0.7 m (section 4).
const PIXELS_PER_DEGREE: f32 = 3840.0 * PI / 180.0;
/// Exponent of the colour difference (section 4.1.3).
const COLOUR_EXPONENT: f32 = 0.7;
/// Share of the largest colour difference that is spread over ...
const KNEE: f32 = 0.4;
/// ... this share of the result (equation 13).
const KNEE_VALUE: f32 = 0.95;
/// Width of the features that are detected, degrees (section 4.2).
const FEATURE_WIDTH: f32 = 0.082;
/// Exponent of the feature difference (equation 16).
const FEATURE_EXPONENT: f32 = 0.5;

/// Contrast sensitivity as sums of Gaussians (table 1): weight and width of each, for the lightness and the two opponent
/// colours.
const SENSITIVITY: [&[(f32, f32)]; 3] = [
    &[(1.0, 0.0047)],
    &[(1.0, 0.0053)],
    &[(34.1, 0.04), (13.5, 0.025)],
];

/// The difference seen at each pixel of two pictures of one size: 0 none, 1 the largest.
pub(super) fn flip(reference: &Picture, test: &Picture) -> Vec<f32> {
    let (a, b) = (perceived(reference), perceived(test));
    let (features_a, features_b) = (Features::of(reference), Features::of(test));
    let largest = hyab(hunt([0.0, 1.0, 0.0]), hunt([0.0, 0.0, 1.0])).powf(COLOUR_EXPONENT);
    let knee = KNEE * largest;
    let pairs = a.into_iter().zip(b).enumerate();
    pairs
        .map(|(i, (a, b))| {
            let difference = hyab(a, b).powf(COLOUR_EXPONENT);
            let colour = if difference < knee {
                difference * KNEE_VALUE / knee
            } else {
                KNEE_VALUE + (difference - knee) / (largest - knee) * (1.0 - KNEE_VALUE)
            };
            let edges = (features_a.edges[i] - features_b.edges[i]).abs();
            let points = (features_a.points[i] - features_b.points[i]).abs();
            let feature = (FRAC_1_SQRT_2 * edges.max(points)).powf(FEATURE_EXPONENT);
            // equation 17
            colour.clamp(0.0, 1.0).powf(1.0 - feature.min(1.0))
        })
        .collect()
}

/// The picture as the eye resolves it, in Hunt-adjusted L*a*b* (sections 4.1.1 and 4.1.2).
fn perceived(picture: &Picture) -> Vec<[f32; 3]> {
    let filtered: [Raster; 3] = std::array::from_fn(|channel| {
        let plane = Raster::of(picture, |pixel| {
            opponent(xyz(pixel.map(tone::decode)))[channel]
        });
        // the width of the widest Gaussian serves all
        let radius = (3.0 * (0.04f32 / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
        let mut sum: Option<Raster> = None;
        let mut mass = 0.0;
        for &(weight, width) in SENSITIVITY[channel] {
            let gaussian = kernel(radius, |x| {
                (-(PI * x / PIXELS_PER_DEGREE).powi(2) / width).exp()
            });
            let weight = weight * (PI / width).sqrt() * gaussian.iter().sum::<f32>().powi(2);
            let gaussian = normalised(gaussian);
            let part = plane.filtered(&gaussian, &gaussian);
            mass += weight;
            sum = Some(match sum {
                None => part.zip(&part, |x, _| weight * x),
                Some(sum) => sum.zip(&part, |s, x| s + weight * x),
            });
        }
        let sum = sum.unwrap_or(plane);
        sum.zip(&sum, |x, _| x / mass)
    });
    let [y, cx, cz] = &filtered;
    (0..y.numbers.len())
        .map(|i| {
            let [x, y, z] = from_opponent([y.numbers[i], cx.numbers[i], cz.numbers[i]]);
            hunt(linear([x, y, z]).map(|c| c.clamp(0.0, 1.0)))
        })
        .collect()
}

/// How strong edges and points are at each pixel (section 4.2).
struct Features {
    edges: Vec<f32>,
    points: Vec<f32>,
}

impl Features {
    fn of(picture: &Picture) -> Features {
        let lightness = Raster::of(picture, |pixel| {
            (opponent(xyz(pixel.map(tone::decode)))[0] + 16.0) / 116.0
        });
        let sigma = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
        let radius = (3.0 * sigma).ceil() as usize;
        let gaussian = |x: f32| (-x * x / (2.0 * sigma * sigma)).exp();
        let blur = normalised(kernel(radius, gaussian));
        let first = normalised(kernel(radius, |x| -x * gaussian(x)));
        let second = normalised(kernel(radius, |x| {
            (x * x / (sigma * sigma) - 1.0) * gaussian(x)
        }));
        let magnitude = |derivative: &[f32]| {
            let along = lightness.filtered(derivative, &blur);
            along
                .zip(&lightness.filtered(&blur, derivative), f32::hypot)
                .numbers
        };
        Features {
            edges: magnitude(&first),
            points: magnitude(&second),
        }
    }
}

/// Distance of two Hunt-adjusted colours (Abasi, Amani Tehran and Fairchild 2020; equation 10).
fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

/// White: linear (1, 1, 1) as XYZ.
const WHITE: [f32; 3] = [0.950_456, 1.0, 1.089_058];

/// CIE XYZ of linear sRGB (IEC 61966-2-1).
fn xyz([r, g, b]: [f32; 3]) -> [f32; 3] {
    [
        0.412_391 * r + 0.357_584 * g + 0.180_481 * b,
        0.212_639 * r + 0.715_169 * g + 0.072_192 * b,
        0.019_331 * r + 0.119_195 * g + 0.950_532 * b,
    ]
}

/// Linear sRGB of CIE XYZ.
fn linear([x, y, z]: [f32; 3]) -> [f32; 3] {
    [
        3.240_97 * x - 1.537_383 * y - 0.498_611 * z,
        -0.969_244 * x + 1.875_968 * y + 0.041_555 * z,
        0.055_63 * x - 0.203_977 * y + 1.056_972 * z,
    ]
}

/// Lightness, red-green and blue-yellow of XYZ: YCxCz (Flohr, Kolpatzik, Balasubramanian, Carrara, Bouman and Allebach
/// 1993; equation 2).
fn opponent(xyz: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = [xyz[0] / WHITE[0], xyz[1] / WHITE[1], xyz[2] / WHITE[2]];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn from_opponent([lightness, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (lightness + 16.0) / 116.0;
    [
        (y + cx / 500.0) * WHITE[0],
        y * WHITE[1],
        (y - cz / 200.0) * WHITE[2],
    ]
}

/// L*a*b* of linear sRGB, with the chroma less the darker it is (Hunt's effect, equation 9).
fn hunt(rgb: [f32; 3]) -> [f32; 3] {
    let delta = 6.0f32 / 29.0;
    let f = |t: f32| {
        if t > delta.powi(3) {
            t.cbrt()
        } else {
            t / (3.0 * delta * delta) + 4.0 / 29.0
        }
    };
    let [x, y, z] = xyz(rgb);
    let [x, y, z] = [f(x / WHITE[0]), f(y / WHITE[1]), f(z / WHITE[2])];
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}
