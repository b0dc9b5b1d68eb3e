//! Runs WGSL on the CPU: the functions that a recorder prints, as naga understands them, in `f32`.
//!
//! Only what printed functions are made of; anything else is a panic that names it.

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, MathFunction,
    Module, ScalarKind, Statement, UnaryOperator,
};

/// A checked shader.
pub(crate) struct Shader(Module);

/// What an expression is.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Float(f32),
    Count(u32),
    Bool(bool),
    Vector(Vec<f32>),
    /// By columns.
    Matrix(Vec<Vec<f32>>),
    Local(Handle<LocalVariable>),
    Params,
    Param(u32),
}

enum Flow {
    On,
    Break,
    Return(Vec<f32>),
}

impl Shader {
    /// Parses and validates functions that read `params`.
    pub(crate) fn new(functions: &str) -> Self {
        let source =
            format!("@group(0) @binding(0) var<storage, read> params: array<f32>;\n{functions}");
        let module = match naga::front::wgsl::parse_str(&source) {
            Ok(module) => module,
            Err(e) => panic!("{}\n{source}", e.emit_to_string(&source)),
        };
        let flags = naga::valid::ValidationFlags::all();
        let checked = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
            .validate(&module);
        if let Err(e) = checked {
            panic!("{}\n{source}", e.emit_to_string(&source));
        }
        Shader(module)
    }

    /// Calls a function of a point and the offset of its parameters.
    pub(crate) fn call(&self, name: &str, p: [f32; 3], at: u32, params: &[f32]) -> Vec<f32> {
        let arguments = vec![Value::Vector(p.to_vec()), Value::Count(at)];
        self.call_with(name, arguments, params)
    }

    /// Calls a function. A matrix comes back column by column.
    pub(crate) fn call_with(&self, name: &str, arguments: Vec<Value>, params: &[f32]) -> Vec<f32> {
        let mut functions = self.0.functions.iter();
        let Some((_, function)) = functions.find(|(_, f)| f.name.as_deref() == Some(name)) else {
            panic!("no function {name}");
        };
        let mut frame = Frame {
            function,
            arguments,
            params,
            locals: vec![Value::Bool(false); function.local_variables.len()],
            values: vec![None; function.expressions.len()],
        };
        for (local, variable) in function.local_variables.iter() {
            if let Some(init) = variable.init {
                frame.locals[local.index()] = frame.value(init);
            }
        }
        match frame.run(&function.body) {
            Flow::Return(v) => v,
            _ => panic!("{name} returns nothing"),
        }
    }
}

struct Frame<'a> {
    function: &'a Function,
    arguments: Vec<Value>,
    params: &'a [f32],
    locals: Vec<Value>,
    values: Vec<Option<Value>>,
}

impl Frame<'_> {
    fn run(&mut self, block: &Block) -> Flow {
        for statement in block.iter() {
            let flow = match statement {
                Statement::Emit(range) => {
                    for e in range.clone() {
                        self.values[e.index()] = Some(self.compute(e));
                    }
                    Flow::On
                }
                Statement::Block(block) => self.run(block),
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let holds = self.truth(*condition);
                    self.run(if holds { accept } else { reject })
                }
                Statement::Loop {
                    body,
                    continuing,
                    break_if: None,
                } => self.repeat(body, continuing),
                Statement::Break => Flow::Break,
                Statement::Store { pointer, value } => {
                    let value = self.value(*value);
                    match self.value(*pointer) {
                        Value::Local(local) => self.locals[local.index()] = value,
                        other => panic!("store to {other:?}"),
                    }
                    Flow::On
                }
                Statement::Return { value: Some(value) } => {
                    Flow::Return(match self.value(*value) {
                        Value::Float(x) => vec![x],
                        Value::Vector(v) => v,
                        Value::Matrix(columns) => columns.concat(),
                        other => panic!("returns {other:?}"),
                    })
                }
                other => panic!("{other:?}"),
            };
            if !matches!(flow, Flow::On) {
                return flow;
            }
        }
        Flow::On
    }

    fn repeat(&mut self, body: &Block, continuing: &Block) -> Flow {
        loop {
            match self.run(body) {
                Flow::On => {}
                Flow::Break => return Flow::On,
                done => return done,
            }
            self.run(continuing);
        }
    }

    /// What an expression is: computed by its `Emit`, or standing by itself.
    fn value(&mut self, e: Handle<Expression>) -> Value {
        match &self.values[e.index()] {
            Some(value) => value.clone(),
            None => self.compute(e),
        }
    }

    fn float(&mut self, e: Handle<Expression>) -> f32 {
        match self.value(e) {
            Value::Float(x) => x,
            other => panic!("{other:?} is no number"),
        }
    }

    fn truth(&mut self, e: Handle<Expression>) -> bool {
        match self.value(e) {
            Value::Bool(b) => b,
            other => panic!("{other:?} is no condition"),
        }
    }

    fn compute(&mut self, e: Handle<Expression>) -> Value {
        match &self.function.expressions[e] {
            Expression::Literal(Literal::F32(x)) => Value::Float(*x),
            Expression::Literal(Literal::U32(n)) => Value::Count(*n),
            Expression::Literal(Literal::Bool(b)) => Value::Bool(*b),
            Expression::FunctionArgument(i) => self.arguments[*i as usize].clone(),
            Expression::GlobalVariable(_) => Value::Params,
            Expression::LocalVariable(local) => Value::Local(*local),
            Expression::Load { pointer } => match self.value(*pointer) {
                Value::Local(local) => self.locals[local.index()].clone(),
                Value::Param(i) => Value::Float(self.params[i as usize]),
                other => panic!("load from {other:?}"),
            },
            Expression::Access { base, index } => match (self.value(*base), self.value(*index)) {
                (Value::Params, Value::Count(i)) => Value::Param(i),
                other => panic!("access {other:?}"),
            },
            Expression::AccessIndex { base, index } => match self.value(*base) {
                Value::Vector(v) => Value::Float(v[*index as usize]),
                Value::Matrix(columns) => Value::Vector(columns[*index as usize].clone()),
                Value::Params => Value::Param(*index),
                other => panic!("access {other:?}"),
            },
            Expression::Compose { components, .. } => {
                let parts: Vec<Value> = components.iter().map(|c| self.value(*c)).collect();
                let columns = parts.iter().map(|part| match part {
                    Value::Vector(v) => Some(v.clone()),
                    _ => None,
                });
                match columns.collect() {
                    Some(columns) => Value::Matrix(columns),
                    None => Value::Vector(components.iter().map(|c| self.float(*c)).collect()),
                }
            }
            Expression::Unary { op, expr } => match (op, self.value(*expr)) {
                (UnaryOperator::Negate, Value::Float(x)) => Value::Float(-x),
                (UnaryOperator::LogicalNot, Value::Bool(b)) => Value::Bool(!b),
                other => panic!("{other:?}"),
            },
            Expression::Binary { op, left, right } => {
                binary(*op, self.value(*left), self.value(*right))
            }
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let holds = self.truth(*condition);
                self.value(if holds { *accept } else { *reject })
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2,
                ..
            } => {
                let first = self.value(*arg);
                let rest: Vec<f32> = [arg1, arg2]
                    .into_iter()
                    .flatten()
                    .map(|a| self.float(*a))
                    .collect();
                Value::Float(math(*fun, first, &rest))
            }
            Expression::As {
                expr,
                kind: ScalarKind::Uint,
                convert: Some(4),
            } => Value::Count(self.float(*expr) as u32),
            other => panic!("{other:?}"),
        }
    }
}

fn binary(op: BinaryOperator, left: Value, right: Value) -> Value {
    use BinaryOperator as B;
    match (op, left, right) {
        (B::Add, Value::Float(a), Value::Float(b)) => Value::Float(a + b),
        (B::Subtract, Value::Float(a), Value::Float(b)) => Value::Float(a - b),
        (B::Multiply, Value::Float(a), Value::Float(b)) => Value::Float(a * b),
        (B::Divide, Value::Float(a), Value::Float(b)) => Value::Float(a / b),
        (B::Less, Value::Float(a), Value::Float(b)) => Value::Bool(a < b),
        (B::Greater, Value::Float(a), Value::Float(b)) => Value::Bool(a > b),
        (B::Add, Value::Count(a), Value::Count(b)) => Value::Count(a + b),
        (B::Subtract, Value::Count(a), Value::Count(b)) => Value::Count(a - b),
        (B::Multiply, Value::Count(a), Value::Count(b)) => Value::Count(a * b),
        (B::Modulo, Value::Count(a), Value::Count(b)) => Value::Count(a % b),
        (B::Less, Value::Count(a), Value::Count(b)) => Value::Bool(a < b),
        (B::And | B::LogicalAnd, Value::Bool(a), Value::Bool(b)) => Value::Bool(a & b),
        (B::InclusiveOr | B::LogicalOr, Value::Bool(a), Value::Bool(b)) => Value::Bool(a | b),
        other => panic!("{other:?}"),
    }
}

fn math(f: MathFunction, first: Value, rest: &[f32]) -> f32 {
    use MathFunction as M;
    match (f, first, rest) {
        (M::Abs, Value::Float(x), []) => x.abs(),
        (M::Sqrt, Value::Float(x), []) => x.sqrt(),
        (M::Floor, Value::Float(x), []) => x.floor(),
        (M::Sin, Value::Float(x), []) => x.sin(),
        (M::Cos, Value::Float(x), []) => x.cos(),
        (M::Exp, Value::Float(x), []) => x.exp(),
        (M::Exp2, Value::Float(x), []) => x.exp2(),
        (M::Log, Value::Float(x), []) => x.ln(),
        (M::Min, Value::Float(x), [y]) => x.min(*y),
        (M::Max, Value::Float(x), [y]) => x.max(*y),
        (M::Atan2, Value::Float(x), [y]) => x.atan2(*y),
        (M::Pow, Value::Float(x), [y]) => x.powf(*y),
        (M::Clamp, Value::Float(x), [lo, hi]) => x.max(*lo).min(*hi),
        (M::Length, Value::Vector(v), []) => v.iter().map(|x| x * x).sum::<f32>().sqrt(),
        other => panic!("{other:?}"),
    }
}
