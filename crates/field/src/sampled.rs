//! Fields of samples: a grid at a place.

use crate::field::FieldError;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::{Dimension, LARGE, SMALL};
use zeroset_number::Grid;

/// Samples of a field at the nodes of a grid that fills a box, interpolated between the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    grid: Arc<Grid>,
    bounds: Aabb,
    dimension: Dimension,
    slope: f64,
    source: Option<Source>,
}

/// What samples were made of: what a scene file says of them. Names of files are those that the scene calls them by.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A mesh.
    Mesh {
        /// Its file.
        file: String,
        /// Cells along the longest side.
        voxels: u32,
        /// How what is inside was found.
        sign: String,
    },
    /// A file of samples.
    Grid {
        /// Its file.
        file: String,
    },
    /// An image, as a plane shape.
    Image {
        /// Its file.
        file: String,
        /// How wide it is, scene units.
        width: f64,
        /// The brightness that parts inside from outside.
        level: f64,
    },
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
        let mut sampled = Sampled {
            grid,
            bounds,
            dimension: Dimension::Three,
            slope: 0.0,
            source: None,
        };
        sampled.slope = sampled.measured();
        Ok(sampled)
    }

    /// A plane shape: a grid of two layers that are the same, whose first node is the smallest corner of a rectangle and whose last
    /// node is the largest.
    ///
    /// # Errors
    /// A rectangle with a side that is too short or too long, layers that differ.
    pub fn plane(grid: Arc<Grid>, min: [f64; 2], max: [f64; 2]) -> Result<Sampled, FieldError> {
        let (below, above) = grid.values().split_at(grid.values().len() / 2);
        if grid.nodes()[2] != 2 || below != above {
            return Err(FieldError::Unfit {
                entry: "grid",
                reason: "a plane shape is the same for every z: its grid has two equal layers"
                    .into(),
            });
        }
        let bounds = Aabb {
            min: [min[0], min[1], -LARGE],
            max: [max[0], max[1], LARGE],
        };
        let sampled = Sampled::new(grid, bounds)?;
        Ok(Sampled {
            dimension: Dimension::Two,
            ..sampled
        })
    }

    /// With what a scene file says of it: without, a scene with it cannot be written.
    #[must_use]
    pub fn with_source(self, source: Source) -> Sampled {
        let source = Some(source);
        Sampled { source, ..self }
    }

    /// What it was made of, as far as a scene file says so.
    pub fn source(&self) -> Option<&Source> {
        self.source.as_ref()
    }

    /// The plane or space.
    pub fn dimension(&self) -> Dimension {
        self.dimension
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

    /// A Lipschitz constant of what is interpolated, measured: the largest over all corners of all cells of the norm of the slopes
    /// along the three edges there. (The square of a trilinear function's gradient is convex along each axis, so that it is largest
    /// at a corner.) For samples of a distance it is between 1 and the root of 3.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    fn measured(&self) -> f64 {
        let (values, density) = (self.grid.values(), self.density());
        let nodes = self.grid.nodes();
        let [nx, ny, nz] = [nodes[0] as usize, nodes[1] as usize, nodes[2] as usize];
        let mut most = 0.0_f64;
        for k in 0..nz {
            for j in 0..ny {
                let row = nx * (j + ny * k);
                for i in 0..nx {
                    let at = row + i;
                    let here = values[at];
                    // a corner of up to eight cells: the steeper one of both edges along each axis
                    let steeper = |place: usize, count: usize, stride: usize| {
                        let mut most = 0.0_f32;
                        if place > 0 {
                            most = (here - values[at - stride]).abs();
                        }
                        if place + 1 < count {
                            most = most.max((here - values[at + stride]).abs());
                        }
                        f64::from(most)
                    };
                    let x = steeper(i, nx, 1) * density[0];
                    let y = steeper(j, ny, nx) * density[1];
                    let z = steeper(k, nz, nx * ny) * density[2];
                    most = most.max(x * x + y * y + z * z);
                }
            }
        }
        most.sqrt()
    }
}
