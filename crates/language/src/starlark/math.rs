//! Mathematics. Functions of numbers take and give radians, as in Python, in shaders and in books; parameters of shapes that are
//! called angle are degrees.

use super::mistake::{Run, mistake};
use super::native::{Call, Given, Native, Slot, slot};
use super::value::Value;

macro_rules! function {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native {
            name: $name, doc: $doc, group: "Mathematics", params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run
        }
    };
    ($name:literal, $doc:literal, $f:expr) => { function!($name, $doc, [X], |c| one(c, $f)) };
}

const X: Slot = slot("x", "", "A number.");
const Y: Slot = slot("y", "", "A number.");

/// Constants: name, one line, value.
pub(crate) const CONSTANTS: &[(&str, &str, f64)] = &[
    (
        "pi",
        "3.14159..., half a turn in radians.",
        std::f64::consts::PI,
    ),
    (
        "tau",
        "6.28318..., a whole turn in radians.",
        std::f64::consts::TAU,
    ),
];

/// The functions.
pub(crate) const ALL: &[Native] = &[
    function!("sin", "Sine of x in radians.", f64::sin),
    function!("cos", "Cosine of x in radians.", f64::cos),
    function!("tan", "Tangent of x in radians.", f64::tan),
    function!(
        "asin",
        "The radians whose sine is x, from -1 to 1.",
        f64::asin
    ),
    function!(
        "acos",
        "The radians whose cosine is x, from -1 to 1.",
        f64::acos
    ),
    function!(
        "atan",
        "The radians whose tangent is y; of two numbers, those of the point (x, y).",
        [Y, slot("x", "None", "A number.")],
        |c| match c.get("x") {
            Some(_) => two(c, ["y", "x"], f64::atan2),
            None => {
                let given = c.need("y")?;
                let y = c.number("y", given)?;
                finite(c, y.atan())
            }
        }
    ),
    function!(
        "atan2",
        "The radians of the point (x, y).",
        [Y, X],
        |c| two(c, ["y", "x"], f64::atan2)
    ),
    function!(
        "radians",
        "Radians of x in degrees: sin(radians(30)) is 0.5.",
        f64::to_radians
    ),
    function!(
        "degrees",
        "Degrees of x in radians, for parameters called angle.",
        f64::to_degrees
    ),
    function!(
        "sqrt",
        "Square root of a number that is not negative.",
        f64::sqrt
    ),
    function!("exp", "e to the power of x.", f64::exp),
    function!("log", "Natural logarithm of a number above 0.", f64::ln),
    function!("tanh", "Hyperbolic tangent.", f64::tanh),
    function!(
        "floor",
        "The largest whole number that is not above x.",
        [X],
        |c| whole(c, f64::floor)
    ),
    function!(
        "ceil",
        "The smallest whole number that is not below x.",
        [X],
        |c| whole(c, f64::ceil)
    ),
    function!(
        "round",
        "The nearest whole number; or so many decimals.",
        [X, slot("digits", "None", "Decimals, 0 to 15.")],
        |c| {
            if c.get("digits").is_none() {
                return whole(c, f64::round);
            }
            let digits = c.count_or("digits", 0, 0, 15)?;
            let scale = 10_f64.powi(digits as i32);
            one(c, |x| (x * scale).round() / scale)
        }
    ),
    function!("abs", "The size of a number, without its sign.", [X], |c| {
        let given = c.need("x")?;
        match given.value {
            Value::Int(i) => i
                .checked_abs()
                .map(Value::Int)
                .ok_or_else(|| mistake("this whole number becomes too large")),
            _ => one(c, f64::abs),
        }
    }),
    function!("sign", "-1, 0 or 1.", [X], |c| {
        let given = c.need("x")?;
        let x = c.number("x", given)?;
        Ok(Value::Int(i64::from(x > 0.0) - i64::from(x < 0.0)))
    }),
    function!("pow", "x to the power of y.", [X, Y], |c| two(
        c,
        ["x", "y"],
        f64::powf
    )),
    function!("hypot", "Length of (x, y).", [X, Y], |c| two(
        c,
        ["x", "y"],
        f64::hypot
    )),
    function!(
        "clamp",
        "x, but not below min nor above max.",
        [
            X,
            slot("min", "0", "The smallest result."),
            slot("max", "1", "The largest result.")
        ],
        |c| {
            let limit = f64::MAX;
            let (min, max) = (
                c.number_or("min", 0.0, -limit, limit)?,
                c.number_or("max", 1.0, -limit, limit)?,
            );
            if min > max {
                return Err(mistake("`min` of clamp() must not be above `max`"));
            }
            one(c, |x| x.clamp(min, max))
        }
    ),
    function!(
        "lerp",
        "From a to b as t goes from 0 to 1: numbers, or tuples such as points and colours.",
        [
            slot("a", "", "A number or a tuple of numbers."),
            slot("b", "", "The same."),
            slot("t", "0.5", "Where between the two.")
        ],
        lerp
    ),
    function!(
        "length",
        "Length of a vector (x, y, ...).",
        [slot("v", "", "A tuple of numbers.")],
        |c| {
            let given = c.need("v")?;
            let numbers = vector(c, "v", given)?;
            Ok(Value::Float(
                numbers.iter().map(|x| x * x).sum::<f64>().sqrt(),
            ))
        }
    ),
    Native {
        name: "random",
        doc: "A number from 0 to 1 that looks random, always the same for the same numbers: random(i), random(i, j).",
        group: "Mathematics",
        params: &[],
        rest: true,
        run: random,
    },
];

fn finite(c: &Call<'_, '_>, x: f64) -> Run<Value> {
    if x.is_nan() {
        return Err(mistake(format!("{}() has no value for this", c.name)));
    }
    Ok(Value::Float(x))
}

fn one(c: &mut Call<'_, '_>, f: impl Fn(f64) -> f64) -> Run<Value> {
    let given = c.need("x")?;
    let x = c.number("x", given)?;
    finite(c, f(x))
}

fn two(c: &mut Call<'_, '_>, names: [&str; 2], f: impl Fn(f64, f64) -> f64) -> Run<Value> {
    let [a, b] = names.map(|n| c.need(n).and_then(|g| c.number(n, g)));
    finite(c, f(a?, b?))
}

/// A rounding: a whole number.
fn whole(c: &mut Call<'_, '_>, f: impl Fn(f64) -> f64) -> Run<Value> {
    let given = c.need("x")?;
    let x = f(c.number("x", given)?);
    if x.abs() < 9e18 {
        Ok(Value::Int(x as i64))
    } else {
        Ok(Value::Float(x))
    }
}

fn vector(c: &Call<'_, '_>, name: &str, given: Given) -> Run<Vec<f64>> {
    let items = c
        .machine
        .store
        .items(given.value)
        .ok_or_else(|| c.unfit(name, "a tuple of numbers", given))?;
    items
        .iter()
        .map(|value| {
            c.number(
                name,
                Given {
                    value: *value,
                    ..given
                },
            )
        })
        .collect()
}

fn lerp(c: &mut Call<'_, '_>) -> Run<Value> {
    let (a, b) = (c.need("a")?, c.need("b")?);
    let t = c.number_or("t", 0.5, -f64::MAX, f64::MAX)?;
    let blend = |a: f64, b: f64| a + (b - a) * t;
    if c.machine.store.items(a.value).is_none() {
        let (a, b) = (c.number("a", a)?, c.number("b", b)?);
        return Ok(Value::Float(blend(a, b)));
    }
    let (a, from) = (vector(c, "a", a)?, b);
    let b = vector(c, "b", b)?;
    if a.len() != b.len() {
        return Err(
            mistake(format!("lerp() of {} and {} numbers", a.len(), b.len())).at(from.place),
        );
    }
    c.machine.grow_items(a.len())?;
    c.machine.tuple(
        a.iter()
            .zip(&b)
            .map(|(a, b)| Value::Float(blend(*a, *b)))
            .collect(),
    )
}

/// A hash of the numbers given (the finaliser of SplitMix64, Steele, Lea and Flood 2014), as a number from 0 to 1.
fn random(c: &mut Call<'_, '_>) -> Run<Value> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for given in &c.rest {
        let x = c.number("seed", *given)?;
        // adding zero makes -0 the same as 0
        state = mixed(state ^ (x + 0.0).to_bits());
    }
    if c.rest.is_empty() {
        return Err(mistake("random() needs a number")
            .help("random(1), random(2), ... give different numbers"));
    }
    Ok(Value::Float((state >> 11) as f64 / (1_u64 << 53) as f64))
}

fn mixed(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}
