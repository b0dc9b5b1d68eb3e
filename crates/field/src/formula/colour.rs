//! Formulas of colours: what a surface looks like from point to point.

use super::{BuildError, FormulaStep, Inner, Steps, StepsError};
use crate::compile;
use crate::program::{CompileError, Limits};
use std::sync::Arc;
use zeroset_catalogue::tape::{Code, Tape};
use zeroset_eval::PointNumber;
use zeroset_number::{Data, Vec3};

/// A formula of a point that gives three numbers: red, green and blue, linear. (Solid texturing: Perlin 1985, Peachey 1985.)
///
/// No slope is proven, as no ray takes steps by it, and its values may be anything: whoever shows them clamps them, and shows
/// something else where they are no numbers. Made with
/// [`Builder::finish_colour`](super::Builder::finish_colour), or of steps.
#[derive(Clone, Debug)]
pub struct ColourFormula {
    steps: Steps,
    results: [u32; 3],
    code: Code,
    data: Arc<Data>,
}

/// Why something is no formula of colours.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ColourFormulaError {
    /// It cannot be written down.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Its steps are none.
    #[error(transparent)]
    Steps(#[from] StepsError),
    /// Neither one number nor three.
    #[error("a colour is three numbers, red, green and blue, this is a vector of {parts}")]
    Parts {
        /// The length of the vector.
        parts: usize,
    },
    /// It is too large.
    #[error(transparent)]
    Compile(#[from] CompileError),
}

impl PartialEq for ColourFormula {
    fn eq(&self, o: &Self) -> bool {
        self.steps == o.steps && self.results == o.results
    }
}

impl ColourFormula {
    /// Of steps whose values at a point are, at these places, red, green and blue.
    ///
    /// # Errors
    /// Places of no steps, or a formula that is too large.
    pub fn new(steps: Steps, results: [u32; 3]) -> Result<ColourFormula, ColourFormulaError> {
        if let Some(&operand) = results.iter().find(|r| **r as usize >= steps.list().len()) {
            let step = steps.list().len();
            return Err(StepsError::Operand { step, operand }.into());
        }
        let mut formula = ColourFormula {
            steps,
            results,
            code: Code {
                instructions: Vec::new(),
                registers: 3,
                result: 0,
            },
            data: Arc::default(),
        };
        let (code, data) = compile::colour(&formula, &Limits::default())?;
        (formula.code, formula.data) = (code, Arc::new(data));
        Ok(formula)
    }

    /// Black.
    pub fn black() -> ColourFormula {
        let steps = Steps::new(vec![FormulaStep::Constant(0.0)]);
        steps
            .map_err(ColourFormulaError::from)
            .and_then(|steps| ColourFormula::new(steps, [0; 3]))
            .expect("a constant is a formula")
    }

    /// Of a list of steps and the fields whose values they take. Whole powers are written as products, so the list may become longer.
    ///
    /// # Errors
    /// As for [`Steps::with_fields`] and [`ColourFormula::new`].
    pub fn of_steps(
        steps: Vec<FormulaStep>,
        fields: Vec<Inner>,
        mut results: [u32; 3],
    ) -> Result<ColourFormula, ColourFormulaError> {
        let steps = Steps::checked(steps, fields, &mut results)?;
        ColourFormula::new(steps, results)
    }

    /// The steps, of which [`ColourFormula::results`] are the values.
    pub fn steps(&self) -> &[FormulaStep] {
        self.steps.list()
    }

    /// The fields whose values the steps take.
    pub fn fields(&self) -> &[Inner] {
        self.steps.fields()
    }

    /// The steps that are red, green and blue.
    pub fn results(&self) -> [u32; 3] {
        self.results
    }

    /// What finds the colour: it leaves red, green and blue where the coordinates of the point were.
    pub fn tape(&self) -> Tape<'_> {
        Tape {
            code: &self.code,
            data: &self.data,
        }
    }

    /// Red, green and blue at a point.
    pub fn eval<R: PointNumber>(&self, p: Vec3<R>) -> [R; 3] {
        let values = self.steps.eval_all(p);
        self.results.map(|step| values[step as usize])
    }
}
