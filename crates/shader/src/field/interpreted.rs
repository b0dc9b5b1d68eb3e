//! The field as data: a loop over the instructions.
//!
//! `code` is a head of four words (where the values' instructions end and where their result is, the same for marks) and
//! the instructions of both, three words each: operation and result, operands, parameters. Points and values are numbered
//! apart. Where marks are the same everywhere there are no instructions for them, and the head holds the numbers of the
//! object and the material, plus one.

use super::{
    FieldSource, Functions, MARKS, Operand, Registers, colours, has_traps, memory, name, places,
    plain_marks, steps,
};
use crate::field::recorded::Form;
use std::collections::BTreeMap;
use std::fmt::Write;
use zeroset_catalogue::tape::{Code, Instruction, Operation};
use zeroset_field::program::Structure;

/// Words before the first instruction.
pub(super) const HEAD: u32 = 4;
/// Words of an instruction.
pub(super) const WORDS: u32 = 3;

pub(super) fn source(structure: &Structure, place: Registers) -> FieldSource {
    let (marked, result) = steps(&structure.marks);
    let plain = match result {
        Operand::Step(i) => plain_marks(&marked)[i],
        Operand::Input => None,
    };
    let lists = match plain {
        Some(_) => vec![&structure.values],
        None => vec![&structure.values, &structure.marks],
    };
    let operations = Operations::of(&lists);
    let mut code = vec![0; HEAD as usize];
    let mut registers = [FEWEST_POINTS, FEWEST_VALUES];
    for (k, list) in lists.iter().enumerate() {
        let points = points(list);
        code.extend((list.instructions.iter()).flat_map(|i| operations.words(i, points, place)));
        if place == Registers::Memory {
            // what fills the last turn up does nothing
            let missing = list.instructions.len().wrapping_neg() % memory::UNROLLED as usize;
            code.extend([memory::NOTHING, 0, 0].repeat(missing));
        }
        code[2 * k] = code.len() as u32;
        code[2 * k + 1] = u32::from(list.result) - 3 * points;
        let values = u32::from(list.registers) - 3 * points;
        registers = [registers[0].max(points), registers[1].max(values)];
    }
    if let Some(plain) = plain {
        let number = |n: Option<u16>| n.map_or(0, |n| u32::from(n) + 1);
        code[2] = number(plain.object);
        code[3] = number(plain.material);
    }
    let registers = registers.map(u32::next_power_of_two);
    let text = match place {
        Registers::Private => text,
        Registers::Memory => memory::text,
    };
    FieldSource {
        text: text(structure, &operations, registers, plain.is_none()),
        code,
        registers: words(registers),
    }
}

/// Words that registers take: those for gradients, or those for marks.
fn words([points, values]: [u32; 2]) -> u32 {
    (12 * points + 4 * values).max(3 * points + 9 * values)
}

/// Room for registers, in powers of two from these on, so that programs share shaders.
const FEWEST_POINTS: u32 = 4;
const FEWEST_VALUES: u32 = 16;

/// How many registers hold points; they come first, and each is written by a step but the first.
fn points(code: &Code) -> u32 {
    let written = (code.instructions.iter())
        .filter(|i| matches!(i.operation, Operation::Warp(_) | Operation::Put(_)))
        .map(|i| u32::from(i.out) / 3);
    written.max().unwrap_or(0) + 1
}

/// The operations that a program uses, by name, with the numbers that they have in `code`. Marks come behind them.
pub(super) struct Operations(BTreeMap<String, (u32, Operation)>);

impl Operations {
    fn of(lists: &[&Code]) -> Operations {
        let used: BTreeMap<String, Operation> = (lists.iter())
            .flat_map(|list| &list.instructions)
            .filter(|i| !matches!(i.operation, Operation::Mark(..)))
            .map(|i| (name(i.operation, Form::Value), i.operation))
            .collect();
        let numbered = (0..).zip(used).map(|(n, (name, o))| (name, (n, o)));
        Operations(numbered.collect())
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, Operation)> {
        self.0.values().copied()
    }

    /// Numbers of the two marks: material, object.
    pub(super) fn marks(&self) -> [u32; 2] {
        let n = self.0.len() as u32;
        [n, n + 1]
    }

    fn words(&self, i: &Instruction, points: u32, place: Registers) -> [u32; WORDS as usize] {
        let point = |r: u16| u32::from(r) / 3;
        let value = |r: u16| u32::from(r) - 3 * points;
        let (number, at) = match i.operation {
            Operation::Mark(kind, number) => {
                (self.marks()[usize::from(kind != 0)], u32::from(number))
            }
            operation => (self.0[&name(operation, Form::Value)].0, i.at),
        };
        let (out, a, b) = match i.operation {
            // points are read in one place from memory: that of a change
            Operation::Leaf(_) if place == Registers::Memory => (value(i.out), 0, point(i.a)),
            Operation::Warp(_) if place == Registers::Memory => (point(i.out), 0, point(i.a)),
            Operation::Leaf(_) => (value(i.out), point(i.a), 0),
            Operation::Warp(_) => (point(i.out), point(i.a), 0),
            Operation::Put(_) => (point(i.out), value(i.a), point(i.b)),
            Operation::Change(_) => (value(i.out), value(i.a), point(i.b)),
            Operation::Pair(_) => (value(i.out), value(i.a), value(i.b)),
            Operation::Mark(..) => (value(i.out), value(i.a), 0),
        };
        [number | out << 16, a | b << 16, at]
    }
}

fn text(
    structure: &Structure,
    operations: &Operations,
    [points, values]: [u32; 2],
    with_marks: bool,
) -> String {
    let mut functions = Functions::default();
    let value_step = step(operations, &mut functions, Form::Value);
    let gradient_step = step(operations, &mut functions, Form::Gradient);
    let marks = if with_marks {
        format!(
            "var<private> field_marked: array<Marks, {values}>;\n\n{}",
            marks(operations, &mut functions)
        )
    } else {
        PLAIN_MARKS.into()
    };
    let places =
        places::text(structure, &mut functions) + &colours::text(structure, &mut functions);
    let functions = functions.print();
    // not local to the functions: those would be cleared in each call
    let registers = format!(
        "var<private> field_points: array<vec3f, {points}>;
var<private> field_values: array<f32, {values}>;
var<private> field_dual_points: array<mat3x4f, {points}>;
var<private> field_duals: array<vec4f, {values}>;
"
    );
    let value = run("field", "f32", "field_values");
    let gradient = run("field_gradient", "vec4f", "field_duals");
    format!(
        "{MARKS}\n{functions}\n{FETCH}\n{registers}\n{value_step}\n{value}\n{gradient_step}\n{gradient}\n{marks}\n{places}"
    )
}

/// The function that carries out one instruction.
fn step(operations: &Operations, functions: &mut Functions, form: Form) -> String {
    let (name, points, values) = match form {
        Form::Gradient => ("field_gradient_step", "field_dual_points", "field_duals"),
        _ => ("field_step", "field_points", "field_values"),
    };
    let mut out =
        format!("fn {name}(instruction: FieldStep) {{\n    switch instruction.operation {{\n");
    for (number, operation) in operations.iter() {
        let (to, operands) = match operation {
            Operation::Leaf(_) => (values, format!("{points}[instruction.a]")),
            Operation::Warp(_) => (points, format!("{points}[instruction.a]")),
            Operation::Put(_) | Operation::Change(_) => (
                match operation {
                    Operation::Put(_) => points,
                    _ => values,
                },
                format!("{values}[instruction.a], {points}[instruction.b]"),
            ),
            Operation::Pair(_) | Operation::Mark(..) => (
                values,
                format!("{values}[instruction.a], {values}[instruction.b]"),
            ),
        };
        let f = functions.name(operation, form);
        // writing to a string cannot fail
        let _ = writeln!(
            out,
            "        case {number}u: {{ {to}[instruction.out] = {f}({operands}, instruction.at); }}"
        );
    }
    // marks leave values as they are; there are none among the instructions for gradients
    let rest = match form {
        Form::Gradient => "{}".into(),
        _ => format!("{{ {values}[instruction.out] = {values}[instruction.a]; }}"),
    };
    out + &format!("        default: {rest}\n    }}\n}}\n")
}

/// `field` and `field_gradient`.
fn run(name: &str, result: &str, values: &str) -> String {
    let (step, input) = match result {
        "vec4f" => (
            "field_gradient_step",
            "field_dual_points[0] = mat3x4f(p.x, 1.0, 0.0, 0.0, p.y, 0.0, 1.0, 0.0, p.z, 0.0, 0.0, 1.0);",
        ),
        _ => ("field_step", "field_points[0] = p;"),
    };
    format!(
        "fn {name}(p: vec3f) -> {result} {{
    {input}
    let end = code[0];
    for (var i = {HEAD}u; i < end; i += {WORDS}u) {{
        {step}(field_fetch(i));
    }}
    return {values}[code[1]];
}}
"
    )
}

/// An instruction.
pub(super) const FETCH: &str = "struct FieldStep {
    operation: u32,
    out: u32,
    a: u32,
    b: u32,
    at: u32,
}

fn field_fetch(i: u32) -> FieldStep {
    let first = code[i];
    let second = code[i + 1u];
    return FieldStep(first & 0xffffu, first >> 16u, second & 0xffffu, second >> 16u, code[i + 2u]);
}
";

/// `field_marks` where marks differ from place to place.
fn marks(operations: &Operations, functions: &mut Functions) -> String {
    let mut cases = String::new();
    let mut numbers = [Vec::new(), Vec::new()];
    for (number, operation) in operations.iter() {
        let marks = match operation {
            Operation::Leaf(_) if has_traps(operation) => {
                let traps = functions.name(operation, Form::Traps);
                format!(
                    "Marks(-1.0, -1.0, -1.0, 0.0, {traps}(field_points[instruction.a], instruction.at))"
                )
            }
            Operation::Pair(_) => {
                let share = functions.name(operation, Form::Share);
                format!(
                    "join_marks(field_marked[instruction.a], field_marked[instruction.b], {share}(field_values[instruction.a], field_values[instruction.b], instruction.at))"
                )
            }
            Operation::Leaf(_) => {
                numbers[0].push(number);
                continue;
            }
            Operation::Change(_) => {
                numbers[1].push(number);
                continue;
            }
            Operation::Warp(_) | Operation::Put(_) | Operation::Mark(..) => continue,
        };
        let _ = writeln!(
            cases,
            "            case {number}u: {{ field_marked[instruction.out] = {marks}; }}"
        );
    }
    let [material, object] = operations.marks();
    for (numbers, marks) in [
        (&numbers[0][..], "Marks(-1.0, -1.0, -1.0, 0.0, vec4f())"),
        (&numbers[1], "field_marked[instruction.a]"),
        (
            &[material],
            "mark_material(field_marked[instruction.a], f32(instruction.at))",
        ),
        (
            &[object],
            "mark_object(field_marked[instruction.a], f32(instruction.at))",
        ),
    ] {
        if !numbers.is_empty() {
            let numbers: Vec<String> = numbers.iter().map(|n| format!("{n}u")).collect();
            let numbers = numbers.join(", ");
            let _ = writeln!(
                cases,
                "            case {numbers}: {{ field_marked[instruction.out] = {marks}; }}"
            );
        }
    }
    format!(
        "fn field_marks(p: vec3f) -> Marks {{
    field_points[0] = p;
    let end = code[2];
    for (var i = code[0]; i < end; i += {WORDS}u) {{
        let instruction = field_fetch(i);
        switch instruction.operation {{
{cases}            default: {{}}
        }}
        field_step(instruction);
    }}
    return field_marked[code[3]];
}}
"
    )
}

/// `field_marks` where they are the same everywhere.
pub(super) const PLAIN_MARKS: &str = "fn field_marks(p: vec3f) -> Marks {
    return Marks(f32(code[2]) - 1.0, f32(code[3]) - 1.0, -1.0, 0.0, vec4f());
}
";
