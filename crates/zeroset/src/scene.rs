//! From the command line's words about a scene to the scene.

use crate::args::SceneArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use std::collections::BTreeMap;
use std::fs;
use zeroset_scene::limits::Limits;
use zeroset_scene::load::{Failed, Loaded, Options, load};

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
        time: args.time,
        size,
        limits,
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

/// Whether there is a file: where there is none, nothing is wrong with a scene.
pub(crate) fn present(args: &SceneArgs) -> Result<(), Failure> {
    let path = args.scene.display();
    match fs::metadata(&args.scene) {
        Ok(metadata) if metadata.is_file() => Ok(()),
        Ok(_) => {
            let message = format!("cannot read {path}: it is not a regular file");
            Err(Failure::with_help(
                Exit::File,
                message,
                "name a scene, for example scene.star",
            ))
        }
        Err(error) => Err(Failure::new(
            Exit::File,
            format!("cannot read {path}: {error}"),
        )),
    }
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

/// As [`loaded`]; a failure names the files that it came from.
pub(crate) fn attempt(
    args: &SceneArgs,
    options: &Options,
    console: &Console,
) -> Result<Loaded, Failed> {
    let start = std::time::Instant::now();
    let loaded = load(&args.scene, options)?;
    for line in &loaded.log {
        console.note(line);
    }
    for warning in &loaded.warnings {
        console.warn(warning);
    }
    tracing::debug!(
        objects = loaded.scene.objects.len(),
        files = loaded.files.len(),
        "loaded {} in {:.1} ms",
        args.scene.display(),
        1e3 * start.elapsed().as_secs_f64()
    );
    Ok(loaded)
}
