//! Every function of every operation is WGSL, and computes what the evaluators compute.

use super::*;
use crate::entry::Binding;
use crate::layout::{Frame, Shared};
use crate::texture::{self, SIDE, starts};
use std::collections::HashSet;
use std::sync::Arc;
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::flat::strips;
use zeroset_catalogue::op::code;
use zeroset_catalogue::tape::{Code, Instruction, Tape};
use zeroset_number::{Data, Grid, Vec3, v3, wgsl};
use zeroset_testkit::wgsl::{Inputs, Shader, Value};

/// All functions, with their names.
fn functions() -> impl Iterator<Item = (Operation, Form, Function)> {
    operations().flat_map(|operation| {
        (Form::ALL.into_iter())
            .filter_map(move |form| Some((operation, form, function(operation, form)?)))
    })
}

#[test]
fn names_are_different_and_plain() {
    let mut seen = HashSet::new();
    for (operation, form, function) in functions() {
        let own = function.name();
        assert_eq!(name(operation, form).as_deref(), Some(own));
        assert!(seen.insert(own.to_owned()), "{own} is there twice");
        assert!(!own.contains("__") && !own.ends_with('_'), "{own}");
        assert!(
            (own.chars()).all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'),
            "{own}"
        );
        assert_eq!(wgsl::identifier(own), own);
    }
    for expected in [
        "leaf_sphere",
        "gradient_leaf_triangle2d",
        "leaf_coordinate_1",
        "traps_leaf_mandelbulb",
        "plain_gradient_leaf_mandelbulb",
        "warp_scale3",
        "warp_rigid",
        "change_round",
        "share_pair_smooth_union",
    ] {
        assert!(seen.contains(expected), "{expected} in {seen:?}");
    }
}

#[test]
fn what_is_not_there_has_no_function() {
    let none = [
        Operation::Mark(0, 0),
        Operation::Leaf(9999),
        Operation::Warp(9999),
        Operation::Change(9999),
        Operation::Pair(9999),
    ];
    for operation in none {
        assert_eq!(name(operation, Form::Value), None);
        assert!(function(operation, Form::Value).is_none());
    }
    let forms = |operation| Form::ALL.map(|form| function(operation, form).is_some());
    assert_eq!(forms(Operation::Leaf(0)), [true, true, true, false, false]);
    assert_eq!(forms(Operation::Warp(0)), [true, true, true, false, false]);
    assert_eq!(
        forms(Operation::Change(0)),
        [true, true, true, false, false]
    );
    assert_eq!(forms(Operation::Pair(0)), [true, true, false, true, false]);
}

/// Parameters worth trying, with three numbers in front that are not the operation's.
fn parameters(operation: Operation) -> Vec<Vec<f32>> {
    let all = catalogue();
    let (centre, info, samples) = match operation {
        Operation::Leaf(code::SAMPLED) => return sampled_parameters(),
        Operation::Leaf(code::STRIPS) => return strip_parameters(),
        Operation::Leaf(code) => match all.primitives.get(usize::from(code)) {
            Some(e) => (vec![0.25, -0.125, 0.0625], &e.info, e.samples),
            None => return own_parameters(),
        },
        Operation::Warp(code) => match all.maps.get(usize::from(code)) {
            Some(e) => (vec![], &e.info, e.samples),
            None => return own_parameters(),
        },
        Operation::Change(code) => match all.modifiers.get(usize::from(code)) {
            Some(e) => (vec![], &e.info, e.samples),
            None => return own_parameters(),
        },
        Operation::Pair(code) => match all.joins.get(usize::from(code)) {
            Some(e) => (vec![], &e.info, e.samples),
            None => return own_parameters(),
        },
        // a put has no parameters
        Operation::Put(_) => return own_parameters(),
        Operation::Mark(..) => return vec![],
    };
    let defaults = (info.params.iter().all(|p| !p.default.is_empty())).then(|| info.defaults());
    (samples.iter().map(|s| s.to_vec()).chain(defaults))
        .map(|own| {
            let own = own.iter().map(|x| *x as f32);
            [9.0; AT]
                .into_iter()
                .chain(centre.clone())
                .chain(own)
                .collect()
        })
        .collect()
}

/// More numbers than any operation of the compiler's takes, none of them zero.
fn own_parameters() -> Vec<Vec<f32>> {
    let mut noise = Noise(7);
    vec![(0..32).map(|_| 0.2 + noise.next().abs()).collect()]
}

/// Contours of many pieces: two rings that cross, one in the other by windings and by crossings.
fn strip_parameters() -> Vec<Vec<f32>> {
    let ring = |corners: u32, size: f64, x: f64| -> Vec<[f64; 2]> {
        let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(corners);
        let reach = |i: u32| size * (1.0 + 0.3 * f64::from(i % 3));
        let corner = |i: u32| [x + reach(i) * turn(i).cos(), reach(i) * turn(i).sin()];
        (0..corners).map(corner).collect()
    };
    let pieces = |points: Vec<[f64; 2]>| -> Vec<f64> {
        let next = points.iter().cycle().skip(1);
        let each = points.iter().zip(next);
        each.flat_map(|(a, b)| [a[0], a[1], b[0], b[1]]).collect()
    };
    let outline = [pieces(ring(17, 0.6, 0.2)), pieces(ring(23, 0.3, -0.4))].concat();
    let outline = [&[40.0], &outline[..]].concat();
    let star: Vec<[f64; 2]> = ring(31, 0.7, 0.0)
        .into_iter()
        .cycle()
        .step_by(7)
        .take(31)
        .collect();
    let star = [&[31.0], star.as_flattened()].concat();
    [("outline", outline), ("polygon", star)]
        .map(|(name, list)| {
            let trees = strips(name, &list).expect("many pieces");
            let front = [9.0; AT].into_iter().chain([0.25, -0.125, 0.0]);
            front.chain(trees.iter().map(|x| *x as f32)).collect()
        })
        .to_vec()
}

/// Grids that a field of samples may be of: the texels of the second begin within a row and go on in the next one.
fn grids() -> Vec<Arc<Grid>> {
    let mut noise = Noise(5);
    [[9, 7, 5], [16, 13, 12], [2, 3, 4]]
        .map(|nodes: [u32; 3]| {
            let values = (0..nodes.iter().product()).map(|_| noise.next()).collect();
            Arc::new(Grid::new(nodes, values).expect("a grid"))
        })
        .to_vec()
}

/// Places and numbers of [`grids`], whose boxes the points of a case lie in and about.
fn sampled_parameters() -> Vec<Vec<f32>> {
    let each = grids().into_iter().enumerate().map(|(number, grid)| {
        let nodes = grid.nodes().map(|n| n as f32);
        let density = nodes.map(|n| (n - 1.0) / 2.5);
        let place = [-1.25, -1.25, -1.25].into_iter().chain(density);
        let place = [9.0; AT].into_iter().chain(place);
        place.chain([number as f32]).chain(nodes).collect()
    });
    each.collect()
}

/// Where the parameters of the operations under test begin.
const AT: usize = 3;

/// Numbers in [-1.5, 1.5).
struct Noise(u32);

impl Noise {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32 * 3.0 - 1.5
    }

    fn dual(&mut self) -> Dual<f32> {
        Dual {
            v: self.next(),
            d: [self.next(), self.next(), self.next()],
        }
    }
}

/// The operation by the evaluator, on three numbers: they are the point; the first is the value of a change, the first two
/// are the values of a pair.
fn evaluate(operation: Operation, params: &[f32], p: Vec3<Dual<f32>>) -> Vec<Dual<f32>> {
    let results = match operation {
        Operation::Warp(_) | Operation::Put(_) => 3,
        _ => 1,
    };
    let b = u16::from(matches!(operation, Operation::Pair(_)));
    let instruction = Instruction {
        operation,
        out: 3,
        a: 0,
        b,
        at: AT as u32,
    };
    (0..results)
        .map(|k| {
            let code = Code {
                instructions: vec![instruction],
                registers: 6,
                result: 3 + k,
            };
            let data = &Data {
                params: params.to_vec(),
                grids: grids(),
            };
            zeroset_eval::Point::new(Tape { code: &code, data }).value(p)
        })
        .collect()
}

fn vector(d: Dual<f32>) -> Vec<f32> {
    vec![d.v, d.d[0], d.d[1], d.d[2]]
}

/// What the function is called with, and what it should give.
fn case(
    operation: Operation,
    form: Form,
    params: &[f32],
    noise: &mut Noise,
) -> (Vec<Value>, Vec<f32>) {
    let plain = |x: f32, axis: usize| Dual {
        v: x,
        d: std::array::from_fn(|k| f32::from(u8::from(k == axis))),
    };
    let p = match form {
        Form::Gradient => v3(noise.dual(), noise.dual(), noise.dual()),
        _ => v3(
            plain(noise.next(), 0),
            plain(noise.next(), 1),
            plain(noise.next(), 2),
        ),
    };
    let point = match form {
        Form::Gradient => Value::Matrix(p.array().map(vector).to_vec()),
        _ => Value::Vector(p.array().map(|x| x.v).to_vec()),
    };
    let dual = matches!(form, Form::Gradient | Form::PlainGradient);
    let number = |x: Dual<f32>| match dual {
        true => Value::Vector(vector(x)),
        false => Value::Float(x.v),
    };
    let mut arguments = match operation {
        Operation::Leaf(_) | Operation::Warp(_) => vec![point],
        Operation::Put(_) | Operation::Change(_) => vec![number(p.x), point],
        Operation::Pair(_) | Operation::Mark(..) => vec![number(p.x), number(p.y)],
    };
    arguments.push(Value::Count(AT as u32));
    let expected = match form {
        Form::Traps => {
            let trap = TRAPS[match operation {
                Operation::Leaf(code) => usize::from(code),
                _ => panic!("traps of {operation:?}"),
            }];
            let a = Args {
                store: &Data::from(params),
                at: AT,
            };
            trap(v3(p.x.v, p.y.v, p.z.v), a).to_vec()
        }
        Form::Share => {
            let d = evaluate(operation, params, p)[0].d;
            vec![d[1].abs() / (d[0].abs() + d[1].abs()).max(1e-20)]
        }
        Form::Value => evaluate(operation, params, p).iter().map(|d| d.v).collect(),
        Form::Gradient | Form::PlainGradient => evaluate(operation, params, p)
            .into_iter()
            .flat_map(vector)
            .collect(),
    };
    (arguments, expected)
}

type Trap = fn(Vec3<f32>, Args<'_, f32>) -> [f32; 4];
macro_rules! traps { ($($entry:ty,)*) => { &[$(<$entry as Leaf>::traps::<f32> as Trap),*] }; }
const TRAPS: &[Trap] = each_leaf!(traps);

/// At how many of [`POINTS`] points the shader's function does not give what the operation gives, and one such case.
fn differences(
    shader: &Shader,
    function: &str,
    (operation, form): (Operation, Form),
    params: &[f32],
) -> (usize, String) {
    let mut noise = Noise(1);
    let (mut count, mut example) = (0, String::new());
    let grids = grids();
    let samples: Vec<f32> = grids.iter().flat_map(|g| g.values()).copied().collect();
    let rows = grids.iter().zip(starts(&grids));
    let table: Vec<[f32; 4]> = rows
        .map(|(grid, start)| bytemuck::cast(crate::job::grid_row(grid, start)))
        .collect();
    let texel = |name: &str, [column, row, layer]: [u32; 3]| {
        assert_eq!((name, layer), ("grids", 0));
        [samples[(row * SIDE + column) as usize], 0.0, 0.0, 1.0]
    };
    let inputs = Inputs {
        params,
        table: &table,
        texel: Some(&texel),
        ..Inputs::default()
    };
    for _ in 0..POINTS {
        let (arguments, expected) = case(operation, form, params, &mut noise);
        let got = shader.run_with(function, arguments, inputs);
        assert_eq!(got.len(), expected.len(), "{function}");
        let size = expected.iter().fold(1.0_f32, |m, x| m.max(x.abs()));
        let near = |(x, y): (&f32, &f32)| (x - y).abs() <= 1e-4 * size;
        let finite = expected.iter().all(|x| x.is_finite());
        if finite && !expected.iter().zip(&got).all(near) {
            count += 1;
            example = format!("{got:?} should be {expected:?}");
        }
    }
    (count, example)
}

const POINTS: usize = 100;

fn shader() -> (Vec<(Operation, Form, Function)>, Shader) {
    let all: Vec<_> = functions().collect();
    let mut source: String = all.iter().map(|(_, _, f)| wgsl::print(f)).collect();
    for binding in [Binding::Table, Binding::Grids] {
        source += &binding.declaration(false);
    }
    source += &Frame::declaration();
    source += "var<private> frame: Frame;\n";
    source += &texture::side();
    source += texture::GRID_TEXEL;
    source += &crate::source::grids();
    let shader = Shader::new(&source);
    (all, shader)
}

#[test]
fn shaders_compute_what_evaluators_compute() {
    let (all, shader) = shader();
    let mut failures = String::new();
    for (operation, form, function) in &all {
        let sets = parameters(*operation);
        assert!(!sets.is_empty(), "nothing to try {operation:?} with");
        for params in sets {
            let name = function.name();
            let (count, example) = differences(&shader, name, (*operation, *form), &params);
            if count > 0 {
                failures += &format!("{name}: at {count} of {POINTS} points: {example}\n");
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

/// Functions in each other's place do not go unseen.
#[test]
fn mistakes_are_seen() {
    let (_, shader) = shader();
    let find = |wanted: &str| {
        (operations().find(|o| name(*o, Form::Value).as_deref() == Some(wanted)))
            .unwrap_or_else(|| panic!("no {wanted}"))
    };
    for (form, wrong, right) in [
        (Form::Value, "leaf_sphere", "leaf_cuboid"),
        (Form::Gradient, "gradient_warp_twist", "warp_shear"),
        (
            Form::PlainGradient,
            "plain_gradient_change_round",
            "change_onion",
        ),
        (Form::Gradient, "gradient_pair_union", "pair_subtraction"),
        (Form::Share, "share_pair_union", "pair_intersection"),
        (Form::Traps, "traps_leaf_mandelbulb", "leaf_mandelbox"),
    ] {
        let operation = find(right);
        let params = &parameters(operation)[0];
        let (count, _) = differences(&shader, wrong, (operation, form), params);
        assert!(count > POINTS / 10, "{wrong} for {right}: {count} points");
    }
}

#[test]
fn changes_that_read_the_point_say_so() {
    for (code, entry) in (0..).zip(CHANGES) {
        let recorder = Recorder::new();
        let (_, results) = (entry.record)(&recorder, Form::Value).unwrap();
        // without the point among its arguments, a function that uses it cannot be made
        let arguments = [("d", Argument::Number), ("at", Argument::Offset)];
        let reads = recorder.function("change", &arguments, &results).is_err();
        assert_eq!(
            zeroset_catalogue::op::reads_point(code),
            reads,
            "{}",
            entry.path
        );
    }
}
