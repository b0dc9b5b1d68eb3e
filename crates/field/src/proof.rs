//! The proof of a formula's slope: interval arithmetic on its gradient over a box that is cut where the bound is worst.

use crate::formula::print::number;
use std::fmt;

mod base;
mod choice;
mod jet;
mod look;
mod obstacle;
mod search;
mod tape;

pub use obstacle::{Cause, Obstacle};

pub(crate) use base::bases;
use jet::Jet;
pub(crate) use look::{cut, reach, sample, usual};
pub(crate) use search::slope;
use tape::Cell;
pub(crate) use tape::ProofTape;

/// How long a proof may search. It counts steps, not time, so that it finds the same on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Steps evaluated over a box: a formula of n steps is looked at in `operations / n` boxes. The default takes about a
    /// tenth of a second.
    pub operations: u64,
    /// The search ends when the bound is within this part of the longest gradient found.
    pub tolerance: f64,
}

/// Steps evaluated that any formula is worth.
const LONGEST: u64 = 4_000_000;

impl Default for Budget {
    fn default() -> Self {
        Budget {
            operations: 500_000,
            tolerance: 0.05,
        }
    }
}

impl Budget {
    /// Boxes that a formula may be looked at in: a few also of a long one, as long as that is a matter of a second.
    fn cells(&self, tape: &ProofTape) -> u64 {
        let steps = tape.work();
        (self.operations / steps).max((LONGEST / steps).clamp(1, 64))
    }
}

/// Why a formula has no proven slope. Every message says what was given and what to do.
#[derive(Clone, Debug, PartialEq)]
pub enum ProofError {
    /// A box that is empty, endless or too large.
    Bounds {
        /// Smallest corner.
        min: [f64; 3],
        /// Largest corner.
        max: [f64; 3],
    },
    /// A plane shape that depends on z.
    Flat,
    /// A stated slope that is not above 0, or above [`STEEPEST`](crate::formula::STEEPEST).
    Slope {
        /// What was stated.
        given: f64,
    },
    /// The gradient has no bound, or none was found.
    Unbounded(Box<Obstacle>),
    /// A power or a logarithm of a number that can be negative, or that cannot be shown not to be.
    Negative(Box<Obstacle>),
    /// The gradient is bounded, but by more than [`STEEPEST`](crate::formula::STEEPEST).
    Steep {
        /// The bound.
        slope: f64,
        /// The longest gradient found.
        steepest: f64,
        /// Where it was found.
        at: [f64; 3],
    },
}

impl std::error::Error for ProofError {}

/// What can be done about a formula without a proof.
const REMEDY: &str = "change the formula or its bounds, or state the slope by hand with slope = ..., which is then reported \
                      as unproven";

impl fmt::Display for ProofError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ProofError::Bounds { min, max } => write!(
                f,
                "the bounds of a formula must be a box with sides above 0 within -1e9 to 1e9, not {} to {}",
                place(*min),
                place(*max)
            ),
            ProofError::Flat => {
                f.write_str("a plane shape cannot depend on z: its points are (x, y)")
            }
            ProofError::Slope { given } => {
                write!(
                    f,
                    "a stated slope must be above 0 and at most 1e6, not {given}"
                )
            }
            ProofError::Unbounded(obstacle) => write!(f, "{obstacle}; {REMEDY}"),
            ProofError::Negative(obstacle) => write!(f, "{obstacle}"),
            ProofError::Steep {
                slope,
                steepest,
                at,
            } => write!(
                f,
                "the slope of the formula may be {} (found: {} at {}), and 1e6 is the most that can be rendered; {REMEDY}",
                number(*slope),
                number(*steepest),
                place(*at)
            ),
        }
    }
}

/// A point as text.
fn place(p: [f64; 3]) -> String {
    format!("({}, {}, {})", number(p[0]), number(p[1]), number(p[2]))
}
