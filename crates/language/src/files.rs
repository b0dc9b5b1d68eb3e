//! Files of a scene: only those below its own folder, and only ordinary ones of a limited size.

use crate::assets::Assets;
use crate::budget::{Budget, Spent};
use crate::images;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use zeroset_scene::material::Image;

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
    #[error(
        "\"{name}\" is not text in UTF-8: byte {at}, in line {line}, cannot be part of it{}",
        if *.wide { " (it looks like UTF-16)" } else { "" }
    )]
    Text {
        name: String,
        at: usize,
        line: usize,
        wide: bool,
    },
    #[error(transparent)]
    Spent(#[from] Spent),
    #[error("a scene in memory has no folder to load \"{0}\" from")]
    NoFolder(String),
    #[error("the scene loads more than {0} files (limit `files`)")]
    Many(u64),
}

/// A folder that files are read from, and what was read.
#[derive(Debug)]
pub(crate) struct Files {
    /// Absent for a scene in memory.
    root: Option<PathBuf>,
    loaded: Vec<PathBuf>,
    limit: u64,
    /// What loading may still take.
    pub(crate) budget: Budget,
    pub(crate) cache: Cache,
    /// Images that are charged already.
    charged: HashSet<PathBuf>,
}

/// What was read of a scene's files: it stays good for as long as none of them changes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cache {
    /// Where files really are, by their paths.
    places: HashMap<PathBuf, PathBuf>,
    /// Files by where they really are, so that each is read once under whatever names.
    bytes: HashMap<PathBuf, Arc<[u8]>>,
    images: HashMap<PathBuf, Arc<Image>>,
    pub(crate) assets: Assets,
}

impl Files {
    pub(crate) fn new(root: Option<PathBuf>, limit: u64, budget: Budget, assets: &Assets) -> Files {
        let cache = Cache {
            assets: assets.clone(),
            ..Cache::default()
        };
        Files {
            root,
            loaded: Vec::new(),
            limit,
            budget,
            cache,
            charged: HashSet::new(),
        }
    }

    /// The same folder, where these files were asked for and this was read before.
    pub(crate) fn again(&self, limit: u64, budget: Budget, cache: Cache) -> Files {
        Files {
            root: self.root.clone(),
            loaded: self.loaded.clone(),
            limit,
            budget,
            cache,
            charged: HashSet::new(),
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

    /// Where a file below the folder really is, behind all links.
    pub(crate) fn find(&mut self, name: &str) -> Result<PathBuf, FileError> {
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
        if let Some(real) = self.cache.places.get(&path) {
            return Ok(real.clone());
        }
        // a link may point out of the folder: what counts is where the path ends
        let missing = |e: std::io::Error| unreadable(name, &e);
        let real = fs::canonicalize(&path).map_err(missing)?;
        if !real.starts_with(fs::canonicalize(&root).map_err(missing)?) {
            return Err(FileError::Outside(name.to_string()));
        }
        self.cache.places.insert(path, real.clone());
        Ok(real)
    }

    /// Where a file really is that was read already, as the scene's own was.
    pub(crate) fn real(&self, name: &str) -> Option<PathBuf> {
        fs::canonicalize(self.root.as_ref()?.join(name)).ok()
    }

    /// The bytes of a file below the folder. They are read once and kept.
    pub(crate) fn read(
        &mut self,
        name: &str,
        limit: u64,
        flag: &'static str,
    ) -> Result<Arc<[u8]>, FileError> {
        let real = self.find(name)?;
        if let Some(bytes) = self.cache.bytes.get(&real) {
            let bytes = bytes.clone();
            if self.charged.insert(real) {
                self.budget
                    .hold(bytes.len() as u64, || format!("\"{name}\""))?;
            }
            return Ok(bytes);
        }
        self.budget.check_clock()?;
        let bytes = read_ordinary(&real, name, limit, flag, &mut self.budget)?;
        // the bytes as they were read and as they are kept
        let twice = 2 * bytes.len() as u64;
        self.budget.borrow(twice, || format!("\"{name}\""))?;
        let bytes: Arc<[u8]> = bytes.into();
        self.charged.insert(real.clone());
        self.cache.bytes.insert(real, bytes.clone());
        Ok(bytes)
    }

    /// The text of a file that was found. It is not kept, but charged as if it were, as its source is.
    pub(crate) fn read_text(
        &mut self,
        real: &Path,
        name: &str,
        limit: u64,
    ) -> Result<String, FileError> {
        self.budget.check_clock()?;
        let bytes = read_ordinary(real, name, limit, "file_bytes", &mut self.budget)?;
        text(bytes, name)
    }

    /// An image of a file below the folder, read once.
    pub(crate) fn image(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut Files, &Path) -> Result<Arc<Image>, String>,
    ) -> Result<Arc<Image>, String> {
        let real = self.find(name).map_err(|e| e.to_string())?;
        self.budget.check_clock().map_err(|e| e.to_string())?;
        let image = match self.cache.images.get(&real) {
            Some(image) => image.clone(),
            None => read(self, &real)?,
        };
        if self.charged.insert(real.clone()) {
            let size = [image.width, image.height];
            (self.budget)
                .hold(images::kept(size), || images::what(name, size))
                .map_err(|e| e.to_string())?;
        }
        self.cache.images.insert(real, image.clone());
        Ok(image)
    }
}

/// Bytes as text.
pub(crate) fn text(bytes: Vec<u8>, name: &str) -> Result<String, FileError> {
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        let bytes = e.as_bytes();
        FileError::Text {
            name: name.to_string(),
            at: at + 1,
            line: bytes[..at].iter().filter(|b| **b == b'\n').count() + 1,
            wide: bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff"),
        }
    })
}

/// Why the system does not give a file.
fn unreadable(name: &str, error: &std::io::Error) -> FileError {
    use std::io::ErrorKind::{NotADirectory, NotFound};
    match error.kind() {
        NotFound | NotADirectory => FileError::Missing(name.to_string()),
        _ => FileError::Unreadable {
            name: name.to_string(),
            reason: error.to_string(),
        },
    }
}

/// The bytes of an ordinary file, charged before they are read. A pipe or a device is never opened, as that could wait for
/// ever.
pub(crate) fn read_ordinary(
    path: &Path,
    name: &str,
    limit: u64,
    flag: &'static str,
    budget: &mut Budget,
) -> Result<Vec<u8>, FileError> {
    let failed = |e: std::io::Error| unreadable(name, &e);
    let large = |bytes| FileError::Large {
        name: name.to_string(),
        bytes,
        limit,
        flag,
    };
    let about = fs::metadata(path).map_err(failed)?;
    if !about.is_file() {
        return Err(FileError::Special(name.to_string()));
    }
    if about.len() > limit {
        return Err(large(about.len()));
    }
    budget.hold(about.len(), || format!("\"{name}\""))?;
    let mut file = fs::File::open(path).map_err(failed)?;
    // it may have become something else, or have grown, since
    if !file.metadata().map_err(failed)?.is_file() {
        return Err(FileError::Special(name.to_string()));
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    let mut taken = about.len();
    loop {
        let more = (&mut file)
            .take(PIECE)
            .read_to_end(&mut bytes)
            .map_err(failed)?;
        if more == 0 {
            return Ok(bytes);
        }
        let length = bytes.len() as u64;
        if length > limit {
            return Err(large(length));
        }
        if length > taken {
            // room for the next piece too, and for the vector that is left behind when it grows
            budget.hold(3 * (length + PIECE - taken), || format!("\"{name}\""))?;
            taken = length + PIECE;
        }
        budget.check_clock()?;
    }
}

/// Bytes that are read at a time.
const PIECE: u64 = 1 << 20;
