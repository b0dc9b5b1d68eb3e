//! What the proofs of the catalogue do not reach: extreme parameters, against plain searches.

use super::*;
use proptest::prelude::*;
use zeroset_number::{Data, F64, v3};

fn value<P: Primitive>(a: &[f64], x: f64, y: f64) -> (f64, f64) {
    let stored = Data::from(a.iter().map(|&x| x as f32).collect::<Vec<f32>>());
    let exact = P::distance(v3(F64(x), F64(y), F64(0.3)), Args::new(&stored)).0;
    let single = P::distance(v3(x as f32, y as f32, 0.3f32), Args::new(&stored));
    (exact, f64::from(single))
}

/// The smallest `f(t)` for t in 0..1: a walk, refined around the places nearer than their neighbours.
fn smallest(f: impl Fn(f64) -> f64) -> f64 {
    let n: usize = 2000;
    let walk: Vec<f64> = (0..=n).map(|i| f(i as f64 / n as f64)).collect();
    let mut best = f64::INFINITY;
    for i in 0..=n {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(n));
        if walk[i] <= walk[before] && walk[i] <= walk[after] {
            let (mut lo, mut hi) = (before as f64 / n as f64, after as f64 / n as f64);
            for _ in 0..80 {
                let third = (hi - lo) / 3.0;
                if f(lo + third) < f(hi - third) {
                    hi -= third
                } else {
                    lo += third
                }
            }
            best = best.min(f(lo));
        }
    }
    best
}

/// Coordinates that like axes, tiny values and each other.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -2.0..2.0f64,
        1 => Just(0.0),
        1 => (-9.0..0.0f64).prop_map(|e| 10f64.powf(e)),
        1 => (-4i32..4).prop_map(|k| f64::from(k) / 4.0),
    ]
}

fn quantized(x: f64) -> f64 {
    f64::from(x as f32)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn ellipses_of_any_ratio(width in -3.0..0.5f64, height in -3.0..0.5f64, x in coordinate(), y in coordinate()) {
        let a = [quantized(10f64.powf(width)), quantized(10f64.powf(height))];
        let (x, y) = (quantized(x), quantized(y));
        let (exact, single) = value::<Ellipse>(&a, x, y);
        let turn = std::f64::consts::FRAC_PI_2;
        // in two halves, so that the fine steps are at the sharp end
        let at = |t: f64| {
            let (s, c) = (t * t * t * turn).sin_cos();
            let flipped = (x.abs() - a[0] / 2.0 * s).hypot(y.abs() - a[1] / 2.0 * c);
            flipped.min((x.abs() - a[0] / 2.0 * c).hypot(y.abs() - a[1] / 2.0 * s))
        };
        let wanted = smallest(at) * if Ellipse::contains(&a, [x, y, 0.0]) { -1.0 } else { 1.0 };
        let size = a[0].max(a[1]) + x.hypot(y);
        prop_assert!((exact - wanted).abs() < 1e-9 * size, "{exact} is not {wanted}");
        prop_assert!((single - exact).abs() < 3e-6 * size, "{single} in f32, {exact}");
    }

    #[test]
    fn curves_of_any_shape(points in prop::array::uniform6(coordinate()), x in coordinate(), y in coordinate()) {
        let a: Vec<f64> = points.iter().map(|&x| quantized(x)).chain([0.125]).collect();
        let (x, y) = (quantized(x), quantized(y));
        let (exact, single) = value::<Bezier2d>(&a, x, y);
        let at = |t: f64| {
            let b = |k: usize| (1.0 - t) * (1.0 - t) * a[k] + 2.0 * t * (1.0 - t) * a[2 + k] + t * t * a[4 + k];
            (b(0) - x).hypot(b(1) - y)
        };
        let wanted = smallest(at) - 0.0625;
        prop_assert!((exact - wanted).abs() < 1e-7, "{exact} is not {wanted}");
        prop_assert!((single - exact).abs() < 3e-5, "{single} in f32, {exact}");
    }

    #[test]
    fn arches_of_any_ratio(width in -2.0..0.5f64, height in -2.0..0.5f64, x in coordinate(), y in coordinate()) {
        let a = [quantized(10f64.powf(width)), quantized(10f64.powf(height))];
        let (x, y) = (quantized(x), quantized(y));
        let (exact, single) = value::<Parabola>(&a, x, y);
        let arch = smallest(|t| {
            let s = 2.0 * t - 1.0;
            (x - a[0] / 2.0 * s).hypot(y - a[1] * (1.0 - s * s))
        });
        let base = (x.abs() - a[0] / 2.0).max(0.0).hypot(y);
        let wanted = arch.min(base) * if Parabola::contains(&a, [x, y, 0.0]) { -1.0 } else { 1.0 };
        let size = a[0].max(a[1]) + x.hypot(y);
        prop_assert!((exact - wanted).abs() < 1e-8 * size, "{exact} is not {wanted}");
        prop_assert!((single - exact).abs() < 3e-6 * size, "{single} in f32, {exact}");
    }

    #[test]
    fn polygons_of_any_points(points in prop::collection::vec((coordinate(), coordinate()), 3..20), x in coordinate(), y in coordinate()) {
        let points: Vec<[f64; 2]> = points.into_iter().map(|(x, y)| [quantized(x), quantized(y)]).collect();
        let mut a = vec![points.len() as f64];
        a.extend(points.iter().flatten());
        let (x, y) = (quantized(x), quantized(y));
        let (exact, single) = value::<Polygon>(&a, x, y);
        let mut nearest = f64::INFINITY;
        for (i, p) in points.iter().enumerate() {
            let q = points[(i + 1) % points.len()];
            let e = [q[0] - p[0], q[1] - p[1]];
            let t = ((x - p[0]) * e[0] + (y - p[1]) * e[1]) / (e[0] * e[0] + e[1] * e[1]).max(1e-300);
            let t = t.clamp(0.0, 1.0);
            nearest = nearest.min((p[0] + t * e[0] - x).hypot(p[1] + t * e[1] - y));
        }
        prop_assert!((exact.abs() - nearest).abs() < 1e-9, "{exact} is not {nearest}");
        prop_assert!((single - exact).abs() < 1e-5, "{single} in f32, {exact}");
        if nearest > 1e-6 {
            prop_assert_eq!(exact < 0.0, odd(&points, [x, y]));
        }
    }
}

#[test]
fn relations_between_parameters_are_checked() {
    let refused = |r: Result<(), String>, part: &str| {
        let why = r.expect_err(part);
        assert!(why.contains(part), "{why}");
    };
    refused(Ring::check(&[0.5, 1.5]), "thickness must be below 1");
    refused(Ngon::check(&[5.5, 1.0]), "whole number");
    refused(Moon::check(&[1.0, 0.2, 0.1]), "offset must be between");
    refused(Vesica::check(&[2.0, 1.0]), "at most 1");
    refused(Horseshoe::check(&[4.2, 0.8, 2.0, 0.3]), "legs would meet");
    refused(
        RoundedRectangle::check(&[1.0, 1.0, 0.1, 0.7, -1.0, -1.0, -1.0]),
        "half the shorter side",
    );
    refused(Triangle2d::check(&[0.0, 0.0, 1.0, 1.0, 2.0, 2.0]), "line");
    refused(Polygon::check(&[2.0, 0.0, 0.0, 1.0, 1.0]), "at least 3");
    refused(Outline::check(&[0.0]), "at least one");
    refused(
        Outline::check(&[2.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        "contours must be closed",
    );
    assert!(Outline::check(&[2.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, -0.0]).is_ok());
}
