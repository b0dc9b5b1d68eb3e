//! Where a vertex lies: on the edge or in the corner of the solid that is near, else on the smooth surface.
//!
//! Planes at the crossings of a cell's edges say where faces meet, exactly where these are flat (Ju, Losasso, Schaefer and Warren 2002).
//! Where they are not, an edge is off by what they bend over a cell. So planes are taken again, nearer to where they met: what bends gets
//! flatter, and what is an edge stays one. That also tells edges from smooth places, with no angle that somebody has to choose.

use crate::grid::Grid;
use crate::qef::{Plane, least_cosine, middle, nearest};
use crate::sample::{Sampled, cell_place, planes};
use crate::sampler::{Sampler, Slope};
use crate::vector::{V, add, scale, single, sub, wide};
use zeroset_catalogue::tape::Tape;
use zeroset_field::program::Program;

/// Normals that differ by less than 2.5 degrees over a cell have no edge between them.
const SMOOTH: f64 = 0.999;
/// Planes are taken again so much nearer.
const NEARER: f64 = 0.25;
/// Times that they are.
const AGAIN: usize = 3;
/// Where normals that are so much nearer still differ by this share of what they did, faces meet.
const STILL: f64 = 0.6;
/// Steps towards the smooth surface.
const NEWTON: usize = 3;
/// An edge is believed where it is no farther from the surface than the smooth place, or within this share of the size of where it is.
const BELIEVED: f64 = 2e-4;
/// A vertex may leave its cell by this share of it, where the surface would not be reached otherwise.
const MARGIN: f64 = 0.4;

/// Where a vertex is looked for.
pub(crate) struct Spot {
    low: V,
    high: V,
    planes: Vec<Plane>,
    /// Where faces meet, as far as is known; none where the surface is smooth.
    edge: Option<V>,
    /// The largest angle between its normals.
    angle: f64,
    smooth: V,
}

/// Finds value and direction of the field at points.
pub(crate) type Ask<'a> = &'a mut dyn FnMut(&[[f32; 3]], &mut Vec<Slope>);

impl Spot {
    /// A place within a box, near these planes.
    pub(crate) fn new(low: V, high: V, planes: Vec<Plane>) -> Spot {
        let mut spot = Spot {
            low,
            high,
            edge: None,
            angle: angle(&planes),
            smooth: [0.0; 3],
            planes,
        };
        spot.smooth = spot.clamp(middle(&spot.planes));
        if least_cosine(&spot.planes) < SMOOTH {
            spot.edge = Some(spot.clamp(nearest(&spot.planes)));
        }
        spot
    }

    fn clamp(&self, p: V) -> V {
        std::array::from_fn(|k| {
            if p[k].is_finite() {
                p[k].clamp(self.low[k], self.high[k])
            } else {
                0.5 * (self.low[k] + self.high[k])
            }
        })
    }

    fn size(&self) -> f64 {
        (0..3)
            .map(|k| self.high[k] - self.low[k])
            .fold(0.0, f64::max)
    }

    /// The same with a larger box.
    fn widened(self) -> Spot {
        let by = MARGIN * self.size();
        let (low, high) = (self.low.map(|x| x - by), self.high.map(|x| x + by));
        let edge = self.edge.map(|_| nearest(&self.planes));
        let mut wide = Spot { low, high, ..self };
        wide.edge = edge.map(|e| wide.clamp(e));
        wide
    }
}

fn angle(planes: &[Plane]) -> f64 {
    least_cosine(planes).clamp(-1.0, 1.0).acos()
}

/// The vertices of a block, in the order of its cells and of their patches.
pub(crate) fn vertices(
    sampled: &Sampled,
    program: &Program,
    grid: &Grid,
    sampler: &mut Sampler<'_>,
) -> Vec<[f32; 3]> {
    let tape = Tape {
        code: &sampled.block.code,
        data: program.data(),
    };
    let first = sampled.block.at.map(|n| n * crate::grid::BLOCK);
    let mut spots = Vec::new();
    let mut of_patch = Vec::new();
    for cell in &sampled.cells {
        let at = cell_place(cell.local);
        let low: [u32; 3] = std::array::from_fn(|k| first[k] + at[k]);
        let [low, high] = [low, low.map(|n| n + 1)].map(|at| wide(grid.node(at)));
        for number in 0..cell.patches.count {
            planes(sampled, cell, number, &mut of_patch);
            spots.push(Spot::new(low, high, of_patch.clone()));
        }
    }
    // within the block its own tape says all
    let (mut found, off) = {
        let mut ask = |points: &[[f32; 3]], out: &mut Vec<Slope>| sampler.slopes(tape, points, out);
        look(&mut spots, &mut ask)
    };
    let lost = |i: &usize| off[*i] > BELIEVED * grid.step;
    let lost: Vec<usize> = (0..spots.len()).filter(lost).collect();
    if lost.is_empty() {
        return found;
    }
    let mut spots: Vec<Option<Spot>> = spots.into_iter().map(Some).collect();
    let mut again: Vec<Spot> = (lost.iter())
        .filter_map(|i| spots[*i].take().map(Spot::widened))
        .collect();
    let mut ask = |points: &[[f32; 3]], out: &mut Vec<Slope>| sampler.whole_slopes(points, out);
    let (better, nearer) = choose(&mut again, &mut ask);
    for (k, i) in lost.into_iter().enumerate() {
        if nearer[k] < off[i] {
            found[i] = better[k];
        }
    }
    found
}

/// Finds where the vertices lie, and how far that is from the surface.
pub(crate) fn look(spots: &mut [Spot], ask: Ask<'_>) -> (Vec<[f32; 3]>, Vec<f64>) {
    for round in 0..AGAIN {
        look_nearer(spots, ask, round);
    }
    choose(spots, ask)
}

/// The edge or the smooth place of each, and how far that is from the surface.
fn choose(spots: &mut [Spot], ask: Ask<'_>) -> (Vec<[f32; 3]>, Vec<f64>) {
    let (mut points, mut slopes) = (Vec::new(), Vec::new());
    for _ in 0..NEWTON {
        points.clear();
        points.extend(spots.iter().map(|p| single(p.smooth)));
        ask(&points, &mut slopes);
        for (spot, slope) in spots.iter_mut().zip(&slopes) {
            spot.smooth = spot.clamp(onto(spot.smooth, slope));
        }
    }
    // an edge lies on the surface too, or it is none
    let mut off = |at: &dyn Fn(&Spot) -> V| -> Vec<f64> {
        points.clear();
        points.extend(spots.iter().map(|p| single(at(p))));
        ask(&points, &mut slopes);
        slopes.iter().map(|s| s.distance.abs()).collect()
    };
    let of_edges = off(&|p| p.edge.unwrap_or(p.smooth));
    let of_smooth = off(&|p| p.smooth);
    let chosen = spots.iter().enumerate().map(|(i, spot)| {
        let most = of_smooth[i].max(BELIEVED * spot.size());
        match spot.edge {
            Some(edge) if of_edges[i] <= most => (single(edge), of_edges[i]),
            _ => (single(spot.smooth), of_smooth[i]),
        }
    });
    chosen.unzip()
}

/// A step of Newton's towards the surface.
pub(crate) fn onto(p: V, slope: &Slope) -> V {
    let next = add(p, scale(slope.normal, -slope.distance));
    if next.iter().all(|x| x.is_finite()) {
        next
    } else {
        p
    }
}

/// Takes planes again, nearer to where they met, and finds where they meet now.
fn look_nearer(spots: &mut [Spot], ask: Ask<'_>, round: usize) {
    let mut points: Vec<V> = Vec::new();
    for spot in spots.iter() {
        let Some(edge) = spot.edge else { continue };
        for plane in &spot.planes {
            let near = add(edge, scale(sub(plane.point, edge), NEARER));
            points.push(spot.clamp(near));
        }
    }
    if points.is_empty() {
        return;
    }
    // once onto the surface, and then the plane there
    let (mut asked, mut slopes): (Vec<[f32; 3]>, Vec<Slope>) = (Vec::new(), Vec::new());
    asked.extend(points.iter().map(|p| single(*p)));
    ask(&asked, &mut slopes);
    let mut next = 0;
    for spot in spots.iter().filter(|p| p.edge.is_some()) {
        for _ in &spot.planes {
            points[next] = spot.clamp(onto(points[next], &slopes[next]));
            next += 1;
        }
    }
    asked.clear();
    asked.extend(points.iter().map(|p| single(*p)));
    ask(&asked, &mut slopes);
    let mut next = 0;
    for spot in spots.iter_mut().filter(|p| p.edge.is_some()) {
        for plane in &mut spot.planes {
            let slope = &slopes[next];
            if slope.normal != [0.0; 3] {
                // single precision rounds the point; the plane goes through what was asked
                plane.point = onto(wide(asked[next]), slope);
                plane.normal = slope.normal;
            }
            next += 1;
        }
        let angle = angle(&spot.planes);
        if round == 0 && angle < STILL * spot.angle {
            spot.edge = None;
            spot.smooth = spot.clamp(middle(&spot.planes));
            continue;
        }
        spot.angle = angle;
        spot.edge = Some(spot.clamp(nearest(&spot.planes)));
    }
}
