//! `zeroset export`.

use crate::args::ExportArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_text;
use zeroset_language::report::Report;
use zeroset_output::atomic::probe;
use zeroset_output::display;
use zeroset_shader::export::{ExportError, glsl, wgsl};

/// Prints a scene as one file of shader text.
pub(crate) fn run(args: &ExportArgs, console: &Console) -> Result<(), Failure> {
    if let Some(path) = &args.output {
        probe(path)?;
    }
    let options = crate::scene::options(&args.scene, args.size.map(|s| s.0))?;
    let loaded = crate::scene::loaded(&args.scene, &options, console)?;
    let scene = loaded.scene;
    if loaded.animated {
        let what = if args.language.glsl { "GLSL" } else { "WGSL" };
        let text = format!(
            "the scene asks for time(), and the {what} holds it as it is at {} seconds: the shader does not move",
            options.time
        );
        let warning = Report::new(text).with_help("choose the moment with --time");
        console.warn(&warning.as_warning());
    }
    let text = if args.language.glsl {
        glsl(&scene)?
    } else {
        wgsl(&scene)?
    };
    // comments repeat names of the scene
    let text = display::clean(&text);
    match &args.output {
        None => console.emit(&text),
        Some(path) => write_text(path, &text),
    }
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Scene(error) => error.into(),
            ExportError::Large { .. } => Failure::with_help(
                Exit::Scene,
                error.to_string(),
                "export a part of the scene, or render it with `zeroset render`, which has no such limit",
            ),
            ExportError::Translation(_) => Failure::new(Exit::Job, error.to_string()),
        }
    }
}
