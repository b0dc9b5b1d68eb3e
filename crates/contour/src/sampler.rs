//! Values and gradients of a program at any number of points, in SIMD batches.

use fearless_simd::Level;
use zeroset_catalogue::tape::Tape;
use zeroset_cells::Cells;
use zeroset_eval::{BATCH, Workspace};
use zeroset_field::program::Program;

/// Points that the widest vectors hold.
const WIDEST: usize = 16;
/// Gradients shorter than this have no direction.
const FLAT: f64 = 1e-12;

/// A field, as one thread asks for it.
pub(crate) struct Sampler<'p> {
    program: &'p Program,
    cells: Option<&'p Cells>,
    level: Level,
    work: Workspace,
}

/// A value and the direction in which it grows.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slope {
    /// How far the surface is, as far as value and gradient tell: the value over the length of the gradient (Taubin 1994).
    pub(crate) distance: f64,
    /// Unit gradient; zero where there is none.
    pub(crate) normal: [f64; 3],
}

impl<'p> Sampler<'p> {
    pub(crate) fn new(program: &'p Program, cells: Option<&'p Cells>) -> Sampler<'p> {
        let values = program.values();
        Sampler {
            program,
            cells,
            level: Level::new(),
            work: Workspace::new(values, values),
        }
    }

    /// The values of a tape of the program at points.
    pub(crate) fn values(&mut self, tape: Tape<'_>, points: &[[f32; 3]], values: &mut [f32]) {
        for (points, values) in points.chunks(BATCH).zip(values.chunks_mut(BATCH)) {
            self.place(points);
            let work = &mut self.work;
            zeroset_number::at_level!(self.level, s => zeroset_eval::values(s, tape, work, points.len()));
            values.copy_from_slice(&self.work.values().0[..points.len()]);
        }
    }

    /// The values of the whole program, whatever is left of it around the points.
    pub(crate) fn whole_values(&mut self, points: &[[f32; 3]], values: &mut [f32]) {
        let Some(cells) = self.cells else {
            let program = self.program;
            return self.values(program.values(), points, values);
        };
        for (points, values) in points.chunks(BATCH).zip(values.chunks_mut(BATCH)) {
            self.place(points);
            let work = &mut self.work;
            zeroset_number::at_level!(self.level, s => cells.values(s, work, points.len()));
            values.copy_from_slice(&self.work.values().0[..points.len()]);
        }
    }

    /// Distances and directions at points, by a tape of the program.
    pub(crate) fn slopes(&mut self, tape: Tape<'_>, points: &[[f32; 3]], slopes: &mut Vec<Slope>) {
        slopes.clear();
        for points in points.chunks(BATCH) {
            self.place(points);
            let work = &mut self.work;
            zeroset_number::at_level!(self.level, s => zeroset_eval::gradients(s, tape, work, points.len()));
            slopes.extend((0..points.len()).map(|i| slope(self.work.gradient(i))));
        }
    }

    /// The same of the whole program.
    pub(crate) fn whole_slopes(&mut self, points: &[[f32; 3]], slopes: &mut Vec<Slope>) {
        let Some(cells) = self.cells else {
            let program = self.program;
            return self.slopes(program.values(), points, slopes);
        };
        slopes.clear();
        for points in points.chunks(BATCH) {
            self.place(points);
            let work = &mut self.work;
            zeroset_number::at_level!(self.level, s => cells.gradients(s, work, points.len()));
            slopes.extend((0..points.len()).map(|i| slope(self.work.gradient(i))));
        }
    }

    /// Puts up to [`BATCH`] points into the registers, and the last one once more in all places that vectors reach.
    fn place(&mut self, points: &[[f32; 3]]) {
        let lanes = self.work.points_mut();
        let end = points.len().next_multiple_of(WIDEST).min(BATCH);
        let Some(last) = points.last() else { return };
        for (k, lane) in lanes.iter_mut().enumerate() {
            for (x, p) in lane.0.iter_mut().zip(points) {
                *x = p[k];
            }
            lane.0[points.len()..end].fill(last[k]);
        }
    }
}

fn slope((value, gradient): (f32, [f32; 3])) -> Slope {
    let g = gradient.map(f64::from);
    let length = g.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > FLAT && length.is_finite() {
        Slope {
            distance: f64::from(value) / length,
            normal: g.map(|x| x / length),
        }
    } else {
        Slope {
            distance: f64::from(value),
            normal: [0.0; 3],
        }
    }
}
