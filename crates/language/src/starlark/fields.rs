//! The catalogue of fields in the language: every primitive is a function, every map and modifier a method of a field,
//! every join both.

use super::machine::Machine;
use super::mistake::{Mistake, Run, mistake};
use super::native::{Call, Given, Native, spoken};
use super::place;
use super::shaping;
use super::value::{Method, Thing, Value};
use starlark_syntax::syntax::ast::BinOp;
use std::sync::LazyLock;
use zeroset_catalogue::entries::{
    Catalogue, JoinEntry, MapEntry, ModifyEntry, PrimitiveEntry, catalogue,
};
use zeroset_catalogue::{Info, Kind, Param, Unit};
use zeroset_field::field::{Field, FieldError, Node};

/// Methods that mean a join, beside the join's own name.
const SYNONYMS: &[(&str, &str)] = &[("blend", "smooth_union")];

/// The methods that no entry of the catalogue is.
pub(crate) fn own_methods() -> impl Iterator<Item = &'static Native> {
    place::METHODS.iter().chain(shaping::METHODS)
}

/// The method of a field with this name.
pub(crate) fn method(name: &str) -> Option<(&'static str, Method)> {
    if let Some(native) = own_methods().find(|n| n.name == name) {
        return Some((native.name, Method::Native(native)));
    }
    let all = catalogue();
    if let Some(entry) = all.map(name) {
        return Some((entry.info.name, Method::Map(entry)));
    }
    if let Some(entry) = all.modifier(name) {
        return Some((entry.info.name, Method::Modify(entry)));
    }
    let join = SYNONYMS.iter().find(|s| s.0 == name).map_or(name, |s| s.1);
    all.join(join).map(|entry| {
        (
            SYNONYMS
                .iter()
                .find(|s| s.0 == name)
                .map_or(entry.info.name, |s| s.0),
            Method::Join(entry),
        )
    })
}

/// Methods that are a join under another name, for the reference.
pub(crate) fn synonymous_methods() -> impl Iterator<Item = super::Word> {
    SYNONYMS.iter().filter_map(|(name, join)| {
        let entry = catalogue().join(join)?;
        let radius = entry.info.params.first()?;
        Some(super::Word {
            name,
            kind: "method",
            doc: "Another name of smooth_union as a method: a.blend(b, radius = 0.2).",
            group: entry.info.group,
            params: vec![
                ("other", "", "The other field."),
                (radius.name, "0.25", radius.doc),
            ],
            more: false,
        })
    })
}

/// The names of all methods of a field.
pub(crate) fn method_names() -> &'static [&'static str] {
    static NAMES: LazyLock<Vec<&str>> = LazyLock::new(|| {
        let all = catalogue();
        (own_methods().map(|n| n.name))
            .chain(all.maps.iter().map(|e| e.info.name))
            .chain(all.modifiers.iter().map(|e| e.info.name))
            .chain(all.joins.iter().map(|e| e.info.name))
            .chain(SYNONYMS.iter().map(|s| s.0))
            .collect()
    });
    &NAMES
}

/// A hint for who writes `shape.sphere()`.
pub(crate) fn function_of_this_name(name: &str) -> Option<String> {
    catalogue().primitive(name)?;
    Some(format!(
        "{name}(...) is a function of its own: shape | {name}(...)"
    ))
}

/// What the field's crate says, as a mistake at the call.
pub(crate) fn unfit(error: &FieldError) -> Box<Mistake> {
    let m = mistake(error.to_string());
    match error {
        FieldError::Dimension {
            hint,
            wanted,
            given,
            entry,
        } => mistake(format!(
            "{entry}() needs a {wanted} shape, this one is {given}"
        ))
        .help(*hint),
        FieldError::Deep => m.help("join many shapes with one union([...])"),
        FieldError::Unfit { entry, reason } => mistake(format!("{entry}(): {reason}")),
        FieldError::Empty { entry } => mistake(format!("{entry}() needs at least one field")),
        _ => m,
    }
}

/// A field as a value, its node charged.
pub(crate) fn value(machine: &mut Machine<'_>, field: Result<Field, FieldError>) -> Run<Value> {
    let field = field.map_err(|e| unfit(&e))?;
    let numbers = match field.node() {
        Node::Primitive { params, .. } | Node::Map { params, .. } | Node::Modify { params, .. } => {
            params.len()
        }
        Node::Join { params, shapes, .. } => params.len() + shapes.len(),
        _ => 0,
    };
    machine.grow_field(numbers)?;
    machine.thing(Thing::Field(field))
}

impl Call<'_, '_> {
    /// A field.
    pub(crate) fn field(&self, param: &str, given: Given) -> Run<Field> {
        if let Value::Thing(i) = given.value
            && let Thing::Field(field) = self.machine.store.thing(i)
        {
            return Ok(field.clone());
        }
        let m = self.unfit(param, "a field", given);
        Err(match given.value {
            Value::Primitive(e) => m.help(format!("write {}() to make one", e.info.name)),
            _ => m,
        })
    }

    /// The field that the method belongs to.
    pub(crate) fn shape(&self) -> Run<Field> {
        self.field(
            "the method",
            Given {
                value: self.receiver,
                place: self.place,
            },
        )
    }

    /// The parameter array of a catalogue entry.
    fn params_of(&mut self, info: &'static Info) -> Run<Vec<f64>> {
        let mut out = Vec::new();
        for param in info.params {
            match self.get(param.name) {
                Some(given) => self.param(param, given, &mut out)?,
                None if param.default.is_empty() => {
                    let m = mistake(format!("{}() needs `{}`", self.name, param.name));
                    return Err(m.help(format!("{}: {}", param.name, param.doc)));
                }
                None => {
                    if let Kind::List(width) = param.kind {
                        out.push((param.default.len() / width) as f64);
                    }
                    out.extend_from_slice(param.default);
                }
            }
        }
        Ok(out)
    }

    /// One parameter of a catalogue entry, appended to its array.
    fn param(&mut self, param: &'static Param, given: Given, out: &mut Vec<f64>) -> Run<()> {
        match param.kind {
            Kind::Number => out.push(self.component(param, given)?),
            Kind::Vec2 => out.extend(self.components::<2>(param, given)?),
            Kind::Vec3 if param.unit == Unit::Direction => {
                out.extend(self.direction(param.name, given)?)
            }
            Kind::Vec3 => out.extend(self.components::<3>(param, given)?),
            Kind::List(width) => {
                let items = self.machine.collect(given.value);
                let items = items.map_err(|_| self.unfit(param.name, &list_words(width), given))?;
                self.machine.grow(8 * width * items.len())?;
                out.push(items.len() as f64);
                for value in items {
                    match width {
                        1 => out.push(self.component(param, Given { value, ..given })?),
                        _ => {
                            let numbers = self
                                .machine
                                .store
                                .items(value)
                                .map(<[Value]>::to_vec)
                                .unwrap_or_default();
                            if numbers.len() != width {
                                let m = mistake(format!(
                                    "{} must be {}",
                                    self.called(param.name),
                                    list_words(width)
                                ));
                                return Err(m.at(given.place));
                            }
                            for value in numbers {
                                out.push(self.component(param, Given { value, ..given })?);
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// One number for all components, or one for each.
    fn components<const N: usize>(&self, param: &'static Param, given: Given) -> Run<[f64; N]> {
        if matches!(given.value, Value::Int(_) | Value::Float(_)) {
            return Ok([self.component(param, given)?; N]);
        }
        let items = self
            .machine
            .store
            .items(given.value)
            .filter(|items| items.len() == N);
        let items = items.ok_or_else(|| {
            let wanted = if N == 2 {
                "a number or (x, y)"
            } else {
                "a number or (x, y, z)"
            };
            self.unfit(param.name, wanted, given)
        })?;
        let mut out = [0.0; N];
        for (x, value) in out.iter_mut().zip(items) {
            *x = self.component(
                param,
                Given {
                    value: *value,
                    ..given
                },
            )?;
        }
        Ok(out)
    }

    /// One number of a parameter: checked, and from the unit of scene files to the field's.
    fn component(&self, param: &'static Param, given: Given) -> Run<f64> {
        let x = self.number(param.name, given)?;
        let called = self.called(param.name);
        let y = if is_angle(param.unit) {
            x.to_radians()
        } else {
            x
        };
        let say = |x: f64| {
            if is_angle(param.unit) {
                spoken(x.to_degrees())
            } else {
                spoken(x)
            }
        };
        if !(param.min <= y && y <= param.max) {
            let message = format!(
                "{called} is {}, allowed is {} to {}",
                spoken(x),
                say(param.min),
                say(param.max)
            );
            return Err(mistake(message)
                .help(format!("{}: {}", param.name, param.doc))
                .at(given.place));
        }
        if param.unit == Unit::Count && x.fract() != 0.0 {
            return Err(mistake(format!(
                "{called} must be a whole number, not {}",
                spoken(x)
            ))
            .at(given.place));
        }
        Ok(y)
    }

    /// A direction: three numbers, or "x", "-y" and the like.
    pub(crate) fn direction(&self, param: &str, given: Given) -> Run<[f64; 3]> {
        if let Value::Text(i) = given.value {
            let word = self.machine.store.text(i);
            return direction_of_word(word).ok_or_else(|| {
                let message = format!("{} cannot be \"{word}\"", self.called(param));
                let help = "write \"x\", \"y\", \"z\", \"-x\", \"-y\", \"-z\" or three numbers such as (1, 2, 0)";
                mistake(message).help(help).at(given.place)
            });
        }
        if !matches!(given.value, Value::List(_) | Value::Tuple(_)) {
            return Err(self.unfit(param, "a direction such as \"y\" or (1, 2, 0)", given));
        }
        let v: [f64; 3] = self.numbers(param, given)?;
        if v.iter().all(|x| *x == 0.0) {
            return Err(mistake(format!(
                "{} is (0, 0, 0), which points nowhere",
                self.called(param)
            ))
            .at(given.place));
        }
        Ok(v)
    }
}

/// The direction of "x", "-y" and the like.
pub(crate) fn direction_of_word(word: &str) -> Option<[f64; 3]> {
    let (sign, axis) = match word.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    };
    let k = ["x", "y", "z"].iter().position(|a| *a == axis)?;
    let mut out = [0.0; 3];
    out[k] = sign;
    Some(out)
}

/// Whether a parameter is degrees in scene files and radians in the field.
pub(crate) fn is_angle(unit: Unit) -> bool {
    matches!(unit, Unit::Angle | Unit::Rate)
}

fn list_words(width: usize) -> String {
    match width {
        1 => "a list of numbers".into(),
        2 => "a list of points such as [(0, 0), (1, 2)]".into(),
        3 => "a list of points such as [(0, 0, 0), (1, 2, 3)]".into(),
        n => format!("a list of tuples of {n} numbers"),
    }
}

/// `sphere(radius)`.
pub(crate) fn primitive(call: &mut Call<'_, '_>, entry: &'static PrimitiveEntry) -> Run<Value> {
    let params = call.params_of(&entry.info)?;
    value(call.machine, Field::primitive(entry, params))
}

/// `shape.twist(rate)`.
pub(crate) fn map(call: &mut Call<'_, '_>, entry: &'static MapEntry) -> Run<Value> {
    let (shape, params) = (call.shape()?, call.params_of(&entry.info)?);
    value(call.machine, shape.map(entry, params))
}

/// `shape.onion(thickness)`.
pub(crate) fn modify(call: &mut Call<'_, '_>, entry: &'static ModifyEntry) -> Run<Value> {
    let (shape, params) = (call.shape()?, call.params_of(&entry.info)?);
    value(call.machine, shape.modify(entry, params))
}

/// `smooth_union([a, b, c], radius)`.
pub(crate) fn join(call: &mut Call<'_, '_>, entry: &'static JoinEntry) -> Run<Value> {
    let params = call.params_of(&entry.info)?;
    let given = call.need("shapes")?;
    let fields = call.machine.collect(given.value);
    let fields = fields.map_err(|_| call.unfit("shapes", "a list of fields", given))?;
    let mut shapes = Vec::with_capacity(fields.len());
    for (i, value) in fields.into_iter().enumerate() {
        let item = format!("{}. of the fields", i + 1);
        shapes.push(call.field(&item, Given { value, ..given })?);
    }
    value(call.machine, Field::join(entry, params, shapes))
}

/// `a.smooth_union(b, radius)`.
pub(crate) fn join_method(call: &mut Call<'_, '_>, entry: &'static JoinEntry) -> Run<Value> {
    let other = call.need("other")?;
    let (shape, other) = (call.shape()?, call.field("other", other)?);
    let params = call.params_of(&entry.info)?;
    value(call.machine, Field::join(entry, params, vec![shape, other]))
}

/// An operator between two fields; `None` where there is none.
pub(crate) fn operate(
    machine: &mut Machine<'_>,
    op: BinOp,
    a: Field,
    b: Field,
) -> Run<Option<Value>> {
    let (entry, associative) = match op {
        BinOp::BitOr => (Some(Catalogue::union()), true),
        BinOp::BitAnd => (catalogue().join("intersection"), true),
        BinOp::Subtract => (catalogue().join("subtraction"), false),
        BinOp::BitXor => (catalogue().join("xor"), false),
        _ => (None, false),
    };
    let Some(entry) = entry else { return Ok(None) };
    // a | b | c is one union of three: a chain of any length stays flat
    let mut shapes = match a.node() {
        Node::Join {
            entry: inner,
            shapes,
            ..
        } if associative && inner.info.name == entry.info.name => {
            machine.charge(shapes.len() as u64)?;
            machine.grow(8 * shapes.len())?;
            shapes.clone()
        }
        _ => vec![a],
    };
    shapes.push(b);
    value(machine, Field::join(entry, Vec::new(), shapes)).map(Some)
}

/// `~field`.
pub(crate) fn complement(machine: &mut Machine<'_>, field: Field) -> Run<Value> {
    let entry = catalogue().modifier("complement");
    let entry = entry
        .ok_or_else(|| mistake("`~` of a field is not known").help("a - b takes b away from a"))?;
    value(machine, field.modify(entry, Vec::new()))
}
