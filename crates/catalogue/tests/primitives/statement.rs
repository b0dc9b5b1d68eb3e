//! Proofs of what an entry says of itself: its words, its parameters, its shader.

use zeroset_catalogue::Kind;

use crate::case::Failure;
use crate::entry::Entry;

fn snake_case(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

fn one_line(doc: &str) -> bool {
    doc.len() > 8 && doc.len() <= 120 && doc.ends_with('.') && !doc.contains('\n')
}

/// Names, documentation, ranges, and that the defaults and samples lie in them.
pub fn info(e: &Entry) -> Result<(), Failure> {
    let fail = |what: String| Failure {
        entry: e.info.name,
        proof: "info",
        params: e.info.defaults(),
        what,
    };
    if !snake_case(e.info.name) || !one_line(e.info.doc) || e.info.group.is_empty() {
        return Err(fail(format!(
            "name, doc or group: {:?}, {:?}",
            e.info.doc, e.info.group
        )));
    }
    for (i, p) in e.info.params.iter().enumerate() {
        if !snake_case(p.name)
            || !one_line(p.doc)
            || e.info.params[..i].iter().any(|q| q.name == p.name)
        {
            return Err(fail(format!("parameter {}: {:?}", p.name, p.doc)));
        }
        if !(p.min < p.max) {
            return Err(fail(format!(
                "parameter {} ranges over {}..{}",
                p.name, p.min, p.max
            )));
        }
        let last = i + 1 == e.info.params.len();
        let fits = match p.kind {
            Kind::List(width) => last && width > 0 && p.default.len() % width == 0,
            kind => p.default.len() == kind.len(),
        };
        if !fits {
            return Err(fail(format!(
                "parameter {} has {} defaults for {:?}",
                p.name,
                p.default.len(),
                p.kind
            )));
        }
    }
    for a in sets(e) {
        in_range(e, &a).map_err(&fail)?;
        (e.check)(&a).map_err(|why| fail(format!("{a:?} is refused: {why}")))?;
    }
    Ok(())
}

/// The sets of parameters that the proofs run at.
pub fn sets(e: &Entry) -> Vec<Vec<f64>> {
    let mut sets = vec![e.info.defaults()];
    sets.extend(e.samples.iter().map(|s| s.to_vec()));
    sets
}

fn in_range(e: &Entry, a: &[f64]) -> Result<(), String> {
    let mut at = 0;
    for p in e.info.params {
        let len = match p.kind {
            Kind::List(width) => {
                at += 1;
                a.get(at - 1).map_or(0, |&n| n as usize * width)
            }
            kind => kind.len(),
        };
        let values = a
            .get(at..at + len)
            .ok_or_else(|| format!("{a:?} is too short for {}", p.name))?;
        if let Some(x) = values.iter().find(|&&x| !(p.min <= x && x <= p.max)) {
            return Err(format!(
                "{} = {x} in {a:?} is not in {}..{}",
                p.name, p.min, p.max
            ));
        }
        at += len;
    }
    if at == a.len() {
        Ok(())
    } else {
        Err(format!(
            "{a:?} has {} numbers, the parameters take {at}",
            a.len()
        ))
    }
}

/// The recorded formula and gradient are WGSL that naga accepts.
pub fn shader(e: &Entry) -> Result<(), Failure> {
    let head = "@group(0) @binding(0) var<storage, read> params: array<f32>;\n";
    let source = format!("{head}{}", (e.shader)());
    let fail = |why: String| {
        let what = format!("{why}\n{source}");
        Failure {
            entry: e.info.name,
            proof: "shader",
            params: e.info.defaults(),
            what,
        }
    };
    let module =
        naga::front::wgsl::parse_str(&source).map_err(|e| fail(e.emit_to_string(&source)))?;
    let mut validator = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    );
    validator
        .validate(&module)
        .map_err(|e| fail(e.emit_to_string(&source)))?;
    Ok(())
}
