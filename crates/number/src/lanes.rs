//! 4 to 16 points at once: SIMD lanes of `f32`, whichever instruction set the machine has.
//!
//! Everything here and above (formulas, closures handed to loops) must be `#[inline(always)]`: a function that is compiled
//! on its own has no vector instructions, and the lanes then travel through memory.

use super::data::Data;
use super::elementary;
use super::list::{fold_list, walk_list};
use super::real::{Ends, Masked, Ops, Real, State, along_axis, between, steps};
use super::vector::Vec3;
use fearless_simd::{Simd, prelude::*};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// The widest level has as many lanes.
const MOST_LANES: usize = 16;

/// One number for each lane.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<S: Simd>(pub S::f32s);

/// One truth value for each lane.
#[derive(Clone, Copy)]
pub struct LaneMask<S: Simd>(pub S::mask32s);

macro_rules! arithmetic {
    ($($t:ident $f:ident),*) => {$(
        impl<S: Simd> $t for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, o: Self) -> Self {
                Lanes($t::$f(self.0, o.0))
            }
        }

        impl<S: Simd> $t<f32> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $f(self, o: f32) -> Self {
                Lanes($t::$f(self.0, o))
            }
        }
    )*};
}
arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Lanes(-self.0)
    }
}

impl<S: Simd> BitAnd for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, o: Self) -> Self {
        LaneMask(self.0 & o.0)
    }
}

impl<S: Simd> BitOr for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, o: Self) -> Self {
        LaneMask(self.0 | o.0)
    }
}

impl<S: Simd> Not for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        LaneMask(!self.0)
    }
}

impl<S: Simd> Masked for Lanes<S> {
    type Mask = LaneMask<S>;
}

impl<S: Simd> Ops<Lanes<S>> for Lanes<S> {
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Lanes(self.0.min(o.0))
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Lanes(self.0.max(o.0))
    }
    #[inline(always)]
    fn below(self, o: Self) -> LaneMask<S> {
        LaneMask(self.0.simd_lt(o.0))
    }
    #[inline(always)]
    fn above(self, o: Self) -> LaneMask<S> {
        LaneMask(self.0.simd_gt(o.0))
    }
}

impl<S: Simd> Ops<f32> for Lanes<S> {
    #[inline(always)]
    fn min(self, o: f32) -> Self {
        Lanes(self.0.min(o))
    }
    #[inline(always)]
    fn max(self, o: f32) -> Self {
        Lanes(self.0.max(o))
    }
    #[inline(always)]
    fn below(self, o: f32) -> LaneMask<S> {
        LaneMask(self.0.simd_lt(o))
    }
    #[inline(always)]
    fn above(self, o: f32) -> LaneMask<S> {
        LaneMask(self.0.simd_gt(o))
    }
}

impl<S: Simd> State<Lanes<S>> for Lanes<S> {
    #[inline(always)]
    fn zip(self, o: Self, f: impl Fn(Self, Self) -> Self + Copy) -> Self {
        f(self, o)
    }
}

/// As many numbers as there are lanes.
#[inline(always)]
fn first_of<S: Simd>(s: S, numbers: &[f32; MOST_LANES]) -> Lanes<S> {
    Lanes(S::f32s::from_slice(s, &numbers[..S::f32s::LEN]))
}

impl<S: Simd> Real for Lanes<S> {
    const SHOWN: bool = true;
    type Base = Self;
    type Scalar = f32;
    type Store = Data;

    #[inline(always)]
    fn param(store: &Data, at: usize) -> f32 {
        f32::param(store, at)
    }
    #[inline(always)]
    fn fetch(store: &Data, grid: f32, node: Vec3<Self>) -> Self {
        let mut found = [f32::NAN; MOST_LANES];
        if let Some(grid) = store.grids.get(grid as usize) {
            let (x, y, z) = (
                node.x.0.as_slice(),
                node.y.0.as_slice(),
                node.z.0.as_slice(),
            );
            for k in 0..S::f32s::LEN {
                found[k] = grid.at([x[k] as usize, y[k] as usize, z[k] as usize]);
            }
        }
        Lanes(S::f32s::from_slice(
            node.x.0.token(),
            &found[..S::f32s::LEN],
        ))
    }
    #[inline(always)]
    fn sample(store: &Data, grid: f32, nodes: Vec3<f32>, p: Vec3<Self>) -> Self {
        let (x, i) = along_axis(p.x, nodes.x);
        let (y, j) = along_axis(p.y, nodes.y);
        let (z, k) = along_axis(p.z, nodes.z);
        let mut corners = [[f32::NAN; MOST_LANES]; 8];
        if let Some(grid) = store.grids.get(grid as usize) {
            grid.corners(
                [i.0.as_slice(), j.0.as_slice(), k.0.as_slice()],
                &mut corners,
            );
        }
        let s = p.x.0.token();
        let near = between(
            between(first_of(s, &corners[0]), first_of(s, &corners[1]), x),
            between(first_of(s, &corners[2]), first_of(s, &corners[3]), x),
            y,
        );
        let far = between(
            between(first_of(s, &corners[4]), first_of(s, &corners[5]), x),
            between(first_of(s, &corners[6]), first_of(s, &corners[7]), x),
            y,
        );
        between(near, far, z)
    }
    #[inline(always)]
    fn constant(c: f64) -> f32 {
        c as f32
    }
    #[inline(always)]
    fn like(self, s: f32) -> Self {
        self.lit(s)
    }
    #[inline(always)]
    fn lit(self, c: f32) -> Self {
        Lanes(S::f32s::splat(self.0.token(), c))
    }
    #[inline(always)]
    fn select(m: LaneMask<S>, yes: Self, no: Self) -> Self {
        Lanes(m.0.select(yes.0, no.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Lanes(self.0.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Lanes(self.0.abs())
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Lanes(self.0.floor())
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = elementary::sin_cos::<S>(self.0);
        (Lanes(s), Lanes(c))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        Lanes(elementary::exp::<S>(self.0))
    }
    #[inline(always)]
    fn exp2(self) -> Self {
        Lanes(elementary::exp2::<S>(self.0))
    }
    #[inline(always)]
    fn ln(self) -> Self {
        Lanes(elementary::ln::<S>(self.0))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Lanes(elementary::atan2::<S>(self.0, x.0))
    }
    #[inline(always)]
    fn powf(self, k: f32) -> Self {
        Lanes(elementary::pow::<S>(self.0, k))
    }

    #[inline(always)]
    fn repeat_while<T: State<Self>>(
        limit: f32,
        init: T,
        live: impl Fn(T) -> LaneMask<S>,
        step: impl Fn(T) -> T,
    ) -> T {
        let mut s = init;
        for _ in 0..steps(limit.into()) {
            let m = live(s).0;
            if !m.any_true() {
                break;
            }
            s = step(s).zip(
                s,
                #[inline(always)]
                |new: Self, old: Self| Lanes(m.select(new.0, old.0)),
            );
        }
        s
    }

    #[inline(always)]
    fn fold<const W: usize, T: State<Self>>(
        store: &Data,
        at: usize,
        ends: Ends,
        init: T,
        step: impl Fn(T, [f32; W], [f32; W]) -> T,
    ) -> T {
        fold_list(&store.params, at, ends, init, step)
    }

    #[inline(always)]
    fn walk<const W: usize, const V: usize, T: State<Self>>(
        store: &Data,
        at: usize,
        init: T,
        look: impl Fn(T, [f32; W]) -> (T, T, LaneMask<S>),
        take: impl Fn(T, [f32; V]) -> T,
    ) -> T {
        walk_list(
            &store.params,
            at,
            init,
            #[inline(always)]
            |s, node: [f32; W]| {
                let (entered, passed, enters) = look(s, node);
                (entered, passed, enters.0.any_true())
            },
            take,
        )
    }
}
