//! Maps that bend along true circular arcs.
//!
//! At distance rho from the centre of an arc of radius R, ways along it are `R / rho` times as long in the shape; all else
//! keeps its length. So the stretch ends at the centre, which must lie outside the box of the result, and with it the half
//! plane behind the centre where the two ends of space meet.

use super::*;
use std::f64::consts::PI;
use zeroset_number::Ops;

/// Distance from the point `c` to the rectangle that `b` has in the plane of the axes `u` and `v`.
fn clearance(b: &Aabb, (u, v): (usize, usize), c: [f64; 2]) -> f64 {
    let off = |k: usize, c: f64| (b.min[k] - c).max(c - b.max[k]).max(0.0);
    off(u, c[0]).hypot(off(v, c[1]))
}

/// The stretch inside `b` for arcs about the point `c` of the plane of the axes `u` and `v`; on the far side of `c` along
/// `v` (or the near one, if `behind` is negative) the map is torn.
fn arc_stretch(
    b: &Aabb,
    (u, v): (usize, usize),
    c: [f64; 2],
    radius: f64,
    behind: f64,
) -> Result<Stretch, String> {
    if b.is_empty() {
        return Ok(Stretch::Within(*b, 1.0));
    }
    let rho = clearance(b, (u, v), c);
    let across = b.min[u] < c[0] && c[0] < b.max[u];
    let beyond = if behind > 0.0 {
        b.max[v] >= c[1]
    } else {
        b.min[v] <= c[1]
    };
    if rho <= 0.0 || (across && beyond) {
        return Err(format!(
            "the bent shape reaches the arc's centre, {radius:.4} from its middle, or beyond; bend less than half a turn, \
             around a larger radius, or a thinner or shorter shape"
        ));
    }
    Ok(Stretch::Within(*b, (radius / rho).max(1.0)))
}

/// The range of `sin` over the angles `from..=to`.
fn sine_range(from: f64, to: f64) -> (f64, f64) {
    let has =
        |angle: f64| ((to - angle) / (2.0 * PI)).floor() >= ((from - angle) / (2.0 * PI)).ceil();
    let (a, b) = (from.sin(), to.sin());
    (
        if has(-0.5 * PI) { -1.0 } else { a.min(b) },
        if has(0.5 * PI) { 1.0 } else { a.max(b) },
    )
}

/// Products of the ranges of a radius (not negative) and a sine or cosine.
fn spread((lo, hi): (f64, f64), (from, to): (f64, f64)) -> (f64, f64) {
    let times = |r: f64, s: f64| if s == 0.0 { 0.0 } else { r * s };
    (
        times(lo, from).min(times(hi, from)),
        times(lo, to).max(times(hi, to)),
    )
}

/// The x axis bent towards y, with straight ends.
pub struct Bend;
impl Bend {
    /// Angle per length; never 0, for which the formulas have a limit but no value.
    fn curvature(a: &[f64]) -> f64 {
        let k = a[0] / a[1];
        if k.abs() < 1e-6 { 1e-6 } else { k }
    }
}
impl Map for Bend {
    const INFO: Info = Info {
        name: "bend",
        doc: "Bends the shape's x axis along a circular arc towards y; beyond the arc it goes on straight.",
        source: "Barr 1984, global linear bends",
        group: "Deformations",
        dimension: Dimension::Any,
        params: &[
            number(
                "angle",
                Unit::Angle,
                &[PI / 3.0],
                -PI,
                PI,
                "Angle between the two ends; negative bends towards -y.",
            ),
            number(
                "length",
                Unit::Length,
                &[2.0],
                SMALL,
                LARGE,
                "Length of the part that is bent, half on each side of x = 0.",
            ),
        ],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[0.0, 1.0], &[-0.7, 1.0], &[1.2, 3.0]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let bent = a.get(0) / a.get(1);
        let k = R::Scalar::select(bent.abs().below(1e-6), bent.lit(1e-6), bent);
        let half = a.get(1) * 0.5;
        // both ends are alike
        let x = p.x.abs();
        // on the arc, whose centre is (0, 1 / k), in a form that loses no digits where k is small
        let (u, v) = (x * k, (p.y * k).one_minus());
        let arc = v2(
            u.atan2(v) / k,
            (p.y * 2.0 - (x.sq() + p.y.sq()) * k) / (length2(u, v) + 1.0),
        );
        // beyond it, along the tangent at its end
        let (s, c) = (half * k).sin_cos();
        let lower = (half * k * 0.5).sin();
        let (x_end, y_end) = (x - s / k, p.y - lower * lower * 2.0 / k);
        let end = v2(x_end * c + y_end * s, y_end * c - x_end * s);
        let q = Vec2::select(end.x.above(0.0), v2(end.x + half, end.y), arc);
        v3(q.x.copysign(p.x), q.y, p.z)
    }
    fn stretch(a: &[f64], bounds: &Aabb) -> Result<Stretch, String> {
        let k = Bend::curvature(a);
        arc_stretch(bounds, (0, 1), [0.0, 1.0 / k], 1.0 / k.abs(), k)
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        if shape.is_empty() {
            return *shape;
        }
        let (k, half) = (Bend::curvature(a), 0.5 * a[1]);
        // towards +y; the other way is its mirror image
        let (radius, mut y) = (1.0 / k.abs(), [shape.min[1], shape.max[1]]);
        if k < 0.0 {
            y = [-y[1], -y[0]];
        }
        let mut b = Aabb::EMPTY;
        let mut hold = |x: (f64, f64), y: (f64, f64)| {
            b = b.hull(&Aabb::new(
                [x.0, y.0, shape.min[2]],
                [x.1, y.1, shape.max[2]],
            ));
        };
        let (from, to) = (shape.min[0].max(-half), shape.max[0].min(half));
        if from <= to {
            let rho = ((radius - y[1]).max(0.0), (radius - y[0]).max(0.0));
            let (sine, cosine) = (
                sine_range(from / radius, to / radius),
                sine_range(from / radius + 0.5 * PI, to / radius + 0.5 * PI),
            );
            let (x, down) = (spread(rho, sine), spread(rho, cosine));
            hold(x, (radius - down.1, radius - down.0));
        }
        let (s, c) = (half / radius).sin_cos();
        for (way, from, to) in [
            (1.0, shape.min[0], shape.max[0]),
            (-1.0, -shape.max[0], -shape.min[0]),
        ] {
            if to > half {
                let end = Aabb::new([from.max(half) - half, y[0], 0.0], [to - half, y[1], 0.0]);
                let rise = 2.0 * radius * (0.5 * half / radius).sin().powi(2);
                let e = map::image(
                    [[c, -s, 0.0], [s, c, 0.0], [0.0; 3]],
                    [radius * s, rise, 0.0],
                    &end,
                );
                let x = map::scaled(way, e.min[0], e.max[0]);
                hold(x, (e.min[1], e.max[1]));
            }
        }
        if k < 0.0 {
            (b.min[1], b.max[1]) = (-b.max[1], -b.min[1]);
        }
        b
    }
}

/// The x axis wrapped around y.
pub struct Wrap;
impl Map for Wrap {
    const INFO: Info = Info {
        name: "wrap",
        doc: "Wraps the shape's x axis around the y axis; what faced z faces away from the axis.",
        source: "Barr 1984, global linear bends",
        group: "Deformations",
        dimension: Dimension::Three,
        params: &[number(
            "radius",
            Unit::Length,
            &[1.0],
            SMALL,
            LARGE,
            "Distance from the y axis at which lengths stay.",
        )],
    };
    const SAMPLES: &'static [&'static [f64]] = &[&[2.5], &[0.8]];
    #[inline(always)]
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(p.x.atan2(p.z) * a.get(0), p.y, length2(p.x, p.z) - a.get(0))
    }
    fn stretch(a: &[f64], bounds: &Aabb) -> Result<Stretch, String> {
        arc_stretch(bounds, (0, 2), [0.0, 0.0], a[0], -1.0)
    }
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        let rho = ((shape.min[2] + a[0]).max(0.0), shape.max[2] + a[0]);
        let (from, to) = (
            (shape.min[0] / a[0]).max(-PI),
            (shape.max[0] / a[0]).min(PI),
        );
        if shape.is_empty() || rho.1 < 0.0 || from > to {
            return Aabb::EMPTY;
        }
        let x = spread(rho, sine_range(from, to));
        let z = spread(rho, sine_range(from + 0.5 * PI, to + 0.5 * PI));
        Aabb::new([x.0, shape.min[1], z.0], [x.1, shape.max[1], z.1])
    }
}
