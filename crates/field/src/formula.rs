//! Free-form fields: a formula over x, y and z.
//!
//! A formula is a list of [`Steps`], written down with a [`Builder`] or given as data. Nobody knows its slope beforehand,
//! so [`Formula::prove`] finds the largest length of its gradient over a box by interval arithmetic, or says why there is
//! none. [`Formula::stated`] takes somebody's word for it.
//!
//! ```
//! use zeroset_catalogue::bounds::Aabb;
//! use zeroset_field::formula::{Budget, Builder, Formula};
//!
//! let formula = Builder::new();
//! let p = formula.point();
//! let bumpy = p.length() - 1.0 + (p.x() * 10.0).sin() * 0.1;
//! let bumpy = Formula::prove(
//!     formula.finish(&bumpy)?,
//!     Aabb::centred([1.2; 3]),
//!     &Budget::default(),
//! )?;
//! // the sphere has slope 1 and so has the wave
//! assert!(bumpy.slope() > 1.9 && bumpy.slope() < 2.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) use guide::Guide;

use crate::proof::{self, ProofTape};
use std::sync::Arc;
use zeroset_catalogue::Dimension;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::op::arithmetic;
use zeroset_eval::PointNumber;
use zeroset_number::Vec3;

mod builder;
mod colour;
mod ease;
mod function;
mod guide;
mod inner;
pub(crate) mod print;

pub use crate::proof::{Budget, Cause, Obstacle, ProofError};
pub use builder::{BuildError, Builder, Expression, MAX_STEPS};
pub use colour::{ColourFormula, ColourFormulaError};
pub use ease::Ease;
pub use function::{EASE, Function, ROTATE, WHERE, functions};
pub use inner::Inner;
pub use zeroset_catalogue::op::arithmetic::{Binary, NoiseKind, Unary};

/// One step of a formula; operands are the numbers of earlier steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FormulaStep {
    /// x, y or z (0, 1, 2).
    Coordinate(u8),
    /// A number: a parameter of the compiled program, so that changing it changes no structure.
    Constant(f64),
    /// A function of one earlier step.
    Unary(Unary, u32),
    /// A function of two earlier steps.
    Binary(Binary, u32, u32),
    /// A noise at the point that three earlier steps are.
    Noise(NoiseKind, [u32; 3]),
    /// The value of the [field](Steps::fields) of this number at the point that three earlier steps are.
    Field(u32, [u32; 3]),
}

/// The largest constant that a formula may hold, in magnitude: its square fits single precision.
pub const LARGEST: f64 = 1e18;

/// The steepest formula that can be rendered: beyond it, single precision sees no slope but noise.
pub const STEEPEST: f64 = 1e6;

/// The slope of formulas that are flatter. Outside the box, the field is then at least the distance to the box, on which
/// the boxes of offsets and smooth joins rely.
const FLATTEST: f64 = 1.0;

/// Why a list of steps is no formula.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepsError {
    /// No steps.
    #[error("a formula needs at least one step")]
    Empty,
    /// More than [`MAX_STEPS`].
    #[error("the formula has {given} steps, {limit} are allowed")]
    TooMany {
        /// Steps given.
        given: usize,
        /// Steps allowed.
        limit: usize,
    },
    /// An operand that is no earlier step.
    #[error("step {step} takes step {operand}, which does not come before it")]
    Operand {
        /// The step.
        step: usize,
        /// What it takes.
        operand: u32,
    },
    /// A coordinate other than x, y and z.
    #[error("step {step} is coordinate {axis}; there are 0 (x), 1 (y) and 2 (z)")]
    Coordinate {
        /// The step.
        step: usize,
        /// The coordinate.
        axis: u8,
    },
    /// A power that has no value, or too many steps once whole powers are written as products.
    #[error(transparent)]
    Built(#[from] BuildError),
    /// A field that there is not.
    #[error("step {step} is the value of field {field}, of {given} that the formula has")]
    Field {
        /// The step.
        step: usize,
        /// The field's number.
        field: u32,
        /// How many there are.
        given: usize,
    },
    /// A constant that single precision cannot hold.
    #[error("step {step} is the constant {value}, which must lie within -1e18 to 1e18")]
    Constant {
        /// The step.
        step: usize,
        /// The number.
        value: f64,
    },
}

/// The steps of a formula, the last of which is its value. Every operand comes before the step that takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    list: Vec<FormulaStep>,
    fields: Arc<[Inner]>,
}

impl Steps {
    /// Checks a list of steps. Whole powers are written as products, so the list may become longer.
    ///
    /// # Errors
    /// No steps or too many, operands that are no earlier steps, numbers out of range.
    pub fn new(steps: Vec<FormulaStep>) -> Result<Steps, StepsError> {
        Steps::with_fields(steps, Vec::new())
    }

    /// As [`Steps::new`], for formulas that take the values of fields.
    ///
    /// # Errors
    /// As for [`Steps::new`], and a field that is not among those given.
    pub fn with_fields(steps: Vec<FormulaStep>, fields: Vec<Inner>) -> Result<Steps, StepsError> {
        Steps::checked(steps, fields, &mut [])
    }

    /// As [`Steps::with_fields`]; `kept` are steps, and are what these are called then.
    pub(crate) fn checked(
        steps: Vec<FormulaStep>,
        fields: Vec<Inner>,
        kept: &mut [u32],
    ) -> Result<Steps, StepsError> {
        if steps.is_empty() {
            return Err(StepsError::Empty);
        }
        if steps.len() > MAX_STEPS {
            let (given, limit) = (steps.len(), MAX_STEPS);
            return Err(StepsError::TooMany { given, limit });
        }
        for (step, what) in steps.iter().enumerate() {
            match *what {
                FormulaStep::Coordinate(axis) if axis > 2 => {
                    return Err(StepsError::Coordinate { step, axis });
                }
                // also refuses NaN
                FormulaStep::Constant(value) if !(-LARGEST..=LARGEST).contains(&value) => {
                    return Err(StepsError::Constant { step, value });
                }
                FormulaStep::Field(field, _) if field as usize >= fields.len() => {
                    let given = fields.len();
                    return Err(StepsError::Field { step, field, given });
                }
                _ => {}
            }
            for operand in what.operands() {
                if operand as usize >= step {
                    return Err(StepsError::Operand { step, operand });
                }
            }
        }
        if let Some(operand) = kept.iter().copied().find(|k| *k as usize >= steps.len()) {
            let step = steps.len();
            return Err(StepsError::Operand { step, operand });
        }
        let fields = Arc::from(fields);
        let list = builder::without_whole_powers(steps, &fields, kept)?;
        Ok(Steps { list, fields })
    }

    /// The steps in their order.
    pub fn list(&self) -> &[FormulaStep] {
        &self.list
    }

    /// The fields whose values the steps take.
    pub fn fields(&self) -> &[Inner] {
        &self.fields
    }

    /// A box that holds all places of `bounds` where the formula may be 0 or below, as small as a short search finds it.
    pub fn reach(&self, bounds: &Aabb) -> Aabb {
        // again within what was found, while that is much less: the search goes down to a part of the box it is given
        const TIMES: usize = 3;
        let (tape, mut within) = (ProofTape::new(self), *bounds);
        for _ in 0..TIMES {
            let found = proof::reach(&tape, &within);
            let (now, before) = (found.half(), within.half());
            let less = (0..3).any(|k| now[k] < 0.5 * before[k]);
            within = found;
            if !less || within.is_empty() {
                break;
            }
        }
        within
    }

    pub(crate) fn shared_fields(&self) -> Arc<[Inner]> {
        Arc::clone(&self.fields)
    }

    /// The value at `p`.
    pub fn eval<R: PointNumber>(&self, p: Vec3<R>) -> R {
        let values = self.eval_all(p);
        values[values.len() - 1]
    }

    /// The values of all steps at `p`.
    pub(crate) fn eval_all<R: PointNumber>(&self, p: Vec3<R>) -> Vec<R> {
        let mut values: Vec<R> = Vec::with_capacity(self.list.len());
        for step in &self.list {
            values.push(step.eval(p, &values, &self.fields));
        }
        values
    }
}

impl FormulaStep {
    /// Its value at `p`, from the values of earlier steps.
    pub(crate) fn eval<R: PointNumber>(&self, p: Vec3<R>, values: &[R], fields: &[Inner]) -> R {
        let point = |[x, y, z]: [u32; 3]| Vec3 {
            x: values[x as usize],
            y: values[y as usize],
            z: values[z as usize],
        };
        match *self {
            FormulaStep::Coordinate(k) => [p.x, p.y, p.z][usize::from(k)],
            FormulaStep::Constant(c) => p.x.like(R::constant(c)),
            FormulaStep::Unary(f, x) => arithmetic::unary(f, values[x as usize]),
            FormulaStep::Binary(f, x, y) => {
                arithmetic::binary(f, values[x as usize], values[y as usize])
            }
            FormulaStep::Noise(kind, q) => arithmetic::noise(kind, point(q)),
            FormulaStep::Field(i, q) => fields[i as usize].value(point(q)),
        }
    }

    /// The earlier steps that it takes.
    pub(crate) fn operands(&self) -> impl Iterator<Item = u32> {
        let (all, count) = match *self {
            FormulaStep::Coordinate(_) | FormulaStep::Constant(_) => ([0; 3], 0),
            FormulaStep::Unary(_, x) => ([x, 0, 0], 1),
            FormulaStep::Binary(_, x, y) => ([x, y, 0], 2),
            FormulaStep::Noise(_, q) | FormulaStep::Field(_, q) => (q, 3),
        };
        all.into_iter().take(count)
    }

    /// The same with other operands.
    pub(crate) fn renamed(self, name: impl Fn(u32) -> u32) -> FormulaStep {
        match self {
            FormulaStep::Coordinate(_) | FormulaStep::Constant(_) => self,
            FormulaStep::Unary(f, x) => FormulaStep::Unary(f, name(x)),
            FormulaStep::Binary(f, x, y) => FormulaStep::Binary(f, name(x), name(y)),
            FormulaStep::Noise(kind, q) => FormulaStep::Noise(kind, q.map(name)),
            FormulaStep::Field(i, q) => FormulaStep::Field(i, q.map(name)),
        }
    }
}

/// What the slope of a formula rests on.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// A proof.
    Proven,
    /// Somebody's word.
    Stated,
    /// Nothing: no slope holds everywhere, or none was found, for this reason. The slope is a usual one near the surface, and no step may
    /// rest on it.
    Usual(ProofError),
}

/// A formula with its box and its slope.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    steps: Steps,
    bounds: Aabb,
    slope: f64,
    ground: Ground,
    steepest: f64,
    steepest_at: [f64; 3],
    cut: Option<[f64; 3]>,
    guide: Option<Guide>,
    flat: bool,
}

impl Formula {
    /// A formula whose slope over the box is found by interval arithmetic: an upper bound on the length of its gradient
    /// anywhere in the box.
    ///
    /// The proof holds for real numbers, with the constants as they are and as single precision holds them. A picture is
    /// computed in single precision, where every step also rounds by one part in 1.7e7 of its value: a formula whose steps
    /// are much larger than the details of its surface is noisy there, whatever its slope.
    ///
    /// # Errors
    /// A box that is empty, endless or larger than 1e6; a formula whose gradient has no bound over the box, or none that
    /// was found within the budget; a power or a logarithm of a number that can be negative in the box.
    pub fn prove(steps: Steps, bounds: Aabb, budget: &Budget) -> Result<Formula, ProofError> {
        let bounds = checked(bounds)?;
        let tape = ProofTape::new(&steps);
        proof::bases(&tape, &bounds, budget)?;
        let proof = proof::slope(&tape, &bounds, budget)?;
        let cut = proof::cut(&tape, &bounds, proof.slope, budget);
        Ok(Formula {
            steps,
            bounds,
            slope: proof.slope.max(FLATTEST),
            ground: Ground::Proven,
            steepest: proof.steepest,
            steepest_at: proof.steepest_at,
            cut,
            guide: None,
            flat: false,
        })
    }

    /// Any formula: as [`Formula::prove`] where there is a proof, else with a slope that is a usual one near its surface, so that its value is
    /// about a distance there. Whoever looks for the surface of such a formula has to do so by its ranges: see
    /// [`Facts::unbounded`](crate::field::Facts::unbounded).
    ///
    /// # Errors
    /// A box that is empty, endless or larger than 1e6; a power or a logarithm of a number that can be negative in the box.
    pub fn new(steps: Steps, bounds: Aabb, budget: &Budget) -> Result<Formula, ProofError> {
        let reason = match Formula::prove(steps.clone(), bounds, budget) {
            Err(reason @ (ProofError::Unbounded(_) | ProofError::Steep { .. })) => reason,
            other => return other,
        };
        let slope = proof::usual(&ProofTape::new(&steps), &steps.reach(&bounds));
        let formula = Formula::stated(steps, bounds, slope.clamp(FLATTEST, STEEPEST))?;
        Ok(Formula {
            ground: Ground::Usual(reason),
            guide: Guide::of(&formula.steps, &formula.bounds, &formula.reach()),
            ..formula
        })
    }

    /// A formula whose slope over the box is stated. It is looked at in some places, see [`Formula::steepest`], but a
    /// slope that is too small makes holes in the picture.
    ///
    /// # Errors
    /// A box that is empty, endless or larger than 1e6; a slope that is not above 0 or larger than 1e6; a power or a
    /// logarithm of a number that can be negative in the box.
    pub fn stated(steps: Steps, bounds: Aabb, slope: f64) -> Result<Formula, ProofError> {
        let bounds = checked(bounds)?;
        // also refuses NaN
        if !(f64::MIN_POSITIVE..=STEEPEST).contains(&slope) {
            return Err(ProofError::Slope { given: slope });
        }
        let tape = ProofTape::new(&steps);
        proof::bases(&tape, &bounds, &Budget::default())?;
        let (steepest, steepest_at) = proof::sample(&tape, &bounds);
        let cut = proof::cut(&tape, &bounds, slope, &Budget::default());
        Ok(Formula {
            steps,
            bounds,
            slope: slope.max(FLATTEST),
            ground: Ground::Stated,
            steepest,
            steepest_at,
            cut,
            guide: None,
            flat: false,
        })
    }

    /// The steps; the last one is the value.
    pub fn steps(&self) -> &[FormulaStep] {
        self.steps.list()
    }

    /// The fields whose values the steps take.
    pub fn fields(&self) -> &[Inner] {
        self.steps.fields()
    }

    /// The same as a shape of the plane.
    ///
    /// # Errors
    /// A formula that depends on z.
    pub fn flattened(mut self) -> Result<Formula, ProofError> {
        if self.steps().contains(&FormulaStep::Coordinate(2)) {
            return Err(ProofError::Flat);
        }
        (self.bounds.min[2], self.bounds.max[2]) =
            (-zeroset_catalogue::LARGE, zeroset_catalogue::LARGE);
        self.flat = true;
        // which is one of space
        self.guide = None;
        Ok(self)
    }

    /// About how far the surface is, where values do not say it.
    pub(crate) fn guide(&self) -> Option<&Guide> {
        self.guide.as_ref()
    }

    /// The plane or space.
    pub fn dimension(&self) -> Dimension {
        if self.flat {
            Dimension::Two
        } else {
            Dimension::Three
        }
    }

    /// A box that holds the solid, as small as a short search finds it: no larger than [`Formula::bounds`].
    pub fn reach(&self) -> Aabb {
        self.steps.reach(&self.bounds)
    }

    /// The value at `p`, wherever that is.
    pub fn eval<R: PointNumber>(&self, p: Vec3<R>) -> R {
        self.steps.eval(p)
    }

    /// The box inside which the formula is the field; outside, the field goes on from the box's surface. Its sides are
    /// numbers of single precision, as in the compiled program.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Lipschitz constant inside the box, no less than 1; where there is none ([`Ground::Usual`]), a usual slope near the surface.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// What the slope rests on.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Whether the slope was proven, rather than stated by hand.
    pub fn is_proven(&self) -> bool {
        self.ground == Ground::Proven
    }

    /// Whether no slope holds everywhere, or none was found.
    pub fn is_unbounded(&self) -> bool {
        matches!(self.ground, Ground::Usual(_))
    }

    /// The longest gradient that was found, a lower bound on the slope. A proven slope is never below it, and the closer
    /// the two are, the fewer steps a march needs. Where a stated slope is below it, the statement is wrong.
    pub fn steepest(&self) -> f64 {
        self.steepest
    }

    /// Where [`Formula::steepest`] was found.
    pub fn steepest_at(&self) -> [f64; 3] {
        self.steepest_at
    }

    /// Whether the surface reaches the side of the box, where it is cut: the solid is what lies inside the surface and in
    /// the box. (A surface that touches the side is not cut.)
    pub fn is_cut(&self) -> bool {
        self.cut.is_some()
    }

    /// A point of the box's side that lies inside the surface, if it [is cut](Formula::is_cut).
    pub fn cut_at(&self) -> Option<[f64; 3]> {
        self.cut
    }
}

/// The box with its sides as single precision holds them.
fn checked(bounds: Aabb) -> Result<Aabb, ProofError> {
    let single = |x: f64| f64::from(x as f32);
    let bounds = Aabb::new(bounds.min.map(single), bounds.max.map(single));
    let largest = zeroset_catalogue::LARGE;
    let within = |x: &f64| (-largest..=largest).contains(x);
    let sides = bounds.min.iter().chain(&bounds.max);
    if !sides.clone().all(within) || (0..3).any(|k| bounds.min[k] >= bounds.max[k]) {
        return Err(ProofError::Bounds {
            min: bounds.min,
            max: bounds.max,
        });
    }
    Ok(bounds)
}
