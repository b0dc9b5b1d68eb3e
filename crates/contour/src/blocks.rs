//! Where the surface may be: the blocks of the grid that are not known to be free of it, each with what is left of the program there.

use crate::ContourError;
use crate::grid::{BLOCK, Grid};
use crate::sampler::Sampler;
use crate::watch::Watch;
use rayon::prelude::*;
use std::sync::Arc;
use zeroset_catalogue::bounds::Exactness;
use zeroset_catalogue::tape::{Code, Tape};
use zeroset_eval::Pruner;
use zeroset_field::program::Program;
use zeroset_number::{SingleInterval, v3};

/// A value that is this much more than what a box reaches from its middle leaves no surface in it, whatever was rounded.
const BEYOND: f64 = 1.0001;

/// A block of cells.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Its number along each axis.
    pub(crate) at: [u32; 3],
    /// What finds values in it, its borders included: the same to the bit as the program does.
    pub(crate) code: Arc<Code>,
}

/// A cube of blocks.
struct Part {
    /// The first of its blocks.
    at: [u32; 3],
    code: Arc<Code>,
}

/// Finds the blocks in which the surface may be: an octree is cut where neither the value in the middle of a part, which is a bound on the
/// distance, nor the range of the values in it says that nothing is there.
pub(crate) fn find(
    program: &Program,
    grid: &Grid,
    most: u64,
    watch: &dyn Watch,
) -> Result<Vec<Block>, ContourError> {
    let blocks = grid.blocks();
    let mut side = blocks.into_iter().max().unwrap_or(1).next_power_of_two();
    let whole = Arc::new(program.values().code.clone());
    let mut parts = vec![Part {
        at: [0; 3],
        code: whole,
    }];
    let is_bound = program.exactness() != Exactness::Estimate;
    let prunes = zeroset_cells::can_be_pruned(program);
    while side > 1 {
        side /= 2;
        let find = |(sampler, pruner): &mut (Sampler<'_>, Pruner), part: &Part| {
            if watch.is_stopped() {
                return Vec::new();
            }
            let corners: Vec<[u32; 3]> = (0..8_u32)
                .map(|i| std::array::from_fn(|k| part.at[k] + side * (i >> k & 1)))
                .filter(|at: &[u32; 3]| (0..3).all(|k| at[k] < blocks[k]))
                .collect();
            let boxes: Vec<[[f32; 3]; 2]> = (corners.iter())
                .map(|at| [at.map(|n| n * BLOCK), at.map(|n| (n + side) * BLOCK)])
                .map(|ends| ends.map(|at| grid.node(at)))
                .collect();
            let middles: Vec<[f32; 3]> = (boxes.iter())
                .map(|[low, high]| std::array::from_fn(|k| 0.5 * (low[k] + high[k])))
                .collect();
            let mut values = vec![0.0; middles.len()];
            let tape = Tape {
                code: &part.code,
                data: program.data(),
            };
            sampler.values(tape, &middles, &mut values);
            let mut found = Vec::new();
            for (i, at) in corners.into_iter().enumerate() {
                let [low, high] = boxes[i];
                let reach = (0..3)
                    .map(|k| {
                        f64::from(high[k] - middles[i][k]).max(f64::from(middles[i][k] - low[k]))
                    })
                    .map(|r| r * r)
                    .sum::<f64>()
                    .sqrt();
                if is_bound && f64::from(values[i]).abs() > BEYOND * reach {
                    continue;
                }
                let mut code = Arc::clone(&part.code);
                if prunes {
                    let along = |k: usize| SingleInterval::new(low[k].into(), high[k].into());
                    let left = pruner.prune(tape, v3(along(0), along(1), along(2)));
                    if left.range.lo > 0.0 || left.range.hi < 0.0 {
                        continue;
                    }
                    if let Some(shorter) = left.code {
                        code = Arc::new(shorter);
                    }
                }
                found.push(Part { at, code });
            }
            found
        };
        let make = || (Sampler::new(program, None), Pruner::new());
        let found: Vec<Vec<Part>> = (parts.par_iter()).map_init(make, find).collect();
        parts = found.into_iter().flatten().collect();
        if watch.is_stopped() {
            return Err(ContourError::Stopped);
        }
        check(parts.len() as u64, most)?;
    }
    let block = |part: Part| Block {
        at: part.at,
        code: part.code,
    };
    Ok(parts.into_iter().map(block).collect())
}

/// Refuses more blocks than there may be.
pub(crate) fn check(blocks: u64, most: u64) -> Result<(), ContourError> {
    let cells = u64::from(BLOCK).pow(3);
    if blocks <= most {
        return Ok(());
    }
    Err(ContourError::Cells {
        given: blocks.saturating_mul(cells),
        most: most.saturating_mul(cells),
    })
}
