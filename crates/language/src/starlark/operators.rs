//! Operators between values.

use super::fields;
use super::machine::Machine;
use super::mistake::{Mistake, Run, mistake};
use super::value::{Thing, Value};
use starlark_syntax::syntax::ast::{AssignOp, BinOp};
use std::cmp::Ordering;

/// How deep values are compared into each other.
const MAX_DEPTH: u32 = 32;

/// The operator of `target op= value`.
pub(crate) fn binary(op: AssignOp) -> BinOp {
    match op {
        AssignOp::Add => BinOp::Add,
        AssignOp::Subtract => BinOp::Subtract,
        AssignOp::Multiply => BinOp::Multiply,
        AssignOp::Divide => BinOp::Divide,
        AssignOp::FloorDivide => BinOp::FloorDivide,
        AssignOp::Percent => BinOp::Percent,
        AssignOp::BitAnd => BinOp::BitAnd,
        AssignOp::BitOr => BinOp::BitOr,
        AssignOp::BitXor => BinOp::BitXor,
        AssignOp::LeftShift => BinOp::LeftShift,
        AssignOp::RightShift => BinOp::RightShift,
    }
}

fn overflow() -> Box<Mistake> {
    mistake("this whole number becomes too large")
        .help("use numbers with a point: 1.0 instead of 1")
}

fn by_zero() -> Box<Mistake> {
    mistake("division by zero")
}

impl<'a> Machine<'a> {
    pub(crate) fn operate(&mut self, op: BinOp, left: Value, right: Value) -> Run<Value> {
        let may_be_formula = |value| matches!(value, Value::Thing(_) | Value::Tuple(_));
        if (may_be_formula(left) || may_be_formula(right))
            && let Some(value) = self.operate_formula(op, left, right)?
        {
            return Ok(value);
        }
        match op {
            BinOp::Equal => return Ok(Value::Bool(self.equal(left, right, 0)?)),
            BinOp::NotEqual => return Ok(Value::Bool(!self.equal(left, right, 0)?)),
            BinOp::Less => return Ok(Value::Bool(self.order(left, right, 0)? == Ordering::Less)),
            BinOp::LessOrEqual => {
                return Ok(Value::Bool(
                    self.order(left, right, 0)? != Ordering::Greater,
                ));
            }
            BinOp::Greater => {
                return Ok(Value::Bool(
                    self.order(left, right, 0)? == Ordering::Greater,
                ));
            }
            BinOp::GreaterOrEqual => {
                return Ok(Value::Bool(self.order(left, right, 0)? != Ordering::Less));
            }
            BinOp::In => return Ok(Value::Bool(self.contains(right, left)?)),
            BinOp::NotIn => return Ok(Value::Bool(!self.contains(right, left)?)),
            _ => {}
        }
        match (left, right) {
            (Value::Int(a), Value::Int(b)) => {
                whole(op, a, b).unwrap_or_else(|| Err(self.unsupported(op, left, right)))
            }
            (Value::Int(_) | Value::Float(_), Value::Int(_) | Value::Float(_)) => {
                let (a, b) = (self.as_float(left), self.as_float(right));
                real(op, a, b).unwrap_or_else(|| Err(self.unsupported(op, left, right)))
            }
            (Value::Thing(a), Value::Thing(b)) => {
                match (self.store.thing(a), self.store.thing(b)) {
                    (Thing::Field(a), Thing::Field(b)) => {
                        let (a, b) = (a.clone(), b.clone());
                        fields::operate(self, op, a, b)?
                            .ok_or_else(|| self.unsupported(op, left, right))
                    }
                    _ => Err(self.unsupported(op, left, right)),
                }
            }
            (Value::Text(a), Value::Text(b)) if op == BinOp::Add => {
                let (a, b) = (self.store.text(a).clone(), self.store.text(b).clone());
                self.grow(a.len() + b.len())?;
                self.text(format!("{a}{b}"))
            }
            (Value::Text(format), _) if op == BinOp::Percent => {
                let format = self.store.text(format).clone();
                self.percent(&format, right)
            }
            (Value::List(a), Value::List(b)) if op == BinOp::Add => {
                self.grow_items(self.store.list(a).items.len() + self.store.list(b).items.len())?;
                let items = [
                    self.store.list(a).items.as_slice(),
                    &self.store.list(b).items,
                ]
                .concat();
                self.list(items)
            }
            (Value::Tuple(a), Value::Tuple(b)) if op == BinOp::Add => {
                self.grow_items(self.store.tuple(a).len() + self.store.tuple(b).len())?;
                let items = [self.store.tuple(a), self.store.tuple(b)].concat();
                self.tuple(items)
            }
            (Value::Dict(a), Value::Dict(b)) if op == BinOp::BitOr => {
                let all: Vec<_> = [a, b]
                    .iter()
                    .flat_map(|d| self.store.dict(*d).pairs.values().copied())
                    .collect();
                let dict = self.dict()?;
                all.into_iter()
                    .try_for_each(|(k, v)| self.insert(dict, k, v))?;
                Ok(Value::Dict(dict))
            }
            (Value::Int(n), sequence) | (sequence, Value::Int(n)) if op == BinOp::Multiply => self
                .times(sequence, n)?
                .ok_or_else(|| self.unsupported(op, left, right)),
            _ => Err(self.unsupported(op, left, right)),
        }
    }

    /// A text, list or tuple repeated.
    fn times(&mut self, sequence: Value, n: i64) -> Run<Option<Value>> {
        let n = usize::try_from(n.max(0)).map_err(|_| overflow())?;
        Ok(Some(match sequence {
            Value::Text(i) => {
                let text = self.store.text(i).clone();
                self.grow(text.len().saturating_mul(n))?;
                self.text(text.repeat(n))?
            }
            Value::List(i) => {
                self.grow_items(self.store.list(i).items.len().saturating_mul(n))?;
                let items = self.store.list(i).items.repeat(n);
                self.list(items)?
            }
            Value::Tuple(i) => {
                self.grow_items(self.store.tuple(i).len().saturating_mul(n))?;
                let items = self.store.tuple(i).repeat(n);
                self.tuple(items)?
            }
            _ => return Ok(None),
        }))
    }

    fn unsupported(&self, op: BinOp, left: Value, right: Value) -> Box<Mistake> {
        let (l, r) = (self.store.kind(left), self.store.kind(right));
        let op = op.to_string();
        let m = mistake(format!("`{}` does not work between {l} and {r}", op.trim()));
        let field =
            |v| matches!(v, Value::Thing(i) if matches!(self.store.thing(i), Thing::Field(_)));
        let symbol =
            |v| matches!(v, Value::Thing(i) if matches!(self.store.thing(i), Thing::Expression(_)));
        match op.trim() {
            "+" if field(left) && field(right) => {
                m.help("a | b joins two fields, a - b takes the second one away")
            }
            "*" if field(left) || field(right) => {
                m.help("a.scale(2) makes a field larger, a & b keeps what lies in both")
            }
            "|" | "&" | "^" if symbol(left) || symbol(right) => {
                m.help("min(a, b) joins two formulas, max(a, b) keeps what lies in both")
            }
            "+" if matches!(left, Value::Text(_)) => m.help("str(...) makes a text of a number"),
            _ => m,
        }
    }

    /// A number as a float; 0 for what is none.
    fn as_float(&self, value: Value) -> f64 {
        match value {
            Value::Int(i) => i as f64,
            Value::Float(x) => x,
            _ => 0.0,
        }
    }

    pub(crate) fn negate(&mut self, value: Value) -> Run<Value> {
        match value {
            Value::Int(i) => i.checked_neg().map(Value::Int).ok_or_else(overflow),
            Value::Float(x) => Ok(Value::Float(-x)),
            Value::Thing(_) => match self.negate_formula(value) {
                Some(negated) => negated,
                None => self.complement(value),
            },
            other => Err(mistake(format!(
                "`-` needs a number or a field, not {}",
                self.store.kind(other)
            ))),
        }
    }

    /// `~value`: all of space that is not in a field, or the bits of a whole number flipped.
    pub(crate) fn complement(&mut self, value: Value) -> Run<Value> {
        match value {
            Value::Int(i) => Ok(Value::Int(!i)),
            Value::Thing(i) => match self.store.thing(i) {
                Thing::Field(field) => {
                    let field = field.clone();
                    fields::complement(self, field)
                }
                other => Err(mistake(format!("`~` needs a field, not {}", other.kind()))),
            },
            other => Err(mistake(format!(
                "`~` needs a field, not {}",
                self.store.kind(other)
            ))),
        }
    }

    pub(crate) fn equal(&mut self, a: Value, b: Value, depth: u32) -> Run<bool> {
        self.charge(1)?;
        self.check_depth(depth)?;
        self.check_decided(a, b)?;
        Ok(match (a, b) {
            (Value::None, Value::None) => true,
            (Value::Bool(a), Value::Bool(b)) => a == b,
            (Value::Int(a), Value::Int(b)) => a == b,
            (Value::Int(_) | Value::Float(_), Value::Int(_) | Value::Float(_)) => {
                compare_numbers(a, b) == Some(Ordering::Equal)
            }
            (Value::Text(a), Value::Text(b)) => {
                self.charge(self.store.text(a).len() as u64 / 16)?;
                self.store.text(a) == self.store.text(b)
            }
            (Value::List(x), Value::List(y)) if x == y => true,
            (Value::Tuple(x), Value::Tuple(y)) if x == y => true,
            (Value::List(_), Value::List(_)) | (Value::Tuple(_), Value::Tuple(_)) => {
                let length = self.items_of(a).len();
                if length != self.items_of(b).len() {
                    return Ok(false);
                }
                for i in 0..length {
                    let (x, y) = (self.items_of(a)[i], self.items_of(b)[i]);
                    if !self.equal(x, y, depth + 1)? {
                        return Ok(false);
                    }
                }
                true
            }
            (Value::Dict(x), Value::Dict(y)) => {
                if self.store.dict(x).pairs.len() != self.store.dict(y).pairs.len() {
                    return Ok(false);
                }
                for i in 0..self.store.dict(x).pairs.len() {
                    let (key, (_, value)) = self
                        .store
                        .dict(x)
                        .pairs
                        .get_index(i)
                        .expect("below the length");
                    let (value, other) = (*value, self.store.dict(y).pairs.get(key).map(|p| p.1));
                    match other {
                        Some(other) if self.equal(value, other, depth + 1)? => {}
                        _ => return Ok(false),
                    }
                }
                true
            }
            (Value::Range(a), Value::Range(b)) => self.store.range(a) == self.store.range(b),
            (Value::Function(a), Value::Function(b)) | (Value::Thing(a), Value::Thing(b)) => a == b,
            _ => false,
        })
    }

    /// Order of numbers, texts, and lists or tuples of these.
    pub(crate) fn order(&mut self, a: Value, b: Value, depth: u32) -> Run<Ordering> {
        self.charge(1)?;
        self.check_depth(depth)?;
        self.check_decided(a, b)?;
        match (a, b) {
            (Value::Int(_) | Value::Float(_), Value::Int(_) | Value::Float(_)) => {
                compare_numbers(a, b)
                    .ok_or_else(|| mistake("a value that is no number (NaN) cannot be compared"))
            }
            (Value::Bool(a), Value::Bool(b)) => Ok(a.cmp(&b)),
            (Value::Text(a), Value::Text(b)) => {
                self.charge(self.store.text(a).len() as u64 / 16)?;
                Ok(self.store.text(a).cmp(self.store.text(b)))
            }
            (Value::List(_), Value::List(_)) | (Value::Tuple(_), Value::Tuple(_)) => {
                let (n, m) = (self.items_of(a).len(), self.items_of(b).len());
                for i in 0..n.min(m) {
                    let (x, y) = (self.items_of(a)[i], self.items_of(b)[i]);
                    match self.order(x, y, depth + 1)? {
                        Ordering::Equal => {}
                        other => return Ok(other),
                    }
                }
                Ok(n.cmp(&m))
            }
            _ => {
                let (l, r) = (self.store.kind(a), self.store.kind(b));
                Err(mistake(format!("{l} and {r} cannot be compared")))
            }
        }
    }

    /// Refuses to compare a value of a formula with a number or another one: which is larger depends on the point.
    fn check_decided(&self, a: Value, b: Value) -> Run<()> {
        let symbol =
            |v| matches!(v, Value::Thing(i) if matches!(self.store.thing(i), Thing::Expression(_)));
        let number = |v| matches!(v, Value::Int(_) | Value::Float(_) | Value::Bool(_)) || symbol(v);
        if (symbol(a) && number(b)) || (symbol(b) && number(a)) {
            return Err(super::formulas::incomparable());
        }
        Ok(())
    }

    fn check_depth(&self, depth: u32) -> Run<()> {
        if depth > MAX_DEPTH {
            Err(mistake("these values are nested too deeply to be compared"))
        } else {
            Ok(())
        }
    }

    fn items_of(&self, value: Value) -> &[Value] {
        self.store.items(value).unwrap_or_default()
    }

    /// Whether `item` is in `container`.
    fn contains(&mut self, container: Value, item: Value) -> Run<bool> {
        match (container, item) {
            (Value::Text(t), Value::Text(part)) => {
                let both = self.store.text(t).len() + self.store.text(part).len();
                self.charge(both as u64 / 16)?;
                Ok(self.store.text(t).contains(&**self.store.text(part)))
            }
            (Value::Dict(d), _) => {
                let key = self.key(item, 0)?;
                Ok(self.store.dict(d).pairs.contains_key(&key))
            }
            (Value::List(_) | Value::Tuple(_) | Value::Range(_), _) => {
                let mut found = false;
                self.each(container, |m, x| {
                    found = m.equal(x, item, 0)?;
                    Ok(!found)
                })?;
                Ok(found)
            }
            (container, item) => {
                let (item, container) = (self.store.kind(item), self.store.kind(container));
                Err(mistake(format!(
                    "{container} cannot be searched for {item}"
                )))
            }
        }
    }
}

/// Order of two numbers, whole ones and floats compared by their exact values; `None` for NaN.
fn compare_numbers(a: Value, b: Value) -> Option<Ordering> {
    match (a, b) {
        (Value::Int(a), Value::Int(b)) => Some(a.cmp(&b)),
        (Value::Float(a), Value::Float(b)) => a.partial_cmp(&b),
        (Value::Int(a), Value::Float(b)) => int_with_float(a, b),
        (Value::Float(a), Value::Int(b)) => int_with_float(b, a).map(Ordering::reverse),
        _ => None,
    }
}

fn int_with_float(a: i64, b: f64) -> Option<Ordering> {
    if b.is_nan() {
        return None;
    }
    // beyond these every float is farther than any whole number of 64 bits
    if b >= 9.3e18 {
        return Some(Ordering::Less);
    }
    if b <= -9.3e18 {
        return Some(Ordering::Greater);
    }
    let whole = b.trunc();
    Some(
        i128::from(a)
            .cmp(&(whole as i128))
            .then_with(|| 0.0_f64.partial_cmp(&(b - whole)).unwrap_or(Ordering::Equal)),
    )
}

/// An operator between whole numbers; `None` where there is none.
fn whole(op: BinOp, a: i64, b: i64) -> Option<Run<Value>> {
    let checked = |x: Option<i64>| Some(x.map(Value::Int).ok_or_else(overflow));
    match op {
        BinOp::Add => checked(a.checked_add(b)),
        BinOp::Subtract => checked(a.checked_sub(b)),
        BinOp::Multiply => checked(a.checked_mul(b)),
        BinOp::Divide if b == 0 => Some(Err(by_zero())),
        BinOp::Divide => Some(Ok(Value::Float(a as f64 / b as f64))),
        BinOp::FloorDivide | BinOp::Percent if b == 0 => Some(Err(by_zero())),
        // rounded down: the remainder has the sign of the divisor
        BinOp::FloorDivide => checked(a.checked_div(b).map(|q| {
            if (a % b != 0) && ((a < 0) != (b < 0)) {
                q - 1
            } else {
                q
            }
        })),
        BinOp::Percent => {
            let r = a.checked_rem(b).unwrap_or(0);
            Some(Ok(Value::Int(if r != 0 && ((r < 0) != (b < 0)) {
                r + b
            } else {
                r
            })))
        }
        BinOp::BitAnd => Some(Ok(Value::Int(a & b))),
        BinOp::BitOr => Some(Ok(Value::Int(a | b))),
        BinOp::BitXor => Some(Ok(Value::Int(a ^ b))),
        BinOp::LeftShift | BinOp::RightShift if !(0..64).contains(&b) => Some(Err(mistake(
            format!("cannot shift by {b} bits, allowed are 0 to 63"),
        ))),
        BinOp::LeftShift => checked(
            (a as i128)
                .checked_shl(b as u32)
                .and_then(|x| i64::try_from(x).ok()),
        ),
        BinOp::RightShift => Some(Ok(Value::Int(a >> b))),
        _ => None,
    }
}

/// An operator between floats; `None` where there is none.
fn real(op: BinOp, a: f64, b: f64) -> Option<Run<Value>> {
    let value = match op {
        BinOp::Add => a + b,
        BinOp::Subtract => a - b,
        BinOp::Multiply => a * b,
        BinOp::Divide | BinOp::FloorDivide | BinOp::Percent if b == 0.0 => {
            return Some(Err(by_zero()));
        }
        BinOp::Divide => a / b,
        BinOp::FloorDivide => (a / b).floor(),
        BinOp::Percent => {
            let r = a % b;
            if r != 0.0 && ((r < 0.0) != (b < 0.0)) {
                r + b
            } else {
                r
            }
        }
        _ => return None,
    };
    Some(Ok(Value::Float(value)))
}
