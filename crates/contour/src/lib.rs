//! Meshes of the zero sets of fields: closed, manifold, with their sharp edges.
//!
//! A [`Contour`] makes a [`Surface`] of a program: dual marching cubes (Nielson 2004) on those cells of a grid that the surface goes through,
//! with vertices on edges and in corners (Ju, Losasso, Schaefer and Warren 2002), and then as few faces as the tolerance allows.
//!
//! ```
//! use zeroset_contour::{Alone, Contour};
//! use zeroset_field::program::{Limits, Program};
//! use zeroset_field::shape::box3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let program = Program::compile(&box3([2.0, 1.0, 1.0]).field()?, &Limits::default())?;
//! let made = Contour::new(0.01).of(&program, &program.bounds(), &Alone)?;
//! let topology = made.surface.topology();
//! assert!(topology.watertight && topology.manifold);
//! assert_eq!((topology.parts, topology.euler), (1, 2));
//! assert_eq!(made.surface.points.len(), 8); // a box has its corners, and no more
//! assert!((made.surface.volume() - 2.0).abs() < 1e-4);
//! # Ok(())
//! # }
//! ```
//!
//! # How a mesh is made
//!
//! - `blocks` cuts an octree down to blocks of 8 x 8 x 8 cells, leaving out what the values in the middle of a part (programs never overestimate
//!   a distance) or the range of its values say is free of the surface. `sample` finds signs at nodes and places and normals on edges.
//! - `patch` says which crossings of a cell hang together, `surface` decides what faces leave open so that the mesh is manifold, whatever
//!   the signs are.
//! - `place` finds where the vertex of each patch lies. `surface` cuts the quads around edges along the better diagonal.
//! - `refine` splits edges whose middles are too far from the surface: grids see no edge that goes through a cell and crosses none of its edges.
//! - `measure` asks the field how far faces are from the surface. A [`Contour`] takes a grid of half the width where that is too much.
//! - `simplify` collapses edges while the field says that the faces are near enough.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod blocks;
mod grid;
mod measure;
mod normals;
mod patch;
mod place;
mod qef;
mod refine;
mod sample;
mod sampler;
mod simplify;
mod surface;
mod topology;
mod vector;
mod watch;

pub use topology::Topology;
pub use watch::{Alone, Watch};

use crate::grid::{BLOCK, Grid};
use crate::sampler::Sampler;
use crate::surface::Blocks;
use zeroset_catalogue::bounds::Aabb;
use zeroset_cells::Cells;
use zeroset_field::program::Program;

/// Triangles over shared vertices, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The vertices, scene units.
    pub points: Vec<[f32; 3]>,
    /// Three vertices a face.
    pub faces: Vec<[u32; 3]>,
}

impl Surface {
    /// How its faces hang together.
    pub fn topology(&self) -> Topology {
        Topology::of(self.points.len(), &self.faces)
    }

    /// What it encloses, cubic scene units.
    pub fn volume(&self) -> f64 {
        let six = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| vector::wide(self.points[v as usize]));
            vector::dot(a, vector::cross(b, c))
        };
        self.faces.iter().map(six).sum::<f64>() / 6.0
    }

    /// Its area, square scene units.
    pub fn area(&self) -> f64 {
        let twice = |face: &[u32; 3]| {
            let corners = face.map(|v| vector::wide(self.points[v as usize]));
            vector::length(surface::normal(corners))
        };
        self.faces.iter().map(twice).sum::<f64>() / 2.0
    }
}

impl Surface {
    /// The normals of the three corners of each face: the gradient of the field beside the corner, on this face's side of an edge. Corners at one
    /// vertex share theirs where they differ by less than 25 degrees.
    pub fn normals(&self, program: &Program) -> Vec<[[f32; 3]; 3]> {
        normals::normals(self, || Sampler::new(program, None))
    }
}

/// A box around the surface of a program, within one that holds all of the solid and may be much larger, as that of a formula: what is known
/// to be free of it, in steps of a sixteenth, is left out.
///
/// # Errors
/// A box without ends, or `watch` says to stop.
pub fn tightened(
    program: &Program,
    bounds: &Aabb,
    watch: &dyn Watch,
) -> Result<Aabb, ContourError> {
    let mut tight = *bounds;
    for _ in 0..TIGHTER {
        if tight.is_empty() {
            return Ok(tight);
        }
        if !tight.is_finite() {
            return Err(ContourError::Endless);
        }
        let step = size(&tight).max(1e-6) / f64::from(16 * BLOCK);
        let Some(grid) = Grid::new(&tight, step) else {
            return Ok(tight);
        };
        let found = blocks::find(program, &grid, u64::MAX, watch)?;
        let hull = found.iter().fold(Aabb::EMPTY, |hull, block| {
            let ends = [
                block.at.map(|n| n * BLOCK),
                block.at.map(|n| (n + 1) * BLOCK),
            ];
            let [min, max] = ends.map(|at| vector::wide(grid.node(at)));
            hull.hull(&Aabb::new(min, max))
        });
        tight = hull.intersect(&tight);
    }
    Ok(tight)
}

/// Times that a box is made smaller.
const TIGHTER: usize = 2;

/// What a contour may cost: checked before what it guards is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Cells that are looked at.
    pub cells: u64,
    /// Faces, before any are taken away.
    pub faces: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            cells: 64 << 20,
            faces: 8 << 20,
        }
    }
}

/// Cells along the longest side of a box, at least.
pub const LEAST: u32 = 4;
/// And at most.
pub const MOST: u32 = 8192;

/// How a surface becomes a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contour {
    /// How far the faces may be from the surface, scene units.
    pub tolerance: f64,
    /// Cells along the longest side of the box, [`LEAST`] to [`MOST`]. Parts of the solid that are thinner than a cell may be missed.
    pub resolution: u32,
    /// The resolution is doubled up to this while the faces are farther from the surface than the tolerance.
    pub finest: u32,
    /// Whether the faces of the grid are changed by what the tolerance asks for: cut where they are too far from the surface, and taken away where
    /// fewer are near enough.
    pub simplify: bool,
    /// What it may cost.
    pub limits: Limits,
}

/// A mesh, and how near it is to the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Contoured {
    /// The mesh.
    pub surface: Surface,
    /// Cells along the longest side of the box.
    pub resolution: u32,
    /// Width of a cell, scene units.
    pub step: f64,
    /// Faces of the grid, before any were cut or taken away.
    pub faces_before: usize,
    /// The largest distance of a point of its faces from the surface that was found, as far as value and gradient of the field tell
    /// (`|f| / |grad f|`, Taubin 1994), scene units. Measured, not proven: at points half a cell apart, or a twelfth of a face.
    pub deviation: f64,
}

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContourError {
    /// No box around all of the solid.
    #[error("the solid has no ends: a mesh needs a box around all of it")]
    Endless,
    /// Nothing is there.
    #[error("there is no surface: the field is {} everywhere", if *.inside { "negative" } else { "positive" })]
    Empty {
        /// Whether all is inside.
        inside: bool,
    },
    /// The solid is not within the box that its field states.
    #[error("the solid goes on beyond the box that its field states: a bound in it is wrong")]
    Leaves,
    /// A tolerance or a resolution that cannot be.
    #[error("the {what} is {given}: {allowed}")]
    Setting {
        /// Which.
        what: &'static str,
        /// What was given.
        given: f64,
        /// What is allowed.
        allowed: String,
    },
    /// Cells too small for the numbers that places are.
    #[error(
        "cells of {step:e} are too small for single precision this far from the origin: ask for a lower resolution, or move the solid to the \
         origin"
    )]
    Fine {
        /// Their width.
        step: f64,
    },
    /// Too many cells.
    #[error(
        "the surface is in {given} cells of the grid, at most {most} are allowed: ask for a lower resolution or a larger tolerance"
    )]
    Cells {
        /// How many there would be.
        given: u64,
        /// Allowed.
        most: u64,
    },
    /// Too many faces.
    #[error(
        "the mesh would have about {given} faces, at most {most} are allowed: ask for a lower resolution or a larger tolerance"
    )]
    Faces {
        /// How many there would be.
        given: u64,
        /// Allowed.
        most: u64,
    },
    /// It was asked to stop.
    #[error("it was stopped")]
    Stopped,
}

/// Cells that a resolution by a tolerance begins with: so many tolerances make a cell, so that what bends as little as the solid as a whole is
/// near enough at once.
const TOLERANCES: f64 = 8.0;

impl Contour {
    /// With this tolerance, for a solid about a scene unit large. [`Contour::fitting`] fits any.
    pub fn new(tolerance: f64) -> Contour {
        Contour {
            tolerance,
            resolution: 64,
            finest: 256,
            simplify: true,
            limits: Limits::default(),
        }
    }

    /// With this tolerance, for what is in a box: with cells of a few tolerances, from 64 to 512 along its longest side, and a half and a quarter as
    /// wide where that is not near enough.
    pub fn fitting(tolerance: f64, bounds: &Aabb) -> Contour {
        let size = size(bounds);
        let cells = (size / (TOLERANCES * tolerance)).clamp(64.0, 512.0);
        Contour {
            resolution: cells as u32,
            finest: 4 * cells as u32,
            ..Contour::new(tolerance)
        }
    }

    fn check(&self) -> Result<(), ContourError> {
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return Err(ContourError::Setting {
                what: "tolerance",
                given: self.tolerance,
                allowed: "it must be a length above 0".into(),
            });
        }
        if !(LEAST..=MOST).contains(&self.resolution) {
            return Err(ContourError::Setting {
                what: "resolution",
                given: self.resolution.into(),
                allowed: format!("it goes from {LEAST} to {MOST}"),
            });
        }
        Ok(())
    }

    /// The mesh of a program's surface within a box that holds all of its solid.
    ///
    /// # Errors
    /// A box without ends, no surface, a tolerance or a resolution that cannot be, more than the limits allow, or `watch` says to stop.
    pub fn of(
        &self,
        program: &Program,
        bounds: &Aabb,
        watch: &dyn Watch,
    ) -> Result<Contoured, ContourError> {
        self.check()?;
        if bounds.is_empty() {
            return Err(ContourError::Empty { inside: false });
        }
        if !bounds.is_finite() {
            return Err(ContourError::Endless);
        }
        let size = size(bounds).max(1e-6);
        let cells = Cells::new(program, *bounds);
        let cells = cells.as_ref();
        let mut resolution = self.resolution;
        let mut best: Option<Contoured> = None;
        loop {
            let step = size / f64::from(resolution);
            let made = self.at(program, cells, bounds, step, watch);
            let surface = match (made, &best) {
                (Ok(surface), _) => surface,
                // as near as the limits allow
                (
                    Err(
                        ContourError::Cells { .. }
                        | ContourError::Faces { .. }
                        | ContourError::Fine { .. },
                    ),
                    Some(_),
                ) => break,
                (Err(error), _) => return Err(error),
            };
            let make = || Sampler::new(program, cells);
            let faces_before = surface.faces.len();
            let surface = match self.simplify {
                true => refine::refine(surface, self.tolerance, self.limits.faces, make, watch),
                false => Some(surface),
            };
            let surface = surface.ok_or(ContourError::Stopped)?;
            let deviation = measure::farthest(&surface, step, make);
            let is_better = best.as_ref().is_none_or(|b| deviation < b.deviation);
            if is_better {
                best = Some(Contoured {
                    resolution,
                    step,
                    faces_before,
                    deviation,
                    surface,
                });
            }
            if deviation <= self.tolerance || 2 * resolution > self.finest.min(MOST) {
                break;
            }
            resolution *= 2;
        }
        let mut best = best.ok_or(ContourError::Empty { inside: false })?;
        if self.simplify {
            let sampler = Sampler::new(program, cells);
            let surface = std::mem::take(&mut best.surface);
            best.surface = simplify::simplify(surface, self.tolerance, best.step, sampler, watch)
                .ok_or(ContourError::Stopped)?;
        }
        best.deviation = measure::farthest(&best.surface, 0.5 * best.step, || {
            Sampler::new(program, cells)
        });
        Ok(best)
    }

    /// With cells of one width.
    fn at(
        &self,
        program: &Program,
        cells: Option<&Cells>,
        bounds: &Aabb,
        step: f64,
        watch: &dyn Watch,
    ) -> Result<Surface, ContourError> {
        let grid = Grid::new(bounds, step).ok_or(ContourError::Fine { step })?;
        let most = self.limits.cells / u64::from(BLOCK).pow(3);
        let found = blocks::find(program, &grid, most, watch)?;
        let blocks = Blocks::new(program, cells, &grid, found, most, watch)?;
        let surface = blocks.surface(self.limits.faces, watch)?;
        if surface.faces.is_empty() {
            let mut value = [0.0];
            let middle = bounds.centre().map(|c| c as f32);
            Sampler::new(program, cells).whole_values(&[middle], &mut value);
            return Err(ContourError::Empty {
                inside: value[0] < 0.0,
            });
        }
        Ok(surface)
    }
}

/// The longest side of a box.
fn size(bounds: &Aabb) -> f64 {
    2.0 * bounds.half().into_iter().fold(0.0, f64::max)
}
