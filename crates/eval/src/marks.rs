//! Which object and which materials a point belongs to.
//!
//! Every value carries marks: its object, the two materials that count most, and the share of the second. A sharp join
//! hands on the marks of the side that won; a smooth one blends, each side weighing as much as the result follows it
//! (the derivative of the join with respect to that side). Keinert 2014, section 4, has the idea of a second evaluation
//! at the hit.

use crate::batch::{Kernel, Kernels, load};
use crate::workspace::{BATCH, Lane, MarkLanes, Marks, Workspace};
use fearless_simd::{Level, Simd, SimdBase};
use std::marker::PhantomData;
use zeroset_catalogue::op::*;
use zeroset_catalogue::tape::{Instruction, Operation, Tape};
use zeroset_catalogue::{each_leaf, each_pair};
use zeroset_number::{Args, Data, Dual, Lanes, Real, v3};

/// Finds the marks that a tape gives the first `n` points of the workspace (at most [`BATCH`]); also leaves their values where
/// [`super::values`] does not look.
pub fn marks<S: Simd>(s: S, tape: Tape<'_>, w: &mut Workspace, n: usize) {
    w.marks.result = usize::from(tape.code.result);
    run_marks(s.level(), tape, w, n);
}

#[inline(never)]
fn run_marks(level: Level, tape: Tape<'_>, w: &mut Workspace, n: usize) {
    zeroset_number::at_level!(level, s => run(s, tape, w, n))
}

#[inline(always)]
fn run<S: Simd>(s: S, tape: Tape<'_>, w: &mut Workspace, n: usize) {
    let n = n.next_multiple_of(S::f32s::LEN).min(BATCH);
    let data = tape.data;
    for i in &tape.code.instructions {
        let (out, a, b) = (usize::from(i.out), usize::from(i.a), usize::from(i.b));
        match i.operation {
            Operation::Leaf(code) => {
                w.marks.marks[out] = Marks::NONE;
                if let Some(trap) = Traps::<S>::ALL[usize::from(code)] {
                    trap(s, i, data, &w.lanes, &mut w.marks.marks[out].orbit, n);
                }
            }
            Operation::Warp(_) | Operation::Put(_) => {}
            Operation::Change(_) => w.marks.marks[out] = w.marks.marks[a],
            Operation::Pair(code) => {
                Shares::<S>::ALL[usize::from(code)](s, i, data, &w.lanes, &mut w.marks.share, n);
                join(&mut w.marks, out, a, b, n);
            }
            Operation::Mark(kind, number) => {
                w.marks.marks[out] = w.marks.marks[a];
                let m = &mut w.marks.marks[out];
                let lane = if kind == 0 {
                    &mut m.first
                } else {
                    &mut m.object
                };
                for x in &mut lane.0[..n] {
                    *x = if *x < 0.0 { f32::from(number) } else { *x };
                }
            }
        }
        let kernel: Kernel<S> = Kernels::<S, Lanes<S>>::of(i.operation);
        kernel(s, i, data, &mut w.lanes, n);
    }
}

/// Marks of a joined value from those of its sides.
fn join(lanes: &mut MarkLanes, out: usize, a: usize, b: usize, n: usize) {
    let [out, a, b] = (lanes.marks.get_disjoint_mut([out, a, b]))
        .expect("the compiler gives operands and results different registers");
    for k in 0..n {
        let w = lanes.share.0[k];
        let ((near, far), w) = if w <= 0.5 {
            ((&*a, &*b), w)
        } else {
            ((&*b, &*a), 1.0 - w)
        };
        out.object.0[k] = near.object.0[k];
        for (out, near) in out.orbit.iter_mut().zip(&near.orbit) {
            out.0[k] = near.0[k];
        }
        let first = near.first.0[k];
        let mut weights = (1.0 - w) * (1.0 - near.share.0[k]);
        // what competes for the second place: the near side's second material and the far side's first
        let (mut second, mut rest) = (near.second.0[k], (1.0 - w) * near.share.0[k]);
        let (other, weight) = (far.first.0[k], w * (1.0 - far.share.0[k]));
        if other == first {
            weights += weight;
        } else if other == second {
            rest += weight;
        } else if weight > rest {
            (second, rest) = (other, weight);
        }
        let (first, second, weights, rest) = if rest > weights {
            (second, first, rest, weights)
        } else {
            (first, second, weights, rest)
        };
        out.first.0[k] = first;
        out.second.0[k] = second;
        out.share.0[k] = if rest > 0.0 {
            rest / (weights + rest)
        } else {
            0.0
        };
    }
}

/// Finds how much of a joined value follows its second operand.
type Share<S> = fn(S, &Instruction, &Data, &[Lane], &mut Lane, usize);

#[inline(never)]
fn share<S: Simd, E: Pair>(
    s: S,
    i: &Instruction,
    data: &Data,
    lanes: &[Lane],
    out: &mut Lane,
    n: usize,
) {
    let (x, y) = (&lanes[usize::from(i.a)], &lanes[usize::from(i.b)]);
    let a = Args {
        store: data,
        at: i.at as usize,
    };
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                let (x, y): (Lanes<S>, Lanes<S>) = (load(s, x, k), load(s, y, k));
                let (o, l) = (x.lit(0.0), x.lit(1.0));
                let joined = E::pair(Dual { v: x, d: [l, o, o] }, Dual { v: y, d: [o, l, o] }, a);
                let (u, v) = (joined.d[0].abs(), joined.d[1].abs());
                super::batch::store(v / zeroset_number::Ops::<f32>::max(u + v, 1e-20), out, k);
            }
        },
    );
}

struct Shares<S>(PhantomData<S>);

macro_rules! shares { ($($entry:ty,)*) => { &[$(share::<S, $entry>),*] }; }

impl<S: Simd> Shares<S> {
    const ALL: &'static [Share<S>] = each_pair!(shares);
}

/// Finds the orbit traps of a fractal.
type Trap<S> = fn(S, &Instruction, &Data, &[Lane], &mut [Lane; 4], usize);

#[inline(never)]
fn trap<S: Simd, E: Leaf>(
    s: S,
    i: &Instruction,
    data: &Data,
    lanes: &[Lane],
    out: &mut [Lane; 4],
    n: usize,
) {
    let p = &lanes[usize::from(i.a)..][..3];
    let a = Args {
        store: data,
        at: i.at as usize,
    };
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                let traps = E::traps::<Lanes<S>>(
                    v3(load(s, &p[0], k), load(s, &p[1], k), load(s, &p[2], k)),
                    a,
                );
                for (out, trap) in out.iter_mut().zip(traps) {
                    super::batch::store(trap, out, k);
                }
            }
        },
    );
}

struct Traps<S>(PhantomData<S>);

macro_rules! traps { ($($entry:ty,)*) => { &[$(if <$entry as Leaf>::TRAPS { Some(trap::<S, $entry>) } else { None }),*] }; }

impl<S: Simd> Traps<S> {
    const ALL: &'static [Option<Trap<S>>] = each_leaf!(traps);
}
