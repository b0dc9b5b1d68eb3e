//! Where points lie in the spaces of coats, with derivatives: as code, whatever form the field has.

use super::compiled::Printer;
use super::{Functions, Operand, steps};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use zeroset_catalogue::tape::Operation;
use zeroset_field::program::Structure;

/// `field_place`; nothing where there are no coats.
pub(super) fn text(structure: &Structure, functions: &mut Functions) -> String {
    let spaces: BTreeSet<u16> = structure.coats.iter().map(|coat| coat.place).collect();
    if spaces.is_empty() {
        return String::new();
    }
    let (steps, _) = steps(&structure.places);
    // a later step may take a register over, but not that of a space
    let written = structure.places.instructions.iter().map(|i| i.out);
    let step_of: BTreeMap<u16, usize> = written.zip(0..).collect();
    let mut cases = String::new();
    for (space, number) in spaces.iter().zip(1..) {
        let last = step_of.get(space).map(|i| Operand::Step(*i));
        let mut needed = BTreeSet::new();
        let mut waiting: Vec<Operand> = last.into_iter().collect();
        while let Some(operand) = waiting.pop() {
            let Operand::Step(i) = operand else {
                continue;
            };
            if !needed.insert(i) {
                continue;
            }
            waiting.push(steps[i].a);
            if let Operation::Put(_) | Operation::Change(_) | Operation::Pair(_) =
                steps[i].operation
            {
                waiting.push(steps[i].b);
            }
        }
        let mut printer = Printer::of(&steps);
        for i in needed {
            printer.value(functions, i, true);
        }
        let point = printer.name(last.unwrap_or(Operand::Input));
        // writing to a string cannot fail
        let _ = writeln!(
            cases,
            "        case {number}u: {{\n{}            return {point};\n        }}",
            printer.out
        );
    }
    format!(
        "fn field_place(number: u32, p: vec3f) -> mat3x4f {{
    switch number {{
{cases}        default: {{
            return mat3x4f(p.x, 1.0, 0.0, 0.0, p.y, 0.0, 1.0, 0.0, p.z, 0.0, 0.0, 1.0);
        }}
    }}
}}
"
    )
}
