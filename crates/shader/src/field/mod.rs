//! The field in a shader: its value, its gradient and its marks at a point, from the recorded operations.
//!
//! As code ([`FieldSource::compiled`]) each instruction of the program is a line; as data ([`FieldSource::interpreted`])
//! the shader is a loop over the instructions, which programs that use the same operations share.

use recorded::Form;
use std::collections::BTreeMap;
use zeroset_catalogue::tape::{Code, Operation};
use zeroset_field::program::{Coat, Structure};
use zeroset_number::wgsl;

mod colours;
mod compiled;
mod interpreted;
mod memory;
mod places;
pub mod recorded;

/// The field's part of a shader module, in WGSL.
///
/// It declares `struct Marks` and
/// ```wgsl
/// fn field(p: vec3f) -> f32
/// fn field_gradient(p: vec3f) -> vec4f // the value, then the gradient
/// fn field_marks(p: vec3f) -> Marks
/// ```
/// and, where the program has [coats](Structure::coats), where a point lies in their spaces, with the derivatives of each coordinate:
/// ```wgsl
/// fn field_place(number: u32, p: vec3f) -> mat3x4f // number: see `place_number`
/// ```
/// and, where it has [formulas of colours](Structure::colours),
/// ```wgsl
/// fn field_colour(number: u32, p: vec3f) -> vec3f // red, green and blue
/// ```
/// and reads `params`, an `array<f32>`, and `code`, an `array<u32>`, which the module declares. Other names that it declares
/// begin with `field_`, with the name of a [`Form`] or with a kind of [`Operation`], or are those of `stage/marks.wgsl`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldSource {
    /// The text.
    pub text: String,
    /// What the module must find in `code`.
    pub code: Vec<u32>,
    /// Words that the registers of an interpreted field take for each thread; 0 where the field is code.
    pub registers: u32,
}

impl FieldSource {
    /// The field as code: no number of the parameters is in the text, but their places are.
    pub fn compiled(structure: &Structure) -> FieldSource {
        FieldSource {
            text: compiled::text(structure),
            // a buffer must not be empty
            code: vec![0],
            registers: 0,
        }
    }

    /// The field as data. The text depends on nothing but which operations there are, the number of registers (in coarse
    /// steps), and whether marks differ from place to place.
    pub fn interpreted(structure: &Structure) -> FieldSource {
        interpreted::source(structure, Registers::Private)
    }

    /// As [`FieldSource::interpreted`], for drivers that compile long for arrays of registers and that allow few turns of
    /// loops: registers lie in a buffer, which the module declares by the functions `cell` and `set_cell`.
    pub(crate) fn in_memory(structure: &Structure) -> FieldSource {
        interpreted::source(structure, Registers::Memory)
    }
}

/// Where the registers of an interpreted field are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Registers {
    /// In arrays of the thread.
    Private,
    /// In a buffer.
    Memory,
}

/// The number by which shaders know the space whose point is left in a register by [`Structure::places`]: 0 is the world.
pub(crate) fn place_number(coats: &[Coat], place: u16) -> u32 {
    let mut before: Vec<u16> = coats.iter().map(|coat| coat.place).collect();
    before.retain(|other| *other < place && *other > 0);
    before.sort_unstable();
    before.dedup();
    if place == 0 {
        0
    } else {
        before.len() as u32 + 1
    }
}

const MARKS: &str = include_str!("../stage/marks.wgsl");

/// The recorded functions that a text calls, by name.
#[derive(Default)]
struct Functions(BTreeMap<String, (Operation, Form)>);

impl Functions {
    /// The name to call a function by; it is printed then.
    fn name(&mut self, operation: Operation, form: Form) -> String {
        let name = name(operation, form);
        self.0.insert(name.clone(), (operation, form));
        name
    }

    fn print(&self) -> String {
        (self.0.values())
            .filter_map(|(operation, form)| recorded::function(*operation, *form))
            .map(|function| wgsl::print(&function))
            .collect()
    }
}

fn name(operation: Operation, form: Form) -> String {
    recorded::name(operation, form).expect("programs hold operations that are in the lists")
}

/// What a step of a program reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operand {
    /// The point to evaluate at.
    Input,
    /// The result of a step.
    Step(usize),
}

/// A step of a program whose operands are steps, not registers.
#[derive(Clone, Copy, Debug)]
struct Step {
    operation: Operation,
    a: Operand,
    b: Operand,
    at: u32,
}

/// The steps of a program and the one that gives its result.
fn steps(code: &Code) -> (Vec<Step>, Operand) {
    let mut registers = vec![Operand::Input; usize::from(code.registers).max(1)];
    let steps = (code.instructions.iter().enumerate())
        .map(|(i, instruction)| {
            let [a, b] = [instruction.a, instruction.b].map(|r| registers[usize::from(r)]);
            registers[usize::from(instruction.out)] = Operand::Step(i);
            Step {
                operation: instruction.operation,
                a,
                b,
                at: instruction.at,
            }
        })
        .collect();
    (steps, registers[usize::from(code.result)])
}

/// Marks that are the same everywhere: of at most one object and one material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Plain {
    object: Option<u16>,
    material: Option<u16>,
}

impl Plain {
    fn marked(mut self, kind: u8, number: u16) -> Plain {
        let place = match kind {
            0 => &mut self.material,
            _ => &mut self.object,
        };
        place.get_or_insert(number);
        self
    }
}

/// For each step, the marks of its value if they are the same everywhere.
fn plain_marks(steps: &[Step]) -> Vec<Option<Plain>> {
    let mut all: Vec<Option<Plain>> = Vec::with_capacity(steps.len());
    for step in steps {
        let of = |operand| match operand {
            Operand::Step(i) => all[i],
            Operand::Input => None,
        };
        all.push(match step.operation {
            Operation::Leaf(_) => (!has_traps(step.operation)).then(Plain::default),
            Operation::Warp(_) | Operation::Put(_) => None,
            Operation::Change(_) => of(step.a),
            Operation::Pair(_) => of(step.a).filter(|a| of(step.b) == Some(*a)),
            Operation::Mark(kind, number) => of(step.a).map(|plain| plain.marked(kind, number)),
        });
    }
    all
}

fn has_traps(operation: Operation) -> bool {
    recorded::function(operation, Form::Traps).is_some()
}
