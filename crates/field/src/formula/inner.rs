//! Fields that formulas take the values of.

use crate::compile;
use crate::field::Field;
use crate::program::{CompileError, Limits, Program};
use zeroset_eval::{Point, PointNumber};
use zeroset_number::Vec3;

/// A field whose value a formula takes at a point that it computes.
///
/// Its value is the one that modifiers of the field see: a length where the field is a distance, before any division by its
/// Lipschitz constant.
#[derive(Clone, Debug)]
pub struct Inner {
    field: Field,
    program: Program,
    /// What the program's value was divided by.
    divisor: f64,
}

impl PartialEq for Inner {
    fn eq(&self, o: &Self) -> bool {
        self.program.structure() == o.program.structure()
            && self.program.params() == o.program.params()
            && self.divisor == o.divisor
    }
}

impl Inner {
    /// A field, ready to be evaluated.
    ///
    /// # Errors
    /// A field that is too large.
    pub fn new(field: &Field) -> Result<Inner, CompileError> {
        let program = compile::compile_any(field, &Limits::default(), &[])?;
        let facts = field.facts();
        let divisor = if facts.steep && facts.slope > 0.0 {
            facts.slope / (1.0 - 1e-6)
        } else {
            1.0
        };
        Ok(Inner {
            field: field.clone(),
            program,
            divisor,
        })
    }

    /// The field.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// Instructions that its value takes.
    pub(crate) fn instructions(&self) -> usize {
        self.program.structure().values.instructions.len()
    }

    /// Its value at `p`.
    pub fn value<R: PointNumber>(&self, p: Vec3<R>) -> R {
        let value = Point::new(self.program.values()).value(p);
        value * value.like(R::constant(self.divisor))
    }
}
