//! Whether to stop, asked while there is work: a tile may take minutes.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use web_time::Instant;
use zeroset_scene::render::Observer;

/// Instructions of the field's program, times points, between two questions at most: some tenths of a millisecond where an
/// instruction is what it mostly is.
pub(crate) const INTERVAL: u64 = 1 << 18;
/// The first question of a tile comes after so much of it: an instruction may be a loop over a thousand corners.
const FIRST: u64 = 1 << 10;
/// Questions that are farther apart than this come more often from then on, and others less often.
const PATIENCE: Duration = Duration::from_millis(1);

/// What a thread asks before every batch. The answer costs a load; the observer is asked about every millisecond.
pub(crate) struct Stop<'a> {
    observer: &'a dyn Observer,
    /// Shared by all threads of a rendering.
    stopped: &'a AtomicBool,
    /// Instructions of an evaluation.
    instructions: u64,
    /// Work since the observer was asked, and when that was.
    work: Cell<u64>,
    asked: Cell<Instant>,
    /// Work until it is asked again.
    interval: Cell<u64>,
    /// Evaluations that were not stopped: all of them, as every stage asks before it evaluates.
    evaluations: Cell<u64>,
}

impl<'a> Stop<'a> {
    /// One for a tile of a rendering that sets `stopped` where its observer wants it to end. Asks for the first time.
    pub(crate) fn new(
        observer: &'a dyn Observer,
        stopped: &'a AtomicBool,
        instructions: usize,
    ) -> Stop<'a> {
        let stop = Stop {
            observer,
            stopped,
            instructions: instructions.max(1) as u64,
            work: Cell::new(0),
            asked: Cell::new(Instant::now()),
            interval: Cell::new(FIRST),
            evaluations: Cell::new(0),
        };
        stop.ask();
        stop
    }

    /// Whether to stop, before so many evaluations.
    #[inline]
    pub(crate) fn before(&self, evaluations: usize) -> bool {
        let work = self.work.get() + self.instructions * evaluations as u64;
        self.work.set(work);
        if work >= self.interval.get() {
            self.pause();
        }
        if self.is_set() {
            return true;
        }
        let all = self.evaluations.get() + evaluations as u64;
        self.evaluations.set(all);
        false
    }

    /// Asks, and finds out when to ask again.
    #[cold]
    fn pause(&self) {
        let (now, interval) = (Instant::now(), self.interval.get());
        let is_late = now.duration_since(self.asked.get()) > PATIENCE;
        let next = if is_late { interval / 2 } else { interval * 2 };
        self.interval.set(next.clamp(1, INTERVAL));
        self.asked.set(now);
        self.work.set(0);
        self.ask();
    }

    /// Evaluations so far.
    pub(crate) fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Whether somebody found out that it is time to stop.
    #[inline]
    pub(crate) fn is_set(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    fn ask(&self) {
        if self.observer.is_cancelled() {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU32;

    struct Counting(AtomicU32);

    impl Observer for Counting {
        fn advance(&self, _rays: u64, _total: u64) {}
        fn is_cancelled(&self) -> bool {
            self.0.fetch_add(1, Ordering::Relaxed);
            false
        }
    }

    /// Work that takes longer than its instructions say is asked about as often as its time wants it.
    #[test]
    fn slow_instructions_are_asked_about_more_often() {
        let (observer, stopped) = (Counting(AtomicU32::new(0)), AtomicBool::new(false));
        let stop = Stop::new(&observer, &stopped, 2);
        for _ in 0..40 {
            assert!(!stop.before(128));
            std::thread::sleep(Duration::from_millis(2));
        }
        let asked = observer.0.into_inner();
        // the first batches are fewer than an interval
        assert!(asked > 30, "{asked} questions in 40 batches of 2 ms");
        let observer = Counting(AtomicU32::new(0));
        let stop = Stop::new(&observer, &stopped, 2);
        let fast = 1 << 16;
        for _ in 0..fast {
            assert!(!stop.before(128));
        }
        assert_eq!(stop.evaluations(), fast * 128);
        let asked = u64::from(observer.0.into_inner());
        // that many at least, and where the machine rests in between some more
        assert!(
            asked >= fast * 256 / INTERVAL && asked < fast / 4,
            "{asked}"
        );
    }
}
