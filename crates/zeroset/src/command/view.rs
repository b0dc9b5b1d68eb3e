//! `zeroset view`.

use crate::args::ViewArgs;
use crate::console::plain_report;
use crate::failure::{Exit, Failure};
use crate::render::digest;
use crate::values::Chosen;
use std::collections::BTreeMap;
use std::sync::Arc;
use zeroset_output::format::recipe::{FORMAT, Recipe};
use zeroset_scene::film::Plane;
use zeroset_scene::render::Renderer;
use zeroset_scene::settings::Settings;
use zeroset_viewer::engine::{MakeRenderer, cpu};
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

/// What makes a picture of the window again, by `render`: what differs from the file, in the words of the command line. `None` where
/// that has no words for it.
fn describe(taken: &Taken<'_>) -> Option<String> {
    let (now, stated) = (&taken.settings, taken.stated);
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
    if plain(rest) != plain(rest_stated) {
        return None;
    }
    if let Some(shadow) = taken.shadow {
        methods.insert("shadow".to_owned(), Chosen(shadow).to_string());
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Command, CommandLine};
    use crate::console::Console;
    use clap::Parser;
    use std::path::Path;
    use std::time::Duration;
    use zeroset_language::load::{Options, load};
    use zeroset_scene::settings::{Antialias, Occlusion, Shadow};
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
}
