//! Joins that put a made edge where two surfaces meet: a chamfer, a fillet, stairs, columns.
//!
//! A profile is drawn in the plane of the two distances, between the points (k, 0) and (0, k) of the walls. Beyond them,
//! where the operands differ by more than `k`, all but the fillet leave the minimum alone.

use super::join_style::{Style, StyledIntersection, StyledSubtraction, StyledUnion, whole};
use super::*;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use zeroset_number::{Data, F64};

const RADIUS: Param = number(
    "radius",
    Unit::Length,
    &[0.25],
    SMALL,
    LARGE,
    "Size of the edge: how far up each wall it reaches.",
);

/// The chamfer `(x + y - k) / 2`. Half, and not 1 / sqrt(2) as a distance between walls at right angles would have: the
/// surface is the same, and the slope is that of the operands where the walls are parallel too.
#[inline(always)]
fn slanted<R: Real>(x: R, y: R, k: R::Scalar) -> R {
    (x + y - k) * 0.5
}

/// A flat, slanted edge.
pub struct Chamfer;
impl Style for Chamfer {
    const NAMES: [&'static str; 3] = [
        "chamfer_union",
        "chamfer_intersection",
        "chamfer_subtraction",
    ];
    const DOCS: [&'static str; 3] = [
        "Union with a flat slope over its inner edge.",
        "Intersection with its outer edge cut off.",
        "Subtraction with its outer edge cut off.",
    ];
    const SOURCE: &'static str = "Profile: Mercury 2016, hg_sdf, chamfer";
    const GROUP: &'static str = "Edge joins";
    const PARAMS: &'static [Param] = &[RADIUS];
    const SAMPLES: &'static [&'static [f64]] = &[&[0.02], &[1.5]];
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        x.min(y).min(slanted(x, y, a.get(0)))
    }
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(x, y, a.get(0).hi)
    }
    fn reach(a: &[f64]) -> f64 {
        0.5 * a[0]
    }
}

/// A fillet with true distances between walls at right angles; [`super::join_smooth::Circular`] has the same surface and
/// flatter slopes.
pub struct Fillet;
impl Style for Fillet {
    const NAMES: [&'static str; 3] = ["round_union", "round_intersection", "round_subtraction"];
    const DOCS: [&'static str; 3] = [
        "Union with a circular fillet, offsets of which are circular too.",
        "Intersection with a circular outer edge, offsets of which are circular too.",
        "Subtraction with a circular outer edge, offsets of which are circular too.",
    ];
    const SOURCE: &'static str = "Mercury 2016, hg_sdf, round";
    const GROUP: &'static str = "Edge joins";
    const PARAMS: &'static [Param] = &[RADIUS];
    const SAMPLES: &'static [&'static [f64]] = &[&[0.02], &[1.5]];
    /// Inside, the arc is not followed more than k / 2 below the minimum, so that it ends somewhere.
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let k = a.get(0);
        let (u, v) = ((-(x - k)).max(0.0), (-(y - k)).max(0.0));
        let least = x.min(y);
        (least.like(k).max(least) - length2(u, v)).max(least - k * 0.5)
    }
    /// Beside the arc `k - (k - x)` is `x`, but for rounding: to the bit the minimum is left alone beyond both walls only.
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        let k = a.get(0).hi;
        if x.lo > k && y.lo > k {
            Kept::smaller(x, y, 0.0)
        } else {
            Kept::Both
        }
    }
    /// The derivatives on the arc are a unit vector.
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.hypot(y)
    }
    fn reach(a: &[f64]) -> f64 {
        0.5 * a[0]
    }
    /// By bisection, between no reach and that of a wall, for the arc does not move along with its operands.
    fn fold_reach(a: &[f64], n: usize) -> f64 {
        let size = a[0] as f32;
        let (k, data) = (f64::from(size), Data::from(vec![size]));
        let joined = |x: f64| {
            let mut value = x;
            for _ in 1..n {
                let next = Self::lower(F64(value), F64(x), Args::new(&data)).0;
                if next <= 0.0 || value - next <= 1e-12 * k {
                    return next;
                }
                value = next;
            }
            value
        };
        let (mut reached, mut free) = (0.0, k);
        for _ in 0..40 {
            let x = 0.5 * (reached + free);
            if joined(x) <= 0.0 {
                reached = x
            } else {
                free = x
            }
        }
        free
    }
}

/// Stairs.
pub struct Stairs;
impl Style for Stairs {
    const NAMES: [&'static str; 3] = ["stairs_union", "stairs_intersection", "stairs_subtraction"];
    const DOCS: [&'static str; 3] = [
        "Union with stairs along its inner edge.",
        "Intersection with stairs along its outer edge.",
        "Subtraction with stairs along its outer edge.",
    ];
    const SOURCE: &'static str =
        "After Mercury 2016, hg_sdf, stairs; whole steps that fill the radius";
    const GROUP: &'static str = "Edge joins";
    const PARAMS: &'static [Param] = &[
        RADIUS,
        number("n", Unit::Count, &[3.0], 1.0, 1000.0, "Number of steps."),
    ];
    const SAMPLES: &'static [&'static [f64]] = &[&[1.5, 1.0], &[0.3, 4.0]];
    /// The slope of the chamfer, less a triangle wave along it that turns it into treads (slope by `y` alone) and risers
    /// (by `x` alone).
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let k = a.get(0);
        let two_steps = k / a.get(1) * 2.0;
        let along = (x - y - k) / two_steps;
        let wave = (along - along.round()).abs().proven(
            0.0,
            0.5,
            v3(along, along.lit(0.0), along.lit(0.0)),
            1.0,
        );
        x.min(y).min(slanted(x, y, k) - wave * (two_steps * 0.5))
    }
    /// Half a step beyond the slope.
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        let k = a.get(0).hi;
        Kept::smaller(x, y, k + k / a.get(1).lo.max(1.0))
    }
    /// The middle of the slope is either a corner, half a step out, or between two.
    fn reach(a: &[f64]) -> f64 {
        0.5 * a[0] * (1.0 + 1.0 / a[1])
    }
    fn check(a: &[f64]) -> Result<(), String> {
        whole("n", a[1])
    }
}

/// Half columns on a chamfer.
pub struct Columns;
impl Columns {
    /// Radius of the columns over the radius of the join: `n` of them side by side on the chamfer, the outer ones
    /// touching the walls.
    fn share(n: f64) -> f64 {
        1.0 / (SQRT_2 * (n - 1.0) + 2.0)
    }
}
impl Style for Columns {
    const NAMES: [&'static str; 3] = [
        "columns_union",
        "columns_intersection",
        "columns_subtraction",
    ];
    const DOCS: [&'static str; 3] = [
        "Union with half columns along its inner edge.",
        "Intersection with half-round grooves along its outer edge.",
        "Subtraction with half-round grooves along its outer edge.",
    ];
    const SOURCE: &'static str = "After Mercury 2016, hg_sdf, columns; a whole number of them, without its jumps at the ends";
    const GROUP: &'static str = "Edge joins";
    const PARAMS: &'static [Param] = &[
        RADIUS,
        number("n", Unit::Count, &[3.0], 1.0, 1000.0, "Number of columns."),
    ];
    const SAMPLES: &'static [&'static [f64]] = &[&[1.5, 1.0], &[0.3, 4.0]];
    #[inline(always)]
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        let (k, last) = (a.get(0), a.get(1) - 1.0);
        let radius = k / (last * R::constant(SQRT_2) + 2.0);
        let root = R::constant(FRAC_1_SQRT_2);
        // the nearest column, with columns numbered from 0 along the chamfer
        let place = (x - y) * root / (radius * 2.0) + last * 0.5;
        let column = place.round().max(0.0).min(last);
        let off = (place - column).abs().proven(
            0.0,
            f32::MAX,
            v3(place, place.lit(0.0), place.lit(0.0)),
            1.0,
        );
        let columns = length2((x + y - k) * root, off * (radius * 2.0)) - radius;
        x.min(y).min(slanted(x, y, k)).min(columns)
    }
    /// The columns lie between the walls and touch them: who is `k` nearer to one of them than to the other is beside them.
    fn lower_kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        Kept::smaller(x, y, a.get(0).hi)
    }
    /// The derivatives towards a column's axis are a unit vector.
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.hypot(y)
    }
    /// Most is taken at the axis of a column in the middle.
    fn reach(a: &[f64]) -> f64 {
        a[0] * (0.5 + Columns::share(a[1]))
    }
    /// A column does not grow with both operands. But only where the next operand is less than `k` from what is joined
    /// already does it change anything, and then by no more than the reach.
    fn fold_reach(a: &[f64], n: usize) -> f64 {
        match n {
            0 | 1 => 0.0,
            2 => Self::reach(a),
            _ => Self::reach(a) + a[0].min((n - 2) as f64 * Self::reach(a)),
        }
    }
    fn check(a: &[f64]) -> Result<(), String> {
        whole("n", a[1])
    }
}

/// Union with a chamfer.
pub type ChamferUnion = StyledUnion<Chamfer>;
/// Intersection with a chamfer.
pub type ChamferIntersection = StyledIntersection<Chamfer>;
/// Subtraction with a chamfer.
pub type ChamferSubtraction = StyledSubtraction<Chamfer>;
/// Union with a fillet.
pub type RoundUnion = StyledUnion<Fillet>;
/// Intersection with a fillet.
pub type RoundIntersection = StyledIntersection<Fillet>;
/// Subtraction with a fillet.
pub type RoundSubtraction = StyledSubtraction<Fillet>;
/// Union with stairs.
pub type StairsUnion = StyledUnion<Stairs>;
/// Intersection with stairs.
pub type StairsIntersection = StyledIntersection<Stairs>;
/// Subtraction with stairs.
pub type StairsSubtraction = StyledSubtraction<Stairs>;
/// Union with columns.
pub type ColumnsUnion = StyledUnion<Columns>;
/// Intersection with columns.
pub type ColumnsIntersection = StyledIntersection<Columns>;
/// Subtraction with columns.
pub type ColumnsSubtraction = StyledSubtraction<Columns>;
