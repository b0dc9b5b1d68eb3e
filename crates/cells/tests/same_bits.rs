//! What is left of a program in a box gives the same bits there: values, gradients and marks.

use fearless_simd::{Level, dispatch};
use proptest::prelude::*;
use std::sync::Arc;
use zeroset_catalogue::Dimension;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::tape::{Code, Tape};
use zeroset_cells::Cells;
use zeroset_eval::{BATCH, Pruner, Workspace};
use zeroset_field::field::{Field, Paint};
use zeroset_field::formula::{Binary, Budget, Formula, FormulaStep, Steps, Unary};
use zeroset_field::placement::Placement;
use zeroset_field::program::{Limits, Program};
use zeroset_field::repetition::{Polar, Repetition};
use zeroset_language::load::{Options, load};
use zeroset_number::{SingleInterval, v3};
use zeroset_testkit::scenes;

/// Xorshift.
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

/// A box in single precision.
#[derive(Clone, Copy, Debug)]
struct Box3 {
    min: [f32; 3],
    max: [f32; 3],
}

impl Box3 {
    fn random(r: &mut Random, reach: f64) -> Box3 {
        let size = reach * 10_f64.powf(r.within(-3.0, 0.0));
        let centre = r.point(reach);
        let half: [f64; 3] = std::array::from_fn(|_| size * r.within(0.2, 1.0));
        Box3 {
            min: std::array::from_fn(|k| (centre[k] - half[k]) as f32),
            max: std::array::from_fn(|k| (centre[k] + half[k]) as f32),
        }
    }

    fn part(&self, r: &mut Random) -> Box3 {
        let mut part = *self;
        for k in 0..3 {
            let middle = 0.5 * (self.min[k] + self.max[k]);
            if r.unit() < 0.5 {
                part.min[k] = middle;
            } else {
                part.max[k] = middle;
            }
        }
        part
    }

    fn interval(&self) -> zeroset_number::Vec3<SingleInterval> {
        let side = |k: usize| SingleInterval::new(self.min[k].into(), self.max[k].into());
        v3(side(0), side(1), side(2))
    }

    /// Points of it, some of them on its sides.
    fn points(&self, r: &mut Random) -> [[f32; 3]; BATCH] {
        std::array::from_fn(|_| {
            std::array::from_fn(|k| {
                let t = r.within(-0.1, 1.1).clamp(0.0, 1.0) as f32;
                (self.min[k] + t * (self.max[k] - self.min[k])).clamp(self.min[k], self.max[k])
            })
        })
    }
}

fn fill(w: &mut Workspace, points: &[[f32; 3]]) {
    for (i, p) in points.iter().enumerate() {
        for (lane, x) in w.points_mut().iter_mut().zip(p) {
            lane.0[i] = *x;
        }
    }
}

/// All that is found at a point, as bits; a zero in a gradient has no sign.
type Found = ([u32; 4], [u32; 8]);

fn found(w: &Workspace, values: &[f32], i: usize) -> Found {
    let m = w.marks();
    let (_, gradient) = w.gradient(i);
    // where there is none, whichever way that came about
    let bits = |x: f32| if x.is_nan() { f32::NAN } else { x + 0.0 }.to_bits();
    let [x, y, z] = gradient.map(bits);
    let marks = [
        m.object.0[i],
        m.first.0[i],
        m.second.0[i],
        m.share.0[i],
        m.orbit[0].0[i],
        m.orbit[1].0[i],
        m.orbit[2].0[i],
        m.orbit[3].0[i],
    ];
    ([values[i].to_bits(), x, y, z], marks.map(f32::to_bits))
}

fn with_tapes(level: Level, values: Tape<'_>, marks: Tape<'_>, points: &[[f32; 3]]) -> Vec<Found> {
    let mut w = Workspace::new(values, marks);
    let n = points.len();
    fill(&mut w, points);
    dispatch!(level, s => zeroset_eval::values(s, values, &mut w, n));
    let found_values = w.values().0;
    dispatch!(level, s => zeroset_eval::gradients(s, values, &mut w, n));
    dispatch!(level, s => zeroset_eval::marks(s, marks, &mut w, n));
    (0..n).map(|i| found(&w, &found_values, i)).collect()
}

fn with_cells(level: Level, cells: &Cells, program: &Program, points: &[[f32; 3]]) -> Vec<Found> {
    let mut w = Workspace::new(program.values(), program.marks());
    let n = points.len();
    fill(&mut w, points);
    dispatch!(level, s => cells.values(s, &mut w, n));
    let found_values = w.values().0;
    dispatch!(level, s => cells.gradients(s, &mut w, n));
    dispatch!(level, s => cells.marks(s, &mut w, n));
    for (k, lane) in w.points().iter().enumerate() {
        assert!((0..n).all(|i| lane.0[i] == points[i][k]), "points move");
    }
    (0..n).map(|i| found(&w, &found_values, i)).collect()
}

fn differing(whole: &[Found], less: &[Found], points: &[[f32; 3]]) -> Option<String> {
    let at = (0..points.len()).find(|&i| whole[i] != less[i])?;
    let show = |f: &Found| (f.0.map(f32::from_bits), f.1.map(f32::from_bits));
    let (a, b) = (show(&whole[at]), show(&less[at]));
    Some(format!("{a:?} becomes {b:?} at {:?}", points[at]))
}

/// Instructions before and after.
#[derive(Default)]
struct Saved {
    before: usize,
    after: usize,
}

/// Prunes the program in random boxes, and in their parts, and compares.
fn check_boxes(name: &str, program: &Program, reach: f64, boxes: usize, r: &mut Random) -> Saved {
    let mut saved = Saved::default();
    let mut pruner = Pruner::new();
    for case in 0..boxes {
        let mut within = Box3::random(r, reach);
        let data = program.data();
        let mut values: Code = program.values().code.clone();
        let mut marks: Code = program.marks().code.clone();
        for _ in 0..3 {
            let left = pruner.prune(
                Tape {
                    code: &values,
                    data,
                },
                within.interval(),
            );
            let marks_left = pruner.prune(Tape { code: &marks, data }, within.interval());
            values = left.code.unwrap_or(values);
            marks = marks_left.code.unwrap_or(marks);
            saved.before += program.values().code.instructions.len();
            saved.after += values.instructions.len();
            let points = within.points(r);
            let level = if case % 2 == 0 {
                Level::new()
            } else {
                Level::baseline()
            };
            let whole = with_tapes(level, program.values(), program.marks(), &points);
            let tape = |code| Tape { code, data };
            let less = with_tapes(level, tape(&values), tape(&marks), &points);
            if let Some(difference) = differing(&whole, &less, &points) {
                panic!("{name}, {within:?}: {difference}");
            }
            for (f, p) in whole.iter().zip(&points) {
                let value = f64::from(f32::from_bits(f.0[0]));
                assert!(
                    left.range.contains(value) || value.is_nan(),
                    "{name}: {value} at {p:?} is not in {:?}",
                    left.range
                );
            }
            within = within.part(r);
        }
    }
    saved
}

fn compiled(field: &Field) -> Program {
    Program::compile(field, &Limits::default()).unwrap()
}

fn solid(r: &mut Random) -> Field {
    let solids: Vec<_> = (catalogue().primitives.iter())
        .filter(|e| e.info.dimension == Dimension::Three && e.exactness < Exactness::Estimate)
        .collect();
    let entry = solids[r.below(solids.len())];
    Field::primitive(entry, entry.info.defaults()).unwrap()
}

fn random_field(r: &mut Random, depth: u32) -> Field {
    let all = catalogue();
    loop {
        if depth == 0 || r.unit() < 0.15 {
            return solid(r);
        }
        let shape = random_field(r, depth - 1);
        let made = match r.below(9) {
            0 => {
                let e = &all.maps[r.below(all.maps.len())];
                shape.map(e, e.info.defaults()).ok()
            }
            1 => {
                let e = &all.modifiers[r.below(all.modifiers.len())];
                shape.modify(e, e.info.defaults()).ok()
            }
            2..=4 => {
                let e = &all.joins[r.below(all.joins.len())];
                let other = random_field(r, depth - 1)
                    .place(Placement::moved(r.point(2.0)))
                    .unwrap();
                Field::join(e, e.info.defaults(), vec![shape, other]).ok()
            }
            5 => shape
                .place(Placement::turned(r.point(1.0), r.within(-3.0, 3.0)))
                .ok(),
            6 => shape.place(Placement::scaled(r.within(0.3, 2.0))).ok(),
            7 => {
                let c = r.within(2.5, 6.0);
                shape
                    .repeat(Repetition {
                        spacing: [c, 0.0, c],
                        count: [3, 0, 0],
                        vary: [0.0, r.within(0.0, 1.0), 0.0],
                        seed: 1,
                    })
                    .ok()
            }
            _ => shape.paint(Paint::Material(r.below(4) as u16)).ok(),
        };
        if let Some(field) =
            made.filter(|f| f.facts().dimension == Dimension::Three && !f.facts().bounds.is_empty())
        {
            return field;
        }
    }
}

#[test]
fn every_join_of_the_catalogue() {
    let mut r = Random(0x5eed_1001);
    for entry in &catalogue().joins {
        let mut all = Saved::default();
        let samples = entry.samples.iter().map(|s| s.to_vec());
        for params in samples.chain([entry.info.defaults()]) {
            for _ in 0..6 {
                let painted = |f: Field, k: u16| {
                    let material = f.paint(Paint::Material(k)).unwrap();
                    material.paint(Paint::Object(k)).unwrap()
                };
                let at = r.point(1.5);
                let (x, y) = (painted(solid(&mut r), 0), painted(solid(&mut r), 1));
                let y = y.place(Placement::moved(at)).unwrap();
                let Ok(field) = Field::join(entry, params.clone(), vec![x, y]) else {
                    continue;
                };
                let saved = check_boxes(entry.info.name, &compiled(&field), 6.0, 40, &mut r);
                all.before += saved.before;
                all.after += saved.after;
            }
        }
        let never =
            ["mix", "pipe"].contains(&entry.info.name) || entry.info.name.ends_with("exponential");
        // an arc is left alone only deeper in both solids than most are deep
        let seldom = ["round_intersection", "round_subtraction"].contains(&entry.info.name);
        assert!(
            (all.after == all.before) == never || seldom,
            "{}: {} of {} instructions",
            entry.info.name,
            all.after,
            all.before
        );
    }
}

#[test]
fn random_trees() {
    let mut r = Random(0x5eed_1002);
    let mut all = Saved::default();
    for case in 0..120 {
        let field = random_field(&mut r, 5);
        let saved = check_boxes(&format!("tree {case}"), &compiled(&field), 4.0, 12, &mut r);
        all.before += saved.before;
        all.after += saved.after;
    }
    assert!(
        all.after * 4 < all.before * 3,
        "{} of {}",
        all.after,
        all.before
    );
}

#[test]
fn polar_copies() {
    let mut r = Random(0x5eed_1003);
    for _ in 0..10 {
        let at = [r.within(1.0, 3.0), 0.0, 0.0];
        let field =
            (solid(&mut r).place(Placement::moved(at))).and_then(|f| f.polar(Polar { count: 7 }));
        if let Ok(field) = field {
            check_boxes("polar", &compiled(&field), 5.0, 30, &mut r);
        }
    }
}

#[test]
fn every_scene() {
    let mut r = Random(0x5eed_1004);
    // those of the benchmark are long enough to have cells
    let long = ["bench/temple.star", "bench/facade.star"].map(|name| scenes::folder().join(name));
    for path in scenes::all().into_iter().chain(long) {
        let scene = load(&path, &Options::default())
            .unwrap_or_else(|e| panic!("{e}"))
            .scene;
        let Some(field) = scene.field().unwrap() else {
            continue;
        };
        let program = compiled(&field);
        let finite = (scene.objects().iter())
            .map(|o| o.field.facts().bounds)
            .filter(|b| b.is_finite() && !b.is_empty())
            .fold(Aabb::EMPTY, |a, b| a.hull(&b));
        let reach = if finite.is_empty() {
            4.0
        } else {
            finite
                .min
                .iter()
                .chain(&finite.max)
                .fold(0.0_f64, |a, b| a.max(b.abs()))
        };
        let name = scenes::name(&path);
        let heavy = program.values().code.instructions.len() > 500 || program.is_fractal();
        check_boxes(&name, &program, reach, if heavy { 4 } else { 12 }, &mut r);
        let around = if finite.is_empty() {
            Aabb::centred([4.0; 3])
        } else {
            finite
        };
        let Some(cells) = Cells::new(&program, around).map(Cells::eager) else {
            continue;
        };
        for case in 0..if heavy { 6 } else { 20 } {
            let points = Box3::random(&mut r, reach).points(&mut r);
            let level = if case % 2 == 0 {
                Level::new()
            } else {
                Level::baseline()
            };
            let whole = with_tapes(level, program.values(), program.marks(), &points);
            let less = with_cells(level, &cells, &program, &points);
            if let Some(difference) = differing(&whole, &less, &points) {
                panic!("{name}, cells: {difference}");
            }
        }
    }
}

/// A step from numbers, whatever they are: operands are earlier steps, mostly the latest.
fn step(at: usize, [kind, a, b]: [u32; 3], constant: f64) -> FormulaStep {
    let operand = |x: u32| at as u32 - (1 + x % 97 % 5 % at as u32);
    match kind % 16 {
        0 => FormulaStep::Coordinate((a % 3) as u8),
        1 | 2 => FormulaStep::Constant(constant),
        3..=6 => FormulaStep::Unary(Unary::ALL[a as usize % Unary::ALL.len()], operand(b)),
        7..=9 => {
            let f = [Binary::Min, Binary::Max][a as usize % 2];
            FormulaStep::Binary(f, operand(a / 2), operand(b))
        }
        _ => {
            let f = Binary::ALL[kind as usize / 16 % Binary::ALL.len()];
            FormulaStep::Binary(f, operand(a), operand(b))
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn random_formulas(
        list in proptest::collection::vec((any::<[u32; 3]>(), -4.0..4.0_f64), 4..40),
        seed in 1..u64::MAX,
    ) {
        let mut steps = vec![
            FormulaStep::Coordinate(0),
            FormulaStep::Coordinate(1),
            FormulaStep::Coordinate(2),
        ];
        for (numbers, constant) in list {
            steps.push(step(steps.len(), numbers, constant));
        }
        let budget = Budget { operations: 2000, ..Budget::default() };
        let bounds = Aabb::centred([2.0; 3]);
        // a remainder by zero is no number, and no range says so: programs with any have no cells
        let has_remainders = steps.iter().any(|s| matches!(s, FormulaStep::Binary(Binary::Modulo, ..)));
        let formula = Steps::new(steps).ok().and_then(|steps| {
            let proven = Formula::prove(steps.clone(), bounds, &budget).ok();
            proven.or_else(|| Formula::stated(steps, bounds, 10.0).ok())
        });
        if let Some(formula) = formula {
            let program = compiled(&Field::formula(Arc::new(formula)).unwrap());
            if has_remainders && Cells::new(&program, bounds).is_none() {
                return Ok(());
            }
            check_boxes("formula", &program, 2.2, 6, &mut Random(seed));
        }
    }
}

/// A tape that lost too much is noticed.
#[test]
fn a_tape_of_another_place_is_noticed() {
    let mut r = Random(0x5eed_1005);
    let mut noticed = 0;
    for _ in 0..40 {
        let field = random_field(&mut r, 5);
        let program = compiled(&field);
        let (here, there) = (Box3::random(&mut r, 3.0), Box3::random(&mut r, 3.0));
        let left = Pruner::new().prune(program.values(), here.interval());
        let Some(code) = left.code else { continue };
        let tape = Tape {
            code: &code,
            data: program.data(),
        };
        let points = there.points(&mut r);
        let whole = with_tapes(Level::new(), program.values(), program.marks(), &points);
        let less = with_tapes(Level::new(), tape, program.marks(), &points);
        noticed += usize::from(differing(&whole, &less, &points).is_some());
    }
    assert!(noticed > 5, "{noticed} of 40");
}

/// Cells end where their budget ends, and say the same.
#[test]
fn a_small_budget_is_kept() {
    let mut r = Random(0x5eed_1006);
    let parts: Vec<Field> = (0..300)
        .map(|_| {
            let at = r.point(3.0);
            let scaled = solid(&mut r).place(Placement::scaled(0.3)).unwrap();
            scaled.place(Placement::moved(at)).unwrap()
        })
        .collect();
    let union = catalogue().join("union").unwrap();
    let program = compiled(&Field::join(union, Vec::new(), parts).unwrap());
    let around = Aabb::centred([3.5; 3]);
    let budget = 60_000;
    let few = Cells::within(&program, around, budget)
        .expect("cells")
        .eager();
    let many = Cells::new(&program, around).expect("cells").eager();
    for _ in 0..40 {
        let points = Box3::random(&mut r, 4.0).points(&mut r);
        let level = Level::new();
        let whole = with_tapes(level, program.values(), program.marks(), &points);
        for cells in [&few, &many] {
            let less = with_cells(level, cells, &program, &points);
            assert_eq!(differing(&whole, &less, &points), None);
        }
    }
    let (few, many) = (few.census(), many.census());
    // one more that was on its way, and tapes for marks, which are fewer than cells
    assert!(
        few.bytes < 3 * budget && many.bytes > 10 * budget,
        "{few:?}, {many:?}"
    );
    assert!(few.cells < many.cells);
    assert!(few.instructions > many.instructions);
}
