//! Placements, continuations beyond a box, and the cells and walls of repetitions.

use super::{Change, Warp};
use zeroset_number::hash::Hash;
use zeroset_number::{Args, Ops, Real, SingleInterval, Vec3, length2, v3};

/// `p - a`
pub struct Offset;

impl Warp for Offset {
    #[inline(always)]
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(p.x - a.get(0), p.y - a.get(1), p.z - a.get(2))
    }
}

/// `M p + c`, M by rows, then c.
pub struct Rigid;

impl Warp for Rigid {
    #[inline(always)]
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(
            p.x * a.get(0) + p.y * a.get(1) + p.z * a.get(2) + a.get(9),
            p.x * a.get(3) + p.y * a.get(4) + p.z * a.get(5) + a.get(10),
            p.x * a.get(6) + p.y * a.get(7) + p.z * a.get(8) + a.get(11),
        )
    }
}

/// The point of a box (smallest corner, largest corner) that is nearest to `p`.
pub struct Clamp;

/// Whether a box lies within another one, whose corners are parameters.
fn within(p: Vec3<SingleInterval>, a: Args<'_, SingleInterval>) -> bool {
    (p.array().iter().enumerate()).all(|(k, c)| a.get(k).hi < c.lo && c.hi < a.get(k + 3).lo)
}

impl Warp for Clamp {
    fn keeps(p: Vec3<SingleInterval>, a: Args<'_, SingleInterval>) -> bool {
        within(p, a)
    }
    #[inline(always)]
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        v3(
            p.x.held(a.get(0), a.get(3)),
            p.y.held(a.get(1), a.get(4)),
            p.z.held(a.get(2), a.get(5)),
        )
    }
}

/// Away from a box (smallest corner, largest corner) along an axis.
#[inline(always)]
fn away<R: Real>(x: R, a: Args<'_, R>, k: usize) -> R {
    x - x.max(a.get(k)).min(a.get(k + 3))
}

/// `a d`
pub struct Scale;

impl Change for Scale {
    #[inline(always)]
    fn change<R: Real>(d: R, _p: Vec3<R>, a: Args<'_, R>) -> R {
        d * a.get(0)
    }
}

/// The value `d` of the nearest point of a box (six numbers, then the slope of `d` inside it), continued to `p` outside:
/// `hypot(slope |p - box|, d)`.
///
/// The solid lies inside the box, which is convex: for a point q of it and the box's nearest point c,
/// |p - q|^2 >= |p - c|^2 + |c - q|^2, so that this never overestimates (Tomczak 2012, algorithm 4.1, corrected). It has
/// the slope that `d` has inside the box.
///
/// A solid that reaches the side of the box is cut there: inside, the value is no less than that of the box itself. Where
/// the solid ends before the side, `d` never is.
///
/// A value that is not a number, as formulas of unproven slope may have at single places, counts as far outside.
pub struct Continue;

impl Change for Continue {
    const READS_POINT: bool = true;
    /// Where the box of the field is left alone, but for the place where it cuts the solid.
    fn keeps(d: SingleInterval, p: Vec3<SingleInterval>, a: Args<'_, SingleInterval>) -> bool {
        let sides = p.array().into_iter().enumerate();
        let depth = sides
            .map(|(k, c)| Ops::min(c - a.get(k), -(c - a.get(k + 3))))
            .fold(SingleInterval::point(f64::from(FAR)), Ops::min)
            * a.get(6);
        within(p, a) && d.is_finite() && -depth.lo < d.lo && d.hi < f64::from(FAR)
    }
    #[inline(always)]
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        let apart = R::norm([away(p.x, a, 0), away(p.y, a, 1), away(p.z, a, 2)]);
        let beyond = apart * a.get(6);
        let x = (p.x - a.get(0)).min(-(p.x - a.get(3)));
        let y = (p.y - a.get(1)).min(-(p.y - a.get(4)));
        let z = (p.z - a.get(2)).min(-(p.z - a.get(5)));
        let depth = x.min(y).min(z) * a.get(6);
        // a comparison, because the minimum with what is not a number is either
        let d = R::select(d.below(FAR), d, d.lit(FAR));
        let outer = d.max(0.0);
        let continued = R::continued(apart, outer, a.get(6), length2(beyond, outer));
        R::select(beyond.above(0.0), continued, d.max(-depth))
    }
}

/// Farther than any place of a scene; its square fits single precision.
const FAR: f32 = 1e18;

/// Parameters that [`RepeatCell`] and [`RepeatWall`] share, three numbers each: whether the axis is repeated (1 or 0), the
/// spacing, the shift of cell centres (0 or 1/2 of a cell), the first and the last cell.
struct Grid<'a, R: Real>(Args<'a, R>);

impl<R: Real> Grid<'_, R> {
    /// The lower one of the two nearest cells along an axis.
    #[inline(always)]
    fn base(&self, x: R, k: usize) -> R {
        let u = x / self.0.get(3 + k) - self.0.get(6 + k);
        u.floor()
            .max(self.0.get(9 + k))
            .min(self.0.get(12 + k) - 1.0)
    }

    /// Centre of a cell along an axis.
    #[inline(always)]
    fn centre(&self, cell: R, k: usize) -> R {
        (cell + self.0.get(6 + k)) * self.0.get(3 + k) * self.0.get(k)
    }
}

/// Into the space of one of the nearest copies on a grid. Parameters: three bits that say which copy, the largest random
/// offset along each axis, a seed (whole number), then the grid.
pub struct RepeatCell;

impl Warp for RepeatCell {
    #[inline(always)]
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let grid = Grid::<R>(a.list(7));
        let cell = v3(
            (grid.base(p.x, 0) + a.get(0)) * a.get(7),
            (grid.base(p.y, 1) + a.get(1)) * a.get(8),
            (grid.base(p.z, 2) + a.get(2)) * a.get(9),
        );
        let h0 = Hash::of3(v3(cell.x + a.get(6), cell.y, cell.z));
        let h1 = h0.next();
        let h2 = h1.next();
        v3(
            p.x - grid.centre(cell.x, 0) - (h0.unit() * 2.0 - 1.0) * a.get(3),
            p.y - grid.centre(cell.y, 1) - (h1.unit() * 2.0 - 1.0) * a.get(4),
            p.z - grid.centre(cell.z, 2) - (h2.unit() * 2.0 - 1.0) * a.get(5),
        )
    }
}

/// `min(d, distance to where other copies can be)`. Parameters: the shape's smallest and largest corner with its random
/// offset, then the grid.
pub struct RepeatWall;

impl Change for RepeatWall {
    const READS_POINT: bool = true;
    #[inline(always)]
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        let grid = Grid::<R>(a.list(6));
        let far = 1e30;
        let x = [p.x, p.y, p.z];
        let (mut wall, mut beside) = ([p.x.lit(far); 3], [p.x.lit(0.0); 3]);
        for k in 0..3 {
            let base = grid.base(x[k], k);
            let below = x[k] - grid.centre(base - 1.0, k) - a.get(3 + k);
            let above = grid.centre(base + 2.0, k) + a.get(k) - x[k];
            let below = R::select(base.above(grid.0.get(9 + k)), below, p.x.lit(far));
            let above = R::select(base.below(grid.0.get(12 + k) - 1.0), above, p.x.lit(far));
            let repeated = p.x.like(grid.0.get(k)).above(0.5);
            wall[k] = R::select(repeated, below.min(above), p.x.lit(far));
            let outside = (-x[k] + a.get(k)).max(x[k] - a.get(3 + k)).max(0.0);
            beside[k] = R::select(repeated, p.x.lit(0.0), outside);
        }
        let wall = wall[0].min(wall[1]).min(wall[2]);
        d.min(R::norm([wall.min(1e15), beside[0], beside[1], beside[2]]))
    }
}

/// Into the space of one of the two nearest copies around the y axis. Parameters: a bit that says which, the sector.
pub struct PolarCell;

impl Warp for PolarCell {
    #[inline(always)]
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        let turn = ((p.z.atan2(p.x) / a.get(1)).floor() + a.get(0)) * a.get(1);
        let (s, c) = turn.sin_cos();
        v3(p.x * c + p.z * s, p.y, p.z * c - p.x * s)
    }
}

/// `min(d, distance to where other copies can be)`. Parameters: sector, smallest and largest angle of the shape, its
/// smallest distance from the axis, its lowest and highest y.
pub struct PolarWall;

impl Change for PolarWall {
    const READS_POINT: bool = true;
    #[inline(always)]
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        let angle = p.z.atan2(p.x);
        let base = (angle / a.get(0)).floor();
        let below = angle - (base - 1.0) * a.get(0) - a.get(2);
        let above = (base + 2.0) * a.get(0) + a.get(1) - angle;
        let apart = below.min(above).min(std::f32::consts::FRAC_PI_2);
        let r = length2(p.x, p.z);
        let wall = (r * apart.sin()).max(-r + a.get(3));
        let beside = (-p.y + a.get(4)).max(p.y - a.get(5)).max(0.0);
        d.min(length2(wall, beside))
    }
}
