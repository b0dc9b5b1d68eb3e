//! Loading: from a scene file, or its text, to a [`Scene`].

use crate::budget::Budget;
use crate::draft::Draft;
use crate::files::{self, Files, read_ordinary};
use crate::json;
use crate::limits::Limits;
use crate::naming::default_stem;
use crate::report::{Report, Source};
use crate::starlark;
use crate::starlark::mistake::{Mistake, Run, mistake};
use crate::starlark::module::{Module, parse};
use crate::trees;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use zeroset_scene::scene::Scene;

/// What is given beside the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Parameters by name, each as text.
    pub set: BTreeMap<String, String>,
    /// Seconds of the animation.
    pub time: f64,
    /// Width and height that replace the file's.
    pub size: Option<[u32; 2]>,
    /// What the scene may cost.
    pub limits: Limits,
}

/// A scene with what loading found out.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What can be changed from outside, in the order of the file.
    pub parameters: Vec<Parameter>,
    /// Whether the scene asked for the time.
    pub animated: bool,
    /// Every file that was read, the scene's own first.
    pub files: Vec<PathBuf>,
    /// What the script printed, line by line.
    pub log: Vec<String>,
    /// What is not as it was meant, although the scene could be loaded.
    pub warnings: Vec<Report>,
}

/// A scene that could not be loaded. Boxed: it carries the file's text.
#[derive(Debug)]
pub struct Failed {
    /// Why.
    pub report: Box<Report>,
    /// Every file that was asked for, the scene's own first: when one of them changes, loading is worth another try.
    pub files: Vec<PathBuf>,
}

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.report.fmt(f)
    }
}

impl std::error::Error for Failed {}

/// Something that can be changed from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// How it is changed.
    pub control: Control,
    /// What it is.
    pub value: Setting,
    /// What it is when nobody changes it.
    pub default: Setting,
    /// Where it is declared: (file, line, column), 1-based.
    pub place: Option<(String, u32, u32)>,
}

/// How a parameter is changed.
#[derive(Clone, Debug, PartialEq)]
pub enum Control {
    /// A number in a range.
    Slider {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// One of several words.
    Choice {
        /// The words.
        options: Vec<String>,
    },
    /// On or off.
    Toggle,
    /// A colour.
    Colour,
}

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// Of a slider.
    Number(f64),
    /// Of a choice.
    Text(String),
    /// Of a toggle.
    Flag(bool),
    /// Of a colour: sRGB, 0 to 1.
    Colour([f64; 3]),
}

/// The language of a scene's text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Starlark, `.star`.
    Starlark,
    /// Its twin in JSON, `.json`.
    Json,
}

/// Loads a scene file. Files that it loads lie in its own folder.
///
/// # Errors
/// Everything that can be wrong with it, with the place and what to do.
pub fn load(path: &Path, options: &Options) -> Result<Loaded, Failed> {
    let fail = |message: String| Failed {
        report: Report::new(message).into(),
        files: vec![path.to_path_buf()],
    };
    let file_name = path
        .file_name()
        .and_then(|n| n.to_str())
        .unwrap_or("scene")
        .to_string();
    let language = match path.extension().and_then(|e| e.to_str()) {
        Some("star") => Language::Starlark,
        Some("json") => Language::Json,
        _ => {
            return Err(fail(format!(
                "{}: a scene file ends in .star or .json",
                path.display()
            )));
        }
    };
    let mut budget = Budget::new(&options.limits);
    let most = options.limits.file_bytes;
    let text = read_ordinary(path, &file_name, most, "file_bytes", &mut budget)
        .and_then(|bytes| files::text(bytes, &file_name))
        .map_err(|e| fail(e.to_string()))?;
    let folder = path
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let result = load_from(
        &file_name,
        text,
        language,
        Some(folder.to_path_buf()),
        options,
        budget,
    );
    let own = |mut files: Vec<PathBuf>| {
        files.insert(0, path.to_path_buf());
        files
    };
    match result {
        Ok(loaded) => Ok(Loaded {
            files: own(loaded.files),
            ..loaded
        }),
        Err(failed) => Err(Failed {
            files: own(failed.files),
            ..failed
        }),
    }
}

/// Loads a scene from its text. `root` is the folder that it may load files from, if any.
///
/// # Errors
/// Everything that can be wrong with it, with the place and what to do.
pub fn load_text(
    name: &str,
    text: &str,
    language: Language,
    root: Option<&Path>,
    options: &Options,
) -> Result<Loaded, Failed> {
    let mut budget = Budget::new(&options.limits);
    let length = text.len() as u64;
    let room = if length > options.limits.file_bytes {
        let most = options.limits.file_bytes;
        Err(format!(
            "\"{name}\" has {length} bytes, at most {most} are allowed (limit `file_bytes`)"
        ))
    } else {
        (budget.hold(length, || format!("\"{name}\""))).map_err(|e| e.to_string())
    };
    room.map_err(|message| Failed {
        report: Report::new(message).in_file(name).into(),
        files: Vec::new(),
    })?;
    load_from(
        name,
        text.to_string(),
        language,
        root.map(Path::to_path_buf),
        options,
        budget,
    )
}

fn load_from(
    name: &str,
    text: String,
    language: Language,
    root: Option<PathBuf>,
    options: &Options,
    budget: Budget,
) -> Result<Loaded, Failed> {
    let (name, options) = (name.to_string(), options.clone());
    let text = without_mark(text);
    let work = move || match language {
        Language::Starlark => load_starlark(&name, text, root, &options, budget),
        Language::Json => load_json(&name, &text, root, &options, budget),
    };
    let thread = std::thread::Builder::new()
        .name("scene".into())
        .stack_size(starlark::depth::STACK)
        .spawn(work);
    let broken = |message: &str| Failed {
        report: Report::new(message).into(),
        files: Vec::new(),
    };
    let thread = thread.map_err(|e| broken(&format!("cannot start a thread: {e}")))?;
    thread.join().unwrap_or_else(|_| {
        Err(broken(
            "the scene loader broke down; please report this scene as a bug",
        ))
    })
}

/// A text without the byte order mark that some editors put in front of it, and that says nothing in UTF-8.
fn without_mark(text: String) -> String {
    match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_string(),
        None => text,
    }
}

fn load_starlark(
    name: &str,
    text: String,
    root: Option<PathBuf>,
    options: &Options,
    budget: Budget,
) -> Result<Loaded, Failed> {
    let mut loader = Loader {
        files: Files::new(root, options.limits.files.saturating_sub(1), budget),
        sources: Vec::new(),
        modules: Vec::new(),
        names: BTreeMap::new(),
        limits: options.limits,
    };
    // the scene's own file, if it is one
    let own = loader.files.real(name);
    let own = own.unwrap_or_else(|| PathBuf::from(name));
    if let Err(m) = loader.module(name, own, text) {
        let report = m.report(&loader.sources).into();
        let files = loader.files.into_loaded();
        return Err(Failed { report, files });
    }
    let draft = Draft::new(options, loader.files, loader.sources);
    let (draft, result) = starlark::run(&loader.modules, draft, &options.limits, budget.start());
    let result = result.map_err(|m| m.report(&draft.sources).into());
    finish(name, draft, result, &options.limits)
}

fn load_json(
    name: &str,
    text: &str,
    root: Option<PathBuf>,
    options: &Options,
    budget: Budget,
) -> Result<Loaded, Failed> {
    let files = Files::new(root, options.limits.files.saturating_sub(1), budget);
    let mut draft = Draft::new(options, files, vec![Source::new(name, text)]);
    let result =
        json::read(&mut draft, &options.limits).and_then(|()| match draft.unknown_parameter() {
            None => Ok(()),
            Some((message, help)) => Err(Report::new(message).with_help(help).into()),
        });
    finish(name, draft, result, &options.limits)
}

/// The scene of a draft that was filled, or why it was not.
fn finish(
    name: &str,
    mut draft: Draft,
    result: Result<(), Box<Report>>,
    limits: &Limits,
) -> Result<Loaded, Failed> {
    let files = draft.files.loaded().to_vec();
    let parameters = std::mem::take(&mut draft.parameters);
    let (animated, log) = (draft.animated, std::mem::take(&mut draft.log));
    let warnings = std::mem::take(&mut draft.warnings);
    let stem = default_stem(Path::new(name));
    let scene = result.and_then(|()| {
        draft
            .finish(&stem, limits)
            .map_err(|m| Report::new(m).in_file(name).into())
    });
    match scene {
        Ok(scene) => Ok(Loaded {
            scene,
            parameters,
            animated,
            files,
            log,
            warnings,
        }),
        Err(report) => Err(Failed { report, files }),
    }
}

/// Parses a file and all that it loads.
struct Loader {
    files: Files,
    sources: Vec<Source>,
    modules: Vec<Module>,
    /// Modules by where their files really are; `None` while one is being loaded.
    names: BTreeMap<PathBuf, Option<u32>>,
    limits: Limits,
}

impl Loader {
    /// Parses a file, after all that it loads. Gives the number of its module.
    fn module(&mut self, name: &str, real: PathBuf, text: String) -> Run<u32> {
        let file = self.sources.len() as u32;
        self.sources.push(Source::new(name, &text));
        self.names.insert(real.clone(), None);
        let room = trees::charge(name, &text, &mut self.files.budget);
        room.map_err(|e| mistake(e.to_string()))?;
        let (statement, wanted) = parse(file, name, &text, &self.limits)?;
        let mut loads = std::collections::HashMap::new();
        for (path, place) in wanted {
            let module = self.loaded(&path).map_err(|m: Box<Mistake>| m.at(place))?;
            loads.insert(path, module);
        }
        self.modules.push(Module {
            file,
            statement,
            loads,
        });
        let number = self.modules.len() as u32 - 1;
        self.names.insert(real, Some(number));
        Ok(number)
    }

    /// The number of a module that a `load` names.
    fn loaded(&mut self, path: &str) -> Run<u32> {
        let wrong = |e: files::FileError| mistake(e.to_string());
        let name = Files::normal(path).map_err(wrong)?;
        if !name.ends_with(".star") {
            return Err(mistake(format!("\"{path}\" does not end in .star"))
                .help("only scene files can be loaded"));
        }
        let real = self.files.find(&name).map_err(wrong)?;
        match self.names.get(&real) {
            Some(Some(number)) => return Ok(*number),
            Some(None) => {
                let m = mistake(format!(
                    "\"{path}\" loads itself, directly or by way of others"
                ));
                return Err(m.help("move what both need into a third file"));
            }
            None => {}
        }
        let most = self.limits.file_bytes;
        let text = self.files.read_text(&real, &name, most).map_err(wrong)?;
        self.module(&name, real, without_mark(text))
    }
}
