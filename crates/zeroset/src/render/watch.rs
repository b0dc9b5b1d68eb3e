//! `--watch`: render again whenever a file that the scene loads is saved.

use super::job::{Job, was_cancelled};
use crate::failure::{Exit, Failure};
use crate::interrupt::{self, Asking};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use zeroset_language::load::Loaded;
use zeroset_language::watch::{PAUSE, Watched};

/// A picture that a change outdated is left alone for as long as this, the first time in a row; then twice as long.
const GRACE: Duration = Duration::from_millis(250);
/// Changes that are farther apart than this are not in a row: a person saves again when something was seen.
const ROW: Duration = Duration::from_secs(2);

/// Renders until the user stops it. What is wrong with a save is said, and the next one is waited for.
pub(crate) fn run(job: &Job<'_>) -> Result<(), Failure> {
    crate::scene::present(&job.args.scene)?;
    let _asking = Asking::begin();
    let mut watched = Watched::of([job.args.scene.scene.clone()]);
    let mut patience = Patience::default();
    loop {
        let files = match crate::scene::attempt(&job.args.scene, &job.options, job.console) {
            Ok(loaded) => {
                watched = watched.with(loaded.files.clone());
                match render_until_changed(job, &loaded, &watched, &mut patience) {
                    // nobody reads standard output any more
                    Err(failure) if failure.exit == Exit::Done => return Ok(()),
                    Err(failure) => say(job, &failure),
                    Ok(unfinished) => unfinished.iter().for_each(|lack| say(job, lack)),
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
        if interrupt::requested() {
            return Ok(());
        }
        if !watched.changed() {
            job.console.note(format_args!(
                "Waiting for a change of {} (Ctrl-C ends)",
                names(&watched)
            ));
        }
        while !watched.changed() {
            if interrupt::requested() {
                return Ok(());
            }
            thread::sleep(PAUSE);
        }
        watched = watched.settled();
    }
}

/// How long a rendering is left alone though it is outdated. A person who saves wants the new picture at once; of files
/// that change all the time there would never be one.
#[derive(Clone, Copy, Debug, Default)]
struct Patience {
    grace: Duration,
}

impl Patience {
    /// After a rendering that was ended by a change that was seen so long after it began.
    fn ended(&mut self, seen: Duration) {
        self.grace = if seen < ROW.max(self.grace) {
            (2 * self.grace).max(GRACE)
        } else {
            Duration::ZERO
        };
    }
}

/// Renders, and gives up when a file changes meanwhile.
fn render_until_changed(
    job: &Job<'_>,
    loaded: &Loaded,
    watched: &Watched,
    patience: &mut Patience,
) -> Result<Option<Failure>, Failure> {
    let (done, outdated) = (AtomicBool::new(false), AtomicBool::new(false));
    let (began, grace) = (Instant::now(), patience.grace);
    let seen = OnceLock::new();
    let result = thread::scope(|scope| {
        let looking = scope.spawn(|| {
            while !done.load(Ordering::Relaxed) && !outdated.load(Ordering::Relaxed) {
                if seen.get().is_some() || watched.changed() {
                    seen.get_or_init(|| began.elapsed());
                    outdated.store(began.elapsed() >= grace, Ordering::Relaxed);
                }
                thread::park_timeout(PAUSE);
            }
        });
        let cancelled = || interrupt::requested() || outdated.load(Ordering::Relaxed);
        let result = job.render(loaded, &job.options, None, &cancelled);
        done.store(true, Ordering::Relaxed);
        looking.thread().unpark();
        result
    });
    if result.as_ref().is_err_and(was_cancelled) {
        patience.ended(seen.get().copied().unwrap_or_default());
    } else {
        *patience = Patience::default();
    }
    result
}

fn say(job: &Job<'_>, failure: &Failure) {
    if !was_cancelled(failure) {
        job.console.failure(failure);
    }
}

fn names(watched: &Watched) -> String {
    let names: Vec<_> = watched
        .files()
        .filter_map(|path| path.file_name())
        .map(|n| n.to_string_lossy())
        .collect();
    match names.as_slice() {
        [one] => one.to_string(),
        [first, rest @ ..] => format!("{first} and {} more", rest.len()),
        [] => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patience_grows_in_a_row_only() {
        let (soon, late) = (Duration::from_millis(50), Duration::from_secs(60));
        let mut patience = Patience::default();
        let mut last = patience.grace;
        for _ in 0..12 {
            patience.ended(soon);
            assert!(patience.grace > last);
            last = patience.grace;
        }
        // any picture is finished in the end
        assert!(last > Duration::from_secs(300));
        let mut patience = Patience::default();
        patience.ended(soon);
        patience.ended(late);
        assert_eq!(patience.grace, Duration::ZERO);
    }
}
