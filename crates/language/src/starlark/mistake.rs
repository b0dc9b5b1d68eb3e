//! What goes wrong in a script.

use crate::report::{Place, Report, Source};

/// A mistake in a scene file, on its way out of the interpreter.
#[derive(Debug)]
pub(crate) struct Mistake {
    message: String,
    help: Option<String>,
    place: Option<Place>,
    /// Calls that led here, innermost first.
    trace: Vec<Place>,
}

/// The result of a step of the interpreter; boxed because the good case is common and small.
pub(crate) type Run<T> = Result<T, Box<Mistake>>;

/// How many calls a message names.
const TRACE: usize = 4;

/// A mistake without a place yet.
pub(crate) fn mistake(message: impl Into<String>) -> Box<Mistake> {
    Box::new(Mistake {
        message: message.into(),
        help: None,
        place: None,
        trace: Vec::new(),
    })
}

impl Mistake {
    /// With what to do.
    pub(crate) fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }

    /// With what to do, if anything is known.
    pub(crate) fn maybe_help(mut self: Box<Self>, help: Option<String>) -> Box<Self> {
        self.help = self.help.or(help);
        self
    }

    /// At a place, unless a nearer one is known.
    pub(crate) fn at(mut self: Box<Self>, place: Place) -> Box<Self> {
        self.place.get_or_insert(place);
        self
    }

    /// In a call made at a place.
    pub(crate) fn called_from(mut self: Box<Self>, place: Place) -> Box<Self> {
        if self.trace.len() < TRACE {
            self.trace.push(place);
        }
        self
    }

    /// For a person.
    pub(crate) fn report(self, sources: &[Source]) -> Report {
        let source = |place: Place| sources.get(place.file as usize);
        let mut report = Report::new(self.message);
        if let Some(help) = self.help {
            report = report.with_help(help);
        }
        if let Some((place, source)) = self.place.and_then(|p| Some((p, source(p)?))) {
            report = report.at(source, place);
        }
        for place in self.trace {
            if let Some(source) = source(place) {
                report = report.called_from(source, place);
            }
        }
        report
    }
}
