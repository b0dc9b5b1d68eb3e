//! What is said, and where: results on standard output, everything else on standard error.

use crate::failure::{Exit, Failure};
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::time::Duration;
use tracing::level_filters::LevelFilter;

/// When to use colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Colour {
    /// On a terminal, unless NO_COLOR is set.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

impl Colour {
    /// Whether this means colours on standard error.
    pub(crate) fn on_stderr(self) -> bool {
        match self {
            Colour::Always => true,
            Colour::Never => false,
            Colour::Auto => {
                io::stderr().is_terminal()
                    && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
            }
        }
    }
}

/// Standard error and standard output, as the flags want them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Console {
    colour: bool,
    quiet: bool,
}

impl Console {
    /// Also starts the log of `--verbose`.
    pub(crate) fn new(colour: Colour, quiet: bool, verbose: u8) -> Console {
        let colour = colour.on_stderr();
        let level = match (quiet, verbose) {
            (true, _) => LevelFilter::ERROR,
            (_, 0) => LevelFilter::WARN,
            (_, 1) => LevelFilter::DEBUG,
            _ => LevelFilter::TRACE,
        };
        tracing_subscriber::fmt()
            .with_max_level(level)
            .with_writer(io::stderr)
            .with_ansi(colour)
            .with_target(false)
            .with_timer(tracing_subscriber::fmt::time::uptime())
            .init();
        Console { colour, quiet }
    }

    /// One that says only what went wrong, without a log.
    #[cfg(all(test, feature = "gpu"))]
    pub(crate) fn silent() -> Console {
        Console {
            colour: false,
            quiet: true,
        }
    }

    /// A note, unless `--quiet`.
    pub(crate) fn note(&self, text: impl fmt::Display) {
        if !self.quiet {
            // nobody can be told that nobody can be told
            let _ = writeln!(io::stderr(), "{text}");
        }
    }

    /// What went wrong, with its place in the scene.
    pub(crate) fn report(&self, report: &dyn Diagnostic) {
        let theme = if self.colour {
            GraphicalTheme::unicode()
        } else {
            GraphicalTheme::unicode_nocolor()
        };
        let _ = writeln!(io::stderr(), "{}", themed(theme, report));
    }

    /// What is not as it was meant, with its place in the scene, unless `--quiet`.
    pub(crate) fn warn(&self, report: &dyn Diagnostic) {
        if !self.quiet {
            self.report(report);
        }
    }

    /// A result, on standard output.
    ///
    /// # Errors
    /// Standard output cannot be written to. A reader that has read enough is no error, and ends the command.
    pub(crate) fn print(&self, text: &str) -> Result<(), Failure> {
        let mut out = io::stdout().lock();
        let ended = if text.ends_with('\n') { "" } else { "\n" };
        out.write_all(text.as_bytes())
            .and_then(|()| out.write_all(ended.as_bytes()))
            .and_then(|()| out.flush())
            .map_err(|error| match error.kind() {
                io::ErrorKind::BrokenPipe => Failure::silent(Exit::Done),
                _ => Failure::new(
                    Exit::File,
                    format!("cannot write to standard output: {error}"),
                ),
            })
    }

    /// A bar for many rays, seen on a terminal only and gone when it is done.
    pub(crate) fn bar(&self, label: String) -> ProgressBar {
        let target = if self.quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(None, target).with_prefix(label);
        let template = "{prefix} {bar:32} {percent:>3} %  {rate}  {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let rate = |state: &ProgressState, w: &mut dyn fmt::Write| {
                let _ = write!(w, "{} rays/s", short(state.per_sec()));
            };
            bar.set_style(style.progress_chars("━╸─").with_key("rate", rate));
        }
        bar.enable_steady_tick(Duration::from_millis(100));
        bar
    }
}

/// What went wrong as [`Console::report`] says it, without colours.
#[cfg(feature = "viewer")]
pub(crate) fn plain_report(report: &dyn Diagnostic) -> String {
    themed(GraphicalTheme::unicode_nocolor(), report)
}

fn themed(theme: GraphicalTheme, report: &dyn Diagnostic) -> String {
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(100)
        .with_links(false);
    let mut text = String::new();
    if handler.render_report(&mut text, report).is_err() {
        text = report.to_string();
    }
    text.trim_end().to_owned()
}

/// A count in three digits: 950, 12.3k, 4.56M.
pub(crate) fn short(count: f64) -> String {
    let (scaled, unit) = match count {
        c if c >= 1e9 => (c / 1e9, "G"),
        c if c >= 1e6 => (c / 1e6, "M"),
        c if c >= 1e3 => (c / 1e3, "k"),
        c => return format!("{c:.0}"),
    };
    let decimals = if scaled >= 100.0 {
        0
    } else {
        2 - usize::from(scaled >= 10.0)
    };
    format!("{scaled:.decimals$}{unit}")
}

/// A count with its thousands apart: 1 048 576.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_short() {
        for (count, text) in [
            (0.0, "0"),
            (950.4, "950"),
            (12_345.0, "12.3k"),
            (4.56e6, "4.56M"),
            (2.5e11, "250G"),
        ] {
            assert_eq!(short(count), text);
        }
        for (count, text) in [
            (0, "0"),
            (999, "999"),
            (1000, "1 000"),
            (1_048_576, "1 048 576"),
        ] {
            assert_eq!(grouped(count), text);
        }
    }
}
