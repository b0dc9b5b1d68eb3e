//! Saving the picture that is shown.

use crate::ladder::Draft;
use crate::session::Session;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zeroset_language::load::Options;
use zeroset_language::naming::default_stem;
use zeroset_output::atomic::write_atomically;
use zeroset_output::format::png::{self, Depth};
use zeroset_output::format::recipe::KEY;
use zeroset_output::format::{ENTRY, Metadata, exr};
use zeroset_output::view::PlaneView;
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::settings::{Settings, Shadow};

/// What a picture was made of, for who says how it is made again.
pub struct Taken<'a> {
    /// The scene's files, its own first.
    pub files: &'a [PathBuf],
    /// Parameters and time.
    pub options: &'a Options,
    /// The settings that the file states.
    pub stated: &'a Settings,
    /// The settings of the picture.
    pub settings: Settings,
    /// The shadow of all lights, where it is not each light's own.
    pub shadow: Option<Shadow>,
    /// The plane of the film that is shown.
    pub plane: Plane,
    /// Who looked.
    pub camera: Camera,
    /// The noise at which it ended, where it went on for that.
    pub noise: Option<f64>,
    /// What rendered.
    pub backend: &'a str,
}

/// What goes into a picture so that it can be made again. `None` where no command line says it.
pub type Describe = fn(&Taken<'_>) -> Option<String>;

/// How the picture that is shown is made again; `None` where the file does not say all that is seen: the stage was changed and not
/// written, something is hidden or moved since, the picture is a draft.
fn recipe(session: &Session, describe: Describe) -> Option<String> {
    let shown = session.shown.as_ref()?;
    let current = session.current.as_ref()?;
    let edited = session
        .comparison
        .edited
        .min(shown.sides.len().checked_sub(1)?);
    let (side, look) = (shown.sides.get(edited)?, shown.request.looks.get(edited)?);
    let is_whole = side.rung.size == shown.request.size && side.rung.draft == Draft::Whole;
    let is_now = Arc::ptr_eq(&shown.request.scene, &current.scene) && session.is_loaded();
    let is_files = session.stage.is_empty() && session.hidden.is_empty();
    // the window sees one moment
    let is_still = !current.loaded.animated || current.loaded.shutter.seconds == 0.0;
    if !(is_whole && is_now && is_files && is_still) || shown.request.slice.is_some() {
        return None;
    }
    describe(&Taken {
        files: &current.loaded.files,
        options: &session.options,
        stated: session.stated(),
        settings: Settings {
            size: side.rung.size,
            antialias: side.rung.antialias,
            ..look.settings
        },
        shadow: look.shadow,
        plane: look.plane,
        camera: shown.request.camera,
        noise: side.convergence.map(|c| c.wanted),
        backend: session.backend.as_deref()?,
    })
}

/// The name of a picture that was given none: from the file's name, whatever the scene calls itself.
pub(crate) fn default_name(session: &Session) -> String {
    let (stem, plane) = (default_stem(&session.path), session.looks[0].plane);
    match plane {
        Plane::Colour => format!("{stem}.png"),
        _ => format!("{stem}-{}.png", plane.name()),
    }
}

/// Writes what is shown: a PNG of the view, or all planes as OpenEXR, as the name ends. Of two looks, the edited one.
///
/// # Errors
/// What is wrong with the name or the disk, and what to do.
pub fn save(session: &Session, name: &str, describe: Option<Describe>) -> Result<PathBuf, String> {
    let path = PathBuf::from(name.trim());
    let shown = session.shown.as_ref().ok_or("there is no picture yet")?;
    let edited = session
        .comparison
        .edited
        .min(shown.sides.len().saturating_sub(1));
    let (Some(side), Some(look)) = (shown.sides.get(edited), shown.request.looks.get(edited))
    else {
        return Err("there is no picture yet".to_owned());
    };
    let scene = &shown.request.scene;
    let notes = Metadata::new(scene.name()).with("Camera", session.rig.statement());
    let notes = match describe.and_then(|describe| recipe(session, describe)) {
        Some(text) if text.len() <= ENTRY => notes.with(KEY, text),
        _ => notes,
    };
    let wrong = |e: zeroset_output::atomic::WriteError| format!("{e}; {}", e.advice());
    match ending(&path).as_deref() {
        Some("png") => {
            let names: Vec<String> = scene.objects().iter().map(|o| o.name.clone()).collect();
            let view = PlaneView {
                plane: look.plane,
                transform: look.settings.view_transform(),
                legend: true,
                objects: &names,
            };
            let picture = view.of(&side.film);
            write_atomically(&path, |writer| {
                png::write(writer, &picture, Depth::Eight, &notes)
            })
        }
        Some("exr") => write_atomically(&path, |writer| exr::write(writer, &side.film, &notes)),
        _ => return Err("end the name in .png, or in .exr for all planes".to_owned()),
    }
    .map_err(wrong)?;
    Ok(path)
}

fn ending(path: &Path) -> Option<String> {
    Some(path.extension()?.to_string_lossy().to_lowercase())
}
