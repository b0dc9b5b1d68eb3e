//! Programs: what the compiler makes of a tree is the tree.

use fearless_simd::{Level, Simd, dispatch};
use std::f64::consts::TAU;
use zeroset_catalogue::Dimension;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::tape::Operation;
use zeroset_eval::{BATCH, Point, Workspace};
use zeroset_field::field::{Field, Paint};
use zeroset_field::placement::Placement;
use zeroset_field::program::{CompileError, Limits, Program};
use zeroset_field::repetition::{Polar, Repetition};
use zeroset_number::{F64, v3};

struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }
    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
    fn point(&mut self, reach: f64) -> [f64; 3] {
        std::array::from_fn(|_| self.within(-reach, reach))
    }
}

fn primitive(name: &str, params: &[f64]) -> Field {
    Field::primitive(catalogue().primitive(name).unwrap(), params.to_vec()).unwrap()
}

fn join(name: &str, params: &[f64], shapes: &[Field]) -> Field {
    Field::join(
        catalogue().join(name).unwrap(),
        params.to_vec(),
        shapes.to_vec(),
    )
    .unwrap()
}

fn moved(field: &Field, x: f64, y: f64, z: f64) -> Field {
    field.place(Placement::moved([x, y, z])).unwrap()
}

fn compiled(field: &Field) -> Program {
    Program::compile(field, &Limits::default()).unwrap()
}

fn value(program: &Program, p: [f64; 3]) -> f64 {
    Point::<F64>::new(program.values())
        .value(v3(F64(p[0]), F64(p[1]), F64(p[2])))
        .0
}

fn levels() -> Vec<Level> {
    let native = Level::new();
    let mut levels = vec![native, Level::baseline()];
    #[cfg(target_arch = "x86_64")]
    {
        levels.extend(native.as_avx2().map(|token| token.level()));
        levels.extend(native.as_sse4_2().map(|token| token.level()));
    }
    levels
}

fn batch(program: &Program, level: Level, points: &[[f64; 3]]) -> (Vec<f32>, Vec<[f32; 3]>) {
    let mut w = Workspace::new(program.values(), program.marks());
    assert!(points.len() <= BATCH);
    for (i, p) in points.iter().enumerate() {
        for (lane, x) in w.points_mut().iter_mut().zip(p) {
            lane.0[i] = *x as f32;
        }
    }
    let n = points.len();
    dispatch!(level, s => zeroset_eval::values(s, program.values(), &mut w, n));
    let values = w.values().0[..n].to_vec();
    dispatch!(level, s => zeroset_eval::gradients(s, program.values(), &mut w, n));
    let g = w.gradients();
    (
        values,
        (0..n).map(|i| [g[0].0[i], g[1].0[i], g[2].0[i]]).collect(),
    )
}

/// A random solid of the catalogue's proven entries.
fn random_field(r: &mut Random, depth: u32) -> Field {
    let all = catalogue();
    loop {
        if depth == 0 || r.unit() < 0.2 {
            let solids: Vec<_> = (all.primitives.iter())
                .filter(|e| {
                    e.info.dimension == Dimension::Three && e.exactness < Exactness::Estimate
                })
                .collect();
            let entry = solids[r.below(solids.len())];
            return Field::primitive(entry, entry.info.defaults()).unwrap();
        }
        let shape = random_field(r, depth - 1);
        let made = match r.below(7) {
            0 => {
                let e = &all.maps[r.below(all.maps.len())];
                shape.map(e, e.info.defaults()).ok()
            }
            1 => {
                let e = &all.modifiers[r.below(all.modifiers.len())];
                shape.modify(e, e.info.defaults()).ok()
            }
            2 | 3 => {
                let e = &all.joins[r.below(all.joins.len())];
                let other = random_field(r, depth - 1)
                    .place(Placement::moved(r.point(1.0)))
                    .unwrap();
                Field::join(e, e.info.defaults(), vec![shape, other]).ok()
            }
            4 => shape
                .place(Placement::turned(r.point(1.0), r.within(-3.0, 3.0)))
                .ok(),
            5 => shape.place(Placement::scaled(r.within(0.3, 2.0))).ok(),
            _ => {
                let c = r.within(2.5, 6.0);
                let vary = [0.0, r.within(0.0, 1.0), 0.0];
                shape
                    .repeat(Repetition {
                        spacing: [c, 0.0, c],
                        count: [3, 0, 0],
                        vary,
                        seed: 1,
                    })
                    .ok()
            }
        };
        if let Some(field) =
            made.filter(|f| f.facts().dimension == Dimension::Three && !f.facts().bounds.is_empty())
        {
            return field;
        }
    }
}

#[test]
fn random_trees_are_bounds_of_slope_one_and_agree_over_number_types() {
    let mut r = Random(0x5eed_0001);
    for case in 0..150 {
        let field = random_field(&mut r, 3);
        let program = compiled(&field);
        let bounds = program.bounds();
        let points: Vec<[f64; 3]> = (0..BATCH)
            .map(|_| r.point(3.0).map(|x| f64::from(x as f32)))
            .collect();
        let mut point = Point::<F64>::new(program.values());
        let mut at = |p: [f64; 3]| point.value(v3(F64(p[0]), F64(p[1]), F64(p[2]))).0;
        for p in &points {
            let f = at(*p);
            assert!(f.is_finite(), "case {case}: {f} at {p:?} of {field:?}");
            if f < -1e-9 {
                assert!(
                    bounds.grow(1e-6).contains(*p),
                    "case {case}: {p:?} is inside but not in {bounds:?} of {field:?}"
                );
            }
            for h in [1e-3, 1e-1] {
                let step = r.point(h);
                let q = [p[0] + step[0], p[1] + step[1], p[2] + step[2]];
                let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
                let slope = (at(q) - f).abs() / length;
                assert!(
                    slope <= 1.0 + 1e-6,
                    "case {case}: slope {slope} from {p:?} to {q:?} of {field:?}"
                );
            }
        }
        for level in levels() {
            let (values, gradients) = batch(&program, level, &points);
            for (i, p) in points.iter().enumerate() {
                let f = at(*p);
                let error = (f64::from(values[i]) - f).abs();
                assert!(
                    error < 2e-4 * (1.0 + f.abs()),
                    "case {case}: {} for {f} at {p:?} of {field:?}",
                    values[i]
                );
                let length = gradients[i].iter().map(|x| x * x).sum::<f32>().sqrt();
                assert!(
                    length < 1.01,
                    "case {case}: gradient {:?} at {p:?} of {field:?}",
                    gradients[i]
                );
            }
        }
    }
}

#[test]
fn numbers_change_parameters_and_not_the_structure() {
    let make = |x: f64, r: f64, angle: f64, k: f64| {
        let ball = moved(&primitive("sphere", &[r]), x, 0.0, 0.0);
        let turned = primitive("box", &[1.0, 1.0, 1.0])
            .place(Placement::turned([0.0, 1.0, 0.0], angle))
            .unwrap();
        compiled(&join("smooth_union", &[k], &[ball, turned]))
    };
    let (a, b) = (make(0.0, 1.0, 0.0, 0.1), make(1.0, 2.0, 1.0, 0.5));
    assert_eq!(a.structure(), b.structure());
    assert_ne!(a.params(), b.params());
}

#[test]
fn shared_nodes_are_evaluated_once() {
    let ball = primitive("sphere", &[1.0]);
    let shell = ball
        .modify(catalogue().modifier("onion").unwrap(), vec![0.1])
        .unwrap();
    let once = compiled(&join("union", &[], &[ball.clone(), shell.clone()]));
    let apart = compiled(&join("union", &[], &[primitive("sphere", &[1.0]), shell]));
    assert_eq!(
        once.structure().values.instructions.len() + 1,
        apart.structure().values.instructions.len()
    );
}

#[test]
fn a_move_costs_no_instruction() {
    let ball = moved(
        &moved(&primitive("sphere", &[1.0]), 1.0, 2.0, 3.0),
        1.0,
        0.0,
        0.0,
    );
    let program = compiled(&ball);
    assert_eq!(program.structure().values.instructions.len(), 1);
    assert!((value(&program, [2.0, 2.0, 5.0]) - 1.0).abs() < 1e-12);
}

#[test]
fn registers_are_reused() {
    let balls: Vec<Field> = (0..100)
        .map(|i| moved(&primitive("sphere", &[0.4]), f64::from(i), 0.0, 0.0))
        .collect();
    let code = &compiled(&join("union", &[], &balls))
        .structure()
        .values
        .clone();
    assert_eq!(code.instructions.len(), 199);
    // the point, and a value for each level of a balanced tree
    assert!(code.registers <= 3 + 8, "{} registers", code.registers);
}

/// The deepest chain of joins from the result down.
fn depth_of_joins(program: &Program) -> usize {
    let code = &program.structure().values;
    let mut depth = vec![0; usize::from(code.registers)];
    for i in &code.instructions {
        let of = |r: u16| depth[usize::from(r)];
        depth[usize::from(i.out)] = match i.operation {
            Operation::Pair(_) => of(i.a).max(of(i.b)) + 1,
            Operation::Change(_) => of(i.a),
            _ => 0,
        };
    }
    depth[usize::from(code.result)]
}

#[test]
fn sharp_unions_are_as_low_as_can_be() {
    for (count, low) in [(1, 0), (2, 1), (3, 2), (8, 3), (100, 7), (1000, 10)] {
        let balls: Vec<Field> = (0..count)
            .map(|i| moved(&primitive("sphere", &[0.4]), f64::from(i), 0.0, 0.0))
            .collect();
        for name in ["union", "intersection"] {
            let depth = depth_of_joins(&compiled(&join(name, &[], &balls)));
            assert_eq!(depth, low, "{name} of {count}");
        }
    }
    // what has an order keeps it
    let balls = vec![primitive("sphere", &[1.0]); 5];
    assert_eq!(
        depth_of_joins(&compiled(&join("subtraction", &[], &balls))),
        4
    );
}

/// All copies as one union: what a repetition must not overestimate, and equal near them.
fn copies(shape: &Field, placements: Vec<Placement>) -> Program {
    let shapes: Vec<Field> = placements
        .iter()
        .map(|p| shape.place(*p).unwrap())
        .collect();
    compiled(&join("union", &[], &shapes))
}

#[test]
fn repetitions_never_overestimate_and_are_true_near_the_shapes() {
    let mut r = Random(0x5eed_0002);
    let shape = moved(&primitive("box", &[0.6, 1.0, 1.1]), 0.2, 0.3, -0.1);
    for count in [2, 3, 6, 7] {
        let repetition = Repetition {
            spacing: [1.0, 0.0, 1.5],
            count: [count, 0, 3],
            vary: [0.0; 3],
            seed: 0,
        };
        let repeated = compiled(&shape.repeat(repetition).unwrap());
        let first = -0.5 * f64::from(count - 1);
        let cells = (0..count).flat_map(|i| (0..3).map(move |k| (i, k)));
        let offsets = cells.map(|(i, k)| [first + f64::from(i), 0.0, 1.5 * (f64::from(k) - 1.0)]);
        let union = copies(&shape, offsets.map(Placement::moved).collect());
        for _ in 0..4000 {
            let p = r.point(5.0);
            let (f, truth) = (value(&repeated, p), value(&union, p));
            assert!(f <= truth + 1e-6, "{f} for {truth} at {p:?}");
            assert!(
                (f - truth).abs() < 1e-6 || f > 0.35 || truth < 0.0,
                "{f} for {truth} at {p:?}"
            );
            assert_eq!(f < 0.0, truth < 0.0, "{f} for {truth} at {p:?}");
        }
    }
}

#[test]
fn polar_copies_never_overestimate() {
    let mut r = Random(0x5eed_0003);
    let shape = moved(&primitive("box", &[0.5, 0.4, 0.5]), 2.0, 0.1, 0.1);
    for count in [1, 2, 3, 5, 12, 20] {
        let polar = compiled(&shape.polar(Polar { count }).unwrap());
        let turn =
            |i: u32| Placement::turned([0.0, 1.0, 0.0], -f64::from(i) * TAU / f64::from(count));
        let union = copies(&shape, (0..count).map(turn).collect());
        for _ in 0..4000 {
            let p = r.point(3.5);
            let (f, truth) = (value(&polar, p), value(&union, p));
            assert!(f <= truth + 1e-6, "{count}: {f} for {truth} at {p:?}");
            assert!(
                f >= truth - 1e-6 || f > 0.05,
                "{count}: {f} for {truth} at {p:?}"
            );
        }
    }
}

#[test]
fn varied_copies_have_slope_one_and_stay_in_their_box() {
    let mut r = Random(0x5eed_0004);
    let shape = primitive("box", &[0.7, 2.0, 0.7]);
    let vary = [0.1, 1.0, 0.1];
    let field = shape
        .repeat(Repetition {
            spacing: [1.0, 0.0, 1.0],
            count: [5, 0, 0],
            vary,
            seed: 7,
        })
        .unwrap();
    assert_eq!(field.facts().bounds.max[1], 2.0);
    let program = compiled(&field);
    let mut heights = std::collections::BTreeSet::new();
    for _ in 0..20_000 {
        let p = r.point(3.0);
        let step = r.point(0.05);
        let q = [p[0] + step[0], p[1] + step[1], p[2] + step[2]];
        let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!(
            (value(&program, p) - value(&program, q)).abs() <= length * (1.0 + 1e-6),
            "{p:?} {q:?}"
        );
        if value(&program, p) < 0.0 {
            assert!(field.facts().bounds.contains(p));
            heights.insert((p[1] * 10.0) as i64);
        }
    }
    assert!(heights.len() > 20, "copies reach different heights");
}

#[test]
fn marks_follow_the_winning_side_and_blend_in_smooth_joins() {
    let red = moved(&primitive("sphere", &[1.0]), -1.0, 0.0, 0.0)
        .paint(Paint::Material(3))
        .unwrap();
    let blue = moved(&primitive("sphere", &[1.0]), 1.0, 0.0, 0.0)
        .paint(Paint::Material(5))
        .unwrap();
    let plain = moved(&primitive("sphere", &[0.5]), 0.0, 5.0, 0.0);
    let blend = join("smooth_union", &[0.5], &[red, blue, plain])
        .paint(Paint::Material(9))
        .unwrap();
    let floor = moved(&primitive("plane", &[]), 0.0, -3.0, 0.0);
    let object = |f: &Field, i| f.paint(Paint::Object(i)).unwrap();
    let program = compiled(&join("union", &[], &[object(&blend, 0), object(&floor, 1)]));
    let mut w = Workspace::new(program.values(), program.marks());
    let points = [
        [-2.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 0.3, 0.0],
        [0.0, 5.5, 0.0],
        [0.0, -3.0, 0.0],
    ];
    for (i, p) in points.iter().enumerate() {
        for (lane, x) in w.points_mut().iter_mut().zip(p) {
            lane.0[i] = *x;
        }
    }
    for level in levels() {
        dispatch!(level, s => zeroset_eval::marks(s, program.marks(), &mut w, points.len()));
        let m = w.marks();
        assert_eq!(m.object.0[..5], [0.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!(
            (m.first.0[0], m.first.0[1], m.first.0[3], m.first.0[4]),
            (3.0, 5.0, 9.0, -1.0)
        );
        assert_eq!(m.share.0[0], 0.0);
        assert!(
            (m.share.0[2] - 0.5).abs() < 1e-4,
            "half and half in the middle: {}",
            m.share.0[2]
        );
        assert_eq!(m.first.0[2] + m.second.0[2], 8.0);
    }
}

#[test]
fn limits_and_flat_fields_are_refused() {
    let mut field = primitive("sphere", &[1.0]);
    for i in 0..40 {
        field = join(
            "union",
            &[],
            &[field.clone(), moved(&field, f64::from(i) + 1.0, 0.0, 0.0)],
        );
    }
    let limits = Limits {
        instructions: 1000,
        ..Limits::default()
    };
    assert_eq!(
        Program::compile(&field, &limits).unwrap_err(),
        CompileError::Instructions { limit: 1000 }
    );
}

#[test]
fn boxes_of_placed_fields_hold_them() {
    let field = primitive("box", &[1.0, 2.0, 3.0])
        .place(Placement::euler([0.3, 0.5, 0.7]))
        .unwrap();
    let bounds = field.facts().bounds;
    let program = compiled(&field);
    let mut r = Random(0x5eed_0005);
    for _ in 0..10_000 {
        let p = r.point(3.0);
        assert!(value(&program, p) > 0.0 || bounds.contains(p));
    }
    assert!(
        Aabb::centred([2.0; 3]).intersect(&bounds) == bounds,
        "{bounds:?} is tight"
    );
}

/// Bounds that are less than the distance to their box: they must not jump where a copy enters the search.
#[test]
fn copies_of_bounds_do_not_jump() {
    let mut r = Random(0x5eed_0009);
    for name in ["sierpinski", "quadric", "box"] {
        let leaning = primitive(name, &catalogue().primitive(name).unwrap().info.defaults())
            .map(catalogue().map("shear").unwrap(), vec![0.5, 0.0])
            .unwrap();
        let grid = leaning.repeat(Repetition {
            spacing: [3.3, 0.0, 3.3],
            count: [3, 0, 0],
            vary: [0.0, 0.9, 0.0],
            seed: 1,
        });
        let ring = moved(&leaning, 8.0, 0.0, 0.0).polar(Polar { count: 12 });
        for field in [grid.unwrap(), ring.unwrap()] {
            let program = compiled(&field);
            for _ in 0..20_000 {
                let (p, step) = (r.point(10.0), r.point(1e-2));
                let q: [f64; 3] = std::array::from_fn(|k| p[k] + step[k]);
                let length = step.iter().map(|x| x * x).sum::<f64>().sqrt();
                let slope = (value(&program, p) - value(&program, q)).abs() / length;
                assert!(slope <= 1.0 + 1e-6, "{name}: slope {slope} at {p:?}");
            }
        }
    }
}

#[test]
fn boxes_hold_what_grows_from_bounds() {
    let all = catalogue();
    let map = |field: &Field, name: &str, params: &[f64]| {
        field.map(all.map(name).unwrap(), params.to_vec()).unwrap()
    };
    let grow = |field: &Field, by: f64| {
        let round = all.modifier("round").unwrap();
        field.modify(round, vec![by]).unwrap()
    };
    let stretched = map(&primitive("sphere", &[1.0]), "stretch", &[3.0, 1.0, 1.0]);
    let twisted = map(&primitive("box", &[1.0, 2.0, 0.4]), "twist", &[1.0]);
    let both = join(
        "smooth_union",
        &[0.8],
        &[stretched.clone(), twisted.clone(), stretched.clone()],
    );
    let mut r = Random(0x5eed_0006);
    for field in [
        grow(&stretched, 0.5),
        grow(&twisted, 0.3),
        both.clone(),
        grow(&both, 0.4),
    ] {
        let program = compiled(&field);
        let bounds = program.bounds().grow(1e-6);
        for _ in 0..20_000 {
            let p = r.point(6.0);
            assert!(
                value(&program, p) > 0.0 || bounds.contains(p),
                "{p:?} is not in {bounds:?}"
            );
        }
    }
    assert!(grow(&stretched, 0.5).facts().bounds.max[0] < 4.6);
}

#[test]
fn a_chain_of_moves_and_roundings_takes_two_points() {
    let round = catalogue().modifier("round").unwrap();
    let mut chain = primitive("sphere", &[0.5]);
    for _ in 0..100 {
        chain = chain.modify(round, vec![0.001]).unwrap();
        chain = moved(&chain, 0.001, 0.0, 0.0);
    }
    let program = compiled(&chain);
    // the point that is asked for, two in turns, and a value or two
    assert!(program.structure().values.registers <= 3 * 3 + 2);
    assert!((value(&program, [2.1, 0.0, 0.0]) - 1.4).abs() < 1e-4);
}
