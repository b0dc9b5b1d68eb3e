//! Scene text: it loads or it is refused, without a panic, in time. What loads goes to JSON and back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zeroset_scene::json::{expand, to_text};
use zeroset_scene::load::{Language, Options, load_text};

fuzz_target!(|text: &str| {
    let options = Options::default();
    match load_text("fuzz.star", text, Language::Starlark, None, &options) {
        Ok(loaded) => {
            let json = to_text(&expand(&loaded.scene));
            let again = load_text("fuzz.json", &json, Language::Json, None, &options).expect("what was written can be read");
            assert_eq!(json, to_text(&expand(&again.scene)));
        }
        // a panic of the loader is caught and reported, so that the window survives it; here it must not pass
        Err(failed) => assert!(!failed.report.message().contains("broke down"), "{}", failed.report),
    }
});
