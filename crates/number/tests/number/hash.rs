//! The lattice hash gives the same bits in every number type.

use crate::formulas;
use crate::support::{Formula, dual_lanes, lanes, levels, reference};
use zeroset_number::{Args, Data, Hash, hash1, hash2, hash3, v3};

formulas! {
    One |p, a| hash1(p.x);
    Two |p, a| hash2(p.xy());
    Three |p, a| hash3(p);
    Next |p, a| Hash::of3(p).next().next().unit();
}

fn cells() -> Vec<[f32; 3]> {
    let mut cells = Vec::new();
    for i in -3000_i32..3000 {
        cells.push([i as f32, (i * 7 - 3) as f32, (-i * 57) as f32]);
        cells.push([
            (i * 1398) as f32,
            (4_194_304 - i.abs()) as f32,
            (i.abs() - 4_194_304) as f32,
        ]);
        // multiples of the period and their neighbours, where a quotient off by one would show
        cells.push([(i * 289) as f32, (i * 289 - 1) as f32, (i * 289 + 1) as f32]);
    }
    // too far for exact arithmetic, but still well defined
    cells.push([1e9, -1e30, f32::MAX]);
    cells.push([-0.0, 0.0, -1.0]);
    cells
}

fn same_bits<F: Formula>(name: &str) {
    let cells = cells();
    let expected: Vec<f64> = cells
        .iter()
        .map(|c| reference::<F>(&[], c.map(f64::from)))
        .collect();
    let check = |got: f32, i: usize, kind: &str| {
        assert_eq!(
            f64::from(got),
            expected[i],
            "{name} of {:?} in {kind}",
            cells[i]
        );
        assert!(
            (0.0..1.0).contains(&got),
            "{name} of {:?} is {got}",
            cells[i]
        );
    };
    for (i, c) in cells.iter().enumerate() {
        check(
            F::eval(v3(c[0], c[1], c[2]), Args::new(&Data::default())),
            i,
            "f32",
        );
    }
    for (kind, level) in levels() {
        for (i, got) in lanes::<F>(level, &[], &cells).into_iter().enumerate() {
            check(got, i, kind);
        }
        for (i, [got, ..]) in dual_lanes::<F>(level, &[], &cells).into_iter().enumerate() {
            check(got, i, kind);
        }
    }
}

#[test]
fn the_same_bits_in_every_number_type() {
    same_bits::<One>("hash1");
    same_bits::<Two>("hash2");
    same_bits::<Three>("hash3");
    same_bits::<Next>("next");
}

#[test]
fn values_are_spread_evenly() {
    // every value of a permutation occurs once in a period, and neighbours have nothing to do with each other
    let n = 289;
    let mut seen = vec![0_u32; n];
    let (mut sum, mut product) = (0.0, 0.0);
    for i in 0..n {
        let (a, b) = (hash1(i as f32), hash1(i as f32 + 1.0));
        seen[(a * n as f32).round() as usize] += 1;
        sum += f64::from(a);
        product += f64::from(a) * f64::from(b);
    }
    assert!(
        seen.iter().all(|&c| c == 1),
        "hash1 is a permutation: {seen:?}"
    );
    let mean = sum / n as f64;
    let correlation = (product / n as f64 - mean * mean) * 12.0;
    assert!(
        correlation.abs() < 0.1,
        "neighbours correlate by {correlation}"
    );
}

#[test]
fn planes_of_cells_differ() {
    let plane = |z: f32| -> Vec<f32> {
        (0..400)
            .map(|i| hash3(v3((i % 20) as f32, (i / 20) as f32, z)))
            .collect()
    };
    let equal = plane(0.0)
        .iter()
        .zip(plane(1.0))
        .filter(|(a, b)| **a == *b)
        .count();
    assert!(
        equal < 12,
        "{equal} of 400 cells have the same hash as the cell above"
    );
}
