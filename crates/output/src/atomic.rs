//! Files appear whole or not at all.
//!
//! A file is written under another name in the folder it belongs in, synchronised with the disk, and then renamed over
//! its predecessor, which POSIX guarantees to be one step; at last the folder itself is synchronised, so that the rename
//! survives a power cut. Whoever reads the target sees all of the old file or all of the new one. The process may be
//! killed at any moment.

use crate::format::Cancelled;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::NamedTempFile;

/// Name of an unfinished file, before its random part. Short, so that a target with the longest possible name still has
/// room beside it.
const PREFIX: &str = ".zeroset-";
/// Name of an unfinished file, after its random part.
const SUFFIX: &str = ".partial";
/// An unfinished file that nobody holds and that is this old was left by a process that was killed.
const ABANDONED: Duration = Duration::from_secs(60);

/// Why a file could not be written. The file that was there before, if any, is whole.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {failure}", path.display())]
pub struct WriteError {
    /// The file that was to be written.
    pub path: PathBuf,
    /// What went wrong.
    pub failure: WriteFailure,
}

/// What goes wrong when a file is written.
#[derive(Debug, thiserror::Error)]
pub enum WriteFailure {
    /// The target is a folder, or ends in a separator.
    #[error("it is a folder")]
    Folder,
    /// The target is a device, a pipe or a socket, which a rename would replace by a file.
    #[error("it is not a regular file")]
    Special,
    /// The target may not be changed.
    #[error("it is write-protected")]
    Protected,
    /// The target exists and was to be created.
    #[error("it exists already")]
    Exists,
    /// The folder that was to hold the file does not exist.
    #[error("the folder {} does not exist", .0.display())]
    NoFolder(PathBuf),
    /// Whoever wanted the file does not want it any more.
    #[error("it was cancelled")]
    Cancelled,
    /// What the system said.
    #[error("{0}")]
    System(#[source] io::Error),
}

impl WriteError {
    fn new(path: &Path, failure: WriteFailure) -> Self {
        WriteError {
            path: path.to_owned(),
            failure,
        }
    }

    fn system(path: &Path) -> impl Fn(io::Error) -> Self {
        move |error| {
            let is_cancelled = error.get_ref().is_some_and(|e| e.is::<Cancelled>());
            let failure = if is_cancelled {
                WriteFailure::Cancelled
            } else {
                WriteFailure::System(error)
            };
            WriteError::new(path, failure)
        }
    }

    /// What the user can do about it.
    pub fn advice(&self) -> &'static str {
        match &self.failure {
            WriteFailure::Folder => "name a file in that folder",
            WriteFailure::Special => "name a regular file",
            WriteFailure::Protected => "choose another name, or make the file writable",
            WriteFailure::Exists => "choose another name, or remove what is there",
            WriteFailure::NoFolder(_) => "create the folder, or choose another one",
            WriteFailure::Cancelled => "ask for it again",
            WriteFailure::System(error) => match error.kind() {
                io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                    "free some space, or choose another disk"
                }
                io::ErrorKind::FileTooLarge => {
                    "raise the limit on file sizes, or make the picture smaller"
                }
                io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
                    "choose a folder that you may write to"
                }
                io::ErrorKind::InvalidFilename => {
                    "choose a shorter name without special characters"
                }
                io::ErrorKind::NotADirectory => {
                    "a part of the path is a file: choose another folder"
                }
                _ => "try again, or choose another place",
            },
        }
    }
}

/// What happens to a file of the same name.
#[derive(Clone, Copy, PartialEq)]
enum Existing {
    Replace,
    Refuse,
}

/// Writes a file, or replaces it: `write` fills it, and only if all of it is on the disk does it take its name.
///
/// A file that is replaced passes on its permissions and, where the system allows, its owner. A symbolic link stays a
/// link: the file behind it is replaced.
///
/// # Errors
/// Whatever `write` gives, a full disk, a missing or protected folder, a target that is no regular file. The old file is
/// whole then, and nothing else is left in the folder.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    put(path, Existing::Replace, write)
}

/// As [`write_atomically`], and refuses to replace anything.
///
/// # Errors
/// As [`write_atomically`], and [`WriteFailure::Exists`].
pub fn create_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    put(path, Existing::Refuse, write)
}

/// Makes a folder, and those that hold it. One that exists is left as it is.
///
/// # Errors
/// A file of that name, a folder that may not be written to.
pub fn create_folder(path: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(path).map_err(WriteError::system(path))?;
    sync_folder(path).map_err(WriteError::system(path))
}

/// Finds out whether a file could be written, before hours of work go into what it would hold. Also clears away what
/// processes that were killed have left in its folder.
///
/// # Errors
/// As [`write_atomically`].
pub fn probe(path: &Path) -> Result<(), WriteError> {
    let target = Target::of(path)?;
    clear_abandoned(&target.folder);
    target.begin(path).map(drop)
}

fn put(
    path: &Path,
    existing: Existing,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> Result<(), WriteError> {
    let system = WriteError::system(path);
    let target = Target::of(path)?;
    if existing == Existing::Refuse && target.old.is_some() {
        return Err(WriteError::new(path, WriteFailure::Exists));
    }
    let unfinished = target.begin(path)?;
    let mut writer = BufWriter::new(unfinished.as_file());
    write(&mut writer).map_err(&system)?;
    writer.flush().map_err(&system)?;
    drop(writer);
    if let Some(old) = &target.old {
        inherit(unfinished.as_file(), old).map_err(&system)?;
    }
    unfinished.as_file().sync_all().map_err(&system)?;
    let named = match existing {
        Existing::Replace => unfinished.persist(&target.file),
        Existing::Refuse => unfinished.persist_noclobber(&target.file),
    };
    named.map_err(|failed| match failed.error.kind() {
        io::ErrorKind::AlreadyExists if existing == Existing::Refuse => {
            WriteError::new(path, WriteFailure::Exists)
        }
        _ => system(failed.error),
    })?;
    sync_folder(&target.folder).map_err(&system)
}

/// Where a file goes.
struct Target {
    /// The file itself, behind any symbolic links.
    file: PathBuf,
    /// The folder that holds it.
    folder: PathBuf,
    /// What is there now.
    old: Option<fs::Metadata>,
}

impl Target {
    fn of(path: &Path) -> Result<Target, WriteError> {
        let fail = |failure| Err(WriteError::new(path, failure));
        if path.file_name().is_none()
            || path
                .as_os_str()
                .to_string_lossy()
                .ends_with(std::path::is_separator)
        {
            return fail(WriteFailure::Folder);
        }
        let (file, old) = match fs::symlink_metadata(path) {
            Ok(link) if link.is_symlink() => {
                let file = fs::canonicalize(path).map_err(WriteError::system(path))?;
                let metadata = fs::metadata(&file).map_err(WriteError::system(path))?;
                (file, Some(metadata))
            }
            Ok(metadata) => (path.to_owned(), Some(metadata)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => (path.to_owned(), None),
            Err(error) => return fail(WriteFailure::System(error)),
        };
        match &old {
            Some(old) if old.is_dir() => return fail(WriteFailure::Folder),
            Some(old) if !old.is_file() => return fail(WriteFailure::Special),
            Some(old) if old.permissions().readonly() => return fail(WriteFailure::Protected),
            _ => {}
        }
        let folder = match file.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        if old.is_none()
            && matches!(fs::metadata(&folder), Err(e) if e.kind() == io::ErrorKind::NotFound)
        {
            return fail(WriteFailure::NoFolder(folder));
        }
        Ok(Target { file, folder, old })
    }

    /// An unfinished file, held by a lock, that goes away when it is dropped.
    fn begin(&self, path: &Path) -> Result<NamedTempFile, WriteError> {
        // what the system says, which does not name the unfinished file: that is no news to anybody
        let mut said = None;
        let mut options = OpenOptions::new();
        options.read(true).write(true).create_new(true);
        let unfinished = tempfile::Builder::new()
            .prefix(PREFIX)
            .suffix(SUFFIX)
            .rand_bytes(10)
            .make_in(&self.folder, |name| {
                options.open(name).inspect_err(|error| {
                    said = error.raw_os_error().map(io::Error::from_raw_os_error);
                })
            })
            .map_err(|error| {
                let said = said.unwrap_or_else(|| error.kind().into());
                WriteError::new(path, WriteFailure::System(said))
            })?;
        // Without a lock (some network disks have none) the file may count as abandoned after a minute of silence: the
        // rename then fails and says so.
        let _ = unfinished.as_file().try_lock();
        Ok(unfinished)
    }
}

/// Gives a new file the permissions of the old one and, as far as the process may, its owner.
fn inherit(file: &File, old: &fs::Metadata) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, fchown};
        let new = file.metadata()?;
        if (new.uid(), new.gid()) != (old.uid(), old.gid()) {
            // who may not give a file away still may replace it
            let _ = fchown(file, Some(old.uid()), Some(old.gid()));
        }
    }
    file.set_permissions(old.permissions())
}

#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder)?.sync_all() {
        // some file systems cannot, and need not
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        done => done,
    }
}

#[cfg(not(unix))]
fn sync_folder(_folder: &Path) -> io::Result<()> {
    Ok(())
}

/// Removes unfinished files that nobody is writing any more. Failing to is no failure.
fn clear_abandoned(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        if !name.starts_with(PREFIX) || !name.ends_with(SUFFIX) {
            continue;
        }
        let age = entry
            .metadata()
            .and_then(|m| m.modified())
            .map(|changed| changed.elapsed().unwrap_or_default());
        if age.is_ok_and(|age| age > ABANDONED)
            && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok())
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}
