//! The thread that renders: it takes the newest request, climbs the ladder, and never keeps the window waiting.

use crate::converge::{self, Convergence};
use crate::develop::develop;
use crate::ladder::{Draft, Rates, Rung, rungs};
use crate::slice::{Cut, Slice};
use eframe::egui::ColorImage;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use zeroset_output::view::section::Section;
use zeroset_output::view::{LegendKey, PlaneView};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::camera::Camera;
use zeroset_scene::fallback::Fallback;
use zeroset_scene::film::{Film, Plane};
use zeroset_scene::progressive;
use zeroset_scene::render::{Evaluations, Observer, Prepared, RenderError, Renderer};
use zeroset_scene::scene::Scene;
use zeroset_scene::settings::Antialias::{self, Supersample};
use zeroset_scene::settings::{Integrator, Occlusion, Settings, Shadow};
use zeroset_scene::valid::SceneError;
use zeroset_trace::CpuRenderer;

/// Stack of the thread: a field is compiled as deep as it nests, which a flag may allow to be deep.
const STACK: usize = 64 << 20;
/// What is said when the renderer itself is wrong.
const BROKEN: &str = "the renderer broke down; please report this scene as a bug";
/// Numbers beside a bar of colours.
const TICKS: usize = 6;

/// Makes the renderer, on the thread that will use it.
pub type MakeRenderer = Box<dyn FnOnce() -> Result<Arc<dyn Renderer>, RenderError> + Send>;

/// The renderer on the CPU.
///
/// # Errors
/// [`RenderError::Threads`] where the system does not give that many.
pub fn cpu(threads: Option<usize>) -> Result<Arc<dyn Renderer>, RenderError> {
    Ok(Arc::new(CpuRenderer::new(threads)?))
}

/// How one side of the window shows the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// The methods.
    pub settings: Settings,
    /// The shadow of all lights; `None` where each light has its own.
    pub shadow: Option<Shadow>,
    /// Which plane of the film is seen.
    pub plane: Plane,
}

impl Look {
    /// Whether both take the same rays: what differs is only how they are shown.
    pub(crate) fn has_rays_of(&self, other: &Look) -> bool {
        let plain = |look: &Look| Look {
            settings: Settings {
                exposure: 0.0,
                tone: zeroset_scene::settings::Tone::Soft,
                ..look.settings
            },
            plane: Plane::Colour,
            ..*look
        };
        plain(self) == plain(other)
    }
}

/// What the window wants to show.
#[derive(Clone, Debug)]
pub struct Request {
    /// The scene; its camera and settings are replaced.
    pub scene: Arc<Scene>,
    /// Who looks.
    pub camera: Camera,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// How: one look, or two beside each other.
    pub looks: Vec<Look>,
    /// Whether to go on to 64 rays a pixel.
    pub refine: bool,
    /// Whether to go on then until 95 % intervals are so narrow, as a share of white.
    pub converge: Option<f64>,
    /// A section through the field.
    pub slice: Option<Slice>,
    /// How often the file was saved before: a picture of another edition is of no use to anybody.
    pub edition: u64,
}

impl PartialEq for Request {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.camera, self.size, self.refine) == (other.camera, other.size, other.refine)
            && (&self.looks, self.converge) == (&other.looks, other.converge)
            && self.slice == other.slice
    }
}

impl Request {
    /// Whether both look at the same from the same place.
    pub(crate) fn sees_as(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.camera, self.size) == (other.camera, other.size)
    }

    /// The scene as a look shows it, or a draft of it.
    fn scene_of(&self, look: &Look, draft: Draft) -> Result<Scene, SceneError> {
        let mut parts = Scene::clone(&self.scene).into_parts();
        parts.settings = look.settings;
        let shadow = match draft {
            Draft::Shadowless => Some(Shadow::None),
            Draft::Whole | Draft::Unoccluded => look.shadow,
        };
        if let Some(shadow) = shadow {
            for light in &mut parts.lights {
                light.shadow = shadow;
            }
        }
        if draft != Draft::Whole {
            parts.settings.occlusion = Occlusion::None;
            for object in &mut parts.objects {
                object.occlusion = None;
            }
        }
        parts.build()
    }
}

/// A look's picture.
#[derive(Clone)]
pub struct Exposed {
    /// All planes.
    pub film: Arc<Film>,
    /// What the window shows.
    pub image: Arc<ColorImage>,
    /// What its colours mean, where they are numbers.
    pub key: Option<LegendKey>,
    /// Which picture of the ladder it is.
    pub rung: Rung,
    /// Seconds that its rays took.
    pub seconds: f64,
    /// Primary rays.
    pub rays: u64,
    /// Evaluations of the field.
    pub evaluations: Evaluations,
    /// How near it is to what it converges to, where it does.
    pub convergence: Option<Convergence>,
}

/// A picture of the ladder that is done.
#[derive(Clone)]
pub struct Shown {
    /// What it shows.
    pub request: Arc<Request>,
    /// One for each look.
    pub sides: Vec<Exposed>,
    /// Whether it is the last one.
    pub is_last: bool,
}

/// What the thread says.
pub enum Event {
    /// It renders with this.
    Ready(String),
    /// A picture is done.
    Shown(Box<Shown>),
    /// The device failed, for this reason; the CPU renders from now on.
    FellBack(String),
    /// The scene cannot be rendered.
    Failed(String),
}

/// What both threads know.
struct Shared {
    wanted: Mutex<Wanted>,
    changed: Condvar,
    /// Number of the newest request.
    newest: AtomicU64,
    /// Thousandths of the picture in the making that are done.
    done: AtomicU64,
    ended: AtomicBool,
}

#[derive(Default)]
struct Wanted {
    request: Option<Request>,
    ended: bool,
}

/// The window's end of the thread that renders.
pub struct Engine {
    shared: Arc<Shared>,
    events: Receiver<Event>,
    thread: Option<JoinHandle<()>>,
}

impl Engine {
    /// Starts the thread. `wake` is called whenever there is an event to take.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(
        make: MakeRenderer,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> std::io::Result<Engine> {
        let shared = Arc::new(Shared {
            wanted: Mutex::default(),
            changed: Condvar::new(),
            newest: AtomicU64::new(0),
            done: AtomicU64::new(0),
            ended: AtomicBool::new(false),
        });
        let (tell, events) = channel();
        let theirs = Arc::clone(&shared);
        let thread = std::thread::Builder::new()
            .name("engine".into())
            .stack_size(STACK)
            .spawn(move || Worker::run(&theirs, make, tell, Arc::new(wake)))?;
        Ok(Engine {
            shared,
            events,
            thread: Some(thread),
        })
    }

    /// Asks for a picture. It takes the place of what was asked for before.
    pub fn ask(&self, request: Request) {
        let mut wanted = lock(&self.shared.wanted);
        wanted.request = Some(request);
        self.shared.newest.fetch_add(1, Ordering::Relaxed);
        self.shared.changed.notify_one();
    }

    /// The next thing that happened, if any.
    pub fn take(&self) -> Option<Event> {
        self.events.try_recv().ok()
    }

    /// As [`Engine::take`], and waits for it.
    pub fn wait(&self, most: std::time::Duration) -> Option<Event> {
        self.events.recv_timeout(most).ok()
    }

    /// How much of the picture in the making is done, 0 to 1.
    pub fn progress(&self) -> f32 {
        self.shared.done.load(Ordering::Relaxed) as f32 / 1000.0
    }

    /// Whether the thread still runs.
    pub fn is_alive(&self) -> bool {
        self.thread.as_ref().is_some_and(|t| !t.is_finished())
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        lock(&self.shared.wanted).ended = true;
        self.shared.ended.store(true, Ordering::Relaxed);
        self.shared.changed.notify_one();
        if let Some(thread) = self.thread.take() {
            // it has said what it had to say
            let _ = thread.join();
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How long the first picture may take when another one is wanted already.
const FIRST: Duration = Duration::from_secs(1);

/// Ends a rendering when something newer is wanted.
struct Impatient<'a> {
    shared: &'a Shared,
    /// The request that is being rendered, and its number.
    request: &'a Request,
    number: u64,
    /// Whether it is the first picture of the request, which is finished unless that takes long: otherwise a camera that
    /// moves, or a slider, would show none.
    is_first: bool,
    began: Instant,
}

impl Observer for Impatient<'_> {
    fn advance(&self, rays: u64, total: u64) {
        let done = rays.saturating_mul(1000) / total.max(1);
        self.shared.done.store(done.min(1000), Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        if self.shared.ended.load(Ordering::Relaxed) {
            return true;
        }
        if self.shared.newest.load(Ordering::Relaxed) == self.number {
            return false;
        }
        // a file that was saved is taken at once: it may mend what takes so long
        let is_saved = |newer: &Request| newer.edition != self.request.edition;
        !self.is_first
            || self.began.elapsed() > FIRST
            || lock(&self.shared.wanted)
                .request
                .as_ref()
                .is_some_and(is_saved)
    }
}

/// A look's film, and what it took.
#[derive(Clone)]
struct Take {
    look: Look,
    rung: Rung,
    film: Arc<Film>,
    seconds: f64,
    rays: u64,
    evaluations: Evaluations,
    convergence: Option<Convergence>,
}

impl Take {
    /// Whether it is as good as a picture of the ladder would be.
    fn serves(&self, look: &Look, rung: &Rung, full: [u32; 2]) -> bool {
        let own = own_rung(look, rung);
        self.look.has_rays_of(look)
            && self.rung.size == full
            && self.rung.samples() >= own.samples()
    }
}

/// The best films of what was seen last, so that no ray is taken twice.
#[derive(Default)]
struct Kept {
    seen: Option<Arc<Request>>,
    films: Vec<Take>,
}

impl Kept {
    /// Keeps what a request can use, and nothing else.
    fn turn_to(&mut self, request: &Arc<Request>) {
        if self.seen.as_ref().is_none_or(|seen| !seen.sees_as(request)) {
            self.films.clear();
        }
        let is_asked = |take: &Take| request.looks.iter().any(|l| l.has_rays_of(&take.look));
        self.films.retain(is_asked);
        self.seen = Some(Arc::clone(request));
    }

    fn find(&self, look: &Look, rung: &Rung, full: [u32; 2]) -> Option<&Take> {
        self.films.iter().find(|r| r.serves(look, rung, full))
    }

    fn keep(&mut self, take: &Take, full: [u32; 2]) {
        if take.rung.size == full && take.rung.draft == Draft::Whole {
            self.films.retain(|r| !r.look.has_rays_of(&take.look));
            self.films.push(take.clone());
        }
    }
}

/// Says what happens to the window.
#[derive(Clone)]
struct News {
    tell: Sender<Event>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl News {
    fn say(&self, event: Event) {
        // a window that is gone needs no news
        let _ = self.tell.send(event);
        (self.wake)();
    }
}

/// A scene that is ready for a look.
struct Ready {
    scene: Arc<Scene>,
    look: Look,
    draft: Draft,
    prepared: Box<dyn Prepared>,
}

/// The thread's side.
struct Worker<'a> {
    shared: &'a Shared,
    news: News,
    renderer: Fallback,
    /// Whether the CPU stands in since the last picture.
    fell_back: Arc<AtomicBool>,
    /// One for each look at most.
    ready: Vec<Ready>,
    /// The same for drafts.
    drafts: Vec<Ready>,
    rates: Rates,
    kept: Kept,
    converging: converge::Kept,
    cut: Cut,
}

impl Worker<'_> {
    fn run(
        shared: &Shared,
        make: MakeRenderer,
        tell: Sender<Event>,
        wake: Arc<dyn Fn() + Send + Sync>,
    ) {
        let news = News { tell, wake };
        let renderer = match make() {
            Ok(renderer) => renderer,
            Err(error) => {
                news.say(Event::Failed(error.to_string()));
                return;
            }
        };
        news.say(Event::Ready(renderer.name()));
        let fell_back = Arc::new(AtomicBool::new(false));
        let (told, loud) = (Arc::clone(&fell_back), news.clone());
        let ready = news.clone();
        let make = move || {
            let renderer = cpu(None)?;
            ready.say(Event::Ready(renderer.name()));
            Ok(renderer)
        };
        let tell = move |error: &RenderError| {
            told.store(true, Ordering::Relaxed);
            let reason = match error {
                RenderError::Device { reason, .. } => reason.clone(),
                other => other.to_string(),
            };
            loud.say(Event::FellBack(reason));
        };
        let worker = Worker {
            shared,
            news,
            renderer: Fallback::new(renderer, Box::new(make), Box::new(tell)),
            fell_back,
            ready: Vec::new(),
            drafts: Vec::new(),
            rates: Rates::default(),
            kept: Kept::default(),
            converging: converge::Kept::default(),
            cut: Cut::default(),
        };
        worker.serve();
    }

    fn say(&self, event: Event) {
        self.news.say(event);
    }

    fn serve(mut self) {
        loop {
            let mut wanted = lock(&self.shared.wanted);
            let request = loop {
                if wanted.ended {
                    return;
                }
                if let Some(request) = wanted.request.take() {
                    break request;
                }
                let woken = self.shared.changed.wait(wanted);
                wanted = woken.unwrap_or_else(PoisonError::into_inner);
            };
            let number = self.shared.newest.load(Ordering::Relaxed);
            drop(wanted);
            let request = Arc::new(request);
            // a fault of this program costs a picture, not the window
            let work = || self.climb(request, number);
            match catch_unwind(AssertUnwindSafe(work)) {
                Ok(Ok(()) | Err(RenderError::Cancelled)) => {}
                Ok(Err(error)) => self.say(Event::Failed(error.to_string())),
                Err(_) => {
                    self.say(Event::Failed(BROKEN.to_owned()));
                    self.ready.clear();
                    self.drafts.clear();
                    self.renderer.give_up(&RenderError::Device {
                        reason: BROKEN.to_owned(),
                        advice: None,
                    });
                }
            }
            if self.fell_back.swap(false, Ordering::Relaxed) {
                (self.kept, self.cut) = (Kept::default(), Cut::default());
                self.rates = Rates::default();
                self.converging.clear();
            }
        }
    }

    fn climb(&mut self, request: Arc<Request>, number: u64) -> Result<(), RenderError> {
        let Some(first) = request.looks.first() else {
            return Ok(());
        };
        let sides = request.looks.len();
        // two looks climb together, each as far as its own antialiasing goes
        let ladder = |look: &Look, rates| {
            rungs(
                request.size,
                look.settings.antialias,
                request.refine,
                rates,
                sides,
            )
        };
        let rates = match request.looks.iter().all(may_be_drafted) {
            true => self.rates,
            false => self.rates.of_whole_pictures(),
        };
        let longest = request.looks.iter().map(|l| ladder(l, &rates));
        let mut rungs = longest
            .max_by_key(Vec::len)
            .unwrap_or_else(|| ladder(first, &rates));
        self.kept.turn_to(&request);
        let (full, kept) = (request.size, &self.kept);
        let is_there = |rung: &Rung| {
            request
                .looks
                .iter()
                .all(|l| kept.find(l, rung, full).is_some())
        };
        // of what is there already, only the best is shown
        let first = rungs.iter().rposition(is_there).unwrap_or(0);
        rungs.drain(..first);
        let count = rungs.len();
        let wanted = rungs.last().map_or(1, Rung::samples);
        let mut sums: Vec<Option<Accumulator>> = request.looks.iter().map(|_| None).collect();
        for (i, rung) in (1..).zip(rungs) {
            let observer = Impatient {
                shared: self.shared,
                request: &request,
                number,
                is_first: i == 1,
                began: Instant::now(),
            };
            self.shared.done.store(0, Ordering::Relaxed);
            let films = self.render(&request, &rung, wanted, &mut sums, &observer)?;
            let is_last = i == count && request.converge.is_none();
            self.show(&request, &films, is_last);
        }
        match request.converge {
            Some(noise) => self.converge(&request, noise, wanted, number),
            None => {
                self.converging.clear();
                Ok(())
            }
        }
    }

    /// Goes on until there is little noise, and shows the picture from time to time, once it has as many samples as the ladder's last.
    fn converge(
        &mut self,
        request: &Arc<Request>,
        noise: f64,
        ladder: u32,
        number: u64,
    ) -> Result<(), RenderError> {
        let observer = Impatient {
            shared: self.shared,
            request,
            number,
            is_first: false,
            began: Instant::now(),
        };
        let mut kept = std::mem::take(&mut self.converging);
        kept.turn_to(request);
        let taken = self.rounds(request, noise, ladder, &mut kept, &observer);
        self.converging = kept;
        taken
    }

    fn rounds(
        &mut self,
        request: &Arc<Request>,
        noise: f64,
        ladder: u32,
        kept: &mut converge::Kept,
        observer: &dyn Observer,
    ) -> Result<(), RenderError> {
        let mut shown = Instant::now();
        loop {
            for (side, converging) in kept.pictures.iter_mut().enumerate() {
                if !converging.is_done(noise) {
                    let prepared = self.prepared(request, side, Draft::Whole)?.as_mut();
                    converging.advance(prepared, request, noise, observer)?;
                }
            }
            let all = &kept.pictures;
            let is_done = all.iter().all(|c| c.is_done(noise));
            let is_finer = all.iter().all(|c| c.picture.samples() >= f64::from(ladder));
            if is_done || (is_finer && shown.elapsed() >= converge::PAUSE) {
                let films: Vec<Take> = all.iter().map(|c| taken_of(c, noise)).collect();
                let is_kept = |take: &&Take| {
                    // what has one ray a pixel is shown so once it does not converge any more
                    matches!(take.look.settings.antialias, Supersample { .. })
                };
                for take in films.iter().filter(is_kept) {
                    self.kept.keep(take, request.size);
                }
                self.show(request, &films, is_done);
                shown = Instant::now();
            }
            if is_done {
                return Ok(());
            }
        }
    }

    /// The scene of a look, ready to be rendered: what was ready for another camera or size is ready for this one too, and of
    /// another scene what both have in common is kept.
    fn prepared(
        &mut self,
        request: &Request,
        side: usize,
        draft: Draft,
    ) -> Result<&mut Box<dyn Prepared>, RenderError> {
        let look = request.looks[side];
        let all = match draft {
            Draft::Whole => &mut self.ready,
            Draft::Unoccluded | Draft::Shadowless => &mut self.drafts,
        };
        // a look whose film is kept needs none ready: there may be fewer of them than looks before this one
        let at = side.min(all.len());
        let is_it = all.get(at).is_some_and(|ready| {
            Arc::ptr_eq(&ready.scene, &request.scene)
                && ready.draft == draft
                && ready.look.has_rays_of(&look)
        });
        if !is_it {
            let scene = Arc::new(request.scene_of(&look, draft)?);
            let prepared = if at < all.len() {
                let mut ready = all.remove(at);
                ready.prepared.update(scene)?;
                ready.prepared
            } else {
                self.renderer.prepare(scene)?
            };
            let ready = Ready {
                scene: Arc::clone(&request.scene),
                look,
                draft,
                prepared,
            };
            all.insert(at, ready);
        }
        Ok(&mut all[at].prepared)
    }

    /// A film for each look: one that is there, or a new one. `wanted` is how many samples a pixel has in the end, `sums` are
    /// those of the samples before.
    fn render(
        &mut self,
        request: &Request,
        rung: &Rung,
        wanted: u32,
        sums: &mut [Option<Accumulator>],
        observer: &dyn Observer,
    ) -> Result<Vec<Take>, RenderError> {
        self.ready.truncate(request.looks.len());
        self.drafts.truncate(request.looks.len());
        let mut films = Vec::with_capacity(request.looks.len());
        for (side, look) in request.looks.iter().enumerate() {
            if let Some(take) = self.kept.find(look, rung, request.size) {
                films.push(take.clone());
                continue;
            }
            let own = own_rung(look, rung);
            let mut into = match (sums[side].take(), own.antialias) {
                (Some(before), Supersample { .. }) => before,
                (_, Supersample { filter, .. }) => {
                    let samples = wanted.max(own.samples());
                    Accumulator::new(own.size, Supersample { samples, filter }, &Plane::ALL)
                }
                (_, antialias) => Accumulator::new(own.size, antialias, &Plane::ALL),
            };
            let samples = into.samples()..own.samples();
            let prepared = self.prepared(request, side, own.draft)?;
            // making the scene ready takes as long for a small picture as for a large one
            let began = Instant::now();
            let statistics = prepared.sample(&request.camera, samples, &mut into, observer)?;
            let take = Take {
                look: *look,
                rung: own,
                film: Arc::new(into.film()),
                seconds: began.elapsed().as_secs_f64(),
                rays: statistics.rays,
                evaluations: statistics.evaluations,
                convergence: None,
            };
            if own.samples() == 1 {
                self.rates.measure(own.draft, take.rays, take.seconds);
            }
            if into.filter().is_some() {
                sums[side] = Some(into);
            }
            self.kept.keep(&take, request.size);
            films.push(take);
        }
        Ok(films)
    }

    fn show(&mut self, request: &Arc<Request>, films: &[Take], is_last: bool) {
        let mut sides = Vec::with_capacity(films.len());
        for (look, take) in request.looks.iter().zip(films) {
            let view = PlaneView {
                plane: look.plane,
                transform: look.settings.view_transform(),
                legend: false,
                objects: &[],
            };
            let film = &take.film;
            let mut image = develop(film, &view);
            let slice = request.slice.as_ref();
            let distances = slice.and_then(|s| self.cut.paint(s, request, film, &mut image));
            let distances = distances.map(|farthest| Section::key(farthest, TICKS));
            let key = view.key(film, TICKS).or(distances);
            sides.push(Exposed {
                film: Arc::clone(film),
                image: Arc::new(image),
                rung: take.rung,
                seconds: take.seconds,
                rays: take.rays,
                evaluations: take.evaluations,
                convergence: take.convergence,
                key,
            });
        }
        self.say(Event::Shown(Box::new(Shown {
            request: Arc::clone(request),
            sides,
            is_last,
        })));
    }
}

/// What a picture that converges has by now.
fn taken_of(converging: &converge::Converging, noise: f64) -> Take {
    let picture = &converging.picture;
    let filter = progressive::filter(converging.look.settings.antialias);
    Take {
        look: converging.look,
        rung: Rung {
            size: picture.size(),
            draft: Draft::Whole,
            antialias: Supersample {
                samples: picture.samples().round() as u32,
                filter,
            },
        },
        film: Arc::new(picture.film()),
        seconds: converging.seconds,
        rays: picture.rays(),
        evaluations: converging.evaluations,
        convergence: Some(converging.convergence(noise)),
    }
}

/// Whether occlusion and shadows can be left out for a moment: paths of light have no methods for them, and who looks at other planes
/// wants those.
fn may_be_drafted(look: &Look) -> bool {
    look.plane == Plane::Colour && !matches!(look.settings.integrator, Integrator::Path { .. })
}

/// A picture of the ladder with the antialiasing that a look asks for.
fn own_rung(look: &Look, rung: &Rung) -> Rung {
    let antialias = match (look.settings.antialias, rung.antialias) {
        (Antialias::None, _) | (_, Antialias::None) => Antialias::None,
        (own @ Antialias::Coverage { .. }, _) => own,
        (own, Antialias::Coverage { .. }) => own,
        (Supersample { filter, .. }, Supersample { samples, .. }) => {
            Supersample { samples, filter }
        }
    };
    Rung { antialias, ..*rung }
}

#[cfg(test)]
#[path = "engine_tests.rs"]
mod tests;
