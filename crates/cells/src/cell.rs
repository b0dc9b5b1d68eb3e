//! One cell: a box with its tapes, and its eight parts as soon as somebody looks there.

use crate::{Cut, STEEPEST};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};
use zeroset_catalogue::tape::{Code, Instruction, Tape};
use zeroset_eval::{Point, Pruner};
use zeroset_number::{Data, Interval, SingleInterval, Slope, v3};

/// Tapes of so few instructions are not made shorter: finding the cell of a point costs as much.
const SHORT: usize = 8;
/// A tape that has lost less than one in this many of its instructions is as long as before.
const SHARE: usize = 8;
/// So many cuts may be made in vain.
const PATIENCE: u8 = 2;

/// What is known in a cell with a slope holds so far around it, in its sides: who is near its border can go on.
const MARGIN: f32 = 0.5;
/// A slope that is more than this share of the one before is no better.
const FLATTER: f32 = 0.9;

/// What is asked of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Its value and its gradient.
    Values,
    /// Its marks.
    Marks,
}

/// A box that is closed below and open above, so that every point lies in one part of it.
pub(crate) struct Cell {
    min: [f32; 3],
    max: [f32; 3],
    centre: [f32; 3],
    values: Arc<Code>,
    /// Made where marks are asked for.
    marks: OnceLock<Arc<Code>>,
    /// What its tape and its slope hold for, beyond its sides.
    margin: f32,
    /// How far the sign stays for each unit of the value, within the margin: one over the slope. Where no slope is known 1, or 0 if values
    /// are no bounds.
    free: f32,
    /// Whether there is one sign all over it and its margin.
    clear: bool,
    /// Cuts that have not made the tape shorter, nor the slope less.
    vain: u8,
    /// None in a cell that is not cut.
    parts: Option<Box<Parts>>,
}

type Parts = [Part; 8];

/// An eighth of a cell.
#[derive(Default)]
struct Part {
    /// Points that were looked for in it before it was made.
    asked: AtomicU32,
    /// None where there was no room for it when it was to be made.
    cell: OnceLock<Option<Box<Cell>>>,
}

/// Bytes of a cell without its tapes, at most.
pub(crate) const LARGEST: usize = size_of::<Cell>() + size_of::<Parts>();

/// Bytes of a tape.
pub(crate) fn bytes(code: &Code) -> usize {
    size_of::<Code>() + code.instructions.len() * size_of::<Instruction>()
}

impl Cell {
    /// A cell in which all of a program is left. One of an empty box holds no point.
    pub(crate) fn whole(
        min: [f32; 3],
        max: [f32; 3],
        free: f32,
        values: &Arc<Code>,
        marks: &Arc<Code>,
    ) -> Cell {
        let cut = min[0] < max[0];
        Cell {
            min,
            max,
            centre: middle(min, max),
            values: Arc::clone(values),
            marks: OnceLock::from(Arc::clone(marks)),
            margin: 0.0,
            free,
            clear: false,
            vain: 0,
            parts: cut.then(Box::default),
        }
    }

    pub(crate) fn values(&self) -> &Code {
        &self.values
    }

    /// The tape for marks, where it was asked for.
    pub(crate) fn marks(&self) -> Option<&Code> {
        self.marks.get().map(|code| &**code)
    }

    #[inline(always)]
    pub(crate) fn holds(&self, p: [f32; 3]) -> bool {
        (p[0] >= self.min[0] && p[0] < self.max[0])
            && (p[1] >= self.min[1] && p[1] < self.max[1])
            && (p[2] >= self.min[2] && p[2] < self.max[2])
    }

    /// Whether the part around a point of it is not made yet, and not to be made after `points` points, so that it is the cell of this
    /// point too.
    #[inline]
    pub(crate) fn stays(&self, p: [f32; 3], points: u32) -> bool {
        let Some(parts) = self.parts.as_ref() else {
            return true;
        };
        let part = &parts[self.number(p)];
        match part.cell.get() {
            Some(made) => made.is_none(),
            None => part.asked.fetch_add(1, Ordering::Relaxed) < points,
        }
    }

    /// The part that holds a box, from its smallest to its largest corner, if there is one and somebody has made it.
    pub(crate) fn part_around(&self, min: [f32; 3], max: [f32; 3]) -> Option<&Cell> {
        let (parts, number) = (self.parts.as_ref()?, self.number(min));
        if self.number(max) != number {
            return None;
        }
        parts[number].cell.get()?.as_deref()
    }

    /// Which part a point lies in.
    #[inline(always)]
    fn number(&self, p: [f32; 3]) -> usize {
        let bit = |k: usize| usize::from(p[k] >= self.centre[k]) << k;
        bit(0) | bit(1) | bit(2)
    }

    /// The part around a point of it; `make` makes it where nobody has yet, and as many points were looked for as it takes.
    #[inline]
    pub(crate) fn child(
        &self,
        p: [f32; 3],
        points: u32,
        make: impl FnOnce(&Cell, usize) -> Option<Cell>,
    ) -> Option<&Cell> {
        let parts = self.parts.as_ref()?;
        let number = self.number(p);
        let part = &parts[number];
        if let Some(made) = part.cell.get() {
            return made.as_deref();
        }
        if part.asked.fetch_add(1, Ordering::Relaxed) < points {
            return None;
        }
        let made = part.cell.get_or_init(|| make(self, number).map(Box::new));
        made.as_deref()
    }

    /// Part number `part`: a bit for each axis, set for the upper half.
    pub(crate) fn part(&self, part: usize, data: &Data, cut: &Cut) -> Cell {
        let (mut min, mut max) = (self.min, self.max);
        for k in 0..3 {
            if part >> k & 1 == 1 {
                min[k] = self.centre[k];
            } else {
                max[k] = self.centre[k];
            }
        }
        let side = max[0] - min[0];
        let margin = if cut.slopes { MARGIN * side } else { 0.0 };
        let (values, is_shorter) = pruned(&self.values, data, min, max, margin);
        let (free, clear) = if cut.slopes {
            let (free, clear) = free(&values, data, min, max, margin, cut.unbounded);
            (free.max(self.free), clear && cut.unbounded)
        } else {
            (1.0, false)
        };
        let is_better = is_shorter || free * FLATTER > self.free;
        // what is not known yet may be in a part, however often it was not
        let is_hopeful = cut.unbounded && free == 0.0;
        let vain = match is_better || is_hopeful || side > cut.coarse {
            true => 0,
            false => self.vain + 1,
        };
        let is_long = values.instructions.len() > SHORT || cut.slopes;
        let is_cut = is_long && !clear && vain < PATIENCE && side > cut.finest;
        Cell {
            min,
            max,
            centre: middle(min, max),
            values,
            marks: OnceLock::new(),
            margin,
            free,
            clear,
            vain,
            parts: is_cut.then(Box::default),
        }
    }

    /// Makes the tape for marks from that of the cell that this is a part of.
    pub(crate) fn prune_marks(&self, parent: &Cell, data: &Data, pay: impl FnOnce(usize)) {
        self.marks.get_or_init(|| {
            let marks = (parent.marks.get()).expect("who looks for marks comes from above");
            let (code, _) = pruned(marks, data, self.min, self.max, self.margin);
            if !Arc::ptr_eq(&code, marks) {
                pay(bytes(&code));
            }
            code
        });
    }

    /// How far around a point of it the field keeps its sign, where its value is `f`; with the sign of `f`.
    pub(crate) fn widen(&self, p: [f32; 3], f: f32) -> f32 {
        let inside = |k: usize| (p[k] - self.min[k]).min(self.max[k] - p[k]);
        // a hair less, for the roundings of the sides
        let border = (self.margin + inside(0).min(inside(1)).min(inside(2))) * 0.999;
        let free = (f.abs() * self.free).min(border);
        free.max(f.abs()).copysign(f)
    }

    /// As [`Cell::widen`], where the value alone is no bound; 0 where nothing is known.
    pub(crate) fn free_around(&self, p: [f32; 3], f: f32) -> f32 {
        let inside = |k: usize| (p[k] - self.min[k]).min(self.max[k] - p[k]);
        let border = (self.margin + inside(0).min(inside(1)).min(inside(2))) * 0.999;
        let by = f.abs() * self.free;
        // not `min`: a value that is no number says nothing
        let free = if self.clear || by >= border {
            border
        } else if by > 0.0 {
            by
        } else {
            0.0
        };
        free.copysign(f)
    }

    /// Bytes of it, as a part of another one.
    pub(crate) fn size(&self, parent: &Cell) -> usize {
        let parts = self.parts.as_ref().map_or(0, |_| size_of::<Parts>());
        let tape = if Arc::ptr_eq(&self.values, &parent.values) {
            0
        } else {
            bytes(&self.values)
        };
        size_of::<Cell>() + parts + tape
    }
}

fn middle(min: [f32; 3], max: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|k| 0.5 * (min[k] + max[k]))
}

/// One over the Lipschitz constant of a tape in a box, a hair less, and whether its value has one sign there. Where the constant is not known to
/// be below 1, the first is 1 if the value is a bound; if it is `unbounded`, 0 where the constant is above [`STEEPEST`].
fn free(
    code: &Code,
    data: &Data,
    min: [f32; 3],
    max: [f32; 3],
    margin: f32,
    unbounded: bool,
) -> (f32, bool) {
    let side = |k: usize| Interval::new((min[k] - margin).into(), (max[k] + margin).into());
    let within = Slope::point(v3(side(0), side(1), side(2)));
    let found = Point::<Slope>::new(Tape { code, data }).value(within);
    // ranges are of exact numbers: values of single precision that close to zero may have the other sign
    let least = f64::from(f32::MIN_POSITIVE);
    let clear = found.v.lo > least || found.v.hi < -least;
    let slope = found.l;
    // also where it is infinite
    let free = if slope < 1.0 || (unbounded && slope <= STEEPEST) {
        ((1.0 - 1e-5) / slope.max(1e-9)) as f32
    } else if unbounded {
        0.0
    } else {
        1.0
    };
    (free, clear)
}

/// What is left of a tape in a box and the margin around it, and whether that is much less.
fn pruned(
    code: &Arc<Code>,
    data: &Data,
    min: [f32; 3],
    max: [f32; 3],
    margin: f32,
) -> (Arc<Code>, bool) {
    let side = |k: usize| SingleInterval::new((min[k] - margin).into(), (max[k] + margin).into());
    let within = v3(side(0), side(1), side(2));
    let before = code.instructions.len();
    match Pruner::new().prune(Tape { code, data }, within).code {
        Some(left) => {
            let is_shorter = (before - left.instructions.len()) * SHARE > before;
            (Arc::new(left), is_shorter)
        }
        None => (Arc::clone(code), false),
    }
}
