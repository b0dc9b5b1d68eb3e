//! A grid of cubes, in blocks of 8 x 8 x 8.

use zeroset_catalogue::bounds::Aabb;

/// Cells along a side of a block.
pub(crate) const BLOCK: u32 = 8;
/// Nodes along a side of a block: those of its upper border are also the next block's.
pub(crate) const NODES: usize = BLOCK as usize + 1;

/// Cells of air around the box.
const AIR: f64 = 1.0;
/// Where nodes lie beside the corners of the box, in cells: not on its faces, which are often faces of the solid, so that there is
/// no choosing on which side of the surface a node lies.
const ASIDE: [f64; 3] = [0.3819, 0.4532, 0.2887];
/// The least width of a cell, in steps of single precision where it lies.
const COARSE: f64 = 64.0;

/// Cubes around a box.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    origin: [f64; 3],
    /// Width of a cell, scene units.
    pub(crate) step: f64,
    /// Cells along each axis.
    pub(crate) cells: [u32; 3],
}

impl Grid {
    /// The grid of cells of this width around a box; none where single precision has too few numbers for it, or where it has more cells
    /// along a side than can be numbered.
    pub(crate) fn new(bounds: &Aabb, step: f64) -> Option<Grid> {
        let origin: [f64; 3] = std::array::from_fn(|k| bounds.min[k] - (AIR + ASIDE[k]) * step);
        let count = |k: usize| ((bounds.max[k] - origin[k]) / step + AIR).ceil();
        let farthest = (0..3).fold(0.0_f64, |far, k| {
            let end = origin[k] + count(k) * step;
            far.max(origin[k].abs()).max(end.abs())
        });
        let is_fine = farthest * f64::from(f32::EPSILON) * COARSE > step;
        let is_long = (0..3).any(|k| count(k) > f64::from(1_u32 << 20));
        if is_fine || is_long || !farthest.is_finite() {
            return None;
        }
        Some(Grid {
            origin,
            step,
            cells: std::array::from_fn(|k| count(k) as u32),
        })
    }

    /// Blocks along each axis.
    pub(crate) fn blocks(&self) -> [u32; 3] {
        self.cells.map(|n| n.div_ceil(BLOCK))
    }

    /// A coordinate of the nodes, halves between them included: the same number wherever it is asked for.
    pub(crate) fn along(&self, axis: usize, at: f64) -> f32 {
        (self.origin[axis] + at * self.step) as f32
    }

    /// Where a node is.
    pub(crate) fn node(&self, at: [u32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| self.along(k, f64::from(at[k])))
    }
}

/// A number for three.
pub(crate) fn key(at: [u32; 3]) -> u64 {
    u64::from(at[0]) | u64::from(at[1]) << 21 | u64::from(at[2]) << 42
}
