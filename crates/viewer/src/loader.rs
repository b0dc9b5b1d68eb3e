//! The thread that loads: the scene again for every change of time or of a slider, and whenever a file is saved. It writes values
//! back into the file too, so that reading and writing never meet.

use std::collections::BTreeMap;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use zeroset_language::assets::Assets;
use zeroset_language::document::Document;
use zeroset_language::load::{Control, Failed, Loaded, Options, Parameter};
use zeroset_language::report::Report;
use zeroset_language::revision::{Change, Revision, revise_file};
use zeroset_language::watch::{PAUSE, Watched};
use zeroset_output::atomic::write_atomically;

/// What a person is told of a scene that cannot be loaded.
pub type Explain = fn(&Failed) -> String;

/// What loading gave.
#[derive(Debug)]
pub struct Outcome {
    /// What it was asked for, without parameters that a new version of the file no longer has.
    pub options: Options,
    /// Whether a file was saved, rather than a parameter moved.
    pub is_edit: bool,
    /// The scene, or what is wrong with it.
    pub result: Result<Arc<Loaded>, String>,
}

/// What became of values that were to be written into the file, or why none was.
pub type Written = Result<Revision, String>;

/// What the thread is asked for.
enum Ask {
    /// The scene with these options.
    Load(Options),
    /// What parameters are set to, and other changes, to be put into the file.
    Write(Options, Vec<Change>),
}

/// What the thread says.
enum Answer {
    Loaded(Outcome),
    Written(Written),
}

/// The window's end of the thread that loads.
pub struct Loader {
    ask: Sender<Ask>,
    outcomes: Receiver<Outcome>,
    written: Receiver<Written>,
}

impl Loader {
    /// Starts the thread, which loads the scene at once. It ends with the loader. `wake` is called whenever there is an
    /// outcome to take.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(
        path: PathBuf,
        options: Options,
        explain: Explain,
        assets: Assets,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Loader> {
        let (ask, asked) = channel();
        let (tell, outcomes) = channel();
        let (confirm, written) = channel();
        let work = move || {
            let mut watcher = Watcher::new(path, options, explain, assets);
            while let Some(answer) = watcher.next(&asked) {
                let is_heard = match answer {
                    Answer::Loaded(outcome) => tell.send(outcome).is_ok(),
                    Answer::Written(written) => confirm.send(written).is_ok(),
                };
                if !is_heard {
                    return;
                }
                wake();
            }
        };
        std::thread::Builder::new()
            .name("loader".into())
            .spawn(work)?;
        Ok(Loader {
            ask,
            outcomes,
            written,
        })
    }

    /// Asks for the scene with other parameters or at another time.
    pub fn ask(&self, options: Options) {
        // a thread that is gone has said why
        let _ = self.ask.send(Ask::Load(options));
    }

    /// Asks for what parameters are set to, and other changes, to be written into the file. What is there then is loaded as after
    /// any other save.
    pub fn write(&self, options: Options, changes: Vec<Change>) {
        // a thread that is gone has said why
        let _ = self.ask.send(Ask::Write(options, changes));
    }

    /// What became of a write, once.
    pub fn take_written(&self) -> Option<Written> {
        self.written.try_recv().ok()
    }

    /// The next outcome, if there is one.
    pub fn take(&self) -> Option<Outcome> {
        self.outcomes.try_recv().ok()
    }

    /// As [`Loader::take`], and waits for it.
    pub fn wait(&self, most: std::time::Duration) -> Option<Outcome> {
        self.outcomes.recv_timeout(most).ok()
    }
}

/// The thread's side.
struct Watcher {
    path: PathBuf,
    options: Options,
    explain: Explain,
    watched: Watched,
    is_first: bool,
    assets: Assets,
    /// The files as they were read last; none where they could not be.
    document: Option<Document>,
    /// What was asked for after what is being done.
    next: Option<Ask>,
}

impl Watcher {
    fn new(path: PathBuf, options: Options, explain: Explain, assets: Assets) -> Watcher {
        Watcher {
            watched: Watched::of([path.clone()]),
            path,
            options,
            explain,
            is_first: true,
            assets,
            document: None,
            next: None,
        }
    }

    /// Waits until there is something to load, and loads it. `None` where nobody waits any more.
    fn next(&mut self, asked: &Receiver<Ask>) -> Option<Answer> {
        if std::mem::take(&mut self.is_first) {
            return Some(Answer::Loaded(self.load(false)));
        }
        loop {
            let ask = match self.next.take() {
                Some(ask) => Ok(ask),
                None => asked.recv_timeout(PAUSE),
            };
            match ask {
                Ok(Ask::Load(options)) => {
                    self.options = options;
                    // of many moves of a slider the last one counts
                    for ask in asked.try_iter() {
                        match ask {
                            Ask::Load(options) => self.options = options,
                            Ask::Write(..) => {
                                self.next = Some(ask);
                                break;
                            }
                        }
                    }
                    return Some(Answer::Loaded(self.load(false)));
                }
                Ok(Ask::Write(options, changes)) => {
                    return Some(Answer::Written(self.write(&options, &changes)));
                }
                Err(RecvTimeoutError::Disconnected) => return None,
                Err(RecvTimeoutError::Timeout) => {}
            }
            if self.watched.changed() {
                self.watched = self.watched.settled();
                return Some(Answer::Loaded(self.load(true)));
            }
        }
    }

    /// Writes values into the file, which is then seen to have changed.
    fn write(&self, options: &Options, changes: &[Change]) -> Written {
        let work = || revise_file(&self.path, options, changes, &self.assets);
        let revised = catch_unwind(AssertUnwindSafe(work))
            .map_err(|_| "the writer broke down; please report this scene as a bug".to_owned())?
            .map_err(|failed| failed.to_string())?;
        if revised.is_changed() {
            let text = revised.revision.text.as_bytes();
            write_atomically(&self.path, |writer| writer.write_all(text))
                .map_err(|e| format!("{e}; {}", e.advice()))?;
        }
        Ok(revised.revision)
    }

    /// Loads the scene. A fault of this program is a mistake in this scene, and the next one is waited for.
    fn attempt(&mut self, options: &Options) -> Result<Loaded, Failed> {
        let work = || {
            let document = match self.document.take() {
                Some(document) => document,
                None => Document::open(&self.path, &options.limits, &self.assets)?,
            };
            self.document.insert(document).scene(options)
        };
        catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
            let said = "the scene loader broke down; please report this scene as a bug";
            Err(Failed {
                report: Box::new(Report::new(said)),
                files: vec![self.path.clone()],
            })
        })
    }

    fn load(&mut self, is_edit: bool) -> Outcome {
        if is_edit {
            self.document = None;
        }
        let options = self.options.clone();
        let mut result = self.attempt(&options);
        if is_edit && result.is_err() && !self.options.set.is_empty() {
            // a parameter that was moved may be gone from the file, or have another range
            let plain = Options {
                set: BTreeMap::new(),
                ..self.options.clone()
            };
            if let Ok(loaded) = self.attempt(&plain) {
                self.options.set.retain(|name, text| {
                    let parameter = loaded.parameters.iter().find(|p| p.name == *name);
                    parameter.is_some_and(|p| takes(p, text))
                });
                let options = self.options.clone();
                result = self.attempt(&options);
            }
        }
        let files = match &result {
            Ok(loaded) => loaded.files.clone(),
            Err(failed) => failed.files.clone(),
        };
        self.watched = self.watched.with(files);
        Outcome {
            options: self.options.clone(),
            is_edit,
            result: match result {
                Ok(loaded) => Ok(Arc::new(loaded)),
                Err(failed) => Err((self.explain)(&failed)),
            },
        }
    }
}

/// Whether a parameter can still be what it was set to.
fn takes(parameter: &Parameter, text: &str) -> bool {
    match &parameter.control {
        Control::Slider { min, max } => text
            .parse::<f64>()
            .is_ok_and(|x| (*min..=*max).contains(&x)),
        Control::Choice { options } => options.iter().any(|o| o == text),
        Control::Toggle => matches!(text, "true" | "false"),
        Control::Colour => text.starts_with('#'),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn patience() -> Duration {
        Duration::from_secs(60)
    }

    fn started(text: &str) -> (tempfile::TempDir, PathBuf, Loader) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.star");
        std::fs::write(&path, text).unwrap();
        let set = Options::default();
        let assets = Assets::default();
        let loader = Loader::start(path.clone(), set, |f| f.to_string(), assets, || {}).unwrap();
        (folder, path, loader)
    }

    const BALL: &str = "r = slider(\"r\", 0.5)\nshow(sphere(r))\n";

    fn set(name: &str, value: &str) -> Options {
        Options {
            set: [(name.to_owned(), value.to_owned())].into(),
            ..Options::default()
        }
    }

    #[test]
    fn every_save_is_loaded_and_what_is_wrong_is_said() {
        let (_folder, path, loader) = started(BALL);
        let first = loader.wait(patience()).unwrap();
        assert!(!first.is_edit && first.result.is_ok());

        std::fs::write(&path, "show(spher(0.5))\n").unwrap();
        let broken = loader.wait(patience()).unwrap();
        assert!(broken.is_edit && broken.result.unwrap_err().contains("spher"));

        std::fs::write(&path, "show(box(0.5))\nshow(sphere(1))\n").unwrap();
        let mended = loader.wait(patience()).unwrap();
        // both, and the floor of scenes that say nothing but what is shown
        assert_eq!(mended.result.unwrap().scene.objects().len(), 3);
        assert!(loader.wait(Duration::from_millis(300)).is_none());
    }

    #[test]
    fn sliders_are_kept_over_a_save_as_far_as_they_fit() {
        let (_folder, path, loader) = started(BALL);
        loader.wait(patience()).unwrap();
        loader.ask(set("r", "0.75"));
        let moved = loader.wait(patience()).unwrap();
        assert!(!moved.is_edit && moved.result.is_ok());

        std::fs::write(&path, format!("{BALL}show(plane())\n")).unwrap();
        let edited = loader.wait(patience()).unwrap();
        assert!(edited.is_edit && edited.options == set("r", "0.75"));

        let narrower = "r = slider(\"r\", 0.2, max = 0.5)\nshow(sphere(r))\n";
        std::fs::write(&path, narrower).unwrap();
        let edited = loader.wait(patience()).unwrap();
        assert!(edited.result.is_ok() && edited.options.set.is_empty());
    }

    #[test]
    fn what_the_window_writes_is_loaded_as_any_other_save() {
        let (_folder, path, loader) = started(BALL);
        loader.wait(patience()).unwrap();
        loader.ask(set("r", "0.75"));
        assert!(!loader.wait(patience()).unwrap().is_edit);
        loader.write(set("r", "0.75"), Vec::new());
        let edited = loader.wait(patience()).unwrap();
        assert!(edited.is_edit);
        let loaded = edited.result.unwrap();
        assert_eq!(loaded.parameters[0].value, loaded.parameters[0].default);
        let written = loader.take_written().unwrap().unwrap();
        assert_eq!(
            (written.written, written.left),
            (vec!["`r`".to_owned()], vec![])
        );
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, BALL.replace("0.5", "0.75"));
        // once, and a file that says it already is not touched
        assert!(loader.wait(Duration::from_millis(300)).is_none());
        loader.write(set("r", "0.75"), Vec::new());
        assert!(loader.wait(Duration::from_millis(500)).is_none());
        assert!(loader.take_written().unwrap().unwrap().left.is_empty());
    }

    #[test]
    fn a_parameter_that_never_was_is_an_error() {
        let (_folder, _path, loader) = started(BALL);
        loader.wait(patience()).unwrap();
        loader.ask(set("radius", "1"));
        let outcome = loader.wait(patience()).unwrap();
        assert!(outcome.result.unwrap_err().contains("radius"));
    }
}
