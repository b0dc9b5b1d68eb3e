//! How near a mean is to the truth, and how much of that is seen.

/// A mean, and how far from it the truth is, 95 times of a hundred at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The estimate, linear light.
    pub mean: f64,
    /// Half the width of the interval around it; infinite where nothing is known.
    pub half: f64,
}

impl Interval {
    /// Whether a value is within.
    pub fn holds(&self, value: f64) -> bool {
        (value - self.mean).abs() <= self.half
    }

    /// Half the width of what a screen shows of it, where light is multiplied by `gain` first.
    pub fn noise(&self, gain: f64) -> f64 {
        if !self.half.is_finite() {
            return f64::INFINITY;
        }
        let [low, high] = [self.mean - self.half, self.mean + self.half];
        0.5 * (displayed(gain * high) - displayed(gain * low))
    }
}

/// About how bright linear light is on a screen, white being 1: the square root up to white (as errors are weighed by Dammertz, Hanika,
/// Keller and Lensch 2010), and the logarithm beyond, as tone curves do. It rises, so what holds a number holds what is shown of it.
pub fn displayed(light: f64) -> f64 {
    if light <= 1.0 {
        light.max(0.0).sqrt()
    } else {
        1.0 + 0.5 * light.ln()
    }
}

/// The quantile of 97.5 % of Student's distribution with so many degrees of freedom. From 7 on it is within 0.001
/// (Fisher and Cornish 1960); below that, of a table.
pub fn student(freedom: u32) -> f64 {
    const TABLE: [f64; 7] = [
        f64::INFINITY,
        12.706_205,
        4.302_653,
        3.182_446,
        2.776_445,
        2.570_582,
        2.446_912,
    ];
    if let Some(quantile) = TABLE.get(freedom as usize) {
        return *quantile;
    }
    const Z: f64 = 1.959_963_984_540_054;
    let n = f64::from(freedom);
    let [z3, z5, z7] = [3, 5, 7].map(|k| Z.powi(k));
    let first = (z3 + Z) / 4.0;
    let second = (5.0 * z5 + 16.0 * z3 + 3.0 * Z) / 96.0;
    let third = (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * Z) / 384.0;
    Z + (first + (second + third / n) / n) / n
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles as tables print them.
    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, right) in [
            (1, 12.706_205),
            (2, 4.302_653),
            (6, 2.446_912),
            (7, 2.364_624),
            (9, 2.262_157),
            (15, 2.131_450),
            (30, 2.042_272),
            (120, 1.979_930),
            (1_000_000, 1.959_966),
        ] {
            assert!((student(freedom) - right).abs() < 1e-3, "{freedom}");
        }
    }

    #[test]
    fn what_is_shown_rises_without_a_step() {
        let mut before = displayed(0.0);
        for i in 1..4000 {
            let now = displayed(f64::from(i) * 1e-3);
            assert!(now > before && now - before < 0.04, "{i}");
            before = now;
        }
        // a grey of 0.25 that may be off by 0.01 is off by a hundredth of white
        let interval = Interval {
            mean: 0.25,
            half: 0.01,
        };
        assert!((interval.noise(1.0) - 0.01).abs() < 1e-5);
        assert!((interval.noise(4.0) - 0.02).abs() < 2e-4);
        assert!(interval.holds(0.2599) && !interval.holds(0.2601));
    }
}
