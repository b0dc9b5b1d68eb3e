//! `--watch`: render again whenever a file that the scene loads is saved.
//!
//! Files are looked at ten times a second instead of being subscribed to: that also works on network disks and in
//! containers, survives editors that save by renaming, and cannot miss a save, because what counts is how a file differs
//! from what was rendered.

use super::job::{Job, was_cancelled};
use crate::failure::{Exit, Failure};
use crate::interrupt;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, SystemTime};

/// Time between two looks.
const PAUSE: Duration = Duration::from_millis(100);
/// How long all files must stay as they are before a change counts: some editors write in several steps.
const SETTLED: Duration = Duration::from_millis(50);

/// What a file looked like; `None` where there is none.
type Stamp = Option<(SystemTime, u64, u64)>;

fn stamp(path: &Path) -> Stamp {
    let metadata = fs::metadata(path).ok()?;
    #[cfg(unix)]
    let number = std::os::unix::fs::MetadataExt::ino(&metadata);
    #[cfg(not(unix))]
    let number = 0;
    Some((metadata.modified().ok()?, metadata.len(), number))
}

/// Files with what they looked like.
#[derive(Clone, Debug, PartialEq)]
struct Watched(Vec<(PathBuf, Stamp)>);

impl Watched {
    fn of(files: impl IntoIterator<Item = PathBuf>) -> Watched {
        Watched(
            files
                .into_iter()
                .map(|path| (stamp(&path), path))
                .map(|(stamp, path)| (path, stamp))
                .collect(),
        )
    }

    /// The files of a new load: those that were known before keep what they looked like then.
    fn with(&self, files: Vec<PathBuf>) -> Watched {
        let known = |path: &Path| {
            self.0
                .iter()
                .find(|(p, _)| p == path)
                .map(|(_, stamp)| *stamp)
        };
        let stamped = files
            .into_iter()
            .map(|path| (known(&path).unwrap_or_else(|| stamp(&path)), path));
        Watched(stamped.map(|(stamp, path)| (path, stamp)).collect())
    }

    fn changed(&self) -> bool {
        self.0.iter().any(|(path, before)| stamp(path) != *before)
    }

    /// The same files as they look now, once they stay so.
    fn settled(&self) -> Watched {
        loop {
            let now = Watched::of(self.0.iter().map(|(path, _)| path.clone()));
            thread::sleep(SETTLED);
            if !now.changed() {
                return now;
            }
        }
    }
}

/// Renders until the user stops it. What is wrong with a save is said, and the next one is waited for.
pub(crate) fn run(job: &Job<'_>) -> Result<(), Failure> {
    crate::scene::present(&job.args.scene)?;
    let mut watched = Watched::of([job.args.scene.scene.clone()]);
    loop {
        let files = match crate::scene::attempt(&job.args.scene, &job.options, job.console) {
            Ok(loaded) => {
                watched = watched.with(loaded.files.clone());
                match render_until_changed(job, &loaded, &watched) {
                    // nobody reads standard output any more
                    Err(failure) if failure.exit == Exit::Done => return Ok(()),
                    Err(failure) => say(job, &failure),
                    Ok(()) => {}
                }
                loaded.files
            }
            Err(failed) => {
                let files = failed.files.clone();
                say(job, &failed.into());
                files
            }
        };
        watched = watched.with(files);
        job.console.note(format_args!(
            "Waiting for a change of {} (Ctrl-C ends)",
            names(&watched)
        ));
        while !watched.changed() {
            if interrupt::requested() {
                return Ok(());
            }
            thread::sleep(PAUSE);
        }
        watched = watched.settled();
    }
}

/// Renders, and gives up when a file changes meanwhile.
fn render_until_changed(
    job: &Job<'_>,
    loaded: &zeroset_scene::load::Loaded,
    watched: &Watched,
) -> Result<(), Failure> {
    let (done, outdated) = (AtomicBool::new(false), AtomicBool::new(false));
    thread::scope(|scope| {
        let looking = scope.spawn(|| {
            while !done.load(Ordering::Relaxed) && !outdated.load(Ordering::Relaxed) {
                outdated.store(watched.changed(), Ordering::Relaxed);
                thread::park_timeout(PAUSE);
            }
        });
        let cancelled = || interrupt::requested() || outdated.load(Ordering::Relaxed);
        let result = job.render(loaded, &job.options, None, &cancelled);
        done.store(true, Ordering::Relaxed);
        looking.thread().unpark();
        result
    })
}

fn say(job: &Job<'_>, failure: &Failure) {
    if let (false, Some(report)) = (was_cancelled(failure), &failure.report) {
        job.console.report(report.as_ref());
    }
}

fn names(watched: &Watched) -> String {
    let names: Vec<_> = watched
        .0
        .iter()
        .filter_map(|(path, _)| path.file_name())
        .map(|n| n.to_string_lossy())
        .collect();
    match names.as_slice() {
        [one] => one.to_string(),
        [first, rest @ ..] => format!("{first} and {} more", rest.len()),
        [] => String::new(),
    }
}
