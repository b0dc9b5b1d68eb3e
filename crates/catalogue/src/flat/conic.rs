//! Ellipse and parabola: exact distances by the foot point.

use super::*;

/// The largest root of `s^3 + linear s = constant`, for a constant that is not negative.
///
/// Newton's method from above, where the cubic is convex and rising, so that it comes down on the root from any start; this
/// one is at most 1.6 times too large.
#[inline(always)]
pub(super) fn largest_root<R: Real>(linear: R, constant: R) -> R {
    let constant = constant.max(1e-30);
    let cubic = constant.powf(R::constant(1.0 / 3.0));
    let steady = constant / linear.max(1e-30);
    let rising = R::select(linear.above(0.0), cubic.min(steady), cubic);
    let mut s = (-linear).max(0.0).sqrt() + rising;
    for _ in 0..7 {
        s = (s.sq() * s * 2.0 + constant) / (s.sq() * 3.0 + linear).max(1e-30);
    }
    s
}

/// An ellipse.
pub struct Ellipse;
impl Primitive for Ellipse {
    const INFO: Info = flat(
        "ellipse",
        "An ellipse with its axes along x and y.",
        "foot point by Newton's method on a convex function, after Eberly 2013, Distance from a Point to an Ellipse",
        &[size(&[1.5, 1.0], "Full axes along x and y.")],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[1.0, 2.0], &[1.0, 1.0], &[2.0, 0.1], &[1.0, 1.0001]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| ellipse(p.xy(), a.vec2(0) * 0.5),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        (x / a[0]).powi(2) + (y / a[1]).powi(2) <= 0.25
    }
}

/// Distance to the ellipse with these half axes.
///
/// The foot of (x, y) is (e_x X, e_y Y) with X = e_x x / (s + e_x^2), Y = e_y y / (s + e_y^2) and X^2 + Y^2 = 1. That sum falls
/// with s and is convex, so Newton's method rises to the root from any start where it is above 1; it starts where it is
/// between 1 and 2. The unknown here is s + min(e^2), whose start is positive. The distance is measured along the normal at the foot: it
/// is right to second order in the foot, and outside never too long.
#[inline(always)]
fn ellipse<R: Real>(p: Vec2<R>, e: Vec2<R::Scalar>) -> R {
    let (xx, yy) = (e.x * e.x, e.y * e.y);
    let least = xx.min(yy);
    let more = v2(xx - least, yy - least);
    // a hair off the axes, where the quotients below would be 0 / 0
    let hair = e.x.min(e.y) * 1e-10;
    let q = v2(p.x.abs().max(hair), p.y.abs().max(hair));
    let z = q.times(e);
    let foot = inlined(
        #[inline(always)]
        |u: R| v2(z.x / (u + more.x), z.y / (u + more.y)),
    );
    let start = (z.x - more.x).max(z.y - more.y);
    let (u, _) = R::repeat_while(
        R::constant(16.0),
        (start, start),
        #[inline(always)]
        |(u, step)| step.above(u * 1e-6),
        #[inline(always)]
        |(u, _)| {
            let f = foot(u);
            let steep = f.x.sq() / (u + more.x) + f.y.sq() / (u + more.y);
            let step = (f.length_squared() - 1.0) / (steep * 2.0);
            (u + step, step)
        },
    );
    let f = foot(u).normalize();
    let normal = v2(f.x / e.x, f.y / e.y).normalize();
    (q - f.times(e)).dot(normal)
}

/// The region under a parabolic arch.
pub struct Parabola;
impl Primitive for Parabola {
    const INFO: Info = flat(
        "parabola",
        "The region under a parabolic arch that stands on the x axis.",
        "foot point by the cubic s^3 + s (1 - 2 k y) / (2 k^2) = x / (2 k^2)",
        &[
            length("width", &[1.5], "Full width at the foot."),
            length("height", &[1.2], "Height of the arch."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.2], &[0.3, 2.0], &[1.0, 1.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| arch(p.xy(), a.get(0) * 0.5, a.get(1)),
        )
    }
    fn bounds(a: &[f64]) -> Aabb {
        span([-a[0] / 2.0, 0.0], [a[0] / 2.0, a[1]])
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        y >= 0.0 && y <= a[1] * (1.0 - (2.0 * x / a[0]).powi(2))
    }
}

#[inline(always)]
fn arch<R: Real>(p: Vec2<R>, half: R::Scalar, height: R::Scalar) -> R {
    // from the top: y = -k x^2
    let k = height / (half * half);
    let q = v2(p.x.abs(), p.y - height);
    let scale = (k * k * 2.0).recip();
    let foot = largest_root((q.y * k * 2.0 + 1.0) * scale, q.x * scale);
    let t = foot.min(half);
    let normal = v2(t * k * 2.0, t.lit(1.0)).normalize();
    let away = v2(q.x - t, q.y + t.sq() * k);
    // beside the arch the foot is the foot, and only past its end is there a way along it
    let along = away.x * normal.y - away.y * normal.x;
    let beyond = R::select(foot.above(half), along.max(0.0), along.lit(0.0));
    let over = away.dot(normal);
    let arch = Edge {
        beyond,
        right: over,
    };
    let below = -p.y;
    let base = Edge {
        beyond: (q.x - half).max(0.0),
        right: below,
    };
    let outside = arch.distance().min(base.distance());
    R::select(over.max(below).above(0.0), outside, below.max(arch.depth()))
}
