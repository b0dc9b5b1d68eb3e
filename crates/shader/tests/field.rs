//! The field in shaders is WGSL, and gives what the evaluators give: value, gradient and marks.

#![allow(unreachable_pub, reason = "nothing outside a test can use it")]

use fearless_simd::{Level, dispatch};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use zeroset_catalogue::tape::{Code, Instruction, Operation};
use zeroset_eval::{BATCH, Workspace};
use zeroset_field::program::{Limits, Program, Structure};
use zeroset_language::load::{Options, load};
use zeroset_number::{Dual, v3};
use zeroset_shader::FieldSource;
use zeroset_shader::recorded::{self, Form};
use zeroset_testkit::wgsl::{Shader, Value};

const HEAD: &str = "@group(0) @binding(2) var<storage, read> params: array<f32>;
@group(0) @binding(3) var<storage, read> code: array<u32>;
// a module that has grids declares it with their texture
fn grid_sample(number: f32, node: vec3f) -> f32 {
    return 0.0;
}
";

fn shader(source: &FieldSource) -> Shader {
    Shader::whole(&format!("{HEAD}{}", source.text))
}

fn both(structure: &Structure) -> [FieldSource; 2] {
    [
        FieldSource::compiled(structure),
        FieldSource::interpreted(structure),
    ]
}

fn scenes(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        match path.extension().and_then(|e| e.to_str()) {
            _ if path.is_dir() => scenes(&path, out),
            Some("star" | "json") => out.push(path),
            _ => {}
        }
    }
}

/// Every scene's program, with its name.
fn programs() -> Vec<(String, Program)> {
    let mut all = Vec::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    scenes(&folder, &mut all);
    all.sort();
    assert!(!all.is_empty());
    (all.iter())
        .map(|path| {
            let loaded = load(path, &Options::default());
            let scene = loaded.unwrap_or_else(|e| panic!("{}", e.report)).scene;
            let field = scene.field().unwrap().unwrap();
            let program = Program::compile(&field, &Limits::default()).unwrap();
            (path.display().to_string(), program)
        })
        .collect()
}

/// Points in and around the solid.
fn points(program: &Program, n: usize) -> Vec<[f32; 3]> {
    let bounds = program.bounds();
    let mut noise = 1_u32;
    let mut random = |k: usize| {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let t = f64::from(noise >> 8) / f64::from(1 << 24);
        let (lo, hi) = (bounds.min[k].max(-4.0), bounds.max[k].min(4.0));
        (lo + (hi - lo) * (1.2 * t - 0.1)) as f32
    };
    (0..n).map(|_| [random(0), random(1), random(2)]).collect()
}

/// Value, gradient and marks, by the evaluators.
fn evaluate(program: &Program, points: &[[f32; 3]]) -> Vec<[Vec<f32>; 3]> {
    assert!(points.len() <= BATCH);
    let mut w = Workspace::new(program.values(), program.marks());
    for (k, lane) in w.points_mut().iter_mut().enumerate() {
        for (x, p) in lane.0.iter_mut().zip(points) {
            *x = p[k];
        }
    }
    dispatch!(Level::new(), s => zeroset_eval::marks(s, program.marks(), &mut w, points.len()));
    let m = w.marks();
    (points.iter().enumerate())
        .map(|(i, p)| {
            let value = zeroset_eval::Point::new(program.values()).value(v3(p[0], p[1], p[2]));
            let dual = Dual::point(v3(p[0], p[1], p[2]));
            let d: Dual<f32> = zeroset_eval::Point::new(program.values()).value(dual);
            let marks = [&m.object, &m.first, &m.second, &m.share];
            let marks = marks.into_iter().chain(&m.orbit).map(|lane| lane.0[i]);
            [
                vec![value],
                vec![d.v, d.d[0], d.d[1], d.d[2]],
                marks.collect(),
            ]
        })
        .collect()
}

const FUNCTIONS: [&str; 3] = ["field", "field_gradient", "field_marks"];
const POINTS: usize = 40;

/// At how many points each function gives something else, and an example.
fn differences(source: &FieldSource, program: &Program) -> ([usize; 3], String) {
    let shader = shader(source);
    let points = points(program, POINTS);
    let mut wrong = [0; 3];
    let mut example = String::new();
    for (p, expected) in points.iter().zip(evaluate(program, &points)) {
        for (k, expected) in expected.into_iter().enumerate() {
            let argument = vec![Value::Vector(p.to_vec())];
            let got = shader.run(FUNCTIONS[k], argument, program.params(), &source.code);
            assert_eq!(got.len(), expected.len());
            let size = expected.iter().fold(1.0_f32, |m, x| m.max(x.abs()));
            let near = |(x, y): (&f32, &f32)| (x - y).abs() <= 1e-3 * size;
            if !expected.iter().zip(&got).all(near) {
                wrong[k] += 1;
                example = format!("{} at {p:?}: {got:?}, not {expected:?}", FUNCTIONS[k]);
            }
        }
    }
    (wrong, example)
}

#[test]
fn scenes_give_what_evaluators_give() {
    let mut failures = String::new();
    let mut kinds = HashSet::new();
    for (name, program) in programs() {
        for source in both(program.structure()) {
            let (wrong, example) = differences(&source, &program);
            // points on the border of two materials, and near orbits of fractals that part
            if wrong.iter().any(|n| *n > POINTS / 20) {
                failures += &format!("{name}: {wrong:?} of {POINTS}: {example}\n");
            }
            kinds.insert(is_plain(&source.text));
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert_eq!(kinds.len(), 2, "scenes with marks of one kind only");
}

/// The body of `field_marks`.
fn body(text: &str) -> &str {
    text.split("fn field_marks(p: vec3f) -> Marks {\n")
        .nth(1)
        .unwrap()
}

/// Whether `field_marks` evaluates nothing.
fn is_plain(text: &str) -> bool {
    body(text).trim_start().starts_with("return Marks(")
}

#[test]
fn mistakes_are_seen() {
    let all = programs();
    let find = |name: &str| all.iter().find(|(path, _)| path.contains(name)).unwrap();
    let program = &find("gallery/joins").1;
    for source in both(program.structure()) {
        assert_eq!(differences(&source, program).0, [0; 3]);
        // the sides of a join change places
        let wrong = source.text.replace("share <= 0.5", "share > 0.5");
        assert_ne!(wrong, source.text);
        let wrong = FieldSource {
            text: wrong,
            ..source
        };
        let (wrong, _) = differences(&wrong, program);
        assert!(wrong[0] == 0 && wrong[2] > POINTS / 20, "{wrong:?}");
    }
    // a scene with another's shader
    let source = FieldSource::compiled(find("keinert_jewel").1.structure());
    let (wrong, _) = differences(&source, program);
    assert!(wrong.iter().all(|n| *n > POINTS / 20), "{wrong:?}");
}

/// A program out of instructions: up to three points (registers 0, 3, 6), then values.
fn structure(values: Vec<Instruction>, marks: Vec<Instruction>) -> Structure {
    let code = |instructions: Vec<Instruction>| Code {
        result: instructions.last().unwrap().out,
        instructions,
        registers: 20,
    };
    Structure {
        values: code(values),
        marks: code(marks),
        sides: Vec::new(),
        places: Code {
            instructions: Vec::new(),
            registers: 3,
            result: 0,
        },
        coats: Vec::new(),
        colours: Vec::new(),
    }
}

fn step(operation: Operation, out: u16, a: u16, b: u16) -> Instruction {
    Instruction {
        operation,
        out,
        a,
        b,
        at: 0,
    }
}

fn sphere(out: u16, point: u16) -> Instruction {
    step(Operation::Leaf(0), out, point, 0)
}

fn union(out: u16, a: u16, b: u16) -> Instruction {
    step(Operation::Pair(0), out, a, b)
}

fn material(number: u16, out: u16, a: u16) -> Instruction {
    step(Operation::Mark(0, number), out, a, 0)
}

fn object(number: u16, out: u16, a: u16) -> Instruction {
    step(Operation::Mark(1, number), out, a, 0)
}

#[test]
fn every_operation_has_a_place() {
    let warp = |out, a| step(Operation::Warp(0), out, a, 0);
    // the value so far is in 9 or 10, after each round in 9
    let mut values = vec![warp(3, 0), warp(6, 3), sphere(9, 0)];
    for operation in recorded::operations() {
        let at = |out, a, b| step(operation, out, a, b);
        // at the point itself and at another
        values.extend(match operation {
            Operation::Leaf(_) => [
                at(11, 0, 0),
                union(10, 9, 11),
                at(11, 3, 0),
                union(9, 10, 11),
            ],
            Operation::Warp(_) => [at(3, 0, 0), at(6, 3, 0), sphere(11, 6), union(10, 9, 11)],
            Operation::Put(_) => [at(3, 9, 0), at(6, 9, 3), sphere(11, 6), union(10, 9, 11)],
            Operation::Change(_) => [at(10, 9, 0), at(11, 10, 3), at(10, 11, 6), at(9, 10, 0)],
            Operation::Pair(_) => [sphere(11, 0), at(10, 9, 11), at(12, 10, 11), at(9, 12, 11)],
            Operation::Mark(..) => panic!("marks have no functions"),
        });
        if let Operation::Warp(_) | Operation::Put(_) = operation {
            values.push(union(9, 10, 11));
        }
    }
    let mut marks = values.clone();
    marks.extend([object(3, 12, 9), material(7, 9, 12)]);
    for source in both(&structure(values, marks)) {
        shader(&source);
        assert!(!is_plain(&source.text));
        for operation in recorded::operations() {
            for form in [Form::Value, Form::Gradient, Form::Share, Form::Traps] {
                if recorded::function(operation, form).is_some() {
                    let call = format!(" {}(", recorded::name(operation, form).unwrap());
                    let found = source.text.matches(&call).count();
                    assert!(
                        found >= 2,
                        "{call} {found} times, once where it is declared"
                    );
                }
            }
        }
    }
}

#[test]
fn equal_operations_share_a_shader() {
    let spheres = |n: u16| {
        let mut values = vec![sphere(9, 0)];
        for _ in 0..n {
            values.extend([sphere(11, 0), union(10, 9, 11)]);
            values.extend([sphere(11, 0), union(9, 10, 11)]);
        }
        FieldSource::interpreted(&structure(values.clone(), values))
    };
    assert_eq!(spheres(1).text, spheres(50).text);
    assert_ne!(spheres(1).code, spheres(50).code);
}

#[test]
fn marks_that_are_the_same_everywhere_cost_nothing() {
    let marks = |first: [u16; 2], second: [u16; 2], share: bool| {
        let values = vec![sphere(9, 0), sphere(10, 0), union(11, 9, 10)];
        let mut marks = vec![
            sphere(9, 0),
            material(first[0], 12, 9),
            object(first[1], 9, 12),
        ];
        marks.extend([
            sphere(10, 0),
            object(second[1], 12, 10),
            material(second[0], 10, 12),
        ]);
        // what is marked already stays as it is
        marks.extend([union(11, 9, 10), material(9, 13, 11), object(9, 12, 13)]);
        let structure = structure(values, marks);
        for source in both(&structure) {
            let shader = shader(&source);
            assert_eq!(is_plain(&source.text), !share, "{}", source.text);
            let p = vec![Value::Vector(vec![0.0; 3])];
            let got = shader.run("field_marks", p, &[0.0, 0.0, 0.0, 1.0], &source.code);
            // the second of equals wins
            let [object, material] = [f32::from(second[1]), f32::from(second[0])];
            assert_eq!(got[..2], [object, material], "{}", source.text);
            assert_eq!(got[4..], [0.0; 4]);
        }
    };
    marks([2, 5], [2, 5], false);
    marks([2, 5], [2, 6], true);
    marks([2, 5], [3, 5], true);
    let nothing = structure(vec![sphere(9, 0)], vec![sphere(9, 0)]);
    for source in both(&nothing) {
        let p = vec![Value::Vector(vec![0.0; 3])];
        let got = shader(&source).run("field_marks", p, &[], &source.code);
        assert_eq!(got, [-1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(is_plain(&source.text));
    }
}
