//! Writing formulas down.

use super::steps;
use zeroset_field::formula::{
    Binary, BuildError, Builder, Expression, FormulaStep, MAX_STEPS, Steps, StepsError, Unary,
    functions,
};
use zeroset_number::{F64, v3};

const P: [f64; 3] = [0.3, -0.7, 1.1];

fn value(f: impl Fn(&Expression) -> Expression) -> f64 {
    steps(f).eval(v3(F64(P[0]), F64(P[1]), F64(P[2]))).0
}

fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} {b}");
}

#[test]
fn expressions_mean_what_they_say() {
    let [x, y, z] = P;
    let length = (x * x + y * y + z * z).sqrt();
    close(value(|p| p.length()), length);
    close(value(|p| (p - 1.0).dot(p)), length * length - (x + y + z));
    close(value(|p| p.cross(p * 2.0 + 1.0).x()), y - z);
    close(value(|p| p.normalize().y()), y / length);
    close(value(|p| p.distance(p + 1.0)), 3_f64.sqrt());
    close(value(|p| p.x().mix(p.y(), 0.25)), 0.75 * x + 0.25 * y);
    close(value(|p| p.clamp(-0.5, 0.5).y()), -0.5);
    close(
        value(|p| p.x().smoothstep(0.0, 1.0)),
        x * x * (3.0 - 2.0 * x),
    );
    close(value(|p| p.x().step(0.2) + p.x().step(0.4) * 10.0), 1.0);
    close(value(|p| p.y().sign() * 2.0 + p.x().sign()), -1.0);
    close(
        value(|p| p.z().fract() + p.y().ceil() + p.y().round()),
        0.1 - 1.0,
    );
    close(value(|p| p.y().modulo(0.5)), 0.3);
    close(value(|p| p.x().pow(2.5)), x.powf(2.5));
    close(value(|p| p.y().powi(3)), y.powi(3));
    close(value(|p| p.y().powi(0)), 1.0);
    close(value(|p| p.z().atan2(p.y())), z.atan2(y));
    close(value(|p| p.least() + p.greatest()), y + z);
    close(value(|p| 1.0 / p.x() - (2.0 - p.y())), 1.0 / x - 2.0 + y);
    close(value(|p| p.swizzle("zx").unwrap().length()), x.hypot(z));
    close(value(|p| p.x().exp().ln() + p.x().tanh()), x + x.tanh());
    close(
        value(|p| p.x().asin() + p.x().acos() + p.x().atan()),
        x.asin() + x.acos() + x.atan(),
    );
    close(value(|p| p.x().tan() * p.x().cos() - p.x().sin()), 0.0);
    close(value(|p| (-p).abs().max(0.5).min(1.0).y()), 0.7);
}

#[test]
fn equal_steps_are_written_once_and_needless_ones_not_at_all() {
    let list = steps(|p| {
        let _unused = p.x().exp();
        (p.x() * p.y()).sin() + (p.y() * p.x()).sin()
    });
    // x, y, their product, its sine, and twice that
    assert_eq!(list.list().len(), 5);
    assert_eq!(steps(|p| p.y()).list(), [FormulaStep::Coordinate(1)]);
}

#[test]
fn the_root_of_a_sum_of_squares_is_a_length() {
    let plain = steps(|p| (p.x() * p.x() + p.y() * p.y() + p.z() * p.z()).sqrt());
    assert_eq!(plain, steps(|p| p.length()));
    assert_eq!(steps(|p| p.x().square().sqrt()), steps(|p| p.x().abs()));
}

#[test]
fn constants_are_parameters_and_do_not_change_the_structure() {
    let shape = |list: &Steps| -> Vec<FormulaStep> {
        let unnamed = |step: &FormulaStep| match step {
            FormulaStep::Constant(_) => FormulaStep::Constant(0.0),
            other => *other,
        };
        list.list().iter().map(unnamed).collect()
    };
    let make = |a: f64, b: f64, c: f64| {
        steps(move |p| (p.x() * a + p.y() * b).max(c) - a * 2.0 + p.x() * 0.0)
    };
    let all = [
        (1.0, 2.0, 3.0),
        (1.0, 1.0, 1.0),
        (0.0, 0.0, 0.0),
        (-1.0, 0.5, 1e9),
    ];
    let [first, rest @ ..] = all.map(|(a, b, c)| make(a, b, c));
    for other in &rest {
        assert_eq!(shape(&first), shape(other));
    }
}

#[test]
fn functions_of_constants_are_constants() {
    let list = steps(|p| {
        let two = p.builder().constant(4.0).sqrt();
        p.x() * (two.clone() + two.sin())
    });
    assert_eq!(
        list.list(),
        [
            FormulaStep::Coordinate(0),
            FormulaStep::Constant(2.0 + 2_f64.sin()),
            FormulaStep::Binary(Binary::Mul, 0, 1)
        ]
    );
}

#[test]
fn vectors_meet_numbers_and_not_other_lengths() {
    let builder = Builder::new();
    let p = builder.point();
    let flat = p.swizzle("xz").unwrap();
    assert_eq!((flat.parts(), (flat.clone() * p.y()).parts()), (2, 2));
    assert!(p.swizzle("xw").is_none() && p.swizzle("").is_none() && p.x().swizzle("x").is_none());
    assert_eq!(builder.check(), Ok(()));
    let _ = flat + &p;
    let error = builder.check().unwrap_err();
    assert_eq!(
        error.to_string(),
        "+ needs numbers or vectors of the same length, not a vector of 2 and a vector of 3"
    );
    assert_eq!(builder.finish(&p.x()), Err(error));
}

#[test]
fn mistakes_are_told() {
    let fails = |f: fn(&Expression) -> Expression| {
        let builder = Builder::new();
        let value = f(&builder.point());
        builder.finish(&value).unwrap_err().to_string()
    };
    assert_eq!(
        fails(|p| p.clone()),
        "the value of a formula is one number, this is a vector of 3; length(...) makes a number of it"
    );
    assert_eq!(
        fails(|p| p.x().z()),
        "z needs a longer vector, not a number"
    );
    assert_eq!(
        fails(|p| p.cross(p.x())),
        "cross needs two vectors of 3, not a vector of 3 and a number"
    );
    assert_eq!(
        fails(|p| p.x() + f64::NAN),
        "a constant is NaN, and numbers of a formula must lie within -1e18 to 1e18"
    );
    let one = |p: &Expression| p.builder().constant(1.0);
    assert_eq!(value(|p| one(p) / 4.0), 0.25);
    assert_eq!(
        fails(|p| p.x() + p.builder().constant(1.0) / 0.0),
        "1 / 0 is inf, and numbers of a formula must lie within -1e18 to 1e18"
    );
    assert_eq!(
        fails(|p| p.builder().vector(&[p.clone(), p.clone()]).x()),
        "a vector needs 2 to 4 numbers, not 6"
    );
    assert_eq!(
        fails(|p| p.x() + Builder::new().point().x()),
        "a value of one formula is used in another: a formula can only use its own point"
    );
}

#[test]
fn steps_are_limited() {
    let builder = Builder::with_limit(10);
    let p = builder.point();
    let value = (0..20).fold(p.x(), |v, i| v * p.y() + f64::from(i));
    assert_eq!(builder.finish(&value), Err(BuildError::Steps { limit: 10 }));
    let builder = Builder::with_limit(usize::MAX);
    let p = builder.point();
    let value = (0..600_000).fold(p.x(), |v, i| v * p.y() + f64::from(i));
    assert_eq!(
        builder.finish(&value),
        Err(BuildError::Steps { limit: MAX_STEPS })
    );
}

#[test]
fn lists_of_steps_are_checked() {
    let fails = |list: &[FormulaStep]| Steps::new(list.to_vec()).unwrap_err();
    assert_eq!(fails(&[]), StepsError::Empty);
    assert_eq!(
        fails(&[
            FormulaStep::Coordinate(0),
            FormulaStep::Unary(Unary::Sin, 1)
        ]),
        StepsError::Operand {
            step: 1,
            operand: 1
        }
    );
    assert_eq!(
        fails(&[FormulaStep::Coordinate(3)]),
        StepsError::Coordinate { step: 0, axis: 3 }
    );
    assert!(matches!(
        fails(&[FormulaStep::Constant(f64::INFINITY)]),
        StepsError::Constant { .. }
    ));
    let long = vec![FormulaStep::Coordinate(0); MAX_STEPS + 1];
    assert!(matches!(fails(&long), StepsError::TooMany { .. }));
}

#[test]
fn every_function_can_be_called_by_its_name() {
    let mut names: Vec<&str> = functions().iter().map(|f| f.name).collect();
    for function in functions() {
        let builder = Builder::new();
        let p = builder.point();
        let arguments: Vec<Expression> = (function.params.iter())
            .map(|param| match *param {
                "v" | "a" | "b" => p.clone() + 2.0,
                "p" => p.clone(),
                "n" => builder.constant(3.0),
                _ => p.x(),
            })
            .collect();
        let arguments = match function.name {
            // one number is no vector
            "vector" => vec![p.x(), p.y()],
            _ => arguments,
        };
        let value = function.call(&arguments).unwrap();
        assert!((1..=4).contains(&value.parts()), "{}", function.name);
        assert!(
            function.doc.ends_with('.') && !function.doc.contains("  "),
            "{}",
            function.name
        );
        let few = function
            .call(&arguments[..function.params.len() - 1])
            .unwrap_err();
        assert!(matches!(few, BuildError::Arguments { .. }), "{few}");
        // those of a certain length take no more
        if !function.optional.is_empty() || function.name.starts_with("vec") {
            continue;
        }
        let many = [&arguments[..], &arguments[..1]].concat();
        assert_eq!(
            function.call(&many).is_ok(),
            function.more,
            "{}",
            function.name
        );
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), functions().len());
}

#[test]
fn whole_powers_are_told_from_others() {
    let powi = functions().iter().find(|f| f.name == "powi").unwrap();
    let builder = Builder::new();
    let p = builder.point();
    let error = powi.call(&[p.x(), builder.constant(2.5)]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "powi needs a whole number of -64 to 64 as its power, not 2.5"
    );
    let few = powi.call(&[p.x()]).unwrap_err();
    assert_eq!(few.to_string(), "powi takes 2 arguments (x, n), 1 given");
}
