//! Prints recorded functions as WGSL.
//!
//! The functions read their parameters from `params`, an `array<f32>` (or a storage buffer of one), and samples of grids through
//! `grid_sample(grid: f32, node: vec3f) -> f32`; the shader declares both.

use super::real::{Ends, MOST_STEPS};
use super::record::{
    Argument, Binary, Comparison, Function, Id, Logic, Loop, Op, Statement, Turns, Unary,
};
use super::wgsl_words::{PREDECLARED, RESERVED};
use std::fmt::Write;

/// The function as WGSL source: a function that returns `f32`, `vec2f`, `vec3f`, `vec4f` or `mat3x4f`.
///
/// Infinite literals, which WGSL does not have, become the largest finite number.
pub fn print(function: &Function) -> String {
    let mut printer = Printer {
        function,
        offset: String::new(),
        out: String::new(),
        depth: 1,
    };
    let arguments: Vec<String> = function
        .arguments()
        .iter()
        .map(|(name, kind)| format!("{}: {}", identifier(name), argument_type(*kind)))
        .collect();
    for (name, kind) in function.arguments() {
        if *kind == Argument::Offset {
            printer.offset = format!("{} + ", identifier(name));
        }
    }
    let results: Vec<String> = function
        .results()
        .iter()
        .map(|id| printer.name(*id))
        .collect();
    let (kind, result) = match results.as_slice() {
        [one] => ("f32".to_owned(), one.clone()),
        many => {
            let kind = match many.len() {
                12 => "mat3x4f".to_owned(),
                n => format!("vec{n}f"),
            };
            (kind.clone(), format!("{kind}({})", many.join(", ")))
        }
    };
    printer.block(function.body());
    printer.line(&format!("return {result};"));
    format!(
        "fn {}({}) -> {kind} {{\n{}}}\n",
        identifier(function.name()),
        arguments.join(", "),
        printer.out
    )
}

/// The name that a recorded function or argument has in WGSL: its own, with an underscore behind it if WGSL has another
/// use for it or the printer has. Different names stay different.
pub fn identifier(name: &str) -> String {
    let local = name
        .strip_prefix(LOCALS)
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    if local || name == PARAMS || name == GRID || name.ends_with('_') || is_word(name) {
        format!("{name}_")
    } else {
        name.to_owned()
    }
}

fn is_word(name: &str) -> bool {
    RESERVED.binary_search(&name).is_ok() || PREDECLARED.binary_search(&name).is_ok()
}

fn argument_type(kind: Argument) -> &'static str {
    match kind {
        Argument::Number => "f32",
        Argument::Vec2 => "vec2f",
        Argument::Vec3 => "vec3f",
        Argument::Vec4 => "vec4f",
        Argument::Mat3x4 => "mat3x4f",
        Argument::Offset => "u32",
    }
}

fn literal(bits: u32) -> String {
    let x = f32::from_bits(bits).clamp(-f32::MAX, f32::MAX);
    // Rust's shortest form has a point or an exponent, so that it is no integer in WGSL either
    if x.is_sign_negative() {
        format!("({x:?}f)")
    } else {
        format!("{x:?}f")
    }
}

struct Printer<'a> {
    function: &'a Function,
    /// What parameter indices are added to.
    offset: String,
    out: String,
    depth: usize,
}

impl Printer<'_> {
    fn line(&mut self, text: &str) {
        let indent = 4 * self.depth;
        // writing to a string cannot fail
        let _ = writeln!(self.out, "{:indent$}{text}", "");
    }

    /// How a value is written where it is used.
    fn name(&self, id: Id) -> String {
        match self.function.op(id) {
            Op::Literal(bits) => literal(*bits),
            Op::Input(input) => {
                let (base, component) =
                    input.split_at(input.find(['.', '[']).unwrap_or(input.len()));
                format!("{}{component}", identifier(base))
            }
            Op::State(of, index) => state_name(of.number(), *index),
            _ => format!("v{}", id.number()),
        }
    }

    fn param(&self, at: u32) -> String {
        format!("{PARAMS}[{}{at}u]", self.offset)
    }

    /// How a value is computed.
    fn expression(&self, op: &Op) -> String {
        let n = |id: &Id| self.name(*id);
        match op {
            Op::Literal(bits) => literal(*bits),
            Op::Input(input) => input.clone(),
            Op::State(of, index) => state_name(of.number(), *index),
            Op::Param(at) => self.param(*at),
            Op::Item {
                of,
                next,
                component,
            } => {
                let which = if *next { 'b' } else { 'a' };
                format!("{PARAMS}[{which}{} + {component}u]", of.number())
            }
            Op::Fetch(grid, [x, y, z]) => {
                format!("{GRID}({}, vec3f({}, {}, {}))", n(grid), n(x), n(y), n(z))
            }
            Op::Copy(a) => n(a),
            Op::Unary(f, a) => match unary(*f) {
                "-" => format!("-{}", n(a)),
                f => format!("{f}({})", n(a)),
            },
            Op::Binary(f, a, b) => match binary(*f) {
                f @ ("+" | "-" | "*" | "/") => format!("{} {f} {}", n(a), n(b)),
                f => format!("{f}({}, {})", n(a), n(b)),
            },
            Op::Length(v) => {
                let components: Vec<String> = v.iter().map(n).collect();
                format!("length(vec{}f({}))", v.len(), components.join(", "))
            }
            Op::Compare(f, a, b) => {
                let f = match f {
                    Comparison::Below => "<",
                    Comparison::Above => ">",
                };
                format!("{} {f} {}", n(a), n(b))
            }
            Op::Logic(f, a, b) => {
                let f = match f {
                    Logic::And => "&",
                    Logic::Or => "|",
                };
                format!("{} {f} {}", n(a), n(b))
            }
            Op::Not(a) => format!("!{}", n(a)),
            Op::Select(m, yes, no) => format!("select({}, {}, {})", n(no), n(yes), n(m)),
        }
    }

    fn block(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Compute(id) => {
                    let value = self.expression(self.function.op(*id));
                    self.line(&format!("let {} = {value};", self.name(*id)));
                }
                Statement::BreakUnless(id) => {
                    self.line(&format!("if (!{}) {{ break; }}", self.name(*id)));
                }
                Statement::Loop(l) => self.repeat(l),
            }
        }
    }

    fn repeat(&mut self, l: &Loop) {
        let id = l.id.number();
        for (index, state) in &l.states {
            let init = self.name(state.init);
            self.line(&format!("var {}: f32 = {init};", state_name(id, *index)));
        }
        let (count, first) = match &l.turns {
            Turns::Fixed(n) => (format!("{n}u"), 0),
            Turns::Number(n) => (whole(&self.name(*n)), 0),
            Turns::Items { at, ends, .. } => {
                // an open list has no pair that ends with its first item
                (whole(&self.param(*at)), u32::from(*ends == Ends::Open))
            }
            Turns::Nodes { at, .. } => (whole(&self.param(*at)), 0),
            Turns::Slice { count, .. } => (whole(&self.name(*count)), 0),
        };
        self.line(&format!("let n{id} = {count};"));
        if let Turns::Nodes { .. } = &l.turns {
            self.line(&format!("var i{id} = {first}u;"));
            self.line(&format!("while (i{id} < n{id}) {{"));
        } else {
            self.line(&format!(
                "for (var i{id} = {first}u; i{id} < n{id}; i{id}++) {{"
            ));
        }
        self.depth += 1;
        if let Turns::Nodes { at, width } = &l.turns {
            let nodes = format!("{}{}u", self.offset, at + 1);
            self.line(&format!("let a{id} = {nodes} + i{id} * {width}u;"));
        }
        if let Turns::Slice {
            at,
            nodes,
            width,
            first,
            ..
        } = &l.turns
        {
            let (begin, count) = (at + 1, whole(&self.param(*at)));
            let items = format!("{}{begin}u + {count} * {nodes}u", self.offset);
            let first = whole(&self.name(*first));
            self.line(&format!(
                "let a{id} = {items} + ({first} + i{id}) * {width}u;"
            ));
        }
        if let Turns::Items { at, width, .. } = &l.turns {
            let items = format!("{}{}u", self.offset, at + 1);
            self.line(&format!(
                "let a{id} = {items} + (i{id} + n{id} - 1u) % n{id} * {width}u;"
            ));
            self.line(&format!("let b{id} = {items} + i{id} * {width}u;"));
        }
        self.block(&l.body);
        for (index, state) in &l.states {
            let (name, next) = (state_name(id, *index), self.name(state.next));
            if next != name {
                self.line(&format!("{name} = {next};"));
            }
        }
        if let Turns::Nodes { width, .. } = &l.turns {
            let last = width - 1;
            let over = format!("u32(clamp({PARAMS}[a{id} + {last}u], 1.0f, {MOST_STEPS}.0f))");
            let on = match l.enters {
                Some(enters) => format!("select({over}, 1u, {})", self.name(enters)),
                None => over,
            };
            self.line(&format!("i{id} += {on};"));
        }
        self.depth -= 1;
        self.line("}");
    }
}

/// A count from a number: the conversion of what does not fit is left open by some GPUs.
fn whole(number: &str) -> String {
    format!("u32(clamp({number}, 0.0f, {MOST_STEPS}.0f))")
}

fn state_name(of: u32, index: u32) -> String {
    format!("s{of}_{index}")
}

fn unary(f: Unary) -> &'static str {
    match f {
        Unary::Neg => "-",
        Unary::Abs => "abs",
        Unary::Sqrt => "sqrt",
        Unary::Floor => "floor",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Exp => "exp",
        Unary::Exp2 => "exp2",
        Unary::Ln => "log",
    }
}

fn binary(f: Binary) -> &'static str {
    match f {
        Binary::Add => "+",
        Binary::Sub => "-",
        Binary::Mul => "*",
        Binary::Div => "/",
        Binary::Min => "min",
        Binary::Max => "max",
        Binary::Atan2 => "atan2",
        Binary::Pow => "pow",
    }
}

/// The array that parameters are read from.
const PARAMS: &str = "params";

/// The function that samples of grids come from: of a grid's number and a node, both whole numbers.
const GRID: &str = "grid_sample";

/// Letters that, with a digit behind them, begin the names of values, states, counters, counts and items.
const LOCALS: [char; 6] = ['v', 's', 'i', 'n', 'a', 'b'];
