//! Files of a scene: only those below its own folder, and only ordinary ones of a limited size.

use std::fs;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Why a file cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FileError {
    #[error(
        "\"{0}\" is outside of the scene's folder: write a path below it, without `..` and without a leading slash"
    )]
    Outside(String),
    #[error("there is no file \"{0}\" in the scene's folder")]
    Missing(String),
    #[error("\"{0}\" is not an ordinary file")]
    Special(String),
    #[error("\"{name}\" has {bytes} bytes, at most {limit} are allowed (limit `{flag}`)")]
    Large {
        name: String,
        bytes: u64,
        limit: u64,
        flag: &'static str,
    },
    #[error("\"{name}\" cannot be read: {reason}")]
    Unreadable { name: String, reason: String },
    #[error("\"{0}\" is not text in UTF-8")]
    Text(String),
    #[error("a scene in memory has no folder to load \"{0}\" from")]
    NoFolder(String),
    #[error("the scene loads more than {0} files (limit `files`)")]
    Many(u64),
}

/// A folder that files are read from, and what was read.
#[derive(Clone, Debug, Default)]
pub(crate) struct Files {
    /// Absent for a scene in memory.
    root: Option<PathBuf>,
    loaded: Vec<PathBuf>,
    limit: u64,
}

impl Files {
    pub(crate) fn new(root: Option<PathBuf>, limit: u64) -> Files {
        Files {
            root,
            loaded: Vec::new(),
            limit,
        }
    }

    /// Every file that was asked for, whether or not it could be read.
    pub(crate) fn into_loaded(self) -> Vec<PathBuf> {
        self.loaded
    }

    pub(crate) fn loaded(&self) -> &[PathBuf] {
        &self.loaded
    }

    /// A path below the folder without detours: `a/./b.star` and `a/b.star` are the same.
    pub(crate) fn normal(name: &str) -> Result<String, FileError> {
        let mut parts = Vec::new();
        let outside = || FileError::Outside(name.to_string());
        if name.is_empty() || name.contains(['\\', '\0']) {
            return Err(outside());
        }
        for component in Path::new(name).components() {
            match component {
                Component::Normal(part) => parts.push(part.to_str().ok_or_else(outside)?),
                Component::CurDir => {}
                _ => return Err(outside()),
            }
        }
        if parts.is_empty() {
            Err(outside())
        } else {
            Ok(parts.join("/"))
        }
    }

    /// The bytes of a file below the folder.
    pub(crate) fn read(
        &mut self,
        name: &str,
        limit: u64,
        flag: &'static str,
    ) -> Result<Vec<u8>, FileError> {
        let normal = Files::normal(name)?;
        let root = self
            .root
            .clone()
            .ok_or_else(|| FileError::NoFolder(name.to_string()))?;
        let path = root.join(&normal);
        if !self.loaded.contains(&path) {
            if self.loaded.len() as u64 >= self.limit {
                return Err(FileError::Many(self.limit));
            }
            self.loaded.push(path.clone());
        }
        // a link may point out of the folder: what counts is where the path ends
        let missing = |_| FileError::Missing(name.to_string());
        let real = fs::canonicalize(&path).map_err(missing)?;
        if !real.starts_with(fs::canonicalize(&root).map_err(missing)?) {
            return Err(FileError::Outside(name.to_string()));
        }
        read_ordinary(&real, name, limit, flag)
    }

    /// The text of a file below the folder.
    pub(crate) fn read_text(&mut self, name: &str, limit: u64) -> Result<String, FileError> {
        let bytes = self.read(name, limit, "file_bytes")?;
        String::from_utf8(bytes).map_err(|_| FileError::Text(name.to_string()))
    }
}

/// The bytes of an ordinary file. A pipe or a device is never opened, as that could wait for ever.
pub(crate) fn read_ordinary(
    path: &Path,
    name: &str,
    limit: u64,
    flag: &'static str,
) -> Result<Vec<u8>, FileError> {
    let unreadable = |e: std::io::Error| FileError::Unreadable {
        name: name.to_string(),
        reason: e.to_string(),
    };
    let large = |bytes| FileError::Large {
        name: name.to_string(),
        bytes,
        limit,
        flag,
    };
    let about = fs::metadata(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => FileError::Missing(name.to_string()),
        _ => unreadable(e),
    })?;
    if !about.is_file() {
        return Err(FileError::Special(name.to_string()));
    }
    if about.len() > limit {
        return Err(large(about.len()));
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    let file = fs::File::open(path).map_err(unreadable)?;
    // the file may have grown since
    file.take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    if bytes.len() as u64 > limit {
        Err(large(bytes.len() as u64))
    } else {
        Ok(bytes)
    }
}
