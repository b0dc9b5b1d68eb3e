//! Motion blur: each sample of a pixel sees the scene at a moment of its own.
//!
//! The moments are scenes that were made before ([`Scene::moments`]). A renderer takes one after the other ([`Prepared::update`]): where only
//! parameters differ it keeps what is compiled, so no method of marching or of light knows of time.

use crate::accumulator::Accumulator;
use crate::camera::Camera;
use crate::progressive::{MOST, SampleMap};
use crate::render::{Observer, Prepared, RenderError, Statistics};
use crate::scene::Scene;
use crate::settings::Settings;
use std::ops::Range;
use std::sync::Arc;

/// Samples that see one moment together, where there are enough: those that share what changes slowly, see [`Prepared::sample`].
const TOGETHER: u32 = 4;

/// Which of `count` moments sample number `index` sees, of as many as are `wanted`: the first samples, however many, are spread evenly over
/// all moments (van der Corput 1935), from a place on that the seed chooses.
pub fn moment_of(index: u32, wanted: u32, count: u32, seed: u32) -> u32 {
    let together = if wanted >= TOGETHER.saturating_mul(count) {
        TOGETHER
    } else {
        1
    };
    let share = (index / together)
        .reverse_bits()
        .wrapping_add(seed.wrapping_mul(0x9e37_79b9));
    ((u64::from(share) * u64::from(count)) >> 32) as u32
}

/// A scene that a renderer made ready, at any of its moments.
pub struct Moving {
    inner: Box<dyn Prepared>,
    scene: Arc<Scene>,
    seed: u32,
    /// The moment that the renderer has, by number; none where it has the scene itself.
    at: Option<u32>,
}

impl Moving {
    /// `inner` has the scene itself.
    pub fn new(scene: Arc<Scene>, inner: Box<dyn Prepared>) -> Moving {
        let seed = scene.settings().seed;
        let at = None;
        Moving {
            inner,
            scene,
            seed,
            at,
        }
    }

    /// Gives the renderer the scene at a moment.
    fn go_to(&mut self, moment: u32) -> Result<(), RenderError> {
        if self.at == Some(moment) {
            return Ok(());
        }
        let settings = Settings {
            seed: self.seed,
            ..*self.scene.settings()
        };
        if let Some(scene) = self.scene.moments().get(moment as usize) {
            let scene = Scene::clone(scene).with_settings(settings)?;
            self.at = None;
            self.inner.update(Arc::new(scene))?;
            self.at = Some(moment);
        }
        Ok(())
    }
}

impl Prepared for Moving {
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError> {
        self.inner.update(Arc::clone(&scene))?;
        (self.seed, self.at) = (scene.settings().seed, None);
        self.scene = scene;
        Ok(())
    }

    fn sample(
        &mut self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let count = self.scene.moments().len() as u32;
        if count == 0 {
            return self.inner.sample(camera, samples, into, observer);
        }
        let (wanted, seed) = (into.wanted(), self.seed);
        let moment = |i: u32| moment_of(i, wanted, count, seed);
        let mut order: Vec<u32> = samples.clone().collect();
        order.sort_by_key(|&i| (moment(i), i));
        let mut sum = Statistics::default();
        for together in order.chunk_by(|&a, &b| moment(a) == moment(b) && a + 1 == b) {
            let (first, number) = (together[0], together.len() as u32);
            let observer = Share {
                observer,
                all: samples.len() as u64,
                now: u64::from(number),
            };
            let taken = first..first + number;
            let now = self.sample_at(moment(first), camera, taken, into, &observer)?;
            sum = Statistics {
                rays: sum.rays + now.rays,
                hits: sum.hits + now.hits,
                evaluations: sum.evaluations.plus(&now.evaluations),
                seconds: sum.seconds + now.seconds,
                threads: now.threads,
            };
        }
        Ok(sum)
    }

    fn reseed(&mut self, seed: u32) -> Result<(), RenderError> {
        self.seed = seed;
        self.inner.reseed(seed)
    }

    fn is_adaptive(&self) -> bool {
        self.scene.moments().is_empty() && self.inner.is_adaptive()
    }

    fn sample_where(
        &mut self,
        camera: &Camera,
        map: &SampleMap,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        if self.scene.moments().is_empty() {
            return self.inner.sample_where(camera, map, into, observer);
        }
        // all places alike: a moment is one of the whole picture
        let count = map.most().max(1);
        let statistics = self.sample(camera, 0..count, into, observer)?;
        into.weigh(MOST / count);
        Ok(statistics)
    }
}

impl Moving {
    /// Adds samples that see one moment.
    fn sample_at(
        &mut self,
        moment: u32,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        self.go_to(moment)?;
        // a camera of the scene's own moves as the scene says, any other stands still
        let own = self.scene.moments().get(moment as usize);
        let seen = match own.filter(|_| camera == self.scene.camera()) {
            Some(scene) => *scene.camera(),
            None => *camera,
        };
        self.inner.sample(&seen, samples, into, observer)
    }
}

/// Tells of samples that are taken a few at a time how many there are of all.
struct Share<'a> {
    observer: &'a dyn Observer,
    /// All samples.
    all: u64,
    /// Those that are taken now.
    now: u64,
}

impl Observer for Share<'_> {
    fn advance(&self, rays: u64, total: u64) {
        let total = total / self.now * self.all;
        self.observer.advance(rays, total);
    }

    fn is_cancelled(&self) -> bool {
        self.observer.is_cancelled()
    }
}
