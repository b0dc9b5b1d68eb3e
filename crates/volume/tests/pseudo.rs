//! Pseudo-distances and Gaussians against their sums in double precision, and against what they stand for.

use proptest::prelude::*;
use zeroset_volume::pseudo::{Mip, PseudoError, gaussian, pseudo_distances};

/// The share of a cell that is filled after so many halvings, by the definition: of the four around each pair, along each axis.
fn share(size: [usize; 3], inside: &[bool], times: u32, cell: [i64; 3]) -> f64 {
    if times == 0 {
        let held = [0, 1, 2].map(|k| cell[k].clamp(0, size[k] as i64 - 1) as usize);
        return f64::from(u8::from(
            inside[held[0] + size[0] * (held[1] + size[1] * held[2])],
        ));
    }
    let finer = size.map(|n| (n >> (times - 1)) as i64);
    let mut sum = 0.0;
    for n in 0..64 {
        let step = [n % 4, n / 4 % 4, n / 16];
        let weight: f64 = step
            .iter()
            .map(|s| [0.125, 0.375, 0.375, 0.125][*s])
            .product();
        let at = [0, 1, 2].map(|k| (2 * cell[k] + step[k] as i64 - 1).clamp(0, finer[k] - 1));
        sum += weight * share(size, inside, times - 1, at);
    }
    sum
}

fn check(size: [usize; 3], inside: &[bool], mips: &[Mip], halvings: u32) {
    for (times, mip) in (halvings..).zip(mips) {
        let blurs: f64 = (0..times).map(|k| 0.75 * 4f64.powi(k as i32)).sum();
        let reach = ((blurs + 1.0 / 12.0) * std::f64::consts::TAU).sqrt();
        for (n, found) in mip.values.iter().enumerate() {
            let [nx, ny, _] = mip.size;
            let cell = [n % nx, n / nx % ny, n / nx / ny].map(|c| c as i64);
            let right = (0.5 - share(size, inside, times, cell)) * reach;
            assert!(
                (f64::from(*found) - right).abs() < 1e-5 * reach,
                "{times} {cell:?}"
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn pseudo_distances_are_blurred_halves(inside in prop::collection::vec(any::<bool>(), 16 * 8 * 8)) {
        let size = [16, 8, 8];
        check(size, &inside, &pseudo_distances(size, &inside, 1, 2).unwrap(), 1);
    }

    #[test]
    fn gaussians_are_sums(values in prop::collection::vec(-1.0f32..1.0, 7 * 5 * 6), deviation in 0.3f32..2.0) {
        let size = [7usize, 5, 6];
        let found = gaussian(size, &values, deviation).unwrap();
        let reach = (4.0 * deviation).ceil() as i64;
        let weight = |k: i64| (-0.5 * (k as f64 / f64::from(deviation)).powi(2)).exp();
        let all: f64 = (-reach..=reach).map(weight).sum();
        for (n, found) in found.iter().enumerate().step_by(17) {
            let cell = [n % 7, n / 7 % 5, n / 35].map(|c| c as i64);
            let mut sum = 0.0;
            for k in -reach..=reach {
                for j in -reach..=reach {
                    for i in -reach..=reach {
                        let at = [cell[0] + i, cell[1] + j, cell[2] + k];
                        let at = [0, 1, 2].map(|a| at[a].clamp(0, size[a] as i64 - 1) as usize);
                        sum += weight(i) * weight(j) * weight(k) * f64::from(values[at[0] + 7 * (at[1] + 5 * at[2])]);
                    }
                }
            }
            let right = sum / all.powi(3);
            prop_assert!((f64::from(*found) - right).abs() < 1e-5, "{found} instead of {right}");
        }
    }
}

/// A ball: the right sign, growing outwards, and near its surface a distance.
#[test]
fn a_ball_has_the_distance_near_its_surface() {
    let (n, radius) = (128usize, 40.0);
    let middle = n as f64 / 2.0;
    let far = |cell: [usize; 3], wide: f64| {
        cell.map(|c| (c as f64 + 0.5) * wide - middle)
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    };
    let inside: Vec<bool> = (0..n * n * n)
        .map(|k| far([k % n, k / n % n, k / n / n], 1.0) < radius)
        .collect();
    let mips = pseudo_distances([n; 3], &inside, 2, 3).unwrap();
    assert_eq!(
        mips.iter().map(|m| m.size[0]).collect::<Vec<_>>(),
        [32, 16, 8]
    );
    for mip in &mips {
        let wide = mip.cell as f64;
        let mut all: Vec<(f64, f64)> = (0..mip.values.len())
            .map(|k| {
                let [nx, ny, _] = mip.size;
                (
                    far([k % nx, k / nx % ny, k / nx / ny], wide) - radius,
                    f64::from(mip.values[k]),
                )
            })
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (right, found) in &all {
            assert!(
                right.abs() < 0.5 * wide || right.signum() == found.signum(),
                "{right} {found}"
            );
            if right.abs() < 0.25 * wide {
                assert!(
                    (right - found).abs() < 0.12 * wide,
                    "{found} instead of {right}"
                );
            }
        }
        // farther away is never nearer, but for what a lattice takes for round
        for pair in all.windows(2) {
            assert!(pair[1].1 > pair[0].1 - 0.08 * wide, "{pair:?}");
        }
    }
}

#[test]
fn what_cannot_be_halved_is_refused() {
    let of = |size: [usize; 3], marks: usize, halvings, mips| {
        pseudo_distances(size, &vec![false; marks], halvings, mips)
    };
    assert!(matches!(
        of([12, 8, 8], 768, 2, 2),
        Err(PseudoError::Size { times: 3, .. })
    ));
    assert!(matches!(
        of([8; 3], 511, 1, 1),
        Err(PseudoError::Count { .. })
    ));
    assert!(matches!(
        of([8; 3], 512, 0, 1),
        Err(PseudoError::Mips { .. })
    ));
    assert!(matches!(
        of([8; 3], 512, 1, 0),
        Err(PseudoError::Mips { .. })
    ));
    assert!(of([8; 3], 512, 1, 3).is_ok());
    assert!(
        gaussian([2; 3], &[0.0; 8], f32::NAN).is_err() && gaussian([2; 3], &[0.0; 7], 1.0).is_err()
    );
}
