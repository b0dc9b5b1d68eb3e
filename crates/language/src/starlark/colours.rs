//! Formulas of materials: `material(color = lambda p: ...)`, and the same for roughness, metal, bumps and the parts of patterns.

use super::formulas::{given_by, told};
use super::mistake::{Mistake, Run, mistake};
use super::native::{Call, Given};
use super::value::Value;
use std::sync::Arc;
use zeroset_field::formula::{Builder, ColourFormula, ColourFormulaError, Expression};
use zeroset_scene::colour::linear_channel;
use zeroset_scene::material::Pattern;

/// What a formula of a material has to give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// A colour.
    Colour,
    /// A number: a roughness, a height.
    Number,
    /// A colour, or a number as a grey of this luminance: part of a pattern.
    Either,
}

impl Call<'_, '_> {
    /// The pattern that a function of a point is; none where what was given is no function.
    pub(super) fn formula_pattern(
        &mut self,
        param: &str,
        given: Given,
        shown: Shown,
    ) -> Run<Option<Pattern>> {
        if !matches!(given.value, Value::Function(_) | Value::Formula(_)) {
            return Ok(None);
        }
        let gives = match shown {
            Shown::Colour => "a colour",
            Shown::Number => "a number",
            Shown::Either => "a colour or a number",
        };
        let (builder, value) = given_by(self, given, false, gives)?;
        let value = match (value.parts(), shown) {
            (1, Shown::Number | Shown::Either) => value,
            (3, Shown::Colour | Shown::Either) => linear(&builder, &value),
            (1, Shown::Colour) => {
                let m = self.misshapen(param, "a colour, not a number");
                return Err(m
                    .help("a grey is vec3(x); mix(\"red\", \"white\", x) goes from one colour to another")
                    .at(given.place));
            }
            (parts, Shown::Number) => {
                let m = self.misshapen(param, &format!("a number, not a vector of {parts}"));
                return Err(m
                    .help("length(v) makes a number of a vector, v.x is one of its parts")
                    .at(given.place));
            }
            (parts, _) => {
                let m = self.misshapen(param, &format!("{gives}, not a vector of {parts}"));
                return Err(m
                    .help("a colour is three numbers, red, green and blue, 0 to 1")
                    .at(given.place));
            }
        };
        let formula = builder.finish_colour(&value).map_err(|e| match e {
            ColourFormulaError::Build(e) => told(&e).at(given.place),
            e => mistake(e.to_string()).at(given.place),
        })?;
        self.machine.charge(formula.steps().len() as u64)?;
        self.machine
            .grow(size_of_val(formula.steps()) + size_of::<ColourFormula>())?;
        let formula = Arc::new(formula);
        Ok(Some(Pattern::Formula { formula }))
    }

    fn misshapen(&self, param: &str, what: &str) -> Box<Mistake> {
        mistake(format!(
            "the function for {} must give {what}",
            self.called(param)
        ))
    }
}

/// The linear parts of a colour as it is written, sRGB (IEC 61966-2-1), in the steps of the formula.
fn linear(builder: &Builder, colour: &Expression) -> Expression {
    let parts: Vec<Expression> = (0..colour.parts())
        .map(|k| {
            let x = colour.part(k);
            match x.as_constant() {
                Some(c) => builder.constant(linear_channel(c.clamp(0.0, 1.0))),
                None => x
                    .less(0.04045)
                    .choose(&x / 12.92, ((&x + 0.055) / 1.055).pow(2.4)),
            }
        })
        .collect();
    builder.vector(&parts)
}
