//! Pictures of volumes alone: rays march in the distances of a volume, and what they meet is lit by its skylight (Evans 2006, 9.8). This is how a scene is
//! shown that is composed anew for each frame, and has no field.

use fearless_simd::{Level, Simd, prelude::*};
use rayon::prelude::*;
use zeroset_number::{Lanes, Ops, Real, Vec3, at_level, v3};
use zeroset_scene::camera::Camera;
use zeroset_shade::skylight::{Reading, SkyVolume};
use zeroset_shade::view::View;

/// Steps of a ray, at most.
const STEPS: u32 = 96;
/// Distances of bodies are no bounds: of each only so much is stepped.
const CARE: f32 = 0.85;
/// Nearer than so many voxels is met.
const NEAR: f32 = 0.2;

/// Renders a volume with colours: linear red, green and blue of each pixel, row by row from the top, by one ray through its middle. What is met
/// shows its colour in the light of a sky of this colour, and this is also seen behind everything. On the threads that it is called on.
pub fn picture(
    volume: &SkyVolume,
    camera: &Camera,
    size: [u32; 2],
    reading: &Reading,
    sky: [f32; 3],
) -> Vec<f32> {
    let view = View::new(camera, size, 0.5);
    let [width, height] = size.map(|n| n as usize);
    let mut pixels = vec![0.0; 3 * width * height];
    let level = Level::new();
    let rows = pixels.par_chunks_mut(3 * width.max(1)).enumerate();
    rows.for_each(|(y, row)| {
        at_level!(level, s => row_of(s, volume, &view, reading, sky, y, row));
    });
    pixels
}

#[inline(always)]
fn row_of<S: Simd>(
    s: S,
    volume: &SkyVolume,
    view: &View,
    reading: &Reading,
    sky: [f32; 3],
    y: usize,
    row: &mut [f32],
) {
    let lanes = S::f32s::LEN;
    let ramp = Lanes(S::f32s::from_fn(
        s,
        #[inline(always)]
        |k| k as f32,
    ));
    let splat = |c: f32| Lanes(S::f32s::splat(s, c));
    for first in (0..row.len() / 3).step_by(lanes) {
        let x = ramp + (first as f32 + 0.5);
        let ray = view.ray(x, splat(y as f32 + 0.5));
        let (origin, direction) = view.split(ray);
        let seen = along(s, volume, reading, sky, origin, direction);
        let count = lanes.min(row.len() / 3 - first);
        let [r, g, b] = [seen.x.0, seen.y.0, seen.z.0];
        let (r, g, b) = (r.as_slice(), g.as_slice(), b.as_slice());
        for k in 0..count {
            row[3 * (first + k)..][..3].copy_from_slice(&[r[k], g[k], b[k]]);
        }
    }
}

/// What rays see.
#[inline(always)]
fn along<S: Simd>(
    s: S,
    volume: &SkyVolume,
    reading: &Reading,
    sky: [f32; 3],
    origin: Vec3<Lanes<S>>,
    direction: Vec3<Lanes<S>>,
) -> Vec3<Lanes<S>> {
    let splat = |c: f32| Lanes(S::f32s::splat(s, c));
    let voxel = volume.extent.voxel;
    // in voxels, from where the ray comes into the volume to where it leaves
    let (from, way) = (volume.place(origin), direction);
    let cells = volume.extent.cells;
    let (mut start, mut end) = (splat(0.0), splat(f32::MAX));
    for (o, d, n) in [
        (from.x, way.x, cells[0]),
        (from.y, way.y, cells[1]),
        (from.z, way.z, cells[2]),
    ] {
        let over = Lanes::choose(d.abs().below(1e-9), splat(1e9), d.recip());
        let (a, b) = (-o * over, (-o + n as f32) * over);
        start = start.max(a.min(b));
        end = end.min(a.max(b));
    }
    let mut t = start;
    let mut met = splat(0.0);
    for _ in 0..STEPS {
        let p = from + way * t;
        let d = volume.distance(0, p) * (1.0 / voxel);
        let near = d.below(NEAR);
        let live = t.below(end) & met.below(0.5);
        met = Lanes::choose(live & near, splat(1.0), met);
        let going = live & !near;
        if !going.0.any_true() {
            break;
        }
        t = Lanes::choose(going, t + (d * CARE).max(0.25), t);
    }
    let behind = v3(splat(sky[0]), splat(sky[1]), splat(sky[2]));
    let is_met = met.above(0.5);
    if !is_met.0.any_true() {
        return behind;
    }
    let p = from + way * t;
    // in a loop, so that what a sample takes is compiled once
    let mut uphill = Vec3::splat(splat(0.0));
    for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        let by = v3(splat(axis[0]), splat(axis[1]), splat(axis[2]));
        let mut rise = splat(0.0);
        for side in [1.0, -1.0] {
            rise = rise + volume.distance(0, p + by * side) * side;
        }
        uphill = uphill + by * rise;
    }
    let normal = uphill / uphill.length().max(1e-12);
    let place = volume.world(p);
    let light = volume.light(place, normal, reading);
    let own = volume.colour(0, p);
    let shown = own.times(light).times(behind);
    v3(
        Lanes::choose(is_met, shown.x, behind.x),
        Lanes::choose(is_met, shown.y, behind.y),
        Lanes::choose(is_met, shown.z, behind.z),
    )
}
