//! Where points lie in the spaces of coats: a line for each map, whatever form the field has.

use super::{Functions, Operand, steps};
use crate::field::recorded::Form;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use zeroset_field::program::Structure;

/// `field_place`; nothing where there are no coats.
pub(super) fn text(structure: &Structure, functions: &mut Functions) -> String {
    let spaces: BTreeSet<u16> = structure.coats.iter().map(|coat| coat.place).collect();
    if spaces.is_empty() {
        return String::new();
    }
    let (steps, _) = steps(&structure.places);
    let written = structure.places.instructions.iter().map(|i| i.out);
    let step_of: BTreeMap<u16, usize> = written.zip(0..).collect();
    let mut cases = String::new();
    for (space, number) in spaces.iter().zip(1..) {
        // the maps that lead there, the last first
        let mut way = Vec::new();
        let mut at = step_of.get(space).map(|i| Operand::Step(*i));
        while let Some(Operand::Step(i)) = at {
            way.push(i);
            at = Some(steps[i].a);
        }
        // writing to a string cannot fail
        let _ = writeln!(cases, "        case {number}u: {{");
        let mut point = "p".to_owned();
        for &i in way.iter().rev() {
            let form = match steps[i].a {
                Operand::Input => Form::PlainGradient,
                Operand::Step(_) => Form::Gradient,
            };
            let map = functions.name(steps[i].operation, form);
            let _ = writeln!(
                cases,
                "            let p{i} = {map}({point}, {}u);",
                steps[i].at
            );
            point = format!("p{i}");
        }
        let _ = writeln!(cases, "            return {point};\n        }}");
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
