//! The functions of formulas by name, for the scene language and its reference.

use super::NoiseKind;
use super::builder::{BuildError, Expression};

/// A function that formulas may call.
#[derive(Debug)]
pub struct Function {
    /// Name in the scene language.
    pub name: &'static str,
    /// Names of its arguments.
    pub params: &'static [&'static str],
    /// Names of arguments that may follow.
    pub optional: &'static [&'static str],
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
        let most = wanted + self.optional.len();
        if given < wanted || (given > most && !self.more) {
            let least = if self.more { "at least " } else { "" };
            let up_to = match most > wanted {
                true => format!(" to {most}"),
                false => String::new(),
            };
            let plural = if most == 1 { "" } else { "s" };
            return Err(BuildError::Arguments {
                function: self.name,
                wanted: format!(
                    "{least}{wanted}{up_to} argument{plural} ({})",
                    [self.params, self.optional].concat().join(", ")
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
    ($($name:literal ($($param:literal),* $(; $more:literal)? $(, [$($optional:literal),*])?) $doc:literal, |$a:ident| $call:expr;)*) => {
        &[$(Function {
            name: $name,
            params: &[$($param),*],
            optional: &[$($($optional),*)?],
            more: false $(| $more)?,
            doc: $doc,
            call: |$a| $call,
        }),*]
    };
}

/// All functions but [`ROTATE`], [`WHERE`] and [`EASE`]. The operators `+`, `-`, `*`, `/` and `%` are not among them.
pub fn functions() -> &'static [Function] {
    FUNCTIONS
}

static FUNCTIONS: &[Function] = functions! {
    "abs" ("x") "Absolute value, of each part of a vector.", |a| a[0].abs();
    "sign" ("x") "-1 below 0, else 1. It jumps, so no slope can be proven where x is 0.", |a| a[0].sign();
    "floor" ("x") "The largest whole number that is not above x. It jumps.", |a| a[0].floor();
    "ceil" ("x") "The smallest whole number that is not below x. It jumps.", |a| a[0].ceil();
    "round" ("x") "The nearest whole number, halves upwards. It jumps.", |a| a[0].round();
    "trunc" ("x") "x without its fraction, towards 0. It jumps.", |a| a[0].abs().floor() * a[0].sign();
    "fract" ("x") "x - floor(x). It jumps.", |a| a[0].fract();
    "mod" ("x", "y") "x - y * floor(x / y), as x % y. It jumps.", |a| a[0].modulo(&a[1]);
    "min" ("x"; true) "The smallest of several; of one vector, its smallest part.", |a| match a {
        [v] => v.least(),
        _ => a[1..].iter().fold(a[0].clone(), |m, x| m.min(x)),
    };
    "max" ("x"; true) "The largest of several; of one vector, its largest part.", |a| match a {
        [v] => v.greatest(),
        _ => a[1..].iter().fold(a[0].clone(), |m, x| m.max(x)),
    };
    "smin" ("a", "b", "k") "The smaller, with the edge rounded where a and b differ by less than k (Quilez 2013, quadratic).", |a| a[0].smooth_min(&a[1], &a[2]);
    "smax" ("a", "b", "k") "The larger, with the edge rounded where a and b differ by less than k (Quilez 2013, quadratic).", |a| -(-&a[0]).smooth_min(-&a[1], &a[2]);
    "clamp" ("x", "lo", "hi") "x, but not outside lo to hi.", |a| a[0].clamp(&a[1], &a[2]);
    "saturate" ("x") "x, but not outside 0 to 1.", |a| a[0].clamp(0.0, 1.0);
    "mix" ("x", "y", "t") "x + (y - x) * t, also called lerp.", |a| a[0].mix(&a[1], &a[2]);
    "lerp" ("a", "b", "t") "a + (b - a) * t, also called mix.", |a| a[0].mix(&a[1], &a[2]);
    "step" ("edge", "x") "0 where x is below the edge, else 1. It jumps.", |a| a[1].step(&a[0]);
    "smoothstep" ("lo", "hi", "x") "A smooth step from 0 at lo to 1 at hi.", |a| a[2].smoothstep(&a[0], &a[1]);
    "sqrt" ("x") "Square root; 0 below 0. Its slope has no bound at 0, that of length(...) has.", |a| a[0].sqrt();
    "inversesqrt" ("x") "1 / sqrt(x), for x above 0.", |a| 1.0 / a[0].sqrt();
    "square" ("x") "x * x.", |a| a[0].square();
    "pow" ("x", "y") "x to the power of y. x may be below 0 where y is a whole number, not one that changes from point to point.", |a| a[0].pow(&a[1]);
    "powi" ("x", "n") "x to a whole power n of -64 to 64, a plain number; x may be below 0.", |a| powi(&a[0], &a[1]);
    "exp" ("x") "e to the power of x.", |a| a[0].exp();
    "exp2" ("x") "2 to the power of x.", |a| (&a[0] * std::f64::consts::LN_2).exp();
    "log" ("x") "Natural logarithm, for x above 0.", |a| a[0].ln();
    "log2" ("x") "Logarithm of base 2, for x above 0.", |a| a[0].ln() * std::f64::consts::LOG2_E;
    "sin" ("x") "Sine of x in radians.", |a| a[0].sin();
    "cos" ("x") "Cosine of x in radians.", |a| a[0].cos();
    "tan" ("x") "Tangent of x in radians.", |a| a[0].tan();
    "asin" ("x") "The radians, -pi/2 to pi/2, whose sine is x.", |a| a[0].asin();
    "acos" ("x") "The radians, 0 to pi, whose cosine is x.", |a| a[0].acos();
    "atan" ("y", ["x"]) "The radians, -pi/2 to pi/2, whose tangent is y; of two numbers, atan2(y, x).", |a| match a {
        [y, x] => y.atan2(x),
        _ => a[0].atan(),
    };
    "atan2" ("y", "x") "The radians, -pi to pi, of the point (x, y). It jumps where y is 0 and x below 0, unless it \
        ends in the sine or cosine of a whole multiple.", |a| a[0].atan2(&a[1]);
    "radians" ("x") "Radians of x in degrees.", |a| &a[0] * 1_f64.to_radians();
    "degrees" ("x") "Degrees of x in radians.", |a| &a[0] * 1_f64.to_degrees();
    "sinh" ("x") "Hyperbolic sine.", |a| (a[0].exp() - (-&a[0]).exp()) * 0.5;
    "cosh" ("x") "Hyperbolic cosine.", |a| (a[0].exp() + (-&a[0]).exp()) * 0.5;
    "tanh" ("x") "Hyperbolic tangent.", |a| a[0].tanh();
    "length" ("v"; true) "Length of a vector, or of several numbers.", |a| a[1..]
        .iter()
        .fold(a[0].length(), |length, x| length.hypot(x.length()));
    "hypot" ("x"; true) "sqrt(x * x + y * y), of any number of numbers, or the length of a vector.", |a| a[1..]
        .iter()
        .fold(a[0].length(), |length, x| length.hypot(x.length()));
    "distance" ("a", "b") "Distance of two points.", |a| a[0].distance(&a[1]);
    "dot" ("a", "b") "Scalar product.", |a| a[0].dot(&a[1]);
    "cross" ("a", "b") "Vector product of two vectors of 3.", |a| a[0].cross(&a[1]);
    "normalize" ("v") "The vector of length 1 in the same direction.", |a| a[0].normalize();
    "reflect" ("v", "n") "v mirrored in the plane across the unit vector n: v - 2 * dot(n, v) * n.", |a| &a[0] - &a[1] * (a[1].dot(&a[0]) * 2.0);
    "vector" ("x"; true) "A vector of 2 to 4 numbers; parts of vectors count as numbers.", |a| a[0].builder().vector(a);
    "vec2" ("x"; true) "A vector of 2 numbers; of one number, both parts.", |a| vector(a, 2);
    "vec3" ("x"; true) "A vector of 3 numbers; of one number, all parts.", |a| vector(a, 3);
    "vec4" ("x"; true) "A vector of 4 numbers; of one number, all parts.", |a| vector(a, 4);
    "value_noise" ("p") "Soft blotches, -1 to 1, a cell 1 wide; p has 2 or 3 parts. Its slope is at most 3.75.", |a| a[0].builder().noise(NoiseKind::Value, &a[0]);
    "noise" ("p") "Even waves (Perlin 2002), -1 to 1, a cell 1 wide; p has 2 or 3 parts. Its slope is at most 3.91.", |a| a[0].builder().noise(NoiseKind::Gradient, &a[0]);
    "cellular_noise" ("p") "Distance to the nearest of random points, one a cell (Worley 1996): 0 to 1, of slope 1.", |a| a[0].builder().noise(NoiseKind::Cellular, &a[0]);
    "fbm" ("p", ["octaves"]) "The mean of so many layers of noise, 1 to 8 (4), each twice as fine and half as strong (Musgrave 1993): -1 to 1.", |a| fbm(a);
};

/// The name of what turns vectors: its axis is a word or numbers, so it is called by the language itself.
pub const ROTATE: Function = Function {
    name: "rotate",
    params: &["p", "axis", "theta"],
    optional: &[],
    more: false,
    doc: "A vector of 3 turned about an axis (\"x\", \"y\", \"z\" or three numbers) by theta radians, counter-clockwise where \
          the axis points at you; of a vector of 2, rotate(p, theta).",
    call: |a| {
        a[0].builder().fail(BuildError::Arguments {
            function: "rotate",
            wanted: "a vector, an axis and radians".into(),
            given: a.len(),
        })
    },
};

/// The name of the choice between two values, which takes a condition: it is called by the language itself.
pub const WHERE: Function = Function {
    name: "where",
    params: &["condition", "a", "b"],
    optional: &[],
    more: false,
    doc: "a where the condition holds, else b: the same as a if condition else b.",
    call: |a| {
        a[0].builder().fail(BuildError::Arguments {
            function: "where",
            wanted: "a condition such as p.x > 0 and two values".into(),
            given: a.len(),
        })
    },
};

/// An easing function by its name: it is called by the language itself.
pub const EASE: Function = Function {
    name: "ease",
    params: &["t"],
    optional: &["name"],
    more: false,
    doc: "From 0 to 1 as t does, by an easing function (Penner 2001): \"linear\", or \"in_\", \"out_\" or \"in_out_\" with quad, \
          cubic, quart, quint, sine, expo, circ, back, elastic or bounce; \"in_out_cubic\" where none is named.",
    call: |a| {
        a[0].builder().fail(BuildError::Arguments {
            function: "ease",
            wanted: "a number and a name".into(),
            given: a.len(),
        })
    },
};

/// A vector of `n` numbers, all parts the same where one number is given.
fn vector(a: &[Expression], n: usize) -> Expression {
    let builder = a[0].builder();
    let made = match a {
        [x] if x.parts() == 1 => builder.vector(&vec![x.clone(); n]),
        _ => builder.vector(a),
    };
    if made.parts() == n {
        return made;
    }
    builder.fail(BuildError::Parts {
        function: ["vec2", "vec3", "vec4"][n - 2],
        wanted: ["2 numbers", "3 numbers", "4 numbers"][n - 2],
        given: made.parts().to_string(),
    })
}

fn fbm(a: &[Expression]) -> Expression {
    let octaves = match a.get(1) {
        None => Some(4.0),
        Some(n) => n.as_constant(),
    };
    match octaves {
        Some(n) if n.fract() == 0.0 && (1.0..=8.0).contains(&n) => {
            a[0].fbm(NoiseKind::Gradient, n as u32)
        }
        other => a[0].builder().fail(BuildError::Parts {
            function: "fbm",
            wanted: "a whole number of 1 to 8 octaves",
            given: other.map_or("a value that changes from point to point".into(), |n| {
                n.to_string()
            }),
        }),
    }
}

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
