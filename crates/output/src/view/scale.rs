//! Scales: from a number to a place on a colour map, and the numbers worth writing beside it.

/// How numbers are spread over a colour map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// Evenly between two numbers.
    Linear(f32, f32),
    /// Evenly by magnitude, between two powers of ten.
    Decades(i32, i32),
}

/// Most powers of ten that a scale covers; what is below is shown as the smallest.
const MAX_DECADES: i32 = 8;

impl Scale {
    /// The scale from 0 to the largest of the numbers.
    pub(crate) fn from_zero(numbers: impl Iterator<Item = f32>) -> Scale {
        let max = numbers.filter(|x| x.is_finite()).fold(0.0, f32::max);
        Scale::Linear(0.0, if max > 0.0 { max } else { 1.0 })
    }

    /// The scale from the smallest to the largest of the numbers.
    pub(crate) fn between(numbers: impl Iterator<Item = f32>) -> Scale {
        let (min, max) = numbers
            .filter(|x| x.is_finite())
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
        match (min <= max, min < max) {
            (true, true) => Scale::Linear(min, max),
            (true, false) => Scale::Linear(min - 0.5, min + 0.5),
            _ => Scale::Linear(0.0, 1.0),
        }
    }

    /// The decades that hold the positive numbers, but for the smallest of a hundred.
    pub(crate) fn decades(numbers: impl Iterator<Item = f32>) -> Scale {
        let mut numbers: Vec<f32> = numbers.filter(|x| x.is_finite() && *x > 0.0).collect();
        numbers.sort_unstable_by(f32::total_cmp);
        let (Some(&min), Some(&max)) = (numbers.get(numbers.len() / 100), numbers.last()) else {
            return Scale::Decades(-6, 0);
        };
        let high = max.log10().ceil() as i32;
        let low = (min.log10().floor() as i32).clamp(high - MAX_DECADES, high - 1);
        Scale::Decades(low, high)
    }

    /// Where a number is on the scale, 0 to 1.
    pub(crate) fn place(self, x: f32) -> f32 {
        let share = match self {
            Scale::Linear(low, high) => (x - low) / (high - low),
            Scale::Decades(low, high) => (x.log10() - low as f32) / (high - low) as f32,
        };
        // also for NaN, and for 0 among decades
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    /// The round number that `most` of lie on a linear scale at most.
    pub(crate) fn step(self, most: usize) -> f32 {
        match self {
            Scale::Linear(low, high) => round_step(f64::from(high) - f64::from(low), most) as f32,
            Scale::Decades(..) => 1.0,
        }
    }

    /// At most about `most` round numbers on the scale, ascending, as (place, text).
    pub(crate) fn ticks(self, most: usize) -> Vec<(f32, String)> {
        let most = most.max(2);
        match self {
            Scale::Linear(low, high) => {
                let (low, high) = (f64::from(low), f64::from(high));
                let step = round_step(high - low, most);
                let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
                let (first, last) = (
                    (low / step - 1e-6).ceil() as i64,
                    (high / step + 1e-6).floor() as i64,
                );
                (first..=last)
                    .map(|i| {
                        let value = i as f64 * step;
                        let text = if value.abs() >= 1e6 || (step < 1e-6 && i != 0) {
                            format!("{value:.0e}")
                        } else {
                            format!("{value:.decimals$}")
                        };
                        (self.place(value as f32), text)
                    })
                    .collect()
            }
            Scale::Decades(low, high) => {
                let every = ((high - low) as usize).div_ceil(most).max(1);
                (low..=high)
                    .step_by(every)
                    .map(|d| ((d - low) as f32 / (high - low) as f32, format!("1e{d}")))
                    .collect()
            }
        }
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that fits into a width at most `most` times.
fn round_step(width: f64, most: usize) -> f64 {
    let rough = width / most as f64;
    let power = 10f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0]
        .map(|m| m * power)
        .into_iter()
        .find(|s| *s >= rough)
        .unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn words(scale: Scale, most: usize) -> Vec<String> {
        scale
            .ticks(most)
            .into_iter()
            .map(|(_, text)| text)
            .collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            words(Scale::Linear(0.0, 87.0), 5),
            ["0", "20", "40", "60", "80"]
        );
        assert_eq!(
            words(Scale::Linear(2.31, 3.07), 4),
            ["2.4", "2.6", "2.8", "3.0"]
        );
        assert_eq!(
            words(Scale::Decades(-7, -1), 4),
            ["1e-7", "1e-5", "1e-3", "1e-1"]
        );
    }

    #[test]
    fn scales_survive_numbers_that_say_nothing() {
        for numbers in [
            vec![],
            vec![f32::NAN],
            vec![f32::INFINITY, f32::NEG_INFINITY],
            vec![0.0],
            vec![3.0; 4],
        ] {
            let make: [fn(std::vec::IntoIter<f32>) -> Scale; 3] = [
                |n| Scale::from_zero(n),
                |n| Scale::between(n),
                |n| Scale::decades(n),
            ];
            for scale in make.map(|make| make(numbers.clone().into_iter())) {
                assert!(scale.ticks(5).len() < 12, "{scale:?}");
                for x in [0.0, -1.0, 3.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                    assert!((0.0..=1.0).contains(&scale.place(x)), "{scale:?} {x}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn ticks_lie_on_the_scale_in_order(low in -1e6f32..1e6, width in 1e-3f32..1e6, most in 2usize..12) {
            let scale = Scale::Linear(low, low + width);
            let ticks = scale.ticks(most);
            prop_assert!(ticks.len() <= most + 1, "{:?}", ticks);
            prop_assert!(ticks.is_sorted_by(|a, b| a.0 <= b.0));
        }
    }
}
