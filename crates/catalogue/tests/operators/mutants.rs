//! Wrong operators that the proofs must refuse: a proof that cannot fail proves nothing.

use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::join::{Intersection, Subtraction, Union, Xor};
use zeroset_catalogue::join_edge::{ChamferUnion, RoundUnion, StairsUnion};
use zeroset_catalogue::join_line::Tongue;
use zeroset_catalogue::join_smooth::{
    ExponentialIntersection, ExponentialUnion, SmoothIntersection, SmoothUnion,
};
use zeroset_catalogue::map::{Elongate, Mirror, Revolve};
use zeroset_catalogue::map_bend::{Bend, Wrap};
use zeroset_catalogue::map_deform::{Scale3, Shear, Taper, Twist};
use zeroset_catalogue::modify::{Extrude, Onion, Round};
use zeroset_catalogue::{Join, Map, Modify, Stretch};
use zeroset_number::{Args, Interval, Real, v3};

use crate::formula::{Formula, Input, Numbers, Output, numbers};
use crate::statement::Failure;
use crate::{joins, maps, modifiers};

/// Formulas that something is wrong with.
macro_rules! formulas {
    ($($name:ident |$q:pat_param, $a:ident| $value:expr;)*) => {$(
        struct $name;
        impl Formula for $name {
            #[inline(always)]
            fn eval<R: Real>($q: Input<R>, $a: Args<'_, R>) -> Output<R> {
                $value
            }
        }
    )*};
}
formulas! {
    Negated |[_, x, y, z], a| [-Union::join(x, y, a), z * 0.0, z * 0.0];
    Swapped |[_, x, y, z], a| [Subtraction::join(y, x, a), z * 0.0, z * 0.0];
    Steeper |[_, x, y, z], a| [SmoothUnion::join(x, y, a) * 1.03, z * 0.0, z * 0.0];
    // the common form of a chamfer, which is too steep for parallel walls
    EuclideanChamfer |[_, x, y, z], a|
        [x.min(y).min((x + y - a.get(0)) * std::f32::consts::FRAC_1_SQRT_2), z * 0.0, z * 0.0];
    // ends where its operands are below the radius, as in common code
    CutRound |[_, x, y, z], a| {
        let joined = RoundUnion::join(x, y, a) - 0.01;
        let inside = x.below(a.get(0)) & y.below(a.get(0));
        [R::select(inside, joined, x.min(y)), z * 0.0, z * 0.0]
    };
    OtherWay |[_, x, y, z], a| { let q = Shear::map(v3(-x, y, z), a); [-q.x, q.y, q.z] };
    OtherAxis |[_, x, y, z], a| { let q = Twist::map(v3(y, x, z), a); [q.y, q.x, q.z] };
    Torn |[_, x, y, z], a| {
        let q = Elongate::map(v3(x, y, z), a);
        [R::select(y.above(0.1), q.x, q.x + 0.2), q.y, q.z]
    };
    Multiplied |[_, x, y, z], a| [x * a.get(0), y * a.get(1), z * a.get(2)];
    Shrunk |[d, x, y, z], a| [Round::modify(-d, v3(x, y, z), a), x * 0.0, x * 0.0];
    HeightForHalf |[d, x, y, z], a| [Extrude::modify(d, v3(x, y, z * 0.5), a), x * 0.0, x * 0.0];
    NotANumber |[d, _, y, _], _a| { let o = y * 0.0; [d + y / o * o, o, o] };
    Slightly |[_, x, y, z], a| [SmoothUnion::join(x, y, a) + 0.001, z * 0.0, z * 0.0];
}

#[track_caller]
fn refused(found: Result<(), Failure>, by: &[&str]) {
    match found {
        Ok(()) => panic!("a mutant passed"),
        Err(failure) => assert!(
            by.contains(&failure.proof),
            "refused for another reason: {failure}"
        ),
    }
}

fn join<J: Join>(change: impl Fn(&mut joins::Table)) -> Result<(), Failure> {
    let mut table = joins::table::<J>();
    change(&mut table);
    joins::prove(&table)
}

fn map<M: Map>(change: impl Fn(&mut maps::Table)) -> Result<(), Failure> {
    let mut table = maps::table::<M>();
    change(&mut table);
    maps::prove(&table)
}

fn modify<M: Modify>(change: impl Fn(&mut modifiers::Table)) -> Result<(), Failure> {
    let mut table = modifiers::table::<M>();
    change(&mut table);
    modifiers::prove(&table)
}

/// A tenth less, whatever the kind.
fn less(stretch: Result<Stretch, String>) -> Result<Stretch, String> {
    stretch.map(|s| match s {
        Stretch::Everywhere(l) => Stretch::Everywhere(0.9 * l),
        Stretch::Within(b, l) => Stretch::Within(b, 0.9 * l),
    })
}

/// A tenth narrower towards larger x.
fn narrower(b: Aabb) -> Aabb {
    let mut b = b;
    b.max[0] -= 0.1 * (b.max[0] - b.min[0]).min(1.0);
    b
}

#[test]
fn unchanged_entries_are_accepted() {
    for found in [
        join::<SmoothUnion>(|_| {}),
        map::<Twist>(|_| {}),
        modify::<Onion>(|_| {}),
    ] {
        found.unwrap_or_else(|failure| panic!("{failure}"));
    }
}

#[test]
fn wrong_formulas_of_joins_are_refused() {
    let formula = |n: Numbers| move |t: &mut joins::Table| t.common.numbers = n;
    refused(join::<Union>(formula(numbers::<Negated>())), &["sign"]);
    refused(
        join::<Subtraction>(formula(numbers::<Swapped>())),
        &["sign"],
    );
    refused(
        join::<SmoothUnion>(formula(numbers::<Steeper>())),
        &["slope"],
    );
    refused(
        join::<ChamferUnion>(formula(numbers::<EuclideanChamfer>())),
        &["slope"],
    );
    refused(
        join::<RoundUnion>(formula(numbers::<CutRound>())),
        &["slope"],
    );
    refused(join::<Union>(formula(numbers::<Swapped>())), &["sign"]);
}

#[test]
fn wrong_facts_of_joins_are_refused() {
    refused(
        join::<Union>(|t| t.lipschitz = |_, x, y| 0.9 * x.max(y)),
        &["slope"],
    );
    refused(
        join::<RoundUnion>(|t| t.lipschitz = |_, x, y| x.max(y)),
        &["slope"],
    );
    refused(
        join::<SmoothUnion>(|t| t.lipschitz = |_, x, y| 0.9 * x.max(y)),
        &["slope"],
    );
    refused(join::<Union>(|t| t.lipschitz = |_, x, y| x + y), &["slope"]);
    refused(
        join::<Union>(|t| t.level_bounds = |_, l, x, y| narrower(x(l).hull(&y(l)))),
        &["bounds"],
    );
    refused(
        join::<Union>(|t| t.level_bounds = |_, l, x, _| x(l)),
        &["bounds"],
    );
    refused(
        join::<SmoothUnion>(|t| t.level_bounds = |_, l, x, y| x(l).hull(&y(l))),
        &["bounds"],
    );
    refused(
        join::<Union>(|t| t.level_bounds = |_, _, x, y| x(0.0).hull(&y(0.0))),
        &["bounds"],
    );
    refused(
        join::<Tongue>(|t| t.level_bounds = |_, l, x, _| x(l)),
        &["bounds"],
    );
    refused(join::<StairsUnion>(|t| t.reach = |a| 0.2 * a[0]), &["sign"]);
    refused(
        join::<SmoothIntersection>(|t| t.contains = |x, y| x || y),
        &["sign"],
    );
    refused(
        join::<Intersection>(|t| t.exactness = |x, y| x.max(y).max(Exactness::Outside)),
        &["exactness"],
    );
    refused(
        join::<Union>(|t| t.exactness = |x, y| x.max(y)),
        &["exactness"],
    );
    refused(
        join::<Xor>(|t| t.exactness = |x, y| x.max(y).max(Exactness::Outside)),
        &["exactness"],
    );
    refused(
        join::<SmoothUnion>(|t| t.exactness = |_, _| Exactness::Outside),
        &["exactness"],
    );
}

#[test]
fn wrong_boxes_of_many_are_refused() {
    let hull = |_: &[f64], b: &[Aabb]| b.iter().fold(Aabb::EMPTY, |all, b| all.hull(b));
    refused(join::<SmoothUnion>(|t| t.fold_bounds = hull), &["bounds"]);
    let as_of_two = |a: &[f64], b: &[Aabb]| {
        b.iter()
            .fold(Aabb::EMPTY, |all, b| all.hull(&b.grow(0.25 * a[0])))
    };
    refused(
        join::<SmoothUnion>(|t| t.fold_bounds = as_of_two),
        &["bounds"],
    );
    let as_of_two = |a: &[f64], b: &[Aabb]| {
        b.iter()
            .fold(Aabb::EMPTY, |all, b| all.hull(&b.grow(0.3 * a[0])))
    };
    refused(
        join::<RoundUnion>(|t| t.fold_bounds = as_of_two),
        &["bounds"],
    );
    let pairs = |a: &[f64], b: &[Aabb]| {
        b.iter()
            .copied()
            .reduce(|x, y| SmoothUnion::bounds(a, &x, &y))
            .unwrap()
    };
    refused(join::<SmoothUnion>(|t| t.fold_bounds = pairs), &["bounds"]);
}

/// The exponential style is the associative one, and the only one.
#[test]
fn exponential_joins_do_not_depend_on_the_order() {
    let value =
        |t: &joins::Table, x: f64, y: f64| (t.common.numbers.value)([0.0, x, y, 0.0], &[0.4])[0];
    let spread = |t: &joins::Table| {
        let values = [0.3, -0.1, 0.05, 0.12, 0.7, -0.04];
        let mut all = Vec::new();
        for shift in 0..values.len() {
            for step in [1, 5] {
                let order = (0..values.len()).map(|i| values[(i * step + shift) % values.len()]);
                all.extend(order.reduce(|x, y| value(t, x, y)));
            }
        }
        let range = |start: f64, f: fn(f64, f64) -> f64| all.iter().copied().fold(start, f);
        range(f64::NEG_INFINITY, f64::max) - range(f64::INFINITY, f64::min)
    };
    assert!(spread(&joins::table::<ExponentialUnion>()) < 1e-12);
    assert!(spread(&joins::table::<ExponentialIntersection>()) < 1e-12);
    assert!(spread(&joins::table::<SmoothUnion>()) > 1e-3);
}

#[test]
fn wrong_maps_are_refused() {
    let formula = |n: Numbers| move |t: &mut maps::Table| t.common.numbers = n;
    refused(map::<Shear>(formula(numbers::<OtherWay>())), &["bounds"]);
    refused(
        map::<Twist>(formula(numbers::<OtherAxis>())),
        &["bounds", "stretch"],
    );
    refused(
        map::<Elongate>(formula(numbers::<Torn>())),
        &["stretch", "bounds"],
    );
    refused(
        map::<Scale3>(formula(numbers::<Multiplied>())),
        &["bounds", "stretch"],
    );
    refused(
        map::<Twist>(|t| t.stretch = |a, b| less(Twist::stretch(a, b))),
        &["stretch"],
    );
    refused(
        map::<Taper>(|t| t.stretch = |a, b| less(Taper::stretch(a, b))),
        &["stretch"],
    );
    refused(
        map::<Bend>(|t| t.stretch = |a, b| less(Bend::stretch(a, b))),
        &["stretch"],
    );
    refused(
        map::<Wrap>(|t| t.stretch = |a, b| less(Wrap::stretch(a, b))),
        &["stretch"],
    );
    refused(
        map::<Shear>(|t| t.stretch = |a, b| less(Shear::stretch(a, b))),
        &["stretch"],
    );
    refused(
        map::<Mirror>(|t| t.stretch = |a, b| less(Mirror::stretch(a, b))),
        &["stretch"],
    );
    refused(
        map::<Twist>(|t| t.bounds = |a, b| narrower(Twist::bounds(a, b))),
        &["bounds"],
    );
    refused(
        map::<Bend>(|t| t.bounds = |a, b| narrower(Bend::bounds(a, b))),
        &["bounds"],
    );
    refused(
        map::<Revolve>(|t| t.bounds = |a, b| narrower(Revolve::bounds(a, b))),
        &["bounds"],
    );
    refused(map::<Wrap>(|t| t.bounds = |_, b| *b), &["bounds"]);
    let careless = |_: &[f64], b: &Aabb| Ok(Stretch::Within(*b, 1.0));
    refused(map::<Bend>(|t| t.stretch = careless), &["stretch"]);
    refused(
        map::<Wrap>(|t| t.stretch = |_, _| Err("no".into())),
        &["stretch"],
    );
}

#[test]
fn wrong_modifiers_are_refused() {
    let formula = |n: Numbers| move |t: &mut modifiers::Table| t.common.numbers = n;
    refused(
        modify::<Round>(formula(numbers::<Shrunk>())),
        &["bounds", "exactness"],
    );
    refused(
        modify::<Extrude>(formula(numbers::<HeightForHalf>())),
        &["slope", "bounds", "exactness"],
    );
    refused(
        modify::<Round>(formula(numbers::<NotANumber>())),
        &["slope"],
    );
    refused(
        modify::<Onion>(|t| t.lipschitz = |_, s| 0.9 * s),
        &["slope"],
    );
    refused(
        modify::<Onion>(|t| t.level_bounds = |a, l, b| b(l + 0.4 * a[0])),
        &["bounds"],
    );
    refused(
        modify::<Round>(|t| t.level_bounds = |_, l, b| b(l)),
        &["bounds"],
    );
    refused(
        modify::<Onion>(|t| t.exactness = |e| e.max(Exactness::Outside)),
        &["exactness"],
    );
    refused(modify::<Onion>(|t| t.exactness = |e| e), &["exactness"]);
    refused(
        modify::<Round>(|t| t.exactness = |_| Exactness::Exact),
        &["exactness"],
    );
}

#[test]
fn wrong_number_types_are_refused() {
    let other = numbers::<Slightly>();
    refused(
        join::<SmoothUnion>(|t| t.common.numbers.single = other.single),
        &["f32"],
    );
    refused(
        join::<SmoothUnion>(|t| t.common.numbers.lanes = other.lanes),
        &["f32"],
    );
    refused(
        join::<SmoothUnion>(|t| t.common.numbers.gradient = other.gradient),
        &["gradient", "slope"],
    );
    let narrow = |q: Input<Interval>, a: &[f32]| {
        let r = (joins::table::<SmoothUnion>().common.numbers.range)(q, a);
        r.map(|r| Interval::new(r.lo + 0.1 * (r.hi - r.lo), r.hi))
    };
    refused(
        join::<SmoothUnion>(|t| t.common.numbers.range = narrow),
        &["interval"],
    );
    refused(
        join::<SmoothUnion>(|t| {
            t.common.numbers.shader = || "fn value() -> f32 { return vec2f(1.0); }".into()
        }),
        &["shader"],
    );
    refused(
        join::<SmoothUnion>(|t| t.common.samples = &[&[-1.0]]),
        &["info"],
    );
}
