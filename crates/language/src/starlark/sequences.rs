//! Lists, tuples, ranges, dicts and texts as sequences.

use super::machine::Machine;
use super::mistake::{Mistake, Run, mistake};
use super::value::{Range, Value};
use crate::starlark::native::spoken;

impl<'a> Machine<'a> {
    /// Hands every item to `work` until it says false.
    pub(crate) fn each(
        &mut self,
        iterable: Value,
        mut work: impl FnMut(&mut Self, Value) -> Run<bool>,
    ) -> Run<()> {
        match iterable {
            Value::List(i) => {
                self.store.list_mut(i).loops += 1;
                let mut k = 0;
                while let Some(item) = self.store.list(i).items.get(k).copied() {
                    self.charge(1)?;
                    if !work(self, item)? {
                        break;
                    }
                    k += 1;
                }
                self.store.list_mut(i).loops -= 1;
            }
            Value::Tuple(i) => {
                for k in 0..self.store.tuple(i).len() {
                    self.charge(1)?;
                    if !work(self, self.store.tuple(i)[k])? {
                        break;
                    }
                }
            }
            Value::Range(i) => {
                let range = *self.store.range(i);
                for k in 0..range.length {
                    self.charge(1)?;
                    if !work(self, Value::Int(range.at(k)))? {
                        break;
                    }
                }
            }
            Value::Dict(i) => {
                self.store.dict_mut(i).loops += 1;
                let mut k = 0;
                while let Some((_, (key, _))) = self.store.dict(i).pairs.get_index(k) {
                    let key = *key;
                    self.charge(1)?;
                    if !work(self, key)? {
                        break;
                    }
                    k += 1;
                }
                self.store.dict_mut(i).loops -= 1;
            }
            other => match self.parts_of_vector(other)? {
                Some(parts) => return self.each(parts, work),
                None => return Err(self.not_a_sequence(other)),
            },
        }
        Ok(())
    }

    fn not_a_sequence(&self, value: Value) -> Box<Mistake> {
        let m = mistake(format!(
            "{} is not a list and cannot be gone through",
            self.store.kind(value)
        ));
        match value {
            Value::Text(_) => m.help("text.elems() gives its characters"),
            Value::Int(_) => m.help("range(n) gives the numbers from 0 to n - 1"),
            _ => m,
        }
    }

    /// Number of items.
    pub(crate) fn length(&self, value: Value) -> Run<u64> {
        match value {
            Value::Text(i) => Ok(self.store.text(i).chars().count() as u64),
            Value::List(i) => Ok(self.store.list(i).items.len() as u64),
            Value::Tuple(i) => Ok(self.store.tuple(i).len() as u64),
            Value::Dict(i) => Ok(self.store.dict(i).pairs.len() as u64),
            Value::Range(i) => Ok(self.store.range(i).length),
            other => self
                .vector_length(other)
                .ok_or_else(|| mistake(format!("{} has no length", self.store.kind(other)))),
        }
    }

    /// All items, charged.
    pub(crate) fn collect(&mut self, iterable: Value) -> Run<Vec<Value>> {
        let length = match iterable {
            Value::Text(_) => return Err(self.not_a_sequence(iterable)),
            _ => self
                .length(iterable)
                .map_err(|_| self.not_a_sequence(iterable))?,
        };
        self.grow_items(usize::try_from(length).unwrap_or(usize::MAX))?;
        let mut out = Vec::with_capacity(length as usize);
        self.each(iterable, |_, item| {
            out.push(item);
            Ok(true)
        })?;
        Ok(out)
    }

    /// Adds items to a list.
    pub(crate) fn extend(&mut self, list: u32, items: Value) -> Run<()> {
        let items = self.collect(items)?;
        self.change(list)?.extend(items);
        Ok(())
    }

    /// The items of a list that may change.
    pub(crate) fn change(&mut self, list: u32) -> Run<&mut Vec<Value>> {
        self.check_branch()?;
        if self.store.list(list).loops > 0 {
            return Err(mistake("a list cannot change while a loop runs over it")
                .help("loop over list(l) instead"));
        }
        Ok(&mut self.store.list_mut(list).items)
    }

    /// A place in a sequence of this length; negative ones count from the end.
    pub(crate) fn place_in(&self, index: Value, length: u64) -> Run<u64> {
        let i = match index {
            Value::Int(i) => i,
            Value::Float(x) => {
                let m = mistake(format!(
                    "an index must be a whole number, not {}",
                    spoken(x)
                ));
                return Err(m.help("int(x) cuts off the fraction, and // divides whole numbers"));
            }
            other => {
                return Err(mistake(format!(
                    "an index must be a whole number, not {}",
                    self.store.kind(other)
                )));
            }
        };
        let at = if i < 0 {
            i128::from(i) + i128::from(length)
        } else {
            i128::from(i)
        };
        if (0..i128::from(length)).contains(&at) {
            Ok(at as u64)
        } else {
            Err(mistake(format!("there is no item {i} among {length}")))
        }
    }

    pub(crate) fn index(&mut self, object: Value, index: Value) -> Run<Value> {
        match object {
            Value::Dict(i) => {
                let key = self.key(index, 0)?;
                match self.store.dict(i).pairs.get(&key) {
                    Some((_, value)) => Ok(*value),
                    None => {
                        let shown = self.shown(index)?;
                        Err(mistake(format!("the dict has no key {shown}"))
                            .help("d.get(key, default) gives a default"))
                    }
                }
            }
            Value::Text(i) => {
                self.charge(self.store.text(i).len() as u64 / 16)?;
                let at = self.place_in(index, self.length(object)?)?;
                let character = self
                    .store
                    .text(i)
                    .chars()
                    .nth(at as usize)
                    .unwrap_or_default();
                self.text(character.to_string())
            }
            Value::Range(i) => {
                let at = self.place_in(index, self.length(object)?)?;
                Ok(Value::Int(self.store.range(i).at(at)))
            }
            Value::List(_) | Value::Tuple(_) => {
                let at = self.place_in(index, self.length(object)?)?;
                Ok(self.store.items(object).unwrap_or_default()[at as usize])
            }
            other => match self.parts_of_vector(other)? {
                Some(parts) => self.index(parts, index),
                None => Err(mistake(format!("{} has no items", self.store.kind(other)))),
            },
        }
    }

    /// Refuses to change what outlives a branch that the point of a formula decides: both branches run.
    fn check_branch(&self) -> Run<()> {
        if self.branches == 0 {
            return Ok(());
        }
        Err(mistake(
            "lists and dicts cannot change where the point decides: both branches are written down",
        )
        .help("choose the value instead: d = a if condition else b"))
    }

    pub(crate) fn set_index(&mut self, object: Value, index: Value, value: Value) -> Run<()> {
        self.check_branch()?;
        match object {
            Value::Dict(i) => self.insert(i, index, value),
            Value::List(i) => {
                let at = self.place_in(index, self.length(object)?)?;
                self.change(i)?[at as usize] = value;
                Ok(())
            }
            other => Err(mistake(format!(
                "items of {} cannot be changed",
                self.store.kind(other)
            ))),
        }
    }

    /// `object[start:stop:step]`.
    pub(crate) fn slice(&mut self, object: Value, bounds: [Option<Value>; 3]) -> Run<Value> {
        let length = match object {
            Value::Text(_) | Value::List(_) | Value::Tuple(_) | Value::Range(_) => {
                self.length(object)?
            }
            other => match self.parts_of_vector(other)? {
                Some(parts) => return self.slice(parts, bounds),
                None => {
                    return Err(mistake(format!("{} has no items", self.store.kind(other))));
                }
            },
        };
        let length = i64::try_from(length).map_err(|_| mistake("this sequence is too long"))?;
        let [start, stop, step] = bounds.map(|b| b.filter(|v| !matches!(v, Value::None)));
        let number = |v: Value| match v {
            Value::Int(i) => Ok(i),
            other => Err(mistake(format!(
                "a slice needs whole numbers, not {}",
                self.store.kind(other)
            ))),
        };
        let step = step.map_or(Ok(1), number)?;
        if step == 0 {
            return Err(mistake("the step of a slice cannot be 0"));
        }
        let (low, high) = if step > 0 {
            (0, length)
        } else {
            (-1, length - 1)
        };
        let clamp = |v: Option<Value>, default: i64| -> Run<i64> {
            let Some(v) = v else { return Ok(default) };
            let i = number(v)?;
            Ok(if i < 0 { i.saturating_add(length) } else { i }.clamp(low, high))
        };
        let (first, last) = if step > 0 {
            (0, length)
        } else {
            (length - 1, -1)
        };
        let (start, stop) = (clamp(start, first)?, clamp(stop, last)?);
        let range = range_of(start, stop, step);
        let count = range.length as usize;
        if let Value::Range(i) = object {
            let whole = *self.store.range(i);
            let step = whole.step.saturating_mul(step);
            return self.range(Range {
                start: if count == 0 {
                    0
                } else {
                    whole.at(start as u64)
                },
                step,
                ..range
            });
        }
        self.grow_items(count)?;
        let places = (0..range.length).map(|k| range.at(k) as usize);
        match object {
            Value::Text(i) => {
                self.grow(4 * length as usize)?;
                let all: Vec<char> = self.store.text(i).chars().collect();
                let text: String = places.filter_map(|k| all.get(k)).collect();
                self.text(text)
            }
            _ => {
                let all = self.store.items(object).unwrap_or_default();
                let items = places.filter_map(|k| all.get(k).copied()).collect();
                if matches!(object, Value::List(_)) {
                    self.list(items)
                } else {
                    self.tuple(items)
                }
            }
        }
    }
}

/// The numbers from `start` to before `stop` by `step`, which is not 0.
pub(crate) fn range_of(start: i64, stop: i64, step: i64) -> Range {
    let (distance, stride) = if step > 0 {
        (i128::from(stop) - i128::from(start), i128::from(step))
    } else {
        (i128::from(start) - i128::from(stop), -i128::from(step))
    };
    let length = if distance > 0 {
        ((distance + stride - 1) / stride) as u64
    } else {
        0
    };
    Range {
        start,
        step,
        length,
    }
}
