//! Occlusion by rays over the hemisphere: the reference.

use crate::secondary::{Aim, Penumbra, from_hits};
use crate::simd::{load_words, splat};
use crate::tile::{Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use std::ops::Range;
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Vec3};
use zeroset_shade::occlusion::obscurance;
use zeroset_shade::sampling::{UNIT, cosine_direction, sobol};

/// A ray that counts the more, the farther it gets: see [`obscurance`].
#[derive(Clone, Copy)]
pub(super) struct Near {
    pub(super) tau: f32,
}

impl<S: Simd> Penumbra<S> for Near {
    const HARD: bool = true;
    #[inline(always)]
    fn width(self) -> f32 {
        0.0
    }
    #[inline(always)]
    fn darken(
        self,
        light: Lanes<S>,
        _f: Lanes<S>,
        _t: Lanes<S>,
        _z: Lanes<S>,
        _r: Lanes<S>,
    ) -> Lanes<S> {
        light
    }
    #[inline(always)]
    fn dark(self, light: Lanes<S>, f: Lanes<S>) -> LaneMask<S> {
        f.below(light)
    }
    #[inline(always)]
    fn stopped(self, t: Lanes<S>) -> Lanes<S> {
        obscurance(t, self.tau)
    }
}

/// Ray number `index` of every hit.
struct Around<'a> {
    index: u32,
    reach: f32,
    scramble: &'a [Vec<u32>; 2],
}

impl<S: Simd> Aim<S> for Around<'_> {
    #[inline(always)]
    fn common(&self) -> Option<[f32; 3]> {
        None
    }
    #[inline(always)]
    fn direction(
        &self,
        at: usize,
        origin: Vec3<Lanes<S>>,
        normal: Vec3<Lanes<S>>,
    ) -> (Vec3<Lanes<S>>, Lanes<S>) {
        let s = origin.x.0.token();
        let point = sobol(self.index);
        let u: S::u32s = (load_words(s, &self.scramble[0], at) ^ point[0]) >> 8;
        let v: S::u32s = (load_words(s, &self.scramble[1], at) ^ point[1]) >> 8;
        let (u, v) = (
            Lanes::<S>(u.to_float::<S::f32s>()),
            Lanes::<S>(v.to_float::<S::f32s>()),
        );
        (
            cosine_direction(normal, u * UNIT, v * UNIT),
            splat(s, self.reach),
        )
    }
}

/// The mean over rays that are spread by the cosine law of what they see: the reference (Tomczak 2012, equations 3.18 and
/// 3.19).
pub(super) fn hemisphere<S: Simd, P: Penumbra<S>>(
    s: S,
    solid: &Solid<'_>,
    kind: P,
    rays: u32,
    reach: Option<f32>,
    range: Range<usize>,
    q: &mut Scratch,
) {
    q.hits.open[range.clone()].fill(0.0);
    let scramble = std::mem::take(&mut q.scramble);
    for index in 0..rays {
        if solid.stop.is_set() {
            break;
        }
        let aim = Around {
            index,
            reach: reach.unwrap_or(f32::INFINITY),
            scramble: &scramble,
        };
        q.counts.occlusion += from_hits(s, kind, &aim, solid, range.clone(), q);
        for (open, lit) in q.hits.open[range.clone()]
            .iter_mut()
            .zip(&q.lit[range.clone()])
        {
            *open += lit / rays as f32;
        }
    }
    q.scramble = scramble;
}
