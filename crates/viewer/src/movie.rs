//! Animations made from the window: what is asked for, and how far it is.

use crate::session::Session;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use zeroset_language::load::Options;
use zeroset_language::revision::Change;
use zeroset_scene::camera::Camera;
use zeroset_scene::settings::{Settings, Shadow};

/// An animation that is to be made.
#[derive(Clone, Debug)]
pub struct Movie {
    /// The scene file.
    pub scene: PathBuf,
    /// The file to write, whose ending says of what kind it is.
    pub path: PathBuf,
    /// How many frames it has; the first one is at time 0.
    pub frames: u32,
    /// Frames a second.
    pub fps: f64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Parameters and limits.
    pub options: Options,
    /// The methods.
    pub settings: Settings,
    /// The shadow of all lights, where it is not each light's own.
    pub shadow: Option<Shadow>,
    /// Who looks, where that is not as the file says.
    pub camera: Option<Camera>,
    /// What was changed of the sun, the sky and materials.
    pub changes: Vec<Change>,
}

impl Movie {
    /// What the window shows, over the length of its timeline.
    pub fn of(session: &Session, path: PathBuf, size: [u32; 2]) -> Movie {
        let clock = &session.clock;
        let look = session.looks[session.comparison.edited.min(1)];
        Movie {
            scene: session.path.clone(),
            path,
            frames: (clock.length * clock.fps).round().max(1.0) as u32,
            fps: clock.fps,
            size,
            options: session.options.clone(),
            settings: look.settings,
            shadow: look.shadow,
            camera: session.is_free.then(|| session.camera(size)),
            changes: session.stage.clone(),
        }
    }
}

/// How far an animation is, and whether it is still wanted.
#[derive(Debug, Default)]
pub struct Progress {
    frames: AtomicU32,
    is_cancelled: AtomicBool,
}

impl Progress {
    /// Another frame begins.
    pub fn advance(&self) {
        self.frames.fetch_add(1, Ordering::Relaxed);
    }

    /// Frames that were begun.
    pub fn frames(&self) -> u32 {
        self.frames.load(Ordering::Relaxed)
    }

    /// Ends it before its next frame.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether it is to end.
    pub fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

/// Makes an animation, or says why there is none.
pub type Animate = fn(&Movie, &Progress) -> Result<(), String>;
