//! One rendering: from a loaded scene to a file.

use super::again;
use super::digest;
use super::limited;
use super::progressive;
use super::summary::{Evaluations, Summary};
use super::target::{Container, numbered, unnamed};
use crate::args::RenderArgs;
use crate::backend::{ChosenRenderer, Used};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::{Progress, no_link, write_watched};
use crate::interrupt::{self, Asking};
use crate::json;
use crate::survey;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;
use zeroset_language::load::{Loaded, Options};
use zeroset_output::atomic::probe;
use zeroset_output::cryptomatte::{self, Mattes};
use zeroset_output::denoise;
use zeroset_output::format::exr::{self, Beside};
use zeroset_output::format::png::Depth;
use zeroset_output::format::recipe::{self, Recipe};
use zeroset_output::format::{ENTRY, Metadata, png};
use zeroset_output::picture::{Developed, Picture, Rows};
use zeroset_output::tone;
use zeroset_output::view::{PlaneView, needed};
use zeroset_scene::film::Plane;
use zeroset_scene::progressive::filter;
use zeroset_scene::render::{Frame, RenderError};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Antialias;
use zeroset_scene::valid::SceneError;

/// Rays a pixel of the mattes of a picture that converges.
const MATTE_RAYS: u32 = 64;

/// A picture, and what it took.
struct Made {
    frame: Frame,
    mattes: Option<Mattes>,
    used: Used,
    /// The share of it that is finished.
    finished: f64,
    /// Why not all of it is.
    lack: Option<String>,
    convergence: Option<(Option<f64>, f64)>,
}

/// What the flags ask for.
pub(crate) struct Job<'a> {
    pub(crate) args: &'a RenderArgs,
    pub(crate) console: &'a Console,
    pub(crate) options: Options,
    engine: ChosenRenderer,
}

impl<'a> Job<'a> {
    pub(crate) fn new(args: &'a RenderArgs, console: &'a Console) -> Result<Job<'a>, Failure> {
        let options = Options {
            moments: true,
            floorless: args.transparent,
            ..crate::scene::options(&args.scene, args.size.map(|s| s.0))?
        };
        if let Some(path) = &args.output
            && args.transparent
            && matches!(Container::of(path)?, Container::Clip(_))
        {
            let help = "number the frames as pictures: end the name in .png or .exr";
            let message = format!("{} has no transparent pixels", path.display());
            return Err(Failure::with_help(Exit::Usage, message, help));
        }
        let is_exr = |path: &PathBuf| matches!(Container::of(path), Ok(Container::Exr));
        if args.cryptomatte && !args.output.as_ref().is_some_and(is_exr) {
            let help = "name the picture: -o picture.exr";
            let message = "only an .exr holds the mattes of --cryptomatte";
            return Err(Failure::with_help(Exit::Usage, message, help));
        }
        if let Some(path) = &args.output
            && Container::of(path)? == Container::Exr
            && args.plane() != Plane::Colour
        {
            let help = "leave out --view, or end the name in .png";
            return Err(Failure::with_help(
                Exit::Usage,
                "an .exr holds all planes",
                help,
            ));
        }
        let engine = ChosenRenderer::new(
            args.backend,
            args.adapter.as_deref(),
            args.threads.map(usize::from),
            console,
        )?;
        Ok(Job {
            args,
            console,
            options,
            engine,
        })
    }

    /// Renders to the file that the flags name, and says what it took. What it gives is why the picture is not finished,
    /// where a time limit ended it.
    ///
    /// # Errors
    /// The file cannot be written (which is found out first), the scene cannot be rendered, `cancelled` says to stop.
    pub(crate) fn render(
        &self,
        loaded: &Loaded,
        options: &Options,
        frame: Option<(u32, &Range<u32>)>,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<Failure>, Failure> {
        let _asking = Asking::begin();
        let scene = self.scene(loaded, options)?;
        let mut path = match &self.args.output {
            Some(path) => path.clone(),
            None => unnamed(&self.args.scene.scene, self.args.plane(), frame.is_some())?,
        };
        let mut label = scene.name().to_string();
        if let Some((number, frames)) = frame {
            path = numbered(&path, number, frames);
            if self.args.output.is_none() {
                no_link(&path)?;
            }
            label = format!("{label} {}/{}", number - frames.start + 1, frames.len());
        }
        let made = self.produce(loaded, &scene, options, &path, &label, cancelled)?;
        let recipe = self.recipe(loaded, &scene, options, &made);
        if let Some(followed) = &self.args.recipe {
            again::say_differences(followed, &recipe.files, &made.used, self.console);
        }
        self.write(&path, &scene, options, &made, &recipe, cancelled)?;
        self.report(
            &path,
            &scene,
            options,
            frame.map(|(number, _)| number),
            &made,
        )?;
        Ok(made.lack.map(|words| unfinished(&path, &words)))
    }

    /// Renders a frame of an animation to bytes as a screen shows them, three a pixel.
    ///
    /// # Errors
    /// As [`Job::render`].
    pub(crate) fn frame(
        &self,
        loaded: &Loaded,
        options: &Options,
        path: &Path,
        (number, frames): (u32, &Range<u32>),
    ) -> Result<(Pixels, Option<Failure>), Failure> {
        let scene = self.scene(loaded, options)?;
        let label = format!(
            "{} {}/{}",
            scene.name(),
            number - frames.start + 1,
            frames.len()
        );
        let cancelled = &interrupt::requested;
        let made = self.produce(loaded, &scene, options, path, &label, cancelled)?;
        let picture = self.plane_view(&scene, |view| match view.plane {
            Plane::Colour => Picture::develop(&made.frame.film, view.transform),
            _ => view.of(&made.frame.film),
        });
        if self.args.json {
            self.report(path, &scene, options, Some(number), &made)?;
        }
        let lack = made.lack.map(|words| unfinished(path, &words));
        Ok((Pixels::of(&picture), lack))
    }

    /// What is rendered: the scene with the methods that the flags choose, and the camera of a picture that is made again.
    fn scene(&self, loaded: &Loaded, options: &Options) -> Result<Scene, Failure> {
        let mut scene = loaded.scene.clone();
        self.args.methods.apply(&mut scene, &options.limits)?;
        let recipe = self.args.recipe.as_ref();
        match recipe.and_then(|recipe| again::camera(self.args, recipe, &scene)) {
            Some(camera) => Ok(scene.with_camera(camera)?),
            None => Ok(scene),
        }
    }

    /// What makes the picture again.
    fn recipe(&self, loaded: &Loaded, scene: &Scene, options: &Options, made: &Made) -> Recipe {
        let (args, settings) = (self.args, scene.settings());
        Recipe {
            format: recipe::FORMAT,
            zeroset: env!("CARGO_PKG_VERSION").to_owned(),
            files: digest::of_files(&loaded.files),
            set: options.set.clone(),
            time: options.time,
            size: settings.size,
            camera: *scene.camera(),
            seed: settings.seed,
            spp: args.methods.spp,
            methods: args.methods.written(),
            view: args.view.map(|view| view.name().to_owned()),
            no_legend: args.no_legend,
            transparent: args.transparent,
            cryptomatte: args.cryptomatte,
            denoise: args.denoise,
            bits: args.bits.as_ref().and_then(|bits| bits.parse().ok()),
            rounds: progressive::is_asked(args),
            noise: args.noise,
            gpu: made.used.adapter().map(str::to_owned),
            unfinished: made.lack.is_some(),
        }
    }

    /// What is shown of a scene's films.
    fn plane_view<T>(&self, scene: &Scene, show: impl FnOnce(PlaneView<'_>) -> T) -> T {
        let names: Vec<String> = scene.objects().iter().map(|o| o.name.clone()).collect();
        show(PlaneView {
            plane: self.args.plane(),
            transform: scene.settings().view_transform(),
            legend: !self.args.no_legend,
            objects: &names,
        })
    }

    /// Renders a scene to the planes that a file of this name needs.
    fn produce(
        &self,
        loaded: &Loaded,
        scene: &Scene,
        options: &Options,
        path: &Path,
        label: &str,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<Made, Failure> {
        let (planes, mut copies) = planes(path, self.args)?;
        if progressive::is_asked(self.args) {
            let [width, height] = scene.settings().size.map(u64::from);
            let bytes = zeroset_scene::progressive::bytes(scene.settings().size, planes);
            copies = copies.max(bytes.div_ceil((width * height).max(1)));
        }
        if self.args.cryptomatte {
            copies += cryptomatte::BYTES;
        }
        (options.limits)
            .check_picture(scene.settings().size, planes, copies)
            .map_err(|e| Failure::new(Exit::Scene, e.to_string()))?;
        if !matches!(Container::of(path)?, Container::Clip(_)) {
            probe(path)?;
        }
        if let Some(name) = survey::around_camera(scene) {
            self.console.note(survey::inside_words(name));
        }
        let progress = Progress {
            bar: self.console.bar(label),
            cancelled,
        };
        let restart = || progress.bar.reset();
        let mut convergence = None;
        let rendered = match self.args.time_limit {
            _ if progressive::is_asked(self.args) => {
                let engine = &self.engine;
                progressive::render(
                    self.args,
                    engine,
                    loaded,
                    scene,
                    planes,
                    &progress,
                    self.console,
                )
                .map(|picture| {
                    convergence = Some((picture.noise, picture.samples));
                    (picture.frame, picture.used, picture.lack)
                })
            }
            None => self
                .engine
                .render(scene, planes, &progress, &restart)
                .map(|(frame, used)| (frame, used, None))
                .map_err(Failure::from),
            Some(seconds) => {
                // beyond some years a limit is none
                let most = Duration::from_secs_f64(seconds.min(1e9));
                limited::render(&self.engine, scene, planes, most, &progress, &restart).map(
                    |(frame, used, lack)| {
                        (frame, used, lack.map(|lack| (lack.finished, lack.words())))
                    },
                )
            }
        };
        progress.bar.finish_and_clear();
        let (mut rendered, used, lack) = rendered?;
        if self.args.denoise {
            let stop = || interrupt::requested() || cancelled();
            rendered.film = denoise::denoise(rendered.film, &stop)
                .ok_or_else(|| Failure::from(RenderError::Cancelled))?;
        }
        if self.args.transparent {
            let cancelled = Progress {
                bar: self.console.working_bar("background"),
                cancelled,
            };
            let mut background = scene.clone();
            background.edit_moments(|parts| {
                parts.objects.clear();
                Ok::<(), SceneError>(())
            })?;
            let behind = self
                .engine
                .render(&background, &[Plane::Colour], &cancelled, &|| ());
            cancelled.bar.finish_and_clear();
            rendered.film.cut_out(&behind?.0.film);
        }
        let mattes = match self.args.cryptomatte {
            true => Some(self.mattes(scene, cancelled)?),
            false => None,
        };
        let (finished, lack) = lack.map_or((1.0, None), |(share, words)| (share, Some(words)));
        Ok(Made {
            frame: rendered,
            mattes,
            used,
            finished,
            lack,
            convergence,
        })
    }

    /// The mattes of the objects of a scene.
    fn mattes(
        &self,
        scene: &Scene,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<Mattes, Failure> {
        let mut scene = scene.clone();
        if progressive::is_asked(self.args) {
            // which has many more rays than it states
            let (samples, filter) = (MATTE_RAYS, filter(scene.settings().antialias));
            scene.edit_moments(|parts| {
                parts.settings.antialias = Antialias::Supersample { samples, filter };
                Ok::<(), SceneError>(())
            })?;
        }
        let progress = Progress {
            bar: self.console.bar("mattes"),
            cancelled,
        };
        let prepare = |scene: &Scene| Ok(self.engine.prepare(scene)?.0);
        let mattes = Mattes::rendered(&prepare, &scene, &progress);
        progress.bar.finish_and_clear();
        Ok(mattes?)
    }

    fn write(
        &self,
        path: &Path,
        scene: &Scene,
        options: &Options,
        made: &Made,
        recipe: &Recipe,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> Result<(), Failure> {
        let (rendered, lack) = (&made.frame, made.lack.as_deref());
        let mut notes = Metadata::new(scene.name()).with("Settings", json::line(scene.settings())?);
        if !options.set.is_empty() {
            notes = notes.with("Parameters", json::line(&options.set)?);
        }
        if options.time != 0.0 {
            notes = notes.with("Time", options.time.to_string());
        }
        if self.args.plane() != Plane::Colour {
            notes = notes.with("View", self.args.plane().name());
        }
        if let Some(lack) = lack {
            notes = notes.with("Unfinished", lack);
        }
        match recipe.to_text() {
            Ok(text) if text.len() <= ENTRY => notes = notes.with(recipe::KEY, text),
            _ => self.console.note(
                "The picture does not say how it was made: what was set has too many letters.",
            ),
        }
        match Container::of(path)? {
            Container::Exr => {
                let beside = Beside {
                    is_cut_out: self.args.transparent,
                    mattes: made.mattes.as_ref(),
                };
                write_watched(path, self.console, cancelled, |writer, observer| {
                    exr::write_beside(writer, &rendered.film, &beside, &notes, observer)
                })
            }
            Container::Png => {
                let depth = if self.args.bits.as_deref() == Some("16") {
                    Depth::Sixteen
                } else {
                    Depth::Eight
                };
                let write = |picture: &dyn Rows| {
                    write_watched(path, self.console, cancelled, |writer, observer| {
                        png::write_watched(writer, picture, depth, &notes, observer)
                    })
                };
                self.plane_view(scene, |view| match view.plane {
                    // without a second copy of a picture that may be large
                    Plane::Colour => {
                        let developed = Developed::new(&rendered.film, view.transform);
                        match self.args.transparent {
                            true => write(&developed.cut_out()),
                            false => write(&developed),
                        }
                    }
                    _ => write(&view.of(&rendered.film)),
                })
            }
            // frame by frame, elsewhere
            Container::Clip(_) => Ok(()),
        }
    }

    fn report(
        &self,
        path: &Path,
        scene: &Scene,
        options: &Options,
        frame: Option<u32>,
        made: &Made,
    ) -> Result<(), Failure> {
        let Made {
            frame: rendered,
            used,
            finished,
            convergence,
            ..
        } = made;
        let statistics = &rendered.statistics;
        let rays = statistics.rays.max(1) as f64;
        let summary = Summary {
            scene: scene.name(),
            file: PathBuf::from(path).to_string_lossy().into_owned(),
            width: rendered.film.width(),
            height: rendered.film.height(),
            view: self.args.plane().name(),
            frame,
            time: options.time,
            set: &options.set,
            seconds: statistics.seconds,
            backend: used.backend(),
            adapter: used.adapter(),
            threads: statistics.threads,
            rays: statistics.rays,
            hits: statistics.hits,
            rays_per_second: statistics.rays as f64 / statistics.seconds.max(1e-9),
            evaluations: Evaluations::of(statistics),
            evaluations_per_ray: statistics.evaluations.total() as f64 / rays,
            finished: *finished,
            noise: convergence.and_then(|(noise, _)| noise),
            rays_a_pixel: convergence.map(|(_, samples)| samples),
            settings: scene.settings(),
        };
        if self.args.json {
            return self.console.emit(&json::line(&summary)?);
        }
        self.console.note(summary.line());
        Ok(())
    }
}

/// The planes that a file needs, and the bytes a pixel that writing it and taking the noise out take beside the film.
fn planes(path: &Path, args: &RenderArgs) -> Result<(&'static [Plane], u64), Failure> {
    let (view, denoise) = (args.plane(), args.denoise);
    let denoising = if denoise { denoise::BYTES } else { 0 };
    let (planes, copies) = match Container::of(path)? {
        // all numbers once more, one plane after the other, and what they are compressed to
        Container::Exr => (&Plane::ALL[..], 2 * 64),
        // colours are written row by row, of others there is a picture, and one with a legend beside it
        Container::Clip(_) if denoise && view == Plane::Colour => (&denoise::GUIDES[..], 24),
        // a picture, and one with a legend beside it
        Container::Clip(_) => (needed(view), 24),
        Container::Png if view != Plane::Colour => (needed(view), 24),
        // and the film of what is behind
        Container::Png if args.transparent => (&[Plane::Colour, Plane::Coverage][..], 12),
        Container::Png if denoise => (&denoise::GUIDES[..], 0),
        Container::Png => (needed(view), 0),
    };
    // one after the other
    Ok((planes, copies.max(denoising)))
}

fn unfinished(path: &Path, words: &str) -> Failure {
    Failure::with_help(
        Exit::Unfinished,
        format!("{}: {words}", path.display()),
        "`zeroset check` estimates what a picture takes; ask for a smaller one, or raise --time-limit",
    )
}

/// A picture in bytes, three a pixel, row by row from the top left.
pub(crate) struct Pixels {
    pub(crate) size: [u32; 2],
    pub(crate) bytes: Vec<u8>,
}

impl Pixels {
    fn of(picture: &Picture) -> Pixels {
        let width = picture.width().max(1) as usize;
        let bytes = picture.pixels().iter().enumerate().flat_map(|(i, pixel)| {
            let (x, y) = ((i % width) as u32, (i / width) as u32);
            pixel.map(|c| tone::quantise8(c, x, y))
        });
        Pixels {
            size: [picture.width(), picture.height()],
            bytes: bytes.collect(),
        }
    }
}

/// Whether a failure is a rendering that was asked to stop.
pub(crate) fn was_cancelled(failure: &Failure) -> bool {
    failure.exit == Exit::Interrupted
}
