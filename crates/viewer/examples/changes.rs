//! How many changes the window shows a second while a slider is dragged: a smooth union of twenty parts at 640x480, on two cores.
//!
//! `cargo run --release -p zeroset-viewer --example changes`

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use zeroset_language::assets::Assets;
use zeroset_language::document::Document;
use zeroset_language::limits::Limits;
use zeroset_language::load::{Language, Options};
use zeroset_scene::film::Plane;
use zeroset_viewer::engine::{Engine, Event, Look, Request, cpu};

/// A body with eight arms of tubes and balls, all of one skin.
const SCENE: &str = "
bend = slider(\"bend\", 0.3, 0, 1)
parts = [sphere(0.9).move(y = 0.6), sphere(0.7).move(y = 1.2), sphere(0.4).move(x = 0.5, y = 1.3), sphere(0.4).move(x = -0.5, y = 1.3)]
for i in range(8):
    a = tau * i / 8
    knee = (1.3 * cos(a), 0.2 + 0.3 * bend, 1.3 * sin(a))
    end = (2.2 * cos(a + bend), -0.3 + 0.4 * bend, 2.2 * sin(a + bend))
    parts += [polyline_tube(0.22, [(0.4 * cos(a), 0.3, 0.4 * sin(a)), knee]), polyline_tube(0.14, [knee, end])]
body = parts[0]
for part in parts[1:]:
    body = body.smooth_union(part, radius = 0.25)
show(body, material(color = \"#c2543c\"))
show(plane().move(y = -0.5), material(color = \"#c9c5bd\"))
camera(eye = (3.2, 2.6, 4.4), target = (0, 0.4, 0), fov = 40)
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (limits, assets) = (Limits::default(), Assets::default());
    let mut document = Document::of_text(
        "octopus.star",
        SCENE,
        Language::Starlark,
        None,
        &limits,
        &assets,
    )?;
    let engine = Engine::start(Box::new(|| cpu(Some(2))), || {})?;
    let mut request = |bend: f64| -> Result<Request, Box<dyn std::error::Error>> {
        let set: BTreeMap<_, _> = [("bend".to_owned(), bend.to_string())].into();
        let loaded = document.scene(&Options {
            set,
            ..Options::default()
        })?;
        let scene = Arc::new(loaded.scene);
        Ok(Request {
            camera: *scene.camera(),
            looks: vec![Look {
                settings: *scene.settings(),
                shadow: None,
                plane: Plane::Colour,
            }],
            size: [640, 480],
            refine: true,
            converge: None,
            slice: None,
            edition: 0,
            scene,
        })
    };
    let steps = 160;
    let mut loading = Duration::ZERO;
    let (mut count, mut began, mut last) = (0, Instant::now(), None);
    for step in 0..steps {
        let start = Instant::now();
        let next = request(0.5 + 0.4 * (0.05 * f64::from(step)).sin())?;
        loading += start.elapsed();
        engine.ask(next);
        // the first picture that answers it; those before it belong to other requests
        loop {
            match engine.wait(Duration::from_secs(60)) {
                Some(Event::Shown(shown)) => {
                    let is_first = last
                        .as_ref()
                        .is_none_or(|l| !Arc::ptr_eq(l, &shown.request));
                    last = Some(Arc::clone(&shown.request));
                    if is_first {
                        let side = &shown.sides[0];
                        if step % 40 == 39 {
                            let [width, height] = side.rung.size;
                            let (draft, rays) = (side.rung.draft, 1e3 * side.seconds);
                            println!("{width}x{height}, {draft:?}: {rays:.0} ms of rays");
                        }
                        break;
                    }
                }
                Some(Event::Failed(reason) | Event::FellBack(reason)) => return Err(reason.into()),
                Some(Event::Ready(_)) => {}
                None => return Err("no picture".into()),
            }
        }
        count += 1;
        if step == 39 {
            // by now it is known how fast this machine is
            (count, began, loading) = (0, Instant::now(), Duration::ZERO);
        }
    }
    let rate = f64::from(count) / began.elapsed().as_secs_f64();
    let loading = 1e3 * loading.as_secs_f64() / f64::from(count);
    println!("{rate:.1} changes a second, of which each took {loading:.0} ms to load");
    Ok(())
}
