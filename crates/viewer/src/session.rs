//! What the window is about, apart from how it is drawn: the scene, the camera, the methods, the time.

use crate::clock::Clock;
use crate::engine::{Look, Request, Shown};
use crate::loader::Outcome;
use crate::pace::Pace;
use crate::pick::Picked;
use crate::rig::{Rig, widened};
use crate::slice::Slice;
use glam::Vec3;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use zeroset_language::load::{Loaded, Options, Parameter, Setting};
use zeroset_language::naming::default_stem;
use zeroset_language::revision::{Change, Look as MaterialLook};
use zeroset_output::display::{NAME, name};
use zeroset_output::view::LegendKey;
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::light::{Light, Source};
use zeroset_scene::scene::{Object, Scene};
use zeroset_scene::settings::Settings;

/// The last version of the scene that could be loaded.
pub struct Current {
    /// The scene as it is shown: with what was changed of its stage, without what is hidden.
    pub scene: Arc<Scene>,
    /// All that loading found out, the scene as the file makes it.
    pub loaded: Arc<Loaded>,
}

/// Two looks beside each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideBySide {
    /// Whether both are shown.
    pub is_on: bool,
    /// Where the divider is, as a share of the picture's width.
    pub divider: f32,
    /// Which look the panels change: 0 = A, left; 1 = B, right.
    pub edited: usize,
}

/// What the window is about.
pub struct Session {
    /// The scene file.
    pub path: PathBuf,
    /// Parameters, time and limits that the scene is loaded with.
    pub options: Options,
    /// What was asked of the loader last.
    asked: Options,
    /// The scene, once one could be loaded.
    pub current: Option<Current>,
    /// What is wrong with the file as it is now, or with rendering it.
    pub trouble: Option<String>,
    /// The camera; meaningful once there is a scene.
    pub rig: Rig,
    /// Whether the camera was moved away from where the file puts it.
    pub is_free: bool,
    /// What was changed of the sun, the sky and materials: one of a kind for each.
    pub stage: Vec<Change>,
    /// Whether drags on the picture move the sun.
    pub is_sun_held: bool,
    /// Whether the ground is drawn as a grid.
    pub has_grid: bool,
    /// Objects that are not shown, by their number in the file's scene.
    pub hidden: BTreeSet<usize>,
    /// How A and B show the scene.
    pub looks: [Look; 2],
    /// A and B beside each other.
    pub comparison: SideBySide,
    /// Whether pictures go on to 64 rays a pixel while nothing changes.
    pub refine: bool,
    /// Whether they go on then until there is little noise.
    pub converge: bool,
    /// How little: what 95 % intervals are wide, as a share of white.
    pub noise: f64,
    /// The plane through the field, and whether it is shown.
    pub slice: Slice,
    /// Whether the plane is shown.
    pub is_sliced: bool,
    /// The time.
    pub clock: Clock,
    /// What was clicked.
    pub picked: Option<Picked>,
    /// The picture that is shown.
    pub shown: Option<Box<Shown>>,
    /// How fast pictures follow each other, where they do.
    pub pace: Pace,
    /// How much of the picture in the making is done, 0 to 1.
    pub progress: Option<f32>,
    /// What renders.
    pub backend: Option<String>,
    /// How often the file was saved.
    edition: u64,
    /// The settings that the file states.
    stated: Settings,
    /// The picture that was asked for last.
    wanted: Option<Request>,
}

impl Session {
    /// A session that knows nothing of its scene yet.
    pub fn new(path: PathBuf, options: Options) -> Session {
        let stated = Settings::default();
        let look = Look {
            settings: stated,
            shadow: None,
            plane: Plane::Colour,
        };
        let lens = zeroset_scene::camera::Lens::Pinhole { fov: 0.7 };
        let camera = Camera {
            eye: glam::Vec3::new(0.0, 0.0, 4.0),
            axes: glam::Mat3::IDENTITY,
            lens,
            near: 0.0,
            far: 1000.0,
            aperture: 0.0,
            focus: 0.0,
        };
        Session {
            path,
            asked: options.clone(),
            clock: Clock::new(options.time),
            options,
            current: None,
            trouble: None,
            rig: Rig::new(&camera, None),
            is_free: false,
            stage: Vec::new(),
            is_sun_held: false,
            has_grid: false,
            hidden: BTreeSet::new(),
            looks: [look; 2],
            comparison: SideBySide {
                is_on: false,
                divider: 0.5,
                edited: 0,
            },
            refine: true,
            converge: false,
            noise: 0.01,
            slice: Slice { axis: 2, at: 0.0 },
            is_sliced: false,
            picked: None,
            shown: None,
            pace: Pace::default(),
            progress: None,
            backend: None,
            edition: 0,
            stated,
            wanted: None,
        }
    }

    /// The scene's name, or the file's as long as there is none, as it is shown.
    pub fn name(&self) -> String {
        match &self.current {
            Some(current) => name(current.scene.name(), NAME),
            None => default_stem(&self.path),
        }
    }

    /// Whether the scene asks for the time.
    pub fn is_animated(&self) -> bool {
        self.current.as_ref().is_some_and(|c| c.loaded.animated)
    }

    /// The parameters of the scene.
    pub fn parameters(&self) -> &[Parameter] {
        self.current.as_ref().map_or(&[], |c| &c.loaded.parameters)
    }

    /// What a parameter is: as it was set, before the scene that has it is loaded.
    pub fn setting(&self, parameter: &Parameter) -> Setting {
        match self.options.set.get(&parameter.name) {
            Some(text) => read(&parameter.value, text).unwrap_or_else(|| parameter.value.clone()),
            None => parameter.default.clone(),
        }
    }

    /// Sets a parameter.
    pub fn set(&mut self, parameter: &Parameter, setting: &Setting) {
        if *setting == parameter.default {
            self.options.set.remove(&parameter.name);
        } else {
            self.options
                .set
                .insert(parameter.name.clone(), written(setting));
        }
    }

    /// Gives a parameter back its default.
    pub fn reset(&mut self, name: &str) {
        self.options.set.remove(name);
    }

    /// Takes what the loader gave.
    pub fn absorb(&mut self, outcome: Outcome) {
        if outcome.is_edit {
            self.edition += 1;
            // parameters that the file no longer has are gone
            let kept = |name: &String| outcome.options.set.contains_key(name);
            let had = |name: &String| self.asked.set.contains_key(name);
            self.options.set.retain(|name, _| kept(name) || !had(name));
            self.asked = outcome.options.clone();
        }
        let loaded = match outcome.result {
            Ok(loaded) => loaded,
            Err(report) => {
                self.trouble = Some(report);
                return;
            }
        };
        self.trouble = None;
        if outcome.is_edit {
            self.forget_what_is_written(&loaded);
        }
        self.keep_stage(&loaded.scene);
        let scene = Arc::new(loaded.scene.clone());
        let moved = match &self.current {
            None => true,
            Some(before) => {
                // how far it sees follows from the scene where the file does not say it
                let stands = |camera: &Camera| Camera {
                    far: 0.0,
                    ..*camera
                };
                stands(before.scene.camera()) != stands(scene.camera())
                    && (outcome.is_edit || !self.is_free)
            }
        };
        if moved && self.current.is_some() && self.rig.stands_at(scene.camera()) {
            // as when the window wrote it: what it orbits stays
            self.rig.see_as_far_as(scene.camera());
            self.is_free = false;
        } else if moved {
            self.rig = Rig::new(scene.camera(), scene.finite_bounds());
            self.is_free = false;
        } else {
            self.rig.see_as_far_as(scene.camera());
        }
        if self.current.is_none() {
            self.slice.at = 0.5 * (Slice::room(&scene).min[2] + Slice::room(&scene).max[2]);
            for look in &mut self.looks {
                look.settings = *scene.settings();
            }
        }
        for look in &mut self.looks {
            look.settings = merged(&self.stated, &look.settings, scene.settings());
        }
        self.stated = *scene.settings();
        if outcome.is_edit {
            self.picked = None;
        }
        self.current = Some(Current { scene, loaded });
        self.set_stage();
    }

    /// Parameters that the file says by now need not be set.
    fn forget_what_is_written(&mut self, loaded: &Loaded) {
        for parameter in &loaded.parameters {
            let text = self.options.set.get(&parameter.name);
            let set = text.and_then(|text| read(&parameter.default, text));
            if set.as_ref() == Some(&parameter.default) {
                self.options.set.remove(&parameter.name);
                self.asked.set.remove(&parameter.name);
            }
        }
    }

    /// Keeps what was changed of the stage as long as the scene has it as it was.
    fn keep_stage(&mut self, now: &Scene) {
        let Some(current) = &self.current else {
            return;
        };
        let before = &current.loaded.scene;
        self.stage.retain(|change| match change {
            Change::Sun { .. } => before.lights() == now.lights(),
            Change::Sky { .. } => before.sky() == now.sky(),
            Change::Material { .. } => before.materials() == now.materials(),
            Change::Parameter { .. } | Change::Camera { .. } => false,
        });
        if before.objects().len() != now.objects().len() {
            self.hidden.clear();
        }
    }

    /// Makes the scene that is shown of the file's.
    fn set_stage(&mut self) {
        let Some(current) = &mut self.current else {
            return;
        };
        let mut scene = current.loaded.scene.clone();
        if self.stage.is_empty() && self.hidden.is_empty() {
            current.scene = Arc::new(scene);
            return;
        }
        let result = scene.edit(|parts| {
            self.stage.iter().for_each(|change| change.apply(parts));
            let mut number = 0..;
            (parts.objects).retain(|_| number.next().is_none_or(|n| !self.hidden.contains(&n)));
        });
        match result {
            Ok(()) => current.scene = Arc::new(scene),
            Err(error) => self.trouble = Some(error.to_string()),
        }
    }

    /// Changes the sun, the sky or a material of what is shown. What was changed of the same before is replaced.
    pub fn change(&mut self, change: Change) {
        let is_same = |other: &Change| match (&change, other) {
            (Change::Sun { light: a, .. }, Change::Sun { light: b, .. }) => a == b,
            (Change::Material { material: a, .. }, Change::Material { material: b, .. }) => a == b,
            (a, b) => std::mem::discriminant(a) == std::mem::discriminant(b),
        };
        self.stage.retain(|other| !is_same(other));
        self.stage.push(change);
        self.set_stage();
    }

    /// Takes back what was changed of the stage.
    pub fn reset_stage(&mut self, is_meant: impl Fn(&Change) -> bool) {
        self.stage.retain(|change| !is_meant(change));
        self.set_stage();
    }

    /// The first light from far away, as it is shown, and its number.
    pub fn sun(&self) -> Option<(usize, Light)> {
        let scene = &self.current.as_ref()?.scene;
        let is_sun = |l: &&Light| matches!(l.source, Source::Directional { .. });
        let number = scene.lights().iter().position(|l| is_sun(&l))?;
        Some((number, scene.lights()[number]))
    }

    /// Turns the sun to where its light travels along `direction`, which need not be of length 1.
    pub fn turn_sun(&mut self, direction: Vec3) {
        if let (Some((light, sun)), Some(direction)) = (self.sun(), direction.try_normalize()) {
            self.change(Change::Sun {
                light,
                direction,
                radiance: sun.radiance,
            });
        }
    }

    /// What was changed of a material.
    pub fn look_of(&self, material: usize) -> MaterialLook {
        let mut all = self.stage.iter().filter_map(|change| match change {
            Change::Material { material: m, look } if *m == material => Some(*look),
            _ => None,
        });
        all.next().unwrap_or_default()
    }

    /// The objects of the file's scene.
    pub fn objects(&self) -> &[Object] {
        self.current
            .as_ref()
            .map_or(&[], |c| c.loaded.scene.objects())
    }

    /// Shows an object, or hides it; the last one that is shown stays.
    pub fn show_object(&mut self, number: usize, is_shown: bool) {
        if is_shown {
            self.hidden.remove(&number);
        } else if self.hidden.len() + 1 < self.objects().len() {
            self.hidden.insert(number);
        }
        self.set_stage();
    }

    /// Shows one object alone; or all again, if it is alone.
    pub fn solo(&mut self, number: usize) {
        let others: BTreeSet<usize> = (0..self.objects().len()).filter(|n| *n != number).collect();
        self.hidden = if self.hidden == others {
            BTreeSet::new()
        } else {
            others
        };
        self.set_stage();
    }

    /// The number in the file's scene of an object that was picked.
    pub fn picked_object(&self) -> Option<usize> {
        let picked = self.picked.as_ref()?;
        let is_it = |o: &Object| (&o.name, &o.place) == (&picked.name, &picked.place);
        self.objects().iter().position(is_it)
    }

    /// What was changed by hand and is not in the file, apart from parameters and methods.
    pub fn changes(&self) -> Vec<Change> {
        let mut all = self.stage.clone();
        if let Some(current) = &self.current
            && self.is_free
            && !self.rig.stands_at(current.loaded.scene.camera())
        {
            all.push(Change::Camera {
                camera: self.rig.camera(),
                target: self.rig.pivot().as_vec3(),
            });
        }
        all
    }

    /// Whether there is anything to write into the file.
    pub fn is_unwritten(&self) -> bool {
        !self.options.set.is_empty() || !self.changes().is_empty()
    }

    /// What to ask of the loader, if anything has changed.
    pub fn to_load(&mut self) -> Option<Options> {
        self.options.time = self.clock.time();
        (self.options != self.asked).then(|| {
            self.asked = self.options.clone();
            self.options.clone()
        })
    }

    /// Whether the scene is loaded with the parameters and the time that are set.
    pub fn is_loaded(&self) -> bool {
        self.options == self.asked
    }

    /// The settings that the file states.
    pub fn stated(&self) -> &Settings {
        &self.stated
    }

    /// The look that the panels change.
    pub fn edited(&mut self) -> &mut Look {
        &mut self.looks[self.comparison.edited.min(1)]
    }

    /// The camera for a picture of this size.
    pub fn camera(&self, size: [u32; 2]) -> Camera {
        let [width, height] = self.stated.size.map(|n| n.max(1) as f32);
        widened(&self.rig.camera(), width / height, size)
    }

    /// The picture to show in so many pixels, if there is a scene.
    pub fn request(&self, size: [u32; 2]) -> Option<Request> {
        let current = self.current.as_ref()?;
        let count = if self.comparison.is_on { 2 } else { 1 };
        Some(Request {
            edition: self.edition,
            scene: Arc::clone(&current.scene),
            camera: self.camera(size),
            size: size.map(|n| n.max(1)),
            looks: self.looks[..count].to_vec(),
            refine: self.refine,
            converge: self.converge.then_some(self.noise),
            slice: self.is_sliced.then_some(self.slice),
        })
    }

    /// Whether the picture that is shown is the one that is wanted, as refined as it will be.
    pub fn is_finished(&self) -> bool {
        let shown = self.shown.as_ref();
        shown.is_some_and(|s| s.is_last && self.wanted.as_ref() == Some(&*s.request))
    }

    /// The picture to ask the engine for, if it is another one than last time.
    pub fn to_render(&mut self, size: [u32; 2]) -> Option<Request> {
        let request = self.request(size)?;
        if self.wanted.as_ref() == Some(&request) {
            return None;
        }
        self.wanted = Some(request.clone());
        Some(request)
    }

    /// What the colours of the edited look mean, where they are numbers.
    pub fn key(&self) -> Option<&LegendKey> {
        let sides = &self.shown.as_ref()?.sides;
        let edited = self.comparison.edited.min(sides.len().saturating_sub(1));
        sides.get(edited)?.key.as_ref()
    }

    /// Puts the camera back to where the file has it.
    pub fn reset_camera(&mut self) {
        if let Some(current) = &self.current {
            self.rig = Rig::new(current.scene.camera(), current.scene.finite_bounds());
            self.is_free = false;
        }
    }

    /// Shows all that has an end.
    pub fn frame_all(&mut self, size: [u32; 2]) {
        let bounds = self.current.as_ref().and_then(|c| c.scene.finite_bounds());
        // the rig's lens sees the height of the scene's shape, which a narrow window widens
        let [width, height] = self.stated.size.map(|n| f64::from(n.max(1)));
        let aspect = f64::from(size[0].max(1)) / f64::from(size[1].max(1));
        self.rig.frame(bounds, aspect.max(width / height));
        self.is_free = true;
    }
}

/// A setting as the command line takes it after `--set NAME=`.
fn written(setting: &Setting) -> String {
    match setting {
        Setting::Number(x) => format!("{x}"),
        Setting::Text(text) => text.clone(),
        Setting::Flag(flag) => flag.to_string(),
        Setting::Colour(srgb) => {
            let [r, g, b] = levels(srgb);
            format!("#{r:02x}{g:02x}{b:02x}")
        }
    }
}

/// An sRGB colour in 256 levels.
pub(crate) fn levels(srgb: &[f64; 3]) -> [u8; 3] {
    srgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// A setting of the same kind as another one from what was written.
fn read(like: &Setting, text: &str) -> Option<Setting> {
    Some(match like {
        Setting::Number(_) => Setting::Number(text.trim().parse().ok()?),
        Setting::Text(_) => Setting::Text(text.to_owned()),
        Setting::Flag(_) => match text.trim().to_lowercase().as_str() {
            "true" | "on" | "yes" | "1" => Setting::Flag(true),
            "false" | "off" | "no" | "0" => Setting::Flag(false),
            _ => return None,
        },
        Setting::Colour(_) => Setting::Colour(zeroset_language::colour::parse(text.trim()).ok()?),
    })
}

/// Settings after the file was edited: what was changed in the window stays, everything else is as the file says now.
fn merged(before: &Settings, edited: &Settings, now: &Settings) -> Settings {
    macro_rules! each {
        ($($field:ident),+) => {
            Settings {
                $($field: if edited.$field == before.$field { now.$field } else { edited.$field }),+
            }
        };
    }
    let settings = each!(
        size,
        march,
        prepass,
        max_steps,
        hit_selection,
        discontinuity_reduction,
        footprint,
        normals,
        shading,
        integrator,
        occlusion,
        antialias,
        seed,
        exposure,
        tone
    );
    Settings {
        size: now.size,
        ..settings
    }
}

#[cfg(test)]
#[path = "session_tests.rs"]
mod tests;
