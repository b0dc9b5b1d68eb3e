//! Free-form fields: a formula over x, y and z.

use crate::bounds::Aabb;

/// A function of one number. Angles are radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Unary {
    Neg,
    Abs,
    Sqrt,
    Square,
    Floor,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Exp,
    Ln,
    Tanh,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Min,
    Max,
    /// `x - y floor(x / y)`.
    Modulo,
    /// `x ^ y` for x > 0.
    Pow,
    Atan2,
    /// `sqrt(x^2 + y^2)`: a function of its own because its slope is bounded where the root's is not.
    Hypot,
}

/// One step of a formula; operands are the numbers of earlier steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// x, y or z (0, 1, 2).
    Coordinate(u8),
    /// A number: a parameter of the compiled program, so that changing it changes no structure.
    Constant(f64),
    /// A function of one earlier step.
    Unary(Unary, u32),
    /// A function of two earlier steps.
    Binary(Binary, u32, u32),
}

/// A formula with its box and its slope.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    steps: Vec<Step>,
    bounds: Aabb,
    slope: f64,
    proven: bool,
}

impl Formula {
    /// The steps; the last one is the value.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The box inside which the formula is the field; outside, the field goes on from the box's surface.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Lipschitz constant inside the box.
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Whether the slope was proven, rather than stated by hand.
    pub fn is_proven(&self) -> bool {
        self.proven
    }
}
