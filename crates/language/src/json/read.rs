//! From JSON to a scene.

use super::formula::{COLOUR_MEMBERS, each_formula, each_formula_mut};
use super::parse::parse;
use super::valid;
use super::{JsonStep, KEY, NAME, Problem, Read, VERSION, angle_name, is_angle, problem};
use crate::assets::Assets;
use crate::budget::LoadBudget;
use crate::draft::{CameraDraft, Draft, Focus};
use crate::files::Reading;
use crate::framing;
use crate::images;
use crate::limits::Limits;
use crate::naming::shortened;
use crate::report::{Report, Source, suggestion};
use crate::sampled;
use crate::starlark::{direction_of_word, spoken};
use glam::{DMat3, DVec3};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::sync::Arc;
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::{Dimension, Info, Kind, LARGE, Param, SMALL, Unit};
use zeroset_field::field::{Field, FieldError, Paint};
use zeroset_field::formula::ColourFormula;
use zeroset_field::placement::Placement;
use zeroset_field::repetition::{Polar, Repetition};
use zeroset_field::sampled::Source as SampledSource;
use zeroset_scene::colour;
use zeroset_scene::environment::{Environment, Surroundings};
use zeroset_scene::light::{Light, Sky};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::scene::Object;
use zeroset_scene::settings::{Occlusion, Settings};
use zeroset_volume::bake::Bake;

type Members = Map<String, Value>;

/// Reads a scene into an empty draft, whose first source is its text.
pub(crate) fn read(draft: &mut Draft, limits: &Limits) -> Result<(), Box<Report>> {
    let source = draft.sources[0].clone();
    let value = parse(&source, &mut draft.files.budget)?;
    let mut reader = Reader {
        parts: Vec::new(),
        nodes: 0,
        visits: 0,
        materials: 0,
        limits: *limits,
        budget: draft.files.budget,
        files: None,
    };
    let result = reader.scene(&value, draft, &source);
    // also where the scene is refused: what it asked for is watched
    if let Some(files) = reader.files.take() {
        draft.files = files;
    }
    result.map_err(|p| Box::new(p.report(&source)))
}

/// Fields, references to parts and materials between two looks at the clock.
const CLOCK: u64 = 64;

struct Reader {
    parts: Vec<Field>,
    nodes: u64,
    /// What was read so far, for the clock.
    visits: u64,
    /// Number of materials.
    materials: usize,
    limits: Limits,
    /// For the clock; what is held is charged to that of the draft.
    budget: LoadBudget,
    /// The draft's, while fields are read.
    files: Option<Reading>,
}

/// The members of an object, none of them unknown.
fn members<'v>(value: &'v Value, what: &str, names: &[&str]) -> Read<&'v Members> {
    let map = value
        .as_object()
        .ok_or_else(|| problem(format!("{what} must be an object")))?;
    for key in map.keys() {
        if !names.contains(&key.as_str()) {
            let help = suggestion(key, names.iter().copied());
            return Err(problem(format!("{what} has no `{}`", shortened(key, KEY)))
                .maybe_help(help)
                .at(key));
        }
    }
    Ok(map)
}

fn list<'v>(value: &'v Value, what: &str) -> Read<&'v Vec<Value>> {
    value
        .as_array()
        .ok_or_else(|| problem(format!("{what} must be a list")))
}

fn number(value: &Value) -> Read<f64> {
    let x = value.as_f64().filter(|x| x.is_finite());
    x.ok_or_else(|| problem("this must be a number"))
}

/// A number that is kept in single precision: its range is one of such numbers.
fn single(min: f32, max: f32) -> impl Fn(&Value) -> Read<f64> {
    move |v: &Value| {
        let x = number(v)?;
        if (min..=max).contains(&(x as f32)) {
            return Ok(x);
        }
        Err(problem(format!(
            "this is {}, allowed is {min:e} to {max:e}",
            spoken(x)
        )))
    }
}

/// A name of something.
fn name(value: &Value, limits: &Limits) -> Read<String> {
    let text = value.as_str();
    let text = text.ok_or_else(|| problem("this must be a text"))?;
    limits.check_name(text).map_err(problem)?;
    Ok(text.to_string())
}

fn count(value: &Value, max: u32) -> Read<u32> {
    let n = value.as_u64().filter(|n| *n <= u64::from(max));
    n.map(|n| n as u32)
        .ok_or_else(|| problem(format!("this must be a whole number from 0 to {max}")))
}

fn array<T: Copy + Default, const N: usize>(
    value: &Value,
    each: impl Fn(&Value) -> Read<T>,
) -> Read<[T; N]> {
    let items = value.as_array().filter(|items| items.len() == N);
    let items = items.ok_or_else(|| problem(format!("this must be a list of {N}")))?;
    let mut out = [T::default(); N];
    for (i, (slot, item)) in out.iter_mut().zip(items).enumerate() {
        *slot = each(item).map_err(|p| p.within(JsonStep::Index(i)))?;
    }
    Ok(out)
}

/// A member, read, or `None` where there is none.
fn member<T>(map: &Members, key: &str, read: impl FnOnce(&Value) -> Read<T>) -> Read<Option<T>> {
    map.get(key)
        .map(|v| read(v).map_err(|p| p.at(key)))
        .transpose()
}

/// Data that needs no more than its types; colours may be texts.
fn data<T: DeserializeOwned>(value: &Value) -> Read<T> {
    let mut value = value.clone();
    colours(&mut value, false)?;
    serde_path_to_error::deserialize(value).map_err(|e| {
        let path = e.path().iter().filter_map(|segment| match segment {
            serde_path_to_error::Segment::Seq { index } => Some(JsonStep::Index(*index)),
            serde_path_to_error::Segment::Map { key } => Some(JsonStep::Key(key.clone())),
            _ => None,
        });
        Box::new(Problem {
            message: e.inner().to_string(),
            help: None,
            path: path.collect(),
        })
    })
}

/// Keys whose values are colours.
const COLOURS: [&str; 8] = [
    "colour", "colours", "emission", "radiance", "top", "horizon", "bottom", "ground",
];

/// Replaces colours that are texts by their linear numbers.
fn colours(value: &mut Value, is_colour: bool) -> Read<()> {
    match value {
        Value::String(text) if is_colour => {
            let srgb = crate::colour::parse(text).map_err(|reason| {
                let text = shortened(text, KEY);
                problem(format!("\"{text}\" is no colour: {reason}"))
            })?;
            *value = serde_json::json!(colour::linear(srgb));
        }
        Value::Array(items) => {
            for (i, item) in items.iter_mut().enumerate() {
                colours(item, is_colour).map_err(|p| p.within(JsonStep::Index(i)))?;
            }
        }
        Value::Object(map) => {
            for (key, item) in map.iter_mut() {
                colours(item, COLOURS.contains(&key.as_str())).map_err(|p| p.at(key))?;
            }
        }
        _ => {}
    }
    Ok(())
}

impl Reader {
    fn scene(&mut self, value: &Value, draft: &mut Draft, source: &Source) -> Read<()> {
        let names = [
            NAME,
            "name",
            "parts",
            "objects",
            "materials",
            "lights",
            "sky",
            "environment",
            "camera",
            "settings",
        ];
        let map = members(value, "a scene", &names)?;
        match map.get(NAME).and_then(Value::as_u64) {
            Some(VERSION) => {}
            Some(other) => {
                let p = problem(format!(
                    "this is version {other} of the format, known is {VERSION}"
                ));
                return Err(p.at(NAME));
            }
            None => {
                return Err(problem(format!(
                    "a scene begins with \"{NAME}\": {VERSION}"
                )));
            }
        }
        let limits = self.limits;
        draft.name = member(map, "name", |v| name(v, &limits))?;
        let materials = member(map, "materials", |v| {
            let items = list(v, "materials")?;
            valid::count_materials(items.len())?;
            let each = |(i, v)| {
                self.tick()
                    .and_then(|()| self.material(v, draft))
                    .map_err(|p| p.within(JsonStep::Index(i)))
            };
            items
                .iter()
                .enumerate()
                .map(each)
                .collect::<Read<Vec<Material>>>()
        })?;
        draft.materials = materials.unwrap_or_default();
        self.materials = draft.materials.len();
        let none = Reading::new(None, 0, self.budget, &Assets::default());
        self.files = Some(std::mem::replace(&mut draft.files, none));
        member(map, "parts", |v| {
            for (i, part) in list(v, "parts")?.iter().enumerate() {
                let field = self.field(part).map_err(|p| p.within(JsonStep::Index(i)))?;
                self.parts.push(field);
            }
            Ok(())
        })?;
        member(map, "materials", |v| {
            let materials = list(v, "materials")?.iter().zip(&mut draft.materials);
            for (i, (v, material)) in materials.enumerate() {
                self.formulas(v, material)
                    .map_err(|p| p.within(JsonStep::Index(i)))?;
            }
            Ok(())
        })?;
        let objects = member(map, "objects", |v| {
            let items = list(v, "objects")?;
            let most = limits.objects.min(u64::from(u16::MAX));
            if items.len() as u64 > most {
                return Err(problem(format!(
                    "{} objects, at most {most} are allowed (limit `objects`)",
                    items.len()
                )));
            }
            let starts = super::locate::items(&source.text, "objects");
            let each = |(i, v): (usize, &Value)| {
                let start = starts.get(i).map_or(0, |at| *at as usize);
                let (line, column) = source.position(start);
                let place = Some((source.name.clone(), line as u32, column as u32));
                self.object(v, i, place)
                    .map_err(|p| p.within(JsonStep::Index(i)))
            };
            items
                .iter()
                .enumerate()
                .map(each)
                .collect::<Read<Vec<Object>>>()
        })?;
        draft.objects = objects.unwrap_or_default();
        let written = map.get("objects").and_then(Value::as_array);
        draft.plain = (written
            .into_iter()
            .flatten()
            .zip(&draft.objects)
            .enumerate())
        .filter(|(_, (v, o))| v.get("material").is_none() && o.field.facts().materials == 0)
        .map(|(i, _)| i)
        .collect();
        if let Some(files) = self.files.take() {
            draft.files = files;
        }
        if draft.objects.is_empty() {
            return Err(problem("the scene shows nothing")
                .help("an object is {\"field\": {\"sphere\": {}}}"));
        }
        if draft
            .objects
            .iter()
            .any(|o| usize::from(o.material) >= draft.materials.len())
        {
            // only the default, 0, of a scene that lists no materials
            draft.materials.push(Material::default());
        }
        let lights = member(map, "lights", |v| {
            valid::count_lights(list(v, "lights")?.len())?;
            let each = |(i, v)| {
                let light: Light = data(v).map_err(|p| p.within(JsonStep::Index(i)))?;
                valid::light(&light).map_err(|p| p.within(JsonStep::Index(i)))?;
                Ok(light)
            };
            list(v, "lights")?
                .iter()
                .enumerate()
                .map(each)
                .collect::<Read<Vec<Light>>>()
        })?;
        draft.lights = lights;
        draft.sky = member(map, "sky", |v| {
            let sky: Sky = data(v)?;
            valid::sky(&sky)?;
            Ok(sky)
        })?;
        draft.settings = member(map, "settings", |v| {
            let settings: Settings = data(v)?;
            valid::settings(&settings, &limits)?;
            Ok(settings)
        })?;
        draft.environment = member(map, "environment", |v| {
            let mut environment: Environment = data(v)?;
            if let Surroundings::Image { image } = &mut environment.source {
                let loaded = images::load(&mut draft.files, &image.path, &self.limits);
                *image = loaded.map_err(|m| problem(m).at("path").at("image").at("source"))?;
            }
            valid::environment(&environment)?;
            Ok(environment)
        })?;
        draft.view = member(map, "camera", camera)?;
        Ok(())
    }

    fn material(&self, value: &Value, draft: &mut Draft) -> Read<Material> {
        let mut bare = value.clone();
        each_formula_mut(&mut bare, &mut |body| {
            for name in COLOUR_MEMBERS {
                body.remove(name);
            }
        });
        let mut material: Material = data(&bare)?;
        valid::material(&material)?;
        for (name, pattern) in material.patterns_mut() {
            pattern.images_mut(&mut |image| -> Read<()> {
                let loaded = images::load(&mut draft.files, &image.path, &self.limits);
                *image = loaded.map_err(|m| problem(m).at("path").at("image").at(name))?;
                Ok(())
            })?;
        }
        Ok(material)
    }

    /// Brings the formulas of materials, which may use parts.
    fn formulas(&mut self, value: &Value, material: &mut Material) -> Read<()> {
        for (name, pattern) in material.patterns_mut() {
            let (value, mut way) = match name {
                "bump" => (
                    value.get(name).and_then(|bump| bump.get("pattern")),
                    vec![JsonStep::Key(name.into()), JsonStep::Key("pattern".into())],
                ),
                _ => (value.get(name), vec![JsonStep::Key(name.into())]),
            };
            let Some(value) = value else { continue };
            let mut read = Vec::new();
            each_formula(value, &mut way, &mut |way, body| {
                let formula = self
                    .colour_formula(body)
                    .map_err(|p| (way.iter().rev()).fold(p, |p, step| p.within(step.clone())))?;
                read.push(Arc::new(formula));
                Ok(())
            })?;
            let mut read = read.into_iter();
            pattern.each_mut(&mut |part| -> Read<()> {
                if let Pattern::Formula { formula } = part
                    && let Some(read) = read.next()
                {
                    *formula = read;
                }
                Ok(())
            })?;
        }
        Ok(())
    }

    fn colour_formula(&mut self, body: &Map<String, Value>) -> Read<ColourFormula> {
        self.check_clock()?;
        let fields = match body.get("of") {
            Some(of) => self.all_of(Some(of), "formula")?,
            None => Vec::new(),
        };
        super::formula::read_colour(body, &fields)
    }

    fn object(
        &mut self,
        value: &Value,
        number: usize,
        place: Option<(String, u32, u32)>,
    ) -> Read<Object> {
        let map = members(value, "an object", &["name", "field", "material", "ao"])?;
        let field = map
            .get("field")
            .ok_or_else(|| problem("an object needs a `field`"))?;
        let field = self.field(field).map_err(|p| p.at("field"))?;
        if field.facts().dimension == Dimension::Two {
            let p = problem("a plane shape has no surface to show").at("field");
            return Err(p.help("make a solid of it with \"extrude\" or \"revolve\""));
        }
        let name = member(map, "name", |v| name(v, &self.limits))?;
        let material = member(map, "material", |v| self.material_number(v))?.unwrap_or(0);
        let occlusion = member(map, "ao", |v| {
            let occlusion: Occlusion = data(v)?;
            valid::occlusion(&occlusion, &self.limits)?;
            Ok(occlusion)
        })?;
        Ok(Object {
            name: name.unwrap_or_else(|| (number + 1).to_string()),
            field,
            material,
            occlusion,
            place,
        })
    }

    fn material_number(&self, value: &Value) -> Read<u16> {
        let number = count(value, u32::from(u16::MAX))?;
        if number as usize >= self.materials.max(1) {
            return Err(problem(format!(
                "there is no material {number}, the scene has {}",
                self.materials
            )));
        }
        Ok(number as u16)
    }

    fn field(&mut self, value: &Value) -> Read<Field> {
        self.tick()?;
        let map = value
            .as_object()
            .filter(|m| m.len() == 1)
            .and_then(|m| m.iter().next());
        let (name, body) = map.ok_or_else(|| {
            problem("a field is an object with one key, the name of what it is")
                .help("such as {\"sphere\": {\"radius\": 1}}")
        })?;
        if name == "part" {
            let place = body
                .as_u64()
                .ok_or_else(|| problem("this must be the number of a part").at("part"))?;
            let count = self.parts.len();
            let part = usize::try_from(place)
                .ok()
                .and_then(|i| self.parts.get(i))
                .cloned();
            let help = "a part must stand before whatever uses it";
            return part.ok_or_else(|| {
                problem(format!("there is no part {place} among the {count} before"))
                    .help(help)
                    .at("part")
            });
        }
        self.nodes += 1;
        if self.nodes > self.limits.nodes {
            return Err(problem(format!(
                "the scene has more than {} fields (limit `nodes`)",
                self.limits.nodes
            )));
        }
        let field = self.node(name, body).map_err(|p| p.at(name))?;
        if field.facts().nodes > self.limits.nodes {
            let nodes = field.facts().nodes;
            let message =
                format!("this field has {nodes} nodes (a shape used twice counts twice), at most");
            return Err(problem(format!(
                "{message} {} are allowed (limit `nodes`)",
                self.limits.nodes
            ))
            .at(name));
        }
        Ok(field)
    }

    /// Asks the clock now and then.
    fn tick(&mut self) -> Read<()> {
        self.visits += 1;
        if self.visits.is_multiple_of(CLOCK) {
            self.check_clock()?;
        }
        Ok(())
    }

    fn check_clock(&self) -> Read<()> {
        self.budget
            .check_clock()
            .map_err(|e| problem(e.to_string()))
    }

    fn node(&mut self, name: &str, body: &Value) -> Read<Field> {
        let all = catalogue();
        let made = |result: Result<Field, FieldError>| result.map_err(|e| problem(e.to_string()));
        if let Some(entry) = all.primitive(name) {
            let params = parameters(&entry.info, body, false)?;
            return made(Field::primitive(entry, params));
        }
        if let Some(entry) = all.map(name) {
            let (params, of) = (parameters(&entry.info, body, true)?, self.of(body)?);
            return made(of.map(entry, params));
        }
        if let Some(entry) = all.modifier(name) {
            let (params, of) = (parameters(&entry.info, body, true)?, self.of(body)?);
            return made(of.modify(entry, params));
        }
        if let Some(entry) = all.join(name) {
            let params = parameters(&entry.info, body, true)?;
            let shapes = self.all_of(body.get("of"), name)?;
            return made(Field::join(entry, params, shapes));
        }
        match name {
            "place" => {
                let map = members(body, "place", &["offset", "rotation", "scale", "of"])?;
                let rotation = member(map, "rotation", |v| {
                    array(v, |row| array::<f64, 3>(row, number))
                })?;
                if let Some(rows) = rotation {
                    rigid(&rows).map_err(|p| p.at("rotation"))?;
                }
                let scale = member(map, "scale", number)?;
                let identity = Placement::IDENTITY;
                let placement = Placement {
                    rotation: rotation.unwrap_or(identity.rotation),
                    scale: scale.unwrap_or(1.0),
                    offset: member(map, "offset", |v| array(v, single(f32::MIN, f32::MAX)))?
                        .unwrap_or_default(),
                    turns: rotation.is_some(),
                    scales: scale.is_some(),
                };
                made(self.of(body)?.place(placement))
            }
            "repeat" => {
                let map = members(body, "repeat", &["spacing", "count", "vary", "seed", "of"])?;
                let repetition = Repetition {
                    spacing: member(map, "spacing", |v| array(v, number))?.unwrap_or_default(),
                    count: member(map, "count", |v| array(v, |v| count(v, u32::MAX)))?
                        .unwrap_or_default(),
                    vary: member(map, "vary", |v| array(v, number))?.unwrap_or_default(),
                    seed: member(map, "seed", |v| count(v, u32::MAX))?.unwrap_or_default(),
                };
                made(self.of(body)?.repeat(repetition))
            }
            "polar" => {
                let map = members(body, "polar", &["count", "of"])?;
                let polar = Polar {
                    count: member(map, "count", |v| count(v, u32::MAX))?.unwrap_or_default(),
                };
                made(self.of(body)?.polar(polar))
            }
            "paint" => {
                let map = members(body, "paint", &["material", "object", "of"])?;
                let material =
                    member(map, "material", |v| self.material_number(v))?.map(Paint::Material);
                let object = member(map, "object", |v| count(v, u32::from(u16::MAX)))?
                    .map(|n| Paint::Object(n as u16));
                let paint = material
                    .or(object)
                    .ok_or_else(|| problem("paint needs a `material`"))?;
                made(self.of(body)?.paint(paint))
            }
            "formula" => {
                let known = ["steps", "bounds", "slope", "proven", "plane", "of"];
                let map = members(body, "formula", &known)?;
                let fields = match map.get("of") {
                    Some(of) => self.all_of(Some(of), name)?,
                    None => Vec::new(),
                };
                // a proof takes up to a tenth of a second
                self.check_clock()?;
                let formula = super::formula::read(map, &fields)?;
                made(Field::formula(Arc::new(formula)))
            }
            "mesh" => {
                let map = members(body, "mesh", &["file", "voxels", "sign"])?;
                let file = file(map)?;
                let voxels = member(map, "voxels", |v| count(v, Bake::MOST))?.unwrap_or(64);
                let sign = member(map, "sign", |v| {
                    let known = |word: &&str| sampled::SIGNS.iter().any(|s| s.0 == *word);
                    let word = v.as_str().filter(known);
                    word.map(str::to_owned)
                        .ok_or_else(|| problem("this must be \"auto\", \"parity\" or \"winding\""))
                })?;
                let sign = sign.unwrap_or_else(|| "auto".to_owned());
                self.sampled(&SampledSource::Mesh { file, voxels, sign })
            }
            "grid" => {
                let map = members(body, "grid", &["file"])?;
                self.sampled(&SampledSource::Grid { file: file(map)? })
            }
            "image_shape" => {
                let map = members(body, "image_shape", &["file", "width", "level"])?;
                let within = |least: f64, most: f64| {
                    move |v: &Value| {
                        let x = number(v)?;
                        if (least..=most).contains(&x) {
                            return Ok(x);
                        }
                        let (least, most) = (spoken(least), spoken(most));
                        Err(problem(format!(
                            "this is {}, allowed is {least} to {most}",
                            spoken(x)
                        )))
                    }
                };
                self.sampled(&SampledSource::Image {
                    file: file(map)?,
                    width: member(map, "width", within(SMALL, LARGE))?.unwrap_or(1.0),
                    level: member(map, "level", within(0.001, 0.999))?.unwrap_or(0.5),
                })
            }
            _ => {
                let own = [
                    "place",
                    "repeat",
                    "polar",
                    "paint",
                    "formula",
                    "mesh",
                    "grid",
                    "image_shape",
                    "part",
                ];
                let names: Vec<&str> = all.infos().map(|i| i.name).chain(own).collect();
                let help = suggestion(name, names.iter().copied());
                let name = shortened(name, KEY);
                Err(problem(format!("there is no field `{name}`")).maybe_help(help))
            }
        }
    }

    /// A field of samples.
    fn sampled(&mut self, source: &SampledSource) -> Read<Field> {
        let files = (self.files.as_mut()).ok_or_else(|| problem("no files can be read here"))?;
        let made = sampled::load(files, source, &self.limits);
        let (samples, taken) = made.map_err(|m| problem(m).at("file"))?;
        self.budget.pause(taken);
        Ok(Field::sampled(samples))
    }

    /// The fields under `of`.
    fn all_of(&mut self, of: Option<&Value>, name: &str) -> Read<Vec<Field>> {
        let shapes = of.and_then(Value::as_array);
        let shapes =
            shapes.ok_or_else(|| problem(format!("{name} needs `of`, a list of fields")))?;
        let each = |(i, v)| {
            self.field(v)
                .map_err(|p| p.within(JsonStep::Index(i)).at("of"))
        };
        shapes.iter().enumerate().map(each).collect()
    }

    /// The field under `of`.
    fn of(&mut self, body: &Value) -> Read<Field> {
        let of = body
            .get("of")
            .ok_or_else(|| problem("this needs `of`, a field"))?;
        self.field(of).map_err(|p| p.at("of"))
    }
}

/// The name of the file that a field is made of.
fn file(map: &Members) -> Read<String> {
    let text = |v: &Value| {
        let name = v.as_str().map(str::to_owned);
        name.ok_or_else(|| problem("this must be the name of a file"))
    };
    member(map, "file", text)?.ok_or_else(|| problem("this needs `file`, the name of a file"))
}

/// Whether the rows are those of a rotation or a mirror image.
fn rigid(rows: &[[f64; 3]; 3]) -> Read<()> {
    let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let wanted = |i: usize, j: usize| f64::from(u8::from(i == j));
    let good =
        (0..3).all(|i| (0..3).all(|j| (dot(&rows[i], &rows[j]) - wanted(i, j)).abs() < 1e-6));
    if good {
        Ok(())
    } else {
        Err(problem(
            "the rows must have length 1 and be at right angles to each other",
        ))
    }
}

/// A camera as far as it is stated.
fn camera(value: &Value) -> Read<CameraDraft> {
    let names = [
        "eye", "axes", "target", "up", "fov", "height", "near", "far", "aperture", "focus",
    ];
    let map = members(value, "a camera", &names)?;
    let point = |v: &Value| {
        let single = single(-f32::MAX, f32::MAX);
        array::<f64, 3>(v, single).map(DVec3::from)
    };
    let axes = member(map, "axes", |v| {
        let rows: [[f64; 3]; 3] = array(v, |row| array::<f64, 3>(row, number))?;
        let axes = DMat3::from_cols_array_2d(&rows);
        let error = axes * axes.transpose() - DMat3::IDENTITY;
        if error
            .to_cols_array()
            .iter()
            .any(|e| e.abs() > valid::UPRIGHT)
        {
            return Err(problem(
                "the axes must have length 1 and be at right angles to each other",
            ));
        }
        Ok(axes)
    })?;
    let range = |min: f64, max: f64| {
        move |v: &Value| {
            let x = number(v)?;
            if (min..=max).contains(&x) {
                return Ok(x);
            }
            Err(problem(format!(
                "this is {}, allowed is {} to {}",
                spoken(x),
                spoken(min),
                spoken(max)
            )))
        }
    };
    let default = CameraDraft::default();
    let view = CameraDraft {
        eye: member(map, "eye", point)?,
        target: member(map, "target", point)?,
        up: member(map, "up", point)?.unwrap_or(DVec3::Y),
        direction: None,
        axes,
        fov: member(map, "fov", range(1.0, 170.0))?.map_or(default.fov, f64::to_radians),
        height: member(map, "height", single(valid::HEIGHT.0, valid::HEIGHT.1))?,
        near: member(map, "near", single(0.0, f32::MAX))?.unwrap_or(default.near),
        // where a file states none it follows from the bounds, which may be of any size
        far: member(map, "far", single(0.0, f32::MAX))?,
        aperture: member(map, "aperture", single(0.0, LARGE as f32))?.unwrap_or_default(),
        focus: member(map, "focus", single(SMALL as f32, valid::FAR))?.map(Focus::Distance),
        ..default
    };
    // what cannot be framed is refused here, where its place is known
    framing::camera(&view, std::iter::empty(), [1, 1]).map_err(problem)?;
    Ok(view)
}

/// The parameter array of a catalogue entry, from its parameters by name.
fn parameters(info: &'static Info, body: &Value, has_of: bool) -> Read<Vec<f64>> {
    let map = body
        .as_object()
        .ok_or_else(|| problem("the parameters must be an object such as {\"radius\": 1}"))?;
    let radians = |p: &Param| angle_name(p.name);
    for key in map.keys() {
        let known = |p: &Param| p.name == key || is_angle(p.unit) && radians(p) == *key;
        if !(info.params.iter().any(known) || has_of && key == "of") {
            let names: Vec<&str> = info
                .params
                .iter()
                .map(|p| p.name)
                .chain(has_of.then_some("of"))
                .collect();
            let help = suggestion(key, names.iter().copied());
            let what = shortened(key, KEY);
            return Err(problem(format!("{} has no `{what}`", info.name))
                .maybe_help(help)
                .at(key));
        }
    }
    let mut out = Vec::new();
    for param in info.params {
        let angle = is_angle(param.unit);
        let exact = angle
            .then(|| radians(param))
            .and_then(|name| map.get_key_value(name.as_str()));
        let (key, value, degrees) = match (exact, map.get(param.name)) {
            (Some((key, value)), _) => (key.as_str(), value, false),
            (None, Some(value)) => (param.name, value, angle),
            (None, None) if !param.default.is_empty() => {
                if let Kind::List(width) = param.kind {
                    out.push((param.default.len() / width) as f64);
                }
                out.extend_from_slice(param.default);
                continue;
            }
            (None, None) => {
                return Err(problem(format!(
                    "{} needs `{}`: {}",
                    info.name, param.name, param.doc
                )));
            }
        };
        parameter(param, value, degrees, &mut out).map_err(|p| p.at(key))?;
    }
    Ok(out)
}

/// One parameter, appended to the array.
fn parameter(param: &'static Param, value: &Value, degrees: bool, out: &mut Vec<f64>) -> Read<()> {
    let component = |v: &Value| {
        let x = number(v)?;
        let y = if degrees { x.to_radians() } else { x };
        let say = |x: f64| spoken(if degrees { x.to_degrees() } else { x });
        if !(param.min..=param.max).contains(&y) {
            let message = format!(
                "this is {}, allowed is {} to {}",
                spoken(x),
                say(param.min),
                say(param.max)
            );
            return Err(problem(message).help(format!("{}: {}", param.name, param.doc)));
        }
        if param.unit == Unit::Count && x.fract() != 0.0 {
            return Err(problem(format!(
                "this must be a whole number, not {}",
                spoken(x)
            )));
        }
        Ok(y)
    };
    match param.kind {
        Kind::Number => out.push(component(value)?),
        Kind::Vec2 if value.is_number() => out.extend([component(value)?; 2]),
        Kind::Vec2 => out.extend(array::<f64, 2>(value, component)?),
        Kind::Vec3 if param.unit == Unit::Direction && value.is_string() => {
            let direction = value.as_str().and_then(direction_of_word);
            out.extend(direction.ok_or_else(|| {
                problem("a direction is \"x\", \"-y\" and the like, or three numbers")
            })?);
        }
        Kind::Vec3 if value.is_number() => out.extend([component(value)?; 3]),
        Kind::Vec3 => out.extend(array::<f64, 3>(value, component)?),
        Kind::List(width) => {
            let items = list(value, "this")?;
            out.push(items.len() as f64);
            for (i, item) in items.iter().enumerate() {
                let numbers = match (width, item.as_array()) {
                    (1, _) => std::slice::from_ref(item),
                    (_, Some(numbers)) if numbers.len() == width => numbers,
                    _ => {
                        return Err(problem(format!("this must be a list of {width}"))
                            .within(JsonStep::Index(i)));
                    }
                };
                for x in numbers {
                    out.push(component(x).map_err(|p| p.within(JsonStep::Index(i)))?);
                }
            }
        }
    }
    Ok(())
}
