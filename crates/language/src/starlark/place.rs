//! Methods of a field that no catalogue entry describes: placements, copies, paint.

use super::fields;
use super::mistake::{Run, mistake};
use super::native::{Call, Given, Native, Slot, slot};
use super::value::{Thing, Value};
use zeroset_catalogue::{Dimension, LARGE, SMALL};
use zeroset_field::field::Paint;
use zeroset_field::placement::Placement;
use zeroset_field::repetition::{MAX_COPIES, Polar, Repetition};

/// Where a move goes.
pub(super) const MOVE: &[Slot] = &[
    slot("x", "0", "How far along x; or all three as (x, y, z)."),
    slot("y", "0", "How far along y."),
    slot("z", "0", "How far along z."),
];

/// What says a turn.
pub(super) const TURN: &[Slot] = &[
    slot("x", "0", "Degrees about x; or all three as (x, y, z)."),
    slot("y", "0", "Degrees about y."),
    slot("z", "0", "Degrees about z."),
    slot(
        "axis",
        "None",
        "An axis such as \"y\" or (1, 1, 0), instead of x, y, z.",
    ),
    slot(
        "angle",
        "None",
        "Degrees about the axis, counter-clockwise when it points at you.",
    ),
    slot("quaternion", "None", "(x, y, z, w), instead of all others."),
];

macro_rules! method {
    ($group:literal, $name:literal, $doc:literal, $slots:ident, $run:expr) => {
        Native { name: $name, doc: $doc, group: $group, params: $slots, rest: false, run: $run }
    };
    ($group:literal, $name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native { name: $name, doc: $doc, group: $group, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run }
    };
}

/// The methods.
pub(crate) const METHODS: &[Native] = &[
    method!("Placement", "move", "Moves the shape.", MOVE, |c| {
        let offset = coordinates(c, LARGE)?;
        place(c, Placement::moved(offset))
    }),
    method!(
        "Placement",
        "turn",
        "Turns the shape about the origin: about x, then y, then z, or about an axis.",
        TURN,
        turn
    ),
    method!(
        "Placement",
        "scale",
        "Scales the shape about the origin, the same in all directions.",
        [slot("factor", "", "How many times larger; above 0.")],
        |c| {
            let given = c.need("factor")?;
            if matches!(given.value, Value::Tuple(_) | Value::List(_)) {
                return Err(mistake("scale() takes one factor for all directions")
                    .help("a factor for each axis is stretch: .stretch((1, 2, 1))")
                    .at(given.place));
            }
            let factor = c.ranged("factor", given, SMALL, LARGE)?;
            place(c, Placement::scaled(factor))
        }
    ),
    method!(
        "Copies",
        "repeat",
        "Copies of the shape on a grid centred on the origin; distances stay true.",
        [
            slot(
                "spacing",
                "",
                "Distance between copies: a number, or (x, y, z) with 0 where it is not repeated."
            ),
            slot(
                "count",
                "None",
                "Number of copies: a number, or (x, y, z); None or 0 for without end."
            ),
            slot(
                "vary",
                "0",
                "Every copy is moved at random by up to this: a number or (x, y, z)."
            ),
            slot("seed", "0", "Chooses other random places.")
        ],
        repeat
    ),
    method!(
        "Copies",
        "polar",
        "Copies of the shape around the y axis, the first one where it is. Those of a plane shape stay in its plane, around z.",
        [slot("count", "", "Number of copies.")],
        |c| {
            c.need("count")?;
            let count = c.count_or("count", 1, 1, MAX_COPIES)?;
            let shape = c.shape()?;
            fields::value(c.machine, shape.polar(Polar { count }))
        }
    ),
    method!(
        "Materials",
        "paint",
        "Gives the shape a material of its own, wherever it has none yet.",
        [slot("material", "", "A material, or a colour.")],
        |c| {
            let given = c.need("material")?;
            let material = c.material("material", given)?;
            let number = c
                .machine
                .draft
                .number(&material)
                .ok_or_else(|| mistake("the scene has too many materials"))?;
            let shape = c.shape()?;
            fields::value(c.machine, shape.paint(Paint::Material(number)))
        }
    ),
    method!(
        "Values and lists",
        "bounds",
        "The corners ((x, y, z), (x, y, z)) of a box that holds the shape.",
        [],
        |c| {
            let bounds = c.shape()?.facts().bounds;
            let corners = [bounds.min, bounds.max].map(|p| {
                c.machine.grow_items(4)?;
                c.machine.tuple(p.map(Value::Float).to_vec())
            });
            let [min, max] = corners;
            let both = vec![min?, max?];
            c.machine.tuple(both)
        }
    ),
    super::formulas::MAP,
];

fn place(c: &mut Call<'_, '_>, placement: Placement) -> Run<Value> {
    let shape = c.shape()?;
    fields::value(c.machine, shape.place(placement))
}

/// `x`, `y` and `z`, or all three in `x`.
pub(super) fn coordinates(c: &Call<'_, '_>, limit: f64) -> Run<[f64; 3]> {
    if let Some(given) = c.get("x")
        && matches!(given.value, Value::List(_) | Value::Tuple(_))
    {
        if let Some(second) = c.get("y").or_else(|| c.get("z")) {
            return Err(mistake("all three coordinates are given already").at(second.place));
        }
        let [x, y, z]: [f64; 3] = c.numbers("x", given)?;
        let parts = [x, y, z].map(|v| {
            c.ranged(
                "x",
                Given {
                    value: Value::Float(v),
                    ..given
                },
                -limit,
                limit,
            )
        });
        let [x, y, z] = parts;
        return Ok([x?, y?, z?]);
    }
    Ok([
        c.number_or("x", 0.0, -limit, limit)?,
        c.number_or("y", 0.0, -limit, limit)?,
        c.number_or("z", 0.0, -limit, limit)?,
    ])
}

fn turn(c: &mut Call<'_, '_>) -> Run<Value> {
    let placement = turned(c)?;
    place(c, placement)
}

/// What the arguments of a turn say.
pub(super) fn turned(c: &Call<'_, '_>) -> Run<Placement> {
    let (axis, angle, quaternion) = (c.get("axis"), c.get("angle"), c.get("quaternion"));
    let euler = c.get("x").or_else(|| c.get("y")).or_else(|| c.get("z"));
    Ok(match (quaternion, axis, angle) {
        (Some(q), None, None) if euler.is_none() => {
            let numbers: [f64; 4] = c.numbers("quaternion", q)?;
            if numbers.iter().all(|x| *x == 0.0) {
                return Err(
                    mistake("the quaternion is (0, 0, 0, 0), which turns nothing").at(q.place),
                );
            }
            Placement::quaternion(numbers)
        }
        (None, Some(axis), Some(angle)) if euler.is_none() => Placement::turned(
            c.direction("axis", axis)?,
            c.number("angle", angle)?.to_radians(),
        ),
        (None, None, None) => Placement::euler(coordinates(c, 1e9)?.map(f64::to_radians)),
        _ => {
            let help = "write turn(y = 30), turn(axis = (1, 1, 0), angle = 30) or turn(quaternion = (0, 0, 0, 1))";
            return Err(mistake("these do not say one turn").help(help));
        }
    })
}

fn repeat(c: &mut Call<'_, '_>) -> Run<Value> {
    let shape = c.shape()?;
    // one number for all axes means those of the plane where the shape is plane
    let plane = shape.facts().dimension == Dimension::Two;
    let one = |given: Given| matches!(given.value, Value::Int(_) | Value::Float(_));
    let each = |c: &Call<'_, '_>, param: &str, given: Given| -> Run<[f64; 3]> {
        let mut numbers = each_axis(c, param, given, 0.0, LARGE)?;
        if plane && one(given) {
            numbers[2] = 0.0;
        }
        Ok(numbers)
    };
    let spacing = c.need("spacing")?;
    let spacing = each(c, "spacing", spacing)?;
    let vary = c.get("vary").map_or(Ok([0.0; 3]), |g| each(c, "vary", g))?;
    let count = match c.get("count") {
        None => [0; 3],
        Some(given) => {
            let numbers = each_axis(c, "count", given, 0.0, f64::from(MAX_COPIES))?;
            if numbers.iter().any(|x| x.fract() != 0.0) {
                return Err(
                    mistake(format!("{} must be whole numbers", c.called("count"))).at(given.place),
                );
            }
            numbers.map(|x| x as u32)
        }
    };
    let seed = c.count_or("seed", 0, 0, u32::MAX)?;
    fields::value(
        c.machine,
        shape.repeat(Repetition {
            spacing,
            count,
            vary,
            seed,
        }),
    )
}

/// A number for all axes, or one for each.
pub(super) fn each_axis(
    c: &Call<'_, '_>,
    param: &str,
    given: Given,
    min: f64,
    max: f64,
) -> Run<[f64; 3]> {
    if matches!(given.value, Value::Int(_) | Value::Float(_)) {
        return Ok([c.ranged(param, given, min, max)?; 3]);
    }
    let numbers: [f64; 3] = c.numbers(param, given)?;
    for x in numbers {
        c.ranged(
            param,
            Given {
                value: Value::Float(x),
                ..given
            },
            min,
            max,
        )?;
    }
    Ok(numbers)
}

impl Call<'_, '_> {
    /// A material, or a colour as a material of that colour.
    pub(crate) fn material(
        &self,
        param: &str,
        given: Given,
    ) -> Run<std::sync::Arc<zeroset_scene::material::Material>> {
        if let Value::Thing(i) = given.value {
            match self.machine.store.thing(i) {
                Thing::Material(material) => return Ok(material.clone()),
                Thing::Pattern(pattern) => {
                    return Ok(zeroset_scene::material::Material {
                        pattern: pattern.clone(),
                        ..Default::default()
                    }
                    .into());
                }
                _ => {}
            }
        }
        if matches!(given.value, Value::Text(_) | Value::Tuple(_)) {
            let colour = self.colour(param, given)?;
            let pattern = zeroset_scene::material::Pattern::Solid { colour };
            return Ok(zeroset_scene::material::Material {
                pattern,
                ..Default::default()
            }
            .into());
        }
        Err(self.unfit(
            param,
            "a material such as material(color = \"#e8b04a\")",
            given,
        ))
    }
}
