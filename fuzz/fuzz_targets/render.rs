//! What loads is rendered at 4x4.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zeroset_fuzz::{language_of, load, render};

fuzz_target!(|text: &str| {
    if let Some(scene) = load(text, language_of(text)) {
        render(scene);
    }
});
