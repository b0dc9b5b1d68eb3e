//! The functions of formulas by name, for the scene language and its reference.

use super::builder::{BuildError, Expression};

/// A function that formulas may call.
#[derive(Debug)]
pub struct Function {
    /// Name in the scene language.
    pub name: &'static str,
    /// Names of its arguments.
    pub params: &'static [&'static str],
    /// Whether the last argument may be followed by more of its kind.
    pub more: bool,
    /// One line.
    pub doc: &'static str,
    call: fn(&[Expression]) -> Expression,
}

impl Function {
    /// Calls it, on one or more expressions of the same formula.
    ///
    /// # Errors
    /// The wrong number of arguments, arguments that do not fit, a formula of too many steps.
    pub fn call(&self, arguments: &[Expression]) -> Result<Expression, BuildError> {
        let (given, wanted) = (arguments.len(), self.params.len());
        if given < wanted || (given > wanted && !self.more) {
            let least = if self.more { "at least " } else { "" };
            let plural = if wanted == 1 { "" } else { "s" };
            return Err(BuildError::Arguments {
                function: self.name,
                wanted: format!(
                    "{least}{wanted} argument{plural} ({})",
                    self.params.join(", ")
                ),
                given,
            });
        }
        let value = (self.call)(arguments);
        value.builder().check()?;
        Ok(value)
    }
}

macro_rules! functions {
    ($($name:literal ($($param:literal),* $(; $more:literal)?) $doc:literal, |$a:ident| $call:expr;)*) => {
        &[$(Function {
            name: $name,
            params: &[$($param),*],
            more: false $(| $more)?,
            doc: $doc,
            call: |$a| $call,
        }),*]
    };
}

/// All functions. The operators `+`, `-`, `*`, `/` and `%` are not among them.
pub fn functions() -> &'static [Function] {
    FUNCTIONS
}

static FUNCTIONS: &[Function] = functions! {
    "abs" ("x") "Absolute value.", |a| a[0].abs();
    "sign" ("x") "-1 below 0, else 1. It jumps, so no slope can be proven where x is 0.", |a| a[0].sign();
    "floor" ("x") "The largest whole number that is not above x. It jumps.", |a| a[0].floor();
    "ceil" ("x") "The smallest whole number that is not below x. It jumps.", |a| a[0].ceil();
    "round" ("x") "The nearest whole number, halves upwards. It jumps.", |a| a[0].round();
    "fract" ("x") "x - floor(x). It jumps.", |a| a[0].fract();
    "mod" ("x", "y") "x - y * floor(x / y). It jumps.", |a| a[0].modulo(&a[1]);
    "min" ("x", "y"; true) "The smallest.", |a| a[1..].iter().fold(a[0].clone(), |m, x| m.min(x));
    "max" ("x", "y"; true) "The largest.", |a| a[1..].iter().fold(a[0].clone(), |m, x| m.max(x));
    "clamp" ("x", "lo", "hi") "x, but not outside lo to hi.", |a| a[0].clamp(&a[1], &a[2]);
    "mix" ("x", "y", "t") "x + (y - x) * t.", |a| a[0].mix(&a[1], &a[2]);
    "step" ("edge", "x") "0 where x is below the edge, else 1. It jumps.", |a| a[1].step(&a[0]);
    "smoothstep" ("lo", "hi", "x") "A smooth step from 0 at lo to 1 at hi.", |a| a[2].smoothstep(&a[0], &a[1]);
    "sqrt" ("x") "Square root; 0 below 0. Its slope has no bound at 0, that of length(...) has.", |a| a[0].sqrt();
    "square" ("x") "x * x.", |a| a[0].square();
    "pow" ("x", "y") "x to the power of y. x may be below 0 where y is a whole number, not one that changes from point to point.", |a| a[0].pow(&a[1]);
    "powi" ("x", "n") "x to a whole power n of -64 to 64, a plain number; x may be below 0.", |a| powi(&a[0], &a[1]);
    "exp" ("x") "e to the power of x.", |a| a[0].exp();
    "log" ("x") "Natural logarithm, for x above 0.", |a| a[0].ln();
    "sin" ("angle") "Sine of an angle in radians.", |a| a[0].sin();
    "cos" ("angle") "Cosine of an angle in radians.", |a| a[0].cos();
    "tan" ("angle") "Tangent of an angle in radians.", |a| a[0].tan();
    "asin" ("x") "Angle in radians, -pi/2 to pi/2, that has this sine.", |a| a[0].asin();
    "acos" ("x") "Angle in radians, 0 to pi, that has this cosine.", |a| a[0].acos();
    "atan" ("x") "Angle in radians, -pi/2 to pi/2, that has this tangent.", |a| a[0].atan();
    "atan2" ("y", "x") "Angle of the point (x, y) in radians, -pi to pi. It jumps where y is 0 and x below 0, unless it \
        ends in the sine or cosine of a whole multiple.", |a| a[0].atan2(&a[1]);
    "tanh" ("x") "Hyperbolic tangent.", |a| a[0].tanh();
    "length" ("v"; true) "Length of a vector, or of several numbers.", |a| a[1..]
        .iter()
        .fold(a[0].length(), |length, x| length.hypot(x.length()));
    "distance" ("a", "b") "Distance of two points.", |a| a[0].distance(&a[1]);
    "dot" ("a", "b") "Scalar product.", |a| a[0].dot(&a[1]);
    "cross_product" ("a", "b") "Vector product of two vectors of 3.", |a| a[0].cross(&a[1]);
    "normalize" ("v") "The vector of length 1 in the same direction.", |a| a[0].normalize();
    "vector" ("x", "y"; true) "A vector of 2 to 4 numbers.", |a| a[0].builder().vector(a);
};

fn powi(x: &Expression, n: &Expression) -> Expression {
    match n.as_constant() {
        Some(n) if n.fract() == 0.0 && (-64.0..=64.0).contains(&n) => x.powi(n as i32),
        other => x.builder().fail(BuildError::Parts {
            function: "powi",
            wanted: "a whole number of -64 to 64 as its power",
            given: other.map_or("a value that changes from point to point".into(), |n| {
                n.to_string()
            }),
        }),
    }
}
