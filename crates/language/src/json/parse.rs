//! From text to JSON values: each is charged before it is made, and no key stands twice in an object.

use crate::budget::{LoadBudget, Spent};
use crate::report::{Place, Report, Source};
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};
use std::fmt;

/// Bytes of a value in a list, which may be half as large again as what it holds while it grows.
const ITEM: u64 = 2 * size_of::<Value>() as u64;
/// Bytes of an object beside its members, but for the room for more of them.
const OBJECT: u64 = 256;
/// Bytes of a member of an object beside its key.
const MEMBER: u64 = ITEM + 64;
/// Bytes of a text beside its own.
const TEXT: u64 = 32;
/// Values between two looks at the clock.
const CLOCK: u64 = 1024;

/// The value that a text says.
pub(super) fn parse(source: &Source, budget: &mut LoadBudget) -> Result<Value, Box<Report>> {
    let mut state = State {
        budget,
        values: 0,
        stopped: None,
    };
    let mut reader = serde_json::Deserializer::from_str(&source.text);
    let value = Strict(&mut state).deserialize(&mut reader);
    let value = value.and_then(|value| reader.end().map(|()| value));
    value.map_err(|e| Box::new(wrong(&e, state.stopped, source)))
}

struct State<'b> {
    budget: &'b mut LoadBudget,
    values: u64,
    stopped: Option<Stop>,
}

/// Why valid JSON is not read on.
enum Stop {
    Spent(Spent),
    Twice(String),
}

impl State<'_> {
    fn charge<E: Error>(&mut self, bytes: u64) -> Result<(), E> {
        self.values += 1;
        let held = self
            .budget
            .hold(bytes, || "what this file says".to_string());
        let spent = held.and_then(|()| match self.values % CLOCK {
            0 => self.budget.check_clock(),
            _ => Ok(()),
        });
        spent.map_err(|e| self.stop(Stop::Spent(e)))
    }

    fn stop<E: Error>(&mut self, why: Stop) -> E {
        self.stopped = Some(why);
        E::custom("stopped")
    }
}

/// Reads a value.
struct Strict<'s, 'b>(&'s mut State<'b>);

impl<'de> DeserializeSeed<'de> for Strict<'_, '_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Value, D::Error> {
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Strict<'_, '_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E: Error>(self, x: bool) -> Result<Value, E> {
        Ok(Value::Bool(x))
    }

    fn visit_i64<E: Error>(self, x: i64) -> Result<Value, E> {
        Ok(x.into())
    }

    fn visit_u64<E: Error>(self, x: u64) -> Result<Value, E> {
        Ok(x.into())
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Value, E> {
        let number = Number::from_f64(x).map(Value::Number);
        number.ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E: Error>(self, x: &str) -> Result<Value, E> {
        self.0.charge::<E>(TEXT + x.len() as u64)?;
        Ok(x.into())
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut out = Vec::new();
        loop {
            self.0.charge::<A::Error>(ITEM)?;
            match items.next_element_seed(Strict(self.0))? {
                Some(item) => out.push(item),
                None => return Ok(Value::Array(out)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Value, A::Error> {
        self.0.charge::<A::Error>(OBJECT)?;
        let mut out = Map::new();
        while let Some(key) = members.next_key::<String>()? {
            if out.contains_key(&key) {
                return Err(self.0.stop(Stop::Twice(key)));
            }
            self.0
                .charge::<A::Error>(MEMBER + TEXT + key.len() as u64)?;
            let value = members.next_value_seed(Strict(self.0))?;
            out.insert(key, value);
        }
        Ok(Value::Object(out))
    }
}

/// What is wrong, at its place.
fn wrong(error: &serde_json::Error, stopped: Option<Stop>, source: &Source) -> Report {
    let lines = source.text.split_inclusive('\n');
    let before = lines.take(error.line().saturating_sub(1));
    let at = before.map(str::len).sum::<usize>() + error.column();
    let place = |start: usize, end: usize| Place {
        file: 0,
        start: start as u32,
        end: end as u32,
    };
    match stopped {
        Some(Stop::Spent(spent)) => {
            Report::new(spent.to_string()).at(source, place(at.saturating_sub(1), at))
        }
        Some(Stop::Twice(key)) => {
            let (start, end) = key_before(&source.text, at);
            let key = crate::naming::shortened(&key, 60);
            Report::new(format!("the key \"{key}\" stands twice in this object"))
                .with_help("leave one of the two out")
                .at(source, place(start, end))
        }
        None => syntax(error, source, place(at.saturating_sub(1), at)),
    }
}

/// A syntax error.
fn syntax(error: &serde_json::Error, source: &Source, place: Place) -> Report {
    if source.text.trim().is_empty() {
        let report = Report::new("this is not JSON: the file is empty").at(source, place);
        return report.with_help("a scene begins with {\"zeroset\": 1, \"objects\": [...]}");
    }
    let text = error.to_string();
    let message = text
        .rsplit_once(" at line ")
        .map_or(text.as_str(), |(message, _)| message);
    let report = Report::new(format!("this is not JSON: {message}")).at(source, place);
    match message {
        "recursion limit exceeded" => {
            report.with_help("put what lies deep into `parts` and refer to it")
        }
        "expected value" => report.with_help(
            "a value is a number, a \"text\", true, false, a [list] or an {object}; there is no NaN and no Infinity",
        ),
        "number out of range" => report.with_help("the largest number is 1.797e308"),
        _ => report,
    }
}

/// Where the last text before a place begins and ends, quotes included.
fn key_before(text: &str, at: usize) -> (usize, usize) {
    let bytes = &text.as_bytes()[..at.min(text.len())];
    let Some(last) = bytes.iter().rposition(|b| *b == b'"') else {
        return (at, at);
    };
    let is_quote = |i: &usize| {
        let slashes = bytes[..*i].iter().rev().take_while(|b| **b == b'\\');
        bytes[*i] == b'"' && slashes.count().is_multiple_of(2)
    };
    let first = (0..last).rev().find(is_quote).unwrap_or(last);
    (first, last + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limits::Limits;

    fn parsed(text: &str, limits: Limits) -> Result<Value, Box<Report>> {
        parse(&Source::new("a.json", text), &mut LoadBudget::new(&limits))
    }

    /// What is accepted is what `serde_json` itself makes of it.
    #[test]
    fn the_same_values() {
        for text in [
            "null",
            "true",
            "-0.0",
            "-0",
            "1e-400",
            "18446744073709551615",
            "-9223372036854775808",
            "99999999999999999999",
            r#""\u00e9\n𝄞""#,
            "[]",
            "{}",
            r#" {"a": [1, {"b": null}, []], "": "x", "c": {}} "#,
            "[0.1, 5e-324, 1.7976931348623157e308]",
        ] {
            let right: Value = serde_json::from_str(text).unwrap();
            let value = parsed(text, Limits::default()).unwrap();
            assert_eq!(value.to_string(), right.to_string(), "{text}");
        }
        for text in [
            "",
            "[1,]",
            "{\"a\" 1}",
            "1 2",
            "NaN",
            "1e400",
            "\"\\ud800\"",
            "[",
            "01",
            "'a'",
            "\"\u{1}\"",
        ] {
            assert!(serde_json::from_str::<Value>(text).is_err(), "{text}");
            assert!(parsed(text, Limits::default()).is_err(), "{text}");
        }
    }

    #[test]
    fn keys_that_stand_twice() {
        for (text, position) in [
            (r#"{"a": 1, "a": 2}"#, (1, 10)),
            ("{\"a\": [{\"x\": 1,\n  \"y\": {},\n  \"x\" : 1}]}", (3, 3)),
            (r#"{"a\"": 1, "\u0061\"": 2}"#, (1, 12)),
            (r#"{"é": 1, "": 2, "": 3}"#, (1, 17)),
        ] {
            let report = parsed(text, Limits::default()).unwrap_err();
            assert!(report.message().contains("twice"), "{report}");
            assert_eq!(report.position(), Some(position), "{text}");
        }
        assert!(parsed(r#"[{"a": {"a": 1}}, {"a": 2}]"#, Limits::default()).is_ok());
    }

    #[test]
    fn values_are_charged_before_they_are_made() {
        let limits = Limits {
            memory: 8 << 20,
            ..Limits::default()
        };
        for text in [
            format!("[{}]", vec!["0"; 20_000].join(",")),
            format!("[{}]", vec!["[]"; 20_000].join(",")),
            format!("\"{}\"", "x".repeat(2 << 20)),
            format!(
                "{{{}}}",
                (0..10_000)
                    .map(|i| format!("\"{i}\":0"))
                    .collect::<Vec<_>>()
                    .join(",")
            ),
        ] {
            let report = parsed(&text, limits).unwrap_err();
            assert!(report.message().contains("memory"), "{report}");
            assert!(parsed(&text, Limits::default()).is_ok());
        }
    }
}
