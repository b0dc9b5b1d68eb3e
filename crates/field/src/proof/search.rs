//! The search for the largest slope in a box.

use super::look::gradient;
use super::{Budget, Cell, Jet, Obstacle, ProofError, ProofTape};
use crate::formula::STEEPEST;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use zeroset_catalogue::bounds::Aabb;
use zeroset_number::{Dual, F64};

/// What a search found.
#[derive(Debug)]
pub(crate) struct Slope {
    /// No gradient in the box is longer.
    pub(crate) slope: f64,
    /// The longest gradient found.
    pub(crate) steepest: f64,
    /// Where.
    pub(crate) steepest_at: [f64; 3],
}

/// A cell that waits to be cut.
pub(super) struct Waiting {
    /// What makes it urgent.
    pub(super) urgency: f64,
    /// What decides between cells of equal urgency.
    pub(super) order: u64,
    pub(super) cell: Cell,
    /// Where to cut.
    pub(super) axis: usize,
}

impl PartialEq for Waiting {
    fn eq(&self, o: &Self) -> bool {
        self.cmp(o) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        Some(self.cmp(o))
    }
}

impl Ord for Waiting {
    /// Among equals, what came last is the smallest cell: the search goes straight to a place without a bound.
    fn cmp(&self, o: &Self) -> Ordering {
        self.urgency
            .total_cmp(&o.urgency)
            .then(self.order.cmp(&o.order))
    }
}

/// A cell without a bound is given up when it is this part of the box.
const SMALLEST: f64 = 1.0 / 16384.0;

struct Search<'t> {
    tape: &'t ProofTape,
    bounds: Cell,
    jets: Vec<Jet>,
    /// See [`ProofTape::alive`].
    alive: Option<Vec<bool>>,
    duals: Vec<Dual<F64>>,
    cells: u64,
    steepest: f64,
    steepest_at: [f64; 3],
}

/// The slope over the box, by branch and bound: the cell with the largest bound is cut until the bound is close to a
/// gradient that was found.
pub(crate) fn slope(tape: &ProofTape, bounds: &Aabb, budget: &Budget) -> Result<Slope, ProofError> {
    let whole = Cell::of(bounds);
    let mut search = Search {
        tape,
        bounds: whole,
        jets: Vec::new(),
        alive: None,
        duals: Vec::new(),
        cells: 0,
        steepest: 0.0,
        steepest_at: whole.centre(),
    };
    let limit = budget.cells(tape);
    let mut heap = BinaryHeap::new();
    heap.push(search.look(whole, f64::INFINITY)?);
    loop {
        let worst = heap
            .pop()
            .expect("every cell that is taken out is cut in two");
        if worst.urgency <= search.steepest * (1.0 + budget.tolerance) || search.cells >= limit {
            if worst.urgency == f64::INFINITY {
                return Err(search.give_up(&worst.cell));
            }
            let (slope, steepest, at) = (worst.urgency, search.steepest, search.steepest_at);
            if slope > STEEPEST {
                return Err(ProofError::Steep {
                    slope,
                    steepest,
                    at,
                });
            }
            return Ok(Slope {
                slope,
                steepest,
                steepest_at: at,
            });
        }
        search.probe(worst.cell.centre());
        for half in worst.cell.split(worst.axis) {
            heap.push(search.look(half, worst.urgency)?);
        }
    }
}

impl Search<'_> {
    /// Finds the bound over a cell, which is no more than that of the cell it was cut from.
    fn look(&mut self, cell: Cell, bound: f64) -> Result<Waiting, ProofError> {
        self.cells += 1;
        let jet = self.tape.jets(&cell, &mut self.jets);
        self.alive = self.tape.alive(&self.jets);
        let defined = (0..self.jets.len()).all(|i| !self.counts(i) || self.jets[i].is_defined());
        let (urgency, axis) = if defined && jet.is_bounded() {
            // a cell that is too small to be cut may be cut anywhere
            let axis = self.longest(&cell, self.jets.len() - 1).unwrap_or(0);
            (jet.slope.l.min(bound), axis)
        } else {
            match self.longest(&cell, self.obstacle()) {
                Some(axis) => (f64::INFINITY, axis),
                None => return Err(self.give_up(&cell)),
            }
        };
        Ok(Waiting {
            urgency,
            order: self.cells,
            cell,
            axis,
        })
    }

    /// Looks for a longer gradient at a point.
    fn probe(&mut self, at: [f64; 3]) {
        let length = gradient(self.tape, at, &mut self.duals);
        if length > self.steepest {
            (self.steepest, self.steepest_at) = (length, at);
        }
    }

    /// The step of the last evaluation that is to blame for a missing bound: the first one without a bound, unless it does
    /// not matter for the formula and another one is no number.
    fn obstacle(&self) -> usize {
        let last = self.jets.len() - 1;
        let is_fine = if self.jets[last].is_bounded() {
            Jet::is_defined
        } else {
            Jet::is_bounded
        };
        (0..self.jets.len())
            .find(|&i| self.counts(i) && !is_fine(&self.jets[i]))
            .unwrap_or(last)
    }

    /// Whether a step counts in the cell that was looked at last.
    fn counts(&self, step: usize) -> bool {
        self.alive.as_ref().is_none_or(|alive| alive[step])
    }

    /// The axis along which a cell is longest, among those that a step depends on; none where the cell is too small to be
    /// cut.
    fn longest(&self, cell: &Cell, step: usize) -> Option<usize> {
        let share = |k: usize| cell.side(k) / self.bounds.side(k);
        (0..3)
            .filter(|&k| self.tape.reaches(step, k) && share(k) > SMALLEST)
            .max_by(|&a, &b| cell.side(a).total_cmp(&cell.side(b)))
    }

    fn give_up(&mut self, cell: &Cell) -> ProofError {
        self.tape.jets(cell, &mut self.jets);
        self.alive = self.tape.alive(&self.jets);
        let step = self.obstacle();
        let small = self.longest(cell, step).is_none();
        let obstacle = Obstacle::new(self.tape, &self.jets, step, cell, small);
        ProofError::Unbounded(Box::new(obstacle))
    }
}
