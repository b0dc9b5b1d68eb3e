//! Values of the language, and the store that owns them.
//!
//! A value is a small handle; what it stands for lies in the store, which only grows and is dropped at once when the
//! script ends. So values that hold each other cannot leak or overflow the stack, and the bytes that a script made are
//! known before they are made.

use super::native::Native;
use crate::registers::Registers;
use indexmap::IndexMap;
use std::sync::Arc;
use zeroset_catalogue::entries::{JoinEntry, MapEntry, ModifyEntry, PrimitiveEntry};
use zeroset_field::field::Field;
use zeroset_field::formula::{Expression, Function};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::methods::Choice;
use zeroset_scene::settings;

/// A value.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    None,
    Bool(bool),
    Int(i64),
    Float(f64),
    Text(u32),
    List(u32),
    Tuple(u32),
    Dict(u32),
    Range(u32),
    /// A function or lambda of the script.
    Function(u32),
    /// A function of this crate.
    Native(&'static Native),
    Primitive(&'static PrimitiveEntry),
    Join(&'static JoinEntry),
    /// A function of formulas.
    Formula(&'static Function),
    /// A method with what it belongs to.
    Bound(u32),
    Thing(u32),
}

/// What a method does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Method {
    Native(&'static Native),
    Map(&'static MapEntry),
    Modify(&'static ModifyEntry),
    Join(&'static JoinEntry),
}

/// A value of the scene's domain.
#[derive(Clone, Debug)]
pub(crate) enum Thing {
    Field(Field),
    Material(Arc<Material>),
    Pattern(Pattern),
    March(settings::March),
    Shadow(settings::Shadow),
    Occlusion(settings::Occlusion),
    Antialias(settings::Antialias),
    Integrator(settings::Integrator),
    /// `none()`, which several settings take.
    Nothing,
    Orthographic(f64),
    /// A value of a formula that is being written down.
    Expression(Expression),
    /// A condition on the point of a formula: 1 where it holds, else 0.
    Condition(Expression),
    /// A formula from a file.
    Registers(Arc<Registers>),
}

impl Thing {
    /// What a person calls it.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Thing::Field(_) => "a field",
            Thing::Material(_) => "a material",
            Thing::Pattern(_) => "a pattern",
            Thing::March(_) => settings::March::WHAT,
            Thing::Shadow(_) => settings::Shadow::WHAT,
            Thing::Occlusion(_) => settings::Occlusion::WHAT,
            Thing::Antialias(_) => settings::Antialias::WHAT,
            Thing::Integrator(_) => settings::Integrator::WHAT,
            Thing::Nothing => "none()",
            Thing::Orthographic(_) => "an orthographic lens",
            Thing::Expression(_) => "a value of a formula",
            Thing::Condition(_) => "a condition on the point of a formula",
            Thing::Registers(_) => "a formula from a file",
        }
    }

    /// The marching method that it is, if it is one.
    pub(crate) fn march(&self) -> Option<settings::March> {
        match self {
            Thing::March(march) => Some(*march),
            _ => None,
        }
    }

    /// The shadow that it is, if it is one.
    pub(crate) fn shadow(&self) -> Option<settings::Shadow> {
        match self {
            Thing::Shadow(shadow) => Some(*shadow),
            _ => None,
        }
    }

    /// The occlusion method that it is, if it is one.
    pub(crate) fn occlusion(&self) -> Option<settings::Occlusion> {
        match self {
            Thing::Occlusion(occlusion) => Some(*occlusion),
            _ => None,
        }
    }

    /// The antialiasing method that it is, if it is one.
    pub(crate) fn antialias(&self) -> Option<settings::Antialias> {
        match self {
            Thing::Antialias(antialias) => Some(*antialias),
            _ => None,
        }
    }

    /// The integrator that it is, if it is one.
    pub(crate) fn integrator(&self) -> Option<settings::Integrator> {
        match self {
            Thing::Integrator(integrator) => Some(*integrator),
            _ => None,
        }
    }
}

/// What a dict is keyed by: a value by content.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum DictKey {
    None,
    Bool(bool),
    Int(i64),
    Float(u64),
    Text(Arc<str>),
    Tuple(Vec<DictKey>),
}

/// The items of a list, and how many loops run over it: then it must not change.
#[derive(Debug, Default)]
pub(crate) struct List {
    pub(crate) items: Vec<Value>,
    pub(crate) loops: u32,
}

/// The pairs of a dict in the order they were added, and how many loops run over it.
#[derive(Debug, Default)]
pub(crate) struct Dict {
    pub(crate) pairs: IndexMap<DictKey, (Value, Value)>,
    pub(crate) loops: u32,
}

/// Numbers from `start` by `step`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) start: i64,
    pub(crate) step: i64,
    pub(crate) length: u64,
}

impl Range {
    /// The number at a place, which must be below `length`.
    pub(crate) fn at(&self, index: u64) -> i64 {
        (i128::from(self.start) + i128::from(self.step) * i128::from(index)) as i64
    }
}

/// Owns what values stand for.
#[derive(Default)]
pub(crate) struct Store {
    pub(crate) texts: Vec<Arc<str>>,
    pub(crate) lists: Vec<List>,
    pub(crate) tuples: Vec<Box<[Value]>>,
    pub(crate) dicts: Vec<Dict>,
    pub(crate) ranges: Vec<Range>,
    pub(crate) bound: Vec<(Value, &'static str, Method)>,
    pub(crate) things: Vec<Thing>,
}

impl Store {
    pub(crate) fn text(&self, i: u32) -> &Arc<str> {
        &self.texts[i as usize]
    }

    pub(crate) fn list(&self, i: u32) -> &List {
        &self.lists[i as usize]
    }

    pub(crate) fn list_mut(&mut self, i: u32) -> &mut List {
        &mut self.lists[i as usize]
    }

    pub(crate) fn tuple(&self, i: u32) -> &[Value] {
        &self.tuples[i as usize]
    }

    pub(crate) fn dict(&self, i: u32) -> &Dict {
        &self.dicts[i as usize]
    }

    pub(crate) fn dict_mut(&mut self, i: u32) -> &mut Dict {
        &mut self.dicts[i as usize]
    }

    pub(crate) fn range(&self, i: u32) -> &Range {
        &self.ranges[i as usize]
    }

    pub(crate) fn thing(&self, i: u32) -> &Thing {
        &self.things[i as usize]
    }

    /// What a person calls the kind of a value, with its article.
    pub(crate) fn kind(&self, value: Value) -> &'static str {
        match value {
            Value::None => "None",
            Value::Bool(_) => "a truth value",
            Value::Int(_) => "a whole number",
            Value::Float(_) => "a number",
            Value::Text(_) => "a text",
            Value::List(_) => "a list",
            Value::Tuple(_) => "a tuple",
            Value::Dict(_) => "a dict",
            Value::Range(_) => "a range",
            Value::Function(_)
            | Value::Native(_)
            | Value::Primitive(_)
            | Value::Join(_)
            | Value::Formula(_)
            | Value::Bound(_) => "a function",
            Value::Thing(i) => self.thing(i).kind(),
        }
    }

    /// Items of a list or tuple.
    pub(crate) fn items(&self, value: Value) -> Option<&[Value]> {
        match value {
            Value::List(i) => Some(&self.list(i).items),
            Value::Tuple(i) => Some(self.tuple(i)),
            _ => None,
        }
    }

    /// Python's truth.
    pub(crate) fn is_true(&self, value: Value) -> bool {
        match value {
            Value::None => false,
            Value::Bool(b) => b,
            Value::Int(i) => i != 0,
            Value::Float(x) => x != 0.0,
            Value::Text(i) => !self.text(i).is_empty(),
            Value::List(i) => !self.list(i).items.is_empty(),
            Value::Tuple(i) => !self.tuple(i).is_empty(),
            Value::Dict(i) => !self.dict(i).pairs.is_empty(),
            Value::Range(i) => self.range(i).length > 0,
            _ => true,
        }
    }
}
