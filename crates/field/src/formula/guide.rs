//! About how far it is to the surface of a formula whose values do not say so.

use super::{FormulaStep, Steps};
use crate::sampled::Sampled;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_number::{F64, Grid, v3};

/// Nodes along the longest side of the box, at most.
const NODES: u32 = 48;
/// Steps of formulas that may be evaluated for it.
const WORK: f64 = 8e6;
/// Cells around the box of the solid.
const MARGIN: f64 = 2.0;

/// A guide: distances to the surface, with its sign, at the nodes of a grid.
///
/// Where a formula has no Lipschitz constant its value may be large beside the surface, or small far away from it, and so may be what a line along
/// the gradient says. The distance between places with one sign and places with the other is known to about a cell whatever values do in
/// between; it sets how large a value may be, and how small (see the lowering of formulas to programs).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Guide {
    /// The distances.
    pub(crate) distances: Sampled,
    /// By how much they may be off: one and a half cells.
    pub(crate) slack: f64,
}

impl Guide {
    /// That of a formula over its box, whose solid is within `reach`; `None` where there is no surface between its nodes.
    pub(crate) fn of(steps: &Steps, bounds: &Aabb, reach: &Aabb) -> Option<Guide> {
        // values that keep marks of a painted field would lose them
        let is_painted = |step: &FormulaStep| matches!(step, FormulaStep::Field(..));
        if reach.is_empty() || !reach.is_finite() || steps.list().iter().any(is_painted) {
            return None;
        }
        let side = (WORK / steps.list().len() as f64).cbrt() as u32;
        let longest = (0..3).map(|k| reach.half()[k] * 2.0).fold(0.0, f64::max);
        let inner = f64::from(side.clamp(12, NODES)) - 1.0 - 2.0 * MARGIN;
        let voxel = longest / inner;
        let nodes = std::array::from_fn(|k| {
            let cells = (reach.half()[k] * 2.0 / voxel).ceil() + 2.0 * MARGIN;
            cells as u32 + 1
        });
        let middle = reach.centre();
        let half = nodes.map(|n| 0.5 * voxel * f64::from(n - 1));
        let min: [f64; 3] = std::array::from_fn(|k| middle[k] - half[k]);
        let max: [f64; 3] = std::array::from_fn(|k| middle[k] + half[k]);
        let count = nodes.map(|n| n as usize);
        let index = |[i, j, k]: [usize; 3]| i + count[0] * (j + count[1] * k);
        let mut values = Vec::with_capacity(count.iter().product());
        for k in 0..count[2] {
            for j in 0..count[1] {
                for i in 0..count[0] {
                    let at = [i, j, k];
                    let p: [f64; 3] = std::array::from_fn(|a| min[a] + voxel * at[a] as f64);
                    let value = match bounds.contains(p) {
                        true => steps.eval(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0,
                        false => f64::INFINITY,
                    };
                    values.push(value);
                }
            }
        }
        // what is no number is outside, as in a program
        let behind = |x: f64| x < 0.0;
        // squares of distances in voxels: at nodes beside the surface by where it is between them, as far as a line says
        let mut squares = vec![f64::INFINITY; values.len()];
        let mut found = false;
        for (axis, apart) in [1, count[0], count[0] * count[1]].into_iter().enumerate() {
            for k in 0..count[2] {
                for j in 0..count[1] {
                    for i in 0..count[0] {
                        let at = [i, j, k];
                        if at[axis] + 1 == count[axis] {
                            continue;
                        }
                        let (a, b) = (index(at), index(at) + apart);
                        if behind(values[a]) == behind(values[b]) {
                            continue;
                        }
                        found = true;
                        let share = values[a].abs() / (values[a].abs() + values[b].abs());
                        let share = if share.is_finite() { share } else { 0.5 };
                        squares[a] = squares[a].min(share * share);
                        squares[b] = squares[b].min((1.0 - share) * (1.0 - share));
                    }
                }
            }
        }
        if !found {
            return None;
        }
        let mut line = Vec::new();
        for (axis, apart) in [1, count[0], count[0] * count[1]].into_iter().enumerate() {
            for first in 0..values.len() {
                if first / apart % count[axis] != 0 {
                    continue;
                }
                line.clear();
                line.extend((0..count[axis]).map(|n| squares[first + n * apart]));
                for n in 0..count[axis] {
                    squares[first + n * apart] = least(&line, n);
                }
            }
        }
        let signed = squares.iter().zip(&values).map(|(square, value)| {
            let distance = square.sqrt() * voxel;
            (if behind(*value) { -distance } else { distance }) as f32
        });
        let grid = Grid::new(nodes, signed.collect()).ok()?;
        let distances = Sampled::new(Arc::new(grid), Aabb::new(min, max)).ok()?;
        Some(Guide {
            distances,
            slack: 1.5 * voxel,
        })
    }
}

/// The least of `line[m] + (n - m)^2`: a scan outwards that ends where nothing can be less.
fn least(line: &[f64], n: usize) -> f64 {
    let mut best = line[n];
    for away in 1..line.len() {
        let square = (away * away) as f64;
        if square >= best {
            break;
        }
        for m in [n.checked_sub(away), Some(n + away)].into_iter().flatten() {
            if let Some(height) = line.get(m) {
                best = best.min(height + square);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formula::Builder;

    #[test]
    fn distances_of_a_ball_whose_values_are_none() {
        let builder = Builder::new();
        let r = builder.point().length();
        // 0 at 0.8, flat far away and endless in the middle
        let value = (r.square() * -3.0).exp() * -1.0 + (-3.0 * 0.64_f64).exp();
        let steps = builder.finish(&value).expect("steps");
        let bounds = Aabb::centred([4.0; 3]);
        let reach = steps.reach(&bounds);
        let guide = Guide::of(&steps, &bounds, &reach).expect("a surface");
        let (grid, box_) = (guide.distances.grid(), guide.distances.bounds());
        let nodes = grid.nodes().map(|n| n as usize);
        let mut worst = 0.0_f64;
        for k in 0..nodes[2] {
            for j in 0..nodes[1] {
                for i in 0..nodes[0] {
                    let p: [f64; 3] = std::array::from_fn(|a| {
                        let share = [i, j, k][a] as f64 / (nodes[a] - 1) as f64;
                        box_.min[a] + share * (box_.max[a] - box_.min[a])
                    });
                    let r = p.iter().map(|c| c * c).sum::<f64>().sqrt();
                    let off = (f64::from(grid.at([i, j, k])) - (r - 0.8)).abs();
                    worst = worst.max(off);
                }
            }
        }
        assert!(worst < guide.slack, "{worst} of {}", guide.slack);
        assert!(guide.slack < 0.12, "{}", guide.slack);
    }

    #[test]
    fn there_is_none_without_a_surface() {
        let builder = Builder::new();
        let value = builder.point().length() + 1.0;
        let steps = builder.finish(&value).expect("steps");
        let bounds = Aabb::centred([1.0; 3]);
        assert_eq!(Guide::of(&steps, &bounds, &bounds), None);
    }
}
