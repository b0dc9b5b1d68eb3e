//! Runs WGSL on the CPU: functions as naga understands them, in `f32`.
//!
//! Only what the shaders of fields are made of; anything else is a panic that names it.

use naga::{
    Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle, Literal,
    LocalVariable, MathFunction, Module, ScalarKind, Statement, SwitchValue, Type, TypeInner,
    UnaryOperator,
};

/// A checked shader.
pub struct Shader(Module);

/// The texel of a texture of this name at a column, a row and a layer.
pub type Texel<'a> = dyn Fn(&str, [u32; 3]) -> [f32; 4] + 'a;

/// What a module reads beside its arguments, under the names that it must have.
#[derive(Clone, Copy, Default)]
pub struct Inputs<'a> {
    /// `params: array<f32>`
    pub params: &'a [f32],
    /// `code: array<u32>`
    pub code: &'a [u32],
    /// `table: array<vec4f>`
    pub table: &'a [[f32; 4]],
    /// What textures hold.
    pub texel: Option<&'a Texel<'a>>,
}

/// What an expression is.
#[derive(Clone, Debug)]
pub enum Value {
    /// A number.
    Float(f32),
    /// A whole number.
    Count(u32),
    /// A condition.
    Bool(bool),
    /// A vector.
    Vector(Vec<f32>),
    /// By columns.
    Matrix(Vec<Vec<f32>>),
    /// An array or a struct.
    List(Vec<Value>),
    /// A variable, and the way to a part of it.
    Pointer(Variable, Vec<u32>),
}

/// A variable of a shader.
#[derive(Clone, Copy, Debug)]
pub enum Variable {
    /// Of the function.
    Local(Handle<LocalVariable>),
    /// Of the module.
    Global(Handle<GlobalVariable>),
}

impl Value {
    /// Its numbers one after the other.
    fn flat(&self) -> Vec<f32> {
        match self {
            Value::Float(x) => vec![*x],
            Value::Vector(v) => v.clone(),
            Value::Matrix(columns) => columns.concat(),
            Value::List(all) => all.iter().flat_map(Value::flat).collect(),
            other => panic!("{other:?} is no number"),
        }
    }

    fn part(&self, index: u32) -> Value {
        match self {
            Value::Vector(v) => Value::Float(v[index as usize]),
            Value::Matrix(columns) => Value::Vector(columns[index as usize].clone()),
            Value::List(all) => all[index as usize].clone(),
            other => panic!("part of {other:?}"),
        }
    }

    fn set(&mut self, path: &[u32], value: Value) {
        match (self, path) {
            (whole, []) => *whole = value,
            (Value::List(all), [first, rest @ ..]) => all[*first as usize].set(rest, value),
            other => panic!("part of {other:?}"),
        }
    }
}

enum Flow {
    On,
    Break,
    Return(Option<Value>),
}

impl Shader {
    /// Parses and validates functions that read `params`.
    pub fn new(functions: &str) -> Self {
        Shader::whole(&format!(
            "@group(0) @binding(0) var<storage, read> params: array<f32>;\n{functions}"
        ))
    }

    /// Parses and validates a module.
    pub fn whole(source: &str) -> Self {
        let module = match naga::front::wgsl::parse_str(source) {
            Ok(module) => module,
            Err(e) => panic!("{}\n{source}", e.emit_to_string(source)),
        };
        let flags = naga::valid::ValidationFlags::all();
        let checked = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
            .validate(&module);
        if let Err(e) = checked {
            panic!("{}\n{source}", e.emit_to_string(source));
        }
        Shader(module)
    }

    /// Calls a function of a point and the offset of its parameters.
    pub fn call(&self, name: &str, p: [f32; 3], at: u32, params: &[f32]) -> Vec<f32> {
        let arguments = vec![Value::Vector(p.to_vec()), Value::Count(at)];
        self.call_with(name, arguments, params)
    }

    /// Calls a function. All numbers of the result come one after the other, a matrix column by column.
    pub fn call_with(&self, name: &str, arguments: Vec<Value>, params: &[f32]) -> Vec<f32> {
        self.run(name, arguments, params, &[])
    }

    /// Calls a function that reads `params` and `code`.
    pub fn run(&self, name: &str, arguments: Vec<Value>, params: &[f32], code: &[u32]) -> Vec<f32> {
        let inputs = Inputs {
            params,
            code,
            ..Inputs::default()
        };
        self.run_with(name, arguments, inputs)
    }

    /// Calls a function that reads anything of these.
    pub fn run_with(&self, name: &str, arguments: Vec<Value>, inputs: Inputs<'_>) -> Vec<f32> {
        let mut functions = self.0.functions.iter();
        let Some((_, function)) = functions.find(|(_, f)| f.name.as_deref() == Some(name)) else {
            panic!("no function {name}");
        };
        let globals = self.0.global_variables.iter();
        let mut machine = Machine {
            module: &self.0,
            inputs,
            globals: globals
                .map(|(_, g)| match g.space {
                    naga::AddressSpace::Private => zero(&self.0, g.ty),
                    _ => Value::Bool(false),
                })
                .collect(),
        };
        match machine.call(function, arguments) {
            Some(value) => value.flat(),
            None => panic!("{name} returns nothing"),
        }
    }
}

/// What variables begin with.
fn zero(module: &Module, ty: Handle<Type>) -> Value {
    match &module.types[ty].inner {
        TypeInner::Scalar(s) => match s.kind {
            ScalarKind::Float => Value::Float(0.0),
            ScalarKind::Uint => Value::Count(0),
            ScalarKind::Bool => Value::Bool(false),
            other => panic!("{other:?}"),
        },
        TypeInner::Vector { size, .. } => Value::Vector(vec![0.0; *size as usize]),
        TypeInner::Matrix { columns, rows, .. } => {
            Value::Matrix(vec![vec![0.0; *rows as usize]; *columns as usize])
        }
        TypeInner::Array {
            base,
            size: naga::ArraySize::Constant(n),
            ..
        } => Value::List(vec![zero(module, *base); n.get() as usize]),
        TypeInner::Struct { members, .. } => {
            Value::List(members.iter().map(|m| zero(module, m.ty)).collect())
        }
        other => panic!("{other:?}"),
    }
}

struct Machine<'a> {
    module: &'a Module,
    inputs: Inputs<'a>,
    globals: Vec<Value>,
}

impl Machine<'_> {
    fn call(&mut self, function: &Function, arguments: Vec<Value>) -> Option<Value> {
        let mut frame = Frame {
            locals: (function.local_variables.iter())
                .map(|(_, variable)| zero(self.module, variable.ty))
                .collect(),
            values: vec![None; function.expressions.len()],
            machine: self,
            function,
            arguments,
        };
        for (local, variable) in function.local_variables.iter() {
            if let Some(init) = variable.init {
                frame.locals[local.index()] = frame.value(init);
            }
        }
        match frame.run(&function.body) {
            Flow::Return(value) => value,
            _ => None,
        }
    }
}

struct Frame<'f, 'm, 'a> {
    machine: &'m mut Machine<'a>,
    function: &'f Function,
    arguments: Vec<Value>,
    locals: Vec<Value>,
    values: Vec<Option<Value>>,
}

impl Frame<'_, '_, '_> {
    fn run(&mut self, block: &Block) -> Flow {
        for statement in block.iter() {
            let flow = self.statement(statement);
            if !matches!(flow, Flow::On) {
                return flow;
            }
        }
        Flow::On
    }

    fn statement(&mut self, statement: &Statement) -> Flow {
        match statement {
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
            Statement::Switch { selector, cases } => {
                let n = self.count(*selector);
                let found = cases.iter().position(|c| c.value == SwitchValue::U32(n));
                let default = || cases.iter().position(|c| c.value == SwitchValue::Default);
                let first = found.or_else(default).unwrap_or(cases.len());
                for case in &cases[first..] {
                    match self.run(&case.body) {
                        Flow::On if case.fall_through => {}
                        Flow::On | Flow::Break => return Flow::On,
                        done => return done,
                    }
                }
                Flow::On
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
                    Value::Pointer(Variable::Local(local), path) => {
                        self.locals[local.index()].set(&path, value);
                    }
                    Value::Pointer(Variable::Global(global), path) => {
                        self.machine.globals[global.index()].set(&path, value);
                    }
                    other => panic!("store to {other:?}"),
                }
                Flow::On
            }
            Statement::Call {
                function,
                arguments,
                result,
            } => {
                let arguments = arguments.iter().map(|a| self.value(*a)).collect();
                let function = &self.machine.module.functions[*function];
                let value = self.machine.call(function, arguments);
                if let Some(result) = result {
                    self.values[result.index()] = value;
                }
                Flow::On
            }
            Statement::Return { value } => Flow::Return(value.map(|value| self.value(value))),
            other => panic!("{other:?}"),
        }
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

    fn count(&mut self, e: Handle<Expression>) -> u32 {
        match self.value(e) {
            Value::Count(n) => n,
            other => panic!("{other:?} is no count"),
        }
    }

    fn truth(&mut self, e: Handle<Expression>) -> bool {
        match self.value(e) {
            Value::Bool(b) => b,
            other => panic!("{other:?} is no condition"),
        }
    }

    fn part(&mut self, base: Handle<Expression>, index: u32) -> Value {
        match self.value(base) {
            Value::Pointer(variable, mut path) => {
                path.push(index);
                Value::Pointer(variable, path)
            }
            value => value.part(index),
        }
    }

    fn load(&self, variable: Variable, path: &[u32]) -> Value {
        let mut value = match variable {
            Variable::Local(local) => &self.locals[local.index()],
            Variable::Global(global) => {
                let name = self.machine.module.global_variables[global].name.as_deref();
                match (name, path) {
                    (Some("params"), [i]) => {
                        return Value::Float(self.machine.inputs.params[*i as usize]);
                    }
                    (Some("code"), [i]) => {
                        return Value::Count(self.machine.inputs.code[*i as usize]);
                    }
                    (Some("table"), [i, rest @ ..]) => {
                        let row = Value::Vector(self.machine.inputs.table[*i as usize].to_vec());
                        return rest.iter().fold(row, |v, index| v.part(*index));
                    }
                    _ => &self.machine.globals[global.index()],
                }
            }
        };
        for (k, index) in path.iter().enumerate() {
            match value {
                Value::List(all) => value = &all[*index as usize],
                value => {
                    return path[k..]
                        .iter()
                        .fold(value.clone(), |v, index| v.part(*index));
                }
            }
        }
        value.clone()
    }

    fn texel(&self, texture: Handle<GlobalVariable>, place: &[Value], layer: u32) -> Value {
        let texture = &self.machine.module.global_variables[texture];
        let (name, texel) = (texture.name.as_deref(), self.machine.inputs.texel);
        match (name, place, texel) {
            (Some(name), [Value::Count(column), Value::Count(row)], Some(texel)) => {
                Value::Vector(texel(name, [*column, *row, layer]).to_vec())
            }
            other => panic!("a texel of {:?} at {:?}", other.0, other.1),
        }
    }

    fn compute(&mut self, e: Handle<Expression>) -> Value {
        match &self.function.expressions[e] {
            Expression::Literal(literal) => constant(literal),
            Expression::Constant(c) => {
                let module = self.machine.module;
                global(&module.global_expressions, module.constants[*c].init)
            }
            Expression::ZeroValue(ty) => zero(self.machine.module, *ty),
            Expression::FunctionArgument(i) => self.arguments[*i as usize].clone(),
            Expression::GlobalVariable(global) => {
                Value::Pointer(Variable::Global(*global), Vec::new())
            }
            Expression::LocalVariable(local) => Value::Pointer(Variable::Local(*local), Vec::new()),
            Expression::Load { pointer } => match self.value(*pointer) {
                Value::Pointer(variable, path) => self.load(variable, &path),
                other => panic!("load from {other:?}"),
            },
            Expression::Access { base, index } => {
                let index = self.count(*index);
                self.part(*base, index)
            }
            Expression::AccessIndex { base, index } => self.part(*base, *index),
            Expression::Compose { ty, components } => {
                let parts: Vec<Value> = components.iter().map(|c| self.value(*c)).collect();
                let flat = || parts.iter().flat_map(Value::flat);
                match &self.machine.module.types[*ty].inner {
                    TypeInner::Vector { scalar, .. } if scalar.kind == ScalarKind::Uint => {
                        Value::List(parts)
                    }
                    TypeInner::Vector { .. } => Value::Vector(flat().collect()),
                    TypeInner::Matrix { rows, .. } => {
                        let numbers: Vec<f32> = flat().collect();
                        let columns = numbers.chunks(*rows as usize);
                        Value::Matrix(columns.map(<[f32]>::to_vec).collect())
                    }
                    _ => Value::List(parts),
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
            Expression::ImageLoad {
                image,
                coordinate,
                array_index: Some(layer),
                ..
            } => {
                let (texture, place) = (self.value(*image), self.value(*coordinate));
                let layer = self.count(*layer);
                match (texture, place) {
                    (Value::Pointer(Variable::Global(texture), _), Value::List(place)) => {
                        self.texel(texture, &place, layer)
                    }
                    other => panic!("{other:?}"),
                }
            }
            Expression::As {
                expr,
                kind,
                convert: Some(4),
            } => match (kind, self.value(*expr)) {
                (ScalarKind::Uint, Value::Float(x)) => Value::Count(x as u32),
                (ScalarKind::Float, Value::Count(n)) => Value::Float(n as f32),
                other => panic!("{other:?}"),
            },
            other => panic!("{other:?}"),
        }
    }
}

fn constant(literal: &Literal) -> Value {
    match literal {
        Literal::F32(x) => Value::Float(*x),
        Literal::U32(n) => Value::Count(*n),
        Literal::Bool(b) => Value::Bool(*b),
        other => panic!("{other:?}"),
    }
}

fn global(expressions: &Arena<Expression>, e: Handle<Expression>) -> Value {
    match &expressions[e] {
        Expression::Literal(literal) => constant(literal),
        other => panic!("{other:?}"),
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
        (B::LessEqual, Value::Float(a), Value::Float(b)) => Value::Bool(a <= b),
        (B::Greater, Value::Float(a), Value::Float(b)) => Value::Bool(a > b),
        (B::Equal, Value::Float(a), Value::Float(b)) => Value::Bool(a == b),
        (B::Add, Value::Count(a), Value::Count(b)) => Value::Count(a + b),
        (B::Subtract, Value::Count(a), Value::Count(b)) => Value::Count(a - b),
        (B::Multiply, Value::Count(a), Value::Count(b)) => Value::Count(a * b),
        (B::Divide, Value::Count(a), Value::Count(b)) => Value::Count(a / b),
        (B::Modulo, Value::Count(a), Value::Count(b)) => Value::Count(a % b),
        (B::Less, Value::Count(a), Value::Count(b)) => Value::Bool(a < b),
        (B::And, Value::Count(a), Value::Count(b)) => Value::Count(a & b),
        (B::ShiftRight, Value::Count(a), Value::Count(b)) => Value::Count(a >> b),
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
