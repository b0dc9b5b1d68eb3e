//! Tapes: the instructions that programs are made of, each an operation of [`op`](crate::op) with its registers and the place of its
//! parameters.

use zeroset_number::Data;

/// What an instruction does: the kind of operation and its code in the list of that kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A point in, a value out.
    Leaf(u16),
    /// A point in, a point out.
    Warp(u16),
    /// A value and a point in, the point out with its coordinate of this number replaced by the value.
    Put(u16),
    /// A value and a point in, a value out.
    Change(u16),
    /// Two values in, a value out.
    Pair(u16),
    /// A value in, the same value out, marked as material (0) or object (1) of this number: only in the list for marks.
    Mark(u8, u16),
}

/// One step of a program. Registers are numbered in numbers: points take three, values one, points come first. No
/// instruction writes a register that it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    /// What it does.
    pub operation: Operation,
    /// Where the result goes.
    pub out: u16,
    /// First operand: a point for a leaf or a warp, otherwise a value.
    pub a: u16,
    /// Second operand: the point of a change (register 0 where it is not read) or of a put, the second value of a pair.
    pub b: u16,
    /// Where its parameters begin.
    pub at: u32,
}

/// A list of instructions with its registers. Register 0 holds the point to evaluate at.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Code {
    /// The steps.
    pub instructions: Vec<Instruction>,
    /// Numbers that the registers take.
    pub registers: u16,
    /// Where the result is.
    pub result: u16,
}

/// What is evaluated: instructions, and the data that they read. A whole program is one; so is what is left of it in a part of
/// space where most of its instructions say nothing, with fewer instructions and the same data.
#[derive(Clone, Copy, Debug)]
pub struct Tape<'a> {
    /// The instructions that are run.
    pub code: &'a Code,
    /// The parameters and grids that they read.
    pub data: &'a Data,
}
