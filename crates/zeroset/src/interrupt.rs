//! Ctrl-C ends the process; where files are being written it asks to stop first, and ends it the second time.

use crate::failure::Exit;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);
/// Who will ask whether to stop.
static ASKING: AtomicUsize = AtomicUsize::new(0);

/// Listens for Ctrl-C and for the system's wish that the process ends.
pub(crate) fn listen() {
    let stop = || {
        if REQUESTED.swap(true, Ordering::SeqCst) || ASKING.load(Ordering::SeqCst) == 0 {
            // Unfinished files stay behind under names of their own; the next run clears them away.
            std::process::exit(Exit::Interrupted as i32);
        }
    };
    if let Err(error) = ctrlc::set_handler(stop) {
        tracing::warn!("Ctrl-C ends the process at once: {error}");
    }
}

/// As long as this lives, somebody asks every few milliseconds whether to stop.
pub(crate) struct Asking(());

impl Asking {
    /// Says so.
    pub(crate) fn begin() -> Asking {
        ASKING.fetch_add(1, Ordering::SeqCst);
        Asking(())
    }
}

impl Drop for Asking {
    fn drop(&mut self) {
        ASKING.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Whether the user asked to stop.
pub(crate) fn requested() -> bool {
    REQUESTED.load(Ordering::Relaxed)
}
