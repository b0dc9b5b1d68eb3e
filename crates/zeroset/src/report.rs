//! Reports of what went wrong, fit to be shown: what they repeat of a stranger's file does nothing to a terminal.

use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError,
    MietteSpanContents, Severity, SourceCode, SourceSpan, SpanContents,
};
use std::fmt;
use zeroset_output::display;

/// Lines of the source around a place.
const AROUND: usize = 1;

/// A report in words, without colours unless the theme has them.
pub(crate) fn themed(theme: GraphicalTheme, report: &dyn Diagnostic) -> String {
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(100)
        .with_links(false);
    let (mut text, shown) = (String::new(), Shown::of(report));
    if handler.render_report(&mut text, &shown).is_err() {
        text.clone_from(&shown.message);
    }
    text.trim_end().to_owned()
}

/// A copy of a report whose texts are clean and of limited length.
#[derive(Debug)]
struct Shown {
    message: String,
    help: Option<String>,
    severity: Option<Severity>,
    labels: Vec<LabeledSpan>,
    source: Option<Excerpt>,
}

impl Shown {
    fn of(report: &dyn Diagnostic) -> Shown {
        let text = |from: String| display::text(&from).into_owned();
        let labels: Vec<LabeledSpan> = report.labels().map(Iterator::collect).unwrap_or_default();
        let source = report.source_code().zip(labels.first());
        let source = source.and_then(|(code, label)| Excerpt::of(code, label.inner()));
        let shown = |label: &LabeledSpan| {
            let said = label.label().map(|said| display::name(said, display::LINE));
            LabeledSpan::new(said, label.offset(), label.len())
        };
        Shown {
            message: text(report.to_string()),
            help: report.help().map(|help| text(help.to_string())),
            severity: report.severity(),
            labels: labels.iter().map(shown).collect(),
            source,
        }
    }
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Shown {}

impl Diagnostic for Shown {
    fn severity(&self) -> Option<Severity> {
        self.severity
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let help = self.help.as_ref()?;
        Some(Box::new(help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source.as_ref().map(|s| s as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        (!self.labels.is_empty())
            .then(|| Box::new(self.labels.iter().cloned()) as Box<dyn Iterator<Item = _>>)
    }
}

/// A few lines of a source. Controls are blotted out, so that places are what they were.
#[derive(Debug)]
struct Excerpt {
    name: Option<String>,
    text: String,
    /// Where it begins in the source: byte, line, column.
    offset: usize,
    line: usize,
    column: usize,
}

impl Excerpt {
    fn of(code: &dyn SourceCode, place: &SourceSpan) -> Option<Excerpt> {
        let found = code.read_span(place, AROUND, AROUND).ok()?;
        // the source is text; if it were not, places would move
        let text = std::str::from_utf8(found.data()).ok()?;
        Some(Excerpt {
            name: found.name().map(|name| display::name(name, 200)),
            text: display::blot(text).into_owned(),
            offset: found.span().offset(),
            line: found.line(),
            column: found.column(),
        })
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let at = span
            .offset()
            .checked_sub(self.offset)
            .ok_or(MietteError::OutOfBounds)?;
        let found = self
            .text
            .read_span(&(at, span.len()).into(), before, after)?;
        let shown: SourceSpan = (found.span().offset() + self.offset, found.span().len()).into();
        // what the excerpt lacks of its first line
        let column = if found.line() == 0 { self.column } else { 0 };
        let (line, column, count) = (
            found.line() + self.line,
            found.column() + column,
            found.line_count(),
        );
        let data = found.data();
        Ok(Box::new(match &self.name {
            Some(name) => {
                MietteSpanContents::new_named(name.clone(), data, shown, line, column, count)
            }
            None => MietteSpanContents::new(data, shown, line, column, count),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use miette::MietteDiagnostic;
    use zeroset_language::load::{Language, Options, load_text};

    fn report(scene: &str) -> String {
        let options = Options::default();
        let loaded = load_text("scene.star", scene, Language::Starlark, None, &options);
        let Err(failed) = loaded else {
            return String::new();
        };
        for theme in [GraphicalTheme::unicode(), GraphicalTheme::unicode_nocolor()] {
            let said = themed(theme, failed.report.as_ref());
            // colours are the only sequences there are
            let said = said.replace("\u{1b}[", "").replace('\t', "");
            assert!(!said.contains(display::is_control), "{said:?}");
            assert!(
                said.chars().count() < 10_000,
                "{} characters",
                said.chars().count()
            );
        }
        themed(GraphicalTheme::unicode_nocolor(), failed.report.as_ref())
    }

    #[test]
    fn a_place_is_shown_as_it_was() {
        let said = report("a = 1\nshow(spere(1))\nb = 2\n");
        let lines: Vec<&str> = said.lines().collect();
        let at = lines
            .iter()
            .position(|l| l.contains("show(spere(1))"))
            .unwrap();
        assert!(said.contains("scene.star:2:6"), "{said}");
        let column = |text: &str, what: char| text.chars().position(|c| c == what);
        assert_eq!(
            column(lines[at], 'p').map(|c| c - 1),
            column(lines[at + 1], '─'),
            "{said}"
        );
    }

    #[test]
    fn controls_in_a_source_are_blotted_out_and_places_stay() {
        for control in [
            "\u{1b}]0;x\u{7}",
            "\u{9b}31m",
            "\u{202e}",
            "\u{7f}\u{0}",
            "\u{e0041}",
            "\r",
        ] {
            let said = report(&format!("text = \"{control}\"; show(spere(1))\n"));
            assert!(said.contains("spere"), "{said}");
            report(&format!("fail(\"{control} failed\")\n"));
            report(&format!("{control}\n"));
            report(&format!("x = {{}}\nx[\"{control}\"]\n"));
            report(&format!("show(sphere(color = \"{control}\"))\n"));
            report(&format!("sphere().paint(material(\"{control}\"))\n"));
        }
    }

    #[test]
    fn long_texts_are_cut() {
        report(&format!("fail(\"{}\")\n", "x".repeat(1_000_000)));
        report(&format!("fail(\"{}\")\n", "x\\n".repeat(100_000)));
        report(&format!("{}\n", "x".repeat(100_000)));
        report(&format!("x = \"{}\" + 1\n", "y".repeat(1_000_000)));
        report(&format!("show({})\n", "x".repeat(100_000)));
        let long = MietteDiagnostic::new("m".repeat(100_000)).with_help("h".repeat(100_000));
        assert!(themed(GraphicalTheme::unicode_nocolor(), &long).len() < 10_000);
    }
}
