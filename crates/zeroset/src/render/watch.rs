//! `--watch`: render again whenever a file that the scene loads is saved.

use super::job::{Job, was_cancelled};
use crate::failure::{Exit, Failure};
use crate::interrupt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use zeroset_scene::watch::{PAUSE, Watched};

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
