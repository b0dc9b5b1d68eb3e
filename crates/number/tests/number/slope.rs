//! Slopes bound every difference quotient in the box.

use crate::tree::{Place, Tree, place, tree};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use zeroset_number::{Dual, F64, Interval, Ops, Real, Slope, Vec3, v3};

/// Differences of values this large drown in rounding.
const LARGE: f64 = 1e6;

/// Two points between which the formula changes faster than `s` allows.
fn steeper(tree: &Tree, place: &Place, s: Slope) -> Option<String> {
    let values: Vec<_> = place
        .points()
        .filter_map(|p| tree.at(p).map(|(v, largest)| (p, v, largest)))
        .filter(|(_, _, largest)| *largest < LARGE)
        .collect();
    for (p, a, _) in &values {
        for (q, b, _) in &values {
            let change = (a - b).abs();
            let rounding = 1e-9 * (1.0 + a.abs() + b.abs());
            let way = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
            if way > 0.0 && change > s.l * way * (1.0 + 1e-12) + rounding {
                return Some(format!("{a} at {p:?} and {b} at {q:?} with {s:?}"));
            }
            // the sum of the ways along the axes, each with its own derivative
            let reach: f64 = (0..3)
                .filter(|k| p[*k] != q[*k])
                .map(|k| s.d[k].mag() * (p[k] - q[k]).abs())
                .sum();
            if way > 0.0 && change > reach * (1.0 + 1e-12) + rounding {
                return Some(format!("{a} at {p:?} and {b} at {q:?} with {s:?}"));
            }
        }
    }
    None
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn no_difference_quotient_is_steeper(tree in tree(), place in place()) {
        let s = tree.eval(Slope::point(place.intervals()), &mut |_| {});
        prop_assert!(s.l >= 0.0, "{s:?}");
        prop_assert_eq!(steeper(&tree, &place, s), None);
        for p in place.points() {
            if let Some((v, _)) = tree.at(p) {
                prop_assert!(s.v.contains(v), "{v:e} at {p:?} is not in {:?}", s.v);
            }
        }
    }

    #[test]
    fn gradients_lie_in_the_range_of_gradients(tree in tree(), place in place()) {
        let s = tree.eval(Slope::point(place.intervals()), &mut |_| {});
        for p in place.points() {
            let mut tame = true;
            let at = Dual::point(v3(F64(p[0]), F64(p[1]), F64(p[2])));
            let g = tree.eval(at, &mut |x: Dual<F64>| {
                let size = x.d.iter().fold(x.v.0.abs(), |m, d| m.max(d.0.abs()));
                tame &= size < LARGE && (x.v.0 == 0.0 || x.v.0.abs() > 1e-9);
            });
            for k in 0..3 {
                let hair = 1e-9 * (1.0 + g.d[k].0.abs());
                let d = s.d[k];
                let inside = d.lo - hair <= g.d[k].0 && g.d[k].0 <= d.hi + hair;
                prop_assert!(!tame || !s.l.is_finite() || inside, "{g:?} at {p:?} is not in {s:?}");
            }
        }
    }
}

#[test]
fn half_a_slope_is_noticed() {
    let mut runner = TestRunner::deterministic();
    let noticed = (0..400).filter(|_| {
        let tree = tree().new_tree(&mut runner).map(|t| t.current());
        let place = place().new_tree(&mut runner).map(|p| p.current());
        let (Ok(tree), Ok(place)) = (tree, place) else {
            return false;
        };
        let s = tree.eval(Slope::point(place.intervals()), &mut |_| {});
        s.l.is_finite() && steeper(&tree, &place, Slope { l: 0.5 * s.l, ..s }).is_some()
    });
    let noticed = noticed.count();
    assert!(noticed > 40, "{noticed} of 400 halved slopes were noticed");
}

fn cube(c: [f64; 3], half: f64) -> Vec3<Slope> {
    let side = |x: f64| Interval::new(x - half, x + half);
    Slope::point(v3(side(c[0]), side(c[1]), side(c[2])))
}

#[test]
fn lengths_keep_a_slope_of_one() {
    // over a box that holds the tip and all directions
    let p = cube([0.1, 0.0, -0.2], 2.0);
    let near_one = |s: Slope| (s.l - 1.0).abs() < 1e-12;
    assert!(near_one(p.length()), "{:?}", p.length());
    assert!(near_one(p.abs().length() - 1.0));
    assert!(near_one(p.xy().length().max(p.z.abs())));
    let torus = v3(p.xz().length() - 0.8, p.y, p.y.lit(0.0)).length();
    assert!(near_one(torus), "{torus:?}");
    let q = p.abs() - v3(0.5, 0.7, 0.4);
    let cuboid = q.max0().length() + q.max_component().min(0.0);
    assert!(cuboid.l < 2.0 + 1e-9, "{cuboid:?}");
}

#[test]
fn jumps_have_no_slope() {
    let p = cube([-1.0, 0.0, 0.5], 0.1);
    assert_eq!(p.y.atan2(p.x).l, f64::INFINITY);
    assert_eq!(p.y.sign().l, f64::INFINITY);
    assert_eq!(p.x.sign().l, 0.0);
    assert_eq!((p.x * 20.0).fract().l, f64::INFINITY);
    assert_eq!(Slope::choose(p.y.negative(), p.x, p.z).l, f64::INFINITY);
    let ends = Slope::repeat_while(Interval::point(5.0), p.y, |s| s.below(0.05), |s| s + 1.0);
    assert_eq!(ends.l, f64::INFINITY);
}

#[test]
fn what_is_proven_elsewhere_clips() {
    let p = cube([0.0; 3], 1.0);
    // a step made smooth: the floor alone has no slope
    let value = (p.x * 3.0).floor() * 0.1;
    assert_eq!(value.l, f64::INFINITY);
    let known = value.proven(-0.3, 0.2, p * 3.0, 0.5);
    assert!((known.l - 1.5).abs() < 1e-12, "{known:?}");
    assert!(known.d[0].mag() <= 1.5 + 1e-12 && known.d[1].mag() < 1.5 + 1e-12);
    assert_eq!(
        (known.v.lo, known.v.hi),
        (f64::from(-0.3_f32), f64::from(0.2_f32))
    );
}
