//! Round shapes: circles and what arcs of circles enclose.

use super::line::{FULL, arc_points, turn};
use super::*;
use std::f64::consts::{FRAC_PI_2, SQRT_2, TAU};

/// A disc.
pub struct Circle;
impl Primitive for Circle {
    const INFO: Info = flat(
        "circle",
        "A disc around the origin.",
        "",
        &[length(
            "radius",
            &[0.8],
            "Distance from the centre to the edge.",
        )],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        p.xy().length() - a.get(0)
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0], a[0])
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        x * x + y * y <= a[0] * a[0]
    }
}

/// A piece of pie.
pub struct Pie;
impl Primitive for Pie {
    const INFO: Info = flat(
        "pie",
        "A sector of a disc around +y.",
        "",
        &[
            turn(&[FRAC_PI_2], TAU, "Opening of the sector."),
            length("radius", &[1.0], "Radius of the disc."),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.3, 1.0], &[4.5, 0.8], &[TAU, 1.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (s, c) = (a.get(0) * 0.5).sin_cos();
        let q = v2(p.x.abs(), p.y);
        let rim = q.length() - a.get(1);
        let e = edge(q, v2(s * 0.0, s * 0.0), v2(s * a.get(1), c * a.get(1)));
        let wedge = rim.max(e.distance().copysign(e.right));
        R::select(q.x.like(a.get(0)).above(FULL), rim, wedge)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let mut points = arc_points(a[0], a[1]);
        points.push([0.0, 0.0]);
        around(points, 0.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        x.hypot(y) <= a[1] && (x.abs().atan2(y) <= a[0] / 2.0 || a[0] > f64::from(FULL))
    }
}

/// A lens.
pub struct Vesica;
impl Primitive for Vesica {
    const INFO: Info = flat(
        "vesica",
        "A lens: what two equal discs side by side have in common.",
        "",
        &[size(
            &[0.8, 1.5],
            "Full width and height, the height not less than the width.",
        )],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 1.0], &[0.3, 2.0]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (w, h) = (a.get(0) * 0.5, a.get(1) * 0.5);
        // the right arc's circle has its centre at -d
        let d = (h * h - w * w) / (w * 2.0);
        let q = p.xy().abs();
        let beyond = ((q.y - h) * d).above(q.x * h);
        let tip = length2(q.x, q.y - h);
        let arc = length2(q.x + d, q.y) - (d + w);
        R::select(beyond, tip, arc)
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[1] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (w, h) = (a[0] / 2.0, a[1] / 2.0);
        let d = (h * h - w * w) / (2.0 * w);
        (x + d).hypot(y) <= d + w && (x - d).hypot(y) <= d + w
    }
    fn check(a: &[f64]) -> Result<(), String> {
        at_most("the width", a[0], a[1], "the height")
    }
}

/// A crescent.
pub struct Moon;
impl Moon {
    /// The corner above the x axis.
    fn corner(a: &[f64]) -> [f64; 2] {
        let x = (a[0] * a[0] - a[1] * a[1] + a[2] * a[2]) / (2.0 * a[2]);
        [x, (a[0] * a[0] - x * x).max(0.0).sqrt()]
    }
}
impl Primitive for Moon {
    const INFO: Info = flat(
        "moon",
        "A disc with a bite: a crescent that opens along +x.",
        "",
        &[
            length("radius", &[0.9], "Radius of the disc."),
            length("bite", &[0.8], "Radius of the bite."),
            length(
                "offset",
                &[0.5],
                "How far along x the bite's centre is from the disc's.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] =
        &[&[1.0, 0.3, 1.0], &[0.5, 2.0, 2.0], &[1.0, 1.0, 1.5]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let (radius, bite, offset) = (a.get(0), a.get(1), a.get(2));
        let x = (radius * radius - bite * bite + offset * offset) / (offset * 2.0);
        let corner = v2(x, (radius * radius - x * x).max(0.0).sqrt());
        let q = v2(p.x, p.y.abs());
        let c = v2(q.x - offset, q.y);
        let (disc, hole) = (q.length() - radius, -(c.length() - bite));
        // outside, each arc counts where the point lies in its sector; the corner always counts
        let to_corner = (q - corner).length();
        let disc_sector = !(q.x * corner.y).above(q.y * corner.x);
        let hole_sector = !(c.x * corner.y).above(c.y * (corner.x - offset));
        let outer = R::select(disc_sector & disc.above(0.0), disc, to_corner);
        let inner = R::select(hole_sector & hole.above(0.0), hole, to_corner);
        let inside = disc.max(hole);
        R::select(inside.above(0.0), outer.min(inner).min(to_corner), inside)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let [x, y] = Self::corner(a);
        let tall = if x >= 0.0 { a[0] } else { y };
        span([-a[0], -tall], [x, tall])
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        x.hypot(y) <= a[0] && (x - a[2]).hypot(y) >= a[1]
    }
    fn check(a: &[f64]) -> Result<(), String> {
        let (least, most) = ((a[0] - a[1]).abs(), a[0] + a[1]);
        if least < a[2] && a[2] < most {
            Ok(())
        } else {
            Err(format!(
                "the circles must cross: offset must be between {least} and {most}, not {}",
                a[2]
            ))
        }
    }
}

/// A heart.
pub struct Heart;
impl Heart {
    /// Height of the heart whose square has diagonals of length 1.
    const TALL: f64 = 0.75 + SQRT_2 / 4.0;
}
impl Primitive for Heart {
    const INFO: Info = flat(
        "heart",
        "A heart with its tip down: a square and two half discs.",
        "",
        &[length("height", &[1.4], "Full height.")],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[0.5]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let scale = a.get(0) * R::constant(1.0 / Self::TALL);
        let q = v2(p.x.abs(), p.y + a.get(0) * 0.5);
        // the square's side from the tip, the notch and the half disc
        let (along, right) = (
            (q.x + q.y) * R::constant(SQRT_2 / 2.0),
            (q.x - q.y) * R::constant(SQRT_2 / 2.0),
        );
        let side = Edge {
            beyond: (-along).max(0.0),
            right,
        };
        let notch = length2(q.x, q.y - scale);
        let round =
            length2(q.x - scale * 0.25, q.y - scale * 0.75) - scale * R::constant(SQRT_2 / 4.0);
        let straight = side.distance().min(notch).copysign(right);
        R::select((q.x + q.y).above(scale), round, straight)
    }
    fn bounds(a: &[f64]) -> Aabb {
        let wide = a[0] / Self::TALL * (0.25 + SQRT_2 / 4.0);
        centred(wide, a[0] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let scale = a[0] / Self::TALL;
        let (x, y) = (x.abs() / scale, (y + a[0] / 2.0) / scale);
        (x <= y && x + y <= 1.0) || (x - 0.25).hypot(y - 0.75) <= SQRT_2 / 4.0
    }
}

/// An egg.
pub struct Egg;
impl Primitive for Egg {
    const INFO: Info = flat(
        "egg",
        "An egg of four arcs, its tip up; the big end's centre is the origin.",
        "Moss's egg (Dixon 1987, Mathographics)",
        &[
            length("radius", &[0.6], "Radius of the big end."),
            number(
                "tip",
                Unit::Length,
                &[0.25],
                0.0,
                LARGE,
                "Radius of the tip.",
            ),
        ],
    );
    const EXACTNESS: Exactness = Exactness::Exact;
    const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 0.0], &[0.5, 0.5]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let tip = a.get(1);
        let r = a.get(0) - tip;
        let root = R::constant(3f64.sqrt());
        let q = v2(p.x.abs(), p.y);
        let big = q.length() - r;
        let flank = length2(q.x + r, q.y) - r * 2.0;
        let small = length2(q.x, q.y - r * root);
        let top = ((q.x + r) * root).below(q.y);
        R::select(q.y.negative(), big, R::select(top, small, flank)) - tip
    }
    fn bounds(a: &[f64]) -> Aabb {
        span([-a[0], -a[0]], [a[0], (a[0] - a[1]) * 3f64.sqrt() + a[1]])
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (x, r, tip) = (x.abs(), a[0] - a[1], a[1]);
        let top = 3f64.sqrt() * r;
        // the small circle's sector, the flank's sector, the big end
        if y <= 0.0 {
            x.hypot(y) <= a[0]
        } else if x.atan2(y - top) <= std::f64::consts::FRAC_PI_6 {
            x.hypot(y - top) <= tip
        } else {
            (x + r).hypot(y) <= 2.0 * r + tip
        }
    }
    fn check(a: &[f64]) -> Result<(), String> {
        at_most("tip", a[1], a[0], "the radius")
    }
}

/// Between a square and a circle.
pub struct Squircle;
impl Primitive for Squircle {
    const INFO: Info = flat(
        "squircle",
        "Between a circle and a square: a mix of their implicit equations.",
        "Munini 2021, section 2.2, as the gauge of its convex curve",
        &[
            length("size", &[1.4], "Full width and height."),
            number(
                "squareness",
                Unit::Ratio,
                &[0.5],
                0.0,
                1.0,
                "0 is the circle, 1 the square.",
            ),
        ],
    );
    /// Munini's curve is `k (m - 1) + (1 - k) (r^2 - 1) = 0` with `m = max(|x|, |y|)` and `r` the distance from the centre. Its
    /// left side has no Lipschitz constant, and over a box a poor one. Asking instead by how much the curve must be
    /// scaled to pass through the point (dividing x and y by s, and solving for s) gives
    /// `s = (k m + sqrt(k^2 m^2 + 4 (1 - k) r^2)) / 2`, the gauge of a convex set that holds the unit disc: a norm that is at
    /// most r, so its slope is at most 1, and `s - 1` is a bound; for k = 0 it is the distance.
    const EXACTNESS: Exactness = Exactness::Bound;
    const SAMPLES: &'static [&'static [f64]] = &[&[2.0, 0.0], &[1.0, 1.0], &[2.0, 0.9]];
    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let k = a.get(1);
        let q = p.xy().abs();
        let m = q.max_component() * k;
        let rest = k.one_minus().sqrt() * 2.0;
        (m + R::norm([m, q.x * rest, q.y * rest]) - a.get(0)) * 0.5
    }
    fn bounds(a: &[f64]) -> Aabb {
        centred(a[0] / 2.0, a[0] / 2.0)
    }
    fn contains(a: &[f64], [x, y, _]: [f64; 3]) -> bool {
        let (x, y, k) = (2.0 * x / a[0], 2.0 * y / a[0], a[1]);
        k * (x.abs().max(y.abs()) - 1.0) + (1.0 - k) * (x * x + y * y - 1.0) <= 0.0
    }
}
