//! Looking at a formula in places: where it is steep, where its box cuts it, how far its solid reaches.

use super::search::Waiting;
use super::{Budget, Cell, ProofTape};
use std::collections::BinaryHeap;
use zeroset_catalogue::bounds::Aabb;
use zeroset_number::{Dual, F64, v3};

/// Length of the gradient at a point; 0 where it has none.
pub(super) fn gradient(tape: &ProofTape, [x, y, z]: [f64; 3], duals: &mut Vec<Dual<F64>>) -> f64 {
    let Dual { v, d } = tape.eval(Dual::point(v3(F64(x), F64(y), F64(z))), duals);
    let length = d.iter().map(|d| d.0 * d.0).sum::<f64>().sqrt();
    if v.0.is_finite() && length.is_finite() {
        length
    } else {
        0.0
    }
}

/// The longest gradient in some places of the box.
pub(crate) fn sample(tape: &ProofTape, bounds: &Aabb) -> (f64, [f64; 3]) {
    const LOOKS: f64 = 8e6;
    // fewer places of a long formula, so that looking takes no longer than the proof
    let side = ((LOOKS / tape.steps().len() as f64).cbrt() as usize).clamp(2, 8);
    let mut duals = Vec::new();
    let mut steepest = (0.0, bounds.centre());
    for i in 0..side * side * side {
        let index = [i % side, i / side % side, i / side / side];
        let p = std::array::from_fn(|k| {
            // off the middle of the box, where kinks are
            let t = (index[k] as f64 + 0.43) / side as f64;
            bounds.min[k] + t * (bounds.max[k] - bounds.min[k])
        });
        let length = gradient(tape, p, &mut duals);
        if length > steepest.0 {
            steepest = (length, p);
        }
    }
    steepest
}

/// How long the gradient is on the surface: the median over places where lines between the nodes of a grid pass it, or over all nodes where none
/// does. Jumps and poles are no such places.
pub(crate) fn usual(tape: &ProofTape, bounds: &Aabb) -> f64 {
    const LOOKS: f64 = 4e5;
    /// Halvings of what is between two nodes.
    const HALVINGS: u32 = 12;
    let side = ((LOOKS / tape.steps().len() as f64).cbrt() as usize).clamp(4, 24);
    let last = tape.steps().len() - 1;
    let (mut values, mut duals) = (Vec::new(), Vec::new());
    let mut value = |[x, y, z]: [f64; 3]| tape.eval(v3(F64(x), F64(y), F64(z)), &mut values).0;
    let place = |index: [usize; 3]| -> [f64; 3] {
        std::array::from_fn(|k| {
            let t = (index[k] as f64 + 0.43) / side as f64;
            bounds.min[k] + t * (bounds.max[k] - bounds.min[k])
        })
    };
    let nodes = (0..side * side * side).map(|i| [i % side, i / side % side, i / side / side]);
    let nodes: Vec<[usize; 3]> = nodes.collect();
    let found: Vec<f64> = nodes.iter().map(|index| value(place(*index))).collect();
    let mut lengths = Vec::new();
    for (i, index) in nodes.iter().enumerate() {
        for (axis, apart) in [1, side, side * side].into_iter().enumerate() {
            if index[axis] + 1 == side || !tape.reaches(last, axis) {
                continue;
            }
            let behind = found[i] < 0.0;
            if behind == (found[i + apart] < 0.0) {
                continue;
            }
            let mut beyond = *index;
            beyond[axis] += 1;
            let (mut from, mut to) = (place(*index), place(beyond));
            for _ in 0..HALVINGS {
                let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
                if (value(middle) < 0.0) == behind {
                    from = middle;
                } else {
                    to = middle;
                }
            }
            // a jump is no smaller between places that are nearer, and a pole is larger
            let jump = (value(from) - value(to)).abs();
            if jump < 0.1 * (found[i] - found[i + apart]).abs() {
                lengths.push(gradient(tape, from, &mut duals));
            }
        }
    }
    if lengths.is_empty() {
        lengths.extend(
            nodes
                .iter()
                .map(|index| gradient(tape, place(*index), &mut duals)),
        );
    }
    // where it has none
    lengths.retain(|length| *length > 0.0);
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

/// A point of the box's side where the formula is below zero by more than a hair, if there is one that can be found: the
/// lowest part of the side is cut until it is known to be above.
pub(crate) fn cut(
    tape: &ProofTape,
    bounds: &Aabb,
    slope: f64,
    budget: &Budget,
) -> Option<[f64; 3]> {
    let whole = Cell::of(bounds);
    let last = tape.steps().len() - 1;
    let along = (0..3).filter(|&k| tape.reaches(last, k));
    let hair = 1e-6 * slope * along.map(|k| whole.side(k)).fold(0.0, f64::max);
    let (mut jets, mut values) = (Vec::new(), Vec::new());
    let mut heap = BinaryHeap::new();
    let mut looked = 0;
    let mut look = |cell: Cell| {
        looked += 1;
        let jet = tape.jets(&cell, &mut jets);
        let [x, y, z] = cell.centre().map(F64);
        let middle = tape.eval(v3(x, y, z), &mut values).0;
        let change = |k: usize| 0.5 * cell.side(k) * jet.slope.d[k].mag().min(slope);
        // rounding is no matter here: nothing but a warning depends on it
        let lowest = jet
            .value()
            .lo
            .max(middle - (change(0) + change(1) + change(2)));
        let waiting = Waiting {
            urgency: -lowest,
            order: u64::MAX - looked,
            cell,
            axis: (1..3).fold(0, |best, k| if change(k) > change(best) { k } else { best }),
        };
        (waiting, middle < -hair, looked)
    };
    let mut found = Vec::new();
    // nothing ends along an axis that the formula does not know: it is a plane shape, or cut as is said elsewhere
    for k in 0..3 {
        if k == 2 && !tape.reaches(last, k) && bounds.max[k] >= zeroset_catalogue::LARGE {
            continue;
        }
        for side in [bounds.min[k], bounds.max[k]] {
            let mut cell = whole;
            (cell.min[k], cell.max[k]) = (side, side);
            found.push(look(cell));
        }
    }
    loop {
        for (waiting, inside, looked) in found.drain(..) {
            if inside {
                return Some(waiting.cell.centre());
            }
            if looked > budget.cells(tape) / 8 {
                return None;
            }
            heap.push(waiting);
        }
        let lowest = heap.pop()?;
        if lowest.urgency <= hair {
            return None;
        }
        found.extend(lowest.cell.split(lowest.axis).map(&mut look));
    }
}

/// A box that holds all places of `bounds` where the formula may be 0 or below, as small as a short search finds it: cells that
/// are cut away where the formula is above 0.
pub(crate) fn reach(tape: &ProofTape, bounds: &Aabb) -> Aabb {
    const WORK: u64 = 200_000;
    let whole = Cell::of(bounds);
    let (mut jets, mut values) = (Vec::new(), Vec::new());
    let last = tape.steps().len() - 1;
    // as large as may be inside: the cells that count for the sides are the outer ones, which are cut first
    let most = (WORK / tape.work()).clamp(64, 20_000);
    let mut waiting = std::collections::VecDeque::from([whole]);
    let mut kept = Aabb::EMPTY;
    let mut looked = 0;
    let share = |cell: &Cell, k: usize| cell.side(k) / whole.side(k);
    while let Some(cell) = waiting.pop_front() {
        let inside = Aabb::new(cell.min, cell.max);
        if kept.hull(&inside) == kept {
            continue;
        }
        looked += 1;
        let jet = tape.jets(&cell, &mut jets);
        let [x, y, z] = cell.centre().map(F64);
        let middle = tape.eval(v3(x, y, z), &mut values).0;
        let along = (0..3).filter(|&k| tape.reaches(last, k));
        let way = along
            .map(|k| 0.25 * cell.side(k) * cell.side(k))
            .sum::<f64>()
            .sqrt();
        // where the value jumps only its range counts
        let change = if jet.turned {
            f64::INFINITY
        } else {
            way * jet.slope.l
        };
        let lowest = jet.value().lo.max(middle - change);
        if lowest > 0.0 {
            continue;
        }
        let axis = (0..3)
            .filter(|&k| tape.reaches(last, k) && share(&cell, k) > 1.0 / 256.0)
            .max_by(|&a, &b| share(&cell, a).total_cmp(&share(&cell, b)));
        match axis {
            Some(axis) if looked < most => waiting.extend(cell.split(axis)),
            _ => kept = kept.hull(&inside),
        }
    }
    kept
}
