//! What colour a surface has where: patterns, averaged over the footprint of a pixel.

use crate::{each, parameters};
use fearless_simd::{Simd, prelude::*};
use zeroset_catalogue::noise::gradient_noise;
use zeroset_number::{Lanes, Ops, Real, Vec2, Vec3, v2, v3};
use zeroset_scene::material::{Image, Pattern};

/// A place on a surface, as far as its colour depends on it.
#[derive(Clone, Copy, Debug)]
pub struct Place<R> {
    /// Where it is.
    pub point: Vec3<R>,
    /// The unit normal.
    pub normal: Vec3<R>,
    /// How far the point moves from one ray to the next, at most, along each axis.
    pub footprint: Vec3<R>,
    /// How near the orbit of a fractal came to its traps.
    pub orbit: [R; 4],
}

impl<R: Real> Place<R> {
    /// The place where a ray of direction `d` and width `pixel` meets a surface.
    #[inline(always)]
    pub fn new(point: Vec3<R>, normal: Vec3<R>, d: Vec3<R>, pixel: R) -> Self {
        Place {
            point,
            normal,
            footprint: footprint(normal, d, pixel),
            orbit: [pixel.lit(0.0); 4],
        }
    }

    /// The same place with the orbit of a fractal.
    #[inline(always)]
    pub fn with_orbit(self, orbit: [R; 4]) -> Self {
        Place { orbit, ..self }
    }
}

/// How far the point moves along each axis from one ray to the next, at most, where a ray of direction `d` and width `pixel`
/// meets a surface: there the pixel is an ellipse, as wide as the ray across, and longer by the cosine along the view.
#[inline(always)]
pub fn footprint<R: Real>(normal: Vec3<R>, d: Vec3<R>, pixel: R) -> Vec3<R> {
    let facing = normal.dot(d);
    let cosine = facing.abs().max(0.05);
    let along = d - normal * facing;
    let along = along / along.length().max(1e-6);
    let longer = cosine.recip() - 1.0;
    let (n, a) = (normal.array(), along.array());
    each(
        #[inline(always)]
        |k| pixel * (n[k].sq().one_minus().max(0.0).sqrt() + a[k].abs() * longer),
    )
}

/// Share of a feature's size that a point is moved into the surface: the faces of solids like to lie on the borders of
/// cubes and bands.
const INWARDS: f32 = 1e-3;

/// Distance to an orbit trap within which nearer makes little difference.
const TRAP: f32 = 0.08;

/// Most octaves of noise.
pub const OCTAVES: u32 = 8;

/// Cubes of two colours, of side `size`.
#[inline(always)]
pub fn checker<R: Real>(at: &Place<R>, colours: [Vec3<R::Scalar>; 2], size: R::Scalar) -> Vec3<R> {
    let p = (at.point - at.normal * (size * INWARDS)) / size;
    let w = at.footprint / size;
    let even = square_wave(p.x, w.x) * square_wave(p.y, w.y) * square_wave(p.z, w.z);
    between::<R>(colours, even * 0.5 + 0.5)
}

/// Bands of two colours across a `direction`, as wide as `size`.
#[inline(always)]
pub fn stripes<R: Real>(
    at: &Place<R>,
    colours: [Vec3<R::Scalar>; 2],
    direction: Vec3<R::Scalar>,
    size: R::Scalar,
) -> Vec3<R> {
    let p = (at.point - at.normal * (size * INWARDS)).dot(direction) / size;
    let w = at.footprint.dot(direction.abs()) / size;
    between::<R>(colours, square_wave(p, w) * 0.5 + 0.5)
}

/// Fractal noise between two colours: `octaves` of gradient noise (at least 1, at most [`OCTAVES`]), each of half the size and
/// half the strength of the one before. Features finer than a pixel fade to their mean, which is zero.
#[inline(always)]
pub fn noise<R: Real>(
    at: &Place<R>,
    colours: [Vec3<R::Scalar>; 2],
    size: R::Scalar,
    octaves: R::Scalar,
) -> Vec3<R> {
    let x = at.point.x;
    let octaves = octaves.max(1.0);
    let first = (
        x.lit(0.0),
        at.point / size,
        at.footprint.length() / size,
        x.lit(1.0),
        x.lit(0.0),
        x.lit(0.0),
    );
    let (sum, _, _, _, total, _) = R::repeat_while(
        R::constant(f64::from(OCTAVES)),
        first,
        #[inline(always)]
        |(_, _, _, _, _, octave): (R, Vec3<R>, R, R, R, R)| octave.below(octaves),
        #[inline(always)]
        |(sum, p, w, share, total, octave)| {
            let seen = (w * 2.0).one_minus().clamp01();
            let sum = sum + gradient_noise(p) * seen * share;
            // turned and moved, so that the lattices of the octaves do not meet
            let turned = v3(p.y * 0.8 + p.z * 0.6, p.x, p.y * 0.6 - p.z * 0.8) * 2.0;
            let p = v3(turned.x + 0.37, turned.y + 0.61, turned.z + (octave + 0.13));
            (sum, p, w * 2.0, share * 0.5, total + share, octave + 1.0)
        },
    );
    between::<R>(colours, (sum * (x.lit(0.8) / total) + 0.5).clamp01())
}

/// From one colour to another between two points.
#[inline(always)]
pub fn gradient<R: Real>(
    at: &Place<R>,
    colours: [Vec3<R::Scalar>; 2],
    from: Vec3<R::Scalar>,
    to: Vec3<R::Scalar>,
) -> Vec3<R> {
    let way = to - from;
    let t = (at.point - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
    between::<R>(colours, t.clamp01())
}

/// Colours by the orbit of a fractal: the nearer a trap, the more its colour counts.
#[inline(always)]
pub fn orbit<R: Real>(at: &Place<R>, colours: [Vec3<R::Scalar>; 4]) -> Vec3<R> {
    let mut weights = at.orbit;
    for weight in &mut weights {
        *weight = (weight.sq() + TRAP * TRAP).recip();
    }
    let total = weights[0] + weights[1] + weights[2] + weights[3];
    let [a, b, c, d] = colours;
    let (a, b, c, d) = (a.array(), b.array(), c.array(), d.array());
    each(
        #[inline(always)]
        |k| {
            let sum = weights[0] * a[k] + weights[1] * b[k] + weights[2] * c[k] + weights[3] * d[k];
            sum / total
        },
    )
}

/// Projections that weigh less than this are left out.
pub const LEAST_WEIGHT: f32 = 1e-4;

/// How much the projections of an image along the three axes count, not yet divided by their sum. Relative to the largest part
/// of the normal: high powers of all three may be too small for a number.
#[inline(always)]
pub fn projection_weights<R: Real>(normal: Vec3<R>, sharpness: R::Scalar) -> Vec3<R> {
    let n = normal.abs();
    let steepest = n.x.max(n.y).max(n.z).max(f32::MIN_POSITIVE);
    n.map(
        #[inline(always)]
        |c| (c / steepest).powf(sharpness),
    )
}

/// Where in the image a point lies, projected along an axis (0, 1 or 2): across and down, as they are seen from outside.
#[inline(always)]
pub fn projection<R: Real>(p: Vec3<R>, normal: Vec3<R>, axis: R, size: R::Scalar) -> Vec2<R> {
    let side = normal.map(
        #[inline(always)]
        |c| R::choose(c.negative(), c.lit(-1.0), c.lit(1.0)),
    );
    let (second, third) = (axis.above(0.5), axis.above(1.5));
    let u = R::choose(second, p.x, -p.z * side.x);
    let u = R::choose(third, p.x * side.z, u);
    let v = R::choose(second & !third, p.z * side.y, -p.y);
    v2(u / size, v / size)
}

/// From one colour to another.
#[inline(always)]
fn between<R: Real>(colours: [Vec3<R::Scalar>; 2], t: R) -> Vec3<R> {
    let [a, b] = colours;
    let (a, rise) = (a.array(), (b - a).array());
    each(
        #[inline(always)]
        |k| t * rise[k] + a[k],
    )
}

/// 1 in even cells of size 1 and -1 in odd ones, averaged over `w` around `x` (the difference of two values of its integral,
/// a triangle wave).
#[inline(always)]
fn square_wave<R: Real>(x: R, w: R) -> R {
    let w = w.max(1e-4);
    let mean = (triangle_wave(x - w * 0.5) - triangle_wave(x + w * 0.5)) * 2.0 / w;
    mean.clamp(-1.0, 1.0)
}

#[inline(always)]
fn triangle_wave<R: Real>(x: R) -> R {
    ((x * 0.5).fract() - 0.5).abs()
}

/// Numbers of which each can be treated on its own.
pub trait PerLane: Real<Scalar = f32> {
    /// `f` of every lane.
    fn each(
        point: Vec3<Self>,
        normal: Vec3<Self>,
        f: impl Fn([f32; 3], [f32; 3]) -> [f32; 3],
    ) -> Vec3<Self>;
}

impl PerLane for f32 {
    #[inline(always)]
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
        let mut out = Vec3::splat(point.x.lit(0.0));
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

/// The linear colour of a pattern at a place.
#[inline(always)]
pub fn colour<R: PerLane>(pattern: &Pattern, at: &Place<R>) -> Vec3<R> {
    let two = |colours: &[glam::Vec3; 2]| [parameters(colours[0]), parameters(colours[1])];
    match pattern {
        Pattern::Solid { colour } => at.point.like(parameters(*colour)),
        Pattern::Checker { colours, size } => checker(at, two(colours), *size),
        Pattern::Stripes {
            colours,
            direction,
            size,
        } => stripes(at, two(colours), parameters(*direction), *size),
        Pattern::Noise {
            colours,
            size,
            octaves,
        } => noise(at, two(colours), *size, *octaves as f32),
        Pattern::Gradient { colours, from, to } => {
            gradient(at, two(colours), parameters(*from), parameters(*to))
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
        Pattern::Orbit { colours } => orbit(at, colours.map(parameters)),
    }
}

/// The image along the three axes, weighted by the normal.
fn triplanar(image: &Image, size: f32, sharpness: f32, p: [f32; 3], n: [f32; 3]) -> [f32; 3] {
    let (p, n) = (v3(p[0], p[1], p[2]), v3(n[0], n[1], n[2]));
    let (mut sum, mut weights) = (glam::Vec3::ZERO, 0.0);
    for (axis, weight) in [0.0, 1.0, 2.0]
        .into_iter()
        .zip(projection_weights(n, sharpness).array())
    {
        if weight < LEAST_WEIGHT {
            continue;
        }
        let place = projection(p, n, axis, size);
        sum += texel(image, place.x, place.y) * weight;
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
