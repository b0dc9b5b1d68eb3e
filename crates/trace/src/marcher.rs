//! How far a ray goes from one sample of the field to the next: the marchers, each one formula over any number type; and
//! what is a hit.
//!
//! A marcher keeps the last good place `t` of a ray, the radius `r` of the unbounding sphere there, the step `z` to the next
//! sample and one number of its own. A sample whose sphere does not overlap the last one is taken back: with the signed test
//! `z > r + f` and never `z > r + |f|`, which walks through flat faces met head-on.
//!
//! A ray ends where the field changes its sign. How near it came to a surface says nothing: values are bounds, which may be
//! far less than the distance, and what a ray passes by it does not hit. Near the surface a ray guesses where the sign
//! changes, from the slope between its last two samples. Steps along a surface that are [`Reach::least`] are not proven any more, nor are [`Reach::tiny`] ones towards
//! it: a body that is not longer than that along the ray may be passed.

use zeroset_number::Real;
use zeroset_shade::march::{
    GUESS_BEYOND, GUESS_LONGEST, LEAST_ROUNDINGS, LEAST_ROUNDINGS_BEHIND, Rough, TOWARDS,
    planar_step, slope_step, smoothed,
};

/// Where a ray is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayState<R> {
    /// Up to here nothing was passed.
    pub(crate) t: R,
    /// The next sample is this much farther. Zero before the first sample only. Negative, with the same meaning, where the
    /// step is a guess of where the sign changes.
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
    pub(crate) step: RayState<R>,
    /// Whether the surface is found: at `step.t`, or between `step.t` and the sample where that is behind the surface.
    pub(crate) hit: R::Mask,
}

/// What is small at the place of a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach<R> {
    /// Radius of the footprint.
    pub(crate) near: R,
    /// Steps along a surface are never shorter.
    pub(crate) least: R,
    /// Nor are those towards one.
    pub(crate) tiny: R,
    /// A value below this is behind the surface. One closer to zero may have its sign from rounding: it is, where the value at
    /// the last place was negative too, for what rounding does is over within the step from there.
    pub(crate) behind: R,
}

/// A way to choose steps.
pub(crate) trait Marcher: Copy + Send + Sync {
    /// Whether samples between which there may be a surface are taken back.
    const CAREFUL: bool = true;
    /// How far the first sample is where nothing is nearer than `r`, and `m` is a guess of the slope.
    fn begin<R: Rough<Scalar = f32>>(self, r: R, m: R) -> R;
    /// The next step from a place with the radius `r`, `z` behind one of radius `before`; its own number. After the `first`
    /// sample there is none before.
    fn next<R: Rough<Scalar = f32>>(self, r: R, z: R, before: R, m: R, first: R::Mask) -> (R, R);
    /// The marcher's own number after a sample was taken back.
    fn back<R: Rough<Scalar = f32>>(self, m: R) -> R {
        m
    }
}

/// What follows from the value `f`, positive on the side that is marched, at the end of the step. `touch`: whether the
/// surface is found already where `f` is less than the footprint, as for cones and for fractals.
#[inline(always)]
pub(crate) fn advance<R: Rough<Scalar = f32>, M: Marcher>(
    marcher: M,
    touch: bool,
    at: RayState<R>,
    f: R,
    reach: Reach<R>,
    first: R::Mask,
) -> Advance<R> {
    let guessed = at.z.below(0.0);
    let z = at.z.abs();
    let crossed = f.below(reach.behind) | (f.below(0.0) & at.r.below(0.0));
    if !M::CAREFUL {
        let (next, m) = marcher.next(f, z, at.r, at.m, first);
        let step = RayState {
            t: R::select(crossed, at.t, at.t + z),
            z: next,
            r: R::select(crossed, at.r, f),
            m,
        };
        return Advance { step, hit: crossed };
    }
    // a gap between the spheres; none where the step was within the first of them, or the least there is and not a guess
    let gap = z.above(at.r) & z.above(f + at.r) & (guessed | z.above(reach.least));
    let hit = if touch {
        !gap & f.below(reach.near)
    } else {
        crossed & (!gap | guessed)
    };
    let stay = gap | (hit & crossed);
    let (t, r) = (R::select(stay, at.t, at.t + z), R::select(stay, at.r, f));
    let (next, m) = marcher.next(r, z, at.r, at.m, first);
    let m = R::select(gap, marcher.back(at.m), m);
    let fall = at.r - f;
    let next = if touch {
        R::select(gap, r, next).max(reach.least)
    } else {
        // steps that are longer than the radius are tested, and must be so long that they are
        let next = R::select(gap | next.below(reach.least), r, next);
        let towards = gap | (!first & fall.above(z * TOWARDS));
        // from a value below zero farther than rounding reaches where the slope is the least of those: two such, and it is a
        // surface
        let behind = R::select(
            r.below(0.0),
            reach.tiny * (LEAST_ROUNDINGS_BEHIND / LEAST_ROUNDINGS),
            reach.tiny,
        )
        .min(reach.least);
        let floor = R::select(towards, behind, reach.least);
        let next = next.max(floor);
        // where the surface should be, going on as from the last sample to this one
        let guess = r * z * (fall.max(1e-30)).rough_recip() * GUESS_BEYOND + reach.least;
        let fit = !gap
            & !first
            & f.below(reach.near)
            & !f.below(0.0)
            & fall.above(0.0)
            & guess.above(next)
            & guess.below(reach.near * GUESS_LONGEST);
        R::select(fit, -guess, next)
    };
    let step = RayState { t, z: next, r, m };
    Advance { step, hit }
}

/// Steps of the field's value (Hart 1996).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere;

impl Marcher for Sphere {
    #[inline(always)]
    fn begin<R: Rough<Scalar = f32>>(self, r: R, _m: R) -> R {
        r
    }
    #[inline(always)]
    fn next<R: Rough<Scalar = f32>>(
        self,
        r: R,
        _z: R,
        _before: R,
        m: R,
        _first: R::Mask,
    ) -> (R, R) {
        (r, m)
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
    fn begin<R: Rough<Scalar = f32>>(self, r: R, _m: R) -> R {
        r
    }
    #[inline(always)]
    fn next<R: Rough<Scalar = f32>>(self, r: R, _z: R, _before: R, m: R, first: R::Mask) -> (R, R) {
        let m = R::select(first, r.lit(self.omega), m);
        (r * m, m)
    }
    #[inline(always)]
    fn back<R: Rough<Scalar = f32>>(self, m: R) -> R {
        m.lit(1.0)
    }
}

/// Steps to where the next sphere would touch this one if the surface were a plane (Balint and Valasek 2018).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Enhanced {
    pub(crate) share: f32,
}

impl Marcher for Enhanced {
    #[inline(always)]
    fn begin<R: Rough<Scalar = f32>>(self, r: R, _m: R) -> R {
        r
    }
    #[inline(always)]
    fn next<R: Rough<Scalar = f32>>(self, r: R, z: R, before: R, m: R, first: R::Mask) -> (R, R) {
        (
            R::select(first, r, planar_step(r, before, z, self.share)),
            m,
        )
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
    fn begin<R: Rough<Scalar = f32>>(self, r: R, m: R) -> R {
        slope_step(r, m)
    }
    #[inline(always)]
    fn next<R: Rough<Scalar = f32>>(self, r: R, z: R, before: R, m: R, first: R::Mask) -> (R, R) {
        let m = R::select(first, m, smoothed(m, before, r, z, self.beta));
        (self.begin(r, m), m)
    }
    #[inline(always)]
    fn back<R: Rough<Scalar = f32>>(self, m: R) -> R {
        m.lit(-1.0)
    }
}

/// Constant steps to the first change of sign (Tomczak 2012, algorithm 2.1; Munini 2021, 3.2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fixed {
    pub(crate) step: f32,
}

impl Marcher for Fixed {
    const CAREFUL: bool = false;
    #[inline(always)]
    fn begin<R: Rough<Scalar = f32>>(self, r: R, _m: R) -> R {
        r.lit(0.0)
    }
    #[inline(always)]
    fn next<R: Rough<Scalar = f32>>(
        self,
        r: R,
        _z: R,
        _before: R,
        m: R,
        _first: R::Mask,
    ) -> (R, R) {
        (r.lit(self.step), m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEAR: f32 = 1e-3;

    /// Marches along a function of one variable with slope at most 1; where the sign changed, the samples it took.
    fn run<M: Marcher>(m: M, f: impl Fn(f32) -> f32, end: f32) -> (Option<[f32; 2]>, u32) {
        let mut at = RayState {
            t: 0.0,
            z: 0.0,
            r: 0.0,
            m: if M::CAREFUL { -1.0 } else { 0.0 },
        };
        let reach = Reach {
            near: NEAR,
            least: NEAR / 16.0,
            tiny: 4e-6,
            behind: -1e-6,
        };
        for samples in 1..1_000_000 {
            let to = at.t + at.z.abs();
            let next = advance(m, false, at, f(to), reach, samples == 1);
            if next.hit {
                return (Some([next.step.t, to]), samples);
            }
            at = next.step;
            if at.t + at.r.max(0.0) >= end {
                return (None, samples);
            }
            at.z = at.z.min(end - at.t);
        }
        panic!("the ray stands still at {}", at.t);
    }

    /// A function along a ray and its first root.
    type Case = (fn(f32) -> f32, Option<f32>);

    const CASES: [Case; 12] = [
        // a wall met head-on, thick, thin, and thinner than a step
        (|t| 3.0 - t, Some(3.0)),
        (|t| (t - 3.0).abs() - 0.01, Some(2.99)),
        (|t| (2.0 - t).max(t - 2.05), Some(2.0)),
        // a wire of a tenth of a footprint, and a leaf of a hundredth that is met aslant
        (|t| (t - 2.0).abs() - 0.000_1, Some(1.999_9)),
        (|t| (t - 2.0).abs() * 0.4 - 0.000_02, Some(1.999_95)),
        // a ball met at its edge and ones that are passed by: far, and by less than the footprint
        (|t| (t - 4.0).hypot(1.0) - 1.001, Some(3.955_267)),
        (|t| (t - 4.0).hypot(1.0) - 0.99, None),
        (|t| (t - 4.0).hypot(1.0) - 0.999_9, None),
        // a floor that falls away before a wall
        (|t| (0.01 + t * 0.9).min((t - 6.0).abs() - 0.02), Some(5.98)),
        (|t| 0.3 + 0.2 * (4.0 * t).sin() * (t * 0.7).cos(), None),
        // a skin without thickness before a wall
        (|t| (t - 3.0).abs().min((t - 6.0).abs() - 0.02), Some(5.98)),
        // a bound that is a hundredth of the distance: the root, and not where the value is small
        (|t| (3.0 - t) * 0.01, Some(3.0)),
    ];

    fn check<M: Marcher>(m: M, name: &str) -> u32 {
        let mut samples = 0;
        for (i, (f, root)) in CASES.iter().enumerate() {
            let (found, n) = run(m, f, 10.0);
            samples += n;
            match (found, root) {
                (Some([near, far]), Some(r)) => {
                    assert!(
                        near < r + 4e-5 && far > r - 1e-5 && f(far) < 0.0,
                        "{name}, case {i}: {near} to {far} instead of {r}"
                    );
                    assert!(f(near) >= -1e-5, "{name}, case {i}: begins behind");
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
        check(Fixed { step: 0.000_02 }, "fixed");
        let auto = check(Auto { beta: 0.3 }, "auto");
        assert!(auto < sphere, "{auto} samples instead of {sphere}");
    }

    /// Steps that are too long and never taken back.
    #[derive(Clone, Copy)]
    struct Careless;
    impl Marcher for Careless {
        const CAREFUL: bool = false;
        fn begin<R: Rough<Scalar = f32>>(self, r: R, _m: R) -> R {
            r
        }
        fn next<R: Rough<Scalar = f32>>(
            self,
            r: R,
            _z: R,
            _before: R,
            m: R,
            _first: R::Mask,
        ) -> (R, R) {
            (r.max(0.0) * 1.3 + 0.01, m)
        }
    }

    #[test]
    fn steps_without_a_test_pass_surfaces() {
        let passed = |(f, root): &Case| root.is_some() && run(Careless, f, 10.0).0.is_none();
        assert!(CASES.iter().any(passed));
    }
}
