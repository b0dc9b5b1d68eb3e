//! `zeroset view`.

use crate::args::ViewArgs;
use crate::args::{Command, CommandLine};
use crate::console::Console;
use crate::console::plain_report;
use crate::failure::{Exit, Failure};
use crate::render::digest;
use crate::values::Chosen;
use clap::Parser;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::sync::Arc;
use zeroset_language::load::Loaded;
use zeroset_output::format::recipe::{FORMAT, Recipe};
use zeroset_scene::film::Plane;
use zeroset_scene::render::Renderer;
use zeroset_scene::settings::{Settings, Shadow};
use zeroset_scene::valid::SceneError;
use zeroset_viewer::engine::{MakeRenderer, cpu};
use zeroset_viewer::movie::{Movie, Progress};
use zeroset_viewer::save::Taken;
use zeroset_viewer::{Open, open};

/// Opens the window, and returns when it is closed. Ctrl-C ends the process: what the window saves is whole or not there,
/// whenever it ends.
pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    crate::scene::present(&args.scene)?;
    let options = crate::scene::options(&args.scene, None)?;
    let window = Open {
        scene: args.scene.scene.clone(),
        options,
        renderer: renderer(args)?,
        explain: |failed| plain_report(failed.report.as_ref()),
        describe,
        animate,
        assets: crate::cache::assets(),
    };
    open(window).map_err(|error| Failure::with_help(Exit::Job, error.to_string(), error.advice()))
}

/// What renders. A GPU that is asked for must be there before the window opens; one that may be there is looked for while
/// it opens.
fn renderer(args: &ViewArgs) -> Result<MakeRenderer, Failure> {
    use crate::backend::{Backend, gpu};
    let threads = args.threads.map(usize::from);
    if args.backend == Backend::Auto && args.adapter.is_none() {
        return Ok(Box::new(move || match gpu(Backend::Auto, None) {
            Ok(Some(renderer)) => Ok(Arc::new(renderer) as Arc<dyn Renderer>),
            _ => cpu(threads),
        }));
    }
    let renderer = gpu(args.backend, args.adapter.as_deref())?;
    Ok(Box::new(move || match renderer {
        Some(renderer) => Ok(Arc::new(renderer) as Arc<dyn Renderer>),
        None => cpu(threads),
    }))
}

/// Methods that differ from the file's, by the options of the command line that choose them. `None` where it has no words for what differs.
fn methods(
    now: &Settings,
    stated: &Settings,
    shadow: Option<Shadow>,
) -> Option<BTreeMap<String, String>> {
    let mut methods = BTreeMap::new();
    // what is left of the settings when all that has an option is taken away
    let (mut rest, mut rest_stated) = (*now, *stated);
    macro_rules! options {
        ($($name:literal: $field:ident),+) => {$(
            if now.$field != stated.$field {
                methods.insert($name.to_owned(), Chosen(now.$field).to_string());
            }
            rest.$field = Settings::DEFAULT.$field;
            rest_stated.$field = Settings::DEFAULT.$field;
        )+};
    }
    options!(
        "march": march,
        "normals": normals,
        "ao": occlusion,
        "aa": antialias,
        "shading": shading,
        "tone": tone,
        "integrator": integrator
    );
    let plain = |settings: Settings| Settings {
        size: Settings::DEFAULT.size,
        seed: Settings::DEFAULT.seed,
        ..settings
    };
    if let Some(shadow) = shadow {
        methods.insert("shadow".to_owned(), Chosen(shadow).to_string());
    }
    (plain(rest) == plain(rest_stated)).then_some(methods)
}

/// What makes a picture of the window again, by `render`: what differs from the file, in the words of the command line. `None` where
/// that has no words for it.
fn describe(taken: &Taken<'_>) -> Option<String> {
    let now = &taken.settings;
    let mut methods = methods(now, taken.stated, taken.shadow)?;
    if taken.noise.is_some() {
        // as many as it takes
        methods.remove("aa");
    }
    let recipe = Recipe {
        format: FORMAT,
        zeroset: env!("CARGO_PKG_VERSION").to_owned(),
        files: digest::of_files(taken.files),
        set: taken.options.set.clone(),
        time: taken.options.time,
        size: now.size,
        camera: taken.camera,
        seed: now.seed,
        spp: None,
        methods,
        view: (taken.plane != Plane::Colour).then(|| taken.plane.name().to_owned()),
        no_legend: false,
        transparent: false,
        cryptomatte: false,
        denoise: false,
        bits: None,
        rounds: taken.noise.is_some(),
        noise: taken.noise,
        gpu: (!taken.backend.starts_with("CPU,")).then(|| taken.backend.to_owned()),
        unfinished: false,
    };
    recipe.to_text().ok()
}

/// Renders an animation with the command line's own means: `render --frames` with what the window shows in place of the file's.
fn animate(movie: &Movie, progress: &Progress) -> Result<(), String> {
    let said = |failure: Failure| match failure.report {
        Some(report) => plain_report(&*report),
        None => "it was ended".to_owned(),
    };
    let [width, height] = movie.size;
    let mut line: Vec<OsString> = vec!["zeroset".into(), "render".into()];
    let mut say = |flag: &str, value: OsString| {
        line.push(flag.into());
        line.push(value);
    };
    say("--frames", format!("0..{}", movie.frames).into());
    say("--fps", movie.fps.to_string().into());
    say("--size", format!("{width}x{height}").into());
    say("--output", movie.path.clone().into());
    for (name, value) in &movie.options.set {
        say("--set", format!("{name}={value}").into());
    }
    line.push("--".into());
    line.push(movie.scene.clone().into());
    let line = CommandLine::try_parse_from(line).map_err(|e| e.to_string())?;
    let Command::Render(mut args) = line.command else {
        return Err("no animation can be made".to_owned());
    };
    // what has no option is put into the scene below
    let words = methods(&movie.settings, &movie.settings, movie.shadow).unwrap_or_default();
    for (option, text) in &words {
        args.methods.choose(option, text)?;
    }
    let prepare = |loaded: &mut Loaded| {
        if progress.is_cancelled() {
            return Err(Failure::silent(Exit::Interrupted));
        }
        progress.advance();
        let size = loaded.scene.settings().size;
        let changed = loaded
            .scene
            .edit_moments(|parts| -> Result<(), SceneError> {
                parts.settings = Settings {
                    size,
                    ..movie.settings
                };
                movie.changes.iter().for_each(|change| change.apply(parts));
                if let Some(camera) = movie.camera {
                    parts.camera = camera;
                }
                Ok(())
            });
        changed.map_err(|error| Failure::new(Exit::Scene, error.to_string()))
    };
    crate::render::run_animation(&args, &prepare, &Console::silent()).map_err(said)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;
    use std::time::Duration;
    use zeroset_language::load::{Options, load};
    use zeroset_scene::settings::{Antialias, Occlusion};
    use zeroset_viewer::engine::{Engine, Event};
    use zeroset_viewer::loader::Outcome;
    use zeroset_viewer::save::save;
    use zeroset_viewer::session::Session;

    const SCENE: &str =
        "r = slider(\"r\", 0.8)\nshow(sphere(r).move(y = time()))\nshow(plane().move(y = -0.8))\n";

    /// A picture of the window as a file, with the session changed first.
    fn pictured(scene: &Path, name: &Path, change: impl FnOnce(&mut Session)) {
        let set = [("r".to_owned(), "0.6".to_owned())].into();
        let options = Options {
            set,
            time: 0.25,
            ..Options::default()
        };
        let loaded = load(scene, &options).unwrap();
        let mut session = Session::new(scene.to_path_buf(), options.clone());
        session.absorb(Outcome {
            options,
            is_edit: false,
            result: Ok(Arc::new(loaded)),
        });
        session.rig.orbit(0.3, 0.1);
        session.is_free = true;
        change(&mut session);
        let engine = Engine::start(Box::new(|| cpu(Some(2))), || {}).unwrap();
        engine.ask(session.to_render([40, 30]).unwrap());
        while !session.is_finished() {
            match engine.wait(Duration::from_secs(60)) {
                Some(Event::Ready(name)) => session.backend = Some(name),
                Some(Event::Shown(shown)) => session.shown = Some(shown),
                Some(Event::Failed(why) | Event::FellBack(why)) => panic!("{why}"),
                None => panic!("no picture"),
            }
        }
        save(&session, name.to_str().unwrap(), Some(describe)).unwrap();
    }

    fn pixels(path: &Path) -> Vec<u8> {
        let mut reader =
            png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()))
                .read_info()
                .unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    }

    /// What the window saves, `render` makes again, to the bit: parameters, time, camera, size, methods, rays and plane.
    #[test]
    fn pictures_of_the_window_are_made_again() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.star");
        std::fs::write(&scene, SCENE).unwrap();
        let again = folder.path().join("again.png");
        type Change = fn(&mut Session);
        let changes: [Change; 4] = [
            |session| session.refine = false,
            |session| session.refine = true,
            |session| {
                session.refine = false;
                let look = session.edited();
                look.settings.antialias = Antialias::None;
                look.settings.occlusion = Occlusion::None;
                look.shadow = Some(Shadow::Hard);
            },
            |session| {
                session.refine = false;
                session.edited().plane = Plane::Normal;
            },
        ];
        for (i, change) in changes.into_iter().enumerate() {
            let name = folder.path().join(format!("picture-{i}.png"));
            pictured(&scene, &name, change);
            let line = CommandLine::parse_from([
                "zeroset".as_ref(),
                "render".as_ref(),
                name.as_os_str(),
                "--scene".as_ref(),
                scene.as_os_str(),
                "-o".as_ref(),
                again.as_os_str(),
            ]);
            let Command::Render(args) = line.command else {
                panic!("another command");
            };
            crate::render::run(&args, &Console::silent()).unwrap();
            assert!(
                pixels(&name) == pixels(&again),
                "picture {i} is another one"
            );
        }
        // what no command line says is not said
        let name = folder.path().join("bright.png");
        pictured(&scene, &name, |session| {
            session.refine = false;
            session.edited().settings.exposure = 1.0;
        });
        assert!(Recipe::of_picture(&name).is_err());
    }

    /// Animations are made of what the window shows, frame by frame, and end when they are told to.
    #[test]
    fn animations_of_the_window() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene.star");
        std::fs::write(&scene, SCENE).unwrap();
        let movie = |name: &str, camera| Movie {
            scene: scene.clone(),
            path: folder.path().join(name),
            frames: 3,
            fps: 10.0,
            size: [24, 16],
            options: Options::default(),
            settings: Settings {
                antialias: Antialias::None,
                ..Settings::DEFAULT
            },
            shadow: Some(Shadow::Hard),
            camera,
            changes: Vec::new(),
        };
        let progress = Progress::default();
        let lens = zeroset_scene::camera::Lens::Pinhole { fov: 0.6 };
        let camera = zeroset_scene::camera::Camera::look_at(
            glam::Vec3::new(0.0, 4.0, 4.0),
            glam::Vec3::ZERO,
            glam::Vec3::Y,
            lens,
        );
        animate(&movie("own.apng", None), &progress).unwrap();
        assert_eq!(progress.frames(), 3);
        animate(&movie("moved.apng", camera), &Progress::default()).unwrap();
        let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
        assert!(bytes("own.apng") != bytes("moved.apng"));
        let line = "render scene.star --frames 0..3 --fps 10 --size 24x16 --aa none --shadow hard -o asked.apng";
        let line = line.replace("scene.star", scene.to_str().unwrap()).replace(
            "asked.apng",
            folder.path().join("asked.apng").to_str().unwrap(),
        );
        let line = CommandLine::parse_from(["zeroset"].into_iter().chain(line.split(' ')));
        let Command::Render(args) = line.command else {
            panic!("another command");
        };
        crate::render::run(&args, &Console::silent()).unwrap();
        assert!(bytes("own.apng") == bytes("asked.apng"));
        let ended = Progress::default();
        ended.cancel();
        assert!(animate(&movie("ended.gif", None), &ended).is_err());
        assert!(!folder.path().join("ended.gif").exists());
        assert!(animate(&movie("none.png", None), &Progress::default()).is_err());
    }
}
