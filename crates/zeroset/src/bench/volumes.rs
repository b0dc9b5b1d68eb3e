//! `bench volumes`: a scene of moving bodies, composed by touched bricks on all cores and from scratch with one thread, and lit.

use serde::Serialize;
use std::sync::Arc;
use std::time::Instant;
use zeroset_number::Grid;
use zeroset_scene::camera::{Camera, Lens};
use zeroset_shade::skylight::{COLOURED, Extent, Reading, SkyVolume};
use zeroset_trace::volume::picture;
use zeroset_volume::compose::{
    Body, BodyError, Bottom, Heights, Lattice, LocalGrid, NOBODY, Pose, SceneVolume, Shape, Star,
};

/// Voxels of the volume along each axis.
const VOXELS: u32 = 128;
/// Side of the volume, scene units.
const SIDE: f32 = 3.2;
/// Bodies of each of five kinds.
const OF_KIND: usize = 4;
/// Frames that are measured.
const FRAMES: usize = 12;
/// Size of their pictures.
const SIZE: [u32; 2] = [640, 480];

/// What `bench volumes` measures.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Volumes {
    /// Voxels along each axis.
    pub voxels: u32,
    /// Bodies that move.
    pub bodies: usize,
    /// Threads.
    pub threads: usize,
    /// Bricks of the volume.
    pub bricks: usize,
    /// Bricks that are written a frame, on average.
    pub bricks_touched: f64,
    /// Milliseconds to compose a frame from scratch, with one thread.
    pub milliseconds_from_scratch: f64,
    /// Milliseconds to compose it by the bricks that are touched, with all.
    pub milliseconds_touched: f64,
    /// How many times as fast that is.
    pub speedup: f64,
    /// Milliseconds to make the mips and their colours, with all threads.
    pub milliseconds_mips: f64,
    /// Milliseconds to render a picture, with all threads.
    pub milliseconds_picture: f64,
    /// Frames a second: composed, with mips, and rendered.
    pub frames_per_second: f64,
    /// Whether both volumes are equal to the bit.
    pub same_volume: bool,
}

/// Shapes of all kinds.
fn shapes() -> Result<Vec<Shape>, BodyError> {
    let (n, bumps) = (33, |x: f32| 0.12 + 0.05 * (7.0 * x).sin());
    let samples = (0..n * n * n).map(|k: u32| {
        let at = |c: u32| 2.0 * (c % n) as f32 / (n - 1) as f32 - 1.0;
        let [x, y, z] = [at(k), at(k / n), at(k / n / n)].map(|c| 0.4 * c);
        // a ring
        (x.hypot(z) - 0.22).hypot(y) - 0.09
    });
    let grid = Grid::of_points([n; 3], samples.collect()).map_err(|_| BodyError::Map {
        nodes: [n; 2],
        values: 0,
    })?;
    let grid = LocalGrid::new(Arc::new(grid), [-0.4; 3], [0.4; 3])?;
    let map: Vec<f32> = (0..32 * 32)
        .map(|k| {
            let [x, z] = [k % 32, k / 32].map(|c| c as f32 / 15.5 - 1.0);
            bumps(x) * (1.0 - 0.5 * x * x) * (1.0 - 0.5 * z * z)
        })
        .collect();
    let lower = Bottom::Heights(map.iter().map(|y| -y).collect());
    let heights = Heights::new([32; 2], [0.3; 2], &map, &lower, 0.03)?;
    let wave =
        |d: [f32; 3]| 0.22 + 0.07 * (5.0 * d[0]).sin() * (5.0 * d[1]).sin() * (5.0 * d[2]).cos();
    let star = Star::new(32, 0.08, wave)?;
    Ok(vec![
        Shape::Cuboid {
            half: [0.22, 0.16, 0.2],
        },
        Shape::Ellipsoid {
            radii: [0.26, 0.16, 0.2],
        },
        Shape::Grid(Arc::new(grid)),
        Shape::Heights(Arc::new(heights)),
        Shape::Star(Arc::new(star)),
    ])
}

/// The bodies of a frame: each goes around in its own circle and turns.
fn bodies(shapes: &[Shape], frame: usize) -> Result<Vec<Body>, BodyError> {
    let t = frame as f32 / 30.0;
    let one = |k: usize| {
        let phase = 2.399 * k as f32;
        let (radius, height) = (0.35 + 0.2 * (k % 5) as f32, -0.9 + 0.45 * (k / 5) as f32);
        let (sin, cos) = (phase + 0.8 * t).sin_cos();
        let pose = Pose::at([radius * cos, height + 0.1 * (phase + t).sin(), radius * sin])
            .turned([0.6, 0.8, 0.0], phase + t);
        let colour = [0.0, 2.1, 4.2].map(|c: f32| 0.55 + 0.4 * (1.7 * k as f32 + c).sin());
        Body::new(shapes[k % shapes.len()].clone(), pose, colour)
    };
    (0..OF_KIND * shapes.len()).map(one).collect()
}

/// The composed distances with their mips and the colours of what is nearest.
fn lit(volume: &SceneVolume, extent: Extent) -> Result<SkyVolume, String> {
    let [nx, ny, nz] = extent.nodes(0).map(|n| n as usize);
    let mut colours: [Vec<f32>; 3] = std::array::from_fn(|_| Vec::new());
    let step = 1 << COLOURED;
    let colour_of = |body: u16| match body {
        NOBODY => [0.0; 3],
        body => volume.bodies()[usize::from(body)].colour(),
    };
    for k in (0..nz).step_by(step) {
        for j in (0..ny).step_by(step) {
            let row = &volume.nearest()[nx * (j + ny * k)..][..nx];
            for body in row.iter().step_by(step) {
                let colour = colour_of(*body);
                for (out, x) in colours.iter_mut().zip(colour) {
                    out.push(x);
                }
            }
        }
    }
    SkyVolume::of(extent, volume.values().to_vec(), Some(colours)).map_err(|e| e.to_string())
}

/// Measures.
pub(crate) fn volumes() -> Result<Volumes, String> {
    let wrong = |e: &dyn std::fmt::Display| e.to_string();
    let extent = Extent {
        origin: [-0.5 * SIDE; 3],
        voxel: SIDE / VOXELS as f32,
        cells: [VOXELS; 3],
    };
    let lattice = Lattice {
        nodes: extent.nodes(0).map(|n| n as usize),
        origin: extent.origin,
        voxel: extent.voxel,
    };
    // bodies count as far as the farthest sample of skylight
    let reading = Reading::new(extent.voxel, 1.5, 3.0, 0.5, 0.6);
    let reach = 8.0 * reading.first;
    let empty = || SceneVolume::new(lattice, reach).map_err(|e| wrong(&e));
    let shapes = shapes().map_err(|e| wrong(&e))?;
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.map_err(|e| wrong(&e))?;
    let eye = glam::Vec3::new(1.6, 1.3, 3.4);
    let lens = Lens::Pinhole {
        fov: 40f32.to_radians(),
    };
    let camera = Camera::look_at(eye, glam::Vec3::ZERO, glam::Vec3::Y, lens);
    let camera = camera.unwrap_or_default();
    let (mut touched, mut scratch) = (empty()?, empty()?);
    touched
        .compose(&bodies(&shapes, 0).map_err(|e| wrong(&e))?)
        .map_err(|e| wrong(&e))?;
    let (mut times, mut bricks, mut same) = ([0.0; 4], 0, true);
    for frame in 1..=FRAMES {
        let bodies = bodies(&shapes, frame).map_err(|e| wrong(&e))?;
        let mut timed = |which: usize, work: &mut dyn FnMut() -> Result<(), String>| {
            let began = Instant::now();
            let done = work();
            times[which] += began.elapsed().as_secs_f64() * 1e3 / FRAMES as f64;
            done
        };
        timed(0, &mut || {
            one.install(|| scratch.compose_anew(&bodies))
                .map_err(|e| wrong(&e))
        })?;
        timed(1, &mut || {
            bricks += touched.compose(&bodies).map_err(|e| wrong(&e))?;
            Ok(())
        })?;
        same &= touched.values() == scratch.values() && touched.nearest() == scratch.nearest();
        let mut sky = None;
        timed(2, &mut || {
            sky = Some(lit(&touched, extent)?);
            Ok(())
        })?;
        let Some(sky) = sky else { continue };
        timed(3, &mut || {
            let pixels = picture(&sky, &camera, SIZE, &reading, [0.95, 0.97, 1.0]);
            std::hint::black_box(&pixels);
            Ok(())
        })?;
    }
    let [from_scratch, by_bricks, mips, picture] = times;
    Ok(Volumes {
        voxels: VOXELS,
        bodies: OF_KIND * shapes.len(),
        threads: rayon::current_num_threads(),
        bricks: touched.bricks(),
        bricks_touched: bricks as f64 / FRAMES as f64,
        milliseconds_from_scratch: from_scratch,
        milliseconds_touched: by_bricks,
        speedup: from_scratch / by_bricks,
        milliseconds_mips: mips,
        milliseconds_picture: picture,
        frames_per_second: 1e3 / (by_bricks + mips + picture),
        same_volume: same,
    })
}

impl Volumes {
    /// For people.
    pub(crate) fn text(&self) -> String {
        format!(
            "{} moving bodies in {VOXELS}x{VOXELS}x{VOXELS} voxels, {} threads\n\
             from scratch, one thread   {:8.2} ms\n\
             touched bricks, all        {:8.2} ms, {:.2} times as fast, {:.0} of {} bricks\n\
             mips and colours           {:8.2} ms\n\
             a picture of {}x{}      {:8.2} ms, with skylight and colour bleeding\n\
             {:.1} frames a second; {}",
            self.bodies,
            self.threads,
            self.milliseconds_from_scratch,
            self.milliseconds_touched,
            self.speedup,
            self.bricks_touched,
            self.bricks,
            self.milliseconds_mips,
            SIZE[0],
            SIZE[1],
            self.milliseconds_picture,
            self.frames_per_second,
            if self.same_volume {
                "the same volume, to the bit"
            } else {
                "ANOTHER VOLUME"
            },
        )
    }
}
