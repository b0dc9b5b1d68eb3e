//! A scene file with values written into it, held against what is wanted.

use super::{Change, Left, Reason, Revision, revise};
use crate::assets::Assets;
use crate::document::Document;
use crate::folder::Folder;
use crate::load::{Failed, Language, Loaded, Options};
use crate::report::Report;
use glam::{Mat3, Vec3};
use std::path::Path;
use std::sync::Arc;
use zeroset_scene::light::{Light, Source};
use zeroset_scene::material::{Material, Pattern};
use zeroset_scene::scene::{Scene, SceneParts};

/// What is to be written to a scene file.
#[derive(Clone, Debug)]
pub struct Revised {
    /// The new text, and what is in it.
    pub revision: Revision,
    /// The text as it stands in the file.
    pub before: String,
}

impl Revised {
    /// Whether there is anything to write.
    pub fn is_changed(&self) -> bool {
        self.revision.text != self.before
    }
}

/// Reads a scene file and puts into its text what parameters are set to (`options.set`), and other changes. The new text is loaded
/// without any parameter set, and what it does not make exactly as wanted is left out of it. Nothing is written.
///
/// # Errors
/// The file cannot be read, or the scene cannot be loaded as it is.
pub fn revise_file(
    path: &Path,
    options: &Options,
    changes: &[Change],
    assets: &Assets,
) -> Result<Revised, Failed> {
    let failed = |message: String| Failed {
        report: Report::new(message).into(),
        files: vec![path.to_path_buf()],
    };
    let file = File {
        path,
        options,
        assets,
    };
    // says what is wrong with the file, if anything is, and holds its length against the limits
    let loaded = Document::open(path, &options.limits, assets)?.scene(options)?;
    let before = std::fs::read_to_string(path).map_err(|e| failed(e.to_string()))?;
    let mut all = Change::of_parameters(&loaded);
    all.extend(changes.iter().cloned());
    let (revision, refused) = file.attempt(&before, &all)?;
    let Some(why) = refused else {
        return Ok(Revised { revision, before });
    };
    // which of them it is: each one alone, and then those together that are good
    let (mut good, mut left) = (Vec::new(), Vec::new());
    let refuse = |change: &Change, why: &Reason| Left {
        change: change.clone(),
        subject: change.subject(&loaded),
        reason: why.clone(),
    };
    for change in &all {
        match file.attempt(&before, std::slice::from_ref(change))? {
            (_, Some(why)) => left.push(refuse(change, &why)),
            (_, None) => good.push(change.clone()),
        }
    }
    let (mut revision, refused) = file.attempt(&before, &good)?;
    if left.is_empty() || refused.is_some() {
        left.extend(good.iter().map(|c| refuse(c, &why)));
        revision = Revision {
            text: before.clone(),
            written: Vec::new(),
            left: Vec::new(),
        };
    }
    revision.left.extend(left);
    Ok(Revised { revision, before })
}

struct File<'a> {
    path: &'a Path,
    options: &'a Options,
    assets: &'a Assets,
}

impl File<'_> {
    fn load(&self, text: &str, options: &Options) -> Result<Loaded, Failed> {
        let folder = self.path.parent().filter(|p| !p.as_os_str().is_empty());
        let folder = Folder::new(folder.unwrap_or(Path::new(".")));
        let limits = &options.limits;
        let files = Some(Arc::new(folder) as _);
        Document::of_text(
            &self.name(),
            text,
            self.language(),
            files,
            limits,
            self.assets,
        )?
        .scene(options)
    }

    fn name(&self) -> String {
        let name = self.path.file_name().and_then(|n| n.to_str());
        name.unwrap_or("scene").to_owned()
    }

    fn language(&self) -> Language {
        match self.path.extension().and_then(|e| e.to_str()) {
            Some("json") => Language::Json,
            _ => Language::Starlark,
        }
    }

    /// The text with changes, and why it is not to be written, if it is not.
    fn attempt(
        &self,
        text: &str,
        changes: &[Change],
    ) -> Result<(Revision, Option<Reason>), Failed> {
        let set = changes.iter().filter_map(|change| match change {
            Change::Parameter { name, .. } => {
                let text = self.options.set.get(name)?;
                Some((name.clone(), text.clone()))
            }
            _ => None,
        });
        let wanted = Options {
            set: set.collect(),
            ..self.options.clone()
        };
        let loaded = self.load(text, &wanted)?;
        let revision = revise(&self.name(), text, self.language(), &loaded, changes)?;
        if revision.text == text {
            return Ok((revision, None));
        }
        // what is left of parameters is as the file says in both
        let is_left = |change: &Change| revision.left.iter().any(|l| l.change == *change);
        let made: Vec<&Change> = changes.iter().filter(|c| !is_left(c)).collect();
        let mut kept = wanted.clone();
        kept.set.retain(|name, _| {
            made.iter()
                .any(|c| matches!(c, Change::Parameter { name: n, .. } if n == name))
        });
        let loaded = if kept == wanted {
            loaded
        } else {
            self.load(text, &kept)?
        };
        let plain = Options {
            set: Default::default(),
            ..wanted
        };
        let again = match self.load(&revision.text, &plain) {
            Ok(again) => again,
            Err(failed) => {
                let why = Reason::Refused(failed.report.message().to_owned());
                return Ok((revision, Some(why)));
            }
        };
        let why = differs(&loaded, &made, &again);
        Ok((revision, why))
    }
}

/// How a scene differs from what is wanted.
fn differs(loaded: &Loaded, changes: &[&Change], again: &Loaded) -> Option<Reason> {
    let refused = |what: &str| Some(Reason::Refused(format!("{what} would not be as it is now")));
    for change in changes {
        if let Change::Parameter { name, setting } = change
            && !(again.parameters.iter()).any(|p| p.name == *name && p.default == *setting)
        {
            return refused(&format!("`{name}`"));
        }
    }
    let (before, after) = (loaded.scene.parts(), again.scene.parts());
    let had_stage = |parts: &SceneParts| {
        parts
            .objects
            .iter()
            .any(|o| o.name == "floor" && o.place.is_none())
    };
    if had_stage(before) && !had_stage(after) {
        return Some(Reason::Stage);
    }
    let mut wanted: Scene = loaded.scene.clone();
    let edited = wanted.edit(|parts| changes.iter().for_each(|c| c.apply(parts)));
    if let Err(error) = edited {
        return Some(Reason::Refused(error.to_string()));
    }
    let wanted = wanted.parts();
    if wanted.objects.len() != after.objects.len() {
        return refused("what is shown");
    }
    if !near_cameras(wanted, after) {
        return refused("the camera");
    }
    if wanted.lights.len() != after.lights.len()
        || !(wanted.lights.iter().zip(&after.lights)).all(|(a, b)| near_lights(a, b))
    {
        return refused("the lights");
    }
    let (a, b) = (&wanted.sky, &after.sky);
    let colours = [(a.top, b.top), (a.horizon, b.horizon), (a.bottom, b.bottom)];
    if !colours.iter().all(|(a, b)| a.abs_diff_eq(*b, NEAR))
        || (a.ambient, a.sun, a.fog) != (b.ambient, b.sun, b.fog)
    {
        return refused("the sky");
    }
    if !(wanted.objects.iter().zip(&after.objects)).all(|(a, b)| {
        let of = |parts: &SceneParts, n: u16| parts.materials.get(usize::from(n)).cloned();
        near_materials(of(wanted, a.material), of(after, b.material))
    }) || wanted.materials.len() < after.materials.len()
    {
        return refused("a material");
    }
    (wanted.settings != after.settings)
        .then(|| Reason::Refused("the methods would not be as they are now".into()))
}

/// How far numbers may be from each other that went through the text of a file: single precision, and the sRGB curve.
const NEAR: f32 = 2e-6;

fn near_cameras(a: &SceneParts, b: &SceneParts) -> bool {
    let (a, b) = (a.camera, b.camera);
    let turned: Mat3 = a.axes - b.axes;
    a.eye == b.eye
        && turned.abs().to_cols_array().iter().all(|x| *x <= 2e-5)
        && a.lens == b.lens
        && a.near == b.near
        && a.aperture == b.aperture
        // what is in focus counts where the lens has an extent
        && (a.aperture == 0.0 || (a.focus - b.focus).abs() <= 1e-5 * a.focus.abs())
}

fn near_lights(a: &Light, b: &Light) -> bool {
    let near = |a: Vec3, b: Vec3| a.abs_diff_eq(b, NEAR * (1.0 + a.abs().max_element()));
    let sources = match (a.source, b.source) {
        (Source::Directional { direction: a }, Source::Directional { direction: b }) => near(a, b),
        (a, b) => a == b,
    };
    sources && near(a.radiance, b.radiance) && a.shadow == b.shadow
}

fn near_materials(a: Option<Material>, b: Option<Material>) -> bool {
    let (Some(a), Some(b)) = (a, b) else {
        return false;
    };
    let colours = match (&a.pattern, &b.pattern) {
        (Pattern::Solid { colour: a }, Pattern::Solid { colour: b }) => a.abs_diff_eq(*b, NEAR),
        (a, b) => a == b,
    };
    let same = Material {
        pattern: b.pattern.clone(),
        shininess: b.shininess,
        ..a.clone()
    };
    colours && (a.shininess - b.shininess).abs() <= 1e-4 * a.shininess && same == b
}
