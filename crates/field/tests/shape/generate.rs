//! Writes `src/shape/entries.rs` from the catalogue.

use std::fmt::Write;
use zeroset_catalogue::entries::catalogue;
use zeroset_catalogue::{Info, Kind, Param, Unit};

/// The functions and methods of every entry.
pub(crate) fn entries() -> String {
    let all = catalogue();
    let mut out = String::from(
        "//! The catalogue as functions and methods. Written by `tests/shape/generate.rs`, which a test holds this file against: do not\n\
         //! change it by hand.\n\n\
         use super::{Params, Shape};\n\
         use glam::{DVec2, DVec3};\n",
    );
    for e in &all.primitives {
        out += "\n";
        documented(&mut out, "", &e.info, "");
        let (params, values) = signature(&e.info);
        let name = rust_name(e.info.name);
        let _ = write!(
            out,
            "pub fn {name}({}) -> Shape {{\n    Shape::primitive(\"{}\", Params::new(){values})\n}}\n",
            params.join(", "),
            e.info.name
        );
    }
    for e in &all.joins {
        out += "\n";
        documented(
            &mut out,
            "",
            &e.info,
            " Of any number of shapes, from left to right.",
        );
        let (mut params, values) = signature(&e.info);
        params.insert(
            0,
            "shapes: impl IntoIterator<Item = impl Into<Shape>>".into(),
        );
        let name = e.info.name;
        let _ = write!(
            out,
            "pub fn {name}({}) -> Shape {{\n    Shape::join(\"{name}\", Params::new(){values}, shapes)\n}}\n",
            params.join(", ")
        );
    }
    out += "\n/// # Maps of space\nimpl Shape {\n";
    let maps = all.maps.iter().map(|e| &e.info);
    methods(&mut out, "map", maps);
    out += "}\n\n/// # Changes of the field\nimpl Shape {\n";
    let modifiers = all.modifiers.iter().map(|e| &e.info);
    methods(&mut out, "modify", modifiers);
    out += "}\n\n/// # Joins with another shape\nimpl Shape {\n";
    for (i, e) in all.joins.iter().enumerate() {
        if i > 0 {
            out += "\n";
        }
        documented(&mut out, "    ", &e.info, "");
        let (mut params, values) = signature(&e.info);
        params.insert(0, "&self".into());
        params.insert(1, "other: impl Into<Shape>".into());
        let name = e.info.name;
        let _ = write!(
            out,
            "    pub fn {name}({}) -> Shape {{\n        Shape::join(\"{name}\", Params::new(){values}, [self.clone(), other.into()])\n    }}\n",
            params.join(", ")
        );
    }
    out + "}\n"
}

fn methods<'a>(out: &mut String, kind: &str, infos: impl Iterator<Item = &'a Info>) {
    for (i, info) in infos.enumerate() {
        if i > 0 {
            *out += "\n";
        }
        documented(out, "    ", info, "");
        let (mut params, values) = signature(info);
        params.insert(0, "&self".into());
        let name = rust_name(info.name);
        let _ = write!(
            out,
            "    pub fn {name}({}) -> Shape {{\n        self.{kind}(\"{}\", Params::new(){values})\n    }}\n",
            params.join(", "),
            info.name
        );
    }
}

/// A name that Rust allows.
fn rust_name(name: &str) -> &str {
    match name {
        "box" => "box3",
        _ => name,
    }
}

/// Parameters of a function, and the calls that put them into the parameter array.
fn signature(info: &Info) -> (Vec<String>, String) {
    let mut values = String::new();
    let params = info.params.iter().map(|p| {
        let (kind, call) = match (p.kind, p.unit) {
            (Kind::Number, Unit::Count) => ("u32", "number"),
            (Kind::Number, _) => ("impl Into<f64>", "number"),
            (Kind::Vec2, _) => ("impl Into<DVec2>", "vec2"),
            (Kind::Vec3, _) => ("impl Into<DVec3>", "vec3"),
            (Kind::List(2), _) => ("impl IntoIterator<Item = impl Into<DVec2>>", "points2"),
            (Kind::List(3), _) => ("impl IntoIterator<Item = impl Into<DVec3>>", "points"),
            (Kind::List(4), _) => (
                "impl IntoIterator<Item = [impl Into<DVec2>; 2]>",
                "segments",
            ),
            (Kind::List(n), _) => panic!("a list of items of {n} numbers"),
        };
        let _ = write!(values, ".{call}({})", p.name);
        format!("{}: {kind}", p.name)
    });
    let params = params.collect();
    (params, values)
}

fn documented(out: &mut String, indent: &str, info: &Info, more: &str) {
    let _ = writeln!(out, "{indent}/// {}{more}", sentence(info.doc));
    if !info.source.is_empty() {
        let _ = writeln!(
            out,
            "{indent}///\n{indent}/// Source: {}",
            sentence(info.source)
        );
    }
    if !info.params.is_empty() {
        let _ = writeln!(out, "{indent}///");
    }
    for p in info.params {
        let _ = writeln!(out, "{indent}/// - `{}`: {}", p.name, described(p));
    }
}

fn described(p: &Param) -> String {
    let unit = match p.unit {
        Unit::Length => "scene units",
        Unit::Angle => "radians",
        Unit::Ratio => "a plain number",
        Unit::Count => "a whole number",
        Unit::Rate => "radians a scene unit",
        Unit::Frequency => "cycles a scene unit",
        Unit::Direction => "a direction of any length",
    };
    let doc = sentence(p.doc);
    format!("{doc} In {unit}, {} to {}.", spoken(p.min), spoken(p.max))
        .replace("In a ", "A ")
        .replace("In scene", "Scene")
        .replace("In radians", "Radians")
        .replace("In cycles", "Cycles")
}

/// A number for people.
fn spoken(x: f64) -> String {
    if x == 0.0 || (1e-3..1e6).contains(&x.abs()) {
        let text = format!("{x:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        format!("{x:e}")
    }
}

/// With a full stop, and without what rustdoc takes for marks.
fn sentence(text: &str) -> String {
    let text = text.replace('[', "\\[").replace('<', "\\<");
    if text.ends_with(['.', '!', '?']) {
        text
    } else {
        format!("{text}.")
    }
}
