//! The arithmetic of free-form formulas, one operation each.

use super::{Change, Kept, Leaf, Pair, Put};
use crate::noise::{CellularNoise, GradientNoise, Noise, ValueNoise};
use std::marker::PhantomData;
use zeroset_number::{Args, Real, SingleInterval, Vec3, length2, v3};

/// A function of one number. Angles are radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// The negation.
    Neg,
    /// The absolute value.
    Abs,
    /// The square root; 0 below 0.
    Sqrt,
    /// The square.
    Square,
    /// The largest whole number that is not above.
    Floor,
    /// The sine.
    Sin,
    /// The cosine.
    Cos,
    /// The tangent.
    Tan,
    /// The angle in [-pi/2, pi/2] that has this sine; beyond -1 and 1 that of the nearer end.
    Asin,
    /// The angle in [0, pi] that has this cosine; beyond -1 and 1 that of the nearer end.
    Acos,
    /// The angle in (-pi/2, pi/2) that has this tangent.
    Atan,
    /// e to the power of it.
    Exp,
    /// The natural logarithm; at 0 and below, that of the smallest number there is.
    Ln,
    /// The hyperbolic tangent.
    Tanh,
}

impl Unary {
    /// All of them.
    pub const ALL: [Unary; 14] = [
        Unary::Neg,
        Unary::Abs,
        Unary::Sqrt,
        Unary::Square,
        Unary::Floor,
        Unary::Sin,
        Unary::Cos,
        Unary::Tan,
        Unary::Asin,
        Unary::Acos,
        Unary::Atan,
        Unary::Exp,
        Unary::Ln,
        Unary::Tanh,
    ];
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// `x + y`.
    Add,
    /// `x - y`.
    Sub,
    /// `x y`.
    Mul,
    /// `x / y`.
    Div,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// `x - y floor(x / y)`.
    Modulo,
    /// `x ^ y` for x > 0. A base that can be negative is refused, unless y is a constant whole number: then a
    /// formula holds products in place of the power.
    Pow,
    /// The angle of the point (y, x), in [-pi, pi]: the first operand is the ordinate.
    Atan2,
    /// `sqrt(x^2 + y^2)`: a function of its own because its slope is bounded where the root's is not.
    Hypot,
    /// 1 where x is below y, else 0: a condition.
    Less,
    /// y where the condition x holds (is above 1/2), else [`NOTHING`]: one half of a choice.
    When,
    /// x unless it is [`NOTHING`], else y: a choice of two halves, of which one is nothing wherever the other is not.
    Either,
}

impl Binary {
    /// All of them.
    pub const ALL: [Binary; 13] = [
        Binary::Add,
        Binary::Sub,
        Binary::Mul,
        Binary::Div,
        Binary::Min,
        Binary::Max,
        Binary::Modulo,
        Binary::Pow,
        Binary::Atan2,
        Binary::Hypot,
        Binary::Less,
        Binary::When,
        Binary::Either,
    ];
}

/// x, y or z.
pub struct Coordinate<const AXIS: usize>;

impl<const AXIS: usize> Leaf for Coordinate<AXIS> {
    #[inline(always)]
    fn leaf<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> R {
        [p.x, p.y, p.z][AXIS]
    }
}

/// A number.
pub struct Constant;

impl Leaf for Constant {
    #[inline(always)]
    fn leaf<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        p.x.like(a.get(0))
    }
}

/// The half of a choice that does not count: beyond every value that a formula may have.
pub const NOTHING: f32 = 3e38;

/// The coordinate of this number of a point, replaced by a value.
pub struct Component<const AXIS: usize>;

impl<const AXIS: usize> Put for Component<AXIS> {
    #[inline(always)]
    fn put<R: Real>(d: R, p: Vec3<R>) -> Vec3<R> {
        match AXIS {
            0 => v3(d, p.y, p.z),
            1 => v3(p.x, d, p.z),
            _ => v3(p.x, p.y, d),
        }
    }
}

/// The point's x in place of the value, whose marks it takes: what a formula made of a painted field.
pub struct Replaced;

impl Change for Replaced {
    const READS_POINT: bool = true;
    #[inline(always)]
    fn change<R: Real>(_d: R, p: Vec3<R>, _a: Args<'_, R>) -> R {
        p.x
    }
}

/// A noise at the point.
pub struct NoiseAt<N>(PhantomData<N>);

impl<N: Noise> Leaf for NoiseAt<N> {
    #[inline(always)]
    fn leaf<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> R {
        N::noise(p)
    }
}

/// Which noise a formula may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NoiseKind {
    /// See [`ValueNoise`].
    Value,
    /// See [`GradientNoise`].
    Gradient,
    /// See [`CellularNoise`].
    Cellular,
}

impl NoiseKind {
    /// All of them.
    pub const ALL: [NoiseKind; 3] = [NoiseKind::Value, NoiseKind::Gradient, NoiseKind::Cellular];
}

/// The noise of this kind at a point.
pub fn noise<R: Real>(kind: NoiseKind, p: Vec3<R>) -> R {
    match kind {
        NoiseKind::Value => ValueNoise::noise(p),
        NoiseKind::Gradient => GradientNoise::noise(p),
        NoiseKind::Cellular => CellularNoise::noise(p),
    }
}

/// What logarithms and powers take for a number that is not above it: the smallest normal number of single precision,
/// below which the vector code for them has no meaning.
pub const TINY: f32 = f32::MIN_POSITIVE;

macro_rules! unary {
    ($($(#[$doc:meta])* $name:ident |$x:ident| $value:expr;)*) => {
        $(
            $(#[$doc])*
            pub struct $name;
            impl Change for $name {
                #[inline(always)]
                fn change<R: Real>($x: R, _p: Vec3<R>, _a: Args<'_, R>) -> R {
                    $value
                }
            }
        )*

        /// A function of one number.
        pub fn unary<R: Real>(f: Unary, x: R) -> R {
            match f {
                $(Unary::$name => {
                    let $x = x;
                    $value
                })*
            }
        }
    };
}

unary! {
    /// `-x`
    Neg |x| -x;
    /// `|x|`
    Abs |x| x.abs();
    /// Square root; 0 below 0.
    Sqrt |x| x.max(0.0).sqrt();
    /// `x * x`
    Square |x| x.sq();
    /// Largest whole number not above.
    Floor |x| x.floor();
    /// Sine (radians).
    Sin |x| x.sin();
    /// Cosine (radians).
    Cos |x| x.cos();
    /// Tangent (radians).
    Tan |x| x.tan();
    /// Arc sine of `x` limited to [-1, 1].
    Asin |x| x.max(-1.0).min(1.0).asin();
    /// Arc cosine of `x` limited to [-1, 1].
    Acos |x| x.max(-1.0).min(1.0).acos();
    /// Arc tangent.
    Atan |x| x.atan();
    /// `e^x`
    Exp |x| x.exp();
    /// Natural logarithm of `x`, which counts as no less than [`TINY`].
    Ln |x| x.max(TINY).ln();
    /// Hyperbolic tangent.
    Tanh |x| x.tanh();
}

macro_rules! binary {
    ($($(#[$doc:meta])* $name:ident |$x:ident, $y:ident| $value:expr $(, keeps $kept:expr)?;)*) => {
        $(
            $(#[$doc])*
            pub struct $name;
            impl Pair for $name {
                $(fn kept(
                    x: SingleInterval,
                    y: SingleInterval,
                    _a: Args<'_, SingleInterval>,
                ) -> Kept {
                    $kept(x, y)
                })?
                #[inline(always)]
                fn pair<R: Real>($x: R, $y: R, _a: Args<'_, R>) -> R {
                    $value
                }
            }
        )*

        /// A function of two numbers.
        pub fn binary<R: Real>(f: Binary, x: R, y: R) -> R {
            match f {
                $(Binary::$name => {
                    let ($x, $y) = (x, y);
                    $value
                })*
            }
        }
    };
}

binary! {
    /// `x + y`
    Add |x, y| x + y;
    /// `x - y`
    Sub |x, y| x - y;
    /// `x * y`
    Mul |x, y| x * y;
    /// `x / y`
    Div |x, y| x / y;
    /// The smaller.
    Min |x, y| x.min(y), keeps |x, y| Kept::smaller(x, y, 0.0);
    /// The larger.
    Max |x, y| x.max(y), keeps |x: SingleInterval, y: SingleInterval| Kept::smaller(-x, -y, 0.0);
    /// `x - y floor(x / y)`
    Modulo |x, y| x.modulo(y);
    /// `x^y` of `x`, which counts as no less than [`TINY`].
    Pow |x, y| (x.max(TINY).ln() * y).exp();
    /// Angle of (y, x): the first operand is the ordinate.
    Atan2 |x, y| x.atan2(y);
    /// `sqrt(x^2 + y^2)`
    Hypot |x, y| length2(x, y);    /// 1 where x is below y, else 0.
    Less |x, y| R::choose((x - y).below(0.0), x.lit(1.0), x.lit(0.0));
    /// y where x is above 1/2, else [`NOTHING`].
    When |x, y| R::choose(x.above(0.5), y, y.lit(NOTHING));
    /// x unless it is [`NOTHING`], else y.
    Either |x, y| R::select(x.below(0.5 * NOTHING), x, y);
}
