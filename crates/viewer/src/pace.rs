//! How many pictures there are a second, while something changes.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// How far back pictures count.
const WINDOW: Duration = Duration::from_secs(1);
/// Fewer are no pace.
const FEWEST: usize = 3;

/// When the first pictures of requests were shown lately: each is the answer to a change.
#[derive(Clone, Debug, Default)]
pub struct Pace(VecDeque<Instant>);

impl Pace {
    /// Another change is seen.
    pub fn mark(&mut self, now: Instant) {
        self.forget(now);
        self.0.push_back(now);
    }

    fn forget(&mut self, now: Instant) {
        while (self.0.front()).is_some_and(|at| now.duration_since(*at) > WINDOW) {
            self.0.pop_front();
        }
    }

    /// Changes seen a second; `None` where there are too few to say so.
    pub fn rate(&self, now: Instant) -> Option<f64> {
        let mut recent = (self.0.iter()).filter(|at| now.duration_since(**at) <= WINDOW);
        let (first, count) = (recent.clone().next()?, recent.clone().count());
        let last = recent.next_back()?;
        let seconds = last.duration_since(*first).as_secs_f64();
        (count >= FEWEST && seconds > 0.0).then(|| (count - 1) as f64 / seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_is_that_of_the_last_second() {
        let (begin, mut pace) = (Instant::now(), Pace::default());
        let at = |ms| begin + Duration::from_millis(ms);
        assert_eq!(pace.rate(begin), None);
        for ms in (0..2000).step_by(500) {
            pace.mark(at(ms));
        }
        assert!((pace.rate(at(1500)).unwrap() - 2.0).abs() < 1e-9);
        for ms in (1500..3000).step_by(40) {
            pace.mark(at(ms));
        }
        assert!((pace.rate(at(3000)).unwrap() - 25.0).abs() < 1e-6);
        assert_eq!(pace.rate(at(9000)), None);
    }
}
