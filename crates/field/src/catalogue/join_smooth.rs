//! Joins that round the edge where two surfaces meet.

use super::*;

/// `radius`, the support of a smooth join: where the operands differ by more, it leaves them alone.
const RADIUS: Param = number(
    "radius",
    Unit::Length,
    &[0.25],
    SMALL,
    LARGE,
    "Where the operands differ by more than this, nothing changes.",
);

/// The quadratic smooth minimum, `min(x, y) - max(k - |x - y|, 0)^2 / (4 k)`.
#[inline(always)]
fn quadratic<R: Real>(x: R, y: R, k: R::Scalar) -> R {
    let h = (-((x - y).abs() - k)).max(0.0);
    x.min(y) - h.sq() / (k * 4.0)
}

/// Union with a rounded inner edge.
pub struct SmoothUnion;
impl Join for SmoothUnion {
    const INFO: Info = Info {
        name: "smooth_union",
        doc: "Union with a smooth inner edge (quadratic).",
        source: "Quilez 2013, quadratic polynomial smooth minimum",
        group: "Smooth joins",
        dimension: Dimension::Any,
        params: &[RADIUS],
    };
    const SHARP: bool = false;
    #[inline(always)]
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        quadratic(x, y, a.get(0))
    }
    /// The two derivatives are positive and sum to one.
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.max(y)
    }
    /// At most `k / 4` is taken from the minimum.
    fn bounds(a: &[f64], x: &Aabb, y: &Aabb) -> Aabb {
        x.hull(y).grow(0.25 * a[0])
    }
    fn exactness(x: Exactness, y: Exactness) -> Exactness {
        x.max(y).max(Exactness::Bound)
    }
    fn reach(a: &[f64]) -> f64 {
        a[0]
    }
    fn contains(x: bool, y: bool) -> bool {
        x || y
    }
}
