//! Files of the system: the only module that reads them.

use crate::files::{Files, NoFile, Opened};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder of the system. Links are followed as far as they stay in it.
#[derive(Clone, Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// The folder at this path.
    pub fn new(path: impl Into<PathBuf>) -> Folder {
        Folder(path.into())
    }
}

impl Files for Folder {
    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn locate(&self, name: &str) -> Result<PathBuf, NoFile> {
        // a link may point out of the folder: what counts is where the path ends
        let real = fs::canonicalize(self.path(name))?;
        if !real.starts_with(fs::canonicalize(&self.0)?) {
            return Err(NoFile::Outside);
        }
        Ok(real)
    }

    fn open(&self, place: &Path) -> Result<Opened, NoFile> {
        open(place)
    }
}

/// Opens an ordinary file of the system. A pipe or a device is never opened, as that could wait for ever.
pub(crate) fn open(path: &Path) -> Result<Opened, NoFile> {
    let about = fs::metadata(path)?;
    if !about.is_file() {
        return Err(NoFile::Special);
    }
    let file = fs::File::open(path)?;
    // it may have become something else since
    if !file.metadata()?.is_file() {
        return Err(NoFile::Special);
    }
    Ok(Opened {
        length: about.len(),
        bytes: Box::new(file),
    })
}
