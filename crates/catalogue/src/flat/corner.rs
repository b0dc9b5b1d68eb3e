//! Shapes with corners.

use super::*;
use std::f64::consts::{PI, TAU};

/// A rectangle.
pub struct Rectangle;
impl Primitive for Rectangle {
    const INFO: Info = flat(
        "rectangle",
        "A rectangle around the origin.",
        "",
        &[size(&[1.5, 1.0], "Full sides along x and y.")],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        rounded(p.xy().abs() - a.vec2(0) * 0.5)
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        p[0].abs() <= a[0] / 2.0 && p[1].abs() <= a[1] / 2.0
    }
}

/// Distance to a right corner from the distances to its sides.
#[inline(always)]
fn rounded<R: Real>(q: Vec2<R>) -> R {
    let side = q.max_component();
    R::select(side.above(0.0), q.max0().length(), side)
}

/// A rectangle with rounded corners.
pub struct RoundedRectangle;
impl RoundedRectangle {
    /// Radii at the corners +x +y, +x -y, -x -y, -x +y.
    fn radii(a: &[f64]) -> [f64; 4] {
        std::array::from_fn(|k| if a[3 + k] < 0.0 { a[2] } else { a[3 + k] })
    }
}
impl Primitive for RoundedRectangle {
    const INFO: Info = flat(
        "rounded_rectangle",
        "A rectangle with rounded corners, all alike or each its own.",
        "",
        &[
            size(&[1.5, 1.0], "Full sides along x and y."),
            number(
                "radius",
                Unit::Length,
                &[0.2],
                0.0,
                LARGE,
                "Radius of the corners.",
            ),
            number(
                "top_right",
                Unit::Length,
                &[-1.0],
                -1.0,
                LARGE,
                "Radius of this corner; -1 stands for `radius`.",
            ),
            number(
                "bottom_right",
                Unit::Length,
                &[-1.0],
                -1.0,
                LARGE,
                "Radius of this corner; -1 stands for `radius`.",
            ),
            number(
                "bottom_left",
                Unit::Length,
                &[-1.0],
                -1.0,
                LARGE,
                "Radius of this corner; -1 stands for `radius`.",
            ),
            number(
                "top_left",
                Unit::Length,
                &[-1.0],
                -1.0,
                LARGE,
                "Radius of this corner; -1 stands for `radius`.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[
        &[1.5, 1.0, 0.5, -1.0, 0.0, 0.1, 0.3],
        &[1.0, 2.0, 0.0, -1.0, -1.0, -1.0, -1.0],
        &[1.0, 1.0, 0.5, -1.0, -1.0, -1.0, -1.0],
    ];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let radius = inlined(
            #[inline(always)]
            |i: usize| {
                p.x.like(R::Scalar::select(a.get(i).negative(), a.get(2), a.get(i)))
            },
        );
        let (left, below) = (p.x.negative(), p.y.negative());
        let right_side = R::choose(below, radius(4), radius(3));
        let left_side = R::choose(below, radius(5), radius(6));
        let r = R::choose(left, left_side, right_side);
        let q = p.xy().abs() - a.vec2(0) * 0.5;
        rounded(q + v2(r, r)) - r
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let r = Self::radii(a)[match (x >= 0.0, y >= 0.0) {
            (true, true) => 0,
            (true, false) => 1,
            (false, false) => 2,
            (false, true) => 3,
        }];
        let (dx, dy) = (x.abs() - (a[0] / 2.0 - r), y.abs() - (a[1] / 2.0 - r));
        dx <= r && dy <= r && !(dx > 0.0 && dy > 0.0 && dx * dx + dy * dy > r * r)
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let limit = a[0].min(a[1]) / 2.0;
        let most = Self::radii(a).into_iter().fold(0.0, f64::max);
        at_most("a corner's radius", most, limit, "half the shorter side")
    }
}

/// A rectangle with its corners cut off.
pub struct ChamferedRectangle;
impl Primitive for ChamferedRectangle {
    const INFO: Info = flat(
        "chamfered_rectangle",
        "A rectangle with its corners cut off at 45 degrees.",
        "",
        &[
            size(&[1.5, 1.0], "Full sides along x and y."),
            number(
                "chamfer",
                Unit::Length,
                &[0.25],
                0.0,
                LARGE,
                "How much of each side a corner loses.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 2.0, 0.5], &[1.0, 1.0, 0.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let q = p.xy().abs() - a.vec2(0) * 0.5;
        let c = a.get(2);
        let diagonal = R::constant(0.5f64.sqrt());
        let past = inlined(
            #[inline(always)]
            |x: R| (x + c).max(0.0),
        );
        convex([
            Edge {
                beyond: past(q.y),
                right: q.x,
            },
            Edge {
                beyond: past(q.x),
                right: q.y,
            },
            Edge {
                beyond: ((q.x - q.y).abs() * diagonal - c * diagonal).max(0.0),
                right: (q.x + q.y + c) * diagonal,
            },
        ])
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (x, y) = (a[0] / 2.0 - x.abs(), a[1] / 2.0 - y.abs());
        x >= 0.0 && y >= 0.0 && x + y >= a[2]
    }
    fn check(a: &[f64]) -> Result<(), String> {
        at_most(
            "chamfer",
            a[2],
            a[0].min(a[1]) / 2.0,
            "half the shorter side",
        )
    }
}

/// A rhombus on its tip.
pub struct Diamond;
impl Primitive for Diamond {
    const INFO: Info = flat(
        "diamond",
        "A rhombus with its corners on the axes.",
        "",
        &[size(&[1.0, 1.5], "Full diagonals along x and y.")],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.3]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let h = a.vec2(0) * 0.5;
        let o = h.x.lit(0.0);
        let e = edge(p.xy().abs(), v2(h.x, o), v2(o, h.y));
        R::select(e.right.above(0.0), e.distance(), e.right)
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        x.abs() / a[0] + y.abs() / a[1] <= 0.5
    }
}

/// A trapezoid with two equal legs.
pub struct Trapezoid;
impl Primitive for Trapezoid {
    const INFO: Info = flat(
        "trapezoid",
        "A trapezoid with two equal legs, around the origin.",
        "",
        &[
            length("bottom", &[1.5], "Length of the lower side."),
            number(
                "top",
                Unit::Length,
                &[0.8],
                0.0,
                LARGE,
                "Length of the upper side; 0 makes a triangle.",
            ),
            length("height", &[1.0], "Distance between the two."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.5, 2.0, 1.0], &[1.0, 0.0, 1.5]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (b, t, h) = (a.get(0) * 0.5, a.get(1) * 0.5, a.get(2) * 0.5);
        let q = v2(p.x.abs(), p.y);
        convex([
            Edge {
                beyond: (q.x - b).max(0.0),
                right: -q.y - h,
            },
            edge(q, v2(b, -h), v2(t, h)),
            Edge {
                beyond: (q.x - t).max(0.0),
                right: q.y - h,
            },
        ])
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0].max(a[1]) / 2.0, a[2] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let up = y / a[2] + 0.5;
        (0.0..=1.0).contains(&up) && 2.0 * x.abs() <= a[0] + (a[1] - a[0]) * up
    }
}

/// A parallelogram with two level sides.
pub struct Parallelogram;
impl Primitive for Parallelogram {
    const INFO: Info = flat(
        "parallelogram",
        "A parallelogram with two level sides, around the origin.",
        "",
        &[
            length("width", &[1.2], "Length of the level sides."),
            length("height", &[1.0], "Distance between them."),
            number(
                "skew",
                Unit::Length,
                &[0.4],
                -LARGE,
                LARGE,
                "How far the upper side is moved along x against the lower.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.5, -1.5], &[0.5, 2.0, 0.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (w, h, s) = (a.get(0) * 0.5, a.get(1) * 0.5, a.get(2) * 0.5);
        let (lower_left, lower_right) = (v2(-w - s, -h), v2(w - s, -h));
        let (upper_right, upper_left) = (v2(w + s, h), v2(s - w, h));
        let q = p.xy();
        convex([
            edge(q, lower_left, lower_right),
            edge(q, lower_right, upper_right),
            edge(q, upper_right, upper_left),
            edge(q, upper_left, lower_left),
        ])
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred((a[0] + a[2].abs()) / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        y.abs() <= a[1] / 2.0 && (x - a[2] * y / a[1]).abs() <= a[0] / 2.0
    }
}

/// A triangle between three points.
pub struct Triangle2d;
impl Triangle2d {
    /// Twice the area, positive for counterclockwise corners.
    fn area(a: &[f64]) -> f64 {
        (a[2] - a[0]) * (a[5] - a[1]) - (a[3] - a[1]) * (a[4] - a[0])
    }
}
impl Primitive for Triangle2d {
    const INFO: Info = flat(
        "triangle2d",
        "A triangle of the plane between three points.",
        "",
        &[
            vec2(
                "a",
                Unit::Length,
                &[-0.75, -0.5],
                -LARGE,
                LARGE,
                "First corner.",
            ),
            vec2(
                "b",
                Unit::Length,
                &[0.75, -0.5],
                -LARGE,
                LARGE,
                "Second corner.",
            ),
            vec2(
                "c",
                Unit::Length,
                &[0.0, 0.75],
                -LARGE,
                LARGE,
                "Third corner.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.0, 0.0, 0.2, 1.0, 2.0, 0.3]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (first, second, third) = (a.vec2(0), a.vec2(2), a.vec2(4));
        let clockwise = (second - first).cross(third - first).negative();
        let b = Vec2::select(clockwise, third, second);
        let c = Vec2::select(clockwise, second, third);
        let q = p.xy();
        convex([edge(q, first, b), edge(q, b, c), edge(q, c, first)])
    }
    fn bounds(a: &[f64]) -> Aabb {
        around([[a[0], a[1]], [a[2], a[3]], [a[4], a[5]]], 0.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        // by the signs of the three areas that the point makes with the sides
        let part = |i: usize, j: usize| Self::area(&[p[0], p[1], a[i], a[i + 1], a[j], a[j + 1]]);
        let parts = [part(0, 2), part(2, 4), part(4, 0)];
        parts.iter().all(|&s| s >= 0.0) || parts.iter().all(|&s| s <= 0.0)
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let longest = [[0, 2], [2, 4], [4, 0]]
            .map(|[i, j]: [usize; 2]| (a[j] - a[i]).powi(2) + (a[j + 1] - a[i + 1]).powi(2))
            .into_iter()
            .fold(0.0, f64::max);
        if Self::area(a).abs() > 1e-6 * longest {
            Ok(())
        } else {
            Err("the three corners must not lie on a line".into())
        }
    }
}

/// A regular polygon.
pub struct Ngon;
impl Ngon {
    fn corners(a: &[f64]) -> Vec<[f64; 2]> {
        let corner = |k: usize| {
            let (s, c) = (TAU * k as f64 / a[0]).sin_cos();
            [a[1] * s, a[1] * c]
        };
        (0..a[0] as usize).map(corner).collect()
    }
}
impl Primitive for Ngon {
    const INFO: Info = flat(
        "ngon",
        "A regular polygon with a corner at the top.",
        "",
        &[
            number("sides", Unit::Count, &[6.0], 3.0, 1000.0, "How many sides."),
            length("radius", &[0.8], "Distance from the centre to a corner."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[3.0, 1.0], &[5.0, 0.7], &[17.0, 1.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let sector = a.get(0).recip() * R::constant(TAU);
        let x = p.x.abs();
        // the edge nearest in direction, turned upwards
        let middle = ((x.atan2(p.y) / sector).floor() + 0.5) * sector;
        let (s, c) = middle.sin_cos();
        let (along, up) = (x * c - p.y * s, x * s + p.y * c);
        let (half_edge, apothem) = (sector * 0.5).sin_cos();
        let over = up - apothem * a.get(1);
        let beyond = (along.abs() - half_edge * a.get(1)).max(0.0);
        R::select(over.above(0.0), length2(over, beyond), over)
    }
    fn bounds(a: &[f64]) -> Aabb {
        around(Self::corners(a), 0.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        odd(&Self::corners(a), [p[0], p[1]])
    }
    fn check(a: &[f64]) -> Result<(), String> {
        whole("sides", a[0])
    }
}

/// A star.
pub struct Star;
impl Star {
    fn corners(a: &[f64]) -> Vec<[f64; 2]> {
        let corner = |k: usize| {
            let (s, c) = (PI * k as f64 / a[0]).sin_cos();
            let r = if k.is_multiple_of(2) { a[1] } else { a[2] };
            [r * s, r * c]
        };
        (0..2 * a[0] as usize).map(corner).collect()
    }
}
impl Primitive for Star {
    const INFO: Info = flat(
        "star",
        "A star with a point at the top.",
        "",
        &[
            number(
                "points",
                Unit::Count,
                &[5.0],
                3.0,
                1000.0,
                "How many points.",
            ),
            length("radius", &[0.9], "Distance from the centre to a point."),
            length("inner", &[0.4], "Distance from the centre to a notch."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[3.0, 1.0, 0.1], &[12.0, 1.0, 0.8], &[4.0, 0.5, 1.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let half = a.get(0).recip() * R::constant(PI);
        let x = p.x.abs();
        // the point nearest in direction, turned upwards
        let at = (x.atan2(p.y) / (half * 2.0)).round() * (half * 2.0);
        let (s, c) = at.sin_cos();
        let q = v2((x * c - p.y * s).abs(), x * s + p.y * c);
        let (s, c) = half.sin_cos();
        let (radius, inner) = (a.get(1), a.get(2));
        let e = edge(q, v2(s * inner, c * inner), v2(s * 0.0, radius));
        e.distance().copysign(e.right)
    }
    fn bounds(a: &[f64]) -> Aabb {
        around(Self::corners(a), 0.0)
    }
    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        odd(&Self::corners(a), [p[0], p[1]])
    }
    fn check(a: &[f64]) -> Result<(), String> {
        whole("points", a[0])
    }
}

/// Two crossed bars.
pub struct Cross;
impl Primitive for Cross {
    const INFO: Info = flat(
        "cross",
        "Two equal bars crossed at right angles.",
        "",
        &[
            length("size", &[1.5], "Full length of the bars."),
            length("width", &[0.5], "Full width of the bars."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.1], &[1.0, 0.9]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (reach, half) = (a.get(0) * 0.5, a.get(1) * 0.5);
        let q = p.xy().abs();
        let upright = q.x.below(q.y);
        let (far, near) = (R::select(upright, q.y, q.x), R::select(upright, q.x, q.y));
        let (end, right) = (far - reach, near - half);
        // from inside, the long side begins where the bars part
        let beyond = (-far + half).max(0.0);
        let inside = end.max(Edge { beyond, right }.depth());
        R::select(end.max(right).above(0.0), rounded(v2(end, right)), inside)
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[0] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (x, y, l, w) = (x.abs(), y.abs(), a[0] / 2.0, a[1] / 2.0);
        (x <= l && y <= w) || (x <= w && y <= l)
    }
    fn check(a: &[f64]) -> Result<(), String> {
        at_most("width", a[1], a[0], "the size")
    }
}
