//! From samples to pixels: every sample counts for the pixels around it as much as the filter says.
//!
//! A tile adds its samples up in sums of its own, which reach two pixels over its edges. Once all tiles are done, a pixel
//! takes the sums of the tiles around it in the order of their numbers: the result does not depend on threads.

use crate::planes::Planes;
use crate::simd::{fma, load, load3, splat, store};
use crate::tile::{Area, HEIGHT, WIDTH};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::{Lanes, Ops, Real};
use zeroset_scene::accumulator::Sum;
use zeroset_scene::settings::Filter;
use zeroset_shade::sampling::{radius, weight};

/// Pixels that sums reach over the edge of a tile: as many as the widest filter.
const MARGIN: usize = 2;
/// Numbers in a row of sums: the tile, both margins, and room for the last vector.
const STRIDE: usize = WIDTH + 2 * MARGIN + 28;
const ROWS: usize = HEIGHT + 2 * MARGIN;
/// Sums of red, green, blue, coverage and weight.
const CHANNELS: usize = 5;
const CHANNEL: usize = STRIDE * ROWS;
/// Numbers in the sums of a tile.
pub(crate) const ACCUMULATORS: usize = CHANNELS * CHANNEL;

/// Adds one sample of every pixel of the tile.
pub(crate) fn splat_samples<S: Simd>(
    s: S,
    filter: Filter,
    area: &Area,
    planes: &Planes,
    sums: &mut [f32],
) {
    match filter {
        Filter::Box => add::<S, 1>(s, filter, area, planes, sums),
        Filter::Tent => add::<S, 3>(s, filter, area, planes, sums),
        Filter::Mitchell => add::<S, 5>(s, filter, area, planes, sums),
    }
}

fn add<S: Simd, const TAPS: usize>(
    s: S,
    filter: Filter,
    area: &Area,
    planes: &Planes,
    sums: &mut [f32],
) {
    s.vectorize(
        #[inline(always)]
        || {
            let reach = radius(filter);
            let ramp = Lanes(S::f32s::from_fn(
                s,
                #[inline(always)]
                |k| k as f32,
            ));
            for y in 0..area.height {
                for x in (0..area.width).step_by(S::f32s::LEN) {
                    let at = y * WIDTH + x;
                    // lanes right of the picture weigh nothing
                    let inside = (ramp + x as f32).below(area.width as f32);
                    let one = Lanes::select(inside, splat(s, 1.0), splat(s, 0.0));
                    let (u, v) = (
                        load(s, &planes.jitter[0], at) - 0.5,
                        load(s, &planes.jitter[1], at) - 0.5,
                    );
                    let (mut across, mut down) = ([one; TAPS], [one; TAPS]);
                    for k in 0..TAPS {
                        let tap = k as f32 - reach as f32;
                        across[k] = weight(filter, u - tap) * one;
                        down[k] = weight(filter, v - tap);
                    }
                    let c = load3(s, &planes.colour, at);
                    let values = [c.x, c.y, c.z, load(s, &planes.coverage, at), splat(s, 1.0)];
                    for dx in 0..TAPS {
                        for channel in 0..CHANNELS {
                            let part = values[channel] * across[dx];
                            for dy in 0..TAPS {
                                let row = y + MARGIN - reach + dy;
                                let to = channel * CHANNEL + row * STRIDE + x + MARGIN - reach + dx;
                                store(fma(part, down[dy], load(s, sums, to)), sums, to);
                            }
                        }
                    }
                }
            }
        },
    );
}

/// Adds to the colour, coverage and weight of band number `k` of a picture the sums of the tiles around it; `sums` begin with those
/// of row number `first` of tiles.
pub(crate) fn band(
    k: usize,
    sums: &[f32],
    first: usize,
    size: [u32; 2],
    band: &mut [(Sum, &mut [f32])],
) {
    let (width, height) = (size[0] as usize, size[1] as usize);
    let (across, down) = (width.div_ceil(WIDTH), height.div_ceil(HEIGHT));
    let mut row = [const { [0.0f32; WIDTH] }; CHANNELS];
    for tile in 0..across {
        let area = Area::of(k * across + tile, size);
        for y in 0..area.height {
            row.iter_mut().for_each(|r| r.fill(0.0));
            for ty in k.saturating_sub(1)..(k + 2).min(down) {
                // the row of sums that this row of pixels is for that tile
                let line = (y + k * HEIGHT + MARGIN).wrapping_sub(ty * HEIGHT);
                if line >= ROWS {
                    continue;
                }
                for tx in tile.saturating_sub(1)..(tile + 2).min(across) {
                    let sums = &sums[((ty - first) * across + tx) * ACCUMULATORS..][..ACCUMULATORS];
                    // pixel x of this tile is number x + shift in that tile's row
                    let shift = (tile * WIDTH + MARGIN) as isize - (tx * WIDTH) as isize;
                    let from = (-shift).max(0) as usize;
                    let to = (area.width as isize)
                        .min((WIDTH + 2 * MARGIN) as isize - shift)
                        .max(0) as usize;
                    for (channel, row) in row.iter_mut().enumerate() {
                        let line = &sums[channel * CHANNEL + line * STRIDE..][..STRIDE];
                        for x in from..to {
                            row[x] += line[(x as isize + shift) as usize];
                        }
                    }
                }
            }
            let at = y * width + area.x;
            for (sum, numbers) in band.iter_mut() {
                let of = match sum {
                    Sum::Colour => &row[..3],
                    Sum::Coverage => &row[3..4],
                    Sum::Weight => &row[4..5],
                    _ => continue,
                };
                for (c, of) in of.iter().enumerate() {
                    for x in 0..area.width {
                        numbers[(at + x) * sum.channels() + c] += of[x];
                    }
                }
            }
        }
    }
}
