//! Samples of a field on a grid, as files hold them and scenes take them.

use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::FieldError;
use zeroset_field::sampled::Sampled;
use zeroset_number::{Grid, GridError};

/// Samples at the nodes of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    nodes: [u32; 3],
    origin: [f64; 3],
    step: [f64; 3],
    values: Vec<f32>,
    background: Option<f32>,
    name: String,
}

/// Why samples make no volume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum VolumeError {
    /// Nodes or samples that make no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A place or a distance between nodes that is none.
    #[error(
        "its nodes are {step:?} apart from {origin:?} on: distances must be above 0 and all within ±1e9"
    )]
    Place {
        /// The first node.
        origin: [f64; 3],
        /// From one to the next, along each axis.
        step: [f64; 3],
    },
    /// A box that a scene cannot hold.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl Volume {
    /// Samples at nodes, x fastest: the first node is at `origin`, the next one along each axis `step` from it.
    ///
    /// # Errors
    /// Too few or too many nodes, another number of samples than nodes, samples that are not finite, nodes that are nowhere.
    pub fn new(
        nodes: [u32; 3],
        origin: [f64; 3],
        step: [f64; 3],
        values: Vec<f32>,
    ) -> Result<Volume, VolumeError> {
        let held = (0..3).all(|k| {
            let far = origin[k] + step[k] * f64::from(nodes[k]);
            step[k] > 0.0 && origin[k].abs() <= 1e9 && far.abs() <= 1e9
        });
        if !held {
            return Err(VolumeError::Place { origin, step });
        }
        if !nodes.iter().all(|n| (2..=Grid::MOST).contains(n)) {
            return Err(GridError::Nodes { nodes }.into());
        }
        let count = nodes.iter().map(|n| *n as usize).product();
        if values.len() != count {
            let values = values.len();
            return Err(GridError::Count {
                nodes: count,
                values,
            }
            .into());
        }
        if let Some(at) = values.iter().position(|x| !x.is_finite()) {
            let value = values[at];
            return Err(GridError::Value { at, value }.into());
        }
        Ok(Volume {
            nodes,
            origin,
            step,
            values,
            background: None,
            name: "distance".into(),
        })
    }

    /// With a narrow band: nothing is farther from the surface than this, and what is as far has no distance. `None` where all
    /// samples count.
    #[must_use]
    pub fn with_background(self, background: Option<f32>) -> Volume {
        Volume { background, ..self }
    }

    /// With a name, which files keep.
    #[must_use]
    pub fn with_name(self, name: impl Into<String>) -> Volume {
        let name = name.into();
        Volume { name, ..self }
    }

    /// Nodes along each axis.
    pub fn nodes(&self) -> [u32; 3] {
        self.nodes
    }

    /// Where the first node is.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// How far each node is from the next, along each axis.
    pub fn step(&self) -> [f64; 3] {
        self.step
    }

    /// The samples, x fastest.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The half width of a narrow band.
    pub fn background(&self) -> Option<f32> {
        self.background
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where a node is.
    pub fn at(&self, node: [u32; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.origin[k] + self.step[k] * f64::from(node[k]))
    }

    /// As a leaf of field trees.
    ///
    /// # Errors
    /// A box that is too small or too large for scenes.
    pub fn into_sampled(self) -> Result<Sampled, VolumeError> {
        let last = self.at(self.nodes.map(|n| n - 1));
        let bounds = Aabb {
            min: self.origin,
            max: last,
        };
        let grid = Grid::new(self.nodes, self.values)?;
        Ok(Sampled::new(Arc::new(grid), bounds)?)
    }
}
