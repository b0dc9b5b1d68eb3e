//! The text of calls, and of what is stored where.

use super::translate::{Parts, Result, Root, SUM, Step, Text, Time, Translator, Writer, atom};
use naga::{Expression as E, Function, Handle, Span, Type, TypeInner};
use std::collections::HashSet;

/// The letters of parts.
const LETTERS: [&str; 4] = ["x", "y", "z", "w"];

impl<'m> Translator<'m> {
    pub(super) fn call(
        &mut self,
        w: &mut Writer<'m>,
        called: Handle<Function>,
        arguments: &'m [Handle<E>],
        result: Option<Handle<E>>,
    ) -> Result<()> {
        let given: Vec<Time> = arguments
            .iter()
            .map(|a| w.times.expressions[a.index()])
            .collect();
        let given: Vec<Time> = given
            .into_iter()
            .map(|t| if t == Time::Unset { Time::Plain } else { t })
            .collect();
        let name = self.function(called, &given)?;
        let callee = &self.module.functions[called];
        let mut texts = Vec::new();
        let mut reads = HashSet::new();
        let mut outs = Vec::new();
        for (argument, parameter) in arguments.iter().zip(&callee.arguments) {
            if self.is_pointer(parameter.ty) {
                outs.push(*argument);
                texts.push(self.pointed(w, *argument)?.text);
            } else {
                texts.push(self.text(w, *argument)?.text);
                reads.extend(self.reads(w, *argument));
            }
        }
        let text = format!("{name}({})", texts.join(", "));
        if outs.is_empty() {
            let Some(result) = result else { return Ok(()) };
            let facts = &self.facts[&w.handle];
            match facts.uses[result.index()] {
                // it gives nothing back that is needed, and does nothing else
                0 => {}
                1 => {
                    w.cache.insert(result, atom(text));
                    w.pending.push((result, reads));
                }
                _ => {
                    let name = w.fresh("t");
                    w.line(format!("{name} = {text}"));
                    w.cache.insert(result, atom(name));
                }
            }
            return Ok(());
        }
        let stored: HashSet<Root> = outs
            .iter()
            .filter_map(|h| self.path(w.function, *h))
            .map(|(root, _)| root)
            .collect();
        let at = w.at;
        self.settle(w, &stored, at)?;
        let mut targets = Vec::new();
        if let Some(result) = result {
            let name = w.fresh("t");
            w.cache.insert(result, atom(name.clone()));
            targets.push(name);
        }
        let mut later = Vec::new();
        for out in outs {
            match self.path(w.function, out) {
                Some((Root::Local(v), steps)) if steps.is_empty() => {
                    w.unset.remove(&v);
                    targets.push(w.names[&v].clone());
                }
                Some((Root::Argument(k), steps)) if steps.is_empty() => {
                    targets.push(w.arguments[k as usize].clone())
                }
                _ => {
                    let name = w.fresh("t");
                    targets.push(name.clone());
                    later.push((out, name));
                }
            }
        }
        w.line(format!("{} = {text}", targets.join(", ")));
        for (out, name) in later {
            self.store(w, out, atom(name), None)?;
        }
        Ok(())
    }

    /// `pointer = value`.
    pub(super) fn store(
        &mut self,
        w: &mut Writer<'m>,
        pointer: Handle<E>,
        value: Text,
        from: Option<Handle<E>>,
    ) -> Result<()> {
        let function = w.function;
        let Some((root, steps)) = self.path(function, pointer) else {
            return self.refuse(
                function.expressions.get_span(pointer),
                "this cannot be stored to",
                "store to a variable",
            );
        };
        let (name, ty) = match root {
            Root::Local(v) => (w.names[&v].clone(), function.local_variables[v].ty),
            Root::Argument(k) => (
                w.arguments[k as usize].clone(),
                self.base_of(function.arguments[k as usize].ty),
            ),
            Root::Global(g) => {
                if self.ignored.contains(&g) {
                    return Ok(());
                }
                let name = self.module.global_variables[g]
                    .name
                    .clone()
                    .unwrap_or_default();
                return self.refuse(
                    Span::UNDEFINED,
                    format!("`{name}` is a variable of the whole shader that is set here and read by what gives the distance"),
                    "hand it to the functions as an argument",
                );
            }
        };
        let reads = from.map(|h| self.reads(w, h)).unwrap_or_default();
        let stored = HashSet::from([root]);
        let at = w.at;
        let lines = w.lines.len();
        self.settle(w, &stored, at)?;
        if w.lines.len() != lines {
            w.parts = None;
        }
        let unset = match root {
            Root::Local(v) => w.unset.remove(&v),
            _ => false,
        };
        if steps.is_empty() {
            w.parts = None;
            w.line(format!("{name} = {}", value.text));
            return Ok(());
        }
        // one part of a vector: several, one after the other, become one line
        if let ([Step::Index(k)], TypeInner::Vector { size, .. }) =
            (&steps[..], &self.module.types[ty].inner)
        {
            let n = *size as usize;
            let time = match root {
                Root::Local(v) => w.times.variables[v.index()],
                Root::Argument(k) => w.times.arguments[k as usize],
                Root::Global(_) => Time::Plain,
            };
            let mut texts = vec![None; n];
            let mut is_fresh = unset;
            if let Some(known) = w.parts.take()
                && known.root == root
                && !reads.contains(&root)
                && known.line + 1 == w.lines.len()
            {
                is_fresh = known.is_fresh;
                texts = known.texts;
                w.lines.pop();
            }
            texts[*k as usize] = Some(value.text);
            let all: Vec<String> = (texts.iter().enumerate())
                .map(|(k, text)| match text {
                    Some(text) => text.clone(),
                    None if is_fresh => "0.0".into(),
                    None => part(&name, k, time),
                })
                .collect();
            w.line(format!("{name} = vec{n}({})", all.join(", ")));
            w.parts = Some(Parts {
                root,
                texts,
                is_fresh,
                line: w.lines.len() - 1,
            });
            return Ok(());
        }
        w.parts = None;
        let time = match root {
            Root::Local(v) => w.times.variables[v.index()],
            Root::Argument(k) => w.times.arguments[k as usize],
            Root::Global(_) => Time::Plain,
        };
        let text = self.rebuilt(
            w,
            atom(name.clone()),
            &self.module.types[ty].inner.clone(),
            time,
            &steps,
            &value,
        )?;
        w.line(format!("{name} = {text}"));
        Ok(())
    }

    /// A value with another value in a part of it.
    fn rebuilt(
        &mut self,
        w: &mut Writer<'m>,
        base: Text,
        ty: &TypeInner,
        time: Time,
        steps: &[Step],
        value: &Text,
    ) -> Result<String> {
        let Some((first, rest)) = steps.split_first() else {
            return Ok(value.text.clone());
        };
        let n = match ty {
            TypeInner::Vector { size, .. } => *size as usize,
            TypeInner::Matrix { columns, .. } => *columns as usize,
            TypeInner::Array {
                size: naga::ArraySize::Constant(n),
                ..
            } => n.get() as usize,
            TypeInner::Struct { members, .. } => members.len(),
            _ => {
                return self.refuse(
                    Span::UNDEFINED,
                    "a part of this cannot be stored",
                    "store the whole of it",
                );
            }
        };
        let mut texts = Vec::new();
        for k in 0..n {
            let old = match ty {
                TypeInner::Vector { .. } => part(&base.text, k, time),
                _ => format!("{}[{k}]", base.text),
            };
            let inner = self.inside(ty, k);
            let new = |s: &mut Self, w: &mut Writer<'m>| {
                s.rebuilt(w, atom(old.clone()), &inner, time, rest, value)
            };
            texts.push(match first {
                Step::Index(i) if *i as usize == k => new(self, w)?,
                Step::Index(_) => old,
                Step::Dynamic(index) => {
                    let at = self.text(w, *index)?.within(SUM);
                    let changed = new(self, w)?;
                    format!("({changed} if {at} == {k} else {old})")
                }
            });
        }
        Ok(match ty {
            TypeInner::Vector { .. } => format!("vec{n}({})", texts.join(", ")),
            TypeInner::Array { .. } => format!("[{}]", texts.join(", ")),
            _ => tuple(&texts),
        })
    }

    /// The type of the part of a value.
    fn inside(&self, ty: &TypeInner, k: usize) -> TypeInner {
        match ty {
            TypeInner::Vector { scalar, .. } => TypeInner::Scalar(*scalar),
            TypeInner::Matrix { rows, scalar, .. } => TypeInner::Vector {
                size: *rows,
                scalar: *scalar,
            },
            TypeInner::Array { base, .. } => self.module.types[*base].inner.clone(),
            TypeInner::Struct { members, .. } => members
                .get(k)
                .map_or(ty.clone(), |m| self.module.types[m.ty].inner.clone()),
            other => other.clone(),
        }
    }

    fn base_of(&self, ty: Handle<Type>) -> Handle<Type> {
        match self.module.types[ty].inner {
            TypeInner::Pointer { base, .. } => base,
            _ => ty,
        }
    }

    /// What a pointer points at.
    pub(super) fn pointed(&mut self, w: &mut Writer<'m>, pointer: Handle<E>) -> Result<Text> {
        let function = w.function;
        let Some((root, steps)) = self.path(function, pointer) else {
            return self.refuse(
                function.expressions.get_span(pointer),
                "this cannot be read",
                "read a variable",
            );
        };
        let (name, ty, time) = match root {
            Root::Local(v) => {
                let ty = function.local_variables[v].ty;
                if w.unset.contains(&v) {
                    // never stored: zero
                    w.unset.remove(&v);
                    let zero = self.zero(ty);
                    let name = w.names[&v].clone();
                    w.line(format!("{name} = {zero}"));
                }
                (w.names[&v].clone(), ty, w.times.variables[v.index()])
            }
            Root::Argument(k) => {
                let k = k as usize;
                (
                    w.arguments[k].clone(),
                    self.base_of(function.arguments[k].ty),
                    w.times.arguments[k],
                )
            }
            Root::Global(g) => (
                self.global(g)?,
                self.module.global_variables[g].ty,
                Time::Plain,
            ),
        };
        let (mut text, mut inner) = (name, self.module.types[ty].inner.clone());
        for step in steps {
            let is_vector = matches!(inner, TypeInner::Vector { .. });
            match step {
                Step::Index(k) if is_vector => text = part(&text, k as usize, time),
                Step::Index(k) => text = format!("{text}[{k}]"),
                Step::Dynamic(index) => text = format!("{text}[{}]", self.index(w, index)?),
            }
            inner = self.inside(
                &inner,
                if let Step::Index(k) = step {
                    k as usize
                } else {
                    0
                },
            );
        }
        Ok(atom(text))
    }

    pub(super) fn index(&mut self, w: &mut Writer<'m>, index: Handle<E>) -> Result<String> {
        if w.times.expressions[index.index()] != Time::Plain {
            return self.refuse(
                w.function.expressions.get_span(index),
                "which item is meant depends on the point",
                "an index must be the same for all points: a number or the variable of a loop",
            );
        }
        Ok(self.text(w, index)?.text)
    }
}

/// A part of a vector: its name needs a value of the formula.
pub(super) fn part(text: &str, k: usize, time: Time) -> String {
    match time {
        Time::Formula => format!("{text}.{}", LETTERS[k.min(3)]),
        _ => format!("{text}[{k}]"),
    }
}

pub(super) fn tuple(texts: &[String]) -> String {
    match texts {
        [one] => format!("({one},)"),
        _ => format!("({})", texts.join(", ")),
    }
}
