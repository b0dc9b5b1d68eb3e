//! Free-form fields: `field(lambda p: ...)`. The function runs once, on a point whose coordinates write down what is done
//! with them.

use super::machine::Machine;
use super::math::Angle;
use super::mistake::{Mistake, Run, mistake};
use super::native::{Argument, Call, Given, Native, Slot, slot};
use super::value::{Thing, Value};
use crate::report::Place;
use starlark_syntax::syntax::ast::BinOp;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_field::field::Field;
use zeroset_field::formula::{
    Budget, BuildError, Builder, Expression, Formula, Function, ProofError, functions,
};

const SLOTS: &[Slot] = &[
    slot(
        "f",
        "",
        "A function of a point p, such as lambda p: length(p) - 1. Its value is negative inside.",
    ),
    slot(
        "size",
        "4",
        "Sides of the box around the origin that the field lives in: a number or (x, y, z).",
    ),
    slot(
        "bounds",
        "None",
        "Corners ((x, y, z), (x, y, z)) of the box, in place of a size.",
    ),
    slot(
        "slope",
        "proven",
        "How fast the value changes at most, where that cannot be proven.",
    ),
];

/// The functions.
pub(crate) const ALL: &[Native] = &[Native {
    name: "field",
    doc: "A field from a formula. How fast it changes is proven over its box.",
    group: "Formulas",
    params: SLOTS,
    rest: false,
    run: field,
}];

/// Functions of formulas that are no functions of numbers by themselves.
pub(crate) fn more_functions() -> impl Iterator<Item = &'static Function> {
    functions().iter().filter(|f| !super::is_native(f.name))
}

/// Steps of the script that a proof counts as, beside those of the formula: a proof takes up to a tenth of a second.
const PROOF: u64 = 20_000;

/// Bytes that a value of a formula counts as.
const BYTES: usize = 40;

/// That the truth of a value is asked for which depends on the point.
pub(crate) fn undecided() -> Box<Mistake> {
    mistake(
        "a value of a formula is neither true nor false: the formula is written down once, for all points",
    )
    .help(
        "where values are negative inside, min(a, b) is a or b, max(a, b) is a and b, -a is not a; clamp(x, lo, hi), \
         step(edge, x) and mix(a, b, t) choose between values",
    )
}

/// That values are compared which depend on the point.
pub(crate) fn incomparable() -> Box<Mistake> {
    mistake("a formula cannot compare: it is written down once, for all points").help(
        "write min(a, b), max(a, b), clamp(x, lo, hi), step(edge, x) or smoothstep(lo, hi, x)",
    )
}

fn field(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("f")?;
    let bounds = bounds(c)?;
    let slope = c
        .get("slope")
        .map(|g| c.ranged("slope", g, 1e-6, 1e6))
        .transpose()?;
    let builder = Builder::new();
    let point = c.machine.formula_value(builder.point())?;
    let argument = Argument {
        name: None,
        value: point,
        place: given.place,
    };
    let result = c.machine.call(given.value, vec![argument], c.place)?;
    let value = match c.machine.operand(&builder, result)? {
        Some(value) => value,
        None => {
            let kind = c.machine.store.kind(result);
            return Err(mistake(format!(
                "the function must give a number made of p, not {kind}"
            ))
            .at(given.place));
        }
    };
    let steps = builder
        .finish(&value)
        .map_err(|e| told(&e).at(given.place))?;
    c.machine.charge(PROOF + steps.list().len() as u64)?;
    let formula = match slope {
        Some(slope) => Formula::stated(steps, bounds, slope),
        None => Formula::prove(steps, bounds, &Budget::default()),
    };
    let formula = formula.map_err(|e| {
        let m = mistake(e.to_string()).at(given.place);
        match e {
            ProofError::Negative(_) => m,
            _ => m.help("state how fast it changes at most: field(..., slope = 2)"),
        }
    })?;
    c.machine.grow(size_of_val(formula.steps()))?;
    super::fields::value(c.machine, Ok(Field::formula(Arc::new(formula))))
}

/// The box of a formula.
fn bounds(c: &Call<'_, '_>) -> Run<Aabb> {
    if let Some(given) = c.get("bounds") {
        let corners = c
            .machine
            .store
            .items(given.value)
            .filter(|items| items.len() == 2);
        let &[low, high] = corners.unwrap_or_default() else {
            return Err(c.unfit(
                "bounds",
                "two corners such as ((-1, -1, -1), (1, 1, 1))",
                given,
            ));
        };
        let corner = |value| c.numbers::<3>("bounds", Given { value, ..given });
        return Ok(Aabb::new(corner(low)?, corner(high)?));
    }
    let half = match c.get("size") {
        None => [2.0; 3],
        Some(given) if matches!(given.value, Value::Int(_) | Value::Float(_)) => {
            [0.5 * c.ranged("size", given, SMALL, LARGE)?; 3]
        }
        Some(given) => c.numbers::<3>("size", given)?.map(|x| 0.5 * x),
    };
    Ok(Aabb::centred(half))
}

fn told(error: &BuildError) -> Box<Mistake> {
    mistake(error.to_string())
}

impl<'a> Machine<'a> {
    /// A value of a formula.
    fn formula_value(&mut self, expression: Expression) -> Run<Value> {
        self.charge(2)?;
        self.grow(BYTES)?;
        expression.builder().check().map_err(|e| told(&e))?;
        Ok(self.charged_thing(Thing::Expression(expression)))
    }

    fn as_expression(&self, value: Value) -> Option<&Expression> {
        match value {
            Value::Thing(i) => match self.store.thing(i) {
                Thing::Expression(expression) => Some(expression),
                _ => None,
            },
            _ => None,
        }
    }

    /// The formula that one of the values belongs to, be it inside of a tuple.
    pub(crate) fn formula_of(&self, values: impl IntoIterator<Item = Value>) -> Option<Builder> {
        values.into_iter().find_map(|value| {
            let inner = self
                .store
                .items(value)
                .filter(|items| items.len() <= 4)
                .unwrap_or_default();
            let mut all = std::iter::once(&value).chain(inner);
            all.find_map(|v| self.as_expression(*v))
                .map(|e| e.builder().clone())
        })
    }

    /// A number, a tuple of numbers, or a value of the formula as a value of the formula; `None` for anything else.
    fn operand(&self, builder: &Builder, value: Value) -> Run<Option<Expression>> {
        Ok(match value {
            Value::Int(i) => Some(builder.constant(i as f64)),
            Value::Float(x) => Some(builder.constant(x)),
            Value::List(_) | Value::Tuple(_) => {
                let items = self.store.items(value).unwrap_or_default();
                if !(2..=4).contains(&items.len()) {
                    return Ok(None);
                }
                let mut parts = Vec::with_capacity(items.len());
                for item in items {
                    match *item {
                        Value::List(_) | Value::Tuple(_) => return Ok(None),
                        item => match self.operand(builder, item)? {
                            Some(part) => parts.push(part),
                            None => return Ok(None),
                        },
                    }
                }
                Some(builder.vector(&parts))
            }
            other => self.as_expression(other).cloned(),
        })
    }

    /// An operator of which one side belongs to a formula; `None` where there is none.
    pub(crate) fn operate_formula(
        &mut self,
        op: BinOp,
        left: Value,
        right: Value,
    ) -> Run<Option<Value>> {
        let Some(builder) = self.formula_of([left, right]) else {
            return Ok(None);
        };
        let (Some(x), Some(y)) = (
            self.operand(&builder, left)?,
            self.operand(&builder, right)?,
        ) else {
            return Ok(None);
        };
        let value = match op {
            BinOp::Add => x + y,
            BinOp::Subtract => x - y,
            BinOp::Multiply => x * y,
            BinOp::Divide => x / y,
            BinOp::Percent => x.modulo(&y),
            BinOp::FloorDivide => (x / y).floor(),
            BinOp::Less
            | BinOp::LessOrEqual
            | BinOp::Greater
            | BinOp::GreaterOrEqual
            | BinOp::Equal
            | BinOp::NotEqual => return Err(incomparable()),
            _ => return Ok(None),
        };
        self.formula_value(value).map(Some)
    }

    /// `-value` of a formula.
    pub(crate) fn negate_formula(&mut self, value: Value) -> Option<Run<Value>> {
        let negated = -self.as_expression(value)?;
        Some(self.formula_value(negated))
    }

    /// `p.x`, `p.xz` and the like.
    pub(crate) fn part_of_formula(&mut self, value: Value, name: &str) -> Option<Run<Value>> {
        let expression = self.as_expression(value)?;
        let part = (name.len() <= 4)
            .then(|| expression.swizzle(name))
            .flatten();
        Some(match part {
            Some(part) => self.formula_value(part),
            None => Err(mistake(format!("a point of a formula has no `{name}`"))
                .help("there are p.x, p.y, p.z, p.xy, p.xz and the like")),
        })
    }

    /// Calls a function of formulas.
    pub(crate) fn call_formula(
        &mut self,
        function: &'static Function,
        arguments: &[Argument<'a>],
        place: Place,
    ) -> Run<Value> {
        self.charge(4 * arguments.len() as u64)?;
        let items = arguments.iter().filter_map(|a| self.store.items(a.value));
        let items: u64 = items.map(|i| i.len() as u64).sum();
        self.charge(items)?;
        let builder = self
            .formula_of(arguments.iter().map(|a| a.value))
            .or_else(|| {
                let items = arguments.iter().filter_map(|a| self.store.items(a.value));
                self.formula_of(items.flatten().copied())
            });
        let plain = builder.is_none();
        let builder = builder.unwrap_or_default();
        let listed = self.listed(function, arguments);
        let arguments = listed.as_deref().unwrap_or(arguments);
        let mut sorted: Vec<Option<Expression>> =
            vec![None; function.params.len().max(arguments.len())];
        for (i, argument) in arguments.iter().enumerate() {
            let at = match &argument.name {
                None => i,
                Some(name) => function
                    .params
                    .iter()
                    .position(|p| p == name)
                    .ok_or_else(|| {
                        let help = crate::report::suggestion(name, function.params.iter().copied());
                        mistake(format!("{}() has no argument `{name}`", function.name))
                            .maybe_help(help)
                            .at(argument.place)
                    })?,
            };
            let value = self.operand(&builder, argument.value)?.ok_or_else(|| {
                let kind = self.store.kind(argument.value);
                mistake(format!("{}() needs numbers, not {kind}", function.name)).at(argument.place)
            })?;
            if sorted[at].replace(value).is_some() {
                let message = format!("{}() is given an argument twice", function.name);
                return Err(mistake(message).at(argument.place));
            }
        }
        let mut given: Vec<Expression> = sorted.into_iter().flatten().collect();
        if given.is_empty() {
            return Err(mistake(format!(
                "{}() needs {}",
                function.name,
                function.params.join(", ")
            )));
        }
        let degrees = 1_f64.to_radians();
        let angle = Angle::of(function.name);
        if angle == Angle::Taken {
            given = given.into_iter().map(|x| x * degrees).collect();
        }
        let mut value = function.call(&given).map_err(|e| told(&e).at(place))?;
        if angle == Angle::Given {
            value = value * degrees.recip();
        }
        if plain {
            // a function of nothing but numbers is a number, or a tuple of numbers
            let numbers: Option<Vec<f64>> = match value.parts() {
                1 => value.as_constant().map(|x| vec![x]),
                n => (0..n).map(|k| value.part(k).as_constant()).collect(),
            };
            return match numbers.as_deref() {
                Some([x]) => Ok(Value::Float(*x)),
                Some(numbers) => {
                    self.grow_items(numbers.len())?;
                    self.tuple(numbers.iter().map(|x| Value::Float(*x)).collect())
                }
                None => Err(mistake(format!(
                    "{}() has no value for this",
                    function.name
                ))),
            };
        }
        self.formula_value(value)
    }

    /// `min([a, b, c])` is `min(a, b, c)`, as it is for numbers.
    fn listed(&self, function: &Function, arguments: &[Argument<'a>]) -> Option<Vec<Argument<'a>>> {
        let [one] = arguments else { return None };
        let items = self.store.items(one.value)?;
        let argument = |value: &Value| Argument {
            name: None,
            value: *value,
            place: one.place,
        };
        matches!(function.name, "min" | "max").then(|| items.iter().map(argument).collect())
    }

    /// The function of formulas with this name, if an argument belongs to a formula.
    pub(crate) fn formula_function(
        &self,
        name: &str,
        arguments: &[Argument<'a>],
    ) -> Option<&'static Function> {
        let own = self.formula_of(arguments.iter().map(|a| a.value));
        // a list of any length, where one is taken
        let listed = || match arguments {
            [one] if matches!(name, "min" | "max") => {
                self.formula_of(self.store.items(one.value)?.iter().copied())
            }
            _ => None,
        };
        own.or_else(listed)?;
        functions().iter().find(|f| f.name == name)
    }
}
