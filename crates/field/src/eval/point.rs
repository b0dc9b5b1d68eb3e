//! One point of any number type: the reference that batches are compared with, intervals over boxes, exact gradients.

use crate::catalogue::*;
use crate::number::{Args, Real, Vec3};
use crate::op::*;
use crate::program::{Instruction, Operation, Program};
use std::marker::PhantomData;

/// Evaluates a program at one point (or box) at a time.
pub struct Point<'p, R> {
    program: &'p Program,
    registers: Vec<R>,
}

impl<'p, R: Real<Store = [f32]> + 'static> Point<'p, R> {
    /// An evaluator of `program`.
    pub fn new(program: &'p Program) -> Self {
        Point {
            program,
            registers: Vec::new(),
        }
    }

    /// The value at `p`.
    pub fn value(&mut self, p: Vec3<R>) -> R {
        let code = &self.program.structure.values;
        if self.registers.is_empty() {
            self.registers.resize(usize::from(code.registers), p.x);
        }
        let registers = &mut self.registers[..];
        registers[..3].copy_from_slice(&[p.x, p.y, p.z]);
        for i in &code.instructions {
            Steps::<R>::of(i.operation)(i, &self.program.params, registers);
        }
        registers[usize::from(code.result)]
    }
}

type Step<R> = fn(&Instruction, &[f32], &mut [R]);

#[inline(always)]
fn point<R: Real>(registers: &[R], at: u16) -> Vec3<R> {
    let at = usize::from(at);
    Vec3 {
        x: registers[at],
        y: registers[at + 1],
        z: registers[at + 2],
    }
}

fn args<'a, R: Real<Store = [f32]>>(i: &Instruction, params: &'a [f32]) -> Args<'a, R> {
    Args {
        store: params,
        at: i.at as usize,
    }
}

fn leaf<R: Real<Store = [f32]>, E: Leaf>(i: &Instruction, params: &[f32], r: &mut [R]) {
    r[usize::from(i.out)] = E::leaf(point(r, i.a), args(i, params));
}

fn warp<R: Real<Store = [f32]>, E: Warp>(i: &Instruction, params: &[f32], r: &mut [R]) {
    let q = E::warp(point(r, i.a), args(i, params));
    r[usize::from(i.out)..][..3].copy_from_slice(&[q.x, q.y, q.z]);
}

fn change<R: Real<Store = [f32]>, E: Change>(i: &Instruction, params: &[f32], r: &mut [R]) {
    r[usize::from(i.out)] = E::change(r[usize::from(i.a)], point(r, i.b), args(i, params));
}

fn pair<R: Real<Store = [f32]>, E: Pair>(i: &Instruction, params: &[f32], r: &mut [R]) {
    r[usize::from(i.out)] = E::pair(r[usize::from(i.a)], r[usize::from(i.b)], args(i, params));
}

fn mark<R: Real>(i: &Instruction, _params: &[f32], r: &mut [R]) {
    r[usize::from(i.out)] = r[usize::from(i.a)];
}

struct Steps<R>(PhantomData<R>);

macro_rules! leaves { ($($entry:ty,)*) => { &[$(leaf::<R, $entry>),*] }; }
macro_rules! warps { ($($entry:ty,)*) => { &[$(warp::<R, $entry>),*] }; }
macro_rules! changes { ($($entry:ty,)*) => { &[$(change::<R, $entry>),*] }; }
macro_rules! pairs { ($($entry:ty,)*) => { &[$(pair::<R, $entry>),*] }; }

impl<R: Real<Store = [f32]> + 'static> Steps<R> {
    const LEAVES: &'static [Step<R>] = each_leaf!(leaves);
    const WARPS: &'static [Step<R>] = each_warp!(warps);
    const CHANGES: &'static [Step<R>] = each_change!(changes);
    const PAIRS: &'static [Step<R>] = each_pair!(pairs);

    #[inline(always)]
    fn of(operation: Operation) -> Step<R> {
        match operation {
            Operation::Leaf(code) => Self::LEAVES[usize::from(code)],
            Operation::Warp(code) => Self::WARPS[usize::from(code)],
            Operation::Change(code) => Self::CHANGES[usize::from(code)],
            Operation::Pair(code) => Self::PAIRS[usize::from(code)],
            Operation::Mark(..) => mark::<R>,
        }
    }
}
