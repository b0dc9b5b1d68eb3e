//! Volumes of scenes whose objects move: each writes its distances where it is, and of all the least counts (Evans 2006, 9.8).
//!
//! A [`SceneVolume`] lies in bricks of 8 by 8 by 8 nodes. A body counts in those that its oriented box comes near, and what a brick holds follows from the
//! bodies there alone. So a new frame writes the bricks anew that a body left, moved in, or came to, on all cores, and has the same bits as one
//! that is composed from scratch.
//!
//! ```
//! use zeroset_volume::compose::{Body, Lattice, Pose, SceneVolume, Shape};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let lattice = Lattice { nodes: [33; 3], origin: [-1.0; 3], voxel: 1.0 / 16.0 };
//! let mut volume = SceneVolume::new(lattice, 0.5)?;
//! let ball = |x: f32| Body::new(Shape::Ellipsoid { radii: [0.3; 3] }, Pose::at([x, 0.0, 0.0]), [1.0, 0.0, 0.0]);
//! volume.compose(&[ball(0.0)?])?;
//! assert!((volume.at([16, 16, 16]) + 0.3).abs() < 1e-3);
//! let touched = volume.compose(&[ball(0.1)?])?;
//! assert!(touched < volume.bricks());
//! # Ok(())
//! # }
//! ```

mod body;
mod maps;

pub use body::{Body, BodyError, LocalGrid, Pose, Shape};
pub use maps::{Bottom, Heights, Star};

use fearless_simd::{Level, Simd, prelude::*};
use rayon::prelude::*;
use zeroset_number::{Data, Lanes, Ops, Real, at_level, v3};

/// Nodes of a brick along each axis.
const SIDE: usize = 8;
/// Nodes of a brick.
const BRICK: usize = SIDE * SIDE * SIDE;
/// The number of no body, in [`SceneVolume::nearest`].
pub const NOBODY: u16 = u16::MAX;

/// Nodes in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Nodes along x, y and z.
    pub nodes: [usize; 3],
    /// The first of them.
    pub origin: [f32; 3],
    /// From one to the next.
    pub voxel: f32,
}

/// Why there is no such volume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ComposeError {
    /// Too few or too many nodes.
    #[error("a volume of {0:?} nodes: allowed are 2 to 1024 along each axis")]
    Nodes([usize; 3]),
    /// A length or a place that is none.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// More bodies than can be numbered.
    #[error("{0} bodies: allowed are 65534")]
    Bodies(usize),
}

/// The least distances from bodies that move.
#[derive(Clone, Debug)]
pub struct SceneVolume {
    lattice: Lattice,
    bricks: [usize; 3],
    reach: f32,
    bodies: Vec<Body>,
    values: Vec<f32>,
    nearest: Vec<u16>,
}

impl SceneVolume {
    /// An empty volume. No sample is farther than `reach` from what is near it: so far around its box a body counts.
    ///
    /// # Errors
    /// Too few or too many nodes, lengths or places that are none.
    pub fn new(lattice: Lattice, reach: f32) -> Result<SceneVolume, ComposeError> {
        let Lattice {
            nodes,
            origin,
            voxel,
        } = lattice;
        if !nodes.iter().all(|n| (2..=1024).contains(n)) {
            return Err(ComposeError::Nodes(nodes));
        }
        body::length("a voxel", voxel)?;
        body::length("how far bodies count", reach)?;
        if !origin.iter().all(|x| x.abs() <= 1e9) {
            return Err(BodyError::Place(origin).into());
        }
        let count = nodes.iter().product();
        Ok(SceneVolume {
            lattice,
            bricks: nodes.map(|n| n.div_ceil(SIDE)),
            reach,
            bodies: Vec::new(),
            values: vec![reach; count],
            nearest: vec![NOBODY; count],
        })
    }

    /// Its nodes.
    pub fn lattice(&self) -> Lattice {
        self.lattice
    }

    /// How many bricks it has.
    pub fn bricks(&self) -> usize {
        self.bricks.iter().product()
    }

    /// The bodies that it was composed of.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The distances, x fastest, not above the reach.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// By node the number of the body that is nearest, [`NOBODY`] where none is near.
    pub fn nearest(&self) -> &[u16] {
        &self.nearest
    }

    /// The distance at a node.
    pub fn at(&self, [i, j, k]: [usize; 3]) -> f32 {
        let [nx, ny, _] = self.lattice.nodes;
        self.values[i + nx * (j + ny * k)]
    }

    /// Composes the volume of these bodies: writes the bricks anew where any of them is not what or where it was. Gives how many that were. What
    /// it holds then is what [`SceneVolume::compose_anew`] gives, to the bit, on any number of threads.
    ///
    /// # Errors
    /// Too many bodies; the volume stays as it was.
    pub fn compose(&mut self, bodies: &[Body]) -> Result<usize, ComposeError> {
        let before = self.put(bodies)?;
        let most = before.len().max(bodies.len());
        let changed = (0..most).filter(|k| match (before.get(*k), bodies.get(*k)) {
            (Some(a), Some(b)) => !a.is_where(b),
            _ => true,
        });
        let changed = changed.flat_map(|k| before.get(k).into_iter().chain(bodies.get(k)));
        let changed: Vec<&Body> = changed.collect();
        let touched = |brick: [usize; 3]| {
            let (centre, radius) = self.ball(brick);
            let near = |body: &&Body| body.clearance(centre, radius) < self.reach;
            changed.iter().any(near)
        };
        let [bx, by, bz] = self.bricks;
        let marked: Vec<bool> = (0..bx * by * bz)
            .into_par_iter()
            .map(|n| touched([n % bx, n / bx % by, n / bx / by]))
            .collect();
        self.write(&marked);
        Ok(marked.iter().filter(|is| **is).count())
    }

    /// Composes the whole volume of these bodies.
    ///
    /// # Errors
    /// Too many bodies; the volume stays as it was.
    pub fn compose_anew(&mut self, bodies: &[Body]) -> Result<(), ComposeError> {
        self.put(bodies)?;
        self.write(&vec![true; self.bricks()]);
        Ok(())
    }

    /// Takes other bodies, and gives those before.
    fn put(&mut self, bodies: &[Body]) -> Result<Vec<Body>, ComposeError> {
        if bodies.len() >= usize::from(NOBODY) {
            return Err(ComposeError::Bodies(bodies.len()));
        }
        Ok(std::mem::replace(&mut self.bodies, bodies.to_vec()))
    }

    /// A ball around a brick.
    fn ball(&self, brick: [usize; 3]) -> ([f32; 3], f32) {
        let Lattice { origin, voxel, .. } = self.lattice;
        let half = 0.5 * (SIDE - 1) as f32;
        let centre = [0, 1, 2].map(|k| origin[k] + voxel * ((SIDE * brick[k]) as f32 + half));
        (centre, voxel * half * 3f32.sqrt() * 1.001)
    }

    /// Writes the bricks that are marked.
    fn write(&mut self, marked: &[bool]) {
        let (mut values, mut nearest) = (
            std::mem::take(&mut self.values),
            std::mem::take(&mut self.nearest),
        );
        let [nx, ny, _] = self.lattice.nodes;
        let [bx, by, _] = self.bricks;
        let level = Level::new();
        let layer = nx * ny * SIDE;
        let layers = values
            .par_chunks_mut(layer)
            .zip(nearest.par_chunks_mut(layer));
        layers.enumerate().for_each(|(z, (values, nearest))| {
            let mut work = Box::new(Work {
                distance: [0.0; BRICK],
                body: [0.0; BRICK],
            });
            for n in (0..bx * by).filter(|n| marked[n + bx * by * z]) {
                let brick = [n % bx, n / bx, z];
                at_level!(level, s => self.brick(s, brick, &mut work));
                self.put_brick(brick, &work, values, nearest);
            }
        });
        (self.values, self.nearest) = (values, nearest);
    }

    /// Finds what a brick holds.
    #[inline(always)]
    fn brick<S: Simd>(&self, s: S, brick: [usize; 3], work: &mut Work) {
        work.distance.fill(self.reach);
        work.body.fill(f32::from(NOBODY));
        let (centre, radius) = self.ball(brick);
        let Lattice { origin, voxel, .. } = self.lattice;
        let first = [
            origin[0] + voxel * (SIDE * brick[0]) as f32,
            origin[1] + voxel * (SIDE * brick[1]) as f32,
            origin[2] + voxel * (SIDE * brick[2]) as f32,
        ];
        let ramp = Lanes(S::f32s::from_fn(
            s,
            #[inline(always)]
            |k| k as f32,
        ));
        for (number, body) in self.bodies.iter().enumerate() {
            if body.clearance(centre, radius) >= self.reach {
                continue;
            }
            nodes(s, ramp, body, number, first, voxel, work);
        }
    }

    /// Copies what a brick holds to its place: bricks at the far ends have fewer nodes.
    fn put_brick(
        &self,
        [x, y, _]: [usize; 3],
        work: &Work,
        values: &mut [f32],
        nearest: &mut [u16],
    ) {
        let [nx, ny, _] = self.lattice.nodes;
        let depth = values.len() / (nx * ny);
        let wide = SIDE.min(nx - SIDE * x);
        for k in 0..depth {
            for j in 0..SIDE.min(ny - SIDE * y) {
                let (to, from) = (
                    SIDE * x + nx * (SIDE * y + j + ny * k),
                    SIDE * (j + SIDE * k),
                );
                values[to..to + wide].copy_from_slice(&work.distance[from..from + wide]);
                let bodies = &work.body[from..from + wide];
                for (to, body) in nearest[to..to + wide].iter_mut().zip(bodies) {
                    *to = *body as u16;
                }
            }
        }
    }
}

/// What a brick holds while it is made: distances, and the numbers of bodies.
struct Work {
    distance: [f32; BRICK],
    body: [f32; BRICK],
}

/// Writes a body into a brick whose first node is at `first`.
#[inline(always)]
fn nodes<S: Simd>(
    s: S,
    ramp: Lanes<S>,
    body: &Body,
    number: usize,
    first: [f32; 3],
    voxel: f32,
    work: &mut Work,
) where
    Lanes<S>: Real<Scalar = f32, Store = Data>,
{
    let lanes = S::f32s::LEN;
    let own = Lanes(S::f32s::splat(s, number as f32));
    for row in 0..SIDE * SIDE {
        let y = Lanes(S::f32s::splat(s, first[1] + voxel * (row % SIDE) as f32));
        let z = Lanes(S::f32s::splat(s, first[2] + voxel * (row / SIDE) as f32));
        for i in (0..SIDE).step_by(lanes) {
            let at = row * SIDE + i;
            let x = (ramp + i as f32) * voxel + first[0];
            let d = body.distance(v3(x, y, z));
            let before = Lanes(S::f32s::from_slice(s, &work.distance[at..at + lanes]));
            let whose = Lanes(S::f32s::from_slice(s, &work.body[at..at + lanes]));
            let nearer = d.below(before);
            Lanes::select(nearer, d, before)
                .0
                .store_slice(&mut work.distance[at..at + lanes]);
            Lanes::select(nearer, own, whose)
                .0
                .store_slice(&mut work.body[at..at + lanes]);
        }
    }
}
