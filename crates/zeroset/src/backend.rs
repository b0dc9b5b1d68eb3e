//! What renders: the CPU, the GPU, or the CPU where the GPU fails.

use crate::console::Console;
use crate::failure::{Exit, Failure};
use clap::ValueEnum;
#[cfg(feature = "gpu")]
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
#[cfg(feature = "gpu")]
use zeroset_gpu::{Choice, GpuRenderer};
#[cfg(feature = "gpu")]
use zeroset_scene::fallback::Fallback;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::render::{Frame, Observer, Prepared, RenderError, Renderer, Statistics};
use zeroset_scene::scene::Scene;
use zeroset_trace::CpuRenderer;

/// Which renderer is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Backend {
    /// The GPU if there is a real one and it works, else the CPU
    #[default]
    Auto,
    /// The CPU
    Cpu,
    /// The GPU; software that stands for one, if there is nothing else
    Gpu,
}

/// What rendered a picture.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Used {
    /// The CPU.
    Cpu,
    /// A GPU, with its name.
    #[cfg(feature = "gpu")]
    Gpu(String),
}

impl Used {
    /// Its name in JSON.
    pub(crate) fn backend(&self) -> &'static str {
        match self {
            Used::Cpu => "cpu",
            #[cfg(feature = "gpu")]
            Used::Gpu(_) => "gpu",
        }
    }

    /// The GPU's name.
    pub(crate) fn adapter(&self) -> Option<&str> {
        match self {
            Used::Cpu => None,
            #[cfg(feature = "gpu")]
            Used::Gpu(name) => Some(name),
        }
    }
}

/// As much of a picture as there was time for.
pub(crate) struct PartialPicture {
    pub(crate) film: Film,
    pub(crate) statistics: Statistics,
    pub(crate) used: Used,
    /// The tiles that are finished (left, top, width, height), unless all of it is.
    pub(crate) finished: Option<Vec<[u32; 4]>>,
}

/// The renderer that was asked for.
pub(crate) struct ChosenRenderer {
    threads: Option<usize>,
    /// Made when it is needed.
    cpu: Arc<OnceLock<CpuRenderer>>,
    /// The GPU, or the CPU where it fails.
    #[cfg(feature = "gpu")]
    gpu: Option<KnownGpu>,
}

/// The GPU, and what is known of it.
#[cfg(feature = "gpu")]
struct KnownGpu {
    title: String,
    renderer: Box<dyn Renderer>,
    /// Whether the CPU stands in for it by now.
    failed: Arc<AtomicBool>,
}

#[cfg(feature = "gpu")]
impl KnownGpu {
    fn is_there(&self) -> bool {
        !self.failed.load(Ordering::Relaxed)
    }
}

impl ChosenRenderer {
    /// Looks for what is asked for. `adapter` is a part of a GPU's name.
    pub(crate) fn new(
        backend: Backend,
        adapter: Option<&str>,
        threads: Option<usize>,
        console: &Console,
    ) -> Result<ChosenRenderer, Failure> {
        let cpu = Arc::new(OnceLock::new());
        #[cfg(feature = "gpu")]
        let gpu = gpu(backend, adapter)?.map(|gpu| {
            let falls_back = backend == Backend::Auto && adapter.is_none();
            standing(gpu, falls_back, threads, &cpu, console)
        });
        #[cfg(not(feature = "gpu"))]
        {
            let _ = console;
            refused(backend, adapter)?;
        }
        let engine = ChosenRenderer {
            threads,
            cpu,
            #[cfg(feature = "gpu")]
            gpu,
        };
        if backend == Backend::Cpu {
            // a wrong number of threads is told before anything is loaded
            engine.cpu()?;
        }
        Ok(engine)
    }

    /// Renders at least these planes. Where the GPU fails and the CPU may stand in, says so, calls `restart` and begins anew.
    pub(crate) fn render(
        &self,
        scene: &Scene,
        planes: &[Plane],
        observer: &dyn Observer,
        restart: &(dyn Fn() + Sync),
    ) -> Result<(Frame, Used), RenderError> {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = self.gpu.as_ref().filter(|gpu| gpu.is_there()) {
            let watched = Watched {
                observer,
                failed: &gpu.failed,
                restart,
                told: AtomicBool::new(false),
            };
            let frame = gpu.renderer.render_planes(scene, planes, &watched)?;
            let used = match gpu.is_there() {
                true => Used::Gpu(gpu.title.clone()),
                false => Used::Cpu,
            };
            return Ok((frame, used));
        }
        #[cfg(not(feature = "gpu"))]
        let _ = restart;
        let frame = self.cpu()?.render_planes(scene, planes, observer)?;
        Ok((frame, Used::Cpu))
    }

    /// As [`ChosenRenderer::render`], and keeps what is finished when the observer ends it; `None` where nothing is kept.
    pub(crate) fn render_part(
        &self,
        scene: &Scene,
        planes: &[Plane],
        observer: &dyn Observer,
        restart: &(dyn Fn() + Sync),
    ) -> Result<Option<PartialPicture>, RenderError> {
        // neither a GPU nor a scene that moves keeps parts of a picture
        if self.is_on_gpu() || !scene.moments().is_empty() {
            let (frame, used) = match self.render(scene, planes, observer, restart) {
                Err(RenderError::Cancelled) => return Ok(None),
                other => other?,
            };
            return Ok(Some(PartialPicture {
                film: frame.film,
                statistics: frame.statistics,
                used,
                finished: None,
            }));
        }
        let prepared = self.cpu()?.prepare_scene(scene.clone().into())?;
        let (part, film) = prepared.render_part(scene.settings().size, planes, observer);
        Ok(Some(PartialPicture {
            film,
            statistics: part.statistics,
            used: Used::Cpu,
            finished: (!part.is_whole).then_some(part.finished),
        }))
    }

    /// Makes a scene ready, and says what will render it.
    pub(crate) fn prepare(&self, scene: &Scene) -> Result<(Box<dyn Prepared>, Used), RenderError> {
        let scene = Arc::new(scene.clone());
        #[cfg(feature = "gpu")]
        if let Some(gpu) = self.gpu.as_ref().filter(|gpu| gpu.is_there()) {
            let prepared = gpu.renderer.prepare(scene)?;
            return Ok((prepared, self.used()));
        }
        Ok((self.cpu()?.prepare(scene)?, Used::Cpu))
    }

    /// What renders by now.
    pub(crate) fn used(&self) -> Used {
        #[cfg(feature = "gpu")]
        if let Some(gpu) = self.gpu.as_ref().filter(|gpu| gpu.is_there()) {
            return Used::Gpu(gpu.title.clone());
        }
        Used::Cpu
    }

    fn is_on_gpu(&self) -> bool {
        #[cfg(feature = "gpu")]
        return self.gpu.as_ref().is_some_and(KnownGpu::is_there);
        #[cfg(not(feature = "gpu"))]
        false
    }

    fn cpu(&self) -> Result<&CpuRenderer, RenderError> {
        made(&self.cpu, self.threads)
    }
}

/// The renderer on the CPU, made when it is needed.
fn made(cpu: &OnceLock<CpuRenderer>, threads: Option<usize>) -> Result<&CpuRenderer, RenderError> {
    if let Some(renderer) = cpu.get() {
        return Ok(renderer);
    }
    let renderer = CpuRenderer::new(threads)?;
    Ok(cpu.get_or_init(|| renderer))
}

/// A GPU that the CPU may stand in for.
#[cfg(feature = "gpu")]
fn standing(
    gpu: GpuRenderer,
    falls_back: bool,
    threads: Option<usize>,
    cpu: &Arc<OnceLock<CpuRenderer>>,
    console: &Console,
) -> KnownGpu {
    let (title, failed) = (gpu.adapter().title(), Arc::new(AtomicBool::new(false)));
    let renderer: Box<dyn Renderer> = if falls_back {
        let (console, told) = (*console, Arc::clone(&failed));
        let tell = move |error: &RenderError| {
            console.note(format_args!("{error}\nRendering on the CPU."));
            told.store(true, Ordering::Relaxed);
        };
        let cpu = Arc::clone(cpu);
        let make = move || Ok(Arc::new(made(&cpu, threads)?.clone()) as Arc<dyn Renderer>);
        Box::new(Fallback::new(Arc::new(gpu), Box::new(make), Box::new(tell)))
    } else {
        Box::new(gpu)
    };
    KnownGpu {
        title,
        renderer,
        failed,
    }
}

/// Begins to count anew when another renderer begins anew.
#[cfg(feature = "gpu")]
struct Watched<'a> {
    observer: &'a dyn Observer,
    failed: &'a AtomicBool,
    restart: &'a (dyn Fn() + Sync),
    told: AtomicBool,
}

#[cfg(feature = "gpu")]
impl Observer for Watched<'_> {
    fn advance(&self, rays: u64, total: u64) {
        if self.failed.load(Ordering::Relaxed) && !self.told.swap(true, Ordering::Relaxed) {
            (self.restart)();
        }
        self.observer.advance(rays, total);
    }

    fn is_cancelled(&self) -> bool {
        self.observer.is_cancelled()
    }
}

/// The GPU that is asked for, if one is; a failure where one must be there and is not.
#[cfg(feature = "gpu")]
pub(crate) fn gpu(backend: Backend, adapter: Option<&str>) -> Result<Option<GpuRenderer>, Failure> {
    let choice = match (backend, adapter) {
        (Backend::Cpu, None) => return Ok(None),
        (Backend::Cpu, Some(_)) => {
            let help = "leave out --adapter, or ask for --backend gpu";
            return Err(Failure::with_help(
                Exit::Usage,
                "the CPU has no adapter",
                help,
            ));
        }
        (_, Some(name)) => Choice::Named(name.to_owned()),
        (Backend::Auto, None) => Choice::Auto,
        (Backend::Gpu, None) => Choice::Any,
    };
    match (GpuRenderer::new(&choice), choice) {
        (Ok(renderer), _) => Ok(Some(renderer)),
        (Err(error), Choice::Auto) => {
            tracing::debug!("rendering on the CPU: {error}");
            Ok(None)
        }
        (Err(error), _) => Err(match error.advice() {
            Some(advice) => Failure::with_help(Exit::Job, error.to_string(), advice),
            None => Failure::new(Exit::Job, error.to_string()),
        }),
    }
}

/// A failure where a GPU is asked for.
#[cfg(not(feature = "gpu"))]
pub(crate) fn refused(backend: Backend, adapter: Option<&str>) -> Result<(), Failure> {
    if backend == Backend::Gpu || adapter.is_some() {
        return Err(Failure::with_help(
            Exit::Job,
            "this zeroset was built without the GPU's renderer",
            "build it with `cargo build --release --features gpu`, or leave out --backend and --adapter",
        ));
    }
    Ok(())
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU32;
    use zeroset_gpu::testing::{Faults, with_faults};
    use zeroset_language::load::{Language, Options, load_text};
    use zeroset_scene::render::Silent;

    type Outcome = Result<(Frame, Used), RenderError>;

    /// A picture by a GPU without memory, and how often it was begun anew.
    fn rendered(test: &str, falls_back: bool) -> Option<(Outcome, u32)> {
        let gpu = with_faults(test, Faults::default().with_memory(20_000))?;
        let console = Console::silent();
        let mut engine =
            ChosenRenderer::new(Backend::Cpu, None, Some(1), &console).expect("the CPU");
        engine.gpu = Some(standing(gpu, falls_back, Some(1), &engine.cpu, &console));
        let options = Options {
            size: Some([64, 48]),
            ..Options::default()
        };
        let text = "show(sphere())";
        let loaded = load_text("a.star", text, Language::Starlark, None, &options);
        let scene = loaded.expect("a valid scene").scene;
        let restarts = AtomicU32::new(0);
        let result = engine.render(&scene, &Plane::ALL, &Silent, &|| {
            restarts.fetch_add(1, Ordering::Relaxed);
        });
        if result.is_ok() {
            // the GPU is not asked again
            let again = engine.render(&scene, &Plane::ALL, &Silent, &|| {
                restarts.store(9, Ordering::Relaxed);
            });
            assert_eq!(again.map(|(_, used)| used), Ok(Used::Cpu));
        }
        Some((result, restarts.into_inner()))
    }

    #[test]
    fn the_cpu_stands_in_for_a_gpu_that_fails() {
        let Some((result, restarts)) = rendered("the_cpu_stands_in_for_a_gpu_that_fails", true)
        else {
            return;
        };
        let (frame, used) = result.expect("a picture");
        assert!(frame.statistics.hits > 100);
        assert_eq!((used, restarts), (Used::Cpu, 1));
    }

    #[test]
    fn a_gpu_that_was_asked_for_fails_with_advice() {
        let Some((result, _)) = rendered("a_gpu_that_was_asked_for_fails_with_advice", false)
        else {
            return;
        };
        match result {
            Err(RenderError::Device { advice, .. }) => assert!(advice.is_some()),
            other => panic!("{:?}", other.map(|(_, used)| used)),
        }
    }
}
