//! What is left of a tape in a box: the instructions that are alive there (Keeter 2020, section 3.2; Barbier et al. 2025 for joins with a
//! support).
//!
//! The tape is run once over the box, in ranges that hold all that single precision gives there. A join whose operands are so far apart
//! that it gives one of them, to the bit, becomes that operand ([`Kept`]); what nobody reads then goes. So the shorter tape gives the same
//! values and the same marks as the whole one at every point of the box, to the bit, and the same gradients (but that a zero may have the
//! other sign, where the whole tape adds a zero to it).

use crate::point::PointKernels;
use zeroset_catalogue::op::arithmetic::Unary;
use zeroset_catalogue::op::{Change, Kept, Pair, Warp, code};
use zeroset_catalogue::tape::{Code, Instruction, Operation, Tape};
use zeroset_catalogue::{each_change, each_pair, each_warp};
use zeroset_number::{Args, Data, SingleInterval, Vec3, v3};

/// What is left of a tape in a box.
#[derive(Clone, Debug)]
pub struct Remains {
    /// The shorter tape; none where all of it is left.
    pub code: Option<Code>,
    /// What its values in the box, and those of single precision, lie in.
    pub range: SingleInterval,
}

/// A step before registers are given: its operands are earlier steps.
#[derive(Clone, Copy)]
struct Step {
    operation: Operation,
    a: u32,
    b: u32,
    at: u32,
}

impl Step {
    fn gives_point(&self) -> bool {
        matches!(self.operation, Operation::Warp(_) | Operation::Put(_))
    }
}

/// The step that is the point to evaluate at.
const INPUT: u32 = u32::MAX;

/// Prunes tapes; keeps its memory from one to the next.
#[derive(Default)]
pub struct Pruner {
    registers: Vec<SingleInterval>,
    /// For each register, the step whose result it holds.
    holds: Vec<u32>,
    /// For each register, whether what it was made of has no infinite range: where single precision has no number, as for 0 / 0 or for 0
    /// times infinity, something before has one.
    defined: Vec<bool>,
    steps: Vec<Step>,
}

impl Pruner {
    /// A pruner.
    pub fn new() -> Pruner {
        Pruner::default()
    }

    /// Finds what is left of a tape in a box.
    pub fn prune(&mut self, tape: Tape<'_>, within: Vec3<SingleInterval>) -> Remains {
        let code = tape.code;
        let count = usize::from(code.registers);
        self.registers.clear();
        self.registers.resize(count, within.x);
        self.registers[..3].copy_from_slice(&within.array());
        self.holds.clear();
        self.holds.resize(count, INPUT);
        self.defined.clear();
        self.defined.resize(count, true);
        self.defined[0] = within.array().iter().all(|c| c.is_finite());
        self.steps.clear();
        for i in &code.instructions {
            self.take(i, tape.data);
        }
        let result = usize::from(code.result);
        Remains {
            code: self.shorter(code, self.holds[result]),
            range: self.registers[result],
        }
    }

    /// Takes an instruction in: as a step, or as another name for what one of its operands is.
    fn take(&mut self, i: &Instruction, data: &Data) {
        let (out, a, b) = (usize::from(i.out), usize::from(i.a), usize::from(i.b));
        let (first, second) = (self.holds[a], self.holds[b]);
        let defined = self.defined[a] && self.defined[b];
        match i.operation {
            _ if !defined => {}
            Operation::Warp(number) => {
                let p = self.point(a);
                if WARPS[usize::from(number)](p, args(i, data)) {
                    self.registers.copy_within(a..a + 3, out);
                    self.holds[out] = first;
                    self.defined[out] = true;
                    return;
                }
            }
            Operation::Change(number) => {
                let (d, p) = (self.registers[a], self.point(b));
                if CHANGES[usize::from(number)](d, p, args(i, data)) {
                    self.keep(out, a);
                    return;
                }
            }
            Operation::Pair(number) => {
                let (x, y) = (self.registers[a], self.registers[b]);
                match PAIRS[usize::from(number)](x, y, args(i, data)) {
                    Kept::First => return self.keep(out, a),
                    Kept::Second => return self.keep(out, b),
                    Kept::MinusSecond => {
                        self.registers[out] = -y;
                        self.holds[out] = self.negation(second);
                        self.defined[out] = true;
                        return;
                    }
                    Kept::Both => {}
                }
            }
            Operation::Leaf(_) | Operation::Put(_) | Operation::Mark(..) => {}
        }
        PointKernels::<SingleInterval>::of(i.operation)(i, data, &mut self.registers);
        let width = match i.operation {
            Operation::Warp(_) | Operation::Put(_) => 3,
            _ => 1,
        };
        let results = &mut self.registers[out..out + width];
        self.defined[out] = defined && results.iter().all(|range| range.is_finite());
        if !defined {
            results.fill(SingleInterval::WHOLE);
        }
        // operands of a pair lie in different registers: what has become the same is negated twice
        let second = match i.operation {
            Operation::Pair(_) if first == second => {
                let minus = self.negation(second);
                self.negation(minus)
            }
            _ => second,
        };
        self.holds[out] = self.push(Step {
            operation: i.operation,
            a: first,
            b: second,
            at: i.at,
        });
    }

    fn push(&mut self, step: Step) -> u32 {
        self.steps.push(step);
        self.steps.len() as u32 - 1
    }

    fn negation(&mut self, of: u32) -> u32 {
        self.push(Step {
            operation: Operation::Change(code::unary(Unary::Neg)),
            a: of,
            b: INPUT,
            at: 0,
        })
    }

    fn keep(&mut self, out: usize, operand: usize) {
        self.registers[out] = self.registers[operand];
        self.holds[out] = self.holds[operand];
        self.defined[out] = self.defined[operand];
    }

    fn point(&self, at: usize) -> Vec3<SingleInterval> {
        v3(
            self.registers[at],
            self.registers[at + 1],
            self.registers[at + 2],
        )
    }

    /// The steps that the result needs, if they are fewer than before and fit in as many registers.
    fn shorter(&self, before: &Code, result: u32) -> Option<Code> {
        let steps = &self.steps;
        let mut last_use = vec![None; steps.len()];
        *last_use.get_mut(result as usize)? = Some(steps.len());
        for (i, step) in steps.iter().enumerate().rev() {
            if last_use[i].is_some() {
                for operand in [step.a, step.b] {
                    if operand != INPUT && last_use[operand as usize].is_none() {
                        last_use[operand as usize] = Some(i);
                    }
                }
            }
        }
        let alive = last_use.iter().filter(|last| last.is_some()).count();
        if alive >= before.instructions.len() {
            return None;
        }
        // places of points and of values, each numbered from zero
        let mut place = vec![0_usize; steps.len()];
        let mut free: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
        let mut used = [0_usize; 2];
        for (i, step) in steps.iter().enumerate() {
            if last_use[i].is_none() {
                continue;
            }
            let kind = usize::from(step.gives_point());
            place[i] = free[kind].pop().unwrap_or_else(|| {
                used[kind] += 1;
                used[kind] - 1
            });
            for operand in [Some(step.a), (step.a != step.b).then_some(step.b)] {
                let Some(operand) = operand.filter(|o| *o != INPUT) else {
                    continue;
                };
                if last_use[operand as usize] == Some(i) {
                    let kind = usize::from(steps[operand as usize].gives_point());
                    free[kind].push(place[operand as usize]);
                }
            }
        }
        let points = 3 * (used[1] + 1);
        let registers = points + used[0];
        if registers > usize::from(before.registers) {
            return None;
        }
        let number = |i: u32| match i {
            INPUT => 0,
            i if steps[i as usize].gives_point() => 3 * (place[i as usize] + 1),
            i => points + place[i as usize],
        } as u16;
        let instructions = (steps.iter().enumerate())
            .filter(|(i, _)| last_use[*i].is_some())
            .map(|(i, step)| Instruction {
                operation: step.operation,
                out: number(i as u32),
                a: number(step.a),
                b: number(step.b),
                at: step.at,
            })
            .collect();
        Some(Code {
            instructions,
            registers: registers as u16,
            result: number(result),
        })
    }
}

fn args<'a>(i: &Instruction, data: &'a Data) -> Args<'a, SingleInterval> {
    Args {
        store: data,
        at: i.at as usize,
    }
}

type KeepPoint = fn(Vec3<SingleInterval>, Args<'_, SingleInterval>) -> bool;
type KeepValue = fn(SingleInterval, Vec3<SingleInterval>, Args<'_, SingleInterval>) -> bool;
type KeepOperand = fn(SingleInterval, SingleInterval, Args<'_, SingleInterval>) -> Kept;

macro_rules! warps { ($($entry:ty,)*) => { &[$(<$entry as Warp>::keeps),*] }; }
macro_rules! changes { ($($entry:ty,)*) => { &[$(<$entry as Change>::keeps),*] }; }
macro_rules! pairs { ($($entry:ty,)*) => { &[$(<$entry as Pair>::kept),*] }; }

const WARPS: &[KeepPoint] = each_warp!(warps);
const CHANGES: &[KeepValue] = each_change!(changes);
const PAIRS: &[KeepOperand] = each_pair!(pairs);
