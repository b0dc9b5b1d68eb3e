//! Operations: what an instruction of a [`Program`](crate::program::Program) does.
//!
//! There are four kinds, told apart by what they take and give. The catalogue's entries are operations, and so are a few
//! that only the compiler emits: placements, the arithmetic of free-form formulas, the walls of repetitions. Every
//! evaluator is generated from the lists `each_leaf!`, `each_warp!`, `each_change!` and `each_pair!`, in which the
//! catalogue comes first.

use crate::catalogue::{Join, Map, Modify, Primitive};
use crate::number::{Args, Real, Vec3};
use std::marker::PhantomData;

pub mod arithmetic;
pub mod domain;
pub mod recorded;

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

/// A point in, a point out.
pub trait Warp: 'static {
    /// The formula.
    fn warp<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R>;
}

/// A value and the point it belongs to in, a value out.
pub trait Change: 'static {
    /// The formula.
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R;
}

/// Two values in, a value out.
pub trait Pair: 'static {
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
    #[inline(always)]
    fn change<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R {
        E::modify(d, p, a)
    }
}

impl<E: Join> Pair for E {
    #[inline(always)]
    fn pair<R: Real>(x: R, y: R, a: Args<'_, R>) -> R {
        E::join(x, y, a)
    }
}

/// Calls `$then!` with the type of every [`Leaf`].
macro_rules! each_leaf {
    ($then:ident $($args:tt)*) => { crate::each_primitive!(with_own_leaves $then [$($args)*]) };
}
macro_rules! with_own_leaves {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $(crate::op::Centred<$entry>,)*
            crate::op::arithmetic::Coordinate<0>,
            crate::op::arithmetic::Coordinate<1>,
            crate::op::arithmetic::Coordinate<2>,
            crate::op::arithmetic::Constant,
        }
    };
}

/// Calls `$then!` with the type of every [`Warp`].
macro_rules! each_warp {
    ($then:ident $($args:tt)*) => { crate::each_map!(with_own_warps $then [$($args)*]) };
}
macro_rules! with_own_warps {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($entry,)*
            crate::op::domain::Offset,
            crate::op::domain::Rigid,
            crate::op::domain::Clamp,
            crate::op::domain::RepeatCell,
            crate::op::domain::PolarCell,
        }
    };
}

/// Calls `$then!` with the type of every [`Change`].
macro_rules! each_change {
    ($then:ident $($args:tt)*) => { crate::each_modify!(with_own_changes $then [$($args)*]) };
}
macro_rules! with_own_changes {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($entry,)*
            crate::op::domain::Scale,
            crate::op::domain::Continue,
            crate::op::domain::RepeatWall,
            crate::op::domain::PolarWall,
            crate::op::arithmetic::Neg,
            crate::op::arithmetic::Abs,
            crate::op::arithmetic::Sqrt,
            crate::op::arithmetic::Square,
            crate::op::arithmetic::Floor,
            crate::op::arithmetic::Sin,
            crate::op::arithmetic::Cos,
            crate::op::arithmetic::Tan,
            crate::op::arithmetic::Asin,
            crate::op::arithmetic::Acos,
            crate::op::arithmetic::Atan,
            crate::op::arithmetic::Exp,
            crate::op::arithmetic::Ln,
            crate::op::arithmetic::Tanh,
        }
    };
}

/// Calls `$then!` with the type of every [`Pair`].
macro_rules! each_pair {
    ($then:ident $($args:tt)*) => { crate::each_join!(with_own_pairs $then [$($args)*]) };
}
macro_rules! with_own_pairs {
    ($then:ident [$($args:tt)*] $($entry:path,)*) => {
        $then! { $($args)* $($entry,)*
            crate::op::arithmetic::Add,
            crate::op::arithmetic::Sub,
            crate::op::arithmetic::Mul,
            crate::op::arithmetic::Div,
            crate::op::arithmetic::Min,
            crate::op::arithmetic::Max,
            crate::op::arithmetic::Modulo,
            crate::op::arithmetic::Pow,
            crate::op::arithmetic::Atan2,
            crate::op::arithmetic::Hypot,
        }
    };
}

pub(crate) use {
    each_change, each_leaf, each_pair, each_warp, with_own_changes, with_own_leaves,
    with_own_pairs, with_own_warps,
};

/// Codes of the operations that only the compiler emits: their places behind the catalogue's in the lists above.
pub(crate) mod code {
    use crate::formula::{Binary, Unary};

    macro_rules! count {
        ($($entry:path,)*) => { [$(stringify!($entry)),*].len() as u16 };
    }
    const PRIMITIVES: u16 = crate::each_primitive!(count);
    const MAPS: u16 = crate::each_map!(count);
    const MODIFIERS: u16 = crate::each_modify!(count);
    const JOINS: u16 = crate::each_join!(count);

    pub(crate) const COORDINATE: u16 = PRIMITIVES;
    pub(crate) const CONSTANT: u16 = PRIMITIVES + 3;
    pub(crate) const OFFSET: u16 = MAPS;
    pub(crate) const RIGID: u16 = MAPS + 1;
    pub(crate) const CLAMP: u16 = MAPS + 2;
    pub(crate) const REPEAT_CELL: u16 = MAPS + 3;
    pub(crate) const POLAR_CELL: u16 = MAPS + 4;
    pub(crate) const SCALE: u16 = MODIFIERS;
    pub(crate) const CONTINUE: u16 = MODIFIERS + 1;
    pub(crate) const REPEAT_WALL: u16 = MODIFIERS + 2;
    pub(crate) const POLAR_WALL: u16 = MODIFIERS + 3;
    pub(crate) const MIN: u16 = JOINS + Binary::Min as u16;

    /// Code of a function of one number.
    pub(crate) const fn unary(f: Unary) -> u16 {
        MODIFIERS + 4 + f as u16
    }

    /// Code of a function of two numbers.
    pub(crate) const fn binary(f: Binary) -> u16 {
        JOINS + f as u16
    }
}
