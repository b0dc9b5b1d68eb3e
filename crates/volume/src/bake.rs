//! Meshes as signed distances on a grid.

use crate::check::{self, Check};
use crate::crossing;
use crate::mesh::{Mesh, v};
use crate::nearest::{self, Lattice, NODES, Nearest, TILE};
use crate::volume::{Volume, VolumeError};
use crate::winding::Winding;
use fearless_simd::Level;
use rayon::prelude::*;

/// How it is found whether a place is inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sign {
    /// Parity where every edge has an even number of faces and no part crosses another, else the winding number.
    #[default]
    Auto,
    /// Inside is what a ray from outside enters once more than it leaves, or three times: shells within shells are hollow, and it
    /// does not matter which way faces run. Holes of the mesh are closed by cones.
    Parity,
    /// Inside is where the generalised winding number is above 1/2 (Jacobson et al. 2013): parts that overlap are one, and
    /// holes are closed as smoothly as a soap film.
    Winding,
}

/// How a mesh becomes a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bake {
    /// Cells along the longest side, margins included; 8 to 2047.
    pub voxels: u32,
    /// Cells around the mesh, 1 or more.
    pub margin: u32,
    /// What is inside.
    pub sign: Sign,
    /// Cells from the surface beyond which distances end, for files; a scene wants them all.
    pub band: Option<f64>,
}

impl Default for Bake {
    fn default() -> Self {
        Bake {
            voxels: 64,
            margin: 2,
            sign: Sign::Auto,
            band: None,
        }
    }
}

/// Why a mesh does not become a grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BakeError {
    /// Too few or too many cells.
    #[error("{given} voxels along the longest side: allowed are {least} to {most}", least = Bake::LEAST, most = Bake::MOST)]
    Voxels {
        /// What was given.
        given: u32,
    },
    /// A mesh so small that single precision does not tell its voxels apart.
    #[error("its longest side is {size}, at {at}: too small there to tell its voxels apart")]
    Small {
        /// The longest side.
        size: f64,
        /// Its largest coordinate.
        at: f64,
    },
    /// The watcher ended it.
    #[error("sampling was stopped")]
    Stopped,
    /// What came out is no volume.
    #[error(transparent)]
    Volume(#[from] VolumeError),
}

/// Looks on while something takes long, and may end it.
pub trait Watch: Sync {
    /// So much of all is done, 0 to 1.
    fn advance(&self, _share: f64) {}
    /// Whether to stop.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Nobody looks on.
#[derive(Clone, Copy, Debug)]
pub struct Alone;

impl Watch for Alone {}

impl Bake {
    /// The fewest cells along the longest side.
    pub const LEAST: u32 = 8;
    /// The most.
    pub const MOST: u32 = zeroset_number::Grid::MOST - 1;

    /// The nodes along each axis of the grid for a mesh within these corners: known before anything is allocated.
    ///
    /// # Errors
    /// Too few or too many voxels, a mesh that is too small for where it is.
    pub fn nodes(&self, bounds: [[f32; 3]; 2]) -> Result<[u32; 3], BakeError> {
        Ok(self.lattice(bounds)?.nodes.map(|n| n as u32))
    }

    fn lattice(&self, [low, high]: [[f32; 3]; 2]) -> Result<Lattice, BakeError> {
        let given = self.voxels;
        let margin = self.margin.max(1);
        if !(Bake::LEAST..=Bake::MOST).contains(&given) || given <= 2 * margin {
            return Err(BakeError::Voxels { given });
        }
        let sides = [0, 1, 2].map(|k| f64::from(high[k]) - f64::from(low[k]));
        let size = sides.iter().fold(0.0_f64, |a, b| a.max(*b));
        let at = (low.iter().chain(&high)).fold(0.0_f64, |a, x| a.max(f64::from(x.abs())));
        let step = size / f64::from(given - 2 * margin);
        // a scene's coordinates are of single precision
        if !(step > 64.0 * f64::from(f32::EPSILON) * at && step > 1e-8) {
            return Err(BakeError::Small { size, at });
        }
        let nodes =
            sides.map(|s| (s / step - 1e-9).ceil().max(0.0) as usize + 2 * margin as usize + 1);
        let origin = [0, 1, 2].map(|k| {
            let middle = 0.5 * (f64::from(low[k]) + f64::from(high[k]));
            middle - 0.5 * step * (nodes[k] - 1) as f64
        });
        Ok(Lattice {
            nodes,
            origin,
            step,
        })
    }

    /// Signed distances at the nodes of a grid around a mesh, negative inside; on all cores. `check` is what [`check::mend`]
    /// found.
    ///
    /// Distances are those of the nearest place of the mesh, rounded to single precision; which face that is on is found in single
    /// precision of the mesh's size. Where a hole was closed, the lid counts as surface.
    ///
    /// # Errors
    /// Voxels that do not fit, or the watcher stopped it.
    pub fn bake(&self, mesh: &Mesh, check: &Check, watch: &dyn Watch) -> Result<Volume, BakeError> {
        let lattice = self.lattice(mesh.bounds())?;
        let band = self
            .band
            .map_or(f32::MAX, |cells| (cells.max(1.0) * lattice.step) as f32);
        let faces: Vec<[[f64; 3]; 3]> =
            (0..mesh.faces().len()).map(|i| mesh.corners64(i)).collect();
        let mut values = vec![band; lattice.count()];
        unsigned(
            &Nearest::new(&faces),
            &lattice,
            &mut values,
            watch,
            [0.0, 0.9],
        )?;
        let parity = match self.sign {
            Sign::Parity => true,
            Sign::Winding => false,
            Sign::Auto => check.watertight && (check.parts == 1 || !check::crosses(mesh)),
        };
        let cones: Vec<[[f64; 3]; 3]> = (check::rims(mesh).iter())
            .flat_map(|rim| {
                let tip = check::tip(mesh, rim);
                let at = |i: u32| mesh.points()[i as usize].map(f64::from);
                rim.iter()
                    .map(move |[a, b]| [at(*a), at(*b), tip])
                    .collect::<Vec<_>>()
            })
            .collect();
        let signs = Signs {
            lattice: &lattice,
            faces: &faces,
            cones: &cones,
            // cones are the lids themselves where parity counts
            open: if parity {
                Winding::NONE
            } else {
                Winding::new(cones.clone())
            },
            parity,
        };
        if cones.is_empty() {
            signs.closed(&mut values, watch)?;
        } else {
            let numbers = signs.numbers(watch)?;
            let lids = lids(&lattice, &values, &numbers);
            if !lids.is_empty() {
                unsigned(
                    &Nearest::new(&lids),
                    &lattice,
                    &mut values,
                    watch,
                    [0.95, 1.0],
                )?;
            }
            for (value, number) in values.iter_mut().zip(&numbers) {
                *value = if *number > 0.5 { -*value } else { *value };
            }
        }
        watch.advance(1.0);
        Ok(Volume::new(
            lattice.nodes.map(|n| n as u32),
            lattice.origin,
            [lattice.step; 3],
            values,
        )?
        .with_background(self.band.map(|_| band)))
    }
}

/// A field's values at the nodes of a grid around a box, on all cores: `make` makes what finds them for some points, once a layer.
///
/// # Errors
/// Voxels that do not fit, values that are no numbers, or the watcher stopped it.
pub fn sample<E: FnMut(&[[f32; 3]], &mut [f32])>(
    bake: &Bake,
    bounds: [[f32; 3]; 2],
    watch: &dyn Watch,
    make: impl Fn() -> E + Sync,
) -> Result<Volume, BakeError> {
    let lattice = bake.lattice(bounds)?;
    let [nx, ny, nz] = lattice.nodes;
    let band = (bake.band).map_or(f32::MAX, |cells| (cells.max(1.0) * lattice.step) as f32);
    let mut values = vec![0.0_f32; lattice.count()];
    let done = std::sync::atomic::AtomicUsize::new(0);
    values
        .par_chunks_mut(nx * ny)
        .enumerate()
        .try_for_each(|(k, layer)| {
            if watch.is_stopped() {
                return Err(BakeError::Stopped);
            }
            let points: Vec<[f32; 3]> = (0..nx * ny)
                .map(|i| lattice.at([i % nx, i / nx, k]).map(|x| x as f32))
                .collect();
            make()(&points, layer);
            for x in layer.iter_mut() {
                *x = x.clamp(-band, band);
            }
            let before = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            watch.advance((before + 1) as f64 / nz as f64);
            Ok(())
        })?;
    Ok(Volume::new(
        lattice.nodes.map(|n| n as u32),
        lattice.origin,
        [lattice.step; 3],
        values,
    )?
    .with_background(bake.band.map(|_| band)))
}

/// Distances without a sign: the smaller of what is in `values` and what is nearest. `share` is the part of all work that this is.
pub(crate) fn unsigned(
    nearest: &Nearest,
    lattice: &Lattice,
    values: &mut [f32],
    watch: &dyn Watch,
    share: [f64; 2],
) -> Result<(), BakeError> {
    let level = Level::new();
    let [nx, ny, nz] = lattice.nodes;
    let [tx, ty, tz] = lattice.tiles();
    for (slab, part) in values.chunks_mut(nx * ny * TILE).enumerate() {
        if watch.is_stopped() {
            return Err(BakeError::Stopped);
        }
        let known = &*part;
        let tiles: Vec<[f32; NODES]> = (0..tx * ty)
            .into_par_iter()
            .map(|tile| {
                let tile = slab * tx * ty + tile;
                let mut found = [f32::MAX; NODES];
                each(lattice, tile, |global, local| found[local] = known[global]);
                zeroset_number::at_level!(level, s => nearest.tile(s, lattice, tile, &mut found));
                found
            })
            .collect();
        for (tile, found) in tiles.iter().enumerate() {
            each(lattice, slab * tx * ty + tile, |global, local| {
                part[global] = found[local];
            });
        }
        let done = (slab + 1) as f64 / tz as f64;
        watch.advance(share[0] + (share[1] - share[0]) * done);
    }
    debug_assert_eq!(values.len(), nx * ny * nz);
    Ok(())
}

/// The nodes of a tile: their places in their slab of tiles, and in the tile.
fn each(lattice: &Lattice, tile: usize, mut f: impl FnMut(usize, usize)) {
    let [nx, ny, _] = lattice.nodes;
    let [x, y, z] = lattice.tile(tile);
    for (k, _) in z.enumerate() {
        for (j, row) in y.clone().enumerate() {
            for (i, column) in x.clone().enumerate() {
                f(column + nx * (row + ny * k), nearest::index([i, j, k]));
            }
        }
    }
}

struct Signs<'a> {
    lattice: &'a Lattice,
    faces: &'a [[[f64; 3]; 3]],
    cones: &'a [[[f64; 3]; 3]],
    open: Winding,
    parity: bool,
}

impl Signs<'_> {
    fn layer(&self) -> usize {
        self.lattice.nodes[0] * self.lattice.nodes[1]
    }

    fn counted(&self, slab: usize) -> Vec<i32> {
        let first = slab * TILE;
        let last = (first + TILE).min(self.lattice.nodes[2]);
        crossing::count(&[self.faces, self.cones], self.lattice, first..last)
    }

    /// Of a mesh without holes: whole numbers, slab by slab.
    fn closed(&self, values: &mut [f32], watch: &dyn Watch) -> Result<(), BakeError> {
        values
            .par_chunks_mut(self.layer() * TILE)
            .enumerate()
            .try_for_each(|(slab, part)| {
                if watch.is_stopped() {
                    return Err(BakeError::Stopped);
                }
                for (value, number) in part.iter_mut().zip(self.counted(slab)) {
                    if if self.parity {
                        number % 2 != 0
                    } else {
                        number > 0
                    } {
                        *value = -*value;
                    }
                }
                Ok(())
            })
    }

    /// Of a mesh with holes: the winding number of every node; away from holes it is whole.
    fn numbers(&self, watch: &dyn Watch) -> Result<Vec<f32>, BakeError> {
        let lattice = self.lattice;
        let mut numbers = vec![0.0; lattice.count()];
        let [tx, ty, _] = lattice.tiles();
        numbers
            .par_chunks_mut(self.layer() * TILE)
            .enumerate()
            .try_for_each(|(slab, part)| {
                if watch.is_stopped() {
                    return Err(BakeError::Stopped);
                }
                let whole = self.counted(slab);
                if self.parity {
                    for (number, n) in part.iter_mut().zip(whole) {
                        *number = if n % 2 != 0 { 1.0 } else { 0.0 };
                    }
                    return Ok(());
                }
                for tile in slab * tx * ty..(slab + 1) * tx * ty {
                    self.tile(tile, &whole, part);
                }
                Ok(())
            })?;
        Ok(numbers)
    }

    /// The winding numbers of a tile: what crossings say, less what the cones add.
    fn tile(&self, tile: usize, whole: &[i32], part: &mut [f32]) {
        /// What the cones may add at most where it is left out: far from 1/2, so that lids are not moved by it.
        const LITTLE: f64 = 0.1;
        /// How far from 1/2 a number may be that is interpolated.
        const CLEAR: f64 = 0.2;
        let lattice = self.lattice;
        let ranges = lattice.tile(tile);
        let (low, high) = (
            lattice.at([0, 1, 2].map(|k| ranges[k].start)),
            lattice.at([0, 1, 2].map(|k| ranges[k].end - 1)),
        );
        let centre = v::scale(v::add(low, high), 0.5);
        let radius = 0.5 * v::length(v::sub(high, low));
        if self.open.most(centre, radius) <= LITTLE {
            each(lattice, tile, |at, _| part[at] = whole[at] as f32);
            return;
        }
        // away from the cones their number is harmonic: what lies between 27 places of the tile is known well enough to tell
        // the side of 1/2 where it is clear
        let smooth = self
            .open
            .is_away(centre, radius + lattice.step * TILE as f64);
        let knots: Option<[f64; 27]> = smooth.then(|| {
            std::array::from_fn(|i| {
                let share = [i % 3, i / 3 % 3, i / 9].map(|n| 0.5 * n as f64);
                self.open
                    .number([0, 1, 2].map(|k| low[k] + share[k] * (high[k] - low[k])))
            })
        });
        let [nx, ny, _] = lattice.nodes;
        let first = ranges[2].start;
        each(lattice, tile, |at, _| {
            let node = [at % nx, at / nx % ny, first + at / (nx * ny)];
            let p = lattice.at(node);
            let about = knots.as_ref().map(|knots| {
                let share = [0, 1, 2].map(|k| {
                    let side = high[k] - low[k];
                    if side > 0.0 {
                        (p[k] - low[k]) / side
                    } else {
                        0.0
                    }
                });
                f64::from(whole[at]) - between(knots, share)
            });
            part[at] = match about {
                Some(number) if (number - 0.5).abs() > CLEAR => number,
                _ => f64::from(whole[at]) - self.open.number(p),
            } as f32;
        });
    }
}

/// The quadratic function through 3x3x3 values at 0, 1/2 and 1, x fastest.
fn between(knots: &[f64; 27], at: [f64; 3]) -> f64 {
    let weights = |t: f64| {
        let (low, high) = (2.0 * t - 1.0, t - 1.0);
        [low * high, -4.0 * t * high, t * low]
    };
    let (x, y, z) = (weights(at[0]), weights(at[1]), weights(at[2]));
    let mut sum = 0.0;
    for (i, knot) in knots.iter().enumerate() {
        sum += knot * x[i % 3] * y[i / 3 % 3] * z[i / 9];
    }
    sum
}

/// Where the sign changes between neighbours though the mesh is too far from both to be between them: places of the lids that close
/// holes. With them the distances are those of the surface that the signs show, and no steeper than one.
fn lids(lattice: &Lattice, values: &[f32], numbers: &[f32]) -> Vec<[[f64; 3]; 3]> {
    let [nx, ny, nz] = lattice.nodes;
    let strides = [1, nx, nx * ny];
    let mut out = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let node = [i, j, k];
                let a = i + nx * (j + ny * k);
                for axis in 0..3 {
                    if node[axis] + 1 >= lattice.nodes[axis] {
                        continue;
                    }
                    let b = a + strides[axis];
                    let (m, n) = (numbers[a], numbers[b]);
                    let apart = f64::from(values[a]) + f64::from(values[b]);
                    if (m > 0.5) == (n > 0.5) || apart <= lattice.step * (1.0 + 1e-6) {
                        continue;
                    }
                    let share = f64::from(((m - 0.5) / (m - n)).clamp(0.02, 0.98));
                    let mut p = lattice.at(node);
                    p[axis] += share * lattice.step;
                    out.push([p; 3]);
                }
            }
        }
    }
    out
}
