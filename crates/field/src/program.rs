//! Programs: what a field tree compiles to.
//!
//! A program is a flat list of typed instructions, a primitive or an operation each, that read their numbers from a
//! parameter array. The list depends on the tree's structure only: moving a shape, turning a knob or advancing time
//! changes parameters and leaves the [`Structure`] equal.
//!
//! The value of a program never overestimates the distance to its surface: it is divided by the Lipschitz constant where
//! that may be above 1.

use crate::compile;
use crate::field::Field;
use crate::formula::ColourFormula;
use std::sync::Arc;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::tape::{Code, Operation, Tape};
use zeroset_number::Data;

/// What a program does, apart from its numbers. Programs of equal structure can share a shader.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Structure {
    /// Instructions for values.
    pub values: Code,
    /// Instructions for values with marks: which object and which materials a point belongs to.
    pub marks: Code,
    /// Parameters that are 1 for rays outside all bodies, and others for rays inside clear ones: see [`Program::inside`].
    pub sides: Vec<u32>,
    /// Instructions that find where a point lies in the spaces of [`Structure::coats`], each in a register of its own.
    pub places: Code,
    /// Materials in the space of what they were painted on: see [`Program::compile_painted`].
    pub coats: Vec<Coat>,
    /// Instructions of formulas of colours, each of which leaves red, green and blue in the place of the point: see
    /// [`Program::with_colours`].
    pub colours: Vec<Code>,
}

/// A material in the space of what it was painted on. A part that was painted and then moved to two places has two.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Coat {
    /// The number of the material.
    pub material: u16,
    /// Where [`Structure::places`] leave the point in that space.
    pub place: u16,
}

/// A compiled field. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) structure: Arc<Structure>,
    pub(crate) data: Arc<Data>,
    pub(crate) bounds: Aabb,
    pub(crate) exactness: Exactness,
    pub(crate) steep: bool,
    pub(crate) slope: f64,
    pub(crate) unbounded: bool,
    /// The same without guides, where there are any.
    pub(crate) bare: Option<Arc<Program>>,
}

/// Slopes below this are none.
pub const FLAT: f32 = 1e-12;

/// The side in [`Program::inside_marks`].
pub const INSIDE_MARKS: f32 = -0.5;

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
    /// More materials, counted once for each part that they lie on, than can be numbered.
    #[error("patterns lie on more than {limit} parts: paint them where they are joined")]
    Coats {
        /// The limit.
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
        compile::compile(field, limits, &[])
    }

    /// Compiles a field whose materials may depend on where they are. `spatial` says of each material whether it does. Where such a one was
    /// painted on something that was then moved, or otherwise mapped, its marks are not its number n, but `spatial.len() + k`, where k is that of a
    /// coat (see [`Program::coats`]): this material, in the space of what it was painted on.
    ///
    /// # Errors
    /// A field over the limits.
    pub fn compile_painted(
        field: &Field,
        limits: &Limits,
        spatial: &[bool],
    ) -> Result<Program, CompileError> {
        compile::compile(field, limits, spatial)
    }

    /// The same program, which also knows formulas of colours ([`Structure::colours`], in this order). Their numbers and grids come behind
    /// its own, so that its own are where they were.
    ///
    /// # Errors
    /// Formulas over the limits.
    pub fn with_colours(
        &self,
        formulas: &[Arc<ColourFormula>],
        limits: &Limits,
    ) -> Result<Program, CompileError> {
        compile::with_colours(self, formulas, limits)
    }

    /// What finds where a point lies in the spaces of coats. It has no result: [`Coat::place`] says where each is.
    pub fn places(&self) -> Tape<'_> {
        Tape {
            code: &self.structure.places,
            data: &self.data,
        }
    }

    /// The materials in the spaces of what they were painted on.
    pub fn coats(&self) -> &[Coat] {
        &self.structure.coats
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
        &self.data.params
    }

    /// Its numbers and grids.
    pub fn data(&self) -> &Data {
        &self.data
    }

    /// The program for rays inside clear bodies, where there are clear and opaque ones.
    ///
    /// With c and o the values of all clear and of all opaque bodies, this program is `min(c, o)`, their union, which is zero at no place
    /// between a glass and the table that it stands on. The other one is `-min(-c, o)`: the clear bodies without the opaque ones.
    /// (Both are `s min(s c, o)`: the structure is the same.)
    pub fn inside(&self) -> Option<Program> {
        self.sided(-1.0)
    }

    /// The program that tells for rays inside clear bodies to which body a place belongs that is a little behind a surface. Where a clear and
    /// an opaque body touch, it is as much behind the one as before the other: the opaque one counts.
    pub fn inside_marks(&self) -> Option<Program> {
        self.sided(INSIDE_MARKS)
    }

    fn sided(&self, side: f32) -> Option<Program> {
        if self.structure.sides.is_empty() {
            return None;
        }
        let mut data = Data::clone(&self.data);
        for &at in &self.structure.sides {
            if let Some(x) = data.params.get_mut(at as usize) {
                *x = side;
            }
        }
        let bare = self.bare.as_ref().and_then(|bare| bare.sided(side));
        Some(Program {
            data: Arc::new(data),
            bare: bare.map(Arc::new),
            ..self.clone()
        })
    }

    /// What finds its values.
    pub fn values(&self) -> Tape<'_> {
        Tape {
            code: &self.structure.values,
            data: &self.data,
        }
    }

    /// What finds which object and which materials a point belongs to.
    pub fn marks(&self) -> Tape<'_> {
        Tape {
            code: &self.structure.marks,
            data: &self.data,
        }
    }

    /// What rays are marched through: the same surface, in most programs by the same values. Where a formula has no Lipschitz constant, values are
    /// made about as large as distances by what is known of the formula from a grid; here they are not, and their ranges and slopes are tighter.
    pub fn marched(&self) -> &Program {
        self.bare.as_deref().unwrap_or(self)
    }

    /// What is shown as the distance to the surface where the field has this value and gradient, and its gradient: the value
    /// where it is close to the distance, else the value over the length of the gradient (Taubin 1994), which does not depend
    /// on the constant that the value was divided by.
    pub fn shown_distance(&self, (value, gradient): (f32, [f32; 3])) -> (f32, [f32; 3]) {
        if self.is_close() {
            return (value, gradient);
        }
        let length = gradient.iter().map(|g| g * g).sum::<f32>().sqrt();
        let scale = 1.0 / length.max(FLAT);
        (value * scale, gradient.map(|g| g * scale))
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

    /// Whether its value may change by more than 1 a unit, by any amount: see [`Facts::unbounded`](crate::field::Facts::unbounded).
    pub fn is_unbounded(&self) -> bool {
        self.unbounded
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
