//! Fractals: orbits of a point under a map that is applied again and again.
//!
//! Escape-time fractals have distance *estimates* (Hart, Sandin and Kauffman 1989): good, but not proven, and reported as
//! such. Fractals by folds are bounds: every fold is a reflection and every step scales, so that the last step's distance
//! divided by all scales never overestimates.

use super::*;

mod escape;
mod fold;

pub use escape::{Apollonian, Julia, Mandelbox, Mandelbulb};
pub use fold::{Kaleidoscope, Menger, Sierpinski};

/// What a step carries: the point, a fourth coordinate, the derivative or scale so far, the distance from the origin.
pub type Orbit<R> = (Vec3<R>, R, R, R);

/// A fractal: where an orbit starts, how it goes on, what distance its end stands for.
pub trait Fractal: 'static {
    /// See [`Primitive::INFO`].
    const INFO: Info;
    /// See [`Primitive::EXACTNESS`].
    const EXACTNESS: Exactness;
    /// See [`Primitive::SAMPLES`].
    const SAMPLES: &'static [&'static [f64]] = &[];
    /// Most steps.
    fn limit<R: Real>(a: Args<'_, R>) -> R::Scalar;
    /// Before the first step.
    fn start<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> Orbit<R>;
    /// Whether the orbit goes on.
    fn live<R: Real>(orbit: Orbit<R>, a: Args<'_, R>) -> R::Mask;
    /// The next point.
    fn step<R: Real>(p: Vec3<R>, orbit: Orbit<R>, a: Args<'_, R>) -> Orbit<R>;
    /// The distance that the end of the orbit stands for.
    fn end<R: Real>(p: Vec3<R>, orbit: Orbit<R>, a: Args<'_, R>) -> R;
    /// See [`Primitive::bounds`].
    fn bounds(a: &[f64]) -> Aabb;
    /// See [`Primitive::level_bounds`].
    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        Self::bounds(a).grow(level)
    }
    /// See [`Primitive::contains`].
    fn contains(a: &[f64], p: [f64; 3]) -> bool;
    /// See [`Primitive::check`].
    fn check(_a: &[f64]) -> Result<(), String> {
        Ok(())
    }
}

impl<F: Fractal> Primitive for F {
    const INFO: Info = F::INFO;
    const EXACTNESS: Exactness = F::EXACTNESS;
    const SAMPLES: &'static [&'static [f64]] = F::SAMPLES;
    const SLACK: f64 = 2.5;
    const ROUGHNESS: Roughness = match F::EXACTNESS {
        Exactness::Estimate => Roughness::Chaotic,
        _ => Roughness::Folded,
    };
    const TRAPS: bool = true;

    #[inline(always)]
    fn distance<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> R {
        let orbit = R::repeat_while(
            F::limit(a),
            F::start(p, a),
            #[inline(always)]
            |orbit| F::live(orbit, a),
            #[inline(always)]
            |orbit| F::step(p, orbit, a),
        );
        F::end(p, orbit, a)
    }

    /// How near the orbit came to the origin and to the planes x = 0, y = 0 and z = 0.
    #[inline(always)]
    fn traps<R: Real>(p: Vec3<R>, a: Args<'_, R>) -> [R; 4] {
        let start = F::start(p, a);
        let far = p.x.lit(1e9);
        let (_, traps) = R::repeat_while(
            F::limit(a),
            (start, [far; 4]),
            #[inline(always)]
            |(orbit, _)| F::live(orbit, a),
            #[inline(always)]
            |(orbit, t): (Orbit<R>, [R; 4])| {
                let next = F::step(p, orbit, a);
                let z = next.0;
                let near = [z.length(), z.x.abs(), z.y.abs(), z.z.abs()];
                (
                    next,
                    [
                        t[0].min(near[0]),
                        t[1].min(near[1]),
                        t[2].min(near[2]),
                        t[3].min(near[3]),
                    ],
                )
            },
        );
        traps
    }

    fn bounds(a: &[f64]) -> Aabb {
        F::bounds(a)
    }

    fn level_bounds(a: &[f64], level: f64) -> Aabb {
        F::level_bounds(a, level)
    }

    fn contains(a: &[f64], p: [f64; 3]) -> bool {
        F::contains(a, p)
    }

    fn check(a: &[f64]) -> Result<(), String> {
        whole_iterations(F::INFO.params, a)?;
        F::check(a)
    }
}

/// Iterations are whole numbers.
fn whole_iterations(params: &[Param], a: &[f64]) -> Result<(), String> {
    let mut at = 0;
    for p in params {
        if p.unit == Unit::Count && a.get(at).is_some_and(|x| x.fract() != 0.0) {
            return Err(format!(
                "{} is {}, allowed are whole numbers",
                p.name, a[at]
            ));
        }
        at += p.kind.len();
    }
    Ok(())
}

/// A ball of radius `radius` around the origin.
fn ball(radius: f64) -> Aabb {
    Aabb::centred([radius; 3])
}
