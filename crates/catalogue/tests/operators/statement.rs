//! What an entry says of itself, at which parameters it is tried, and what a failed proof reports.

use std::fmt;

use zeroset_catalogue::{Info, Kind};

use crate::formula::Numbers;

/// What a proof found, and where.
#[derive(Debug)]
pub struct Failure {
    pub entry: &'static str,
    pub proof: &'static str,
    pub params: Vec<f64>,
    pub what: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} {:?}: {}: {}",
            self.entry, self.params, self.proof, self.what
        )
    }
}

/// What all kinds of operators have.
#[derive(Clone, Copy)]
pub struct Common {
    pub info: Info,
    pub samples: &'static [&'static [f64]],
    pub numbers: Numbers,
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// An operator's parameters as evaluators read them, and the same numbers in `f64`.
pub struct Params {
    pub stored: Vec<f32>,
    pub exact: Vec<f64>,
}

impl Common {
    /// The sets of parameters that the proofs run at.
    pub fn sets(&self) -> Vec<Params> {
        let samples = self.samples.iter().map(|s| s.to_vec());
        let sets = std::iter::once(self.info.defaults()).chain(samples);
        sets.map(|set| {
            let stored: Vec<f32> = set.iter().map(|&x| x as f32).collect();
            let exact = stored.iter().map(|&x| f64::from(x)).collect();
            Params { stored, exact }
        })
        .collect()
    }

    pub fn fail(&self, proof: &'static str, a: &Params, what: String) -> Failure {
        Failure {
            entry: self.info.name,
            proof,
            params: a.exact.clone(),
            what,
        }
    }

    /// Names, words, ranges, defaults and samples.
    pub fn prove_info(&self) -> Result<(), Failure> {
        let none = Params {
            stored: Vec::new(),
            exact: self.info.defaults(),
        };
        let fail = |what: String| self.fail("info", &none, what);
        if !snake_case(self.info.name) || !one_line(self.info.doc) || self.info.group.is_empty() {
            return Err(fail(format!(
                "name, doc or group: {:?}, {:?}",
                self.info.doc, self.info.group
            )));
        }
        for p in self.info.params {
            if !snake_case(p.name) || !one_line(p.doc) || !(p.min < p.max) {
                return Err(fail(format!(
                    "parameter {} ({}) from {} to {}",
                    p.name, p.doc, p.min, p.max
                )));
            }
            if matches!(p.kind, Kind::List(_)) || p.default.len() != p.kind.len() {
                return Err(fail(format!(
                    "parameter {} has {} defaults",
                    p.name,
                    p.default.len()
                )));
            }
        }
        for set in
            std::iter::once(self.info.defaults()).chain(self.samples.iter().map(|s| s.to_vec()))
        {
            let ranges = self
                .info
                .params
                .iter()
                .flat_map(|p| (0..p.kind.len()).map(move |_| p.min..=p.max));
            if set.len() != ranges.clone().count() || !ranges.zip(&set).all(|(r, x)| r.contains(x))
            {
                return Err(fail(format!("the set {set:?} does not fit the parameters")));
            }
            (self.check)(&set).map_err(|why| fail(format!("the set {set:?} is refused: {why}")))?;
        }
        Ok(())
    }

    /// The recorded formula and gradient are WGSL that naga accepts.
    pub fn prove_shader(&self) -> Result<(), Failure> {
        let head = "@group(0) @binding(0) var<storage, read> params: array<f32>;\n";
        let source = format!("{head}{}", (self.numbers.shader)());
        let none = Params {
            stored: Vec::new(),
            exact: Vec::new(),
        };
        let fail = |why: String| self.fail("shader", &none, format!("{why}\n{source}"));
        let module =
            naga::front::wgsl::parse_str(&source).map_err(|e| fail(e.emit_to_string(&source)))?;
        let (flags, none) = (
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::empty(),
        );
        naga::valid::Validator::new(flags, none)
            .validate(&module)
            .map_err(|e| fail(e.emit_to_string(&source)))?;
        Ok(())
    }
}

fn snake_case(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
}

fn one_line(doc: &str) -> bool {
    doc.len() > 8 && doc.len() <= 120 && doc.ends_with('.') && !doc.contains('\n')
}
