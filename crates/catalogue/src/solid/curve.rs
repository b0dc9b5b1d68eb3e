//! Tubes around curves.

use super::sheet::to_segment;
use super::*;
use std::f64::consts::{PI, TAU};

const fn point(name: &'static str, default: &'static [f64; 3], doc: &'static str) -> Param {
    vec3(name, Unit::Length, default, -LARGE, LARGE, doc)
}

/// A cylinder with half balls as ends.
pub struct Capsule;
impl Primitive for Capsule {
    const INFO: Info = solid(
        "Tubes",
        "capsule",
        "A cylinder with half balls as ends.",
        "",
        &[
            size("radius", &[0.4], "Radius of the cylinder and of its ends."),
            number(
                "height",
                Unit::Length,
                &[1.0],
                0.0,
                LARGE,
                "Height of the cylinder, without its ends.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.1, 2.0], &[1.0, 0.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let y = (p.y.abs() - a.get(1) * 0.5).max(0.0);
        R::norm([p.x, y, p.z]) - a.get(0)
    }
    fn bounds(a: &[f64]) -> Aabb {
        Aabb::centred([a[0], 0.5 * a[1] + a[0], a[0]])
    }
    fn contains(a: &[f64], [x, y, z]: [f64; 3]) -> bool {
        let end = |h: f64| x * x + (y - h).powi(2) + z * z <= a[0] * a[0];
        end(0.5 * a[1])
            || end(-0.5 * a[1])
            || (2.0 * y.abs() <= a[1] && x * x + z * z <= a[0] * a[0])
    }
}

/// A capsule from one point to another.
pub struct CapsuleBetween;
impl Primitive for CapsuleBetween {
    const INFO: Info = solid(
        "Tubes",
        "capsule_between",
        "A capsule from one point to another.",
        "",
        &[
            point("start", &[-0.6, -0.5, 0.0], "Centre of the first end."),
            point("end", &[0.6, 0.5, 0.0], "Centre of the second end."),
            size("radius", &[0.25], "Radius of the cylinder and of its ends."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.1, 0.2, 0.3, 0.1, 0.2, 0.3, 0.5],
        &[0.0, 1.0, 2.0, 1.0, -1.0, 0.0, 0.02],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (start, end) = (a.vec3(0), a.vec3(3));
        to_segment(p - start, end - start) - a.get(6)
    }
    fn bounds(a: &[f64]) -> Aabb {
        hull_of(&[triple(a, 0), triple(a, 3)], a[6])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        near_segment(p, triple(a, 0), triple(a, 3), a[6])
    }
}

/// Whether `p` is near the straight line from `u` to `v`: near an end, or between them and near the line by Heron's height.
fn near_segment(p: [f64; 3], u: [f64; 3], v: [f64; 3], radius: f64) -> bool {
    let square = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    let (pu, pv, uv) = (square(p, u), square(p, v), square(u, v));
    let t = pu - pv + uv;
    pu.min(pv) <= radius * radius
        || ((0.0..=2.0 * uv).contains(&t) && uv > 0.0 && pu - t * t / (4.0 * uv) <= radius * radius)
}

/// A tube along straight pieces.
pub struct PolylineTube;
impl Primitive for PolylineTube {
    const INFO: Info = solid(
        "Tubes",
        "polyline_tube",
        "A tube along straight lines from point to point.",
        "",
        &[
            size("radius", &[0.12], "Radius of the tube and of its ends."),
            list(
                "points",
                Unit::Length,
                3,
                &[
                    -0.8, -0.5, 0.0, -0.3, 0.6, 0.3, 0.3, -0.4, -0.3, 0.8, 0.5, 0.0,
                ],
                "Points in their order, one at least.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.5, 1.0, 0.1, 0.2, 0.3],
        &[0.1, 2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        &[
            0.2, 5.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.3, 0.8,
        ],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let first = (p - a.vec3(2)).length();
        let nearest = a.list(1).fold(
            Ends::Open,
            first,
            #[inline(always)]
            |nearest, u: [_; 3], v: [_; 3]| {
                let u = v3(u[0], u[1], u[2]);
                nearest.min(to_segment(p - u, v3(v[0], v[1], v[2]) - u))
            },
        );
        nearest - a.get(0)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let points: Vec<[f64; 3]> = a[2..].chunks_exact(3).map(|c| triple(c, 0)).collect();
        hull_of(&points, a[0])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let points: Vec<[f64; 3]> = a[2..].chunks_exact(3).map(|c| triple(c, 0)).collect();
        near_segment(p, points[0], points[0], a[0])
            || points.windows(2).any(|w| near_segment(p, w[0], w[1], a[0]))
    }
    fn check(a: &[f64]) -> Result<(), String> {
        if a[1] >= 1.0 {
            Ok(())
        } else {
            Err("points must hold one point at least".into())
        }
    }
}

/// The least distance to a curve over `t` in 0..1, by sampling and then narrowing down: for the proofs.
fn near_curve(p: [f64; 3], samples: usize, radius: f64, curve: impl Fn(f64) -> [f64; 3]) -> bool {
    let square = |t: f64| {
        let c = curve(t);
        (0..3).map(|k| (p[k] - c[k]).powi(2)).sum::<f64>()
    };
    let points: Vec<[f64; 3]> = (0..=samples)
        .map(|i| curve(i as f64 / samples as f64))
        .collect();
    let values: Vec<f64> = (0..=samples)
        .map(|i| square(i as f64 / samples as f64))
        .collect();
    let step = points
        .windows(2)
        .map(|w| (0..3).map(|k| (w[0][k] - w[1][k]).abs()).sum::<f64>())
        .fold(0.0, f64::max);
    (0..=samples).any(|i| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(samples));
        if values[i] > values[before].min(values[after]) || values[i].sqrt() > radius + step {
            return false;
        }
        let (mut lo, mut hi) = (
            before as f64 / samples as f64,
            after as f64 / samples as f64,
        );
        for _ in 0..50 {
            let (u, v) = (lo + (hi - lo) * 0.382, lo + (hi - lo) * 0.618);
            if square(u) < square(v) {
                hi = v
            } else {
                lo = u
            }
        }
        square(0.5 * (lo + hi)).min(values[i]) <= radius * radius
    })
}

/// A tube along a parabola.
pub struct BezierTube;
impl Primitive for BezierTube {
    const INFO: Info = solid(
        "Tubes",
        "bezier_tube",
        "A tube along a quadratic Bezier curve.",
        "",
        &[
            point("start", &[-0.8, -0.5, 0.0], "Where the curve begins."),
            point(
                "control",
                &[0.0, 1.2, 0.4],
                "Where its tangents at both ends meet.",
            ),
            point("end", &[0.8, -0.5, 0.0], "Where the curve ends."),
            size("radius", &[0.15], "Radius of the tube and of its ends."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.2],
        &[0.0, 0.0, 0.0, 0.5, 0.001, 0.0, 1.0, 0.0, 0.0, 0.05],
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.2, 0.1, 0.1, 0.0, 0.1],
        &[-1.0, 0.0, 0.0, 3.0, 0.5, 0.0, 0.0, 0.7, 0.5, 0.1],
    ];

    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| to_parabola(p, a),
        ) - a.get(9)
    }
    fn bounds(a: &[f64]) -> Aabb {
        // Where a coordinate turns, if it does.
        let turn = |k: usize| {
            let (s, c, e) = (a[k], a[3 + k], a[6 + k]);
            let t = (s - c) / (s - 2.0 * c + e);
            if t > 0.0 && t < 1.0 {
                s + t * (2.0 * (c - s) + t * (s - 2.0 * c + e))
            } else {
                s
            }
        };
        hull_of(
            &[triple(a, 0), triple(a, 6), std::array::from_fn(turn)],
            a[9],
        )
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        near_curve(p, 48, a[9], |t| {
            std::array::from_fn(|k| {
                (1.0 - t).powi(2) * a[k] + 2.0 * t * (1.0 - t) * a[3 + k] + t * t * a[6 + k]
            })
        })
    }
}

/// Distance to the curve.
///
/// Half the derivative of the squared distance to a + 2 t u + t^2 v is a cubic g. Its two rising parts, before and after
/// its turning points, hold the two minima. There g is concave and convex, so that Newton's method climbs from t = 0 and
/// comes down from t = 1 without passing the root.
#[inline(always)]
fn to_parabola<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
    let (start, control, end) = (a.vec3(0), a.vec3(3), a.vec3(6));
    let u = control - start;
    let v = end - control - u;
    let q = p - start;
    let (uv, uu) = (u.dot(v), u.length_squared());
    // A straight line has no cubic term: one that does no harm keeps the divisions by it finite.
    let vv = v.length_squared().max(uu * 1e-12).max(1e-30);
    let (g1, g0) = (-(q.dot(v) - uu * 2.0), -q.dot(u));
    let half = ((-(g1 * (vv / 3.0)) + uv * uv).max(0.0)).sqrt() / vv;
    let middle = -(uv / vv);
    let low = (-half + middle).clamp01();
    let high = (half + middle).clamp01();
    let newton = inlined(
        #[inline(always)]
        |t: R| {
            let g = ((t * vv + uv * 3.0) * t + g1) * t + g0;
            let slope = (t * (vv * 3.0) + uv * 6.0) * t + g1;
            t - g / slope.max(1e-20)
        },
    );
    let (s, t, _) = R::repeat_while(
        R::constant(24.0),
        (
            newton(p.x.lit(0.0)).max(0.0).min(low),
            newton(p.x.lit(1.0)).min(1.0).max(high),
            p.x.lit(1.0),
        ),
        #[inline(always)]
        |(_, _, change)| change.above(1e-6),
        #[inline(always)]
        |(s, t, _)| {
            let (s2, t2) = (newton(s).max(0.0).min(low), newton(t).min(1.0).max(high));
            (s2, t2, (s2 - s).abs() + (t2 - t).abs())
        },
    );
    let at = inlined(
        #[inline(always)]
        |t: R| {
            let c = inlined(
                #[inline(always)]
                |q: R, u: R::Scalar, v: R::Scalar| q - t * (t * v + u * 2.0),
            );
            R::norm([c(q.x, u.x, v.x), c(q.y, u.y, v.y), c(q.z, u.z, v.z)])
        },
    );
    at(s).min(at(t))
}

/// A tube along a screw line.
pub struct Helix;
impl Primitive for Helix {
    const INFO: Info = solid(
        "Tubes",
        "helix",
        "A tube that winds around the y axis.",
        "",
        &[
            size("radius", &[0.6], "From the axis to the middle of the tube."),
            size("pitch", &[0.5], "Height of a turn."),
            number(
                "turns",
                Unit::Ratio,
                &[3.0],
                0.01,
                1000.0,
                "Number of turns.",
            ),
            size("tube", &[0.12], "Radius of the tube and of its ends."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.5, 2.0, 1.3, 0.1],
        &[0.3, 3.0, 0.4, 0.2],
        &[1.0, 0.2, 2.5, 0.05],
    ];

    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| to_helix(p, a),
        ) - a.get(3)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let last = PI * a[2];
        // Where the turning points of x and z are reached, the radius; else the ends.
        let reach = |phase: f64| {
            let turning = ((last - phase) / TAU).floor() >= ((-last - phase) / TAU).ceil();
            if turning {
                a[0]
            } else {
                a[0] * (last - phase).cos().max((-last - phase).cos())
            }
        };
        let half = 0.5 * a[1] * a[2];
        Aabb::new(
            [-reach(PI), -half, -reach(-0.5 * PI)],
            [reach(0.0), half, reach(0.5 * PI)],
        )
        .grow(a[3])
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        let samples = (64.0 * a[2]).ceil() as usize + 8;
        near_curve(p, samples, a[3], |t| {
            let angle = (2.0 * t - 1.0) * PI * a[2];
            [a[0] * angle.cos(), a[1] * angle / TAU, a[0] * angle.sin()]
        })
    }
}

/// Distance to the curve.
///
/// The squared distance to the point at angle t is rho^2 + radius^2 - 2 rho radius cos(t - theta) + (rise t - y)^2. Its
/// minima lie one to a turn, between theta + 2 pi n and the angle at which the helix has the height y, where half the
/// derivative is concave: Newton's method climbs to the root. The nearest is on the turn whose height is nearest, or, if
/// that is past the end, on the last one, or at the end itself.
#[inline(always)]
fn to_helix<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
    let (radius, rise) = (a.get(0), a.get(1) / R::constant(TAU));
    let last = a.get(2) * R::constant(PI);
    let (rho, theta) = (length2(p.x, p.z), p.z.atan2(p.x));
    let height = p.y / rise;
    let (pull, spring) = (rho * radius, rise * rise);
    // The turns whose theta is on the helix, and one more on each side.
    let turn = inlined(
        #[inline(always)]
        |angle: R| angle / R::constant(TAU),
    );
    let low = -(turn(theta + last).floor());
    let high = turn(-(theta - last)).floor();
    let nearest = turn(height - theta).round();
    // (On a piece of less than a turn there may be none: then both of its neighbours.)
    let none = high.below(low);
    let beside = R::select(none, low - 1.0, nearest.max(low - 1.0).min(high + 1.0));
    let within = nearest.max(low).min(high.max(low));
    let (first, second) = (
        theta + beside * R::constant(TAU),
        theta + within * R::constant(TAU),
    );
    let (up, down) = ((height - first).abs(), (height - second).abs());
    let newton = inlined(
        #[inline(always)]
        |u: R, way: R| {
            let (s, c) = u.sin_cos();
            let slope = (pull * c + spring).max(1e-20);
            let next = u - (pull * s + (u - way) * spring) / slope;
            next.max(0.0).min(R::constant(PI)).min(way)
        },
    );
    let (u, v, _) = R::repeat_while(
        R::constant(20.0),
        (
            newton(p.x.lit(0.0), up),
            newton(p.x.lit(0.0), down),
            p.x.lit(1.0),
        ),
        #[inline(always)]
        |(_, _, change)| change.above(1e-6),
        #[inline(always)]
        |(u, v, _)| {
            let (u2, v2) = (newton(u, up), newton(v, down));
            (u2, v2, (u2 - u).abs() + (v2 - v).abs())
        },
    );
    let at = inlined(
        #[inline(always)]
        |t: R| {
            let (s, c) = t.sin_cos();
            R::norm([p.x - c * radius, p.y - t * rise, p.z - s * radius])
        },
    );
    let on = inlined(
        #[inline(always)]
        |from: R, way: R| {
            let t = R::select((height - from).negative(), from - way, from + way);
            at(t.max(-last).min(last))
        },
    );
    let ends = at(p.x.like(last)).min(at(p.x.like(-last)));
    on(first, u).min(on(second, v)).min(ends)
}
