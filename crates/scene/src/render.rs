//! What a renderer is: the CPU's and the GPU's implement the same trait.

use crate::accumulator::Accumulator;
use crate::camera::Camera;
use crate::film::{Film, Plane};
use crate::progressive::{MOST, SampleMap};
use crate::scene::Scene;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A renderer.
pub trait Renderer: Send + Sync {
    /// What it renders with, for people: such as "CPU, 8 threads", or the name of a GPU.
    fn name(&self) -> String;

    /// Makes a scene ready to be rendered: compiles its field, looks at its methods, brings its images to where they are needed.
    ///
    /// # Errors
    /// See [`RenderError`].
    fn prepare(&self, scene: Arc<Scene>) -> Result<Box<dyn Prepared>, RenderError>;

    /// Renders the scene at the size and with the methods that its settings state.
    ///
    /// # Errors
    /// See [`RenderError`].
    fn render(&self, scene: &Scene, observer: &dyn Observer) -> Result<Frame, RenderError> {
        self.render_planes(scene, &Plane::ALL, observer)
    }

    /// Renders these planes only, which takes less memory.
    ///
    /// # Errors
    /// See [`RenderError`].
    fn render_planes(
        &self,
        scene: &Scene,
        planes: &[Plane],
        observer: &dyn Observer,
    ) -> Result<Frame, RenderError> {
        let scene = Arc::new(scene.clone());
        let (camera, settings) = (*scene.camera(), *scene.settings());
        let mut sums = Accumulator::new(settings.size, settings.antialias, planes);
        let samples = 0..sums.wanted();
        let mut prepared = self.prepare(scene)?;
        let statistics = prepared.sample(&camera, samples, &mut sums, observer)?;
        let film = sums.into_film();
        Ok(Frame { film, statistics })
    }
}

/// A scene that a renderer made ready. It can be seen by any camera, in any size, as often as one likes.
pub trait Prepared: Send {
    /// Takes another scene, and keeps what both have in common: what is compiled, images, memory.
    ///
    /// # Errors
    /// See [`RenderError`]; the scene before is then still there.
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError>;

    /// Adds these samples of every pixel, of those that [`Accumulator::wanted`] counts, as `camera` sees the scene. The size of the
    /// picture, its antialiasing and its planes are those of the accumulator.
    ///
    /// Samples from 4 n to 4 n + 3 may share what only changes slowly (occlusion), where they are taken in one call: pictures that are
    /// made in other turns differ by as much as that changes within a pixel.
    ///
    /// # Errors
    /// See [`RenderError`]; some pixels may then have samples that others lack, and the accumulator is only good to be cleared.
    fn sample(
        &mut self,
        camera: &Camera,
        samples: Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError>;

    /// Takes another [`Settings::seed`](crate::settings::Settings::seed), and keeps everything else.
    ///
    /// # Errors
    /// See [`RenderError`].
    fn reseed(&mut self, seed: u32) -> Result<(), RenderError>;

    /// Whether [`Prepared::sample_where`] can give places different numbers of samples.
    fn is_adaptive(&self) -> bool {
        false
    }

    /// Gives an accumulator without samples those that a map says: at each place the first ones, as many as there are for it, which together
    /// count as [`MOST`] do. A renderer that is not adaptive gives all places as many as the place that has the most: a power of two.
    ///
    /// # Errors
    /// As [`Prepared::sample`].
    fn sample_where(
        &mut self,
        camera: &Camera,
        map: &SampleMap,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let count = map.most().max(1);
        let statistics = self.sample(camera, 0..count, into, observer)?;
        into.weigh(MOST / count);
        Ok(statistics)
    }
}

/// A finished picture and what it took.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The planes.
    pub film: Film,
    /// What it took.
    pub statistics: Statistics,
}

/// What a picture took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Primary rays.
    pub rays: u64,
    /// Primary rays that hit a surface.
    pub hits: u64,
    /// Evaluations of the field, by stage.
    pub evaluations: Evaluations,
    /// Seconds, wall clock.
    pub seconds: f64,
    /// Threads.
    pub threads: usize,
}

/// Evaluations of the field, by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Evaluations {
    /// Cones that whole tiles are marched with.
    pub prepass: u64,
    /// Primary rays.
    pub march: u64,
    /// Normals.
    pub normal: u64,
    /// Ambient occlusion.
    pub occlusion: u64,
    /// Shadows.
    pub shadow: u64,
    /// Materials.
    pub material: u64,
}

impl Evaluations {
    /// All stages together.
    pub fn total(&self) -> u64 {
        self.prepass + self.march + self.normal + self.occlusion + self.shadow + self.material
    }

    /// Both together.
    pub fn plus(&self, other: &Self) -> Self {
        Evaluations {
            prepass: self.prepass + other.prepass,
            march: self.march + other.march,
            normal: self.normal + other.normal,
            occlusion: self.occlusion + other.occlusion,
            shadow: self.shadow + other.shadow,
            material: self.material + other.material,
        }
    }
}

/// Who is told of the progress and may end a rendering.
pub trait Observer: Sync {
    /// `rays` more primary rays of `total` are done.
    fn advance(&self, rays: u64, total: u64);
    /// Whether to stop.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Tells nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn advance(&self, _rays: u64, _total: u64) {}
}

/// Can be cancelled from another thread.
impl Observer for AtomicBool {
    fn advance(&self, _rays: u64, _total: u64) {}
    fn is_cancelled(&self) -> bool {
        self.load(Ordering::Relaxed)
    }
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The field cannot be made.
    #[error(transparent)]
    Field(#[from] zeroset_field::field::FieldError),
    /// The field cannot be compiled.
    #[error(transparent)]
    Compile(#[from] zeroset_field::program::CompileError),
    /// A scene changed on its way to the renderer, and is none any more.
    #[error(transparent)]
    Scene(#[from] crate::valid::SceneError),
    /// The observer asked to stop.
    #[error("the rendering was cancelled")]
    Cancelled,
    /// The number of threads asked for cannot be had.
    #[error("cannot start {threads} threads: {reason}")]
    Threads {
        /// Asked for.
        threads: usize,
        /// What the system said.
        reason: String,
    },
    /// The device that renders, a GPU, failed: another renderer may not.
    #[error("the GPU cannot render this: {reason}")]
    Device {
        /// What happened, the adapter named.
        reason: String,
        /// What can be done about it.
        advice: Option<&'static str>,
    },
}
