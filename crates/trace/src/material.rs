//! What colour a surface has where.

use crate::simd::{constant, each, splat3};
use fearless_simd::{Simd, prelude::*};
use zeroset_catalogue::noise::gradient_noise;
use zeroset_number::{Lanes, Real, Vec3, v3};
use zeroset_scene::material::{Image, Pattern};

/// A place on a surface, as far as its colour depends on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<R> {
    pub(crate) point: Vec3<R>,
    pub(crate) normal: Vec3<R>,
    /// How far the point moves from one ray to the next, at most, along each axis.
    pub(crate) footprint: Vec3<R>,
    /// How near the orbit of a fractal came to its traps.
    pub(crate) orbit: [R; 4],
}

impl<R: Real<Scalar = f32>> Place<R> {
    /// The place where a ray of direction `d` and width `pixel` meets a surface.
    ///
    /// On the surface the pixel is an ellipse: as wide as the ray across, and longer by the cosine along the view.
    #[inline(always)]
    pub(crate) fn new(point: Vec3<R>, normal: Vec3<R>, d: Vec3<R>, pixel: R) -> Self {
        let cosine = normal.dot(d).abs().max(0.05);
        let along = d - normal * normal.dot(d);
        let along = along / along.length().max(1e-6);
        let longer = cosine.recip() - 1.0;
        let (n, a) = (normal.array(), along.array());
        let footprint = each(
            #[inline(always)]
            |k| pixel * (n[k].sq().one_minus().max(0.0).sqrt() + a[k].abs() * longer),
        );
        Place {
            point,
            normal,
            footprint,
            orbit: [pixel.lit(0.0); 4],
        }
    }

    /// The same place with the orbit of a fractal.
    #[inline(always)]
    pub(crate) fn with_orbit(self, orbit: [R; 4]) -> Self {
        Place { orbit, ..self }
    }
}

/// Numbers of which each can be treated on its own.
pub(crate) trait PerLane: Real<Scalar = f32> {
    /// `f` of every lane.
    fn each(
        point: Vec3<Self>,
        normal: Vec3<Self>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<Self>;
}

impl PerLane for f32 {
    fn each(
        point: Vec3<f32>,
        normal: Vec3<f32>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<f32> {
        let c = f(point.array(), normal.array());
        v3(c[0], c[1], c[2])
    }
}

impl<S: Simd> PerLane for Lanes<S> {
    #[inline(always)]
    fn each(
        point: Vec3<Self>,
        normal: Vec3<Self>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<Self> {
        let mut out = splat3(point.x.0.token(), [0.0; 3]);
        let (p, n) = (point.array(), normal.array());
        for i in 0..S::f32s::LEN {
            let c = f(
                [p[0].0[i], p[1].0[i], p[2].0[i]],
                [n[0].0[i], n[1].0[i], n[2].0[i]],
            );
            (out.x.0[i], out.y.0[i], out.z.0[i]) = (c[0], c[1], c[2]);
        }
        out
    }
}

/// Share of a feature's size that a point is moved into the surface: the faces of solids like to lie on the borders of
/// cubes and bands.
const INWARDS: f32 = 1e-3;

/// Distance to an orbit trap within which nearer makes little difference.
const TRAP: f32 = 0.08;

/// The linear colour of a pattern at a place.
#[inline(always)]
pub(crate) fn colour<R: PerLane>(pattern: &Pattern, at: &Place<R>) -> Vec3<R> {
    let x = at.point.x;
    match pattern {
        Pattern::Solid { colour } => constant(x, colour.to_array()),
        Pattern::Checker { colours, size } => {
            let p = (at.point - at.normal * (size * INWARDS)) / *size;
            let w = at.footprint / *size;
            let even = square_wave(p.x, w.x) * square_wave(p.y, w.y) * square_wave(p.z, w.z);
            between(colours, even * 0.5 + 0.5)
        }
        Pattern::Stripes {
            colours,
            direction,
            size,
        } => {
            let to = v3(direction.x, direction.y, direction.z);
            let p = (at.point - at.normal * (size * INWARDS)).dot(to) / *size;
            let w = at.footprint.dot(to.abs()) / *size;
            between(colours, square_wave(p, w) * 0.5 + 0.5)
        }
        Pattern::Noise {
            colours,
            size,
            octaves,
        } => {
            let (mut sum, mut share) = (x.lit(0.0), 1.0);
            let mut p = at.point / *size;
            let mut w = at.footprint.length() / *size;
            let mut total = 0.0;
            for octave in 0..(*octaves).clamp(1, 8) {
                // features finer than a pixel fade to their mean, which is zero
                let seen = (w * 2.0).one_minus().clamp01();
                sum = sum + gradient_noise(p) * seen * share;
                total += share;
                // turned and moved, so that the lattices of the octaves do not meet
                p = v3(p.y * 0.8 + p.z * 0.6, p.x, p.y * 0.6 - p.z * 0.8) * 2.0
                    + v3(0.37, 0.61, 0.13 + octave as f32);
                w = w * 2.0;
                share *= 0.5;
            }
            between(colours, (sum * (0.8 / total) + 0.5).clamp01())
        }
        Pattern::Gradient { colours, from, to } => {
            let way = *to - *from;
            let p = at.point - v3(from.x, from.y, from.z);
            let t = p.dot(v3(way.x, way.y, way.z)) / way.length_squared().max(f32::MIN_POSITIVE);
            between(colours, t.clamp01())
        }
        Pattern::Triplanar {
            image,
            size,
            sharpness,
        } => R::each(
            at.point,
            at.normal,
            #[inline(always)]
            |p, n| triplanar(image, *size, *sharpness, p, n),
        ),
        Pattern::Orbit { colours } => {
            // the nearer a trap, the more its colour counts
            let weights = at.orbit.map(
                #[inline(always)]
                |t| (t.sq() + TRAP * TRAP).recip(),
            );
            let total = weights[0] + weights[1] + weights[2] + weights[3];
            each(
                #[inline(always)]
                |k| {
                    let sum = weights[0] * colours[0][k]
                        + weights[1] * colours[1][k]
                        + weights[2] * colours[2][k]
                        + weights[3] * colours[3][k];
                    sum / total
                },
            )
        }
    }
}

#[inline(always)]
fn between<R: Real<Scalar = f32>>(colours: &[glam::Vec3; 2], t: R) -> Vec3<R> {
    each(
        #[inline(always)]
        |k| t * (colours[1][k] - colours[0][k]) + colours[0][k],
    )
}

/// 1 in even cells of size 1 and -1 in odd ones, averaged over `w` around `x` (the difference of two values of its integral,
/// a triangle wave).
#[inline(always)]
fn square_wave<R: Real<Scalar = f32>>(x: R, w: R) -> R {
    let w = w.max(1e-4);
    let mean = (triangle_wave(x - w * 0.5) - triangle_wave(x + w * 0.5)) * 2.0 / w;
    mean.clamp(-1.0, 1.0)
}

#[inline(always)]
fn triangle_wave<R: Real<Scalar = f32>>(x: R) -> R {
    ((x * 0.5).fract() - 0.5).abs()
}

/// The image along the three axes, weighted by the normal.
fn triplanar(image: &Image, size: f32, sharpness: f32, p: [f32; 3], n: [f32; 3]) -> [f32; 3] {
    let mut sum = glam::Vec3::ZERO;
    let mut weights = 0.0;
    // relative to the largest part: high powers of all three may be too small for a number
    let steepest = n[0].abs().max(n[1].abs()).max(n[2].abs());
    for k in 0..3 {
        let weight = (n[k].abs() / steepest.max(f32::MIN_POSITIVE)).powf(sharpness);
        if weight < 1e-4 {
            continue;
        }
        // across and down as they are seen from outside
        let (u, v) = match k {
            0 => (-p[2] * n[0].signum(), -p[1]),
            1 => (p[0], p[2] * n[1].signum()),
            _ => (p[0] * n[2].signum(), -p[1]),
        };
        sum += texel(image, u / size, v / size) * weight;
        weights += weight;
    }
    (sum / weights.max(f32::MIN_POSITIVE)).to_array()
}

/// The colour of an endlessly repeated image, between its four nearest pixels.
fn texel(image: &Image, u: f32, v: f32) -> glam::Vec3 {
    let (width, height) = (image.width as usize, image.height as usize);
    if width == 0 || height == 0 || image.pixels.len() < width * height {
        return glam::Vec3::ZERO;
    }
    let (x, y) = (
        (u - u.floor()) * width as f32 - 0.5,
        (v - v.floor()) * height as f32 - 0.5,
    );
    let (i, j) = (x.floor(), y.floor());
    let at = |dx: f32, dy: f32| {
        let x = (i + dx).rem_euclid(width as f32) as usize;
        let y = (j + dy).rem_euclid(height as f32) as usize;
        image.pixels[y.min(height - 1) * width + x.min(width - 1)]
    };
    let (a, b) = (
        at(0.0, 0.0).lerp(at(1.0, 0.0), x - i),
        at(0.0, 1.0).lerp(at(1.0, 1.0), x - i),
    );
    a.lerp(b, y - j)
}
