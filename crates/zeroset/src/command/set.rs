//! `zeroset set`.

use crate::args::SetArgs;
use crate::cache::assets;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_text;
use zeroset_language::revision::revise_file;

/// Writes values into the scene's own file. What cannot be written is said, and the rest is written all the same.
pub(crate) fn run(args: &SetArgs, console: &Console) -> Result<(), Failure> {
    let mut scene = args.scene.clone();
    scene.set.extend(args.values.iter().cloned());
    if scene.set.is_empty() {
        return Err(Failure::with_help(
            Exit::Usage,
            "nothing is set",
            "name parameters with their values: zeroset set scene.star size=0.7 tint=tomato",
        ));
    }
    crate::scene::present(&scene)?;
    let options = crate::scene::options(&scene, None)?;
    let revised = revise_file(&scene.scene, &options, &[], &assets())?;
    if args.print {
        console.emit(&revised.revision.text)?;
    } else if revised.is_changed() {
        write_text(&scene.scene, &revised.revision.text)?;
        let names = revised.revision.written.join(", ");
        console.note(format_args!("{}: {names}", scene.scene.display()));
    } else if revised.revision.left.is_empty() {
        let path = scene.scene.display();
        console.note(format_args!("{path}: it says so already"));
    }
    let left: Vec<String> = (revised.revision.left.iter())
        .map(|left| format!("not written: {left}"))
        .collect();
    if left.is_empty() {
        return Ok(());
    }
    let help = "write the value as a literal in this file, such as slider(\"size\", 0.5)";
    Err(Failure::with_help(Exit::Job, left.join("\n"), help))
}
