//! Python's everyday functions.

use super::mistake::{Run, mistake};
use super::native::{Call, Given, Native, Slot, slot};
use super::sequences::range_of;
use super::value::Value;
use std::cmp::Ordering;

const GROUP: &str = "Values and lists";

macro_rules! native {
    ($name:literal, $doc:literal, [$($slot:expr),*], $run:expr) => {
        Native { name: $name, doc: $doc, group: GROUP, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: false, run: $run }
    };
    ($name:literal, $doc:literal, [$($slot:expr),*] .., $run:expr) => {
        Native { name: $name, doc: $doc, group: GROUP, params: { const S: &[Slot] = &[$($slot),*]; S }, rest: true, run: $run }
    };
}

const X: Slot = slot("x", "", "Any value.");
const ITEMS: Slot = slot("items", "", "A list, tuple, range or dict.");

/// The functions.
pub(crate) const ALL: &[Native] = &[
    native!(
        "len",
        "Number of items of a list, or of characters of a text.",
        [X],
        |c| {
            let given = c.need("x")?;
            if let Value::Text(i) = given.value {
                c.machine
                    .charge(c.machine.store.text(i).len() as u64 / 16)?;
            }
            let length = c.machine.length(given.value)?;
            Ok(Value::Int(i64::try_from(length).unwrap_or(i64::MAX)))
        }
    ),
    native!(
        "range",
        "Whole numbers from 0 to before a stop, or from a start by a step.",
        []..,
        range
    ),
    native!(
        "list",
        "A new list of the items.",
        [slot("items", "[]", ITEMS.doc)],
        |c| {
            let items = optional_items(c)?;
            c.machine.list(items)
        }
    ),
    native!(
        "tuple",
        "A tuple of the items.",
        [slot("items", "()", ITEMS.doc)],
        |c| {
            let items = optional_items(c)?;
            c.machine.tuple(items)
        }
    ),
    native!(
        "dict",
        "A dict of pairs, and of names: dict(a = 1).",
        [slot(
            "pairs",
            "[]",
            "A list of (key, value), or a dict; names with values may follow."
        )],
        dict
    ),
    native!(
        "enumerate",
        "Pairs of number and item.",
        [ITEMS, slot("start", "0", "The first number.")],
        enumerate
    ),
    native!(
        "zip",
        "Tuples of the items that stand at the same place.",
        []..,
        zip
    ),
    native!("reversed", "The items from last to first.", [ITEMS], |c| {
        let mut items = items(c)?;
        items.reverse();
        c.machine.list(items)
    }),
    native!(
        "sorted",
        "The items in order.",
        [
            ITEMS,
            slot(
                "key",
                "None",
                "A function of an item that gives what to sort by."
            ),
            slot("reverse", "False", "Whether the largest comes first.")
        ],
        sorted
    ),
    native!(
        "sum",
        "The sum of numbers.",
        [ITEMS, slot("start", "0", "What to begin with.")],
        |c| {
            let items = items(c)?;
            let start = c.get("start").map_or(Value::Int(0), |g| g.value);
            items.into_iter().try_fold(start, |a, b| {
                c.machine
                    .operate(starlark_syntax::syntax::ast::BinOp::Add, a, b)
            })
        }
    ),
    native!(
        "min",
        "The smallest of several values, or of a list.",
        []..,
        |c| extreme(c, Ordering::Less)
    ),
    native!(
        "max",
        "The largest of several values, or of a list.",
        []..,
        |c| extreme(c, Ordering::Greater)
    ),
    native!("any", "Whether one of the items is true.", [ITEMS], |c| {
        for item in items(c)? {
            if c.machine.truth(item)? {
                return Ok(Value::Bool(true));
            }
        }
        Ok(Value::Bool(false))
    }),
    native!("all", "Whether all items are true.", [ITEMS], |c| {
        for item in items(c)? {
            if !c.machine.truth(item)? {
                return Ok(Value::Bool(false));
            }
        }
        Ok(Value::Bool(true))
    }),
    native!(
        "int",
        "A whole number: the fraction is cut off; a text is read.",
        [X],
        int
    ),
    native!(
        "float",
        "A number with a point; a text is read.",
        [X],
        |c| {
            let given = c.need("x")?;
            match given.value {
                Value::Text(i) => {
                    let text = c.machine.store.text(i).clone();
                    c.machine.charge(text.len() as u64 / 16)?;
                    let x = text
                        .trim()
                        .parse()
                        .map_err(|_| mistake(format!("\"{text}\" is no number")).at(given.place))?;
                    Ok(Value::Float(x))
                }
                Value::Bool(b) => Ok(Value::Float(f64::from(u8::from(b)))),
                _ => Ok(Value::Float(c.number("x", given)?)),
            }
        }
    ),
    native!(
        "bool",
        "Whether a value is true: not 0, not empty, not None.",
        [X],
        |c| {
            let value = c.need_any("x")?;
            Ok(Value::Bool(c.machine.truth(value)?))
        }
    ),
    native!("str", "A value as text.", [X], |c| {
        let value = c.need_any("x")?;
        let text = c.machine.spelled(value)?;
        c.machine.text(text)
    }),
    native!("repr", "A value as it is written in a script.", [X], |c| {
        let value = c.need_any("x")?;
        let text = c.machine.shown(value)?;
        c.machine.text(text)
    }),
    native!("type", "The kind of a value, as text.", [X], |c| {
        let value = c.need_any("x")?;
        let name = match value {
            Value::None => "NoneType",
            Value::Bool(_) => "bool",
            Value::Int(_) => "int",
            Value::Float(_) => "float",
            Value::Text(_) => "string",
            Value::List(_) => "list",
            Value::Tuple(_) => "tuple",
            Value::Dict(_) => "dict",
            Value::Range(_) => "range",
            Value::Thing(i) => c
                .machine
                .store
                .thing(i)
                .kind()
                .trim_start_matches("an ")
                .trim_start_matches("a "),
            _ => "function",
        };
        c.machine.text(name)
    }),
    native!(
        "print",
        "Writes values to the log, for finding mistakes.",
        []..,
        |c| {
            let values: Vec<Value> = c.rest.iter().map(|g| g.value).collect();
            let mut line = String::new();
            for value in values {
                if !line.is_empty() {
                    line.push(' ');
                }
                line.push_str(&c.machine.spelled(value)?);
            }
            c.machine.draft.print(&line);
            Ok(Value::None)
        }
    ),
    native!("fail", "Ends the script with a message.", [].., |c| {
        let values: Vec<Value> = c.rest.iter().map(|g| g.value).collect();
        let words = values
            .into_iter()
            .map(|v| c.machine.spelled(v))
            .collect::<Run<Vec<String>>>()?;
        Err(mistake(words.join(" ")))
    }),
];

impl Call<'_, '_> {
    /// A value that must be given, be it None.
    pub(crate) fn need_any(&self, param: &str) -> Run<Value> {
        let i = self.params.iter().position(|p| *p == param);
        match i.and_then(|i| self.given[i]) {
            Some(given) => Ok(given.value),
            None => self.need(param).map(|g| g.value),
        }
    }
}

fn items(c: &mut Call<'_, '_>) -> Run<Vec<Value>> {
    let given = c.need("items")?;
    c.machine
        .collect(given.value)
        .map_err(|m| m.at(given.place))
}

fn optional_items(c: &mut Call<'_, '_>) -> Run<Vec<Value>> {
    if c.get("items").is_some() {
        items(c)
    } else {
        Ok(Vec::new())
    }
}

fn range(c: &mut Call<'_, '_>) -> Run<Value> {
    let numbers = c.rest.iter().map(|g| match g.value {
        Value::Int(i) => Ok(i),
        other => {
            let kind = c.machine.store.kind(other);
            let help = "int(x) cuts off the fraction, and // divides whole numbers";
            Err(mistake(format!("range() needs whole numbers, not {kind}"))
                .help(help)
                .at(g.place))
        }
    });
    let numbers = numbers.collect::<Run<Vec<i64>>>()?;
    let (start, stop, step) = match numbers[..] {
        [stop] => (0, stop, 1),
        [start, stop] => (start, stop, 1),
        [start, stop, step] => (start, stop, step),
        _ => {
            return Err(mistake(
                "range() takes a stop, or a start and a stop, or a start, a stop and a step",
            ));
        }
    };
    if step == 0 {
        return Err(mistake("the step of range() cannot be 0").at(c.rest[2].place));
    }
    c.machine.range(range_of(start, stop, step))
}

fn dict(c: &mut Call<'_, '_>) -> Run<Value> {
    let dict = c.machine.dict()?;
    if let Some(given) = c.get("pairs") {
        if let Value::Dict(other) = given.value {
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
        } else {
            for pair in c
                .machine
                .collect(given.value)
                .map_err(|m| m.at(given.place))?
            {
                match c.machine.store.items(pair) {
                    Some(&[key, value]) => c.machine.insert(dict, key, value)?,
                    _ => {
                        return Err(
                            mistake("dict() needs pairs such as (\"key\", 1)").at(given.place)
                        );
                    }
                }
            }
        }
    }
    Ok(Value::Dict(dict))
}

fn enumerate(c: &mut Call<'_, '_>) -> Run<Value> {
    let items = items(c)?;
    let start = match c.get("start") {
        None => 0,
        Some(Given {
            value: Value::Int(i),
            ..
        }) => i,
        Some(given) => return Err(c.unfit("start", "a whole number", given)),
    };
    c.machine.grow_items(2 * items.len())?;
    let numbers = (0..).map(|i: i64| Value::Int(start.saturating_add(i)));
    let pairs = numbers
        .zip(items)
        .map(|(i, x)| c.machine.tuple(vec![i, x]))
        .collect::<Run<Vec<Value>>>()?;
    c.machine.list(pairs)
}

fn zip(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = std::mem::take(&mut c.rest);
    let lists = given
        .iter()
        .map(|g| c.machine.collect(g.value).map_err(|m| m.at(g.place)));
    let lists = lists.collect::<Run<Vec<Vec<Value>>>>()?;
    let length = lists.iter().map(Vec::len).min().unwrap_or(0);
    c.machine
        .grow_items(length.saturating_mul(lists.len() + 1))?;
    let rows = (0..length).map(|i| c.machine.tuple(lists.iter().map(|l| l[i]).collect()));
    let rows = rows.collect::<Run<Vec<Value>>>()?;
    c.machine.list(rows)
}

fn sorted(c: &mut Call<'_, '_>) -> Run<Value> {
    let items = items(c)?;
    let (key, reverse) = (c.get("key"), c.flag_or("reverse", false)?);
    let mut pairs = Vec::with_capacity(items.len());
    for item in items {
        let by = match key {
            None => item,
            Some(key) => {
                let argument = super::native::Argument {
                    name: None,
                    value: item,
                    place: key.place,
                };
                c.machine.call(key.value, vec![argument], c.place)?
            }
        };
        pairs.push((by, item));
    }
    let sorted = merge_sort(c, pairs, reverse)?;
    c.machine.list(sorted.into_iter().map(|p| p.1).collect())
}

/// A stable merge sort that ends at the first pair that cannot be compared.
fn merge_sort(
    c: &mut Call<'_, '_>,
    mut pairs: Vec<(Value, Value)>,
    reverse: bool,
) -> Run<Vec<(Value, Value)>> {
    if pairs.len() < 2 {
        return Ok(pairs);
    }
    let right = pairs.split_off(pairs.len() / 2);
    let left = merge_sort(c, pairs, reverse)?;
    let right = merge_sort(c, right, reverse)?;
    let (mut out, mut right) = (
        Vec::with_capacity(left.len() + right.len()),
        right.into_iter().peekable(),
    );
    let first = if reverse {
        Ordering::Greater
    } else {
        Ordering::Less
    };
    for item in left {
        while let Some(other) = right.peek() {
            if c.machine.order(other.0, item.0, 0)? != first {
                break;
            }
            out.extend(right.next());
        }
        out.push(item);
    }
    out.extend(right);
    Ok(out)
}

fn extreme(c: &mut Call<'_, '_>, wanted: Ordering) -> Run<Value> {
    let given = std::mem::take(&mut c.rest);
    let items = match given[..] {
        [one] => c.machine.collect(one.value).map_err(|m| m.at(one.place))?,
        _ => given.iter().map(|g| g.value).collect(),
    };
    let mut best: Option<Value> = None;
    for x in items {
        let better = match best {
            None => true,
            Some(b) => c.machine.order(x, b, 0)? == wanted,
        };
        if better {
            best = Some(x);
        }
    }
    best.ok_or_else(|| mistake(format!("{}() of no values", c.name)))
}

fn int(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("x")?;
    match given.value {
        Value::Int(_) => Ok(given.value),
        Value::Bool(b) => Ok(Value::Int(i64::from(b))),
        Value::Float(x) if x.abs() < 9e18 => Ok(Value::Int(x as i64)),
        Value::Float(x) => {
            Err(mistake(format!("{x:e} is too large for a whole number")).at(given.place))
        }
        Value::Text(i) => {
            let text = c.machine.store.text(i).clone();
            c.machine.charge(text.len() as u64 / 16)?;
            let x = text
                .trim()
                .parse()
                .map_err(|_| mistake(format!("\"{text}\" is no whole number")).at(given.place))?;
            Ok(Value::Int(x))
        }
        _ => Err(c.unfit("x", "a number or a text", given)),
    }
}
