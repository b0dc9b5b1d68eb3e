//! The time of an animation: playing, looping, and standing still.

/// Lengths that a timeline may have, seconds.
pub const LENGTHS: std::ops::RangeInclusive<f64> = 0.1..=3600.0;
/// Frames a second that it may have.
pub const RATES: std::ops::RangeInclusive<f64> = 1.0..=120.0;

/// What `time()` is in the scene, and how it goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Seconds since the beginning, not yet brought to a frame.
    at: f64,
    /// Whether it runs.
    pub is_playing: bool,
    /// Whether it begins again at its end.
    pub is_looping: bool,
    /// Seconds.
    pub length: f64,
    /// Frames a second.
    pub fps: f64,
}

impl Clock {
    /// A clock that stands at a time.
    pub fn new(at: f64) -> Clock {
        Clock {
            at,
            is_playing: false,
            is_looping: true,
            length: if at > 4.0 { at } else { 4.0 },
            fps: 30.0,
        }
    }

    /// The time of the frame that is shown, seconds. What was set by hand need not be one.
    pub fn time(&self) -> f64 {
        if self.is_playing {
            self.moment(self.frame())
        } else {
            self.at
        }
    }

    /// Number of the frame that is shown.
    pub fn frame(&self) -> i64 {
        // a hair more, so that the time of a frame belongs to that frame
        (self.at * self.fps + 1e-6).floor() as i64
    }

    /// When a frame is.
    fn moment(&self, frame: i64) -> f64 {
        frame as f64 / self.fps
    }

    /// Sets the time.
    pub fn scrub(&mut self, at: f64) {
        if at.is_finite() {
            self.at = at.clamp(0.0, self.length);
        }
    }

    /// Goes a number of frames on, or back.
    pub fn step(&mut self, frames: i64) {
        self.is_playing = false;
        self.scrub(self.moment(self.frame() + frames));
    }

    /// Begins, or stops. From the end it begins at the beginning.
    pub fn toggle(&mut self) {
        self.is_playing = !self.is_playing;
        if self.is_playing && self.frame() >= self.last() {
            self.at = 0.0;
        }
        if !self.is_playing {
            self.at = self.moment(self.frame());
        }
    }

    /// The last frame.
    fn last(&self) -> i64 {
        ((self.length * self.fps).round() as i64 - 1).max(0)
    }

    /// Lets seconds pass.
    pub fn advance(&mut self, seconds: f64) {
        if !(self.is_playing && seconds > 0.0 && seconds.is_finite()) {
            return;
        }
        self.at += seconds;
        if self.at < self.length {
            return;
        }
        if self.is_looping {
            self.at = self.at.rem_euclid(self.length);
        } else {
            self.at = self.moment(self.last());
            self.is_playing = false;
        }
    }

    /// Keeps what a person may have changed within its ranges.
    pub fn settle(&mut self) {
        self.length = self.length.clamp(*LENGTHS.start(), *LENGTHS.end());
        self.fps = self.fps.clamp(*RATES.start(), *RATES.end());
        self.at = self.at.min(self.length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_plays_frame_by_frame_and_loops() {
        let mut clock = Clock::new(0.0);
        clock.advance(1.0);
        assert_eq!(clock.time(), 0.0);
        clock.toggle();
        clock.advance(0.05);
        assert_eq!((clock.frame(), clock.time()), (1, 1.0 / 30.0));
        clock.advance(3.96);
        assert_eq!(clock.frame(), 0);
        clock.is_looping = false;
        clock.advance(100.0);
        assert_eq!((clock.frame(), clock.is_playing), (119, false));
        clock.toggle();
        assert_eq!((clock.frame(), clock.is_playing), (0, true));
    }

    #[test]
    fn scrubbing_and_stepping_stay_on_the_timeline() {
        let mut clock = Clock::new(0.0);
        clock.scrub(1.234);
        assert_eq!(clock.time(), 1.234);
        clock.step(1);
        assert_eq!(clock.time(), 38.0 / 30.0);
        clock.step(-1);
        assert_eq!(clock.time(), 37.0 / 30.0);
        for _ in 0..200 {
            clock.step(1);
        }
        assert!(clock.time() <= clock.length);
        clock.step(-100_000);
        assert_eq!(clock.time(), 0.0);
        clock.scrub(f64::NAN);
        clock.length = 1e9;
        clock.fps = 0.0;
        clock.settle();
        assert_eq!((clock.time(), clock.length, clock.fps), (0.0, 3600.0, 1.0));
    }

    #[test]
    fn a_time_that_was_given_is_kept() {
        let clock = Clock::new(7.3);
        assert!(clock.time() == 7.3 && clock.length >= 7.3);
    }
}
