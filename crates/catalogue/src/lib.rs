//! The catalogue: every primitive, map, modifier and join, each written once over [`Real`].
//!
//! An entry is a unit struct with one trait implementation (its formula, its parameters, its bounds, and a plain `f64`
//! membership test that the proofs hold it against) and one line in [`mod@list`]. The scene language, the reference listing,
//! the evaluators, the shaders and the tests all iterate that list.
//!
//! 2D shapes are fields that ignore `z`: they become solids by `extrude` and `revolve`.
//!
//! ```
//! use zeroset_catalogue::entries::catalogue;
//!
//! let torus = catalogue().primitive("torus").ok_or("no such shape")?;
//! let names: Vec<&str> = torus.info.params.iter().map(|p| p.name).collect();
//! assert_eq!(names, ["radius", "tube"]);
//!
//! // what an entry says of itself at parameters: a box, its steepness, what is inside
//! let params = [2.0, 0.5];
//! assert_eq!((torus.bounds)(&params).max, [2.5, 0.5, 2.5]);
//! assert_eq!((torus.lipschitz)(&params), 1.0);
//! assert!((torus.contains)(&params, [2.0, 0.2, 0.0]));
//! # Ok::<(), &str>(())
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

use crate::bounds::{Aabb, Exactness};
use crate::op::Kept;
use zeroset_number::{Args, Real, SingleInterval, Vec2, Vec3, length2, v2, v3};

pub mod bounds;
pub mod entries;
pub mod flat;
pub mod fractal;
pub mod join;
pub mod join_edge;
pub mod join_line;
pub mod join_smooth;
pub mod join_style;
pub mod list;
pub mod map;
pub mod map_bend;
pub mod map_deform;
pub mod modify;
pub mod modify_displace;
pub mod noise;
pub mod op;
pub mod solid;
pub mod tape;

/// What a parameter measures. Angles are radians here and degrees in scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Scene units.
    Length,
    /// Radians.
    Angle,
    /// A plain number.
    Ratio,
    /// A whole number.
    Count,
    /// Radians per scene unit here, degrees per scene unit in scene files.
    Rate,
    /// Cycles per scene unit.
    Frequency,
    /// A direction; its length does not matter.
    Direction,
}

/// How many numbers a parameter has and how they lie in the parameter array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One number.
    Number,
    /// Two numbers.
    Vec2,
    /// Three numbers.
    Vec3,
    /// A list of items of this many numbers: the count, then the items. Always the last parameter.
    List(usize),
}

impl Kind {
    /// Numbers it takes in the parameter array; a list takes at least its count.
    #[allow(clippy::len_without_is_empty, reason = "a parameter is never empty")]
    pub const fn len(self) -> usize {
        match self {
            Kind::Number | Kind::List(_) => 1,
            Kind::Vec2 => 2,
            Kind::Vec3 => 3,
        }
    }
}

/// One parameter of an entry.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Name in the scene language.
    pub name: &'static str,
    /// Shape in the parameter array.
    pub kind: Kind,
    /// What it measures.
    pub unit: Unit,
    /// Default value (for a list: its items, without the count). Empty: the parameter must be given.
    pub default: &'static [f64],
    /// Smallest value allowed, for every component.
    pub min: f64,
    /// Largest value allowed, for every component.
    pub max: f64,
    /// One line.
    pub doc: &'static str,
}

/// A parameter of one number.
pub const fn number(
    name: &'static str,
    unit: Unit,
    default: &'static [f64; 1],
    min: f64,
    max: f64,
    doc: &'static str,
) -> Param {
    Param {
        name,
        kind: Kind::Number,
        unit,
        default,
        min,
        max,
        doc,
    }
}

/// A parameter of two numbers.
pub const fn vec2(
    name: &'static str,
    unit: Unit,
    default: &'static [f64; 2],
    min: f64,
    max: f64,
    doc: &'static str,
) -> Param {
    Param {
        name,
        kind: Kind::Vec2,
        unit,
        default,
        min,
        max,
        doc,
    }
}

/// A parameter of three numbers.
pub const fn vec3(
    name: &'static str,
    unit: Unit,
    default: &'static [f64; 3],
    min: f64,
    max: f64,
    doc: &'static str,
) -> Param {
    Param {
        name,
        kind: Kind::Vec3,
        unit,
        default,
        min,
        max,
        doc,
    }
}

/// A list of items of `width` numbers.
pub const fn list(
    name: &'static str,
    unit: Unit,
    width: usize,
    default: &'static [f64],
    doc: &'static str,
) -> Param {
    Param {
        name,
        kind: Kind::List(width),
        unit,
        default,
        min: -LARGE,
        max: LARGE,
        doc,
    }
}

/// The largest length a scene may state, in scene units.
pub const LARGE: f64 = 1e9;
/// The smallest length of a thing that must have one.
pub const SMALL: f64 = 1e-9;

/// Whether a field lives in the plane or in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Ignores `z`.
    Two,
    /// Uses all coordinates.
    Three,
    /// Takes either and gives the same.
    Any,
}

/// What an entry says of itself.
#[derive(Clone, Copy, Debug)]
pub struct Info {
    /// Name in the scene language (snake_case).
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    /// Author, year, equation, where the formula is not common knowledge.
    pub source: &'static str,
    /// The section of the reference it stands in.
    pub group: &'static str,
    /// The plane, space, or either.
    pub dimension: Dimension,
    /// Parameters in the order in which the array holds them.
    pub params: &'static [Param],
}

impl Info {
    /// The defaults as the parameter array.
    pub fn defaults(&self) -> Vec<f64> {
        let mut out = Vec::new();
        for p in self.params {
            if let Kind::List(width) = p.kind {
                out.push((p.default.len() / width) as f64);
            }
            out.extend_from_slice(p.default);
        }
        out
    }
}

/// How far a formula can be trusted at single places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roughness {
    /// Everywhere.
    Smooth,
    /// At planes of symmetry, where its foldings meet, the gradient may be that of another branch.
    Folded,
    /// The orbits of near points part: single precision agrees with double only at most places.
    Chaotic,
}

/// A shape: a point in, a distance out.
pub trait Primitive: 'static {
    /// Name, parameters, words.
    const INFO: Info;
    /// How true the distance is.
    const EXACTNESS: Exactness;
    /// More parameter sets that the proofs run at, beside the defaults.
    const SAMPLES: &'static [&'static [f64]] = &[];
    /// The formula.
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R;
    /// A box that holds the solid; infinite along `z` for a 2D shape.
    fn bounds(a: &[f64]) -> Aabb;
    /// A box that holds all places where the value is at most `level` >= 0. A distance grows the box by the level; a value
    /// that is only a bound may need more.
    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        Self::bounds(a).grow(level)
    }
    /// Largest slope of [`Self::distance`] anywhere; the compiler divides by it.
    fn lipschitz(_a: &[f64]) -> f64 {
        1.0
    }
    /// Whether `p` lies in the solid: plain `f64`, written from the shape's geometry and not from [`Self::distance`], so
    /// that the proofs have a second opinion on the sign.
    fn contains(a: &[f64], p: [f64; 3]) -> bool;
    /// How many times longer than the solid a side of [`Self::bounds`] may be.
    const SLACK: f64 = 1.25;
    /// How far the formula can be trusted at single places.
    const ROUGHNESS: Roughness = Roughness::Smooth;
    /// Whether [`Self::traps`] says something.
    const TRAPS: bool = false;
    /// How near the orbit of `p` came to its traps: what fractals are coloured by.
    #[inline(always)]
    fn traps<R: Real>(p: Vec3<R>, _a: Args<'_, R>) -> [R; 4] {
        [p.x.lit(0.0); 4]
    }
    /// Relations between parameters that ranges cannot state; the message says what is allowed.
    fn check(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
}

/// How much longer a map can make a short way, which is what the field behind it grows steeper by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stretch {
    /// At most this anywhere.
    Everywhere(f64),
    /// At most this inside the box, which must hold the result; outside, the compiler continues the field from the box
    /// by `hypot(distance to the box, value at its nearest point)`, which never overestimates.
    Within(Aabb, f64),
}

/// A map of space: the shape at `map(p)` is seen at `p`.
pub trait Map: 'static {
    /// Name, parameters, words. [`Dimension::Two`] takes a 2D field and makes a solid.
    const INFO: Info;
    /// Whether it takes a solid and gives a 2D field.
    const SECTION: bool = false;
    /// Whether an exact distance stays exact (rigid motions only).
    const RIGID: bool = false;
    /// More parameter sets that the proofs run at, beside the defaults.
    const SAMPLES: &'static [&'static [f64]] = &[];
    /// The map, from the place that is seen to the place in the shape.
    fn map<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Vec3<R>;
    /// Largest singular value of the map's derivative. `bounds` is what [`Self::bounds`] gave. The message says why there
    /// is none and what to do (for instance: bound the shape first).
    fn stretch(a: &[f64], bounds: &Aabb) -> Result<Stretch, String>;
    /// A box that holds the result, from the box of the shape.
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb;
    /// Whether a plane shape stays in its plane, if the map takes plane shapes: what would move it along z is refused, as it
    /// would be lost without a word.
    fn plane(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
    /// Relations between parameters that ranges cannot state.
    fn check(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
}

/// A change of one field's value (rounding, shells, displacement, extrusion).
pub trait Modify: 'static {
    /// Name, parameters, words. [`Dimension::Two`] takes a 2D field and makes a solid; otherwise the dimension stays.
    const INFO: Info;
    /// More parameter sets that the proofs run at, beside the defaults.
    const SAMPLES: &'static [&'static [f64]] = &[];
    /// Whether the formula reads the point.
    const READS_POINT: bool = false;
    /// The new value from the field's value `d` at `p`.
    fn modify<R: Real>(d: R, p: Vec3<R>, a: Args<'_, R>) -> R;
    /// Slope of the result, from the slope of the field.
    fn lipschitz(a: &[f64], slope: f64) -> f64;
    /// A box that holds all places where the result is at most `level`, from boxes of the field's level sets: `shape(l)`
    /// holds all places where the field is at most `l`. Level sets, because a field that is no exact distance may grow by
    /// more than its value says.
    fn level_bounds(a: &[f64], level: f64, shape: &dyn Fn(f64) -> Aabb) -> Aabb;
    /// A box that holds the result, from the box of a field whose value is at least the distance to that box along some
    /// axis.
    fn bounds(a: &[f64], shape: &Aabb) -> Aabb {
        Self::level_bounds(a, 0.0, &|level| shape.grow(level))
    }
    /// How true the result is.
    fn exactness(shape: Exactness) -> Exactness;
    /// Relations between parameters that ranges cannot state.
    fn check(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
}

/// Two fields made one.
pub trait Join: 'static {
    /// Name, parameters, words.
    const INFO: Info;
    /// Whether only the signs of the operands matter for the shape of the result (sharp joins). The compiler then divides
    /// each operand by its own slope; otherwise the values are lengths, are kept, and the result is divided.
    const SHARP: bool;
    /// Whether operands may be joined in any grouping, to the bit, as by `min` and `max`. Such a join takes no parameters.
    const ASSOCIATIVE: bool = false;
    /// More parameter sets that the proofs run at, beside the defaults.
    const SAMPLES: &'static [&'static [f64]] = &[];
    /// The new value from the two.
    fn join<R: Real>(x: R, y: R, a: Args<'_, R>) -> R;
    /// Which operand is the result, to the bit, wherever the operands lie in these ranges: a part of space where that is known needs no
    /// more than this one.
    fn kept(_x: SingleInterval, _y: SingleInterval, _a: Args<'_, SingleInterval>) -> Kept {
        Kept::Both
    }
    /// Slope of the result, from the slopes of the two, over all directions in which both may change.
    fn lipschitz(a: &[f64], x: f64, y: f64) -> f64;
    /// A box that holds all places where the result is at most `level`, from boxes of the operands' level sets: `x(l)`
    /// holds all places where `x` is at most `l`.
    fn level_bounds(
        a: &[f64],
        level: f64,
        x: &dyn Fn(f64) -> Aabb,
        y: &dyn Fn(f64) -> Aabb,
    ) -> Aabb;
    /// A box that holds the result, from the boxes of fields whose values are at least the distance to their box along
    /// some axis.
    fn bounds(a: &[f64], x: &Aabb, y: &Aabb) -> Aabb {
        Self::level_bounds(a, 0.0, &|level| x.grow(level), &|level| y.grow(level))
    }
    /// A box that holds the result of joining many fields from left to right, from their boxes.
    fn fold_bounds(a: &[f64], shapes: &[Aabb]) -> Aabb {
        let joined = shapes
            .iter()
            .copied()
            .reduce(|x, y| Self::bounds(a, &x, &y));
        joined.unwrap_or(Aabb::EMPTY)
    }
    /// How true the result is.
    fn exactness(x: Exactness, y: Exactness) -> Exactness;
    /// How far from both surfaces the join may move the surface: 0 for sharp joins, infinite where the operands' signs
    /// alone never decide.
    fn reach(_a: &[f64]) -> f64 {
        0.0
    }
    /// Whether a point is in the result if it is in (`x`, `y`), for points farther than [`Self::reach`] from both surfaces.
    fn contains(x: bool, y: bool) -> bool;
    /// Relations between parameters that ranges cannot state.
    fn check(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
}
