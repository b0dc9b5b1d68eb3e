//! The points of a batch, sorted by the tapes of their cells.

use crate::Cells;
use crate::cell::{Cell, Side};
use zeroset_catalogue::tape::Code;
use zeroset_eval::{BATCH, Lane, Workspace};

/// The points of a batch by tape.
pub(crate) struct Groups<'c> {
    /// The tapes, and where the points of each end in `order`.
    tapes: [Option<(&'c Code, u8)>; BATCH],
    count: usize,
    /// Numbers of the points, those of a tape beside each other and in their order.
    order: [u8; BATCH],
}

/// Numbers of points fit a byte.
const _: () = assert!(BATCH <= 255);

impl<'c> Groups<'c> {
    /// Sorts the first `n` points.
    pub(crate) fn new(cells: &'c Cells, side: Side, points: &[Lane; 3], n: usize) -> Groups<'c> {
        let mut groups = Groups {
            tapes: [None; BATCH],
            count: 0,
            order: [0; BATCH],
        };
        let (mut of, mut sizes) = ([0_u8; BATCH], [0_u8; BATCH]);
        let mut last: Option<(&Cell, u8)> = None;
        for i in 0..n.min(BATCH) {
            let p = [points[0].0[i], points[1].0[i], points[2].0[i]];
            // neighbours mostly lie in one cell
            let group = match last {
                Some((cell, group)) if cell.holds(p) && cell.stays(p, cells.points()) => group,
                _ => {
                    let cell = cells.find(p, side);
                    let code = match side {
                        Side::Values => cell.values(),
                        Side::Marks => cells.marks_of(cell),
                    };
                    let group = groups.of(code);
                    last = Some((cell, group));
                    group
                }
            };
            of[i] = group;
            sizes[usize::from(group)] += 1;
        }
        let (mut ends, mut end, mut instructions, mut all) = ([0_u8; BATCH], 0, 0, 0);
        for (k, (tape, size)) in groups.tapes.iter_mut().zip(sizes).enumerate() {
            let Some((code, last)) = tape else { break };
            ends[k] = end;
            end += size;
            *last = end;
            instructions += code.instructions.len() * usize::from(size);
            all += cost(code, usize::from(size));
        }
        // many tapes for a few points each take longer than one for all
        if groups.count > 1 {
            let code = cells.around(side, points, n.min(BATCH));
            if cost(code, n) <= all {
                groups.tapes = [None; BATCH];
                groups.tapes[0] = Some((code, 0));
                groups.count = 1;
                cells.count(code.instructions.len() * n, n);
                return groups;
            }
        }
        for i in 0..n.min(BATCH) {
            let at = &mut ends[usize::from(of[i])];
            groups.order[usize::from(*at)] = i as u8;
            *at += 1;
        }
        cells.count(instructions, n);
        groups
    }

    /// The number of a tape's group.
    fn of(&mut self, code: &'c Code) -> u8 {
        let known = (self.tapes[..self.count].iter())
            .position(|tape| tape.is_some_and(|(known, _)| std::ptr::eq(known, code)));
        let group = known.unwrap_or(self.count);
        if known.is_none() {
            self.tapes[group] = Some((code, 0));
            self.count += 1;
        }
        group as u8
    }

    /// The tape of all points, if they share one.
    pub(crate) fn only(&self) -> Option<&'c Code> {
        match self.tapes {
            [Some((code, _)), None, ..] => Some(code),
            _ => None,
        }
    }

    /// The tapes, each with the numbers of its points.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&'c Code, &[u8])> {
        let mut begin = 0;
        self.tapes[..self.count]
            .iter()
            .flatten()
            .map(move |(code, end)| {
                let members = &self.order[begin..usize::from(*end)];
                begin = usize::from(*end);
                (*code, members)
            })
    }
}

/// Points of a vector, about.
const VECTOR: usize = 8;
/// Vectors that take as long as finding and calling what an instruction does.
const CALL: usize = 3;

/// What it takes to evaluate a tape at some points, in vectors of an instruction.
fn cost(code: &Code, points: usize) -> usize {
    code.instructions.len() * (CALL + points.div_ceil(VECTOR))
}

/// Puts the points of a group first in the workspace.
pub(crate) fn gather(points: &[Lane; 3], members: &[u8], work: &mut Workspace) {
    for (from, to) in points.iter().zip(work.points_mut()) {
        for (x, &i) in to.0.iter_mut().zip(members) {
            *x = from.0[usize::from(i)];
        }
    }
}

/// Puts what was found for a group where its points are.
pub(crate) fn scatter(from: &[f32], members: &[u8], to: &mut [f32]) {
    for (x, &i) in from.iter().zip(members) {
        to[usize::from(i)] = *x;
    }
}
