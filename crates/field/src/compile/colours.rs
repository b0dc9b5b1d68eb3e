//! Formulas of colours: what gives three numbers is a map of points, to where red, green and blue are the coordinates.

use super::{INPUT, Lowering, registers};
use crate::formula::ColourFormula;
use crate::program::{CompileError, Limits, Program, Structure};
use std::sync::Arc;
use zeroset_catalogue::tape::{Code, Operation};
use zeroset_number::Data;

/// The instructions of a formula of colours on its own, and the numbers that they read.
pub(crate) fn colour(
    formula: &ColourFormula,
    limits: &Limits,
) -> Result<(Code, Data), CompileError> {
    let mut l = Lowering::new(limits, &[], true);
    let result = l.colour(formula)?;
    let code = in_place(&l, result)?;
    let data = Data {
        params: l.params,
        grids: l.grids,
    };
    Ok((code, data))
}

/// A program that also knows formulas of colours: their numbers come behind its own.
pub(crate) fn with_colours(
    program: &Program,
    formulas: &[Arc<ColourFormula>],
    limits: &Limits,
) -> Result<Program, CompileError> {
    if formulas.is_empty() {
        return Ok(program.clone());
    }
    let mut l = Lowering::new(limits, &[], true);
    l.params.clone_from(&program.data.params);
    l.grids.clone_from(&program.data.grids);
    let results = formulas.iter().map(|formula| l.colour(formula));
    let results = results.collect::<Result<Vec<u32>, CompileError>>()?;
    let colours = results.into_iter().map(|result| in_place(&l, result));
    let structure = Structure {
        colours: colours.collect::<Result<Vec<Code>, CompileError>>()?,
        ..Structure::clone(&program.structure)
    };
    Ok(Program {
        structure: Arc::new(structure),
        data: Arc::new(Data {
            params: l.params,
            grids: l.grids,
        }),
        ..program.clone()
    })
}

impl Lowering<'_> {
    /// The point whose coordinates are what a formula gives.
    fn colour(&mut self, formula: &ColourFormula) -> Result<u32, CompileError> {
        let values = self.formula_steps(formula.steps(), formula.fields(), INPUT)?;
        let mut point = INPUT;
        for (k, step) in (0..3).zip(formula.results()) {
            point = self.emit(Operation::Put(k), values[step as usize], point, &[])?;
        }
        Ok(point)
    }
}

/// Instructions that leave a point in the registers that it was asked at, which nothing reads once the last one runs.
fn in_place(l: &Lowering<'_>, result: u32) -> Result<Code, CompileError> {
    let (mut code, _) = registers(&l.steps, &[result], false)?;
    if let Some(last) = code.instructions.last_mut() {
        last.out = 0;
    }
    code.result = 0;
    Ok(code)
}
