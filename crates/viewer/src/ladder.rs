//! The ladder of pictures: from a coarse one that is there at once to a refined one.

use zeroset_scene::settings::{Antialias, Filter};

/// How long a coarse picture may take, seconds: 25 a second while the camera moves.
const BUDGET: f64 = 0.040;
/// Rays a second before anything was measured.
const UNMEASURED: f64 = 2e6;
/// The coarsest picture has one pixel for so many of the window's, along a side.
const COARSEST: u32 = 8;
/// How many times as fast a draft is at least that is worth what it leaves out.
const FASTER: f64 = 1.1;
/// Rays a pixel of the pictures on the ladder.
const RUNGS: [u32; 4] = [1, 4, 16, 64];

/// What a picture leaves out, to be there in time: first what eyes miss least.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Draft {
    /// Nothing.
    #[default]
    Whole,
    /// Ambient occlusion.
    Unoccluded,
    /// Ambient occlusion and shadows.
    Shadowless,
}

impl Draft {
    /// All, in the order in which they are tried.
    pub const ALL: [Draft; 3] = [Draft::Whole, Draft::Unoccluded, Draft::Shadowless];

    /// How many times as fast as the one before it a draft is taken to be that was never measured. A draft that turns out no faster
    /// is measured by then, and passed over.
    const GAIN: f64 = 1.6;
}

/// How many rays a second were measured, of whole pictures and of drafts, with one ray a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates([Option<f64>; 3]);

impl Rates {
    /// After another measurement.
    pub fn measure(&mut self, draft: Draft, rays: u64, seconds: f64) {
        let rate = &mut self.0[draft as usize];
        *rate = measured(*rate, rays, seconds);
    }

    /// The same for what nothing can be left out of.
    pub fn of_whole_pictures(&self) -> Rates {
        Rates([self.0[0]; 3])
    }

    /// What is known of a draft, or taken for granted.
    fn of(&self, draft: Draft) -> f64 {
        match (self.0[draft as usize], draft) {
            (Some(rate), _) => rate,
            (None, Draft::Whole) => UNMEASURED,
            (None, Draft::Unoccluded) => Draft::GAIN * self.of(Draft::Whole),
            (None, Draft::Shadowless) => Draft::GAIN * self.of(Draft::Unoccluded),
        }
    }

    /// The first picture that keeps to the budget: as large as the window, if one of the drafts is fast enough.
    fn first(&self, full: [u32; 2], sides: usize) -> ([u32; 2], Draft) {
        // before anything was measured, nothing is left out
        let drafts = match self.0[0] {
            Some(_) => &Draft::ALL[..],
            None => &Draft::ALL[..1],
        };
        let at = |draft| (coarse(full, self.of(draft), sides), draft);
        let mut best = at(Draft::Whole);
        for draft in drafts {
            let now = at(*draft);
            // one that is no larger and no faster has nothing to say for what it leaves out
            let is_larger = now.0[0] > best.0[0];
            let is_faster = self.of(*draft) > FASTER * self.of(best.1);
            if is_larger || (best.0 != full && now.0 == best.0 && is_faster) {
                best = now;
            }
        }
        best
    }
}

/// One picture of the ladder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rung {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What it leaves out.
    pub draft: Draft,
    /// How its edges are smoothed.
    pub antialias: Antialias,
}

impl Rung {
    /// Rays a pixel.
    pub fn samples(&self) -> u32 {
        self.antialias.samples()
    }
}

/// The pictures to make, one after the other, for a window of `full` pixels.
///
/// `rates` are what was measured before. `sides` pictures of that size are made at once.
/// The last one has the antialiasing that was chosen; with `refine` it has at least 64 rays a pixel, unless none was
/// chosen.
pub fn rungs(
    full: [u32; 2],
    antialias: Antialias,
    refine: bool,
    rates: &Rates,
    sides: usize,
) -> Vec<Rung> {
    let full = full.map(|n| n.max(1));
    let mut rungs = Vec::with_capacity(6);
    let draft = Draft::Whole;
    let (size, first) = rates.first(full, sides);
    if (size, first) != (full, draft) {
        rungs.push(Rung {
            size,
            draft: first,
            antialias: Antialias::None,
        });
    }
    rungs.push(Rung {
        size: full,
        draft,
        antialias: Antialias::None,
    });
    if matches!(antialias, Antialias::Coverage { .. }) {
        rungs.push(Rung {
            size: full,
            draft,
            antialias,
        });
    }
    if let Antialias::Supersample { samples, filter } = antialias {
        let last = if refine {
            samples.max(RUNGS[3])
        } else {
            samples
        };
        let between = RUNGS.into_iter().filter(|&n| n > 1 && n < last);
        rungs.extend(between.chain([last]).map(|samples| Rung {
            size: full,
            draft,
            antialias: Antialias::Supersample { samples, filter },
        }));
        if last == 1 && filter == Filter::Box {
            // what is there already
            rungs.pop();
        }
    }
    rungs
}

/// The size of a picture that keeps to the budget: the window's over a whole number.
fn coarse([width, height]: [u32; 2], rate: f64, sides: usize) -> [u32; 2] {
    let pixels = f64::from(width) * f64::from(height) * sides.max(1) as f64;
    let affordable = (rate * BUDGET).max(1.0);
    let over = (pixels / affordable).sqrt().ceil();
    let over = if over.is_finite() {
        over as u32
    } else {
        COARSEST
    };
    let over = over.clamp(1, COARSEST);
    [width.div_ceil(over), height.div_ceil(over)]
}

/// The rate after another measurement: a moving mean, so that one slow picture does not make all others coarse.
fn measured(before: Option<f64>, rays: u64, seconds: f64) -> Option<f64> {
    let now = rays as f64 / seconds;
    if !(now > 0.0 && now.is_finite()) {
        return before;
    }
    Some(before.map_or(now, |before| 0.6 * before + 0.4 * now))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOUR: Antialias = Antialias::Supersample {
        samples: 4,
        filter: Filter::Mitchell,
    };

    /// Rates of which only that of whole pictures is known.
    fn known(rate: f64) -> Rates {
        Rates([Some(rate), None, None])
    }

    fn samples(rungs: &[Rung]) -> Vec<u32> {
        rungs.iter().map(Rung::samples).collect()
    }

    #[test]
    fn a_fast_machine_has_no_coarse_picture() {
        let rungs = rungs([800, 600], FOUR, true, &known(1e9), 1);
        assert_eq!(samples(&rungs), [1, 4, 16, 64]);
        assert!(rungs.iter().all(|r| r.size == [800, 600]));
    }

    #[test]
    fn a_coarse_picture_keeps_to_the_budget() {
        for rate in [3e5, 1e6, 5e6] {
            for sides in [1, 2] {
                let rungs = rungs([1283, 799], FOUR, true, &Rates([Some(rate); 3]), sides);
                let [width, height] = rungs[0].size;
                let seconds = f64::from(width * height) * sides as f64 / rate;
                let coarsest = [1283u32.div_ceil(8), 799u32.div_ceil(8)];
                assert!(seconds < 0.045 || rungs[0].size == coarsest, "{rungs:?}");
                assert_eq!(rungs[1].size, [1283, 799]);
                assert_eq!((rungs[0].samples(), rungs[1].samples()), (1, 1));
            }
        }
    }

    #[test]
    fn quality_falls_in_the_order_that_eyes_forgive() {
        let full = [640, 480];
        let pixels = 640.0 * 480.0;
        // how much faster than in time a whole picture is
        let first = |speed: f64| {
            let rung = rungs(full, FOUR, true, &known(speed * pixels / BUDGET), 1)[0];
            (rung.draft, rung.size == full)
        };
        assert_eq!(first(1.01), (Draft::Whole, true));
        assert_eq!(first(0.7), (Draft::Unoccluded, true));
        assert_eq!(first(0.45), (Draft::Shadowless, true));
        assert_eq!(first(0.1), (Draft::Shadowless, false));
        // as coarse as it gets, and still too slow
        assert_eq!(first(1e-4), (Draft::Shadowless, false));
        // what was measured to be of no use is left out of the choice
        let same = Rates([Some(0.5 * pixels / BUDGET); 3]);
        assert_eq!(rungs(full, FOUR, true, &same, 1)[0].draft, Draft::Whole);
        // nothing is left out for good
        let slow = rungs(full, FOUR, true, &known(1e5), 1);
        assert!(
            slow[1..]
                .iter()
                .all(|r| r.draft == Draft::Whole && r.size == full)
        );
    }

    #[test]
    fn the_last_picture_is_what_was_chosen() {
        let last = |antialias, refine| {
            let rungs = rungs([64, 64], antialias, refine, &known(1e9), 1);
            rungs.last().map(|r| r.antialias)
        };
        let many = |samples| Antialias::Supersample {
            samples,
            filter: Filter::Tent,
        };
        assert_eq!(last(Antialias::None, true), Some(Antialias::None));
        assert_eq!(last(many(4), false), Some(many(4)));
        assert_eq!(last(many(9), false), Some(many(9)));
        assert_eq!(last(many(9), true), Some(many(64)));
        assert_eq!(last(many(256), true), Some(many(256)));
        assert_eq!(
            samples(&rungs([9, 9], many(256), true, &known(1e9), 1)),
            [1, 4, 16, 64, 256]
        );
    }

    #[test]
    fn odd_measurements_and_windows_do_no_harm() {
        for rate in [
            None,
            Some(0.0),
            Some(f64::NAN),
            Some(f64::INFINITY),
            Some(1e-9),
        ] {
            for full in [[0, 0], [1, 1], [7, 3000]] {
                assert!(
                    rungs(full, FOUR, true, &Rates([rate; 3]), 2)
                        .iter()
                        .all(|r| r.size[0] > 0 && r.size[1] > 0)
                );
            }
        }
        assert_eq!(measured(Some(5.0), 0, 1.0), Some(5.0));
        assert_eq!(measured(None, 10, 0.0), None);
        assert_eq!(measured(None, 10, 2.0), Some(5.0));
    }
}
