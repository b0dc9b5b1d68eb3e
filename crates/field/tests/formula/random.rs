//! Random formulas: no gradient that can be found is longer than the proven slope.

use super::Random;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::formula::{Binary, Budget, Formula, FormulaStep, ProofError, Steps, Unary};
use zeroset_number::{Dual, F64, Interval, v3};

/// A step from four numbers, whatever they are: operands are earlier steps, mostly the latest.
fn step(at: usize, [kind, a, b]: [u32; 3], constant: f64) -> FormulaStep {
    let operand = |x: u32| {
        let back = 1 + x % 97 % 5 % at as u32;
        at as u32 - back
    };
    match kind % 16 {
        0 => FormulaStep::Coordinate((a % 3) as u8),
        1 | 2 => FormulaStep::Constant(constant),
        k @ 3..=8 => {
            let _ = k;
            FormulaStep::Unary(Unary::ALL[a as usize % Unary::ALL.len()], operand(b))
        }
        _ => {
            let f = Binary::ALL[kind as usize / 16 % Binary::ALL.len()];
            FormulaStep::Binary(f, operand(a), operand(b))
        }
    }
}

fn formulas() -> impl Strategy<Value = Steps> {
    let constant = prop_oneof![
        -4.0..4.0_f64,
        Just(0.0),
        Just(1.0),
        Just(-0.5),
        Just(2.0),
        Just(10.0)
    ];
    proptest::collection::vec((any::<[u32; 3]>(), constant), 1..24).prop_filter_map(
        "a power of a negative constant",
        |list| {
            let mut steps = vec![
                FormulaStep::Coordinate(0),
                FormulaStep::Coordinate(1),
                FormulaStep::Coordinate(2),
            ];
            for (numbers, constant) in list {
                steps.push(step(steps.len(), numbers, constant));
            }
            Steps::new(steps).ok()
        },
    )
}

fn at(steps: &Steps, p: [f64; 3]) -> f64 {
    steps.eval(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn no_gradient_is_longer_than_the_proven_slope(
        steps in formulas(),
        centre in prop::array::uniform3(-2.0..2.0_f64),
        half in prop::array::uniform3(0.05..2.0_f64),
        seed in 1..u64::MAX,
    ) {
        let bounds = Aabb::new(
            std::array::from_fn(|k| centre[k] - half[k]),
            std::array::from_fn(|k| centre[k] + half[k]),
        );
        let budget = Budget { operations: 4000, ..Budget::default() };
        let formula = match Formula::prove(steps.clone(), bounds, &budget) {
            Ok(formula) => formula,
            Err(ProofError::Unbounded(o)) => {
                prop_assert!(bounds.grow(1e-6).contains(o.within.centre()));
                return Ok(());
            }
            Err(ProofError::Steep { .. } | ProofError::Negative(_)) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(other.to_string())),
        };
        let bounds = formula.bounds();
        let slope = formula.slope();
        prop_assert!(formula.steepest() <= slope * (1.0 + 1e-9));
        let mut r = Random(seed);
        for _ in 0..40 {
            let p: [f64; 3] = std::array::from_fn(|k| {
                // now and then on a side
                let t = (1.2 * r.unit() - 0.1).clamp(0.0, 1.0);
                (bounds.min[k] + t * (bounds.max[k] - bounds.min[k])).clamp(bounds.min[k], bounds.max[k])
            });
            let d = steps.eval(Dual::point(v3(F64(p[0]), F64(p[1]), F64(p[2]))));
            let length = d.d.iter().map(|x| x.0 * x.0).sum::<f64>().sqrt();
            prop_assert!(d.v.0.is_finite(), "{} at {p:?}", d.v.0);
            prop_assert!(length <= slope * (1.0 + 1e-9), "{length} at {p:?} is more than {slope}");
            // two points of the box, near or far
            let scale = 10_f64.powf(-5.0 * r.unit());
            let q: [f64; 3] = std::array::from_fn(|k| {
                let step = (2.0 * r.unit() - 1.0) * scale * half[k];
                (p[k] + step).clamp(bounds.min[k], bounds.max[k])
            });
            let way = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
            let (a, b) = (at(&steps, p), at(&steps, q));
            // what values of this size may be rounded by
            let rounding = 1e-12 * (1.0 + a.abs() + b.abs() + slope);
            prop_assert!(
                (a - b).abs() <= slope * way * (1.0 + 1e-9) + rounding,
                "{a} at {p:?} and {b} at {q:?}: {} is more than {slope}", (a - b).abs() / way
            );
        }
        // a cut lies on a side, inside the surface
        if let Some(p) = formula.cut_at() {
            prop_assert!(at(&steps, p) < 0.0 && bounds.contains(p));
            prop_assert!((0..3).any(|k| p[k] == bounds.min[k] || p[k] == bounds.max[k]));
        }
        let range = steps.eval(v3(
            Interval::new(bounds.min[0], bounds.max[0]),
            Interval::new(bounds.min[1], bounds.max[1]),
            Interval::new(bounds.min[2], bounds.max[2]),
        ));
        prop_assert!(range.contains(at(&steps, bounds.centre())));
    }
}

#[test]
fn many_random_formulas_are_proven() {
    let mut runner = TestRunner::deterministic();
    let budget = Budget {
        operations: 4000,
        ..Budget::default()
    };
    let mut proven = 0;
    for _ in 0..400 {
        let steps = formulas().new_tree(&mut runner).unwrap().current();
        let bounds = Aabb::new([0.5; 3], [1.0; 3]);
        proven += usize::from(Formula::prove(steps, bounds, &budget).is_ok());
    }
    assert!(proven > 200, "{proven} of 400");
}
