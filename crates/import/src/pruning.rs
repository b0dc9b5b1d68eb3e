//! Trees of Lipschitz pruning (Barbier, Sanchez, Paris, Michel, Lambert, Boubekeur, Paulin and Thonat 2025): boxes, spheres, cylinders and
//! cones under unions, intersections and subtractions, smooth by a radius, as the JSON of their program.
//!
//! A matrix has three rows of four numbers and takes a point of what is above to one of the node. A box has full `sides`; its section in x
//! and z has corners of half the `bevel`, its edges above and below are rounded by `round_x` and `round_y`.

use crate::{ImportError, Imported};
use serde_json::{Map, Value};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Braces and brackets within each other that are followed.
const DEEPEST: usize = 10_000;
/// Bytes of the stack on which so many are.
const STACK: usize = 512 << 20;

/// A blend that is narrower than this is none: what its program writes for none is 1e-8.
const SHARP: f64 = 1e-6;

type Matrix = [[f64; 4]; 3];
const WHOLE: Matrix = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Blend {
    Union,
    Intersection,
    Subtraction,
}

/// A scene from a tree.
///
/// # Errors
/// What is no such tree, with the way to it.
pub(crate) fn scene(text: &str, title: &str) -> Result<Imported, ImportError> {
    let deepest = depth(text);
    if deepest > DEEPEST {
        return Err(ImportError::Tree {
            path: String::new(),
            message: format!("it is nested {deepest} deep, at most {DEEPEST} is read"),
        });
    }
    let work = || {
        let mut reader = serde_json::Deserializer::from_str(text);
        reader.disable_recursion_limit();
        let value: Value = serde::Deserialize::deserialize(&mut reader)?;
        reader.end()?;
        written(&value, title)
    };
    // parsing, walking and dropping such a value each take a frame of the stack a level
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, work);
        match thread.map(std::thread::ScopedJoinHandle::join) {
            Ok(Ok(result)) => result,
            _ => Err(ImportError::Tree {
                path: String::new(),
                message: "there is no room for so deep a tree".into(),
            }),
        }
    })
}

/// How deep braces and brackets are nested.
fn depth(text: &str) -> usize {
    let (mut now, mut most, mut in_text, mut escaped) = (0_usize, 0, false, false);
    for byte in text.bytes() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_text => escaped = true,
            b'"' => in_text = !in_text,
            b'{' | b'[' if !in_text => {
                now += 1;
                most = most.max(now);
            }
            b'}' | b']' if !in_text => now = now.saturating_sub(1),
            _ => {}
        }
    }
    most
}

/// Where in the tree something is: the last few steps of the way.
struct Way<'a> {
    above: Option<&'a Way<'a>>,
    step: &'a str,
}

impl Way<'_> {
    fn text(&self) -> String {
        let (mut steps, mut at) = (Vec::new(), Some(self));
        while let Some(way) = at {
            if steps.len() == 8 {
                steps.push("...");
                break;
            }
            if !way.step.is_empty() {
                steps.push(way.step);
            }
            at = way.above;
        }
        steps.reverse();
        steps.join(".")
    }

    fn wrong<T>(&self, message: impl Into<String>) -> Result<T, ImportError> {
        Err(ImportError::Tree {
            path: self.text(),
            message: message.into(),
        })
    }
}

struct Scene {
    lines: String,
    /// Widest blend.
    reach: f64,
    parts: usize,
    /// Whether a box has edges that no shape of the catalogue has.
    bevelled: bool,
    colours: BTreeSet<String>,
}

fn written(value: &Value, title: &str) -> Result<Imported, ImportError> {
    let root = Way {
        above: None,
        step: "",
    };
    let mut scene = Scene {
        lines: String::new(),
        reach: widest(value),
        parts: 0,
        bevelled: false,
        colours: BTreeSet::new(),
    };
    let shape = scene.node(value, &root, &WHOLE)?;
    let shape = if shape.len() > 400 {
        scene.named("tree", &shape)
    } else {
        shape
    };
    let mut text = format!(
        "# {title}: {} shapes, imported from the JSON of Lipschitz pruning (Barbier et al. 2025).\n\n",
        scene.parts
    );
    for colour in &scene.colours {
        let _ = writeln!(
            text,
            "{} = material(color = \"#{colour}\", roughness = 0.6)",
            colour_name(colour)
        );
    }
    if scene.bevelled {
        text += BEVELLED;
    }
    text.push('\n');
    text += &scene.lines;
    let _ = writeln!(text, "show({shape}, name = \"tree\")");
    Ok(Imported {
        text,
        notes: Vec::new(),
    })
}

fn colour_name(colour: &str) -> String {
    format!("m_{colour}")
}

/// A box as its program has it: a formula, since no shape of the catalogue has such edges.
const BEVELLED: &str = r#"
# A rectangle with a radius for each corner, drawn along y, whose edges are rounded above and below.
def bevelled_box(sides, corners, top, bottom, room):
    x, y, z = [0.5 * s for s in sides]
    def distance_at(p):
        r = (corners[0] if p.z > 0 else corners[1]) if p.x > 0 else (corners[2] if p.z > 0 else corners[3])
        q = vec2(abs(p.x) - x + r, abs(p.z) - z + r)
        section = min(max(q.x, q.y), 0) + length(max(q, 0)) - r
        e = top if p.y > 0 else bottom
        s = vec2(section + e, abs(p.y) - y + e)
        return min(max(s.x, s.y), 0) + length(max(s, 0)) - e
    size = [s + room for s in sides]
    if max(corners) == min(corners) and top == bottom:
        return field(distance_at, size = size)
    # the corners meet where they differ, so that its slope is known and not proven
    return field(distance_at, size = size, slope = 1)
"#;

fn widest(value: &Value) -> f64 {
    let (mut open, mut widest) = (vec![value], 0.0_f64);
    while let Some(value) = open.pop() {
        let Value::Object(node) = value else { continue };
        widest = widest.max(
            node.get("blendRadius")
                .and_then(Value::as_f64)
                .unwrap_or(0.0),
        );
        open.extend(
            ["leftChild", "rightChild"]
                .iter()
                .filter_map(|k| node.get(*k)),
        );
    }
    widest
}

impl Scene {
    /// Gives a text a name, in a line of its own.
    fn named(&mut self, wanted: &str, text: &str) -> String {
        let name = format!("{wanted}_{}", self.lines.lines().count() + 1);
        let _ = writeln!(self.lines, "{name} = {text}");
        name
    }

    fn node(
        &mut self,
        value: &Value,
        way: &Way<'_>,
        above: &Matrix,
    ) -> Result<String, ImportError> {
        let Value::Object(node) = value else {
            return way.wrong("a node is an object");
        };
        let kind = text_of(node, "nodeType", way)?;
        let own = match node.get("matrix") {
            None => WHOLE,
            Some(_) => rows(node, way)?,
        };
        let matrix = times(above, &own);
        match kind {
            "primitive" => {
                self.parts += 1;
                self.primitive(node, way, &matrix)
            }
            "binaryOperator" => self.operator(node, way, &matrix),
            other => way.wrong(format!(
                "`nodeType` is \"primitive\" or \"binaryOperator\", not {other:?}"
            )),
        }
    }

    fn operator(
        &mut self,
        node: &Map<String, Value>,
        way: &Way<'_>,
        matrix: &Matrix,
    ) -> Result<String, ImportError> {
        let (blend, radius) = blend(node, way)?;
        // joins of the same kind in each other are one list, from the innermost on: both ways round they are the same
        let mut rest: Vec<(&Value, &'static str, Matrix)> = Vec::new();
        let (mut at, mut above) = (node, *matrix);
        let is_same = |value: &Value| match value {
            Value::Object(node)
                if node.get("nodeType").and_then(Value::as_str) == Some("binaryOperator") =>
            {
                let inner = self::blend(node, way);
                blend != Blend::Subtraction
                    && inner.is_ok_and(|(other, width)| {
                        other == blend && (width == radius || width.max(radius) < SHARP)
                    })
            }
            _ => false,
        };
        loop {
            let (left, right) = (child(at, "leftChild", way)?, child(at, "rightChild", way)?);
            let (inner, step, other) = match (is_same(left), is_same(right)) {
                (false, true) => (right, "leftChild", left),
                _ => (left, "rightChild", right),
            };
            rest.push((other, step, above));
            match inner {
                Value::Object(next) if is_same(inner) => {
                    let own = match next.get("matrix") {
                        None => WHOLE,
                        Some(_) => rows(next, way)?,
                    };
                    above = times(&above, &own);
                    at = next;
                }
                _ => {
                    rest.push((
                        inner,
                        if step == "leftChild" {
                            "rightChild"
                        } else {
                            "leftChild"
                        },
                        above,
                    ));
                    break;
                }
            }
        }
        rest.reverse();
        let mut shapes = Vec::new();
        for (value, step, matrix) in rest {
            let here = Way {
                above: Some(way),
                step,
            };
            let shape = self.node(value, &here, &matrix)?;
            shapes.push(if shape.len() > 160 {
                self.named("part", &shape)
            } else {
                shape
            });
        }
        let name = match blend {
            Blend::Union => "union",
            Blend::Intersection => "intersection",
            Blend::Subtraction => "subtraction",
        };
        let (lines, indent) = if shapes.len() > 3 {
            ("\n    ", ",\n")
        } else {
            ("", "")
        };
        let list = match lines {
            "" => shapes.join(", "),
            _ => format!("{lines}{}{indent}", shapes.join(&format!(",{lines}"))),
        };
        let text = match (blend, radius < SHARP) {
            (Blend::Subtraction, true) => format!("subtraction({}, {})", shapes[0], shapes[1]),
            (Blend::Subtraction, false) => {
                format!(
                    "{}.smooth_subtraction({}, radius = {})",
                    shapes[0],
                    shapes[1],
                    number(radius)
                )
            }
            (_, true) => format!("{name}([{list}])"),
            (_, false) => format!("smooth_{name}([{list}], radius = {})", number(radius)),
        };
        // lines of their own keep expressions shallow, however deep the tree is
        Ok(self.named("part", &text))
    }

    fn primitive(
        &mut self,
        node: &Map<String, Value>,
        way: &Way<'_>,
        matrix: &Matrix,
    ) -> Result<String, ImportError> {
        let shape = match text_of(node, "primitiveType", way)? {
            "sphere" => format!("sphere({})", number(above_zero(node, "radius", way)?)),
            "cylinder" => {
                let (radius, height) = (
                    above_zero(node, "radius", way)?,
                    above_zero(node, "height", way)?,
                );
                format!("cylinder({}, {})", number(radius), number(height))
            }
            "cone" => {
                let (radius, height) = (
                    above_zero(node, "radius", way)?,
                    above_zero(node, "height", way)?,
                );
                format!("cone({}, {})", number(radius), number(height))
            }
            "box" => self.block(node, way)?,
            other => {
                return way.wrong(format!("`primitiveType` is \"sphere\", \"box\", \"cylinder\" or \"cone\", not {other:?}"));
            }
        };
        let mut text = shape;
        if node.contains_key("color") {
            let channel = |c: f64| (c.clamp(0.0, 1.0) * 255.99).floor() as u8;
            let [r, g, b] = numbers::<3>(node, "color", way)?.map(channel);
            let colour = format!("{r:02x}{g:02x}{b:02x}");
            let _ = write!(text, ".paint({})", colour_name(&colour));
            self.colours.insert(colour);
        }
        text += &placed(matrix);
        Ok(text)
    }

    fn block(&mut self, node: &Map<String, Value>, way: &Way<'_>) -> Result<String, ImportError> {
        let sides = numbers::<3>(node, "sides", way)?;
        if sides.iter().any(|s| *s <= 0.0) {
            return way.wrong(format!("`sides` are above 0, not {sides:?}"));
        }
        let bevel = match node.contains_key("bevel") {
            true => numbers::<4>(node, "bevel", way)?,
            false => [0.0; 4],
        };
        let edge = |key| match node.contains_key(key) {
            true => one(node, key, way),
            false => Ok(0.0),
        };
        let (top, bottom) = (edge("round_x")?, edge("round_y")?);
        let corners = bevel.map(|b| (0.5 * b).clamp(0.0, 0.5 * sides[0].min(sides[2])));
        let all = [corners[0], corners[1], corners[2], corners[3], top, bottom];
        let half = 0.5 * sides.into_iter().fold(f64::INFINITY, f64::min);
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-5 * half;
        let is_same = all.iter().all(|r| near(*r, all[0]));
        let is_cube = sides.iter().all(|s| near(0.5 * s, half));
        let list = |numbers: &[f64]| {
            format!(
                "({})",
                numbers
                    .iter()
                    .map(|x| number(*x))
                    .collect::<Vec<_>>()
                    .join(", ")
            )
        };
        Ok(match all[0] {
            r if is_same && near(r, 0.0) => format!("box({})", list(&sides)),
            r if is_same && is_cube && near(r, half) => format!("sphere({})", number(half)),
            r if is_same && r < half => format!("rounded_box({}, {})", list(&sides), number(r)),
            _ => {
                self.bevelled = true;
                let room = number(2.0 * self.reach + 0.02 * sides.into_iter().fold(0.0, f64::max));
                format!(
                    "bevelled_box({}, {}, {}, {}, {room})",
                    list(&sides),
                    list(&corners),
                    number(top),
                    number(bottom)
                )
            }
        })
    }
}

fn blend(node: &Map<String, Value>, way: &Way<'_>) -> Result<(Blend, f64), ImportError> {
    let blend = match text_of(node, "blendMode", way)? {
        "union" => Blend::Union,
        "inter" => Blend::Intersection,
        "sub" => Blend::Subtraction,
        other => {
            return way.wrong(format!(
                "`blendMode` is \"union\", \"inter\" or \"sub\", not {other:?}"
            ));
        }
    };
    let radius = if node.contains_key("blendRadius") {
        one(node, "blendRadius", way)?
    } else {
        0.0
    };
    Ok((blend, radius))
}

fn child<'v>(
    node: &'v Map<String, Value>,
    key: &str,
    way: &Way<'_>,
) -> Result<&'v Value, ImportError> {
    match node.get(key) {
        Some(value) => Ok(value),
        None => way.wrong(format!("a binary operator needs `{key}`")),
    }
}

fn text_of<'v>(
    node: &'v Map<String, Value>,
    key: &str,
    way: &Way<'_>,
) -> Result<&'v str, ImportError> {
    match node.get(key) {
        Some(Value::String(text)) => Ok(text),
        Some(_) => way.wrong(format!("`{key}` is a text")),
        None => way.wrong(format!("`{key}` is missing")),
    }
}

fn one(node: &Map<String, Value>, key: &str, way: &Way<'_>) -> Result<f64, ImportError> {
    match node.get(key).map(Value::as_f64) {
        Some(Some(x)) if (0.0..1e6).contains(&x) => Ok(x),
        Some(_) => way.wrong(format!("`{key}` is a number from 0 to 1e6")),
        None => way.wrong(format!("`{key}` is missing")),
    }
}

fn above_zero(node: &Map<String, Value>, key: &str, way: &Way<'_>) -> Result<f64, ImportError> {
    match one(node, key, way)? {
        0.0 => way.wrong(format!("`{key}` is above 0")),
        x => Ok(x),
    }
}

fn numbers<const N: usize>(
    node: &Map<String, Value>,
    key: &str,
    way: &Way<'_>,
) -> Result<[f64; N], ImportError> {
    let list = node
        .get(key)
        .and_then(Value::as_array)
        .filter(|list| list.len() == N);
    let Some(list) = list else {
        return way.wrong(format!("`{key}` is a list of {N} numbers"));
    };
    let mut out = [0.0; N];
    for (out, value) in out.iter_mut().zip(list) {
        match value.as_f64().filter(|x| x.abs() < 1e6) {
            Some(x) => *out = x,
            None => return way.wrong(format!("`{key}` is a list of {N} numbers below 1e6")),
        }
    }
    Ok(out)
}

fn rows(node: &Map<String, Value>, way: &Way<'_>) -> Result<Matrix, ImportError> {
    let m = numbers::<12>(node, "matrix", way)?;
    Ok([0, 4, 8].map(|k| [m[k], m[k + 1], m[k + 2], m[k + 3]]))
}

/// What the second one does, and then the first one.
fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let linear: f64 = (0..3).map(|k| a[i][k] * b[k][j]).sum();
            linear + if j == 3 { a[i][3] } else { 0.0 }
        })
    })
}

/// The calls that place a shape, whose own point is the matrix times that of the scene.
fn placed(m: &Matrix) -> String {
    let column = |j: usize| [m[0][j], m[1][j], m[2][j]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (x, y, z) = (column(0), column(1), column(2));
    let cross = [
        x[1] * y[2] - x[2] * y[1],
        x[2] * y[0] - x[0] * y[2],
        x[0] * y[1] - x[1] * y[0],
    ];
    let near = |a: f64, b: f64| (a - b).abs() < 1e-5;
    let is_rigid = [x, y, z].iter().all(|c| near(dot(*c, *c), 1.0))
        && [dot(x, y), dot(x, z), dot(y, z)]
            .iter()
            .all(|d| near(*d, 0.0))
        && near(dot(cross, z), 1.0);
    if !is_rigid {
        // its values stay what they are, as in its program: how fast they change is found
        let row = |r: &[f64; 4]| {
            format!(
                "{} * p.x + {} * p.y + {} * p.z + {}",
                number(r[0]),
                number(r[1]),
                number(r[2]),
                number(r[3])
            )
        };
        return format!(
            ".map(lambda p: vec3({}, {}, {}))",
            row(&m[0]),
            row(&m[1]),
            row(&m[2])
        );
    }
    let mut text = String::new();
    // the turn that undoes the matrix: its axis and angle are those of the transposed one
    let (cosine, axis) = (
        0.5 * (x[0] + y[1] + z[2] - 1.0),
        [m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]],
    );
    let sine = 0.5 * dot(axis, axis).sqrt();
    let angle = sine.atan2(cosine).to_degrees();
    if angle > 1e-4 {
        let axis = if sine > 1e-4 {
            axis.map(|a| a / (2.0 * sine))
        } else {
            half_turn(m)
        };
        let _ = write!(
            text,
            ".turn(axis = ({}, {}, {}), angle = {})",
            number(axis[0]),
            number(axis[1]),
            number(axis[2]),
            number(angle)
        );
    }
    let t = column(3);
    let moved = [-dot(x, t), -dot(y, t), -dot(z, t)].map(|v| if v == 0.0 { 0.0 } else { v });
    if moved != [0.0; 3] {
        let _ = write!(
            text,
            ".move(({}, {}, {}))",
            number(moved[0]),
            number(moved[1]),
            number(moved[2])
        );
    }
    text
}

/// The axis of half a turn: the matrix is 2 a a^T - 1.
fn half_turn(m: &Matrix) -> [f64; 3] {
    let k = (0..3)
        .max_by(|i, j| m[*i][*i].total_cmp(&m[*j][*j]))
        .unwrap_or(0);
    let mut axis = [m[0][k], m[1][k], m[2][k]].map(|v| 0.5 * v);
    axis[k] += 0.5;
    let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt().max(1e-9);
    axis.map(|a| a / length)
}

/// The shortest text of a number, as far as single precision has it: what the file holds is that.
fn number(x: f64) -> String {
    let x = x as f32;
    if x == 0.0 {
        "0".into()
    } else if x.fract() == 0.0 && x.abs() < 1e6 {
        format!("{}", x as i64)
    } else {
        format!("{x:?}")
    }
}
