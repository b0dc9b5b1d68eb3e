//! Cylinders and cones.

use super::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

const RADIUS: Param = size("radius", &[0.5], "Distance from the axis to the surface.");
const HEIGHT: Param = size("height", &[1.5], "Full height.");

/// A cylinder without ends.
pub struct InfiniteCylinder;
impl Primitive for InfiniteCylinder {
    const INFO: Info = solid(
        "Cylinders and cones",
        "infinite_cylinder",
        "A cylinder without ends.",
        "",
        &[RADIUS],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        length2(p.x, p.z) - a.get(0)
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0], f64::INFINITY, a[0]])
    }
    fn contains(a: &[f64], [x, _, z]: [f64; 3]) -> bool {
        x * x + z * z <= a[0] * a[0]
    }
}

/// A cylinder with flat ends.
pub struct Cylinder;
impl Primitive for Cylinder {
    const INFO: Info = solid(
        "Cylinders and cones",
        "cylinder",
        "A cylinder with flat ends.",
        "",
        &[RADIUS, HEIGHT],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.05], &[0.1, 2.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let q = meridian(p);
        corner([q.x - a.get(0), q.y.abs() - a.get(1) * 0.5])
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0], 0.5 * a[1], a[0]])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        2.0 * p[1].abs() <= a[1] && InfiniteCylinder::contains(a, p)
    }
}

/// A cylinder with round edges.
pub struct RoundedCylinder;
impl Primitive for RoundedCylinder {
    const INFO: Info = solid(
        "Cylinders and cones",
        "rounded_cylinder",
        "A cylinder with round edges.",
        "",
        &[
            RADIUS,
            HEIGHT,
            number(
                "round",
                Unit::Length,
                &[0.1],
                0.0,
                LARGE,
                "Radius of the edges; the size stays.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[1.0, 0.5, 0.25], &[0.3, 2.0, 0.3], &[1.0, 1.0, 0.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (q, round) = (meridian(p), a.get(2));
        corner([
            q.x - (a.get(0) - round),
            q.y.abs() - (a.get(1) * 0.5 - round),
        ]) - round
    }
    fn bounds(a: &[f64]) -> Aabb {
        Cylinder::bounds(a)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // In one of the two cylinders that the inner one grows to, or in the ring around its edges.
        let (x, y, round) = (p[0].hypot(p[2]), p[1].abs(), a[2]);
        let (radius, half) = (a[0] - round, 0.5 * a[1] - round);
        (x <= radius && y <= half + round)
            || (x <= radius + round && y <= half)
            || (x - radius).powi(2) + (y - half).powi(2) <= round * round
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let most = a[0].min(0.5 * a[1]);
        if a[2] <= most {
            Ok(())
        } else {
            Err(format!(
                "round must be at most radius and half the height, {most}, not {}",
                a[2]
            ))
        }
    }
}

/// The cone's generator from (`lower`, -half) to (`upper`, half), and the discs at its ends.
#[inline(always)]
fn frustum<R: Real>(q: Vec2<R>, lower: R::Scalar, upper: R::Scalar, height: R::Scalar) -> R {
    let half = height * 0.5;
    let (out, len) = (
        upper - lower,
        (height * height + (upper - lower) * (upper - lower)).sqrt(),
    );
    let (tx, ty) = (out / len, height / len);
    // Over the generator, along it, and past its ends.
    let (x, y) = (q.x - lower, q.y + half);
    let (over, along) = (x * ty - y * tx, x * tx + y * ty);
    let past = along - along.clamp(0.0, len);
    let disc = q.y.abs() - half;
    let radius = R::select(q.y.negative(), q.x.like(lower), q.x.like(upper));
    let outside = length2(over, past).min(length2((q.x - radius).max(0.0), disc));
    let inside = over.max(disc);
    R::select(inside.above(0.0), outside, inside)
}

fn in_frustum(p: [f64; 3], lower: f64, upper: f64, height: f64) -> bool {
    let t = p[1] / height + 0.5;
    (0.0..=1.0).contains(&t) && p[0].hypot(p[2]) <= lower + (upper - lower) * t
}

/// A cone with a tip.
pub struct Cone;
impl Primitive for Cone {
    const INFO: Info = solid(
        "Cylinders and cones",
        "cone",
        "A cone that stands on its disc.",
        "",
        &[
            size("radius", &[0.6], "Radius of the disc."),
            size("height", &[1.5], "From the disc to the tip."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.2], &[0.2, 2.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        frustum(meridian(p), a.get(0), R::constant(0.0), a.get(1))
    }
    fn bounds(a: &[f64]) -> Aabb {
        Cylinder::bounds(a)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        in_frustum(p, a[0], 0.0, a[1])
    }
}

/// A cone with a flat top.
pub struct CappedCone;
impl Primitive for CappedCone {
    const INFO: Info = solid(
        "Cylinders and cones",
        "capped_cone",
        "A cone with a flat top.",
        "",
        &[
            number(
                "lower",
                Unit::Length,
                &[0.7],
                0.0,
                LARGE,
                "Radius at the bottom.",
            ),
            number(
                "upper",
                Unit::Length,
                &[0.3],
                0.0,
                LARGE,
                "Radius at the top.",
            ),
            size("height", &[1.2], "Full height."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[0.2, 1.0, 0.3], &[0.5, 0.5, 1.0], &[0.0, 0.5, 1.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        frustum(meridian(p), a.get(0), a.get(1), a.get(2))
    }
    fn bounds(a: &[f64]) -> Aabb {
        let wide = a[0].max(a[1]);
        Aabb::centred([wide, 0.5 * a[2], wide])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        in_frustum(p, a[0], a[1], a[2])
    }
}

/// A cone without a base.
pub struct InfiniteCone;
impl Primitive for InfiniteCone {
    const INFO: Info = solid(
        "Cylinders and cones",
        "infinite_cone",
        "A cone without end below its tip, which is the origin.",
        "",
        &[number(
            "angle",
            Unit::Angle,
            &[FRAC_PI_6],
            1e-3,
            FRAC_PI_2 - 1e-3,
            "Angle from the axis to the surface.",
        )],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.1], &[1.4]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (s, c) = a.get(0).sin_cos();
        let q = meridian(p);
        let (along, over) = (q.x * s - q.y * c, q.x * c + q.y * s);
        R::select(along.negative(), q.length(), over)
    }
    fn bounds(_a: &[f64]) -> Aabb {
        Plane::bounds(&[])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        x.hypot(z) <= -y * a[0].tan()
    }
}

/// The hull of two balls.
pub struct RoundCone;
impl Primitive for RoundCone {
    const INFO: Info = solid(
        "Cylinders and cones",
        "round_cone",
        "A cone with round ends: the hull of two balls, one above the other.",
        "",
        &[
            size("lower", &[0.5], "Radius of the lower ball."),
            size("upper", &[0.25], "Radius of the upper ball."),
            size(
                "height",
                &[1.0],
                "Distance between the balls' centres; more than the radii differ.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.2, 0.8, 0.7], &[0.4, 0.4, 1.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (lower, upper, height) = (a.get(0), a.get(1), a.get(2));
        let (q, half) = (meridian(p), height * 0.5);
        // Sine and cosine of the slant.
        let s = (lower - upper) / height;
        let c = ((s + 1.0) * s.one_minus()).max(0.0).sqrt();
        let y = q.y + half;
        let along = y * c - q.x * s;
        let side = q.x * c + y * s - lower;
        let below = length2(q.x, y) - lower;
        let above = length2(q.x, q.y - half) - upper;
        R::select(
            along.negative(),
            below,
            R::select(along.above(height * c), above, side),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        let wide = a[0].max(a[1]);
        Aabb::new(
            [-wide, -0.5 * a[2] - a[0], -wide],
            [wide, 0.5 * a[2] + a[1], wide],
        )
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        // The largest reach of the balls between the two, found where its derivative vanishes.
        let (x, y) = (x.hypot(z), y + 0.5 * a[2]);
        let slope = (a[1] - a[0]) / a[2];
        let reach = |t: f64| (a[0] + slope * t) - x.hypot(y - t);
        let best = (y + slope * x / (1.0 - slope * slope).sqrt()).clamp(0.0, a[2]);
        reach(best) >= 0.0 || reach(0.0) >= 0.0 || reach(a[2]) >= 0.0
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let least = (a[0] - a[1]).abs();
        if a[2] > least {
            Ok(())
        } else {
            Err(format!(
                "height must be more than the radii differ, {least}, not {}",
                a[2]
            ))
        }
    }
}
