//! Statements and expressions.

use super::depth::CALL;
use super::machine::{Body, Function, Machine, Param, ParamKind};
use super::mistake::{Mistake, Run, mistake};
use super::operators::binary;
use super::scope::{comprehension_names, find, locals};
use super::value::Value;
use starlark_syntax::syntax::ast::{
    AssignOp, AssignTargetP, AstAssignTarget, AstExpr, AstLiteral, AstNoPayload, AstParameter,
    AstStmt, BinOp, ClauseP, ExprP, ForClauseP, LoadP, ParameterP, StmtP,
};
use zeroset_field::formula::Expression;

/// `for` clauses and conditions of a comprehension.
const MAX_CLAUSES: usize = 16;

/// How a statement ends.
pub(crate) enum Flow {
    Next,
    Break,
    Continue,
    Return(Value),
}

/// Bytes that a value counts as which a function gives back where a condition holds.
const PENDING: usize = 64;

/// A condition.
enum Decided {
    /// The same for all points.
    Plain(bool),
    /// Another at each point of a formula.
    ByPoint(Expression),
}

type For = ForClauseP<AstNoPayload>;
type Clause = ClauseP<AstNoPayload>;

impl<'a> Machine<'a> {
    /// Runs a module from its first to its last statement.
    pub(crate) fn run_module(&mut self, module: u32) -> Run<()> {
        (self.module, self.frame) = (module, None);
        let statement = &self.modules[module as usize].statement;
        self.statement(statement).map(|_| ())
    }

    pub(crate) fn statement(&mut self, stmt: &'a AstStmt) -> Run<Flow> {
        let ready = self.depth.enter(1).and_then(|()| self.charge(1));
        let result = match ready {
            Ok(()) => self.run_statement(stmt),
            Err(m) => Err(m.at(self.place(stmt.span))),
        };
        self.depth.leave(1);
        result
    }

    fn run_statement(&mut self, stmt: &'a AstStmt) -> Run<Flow> {
        match &stmt.node {
            StmtP::Statements(all) => {
                for s in all {
                    match self.statement(s)? {
                        Flow::Next => {}
                        other => return Ok(other),
                    }
                }
                return Ok(Flow::Next);
            }
            StmtP::Expression(e) => {
                self.eval(e)?;
            }
            StmtP::Assign(assign) => {
                let value = self.eval(&assign.rhs)?;
                self.assign(&assign.lhs, value)?;
            }
            StmtP::AssignModify(target, op, rhs) => {
                self.modify(target, *op, rhs)
                    .map_err(|m| m.at(self.place(stmt.span)))?;
            }
            StmtP::If(cond, body) => match self.decided(cond)? {
                Decided::Plain(true) => return self.statement(body),
                Decided::Plain(false) => {}
                Decided::ByPoint(c) => return self.both_branches(&c, body, None),
            },
            StmtP::IfElse(cond, both) => match self.decided(cond)? {
                Decided::Plain(true) => return self.statement(&both.0),
                Decided::Plain(false) => return self.statement(&both.1),
                Decided::ByPoint(c) => return self.both_branches(&c, &both.0, Some(&both.1)),
            },
            StmtP::For(f) => {
                return self.loop_over(&f.over, |m, item| {
                    m.assign(&f.var, item)?;
                    m.statement(&f.body)
                });
            }
            StmtP::Return(value) => {
                let value = value.as_ref().map_or(Ok(Value::None), |e| self.eval(e))?;
                return Ok(Flow::Return(value));
            }
            StmtP::Def(def) => {
                let names = self.locals_of(&*def.body, || locals(&def.params, Some(&def.body)));
                let params = self.params(&def.params)?;
                let (module, frame) = (self.module, self.frame);
                let name = def.name.node.ident.as_str();
                let body = Body::Block(&def.body);
                let function = self.function(Function {
                    name,
                    params,
                    body,
                    locals: names,
                    module,
                    frame,
                })?;
                self.set(name, function);
            }
            StmtP::Load(load) => self.load(load)?,
            StmtP::Break => return Ok(Flow::Break),
            StmtP::Continue => return Ok(Flow::Continue),
            StmtP::Pass => {}
        }
        Ok(Flow::Next)
    }

    /// A condition, which a point may decide.
    fn decided(&mut self, e: &'a AstExpr) -> Run<Decided> {
        let value = self.eval(e)?;
        match self.as_condition(value) {
            Some(condition) => Ok(Decided::ByPoint(condition)),
            None => {
                let truth = self.truth(value).map_err(|m| m.at(self.place(e.span)))?;
                Ok(Decided::Plain(truth))
            }
        }
    }

    /// Runs both branches of an `if` that the point of a formula decides: the formula is written down once, for all points.
    /// Variables then have the value of the one branch or of the other, and what a branch gives back is what the function
    /// gives back where its condition holds.
    fn both_branches(
        &mut self,
        condition: &Expression,
        yes: &'a AstStmt,
        no: Option<&'a AstStmt>,
    ) -> Run<Flow> {
        let Some(frame) = self.frame else {
            return Err(super::formulas::conditional());
        };
        let frame = frame as usize;
        self.charge(self.frames[frame].values.len() as u64)?;
        let before = self.frames[frame].values.clone();
        let other = condition.negated();
        self.branches += 1;
        let first = self.guarded(condition, yes);
        let first = first.map(|flow| {
            let values = std::mem::replace(&mut self.frames[frame].values, before);
            (flow, values)
        });
        let second = match (&first, no) {
            (Ok(_), Some(no)) => self.guarded(&other, no),
            _ => Ok(Flow::Next),
        };
        self.branches -= 1;
        let (first, values) = first?;
        match (first, second?) {
            (Flow::Return(a), Flow::Return(b)) => self.chosen(condition, a, b).map(Flow::Return),
            (Flow::Return(a), Flow::Next) => {
                self.grow(PENDING)?;
                self.pending.push((condition.clone(), a));
                Ok(Flow::Next)
            }
            (Flow::Next, Flow::Return(b)) => {
                self.grow(PENDING)?;
                self.frames[frame].values = values;
                self.pending.push((other, b));
                Ok(Flow::Next)
            }
            (Flow::Next, Flow::Next) => {
                for (i, yes) in values.into_iter().enumerate() {
                    let merged = match (yes, self.frames[frame].values[i]) {
                        (Some(yes), Some(no)) => Some(self.chosen(condition, yes, no)?),
                        (yes, no) => yes.or(no),
                    };
                    self.frames[frame].values[i] = merged;
                }
                Ok(Flow::Next)
            }
            _ => Err(mistake(
                "`break` and `continue` cannot depend on the point: a loop runs the same for all points",
            )
            .help("choose the value instead: d = a if condition else d")),
        }
    }

    /// Runs a branch; what it gives back on its way counts where the condition holds as well.
    fn guarded(&mut self, condition: &Expression, branch: &'a AstStmt) -> Run<Flow> {
        let from = self.pending.len();
        let flow = self.statement(branch)?;
        for (holds, _) in &mut self.pending[from..] {
            *holds = condition.min(&*holds);
        }
        Ok(flow)
    }

    /// What a function gives back, from what it gave back where conditions hold and else; `from` is where its own begin.
    pub(crate) fn returned(&mut self, from: usize, last: Value) -> Run<Value> {
        let mut result = last;
        while self.pending.len() > from {
            if let Some((condition, value)) = self.pending.pop() {
                result = self.chosen(&condition, value, result)?;
            }
        }
        Ok(result)
    }

    fn condition(&mut self, e: &'a AstExpr) -> Run<bool> {
        let value = self.eval(e)?;
        self.truth(value).map_err(|m| m.at(self.place(e.span)))
    }

    /// Runs `work` for every item; a `return` in it ends the loop and is passed on.
    fn loop_over(
        &mut self,
        over: &'a AstExpr,
        mut work: impl FnMut(&mut Self, Value) -> Run<Flow>,
    ) -> Run<Flow> {
        let iterable = self.eval(over)?;
        let place = self.place(over.span);
        let mut result = Ok(Flow::Next);
        self.deeper(CALL, |m| {
            m.each(iterable, |m, item| {
                m.charge(1).map_err(|e| e.at(place))?;
                match work(m, item) {
                    Ok(Flow::Next | Flow::Continue) => Ok(true),
                    Ok(Flow::Break) => Ok(false),
                    other => {
                        result = other;
                        Ok(false)
                    }
                }
            })
        })
        .map_err(|m| m.at(place))?;
        result
    }

    /// Gives the name a value: a variable of the running function, or of the module.
    fn set(&mut self, name: &'a str, value: Value) {
        if let Some(frame) = self.frame {
            let frame = &mut self.frames[frame as usize];
            if let Some(i) = find(&frame.names, name) {
                frame.values[i] = Some(value);
                return;
            }
        }
        self.globals[self.module as usize].insert(name, value);
    }

    fn get(&self, name: &str) -> Run<Value> {
        let unset = || {
            mistake(format!("`{name}` has no value yet")).help("give it a value before it is used")
        };
        let mut frame = self.frame;
        while let Some(i) = frame {
            let f = &self.frames[i as usize];
            if let Some(k) = find(&f.names, name) {
                return f.values[k].ok_or_else(unset);
            }
            frame = f.parent;
        }
        let global = self.globals[self.module as usize]
            .get(name)
            .or_else(|| self.builtins.get(name));
        global.copied().ok_or_else(unset)
    }

    fn assign(&mut self, target: &'a AstAssignTarget, value: Value) -> Run<()> {
        match &target.node {
            AssignTargetP::Identifier(ident) => {
                self.set(&ident.node.ident, value);
                Ok(())
            }
            AssignTargetP::Tuple(targets) => {
                let items = self
                    .collect(value)
                    .map_err(|m| m.at(self.place(target.span)))?;
                if items.len() != targets.len() {
                    let message = format!("{} names for {} values", targets.len(), items.len());
                    return Err(mistake(message).at(self.place(target.span)));
                }
                targets
                    .iter()
                    .zip(items)
                    .try_for_each(|(t, item)| self.assign(t, item))
            }
            AssignTargetP::Index(both) => {
                let object = self.eval(&both.0)?;
                let index = self.eval(&both.1)?;
                self.set_index(object, index, value)
                    .map_err(|m| m.at(self.place(target.span)))
            }
            AssignTargetP::Dot(..) => {
                let m = mistake("attributes cannot be changed")
                    .help("methods give a new value: a = a.move(x = 1)");
                Err(m.at(self.place(target.span)))
            }
        }
    }

    /// `target op= value`: a list on the left of `+=` changes itself.
    fn modify(&mut self, target: &'a AstAssignTarget, op: AssignOp, value: &'a AstExpr) -> Run<()> {
        let (old, at) = match &target.node {
            AssignTargetP::Identifier(ident) => (self.get(&ident.node.ident)?, None),
            AssignTargetP::Index(both) => {
                let object = self.eval(&both.0)?;
                let index = self.eval(&both.1)?;
                (self.index(object, index)?, Some((object, index)))
            }
            _ => return Err(mistake("only a name or an item can be changed like this")),
        };
        let value = self.eval(value)?;
        let new = match (op, old) {
            (AssignOp::Add, Value::List(list)) => {
                self.extend(list, value)?;
                old
            }
            _ => self.operate(binary(op), old, value)?,
        };
        match (at, &target.node) {
            (Some((object, index)), _) => self.set_index(object, index, new),
            (None, AssignTargetP::Identifier(ident)) => {
                self.set(&ident.node.ident, new);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn load(&mut self, load: &'a LoadP<AstNoPayload>) -> Run<()> {
        let path = load.module.node.as_str();
        let module = self.modules[self.module as usize].loads.get(path).copied();
        let module = module.ok_or_else(|| mistake(format!("`{path}` is not loaded")))?;
        for arg in &load.args {
            let name = arg.their.node.as_str();
            let place = self.place(arg.their.span);
            if name.starts_with('_') {
                let m = mistake(format!(
                    "`{name}` is private to {path}, as its name starts with _"
                ));
                return Err(m.at(place));
            }
            let value = self.globals[module as usize]
                .get(name)
                .copied()
                .ok_or_else(|| {
                    let names = self.globals[module as usize].keys().copied();
                    let help =
                        crate::report::suggestion(name, names.filter(|n| !n.starts_with('_')));
                    mistake(format!("{path} has no `{name}`"))
                        .maybe_help(help)
                        .at(place)
                })?;
            self.set(&arg.local.node.ident, value);
        }
        Ok(())
    }

    pub(crate) fn eval(&mut self, e: &'a AstExpr) -> Run<Value> {
        let ready = self.depth.enter(1).and_then(|()| self.charge(1));
        let result = ready.and_then(|()| self.expression(e));
        self.depth.leave(1);
        result.map_err(|m: Box<Mistake>| m.at(self.place(e.span)))
    }

    fn expression(&mut self, e: &'a AstExpr) -> Run<Value> {
        match &e.node {
            ExprP::Literal(literal) => self.literal(literal),
            ExprP::Identifier(ident) => self.get(&ident.node.ident),
            ExprP::Call(function, args) => self.call_expression(function, &args.args, e.span),
            ExprP::Dot(object, name) => {
                let object = self.eval(object)?;
                let place = self.place(name.span);
                self.attribute(object, &name.node).map_err(|m| m.at(place))
            }
            ExprP::Op(left, BinOp::And, right) => {
                let place = self.place(left.span);
                let left = self.eval(left)?;
                if let Some(condition) = self.as_condition(left) {
                    let at = self.place(right.span);
                    let right = self.eval(right)?;
                    return self.combined(&condition, right, true).map_err(|m| m.at(at));
                }
                if self.truth(left).map_err(|m| m.at(place))? {
                    self.eval(right)
                } else {
                    Ok(left)
                }
            }
            ExprP::Op(left, BinOp::Or, right) => {
                let place = self.place(left.span);
                let left = self.eval(left)?;
                if let Some(condition) = self.as_condition(left) {
                    let at = self.place(right.span);
                    let right = self.eval(right)?;
                    return self
                        .combined(&condition, right, false)
                        .map_err(|m| m.at(at));
                }
                if self.truth(left).map_err(|m| m.at(place))? {
                    Ok(left)
                } else {
                    self.eval(right)
                }
            }
            ExprP::Op(left, op, right) => {
                let (left, right) = (self.eval(left)?, self.eval(right)?);
                self.operate(*op, left, right)
            }
            ExprP::Not(x) => match self.decided(x)? {
                Decided::Plain(truth) => Ok(Value::Bool(!truth)),
                Decided::ByPoint(condition) => self.formula_condition(condition.negated()),
            },
            ExprP::Minus(x) => {
                let x = self.eval(x)?;
                self.negate(x)
            }
            ExprP::Plus(x) => {
                let x = self.eval(x)?;
                match x {
                    Value::Int(_) | Value::Float(_) => Ok(x),
                    _ if self.formula_of([x]).is_some() && self.as_condition(x).is_none() => Ok(x),
                    other => Err(mistake(format!(
                        "`+` needs a number, not {}",
                        self.store.kind(other)
                    ))),
                }
            }
            ExprP::BitNot(x) => {
                let x = self.eval(x)?;
                self.complement(x)
            }
            ExprP::If(parts) => match self.decided(&parts.0)? {
                Decided::Plain(true) => self.eval(&parts.1),
                Decided::Plain(false) => self.eval(&parts.2),
                Decided::ByPoint(condition) => {
                    let (yes, no) = (self.eval(&parts.1)?, self.eval(&parts.2)?);
                    self.chosen(&condition, yes, no)
                }
            },
            ExprP::Tuple(items) => {
                let items = self.eval_all(items)?;
                self.tuple(items)
            }
            ExprP::List(items) => {
                let items = self.eval_all(items)?;
                self.list(items)
            }
            ExprP::Dict(pairs) => {
                let dict = self.dict()?;
                for (key, value) in pairs {
                    let (k, v) = (self.eval(key)?, self.eval(value)?);
                    self.insert(dict, k, v)
                        .map_err(|m| m.at(self.place(key.span)))?;
                }
                Ok(Value::Dict(dict))
            }
            ExprP::Index(both) => {
                let (object, index) = (self.eval(&both.0)?, self.eval(&both.1)?);
                self.index(object, index)
            }
            ExprP::Index2(_) => Err(mistake("one index is allowed, not two")),
            ExprP::Slice(object, start, stop, step) => {
                let object = self.eval(object)?;
                let mut bound =
                    |e: &'a Option<Box<AstExpr>>| e.as_ref().map(|e| self.eval(e)).transpose();
                let bounds = [bound(start)?, bound(stop)?, bound(step)?];
                self.slice(object, bounds)
            }
            ExprP::Lambda(lambda) => {
                let names = self.locals_of(&*lambda.body, || locals(&lambda.params, None));
                let params = self.params(&lambda.params)?;
                let (module, frame) = (self.module, self.frame);
                let body = Body::Expression(&lambda.body);
                self.function(Function {
                    name: "lambda",
                    params,
                    body,
                    locals: names,
                    module,
                    frame,
                })
            }
            ExprP::ListComprehension(item, first, rest) => {
                let mut items = Vec::new();
                self.comprehension(first, rest, |m| {
                    m.grow(size_of::<Value>())?;
                    let value = m.eval(item)?;
                    items.push(value);
                    Ok(())
                })?;
                self.list(items)
            }
            ExprP::DictComprehension(pair, first, rest) => {
                let dict = self.dict()?;
                self.comprehension(first, rest, |m| {
                    let (key, value) = (m.eval(&pair.0)?, m.eval(&pair.1)?);
                    m.insert(dict, key, value)
                        .map_err(|e| e.at(m.place(pair.0.span)))
                })?;
                Ok(Value::Dict(dict))
            }
            ExprP::FString(f) => {
                let values = self.eval_all(&f.node.expressions)?;
                self.format(&f.node.format.node, &values, &[])
            }
        }
    }

    fn eval_all(&mut self, items: &'a [AstExpr]) -> Run<Vec<Value>> {
        self.grow_items(items.len())?;
        items.iter().map(|e| self.eval(e)).collect()
    }

    fn literal(&mut self, literal: &'a AstLiteral) -> Run<Value> {
        match literal {
            AstLiteral::Int(i) => {
                match i.node.to_string().parse() {
                    Ok(i) => Ok(Value::Int(i)),
                    Err(_) => Err(mistake("this whole number is too large")
                        .help("write it with a point: 1e30")),
                }
            }
            AstLiteral::Float(x) => Ok(Value::Float(x.node)),
            AstLiteral::String(s) => self.text(s.node.as_str()),
            AstLiteral::Bytes(_) => {
                Err(mistake("the scene language has no bytes")
                    .help("leave out the b before the text"))
            }
            AstLiteral::Ellipsis => Err(mistake("`...` stands for nothing here")),
        }
    }

    fn params(&mut self, params: &'a [AstParameter]) -> Run<Vec<Param<'a>>> {
        let mut out = Vec::with_capacity(params.len());
        let mut kind = ParamKind::Normal;
        for param in params {
            let (ident, kind, default) = match &param.node {
                ParameterP::Slash => continue,
                ParameterP::NoArgs => {
                    kind = ParamKind::Named;
                    continue;
                }
                ParameterP::Args(ident, _) => {
                    kind = ParamKind::Named;
                    (ident, ParamKind::Rest, None)
                }
                ParameterP::KwArgs(ident, _) => (ident, ParamKind::RestNamed, None),
                ParameterP::Normal(ident, _, default) => (
                    ident,
                    kind,
                    default.as_ref().map(|e| self.eval(e)).transpose()?,
                ),
            };
            out.push(Param {
                name: &ident.node.ident,
                kind,
                default,
            });
        }
        Ok(out)
    }

    fn comprehension(
        &mut self,
        first: &'a For,
        rest: &'a [Clause],
        mut item: impl FnMut(&mut Self) -> Run<()>,
    ) -> Run<()> {
        if rest.len() >= MAX_CLAUSES {
            return Err(mistake(format!(
                "a comprehension may have at most {MAX_CLAUSES} clauses"
            )));
        }
        // the first sequence is evaluated outside of the comprehension's own variables
        let over = self.eval(&first.over)?;
        let names = self.locals_of(first, || comprehension_names(first, rest));
        self.charge(names.len() as u64 / 16)?;
        let (values, parent) = (vec![None; names.len()], self.frame);
        self.in_frame(names, values, parent, |m| {
            m.clauses(first, over, rest, &mut item)
        })
    }

    fn clauses(
        &mut self,
        head: &'a For,
        over: Value,
        rest: &'a [Clause],
        item: &mut dyn FnMut(&mut Self) -> Run<()>,
    ) -> Run<()> {
        let place = self.place(head.over.span);
        self.deeper(CALL, |m| {
            m.each(over, |m, value| {
                m.charge(1).map_err(|e| e.at(place))?;
                m.assign(&head.var, value)?;
                m.rest(rest, item)?;
                Ok(true)
            })
        })
        .map_err(|m| m.at(place))
    }

    fn rest(&mut self, rest: &'a [Clause], item: &mut dyn FnMut(&mut Self) -> Run<()>) -> Run<()> {
        match rest.split_first() {
            None => item(self),
            Some((ClauseP::If(cond), rest)) => {
                if self.condition(cond)? {
                    self.rest(rest, item)
                } else {
                    Ok(())
                }
            }
            Some((ClauseP::For(f), rest)) => {
                let over = self.eval(&f.over)?;
                self.clauses(f, over, rest, item)
            }
        }
    }
}
