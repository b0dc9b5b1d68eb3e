//! Up to [`BATCH`] points at once: one kernel an operation, vectorised over the batch.

use crate::workspace::{BATCH, Lane, Workspace};
use fearless_simd::{Level, Simd, SimdBase};
use std::marker::PhantomData;
use std::ops::Range;
use zeroset_catalogue::op::*;
use zeroset_catalogue::tape::{Instruction, Operation, Tape};
use zeroset_catalogue::{each_change, each_leaf, each_pair, each_put, each_warp};
use zeroset_number::{Args, Data, Dual, Lanes, Real, Vec3, v3};

/// Evaluates a tape at the first `n` points of the workspace (at most [`BATCH`]). `n` is rounded up to the width of the SIMD level,
/// so the points behind the last one must be numbers too.
#[inline(always)]
pub fn values<S: Simd>(s: S, tape: Tape<'_>, w: &mut Workspace, n: usize) {
    w.result = usize::from(tape.code.result);
    run_values(s.level(), tape, &mut w.lanes, n);
}

/// As [`values`], with the gradient. The points are those of [`Workspace::points_mut`].
pub fn gradients<S: Simd>(s: S, tape: Tape<'_>, w: &mut Workspace, n: usize) {
    w.begin_gradients(tape);
    run_gradients(s.level(), tape, &mut w.duals, n);
}

/// Finds where the points lie after the maps of a tape, and how that changes with the point: see [`Workspace::place`]. What
/// [`gradients`] found is lost.
pub fn places<S: Simd>(s: S, tape: Tape<'_>, w: &mut Workspace, n: usize) {
    w.begin_places(tape);
    run_gradients(s.level(), tape, &mut w.duals, n);
}

// Not generic, so that the kernels are compiled once, in this crate.
#[inline(never)]
pub(super) fn run_values(level: Level, tape: Tape<'_>, lanes: &mut [Lane], n: usize) {
    zeroset_number::at_level!(level, s => run::<_, Lanes<_>>(s, tape, lanes, n))
}

#[inline(never)]
pub(super) fn run_gradients(level: Level, tape: Tape<'_>, lanes: &mut [Lane], n: usize) {
    zeroset_number::at_level!(level, s => run::<_, Dual<Lanes<_>>>(s, tape, lanes, n))
}

#[inline(always)]
fn run<S: Simd, N: Slot<S>>(s: S, tape: Tape<'_>, lanes: &mut [Lane], n: usize) {
    let n = n.next_multiple_of(S::f32s::LEN).min(BATCH);
    for i in &tape.code.instructions {
        Kernels::<S, N>::of(i.operation)(s, i, tape.data, lanes, n);
    }
}

/// How a number type lies in the registers.
pub(super) trait Slot<S: Simd>: Real<Scalar = f32, Store = Data> {
    /// Lanes a number.
    const WIDTH: usize;
    /// The numbers from point `i` on.
    fn load(s: S, lanes: &[Lane], i: usize) -> Self;
    /// Writes them.
    fn store(self, lanes: &mut [Lane], i: usize);
}

#[inline(always)]
pub(super) fn load<S: Simd>(s: S, lane: &Lane, i: usize) -> Lanes<S> {
    Lanes(S::f32s::from_slice(s, &lane.0[i..i + S::f32s::LEN]))
}

#[inline(always)]
pub(super) fn store<S: Simd>(x: Lanes<S>, lane: &mut Lane, i: usize) {
    x.0.store_slice(&mut lane.0[i..i + S::f32s::LEN]);
}

impl<S: Simd> Slot<S> for Lanes<S> {
    const WIDTH: usize = 1;
    #[inline(always)]
    fn load(s: S, lanes: &[Lane], i: usize) -> Self {
        load(s, &lanes[0], i)
    }
    #[inline(always)]
    fn store(self, lanes: &mut [Lane], i: usize) {
        store(self, &mut lanes[0], i);
    }
}

impl<S: Simd> Slot<S> for Dual<Lanes<S>> {
    const WIDTH: usize = 4;
    #[inline(always)]
    fn load(s: S, lanes: &[Lane], i: usize) -> Self {
        Dual {
            v: load(s, &lanes[0], i),
            d: [
                load(s, &lanes[1], i),
                load(s, &lanes[2], i),
                load(s, &lanes[3], i),
            ],
        }
    }
    #[inline(always)]
    fn store(self, lanes: &mut [Lane], i: usize) {
        store(self.v, &mut lanes[0], i);
        for k in 0..3 {
            store(self.d[k], &mut lanes[k + 1], i);
        }
    }
}

#[inline(always)]
fn load3<S: Simd, N: Slot<S>>(s: S, lanes: &[Lane], i: usize) -> Vec3<N> {
    let w = N::WIDTH;
    v3(
        N::load(s, &lanes[..w], i),
        N::load(s, &lanes[w..2 * w], i),
        N::load(s, &lanes[2 * w..3 * w], i),
    )
}

pub(super) type Kernel<S> = fn(S, &Instruction, &Data, &mut [Lane], usize);

/// The lanes of `count` numbers of a type from register `at` on.
#[inline(always)]
fn span<S: Simd, N: Slot<S>>(at: u16, count: usize) -> Range<usize> {
    let at = usize::from(at) * N::WIDTH;
    at..at + count * N::WIDTH
}

/// Splits the registers into what an instruction writes and what it reads.
#[inline(always)]
fn split<const M: usize>(lanes: &mut [Lane], spans: [Range<usize>; M]) -> [&mut [Lane]; M] {
    (lanes.get_disjoint_mut(spans))
        .expect("the compiler gives operands and results different registers")
}

#[inline(never)]
fn leaf<S: Simd, N: Slot<S>, E: Leaf>(
    s: S,
    i: &Instruction,
    data: &Data,
    lanes: &mut [Lane],
    n: usize,
) {
    let [out, p] = split(lanes, [span::<S, N>(i.out, 1), span::<S, N>(i.a, 3)]);
    let a = Args {
        store: data,
        at: i.at as usize,
    };
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                E::leaf(load3::<S, N>(s, p, k), a).store(out, k);
            }
        },
    );
}

#[inline(never)]
fn warp<S: Simd, N: Slot<S>, E: Warp>(
    s: S,
    i: &Instruction,
    data: &Data,
    lanes: &mut [Lane],
    n: usize,
) {
    let w = N::WIDTH;
    let [out, p] = split(lanes, [span::<S, N>(i.out, 3), span::<S, N>(i.a, 3)]);
    let a = Args {
        store: data,
        at: i.at as usize,
    };
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                let q = E::warp(load3::<S, N>(s, p, k), a);
                q.x.store(&mut out[..w], k);
                q.y.store(&mut out[w..2 * w], k);
                q.z.store(&mut out[2 * w..3 * w], k);
            }
        },
    );
}

#[inline(never)]
fn put<S: Simd, N: Slot<S>, E: Put>(
    s: S,
    i: &Instruction,
    _data: &Data,
    lanes: &mut [Lane],
    n: usize,
) {
    let w = N::WIDTH;
    let spans = [
        span::<S, N>(i.out, 3),
        span::<S, N>(i.a, 1),
        span::<S, N>(i.b, 3),
    ];
    let [out, d, p] = split(lanes, spans);
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                let q = E::put(N::load(s, d, k), load3::<S, N>(s, p, k));
                q.x.store(&mut out[..w], k);
                q.y.store(&mut out[w..2 * w], k);
                q.z.store(&mut out[2 * w..3 * w], k);
            }
        },
    );
}

#[inline(never)]
fn change<S: Simd, N: Slot<S>, E: Change>(
    s: S,
    i: &Instruction,
    data: &Data,
    lanes: &mut [Lane],
    n: usize,
) {
    let spans = [
        span::<S, N>(i.out, 1),
        span::<S, N>(i.a, 1),
        span::<S, N>(i.b, 3),
    ];
    let [out, d, p] = split(lanes, spans);
    let a = Args {
        store: data,
        at: i.at as usize,
    };
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                E::change(N::load(s, d, k), load3::<S, N>(s, p, k), a).store(out, k);
            }
        },
    );
}

#[inline(never)]
fn pair<S: Simd, N: Slot<S>, E: Pair>(
    s: S,
    i: &Instruction,
    data: &Data,
    lanes: &mut [Lane],
    n: usize,
) {
    let spans = [
        span::<S, N>(i.out, 1),
        span::<S, N>(i.a, 1),
        span::<S, N>(i.b, 1),
    ];
    let [out, x, y] = split(lanes, spans);
    let a = Args {
        store: data,
        at: i.at as usize,
    };
    s.vectorize(
        #[inline(always)]
        || {
            for k in (0..n.min(BATCH)).step_by(S::f32s::LEN) {
                E::pair(N::load(s, x, k), N::load(s, y, k), a).store(out, k);
            }
        },
    );
}

#[inline(never)]
fn mark<S: Simd, N: Slot<S>>(_s: S, i: &Instruction, _data: &Data, lanes: &mut [Lane], _n: usize) {
    let [out, x] = split(lanes, [span::<S, N>(i.out, 1), span::<S, N>(i.a, 1)]);
    out.copy_from_slice(x);
}

/// The kernels of a number type at a SIMD level, by operation.
pub(super) struct Kernels<S, N>(PhantomData<(S, N)>);

macro_rules! leaves { ($($entry:ty,)*) => { &[$(leaf::<S, N, $entry>),*] }; }
macro_rules! warps { ($($entry:ty,)*) => { &[$(warp::<S, N, $entry>),*] }; }
macro_rules! puts { ($($entry:ty,)*) => { &[$(put::<S, N, $entry>),*] }; }
macro_rules! changes { ($($entry:ty,)*) => { &[$(change::<S, N, $entry>),*] }; }
macro_rules! pairs { ($($entry:ty,)*) => { &[$(pair::<S, N, $entry>),*] }; }

impl<S: Simd, N: Slot<S>> Kernels<S, N> {
    const LEAVES: &'static [Kernel<S>] = each_leaf!(leaves);
    const WARPS: &'static [Kernel<S>] = each_warp!(warps);
    const PUTS: &'static [Kernel<S>] = each_put!(puts);
    const CHANGES: &'static [Kernel<S>] = each_change!(changes);
    const PAIRS: &'static [Kernel<S>] = each_pair!(pairs);

    #[inline(always)]
    pub(super) fn of(operation: Operation) -> Kernel<S> {
        match operation {
            Operation::Leaf(code) => Self::LEAVES[usize::from(code)],
            Operation::Warp(code) => Self::WARPS[usize::from(code)],
            Operation::Put(code) => Self::PUTS[usize::from(code)],
            Operation::Change(code) => Self::CHANGES[usize::from(code)],
            Operation::Pair(code) => Self::PAIRS[usize::from(code)],
            Operation::Mark(..) => mark::<S, N>,
        }
    }
}
