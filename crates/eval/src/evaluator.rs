//! Evaluation without SIMD in sight: slices of points in, slices of numbers out.

use crate::batch::{run_gradients, run_values};
use crate::workspace::{BATCH, Workspace};
use fearless_simd::Level;
use glam::Vec3;
use zeroset_catalogue::tape::Tape;

/// Evaluates a tape at any number of points, [`BATCH`] at once, with the widest vectors of the machine.
///
/// It holds the registers of one thread, and allocates nothing after it was made: keep one a thread. Points are in scene units;
/// a value is a bound on the distance to the surface, negative inside (what kind of bound, the program knows).
///
/// ```
/// use glam::{Vec3, vec3};
/// use zeroset_eval::Evaluator;
/// use zeroset_field::program::{Limits, Program};
/// use zeroset_field::shape::sphere;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let program = Program::compile(&sphere(1.0).field()?, &Limits::default())?;
/// let mut evaluator = Evaluator::new(program.values());
/// let points = [vec3(0.0, 0.0, 0.0), vec3(0.0, 3.0, 0.0)];
///
/// let mut values = [0.0; 2];
/// evaluator.values(&points, &mut values)?;
/// assert_eq!(values, [-1.0, 2.0]);
///
/// let mut gradients = [Vec3::ZERO; 2];
/// evaluator.gradients(&points, &mut values, &mut gradients)?;
/// assert_eq!(gradients[1], Vec3::Y);
/// # Ok(())
/// # }
/// ```
pub struct Evaluator<'t> {
    tape: Tape<'t>,
    level: Level,
    workspace: Workspace,
}

/// Slices of other lengths than there are points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{points} points, but room for {room} {what}")]
pub struct LengthError {
    /// Points given.
    pub points: usize,
    /// What there is room for.
    pub what: &'static str,
    /// How many of them there is room for.
    pub room: usize,
}

impl<'t> Evaluator<'t> {
    /// An evaluator of a tape, such as `Program::values` gives.
    pub fn new(tape: Tape<'t>) -> Evaluator<'t> {
        Evaluator {
            tape,
            level: Level::new(),
            workspace: Workspace::new(tape, tape),
        }
    }

    /// The value at a point.
    pub fn value(&mut self, point: Vec3) -> f32 {
        self.place(&[point]);
        run_values(self.level, self.tape, &mut self.workspace.lanes, 1);
        self.workspace.lanes[usize::from(self.tape.code.result)].0[0]
    }

    /// The value at a point and its gradient, the derivatives along x, y and z.
    pub fn gradient(&mut self, point: Vec3) -> (f32, Vec3) {
        self.place(&[point]);
        self.run_gradients(1);
        let (value, gradient) = self.workspace.gradient(0);
        (value, gradient.into())
    }

    /// The values at points, in their order.
    ///
    /// # Errors
    /// `values` is not as long as `points`; nothing is written.
    pub fn values(&mut self, points: &[Vec3], values: &mut [f32]) -> Result<(), LengthError> {
        fits(points, "values", values.len())?;
        let result = usize::from(self.tape.code.result);
        for (points, values) in points.chunks(BATCH).zip(values.chunks_mut(BATCH)) {
            self.place(points);
            run_values(
                self.level,
                self.tape,
                &mut self.workspace.lanes,
                points.len(),
            );
            values.copy_from_slice(&self.workspace.lanes[result].0[..points.len()]);
        }
        Ok(())
    }

    /// The values at points and their gradients, in their order. A gradient is the direction in which the value grows, times how
    /// fast it does.
    ///
    /// # Errors
    /// `values` or `gradients` is not as long as `points`; nothing is written.
    pub fn gradients(
        &mut self,
        points: &[Vec3],
        values: &mut [f32],
        gradients: &mut [Vec3],
    ) -> Result<(), LengthError> {
        fits(points, "values", values.len())?;
        fits(points, "gradients", gradients.len())?;
        let out = values.chunks_mut(BATCH).zip(gradients.chunks_mut(BATCH));
        for (points, (values, gradients)) in points.chunks(BATCH).zip(out) {
            self.place(points);
            self.run_gradients(points.len());
            for (i, (value, gradient)) in values.iter_mut().zip(gradients).enumerate() {
                let (v, g) = self.workspace.gradient(i);
                (*value, *gradient) = (v, g.into());
            }
        }
        Ok(())
    }

    fn run_gradients(&mut self, n: usize) {
        self.workspace.begin_gradients(self.tape);
        run_gradients(self.level, self.tape, &mut self.workspace.duals, n);
    }

    /// Puts up to [`BATCH`] points into the registers, and the last one once more in all places that vectors reach.
    fn place(&mut self, points: &[Vec3]) {
        let [x, y, z] = self.workspace.points_mut();
        for (i, p) in points.iter().enumerate() {
            (x.0[i], y.0[i], z.0[i]) = (p.x, p.y, p.z);
        }
        if let Some(last) = points.last() {
            let end = points.len().next_multiple_of(WIDEST).min(BATCH);
            for i in points.len()..end {
                (x.0[i], y.0[i], z.0[i]) = (last.x, last.y, last.z);
            }
        }
    }
}

/// Points that the widest vectors hold.
const WIDEST: usize = 16;

fn fits(points: &[Vec3], what: &'static str, room: usize) -> Result<(), LengthError> {
    let points = points.len();
    if points == room {
        return Ok(());
    }
    Err(LengthError { points, what, room })
}
