//! What formulas read beside the point they are given: numbers, and samples on grids.

use super::interval::Interval;
use std::sync::{Arc, OnceLock};

/// The data of a program: its parameters and its grids.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Data {
    /// Parameters: what sliders, placements and sizes come down to.
    pub params: Vec<f32>,
    /// Grids, by number.
    pub grids: Vec<Arc<Grid>>,
}

impl From<Vec<f32>> for Data {
    fn from(params: Vec<f32>) -> Self {
        Data {
            params,
            grids: Vec::new(),
        }
    }
}

impl From<&[f32]> for Data {
    fn from(params: &[f32]) -> Self {
        params.to_vec().into()
    }
}

/// Why samples make no grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// An axis has too few nodes to interpolate between, or too many for a GPU.
    #[error("a grid of {}x{}x{} nodes: every axis takes 2 to {most}", .nodes[0], .nodes[1], .nodes[2], most = Grid::MOST)]
    Nodes {
        /// Nodes along x, y and z.
        nodes: [u32; 3],
    },
    /// Not one sample a node.
    #[error("a grid of {nodes} nodes has {values} samples")]
    Count {
        /// Nodes.
        nodes: usize,
        /// Samples.
        values: usize,
    },
    /// A sample that is no finite number.
    #[error("sample {at} of a grid is {value}: samples must be finite numbers")]
    Value {
        /// Its place.
        at: usize,
        /// What it is.
        value: f32,
    },
}

/// Samples of a field at the nodes of a box, x fastest. Between the nodes a formula interpolates (`Args::sample`); a node is
/// one unit from the next here, whatever the field's voxels measure.
#[derive(Debug)]
pub struct Grid {
    nodes: [u32; 3],
    values: Vec<f32>,
    steepest: OnceLock<[f32; 3]>,
    /// Ranges over blocks of 2, 4, 8, ... nodes a side, for questions about many nodes.
    ranges: OnceLock<Vec<Ranges>>,
}

impl PartialEq for Grid {
    fn eq(&self, other: &Grid) -> bool {
        self.nodes == other.nodes && self.values == other.values
    }
}

/// Ranges over the blocks of a grid.
#[derive(Debug, PartialEq)]
struct Ranges {
    blocks: [u32; 3],
    ranges: Vec<[f32; 2]>,
}

impl Grid {
    /// The most nodes an axis may have: what every GPU takes as a texture.
    pub const MOST: u32 = 2048;

    /// A grid of these samples.
    ///
    /// # Errors
    /// Too few or too many nodes, another number of samples, samples that are not finite.
    pub fn new(nodes: [u32; 3], values: Vec<f32>) -> Result<Grid, GridError> {
        let grid = Grid::of_points(nodes, values)?;
        grid.steepest();
        grid.ranges();
        Ok(grid)
    }

    /// As [`Grid::new`], for a grid that is read at points alone: how steep it is and what ranges it has is not found before somebody asks.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn of_points(nodes: [u32; 3], values: Vec<f32>) -> Result<Grid, GridError> {
        if !nodes.iter().all(|n| (2..=Grid::MOST).contains(n)) {
            return Err(GridError::Nodes { nodes });
        }
        let count = nodes.iter().map(|n| *n as usize).product();
        if values.len() != count {
            let values = values.len();
            return Err(GridError::Count {
                nodes: count,
                values,
            });
        }
        if let Some(at) = values.iter().position(|v| !v.is_finite()) {
            let value = values[at];
            return Err(GridError::Value { at, value });
        }
        Ok(Grid {
            nodes,
            values,
            steepest: OnceLock::new(),
            ranges: OnceLock::new(),
        })
    }

    /// Nodes along x, y and z.
    pub fn nodes(&self) -> [u32; 3] {
        self.nodes
    }

    /// The samples, x fastest.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The largest difference between neighbours along x, y and z: what is interpolated is no steeper along that axis, since a
    /// derivative of a trilinear function lies between those along the edges of its cell.
    pub fn steepest(&self) -> [f32; 3] {
        let find = || [0, 1, 2].map(|axis| self.steepest_along(axis));
        *self.steepest.get_or_init(find)
    }

    fn ranges(&self) -> &[Ranges] {
        self.ranges.get_or_init(|| self.gather_ranges())
    }

    /// The sample at a node; coordinates beyond the grid count as its last ones.
    #[inline(always)]
    pub fn at(&self, node: [usize; 3]) -> f32 {
        // written out: closures of `array::map` are not inlined
        let nodes = [
            self.nodes[0] as usize,
            self.nodes[1] as usize,
            self.nodes[2] as usize,
        ];
        let i = node[0].min(nodes[0] - 1);
        let j = node[1].min(nodes[1] - 1);
        let k = node[2].min(nodes[2] - 1);
        self.values[i + nodes[0] * (j + nodes[1] * k)]
    }

    /// The samples at the eight corners of cells, x fastest, from the coordinates of their first nodes, one a lane. Scalar, and one function for
    /// all vectors: gathering takes no arithmetic that would be faster in SIMD, and what is inlined everywhere takes long to compile.
    #[inline(never)]
    pub(super) fn corners<const N: usize>(&self, first: [&[f32]; 3], out: &mut [[f32; N]; 8]) {
        let [nx, ny, nz] = self.nodes.map(|n| n as usize);
        let [x, y, z] = first;
        for (lane, ((x, y), z)) in x.iter().zip(y).zip(z).enumerate().take(N) {
            // not a number is 0
            let node = [*x as usize, *y as usize, *z as usize];
            let i = node[0].min(nx - 2);
            let j = node[1].min(ny - 2);
            let k = node[2].min(nz - 2);
            let near = &self.values[i + nx * (j + ny * k)..][..nx + 2];
            let far = &self.values[i + nx * (j + ny * (k + 1))..][..nx + 2];
            for (corner, from) in [0, 1, nx, nx + 1].into_iter().enumerate() {
                out[corner][lane] = near[from];
                out[4 + corner][lane] = far[from];
            }
        }
    }

    fn steepest_along(&self, axis: usize) -> f32 {
        let mut steepest = 0.0_f32;
        let [nx, ny, nz] = self.nodes.map(|n| n as usize);
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let mut next = [i, j, k];
                    next[axis] += 1;
                    steepest = steepest.max((self.at(next) - self.at([i, j, k])).abs());
                }
            }
        }
        steepest
    }

    fn gather_ranges(&self) -> Vec<Ranges> {
        let mut all = Vec::new();
        let mut below: Option<Ranges> = None;
        loop {
            let from = below.as_ref().map_or(self.nodes, |r| r.blocks);
            if from.iter().all(|n| *n <= 2) {
                break;
            }
            let blocks = from.map(|n| n.div_ceil(2));
            let mut ranges = Vec::new();
            for k in 0..blocks[2] {
                for j in 0..blocks[1] {
                    for i in 0..blocks[0] {
                        let first = [2 * i, 2 * j, 2 * k];
                        let last = [0, 1, 2].map(|axis| (first[axis] + 1).min(from[axis] - 1));
                        ranges.push(self.range_of(below.as_ref(), first, last));
                    }
                }
            }
            all.extend(below.replace(Ranges { blocks, ranges }));
        }
        all.extend(below);
        all
    }

    /// The range over blocks (or nodes, without any) `first` to `last`.
    fn range_of(&self, ranges: Option<&Ranges>, first: [u32; 3], last: [u32; 3]) -> [f32; 2] {
        let mut range = [f32::INFINITY, f32::NEG_INFINITY];
        for k in first[2]..=last[2] {
            for j in first[1]..=last[1] {
                for i in first[0]..=last[0] {
                    let [lo, hi] = match ranges {
                        Some(r) => r.ranges[(i + r.blocks[0] * (j + r.blocks[1] * k)) as usize],
                        None => [self.at([i, j, k].map(|n| n as usize)); 2],
                    };
                    range = [range[0].min(lo), range[1].max(hi)];
                }
            }
        }
        range
    }

    /// The range of all samples at the nodes in a box; what lies beyond the grid counts as its last nodes.
    pub(super) fn range(&self, node: [Interval; 3]) -> Interval {
        let held = |x: f64, axis: usize| x.clamp(0.0, f64::from(self.nodes[axis] - 1)) as u32;
        let mut first = [0, 1, 2].map(|axis| held(node[axis].lo.floor(), axis));
        let mut last = [0, 1, 2].map(|axis| held(node[axis].hi.ceil(), axis));
        // as few blocks as hold the box: four a side at most
        let mut ranges = self.ranges().iter();
        let mut level = None;
        while (0..3).any(|axis| last[axis] - first[axis] >= 4) {
            let Some(above) = ranges.next() else { break };
            level = Some(above);
            first = first.map(|n| n / 2);
            last = last.map(|n| n / 2);
        }
        let [lo, hi] = self.range_of(level, first, last);
        Interval::new(lo.into(), hi.into())
    }
}
