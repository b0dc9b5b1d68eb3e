//! How far a ray goes from one sample of the field to the next: the marchers, each one formula over any number type.
//!
//! A marcher keeps the last good place `t` of a ray, the radius `r` of the unbounding sphere there, the step `z` to the next
//! sample and one number of its own. All but [`Fixed`] take a sample back when its sphere does not overlap the last one:
//! with the signed test `z > r + f` and never `z > r + |f|`, which walks through flat faces met head-on.

use fearless_simd::{Simd, prelude::*};
use zeroset_field::number::{Lanes, Real};

/// Numbers whose reciprocal can be had cheaply where it need not be right: a step that is a little off is still tested.
pub(crate) trait Rough: Real<Scalar = f32> {
    /// Nearly `1 / self`.
    fn rough_recip(self) -> Self;
}

impl Rough for f32 {
    fn rough_recip(self) -> f32 {
        1.0 / self
    }
}

impl<S: Simd> Rough for Lanes<S> {
    #[inline(always)]
    fn rough_recip(self) -> Self {
        Lanes(self.0.approximate_recip())
    }
}

/// Where a ray is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<R> {
    /// Up to here nothing was passed.
    pub(crate) t: R,
    /// The next sample is this much farther. Zero before the first sample only.
    pub(crate) z: R,
    /// Radius of the unbounding sphere at `t`.
    pub(crate) r: R,
    /// The marcher's own number.
    pub(crate) m: R,
}

/// What a sample led to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Advance<R: Real> {
    /// The ray afterwards.
    pub(crate) step: Step<R>,
    /// Whether the sample counts; otherwise it was taken back.
    pub(crate) kept: R::Mask,
    /// Whether the surface is found.
    pub(crate) hit: R::Mask,
}

/// A way to choose steps.
pub(crate) trait Marcher: Copy + Send + Sync {
    /// How far the first sample is where nothing is nearer than `r`, and `m` is a guess of the slope.
    fn begin<R: Rough>(self, r: R, m: R) -> R;
    /// What follows from the value `f` at `t + z`, positive on the side that is marched. At the `first` sample `r` is not the
    /// value at `t` but less. `threshold` is the value that counts as a hit; steps are never much shorter.
    fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, first: R::Mask) -> Advance<R>;
}

/// Share of the threshold that a step is at least long. Longer ones could circle around a surface; with none, a ray that
/// touches a surface would stand still.
const LEAST: f32 = 0.5;
/// Steeper slopes along the ray count as this: a step is at most a hundred radii long.
const STEEPEST: f32 = 0.98;

/// Keeps or takes back the sample: place, radius and whether it was kept.
#[inline(always)]
fn settle<R: Real<Scalar = f32>>(at: Step<R>, f: R, apart: R::Mask) -> (R, R, R::Mask) {
    let t = R::select(apart, at.t, at.t + at.z);
    let r = R::select(apart, at.r, f);
    (t, r, !apart)
}

/// Whether the unbounding spheres of the last two samples leave a gap. A step within the first sphere never does.
#[inline(always)]
fn apart<R: Real<Scalar = f32>>(at: Step<R>, f: R) -> R::Mask {
    at.z.above(at.r) & at.z.above(f + at.r)
}

/// Steps of the field's value (Hart 1996).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere;

impl Marcher for Sphere {
    #[inline(always)]
    fn begin<R: Rough>(self, r: R, _m: R) -> R {
        r
    }
    #[inline(always)]
    fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, _first: R::Mask) -> Advance<R> {
        let kept = at.z.above(f32::NEG_INFINITY);
        let step = Step {
            t: at.t + at.z,
            z: f.max(threshold * LEAST),
            r: f,
            m: at.m,
        };
        Advance {
            step,
            kept,
            hit: f.below(threshold),
        }
    }
}

/// Over-relaxation by a constant factor (Keinert 2014, 3.1, listing 2 corrected): after the first gap the ray goes back to the
/// edge of the last good sphere and on without relaxation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relaxed {
    pub(crate) omega: f32,
}

impl Marcher for Relaxed {
    #[inline(always)]
    fn begin<R: Rough>(self, r: R, _m: R) -> R {
        r
    }
    #[inline(always)]
    fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, first: R::Mask) -> Advance<R> {
        let gap = apart(at, f);
        let (t, r, kept) = settle(at, f, gap);
        let m = R::select(gap, r.lit(1.0), R::select(first, r.lit(self.omega), at.m));
        let step = Step {
            t,
            z: (r * m).max(threshold * LEAST),
            r,
            m,
        };
        Advance {
            step,
            kept,
            hit: kept & f.below(threshold),
        }
    }
}

/// Steps to where the next sphere would touch this one if the surface were a plane (Balint and Valasek 2018).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Enhanced {
    pub(crate) share: f32,
}

impl Marcher for Enhanced {
    #[inline(always)]
    fn begin<R: Rough>(self, r: R, _m: R) -> R {
        r
    }
    #[inline(always)]
    fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, first: R::Mask) -> Advance<R> {
        let gap = apart(at, f);
        let (t, r, kept) = settle(at, f, gap);
        // z = r + w r (d - r0 + r) / (d + r0 - r)
        let ahead = at.z - at.r + f;
        let behind = (at.z + at.r - f).max(at.z * (1.0 - STEEPEST)).max(1e-20);
        let guess = r + r * (ahead * behind.rough_recip()).max(0.0) * self.share;
        let z = R::select(first | gap, r, guess);
        let step = Step {
            t,
            z: z.max(threshold * LEAST),
            r,
            m: at.m,
        };
        Advance {
            step,
            kept,
            hit: kept & f.below(threshold),
        }
    }
}

/// Over-relaxation from the slope of the field along the ray, smoothed over its samples (Ban and Valasek 2023). Its number is
/// the slope: -1 at the start, or what is known of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Auto {
    pub(crate) beta: f32,
}

impl Marcher for Auto {
    #[inline(always)]
    fn begin<R: Rough>(self, r: R, m: R) -> R {
        r * (m.one_minus().rough_recip() * 2.0).max(1.0)
    }
    #[inline(always)]
    fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, first: R::Mask) -> Advance<R> {
        let gap = apart(at, f);
        let (t, r, kept) = settle(at, f, gap);
        let slope = ((f - at.r) * at.z.max(1e-20).rough_recip()).clamp(-1.0, 1.0);
        let m = R::select(first, at.m, at.m.mix(slope, self.beta).min(STEEPEST));
        // after a gap the step must be the radius itself: no other is sure to be kept
        let z = R::select(gap, r, self.begin(r, m)).max(threshold * LEAST);
        let step = Step {
            t,
            z,
            r,
            m: R::select(gap, r.lit(-1.0), m),
        };
        Advance {
            step,
            kept,
            hit: kept & f.below(threshold),
        }
    }
}

/// Constant steps to the first change of sign, then bisection (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed {
    pub(crate) step: f32,
}

impl Marcher for Fixed {
    #[inline(always)]
    fn begin<R: Rough>(self, r: R, _m: R) -> R {
        r.lit(0.0)
    }
    #[inline(always)]
    fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, _first: R::Mask) -> Advance<R> {
        let passed = f.below(0.0);
        // m tells whether the surface lies within the last step
        let within = at.m.above(0.0) | passed;
        let half = at.z.abs() * 0.5;
        let z = R::select(within, R::select(passed, -half, half), half.lit(self.step));
        let step = Step {
            t: at.t + at.z,
            z,
            r: f.lit(0.0),
            m: R::select(within, f.lit(1.0), f.lit(0.0)),
        };
        Advance {
            step,
            kept: at.z.above(f32::NEG_INFINITY),
            hit: within & half.below(threshold * 0.5),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Marches along a function of one variable with slope at most 1; the hit, the samples it took.
    fn run<M: Marcher>(m: M, f: impl Fn(f32) -> f32, end: f32) -> (Option<f32>, u32) {
        let mut at = Step {
            t: 0.0,
            z: 0.0,
            r: 0.0,
            m: 0.0,
        };
        for samples in 1..10_000 {
            let next = m.advance(at, f(at.t + at.z), 1e-4, samples == 1);
            if next.hit {
                return (Some(next.step.t), samples);
            }
            at = next.step;
            if at.t + at.r >= end {
                return (None, samples);
            }
            at.z = at.z.min(end - at.t);
        }
        panic!("the ray stands still at {}", at.t);
    }

    /// A function along a ray and its first root.
    type Case = (fn(f32) -> f32, Option<f32>);

    const CASES: [Case; 7] = [
        // a wall met head-on, thick, thin, and thinner than a step
        (|t| 3.0 - t, Some(3.0)),
        (|t| (t - 3.0).abs() - 0.01, Some(2.99)),
        (|t| (2.0 - t).max(t - 2.05), Some(2.0)),
        // a ball met at its edge and one that is passed by
        (|t| (t - 4.0).hypot(1.0) - 1.001, Some(3.955_267)),
        (|t| (t - 4.0).hypot(1.0) - 0.99, None),
        // a floor that falls away before a wall
        (|t| (0.01 + t * 0.9).min((t - 6.0).abs() - 0.02), Some(5.98)),
        (|t| 0.3 + 0.2 * (4.0 * t).sin() * (t * 0.7).cos(), None),
    ];

    fn check<M: Marcher>(m: M, name: &str) -> u32 {
        let mut samples = 0;
        for (i, (f, root)) in CASES.iter().enumerate() {
            let (found, n) = run(m, f, 10.0);
            samples += n;
            match (found, root) {
                (Some(t), Some(r)) => {
                    assert!((t - r).abs() < 5e-3, "{name}, case {i}: {t} instead of {r}")
                }
                (None, None) => {}
                (found, root) => panic!("{name}, case {i}: {found:?} instead of {root:?}"),
            }
        }
        samples
    }

    #[test]
    fn all_find_the_first_root() {
        let sphere = check(Sphere, "sphere");
        check(Relaxed { omega: 1.2 }, "relaxed");
        check(Relaxed { omega: 1.9 }, "relaxed");
        check(Enhanced { share: 0.9 }, "enhanced");
        check(Fixed { step: 0.005 }, "fixed");
        let auto = check(Auto { beta: 0.3 }, "auto");
        assert!(auto < sphere, "{auto} samples instead of {sphere}");
    }

    /// Steps that are too long and never taken back.
    #[derive(Clone, Copy)]
    struct Careless;
    impl Marcher for Careless {
        fn begin<R: Rough>(self, r: R, _m: R) -> R {
            r
        }
        fn advance<R: Rough>(self, at: Step<R>, f: R, threshold: R, _first: R::Mask) -> Advance<R> {
            let step = Step {
                t: at.t + at.z,
                z: f.max(0.0) * 1.3 + threshold * 100.0,
                r: f.max(0.0),
                m: at.m,
            };
            Advance {
                step,
                kept: at.z.above(-1.0),
                hit: f.below(threshold) & f.above(-threshold),
            }
        }
    }

    #[test]
    fn steps_without_a_test_pass_surfaces() {
        let passed = |(f, root): &Case| root.is_some() && run(Careless, f, 10.0).0.is_none();
        assert!(CASES.iter().any(passed));
    }
}
