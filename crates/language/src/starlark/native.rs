//! Functions of this crate: what they take, and how arguments reach them.

use super::machine::Machine;
use super::mistake::{Mistake, Run, mistake};
use super::synonyms;
use super::value::Value;
use crate::report::{Place, suggestion};
use std::borrow::Cow;

/// A function that the language offers.
#[derive(Debug)]
pub(crate) struct Native {
    pub(crate) name: &'static str,
    /// One line.
    pub(crate) doc: &'static str,
    /// The section of the reference it stands in.
    pub(crate) group: &'static str,
    pub(crate) params: &'static [Slot],
    /// Whether more values may follow by place.
    pub(crate) rest: bool,
    pub(crate) run: fn(&mut Call<'_, '_>) -> Run<Value>,
}

/// A parameter of a native function.
#[derive(Debug)]
pub(crate) struct Slot {
    pub(crate) name: &'static str,
    /// How the default is written; empty where there is none.
    pub(crate) default: &'static str,
    /// One line: what it means, its unit, its range.
    pub(crate) doc: &'static str,
}

/// A parameter that may be left out.
pub(crate) const fn slot(name: &'static str, default: &'static str, doc: &'static str) -> Slot {
    Slot { name, default, doc }
}

/// An argument as it was written.
pub(crate) struct Argument<'a> {
    pub(crate) name: Option<Cow<'a, str>>,
    pub(crate) value: Value,
    pub(crate) place: Place,
}

/// A value with where it was written.
#[derive(Clone, Copy)]
pub(crate) struct Given {
    pub(crate) value: Value,
    pub(crate) place: Place,
}

/// A call of a native function.
pub(crate) struct Call<'m, 'a> {
    pub(crate) machine: &'m mut Machine<'a>,
    /// What the function is called in messages.
    pub(crate) name: &'static str,
    pub(crate) params: Vec<&'static str>,
    /// What was given for each parameter.
    pub(crate) given: Vec<Option<Given>>,
    /// What was given by place beyond the parameters.
    pub(crate) rest: Vec<Given>,
    /// What the method belongs to.
    pub(crate) receiver: Value,
    /// The whole call.
    pub(crate) place: Place,
}

impl<'m, 'a> Call<'m, 'a> {
    /// Sorts arguments to parameters.
    pub(crate) fn bind(
        machine: &'m mut Machine<'a>,
        name: &'static str,
        params: Vec<&'static str>,
        rest_allowed: bool,
        receiver: Value,
        arguments: Vec<Argument<'a>>,
        place: Place,
    ) -> Run<Call<'m, 'a>> {
        let mut given: Vec<Option<Given>> = vec![None; params.len()];
        let apart = |params: &[&str], arguments: &[Argument<'a>]| {
            let places = arguments.iter().filter(|a| a.name.is_none()).count();
            (places > params.len())
                .then(|| synonyms::of_numbers(name, arguments))
                .flatten()
        };
        let apart = apart(&params, &arguments);
        let (mut rest, mut next) = (Vec::new(), 0);
        for argument in arguments {
            let (value, at) = (argument.value, argument.place);
            let index = match &argument.name {
                None if next < params.len() => {
                    next += 1;
                    next - 1
                }
                None if rest_allowed => {
                    rest.push(Given { value, place: at });
                    continue;
                }
                None => {
                    let message = match params.as_slice() {
                        [] => format!("{name}() takes no argument"),
                        [one] => format!("{name}() takes one argument, `{one}`"),
                        many => format!("{name}() takes at most {} arguments", many.len()),
                    };
                    let help =
                        (params.len() > 1).then(|| format!("they are {}", params.join(", ")));
                    return Err(mistake(message).maybe_help(apart).maybe_help(help).at(at));
                }
                Some(written) => params.iter().position(|p| p == written).ok_or_else(|| {
                    let message = match params.as_slice() {
                        [] => format!("{name}() takes no argument"),
                        _ => format!("{name}() has no argument `{written}`"),
                    };
                    mistake(message)
                        .maybe_help(synonyms::of_argument(&params, written))
                        .maybe_help(suggestion(written, params.iter().copied()))
                        .at(at)
                })?,
            };
            if given[index].is_some() {
                return Err(mistake(format!("{name}() is given `{}` twice", params[index])).at(at));
            }
            given[index] = Some(Given { value, place: at });
        }
        Ok(Call {
            machine,
            name,
            params,
            given,
            rest,
            receiver,
            place,
        })
    }

    /// What was given for a parameter; `None` given counts as nothing.
    pub(crate) fn get(&self, param: &str) -> Option<Given> {
        let i = self.params.iter().position(|p| *p == param)?;
        self.given[i].filter(|g| !matches!(g.value, Value::None))
    }

    /// What was given for a parameter that must be given.
    pub(crate) fn need(&self, param: &str) -> Run<Given> {
        self.get(param).ok_or_else(|| {
            mistake(format!("{}() needs `{param}`", self.name))
                .help(format!("write {}({param} = ...)", self.name))
        })
    }

    /// How a parameter is called in messages.
    pub(crate) fn called(&self, param: &str) -> String {
        format!("`{param}` of {}()", self.name)
    }

    /// That a parameter is not what it must be.
    pub(crate) fn unfit(&self, param: &str, wanted: &str, given: Given) -> Box<Mistake> {
        let kind = self.machine.store.kind(given.value);
        mistake(format!(
            "{} must be {wanted}, not {kind}",
            self.called(param)
        ))
        .at(given.place)
    }

    /// A number.
    pub(crate) fn number(&self, param: &str, given: Given) -> Run<f64> {
        match given.value {
            Value::Int(i) => Ok(i as f64),
            Value::Float(x) if x.is_finite() => Ok(x),
            Value::Float(x) => Err(mistake(format!(
                "{} is {x}, which is no number",
                self.called(param)
            ))
            .at(given.place)),
            _ => Err(self.unfit(param, "a number", given)),
        }
    }

    /// A number in a range.
    pub(crate) fn ranged(&self, param: &str, given: Given, min: f64, max: f64) -> Run<f64> {
        let x = self.number(param, given)?;
        if min <= x && x <= max {
            return Ok(x);
        }
        let (min, max) = (spoken(min), spoken(max));
        let message = format!(
            "{} is {}, allowed is {min} to {max}",
            self.called(param),
            spoken(x)
        );
        Err(mistake(message).at(given.place))
    }

    /// A number in a range, or a default.
    pub(crate) fn number_or(&self, param: &str, default: f64, min: f64, max: f64) -> Run<f64> {
        self.get(param)
            .map_or(Ok(default), |g| self.ranged(param, g, min, max))
    }

    /// A whole number in a range, or a default.
    pub(crate) fn count_or(&self, param: &str, default: u32, min: u32, max: u32) -> Run<u32> {
        let Some(given) = self.get(param) else {
            return Ok(default);
        };
        let x = self.ranged(param, given, f64::from(min), f64::from(max))?;
        if x.fract() != 0.0 {
            let message = format!(
                "{} must be a whole number, not {}",
                self.called(param),
                spoken(x)
            );
            return Err(mistake(message).at(given.place));
        }
        Ok(x as u32)
    }

    /// A text.
    pub(crate) fn text(&self, param: &str, given: Given) -> Run<std::sync::Arc<str>> {
        match given.value {
            Value::Text(i) => Ok(self.machine.store.text(i).clone()),
            _ => Err(self.unfit(param, "a text", given)),
        }
    }

    /// A truth value, or a default.
    pub(crate) fn flag_or(&self, param: &str, default: bool) -> Run<bool> {
        match self.get(param) {
            None => Ok(default),
            Some(Given {
                value: Value::Bool(b),
                ..
            }) => Ok(b),
            Some(given) => Err(self.unfit(param, "True or False", given)),
        }
    }

    /// `N` numbers.
    pub(crate) fn numbers<const N: usize>(&self, param: &str, given: Given) -> Run<[f64; N]> {
        let items = self.machine.store.items(given.value).unwrap_or_default();
        if items.len() != N {
            let wanted = match N {
                2 => "2 numbers such as (1, 2)",
                3 => "3 numbers such as (1, 2, 3)",
                _ => "4 numbers such as (0, 0, 0, 1)",
            };
            return Err(match self.machine.store.items(given.value) {
                Some(items) => mistake(format!(
                    "{} must be {wanted}, not {}",
                    self.called(param),
                    items.len()
                ))
                .at(given.place),
                None => self.unfit(param, wanted, given),
            });
        }
        let mut out = [0.0; N];
        for (x, item) in out.iter_mut().zip(items) {
            *x = self.number(
                param,
                Given {
                    value: *item,
                    ..given
                },
            )?;
        }
        Ok(out)
    }

    /// One of several words, or a default.
    pub(crate) fn word_or<T: Copy>(&self, param: &str, default: T, words: &[(&str, T)]) -> Run<T> {
        let Some(given) = self.get(param) else {
            return Ok(default);
        };
        let text = self.text(param, given)?;
        words
            .iter()
            .find(|(word, _)| **word == *text)
            .map(|(_, x)| *x)
            .ok_or_else(|| {
                let names = words.iter().map(|(word, _)| *word);
                mistake(format!("{} cannot be \"{text}\"", self.called(param)))
                    .maybe_help(suggestion(&text, names))
                    .at(given.place)
            })
    }
}

/// A number as a person writes it.
pub(crate) fn spoken(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e7).contains(&x.abs()) {
        format!("{x:e}")
    } else {
        format!("{x}")
    }
}
