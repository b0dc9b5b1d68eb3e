//! Shapes of the plane: fields of x and y alone, made solid by `extrude` and `revolve`.
//!
//! All are symmetric where they can be, centred on the origin or hung on it, and open or point along +y. Exact distances to
//! straight and circular parts are common knowledge (Quilez, 2D distance functions, collects them); others name their source.

use super::*;
use zeroset_number::{Ends, Ops, Vec2, inlined, v2};

mod conic;
mod corner;
mod line;
mod outline;
mod round;
mod strip;

pub use conic::*;
pub use corner::*;
pub use line::*;
pub use outline::*;
pub use round::*;
pub use strip::{Strips, strips};

/// The words of a 2D shape.
const fn flat(
    name: &'static str,
    doc: &'static str,
    source: &'static str,
    params: &'static [Param],
) -> Info {
    Info {
        name,
        doc,
        source,
        group: "2D shapes",
        dimension: Dimension::Two,
        params,
    }
}

/// A length that must be there.
const fn length(name: &'static str, default: &'static [f64; 1], doc: &'static str) -> Param {
    number(name, Unit::Length, default, SMALL, LARGE, doc)
}

/// Full extents along x and y.
const fn size(default: &'static [f64; 2], doc: &'static str) -> Param {
    vec2("size", Unit::Length, default, SMALL, LARGE, doc)
}

/// The full width of a drawn line.
const fn thickness(default: &'static [f64; 1]) -> Param {
    length("thickness", default, "Full width of the line.")
}

/// Where a point lies against an edge of the plane.
#[derive(Clone, Copy)]
struct Edge<R> {
    /// How far past the nearer end, along the edge.
    beyond: R,
    /// How far to the right, looking from start to end: outside, for an edge of a counterclockwise contour.
    right: R,
}

impl<R: Real> Edge<R> {
    /// Distance to the edge. (Its gradient is right on the edge too, where that of the length of a zero vector is not.)
    #[inline(always)]
    fn distance(self) -> R {
        let corner = length2(self.beyond, self.right);
        R::select(self.beyond.above(0.0), corner, self.right.abs())
    }

    /// Minus the distance to the edge, for a point that does not lie to the right of it.
    #[inline(always)]
    fn depth(self) -> R {
        let corner = length2(self.beyond, self.right);
        R::select(self.beyond.above(0.0), -corner, self.right)
    }

    #[inline(always)]
    fn distance_squared(self) -> R {
        self.beyond.sq() + self.right.sq()
    }
}

/// `p` against the edge between two points, which may coincide.
///
/// The two components stay apart until the end, because beside the edge `beyond` is exactly zero: the gradient is then the
/// edge's normal even where the distance is all rounding.
#[inline(always)]
fn edge<R: Real>(p: Vec2<R>, from: Vec2<R::Scalar>, to: Vec2<R::Scalar>) -> Edge<R> {
    let e = to - from;
    let length = e.length();
    let point = length.below(1e-12);
    let along = v2(
        R::Scalar::select(point, length.lit(1.0), e.x.unit(length)),
        R::Scalar::select(point, length.lit(0.0), e.y.unit(length)),
    );
    let w = p - from;
    let half = length * 0.5;
    Edge {
        beyond: ((w.dot(along) - half).abs() - half).max(0.0),
        right: w.cross(along),
    }
}

/// Distance to a convex contour from its edges in counterclockwise order (or from those that can be nearest, if the point was
/// folded by symmetry).
#[inline(always)]
fn convex<R: Real, const N: usize>(edges: [Edge<R>; N]) -> R {
    let (mut right, mut nearest) = (edges[0].right, edges[0].distance_squared());
    for e in &edges[1..] {
        right = right.max(e.right);
        nearest = nearest.min(e.distance_squared());
    }
    R::select(right.above(0.0), nearest.sqrt(), right)
}

/// The box of a flat shape between two corners.
fn span(min: [f64; 2], max: [f64; 2]) -> Aabb {
    Aabb {
        min: [min[0], min[1], f64::NEG_INFINITY],
        max: [max[0], max[1], f64::INFINITY],
    }
}

/// The box of a flat shape with these half extents.
fn centred(x: f64, y: f64) -> Aabb {
    span([-x, -y], [x, y])
}

/// The box around points.
fn around(points: impl IntoIterator<Item = [f64; 2]>, grow: f64) -> Aabb {
    let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in points {
        for k in 0..2 {
            min[k] = min[k].min(p[k] - grow);
            max[k] = max[k].max(p[k] + grow);
        }
    }
    span(min, max)
}

/// Whether a ray upwards crosses the closed contour through these points an odd number of times.
fn odd(points: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    let mut a = points[points.len() - 1];
    for &b in points {
        if (a[0] <= x) != (b[0] <= x) {
            let t = (x - a[0]) / (b[0] - a[0]);
            inside ^= a[1] + t * (b[1] - a[1]) > y;
        }
        a = b;
    }
    inside
}

/// A parameter that counts must be whole.
fn whole(name: &str, value: f64) -> Result<(), String> {
    if value.fract() == 0.0 {
        Ok(())
    } else {
        Err(format!("{name} must be a whole number, not {value}"))
    }
}

/// A parameter must be below a limit that another sets.
fn below(name: &str, value: f64, limit: f64, why: &str) -> Result<(), String> {
    if value < limit {
        Ok(())
    } else {
        Err(format!("{name} must be below {limit} ({why}), not {value}"))
    }
}

/// A parameter must not be above a limit that another sets.
fn at_most(name: &str, value: f64, limit: f64, why: &str) -> Result<(), String> {
    if value <= limit * (1.0 + 1e-6) {
        Ok(())
    } else {
        Err(format!(
            "{name} must be at most {limit} ({why}), not {value}"
        ))
    }
}

#[cfg(test)]
mod tests;
