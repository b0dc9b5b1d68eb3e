//! What a file may take of the machine. Seconds are those of the processor: wall time says nothing where others work too.

use cpu_time::ProcessTime;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a file from a stranger may take until it is refused.
pub(crate) const SECONDS: f64 = 2.0;
pub(crate) const BYTES: u64 = 512 << 20;

/// One test of this process at a time: what they take would add up.
pub(crate) fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What comes of `work`, and the seconds that it took all threads of this process together.
pub(crate) fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = ProcessTime::now();
    let done = work();
    (done, start.elapsed().as_secs_f64())
}

/// The most memory that this process ever held, in bytes, where the system says so.
pub(crate) fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kibibytes = line.split_whitespace().nth(1)?.parse::<u64>().ok()?;
    Some(kibibytes << 10)
}
