use super::*;
use std::sync::atomic::AtomicUsize;
use std::time::Duration;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::render::Statistics;
use zeroset_scene::settings::{Filter, March};

const PATIENCE: Duration = Duration::from_secs(60);

fn request(text: &str, size: [u32; 2]) -> Request {
    let loaded = load_text(
        "test.star",
        text,
        Language::Starlark,
        None,
        &Options::default(),
    );
    let scene = Arc::new(loaded.unwrap().scene);
    let look = Look {
        settings: *scene.settings(),
        shadow: None,
        plane: Plane::Colour,
    };
    Request {
        edition: 0,
        camera: *scene.camera(),
        size,
        looks: vec![look],
        refine: false,
        converge: None,
        slice: None,
        scene,
    }
}

/// Counts, and takes its time: a picture of one ray a pixel is there at once, one with more waits until it may go on or
/// until nobody wants it any more.
#[derive(Clone, Default)]
struct Counting {
    calls: Arc<AtomicUsize>,
    cancelled: Arc<AtomicUsize>,
    may_finish: Arc<AtomicBool>,
}

impl Test for Counting {
    fn sample(
        &self,
        _: &Scene,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        self.calls.fetch_add(1, Ordering::SeqCst);
        let [width, height] = into.size();
        while into.antialias() != Antialias::None && !self.may_finish.load(Ordering::SeqCst) {
            if observer.is_cancelled() {
                self.cancelled.fetch_add(1, Ordering::SeqCst);
                return Err(RenderError::Cancelled);
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(Statistics {
            rays: u64::from(width * height),
            ..Statistics::default()
        })
    }
}

/// What a renderer of a test does.
trait Test: Clone + Send + Sync + 'static {
    fn sample(
        &self,
        scene: &Scene,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError>;
}

struct Testing<T>(T);

impl<T: Test> Renderer for Testing<T> {
    fn name(&self) -> String {
        "test".to_owned()
    }

    fn prepare(&self, scene: Arc<Scene>) -> Result<Box<dyn Prepared>, RenderError> {
        Ok(Box::new(Tested(self.0.clone(), scene)))
    }
}

struct Tested<T>(T, Arc<Scene>);

impl<T: Test> Prepared for Tested<T> {
    fn update(&mut self, scene: Arc<Scene>) -> Result<(), RenderError> {
        self.1 = scene;
        Ok(())
    }

    fn sample(
        &mut self,
        _: &Camera,
        samples: std::ops::Range<u32>,
        into: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let statistics = self.0.sample(&self.1, into, observer)?;
        into.count(samples.len() as u32);
        Ok(statistics)
    }

    fn reseed(&mut self, _: u32) -> Result<(), RenderError> {
        Ok(())
    }
}

fn started(renderer: impl Test) -> Engine {
    let make = || Ok(Arc::new(Testing(renderer)) as Arc<dyn Renderer>);
    let engine = Engine::start(Box::new(make), || {}).unwrap();
    assert!(matches!(engine.wait(PATIENCE), Some(Event::Ready(name)) if name == "test"));
    engine
}

#[track_caller]
fn picture(engine: &Engine) -> Shown {
    match engine.wait(PATIENCE) {
        Some(Event::Shown(shown)) => *shown,
        Some(Event::Failed(reason)) => panic!("{reason}"),
        _ => panic!("no picture"),
    }
}

#[track_caller]
fn last(engine: &Engine) -> Shown {
    loop {
        let shown = picture(engine);
        if shown.is_last {
            return shown;
        }
    }
}

const BALL: &str = "show(sphere())\nrender(aa = supersample(4, filter = \"box\"))\n";

#[test]
fn pictures_come_from_coarse_to_refined() {
    let engine = Engine::start(Box::new(|| cpu(Some(2))), || {}).unwrap();
    assert!(
        matches!(engine.wait(PATIENCE), Some(Event::Ready(name)) if name.contains("2 threads"))
    );
    // more than an unmeasured machine can do in time
    engine.ask(request(BALL, [400, 300]));
    let mut samples = Vec::new();
    loop {
        let shown = picture(&engine);
        let size = shown.sides[0].rung.size;
        assert!(
            size == [400, 300] || (samples.is_empty() && size[0] < 400),
            "{size:?}"
        );
        let [width, height] = size.map(|n| n as usize);
        assert_eq!(shown.sides[0].image.size, [width, height]);
        let side = &shown.sides[0];
        assert!(side.evaluations.total() > side.rays / 4 && side.seconds > 0.0);
        let middle = shown.sides[0].image.pixels[height / 2 * width + width / 2];
        assert!(middle.r() > 40, "the ball is not there: {middle:?}");
        samples.push(shown.sides[0].rung.samples());
        if shown.is_last {
            break;
        }
    }
    assert_eq!(samples, [1, 1, 4]);
}

#[test]
fn the_newest_request_ends_the_others() {
    let renderer = Counting::default();
    let engine = started(renderer.clone());
    engine.ask(request(BALL, [8, 8]));
    assert_eq!(picture(&engine).sides[0].rung.samples(), 1);
    while renderer.calls.load(Ordering::SeqCst) < 2 {
        std::thread::yield_now();
    }
    // the refined picture is waiting now
    engine.ask(request(BALL, [16, 16]));
    let next = picture(&engine);
    assert_eq!(
        (next.sides[0].rung.size, next.sides[0].rung.samples()),
        ([16, 16], 1)
    );
    assert_eq!(renderer.cancelled.load(Ordering::SeqCst), 1);
    renderer.may_finish.store(true, Ordering::SeqCst);
    let refined = picture(&engine);
    assert!(refined.is_last && refined.sides[0].rung.samples() == 4);
}

/// A camera that never rests shows pictures all the same.
#[test]
fn the_first_picture_of_a_request_is_always_finished() {
    let engine = started(Counting::default());
    for width in 1..=20 {
        engine.ask(request(BALL, [width, 4]));
        assert_eq!(picture(&engine).sides[0].rung.size, [width, 4]);
    }
}

#[test]
fn what_is_only_shown_differently_takes_no_rays() {
    let renderer = Counting::default();
    renderer.may_finish.store(true, Ordering::SeqCst);
    let engine = started(renderer.clone());
    let first = request(BALL, [8, 8]);
    engine.ask(first.clone());
    last(&engine);
    let calls = renderer.calls.load(Ordering::SeqCst);
    let mut other = first.clone();
    other.looks[0].plane = Plane::Steps;
    other.looks[0].settings.exposure = 1.0;
    other.slice = Some(Slice { axis: 0, at: 0.1 });
    engine.ask(other.clone());
    let shown = picture(&engine);
    assert!(shown.is_last && shown.sides[0].key.is_some());
    assert_eq!(renderer.calls.load(Ordering::SeqCst), calls);
    // one that goes on from there takes only what is missing
    other.refine = true;
    engine.ask(other.clone());
    assert_eq!(last(&engine).sides[0].rung.samples(), 64);
    assert_eq!(renderer.calls.load(Ordering::SeqCst), calls + 2);
    // and another method takes all
    other.looks[0].settings.march = March::Sphere;
    engine.ask(other);
    assert_eq!(last(&engine).sides[0].rung.samples(), 64);
    assert_eq!(renderer.calls.load(Ordering::SeqCst), calls + 2 + 4);
}

#[test]
fn two_looks_are_two_pictures() {
    let engine = Engine::start(Box::new(|| cpu(Some(2))), || {}).unwrap();
    let mut wanted = request(BALL, [48, 48]);
    let mut other = wanted.looks[0];
    other.settings.antialias = Antialias::None;
    other.plane = Plane::Normal;
    wanted.looks.push(other);
    engine.wait(PATIENCE);
    engine.ask(wanted);
    let shown = last(&engine);
    assert_eq!(shown.sides.len(), 2);
    assert!(shown.sides[0].image.pixels != shown.sides[1].image.pixels);
    let filter = Filter::Box;
    assert_eq!(
        shown.sides[0].rung.antialias,
        Antialias::Supersample { samples: 4, filter }
    );
    assert_eq!(shown.sides[1].rung.antialias, Antialias::None);
}

/// Of two looks, only the one that changed is rendered again.
#[test]
fn a_look_that_stays_keeps_its_picture() {
    let renderer = Counting::default();
    renderer.may_finish.store(true, Ordering::SeqCst);
    let engine = started(renderer.clone());
    let mut wanted = request(BALL, [8, 8]);
    engine.ask(wanted.clone());
    let alone = last(&engine);
    let calls = || renderer.calls.swap(0, Ordering::SeqCst);
    assert_eq!(calls(), 2);
    // another look that is the same is there already
    wanted.looks.push(wanted.looks[0]);
    engine.ask(wanted.clone());
    let both = picture(&engine);
    assert!(both.is_last && calls() == 0);
    wanted.looks[1].settings.march = March::Sphere;
    engine.ask(wanted.clone());
    let first = picture(&engine);
    assert_eq!(
        first.sides[0].rung.samples(),
        4,
        "the first look became coarse"
    );
    assert_eq!(first.sides[1].rung.samples(), 1);
    let refined = last(&engine);
    assert!(Arc::ptr_eq(&alone.sides[0].film, &refined.sides[0].film));
    assert_eq!((calls(), refined.sides[1].rung.samples()), (2, 4));
    // a camera that moved sees both anew
    wanted.camera.eye.x += 0.1;
    engine.ask(wanted);
    assert_eq!(picture(&engine).sides[0].rung.samples(), 1);
    last(&engine);
    assert_eq!(calls(), 4);
}

#[test]
fn what_cannot_be_rendered_is_said() {
    let make = || {
        Err(RenderError::Threads {
            threads: 7,
            reason: "there are none".into(),
        })
    };
    let engine = Engine::start(Box::new(make), || {}).unwrap();
    assert!(
        matches!(engine.wait(PATIENCE), Some(Event::Failed(reason)) if reason.contains("there are none"))
    );
}

/// Its device is gone.
#[derive(Clone)]
struct Lost;

impl Test for Lost {
    fn sample(
        &self,
        _: &Scene,
        _: &mut Accumulator,
        _: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        Err(RenderError::Device {
            reason: "it was pulled out".into(),
            advice: None,
        })
    }
}

#[test]
fn the_cpu_goes_on_where_a_device_fails() {
    let engine = started(Lost);
    engine.ask(request(BALL, [32, 24]));
    assert!(matches!(engine.wait(PATIENCE), Some(Event::Ready(name)) if name.starts_with("CPU")));
    assert!(
        matches!(engine.wait(PATIENCE), Some(Event::FellBack(reason)) if reason.contains("pulled"))
    );
    assert_eq!(last(&engine).sides[0].rung.samples(), 4);
}

#[test]
fn a_window_that_closes_waits_for_nothing() {
    let engine = started(Counting::default());
    engine.ask(request(BALL, [8, 8]));
    picture(&engine);
    // the refined picture would never end
    drop(engine);
}

/// Takes hours for a scene whose first object is called so, and asks; breaks down at another one.
#[derive(Clone)]
struct Moody;

impl Test for Moody {
    fn sample(
        &self,
        scene: &Scene,
        _: &mut Accumulator,
        observer: &dyn Observer,
    ) -> Result<Statistics, RenderError> {
        let name = scene.objects().first().map_or("", |o| o.name.as_str());
        assert!(name != "bad", "planted");
        if name == "slow" {
            while !observer.is_cancelled() {
                std::thread::sleep(Duration::from_millis(1));
            }
            return Err(RenderError::Cancelled);
        }
        Ok(Statistics::default())
    }
}

const NAMED: &str = "show(sphere(), name = \"NAME\")\nrender(aa = none())\n";

fn named(name: &str, edition: u64) -> Request {
    Request {
        edition,
        ..request(&NAMED.replace("NAME", name), [8, 8])
    }
}

#[test]
fn a_saved_file_ends_even_the_first_picture_at_once() {
    let engine = started(Moody);
    engine.ask(named("slow", 0));
    std::thread::sleep(Duration::from_millis(50));
    let began = Instant::now();
    engine.ask(named("fast", 1));
    assert_eq!(last(&engine).request.scene.objects()[0].name, "fast");
    assert!(
        began.elapsed() < Duration::from_millis(900),
        "{:?}",
        began.elapsed()
    );
}

#[test]
fn a_first_picture_that_takes_long_makes_room_for_any_other() {
    let engine = started(Moody);
    engine.ask(named("slow", 0));
    std::thread::sleep(Duration::from_millis(50));
    // a slider that was moved: the file is the same
    engine.ask(named("fast", 0));
    assert_eq!(last(&engine).request.scene.objects()[0].name, "fast");
}

#[test]
fn a_renderer_that_breaks_down_takes_nothing_along() {
    let engine = started(Moody);
    for round in 0..2 {
        engine.ask(named("bad", round));
        if round == 0 {
            assert!(
                matches!(engine.wait(PATIENCE), Some(Event::Failed(said)) if said.contains("broke down"))
            );
            assert!(matches!(engine.wait(PATIENCE), Some(Event::Ready(_))));
            assert!(matches!(engine.wait(PATIENCE), Some(Event::FellBack(_))));
        } else {
            // the CPU has no moods
            last(&engine);
        }
        engine.ask(named("good", round));
        assert_eq!(last(&engine).request.scene.objects()[0].name, "good");
        assert!(engine.is_alive());
    }
}

/// A picture that converges ends where there is little noise, goes on from what it has when only the view changes, and its renderer
/// makes the same pictures as before.
#[test]
fn pictures_converge_in_place() {
    let engine = Engine::start(Box::new(|| cpu(Some(2))), || {}).unwrap();
    engine.wait(PATIENCE);
    let mut wanted = request(BALL, [48, 32]);
    engine.ask(wanted.clone());
    let before = last(&engine);
    wanted.converge = Some(0.05);
    engine.ask(wanted.clone());
    let shown = last(&engine);
    let side = &shown.sides[0];
    let convergence = side.convergence.unwrap();
    assert!(convergence.noise.unwrap() <= 0.05 && convergence.left == Some(0.0));
    assert!(side.rung.samples() >= 64 && side.rays > 0);
    // another plane of it is there at once
    wanted.looks[0].plane = Plane::Normal;
    engine.ask(wanted.clone());
    let again = last(&engine);
    assert_eq!(again.sides[0].rays, side.rays);
    assert!(again.sides[0].film == side.film);
    // what was taken for it left no trace
    wanted.converge = None;
    wanted.camera.eye.x += 0.1;
    engine.ask(wanted.clone());
    last(&engine);
    wanted.camera = before.request.camera;
    engine.ask(wanted);
    assert!(last(&engine).sides[0].film == before.sides[0].film);
}

/// A draft that the ladder asks for has no occlusion and no shadows, and is kept from being taken for the whole picture.
#[test]
fn drafts_leave_out_what_they_say() {
    let mut wanted = request("show(sphere(1), ao = quilez())\nshow(plane())\n", [8, 8]);
    let look = wanted.looks[0];
    let of = |draft| wanted.scene_of(&look, draft).unwrap();
    let shadows = |scene: &Scene| scene.lights().iter().any(|l| l.shadow != Shadow::None);
    let occluded = |scene: &Scene| {
        scene.settings().occlusion != Occlusion::None
            || scene.objects().iter().any(|o| o.occlusion.is_some())
    };
    let seen = Draft::ALL.map(|d| (occluded(&of(d)), shadows(&of(d))));
    assert_eq!(seen, [(true, true), (false, true), (false, false)]);
    assert!(may_be_drafted(&look));
    wanted.looks[0].plane = Plane::Occlusion;
    assert!(!may_be_drafted(&wanted.looks[0]));
    let film = Arc::new(Film::new(8, 8));
    let take = |draft| Take {
        look,
        rung: Rung {
            size: [8, 8],
            draft,
            antialias: Antialias::None,
        },
        film: Arc::clone(&film),
        seconds: 1.0,
        rays: 64,
        evaluations: Evaluations::default(),
        convergence: None,
    };
    let mut kept = Kept::default();
    kept.keep(&take(Draft::Shadowless), [8, 8]);
    assert!(kept.films.is_empty());
    kept.keep(&take(Draft::Whole), [8, 8]);
    assert_eq!(kept.films.len(), 1);
}
