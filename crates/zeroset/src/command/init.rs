//! `zeroset init`.

use crate::args::InitArgs;
use crate::console::Console;
use crate::failure::Failure;
use std::io::Write;
use zeroset_output::atomic::{create_atomically, create_folder};

/// The first scene: everything a scene has, each with a word on what it does.
const STARTER: &str = include_str!("starter.star");

/// Makes a folder with a first scene.
pub(crate) fn run(args: &InitArgs, console: &Console) -> Result<(), Failure> {
    create_folder(&args.folder)?;
    let scene = args.folder.join("scene.star");
    create_atomically(&scene, |writer| writer.write_all(STARTER.as_bytes()))?;
    console.note(format_args!(
        "Made {}. Render it, and again on every save, with",
        scene.display()
    ));
    console.note(format_args!(
        "\n    zeroset render {} --watch\n",
        scene.display()
    ));
    Ok(())
}
