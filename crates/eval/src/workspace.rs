//! The registers of tapes, a lane for each number of every point of a batch.

use zeroset_catalogue::tape::{Code, Tape};

/// Points an instruction is run over at most. Large enough that the choice of a kernel costs nothing, small enough that
/// the registers of a program stay in the nearest cache.
pub const BATCH: usize = 128;

/// One number of every point of a batch.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Lane(pub [f32; BATCH]);

impl Lane {
    /// A lane of zeros.
    pub const ZERO: Lane = Lane([0.0; BATCH]);
}

/// The registers of tapes for one thread. Made once; an evaluation allocates nothing.
pub struct Workspace {
    /// Value lanes; the first three are the points.
    pub(super) lanes: Vec<Lane>,
    /// Four lanes a number: value and gradient.
    pub(super) duals: Vec<Lane>,
    pub(super) marks: MarkLanes,
    pub(super) result: usize,
    pub(super) result_dual: usize,
}

impl Workspace {
    /// Registers for tapes that take no more of them than these two: one that finds values, one that finds marks.
    pub fn new(values: Tape<'_>, marks: Tape<'_>) -> Workspace {
        let (values, marks) = (values.code, marks.code);
        let lanes = usize::from(values.registers.max(marks.registers));
        Workspace {
            lanes: vec![Lane::ZERO; lanes],
            duals: vec![Lane::ZERO; 4 * usize::from(values.registers)],
            marks: MarkLanes::new(marks),
            result: usize::from(values.result),
            result_dual: 4 * usize::from(values.result),
        }
    }

    /// Makes room for the values and gradients of another tape.
    pub fn make_room(&mut self, values: Tape<'_>) {
        let lanes = usize::from(values.code.registers);
        if self.lanes.len() < lanes {
            self.lanes.resize(lanes, Lane::ZERO);
        }
        if self.duals.len() < 4 * lanes {
            self.duals.resize(4 * lanes, Lane::ZERO);
        }
    }

    /// The points to evaluate at: x, y and z.
    #[inline(always)]
    pub fn points_mut(&mut self) -> &mut [Lane; 3] {
        (&mut self.lanes[..3])
            .try_into()
            .expect("a workspace has three lanes at least")
    }

    /// The points to evaluate at.
    #[inline(always)]
    pub fn points(&self) -> &[Lane; 3] {
        (&self.lanes[..3])
            .try_into()
            .expect("a workspace has three lanes at least")
    }

    /// What [`values`](crate::values) found.
    #[inline(always)]
    pub fn values(&self) -> &Lane {
        &self.lanes[self.result]
    }

    /// Where [`values`](crate::values) leaves what it finds, for what is made of it.
    #[inline(always)]
    pub fn values_mut(&mut self) -> &mut Lane {
        &mut self.lanes[self.result]
    }

    /// The values that [`gradients`](crate::gradients) found.
    #[inline(always)]
    pub fn gradient_values(&self) -> &Lane {
        &self.duals[self.result_dual]
    }

    /// Takes the points as those that are mapped.
    pub(super) fn begin_places(&mut self, tape: Tape<'_>) {
        let lanes = 4 * usize::from(tape.code.registers);
        if self.duals.len() < lanes {
            self.duals.resize(lanes, Lane::ZERO);
        }
        self.begin_gradients(tape);
    }

    /// What [`places`](crate::places) left in a register: of each coordinate of the mapped point its value and its derivatives along x, y
    /// and z.
    pub fn place(&self, register: u16) -> &[Lane; 12] {
        (&self.duals[4 * usize::from(register)..][..12])
            .try_into()
            .expect("a point has three coordinates of four numbers")
    }

    /// Takes the points as those to differentiate at.
    pub(super) fn begin_gradients(&mut self, tape: Tape<'_>) {
        for k in 0..3 {
            self.duals[4 * k] = self.lanes[k];
            for j in 0..3 {
                self.duals[4 * k + 1 + j]
                    .0
                    .fill(if j == k { 1.0 } else { 0.0 });
            }
        }
        self.result_dual = 4 * usize::from(tape.code.result);
    }

    /// Where [`gradients`](crate::gradients) leaves what it finds: the value and the derivatives along x, y and z.
    pub fn gradients_mut(&mut self) -> &mut [Lane; 4] {
        (&mut self.duals[self.result_dual..][..4])
            .try_into()
            .expect("a result has a value and three derivatives")
    }

    /// What [`gradients`](crate::gradients) found at point number `i`: the value and the derivatives along x, y and z.
    pub fn gradient(&self, i: usize) -> (f32, [f32; 3]) {
        let gradient = self.gradients().each_ref().map(|lane| lane.0[i]);
        (self.gradient_values().0[i], gradient)
    }

    /// What [`gradients`](crate::gradients) found: the derivatives along x, y and z.
    #[inline(always)]
    pub fn gradients(&self) -> &[Lane; 3] {
        (&self.duals[self.result_dual + 1..][..3])
            .try_into()
            .expect("a result has three derivatives")
    }
}

/// The marks of a batch. Numbers of objects and materials are whole; -1 where there is none.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Marks {
    /// Object.
    pub object: Lane,
    /// The material that counts most.
    pub first: Lane,
    /// The material that counts second.
    pub second: Lane,
    /// Share of the second, 0 to 1/2.
    pub share: Lane,
    /// How near the orbit of a fractal came to the origin and to the planes x = 0, y = 0 and z = 0; zero elsewhere.
    pub orbit: [Lane; 4],
}

impl Marks {
    pub(super) const NONE: Marks = Marks {
        object: Lane([-1.0; BATCH]),
        first: Lane([-1.0; BATCH]),
        second: Lane([-1.0; BATCH]),
        share: Lane::ZERO,
        orbit: [Lane::ZERO; 4],
    };
}

/// Marks of every value register.
pub(super) struct MarkLanes {
    pub(super) marks: Vec<Marks>,
    /// Share of the second operand of a join.
    pub(super) share: Lane,
    pub(super) result: usize,
}

impl MarkLanes {
    pub(super) fn new(code: &Code) -> Self {
        MarkLanes {
            marks: vec![Marks::NONE; usize::from(code.registers)],
            share: Lane::ZERO,
            result: usize::from(code.result),
        }
    }
}

impl Workspace {
    /// What [`marks`](crate::marks) found.
    pub fn marks(&self) -> &Marks {
        &self.marks.marks[self.marks.result]
    }

    /// Where [`marks`](crate::marks) leaves what it finds.
    pub fn marks_mut(&mut self) -> &mut Marks {
        &mut self.marks.marks[self.marks.result]
    }
}
