//! What fuzzing found once, and programs that nest: they load or they are refused, in time; what loads renders.
//!
//! The targets of `fuzz/` ask the same of inputs that they make up. An input that broke something is kept in
//! `fuzz/regressions/` as the text of a scene.

#![allow(unreachable_pub, reason = "the modules of a test are its own")]

#[path = "../../../fuzz/src/nest.rs"]
mod nest;

use std::path::PathBuf;
use std::time::{Duration, Instant};
use zeroset_language::load::{Language, Options, load_text};
use zeroset_scene::film::Plane;
use zeroset_scene::render::{Renderer, Silent};
use zeroset_trace::CpuRenderer;

/// A file from a stranger has two seconds; a machine under load, with all tests at once, is slower.
const PATIENCE: Duration = Duration::from_secs(6);

/// JSON where the text begins as JSON does, else Starlark: the language that fuzzing takes it for.
fn language_of(text: &str) -> Language {
    if text.trim_start().starts_with('{') {
        Language::Json
    } else {
        Language::Starlark
    }
}

/// Loads a text, and renders it at 4x4 if it is asked for.
fn survives(name: &str, text: &str, picture: bool) {
    let options = Options {
        size: Some([4, 4]),
        ..Options::default()
    };
    let start = Instant::now();
    let loaded = load_text(name, text, language_of(text), None, &options);
    assert!(
        start.elapsed() < PATIENCE,
        "{name} took {:?}",
        start.elapsed()
    );
    match loaded {
        Err(failed) => assert!(!failed.report.is_bug(), "{name}: {}", failed.report),
        Ok(loaded) if picture => {
            let renderer = CpuRenderer::new(Some(2)).expect("threads");
            let Ok(frame) = renderer.render(&loaded.scene, &Silent) else {
                return;
            };
            for plane in Plane::ALL {
                let far = plane == Plane::Depth;
                let numbers = frame.film.plane(plane);
                let sound = |x: &f32| x.is_finite() || (far && *x == f32::INFINITY);
                assert!(
                    numbers.iter().all(sound),
                    "{name}: {plane:?} has {numbers:?}"
                );
            }
        }
        Ok(_) => {}
    }
}

#[test]
fn what_fuzzing_found_stays_mended() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/regressions");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(&folder)
        .expect("the folder of regressions")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    for path in paths {
        let bytes = std::fs::read(&path).expect("a file");
        let text = String::from_utf8_lossy(&bytes);
        survives(&path.display().to_string(), &text, true);
    }
}

/// A thousand of the programs of the fuzz target that knows depth.
#[test]
fn programs_that_nest_are_refused_in_time() {
    let mut state = 0x2545_f491_4f6c_dd1du64;
    let mut deep = 0;
    for number in 0..1000 {
        let bytes: Vec<u8> = (0..48)
            .map(|_| {
                // xorshift64*: Marsaglia 2003, Vigna 2016
                state ^= state >> 12;
                state ^= state << 25;
                state ^= state >> 27;
                (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 56) as u8
            })
            .collect();
        let text = nest::program(&bytes);
        deep += usize::from(text.len() > 5000);
        survives(&format!("nested program {number}"), &text, false);
    }
    assert!(deep > 300, "only {deep} programs nest deeply");
}
