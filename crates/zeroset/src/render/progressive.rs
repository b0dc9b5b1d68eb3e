//! `--noise`, `--checkpoint` and `--resume`: pictures that converge, round by round.

use super::digest::Digest;
use crate::args::RenderArgs;
use crate::backend::{ChosenRenderer, Used};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::Progress;
use crate::json;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use zeroset_language::json::expand;
use zeroset_language::load::Loaded;
use zeroset_output::atomic::{probe, write_atomically};
use zeroset_output::display;
use zeroset_output::format::checkpoint::{self, CheckpointFailure, Difference, Identity};
use zeroset_scene::film::Plane;
use zeroset_scene::progressive::{Progressive, USUAL, filter};
use zeroset_scene::render::{Frame, Observer, Prepared, RenderError, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Antialias;

/// The most rays a pixel where `--spp` says nothing.
const MOST_RAYS: u32 = 1 << 16;

/// Whether the flags ask for a picture that converges.
pub(crate) fn is_asked(args: &RenderArgs) -> bool {
    let recipe = args.recipe.as_ref();
    args.noise.is_some() || args.checkpoint.is_some() || recipe.is_some_and(|r| r.rounds)
}

/// When a picture ends, and where it is kept meanwhile.
struct Aim<'a> {
    noise: Option<f64>,
    /// Rays a pixel.
    most: u32,
    limit: Option<Duration>,
    checkpoint: Option<&'a Path>,
    every: Duration,
}

impl Aim<'_> {
    fn of<'a>(args: &'a RenderArgs, scene: &Scene) -> Aim<'a> {
        let stated = match scene.settings().antialias {
            Antialias::Supersample { samples, .. } => samples,
            // what has one ray a pixel, or not rays alone
            _ => 1,
        };
        Aim {
            noise: args.noise,
            most: match (args.noise, args.methods.spp) {
                (Some(_), None) => MOST_RAYS,
                _ => stated,
            },
            // beyond some years a limit is none
            limit: (args.time_limit).map(|s| Duration::from_secs_f64(s.min(1e9))),
            checkpoint: args.checkpoint.as_deref(),
            every: Duration::from_secs_f64(args.checkpoint_every.min(1e9)),
        }
    }

    fn is_reached(&self, picture: &Progressive) -> bool {
        let is_sharp = self.noise.is_some_and(|noise| picture.noise() <= noise);
        is_sharp || picture.samples() >= f64::from(self.most)
    }

    /// How much of the way is done, from 0 to 1.
    fn share(&self, picture: &Progressive) -> f64 {
        let rays = picture.samples() / f64::from(self.most);
        let left = self.noise.and_then(|noise| picture.left(noise));
        left.map_or(rays, |left| rays.max(1.0 / (1.0 + left)))
            .min(1.0)
    }
}

/// A picture that converged, or as far as it got.
pub(crate) struct Converged {
    pub(crate) frame: Frame,
    pub(crate) used: Used,
    /// How wide 95 % intervals are; none before anything is known.
    pub(crate) noise: Option<f64>,
    /// Rays that a pixel has on average, of all runs together.
    pub(crate) samples: f64,
    /// The share that is finished, and why not all of it is, where the time limit ended it.
    pub(crate) lack: Option<(f64, String)>,
}

/// Ends a round when the time is over; a bar shows rounds, not rays.
struct Watching<'a> {
    progress: &'a Progress<'a>,
    end: Option<Instant>,
}

impl Observer for Watching<'_> {
    fn advance(&self, _rays: u64, _total: u64) {}

    fn is_cancelled(&self) -> bool {
        self.progress.is_cancelled() || self.end.is_some_and(|end| Instant::now() >= end)
    }
}

/// Renders until there is little noise, as many rays as were asked for, or no time left.
///
/// # Errors
/// A checkpoint that is of another picture or damaged, or is there and was not asked for; a scene that cannot be rendered; a time limit
/// that ends the first round; `progress` says to stop: then the checkpoint has all finished rounds.
pub(crate) fn render(
    args: &RenderArgs,
    engine: &ChosenRenderer,
    loaded: &Loaded,
    scene: &Scene,
    planes: &[Plane],
    progress: &Progress<'_>,
    console: &Console,
) -> Result<Converged, Failure> {
    let began = Instant::now();
    let (aim, settings) = (Aim::of(args, scene), scene.settings());
    let filter = filter(settings.antialias);
    let mut picture = Progressive::new(
        settings.size,
        filter,
        planes,
        settings.seed,
        settings.exposure,
    );
    let (mut prepared, used) = engine.prepare(scene)?;
    let identity = match aim.checkpoint {
        Some(path) => {
            let identity = identity(loaded, scene, planes, &used)?;
            begin(path, args.resume, &identity, &mut picture, console)?;
            identity
        }
        None => Identity::default(),
    };
    let watching = Watching {
        progress,
        end: aim.limit.map(|limit| began + limit),
    };
    let mut statistics = Statistics::default();
    let (mut kept, mut kept_at) = (picture.rounds(), Instant::now());
    let mut lack = None;
    while !aim.is_reached(&picture) {
        let prepared: &mut dyn Prepared = prepared.as_mut();
        match picture.advance(prepared, scene.camera(), aim.noise, &watching) {
            Ok(more) => statistics = super::limited::sum(&statistics, &more),
            Err(RenderError::Cancelled) => {
                if let Some(path) = aim.checkpoint
                    && picture.rounds() > kept
                {
                    keep(path, &identity, &picture)?;
                }
                if progress.is_cancelled() {
                    if let Some(path) = aim.checkpoint.filter(|_| picture.rounds() > 0) {
                        console.note(format_args!(
                            "What is rendered is in {}: the same command with --resume goes on.",
                            path.display()
                        ));
                    }
                    return Err(Failure::silent(Exit::Interrupted));
                }
                lack = Some(ended(&aim, &picture)?);
                break;
            }
            Err(error) => return Err(error.into()),
        }
        // as many rays as it will take, as far as that is known
        let share = aim.share(&picture).max(1e-6);
        progress
            .bar
            .set_length((picture.rays() as f64 / share) as u64);
        progress.bar.set_position(picture.rays());
        if let Some(path) = aim.checkpoint
            && kept_at.elapsed() >= aim.every
        {
            keep(path, &identity, &picture)?;
            (kept, kept_at) = (picture.rounds(), Instant::now());
        }
    }
    if let Some(path) = aim.checkpoint
        && picture.rounds() > kept
        && lack.is_none()
    {
        keep(path, &identity, &picture)?;
    }
    if let (Some(wanted), None) = (aim.noise, &lack)
        && picture.noise() > wanted
    {
        console.note(format_args!(
            "{:.0} rays a pixel leave a noise of {}, more than {wanted}; --spp allows more.",
            picture.samples(),
            shortened(picture.noise())
        ));
    }
    statistics.seconds = began.elapsed().as_secs_f64();
    Ok(Converged {
        noise: Some(picture.noise()).filter(|noise| noise.is_finite()),
        samples: picture.samples(),
        used: engine.used(),
        frame: Frame {
            film: picture.into_film(),
            statistics,
        },
        lack,
    })
}

/// What a picture lacks that the time limit ended.
fn ended(aim: &Aim<'_>, picture: &Progressive) -> Result<(f64, String), Failure> {
    let seconds = aim.limit.unwrap_or_default().as_secs_f64();
    if picture.rounds() == 0 {
        let message =
            format!("in {seconds} s not even {USUAL} rays a pixel could be taken, a first round");
        let help = "raise --time-limit, or ask for a smaller picture";
        return Err(Failure::with_help(Exit::Unfinished, message, help));
    }
    let rays = picture.samples();
    let words = match aim.noise {
        Some(wanted) => {
            let noise = match picture.noise() {
                noise if noise.is_finite() => format!("a noise of {}", shortened(noise)),
                _ => "too few rays to say how much noise".to_owned(),
            };
            format!(
                "ended by the time limit of {seconds} s: it has {rays:.0} rays a pixel and {noise}, {wanted} was wanted"
            )
        }
        None => format!(
            "ended by the time limit of {seconds} s: it has {rays:.0} of {} rays a pixel",
            aim.most
        ),
    };
    let share = aim.noise.map(|noise| picture.finished(noise));
    Ok((share.unwrap_or(0.0), words))
}

/// Two digits that count.
fn shortened(x: f64) -> String {
    let digits = (1.0 - x.abs().max(1e-9).log10().floor()).clamp(0.0, 9.0);
    format!("{x:.0$}", digits as usize)
}

/// Goes on from a checkpoint where that is asked for and there is one.
fn begin(
    path: &Path,
    resume: bool,
    identity: &Identity,
    picture: &mut Progressive,
    console: &Console,
) -> Result<(), Failure> {
    probe(path)?;
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            if resume {
                console.note(format_args!(
                    "{} is not there yet: the picture begins anew.",
                    path.display()
                ));
            }
            return Ok(());
        }
        _ if !resume => {
            return Err(Failure::with_help(
                Exit::File,
                format!("{} exists already", path.display()),
                "--resume goes on from it; remove it to begin anew",
            ));
        }
        _ => {}
    }
    match checkpoint::resume(path, identity, picture) {
        Ok(()) => {
            console.note(format_args!(
                "Going on from {:.0} rays a pixel in {}.",
                picture.samples(),
                path.display()
            ));
            Ok(())
        }
        Err(error) => {
            let help = match &error.failure {
                CheckpointFailure::Foreign(difference) => told(difference),
                CheckpointFailure::Version(_) => {
                    "go on with the Zeroset that wrote it, or name another file".to_owned()
                }
                CheckpointFailure::Damaged(_) => {
                    "it cannot be mended: remove it, and begin anew".to_owned()
                }
                CheckpointFailure::Format | CheckpointFailure::Special => {
                    "name the file that --checkpoint wrote".to_owned()
                }
                CheckpointFailure::System(_) => "make the file readable".to_owned(),
            };
            Err(Failure::with_help(Exit::File, error.to_string(), help))
        }
    }
}

fn keep(path: &Path, identity: &Identity, picture: &Progressive) -> Result<(), Failure> {
    write_atomically(path, |writer| checkpoint::write(writer, identity, picture))?;
    Ok(())
}

/// What differs, for a person.
fn told(difference: &Difference) -> String {
    let Difference { what, held, wanted } = difference;
    let object = |text: &str| match serde_json::from_str(text) {
        Ok(Value::Object(map)) => Some(map),
        _ => None,
    };
    let go_on = "ask for the same, or name another file";
    if let (Some(held), Some(wanted)) = (object(held), object(wanted)) {
        let null = Value::Null;
        let parts: Vec<String> = (wanted.iter())
            .filter(|(key, value)| held.get(*key) != Some(value))
            .map(|(key, value)| {
                let held = held.get(key).unwrap_or(&null).to_string();
                let held = display::name(&held, 80);
                format!(
                    "{key}: {held} there, {} here",
                    display::name(&value.to_string(), 80)
                )
            })
            .collect();
        return format!("{}; {go_on}", parts.join("; "));
    }
    match *what {
        "scene" => format!("what the scene shows has changed since; {go_on}"),
        _ => format!(
            "{what}: {} there, {} here; {go_on}",
            display::name(held, 80),
            display::name(wanted, 80)
        ),
    }
}

/// What a picture is of and how it is made; how long it is rendered is no part of that.
fn identity(
    loaded: &Loaded,
    scene: &Scene,
    planes: &[Plane],
    used: &Used,
) -> Result<Identity, Failure> {
    let failed = |error: String| Failure::new(Exit::Scene, error);
    let mut all = expand(scene).map_err(|error| failed(error.to_string()))?;
    let mut part = |key: &str| match &mut all {
        Value::Object(map) => map.shift_remove(key).unwrap_or_default(),
        _ => Value::Null,
    };
    let (camera, mut settings) = (part("camera"), part("settings"));
    // a title
    part("name");
    if let Value::Object(settings) = &mut settings {
        settings.shift_remove("size");
        // how sums are shown
        settings.shift_remove("tone");
        if let Some(Value::Object(antialias)) = settings.get_mut("antialias") {
            antialias.shift_remove("samples");
        }
    }
    let mut digest = Digest::new();
    digest.add(all.to_string().as_bytes());
    for moment in scene.moments() {
        let moment = expand(moment).map_err(|error| failed(error.to_string()))?;
        digest.add(moment.to_string().as_bytes());
    }
    for file in data_files(loaded) {
        let bytes = fs::read(&file).map_err(|e| {
            let message = format!("cannot read {}: {e}", file.display());
            Failure::new(Exit::File, message)
        })?;
        digest.add(&bytes);
    }
    let [width, height] = scene.settings().size;
    let names: Vec<&str> = planes.iter().map(|plane| plane.name()).collect();
    Ok(Identity::default()
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("size", format!("{width}x{height}"))
        // how far a camera sees follows from the scene: which of both changed is to be said
        .with("scene", digest.written())
        .with("camera", json::line(&camera)?)
        .with("settings", json::line(&settings)?)
        .with("renderer", used.adapter().unwrap_or("CPU"))
        .with("planes", names.join(" ")))
}

/// The files of a scene that are no scripts: images, and what else it shows.
fn data_files(loaded: &Loaded) -> impl Iterator<Item = PathBuf> {
    let is_script = |path: &&PathBuf| {
        let ending = path.extension().map(|e| e.to_ascii_lowercase());
        ending.is_some_and(|e| e == "star" || e == "json")
    };
    (loaded.files.iter().skip(1))
        .filter(move |path| !is_script(path))
        .cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(shortened(0.012_345), "0.012");
        assert_eq!(shortened(0.5), "0.50");
        assert_eq!(shortened(2.34), "2.3");
        assert_eq!(shortened(0.0), "0.000000000");
    }
}
