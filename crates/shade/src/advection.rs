//! Shadows without shadow rays: light that flows through a volume (Evans 2006, 9.9 and figure 12).
//!
//! Around all that has an end lies a volume, as that of [`crate::skylight`]. At each of its nodes it is known how much of it is solid, and the
//! **flow** of a light: the first four spherical harmonics, constant and linear, of what would arrive there if nothing stood in between. The linear
//! ones over the constant one are a way of at most one voxel: away from the light, shorter where it comes from many sides of a large lamp. At first
//! all light arrives. Then again and again each node takes what was there one way before it, as much as the solid there lets through, blurred a
//! little; what is solid grows shadows that way, softer the longer they are. When nothing changes any more, what is left of the light is found at
//! each node:
//!
//! ```text
//! a(x) = [o b](x - w(x)),    b = blur(o a) / blur(o),    w = voxel * flux / fluence
//! ```
//!
//! with `o` the open share of a voxel. **What the paper leaves open**: blur, steps, solids and what many lights have in common. Dividing by what
//! is open keeps solids out of the blur, so that hardly any light is lost along walls. The paper's one volume for all lights follows their mean direction,
//! which between two lights points at neither. Here each light has its own.
//!
//! **Beyond the volume** there is nothing that has an end: light goes straight on from where it leaves. **Beside the surface**, some voxels before
//! it, it is read: on the surface itself half of the nodes around are solid.

use crate::lamp::{Lamp, Shape};
use crate::parameters;
use crate::skylight::{Extent, affordable, is_same, mixed, sampled};
use crate::view::on_disc;
use rayon::prelude::*;
use std::sync::Arc;
use zeroset_field::field::FieldError;
use zeroset_field::program::Program;
use zeroset_number::{Data, Grid, GridError, Real, Vec3, v3};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::{Integrator, Shadow};

/// Places along each side of a flat lamp that its flow is summed over.
const PLACES: u32 = 4;
/// Nodes that may be visited for all lights together: a scene may come from a stranger.
const WORK: u64 = 1 << 33;
/// The volume is done when nothing changes by more: a picture of 8 bits cannot show it.
const STILL: f32 = 1.0 / 4096.0;
/// Less than this is nothing.
const LEAST: f32 = 1e-6;

/// The light that would arrive at a place if nothing stood in between, of a light that is 1 at a distance of 1: the first four spherical harmonics of
/// its radiance, but for their constant factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// From all sides together.
    pub fluence: f32,
    /// What goes through: the way that the light travels, and how much of it.
    pub flux: Vec3<f32>,
}

impl Flow {
    /// That of a light at a place. From within a sphere as much comes from either side; behind a flat lamp nothing arrives.
    pub fn of(source: &Source, lamp: Option<&Lamp<f32>>, p: Vec3<f32>) -> Flow {
        let none = Flow {
            fluence: 0.0,
            flux: Vec3::splat(0.0),
        };
        if let Source::Directional { direction } = source {
            return Flow {
                fluence: 1.0,
                flux: parameters(*direction),
            };
        }
        let from = |place: Vec3<f32>| {
            let way = p - place;
            let distance = way.length().max(1e-18);
            (way / distance, 1.0 / (distance * distance))
        };
        match (source, lamp) {
            (_, Some(lamp)) if matches!(lamp.shape, Shape::Sphere) => {
                let (way, falloff) = from(lamp.place);
                let sine2 = lamp.radius * lamp.radius * falloff;
                if sine2 >= 1.0 {
                    return Flow {
                        fluence: falloff,
                        ..none
                    };
                }
                // all of a cone's light over what goes along its axis
                let along = 0.5 * (1.0 + (1.0 - sine2).sqrt());
                Flow {
                    fluence: falloff / along,
                    flux: way * falloff,
                }
            }
            (_, Some(lamp)) => {
                let front = lamp.right.cross(lamp.up);
                let front = front / front.length().max(1e-18);
                let share = |n: u32| (n as f32 + 0.5) / PLACES as f32;
                let mut sum = none;
                for k in 0..PLACES * PLACES {
                    let u = [share(k % PLACES), share(k / PLACES)];
                    let [x, y] = match lamp.shape {
                        Shape::Disc => on_disc(u),
                        Shape::Rectangle | Shape::Sphere => u.map(|u| 2.0 * u - 1.0),
                    };
                    let (way, falloff) = from(lamp.place + lamp.right * x + lamp.up * y);
                    let part = (falloff * front.dot(way)).max(0.0) / (PLACES * PLACES) as f32;
                    sum.fluence += part;
                    sum.flux = sum.flux + way * part;
                }
                sum
            }
            (
                Source::Point { position }
                | Source::Rectangle { position, .. }
                | Source::Disc { position, .. }
                | Source::Sphere { position, .. },
                None,
            ) => {
                let (way, falloff) = from(parameters(*position));
                Flow {
                    fluence: falloff,
                    flux: way * falloff,
                }
            }
            (Source::Directional { .. }, None) => none,
        }
    }
}

/// How far along the way `to` a light (of length 1) a place first lies in the volume, in voxels from its first node: 0 within it, below 0 where the way leads past it.
#[inline(always)]
pub fn entry<R: Real>(place: Vec3<R>, to: Vec3<R>, cells: Vec3<R::Scalar>) -> R {
    let (x, y, z) = (
        slab(place.x, to.x, cells.x),
        slab(place.y, to.y, cells.y),
        slab(place.z, to.z, cells.z),
    );
    let near = x.0.max(y.0).max(z.0).max(0.0);
    let far = x.1.min(y.1).min(z.1);
    R::choose(far.below(near), place.x.lit(-1.0), near)
}

/// Where a line is between two planes across an axis.
#[inline(always)]
fn slab<R: Real>(p: R, d: R, cells: R::Scalar) -> (R, R) {
    let d = R::choose(d.abs().below(1e-6), d.lit(1e-6), d);
    let (a, b) = (-p / d, -(p - cells) / d);
    (a.min(b), a.max(b))
}

/// How a light's shadow is read from its volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The number of its grid.
    pub grid: usize,
    /// How far before the surface, scene units.
    pub before: f32,
}

/// The volumes of a scene's lights: one grid for each of those that ask for one.
#[derive(Clone, Debug)]
pub struct LightVolume {
    /// Where they lie.
    pub extent: Extent,
    /// Their grids.
    pub data: Data,
    /// How they are read, light by light; none of those that ask for none.
    pub readings: Vec<Option<Reading>>,
    made_of: (Program, Vec<(Source, f32)>),
}

impl LightVolume {
    /// Those of a scene, if any of its lights asks for one; its grids are those from before, if they were made of the same. All have the highest resolution that is asked
    /// for; where it would take too long, half of it, or less. Paths of light are followed to lights themselves: they ask for none.
    ///
    /// # Errors
    /// Samples that make no grid, which no valid scene has.
    pub fn renewed(
        before: Option<&Arc<LightVolume>>,
        scene: &Scene,
        program: &Program,
    ) -> Result<Option<Arc<LightVolume>>, FieldError> {
        let Some(resolution) = wanted(scene) else {
            return Ok(None);
        };
        let lights: Vec<(Source, f32)> = (scene.lights().iter())
            .filter_map(|light| Some((light.source, asked(light)?.spread)))
            .collect();
        let instructions = program.structure().values.instructions.len();
        let mut resolution = affordable(resolution, instructions);
        while resolution > 24 && visits(resolution).saturating_mul(lights.len() as u64) > WORK {
            resolution /= 2;
        }
        let extent = Extent::of(scene, resolution);
        let mut grid = 0..;
        let readings = (scene.lights().iter())
            .map(|light| {
                let asked = asked(light)?;
                Some(Reading {
                    grid: grid.next()?,
                    before: asked.bias * extent.voxel,
                })
            })
            .collect();
        if let Some(same) = before.filter(|before| {
            let (of, known) = &before.made_of;
            before.extent == extent && *known == lights && is_same(of, program)
        }) {
            return Ok(Some(Arc::new(LightVolume {
                readings,
                ..LightVolume::clone(same)
            })));
        }
        let open = open(&extent, &sampled(program, &extent));
        let unfit = |error: GridError| FieldError::Unfit {
            entry: "advected",
            reason: error.to_string(),
        };
        let grids = (lights.iter())
            .map(|(source, spread)| {
                let left = advected(&extent, &open, source, *spread);
                Ok(Arc::new(Grid::of_points(extent.nodes(0), left)?))
            })
            .collect::<Result<_, _>>()
            .map_err(unfit)?;
        Ok(Some(Arc::new(LightVolume {
            extent,
            data: Data {
                params: Vec::new(),
                grids,
            },
            readings,
            made_of: (program.clone(), lights),
        })))
    }

    /// How much of a light reaches a surface that sees it along `to` (of length 1), so far away.
    #[inline(always)]
    pub fn left<R: Real<Scalar = f32, Store = Data>>(
        &self,
        reading: &Reading,
        point: Vec3<R>,
        normal: Vec3<R>,
        to: Vec3<R>,
        distance: R,
    ) -> R {
        let Extent {
            origin: [x, y, z],
            voxel,
            cells,
        } = self.extent;
        let p = point + normal * reading.before;
        let place = (p - v3(x, y, z)) * (1.0 / voxel);
        let [x, y, z] = cells.map(|n| n as f32);
        let t = entry(place, to, v3(x, y, z));
        let past = t.below(0.0) | (t * voxel).above(distance);
        let nodes = v3(x + 1.0, y + 1.0, z + 1.0);
        let found = R::sample(&self.data, reading.grid as f32, nodes, place + to * t);
        R::choose(past, t.lit(1.0), found)
    }
}

/// What a light asks for.
struct Asked {
    resolution: u32,
    spread: f32,
    bias: f32,
}

fn asked(light: &Light) -> Option<Asked> {
    match light.shadow {
        Shadow::Advected {
            resolution,
            spread,
            bias,
        } => Some(Asked {
            resolution,
            spread,
            bias,
        }),
        Shadow::None | Shadow::Hard | Shadow::Soft { .. } | Shadow::SoftClosest { .. } => None,
    }
}

/// The resolution that the lights of a scene ask for, if any does.
pub fn wanted(scene: &Scene) -> Option<u32> {
    if matches!(scene.settings().integrator, Integrator::Path { .. }) {
        return None;
    }
    let all = scene.lights().iter().filter_map(asked);
    all.map(|asked| asked.resolution).max()
}

/// Nodes that light visits on its way through a volume, at most about.
fn visits(resolution: u32) -> u64 {
    3 * u64::from(resolution).pow(4)
}

/// How much of the voxel around each node is open, by its distance from the surface.
fn open(extent: &Extent, distances: &[f32]) -> Vec<f32> {
    let share = |f: &f32| (0.5 + f / extent.voxel).clamp(0.0, 1.0);
    distances.par_iter().map(share).collect()
}

/// Where light comes from that is at a node: a cell, and where in it. None where it is all there is of the light.
#[derive(Clone, Copy)]
struct Upwind {
    cell: Option<u32>,
    t: [f32; 3],
}

/// What is left of a light at the nodes of a volume that is so open.
fn advected(extent: &Extent, open: &[f32], source: &Source, spread: f32) -> Vec<f32> {
    let nodes = extent.nodes(0).map(|n| n as usize);
    let [nx, ny, nz] = nodes;
    let lamp = Lamp::of(&Light {
        source: *source,
        radiance: glam::Vec3::ONE,
        shadow: Shadow::None,
    });
    let upwind: Vec<Upwind> = (0..nx * ny * nz)
        .into_par_iter()
        .map(|n| {
            upwind(
                extent,
                [n % nx, n / nx % ny, n / nx / ny],
                source,
                lamp.as_ref(),
            )
        })
        .collect();
    let mut spare = vec![0.0; open.len()];
    // one over what is open around each node
    let mut around = open.to_vec();
    blur(nodes, spread, &mut around, &mut spare);
    around.par_iter_mut().for_each(|o| {
        *o = match *o > LEAST {
            true => o.recip(),
            false => 0.0,
        };
    });
    let mut light = vec![1.0; open.len()];
    let mut sent = vec![0.0; open.len()];
    for _ in 0..4 * (nx + ny + nz) {
        let all = sent.par_iter_mut().zip(&light).zip(open);
        all.for_each(|((sent, light), open)| *sent = light * open);
        if spread > 0.0 {
            blur(nodes, spread, &mut sent, &mut spare);
            let all = sent.par_iter_mut().zip(&around).zip(open);
            all.for_each(|((sent, around), open)| *sent = (*sent * around).min(1.0) * open);
        }
        let changes = light.par_iter_mut().zip(&upwind).map(|(light, from)| {
            let Some(cell) = from.cell else {
                return 0.0;
            };
            let found = between(&sent, cell as usize, [nx, nx * ny], from.t);
            let change = (found - *light).abs();
            *light = found;
            change
        });
        if changes.reduce(|| 0.0, f32::max) <= STILL {
            break;
        }
    }
    light
}

/// Where light comes from that is at a node.
fn upwind(extent: &Extent, node: [usize; 3], source: &Source, lamp: Option<&Lamp<f32>>) -> Upwind {
    let all = Upwind {
        cell: None,
        t: [0.0; 3],
    };
    let [x, y, z] = extent.origin;
    let [i, j, k] = node.map(|n| n as f32);
    let p = v3(x, y, z) + v3(i, j, k) * extent.voxel;
    let flow = Flow::of(source, lamp, p);
    let near = match source {
        Source::Directional { .. } => false,
        Source::Point { position }
        | Source::Rectangle { position, .. }
        | Source::Disc { position, .. }
        | Source::Sphere { position, .. } => (p - parameters(*position)).length() < extent.voxel,
    };
    let way = flow.flux / flow.fluence.max(1e-30);
    if near || way.length() <= 0.0 {
        return all;
    }
    let from = (v3(i, j, k) - way).array();
    let (mut first, mut t) = ([0; 3], [0.0; 3]);
    for axis in 0..3 {
        let cells = extent.cells[axis] as f32;
        if !(from[axis] >= 0.0 && from[axis] <= cells) {
            return all;
        }
        first[axis] = (from[axis] as u32).min(extent.cells[axis] - 1);
        t[axis] = from[axis] - first[axis] as f32;
    }
    let [nx, ny, _] = extent.nodes(0);
    Upwind {
        cell: Some((first[2] * ny + first[1]) * nx + first[0]),
        t,
    }
}

/// What lies within a cell, whose neighbours along y and z are so far away.
#[inline(always)]
fn between(values: &[f32], cell: usize, [row, slice]: [usize; 2], [x, y, z]: [f32; 3]) -> f32 {
    let line = |at: usize| values[at] + (values[at + 1] - values[at]) * x;
    let face = |at: usize| {
        let near = line(at);
        near + (line(at + row) - near) * y
    };
    let near = face(cell);
    near + (face(cell + slice) - near) * z
}

/// Blurs samples along each axis: `spread` of each is mixed as [`mixed`] does, and the rest stays. Ends stay as they are.
fn blur([nx, ny, nz]: [usize; 3], spread: f32, values: &mut [f32], spare: &mut [f32]) {
    let kept = 1.0 - spread;
    spare
        .par_chunks_mut(nx * ny)
        .zip(values.par_chunks(nx * ny))
        .for_each_init(
            || vec![0.0; nx * ny],
            |narrow, (out, slice)| {
                for (out, row) in narrow.chunks_mut(nx).zip(slice.chunks(nx)) {
                    out.copy_from_slice(row);
                    for (out, three) in out[1..].iter_mut().zip(row.windows(3)) {
                        *out = kept * three[1] + spread * mixed(three[0], three[1], three[2]);
                    }
                }
                lines(kept, out, narrow, nx, ny);
            },
        );
    let wide = nx * ny;
    values
        .par_chunks_mut(wide)
        .enumerate()
        .for_each(|(k, out)| {
            let slice = |k: usize| &spare[k * wide..][..wide];
            let here = slice(k);
            if k == 0 || k + 1 == nz {
                out.copy_from_slice(here);
                return;
            }
            let (before, after) = (slice(k - 1), slice(k + 1));
            for (i, out) in out.iter_mut().enumerate() {
                *out = kept * here[i] + spread * mixed(before[i], here[i], after[i]);
            }
        });
}

/// The same from line to line, of which there are so many.
fn lines(kept: f32, out: &mut [f32], from: &[f32], width: usize, count: usize) {
    for (j, out) in out.chunks_mut(width).enumerate() {
        let line = |j: usize| &from[j * width..][..width];
        let here = line(j);
        if j == 0 || j + 1 == count {
            out.copy_from_slice(here);
            continue;
        }
        let (before, after) = (line(j - 1), line(j + 1));
        for (i, out) in out.iter_mut().enumerate() {
            *out = kept * here[i] + (1.0 - kept) * mixed(before[i], here[i], after[i]);
        }
    }
}

#[cfg(test)]
mod tests;
