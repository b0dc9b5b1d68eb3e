//! Any text as Starlark, and as a list of operations.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zeroset_language::load::Language;
use zeroset_language::registers::Registers;

fuzz_target!(|text: &str| {
    zeroset_fuzz::load(text, Language::Starlark);
    let _ = Registers::parse(text);
});
