//! What took long to make, kept from one run to the next: files in the folder that the system has for such things.
//!
//! `ZEROSET_CACHE` names another folder, or is `off`. Whatever goes wrong, the work is just done again.

use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;
use zeroset_language::assets::{Assets, Shelf};
use zeroset_output::atomic::write_atomically;

/// Bytes of all files together; beyond, the ones that were used longest ago are removed.
const MOST: u64 = 1 << 30;
const END: &str = "nrrd";

/// Assets that are kept in the user's cache, if there is one.
pub(crate) fn assets() -> Assets {
    match folder(|name| std::env::var_os(name)) {
        Some(folder) => Assets::on(Arc::new(Cache(folder))),
        None => Assets::default(),
    }
}

fn folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let path = |name: &str| {
        variable(name)
            .filter(|v| !v.is_empty())
            .map(PathBuf::from)
            // relative folders are to be ignored (XDG base directory specification)
            .filter(|p| p.is_absolute())
    };
    if let Some(own) = variable("ZEROSET_CACHE").filter(|v| !v.is_empty()) {
        return (own != "off").then(|| PathBuf::from(own));
    }
    if cfg!(windows) {
        return path("LOCALAPPDATA").map(|p| p.join("zeroset").join("cache"));
    }
    if cfg!(target_os = "macos") {
        return path("HOME").map(|p| p.join("Library/Caches/zeroset"));
    }
    path("XDG_CACHE_HOME")
        .or_else(|| path("HOME").map(|p| p.join(".cache")))
        .map(|p| p.join("zeroset"))
}

#[derive(Debug)]
struct Cache(PathBuf);

impl Cache {
    fn file(&self, name: &str) -> PathBuf {
        self.0.join(name).with_extension(END)
    }

    /// Removes the files that were used longest ago, as many as are too many.
    fn tidy(&self) {
        let Ok(entries) = fs::read_dir(&self.0) else {
            return;
        };
        let mut files: Vec<(SystemTime, u64, PathBuf)> = entries
            .filter_map(Result::ok)
            .map(|e| e.path())
            .filter(|p| p.extension().is_some_and(|e| e == END))
            .filter_map(|p| {
                let about = fs::symlink_metadata(&p)
                    .ok()
                    .filter(fs::Metadata::is_file)?;
                Some((about.modified().ok()?, about.len(), p))
            })
            .collect();
        files.sort();
        let mut all: u64 = files.iter().map(|f| f.1).sum();
        for (_, bytes, path) in files {
            if all <= MOST {
                break;
            }
            all -= bytes;
            let _ = fs::remove_file(path);
        }
    }
}

impl Shelf for Cache {
    fn get(&self, name: &str) -> Option<Vec<u8>> {
        let path = self.file(name);
        let about = fs::symlink_metadata(&path).ok()?;
        if !about.is_file() || about.len() > MOST {
            return None;
        }
        let bytes = fs::read(&path).ok()?;
        // used now
        let now = fs::File::options().append(true).open(&path);
        let _ = now.and_then(|f| f.set_modified(SystemTime::now()));
        tracing::debug!("samples from {}", path.display());
        Some(bytes)
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        if bytes.len() as u64 > MOST {
            return;
        }
        let path = self.file(name);
        let written = make(&self.0).and_then(|()| {
            write_atomically(&path, |w| w.write_all(bytes)).map_err(|e| e.to_string())
        });
        match written {
            Ok(()) => self.tidy(),
            Err(error) => tracing::debug!("samples are not kept: {error}"),
        }
    }
}

fn make(folder: &Path) -> Result<(), String> {
    fs::create_dir_all(folder).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_is_where_the_system_has_such_things() {
        let of = |pairs: &'static [(&str, &str)]| {
            folder(move |name| pairs.iter().find(|p| p.0 == name).map(|p| p.1.into()))
        };
        assert_eq!(of(&[("ZEROSET_CACHE", "off"), ("HOME", "/h")]), None);
        assert_eq!(of(&[("ZEROSET_CACHE", "x")]), Some("x".into()));
        assert_eq!(of(&[]), None);
        if cfg!(target_os = "linux") {
            assert_eq!(of(&[("HOME", "/h")]), Some("/h/.cache/zeroset".into()));
            let both: &[_] = &[("HOME", "/h"), ("XDG_CACHE_HOME", "/c")];
            assert_eq!(of(both), Some("/c/zeroset".into()));
            let relative: &[_] = &[("HOME", "/h"), ("XDG_CACHE_HOME", "c")];
            assert_eq!(of(relative), Some("/h/.cache/zeroset".into()));
        }
    }

    /// What was kept is there again; a folder that cannot be is no error.
    #[test]
    fn what_is_kept_is_there_again() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache(folder.path().join("a/b"));
        assert_eq!(cache.get("x"), None);
        cache.put("x", b"samples");
        assert_eq!(cache.get("x").unwrap(), b"samples");
        let nowhere = Cache(folder.path().join("a/b/x.nrrd/c"));
        nowhere.put("y", b"samples");
        assert_eq!(nowhere.get("y"), None);
    }
}
