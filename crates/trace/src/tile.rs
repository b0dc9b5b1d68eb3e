//! The part of a picture that one thread works on at a time, and all the memory that this takes.

use crate::ao::SharedOcclusion;
use crate::coverage::Coverage;
use crate::lamps::AimColumns;
use crate::march::ITERATIONS;
use crate::order::Sorting;
use crate::path::BounceColumns;
use crate::paths::Paths;
use crate::planes::Planes;
use crate::ray::{Common, Queue, RayColumns, WideRay};
use crate::simd::{Row, SLACK, Sheet, TILE_RAYS, WordRow, WordSheet};
use crate::stop::Stop;
use crate::surface::MaterialColumns;
use fearless_simd::Simd;
use zeroset_cells::Cells;
use zeroset_eval::Workspace;
use zeroset_field::program::Program;
use zeroset_number::{Lanes, Real, Vec3, v3};
use zeroset_scene::progressive::CELL;
use zeroset_scene::render::Evaluations;
use zeroset_shade::closed::Closed;
use zeroset_shade::view::{Region, View};

/// Pixels of a tile from left to right.
pub(crate) const WIDTH: usize = 64;
/// Pixels of a tile from top to bottom.
pub(crate) const HEIGHT: usize = 32;
/// Samples are spread over tiles.
const _: () = assert!(WIDTH as u32 == CELL[0] && HEIGHT as u32 == CELL[1]);

/// Where cells know the slopes of a field, rays may take so many times more steps than by distances.
const PATIENCE: u32 = 4;

/// What a tile covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Area {
    /// Left edge, pixels.
    pub(crate) x: usize,
    /// Top edge, pixels.
    pub(crate) y: usize,
    /// At most [`WIDTH`].
    pub(crate) width: usize,
    /// At most [`HEIGHT`].
    pub(crate) height: usize,
}

impl Area {
    /// Tile number `index` of a picture.
    pub(crate) fn of(index: usize, [width, height]: [u32; 2]) -> Area {
        let (width, height) = (width as usize, height as usize);
        let across = width.div_ceil(WIDTH);
        let (x, y) = (index % across * WIDTH, index / across * HEIGHT);
        Area {
            x,
            y,
            width: WIDTH.min(width - x),
            height: HEIGHT.min(height - y),
        }
    }

    /// Tiles of a picture.
    pub(crate) fn count([width, height]: [u32; 2]) -> usize {
        (width as usize).div_ceil(WIDTH) * (height as usize).div_ceil(HEIGHT)
    }
}

/// What is marched: a field with what its box and the picture say of it.
pub(crate) struct Solid<'a> {
    pub(crate) program: &'a Program,
    /// What is left of the program in parts of space, where that is worth while: of [`Program::marched`] where the surface is `sought`.
    pub(crate) cells: Option<&'a Cells>,
    pub(crate) region: Region,
    pub(crate) view: &'a View,
    /// Evaluations that a ray may take.
    pub(crate) max_steps: u32,
    /// Whether the surface has to be sought by ranges wherever it is not known how far a ray may go: there [`Solid::clearances`] are 0.
    pub(crate) sought: bool,
    /// Whether the field is an estimate of something without an end to its detail: what is under the footprint is a hit.
    pub(crate) fractal: bool,
    /// Whether the field's value can be shown as a distance.
    pub(crate) close: bool,
    /// Whether it is zero at places without thickness, which no secondary ray may take for surfaces.
    pub(crate) skins: bool,
    /// Rays a pixel: each stands for less of it.
    pub(crate) samples: u32,
    /// Solids in closed form beside the program: what meets neither them nor it meets nothing.
    pub(crate) closed: &'a [Closed],
    /// Whether to stop.
    pub(crate) stop: &'a Stop<'a>,
}

impl<'a> Solid<'a> {
    /// `max_steps` of a field whose value is the distance; one that is less gets more of them. `samples`: rays a pixel.
    pub(crate) fn new(
        (program, cells): (&'a Program, Option<&'a Cells>),
        region: Region,
        view: &'a View,
        max_steps: u32,
        skins: bool,
        samples: u32,
        stop: &'a Stop<'a>,
    ) -> Solid<'a> {
        Solid {
            program,
            cells,
            region,
            view,
            max_steps: match cells {
                // by slopes that hold where a ray is, it gets along as by distances
                Some(cells) if cells.has_slopes() => max_steps.saturating_mul(PATIENCE),
                _ => program.patient(max_steps),
            }
            .min(ITERATIONS),
            sought: program.is_unbounded() && !program.is_fractal(),
            fractal: program.is_fractal(),
            close: program.is_close(),
            skins,
            samples,
            closed: &[],
            stop,
        }
    }
}

impl Solid<'_> {
    /// Finds the values of the field at the first `n` points of the workspace: as [`zeroset_eval::values`], to the bit, by cells where
    /// there are any. With [`Solid::gradients`] and [`Solid::marks`] the one way in to the field.
    #[inline(always)]
    pub(crate) fn values<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        match self.cells.filter(|_| !self.sought) {
            Some(cells) => cells.values(s, work, n),
            None => zeroset_eval::values(s, self.program.values(), work, n),
        }
    }

    /// As [`Solid::values`], of what is marched.
    #[inline(always)]
    fn marched<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        match self.cells {
            Some(cells) => cells.values(s, work, n),
            None => zeroset_eval::values(s, self.program.marched().values(), work, n),
        }
    }

    /// How far around each point the field keeps its sign, and on which side of the surface it is: the values, where the field changes by no
    /// more than 1 a unit, or more than that where cells know how steep it is; 0 with that sign where a field without a Lipschitz constant says
    /// nothing.
    #[inline(always)]
    pub(crate) fn clearances<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        self.marched(s, work, n);
        self.widen(work, n);
    }

    /// Makes clearances of what [`Solid::sides`] found, where the surface is sought.
    #[inline(always)]
    pub(crate) fn widen(&self, work: &mut Workspace, n: usize) {
        match self.cells {
            Some(cells) => cells.widen(work, n),
            None if self.sought => {
                let values = &mut work.values_mut().0[..n];
                values.iter_mut().for_each(|f| *f = 0.0_f32.copysign(*f));
            }
            None => {}
        }
    }

    /// Values that tell on which side of the surface points are, and about how far from it compared with each other: [`Solid::clearances`],
    /// where those say something everywhere.
    #[inline(always)]
    pub(crate) fn sides<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        if self.sought {
            self.marched(s, work, n);
        } else {
            self.clearances(s, work, n);
        }
    }

    /// As [`zeroset_eval::gradients`].
    pub(crate) fn gradients<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        match self.cells.filter(|_| !self.sought) {
            Some(cells) => cells.gradients(s, work, n),
            None => zeroset_eval::gradients(s, self.program.values(), work, n),
        }
    }

    /// As [`zeroset_eval::marks`].
    pub(crate) fn marks<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        match self.cells.filter(|_| !self.sought) {
            Some(cells) => cells.marks(s, work, n),
            None => zeroset_eval::marks(s, self.program.marks(), work, n),
        }
    }

    /// The radius of the footprint at the distance `t` of a ray.
    #[inline(always)]
    pub(crate) fn near<R: Real<Scalar = f32>>(&self, ray: &WideRay<R>, t: R) -> R {
        self.view.near(ray.way(t), ray.narrow)
    }

    /// The width of a pixel at the distance `t` of a ray.
    #[inline(always)]
    pub(crate) fn width<R: Real<Scalar = f32>>(&self, ray: &WideRay<R>, t: R) -> R {
        self.view.width(ray.way(t), ray.narrow)
    }
}

/// Rays on their way, one a lane.
pub(crate) struct Rays {
    pub(crate) ray: RayColumns<Row>,
    pub(crate) t: Row,
    pub(crate) z: Row,
    pub(crate) r: Row,
    pub(crate) m: Row,
    /// Behind this there is nothing.
    pub(crate) end: Row,
    /// See [`crate::march`].
    pub(crate) word: WordRow,
    pub(crate) count: usize,
}

/// Secondary rays on their way, one a lane: see [`crate::secondary`].
pub(crate) struct SecondaryRays {
    pub(crate) origin: [Row; 3],
    pub(crate) direction: [Row; 3],
    pub(crate) t: Row,
    pub(crate) z: Row,
    pub(crate) r: Row,
    pub(crate) m: Row,
    /// What is left of the light (soft shadows), the value that counts as dark (hard ones), or the clearance (occlusion).
    pub(crate) light: Row,
    /// Steps are never shorter.
    pub(crate) least: Row,
    pub(crate) end: Row,
    /// See [`crate::march`]; the hit's number in place of the pixel's.
    pub(crate) word: WordRow,
    pub(crate) count: usize,
}

/// Secondary rays that ended.
pub(crate) struct Ended {
    pub(crate) light: Box<Sheet>,
    pub(crate) word: Box<WordSheet>,
    pub(crate) count: usize,
}

/// A ray that ran out of steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exhausted {
    pub(crate) ray: WideRay<f32>,
    /// Up to here nothing was passed.
    pub(crate) t: f32,
    pub(crate) end: f32,
    /// See [`crate::march`].
    pub(crate) word: u32,
}

/// Where rays ended on a surface, in the order in which they did.
pub(crate) struct Hits {
    pub(crate) count: usize,
    pub(crate) rays: RayColumns<Box<Sheet>>,
    /// What the rays have in common.
    pub(crate) common: Common,
    /// Distance along the ray: the last place that is not behind the surface, then the surface.
    pub(crate) t: Box<Sheet>,
    /// How much farther the ray is behind the surface; zero where it ended before.
    pub(crate) beyond: Box<Sheet>,
    /// Value of the field at `t`, from the side that was marched.
    pub(crate) f: Box<Sheet>,
    /// The same behind the surface.
    pub(crate) behind: Box<Sheet>,
    /// Number of the ray in its queue, and side.
    pub(crate) word: Box<WordSheet>,
    /// Evaluations of the ray.
    pub(crate) steps: Box<Sheet>,
    /// Value of the field at the point.
    pub(crate) residual: Box<Sheet>,
    pub(crate) point: [Box<Sheet>; 3],
    pub(crate) normal: [Box<Sheet>; 3],
    /// The normal that light meets: with the heights of bumps.
    pub(crate) shown: [Box<Sheet>; 3],
    /// How far secondary rays start from the surface.
    pub(crate) offset: Box<Sheet>,
    /// The ball of this radius that touches the place where secondary rays start, on the side of the normal, is empty. Zero
    /// where none is known.
    pub(crate) ball: Box<Sheet>,
    pub(crate) object: Box<Sheet>,
    pub(crate) first: Box<Sheet>,
    pub(crate) second: Box<Sheet>,
    pub(crate) share: Box<Sheet>,
    /// How near the orbits of fractals came to their traps.
    pub(crate) orbit: [Box<Sheet>; 4],
    /// Ambient visibility.
    pub(crate) open: Box<Sheet>,
    /// Mean direction that is not occluded, normalised.
    pub(crate) bent: [Box<Sheet>; 3],
    /// See [`zeroset_shade::surface::Lighting::tint`]; only where the scene's volume has colours.
    pub(crate) tint: [Box<Sheet>; 3],
    /// Visibility of all lights.
    pub(crate) shadow: Box<Sheet>,
    /// What the lights would be without shadows.
    pub(crate) shares: Box<Sheet>,
    /// Light that arrives from lights, by the cosine law.
    pub(crate) diffuse: [Box<Sheet>; 3],
    /// Light in the highlight.
    pub(crate) gloss: [Box<Sheet>; 3],
    /// The part of it that the rise of Fresnel's law weighs.
    pub(crate) grazing: [Box<Sheet>; 3],
    pub(crate) material: MaterialColumns,
    /// The share of the reflection that rays follow.
    pub(crate) followed: Box<Sheet>,
    pub(crate) colour: [Box<Sheet>; 3],
}

impl Hits {
    /// The rays of the hits from number `i` on.
    #[inline(always)]
    pub(crate) fn ray<S: Simd>(&self, s: S, i: usize) -> WideRay<Lanes<S>> {
        self.rays.load(s, &self.common, i)
    }

    /// The place of hit number `i`.
    pub(crate) fn point(&self, i: usize) -> Vec3<f32> {
        let [x, y, z] = &self.point;
        v3(x[i], y[i], z[i])
    }

    /// The normal of hit number `i` that light meets.
    pub(crate) fn shown(&self, i: usize) -> Vec3<f32> {
        let [x, y, z] = &self.shown;
        v3(x[i], y[i], z[i])
    }

    /// The normal of hit number `i`.
    pub(crate) fn normal(&self, i: usize) -> Vec3<f32> {
        let [x, y, z] = &self.normal;
        v3(x[i], y[i], z[i])
    }
}

/// Where rays start and end, and the slope of the field where they start.
pub(crate) struct RaySpans {
    pub(crate) start: Box<Sheet>,
    pub(crate) end: Box<Sheet>,
    pub(crate) slope: Box<Sheet>,
    /// Nothing is nearer than this where rays start; negative where they start inside the solid.
    pub(crate) radius: Box<Sheet>,
}

impl RaySpans {
    pub(crate) fn new() -> RaySpans {
        RaySpans {
            start: Sheet::boxed(),
            end: Sheet::boxed(),
            slope: Sheet::boxed(),
            radius: Sheet::boxed(),
        }
    }
}

/// All that a thread needs for its tiles. Made once a thread; a tile allocates nothing.
pub(crate) struct Scratch {
    pub(crate) work: Workspace,
    /// Where in its pixel each ray goes through.
    pub(crate) jitter: [Box<Sheet>; 2],
    /// Where on the lens each ray begins, as a place of the unit square.
    pub(crate) lens: [Box<Sheet>; 2],
    /// Cells, in the end the rays of pixels.
    pub(crate) queue: Queue,
    /// The spans of the cells that are larger by one size.
    pub(crate) parents: RaySpans,
    /// The spans that are being found.
    pub(crate) next: RaySpans,
    pub(crate) rays: Box<Rays>,
    pub(crate) secondary: Box<SecondaryRays>,
    pub(crate) ended: Ended,
    /// How much reaches each hit of what secondary rays look for.
    pub(crate) lit: Box<Sheet>,
    pub(crate) hits: Hits,
    /// Rays that go on from hits.
    pub(crate) paths: Paths,
    /// The parts of pixels.
    pub(crate) coverage: Coverage,
    /// Occlusion that several samples share.
    pub(crate) shared: SharedOcclusion,
    /// How many hits there are of each kind of occlusion.
    pub(crate) ends: Vec<usize>,
    /// Evaluations of the rays that hit nothing, by pixel.
    pub(crate) steps: Box<Sheet>,
    pub(crate) exhausted: Vec<Exhausted>,
    /// Memory to put the hits in another order.
    pub(crate) sorting: Sorting,
    /// Random numbers of the hits.
    pub(crate) scramble: [Vec<u32>; 2],
    /// Where rays towards lights go from the hits.
    pub(crate) towards: [Vec<f32>; 3],
    /// Where lights with an extent are looked for.
    pub(crate) aim: AimColumns,
    /// Where rays go on from them.
    pub(crate) bounce: BounceColumns,
    /// Sines of the clearances of the occlusion's cones.
    pub(crate) clearance: [Box<Sheet>; zeroset_shade::occlusion::CONES],
    pub(crate) planes: Planes,
    pub(crate) counts: Evaluations,
}

fn sheet3() -> [Box<Sheet>; 3] {
    [Sheet::boxed(), Sheet::boxed(), Sheet::boxed()]
}

impl Scratch {
    /// For a program, and another one that is run beside it.
    pub(crate) fn new(program: &Program, beside: Option<&Program>) -> Scratch {
        let row = || Row::ZERO;
        let mut work = Workspace::new(program.values(), program.marks());
        work.make_room(program.marched().values());
        if let Some(beside) = beside {
            work.make_room(beside.values());
            work.make_room(beside.marched().values());
        }
        Scratch {
            work,
            jitter: [Sheet::boxed(), Sheet::boxed()],
            lens: [Sheet::boxed(), Sheet::boxed()],
            queue: Queue::new(),
            parents: RaySpans::new(),
            next: RaySpans::new(),
            rays: Box::new(Rays {
                ray: RayColumns::new(row),
                t: row(),
                z: row(),
                r: row(),
                m: row(),
                end: row(),
                word: *WordRow::boxed(),
                count: 0,
            }),
            secondary: Box::new(SecondaryRays {
                origin: [row(), row(), row()],
                direction: [row(), row(), row()],
                t: row(),
                z: row(),
                r: row(),
                m: row(),
                light: row(),
                least: row(),
                end: row(),
                word: *WordRow::boxed(),
                count: 0,
            }),
            ended: Ended {
                light: Sheet::boxed(),
                word: WordSheet::boxed(),
                count: 0,
            },
            lit: Sheet::boxed(),
            hits: Hits {
                count: 0,
                rays: RayColumns::new(Sheet::boxed),
                common: Common::default(),
                t: Sheet::boxed(),
                beyond: Sheet::boxed(),
                f: Sheet::boxed(),
                behind: Sheet::boxed(),
                word: WordSheet::boxed(),
                steps: Sheet::boxed(),
                residual: Sheet::boxed(),
                point: sheet3(),
                normal: sheet3(),
                shown: sheet3(),
                offset: Sheet::boxed(),
                ball: Sheet::boxed(),
                object: Sheet::boxed(),
                first: Sheet::boxed(),
                second: Sheet::boxed(),
                share: Sheet::boxed(),
                orbit: std::array::from_fn(|_| Sheet::boxed()),
                open: Sheet::boxed(),
                bent: sheet3(),
                tint: sheet3(),
                shadow: Sheet::boxed(),
                shares: Sheet::boxed(),
                diffuse: sheet3(),
                gloss: sheet3(),
                grazing: sheet3(),
                material: MaterialColumns::new(),
                followed: Sheet::boxed(),
                colour: sheet3(),
            },
            paths: Paths::new(),
            coverage: Coverage::new(),
            shared: SharedOcclusion::new(),
            ends: Vec::new(),
            steps: Sheet::boxed(),
            exhausted: Vec::with_capacity(WIDTH * HEIGHT),
            sorting: Sorting::new(),
            scramble: [vec![0; TILE_RAYS + SLACK], vec![0; TILE_RAYS + SLACK]],
            towards: std::array::from_fn(|_| vec![0.0; TILE_RAYS + SLACK]),
            aim: AimColumns::new(),
            bounce: BounceColumns::new(),
            clearance: std::array::from_fn(|_| Sheet::boxed()),
            planes: Planes::new(),
            counts: Evaluations::default(),
        }
    }
}
