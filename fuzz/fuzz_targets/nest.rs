//! Programs that nest and recurse as deep as they may, and deeper: bytes choose what is put into what, and how often.
//!
//! `ZEROSET_FUZZ_SHOW=1` prints the program of an input.
#![no_main]

use libfuzzer_sys::fuzz_target;
use zeroset_fuzz::{language_of, load, nest};

fuzz_target!(|bytes: &[u8]| {
    let text = nest::program(bytes);
    if std::env::var_os("ZEROSET_FUZZ_SHOW").is_some() {
        println!("{text}");
    }
    load(&text, language_of(&text));
});
