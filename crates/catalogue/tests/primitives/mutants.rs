//! Wrong entries that the proofs must refuse: a proof that cannot fail proves nothing.

use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::solid::Cuboid;
use zeroset_catalogue::{Info, Primitive};
use zeroset_number::{Args, Interval, Real, Vec3, v3};

use crate::entry::{Entry, entry};
use crate::prove;

/// Boxes whose distance is `$value`, all else being right.
macro_rules! mutants {
    ($($name:ident |$p:ident, $a:ident| $value:expr;)*) => {$(
        struct $name;
        impl Primitive for $name {
            const INFO: Info = Cuboid::INFO;
            const SAMPLES: &'static [&'static [f64]] = &[&[1.0, 1.5, 0.75]];
            const EXACTNESS: Exactness = Exactness::Exact;
            #[inline(always)]
            fn distance<R: Real>($p: Vec3<R>, $a: Args<'_, R>) -> R {
                $value
            }
            fn bounds(a: &[f64]) -> Aabb {
                Cuboid::bounds(a)
            }
            fn contains(a: &[f64], p: [f64; 3]) -> bool {
                Cuboid::contains(a, p)
            }
        }
    )*};
}
mutants! {
    Itself |p, a| Cuboid::distance(p, a);
    WrongSign |p, a| -Cuboid::distance(p, a);
    Longer |p, a| Cuboid::distance(p, a) * 1.05;
    SlightlyLonger |p, a| Cuboid::distance(p, a) * 1.01;
    Shorter |p, a| Cuboid::distance(p, a) * 0.99;
    SwappedAxes |p, a| Cuboid::distance(v3(p.y, p.x, p.z), a);
    Thicker |p, a| Cuboid::distance(p, a) - 0.002;
    Jump |p, a| { let d = Cuboid::distance(p, a); R::select(p.x.above(0.2), d * 0.98, d) };
    FarJump |p, a| { let d = Cuboid::distance(p, a); R::select(d.above(0.3), d * 0.95, d) };
    NotANumber |p, a| { let d = Cuboid::distance(p, a); d + (-(p.y * p.y) - 1.0).sqrt() };
    Absolute |p, a| Cuboid::distance(p, a).min(100.0);
    BadGradient |p, a| { let d = Cuboid::distance(p, a); d + (p.y * p.y).sqrt() * 0.0 / p.y };
}

#[track_caller]
fn refused(e: &Entry, by: &[&str]) {
    match prove(e) {
        Ok(()) => panic!("a mutant passed"),
        Err(failure) => assert!(
            by.contains(&failure.proof),
            "refused for another reason: {failure}"
        ),
    }
}

#[test]
fn the_unchanged_box_is_accepted() {
    prove(&entry::<Itself>()).unwrap_or_else(|failure| panic!("{failure}"));
}

#[test]
fn wrong_distances_are_refused() {
    refused(&entry::<WrongSign>(), &["sign"]);
    refused(&entry::<Longer>(), &["slope"]);
    refused(&entry::<SlightlyLonger>(), &["slope"]);
    refused(&entry::<Shorter>(), &["distance"]);
    refused(&entry::<SwappedAxes>(), &["sign"]);
    refused(&entry::<Thicker>(), &["sign"]);
    refused(&entry::<Jump>(), &["slope", "distance"]);
    refused(&entry::<FarJump>(), &["slope", "distance"]);
    refused(&entry::<NotANumber>(), &["sign"]);
    refused(&entry::<BadGradient>(), &["sign", "gradient"]);
    refused(&entry::<Absolute>(), &["any size"]);
}

#[test]
fn balls_that_are_not_empty_are_refused() {
    // The slope as stated is right for the value, which is no distance: only the ball can tell.
    let wrong = Entry {
        lipschitz: |_| 1.0,
        ..entry::<Longer>()
    };
    let params = wrong.info.defaults();
    let case =
        crate::case::Case::new(&wrong, &params).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(crate::geometry::empty_ball(&case).is_err());
    let right = Entry {
        lipschitz: |_| 1.05,
        exactness: Exactness::Bound,
        ..wrong
    };
    prove(&right).unwrap_or_else(|failure| panic!("{failure}"));
}

#[test]
fn wrong_boxes_are_refused() {
    refused(
        &Entry {
            bounds: |a| Aabb::centred([0.499 * a[0], 0.5 * a[1], 0.5 * a[2]]),
            ..entry::<Itself>()
        },
        &["bounds"],
    );
    refused(
        &Entry {
            bounds: |a| Aabb::centred([0.5 * a[1], 0.5 * a[0], 0.5 * a[2]]),
            ..entry::<Itself>()
        },
        &["bounds"],
    );
    refused(
        &Entry {
            bounds: |a| Aabb::centred([0.5 * a[0], 0.8 * a[1], 0.5 * a[2]]),
            ..entry::<Itself>()
        },
        &["bounds"],
    );
    refused(
        &Entry {
            bounds: |_| Aabb::EMPTY,
            ..entry::<Itself>()
        },
        &["bounds"],
    );
}

#[test]
fn wrong_number_types_are_refused() {
    let good = entry::<Itself>();
    refused(
        &Entry {
            single: entry::<Thicker>().single,
            ..good
        },
        &["f32"],
    );
    refused(
        &Entry {
            lanes: entry::<Thicker>().lanes,
            ..good
        },
        &["f32"],
    );
    refused(
        &Entry {
            range: entry::<Thicker>().range,
            ..good
        },
        &["interval"],
    );
    refused(
        &Entry {
            gradient: entry::<SlightlyLonger>().gradient,
            ..good
        },
        &["gradient"],
    );
    refused(
        &Entry {
            gradient: entry::<SwappedAxes>().gradient,
            ..good
        },
        &["gradient"],
    );
    refused(
        &Entry {
            range: |_, _| Interval::new(f64::NEG_INFINITY, f64::INFINITY),
            ..good
        },
        &["interval"],
    );
}

#[test]
fn wrong_words_are_refused() {
    let good = entry::<Itself>();
    refused(
        &Entry {
            info: Info {
                name: "Box",
                ..good.info
            },
            ..good
        },
        &["info"],
    );
    refused(
        &Entry {
            info: Info {
                doc: "no full stop",
                ..good.info
            },
            ..good
        },
        &["info"],
    );
    refused(
        &Entry {
            samples: &[&[1.0, 1.0]],
            ..good
        },
        &["info"],
    );
    refused(
        &Entry {
            samples: &[&[1.0, 1.0, -1.0]],
            ..good
        },
        &["info"],
    );
    refused(
        &Entry {
            shader: || "fn value(p: vec3f, at: u32) -> f32 { return p; }".into(),
            ..good
        },
        &["shader"],
    );
}
