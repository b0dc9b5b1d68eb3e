//! One point of any number type: the reference that batches are compared with, intervals over boxes, exact gradients.

use std::marker::PhantomData;
use zeroset_catalogue::op::*;
use zeroset_catalogue::tape::{Instruction, Operation, Tape};
use zeroset_catalogue::{each_change, each_leaf, each_pair, each_put, each_warp};
use zeroset_number::{Args, Data, Dual, F64, Interval, Real, SingleInterval, Slope, Vec3};

/// Number types that tapes are evaluated over one point at a time. Their kernels are compiled here and nowhere else.
pub trait PointNumber: Real<Store = Data> + sealed::Sealed {
    /// Runs the instructions of a tape over registers.
    #[doc(hidden)]
    fn run(tape: Tape<'_>, registers: &mut [Self]);
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl sealed::Sealed for $number {}
        impl PointNumber for $number {
            #[inline(never)]
            fn run(tape: Tape<'_>, registers: &mut [Self]) {
                for i in &tape.code.instructions {
                    PointKernels::<$number>::of(i.operation)(i, tape.data, registers);
                }
            }
        }
    )*};
}
numbers!(
    F64,
    Interval,
    SingleInterval,
    Slope,
    Dual<F64>,
    Dual<Interval>
);
#[cfg(feature = "single")]
numbers!(f32, Dual<f32>);

/// Evaluates a tape at one point (or box) at a time.
pub struct Point<'t, R> {
    tape: Tape<'t>,
    registers: Vec<R>,
}

impl<'t, R: PointNumber> Point<'t, R> {
    /// An evaluator of `tape`.
    pub fn new(tape: Tape<'t>) -> Self {
        Point {
            tape,
            registers: Vec::new(),
        }
    }

    /// The value at `p`.
    pub fn value(&mut self, p: Vec3<R>) -> R {
        self.run(p);
        self.registers[usize::from(self.tape.code.result)]
    }

    /// The point that is left in a register when `p` is evaluated at: where `p` lies after maps.
    pub fn place(&mut self, p: Vec3<R>, register: u16) -> Vec3<R> {
        self.run(p);
        point(&self.registers, register)
    }

    fn run(&mut self, p: Vec3<R>) {
        let code = self.tape.code;
        if self.registers.is_empty() {
            self.registers.resize(usize::from(code.registers), p.x);
        }
        self.registers[..3].copy_from_slice(&[p.x, p.y, p.z]);
        R::run(self.tape, &mut self.registers);
    }
}

pub(super) type PointKernel<R> = fn(&Instruction, &Data, &mut [R]);

#[inline(always)]
fn point<R: Real>(registers: &[R], at: u16) -> Vec3<R> {
    let at = usize::from(at);
    Vec3 {
        x: registers[at],
        y: registers[at + 1],
        z: registers[at + 2],
    }
}

fn args<'a, R: Real<Store = Data>>(i: &Instruction, data: &'a Data) -> Args<'a, R> {
    Args {
        store: data,
        at: i.at as usize,
    }
}

fn leaf<R: Real<Store = Data>, E: Leaf>(i: &Instruction, data: &Data, r: &mut [R]) {
    r[usize::from(i.out)] = E::leaf(point(r, i.a), args(i, data));
}

fn warp<R: Real<Store = Data>, E: Warp>(i: &Instruction, data: &Data, r: &mut [R]) {
    let q = E::warp(point(r, i.a), args(i, data));
    r[usize::from(i.out)..][..3].copy_from_slice(&[q.x, q.y, q.z]);
}

fn put<R: Real<Store = Data>, E: Put>(i: &Instruction, _data: &Data, r: &mut [R]) {
    let q = E::put(r[usize::from(i.a)], point(r, i.b));
    r[usize::from(i.out)..][..3].copy_from_slice(&[q.x, q.y, q.z]);
}

fn change<R: Real<Store = Data>, E: Change>(i: &Instruction, data: &Data, r: &mut [R]) {
    r[usize::from(i.out)] = E::change(r[usize::from(i.a)], point(r, i.b), args(i, data));
}

fn pair<R: Real<Store = Data>, E: Pair>(i: &Instruction, data: &Data, r: &mut [R]) {
    r[usize::from(i.out)] = E::pair(r[usize::from(i.a)], r[usize::from(i.b)], args(i, data));
}

fn mark<R: Real>(i: &Instruction, _data: &Data, r: &mut [R]) {
    r[usize::from(i.out)] = r[usize::from(i.a)];
}

/// The kernels of a number type, by operation.
pub(super) struct PointKernels<R>(PhantomData<R>);

macro_rules! leaves { ($($entry:ty,)*) => { &[$(leaf::<R, $entry>),*] }; }
macro_rules! warps { ($($entry:ty,)*) => { &[$(warp::<R, $entry>),*] }; }
macro_rules! puts { ($($entry:ty,)*) => { &[$(put::<R, $entry>),*] }; }
macro_rules! changes { ($($entry:ty,)*) => { &[$(change::<R, $entry>),*] }; }
macro_rules! pairs { ($($entry:ty,)*) => { &[$(pair::<R, $entry>),*] }; }

impl<R: Real<Store = Data> + 'static> PointKernels<R> {
    const LEAVES: &'static [PointKernel<R>] = each_leaf!(leaves);
    const WARPS: &'static [PointKernel<R>] = each_warp!(warps);
    const PUTS: &'static [PointKernel<R>] = each_put!(puts);
    const CHANGES: &'static [PointKernel<R>] = each_change!(changes);
    const PAIRS: &'static [PointKernel<R>] = each_pair!(pairs);

    #[inline(always)]
    pub(super) fn of(operation: Operation) -> PointKernel<R> {
        match operation {
            Operation::Leaf(code) => Self::LEAVES[usize::from(code)],
            Operation::Warp(code) => Self::WARPS[usize::from(code)],
            Operation::Put(code) => Self::PUTS[usize::from(code)],
            Operation::Change(code) => Self::CHANGES[usize::from(code)],
            Operation::Pair(code) => Self::PAIRS[usize::from(code)],
            Operation::Mark(..) => mark::<R>,
        }
    }
}
