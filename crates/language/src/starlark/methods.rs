//! Methods of texts, lists and dicts.

use super::mistake::{Run, mistake};
use super::native::{Call, Given, Native, Slot, slot};
use super::value::Value;
use std::sync::Arc;

macro_rules! method {
    ($group:literal, $name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native { name: $name, doc: $doc, group: $group, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run }
    };
}

macro_rules! text {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => { method!("Texts", $name, $doc, [$($slot),*], $run) };
}

macro_rules! list {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => { method!("Lists", $name, $doc, [$($slot),*], $run) };
}

macro_rules! dict {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => { method!("Dicts", $name, $doc, [$($slot),*], $run) };
}

const PART: Slot = slot("part", "", "A text.");
const VALUE: Slot = slot("value", "", "Any value.");
const KEY: Slot = slot("key", "", "A key.");

/// Methods of texts.
pub(crate) const TEXT: &[Native] = &[
    text!("upper", "In capital letters.", [], |c| mapped(c, |t| t
        .to_uppercase())),
    text!("lower", "In small letters.", [], |c| mapped(c, |t| t
        .to_lowercase())),
    text!(
        "strip",
        "Without white space at both ends.",
        [],
        |c| mapped(c, |t| t.trim().to_string())
    ),
    text!(
        "startswith",
        "Whether it begins with a text.",
        [PART],
        |c| {
            let (text, part) = (receiver(c)?, part(c, "part")?);
            Ok(Value::Bool(text.starts_with(&*part)))
        }
    ),
    text!("endswith", "Whether it ends with a text.", [PART], |c| {
        let (text, part) = (receiver(c)?, part(c, "part")?);
        Ok(Value::Bool(text.ends_with(&*part)))
    }),
    text!("find", "Where a text begins in it, or -1.", [PART], |c| {
        let (text, part) = (receiver(c)?, part(c, "part")?);
        let at = text
            .find(&*part)
            .map(|at| text[..at].chars().count() as i64);
        Ok(Value::Int(at.unwrap_or(-1)))
    }),
    text!("count", "How often a text is in it.", [PART], |c| {
        let (text, part) = (receiver(c)?, part(c, "part")?);
        Ok(Value::Int(text.matches(&*part).count() as i64))
    }),
    text!(
        "replace",
        "With a text replaced by another.",
        [slot("old", "", "What."), slot("new", "", "By what.")],
        |c| {
            let (text, old, new) = (receiver(c)?, part(c, "old")?, part(c, "new")?);
            let count = text.matches(&*old).count();
            c.machine
                .grow(text.len().saturating_add(count.saturating_mul(new.len())))?;
            c.machine.text(text.replace(&*old, &new))
        }
    ),
    text!(
        "split",
        "Its parts between a separator.",
        [slot("by", "white space", "The separator.")],
        |c| {
            let text = receiver(c)?;
            let by = c.get("by").map(|g| c.text("by", g)).transpose()?;
            let parts: Vec<&str> = match by.as_deref() {
                Some("") => return Err(mistake("split() needs a separator that is not empty")),
                Some(by) => text.split(by).collect(),
                None => text.split_whitespace().collect(),
            };
            texts(c, parts.into_iter())
        }
    ),
    text!("elems", "Its characters.", [], |c| {
        let text = receiver(c)?;
        texts(c, text.split("").filter(|s| !s.is_empty()))
    }),
    text!(
        "join",
        "The texts of a list with this one between them.",
        [slot("parts", "", "A list of texts.")],
        join
    ),
    Native {
        name: "format",
        doc: "With values in place of {}, {0} or {name}.",
        group: "Texts",
        params: &[],
        rest: true,
        run: |c| {
            let text = receiver(c)?;
            let values: Vec<Value> = c.rest.iter().map(|g| g.value).collect();
            c.machine.format(&text, &values, &[])
        },
    },
];

/// Methods of lists.
pub(crate) const LIST: &[Native] = &[
    list!("append", "Adds an item at the end.", [VALUE], |c| {
        let (list, value) = (list(c), c.need_any("value")?);
        c.machine.grow_items(1)?;
        c.machine.change(list)?.push(value);
        Ok(Value::None)
    }),
    list!(
        "extend",
        "Adds items at the end.",
        [slot("items", "", "A list.")],
        |c| {
            let (list, items) = (list(c), c.need("items")?);
            c.machine.extend(list, items.value)?;
            Ok(Value::None)
        }
    ),
    list!(
        "insert",
        "Adds an item before a place.",
        [slot("place", "", "The place."), VALUE],
        |c| {
            let (list, value) = (list(c), c.need_any("value")?);
            let length = c.machine.store.list(list).items.len();
            let at = match c.need("place")? {
                Given {
                    value: Value::Int(i),
                    ..
                } if i < 0 => length.saturating_sub(i.unsigned_abs() as usize),
                Given {
                    value: Value::Int(i),
                    ..
                } => length.min(i as usize),
                given => return Err(c.unfit("place", "a whole number", given)),
            };
            c.machine.charge(length as u64 / 16)?;
            c.machine.grow_items(1)?;
            c.machine.change(list)?.insert(at, value);
            Ok(Value::None)
        }
    ),
    list!(
        "pop",
        "Takes an item out and gives it.",
        [slot("place", "-1", "The place.")],
        |c| {
            let list = list(c);
            let length = c.machine.store.list(list).items.len() as u64;
            let index = c.get("place").map_or(Value::Int(-1), |g| g.value);
            let at = c.machine.place_in(index, length)?;
            c.machine.charge(length / 16)?;
            Ok(c.machine.change(list)?.remove(at as usize))
        }
    ),
    list!("index", "The place of an item.", [VALUE], |c| {
        let value = c.need_any("value")?;
        let (mut at, mut found) = (0, false);
        c.machine.each(c.receiver, |m, x| {
            found = m.equal(x, value, 0)?;
            at += i64::from(!found);
            Ok(!found)
        })?;
        if found {
            Ok(Value::Int(at))
        } else {
            Err(mistake("the list has no such item"))
        }
    }),
    list!("clear", "Takes all items out.", [], |c| {
        let list = list(c);
        c.machine.change(list)?.clear();
        Ok(Value::None)
    }),
];

/// Methods of dicts.
pub(crate) const DICT: &[Native] = &[
    dict!(
        "get",
        "The value of a key, or a default.",
        [KEY, slot("default", "None", "Any value.")],
        |c| {
            let (dict, key) = (dict(c), c.need_any("key")?);
            let key = c.machine.key(key, 0)?;
            let default = c.get("default").map_or(Value::None, |g| g.value);
            Ok(c.machine
                .store
                .dict(dict)
                .pairs
                .get(&key)
                .map_or(default, |p| p.1))
        }
    ),
    dict!("keys", "Its keys.", [], |c| {
        let pairs = pairs(c)?;
        c.machine.list(pairs.into_iter().map(|p| p.0).collect())
    }),
    dict!("values", "Its values.", [], |c| {
        let pairs = pairs(c)?;
        c.machine.list(pairs.into_iter().map(|p| p.1).collect())
    }),
    dict!("items", "Its pairs of key and value.", [], |c| {
        let pairs = pairs(c)?;
        c.machine.grow_items(pairs.len())?;
        let tuples = pairs
            .into_iter()
            .map(|(k, v)| c.machine.tuple(vec![k, v]))
            .collect::<Run<Vec<Value>>>()?;
        c.machine.list(tuples)
    }),
    dict!(
        "update",
        "Takes over all pairs of another dict.",
        [slot("other", "", "A dict.")],
        |c| {
            let dict = dict(c);
            let Given {
                value: Value::Dict(other),
                ..
            } = c.need("other")?
            else {
                let given = c.need("other")?;
                return Err(c.unfit("other", "a dict", given));
            };
            let pairs: Vec<_> = c
                .machine
                .store
                .dict(other)
                .pairs
                .values()
                .copied()
                .collect();
            pairs
                .into_iter()
                .try_for_each(|(k, v)| c.machine.insert(dict, k, v))?;
            Ok(Value::None)
        }
    ),
    dict!(
        "setdefault",
        "The value of a key, set first where there is none.",
        [KEY, slot("default", "None", "Any value.")],
        |c| {
            let (dict, key) = (dict(c), c.need_any("key")?);
            let content = c.machine.key(key, 0)?;
            if let Some(pair) = c.machine.store.dict(dict).pairs.get(&content) {
                return Ok(pair.1);
            }
            let default = c.get("default").map_or(Value::None, |g| g.value);
            c.machine.insert(dict, key, default)?;
            Ok(default)
        }
    ),
];

fn receiver(c: &mut Call<'_, '_>) -> Run<Arc<str>> {
    let Value::Text(i) = c.receiver else {
        return Err(mistake("this is not a text"));
    };
    let text = c.machine.store.text(i).clone();
    c.machine.charge(text.len() as u64 / 16)?;
    Ok(text)
}

fn part(c: &mut Call<'_, '_>, name: &str) -> Run<Arc<str>> {
    let given = c.need(name)?;
    let part = c.text(name, given)?;
    c.machine.charge(part.len() as u64 / 16)?;
    Ok(part)
}

/// A text made from a text; letters may grow threefold when their case changes.
fn mapped(c: &mut Call<'_, '_>, f: impl Fn(&str) -> String) -> Run<Value> {
    let text = receiver(c)?;
    c.machine.grow(3 * text.len())?;
    c.machine.text(f(&text))
}

/// A list of texts.
fn texts<'t>(c: &mut Call<'_, '_>, parts: impl Iterator<Item = &'t str>) -> Run<Value> {
    let mut out = Vec::new();
    for part in parts {
        c.machine.grow_items(1)?;
        out.push(c.machine.text(part)?);
    }
    c.machine.list(out)
}

fn join(c: &mut Call<'_, '_>) -> Run<Value> {
    let (by, given) = (receiver(c)?, c.need("parts")?);
    let mut out = String::new();
    for (i, part) in c.machine.collect(given.value)?.into_iter().enumerate() {
        let Value::Text(text) = part else {
            let kind = c.machine.store.kind(part);
            return Err(mistake(format!("join() needs texts, not {kind}"))
                .help("str(...) makes a text of it")
                .at(given.place));
        };
        let text = c.machine.store.text(text).clone();
        c.machine.grow(text.len() + by.len())?;
        if i > 0 {
            out.push_str(&by);
        }
        out.push_str(&text);
    }
    c.machine.text(out)
}

fn list(c: &Call<'_, '_>) -> u32 {
    match c.receiver {
        Value::List(i) => i,
        _ => unreachable!("methods of lists are looked up by lists only"),
    }
}

fn dict(c: &Call<'_, '_>) -> u32 {
    match c.receiver {
        Value::Dict(i) => i,
        _ => unreachable!("methods of dicts are looked up by dicts only"),
    }
}

fn pairs(c: &mut Call<'_, '_>) -> Run<Vec<(Value, Value)>> {
    let dict = dict(c);
    c.machine
        .grow_items(2 * c.machine.store.dict(dict).pairs.len())?;
    Ok(c.machine.store.dict(dict).pairs.values().copied().collect())
}
