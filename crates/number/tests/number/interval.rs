//! Intervals enclose what `f64` gives at every point of the box.

use crate::support::levels;
use crate::tree::{Binary, Place, Tree, number, place, tree};
use fearless_simd::{Level, Simd, dispatch, prelude::*};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use zeroset_number::{Args, Data, Ends, F64, Interval, Lanes, Ops, Real, SingleInterval, Vec3, v3};

/// A point whose value is not in `range`.
fn miss(tree: &Tree, place: &Place, range: Interval) -> Option<String> {
    place.points().find_map(|p| {
        let (v, _) = tree.at(p)?;
        (!range.contains(v)).then(|| format!("{v:e} at {p:?} is not in {range:?}"))
    })
}

/// The formula at a point in single precision, unless something on the way is no finite number.
fn in_lanes(tree: &Tree, level: Level, p: [f32; 3]) -> Option<f32> {
    fn run<S: Simd>(s: S, tree: &Tree, p: [f32; 3]) -> Option<f32> {
        let [x, y, z] = p.map(|x| Lanes(S::f32s::splat(s, x)));
        let mut finite = true;
        let value = tree.eval(v3(x, y, z), &mut |x: Lanes<S>| {
            finite &= x.0.as_slice()[0].is_finite();
        });
        finite.then_some(value.0.as_slice()[0])
    }
    dispatch!(level, s => run(s, tree, p))
}

/// A value of single precision that is not in its range over the box around the points.
fn single_miss(tree: &Tree, place: &Place, share: f64) -> Option<String> {
    let points: Vec<[f32; 3]> = place.points().map(|p| p.map(|x| x as f32)).collect();
    let side = |k: usize| {
        let ends = points.iter().map(|p| f64::from(p[k]));
        let lo = ends.clone().fold(f64::INFINITY, f64::min);
        SingleInterval::new(lo, ends.fold(f64::NEG_INFINITY, f64::max))
    };
    let mut range = tree.eval(v3(side(0), side(1), side(2)), &mut |_| {});
    // (a share of nothing of what is endless is nothing)
    if share > 0.0 {
        range.lo += share * (range.hi - range.lo);
    }
    for (name, level) in levels() {
        for p in &points {
            if let Some(value) = in_lanes(tree, level, *p)
                && !range.contains(value.into())
            {
                return Some(format!("{name}: {value:e} at {p:?} is not in {range:?}"));
            }
        }
    }
    None
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn single_precision_stays_in_its_range(tree in tree(), place in place()) {
        prop_assert_eq!(single_miss(&tree, &place, 0.0), None);
    }

    #[test]
    fn formulas_stay_in_their_range(tree in tree(), place in place()) {
        let range = tree.eval(place.intervals(), &mut |_| {});
        prop_assert!(range.lo <= range.hi, "{range:?}");
        prop_assert_eq!(miss(&tree, &place, range), None);
    }

    #[test]
    fn bounds_by_slope_enclose(place in place(), c in number()) {
        let sphere = |p: Vec3<Interval>| p.length() - c;
        let range = Interval::bounded_slope(place.intervals(), 1.0, sphere);
        for p in place.points() {
            let v = v3(F64(p[0]), F64(p[1]), F64(p[2])).length() - c;
            prop_assert!(range.contains(v.0), "{v:?} at {p:?} is not in {range:?}");
        }
    }
}

#[test]
fn a_range_without_its_ends_is_noticed() {
    let mut runner = TestRunner::deterministic();
    let noticed = (0..400).filter(|_| {
        let tree = tree().new_tree(&mut runner).map(|t| t.current());
        let place = place().new_tree(&mut runner).map(|p| p.current());
        let (Ok(tree), Ok(place)) = (tree, place) else {
            return false;
        };
        let r = tree.eval(place.intervals(), &mut |_| {});
        let tenth = 0.1 * (r.hi - r.lo);
        miss(
            &tree,
            &place,
            Interval {
                lo: r.lo + tenth,
                hi: r.hi,
            },
        )
        .is_some()
    });
    let noticed = noticed.count();
    assert!(
        noticed > 100,
        "{noticed} of 400 ranges that are a tenth short were noticed"
    );
}

#[test]
fn a_range_of_single_precision_without_its_ends_is_noticed() {
    let mut runner = TestRunner::deterministic();
    let noticed = (0..400).filter(|_| {
        let tree = tree().new_tree(&mut runner).map(|t| t.current());
        let place = place().new_tree(&mut runner).map(|p| p.current());
        matches!((tree, place), (Ok(tree), Ok(place)) if single_miss(&tree, &place, 0.1).is_some())
    });
    let noticed = noticed.count();
    assert!(noticed > 100, "{noticed} of 400");
}

fn at(tree: Tree, x: (f64, f64), y: (f64, f64)) -> Interval {
    let p = v3(
        Interval::new(x.0, x.1),
        Interval::new(y.0, y.1),
        Interval::point(0.0),
    );
    tree.eval(p, &mut |_| {})
}

fn atan2() -> Tree {
    Tree::Binary(Binary::Atan2, Box::new(Tree::Y), Box::new(Tree::X))
}

#[test]
fn the_cut_of_atan2_is_the_whole_circle() {
    for y in [
        (-0.1, 0.1),
        (0.0, 0.1),
        (-0.1, 0.0),
        (0.0, 0.0),
        (-0.0, -0.0),
    ] {
        let a = at(atan2(), (-2.0, -1.0), y);
        assert!(
            a.contains(std::f64::consts::PI) && a.contains(-std::f64::consts::PI),
            "{a:?}"
        );
    }
    let a = at(atan2(), (-2.0, -1.0), (0.1, 0.2));
    assert!(a.lo > 2.9 && a.hi < 3.1, "{a:?}");
    let a = at(atan2(), (1.0, f64::INFINITY), (1.0, f64::INFINITY));
    assert!(a.lo > -1e-9 && a.contains(1.57), "{a:?}");
}

#[test]
fn ranges_are_tight() {
    let width = |r: Interval| r.hi - r.lo;
    let x = Interval::new(0.3, 0.4);
    assert!(width(x + 1.0) < 0.1 + 1e-12);
    assert!(width(Interval::new(-2.0, 1.0).sq()) < 4.0 + 1e-12);
    assert!(width(x.sin()) < 0.1 && width(x.exp()) < 0.16 && width(x.acos()) < 0.11);
    assert!(width(Interval::new(1.2, 1.9).fract()) < 0.7 + 1e-12);
    assert_eq!(Interval::new(0.9, 1.1).fract(), Interval::new(0.0, 1.0));
    let around = Interval::bounded_slope(Vec3::splat(Interval::new(-0.1, 0.1)), 1.0, |_| {
        Interval::WHOLE
    });
    assert_eq!(around, Interval::WHOLE);
}

#[test]
fn no_range_is_made_of_nan() {
    let ends = [
        f64::NEG_INFINITY,
        -1.0,
        -0.0,
        0.0,
        1.0,
        f64::MAX,
        f64::INFINITY,
    ];
    for a in ends {
        for b in ends {
            let (x, y) = (Interval::point(a), Interval::new(a, b));
            for r in [
                x + y,
                x - y,
                x * y,
                x / y,
                x.min(y),
                y.sqrt(),
                y.ln(),
                y.exp(),
                y.sin(),
                x.atan2(y),
                y.powf(x),
                y.fract(),
                x.modulo(y),
                y.recip(),
            ] {
                assert!(r.lo <= r.hi, "{a} {b} {r:?}");
            }
        }
    }
    assert_eq!(Interval::point(f64::NAN), Interval::WHOLE);
    assert_eq!(Interval::new(2.0, 1.0), Interval::new(1.0, 2.0));
}

#[test]
fn lists_that_lie_about_their_length_are_cut_short() {
    // three items are claimed (or any other number), two are there
    let sum = |store: &[f32], ends| {
        let a = Data::from(store);
        let a = Args::<f32>::new(&a);
        a.fold(ends, 0.0, |s, item: [f32; 2], next: [f32; 2]| {
            s + item[0] * 10.0 + next[1]
        })
    };
    for count in [3.0, 1e30, f32::INFINITY] {
        assert_eq!(sum(&[count, 1.0, 2.0, 3.0, 4.0], Ends::Open), 14.0);
        assert_eq!(sum(&[count, 1.0, 2.0, 3.0, 4.0], Ends::Ring), 32.0 + 14.0);
    }
    for count in [0.0, -1.0, f32::NAN] {
        assert_eq!(sum(&[count, 1.0, 2.0, 3.0, 4.0], Ends::Ring), 0.0);
    }
    assert_eq!(sum(&[], Ends::Ring), 0.0);
    assert!(f32::param(&Data::from(vec![1.0]), 7).is_nan());
}
