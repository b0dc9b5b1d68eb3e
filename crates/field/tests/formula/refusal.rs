//! Formulas without a slope, and what is said of them.

use super::{proven, steps};
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::formula::{Budget, Cause, Expression, Formula, Obstacle, ProofError};

fn obstacle(half: f64, f: impl Fn(&Expression) -> Expression) -> Obstacle {
    match proven(half, f) {
        Err(ProofError::Unbounded(obstacle)) => *obstacle,
        other => panic!("{other:?}"),
    }
}

/// The obstacle is of this kind, in this step, in a small box that holds this place.
fn refused(
    half: f64,
    cause: Cause,
    expression: &str,
    at: [Option<f64>; 3],
    f: impl Fn(&Expression) -> Expression,
) {
    let o = obstacle(half, f);
    assert_eq!(
        (o.cause, o.expression.as_str(), o.certain),
        (cause, expression, true),
        "{o}"
    );
    for k in 0..3 {
        if let Some(x) = at[k] {
            let (lo, hi) = (o.within.min[k], o.within.max[k]);
            assert!(
                lo <= x + 1e-3 && x - 1e-3 <= hi && hi - lo < 1e-2 * half,
                "{x} is not in {lo} to {hi}: {o}"
            );
        }
    }
}

#[test]
fn every_obstacle_is_named_with_its_place() {
    let x = |x: f64| [Some(x), None, None];
    refused(1.0, Cause::Division, "1 / x", x(0.0), |p| {
        p.y() + 1.0 / p.x()
    });
    refused(1.0, Cause::Division, "y / (x + 0.3)", x(-0.3), |p| {
        p.y() / (p.x() + 0.3)
    });
    refused(1.0, Cause::Root, "sqrt(x + 0.3)", x(-0.3), |p| {
        (p.x() + 0.3).sqrt()
    });
    refused(1.0, Cause::Logarithm, "log(abs(x))", x(0.0), |p| {
        p.x().abs().ln()
    });
    refused(1.0, Cause::Power, "pow(abs(x), 0.5)", x(0.0), |p| {
        p.x().abs().pow(0.5)
    });
    refused(1.0, Cause::Power, "pow(abs(x), y)", x(0.0), |p| {
        p.x().abs().pow(p.y())
    });
    refused(
        2.0,
        Cause::Tangent,
        "tan(abs(x))",
        x(std::f64::consts::FRAC_PI_2),
        |p| p.x().abs().tan() + p.y(),
    );
    refused(2.0, Cause::FormulaStep, "floor(x)", [None; 3], |p| {
        p.x().floor()
    });
    refused(2.0, Cause::FormulaStep, "mod(x, 0.7)", [None; 3], |p| {
        p.x().modulo(0.7) - 0.2
    });
    refused(
        2.0,
        Cause::FormulaStep,
        "floor(min(max(y, -0.5), 0.5))",
        [None, Some(0.0), None],
        |p| p.y().sign(),
    );
    // whether its slope matters or not
    refused(1.0, Cause::Division, "1 / x", x(0.0), |p| {
        (1.0 / p.x()).sin().max(2.0) + p.y()
    });
    refused(2.0, Cause::Arc, "asin(x * 0.7)", [None; 3], |p| {
        (p.x() * 0.7).asin()
    });
    refused(2.0, Cause::Arc, "acos(x)", [None; 3], |p| p.x().acos());
    refused(5.0, Cause::Overflow, "exp(x * 30)", [None; 3], |p| {
        (p.x() * 30.0).exp()
    });
    let axis = [Some(0.0), None, Some(0.0)];
    refused(1.0, Cause::Origin, "atan2(z, x)", axis, |p| {
        (p.z().atan2(p.x()) * 3.0).sin()
    });
}

#[test]
fn a_turn_is_told_of_where_it_comes_from() {
    let aside = |f: fn(&Expression) -> Expression| {
        let bounds = Aabb::new([-2.0, -1.0, -1.0], [-1.0, 1.0, 1.0]);
        match Formula::prove(steps(f), bounds, &Budget::default()) {
            Err(ProofError::Unbounded(o)) => *o,
            other => panic!("{other:?}"),
        }
    };
    let turning: [fn(&Expression) -> Expression; 8] = [
        |p| p.z().atan2(p.x()),
        |p| p.z().atan2(p.x()) * 2.0 + p.y(),
        |p| (p.z().atan2(p.x()) * 0.5).sin(),
        |p| p.z().atan2(p.x()).max(p.y()),
        |p| p.z().atan2(p.x()).abs().sqrt(),
        |p| (p.z().atan2(p.x()) * p.y()).cos(),
        |p| (p.z().atan2(p.x()) / 3.0).tan(),
        |p| (p.z().atan2(p.x()) + p.z().atan2(p.x()) * 0.5).sin(),
    ];
    for f in turning {
        let o = aside(f);
        assert_eq!(
            (o.cause, o.expression.as_str()),
            (Cause::Turn, "atan2(z, x)"),
            "{o}"
        );
        assert!(o.within.min[2] <= 0.0 && o.within.max[2] >= 0.0);
    }
    // on the other side there is no cut
    let bounds = Aabb::new([1.0, -1.0, -1.0], [2.0, 1.0, 1.0]);
    for f in [turning[0], turning[1], turning[2], turning[3], turning[7]] {
        assert!(Formula::prove(steps(f), bounds, &Budget::default()).is_ok());
    }
}

#[test]
fn the_message_says_what_where_and_what_to_do() {
    let message = |f: fn(&Expression) -> Expression| proven(1.0, f).unwrap_err().to_string();
    assert_eq!(
        message(|p| (p.x() * p.y() + p.z()).sqrt() - 0.5),
        "the slope of the formula cannot be bounded: `sqrt(x * y + z)` is infinitely steep where `x * y + z` is 0 (the \
         length of a vector is not: use length(...)) near (6.104e-5, 0.9999, 6.104e-5), where `x * y + z` is 0 to 2.441e-4; \
         change the formula or its bounds, or state the slope by hand with slope = ..., which is then reported as unproven"
    );
    assert_eq!(
        message(|p| 1.0 / p.x()),
        "the slope of the formula cannot be bounded: `1 / x` divides by `x`, which may be 0 near (6.104e-5, 0, 0), where \
         `x` is 0 to 1.221e-4; change the formula or its bounds, or state the slope by hand with slope = ..., which is \
         then reported as unproven"
    );
    assert_eq!(
        message(|p| (p.x() * 1e7).sin()),
        "the slope of the formula may be 1e7 (found: 1e7 at (0, 0, 0)), and 1e6 is the most that can be rendered; change \
         the formula or its bounds, or state the slope by hand with slope = ..., which is then reported as unproven"
    );
}

#[test]
fn long_formulas_are_shortened() {
    let o = obstacle(1.0, |p| {
        let wave = (0..40).fold(p.x(), |w, i| (w * p.y() + f64::from(i)).sin());
        1.0 / (p.z() + wave)
    });
    assert!(
        o.expression.len() <= 72 && o.expression.contains("..."),
        "{}",
        o.expression
    );
}

#[test]
fn boxes_are_checked() {
    let refused = |min: [f64; 3], max: [f64; 3]| {
        let list = steps(|p| p.length() - 1.0);
        Formula::prove(list, Aabb::new(min, max), &Budget::default()).unwrap_err()
    };
    assert_eq!(
        refused([-1.0; 3], [1.0, -1.0, 1.0]).to_string(),
        "the bounds of a formula must be a box with sides above 0 within -1e9 to 1e9, not (-1, -1, -1) to (1, -1, 1)"
    );
    for (min, max) in [
        (-1.0, f64::INFINITY),
        (f64::NAN, 1.0),
        (-2e9, 1.0),
        (1.0, 1.0),
        (1.0, 1.0 + 1e-12),
    ] {
        assert!(matches!(
            refused([min; 3], [max; 3]),
            ProofError::Bounds { .. }
        ));
    }
}

#[test]
fn a_short_search_says_so() {
    let list = steps(|p| 1.0 / ((p.x() - p.y()) * (p.x() - p.y() * 1.01) + 1e-3));
    let budget = |operations: u64| Budget {
        operations,
        ..Budget::default()
    };
    let bounds = Aabb::centred([1.0; 3]);
    match Formula::prove(list, bounds, &budget(0)) {
        Err(ProofError::Unbounded(o)) => {
            assert!(
                !o.certain && o.to_string().contains("raise its budget"),
                "{o}"
            );
        }
        other => panic!("{other:?}"),
    }
}
