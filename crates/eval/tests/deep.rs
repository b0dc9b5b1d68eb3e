//! Trees and formulas as deep and as long as they may be, on threads whose stack is small.

use std::sync::Arc;
use std::time::Instant;
use zeroset_catalogue::bounds::Aabb;
use zeroset_catalogue::entries::catalogue;
use zeroset_eval::Point;
use zeroset_field::field::{Field, FieldError, MAX_DEPTH, Paint};
use zeroset_field::formula::{Budget, Builder, Formula, FormulaStep, MAX_STEPS, Steps, Unary};
use zeroset_field::placement::Placement;
use zeroset_field::program::{Limits, Program};
use zeroset_field::repetition::{Polar, Repetition};
use zeroset_number::{F64, v3};

/// Half of what a thread has unless it asks for more.
const SMALL: usize = 1 << 20;

fn on_small_stack(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(SMALL).spawn(work);
    thread.unwrap().join().unwrap();
}

type Deepen = fn(&Field) -> Result<Field, FieldError>;

fn ball() -> Field {
    let sphere = catalogue().primitive("sphere").unwrap();
    Field::primitive(sphere, sphere.info.defaults()).unwrap()
}

/// Every kind of node over a field.
const FORMS: &[(&str, Deepen)] = &[
    ("smooth_union", |f| {
        let join = catalogue().join("smooth_union").unwrap();
        Field::join(join, join.info.defaults(), vec![f.clone(), ball()])
    }),
    ("subtraction", |f| {
        let join = catalogue().join("subtraction").unwrap();
        Field::join(join, Vec::new(), vec![ball(), f.clone()])
    }),
    ("round", |f| {
        f.modify(catalogue().modifier("round").unwrap(), vec![1e-4])
    }),
    ("stretch", |f| {
        f.map(catalogue().map("stretch").unwrap(), vec![1.0, 1.0001, 1.0])
    }),
    ("twist", |f| {
        f.map(catalogue().map("twist").unwrap(), vec![1e-6])
    }),
    ("paint", |f| f.paint(Paint::Material(1))),
    ("repeat", |f| {
        f.repeat(Repetition {
            spacing: [1e6, 0.0, 0.0],
            count: [1, 1, 1],
            vary: [0.0; 3],
            seed: 0,
        })
    }),
    ("polar", |f| f.polar(Polar { count: 1 })),
    ("place", |f| {
        // moves that follow each other become one, so something lies between
        f.paint(Paint::Object(1))?
            .place(Placement::moved([1e-6, 0.0, 0.0]))
    }),
];

#[test]
fn trees() {
    on_small_stack(|| {
        for (name, deepen) in FORMS {
            let mut field = ball();
            let refused = loop {
                match deepen(&field) {
                    Ok(deeper) => field = deeper,
                    Err(error) => break error,
                }
            };
            // some refuse for another reason before: then they cannot be deep
            if refused == FieldError::Deep {
                assert!(field.facts().depth + 1 >= MAX_DEPTH, "{name}");
            }
            let program = Program::compile(&field, &Limits::default());
            if let Ok(program) = program {
                let value =
                    Point::<F64>::new(program.values()).value(v3(F64(9.0), F64(0.0), F64(0.0)));
                assert!(value.0.is_finite(), "{name}: {value:?}");
            }
            drop(field);
        }
    });
}

/// Formulas of so many steps, each of a form that a pass over them could take to be nested.
fn long(n: usize) -> Vec<(&'static str, Steps)> {
    let steps = |name: &'static str,
                 make: &dyn Fn(&Builder) -> zeroset_field::formula::Expression| {
        let builder = Builder::new();
        let value = make(&builder);
        (name, builder.finish(&value).unwrap())
    };
    vec![
        steps("sum of squares under a root", &|b| {
            let p = b.point();
            let sum = (0..n / 4).fold(p.x().square(), |sum, i| {
                sum + (p.y() - i as f64 / n as f64).square()
            });
            sum.sqrt() / (n as f64).sqrt() - 0.1
        }),
        steps("box distance of many faces", &|b| {
            let p = b.point();
            let faces = |i: usize| p.x() * (i as f64 / n as f64) + p.y();
            let greatest = (0..n / 8).fold(p.z(), |m, i| m.max(faces(i)));
            let outside = (0..n / 8).fold(p.z().max(0.0), |l, i| l.hypot(faces(i).max(0.0)));
            outside / (n as f64).sqrt() + greatest.min(0.0)
        }),
        steps("negations", &|b| {
            let mut x = b.point().x();
            for i in 0..n / 3 {
                x = x + b.point().y() * (1.0 / (1.0 + i as f64));
            }
            x * 0.01
        }),
        steps("a chain of sines", &|b| {
            (0..n - 8).fold(b.point().x(), |x, _| x.sin())
        }),
        steps("a tree of minima", &|b| {
            let p = b.point();
            (0..n / 4).fold(p.length(), |m, i| m.min(&(p.x() - i as f64)))
        }),
    ]
}

#[test]
fn long_formulas() {
    on_small_stack(|| {
        for (name, steps) in long(20_000) {
            let start = Instant::now();
            let bounds = Aabb::centred([2.0; 3]);
            let formula = Formula::prove(steps.clone(), bounds, &Budget::default())
                .or_else(|_| Formula::stated(steps, bounds, 100.0))
                .unwrap();
            let field = Field::formula(Arc::new(formula)).unwrap();
            let program = Program::compile(&field, &Limits::default()).unwrap();
            let value = Point::<F64>::new(program.values()).value(v3(F64(0.3), F64(0.4), F64(0.1)));
            assert!(value.0.is_finite(), "{name}");
            // hundreds of times less than a quadratic pass would take
            assert!(
                start.elapsed().as_secs_f64() < 20.0,
                "{name}: {:?}",
                start.elapsed()
            );
        }
    });
}

#[test]
fn the_longest_formula() {
    let mut steps = vec![FormulaStep::Coordinate(0), FormulaStep::Coordinate(1)];
    while steps.len() < MAX_STEPS - 1 {
        steps.push(FormulaStep::Unary(Unary::Sin, steps.len() as u32 - 1));
    }
    let steps = Steps::new(steps).unwrap();
    let formula = Formula::prove(steps, Aabb::centred([1.0; 3]), &Budget::default()).unwrap();
    let program = Program::compile(
        &Field::formula(Arc::new(formula)).unwrap(),
        &Limits::default(),
    )
    .unwrap();
    let value = Point::<F64>::new(program.values()).value(v3(F64(0.3), F64(0.4), F64(0.1)));
    assert!(value.0.abs() < 0.01, "{value:?}");
}
