//! Known slopes.

use super::{proven, steps};
use std::f64::consts::SQRT_2;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::formula::{Budget, Expression, Formula};

/// The proven slope is no less than the true one, and no more than so many times it.
fn is(formula: &Formula, truth: f64, times: f64) {
    let slope = formula.slope();
    assert!(formula.is_proven());
    assert!(
        slope >= truth * (1.0 - 1e-9),
        "{slope} is less than {truth}"
    );
    assert!(
        slope <= truth * times,
        "{slope} is more than {times} times {truth}"
    );
    assert!(
        formula.steepest() <= slope,
        "{} is more than {slope}",
        formula.steepest()
    );
}

fn gyroid(p: &Expression, scale: f64) -> Expression {
    let q = p * scale;
    q.sin().dot(q.cos().swizzle("yzx").unwrap())
}

#[test]
fn distances_have_slope_one() {
    is(&proven(2.0, |p| p.length() - 1.0).unwrap(), 1.0, 1.0 + 1e-9);
    let naive = |p: &Expression| (p.x() * p.x() + p.y() * p.y() + p.z() * p.z()).sqrt() - 1.0;
    is(&proven(2.0, naive).unwrap(), 1.0, 1.0 + 1e-9);
    let torus = |p: &Expression| (p.x().hypot(p.z()) - 0.7).hypot(p.y()) - 0.2;
    is(&proven(2.0, torus).unwrap(), 1.0, 1.0 + 1e-9);
}

#[test]
fn the_distance_to_a_box_from_its_faces_has_slope_one() {
    let cube = |p: &Expression| {
        let q = p.abs() - 0.5;
        q.max(0.0).length() + q.greatest().min(0.0)
    };
    is(&proven(2.0, cube).unwrap(), 1.0, 1.0 + 1e-9);
    // with faces that are not all of the box's, the two terms meet, and each has slope 1
    let sloppy = |p: &Expression| {
        let q = p.abs() - 0.5;
        q.max(0.0).length() + q.x().min(0.0)
    };
    is(&proven(2.0, sloppy).unwrap(), SQRT_2, SQRT_2 + 1e-9);
}

#[test]
fn a_wave_on_a_sphere() {
    is(
        &proven(2.0, |p| p.length() - 1.0 + (p.x() * 10.0).sin() * 0.1).unwrap(),
        2.0,
        1.01,
    );
    // on a plane the wave's slope is across
    is(
        &proven(2.0, |p| p.y() + (p.x() * 10.0).sin() * 0.1).unwrap(),
        SQRT_2,
        1.05,
    );
}

#[test]
fn polynomials() {
    // Munini 2021, after theorem 2.1: x^2 + y^2 - 1 is no distance; its gradient is longest in the corner of the box
    let disc = |p: &Expression| p.x().square() + p.y().square() - 1.0;
    is(&proven(2.0, disc).unwrap(), 4.0 * SQRT_2, 1.05);
    // Goursat's quartic: |4 x^3 - 10 x| in every coordinate, in the corner
    let tangle = |p: &Expression| {
        let q = p.square();
        q.dot(&q) - (q.x() + q.y() + q.z()) * 5.0 + 11.8
    };
    is(
        &proven(3.0, tangle).unwrap(),
        (4.0 * 27.0 - 30.0) * 3_f64.sqrt(),
        1.05,
    );
    // z x^2 along its axis, by powers
    let powers = |p: &Expression| p.x().powi(5) + p.y().abs().pow(1.5) * 0.0;
    is(&proven(1.0, powers).unwrap(), 5.0, 1.05);
    is(&proven(1.0, |p| p.y().abs().pow(1.5)).unwrap(), 1.5, 1.05);
    is(
        &proven(1.0, |p| p.y().abs().pow(1.0) + p.y().abs().pow(0.0)).unwrap(),
        1.0,
        1.05,
    );
}

#[test]
fn the_gyroid() {
    // its gradient is (1, 1, 1) where it is longest
    is(
        &proven(1.0, |p| gyroid(p, 3.0)).unwrap(),
        3.0 * 3_f64.sqrt(),
        1.1,
    );
    is(
        &proven(2.0, |p| gyroid(p, 3.0)).unwrap(),
        3.0 * 3_f64.sqrt(),
        1.25,
    );
}

#[test]
fn a_twisted_bar() {
    let twisted = |p: &Expression| {
        let (s, c) = ((p.y() * 2.0).sin(), (p.y() * 2.0).cos());
        let x = p.x() * &c - p.z() * &s;
        let z = p.x() * &s + p.z() * &c;
        x.abs().max(z.abs()) - 0.4
    };
    // sqrt(1 + (rate z)^2) where |z| is largest along the bar's other faces: 1 in the box's corners
    is(&proven(1.0, twisted).unwrap(), 5_f64.sqrt(), 1.4);
}

#[test]
fn smooth_unions_by_exponentials_keep_the_slope_of_their_shapes() {
    let blend = |p: &Expression| {
        let sum = (-(p.length() * 8.0)).exp() + (-((p + 0.3).length() * 8.0)).exp();
        -sum.ln() / 8.0 - 0.5
    };
    is(&proven(2.0, blend).unwrap(), 1.0, 1.02);
    let ratio = |p: &Expression| ((p.x() * 3.0).exp() / (p.y() * 4.0).exp() * 2.0).ln() / 5.0;
    // of a quotient, the sum of both
    is(&proven(2.0, ratio).unwrap(), 1.0, 1.4 + 1e-6);
}

#[test]
fn angles_may_go_round_where_nothing_jumps() {
    let ring = |p: &Expression| (p.x().hypot(p.z()) - 1.0).hypot(p.y()) - 0.3;
    // not on the axis, where the angle turns infinitely fast
    let aside = |turns: f64| {
        let angle = steps(move |p| ring(p) + (p.z().atan2(p.x()) * turns).cos() * 0.05);
        Formula::prove(
            angle,
            Aabb::new([-2.0, -1.0, -1.0], [-0.5, 1.0, 1.0]),
            &Budget::default(),
        )
    };
    is(&aside(3.0).unwrap(), 1.0, 1.5);
    is(&aside(-4.0).unwrap(), 1.0, 1.5);
    assert!(aside(2.5).is_err());
}

#[test]
fn inverse_functions_inside_their_domains() {
    is(&proven(0.6, |p| p.x().asin()).unwrap(), 1.25, 1.05);
    is(
        &proven(0.6, |p| p.x().acos() + p.y()).unwrap(),
        (1.0 + 1.25_f64.powi(2)).sqrt(),
        1.05,
    );
    is(
        &proven(3.0, |p| p.x().atan() + p.y().tanh()).unwrap(),
        SQRT_2,
        1.05,
    );
    is(&proven(1.0, |p| (p.x() + 1.5).ln()).unwrap(), 2.0, 1.05);
    is(
        &proven(1.0, |p| (p.x() + 1.25).sqrt() * 2.0).unwrap(),
        2.0,
        1.05,
    );
    is(&proven(1.0, |p| 1.0 / (p.x() + 2.0)).unwrap(), 1.0, 1.05);
    is(
        &proven(1.0, |p| p.x().tan()).unwrap(),
        1.0 / 1_f64.cos().powi(2),
        1.05,
    );
    // constant where it is limited
    is(
        &proven(1.0, |p| (p.x() + 3.0).asin() + p.y()).unwrap(),
        1.0,
        1.0 + 1e-6,
    );
    is(
        &proven(1.0, |p| (p.x() - 3.0).sqrt() + p.y()).unwrap(),
        1.0,
        1.0 + 1e-6,
    );
    is(
        &proven(0.4, |p| (p.x() + 0.5).floor() + p.y()).unwrap(),
        1.0,
        1.0 + 1e-6,
    );
}

#[test]
fn flat_formulas_count_as_no_flatter_than_one() {
    for c in [-1.0, 1.0] {
        let formula = proven(1.0, |p| p.builder().constant(c)).unwrap();
        assert_eq!((formula.slope(), formula.steepest()), (1.0, 0.0));
        assert_eq!(formula.is_cut(), c < 0.0);
    }
    assert_eq!(proven(1.0, |p| p.x() * 0.1).unwrap().slope(), 1.0);
}

#[test]
fn a_larger_budget_is_never_looser() {
    let list = steps(|p| gyroid(p, 4.0) + p.length());
    let bounds = Aabb::centred([1.5; 3]);
    let mut before = f64::INFINITY;
    for operations in [0, 1000, 10_000, 100_000] {
        let budget = Budget {
            operations,
            ..Budget::default()
        };
        let formula = Formula::prove(list.clone(), bounds, &budget).unwrap();
        assert!(formula.slope() <= before && formula.slope() >= 4.0 * 3_f64.sqrt());
        // and the same again
        assert_eq!(
            formula,
            Formula::prove(list.clone(), bounds, &budget).unwrap()
        );
        before = formula.slope();
    }
}

#[test]
fn cuts_are_found() {
    // touching is no cut, neither is what lies beyond the box
    assert!(!proven(1.0, |p| p.length() - 1.0).unwrap().is_cut());
    assert!(!proven(1.1, |p| p.length() - 1.0).unwrap().is_cut());
    assert!(!proven(1.0, |p| p.length() + 1.0).unwrap().is_cut());
    let cut = proven(0.99, |p| p.length() - 1.0).unwrap();
    let at = cut.cut_at().unwrap();
    assert!(cut.is_cut() && at.iter().map(|x| x * x).sum::<f64>() < 1.0);
    assert!(
        at.iter().any(|x| (x.abs() - 0.99).abs() < 1e-6),
        "{at:?} lies on a side"
    );
    // a small piece in a corner of a side
    let corner = |p: &Expression| (p - 0.97).length() - 0.05;
    assert!(proven(1.0, corner).unwrap().is_cut());
}

#[test]
fn the_box_is_that_of_single_precision() {
    let formula = proven(1.1, |p| p.length() - 1.0).unwrap();
    assert_eq!(formula.bounds(), Aabb::centred([f64::from(1.1_f32); 3]));
}

#[test]
fn stated_slopes_are_looked_at() {
    let list = steps(|p| p.x().floor() + p.y() * 3.0);
    let stated = |slope: f64| Formula::stated(list.clone(), Aabb::centred([1.0; 3]), slope);
    let formula = stated(2.0).unwrap();
    assert!(!formula.is_proven());
    assert_eq!((formula.slope(), formula.steepest()), (2.0, 3.0));
    assert!(formula.bounds().contains(formula.steepest_at()));
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, 2e6] {
        let error = stated(wrong).unwrap_err().to_string();
        assert_eq!(
            error,
            format!("a stated slope must be above 0 and at most 1e6, not {wrong}")
        );
    }
}
