//! Register lists (`.vm`): formulas as MPR (Keeter 2020) and Fidget write them down, one operation a line.
//!
//! A line is a name, an operation and what it is done with: `_2 add _0 _1`. A name is any word; what it stands for is given once, before it is
//! used. The value of the last line is that of the formula. `#` begins a comment.

use crate::json::formula::UNARY;
use std::collections::HashMap;
use zeroset_catalogue::op::arithmetic::{Binary, Unary};
use zeroset_field::formula::{Builder, Expression};

/// A formula as a list of operations, each over those before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Registers {
    operations: Vec<Operation>,
}

/// One operation. Numbers are those of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    Coordinate(usize),
    Unary(Unary, usize),
    /// Functions that are no single step of a formula.
    Made(Made, usize),
    Binary(Binary, usize, usize),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Made {
    Ceil,
    Round,
    Recip,
}

/// Why a text is no register list.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RegistersError {
    /// A line that cannot be read.
    #[error("line {line}: {reason}")]
    Line {
        /// Its number, from 1.
        line: usize,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// A text without a single operation.
    #[error(
        "it holds no operation: a line is a name, an operation and its operands, as in `_2 add _0 _1`"
    )]
    Empty,
}

const MADE: [(&str, Made); 3] = [
    ("ceil", Made::Ceil),
    ("round", Made::Round),
    ("recip", Made::Recip),
];
const BINARY: [(&str, Binary); 9] = [
    ("add", Binary::Add),
    ("sub", Binary::Sub),
    ("mul", Binary::Mul),
    ("div", Binary::Div),
    ("min", Binary::Min),
    ("max", Binary::Max),
    ("mod", Binary::Modulo),
    ("pow", Binary::Pow),
    ("atan2", Binary::Atan2),
];
const COORDINATES: [&str; 3] = ["var-x", "var-y", "var-z"];

fn named<T: Copy>(list: &[(&str, T)], name: &str) -> Option<T> {
    list.iter().find(|(n, _)| *n == name).map(|(_, what)| *what)
}

impl Registers {
    /// Reads a list.
    ///
    /// # Errors
    /// The first line that is no operation over earlier ones.
    pub fn parse(text: &str) -> Result<Registers, RegistersError> {
        let mut operations = Vec::new();
        let mut names: HashMap<&str, usize> = HashMap::new();
        for (number, line) in text.lines().enumerate() {
            let wrong = |reason: String| RegistersError::Line {
                line: number + 1,
                reason,
            };
            let line = line.split('#').next().unwrap_or_default();
            let mut words = line.split_whitespace();
            let Some(name) = words.next() else { continue };
            let Some(word) = words.next() else {
                return Err(wrong(format!("`{name}` has no operation")));
            };
            let operands: Vec<&str> = words.collect();
            let operation = operation(word, &operands, &names).map_err(wrong)?;
            if names.insert(name, operations.len()).is_some() {
                return Err(wrong(format!(
                    "`{name}` is there already: a name is given once"
                )));
            }
            operations.push(operation);
        }
        match operations.is_empty() {
            true => Err(RegistersError::Empty),
            false => Ok(Registers { operations }),
        }
    }

    /// How many operations it takes.
    pub fn operations(&self) -> usize {
        self.operations.len()
    }

    /// Whether it uses z.
    pub fn is_solid(&self) -> bool {
        self.operations.contains(&Operation::Coordinate(2))
    }

    /// Writes the formula down, at a point that has z if the list uses it.
    pub(crate) fn write(&self, builder: &Builder, point: &Expression) -> Expression {
        let mut values: Vec<Expression> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let value = match *operation {
                Operation::Constant(c) => builder.constant(c),
                Operation::Coordinate(k) => point.part(k),
                Operation::Unary(Unary::Sqrt, x) => match self.squares(x) {
                    // bounded in its slope where the root of a sum of squares is not
                    Some(parts) => {
                        let mut parts = parts.into_iter().map(|k| values[k].clone());
                        let first = parts.next().unwrap_or_else(|| builder.constant(0.0));
                        parts.fold(first, |a, b| builder.binary(Binary::Hypot, &a, &b))
                    }
                    None => builder.unary(Unary::Sqrt, &values[x]),
                },
                Operation::Unary(f, x) => builder.unary(f, &values[x]),
                Operation::Made(Made::Ceil, x) => values[x].ceil(),
                Operation::Made(Made::Round, x) => values[x].round(),
                Operation::Made(Made::Recip, x) => {
                    builder.binary(Binary::Div, &builder.constant(1.0), &values[x])
                }
                Operation::Binary(Binary::Pow, x, n) => match values[n].as_constant() {
                    Some(power) if power.fract() == 0.0 && power.abs() <= 64.0 => {
                        values[x].powi(power as i32)
                    }
                    _ => builder.binary(Binary::Pow, &values[x], &values[n]),
                },
                Operation::Binary(Binary::Mul, x, y) if x == y => {
                    builder.unary(Unary::Square, &values[x])
                }
                Operation::Binary(f, x, y) => builder.binary(f, &values[x], &values[y]),
            };
            values.push(value);
        }
        values.pop().unwrap_or_else(|| builder.constant(0.0))
    }

    /// What is squared and added up in operation `at`, if it is a sum of two or three squares.
    fn squares(&self, at: usize) -> Option<Vec<usize>> {
        let (mut open, mut parts) = (vec![at], Vec::new());
        while let Some(k) = open.pop() {
            match self.operations[k] {
                Operation::Unary(Unary::Square, x) => parts.push(x),
                Operation::Binary(Binary::Mul, x, y) if x == y => parts.push(x),
                Operation::Binary(Binary::Add, x, y) => open.extend([y, x]),
                _ => return None,
            }
            if open.len() + parts.len() > 3 {
                return None;
            }
        }
        (parts.len() > 1).then_some(parts)
    }
}

fn operation(
    word: &str,
    operands: &[&str],
    names: &HashMap<&str, usize>,
) -> Result<Operation, String> {
    let takes = |n: usize| match operands.len() == n {
        true => Ok(()),
        false => Err(format!(
            "`{word}` takes {n} operand{}, {} given",
            if n == 1 { "" } else { "s" },
            operands.len()
        )),
    };
    let value = |k: usize| {
        let name = operands[k];
        (names.get(name).copied()).ok_or_else(|| format!("`{name}` is used before it is given"))
    };
    if word == "const" {
        takes(1)?;
        let number: f64 =
            (operands[0].parse()).map_err(|_| format!("`{}` is not a number", operands[0]))?;
        return Ok(Operation::Constant(number));
    }
    if let Some(k) = COORDINATES.iter().position(|name| *name == word) {
        takes(0)?;
        return Ok(Operation::Coordinate(k));
    }
    if let Some(f) = named(UNARY, word) {
        takes(1)?;
        return Ok(Operation::Unary(f, value(0)?));
    }
    if let Some(f) = named(&MADE, word) {
        takes(1)?;
        return Ok(Operation::Made(f, value(0)?));
    }
    if let Some(f) = named(&BINARY, word) {
        takes(2)?;
        return Ok(Operation::Binary(f, value(0)?, value(1)?));
    }
    let known = UNARY.iter().map(|(name, _)| *name);
    let known = known.chain(MADE.iter().map(|(name, _)| *name));
    let known = known.chain(BINARY.iter().map(|(name, _)| *name));
    let known: Vec<&str> = COORDINATES
        .into_iter()
        .chain(["const"])
        .chain(known)
        .collect();
    Err(format!(
        "`{word}` is no operation that is read here; these are: {}",
        known.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::{Registers, RegistersError};
    use proptest::prelude::*;
    use zeroset_catalogue::bounds::Aabb;
    use zeroset_field::formula::{Budget, Builder, Formula};
    use zeroset_number::{F64, v3};

    fn value(text: &str, [x, y, z]: [f64; 3]) -> f64 {
        let builder = Builder::new();
        let registers = Registers::parse(text).expect("a list");
        let value = registers.write(&builder, &builder.point());
        let steps = builder.finish(&value).expect("a formula");
        steps.eval(v3(F64(x), F64(y), F64(z))).0
    }

    #[test]
    fn a_list_is_its_formula() {
        let circle = "# a circle\nx var-x\ny var-y\n\nxx square x\nyy mul y y # another way\nrr add xx yy\nr sqrt rr\nhalf const 0.5\nout sub r half";
        for p in [[0.3f64, 0.4, 2.0], [0.0, 0.0, 0.0], [-3.0, 1.5, 0.1]] {
            let expected = (p[0] * p[0] + p[1] * p[1]).sqrt() - 0.5;
            assert!((value(circle, p) - expected).abs() < 1e-12);
        }
        let all = "x var-x\ny var-y\nz var-z\na mod x y\nb atan2 z x\nc max a b\nthree const 3\nd pow z three\ne recip y\nf round x\ng ceil y\nh add c d\ni add e f\nj add g h\nk min i j\nl abs k\nm neg l\nn exp m\no ln n\np div o y";
        let [x, y, z] = [1.7, 0.6, -0.4f64];
        let c = (x - y * (x / y).floor()).max(z.atan2(x));
        let expected = -((1.0 / y + 2.0f64).min(1.0 + (c + z.powi(3)))).abs() / y;
        assert!((value(all, [x, y, z]) - expected).abs() < 1e-9);
    }

    /// A root of a sum of squares is a length, whose slope has a bound in its middle too: the field needs no stated slope.
    #[test]
    fn roots_of_squares_are_lengths() {
        let ball = "x var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\nd add a b\ne add d c\nf sqrt e\none const 1\ng sub f one";
        let builder = Builder::new();
        let registers = Registers::parse(ball).expect("a list");
        assert!(registers.is_solid());
        assert_eq!(registers.operations(), 11);
        let value = registers.write(&builder, &builder.point());
        let steps = builder.finish(&value).expect("a formula");
        let formula = Formula::prove(steps, Aabb::centred([2.0; 3]), &Budget::default());
        let slope = formula.expect("a bound").slope();
        assert!((1.0..1.01).contains(&slope), "{slope}");
    }

    proptest! {
        /// Whatever stands there, it is read or refused; what is read is a formula, or none for a reason.
        #[test]
        fn any_lines_are_read_or_refused(lines in prop::collection::vec(
            ("[a-d]", "(const|var-[xyz]|neg|sqrt|square|recip|ln|ceil|add|mul|div|mod|pow|atan2|max|#|foo)", "[a-d0-9.e-]{0,4}", "[a-d]?"),
            0..12,
        )) {
            let mut text = String::new();
            for (k, (name, word, a, b)) in lines.iter().enumerate() {
                text += &format!("{name}{k} {word} {a} {b}\n{name} {word} {a}{k} {b}\n");
            }
            if let Ok(list) = Registers::parse(&text) {
                let builder = Builder::new();
                let value = list.write(&builder, &builder.point());
                let _ = builder.finish(&value);
            }
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let wrong = |text: &str| Registers::parse(text).expect_err(text).to_string();
        assert_eq!(
            wrong("a var-x\nb add a c"),
            "line 2: `c` is used before it is given"
        );
        assert_eq!(
            wrong("a var-x\na var-y"),
            "line 2: `a` is there already: a name is given once"
        );
        assert_eq!(wrong("a"), "line 1: `a` has no operation");
        assert_eq!(wrong("a add"), "line 1: `add` takes 2 operands, 0 given");
        assert_eq!(wrong("a const one"), "line 1: `one` is not a number");
        assert!(
            wrong("a var-x\nb cbrt a")
                .starts_with("line 2: `cbrt` is no operation that is read here; these are: var-x,")
        );
        assert_eq!(
            Registers::parse("# nothing\n\n"),
            Err(RegistersError::Empty)
        );
    }
}
