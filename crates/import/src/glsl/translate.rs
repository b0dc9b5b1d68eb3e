//! From naga's representation of a shader to functions of Starlark.
//!
//! The front end has resolved names, overloads, macros, swizzles that are written and arguments that are given back; what is left are typed
//! expressions, and statements with loads and stores. Each function becomes a function, each of its variables a variable. Expressions are
//! written where they are used, unless a variable that they read is stored in between: then they get a name first.
//!
//! The scene language tells values of a formula from plain numbers, and a tuple of plain numbers is no vector to it. So each function is
//! looked at for what its arguments are (binding times; Jones, Gomard and Sestoft 1993): vectors that may be plain are
//! computed part by part.

use super::GlslError;
use naga::{
    BinaryOperator, Block, Expression as E, Function, Handle, LocalVariable, MathFunction as M,
    Module, Span, Statement as S, Type, TypeInner,
};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// How often a loop runs at most whose count is not written down.
pub(super) const MOST_ROUNDS: u32 = 1000;

/// Whether a value depends on the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Time {
    /// Nothing is known yet.
    Unset,
    /// A number, or a tuple of numbers.
    Plain,
    /// A value of the formula.
    Formula,
    /// The one or the other.
    Mixed,
}

impl Time {
    /// Of one of two values.
    pub(super) fn either(self, other: Time) -> Time {
        match (self, other) {
            (Time::Unset, x) | (x, Time::Unset) => x,
            (a, b) if a == b => a,
            _ => Time::Mixed,
        }
    }

    /// Of what is made of two values.
    pub(super) fn with(self, other: Time) -> Time {
        match (self, other) {
            (Time::Formula, _) | (_, Time::Formula) => Time::Formula,
            (Time::Unset, _) | (_, Time::Unset) => Time::Unset,
            (Time::Mixed, _) | (_, Time::Mixed) => Time::Mixed,
            _ => Time::Plain,
        }
    }

    /// Of a value that is only stored, or given back, where a condition of the point holds.
    pub(super) fn where_it_holds(self) -> Time {
        if self == Time::Plain {
            Time::Mixed
        } else {
            self
        }
    }
}

/// A text, and how tightly its operator binds.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub text: String,
    pub binds: u8,
}

pub(super) const CHOICE: u8 = 0;
pub(super) const OR: u8 = 1;
pub(super) const AND: u8 = 2;
pub(super) const NOT: u8 = 3;
pub(super) const COMPARED: u8 = 4;
pub(super) const SUM: u8 = 5;
pub(super) const PRODUCT: u8 = 6;
pub(super) const SIGN: u8 = 7;
pub(super) const ATOM: u8 = 9;

pub(super) fn atom(text: impl Into<String>) -> Text {
    Text {
        text: text.into(),
        binds: ATOM,
    }
}

pub(super) fn bound(text: impl Into<String>, binds: u8) -> Text {
    Text {
        text: text.into(),
        binds,
    }
}

impl Text {
    /// In parentheses, if it binds less than this.
    pub(super) fn within(&self, least: u8) -> String {
        if self.binds < least {
            format!("({})", self.text)
        } else {
            self.text.clone()
        }
    }

    pub(super) fn is_simple(&self) -> bool {
        self.text
            .chars()
            .all(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']'))
    }
}

/// What a function gives, for arguments of some kind.
#[derive(Clone, Debug)]
pub(super) struct Summary {
    pub result: Time,
    /// What its arguments are afterwards.
    pub after: Vec<Time>,
}

/// What is known of an expression or variable of a function, for arguments of some kind.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Times {
    pub expressions: Vec<Time>,
    pub variables: Vec<Time>,
    pub arguments: Vec<Time>,
    pub result: Time,
}

/// What does not depend on what the arguments are.
pub(super) struct Facts {
    /// Types.
    pub inner: Vec<TypeInner>,
    /// How often an expression is written where it is not given a name.
    pub uses: Vec<u32>,
    /// The last statement that needs it, in their order.
    pub last: Vec<u32>,
    /// The statement that emits it.
    last_emitted: Vec<u32>,
    /// The last statement that needs what is read from a variable.
    pub last_read: HashMap<Root, u32>,
    /// Variables that arguments are copied to at the beginning, under the same name.
    pub copied: HashMap<Handle<LocalVariable>, u32>,
    pub returns: u32,
}

/// What a pointer leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Root {
    Local(Handle<LocalVariable>),
    Argument(u32),
    Global(Handle<naga::GlobalVariable>),
}

/// A step from a variable to a part of it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Index(u32),
    Dynamic(Handle<E>),
}

type Key = (Handle<Function>, Vec<Time>);
pub(super) type Result<T> = std::result::Result<T, GlslError>;

/// Writes functions down.
pub(crate) struct Translator<'m> {
    pub(super) module: &'m Module,
    pub(super) facts: HashMap<Handle<Function>, Facts>,
    pub summaries: HashMap<Key, Summary>,
    /// Names of functions that are written.
    written: HashMap<Key, String>,
    /// Their texts, those first that others call.
    pub functions: Vec<String>,
    texts: HashMap<(Handle<Function>, Vec<String>), String>,
    pub open: Vec<Handle<Function>>,
    pub(super) taken: HashSet<String>,
    /// Constants and variables of the shader that are read, in the order of the shader.
    pub constants: BTreeMap<u32, (String, String)>,
    pub(super) globals: HashMap<Handle<naga::GlobalVariable>, String>,
    pub(super) global_constants: HashMap<Handle<naga::Constant>, String>,
    pub helpers: BTreeSet<&'static str>,
    /// What the person should know.
    pub notes: Vec<String>,
    pub(super) uniforms: Vec<String>,
    pub(super) ignored: HashSet<Handle<naga::GlobalVariable>>,
}

/// A function that is being written.
pub(super) struct Writer<'f> {
    pub handle: Handle<Function>,
    pub function: &'f Function,
    pub times: Times,
    /// Steps of indentation, and text.
    pub lines: Vec<(usize, String)>,
    pub indent: usize,
    pub names: HashMap<Handle<LocalVariable>, String>,
    pub arguments: Vec<String>,
    pub taken: HashSet<String>,
    /// Texts of expressions that have one of their own: a name, or a call.
    pub cache: HashMap<Handle<E>, Text>,
    /// What was read from variables and is not written yet, with those.
    pub pending: Vec<(Handle<E>, HashSet<Root>)>,
    /// Variables of the front end's own that stand for a text.
    pub alias: HashMap<Handle<LocalVariable>, (Text, HashSet<Root>)>,
    /// The number of the statement.
    pub at: u32,
    pub loops: Vec<Round>,
    /// The parts that the last line stores.
    pub parts: Option<Parts>,
    /// Variables without a value so far.
    pub unset: HashSet<Handle<LocalVariable>>,
}

/// Parts of a vector that were stored one after the other.
pub(super) struct Parts {
    pub root: Root,
    pub texts: Vec<Option<String>>,
    /// Whether it had no value before.
    pub is_fresh: bool,
    /// The line that stores them.
    pub line: usize,
}

impl Writer<'_> {
    pub(super) fn line(&mut self, text: String) {
        self.lines.push((self.indent, text));
    }

    pub(super) fn fresh(&mut self, wanted: &str) -> String {
        Translator::free(&mut self.taken, wanted)
    }
}

/// A loop that is being written.
pub(super) struct Round {
    /// Name of the flag that is false once the loop is left.
    pub running: Option<String>,
    /// Name of the flag that is false once the round is over.
    pub here: Option<String>,
}

impl Round {
    /// What tells whether the round goes on.
    pub(super) fn flag(&self) -> Option<&String> {
        self.here.as_ref().or(self.running.as_ref())
    }
}

const RESERVED: &[&str] = &[
    "and", "as", "assert", "async", "await", "break", "class", "continue", "def", "del", "elif",
    "else", "except", "finally", "for", "from", "global", "if", "import", "in", "is", "lambda",
    "load", "nonlocal", "not", "or", "pass", "raise", "return", "try", "while", "with", "yield",
    "None", "True", "False",
];

/// Names that what is written uses, beside those of the shader.
const USED: &[&str] = &[
    "abs",
    "acos",
    "asin",
    "atan",
    "atan2",
    "camera",
    "ceil",
    "clamp",
    "cos",
    "cosh",
    "cross",
    "degrees",
    "distance",
    "dot",
    "exp",
    "exp2",
    "field",
    "floor",
    "fract",
    "int",
    "inversesqrt",
    "length",
    "log",
    "log2",
    "material",
    "max",
    "min",
    "mix",
    "mod",
    "normalize",
    "part",
    "pow",
    "radians",
    "range",
    "reflect",
    "round",
    "show",
    "sign",
    "sin",
    "sinh",
    "sky",
    "smoothstep",
    "sqrt",
    "step",
    "sun",
    "tan",
    "tanh",
    "time",
    "trunc",
    "vec2",
    "vec3",
    "vec4",
    "apply_matrix",
    "apply_transposed",
    "multiply_matrices",
    "transposed",
    "remainder",
    "hsv",
    "rgb",
    "vector",
    "sum",
    "len",
    "soft",
];

pub(super) fn number(value: f64) -> String {
    if value.is_infinite() {
        return if value > 0.0 {
            "1e30".into()
        } else {
            "-1e30".into()
        };
    }
    if value.is_nan() {
        return "0.0".into();
    }
    format!("{value:?}")
}

/// The shortest text of a number of single precision.
pub(super) fn single(value: f32) -> String {
    if value.is_finite() {
        format!("{value:?}")
    } else {
        number(f64::from(value))
    }
}

impl<'m> Translator<'m> {
    pub(crate) fn new(module: &'m Module, uniforms: &[String]) -> Translator<'m> {
        let mut taken: HashSet<String> = RESERVED
            .iter()
            .chain(USED)
            .map(|s| (*s).to_owned())
            .collect();
        taken.insert("pi".into());
        Translator {
            module,
            facts: HashMap::new(),
            summaries: HashMap::new(),
            written: HashMap::new(),
            functions: Vec::new(),
            texts: HashMap::new(),
            open: Vec::new(),
            taken,
            constants: BTreeMap::new(),
            globals: HashMap::new(),
            global_constants: HashMap::new(),
            helpers: BTreeSet::new(),
            notes: Vec::new(),
            uniforms: uniforms.to_vec(),
            ignored: HashSet::new(),
        }
    }

    pub(super) fn refuse<T>(
        &self,
        span: Span,
        what: impl Into<String>,
        help: impl Into<String>,
    ) -> Result<T> {
        Err(GlslError::unsupported(span, what, help))
    }

    /// Finds variables of the whole shader that are set and whose values never reach anything else: what shading wants to know.
    pub(crate) fn find_ignored(&mut self) {
        for (g, _) in self.module.global_variables.iter() {
            let is_needed = self
                .module
                .functions
                .iter()
                .any(|(_, function)| self.is_needed(function, g));
            if !is_needed {
                self.ignored.insert(g);
            }
        }
    }

    fn is_needed(&self, function: &Function, g: Handle<naga::GlobalVariable>) -> bool {
        let is_it = |pointer: Handle<E>| matches!(self.path(function, pointer), Some((Root::Global(x), _)) if x == g);
        let mut made = vec![false; function.expressions.len()];
        for (h, expression) in function.expressions.iter() {
            made[h.index()] = match expression {
                E::Load { pointer } => is_it(*pointer),
                _ => self.operands(function, h).iter().any(|o| made[o.index()]),
            };
        }
        fn any(block: &Block, check: &dyn Fn(&S) -> bool) -> bool {
            block
                .iter()
                .any(|s| check(s) || blocks(s).into_iter().any(|b| any(b, check)))
        }
        any(&function.body, &|statement| match statement {
            S::If { condition, .. } => made[condition.index()],
            S::Return { value: Some(value) } => made[value.index()],
            S::Store { pointer, value } => made[value.index()] && !is_it(*pointer),
            S::Call { arguments, .. } => arguments.iter().any(|a| made[a.index()] || is_it(*a)),
            S::Switch { selector, .. } => made[selector.index()],
            _ => false,
        })
    }

    /// Zero of the type, or of what it points to.
    pub(crate) fn zero_of(&self, ty: Handle<Type>) -> String {
        match self.module.types[ty].inner {
            TypeInner::Pointer { base, .. } => self.zero(base),
            _ => self.zero(ty),
        }
    }

    pub(crate) fn free_name(&mut self, wanted: &str) -> String {
        Self::free(&mut self.taken, wanted)
    }

    /// A name like this one that is free.
    pub(super) fn free(taken: &mut HashSet<String>, wanted: &str) -> String {
        let clean: String = wanted
            .chars()
            .filter(|c| c.is_ascii_alphanumeric() || *c == '_')
            .collect();
        let clean = match clean.chars().next() {
            None => "value".to_owned(),
            Some(c) if c.is_ascii_digit() || c == '_' => format!("v{clean}"),
            Some(_) => clean,
        };
        if taken.insert(clean.clone()) {
            return clean;
        }
        let mut k = 2;
        loop {
            let next = format!("{clean}_{k}");
            if taken.insert(next.clone()) {
                return next;
            }
            k += 1;
        }
    }

    /// Writes a function, for arguments of these kinds; its name.
    pub(crate) fn function(
        &mut self,
        handle: Handle<Function>,
        arguments: &[Time],
    ) -> Result<String> {
        let key = (handle, arguments.to_vec());
        if let Some(name) = self.written.get(&key) {
            return Ok(name.clone());
        }
        let times = self.times(handle, arguments)?;
        let function = &self.module.functions[handle];
        let (parameters, lines) = self.body(handle, function, times)?;
        // what is the same for other arguments is written once
        let same = (handle, lines.clone());
        if let Some(name) = self.texts.get(&same) {
            self.written.insert(key, name.clone());
            return Ok(name.clone());
        }
        let wanted = function.name.clone().unwrap_or_else(|| "function".into());
        let name = Self::free(&mut self.taken, &wanted);
        let mut text = format!("def {name}({}):\n", parameters.join(", "));
        for line in &lines {
            text += line;
            text.push('\n');
        }
        self.functions.push(text);
        self.texts.insert(same, name.clone());
        self.written.insert(key, name.clone());
        Ok(name)
    }

    /// Types, uses and places of a function's expressions.
    pub(super) fn learn(&mut self, handle: Handle<Function>) -> Result<()> {
        if self.facts.contains_key(&handle) {
            return Ok(());
        }
        let function = &self.module.functions[handle];
        let context = naga::proc::ResolveContext::with_locals(
            self.module,
            &function.local_variables,
            &function.arguments,
        );
        let mut typifier = naga::front::Typifier::new();
        for (h, _) in function.expressions.iter() {
            typifier
                .grow(h, &function.expressions, &context)
                .map_err(|error| {
                    GlslError::unsupported(
                        function.expressions.get_span(h),
                        format!("the type of this is not known: {error}"),
                        "write it in another way",
                    )
                })?;
        }
        let inner: Vec<TypeInner> = function
            .expressions
            .iter()
            .map(|(h, _)| typifier.get(h, &self.module.types).clone())
            .collect();
        let n = function.expressions.len();
        let mut facts = Facts {
            inner,
            uses: vec![0; n],
            last: vec![0; n],
            last_emitted: vec![0; n],
            last_read: HashMap::new(),
            copied: HashMap::new(),
            returns: 0,
        };
        let mut at = 0;
        self.count_block(function, &function.body, &mut at, &mut facts);
        // uses of operands follow from those of what they are in, which stands behind them
        for (h, _) in function
            .expressions
            .iter()
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
        {
            if facts.uses[h.index()] == 0 {
                continue;
            }
            // what gets a name needs its operands no more from there on
            let is_named = facts.uses[h.index()] > 1 && gets_a_name(&function.expressions[h]);
            let last = if is_named {
                facts.last_emitted[h.index()]
            } else {
                facts.last[h.index()]
            };
            for operand in self.operands(function, h) {
                facts.uses[operand.index()] += 1;
                facts.last[operand.index()] = facts.last[operand.index()].max(last);
            }
            if let E::Load { pointer } = function.expressions[h]
                && let Some((root, _)) = self.path(function, pointer)
            {
                let read = facts.last_read.entry(root).or_default();
                *read = (*read).max(last);
            }
        }
        // copies of arguments that a function may change
        for statement in &function.body {
            if let S::Store { pointer, value } = statement
                && let (E::LocalVariable(local), E::FunctionArgument(k)) = (
                    &function.expressions[*pointer],
                    &function.expressions[*value],
                )
                && function.local_variables[*local].name == function.arguments[*k as usize].name
            {
                facts.copied.entry(*local).or_insert(*k);
            }
        }
        self.facts.insert(handle, facts);
        Ok(())
    }

    fn count_block(&self, function: &Function, block: &Block, at: &mut u32, facts: &mut Facts) {
        let _ = function;
        for statement in block {
            *at += 1;
            let here = *at;
            let mut used = |h: Handle<E>| {
                facts.uses[h.index()] += 1;
                facts.last[h.index()] = facts.last[h.index()].max(here);
            };
            match statement {
                S::Emit(range) => range
                    .clone()
                    .for_each(|h| facts.last_emitted[h.index()] = here),
                S::If { condition, .. } => used(*condition),
                S::Loop {
                    break_if: Some(h), ..
                } => used(*h),
                S::Switch { selector, .. } => used(*selector),
                S::Store { pointer, value } => [*pointer, *value].into_iter().for_each(used),
                S::Call { arguments, .. } => arguments.iter().copied().for_each(used),
                S::Return { value } => {
                    value.iter().copied().for_each(used);
                    facts.returns += 1;
                }
                _ => {}
            }
            for inner in blocks(statement) {
                self.count_block(function, inner, at, facts);
            }
        }
    }

    /// The operands of an expression, as it is written.
    pub(super) fn operands(&self, function: &Function, h: Handle<E>) -> Vec<Handle<E>> {
        if let Some((x, y)) = modulo(function, h) {
            return vec![x, y];
        }
        match &function.expressions[h] {
            E::Compose { components, .. } => components.clone(),
            E::Access { base, index } => vec![*base, *index],
            E::AccessIndex { base, .. } => vec![*base],
            E::Splat { value, .. } => vec![*value],
            E::Swizzle { vector, .. } => vec![*vector],
            E::Load { pointer } => vec![*pointer],
            E::Unary { expr, .. } | E::As { expr, .. } => vec![*expr],
            E::Binary { left, right, .. } => vec![*left, *right],
            E::Select {
                condition,
                accept,
                reject,
            } => vec![*condition, *accept, *reject],
            E::Relational { argument, .. } => vec![*argument],
            E::Math {
                arg,
                arg1,
                arg2,
                arg3,
                ..
            } => [Some(*arg), *arg1, *arg2, *arg3]
                .into_iter()
                .flatten()
                .collect(),
            E::Derivative { expr, .. } => vec![*expr],
            _ => Vec::new(),
        }
    }

    pub(super) fn path(
        &self,
        function: &Function,
        pointer: Handle<E>,
    ) -> Option<(Root, Vec<Step>)> {
        match &function.expressions[pointer] {
            E::LocalVariable(v) => Some((Root::Local(*v), Vec::new())),
            E::GlobalVariable(v) => Some((Root::Global(*v), Vec::new())),
            E::FunctionArgument(k) => Some((Root::Argument(*k), Vec::new())),
            E::AccessIndex { base, index } => {
                let (root, mut steps) = self.path(function, *base)?;
                steps.push(Step::Index(*index));
                Some((root, steps))
            }
            E::Access { base, index } => {
                let (root, mut steps) = self.path(function, *base)?;
                steps.push(match function.expressions[*index] {
                    E::Literal(naga::Literal::I32(k)) if k >= 0 => Step::Index(k as u32),
                    E::Literal(naga::Literal::U32(k)) => Step::Index(k),
                    _ => Step::Dynamic(*index),
                });
                Some((root, steps))
            }
            _ => None,
        }
    }

    pub(super) fn is_pointer(&self, ty: Handle<Type>) -> bool {
        matches!(
            self.module.types[ty].inner,
            TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. }
        )
    }
}

/// The blocks in a statement.
pub(super) fn blocks(statement: &S) -> Vec<&Block> {
    match statement {
        S::If { accept, reject, .. } => vec![accept, reject],
        S::Block(inner) => vec![inner],
        S::Loop {
            body, continuing, ..
        } => vec![body, continuing],
        S::Switch { cases, .. } => cases.iter().map(|c| &c.body).collect(),
        _ => Vec::new(),
    }
}

/// Whether an expression that is used more than once is given a name.
pub(super) fn gets_a_name(expression: &E) -> bool {
    matches!(
        expression,
        E::Binary { .. }
            | E::Math { .. }
            | E::Compose { .. }
            | E::Select { .. }
            | E::Unary { .. }
            | E::Relational { .. }
    )
}

/// `x - y * floor(x / y)`, which `mod(x, y)` was.
pub(super) fn modulo(function: &Function, h: Handle<E>) -> Option<(Handle<E>, Handle<E>)> {
    let E::Binary {
        op: BinaryOperator::Subtract,
        left: x,
        right,
    } = function.expressions[h]
    else {
        return None;
    };
    let E::Binary {
        op: BinaryOperator::Multiply,
        left: a,
        right: b,
    } = function.expressions[right]
    else {
        return None;
    };
    [(a, b), (b, a)].into_iter().find_map(|(y, whole)| {
        let E::Math {
            fun: M::Floor, arg, ..
        } = function.expressions[whole]
        else {
            return None;
        };
        let E::Binary {
            op: BinaryOperator::Divide,
            left,
            right,
        } = function.expressions[arg]
        else {
            return None;
        };
        (left == x && right == y).then_some((x, y))
    })
}
