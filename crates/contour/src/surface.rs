//! From blocks to a closed mesh.

use crate::blocks::{Block, check};
use crate::grid::{BLOCK, Grid, key};
use crate::patch::{FACES, Patches, cuts_odd, edge, is_ambiguous};
use crate::place::vertices;
use crate::sample::{Room, Sampled, cell_number, cell_place};
use crate::sampler::Sampler;
use crate::vector::{V, add, cross, dot, length, scale, single, sub, wide};
use crate::watch::Watch;
use crate::{ContourError, Surface};
use rayon::prelude::*;
use std::collections::HashMap;
use zeroset_cells::Cells;
use zeroset_field::program::Program;

/// Blocks by where they are.
pub(crate) struct Blocks<'p> {
    pub(crate) program: &'p Program,
    pub(crate) cells: Option<&'p Cells>,
    pub(crate) grid: &'p Grid,
    all: Vec<Sampled>,
    numbers: HashMap<u64, u32>,
}

impl<'p> Blocks<'p> {
    /// Samples these blocks, and those into which the surface goes on from them.
    pub(crate) fn new(
        program: &'p Program,
        cells: Option<&'p Cells>,
        grid: &'p Grid,
        found: Vec<Block>,
        most: u64,
        watch: &dyn Watch,
    ) -> Result<Blocks<'p>, ContourError> {
        let mut blocks = Blocks {
            program,
            cells,
            grid,
            all: Vec::new(),
            numbers: HashMap::new(),
        };
        let mut next = found;
        while !next.is_empty() {
            let count = blocks.all.len() + next.len();
            check(count as u64, most)?;
            let make = || (Sampler::new(program, cells), Room::default());
            let sampled: Vec<Sampled> = (next.into_par_iter())
                .map_init(make, |(sampler, room), block| {
                    if watch.is_stopped() {
                        // what is left is not looked at any more
                        return Sampled::nothing(block);
                    }
                    Sampled::new(block, program, grid, sampler, room)
                })
                .collect();
            if watch.is_stopped() {
                return Err(ContourError::Stopped);
            }
            let from = blocks.all.len();
            for block in sampled {
                blocks
                    .numbers
                    .insert(key(block.block.at), blocks.all.len() as u32);
                blocks.all.push(block);
            }
            next = blocks.missing(from);
        }
        if blocks.all.iter().any(|b| b.leaves) {
            return Err(ContourError::Leaves);
        }
        blocks.pair_ambiguous();
        Ok(blocks)
    }

    /// Blocks that the surface reaches from those behind the first `from` and that are not there: where a field is no bound, or a range
    /// does not say all, it may be in a block that was passed over. So the mesh is closed whatever the field says of itself.
    fn missing(&self, from: usize) -> Vec<Block> {
        let mut wanted: Vec<[u32; 3]> = Vec::new();
        for sampled in &self.all[from..] {
            for bit in (0..27_u32).filter(|bit| sampled.reaches >> bit & 1 == 1) {
                let by = [bit % 3, bit / 3 % 3, bit / 9];
                let at = sampled.block.at;
                let beside: Option<Vec<u32>> =
                    (0..3).map(|k| (at[k] + by[k]).checked_sub(1)).collect();
                let Some(&[x, y, z]) = beside.as_deref() else {
                    continue;
                };
                if !self.numbers.contains_key(&key([x, y, z])) {
                    wanted.push([x, y, z]);
                }
            }
        }
        wanted.sort_unstable();
        wanted.dedup();
        let code = std::sync::Arc::new(self.program.values().code.clone());
        let block = |at| Block {
            at,
            code: std::sync::Arc::clone(&code),
        };
        wanted.into_iter().map(block).collect()
    }

    fn block(&self, at: [u32; 3]) -> Option<usize> {
        self.numbers.get(&key(at)).map(|n| *n as usize)
    }

    /// The block of a cell of the grid, and its number there.
    fn locate(&self, cell: [u32; 3]) -> Option<(usize, u16)> {
        let block = self.block(cell.map(|n| n / BLOCK))?;
        Some((block, cell_number(cell.map(|n| n % BLOCK))))
    }

    fn cell_at(&self, block: &Sampled, local: u16) -> [u32; 3] {
        let place = cell_place(local);
        std::array::from_fn(|k| block.block.at[k] * BLOCK + place[k])
    }

    /// Decides how faces with alternating signs are paired: as the field in their middle says and, where both cells of a face would have one
    /// patch with both of its pairs, the other way. An edge of the mesh is a pair of crossings of a face, between a patch of either cell;
    /// two pairs between the same patches would be an edge of four faces. Paired the other way, both cells have two patches there
    /// (`patch::tests` has all cases), and nothing that was apart is joined: so one pass is enough, and the mesh is manifold.
    fn pair_ambiguous(&mut self) {
        // a face belongs to the cell above it
        let mut faces: Vec<([u32; 3], usize)> = Vec::new();
        for block in &self.all {
            for cell in &block.cells {
                for face in (0..FACES).filter(|f| is_ambiguous(cell.mask, *f)) {
                    let mut at = self.cell_at(block, cell.local);
                    at[face / 2] += (face % 2) as u32;
                    faces.push((at, face / 2));
                }
            }
        }
        if faces.is_empty() {
            return;
        }
        faces.sort_unstable();
        faces.dedup();
        let middles: Vec<[f32; 3]> = (faces.iter())
            .map(|(at, axis)| {
                let half = |k: usize| if k == *axis { 0.0 } else { 0.5 };
                std::array::from_fn(|k| self.grid.along(k, f64::from(at[k]) + half(k)))
            })
            .collect();
        let mut values = vec![0.0; middles.len()];
        Sampler::new(self.program, self.cells).whole_values(&middles, &mut values);
        let mut odd: HashMap<(u64, usize), bool> = HashMap::new();
        for ((at, axis), value) in faces.iter().zip(values) {
            if let Some((block, local)) = self.locate(*at)
                && let Some(cell) = self.all[block].cell(local)
            {
                let cuts = cuts_odd(cell.mask, 2 * axis, value < 0.0);
                odd.insert((key(*at), *axis), cuts);
            }
        }
        let mut touched: Vec<[u32; 3]> = Vec::new();
        for (at, axis) in &faces {
            touched.push(*at);
            let mut below = *at;
            below[*axis] = below[*axis].saturating_sub(1);
            touched.push(below);
        }
        touched.sort_unstable();
        touched.dedup();
        for at in touched {
            self.patch(at, &odd);
        }
        for (at, axis) in faces {
            let mut below = at;
            below[axis] = below[axis].saturating_sub(1);
            let is_one = |cell: [u32; 3], face: usize| {
                self.locate(cell)
                    .and_then(|(block, local)| self.all[block].cell(local))
                    .is_some_and(|cell| cell.patches.is_one_on(face))
            };
            if is_one(at, 2 * axis) && is_one(below, 2 * axis + 1) {
                if let Some(cuts) = odd.get_mut(&(key(at), axis)) {
                    *cuts = !*cuts;
                }
                self.patch(at, &odd);
                self.patch(below, &odd);
            }
        }
    }

    /// Finds the patches of a cell anew.
    fn patch(&mut self, at: [u32; 3], odd: &HashMap<(u64, usize), bool>) {
        let Some((block, local)) = self.locate(at) else {
            return;
        };
        let cells = &mut self.all[block].cells;
        let Ok(number) = cells.binary_search_by_key(&local, |c| c.local) else {
            return;
        };
        let cell = &mut cells[number];
        cell.patches = Patches::new(cell.mask, |face| {
            let mut owner = at;
            owner[face / 2] += (face % 2) as u32;
            odd.get(&(key(owner), face / 2))
                .copied()
                .unwrap_or_default()
        });
    }

    /// The vertices, a patch each, and the faces: around each edge of the grid that is crossed four patches, as two triangles.
    pub(crate) fn surface(
        mut self,
        most_faces: u64,
        watch: &dyn Watch,
    ) -> Result<Surface, ContourError> {
        let mut count = 0_u64;
        for block in &mut self.all {
            for cell in &mut block.cells {
                cell.first = count as u32;
                count += u64::from(cell.patches.count);
            }
        }
        // a closed surface has about twice as many faces as vertices
        let faces = 2 * count;
        if faces > most_faces || count > u64::from(u32::MAX) {
            return Err(ContourError::Faces {
                given: faces,
                most: most_faces,
            });
        }
        let make = || (Sampler::new(self.program, self.cells), Room::default());
        let points: Vec<Vec<[f32; 3]>> = (self.all.par_iter())
            .map_init(make, |(sampler, _), block| {
                if watch.is_stopped() {
                    return Vec::new();
                }
                vertices(block, self.program, self.grid, sampler)
            })
            .collect();
        if watch.is_stopped() {
            return Err(ContourError::Stopped);
        }
        let points: Vec<[f32; 3]> = points.into_iter().flatten().collect();
        let quads: Vec<Vec<[u32; 4]>> = (self.all.par_iter())
            .map(|block| self.quads(block))
            .collect();
        let quads: Vec<[u32; 4]> = quads.into_iter().flatten().collect();
        let faces: Vec<Vec<[u32; 3]>> = (quads.par_chunks(CHUNK))
            .map_init(make, |(sampler, room), quads| {
                cut(&points, quads, sampler, room)
            })
            .collect();
        Ok(Surface {
            points,
            faces: faces.into_iter().flatten().collect(),
        })
    }

    /// Four vertices around each edge of the grid that a block owns, counter-clockwise seen from outside.
    fn quads(&self, block: &Sampled) -> Vec<[u32; 4]> {
        let mut quads = Vec::new();
        for local in 0..(BLOCK * BLOCK * BLOCK) as u16 {
            let place = cell_place(local);
            for axis in 0..3 {
                let node = place.map(|n| n as usize);
                let Some(crossing) = block.crossing(node, axis) else {
                    continue;
                };
                let at = self.cell_at(block, local);
                let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                // counter-clockwise seen from where the axis points to
                let around = [(0, 0), (1, 0), (1, 1), (0, 1)];
                let vertex = |(i, j): (u32, u32)| {
                    let mut cell = at;
                    cell[b] = cell[b].checked_sub(i)?;
                    cell[c] = cell[c].checked_sub(j)?;
                    let (number, local) = self.locate(cell)?;
                    let cell = self.all[number].cell(local)?;
                    let patch = cell.patches.of(edge(axis, i as usize, j as usize));
                    Some(cell.first + u32::from(patch))
                };
                let [Some(p), Some(q), Some(r), Some(s)] = around.map(vertex) else {
                    continue;
                };
                quads.push(if crossing.low_is_inside {
                    [p, q, r, s]
                } else {
                    [p, s, r, q]
                });
            }
        }
        quads
    }
}

/// Quads that are cut together.
const CHUNK: usize = 512;

/// Cuts quads into triangles along the diagonal that is nearer to the surface.
fn cut(
    points: &[[f32; 3]],
    quads: &[[u32; 4]],
    sampler: &mut Sampler<'_>,
    room: &mut Room,
) -> Vec<[u32; 3]> {
    let at = |v: u32| wide(points[v as usize]);
    room.points.clear();
    for [p, q, r, s] in quads {
        for (a, b) in [(p, r), (q, s)] {
            room.points.push(single(scale(add(at(*a), at(*b)), 0.5)));
        }
    }
    sampler.whole_slopes(&room.points, &mut room.slopes);
    let mut faces = Vec::with_capacity(2 * quads.len());
    for (i, &[p, q, r, s]) in quads.iter().enumerate() {
        let ways = [[[p, q, r], [p, r, s]], [[q, r, s], [q, s, p]]];
        let normals = ways.map(|way| way.map(|f| normal(f.map(at))));
        // folded over, it is the wrong diagonal whatever the field says
        let folds = normals.map(|[a, b]| dot(a, b) < 0.0);
        let off = [0, 1].map(|k| room.slopes[2 * i + k].distance.abs());
        let lengths = [length(sub(at(p), at(r))), length(sub(at(q), at(s)))];
        let close = 1e-5 * lengths[0].max(lengths[1]);
        let second = if folds[0] != folds[1] {
            folds[0]
        } else if (off[0] - off[1]).abs() > close {
            off[1] < off[0]
        } else {
            lengths[1] < lengths[0]
        };
        faces.extend(ways[usize::from(second)]);
    }
    faces
}

/// Twice the area of a triangle along its normal.
pub(crate) fn normal([a, b, c]: [V; 3]) -> V {
    cross(sub(b, a), sub(c, a))
}
