//! Skylight from a volume of distances (Evans 2006, 9.6), and the colours that things give to what is near them (9.9).
//!
//! What a scene shows as distances is sampled once, at the nodes of a volume around all that has an end. Each of the mips above it
//! is the one below, blurred by 1/4, 1/2, 1/4 along each axis and halved. A surface at `x` with normal `n` reads four distances `f_i`, at `d_i` along
//! `n' = n + alpha u`, where `u` is up and each `d_i` is twice the one before: each from the mip whose voxels are twice as wide as well, since what is
//! far away throws blurred shadows. In the open they would be `d_i`. The light that comes through is
//!
//! ```text
//! exp(-k sum_i w_i (d_i - f_i)),    w = 1, 1.2, 1.4, 1.8
//! ```
//!
//! but not more than 1. (The paper's distances are positive inside, and its exponent has the other sign.)
//!
//! **Colours.** The paper has a volume for each of red, green and blue, in which the distances to a thing are greater by a small share of its colour: near a
//! red wall red light is less occluded. Blurring adds up, so that the same comes of one volume of distances and one of the colours of the nearest
//! things, and how much they count needs no volume anew. A thing near which light of a colour is not lost at all is white at [`Reading::bleed`]
//! for `bleed = 1`: the mean of the four distances, by their weights.
//!
//! **Where the volume ends**, over [`MARGIN`] voxels around the box, it gives way to the field itself: a floor goes on for ever without a seam.

use crate::occlusion::{EVANS, UP};
use crate::pattern::formula_shown;
use fearless_simd::{Level, Simd};
use rayon::prelude::*;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::{BATCH, Evaluator, Workspace};
use zeroset_field::field::FieldError;
use zeroset_field::formula::ColourFormula;
use zeroset_field::program::{FLAT, Program};
use zeroset_number::{Data, Grid, GridError, Real, Vec3, at_level, v3};
use zeroset_scene::material::{Ink, Material, Pattern};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Occlusion;

/// Mips of the volume, the finest among them: one for each sample.
pub const LEVELS: usize = EVANS.len();
/// Voxels that the volume goes on beyond the box of the scene. They are also where it gives way to the field.
pub const MARGIN: u32 = 1 << (LEVELS - 1);
/// The finest mip that has colours: they change more slowly than distances.
pub const COLOURED: usize = 1;
/// Grids of distances, then for each mip that has colours one of red, one of green and one of blue.
pub const GRIDS: usize = LEVELS + 3 * (LEVELS - COLOURED);
/// No sample is more voxels from zero: farther than any method reads, and where a gradient vanishes a distance may be anything.
const FARTHEST: f32 = 2048.0;

/// Instructions that sampling may take, at all nodes together: a scene may come from a stranger.
const WORK: u64 = 1 << 34;

/// Where a volume lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Its first node.
    pub origin: [f32; 3],
    /// From one node to the next, scene units.
    pub voxel: f32,
    /// Voxels along each axis: one less than nodes.
    pub cells: [u32; 3],
}

impl Extent {
    /// That of a scene: around all that has an end, the longest side being `resolution` voxels, [`MARGIN`] on either side included. Where
    /// nothing has an end it is a cube around the origin that reaches as far as the eye.
    pub fn of(scene: &Scene, resolution: u32) -> Extent {
        let bounds = scene.finite_bounds().unwrap_or_else(|| {
            let reach = f64::from(scene.camera().eye.length()).max(1e-3);
            Aabb::centred([reach; 3])
        });
        let half = bounds.half();
        let longest = half.iter().fold(1e-6, |a: f64, b| a.max(2.0 * b));
        let inner = resolution.max(2 * MARGIN + MARGIN).next_multiple_of(MARGIN) - 2 * MARGIN;
        let voxel = longest / f64::from(inner);
        let cells = half.map(|half| {
            let inner = (2.0 * half / voxel - 1e-6).ceil().max(1.0) as u32;
            inner.next_multiple_of(MARGIN) + 2 * MARGIN
        });
        let centre = bounds.centre();
        Extent {
            origin: std::array::from_fn(|k| (centre[k] - 0.5 * voxel * f64::from(cells[k])) as f32),
            voxel: voxel as f32,
            cells,
        }
    }

    /// Nodes of a mip.
    pub fn nodes(&self, level: usize) -> [u32; 3] {
        self.cells.map(|n| (n >> level) + 1)
    }
}

/// What a method reads with, in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The first distance above zero.
    pub first: f32,
    /// What the sum of distances is multiplied by.
    pub scale: f32,
    /// How far the normal bends towards the sky.
    pub bend: f32,
    /// How much farther away white things are.
    pub bleed: f32,
}

impl Reading {
    /// Of a method's own numbers, in a volume of such voxels. A place where all four distances are 0 gets e to the power of `-strength`.
    pub fn new(voxel: f32, step: f32, strength: f32, bend: f32, bleed: f32) -> Reading {
        let first = step * voxel;
        let far = |(i, w): (usize, &f32)| w * (1 << i) as f32;
        let (ways, weights) = (
            EVANS.iter().enumerate().map(far).sum::<f32>(),
            EVANS.iter().sum::<f32>(),
        );
        Reading {
            first,
            scale: strength / (ways * first),
            bend,
            bleed: bleed * first * ways / weights,
        }
    }
}

/// The way along which distances are read: the normal, bent towards the sky.
#[inline(always)]
pub fn way<R: Real>(normal: Vec3<R>, bend: R::Scalar) -> Vec3<R> {
    let lift = |c: f32| normal.x.like(bend * c);
    normal + v3(lift(UP[0]), lift(UP[1]), lift(UP[2]))
}

/// The middle of the part of the sky that such a way leads to.
#[inline(always)]
pub fn bent<R: Real>(normal: Vec3<R>, way: Vec3<R>) -> Vec3<R> {
    let length = way.length();
    // straight down there may be no way
    let is_none = length.below(1e-3);
    let unit = way / length.max(1e-3);
    v3(
        R::choose(is_none, normal.x, unit.x),
        R::choose(is_none, normal.y, unit.y),
        R::choose(is_none, normal.z, unit.z),
    )
}

/// How much the volume counts at a place, in voxels from its first node; the rest is the field's. 0 at its border, 1 from [`MARGIN`] on.
#[inline(always)]
pub fn share<R: Real>(p: Vec3<R>, cells: Vec3<R::Scalar>) -> R {
    let x = p.x.min(-(p.x - cells.x));
    let y = p.y.min(-(p.y - cells.y));
    let z = p.z.min(-(p.z - cells.z));
    x.min(y).min(z).smoothstep(0.0, MARGIN as f32)
}

/// What of the light of each colour comes through, from the sums over all samples of how much farther away the surface is than expected.
#[inline(always)]
pub fn light<R: Real>(sums: Vec3<R>, scale: R::Scalar) -> Vec3<R> {
    sums.map(
        #[inline(always)]
        |sum| crate::occlusion::exponential_visibility(sum, scale),
    )
}

/// What a mip is off at a surface, `f`, as a shade: 0.6 where it is flat, less in creases and more on ridges. It is `0.5 + exp(k f)` (Evans 2006, 9.5, with
/// the sign mended), of which 1.5 is flat, as a share of 2.5. `per` is k.
#[inline(always)]
pub fn curved<R: Real>(f: R, per: R::Scalar) -> R {
    ((f * per).exp() + 0.5).min(2.5) * 0.4
}

/// What `f` is multiplied by in [`curved`] for a strength and a mip of a volume of such voxels.
pub fn per_voxel(strength: f32, voxel: f32, level: usize) -> f32 {
    strength / (voxel * (1 << level) as f32)
}

/// How open a place is that gets such light, and what the sky's light is multiplied by beside that: their product is the light.
#[inline(always)]
pub fn split<R: Real>(light: Vec3<R>) -> (R, Vec3<R>) {
    let open = (light.x + light.y + light.z) * (1.0 / 3.0);
    (open, light / open.max(1e-20))
}

/// The volume of a scene.
#[derive(Clone, Debug)]
pub struct SkyVolume {
    /// Where it lies.
    pub extent: Extent,
    /// Whether it has colours.
    pub is_coloured: bool,
    /// Its grids: see [`GRIDS`].
    pub data: Data,
    /// What it was made of.
    made_of: Option<(Program, Vec<glam::Vec3>)>,
}

impl SkyVolume {
    /// That of a scene, if any of its methods reads it: the one before, if it was made of the same. Where methods ask for different
    /// resolutions there is one volume of the highest; where the field is so large that sampling it would take too long (8000 instructions
    /// for 128 voxels), of half of it, or less.
    ///
    /// # Errors
    /// Samples that make no grid, which no valid scene has.
    pub fn renewed(
        before: Option<&Arc<SkyVolume>>,
        scene: &Scene,
        program: &Program,
    ) -> Result<Option<Arc<SkyVolume>>, FieldError> {
        let Some((resolution, is_coloured)) = wanted(scene) else {
            return Ok(None);
        };
        let instructions = program.structure().values.instructions.len();
        let extent = Extent::of(scene, affordable(resolution, instructions));
        let colours = palette(scene, program);
        let same = |volume: &&Arc<SkyVolume>| {
            let Some((of, painted)) = &volume.made_of else {
                return false;
            };
            volume.extent == extent
                && (!is_coloured || (volume.is_coloured && *painted == colours))
                && is_same(of, program)
        };
        if let Some(same) = before.filter(same) {
            return Ok(Some(Arc::clone(same)));
        }
        let distances = sampled(program, &extent);
        let nearest = is_coloured.then(|| painted(program, &extent, &colours));
        let unfit = |error: GridError| FieldError::Unfit {
            entry: "skylight",
            reason: error.to_string(),
        };
        let volume = SkyVolume::of(extent, distances, nearest).map_err(unfit)?;
        Ok(Some(Arc::new(SkyVolume {
            made_of: Some((program.clone(), colours)),
            ..volume
        })))
    }

    /// That of these samples, x fastest: distances at the nodes of the finest mip, and red, green and blue at those of mip [`COLOURED`].
    ///
    /// # Errors
    /// Another number of samples than nodes, samples that are no numbers.
    pub fn of(
        extent: Extent,
        distances: Vec<f32>,
        colours: Option<[Vec<f32>; 3]>,
    ) -> Result<SkyVolume, GridError> {
        let is_coloured = colours.is_some();
        let mut grids = mips(&extent, 0, distances)?;
        if let Some(colours) = colours {
            let mut each = Vec::new();
            for colour in colours {
                each.push(mips(&extent, COLOURED, colour)?);
            }
            for level in 0..LEVELS - COLOURED {
                grids.extend(each.iter().map(|grids| Arc::clone(&grids[level])));
            }
        }
        let data = Data {
            params: Vec::new(),
            grids,
        };
        Ok(SkyVolume {
            extent,
            is_coloured,
            data,
            made_of: None,
        })
    }

    /// A place in voxels from the first node.
    #[inline(always)]
    pub fn place<R: Real<Scalar = f32>>(&self, p: Vec3<R>) -> Vec3<R> {
        let [x, y, z] = self.extent.origin;
        (p - v3(x, y, z)) * (1.0 / self.extent.voxel)
    }

    /// Where a place in voxels from the first node is.
    #[inline(always)]
    pub fn world<R: Real<Scalar = f32>>(&self, place: Vec3<R>) -> Vec3<R> {
        let [x, y, z] = self.extent.origin;
        place * self.extent.voxel + v3(x, y, z)
    }

    /// See [`share`].
    #[inline(always)]
    pub fn share<R: Real<Scalar = f32>>(&self, place: Vec3<R>) -> R {
        let [x, y, z] = self.extent.cells;
        share(place, v3(x as f32, y as f32, z as f32))
    }

    /// The distance of a mip at a place, in voxels of the finest one.
    #[inline(always)]
    pub fn distance<R: Real<Scalar = f32, Store = Data>>(&self, level: usize, place: Vec3<R>) -> R {
        self.read(level, level, place)
    }

    /// The colour of the nearest thing as a mip has it; the coarsest one that has colours for finer ones.
    #[inline(always)]
    pub fn colour<R: Real<Scalar = f32, Store = Data>>(
        &self,
        level: usize,
        place: Vec3<R>,
    ) -> Vec3<R> {
        let level = level.max(COLOURED);
        let first = LEVELS + 3 * (level - COLOURED);
        v3(
            self.read(first, level, place),
            self.read(first + 1, level, place),
            self.read(first + 2, level, place),
        )
    }

    /// The light of each colour that comes to a place with this normal, by the volume alone: beyond it, what is at its border goes on.
    #[inline(always)]
    pub fn light<R: Real<Scalar = f32, Store = Data>>(
        &self,
        p: Vec3<R>,
        normal: Vec3<R>,
        reading: &Reading,
    ) -> Vec3<R> {
        let way = way(normal, reading.bend);
        let mut sums = Vec3::splat(p.x.lit(0.0));
        for level in 0..LEVELS {
            let far = reading.first * (1 << level) as f32;
            let place = self.place(p + way * far);
            let more = (self.distance(level, place) - far) * EVANS[level];
            sums = sums + Vec3::splat(more);
            if self.is_coloured && reading.bleed > 0.0 {
                sums = sums + self.colour(level, place) * (reading.bleed * EVANS[level]);
            }
        }
        light(sums, reading.scale)
    }

    #[inline(always)]
    fn read<R: Real<Scalar = f32, Store = Data>>(
        &self,
        grid: usize,
        level: usize,
        place: Vec3<R>,
    ) -> R {
        let [x, y, z] = self.extent.nodes(level);
        let nodes = v3(x as f32, y as f32, z as f32);
        let finer = 1.0 / (1 << level) as f32;
        R::sample(&self.data, grid as f32, nodes, place * finer)
    }
}

/// Whether two programs are one field.
pub(crate) fn is_same(one: &Program, other: &Program) -> bool {
    let (a, b) = (one.data(), other.data());
    one.structure() == other.structure()
        && a.params == b.params
        && a.grids.len() == b.grids.len()
        && a.grids.iter().zip(&b.grids).all(|(a, b)| Arc::ptr_eq(a, b))
}

/// The resolution that a field of so many instructions is sampled with in place of another one.
pub(crate) fn affordable(mut resolution: u32, instructions: usize) -> u32 {
    let work = |n: u32| u64::from(n).pow(3).saturating_mul(instructions as u64);
    while resolution > 3 * MARGIN && work(resolution) > WORK {
        resolution /= 2;
    }
    resolution
}

/// The resolution that a scene's methods ask for, and whether any of them reads colours.
pub fn wanted(scene: &Scene) -> Option<(u32, bool)> {
    let own = scene.objects().iter().filter_map(|o| o.occlusion);
    let asked = own.chain([scene.settings().occlusion]);
    asked
        .filter_map(|method| match method {
            Occlusion::Skylight {
                resolution, bleed, ..
            } => Some((resolution, bleed > 0.0)),
            Occlusion::Curvature { resolution, .. } => Some((resolution, false)),
            _ => None,
        })
        .reduce(|(a, x), (b, y)| (a.max(b), x || y))
}

/// The colours that materials have on average as far as they are matte, by their numbers as marks; last that of what has none.
fn palette(scene: &Scene, program: &Program) -> Vec<glam::Vec3> {
    let materials = scene.materials();
    let placed = program.coats().iter();
    let placed = placed.filter_map(|coat| materials.get(usize::from(coat.material)));
    let own = |m: &Material| average(&m.pattern) * (1.0 - m.transmission);
    let all = materials.iter().chain(placed).map(own);
    all.chain([own(&Material::default())]).collect()
}

/// The colour of a pattern on average, all inks alike.
pub fn average(pattern: &Pattern) -> glam::Vec3 {
    match pattern {
        Pattern::Solid { colour } => *colour,
        Pattern::Placed { pattern, .. } => average(pattern),
        Pattern::Triplanar { image, .. } => {
            let sum: glam::DVec3 = image.pixels.iter().map(|c| c.as_dvec3()).sum();
            (sum / image.pixels.len().max(1) as f64).as_vec3()
        }
        Pattern::Formula { formula } => formula_average(formula),
        Pattern::Checker { .. }
        | Pattern::Stripes { .. }
        | Pattern::Noise { .. }
        | Pattern::Gradient { .. }
        | Pattern::Orbit { .. } => {
            let inks = pattern.inks();
            let ink = |ink: &Ink| match ink {
                Ink::Colour(colour) => *colour,
                Ink::Pattern(pattern) => average(pattern),
            };
            inks.iter().map(ink).sum::<glam::Vec3>() / inks.len().max(1) as f32
        }
    }
}

/// The colour of a formula on average over a cube of side 2 around the origin, where most that is painted lies: at points that are spread
/// evenly (the additive recurrence R3, Roberts 2018).
fn formula_average(formula: &ColourFormula) -> glam::Vec3 {
    const POINTS: u32 = 128;
    const STEPS: [f64; 3] = [
        0.819_172_513_396_164_4,
        0.671_043_606_703_789_2,
        0.549_700_477_901_960_8,
    ];
    let sum: glam::Vec3 = (1..=POINTS)
        .map(|n| {
            let [x, y, z] = STEPS.map(|step| ((f64::from(n) * step).fract() * 2.0 - 1.0) as f32);
            let colour = formula_shown(formula, v3(x, y, z), false);
            glam::Vec3::from(colour.array())
        })
        .sum();
    sum / POINTS as f32
}

/// The places of a row of nodes of a mip.
fn row(extent: &Extent, level: usize, number: usize, into: &mut Vec<glam::Vec3>) {
    let [nx, ny, _] = extent.nodes(level).map(|n| n as usize);
    let [x, y, z] = extent.origin;
    let step = extent.voxel * (1 << level) as f32;
    let (j, k) = ((number % ny) as f32, (number / ny) as f32);
    into.clear();
    into.extend((0..nx).map(|i| glam::Vec3::new(x + step * i as f32, y + step * j, z + step * k)));
}

/// What is shown as distances at the nodes of the finest mip.
pub(crate) fn sampled(program: &Program, extent: &Extent) -> Vec<f32> {
    let [nx, ny, nz] = extent.nodes(0).map(|n| n as usize);
    let mut values = vec![0.0; nx * ny * nz];
    let most = FARTHEST * extent.voxel;
    let rows = values.par_chunks_mut(nx).enumerate();
    rows.for_each_init(
        || {
            (
                Evaluator::new(program.values()),
                Vec::new(),
                vec![glam::Vec3::ZERO; nx],
            )
        },
        |(evaluator, points, gradients), (number, out)| {
            row(extent, 0, number, points);
            // there is a value for each point, and that is all that could be wrong
            if program.is_close() {
                let _ = evaluator.values(points, out);
            } else if evaluator.gradients(points, out, gradients).is_ok() {
                for (f, slope) in out.iter_mut().zip(gradients) {
                    *f /= slope.length().max(FLAT);
                }
            }
            for f in out {
                *f = if f.is_nan() {
                    0.0
                } else {
                    f.clamp(-most, most)
                };
            }
        },
    );
    values
}

/// Red, green and blue of the nearest thing at the nodes of mip [`COLOURED`], blurred once.
fn painted(program: &Program, extent: &Extent, colours: &[glam::Vec3]) -> [Vec<f32>; 3] {
    let nodes = extent.nodes(COLOURED).map(|n| n as usize);
    let nx = nodes[0];
    let rows: Vec<[Vec<f32>; 3]> = (0..nodes[1] * nodes[2])
        .into_par_iter()
        .map_init(
            || {
                (
                    Workspace::new(program.values(), program.marks()),
                    Vec::new(),
                )
            },
            |(work, points), number| {
                row(extent, COLOURED, number, points);
                let mut out = std::array::from_fn(|_| Vec::with_capacity(nx));
                for points in points.chunks(BATCH) {
                    let [x, y, z] = work.points_mut();
                    for i in 0..BATCH {
                        let p = points[i.min(points.len() - 1)];
                        (x.0[i], y.0[i], z.0[i]) = (p.x, p.y, p.z);
                    }
                    at_level!(Level::new(), s => mark(s, program, work, points.len()));
                    let marks = work.marks();
                    for i in 0..points.len() {
                        let colour = |number: f32| {
                            let last = colours.len() - 1;
                            let at = if number >= 0.0 { number as usize } else { last };
                            colours[at.min(last)]
                        };
                        let first = colour(marks.first.0[i]);
                        let mixed = match marks.share.0[i] {
                            share if share > 0.0 => first.lerp(colour(marks.second.0[i]), share),
                            _ => first,
                        };
                        for (out, x) in out.iter_mut().zip(mixed.to_array()) {
                            out.push(x);
                        }
                    }
                }
                out
            },
        )
        .collect();
    [0, 1, 2].map(|k| {
        let all: Vec<f32> = rows.iter().flat_map(|row| row[k].iter().copied()).collect();
        blurred(nodes, all)
    })
}

#[inline(always)]
fn mark<S: Simd>(s: S, program: &Program, work: &mut Workspace, n: usize) {
    zeroset_eval::marks(s, program.marks(), work, n);
}

/// All mips from one on, of its samples.
fn mips(extent: &Extent, from: usize, values: Vec<f32>) -> Result<Vec<Arc<Grid>>, GridError> {
    let mut values = values;
    let mut grids = Vec::new();
    for level in from..LEVELS {
        let nodes = extent.nodes(level);
        let next = (level + 1 < LEVELS).then(|| halved(nodes.map(|n| n as usize), &values));
        grids.push(Arc::new(Grid::of_points(nodes, values)?));
        values = next.unwrap_or_default();
    }
    Ok(grids)
}

/// Samples, blurred by 1/4, 1/2, 1/4 along each axis, at every other node. The first and the last node of an axis stay as they are: as if the
/// samples went on in a straight line.
fn halved(nodes: [usize; 3], values: &[f32]) -> Vec<f32> {
    let [nx, ny, nz] = nodes;
    let [hx, hy, hz] = nodes.map(|n| (n - 1) / 2 + 1);
    // along x and y, slice by slice
    let mut flat = vec![0.0; hx * hy * nz];
    let slices = flat.par_chunks_mut(hx * hy).zip(values.par_chunks(nx * ny));
    slices.for_each_init(
        || vec![0.0; hx * ny],
        |narrow, (out, slice)| {
            for (out, row) in narrow.chunks_mut(hx).zip(slice.chunks(nx)) {
                for (i, x) in out.iter_mut().enumerate() {
                    let (before, after) = beside(2 * i, nx);
                    *x = mixed(row[before], row[2 * i], row[after]);
                }
            }
            for (j, out) in out.chunks_mut(hx).enumerate() {
                let (before, after) = beside(2 * j, ny);
                rows(out, narrow, [before, 2 * j, after], hx);
            }
        },
    );
    let mut out = vec![0.0; hx * hy * hz];
    out.par_chunks_mut(hx * hy)
        .enumerate()
        .for_each(|(k, out)| {
            let (before, after) = beside(2 * k, nz);
            rows(out, &flat, [before, 2 * k, after], hx * hy);
        });
    out
}

/// Samples, blurred as [`halved`] does, at all nodes.
fn blurred([nx, ny, nz]: [usize; 3], values: Vec<f32>) -> Vec<f32> {
    let mut along_x = values.clone();
    for (out, row) in along_x.chunks_mut(nx).zip(values.chunks(nx)) {
        for (i, x) in out.iter_mut().enumerate() {
            let (before, after) = beside(i, nx);
            *x = mixed(row[before], row[i], row[after]);
        }
    }
    let mut along_y = values;
    for (out, slice) in along_y.chunks_mut(nx * ny).zip(along_x.chunks(nx * ny)) {
        for (j, out) in out.chunks_mut(nx).enumerate() {
            let (before, after) = beside(j, ny);
            rows(out, slice, [before, j, after], nx);
        }
    }
    let mut out = along_x;
    for (k, out) in out.chunks_mut(nx * ny).enumerate() {
        let (before, after) = beside(k, nz);
        rows(out, &along_y, [before, k, after], nx * ny);
    }
    out
}

/// The nodes beside one, or twice itself at an end.
#[inline(always)]
fn beside(i: usize, count: usize) -> (usize, usize) {
    if i == 0 || i + 1 == count {
        (i, i)
    } else {
        (i - 1, i + 1)
    }
}

#[inline(always)]
pub(crate) fn mixed(before: f32, here: f32, after: f32) -> f32 {
    0.5 * here + 0.25 * (before + after)
}

/// Three rows of so many numbers, mixed.
#[inline(always)]
fn rows(out: &mut [f32], from: &[f32], [before, here, after]: [usize; 3], width: usize) {
    let row = |number: usize| &from[number * width..][..width];
    let (a, b, c) = (row(before), row(here), row(after));
    for i in 0..width {
        out[i] = mixed(a[i], b[i], c[i]);
    }
}

/// The numbers that a scene's method reads with, if it reads the volume.
pub fn reading(method: &Occlusion, voxel: f32) -> Option<Reading> {
    match *method {
        Occlusion::Skylight {
            step,
            strength,
            bend,
            bleed,
            ..
        } => Some(Reading::new(voxel, step, strength, bend, bleed)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_language::load::{Language, Options, load_text};

    fn scene(text: &str) -> Scene {
        let options = Options::default();
        load_text("test.star", text, Language::Starlark, None, &options)
            .unwrap_or_else(|e| panic!("{}", e.report))
            .scene
    }

    fn program(scene: &Scene) -> Program {
        let field = scene.field().unwrap().unwrap();
        Program::compile(&field, &Default::default()).unwrap()
    }

    fn volume(text: &str) -> Arc<SkyVolume> {
        let scene = scene(text);
        SkyVolume::renewed(None, &scene, &program(&scene))
            .unwrap()
            .unwrap()
    }

    /// Straight lines stay straight in every mip, to the border.
    #[test]
    fn planes_are_exact_in_every_mip() {
        let volume = volume(
            "show(plane())\nshow(sphere(0.1).move(y = -3))\nrender(ao = skylight(resolution = 32))",
        );
        let Extent {
            origin,
            voxel,
            cells,
        } = volume.extent;
        for level in 0..LEVELS {
            for i in 0..40 {
                let p = [0, 1, 2].map(|k| {
                    let share = (0.37 + 0.618 * (i * (k + 1)) as f32).fract();
                    share * cells[k] as f32
                });
                let place = v3(p[0], p[1], p[2]);
                let y = origin[1] + voxel * p[1];
                let found: f32 = volume.distance(level, place);
                // the ball lies below the floor
                if y > 0.0 {
                    assert!((found - y).abs() < 2e-6, "{level}: {found} instead of {y}");
                }
            }
        }
    }

    /// The box with its margins is `resolution` voxels long, and every mip has whole voxels.
    #[test]
    fn volumes_hold_the_box_and_its_margins() {
        // what is small is not far away: places are in single precision
        for (size, x, resolution) in [
            ("(4, 1, 2)", 7.0, 128),
            ("(0.1, 30, 3)", 7.0, 17),
            ("1e-6", 0.0, 256),
        ] {
            let scene = scene(&format!("show(box({size}).move(x = {x}))"));
            let extent = Extent::of(&scene, resolution);
            let bounds = scene.finite_bounds().unwrap();
            assert!(extent.cells.iter().all(|n| n % MARGIN == 0));
            assert_eq!(
                extent.cells.iter().max(),
                Some(&resolution.max(24).next_multiple_of(8))
            );
            for k in 0..3 {
                let margin = f64::from(extent.voxel) * 7.99;
                let (first, wide) = (
                    f64::from(extent.origin[k]),
                    f64::from(extent.cells[k]) * f64::from(extent.voxel),
                );
                assert!(first <= bounds.min[k] - margin && first + wide >= bounds.max[k] + margin);
            }
        }
    }

    /// What has no end has a volume too, and nothing is sampled anew while the field stays.
    #[test]
    fn volumes_are_kept_while_their_field_stays() {
        let text = |height: f32, more: &str| {
            format!(
                "show(sphere(1).move(y = {height}), material(color = \"red\"))\nshow(plane())\nrender(ao = skylight(resolution = 16{more}))"
            )
        };
        let first = scene(&text(1.0, ""));
        let made = SkyVolume::renewed(None, &first, &program(&first))
            .unwrap()
            .unwrap();
        let renewed = |text: &str| {
            let scene = scene(text);
            SkyVolume::renewed(Some(&made), &scene, &program(&scene))
                .unwrap()
                .unwrap()
        };
        assert!(Arc::ptr_eq(
            &made,
            &renewed(&text(1.0, ", strength = 1, bend = 0"))
        ));
        assert!(!Arc::ptr_eq(&made, &renewed(&text(1.5, ""))));
        let coloured = renewed(&text(1.0, ", bleed = 0.5"));
        assert!(coloured.is_coloured && coloured.data.grids.len() == GRIDS);
        let none = scene("show(sphere(1))");
        assert!(
            SkyVolume::renewed(Some(&made), &none, &program(&none))
                .unwrap()
                .is_none()
        );
        volume("show(plane())\nrender(ao = skylight(resolution = 16))");
    }

    /// No stranger's field takes for ever.
    #[test]
    fn large_fields_are_sampled_at_fewer_places() {
        assert_eq!(affordable(128, 8000), 128);
        assert_eq!(affordable(256, 8000), 128);
        assert_eq!(affordable(256, 2_500_000), 16);
        for resolution in 16..=256 {
            let n = u64::from(affordable(resolution, 1_000_000));
            assert!(n <= 24 || n.pow(3) * 1_000_000 <= WORK);
        }
    }

    #[test]
    fn closed_places_get_what_the_strength_says() {
        let reading = Reading::new(0.25, 2.0, 3.0, 0.5, 1.0);
        assert_eq!(reading.first, 0.5);
        let far: f32 = EVANS
            .iter()
            .enumerate()
            .map(|(i, w)| w * 0.5 * (1 << i) as f32)
            .sum();
        let closed: Vec3<f32> = light(Vec3::splat(-far), reading.scale);
        assert!((closed.x - (-3f32).exp()).abs() < 1e-6);
        // what is white takes nothing of the light
        let white = EVANS.iter().map(|w| w * reading.bleed).sum::<f32>();
        assert!((white - far).abs() < 1e-5);
        let (open, tint) = split(v3(0.9, 0.3, 0.6f32));
        assert!((open - 0.6).abs() < 1e-6 && (tint.x * open - 0.9).abs() < 1e-6);
    }
}
