//! The text of loops.

use super::translate::{AND, Result, Root, Round, SUM, Time, Translator, Writer, blocks};
use super::write::count;
use naga::{
    BinaryOperator, Block, Expression as E, Handle, Literal, ScalarKind, Span, Statement as S,
    TypeInner, UnaryOperator,
};
use std::collections::HashSet;

impl<'m> Translator<'m> {
    pub(super) fn inner(&mut self, w: &mut Writer<'m>, block: &'m Block) -> Result<()> {
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

    pub(super) fn round(
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

fn whole(literal: Literal) -> Option<i64> {
    match literal {
        Literal::I32(n) => Some(i64::from(n)),
        Literal::U32(n) => Some(i64::from(n)),
        Literal::F32(x) if x.fract() == 0.0 && x.abs() < 1e6 => Some(x as i64),
        _ => None,
    }
}

pub(super) fn last_statement(block: &Block) -> Option<&S> {
    match block.last() {
        Some(S::Block(inner)) => last_statement(inner),
        other => other,
    }
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
pub(super) fn may_leave(statement: &S) -> bool {
    match statement {
        S::Break | S::Continue => true,
        S::If { accept, reject, .. } => accept.iter().chain(reject).any(may_leave),
        S::Block(inner) => inner.iter().any(may_leave),
        _ => false,
    }
}
