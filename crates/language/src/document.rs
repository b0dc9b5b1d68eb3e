//! Documents: scene files that were read and parsed, ready to become scenes.

use crate::assets::Assets;
use crate::budget::LoadBudget;
use crate::draft::Draft;
use crate::files::{self, Cache, Files, Reading, read_whole};
use crate::folder::{self, Folder};
use crate::json;
use crate::limits::Limits;
use crate::load::{Failed, Language, Loaded, Options, Shutter};
use crate::naming::default_stem;
use crate::report::{Report, Source};
use crate::starlark;
use crate::starlark::mistake::{Mistake, Run, mistake};
use crate::starlark::module::{Module, parse};
use crate::trees;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene file that was read, with all files that it loads. It becomes a scene as often as one likes, for other parameters,
/// times and sizes: nothing is read, parsed or decoded again, but what it did not ask for before.
pub struct Document {
    name: String,
    /// The scene's own file, if it is one.
    path: Option<PathBuf>,
    body: Body,
    files: Reading,
    cache: Cache,
}

/// What was read.
enum Body {
    Starlark {
        modules: Vec<Module>,
        sources: Vec<Source>,
    },
    Json(Source),
}

impl Document {
    /// Reads a scene file. Files that it loads lie in its own folder.
    ///
    /// # Errors
    /// What is wrong with the files, with the place and what to do.
    pub fn open(path: &Path, limits: &Limits, assets: &Assets) -> Result<Document, Failed> {
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
        let mut budget = LoadBudget::new(limits);
        let most = limits.file_bytes;
        let opened = folder::open(path);
        let text = read_whole(opened, &file_name, most, "file_bytes", &mut budget)
            .and_then(|bytes| files::text(bytes, &file_name))
            .map_err(|e| fail(e.to_string()))?;
        let folder = path
            .parent()
            .filter(|p| !p.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        let source = Some(Arc::new(Folder::new(folder)) as Arc<dyn Files>);
        let own = Some(path.to_path_buf());
        Document::read(
            &file_name, own, text, language, source, limits, budget, assets,
        )
    }

    /// A scene from its text. `files` are those that it may load, if any.
    ///
    /// # Errors
    /// What is wrong with the text, with the place and what to do.
    pub fn of_text(
        name: &str,
        text: &str,
        language: Language,
        files: Option<Arc<dyn Files>>,
        limits: &Limits,
        assets: &Assets,
    ) -> Result<Document, Failed> {
        let mut budget = LoadBudget::new(limits);
        let length = text.len() as u64;
        let room = if length > limits.file_bytes {
            let most = limits.file_bytes;
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
        let text = text.to_string();
        Document::read(name, None, text, language, files, limits, budget, assets)
    }

    #[allow(clippy::too_many_arguments, reason = "one call of each way to begin")]
    fn read(
        name: &str,
        path: Option<PathBuf>,
        text: String,
        language: Language,
        source: Option<Arc<dyn Files>>,
        limits: &Limits,
        budget: LoadBudget,
        assets: &Assets,
    ) -> Result<Document, Failed> {
        let text = without_mark(text);
        let files = Reading::new(source, limits.files.saturating_sub(1), budget, assets);
        let read = || match language {
            Language::Starlark => starlark(name, text, files, limits),
            Language::Json => Ok((Body::Json(Source::new(name, &text)), files)),
        };
        let (body, mut files) = on_a_deep_stack(read)
            .and_then(|result| result)
            .map_err(|failed| failed.of(path.as_deref()))?;
        Ok(Document {
            name: name.to_owned(),
            path,
            body,
            cache: std::mem::take(&mut files.cache),
            files,
        })
    }

    /// The scene; with what it is at other moments, where those are wanted.
    ///
    /// # Errors
    /// Everything that can be wrong with it, with the place and what to do.
    pub fn scene(&mut self, options: &Options) -> Result<Loaded, Failed> {
        let loaded = self.scene_at(options)?;
        let Shutter { seconds, moments } = loaded.shutter;
        if !(options.moments && loaded.animated && seconds > 0.0) {
            return Ok(loaded);
        }
        let at = |k: u32| Options {
            time: options.time + seconds * (f64::from(k) + 0.5) / f64::from(moments),
            ..options.clone()
        };
        let scenes = (0..moments).map(|k| self.scene_at(&at(k)).map(|moment| moment.scene));
        let scenes = scenes.collect::<Result<Vec<_>, Failed>>()?;
        match loaded.scene.with_moments(scenes) {
            Ok(scene) => Ok(Loaded { scene, ..loaded }),
            Err(error) => Err(Failed {
                report: Report::new(error.to_string()).into(),
                files: loaded.files,
            }),
        }
    }

    /// The scene at one time.
    fn scene_at(&mut self, options: &Options) -> Result<Loaded, Failed> {
        let limits = &options.limits;
        let budget = self.files.budget.again(limits);
        let cache = std::mem::take(&mut self.cache);
        let most = limits.files.saturating_sub(1);
        let files = self.files.again(most, budget, cache);
        let (body, name) = (&self.body, self.name.as_str());
        let run = || match body {
            Body::Starlark { modules, sources } => {
                let draft = Draft::new(options, files, sources.clone());
                let (draft, result) = starlark::run(modules, draft, limits, budget.start());
                let result = result.map_err(|m| m.report(&draft.sources).into());
                (draft, result)
            }
            Body::Json(source) => {
                let mut draft = Draft::new(options, files, vec![source.clone()]);
                let result =
                    json::read(&mut draft, limits).and_then(|()| match draft.unknown_parameter() {
                        None => Ok(()),
                        Some((message, help)) => Err(Report::new(message).with_help(help).into()),
                    });
                (draft, result)
            }
        };
        let finished = on_a_deep_stack(|| {
            let (mut draft, result) = run();
            if result.is_ok() && !options.bare {
                draft.welcome(!options.floorless);
            }
            let cache = std::mem::take(&mut draft.files.cache);
            (finish(name, draft, result, limits), cache)
        });
        let result = match finished {
            Ok((result, cache)) => {
                self.cache = cache;
                result
            }
            Err(failed) => Err(failed),
        };
        match (result, &self.path) {
            (Ok(loaded), Some(path)) => Ok(Loaded {
                files: with_own(path, loaded.files),
                ..loaded
            }),
            (Ok(loaded), None) => Ok(loaded),
            (Err(failed), path) => Err(failed.of(path.as_deref())),
        }
    }
}

impl Failed {
    /// With the scene's own file first.
    fn of(self, path: Option<&Path>) -> Failed {
        match path {
            Some(path) => Failed {
                files: with_own(path, self.files),
                ..self
            },
            None => self,
        }
    }
}

fn with_own(path: &Path, mut files: Vec<PathBuf>) -> Vec<PathBuf> {
    files.insert(0, path.to_path_buf());
    files
}

/// Runs what may call itself as deep as the limits allow: on a thread that has a stack for it. A browser has no threads, and
/// runs it where it is.
#[allow(
    clippy::disallowed_methods,
    reason = "a thread only where there are threads"
)]
pub(crate) fn on_a_deep_stack<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Failed> {
    if cfg!(target_family = "wasm") {
        return Ok(work());
    }
    let failed = |report: Report| Failed {
        report: report.into(),
        files: Vec::new(),
    };
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new()
            .name("scene".into())
            .stack_size(starlark::depth::STACK)
            .spawn_scoped(scope, work)
            .map_err(|e| failed(Report::new(format!("cannot start a thread: {e}"))))?;
        thread.join().map_err(|_| failed(Report::of_a_bug()))
    })
}

/// A text without the byte order mark that some editors put in front of it, and that says nothing in UTF-8.
fn without_mark(text: String) -> String {
    match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_string(),
        None => text,
    }
}

fn starlark(
    name: &str,
    text: String,
    files: Reading,
    limits: &Limits,
) -> Result<(Body, Reading), Failed> {
    let mut loader = Loader {
        files,
        sources: Vec::new(),
        modules: Vec::new(),
        names: BTreeMap::new(),
        limits: *limits,
    };
    // the scene's own file, if it is one
    let own = loader.files.real(name);
    let own = own.unwrap_or_else(|| PathBuf::from(name));
    if let Err(m) = loader.module(name, own, text) {
        let report = m.report(&loader.sources).into();
        let files = loader.files.into_loaded();
        return Err(Failed { report, files });
    }
    let (modules, sources) = (loader.modules, loader.sources);
    Ok((Body::Starlark { modules, sources }, loader.files))
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
    let shutter = draft
        .view
        .as_ref()
        .map_or_else(Shutter::default, |view| Shutter {
            seconds: view.shutter,
            moments: view.moments,
        });
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
            shutter,
            files,
            log,
            warnings,
        }),
        Err(report) => Err(Failed { report, files }),
    }
}

/// Parses a file and all that it loads.
struct Loader {
    files: Reading,
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
        let name = Reading::normal(path).map_err(wrong)?;
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

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "r = slider(\"r\", 0.5)\nload(\"part.star\", \"part\")\n\
                         show(part(r), material(color = triplanar(\"tile.png\")))\n";

    fn image(loaded: &Loaded) -> std::sync::Arc<zeroset_scene::material::Image> {
        let found = loaded
            .scene
            .materials()
            .iter()
            .find_map(|m| match &m.pattern {
                zeroset_scene::material::Pattern::Triplanar { image, .. } => Some(image.clone()),
                _ => None,
            });
        found.unwrap()
    }

    /// A slider reads no file: they may all be gone.
    #[test]
    fn a_parameter_needs_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("main.star");
        std::fs::write(&path, SCENE).unwrap();
        let part = folder.path().join("part.star");
        std::fs::write(&part, "def part(r):\n    return sphere(r)\n").unwrap();
        let tile = folder.path().join("tile.png");
        image::RgbImage::new(8, 8).save(&tile).unwrap();
        let assets = Assets::default();
        let limits = Limits::default();
        let mut document = Document::open(&path, &limits, &assets).unwrap();
        let first = document.scene(&Options::default()).unwrap();
        assert_eq!(first.files.len(), 3);
        for file in [&path, &part, &tile] {
            std::fs::remove_file(file).unwrap();
        }
        let options = Options {
            set: [("r".to_owned(), "0.75".to_owned())].into(),
            ..Options::default()
        };
        let second = document.scene(&options).unwrap();
        assert_eq!(second.files, first.files);
        assert!(std::sync::Arc::ptr_eq(&image(&first), &image(&second)));
        let size = |loaded: &Loaded| loaded.scene.finite_bounds().unwrap().half()[0];
        assert_eq!((size(&first), size(&second)), (0.5, 0.75));
    }

    /// An image whose content is the same is not decoded again when the scene is read again, one that changed is.
    #[test]
    fn assets_outlive_documents() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("main.star");
        let tile = folder.path().join("tile.png");
        std::fs::write(
            &path,
            "show(sphere(), material(color = triplanar(\"tile.png\")))",
        )
        .unwrap();
        image::RgbImage::new(8, 8).save(&tile).unwrap();
        let (assets, limits) = (Assets::default(), Limits::default());
        let read = || {
            let mut document = Document::open(&path, &limits, &assets).unwrap();
            document.scene(&Options::default()).unwrap()
        };
        let (first, second) = (read(), read());
        assert!(std::sync::Arc::ptr_eq(&image(&first), &image(&second)));
        image::RgbImage::new(9, 8).save(&tile).unwrap();
        assert_eq!(image(&read()).width, 9);
    }
}
