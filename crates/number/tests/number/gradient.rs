//! Gradients by dual numbers: against differences in `f64`, and in SIMD lanes against `f64`.

use crate::formulas::*;
use crate::support::{Formula, dual_lanes, lanes, levels, p3, reference};
use proptest::prelude::*;
use zeroset_number::{Args, Data, Dual, F64, Interval, Real, Slope, v3};

/// Points where all of them are smooth, and some where they are not.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![6 => -2.0_f32..2.0, 1 => prop::sample::select(vec![0.0, -0.0, 1.0, 0.5, 1e-8, -1e-20, 100.0])]
}

fn point() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(coordinate())
}

/// How little the gradient turns within `by` of a point: the test's own tolerance near edges and folds.
fn turn<F: Formula>(p: [f32; 3], by: f64) -> f64 {
    let side = |k: usize| Interval::new(f64::from(p[k]) - by, f64::from(p[k]) + by);
    let s = F::eval(
        Slope::point(v3(side(0), side(1), side(2))),
        Args::new(&Data::from(&PARAMS[..])),
    );
    let range = |d: Interval| d.hi - d.lo;
    range(s.d[0]).max(range(s.d[1])).max(range(s.d[2]))
}

fn gradient<F: Formula>(p: [f32; 3]) -> Dual<F64> {
    F::eval(
        Dual::point(p3(p.map(f64::from))),
        Args::new(&Data::from(&PARAMS[..])),
    )
}

/// The gradient against central differences; whether the place allowed a comparison.
fn by_differences<F: Formula>(p: [f32; 3]) -> Result<bool, TestCaseError> {
    let h = 1e-6;
    let turn = turn::<F>(p, 2.0 * h);
    if turn.is_nan() || turn > 1e-2 {
        return Ok(false);
    }
    let g = gradient::<F>(p);
    prop_assert_eq!(g.v.0, reference::<F>(&PARAMS, p.map(f64::from)));
    for k in 0..3 {
        let at = |by: f64| {
            let mut q = p.map(f64::from);
            q[k] += by;
            reference::<F>(&PARAMS, q)
        };
        let difference = (at(h) - at(-h)) / (2.0 * h);
        let tolerance = turn + 1e-8 * (1.0 + g.v.0.abs() / h * 1e-4 + difference.abs());
        prop_assert!(
            (difference - g.d[k].0).abs() <= tolerance,
            "{difference} by differences, {g:?} at {p:?}"
        );
    }
    Ok(true)
}

/// Values and gradients of lanes at every level against `f64`.
fn by_lanes<F: Formula>(points: &[[f32; 3]], tolerance: f64) -> Result<(), TestCaseError> {
    for (level, simd) in levels() {
        let values = lanes::<F>(simd, &PARAMS, points);
        for ((p, got), v) in points
            .iter()
            .zip(dual_lanes::<F>(simd, &PARAMS, points))
            .zip(values)
        {
            prop_assert_eq!(
                got[0].to_bits(),
                v.to_bits(),
                "value with and without gradient at {:?}",
                p
            );
            let near = turn::<F>(
                *p,
                1e-6 * (1.0 + f64::from(p[0].abs().max(p[1].abs()).max(p[2].abs()))),
            );
            if near.is_nan() || near > 1e-2 {
                continue;
            }
            let g = gradient::<F>(*p);
            let expected = [g.v.0, g.d[0].0, g.d[1].0, g.d[2].0];
            let size = expected.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            for k in 0..4 {
                let error = (f64::from(got[k]) - expected[k]).abs();
                prop_assert!(
                    error <= tolerance * size + near,
                    "{got:?} at {p:?} ({level}), should be {expected:?}"
                );
            }
        }
    }
    Ok(())
}

macro_rules! gradients {
    ($($test:ident $formula:ident $tolerance:literal;)*) => {
        proptest! {
            #![proptest_config(ProptestConfig::with_cases(40))]
            $(
                #[test]
                fn $test(points in prop::collection::vec(point(), 33)) {
                    for p in &points {
                        by_differences::<$formula>(*p)?;
                    }
                    by_lanes::<$formula>(&points, $tolerance)?;
                }
            )*
        }
    };
}
gradients! {
    sphere Sphere 1e-6;
    cuboid Cuboid 1e-6;
    blend Blend 5e-6;
    bulb Bulb 1e-3;
    polygon Polygon 2e-5;
    waves Waves 5e-6;
    powers Powers 5e-6;
    quotients Quotients 5e-6;
    cells Cells 1e-5;
    blends Blends 1e-5;
}

#[test]
fn most_places_are_compared() {
    let mut compared = 0;
    for i in 0..200_u32 {
        let at = |k: u32| ((i * 7919 + k * 104_729) % 1000) as f32 * 0.004 - 2.0;
        let p = [at(1), at(2), at(3)];
        let all = [
            by_differences::<Sphere>(p),
            by_differences::<Blend>(p),
            by_differences::<Polygon>(p),
            by_differences::<Waves>(p),
            by_differences::<Powers>(p),
            by_differences::<Quotients>(p),
            by_differences::<Cells>(p),
            by_differences::<Blends>(p),
        ];
        compared += all.iter().filter(|r| matches!(r, Ok(true))).count();
    }
    assert!(compared > 1300, "{compared} of 1600");
}

#[test]
fn gradients_are_finite_where_there_is_none() {
    let at = |f: fn(Dual<F64>) -> Dual<F64>, x: f64| f(Dual::point(p3([x, 0.0, 0.0])).x);
    for g in [
        at(|x| x.sqrt(), 0.0),
        at(|x| x.powf(F64(0.5)), 0.0),
        at(|x| x.powf(F64(2.0)), 0.0),
        at(|x| x.atan2(x), 0.0),
        at(|x| v3(x, x, x).length(), 0.0),
        at(|x| v3(x, x, x).normalize().x, 0.0),
        at(|x| x.acos(), 1.0),
        at(|x| x.tanh(), 100.0),
    ] {
        assert!(
            g.v.0.is_finite() && g.d.iter().all(|d| d.0.is_finite()),
            "{g:?}"
        );
    }
}
