//! Proofs that every number type computes the same formula.

use zeroset_catalogue::Roughness;
use zeroset_catalogue::{Kind, Unit};
use zeroset_number::Interval;

use crate::case::{Case, Failure, along, length};
use crate::entry::levels;

/// Error of `f32` and SIMD, relative to the size of the shape and the distance from the origin.
pub const SINGLE: f64 = 1e-5;

/// Share of the places at which a chaotic entry may be off by more than [`SINGLE`].
const CHAOS: f64 = 0.03;

/// `f32` and every SIMD level against `f64`; no gradient that is not a number, not even at places of symmetry.
pub fn single(case: &Case<'_>) -> Result<(), Failure> {
    let places: Vec<[f32; 3]> = case
        .places(600, 10)
        .iter()
        .map(|p| p.map(|x| x as f32))
        .collect();
    let mut excused = 0;
    let mut compare = |what: &str, p: [f32; 3], value: f32| {
        let p = p.map(f64::from);
        let exact = case.value(p);
        let allowed = SINGLE * (case.size + length(p));
        if !((f64::from(value) - exact).abs() <= allowed) {
            excused += 1;
            if case.entry.roughness == Roughness::Chaotic
                && value.is_finite()
                && f64::from(excused) < CHAOS * (places.len() * (1 + levels().len())) as f64
            {
                return Ok(());
            }
            return Err(case.fail(
                "f32",
                format!("{what} gives {value} at {p:?}, f64 gives {exact}"),
            ));
        }
        Ok(())
    };
    for &p in &places {
        let (value, gradient) = (case.entry.single)(p, &case.stored);
        compare("f32", p, value)?;
        if gradient.iter().any(|g| !g.is_finite()) {
            return Err(case.fail("gradient", format!("{gradient:?} in f32 at {p:?}")));
        }
    }
    for (name, level) in levels() {
        for (&p, value) in places
            .iter()
            .zip((case.entry.lanes)(level, &places, &case.stored))
        {
            compare(name, p, value)?;
        }
    }
    Ok(())
}

/// Share of small boxes whose range must be useful, and how many times wider than the field's variation it may be.
const USEFUL: (f64, f64) = (0.75, 64.0);

/// The range over a box holds the value at every point of it, and over small boxes says something.
pub fn interval(case: &Case<'_>) -> Result<(), Failure> {
    let mut random = case.random(11);
    let (mut small, mut useful) = (0_u32, 0_u32);
    for p in case.places(250, 12) {
        let half = random.scale(1e-4, 1.0) * case.size;
        let range = (case.entry.range)(p.map(|x| Interval::new(x - half, x + half)), &case.stored);
        for _ in 0..6 {
            let q = std::array::from_fn(|k| p[k] + random.within(-half, half));
            let value = case.value(q);
            let slack = 1e-12 * (case.size + length(q));
            if !(range.lo - slack <= value && value <= range.hi + slack) {
                return Err(case.fail(
                    "interval",
                    format!("{value} at {q:?} is not in {range:?}, half side {half}"),
                ));
            }
        }
        if half < 1e-2 * case.size {
            small += 1;
            useful += u32::from(range.hi - range.lo <= USEFUL.1 * case.lipschitz * half);
        }
    }
    if case.entry.roughness == Roughness::Smooth && f64::from(useful) < USEFUL.0 * f64::from(small)
    {
        return Err(case.fail(
            "interval",
            format!("only {useful} of {small} ranges over small boxes are useful"),
        ));
    }
    Ok(())
}

/// The dual number's value is the value, its gradient is the difference quotient, and no longer than the stated slope.
pub fn gradient(case: &Case<'_>) -> Result<(), Failure> {
    let places = case.places(600, 13);
    let h = 1e-5 * case.size;
    let mut smooth = 0;
    let special = case.special();
    for &p in &places {
        let (value, gradient) = (case.entry.gradient)(p, &case.stored);
        let plain = case.value(p);
        if !((value - plain).abs() <= 1e-12 * (case.size + length(p))) {
            return Err(case.fail(
                "gradient",
                format!("its value at {p:?} is {value}, not {plain}"),
            ));
        }
        let slope = length(gradient);
        if !(slope <= case.lipschitz * (1.0 + 1e-9) + 1e-9) {
            return Err(case.fail(
                "gradient",
                format!("{gradient:?} at {p:?} is longer than {}", case.lipschitz),
            ));
        }
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let quotients = axes.map(|d| {
            let (a, b) = (case.value(along(p, d, h)), case.value(along(p, d, -h)));
            ((a - plain) / h, (plain - b) / h)
        });
        if case.entry.roughness == Roughness::Folded && special.contains(&p) {
            smooth += 1;
            continue;
        }
        // At an edge of the field the two sides differ and there is no gradient to compare.
        if quotients
            .iter()
            .all(|(a, b)| (a - b).abs() < 1e-3 * case.lipschitz)
        {
            smooth += 1;
            for (k, (a, b)) in quotients.into_iter().enumerate() {
                if (gradient[k] - 0.5 * (a + b)).abs() > 2e-3 * case.lipschitz {
                    return Err(case.fail(
                        "gradient",
                        format!("{gradient:?} at {p:?}, differences give {quotients:?}"),
                    ));
                }
            }
        }
    }
    if smooth * 2 < places.len() {
        return Err(case.fail(
            "gradient",
            format!("smooth at only {smooth} of {} places", places.len()),
        ));
    }
    Ok(())
}

/// A shape of a thousand times the size, or a thousandth, is the same shape: no tolerance hidden in a formula is absolute.
/// (For entries whose size is set by lengths: that of a fractal is set by its iteration.)
pub fn any_size(case: &Case<'_>) -> Result<(), Failure> {
    let params = case.entry.info.params;
    let scales =
        case.entry.info.group != "Fractals" && params.iter().any(|p| p.unit == Unit::Length);
    if !scales || params.iter().any(|p| p.unit == Unit::Rate) {
        return Ok(());
    }
    // Powers of two, so that nothing is rounded.
    for factor in [1024.0, 1.0 / 1024.0] {
        let mut stored = case.stored.clone();
        let mut at = 0;
        for p in params {
            if let Kind::List(_) = p.kind {
                at += 1;
            }
            let len = if let Kind::List(_) = p.kind {
                stored.len() - at
            } else {
                p.kind.len()
            };
            if p.unit == Unit::Length {
                stored[at..at + len]
                    .iter_mut()
                    .for_each(|x| *x *= factor as f32);
            }
            at += len;
        }
        for p in case.places(150, 14) {
            let q = p.map(|x| x * factor);
            let (plain, scaled) = (case.value(p), (case.entry.value)(q, &stored) / factor);
            let near =
                |error: f64, value: f64| (value - plain).abs() <= error * (case.size + length(p));
            if !near(1e-9, scaled) {
                let what = format!("times {factor} it is {scaled} at {p:?}, not {plain}");
                return Err(case.fail("any size", what));
            }
            let single = (case.entry.single)(q.map(|x| x as f32), &stored);
            if !near(SINGLE, f64::from(single.0) / factor)
                || single.1.iter().any(|g| !g.is_finite())
            {
                let what = format!("times {factor} it is {single:?} in f32 at {p:?}, not {plain}");
                return Err(case.fail("any size", what));
            }
        }
    }
    Ok(())
}
