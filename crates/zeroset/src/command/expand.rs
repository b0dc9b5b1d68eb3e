//! `zeroset expand`.

use crate::args::ExpandArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_text;
use zeroset_language::json::{expand, to_text};
use zeroset_output::atomic::probe;
use zeroset_output::display;

/// Prints a scene as JSON.
pub(crate) fn run(args: &ExpandArgs, console: &Console) -> Result<(), Failure> {
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let options = crate::scene::options(&args.scene, None)?;
    let loaded = crate::scene::loaded(&args.scene, &options, console)?;
    let written = expand(&loaded.scene).map_err(|e| Failure::new(Exit::Scene, e.to_string()))?;
    let text = to_text(&written);
    let text = display::json(&text);
    match &args.output {
        None => console.emit(&text),
        Some(path) => write_text(path, &text),
    }
}
