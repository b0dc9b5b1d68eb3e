//! `zeroset completions` and `zeroset man`.

use crate::args::{CommandLine, CompletionsArgs, ManArgs};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use clap::CommandFactory;

/// Prints completions for a shell.
pub(crate) fn completions(args: &CompletionsArgs, console: &Console) -> Result<(), Failure> {
    let mut out = Vec::new();
    clap_complete::generate(args.shell, &mut CommandLine::command(), "zeroset", &mut out);
    console.emit(&String::from_utf8_lossy(&out))
}

/// Prints a manual page.
pub(crate) fn man(args: &ManArgs, console: &Console) -> Result<(), Failure> {
    let mut command = CommandLine::command();
    command.build();
    if let Some(name) = &args.command {
        let Some(found) = command.find_subcommand(name) else {
            let names: Vec<_> = command
                .get_subcommands()
                .map(clap::Command::get_name)
                .collect();
            let help = format!("the commands are {}", names.join(", "));
            return Err(Failure::with_help(
                Exit::Usage,
                format!("there is no command `{name}`"),
                help,
            ));
        };
        command = found.clone();
    }
    let mut out = Vec::new();
    clap_mangen::Man::new(command)
        .render(&mut out)
        .map_err(|error| {
            Failure::new(Exit::Job, format!("cannot make the manual page: {error}"))
        })?;
    console.emit(&String::from_utf8_lossy(&out))
}
