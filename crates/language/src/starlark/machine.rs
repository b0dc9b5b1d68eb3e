//! The interpreter's state: values, variables, and the budget that every step is charged to.

use super::depth::Depth;
use super::mistake::{Run, mistake};
use super::module::Module;
use super::scope::Locals;
use super::value::{Dict, DictKey, List, Method, Range, Store, Thing, Value};
use crate::draft::Draft;
use crate::limits::Limits;
use crate::report::Place;
use starlark_syntax::codemap::Span;
use starlark_syntax::syntax::ast::{AstExpr, AstStmt};
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;
use zeroset_field::formula::Expression;

/// Steps between two looks at the clock.
const CLOCK: u64 = 1024;
/// Longest text that a script may make, in bytes.
pub(crate) const MAX_TEXT: usize = 1 << 20;

/// A function of the script.
pub(crate) struct Function<'a> {
    pub(crate) name: &'a str,
    pub(crate) params: Vec<Param<'a>>,
    pub(crate) body: Body<'a>,
    pub(crate) locals: Locals<'a>,
    pub(crate) module: u32,
    /// The variables around it.
    pub(crate) frame: Option<u32>,
}

/// What a function does.
#[derive(Clone, Copy)]
pub(crate) enum Body<'a> {
    Block(&'a AstStmt),
    Expression(&'a AstExpr),
}

/// A parameter of a function of the script.
pub(crate) struct Param<'a> {
    pub(crate) name: &'a str,
    pub(crate) kind: ParamKind,
    pub(crate) default: Option<Value>,
}

/// How a parameter is given.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ParamKind {
    /// By place or by name.
    Normal,
    /// By name only.
    Named,
    /// `*args`.
    Rest,
    /// `**kwargs`.
    RestNamed,
}

/// The variables of a running function or comprehension.
pub(crate) struct Variables<'a> {
    pub(crate) names: Locals<'a>,
    pub(crate) values: Vec<Option<Value>>,
    pub(crate) parent: Option<u32>,
    /// Whether a function that was made in it may outlive it.
    pub(crate) captured: bool,
}

/// Runs scripts.
pub(crate) struct Machine<'a> {
    pub(crate) store: Store,
    /// What the script declares: objects, lights, parameters.
    pub(crate) draft: Draft,
    pub(crate) limits: Limits,
    pub(crate) modules: &'a [Module],
    pub(crate) globals: Vec<HashMap<&'a str, Value>>,
    pub(crate) builtins: &'static HashMap<&'static str, Value>,
    pub(crate) functions: Vec<Function<'a>>,
    pub(crate) frames: Vec<Variables<'a>>,
    pub(crate) frame: Option<u32>,
    pub(crate) module: u32,
    pub(crate) calls: u64,
    pub(crate) depth: Depth,
    /// What running functions give back where a condition on the point holds.
    pub(crate) pending: Vec<(Expression, Value)>,
    /// Branches around that a condition on the point decides.
    pub(crate) branches: u32,
    /// The variables of functions and comprehensions, by where they are in the syntax tree.
    locals: HashMap<usize, Locals<'a>>,
    ticks: u64,
    heap: u64,
    nodes: u64,
    next_clock: u64,
    start: Instant,
}

impl<'a> Machine<'a> {
    pub(crate) fn new(modules: &'a [Module], draft: Draft, limits: Limits, start: Instant) -> Self {
        Machine {
            store: Store::default(),
            draft,
            limits,
            modules,
            globals: modules.iter().map(|_| HashMap::new()).collect(),
            builtins: super::builtins(),
            functions: Vec::new(),
            frames: Vec::new(),
            frame: None,
            module: 0,
            calls: 0,
            depth: Depth::new(),
            pending: Vec::new(),
            branches: 0,
            locals: HashMap::new(),
            ticks: 0,
            heap: 0,
            nodes: 0,
            next_clock: 0,
            start,
        }
    }

    /// The place of a piece of the running module.
    pub(crate) fn place(&self, span: Span) -> Place {
        let file = self.modules[self.module as usize].file;
        Place {
            file,
            start: span.begin().get(),
            end: span.end().get(),
        }
    }

    /// Runs `work` so many levels deeper.
    #[inline]
    pub(crate) fn deeper<T>(
        &mut self,
        levels: u32,
        work: impl FnOnce(&mut Self) -> Run<T>,
    ) -> Run<T> {
        let result = self.depth.enter(levels).and_then(|()| work(self));
        self.depth.leave(levels);
        result
    }

    /// The variables of a piece of the syntax tree, found once: it may be run very often.
    pub(crate) fn locals_of<T>(
        &mut self,
        piece: &'a T,
        find: impl FnOnce() -> Locals<'a>,
    ) -> Locals<'a> {
        let place = std::ptr::from_ref(piece).addr();
        Rc::clone(self.locals.entry(place).or_insert_with(find))
    }

    /// Python's truth.
    pub(crate) fn truth(&self, value: Value) -> Run<bool> {
        match value {
            Value::Thing(i) if matches!(self.store.thing(i), Thing::Expression(_)) => {
                Err(super::formulas::undecided())
            }
            Value::Thing(i) if matches!(self.store.thing(i), Thing::Condition(_)) => {
                Err(super::formulas::conditional())
            }
            _ => Ok(self.store.is_true(value)),
        }
    }

    /// Leaves time out of what the script may take, as that of sampling, which has a limit of its own.
    pub(crate) fn pause(&mut self, time: Duration) {
        self.start += time;
    }

    /// Charges steps, before they are taken.
    #[inline]
    pub(crate) fn charge(&mut self, steps: u64) -> Run<()> {
        self.ticks = self.ticks.saturating_add(steps);
        if self.ticks >= self.next_clock {
            self.check()
        } else {
            Ok(())
        }
    }

    #[cold]
    fn check(&mut self) -> Run<()> {
        if self.ticks > self.limits.ticks {
            let message = format!("the script takes more than {} steps", self.limits.ticks);
            return Err(
                mistake(message).help("make fewer or smaller loops, or raise the limit `ticks`")
            );
        }
        if self.start.elapsed() > Duration::from_secs_f64(self.limits.seconds) {
            let message = format!(
                "the script takes longer than {} seconds",
                self.limits.seconds
            );
            return Err(
                mistake(message).help("make fewer or smaller loops, or raise the limit `seconds`")
            );
        }
        self.next_clock = (self.ticks + CLOCK).min(self.limits.ticks + 1);
        Ok(())
    }

    /// Charges bytes, before they are allocated.
    pub(crate) fn grow(&mut self, bytes: usize) -> Run<()> {
        self.heap = self.heap.saturating_add(bytes as u64);
        if self.heap > self.limits.heap {
            let message = format!(
                "the script makes more than {} MiB of values",
                self.limits.heap >> 20
            );
            return Err(mistake(message)
                .help("make fewer or smaller lists and texts, or raise the limit `heap`"));
        }
        Ok(())
    }

    /// Charges a copy of `count` values.
    pub(crate) fn grow_items(&mut self, count: usize) -> Run<()> {
        self.charge(count as u64)?;
        self.grow(count.saturating_mul(size_of::<Value>()))
    }

    /// Charges a node of a field.
    pub(crate) fn grow_field(&mut self, numbers: usize) -> Run<()> {
        self.nodes += 1;
        if self.nodes > self.limits.nodes {
            let message = format!("the scene makes more than {} fields", self.limits.nodes);
            return Err(mistake(message).help(
                "use .repeat(...) or .polar(...) for many copies, or raise the limit `nodes`",
            ));
        }
        self.charge(8)?;
        self.grow(256 + 8 * numbers)
    }

    /// A text, whose bytes are charged.
    pub(crate) fn text(&mut self, text: impl Into<Arc<str>> + AsRef<str>) -> Run<Value> {
        let length = text.as_ref().len();
        if length > MAX_TEXT {
            return Err(mistake(format!("a text may have at most {MAX_TEXT} bytes")));
        }
        self.charge(length as u64 / 16)?;
        self.grow(length + 32)?;
        Ok(Value::Text(push(&mut self.store.texts, text.into())))
    }

    /// A list of items that were charged by [`Self::grow_items`].
    pub(crate) fn list(&mut self, items: Vec<Value>) -> Run<Value> {
        self.grow(size_of::<List>())?;
        Ok(Value::List(push(
            &mut self.store.lists,
            List { items, loops: 0 },
        )))
    }

    /// A tuple of items that were charged by [`Self::grow_items`].
    pub(crate) fn tuple(&mut self, items: Vec<Value>) -> Run<Value> {
        self.grow(size_of::<Box<[Value]>>())?;
        Ok(Value::Tuple(push(&mut self.store.tuples, items.into())))
    }

    /// An empty dict.
    pub(crate) fn dict(&mut self) -> Run<u32> {
        self.grow(size_of::<Dict>())?;
        Ok(push(&mut self.store.dicts, Dict::default()))
    }

    /// Adds a pair to a dict or changes it.
    pub(crate) fn insert(&mut self, dict: u32, key: Value, value: Value) -> Run<()> {
        let content = self.key(key, 0)?;
        if self.store.dict(dict).loops > 0 {
            return Err(mistake("a dict cannot change while a loop runs over it")
                .help("loop over list(d) instead"));
        }
        self.grow(96)?;
        self.store
            .dict_mut(dict)
            .pairs
            .insert(content, (key, value));
        Ok(())
    }

    /// A value by its content.
    pub(crate) fn key(&mut self, value: Value, depth: u32) -> Run<DictKey> {
        self.charge(1)?;
        if depth > 16 {
            return Err(mistake("a key of a dict is nested too deeply"));
        }
        Ok(match value {
            Value::None => DictKey::None,
            Value::Bool(b) => DictKey::Bool(b),
            Value::Int(i) => DictKey::Int(i),
            // a whole float is the same key as the whole number, as they are equal
            Value::Float(x) if x.fract() == 0.0 && x.abs() < 9e15 => DictKey::Int(x as i64),
            Value::Float(x) => DictKey::Float(x.to_bits()),
            Value::Text(i) => {
                self.charge(self.store.text(i).len() as u64 / 16)?;
                DictKey::Text(self.store.text(i).clone())
            }
            Value::Tuple(i) => {
                let length = self.store.tuple(i).len();
                self.grow(length * size_of::<DictKey>())?;
                let items = (0..length).map(|k| self.key(self.store.tuple(i)[k], depth + 1));
                DictKey::Tuple(items.collect::<Run<Vec<DictKey>>>()?)
            }
            other => {
                let kind = self.store.kind(other);
                return Err(mistake(format!("{kind} cannot be a key of a dict"))
                    .help("keys are texts, numbers, truth values, None and tuples of these"));
            }
        })
    }

    pub(crate) fn range(&mut self, range: Range) -> Run<Value> {
        self.grow(size_of::<Range>())?;
        Ok(Value::Range(push(&mut self.store.ranges, range)))
    }

    pub(crate) fn thing(&mut self, thing: Thing) -> Run<Value> {
        self.grow(size_of::<Thing>())?;
        Ok(self.charged_thing(thing))
    }

    /// As [`Self::thing`], of what was charged already.
    pub(crate) fn charged_thing(&mut self, thing: Thing) -> Value {
        Value::Thing(push(&mut self.store.things, thing))
    }

    pub(crate) fn bound(
        &mut self,
        receiver: Value,
        name: &'static str,
        method: Method,
    ) -> Run<Value> {
        self.grow(size_of::<(Value, &str, Method)>())?;
        Ok(Value::Bound(push(
            &mut self.store.bound,
            (receiver, name, method),
        )))
    }

    pub(crate) fn function(&mut self, function: Function<'a>) -> Run<Value> {
        self.grow(size_of::<Function<'a>>() + function.params.len() * size_of::<Param<'a>>())?;
        let mut frame = self.frame;
        while let Some(i) = frame {
            let f = &mut self.frames[i as usize];
            if f.captured {
                break;
            }
            f.captured = true;
            frame = f.parent;
            let bytes = size_of::<Variables<'a>>() + f.values.len() * size_of::<Option<Value>>();
            self.grow(bytes)?;
        }
        Ok(Value::Function(push(&mut self.functions, function)))
    }

    /// Runs `work` with the variables of a new frame, which ends with it unless something captured it.
    pub(crate) fn in_frame<T>(
        &mut self,
        names: Locals<'a>,
        values: Vec<Option<Value>>,
        parent: Option<u32>,
        work: impl FnOnce(&mut Self) -> Run<T>,
    ) -> Run<T> {
        let outer = self.frame;
        let mine = push(
            &mut self.frames,
            Variables {
                names,
                values,
                parent,
                captured: false,
            },
        );
        self.frame = Some(mine);
        let result = work(self);
        self.frame = outer;
        if self.frames.len() == mine as usize + 1 && !self.frames[mine as usize].captured {
            self.frames.pop();
        }
        result
    }
}

/// Appends and gives the place. A store cannot reach 2^32 values: each is charged to the heap limit.
fn push<T>(list: &mut Vec<T>, item: T) -> u32 {
    list.push(item);
    (list.len() - 1) as u32
}
