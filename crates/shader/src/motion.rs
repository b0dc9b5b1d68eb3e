//! Numbers of a scene as formulas of time and of sliders, so that an exported shader moves.
//!
//! A scene is made by a script: what its numbers are at another time is only known from making it again. Their structure is equal at all
//! times where nothing appears or ends, and each number is mostly a smooth function: linear, or a sum of a few waves of time, a short
//! polynomial of a slider. So each input is tried alone, at the nodes of an interpolation that converges fast for smooth functions
//! (trigonometric for waves, Chebyshev's for sliders), and what is found must hold at places that it was not found at, alone and
//! together with the other inputs. An input that one number does not follow is left out whole: a shader with half of it would show
//! another thing.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// What changes the numbers of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// What it is called.
    pub name: String,
    /// What it is in the scene that is exported.
    pub value: f64,
    /// Smallest and largest value of a slider; none for time, which has no end.
    pub range: Option<[f64; 2]>,
}

/// An input that a shader does not have, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Held {
    /// What it is called.
    pub name: String,
    /// Why, as a sentence that goes on after its name.
    pub why: String,
}

/// Numbers that are alike in structure: the same number at the same place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Numbers {
    /// What must be equal for two scenes to have the same shader.
    pub(crate) structure: u64,
    pub(crate) values: Vec<f64>,
    /// By place: numbers that only bound others may be larger (1) or smaller (-1) than they need to be.
    pub(crate) loose: Vec<i8>,
}

/// The most inputs that are carried.
pub(crate) const MOST: usize = 12;
/// Nodes of Chebyshev's interpolation.
const NODES: usize = 17;
/// Samples of a wave's period.
const SAMPLES: usize = 64;
/// The most terms of a formula.
const TERMS: usize = 24;
/// Different periods in one scene.
const PERIODS: usize = 6;
/// How far numbers may be from their formulas, as a share of the largest that they are: single precision has 6e-8.
const NEAR: f64 = 4e-6;
/// Samples lie beside the round times at which parts of a scene line up by chance, and are then made as one: a share of a step, and seconds.
const BESIDE: f64 = 0.3137;
const LATER: f64 = 0.013_07;
/// Places where inputs are tried together.
const TOGETHER: usize = 12;

/// A function of one input, less its value in the exported scene.
#[derive(Clone, Debug, PartialEq)]
enum Curve {
    /// By a factor.
    Line(f64),
    /// Of Chebyshev's polynomials from the first on, over the range.
    Polynomial(Vec<f64>, f64),
    /// Number of the period; cosines and sines of its multiples from the first on, and a constant.
    Waves(usize, Vec<[f64; 2]>, f64),
}

/// What inputs add to a number, by the inputs' numbers.
type Curves = Vec<(usize, Curve)>;

/// Numbers that change, as formulas.
#[derive(Debug, Default)]
pub(crate) struct Motion {
    /// The numbers of the inputs that are carried.
    pub(crate) inputs: Vec<usize>,
    pub(crate) held: Vec<Held>,
    periods: Vec<f64>,
    /// By place: what the number is, and what each input adds.
    formulas: Vec<(usize, f64, Curves)>,
    /// Bounds that hold for all that was tried, by place.
    pub(crate) bounds: Vec<(usize, f64)>,
}

/// Makes numbers of values of the inputs.
pub(crate) type Make<'a> = dyn FnMut(&[f64]) -> Option<Numbers> + 'a;

/// Numbers that were made.
struct Tried<'a> {
    inputs: &'a [Input],
    make: &'a mut Make<'a>,
    base: Numbers,
    known: HashMap<Vec<u64>, Option<Numbers>>,
    least: Vec<f64>,
    most: Vec<f64>,
}

/// Why an input is not carried.
enum Why {
    Fails(f64),
    Structure(f64),
    Number,
}

impl Tried<'_> {
    fn at(&mut self, values: &[f64]) -> Option<Numbers> {
        let key: Vec<u64> = values.iter().map(|x| x.to_bits()).collect();
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let made = (self.make)(values);
        self.known.insert(key, made.clone());
        made
    }

    /// With one input elsewhere.
    fn alone(&mut self, input: usize, x: f64) -> Result<Vec<f64>, Why> {
        let mut values: Vec<f64> = self.inputs.iter().map(|i| i.value).collect();
        values[input] = x;
        let numbers = self.at(&values).ok_or(Why::Fails(x))?;
        self.same(numbers).ok_or(Why::Structure(x))
    }

    /// The values of numbers of the same structure.
    fn same(&mut self, numbers: Numbers) -> Option<Vec<f64>> {
        if numbers.structure != self.base.structure
            || numbers.values.len() != self.base.values.len()
        {
            return None;
        }
        for (i, x) in numbers.values.iter().enumerate() {
            self.least[i] = self.least[i].min(*x);
            self.most[i] = self.most[i].max(*x);
        }
        Some(numbers.values)
    }
}

/// The inputs at a moment that has the structure of most, where the one at hand has not: at its beginning much stands straight.
pub(crate) fn usual(inputs: &[Input], make: &mut Make<'_>) -> Option<Vec<Input>> {
    let time = inputs.iter().position(|i| i.range.is_none())?;
    let mut structure = |later: f64| {
        let mut values: Vec<f64> = inputs.iter().map(|i| i.value).collect();
        values[time] += later;
        Some(make(&values)?.structure)
    };
    let [now, soon, later] = [structure(0.0)?, structure(LATER)?, structure(0.7319)?];
    let mut out = inputs.to_vec();
    out[time].value += LATER;
    (now != soon && soon == later).then_some(out)
}

/// Finds the formulas. `make` gives the numbers of the scene for values of the inputs, in their order; none where it fails.
pub(crate) fn found<'a>(inputs: &'a [Input], base: Numbers, make: &'a mut Make<'a>) -> Motion {
    let mut tried = Tried {
        inputs,
        make,
        least: base.values.clone(),
        most: base.values.clone(),
        base,
        known: HashMap::new(),
    };
    let mut motion = Motion::default();
    let mut curves: HashMap<usize, Curves> = HashMap::new();
    for (number, input) in inputs.iter().enumerate() {
        let held = |why: String| Held {
            name: input.name.clone(),
            why,
        };
        if motion.inputs.len() == MOST {
            motion
                .held
                .push(held(format!("a shader takes {MOST} inputs at most")));
            continue;
        }
        let fitted = match input.range {
            Some(range) => slider(&mut tried, number, range),
            None => waves(&mut tried, number, &mut motion.periods),
        };
        let fitted = match fitted {
            Ok(fitted) => fitted,
            Err(why) => {
                motion.held.push(held(match why {
                    Why::Fails(x) => format!("the scene fails at {}", short(x)),
                    Why::Structure(x) => {
                        format!("what the scene is made of is not the same at {}", short(x))
                    }
                    Why::Number => {
                        "numbers of the scene follow it in ways that no short formula has"
                            .to_owned()
                    }
                }));
                continue;
            }
        };
        let mut all = curves.clone();
        for (place, curve) in fitted {
            all.entry(place).or_default().push((number, curve));
        }
        let mut carried = motion.inputs.clone();
        carried.push(number);
        if carried.len() == 1 || holds_together(&mut tried, &carried, &all, &motion.periods) {
            (motion.inputs, curves) = (carried, all);
        } else {
            let others: Vec<&str> = motion
                .inputs
                .iter()
                .map(|i| inputs[*i].name.as_str())
                .collect();
            motion.held.push(held(format!(
                "numbers of the scene follow it together with {}",
                others.join(", ")
            )));
        }
    }
    let mut formulas: Vec<_> = curves
        .into_iter()
        .map(|(place, curves)| (place, tried.base.values[place], curves))
        .collect();
    formulas.sort_by_key(|(place, ..)| *place);
    motion.formulas = formulas;
    if !motion.inputs.is_empty() {
        for (place, loose) in tried.base.loose.iter().enumerate() {
            let (least, most) = (tried.least[place], tried.most[place]);
            // between the places that were tried it may be a little more
            let air = 0.05 * (most - least);
            if air > 0.0 && *loose != 0 {
                let bound = if *loose > 0 { most + air } else { least - air };
                motion.bounds.push((place, bound));
            }
        }
    }
    motion
}

/// The places that an input changes, of those that are not only bounds.
fn changed(tried: &Tried<'_>, samples: &[Vec<f64>]) -> Vec<usize> {
    let base = &tried.base;
    let differs = |place: &usize| {
        base.loose[*place] == 0 && samples.iter().any(|s| s[*place] != base.values[*place])
    };
    (0..base.values.len()).filter(differs).collect()
}

/// How far a number may be off whose samples these are.
fn near(samples: impl Iterator<Item = f64>) -> f64 {
    NEAR * samples
        .fold(0.0, |most: f64, x| most.max(x.abs()))
        .max(1e-30)
}

fn slider(tried: &mut Tried<'_>, input: usize, [min, max]: [f64; 2]) -> Result<Curves, Why> {
    let (middle, half) = (0.5 * (min + max), 0.5 * (max - min));
    let angle = |k: usize| PI * (k as f64 + 0.5) / NODES as f64;
    let mut samples = Vec::new();
    for k in 0..NODES {
        samples.push(tried.alone(input, middle + half * angle(k).cos())?);
    }
    let tests = [0.0, 0.113, 0.271, 0.5, 0.639, 0.871, 1.0].map(|share| min + share * (max - min));
    let mut right = Vec::new();
    for x in tests {
        right.push(tried.alone(input, x)?);
    }
    let all: Vec<Vec<f64>> = samples.iter().chain(&right).cloned().collect();
    let mut out = Vec::new();
    let value = tried.inputs[input].value;
    for place in changed(tried, &all) {
        let near = near(all.iter().map(|s| s[place]));
        let mut factors: Vec<f64> = (0..NODES)
            .map(|j| {
                let term = |k: usize| samples[k][place] * (j as f64 * angle(k)).cos();
                2.0 / NODES as f64 * (0..NODES).map(term).sum::<f64>()
            })
            .collect();
        factors.remove(0);
        while factors.last().is_some_and(|x| x.abs() < 0.25 * near) {
            factors.pop();
        }
        let curve = match factors[..] {
            [slope] => Curve::Line(slope / half),
            _ => {
                let start = chebyshev(&factors, (value - middle) / half);
                Curve::Polynomial(factors, start)
            }
        };
        let base = tried.base.values[place];
        for (x, right) in tests.iter().zip(&right) {
            let found = base + curve.at(*x, &tried.inputs[input], &[]);
            if (found - right[place]).abs() > near {
                return Err(Why::Number);
            }
        }
        out.push((place, curve));
    }
    Ok(out)
}

/// A sum of Chebyshev's polynomials from the first on (Clenshaw 1955).
fn chebyshev(factors: &[f64], x: f64) -> f64 {
    let (mut a, mut b) = (0.0, 0.0);
    for factor in factors.iter().rev() {
        (a, b) = (factor + 2.0 * x * a - b, a);
    }
    x * a - b
}

fn waves(tried: &mut Tried<'_>, input: usize, periods: &mut Vec<f64>) -> Result<Curves, Why> {
    let start = tried.inputs[input].value;
    // places that no simple period has in common
    let tests: Vec<f64> = [0.137, 0.731, 1.919, 3.371, 7.717, 16.329, 41.77, 133.37]
        .map(|t| start + t)
        .into();
    let mut right = Vec::new();
    for t in &tests {
        right.push(tried.alone(input, *t)?);
    }
    let mut out = Vec::new();
    let places = changed(tried, &right);
    for place in places {
        let base = tried.base.values[place];
        let near = near(right.iter().map(|s| s[place]).chain([base]));
        let holds = |curve: &Curve, periods: &[f64], tried: &Tried<'_>| {
            tests.iter().zip(&right).all(|(t, right)| {
                let found = base + curve.at(*t, &tried.inputs[input], periods);
                (found - right[place]).abs() <= near
            })
        };
        let line = Curve::Line((right[7][place] - base) / (tests[7] - start));
        if holds(&line, periods, tried) {
            out.push((place, line));
            continue;
        }
        let mut fitted = None;
        let mut candidates = periods.clone();
        candidates.extend(guessed(tried, input, place)?);
        candidates.extend([
            0.5,
            1.0,
            2.0,
            3.0,
            4.0,
            5.0,
            6.0,
            8.0,
            10.0,
            12.0,
            15.0,
            20.0,
            24.0,
            30.0,
            60.0,
            PI,
            TAU,
            2.0 * TAU,
        ]);
        for period in candidates {
            let after = tried.alone(input, tests[2] + period)?[place];
            if (after - right[2][place]).abs() > near {
                continue;
            }
            let number = periods.iter().position(|p| *p == period);
            let number = match number {
                Some(number) => number,
                None if periods.len() < PERIODS => {
                    periods.push(period);
                    periods.len() - 1
                }
                None => continue,
            };
            let mut samples = Vec::new();
            for k in 0..SAMPLES {
                let share = (k as f64 + BESIDE) / SAMPLES as f64;
                samples.push(tried.alone(input, period * share)?[place]);
            }
            let curve = harmonics(number, &samples, near, period, start);
            if curve.terms() <= TERMS && holds(&curve, periods, tried) {
                fitted = Some(curve);
                break;
            }
            // nobody else has it
            if number + 1 == periods.len()
                && !out
                    .iter()
                    .any(|(_, c)| matches!(c, Curve::Waves(n, ..) if *n == number))
            {
                periods.pop();
            }
        }
        out.push((place, fitted.ok_or(Why::Number)?));
    }
    Ok(out)
}

/// The waves that a period's samples are, less what they are at first.
fn harmonics(number: usize, samples: &[f64], near: f64, period: f64, start: f64) -> Curve {
    let n = samples.len() as f64;
    let mut waves: Vec<[f64; 2]> = (1..samples.len() / 2)
        .map(|j| {
            let mut sums = [0.0; 2];
            for (k, x) in samples.iter().enumerate() {
                let turns = j as f64 * (k as f64 + BESIDE) / n;
                let (sin, cos) = (TAU * turns.fract()).sin_cos();
                sums[0] += 2.0 / n * x * cos;
                sums[1] += 2.0 / n * x * sin;
            }
            sums.map(|x| if x.abs() < 0.1 * near { 0.0 } else { x })
        })
        .collect();
    while waves.last().is_some_and(|w| *w == [0.0; 2]) {
        waves.pop();
    }
    let constant = wave(&waves, start / period);
    Curve::Waves(number, waves, constant)
}

fn wave(waves: &[[f64; 2]], turns: f64) -> f64 {
    let terms = (1..).zip(waves).map(|(j, [a, b])| {
        let (sin, cos) = (TAU * (f64::from(j) * turns).fract()).sin_cos();
        a * cos + b * sin
    });
    terms.sum()
}

/// The period of a single wave around a constant: differences of even steps satisfy `d(k + 1) + d(k - 1) = 2 cos(w h) d(k)`. Longer and
/// longer steps tell it better.
fn guessed(tried: &mut Tried<'_>, input: usize, place: usize) -> Result<Option<f64>, Why> {
    let start = tried.inputs[input].value;
    let mut frequency: Option<f64> = None;
    let mut step = 1.0 / 64.0;
    while step < 200.0 {
        let mut samples = Vec::new();
        for k in 0..6 {
            samples.push(tried.alone(input, start + LATER + step * f64::from(k))?[place]);
        }
        let d: Vec<f64> = samples.windows(2).map(|w| w[1] - w[0]).collect();
        let over: f64 = d.windows(3).map(|w| (w[0] + w[2]) * w[1]).sum();
        let under: f64 = d.windows(3).map(|w| 2.0 * w[1] * w[1]).sum();
        let cosine = over / under;
        if cosine.is_finite() && cosine.abs() < 0.9999 {
            // the angle of a step, and whole turns as the frequency before says
            let angle = cosine.acos();
            let candidates = |turns: f64| [TAU * turns + angle, TAU * turns - angle];
            let expected = frequency.map_or(angle, |w| w * step);
            let turns = (expected / TAU).round();
            let near = [turns - 1.0, turns, turns + 1.0].map(candidates).concat();
            let best = near
                .into_iter()
                .min_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()));
            // where the cosine is flat the angle is not known well
            if let Some(best) = best.filter(|_| frequency.is_none() || cosine.abs() < 0.9) {
                frequency = Some(best / step);
            }
        }
        step *= 2.0;
    }
    Ok(frequency
        .map(|w| TAU / w.abs())
        .filter(|p| p.is_finite() && *p > 0.02 && *p < 2000.0)
        .map(rounded))
}

/// The number of few digits that is as near as the measure is.
fn rounded(x: f64) -> f64 {
    for unit in [1.0, TAU, 360.0] {
        for whole in 1..=24 {
            let times = x / unit * f64::from(whole);
            if times >= 0.5 && (times - times.round()).abs() < 2e-5 * times {
                return times.round() * unit / f64::from(whole);
            }
        }
    }
    x
}

fn holds_together(
    tried: &mut Tried<'_>,
    carried: &[usize],
    curves: &HashMap<usize, Curves>,
    periods: &[f64],
) -> bool {
    let inputs = tried.inputs;
    for k in 0..TOGETHER {
        let mut values: Vec<f64> = inputs.iter().map(|i| i.value).collect();
        for (j, input) in carried.iter().enumerate() {
            // a sequence of low discrepancy (Weyl 1916), by another root for each input
            let share = ((k + 1) as f64 * ((2 * j + 3) as f64).sqrt()).fract();
            values[*input] = match inputs[*input].range {
                Some([min, max]) => min + share * (max - min),
                None => inputs[*input].value + 20.0 * share,
            };
        }
        let Some(right) = tried.at(&values).and_then(|numbers| tried.same(numbers)) else {
            return false;
        };
        for (place, right) in right.iter().enumerate() {
            let base = tried.base.values[place];
            if tried.base.loose[place] != 0 {
                continue;
            }
            let added = curves.get(&place).map_or(0.0, |curves| {
                let each = |(i, curve): &(usize, Curve)| curve.at(values[*i], &inputs[*i], periods);
                curves.iter().map(each).sum()
            });
            let near = near([base, *right, tried.most[place], tried.least[place]].into_iter());
            if (base + added - right).abs() > 2.0 * near {
                return false;
            }
        }
    }
    true
}

impl Curve {
    fn terms(&self) -> usize {
        match self {
            Curve::Line(_) => 1,
            Curve::Polynomial(factors, _) => factors.len(),
            Curve::Waves(_, waves, _) => waves.as_flattened().iter().filter(|x| **x != 0.0).count(),
        }
    }

    /// What is added at a value of the input.
    fn at(&self, x: f64, input: &Input, periods: &[f64]) -> f64 {
        match self {
            Curve::Line(slope) => slope * (x - input.value),
            Curve::Polynomial(factors, start) => chebyshev(factors, unit(x, input)) - start,
            Curve::Waves(number, waves, start) => wave(waves, x / periods[*number]) - start,
        }
    }
}

/// A slider's value from -1 to 1.
fn unit(x: f64, input: &Input) -> f64 {
    let [min, max] = input.range.unwrap_or([-1.0, 1.0]);
    (2.0 * x - min - max) / (max - min)
}

fn short(x: f64) -> String {
    let text = format!("{x:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number as WGSL.
fn number(x: f64) -> String {
    format!("{:?}f", x.clamp(-3e38, 3e38) as f32)
}

impl Motion {
    /// Whether time is among the inputs.
    pub(crate) fn moves(&self, inputs: &[Input]) -> bool {
        self.inputs.iter().any(|i| inputs[*i].range.is_none())
    }

    /// Without any input, all for one reason.
    pub(crate) fn held(inputs: &[Input], why: &str) -> Motion {
        let held = |input: &Input| Held {
            name: input.name.clone(),
            why: why.to_owned(),
        };
        Motion {
            held: inputs.iter().map(held).collect(),
            ..Motion::default()
        }
    }

    /// What a place holds for values of the inputs.
    #[cfg(test)]
    pub(crate) fn at(&self, inputs: &[Input], place: usize, base: f64, values: &[f64]) -> f64 {
        if let Some((_, bound)) = self.bounds.iter().find(|(at, _)| *at == place) {
            return *bound;
        }
        let curves = self.formulas.iter().find(|(at, ..)| *at == place);
        let added = curves.into_iter().flat_map(|(.., curves)| curves);
        let each = |(i, curve): &(usize, Curve)| curve.at(values[*i], &inputs[*i], &self.periods);
        base + added.map(each).sum::<f64>()
    }

    /// The function `animate` in WGSL, of the inputs that are carried, which puts all numbers in their places. `place` is what a place is called.
    pub(crate) fn text(&self, inputs: &[Input], place: impl Fn(usize) -> String) -> String {
        let names: Vec<String> = (self.inputs.iter())
            .map(|i| format!("{}: f32", letter(*i)))
            .collect();
        let mut text = format!(
            "\n/// Puts what changes in its place.\nfn animate({}) {{\n",
            names.join(", ")
        );
        let used = |wanted: &dyn Fn(&Curve) -> bool| {
            self.formulas
                .iter()
                .any(|(.., c)| c.iter().any(|(_, c)| wanted(c)))
        };
        for i in &self.inputs {
            let Some([min, max]) = inputs[*i].range else {
                for (k, period) in self.periods.iter().enumerate() {
                    if used(&|c| matches!(c, Curve::Waves(n, ..) if *n == k)) {
                        // a turn, whose whole part is taken off: of large angles single precision has no sine
                        let _ = writeln!(
                            text,
                            "    let {turn} = {} * ({time} / {period} - floor({time} / {period}));",
                            number(TAU),
                            turn = turn(k),
                            time = letter(*i),
                            period = number(*period)
                        );
                    }
                }
                continue;
            };
            if self.formulas.iter().any(|(.., c)| {
                c.iter()
                    .any(|(n, c)| n == i && matches!(c, Curve::Polynomial(..)))
            }) {
                let _ = writeln!(
                    text,
                    "    let {}_share = clamp((2.0 * {} - {}) / {}, -1.0, 1.0);",
                    letter(*i),
                    letter(*i),
                    number(min + max),
                    number(max - min)
                );
            }
        }
        for (at, bound) in &self.bounds {
            let _ = writeln!(text, "    {} = {};", place(*at), number(*bound));
        }
        for (at, base, curves) in &self.formulas {
            let mut constant = *base;
            let mut terms = String::new();
            for (i, curve) in curves {
                match curve {
                    Curve::Line(slope) => {
                        constant -= slope * inputs[*i].value;
                        let _ = write!(terms, " + {} * {}", number(*slope), letter(*i));
                    }
                    Curve::Polynomial(factors, start) => {
                        // Clenshaw's sum, written out as Horner's of the powers
                        let mut sum = String::new();
                        let powers = powers(factors);
                        constant += powers[0] - start;
                        let x = format!("{}_share", letter(*i));
                        for power in powers[1..].iter().rev() {
                            sum = if sum.is_empty() {
                                number(*power)
                            } else {
                                format!("({sum} * {x} + {})", number(*power))
                            };
                        }
                        let _ = write!(terms, " + {sum} * {x}");
                    }
                    Curve::Waves(n, waves, start) => {
                        constant -= start;
                        for (j, [a, b]) in (1..).zip(waves) {
                            for (factor, function) in [(a, "cos"), (b, "sin")] {
                                if *factor != 0.0 {
                                    let _ = write!(
                                        terms,
                                        " + {} * {function}({j}.0 * {})",
                                        number(*factor),
                                        turn(*n)
                                    );
                                }
                            }
                        }
                    }
                }
            }
            let _ = writeln!(text, "    {} = {}{terms};", place(*at), number(constant));
        }
        text += "}\n";
        text
    }
}

/// The powers of a sum of Chebyshev's polynomials from the first on, by their recurrence.
fn powers(factors: &[f64]) -> Vec<f64> {
    let count = factors.len() + 1;
    let (mut before, mut now) = (vec![0.0; count], vec![0.0; count]);
    before[0] = 1.0;
    now[1.min(count - 1)] = 1.0;
    let mut out = vec![0.0; count];
    for factor in factors {
        for (sum, x) in out.iter_mut().zip(&now) {
            *sum += factor * x;
        }
        let next: Vec<f64> = (0..count)
            .map(|k| 2.0 * k.checked_sub(1).map_or(0.0, |k| now[k]) - before[k])
            .collect();
        (before, now) = (now, next);
    }
    out
}

/// What an input is called inside: no name ends in a digit, to which translators add an underscore.
fn letter(input: usize) -> String {
    format!("input_{}", alphabet(input))
}

fn turn(period: usize) -> String {
    format!("turn_{}", alphabet(period))
}

fn alphabet(n: usize) -> String {
    let (a, b) = (n / 26, n % 26);
    let letter = |n: usize| char::from(b'a' + (n % 26) as u8);
    if a == 0 {
        letter(b).to_string()
    } else {
        format!("{}{}", letter(a - 1), letter(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zeroset_testkit::wgsl::{Shader, Value};

    fn inputs() -> Vec<Input> {
        let input = |name: &str, value: f64, range| Input {
            name: name.to_owned(),
            value,
            range,
        };
        vec![
            input("time()", 0.25, None),
            input("size", 0.8, Some([0.1, 2.0])),
            input("bend", -1.0, Some([-3.0, 5.0])),
        ]
    }

    /// As a scene's numbers are: in single precision.
    fn numbers(values: Vec<f64>, structure: u64) -> Numbers {
        Numbers {
            structure,
            loose: vec![0; values.len()],
            values: values.iter().map(|x| f64::from(*x as f32)).collect(),
        }
    }

    /// What the text makes of values of the inputs.
    fn animated(motion: &Motion, inputs: &[Input], base: &[f64], values: &[f64]) -> Vec<f64> {
        let text = motion.text(inputs, |place| format!("found[{place}]"));
        let names: Vec<String> = motion
            .inputs
            .iter()
            .map(|i| format!("{}: f32", letter(*i)))
            .collect();
        let passed: Vec<String> = motion.inputs.iter().map(|i| letter(*i)).collect();
        let shader = Shader::whole(&format!(
            "var<private> found: array<f32, {}>;\n{text}\nfn probe(at: u32, {}) -> f32 {{\n animate({});\n return found[at];\n}}",
            base.len(),
            names.join(", "),
            passed.join(", ")
        ));
        let places = motion.formulas.iter().map(|(place, ..)| *place);
        let places: Vec<usize> = places.chain(motion.bounds.iter().map(|b| b.0)).collect();
        let mut out = base.to_vec();
        for place in places {
            let mut arguments = vec![Value::Count(place as u32)];
            arguments.extend(
                motion
                    .inputs
                    .iter()
                    .map(|i| Value::Float(values[*i] as f32)),
            );
            out[place] = f64::from(shader.call_with("probe", arguments, &[])[0]);
        }
        out
    }

    #[test]
    fn smooth_numbers_become_formulas() {
        let inputs = inputs();
        let scene = |v: &[f64]| {
            let (t, size, bend) = (v[0], v[1], v[2]);
            let turn = (77.0 * t).to_radians();
            vec![
                3.0,
                1.0 - 2.0 * t,
                (TAU * t).sin() + size,
                turn.cos(),
                -turn.sin(),
                0.5 * turn.cos().powi(2) - 3.0 * bend,
                1.0 / (1.0 + size) + (bend * 0.5).sin(),
                size.powi(3),
                (3.0 * t).sin().exp(),
            ]
        };
        let base: Vec<f64> = inputs.iter().map(|i| i.value).collect();
        let mut make = |v: &[f64]| Some(numbers(scene(v), 0));
        let motion = found(&inputs, numbers(scene(&base), 0), &mut make);
        assert_eq!(motion.held, []);
        assert_eq!(motion.inputs, [0, 1, 2]);
        for k in 0..40 {
            let share = |root: f64| (f64::from(k) * root.sqrt()).fract();
            let v = [
                60.0 * share(2.0),
                0.1 + 1.9 * share(3.0),
                -3.0 + 8.0 * share(5.0),
            ];
            let found = animated(&motion, &inputs, &scene(&base), &v);
            for (place, (found, right)) in found.iter().zip(scene(&v)).enumerate() {
                // a turn of 60 seconds in single precision
                assert!(
                    (found - right).abs() < 4e-5 * right.abs().max(1.0),
                    "{place} at {v:?}: {found}, not {right}"
                );
            }
        }
    }

    /// Numbers and their structure.
    type Scene<'a> = dyn Fn(&[f64]) -> Option<(Vec<f64>, u64)> + 'a;

    /// What cannot be followed is left out whole, with the reason.
    #[test]
    fn what_no_formula_has_is_held() {
        let inputs = inputs();
        let why = |scene: &Scene<'_>| {
            let base: Vec<f64> = inputs.iter().map(|i| i.value).collect();
            let (values, structure) = scene(&base).unwrap();
            let mut make =
                |v: &[f64]| scene(v).map(|(values, structure)| numbers(values, structure));
            let motion = found(&inputs, numbers(values, structure), &mut make);
            motion
                .held
                .into_iter()
                .map(|h| format!("{}: {}", h.name, h.why))
                .collect::<Vec<_>>()
        };
        let found = why(&|v| Some((vec![(v[0] * v[0]).sin(), v[1].max(0.7), v[2]], 0)));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(
            found.iter().all(|why| why.contains("no short formula")),
            "{found:?}"
        );
        let found = why(&|v| Some((vec![v[0].sin() * v[1], v[2]], 0)));
        assert_eq!(
            found,
            ["size: numbers of the scene follow it together with time()"]
        );
        let found = why(&|v| Some((vec![v[0], v[1]], u64::from(v[2] > 2.0))));
        assert!(
            found.len() == 1 && found[0].contains("bend: what the scene is made of"),
            "{found:?}"
        );
        let found = why(&|v| (v[1] < 1.5).then(|| (vec![v[0], v[1]], 0)));
        assert!(
            found.len() == 1 && found[0].contains("size: the scene fails at"),
            "{found:?}"
        );
    }

    #[test]
    fn bounds_hold_for_all_that_is_seen() {
        let inputs = &inputs()[..1];
        let scene = |t: f64| Numbers {
            structure: 0,
            values: vec![t.sin(), t.sin().max(0.3 * t.cos())],
            loose: vec![0, 1],
        };
        let mut make = |v: &[f64]| Some(scene(v[0]));
        let motion = found(inputs, scene(0.25), &mut make);
        assert_eq!(motion.inputs, [0]);
        let [(1, bound)] = motion.bounds[..] else {
            panic!("{:?}", motion.bounds);
        };
        assert!((1.0..1.2).contains(&bound), "{bound}");
    }
}
