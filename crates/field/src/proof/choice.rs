//! Choices, `a if c else b`: which steps they are, and whether their two values agree where the condition flips.
//!
//! A function that is made of two pieces is continuous, and its slope is that of the steeper one, if the pieces agree where
//! they meet. A condition is made of comparisons `l < r`; it can only flip where `l = r` for one of them. So for each
//! comparison one side is replaced by the other in both values: what becomes the same term agrees there.

use crate::formula::{Binary, FormulaStep, Unary};
use std::collections::HashMap;
use zeroset_catalogue::op::arithmetic::{self, NOTHING};
use zeroset_number::F64;

/// A choice: the step of its condition, of the value where it holds, of the one where it does not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    pub(super) condition: u32,
    pub(super) yes: u32,
    pub(super) no: u32,
    /// Whether the two values agree where the condition flips.
    pub(super) continuous: bool,
}

/// Constants that differ by less than this part of their size are equal: folding rounds.
const HAIR: f64 = 1e-12;

/// Terms that a comparison of two values may make.
const MOST_TERMS: usize = 20_000;

/// For every step, the choice that it is; and which steps are conditions or halves of choices and used as nothing else.
pub(super) fn choices(steps: &[FormulaStep]) -> (Vec<Option<Choice>>, Vec<bool>) {
    let mut found: Vec<Option<Choice>> = (0..steps.len()).map(|i| choice(steps, i)).collect();
    if found.iter().all(Option::is_none) {
        let is_plain = |s: &FormulaStep| !matches!(s, FormulaStep::Binary(Binary::Less, ..));
        if steps.iter().all(is_plain) {
            return (found, vec![false; steps.len()]);
        }
    }
    let mut quiet: Vec<bool> = Vec::with_capacity(steps.len());
    for (i, step) in steps.iter().enumerate() {
        let of = |i: u32| quiet[i as usize];
        quiet.push(
            match *step {
                FormulaStep::Binary(Binary::Less, ..) => true,
                FormulaStep::Binary(Binary::Min | Binary::Max, x, y) => of(x) && of(y),
                FormulaStep::Binary(Binary::Sub, one, x) => {
                    steps[one as usize] == FormulaStep::Constant(1.0) && of(x)
                }
                FormulaStep::Binary(Binary::When, condition, _) => of(condition),
                _ => false,
            } && i + 1 < steps.len(),
        );
    }
    // what is read as a number anywhere is one; operands come first, so this ends with one way back
    for (i, step) in steps.iter().enumerate().rev() {
        let loud = |x: u32, allowed: bool, quiet: &mut Vec<bool>| {
            if !allowed {
                quiet[x as usize] = false;
            }
        };
        match *step {
            FormulaStep::Binary(Binary::Either, x, y) => {
                let is_choice = found[i].is_some();
                loud(x, is_choice, &mut quiet);
                loud(y, is_choice, &mut quiet);
            }
            FormulaStep::Binary(Binary::When, condition, value) => {
                let half = quiet[i];
                loud(condition, half, &mut quiet);
                loud(value, false, &mut quiet);
            }
            FormulaStep::Binary(Binary::Less, x, y) => {
                loud(x, false, &mut quiet);
                loud(y, false, &mut quiet);
            }
            _ => {
                let combines = quiet[i];
                for x in step.operands() {
                    let half = matches!(steps[x as usize], FormulaStep::Binary(Binary::When, ..));
                    loud(x, combines && !half, &mut quiet);
                }
            }
        }
    }
    for choice in found.iter_mut().flatten() {
        choice.continuous = quiet[choice.condition as usize] && agree(steps, choice);
    }
    (found, quiet)
}

fn choice(steps: &[FormulaStep], step: usize) -> Option<Choice> {
    let FormulaStep::Binary(Binary::Either, x, y) = steps[step] else {
        return None;
    };
    let half = |i: u32| match steps[i as usize] {
        FormulaStep::Binary(Binary::When, condition, value) => Some((condition, value)),
        _ => None,
    };
    let ((condition, yes), (other, no)) = (half(x)?, half(y)?);
    let is_other = |a: u32, b: u32| match steps[a as usize] {
        FormulaStep::Binary(Binary::Sub, one, x) => {
            steps[one as usize] == FormulaStep::Constant(1.0) && x == b
        }
        _ => false,
    };
    (is_other(other, condition) || is_other(condition, other)).then_some(Choice {
        condition,
        yes,
        no,
        continuous: false,
    })
}

/// Whether the two values agree wherever the condition may flip.
fn agree(steps: &[FormulaStep], choice: &Choice) -> bool {
    let (mut waiting, mut seen) = (vec![choice.condition], Vec::new());
    while let Some(i) = waiting.pop() {
        if seen.contains(&i) {
            continue;
        }
        seen.push(i);
        match steps[i as usize] {
            FormulaStep::Binary(Binary::Less, l, r) => {
                let same = |from: u32, to: u32| Terms::new(steps, from, to).are_same(choice);
                if !same(l, r) && !same(r, l) {
                    return false;
                }
            }
            FormulaStep::Binary(Binary::Min | Binary::Max | Binary::Sub, x, y) => {
                waiting.extend([x, y]);
            }
            FormulaStep::Constant(_) => {}
            _ => return false,
        }
        if seen.len() > MOST_TERMS {
            return false;
        }
    }
    true
}

/// A term whose operands are earlier terms; equal terms are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Term {
    Constant(u64),
    Coordinate(u8),
    Unary(Unary, u32),
    Binary(Binary, u32, u32),
    /// What is not looked into: the step, and the terms that it takes.
    Other(u32, [u32; 3]),
}

/// Steps as terms, one side of a comparison replaced by the other.
struct Terms<'s> {
    steps: &'s [FormulaStep],
    from: u32,
    to: u32,
    /// The coordinate that is replaced, where the side to be replaced is one.
    coordinate: Option<u8>,
    terms: Vec<Term>,
    known: HashMap<Term, u32>,
    /// The term of every step that was asked for.
    of: HashMap<u32, u32>,
}

impl<'s> Terms<'s> {
    fn new(steps: &'s [FormulaStep], from: u32, to: u32) -> Terms<'s> {
        Terms {
            steps,
            from,
            to,
            coordinate: match steps[from as usize] {
                FormulaStep::Coordinate(k) => Some(k),
                _ => None,
            },
            terms: Vec::new(),
            known: HashMap::new(),
            of: HashMap::new(),
        }
    }

    fn are_same(mut self, choice: &Choice) -> bool {
        // a side that is made of what it replaces would not end
        if self.reaches(self.to) {
            return false;
        }
        let last = choice.yes.max(choice.no).max(self.to);
        if last as usize > MOST_TERMS {
            return false;
        }
        // operands come before the steps that take them: one way through is enough
        let mut needed = vec![false; last as usize + 1];
        for i in [choice.yes, choice.no, self.to] {
            needed[i as usize] = true;
        }
        for i in (0..needed.len()).rev() {
            if needed[i] && i as u32 != self.from {
                for x in self.steps[i].operands() {
                    needed[x as usize] = true;
                }
            }
        }
        let to = self.to;
        // the other side first: it does not depend on what it replaces
        self.fill(&needed, |terms, i| i <= to && !terms.is_replaced(i));
        let Some(&other) = self.of.get(&to) else {
            return false;
        };
        self.of.clear();
        self.of.insert(self.from, other);
        let from = self.from;
        let replaced = self.coordinate;
        for i in 0..needed.len() as u32 {
            if !needed[i as usize] || i == from {
                continue;
            }
            let is_coordinate =
                replaced.is_some_and(|k| self.steps[i as usize] == FormulaStep::Coordinate(k));
            let term = if is_coordinate { other } else { self.term(i) };
            self.of.insert(i, term);
        }
        match (self.of.get(&choice.yes), self.of.get(&choice.no)) {
            (Some(&a), Some(&b)) => a == b || self.near(a, b),
            _ => false,
        }
    }

    fn is_replaced(&self, i: u32) -> bool {
        i == self.from
    }

    /// Whether a step is made of what is replaced.
    fn reaches(&self, step: u32) -> bool {
        let mut reached = vec![false; step as usize + 1];
        for i in 0..=step {
            let is_coordinate = self
                .coordinate
                .is_some_and(|k| self.steps[i as usize] == FormulaStep::Coordinate(k));
            reached[i as usize] = i == self.from
                || is_coordinate
                || self.steps[i as usize]
                    .operands()
                    .any(|x| reached[x as usize]);
        }
        reached[step as usize]
    }

    fn fill(&mut self, needed: &[bool], wanted: impl Fn(&Self, u32) -> bool) {
        for i in 0..needed.len() as u32 {
            let known = |of: &HashMap<u32, u32>, i: u32| of.contains_key(&i);
            let ready = self.steps[i as usize]
                .operands()
                .all(|x| known(&self.of, x));
            if needed[i as usize] && ready && wanted(self, i) {
                let term = self.term(i);
                self.of.insert(i, term);
            }
        }
    }

    fn near(&self, a: u32, b: u32) -> bool {
        match (self.constant(a), self.constant(b)) {
            (Some(a), Some(b)) => (a - b).abs() <= HAIR * a.abs().max(b.abs()).max(1.0),
            _ => false,
        }
    }

    fn constant(&self, term: u32) -> Option<f64> {
        match self.terms[term as usize] {
            Term::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    fn push(&mut self, term: Term) -> u32 {
        if let Some(&known) = self.known.get(&term) {
            return known;
        }
        self.terms.push(term);
        let place = self.terms.len() as u32 - 1;
        self.known.insert(term, place);
        place
    }

    fn number(&mut self, x: f64) -> u32 {
        // 0 and -0 are one
        self.push(Term::Constant((x + 0.0).to_bits()))
    }

    /// The term of a step whose operands have theirs.
    fn term(&mut self, i: u32) -> u32 {
        let of = |terms: &Self, x: u32| terms.of.get(&x).copied().unwrap_or_default();
        match self.steps[i as usize] {
            FormulaStep::Constant(c) => self.number(c),
            FormulaStep::Coordinate(k) => self.push(Term::Coordinate(k)),
            FormulaStep::Unary(f, x) => {
                let x = of(self, x);
                self.unary(f, x)
            }
            FormulaStep::Binary(f, x, y) => {
                let (x, y) = (of(self, x), of(self, y));
                self.binary(f, x, y)
            }
            FormulaStep::Noise(_, q) | FormulaStep::Field(_, q) => {
                let q = q.map(|x| of(self, x));
                // equal where the kind and the point are: the kind is told by the first step of it
                let first = (0..i)
                    .find(
                        |&j| match (self.steps[j as usize], self.steps[i as usize]) {
                            (FormulaStep::Noise(a, _), FormulaStep::Noise(b, _)) => a == b,
                            (FormulaStep::Field(a, _), FormulaStep::Field(b, _)) => a == b,
                            _ => false,
                        },
                    )
                    .unwrap_or(i);
                self.push(Term::Other(first, q))
            }
        }
    }

    fn unary(&mut self, f: Unary, x: u32) -> u32 {
        if let Some(c) = self.constant(x) {
            return self.number(arithmetic::unary(f, F64(c)).0);
        }
        match (f, self.terms[x as usize]) {
            (Unary::Neg, Term::Unary(Unary::Neg, y)) => y,
            // -(a - b) is b - a
            (Unary::Neg, Term::Binary(Binary::Sub, a, b)) => self.binary(Binary::Sub, b, a),
            (Unary::Abs | Unary::Square | Unary::Cos, Term::Unary(Unary::Neg | Unary::Abs, y)) => {
                self.unary(f, y)
            }
            _ => self.push(Term::Unary(f, x)),
        }
    }

    fn binary(&mut self, f: Binary, x: u32, y: u32) -> u32 {
        let (a, b) = (self.constant(x), self.constant(y));
        if let (Some(a), Some(b)) = (a, b)
            && !matches!(f, Binary::When | Binary::Either)
        {
            return self.number(arithmetic::binary(f, F64(a), F64(b)).0);
        }
        match (f, a, b) {
            (Binary::Add, Some(0.0), _) => return y,
            (Binary::Add | Binary::Sub, _, Some(0.0)) => return x,
            (Binary::Sub, Some(0.0), _) => return self.unary(Unary::Neg, y),
            (Binary::Mul, Some(1.0), _) => return y,
            (Binary::Mul | Binary::Div, _, Some(1.0)) => return x,
            (Binary::Mul, Some(0.0), _)
            | (Binary::Mul, _, Some(0.0))
            | (Binary::Div, Some(0.0), _) => {
                return self.number(0.0);
            }
            (Binary::Hypot, Some(0.0), _) => return self.unary(Unary::Abs, y),
            (Binary::Hypot, _, Some(0.0)) => return self.unary(Unary::Abs, x),
            (Binary::Either, ..) if x == y => return x,
            // a choice whose condition is known; where it flips as well, its own values agree or it jumps by itself
            (Binary::When, Some(c), _) if c > 0.5 => return y,
            (Binary::When, Some(_), _) => return self.number(f64::from(NOTHING)),
            (Binary::Either, Some(x), _) if x >= f64::from(NOTHING) => return y,
            (Binary::Either, _, Some(y)) if y >= f64::from(NOTHING) => return x,
            _ => {}
        }
        if x == y {
            match f {
                Binary::Min | Binary::Max => return x,
                Binary::Sub => return self.number(0.0),
                Binary::Div => return self.number(1.0),
                _ => {}
            }
        }
        // a length does not see signs
        let unsigned = |terms: &Self, x: u32| match terms.terms[x as usize] {
            Term::Unary(Unary::Neg | Unary::Abs, y) if f == Binary::Hypot => y,
            _ => x,
        };
        let (x, y) = (unsigned(self, x), unsigned(self, y));
        let symmetric = matches!(
            f,
            Binary::Add | Binary::Mul | Binary::Min | Binary::Max | Binary::Hypot
        );
        let (x, y) = if symmetric && x > y { (y, x) } else { (x, y) };
        self.push(Term::Binary(f, x, y))
    }
}
