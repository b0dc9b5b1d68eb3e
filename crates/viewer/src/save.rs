//! Saving the picture that is shown.

use crate::session::Session;
use std::path::{Path, PathBuf};
use zeroset_language::naming::default_stem;
use zeroset_output::atomic::write_atomically;
use zeroset_output::format::png::{self, Depth};
use zeroset_output::format::{Metadata, exr};
use zeroset_output::view::PlaneView;
use zeroset_scene::film::Plane;

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
pub(crate) fn save(session: &Session, name: &str) -> Result<PathBuf, String> {
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
