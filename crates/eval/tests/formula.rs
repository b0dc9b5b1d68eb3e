//! What formulas compile to: fields that never overestimate, in the box and beyond it.

use fearless_simd::Level;
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::{BATCH, Point, Workspace};
use zeroset_field::field::Field;
use zeroset_field::formula::{
    Binary, Budget, Builder, Expression, Formula, FormulaStep, NoiseKind, ProofError, Steps, Unary,
};
use zeroset_field::program::{Limits, Program};
use zeroset_number::{F64, Interval, v3};

/// The steps of a formula of the point.
fn steps(f: impl Fn(&Expression) -> Expression) -> Steps {
    let builder = Builder::new();
    let value = f(&builder.point());
    builder.finish(&value).unwrap()
}

/// A formula proven over a cube around the origin.
fn proven(half: f64, f: impl Fn(&Expression) -> Expression) -> Result<Formula, ProofError> {
    Formula::prove(steps(f), Aabb::centred([half; 3]), &Budget::default())
}

/// Xorshift.
struct Random(u64);

impl Random {
    /// Uniform in 0..1.
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in a cube around the origin.
    fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| reach * (2.0 * self.unit() - 1.0))
    }
}

fn compiled(formula: Formula) -> Program {
    Program::compile(
        &Field::formula(Arc::new(formula)).unwrap(),
        &Limits::default(),
    )
    .unwrap()
}

fn value(program: &Program, p: [f64; 3]) -> f64 {
    Point::<F64>::new(program.values())
        .value(v3(F64(p[0]), F64(p[1]), F64(p[2])))
        .0
}

fn gyroid(p: &Expression) -> Expression {
    let q = p * 4.0;
    q.sin().dot(q.cos().swizzle("yzx").unwrap())
}

fn bumpy(p: &Expression) -> Expression {
    p.length() - 1.0 + (p.x() * 10.0).sin() * (p.y() * 8.0).cos() * 0.1
}

fn heart(p: &Expression) -> Expression {
    let q = p.square();
    let body = q.x() + q.y() * 2.25 + q.z() - 1.0;
    body.powi(3) - (q.x() + q.y() * 0.1125) * p.z().powi(3)
}

fn blend(p: &Expression) -> Expression {
    let (a, b) = (p.length() - 0.7, (p - 0.6).length() - 0.4);
    let h = ((&b - &a) / 0.4 + 0.5).clamp(0.0, 1.0);
    b.mix(a, &h) - &h * (1.0 - &h) * 0.2
}

fn carved(p: &Expression) -> Expression {
    let q = p.abs() - 0.5;
    let cube = q.max(0.0).length() + q.greatest().min(0.0);
    cube.max(-(p.length() - 0.6)).min(p.y() + 0.7)
}

/// Formulas with the half side of their box; some end inside it, some are cut.
fn examples() -> Vec<(&'static str, Formula)> {
    type Example = (&'static str, f64, fn(&Expression) -> Expression);
    let list: [Example; 8] = [
        ("sphere", 1.2, |p| p.length() - 1.0),
        ("touching sphere", 1.0, |p| p.length() - 1.0),
        ("cut sphere", 0.8, |p| p.length() - 1.0),
        ("gyroid", 1.0, gyroid),
        ("bumpy", 1.5, bumpy),
        ("heart", 1.5, heart),
        ("blend", 1.5, blend),
        ("carved", 1.0, carved),
    ];
    list.map(|(name, half, f)| (name, proven(half, f).unwrap()))
        .into()
}

#[test]
fn compiled_formulas_have_slope_one_and_empty_balls_inside_and_outside_the_box() {
    let mut r = Random(0x5eed_0011);
    for (name, formula) in examples() {
        let (bounds, list) = (formula.bounds(), formula.clone());
        let program = compiled(formula);
        let mut point = Point::<F64>::new(program.values());
        let mut at = |p: [f64; 3]| point.value(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0;
        let solid = |p: [f64; 3]| {
            bounds.contains(p) && list.eval(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0 <= 0.0
        };
        let reach = 1.6 * bounds.max[0];
        for _ in 0..3000 {
            let p = r.point(reach);
            let f = at(p);
            assert!(f.is_finite(), "{name}: {f} at {p:?}");
            assert!(
                f.abs() < 1e-9 || (f < 0.0) == solid(p),
                "{name}: {f} at {p:?}"
            );
            for h in [1e-4, 1e-2, 0.3] {
                let step = r.point(h);
                let q = std::array::from_fn(|k| p[k] + step[k]);
                let way = step.iter().map(|x| x * x).sum::<f64>().sqrt();
                let slope = (at(q) - f).abs() / way;
                assert!(
                    slope <= 1.0 + 1e-6,
                    "{name}: slope {slope} from {p:?} to {q:?}"
                );
            }
            // the ball around p of radius |f| lies on one side
            for _ in 0..8 {
                let direction = r.point(1.0);
                let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
                let t = 0.999 * f.abs() * r.unit().cbrt() / length;
                let q = std::array::from_fn(|k| p[k] + t * direction[k]);
                assert_eq!(
                    solid(q),
                    f < 0.0,
                    "{name}: {q:?} in the ball of {f} around {p:?}"
                );
            }
        }
    }
}

#[test]
fn compiled_formulas_agree_over_number_types() {
    let mut r = Random(0x5eed_0012);
    for (name, formula) in examples() {
        let program = compiled(formula);
        let mut range = Point::<Interval>::new(program.values());
        for _ in 0..300 {
            let (c, half) = (r.point(1.5), 0.3 * r.unit());
            let [x, y, z] = c.map(|x| Interval::new(x - half, x + half));
            let over = range.value(v3(x, y, z));
            for _ in 0..10 {
                let inside = r.point(half);
                let f = value(&program, std::array::from_fn(|k| c[k] + inside[k]));
                assert!(
                    over.lo - 1e-9 <= f && f <= over.hi + 1e-9,
                    "{name}: {f} is not in {over:?}"
                );
            }
        }
        let points: Vec<[f64; 3]> = (0..BATCH)
            .map(|_| r.point(1.5).map(|x| f64::from(x as f32)))
            .collect();
        let mut w = Workspace::new(program.values(), program.marks());
        for (i, p) in points.iter().enumerate() {
            for k in 0..3 {
                w.points_mut()[k].0[i] = p[k] as f32;
            }
        }
        for level in [Level::new(), Level::baseline()] {
            zeroset_number::at_level!(level, s => zeroset_eval::values(s, program.values(), &mut w, BATCH));
            zeroset_number::at_level!(level, s => zeroset_eval::gradients(s, program.values(), &mut w, BATCH));
            for (i, p) in points.iter().enumerate() {
                let (f, v) = (value(&program, *p), f64::from(w.values().0[i]));
                assert!((v - f).abs() < 1e-5, "{name}: {v} for {f} at {p:?}");
                let g = w.gradients().map(|lane| f64::from(lane.0[i]));
                let length = g.iter().map(|x| x * x).sum::<f64>().sqrt();
                assert!(length < 1.0 + 1e-4, "{name}: {g:?} at {p:?}");
            }
        }
    }
}

/// A formula of one operation, on operands that suit it.
fn alone(step: FormulaStep) -> Formula {
    let list = vec![
        FormulaStep::Coordinate(0),
        FormulaStep::Coordinate(1),
        step,
        FormulaStep::Constant(0.3),
        FormulaStep::Binary(Binary::Mul, 2, 3),
    ];
    Formula::stated(
        Steps::new(list).unwrap(),
        Aabb::new([0.1; 3], [0.9; 3]),
        1.0,
    )
    .unwrap()
}

#[test]
fn every_operation_compiles_to_itself() {
    let unary = Unary::ALL.map(|f| FormulaStep::Unary(f, 0));
    // halves of choices have no value of their own: see `choices_noises_and_fields`
    let binary = (Binary::ALL.into_iter())
        .filter(|f| !matches!(f, Binary::When | Binary::Either))
        .map(|f| FormulaStep::Binary(f, 0, 1));
    let noise = NoiseKind::ALL.map(|kind| FormulaStep::Noise(kind, [0, 1, 0]));
    for step in unary.into_iter().chain(binary).chain(noise) {
        let formula = alone(step);
        let program = compiled(formula.clone());
        let mut r = Random(0x5eed_0013);
        for _ in 0..50 {
            // from the middle of the box, where its sides do not matter
            let p = r.point(0.05).map(|x| f64::from((x + 0.5) as f32));
            let [x, y, z] = p.map(F64);
            let plain = formula.eval(v3(x, y, z)).0.max(-0.35);
            let f = value(&program, p);
            assert!((f - plain).abs() < 1e-6, "{step:?}: {f} for {plain}");
            let mut w = Workspace::new(program.values(), program.marks());
            for k in 0..3 {
                w.points_mut()[k].0.fill(p[k] as f32);
            }
            zeroset_number::at_level!(Level::new(), s => zeroset_eval::values(s, program.values(), &mut w, 1));
            let single = f64::from(w.values().0[0]);
            assert!((single - f).abs() < 2e-6, "{step:?}: {single} for {f}");
        }
    }
}

#[test]
fn constants_do_not_change_the_program() {
    let make = |a: f64, b: f64| {
        compiled(proven(2.0, move |p| p.length() - a + (p.x() * b).sin() * 0.1).unwrap())
    };
    let (one, other) = (make(1.0, 0.0), make(0.5, 10.0));
    assert_eq!(one.structure(), other.structure());
    assert_ne!(one.params(), other.params());
}

#[test]
fn what_is_not_a_number_stays_in_its_place() {
    // poles, roots and logarithms of nothing, zero by zero
    let wild: [fn(&Expression) -> Expression; 7] = [
        |p| 1.0 / p.x() - 1.0,
        |p| p.x() / p.x() - p.y() / p.x(),
        |p| p.x().abs().ln() * p.y().abs().ln() + p.x().sqrt(),
        |p| p.x().abs().pow(p.y() * 100.0) - p.y().pow(-50.0),
        |p| p.x().modulo(p.y()),
        |p| (p.x() * 200.0).exp() - (p.y() * 200.0).exp(),
        |p| p.z().atan2(p.x()) / p.y() - p.normalize().x(),
    ];
    let list = [-1.0, -0.5, 0.0, 1e-30, 0.25, 1.0, 2.0];
    for (case, f) in wild.into_iter().enumerate() {
        let formula = Formula::stated(steps(f), Aabb::centred([1.0; 3]), 5.0).unwrap();
        let program = compiled(formula);
        let mut w = Workspace::new(program.values(), program.marks());
        for (i, point) in (0..BATCH).enumerate() {
            let index = [point % 7, point / 7 % 7, point / 49];
            for k in 0..3 {
                w.points_mut()[k].0[i] = list[index[k]];
            }
        }
        for level in [Level::new(), Level::baseline()] {
            zeroset_number::at_level!(level, s => zeroset_eval::values(s, program.values(), &mut w, BATCH));
            for i in 0..BATCH {
                let p = [0, 1, 2].map(|k| f64::from(w.points()[k].0[i]));
                let single = w.values().0[i];
                let exact = value(&program, p);
                assert!(
                    single.is_finite() && exact.is_finite(),
                    "{case}: {single}, {exact} at {p:?}"
                );
            }
        }
    }
}

/// A formula as the evaluators see it, single precision against double, over its box and around it.
#[track_caller]
fn agrees(name: &str, formula: &Formula) {
    let program = compiled(formula.clone());
    let mut w = Workspace::new(program.values(), program.marks());
    let mut r = Random(0x5eed_0021);
    let tolerance = 3e-6 * formula.slope();
    for _ in 0..200 {
        let p = r.point(1.9).map(|x| f64::from(x as f32));
        let [x, y, z] = p.map(F64);
        let inside =
            (0..3).all(|k| formula.bounds().min[k] <= p[k] && p[k] <= formula.bounds().max[k]);
        let f = value(&program, p);
        if inside {
            // the box cuts what reaches it: no less than minus the way to its side
            let depth = (0..3)
                .map(|k| (p[k] - formula.bounds().min[k]).min(formula.bounds().max[k] - p[k]))
                .fold(f64::INFINITY, f64::min);
            let plain = (formula.eval(v3(x, y, z)).0 / formula.slope()).max(-depth);
            assert!(
                (f - plain).abs() < tolerance + 1e-5,
                "{name}: {f} for {plain} at {p:?}"
            );
        }
        for k in 0..3 {
            w.points_mut()[k].0.fill(p[k] as f32);
        }
        zeroset_number::at_level!(Level::new(), s => zeroset_eval::values(s, program.values(), &mut w, 1));
        let single = f64::from(w.values().0[0]);
        assert!(
            (single - f).abs() < tolerance + 1e-5,
            "{name}: {single} for {f} at {p:?}"
        );
        let around = program_range(&program, p, 0.05);
        assert!(around.contains(f), "{name}: {around:?} for {f} at {p:?}");
    }
}

fn program_range(program: &Program, p: [f64; 3], half: f64) -> Interval {
    let side = |x: f64| Interval::new(x - half, x + half);
    Point::<Interval>::new(program.values()).value(v3(side(p[0]), side(p[1]), side(p[2])))
}

/// A formula of the point.
type Written = Box<dyn Fn(&Expression) -> Expression>;

#[test]
fn choices_noises_and_fields() {
    let all = zeroset_catalogue::entries::catalogue();
    let shape = |name: &str| {
        let entry = all.primitive(name).unwrap();
        Field::primitive(entry, entry.info.defaults()).unwrap()
    };
    let (ball, cube) = (shape("sphere"), shape("box"));
    let twisted = {
        let entry = all.map("twist").unwrap();
        cube.map(entry, vec![1.5]).unwrap()
    };
    let cases: Vec<(&str, Written)> = vec![
        (
            "a kink",
            Box::new(|p| p.x().less(p.y()).choose(p.x(), p.y()) - 0.3),
        ),
        (
            "half a ball, half a cylinder",
            Box::new(|p| {
                let d = p.swizzle("xz").unwrap().length();
                let high = 0.0.less_than(&p.y());
                high.choose(p.length() - 1.0, &d - 1.0)
            }),
        ),
        (
            "nested",
            Box::new(|p| {
                let inner = p.y().less(0.2).choose(p.y() * 2.0, p.y() + 0.2);
                p.x().less(0.0).choose(-p.x(), p.x()) + inner - 0.5
            }),
        ),
        (
            "noise",
            Box::new(|p| {
                p.builder().noise(NoiseKind::Gradient, &(p * 2.0)) * 0.2 + p.length() - 1.0
            }),
        ),
        ("layers", Box::new(|p| p.fbm(NoiseKind::Value, 3) + p.y())),
        (
            "cells",
            Box::new(|p| {
                p.builder()
                    .noise(NoiseKind::Cellular, &(p * 3.0 + p.x().sin()))
                    - 0.3
            }),
        ),
        ("a field", {
            let ball = ball.clone();
            Box::new(move |p| p.builder().field(&ball, &(p * 1.5)).abs() - 0.1)
        }),
        ("a field elsewhere", {
            let (cube, ball) = (cube.clone(), ball.clone());
            Box::new(move |p| {
                let q = p.rotate([0.0, 1.0, 0.0], p.y());
                p.builder()
                    .field(&cube, &q)
                    .max(-(p.builder().field(&ball, p) + 0.5))
            })
        }),
        (
            "a steep field",
            Box::new(move |p| p.builder().field(&twisted, p) + p.x() * 0.1),
        ),
    ];
    for (name, f) in &cases {
        let formula = proven(1.5, f).unwrap_or_else(|e| panic!("{name}: {e}"));
        let mut r = Random(0x5eed_0022);
        for _ in 0..2000 {
            let (p, q) = (r.point(1.5), r.point(1.5));
            let scale = 10_f64.powf(-4.0 * r.unit());
            let q: [f64; 3] = std::array::from_fn(|k| p[k] + scale * (q[k] - p[k]));
            let at = |[x, y, z]: [f64; 3]| formula.eval(v3(F64(x), F64(y), F64(z))).0;
            let way = (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
            let rise = (at(p) - at(q)).abs();
            assert!(
                rise <= formula.slope() * way * (1.0 + 1e-9) + 1e-6,
                "{name}: {rise} over {way}"
            );
        }
        agrees(name, &formula);
    }
    // what jumps is refused, wherever it does
    for (name, f) in [
        (
            "a step",
            &(|p: &Expression| p.x().less(0.3).choose(0.5, p.y()))
                as &dyn Fn(&Expression) -> Expression,
        ),
        ("a small step", &|p: &Expression| {
            p.x().less(0.3).choose(p.x(), p.x() + 1e-6)
        }),
        ("agreeing elsewhere", &|p: &Expression| {
            p.x().less(0.3).choose(p.y() * (p.x() - 0.4), 0.0)
        }),
        ("a condition as a number", &|p: &Expression| {
            p.x().less(0.3) + p.y()
        }),
    ] {
        assert!(
            matches!(proven(1.5, f), Err(ProofError::Unbounded(_))),
            "{name}"
        );
    }
}

/// `x < p`, for a number x.
trait LessThan {
    fn less_than(self, p: &Expression) -> Expression;
}

impl LessThan for f64 {
    fn less_than(self, p: &Expression) -> Expression {
        p.builder().constant(self).less(p)
    }
}
