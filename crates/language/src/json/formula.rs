//! Formulas in JSON: a list of steps, each a number, a coordinate, or a function of earlier steps.

use super::{JsonStep, Problem, Read, problem};
use serde_json::{Map, Value, json};
use zeroset_catalogue::Dimension;
use zeroset_catalogue::LARGE;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::Field;
use zeroset_field::formula::{
    Binary, Budget, ColourFormula, Formula, FormulaStep, Inner, NoiseKind, Steps, Unary,
};

/// Names of functions of one step.
pub(crate) const UNARY: &[(&str, Unary)] = &[
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
    ("less", Binary::Less),
    ("when", Binary::When),
    ("either", Binary::Either),
];

/// Names of functions of a point, which is three steps.
const NOISE: &[(&str, NoiseKind)] = &[
    ("value_noise", NoiseKind::Value),
    ("noise", NoiseKind::Gradient),
    ("cellular_noise", NoiseKind::Cellular),
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
    let mut body = Map::new();
    body.insert("steps".into(), written(formula.steps()));
    let mut bounds = formula.bounds();
    let plane = formula.dimension() == Dimension::Two;
    if plane {
        (bounds.min[2], bounds.max[2]) = (-1.0, 1.0);
    }
    body.insert("bounds".into(), json!([bounds.min, bounds.max]));
    if plane {
        body.insert("plane".into(), json!(true));
    }
    if !formula.is_unbounded() {
        body.insert("slope".into(), json!(formula.slope()));
    }
    body.insert("proven".into(), json!(formula.is_proven()));
    body
}

fn written(steps: &[FormulaStep]) -> Value {
    let steps = steps.iter().map(|step| match step {
        FormulaStep::Constant(x) => json!(x),
        FormulaStep::Coordinate(k) => json!(COORDINATES.get(usize::from(*k))),
        FormulaStep::Unary(f, a) => json!([name_of(UNARY, f), a]),
        FormulaStep::Binary(f, a, b) => json!([name_of(BINARY, f), a, b]),
        FormulaStep::Noise(kind, [a, b, c]) => json!([name_of(NOISE, kind), a, b, c]),
        // the number of the field among `of`, then the point
        FormulaStep::Field(i, [a, b, c]) => json!(["of", i, a, b, c]),
    });
    steps.collect()
}

/// A formula from its steps, its box, and its slope if that is stated rather than looked for.
pub(super) fn read(body: &Map<String, Value>, fields: &[Field]) -> Read<Formula> {
    let (steps, fields) = listed(body, fields)?;
    let steps =
        Steps::with_fields(steps, fields).map_err(|e| problem(e.to_string()).at("steps"))?;
    let corner = |v: Option<&Value>| {
        let items = v
            .and_then(Value::as_array)
            .filter(|items| items.len() == 3)?;
        let mut out = [0.0; 3];
        for (x, item) in out.iter_mut().zip(items) {
            *x = item.as_f64()?;
        }
        Some(out)
    };
    let bounds = body.get("bounds").and_then(Value::as_array);
    let corners = bounds.and_then(|b| Some((corner(b.first())?, corner(b.get(1))?)));
    let (min, max) =
        corners.ok_or_else(|| problem("a formula needs `bounds`, two corners of three numbers"))?;
    let mut bounds = Aabb::new(min, max);
    let plane = body.get("plane").and_then(Value::as_bool).unwrap_or(false);
    if plane {
        (bounds.min[2], bounds.max[2]) = (-LARGE, LARGE);
    }
    let formula = match (
        body.get("proven").and_then(Value::as_bool),
        body.get("slope").and_then(Value::as_f64),
    ) {
        (Some(false), Some(slope)) => Formula::stated(steps, bounds, slope),
        _ => Formula::new(steps, bounds, &Budget::default()),
    };
    let formula = match plane {
        true => formula.and_then(Formula::flattened),
        false => formula,
    };
    formula.map_err(|e| problem(e.to_string()))
}

/// The steps of a body, and the fields whose values they take.
fn listed(body: &Map<String, Value>, fields: &[Field]) -> Read<(Vec<FormulaStep>, Vec<Inner>)> {
    let steps = body.get("steps").and_then(Value::as_array);
    let steps = steps.ok_or_else(|| problem("a formula needs `steps`, a list"))?;
    let each = |(i, v)| step(v).map_err(|p| p.within(JsonStep::Index(i)).at("steps"));
    let steps = steps
        .iter()
        .enumerate()
        .map(each)
        .collect::<Read<Vec<FormulaStep>>>()?;
    let fields = fields
        .iter()
        .map(Inner::new)
        .collect::<Result<Vec<Inner>, _>>();
    let fields = fields.map_err(|e| problem(e.to_string()).at("of"))?;
    Ok((steps, fields))
}

/// A formula of colours, beside its fields.
pub(super) fn write_colour(formula: &ColourFormula) -> Map<String, Value> {
    let mut body = Map::new();
    body.insert("steps".into(), written(formula.steps()));
    body.insert("results".into(), json!(formula.results()));
    body
}

/// The members of a formula of colours that are not left to the pattern that it is.
pub(super) const COLOUR_MEMBERS: [&str; 3] = ["steps", "results", "of"];

/// A formula of colours from its steps, and the numbers of those that are red, green and blue.
pub(super) fn read_colour(body: &Map<String, Value>, fields: &[Field]) -> Read<ColourFormula> {
    let (steps, fields) = listed(body, fields)?;
    let number = |v: &Value| v.as_u64().and_then(|n| u32::try_from(n).ok());
    let results = match body
        .get("results")
        .and_then(Value::as_array)
        .map(Vec::as_slice)
    {
        Some([r, g, b]) => number(r).zip(number(g)).zip(number(b)),
        _ => None,
    };
    let ((r, g), b) = results.ok_or_else(|| {
        problem("a formula of colours needs `results`, the numbers of three steps")
    })?;
    ColourFormula::of_steps(steps, fields, [r, g, b]).map_err(|e| problem(e.to_string()))
}

/// Calls `f` with every formula within a pattern, in the order of [`Pattern::each_mut`](zeroset_scene::material::Pattern::each_mut), and
/// with the way there.
pub(super) fn each_formula<'v>(
    pattern: &'v Value,
    way: &mut Vec<JsonStep>,
    f: &mut impl FnMut(&[JsonStep], &'v Map<String, Value>) -> Read<()>,
) -> Read<()> {
    let Some(map) = pattern.as_object() else {
        return Ok(());
    };
    if map.get("kind").and_then(Value::as_str) == Some("formula") {
        return f(way, map);
    }
    if let Some(inner) = map.get("pattern") {
        way.push(JsonStep::Key("pattern".into()));
        each_formula(inner, way, f)?;
        way.pop();
    }
    if let Some(inks) = map.get("colours").and_then(Value::as_array) {
        way.push(JsonStep::Key("colours".into()));
        for (i, ink) in inks.iter().enumerate() {
            way.push(JsonStep::Index(i));
            each_formula(ink, way, f)?;
            way.pop();
        }
        way.pop();
    }
    Ok(())
}

/// Calls `f` with every formula within a value that is a pattern or holds some.
pub(super) fn each_formula_mut(value: &mut Value, f: &mut impl FnMut(&mut Map<String, Value>)) {
    match value {
        Value::Object(map) if map.get("kind").and_then(Value::as_str) == Some("formula") => f(map),
        Value::Object(map) => map.values_mut().for_each(|v| each_formula_mut(v, f)),
        Value::Array(items) => items.iter_mut().for_each(|v| each_formula_mut(v, f)),
        _ => {}
    }
}

fn step(value: &Value) -> Read<FormulaStep> {
    let unknown = || -> Box<Problem> {
        problem(
            "a step is a number, \"x\", \"y\", \"z\", or a function of earlier steps such as [\"sin\", 0] or [\"add\", 0, 1]",
        )
    };
    if let Some(x) = value.as_f64() {
        return Ok(FormulaStep::Constant(x));
    }
    if let Some(name) = value.as_str() {
        let k = COORDINATES
            .iter()
            .position(|c| *c == name)
            .ok_or_else(unknown)?;
        return Ok(FormulaStep::Coordinate(k as u8));
    }
    let items = value.as_array().ok_or_else(unknown)?;
    let operand = |v: &Value| v.as_u64().and_then(|n| u32::try_from(n).ok());
    let name = items.first().and_then(Value::as_str).ok_or_else(unknown)?;
    let step = match items[1..] {
        [ref a] => (UNARY.iter().find(|f| f.0 == name))
            .and_then(|f| Some(FormulaStep::Unary(f.1, operand(a)?))),
        [ref a, ref b] => {
            let found = BINARY.iter().find(|f| f.0 == name);
            found.and_then(|f| Some(FormulaStep::Binary(f.1, operand(a)?, operand(b)?)))
        }
        [ref a, ref b, ref c] => {
            let found = NOISE.iter().find(|f| f.0 == name);
            found.and_then(|f| {
                Some(FormulaStep::Noise(
                    f.1,
                    [operand(a)?, operand(b)?, operand(c)?],
                ))
            })
        }
        [ref i, ref a, ref b, ref c] if name == "of" => {
            let point = || Some([operand(a)?, operand(b)?, operand(c)?]);
            operand(i).and_then(|i| Some(FormulaStep::Field(i, point()?)))
        }
        _ => None,
    };
    step.ok_or_else(unknown)
}
