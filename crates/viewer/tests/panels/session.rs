//! Sessions to put panels on.

use std::sync::Arc;
use std::time::Duration;
use zeroset_language::load::{Language, Options, load_text};
use zeroset_viewer::engine::{Engine, Event, cpu};
use zeroset_viewer::loader::Outcome;
use zeroset_viewer::session::Session;

/// A scene with every kind of parameter, and a time.
pub(crate) const SCENE: &str = "bite = slider(\"bite\", 0.4, min = 0.0, max = 1.0)
style = choice(\"style\", [\"round\", \"sharp\"])
floor = toggle(\"floor\", True)
tint = color(\"tint\", \"#e8b04a\")
ball = sphere(0.8) if style == \"round\" else box(1.2)
show(ball - sphere(0.4).move(x = 1 - bite, y = 0.1 * sin(tau * time())), tint, name = \"fruit\")
if floor:
    show(plane().move(y = -0.8))
render(size = (320, 240), aa = none())
";

/// What a loader gives for a text.
pub(crate) fn outcome(text: &str, options: &Options) -> Outcome {
    let result = load_text("test.star", text, Language::Starlark, None, options);
    Outcome {
        options: options.clone(),
        is_edit: true,
        result: result.map(Arc::new).map_err(|f| f.to_string()),
    }
}

/// A session with a scene.
pub(crate) fn session() -> Session {
    let mut session = Session::new("test.star".into(), Options::default());
    session.absorb(outcome(SCENE, &Options::default()));
    assert_eq!(session.trouble, None);
    session
}

/// A session with a picture of its scene.
pub(crate) fn rendered(prepare: impl FnOnce(&mut Session)) -> Session {
    let mut session = session();
    session.refine = false;
    prepare(&mut session);
    let engine = Engine::start(Box::new(|| cpu(Some(2))), || {}).expect("a thread");
    engine.ask(session.to_render([160, 120]).expect("a scene"));
    loop {
        match engine.wait(Duration::from_secs(60)) {
            Some(Event::Ready(name)) => session.backend = Some(name),
            Some(Event::Failed(reason) | Event::FellBack(reason)) => panic!("{reason}"),
            Some(Event::Shown(shown)) => {
                let is_last = shown.is_last;
                session.shown = Some(shown);
                if is_last {
                    return session;
                }
            }
            None => panic!("no picture"),
        }
    }
}
