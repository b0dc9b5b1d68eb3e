//! The comparators: against independent implementations, and each proven able to fail.

use proptest::prelude::*;
use zeroset_output::compare::{CompareError, compare};
use zeroset_output::picture::Picture;

/// A disc before a gradient, and a checkered strip. `shift` moves the disc, `tint` colours it.
fn scene(shift: f32, tint: f32) -> Picture {
    const SIZE: [u32; 2] = [97, 83];
    Picture::from_fn(SIZE[0], SIZE[1], |column, row| {
        let (x, y) = (column as f32, row as f32);
        if (column / 7 + row / 5) % 2 == 0 && row > 60 {
            [0.1; 3]
        } else if (x - 40.0 - shift).hypot(y - 35.0) < 20.0 {
            [0.85, 0.4 + tint, 0.15]
        } else {
            [
                0.2 + 0.5 * x / SIZE[0] as f32,
                0.3 + 0.4 * y / SIZE[1] as f32,
                0.6 - 0.3 * x / SIZE[0] as f32,
            ]
        }
    })
}

/// Mean and 99th percentile of the authors' own FLIP (flip-evaluator 1.7), and scikit-image 0.25's structural similarity
/// with a Gaussian window, on the same pictures.
#[test]
fn numbers_agree_with_independent_implementations() {
    let cases = [
        ("moved", scene(2.0, 0.0), [0.036919, 0.458010, 0.980097]),
        ("tinted", scene(0.0, 0.1), [0.068799, 0.401601, 0.960258]),
        ("both", scene(5.0, 0.3), [0.185824, 0.953017, 0.869147]),
    ];
    for (name, test, [flip_mean, flip_p99, ssim]) in cases {
        let found = compare(&scene(0.0, 0.0), &test).unwrap();
        assert!(
            (found.flip_mean - flip_mean).abs() < 1e-3,
            "{name}: FLIP {}",
            found.flip_mean
        );
        assert!(
            (found.flip_p99 - flip_p99).abs() < 2e-3,
            "{name}: FLIP at 99 % {}",
            found.flip_p99
        );
        assert!(
            (found.ssim - ssim).abs() < 1e-3,
            "{name}: SSIM {}",
            found.ssim
        );
    }
}

#[test]
fn equal_pictures_differ_by_nothing() {
    let found = compare(&scene(1.0, 0.2), &scene(1.0, 0.2)).unwrap();
    assert_eq!(
        (found.rmse, found.largest, found.flip_mean, found.flip_p99),
        (0.0, 0.0, 0.0, 0.0)
    );
    assert_eq!(found.psnr, f64::INFINITY);
    assert!((found.ssim - 1.0).abs() < 1e-6);
}

#[test]
fn every_number_sees_a_planted_change() {
    let original = scene(0.0, 0.0);
    let change = |change: fn(u32, u32, [f32; 3]) -> [f32; 3]| {
        Picture::from_fn(97, 83, |x, y| change(x, y, original.pixel(x, y).unwrap()))
    };
    let mutants = [
        (
            "a brighter picture",
            change(|_, _, p| p.map(|c| (c * 1.05).min(1.0))),
        ),
        ("swapped channels", change(|_, _, [r, g, b]| [b, g, r])),
        (
            "a spot",
            change(|x, y, p| {
                if x.abs_diff(60) < 3 && y.abs_diff(20) < 3 {
                    [1.0; 3]
                } else {
                    p
                }
            }),
        ),
        (
            "mirrored",
            Picture::from_fn(97, 83, |x, y| original.pixel(96 - x, y).unwrap()),
        ),
        (
            "one row off",
            Picture::from_fn(97, 83, |x, y| {
                original.pixel(x, y.saturating_sub(1)).unwrap()
            }),
        ),
    ];
    for (name, mutant) in mutants {
        let found = compare(&original, &mutant).unwrap();
        assert!(
            found.rmse > 0.005 && found.psnr < 46.0 && found.largest > 0.01,
            "{name}: {found:?}"
        );
        assert!(
            found.ssim < 0.9999 && found.flip_mean > 0.003 && found.flip_p99 > 0.05,
            "{name}: {}",
            found.flip_mean
        );
    }
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let picture = |w, h| Picture::filled(w, h, [0.5; 3]);
    assert_eq!(
        compare(&picture(3, 4), &picture(4, 3)),
        Err(CompareError::Sizes([3, 4], [4, 3]))
    );
    assert_eq!(
        compare(&picture(0, 4), &picture(0, 4)),
        Err(CompareError::Empty)
    );
    for (w, h) in [(1, 1), (1, 40), (11, 11), (12, 2)] {
        assert_eq!(
            compare(&picture(w, h), &picture(w, h)).unwrap().flip_mean,
            0.0
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn numbers_stay_in_their_ranges(seed in prop::collection::vec(0.0f32..=1.0, 2 * 3 * 9 * 7)) {
        let picture = |half: usize| Picture::from_fn(9, 7, |x, y| {
            let at = half * 189 + 3 * (y as usize * 9 + x as usize);
            [seed[at], seed[at + 1], seed[at + 2]]
        });
        let (a, b) = (picture(0), picture(1));
        let (found, swapped) = (compare(&a, &b).unwrap(), compare(&b, &a).unwrap());
        prop_assert!(found.flip.iter().all(|x| (0.0..=1.0).contains(x)));
        prop_assert!((found.flip_mean - swapped.flip_mean).abs() < 1e-6);
        prop_assert!((found.ssim - swapped.ssim).abs() < 1e-6 && found.ssim <= 1.0);
        prop_assert_eq!(found.picture().width(), 9);
    }
}
