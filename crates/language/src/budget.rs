//! What loading may take: bytes that are charged before they are asked for, and time.

use crate::limits::{Limits, in_words};
use web_time::{Duration, Instant};

/// The part of the limit `memory` that loading may take: the picture needs the rest, and a scene that ends in an error
/// never needs a picture.
const SHARE: u64 = 8;

/// Bytes and seconds of one load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoadBudget {
    held: u64,
    memory: u64,
    start: Instant,
    seconds: f64,
    /// What of the time went into sampling, which has a limit of its own.
    sampled: Duration,
}

/// Why loading ends.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Spent {
    #[error(
        "{what} would take {wanted} of memory beside the {held} that the scene's files take already: at most {allowed} in \
         all (an eighth of the limit `memory`)"
    )]
    Memory {
        what: String,
        wanted: String,
        held: String,
        allowed: String,
    },
    #[error("loading takes longer than {0} seconds (limit `seconds`)")]
    Time(f64),
}

impl LoadBudget {
    pub(crate) fn new(limits: &Limits) -> LoadBudget {
        LoadBudget {
            held: 0,
            memory: limits.memory / SHARE,
            start: Instant::now(),
            seconds: limits.seconds,
            sampled: Duration::ZERO,
        }
    }

    /// The same bytes held, with all the time again.
    pub(crate) fn again(&self, limits: &Limits) -> LoadBudget {
        LoadBudget {
            held: self.held,
            ..LoadBudget::new(limits)
        }
    }

    /// Leaves time that sampling took out of what loading may take.
    pub(crate) fn pause(&mut self, time: Duration) {
        self.start += time;
        self.sampled += time;
    }

    /// What sampling took so far.
    pub(crate) fn sampled(&self) -> Duration {
        self.sampled
    }

    /// When loading began.
    pub(crate) fn start(&self) -> Instant {
        self.start
    }

    /// Charges bytes that are kept until loading ends.
    pub(crate) fn hold(&mut self, bytes: u64, what: impl FnOnce() -> String) -> Result<(), Spent> {
        self.borrow(bytes, what)?;
        self.held += bytes;
        Ok(())
    }

    /// Whether bytes may be taken that are given back at once.
    pub(crate) fn borrow(&self, bytes: u64, what: impl FnOnce() -> String) -> Result<(), Spent> {
        if self.held.saturating_add(bytes) <= self.memory {
            return Ok(());
        }
        Err(Spent::Memory {
            what: what(),
            wanted: in_words(bytes),
            held: in_words(self.held),
            allowed: in_words(self.memory),
        })
    }

    /// Whether there is time left.
    pub(crate) fn check_clock(&self) -> Result<(), Spent> {
        if self.start.elapsed().as_secs_f64() > self.seconds {
            return Err(Spent::Time(self.seconds));
        }
        Ok(())
    }
}
