//! Which names belong to whom: the variables of a function, and names that nothing gives a value.

use super::mistake::{Run, mistake};
use crate::report::{Place, suggestion};
use indexmap::{IndexMap, IndexSet};
use starlark_syntax::syntax::ast::{
    AssignTargetP, AstAssignTarget, AstExpr, AstNoPayload, AstParameter, AstStmt, ClauseP, ExprP,
    ForClauseP, ParameterP, StmtP,
};
use std::collections::HashMap;
use std::rc::Rc;

/// Different names in the order in which they were found.
type Names<'a> = IndexSet<&'a str>;

/// The variables of a function, parameters first.
pub(crate) type Locals<'a> = Rc<Names<'a>>;

/// The place of a variable.
pub(crate) fn find(names: &Names<'_>, name: &str) -> Option<usize> {
    const FEW: usize = 8;
    if names.len() <= FEW {
        return names.iter().position(|n| *n == name);
    }
    names.get_index_of(name)
}

/// The variables of a function.
pub(crate) fn locals<'a>(params: &'a [AstParameter], body: Option<&'a AstStmt>) -> Locals<'a> {
    let mut names = Names::new();
    for param in params {
        if let Some(ident) = param.node.ident() {
            names.insert(&ident.node.ident);
        }
    }
    if let Some(body) = body {
        assigned(body, &mut names);
    }
    names.into()
}

/// The variables of a target such as `(a, b)`.
pub(crate) fn targets<'a>(target: &'a AstAssignTarget, names: &mut Names<'a>) {
    match &target.node {
        AssignTargetP::Tuple(items) => items.iter().for_each(|t| targets(t, names)),
        AssignTargetP::Identifier(ident) => _ = names.insert(&ident.node.ident),
        AssignTargetP::Index(_) | AssignTargetP::Dot(..) => {}
    }
}

/// The names that a file gives a meaning, in functions too, and how often it does.
pub(crate) fn assigned_names(module: &AstStmt) -> IndexMap<&str, usize> {
    fn count<'a>(names: &mut IndexMap<&'a str, usize>, found: impl Iterator<Item = &'a str>) {
        for name in found {
            *names.entry(name).or_default() += 1;
        }
    }
    fn visit<'a>(stmt: &'a AstStmt, all: &mut IndexMap<&'a str, usize>) {
        let mut names = Names::new();
        match &stmt.node {
            StmtP::Assign(assign) => targets(&assign.lhs, &mut names),
            StmtP::AssignModify(target, ..) => targets(target, &mut names),
            StmtP::For(f) => targets(&f.var, &mut names),
            StmtP::Load(load) => names.extend(load.args.iter().map(|arg| &*arg.local.node.ident)),
            StmtP::Def(def) => {
                names.insert(&def.name.node.ident);
                let params = def.params.iter().filter_map(|p| p.node.ident());
                count(all, params.map(|i| &*i.node.ident));
            }
            _ => {}
        }
        count(all, names.into_iter());
        stmt.visit_stmt(|s| visit(s, all));
    }
    let mut all = IndexMap::new();
    visit(module, &mut all);
    all
}

/// The names that a block assigns, nested functions left out.
fn assigned<'a>(stmt: &'a AstStmt, names: &mut Names<'a>) {
    match &stmt.node {
        StmtP::Assign(assign) => targets(&assign.lhs, names),
        StmtP::AssignModify(target, ..) => targets(target, names),
        StmtP::For(f) => {
            targets(&f.var, names);
            assigned(&f.body, names);
        }
        StmtP::Def(def) => _ = names.insert(&def.name.node.ident),
        StmtP::Load(load) => names.extend(load.args.iter().map(|arg| &*arg.local.node.ident)),
        _ => stmt.visit_stmt(|s| assigned(s, names)),
    }
}

/// Looks for names that nothing gives a value.
pub(crate) struct NameCheck<'a, F> {
    builtin: F,
    file: u32,
    globals: Names<'a>,
    /// Names of functions and comprehensions around, with the number of those that have them.
    around: HashMap<&'a str, u32>,
}

impl<'a, F: Fn(&str) -> bool> NameCheck<'a, F> {
    /// Checks a module. `builtin` knows the names that are always there, `all` lists them.
    pub(crate) fn module(
        file: u32,
        module: &'a AstStmt,
        builtin: F,
        all: impl Iterator<Item = &'static str>,
    ) -> Run<()> {
        let mut names = Names::new();
        assigned(module, &mut names);
        let mut check = NameCheck {
            builtin,
            file,
            globals: names,
            around: HashMap::new(),
        };
        check.stmt(module).map_err(|(name, place)| {
            let around = check.around.keys().copied();
            let mut names: Vec<&str> = around.chain(check.globals.iter().copied()).collect();
            // in an order that is the same each time
            names.sort_unstable();
            names.extend(all.map(|name| name as &str));
            mistake(format!("there is no `{name}`"))
                .maybe_help(super::synonyms::of_name(&name))
                .maybe_help(suggestion(&name, names.iter().copied()))
                .at(place)
        })
    }

    fn stmt(&mut self, stmt: &'a AstStmt) -> Result<(), (String, Place)> {
        if let StmtP::Def(def) = &stmt.node {
            return self.function(&def.params, locals(&def.params, Some(&def.body)), |c| {
                c.stmt(&def.body)
            });
        }
        let mut result = Ok(());
        // visits this statement's own expressions and blocks, one level at a time
        match &stmt.node {
            StmtP::If(cond, body) => {
                self.expr(cond)?;
                return self.stmt(body);
            }
            StmtP::IfElse(cond, both) => {
                self.expr(cond)?;
                self.stmt(&both.0)?;
                return self.stmt(&both.1);
            }
            StmtP::For(f) => {
                self.expr(&f.over)?;
                self.target(&f.var)?;
                return self.stmt(&f.body);
            }
            StmtP::Statements(all) => return all.iter().try_for_each(|s| self.stmt(s)),
            StmtP::Assign(assign) => {
                self.expr(&assign.rhs)?;
                return self.target(&assign.lhs);
            }
            StmtP::AssignModify(target, _, value) => {
                self.expr(value)?;
                return self.target(target);
            }
            _ => {}
        }
        stmt.visit_expr(|e| {
            if result.is_ok() {
                result = self.expr(e);
            }
        });
        result
    }

    fn function(
        &mut self,
        params: &'a [AstParameter],
        locals: Locals<'a>,
        body: impl FnOnce(&mut Self) -> Result<(), (String, Place)>,
    ) -> Result<(), (String, Place)> {
        for param in params {
            if let ParameterP::Normal(_, _, Some(default)) = &param.node {
                self.expr(default)?;
            }
        }
        self.within(&locals, body)
    }

    /// Checks what sees these names. After a mistake they stay: they are what might have been meant.
    fn within(
        &mut self,
        names: &Names<'a>,
        body: impl FnOnce(&mut Self) -> Result<(), (String, Place)>,
    ) -> Result<(), (String, Place)> {
        for name in names {
            *self.around.entry(*name).or_default() += 1;
        }
        body(self)?;
        for name in names {
            if let Some(count) = self.around.get_mut(name) {
                *count -= 1;
                if *count == 0 {
                    self.around.remove(name);
                }
            }
        }
        Ok(())
    }

    fn target(&mut self, target: &'a AstAssignTarget) -> Result<(), (String, Place)> {
        match &target.node {
            AssignTargetP::Tuple(items) => items.iter().try_for_each(|t| self.target(t)),
            AssignTargetP::Index(both) => {
                self.expr(&both.0)?;
                self.expr(&both.1)
            }
            AssignTargetP::Dot(object, _) => self.expr(object),
            AssignTargetP::Identifier(_) => Ok(()),
        }
    }

    fn comprehension(
        &mut self,
        first: &'a ForClauseP<AstNoPayload>,
        rest: &'a [ClauseP<AstNoPayload>],
        items: &[&'a AstExpr],
    ) -> Result<(), (String, Place)> {
        self.expr(&first.over)?;
        self.within(&comprehension_names(first, rest), |c| {
            for clause in rest {
                match clause {
                    ClauseP::For(f) => c.expr(&f.over)?,
                    ClauseP::If(cond) => c.expr(cond)?,
                }
            }
            items.iter().try_for_each(|e| c.expr(e))
        })
    }

    fn expr(&mut self, expr: &'a AstExpr) -> Result<(), (String, Place)> {
        match &expr.node {
            ExprP::Identifier(ident) => {
                let name = ident.node.ident.as_str();
                let known = self.around.contains_key(name)
                    || self.globals.contains(name)
                    || (self.builtin)(name);
                let (start, end) = (ident.span.begin().get(), ident.span.end().get());
                if known {
                    Ok(())
                } else {
                    Err((
                        name.to_string(),
                        Place {
                            file: self.file,
                            start,
                            end,
                        },
                    ))
                }
            }
            ExprP::Lambda(lambda) => {
                self.function(&lambda.params, locals(&lambda.params, None), |c| {
                    c.expr(&lambda.body)
                })
            }
            ExprP::ListComprehension(item, first, rest) => self.comprehension(first, rest, &[item]),
            ExprP::DictComprehension(pair, first, rest) => {
                self.comprehension(first, rest, &[&pair.0, &pair.1])
            }
            ExprP::FString(f) => f.node.expressions.iter().try_for_each(|e| self.expr(e)),
            node => {
                let mut result = Ok(());
                node.visit_expr(|e| {
                    if result.is_ok() {
                        result = self.expr(e);
                    }
                });
                result
            }
        }
    }
}

/// The variables of a comprehension.
pub(crate) fn comprehension_names<'a>(
    first: &'a ForClauseP<AstNoPayload>,
    rest: &'a [ClauseP<AstNoPayload>],
) -> Locals<'a> {
    let mut names = Names::new();
    targets(&first.var, &mut names);
    for clause in rest {
        if let ClauseP::For(f) = clause {
            targets(&f.var, &mut names);
        }
    }
    names.into()
}
