//! Ctrl-C: the first one asks to stop, the second one stops.

use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Listens for Ctrl-C and for the system's wish that the process ends.
pub(crate) fn listen() {
    let stop = || {
        if REQUESTED.swap(true, Ordering::Relaxed) {
            // Unfinished files stay behind under names of their own; the next run clears them away.
            std::process::exit(crate::failure::Exit::Interrupted as i32);
        }
    };
    if let Err(error) = ctrlc::set_handler(stop) {
        tracing::warn!("Ctrl-C ends the process at once: {error}");
    }
}

/// Whether the user asked to stop.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
