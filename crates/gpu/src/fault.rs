//! Faults on demand: how tests bring about what drivers do rarely.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// What goes wrong and when. Things are counted from 0 over the life of the renderer, devices that were lost included.
#[derive(Clone, Debug, Default)]
pub struct Faults(Arc<Mutex<Plan>>);

#[derive(Debug, Default)]
struct Plan {
    /// Allocations that fail.
    allocations: BTreeSet<u64>,
    /// All allocations above this many bytes fail.
    largest: Option<u64>,
    /// Submissions before which the device is lost.
    losses: BTreeSet<u64>,
    /// Devices that are not given.
    devices: BTreeSet<u64>,
    /// How long a submission may take.
    patience: Option<Duration>,
    counts: [u64; 3],
}

impl Faults {
    /// The allocations with these numbers fail.
    #[must_use]
    pub fn failing_allocations(self, numbers: impl IntoIterator<Item = u64>) -> Faults {
        self.plan(|plan| plan.allocations.extend(numbers));
        self
    }

    /// All allocations above this many bytes fail.
    #[must_use]
    pub fn with_memory(self, largest: u64) -> Faults {
        self.plan(|plan| plan.largest = Some(largest));
        self
    }

    /// The device is lost before the submissions with these numbers.
    #[must_use]
    pub fn losing_at(self, numbers: impl IntoIterator<Item = u64>) -> Faults {
        self.plan(|plan| plan.losses.extend(numbers));
        self
    }

    /// The devices with these numbers are not given.
    #[must_use]
    pub fn refusing_devices(self, numbers: impl IntoIterator<Item = u64>) -> Faults {
        self.plan(|plan| plan.devices.extend(numbers));
        self
    }

    /// A device that does not finish a submission in this time is given up, also where it compiles.
    #[must_use]
    pub fn with_patience(self, patience: Duration) -> Faults {
        self.plan(|plan| plan.patience = Some(patience));
        self
    }

    /// Allocations, submissions and devices so far.
    pub fn counts(&self) -> [u64; 3] {
        self.plan(|plan| plan.counts)
    }

    pub(crate) fn fails_allocation(&self, bytes: u64) -> bool {
        self.plan(|plan| {
            let number = count(&mut plan.counts[0]);
            plan.allocations.contains(&number) || plan.largest.is_some_and(|most| bytes > most)
        })
    }

    pub(crate) fn loses_device(&self) -> bool {
        self.plan(|plan| {
            let number = count(&mut plan.counts[1]);
            plan.losses.contains(&number)
        })
    }

    pub(crate) fn refuses_device(&self) -> bool {
        self.plan(|plan| {
            let number = count(&mut plan.counts[2]);
            plan.devices.contains(&number)
        })
    }

    pub(crate) fn patience(&self) -> Option<Duration> {
        self.plan(|plan| plan.patience)
    }

    fn plan<T>(&self, with: impl FnOnce(&mut Plan) -> T) -> T {
        with(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// The number, which then grows by one.
fn count(counter: &mut u64) -> u64 {
    *counter += 1;
    *counter - 1
}
