//! Proofs that every number type computes the same formula.

use zeroset_number::Interval;

use crate::formula::{Gradient, Input, Seeds, levels};
use crate::shapes::{Random, dot, length};
use crate::statement::{Common, Failure, Params};

/// Error of `f32` and SIMD, relative to the size of the numbers that go in.
const SINGLE: f64 = 1e-5;

/// Derivatives of the inputs, with `field` that of the field's value.
pub fn seeds(field: Gradient) -> Seeds {
    [field, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

fn inputs(c: &Common, a: &Params, n: usize, salt: u64) -> Vec<Input<f64>> {
    let mut random = Random::new(c.info.name, &a.exact, salt);
    let steps = [-1.0, -0.25, 0.0, 0.25, 1.0];
    let special = (0..125).map(|i| [steps[i % 5], steps[i % 5], steps[i / 5 % 5], steps[i / 25]]);
    let mut out: Vec<Input<f64>> = special.collect();
    for i in 0..n {
        let hi = [0.3, 3.0][i % 2];
        let mut q: Input<f64> = std::array::from_fn(|_| random.signed(hi));
        if i % 3 == 0 {
            // operands that nearly agree, as near as joins make a difference
            q[2] = q[1] + random.signed(0.3 * hi);
        }
        out.push(q.map(|x| f64::from(x as f32)));
    }
    out
}

fn size(q: Input<f64>) -> f64 {
    1.0 + q.iter().fold(0.0, |s: f64, x| s.max(x.abs()))
}

/// How much an output may vary with rounding: `f32` loses where the formula is steep.
fn allowed(c: &Common, a: &Params, q: Input<f64>) -> f64 {
    let field = [0.5, 0.5, 0.5];
    let steep = (c.numbers.gradient)(q, seeds(field), &a.stored)
        .map(|(_, g)| length(g))
        .into_iter()
        .fold(1.0, f64::max);
    SINGLE * size(q) * steep
}

/// `f32` and every SIMD level against `f64`, and no gradient that is not a number.
pub fn single(c: &Common, a: &Params) -> Result<(), Failure> {
    let places = inputs(c, a, 500, 1);
    let compare = |what: &str, q: Input<f64>, got: [f32; 3]| {
        let exact = (c.numbers.value)(q, &a.stored);
        let slack = allowed(c, a, q);
        if (0..3).all(|k| (f64::from(got[k]) - exact[k]).abs() <= slack) {
            return Ok(());
        }
        Err(c.fail(
            "f32",
            a,
            format!("{what} gives {got:?} at {q:?}, f64 gives {exact:?}"),
        ))
    };
    let stored: Vec<Input<f32>> = places.iter().map(|q| q.map(|x| x as f32)).collect();
    for (&q, &s) in places.iter().zip(&stored) {
        let got = (c.numbers.single)(s, seeds([0.6, 0.0, 0.8]), &a.stored);
        compare("f32", q, got.map(|r| r.0))?;
        if got.iter().any(|r| r.1.iter().any(|g| !g.is_finite())) {
            return Err(c.fail("gradient", a, format!("{got:?} in f32 at {q:?}")));
        }
    }
    for (name, level) in levels() {
        for (&q, got) in places
            .iter()
            .zip((c.numbers.lanes)(level, &stored, &a.stored))
        {
            compare(name, q, got)?;
        }
    }
    Ok(())
}

/// The ranges over a box hold the values and gradients at every point of it.
pub fn interval(c: &Common, a: &Params) -> Result<(), Failure> {
    let mut random = Random::new(c.info.name, &a.exact, 2);
    let seeds = seeds([0.6, 0.0, 0.8]);
    for q in inputs(c, a, 250, 3) {
        let half = random.scale(1e-4, 1.0);
        let range = q.map(|x| Interval::new(x - half, x + half));
        let values = (c.numbers.range)(range, &a.stored);
        let slopes = (c.numbers.slope)(range, seeds, &a.stored);
        for _ in 0..5 {
            let p = q.map(|x| x + random.within(-half, half));
            let slack = 1e-12 * size(p);
            for (k, (v, g)) in (c.numbers.gradient)(p, seeds, &a.stored)
                .into_iter()
                .enumerate()
            {
                let fits = |r: Interval, x: f64| r.lo - slack <= x && x <= r.hi + slack;
                if !fits(values[k], v) || !fits(slopes[k].v, v) {
                    return Err(c.fail(
                        "interval",
                        a,
                        format!("{v} at {p:?} is not in {:?}, half side {half}", values[k]),
                    ));
                }
                let longest = slopes[k].l * (1.0 + 1e-9) + 1e-9;
                let steeper = slopes[k]
                    .d
                    .iter()
                    .zip(g)
                    .any(|(r, x)| !(r.lo - 1e-9 <= x && x <= r.hi + 1e-9));
                if steeper || length(g) > longest {
                    return Err(c.fail(
                        "slope",
                        a,
                        format!("{g:?} at {p:?} is not in {:?}, half side {half}", slopes[k]),
                    ));
                }
            }
        }
    }
    Ok(())
}

/// Dual numbers: the value is the value, the gradient is the difference quotient.
pub fn gradient(c: &Common, a: &Params) -> Result<(), Failure> {
    let h = 1e-6;
    let places = inputs(c, a, 400, 4);
    let (mut smooth, mut all) = (0, 0);
    let field = [0.6, 0.0, 0.8];
    let ways = [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
        [1.0, -1.0, 0.0],
        [0.0, 1.0, 1.0],
    ];
    for &q in &places {
        let got = (c.numbers.gradient)(q, seeds(field), &a.stored);
        let plain = (c.numbers.value)(q, &a.stored);
        let moved = |d: [f64; 3], t: f64| {
            let step = [dot(d, field), d[0], d[1], d[2]];
            (c.numbers.value)(std::array::from_fn(|i| q[i] + t * step[i]), &a.stored)
        };
        let quotients = ways.map(|d| {
            let (above, below) = (moved(d, h), moved(d, -h));
            [0, 1, 2].map(|k| ((above[k] - plain[k]) / h, (plain[k] - below[k]) / h))
        });
        for k in 0..3 {
            all += 1;
            if !((got[k].0 - plain[k]).abs() <= 1e-12 * size(q)) {
                return Err(c.fail(
                    "gradient",
                    a,
                    format!("its value at {q:?} is {}, not {}", got[k].0, plain[k]),
                ));
            }
            // at an edge the two sides differ, and at a tear they jump: there is no gradient to compare
            let steep = quotients
                .iter()
                .fold(1.0, |s: f64, way| s.max(way[k].0.abs()));
            if quotients
                .iter()
                .any(|way| (way[k].0 - way[k].1).abs() > 1e-3 * steep)
                || steep > 1e4
            {
                continue;
            }
            smooth += 1;
            for (d, way) in ways.iter().zip(&quotients) {
                let (right, left) = way[k];
                if (dot(got[k].1, *d) - 0.5 * (right + left)).abs() > 3e-3 * steep {
                    let what = format!(
                        "{:?} at {q:?}, differences along {d:?} give {left} and {right}",
                        got[k].1
                    );
                    return Err(c.fail("gradient", a, what));
                }
            }
        }
    }
    if smooth * 10 < all * 7 {
        return Err(c.fail(
            "gradient",
            a,
            format!("smooth at only {smooth} of {all} places"),
        ));
    }
    Ok(())
}
