//! How often a ray from far away along x crosses closed triangles before it comes to each node of a grid: entries less exits.
//!
//! A ray that meets an edge or a vertex counts once, whatever rounding does: its sides of edges are exact (Shewchuk 1997), and a
//! ray that is on one counts as moved aside by less than any number (simulation of simplicity, Edelsbrunner and Mücke 1990).

use crate::nearest::Lattice;
use robust::{Coord, orient2d};
use std::ops::Range;

type Triangle = [[f64; 3]; 3];

/// Adds up crossings for the layers of nodes in `layers`, x fastest.
pub(crate) fn count(
    triangles: &[&[Triangle]],
    lattice: &Lattice,
    layers: Range<usize>,
) -> Vec<i32> {
    let [nx, ny, _] = lattice.nodes;
    let mut sums = vec![0_i32; nx * ny * layers.len()];
    for t in triangles.iter().flat_map(|t| t.iter()) {
        let rows = range(t, 1, lattice, 0..ny);
        let planes = range(t, 2, lattice, layers.clone());
        for k in planes {
            for j in rows.clone() {
                let [_, y, z] = lattice.at([0, j, k]);
                let Some((x, exits)) = crossing(t, y, z) else {
                    continue;
                };
                // the first node behind it
                let i = ((x - lattice.origin[0]) / lattice.step).ceil().max(0.0) as usize;
                let mut i = i.min(nx);
                while i > 0 && lattice.at([i - 1, 0, 0])[0] > x {
                    i -= 1;
                }
                while i < nx && lattice.at([i, 0, 0])[0] <= x {
                    i += 1;
                }
                if i < nx {
                    sums[i + nx * (j + ny * (k - layers.start))] += if exits { -1 } else { 1 };
                }
            }
        }
    }
    for row in sums.chunks_mut(nx) {
        let mut sum = 0;
        for x in row {
            sum += *x;
            *x = sum;
        }
    }
    sums
}

/// The nodes along an axis that a triangle may cover.
fn range(t: &Triangle, axis: usize, lattice: &Lattice, within: Range<usize>) -> Range<usize> {
    let low = t.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
    let high = t.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
    let node = |x: f64| (x - lattice.origin[axis]) / lattice.step;
    // one more on both sides than rounding could ask for
    let first = (node(low).floor() - 1.0).max(0.0) as usize;
    let last = (node(high).ceil() + 2.0).max(0.0) as usize;
    first.max(within.start)..last.min(within.end)
}

/// Where the line along x through (y, z) crosses a triangle, and whether it leaves there.
fn crossing(t: &Triangle, y: f64, z: f64) -> Option<(f64, bool)> {
    let flat = |p: &[f64; 3]| Coord { x: p[1], y: p[2] };
    let p = Coord { x: y, y: z };
    let mut weights = [0.0; 3];
    let mut exits = None;
    for k in 0..3 {
        let (a, b) = (flat(&t[k]), flat(&t[(k + 1) % 3]));
        let side = orient2d(a, b, p);
        let aside = if side != 0.0 {
            side > 0.0
        } else if a.y != b.y {
            b.y < a.y
        } else if a.x != b.x {
            b.x > a.x
        } else {
            return None;
        };
        if exits.is_some_and(|e| e != aside) {
            return None;
        }
        exits = Some(aside);
        weights[(k + 2) % 3] = side.abs();
    }
    let all: f64 = weights.iter().sum();
    let x = if all > 0.0 {
        (0..3).map(|k| t[k][0] * (weights[k] / all)).sum()
    } else {
        t[0][0]
    };
    exits.map(|e| (x, e))
}
