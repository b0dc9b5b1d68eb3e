//! Files of a scene: only those below its own folder, and only ordinary ones of a limited size. Where they come from is a [`Files`]: a
//! folder of the system, or what a program holds in memory, as a page of a browser does.

use crate::assets::Assets;
use crate::budget::{LoadBudget, Spent};
use crate::images;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::io::{self, Cursor, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use zeroset_field::sampled::Sampled;
use zeroset_scene::material::Image;

/// Where a scene's files come from. Names are paths below it, with `/` between their parts and without detours.
pub trait Files: Send + Sync + std::fmt::Debug {
    /// What a file is called outside: that path is shown as one that the scene depends on, whether or not there is such a file.
    fn path(&self, name: &str) -> PathBuf;

    /// Where the file of a name really is: one place for one file, under whatever names.
    ///
    /// # Errors
    /// There is no such file that the scene may see.
    fn locate(&self, name: &str) -> Result<PathBuf, NoFile>;

    /// The file at a place that was located.
    ///
    /// # Errors
    /// It is no ordinary file, or cannot be read.
    fn open(&self, place: &Path) -> Result<Opened, NoFile>;
}

/// A file that can be read.
pub struct Opened {
    /// Its length in bytes, as far as that is known before it was read.
    pub length: u64,
    /// What it holds.
    pub bytes: Box<dyn Read>,
}

/// Why there is no file.
#[derive(Debug, thiserror::Error)]
pub enum NoFile {
    /// It is outside of what the scene may see.
    #[error("it is outside of the scene's folder")]
    Outside,
    /// It is a folder, a pipe or a device.
    #[error("it is not an ordinary file")]
    Special,
    /// The system says so.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Files in memory, by their names.
///
/// ```
/// use std::sync::Arc;
/// use zeroset_language::assets::Assets;
/// use zeroset_language::document::Document;
/// use zeroset_language::files::InMemory;
/// use zeroset_language::limits::Limits;
/// use zeroset_language::load::{Language, Options};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let files = InMemory::new([("parts/ball.star", "def ball(r):\n    return sphere(r)\n")]);
/// let text = "load(\"parts/ball.star\", \"ball\")\nshow(ball(2))";
/// let (limits, assets) = (Limits::default(), Assets::default());
/// let files = Some(Arc::new(files) as _);
/// let mut document = Document::of_text("scene.star", text, Language::Starlark, files, &limits, &assets)?;
/// let scene = document.scene(&Options::default())?.scene;
/// assert_eq!(scene.objects()[0].field.facts().bounds.max, [2.0; 3]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct InMemory(BTreeMap<String, Arc<[u8]>>);

impl InMemory {
    /// Files with these names and contents.
    pub fn new<N: Into<String>, C: AsRef<[u8]>>(
        files: impl IntoIterator<Item = (N, C)>,
    ) -> InMemory {
        let file = |(name, content): (N, C)| (name.into(), content.as_ref().into());
        InMemory(files.into_iter().map(file).collect())
    }
}

impl Files for InMemory {
    fn path(&self, name: &str) -> PathBuf {
        PathBuf::from(name)
    }

    fn locate(&self, name: &str) -> Result<PathBuf, NoFile> {
        if self.0.contains_key(name) {
            Ok(PathBuf::from(name))
        } else {
            Err(io::Error::from(io::ErrorKind::NotFound).into())
        }
    }

    fn open(&self, place: &Path) -> Result<Opened, NoFile> {
        let name = place.to_str().unwrap_or_default();
        let bytes = (self.0.get(name)).ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))?;
        Ok(Opened {
            length: bytes.len() as u64,
            bytes: Box::new(Cursor::new(bytes.clone())),
        })
    }
}

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

/// Files as one document reads them: limited, charged, each of them once.
#[derive(Debug)]
pub(crate) struct Reading {
    /// Absent for a scene without any.
    source: Option<Arc<dyn Files>>,
    loaded: Vec<PathBuf>,
    limit: u64,
    /// What loading may still take.
    pub(crate) budget: LoadBudget,
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
    /// Samples by their file and by how they are made of it.
    sampled: HashMap<(PathBuf, String), Arc<Sampled>>,
    pub(crate) assets: Assets,
}

impl Reading {
    pub(crate) fn new(
        source: Option<Arc<dyn Files>>,
        limit: u64,
        budget: LoadBudget,
        assets: &Assets,
    ) -> Reading {
        let cache = Cache {
            assets: assets.clone(),
            ..Cache::default()
        };
        Reading {
            source,
            loaded: Vec::new(),
            limit,
            budget,
            cache,
            charged: HashSet::new(),
        }
    }

    /// The same files, where these files were asked for and this was read before.
    pub(crate) fn again(&self, limit: u64, budget: LoadBudget, cache: Cache) -> Reading {
        Reading {
            source: self.source.clone(),
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
        let normal = Reading::normal(name)?;
        let source = self.source(name)?;
        let path = source.path(&normal);
        if !self.loaded.contains(&path) {
            if self.loaded.len() as u64 >= self.limit {
                return Err(FileError::Many(self.limit));
            }
            self.loaded.push(path.clone());
        }
        if let Some(real) = self.cache.places.get(&path) {
            return Ok(real.clone());
        }
        let real = source.locate(&normal).map_err(|e| no_file(name, e))?;
        self.cache.places.insert(path, real.clone());
        Ok(real)
    }

    fn source(&self, name: &str) -> Result<Arc<dyn Files>, FileError> {
        (self.source.clone()).ok_or_else(|| FileError::NoFolder(name.to_string()))
    }

    /// Where a file really is that was read already, as the scene's own was.
    pub(crate) fn real(&self, name: &str) -> Option<PathBuf> {
        self.source.as_ref()?.locate(name).ok()
    }

    /// The bytes of the file at a place that was found, charged before they are read.
    pub(crate) fn read_at(
        &self,
        real: &Path,
        name: &str,
        limit: u64,
        flag: &'static str,
        budget: &mut LoadBudget,
    ) -> Result<Vec<u8>, FileError> {
        let opened = self.source(name)?.open(real);
        read_whole(opened, name, limit, flag, budget)
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
        let mut budget = self.budget;
        let bytes = self.read_at(&real, name, limit, flag, &mut budget)?;
        self.budget = budget;
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
        let mut budget = self.budget;
        let bytes = self.read_at(real, name, limit, "file_bytes", &mut budget)?;
        self.budget = budget;
        text(bytes, name)
    }

    /// An image of a file below the folder, read once.
    pub(crate) fn image(
        &mut self,
        name: &str,
        read: impl FnOnce(&mut Reading, &Path) -> Result<Arc<Image>, String>,
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

    /// Samples of a file below the folder, made once in each way.
    pub(crate) fn sampled(
        &mut self,
        name: &str,
        how: &str,
        make: impl FnOnce(&mut Reading) -> Result<Arc<Sampled>, String>,
    ) -> Result<Arc<Sampled>, String> {
        let real = self.find(name).map_err(|e| e.to_string())?;
        self.budget.check_clock().map_err(|e| e.to_string())?;
        let key = (real, how.to_owned());
        if let Some(sampled) = self.cache.sampled.get(&key) {
            return Ok(sampled.clone());
        }
        let sampled = make(self)?;
        self.cache.sampled.insert(key, sampled.clone());
        Ok(sampled)
    }

    /// Charges samples, those of a file at most once.
    pub(crate) fn hold_sampled(&mut self, name: &str, bytes: u64) -> Result<(), FileError> {
        let real = self.find(name)?;
        if self.charged.insert(real) {
            self.budget
                .hold(bytes, || format!("samples of \"{name}\""))?;
        }
        Ok(())
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

/// Why there is no file of a name.
fn no_file(name: &str, error: NoFile) -> FileError {
    match error {
        NoFile::Outside => FileError::Outside(name.to_string()),
        NoFile::Special => FileError::Special(name.to_string()),
        NoFile::Io(e) => unreadable(name, &e),
    }
}

/// Why the system does not give a file.
fn unreadable(name: &str, error: &io::Error) -> FileError {
    use io::ErrorKind::{NotADirectory, NotFound};
    match error.kind() {
        NotFound | NotADirectory => FileError::Missing(name.to_string()),
        _ => FileError::Unreadable {
            name: name.to_string(),
            reason: error.to_string(),
        },
    }
}

/// The bytes of a file, charged before they are read.
pub(crate) fn read_whole(
    opened: Result<Opened, NoFile>,
    name: &str,
    limit: u64,
    flag: &'static str,
    budget: &mut LoadBudget,
) -> Result<Vec<u8>, FileError> {
    let mut file = opened.map_err(|e| no_file(name, e))?;
    let large = |bytes| FileError::Large {
        name: name.to_string(),
        bytes,
        limit,
        flag,
    };
    if file.length > limit {
        return Err(large(file.length));
    }
    budget.hold(file.length, || format!("\"{name}\""))?;
    let mut bytes = Vec::with_capacity(file.length as usize);
    let mut taken = file.length;
    loop {
        // it may have grown since
        let more = (&mut file.bytes)
            .take(PIECE)
            .read_to_end(&mut bytes)
            .map_err(|e| unreadable(name, &e))?;
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
