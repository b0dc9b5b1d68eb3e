//! Cells: boxes of space, each with what is left of a program in it (Keeter 2020; Barbier et al. 2025).
//!
//! [`Cells`] is a tree over a cube around the solid. A cell has the tape that says all there is to say in it, made from its parent's by one
//! evaluation over its box ([`zeroset_eval::Pruner`]), so that the cost of a point depends on what is near it. Cells are made where many
//! look, once, whatever thread comes first; which ones there are says nothing but how fast it goes, because **a cell's tape gives the
//! same bits as the whole program**: values, gradients, marks.
//!
//! Where a program divides by a large Lipschitz constant, because a formula is steep somewhere, cells know more: how much its value changes
//! in them at most (Galin et al. 2020). [`Cells::widen`] makes of a value how far a ray may go from there.
//!
//! Where a formula has no Lipschitz constant at all, values are no bounds. Then only cells say how far a ray may go: by their own slopes, or to
//! where they end, if their ranges leave zero out. Where neither helps, [`Cells::widen`] gives 0, and whoever is there has to look closer.
//!
//! The one way in is [`Cells::values`], [`Cells::gradients`] and [`Cells::marks`], which do for the points of a workspace what the
//! functions of the same names in [`zeroset_eval`] do with one tape: points are sorted by their cells, so that SIMD batches share a tape.
//!
//! ```
//! use zeroset_cells::Cells;
//! use zeroset_catalogue::bounds::Aabb;
//! use zeroset_field::program::{Limits, Program};
//! use zeroset_field::shape::sphere;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let beads = (0..400).map(|k| sphere(0.4).translate([f64::from(k), 0.0, 0.0]));
//! let chain = beads.reduce(|a, b| a | b).ok_or("no beads")?;
//! let program = Program::compile(&chain.field()?, &Limits::default())?;
//! let cells = Cells::new(&program, program.bounds()).ok_or("a small program")?.eager();
//!
//! assert_eq!(program.values().code.instructions.len(), 799);
//! // near the fourth bead a few are left
//! assert!(cells.tape_at([3.0, 0.5, 0.0]).code.instructions.len() < 10);
//! # Ok(())
//! # }
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod cell;
mod groups;

use cell::{Cell, Side};
use fearless_simd::Simd;
use groups::Groups;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::op::arithmetic::Binary;
use zeroset_catalogue::op::code;
use zeroset_catalogue::tape::{Code, Operation, Tape};
use zeroset_eval::{BATCH, Lane, Marks, Workspace};
use zeroset_field::program::Program;

/// Programs of fewer instructions have no cells: sorting points costs as much as it saves (docs/performance.md, "Cells").
pub const LEAST_INSTRUCTIONS: usize = 512;

/// Bytes that the cells of a program may take, apart from what they are made of at least: 256 MiB. Where there are as many, none are made
/// any more.
pub const BUDGET: usize = 256 << 20;

/// Programs that divide by this much and more have cells for their slopes, however short they are.
pub const STEEP: f64 = 16.0;

/// In cells whose values change by more than this a unit, where the surface may be, a ray gets along no better than by ranges.
const STEEPEST: f64 = 32.0;

/// How far cells with slopes go beyond what they are made around, in its sizes: outside, formulas are continued.
const REACH_OF_SLOPES: f32 = 1.25;
/// Cells with slopes are cut so often at most, and less often where the budget would not hold all that there can be: how far a ray goes
/// must not depend on which cells were made first.
const MOST_CUTS: u32 = 5;

/// A part of a cell is made when so many points were looked for in it: to make it costs as much as some tens of evaluations.
const POINTS: u32 = 256;

/// How far cells go beyond what they are made around, in its sizes.
const REACH: f32 = 64.0;
/// Cells with sides above this share of it are cut though their tapes stay as long: what they see of it may all be equally far.
const COARSE: f32 = 0.25;
/// Cells are not cut below this share of the size of what they are made around.
const FINEST: f32 = 1.0 / 1024.0;

/// The cells of a program.
pub struct Cells {
    program: Program,
    root: Cell,
    /// All that lies beyond the root.
    beyond: Cell,
    /// What they are made around: two corners.
    around: [[f32; 3]; 2],
    cut: Cut,
    count: AtomicUsize,
    bytes: AtomicUsize,
    instructions: AtomicU64,
    evaluated: AtomicU64,
}

/// How cells are cut.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// Cells with sides of this and less ought to be shorter than their parents.
    coarse: f32,
    /// Cells with sides of this are not cut.
    finest: f32,
    /// Bytes that all cells may take.
    budget: usize,
    /// Points that are looked for in a part of a cell before it is made.
    points: u32,
    /// Whether cells have slopes.
    slopes: bool,
    /// Whether the program has none.
    unbounded: bool,
    /// Whether what has none may reach beyond what the cells are made around.
    open: bool,
}

/// What cells have cost, and what they have saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Census {
    /// Cells that were made.
    pub cells: usize,
    /// Bytes that they take.
    pub bytes: usize,
    /// Instructions that were evaluated at points: each counts once a point.
    pub instructions: u64,
    /// Points that were evaluated.
    pub points: u64,
}

impl Cells {
    /// Cells for a program, over a cube that reaches far beyond the box `around`. None where they would cost more than they save, as in
    /// programs of few instructions, or where the box is empty or has no end.
    pub fn new(program: &Program, around: Aabb) -> Option<Cells> {
        Cells::within(program, around, BUDGET)
    }

    /// As [`Cells::new`], with another budget of bytes.
    pub fn within(program: &Program, around: Aabb, budget: usize) -> Option<Cells> {
        let structure = program.structure();
        if !can_be_pruned(program) {
            return None;
        }
        let unbounded = program.is_unbounded() && !program.is_fractal();
        let slopes = unbounded || (program.slope() >= STEEP && !program.is_fractal());
        if (structure.values.instructions.len() < LEAST_INSTRUCTIONS && !slopes)
            || around.is_empty()
            || !around.is_finite()
        {
            return None;
        }
        let size = around.half().iter().fold(0.0_f64, |a, b| a.max(*b)) as f32;
        let size = size.max(1e-6);
        let centre = around.centre().map(|c| c as f32);
        let reach = size * if slopes { REACH_OF_SLOPES } else { REACH };
        let (min, max) = (centre.map(|c| c - reach), centre.map(|c| c + reach));
        if !(0..3).all(|k| min[k].is_finite() && max[k].is_finite() && min[k] < max[k]) {
            return None;
        }
        let whole = Arc::new(structure.values.clone());
        let marks = Arc::new(structure.marks.clone());
        let cut = if slopes {
            let largest = cell::LARGEST + cell::bytes(&whole) + cell::bytes(&marks);
            // an eighth of all cells are not the smallest ones
            let all = |cuts: &u32| (1_usize << (3 * cuts)).saturating_mul(largest) / 7 * 8;
            let cuts = (0..=MOST_CUTS).rev().find(|cuts| all(cuts) <= budget)?;
            Cut {
                coarse: 2.0 * reach,
                // a hair more, for the rounding of halves
                finest: 2.0 * reach * 1.001 / (1_u32 << cuts) as f32,
                budget: usize::MAX,
                // how far a ray goes must not depend on who was there before
                points: 0,
                slopes,
                unbounded,
                open: false,
            }
        } else {
            Cut {
                coarse: size * COARSE,
                finest: 2.0 * size * FINEST,
                budget,
                points: POINTS,
                slopes,
                unbounded,
                open: false,
            }
        };
        let free = if unbounded { 0.0 } else { 1.0 };
        let root = Cell::whole(min, max, free, &whole, &marks);
        let beyond = Cell::whole([0.0; 3], [0.0; 3], free, &whole, &marks);
        Some(Cells {
            program: program.clone(),
            bytes: AtomicUsize::new(2 * cell::bytes(&whole) + cell::bytes(&marks)),
            root,
            beyond,
            around: [around.min, around.max].map(|corner| corner.map(|c| c as f32)),
            cut,
            count: AtomicUsize::new(1),
            instructions: AtomicU64::new(0),
            evaluated: AtomicU64::new(0),
        })
    }

    /// Cells that are made at the first point that is looked for in them, and not where many are.
    pub fn eager(mut self) -> Cells {
        self.cut.points = 0;
        self
    }

    /// Cells of a program in which something without a Lipschitz constant reaches beyond what the cells are made around.
    pub fn open(mut self) -> Cells {
        self.cut.open = true;
        self
    }

    /// Points that are looked for in a part of a cell before it is made.
    fn points(&self) -> u32 {
        self.cut.points
    }

    /// What they have cost so far.
    pub fn census(&self) -> Census {
        Census {
            cells: self.count.load(Ordering::Relaxed),
            bytes: self.bytes.load(Ordering::Relaxed),
            instructions: self.instructions.load(Ordering::Relaxed),
            points: self.evaluated.load(Ordering::Relaxed),
        }
    }

    /// The tape that gives the program's values around a point.
    pub fn tape_at(&self, p: [f32; 3]) -> Tape<'_> {
        self.tape(self.find(p, Side::Values).values())
    }

    /// The tape that gives the program's marks around a point.
    pub fn marks_at(&self, p: [f32; 3]) -> Tape<'_> {
        self.tape(self.marks_of(self.find(p, Side::Marks)))
    }

    fn marks_of<'a>(&'a self, cell: &'a Cell) -> &'a Code {
        cell.marks().unwrap_or(&self.program.structure().marks)
    }

    /// As [`zeroset_eval::values`], at the first `n` points of the workspace.
    #[inline(always)]
    pub fn values<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        let groups = Groups::new(self, Side::Values, work.points(), n);
        if let Some(code) = groups.only() {
            zeroset_eval::values(s, self.tape(code), work, n);
            return;
        }
        let (points, mut found) = (*work.points(), Lane::ZERO);
        for (code, members) in groups.iter() {
            groups::gather(&points, members, work);
            zeroset_eval::values(s, self.tape(code), work, members.len());
            groups::scatter(&work.values().0, members, &mut found.0);
        }
        *work.points_mut() = points;
        *work.values_mut() = found;
    }

    /// As [`zeroset_eval::gradients`], at the first `n` points of the workspace.
    pub fn gradients<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        let groups = Groups::new(self, Side::Values, work.points(), n);
        if let Some(code) = groups.only() {
            zeroset_eval::gradients(s, self.tape(code), work, n);
            return;
        }
        let (points, mut found) = (*work.points(), [Lane::ZERO; 4]);
        for (code, members) in groups.iter() {
            groups::gather(&points, members, work);
            zeroset_eval::gradients(s, self.tape(code), work, members.len());
            for (from, to) in work.gradients_mut().iter().zip(&mut found) {
                groups::scatter(&from.0, members, &mut to.0);
            }
        }
        *work.points_mut() = points;
        *work.gradients_mut() = found;
    }

    /// As [`zeroset_eval::marks`], at the first `n` points of the workspace.
    pub fn marks<S: Simd>(&self, s: S, work: &mut Workspace, n: usize) {
        let groups = Groups::new(self, Side::Marks, work.points(), n);
        if let Some(code) = groups.only() {
            zeroset_eval::marks(s, self.tape(code), work, n);
            return;
        }
        let points = *work.points();
        let mut found = Marks {
            object: Lane::ZERO,
            first: Lane::ZERO,
            second: Lane::ZERO,
            share: Lane::ZERO,
            orbit: [Lane::ZERO; 4],
        };
        for (code, members) in groups.iter() {
            groups::gather(&points, members, work);
            zeroset_eval::marks(s, self.tape(code), work, members.len());
            let from = work.marks();
            let pairs = [
                (&from.object, &mut found.object),
                (&from.first, &mut found.first),
                (&from.second, &mut found.second),
                (&from.share, &mut found.share),
            ];
            let orbits = from.orbit.iter().zip(&mut found.orbit);
            for (from, to) in pairs.into_iter().chain(orbits) {
                groups::scatter(&from.0, members, &mut to.0);
            }
        }
        *work.points_mut() = points;
        *work.marks_mut() = found;
    }

    /// Whether cells know the slopes of the field, so that [`Cells::widen`] does something.
    pub fn has_slopes(&self) -> bool {
        self.cut.slopes
    }

    /// From the values at the first `n` points of the workspace, how far around each of them the field keeps its sign: the value over the
    /// slope of the cell, as far as that holds, and no less than the value where this is a bound. The sign stays; 0 where nothing is known.
    pub fn widen(&self, work: &mut Workspace, n: usize) {
        if !self.cut.slopes {
            return;
        }
        let points = *work.points();
        let values = &mut work.values_mut().0;
        let mut last: Option<&Cell> = None;
        for i in 0..n.min(BATCH) {
            let p = [points[0].0[i], points[1].0[i], points[2].0[i]];
            let cell = match last.filter(|cell| cell.holds(p)) {
                Some(cell) => cell,
                None => self.find(p, Side::Values),
            };
            last = Some(cell);
            values[i] = if !self.cut.unbounded {
                cell.widen(p, values[i])
            } else if self.root.holds(p) {
                cell.free_around(p, values[i])
            } else {
                self.free_beyond(p, values[i])
            };
        }
    }

    /// As [`Cells::widen`], beyond the root: what has no slope is no nearer than the box that it is in, and the rest of the program has bounds.
    fn free_beyond(&self, p: [f32; 3], f: f32) -> f32 {
        if self.cut.open {
            return 0.0_f32.copysign(f);
        }
        let [min, max] = self.around;
        let way = |k: usize| (min[k] - p[k]).max(p[k] - max[k]).max(0.0);
        let away = (way(0) * way(0) + way(1) * way(1) + way(2) * way(2)).sqrt();
        // a hair less, for the roundings of the box; also where the value is no number
        (away * 0.9999).min(f.abs()).copysign(f)
    }

    fn tape<'a>(&'a self, code: &'a Code) -> Tape<'a> {
        Tape {
            code,
            data: self.program.data(),
        }
    }

    /// The smallest cell around a point that there ought to be.
    fn find(&self, p: [f32; 3], side: Side) -> &Cell {
        if !self.root.holds(p) {
            return &self.beyond;
        }
        let mut cell = &self.root;
        while let Some(child) = cell.child(p, self.cut.points, |cell, part| self.make(cell, part)) {
            if side == Side::Marks {
                child.prune_marks(cell, self.program.data(), |bytes| self.pay(bytes));
            }
            cell = child;
        }
        cell
    }

    /// A tape for all of the first `n` points.
    fn around(&self, side: Side, points: &[Lane; 3], n: usize) -> &Code {
        let structure = self.program.structure();
        if side == Side::Marks {
            return &structure.marks;
        }
        let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for k in 0..3 {
            for &x in &points[k].0[..n] {
                if !x.is_finite() {
                    return &structure.values;
                }
                (min[k], max[k]) = (min[k].min(x), max[k].max(x));
            }
        }
        if !(self.root.holds(min) && self.root.holds(max)) {
            return &structure.values;
        }
        let mut cell = &self.root;
        while let Some(part) = cell.part_around(min, max) {
            cell = part;
        }
        cell.values()
    }

    /// A part of a cell, if it has any and there is room for one.
    fn make(&self, cell: &Cell, part: usize) -> Option<Cell> {
        if self.bytes.load(Ordering::Relaxed) > self.cut.budget {
            return None;
        }
        let child = cell.part(part, self.program.data(), &self.cut);
        self.count.fetch_add(1, Ordering::Relaxed);
        self.pay(child.size(cell));
        Some(child)
    }

    fn pay(&self, bytes: usize) {
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
    }

    /// Counts what an evaluation takes.
    fn count(&self, instructions: usize, points: usize) {
        let all = instructions as u64;
        self.instructions.fetch_add(all, Ordering::Relaxed);
        self.evaluated.fetch_add(points as u64, Ordering::Relaxed);
    }
}

/// Whether what is left of a program in a box has the same bits there. A remainder by zero is no number, and no range says so: a formula
/// that takes remainders by anything but a constant other than zero is never cut.
pub fn can_be_pruned(program: &Program) -> bool {
    !divides_by_what_varies(program)
}

fn divides_by_what_varies(program: &Program) -> bool {
    let tape = program.values();
    let mut constant = vec![false; usize::from(tape.code.registers)];
    for i in &tape.code.instructions {
        if i.operation == Operation::Pair(code::binary(Binary::Modulo))
            && !constant[usize::from(i.b)]
        {
            return true;
        }
        constant[usize::from(i.out)] = i.operation == Operation::Leaf(code::CONSTANT)
            && (tape.data.params.get(i.at as usize)).is_some_and(|c| *c != 0.0);
    }
    false
}
