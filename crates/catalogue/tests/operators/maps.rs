//! Proofs for maps.

use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::{Dimension, Map, Stretch};

use crate::formula::{OfMap, numbers};
use crate::shapes::{Point, Random, Shape, along, dot, is_sound, length, reached, window};
use crate::statement::{Common, Failure, Params};

/// A map, as plain functions.
#[derive(Clone, Copy)]
pub struct Table {
    pub common: Common,
    pub stretch: fn(&[f64], &Aabb) -> Result<Stretch, String>,
    pub bounds: fn(&[f64], &Aabb) -> Aabb,
}

pub fn table<M: Map>() -> Table {
    Table {
        common: Common {
            info: M::INFO,
            samples: M::SAMPLES,
            numbers: numbers::<OfMap<M>>(),
            check: M::check,
        },
        stretch: M::stretch,
        bounds: M::bounds,
    }
}

pub fn prove(t: &Table) -> Result<(), Failure> {
    t.common.prove_info()?;
    t.common.prove_shader()?;
    for a in t.common.sets() {
        in_space(t, &a)?;
        unbounded(t, &a)?;
        crate::numbers::single(&t.common, &a)?;
        crate::numbers::interval(&t.common, &a)?;
        crate::numbers::gradient(&t.common, &a)?;
    }
    Ok(())
}

fn map(t: &Table, a: &Params, p: Point) -> Point {
    (t.common.numbers.value)([0.0, p[0], p[1], p[2]], &a.stored)
}

/// Half side of the part of space that maps are tried in.
const WINDOW: f64 = 6.0;

/// With bounded shapes: the stretch and the box, and that most shapes are taken.
pub fn in_space(t: &Table, a: &Params) -> Result<(), Failure> {
    let mut random = Random::new(t.common.info.name, &a.exact, 40);
    let (mut taken, mut steepest) = (0, 0.0_f64);
    let shapes = 16;
    for i in 0..shapes {
        let spread = [0.0, 0.4, 0.8][i % 3];
        let shape = if t.common.info.dimension == Dimension::Two {
            Shape::flat(&mut random, spread)
        } else {
            Shape::solid(&mut random, spread)
        };
        let b = (t.bounds)(&a.exact, &shape.bounds());
        boxed(t, a, &shape, &b, &mut random)?;
        match (t.stretch)(&a.exact, &b) {
            Ok(stretch) => {
                taken += 1;
                steepest = steepest.max(stretched(t, a, &b, stretch, &mut random)?);
            }
            Err(why) if why.is_empty() => {
                return Err(t
                    .common
                    .fail("stretch", a, "refused without a reason".into()));
            }
            Err(_) => {}
        }
    }
    if taken * 2 < shapes {
        return Err(t.common.fail(
            "stretch",
            a,
            format!("only {taken} of {shapes} shapes are taken"),
        ));
    }
    if steepest < 0.95 {
        return Err(t.common.fail(
            "stretch",
            a,
            format!("at most {steepest} of what is stated is reached"),
        ));
    }
    Ok(())
}

/// All places whose image is in the shape are in the box.
fn boxed(
    t: &Table,
    a: &Params,
    shape: &Shape,
    b: &Aabb,
    random: &mut Random,
) -> Result<(), Failure> {
    if !is_sound(b) {
        return Err(t.common.fail("bounds", a, format!("{b:?} for {shape:?}")));
    }
    let value = |p: Point| shape.value(map(t, a, p));
    let near = if b.is_empty() {
        Aabb::centred([2.0; 3])
    } else {
        window(&b.grow(0.3), WINDOW)
    };
    let all = Aabb::centred([WINDOW; 3]);
    let starts: Vec<Point> = (0..400)
        .map(|i| random.point(if i % 4 == 0 { &all } else { &near }))
        .collect();
    for p in reached(&value, 0.0, &starts, WINDOW) {
        if !b.grow(1e-6).contains(p) {
            let what = format!("{p:?} with {} is not in {b:?}, for {shape:?}", value(p));
            return Err(t.common.fail("bounds", a, what));
        }
    }
    Ok(())
}

/// Ways between places of the box, and directions at them, are not stretched by more than is stated. What share of it is
/// reached.
fn stretched(
    t: &Table,
    a: &Params,
    b: &Aabb,
    stretch: Stretch,
    random: &mut Random,
) -> Result<f64, Failure> {
    let fail = |what: String| {
        t.common
            .fail("stretch", a, format!("{what}, {stretch:?} is stated"))
    };
    let (room, limit) = match stretch {
        Stretch::Everywhere(l) => (Aabb::centred([3.0; 3]), l),
        Stretch::Within(inner, l) => {
            if b.intersect(&inner) != *b {
                return Err(fail(format!("the box does not hold {b:?}")));
            }
            (window(&inner, WINDOW), l)
        }
    };
    if !(limit > 0.0 && limit.is_finite()) {
        return Err(fail("no constant".into()));
    }
    if room.is_empty() {
        return Ok(1.0);
    }
    let (centre, half) = (room.centre(), room.half());
    let mut steepest: f64 = 0.0;
    for i in 0..300 {
        let p: Point = if i < 125 {
            let steps = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|s| s * 0.999);
            let s = [steps[i % 5], steps[i / 5 % 5], steps[i / 25]];
            std::array::from_fn(|k| centre[k] + s[k] * half[k])
        } else {
            random.point(&room)
        };
        let s = largest_singular_value(&|p| map(t, a, p), p);
        if !(s <= limit * (1.0 + 1e-5)) {
            return Err(fail(format!("directions at {p:?} are stretched {s} times")));
        }
        steepest = steepest.max(s);
        let q = random.point(&room);
        let (way, image) = (
            length(along(p, q, -1.0)),
            length(along(map(t, a, p), map(t, a, q), -1.0)),
        );
        if !(image <= limit * way * (1.0 + 1e-9) + 1e-12) {
            return Err(fail(format!(
                "the way from {p:?} to {q:?} is stretched {} times",
                image / way
            )));
        }
    }
    Ok(steepest / limit)
}

/// By differences; at a fold of space it is that of a mean of both sides, which is no larger.
fn largest_singular_value(map: &dyn Fn(Point) -> Point, p: Point) -> f64 {
    let h = 1e-5;
    let columns: [Point; 3] = std::array::from_fn(|k| {
        let (mut u, mut v) = (p, p);
        u[k] += h;
        v[k] -= h;
        along(map(u), map(v), -1.0).map(|x| x / (2.0 * h))
    });
    // power iteration on J^T J
    let mut v = [0.57, 0.61, 0.55];
    let mut s = 0.0;
    for _ in 0..100 {
        let image = (0..3).fold([0.0; 3], |sum, k| along(sum, columns[k], v[k]));
        let next: Point = std::array::from_fn(|k| dot(columns[k], image));
        let r = length(next);
        if r < 1e-30 {
            return s;
        }
        s = length(image) / length(v);
        v = next.map(|x| x / r);
    }
    s
}

/// Boxes with infinite sides and without any place give boxes of numbers.
fn unbounded(t: &Table, a: &Params) -> Result<(), Failure> {
    let far = f64::INFINITY;
    let sides = [
        (-far, far),
        (-0.5, far),
        (-far, 0.7),
        (-0.5, 0.7),
        (0.0, 0.0),
        (0.3, 0.9),
    ];
    for (i, x) in sides.into_iter().enumerate() {
        for y in sides {
            for z in [sides[0], sides[3], sides[i]] {
                let shape = Aabb::new([x.0, y.0, z.0], [x.1, y.1, z.1]);
                let b = (t.bounds)(&a.exact, &shape);
                let stretch = (t.stretch)(&a.exact, &b);
                let limit = match stretch {
                    Ok(Stretch::Everywhere(l) | Stretch::Within(_, l)) => l,
                    Err(_) => 1.0,
                };
                if !is_sound(&b) || !limit.is_finite() {
                    return Err(t.common.fail(
                        "bounds",
                        a,
                        format!("{b:?} and {stretch:?} for {shape:?}"),
                    ));
                }
            }
        }
    }
    let b = (t.bounds)(&a.exact, &Aabb::EMPTY);
    if !is_sound(&b) || !b.is_empty() {
        return Err(t.common.fail("bounds", a, format!("{b:?} for nothing")));
    }
    Ok(())
}
