//! Where a ray meets the surface first, by ranges of the field over its parts: for rays that sphere tracing does not bring to
//! an end, along a plane or through a narrow gap.
//!
//! A part of the ray over which the field's range is above zero holds no surface, whatever its length; the others are halved,
//! near ones first (Mitchell 1990, root isolation). For a field that is a bound the value in the middle of a part, less
//! half its length, is a lower bound as well.

use zeroset_field::bounds::Exactness;
use zeroset_field::eval::Point;
use zeroset_field::number::{Dual, F64, Interval, Vec3, v3};
use zeroset_field::program::Program;
use zeroset_scene::view::ROUNDING;

/// A ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub(crate) origin: [f32; 3],
    pub(crate) direction: [f32; 3],
    /// Whether it starts inside the solid.
    pub(crate) inside: bool,
}

impl Line {
    fn at(&self, t: f64) -> [f64; 3] {
        std::array::from_fn(|k| f64::from(self.origin[k]) + f64::from(self.direction[k]) * t)
    }

    /// The box around a part of it.
    fn part(&self, from: f64, to: f64) -> Vec3<Interval> {
        let (a, b) = (self.at(from), self.at(to));
        v3(
            Interval::new(a[0], b[0]),
            Interval::new(a[1], b[1]),
            Interval::new(a[2], b[2]),
        )
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

/// Instructions that a search may take.
const WORK: usize = 400_000;

/// A search's memory.
pub(crate) struct Isolation<'p> {
    program: &'p Program,
    ranges: Point<'p, Interval>,
    values: Point<'p, F64>,
    gradients: Point<'p, Dual<F64>>,
    /// Whether the value changes by at most 1 per unit.
    bound: bool,
    parts: Vec<[f64; 2]>,
    evaluations: u64,
}

impl<'p> Isolation<'p> {
    pub(crate) fn new(program: &'p Program) -> Self {
        Isolation {
            program,
            ranges: Point::new(program),
            values: Point::new(program),
            gradients: Point::new(program),
            bound: program.exactness() <= Exactness::Bound,
            parts: Vec::new(),
            evaluations: 0,
        }
    }

    /// Evaluations since the last time that this was asked.
    pub(crate) fn take_evaluations(&mut self) -> u64 {
        std::mem::take(&mut self.evaluations)
    }

    fn value(&mut self, line: &Line, t: f64) -> f64 {
        self.evaluations += 1;
        let p = line.at(t).map(F64);
        line.sided(self.values.value(v3(p[0], p[1], p[2])).0)
    }

    /// The distance to the surface at `t`, about: the value over the length of the gradient.
    pub(crate) fn distance(&mut self, line: &Line, t: f32) -> f32 {
        self.evaluations += 1;
        let p = line.at(f64::from(t)).map(F64);
        let f = self.gradients.value(Dual::point(v3(p[0], p[1], p[2])));
        let slope = f.d.iter().map(|d| d.0 * d.0).sum::<f64>().sqrt();
        (f.v.0.abs() / slope.max(1e-30)) as f32
    }

    /// The first place between `start` and `end` where the field is behind the surface, beyond rounding and for longer than
    /// `least`.
    pub(crate) fn first(&mut self, line: &Line, start: f32, end: f32, least: f32) -> Crossing {
        let size = |p: [f64; 3]| p.iter().map(|c| c.abs()).sum::<f64>();
        let behind = |t: f64| -0.5 * f64::from(ROUNDING) * size(line.at(t));
        let instructions = self.program.structure().values.instructions.len();
        let most = (WORK / instructions.max(1)).max(64);
        let end = f64::from(end.min(f32::MAX));
        self.parts.clear();
        self.parts.push([f64::from(start), end]);
        let mut looked = 0;
        while let Some([from, to]) = self.parts.pop() {
            looked += 1;
            if looked > most {
                return Crossing::Unknown(from as f32);
            }
            self.evaluations += 1;
            let range = self.ranges.value(line.part(from, to));
            let (low, high) = if line.inside {
                (-range.hi, -range.lo)
            } else {
                (range.lo, range.hi)
            };
            if low >= behind(from).max(behind(to)) {
                continue;
            }
            if high < behind(from).min(behind(to)) {
                return Crossing::At(from as f32);
            }
            let middle = 0.5 * (from + to);
            let value = self.value(line, middle);
            if self.bound && value >= 0.5 * (to - from) {
                continue;
            }
            let within = value < behind(middle);
            if to - from <= f64::from(least) {
                if within {
                    return Crossing::At(middle as f32);
                }
                continue;
            }
            if !within {
                self.parts.push([middle, to]);
            }
            // where the middle is behind the surface, the first place lies before it
            self.parts.push([from, middle]);
            if within && middle - from <= f64::from(least) {
                return Crossing::At(middle as f32);
            }
        }
        Crossing::None
    }
}
