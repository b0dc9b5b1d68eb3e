//! Formulas of colours: as code, whatever form the field has.

use super::compiled::Printer;
use super::{Functions, steps};
use std::fmt::Write;
use zeroset_field::program::Structure;

/// `field_colour`; nothing where there are no formulas of colours.
pub(super) fn text(structure: &Structure, functions: &mut Functions) -> String {
    if structure.colours.is_empty() {
        return String::new();
    }
    let mut cases = String::new();
    for (number, code) in structure.colours.iter().enumerate() {
        let (steps, result) = steps(code);
        let mut printer = Printer::of(&steps);
        for i in 0..steps.len() {
            printer.value(functions, i, false);
        }
        let colour = printer.name(result);
        // writing to a string cannot fail
        let _ = writeln!(
            cases,
            "        case {number}u: {{\n{}            return {colour};\n        }}",
            printer.out
        );
    }
    format!(
        "fn field_colour(number: u32, p: vec3f) -> vec3f {{
    switch number {{
{cases}        default: {{
            return vec3f(0.0);
        }}
    }}
}}
"
    )
}
