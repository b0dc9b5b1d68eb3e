//! Values as text.

use super::machine::{MAX_TEXT, Machine};
use super::mistake::{Run, mistake};
use super::value::{Thing, Value};
use std::fmt::Write;

/// How deep values are written into each other; deeper ones become `...`.
const MAX_DEPTH: u32 = 16;

impl<'a> Machine<'a> {
    /// A value as a person reads it: a text as it is, others as they are written in a script.
    pub(crate) fn spelled(&mut self, value: Value) -> Run<String> {
        match value {
            Value::Text(i) => {
                self.grow(self.store.text(i).len())?;
                Ok(self.store.text(i).to_string())
            }
            other => self.shown(other),
        }
    }

    /// A value as it is written in a script.
    pub(crate) fn shown(&mut self, value: Value) -> Run<String> {
        let mut out = String::new();
        self.show(value, 0, &mut out)?;
        self.grow(out.len())?;
        Ok(out)
    }

    fn show(&mut self, value: Value, depth: u32, out: &mut String) -> Run<()> {
        self.charge(1 + out.len() as u64 / 4096)?;
        if out.len() > MAX_TEXT {
            return Err(mistake(format!("a text may have at most {MAX_TEXT} bytes")));
        }
        if depth > MAX_DEPTH {
            out.push_str("...");
            return Ok(());
        }
        match value {
            Value::None => out.push_str("None"),
            Value::Bool(b) => out.push_str(if b { "True" } else { "False" }),
            Value::Int(i) => _ = write!(out, "{i}"),
            Value::Float(x) => _ = write!(out, "{x:?}"),
            Value::Text(i) => {
                let text = self.store.text(i).clone();
                self.charge(text.len() as u64 / 16)?;
                _ = write!(out, "{text:?}");
            }
            Value::List(_) | Value::Tuple(_) => {
                let (open, close) = if matches!(value, Value::List(_)) {
                    ('[', ']')
                } else {
                    ('(', ')')
                };
                out.push(open);
                let length = self.store.items(value).unwrap_or_default().len();
                for k in 0..length {
                    if k > 0 {
                        out.push_str(", ");
                    }
                    let item = self.store.items(value).unwrap_or_default()[k];
                    self.show(item, depth + 1, out)?;
                }
                if length == 1 && close == ')' {
                    out.push(',');
                }
                out.push(close);
            }
            Value::Dict(i) => {
                out.push('{');
                for k in 0..self.store.dict(i).pairs.len() {
                    if k > 0 {
                        out.push_str(", ");
                    }
                    let (key, item) = self.store.dict(i).pairs[k];
                    self.show(key, depth + 1, out)?;
                    out.push_str(": ");
                    self.show(item, depth + 1, out)?;
                }
                out.push('}');
            }
            Value::Range(i) => {
                let r = *self.store.range(i);
                let stop = r.at(r.length);
                _ = write!(out, "range({}, {stop}, {})", r.start, r.step);
            }
            Value::Function(i) => _ = write!(out, "<function {}>", self.functions[i as usize].name),
            Value::Native(n) => _ = write!(out, "<function {}>", n.name),
            Value::Primitive(e) => _ = write!(out, "<function {}>", e.info.name),
            Value::Join(e) => _ = write!(out, "<function {}>", e.info.name),
            Value::Formula(f) => _ = write!(out, "<function {}>", f.name),
            Value::Bound(i) => _ = write!(out, "<method {}>", self.store.bound[i as usize].1),
            Value::Thing(i) => match self.store.thing(i) {
                Thing::Field(field) => _ = write!(out, "<field of {} nodes>", field.facts().nodes),
                other => {
                    _ = write!(
                        out,
                        "<{}>",
                        other
                            .kind()
                            .trim_start_matches("a ")
                            .trim_start_matches("an ")
                    )
                }
            },
        }
        Ok(())
    }

    /// `format.format(...)`: `{}` by order, `{0}` by place, `{name}` by name, `{{` for a brace.
    pub(crate) fn format(
        &mut self,
        format: &str,
        values: &[Value],
        named: &[(String, Value)],
    ) -> Run<Value> {
        let mut out = String::new();
        let (mut rest, mut next) = (format, 0);
        while let Some(at) = rest.find(['{', '}']) {
            out.push_str(&rest[..at]);
            let brace = &rest[at..=at];
            rest = &rest[at + 1..];
            if let Some(after) = rest.strip_prefix(brace) {
                out.push_str(brace);
                rest = after;
                continue;
            }
            let end = rest.find('}').filter(|_| brace == "{");
            let end = end.ok_or_else(|| {
                mistake(format!("a single {brace} in a format")).help("{{ stands for a brace")
            })?;
            let (name, raw) = match rest[..end].split_once('!') {
                Some((name, "r")) => (name, true),
                Some((name, "s")) => (name, false),
                None => (&rest[..end], false),
                Some((_, other)) => {
                    return Err(
                        mistake(format!("unknown conversion !{other}")).help("there are !r and !s")
                    );
                }
            };
            let value = if name.is_empty() {
                next += 1;
                values.get(next - 1).copied()
            } else if let Ok(i) = name.parse::<usize>() {
                values.get(i).copied()
            } else {
                named.iter().find(|(n, _)| n == name).map(|(_, v)| *v)
            };
            let value = value.ok_or_else(|| mistake(format!("nothing is given for {{{name}}}")))?;
            out += &if raw {
                self.shown(value)?
            } else {
                self.spelled(value)?
            };
            if out.len() > MAX_TEXT {
                break;
            }
            rest = &rest[end + 1..];
        }
        out.push_str(rest);
        self.grow(out.len())?;
        self.text(out)
    }

    /// `format % values`: %s, %r, %d, %f, %g with an optional number of decimals, %x, %%.
    pub(crate) fn percent(&mut self, format: &str, values: Value) -> Run<Value> {
        let items = match values {
            Value::Tuple(i) => self.store.tuple(i).to_vec(),
            other => vec![other],
        };
        self.grow_items(items.len())?;
        let (mut out, mut rest, mut next) = (String::new(), format, items.iter());
        while let Some(at) = rest.find('%') {
            out.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let digits = rest
                .find(|c: char| !c.is_ascii_digit() && c != '.')
                .unwrap_or(rest.len());
            let (size, kind) = (&rest[..digits], rest[digits..].chars().next());
            let decimals = size
                .split_once('.')
                .and_then(|(_, d)| d.parse::<usize>().ok())
                .unwrap_or(6)
                .min(30);
            if kind == Some('%') {
                out.push('%');
                rest = &rest[digits + 1..];
                continue;
            }
            let value = *next
                .next()
                .ok_or_else(|| mistake("fewer values than % in the format"))?;
            let number = match value {
                Value::Int(i) => Some(i as f64),
                Value::Float(x) => Some(x),
                _ => None,
            };
            let no_number = |m: &Self| {
                let kind_of = m.store.kind(value);
                mistake(format!(
                    "%{} needs a number, not {kind_of}",
                    kind.unwrap_or(' ')
                ))
            };
            match kind {
                Some('s') => out += &self.spelled(value)?,
                Some('r') => out += &self.shown(value)?,
                Some('d' | 'i') => match value {
                    Value::Int(i) => _ = write!(out, "{i}"),
                    _ => _ = write!(out, "{}", number.ok_or_else(|| no_number(self))?.trunc()),
                },
                Some('x') => match value {
                    Value::Int(i) => _ = write!(out, "{i:x}"),
                    _ => return Err(no_number(self)),
                },
                Some('f' | 'F') => {
                    _ = write!(out, "{:.decimals$}", number.ok_or_else(|| no_number(self))?)
                }
                Some('g' | 'e') => _ = write!(out, "{}", number.ok_or_else(|| no_number(self))?),
                other => {
                    let shown = other.map_or("at the end".to_string(), |c| format!("before `{c}`"));
                    return Err(mistake(format!("% {shown} in a format"))
                        .help("there are %s %r %d %f %g %x, and %% for %"));
                }
            }
            if out.len() > MAX_TEXT {
                break;
            }
            rest = &rest[digits + 1..];
        }
        if next.next().is_some() {
            return Err(mistake("more values than % in the format"));
        }
        out.push_str(rest);
        self.grow(out.len())?;
        self.text(out)
    }
}
