//! Formulas in JSON: a list of steps, each a number, a coordinate, or a function of earlier steps.

use serde_json::{Map, Value, json};
use zeroset_field::formula::{Binary, Formula, Step, Unary};

/// Names of functions of one step.
const UNARY: &[(&str, Unary)] = &[
    ("neg", Unary::Neg),
    ("abs", Unary::Abs),
    ("sqrt", Unary::Sqrt),
    ("square", Unary::Square),
    ("floor", Unary::Floor),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("asin", Unary::Asin),
    ("acos", Unary::Acos),
    ("atan", Unary::Atan),
    ("exp", Unary::Exp),
    ("ln", Unary::Ln),
    ("tanh", Unary::Tanh),
];

/// Names of functions of two steps.
const BINARY: &[(&str, Binary)] = &[
    ("add", Binary::Add),
    ("sub", Binary::Sub),
    ("mul", Binary::Mul),
    ("div", Binary::Div),
    ("min", Binary::Min),
    ("max", Binary::Max),
    ("modulo", Binary::Modulo),
    ("pow", Binary::Pow),
    ("atan2", Binary::Atan2),
    ("hypot", Binary::Hypot),
];

const COORDINATES: [&str; 3] = ["x", "y", "z"];

fn name_of<T: PartialEq>(table: &[(&'static str, T)], what: &T) -> &'static str {
    table
        .iter()
        .find(|(_, t)| t == what)
        .map_or("", |(name, _)| name)
}

/// A formula with its box and its slope.
pub(super) fn write(formula: &Formula) -> Map<String, Value> {
    let steps = formula.steps().iter().map(|step| match step {
        Step::Constant(x) => json!(x),
        Step::Coordinate(k) => json!(COORDINATES.get(usize::from(*k))),
        Step::Unary(f, a) => json!([name_of(UNARY, f), a]),
        Step::Binary(f, a, b) => json!([name_of(BINARY, f), a, b]),
    });
    let mut body = Map::new();
    body.insert("steps".into(), steps.collect());
    body.insert(
        "bounds".into(),
        json!([formula.bounds().min, formula.bounds().max]),
    );
    body.insert("slope".into(), json!(formula.slope()));
    body.insert("proven".into(), json!(formula.is_proven()));
    body
}
