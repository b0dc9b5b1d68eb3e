//! Shadows: how much of a light reaches the hits.

use crate::secondary::{Aim, Penumbra, from_hits};
use crate::simd::{INSIDE, along, load, load_words, load3, splat, store};
use crate::tile::{Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::settings::Shadow;
use zeroset_shade::advection::{LightVolume, Reading};
use zeroset_shade::light::towards;
use zeroset_shade::shadow::{DARK, soft, soft_closest};

/// Lit or not (Tomczak 2012, algorithm 3.2).
#[derive(Clone, Copy)]
pub(crate) struct Hard;

impl<S: Simd> Penumbra<S> for Hard {
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
}

/// The least that [`soft`] gives.
#[derive(Clone, Copy)]
struct Soft {
    sharpness: f32,
}

impl<S: Simd> Penumbra<S> for Soft {
    const HARD: bool = false;
    #[inline(always)]
    fn width(self) -> f32 {
        1.0 / self.sharpness
    }
    #[inline(always)]
    fn darken(
        self,
        light: Lanes<S>,
        f: Lanes<S>,
        t: Lanes<S>,
        _z: Lanes<S>,
        _r: Lanes<S>,
    ) -> Lanes<S> {
        light.min(soft(f, t, self.sharpness))
    }
    #[inline(always)]
    fn dark(self, light: Lanes<S>, _f: Lanes<S>) -> LaneMask<S> {
        light.below(DARK)
    }
}

/// The least that [`soft_closest`] gives.
#[derive(Clone, Copy)]
struct Closest {
    sharpness: f32,
}

impl<S: Simd> Penumbra<S> for Closest {
    const HARD: bool = false;
    #[inline(always)]
    fn width(self) -> f32 {
        1.0 / self.sharpness
    }
    #[inline(always)]
    fn darken(
        self,
        light: Lanes<S>,
        f: Lanes<S>,
        t: Lanes<S>,
        z: Lanes<S>,
        r: Lanes<S>,
    ) -> Lanes<S> {
        light.min(soft_closest(f, z, r, t, self.sharpness))
    }
    #[inline(always)]
    fn dark(self, light: Lanes<S>, _f: Lanes<S>) -> LaneMask<S> {
        light.below(DARK)
    }
}

/// Towards a light.
struct ToLight<'a> {
    source: &'a Source,
}

impl<S: Simd> Aim<S> for ToLight<'_> {
    #[inline(always)]
    fn common(&self) -> Option<[f32; 3]> {
        match self.source {
            Source::Directional { direction } => Some((-*direction).to_array()),
            _ => None,
        }
    }
    #[inline(always)]
    fn direction(
        &self,
        _at: usize,
        origin: Vec3<Lanes<S>>,
        _normal: Vec3<Lanes<S>>,
    ) -> (Vec3<Lanes<S>>, Lanes<S>) {
        towards(self.source, origin)
    }
}

/// Finds how much of `light` reaches every hit: 0 where the surface faces away. Whether anything is in its way can be asked of `marched`,
/// solids in closed form and the rest; how near a ray comes to it cannot.
pub(crate) fn shadows<S: Simd>(
    s: S,
    solid: &Solid<'_>,
    marched: &Solid<'_>,
    light: &Light,
    q: &mut Scratch,
) {
    let aim = ToLight {
        source: &light.source,
    };
    let all = 0..q.hits.count;
    q.counts.shadow += match light.shadow {
        Shadow::None => unshadowed(s, light, q),
        Shadow::Hard => from_hits(s, Hard, &aim, marched, all, q),
        Shadow::Soft { sharpness } => from_hits(s, Soft { sharpness }, &aim, solid, all, q),
        Shadow::SoftClosest { sharpness } => {
            from_hits(s, Closest { sharpness }, &aim, solid, all, q)
        }
        // none was made: nothing is in its way
        Shadow::Advected { .. } => unshadowed(s, light, q),
    };
}

/// Finds how much of a light reaches every hit by the volume that it was advected through: 0 where the surface faces away. `aim` gives the direction to the light and
/// its distance from the hits from a number on, whose rays would begin at a place. From inside a solid it is seen as if there were none.
pub(crate) fn advected<S: Simd>(
    s: S,
    volume: &LightVolume,
    reading: &Reading,
    aim: impl Fn(usize, Vec3<Lanes<S>>) -> (Vec3<Lanes<S>>, Lanes<S>),
    q: &mut Scratch,
) {
    s.vectorize(
        #[inline(always)]
        || {
            let hits = &q.hits;
            for i in (0..hits.count).step_by(S::f32s::LEN) {
                let (point, normal) = (load3(s, &hits.point, i), load3(s, &hits.normal, i));
                let (to, distance) = aim(i, along(point, normal, load(s, &hits.offset, i)));
                let side = load_words(s, &hits.word, i) & INSIDE;
                let inside = LaneMask(side.simd_gt(S::u32s::splat(s, 0)));
                let left = volume.left(reading, point, normal, to, distance);
                let left = Lanes::select(inside, splat(s, 1.0), left);
                let facing = normal.dot(to).above(0.0);
                store(Lanes::select(facing, left, splat(s, 0.0)), &mut q.lit, i);
            }
        },
    );
}

pub(crate) fn unshadowed<S: Simd>(s: S, light: &Light, q: &mut Scratch) -> u64 {
    s.vectorize(
        #[inline(always)]
        || {
            let hits = &q.hits;
            for i in (0..hits.count).step_by(S::f32s::LEN) {
                let (to, _) = towards(&light.source, load3(s, &hits.point, i));
                let facing = load3(s, &hits.normal, i).dot(to).above(0.0);
                store(
                    Lanes::select(facing, splat(s, 1.0), splat(s, 0.0)),
                    &mut q.lit,
                    i,
                );
            }
            0
        },
    )
}
