//! Formulas: `field(lambda p: ...)`, `shape.map(lambda p: ...)`, `shape.displace(lambda p: ...)`. The function runs once, on a
//! point whose coordinates write down what is done with them.

use super::machine::Machine;
use super::mistake::{Mistake, Run, mistake};
use super::native::{Argument, Call, Given, Native, Slot, slot};
use super::value::{Thing, Value};
use crate::registers::Registers;
use crate::report::Place;
use starlark_syntax::syntax::ast::BinOp;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::{Dimension, LARGE, SMALL};
use zeroset_field::field::Field;
use zeroset_field::formula::{
    Budget, BuildError, Builder, EASE, Expression, Formula, Function, ROTATE, Steps, WHERE,
    functions,
};

const SIZE: Slot = slot(
    "size",
    "4",
    "Sides of the box around the origin that the field lives in: a number or (x, y, z).",
);
const FLAT_SIZE: Slot = slot(
    "size",
    "4",
    "Sides of the rectangle around the origin that the shape lives in: a number or (x, y).",
);
const BOUNDS: Slot = slot(
    "bounds",
    "None",
    "Corners ((x, y, z), (x, y, z)) of the box, in place of a size.",
);
const FLAT_BOUNDS: Slot = slot(
    "bounds",
    "None",
    "Corners ((x, y), (x, y)) of the rectangle, in place of a size.",
);
const FOUND: Slot = slot(
    "bounds",
    "found",
    "Corners ((x, y, z), (x, y, z)) of the box that holds the result, where it is not found.",
);
const SLOPE: Slot = slot(
    "slope",
    "proven",
    "How fast the value changes at most, where that cannot be proven.",
);

/// The functions.
pub(crate) const ALL: &[Native] = &[
    Native {
        name: "field",
        doc: "A field from a formula. How fast it changes is proven over its box.",
        group: GROUP,
        params: &[
            slot(
                "f",
                "",
                "A function of a point p, such as lambda p: length(p) - 1. Its value is negative inside.",
            ),
            SIZE,
            BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: |c| field(c, false),
    },
    Native {
        name: "field2d",
        doc: "A plane shape from a formula, for extrude, revolve and the like.",
        group: GROUP,
        params: &[
            slot(
                "f",
                "",
                "A function of a point p = (x, y), such as lambda p: length(p) - 1. Its value is negative inside.",
            ),
            FLAT_SIZE,
            FLAT_BOUNDS,
            SLOPE,
        ],
        rest: false,
        run: |c| field(c, true),
    },
];

/// `shape.map(lambda p: ...)`.
pub(crate) const MAP: Native = Native {
    name: "map",
    doc: "A deformation of one's own: what is seen at p is what the shape has at f(p). How much it stretches is proven.",
    group: GROUP,
    params: &[
        slot(
            "f",
            "",
            "A function of a point that gives a point, such as lambda p: rotate(p, \"y\", p.y).",
        ),
        FOUND,
        SLOPE,
    ],
    rest: false,
    run: map,
};

/// `shape.displace(lambda p: ...)`.
pub(crate) const DISPLACE: Native = Native {
    name: "displace",
    doc: "Moves the surface outwards by a formula.",
    group: GROUP,
    params: &[
        slot(
            "amplitude",
            "",
            "A function of a point that gives a length, such as lambda p: 0.1 * sin(20 * p.x).",
        ),
        FOUND,
        SLOPE,
    ],
    rest: false,
    run: displace,
};

const GROUP: &str = "Formulas";

/// All functions of formulas.
pub(crate) fn all_functions() -> impl Iterator<Item = &'static Function> {
    functions().iter().chain([&ROTATE, &WHERE, &EASE])
}

/// Functions of formulas that are no functions of numbers, shapes or materials by themselves.
pub(crate) fn more_functions() -> impl Iterator<Item = &'static Function> {
    all_functions().filter(|f| !super::is_native(f.name))
}

/// Functions of formulas whose names mean something else outside of them: a shape, a pattern.
pub(crate) fn namesakes() -> impl Iterator<Item = &'static Function> {
    all_functions().filter(|f| matches!(f.name, "cross" | "noise"))
}

/// Steps of the script that a proof counts as, beside those of the formula: a proof takes up to a tenth of a second.
const PROOF: u64 = 20_000;

/// Bytes that a value of a formula counts as.
const BYTES: usize = 40;

/// Steps of the script that a call of a field counts as at most.
const MOST_CALLED: u64 = 100_000;

/// That the truth of a value is asked for which depends on the point.
pub(crate) fn undecided() -> Box<Mistake> {
    mistake(
        "a value of a formula is neither true nor false: the formula is written down once, for all points",
    )
    .help(
        "compare it, as in `a if p.x > 0 else b`; where values are negative inside, min(a, b) is a or b, max(a, b) is a and b, \
         -a is not a",
    )
}

/// That a condition on the point is asked for its truth where one answer is needed for all points.
pub(crate) fn conditional() -> Box<Mistake> {
    mistake("this condition depends on the point, and here one answer is needed for all points").help(
        "`a if condition else b`, `if` with returns or values, `and`, `or` and `not` take it; loops and lists must not depend on it",
    )
}

/// That values are compared in a way that needs one answer for all points.
pub(crate) fn incomparable() -> Box<Mistake> {
    mistake("values of a formula cannot be compared here: which is larger depends on the point").help(
        "write `a if p.x > 0 else b`, min(a, b), max(a, b), clamp(x, lo, hi), step(edge, x) or smoothstep(lo, hi, x)",
    )
}

/// A formula over its box, with a stated slope or whatever is found out about it.
pub(crate) fn made(
    c: &mut Call<'_, '_>,
    f: Given,
    steps: Steps,
    bounds: Aabb,
    flat: bool,
) -> Run<Value> {
    let slope = c
        .get("slope")
        .map(|g| c.ranged("slope", g, 1e-6, 1e6))
        .transpose()?;
    c.machine.charge(PROOF + steps.list().len() as u64)?;
    let formula = match slope {
        Some(slope) => Formula::stated(steps, bounds, slope),
        None => Formula::new(steps, bounds, &Budget::default()),
    };
    let formula = match flat {
        true => formula.and_then(Formula::flattened),
        false => formula,
    };
    let formula = formula.map_err(|e| mistake(e.to_string()).at(f.place))?;
    c.machine.grow(size_of_val(formula.steps()))?;
    super::fields::value(c.machine, Field::formula(Arc::new(formula)))
}

/// The steps of a function of a point: `end` makes a number of what it gives.
fn written(
    c: &mut Call<'_, '_>,
    f: Given,
    flat: bool,
    gives: &str,
    end: impl FnOnce(&Builder, Expression) -> Expression,
) -> Run<Steps> {
    let (builder, value) = given_by(c, f, flat, gives)?;
    let value = end(&builder, value);
    builder.finish(&value).map_err(|e| told(&e).at(f.place))
}

/// What a function of a point gives, and the formula that this is written down in.
pub(super) fn given_by(
    c: &mut Call<'_, '_>,
    f: Given,
    flat: bool,
    gives: &str,
) -> Run<(Builder, Expression)> {
    let builder = Builder::new();
    let point = builder.point();
    let point = match flat.then(|| point.swizzle("xy")).flatten() {
        Some(plane) => plane,
        None => point,
    };
    let point = c.machine.formula_value(point)?;
    let argument = Argument {
        name: None,
        value: point,
        place: f.place,
    };
    let result = c.machine.call(f.value, vec![argument], c.place)?;
    let Some(value) = c.machine.operand(&builder, result)? else {
        let kind = c.machine.store.kind(result);
        let m = mistake(format!(
            "the function must give {gives} made of p, not {kind}"
        ));
        return Err(match result {
            Value::None => m.help("a function gives what follows `return`"),
            Value::Thing(i) if matches!(c.machine.store.thing(i), Thing::Field(_)) => {
                m.help("a field is asked for its value at a point: s(p)")
            }
            _ => m,
        }
        .at(f.place));
    };
    Ok((builder, value))
}

fn field(c: &mut Call<'_, '_>, flat: bool) -> Run<Value> {
    let f = c.need("f")?;
    let bounds = if flat { flat_bounds(c)? } else { bounds(c)? };
    let steps = written(c, f, flat, "a number", |_, value| value)?;
    made(c, f, steps, bounds, flat)
}

/// The box of a formula.
fn bounds(c: &Call<'_, '_>) -> Run<Aabb> {
    if let Some(given) = c.get("bounds") {
        return corners(c, given);
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

fn corners(c: &Call<'_, '_>, given: Given) -> Run<Aabb> {
    let [low, high] = pair(c, given, "two corners such as ((-1, -1, -1), (1, 1, 1))")?;
    let corner = |value| c.numbers::<3>("bounds", Given { value, ..given });
    Ok(Aabb::new(corner(low)?, corner(high)?))
}

/// The box of a formula in the plane.
fn flat_bounds(c: &Call<'_, '_>) -> Run<Aabb> {
    let rectangle = |low: [f64; 2], high: [f64; 2]| {
        Aabb::new([low[0], low[1], -LARGE], [high[0], high[1], LARGE])
    };
    if let Some(given) = c.get("bounds") {
        let [low, high] = pair(c, given, "two corners such as ((-1, -1), (1, 1))")?;
        let corner = |value| c.numbers::<2>("bounds", Given { value, ..given });
        return Ok(rectangle(corner(low)?, corner(high)?));
    }
    let half = match c.get("size") {
        None => [2.0; 2],
        Some(given) if matches!(given.value, Value::Int(_) | Value::Float(_)) => {
            [0.5 * c.ranged("size", given, SMALL, LARGE)?; 2]
        }
        Some(given) => c.numbers::<2>("size", given)?.map(|x| 0.5 * x),
    };
    Ok(rectangle(half.map(|x| -x), half))
}

fn pair(c: &Call<'_, '_>, given: Given, wanted: &str) -> Run<[Value; 2]> {
    match c.machine.store.items(given.value) {
        Some(&[low, high]) => Ok([low, high]),
        _ => Err(c.unfit("bounds", wanted, given)),
    }
}

/// A box that holds what a formula makes of a shape: the one given, or what is found in a box around the shape's.
pub(crate) fn found(c: &mut Call<'_, '_>, of: &Aabb, flat: bool, steps: &Steps) -> Run<Aabb> {
    if let Some(given) = c.get("bounds") {
        return if flat {
            flat_bounds(c)
        } else {
            corners(c, given)
        };
    }
    let axes = if flat { 0..2 } else { 0..3 };
    let ends = axes
        .clone()
        .all(|k| of.min[k].is_finite() && of.max[k].is_finite());
    if !ends || of.is_empty() {
        let m = mistake(format!(
            "{}() of a shape without ends needs `bounds`",
            c.name
        ));
        return Err(m.help(
            "write bounds = ((-5, -5, -5), (5, 5, 5)), or intersect the shape with a box first",
        ));
    }
    let reach = axes.clone().map(|k| of.half()[k]).fold(0.0, f64::max);
    let mut around = of.grow((3.0 * reach).max(1e-6));
    if flat {
        (around.min[2], around.max[2]) = (-LARGE, LARGE);
    }
    c.machine.charge(PROOF)?;
    let mut found = steps.reach(&around);
    let hair = 1e-4 * reach;
    for k in axes {
        if found.min[k] <= around.min[k] || found.max[k] >= around.max[k] {
            let m = mistake(format!(
                "how far the result of {}() reaches could not be found: at least {} from the shape's box",
                c.name,
                super::native::spoken(3.0 * reach)
            ));
            return Err(m.help("state a box that holds it: bounds = ((-5, -5, -5), (5, 5, 5))"));
        }
        if found.is_empty() {
            continue;
        }
        found.min[k] -= hair;
        found.max[k] += hair;
    }
    // nothing is left of it: a box of any size will do
    Ok(if found.is_empty() {
        of.grow(hair.max(1e-6))
    } else {
        found
    })
}

fn map(c: &mut Call<'_, '_>) -> Run<Value> {
    let (shape, f) = (c.shape()?, c.need("f")?);
    let flat = shape.facts().dimension == Dimension::Two;
    let gives = if flat {
        "a point (x, y)"
    } else {
        "a point (x, y, z)"
    };
    let steps = written(c, f, flat, gives, |builder, q| builder.field(&shape, &q))?;
    let bounds = found(c, &shape.facts().bounds, flat, &steps)?;
    made(c, f, steps, bounds, flat)
}

fn displace(c: &mut Call<'_, '_>) -> Run<Value> {
    let (shape, f) = (c.shape()?, c.need("amplitude")?);
    let flat = shape.facts().dimension == Dimension::Two;
    let at = |builder: &Builder| match builder.point() {
        p if flat => p.swizzle("xy").unwrap_or(p),
        p => p,
    };
    let steps = written(c, f, flat, "a number", |builder, by| {
        builder.field(&shape, &at(builder)) - by
    })?;
    let bounds = found(c, &shape.facts().bounds, flat, &steps)?;
    made(c, f, steps, bounds, flat)
}

pub(crate) fn told(error: &BuildError) -> Box<Mistake> {
    mistake(error.to_string())
}

impl<'a> Machine<'a> {
    /// A value of a formula.
    pub(crate) fn formula_value(&mut self, expression: Expression) -> Run<Value> {
        self.charge(2)?;
        self.grow(BYTES)?;
        expression.builder().check().map_err(|e| told(&e))?;
        Ok(self.charged_thing(Thing::Expression(expression)))
    }

    /// A condition on the point.
    pub(crate) fn formula_condition(&mut self, condition: Expression) -> Run<Value> {
        self.charge(2)?;
        self.grow(BYTES)?;
        condition.builder().check().map_err(|e| told(&e))?;
        Ok(self.charged_thing(Thing::Condition(condition)))
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

    /// The parts of a vector of a formula, as a tuple.
    pub(crate) fn parts_of_vector(&mut self, value: Value) -> Run<Option<Value>> {
        let Some(vector) = self.as_expression(value).filter(|e| e.parts() > 1).cloned() else {
            return Ok(None);
        };
        self.grow_items(vector.parts())?;
        let parts = (0..vector.parts()).map(|k| self.formula_value(vector.part(k)));
        let parts = parts.collect::<Run<Vec<Value>>>()?;
        self.tuple(parts).map(Some)
    }

    /// How many parts a vector of a formula has; none for anything else.
    pub(crate) fn vector_length(&self, value: Value) -> Option<u64> {
        let parts = self.as_expression(value)?.parts();
        (parts > 1).then_some(parts as u64)
    }

    /// A condition on the point, if a value is one.
    pub(crate) fn as_condition(&self, value: Value) -> Option<Expression> {
        match value {
            Value::Thing(i) => match self.store.thing(i) {
                Thing::Condition(condition) => Some(condition.clone()),
                _ => None,
            },
            _ => None,
        }
    }

    /// Where the condition holds `yes`, else `no`.
    pub(crate) fn chosen(&mut self, condition: &Expression, yes: Value, no: Value) -> Run<Value> {
        self.charge(4)?;
        let builder = condition.builder().clone();
        if same_value(yes, no) {
            return Ok(yes);
        }
        let truth = |m: &Self, value| match value {
            Value::Bool(b) => Some(builder.constant(f64::from(u8::from(b)))),
            other => m.as_condition(other),
        };
        if let (Some(a), Some(b)) = (truth(self, yes), truth(self, no)) {
            let holds = condition.min(a).max(condition.negated().min(b));
            return self.formula_condition(holds);
        }
        let is_list = |m: &Self, value| {
            let items = m.store.items(value).unwrap_or_default();
            items.iter().any(|item| m.vector_length(*item).is_some())
        };
        // a list with vectors in it is no vector of all their parts
        if !is_list(self, yes)
            && !is_list(self, no)
            && let (Some(a), Some(b)) = (self.operand(&builder, yes)?, self.operand(&builder, no)?)
        {
            return self.formula_value(condition.choose(a, b));
        }
        // lists of values of the same length, one by one
        let (a, b) = (self.store.items(yes), self.store.items(no));
        if let (Some(a), Some(b)) = (a, b)
            && a.len() == b.len()
        {
            let pairs: Vec<(Value, Value)> = a.iter().copied().zip(b.iter().copied()).collect();
            self.grow_items(pairs.len())?;
            let chosen = pairs
                .into_iter()
                .map(|(a, b)| self.deeper(super::depth::CALL, |m| m.chosen(condition, a, b)));
            let chosen = chosen.collect::<Run<Vec<Value>>>()?;
            return match yes {
                Value::List(_) => self.list(chosen),
                _ => self.tuple(chosen),
            };
        }
        let (a, b) = (self.store.kind(yes), self.store.kind(no));
        Err(mistake(format!(
            "a condition on the point chooses between numbers or vectors, not between {a} and {b}"
        )))
    }

    /// `a and b`, `a or b`, where a is a condition on the point.
    pub(crate) fn combined(&mut self, left: &Expression, right: Value, both: bool) -> Run<Value> {
        let right = match right {
            Value::Bool(b) => left.builder().constant(f64::from(u8::from(b))),
            other => match self.as_condition(other) {
                Some(right) => right,
                None if self.as_expression(other).is_some() => return Err(undecided()),
                None => {
                    let kind = self.store.kind(other);
                    return Err(mistake(format!(
                        "a condition on the point goes together with another one, not with {kind}"
                    ))
                    .help("write p.x > 0 and p.y > 0"));
                }
            },
        };
        self.formula_condition(if both {
            left.min(right)
        } else {
            left.max(right)
        })
    }

    /// The value of a field at a point: of a formula, or of numbers.
    pub(crate) fn ask_field(
        &mut self,
        field: &Field,
        arguments: &[Argument<'a>],
        place: Place,
    ) -> Run<Value> {
        self.charge(8 + field.facts().nodes.min(MOST_CALLED))?;
        let builder = self.formula_of(arguments.iter().map(|a| a.value));
        let plain = builder.is_none();
        let builder = builder.unwrap_or_default();
        let mut parts = Vec::new();
        for argument in arguments {
            if let Some(name) = &argument.name {
                return Err(mistake(format!("a field has no argument `{name}`"))
                    .help("ask it for its value at a point: s(p), or s((0, 1, 0))")
                    .at(argument.place));
            }
            parts.push(self.operand(&builder, argument.value)?.ok_or_else(|| {
                let kind = self.store.kind(argument.value);
                mistake(format!(
                    "a field is asked for its value at a point, not at {kind}"
                ))
                .help("s(p), or s((0, 1, 0))")
                .at(argument.place)
            })?);
        }
        let point = match &parts[..] {
            [one] => one.clone(),
            [] => {
                let m = mistake("a field is asked for its value at a point");
                return Err(m.help("s(p), or s((0, 1, 0))").at(place));
            }
            several => builder.vector(several),
        };
        let value = builder.field(field, &point);
        builder.check().map_err(|e| told(&e).at(place))?;
        if !plain {
            return self.formula_value(value);
        }
        let steps = builder.finish(&value).map_err(|e| told(&e).at(place))?;
        let origin = zeroset_number::F64(0.0);
        let value = steps.eval(zeroset_number::v3(origin, origin, origin)).0;
        if value.is_finite() {
            return Ok(Value::Float(value));
        }
        Err(mistake("the field has no value there").at(place))
    }

    /// The value of a formula from a file at a point of another one.
    pub(crate) fn ask_registers(
        &mut self,
        list: &Registers,
        arguments: &[Argument<'a>],
        place: Place,
    ) -> Run<Value> {
        self.charge(list.operations() as u64)?;
        let wrong = |message: String, at: Place| {
            let m = mistake(message);
            m.help("hand it to field(...) or to field2d(...), or call it with their point: f(p)")
                .at(at)
        };
        let [argument] = arguments else {
            let message = "a formula from a file takes one point".to_owned();
            return Err(wrong(message, place));
        };
        let wanted = if list.is_solid() { 3 } else { 2 };
        let value = match self.formula_of([argument.value]) {
            Some(builder) => self
                .operand(&builder, argument.value)?
                .filter(|point| (wanted..=3).contains(&point.parts()))
                .map(|point| (list.write(&builder, &point), builder)),
            None => None,
        };
        let Some((value, builder)) = value else {
            let kind = self.store.kind(argument.value);
            let axes = if list.is_solid() {
                ", since it uses z"
            } else {
                ""
            };
            let message = format!(
                "a formula from a file is asked at a point of {wanted} numbers{axes}; this is {kind}"
            );
            return Err(wrong(message, argument.place));
        };
        builder.check().map_err(|e| told(&e).at(place))?;
        self.formula_value(value)
    }

    /// `rotate(p, axis, theta)`, or `rotate(p, theta)` of a vector of 2.
    fn call_rotate(&mut self, arguments: &[Argument<'a>], place: Place) -> Run<Value> {
        let names = ROTATE.params;
        let (mut given, mut next) = ([None; 3], 0);
        for argument in arguments {
            let at = match &argument.name {
                None => next,
                Some(name) => names.iter().position(|n| n == name).ok_or_else(|| {
                    let help = crate::report::suggestion(name, names.iter().copied());
                    mistake(format!("rotate() has no argument `{name}`"))
                        .maybe_help(help)
                        .at(argument.place)
                })?,
            };
            next += usize::from(argument.name.is_none());
            let free = given.get_mut(at).filter(|g| g.is_none());
            let Some(free) = free else {
                return Err(mistake(
                    "rotate() takes a vector of 3, an axis and radians, or a vector of 2 and radians",
                )
                .at(argument.place));
            };
            *free = Some(Given {
                value: argument.value,
                place: argument.place,
            });
        }
        let wrong = || {
            mistake(
                "rotate() takes a vector of 3, an axis and radians, or a vector of 2 and radians",
            )
            .help("rotate(p, \"y\", 0.5), rotate(p, (1, 1, 0), p.y), rotate(p.xz, 0.5)")
            .at(place)
        };
        let (p, axis, theta) = match given {
            [Some(p), Some(theta), None] => (p, None, theta),
            [Some(p), None, Some(theta)] => (p, None, theta),
            [Some(p), Some(axis), Some(theta)] => (p, Some(axis), theta),
            _ => return Err(wrong()),
        };
        if matches!(p.value, Value::Thing(i) if matches!(self.store.thing(i), Thing::Field(_))) {
            return Err(mistake("rotate() turns vectors of formulas, and this is a field")
                .help("shape.turn(y = 30) or shape.turn(axis = (1, 1, 0), angle = 30), in degrees")
                .at(p.place));
        }
        let builder = self.formula_of([p.value, theta.value]);
        let plain = builder.is_none();
        let builder = builder.unwrap_or_default();
        let vector = self.operand(&builder, p.value)?.ok_or_else(wrong)?;
        let theta = self.operand(&builder, theta.value)?.ok_or_else(wrong)?;
        let turned = match axis {
            None => vector.turned(theta),
            Some(axis) => {
                let direction = match axis.value {
                    Value::Text(i) => super::fields::direction_of_word(self.store.text(i)),
                    other => self.store.items(other).and_then(three_numbers),
                };
                let direction = direction.filter(|d| d.iter().any(|x| *x != 0.0));
                let direction = direction.ok_or_else(|| {
                    mistake("`axis` of rotate() must be \"x\", \"y\", \"z\" or three numbers that are not all 0")
                        .at(axis.place)
                })?;
                vector.rotate(direction, theta)
            }
        };
        builder.check().map_err(|e| told(&e).at(place))?;
        if plain {
            return self.plain_value(&turned, "rotate");
        }
        self.formula_value(turned)
    }

    /// `where(condition, a, b)`.
    fn call_where(&mut self, arguments: &[Argument<'a>], place: Place) -> Run<Value> {
        let [condition, yes, no] = arguments else {
            let m = mistake("where() takes a condition and two values");
            return Err(m
                .help("where(p.x > 0, a, b) is a if p.x > 0 else b")
                .at(place));
        };
        match (condition.value, self.as_condition(condition.value)) {
            (_, Some(holds)) => self.chosen(&holds, yes.value, no.value),
            (Value::Bool(holds), _) => Ok(if holds { yes.value } else { no.value }),
            (other, _) => {
                let kind = self.store.kind(other);
                let m = mistake(format!(
                    "where() needs a condition such as p.x > 0, not {kind}"
                ));
                Err(m.at(condition.place))
            }
        }
    }

    /// A constant as a number, or a tuple of numbers.
    pub(crate) fn plain_value(&mut self, value: &Expression, name: &str) -> Run<Value> {
        let numbers: Option<Vec<f64>> = match value.parts() {
            1 => value.as_constant().map(|x| vec![x]),
            n => (0..n).map(|k| value.part(k).as_constant()).collect(),
        };
        match numbers.as_deref() {
            Some([x]) => Ok(Value::Float(*x)),
            Some(numbers) => {
                self.grow_items(numbers.len())?;
                self.tuple(numbers.iter().map(|x| Value::Float(*x)).collect())
            }
            None => {
                // what is not folded, as noise, is evaluated
                let mut numbers = Vec::new();
                for k in 0..value.parts() {
                    let steps = value
                        .builder()
                        .finish(&value.part(k))
                        .map_err(|e| told(&e))?;
                    let o = zeroset_number::F64(0.0);
                    numbers.push(steps.eval(zeroset_number::v3(o, o, o)).0);
                }
                match numbers[..] {
                    _ if numbers.iter().any(|x| !x.is_finite()) => {
                        Err(mistake(format!("{name}() has no value for this")))
                    }
                    [x] => Ok(Value::Float(x)),
                    _ => {
                        self.grow_items(numbers.len())?;
                        self.tuple(numbers.into_iter().map(Value::Float).collect())
                    }
                }
            }
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
            all.find_map(|v| match self.as_expression(*v) {
                Some(e) => Some(e.builder().clone()),
                None => self.as_condition(*v).map(|c| c.builder().clone()),
            })
        })
    }

    /// A number, a tuple of numbers, the name of a colour, or a value of the formula as a value of the formula; `None` for anything else.
    pub(crate) fn operand(&self, builder: &Builder, value: Value) -> Run<Option<Expression>> {
        Ok(match value {
            Value::Int(i) => Some(builder.constant(i as f64)),
            Value::Float(x) => Some(builder.constant(x)),
            Value::Text(i) => crate::colour::parse(self.store.text(i))
                .ok()
                .map(|parts| builder.vector(&parts.map(|x| builder.constant(x)))),
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
        if let Some(condition) = compared(op, &x, &y) {
            if x.parts() != 1 || y.parts() != 1 {
                let m = mistake("numbers can be compared, vectors cannot: which is larger?");
                return Err(m.help("compare parts or lengths: p.x > 0, length(p) < 1"));
            }
            return self.formula_condition(condition).map(Some);
        }
        let value = match op {
            BinOp::Add => x + y,
            BinOp::Subtract => x - y,
            BinOp::Multiply => x * y,
            BinOp::Divide => x / y,
            BinOp::Percent => x.modulo(&y),
            BinOp::FloorDivide => (x / y).floor(),
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
                .help("there are p.x, p.y, p.z, p.xy, p.xz and the like, and p[0], p[1], p[2]")),
        })
    }

    /// Calls a function of formulas.
    pub(crate) fn call_formula(
        &mut self,
        function: &'static Function,
        arguments: &[Argument<'a>],
        place: Place,
    ) -> Run<Value> {
        if function.name == ROTATE.name {
            return self.call_rotate(arguments, place);
        }
        if function.name == WHERE.name {
            return self.call_where(arguments, place);
        }
        if function.name == EASE.name {
            return self.call_ease(arguments, place);
        }
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
            vec![None; (function.params.len() + function.optional.len()).max(arguments.len())];
        let names = || function.params.iter().chain(function.optional);
        for (i, argument) in arguments.iter().enumerate() {
            let at = match &argument.name {
                None => i,
                Some(name) => names().position(|p| p == name).ok_or_else(|| {
                    let help = crate::report::suggestion(name, names().copied());
                    mistake(format!("{}() has no argument `{name}`", function.name))
                        .maybe_help(help)
                        .at(argument.place)
                })?,
            };
            let value = self.operand(&builder, argument.value)?.ok_or_else(|| {
                let wrong = match argument.value {
                    Value::Text(i) => {
                        let text = self.store.text(i);
                        format!(
                            "{}() needs numbers or colours, and \"{text}\" is none",
                            function.name
                        )
                    }
                    other => {
                        let kind = self.store.kind(other);
                        format!("{}() needs numbers, not {kind}", function.name)
                    }
                };
                mistake(wrong).at(argument.place)
            })?;
            if sorted[at].replace(value).is_some() {
                let message = format!("{}() is given an argument twice", function.name);
                return Err(mistake(message).at(argument.place));
            }
        }
        let given: Vec<Expression> = sorted.into_iter().flatten().collect();
        if given.is_empty() {
            return Err(mistake(format!(
                "{}() needs {}",
                function.name,
                function.params.join(", ")
            )));
        }
        let value = function.call(&given).map_err(|e| told(&e).at(place))?;
        if plain {
            // a function of nothing but numbers is a number, or a tuple of numbers
            return self.plain_value(&value, function.name);
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
        // of plain numbers, what has another meaning too
        let vectors = || {
            let three = |a: &Argument<'a>| self.store.items(a.value).and_then(three_numbers);
            let all = name == "cross"
                && arguments.len() == 2
                && arguments.iter().all(|a| three(a).is_some());
            all.then(Builder::new)
        };
        own.or_else(listed).or_else(vectors)?;
        functions().iter().find(|f| f.name == name)
    }
}

/// The comparison of two values, if the operator is one: 1 where it holds, else 0.
fn compared(op: BinOp, x: &Expression, y: &Expression) -> Option<Expression> {
    Some(match op {
        BinOp::Less => x.less(y),
        BinOp::Greater => y.less(x),
        BinOp::LessOrEqual => y.less(x).negated(),
        BinOp::GreaterOrEqual => x.less(y).negated(),
        BinOp::Equal => x.less(y).max(y.less(x)).negated(),
        BinOp::NotEqual => x.less(y).max(y.less(x)),
        _ => return None,
    })
}

/// Whether two values are one and the same.
fn same_value(a: Value, b: Value) -> bool {
    match (a, b) {
        (Value::None, Value::None) => true,
        (Value::Bool(a), Value::Bool(b)) => a == b,
        (Value::Int(a), Value::Int(b)) => a == b,
        (Value::Float(a), Value::Float(b)) => a.to_bits() == b.to_bits(),
        (Value::Text(a), Value::Text(b))
        | (Value::List(a), Value::List(b))
        | (Value::Tuple(a), Value::Tuple(b))
        | (Value::Dict(a), Value::Dict(b))
        | (Value::Range(a), Value::Range(b))
        | (Value::Function(a), Value::Function(b))
        | (Value::Bound(a), Value::Bound(b))
        | (Value::Thing(a), Value::Thing(b)) => a == b,
        (Value::Native(a), Value::Native(b)) => std::ptr::eq(a, b),
        (Value::Primitive(a), Value::Primitive(b)) => std::ptr::eq(a, b),
        (Value::Join(a), Value::Join(b)) => std::ptr::eq(a, b),
        (Value::Formula(a), Value::Formula(b)) => std::ptr::eq(a, b),
        _ => false,
    }
}

/// Three plain numbers.
fn three_numbers(items: &[Value]) -> Option<[f64; 3]> {
    let number = |value: &Value| match *value {
        Value::Int(i) => Some(i as f64),
        Value::Float(x) => Some(x),
        _ => None,
    };
    match items {
        [x, y, z] => Some([number(x)?, number(y)?, number(z)?]),
        _ => None,
    }
}
