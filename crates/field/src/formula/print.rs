//! Steps as text, for messages.

use super::{Binary, FormulaStep, NoiseKind, Unary};

/// Longest text of a step; what does not fit is left out.
const LONGEST: usize = 72;

/// Deepest nesting that is written out.
const DEEPEST: u32 = 12;

/// How tightly an operator binds its operands.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Tie {
    Sum,
    Product,
    Whole,
}

/// A step in the way that a person would write it, shortened.
pub(crate) fn text(steps: &[FormulaStep], step: u32) -> String {
    // the deepest nesting that fits
    (1..=DEEPEST)
        .rev()
        .map(|depth| write(steps, step, depth, Tie::Sum).unwrap_or_default())
        .find(|text| !text.is_empty() && text.len() <= LONGEST)
        .unwrap_or_else(|| "...".into())
}

/// `None` where it is longer than any text that is wanted.
fn write(steps: &[FormulaStep], step: u32, depth: u32, within: Tie) -> Option<String> {
    let operand = |i: u32, tie: Tie| write(steps, i, depth - 1, tie);
    let text = match steps[step as usize] {
        FormulaStep::Coordinate(k) => ["x", "y", "z"][usize::from(k)].into(),
        FormulaStep::Constant(c) => number(c),
        _ if depth == 0 => "...".into(),
        FormulaStep::Unary(Unary::Neg, x) => format!("-{}", operand(x, Tie::Whole)?),
        FormulaStep::Unary(Unary::Square, x) => {
            let x = operand(x, Tie::Product)?;
            enclosed(format!("{x} * {x}"), Tie::Product, within)
        }
        FormulaStep::Unary(f, x) => format!("{}({})", unary(f), operand(x, Tie::Sum)?),
        FormulaStep::Noise(_, q) | FormulaStep::Field(_, q) => {
            let name = match steps[step as usize] {
                FormulaStep::Noise(kind, _) => noise(kind).to_owned(),
                _ => "shape".to_owned(),
            };
            match point(steps, q) {
                Some(p) => format!("{name}({p})"),
                None => {
                    let [x, y, z] = q.map(|i| operand(i, Tie::Sum));
                    format!("{name}({}, {}, {})", x?, y?, z?)
                }
            }
        }
        FormulaStep::Binary(f, x, y) => match f {
            Binary::Less => enclosed(
                format!("{} < {}", operand(x, Tie::Sum)?, operand(y, Tie::Sum)?),
                Tie::Sum,
                within,
            ),
            Binary::Sub if is_condition(steps, y) => format!("not {}", operand(y, Tie::Whole)?),
            Binary::Min if is_condition(steps, x) => {
                format!(
                    "{} and {}",
                    operand(x, Tie::Product)?,
                    operand(y, Tie::Product)?
                )
            }
            Binary::Max if is_condition(steps, x) => {
                format!(
                    "{} or {}",
                    operand(x, Tie::Product)?,
                    operand(y, Tie::Product)?
                )
            }
            Binary::Either => match (steps[x as usize], steps[y as usize]) {
                (FormulaStep::Binary(Binary::When, c, a), FormulaStep::Binary(_, _, b)) => {
                    let [a, c, b] = [a, c, b].map(|i| operand(i, Tie::Sum));
                    enclosed(format!("{} if {} else {}", a?, c?, b?), Tie::Sum, within)
                }
                _ => format!(
                    "either({}, {})",
                    operand(x, Tie::Sum)?,
                    operand(y, Tie::Sum)?
                ),
            },
            Binary::Add => enclosed(
                format!("{} + {}", operand(x, Tie::Sum)?, operand(y, Tie::Sum)?),
                Tie::Sum,
                within,
            ),
            Binary::Sub => enclosed(
                format!("{} - {}", operand(x, Tie::Sum)?, operand(y, Tie::Product)?),
                Tie::Sum,
                within,
            ),
            Binary::Mul => enclosed(
                format!(
                    "{} * {}",
                    operand(x, Tie::Product)?,
                    operand(y, Tie::Product)?
                ),
                Tie::Product,
                within,
            ),
            Binary::Div => enclosed(
                format!(
                    "{} / {}",
                    operand(x, Tie::Product)?,
                    operand(y, Tie::Whole)?
                ),
                Tie::Product,
                within,
            ),
            f => format!(
                "{}({}, {})",
                binary(f),
                operand(x, Tie::Sum)?,
                operand(y, Tie::Sum)?
            ),
        },
    };
    (text.len() <= 2 * LONGEST).then_some(text)
}

/// Whether a step is a condition.
fn is_condition(steps: &[FormulaStep], step: u32) -> bool {
    let mut step = step;
    loop {
        step = match steps[step as usize] {
            FormulaStep::Binary(Binary::Less, ..) => return true,
            FormulaStep::Binary(Binary::Min | Binary::Max, x, _) => x,
            FormulaStep::Binary(Binary::Sub, one, x)
                if steps[one as usize] == FormulaStep::Constant(1.0) =>
            {
                x
            }
            _ => return false,
        }
    }
}

/// `p`, where three steps are the point itself.
fn point(steps: &[FormulaStep], q: [u32; 3]) -> Option<&'static str> {
    let is = |k: usize| steps[q[k] as usize] == FormulaStep::Coordinate(k as u8);
    (is(0) && is(1) && is(2)).then_some("p")
}

/// The name of a noise in the scene language.
pub(crate) fn noise(kind: NoiseKind) -> &'static str {
    match kind {
        NoiseKind::Value => "value_noise",
        NoiseKind::Gradient => "noise",
        NoiseKind::Cellular => "cellular_noise",
    }
}

fn enclosed(text: String, tie: Tie, within: Tie) -> String {
    if tie < within {
        format!("({text})")
    } else {
        text
    }
}

/// A number with the digits that matter.
pub(crate) fn number(c: f64) -> String {
    let short = format!("{c}");
    if short.len() <= 7 {
        return short;
    }
    let (digits, power) = if (1e-3..1e6).contains(&c.abs()) {
        (format!("{c:.4}"), String::new())
    } else {
        let text = format!("{c:.3e}");
        match text.split_once('e') {
            Some((digits, power)) => (digits.into(), format!("e{power}")),
            None => (text, String::new()),
        }
    };
    let digits = match digits.contains('.') {
        true => digits.trim_end_matches('0').trim_end_matches('.'),
        false => &digits,
    };
    format!("{digits}{power}")
}

/// The name of a function in the scene language.
pub(crate) fn unary(f: Unary) -> &'static str {
    match f {
        Unary::Neg => "-",
        Unary::Abs => "abs",
        Unary::Sqrt => "sqrt",
        Unary::Square => "square",
        Unary::Floor => "floor",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Tan => "tan",
        Unary::Asin => "asin",
        Unary::Acos => "acos",
        Unary::Atan => "atan",
        Unary::Exp => "exp",
        Unary::Ln => "log",
        Unary::Tanh => "tanh",
    }
}

/// The name of a function or operator in the scene language.
pub(crate) fn binary(f: Binary) -> &'static str {
    match f {
        Binary::Add => "+",
        Binary::Sub => "-",
        Binary::Mul => "*",
        Binary::Div => "/",
        Binary::Min => "min",
        Binary::Max => "max",
        Binary::Modulo => "mod",
        Binary::Pow => "pow",
        Binary::Atan2 => "atan2",
        Binary::Hypot => "length",
        Binary::Less => "less",
        Binary::When => "when",
        Binary::Either => "either",
    }
}
