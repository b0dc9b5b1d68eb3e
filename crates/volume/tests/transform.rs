//! Distance transforms: every one against all pairs of cells.

use proptest::prelude::*;
use zeroset_volume::transform::{Method, Metric, TransformError, distances, signed};

/// The least over all marked cells, by the definition.
fn right(size: [usize; 3], marked: &[bool], metric: Metric) -> Vec<f64> {
    let place =
        |i: usize| [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])].map(|x| x as f64);
    (0..marked.len())
        .map(|i| {
            let p = place(i);
            (0..marked.len())
                .filter(|j| marked[*j])
                .map(|j| {
                    let q = place(j);
                    let d = [0, 1, 2].map(|k| (p[k] - q[k]).abs());
                    match metric {
                        Metric::Euclidean => (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt(),
                        Metric::CityBlock => d[0] + d[1] + d[2],
                        Metric::Chessboard => d[0].max(d[1]).max(d[2]),
                    }
                })
                .fold(f64::INFINITY, f64::min)
        })
        .collect()
}

fn marks(count: usize, seed: u64, one_in: u64) -> Vec<bool> {
    let mut x = seed | 1;
    (0..count)
        .map(|_| {
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            x.is_multiple_of(one_in)
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]
    #[test]
    fn exact_is_exact(x in 1..14_usize, y in 1..14_usize, z in 1..9_usize, seed: u64, one_in in 1..80_u64) {
        let size = [x, y, z];
        let marked = marks(x * y * z, seed, one_in);
        for (_, metric) in Metric::ALL {
            let wanted = right(size, &marked, metric);
            for method in [Method::Exact, Method::Brute] {
                let got = distances(size, &marked, metric, method).unwrap();
                for (g, w) in got.iter().zip(&wanted) {
                    prop_assert_eq!(*g, *w as f32);
                }
            }
        }
    }
}

#[test]
fn a_volume_of_32_voxel_for_voxel() {
    for seed in 1..4 {
        let marked = marks(32 * 32 * 32, seed, 900);
        let all = |method| distances([32; 3], &marked, Metric::Euclidean, method).unwrap();
        assert_eq!(all(Method::Exact), all(Method::Brute));
    }
}

/// Chamfers are off by the share that Borgefors says; dead reckoning hardly ever is, and never below.
#[test]
fn the_old_ones_are_as_good_as_they_are_said_to_be() {
    for (size, seed) in [([60, 50, 1], 3), ([24, 20, 22], 5)] {
        let count = size.iter().product();
        let marked = marks(count, seed, 300);
        let exact = distances(size, &marked, Metric::Euclidean, Method::Exact).unwrap();
        let chamfer = distances(size, &marked, Metric::Euclidean, Method::Chamfer).unwrap();
        let dead = distances(size, &marked, Metric::Euclidean, Method::DeadReckoning).unwrap();
        let mut wrong = 0;
        for ((e, c), d) in exact.iter().zip(&chamfer).zip(&dead) {
            assert!((c - e).abs() <= 0.12 * e + 1e-4, "{c} for {e}");
            assert!(*d >= e - 1e-4 && *d < e + 0.5, "{d} for {e}");
            wrong += usize::from(*d > e + 1e-4);
        }
        assert!(wrong * 100 < count, "{wrong} of {count}");
    }
}

/// A half plane and a disc: the boundary is between the cells.
#[test]
fn signed_distances_are_from_the_boundary() {
    let half: Vec<bool> = (0..20 * 10).map(|i| i % 20 < 8).collect();
    for (_, method) in Method::ALL {
        let got = signed([20, 10, 1], &half, Metric::Euclidean, method).unwrap();
        for (i, d) in got.iter().enumerate() {
            // middles are half a cell from their sides; the boundary is at x = 8
            assert!(
                (d - ((i % 20) as f32 + 0.5 - 8.0)).abs() < 1e-5,
                "{d} at {i}"
            );
        }
    }
    let disc: Vec<bool> = (0..64 * 64)
        .map(|i| f64::hypot((i % 64) as f64 - 31.5, (i / 64) as f64 - 31.5) < 20.0)
        .collect();
    let got = signed([64, 64, 1], &disc, Metric::Euclidean, Method::Exact).unwrap();
    for (i, d) in got.iter().enumerate() {
        let right = f64::hypot((i % 64) as f64 - 31.5, (i / 64) as f64 - 31.5) - 20.0;
        assert!((f64::from(*d) - right).abs() < 0.8, "{d} for {right}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    assert_eq!(
        distances([2, 2, 1], &[true; 3], Metric::Euclidean, Method::Exact),
        Err(TransformError::Count {
            size: [2, 2, 1],
            marks: 3
        })
    );
    assert_eq!(
        distances([0, 1, 1], &[], Metric::Euclidean, Method::Exact),
        Err(TransformError::Size([0, 1, 1]))
    );
    assert_eq!(
        distances([1; 3], &[true], Metric::CityBlock, Method::Chamfer),
        Err(TransformError::Metric)
    );
    assert_eq!(
        distances([2, 1, 1], &[false; 2], Metric::Euclidean, Method::Exact),
        Ok(vec![f32::INFINITY; 2])
    );
    // all of one kind: no boundary
    assert!(
        signed([2, 1, 1], &[true; 2], Metric::Euclidean, Method::Exact)
            .unwrap()
            .iter()
            .all(|d| *d == f32::NEG_INFINITY)
    );
}
