//! The scene language: Starlark with the catalogue of fields built in.
//!
//! The text is parsed by `starlark_syntax`, the parser of starlark-rust. It is run by this module's own interpreter and
//! not by starlark-rust's: scene files come from strangers, and that one checks its limits only every thousand steps, so
//! that a few lines take gigabytes or never end (measured with 0.14.2: comparing two tuples that hold themselves sixty
//! times over never returns, doubling a list thirty times takes 4.4 GB). Here every step, every copied item and every
//! byte is charged before it is spent.
//!
//! | file | what |
//! | --- | --- |
//! | `module` | parsing, and refusing what nests too deeply |
//! | `letters` | names with letters beyond ASCII |
//! | `depth` | the one budget for what is inside each other |
//! | `scope` | which names belong to whom |
//! | `machine` | the state of a running script and its budget |
//! | `run`, `calls`, `operators`, `sequences`, `text` | the language itself |
//! | `builtins`, `methods`, `math` | everyday functions |
//! | `fields`, `place` | the catalogue as functions and methods |
//! | `synonyms` | what other tools call things |
//! | `formulas`, `shaping` | fields from formulas, between fields and along curves |
//! | `lettering`, `sampling` | fields from letters and from files |
//! | `colours` | materials from formulas |
//! | `materials`, `stage`, `rendering`, `parameters` | everything else of a scene |

mod builtins;
mod calls;
mod colours;
pub(crate) mod depth;
mod fields;
mod formulas;
mod lettering;
mod letters;
mod machine;
mod materials;
mod math;
mod methods;
pub(crate) mod mistake;
pub(crate) mod module;
mod native;
mod operators;
mod parameters;
mod place;
mod rendering;
mod run;
mod sampling;
mod scope;
mod sequences;
mod shaping;
mod stage;
mod synonyms;
mod text;
mod value;

pub(crate) use fields::direction_of_word;
pub(crate) use materials::shininess_of;
pub(crate) use native::spoken;
pub(crate) use scope::assigned_names;
pub use synonyms::{SYNONYMS, Synonym};

use crate::draft::Draft;
use crate::limits::Limits;
use machine::Machine;
use mistake::{Run, mistake};
use module::Module;
use native::Native;
use std::collections::HashMap;
use std::sync::LazyLock;
use value::Value;
use web_time::Instant;
use zeroset_catalogue::entries::catalogue;
use zeroset_field::formula::Function;

/// Functions of this crate that stand alone.
fn natives() -> impl Iterator<Item = &'static Native> {
    [
        builtins::ALL,
        formulas::ALL,
        lettering::ALL,
        math::ALL,
        materials::ALL,
        stage::ALL,
        rendering::all(),
        parameters::ALL,
        sampling::ALL,
        shaping::ALL,
    ]
    .into_iter()
    .flatten()
}

/// Whether a function that stands alone has this name: one of this crate, a shape, a join.
pub(crate) fn is_native(name: &str) -> bool {
    let all = catalogue();
    natives().any(|n| n.name == name) || all.join(name).is_some() || all.primitive(name).is_some()
}

/// The parameters of a function of this crate that stands alone, in their order.
pub(crate) fn parameters_of(name: &str) -> Vec<&'static str> {
    let native = natives().find(|n| n.name == name);
    let params = native.map_or(&[] as &[native::Slot], |n| n.params);
    params.iter().map(|p| p.name).collect()
}

/// Every name that is there without being defined.
pub(crate) fn builtins() -> &'static HashMap<&'static str, Value> {
    static NAMES: LazyLock<HashMap<&'static str, Value>> = LazyLock::new(|| {
        let all = catalogue();
        let words = [
            ("None", Value::None),
            ("True", Value::Bool(true)),
            ("False", Value::Bool(false)),
        ];
        (all.primitives
            .iter()
            .map(|e| (e.info.name, Value::Primitive(e))))
        .chain(all.joins.iter().map(|e| (e.info.name, Value::Join(e))))
        .chain(formulas::more_functions().map(|f| (f.name, Value::Formula(f))))
        .chain(natives().map(|n| (n.name, Value::Native(n))))
        .chain(
            math::CONSTANTS
                .iter()
                .map(|(name, _, x)| (*name, Value::Float(*x))),
        )
        .chain(words)
        .collect()
    });
    &NAMES
}

/// Runs the modules in order, the last one being the scene itself, and gives what they declare.
pub(crate) fn run(
    modules: &[Module],
    draft: Draft,
    limits: &Limits,
    start: Instant,
) -> (Draft, Run<()>) {
    let mut machine = Machine::new(modules, draft, *limits, start);
    let result = (0..modules.len()).try_for_each(|module| machine.run_module(module as u32));
    let draft = machine.draft;
    let result = result.and_then(|()| check(&draft));
    (draft, result)
}

/// Whether a script that ran to its end declared a scene.
fn check(draft: &Draft) -> Run<()> {
    if let Some((message, help)) = draft.unknown_parameter() {
        return Err(mistake(message).help(help));
    }
    if draft.objects.is_empty() {
        return Err(mistake("the scene shows nothing").help("show(sphere()) puts a ball on stage"));
    }
    Ok(())
}

/// A function, a method or a constant of the language, for references and editors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// Its name.
    pub name: &'static str,
    /// What it is: a function, a function of formulas, a method (of a field, or of what is said), a constant.
    pub kind: &'static str,
    /// One line.
    pub doc: &'static str,
    /// The section of the reference it stands in.
    pub group: &'static str,
    /// Its parameters: name, how the default is written (empty where there is none), one line.
    pub params: Vec<(&'static str, &'static str, &'static str)>,
    /// Whether more values may follow.
    pub more: bool,
}

impl Word {
    fn of(native: &'static Native, kind: &'static str) -> Word {
        let params = native.params.iter().map(|p| (p.name, p.default, p.doc));
        Word {
            name: native.name,
            kind,
            doc: native.doc,
            group: native.group,
            params: params.collect(),
            more: native.rest,
        }
    }

    fn of_formulas(function: &'static Function) -> Word {
        let params = function.params.iter().map(|name| (*name, "", ""));
        let optional = function.optional.iter().map(|name| (*name, "...", ""));
        Word {
            name: function.name,
            kind: "function of formulas",
            doc: function.doc,
            group: "Formulas",
            params: params.chain(optional).collect(),
            more: function.more,
        }
    }
}

/// What the language offers beside the catalogue of fields.
pub fn words() -> Vec<Word> {
    let constants = math::CONSTANTS.iter().map(|(name, doc, _)| Word {
        name,
        kind: "constant",
        doc,
        group: "Mathematics",
        params: Vec::new(),
        more: false,
    });
    (natives().map(|n| Word::of(n, "function")))
        .chain(constants)
        .chain(formulas::more_functions().map(Word::of_formulas))
        .chain(formulas::namesakes().map(Word::of_formulas))
        .chain(fields::own_methods().map(|n| Word::of(n, "method")))
        .chain([Word::of(&formulas::DISPLACE, "method")])
        .chain(fields::synonymous_methods())
        .chain((materials::METHODS.iter()).map(|n| Word::of(n, "method of a pattern")))
        .chain(
            methods::TEXT
                .iter()
                .map(|n| Word::of(n, "method of a text")),
        )
        .chain(
            methods::LIST
                .iter()
                .map(|n| Word::of(n, "method of a list")),
        )
        .chain(
            methods::DICT
                .iter()
                .map(|n| Word::of(n, "method of a dict")),
        )
        .collect()
}

/// The functions that formulas may call, those of plain numbers among them.
pub fn formula_functions() -> Vec<Word> {
    formulas::all_functions().map(Word::of_formulas).collect()
}
