//! A renderer that another one stands in for.

use crate::accumulator::Accumulator;
use crate::camera::Camera;
use crate::progressive::SampleMap;
use crate::render::{Observer, Prepared, RenderError, Renderer, Statistics};
use crate::scene::Scene;
use crate::settings::Settings;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Makes the renderer that stands in.
pub type Make = Box<dyn Fn() -> Result<Arc<dyn Renderer>, RenderError> + Send + Sync>;
/// Who is told that the first renderer failed, and why; what was rendered so far is lost.
pub type Tell = Box<dyn Fn(&RenderError) + Send + Sync>;

/// Renders with one renderer as long as its device works ([`RenderError::Device`] says when it does not), and from then on with
/// another one.
pub struct Fallback {
    shared: Arc<Shared>,
}

struct Shared {
    first: Mutex<Option<Arc<dyn Renderer>>>,
    make: Make,
    second: OnceLock<Arc<dyn Renderer>>,
    tell: Tell,
}

impl Fallback {
    /// `first` until it fails, then what `make` makes.
    pub fn new(first: Arc<dyn Renderer>, make: Make, tell: Tell) -> Fallback {
        Fallback {
            shared: Arc::new(Shared {
                first: Mutex::new(Some(first)),
                make,
                second: OnceLock::new(),
                tell,
            }),
        }
    }

    /// Gives the first renderer up, as if its device had failed: for one that broke down.
    pub fn give_up(&self, error: &RenderError) {
        self.shared.give_up(error);
    }
}

impl Shared {
    fn first(&self) -> MutexGuard<'_, Option<Arc<dyn Renderer>>> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn second(&self) -> Result<Arc<dyn Renderer>, RenderError> {
        if let Some(second) = self.second.get() {
            return Ok(Arc::clone(second));
        }
        let made = (self.make)()?;
        Ok(Arc::clone(self.second.get_or_init(|| made)))
    }

    /// The renderer that works, and whether it is the first one.
    fn current(&self) -> Result<(Arc<dyn Renderer>, bool), RenderError> {
        let first = self.first().clone();
        match first {
            Some(first) => Ok((first, true)),
            None => Ok((self.second()?, false)),
        }
    }

    /// Gives the first renderer up; told once, when the other one is there. Where it cannot be made, whoever asks for it next is
    /// told why.
    fn give_up(&self, error: &RenderError) {
        if self.first().take().is_some() && self.second().is_ok() {
            (self.tell)(error);
        }
    }

    fn prepare(&self, scene: &Arc<Scene>) -> Result<(Box<dyn Prepared>, bool), RenderError> {
        let (renderer, is_first) = self.current()?;
        match renderer.prepare(Arc::clone(scene)) {
            Err(error @ RenderError::Device { .. }) if is_first => {
                self.give_up(&error);
                Ok((self.second()?.prepare(Arc::clone(scene))?, false))
            }
            made => made.map(|prepared| (prepared, is_first)),
        }
    }
}

impl Renderer for Fallback {
    fn name(&self) -> String {
        match self.shared.current() {
            Ok((renderer, _)) => renderer.name(),
            Err(error) => error.to_string(),
        }
    }

    fn prepare(&self, scene: Arc<Scene>) -> Result<Box<dyn Prepared>, RenderError> {
        let (prepared, is_first) = self.shared.prepare(&scene)?;
        Ok(Box::new(Standing {
            shared: Arc::clone(&self.shared),
            scene,
            prepared,
            is_first,
        }))
    }
}

/// A scene that either renderer made ready.
struct Standing {
    shared: Arc<Shared>,
    scene: Arc<Scene>,
    prepared: Box<dyn Prepared>,
    is_first: bool,
}

impl Standing {
    /// Makes the scene ready with the other renderer.
    fn fall_back(&mut self, error: &RenderError) -> Result<(), RenderError> {
        self.shared.give_up(error);
        (self.prepared, self.is_first) = self.shared.prepare(&self.scene)?;
        Ok(())
    }
}

impl Prepared for Standing {
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError> {
        match self.prepared.update(Arc::clone(&scene)) {
            Err(error @ RenderError::Device { .. }) if self.is_first => {
                self.scene = scene;
                self.fall_back(&error)
            }
            Ok(()) => {
                self.scene = scene;
                Ok(())
            }
            error => error,
        }
    }

    fn sample(
        &mut self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let result = self
            .prepared
            .sample(camera, samples.clone(), into, observer);
        match result {
            Err(error @ RenderError::Device { .. }) if self.is_first => {
                self.fall_back(&error)?;
                // what the accumulator holds is of a device that failed: all of it is sampled anew
                into.clear();
                self.prepared.sample(camera, 0..samples.end, into, observer)
            }
            result => result,
        }
    }

    fn reseed(&mut self, seed: u32) -> Result<(), RenderError> {
        // so that a renderer that stands in has it too
        let settings = Settings {
            seed,
            ..*self.scene.settings()
        };
        self.scene = Arc::new(Scene::clone(&self.scene).with_settings(settings)?);
        match self.prepared.reseed(seed) {
            Err(error @ RenderError::Device { .. }) if self.is_first => self.fall_back(&error),
            result => result,
        }
    }

    fn is_adaptive(&self) -> bool {
        self.prepared.is_adaptive()
    }

    fn sample_where(
        &mut self,
        camera: &Camera,
        map: &SampleMap,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        match self.prepared.sample_where(camera, map, into, observer) {
            Err(error @ RenderError::Device { .. }) if self.is_first => {
                self.fall_back(&error)?;
                into.clear();
                self.prepared.sample_where(camera, map, into, observer)
            }
            result => result,
        }
    }
}
