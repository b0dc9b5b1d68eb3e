//! `--frames` to one file: an animation.

use super::ffmpeg::Encoder;
use super::job::Job;
use super::target::{Clip, STDOUT};
use crate::failure::{Exit, Failure};
use crate::file::make_folder;
use crate::interrupt::{self, Asking};
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;
use std::time::Instant;
use zeroset_language::load::Loaded;
use zeroset_output::atomic::{probe, write_atomically};
use zeroset_output::display;
use zeroset_output::format::animation::{self, Animation, Kind, Timing};

/// What is done with the scene of each frame before it is rendered; where that fails, the animation ends.
pub(crate) type Prepare<'a> = &'a dyn Fn(&mut Loaded) -> Result<(), Failure>;

/// Renders all frames into one file.
pub(crate) fn run(
    job: &Job<'_>,
    path: &Path,
    clip: Clip,
    frames: &Range<u32>,
    prepare: Prepare<'_>,
) -> Result<(), Failure> {
    let start = Instant::now();
    let is_piped = path == Path::new(STDOUT);
    if is_piped && job.args.json {
        let message = "standard output holds the frames: --json has no place there";
        return Err(Failure::new(Exit::Usage, message));
    }
    if let Clip::Video(_) = clip {
        Encoder::check(path)?;
    }
    if !is_piped {
        make_folder(path)?;
        probe(path)?;
    }
    let _asking = Asking::begin();
    let mut movie = Movie {
        job,
        path,
        frames,
        prepare,
        document: crate::scene::document(&job.args.scene, &job.options)?,
        unfinished: false,
    };
    let mut failed = None;
    let written = match clip {
        Clip::Own(kind) if is_piped => {
            let stdout = io::stdout().lock();
            movie.write_into(kind, io::BufWriter::new(stdout), &mut failed)
        }
        Clip::Own(kind) => {
            let written =
                write_atomically(path, |writer| movie.write_into(kind, writer, &mut failed));
            match failed.take() {
                Some(failure) => return Err(failure),
                None => Ok(written?),
            }
        }
        Clip::Video(codec) => {
            let mut encoder: Option<Encoder> = None;
            movie.each(|frame, size| {
                if encoder.is_none() {
                    encoder = Some(Encoder::begin(codec, size, job.args.fps)?);
                }
                encoder.as_mut().map_or(Ok(()), |e| e.push(frame))
            })?;
            if let Some(encoder) = encoder {
                let bytes = encoder.finish()?;
                write_atomically(path, |writer| writer.write_all(&bytes))?;
            }
            Ok(())
        }
    };
    if let Some(failure) = failed {
        return Err(failure);
    }
    match written {
        // who reads a pipe may have seen enough
        Err(error) if is_piped && error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
        Err(error) => return Err(Failure::new(Exit::File, error.to_string())),
        Ok(()) => {}
    }
    let name = path.to_string_lossy();
    job.console.note(format_args!(
        "{}: {} frames, {:.2} s long, in {:.1} s",
        if is_piped {
            "standard output".into()
        } else {
            display::name(&name, display::NAME)
        },
        frames.len(),
        frames.len() as f64 / job.args.fps,
        start.elapsed().as_secs_f64()
    ));
    if movie.unfinished {
        return Err(Failure::silent(Exit::Unfinished));
    }
    Ok(())
}

/// A scene, frame by frame.
struct Movie<'a, 'j> {
    job: &'a Job<'j>,
    path: &'a Path,
    frames: &'a Range<u32>,
    prepare: Prepare<'a>,
    document: zeroset_language::document::Document,
    unfinished: bool,
}

impl Movie<'_, '_> {
    /// Renders all frames, and hands each on with its size.
    fn each(
        &mut self,
        mut take: impl FnMut(&[u8], [u32; 2]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let job = self.job;
        let mut first: Option<[u32; 2]> = None;
        for number in self.frames.clone() {
            if interrupt::requested() {
                return Err(Failure::silent(Exit::Interrupted));
            }
            let mut options = job.options.clone();
            options.time += f64::from(number) / job.args.fps;
            let scene = &job.args.scene;
            let mut loaded =
                crate::scene::evaluated(scene, &mut self.document, &options, job.console)?;
            (self.prepare)(&mut loaded)?;
            if number == self.frames.start && self.frames.len() > 1 && !loaded.animated {
                job.console
                    .note("The scene does not use time(): all frames will be the same.");
            }
            let (pixels, lack) = job.frame(&loaded, &options, self.path, (number, self.frames))?;
            // that of a legend may change with its numbers, that of a scene with time
            let size = pixels.size;
            let wanted = *first.get_or_insert(size);
            if size != wanted {
                let ([w, h], [a, b]) = (size, wanted);
                let message = format!(
                    "frame {number} has {w}x{h} pixels, the first one has {a}x{b}: an animation has one size"
                );
                let help = "ask for one with --size, or leave the legend out with --no-legend";
                return Err(Failure::with_help(Exit::Scene, message, help));
            }
            if let Some(lack) = lack {
                job.console.failure(&lack);
                self.unfinished = true;
            }
            take(&pixels.bytes, size)?;
        }
        Ok(())
    }

    /// Renders all frames into an animation. Where a frame fails, why is left in `failed`.
    fn write_into<W: Write>(
        &mut self,
        kind: Kind,
        writer: W,
        failed: &mut Option<Failure>,
    ) -> io::Result<()> {
        let (frames, rate) = (self.frames.len() as u32, self.job.args.fps);
        let memory = self.job.options.limits.memory;
        let mut writer = Some(writer);
        let mut animation: Option<Animation<W>> = None;
        let done = self.each(|frame, size| {
            if let Some(writer) = writer.take() {
                let timing = Timing { size, frames, rate };
                refuse(kind, &timing, memory)?;
                animation = Some(Animation::new(writer, kind, timing).map_err(|e| unwritten(&e))?);
            }
            match &mut animation {
                Some(animation) => animation.push(frame).map_err(|e| unwritten(&e)),
                None => Ok(()),
            }
        });
        if let Err(failure) = done {
            *failed = Some(failure);
            return Err(io::Error::other("a frame failed"));
        }
        animation.map_or(Ok(()), Animation::finish)
    }
}

/// Refuses what a kind of file cannot hold, or what would take too much memory.
fn refuse(kind: Kind, timing: &Timing, memory: u64) -> Result<(), Failure> {
    animation::check(kind, timing).map_err(|why| Failure::new(Exit::Usage, why))?;
    let bytes = animation::bytes(kind, timing);
    if bytes <= memory {
        return Ok(());
    }
    let mib = |bytes: u64| bytes >> 20;
    let [width, height] = timing.size;
    Err(Failure::with_help(
        Exit::Usage,
        format!(
            "{} frames of {width}x{height} pixels take {} MiB of memory until their colours are chosen, at most {} are allowed",
            timing.frames,
            mib(bytes),
            mib(memory)
        ),
        "ask for a smaller size, write .apng or .mp4, or raise the limit: --limit memory=...",
    ))
}

fn unwritten(error: &io::Error) -> Failure {
    // who reads a pipe may have seen enough
    if error.kind() == io::ErrorKind::BrokenPipe {
        return Failure::silent(Exit::Done);
    }
    Failure::new(Exit::File, error.to_string())
}
