//! The ladder of pictures: from a coarse one that is there at once to a refined one.

use zeroset_scene::settings::{Antialias, Filter};

/// How long a coarse picture may take, seconds: 25 a second while the camera moves.
const BUDGET: f64 = 0.040;
/// Rays a second before anything was measured.
const UNMEASURED: f64 = 2e6;
/// The coarsest picture has one pixel for so many of the window's, along a side.
const COARSEST: u32 = 8;
/// Rays a pixel of the pictures on the ladder.
const RUNGS: [u32; 4] = [1, 4, 16, 64];

/// One picture of the ladder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rung {
    /// Width and height in pixels.
    pub size: [u32; 2],
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
/// `rate` is how many rays a second were measured with one ray a pixel. `sides` pictures of that size are made at once.
/// The last one has the antialiasing that was chosen; with `refine` it has at least 64 rays a pixel, unless none was
/// chosen.
pub fn rungs(
    full: [u32; 2],
    antialias: Antialias,
    refine: bool,
    rate: Option<f64>,
    sides: usize,
) -> Vec<Rung> {
    let full = full.map(|n| n.max(1));
    let mut rungs = Vec::with_capacity(6);
    let coarse = coarse(full, rate.unwrap_or(UNMEASURED), sides);
    if coarse != full {
        rungs.push(Rung {
            size: coarse,
            antialias: Antialias::None,
        });
    }
    rungs.push(Rung {
        size: full,
        antialias: Antialias::None,
    });
    if matches!(antialias, Antialias::Coverage { .. }) {
        rungs.push(Rung {
            size: full,
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
pub fn measured(before: Option<f64>, rays: u64, seconds: f64) -> Option<f64> {
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

    fn samples(rungs: &[Rung]) -> Vec<u32> {
        rungs.iter().map(Rung::samples).collect()
    }

    #[test]
    fn a_fast_machine_has_no_coarse_picture() {
        let rungs = rungs([800, 600], FOUR, true, Some(1e9), 1);
        assert_eq!(samples(&rungs), [1, 4, 16, 64]);
        assert!(rungs.iter().all(|r| r.size == [800, 600]));
    }

    #[test]
    fn a_coarse_picture_keeps_to_the_budget() {
        for rate in [3e5, 1e6, 5e6] {
            for sides in [1, 2] {
                let rungs = rungs([1283, 799], FOUR, true, Some(rate), sides);
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
    fn the_last_picture_is_what_was_chosen() {
        let last = |antialias, refine| {
            let rungs = rungs([64, 64], antialias, refine, Some(1e9), 1);
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
            samples(&rungs([9, 9], many(256), true, Some(1e9), 1)),
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
                    rungs(full, FOUR, true, rate, 2)
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
