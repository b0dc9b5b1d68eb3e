//! The field as code: a line for each instruction, results as `p12` (points), `d12` (values) and `m12` (marks).

use super::{Functions, MARKS, Operand, Plain, Step, colours, places, plain_marks, steps};
use crate::field::recorded::Form;
use std::fmt::Write;
use zeroset_catalogue::tape::Operation;
use zeroset_field::program::Structure;

pub(super) fn text(structure: &Structure) -> String {
    let mut functions = Functions::default();
    let (values, result) = steps(&structure.values);
    let value = Printer::of(&values).function(&mut functions, false, result);
    let gradient = Printer::of(&values).function(&mut functions, true, result);
    let (marked, result) = steps(&structure.marks);
    let marks = marks(&mut functions, &marked, result);
    let places =
        places::text(structure, &mut functions) + &colours::text(structure, &mut functions);
    format!(
        "{MARKS}\n{}\n{value}\n{gradient}\n{marks}\n{places}",
        functions.print()
    )
}

/// Prints steps, one line each.
pub(super) struct Printer<'s> {
    steps: &'s [Step],
    pub(super) out: String,
}

impl<'s> Printer<'s> {
    pub(super) fn of(steps: &'s [Step]) -> Self {
        Printer {
            steps,
            out: String::new(),
        }
    }

    /// The function of values, or that of values with gradients.
    fn function(mut self, functions: &mut Functions, gradient: bool, result: Operand) -> String {
        for i in 0..self.steps.len() {
            self.value(functions, i, gradient);
        }
        let head = if gradient {
            "fn field_gradient(p: vec3f) -> vec4f"
        } else {
            "fn field(p: vec3f) -> f32"
        };
        let result = self.name(result);
        format!("{head} {{\n{}    return {result};\n}}\n", self.out)
    }

    fn line(&mut self, name: &str, value: &str) {
        // writing to a string cannot fail
        let _ = writeln!(self.out, "    let {name} = {value};");
    }

    /// The point or value that an operand is.
    pub(super) fn name(&self, operand: Operand) -> String {
        let Operand::Step(i) = operand else {
            return "p".into();
        };
        match self.steps[i].operation {
            Operation::Warp(_) | Operation::Put(_) => format!("p{i}"),
            // a marked value is the value
            Operation::Mark(..) => self.name(self.steps[i].a),
            _ => format!("d{i}"),
        }
    }

    /// The point or value that a step gives.
    pub(super) fn value(&mut self, functions: &mut Functions, i: usize, gradient: bool) {
        let step = &self.steps[i];
        let (point, operands) = match step.operation {
            Operation::Leaf(_) | Operation::Warp(_) => (Some(step.a), vec![step.a]),
            Operation::Put(_) | Operation::Change(_) => (Some(step.b), vec![step.a, step.b]),
            Operation::Pair(_) => (None, vec![step.a, step.b]),
            Operation::Mark(..) => return,
        };
        let form = match (gradient, point) {
            (false, _) => Form::Value,
            (true, Some(Operand::Input)) => Form::PlainGradient,
            (true, _) => Form::Gradient,
        };
        let operands: Vec<String> = operands.into_iter().map(|o| self.name(o)).collect();
        let call = format!(
            "{}({}, {}u)",
            functions.name(step.operation, form),
            operands.join(", "),
            step.at
        );
        self.line(&self.name(Operand::Step(i)), &call);
    }
}

/// What the marks of a result are made of.
struct Needed {
    values: Vec<bool>,
    marks: Vec<bool>,
}

impl Needed {
    fn new(steps: &[Step], plain: &[Option<Plain>], result: Operand) -> Needed {
        let mut needed = Needed {
            values: vec![false; steps.len()],
            marks: vec![false; steps.len()],
        };
        set(&mut needed.marks, result);
        for (i, step) in steps.iter().enumerate().rev() {
            if needed.marks[i] && plain[i].is_none() {
                match step.operation {
                    Operation::Leaf(_) | Operation::Warp(_) => set(&mut needed.values, step.a),
                    // a point has no marks
                    Operation::Put(_) => {}
                    Operation::Change(_) | Operation::Mark(..) => set(&mut needed.marks, step.a),
                    Operation::Pair(_) => {
                        for operand in [step.a, step.b] {
                            set(&mut needed.marks, operand);
                            set(&mut needed.values, operand);
                        }
                    }
                }
            }
            if needed.values[i] {
                set(&mut needed.values, step.a);
                if matches!(
                    step.operation,
                    Operation::Put(_) | Operation::Change(_) | Operation::Pair(_)
                ) {
                    set(&mut needed.values, step.b);
                }
            }
        }
        needed
    }
}

fn set(all: &mut [bool], operand: Operand) {
    if let Operand::Step(i) = operand {
        all[i] = true;
    }
}

fn marks(functions: &mut Functions, steps: &[Step], result: Operand) -> String {
    let plain = plain_marks(steps);
    let needed = Needed::new(steps, &plain, result);
    let mut printer = Printer::of(steps);
    for (i, step) in steps.iter().enumerate() {
        if needed.values[i] {
            printer.value(functions, i, false);
        }
        if !needed.marks[i] || plain[i].is_some() {
            continue;
        }
        let of = |operand| marks_name(steps, &plain, operand);
        let value = match step.operation {
            Operation::Leaf(_) => {
                let traps = functions.name(step.operation, Form::Traps);
                let p = printer.name(step.a);
                constructor(Plain::default(), &format!("{traps}({p}, {}u)", step.at))
            }
            Operation::Pair(_) => {
                let share = functions.name(step.operation, Form::Share);
                let [x, y] = [step.a, step.b].map(|o| printer.name(o));
                format!(
                    "join_marks({}, {}, {share}({x}, {y}, {}u))",
                    of(step.a),
                    of(step.b),
                    step.at
                )
            }
            Operation::Mark(0, number) => format!("mark_material({}, {number}.0)", of(step.a)),
            Operation::Mark(_, number) => format!("mark_object({}, {number}.0)", of(step.a)),
            Operation::Warp(_) | Operation::Put(_) | Operation::Change(_) => continue,
        };
        printer.line(&format!("m{i}"), &value);
    }
    let result = marks_name(steps, &plain, result);
    format!(
        "fn field_marks(p: vec3f) -> Marks {{\n{}    return {result};\n}}\n",
        printer.out
    )
}

/// The marks that an operand has.
fn marks_name(steps: &[Step], plain: &[Option<Plain>], operand: Operand) -> String {
    let Operand::Step(i) = operand else {
        return constructor(Plain::default(), "vec4f()");
    };
    match (plain[i], steps[i].operation) {
        (Some(plain), _) => constructor(plain, "vec4f()"),
        (None, Operation::Change(_)) => marks_name(steps, plain, steps[i].a),
        (None, _) => format!("m{i}"),
    }
}

fn constructor(plain: Plain, orbit: &str) -> String {
    let number = |n: Option<u16>| n.map_or("-1.0".into(), |n| format!("{n}.0"));
    format!(
        "Marks({}, {}, -1.0, 0.0, {orbit})",
        number(plain.object),
        number(plain.material)
    )
}
