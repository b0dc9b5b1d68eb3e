//! A formula as the proof runs it.

use super::choice::{Choice, choices};
use super::jet::Jet;
use crate::formula::{Binary, FormulaStep, Inner, Steps, Unary};
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_eval::PointNumber;
use zeroset_number::{Interval, Slope, Vec3, v3};

/// A box: smallest and largest corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
}

impl Cell {
    pub(crate) fn of(bounds: &Aabb) -> Cell {
        Cell {
            min: bounds.min,
            max: bounds.max,
        }
    }

    pub(crate) fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|k| 0.5 * (self.min[k] + self.max[k]))
    }

    pub(crate) fn side(&self, k: usize) -> f64 {
        self.max[k] - self.min[k]
    }

    /// The two halves along axis `k`.
    pub(crate) fn split(&self, k: usize) -> [Cell; 2] {
        let (mut low, mut high) = (*self, *self);
        let middle = self.centre()[k];
        (low.max[k], high.min[k]) = (middle, middle);
        [low, high]
    }
}

/// How many turns an angle jumps by, where it jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Turns {
    /// It does not jump.
    None,
    /// By whole multiples of so many turns.
    Of(f64),
    /// By anything.
    Any,
}

impl Turns {
    /// Whether a function that is the same after `period` turns does not see the jump.
    fn is_hidden(self, period: f64) -> bool {
        match self {
            Turns::None => true,
            Turns::Of(turns) => {
                let periods = turns / period;
                (periods - periods.round()).abs() <= 1e-9 * periods.abs().max(1.0)
                    && periods.abs() < 1e6
            }
            Turns::Any => false,
        }
    }

    fn plus(self, o: Turns) -> Turns {
        match (self, o) {
            (Turns::None, t) | (t, Turns::None) => t,
            (a, b) if a == b => a,
            (a, b) if a.is_hidden(1.0) && b.is_hidden(1.0) => Turns::Of(1.0),
            _ => Turns::Any,
        }
    }

    fn times(self, factor: Option<f64>) -> Turns {
        match (self, factor) {
            (Turns::Of(t), Some(c)) if c != 0.0 => Turns::Of(t * c),
            (Turns::None, _) => Turns::None,
            _ => Turns::Any,
        }
    }
}

/// What a step does with an operand that may have jumped by a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Passing {
    /// Jumps as well.
    On,
    /// Does not see it.
    Hidden,
    /// Jumps in a way that is not followed further.
    Jump,
}

/// Steps with what is known of them wherever they are evaluated.
#[derive(Debug)]
pub(crate) struct ProofTape {
    steps: Vec<FormulaStep>,
    fields: Arc<[Inner]>,
    /// For every step, the choice that it is.
    choices: Vec<Option<Choice>>,
    /// Conditions and halves of choices.
    quiet: Vec<bool>,
    /// Whether there are choices.
    chooses: bool,
    /// For every step, the coordinates that it depends on, as bits.
    reach: Vec<u8>,
    passing: Vec<Passing>,
    /// Sums one side of which is 0 wherever the other is not.
    exclusive: Vec<bool>,
}

/// Whether a step is `length(max(a, 0), max(b, 0), ...) + min(max(a, b, ...), 0)`, as in the distance to a box from its
/// faces: inside all faces the first term is 0, elsewhere the second. Bounds on the two would be added otherwise, in every
/// box that holds a piece of the surface, however small.
fn is_exclusive(steps: &[FormulaStep], step: usize) -> bool {
    let FormulaStep::Binary(Binary::Add, x, y) = steps[step] else {
        return false;
    };
    [(x, y), (y, x)].into_iter().any(|(length, inside)| {
        let Some(greatest) = beside_zero(steps, Binary::Min, inside) else {
            return false;
        };
        let parts = leaves(steps, Binary::Hypot, length);
        let faces = leaves(steps, Binary::Max, greatest);
        (parts.iter()).all(|&part| {
            beside_zero(steps, Binary::Max, part).is_some_and(|face| faces.contains(&face))
        })
    })
}

/// The other operand of `f`, where one is the constant 0.
fn beside_zero(steps: &[FormulaStep], f: Binary, step: u32) -> Option<u32> {
    let zero = |i: u32| steps[i as usize] == FormulaStep::Constant(0.0);
    match steps[step as usize] {
        FormulaStep::Binary(g, x, y) if f == g && zero(y) => Some(x),
        FormulaStep::Binary(g, x, y) if f == g && zero(x) => Some(y),
        _ => None,
    }
}

/// What a nest of one function is made of, as far as it is of any use to look.
fn leaves(steps: &[FormulaStep], f: Binary, step: u32) -> Vec<u32> {
    const ENOUGH: usize = 16;
    // not by recursion: a nest may be as deep as the formula is long
    let (mut waiting, mut found) = (vec![step], Vec::new());
    while let Some(step) = waiting.pop() {
        match steps[step as usize] {
            FormulaStep::Binary(g, x, y) if f == g && found.len() + waiting.len() < ENOUGH => {
                waiting.extend([y, x]);
            }
            _ => found.push(step),
        }
    }
    found
}

impl ProofTape {
    pub(crate) fn new(steps: &Steps) -> ProofTape {
        let fields = steps.shared_fields();
        let steps = steps.list().to_vec();
        let (choices, quiet) = choices(&steps);
        let mut reach: Vec<u8> = Vec::with_capacity(steps.len());
        let mut turns: Vec<Turns> = Vec::with_capacity(steps.len());
        let mut passing = Vec::with_capacity(steps.len());
        let constant = |i: u32| match steps[i as usize] {
            FormulaStep::Constant(c) => Some(c),
            _ => None,
        };
        for step in &steps {
            let operand = |i: u32| turns[i as usize];
            let (bits, after, pass) = match *step {
                FormulaStep::Coordinate(k) => (1 << k, Turns::None, Passing::On),
                FormulaStep::Constant(_) => (0, Turns::None, Passing::On),
                FormulaStep::Noise(_, q) | FormulaStep::Field(_, q) => {
                    let bits = q.into_iter().fold(0, |bits, x| bits | reach[x as usize]);
                    let turned = q.into_iter().any(|x| operand(x) != Turns::None);
                    let pass = if turned { Passing::Jump } else { Passing::On };
                    (bits, Turns::None, pass)
                }
                FormulaStep::Unary(f, x) => {
                    let before = operand(x);
                    let (after, pass) = match f {
                        _ if before == Turns::None => (Turns::None, Passing::On),
                        Unary::Neg => (before, Passing::On),
                        Unary::Sin | Unary::Cos if before.is_hidden(1.0) => {
                            (Turns::None, Passing::Hidden)
                        }
                        Unary::Tan if before.is_hidden(0.5) => (Turns::None, Passing::Hidden),
                        _ => (Turns::None, Passing::Jump),
                    };
                    (reach[x as usize], after, pass)
                }
                FormulaStep::Binary(f, x, y) => {
                    let (a, b) = (operand(x), operand(y));
                    let after = match f {
                        Binary::Atan2 if (a, b) == (Turns::None, Turns::None) => Turns::Of(1.0),
                        Binary::Add | Binary::Sub => a.plus(b),
                        Binary::Mul if b == Turns::None => a.times(constant(y)),
                        Binary::Mul if a == Turns::None => b.times(constant(x)),
                        Binary::Div if b == Turns::None => a.times(constant(y).map(|c| 1.0 / c)),
                        _ if (a, b) == (Turns::None, Turns::None) => Turns::None,
                        _ => Turns::Any,
                    };
                    let (after, pass) = match after {
                        Turns::Any if f == Binary::Atan2 => (Turns::Of(1.0), Passing::Jump),
                        Turns::Any => (Turns::None, Passing::Jump),
                        after => (after, Passing::On),
                    };
                    (reach[x as usize] | reach[y as usize], after, pass)
                }
            };
            reach.push(bits);
            turns.push(after);
            passing.push(pass);
        }
        let exclusive = (0..steps.len())
            .map(|step| is_exclusive(&steps, step))
            .collect();
        ProofTape {
            chooses: choices.iter().any(Option::is_some),
            steps,
            fields,
            choices,
            quiet,
            reach,
            passing,
            exclusive,
        }
    }

    pub(crate) fn steps(&self) -> &[FormulaStep] {
        &self.steps
    }

    /// What an evaluation costs, in steps.
    pub(crate) fn work(&self) -> u64 {
        let of = |step: &FormulaStep| match *step {
            FormulaStep::Field(i, _) => 4 * self.fields[i as usize].instructions() as u64,
            // eight corners or 27 cells, each with its range and gradient
            FormulaStep::Noise(..) => 500,
            _ => 1,
        };
        self.steps.iter().map(of).sum::<u64>().max(1)
    }

    /// Which steps count over a cell, where the jets are those of the steps: not what a choice leaves out.
    pub(crate) fn alive(&self, jets: &[Jet]) -> Option<Vec<bool>> {
        if !self.chooses {
            return None;
        }
        let mut alive = vec![false; self.steps.len()];
        alive[self.steps.len() - 1] = true;
        for i in (0..self.steps.len()).rev() {
            if !alive[i] {
                continue;
            }
            match self.choices[i] {
                Some(choice) => {
                    alive[choice.condition as usize] = true;
                    let range = jets[choice.condition as usize].value();
                    if range.hi > 0.5 {
                        alive[choice.yes as usize] = true;
                    }
                    if range.lo <= 0.5 {
                        alive[choice.no as usize] = true;
                    }
                }
                None => {
                    for x in self.steps[i].operands() {
                        alive[x as usize] = true;
                    }
                }
            }
        }
        Some(alive)
    }

    /// The coordinates that a step depends on.
    pub(crate) fn reaches(&self, step: usize, axis: usize) -> bool {
        self.reach[step] >> axis & 1 == 1
    }

    /// What is known of every step over a cell; the last one is the formula.
    pub(crate) fn jets(&self, cell: &Cell, jets: &mut Vec<Jet>) -> Jet {
        let [x, y, z] = std::array::from_fn(|k| Interval {
            lo: cell.min[k],
            hi: cell.max[k],
        });
        let point = Slope::point(v3(x, y, z)).array();
        jets.clear();
        for step in 0..self.steps.len() {
            let jet = self.jet(step, &point, jets);
            jets.push(jet);
        }
        jets[self.steps.len() - 1]
    }

    /// The value at a point; `values` is for those of the steps.
    pub(crate) fn eval<R: PointNumber>(&self, p: Vec3<R>, values: &mut Vec<R>) -> R {
        values.clear();
        for step in &self.steps {
            values.push(step.eval(p, values, &self.fields));
        }
        values[values.len() - 1]
    }

    fn jet(&self, step: usize, point: &[Slope; 3], known: &[Jet]) -> Jet {
        let operand = |i: u32| &known[i as usize];
        let (mut jet, turned) = match self.steps[step] {
            FormulaStep::Coordinate(k) => return Jet::coordinate(point[usize::from(k)]),
            FormulaStep::Constant(c) => return Jet::constant(c),
            FormulaStep::Unary(f, x) => (Jet::unary(f, operand(x)), operand(x).turned),
            FormulaStep::Noise(kind, q) => {
                let q = q.map(operand);
                (Jet::noise(kind, q), q.iter().any(|jet| jet.turned))
            }
            FormulaStep::Field(i, q) => {
                let q = q.map(operand);
                let jet = Jet::field(&self.fields[i as usize], q);
                (jet, q.iter().any(|jet| jet.turned))
            }
            FormulaStep::Binary(..) if self.choices[step].is_some() => self.chosen(step, known),
            FormulaStep::Binary(_, x, y) if self.exclusive[step] => {
                let (x, y) = (operand(x), operand(y));
                (Jet::either(x, y), x.turned || y.turned)
            }
            FormulaStep::Binary(f, x, y) => {
                let exponent = matches!(self.steps[y as usize], FormulaStep::Constant(_));
                let turned = operand(x).turned || operand(y).turned;
                (Jet::binary(f, operand(x), operand(y), exponent), turned)
            }
        };
        if self.quiet[step] {
            return jet.quiet();
        }
        match self.passing[step] {
            Passing::Hidden => jet.turned = false,
            Passing::Jump if turned => jet.break_off(),
            _ => {}
        }
        // the value of a formula must not jump, whatever the angle
        if step + 1 == self.steps.len() && jet.turned {
            jet.break_off();
        }
        jet
    }

    /// What is known of a choice, and whether it may be of an angle that jumps.
    fn chosen(&self, step: usize, known: &[Jet]) -> (Jet, bool) {
        let Some(choice) = self.choices[step] else {
            return (known[step - 1], false);
        };
        let of = |i: u32| known[i as usize];
        let (yes, no) = (of(choice.yes), of(choice.no));
        let range = of(choice.condition).value();
        let jet = match (range.hi > 0.5, range.lo <= 0.5) {
            (true, false) => yes,
            (false, _) => no,
            (true, true) => {
                let mut jet = Jet::one_of(&yes, &no);
                if !choice.continuous {
                    jet.break_off();
                }
                jet
            }
        };
        (jet, jet.turned)
    }
}
