//! The text of a function: statements and expressions.

use super::translate::{
    AND, CHOICE, OR, Parts, Result, Root, Round, SUM, Step, Text, Time, Times, Translator, Writer,
    atom, blocks, bound, gets_a_name,
};
use naga::{
    BinaryOperator, Block, Expression as E, Function, Handle, Literal, LocalVariable, ScalarKind,
    Span, Statement as S, Type, TypeInner, UnaryOperator,
};
use std::collections::{HashMap, HashSet};

/// The letters of parts.
const LETTERS: [&str; 4] = ["x", "y", "z", "w"];

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

    fn block(&mut self, w: &mut Writer<'m>, block: &'m Block) -> Result<()> {
        let all: Vec<(&'m S, &'m Span)> = block.span_iter().collect();
        self.statements(w, &all)
    }

    fn statements(&mut self, w: &mut Writer<'m>, all: &[(&'m S, &'m Span)]) -> Result<()> {
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

    fn emitted(&mut self, w: &mut Writer<'m>, h: Handle<E>) -> Result<()> {
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
    fn settle(&mut self, w: &mut Writer<'m>, stored: &HashSet<Root>, after: u32) -> Result<()> {
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

    fn stored_in(&self, function: &Function, block: &Block, found: &mut HashSet<Root>) {
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

    fn inner(&mut self, w: &mut Writer<'m>, block: &'m Block) -> Result<()> {
        w.parts = None;
        w.indent += 1;
        let before = w.lines.len();
        self.block(w, block)?;
        if w.lines.len() == before {
            w.line("pass".into());
        }
        w.indent -= 1;
        w.parts = None;
        Ok(())
    }

    fn round(
        &mut self,
        w: &mut Writer<'m>,
        body: &'m Block,
        continuing: &'m Block,
        break_if: Option<Handle<E>>,
    ) -> Result<()> {
        let function = w.function;
        if let Some(h) = break_if {
            let span = function.expressions.get_span(h);
            return self.refuse(
                span,
                "`do` loops are not translated",
                "write a `for` loop with a fixed count",
            );
        }
        let mut stored = HashSet::new();
        self.stored_in(function, body, &mut stored);
        self.stored_in(function, continuing, &mut stored);
        let at = w.at;
        self.settle(w, &stored, at)?;
        let all: Vec<(&'m S, &'m Span)> = body.span_iter().collect();
        // the condition stands at the beginning
        let head = all.iter().position(|(s, _)| !matches!(s, S::Emit(_)));
        let condition = head.and_then(|k| match all[k].0 {
            S::If {
                condition, accept, ..
            } if matches!(accept.iter().collect::<Vec<_>>()[..], [S::Break]) => {
                match function.expressions[*condition] {
                    E::Unary {
                        op: UnaryOperator::LogicalNot,
                        expr,
                    } => Some((k, expr)),
                    _ => None,
                }
            }
            _ => None,
        });
        let Some((head, condition)) = condition else {
            return self.refuse(
                Span::UNDEFINED,
                "a loop whose end cannot be told",
                "write a `for` loop with a fixed count",
            );
        };
        // i < n && length(z) < 2.0: the first part counts, the second one ends it early
        let mut parts = vec![condition];
        let is_both = |h: &Handle<E>| {
            matches!(
                function.expressions[*h],
                E::Binary {
                    op: BinaryOperator::LogicalAnd,
                    ..
                }
            )
        };
        while let Some(k) = parts.iter().position(is_both) {
            if let E::Binary { left, right, .. } = function.expressions[parts[k]] {
                parts.splice(k..=k, [left, right]);
            }
        }
        let plain: Vec<bool> = w
            .times
            .expressions
            .iter()
            .map(|t| *t == Time::Plain)
            .collect();
        let (counts, early): (Vec<_>, Vec<_>) = parts.into_iter().partition(|h| plain[h.index()]);
        if counts.is_empty() {
            let span = function.expressions.get_span(condition);
            return self.refuse(
                span,
                "how often this loop runs depends on the point",
                "a `for` loop needs a count that is the same everywhere; a `break` in it may depend on the point",
            );
        }
        let rest = &all[head + 1..];
        let leaves = rest.iter().fold(Leaves::default(), |sum, (s, _)| {
            sum.and(leaves(s, false, &plain))
        });
        let by_point = leaves.by_point || !early.is_empty();
        let end = at + count(body) + count(continuing);
        let counted = match &counts[..] {
            [one] => self.counted(w, *one, body, continuing, end)?,
            _ => None,
        };
        let running = by_point.then(|| w.fresh("running"));
        let here = (leaves.next && (by_point || counted.is_none())).then(|| w.fresh("here"));
        if let Some(flag) = &running {
            w.line(format!("{flag} = True"));
        }
        let is_counted = counted.is_some();
        match counted {
            Some(header) => {
                w.line(header);
                w.indent += 1;
                self.head(w, &all[..head])?;
            }
            None => {
                let name = w.fresh("k");
                w.line(format!(
                    "for {name} in range({}):",
                    super::translate::MOST_ROUNDS
                ));
                w.indent += 1;
                self.head(w, &all[..head])?;
                let asked = self.all_of(w, &counts)?;
                w.line(format!("if not ({asked}):"));
                w.indent += 1;
                w.line("break".into());
                w.indent -= 1;
            }
        }
        let outer = w.indent;
        if let Some(flag) = &running {
            if !early.is_empty() {
                let asked = self.all_of(w, &early)?;
                w.line(format!("{flag} = {flag} and {asked}"));
            }
            w.line(format!("if {flag}:"));
            w.indent += 1;
        }
        if let Some(flag) = &here {
            w.line(format!("{flag} = True"));
        }
        w.loops.push(Round {
            running: running.clone(),
            here,
        });
        w.parts = None;
        self.statements(w, rest)?;
        w.loops.pop();
        if w.lines.last().is_some_and(|(_, line)| line.ends_with(':')) {
            w.line("pass".into());
        }
        w.indent = outer;
        if is_counted {
            w.at += count(continuing);
        } else {
            let mut counts = HashSet::new();
            self.stored_in(function, continuing, &mut counts);
            let is_read = |root: &Root| {
                self.facts[&w.handle]
                    .last_read
                    .get(root)
                    .is_some_and(|last| *last > end)
            };
            if running.is_some() && counts.iter().any(is_read) {
                let span = function.expressions.get_span(condition);
                return self.refuse(
                    span,
                    "how far this loop counted is needed after it, and that depends on the point",
                    "count in a variable of its own: n += 1.0 in the loop's body",
                );
            }
            self.block(w, continuing)?;
        }
        w.indent -= 1;
        w.parts = None;
        Ok(())
    }

    /// What is done before the condition of a loop, which stands behind it.
    fn head(&mut self, w: &mut Writer<'m>, statements: &[(&'m S, &'m Span)]) -> Result<()> {
        for (statement, _) in statements {
            w.at += 1;
            if let S::Emit(range) = statement {
                for h in range.clone() {
                    self.emitted(w, h)?;
                }
            }
        }
        // the condition, and its break
        w.at += 2;
        Ok(())
    }

    fn all_of(&mut self, w: &mut Writer<'m>, conditions: &[Handle<E>]) -> Result<String> {
        let mut texts = Vec::new();
        for h in conditions {
            texts.push(self.text(w, *h)?.within(AND));
        }
        Ok(texts.join(" and "))
    }

    /// `for i in range(...)`, where a loop counts by whole steps and nothing else changes or needs its variable.
    fn counted(
        &mut self,
        w: &mut Writer<'m>,
        condition: Handle<E>,
        body: &'m Block,
        continuing: &'m Block,
        end: u32,
    ) -> Result<Option<String>> {
        let function = w.function;
        let E::Binary { op, left, right } = function.expressions[condition] else {
            return Ok(None);
        };
        let variable = |h: Handle<E>| match function.expressions[h] {
            E::Load { pointer } => match function.expressions[pointer] {
                E::LocalVariable(v) => Some(v),
                _ => None,
            },
            _ => None,
        };
        let Some(v) = variable(left) else {
            return Ok(None);
        };
        // what the variable is made of at the end of a round
        let stores: Vec<_> = continuing
            .iter()
            .filter(|s| !matches!(s, S::Emit(_)))
            .collect();
        let [S::Store { pointer, value }] = stores[..] else {
            return Ok(None);
        };
        let E::Binary {
            op: change,
            left: old,
            right: step,
        } = function.expressions[*value]
        else {
            return Ok(None);
        };
        let E::Literal(step) = function.expressions[step] else {
            return Ok(None);
        };
        let is_same = matches!(function.expressions[*pointer], E::LocalVariable(x) if x == v)
            && variable(old) == Some(v);
        let Some(mut step) = whole(step) else {
            return Ok(None);
        };
        match change {
            BinaryOperator::Add => {}
            BinaryOperator::Subtract => step = -step,
            _ => return Ok(None),
        }
        let mut stored = HashSet::new();
        self.stored_in(function, body, &mut stored);
        let read_after = self.facts[&w.handle]
            .last_read
            .get(&Root::Local(v))
            .is_some_and(|last| *last > end);
        if !is_same
            || step == 0
            || stored.contains(&Root::Local(v))
            || read_after
            || !self.reads(w, right).is_disjoint(&stored)
        {
            return Ok(None);
        }
        let is_int = matches!(self.facts[&w.handle].inner[left.index()], TypeInner::Scalar(s) if s.kind != ScalarKind::Float);
        let literal = match function.expressions[right] {
            E::Literal(literal) => whole(literal),
            _ => None,
        };
        let stop = match (op, step > 0) {
            (BinaryOperator::Less, true) | (BinaryOperator::Greater, false) => 0,
            (BinaryOperator::LessEqual, true) => 1,
            (BinaryOperator::GreaterEqual, false) => -1,
            _ => return Ok(None),
        };
        let name = w.names[&v].clone();
        let begin = format!("{name} = ");
        let (mut everywhere, is_v) = (
            0,
            |pointer: Handle<E>| matches!(self.path(function, pointer), Some((Root::Local(x), _)) if x == v),
        );
        stores_of(&function.body, &is_v, &mut everywhere);
        // set where it is declared, or just before the loop
        let at = match function.local_variables[v].init.is_some() && everywhere == 1 {
            true => w
                .lines
                .iter()
                .position(|(indent, line)| *indent == 1 && line.starts_with(&begin)),
            false => w
                .lines
                .len()
                .checked_sub(1)
                .filter(|k| w.lines[*k].0 == w.indent && w.lines[*k].1.starts_with(&begin)),
        };
        let start = at.map(|k| w.lines[k].1[begin.len()..].to_owned());
        let whole_start = start
            .as_ref()
            .and_then(|s| s.strip_suffix(".0").unwrap_or(s).parse::<i64>().ok());
        if !is_int && (literal.is_none() || whole_start.is_none()) {
            return Ok(None);
        }
        // the bound may be emitted within the loop: it reads nothing that the loop changes
        let stop = match literal {
            Some(number) => (number + stop).to_string(),
            None => {
                let text = self.text(w, right)?;
                match stop {
                    0 => text.text,
                    _ => format!(
                        "{} {} 1",
                        text.within(SUM),
                        if stop > 0 { "+" } else { "-" }
                    ),
                }
            }
        };
        if let Some(k) = at {
            w.lines.remove(k);
            w.parts = None;
        }
        let start = whole_start
            .map(|n| n.to_string())
            .or(start)
            .unwrap_or_else(|| name.clone());
        Ok(Some(match (start.as_str(), step) {
            ("0", 1) => format!("for {name} in range({stop}):"),
            (_, 1) => format!("for {name} in range({start}, {stop}):"),
            _ => format!("for {name} in range({start}, {stop}, {step}):"),
        }))
    }

    fn call(
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
    fn store(
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

/// How many statements store to a variable.
fn stores_of(block: &Block, is_it: &dyn Fn(Handle<E>) -> bool, found: &mut usize) {
    for statement in block {
        match statement {
            S::Store { pointer, .. } => *found += usize::from(is_it(*pointer)),
            S::Call { arguments, .. } => *found += arguments.iter().filter(|a| is_it(**a)).count(),
            _ => {}
        }
        blocks(statement)
            .into_iter()
            .for_each(|b| stores_of(b, is_it, found));
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

fn whole(literal: Literal) -> Option<i64> {
    match literal {
        Literal::I32(n) => Some(i64::from(n)),
        Literal::U32(n) => Some(i64::from(n)),
        Literal::F32(x) if x.fract() == 0.0 && x.abs() < 1e6 => Some(x as i64),
        _ => None,
    }
}

fn last_statement(block: &Block) -> Option<&S> {
    match block.last() {
        Some(S::Block(inner)) => last_statement(inner),
        other => other,
    }
}

/// How many statements there are in a block, with those in its blocks.
fn count(block: &Block) -> u32 {
    block
        .iter()
        .map(|s| 1 + blocks(s).into_iter().map(count).sum::<u32>())
        .sum()
}

/// How a loop may be left, or a round of it.
#[derive(Clone, Copy, Debug, Default)]
struct Leaves {
    by_point: bool,
    next: bool,
}

impl Leaves {
    fn and(self, other: Leaves) -> Leaves {
        Leaves {
            by_point: self.by_point || other.by_point,
            next: self.next || other.next,
        }
    }
}

fn leaves(statement: &S, by_point: bool, plain: &[bool]) -> Leaves {
    let none = Leaves::default();
    match statement {
        S::Break => Leaves { by_point, ..none },
        S::Continue => Leaves {
            by_point,
            next: true,
        },
        S::If {
            condition,
            accept,
            reject,
        } => {
            let by_point = by_point || !plain[condition.index()];
            accept
                .iter()
                .chain(reject)
                .fold(none, |sum, s| sum.and(leaves(s, by_point, plain)))
        }
        S::Block(inner) => inner
            .iter()
            .fold(none, |sum, s| sum.and(leaves(s, by_point, plain))),
        _ => none,
    }
}

/// Whether a statement may end the round of the loop that it is in.
fn may_leave(statement: &S) -> bool {
    match statement {
        S::Break | S::Continue => true,
        S::If { accept, reject, .. } => accept.iter().chain(reject).any(may_leave),
        S::Block(inner) => inner.iter().any(may_leave),
        _ => false,
    }
}
