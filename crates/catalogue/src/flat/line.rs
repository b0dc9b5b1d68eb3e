//! Drawn lines: straight, round and curved, with a thickness.

use super::conic::largest_root;
use super::*;
use std::f64::consts::{PI, TAU};

/// A straight line with round ends.
pub struct Segment;
impl Primitive for Segment {
    const INFO: Info = flat(
        "segment",
        "A straight line with round ends.",
        "",
        &[
            vec2(
                "start",
                Unit::Length,
                &[-0.5, -0.2],
                -LARGE,
                LARGE,
                "Where it begins.",
            ),
            vec2(
                "end",
                Unit::Length,
                &[0.5, 0.2],
                -LARGE,
                LARGE,
                "Where it ends.",
            ),
            thickness(&[0.3]),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[0.2, 0.1, 0.2, 0.1, 1.0], &[0.0, 1.0, 0.0, -1.0, 0.1]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        edge(p.xy(), a.vec2(0), a.vec2(2)).distance() - a.get(4) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        around([[a[0], a[1]], [a[2], a[3]]], a[4] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (ex, ey, wx, wy) = (a[2] - a[0], a[3] - a[1], x - a[0], y - a[1]);
        let t = ((wx * ex + wy * ey) / (ex * ex + ey * ey).max(1e-300)).clamp(0.0, 1.0);
        (wx - t * ex).hypot(wy - t * ey) <= a[4] / 2.0
    }
}

/// A circle's line.
pub struct Ring;
impl Primitive for Ring {
    const INFO: Info = flat(
        "ring",
        "A circle drawn with a thick line.",
        "",
        &[
            length(
                "radius",
                &[0.8],
                "Distance from the centre to the middle of the line.",
            ),
            thickness(&[0.3]),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.5, 0.99]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        (p.xy().length() - a.get(0)).abs() - a.get(1) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        let r = a[0] + a[1] / 2.0;
        centred(r, r)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let r2 = x * x + y * y;
        let (inner, outer) = (a[0] - a[1] / 2.0, a[0] + a[1] / 2.0);
        r2 <= outer * outer && r2 >= inner * inner
    }
    fn check(a: &[f64]) -> Result<(), String> {
        below("thickness", a[1], 2.0 * a[0], "twice the radius")
    }
}

/// Above this an angle counts as the full turn (359.8 degrees).
pub(super) const FULL: f32 = 6.2797;

/// An angle of a part of a turn, centred on +y.
pub(super) const fn turn(default: &'static [f64; 1], max: f64, doc: &'static str) -> Param {
    number("angle", Unit::Angle, default, 1e-3, max, doc)
}

/// The extreme points of the arc of radius `r` and full angle `angle` around +y.
pub(super) fn arc_points(angle: f64, r: f64) -> Vec<[f64; 2]> {
    let h = (angle / 2.0).min(PI);
    let mut points = vec![
        [r * h.sin(), r * h.cos()],
        [-r * h.sin(), r * h.cos()],
        [0.0, r],
    ];
    if h >= PI / 2.0 {
        points.extend([[r, 0.0], [-r, 0.0]]);
    }
    points
}

/// A part of a circle's line.
pub struct Arc;
impl Primitive for Arc {
    const INFO: Info = flat(
        "arc",
        "A part of a circle around +y, drawn with a thick line with round ends.",
        "",
        &[
            turn(&[1.5 * PI], TAU, "How much of the circle."),
            length("radius", &[0.8], "Radius of the middle of the line."),
            thickness(&[0.3]),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.6, 1.0, 0.2],
        &[PI, 1.0, 0.5],
        &[TAU, 0.6, 0.2],
        &[6.0, 0.8, 0.3],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (s, c) = (a.get(0) * 0.5).sin_cos();
        let q = v2(p.x.abs(), p.y);
        let radius = a.get(1);
        let past = (q.x * c).above(q.y * s) & q.x.like(a.get(0)).below(FULL);
        let end = (q - v2(s * radius, c * radius)).length();
        R::select(past, end, (q.length() - radius).abs()) - a.get(2) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        around(arc_points(a[0], a[1]), a[2] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (half, r, h) = (a[0] / 2.0, a[1], a[2] / 2.0);
        let band = (x.hypot(y) - r).abs() <= h;
        let (s, c) = half.sin_cos();
        let ends = (x.abs() - r * s).hypot(y - r * c) <= h;
        ends || (band && (x.abs().atan2(y) <= half || a[0] >= f64::from(FULL)))
    }
}

/// A bend with two straight legs.
pub struct Horseshoe;
impl Primitive for Horseshoe {
    const INFO: Info = flat(
        "horseshoe",
        "A bend around +y that goes on in two straight legs with square ends.",
        "",
        &[
            turn(&[PI], 6.2, "How much of a circle the bend is."),
            length("radius", &[0.5], "Radius of the middle of the line."),
            number(
                "length",
                Unit::Length,
                &[0.6],
                0.0,
                LARGE,
                "Length of each leg.",
            ),
            thickness(&[0.3]),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[0.8, 1.0, 0.5, 0.2],
        &[4.2, 0.8, 0.4, 0.3],
        &[6.0, 0.8, 0.0, 0.3],
        &[PI, 0.5, 0.2, 0.9],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (s, c) = (a.get(0) * 0.5).sin_cos();
        let (radius, leg, half) = (a.get(1), a.get(2), a.get(3) * 0.5);
        let q = v2(p.x.abs(), p.y);
        // along and across the leg; before it, in the bend, across is along the radius
        let (along, across) = (q.x * c - q.y * s, q.x * s + q.y * c);
        let middle = R::select(along.negative(), q.length(), across) - radius;
        let (side, end) = (middle.abs() - half, along - leg);
        let outside = length2(side.max(0.0), end.max(0.0));
        let beyond = ((across - radius).abs() - half).max(0.0);
        let face = Edge { beyond, right: end };
        R::select(side.max(end).above(0.0), outside, side.max(face.depth()))
    }
    fn bounds(a: &[f64]) -> Aabb {
        let (s, c) = (a[0] / 2.0).sin_cos();
        let (inner, outer) = (a[1] - a[3] / 2.0, a[1] + a[3] / 2.0);
        let mut points = arc_points(a[0], outer);
        for r in [inner, outer] {
            let (x, y) = (r * s + a[2] * c, r * c - a[2] * s);
            points.extend([[x, y], [-x, y]]);
        }
        points.extend(arc_points(a[0], inner));
        around(points, 0.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (half, r, leg, w) = (a[0] / 2.0, a[1], a[2], a[3] / 2.0);
        let band = x.hypot(y) >= r - w && x.hypot(y) <= r + w;
        // the leg as a bar, seen from where it begins
        let (wx, wy) = (x.abs() - r * half.sin(), y - r * half.cos());
        let (along, across) = (
            wx * half.cos() - wy * half.sin(),
            wx * half.sin() + wy * half.cos(),
        );
        (band && x.abs().atan2(y) <= half) || ((0.0..=leg).contains(&along) && across.abs() <= w)
    }
    fn check(a: &[f64]) -> Result<(), String> {
        below("thickness", a[3], 2.0 * a[1], "twice the radius")?;
        let (s, c) = (a[0] / 2.0).sin_cos();
        if c < 0.0 {
            let limit = (a[1] - a[3] / 2.0) * s / -c;
            below("length", a[2], limit, "where the legs would meet")?;
        }
        Ok(())
    }
}

/// A curve through the plane.
pub struct Bezier2d;
impl Primitive for Bezier2d {
    const INFO: Info = flat(
        "bezier2d",
        "A quadratic Bezier curve of the plane, drawn with a thick line with round ends.",
        "distance by the cubic of the foot point, as for a parabola",
        &[
            vec2(
                "start",
                Unit::Length,
                &[-0.7, -0.4],
                -LARGE,
                LARGE,
                "Where it begins.",
            ),
            vec2(
                "control",
                Unit::Length,
                &[0.0, 1.2],
                -LARGE,
                LARGE,
                "Where the tangents of both ends meet.",
            ),
            vec2(
                "end",
                Unit::Length,
                &[0.7, -0.4],
                -LARGE,
                LARGE,
                "Where it ends.",
            ),
            thickness(&[0.2]),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Outside;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[-1.0, 0.0, 0.9, 0.1, -0.5, 0.1, 0.1],
        &[-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.2],
        &[-1.0, 0.0, 0.0, 0.001, 1.0, 0.0, 0.2],
        &[-1.0, 0.0, 0.00001, 0.00002, 1.0, 0.0, 0.2],
        &[0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.5],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        R::bounded_slope(
            p,
            1.0,
            #[inline(always)]
            |p| curve_distance(p.xy(), [a.vec2(0), a.vec2(2), a.vec2(4)]),
        ) - a.get(6) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        let at = |t: f64, k: usize| {
            let s = 1.0 - t;
            s * s * a[k] + 2.0 * s * t * a[2 + k] + t * t * a[4 + k]
        };
        let mut points = vec![[a[0], a[1]], [a[4], a[5]]];
        for k in 0..2 {
            // where the curve turns back along this axis
            let t = (a[k] - a[2 + k]) / (a[k] - 2.0 * a[2 + k] + a[4 + k]);
            if (0.0..=1.0).contains(&t) {
                points.push([at(t, 0), at(t, 1)]);
            }
        }
        around(points, a[6] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let away = |t: f64| {
            let s = 1.0 - t;
            let at = |k: usize| s * s * a[k] + 2.0 * s * t * a[2 + k] + t * t * a[4 + k];
            (at(0) - x).hypot(at(1) - y)
        };
        // a walk along the curve, refined around every place that is nearer than its neighbours
        const STEPS: usize = 48;
        let walk: Vec<f64> = (0..=STEPS).map(|i| away(i as f64 / STEPS as f64)).collect();
        (0..=STEPS).any(|i| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(STEPS));
            if walk[i] > walk[before] || walk[i] > walk[after] {
                return false;
            }
            let (mut lo, mut hi) = (before as f64 / STEPS as f64, after as f64 / STEPS as f64);
            for _ in 0..60 {
                let third = (hi - lo) / 3.0;
                if away(lo + third) < away(hi - third) {
                    hi -= third
                } else {
                    lo += third
                }
            }
            away(lo) <= a[6] / 2.0
        })
    }
}

/// Distance to the quadratic Bezier curve with these control points.
///
/// With `B(t) = a + 2 b t + c t^2` the foot solves the cubic `(B(t) - p) . B'(t) = 0`. Its outer roots are the two local minima,
/// one on each side of the parabola's vertex; clamped to [0, 1] one of them is nearest.
#[inline(always)]
fn curve_distance<R: Real>(p: Vec2<R>, [start, control, end]: [Vec2<R::Scalar>; 3]) -> R {
    let b = control - start;
    let c = end - control - b;
    let (bb, bc) = (b.dot(b), b.dot(c));
    // a curve straighter than this is solved as a line, and refined below all the same
    let (cc, least) = (c.dot(c), bb * 1e-8 + 1e-30);
    let bent = p.x.like(cc).above(least);
    let scale = cc.max(least).recip();
    let vertex = bc * scale;
    let w = -(p - start);
    // with t = s - vertex: s^3 + linear s = constant
    let linear = w.dot(c) * scale + (bb * scale * 2.0 - vertex * vertex * 3.0);
    let constant =
        (w.dot(c) * vertex - w.dot(b)) * scale + (bb * scale - vertex * vertex) * vertex * 2.0;
    let outer = largest_root(linear, constant.abs());
    let apart = (-outer.sq() * 3.0 - linear * 4.0).max(0.0).sqrt();
    let other = (outer + apart) * -0.5;
    let straight = -w.dot(b) / (bb * 2.0 + 1e-30);
    let distance = inlined(
        #[inline(always)]
        |root: R| {
            let mut t = R::choose(bent, root - vertex, straight).clamp01();
            for _ in 0..2 {
                let half = v2(t * c.x, t * c.y) + b;
                let away = w + v2((half.x + b.x) * t, (half.y + b.y) * t);
                let steep = half.length_squared();
                let slope = (steep * 2.0 + away.dot(c)).max(steep * 0.1 + 1e-30);
                t = (t - away.dot(half) / slope).clamp01();
            }
            (w + v2((t * c.x + b.x * 2.0) * t, (t * c.y + b.y * 2.0) * t)).length()
        },
    );
    let flipped = constant.negative();
    let root = inlined(
        #[inline(always)]
        |s: R| R::choose(flipped, -s, s),
    );
    distance(root(outer)).min(distance(root(other)))
}
