//! Files that commands write: under a name that was given, or one that comes from the scene file's own.

use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::interrupt::{self, Asking};
use indicatif::ProgressBar;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use zeroset_language::naming::default_stem;
use zeroset_output::atomic::{create_folder, write_atomically};
use zeroset_output::display;
use zeroset_scene::render::Observer;

/// The name of a file in this folder that was given none. What a scene says of itself has no part in it.
///
/// # Errors
/// A link of that name: nobody asked for what is behind it to be replaced.
pub(crate) fn default_name(scene: &Path, rest: &str) -> Result<PathBuf, Failure> {
    let name = PathBuf::from(default_stem(scene) + rest);
    no_link(&name)?;
    Ok(name)
}

/// Refuses a name that nobody chose where it is a link.
pub(crate) fn no_link(name: &Path) -> Result<(), Failure> {
    if fs::symlink_metadata(name).is_ok_and(|m| m.is_symlink()) {
        let message = format!("{} is a link to another file", name.display());
        let help = "name the file to write with -o, which may be a link";
        return Err(Failure::with_help(Exit::File, message, help));
    }
    Ok(())
}

/// Makes the folder that a file goes to, where there is none.
pub(crate) fn make_folder(path: &Path) -> Result<(), Failure> {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.exists() => {
            Ok(create_folder(folder)?)
        }
        _ => Ok(()),
    }
}

/// Refuses a name that does not end in .png; `what` is written so.
pub(crate) fn only_png(path: &Path, what: &str) -> Result<(), Failure> {
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("png") => Ok(()),
        _ => Err(Failure::with_help(
            Exit::Usage,
            format!("{} does not end in .png", path.display()),
            format!("{what} are written as PNG"),
        )),
    }
}

/// Writes text to a file.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<(), Failure> {
    let _asking = Asking::begin();
    write_atomically(path, |writer| writer.write_all(text.as_bytes()))?;
    Ok(())
}

/// Writes a file and shows how far it is; Ctrl-C or `cancelled` ends it.
pub(crate) fn write_watched(
    path: &Path,
    console: &Console,
    cancelled: &(dyn Fn() -> bool + Sync),
    write: impl FnOnce(&mut BufWriter<&File>, &dyn Observer) -> io::Result<()>,
) -> Result<(), Failure> {
    let _asking = Asking::begin();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let progress = Progress {
        bar: console.writing_bar(&display::name(&name, 30)),
        cancelled: &|| interrupt::requested() || cancelled(),
    };
    let written = write_atomically(path, |writer| write(writer, &progress));
    progress.bar.finish_and_clear();
    Ok(written?)
}

/// Tells a bar, and asks whether to stop.
pub(crate) struct Progress<'a> {
    pub(crate) bar: ProgressBar,
    pub(crate) cancelled: &'a (dyn Fn() -> bool + Sync),
}

impl Observer for Progress<'_> {
    fn advance(&self, done: u64, total: u64) {
        if self.bar.length() != Some(total) {
            self.bar.set_length(total);
        }
        self.bar.inc(done);
    }

    fn is_cancelled(&self) -> bool {
        (self.cancelled)()
    }
}

/// A bar of shares of what takes long, and Ctrl-C.
pub(crate) struct Shares(pub(crate) ProgressBar);

impl Shares {
    fn show(&self, share: f64) {
        self.0.set_length(1000);
        self.0.set_position((1000.0 * share) as u64);
    }
}

impl zeroset_volume::bake::Watch for Shares {
    fn advance(&self, share: f64) {
        self.show(share);
    }
    fn is_stopped(&self) -> bool {
        interrupt::requested()
    }
}

impl zeroset_contour::Watch for Shares {
    fn advance(&self, share: f64) {
        self.show(share);
    }
    fn is_stopped(&self) -> bool {
        interrupt::requested()
    }
}
