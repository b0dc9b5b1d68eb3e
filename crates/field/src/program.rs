//! Programs: what a field tree compiles to.
//!
//! A program is a flat list of typed instructions, a primitive or an operation each, that read their numbers from a
//! parameter array. The list depends on the tree's structure only: moving a shape, turning a knob or advancing time
//! changes parameters and leaves the [`Structure`] equal.
//!
//! The value of a program never overestimates the distance to its surface: it is divided by the Lipschitz constant where
//! that may be above 1.

use crate::bounds::{Aabb, Exactness};
use crate::catalogue::entries::catalogue;
use crate::compile;
use crate::field::{Field, Paint};
use std::sync::Arc;

/// What an instruction does: the kind of operation and its code in the list of that kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A point in, a value out.
    Leaf(u16),
    /// A point in, a point out.
    Warp(u16),
    /// A value and a point in, a value out.
    Change(u16),
    /// Two values in, a value out.
    Pair(u16),
    /// A value in, the same value out, marked as [`Paint`]: only in the list for marks.
    Mark(u8, u16),
}

impl Operation {
    pub(crate) fn mark(paint: Paint) -> Self {
        match paint {
            Paint::Material(m) => Operation::Mark(0, m),
            Paint::Object(o) => Operation::Mark(1, o),
        }
    }
}

/// One step of a program. Registers are numbered in numbers: points take three, values one, points come first. No
/// instruction writes a register that it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    /// What it does.
    pub operation: Operation,
    /// Where the result goes.
    pub out: u16,
    /// First operand: a point for a leaf or a warp, otherwise a value.
    pub a: u16,
    /// Second operand: the point of a change (register 0 where it is not read), the second value of a pair.
    pub b: u16,
    /// Where its parameters begin.
    pub at: u32,
}

/// A list of instructions with its registers. Register 0 holds the point to evaluate at.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Code {
    /// The steps.
    pub instructions: Vec<Instruction>,
    /// Numbers that the registers take.
    pub registers: u16,
    /// Where the result is.
    pub result: u16,
}

/// What a program does, apart from its numbers. Programs of equal structure can share a shader.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Structure {
    /// Instructions for values.
    pub values: Code,
    /// Instructions for values with marks: which object and which materials a point belongs to.
    pub marks: Code,
}

/// A compiled field. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) structure: Arc<Structure>,
    pub(crate) params: Arc<[f32]>,
    pub(crate) bounds: Aabb,
    pub(crate) exactness: Exactness,
    pub(crate) steep: bool,
    pub(crate) slope: f64,
}

/// Programs that divide by more than this hold a field that may be far less than the distance.
const CLOSE: f64 = 1.25;

/// However loose a bound is, a ray gets no more steps than this times those that it may take.
const MOST_PATIENT: f64 = 64.0;

/// What a program may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Instructions.
    pub instructions: usize,
    /// Numbers in the parameter array.
    pub params: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            instructions: 2_500_000,
            params: 4_000_000,
        }
    }
}

/// Why a tree cannot be compiled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompileError {
    /// More instructions than the limit.
    #[error(
        "the field compiles to more than {limit} instructions: use fewer parts, or repeat(...) for many equal ones"
    )]
    Instructions {
        /// The limit.
        limit: usize,
    },
    /// More parameters than the limit.
    #[error(
        "the field has more than {limit} parameters: use shorter lists of points or fewer parts"
    )]
    Params {
        /// The limit.
        limit: usize,
    },
    /// More values alive at once than registers can be numbered.
    #[error("the field needs {needed} registers, {limit} is the limit: nest it less deeply")]
    Registers {
        /// Needed.
        needed: usize,
        /// Allowed.
        limit: usize,
    },
    /// A shape of the plane, which cannot be rendered.
    #[error("the field is 2D: make a solid of it with extrude(...) or revolve(...)")]
    Flat,
}

impl Program {
    /// Compiles a field.
    ///
    /// # Errors
    /// A field over the limits.
    pub fn compile(field: &Field, limits: &Limits) -> Result<Program, CompileError> {
        compile::compile(field, limits)
    }

    /// What it does, apart from its numbers.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// The same, shared.
    pub fn shared_structure(&self) -> Arc<Structure> {
        Arc::clone(&self.structure)
    }

    /// Its numbers.
    pub fn params(&self) -> &[f32] {
        &self.params
    }

    /// A box that holds the solid.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// How true its distance is.
    pub fn exactness(&self) -> Exactness {
        self.exactness
    }

    /// The largest Lipschitz constant that a part of it is divided by, at least 1: near a surface its value may be this much
    /// less than the distance, and rays take that many more steps.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Whether it may divide by a Lipschitz constant above 1: a question of its structure, whatever its numbers.
    pub fn is_steep(&self) -> bool {
        self.steep
    }

    /// Whether its value is near enough to the distance to be shown as one. What is shown of another is the value over the
    /// length of its gradient, which does not depend on the constant that it was divided by.
    pub fn is_close(&self) -> bool {
        self.slope <= CLOSE
    }

    /// How many evaluations a ray may take where it may take `steps` of a field whose value is the distance: one that is less
    /// gets as many more as its slope, within reason.
    pub fn patient(&self, steps: u32) -> u32 {
        let fractal = if self.is_fractal() { 4.0 } else { 1.0 };
        (f64::from(steps) * self.slope.clamp(fractal, MOST_PATIENT)) as u32
    }

    /// Whether a part of it is an estimate of the distance to a set without an end to its detail: rays end where its value
    /// is less than the footprint of a pixel, for there is always more to be found within it.
    pub fn is_fractal(&self) -> bool {
        let primitives = &catalogue().primitives;
        (self.structure.values.instructions.iter()).any(|i| match i.operation {
            Operation::Leaf(code) => {
                (primitives.iter()).any(|p| p.code == code && p.exactness == Exactness::Estimate)
            }
            _ => false,
        })
    }
}
