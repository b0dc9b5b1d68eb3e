//! The text of a function: its statements.

use super::loops::{last_statement, may_leave};
use super::translate::{
    CHOICE, OR, Result, Root, Round, Times, Translator, Writer, atom, blocks, bound, gets_a_name,
};
use naga::{
    Block, Expression as E, Function, Handle, LocalVariable, Span, Statement as S, TypeInner,
};
use std::collections::{HashMap, HashSet};

impl<'m> Translator<'m> {
    /// The parameters and the lines of a function's body.
    pub(super) fn body(
        &mut self,
        handle: Handle<Function>,
        function: &'m Function,
        times: Times,
    ) -> Result<(Vec<String>, Vec<String>)> {
        let mut taken = self.taken.clone();
        let arguments: Vec<String> = (function.arguments.iter())
            .map(|a| Self::free(&mut taken, a.name.as_deref().unwrap_or("x")))
            .collect();
        let mut names = HashMap::new();
        let copied = self.facts[&handle].copied.clone();
        for (v, variable) in function.local_variables.iter() {
            let name = match copied.get(&v) {
                Some(k) => arguments[*k as usize].clone(),
                None => Self::free(&mut taken, variable.name.as_deref().unwrap_or("t")),
            };
            names.insert(v, name);
        }
        let unset = function
            .local_variables
            .iter()
            .filter(|(v, l)| l.init.is_none() && !copied.contains_key(v))
            .map(|(v, _)| v);
        let mut w = Writer {
            handle,
            function,
            times,
            lines: Vec::new(),
            indent: 1,
            names,
            arguments: arguments.clone(),
            taken,
            cache: HashMap::new(),
            pending: Vec::new(),
            alias: HashMap::new(),
            at: 0,
            loops: Vec::new(),
            parts: None,
            unset: unset.collect(),
        };
        for (v, variable) in function.local_variables.iter() {
            if let Some(init) = variable.init {
                let text = self.text(&mut w, init)?;
                let name = w.names[&v].clone();
                w.line(format!("{name} = {}", text.text));
            }
        }
        self.zero_first(&mut w);
        self.block(&mut w, &function.body)?;
        if !matches!(last_statement(&function.body), Some(S::Return { .. })) {
            let outs = self.outs(&w);
            if !outs.is_empty() {
                w.line(format!("return {}", outs.join(", ")));
            }
        }
        if w.lines.is_empty() {
            w.line("pass".into());
        }
        let lines = w
            .lines
            .iter()
            .map(|(indent, line)| format!("{}{line}", "    ".repeat(*indent)))
            .collect();
        Ok((arguments, lines))
    }

    /// Sets variables that may be read before they are set on every way.
    fn zero_first(&mut self, w: &mut Writer<'m>) {
        let function = w.function;
        let mut first: HashMap<Handle<LocalVariable>, bool> = HashMap::new();
        self.first_touch(function, &function.body, &mut first);
        for (v, variable) in function.local_variables.iter() {
            if w.unset.contains(&v) && first.get(&v) == Some(&false) {
                let name = w.names[&v].clone();
                let zero = self.zero(variable.ty);
                w.line(format!("{name} = {zero}"));
                w.unset.remove(&v);
            }
        }
    }

    /// Whether variables are stored as a whole before anything else is done with them, in the block where all of that is done.
    fn first_touch(
        &self,
        function: &Function,
        block: &Block,
        first: &mut HashMap<Handle<LocalVariable>, bool>,
    ) {
        // what inner blocks touch, before this one has stored it
        for statement in block {
            let mut inner = HashMap::new();
            for b in blocks(statement) {
                self.first_touch(function, b, &mut inner);
            }
            let both = match statement {
                // stored on both ways is stored
                S::If { accept, reject, .. } => {
                    let (mut a, mut b) = (HashMap::new(), HashMap::new());
                    self.first_touch(function, accept, &mut a);
                    self.first_touch(function, reject, &mut b);
                    a.into_iter()
                        .filter(|(v, whole)| *whole && b.get(v) == Some(&true))
                        .map(|(v, _)| v)
                        .collect()
                }
                S::Block(_) => inner
                    .iter()
                    .filter(|(_, whole)| **whole)
                    .map(|(v, _)| *v)
                    .collect(),
                _ => HashSet::new(),
            };
            for (v, whole) in inner {
                // a variable of the block alone is set there
                let alone = whole && !self.touched_outside(function, &function.body, statement, v);
                first.entry(v).or_insert(both.contains(&v) || alone);
            }
            match statement {
                S::Emit(range) => {
                    for h in range.clone() {
                        if let E::Load { pointer } = function.expressions[h]
                            && let Some((Root::Local(v), _)) = self.path(function, pointer)
                        {
                            first.entry(v).or_insert(false);
                        }
                    }
                }
                S::Store { pointer, .. } => {
                    if let Some((Root::Local(v), steps)) = self.path(function, *pointer) {
                        // parts that are stored one after the other are put together
                        first.entry(v).or_insert(steps.is_empty());
                    }
                }
                S::Call { arguments, .. } => {
                    for a in arguments {
                        if let Some((Root::Local(v), _)) = self.path(function, *a) {
                            first.entry(v).or_insert(false);
                        }
                    }
                }
                _ => {}
            }
        }
    }

    fn touched_outside(
        &self,
        function: &Function,
        block: &Block,
        except: &S,
        v: Handle<LocalVariable>,
    ) -> bool {
        block.iter().any(|statement| {
            if std::ptr::eq(statement, except) {
                return false;
            }
            let is_it = |pointer: Handle<E>| {
                matches!(self.path(function, pointer), Some((Root::Local(x), _)) if x == v)
            };
            let own = match statement {
                S::Emit(range) => range.clone().any(|h| matches!(function.expressions[h], E::Load { pointer } if is_it(pointer))),
                S::Store { pointer, .. } => is_it(*pointer),
                S::Call { arguments, .. } => arguments.iter().any(|a| is_it(*a)),
                _ => false,
            };
            own || blocks(statement).into_iter().any(|b| self.touched_outside(function, b, except, v))
        })
    }

    /// Names of the arguments that are given back.
    fn outs(&self, w: &Writer<'m>) -> Vec<String> {
        (w.function.arguments.iter().zip(&w.arguments))
            .filter(|(a, _)| self.is_pointer(a.ty))
            .map(|(_, name)| name.clone())
            .collect()
    }

    pub(super) fn block(&mut self, w: &mut Writer<'m>, block: &'m Block) -> Result<()> {
        let all: Vec<(&'m S, &'m Span)> = block.span_iter().collect();
        self.statements(w, &all)
    }

    pub(super) fn statements(
        &mut self,
        w: &mut Writer<'m>,
        all: &[(&'m S, &'m Span)],
    ) -> Result<()> {
        let outer = w.indent;
        for (k, (statement, span)) in all.iter().enumerate() {
            w.at += 1;
            self.statement(w, statement).map_err(|e| e.or_at(**span))?;
            let rest = &all[k + 1..];
            if matches!(statement, S::Return { .. } | S::Break | S::Continue) {
                // what follows is never reached
                w.at += rest
                    .iter()
                    .map(|(s, _)| 1 + blocks(s).into_iter().map(count).sum::<u32>())
                    .sum::<u32>();
                break;
            }
            // what follows a way out by the point happens where it was not taken
            if may_leave(statement)
                && !rest.is_empty()
                && let Some(flag) = w.loops.last().and_then(Round::flag)
            {
                w.line(format!("if {flag}:"));
                w.indent += 1;
                w.parts = None;
            }
        }
        if w.indent > outer && w.lines.last().is_some_and(|(_, line)| line.ends_with(':')) {
            w.line("pass".into());
        }
        w.indent = outer;
        Ok(())
    }

    fn statement(&mut self, w: &mut Writer<'m>, statement: &'m S) -> Result<()> {
        if !matches!(statement, S::Emit(_) | S::Store { .. }) {
            w.parts = None;
        }
        match statement {
            S::Emit(range) => {
                for h in range.clone() {
                    self.emitted(w, h)?;
                }
                Ok(())
            }
            S::Block(inner) => self.block(w, inner),
            S::If {
                condition,
                accept,
                reject,
            } => self.choice(w, *condition, accept, reject),
            S::Loop {
                body,
                continuing,
                break_if,
            } => self.round(w, body, continuing, *break_if),
            S::Store { pointer, value } => {
                let skip = match (
                    &w.function.expressions[*pointer],
                    &w.function.expressions[*value],
                ) {
                    (E::LocalVariable(v), E::FunctionArgument(k)) => {
                        self.facts[&w.handle].copied.get(v) == Some(k)
                    }
                    _ => false,
                };
                if skip {
                    return Ok(());
                }
                let text = self.text(w, *value)?;
                self.store(w, *pointer, text, Some(*value))
            }
            S::Return { value } => {
                let mut parts = Vec::new();
                if let Some(value) = value {
                    parts.push(self.text(w, *value)?.text);
                }
                parts.extend(self.outs(w));
                w.line(if parts.is_empty() {
                    "return None".into()
                } else {
                    format!("return {}", parts.join(", "))
                });
                Ok(())
            }
            S::Call {
                function,
                arguments,
                result,
            } => self.call(w, *function, arguments, *result),
            S::Break => {
                let Some(round) = w.loops.last() else {
                    return Ok(());
                };
                match (&round.running, &round.here) {
                    (None, _) => w.line("break".into()),
                    (Some(running), here) => {
                        let both = here
                            .iter()
                            .chain([running])
                            .map(|f| format!("{f} = False"))
                            .collect::<Vec<_>>();
                        both.into_iter().for_each(|line| w.line(line));
                    }
                }
                Ok(())
            }
            S::Continue => {
                let Some(round) = w.loops.last() else {
                    return Ok(());
                };
                match &round.here {
                    None => w.line("continue".into()),
                    Some(here) => w.line(format!("{here} = False")),
                }
                Ok(())
            }
            S::Switch { .. } => self.refuse(
                Span::UNDEFINED,
                "`switch` is not translated",
                "write `if` and `else if`",
            ),
            S::Kill => self.refuse(
                Span::UNDEFINED,
                "`discard` has no meaning for a distance",
                "leave it out",
            ),
            _ => self.refuse(
                Span::UNDEFINED,
                "this statement is not translated",
                "a distance follows from arithmetic alone",
            ),
        }
    }

    /// The variables that the text of an expression reads.
    pub(super) fn reads(&self, w: &Writer<'m>, h: Handle<E>) -> HashSet<Root> {
        let mut found = HashSet::new();
        let mut open = vec![h];
        while let Some(h) = open.pop() {
            if let Some((_, roots)) = w.pending.iter().find(|(p, _)| *p == h) {
                found.extend(roots.iter().copied());
            } else if !w.cache.contains_key(&h) {
                if let E::Load { pointer } = w.function.expressions[h] {
                    found.extend(self.path(w.function, pointer).map(|(root, _)| root));
                }
                open.extend(self.operands(w.function, h));
            }
        }
        found
    }

    pub(super) fn emitted(&mut self, w: &mut Writer<'m>, h: Handle<E>) -> Result<()> {
        let facts = &self.facts[&w.handle];
        let (uses, inner) = (facts.uses[h.index()], &facts.inner[h.index()]);
        if uses == 0
            || matches!(
                inner,
                TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }
            )
        {
            return Ok(());
        }
        if let E::Load { pointer } = w.function.expressions[h] {
            if let Some((root, steps)) = self.path(w.function, pointer) {
                let aliased = match root {
                    Root::Local(v) => w.alias.get(&v).cloned(),
                    _ => None,
                };
                let mut roots = HashSet::from([root]);
                if let (Some((text, of)), true) = (aliased, steps.is_empty()) {
                    w.cache.insert(h, text);
                    roots = of;
                }
                w.pending.push((h, roots));
            }
            return Ok(());
        }
        if uses > 1 && gets_a_name(&w.function.expressions[h]) {
            let text = self.text(w, h)?;
            let name = w.fresh("t");
            w.line(format!("{name} = {}", text.text));
            w.cache.insert(h, atom(name));
        }
        Ok(())
    }

    /// Gives names to what was read before a variable is stored and is needed after it.
    pub(super) fn settle(
        &mut self,
        w: &mut Writer<'m>,
        stored: &HashSet<Root>,
        after: u32,
    ) -> Result<()> {
        let last = |h: Handle<E>| self.facts[&w.handle].last[h.index()];
        let old: Vec<Handle<E>> = (w.pending.iter())
            .filter(|(h, roots)| last(*h) > after && !roots.is_disjoint(stored))
            .map(|(h, _)| *h)
            .collect();
        for h in old {
            let text = self.text(w, h)?;
            let name = w.fresh("before");
            w.line(format!("{name} = {}", text.text));
            w.cache.insert(h, atom(name));
            w.pending.retain(|(p, _)| *p != h);
        }
        // what is read from here on is what is stored
        w.pending.retain(|(_, roots)| roots.is_disjoint(stored));
        Ok(())
    }

    pub(super) fn stored_in(&self, function: &Function, block: &Block, found: &mut HashSet<Root>) {
        for statement in block {
            match statement {
                S::Store { pointer, .. } => {
                    found.extend(self.path(function, *pointer).map(|(root, _)| root))
                }
                S::Call { arguments, .. } => {
                    let pointers = arguments.iter().filter_map(|a| self.path(function, *a));
                    found.extend(pointers.map(|(root, _)| root));
                }
                _ => {}
            }
            for inner in blocks(statement) {
                self.stored_in(function, inner, found);
            }
        }
    }

    fn choice(
        &mut self,
        w: &mut Writer<'m>,
        condition: Handle<E>,
        accept: &'m Block,
        reject: &'m Block,
    ) -> Result<()> {
        // a choice of values: a ? b : c, into a variable of the front end's own
        let only = |block: &'m Block| match block
            .iter()
            .filter(|s| !matches!(s, S::Emit(_)))
            .collect::<Vec<_>>()[..]
        {
            [S::Store { pointer, value }] => match w.function.expressions[*pointer] {
                E::LocalVariable(v) if w.function.local_variables[v].name.is_none() => {
                    Some((v, *value))
                }
                _ => None,
            },
            _ => None,
        };
        if let (Some((v, yes)), Some((same, no))) = (only(accept), only(reject))
            && v == same
        {
            let asked = self.text(w, condition)?;
            let mut texts = Vec::new();
            for (block, value) in [(accept, yes), (reject, no)] {
                for statement in block {
                    w.at += 1;
                    if let S::Emit(range) = statement {
                        for h in range.clone() {
                            self.emitted(w, h)?;
                        }
                    }
                }
                texts.push(self.text(w, value)?);
            }
            let mut reads = self.reads(w, condition);
            reads.extend(self.reads(w, yes));
            reads.extend(self.reads(w, no));
            let text = format!(
                "{} if {} else {}",
                texts[0].within(OR),
                asked.within(OR),
                texts[1].within(CHOICE)
            );
            w.unset.remove(&v);
            w.alias.insert(v, (bound(text, CHOICE), reads));
            return Ok(());
        }
        let mut stored = HashSet::new();
        self.stored_in(w.function, accept, &mut stored);
        self.stored_in(w.function, reject, &mut stored);
        let at = w.at;
        self.settle(w, &stored, at)?;
        let asked = self.text(w, condition)?;
        w.line(format!("if {}:", asked.text));
        self.inner(w, accept)?;
        if reject.iter().any(|s| !matches!(s, S::Emit(_))) {
            let from = w.lines.len();
            w.line("else:".into());
            self.inner(w, reject)?;
            // else: if ... becomes elif
            let indent = w.indent;
            let alone = w.lines[from + 1..].iter().skip(1).all(|(i, l)| {
                *i > indent + 1 || (*i == indent + 1 && (l == "else:" || l.starts_with("elif ")))
            });
            if w.lines
                .get(from + 1)
                .is_some_and(|(_, l)| l.starts_with("if "))
                && alone
            {
                w.lines.remove(from);
                for (k, (i, line)) in w.lines[from..].iter_mut().enumerate() {
                    *i -= 1;
                    if k == 0 {
                        line.insert_str(0, "el");
                    }
                }
            }
        } else {
            w.at += count(reject);
        }
        Ok(())
    }
}

/// How many statements there are in a block, with those in its blocks.
pub(super) fn count(block: &Block) -> u32 {
    block
        .iter()
        .map(|s| 1 + blocks(s).into_iter().map(count).sum::<u32>())
        .sum()
}
