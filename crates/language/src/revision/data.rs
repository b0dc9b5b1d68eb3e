//! Values in JSON: where they stand in the text.

use super::plan::{self, Given, Literal, Statement};
use super::{Change, Edits, Look, Reason};
use crate::json::JsonStep;
use crate::json::locate::{locate, members};
use crate::load::Loaded;
use glam::Vec3;
use serde_json::Value;
use std::ops::Range;
use zeroset_scene::light::Source;
use zeroset_scene::material::Pattern;

/// As [`super::revise`]; the text was loaded, and is JSON.
pub(super) fn revise(
    text: &str,
    loaded: &Loaded,
    changes: &[Change],
    edits: &mut Edits<'_>,
    record: &mut dyn FnMut(&Change, Result<(), Reason>),
) {
    for change in changes {
        let mark = edits.mark();
        let result = one(text, loaded, change, edits);
        if result.is_err() {
            edits.back_to(mark);
        }
        record(change, result);
    }
}

fn one(text: &str, loaded: &Loaded, change: &Change, edits: &mut Edits<'_>) -> Result<(), Reason> {
    let scene = &loaded.scene;
    match change {
        Change::Parameter { .. } => Err(Reason::NotInJson),
        Change::Camera { camera, target } => {
            let mut to = Object::of(text, &[key("camera")], edits);
            plan::camera(&mut to, scene.camera(), camera, *target)?;
            to.finish();
            Ok(())
        }
        Change::Sun {
            light,
            direction,
            radiance,
        } => {
            let path = [key("lights"), JsonStep::Index(*light)];
            let before = scene.lights().get(*light).ok_or(Reason::NotInJson)?;
            if !is_there(text, &path) {
                return Err(Reason::NotInJson);
            }
            let [lights, light] = path;
            let source = [lights.clone(), light.clone(), key("source")];
            let mut to = Object::of(text, &source, edits);
            if !matches!(before.source, Source::Directional { direction: d } if d == *direction) {
                to.set("direction", Literal::vector(*direction))?;
            }
            to.finish();
            let mut to = Object::of(text, &[lights, light], edits);
            if before.radiance != *radiance {
                to.set("radiance", Literal::vector(*radiance))?;
            }
            to.finish();
            Ok(())
        }
        Change::Sky {
            top,
            horizon,
            bottom,
            ambient,
        } => {
            let before = scene.sky();
            let mut to = Object::of(text, &[key("sky")], edits);
            let colours = [
                ("top", before.top, *top),
                ("horizon", before.horizon, *horizon),
                ("bottom", before.bottom, *bottom),
            ];
            for (name, before, now) in colours {
                if before != now {
                    to.set(name, Literal::vector(now))?;
                }
            }
            if before.ambient != *ambient {
                to.set("ambient", Literal::single(*ambient))?;
            }
            to.finish();
            Ok(())
        }
        Change::Material { material, look } => material_of(text, loaded, *material, look, edits),
    }
}

fn material_of(
    text: &str,
    loaded: &Loaded,
    material: usize,
    look: &Look,
    edits: &mut Edits<'_>,
) -> Result<(), Reason> {
    let path = [key("materials"), JsonStep::Index(material)];
    let Some(mut wanted) = loaded.scene.materials().get(material).cloned() else {
        return Err(Reason::NotInJson);
    };
    if !is_there(text, &path) {
        return Err(Reason::NotInJson);
    }
    look.apply(&mut wanted);
    let mut to = Object::of(text, &path, edits);
    if let (Some(_), Pattern::Solid { colour }) = (look.colour, &wanted.pattern) {
        let Vec3 { x, y, z } = *colour;
        to.put(
            "pattern",
            &format!("{{\"kind\": \"solid\", \"colour\": [{x}, {y}, {z}]}}"),
        );
    }
    if look.roughness.is_some() {
        to.set("roughness", Literal::single(wanted.roughness))?;
        to.set("shininess", Literal::single(wanted.shininess))?;
    }
    if look.metallic.is_some() {
        to.set("metallic", Literal::single(wanted.metallic))?;
    }
    if look.specular.is_some() {
        to.set("specular", Literal::single(wanted.specular))?;
    }
    to.finish();
    Ok(())
}

fn key(name: &str) -> JsonStep {
    JsonStep::Key(name.to_owned())
}

/// Whether the whole of a path is there.
fn is_there(text: &str, path: &[JsonStep]) -> bool {
    let Ok(mut value) = serde_json::from_str::<Value>(text) else {
        return false;
    };
    path.iter().all(|step| {
        let inner = match step {
            JsonStep::Key(key) => value.get_mut(key),
            JsonStep::Index(i) => value.get_mut(i),
        };
        inner.map(Value::take).map(|v| value = v).is_some()
    })
}

/// An object of the text whose members are changed; one that is not there is made a member of the outermost.
struct Object<'e, 't> {
    text: &'t str,
    edits: &'e mut Edits<'t>,
    /// Keys as they are meant, with the bytes of the values.
    members: Vec<(String, Range<usize>, Range<usize>)>,
    /// Where more members go: behind the last one, or behind the brace.
    end: usize,
    /// Its name, where it is to be made.
    missing: Option<String>,
    added: Vec<String>,
}

impl<'e, 't> Object<'e, 't> {
    fn of(text: &str, path: &[JsonStep], edits: &'e mut Edits<'t>) -> Object<'e, 't> {
        let body = edits.text;
        let is_there = is_there(text, path);
        let at = locate(text, if is_there { path } else { &[] }).start;
        let all = members(body, at);
        let end = all.last().map_or(at + 1, |(_, value)| value.end);
        let missing = match path.last() {
            Some(JsonStep::Key(name)) if !is_there => Some(name.clone()),
            _ => None,
        };
        let named = all.into_iter().filter_map(|(key, value)| {
            let name = serde_json::from_str(body.get(key.clone())?).ok()?;
            Some((name, key, value))
        });
        Object {
            text: body,
            members: if is_there {
                named.collect()
            } else {
                Vec::new()
            },
            edits,
            end,
            missing,
            added: Vec::new(),
        }
    }

    fn member(&self, name: &str) -> Option<(Range<usize>, Range<usize>)> {
        let mut all = self.members.iter();
        let (_, key, value) = all.find(|(n, ..)| n == name)?;
        Some((key.clone(), value.clone()))
    }

    /// Makes a member of it, whatever it was.
    fn put(&mut self, name: &str, value: &str) {
        match self.member(name) {
            Some((_, span)) => self.edits.replace(span, value.to_owned()),
            None => self.added.push(format!("\"{name}\": {value}")),
        }
    }

    /// Writes the members that were added.
    fn finish(self) {
        if self.added.is_empty() {
            return;
        }
        // as the line of the last member begins, where it stands on a line of its own
        let line = self.text[..self.end].rfind('\n').map_or(0, |at| at + 1);
        let indent: String = (self.text[line..self.end].chars())
            .take_while(|c| c.is_whitespace())
            .collect();
        let is_broken = self.missing.is_some() && line > 0;
        let gap = if is_broken {
            format!("\n{indent}")
        } else {
            " ".to_owned()
        };
        let mut what = self.added.join(", ");
        if let Some(name) = &self.missing {
            what = format!("\"{name}\": {{{what}}}");
        }
        let is_first = self.text[..self.end].ends_with('{');
        let comma = if is_first { "" } else { "," };
        let gap = if is_first { "" } else { &gap };
        self.edits.insert(self.end, format!("{comma}{gap}{what}"));
    }
}

impl Statement for Object<'_, '_> {
    fn given(&self, name: &str) -> Given {
        let Some((_, span)) = self.member(name) else {
            return Given::Absent;
        };
        let numbers = |all: &[Value]| all.iter().map(Value::as_f64).collect::<Option<Vec<_>>>();
        match serde_json::from_str(&self.text[span]) {
            Ok(Value::Number(x)) => Given::Literal(Literal::Number(x.as_f64().unwrap_or(0.0))),
            Ok(Value::String(text)) => Given::Literal(Literal::Text(text)),
            Ok(Value::Bool(on)) => Given::Literal(Literal::Flag(on)),
            Ok(Value::Array(all)) => {
                // rows of axes are all that is no list of numbers
                Given::Literal(Literal::Numbers(numbers(&all).unwrap_or_default()))
            }
            _ => Given::Literal(Literal::None),
        }
    }

    fn set(&mut self, name: &str, value: Literal) -> Result<(), Reason> {
        // numbers of colours are linear here, and mean nothing else
        let is_same = matches!(self.given(name), Given::Literal(now) if now == value);
        if !is_same {
            self.put(name, &written(&value));
        }
        Ok(())
    }

    fn exchange(&mut self, old: &str, new: &str, value: Literal) -> Result<(), Reason> {
        match self.member(old) {
            Some((key, span)) => {
                let text = format!("\"{new}\": {}", written(&value));
                self.edits.replace(key.start..span.end, text);
                Ok(())
            }
            None => self.set(new, value),
        }
    }

    fn has_height(&self) -> bool {
        true
    }
}

fn written(value: &Literal) -> String {
    match value {
        Literal::None => "null".into(),
        Literal::Flag(on) => on.to_string(),
        Literal::Number(x) | Literal::Orthographic(x) => digits(*x),
        Literal::Text(text) => Value::from(text.as_str()).to_string(),
        Literal::Numbers(all) => {
            let all: Vec<String> = all.iter().map(|x| digits(*x)).collect();
            format!("[{}]", all.join(", "))
        }
    }
}

/// A number as JSON has it.
fn digits(x: f64) -> String {
    serde_json::Number::from_f64(x + 0.0).map_or("0".into(), |n| n.to_string())
}
