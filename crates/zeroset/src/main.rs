//! The command line of Zeroset.

mod args;
mod backend;
mod bench;
mod cache;
mod command;
mod console;
mod estimate;
mod failure;
mod file;
mod fit;
mod interrupt;
mod json;
mod paint;
mod reference;
mod render;
mod report;
mod scene;
mod shares;
mod simplex;
mod survey;
mod values;

use args::{Command, CommandLine};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ColorChoice, CommandFactory, FromArgMatches};
use console::{Colour, Console, say};
use failure::{Exit, Failure};
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;
use zeroset_output::display;

fn main() -> ExitCode {
    std::panic::set_hook(Box::new(console::panicked));
    let arguments: Vec<OsString> = std::env::args_os().collect();
    let choice = match asked_colour(&arguments) {
        Colour::Auto if console::is_dumb() => ColorChoice::Never,
        Colour::Auto => ColorChoice::Auto,
        Colour::Always => ColorChoice::Always,
        Colour::Never => ColorChoice::Never,
    };
    let parse = |arguments: &[OsString]| {
        let command = CommandLine::command().color(choice);
        command.try_get_matches_from(arguments)
    };
    let mut parsed = parse(&arguments);
    if cfg!(feature = "window")
        && let Some(place) = parsed.as_ref().err().and_then(scene_as_command)
        && let Some(place) = arguments.iter().position(|a| *a == *place)
    {
        let mut view = arguments.clone();
        view.insert(place, "view".into());
        parsed = parse(&view);
    }
    let line = match parsed.and_then(|matches| CommandLine::from_arg_matches(&matches)) {
        Ok(line) => line,
        Err(error) => {
            // help and version go to standard output and are no error
            if error.use_stderr() && arguments.iter().any(|a| is_odd(&a.to_string_lossy())) {
                say(error.render().to_string().trim_end());
            } else {
                let _ = error.print();
            }
            if let Some(scene) = scene_as_command(&error) {
                say(&format!("\nTo render it: zeroset render {scene}"));
            }
            if let Some(feature) = left_out(&error) {
                say(&format!(
                    "\nThis zeroset was built without the {feature}: cargo build --release --features {feature}"
                ));
            }
            return ExitCode::from(if error.use_stderr() {
                Exit::Usage
            } else {
                Exit::Done
            } as u8);
        }
    };
    let console = Console::new(line.global.color, line.global.quiet, line.global.verbose);
    interrupt::listen();
    let exit = match run(&line.command, &console) {
        Ok(()) => Exit::Done,
        Err(failure) => {
            console.failure(&failure);
            failure.exit
        }
    };
    ExitCode::from(exit as u8)
}

fn run(command: &Command, console: &Console) -> Result<(), Failure> {
    match command {
        #[cfg(feature = "window")]
        Command::View(args) => command::view::run(args),
        Command::Render(args) => render::run(args, console),
        Command::Check(args) => command::check::run(args, console),
        Command::Certify(args) => command::certify::run(args, console),
        Command::Set(args) => command::set::run(args, console),
        Command::Expand(args) => command::expand::run(args, console),
        #[cfg(feature = "shaders")]
        Command::Export(args) => command::export::run(args, console),
        Command::Import(args) => command::import::run(args, console),
        Command::Slice(args) => command::slice::run(args, console),
        Command::Why(args) => command::why::run(args, console),
        Command::Fields(args) => command::fields::run(args, console),
        Command::FitAo(args) => command::fit_ao::run(args, console),
        Command::Bake(args) => command::bake::run(args, console),
        Command::Mesh(args) => command::mesh::run(args, console),
        Command::Edt(args) => command::bake::edt(args, console),
        Command::Compare(args) => command::compare::run(args, console),
        Command::Bench(args) => bench::run(args, console),
        #[cfg(feature = "gpu")]
        Command::Gpu(args) => command::gpu::run(args, console),
        Command::Init(args) => command::init::run(args, console),
        Command::Completions(args) => command::completions::completions(args, console),
        Command::Man(args) => command::completions::man(args, console),
    }
}

/// Whether an argument is nothing to repeat as it is: the name of a file may come from anybody.
fn is_odd(argument: &str) -> bool {
    argument.len() > display::LINE
        || argument.contains(|c: char| display::is_control(c) || c == '\n')
}

/// The scene that was named where a command belongs.
fn scene_as_command(error: &clap::Error) -> Option<&str> {
    let given = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(given)) if error.kind() == ErrorKind::InvalidSubcommand => given,
        _ => return None,
    };
    let ending = Path::new(given).extension()?;
    (ending == "star" || ending == "json").then_some(given)
}

/// The feature that a command is in which this build leaves out; a scene without a command wants a window.
fn left_out(error: &clap::Error) -> Option<&'static str> {
    let given = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(given)) => given.as_str(),
        _ => return None,
    };
    let window = given == "view" || scene_as_command(error).is_some();
    let shaders = given == "export";
    [
        ("window", window),
        ("gpu", given == "gpu"),
        ("shaders", shaders),
    ]
    .into_iter()
    .find_map(|(feature, wanted)| wanted.then_some(feature))
}

/// `--color`, before the command line is read: its own messages want to know.
fn asked_colour(arguments: &[OsString]) -> Colour {
    let texts: Vec<&str> = arguments.iter().filter_map(|a| a.to_str()).collect();
    let after = |i: usize| texts.get(i + 1).copied();
    let asked =
        texts
            .iter()
            .enumerate()
            .find_map(|(i, text)| match text.strip_prefix("--color=") {
                Some(when) => Some(when),
                None if *text == "--color" => after(i),
                None => None,
            });
    match asked {
        Some("always") => Colour::Always,
        Some("never") => Colour::Never,
        _ => Colour::Auto,
    }
}
