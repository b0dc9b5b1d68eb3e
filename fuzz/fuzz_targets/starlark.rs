//! Any text as Starlark.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zeroset_language::load::Language;

fuzz_target!(|text: &str| {
    zeroset_fuzz::load(text, Language::Starlark);
});
