//! `zeroset render`: one picture, many frames, or again on every save.

mod again;
mod animate;
pub(crate) mod digest;
mod ffmpeg;
mod job;
mod limited;
mod progressive;
mod summary;
mod target;
mod watch;

use crate::args::RenderArgs;
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::make_folder;
use crate::interrupt;
use job::Job;
use std::time::Instant;
use target::Container;

/// Renders.
pub(crate) fn run(args: &RenderArgs, console: &Console) -> Result<(), Failure> {
    let args = &again::followed(args, console)?;
    let job = Job::new(args, console)?;
    let clip = match &args.output {
        Some(path) => match Container::of(path)? {
            Container::Clip(clip) => Some((path.as_path(), clip)),
            Container::Png | Container::Exr => None,
        },
        None => None,
    };
    match (&args.frames, clip) {
        (None, Some((path, _))) => Err(Failure::with_help(
            Exit::Usage,
            format!("{} is an animation", path.display()),
            "say which frames it has, for example --frames 0..60",
        )),
        (Some(frames), Some((path, clip))) => {
            animate::run(&job, path, clip, &frames.0, &|_| Ok(()))
        }
        _ if args.watch => watch::run(&job),
        (Some(frames), None) => run_frames(&job, frames.0.clone()),
        (None, None) => {
            let loaded = crate::scene::loaded(&args.scene, &job.options, console)?;
            match job.render(&loaded, &job.options, None, &interrupt::requested)? {
                Some(unfinished) => Err(unfinished),
                None => Ok(()),
            }
        }
    }
}

/// Renders an animation for a window: as [`run`] does with the same arguments, with a scene that is changed before each frame.
#[cfg(feature = "window")]
pub(crate) fn run_animation(
    args: &RenderArgs,
    prepare: animate::Prepare<'_>,
    console: &Console,
) -> Result<(), Failure> {
    let job = Job::new(args, console)?;
    match (&args.frames, &args.output) {
        (Some(frames), Some(path)) => match Container::of(path)? {
            Container::Clip(clip) => animate::run(&job, path, clip, &frames.0, prepare),
            Container::Png | Container::Exr => Err(Failure::new(
                Exit::Usage,
                "end the name in .gif, .apng, .mp4, .webm or .y4m",
            )),
        },
        _ => Err(Failure::new(
            Exit::Usage,
            "an animation has frames and a name",
        )),
    }
}

/// Renders frame by frame, each at its own time.
fn run_frames(job: &Job<'_>, frames: std::ops::Range<u32>) -> Result<(), Failure> {
    let start = Instant::now();
    let (count, mut unfinished) = (frames.len(), false);
    if let Some(path) = &job.args.output {
        make_folder(path)?;
    }
    let mut document = crate::scene::document(&job.args.scene, &job.options)?;
    for frame in frames.clone() {
        if interrupt::requested() {
            return Err(Failure::silent(Exit::Interrupted));
        }
        let mut options = job.options.clone();
        options.time += f64::from(frame) / job.args.fps;
        let scene = &job.args.scene;
        let loaded = crate::scene::evaluated(scene, &mut document, &options, job.console)?;
        if frame == frames.start && count > 1 && !loaded.animated {
            job.console
                .note("The scene does not use time(): all frames will be the same.");
        }
        let place = Some((frame, &frames));
        if let Some(lack) = job.render(&loaded, &options, place, &interrupt::requested)? {
            job.console.failure(&lack);
            unfinished = true;
        }
    }
    job.console.note(format_args!(
        "{count} frames in {:.1} s",
        start.elapsed().as_secs_f64()
    ));
    if unfinished {
        return Err(Failure::silent(Exit::Unfinished));
    }
    Ok(())
}
