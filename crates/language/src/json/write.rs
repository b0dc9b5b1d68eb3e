//! From a scene to JSON.

use super::formula::{each_formula_mut, write_colour};
use super::{NAME, VERSION, angle_name};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::collections::HashMap;
use std::convert::Infallible;
use std::sync::Arc;
use zeroset_catalogue::{Info, Kind, Unit};
use zeroset_field::field::{Field, Node, Paint};
use zeroset_field::placement::Placement;
use zeroset_field::sampled::Source;
use zeroset_scene::camera::{Camera, Lens, degrees_of};
use zeroset_scene::material::{Material, Pattern, formulas};
use zeroset_scene::scene::Scene;

/// Levels of a field that are written into each other; what lies deeper becomes a part of its own.
const DEPTH: u32 = 12;

/// Why a scene cannot be written as JSON. Scenes that were loaded can.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this scene cannot be written as JSON: {reason}")]
pub struct ExpandError {
    /// Which number it is, and what is allowed.
    pub reason: String,
}

impl ExpandError {
    fn new(reason: impl Into<String>) -> ExpandError {
        let reason = reason.into();
        ExpandError { reason }
    }
}

/// The scene as JSON: everything that it is, every number exact.
///
/// # Errors
/// A number that is not finite, or a field of samples that come from no file, which JSON has no word for.
pub fn expand(scene: &Scene) -> Result<Value, ExpandError> {
    let mut writer = Writer::default();
    (scene.objects().iter()).for_each(|object| writer.count(&object.field));
    for formula in formulas(scene.materials()) {
        (formula.fields().iter()).for_each(|inner| writer.count(inner.field()));
    }
    if writer.has_samples {
        return Err(ExpandError::new(
            "a field of samples that come from no file has no word there",
        ));
    }
    let objects: Vec<Value> = (scene.objects().iter())
        .map(|object| {
            let mut out = Map::new();
            out.insert("name".into(), json!(object.name));
            out.insert("field".into(), writer.field(&object.field, 0));
            out.insert("material".into(), json!(object.material));
            if let Some(occlusion) = &object.occlusion {
                out.insert("ao".into(), plain(occlusion));
            }
            Value::Object(out)
        })
        .collect();
    let materials: Vec<Value> = (scene.materials().iter())
        .map(|material| writer.material(material))
        .collect();
    let mut out = Map::new();
    out.insert(NAME.into(), json!(VERSION));
    out.insert("name".into(), json!(scene.name()));
    if !writer.parts.is_empty() {
        out.insert("parts".into(), Value::Array(writer.parts));
    }
    out.insert("objects".into(), Value::Array(objects));
    out.insert("materials".into(), Value::Array(materials));
    out.insert("lights".into(), plain(scene.lights()));
    out.insert("sky".into(), plain(scene.sky()));
    if let Some(environment) = scene.environment() {
        out.insert("environment".into(), plain(environment));
    }
    out.insert("camera".into(), camera(scene.camera()));
    out.insert("settings".into(), plain(scene.settings()));
    let out = Value::Object(out);
    // nothing in a scene is written as null but a number that is not finite
    match null(&out) {
        Some(path) => Err(ExpandError::new(format!("{path} is not a finite number"))),
        None => Ok(out),
    }
}

/// Where there is a null in a value.
fn null(value: &Value) -> Option<String> {
    match value {
        Value::Null => Some(String::new()),
        Value::Array(items) => {
            (items.iter().enumerate()).find_map(|(i, v)| Some(format!("[{i}]{}", null(v)?)))
        }
        Value::Object(map) => (map.iter()).find_map(|(key, v)| {
            let inner = null(v)?;
            let dot = if inner.is_empty() || inner.starts_with('[') {
                ""
            } else {
                "."
            };
            Some(format!("{key}{dot}{inner}"))
        }),
        _ => None,
    }
}

/// Data without fields. What cannot be written becomes null, which is found.
fn plain(data: &(impl Serialize + ?Sized)) -> Value {
    serde_json::to_value(data).unwrap_or_default()
}

fn camera(camera: &Camera) -> Value {
    let mut out = Map::new();
    out.insert("eye".into(), plain(&camera.eye));
    let axes = [camera.axes.x_axis, camera.axes.y_axis, camera.axes.z_axis];
    out.insert("axes".into(), plain(&axes));
    match camera.lens {
        Lens::Pinhole { fov } => out.insert("fov".into(), json!(degrees_of(fov))),
        Lens::Orthographic { height } => out.insert("height".into(), json!(height)),
    };
    out.insert("near".into(), json!(camera.near));
    out.insert("far".into(), json!(camera.far));
    if camera.aperture > 0.0 {
        out.insert("aperture".into(), json!(camera.aperture));
        out.insert("focus".into(), json!(camera.focus));
    }
    Value::Object(out)
}

/// The degrees that become exactly these radians, if there are any: near the nominal ones, the shortest.
pub(super) fn exact_degrees(radians: f64) -> Option<f64> {
    let near = radians.to_degrees();
    let (mut low, mut high, mut best) = (near, near, None::<f64>);
    let mut consider = |d: f64| {
        let shorter = |b: f64| format!("{d}").len() < format!("{b}").len();
        if d.to_radians().to_bits() == radians.to_bits() && best.is_none_or(shorter) {
            best = Some(d);
        }
    };
    consider(near);
    for _ in 0..4 {
        (low, high) = (low.next_down(), high.next_up());
        consider(low);
        consider(high);
    }
    best
}

#[derive(Default)]
struct Writer {
    /// How often each node is used, and how deep the tree below it is.
    uses: HashMap<usize, u32>,
    /// Parts written already, by node.
    places: HashMap<usize, usize>,
    parts: Vec<Value>,
    /// Whether any node is a grid of samples that come from no file.
    has_samples: bool,
}

impl Writer {
    /// Counts the uses of every node below.
    fn count(&mut self, field: &Field) {
        let uses = self.uses.entry(field.key()).or_default();
        *uses += 1;
        if *uses == 1 {
            // those of a file are told by its name
            self.has_samples |=
                matches!(field.node(), Node::Sampled(samples) if samples.source().is_none());
            field.children().iter().for_each(|c| self.count(c));
        }
    }

    /// A material with its formulas.
    fn material(&mut self, material: &Material) -> Value {
        let mut out = plain(material);
        for (name, pattern) in material.patterns() {
            let mut formulas = Vec::new();
            // those of a pattern are told in the order in which they stand
            let _ = pattern
                .clone()
                .each_mut(&mut |part| -> Result<(), Infallible> {
                    if let Pattern::Formula { formula } = part {
                        formulas.push(Arc::clone(formula));
                    }
                    Ok(())
                });
            let mut formulas = formulas.into_iter();
            let Some(value) = out.get_mut(name) else {
                continue;
            };
            each_formula_mut(value, &mut |body| {
                let Some(formula) = formulas.next() else {
                    return;
                };
                body.append(&mut write_colour(&formula));
                if !formula.fields().is_empty() {
                    let fields = formula.fields().iter();
                    let fields = fields.map(|inner| self.field(inner.field(), 0));
                    body.insert("of".into(), fields.collect());
                }
            });
        }
        out
    }

    /// A field, `level` levels inside of the part or object that holds it.
    fn field(&mut self, field: &Field, level: u32) -> Value {
        let key = field.key();
        if let Some(place) = self.places.get(&key) {
            return json!({ "part": place });
        }
        let shared = self.uses.get(&key).is_some_and(|n| *n > 1);
        if shared || level >= DEPTH {
            let value = self.node(field, 0);
            self.places.insert(key, self.parts.len());
            self.parts.push(value);
            return json!({ "part": self.parts.len() - 1 });
        }
        self.node(field, level)
    }

    fn node(&mut self, field: &Field, level: u32) -> Value {
        let mut of = |shape: &Field| self.field(shape, level + 1);
        let (name, body) = match field.node() {
            Node::Primitive { entry, params } => (entry.info.name, parameters(&entry.info, params)),
            Node::Map {
                entry,
                params,
                shape,
            } => {
                let mut body = parameters(&entry.info, params);
                body.insert("of".into(), of(shape));
                (entry.info.name, body)
            }
            Node::Modify {
                entry,
                params,
                shape,
            } => {
                let mut body = parameters(&entry.info, params);
                body.insert("of".into(), of(shape));
                (entry.info.name, body)
            }
            Node::Join {
                entry,
                params,
                shapes,
            } => {
                let mut body = parameters(&entry.info, params);
                body.insert("of".into(), shapes.iter().map(of).collect());
                (entry.info.name, body)
            }
            Node::Place { placement, shape } => ("place", place(placement, of(shape))),
            Node::Repeat { repetition, shape } => {
                let mut body = Map::new();
                body.insert("spacing".into(), json!(repetition.spacing));
                body.insert("count".into(), json!(repetition.count));
                body.insert("vary".into(), json!(repetition.vary));
                body.insert("seed".into(), json!(repetition.seed));
                body.insert("of".into(), of(shape));
                ("repeat", body)
            }
            Node::Polar { polar, shape } => {
                let mut body = Map::new();
                body.insert("count".into(), json!(polar.count));
                body.insert("of".into(), of(shape));
                ("polar", body)
            }
            Node::Paint { paint, shape } => {
                let mut body = Map::new();
                match paint {
                    Paint::Material(number) => body.insert("material".into(), json!(number)),
                    Paint::Object(number) => body.insert("object".into(), json!(number)),
                };
                body.insert("of".into(), of(shape));
                ("paint", body)
            }
            Node::Formula(formula) => {
                let mut body = super::formula::write(formula);
                if !formula.fields().is_empty() {
                    let fields = formula.fields().iter().map(|f| of(f.field()));
                    body.insert("of".into(), fields.collect());
                }
                ("formula", body)
            }
            Node::Sampled(samples) => match samples.source() {
                Some(source) => of_file(source),
                // refused before: see `expand`
                None => return Value::Null,
            },
            Node::Sided(_) => return Value::Null,
        };
        json!({ name: body })
    }
}

/// Samples of a file.
fn of_file(source: &Source) -> (&'static str, Map<String, Value>) {
    let mut body = Map::new();
    let name = match source {
        Source::Mesh { file, voxels, sign } => {
            body.insert("file".into(), json!(file));
            body.insert("voxels".into(), json!(voxels));
            body.insert("sign".into(), json!(sign));
            "mesh"
        }
        Source::Grid { file } => {
            body.insert("file".into(), json!(file));
            "grid"
        }
        Source::Image { file, width, level } => {
            body.insert("file".into(), json!(file));
            body.insert("width".into(), json!(width));
            body.insert("level".into(), json!(level));
            "image_shape"
        }
    };
    (name, body)
}

fn place(placement: &Placement, of: Value) -> Map<String, Value> {
    let mut body = Map::new();
    body.insert("offset".into(), json!(placement.offset));
    if placement.turns {
        body.insert("rotation".into(), json!(placement.rotation));
    }
    if placement.scales {
        body.insert("scale".into(), json!(placement.scale));
    }
    body.insert("of".into(), of);
    body
}

/// The parameter array of a catalogue entry by names.
fn parameters(info: &Info, params: &[f64]) -> Map<String, Value> {
    let (mut out, mut rest) = (Map::new(), params);
    for param in info.params {
        let mut take = |n: usize| {
            let (head, tail) = rest.split_at(n.min(rest.len()));
            rest = tail;
            head
        };
        let width = match param.kind {
            Kind::List(width) => width,
            kind => kind.len(),
        };
        let items = match param.kind {
            Kind::List(width) => {
                let count = take(1).first().map_or(0, |n| *n as usize);
                take(count * width)
            }
            _ => take(width),
        };
        let degrees = super::is_angle(param.unit)
            .then(|| {
                items
                    .iter()
                    .map(|x| exact_degrees(*x))
                    .collect::<Option<Vec<f64>>>()
            })
            .flatten();
        let name = match degrees {
            None if super::is_angle(param.unit) => angle_name(param.name),
            _ => param.name.to_string(),
        };
        let numbers = degrees.as_deref().unwrap_or(items);
        let number = |x: &f64| {
            if param.unit == Unit::Count {
                json!(*x as i64)
            } else {
                json!(x)
            }
        };
        let value = match param.kind {
            Kind::Number => numbers.first().map_or(Value::Null, number),
            Kind::Vec2 | Kind::Vec3 | Kind::List(1) => numbers.iter().map(number).collect(),
            Kind::List(width) => numbers
                .chunks(width)
                .map(|c| c.iter().map(number).collect::<Value>())
                .collect(),
        };
        out.insert(name, value);
    }
    out
}

/// JSON as text for people: what fits into a line stands in a line.
pub fn to_text(value: &Value) -> String {
    let mut out = String::new();
    write_text(value, 0, &mut out);
    out.push('\n');
    out
}

const LINE: usize = 110;

fn write_text(value: &Value, indent: usize, out: &mut String) {
    let flat = |value: &Value| spaced(value);
    let fits = |text: &str| indent + text.len() <= LINE;
    let (open, close, items): (char, char, Vec<(String, &Value)>) = match value {
        Value::Array(items) => ('[', ']', items.iter().map(|v| (String::new(), v)).collect()),
        Value::Object(map) => {
            let named = map
                .iter()
                .map(|(k, v)| (format!("{}: ", Value::from(k.as_str())), v));
            ('{', '}', named.collect())
        }
        other => return out.push_str(&other.to_string()),
    };
    // text of a large value is not made only to find that it does not fit
    if size(value, LINE) <= LINE {
        let text = flat(value);
        if fits(&text) {
            return out.push_str(&text);
        }
    }
    out.push(open);
    let count = items.len();
    for (i, (name, item)) in items.into_iter().enumerate() {
        out.push('\n');
        out.push_str(&" ".repeat(indent + 2));
        out.push_str(&name);
        write_text(item, indent + 2, out);
        if i + 1 < count {
            out.push(',');
        }
    }
    out.push('\n');
    out.push_str(&" ".repeat(indent));
    out.push(close);
}

/// A lower bound of a value's length as text, exact enough beyond `limit`.
fn size(value: &Value, limit: usize) -> usize {
    let mut total = 2;
    let mut add = |v: &Value, extra: usize| {
        if total <= limit {
            total += size(v, limit - total.min(limit)) + extra;
        }
    };
    match value {
        Value::Array(items) => items.iter().for_each(|v| add(v, 1)),
        Value::Object(map) => map.iter().for_each(|(k, v)| add(v, k.len() + 3)),
        Value::String(s) => total += s.len(),
        _ => total = 1,
    }
    total
}

/// A value on one line, with spaces after commas and colons.
fn spaced(value: &Value) -> String {
    match value {
        Value::Array(items) => format!(
            "[{}]",
            items.iter().map(spaced).collect::<Vec<_>>().join(", ")
        ),
        Value::Object(map) => {
            let pairs = map
                .iter()
                .map(|(k, v)| format!("{}: {}", Value::from(k.as_str()), spaced(v)));
            format!("{{{}}}", pairs.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}
