//! Noise over space with proven ranges and slopes: for displacement and for procedural materials.
//!
//! All noises live on the lattice of whole numbers, draw from its [`struct@Hash`] (the same bits in every number type) and so repeat
//! after 289 cells along every axis.
//!
//! # Ranges and slopes
//!
//! In one cell let `x` be the place in it, `f(x) = 6 x^5 - 15 x^4 + 10 x^3` the fade (Perlin 2002), and pick a corner `c` at
//! random: `c_i = 1` with probability `f_i = f(x_i)`, each axis on its own. Interpolation between corner values `h_c` is then
//! the expectation `V = E[h_c]`, and by Parseval in the basis of this product measure (O'Donnell 2014, Analysis of Boolean
//! Functions, section 8.4), with `D_i` the slope of `V` in `f_i`,
//!
//! `sum_i f_i (1 - f_i) D_i^2 <= Var[h_c]`.
//!
//! **Value noise.** `|h| <= 1`, so `|V| <= 1` and `Var <= 1`, and as the gradient is `f'_i D_i`,
//! `|grad V|^2 <= max f'^2 / (f (1 - f)) = 225 / 16`, taken at `x = 1/2`: the slope is at most 15/4. Corners that differ along
//! one axis alone reach it.
//!
//! **Gradient noise.** `h_c = g_c . d_c` with unit vectors `g_c` and `d_c = x - c`. As
//! `E[|d|^2] = sum_i C(x_i)` with `C(x) = (1 - f) x^2 + f (1 - x)^2 <= 1/4`, Jensen gives `|V| <= sqrt(3) / 2`. Along a unit
//! vector `u` the slope is `E[g_c . (u + xi d_c)]` with `xi = sum_i u_i eta_i`, where `eta_i` is `f'_i / f_i` for `c_i = 1` and
//! `-f'_i / (1 - f_i)` for `c_i = 0`. Its square is at most `E[|u + xi d|^2]`, in which all mixed terms vanish because
//! `E[eta_i] = 0`, and what is left is `sum_i u_i^2 (A(x_i) + B(x_i) sum_{j != i} C(x_j))` with `A = E[(1 + eta d)^2]` and
//! `B = E[eta^2] = f'^2 / (f (1 - f))`. So the slope is at most `max sqrt(A + B / 2) = 3.3791` (at `x = 0.193`). Dividing by
//! `sqrt(3) / 2` makes the range [-1, 1] and the slope 3.9018.
//!
//! **Cellular noise** (Worley 1996, F1): one point in every cell, anywhere in it. The nearest point in the 27 cells around is
//! the nearest of all unless it is farther than 1, so the distance, cut at 1, is exact: it lies in [0, 1] and its slope
//! is at most 1.
//!
//! **Fractal sums** are averages of octaves weighted by `gain^i`, so the range stays and the slope follows: [`fbm_slope`].

use zeroset_number::{Hash, Real, Vec3, v3};

/// A noise: its formula and what is proven of it.
pub trait Noise: 'static {
    /// Name in the scene language.
    const NAME: &'static str;
    /// One line.
    const DOC: &'static str;
    /// Smallest and largest value.
    const RANGE: (f64, f64);
    /// Largest slope.
    const SLOPE: f64;
    /// The value at `p`, in whose units a cell of the lattice is 1 wide.
    fn noise<R: Real>(p: Vec3<R>) -> R;
}

/// Random values at the lattice points, smoothly joined.
pub struct ValueNoise;

/// Random slopes at the lattice points, smoothly joined (Perlin 1985, 2002).
pub struct GradientNoise;

/// Distance to the nearest of random points, one in each cell (Worley 1996).
pub struct CellularNoise;

impl Noise for ValueNoise {
    const NAME: &'static str = "value";
    const DOC: &'static str = "Random values at lattice points, smoothly joined: soft blotches.";
    const RANGE: (f64, f64) = (-1.0, 1.0);
    const SLOPE: f64 = 3.75;
    #[inline(always)]
    fn noise<R: Real>(p: Vec3<R>) -> R {
        value_noise(p)
    }
}

impl Noise for GradientNoise {
    const NAME: &'static str = "gradient";
    const DOC: &'static str = "Random slopes at lattice points, smoothly joined: even waves.";
    const RANGE: (f64, f64) = (-1.0, 1.0);
    const SLOPE: f64 = 3.9018;
    #[inline(always)]
    fn noise<R: Real>(p: Vec3<R>) -> R {
        gradient_noise(p)
    }
}

impl Noise for CellularNoise {
    const NAME: &'static str = "cellular";
    const DOC: &'static str =
        "Distance to the nearest of random points, one a cell: pebbles, scales.";
    const RANGE: (f64, f64) = (0.0, 1.0);
    const SLOPE: f64 = 1.0;
    #[inline(always)]
    fn noise<R: Real>(p: Vec3<R>) -> R {
        cellular_noise(p)
    }
}

/// The fade and the corners' mean under it: `h` holds the corners' values, x fastest, z slowest.
#[inline(always)]
fn interpolate<R: Real>(x: Vec3<R>, h: [R; 8]) -> R {
    let f = x.map(
        #[inline(always)]
        |t| t.sq() * t * ((t * 6.0 - 15.0) * t + 10.0),
    );
    let near = h[0].mix(h[1], f.x).mix(h[2].mix(h[3], f.x), f.y);
    let far = h[4].mix(h[5], f.x).mix(h[6].mix(h[7], f.x), f.y);
    near.mix(far, f.z)
}

/// The cell of `p`, the place in it, and the corners' hashes, x fastest, z slowest.
#[inline(always)]
fn corners<R: Real>(p: Vec3<R>) -> (Vec3<R>, [Hash<R>; 8]) {
    let c = p.floor();
    let x = [Hash::of1(c.x), Hash::of1(c.x + 1.0)];
    let xy = [
        x[0].and(c.y),
        x[1].and(c.y),
        x[0].and(c.y + 1.0),
        x[1].and(c.y + 1.0),
    ];
    let z = c.z + 1.0;
    let hashes = [
        xy[0].and(c.z),
        xy[1].and(c.z),
        xy[2].and(c.z),
        xy[3].and(c.z),
        xy[0].and(z),
        xy[1].and(z),
        xy[2].and(z),
        xy[3].and(z),
    ];
    (p - c, hashes)
}

/// Value noise at `p`: in [-1, 1], with a slope of at most 15/4.
#[inline(always)]
pub fn value_noise<R: Real>(p: Vec3<R>) -> R {
    let slope = ValueNoise::SLOPE as f32;
    let v = R::bounded_slope(
        p,
        slope,
        #[inline(always)]
        |p| {
            let (x, hashes) = corners(p);
            let mut h = [x.x; 8];
            for c in 0..8 {
                h[c] = hashes[c].unit() * 2.0 - 1.0;
            }
            interpolate(x, h)
        },
    );
    v.proven(-1.0, 1.0, p, slope)
}

/// A unit vector from a hash: the 17 by 17 grid of the square, folded to an octahedron and pushed out to the sphere.
#[inline(always)]
fn direction<R: Real>(h: Hash<R>) -> Vec3<R> {
    let s = h.square();
    let z = (s.x.abs() + s.y.abs()).one_minus();
    let below = (-z).max(0.0);
    v3(s.x - below.copysign(s.x), s.y - below.copysign(s.y), z).normalize()
}

/// Gradient noise at `p`: in [-1, 1], with a slope of at most 3.9018; 0 at the lattice points.
#[inline(always)]
pub fn gradient_noise<R: Real>(p: Vec3<R>) -> R {
    let slope = GradientNoise::SLOPE as f32;
    let v = R::bounded_slope(
        p,
        slope,
        #[inline(always)]
        |p| {
            let (x, hashes) = corners(p);
            let mut h = [x.x; 8];
            for c in 0..8 {
                let bit = |axis: usize| (c >> axis & 1) as f32;
                h[c] = direction(hashes[c]).dot(x - v3(bit(0), bit(1), bit(2)));
            }
            interpolate(x, h) * R::constant(2.0 / 3f64.sqrt())
        },
    );
    v.proven(-1.0, 1.0, p, slope)
}

/// Cellular noise at `p`: the distance to the nearest of random points, one in each cell, cut at 1. In [0, 1], with a slope of
/// at most 1.
#[inline(always)]
pub fn cellular_noise<R: Real>(p: Vec3<R>) -> R {
    let v = R::bounded_slope(
        p,
        1.0,
        #[inline(always)]
        |p| nearest(p),
    );
    v.proven(0.0, 1.0, p, 1.0)
}

/// The distance to the nearest of the points in the 27 cells around `p`, cut at 1.
#[inline(always)]
fn nearest<R: Real>(p: Vec3<R>) -> R {
    let c = p.floor();
    let x = p - c;
    // a loop over the three layers along x; the offset from p to the layer's cells goes along
    let (_, _, nearest) = R::repeat_while(
        R::constant(3.0),
        (c.x - 1.0, -x.x - 1.0, x.x.lit(1.0)),
        #[inline(always)]
        |(layer, _, _)| layer.below(f32::MAX),
        #[inline(always)]
        |(layer, at, nearest)| {
            let mut nearest = nearest;
            let h = Hash::of1(layer);
            for y in [-1.0, 0.0, 1.0] {
                let h = h.and(c.y + y);
                for z in [-1.0, 0.0, 1.0] {
                    let h = h.and(c.z + z);
                    let (s, t) = (h.square(), h.next().unit());
                    let d = v3(
                        s.x * 0.5 + 0.5 + at,
                        s.y * 0.5 + (0.5 + y) - x.y,
                        t + z - x.z,
                    );
                    nearest = nearest.min(d.length_squared());
                }
            }
            (layer + 1.0, at + 1.0, nearest)
        },
    );
    nearest.sqrt()
}

/// The mean of `octaves` (at least 1) layers of the noise `N`, each finer by `lacunarity` and weaker by `gain` than the one
/// before: in the range of `N`, with a slope of at most [`fbm_slope`]. (Mandelbrot and van Ness 1968; Musgrave 1993.)
///
/// Each layer is turned and moved against the last, so that their lattices do not show.
#[inline(always)]
pub fn fbm<N: Noise, R: Real>(
    p: Vec3<R>,
    octaves: R::Scalar,
    lacunarity: R::Scalar,
    gain: R::Scalar,
) -> R {
    let one = p.x.lit(1.0);
    let (_, _, sum, weights) = R::repeat_while(
        octaves,
        (p, one, p.x.lit(0.0), p.x.lit(0.0)),
        #[inline(always)]
        |(q, _, _, _)| q.x.below(f32::MAX),
        #[inline(always)]
        |(q, weight, sum, weights)| {
            let sum = sum + N::noise(q) * weight;
            // (2, -1, 2), (2, 2, -1), (-1, 2, 2) over 3: a rotation
            let turned = v3(
                (q.x + q.z) * 2.0 - q.y,
                (q.x + q.y) * 2.0 - q.z,
                (q.y + q.z) * 2.0 - q.x,
            );
            let finer = turned * (lacunarity / 3.0) + v3(19.1, 7.7, 13.3);
            (finer, weight * gain, sum, weights + weight)
        },
    );
    let (lo, hi) = (N::RANGE.0 as f32, N::RANGE.1 as f32);
    (sum / weights).proven(lo, hi, p, f32::INFINITY)
}

/// Largest slope of [`fbm`]: `SLOPE sum (gain lacunarity)^i / sum gain^i`.
pub fn fbm_slope<N: Noise>(octaves: f64, lacunarity: f64, gain: f64) -> f64 {
    let (mut slopes, mut weights, mut slope, mut weight) = (0.0, 0.0, 1.0, 1.0);
    for _ in 0..octaves as u32 {
        slopes += slope;
        weights += weight;
        slope *= gain * lacunarity;
        weight *= gain;
    }
    N::SLOPE * slopes / f64::max(weights, 1e-30)
}

#[cfg(test)]
mod tests;
