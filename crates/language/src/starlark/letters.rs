//! Names with letters beyond ASCII.
//!
//! Python allows any letter in a name, the lexer of `starlark_syntax` those of ASCII. So every name that holds another one is
//! written with letters of ASCII before that lexer sees it, as many as the name has bytes, so that places stay where they
//! are. Once there is a syntax tree, the names are put back.

use super::mistake::{Mistake, mistake};
use starlark_syntax::codemap::CodeMap;
use starlark_syntax::dialect::Dialect;
use starlark_syntax::lexer::Lexer;
use starlark_syntax::syntax::ast::{
    ArgumentP, AssignTargetP, AstAssignIdent, AstAssignTarget, AstExpr, AstNoPayload, AstParameter,
    AstStmt, ClauseP, ExprP, ForClauseP, ParameterP, StmtP,
};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use unicode_ident::{is_xid_continue, is_xid_start};
use unicode_normalization::UnicodeNormalization;

/// Letters beyond ASCII outside of texts and comments that a file may have.
const MOST: usize = 100_000;

/// A text whose names are of ASCII letters, and what they stand for.
pub(crate) struct Letters<'t> {
    text: Cow<'t, str>,
    /// The names as they are meant, by those that stand for them.
    names: HashMap<String, String>,
}

impl<'t> Letters<'t> {
    /// Of a file.
    ///
    /// # Errors
    /// More of them than is allowed, with the place.
    pub(crate) fn of(text: &'t str) -> Result<Letters<'t>, (usize, Box<Mistake>)> {
        let mut letters = Letters {
            text: Cow::Borrowed(text),
            names: HashMap::new(),
        };
        if text.is_ascii() {
            return Ok(letters);
        }
        let spans = spans(text)?;
        if spans.is_empty() {
            return Ok(letters);
        }
        let used: HashSet<&str> = text
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .collect();
        let mut stand_ins = StandIns {
            used,
            next: HashMap::new(),
        };
        let mut known: HashMap<&str, String> = HashMap::new();
        let (mut plain, mut done) = (String::with_capacity(text.len()), 0);
        for (start, end) in spans {
            let name = &text[start..end];
            let stand_in = match known.get(name) {
                Some(stand_in) => stand_in,
                None => {
                    let made = stand_ins
                        .make(name.len())
                        .ok_or_else(|| (start, too_many()))?;
                    // as Python does: one name, however its letters are composed
                    letters.names.insert(made.clone(), name.nfkc().collect());
                    known.entry(name).or_insert(made)
                }
            };
            plain.push_str(&text[done..start]);
            plain.push_str(stand_in);
            done = end;
        }
        plain.push_str(&text[done..]);
        letters.text = Cow::Owned(plain);
        Ok(letters)
    }

    /// The text for the lexer, as long as the file's.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// A message of the parser with the names of the file.
    pub(crate) fn in_message(&self, message: &str) -> String {
        if self.names.is_empty() {
            return message.to_string();
        }
        let parts = message
            .split('`')
            .map(|part| self.names.get(part).map_or(part, |n| n));
        parts.collect::<Vec<&str>>().join("`")
    }

    /// Puts the names back.
    pub(crate) fn restore(&self, statement: &mut AstStmt) {
        if !self.names.is_empty() {
            Restore(&self.names).statement(statement);
        }
    }
}

fn too_many() -> Box<Mistake> {
    mistake("this file has too many letters beyond ASCII outside of its texts and comments")
        .help("use shorter names, or lists and dicts in place of so many names")
}

/// First byte and end of each of some pieces of a text.
type Spans = Vec<(usize, usize)>;
/// Where a mistake is, and which.
type Misplaced = (usize, Box<Mistake>);

/// First byte and end of every name that holds a letter beyond ASCII.
fn spans(text: &str) -> Result<Spans, Misplaced> {
    let mut lexer = Lexer::new(
        text,
        &Dialect::Standard,
        CodeMap::new(String::new(), text.to_string()),
    );
    let mut spans: Vec<(usize, usize)> = Vec::new();
    let (mut refused, mut seen) = (0, 0);
    // the lexer goes on after a sign that it does not know, and is not in a text or a comment there
    while let Some(token) = lexer.next() {
        let Err(error) = token else { continue };
        let error = error.into_error();
        refused += 1;
        let Some(at) = error.span().map(|s| s.span.begin().get() as usize) else {
            continue;
        };
        // each costs the lexer a message, be it in a name that is known already
        if refused > MOST {
            return Err((at, too_many()));
        }
        let letter = text.get(at..).and_then(|rest| rest.chars().next());
        if at < seen || !letter.is_some_and(|c| !c.is_ascii() && is_xid_continue(c)) {
            continue;
        }
        let within = |c: char| is_xid_continue(c);
        let before = text[..at].char_indices().rev();
        let start = before
            .take_while(|(_, c)| within(*c))
            .last()
            .map_or(at, |(i, _)| i);
        let rest = text[at..].char_indices();
        let end = at
            + rest
                .take_while(|(_, c)| within(*c))
                .map(|(i, c)| i + c.len_utf8())
                .last()
                .unwrap_or(0);
        seen = end;
        // what begins with a digit or a mark is no name
        let first = text[start..].chars().next();
        if first.is_some_and(|c| is_xid_start(c) || c == '_') {
            spans.push((start, end));
        }
    }
    Ok(spans)
}

/// Makes names that a file does not have.
struct StandIns<'t> {
    used: HashSet<&'t str>,
    /// The next one of each length.
    next: HashMap<usize, u64>,
}

impl StandIns<'_> {
    /// A name of so many letters; `None` if there is none any more.
    fn make(&mut self, length: usize) -> Option<String> {
        const LETTERS: &[u8; 52] = b"ZYXWVUTSRQPONMLKJIHGFEDCBAzyxwvutsrqponmlkjihgfedcba";
        let next = self.next.entry(length).or_default();
        loop {
            let mut rest = *next;
            *next += 1;
            let mut name = String::with_capacity(length);
            for _ in 0..length {
                name.push(char::from(LETTERS[(rest % 52) as usize]));
                rest /= 52;
            }
            if rest > 0 {
                return None;
            }
            // no word of the language is in capitals, none of more than two letters begins with a Z
            let reserved = ["as", "if", "in", "is", "or"].contains(&name.as_str());
            if !reserved && !self.used.contains(name.as_str()) {
                return Some(name);
            }
        }
    }
}

/// Puts names back into a syntax tree.
struct Restore<'n>(&'n HashMap<String, String>);

impl Restore<'_> {
    fn name(&self, name: &mut String) {
        if let Some(meant) = self.0.get(name) {
            name.clone_from(meant);
        }
    }

    fn ident(&self, ident: &mut AstAssignIdent) {
        self.name(&mut ident.node.ident);
    }

    fn params(&self, params: &mut [AstParameter]) {
        for param in params {
            match &mut param.node {
                ParameterP::Normal(ident, _, default) => {
                    self.ident(ident);
                    if let Some(default) = default {
                        self.expr(default);
                    }
                }
                ParameterP::Args(ident, _) | ParameterP::KwArgs(ident, _) => self.ident(ident),
                ParameterP::NoArgs | ParameterP::Slash => {}
            }
        }
    }

    fn target(&self, target: &mut AstAssignTarget) {
        match &mut target.node {
            AssignTargetP::Tuple(items) => items.iter_mut().for_each(|t| self.target(t)),
            AssignTargetP::Index(both) => {
                self.expr(&mut both.0);
                self.expr(&mut both.1);
            }
            AssignTargetP::Dot(object, name) => {
                self.expr(object);
                self.name(&mut name.node);
            }
            AssignTargetP::Identifier(ident) => self.ident(ident),
        }
    }

    fn statement(&self, statement: &mut AstStmt) {
        match &mut statement.node {
            StmtP::Break | StmtP::Continue | StmtP::Pass | StmtP::Return(None) => {}
            StmtP::Return(Some(e)) | StmtP::Expression(e) => self.expr(e),
            StmtP::Assign(assign) => {
                self.target(&mut assign.lhs);
                self.expr(&mut assign.rhs);
            }
            StmtP::AssignModify(target, _, value) => {
                self.target(target);
                self.expr(value);
            }
            StmtP::Statements(all) => all.iter_mut().for_each(|s| self.statement(s)),
            StmtP::If(condition, body) => {
                self.expr(condition);
                self.statement(body);
            }
            StmtP::IfElse(condition, both) => {
                self.expr(condition);
                self.statement(&mut both.0);
                self.statement(&mut both.1);
            }
            StmtP::For(f) => {
                self.target(&mut f.var);
                self.expr(&mut f.over);
                self.statement(&mut f.body);
            }
            StmtP::Def(def) => {
                self.ident(&mut def.name);
                self.params(&mut def.params);
                self.statement(&mut def.body);
            }
            // the names of the other file are texts
            StmtP::Load(load) => load.args.iter_mut().for_each(|a| self.ident(&mut a.local)),
        }
    }

    fn clauses(&self, first: &mut ForClauseP<AstNoPayload>, rest: &mut [ClauseP<AstNoPayload>]) {
        let one = |f: &mut ForClauseP<AstNoPayload>| {
            self.target(&mut f.var);
            self.expr(&mut f.over);
        };
        one(first);
        for clause in rest {
            match clause {
                ClauseP::For(f) => one(f),
                ClauseP::If(condition) => self.expr(condition),
            }
        }
    }

    fn expr(&self, expr: &mut AstExpr) {
        match &mut expr.node {
            ExprP::Identifier(ident) => self.name(&mut ident.node.ident),
            ExprP::Dot(object, name) => {
                self.expr(object);
                self.name(&mut name.node);
            }
            ExprP::Call(function, args) => {
                self.expr(function);
                for arg in &mut args.args {
                    if let ArgumentP::Named(name, _) = &mut arg.node {
                        self.name(&mut name.node);
                    }
                    self.expr(arg.node.expr_mut());
                }
            }
            ExprP::Lambda(lambda) => {
                self.params(&mut lambda.params);
                self.expr(&mut lambda.body);
            }
            ExprP::ListComprehension(item, first, rest) => {
                self.expr(item);
                self.clauses(first, rest);
            }
            ExprP::DictComprehension(pair, first, rest) => {
                self.expr(&mut pair.0);
                self.expr(&mut pair.1);
                self.clauses(first, rest);
            }
            ExprP::FString(f) => f.node.expressions.iter_mut().for_each(|e| self.expr(e)),
            node => node.visit_expr_mut(|e| self.expr(e)),
        }
    }
}
