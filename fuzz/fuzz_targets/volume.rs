//! Any bytes as a file of samples: the first says of which format.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    zeroset_fuzz::samples::volume(bytes);
});
