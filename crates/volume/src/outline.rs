//! Pictures as plane shapes: the line where the brightness passes a level, and the distance from it.

use crate::bake::{BakeError, Watch, unsigned};
use crate::nearest::{Lattice, Nearest};
use crate::volume::VolumeError;
use zeroset_field::sampled::Sampled;
use zeroset_number::{Grid, GridError};

/// Pixels that count as outside around a picture, so that a shape that goes to its side is closed there.
const MARGIN: usize = 2;

/// Why a picture is no shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineError {
    /// It has no line.
    #[error("all of it is {}: there is no line between dark and bright at the level {level}", if *.dark { "dark" } else { "bright" })]
    Blank {
        /// Whether all of it is inside.
        dark: bool,
        /// The brightness that parts both.
        level: f32,
    },
    /// Too many pixels along a side, or none.
    #[error("{}x{} pixels: a shape takes 1 to {most} along each side", .size[0], .size[1], most = Grid::MOST as usize - 2 * MARGIN)]
    Size {
        /// Width and height.
        size: [usize; 2],
    },
    /// The watcher ended it.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// What came out is no volume.
    #[error(transparent)]
    Volume(#[from] VolumeError),
}

/// The plane shape of what is darker than a level in a picture: `width` scene units wide, about the origin. `pixels` are brightnesses,
/// row by row from the top. Between the middles of pixels the brightness is interpolated, so that smooth edges of a picture are
/// smooth edges of the shape; distances are exact from that line.
///
/// # Errors
/// A picture of one side only, or too large.
pub fn shape(
    size: [usize; 2],
    pixels: &[f32],
    level: f32,
    width: f64,
    watch: &dyn Watch,
) -> Result<Sampled, OutlineError> {
    let [w, h] = size;
    let most = Grid::MOST as usize - 2 * MARGIN;
    if w == 0 || h == 0 || w > most || h > most || pixels.len() != w * h {
        return Err(OutlineError::Size { size });
    }
    let nodes = [w + 2 * MARGIN, h + 2 * MARGIN];
    // from the bottom, with a margin that is as bright as can be
    let at = |i: usize, j: usize| {
        let (x, y) = (i.wrapping_sub(MARGIN), j.wrapping_sub(MARGIN));
        if x < w && y < h {
            pixels[x + w * (h - 1 - y)]
        } else {
            1.0_f32.max(2.0 * level)
        }
    };
    let lines = lines(nodes, at, level);
    if lines.is_empty() {
        let dark = pixels.iter().all(|x| *x < level);
        return Err(OutlineError::Blank { dark, level });
    }
    let lattice = Lattice {
        nodes: [nodes[0], nodes[1], 1],
        origin: [0.0; 3],
        step: 1.0,
    };
    let mut layer = vec![f32::MAX; lattice.count()];
    unsigned(
        &Nearest::new(&lines),
        &lattice,
        &mut layer,
        watch,
        [0.0, 1.0],
    )?;
    let pixel = width / w as f64;
    for (i, x) in layer.iter_mut().enumerate() {
        let side = if at(i % nodes[0], i / nodes[0]) < level {
            -pixel
        } else {
            pixel
        };
        *x = (f64::from(*x) * side) as f32;
    }
    let both = [&layer[..], &layer[..]].concat();
    let grid = Grid::new([nodes[0] as u32, nodes[1] as u32, 2], both)
        .map_err(|e: GridError| VolumeError::from(e))?;
    let half = nodes.map(|n| 0.5 * pixel * (n - 1) as f64);
    let shape =
        Sampled::plane(grid.into(), [-half[0], -half[1]], half).map_err(VolumeError::from)?;
    Ok(shape)
}

/// The segments of the level's line (marching squares), as triangles without area.
fn lines(nodes: [usize; 2], at: impl Fn(usize, usize) -> f32, level: f32) -> Vec<[[f64; 3]; 3]> {
    let mut out = Vec::new();
    for j in 0..nodes[1] - 1 {
        for i in 0..nodes[0] - 1 {
            // around the square, counter-clockwise
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let values = corners.map(|(x, y)| at(x, y));
            let mut cuts = Vec::with_capacity(4);
            for k in 0..4 {
                let (a, b) = (values[k], values[(k + 1) % 4]);
                if (a < level) != (b < level) {
                    let t = f64::from((level - a) / (b - a));
                    let (p, q) = (corners[k], corners[(k + 1) % 4]);
                    let mix = |p: usize, q: usize| p as f64 + t * (q as f64 - p as f64);
                    cuts.push([mix(p.0, q.0), mix(p.1, q.1), 0.0]);
                }
            }
            let mut line = |a: usize, b: usize| out.push([cuts[a], cuts[b], cuts[b]]);
            match cuts.len() {
                2 => line(0, 1),
                4 => {
                    // opposite corners: the middle says which of them hang together
                    let middle = values.iter().sum::<f32>() / 4.0;
                    if (middle < level) == (values[0] < level) {
                        line(0, 1);
                        line(2, 3);
                    } else {
                        line(3, 0);
                        line(1, 2);
                    }
                }
                _ => {}
            }
        }
    }
    out
}
