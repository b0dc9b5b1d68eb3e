//! How far rays may go by the slopes of cells: what is called free keeps its sign.

use fearless_simd::{Level, dispatch};
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_cells::Cells;
use zeroset_eval::{BATCH, Point, Workspace};
use zeroset_field::field::Field;
use zeroset_field::formula::{Budget, Builder, Expression, Formula};
use zeroset_field::program::{Limits, Program};
use zeroset_number::{F64, v3};

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| reach * (2.0 * self.unit() - 1.0))
    }
}

fn program(half: f64, f: impl Fn(&Expression) -> Expression) -> Program {
    let builder = Builder::new();
    let value = f(&builder.point());
    let steps = builder.finish(&value).unwrap();
    let formula = Formula::new(steps, Aabb::centred([half; 3]), &Budget::default()).unwrap();
    Program::compile(
        &Field::formula(Arc::new(formula)).unwrap(),
        &Limits::default(),
    )
    .unwrap()
}

/// Taubin's heart (1994).
fn heart(p: &Expression) -> Expression {
    let q = p.square();
    let body = q.x() + q.y() * 2.25 + q.z() - 1.0;
    body.powi(3) - (q.x() + q.y() * 0.1125) * p.z().powi(3)
}

/// A sphere, as steep as a wave of high frequency over it.
fn bumpy(p: &Expression) -> Expression {
    (p.length() - 1.0 + (p.x() * 30.0).sin() * 0.02) * (p.y() * 4.0).exp()
}

/// How much farther it is free than the values say, in the mean, and the share of places of which anything is known.
fn check(program: &Program, half: f64) -> (f64, f64) {
    let cells = Cells::new(program, program.bounds()).expect("a steep program");
    assert!(cells.has_slopes());
    let mut exact = Point::<F64>::new(program.values());
    let mut value = |p: [f64; 3]| exact.value(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0;
    let mut w = Workspace::new(program.values(), program.marks());
    let mut r = Random(0x5eed_2001);
    let (mut wider, mut known) = (0.0, 0.0);
    for _ in 0..40 {
        let points: [[f32; 3]; BATCH] =
            std::array::from_fn(|_| r.point(1.2 * half).map(|x| x as f32));
        for (i, p) in points.iter().enumerate() {
            for (lane, x) in w.points_mut().iter_mut().zip(p) {
                lane.0[i] = *x;
            }
        }
        dispatch!(Level::new(), s => cells.values(s, &mut w, BATCH));
        let values = w.values().0;
        cells.widen(&mut w, BATCH);
        for (i, p) in points.iter().enumerate() {
            let (f, free) = (values[i], w.values().0[i]);
            let is_known = !program.is_unbounded() || free != 0.0;
            assert!(program.is_unbounded() || free.abs() >= f.abs());
            assert!(f == 0.0 || free.signum() == f.signum());
            known += f64::from(u8::from(is_known)) / (40 * BATCH) as f64;
            wider += f64::from(free / f).min(1000.0) / (40 * BATCH) as f64;
            for k in 0..12 {
                let to = r.point(1.0);
                let length = to.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-9);
                let by = f64::from(free.abs()) * if k % 2 == 0 { 1.0 } else { r.unit() };
                let q: [f64; 3] = std::array::from_fn(|k| f64::from(p[k]) + by * to[k] / length);
                let there = value(q) * f64::from(f.signum());
                assert!(
                    there > -1e-9,
                    "{there} at {q:?}, {by} from {p:?} where it is {f}"
                );
            }
        }
    }
    (wider, known)
}

#[test]
fn a_heart_is_free_as_far_as_it_is_flat() {
    let program = program(1.6, heart);
    assert!(program.slope() > 300.0, "{}", program.slope());
    let (wider, _) = check(&program, 1.6);
    assert!(wider > 20.0, "{wider} times the value in the mean");
}

#[test]
fn a_formula_that_grows_steeper_upwards() {
    let program = program(1.4, bumpy);
    let (wider, _) = check(&program, 1.4);
    assert!(wider > 5.0, "{wider} times the value in the mean");
}

#[test]
fn what_has_no_slope_is_free_where_its_sign_is_known() {
    let formulas: [fn(&Expression) -> Expression; 4] = [
        |p| {
            let q = p.abs().sqrt();
            q.x() + q.y() + q.z() - 1.5
        },
        |p| p.y() - p.x() * 0.3 / (p.z() + 0.1),
        |p| p.y() - ((p.x() + p.z()) * 2.0).floor() * 0.25,
        |p| p.x().powi(40) + p.y().powi(40) + p.z().powi(40) - 1.0,
    ];
    for formula in formulas {
        let program = program(1.6, formula);
        assert!(program.is_unbounded());
        let (_, known) = check(&program, 1.6);
        assert!(known > 0.5, "{known} of all places");
    }
}

#[test]
fn slopes_are_the_same_whichever_cells_were_made_first() {
    let program = program(1.6, heart);
    let mut r = Random(0x5eed_2002);
    let points: [[f32; 3]; BATCH] = std::array::from_fn(|_| r.point(1.6).map(|x| x as f32));
    let answer = |order: &[usize]| {
        let cells = Cells::new(&program, program.bounds()).expect("a steep program");
        let mut found = [0.0_f32; BATCH];
        for part in order.chunks(7) {
            let mut w = Workspace::new(program.values(), program.marks());
            for (i, &at) in part.iter().enumerate() {
                for (lane, x) in w.points_mut().iter_mut().zip(points[at]) {
                    lane.0[i] = x;
                }
            }
            dispatch!(Level::new(), s => cells.values(s, &mut w, part.len()));
            cells.widen(&mut w, part.len());
            for (i, &at) in part.iter().enumerate() {
                found[at] = w.values().0[i];
            }
        }
        found.map(f32::to_bits)
    };
    let forwards: Vec<usize> = (0..BATCH).collect();
    let backwards: Vec<usize> = (0..BATCH).rev().collect();
    assert_eq!(answer(&forwards), answer(&backwards));
}
