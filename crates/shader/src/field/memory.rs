//! The interpreter with its registers in a buffer.
//!
//! llvmpipe turns every access to an array of a thread into a choice between all its elements: 64 registers for points take it
//! minutes to compile. And it allows few turns of loops. So an instruction reads its operands in one place, whatever it does,
//! and writes its result in one place; and a turn of the loop carries out several.

use super::interpreted::{FETCH, HEAD, Operations, PLAIN_MARKS, WORDS};
use super::{Functions, MARKS, colours, has_traps, places};
use crate::field::recorded::Form;
use std::fmt::Write;
use zeroset_catalogue::tape::Operation;
use zeroset_field::program::Structure;

/// Instructions a turn of the loop.
pub(super) const UNROLLED: u32 = 4;
/// The number of an operation that does nothing.
pub(super) const NOTHING: u32 = 0xffff;

pub(super) fn text(
    structure: &Structure,
    operations: &Operations,
    [points, values]: [u32; 2],
    with_marks: bool,
) -> String {
    let mut functions = Functions::default();
    let value_step = step(operations, &mut functions, Form::Value);
    let gradient_step = step(operations, &mut functions, Form::Gradient);
    let marks = if with_marks {
        let step = marks_step(operations, &mut functions);
        let turns = turns("field_marks_step");
        format!(
            "{step}
fn field_marks(p: vec3f) -> Marks {{
    field_set_point(0u, p);
    let end = code[2];
    for (var i = code[0]; i < end; i += {WORDS}u * {UNROLLED}u) {{
{turns}    }}
    return field_read_marks(code[3]);
}}
"
        )
    } else {
        PLAIN_MARKS.into()
    };
    let places =
        places::text(structure, &mut functions) + &colours::text(structure, &mut functions);
    let functions = functions.print();
    let value = run(
        "fn field(p: vec3f) -> f32",
        "field_set_point(0u, p);",
        "field_step",
        "field_value",
    );
    let gradient = run(
        "fn field_gradient(p: vec3f) -> vec4f",
        "field_set_dual_point(0u, mat3x4f(p.x, 1.0, 0.0, 0.0, p.y, 0.0, 1.0, 0.0, p.z, 0.0, 0.0, 1.0));",
        "field_gradient_step",
        "field_dual",
    );
    format!(
        "const FIELD_POINTS: u32 = {points}u;\nconst FIELD_VALUES: u32 = {values}u;\n{MARKS}\n{functions}\n{FETCH}\n{}\n{value_step}\n{value}\n{gradient_step}\n{gradient}\n{marks}\n{places}",
        accesses(with_marks)
    )
}

/// Registers by number: points come first, then values, then marks. For gradients each number of them is four.
fn accesses(with_marks: bool) -> String {
    let marks = if with_marks { MARK_ACCESSES } else { "" };
    format!("{ACCESSES}{marks}")
}

const ACCESSES: &str = "fn field_point(i: u32) -> vec3f {
    return vec3f(cell(3u * i), cell(3u * i + 1u), cell(3u * i + 2u));
}

fn field_set_point(i: u32, p: vec3f) {
    set_cell(3u * i, p.x);
    set_cell(3u * i + 1u, p.y);
    set_cell(3u * i + 2u, p.z);
}

fn field_value(i: u32) -> f32 {
    return cell(3u * FIELD_POINTS + i);
}

fn field_set_value(i: u32, d: f32) {
    set_cell(3u * FIELD_POINTS + i, d);
}

fn field_four(k: u32) -> vec4f {
    return vec4f(cell(k), cell(k + 1u), cell(k + 2u), cell(k + 3u));
}

fn field_set_four(k: u32, v: vec4f) {
    set_cell(k, v.x);
    set_cell(k + 1u, v.y);
    set_cell(k + 2u, v.z);
    set_cell(k + 3u, v.w);
}

fn field_dual_point(i: u32) -> mat3x4f {
    return mat3x4f(field_four(12u * i), field_four(12u * i + 4u), field_four(12u * i + 8u));
}

fn field_set_dual_point(i: u32, p: mat3x4f) {
    field_set_four(12u * i, p[0]);
    field_set_four(12u * i + 4u, p[1]);
    field_set_four(12u * i + 8u, p[2]);
}

fn field_dual(i: u32) -> vec4f {
    return field_four(12u * FIELD_POINTS + 4u * i);
}

fn field_set_dual(i: u32, d: vec4f) {
    field_set_four(12u * FIELD_POINTS + 4u * i, d);
}
";

/// Marks of value i lie behind all values: nine words a value in all, woven.
const MARK_ACCESSES: &str = "
fn field_read_marks(i: u32) -> Marks {
    let k = 3u * FIELD_POINTS + FIELD_VALUES + 8u * i;
    let first = field_four(k);
    return Marks(first.x, first.y, first.z, first.w, field_four(k + 4u));
}

fn field_set_marks(i: u32, marks: Marks) {
    let k = 3u * FIELD_POINTS + FIELD_VALUES + 8u * i;
    field_set_four(k, vec4f(marks.object, marks.first, marks.second, marks.share));
    field_set_four(k + 4u, marks.orbit);
}
";

/// The function that carries out one instruction.
fn step(operations: &Operations, functions: &mut Functions, form: Form) -> String {
    let (name, read_point, read_value, set_point, set_value) = match form {
        Form::Gradient => (
            "field_gradient_step",
            "field_dual_point",
            "field_dual",
            "field_set_dual_point",
            "field_set_dual",
        ),
        _ => (
            "field_step",
            "field_point",
            "field_value",
            "field_set_point",
            "field_set_value",
        ),
    };
    let mut cases = String::new();
    for (number, operation) in operations.iter() {
        let f = functions.name(operation, form);
        let body = match operation {
            Operation::Leaf(_) => format!("d = {f}(p, instruction.at);"),
            Operation::Warp(_) => format!("q = {f}(p, instruction.at); moves = true;"),
            Operation::Put(_) => format!("q = {f}(x, p, instruction.at); moves = true;"),
            Operation::Change(_) => format!("d = {f}(x, p, instruction.at);"),
            Operation::Pair(_) | Operation::Mark(..) => {
                format!("d = {f}(x, y, instruction.at);")
            }
        };
        // writing to a string cannot fail
        let _ = writeln!(cases, "        case {number}u: {{ {body} }}");
    }
    format!(
        "fn {name}(instruction: FieldStep) {{
    if (instruction.operation == {NOTHING}u) {{
        return;
    }}
    let p = {read_point}(instruction.b);
    let x = {read_value}(instruction.a);
    let y = {read_value}(instruction.b);
    var q = p;
    // what only marks leaves the value as it is
    var d = x;
    var moves = false;
    switch instruction.operation {{
{cases}        default: {{}}
    }}
    if (moves) {{
        {set_point}(instruction.out, q);
    }} else {{
        {set_value}(instruction.out, d);
    }}
}}
"
    )
}

/// The function that carries out one instruction for marks.
fn marks_step(operations: &Operations, functions: &mut Functions) -> String {
    let mut cases = String::new();
    let mut case = |number: u32, marks: &str| {
        let _ = writeln!(cases, "            case {number}u: {{ marks = {marks}; }}");
    };
    let mut warps = String::from("false");
    for (number, operation) in operations.iter() {
        match operation {
            Operation::Leaf(_) if has_traps(operation) => {
                let traps = functions.name(operation, Form::Traps);
                case(
                    number,
                    &format!(
                        "Marks(-1.0, -1.0, -1.0, 0.0, {traps}(field_point(instruction.b), instruction.at))"
                    ),
                );
            }
            Operation::Leaf(_) => case(number, "Marks(-1.0, -1.0, -1.0, 0.0, vec4f())"),
            Operation::Pair(_) => {
                let share = functions.name(operation, Form::Share);
                case(
                    number,
                    &format!(
                        "join_marks(marks, field_read_marks(instruction.b), {share}(field_value(instruction.a), field_value(instruction.b), instruction.at))"
                    ),
                );
            }
            // the marks of the value that is changed
            Operation::Change(_) | Operation::Mark(..) => {}
            Operation::Warp(_) | Operation::Put(_) => {
                let _ = write!(warps, " || instruction.operation == {number}u");
            }
        }
    }
    let [material, object] = operations.marks();
    case(material, "mark_material(marks, f32(instruction.at))");
    case(object, "mark_object(marks, f32(instruction.at))");
    format!(
        "fn field_marks_step(instruction: FieldStep) {{
    if (!({warps} || instruction.operation == {NOTHING}u)) {{
        var marks = field_read_marks(instruction.a);
        switch instruction.operation {{
{cases}            default: {{}}
        }}
        field_set_marks(instruction.out, marks);
    }}
    field_step(instruction);
}}
"
    )
}

/// `field` or `field_gradient`.
fn run(head: &str, input: &str, step: &str, result: &str) -> String {
    let turns = turns(step);
    format!(
        "{head} {{
    {input}
    let end = code[0];
    for (var i = {HEAD}u; i < end; i += {WORDS}u * {UNROLLED}u) {{
{turns}    }}
    return {result}(code[1]);
}}
"
    )
}

/// The instructions of a turn.
fn turns(step: &str) -> String {
    (0..UNROLLED)
        .map(|k| format!("        {step}(field_fetch(i + {}u));\n", WORDS * k))
        .collect()
}
