//! Fields of samples: a grid at a place.

use crate::field::FieldError;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_number::Grid;

/// Samples of a field at the nodes of a grid that fills a box, interpolated between the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    grid: Arc<Grid>,
    bounds: Aabb,
}

impl Sampled {
    /// A grid whose first node is the smallest corner of a box and whose last node is the largest.
    ///
    /// # Errors
    /// A box with a side that is too short or too long.
    pub fn new(grid: Arc<Grid>, bounds: Aabb) -> Result<Sampled, FieldError> {
        for k in 0..3 {
            let (low, high) = (bounds.min[k], bounds.max[k]);
            // also refuses NaN
            if !(-LARGE <= low && high <= LARGE && high - low >= SMALL) {
                return Err(FieldError::Unfit {
                    entry: "grid",
                    reason: format!(
                        "its box goes from {low} to {high} along an axis: allowed are -1e9 to 1e9 and sides of 1e-9 at least"
                    ),
                });
            }
        }
        Ok(Sampled { grid, bounds })
    }

    /// The samples.
    pub fn grid(&self) -> &Arc<Grid> {
        &self.grid
    }

    /// The box that they fill.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Nodes a scene unit along each axis.
    pub fn density(&self) -> [f64; 3] {
        let (nodes, half) = (self.grid.nodes(), self.bounds.half());
        std::array::from_fn(|k| f64::from(nodes[k] - 1) / (2.0 * half[k]))
    }

    /// A Lipschitz constant of what is interpolated: along each axis a trilinear function is no steeper than the steepest
    /// difference between neighbours.
    pub fn slope(&self) -> f64 {
        let (steepest, density) = (self.grid.steepest(), self.density());
        let square: f64 = (0..3)
            .map(|k| (f64::from(steepest[k]) * density[k]).powi(2))
            .sum();
        square.sqrt()
    }
}
