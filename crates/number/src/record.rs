//! A formula as data: what a recorded formula does, ready to be printed as a function of a shading language.
//!
//! A [`Recorder`] listens while a formula runs over [`Expr`]: every operation becomes an [`Op`], equal operations become one,
//! and loops stay loops. [`Recorder::function`] takes out what some results need, as a [`Function`], which knows nothing of
//! the language it is printed in.

use super::dual::Dual;
use super::expr::Expr;
use super::real::Ends;
use super::vector::{Vec3, v3};
use std::cell::RefCell;
use std::collections::HashMap;
use thiserror::Error;

/// A value of a record: its place in [`Function::op`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Id(u32);

impl Id {
    /// Its number, to make a name from.
    pub fn number(self) -> u32 {
        self.0
    }
}

/// A loop of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LoopId(u32);

impl LoopId {
    /// Its number, to make a name from.
    pub fn number(self) -> u32 {
        self.0
    }
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unary {
    /// `-x`
    Neg,
    /// Absolute value.
    Abs,
    /// Square root.
    Sqrt,
    /// Largest integer not above.
    Floor,
    /// Sine of radians.
    Sin,
    /// Cosine of radians.
    Cos,
    /// e to the power.
    Exp,
    /// 2 to the power.
    Exp2,
    /// Natural logarithm.
    Ln,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// `x + y`
    Add,
    /// `x - y`
    Sub,
    /// `x * y`
    Mul,
    /// `x / y`
    Div,
    /// The smaller.
    Min,
    /// The larger.
    Max,
    /// Angle of the point (second, first).
    Atan2,
    /// The first to the power of the second.
    Pow,
}

/// A comparison of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// `x < y`
    Below,
    /// `x > y`
    Above,
}

/// A condition of two conditions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Logic {
    /// Both.
    And,
    /// At least one.
    Or,
}

/// One operation: a number or, for comparisons and logic, a condition.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// A number by its bits: finite, or infinite for "as large as can be".
    Literal(u32),
    /// A number that is handed in: an argument, or a component of one (`p.x`, `m[0].x`).
    Input(String),
    /// A parameter, counted from where the function's parameters begin.
    Param(u32),
    /// Number `component` of the loop's item, or of the one that follows it.
    Item {
        /// The loop over the list.
        of: LoopId,
        /// Whether it is the item that follows.
        next: bool,
        /// Which of the item's numbers.
        component: u32,
    },
    /// What a loop carries: as it is in this turn within the loop, and as it ended behind it.
    State(LoopId, u32),
    /// The value of a [`Op::State`] now, kept when the state goes on.
    Copy(Id),
    /// The sample of the grid of the first number at the node of the other three.
    Fetch(Id, [Id; 3]),
    /// A function of one number.
    Unary(Unary, Id),
    /// A function of two numbers.
    Binary(Binary, Id, Id),
    /// Euclidean length of a vector of two to four components.
    Length(Vec<Id>),
    /// A comparison.
    Compare(Comparison, Id, Id),
    /// A condition of conditions.
    Logic(Logic, Id, Id),
    /// The opposite condition.
    Not(Id),
    /// The second where the first, a condition, holds; else the third.
    Select(Id, Id, Id),
}

impl Op {
    /// The values it is made of.
    fn operands(&self) -> Vec<Id> {
        match self {
            Op::Literal(_) | Op::Input(_) | Op::Param(_) | Op::Item { .. } | Op::State(..) => {
                vec![]
            }
            Op::Fetch(grid, [x, y, z]) => vec![*grid, *x, *y, *z],
            Op::Copy(a) | Op::Unary(_, a) | Op::Not(a) => vec![*a],
            Op::Binary(_, a, b) | Op::Compare(_, a, b) | Op::Logic(_, a, b) => vec![*a, *b],
            Op::Length(v) => v.clone(),
            Op::Select(m, a, b) => vec![*m, *a, *b],
        }
    }

    /// Whether it is computed by a statement, once; the others stand wherever they are used.
    fn is_computed(&self) -> bool {
        !matches!(self, Op::Literal(_) | Op::Input(_) | Op::State(..))
    }
}

/// How often a loop turns, unless it ends early.
#[derive(Clone, Debug)]
pub enum Turns {
    /// This many times.
    Fixed(u32),
    /// As a number says: rounded down, at most [`super::MOST_STEPS`] times.
    Number(Id),
    /// Once for each item of a list in the parameters that has a successor: with the item and the successor.
    Items {
        /// The parameter that holds the number of items, which follow it.
        at: u32,
        /// Numbers an item has.
        width: u32,
        /// Whether the last item is followed by the first. That pair comes first then.
        ends: Ends,
    },
    /// Once for each node of a list of trees in the parameters that is come to: [`Loop::enters`] says whether a node's children are.
    Nodes {
        /// The parameter that holds the number of nodes, which follow it.
        at: u32,
        /// Numbers a node has. The last is the number of nodes in its tree.
        width: u32,
    },
    /// Once for each of some items that stand behind such nodes.
    Slice {
        /// The parameter that holds the number of nodes.
        at: u32,
        /// Numbers a node has.
        nodes: u32,
        /// Numbers an item has.
        width: u32,
        /// Which item is the first.
        first: Id,
        /// How many there are.
        count: Id,
    },
}

/// Something that a loop carries.
#[derive(Clone, Debug)]
pub struct State {
    /// Before the first turn.
    pub init: Id,
    /// After a turn.
    pub next: Id,
}

/// A loop.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Its name.
    pub id: LoopId,
    /// How often it turns.
    pub turns: Turns,
    /// What it carries that is used: index and values. All go on together at the end of a turn.
    pub states: Vec<(u32, State)>,
    /// Of [`Turns::Nodes`]: whether the children of the node come next. Without it they never do.
    pub enters: Option<Id>,
    /// What happens in each turn.
    pub body: Vec<Statement>,
}

/// A step of a function.
#[derive(Clone, Debug)]
pub enum Statement {
    /// Compute a value.
    Compute(Id),
    /// Run a loop.
    Loop(Loop),
    /// End the innermost loop unless the condition holds.
    BreakUnless(Id),
}

/// What a function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// A number; its input has the argument's name.
    Number,
    /// A vector; its inputs are `name.x` and `name.y`.
    Vec2,
    /// A vector; its inputs are `name.x`, `name.y` and `name.z`.
    Vec3,
    /// A vector; its inputs are `name.x` to `name.w`. A number with its gradient is one: the value, then the derivatives
    /// along x, y and z.
    Vec4,
    /// Three vectors of four; their inputs are `name[0].x` to `name[2].w`. A point with its derivatives is one: the numbers
    /// x, y and z, each with its gradient.
    Mat3x4,
    /// Where the function's parameters begin in the parameter array. Without one they begin at 0.
    Offset,
}

/// Why a record makes no function.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum RecordError {
    /// A name that is none.
    #[error(
        "`{0}` is no name for a function or an argument: letters, digits and underscores, not a digit first, no two underscores first"
    )]
    Name(String),
    /// Two arguments of one name, or two offsets.
    #[error("function `{function}` has two arguments `{argument}`")]
    Twice {
        /// The function.
        function: String,
        /// The argument.
        argument: String,
    },
    /// An input that no argument stands for.
    #[error("function `{function}` uses the input `{input}`, which none of its arguments has")]
    Input {
        /// The function.
        function: String,
        /// The input.
        input: String,
    },
    /// A literal that is not a number.
    #[error("function `{0}` holds a constant that is not a number (such as 0 / 0)")]
    NotANumber(String),
    /// As many results as neither a vector nor a point with its derivatives has.
    #[error("function `{function}` has {count} results; it can have 1 to 4, or 12")]
    Results {
        /// The function.
        function: String,
        /// How many.
        count: usize,
    },
}

/// A recorded function: it takes arguments and gives one number, a vector of two to four, or three vectors of four.
#[derive(Clone, Debug)]
pub struct Function {
    name: String,
    arguments: Vec<(String, Argument)>,
    results: Vec<Id>,
    ops: Vec<Op>,
    body: Vec<Statement>,
}

impl Function {
    /// The name it was given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it takes.
    pub fn arguments(&self) -> &[(String, Argument)] {
        &self.arguments
    }

    /// What it gives.
    pub fn results(&self) -> &[Id] {
        &self.results
    }

    /// What it does, with everything computed before it is used.
    pub fn body(&self) -> &[Statement] {
        &self.body
    }

    /// What a value is.
    pub fn op(&self, id: Id) -> &Op {
        &self.ops[id.0 as usize]
    }
}

/// A loop as it is recorded.
#[derive(Debug)]
struct LoopRecord {
    turns: Turns,
    /// Each with the value that stands for it.
    states: Vec<(Id, State)>,
    condition: Option<Id>,
    enters: Option<Id>,
}

/// A block of statements that is being recorded, and the values that were computed in it.
#[derive(Debug, Default)]
struct Block {
    statements: Vec<Recorded>,
    seen: HashMap<Op, Id>,
}

#[derive(Debug)]
enum Recorded {
    Compute(Id),
    Loop(LoopId, Vec<Recorded>),
    BreakUnless(Id),
}

#[derive(Debug)]
struct Record {
    ops: Vec<Op>,
    loops: Vec<LoopRecord>,
    /// The function's own block, then those of the loops that are open.
    blocks: Vec<Block>,
}

/// Listens to formulas over [`Expr`].
///
/// Expressions of different recorders must not meet.
#[derive(Debug)]
pub struct Recorder(RefCell<Record>);

impl Default for Recorder {
    fn default() -> Self {
        Recorder::new()
    }
}

impl Recorder {
    /// An empty record.
    pub fn new() -> Self {
        Recorder(RefCell::new(Record {
            ops: Vec::new(),
            loops: Vec::new(),
            blocks: vec![Block::default()],
        }))
    }

    /// A number that is handed in: the name of a [`Argument::Number`], or a component of a vector (`p.x`) or of one of three
    /// (`m[0].x`).
    pub fn input(&self, name: &str) -> Expr<'_> {
        Expr::value(self, self.add(Op::Input(name.into())))
    }

    /// The vector that is handed in as the argument `name`.
    pub fn point(&self, name: &str) -> Vec3<Expr<'_>> {
        let axis = |c: &str| self.input(&format!("{name}.{c}"));
        v3(axis("x"), axis("y"), axis("z"))
    }

    /// The number with its gradient that is handed in as the argument `name`, an [`Argument::Vec4`].
    pub fn dual(&self, name: &str) -> Dual<Expr<'_>> {
        let component = |c: &str| self.input(&format!("{name}.{c}"));
        Dual {
            v: component("x"),
            d: [component("y"), component("z"), component("w")],
        }
    }

    /// The point with its derivatives that is handed in as the argument `name`, an [`Argument::Mat3x4`].
    pub fn dual_point(&self, name: &str) -> Vec3<Dual<Expr<'_>>> {
        let axis = |k: usize| self.dual(&format!("{name}[{k}]"));
        v3(axis(0), axis(1), axis(2))
    }

    /// Parameter `at`, counted from where the function's parameters begin.
    pub fn param(&self, at: u32) -> Expr<'_> {
        Expr::value(self, self.add(Op::Param(at)))
    }

    /// What is needed for `results`, as a function. The record stays as it is.
    pub fn function(
        &self,
        name: &str,
        arguments: &[(&str, Argument)],
        results: &[Expr<'_>],
    ) -> Result<Function, RecordError> {
        check_names(name, arguments)?;
        if !matches!(results.len(), 1..=4 | 12) {
            return Err(RecordError::Results {
                function: name.into(),
                count: results.len(),
            });
        }
        let results: Vec<Id> = results.iter().map(|e| e.id(self)).collect();
        let record = self.0.borrow();
        let used = record.needed(&results);
        for (op, _) in record.ops.iter().zip(&used).filter(|(_, used)| **used) {
            match op {
                Op::Input(input) if !is_given(input, arguments) => {
                    return Err(RecordError::Input {
                        function: name.into(),
                        input: input.clone(),
                    });
                }
                Op::Literal(bits) if f32::from_bits(*bits).is_nan() => {
                    return Err(RecordError::NotANumber(name.into()));
                }
                _ => {}
            }
        }
        let body = match record.blocks.first() {
            Some(block) => record.prune(&block.statements, &used),
            None => Vec::new(),
        };
        Ok(Function {
            name: name.into(),
            arguments: arguments.iter().map(|(n, a)| ((*n).into(), *a)).collect(),
            results,
            ops: record.ops.clone(),
            body,
        })
    }

    /// The value of an operation: one that was recorded before where it still stands, else a new one.
    pub(super) fn add(&self, op: Op) -> Id {
        let mut record = self.0.borrow_mut();
        if let Some(id) = record.blocks.iter().find_map(|b| b.seen.get(&op)) {
            return *id;
        }
        let id = record.push(op.clone());
        // what is not computed stands everywhere
        let computed = op.is_computed();
        let block = if computed {
            record.blocks.last_mut()
        } else {
            record.blocks.first_mut()
        };
        if let Some(block) = block {
            if computed {
                block.statements.push(Recorded::Compute(id));
            }
            block.seen.insert(op, id);
        }
        id
    }

    /// Whether a value is the negative of another.
    pub(super) fn negated(&self, id: Id) -> Option<Id> {
        match self.0.borrow().ops[id.0 as usize] {
            Op::Unary(Unary::Neg, a) => Some(a),
            _ => None,
        }
    }

    /// Begins a loop: what is recorded from now on is its body.
    pub(super) fn open(&self, turns: Turns) -> LoopId {
        let mut record = self.0.borrow_mut();
        let id = LoopId(record.loops.len() as u32);
        record.loops.push(LoopRecord {
            turns,
            states: Vec::new(),
            condition: None,
            enters: None,
        });
        record.blocks.push(Block::default());
        id
    }

    /// Something that the loop carries, with its value before the first turn.
    pub(super) fn state(&self, of: LoopId, init: Id) -> Id {
        let mut record = self.0.borrow_mut();
        let index = record.loops[of.0 as usize].states.len() as u32;
        let id = record.push(Op::State(of, index));
        let state = State { init, next: init };
        record.loops[of.0 as usize].states.push((id, state));
        id
    }

    /// The value of a state after a turn.
    pub(super) fn set_next(&self, state: Id, next: Id) {
        let is_state = |id: Id| match self.0.borrow().ops[id.0 as usize] {
            Op::State(of, index) => Some((of, index)),
            _ => None,
        };
        let Some((of, index)) = is_state(state) else {
            return;
        };
        // all states go on together: one that takes over another's value needs that of this turn
        let next = if next != state && is_state(next).is_some() {
            self.add(Op::Copy(next))
        } else {
            next
        };
        self.0.borrow_mut().loops[of.0 as usize].states[index as usize]
            .1
            .next = next;
    }

    /// Ends the innermost loop, `of`, unless the condition holds.
    pub(super) fn break_unless(&self, of: LoopId, condition: Id) {
        let mut record = self.0.borrow_mut();
        record.loops[of.0 as usize].condition = Some(condition);
        if let Some(block) = record.blocks.last_mut() {
            block.statements.push(Recorded::BreakUnless(condition));
        }
    }

    /// The children of the node that the loop `of` is at come next if the condition holds.
    pub(super) fn enter_if(&self, of: LoopId, condition: Id) {
        self.0.borrow_mut().loops[of.0 as usize].enters = Some(condition);
    }

    /// Ends the body of the innermost loop, `of`.
    pub(super) fn close(&self, of: LoopId) {
        let mut record = self.0.borrow_mut();
        if let Some(body) = record.blocks.pop()
            && let Some(block) = record.blocks.last_mut()
        {
            block.statements.push(Recorded::Loop(of, body.statements));
        }
    }

    /// Forgets the innermost loop, which never turns.
    pub(super) fn abandon(&self) {
        self.0.borrow_mut().blocks.pop();
    }
}

impl Record {
    fn push(&mut self, op: Op) -> Id {
        let id = Id(self.ops.len() as u32);
        self.ops.push(op);
        id
    }

    /// Which values the results are made of.
    fn needed(&self, results: &[Id]) -> Vec<bool> {
        let mut used = vec![false; self.ops.len()];
        let mut open = results.to_vec();
        while let Some(id) = open.pop() {
            if std::mem::replace(&mut used[id.0 as usize], true) {
                continue;
            }
            let op = &self.ops[id.0 as usize];
            open.extend(op.operands());
            if let Op::State(of, index) = op {
                let record = &self.loops[of.0 as usize];
                let (_, state) = &record.states[*index as usize];
                open.extend([state.init, state.next]);
                open.extend(record.condition);
                open.extend(record.enters);
                match record.turns {
                    Turns::Number(n) => open.push(n),
                    Turns::Slice { first, count, .. } => open.extend([first, count]),
                    Turns::Fixed(_) | Turns::Items { .. } | Turns::Nodes { .. } => {}
                }
            }
        }
        used
    }

    /// The statements that compute what is used.
    fn prune(&self, statements: &[Recorded], used: &[bool]) -> Vec<Statement> {
        let mut out = Vec::new();
        for statement in statements {
            match statement {
                Recorded::Compute(id) if used[id.0 as usize] => out.push(Statement::Compute(*id)),
                Recorded::Compute(_) => {}
                Recorded::BreakUnless(id) => out.push(Statement::BreakUnless(*id)),
                Recorded::Loop(id, body) => {
                    let record = &self.loops[id.0 as usize];
                    let states: Vec<_> = (0..)
                        .zip(&record.states)
                        .filter(|(_, (id, _))| used[id.0 as usize])
                        .map(|(index, (_, state))| (index, state.clone()))
                        .collect();
                    if !states.is_empty() {
                        out.push(Statement::Loop(Loop {
                            id: *id,
                            turns: record.turns.clone(),
                            states,
                            enters: record.enters,
                            body: self.prune(body, used),
                        }));
                    }
                }
            }
        }
        out
    }
}

/// Letters, digits and underscores, as the shading languages have in common.
fn is_name(name: &str) -> bool {
    let mut chars = name.chars();
    chars
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && chars.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && name != "_"
        && !name.starts_with("__")
}

fn check_names(function: &str, arguments: &[(&str, Argument)]) -> Result<(), RecordError> {
    if let Some(name) = std::iter::once(function)
        .chain(arguments.iter().map(|(n, _)| *n))
        .find(|n| !is_name(n))
    {
        return Err(RecordError::Name(name.into()));
    }
    for (i, (name, kind)) in arguments.iter().enumerate() {
        let twice = |(n, k): &(&str, Argument)| {
            n == name || (*k == Argument::Offset && *kind == Argument::Offset)
        };
        if arguments[..i].iter().any(twice) {
            return Err(RecordError::Twice {
                function: function.into(),
                argument: (*name).into(),
            });
        }
    }
    Ok(())
}

/// Whether an input is an argument or a component of one.
fn is_given(input: &str, arguments: &[(&str, Argument)]) -> bool {
    let (base, component) = input.split_at(input.find(['.', '[']).unwrap_or(input.len()));
    arguments.iter().any(|(name, kind)| {
        *name == base
            && match kind {
                Argument::Number => component.is_empty(),
                Argument::Vec2 => [".x", ".y"].contains(&component),
                Argument::Vec3 => [".x", ".y", ".z"].contains(&component),
                Argument::Vec4 => FOUR.contains(&component),
                Argument::Mat3x4 => ["[0]", "[1]", "[2]"].iter().any(|column| {
                    component
                        .strip_prefix(column)
                        .is_some_and(|c| FOUR.contains(&c))
                }),
                Argument::Offset => false,
            }
    })
}

/// The components of a vector of four.
const FOUR: [&str; 4] = [".x", ".y", ".z", ".w"];
