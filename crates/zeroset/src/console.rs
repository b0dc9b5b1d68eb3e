//! What is said, and where: results on standard output, everything else on standard error.

use crate::failure::{Exit, Failure};
use crate::report::themed;
use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use miette::{Diagnostic, GraphicalTheme};
use std::ffi::OsString;
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::panic::PanicHookInfo;
use std::time::Duration;
use tracing::level_filters::LevelFilter;
use tracing_subscriber::filter::Targets;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use zeroset_output::display;

/// When to use colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Colour {
    /// On a terminal, unless NO_COLOR, CLICOLOR=0 or TERM=dumb says otherwise.
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
        self.wanted(io::stderr().is_terminal(), &|name| std::env::var_os(name))
    }

    /// Whether this means colours, by the conventions of no-color.org and bixense.com/clicolors.
    fn wanted(self, is_terminal: bool, variable: &dyn Fn(&str) -> Option<OsString>) -> bool {
        let is_set = |name| variable(name).is_some_and(|v| !v.is_empty());
        let is = |name, value: &str| variable(name).is_some_and(|v| v == value);
        match self {
            Colour::Always => true,
            Colour::Never => false,
            Colour::Auto if is_set("NO_COLOR") => false,
            Colour::Auto if is_set("CLICOLOR_FORCE") && !is("CLICOLOR_FORCE", "0") => true,
            Colour::Auto => is_terminal && !is("CLICOLOR", "0") && !is("TERM", "dumb"),
        }
    }
}

/// Whether the terminal only shows text, line after line.
pub(crate) fn is_dumb() -> bool {
    std::env::var_os("TERM").is_some_and(|t| t == "dumb")
}

/// Writes to standard error what a stranger may have chosen words of. Nobody can be told that nobody can be told.
pub(crate) fn say(text: &str) {
    let _ = writeln!(io::stderr(), "{}", display::text(text));
}

/// What is said when the program itself is wrong.
pub(crate) fn panicked(info: &PanicHookInfo<'_>) {
    say(&format!(
        "zeroset broke down; please report this with the scene as a bug.\n{info}"
    ));
    if std::env::var_os("RUST_BACKTRACE").is_some_and(|v| v != "0") {
        say(&std::backtrace::Backtrace::force_capture().to_string());
    }
}

/// Where the log goes: an event at a time.
struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        say(String::from_utf8_lossy(bytes).trim_end());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
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
            .with_writer(|| Log)
            .with_ansi(false)
            .with_target(false)
            .with_timer(tracing_subscriber::fmt::time::uptime())
            .finish()
            .with(
                // what libraries warn of helps nobody but who looks for a fault
                Targets::new()
                    .with_target("zeroset", level)
                    .with_default(match verbose {
                        0 => LevelFilter::ERROR,
                        _ => level,
                    }),
            )
            .init();
        Console { colour, quiet }
    }

    /// One that says only what went wrong, without a log.
    #[cfg(any(feature = "window", all(test, feature = "gpu")))]
    pub(crate) fn silent() -> Console {
        Console {
            colour: false,
            quiet: true,
        }
    }

    /// A note, unless `--quiet`.
    pub(crate) fn note(&self, text: impl fmt::Display) {
        if !self.quiet {
            say(&text.to_string());
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

    /// As [`Console::report`], of what has a report.
    pub(crate) fn failure(&self, failure: &Failure) {
        if let Some(report) = &failure.report {
            self.report(report.as_ref());
        }
    }

    /// A result for a person, on standard output.
    ///
    /// # Errors
    /// As [`Console::emit`].
    pub(crate) fn print(&self, text: &str) -> Result<(), Failure> {
        self.emit(&display::text(text))
    }

    /// A result that a program may read, on standard output: all of it. (JSON has no controls, see [`crate::json`].)
    ///
    /// # Errors
    /// Standard output cannot be written to. A reader that has read enough is no error, and ends the command.
    pub(crate) fn emit(&self, text: &str) -> Result<(), Failure> {
        let text = display::clean(text);
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
    pub(crate) fn bar(&self, label: &str) -> ProgressBar {
        let rate = |state: &ProgressState, w: &mut dyn fmt::Write| {
            let _ = write!(w, "{} rays/s", short(state.per_sec()));
        };
        let template = "{prefix} {bar:32} {percent:>3} %  {rate}  {eta} left";
        self.bar_of(label, template, |style| style.with_key("rate", rate))
    }

    /// A bar for a file that is written.
    pub(crate) fn writing_bar(&self, label: &str) -> ProgressBar {
        let template = "{prefix}: writing {bar:32} {percent:>3} %";
        self.bar_of(label, template, |style| style)
    }

    /// A bar for work that is counted in shares.
    pub(crate) fn working_bar(&self, label: &str) -> ProgressBar {
        let template = "{prefix} {bar:32} {percent:>3} %  {eta} left";
        self.bar_of(label, template, |style| style)
    }

    fn bar_of(
        &self,
        label: &str,
        template: &str,
        with_keys: impl FnOnce(ProgressStyle) -> ProgressStyle,
    ) -> ProgressBar {
        let target = if self.quiet || is_dumb() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let label = display::name(label, 30);
        let bar = ProgressBar::with_draw_target(None, target).with_prefix(label);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(with_keys(style).progress_chars("━╸─"));
        }
        bar.enable_steady_tick(Duration::from_millis(100));
        bar
    }
}

/// What went wrong as [`Console::report`] says it, without colours.
#[cfg(feature = "window")]
pub(crate) fn plain_report(report: &dyn Diagnostic) -> String {
    themed(GraphicalTheme::unicode_nocolor(), report)
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
    fn colours_follow_the_conventions() {
        let asked = |colour: Colour, is_terminal, variables: &[(&str, &str)]| {
            let find = |name: &str| variables.iter().find(|(n, _)| *n == name);
            colour.wanted(is_terminal, &|name| find(name).map(|(_, v)| v.into()))
        };
        let auto =
            |is_terminal, variables: &[(&str, &str)]| asked(Colour::Auto, is_terminal, variables);
        assert!(auto(true, &[("TERM", "xterm")]) && auto(true, &[]));
        assert!(!auto(false, &[("TERM", "xterm")]));
        for off in [("NO_COLOR", "1"), ("CLICOLOR", "0"), ("TERM", "dumb")] {
            assert!(!auto(true, &[off]), "{off:?}");
            assert!(asked(Colour::Always, false, &[off]), "{off:?}");
        }
        assert!(auto(true, &[("NO_COLOR", "")]) && auto(true, &[("CLICOLOR", "1")]));
        assert!(
            auto(false, &[("CLICOLOR_FORCE", "1")]) && !auto(false, &[("CLICOLOR_FORCE", "0")])
        );
        assert!(!auto(false, &[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]));
        assert!(!asked(Colour::Never, true, &[("CLICOLOR_FORCE", "1")]));
    }

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
