//! A way of joining two surfaces, and the union, intersection and subtraction in that way.
//!
//! Every style is a *joined minimum* `m(x, y) <= min(x, y)`, from which follow
//!
//! - the union `m(x, y)`,
//! - the intersection `-m(-x, -y)`, for what is outside the one is inside the complement,
//! - the subtraction `-m(-x, y)`, the intersection with the complement of `y`.
//!
//! What a style may cost: where the operands' gradients may point anywhere, the slope of `m` is at most
//! `|m_x| Lx + |m_y| Ly`, reached where they are parallel. A joined minimum that moves along with its operands,
//! `m(x + c, y + c) = m(x, y) + c`, has `m_x + m_y = 1`; where moreover neither derivative is negative it is as steep as
//! the steeper operand and no more. Every style whose profile allows it is written in that form: it is the largest bound
//! with its profile, since the largest ball around (x, y) in which the derivatives may add up to 1 is a square.

use super::*;
use std::marker::PhantomData;
use zeroset_number::{Data, F64};

/// A way of joining: the joined minimum and what is known of it.
pub trait Style: 'static {
    /// Names of the union, the intersection and the subtraction.
    const NAMES: [&'static str; 3];
    /// A line for each.
    const DOCS: [&'static str; 3];
    /// See [`Info::source`].
    const SOURCE: &'static str;
    /// See [`Info::group`].
    const GROUP: &'static str;
    /// Parameters.
    const PARAMS: &'static [Param];
    /// More parameter sets that the proofs run at, beside the defaults.
    const SAMPLES: &'static [&'static [f64]];
    /// The joined minimum: symmetric, never above `min(x, y)`, and never more than [`Self::reach`] below it.
    fn lower<R: Real>(x: R, y: R, a: Args<'_, R>) -> R;
    /// What the joined minimum keeps over a box, see [`Join::kept`]. It is where the minimum is left alone, to the bit.
    fn lower_kept(_x: SingleInterval, _y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        Kept::Both
    }
    /// Largest `|m_x| Lx + |m_y| Ly`.
    fn lipschitz(_a: &[f64], x: f64, y: f64) -> f64 {
        x.max(y)
    }
    /// Largest `min(x, y) - m(x, y)`.
    fn reach(a: &[f64]) -> f64;
    /// Largest value that all of `n` operands can have where the union of them, joined from left to right, is at most 0.
    ///
    /// A joined minimum that grows with both operands is smallest beside them where all are equal; one that moves along
    /// with them then goes down by `s' = -m(-s, 0)`, from 0, with every operand.
    fn fold_reach(a: &[f64], n: usize) -> f64 {
        let a = Data::from(a.iter().map(|&x| x as f32).collect::<Vec<f32>>());
        let mut reach = 0.0;
        for _ in 1..n {
            let next = -Self::lower(F64(-reach), F64(0.0), Args::new(&a)).0;
            if next - reach <= 1e-12 * next {
                break;
            }
            reach = next;
        }
        reach
    }
    /// Relations between parameters that ranges cannot state.
    fn check(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
}

/// The union in a style.
pub struct StyledUnion<S>(PhantomData<S>);
/// The intersection in a style.
pub struct StyledIntersection<S>(PhantomData<S>);
/// The subtraction in a style.
pub struct StyledSubtraction<S>(PhantomData<S>);

const fn info<S: Style>(which: usize) -> Info {
    Info {
        name: S::NAMES[which],
        doc: S::DOCS[which],
        source: S::SOURCE,
        group: S::GROUP,
        dimension: Dimension::Any,
        params: S::PARAMS,
    }
}

macro_rules! styled {
    ($($join:ident $which:literal |$x:ident, $y:ident, $a:ident| $value:expr;
        |$level:ident, $r:ident, $bx:ident, $by:ident| $bounds:expr;
        |$ix:ident, $iy:ident| $contains:expr;
        $fold_bounds:expr;
        |$kx:ident, $ky:ident, $ka:ident| $kept:expr;)*) => {$(
        impl<S: Style> Join for $join<S> {
            const INFO: Info = info::<S>($which);
            const SHARP: bool = false;
            const SAMPLES: &'static [&'static [f64]] = S::SAMPLES;
            #[inline(always)]
            fn join<R: Real>($x: R, $y: R, $a: Args<'_, R>) -> R {
                $value
            }
            fn kept(
                $kx: SingleInterval,
                $ky: SingleInterval,
                $ka: Args<'_, SingleInterval>,
            ) -> Kept {
                $kept
            }
            fn lipschitz(a: &[f64], x: f64, y: f64) -> f64 {
                S::lipschitz(a, x, y)
            }
            fn level_bounds(
                a: &[f64],
                $level: f64,
                $bx: &dyn Fn(f64) -> Aabb,
                $by: &dyn Fn(f64) -> Aabb,
            ) -> Aabb {
                let $r = S::reach(a);
                $bounds
            }
            fn fold_bounds(a: &[f64], shapes: &[Aabb]) -> Aabb {
                $fold_bounds(a, shapes)
            }
            /// A join in a style is a distance bound, not a distance.
            fn exactness(x: Exactness, y: Exactness) -> Exactness {
                x.max(y).max(Exactness::Bound)
            }
            fn reach(a: &[f64]) -> f64 {
                S::reach(a)
            }
            fn contains($ix: bool, $iy: bool) -> bool {
                $contains
            }
            fn check(a: &[f64]) -> Result<(), String> {
                S::check(a)
            }
        }
    )*};
}
styled! {
    StyledUnion 0 |x, y, a| S::lower(x, y, a);
        |level, r, x, y| x(level + r).hull(&y(level + r));
        |x, y| x || y;
        |a, shapes: &[Aabb]| {
            let reach = S::fold_reach(a, shapes.len());
            shapes.iter().fold(Aabb::EMPTY, |b, shape| b.hull(&shape.grow(reach)))
        };
        |x, y, a| S::lower_kept(x, y, a);
    // never below the sharp ones
    StyledIntersection 1 |x, y, a| -S::lower(-x, -y, a);
        |level, _r, x, y| x(level).intersect(&y(level));
        |x, y| x && y;
        |_a, shapes: &[Aabb]| shapes.iter().fold(Aabb::WHOLE, |b, shape| b.intersect(shape));
        |x, y, a| S::lower_kept(-x, -y, a);
    StyledSubtraction 2 |x, y, a| -S::lower(-x, y, a);
        |level, _r, x, _y| x(level);
        |x, y| x && !y;
        |_a, shapes: &[Aabb]| shapes.first().copied().unwrap_or(Aabb::EMPTY);
        |x, y, a| S::lower_kept(-x, y, a).with_second_negated();
}

/// Whether parameter `name` is a whole number.
pub(super) fn whole(name: &str, value: f64) -> Result<(), String> {
    if value.fract() == 0.0 {
        Ok(())
    } else {
        Err(format!("{name} is {value}, allowed are whole numbers"))
    }
}
