//! Shadows: how much of a light reaches the hits.

use crate::beam::{Aim, Penumbra, stream};
use crate::simd::{constant, load3, splat, store};
use crate::tile::{Scratch, Solid};
use fearless_simd::{Simd, prelude::*};
use zeroset_number::lanes::LaneMask;
use zeroset_number::{Lanes, Ops, Real, Vec3, v3};
use zeroset_scene::light::{Light, Source};
use zeroset_scene::settings::Shadow;

/// Less light than this counts as dark: a picture of 8 bits can hardly show it.
pub(crate) const DARK: f32 = 1.0 / 256.0;

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

/// The least `sharpness * f / t` (Tomczak 2012, algorithm 3.3).
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
        light.min(f * self.sharpness / t)
    }
    #[inline(always)]
    fn dark(self, light: Lanes<S>, _f: Lanes<S>) -> LaneMask<S> {
        light.below(DARK)
    }
}

/// As [`Soft`], at the closest place between two samples (Aaltonen 2018).
#[derive(Clone, Copy)]
struct Closest {
    sharpness: f32,
}

/// How far before the sample `f` a ray came closest to the surface, and how close, if the surface is seen from both samples
/// at the same place: `y = (z^2 + f^2 - r^2) / (2 z)`, which for `z = r` is Aaltonen's `f^2 / (2 r)`. Steps beyond the
/// sphere of the last sample have no such place.
#[inline(always)]
pub(crate) fn closest<R: Real<Scalar = f32>>(f: R, z: R, r: R) -> (R, R) {
    let y = (z.sq() + f.sq() - r.sq()) / (z * 2.0).max(1e-20);
    // none before the first sample, none where the ray moves away
    let none = !z.above(0.0) | z.above(r * 1.000_001) | !f.below(r);
    let y = R::select(none, f.lit(0.0), y.max(0.0));
    (y, (f.sq() - y.sq()).max(0.0).sqrt())
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
        let (y, d) = closest(f, z, r);
        // a sample within the solid is dark, however close the surface
        let d = Lanes::select(f.below(0.0), f, d);
        light.min(d * self.sharpness / (t - y).max(1e-20))
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
            Source::Point { .. } => None,
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

/// Direction to the light, and the distance to it.
#[inline(always)]
pub(crate) fn towards<R: Real<Scalar = f32>>(source: &Source, p: Vec3<R>) -> (Vec3<R>, R) {
    match source {
        Source::Directional { direction } => (
            constant(p.x, (-*direction).to_array()),
            p.x.lit(f32::INFINITY),
        ),
        Source::Point { position } => {
            let to = -(p - v3(position.x, position.y, position.z));
            let distance = to.length().max(1e-18);
            (to / distance, distance)
        }
    }
}

/// Finds how much of `light` reaches every hit: 0 where the surface faces away.
pub(crate) fn shadows<S: Simd>(s: S, solid: &Solid<'_>, light: &Light, q: &mut Scratch) {
    let aim = ToLight {
        source: &light.source,
    };
    let all = 0..q.hits.count;
    q.counts.shadow += match light.shadow {
        Shadow::None => unshadowed(s, light, q),
        Shadow::Hard => stream(s, Hard, &aim, solid, all, q),
        Shadow::Soft { sharpness } => stream(s, Soft { sharpness }, &aim, solid, all, q),
        Shadow::SoftClosest { sharpness } => stream(s, Closest { sharpness }, &aim, solid, all, q),
    };
}

fn unshadowed<S: Simd>(s: S, light: &Light, q: &mut Scratch) -> u64 {
    s.vectorize(
        #[inline(always)]
        || {
            let hits = &mut q.hits;
            for i in (0..hits.count).step_by(S::f32s::LEN) {
                let (to, _) = towards(&light.source, load3(s, &hits.point, i));
                let facing = load3(s, &hits.normal, i).dot(to).above(0.0);
                store(
                    Lanes::select(facing, splat(s, 1.0), splat(s, 0.0)),
                    &mut hits.lit,
                    i,
                );
            }
            0
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two samples that see one point at height `h` over the ray's place `c`.
    #[test]
    fn the_closest_place_is_the_foot_of_the_perpendicular() {
        let close =
            |a: f32, b: f32| assert!((a - b).abs() < 2e-3 * b.max(1.0), "{a} instead of {b}");
        let mut beyond = 0;
        for (c, h) in [(2.0f32, 0.5f32), (3.0, 1.0), (1.0, 0.01), (8.0, 0.3)] {
            for share in [0.1f32, 0.4, 0.8] {
                let t = c * share;
                let r = (c - t).hypot(h);
                for z in [0.5 * r, 0.9 * r, r] {
                    let f = (t + z - c).hypot(h);
                    let (y, d) = closest(f, z, r);
                    if f < r && t + z > c {
                        // the sample is that far behind the foot
                        close(t + z - y, c);
                        close(d, h);
                        beyond += 1;
                    } else {
                        // nothing closer has been passed
                        close(y, 0.0);
                        close(d, f);
                    }
                }
            }
        }
        assert!(beyond >= 10, "{beyond}");
        // the first sample, and a step out of the sphere of the last one
        assert_eq!(closest(0.5, 0.0, 0.0), (0.0, 0.5));
        assert_eq!(closest(0.5, 1.1, 1.0), (0.0, 0.5));
    }
}
