//! Where a ray meets the surface first, by ranges of the field over its parts: for rays that sphere tracing does not bring to
//! an end, along a plane or through a narrow gap.
//!
//! A part of the ray over which the field's range is above zero holds no surface, whatever its length; the others are halved,
//! near ones first (Mitchell 1990). The values at its ends help: with the slope of a field that is a bound, or with the range
//! of its derivative along the ray, which needs fewer and fewer parts the shorter they are. What the field is far from in a part is left out
//! in the parts of that one.

use zeroset_catalogue::bounds::Exactness;
use zeroset_catalogue::tape::{Code, Tape};
use zeroset_cells::can_be_pruned;
use zeroset_eval::{Point, PointNumber, Pruner};
use zeroset_field::program::Program;
use zeroset_number::{Dual, F64, Interval, SingleInterval, Slope, Vec3, v3};

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Whether it starts inside the solid.
    pub(crate) inside: bool,
}

impl Line {
    pub(crate) fn at(&self, t: f64) -> Vec3<F64> {
        let along = |k: usize| F64(f64::from(self.origin[k]) + f64::from(self.direction[k]) * t);
        v3(along(0), along(1), along(2))
    }

    /// The box around a part of it.
    fn part(&self, from: f64, to: f64) -> Vec3<Interval> {
        let (a, b) = (self.at(from), self.at(to));
        v3(
            Interval::new(a.x.0, b.x.0),
            Interval::new(a.y.0, b.y.0),
            Interval::new(a.z.0, b.z.0),
        )
    }

    /// The same, for a tape in single precision.
    fn single_part(&self, from: f64, to: f64) -> Vec3<SingleInterval> {
        let (a, b) = (self.at(from), self.at(to));
        v3(
            SingleInterval::new(a.x.0, b.x.0),
            SingleInterval::new(a.y.0, b.y.0),
            SingleInterval::new(a.z.0, b.z.0),
        )
    }

    /// The sum of the sizes of the coordinates at `t`.
    pub(crate) fn size(&self, t: f64) -> f64 {
        let at = self.at(t);
        at.x.0.abs() + at.y.0.abs() + at.z.0.abs()
    }

    fn sided(&self, f: f64) -> f64 {
        if self.inside { -f } else { f }
    }
}

/// What became of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Crossing {
    /// There is no surface.
    None,
    /// The sign changes here, for the first time.
    At(f32),
    /// There is none up to here; behind it the search took too long.
    Unknown(f32),
}

/// Evaluations in double precision are off by about this share of the coordinates.
const ROUNDING: f64 = 1e-15;
/// Instructions over ranges that a search may take, and parts that it may look at in any case.
const WORK: usize = 400_000;
const PARTS: usize = 64;
/// Tapes of so few instructions are not made shorter.
const SHORT: usize = 32;

/// A part of a ray.
#[derive(Clone, Copy)]
struct Segment {
    from: f64,
    to: f64,
    /// Whether its end is known to be behind the surface.
    ends_behind: bool,
}

/// What is left of the program on a part of the ray.
struct Remains {
    from: f64,
    to: f64,
    code: Code,
}

/// What is left of a program where a ray is looked at.
fn tape<'a>(program: &'a Program, left: &'a [Remains]) -> Tape<'a> {
    let whole = program.values();
    Tape {
        code: left.last().map_or(whole.code, |left| &left.code),
        data: whole.data,
    }
}

/// A search's memory.
pub(crate) struct Isolation<'p> {
    program: &'p Program,
    /// The ray that is looked at, and what is left of the program on parts of it, each within the one before.
    line: Option<Line>,
    left: Vec<Remains>,
    pruner: Pruner,
    /// Whether what is left of the program in a box gives the same there.
    prunes: bool,
    /// Whether the value changes by at most 1 per unit.
    bound: bool,
    /// Whether the value may jump.
    chaotic: bool,
    parts: Vec<Segment>,
    evaluations: u64,
    /// Instructions that ranges took.
    work: usize,
}

impl<'p> Isolation<'p> {
    pub(crate) fn new(program: &'p Program) -> Self {
        Isolation {
            program,
            line: None,
            left: Vec::new(),
            pruner: Pruner::new(),
            prunes: can_be_pruned(program),
            bound: program.exactness() <= Exactness::Bound,
            chaotic: program.is_fractal(),
            parts: Vec::new(),
            evaluations: 0,
            work: 0,
        }
    }

    /// Lets go of what is only known of parts of a ray that do not hold this one.
    fn look_at(&mut self, line: &Line, from: f64, to: f64) {
        if self.line != Some(*line) {
            self.line = Some(*line);
            self.left.clear();
        }
        while (self.left.last()).is_some_and(|left| from < left.from || left.to < to) {
            self.left.pop();
        }
    }

    fn evaluate<R: PointNumber>(&mut self, at: Vec3<R>) -> R {
        self.evaluations += 1;
        Point::new(tape(self.program, &self.left)).value(at)
    }

    /// Leaves out of the program what does not matter on a part of the ray. Returns the least value there, from the side that is followed, if
    /// that was found on the way.
    fn prune(&mut self, line: &Line, from: f64, to: f64) -> Option<f64> {
        let tape = tape(self.program, &self.left);
        let instructions = tape.code.instructions.len();
        if !self.prunes || instructions <= SHORT {
            return None;
        }
        let left = (self.pruner).prune(tape, line.single_part(from, to));
        self.evaluations += 1;
        self.work += instructions;
        if let Some(code) = left.code {
            self.left.push(Remains { from, to, code });
        }
        let range = left.range;
        Some(if line.inside { -range.hi } else { range.lo })
    }

    /// Whether the value may jump: ranges of it say nothing then.
    pub(crate) fn is_chaotic(&self) -> bool {
        self.chaotic
    }

    /// Whether the value changes by at most 1 per unit.
    pub(crate) fn is_bound(&self) -> bool {
        self.bound
    }

    /// By how much rounding may be off at `t`.
    pub(crate) fn rounding(&self, line: &Line, t: f64) -> f64 {
        ROUNDING * line.size(t)
    }

    /// Evaluations since the last time that this was asked.
    pub(crate) fn take_evaluations(&mut self) -> u64 {
        std::mem::take(&mut self.evaluations)
    }

    /// The value at `t`, from the side that is followed.
    pub(crate) fn value(&mut self, line: &Line, t: f64) -> f64 {
        self.look_at(line, t, t);
        line.sided(self.evaluate(line.at(t)).0)
    }

    /// The place between one that is not behind the surface and one that is.
    fn between(&mut self, line: &Line, mut outside: f64, mut inside: f64) -> Crossing {
        while inside - outside > inside.abs() * f64::from(f32::EPSILON) * 0.25 {
            let middle = 0.5 * (outside + inside);
            if middle <= outside || middle >= inside {
                break;
            }
            if self.value(line, middle) < 0.0 {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        Crossing::At(inside as f32)
    }

    /// Whether the field is nowhere below `limit` on a part of the ray, as far as is easily seen: by its range over the box
    /// around it, by its slope where it is a bound, by the range of its derivative along the ray.
    pub(crate) fn is_clear(&mut self, line: &Line, from: f64, to: f64, limit: f64) -> bool {
        self.look_at(line, from, to);
        if (self.prune(line, from, to)).is_some_and(|low| low >= limit) {
            return true;
        }
        let part = line.part(from, to);
        self.work += tape(self.program, &self.left).code.instructions.len();
        let range = self.evaluate(part);
        let low = if line.inside { -range.hi } else { range.lo };
        if low >= limit {
            return true;
        }
        let ends = [self.value(line, from), self.value(line, to)];
        let length = to - from;
        if ends[0].min(ends[1]) < limit {
            return false;
        }
        if self.bound && ends[0] + ends[1] - length >= 2.0 * limit {
            return true;
        }
        if self.chaotic {
            return false;
        }
        // f(t) >= f(from) + low (t - from) and f(t) >= f(to) - high (to - t)
        // endless where the value may jump, which ranges of derivatives alone do not say
        let d = self.evaluate(Slope::point(part)).d;
        let mut along = Interval::point(0.0);
        for (slope, direction) in d.iter().zip(line.direction) {
            along = along + *slope * Interval::point(f64::from(direction));
        }
        let (low, high) = if line.inside {
            (-along.hi, -along.lo)
        } else {
            (along.lo, along.hi)
        };
        if !(low.is_finite() && high.is_finite()) {
            return false;
        }
        if low >= 0.0 || high <= 0.0 {
            return true;
        }
        // the two lines meet where both are least
        let meet = (ends[1] - ends[0] - high * length) / (low - high);
        ends[0] + low * meet.clamp(0.0, length) >= limit
    }

    /// The distance to the surface at `t`, about: the value over the length of the gradient.
    pub(crate) fn distance(&mut self, line: &Line, t: f32) -> f32 {
        let value = self.value(line, f64::from(t)).abs();
        (value / self.slope(line, f64::from(t)).max(1e-30)) as f32
    }

    /// The length of the gradient at `t`.
    pub(crate) fn slope(&mut self, line: &Line, t: f64) -> f64 {
        self.look_at(line, t, t);
        let f = self.evaluate(Dual::point(line.at(t)));
        f.d.iter().map(|d| d.0 * d.0).sum::<f64>().sqrt()
    }

    /// The first place between `start` and `end` where the field is behind the surface, beyond rounding and for longer than
    /// `least`.
    pub(crate) fn first(&mut self, line: &Line, start: f32, end: f32, least: f32) -> Crossing {
        let behind = |t: f64| -ROUNDING * line.size(t);
        self.work = 0;
        let end = f64::from(end.min(f32::MAX));
        self.parts.clear();
        self.parts.push(Segment {
            from: f64::from(start),
            to: end,
            ends_behind: false,
        });
        let mut looked = 0;
        while let Some(Segment {
            from,
            to,
            ends_behind,
        }) = self.parts.pop()
        {
            looked += 1;
            if looked > PARTS && self.work > WORK {
                return Crossing::Unknown(from as f32);
            }
            if !ends_behind && self.is_clear(line, from, to, behind(from).max(behind(to))) {
                continue;
            }
            let middle = 0.5 * (from + to);
            let value = self.value(line, middle);
            let within = value < behind(middle);
            if to - from <= f64::from(least) {
                match (within, ends_behind) {
                    (true, _) => return self.between(line, from, middle),
                    (false, true) => return self.between(line, middle, to),
                    (false, false) => continue,
                }
            }
            // what lies behind a place that is behind the surface does not matter any more
            if within {
                self.parts.clear();
            } else {
                self.parts.push(Segment {
                    from: middle,
                    to,
                    ends_behind,
                });
            }
            self.parts.push(Segment {
                from,
                to: middle,
                ends_behind: within,
            });
        }
        Crossing::None
    }
}
