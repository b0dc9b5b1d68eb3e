//! What stands in the way of a proof, in words.

use super::jet::Jet;
use super::place;
use super::tape::{Cell, ProofTape};
use crate::formula::print::{number, text};
use crate::formula::{Binary, FormulaStep, Unary};
use std::fmt;
use zeroset_catalogue::bounds::Aabb;

/// What a step may do that has no slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// Divides by a number that may be 0.
    Division,
    /// Takes the root of a number that may be 0.
    Root,
    /// Takes the logarithm of a number that may be 0 or below.
    Logarithm,
    /// Raises a number that may be 0 to a power below 1, or one that varies.
    Power,
    /// Raises a number that may be negative to a power that is not whole, or takes its logarithm.
    Base,
    /// Takes the arc sine or arc cosine of a number that may reach -1 or 1.
    Arc,
    /// Takes the tangent of an angle that may be a right one.
    Tangent,
    /// Jumps, as whole numbers do.
    FormulaStep,
    /// Chooses between two values that differ where the condition flips.
    Choice,
    /// Takes the angle of a point that may be the origin.
    Origin,
    /// Jumps by a full turn.
    Turn,
    /// Grows beyond all numbers.
    Overflow,
}

/// The step of a formula that has no bounded slope, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// What it does.
    pub cause: Cause,
    /// The step as text.
    pub expression: String,
    /// What the step is about, as text: the divisor, the number under the root.
    pub operand: String,
    /// Range of the operand in the box.
    pub range: [f64; 2],
    /// The box in which it does.
    pub within: Aabb,
    /// Whether the box is as small as the search goes. Otherwise the budget ended, and with a larger one there might be a
    /// proof.
    pub certain: bool,
}

impl Obstacle {
    /// What is wrong with a step that has no bound although its operands have, over a cell.
    pub(super) fn new(
        tape: &ProofTape,
        jets: &[Jet],
        step: usize,
        cell: &Cell,
        certain: bool,
    ) -> Obstacle {
        let steps = tape.steps();
        let jet = |i: u32| &jets[i as usize];
        let is_angle = |i: usize| matches!(steps[i], FormulaStep::Binary(Binary::Atan2, ..));
        let turned = steps[step].operands().any(|i| jet(i).turned);
        let (cause, step, operand) = match steps[step] {
            FormulaStep::Binary(Binary::Atan2, y, x)
                if holds_zero(jet(x)) && holds_zero(jet(y)) =>
            {
                (Cause::Origin, step, y)
            }
            FormulaStep::Binary(Binary::Atan2, y, _) => (Cause::Turn, step, y),
            _ if turned => {
                // told of where it comes from
                let angle = (0..step)
                    .rev()
                    .find(|&i| is_angle(i) && jets[i].turned)
                    .unwrap_or(step);
                (
                    Cause::Turn,
                    angle,
                    steps[angle].operands().next().unwrap_or_default(),
                )
            }
            FormulaStep::Binary(Binary::Div | Binary::Modulo, _, y) if holds_zero(jet(y)) => {
                (Cause::Division, step, y)
            }
            FormulaStep::Binary(Binary::Modulo, x, _) => (Cause::FormulaStep, step, x),
            FormulaStep::Binary(Binary::Either, x, _) => match steps[x as usize] {
                FormulaStep::Binary(Binary::When, condition, _) => (Cause::Choice, step, condition),
                _ => (Cause::Choice, step, x),
            },
            FormulaStep::Binary(Binary::Less, x, _) => (Cause::FormulaStep, step, x),
            FormulaStep::Binary(Binary::Pow, x, _) => (Cause::Power, step, x),
            FormulaStep::Unary(Unary::Floor, x) => (Cause::FormulaStep, step, x),
            FormulaStep::Unary(Unary::Sqrt, x) => (Cause::Root, step, x),
            FormulaStep::Unary(Unary::Ln, x) => (Cause::Logarithm, step, x),
            FormulaStep::Unary(Unary::Asin | Unary::Acos, x) => (Cause::Arc, step, x),
            FormulaStep::Unary(Unary::Tan, x) => (Cause::Tangent, step, x),
            _ => (Cause::Overflow, step, step as u32),
        };
        Obstacle::of(tape, jets, (cause, step, operand), cell, certain)
    }

    /// That a step does something that its operand does not allow, over a cell.
    pub(super) fn of(
        tape: &ProofTape,
        jets: &[Jet],
        (cause, step, operand): (Cause, usize, u32),
        cell: &Cell,
        certain: bool,
    ) -> Obstacle {
        let steps = tape.steps();
        let range = jets[operand as usize].value();
        Obstacle {
            cause,
            expression: text(steps, step as u32),
            operand: text(steps, operand),
            range: [range.lo, range.hi],
            within: Aabb::new(cell.min, cell.max),
            certain,
        }
    }
}

/// A number without the hair that rounding left.
fn about(x: f64) -> f64 {
    if x.abs() < 1e-15 { 0.0 } else { x }
}

fn holds_zero(jet: &Jet) -> bool {
    jet.value().lo <= 0.0 && jet.value().hi >= 0.0
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (e, x) = (&self.expression, &self.operand);
        if self.cause != Cause::Base {
            f.write_str("the slope of the formula cannot be bounded: ")?;
        }
        match self.cause {
            Cause::Division => write!(f, "`{e}` divides by `{x}`, which may be 0")?,
            Cause::Root => write!(
                f,
                "`{e}` is infinitely steep where `{x}` is 0 (the length of a vector is not: use length(...))"
            )?,
            Cause::Logarithm => write!(f, "`{e}` is infinitely steep where `{x}` is 0 or below")?,
            Cause::Power => write!(
                f,
                "`{e}` is infinitely steep or not a number where `{x}` is 0"
            )?,
            Cause::Base if self.certain => {
                write!(f, "`{e}` has no value where `{x}` is negative, and it is")?
            }
            Cause::Base => write!(
                f,
                "`{e}` has no value where `{x}` is negative, and it could not be shown that it never is"
            )?,
            Cause::Arc => write!(f, "`{e}` is infinitely steep where `{x}` is -1 or 1")?,
            Cause::Tangent => write!(f, "`{e}` is infinite at an angle of 90 degrees")?,
            Cause::FormulaStep => {
                write!(f, "`{e}` jumps (copies are better made with repeat(...))")?
            }
            Cause::Choice => write!(
                f,
                "`{e}` jumps where `{x}` changes, unless its two values agree there, which could not be shown"
            )?,
            Cause::Origin => write!(f, "`{e}` turns infinitely fast where both are 0")?,
            Cause::Turn => write!(
                f,
                "`{e}` jumps by a full turn (only the sin and cos of its whole multiples do not)"
            )?,
            Cause::Overflow => write!(f, "`{e}` grows beyond all numbers")?,
        }
        let middle = std::array::from_fn(|k| 0.5 * (self.within.min[k] + self.within.max[k]));
        write!(f, " near {}", place(middle))?;
        if self.range.iter().all(|x| x.is_finite())
            && !matches!(self.cause, Cause::Overflow | Cause::Choice)
        {
            write!(
                f,
                ", where `{x}` is {} to {}",
                number(about(self.range[0])),
                number(about(self.range[1]))
            )?;
        }
        if self.cause == Cause::Base {
            return write!(
                f,
                ": write max({x}, 0) or abs({x}) in its place, or bounds within which it is not; whole powers such as pow({x}, 3) \
                 may be of anything"
            );
        }
        if !self.certain {
            f.write_str(" (or the search was too short to tell: raise its budget)")?;
        }
        Ok(())
    }
}
