//! What a person is told when a scene cannot be loaded: where, what, and what to do.

use crate::lines::Lines;
use crate::naming::{floor_char, shortened};
use miette::{
    Diagnostic, LabeledSpan, MietteError, MietteSpanContents, Severity, SourceCode, SourceSpan,
    SpanContents,
};
use std::fmt;
use std::sync::Arc;

/// A file's text, as far as messages need it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// Its name as it is shown: relative to the scene's folder.
    pub name: String,
    /// Its text.
    pub text: Arc<str>,
    lines: Arc<Lines>,
}

impl Source {
    /// A file's text under a name.
    pub fn new(name: impl Into<String>, text: &str) -> Source {
        Source {
            name: name.into(),
            text: Arc::from(text),
            lines: Arc::new(Lines::of(text)),
        }
    }

    /// Line and column of a byte, 1-based; the column counts characters.
    pub fn position(&self, at: usize) -> (usize, usize) {
        self.lines.position(&self.text, floor_char(&self.text, at))
    }
}

/// A piece of a file's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Which file: the number of its [`Source`].
    pub file: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// Why a scene cannot be loaded. Printed by any `miette` handler, or as one line by [`fmt::Display`].
#[derive(Clone, Debug)]
pub struct Report {
    severity: Severity,
    bug: bool,
    message: String,
    help: Option<String>,
    source: Option<Source>,
    name: String,
    label: Option<LabeledSpan>,
    /// Line and column of the place, 1-based; the column counts characters.
    position: Option<(usize, usize)>,
    /// Where the place was called from, innermost first.
    trace: Vec<String>,
}

impl Report {
    /// A report without a place.
    pub fn new(message: impl Into<String>) -> Report {
        Report {
            severity: Severity::Error,
            bug: false,
            message: shortened(&message.into(), MESSAGE),
            help: None,
            source: None,
            name: String::new(),
            label: None,
            position: None,
            trace: Vec::new(),
        }
    }

    /// A report of what no scene may cause: the loader itself broke down.
    pub(crate) fn of_a_bug() -> Report {
        Report {
            bug: true,
            ..Report::new("the scene loader broke down; please report this scene as a bug")
        }
    }

    /// Whether the loader itself broke down, whatever the scene is. A message cannot tell: it may quote the scene.
    pub fn is_bug(&self) -> bool {
        self.bug
    }

    /// With a hint what to do.
    pub fn with_help(mut self, help: impl Into<String>) -> Report {
        self.help = Some(shortened(&help.into(), MESSAGE));
        self
    }

    /// As a warning: the scene was loaded, but something in it is not as it was meant.
    pub fn as_warning(mut self) -> Report {
        self.severity = Severity::Warning;
        self
    }

    /// With the name of the file alone.
    pub fn in_file(mut self, name: impl Into<String>) -> Report {
        self.name = name.into();
        self
    }

    /// With a place in a file.
    pub fn at(mut self, source: &Source, place: Place) -> Report {
        let length = source.text.len();
        let start = floor_char(&source.text, (place.start as usize).min(length));
        let end = (place.end as usize).clamp(start, length).min(start + LINE);
        let end = floor_char(&source.text, end);
        self.position = Some(source.position(start));
        self.label = Some(LabeledSpan::new(None, start, end - start));
        self.source = Some(without_tabs(source));
        self.name.clone_from(&source.name);
        self
    }

    /// With where the place was called from.
    pub(crate) fn called_from(mut self, source: &Source, place: Place) -> Report {
        let (line, column) = source.position(place.start as usize);
        self.trace.push(format!("{}:{line}:{column}", source.name));
        self
    }

    /// What is wrong.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What to do.
    pub fn hint(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// Name of the file, if there is one.
    pub fn file(&self) -> Option<&str> {
        (!self.name.is_empty()).then_some(self.name.as_str())
    }

    /// Line and column, 1-based; the column counts characters.
    pub fn position(&self) -> Option<(usize, usize)> {
        self.position
    }
}

/// Characters of a message or a hint: they may quote what a stranger wrote.
const MESSAGE: usize = 1000;

/// Bytes of a line beyond which only the part around a place is shown.
const LINE: usize = 160;

impl SourceCode for Source {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let all = self.text.read_span(span, before, after)?;
        let lines = all.data().split(|b| *b == b'\n');
        let (line, column, count) = (all.line(), all.column(), all.line_count());
        let (mut data, mut shown) = (all.data(), *all.span());
        if lines.map(<[u8]>::len).any(|length| length > 2 * LINE) {
            let around = |at: usize| floor_char(&self.text, at.min(self.text.len()));
            let line_start = self.text[..around(span.offset())]
                .rfind('\n')
                .map_or(0, |i| i + 1);
            let start = around(span.offset().saturating_sub(LINE / 2)).max(line_start);
            let rest = &self.text[start..];
            let line_end = start + rest.find('\n').unwrap_or(rest.len());
            let end = around((span.offset() + span.len() + LINE / 2).min(line_end)).max(start);
            (data, shown) = (
                &self.text.as_bytes()[start..end],
                (start, end - start).into(),
            );
            let (line, column) = self.position(start);
            let name = self.name.clone();
            return Ok(Box::new(MietteSpanContents::new_named(
                name,
                data,
                shown,
                line - 1,
                column - 1,
                1,
            )));
        }
        // characters, as in `Report::position`: what is read here counts bytes
        let column = match column {
            0 => 0,
            _ => self.position(floor_char(&self.text, shown.offset())).1 - 1,
        };
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            data,
            shown,
            line,
            column,
            count,
        )))
    }
}

/// The text as it is shown: a tab takes one place like any other character, so that marks stand below what they mark.
fn without_tabs(source: &Source) -> Source {
    if source.text.contains('\t') {
        Source::new(&source.name, &source.text.replace('\t', " "))
    } else {
        source.clone()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Report {}

impl Diagnostic for Report {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let mut text = self.help.clone().unwrap_or_default();
        for place in &self.trace {
            let line = if text.is_empty() { "" } else { "\n" };
            text += &format!("{line}called from {place}");
        }
        (!text.is_empty()).then(|| Box::new(text) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|s| s as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.label
            .clone()
            .map(|l| Box::new(std::iter::once(l)) as Box<dyn Iterator<Item = LabeledSpan>>)
    }
}

/// Characters of the longest name that is compared with others: comparing takes as many steps as one is long times the other.
const COMPARED: usize = 40;
/// Names that are compared at most: a stranger's file may hold any number of them.
const CANDIDATES: usize = 4096;

/// The name among `names` that `given` was most likely meant to be. Takes a limited time, whatever the names.
pub fn nearest<'a>(given: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let is_short = |name: &str| name.len() <= 4 * COMPARED && name.chars().count() <= COMPARED;
    if !is_short(given) {
        return None;
    }
    let plain = |s: &str| s.replace('_', "").to_lowercase();
    let (lower, bare) = (given.to_lowercase(), plain(given));
    let candidates = names
        .into_iter()
        .take(CANDIDATES)
        .filter(|name| is_short(name));
    let scored = candidates.map(|name| {
        let distance = if plain(name) == bare {
            0
        } else {
            strsim::osa_distance(&lower, &name.to_lowercase())
        };
        (distance, name)
    });
    let (distance, name) = scored.min()?;
    let allowed = (given.chars().count().max(name.chars().count()) / 3).clamp(1, 3);
    (distance <= allowed).then_some(name)
}

/// "did you mean ...?" for an unknown name, or the list of all there are where nothing is near and the list is short.
pub(crate) fn suggestion<'a>(
    given: &str,
    names: impl IntoIterator<Item = &'a str> + Clone,
) -> Option<String> {
    if let Some(name) = nearest(given, names.clone()) {
        return Some(format!("did you mean `{name}`?"));
    }
    // one more than are listed says that there are too many
    let all: Vec<&str> = names.into_iter().take(17).collect();
    match all.as_slice() {
        all if all.iter().any(|name| name.len() > 4 * COMPARED) => None,
        [] => None,
        [one] => Some(format!("there is only `{one}`")),
        _ if all.len() <= 16 => Some(format!("there are {}", listing(&all))),
        _ => None,
    }
}

/// `a`, `b` and `c`.
pub(crate) fn listing(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|n| format!("`{n}`")).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}
