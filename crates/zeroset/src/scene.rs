//! From the command line's words about a scene to the scene.

use crate::args::SceneArgs;
use crate::cache::assets;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read};
use std::path::Path;
use zeroset_language::document::Document;
use zeroset_language::limits::Limits;
use zeroset_language::load::{Failed, Loaded, Options};
use zeroset_output::display::LINES;

/// What the flags say about loading.
pub(crate) fn options(args: &SceneArgs, size: Option<[u32; 2]>) -> Result<Options, Failure> {
    let mut limits = Limits::default();
    for (name, value) in &args.limit {
        limits
            .set(name, value)
            .map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
    }
    if let Some([width, height]) = size {
        check_size([width, height], &limits)?;
    }
    let mut set = BTreeMap::new();
    for (name, value) in &args.set {
        if set.insert(name.clone(), value.clone()).is_some() {
            return Err(Failure::new(Exit::Usage, format!("`{name}` is set twice")));
        }
    }
    Ok(Options {
        set,
        time: args.time.unwrap_or(0.0),
        size,
        limits,
        moments: false,
        bare: false,
        floorless: false,
    })
}

/// Refuses a size that the limits forbid, before anything of that size is made.
pub(crate) fn check_size([width, height]: [u32; 2], limits: &Limits) -> Result<(), Failure> {
    if u64::from(width) * u64::from(height) <= limits.pixels {
        return Ok(());
    }
    let message = format!(
        "a picture of {width}x{height} has more than {} pixels",
        limits.pixels
    );
    Err(Failure::with_help(
        Exit::Usage,
        message,
        "ask for a smaller one, or raise the limit: --limit pixels=...",
    ))
}

/// Why a file cannot be read.
pub(crate) enum Unreadable {
    /// There is none.
    Missing(io::Error),
    /// It is a folder, a device, a pipe.
    Special,
    /// What the system says.
    System(io::Error),
}

/// Whether there is a file that can be read. A pipe or a device is never opened, as that could wait for ever.
pub(crate) fn readable(path: &Path) -> Result<(), Unreadable> {
    let sorted = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => Unreadable::Missing(error),
        _ => Unreadable::System(error),
    };
    if !fs::metadata(path).map_err(sorted)?.is_file() {
        return Err(Unreadable::Special);
    }
    let read = |mut file: fs::File| file.read(&mut [0; 1]);
    fs::File::open(path)
        .and_then(read)
        .map(drop)
        .map_err(sorted)
}

/// Whether the scene's file can be read: where it cannot, nothing is wrong with the scene.
pub(crate) fn present(args: &SceneArgs) -> Result<(), Failure> {
    let path = args.scene.display();
    readable(&args.scene).map_err(|why| match why {
        Unreadable::Special => Failure::with_help(
            Exit::File,
            format!("cannot read {path}: it is not a regular file"),
            "name a scene, for example scene.star",
        ),
        Unreadable::Missing(error) | Unreadable::System(error) => {
            Failure::new(Exit::File, format!("cannot read {path}: {error}"))
        }
    })
}

/// Loads the scene and says what it prints.
pub(crate) fn loaded(
    args: &SceneArgs,
    options: &Options,
    console: &Console,
) -> Result<Loaded, Failure> {
    present(args)?;
    Ok(attempt(args, options, console)?)
}

/// Reads the scene, to load it more than once.
pub(crate) fn document(args: &SceneArgs, options: &Options) -> Result<Document, Failure> {
    present(args)?;
    let document = Document::open(&args.scene, &options.limits, &assets());
    Ok(document?)
}

/// As [`loaded`]; a failure names the files that it came from.
pub(crate) fn attempt(
    args: &SceneArgs,
    options: &Options,
    console: &Console,
) -> Result<Loaded, Failed> {
    let mut document = Document::open(&args.scene, &options.limits, &assets())?;
    evaluated(args, &mut document, options, console)
}

/// The scene of a document, for other parameters or another time; says what it prints.
pub(crate) fn evaluated(
    args: &SceneArgs,
    document: &mut Document,
    options: &Options,
    console: &Console,
) -> Result<Loaded, Failed> {
    let start = std::time::Instant::now();
    let loaded = document.scene(options)?;
    say_printed(&loaded.log, console);
    for warning in &loaded.warnings {
        console.warn(warning);
    }
    tracing::debug!(
        objects = loaded.scene.objects().len(),
        files = loaded.files.len(),
        "loaded {} in {:.1} ms",
        args.scene.display(),
        1e3 * start.elapsed().as_secs_f64()
    );
    Ok(loaded)
}

/// Says what the scene prints, as far as anybody would read it.
fn say_printed(log: &[String], console: &Console) {
    for line in log.iter().take(LINES) {
        console.note(line);
    }
    if log.len() > LINES {
        console.note(format_args!("…({} lines left out)", log.len() - LINES));
    }
}
