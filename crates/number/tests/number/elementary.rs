//! The elementary functions of SIMD lanes against `f64`, over the whole range of `f32`, at every SIMD level.

use crate::formulas;
use crate::support::{Formula, every_exponent, lanes, levels, reference, ulp};
use zeroset_number::Real;

formulas! {
    Sin |p, a| p.x.sin();
    Cos |p, a| p.x.cos();
    Tan |p, a| p.x.tan();
    Exp |p, a| p.x.exp();
    Exp2 |p, a| p.x.exp2();
    Ln |p, a| p.x.ln();
    Log2 |p, a| p.x.log2();
    Tanh |p, a| p.x.tanh();
    Asin |p, a| p.x.asin();
    Acos |p, a| p.x.acos();
    Atan |p, a| p.x.atan();
    Atan2 |p, a| p.y.atan2(p.x);
    Pow |p, a| p.x.powf(a.get(0));
}

/// Results that are smaller than this may come out as zero.
const UNDERFLOW: f64 = 1.7e-38;

/// Holds a function against f64: `error(got, expected)` must not be above 1.
fn hold<F: Formula>(
    name: &str,
    params: &[f32],
    points: &[[f32; 3]],
    error: impl Fn(f64, f64) -> f64,
) {
    for (level, simd) in levels() {
        for (p, got) in points.iter().zip(lanes::<F>(simd, params, points)) {
            let expected = reference::<F>(params, p.map(f64::from));
            let fine = if expected.is_nan() || got.is_nan() {
                expected.is_nan() && got.is_nan()
            } else if (expected as f32).is_infinite() || got.is_infinite() {
                expected as f32 == got
            } else {
                error(got.into(), expected) <= 1.0
            };
            assert!(
                fine,
                "{name} at {p:?} ({level}): {got:e}, should be {expected:e}"
            );
        }
    }
}

fn along_x(xs: Vec<f32>) -> Vec<[f32; 3]> {
    xs.into_iter().map(|x| [x, 0.0, 0.0]).collect()
}

/// Every exponent, and densely where people work.
fn arguments() -> Vec<[f32; 3]> {
    let mut xs = every_exponent(24);
    xs.extend((-4000..4000).map(|i| i as f32 * 0.0051));
    // around multiples of pi / 2, near and far, and around the limits of exp
    for n in (-40..40).chain([1000, 5000, 5215, 5216, 100_000, 4_000_000]) {
        let x = (f64::from(n) * std::f64::consts::FRAC_PI_2) as f32;
        xs.extend([x.next_down(), x, x.next_up()]);
    }
    for x in [
        8192.0_f32, 88.376, 88.722_83, -87.336_54, -103.97, -126.0, 128.0, 127.5,
    ] {
        xs.extend([x.next_down(), x, x.next_up()]);
    }
    along_x(xs)
}

fn absolute(bound: f64) -> impl Fn(f64, f64) -> f64 {
    move |got, expected| (got - expected).abs() / bound
}

fn in_ulp(bound: f64) -> impl Fn(f64, f64) -> f64 {
    move |got, expected| {
        let error = (got - expected).abs();
        if error <= UNDERFLOW && expected.abs() <= UNDERFLOW {
            0.0
        } else {
            error / (bound * ulp(expected))
        }
    }
}

#[test]
fn sin_and_cos() {
    hold::<Sin>("sin", &[], &arguments(), absolute(1e-7));
    hold::<Cos>("cos", &[], &arguments(), absolute(1e-7));
}

#[test]
fn exponentials() {
    hold::<Exp>("exp", &[], &arguments(), in_ulp(1.1));
    hold::<Exp2>("exp2", &[], &arguments(), in_ulp(1.4));
}

#[test]
fn logarithms() {
    hold::<Ln>("ln", &[], &arguments(), in_ulp(0.9));
    // ln times a constant: near 1 the error of ln counts in full
    hold::<Log2>("log2", &[], &arguments(), in_ulp(2.5));
}

#[test]
fn atan2_everywhere() {
    let mut points = Vec::new();
    let xs = every_exponent(1);
    for (i, &y) in xs.iter().enumerate() {
        for &x in xs.iter().skip(i % 7).step_by(7) {
            points.push([x, y, 0.0]);
        }
        // equal, nearly equal, axes and signed zeros
        let near = [y, -y, y.next_up(), -y.next_down(), 0.0, -0.0];
        points.extend(near.map(|x| [x, y, 0.0]));
        points.extend([[y, 0.0, 0.0], [y, -0.0, 0.0]]);
    }
    points.retain(|[x, y, _]| !(x.is_infinite() && y.is_infinite()));
    hold::<Atan2>("atan2", &[], &points, in_ulp(2.5));
    for (_, level) in levels() {
        for (x, y) in [
            (0.0, 0.0),
            (0.0, -0.0),
            (-0.0, 0.0),
            (-0.0, -0.0),
            (1.0, -0.0),
        ] {
            let got = lanes::<Atan2>(level, &[], &[[x, y, 0.0]])[0];
            let expected = y.atan2(x);
            assert_eq!(
                (got, got.is_sign_negative()),
                (expected, expected.is_sign_negative())
            );
        }
    }
}

#[test]
fn powers() {
    let ks = [
        0.0,
        1.0,
        -1.0,
        0.5,
        -0.5,
        2.0,
        2.4,
        3.0,
        7.0,
        8.0,
        -8.0,
        1.0 / 3.0,
        40.0,
        100.3,
        -300.0,
        1e-3,
        1e-20,
        1e5,
        -1e5,
        1e30,
    ];
    for k in ks {
        let mut xs: Vec<f32> = every_exponent(6);
        // where the result is in range
        xs.extend((-600..600).map(|i| (f64::from(i) * 0.2 / f64::from(k)).exp2() as f32));
        xs.extend((0..200).map(|i| 0.5 + i as f32 * 0.0075));
        let relative = 1.5e-7 + 6e-8 * f64::from(k.abs());
        hold::<Pow>("pow", &[k], &along_x(xs), |got, expected| {
            if got.abs().max(expected.abs()) <= UNDERFLOW {
                0.0
            } else {
                (got / expected - 1.0).abs() / relative.min(7e-6)
            }
        });
    }
}

#[test]
fn derived_functions() {
    let all = arguments();
    hold::<Tanh>("tanh", &[], &all, absolute(2e-7));
    hold::<Atan>("atan", &[], &all, in_ulp(2.5));
    hold::<Asin>("asin", &[], &all, absolute(4e-7));
    hold::<Acos>("acos", &[], &all, absolute(6e-7));
    // away from the poles, where an absolute error of sine and cosine is a relative one
    let tame: Vec<_> = all
        .into_iter()
        .filter(|p| p[0].abs() < 1e6 && f64::from(p[0]).cos().abs() > 0.1)
        .collect();
    hold::<Tan>("tan", &[], &tame, |got, expected| {
        (got - expected).abs() / (1e-7 * 12.0 * (1.0 + expected.abs()))
    });
}
