//! Powers and logarithms: whether what they are of can be negative.

use super::{Budget, Cause, Cell, Obstacle, ProofError, ProofTape};
use crate::formula::{Binary, FormulaStep, Unary};
use std::collections::VecDeque;
use zeroset_catalogue::bounds::Aabb;
use zeroset_number::{F64, v3};

/// A base that falls below 0 by no more than this part of its size counts as 0: rounding does as much.
const HAIR: f64 = 1e-6;

/// A cell is not cut any more when it is this part of the box.
const SMALLEST: f64 = 1.0 / 65536.0;

/// Whether every power that is not whole, and every logarithm, is of a number that is not negative anywhere in the box.
///
/// What a power of a negative number gives is not a number. Vector code and shaders take 0 for it or nothing at all, so such
/// a formula would show something else than what is written.
///
/// # Errors
/// A base that is negative somewhere, or that could not be shown not to be within the budget.
pub(crate) fn bases(tape: &ProofTape, bounds: &Aabb, budget: &Budget) -> Result<(), ProofError> {
    let steps = tape.steps();
    let of = |step: &FormulaStep| match *step {
        FormulaStep::Binary(Binary::Pow, base, _) | FormulaStep::Unary(Unary::Ln, base) => {
            Some(base as usize)
        }
        _ => None,
    };
    let all: Vec<(usize, usize)> = (steps.iter().enumerate())
        .filter_map(|(i, step)| Some((i, of(step)?)))
        .collect();
    if all.is_empty() {
        return Ok(());
    }
    let whole = Cell::of(bounds);
    let (mut jets, mut values) = (Vec::new(), Vec::new());
    tape.jets(&whole, &mut jets);
    let hair: Vec<f64> = (all.iter())
        .map(|&(_, base)| HAIR * jets[base].value().mag().min(1e30))
        .collect();
    let mut waiting = VecDeque::from([whole]);
    let mut looked = 0;
    while let Some(cell) = waiting.pop_front() {
        looked += 1;
        tape.jets(&cell, &mut jets);
        let [x, y, z] = cell.centre().map(F64);
        tape.eval(v3(x, y, z), &mut values);
        let (mut doubtful, alive) = (None, tape.alive(&jets));
        for (&(step, base), &hair) in all.iter().zip(&hair) {
            if alive.as_ref().is_some_and(|alive| !alive[step]) {
                continue;
            }
            let (jet, middle) = (&jets[base], values[base].0);
            // where a choice may leave it out, what it has in the middle says nothing
            let certain = alive.is_none();
            if certain && middle < -hair {
                return Err(refused(tape, &jets, (step, base), &cell, true));
            }
            // the nearer the base is to its smallest value, the flatter it is: this bound closes in faster than the range
            let change: f64 = (0..3)
                .map(|k| 0.5 * cell.side(k) * jet.slope.d[k].mag())
                .sum();
            // also where the bound is no number
            let fine = jet.value().lo >= -hair || middle - change >= -hair;
            if !fine {
                doubtful = doubtful.or(Some((step, base)));
            }
        }
        let Some(place) = doubtful else { continue };
        let share = |k: usize| cell.side(k) / whole.side(k);
        let axis = (0..3)
            .filter(|&k| tape.reaches(place.1, k) && share(k) > SMALLEST)
            .max_by(|&a, &b| share(a).total_cmp(&share(b)));
        match axis {
            Some(axis) if looked < budget.cells(tape) => waiting.extend(cell.split(axis)),
            _ => return Err(refused(tape, &jets, place, &cell, false)),
        }
    }
    Ok(())
}

fn refused(
    tape: &ProofTape,
    jets: &[super::Jet],
    (step, base): (usize, usize),
    cell: &Cell,
    certain: bool,
) -> ProofError {
    ProofError::Negative(Box::new(Obstacle::of(
        tape,
        jets,
        (Cause::Base, step, base as u32),
        cell,
        certain,
    )))
}
