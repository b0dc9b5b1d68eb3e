//! Proofs for modifiers.

use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::{Dimension, Modify};

use crate::field::{Field, prove_balls, prove_exactness, prove_slope};
use crate::formula::{Gradient, OfModify, numbers};
use crate::numbers::seeds;
use crate::shapes::{Point, Random, Shape, beside, is_sound, length, reached};
use crate::statement::{Common, Failure, Params};

type Level<'a> = &'a dyn Fn(f64) -> Aabb;

/// A modifier, as plain functions.
#[derive(Clone, Copy)]
pub struct Table {
    pub common: Common,
    pub lipschitz: fn(&[f64], f64) -> f64,
    pub level_bounds: fn(&[f64], f64, Level<'_>) -> Aabb,
    pub exactness: fn(Exactness) -> Exactness,
}

pub fn table<M: Modify>() -> Table {
    Table {
        common: Common {
            info: M::INFO,
            samples: M::SAMPLES,
            numbers: numbers::<OfModify<M>>(),
            check: M::check,
        },
        lipschitz: M::lipschitz,
        level_bounds: |a, level, shape| {
            if level == 0.0 {
                M::bounds(a, &shape(0.0))
            } else {
                M::level_bounds(a, level, shape)
            }
        },
        exactness: M::exactness,
    }
}

pub fn prove(t: &Table) -> Result<(), Failure> {
    t.common.prove_info()?;
    t.common.prove_shader()?;
    for a in t.common.sets() {
        derivatives(t, &a)?;
        in_space(t, &a)?;
        crate::numbers::single(&t.common, &a)?;
        crate::numbers::interval(&t.common, &a)?;
        crate::numbers::gradient(&t.common, &a)?;
    }
    Ok(())
}

fn is_flat(t: &Table) -> bool {
    t.common.info.dimension == Dimension::Two
}

/// The gradient of the result, for a field whose gradient points anywhere, is at most the constant, and comes near to it
/// unless it is a bound on noise.
pub fn derivatives(t: &Table, a: &Params) -> Result<(), Failure> {
    let mut random = Random::new(t.common.info.name, &a.exact, 50);
    for slope in [1.0, 0.3, 2.0] {
        let limit = (t.lipschitz)(&a.exact, slope);
        let mut steepest: f64 = 0.0;
        for _ in 0..4000 {
            let q = std::array::from_fn(|k| random.signed(if k == 0 { 1.0 } else { 3.0 }));
            let result = |g: Gradient| (t.common.numbers.gradient)(q, seeds(g), &a.stored)[0].1;
            let mut g = random.direction();
            if is_flat(t) {
                g[2] = 0.0;
            } else if random.unit() < 0.5 {
                // along what the modifier itself adds
                let own = result([0.0; 3]);
                if length(own) > 0.0 {
                    g = own.map(|x| x / length(own));
                }
            }
            let s = length(result(g.map(|x| x * slope)));
            if !(s <= limit * (1.0 + 1e-7)) {
                let what = format!(
                    "{s} at {q:?} for a field of slope {slope} along {g:?}, {limit} is stated"
                );
                return Err(t.common.fail("slope", a, what));
            }
            steepest = steepest.max(s);
        }
        if !(steepest >= 0.9 * limit) && t.common.info.group != "Noise displacement" {
            let what = format!(
                "{limit} is stated for a field of slope {slope}, only {steepest} is reached"
            );
            return Err(t.common.fail("slope", a, what));
        }
    }
    Ok(())
}

/// With shapes: slope, empty balls, boxes, exactness.
pub fn in_space(t: &Table, a: &Params) -> Result<(), Failure> {
    let mut random = Random::new(t.common.info.name, &a.exact, 51);
    for i in 0..10 {
        let mut shape = || {
            if is_flat(t) {
                Shape::flat(&mut random, 0.5)
            } else {
                Shape::solid(&mut random, 0.5)
            }
        };
        let shape = if i % 3 == 2 {
            Shape::Two(Box::new(shape()), Box::new(shape()))
        } else {
            shape()
        };
        let value =
            |p: Point| (t.common.numbers.value)([shape.value(p), p[0], p[1], p[2]], &a.stored)[0];
        let field = Field {
            common: &t.common,
            params: a,
            value: &value,
            what: format!("{shape:?}"),
        };
        let mut starts = vec![beside(shape.centre()); 6];
        starts.extend((0..200).map(|i| random.point(&Aabb::centred([[0.8, 2.0][i % 2]; 3]))));
        let limit = (t.lipschitz)(&a.exact, 1.0);
        prove_slope(&field, limit, &starts)?;
        prove_balls(&field, limit, &starts)?;
        prove_exactness(&field, (t.exactness)(shape.exactness()), &starts)?;
        let inner = shape.bounds();
        for level in [0.0, [-0.1, 0.2, 0.5][i % 3]] {
            let b = (t.level_bounds)(&a.exact, level, &|l| inner.grow(l));
            for p in reached(&value, level, &starts, 3.0) {
                if !is_sound(&b) || !b.grow(1e-6).contains(p) {
                    let what = format!(
                        "{p:?} with {} is not in {b:?} of level {level}, for {shape:?}",
                        value(p)
                    );
                    return Err(t.common.fail("bounds", a, what));
                }
            }
        }
    }
    Ok(())
}
