//! The reference: what the scene language offers, as data. Everything comes from the catalogue of fields and from the
//! language's own list of words.

use serde::Serialize;
use std::fmt::Write;
use zeroset_catalogue::bounds::{Aabb, Exactness};
use zeroset_catalogue::entries::{Catalogue, MapEntry, ModifyEntry, PrimitiveEntry, catalogue};
use zeroset_catalogue::{Dimension, Info, Kind, Param, Stretch, Unit};
use zeroset_language::limits::{LIMITS, Limits};
use zeroset_language::starlark::{Word, words};
use zeroset_scene::methods::{self, GROUPS, Method};

/// What is known about a name.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Entry {
    /// The name.
    pub name: &'static str,
    /// What it is: shape, join, map or modifier of fields, or a function or method of the language.
    pub kind: &'static str,
    /// The section it stands in.
    pub group: &'static str,
    /// One line.
    pub doc: &'static str,
    /// Author, year and equation, or empty.
    pub source: &'static str,
    /// 2D, 3D, or both; none for what is no field.
    pub dimension: Option<&'static str>,
    /// What it takes.
    pub parameters: Vec<Parameter>,
    /// What is true of it, as (topic, statement).
    pub facts: Vec<(&'static str, String)>,
    /// A line that uses it, if it can be had from the catalogue.
    pub example: Option<String>,
}

/// A parameter.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// A number, two or three of them, or a list of items of some numbers; none where the line below says it.
    pub kind: Option<String>,
    /// What it measures; none where the line below says it.
    pub unit: Option<&'static str>,
    /// As it is written in a scene; none if it must be given.
    pub default: Option<String>,
    /// Smallest number allowed; none where the line below says it.
    pub min: Option<f64>,
    /// Largest number allowed; none where the line below says it.
    pub max: Option<f64>,
    /// Whether the smallest number itself is not allowed.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_above: bool,
    /// Whether the largest number itself is not allowed.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub is_below: bool,
    /// One line.
    pub doc: &'static str,
}

/// All entries, in the order of the reference.
pub(crate) fn entries() -> Vec<Entry> {
    let Catalogue {
        primitives,
        maps,
        modifiers,
        joins,
    } = catalogue();
    (primitives.iter().map(shape))
        .chain(joins.iter().map(|join| {
            let facts = vec![
                (
                    "surface",
                    if join.sharp {
                        "sharp where the shapes meet"
                    } else {
                        "blended where the shapes meet"
                    }
                    .into(),
                ),
                (
                    "distance",
                    truth((join.exactness)(Exactness::Exact, Exactness::Exact))
                        .replace("is", "of exact shapes is"),
                ),
            ];
            let example = format!(
                "{}([sphere(1.0), box(1.5)]{})",
                join.info.name,
                more(&join.info)
            );
            entry("join", &join.info, facts, example)
        }))
        .chain(maps.iter().map(map))
        .chain(modifiers.iter().map(modifier))
        .chain(words().into_iter().map(word))
        .collect()
}

fn shape(primitive: &PrimitiveEntry) -> Entry {
    let params = primitive.info.defaults();
    let mut facts = vec![("distance", truth(primitive.exactness))];
    // where a parameter must be given there are no defaults to measure
    if primitive.info.params.iter().all(|p| !p.default.is_empty()) {
        let slope = (primitive.lipschitz)(&params);
        let divided = if slope == 1.0 {
            ""
        } else {
            ", which the distance is divided by"
        };
        facts.push((
            "Lipschitz constant",
            format!("{}{divided}", shortest(slope)),
        ));
        facts.push((
            "bounds of the default",
            bounds(&(primitive.bounds)(&params)),
        ));
    }
    entry(
        "shape",
        &primitive.info,
        facts,
        format!("{}({})", primitive.info.name, arguments(&primitive.info)),
    )
}

fn map(map: &MapEntry) -> Entry {
    let unit = Aabb::centred([0.5; 3]);
    let params = map.info.defaults();
    let held = (map.bounds)(&params, &unit);
    let stretch = match (map.stretch)(&params, &held) {
        Ok(Stretch::Everywhere(1.0)) => "1: distances stay true".to_owned(),
        Ok(Stretch::Everywhere(s)) => format!(
            "{} with the defaults, which distances are divided by",
            shortest(s)
        ),
        Ok(Stretch::Within(_, s)) => {
            format!(
                "{} for a unit cube with the defaults, which distances are divided by",
                shortest(s)
            )
        }
        Err(reason) => reason,
    };
    let distance = if map.rigid {
        "stays as true as it is"
    } else {
        "becomes a bound"
    };
    let facts = vec![("distance", distance.to_owned()), ("stretch", stretch)];
    entry(
        "map",
        &map.info,
        facts,
        format!(
            "{}.{}({})",
            subject(&map.info),
            map.info.name,
            arguments(&map.info)
        ),
    )
}

fn modifier(modifier: &ModifyEntry) -> Entry {
    let slope = (modifier.lipschitz)(&modifier.info.defaults(), 1.0);
    let facts = vec![
        (
            "distance",
            truth((modifier.exactness)(Exactness::Exact)).replace("is", "of an exact shape is"),
        ),
        (
            "Lipschitz constant",
            format!("{} over a shape of 1, with the defaults", shortest(slope)),
        ),
    ];
    let example = format!(
        "{}.{}({})",
        subject(&modifier.info),
        modifier.info.name,
        arguments(&modifier.info)
    );
    entry("modifier", &modifier.info, facts, example)
}

fn entry(
    kind: &'static str,
    info: &Info,
    facts: Vec<(&'static str, String)>,
    example: String,
) -> Entry {
    Entry {
        name: info.name,
        kind,
        group: info.group,
        doc: info.doc,
        source: info.source,
        dimension: Some(match info.dimension {
            Dimension::Two => "2D",
            Dimension::Three => "3D",
            Dimension::Any => "2D or 3D",
        }),
        parameters: info.params.iter().map(parameter).collect(),
        facts,
        example: Some(example),
    }
}

/// A function or method of the language.
fn word(word: Word) -> Entry {
    // what the registry of methods knows besides
    let known = (GROUPS
        .iter()
        .filter(|g| g.is_called() && g.title == word.group))
    .flat_map(|g| g.methods)
    .find(|m| m.word == word.name);
    let parameter = |(name, default, doc): (&'static str, &'static str, &'static str)| Parameter {
        name,
        kind: None,
        unit: None,
        default: (!default.is_empty()).then(|| default.to_owned()),
        min: None,
        max: None,
        is_above: false,
        is_below: false,
        doc,
    };
    let parameters: Vec<Parameter> = match known {
        Some(method) => method.params.iter().map(number).collect(),
        None => word.params.into_iter().map(parameter).collect(),
    };
    Entry {
        name: word.name,
        kind: word.kind,
        group: word.group,
        doc: word.doc,
        source: known.map_or("", |m| m.source),
        dimension: None,
        parameters,
        facts: Vec::new(),
        example: None,
    }
}

/// What takes whole numbers only.
const WHOLE: &str = "whole number";

/// A parameter of a method of rendering.
fn number(param: &methods::Param) -> Parameter {
    let is_word = matches!(param.kind, methods::Kind::Word(_));
    let range = (!is_word).then_some(param.allowed);
    Parameter {
        name: param.name,
        kind: Some(match param.kind {
            methods::Kind::Real => "number".to_owned(),
            methods::Kind::Whole => WHOLE.to_owned(),
            methods::Kind::Limit => "number, or nothing for no limit".to_owned(),
            methods::Kind::Word(words) => either(words),
        }),
        unit: (!is_word).then(|| param.unit.name()),
        default: Some(param.written(param.default)),
        min: range.map(|r| r.min),
        max: range.map(|r| r.max),
        is_above: range.is_some_and(|r| r.is_above),
        is_below: range.is_some_and(|r| r.is_below),
        doc: param.doc,
    }
}

/// Methods as words.
fn either(methods: &[Method]) -> String {
    let names: Vec<String> = methods.iter().map(|m| format!("\"{}\"", m.name)).collect();
    names.join(" or ")
}

/// All methods of rendering, as a page.
pub(crate) fn methods() -> String {
    let mut out = "Methods of which a rendering chooses one each, the default first. A scene states them, `zeroset render`\n\
                   takes them as flags: --march relaxed=1.4, or --ao bent,steps=7,bend=0.1.\n"
        .to_owned();
    for group in &GROUPS {
        let _ = writeln!(out, "\n{}: {}", group.title, group.key);
        for method in group.methods {
            let also = match method.word == method.name {
                true => String::new(),
                false => format!(" (in scenes {})", method.word),
            };
            let _ = writeln!(
                out,
                "  {}{also}\n      {} [{}]",
                method.name, method.doc, method.source
            );
            for param in method.params.iter().map(number) {
                let _ = writeln!(
                    out,
                    "      {}: {} ({})",
                    param.name,
                    param.doc.trim_end_matches('.'),
                    allowed(&param)
                );
            }
        }
    }
    out
}

fn parameter(param: &Param) -> Parameter {
    Parameter {
        name: param.name,
        kind: Some(match param.kind {
            Kind::Number => "number".to_owned(),
            Kind::Vec2 => "2 numbers".to_owned(),
            Kind::Vec3 => "3 numbers".to_owned(),
            Kind::List(1) => "list of numbers".to_owned(),
            Kind::List(width) => format!("list of items of {width} numbers"),
        }),
        unit: Some(match param.unit {
            Unit::Length => "scene units",
            Unit::Angle => "degrees",
            Unit::Ratio => "ratio",
            Unit::Count => "count",
            Unit::Rate => "degrees per scene unit",
            Unit::Frequency => "cycles per scene unit",
            Unit::Direction => "direction",
        }),
        default: written(param),
        min: Some(spoken(param, param.min)),
        max: Some(spoken(param, param.max)),
        is_above: false,
        is_below: false,
        doc: param.doc,
    }
}

/// The default as a scene writes it; none if there is none.
fn written(param: &Param) -> Option<String> {
    let numbers: Vec<String> = param
        .default
        .iter()
        .map(|&x| shortest(spoken(param, x)))
        .collect();
    match param.kind {
        _ if numbers.is_empty() => None,
        Kind::Number => numbers.into_iter().next(),
        Kind::Vec2 | Kind::Vec3 => Some(format!("({})", numbers.join(", "))),
        Kind::List(1) => Some(format!("[{}]", numbers.join(", "))),
        Kind::List(width) => {
            let items: Vec<String> = numbers
                .chunks(width)
                .map(|item| format!("({})", item.join(", ")))
                .collect();
            Some(format!("[{}]", items.join(", ")))
        }
    }
}

/// A number in the unit of scenes.
fn spoken(param: &Param, x: f64) -> f64 {
    match param.unit {
        Unit::Angle | Unit::Rate => x.to_degrees(),
        _ => x,
    }
}

/// All parameters by name, with their defaults or, where they must be given, something plausible.
fn arguments(info: &Info) -> String {
    let given = |param: &Param| match (written(param), param.kind) {
        (Some(default), _) => default,
        (None, Kind::Number) => "1".to_owned(),
        (None, Kind::Vec2) => "(1, 1)".to_owned(),
        (None, Kind::Vec3) => "(1, 1, 1)".to_owned(),
        (None, Kind::List(_)) => "[...]".to_owned(),
    };
    let all: Vec<String> = info
        .params
        .iter()
        .map(|p| format!("{} = {}", p.name, given(p)))
        .collect();
    all.join(", ")
}

fn more(info: &Info) -> String {
    if info.params.is_empty() {
        String::new()
    } else {
        format!(", {}", arguments(info))
    }
}

/// A shape that an operation can be shown on.
fn subject(info: &Info) -> &'static str {
    if info.dimension == Dimension::Two {
        "circle(0.5)"
    } else {
        "box(1.0)"
    }
}

fn truth(exactness: Exactness) -> String {
    match exactness {
        Exactness::Exact => "is exact",
        Exactness::Outside => "is exact outside, a bound inside",
        Exactness::Bound => "is a bound: never more than the true one",
        Exactness::Estimate => "is an estimate, without a proof",
    }
    .to_owned()
}

fn bounds(aabb: &Aabb) -> String {
    let axis = |name: &str, k: usize| match (aabb.min[k].is_finite(), aabb.max[k].is_finite()) {
        (true, true) => format!(
            "{name} {} to {}",
            shortest(aabb.min[k]),
            shortest(aabb.max[k])
        ),
        (true, false) => format!("{name} from {}", shortest(aabb.min[k])),
        (false, true) => format!("{name} to {}", shortest(aabb.max[k])),
        (false, false) => format!("{name} unbounded"),
    };
    [axis("x", 0), axis("y", 1), axis("z", 2)].join(", ")
}

/// A number without noise: at most six digits after the point.
pub(crate) fn shortest(x: f64) -> String {
    if x != 0.0 && (x.abs() >= 1e5 || x.abs() < 1e-4) {
        let text = format!("{x:.3e}");
        let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
        return format!(
            "{}e{power}",
            digits.trim_end_matches('0').trim_end_matches('.')
        );
    }
    let text = format!("{x:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// The parameters in brackets, as a listing shows them.
pub(crate) fn signature(entry: &Entry) -> String {
    let parameters = entry.parameters.iter().map(|p| match &p.default {
        Some(default) if default.len() <= 16 => format!("{} = {default}", p.name),
        Some(_) => format!("{} = [...]", p.name),
        None => p.name.to_owned(),
    });
    if entry.kind == "constant" {
        return entry.name.to_owned();
    }
    let first = (entry.kind == "join").then(|| "shapes".to_owned());
    let all: Vec<String> = first.into_iter().chain(parameters).collect();
    format!("{}({})", entry.name, all.join(", "))
}

/// Kind, unit, range and default of a parameter, as far as they are known.
fn allowed(p: &Parameter) -> String {
    let range = p.min.zip(p.max).map(|(min, max)| {
        let above = if p.is_above { "above " } else { "" };
        let below = if p.is_below { "below " } else { "" };
        format!("{above}{} to {below}{}", shortest(min), shortest(max))
    });
    let default = p
        .default
        .as_ref()
        .map_or("must be given".to_owned(), |d| format!("default {d}"));
    let parts = [
        p.kind.clone(),
        p.unit.map(str::to_owned),
        range,
        Some(default),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// The limits with their defaults, as a page.
pub(crate) fn limits() -> String {
    let mut out = "What a scene may cost. Change a limit with --limit NAME=VALUE.\n\n".to_owned();
    let width = LIMITS.iter().map(|l| l.name.len()).max().unwrap_or(0);
    for limit in LIMITS {
        let _ = writeln!(
            out,
            "  {:width$}  {}, default {}",
            limit.name,
            limit.doc,
            limit.of(&Limits::default())
        );
    }
    out
}

/// A page about an entry.
pub(crate) fn page(entry: &Entry) -> String {
    let mut out = format!("{}\n\n    {}\n", entry.doc, signature(entry));
    let title = |out: &mut String, title: &str| out.push_str(&format!("\n{title}\n"));
    // those of a function of formulas are numbers and vectors that its line speaks of
    if entry.parameters.iter().any(|p| !p.doc.is_empty()) {
        title(&mut out, "Parameters");
        let width = entry
            .parameters
            .iter()
            .map(|p| p.name.len())
            .max()
            .unwrap_or(0);
        for p in &entry.parameters {
            let _ = writeln!(
                out,
                "  {:width$}  {}\n  {:width$}  {}",
                p.name,
                p.doc,
                "",
                allowed(p)
            );
        }
    }
    title(&mut out, "Facts");
    let dimension = entry
        .dimension
        .map(|d| format!(", {d}"))
        .unwrap_or_default();
    let _ = writeln!(
        out,
        "  {} in the group {}{dimension}",
        entry.kind, entry.group
    );
    for (topic, statement) in &entry.facts {
        let _ = writeln!(out, "  {topic}: {statement}");
    }
    if !entry.source.is_empty() {
        let _ = writeln!(out, "  source: {}", entry.source);
    }
    if let Some(example) = &entry.example {
        title(&mut out, "Example");
        let _ = writeln!(out, "  {example}");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.5, "1.5"),
            (30f64.to_radians().to_degrees(), "30"),
            (1e6, "1e6"),
            (-57_295_779.5, "-5.73e7"),
            (1e-6, "1e-6"),
        ] {
            assert_eq!(shortest(x), text);
        }
    }

    #[test]
    fn every_entry_says_what_it_is() {
        let entries = entries();
        assert_eq!(entries.len(), catalogue().infos().count() + words().len());
        for entry in &entries {
            let page = page(entry);
            assert!(
                entry
                    .example
                    .as_ref()
                    .is_none_or(|e| e.contains(entry.name)),
                "{page}"
            );
            assert_eq!(
                page.contains("distance: "),
                entry.dimension.is_some(),
                "{page}"
            );
            assert!(page.contains(entry.doc), "{page}");
            assert!(
                entry.parameters.iter().all(|p| page.contains(p.doc)),
                "{page}"
            );
            assert!(!page.contains("NaN"), "{page}");
        }
    }
}
