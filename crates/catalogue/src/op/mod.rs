//! Operations: what an [`Instruction`](crate::tape::Instruction) does.
//!
//! There are five kinds, told apart by what they take and give. The catalogue's entries are operations, and so are a few
//! that only the compiler emits: placements, the arithmetic of free-form formulas, grids of samples, the walls of repetitions. Every
//! evaluator is generated from the lists `each_leaf!`, `each_warp!`, `each_put!`, `each_change!` and `each_pair!`, in
//! which the catalogue comes first.

use crate::{Join, Map, Modify, Primitive};
use std::marker::PhantomData;
use zeroset_number::{Args, Real, SingleInterval, Vec3};

pub mod arithmetic;
pub mod domain;
pub mod grid;

/// A point in, a value out.
pub trait Leaf: 'static {
    /// The formula.
    fn leaf<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R;
    /// See [`Primitive::TRAPS`].
    const TRAPS: bool = false;
    /// See [`Primitive::traps`].
    #[inline(always)]
    fn traps<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> [R; 4] {
        [p.x.lit(0.0); 4]
    }
}

/// Over a box: which operand a join gives, to the bit, with its gradient and its marks, wherever in the box it is evaluated in single
/// precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// Both count somewhere, or that cannot be told.
    Both,
    /// The first.
    First,
    /// The second.
    Second,
    /// The negation of the second.
    MinusSecond,
}

impl Kept {
    /// What the smaller of two numbers keeps that are in these ranges; and so does a join that leaves the minimum alone where its operands
    /// are more than `support` apart.
    ///
    /// The ranges must be finite: where single precision has no number, as for 0 / 0, a range is not.
    pub fn smaller(x: SingleInterval, y: SingleInterval, support: f64) -> Kept {
        if !(x.is_finite() && y.is_finite()) {
            return Kept::Both;
        }
        // for the roundings within the join
        let by = support
            + 1e-6
                * (support
                    + if support > 0.0 {
                        x.mag() + y.mag()
                    } else {
                        0.0
                    });
        if x.hi < y.lo - by {
            Kept::First
        } else if y.hi < x.lo - by {
            Kept::Second
        } else {
            Kept::Both
        }
    }

    /// The first operand, if `first` holds.
    pub fn first_if(first: bool) -> Kept {
        if first { Kept::First } else { Kept::Both }
    }

    /// For a subtraction, which negates its second operand.
    pub fn with_second_negated(self) -> Kept {
        match self {
            Kept::Second => Kept::MinusSecond,
            kept => kept,
        }
    }
}

/// A point in, a point out.
pub trait Warp: 'static {
    /// Whether the result is the point itself, to the bit and with its gradient, in all of the box.
    fn keeps(_p: Vec3<SingleInterval>, _a: Args<'_, SingleInterval>) -> bool {
        false
    }
    /// The formula.
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R>;
}

/// A value and a point in, the point out with one of its coordinates replaced.
pub trait Put: 'static {
    /// The formula.
    fn put<R: Real>(d: R, p: Vec3<R>) -> Vec3<R>;
}

/// A value and the point it belongs to in, a value out.
pub trait Change: 'static {
    /// Whether the formula reads the point. What does not read it does not keep it alive either.
    const READS_POINT: bool = false;
    /// Whether the result is the value itself, to the bit and with its gradient, in all of the box.
    fn keeps(_d: SingleInterval, _p: Vec3<SingleInterval>, _a: Args<'_, SingleInterval>) -> bool {
        false
    }
    /// The formula.
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R;
}

/// Two values in, a value out.
pub trait Pair: 'static {
    /// Which operand is the result in all of the box.
    fn kept(_x: SingleInterval, _y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        Kept::Both
    }
    /// The formula.
    fn pair<R: Real>(x: R, y: R, a: Args<'_, R>) -> R;
}

/// A primitive at a place of its own: its parameters come after three numbers that are its centre, so that a move costs
/// no instruction.
pub struct Centred<E>(PhantomData<E>);

impl<E: Primitive> Leaf for Centred<E> {
    const TRAPS: bool = E::TRAPS;
    #[inline(always)]
    fn leaf<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        E::distance(domain::Offset::warp(p, a), a.list(3))
    }
    #[inline(always)]
    fn traps<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> [R; 4] {
        E::traps(domain::Offset::warp(p, a), a.list(3))
    }
}

impl<E: Map> Warp for E {
    #[inline(always)]
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R> {
        E::map(p, a)
    }
}

impl<E: Modify> Change for E {
    const READS_POINT: bool = E::READS_POINT;
    #[inline(always)]
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        E::modify(d, p, a)
    }
}

impl<E: Join> Pair for E {
    fn kept(x: SingleInterval, y: SingleInterval, a: Args<'_, SingleInterval>) -> Kept {
        E::kept(x, y, a)
    }
    #[inline(always)]
    fn pair<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        E::join(x, y, a)
    }
}

/// Calls `$then!` with the type of every [`Leaf`].
#[doc(hidden)]
#[macro_export]
macro_rules! each_leaf {
    ($then:ident $($args:tt)*) => { $crate::each_primitive!{ [$crate::with_own_leaves] $then [$($args)*] } };
}
#[doc(hidden)]
#[macro_export]
macro_rules! with_own_leaves {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($crate::op::Centred<$entry>,)*
            $crate::op::arithmetic::Coordinate<0>,
            $crate::op::arithmetic::Coordinate<1>,
            $crate::op::arithmetic::Coordinate<2>,
            $crate::op::arithmetic::Constant,
            $crate::op::grid::Sampled,
            $crate::op::arithmetic::NoiseAt<$crate::noise::ValueNoise>,
            $crate::op::arithmetic::NoiseAt<$crate::noise::GradientNoise>,
            $crate::op::arithmetic::NoiseAt<$crate::noise::CellularNoise>,
            $crate::flat::Strips,
        }
    };
}

/// Calls `$then!` with the type of every [`Warp`].
#[doc(hidden)]
#[macro_export]
macro_rules! each_warp {
    ($then:ident $($args:tt)*) => { $crate::each_map!{ [$crate::with_own_warps] $then [$($args)*] } };
}
#[doc(hidden)]
#[macro_export]
macro_rules! with_own_warps {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($entry,)*
            $crate::op::domain::Offset,
            $crate::op::domain::Rigid,
            $crate::op::domain::Clamp,
            $crate::op::domain::RepeatCell,
            $crate::op::domain::PolarCell,
        }
    };
}

/// Calls `$then!` with the type of every [`Put`].
#[doc(hidden)]
#[macro_export]
macro_rules! each_put {
    ($then:ident $($args:tt)*) => {
        $then! { $($args)*
            $crate::op::arithmetic::Component<0>,
            $crate::op::arithmetic::Component<1>,
            $crate::op::arithmetic::Component<2>,
        }
    };
}

/// Calls `$then!` with the type of every [`Change`].
#[doc(hidden)]
#[macro_export]
macro_rules! each_change {
    ($then:ident $($args:tt)*) => { $crate::each_modify!{ [$crate::with_own_changes] $then [$($args)*] } };
}
#[doc(hidden)]
#[macro_export]
macro_rules! with_own_changes {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($entry,)*
            $crate::op::domain::Scale,
            $crate::op::domain::Continue,
            $crate::op::domain::RepeatWall,
            $crate::op::domain::PolarWall,
            $crate::op::arithmetic::Neg,
            $crate::op::arithmetic::Abs,
            $crate::op::arithmetic::Sqrt,
            $crate::op::arithmetic::Square,
            $crate::op::arithmetic::Floor,
            $crate::op::arithmetic::Sin,
            $crate::op::arithmetic::Cos,
            $crate::op::arithmetic::Tan,
            $crate::op::arithmetic::Asin,
            $crate::op::arithmetic::Acos,
            $crate::op::arithmetic::Atan,
            $crate::op::arithmetic::Exp,
            $crate::op::arithmetic::Ln,
            $crate::op::arithmetic::Tanh,
            $crate::op::arithmetic::Replaced,
        }
    };
}

/// Calls `$then!` with the type of every [`Pair`].
#[doc(hidden)]
#[macro_export]
macro_rules! each_pair {
    ($then:ident $($args:tt)*) => { $crate::each_join!{ [$crate::with_own_pairs] $then [$($args)*] } };
}
#[doc(hidden)]
#[macro_export]
macro_rules! with_own_pairs {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($entry,)*
            $crate::op::arithmetic::Add,
            $crate::op::arithmetic::Sub,
            $crate::op::arithmetic::Mul,
            $crate::op::arithmetic::Div,
            $crate::op::arithmetic::Min,
            $crate::op::arithmetic::Max,
            $crate::op::arithmetic::Modulo,
            $crate::op::arithmetic::Pow,
            $crate::op::arithmetic::Atan2,
            $crate::op::arithmetic::Hypot,
            $crate::op::arithmetic::Less,
            $crate::op::arithmetic::When,
            $crate::op::arithmetic::Either,
        }
    };
}

/// Codes of the operations that only the compiler emits: their places behind the catalogue's in the lists above.
pub mod code {
    use super::arithmetic::{Binary, NoiseKind, Unary};

    macro_rules! count {
        ($($entry:path,)*) => { [$(stringify!($entry)),*].len() as u16 };
    }
    const PRIMITIVES: u16 = crate::each_primitive!(count);
    const MAPS: u16 = crate::each_map!(count);
    const MODIFIERS: u16 = crate::each_modify!(count);
    const JOINS: u16 = crate::each_join!(count);

    /// x; y and z follow.
    pub const COORDINATE: u16 = PRIMITIVES;
    /// A number.
    pub const CONSTANT: u16 = PRIMITIVES + 3;
    /// See [`grid::Sampled`](super::grid::Sampled).
    pub const SAMPLED: u16 = PRIMITIVES + 4;
    /// See [`domain::Offset`](super::domain::Offset).
    pub const OFFSET: u16 = MAPS;
    /// See [`domain::Rigid`](super::domain::Rigid).
    pub const RIGID: u16 = MAPS + 1;
    /// See [`domain::Clamp`](super::domain::Clamp).
    pub const CLAMP: u16 = MAPS + 2;
    /// See [`domain::RepeatCell`](super::domain::RepeatCell).
    pub const REPEAT_CELL: u16 = MAPS + 3;
    /// See [`domain::PolarCell`](super::domain::PolarCell).
    pub const POLAR_CELL: u16 = MAPS + 4;
    /// See [`domain::Scale`](super::domain::Scale).
    pub const SCALE: u16 = MODIFIERS;
    /// See [`domain::Continue`](super::domain::Continue).
    pub const CONTINUE: u16 = MODIFIERS + 1;
    /// See [`domain::RepeatWall`](super::domain::RepeatWall).
    pub const REPEAT_WALL: u16 = MODIFIERS + 2;
    /// See [`domain::PolarWall`](super::domain::PolarWall).
    pub const POLAR_WALL: u16 = MODIFIERS + 3;
    /// The smaller of two numbers.
    pub const MIN: u16 = JOINS + Binary::Min as u16;

    /// See [`arithmetic::Replaced`](super::arithmetic::Replaced).
    pub const REPLACED: u16 = MODIFIERS + 4 + Unary::ALL.len() as u16;

    /// See [`Strips`](crate::flat::Strips).
    pub const STRIPS: u16 = PRIMITIVES + 5 + NoiseKind::ALL.len() as u16;

    /// Code of a noise.
    pub const fn noise(kind: NoiseKind) -> u16 {
        PRIMITIVES + 5 + kind as u16
    }

    /// Code of a function of one number.
    pub const fn unary(f: Unary) -> u16 {
        MODIFIERS + 4 + f as u16
    }

    /// Code of a function of two numbers.
    pub const fn binary(f: Binary) -> u16 {
        JOINS + f as u16
    }
}

/// Whether the change of this code reads the point, beside the value.
pub fn reads_point(code: u16) -> bool {
    macro_rules! reads {
        ($($entry:ty,)*) => { &[$(<$entry as Change>::READS_POINT),*] };
    }
    const READS: &[bool] = crate::each_change!(reads);
    READS.get(usize::from(code)).is_none_or(|reads| *reads)
}
