//! What the field is like on the nodes and edges of a block.

use crate::blocks::Block;
use crate::grid::{BLOCK, Grid, NODES};
use crate::patch::{EDGES, FACES, Mask, Patches, is_ambiguous, parts};
use crate::qef::Plane;
use crate::sampler::{Sampler, Slope};
use crate::vector::{single, wide};
use zeroset_catalogue::tape::Tape;
use zeroset_field::program::Program;

/// Steps of looking for the place where the sign changes.
const STEPS: usize = 14;
/// A place is found when it is known to this share of an edge.
const FOUND: f64 = 1e-6;

/// A cell that the surface goes through.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    /// Its number in the block.
    pub(crate) local: u16,
    pub(crate) mask: Mask,
    pub(crate) patches: Patches,
    /// The vertex of its first patch.
    pub(crate) first: u32,
}

/// Where the surface crosses an edge of the grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Three times the number of its lower node in the block, and its axis.
    edge: u16,
    /// Whether the lower node is inside.
    pub(crate) low_is_inside: bool,
    point: [f32; 3],
    normal: [f32; 3],
}

impl Crossing {
    fn plane(&self) -> Plane {
        Plane {
            point: wide(self.point),
            normal: wide(self.normal),
        }
    }
}

/// A block with what was found in it.
#[derive(Clone, Debug)]
pub(crate) struct Sampled {
    pub(crate) block: Block,
    /// In the order of their numbers.
    pub(crate) cells: Vec<Cell>,
    /// Those on all edges of the block, its borders included, in the order of the edges.
    crossings: Vec<Crossing>,
    /// Which blocks around it the surface reaches: a bit for each of the 27 about it.
    pub(crate) reaches: u32,
    /// Whether a node on the outermost border of the grid was inside.
    pub(crate) leaves: bool,
}

/// The number of a node of a block.
fn node(at: [usize; 3]) -> usize {
    at[0] + NODES * (at[1] + NODES * at[2])
}

/// The number of a cell of a block.
pub(crate) fn cell_number(at: [u32; 3]) -> u16 {
    (at[0] + BLOCK * (at[1] + BLOCK * at[2])) as u16
}

/// The place of a cell in its block.
pub(crate) fn cell_place(number: u16) -> [u32; 3] {
    let n = u32::from(number);
    [n % BLOCK, n / BLOCK % BLOCK, n / (BLOCK * BLOCK)]
}

impl Sampled {
    /// The crossing of an edge, by its lower node and axis.
    pub(crate) fn crossing(&self, at: [usize; 3], axis: usize) -> Option<&Crossing> {
        let wanted = (3 * node(at) + axis) as u16;
        let found = self.crossings.binary_search_by_key(&wanted, |c| c.edge);
        found.ok().map(|i| &self.crossings[i])
    }

    /// The crossing of an edge of a cell.
    pub(crate) fn crossing_of(&self, cell: u16, number: usize) -> Option<&Crossing> {
        let (axis, b, c) = parts(number);
        let mut at = cell_place(cell).map(|n| n as usize);
        at[(axis + 1) % 3] += b;
        at[(axis + 2) % 3] += c;
        self.crossing(at, axis)
    }

    /// The cell of this number, if the surface goes through it.
    pub(crate) fn cell(&self, number: u16) -> Option<&Cell> {
        let found = self.cells.binary_search_by_key(&number, |c| c.local);
        found.ok().map(|i| &self.cells[i])
    }

    /// A block that was not looked at.
    pub(crate) fn nothing(block: Block) -> Sampled {
        Sampled {
            block,
            cells: Vec::new(),
            crossings: Vec::new(),
            reaches: 0,
            leaves: false,
        }
    }

    /// Samples a block.
    pub(crate) fn new(
        block: Block,
        program: &Program,
        grid: &Grid,
        sampler: &mut Sampler<'_>,
        room: &mut Room,
    ) -> Sampled {
        let tape = Tape {
            code: &block.code,
            data: program.data(),
        };
        let first = block.at.map(|n| n * BLOCK);
        let global =
            |at: [usize; 3]| -> [u32; 3] { std::array::from_fn(|k| first[k] + at[k] as u32) };
        room.points.clear();
        for at in nodes() {
            room.points.push(grid.node(global(at)));
        }
        room.values.resize(room.points.len(), 0.0);
        sampler.values(tape, &room.points, &mut room.values);
        // beyond the grid all is outside: what ends there is closed there
        let is_border = |at: [usize; 3]| {
            let at = global(at);
            (0..3).any(|k| at[k] == 0 || at[k] >= grid.cells[k])
        };
        let mut leaves = false;
        let mut inside = [false; NODES * NODES * NODES];
        for (i, at) in nodes().enumerate() {
            // what is no number is no solid
            inside[i] = room.values[i] < 0.0;
            if inside[i] && is_border(at) {
                (inside[i], leaves) = (false, true);
                room.values[i] = f32::MIN_POSITIVE;
            }
        }
        let cells = cells(&inside);
        let (mut crossings, mut reaches) = (Vec::new(), 0);
        room.spans.clear();
        for at in nodes() {
            for axis in 0..3 {
                let low = node(at);
                let mut above = at;
                above[axis] += 1;
                if above[axis] >= NODES || inside[low] == inside[node(above)] {
                    continue;
                }
                crossings.push(Crossing {
                    edge: (3 * low + axis) as u16,
                    low_is_inside: inside[low],
                    point: room.points[low],
                    normal: [0.0; 3],
                });
                let (a, b) = (low, node(above));
                room.spans.push(Span {
                    from: room.points[a],
                    axis,
                    low: 0.0,
                    high: 1.0,
                    length: f64::from(room.points[b][axis]) - f64::from(room.points[a][axis]),
                    values: [a, b].map(|i| f64::from(room.values[i])),
                    last: None,
                });
                reaches |= reached(at, axis);
            }
        }
        find_crossings(tape, sampler, room, &mut crossings);
        Sampled {
            block,
            cells,
            crossings,
            reaches,
            leaves,
        }
    }
}

/// The nodes of a block in the order of their numbers.
fn nodes() -> impl Iterator<Item = [usize; 3]> {
    (0..NODES * NODES * NODES).map(|i| [i % NODES, i / NODES % NODES, i / (NODES * NODES)])
}

/// The blocks that an edge of a block touches: bits of the 27 around it.
fn reached(at: [usize; 3], axis: usize) -> u32 {
    let last = BLOCK as usize;
    let span = |k: usize| {
        if k == axis {
            return 1..=1;
        }
        match at[k] {
            0 => 0..=1,
            n if n == last => 1..=2,
            _ => 1..=1,
        }
    };
    let mut bits = 0;
    for z in span(2) {
        for y in span(1) {
            for x in span(0) {
                bits |= 1 << (x + 3 * (y + 3 * z));
            }
        }
    }
    bits
}

/// The cells with corners of both signs.
fn cells(inside: &[bool; NODES * NODES * NODES]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for local in 0..(BLOCK * BLOCK * BLOCK) as u16 {
        let at = cell_place(local).map(|n| n as usize);
        let mask = (0..8).fold(0, |mask, corner: usize| {
            let at = std::array::from_fn(|k| at[k] + (corner >> k & 1));
            mask | u8::from(inside[node(at)]) << corner
        });
        if mask == 0 || mask == 255 {
            continue;
        }
        // ambiguous faces are looked at when all blocks are there
        let ambiguous = (0..FACES).any(|face| is_ambiguous(mask, face));
        let patches = match ambiguous {
            true => Patches::default(),
            false => Patches::new(mask, |_| false),
        };
        cells.push(Cell {
            local,
            mask,
            patches,
            first: 0,
        });
    }
    cells
}

/// Memory that is used for one block after the other.
#[derive(Default)]
pub(crate) struct Room {
    pub(crate) points: Vec<[f32; 3]>,
    pub(crate) values: Vec<f32>,
    pub(crate) slopes: Vec<Slope>,
    spans: Vec<Span>,
}

/// A part of an edge in which the sign changes.
struct Span {
    from: [f32; 3],
    axis: usize,
    low: f64,
    high: f64,
    length: f64,
    /// At both ends.
    values: [f64; 2],
    /// The end that was moved last.
    last: Option<bool>,
}

impl Span {
    fn at(&self, t: f64) -> [f32; 3] {
        let mut p = self.from;
        p[self.axis] = (f64::from(p[self.axis]) + t * self.length) as f32;
        p
    }

    /// Where a line through both values is zero; within the span, whatever they are.
    fn guess(&self) -> f64 {
        let [a, b] = self.values;
        let t = self.low + (self.high - self.low) * (a / (a - b));
        if t > self.low && t < self.high {
            t
        } else {
            0.5 * (self.low + self.high)
        }
    }

    /// Takes the value at a place within.
    fn take(&mut self, t: f64, value: f64, step: usize) {
        let is_low = (value < 0.0) == (self.values[0] < 0.0);
        let (kept, moved) = match is_low {
            true => (1, 0),
            false => (0, 1),
        };
        *(if is_low {
            &mut self.low
        } else {
            &mut self.high
        }) = t;
        self.values[moved] = if value.is_finite() {
            value
        } else {
            self.values[moved]
        };
        // the other end counts half where the same one is moved again (Illinois: Dowell and Jarratt 1971)
        if self.last == Some(is_low) && step > 0 {
            self.values[kept] *= 0.5;
        }
        self.last = Some(is_low);
    }

    fn is_found(&self) -> bool {
        self.high - self.low < FOUND
    }
}

/// Finds where the sign changes on each edge, and the normal there.
fn find_crossings(
    tape: Tape<'_>,
    sampler: &mut Sampler<'_>,
    room: &mut Room,
    crossings: &mut [Crossing],
) {
    let mut open: Vec<usize> = (0..room.spans.len()).collect();
    let mut best: Vec<(f64, f64)> = (room.spans.iter())
        .map(|s| match s.values[0].abs() <= s.values[1].abs() {
            true => (0.0, s.values[0].abs()),
            false => (1.0, s.values[1].abs()),
        })
        .collect();
    for step in 0..STEPS {
        if open.is_empty() {
            break;
        }
        // every third step halves the span, so that none stays wide
        let t: Vec<f64> = (open.iter())
            .map(|i| &room.spans[*i])
            .map(|s| {
                if step % 3 == 2 {
                    0.5 * (s.low + s.high)
                } else {
                    s.guess()
                }
            })
            .collect();
        room.points.clear();
        room.points
            .extend(open.iter().zip(&t).map(|(i, t)| room.spans[*i].at(*t)));
        room.values.resize(room.points.len(), 0.0);
        sampler.values(tape, &room.points, &mut room.values);
        for (k, i) in open.iter().enumerate() {
            let value = f64::from(room.values[k]);
            if value.abs() < best[*i].1 {
                best[*i] = (t[k], value.abs());
            }
            room.spans[*i].take(t[k], value, step);
        }
        open.retain(|i| best[*i].1 > 0.0 && !room.spans[*i].is_found());
    }
    room.points.clear();
    for (span, (t, _)) in room.spans.iter().zip(&best) {
        // the value says where within the span; outside of it there was a better one on the other side of a jump
        let t = t.clamp(span.low, span.high);
        room.points.push(span.at(t));
    }
    sampler.slopes(tape, &room.points, &mut room.slopes);
    for (k, crossing) in crossings.iter_mut().enumerate() {
        let mut normal = room.slopes[k].normal;
        if normal == [0.0; 3] || !normal.iter().all(|x| x.is_finite()) {
            normal = [0.0; 3];
            normal[room.spans[k].axis] = if crossing.low_is_inside { 1.0 } else { -1.0 };
        }
        crossing.point = room.points[k];
        crossing.normal = single(normal);
    }
}

/// The crossings of a patch of a cell.
pub(crate) fn planes(sampled: &Sampled, cell: &Cell, patch: u8, out: &mut Vec<Plane>) {
    out.clear();
    for number in 0..EDGES {
        if cell.patches.of(number) == patch
            && let Some(crossing) = sampled.crossing_of(cell.local, number)
        {
            out.push(crossing.plane());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{edge, ends};

    /// Corners of an edge lie where its crossing is looked for.
    #[test]
    fn edges_of_cells_are_edges_of_blocks() {
        for number in 0..EDGES {
            let (axis, b, c) = parts(number);
            assert_eq!(number, edge(axis, b, c));
            let [low, high] = ends(number);
            assert_eq!(low ^ high, 1 << axis);
            assert_eq!(low >> ((axis + 1) % 3) & 1, b);
            assert_eq!(low >> ((axis + 2) % 3) & 1, c);
        }
    }
}
