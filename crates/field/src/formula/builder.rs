//! Writing a formula down.

use super::colour::{ColourFormula, ColourFormulaError};
use super::inner::Inner;
use super::print::{number, text};
use super::{Binary, FormulaStep, LARGEST, NoiseKind, Steps, Unary};
use crate::field::Field;
use std::collections::HashMap;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use zeroset_catalogue::Dimension;
use zeroset_catalogue::op::arithmetic;
use zeroset_number::F64;

/// Most steps of a formula.
pub const MAX_STEPS: usize = 1_000_000;

/// Why a formula cannot be written down.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BuildError {
    /// More steps than the limit.
    #[error(
        "the formula takes more than {limit} steps, which is the limit; build the shape of several fields instead"
    )]
    Steps {
        /// The limit.
        limit: usize,
    },
    /// A constant that is not finite or out of range, or that became so when constants were folded.
    #[error("{expression} is {value}, and numbers of a formula must lie within -1e18 to 1e18")]
    Constant {
        /// The constant, as text.
        expression: String,
        /// Its value.
        value: f64,
    },
    /// A power of a number below 0 that is not whole.
    #[error("pow({base}, {power}) has no value: only whole powers of a negative number have one")]
    Power {
        /// The number.
        base: f64,
        /// The power.
        power: f64,
    },
    /// A value of another formula.
    #[error("a value of one formula is used in another: a formula can only use its own point")]
    Foreign,
    /// Vectors of different lengths, or a number where a vector is needed.
    #[error("{function} needs {wanted}, not {given}")]
    Parts {
        /// Function or operator.
        function: &'static str,
        /// What it needs.
        wanted: &'static str,
        /// What it got.
        given: String,
    },
    /// The wrong number of arguments.
    #[error("{function} takes {wanted}, {given} given")]
    Arguments {
        /// Function.
        function: &'static str,
        /// What it takes.
        wanted: String,
        /// Number of arguments given.
        given: usize,
    },
    /// A field that is called at a point of the wrong length, or that is too large.
    #[error("{reason}")]
    Field {
        /// Why, and what to do.
        reason: String,
    },
    /// A value that is a vector.
    #[error(
        "the value of a formula is one number, this is a vector of {parts}; length(...) makes a number of it"
    )]
    Vector {
        /// Its length.
        parts: usize,
    },
}

/// A formula that is being written down: a list of steps that [`Expression`]s append to. Cloning gives another handle to
/// the same formula.
///
/// Equal steps are written once. Constants are not: which numbers happen to be equal must not change a formula's
/// structure. A function of nothing but constants is a constant again.
///
/// A mistake does not interrupt: the first one is kept and told by [`Builder::check`] and [`Builder::finish`].
#[derive(Clone, Debug)]
pub struct Builder(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    steps: Vec<FormulaStep>,
    known: HashMap<StepKey, u32>,
    fields: Vec<Inner>,
    limit: usize,
    failure: Option<BuildError>,
}

/// What makes two steps equal.
#[derive(PartialEq, Eq, Hash, Debug)]
enum StepKey {
    Unary(Unary, u32),
    Binary(Binary, u32, u32),
    Noise(NoiseKind, [u32; 3]),
    Field(u32, [u32; 3]),
}

/// Coordinates, which are always the first steps.
const COORDINATES: [FormulaStep; 3] = [
    FormulaStep::Coordinate(0),
    FormulaStep::Coordinate(1),
    FormulaStep::Coordinate(2),
];

impl Default for Builder {
    fn default() -> Self {
        Self::new()
    }
}

impl Builder {
    /// An empty formula of at most [`MAX_STEPS`] steps.
    pub fn new() -> Builder {
        Builder::with_limit(MAX_STEPS)
    }

    /// An empty formula of at most `limit` steps, and no more than [`MAX_STEPS`].
    pub fn with_limit(limit: usize) -> Builder {
        Builder(Arc::new(Mutex::new(State {
            steps: COORDINATES.to_vec(),
            known: HashMap::new(),
            fields: Vec::new(),
            limit: limit.min(MAX_STEPS),
            failure: None,
        })))
    }

    /// The point at which the formula is evaluated: a vector of x, y and z.
    pub fn point(&self) -> Expression {
        self.expression(&[0, 1, 2])
    }

    /// A number.
    pub fn constant(&self, c: f64) -> Expression {
        let step = self.state().constant(c);
        self.expression(&[step])
    }

    /// A vector of numbers or of parts of vectors, in their order: 2 to 4 in all.
    pub fn vector(&self, parts: &[Expression]) -> Expression {
        let mut steps = Vec::new();
        for part in parts {
            if !self.owns(part) {
                return self.fail(BuildError::Foreign);
            }
            steps.extend_from_slice(part.steps());
        }
        if !(2..=4).contains(&steps.len()) {
            return self.fail(BuildError::Parts {
                function: "a vector",
                wanted: "2 to 4 numbers",
                given: steps.len().to_string(),
            });
        }
        self.expression(&steps)
    }

    /// A function of one number, part by part.
    pub fn unary(&self, f: Unary, x: &Expression) -> Expression {
        if !self.owns(x) {
            return self.fail(BuildError::Foreign);
        }
        let mut state = self.state();
        let mut out = [0; 4];
        for (out, &x) in out.iter_mut().zip(x.steps()) {
            *out = state.unary(f, x);
        }
        self.expression(&out[..x.parts()])
    }

    /// A function of two numbers, part by part; a number stands for a vector of equal parts.
    pub fn binary(&self, f: Binary, x: &Expression, y: &Expression) -> Expression {
        if !self.owns(x) || !self.owns(y) {
            return self.fail(BuildError::Foreign);
        }
        let n = x.parts().max(y.parts());
        if [x, y].iter().any(|e| e.parts() != 1 && e.parts() != n) {
            return self.fail(BuildError::Parts {
                function: super::print::binary(f),
                wanted: "numbers or vectors of the same length",
                given: format!("{} and {}", x.spoken(), y.spoken()),
            });
        }
        let mut state = self.state();
        let mut out = [0; 4];
        for (k, out) in out[..n].iter_mut().enumerate() {
            *out = state.binary(f, x.spread(k), y.spread(k));
        }
        self.expression(&out[..n])
    }

    /// A noise at a point of 3 numbers, or of 2 in the plane z = 0.
    pub fn noise(&self, kind: NoiseKind, p: &Expression) -> Expression {
        let needs = ("noise", "a point of 2 or 3 numbers");
        self.at_point(p, needs, |state, q| state.noise(kind, q))
    }

    /// The value of a field at a point of 3 numbers; of a plane shape, at one of 2.
    pub fn field(&self, field: &Field, p: &Expression) -> Expression {
        let plane = field.facts().dimension == Dimension::Two;
        match (plane, p.parts()) {
            (true, 2) | (false, 3) => {}
            (true, _) => {
                return self.fail(BuildError::Field {
                    reason: format!(
                        "a plane shape is asked at (x, y), as in s(p.xy), not at {}",
                        p.spoken()
                    ),
                });
            }
            (false, _) => {
                return self.fail(BuildError::Field {
                    reason: format!(
                        "a field is asked at a point (x, y, z), not at {}",
                        p.spoken()
                    ),
                });
            }
        }
        let key = field.key();
        let known = self
            .state()
            .fields
            .iter()
            .position(|f| f.field().key() == key);
        let number = match known {
            Some(number) => number,
            None => match Inner::new(field) {
                Ok(inner) => {
                    let mut state = self.state();
                    state.fields.push(inner);
                    state.fields.len() - 1
                }
                Err(e) => {
                    return self.fail(BuildError::Field {
                        reason: e.to_string(),
                    });
                }
            },
        };
        let needs = ("a field", "a point");
        self.at_point(p, needs, |state, q| state.field(number as u32, q))
    }

    /// What `value` gives at the steps of a point, the third of which is 0 where there are two.
    fn at_point(
        &self,
        p: &Expression,
        (function, wanted): (&'static str, &'static str),
        value: impl FnOnce(&mut State, [u32; 3]) -> u32,
    ) -> Expression {
        if !self.owns(p) {
            return self.fail(BuildError::Foreign);
        }
        let step = {
            let mut state = self.state();
            let q = match *p.steps() {
                [x, y, z] => Some([x, y, z]),
                [x, y] => Some([x, y, state.constant(0.0)]),
                _ => None,
            };
            q.map(|q| value(&mut state, q))
        };
        match step {
            Some(step) => self.expression(&[step]),
            None => {
                let given = p.spoken();
                self.fail(BuildError::Parts {
                    function,
                    wanted,
                    given,
                })
            }
        }
    }

    /// Whether all went well so far.
    ///
    /// # Errors
    /// The first mistake.
    pub fn check(&self) -> Result<(), BuildError> {
        self.state().failure.clone().map_or(Ok(()), Err)
    }

    /// The steps that `value` needs.
    ///
    /// # Errors
    /// The first mistake that was made, or a value that is a vector or belongs to another formula.
    pub fn finish(&self, value: &Expression) -> Result<Steps, BuildError> {
        if value.parts() > 1 {
            self.check()?;
            let parts = value.parts();
            return Err(BuildError::Vector { parts });
        }
        self.needed(value).map(|(steps, _)| steps)
    }

    /// The steps that three numbers need, red, green and blue, linear; or one, which is a grey of this luminance.
    ///
    /// # Errors
    /// The first mistake that was made, a value of two or four parts or of another formula, or one that is too large to be compiled.
    pub fn finish_colour(&self, value: &Expression) -> Result<ColourFormula, ColourFormulaError> {
        let (steps, results) = self.needed(value)?;
        match results[..] {
            [red, green, blue] => ColourFormula::new(steps, [red, green, blue]),
            [grey] => ColourFormula::new(steps, [grey; 3]),
            _ => Err(ColourFormulaError::Parts {
                parts: results.len(),
            }),
        }
    }

    /// The steps that the parts of a value need, in their order, and which of them they are.
    fn needed(&self, value: &Expression) -> Result<(Steps, Vec<u32>), BuildError> {
        if !self.owns(value) {
            return Err(BuildError::Foreign);
        }
        self.check()?;
        let state = self.state();
        let last = value.steps().iter().copied().fold(0, u32::max);
        let mut used = vec![false; last as usize + 1];
        for step in value.steps() {
            used[*step as usize] = true;
        }
        for step in (0..used.len()).rev() {
            if used[step] {
                for operand in state.steps[step].operands() {
                    used[operand as usize] = true;
                }
            }
        }
        let mut renamed = vec![0; used.len()];
        let mut steps = Vec::new();
        for step in 0..used.len() {
            if used[step] {
                renamed[step] = steps.len() as u32;
                let name = |x: u32| renamed[x as usize];
                steps.push(state.steps[step].renamed(name));
            }
        }
        // fields that are not needed are left out too
        let mut numbers: Vec<u32> = Vec::new();
        for step in &mut steps {
            if let FormulaStep::Field(field, _) = step {
                let place = numbers.iter().position(|n| n == field);
                let place = place.unwrap_or_else(|| {
                    numbers.push(*field);
                    numbers.len() - 1
                });
                *field = place as u32;
            }
        }
        let fields = numbers.iter().map(|n| state.fields[*n as usize].clone());
        let parts = value.steps().iter().map(|step| renamed[*step as usize]);
        let steps = Steps {
            list: steps,
            fields: fields.collect(),
        };
        Ok((steps, parts.collect()))
    }

    /// Remembers a mistake; what is given back stands for the value that there is not.
    pub(super) fn fail(&self, error: BuildError) -> Expression {
        self.state().failure.get_or_insert(error);
        self.expression(&[0])
    }

    fn owns(&self, e: &Expression) -> bool {
        Arc::ptr_eq(&self.0, &e.builder.0)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // a list of steps is whole after every statement
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn expression(&self, steps: &[u32]) -> Expression {
        let mut all = [0; 4];
        all[..steps.len()].copy_from_slice(steps);
        Expression {
            builder: self.clone(),
            steps: all,
            parts: steps.len() as u8,
        }
    }
}

/// A constant power that is a whole number.
fn whole(power: f64) -> Option<i32> {
    (power.fract() == 0.0 && power.abs() <= f64::from(i32::MAX)).then_some(power as i32)
}

/// Steps in which whole powers are written as products, as [`Builder`] writes them. `kept` are steps, and are what these are called then.
pub(super) fn without_whole_powers(
    steps: Vec<FormulaStep>,
    fields: &[Inner],
    kept: &mut [u32],
) -> Result<Vec<FormulaStep>, BuildError> {
    let is_whole = |step: &FormulaStep| match *step {
        FormulaStep::Binary(Binary::Pow, _, n) => {
            matches!(steps[n as usize], FormulaStep::Constant(n) if whole(n).is_some())
        }
        _ => false,
    };
    if !steps.iter().any(is_whole) {
        return Ok(steps);
    }
    let builder = Builder::new();
    let last = {
        let mut state = builder.state();
        state.fields = fields.to_vec();
        let mut names: Vec<u32> = Vec::with_capacity(steps.len());
        for step in &steps {
            let name = match *step {
                FormulaStep::Coordinate(k) => u32::from(k),
                FormulaStep::Constant(c) => state.constant(c),
                FormulaStep::Unary(f, x) => state.unary(f, names[x as usize]),
                FormulaStep::Binary(f, x, y) => {
                    state.binary(f, names[x as usize], names[y as usize])
                }
                FormulaStep::Noise(kind, q) => state.noise(kind, q.map(|x| names[x as usize])),
                FormulaStep::Field(i, q) => state.field(i, q.map(|x| names[x as usize])),
            };
            names.push(name);
        }
        for step in kept.iter_mut() {
            *step = names[*step as usize];
        }
        let last = names.last().copied().unwrap_or_default();
        kept.iter().copied().fold(last, u32::max)
    };
    builder.check()?;
    let state = builder.state();
    // all of them: the order of fields stays
    Ok(state.steps[..=last as usize].to_vec())
}

impl State {
    fn push(&mut self, step: FormulaStep) -> u32 {
        if self.steps.len() >= self.limit {
            let limit = self.limit;
            self.failure.get_or_insert(BuildError::Steps { limit });
            return 0;
        }
        self.steps.push(step);
        self.steps.len() as u32 - 1
    }

    fn constant(&mut self, c: f64) -> u32 {
        // also refuses NaN
        if !(-LARGEST..=LARGEST).contains(&c) {
            self.failure.get_or_insert(BuildError::Constant {
                expression: "a constant".into(),
                value: c,
            });
            return 0;
        }
        self.push(FormulaStep::Constant(c))
    }

    /// A constant that an operation on constants gave.
    fn folded(&mut self, c: f64, expression: impl FnOnce(&[FormulaStep]) -> String) -> u32 {
        if !(-LARGEST..=LARGEST).contains(&c) {
            let expression = expression(&self.steps);
            self.failure.get_or_insert(BuildError::Constant {
                expression,
                value: c,
            });
            return 0;
        }
        self.push(FormulaStep::Constant(c))
    }

    fn unary(&mut self, f: Unary, x: u32) -> u32 {
        match self.steps[x as usize] {
            FormulaStep::Constant(c) => {
                let value = arithmetic::unary(f, F64(c)).0;
                return self.folded(value, |_| {
                    format!("{}({})", super::print::unary(f), number(c))
                });
            }
            FormulaStep::Unary(Unary::Neg, y) => match f {
                Unary::Neg => return y,
                Unary::Abs | Unary::Square | Unary::Cos => return self.unary(f, y),
                _ => {}
            },
            _ => {}
        }
        if f == Unary::Sqrt
            && let Some(roots) = self.roots(x)
        {
            return self.hypot(&roots);
        }
        if let Some(&known) = self.known.get(&StepKey::Unary(f, x)) {
            return known;
        }
        let step = self.push(FormulaStep::Unary(f, x));
        self.known.insert(StepKey::Unary(f, x), step);
        step
    }

    fn binary(&mut self, f: Binary, x: u32, y: u32) -> u32 {
        if f == Binary::Pow
            && let FormulaStep::Constant(power) = self.steps[y as usize]
            && let Some(n) = whole(power)
        {
            return self.power(x, n);
        }
        if let (FormulaStep::Constant(a), FormulaStep::Constant(b)) =
            (self.steps[x as usize], self.steps[y as usize])
            && !matches!(f, Binary::When | Binary::Either)
        {
            if f == Binary::Pow && a < 0.0 {
                let (base, power) = (a, b);
                self.failure
                    .get_or_insert(BuildError::Power { base, power });
                return 0;
            }
            let value = arithmetic::binary(f, F64(a), F64(b)).0;
            return self.folded(value, |steps| {
                let mut steps = steps.to_vec();
                steps.push(FormulaStep::Binary(f, x, y));
                text(&steps, steps.len() as u32 - 1)
            });
        }
        // a square is never negative, and its slope is found more closely
        if f == Binary::Mul && x == y {
            return self.unary(Unary::Square, x);
        }
        if matches!(f, Binary::Min | Binary::Max) && x == y {
            return x;
        }
        let symmetric = matches!(
            f,
            Binary::Add | Binary::Mul | Binary::Min | Binary::Max | Binary::Hypot
        );
        let key = if symmetric && x > y {
            StepKey::Binary(f, y, x)
        } else {
            StepKey::Binary(f, x, y)
        };
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let step = self.push(FormulaStep::Binary(f, x, y));
        self.known.insert(key, step);
        step
    }

    fn noise(&mut self, kind: NoiseKind, q: [u32; 3]) -> u32 {
        self.once(StepKey::Noise(kind, q), FormulaStep::Noise(kind, q))
    }

    fn field(&mut self, field: u32, q: [u32; 3]) -> u32 {
        self.once(StepKey::Field(field, q), FormulaStep::Field(field, q))
    }

    fn once(&mut self, key: StepKey, step: FormulaStep) -> u32 {
        if let Some(&known) = self.known.get(&key) {
            return known;
        }
        let step = self.push(step);
        self.known.insert(key, step);
        step
    }

    /// `x` to a whole power, by squaring: a number below 0 has one too. (The logarithm that other powers go by has no value
    /// there.)
    fn power(&mut self, x: u32, n: i32) -> u32 {
        if let FormulaStep::Constant(base) = self.steps[x as usize] {
            return self.folded(base.powi(n), |_| format!("pow({}, {n})", number(base)));
        }
        let Some(top) = n.unsigned_abs().checked_ilog2() else {
            return self.constant(1.0);
        };
        let power = (0..top).rev().fold(x, |power, bit| {
            let square = self.unary(Unary::Square, power);
            if n.unsigned_abs() >> bit & 1 == 1 {
                self.binary(Binary::Mul, square, x)
            } else {
                square
            }
        });
        if n > 0 {
            return power;
        }
        let one = self.constant(1.0);
        self.binary(Binary::Div, one, power)
    }

    /// What is squared in a sum of a few squares.
    fn roots(&self, x: u32) -> Option<Vec<u32>> {
        const MOST: usize = 8;
        // not by recursion: a sum may have as many terms as a formula has steps
        let (mut waiting, mut roots) = (vec![x], Vec::new());
        while let Some(x) = waiting.pop() {
            match self.steps[x as usize] {
                FormulaStep::Unary(Unary::Square, root) => roots.push(root),
                FormulaStep::Binary(Binary::Add, x, y) => waiting.extend([y, x]),
                _ => return None,
            }
            if roots.len() + waiting.len() > MOST {
                return None;
            }
        }
        Some(roots)
    }

    /// `sqrt(x^2 + ...)`, which is the absolute value of a number alone.
    fn hypot(&mut self, parts: &[u32]) -> u32 {
        let (&first, rest) = parts.split_first().expect("a length has parts");
        if rest.is_empty() {
            return self.unary(Unary::Abs, first);
        }
        rest.iter().fold(first, |length, &part| {
            self.binary(Binary::Hypot, length, part)
        })
    }
}

/// A value of a formula that is being written down: a number, or a vector of 2 to 4 numbers.
///
/// Functions of numbers go part by part over vectors, and where one takes several, a number stands for a vector of equal
/// parts. Plain `f64` numbers are constants.
#[derive(Clone, Debug)]
pub struct Expression {
    builder: Builder,
    steps: [u32; 4],
    parts: u8,
}

/// An operand: an expression, or a number that becomes a constant of the same formula.
pub trait Operand {
    /// The operand as an expression of the formula that `other` belongs to.
    fn beside(&self, other: &Expression) -> Expression;
}

impl Operand for Expression {
    fn beside(&self, _other: &Expression) -> Expression {
        self.clone()
    }
}

impl Operand for &Expression {
    fn beside(&self, _other: &Expression) -> Expression {
        (*self).clone()
    }
}

impl Operand for f64 {
    fn beside(&self, other: &Expression) -> Expression {
        other.builder.constant(*self)
    }
}

macro_rules! unary_methods {
    ($($(#[$doc:meta])* $name:ident $f:ident;)*) => {$(
        $(#[$doc])*
        pub fn $name(&self) -> Expression {
            self.builder.unary(Unary::$f, self)
        }
    )*};
}

macro_rules! binary_methods {
    ($($(#[$doc:meta])* $name:ident $f:ident;)*) => {$(
        $(#[$doc])*
        pub fn $name(&self, o: impl Operand) -> Expression {
            self.builder.binary(Binary::$f, self, &o.beside(self))
        }
    )*};
}

impl Expression {
    /// The formula it belongs to.
    pub fn builder(&self) -> &Builder {
        &self.builder
    }

    /// How many numbers it is: 1, or the length of the vector.
    pub fn parts(&self) -> usize {
        usize::from(self.parts)
    }

    /// Part `k` of a vector.
    pub fn part(&self, k: usize) -> Expression {
        if k >= self.parts() {
            return self.builder.fail(BuildError::Parts {
                function: ["x", "y", "z", "w"].get(k).copied().unwrap_or("a part"),
                wanted: "a longer vector",
                given: self.spoken(),
            });
        }
        self.builder.expression(&[self.steps[k]])
    }

    /// First part.
    pub fn x(&self) -> Expression {
        self.part(0)
    }

    /// Second part.
    pub fn y(&self) -> Expression {
        self.part(1)
    }

    /// Third part.
    pub fn z(&self) -> Expression {
        self.part(2)
    }

    /// Parts by their letters, as in `xz` or `zyx`; `None` for a name that holds anything but the letters of its parts.
    pub fn swizzle(&self, name: &str) -> Option<Expression> {
        let letter = |c: char| "xyzw"[..self.parts()].find(c).map(|k| self.steps[k]);
        let steps: Vec<u32> = name.chars().map(letter).collect::<Option<_>>()?;
        ((1..=4).contains(&steps.len()) && self.parts > 1).then(|| self.builder.expression(&steps))
    }

    unary_methods! {
        /// Absolute value.
        abs Abs;
        /// Square root; 0 below 0. Of a sum of squares it becomes the [`length`](Expression::length), whose slope is
        /// bounded.
        sqrt Sqrt;
        /// The square.
        square Square;
        /// The largest whole number that is not above.
        floor Floor;
        /// Sine of an angle in radians.
        sin Sin;
        /// Cosine of an angle in radians.
        cos Cos;
        /// Tangent of an angle in radians.
        tan Tan;
        /// Angle in [-pi/2, pi/2] that has this sine.
        asin Asin;
        /// Angle in [0, pi] that has this cosine.
        acos Acos;
        /// Angle in (-pi/2, pi/2) that has this tangent.
        atan Atan;
        /// e to the power of it.
        exp Exp;
        /// Natural logarithm.
        ln Ln;
        /// Hyperbolic tangent.
        tanh Tanh;
    }

    binary_methods! {
        /// The smaller.
        min Min;
        /// The larger.
        max Max;
        /// `self - o floor(self / o)`.
        modulo Modulo;
        /// self to the power of `o`. Where `o` is a constant whole number, self may be below 0 and the power becomes part of the
        /// formula's structure.
        pow Pow;
        /// Angle of the point (`o`, self) in [-pi, pi].
        atan2 Atan2;
        /// `sqrt(self^2 + o^2)`.
        hypot Hypot;
    }

    /// self to a whole power, by squaring: also for self below 0. The power is part of the formula's structure.
    pub fn powi(&self, n: i32) -> Expression {
        let mut state = self.builder.state();
        let mut out = [0; 4];
        for (out, &x) in out.iter_mut().zip(self.steps()) {
            *out = state.power(x, n);
        }
        drop(state);
        self.builder.expression(&out[..self.parts()])
    }

    /// The value of a constant number.
    pub fn as_constant(&self) -> Option<f64> {
        match (self.steps(), self.builder.state()) {
            (&[step], state) => match state.steps[step as usize] {
                FormulaStep::Constant(c) => Some(c),
                _ => None,
            },
            _ => None,
        }
    }

    /// The smallest whole number that is not below.
    pub fn ceil(&self) -> Expression {
        -(-self).floor()
    }

    /// The nearest whole number, halves upwards.
    pub fn round(&self) -> Expression {
        (self + 0.5).floor()
    }

    /// `self - floor(self)`.
    pub fn fract(&self) -> Expression {
        self - self.floor()
    }

    /// -1 below 0, else 1.
    pub fn sign(&self) -> Expression {
        self.clamp(-0.5, 0.5).floor() * 2.0 + 1.0
    }

    /// 0 where self is below `edge`, else 1.
    pub fn step(&self, edge: impl Operand) -> Expression {
        (self - edge).clamp(-0.5, 0.5).floor() + 1.0
    }

    /// self, but not outside [`lo`, `hi`].
    pub fn clamp(&self, lo: impl Operand, hi: impl Operand) -> Expression {
        self.max(lo).min(hi)
    }

    /// `self + (o - self) t`.
    pub fn mix(&self, o: impl Operand, t: impl Operand) -> Expression {
        self + (o.beside(self) - self) * t
    }

    /// The cubic step 3 t^2 - 2 t^3, where t goes from 0 at `lo` to 1 at `hi`.
    pub fn smoothstep(&self, lo: impl Operand, hi: impl Operand) -> Expression {
        let (lo, hi) = (lo.beside(self), hi.beside(self));
        let t = ((self - &lo) / (hi - &lo)).clamp(0.0, 1.0);
        t.square() * (-(t * 2.0) + 3.0)
    }

    /// Euclidean length of a vector; the absolute value of a number. Its slope is at most 1.
    pub fn length(&self) -> Expression {
        let step = self.builder.state().hypot(self.steps());
        self.builder.expression(&[step])
    }

    /// Euclidean distance of two points.
    pub fn distance(&self, o: impl Operand) -> Expression {
        (self - o).length()
    }

    /// Scalar product.
    pub fn dot(&self, o: impl Operand) -> Expression {
        let product = self * o;
        let mut sum = product.part(0);
        for k in 1..product.parts() {
            sum = sum + product.part(k);
        }
        sum
    }

    /// Vector product of two vectors of 3.
    pub fn cross(&self, o: impl Operand) -> Expression {
        let o = o.beside(self);
        if (self.parts, o.parts) != (3, 3) {
            return self.builder.fail(BuildError::Parts {
                function: "cross",
                wanted: "two vectors of 3",
                given: format!("{} and {}", self.spoken(), o.spoken()),
            });
        }
        let part = |a: usize, b: usize| self.part(a) * o.part(b) - self.part(b) * o.part(a);
        self.builder.vector(&[part(1, 2), part(2, 0), part(0, 1)])
    }

    /// The vector of length 1 in the same direction. It jumps where the vector is zero.
    pub fn normalize(&self) -> Expression {
        self / self.length()
    }

    /// 1 where self is below `o`, else 0: a condition, for [`Expression::choose`] and the like.
    pub fn less(&self, o: impl Operand) -> Expression {
        self.builder.binary(Binary::Less, self, &o.beside(self))
    }

    /// Whether a condition does not hold.
    pub fn negated(&self) -> Expression {
        1.0 - self
    }

    /// Where self, a condition, holds, `yes`, else `no`. The slope is proven where the two agree wherever the condition
    /// flips: where replacing one side of each comparison in it by the other makes them equal.
    pub fn choose(&self, yes: impl Operand, no: impl Operand) -> Expression {
        let (yes, no) = (yes.beside(self), no.beside(self));
        match self.as_constant() {
            Some(c) if c > 0.5 => return yes,
            Some(_) => return no,
            None => {}
        }
        let same = yes.steps() == no.steps();
        if same {
            return yes;
        }
        let halves = (
            self.builder.binary(Binary::When, self, &yes),
            self.builder.binary(Binary::When, &self.negated(), &no),
        );
        self.builder.binary(Binary::Either, &halves.0, &halves.1)
    }

    /// A vector of 3 turned about an axis by an angle in radians, counter-clockwise where the axis points at you (Rodrigues
    /// 1840).
    pub fn rotate(&self, axis: [f64; 3], theta: impl Operand) -> Expression {
        if self.parts != 3 {
            return self.builder.fail(BuildError::Parts {
                function: "rotate",
                wanted: "a vector of 3, an axis and an angle",
                given: self.spoken(),
            });
        }
        let theta = theta.beside(self);
        let (s, c) = (theta.sin(), theta.cos());
        let length = axis[0].hypot(axis[1]).hypot(axis[2]);
        let number = |k: usize| self.builder.constant(axis[k] / length);
        // along an axis of coordinates two parts turn and the third stays
        if let Some(k) = (0..3).find(|&k| axis[k].abs() == length) {
            let s = if axis[k] < 0.0 { -s } else { s };
            let (u, v) = (self.part((k + 1) % 3), self.part((k + 2) % 3));
            let turned = [self.part(k), &u * &c - &v * &s, &u * &s + &v * &c];
            let place = |i: usize| turned[(i + 3 - k) % 3].clone();
            return self.builder.vector(&[place(0), place(1), place(2)]);
        }
        let n = self.builder.vector(&[number(0), number(1), number(2)]);
        let along = self.dot(&n) * (1.0 - &c);
        self * c + n.cross(self) * s + n * along
    }

    /// A vector of 2 turned by an angle in radians, from the first part towards the second.
    pub fn turned(&self, theta: impl Operand) -> Expression {
        if self.parts != 2 {
            return self.builder.fail(BuildError::Parts {
                function: "rotate",
                wanted: "a vector of 2 and an angle",
                given: self.spoken(),
            });
        }
        let theta = theta.beside(self);
        let (s, c) = (theta.sin(), theta.cos());
        let (x, y) = (self.x(), self.y());
        self.builder.vector(&[&x * &c - &y * &s, x * s + y * c])
    }

    /// The smaller, with the edge between the two rounded where they differ by less than `k`: the quadratic polynomial of
    /// Quilez 2013, `min(a, b) - h^2 / (4 k)` with `h = max(k - |a - b|, 0)`.
    pub fn smooth_min(&self, o: impl Operand, k: impl Operand) -> Expression {
        let (o, k) = (o.beside(self), k.beside(self));
        let h = (&k - (self - &o).abs()).max(0.0);
        self.min(o) - h.square() / (k * 4.0)
    }

    /// A fractal sum of noises at a point: the mean of `octaves` layers, each twice as fine and half as strong as the one
    /// before, turned and moved against it (Musgrave 1993; the same as [`zeroset_catalogue::noise::fbm`]).
    pub fn fbm(&self, kind: NoiseKind, octaves: u32) -> Expression {
        let mut q = match self.parts {
            2 => self
                .builder
                .vector(&[self.clone(), self.builder.constant(0.0)]),
            _ => self.clone(),
        };
        let (mut sum, mut weights, mut weight) = (self.builder.constant(0.0), 0.0, 1.0);
        for layer in 0..octaves {
            let noise = self.builder.noise(kind, &q);
            if noise.parts() != 1 || q.parts() != 3 {
                return noise;
            }
            sum = if layer == 0 {
                noise
            } else {
                sum + noise * weight
            };
            weights += weight;
            weight *= 0.5;
            let (x, y, z) = (q.x(), q.y(), q.z());
            // (2, -1, 2), (2, 2, -1), (-1, 2, 2) over 3: a rotation
            let turned = self.builder.vector(&[
                (&x + &z) * 2.0 - &y,
                (&x + &y) * 2.0 - &z,
                (&y + &z) * 2.0 - &x,
            ]);
            let moved = [19.1, 7.7, 13.3].map(|c| self.builder.constant(c));
            q = turned * (2.0 / 3.0) + self.builder.vector(&moved);
        }
        sum / weights
    }

    /// The smallest part.
    pub fn least(&self) -> Expression {
        (1..self.parts()).fold(self.part(0), |least, k| least.min(self.part(k)))
    }

    /// The largest part.
    pub fn greatest(&self) -> Expression {
        (1..self.parts()).fold(self.part(0), |greatest, k| greatest.max(self.part(k)))
    }

    fn steps(&self) -> &[u32] {
        &self.steps[..self.parts()]
    }

    /// The step of part `k`; a number has equal parts.
    fn spread(&self, k: usize) -> u32 {
        self.steps[if self.parts == 1 { 0 } else { k }]
    }

    fn spoken(&self) -> String {
        match self.parts {
            1 => "a number".into(),
            n => format!("a vector of {n}"),
        }
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $f:ident;)*) => {$(
        impl<T: Operand> $trait<T> for &Expression {
            type Output = Expression;
            fn $method(self, o: T) -> Expression {
                self.builder.binary(Binary::$f, self, &o.beside(self))
            }
        }

        impl<T: Operand> $trait<T> for Expression {
            type Output = Expression;
            fn $method(self, o: T) -> Expression {
                $trait::$method(&self, o)
            }
        }

        impl $trait<&Expression> for f64 {
            type Output = Expression;
            fn $method(self, o: &Expression) -> Expression {
                $trait::$method(self.beside(o), o)
            }
        }

        impl $trait<Expression> for f64 {
            type Output = Expression;
            fn $method(self, o: Expression) -> Expression {
                $trait::$method(self, &o)
            }
        }
    )*};
}
operators! {
    Add add Add;
    Sub sub Sub;
    Mul mul Mul;
    Div div Div;
}

impl Neg for &Expression {
    type Output = Expression;
    fn neg(self) -> Expression {
        self.builder.unary(Unary::Neg, self)
    }
}

impl Neg for Expression {
    type Output = Expression;
    fn neg(self) -> Expression {
        -&self
    }
}
