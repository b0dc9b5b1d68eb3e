//! Scene JSON: it loads or it is refused, without a panic, in time. What loads can be written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zeroset_scene::json::{expand, to_text};
use zeroset_scene::load::{Language, Options, load_text};

fuzz_target!(|text: &str| {
    let options = Options::default();
    match load_text("fuzz.json", text, Language::Json, None, &options) {
        Ok(loaded) => {
            let json = to_text(&expand(&loaded.scene));
            let again = load_text("fuzz.json", &json, Language::Json, None, &options).expect("what was written can be read");
            assert_eq!(json, to_text(&expand(&again.scene)));
        }
        Err(failed) => assert!(!failed.report.message().contains("broke down"), "{}", failed.report),
    }
});
