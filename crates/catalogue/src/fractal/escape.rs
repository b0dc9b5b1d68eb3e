//! Escape-time fractals: distance estimates by the derivative of the orbit (Hart, Sandin and Kauffman 1989).

use super::*;
use zeroset_number::Ops;

/// The estimate, or minus it where the orbit did not escape, or the distance to the ball that holds the fractal, which is
/// true, from outside that ball.
#[inline(always)]
fn estimate<R: Real>(p: Vec3<R>, d: R, escaped: R::Mask, ball: R) -> R {
    let apart = p.length() - ball;
    R::select(
        apart.above(0.25),
        apart,
        R::select(escaped, d.abs(), -d.abs()),
    )
}

/// The Mandelbulb.
pub struct Mandelbulb;

/// Radius of the ball that holds the Mandelbulb: where |z|^n grows faster than the point that is added can pull back.
fn bulb_radius(power: f64) -> f64 {
    2.0_f64.powf(1.0 / (power - 1.0))
}

impl Fractal for Mandelbulb {
    const INFO: Info = Info {
        name: "mandelbulb",
        doc: "The Mandelbulb: z -> z^power + p with powers by spherical angles.",
        source: "White and Nylander 2009; estimate after Hart, Sandin and Kauffman 1989",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[
            number("power", Unit::Ratio, &[8.0], 2.0, 32.0, "Exponent."),
            number(
                "iterations",
                Unit::Count,
                &[8.0],
                1.0,
                64.0,
                "Most steps of an orbit.",
            ),
        ],
    };
    const EXACTNESS: Exactness = Exactness::Estimate;
    const SAMPLES: &'static [&'static [f64]] = &[&[4.0, 5.0]];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(1)
    }
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> Orbit<R> {
        (p, p.x.lit(0.0), p.x.lit(1.0), p.length())
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.3.below(4.0)
    }
    #[inline(always)]
    fn step<R: Real>(p: Vec3<R>, (z, w, dr, r): Orbit<R>, a: Args<'_, R>) -> Orbit<R> {
        let power = a.get(0);
        let theta = length2(z.x, z.z).atan2(z.y) * power;
        let phi = z.z.atan2(z.x) * power;
        let before = r.max(1e-6).powf(power - 1.0);
        let (rn, dr) = (before * r, before * power * dr + 1.0);
        let ((st, ct), (sp, cp)) = (theta.sin_cos(), phi.sin_cos());
        let z = v3(rn * st * cp + p.x, rn * ct + p.y, rn * st * sp + p.z);
        (z, w, dr, z.length())
    }
    #[inline(always)]
    fn end<R: Real>(p: Vec3<R>, (_, _, dr, r): Orbit<R>, a: Args<'_, R>) -> R {
        let ball = p.x.like((a.get(0) - 1.0).recip().exp2());
        estimate(p, r.max(1e-6).ln() * 0.5 * r / dr, r.above(4.0), ball)
    }
    fn bounds(a: &[f64]) -> Aabb {
        ball(bulb_radius(a[0]))
    }
    /// Within 1/4 of the ball the value is the estimate, which may be small.
    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        <Self as Fractal>::bounds(a).grow(if level > 0.0 { level.max(0.25) } else { 0.0 })
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let mut z = p;
        for _ in 0..=a[1] as u32 {
            let r = (z[0] * z[0] + z[1] * z[1] + z[2] * z[2]).sqrt();
            if r > 4.0 {
                return false;
            }
            let theta = if r > 0.0 {
                (z[1] / r).clamp(-1.0, 1.0).acos() * a[0]
            } else {
                0.0
            };
            let phi = z[2].atan2(z[0]) * a[0];
            let rn = r.powf(a[0]);
            z = [
                rn * theta.sin() * phi.cos() + p[0],
                rn * theta.cos() + p[1],
                rn * theta.sin() * phi.sin() + p[2],
            ];
        }
        true
    }
}

/// The Mandelbox.
pub struct Mandelbox;

/// Half side of the cube that holds the Mandelbox.
fn box_half(scale: f64) -> f64 {
    if scale > 0.0 {
        2.0 * (scale + 1.0) / (scale - 1.0)
    } else {
        2.0
    }
}

impl Fractal for Mandelbox {
    const INFO: Info = Info {
        name: "mandelbox",
        doc: "The Mandelbox: fold into a box and a ball, scale, add the point, again; in a cube of side 2.",
        source: "Lowe 2010; estimate after Buddhi 2010",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[
            number(
                "factor",
                Unit::Ratio,
                &[2.2],
                -4.0,
                4.0,
                "Scale of a step: -4 to -1.2 or 1.5 to 4.",
            ),
            number(
                "iterations",
                Unit::Count,
                &[12.0],
                1.0,
                64.0,
                "Most steps of an orbit.",
            ),
            number(
                "inner",
                Unit::Ratio,
                &[0.5],
                0.05,
                1.0,
                "Radius below which the ball fold is linear.",
            ),
        ],
    };
    const EXACTNESS: Exactness = Exactness::Estimate;
    const SAMPLES: &'static [&'static [f64]] = &[&[-1.5, 8.0, 0.5], &[3.0, 6.0, 0.4]];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(1)
    }
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Orbit<R> {
        let z = p.scale(half_side::<R>(a));
        (z, p.x.lit(0.0), p.x.lit(1.0), z.length())
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.3.below(100.0)
    }
    #[inline(always)]
    fn step<R: Real>(p: Vec3<R>, (z, w, dr, _): Orbit<R>, a: Args<'_, R>) -> Orbit<R> {
        let c = p.scale(half_side::<R>(a));
        let z = z.map(
            #[inline(always)]
            |x: R| x.max(-1.0).min(1.0) * 2.0 - x,
        );
        let k = z.length_squared().max(a.get(2) * a.get(2)).recip().max(1.0);
        let scale = a.get(0);
        let z = v3(
            z.x * k * scale + c.x,
            z.y * k * scale + c.y,
            z.z * k * scale + c.z,
        );
        (z, w, dr * k * scale.abs() + 1.0, z.length())
    }
    #[inline(always)]
    fn end<R: Real>(p: Vec3<R>, (_, _, dr, r): Orbit<R>, a: Args<'_, R>) -> R {
        let q = v3(p.x.abs() - 1.0, p.y.abs() - 1.0, p.z.abs() - 1.0);
        let apart = q.max0().length();
        let d = r / dr / half_side::<R>(a);
        let near = R::select(r.above(100.0), d, -d);
        // an orbit from just outside the cube may not have escaped yet
        let inside = near.max(q.max_component());
        R::select(apart.above(0.1), apart, inside)
    }
    fn bounds(_a: &[f64]) -> Aabb {
        ball(1.0)
    }
    /// Within 1/10 of the cube the value is the estimate, which may be small.
    fn level_bounds(_a: &[f64], level: f64) -> Aabb {
        ball(1.0).grow(if level > 0.0 { level.max(0.1) } else { 0.0 })
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        if p.iter().any(|x| x.abs() > 1.0) {
            return false;
        }
        let c = p.map(|x| x * box_half(a[0]));
        let mut z = c;
        for _ in 0..=a[1] as u32 {
            if z.iter().map(|x| x * x).sum::<f64>() > 1e4 {
                return false;
            }
            z = z.map(|x| {
                if x > 1.0 {
                    2.0 - x
                } else if x < -1.0 {
                    -2.0 - x
                } else {
                    x
                }
            });
            let r2 = z.iter().map(|x| x * x).sum::<f64>();
            let k = if r2 < a[2] * a[2] {
                1.0 / (a[2] * a[2])
            } else {
                (1.0 / r2).max(1.0)
            };
            z = std::array::from_fn(|i| a[0] * k * z[i] + c[i]);
        }
        true
    }
    fn check(a: &[f64]) -> Result<(), String> {
        if (-1.2..1.5).contains(&a[0]) {
            return Err(format!(
                "factor is {}, allowed are -4 to -1.2 and 1.5 to 4",
                a[0]
            ));
        }
        Ok(())
    }
}

/// [`box_half`] over a number type's parameters.
#[inline(always)]
fn half_side<R: Real>(a: Args<'_, R>) -> R::Scalar {
    let s = a.get(0);
    let grown = (s + 1.0) * 2.0 / (s - 1.0);
    R::Scalar::select(s.above(0.0), grown, s.lit(2.0))
}

/// A quaternion Julia set.
pub struct Julia;

impl Fractal for Julia {
    const INFO: Info = Info {
        name: "julia",
        doc: "A quaternion Julia set: q -> q^2 + c, seen where the last coordinate is `slice`.",
        source: "Norton 1982; Hart, Sandin and Kauffman 1989",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[
            vec3(
                "c",
                Unit::Ratio,
                &[-0.2, 0.6, 0.2],
                -2.0,
                2.0,
                "First three coordinates of c.",
            ),
            number(
                "c_w",
                Unit::Ratio,
                &[0.2],
                -2.0,
                2.0,
                "Last coordinate of c.",
            ),
            number(
                "slice",
                Unit::Length,
                &[0.0],
                -2.0,
                2.0,
                "Last coordinate of the points that are seen.",
            ),
            number(
                "iterations",
                Unit::Count,
                &[11.0],
                1.0,
                64.0,
                "Most steps of an orbit.",
            ),
        ],
    };
    const EXACTNESS: Exactness = Exactness::Estimate;
    const SAMPLES: &'static [&'static [f64]] = &[&[-1.0, 0.2, 0.0, 0.0, 0.0, 8.0]];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(5)
    }
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Orbit<R> {
        let w = p.x.like(a.get(4));
        (p, w, p.x.lit(1.0), R::norm([p.x, p.y, p.z, w]))
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.3.below(16.0)
    }
    #[inline(always)]
    fn step<R: Real>(_p: Vec3<R>, (z, w, dr, r): Orbit<R>, a: Args<'_, R>) -> Orbit<R> {
        let dr = r * dr * 2.0;
        let x = z.x.sq() - z.y.sq() - z.z.sq() - w.sq() + a.get(0);
        let w = z.x * w * 2.0 + a.get(3);
        let z = v3(x, z.x * z.y * 2.0 + a.get(1), z.x * z.z * 2.0 + a.get(2));
        (z, w, dr, R::norm([z.x, z.y, z.z, w]))
    }
    #[inline(always)]
    fn end<R: Real>(p: Vec3<R>, (_, _, dr, r): Orbit<R>, a: Args<'_, R>) -> R {
        let c = R::Scalar::norm([a.get(0), a.get(1), a.get(2), a.get(3)]);
        let ball = p.x.like(((c * 4.0 + 1.0).sqrt() + 1.0) * 0.5);
        estimate(
            p,
            r.max(1e-6).ln() * 0.5 * r / dr.max(1e-6),
            r.above(16.0),
            ball,
        )
    }
    /// |q^2 + c| > |q| beyond the positive root of r^2 - r - |c|.
    fn bounds(a: &[f64]) -> Aabb {
        let c = (a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3]).sqrt();
        ball(0.5 * (1.0 + (1.0 + 4.0 * c).sqrt()))
    }
    /// Within 1/4 of the ball the value is the estimate, which may be small.
    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        <Self as Fractal>::bounds(a).grow(if level > 0.0 { level.max(0.25) } else { 0.0 })
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let mut q = [p[0], p[1], p[2], a[4]];
        for _ in 0..=a[5] as u32 {
            if q.iter().map(|x| x * x).sum::<f64>() > 256.0 {
                return false;
            }
            q = [
                q[0] * q[0] - q[1] * q[1] - q[2] * q[2] - q[3] * q[3] + a[0],
                2.0 * q[0] * q[1] + a[1],
                2.0 * q[0] * q[2] + a[2],
                2.0 * q[0] * q[3] + a[3],
            ];
        }
        true
    }
}

/// An Apollonian packing.
pub struct Apollonian;

impl Fractal for Apollonian {
    const INFO: Info = Info {
        name: "apollonian",
        doc: "An Apollonian packing without end: repeat, invert in a sphere, again. Intersect it with a shape.",
        source: "Quilez 2013, after inversions in circles (Apollonius)",
        group: "Fractals",
        dimension: Dimension::Three,
        params: &[
            number(
                "inversion",
                Unit::Ratio,
                &[1.1],
                0.8,
                1.6,
                "Square of the inversion's radius.",
            ),
            number(
                "iterations",
                Unit::Count,
                &[8.0],
                1.0,
                12.0,
                "Steps of an orbit.",
            ),
            number(
                "thickness",
                Unit::Length,
                &[0.003],
                0.0,
                0.5,
                "Thickness of the sheets.",
            ),
        ],
    };
    const EXACTNESS: Exactness = Exactness::Estimate;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.3, 4.0, 0.02]];

    #[inline(always)]
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar {
        a.get(1)
    }
    #[inline(always)]
    fn start<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> Orbit<R> {
        (p, p.x.lit(0.0), p.x.lit(1.0), p.x.lit(0.0))
    }
    #[inline(always)]
    fn live<R: Real>(orbit: Orbit<R>, _a: Args<'_, R>) -> R::Mask {
        orbit.2.above(0.0)
    }
    #[inline(always)]
    fn step<R: Real>(_p: Vec3<R>, (z, w, scale, r): Orbit<R>, a: Args<'_, R>) -> Orbit<R> {
        let z = z.map(
            #[inline(always)]
            |x: R| (x * 0.5 + 0.5).fract() * 2.0 - 1.0,
        );
        let k = z.length_squared().max(0.01).recip() * a.get(0);
        (v3(z.x * k, z.y * k, z.z * k), w, scale * k, r)
    }
    #[inline(always)]
    fn end<R: Real>(_p: Vec3<R>, (z, _, scale, _): Orbit<R>, a: Args<'_, R>) -> R {
        z.y.abs() * 0.25 / scale - a.get(2)
    }
    fn bounds(_a: &[f64]) -> Aabb {
        Aabb::WHOLE
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let (mut z, mut scale) = (p, 1.0);
        for _ in 0..a[1] as u32 {
            z = z.map(|x| x - 2.0 * (0.5 * (x + 1.0)).floor());
            let k = a[0] / z.iter().map(|x| x * x).sum::<f64>().max(0.01);
            z = z.map(|x| x * k);
            scale *= k;
        }
        0.25 * z[1].abs() / scale <= a[2]
    }
}
