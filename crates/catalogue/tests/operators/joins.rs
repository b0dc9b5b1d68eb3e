//! Proofs for joins.

use zeroset_catalogue::Join;
use zeroset_catalogue::bounds::{Aabb, Exactness};

use crate::field::{Field, prove_balls, prove_exactness, prove_slope};
use crate::formula::{OfJoin, numbers};
use crate::shapes::{Point, Random, Shape, beside, is_sound, pairs, reached};
use crate::statement::{Common, Failure, Params};

type Level<'a> = &'a dyn Fn(f64) -> Aabb;

/// A join, as plain functions.
#[derive(Clone, Copy)]
pub struct Table {
    pub common: Common,
    pub lipschitz: fn(&[f64], f64, f64) -> f64,
    pub level_bounds: fn(&[f64], f64, Level<'_>, Level<'_>) -> Aabb,
    pub fold_bounds: fn(&[f64], &[Aabb]) -> Aabb,
    pub exactness: fn(Exactness, Exactness) -> Exactness,
    pub reach: fn(&[f64]) -> f64,
    pub contains: fn(bool, bool) -> bool,
}

pub fn table<J: Join>() -> Table {
    Table {
        common: Common {
            info: J::INFO,
            samples: J::SAMPLES,
            numbers: numbers::<OfJoin<J>>(),
            check: J::check,
        },
        lipschitz: J::lipschitz,
        level_bounds: |a, level, x, y| {
            if level == 0.0 {
                J::bounds(a, &x(0.0), &y(0.0))
            } else {
                J::level_bounds(a, level, x, y)
            }
        },
        fold_bounds: J::fold_bounds,
        exactness: J::exactness,
        reach: J::reach,
        contains: J::contains,
    }
}

pub fn prove(t: &Table) -> Result<(), Failure> {
    t.common.prove_info()?;
    t.common.prove_shader()?;
    for a in t.common.sets() {
        derivatives(t, &a)?;
        sign(t, &a)?;
        in_space(t, &a)?;
        folds(t, &a)?;
        crate::numbers::single(&t.common, &a)?;
        crate::numbers::interval(&t.common, &a)?;
        crate::numbers::gradient(&t.common, &a)?;
    }
    Ok(())
}

fn value(t: &Table, a: &Params, x: f64, y: f64) -> f64 {
    (t.common.numbers.value)([0.0, x, y, 0.0], &a.stored)[0]
}

/// Lengths that matter to the join: its largest parameter, or 1.
fn size(a: &Params) -> f64 {
    a.exact
        .iter()
        .copied()
        .filter(|x| *x < 2.0)
        .fold(0.05, f64::max)
}

/// Operands all over, near each other, near the surface, far away.
fn operands(t: &Table, a: &Params, n: usize) -> Vec<[f64; 2]> {
    let mut random = Random::new(t.common.info.name, &a.exact, 20);
    let near = size(a);
    (0..n)
        .map(|i| {
            let x = random.signed([1.0, 3.0, 20.0][i % 3] * near);
            let y = if i % 2 == 0 {
                x + random.signed(1.5 * near)
            } else {
                random.signed(3.0 * near)
            };
            [x, y]
        })
        .collect()
}

/// `|F_x| Lx + |F_y| Ly`, which parallel or opposed gradients reach, is at most the constant and comes near to it; for
/// derivatives and for short and long ways.
pub fn derivatives(t: &Table, a: &Params) -> Result<(), Failure> {
    let fail = |what: String| t.common.fail("slope", a, what);
    let mut random = Random::new(t.common.info.name, &a.exact, 21);
    for (lx, ly) in [(1.0, 1.0), (2.0, 0.7), (0.4, 1.5)] {
        let limit = (t.lipschitz)(&a.exact, lx, ly);
        let mut steepest: f64 = 0.0;
        for [x, y] in operands(t, a, 3000) {
            let seeds = crate::numbers::seeds([0.0; 3]);
            let (v, g) = (t.common.numbers.gradient)([0.0, x, y, 0.0], seeds, &a.stored)[0];
            let mut slope = g[0].abs() * lx + g[1].abs() * ly;
            for (sx, sy) in [(1.0, 1.0), (1.0, -1.0)] {
                let h = random.scale(1e-6, 1.0) * size(a);
                let step = value(t, a, x + sx * lx * h, y + sy * ly * h) - v;
                slope = slope.max((step.abs() - 1e-14 * (1.0 + x.abs() + y.abs())) / h);
            }
            if !(slope <= limit * (1.0 + 1e-7)) {
                return Err(fail(format!(
                    "{slope} at ({x}, {y}) for slopes {lx} and {ly}, {limit} is stated"
                )));
            }
            steepest = steepest.max(slope);
        }
        if !(steepest >= 0.93 * limit) {
            return Err(fail(format!(
                "{limit} is stated for slopes {lx} and {ly}, only {steepest} is reached"
            )));
        }
    }
    Ok(())
}

/// Beyond the reach of the join, the operands' signs decide; and the reach of the smooth ones is no larger than needed.
pub fn sign(t: &Table, a: &Params) -> Result<(), Failure> {
    let reach = (t.reach)(&a.exact);
    for [x, y] in operands(t, a, 4000) {
        let v = value(t, a, x, y);
        if x.abs() > reach && y.abs() > reach && (v <= 0.0) != (t.contains)(x <= 0.0, y <= 0.0) {
            return Err(t
                .common
                .fail("sign", a, format!("{v} at ({x}, {y}), reach {reach}")));
        }
    }
    Ok(())
}

/// With shapes for operands: slope, empty balls, boxes, exactness.
pub fn in_space(t: &Table, a: &Params) -> Result<(), Failure> {
    let mut random = Random::new(t.common.info.name, &a.exact, 22);
    for (i, (x, y)) in pairs(&mut random).into_iter().enumerate() {
        let value = |p: Point| value(t, a, x.value(p), y.value(p));
        let field = Field {
            common: &t.common,
            params: a,
            value: &value,
            what: format!("{x:?} and {y:?}"),
        };
        let starts = starts(&mut random, &[&x, &y]);
        prove_slope(&field, (t.lipschitz)(&a.exact, 1.0, 1.0), &starts)?;
        prove_balls(&field, (t.lipschitz)(&a.exact, 1.0, 1.0), &starts)?;
        prove_exactness(&field, (t.exactness)(x.exactness(), y.exactness()), &starts)?;
        for level in [0.0, [-0.1, 0.2, 0.5][i % 3]] {
            let (bx, by) = (x.bounds(), y.bounds());
            let b = (t.level_bounds)(&a.exact, level, &|l| bx.grow(l), &|l| by.grow(l));
            if !is_sound(&b) {
                return Err(t
                    .common
                    .fail("bounds", a, format!("{b:?} for {x:?} and {y:?}")));
            }
            for p in reached(&value, level, &starts, 3.0) {
                if !b.grow(1e-6).contains(p) {
                    let what = format!(
                        "{p:?} with {} is not in {b:?} of level {level}, for {x:?} and {y:?}",
                        value(p)
                    );
                    return Err(t.common.fail("bounds", a, what));
                }
            }
        }
    }
    Ok(())
}

/// Places all over, and the centres of the shapes.
fn starts(random: &mut Random, shapes: &[&Shape]) -> Vec<Point> {
    let mut out: Vec<Point> = shapes
        .iter()
        .flat_map(|s| [beside(s.centre()); 6])
        .collect();
    out.extend((0..120).map(|i| random.point(&Aabb::centred([[0.8, 2.0][i % 2]; 3]))));
    out
}

/// Many shapes joined from left to right stay in the box of all, when they coincide and when they do not.
pub fn folds(t: &Table, a: &Params) -> Result<(), Failure> {
    let mut random = Random::new(t.common.info.name, &a.exact, 23);
    for (i, n) in [1, 2, 3, 5, 12, 12].into_iter().enumerate() {
        let spread = [0.0, 0.1][i % 2] * size(a);
        let shapes: Vec<Shape> = (0..n)
            .map(|_| Shape::Ball {
                c: std::array::from_fn(|_| random.within(-spread, spread)),
                r: 0.7 + random.within(-spread, spread),
            })
            .collect();
        let values = |p: Point| shapes.iter().map(move |s| s.value(p));
        let joined = |p: Point| values(p).reduce(|x, y| value(t, a, x, y)).unwrap_or(0.0);
        let boxes: Vec<Aabb> = shapes.iter().map(|s| s.bounds()).collect();
        let b = (t.fold_bounds)(&a.exact, &boxes);
        let starts = starts(&mut random, &[&shapes[0], &shapes[n - 1]]);
        for p in reached(&joined, 0.0, &starts, 3.0) {
            if !is_sound(&b) || !b.grow(1e-6).contains(p) {
                let what = format!("{p:?} with {} is not in {b:?}, for {shapes:?}", joined(p));
                return Err(t.common.fail("bounds", a, what));
            }
        }
        // not much larger than needed either, where the join adds to the shapes at all
        let grown = b.max[0] - boxes.iter().fold(f64::NEG_INFINITY, |m, b| m.max(b.max[0]));
        if grown > 2.0 * size(a) {
            return Err(t.common.fail(
                "bounds",
                a,
                format!("{b:?} is {grown} wider than its {n} shapes"),
            ));
        }
    }
    Ok(())
}
