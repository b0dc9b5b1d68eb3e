//! Any bytes as a checkpoint: as they are, and with check sums that are right, so that what is behind them is reached.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    zeroset_fuzz::checkpoint(bytes);
});
