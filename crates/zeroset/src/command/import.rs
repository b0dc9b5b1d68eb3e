//! `zeroset import`.

use crate::args::ImportArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::write_text;
use crate::scene::{Unreadable, readable};
use std::path::{Component, Path, PathBuf};
use zeroset_import::{ImportError, Kind, Request, import};
use zeroset_language::limits::Limits;
use zeroset_language::report::{Place, Report, Source};
use zeroset_output::atomic::probe;
use zeroset_output::display;

/// Makes a scene of a model of others.
pub(crate) fn run(args: &ImportArgs, console: &Console) -> Result<(), Failure> {
    let kind = kind(&args.file)?;
    if args.function.is_some() && kind != Kind::Glsl {
        return Err(Failure::new(
            Exit::Usage,
            "--function names a function of GLSL, and this is none",
        ));
    }
    if let Some(output) = &args.output {
        if output.extension().is_none_or(|ending| ending != "star") {
            return Err(Failure::with_help(
                Exit::Usage,
                format!("{} does not end in .star", output.display()),
                "what is written is a scene in Starlark",
            ));
        }
        probe(output)?;
    }
    let text = text_of(&args.file)?;
    let title = (args.file.file_name().unwrap_or_default()).to_string_lossy();
    let name = match kind {
        Kind::Registers => name_from(&args.file, args.output.as_deref())?,
        _ => title.clone().into_owned(),
    };
    let request = Request {
        name: &name,
        title: &title,
        function: args.function.as_deref(),
    };
    let scene = import(&text, kind, &request).map_err(|error| failure(error, &args.file, &text))?;
    for note in &scene.notes {
        console.note(display::text(note));
    }
    let text = display::clean(&scene.text);
    match &args.output {
        None => console.emit(&text),
        Some(path) => {
            write_text(path, &text)?;
            console.note(format_args!(
                "Made {}. Render it with zeroset render, look at it with zeroset check",
                path.display()
            ));
            Ok(())
        }
    }
}

fn kind(file: &Path) -> Result<Kind, Failure> {
    let ending = file
        .extension()
        .map(|e| e.to_string_lossy())
        .unwrap_or_default();
    Kind::of_ending(&ending).ok_or_else(|| {
        Failure::with_help(
            Exit::Usage,
            format!("what {} is cannot be told from its name", file.display()),
            "GLSL ends in .glsl or .frag, trees of Lipschitz pruning in .json, register lists in .vm",
        )
    })
}

/// A file's text, if it is no longer than a scene's files may be.
fn text_of(file: &Path) -> Result<String, Failure> {
    let shown = file.display();
    let cannot = |why: String| Failure::new(Exit::File, format!("cannot read {shown}: {why}"));
    readable(file).map_err(|why| match why {
        Unreadable::Special => cannot("it is not a regular file".into()),
        Unreadable::Missing(error) | Unreadable::System(error) => cannot(error.to_string()),
    })?;
    let most = Limits::default().file_bytes;
    let length = std::fs::metadata(file)
        .map_err(|e| cannot(e.to_string()))?
        .len();
    if length > most {
        return Err(cannot(format!(
            "it has {length} bytes, at most {most} are read"
        )));
    }
    let bytes = std::fs::read(file).map_err(|e| cannot(e.to_string()))?;
    String::from_utf8(bytes).map_err(|_| cannot("it is no text (UTF-8)".into()))
}

/// The name of a file as a scene asks for it: relative to the scene's folder.
fn name_from(file: &Path, scene: Option<&Path>) -> Result<String, Failure> {
    let folder = scene
        .and_then(Path::parent)
        .unwrap_or(Path::new(""))
        .to_owned();
    let whole = |path: &Path| -> Result<PathBuf, Failure> {
        let path = if path.as_os_str().is_empty() {
            Path::new(".")
        } else {
            path
        };
        path.canonicalize().map_err(|error| {
            Failure::new(
                Exit::File,
                format!("cannot find {}: {error}", path.display()),
            )
        })
    };
    let (file, folder) = (whole(file)?, whole(&folder)?);
    let relative = file.strip_prefix(&folder).ok();
    let parts = relative.map(|r| {
        r.components()
            .map(|c| match c {
                Component::Normal(name) => name.to_str(),
                _ => None,
            })
            .collect::<Option<Vec<_>>>()
    });
    match parts.flatten() {
        Some(parts) => Ok(parts.join("/")),
        None => Err(Failure::with_help(
            Exit::Usage,
            "a scene reads files of its own folder, and this one lies elsewhere",
            format!(
                "write the scene beside it: -o {}",
                file.with_extension("star").display()
            ),
        )),
    }
}

fn failure(error: ImportError, file: &Path, text: &str) -> Failure {
    let shown = file.to_string_lossy();
    let message = match &error {
        ImportError::Shader { place: Some(_), .. } => error.to_string(),
        _ => format!("{}: {error}", display::name(&shown, 200)),
    };
    let report = match error {
        ImportError::Shader { help, place, .. } => {
            let report = Report::new(message);
            let report = match help {
                Some(help) => report.with_help(help),
                None => report,
            };
            match place {
                Some(place) => {
                    let bytes = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
                    let place = Place {
                        file: 0,
                        start: bytes(place.start),
                        end: bytes(place.end),
                    };
                    report.at(&Source::new(shown, text), place)
                }
                None => report.in_file(shown),
            }
        }
        ImportError::LeftOut => {
            return Failure::with_help(
                Exit::Usage,
                "this zeroset was built without GLSL",
                "cargo build --release --features shaders",
            );
        }
        ImportError::Scene {
            help: Some(help), ..
        } => Report::new(message).in_file(shown).with_help(help),
        _ => Report::new(message).in_file(shown),
    };
    Failure {
        exit: Exit::Scene,
        report: Some(Box::new(report)),
    }
}
