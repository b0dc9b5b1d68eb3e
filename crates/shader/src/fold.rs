//! Takes what never runs out of a shader: branches whose conditions follow from numbers that nobody changes, and all that only they use.

use naga::compact::{KeepUnused, compact};
use naga::valid::ModuleInfo;
use naga::{
    Arena, BinaryOperator, Block, Constant, Expression, Function, GlobalVariable, Handle, Literal,
    LocalVariable, Module, Statement, UnaryOperator,
};
use std::collections::{HashMap, HashSet};

/// How often a module is gone through at most: a branch that is gone can make another condition known.
const ROUNDS: usize = 8;

/// What an expression is, as far as it is known.
#[derive(Clone, Debug, PartialEq)]
enum Known {
    Literal(Literal),
    Parts(Vec<Option<Known>>),
}

/// What is known of a module.
struct Facts {
    constants: Vec<(Handle<Constant>, Option<Known>)>,
    /// What variables begin with.
    globals: HashMap<Handle<GlobalVariable>, Known>,
    /// Parts of them that are changed; all of one that has no number.
    changed: HashSet<(Handle<GlobalVariable>, Option<u32>)>,
    /// Functions that do nothing but give a number.
    results: HashMap<Handle<Function>, Literal>,
}

/// A valid module without what never runs. Its functions give what they gave, to the bit.
pub(crate) fn trim(module: &mut Module) {
    for _ in 0..ROUNDS {
        let facts = Facts::of(module);
        let mut changed = false;
        for (_, function) in module.functions.iter_mut() {
            changed |= facts.fold(function);
        }
        for point in &mut module.entry_points {
            changed |= facts.fold(&mut point.function);
        }
        compact(module, KeepUnused::No);
        if !changed {
            return;
        }
    }
}

/// The deepest that expressions are nested: compilers refuse what is nested much more.
const DEEPEST: u32 = 12;

/// Takes names from what is used once, so that it is written where it is used: recorded formulas name every step.
pub(crate) fn unname(module: &mut Module, info: &ModuleInfo) {
    for (handle, function) in module.functions.iter_mut() {
        let info = &info[handle];
        let mut depths: HashMap<Handle<Expression>, u32> = HashMap::new();
        for (handle, expression) in function.expressions.iter() {
            let of = |h: &Handle<Expression>| depths.get(h).copied().unwrap_or(0);
            let depth = 1 + operands(expression).iter().map(of).max().unwrap_or(0);
            let once = info[handle].ref_count <= 1;
            if once && depth <= DEEPEST {
                function.named_expressions.shift_remove(&handle);
            }
            let is_written_apart = !once || function.named_expressions.contains_key(&handle);
            depths.insert(handle, if is_written_apart { 0 } else { depth });
        }
    }
}

/// What an expression is written with, of those that calculate.
fn operands(expression: &Expression) -> Vec<Handle<Expression>> {
    match expression {
        Expression::Binary { left, right, .. } => vec![*left, *right],
        Expression::Unary { expr, .. } | Expression::As { expr, .. } => vec![*expr],
        Expression::Math {
            arg,
            arg1,
            arg2,
            arg3,
            ..
        } => [Some(*arg), *arg1, *arg2, *arg3]
            .into_iter()
            .flatten()
            .collect(),
        Expression::Select {
            condition,
            accept,
            reject,
        } => vec![*condition, *accept, *reject],
        Expression::Compose { components, .. } => components.clone(),
        Expression::AccessIndex { base, .. } => vec![*base],
        Expression::Access { base, index } => vec![*base, *index],
        Expression::Splat { value, .. } => vec![*value],
        Expression::Swizzle { vector, .. } => vec![*vector],
        Expression::Relational { argument, .. } => vec![*argument],
        _ => Vec::new(),
    }
}

impl Facts {
    fn of(module: &Module) -> Facts {
        let global = |h| in_module(&module.global_expressions, &module.constants, h);
        let mut facts = Facts {
            constants: module
                .constants
                .iter()
                .map(|(h, c)| (h, global(c.init)))
                .collect(),
            globals: HashMap::new(),
            changed: HashSet::new(),
            results: HashMap::new(),
        };
        for (handle, variable) in module.global_variables.iter() {
            if let Some(known) = variable.init.and_then(global) {
                facts.globals.insert(handle, known);
            }
        }
        let entries = module.entry_points.iter().map(|p| &p.function);
        for function in module.functions.iter().map(|(_, f)| f).chain(entries) {
            each(&function.body, &mut |statement| match statement {
                Statement::Store { pointer, .. } => facts.change(function, *pointer),
                Statement::Call { arguments, .. } => {
                    arguments.iter().for_each(|a| facts.change(function, *a));
                }
                _ => {}
            });
        }
        for (handle, function) in module.functions.iter() {
            if let Some(result) = facts.result(function) {
                facts.results.insert(handle, result);
            }
        }
        facts
    }

    /// A pointer that something is put into.
    fn change(&mut self, function: &Function, pointer: Handle<Expression>) {
        if let Some((global, path)) = place(function, pointer) {
            self.changed
                .insert((global, path.first().copied().flatten()));
        }
    }

    /// What a function gives that does nothing else.
    fn result(&self, function: &Function) -> Option<Literal> {
        let (last, before) = function.body.split_last()?;
        let is_plain = before.iter().all(|s| matches!(s, Statement::Emit(_)));
        match last {
            Statement::Return { value: Some(value) } if is_plain => {
                self.literal(function, &HashMap::new(), *value)
            }
            _ => None,
        }
    }

    fn literal(
        &self,
        function: &Function,
        locals: &Locals,
        expression: Handle<Expression>,
    ) -> Option<Literal> {
        match self.known(function, locals, expression)? {
            Known::Literal(literal) => Some(literal),
            Known::Parts(_) => None,
        }
    }

    fn known(
        &self,
        function: &Function,
        locals: &Locals,
        expression: Handle<Expression>,
    ) -> Option<Known> {
        let known = |h| self.known(function, locals, h);
        let literal = |h| self.literal(function, locals, h);
        match &function.expressions[expression] {
            Expression::Literal(literal) => Some(Known::Literal(*literal)),
            Expression::Constant(constant) => {
                let found = self.constants.iter().find(|(h, _)| h == constant)?;
                found.1.clone()
            }
            Expression::Compose { components, .. } => {
                Some(Known::Parts(components.iter().map(|c| known(*c)).collect()))
            }
            Expression::AccessIndex { base, index } => match known(*base)? {
                Known::Parts(parts) => parts.get(*index as usize)?.clone(),
                Known::Literal(_) => None,
            },
            Expression::Load { pointer } => {
                if let Expression::LocalVariable(local) = function.expressions[*pointer] {
                    return locals.get(&local).map(|l| Known::Literal(*l));
                }
                let (global, path) = place(function, *pointer)?;
                let first = path.first().copied().flatten();
                if self.changed.contains(&(global, None)) || self.changed.contains(&(global, first))
                {
                    return None;
                }
                // a whole of which a part is changed
                if first.is_none() && self.changed.iter().any(|(g, _)| *g == global) {
                    return None;
                }
                let mut value = self.globals.get(&global)?.clone();
                for step in path {
                    value = match value {
                        Known::Parts(parts) => parts.get(step? as usize)?.clone()?,
                        Known::Literal(_) => return None,
                    };
                }
                Some(value)
            }
            Expression::Unary {
                op: UnaryOperator::LogicalNot,
                expr,
            } => match literal(*expr)? {
                Literal::Bool(b) => Some(Known::Literal(Literal::Bool(!b))),
                _ => None,
            },
            Expression::Binary { op, left, right } => {
                binary(*op, literal(*left), literal(*right)).map(Known::Literal)
            }
            Expression::Select {
                condition,
                accept,
                reject,
            } => match literal(*condition)? {
                Literal::Bool(true) => known(*accept),
                Literal::Bool(false) => known(*reject),
                _ => None,
            },
            _ => None,
        }
    }

    /// Takes out of a function what never runs. Gives whether there was something.
    fn fold(&self, function: &mut Function) -> bool {
        let mut changed = false;
        let mut body = std::mem::take(&mut function.body);
        changed |= self.give_results(function, &mut body);
        let locals = self.locals(function, &body);
        changed |= self.fold_block(function, &locals, &mut body);
        function.body = body;
        let mut emitted = HashSet::new();
        each(&function.body, &mut |statement| match statement {
            Statement::Emit(range) => emitted.extend(range.clone()),
            Statement::Call {
                result: Some(result),
                ..
            } => {
                emitted.insert(*result);
            }
            _ => {}
        });
        let expressions = &function.expressions;
        (function.named_expressions)
            .retain(|h, _| emitted.contains(h) || expressions[*h].needs_pre_emit());
        changed
    }

    /// Puts the results of functions that only give a number in the places of their calls.
    fn give_results(&self, function: &mut Function, block: &mut Block) -> bool {
        let (mut changed, old) = (false, std::mem::take(block));
        for (mut statement, span) in old.span_into_iter() {
            if let Statement::Call {
                function: called,
                result: Some(result),
                ..
            } = &statement
                && let Some(literal) = self.results.get(called)
            {
                function.expressions[*result] = Expression::Literal(*literal);
                changed = true;
                continue;
            }
            for inner in blocks(&mut statement) {
                changed |= self.give_results(function, inner);
            }
            block.push(statement, span);
        }
        changed
    }

    /// Variables that translators make for `&&` and `||`, which are set once, right before they are read.
    fn locals(&self, function: &Function, body: &Block) -> Locals {
        let mut stores: HashMap<Handle<LocalVariable>, Vec<Option<Literal>>> = HashMap::new();
        each(body, &mut |statement| {
            if let Statement::Store { pointer, value } = statement
                && let Expression::LocalVariable(local) = function.expressions[*pointer]
                && function.local_variables[local].name.is_none()
                && function.local_variables[local].init.is_none()
            {
                let value = self.literal(function, &HashMap::new(), *value);
                stores.entry(local).or_default().push(value);
            }
        });
        let single = |(local, values): (_, Vec<Option<Literal>>)| match values[..] {
            [Some(value)] => Some((local, value)),
            _ => None,
        };
        stores.into_iter().filter_map(single).collect()
    }

    fn fold_block(&self, function: &Function, locals: &Locals, block: &mut Block) -> bool {
        let (mut changed, old) = (false, std::mem::take(block));
        for (mut statement, span) in old.span_into_iter() {
            for inner in blocks(&mut statement) {
                changed |= self.fold_block(function, locals, inner);
            }
            if let Statement::If {
                condition,
                accept,
                reject,
            } = &mut statement
                && let Some(Literal::Bool(truth)) = self.literal(function, locals, *condition)
            {
                changed = true;
                let taken = std::mem::take(if truth { accept } else { reject });
                let ends = taken.last().is_some_and(Statement::is_terminator);
                for (statement, span) in taken.span_into_iter() {
                    block.push(statement, span);
                }
                if ends {
                    break;
                }
                continue;
            }
            block.push(statement, span);
        }
        changed
    }
}

type Locals = HashMap<Handle<LocalVariable>, Literal>;

/// What an expression of the module is.
fn in_module(
    expressions: &Arena<Expression>,
    constants: &Arena<Constant>,
    handle: Handle<Expression>,
) -> Option<Known> {
    match &expressions[handle] {
        Expression::Literal(literal) => Some(Known::Literal(*literal)),
        Expression::Constant(constant) => {
            in_module(expressions, constants, constants[*constant].init)
        }
        Expression::Compose { components, .. } => {
            let parts = components
                .iter()
                .map(|c| in_module(expressions, constants, *c));
            Some(Known::Parts(parts.collect()))
        }
        _ => None,
    }
}

/// The variable that a pointer points into, and the way to the place: numbers of parts, none for one that is computed.
fn place(
    function: &Function,
    pointer: Handle<Expression>,
) -> Option<(Handle<GlobalVariable>, Vec<Option<u32>>)> {
    match &function.expressions[pointer] {
        Expression::GlobalVariable(global) => Some((*global, Vec::new())),
        Expression::AccessIndex { base, index } => {
            let (global, mut path) = place(function, *base)?;
            path.push(Some(*index));
            Some((global, path))
        }
        Expression::Access { base, .. } => {
            let (global, mut path) = place(function, *base)?;
            path.push(None);
            Some((global, path))
        }
        _ => None,
    }
}

fn binary(op: BinaryOperator, left: Option<Literal>, right: Option<Literal>) -> Option<Literal> {
    use BinaryOperator as B;
    use Literal as L;
    match (op, left, right) {
        (B::LogicalAnd | B::And, Some(L::Bool(false)), _)
        | (B::LogicalAnd | B::And, _, Some(L::Bool(false))) => {
            return Some(L::Bool(false));
        }
        (B::LogicalOr | B::InclusiveOr, Some(L::Bool(true)), _)
        | (B::LogicalOr | B::InclusiveOr, _, Some(L::Bool(true))) => {
            return Some(L::Bool(true));
        }
        _ => {}
    }
    fn compared<T: PartialOrd>(op: BinaryOperator, a: T, b: T) -> Option<Literal> {
        Some(L::Bool(match op {
            B::Equal => a == b,
            B::NotEqual => a != b,
            B::Less => a < b,
            B::LessEqual => a <= b,
            B::Greater => a > b,
            B::GreaterEqual => a >= b,
            _ => return None,
        }))
    }
    match (left?, right?) {
        (L::F32(a), L::F32(b)) => compared(op, a, b),
        (L::I32(a), L::I32(b)) => compared(op, a, b),
        (L::U32(a), L::U32(b)) => compared(op, a, b).or(match op {
            B::And => Some(L::U32(a & b)),
            B::InclusiveOr => Some(L::U32(a | b)),
            B::Add => a.checked_add(b).map(L::U32),
            B::Subtract => a.checked_sub(b).map(L::U32),
            B::Multiply => a.checked_mul(b).map(L::U32),
            B::Divide => a.checked_div(b).map(L::U32),
            _ => None,
        }),
        (L::Bool(a), L::Bool(b)) => match op {
            B::LogicalAnd | B::And => Some(L::Bool(a && b)),
            B::LogicalOr | B::InclusiveOr => Some(L::Bool(a || b)),
            B::Equal => Some(L::Bool(a == b)),
            B::NotEqual => Some(L::Bool(a != b)),
            _ => None,
        },
        _ => None,
    }
}

/// The blocks inside of a statement.
fn blocks(statement: &mut Statement) -> Vec<&mut Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter_mut().map(|c| &mut c.body).collect(),
        Statement::Loop {
            body, continuing, ..
        } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Visits all statements of a block, those inside of others too.
fn each(block: &Block, visit: &mut impl FnMut(&Statement)) {
    for statement in block {
        visit(statement);
        match statement {
            Statement::Block(block) => each(block, visit),
            Statement::If { accept, reject, .. } => {
                each(accept, visit);
                each(reject, visit);
            }
            Statement::Switch { cases, .. } => cases.iter().for_each(|c| each(&c.body, visit)),
            Statement::Loop {
                body, continuing, ..
            } => {
                each(body, visit);
                each(continuing, visit);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    const SOURCE: &str = "
struct Frame { steps: u32, fog: f32, at: vec2f, turned: f32 }
var<private> frame: Frame = Frame(7u, 0.0, vec2f(1.0, 2.0), 3.0);
var<private> table: array<f32, 3> = array<f32, 3>(1.0, 2.0, 3.0);

fn thick() -> bool { return frame.fog != 0.0; }
fn foggy(x: f32) -> f32 { return x * frame.fog + costly(x); }
fn costly(x: f32) -> f32 { return x * 9.0; }
fn turn(x: f32) { frame.turned = x; }

fn shown(x: f32, k: u32) -> f32 {
    var sum = x;
    if (thick() && x > 1.0) {
        let more = foggy(x);
        sum += more;
    }
    if (frame.at.y >= 2.0 || costly(x) > 0.0) {
        sum += table[k];
    } else {
        return foggy(sum);
    }
    if (frame.turned > 3.5) {
        sum *= 2.0;
    }
    for (var i = 0u; i < 3u; i++) {
        if (frame.steps == 7u) {
            sum += 1.0;
            if (i == 1u) { break; }
        }
    }
    if (!thick()) {
        return sum;
    }
    return foggy(x);
}
@fragment
fn pixel(@location(0) x: f32) -> @location(0) vec4f {
    turn(x);
    return vec4f(shown(x, u32(x)));
}
";

    #[test]
    fn what_never_runs_is_gone() {
        let mut module = naga::front::wgsl::parse_str(SOURCE).unwrap();
        let check = |module: &Module| {
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(module)
                .unwrap();
        };
        check(&module);
        trim(&mut module);
        check(&module);
        let mut names: Vec<&str> = (module.functions.iter())
            .filter_map(|(_, f)| f.name.as_deref())
            .collect();
        names.sort_unstable();
        // what is changed, by whatever it is, is still looked at
        assert_eq!(names, ["shown", "turn"]);
        let shown = &module
            .functions
            .iter()
            .find(|(_, f)| f.name.as_deref() == Some("shown"))
            .unwrap()
            .1;
        let mut conditions = 0;
        each(&shown.body, &mut |s| {
            conditions += usize::from(matches!(s, Statement::If { .. }))
        });
        // of the turn, of the loop's end and of its break
        assert_eq!(conditions, 3);
    }
}
